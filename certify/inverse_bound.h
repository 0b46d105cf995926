// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse of the force-density matrix D over a box of s, with its slopes.
//
// Let T be the box, m its midpoint and r its radius, C any approximation of D(m)^-1. With A0 = C D(m) and A1 ⊇ C S, S
// the slopes of D from m (slope_form.h), entry by entry
//   |I − C D(t)| <= N := |I − A0| + r |A1|   for every t in T.                                                      (a)
// If ρ = ‖N‖∞ < 1, C D(t) is non-singular, hence so are D(t) and C, and with P(t) = (C D(t))^-1 = Σ_k (I − C D(t))^k
//   |P(t) − I| <= N + N² + … <= Q,   Q_ij = N_ij + (Σ_k N_ik) (max_k N_kj) / (1 − ρ).                               (b)
// As D^-1 = P C, a column D^-1 b = P x, x = C b, has the value P(m) x in x ± Q0|x| at m, where Q0 is (b) of |I − A0|,
// and the slopes from m
//   −P(t) v,  v = (C S) P(m) x,   P(t) v in v ± Q|v|.                                                               (c)
// |v| is far below |A1||x|, as the columns of D^-1 change little. Proof of each step: docs/theory.md, "A box".
#pragma once

#include <type_traits>

#include "certify/arithmetic/neumann.h"
#include "certify/arithmetic/slope_form.h"
#include "certify/lanes/kernel.h"
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
  /// What set() finds, from lanes. @pre BoxKernel::bound_inverse() of this box
  void set(const lanes::Box<1>& box) requires std::is_same_v<I, Interval>;

  /// P x over T for the columns x = C B of constants.
  template <std::size_t N>
  [[nodiscard]] std::array<std::array<SlopeForm<I>, N>, 6> times(const Columns<N>& x) const;

  [[nodiscard]] const Matrix6<Point>& c() const { return c_; }
  [[nodiscard]] const Square<Upper>& q() const { return q_; }
  [[nodiscard]] const Square<I>& a1() const { return a1_; }
  [[nodiscard]] const Square<Upper>& q0() const { return q0_; }
  /// W = |A1| Q0 + Q (|A1| + |A1| Q0): P(t) (C S) P(m) is in A1 ± W.
  [[nodiscard]] Square<Upper> slope_bound() const;

 private:
  /// row += factor * other, for an exact factor.
  static void add_multiple(std::array<I, 6>& row, const Point& factor, const std::array<I, 6>& other) {
    for (std::size_t j = 0; j < 6; ++j) row[j] = row[j] + factor * other[j];
  }

  double radius_ = 0;
  Matrix6<Point> c_;
  Square<I> a1_;
  Square<Upper> a1_magnitude_;
  Square<Upper> q0_, q_;
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
  return neumann_bound<I>(n0, q0_) && neumann_bound<I>(n, q_);
}

template <class I>
void InverseBound<I>::set(const lanes::Box<1>& box) requires std::is_same_v<I, Interval> {
  radius_ = box.radius[0];
  for (std::size_t j = 0; j < 6; ++j) {
    const lanes::IntervalRow& a1 = box.a1[0][j];
    for (std::size_t i = 0; i < 6; ++i) {
      c_(static_cast<int>(i), static_cast<int>(j)) = box.c[j].x[i];
      a1_[i][j] = I(-a1.minus_lower.x[i], a1.upper.x[i]);
      a1_magnitude_[i][j] = Upper(box.a1_size[0][j].x[i]);
      q0_[i][j] = Upper(box.q0[j].x[i]);
      q_[i][j] = Upper(box.q[j].x[i]);
    }
  }
}

template <class I>
auto InverseBound<I>::slope_bound() const -> Square<Upper> {
  Square<Upper> w = upper_product(a1_magnitude_, q0_);
  Square<Upper> sum = w;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) sum[i][j] += a1_magnitude_[i][j];
  }
  const Square<Upper> second = upper_product(q_, sum);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) w[i][j] += second[i][j];
  }
  return w;
}

/// A1 P(m) x is enclosed by A1 times numbers x̂ near x, and |A1| times bounds of P(m) x − x̂.
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
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t j = 0; j < N; ++j) x_error[k][j] += mid_error[k][j];
  }
  const auto drift_error = upper_product(a1_magnitude_, x_error);
  std::array<std::array<Upper, N>, 6> drift_magnitude;  // |v|
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < N; ++j) drift_magnitude[i][j] = Upper(magnitude(drift[i][j])) + drift_error[i][j];
  }
  const auto change = upper_product(q_, drift_magnitude);
  std::array<std::array<SlopeForm<I>, N>, 6> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      SlopeForm<I>& value = result[i][j];
      value.at_mid = x[i][j] + ProofScalarTraits<I>::symmetric(mid_error[i][j]);
      value.slope = ProofScalarTraits<I>::symmetric(drift_error[i][j] + change[i][j]) - drift[i][j];
      value.range = value.at_mid + ProofScalarTraits<I>::symmetric(Upper(radius_) * Upper(magnitude(value.slope)));
    }
  }
  return result;
}

}  // namespace taut
