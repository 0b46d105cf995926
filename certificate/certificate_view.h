// SPDX-License-Identifier: GPL-3.0-or-later
// A certificate as the report reads it (docs/certificate-format.md): types instead of JSON, nothing checked but its
// form. What it claims is no verdict: a ReportContext shows it only where the checker has made a theorem of it. Numbers that
// the report only prints stay the strings that they are.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "certify/arithmetic/dyadic.h"
#include "kinematics/segment.h"
#include "problem/problem.h"

namespace taut {

struct MarginsView {
  std::string tension_N;
  std::string length_m;
  std::string wrench_scale;
};

struct SegmentView {
  int from = 0;
  int to = 0;
  std::size_t boxes = 0;
  MarginsView margins;
};

/// A point of the path: waypoint `index`, or s on segment `index`.
struct PathPointView {
  int index = 0;
  std::optional<std::string> s;  ///< dyadic; absent at a waypoint
  double position = 0;           ///< index + s, approximately
};

struct WitnessView {
  std::string kind;
  PathPointView at;
  std::optional<PathPointView> to;  ///< kind "singular" only; the rest is then empty
  int cable = 0;                    ///< 1…6
  std::string value_lower;
  std::string value_upper;
  std::string limit;
  bool deviates = false;           ///< the machine is not the stated one, but within the tolerances
  bool uses_continuation = false;  ///< its lengths hold it where its deviation leads
};

/// Where an audited path is not proved.
struct StretchView {
  PathPointView begin;
  PathPointView end;
  std::optional<WitnessView> first;  ///< the first and the last proved violation; none of an open stretch
  std::optional<WitnessView> last;
  std::string reason;  ///< only of an open stretch
};

struct UndecidedView {
  std::string reason;
  std::optional<int> segment;
  std::string box_lower;
  std::string box_upper;
  double lower = 0;  ///< of the box, approximately
  double upper = 1;
};

/// How far a tolerance could grow alone; as printed.
struct ToleranceLimitView {
  std::string tolerance;  ///< key of the case file
  std::string proved;
  std::string unit;
};

/// Polygon of a chart in the plane of the parameters.
struct ChartView {
  std::vector<double> centre;
  std::vector<std::array<double, 2>> corners;
};

struct CertificateView {
  std::string generator;  ///< name and version
  std::string verdict;    ///< "proved", "refuted" or "undecided"; "unchecked" where nobody knows (ReportContext)
  std::string claim;
  Problem problem;
  Path path;
  std::string interpolation;
  std::string problem_sha256;
  std::string path_sha256;
  std::string footer_sha256;
  std::size_t boxes = 0;
  std::vector<SegmentView> segments;
  /// The boxes of each segment, without those that are none of the form [k/2^d, (k+1)/2^d], which taut does not write.
  std::vector<std::vector<DyadicBox>> segment_boxes;
  std::optional<MarginsView> margins;
  std::optional<WitnessView> witness;
  std::optional<UndecidedView> undecided;
  std::vector<StretchView> stretches;  ///< of an audit that is not proved
  std::vector<ToleranceLimitView> tolerance_limits;
  std::vector<ChartView> charts;
  std::map<std::string, std::string> stats;  ///< of the search, as printed
};

/// Whether a planner found no path: then the certificate's path is the query's waypoints alone.
[[nodiscard]] inline bool found_no_path(const CertificateView& view) {
  return view.undecided && !view.undecided->segment && view.stretches.empty();
}

/// @throws InputError for a missing key or a wrong type. Does not compare digests: that is taut-check's.
[[nodiscard]] CertificateView read_certificate(const nlohmann::json& certificate);

}  // namespace taut
