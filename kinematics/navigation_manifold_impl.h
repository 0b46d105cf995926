// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of navigation_manifold.h.
#pragma once

#include "kinematics/jet.h"

namespace taut {

/// Y = D^-1 with its slopes −Y D' Y, from D with its own. @returns whether D could be inverted
template <class S>
bool invert_with_slopes(const Matrix6<Jet<S, 6>>& D, Matrix6<Jet<S, 6>>& inverse) {
  Matrix6<S> d;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) d(i, j) = D(i, j).value;
  }
  Matrix6<S> y;
  S determinant;
  if (!invert(d, y, determinant)) return false;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) inverse(i, j) = Jet<S, 6>(y(i, j));
  }
  for (std::size_t k = 0; k < 6; ++k) {
    Matrix6<S> product;  // D' Y
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        S sum = S(0.0);
        for (int l = 0; l < 6; ++l) sum = sum + D(i, l).partial[k] * y(l, j);
        product(i, j) = sum;
      }
    }
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        S sum = S(0.0);
        for (int l = 0; l < 6; ++l) sum = sum + y(i, l) * product(l, j);
        inverse(i, j).partial[k] = -sum;
      }
    }
  }
  return true;
}

template <class S>
bool navigation_tangent(const Model<S>& model, const Pose<S>& pose, NavigationTangent<S>& result) {
  using J = Jet<S, 6>;
  using Layout = NavigationLayout;
  const Pose<J> jet_pose{Vector3<J>(J(pose.p_WP(0), 0), J(pose.p_WP(1), 1), J(pose.p_WP(2), 2)),
                         {J(pose.angles[0], 3), J(pose.angles[1], 4), J(pose.angles[2], 5)}};
  const CableGeometry<J> geometry = cable_geometry(model, jet_pose);

  Matrix6<J> inverse;
  if (!invert_with_slopes(geometry.force_density, inverse)) return false;

  const auto put = [&](int row, const J& x) {
    result.point(row) = x.value;
    for (int k = 0; k < 6; ++k) result.tangent(row, k) = x.partial[static_cast<std::size_t>(k)];
  };
  for (int axis = 0; axis < 3; ++axis) put(Layout::kPosition + axis, jet_pose.p_WP(axis));
  for (int k = 0; k < 3; ++k) put(Layout::kAngles + k, jet_pose.angles[static_cast<std::size_t>(k)]);

  std::array<J, kCables> lengths;
  std::array<std::array<J, 6>, kCables> z;  // rows of Y L
  for (int i = 0; i < kCables; ++i) {
    const auto n = static_cast<std::size_t>(i);
    for (int axis = 0; axis < 3; ++axis) put(Layout::kCableVectors + 3 * i + axis, geometry.p_AB_W[n](axis));
    lengths[n] = length(geometry.p_AB_W[n]);
    put(Layout::kLengths + i, lengths[n]);
    for (int j = 0; j < 6; ++j) {
      J sum = inverse(i, 0) * model.ellipsoid_root(0, j);
      for (int l = 1; l <= j; ++l) sum = sum + inverse(i, l) * model.ellipsoid_root(l, j);
      z[n][static_cast<std::size_t>(j)] = sum;
    }
  }
  for (int i = 0; i < kCables; ++i) {
    const auto n = static_cast<std::size_t>(i);
    J density = inverse(i, 0) * model.wrench(0);
    for (int l = 1; l < 6; ++l) density = density + inverse(i, l) * model.wrench(l);
    const J tension = lengths[n] * density;
    put(Layout::kTensions + i, tension);

    // Column i of B^-1 over sqrt((B^-1)_ii) = d_i |z_i|.
    J square = sqr(z[n][0]);
    for (std::size_t l = 1; l < 6; ++l) square = square + sqr(z[n][l]);
    const J norm = sqrt(square);
    for (int j = 0; j < kCables; ++j) {
      const auto m = static_cast<std::size_t>(j);
      J product = z[m][0] * z[n][0];
      for (std::size_t l = 1; l < 6; ++l) product = product + z[m][l] * z[n][l];
      put(Layout::kVariations + 6 * i + j, lengths[m] * product / norm);
    }
    const J tension_radius = lengths[n] * norm;

    const S half_length = (model.length_upper[n] - model.length_lower[n]) * S(0.5);
    const S half_tension = (model.tension_upper[n] - model.tension_lower[n]) * S(0.5);
    const J slack = (lengths[n] - model.length_lower[n]) * (-lengths[n] + model.length_upper[n]);
    put(Layout::kLengthSlack + i, J(half_length * half_length) / slack);
    put(Layout::kLowSlack + i, J(half_tension) / (tension - tension_radius - model.tension_lower[n]));
    put(Layout::kHighSlack + i, J(half_tension) / (-(tension + tension_radius) + model.tension_upper[n]));
  }
  return true;
}

/// J from x's own cable vectors and lengths.
template <class S>
Matrix6<S> force_jacobian(const Model<S>& model, const Matrix3<S>& r_WP, const NavigationPoint<S>& x) {
  using Layout = NavigationLayout;
  const auto cable_vector = [&](int i, int axis) { return x(Layout::kCableVectors + 3 * i + axis); };
  Matrix6<S> j;
  for (int i = 0; i < kCables; ++i) {
    Vector3<S> arm;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3<S>& m = model.p_MB[static_cast<std::size_t>(i)];
      arm(axis) = r_WP(axis, 0) * m(0) + r_WP(axis, 1) * m(1) + r_WP(axis, 2) * m(2);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int k = (axis + 1) % 3;
      const int l = (axis + 2) % 3;
      j(axis, i) = cable_vector(i, axis) / x(Layout::kLengths + i);
      j(3 + axis, i) = (arm(k) * cable_vector(i, l) - arm(l) * cable_vector(i, k)) / x(Layout::kLengths + i);
    }
  }
  return j;
}

/// JᵀEJ.
template <class S>
Matrix6<S> ellipsoid_of_tensions(const Model<S>& model, const Matrix6<S>& j) {
  Matrix6<S> b;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) {
      S sum = S(0.0);
      for (int k = 0; k < 6; ++k) {
        for (int l = 0; l < 6; ++l) {
          if (model.ellipsoid_is_diagonal && k != l) continue;
          sum = sum + j(k, r) * model.ellipsoid(k, l) * j(l, c);
        }
      }
      b(r, c) = sum;
    }
  }
  return b;
}

template <class S>
Eigen::Matrix<S, kNavigationEquations, 1> navigation_residual(const Model<S>& model, const NavigationPoint<S>& x) {
  using Layout = NavigationLayout;
  Eigen::Matrix<S, kNavigationEquations, 1> f;
  int row = 0;
  const Vector3<S> p_WP(x(0), x(1), x(2));
  const Matrix3<S> r_WP =
      rotation(model.angles, std::array<S, 3>{x(Layout::kAngles), x(Layout::kAngles + 1), x(Layout::kAngles + 2)});
  const CableGeometry<S> geometry = cable_geometry(model, p_WP, r_WP);
  const auto cable_vector = [&](int i, int axis) { return x(Layout::kCableVectors + 3 * i + axis); };
  const auto cable_length = [&](int i) { return x(Layout::kLengths + i); };

  for (int i = 0; i < kCables; ++i) {  // (1)
    for (int axis = 0; axis < 3; ++axis) {
      f(row++) = cable_vector(i, axis) - geometry.p_AB_W[static_cast<std::size_t>(i)](axis);
    }
  }
  for (int i = 0; i < kCables; ++i) {  // (2)
    f(row++) = sqr(cable_length(i)) - sqr(cable_vector(i, 0)) - sqr(cable_vector(i, 1)) - sqr(cable_vector(i, 2));
  }

  const Matrix6<S> j = force_jacobian(model, r_WP, x);
  for (int axis = 0; axis < 6; ++axis) {  // (4)
    S sum = -model.wrench(axis);
    for (int i = 0; i < kCables; ++i) sum = sum + j(axis, i) * x(Layout::kTensions + i);
    f(row++) = sum;
  }

  const Matrix6<S> b = ellipsoid_of_tensions(model, j);
  for (int i = 0; i < kCables; ++i) {
    const auto v = [&](int k) { return x(Layout::kVariations + 6 * i + k); };
    S quadratic = S(0.0);
    for (int r = 0; r < 6; ++r) {
      S sum = S(0.0);
      for (int k = 0; k < 6; ++k) sum = sum + b(r, k) * v(k);
      if (r != i) f(row++) = sum;  // (5)
      quadratic = quadratic + v(r) * sum;
    }
    f(row++) = quadratic - S(1.0);  // (6)
  }
  for (int i = 0; i < kCables; ++i) {  // (10)–(12)
    const auto n = static_cast<std::size_t>(i);
    const S half_length = (model.length_upper[n] - model.length_lower[n]) * S(0.5);
    const S half_tension = (model.tension_upper[n] - model.tension_lower[n]) * S(0.5);
    const S& tension = x(Layout::kTensions + i);
    const S& tension_radius = x(Layout::kVariations + 7 * i);
    f(row++) = x(Layout::kLengthSlack + i) * (cable_length(i) - model.length_lower[n]) *
                   (model.length_upper[n] - cable_length(i)) -
               half_length * half_length;
    f(row++) = x(Layout::kLowSlack + i) * (tension - tension_radius - model.tension_lower[n]) - half_tension;
    f(row++) = x(Layout::kHighSlack + i) * (model.tension_upper[n] - tension - tension_radius) - half_tension;
  }
  return f;
}

}  // namespace taut
