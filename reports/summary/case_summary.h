// SPDX-License-Identifier: GPL-3.0-or-later
// A summary of a case as taut understands it: robot, load, space, and each waypoint of its query with lengths, tensions
// and margins. The case's numbers are exact. Those computed from them are floating point and prove nothing.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "case/case_of_legs.h"
#include "kinematics/pose_sampler.h"
#include "reports/summary/body_distances.h"

namespace taut {

/// A waypoint of the query in floating point.
struct WaypointSummary {
  std::vector<double> parameters;  ///< SI
  Pose<double> pose;
  Statics<double> statics;
  double wrench_scale =
      0;  ///< by how much K could grow before a tension reaches a limit; below 1, the waypoint is infeasible
  std::vector<BodyDistance> nearest;  ///< pairs of bodies, those with the least left first; at most kNearestPairs
};

/// The distance of cable i from the nearer of its two limits, negative beyond one. Tensions include all loads in K.
[[nodiscard]] double tension_margin(const Model<double>& model, const Statics<double>& statics,
                                    std::size_t i);                                                             ///< [N]
[[nodiscard]] double length_margin(const Model<double>& model, const Statics<double>& statics, std::size_t i);  ///< [m]

inline constexpr std::size_t kNearestPairs = 5;

struct CaseSummary {
  explicit CaseSummary(const Case& the_case);

  const Case& source;
  PoseSampler sampler;
  std::optional<BodyDistances> bodies;     ///< if the case has bodies
  std::vector<WaypointSummary> waypoints;  ///< of the query
};

/// The summary as text for people; lengths are in the case's own unit.
[[nodiscard]] std::string to_text(const CaseSummary& summary);
/// Of each leg, in their order; of a case without legs its own alone. They refer to the case.
[[nodiscard]] std::vector<CaseSummary> summaries_of(const CaseOfLegs& the_case);
/// The same of a case of legs: what is one for all, then of each leg its load, its bodies and its waypoints.
/// @param summaries  summaries_of(the_case)
[[nodiscard]] std::string to_text(const CaseOfLegs& the_case, std::span<const CaseSummary> summaries);
/// The summary for programs: `problem` exactly as in a certificate (SI), and `waypoints` in floating point.
[[nodiscard]] nlohmann::json to_json(const CaseSummary& summary);
/// Of a case of legs `legs`, of each its `name` and as `case` the summary of it. Parameters as of to_text().
[[nodiscard]] nlohmann::json to_json(const CaseOfLegs& the_case, std::span<const CaseSummary> summaries);

}  // namespace taut
