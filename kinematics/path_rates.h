// SPDX-License-Identifier: GPL-3.0-or-later
// How the platform moves along its path: the pose and its first N derivatives by s, N being 2 or 3, for any scalar.
#pragma once

#include <array>
#include <span>
#include <type_traits>
#include <vector>

#include "kinematics/model.h"
#include "kinematics/moving_load.h"
#include "kinematics/segment.h"
#include "kinematics/taylor.h"

namespace taut {

/// A polynomial in s with its derivatives, for every s in `range`.
template <int N, class S>
[[nodiscard]] Taylor<S, N> with_derivatives(const Polynomial<S>& x, const S& range) {
  std::array<S, N + 1> d;
  d[0] = x.at(range);
  d[1] = x.slope(range);
  if constexpr (N >= 2) d[2] = x.cubic ? S(x.c[2] + x.c[2] + range * (S(6.0) * x.c[3])) : S(0.0);
  if constexpr (N >= 3) d[3] = x.cubic ? S(S(6.0) * x.c[3]) : S(0.0);
  return Taylor<S, N>(d);
}

/// What is known from N derivatives.
template <class S, int N>
using PathRatesOf = std::conditional_t<N == 3, ThirdPathRates<S>, PathRates<S>>;

/// Of p(s) and R(s), with [w] = R' Rᵀ and its derivatives.
template <class S, int N>
[[nodiscard]] PathRatesOf<S, N> path_rates(const Vector3<Taylor<S, N>>& p, const Matrix3<Taylor<S, N>>& r) {
  PathRatesOf<S, N> result;
  for (int k = 0; k < 3; ++k) {
    result.p(k) = p(k).d[0];
    result.p1(k) = p(k).d[1];
    result.p2(k) = p(k).d[2];
    if constexpr (N == 3) result.p3(k) = p(k).d[3];
    for (int l = 0; l < 3; ++l) result.r_WP(k, l) = r(k, l).d[0];
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 2) % 3, j = (k + 1) % 3;
    S w(0.0), w1(0.0), w2(0.0);
    for (int l = 0; l < 3; ++l) {
      const auto &a = r(i, l).d, &b = r(j, l).d;
      w = w + a[1] * b[0];
      w1 = w1 + a[2] * b[0] + a[1] * b[1];
      if constexpr (N == 3) w2 = w2 + a[3] * b[0] + S(2.0) * (a[2] * b[1]) + a[1] * b[2];
    }
    result.w(k) = w;
    result.w1(k) = w1;
    if constexpr (N == 3) result.w2(k) = w2;
  }
  return result;
}

/// The poses of a space as functions of its parameters.
template <class S, int N>
class PathRatesModel {
 public:
  /// At working_precision(). @throws InputError as make_model()
  explicit PathRatesModel(const Problem& problem)
      : pose_(pose_tape(problem)), angles_(make_angles<S>(problem.space.angles)) {}

  /// Where the parameters are these functions of s. For an enclosing scalar void if a fault was raised.
  [[nodiscard]] PathRatesOf<S, N> of(std::span<const Taylor<S, N>> parameters) const {
    const Pose<Taylor<S, N>> pose = evaluate_pose(pose_, parameters);
    return path_rates<S, N>(pose.p_WP, rotation(angles_, pose.angles));
  }

  /// Along ℓ itself, for every s in `range` [0, 1]: the motion of a space without constraints.
  /// @pre the segment's law runs through parameters
  [[nodiscard]] PathRatesOf<S, N> along_curve(const Segment& segment, const S& range) const {
    std::vector<Taylor<S, N>> parameters;
    for (std::size_t j = 0; j < segment.control[0]->x.size(); ++j) {
      parameters.push_back(with_derivatives<N>(coordinate_polynomial<S>(segment, j), range));
    }
    return of(parameters);
  }

 private:
  Evaluator<Taylor<S, N>> pose_;
  Angles<S> angles_;
};

}  // namespace taut
