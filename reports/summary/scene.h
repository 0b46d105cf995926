// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that a report is made from: the certificate, and floating-point samples of its path.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "certify/box_ranges.h"
#include "checker/check.h"
#include "reports/summary/body_distances.h"
#include "reports/summary/illustration.h"
#include "reports/summary/report_options.h"
#include "reports/summary/samples.h"
#include "reports/summary/shown_bodies.h"
#include "reports/summary/travel.h"

namespace taut {

struct ReportContext {
  /// From what the checker said of a certificate: with a verdict where it made a theorem.
  /// @throws InputError where a report can't show what is in it. @pre the outcome is neither rejected nor malformed.
  explicit ReportContext(const checker::CheckResult& checked);
  /// Unless confirmed, all claims are taken out of the certificate.
  ReportContext(Certificate stated, Recheck checked);

  Recheck recheck;
  Certificate certificate;
  std::string verdict;  ///< "proved" or "refuted" where the checker confirmed that, else "undecided" or "unchecked"
  Illustration illustration;
  std::vector<std::vector<DyadicBox>> boxes;  ///< of each segment
  Sampler sampler;
  std::vector<PathSample> samples;                ///< along the whole path
  std::optional<BodyDistances> bodies;            ///< in floating point; where the problem has bodies
  DistancesAlong distances;                       ///< of them at `samples`
  std::map<std::string, ShownBody> shown_meshes;  ///< the meshes that were checked, by their bodies' names
  Travel travel;                                  ///< how far into the move a place is
  /// Enclosures over the certificate's boxes, computed anew without floating point, and no wider than the margins that
  /// the certificate states of each segment: proved where the certificate is right.
  PathRanges ranges;
  /// Whether they are those of the whole path: the boxes leave no gaps, and all of them were enclosed.
  bool ranges_are_whole = false;
  /// Of a refuted move: the gravest violation that the checker confirmed of it, whichever the certificate names first.
  /// Where poses are implied it is the certificate's own witness, as the move is proved to lead to that one only.
  std::optional<Witness> gravest;
};

/// Whether a planner found no path: then the certificate's path is the query's waypoints alone.
[[nodiscard]] bool found_no_path(const Certificate& certificate);
/// Whether poses are implied, by constraints or lengths of cables. What is proved behind the certificate's witness is
/// then about the only pose in each tube that the certificate states, and not that the move leads there (theory.md, 8).
[[nodiscard]] bool is_implied(const Certificate& certificate);
/// A point of the path as a number that counts segments: k + s is the point s of segment k.
[[nodiscard]] double position(const PathPoint& point);

/// "rad", "m" or "": the unit of parameter j, where it can be told.
[[nodiscard]] std::string unit(const SpaceText& space, std::size_t j);
/// The unit in brackets, "[rad]"; nothing for "".
[[nodiscard]] std::string in_brackets(const std::string& unit);

}  // namespace taut
