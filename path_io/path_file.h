// SPDX-License-Identifier: GPL-3.0-or-later
// Path files: the poses that another program planned, one row at a time (docs/audits.md).
//
// Formats, told apart by the first line that is neither blank nor a comment:
//   a table           a header of named columns with units, then numbers; commas, semicolons or tabs. Columns are either the case's own
//                     parameters, or px py pz phi theta sigma, or px py pz qx qy qz qw, or cable lengths l1 … l6 (also d1 … d6)
//                     with, in its first row, the pose to start from; and a time t (also time), if there is one.
//   TUM               eight numbers between blanks: time [s], position [m], quaternion x y z w; no header
//   taut's path.csv   waypoint (or control_point), x.NAME, half_turns.NAME: what `taut plan` writes, bit for bit
// The names .csv and .tsv stand for tables, .tum for TUM; any other name for either. Certificates are no tables: is_certificate_name().
//
// Each number is read exactly, scaled exactly by its unit, and moved to the nearest binary64 once (nearest_si.h). Memory doesn't
// depend on the number of rows.
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "problem/decimal.h"
#include "problem/nearest_si.h"
#include "problem/problem.h"

namespace taut {

enum class PathFormat { kTable, kTum, kTautWaypoints, kTautControlPoints };

/// What the numbers of a row are coordinates of, and in which order.
enum class PathForm {
  kParameters,  ///< the case's own parameters
  kAngles,      ///< px, py, pz [m], phi, theta, sigma [rad]
  kQuaternion,  ///< px, py, pz [m], qx, qy, qz, qw: the rotation R(q)/|q|^2, so q and −q are one pose; | |q| − 1 | <= 1e-3
  kCableLengths,  ///< l1 … l6 [m]
};

inline constexpr double kNormTolerance = 1e-3;  ///< of quaternions; exporters write three digits at least
inline constexpr std::array<const char*, 7> kQuaternionNames = {"px", "py", "pz", "qx", "qy", "qz", "qw"};
inline constexpr std::array<const char*, 6> kLengthNames = {"l1", "l2", "l3", "l4", "l5", "l6"};

/// A coordinate as the file gives it.
struct PathColumn {
  std::string name;
  std::string unit;     ///< as typed; empty if it has none
  double per_unit = 1;  ///< about so many in SI
};

/// What the file says of its columns.
struct PathHeader {
  PathFormat format = PathFormat::kTable;
  PathForm form = PathForm::kParameters;
  std::vector<PathColumn> coordinates;  ///< in the form's order
  std::optional<PathColumn> time;
  /// Of a table of cable lengths, the form of its first row's pose; nothing if it has none.
  std::optional<PathForm> start;
};

struct PathRow {
  std::size_t line = 0;           ///< of the file, from 1
  std::optional<Decimal> time_s;  ///< exactly what was typed, later than the row before
  std::vector<double> x;          ///< the form's coordinates, nearest binary64 of their values in SI
  std::vector<int> half_turns;  ///< λ_j = x_j + π half_turns_j; not 0 only for periodic parameters of taut's own files
  bool operator==(const PathRow&) const = default;
};

struct PathFileOptions {
  /// Rows that repeat the pose of the row before are dropped; else an error, since they usually mean a broken export. taut's own
  /// files may repeat waypoints and control points in any case.
  bool allow_repeats = false;
};

/// Reads from first row to last. Every fault of the file is an InputError with file, line, column, the value seen and what
/// was expected.
class PathFile {
 public:
  /// Opens the file and reads its header. @throws InputError
  PathFile(const std::string& path, const SpaceText& space, PathFileOptions options = {});
  /// As above, from a stream; `name` stands for the file in messages.
  PathFile(std::unique_ptr<std::istream> text, const std::string& name, const SpaceText& space,
           PathFileOptions options = {});
  ~PathFile();
  PathFile(PathFile&&) noexcept;
  PathFile(const PathFile&) = delete;
  PathFile& operator=(const PathFile&) = delete;
  PathFile& operator=(PathFile&&) = delete;

  [[nodiscard]] const PathHeader& header() const;

  /// Reads the next row into `row`; false behind the last, of which there is at least one. @throws InputError
  [[nodiscard]] bool next(PathRow& row);

  /// Of a table of cable lengths with a pose in its first row: its coordinates in header().start's order and SI. Known once
  /// the first row was read; else empty.
  [[nodiscard]] const std::vector<double>& start() const;

  [[nodiscard]] std::size_t repeats_dropped() const;
  [[nodiscard]] std::uintmax_t bytes_read() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> self_;
};

/// The last line of path.csv: a comment that names the certificate with which it was written by the SHA-256 of its
/// bytes.
[[nodiscard]] std::string certificate_line(std::string_view sha256);
/// The SHA-256 in such a line of a path file's text; empty where it has none.
[[nodiscard]] std::string named_certificate(std::string_view text);

/// Whether a file of this name is to be read as a certificate: NAME.json.
[[nodiscard]] bool is_certificate_name(std::string_view path);

}  // namespace taut
