// SPDX-License-Identifier: GPL-3.0-or-later
// Cables and force densities at a pose (design: no square root but in the lengths).
//
//   d_i = p + R b_i − a_i                                                    cable vector A_i→B_i                 (1)
//   D   = columns (d_i ; (R (b_i − p_m)) × d_i)                              force-density matrix about P_m
//   D λ = w,  f_i = d_i λ_i                                                  equilibrium in the load frame F3     (4)
//
// J = D diag(1/d_i), so J is non-singular exactly where D is and all lengths are positive. D is polynomial in p and R.
// The scalar S of the pose may be a centred form or a dual number over the model's scalar K.
#pragma once

#include <algorithm>
#include <cmath>

#include "kinematics/model.h"

namespace taut {

template <class S>
struct CableGeometry {
  std::array<Vector3<S>, kCables> p_AB_W;  ///< d_i, axes of W [m]
  Matrix6<S> force_density;                ///< D
};

/// Rz(first) Ry(second) Rz(third).
template <class S>
[[nodiscard]] Matrix3<S> rotation_zyz(const S& first, const S& second, const S& third) {
  const SinCos<S> f = sincos(first);
  const SinCos<S> t = sincos(second);
  const SinCos<S> g = sincos(third);
  const S cf_ct = f.cos * t.cos;
  const S sf_ct = f.sin * t.cos;
  Matrix3<S> r_WP;
  r_WP(0, 0) = cf_ct * g.cos - f.sin * g.sin;
  r_WP(0, 1) = -(cf_ct * g.sin) - f.sin * g.cos;
  r_WP(0, 2) = f.cos * t.sin;
  r_WP(1, 0) = sf_ct * g.cos + f.cos * g.sin;
  r_WP(1, 1) = f.cos * g.cos - sf_ct * g.sin;
  r_WP(1, 2) = f.sin * t.sin;
  r_WP(2, 0) = -(t.sin * g.cos);
  r_WP(2, 1) = t.sin * g.sin;
  r_WP(2, 2) = t.cos;
  return r_WP;
}

/// Rz(phi) Ry(theta) Rz(sigma − phi).
template <class S>
[[nodiscard]] Matrix3<S> rotation(const S& phi, const S& theta, const S& sigma) {
  return rotation_zyz<S>(phi, theta, sigma - phi);
}

/// Rz(yaw) Ry(pitch) Rx(roll).
template <class S>
[[nodiscard]] Matrix3<S> rotation_zyx(const S& yaw, const S& pitch, const S& roll) {
  const SinCos<S> y = sincos(yaw);
  const SinCos<S> p = sincos(pitch);
  const SinCos<S> r = sincos(roll);
  const S cy_sp = y.cos * p.sin;
  const S sy_sp = y.sin * p.sin;
  Matrix3<S> r_WP;
  r_WP(0, 0) = y.cos * p.cos;
  r_WP(0, 1) = cy_sp * r.sin - y.sin * r.cos;
  r_WP(0, 2) = cy_sp * r.cos + y.sin * r.sin;
  r_WP(1, 0) = y.sin * p.cos;
  r_WP(1, 1) = sy_sp * r.sin + y.cos * r.cos;
  r_WP(1, 2) = sy_sp * r.cos - y.cos * r.sin;
  r_WP(2, 0) = -p.sin;
  r_WP(2, 1) = p.cos * r.sin;
  r_WP(2, 2) = p.cos * r.cos;
  return r_WP;
}

/// By `turn` about the axis of `angles`: 1 + sin(turn) [n] + (1 − cos(turn)) [n]².
template <class S, class K>
[[nodiscard]] Matrix3<S> rotation_about_axis(const Angles<K>& angles, const S& turn) {
  const SinCos<S> t = sincos(turn);
  const S versine = -t.cos + K(1.0);
  Matrix3<S> r_WP;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const S bend = versine * angles.square(i, j);
      r_WP(i, j) = i == j ? S(bend + K(1.0)) : S(bend + t.sin * angles.cross(i, j));
    }
  }
  return r_WP;
}

/// R_WP of a pose's angles.
template <class S, class K>
[[nodiscard]] Matrix3<S> rotation(const Angles<K>& angles, const std::array<S, 3>& x) {
  switch (angles.kind) {
    case AngleKind::kTiltAndTorsion: break;
    case AngleKind::kRollPitchYaw: return rotation_zyx(x[2], x[1], x[0]);
    case AngleKind::kZyz: return rotation_zyz(x[0], x[1], x[2]);
    case AngleKind::kAxis: return rotation_about_axis(angles, x[0]);
  }
  return rotation(x[0], x[1], x[2]);
}

template <class S, class K>
[[nodiscard]] CableGeometry<S> cable_geometry(const Model<K>& model, const Vector3<S>& p_WP, const Matrix3<S>& r_WP) {
  CableGeometry<S> g;
  for (int i = 0; i < kCables; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Vector3<K>& b = model.p_PB[n];
    const Vector3<K>& m = model.p_MB[n];
    Vector3<S>& d = g.p_AB_W[n];
    Vector3<S> arm;  // R (b_i − p_m): from P_m to B_i, axes of W
    for (int axis = 0; axis < 3; ++axis) {
      arm(axis) = r_WP(axis, 0) * m(0) + r_WP(axis, 1) * m(1) + r_WP(axis, 2) * m(2);
      const S reach = r_WP(axis, 0) * b(0) + r_WP(axis, 1) * b(1) + r_WP(axis, 2) * b(2);
      d(axis) = p_WP(axis) - model.p_WA[n](axis) + reach;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int j = (axis + 1) % 3;
      const int k = (axis + 2) % 3;
      g.force_density(axis, i) = d(axis);
      g.force_density(3 + axis, i) = arm(j) * d(k) - arm(k) * d(j);
    }
  }
  return g;
}

template <class S, class K>
[[nodiscard]] CableGeometry<S> cable_geometry(const Model<K>& model, const Pose<S>& pose) {
  return cable_geometry(model, pose.p_WP, rotation(model.angles, pose.angles));
}

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> cross(const Vector3<S>& a, const Vector3<S>& b) {
  return {a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
}

template <class S>
[[nodiscard]] S length(const Vector3<S>& d) {
  return sqrt(sqr(d(0)) + sqr(d(1)) + sqr(d(2)));
}

/// The angle ‖log(aᵀ b)‖ between two orientations [rad], from the chord ‖a − b‖_F = 2√2 sin(angle/2).
[[nodiscard]] inline double rotation_angle(const Matrix3<double>& a, const Matrix3<double>& b) {
  constexpr double kTwoRootsOfTwo = 2.8284271247461903;
  return 2.0 * std::asin(std::min(1.0, (a - b).norm() / kTwoRootsOfTwo));
}

}  // namespace taut
