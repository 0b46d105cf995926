// SPDX-License-Identifier: GPL-3.0-or-later
// One audit: every segment of a path that something else made, proved or not, and where not.
//
// Waypoints are read, segments are proved on all cores, and what comes out is written, all at once and in batches: memory does
// not grow with the path.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "app/path_source.h"
#include "certificate/certificate_stream.h"
#include "certify/path_proof.h"

namespace taut {

/// A place on the path, and where that is in the file.
struct AuditPlace {
  std::size_t segment = 0;
  Dyadic s;
  std::size_t line_before = 0, line_behind = 0;  ///< of the file, see PathSource::place_name(); equal at a waypoint
  std::optional<double> time_s;                  ///< if the file has times, interpolated between them
};

/// A piece of the path that was not proved.
struct AuditStretch {
  AuditPlace begin, end;                                     ///< outside of them the path is proved
  std::optional<std::pair<PathWitness, PathWitness>> inner;  ///< the first and the last proved violation in it
  std::pair<nlohmann::json, nlohmann::json> inner_json;      ///< these, as the certificate states them
  std::optional<std::pair<AuditPlace, AuditPlace>> inner_places;
  Reason reason;  ///< of a stretch without violations: why it is open
};

struct Audit {
  /// Stretches that are kept here; the certificate has all.
  static constexpr std::size_t kMaxListed = 1000;

  Verdict verdict = Verdict::kUndecided;
  bool interrupted = false;  ///< then nothing else is meant
  std::size_t segments = 0;
  std::size_t boxes = 0;
  long boxes_judged = 0;
  std::optional<Margins> margins;       ///< of the whole path; only if proved
  std::size_t stretches_violated = 0;   ///< with a proved violation
  std::size_t stretches_open = 0;       ///< without
  std::vector<AuditStretch> stretches;  ///< the first of them
  double seconds = 0;
};

/// Receives a file, piece by piece.
using WriteText = CertificateStream::Write;
using AuditProgress = std::function<void(std::size_t segments_done)>;

/// Audits all of `source`; what was written is of no use if it was interrupted.
/// @param certificate  takes the path and its segments, and still has to be finished
/// @param csv          takes all of path.csv
/// @throws InputError as PathSource::next(), and where a file can't be written.
[[nodiscard]] Audit audit(const Prover& prover, PathSource& source, CertificateStream& certificate,
                          const WriteText& csv, const AuditProgress& progress, const std::stop_token& stop);

/// What a certificate's `undecided` says; null unless the audit is undecided.
[[nodiscard]] nlohmann::json undecided_json(const Audit& audit);

}  // namespace taut
