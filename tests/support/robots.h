// The two reconstructed robots of the paper, as the cases under cases/ define them.
#pragma once

#include <string>

#include "kinematics/case_file.h"

namespace taut::testing {

/// Robot 1 on its orientation slice: parameters phi, theta.
inline Problem robot1_slice() { return load_case(TAUT_SOURCE_DIR "/cases/robot1-slice-qs-qg.yaml").problem; }

/// Robot 2 on the sphere of (16): parameters alpha1, alpha2.
inline Problem robot2_sphere() { return load_case(TAUT_SOURCE_DIR "/cases/robot2-sphere-q1-q2-q3.yaml").problem; }

/// The same robot and load with all six pose coordinates free.
inline Problem free_flying(Problem problem) {
  problem.space = SpaceText{};
  for (const char* name : kPoseNames) problem.space.parameters.push_back({name, ParameterKind::kReal, "", ""});
  for (std::size_t j = 0; j < 6; ++j) problem.space.pose[j] = kPoseNames[j];
  return problem;
}

}  // namespace taut::testing
