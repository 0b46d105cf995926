// SPDX-License-Identifier: GPL-3.0-or-later
// How the platform moves along its path: the pose and its first two derivatives by s, for any scalar.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kinematics/jet.h"
#include "kinematics/model.h"
#include "kinematics/moving_load.h"
#include "kinematics/segment.h"

namespace taut {

/// x, x' and x'' of a function of s: a jet of jets.
template <class S>
using SecondJet = Jet<Jet<S, 1>, 1>;

template <class S>
[[nodiscard]] SecondJet<S> second_jet(const S& x, const S& x1, const S& x2) {
  Jet<S, 1> value(x), slope(x1);
  value.partial[0] = x1;
  slope.partial[0] = x2;
  SecondJet<S> result(value);
  result.partial[0] = slope;
  return result;
}
template <class S>
[[nodiscard]] const S& value_of(const SecondJet<S>& x) {
  return x.value.value;
}
template <class S>
[[nodiscard]] const S& first_of(const SecondJet<S>& x) {
  return x.partial[0].value;
}
template <class S>
[[nodiscard]] const S& second_of(const SecondJet<S>& x) {
  return x.partial[0].partial[0];
}

/// A polynomial in s with its derivatives, for every s in `range`.
template <class S>
[[nodiscard]] SecondJet<S> second_jet(const Polynomial<S>& x, const S& range) {
  const S curvature = x.cubic ? S(x.c[2] + x.c[2] + range * (S(6.0) * x.c[3])) : S(0.0);
  return second_jet<S>(x.at(range), x.slope(range), curvature);
}

/// Of p(s) and R(s), and [w] = R' Rᵀ.
template <class S>
[[nodiscard]] PathRates<S> path_rates(const Vector3<SecondJet<S>>& p, const Matrix3<SecondJet<S>>& r) {
  PathRates<S> result;
  for (int k = 0; k < 3; ++k) {
    result.p(k) = value_of(p(k));
    result.p1(k) = first_of(p(k));
    result.p2(k) = second_of(p(k));
    for (int l = 0; l < 3; ++l) result.r_WP(k, l) = value_of(r(k, l));
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 2) % 3, j = (k + 1) % 3;
    result.w(k) = S(0.0);
    result.w1(k) = S(0.0);
    for (int l = 0; l < 3; ++l) {
      result.w(k) = result.w(k) + first_of(r(i, l)) * value_of(r(j, l));
      result.w1(k) = result.w1(k) + second_of(r(i, l)) * value_of(r(j, l)) + first_of(r(i, l)) * first_of(r(j, l));
    }
  }
  return result;
}

/// The poses of a space as functions of its parameters.
template <class S>
class PathRatesModel {
 public:
  /// At working_precision(). @throws InputError as make_model()
  explicit PathRatesModel(const Problem& problem)
      : pose_(pose_tape(problem)), angles_(make_angles<S>(problem.space.angles)) {}

  /// Where the parameters are these functions of s. For an enclosing scalar void if a fault was raised.
  [[nodiscard]] PathRates<S> of(std::span<const SecondJet<S>> parameters) const {
    const Pose<SecondJet<S>> pose = evaluate_pose(pose_, parameters);
    const Angles<Jet<S, 1>> angles = constant(angles_);
    return path_rates<S>(pose.p_WP, rotation(angles, pose.angles));
  }

  /// Along ℓ itself, for every s in `range` [0, 1]: the motion of a space without constraints.
  /// @pre the segment's law runs through parameters
  [[nodiscard]] PathRates<S> along_curve(const Segment& segment, const S& range) const {
    std::vector<SecondJet<S>> parameters;
    for (std::size_t j = 0; j < segment.control[0]->x.size(); ++j) {
      parameters.push_back(second_jet(coordinate_polynomial<S>(segment, j), range));
    }
    return of(parameters);
  }

 private:
  static Angles<Jet<S, 1>> constant(const Angles<S>& angles) {
    Angles<Jet<S, 1>> result;
    result.kind = angles.kind;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        result.cross(i, j) = Jet<S, 1>(angles.cross(i, j));
        result.square(i, j) = Jet<S, 1>(angles.square(i, j));
      }
    }
    return result;
  }

  Evaluator<SecondJet<S>> pose_;
  Angles<S> angles_;
};

}  // namespace taut
