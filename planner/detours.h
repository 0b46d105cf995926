// SPDX-License-Identifier: GPL-3.0-or-later
// Points by which a path may go around what blocks the straight way to the goal.
//
// Often two long edges go around it. They cost a few dozen samples, while charts along an obstacle cost hundreds. The
// points are those of a low-discrepancy sequence around start and goal by which the way is short. Nobody has asked yet
// whether the machine can be there: an edge's samples say so.
#pragma once

#include <array>
#include <vector>

#include "kinematics/pose_sampler.h"
#include "planner/path_length.h"

namespace taut {

class Detours {
 public:
  /// In a space without constraints. All but `symmetry` have to outlive this.
  Detours(const SpaceText& space, const PoseSampler& sampler, const PathLength& length,
          const CoordinateSymmetry& symmetry);

  /// Points within the parameters' ranges by which start → point → goal is at most a quarter longer than the shortest
  /// motion without limits, by ascending length; lengths are estimated. The goal is its image nearest to the point.
  [[nodiscard]] std::vector<Coordinates> operator()(const Coordinates& start, const Coordinates& goal) const;

 private:
  using Range = std::array<double, 2>;
  [[nodiscard]] std::vector<Range> box_around(const Coordinates& start, const Coordinates& goal) const;
  [[nodiscard]] double rough_length(const Coordinates& a, const Coordinates& b) const;

  const SpaceText& space_;
  const PoseSampler& sampler_;
  const PathLength& length_;
  CoordinateSymmetry symmetry_;
};

}  // namespace taut
