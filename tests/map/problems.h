// SPDX-License-Identifier: GPL-3.0-or-later
// Problems whose spaces are mapped, and their poses in 200 bits.
#pragma once

#include <cstring>
#include <string>

#include "map/subdivision.h"
#include "tests/soundness/machine.h"
#include "tests/support/robots.h"

namespace taut::testing {

/// Bit for bit.
inline bool are_same(const CellMap& a, const CellMap& b) {
  return a.nodes.size() == b.nodes.size() && a.judged == b.judged && a.end == b.end && a.share == b.share &&
         a.tolerance_share == b.tolerance_share &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(MapNode)) == 0;
}

/// Robot 1 on the slice, with a load of items in place of its ellipsoid, or around it.
inline Problem robot1_with_items(bool with_ellipsoid) {
  Problem problem = robot1_slice();
  if (!with_ellipsoid) {
    problem.load.ellipsoid.reset();
    problem.load.wrench.fill("0");
  }
  problem.load.gravity_m_s2 = {"0", "0", "9.81"};
  const std::string mass = with_ellipsoid ? "0.003" : "0.1";
  problem.load.items = {{"platform", Weight{mass, mass + "1", {"0.03", "0.014", "-0.021"}, "0.001"}},
                        {"wind", Force{DiscOfVectors{"0.008", {"0", "0", "1"}}, Axes::kWorld, {"0.02", "0", "0"}}},
                        {"tool", Moment{SegmentOfVectors{{"0", "1", "0"}, "-0.0005", "0.001"}, Axes::kPlatform}}};
  validate(problem);
  return problem;
}

/// Robot 1 with tolerances, its pose or its lengths controlled.
inline Problem robot1_with_tolerances(bool length_controlled) {
  Problem problem = robot1_slice();
  TolerancesText tolerances;
  tolerances.base_anchor_m.fill("0.0001");
  tolerances.platform_anchor_m.fill("0.0001");
  tolerances.wrench = {"0", "0", "0.002", "0", "0", "0"};
  if (length_controlled) {
    tolerances.cable_length_m = {"0.0001", "0.0001", "0.0001", "0.0001", "0.0001", "0.0001"};
  } else {
    tolerances.position_m = "0.0003";
    tolerances.orientation_rad = "0.001";
  }
  problem.tolerances = tolerances;
  validate(problem);
  return problem;
}

/// Robot 1 with its torsion free, too.
inline Problem robot1_sigma_free() {
  Problem problem = robot1_slice();
  problem.space.parameters.push_back({"sigma", ParameterKind::kPeriodic, "", ""});
  problem.space.pose[5] = "sigma";
  for (auto& waypoint : problem.query) waypoint.push_back("0.6");
  validate(problem);
  return problem;
}

/// Poses of a map's cells.
class ExactPoses {
 public:
  ExactPoses(const Problem& problem, const MapSpace& space)
      : problem_(problem), space_(space), pose_(pose_tape(problem)) {}

  /// At t, one a coordinate. @pre in PrecisionScope(oracle::kBits)
  [[nodiscard]] campaign::RigidPose<BigFloat> at(const std::vector<double>& t) const {
    std::vector<MpInterval> parameters;
    for (std::size_t k = 0; k < t.size(); ++k) {
      const auto lower = evaluate_constant<MpInterval>(space_.axes[k].lower);
      const auto upper = evaluate_constant<MpInterval>(space_.axes[k].upper);
      parameters.push_back(lower + (upper - lower) * MpInterval(t[k]));
    }
    std::array<MpInterval, 6> x;
    pose_.evaluate(parameters, x);
    return {{x[0].lower(), x[1].lower(), x[2].lower()},
            campaign::orientation(problem_.space.angles, x[3].lower(), x[4].lower(), x[5].lower())};
  }

 private:
  const Problem& problem_;
  const MapSpace& space_;
  Evaluator<MpInterval> pose_;
};

}  // namespace taut::testing
