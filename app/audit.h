// SPDX-License-Identifier: GPL-3.0-or-later
// Audits a path that something else made: proves every segment of it or says where it is not proved, and writes the
// certificate.
//
// Waypoints are read, segments are proved on all cores, and what comes out is written, all at once and in batches, so
// that memory does not grow with the path.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "app/as_items.h"
#include "app/path_source.h"
#include "case/case_file.h"
#include "certificate/certificate_writer.h"
#include "certificate/signature.h"
#include "certify/headroom.h"
#include "reports/summary/file_lines.h"

namespace taut {

/// For longer paths it is not sought what stands in the way or how far the proof reaches, which takes some tens of
/// proofs and all of the path in memory; nor is a report made of them unless somebody asks for one. Their least margins
/// are stated less sharply, too.
inline constexpr std::size_t kMostReported = 20'000;

/// The laws that may be asked for, by their names.
[[nodiscard]] const std::map<std::string, Interpolation>& audit_laws();

/// Which path is audited, and how it is read.
struct AuditRequest {
  PathInput path = std::string();              ///< without a name: that of the case
  std::optional<Interpolation> law;            ///< nothing: as the file suggests
  bool timed = false;                          ///< as a move in time (timed_audit.h)
  std::optional<TableRounding> rounding = {};  ///< of a table's rows, where it is timed
};

/// Completes a request that names no path by what the case's own `audit` says.
/// @param case_path  the case's file
/// @throws InputError where the case has none.
[[nodiscard]] AuditRequest resolved(AuditRequest request, const Case& the_case, const std::string& case_path);

struct AuditOptions {
  const Case& the_case;             ///< what the report says of it, beside the problem
  Decoration decoration{};          ///< for the report's pictures: what read_meshes() makes of the case's
  long max_bits = 4096;             ///< the greatest precision of the prover
  std::filesystem::path folder;     ///< for temporary files
  const SigningKey* key = nullptr;  ///< null: the certificate is not signed
  double headroom_seconds = 0;      ///< that find_headroom() may take; 0: it is not sought
  HeadroomProgress headroom_progress = {};
};

/// Where in a path file a point of the path is.
struct FilePlace {
  std::size_t line_before = 0, line_behind = 0;  ///< see PathSource::place_name(); equal at a waypoint
  std::optional<double> time_s;                  ///< if the file has times, interpolated between them
};

/// A stretch, and where its points are in the file.
struct AuditedStretch {
  Stretch stretch;
  FilePlace begin, end;
  FilePlace first, last;  ///< of the violations, if there are any
};

struct Audit {
  /// Stretches that are kept here; the certificate has all.
  static constexpr std::size_t kMaxListed = 1000;

  Verdict verdict = Verdict::kUndecided;
  bool interrupted = false;  ///< then nothing else is meant, and what was written is of no use
  std::size_t segments = 0;
  std::size_t boxes = 0;
  long boxes_judged = 0;
  std::optional<Margins> margins;         ///< of the whole path; only if proved
  std::size_t stretches_violated = 0;     ///< with a proved violation
  std::size_t stretches_open = 0;         ///< without
  std::vector<AuditedStretch> stretches;  ///< the first of them
  std::optional<Witness> witness{};       ///< of the certificate, if the path is refuted
  FilePlace witness_place{};              ///< of its `at`
  bool witness_is_gravest = false;        ///< of all that were found; else the first, as the motion is implied
  std::optional<Headroom> headroom{};     ///< where it was sought
  std::optional<AsItems> as_items{};      ///< of an ellipsoid around items, where headroom was sought
  FileLines lines{};                      ///< on which its waypoints stand; none where the path is a certificate's
  double seconds = 0;
};

/// Receives a file, piece by piece.
using WriteText = CertificateWriter::Write;
using AuditProgress = std::function<void(std::size_t segments_done)>;

/// Audits all of `source`.
/// @param source       at its first waypoint
/// @param certificate  takes the text of certificate.json
/// @param csv          takes the text of path.csv
/// @throws InputError as PathSource::next(), and where a file can't be written.
[[nodiscard]] Audit audit_path(PathSource& source, const AuditOptions& options, const WriteText& certificate,
                               const WriteText& csv, const AuditProgress& progress, const std::stop_token& stop);

}  // namespace taut
