// SPDX-License-Identifier: GPL-3.0-or-later
// Audits a move in time that something else made: a certificate's path with its law, or a table with times.
//
// A table's digits are noise to accelerations. So the move that is audited is one that is fitted to the table
// (planner/move_fit.h), and it is proved that each row lies within a stated rounding of it at the row's time. The
// certificate is about that move alone: its checker is not told of rows.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "app/audit.h"
#include "app/path_source.h"
#include "app/recheck.h"

namespace taut {

/// A table with times, and how near its rows are to the move that was fitted to it.
struct FittedTable {
  TableRounding rounding;
  std::vector<std::size_t> lines;  ///< of its rows
  std::vector<double> times_s;     ///< since the first row, rounded
  Decimal begin_s;                 ///< the first row's time, where the move's time is 0
  double duration_off_s = 0;       ///< what rounding of the law's step changes of the time from first to last row
  /// The greatest proved bound of a row's distance from the move, and in which line. Not above the rounding.
  struct Farthest {
    double by = 0;
    std::size_t line = 0;
  };
  Farthest position_m, angle_rad;  ///< of poses
  Farthest length_m;               ///< of cable lengths
  /// Where lengths that run straight between the rows are part of the theorem: by how much they may change their speed
  /// at a row, in floating point [m/s].
  std::optional<double> jump_m_s;
  std::string angles;  ///< "roll, pitch and yaw": where these were made of quaternions or lengths; else empty

  /// The lines of the rows next to a time of the move; one number twice where they are one.
  [[nodiscard]] std::pair<std::size_t, std::size_t> lines_at(double time_s) const;
};

struct MoveSource {
  Problem problem;  ///< the case's, without its query, in the space of `path`
  Path path;        ///< with its law in time
  PathOrigin origin;
  std::string description;           ///< lines of text: what was read, and what that means
  std::string remarks;               ///< what is odd about the file's columns; may be empty
  std::optional<FittedTable> table;  ///< nothing where a certificate was read
};

/// Reads a certificate with a law in time, or fits a move to a table.
/// @param rounding  of a table's rows; it has to be stated for a table, and for no certificate
/// @throws InputError, also where no move that begins and ends at rest is within the rounding of all rows.
[[nodiscard]] MoveSource read_move(const Problem& problem, const PathInput& input,
                                   const std::optional<TableRounding>& rounding);

/// "All 1451 rows lie within 0.1 mm and 0.01 deg of this move at their times …": what is proved of a table, and what is
/// not.
[[nodiscard]] std::string row_sentence(const FittedTable& table);
[[nodiscard]] nlohmann::json to_json(const FittedTable& table);

/// Throws unless a request for an audit in time goes with the case. @param option  how the user asked for it
void require_timed(const AuditRequest& request, const Case& the_case, const std::string& option);

struct TimedAudit {
  std::string text;  ///< of certificate.json
  checker::CheckResult checked;
  Certificate certificate;            ///< what `text` says
  std::optional<double> witness_s{};  ///< at which time a refuted move is refuted first
  double prove_seconds = 0;
  bool interrupted = false;  ///< then nothing else is meant
};

struct TimedAuditOptions {
  long max_bits = 4096;
  const SigningKey* key = nullptr;     ///< null: the certificate is not signed
  double max_seconds = kCheckSeconds;  ///< that the checker may take
};

/// Proves the move and has the checker prove it again. @throws InputError; std::logic_error where the checker rejects
/// it
[[nodiscard]] TimedAudit audit_move(const MoveSource& source, const Case& the_case, const TimedAuditOptions& options,
                                    const std::stop_token& stop);

}  // namespace taut
