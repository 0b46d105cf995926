// SPDX-License-Identifier: GPL-3.0-or-later
// What a rigid load does to the cables when it moves.
//
// The platform P moves in W: p(t), R(t), with the rates ṗ, p̈, ω, ω̇ (axes of W; Ṙ = [ω] R). A mass m whose centre of
// gravity is the point c of P has the acceleration
//   a = p̈ + ω̇ × r_c + ω × (ω × r_c),   r_c = R c,
// and with its inertia I about c (axes of P) the momenta of a body change by the wrench about the load point P_m
//   w_in = Σ ( m a ;  R (c − p_m) × m a + R I Rᵀ ω̇ + ω × R I Rᵀ ω ).
// The cables carry what acts from outside less this: D λ = w − w_in. docs/theory.md, "A load that moves".
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "kinematics/geometry.h"
#include "kinematics/model.h"

namespace taut {

/// How the platform moves at one place of a path, by the path's own parameter s: p' and p'', and with R' = [w] R the
/// rates w and w'.
template <class S>
struct PathRates {
  Matrix3<S> r_WP;
  Vector3<S> p, p1, p2;  ///< p, p', p'' [m]
  Vector3<S> w, w1;      ///< [rad], axes of W
};

/// With one derivative more.
template <class S>
struct ThirdPathRates : PathRates<S> {
  Vector3<S> p3, w2;  ///< p''' [m], w'' [rad]
};

/// The same by time.
template <class S>
struct Rates {
  Vector3<S> velocity, acceleration;                  ///< ṗ [m/s], p̈ [m/s²], of the platform's origin
  Vector3<S> angular_velocity, angular_acceleration;  ///< ω [rad/s], ω̇ [rad/s²], axes of W
};

/// @param rate, acceleration  σ' [1/s] and σ'' [1/s²]
template <class S>
[[nodiscard]] Rates<S> by_time(const PathRates<S>& x, const S& rate, const S& acceleration) {
  const S square = sqr(rate);
  Rates<S> result;
  for (int k = 0; k < 3; ++k) {
    result.velocity(k) = x.p1(k) * rate;
    result.acceleration(k) = x.p2(k) * square + x.p1(k) * acceleration;
    result.angular_velocity(k) = x.w(k) * rate;
    result.angular_acceleration(k) = x.w1(k) * square + x.w(k) * acceleration;
  }
  return result;
}

/// All from a to b, and all of magnitude up to x; of double the middle.
inline double span(double a, double b) { return 0.5 * (a + b); }
inline double symmetric(double /*x*/) { return 0; }
template <class I>
[[nodiscard]] I span(const I& a, const I& b) {
  return hull(a, b);
}
template <class I>
[[nodiscard]] I symmetric(const I& x) {
  return hull(-x, x);
}

/// A body of the load. Of an enclosing scalar, `mass` and `inertia` hold all that the tolerances allow.
template <class S>
struct MovingBody {
  S mass;              ///< [kg]
  Vector3<S> p_PC;     ///< c [m]
  Vector3<S> p_MC;     ///< c − p_m [m]
  Matrix3<S> inertia;  ///< I [kg m²], axes of P
};

/// The bodies of a load: its weights. Of an enclosing scalar, each with all masses and centres of gravity that it may
/// have, and with the inertia of its box about the centre of gravity, wherever that is.
template <class S>
[[nodiscard]] std::vector<MovingBody<S>> make_moving_bodies(const LoadText& load) {
  std::vector<MovingBody<S>> bodies;
  for (const LoadItem& item : load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (weight == nullptr) continue;
    MovingBody<S>& body = bodies.emplace_back();
    const S off = symmetric(from_rational<S>(weight->at_tolerance));
    body.mass = span(from_rational<S>(weight->mass_lower), from_rational<S>(weight->mass_upper));
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const S c = from_rational<S>(weight->at[axis]);
      body.p_PC(k) = c + off;
      body.p_MC(k) = c - from_rational<S>(load.point_m[axis]) + off;
      for (int l = 0; l < 3; ++l) body.inertia(k, l) = S(0.0);
    }
    if (!weight->inertia_box) continue;
    std::array<S, 3> square;
    for (std::size_t k = 0; k < 3; ++k) square[k] = sqr(from_rational<S>((*weight->inertia_box)[k]));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<int>(k);
      body.inertia(axis, axis) = body.mass * (square[(k + 1) % 3] + square[(k + 2) % 3]) / S(12.0);
    }
  }
  return bodies;
}

template <class S>
[[nodiscard]] Vector3<S> turned(const Matrix3<S>& r, const Vector3<S>& v) {
  Vector3<S> result;
  for (int i = 0; i < 3; ++i) result(i) = r(i, 0) * v(0) + r(i, 1) * v(1) + r(i, 2) * v(2);
  return result;
}
template <class S>
[[nodiscard]] Vector3<S> turned_back(const Matrix3<S>& r, const Vector3<S>& v) {
  Vector3<S> result;
  for (int i = 0; i < 3; ++i) result(i) = r(0, i) * v(0) + r(1, i) * v(1) + r(2, i) * v(2);
  return result;
}

/// The acceleration of the point of P whose lever from its origin is `arm`, in the axes of W [m/s²].
template <class S>
[[nodiscard]] Vector3<S> acceleration_at(const Rates<S>& x, const Vector3<S>& arm) {
  const Vector3<S> centripetal = cross(x.angular_velocity, Vector3<S>(cross(x.angular_velocity, arm)));
  const Vector3<S> tangential = cross(x.angular_acceleration, arm);
  Vector3<S> result;
  for (int k = 0; k < 3; ++k) result(k) = x.acceleration(k) + tangential(k) + centripetal(k);
  return result;
}

template <class S>
[[nodiscard]] Vector3<S> velocity_at(const Rates<S>& x, const Vector3<S>& arm) {
  const Vector3<S> turning = cross(x.angular_velocity, arm);
  return {x.velocity(0) + turning(0), x.velocity(1) + turning(1), x.velocity(2) + turning(2)};
}

/// w_in about P_m, axes of W [N, N m].
template <class S>
[[nodiscard]] Vector6<S> inertial_wrench(const std::vector<MovingBody<S>>& bodies, const Matrix3<S>& r_WP,
                                         const Rates<S>& x) {
  Vector6<S> sum;
  for (int k = 0; k < 6; ++k) sum(k) = S(0.0);
  const Vector3<S> spin = turned_back(r_WP, x.angular_velocity);
  for (const MovingBody<S>& body : bodies) {
    const Vector3<S> a = acceleration_at(x, turned(r_WP, body.p_PC));
    const Vector3<S> force(body.mass * a(0), body.mass * a(1), body.mass * a(2));
    const Vector3<S> by_force = cross(turned(r_WP, body.p_MC), force);
    const Vector3<S> by_spin = turned(r_WP, turned(body.inertia, turned_back(r_WP, x.angular_acceleration)));
    const Vector3<S> gyroscopic = turned(r_WP, Vector3<S>(cross(spin, turned(body.inertia, spin))));
    for (int k = 0; k < 3; ++k) {
      sum(k) = sum(k) + force(k);
      sum(3 + k) = sum(3 + k) + by_force(k) + by_spin(k) + gyroscopic(k);
    }
  }
  return sum;
}

/// p + R c by s where R c = `arm`, three times derived [m].
template <class S>
[[nodiscard]] Vector3<S> third_derivative_at(const ThirdPathRates<S>& x, const Vector3<S>& arm) {
  const Vector3<S> first = cross(x.w, arm), outer = cross(x.w1, arm), inner = cross(x.w, first);
  const Vector3<S> second(outer(0) + inner(0), outer(1) + inner(1), outer(2) + inner(2));
  const Vector3<S> a = cross(x.w2, arm), b = cross(x.w1, first), c = cross(x.w, second);
  Vector3<S> result;
  for (int k = 0; k < 3; ++k) result(k) = x.p3(k) + a(k) + S(2.0) * b(k) + c(k);
  return result;
}

/// What a winch does: L̇ [m/s] and L̈ [m/s²], with v and a of the anchor B_i:
///   L L̇ = d·v,   L L̈ + L̇² = |v|² + d·a.
template <class S>
struct WinchRate {
  S speed, acceleration;
};

/// @param p_WP, r_WP  the pose
template <class S>
[[nodiscard]] WinchRate<S> winch_rate(const Model<S>& model, std::size_t cable, const Vector3<S>& p_WP,
                                      const Matrix3<S>& r_WP, const Rates<S>& x) {
  const Vector3<S> arm = turned(r_WP, model.p_PB[cable]);
  const Vector3<S> v = velocity_at(x, arm), a = acceleration_at(x, arm);
  S by_speed(0.0), by_acceleration(0.0), square(0.0);
  Vector3<S> d;
  for (int k = 0; k < 3; ++k) {
    d(k) = p_WP(k) + arm(k) - model.p_WA[cable](k);
    by_speed = by_speed + d(k) * v(k);
    by_acceleration = by_acceleration + d(k) * a(k);
    square = square + sqr(v(k));
  }
  const S l = length(d);
  const S speed = by_speed / l;
  return {speed, (square - sqr(speed) + by_acceleration) / l};
}

/// L''' by s, given L' and L'': L L''' + 3 L' L'' = 3 v·a + d·j, with v, a and j of the anchor B_i.
template <class S>
[[nodiscard]] S third_derivative_of_length(const Model<S>& model, std::size_t cable, const ThirdPathRates<S>& x,
                                           const WinchRate<S>& by_s) {
  const Rates<S> rates{x.p1, x.p2, x.w, x.w1};
  const Vector3<S> arm = turned(x.r_WP, model.p_PB[cable]);
  const Vector3<S> v = velocity_at(rates, arm), a = acceleration_at(rates, arm), j = third_derivative_at(x, arm);
  S bend = -(by_s.speed * by_s.acceleration), sum(0.0);
  Vector3<S> d;
  for (int k = 0; k < 3; ++k) {
    d(k) = x.p(k) + arm(k) - model.p_WA[cable](k);
    bend = bend + v(k) * a(k);
    sum = sum + d(k) * j(k);
  }
  return (sum + S(3.0) * bend) / length(d);
}

/// Of all winches.
template <class S>
struct WinchRates {
  std::array<S, kCables> speed, acceleration;
};

template <class S>
[[nodiscard]] WinchRates<S> winch_rates(const Model<S>& model, const Vector3<S>& p_WP, const Matrix3<S>& r_WP,
                                        const Rates<S>& x) {
  WinchRates<S> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const WinchRate<S> winch = winch_rate(model, i, p_WP, r_WP, x);
    result.speed[i] = winch.speed;
    result.acceleration[i] = winch.acceleration;
  }
  return result;
}

}  // namespace taut
