// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse of the force-density matrix D over a box of s, with its slopes.
//
// Let T be the box, m its midpoint and r its radius, C any approximation of D(m)^-1. With A0 = C D(m) and A1 ⊇ C S, S
// the slopes of D from m (slope_form.h), entry by entry
//   |I − C D(t)| <= N := |I − A0| + r |A1|   for every t in T.                                                      (a)
// If ρ = ‖N‖∞ < 1, C D(t) is non-singular, hence so are D(t) and C, and with P(t) = (C D(t))^-1 = Σ_k (I − C D(t))^k
//   |P(t) − I| <= N + N² + … <= Q,   Q_ij = N_ij + (Σ_k N_ik) (max_k N_kj) / (1 − ρ).                               (b)
// As D^-1 = P C, a column D^-1 b = P C b has the slopes from m
//   −P(t) (C S) P(m) C b,   P(t) (C S) P(m) in A1 ± W,   W = |A1| Q0 + Q (|A1| + |A1| Q0),                          (c)
// where Q0 is (b) of N0 = |I − A0|: a bound of |P(m) − I|. Proof of each step: docs/theory.md, "A box".
#pragma once

#include "certify/arithmetic/neumann.h"
#include "certify/arithmetic/slope_form.h"
#include "kinematics/statics.h"

namespace taut {

template <class I>
class InverseBound {
 public:
  using Point = typename ProofScalarTraits<I>::Point;
  using Upper = UpperOf<I>;
  template <std::size_t N>
  using Columns = std::array<std::array<I, N>, 6>;

  /// Whether D is proved non-singular on all of T; what follows is void otherwise.
  [[nodiscard]] bool set(const Matrix6<SlopeForm<I>>& force_density, double radius);

  /// P x over T for the columns x = C B of constants.
  template <std::size_t N>
  [[nodiscard]] std::array<std::array<SlopeForm<I>, N>, 6> times(const Columns<N>& x) const;

  [[nodiscard]] const Matrix6<Point>& c() const { return c_; }
  [[nodiscard]] const Square<Upper>& q() const { return q_; }
  /// A1, Q0 and W of (c).
  [[nodiscard]] const Square<I>& a1() const { return a1_; }
  [[nodiscard]] const Square<Upper>& q0() const { return q0_; }
  [[nodiscard]] const Square<Upper>& w() const { return w_; }

 private:
  /// row += factor * other, for an exact factor.
  static void add_multiple(std::array<I, 6>& row, const Point& factor, const std::array<I, 6>& other) {
    for (std::size_t j = 0; j < 6; ++j) row[j] = row[j] + factor * other[j];
  }
  void set_slope_bound();

  double radius_ = 0;
  Matrix6<Point> c_;
  Square<I> a1_;
  Square<Upper> a1_magnitude_;
  Square<Upper> q0_, q_, w_;
};

template <class I>
bool InverseBound<I>::set(const Matrix6<SlopeForm<I>>& force_density, double radius) {
  radius_ = radius;
  Matrix6<Point> mid;
  Square<I> d_mid, d_slope;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const SlopeForm<I>& entry = force_density(i, j);
      mid(i, j) = ProofScalarTraits<I>::point(entry.at_mid);
      d_mid[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = entry.at_mid;
      d_slope[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = entry.slope;
    }
  }
  Point unused_determinant;
  if (!invert(mid, c_, unused_determinant)) return false;

  // A0 = C D(m), A1 = C S; N0, N; Q0, Q: (a), (b).
  Square<Upper> n0, n;
  for (std::size_t i = 0; i < 6; ++i) {
    std::array<I, 6> a0;
    a0.fill(I(0.0));
    a1_[i].fill(I(0.0));
    for (std::size_t k = 0; k < 6; ++k) {
      const Point& factor = c_(static_cast<int>(i), static_cast<int>(k));
      add_multiple(a0, factor, d_mid[k]);
      add_multiple(a1_[i], factor, d_slope[k]);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      n0[i][j] = Upper(magnitude(a0[j] - I(i == j ? 1.0 : 0.0)));
      a1_magnitude_[i][j] = Upper(magnitude(a1_[i][j]));
      n[i][j] = n0[i][j] + Upper(radius) * a1_magnitude_[i][j];
    }
  }
  if (!neumann_bound<I>(n0, q0_) || !neumann_bound<I>(n, q_)) return false;
  set_slope_bound();
  return true;
}

/// W of (c).
template <class I>
void InverseBound<I>::set_slope_bound() {
  w_ = upper_product(a1_magnitude_, q0_);
  Square<Upper> sum = w_;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) sum[i][j] += a1_magnitude_[i][j];
  }
  const Square<Upper> second = upper_product(q_, sum);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) w_[i][j] += second[i][j];
  }
}

/// P x has the value x ± Q0|x| at m and slopes −(A1 ± W) x. A1 x is enclosed by A1 times numbers x̂ near x, and |A1|
/// times bounds of x − x̂.
template <class I>
template <std::size_t N>
std::array<std::array<SlopeForm<I>, N>, 6> InverseBound<I>::times(const Columns<N>& x) const {
  Columns<N> drift;  // A1 x̂
  std::array<std::array<Upper, N>, 6> x_magnitude, x_error;
  for (auto& row : drift) row.fill(I(0.0));
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t j = 0; j < N; ++j) {
      const Point near = ProofScalarTraits<I>::point(x[k][j]);
      x_magnitude[k][j] = Upper(magnitude(x[k][j]));
      x_error[k][j] = Upper(magnitude(x[k][j] - I(near)));
      for (std::size_t i = 0; i < 6; ++i) drift[i][j] = drift[i][j] + near * a1_[i][k];
    }
  }
  const auto mid_error = upper_product(q0_, x_magnitude);
  const auto slope_error = upper_product(w_, x_magnitude);
  const auto drift_error = upper_product(a1_magnitude_, x_error);
  std::array<std::array<SlopeForm<I>, N>, 6> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      SlopeForm<I>& value = result[i][j];
      value.at_mid = x[i][j] + ProofScalarTraits<I>::symmetric(mid_error[i][j]);
      value.slope = ProofScalarTraits<I>::symmetric(slope_error[i][j] + drift_error[i][j]) - drift[i][j];
      value.range = value.at_mid + ProofScalarTraits<I>::symmetric(Upper(radius_) * Upper(magnitude(value.slope)));
    }
  }
  return result;
}

}  // namespace taut
