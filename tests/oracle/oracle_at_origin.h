// SPDX-License-Identifier: GPL-3.0-or-later
// An oracle for statics by another route than the product's: straight from the paper's frame F1.
//
// J about the origin O with columns (u_i ; a_i × u_i); w0 and K carried from the load point to O by the wrench
// transform X = [I 0; [r]× I]; J f = w solved by Gaussian elimination in MPFR at 200 bits, rounding to nearest. No
// force densities, no load frame, no intervals, none of kinematics/. Errors are below 1e-40 for the poses of the tests.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "certify/arithmetic/big_float.h"
#include "problem/problem.h"

namespace taut::oracle {

inline constexpr mpfr_prec_t kBits = 200;

using Big3 = std::array<BigFloat, 3>;
using Big6 = std::array<BigFloat, 6>;
using Big66 = std::array<Big6, 6>;

inline BigFloat big(const DecimalText& text) {
  BigFloat x;
  if (mpfr_set_str(x.get(), text.c_str(), 10, MPFR_RNDN) != 0) throw std::invalid_argument(text);
  return x;
}
inline BigFloat root(const BigFloat& x) { return BigFloat::apply_rounded(MPFR_RNDN, mpfr_sqrt, x); }
inline BigFloat sine(const BigFloat& x) { return BigFloat::apply_rounded(MPFR_RNDN, mpfr_sin, x); }
inline BigFloat cosine(const BigFloat& x) { return BigFloat::apply_rounded(MPFR_RNDN, mpfr_cos, x); }
inline BigFloat pi() {
  BigFloat x;
  mpfr_const_pi(x.get(), MPFR_RNDN);
  return x;
}
inline Big3 cross(const Big3& a, const Big3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Solves a x = b for several right-hand sides, in place; returns det a.
inline BigFloat solve(Big66 a, std::vector<Big6>& right_hand_sides) {
  BigFloat determinant(1.0);
  for (std::size_t column = 0; column < 6; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < 6; ++row) {
      if (abs(a[row][column]) > abs(a[pivot][column])) pivot = row;
    }
    if (pivot != column) {
      std::swap(a[pivot], a[column]);
      for (auto& b : right_hand_sides) std::swap(b[pivot], b[column]);
      determinant = -determinant;
    }
    determinant *= a[column][column];
    for (std::size_t row = column + 1; row < 6; ++row) {
      const BigFloat factor = a[row][column] / a[column][column];
      for (std::size_t k = column; k < 6; ++k) a[row][k] -= factor * a[column][k];
      for (auto& b : right_hand_sides) b[row] -= factor * b[column];
    }
  }
  for (auto& b : right_hand_sides) {
    for (std::size_t i = 6; i-- > 0;) {
      for (std::size_t k = i + 1; k < 6; ++k) b[i] -= a[i][k] * b[k];
      b[i] /= a[i][i];
    }
  }
  return determinant;
}

struct OracleStatics {
  Big6 length, tension, tension_radius;
  BigFloat determinant;  ///< det J about O
  Big66 jacobian;        ///< J about O
  Big66 transform;       ///< X: wrenches about P_m to wrenches about O
};

/// pose: px, py, pz [m], phi, theta, sigma [rad]. Call within PrecisionScope(kBits).
inline OracleStatics statics(const Problem& problem, const Big6& pose) {
  const auto& [px, py, pz, phi, theta, sigma] = pose;
  struct Turn {
    explicit Turn(const BigFloat& t) : c(cosine(t)), s(sine(t)) {}
    BigFloat c, s;
  };
  const Turn tilt_direction(phi), tilt(theta), torsion(sigma - phi);
  const auto rz = [](const Turn& t, const Big3& x) {
    return Big3{t.c * x[0] - t.s * x[1], t.s * x[0] + t.c * x[1], x[2]};
  };
  const auto ry = [](const Turn& t, const Big3& x) {
    return Big3{t.c * x[0] + t.s * x[2], x[1], t.c * x[2] - t.s * x[0]};
  };
  const auto rotate = [&](const Big3& x) { return rz(tilt_direction, ry(tilt, rz(torsion, x))); };
  const auto vector = [](const std::array<DecimalText, 3>& t) { return Big3{big(t[0]), big(t[1]), big(t[2])}; };

  OracleStatics result;
  for (std::size_t i = 0; i < 6; ++i) {
    const Big3 a = vector(problem.robot.base_anchors_m[i]);
    const Big3 b = rotate(vector(problem.robot.platform_anchors_m[i]));
    const Big3 d{px + b[0] - a[0], py + b[1] - a[1], pz + b[2] - a[2]};
    result.length[i] = root(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const Big3 u{d[0] / result.length[i], d[1] / result.length[i], d[2] / result.length[i]};
    const Big3 m = cross(a, u);
    for (std::size_t k = 0; k < 3; ++k) {
      result.jacobian[k][i] = u[k];
      result.jacobian[3 + k][i] = m[k];
    }
  }
  const Big3 arm = rotate(vector(problem.load.point_m));
  const Big3 r{px + arm[0], py + arm[1], pz + arm[2]};
  for (std::size_t i = 0; i < 6; ++i) result.transform[i][i] = BigFloat(1.0);
  result.transform[3][1] = -r[2];
  result.transform[3][2] = r[1];
  result.transform[4][0] = r[2];
  result.transform[4][2] = -r[0];
  result.transform[5][0] = -r[1];
  result.transform[5][1] = r[0];

  // f0 = J^-1 X w0. v_ii² = (B^-1)_ii with B^-1 = J^-1 X E^-1 X^T J^-T: solve for the columns of X and use E^-1 by
  // solving.
  std::vector<Big6> columns(7);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      columns[0][i] += result.transform[i][k] * big(problem.load.wrench[k]);
      columns[1 + k][i] = result.transform[i][k];
    }
  }
  result.determinant = solve(result.jacobian, columns);
  result.tension = columns[0];
  Big66 e;
  std::vector<Big6> rows(6);  // row i of J^-1 X
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      e[i][k] = big(problem.load.ellipsoid.value()[i][k]);
      rows[i][k] = columns[1 + k][i];
    }
  }
  std::vector<Big6> solved = rows;
  solve(e, solved);
  for (std::size_t i = 0; i < 6; ++i) {
    BigFloat square;
    for (std::size_t k = 0; k < 6; ++k) square += rows[i][k] * solved[i][k];
    result.tension_radius[i] = root(square);
  }
  return result;
}

}  // namespace taut::oracle
