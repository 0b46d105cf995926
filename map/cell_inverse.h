// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse of the force-density matrix D over a cell, row by row, with its slopes in N variables.
//
// With C ≈ D(m)^-1, A0 = C D(m) and A1_k ⊇ C S_k for the slopes S_k of D from the cell's midpoint m,
//   C D(t) ∈ A0 + Σ_k (t_k − m_k) A1_k,   |I − C D(t)| <= N := |I − A0| + Σ_k r_k |A1_k|       on the cell.       (m)
// If the largest row sum of N is below 1, D is non-singular on the cell and inverse_bound.h's (b) and (c) hold with one
// slope for each variable. Unlike there, rows are enclosed one at a time: of most cells few are needed. Proof:
// docs/theory.md, "Maps".
#pragma once

#include <array>
#include <cstddef>

#include "certify/arithmetic/gradient.h"
#include "certify/arithmetic/neumann.h"
#include "certify/arithmetic/slope_form.h"
#include "kinematics/statics.h"

namespace taut {

template <std::size_t N>
using CellForm = SlopeForm<Interval, Gradient<Interval, N>>;

/// M columns x = C B of constants, and what enclosing P x takes to know of them.
template <std::size_t M>
struct CellColumns {
  std::array<std::array<Interval, M>, 6> value;
  std::array<std::array<double, M>, 6> near, error, magnitude;  ///< |x − near| <= error, |x| <= magnitude
  std::array<double, M> sum;                                    ///< of the magnitudes

  /// Sets the rest from `value`.
  void finish() {
    sum.fill(0.0);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < M; ++j) {
        near[i][j] = midpoint_approx(value[i][j]);
        error[i][j] = taut::magnitude(value[i][j] - Interval(near[i][j]));
        magnitude[i][j] = taut::magnitude(value[i][j]);
        sum[j] += magnitude[i][j];
      }
    }
  }
};

/// Only under run_upward(). Void if a fault was raised.
template <std::size_t N>
class CellInverse {
 public:
  using Form = CellForm<N>;

  /// Whether there is a C; what follows is void otherwise.
  [[nodiscard]] bool set(const Matrix6<Form>& force_density, const std::array<double, N>& radius);
  /// Whether D is proved non-singular on all of the cell.
  [[nodiscard]] bool is_regular() const { return regular_; }

  [[nodiscard]] const Matrix6<double>& c() const { return c_; }
  /// |D^-1 C^-1 − I| <= q() on the cell. @pre is_regular()
  [[nodiscard]] const Square<double>& q() const { return q_; }
  /// (C D)_ij over the cell.
  [[nodiscard]] Interval product(std::size_t i, std::size_t j) const {
    double reach = 0;
    for (std::size_t k = 0; k < N; ++k) reach += radius_[k] * a1_magnitude_[k][i][j];
    return a0_[i][j] + Interval(-reach, reach);
  }
  /// How much the cell's extent along an axis adds to the row sums of N.
  [[nodiscard]] double reach(std::size_t axis) const;

  /// Row i of P x over the cell. @pre is_regular()
  template <std::size_t M>
  void row(std::size_t i, const CellColumns<M>& x, std::array<Form, M>& result) const;

 private:
  /// row += factor * other, for an exact factor.
  static void add_multiple(std::array<Interval, 6>& row, double factor, const std::array<Interval, 6>& other) {
    for (std::size_t j = 0; j < 6; ++j) row[j] = row[j] + factor * other[j];
  }

  Matrix6<double> c_;
  std::array<double, N> radius_;
  Square<Interval> a0_;
  std::array<Square<Interval>, N> a1_;
  std::array<Square<double>, N> a1_magnitude_;
  Square<double> q_;
  double q0_ = 0;  ///< |P(m) − I| <= q0, entry by entry
  bool regular_ = false;
};

template <std::size_t N>
bool CellInverse<N>::set(const Matrix6<Form>& force_density, const std::array<double, N>& radius) {
  radius_ = radius;
  Matrix6<double> mid;
  Square<Interval> d_mid;
  std::array<Square<Interval>, N> d_slope;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      const Form& entry = force_density(static_cast<int>(i), static_cast<int>(j));
      mid(static_cast<int>(i), static_cast<int>(j)) = midpoint_approx(entry.at_mid);
      d_mid[i][j] = entry.at_mid;
      for (std::size_t k = 0; k < N; ++k) d_slope[k][i][j] = entry.slope[k];
    }
  }
  double unused_determinant = 0;
  if (!invert(mid, c_, unused_determinant)) return false;

  Square<double> n;
  double rho0 = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    a0_[i].fill(Interval(0.0));
    for (std::size_t k = 0; k < N; ++k) a1_[k][i].fill(Interval(0.0));
    for (std::size_t l = 0; l < 6; ++l) {
      const double factor = c_(static_cast<int>(i), static_cast<int>(l));
      add_multiple(a0_[i], factor, d_mid[l]);
      for (std::size_t k = 0; k < N; ++k) add_multiple(a1_[k][i], factor, d_slope[k][l]);
    }
    double row_sum = 0;
    for (std::size_t j = 0; j < 6; ++j) {
      n[i][j] = magnitude(a0_[i][j] - Interval(i == j ? 1.0 : 0.0));
      row_sum += n[i][j];
      for (std::size_t k = 0; k < N; ++k) {
        a1_magnitude_[k][i][j] = magnitude(a1_[k][i][j]);
        n[i][j] += radius[k] * a1_magnitude_[k][i][j];
      }
    }
    rho0 = std::max(rho0, row_sum);
  }
  regular_ = neumann_bound<Interval>(n, q_);
  if (regular_) q0_ = rho0 / ProofScalarTraits<Interval>::one_minus_lower(rho0);  // rho0 <= ρ < 1
  return true;
}

template <std::size_t N>
double CellInverse<N>::reach(std::size_t axis) const {
  double most = 0;
  for (const auto& row : a1_magnitude_[axis]) {
    double sum = 0;
    for (const double x : row) sum += x;
    most = std::max(most, sum);
  }
  return radius_[axis] * most;
}

/// The slopes are −(A1_k ± W_k) x, W_k = |A1_k| Q0 + Q (|A1_k| + |A1_k| Q0), of which row i is needed.
template <std::size_t N>
template <std::size_t M>
void CellInverse<N>::row(std::size_t i, const CellColumns<M>& x, std::array<Form, M>& result) const {
  for (std::size_t j = 0; j < M; ++j) {
    const double mid_error = q0_ * x.sum[j];
    result[j].at_mid = x.value[i][j] + Interval(-mid_error, mid_error);
  }
  std::array<double, M> reach;
  reach.fill(0.0);
  for (std::size_t k = 0; k < N; ++k) {
    std::array<double, 6> w;  // row i of W_k
    w.fill(0.0);
    for (std::size_t l = 0; l < 6; ++l) {
      double row_sum = 0;
      for (std::size_t p = 0; p < 6; ++p) row_sum += a1_magnitude_[k][l][p];
      const double rounding = q0_ * row_sum;
      const double share = l == i ? 1.0 : 0.0;
      for (std::size_t p = 0; p < 6; ++p) w[p] += q_[i][l] * (a1_magnitude_[k][l][p] + rounding) + share * rounding;
    }
    std::array<Interval, M> drift;
    std::array<double, M> error;
    drift.fill(Interval(0.0));
    error.fill(0.0);
    for (std::size_t l = 0; l < 6; ++l) {
      for (std::size_t j = 0; j < M; ++j) {
        drift[j] = drift[j] + x.near[l][j] * a1_[k][i][l];
        error[j] += w[l] * x.magnitude[l][j] + a1_magnitude_[k][i][l] * x.error[l][j];
      }
    }
    for (std::size_t j = 0; j < M; ++j) {
      result[j].slope[k] = Interval(-error[j], error[j]) - drift[j];
      reach[j] += radius_[k] * magnitude(result[j].slope[k]);
    }
  }
  for (std::size_t j = 0; j < M; ++j) result[j].range = result[j].at_mid + Interval(-reach[j], reach[j]);
}

}  // namespace taut
