// SPDX-License-Identifier: GPL-3.0-or-later
// The motion of an edge, in binary64: straight in the parameters or, in a space with constraints, what segment.h makes
// of that.
#pragma once

#include "atlas/manifold.h"
#include "kinematics/pose_sampler.h"

namespace taut {

class EdgeMotion {
 public:
  /// From a to b; `sampler` has to outlive this.
  EdgeMotion(const PoseSampler& sampler, const Coordinates& a, const Coordinates& b);

  /// At s from 0 to 1. With constraints: the pose on them; not-a-number where none is found.
  [[nodiscard]] Pose<double> pose(double s) const;
  /// Whether a proof is likely to find one motion in a tube around the edge's line: not where the constraints bend so
  /// much along the edge that Newton's matrix varies across the tube. True without constraints.
  [[nodiscard]] bool looks_single() const;

 private:
  [[nodiscard]] ConstraintFunctions::Vector line(double s) const { return start_ + s * step_; }
  [[nodiscard]] ConstraintFunctions::Jacobian normals(double s) const { return start_normals_ + s * normals_step_; }

  const PoseSampler& sampler_;
  Coordinates start_;
  Coordinates step_;
  ConstraintFunctions::Jacobian start_normals_;  ///< only with constraints
  ConstraintFunctions::Jacobian normals_step_;
};

}  // namespace taut
