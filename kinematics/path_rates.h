// SPDX-License-Identifier: GPL-3.0-or-later
// How the platform moves along its path: the pose and its first N derivatives by s, N being 2 or 3, for any scalar.
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <span>
#include <type_traits>

#include "kinematics/geometry.h"
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

/// w and its derivatives: value [n] is the n-th. R is a turn by x about a fixed axis, or Rz(f) Ry(t) R_e(g), where e is
/// the z or the x axis of P. These turns add up: w = f' e_z + t' a + g' c, with a = Rz(f) e_y, and c = R e, which the
/// first two carry.
/// @param r_WP  R, of these angles
template <int N, class S, class K>
[[nodiscard]] std::array<Vector3<S>, N> turning(const Angles<K>& angles, const std::array<Taylor<S, N>, 3>& x,
                                                const Matrix3<S>& r_WP) {
  static_assert(N == 2 || N == 3);
  std::array<Vector3<S>, N> w;
  if (angles.kind == AngleKind::kAxis) {
    for (int k = 0; k < 3; ++k) {
      const K& axis = angles.cross((k + 2) % 3, (k + 1) % 3);
      for (std::size_t n = 0; n < N; ++n) w[n](k) = S(axis) * x[0].d[n + 1];
    }
    return w;
  }
  const bool is_by_roll = angles.kind == AngleKind::kRollPitchYaw;
  const auto& [f, t, g] = is_by_roll                       ? std::array{x[2].d, x[1].d, x[0].d}
                          : angles.kind == AngleKind::kZyz ? std::array{x[0].d, x[1].d, x[2].d}
                                                           : std::array{x[0].d, x[1].d, (x[2] - x[0]).d};
  const SinCos<S> first = sincos(f[0]);
  const Vector3<S> c = r_WP.col(is_by_roll ? 0 : 2);
  // a and its derivatives: turned by a right angle, it is -h.
  const Vector3<S> a(-first.sin, first.cos, S(0.0)), h(first.cos, first.sin, S(0.0));
  std::array<Vector3<S>, N> u;  // f' e_z + t' a: how c turns
  const S f1_squared = sqr(f[1]);
  for (int k = 0; k < 2; ++k) {
    const S a1 = -(f[1] * h(k));
    u[0](k) = t[1] * a(k);
    u[1](k) = t[2] * a(k) + t[1] * a1;
    if constexpr (N == 3) {
      const S a2 = -(f[2] * h(k)) - f1_squared * a(k);
      u[2](k) = t[3] * a(k) + S(2.0) * (t[2] * a1) + t[1] * a2;
    }
  }
  for (std::size_t n = 0; n < N; ++n) u[n](2) = f[n + 1];
  const Vector3<S> c1 = cross(u[0], c);
  for (int k = 0; k < 3; ++k) {
    w[0](k) = u[0](k) + g[1] * c(k);
    w[1](k) = u[1](k) + g[2] * c(k) + g[1] * c1(k);
  }
  if constexpr (N == 3) {
    const Vector3<S> outer = cross(u[1], c), inner = cross(u[0], c1);
    for (int k = 0; k < 3; ++k) {
      w[2](k) = u[2](k) + g[3] * c(k) + S(2.0) * (g[2] * c1(k)) + g[1] * (outer(k) + inner(k));
    }
  }
  return w;
}

/// The poses of a space as functions of its parameters.
template <class S, int N>
class PathRatesModel {
 public:
  /// At working_precision(). @throws InputError as make_model()
  explicit PathRatesModel(const Problem& problem)
      : pose_(pose_tape(problem)), angles_(make_angles<S>(problem.space.angles)) {}

  /// Where the parameters are these functions of s. For an enclosing scalar void if a fault was raised.
  /// @param known  R, where it is known already
  [[nodiscard]] PathRatesOf<S, N> of(std::span<const Taylor<S, N>> parameters,
                                     const Matrix3<S>* known = nullptr) const {
    const Pose<Taylor<S, N>> pose = evaluate_pose(pose_, parameters);
    const auto& x = pose.angles;
    PathRatesOf<S, N> result;
    result.r_WP = known != nullptr ? *known : rotation(angles_, std::array<S, 3>{x[0].d[0], x[1].d[0], x[2].d[0]});
    const std::array<Vector3<S>, N> w = turning<N>(angles_, x, result.r_WP);
    result.w = w[0];
    result.w1 = w[1];
    if constexpr (N == 3) result.w2 = w[2];
    for (int k = 0; k < 3; ++k) {
      const auto& p = pose.p_WP(k).d;
      result.p(k) = p[0];
      result.p1(k) = p[1];
      result.p2(k) = p[2];
      if constexpr (N == 3) result.p3(k) = p[3];
    }
    return result;
  }

  /// Along ℓ itself, for every s in `range` [0, 1]: the motion of a space without constraints.
  /// @pre the segment's law runs through parameters
  [[nodiscard]] PathRatesOf<S, N> along_curve(const Segment& segment, const S& range,
                                              const Matrix3<S>* known = nullptr) const {
    boost::container::small_vector<Taylor<S, N>, kFewParameters> parameters;
    for (std::size_t j = 0; j < segment.control[0]->parameters().x.size(); ++j) {
      parameters.push_back(with_derivatives<N>(coordinate_polynomial<S>(segment, j), range));
    }
    return of(std::span<const Taylor<S, N>>(parameters.data(), parameters.size()), known);
  }

 private:
  static constexpr std::size_t kFewParameters = 8;  ///< which take no allocation

  Evaluator<Taylor<S, N>> pose_;
  Angles<S> angles_;
};

}  // namespace taut
