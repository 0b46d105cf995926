// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of inverses of matrices close to the identity, rounded upward; for both proof scalars.
//
// Let |I − M| <= N entry by entry, with ρ = max row sum of N < 1. Then M is non-singular and
//   |M^-1 − I| <= N + N² + … <= Q,   Q_ij = N_ij + (Σ_k N_ik) (max_k N_kj) / (1 − ρ).
// Proof: docs/theory.md, "The inverse".
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"

namespace taut {

/// A nonnegative number; sums, products and quotients are rounded upward.
template <class I>
struct ProofScalarTraits;

template <>
struct ProofScalarTraits<Interval> {
  using Point = double;  ///< entries of C: approximations, but exact numbers once chosen
  using Upper = double;  ///< under run_upward(), plain double arithmetic rounds upward
  static Point point(const Interval& x) { return midpoint_approx(x); }
  static Interval symmetric(Upper radius) { return {-radius, radius}; }
  static Upper one_minus_lower(Upper x) { return -(x - 1.0); }  // rounded down
  static Upper root(Upper x) { return std::sqrt(x); }
  static double to_double(Upper x) { return x; }
};

class BigUpper {
 public:
  BigUpper() = default;
  explicit(false) BigUpper(double x) : x_(x) {}
  explicit BigUpper(BigFloat x) : x_(std::move(x)) {}
  friend BigUpper operator+(const BigUpper& a, const BigUpper& b) { return up(mpfr_add, a, b); }
  friend BigUpper operator*(const BigUpper& a, const BigUpper& b) { return up(mpfr_mul, a, b); }
  friend BigUpper operator/(const BigUpper& a, const BigUpper& b) { return up(mpfr_div, a, b); }
  BigUpper& operator+=(const BigUpper& b) { return *this = *this + b; }
  friend bool operator<(const BigUpper& a, const BigUpper& b) { return a.x_ < b.x_; }
  [[nodiscard]] const BigFloat& value() const { return x_; }

 private:
  template <class F>
  static BigUpper up(F function, const BigUpper& a, const BigUpper& b) {
    return BigUpper(BigFloat::apply_rounded(MPFR_RNDU, function, a.x_, b.x_));
  }
  BigFloat x_;
};

template <>
struct ProofScalarTraits<MpInterval> {
  using Point = BigFloat;
  using Upper = BigUpper;
  static Point point(const MpInterval& x) { return MpfrRounding<BigFloat>::median(x.lower(), x.upper()); }
  static MpInterval symmetric(const Upper& radius) { return {-radius.value(), radius.value()}; }
  static Upper one_minus_lower(const Upper& x) {
    return Upper(BigFloat::apply_rounded(MPFR_RNDD, mpfr_sub, BigFloat(1.0), x.value()));
  }
  static Upper root(const Upper& x) { return Upper(BigFloat::apply_rounded(MPFR_RNDU, mpfr_sqrt, x.value())); }
  static double to_double(const Upper& x) { return x.value().to_double(MPFR_RNDU); }
};

/// Row-major N x N; plain arrays keep the inner loops visible to the vectoriser.
template <class T, std::size_t N = 6>
using Square = std::array<std::array<T, N>, N>;

template <class I>
using UpperOf = typename ProofScalarTraits<I>::Upper;

template <class Upper, std::size_t N, std::size_t M>
std::array<std::array<Upper, M>, N> upper_product(const Square<Upper, N>& a,
                                                  const std::array<std::array<Upper, M>, N>& b) {
  std::array<std::array<Upper, M>, N> c;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < M; ++j) c[i][j] = a[i][0] * b[0][j];
    for (std::size_t k = 1; k < N; ++k) {
      for (std::size_t j = 0; j < M; ++j) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

/// Q above for N = `n`; false if ρ < 1 is not certain.
template <class I, std::size_t N>
[[nodiscard]] bool neumann_bound(const Square<UpperOf<I>, N>& n, Square<UpperOf<I>, N>& q) {
  using Upper = UpperOf<I>;
  std::array<Upper, N> row_sum;
  std::array<Upper, N> column_max;
  column_max.fill(Upper(0.0));
  Upper rho(0.0);
  for (std::size_t i = 0; i < N; ++i) {
    row_sum[i] = Upper(0.0);
    for (std::size_t j = 0; j < N; ++j) {
      row_sum[i] += n[i][j];
      column_max[j] = std::max(column_max[j], n[i][j]);
    }
    if (!(row_sum[i] < Upper(1.0))) return false;  // also where a NaN slipped in
    rho = std::max(rho, row_sum[i]);
  }
  const Upper gap = ProofScalarTraits<I>::one_minus_lower(rho);
  if (!(Upper(0.0) < gap)) return false;
  for (std::size_t i = 0; i < N; ++i) {
    const Upper scaled = row_sum[i] / gap;
    for (std::size_t j = 0; j < N; ++j) q[i][j] = n[i][j] + scaled * column_max[j];
  }
  return true;
}

}  // namespace taut
