// SPDX-License-Identifier: GPL-3.0-or-later
// What a case was understood to say: robot, load, space, and each waypoint of its query with lengths, tensions and margins. Numbers of
// the case are exact; what is computed from them is floating point, and no verdict: nothing here is proved.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "case/case_file.h"
#include "kinematics/pose_sampler.h"

namespace taut {

/// A waypoint of the query in floating point.
struct WaypointSummary {
  std::vector<double> parameters;  ///< SI
  Pose<double> pose;
  Statics<double> statics;
  double wrench_scale =
      0;  ///< by how much K could grow before a tension reaches a limit; below 1, the waypoint is infeasible
};

/// By how much a waypoint keeps the limits of cable i, the nearer of the two; negative beyond one. Tensions with all loads in K.
[[nodiscard]] double tension_margin(const Model<double>& model, const Statics<double>& statics,
                                    std::size_t i);                                                             ///< [N]
[[nodiscard]] double length_margin(const Model<double>& model, const Statics<double>& statics, std::size_t i);  ///< [m]

struct CaseSummary {
  explicit CaseSummary(const Case& the_case);

  const Case& source;
  PoseSampler sampler;
  std::vector<WaypointSummary> waypoints;  ///< of the query
};

/// For people; lengths in the case's own unit.
[[nodiscard]] std::string to_text(const CaseSummary& summary);
/// For machines: `problem` exactly as a certificate has it (SI), and `waypoints` in floating point.
[[nodiscard]] nlohmann::json to_json(const CaseSummary& summary);

}  // namespace taut
