// SPDX-License-Identifier: GPL-3.0-or-later
// The two reconstructed robots of the paper, as the cases under cases/ define them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "case/case_file.h"
#include "kinematics/segment.h"

namespace taut::testing {

/// Robot 1 on its orientation slice: parameters phi, theta.
inline Problem robot1_slice() { return load_case(TAUT_SOURCE_DIR "/cases/robot1-slice-qs-qg.yaml").problem; }

/// Robot 2 on the sphere of (16): parameters alpha1, alpha2.
inline Problem robot2_sphere() { return load_case(TAUT_SOURCE_DIR "/cases/robot2-sphere-q1-q2-q3.yaml").problem; }

/// Robot 2 on the same sphere given by constraints: p is on it, and the platform is normal to its radius. Parameters
/// px, py, pz, phi, theta and, if free, sigma.
inline Problem robot2_implicit_sphere(bool sigma_free) {
  Problem problem = robot2_sphere();
  problem.space = SpaceText{};
  const std::vector<std::string> names = pose_names(AngleKind::kTiltAndTorsion);
  for (std::size_t j = 0; j < 6; ++j) {
    const bool turns = j == 3 || j == 5;
    problem.space.pose[j] = names[j];
    if (j == 5 && !sigma_free) {
      problem.space.pose[j] = "0";
    } else {
      problem.space.parameters.push_back({names[j], turns ? ParameterKind::kPeriodic : ParameterKind::kReal, "", ""});
    }
  }
  problem.space.constraints = {"px + 0.13*sin(theta)*cos(phi)", "py + 0.13*sin(theta)*sin(phi)",
                               "pz - 0.306 + 0.13*cos(theta)"};
  return problem;
}

/// A waypoint without half turns.
inline Waypoint at(std::vector<double> x) {
  std::vector<int> none(x.size(), 0);
  return {std::move(x), std::move(none)};
}

/// The same robot and load with all six pose coordinates free.
inline Problem free_flying(Problem problem) {
  problem.space = SpaceText{};
  const std::vector<std::string> names = pose_names(AngleKind::kTiltAndTorsion);
  for (const std::string& name : names) problem.space.parameters.push_back({name, ParameterKind::kReal, "", ""});
  std::ranges::copy(names, problem.space.pose.begin());
  return problem;
}

}  // namespace taut::testing
