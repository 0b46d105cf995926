// SPDX-License-Identifier: GPL-3.0-or-later
// A problem in binary64: poses, statics and distances to the limits at points of its space.
//
// For what proposes and what draws; nothing here is proved.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kinematics/constraint_functions.h"
#include "kinematics/pose_conversion.h"
#include "kinematics/segment.h"
#include "kinematics/statics.h"

namespace taut {

class PoseSampler {
 public:
  /// @throws InputError if the problem has no model in doubles.
  explicit PoseSampler(const Problem& problem);

  [[nodiscard]] const Model<double>& model() const { return model_; }
  [[nodiscard]] const ExpressionTape& tape() const { return tape_; }  ///< of the pose

  /// Only in a space with constraints.
  [[nodiscard]] const std::optional<ConstraintFunctions>& constraints() const { return constraints_; }

  /// Parameters of the motion (segment.h) at s: on the constraints, where the space has some and Newton's method finds
  /// them. Under a law with poses px … sigma; of cable lengths, the pose that Newton's method finds from the reference.
  [[nodiscard]] std::vector<double> parameters(const Segment& segment, double s) const;

  [[nodiscard]] Pose<double> pose(std::span<const double> parameters) const { return evaluate_pose(pose_, parameters); }
  /// The pose that a path through parameters reaches at a waypoint.
  [[nodiscard]] Pose<double> pose(const Waypoint& waypoint) const {
    return pose(parameters(Segment::straight(waypoint, waypoint), 0));
  }
  /// Of the motion under any law: where lengths are straight, the pose that has them (the reference, if none is found).
  [[nodiscard]] RigidPose rigid_pose(const Segment& segment, double s) const;
  /// How far the pose on the constraints at a segment's begin, or its end, is beyond those of the control points that
  /// matter there (one of a straight segment, three of a spline's): the largest difference of a coordinate, positions
  /// over the platform's size (mean |b_i|), or angle [rad]. 0 without constraints, and where no pose on them is found.
  [[nodiscard]] double distance_to_constraints(const Segment& segment, bool at_end) const;

  [[nodiscard]] Matrix3<double> rotation(const Pose<double>& pose) const {
    return taut::rotation(model_.angles, pose.angles);
  }
  [[nodiscard]] RigidPose rigid_pose(const Pose<double>& pose) const { return taut::rigid_pose(model_.angles, pose); }

  [[nodiscard]] Statics<double> statics(const RigidPose& pose) const {
    return taut::statics(model_, pose.p, Matrix3<double>(pose.q.toRotationMatrix()));
  }
  [[nodiscard]] Statics<double> statics(const Pose<double>& pose) const { return taut::statics(model_, pose); }

  /// The least distance to a limit of any cable, over half the range between the limits: 0 on a limit, negative beyond
  /// one or where J is singular.
  [[nodiscard]] double clearance(const Statics<double>& statics) const;

 private:
  Model<double> model_;
  ExpressionTape tape_;
  Evaluator<double> pose_;
  std::optional<ConstraintFunctions> constraints_;
};

}  // namespace taut
