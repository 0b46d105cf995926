// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that enclose: balls over Arb, at the precision set by the innermost WorkingPrecision.
//
// A Ball stands for a real number x that we do not know exactly: it holds a binary number m and a bound r with
// |x - m| <= r. Each operation returns a Ball that holds the result for every choice of operands (F. Johansson, "Arb:
// efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Trans. Computers 2017). Arb computes with
// integers; it depends neither on the processor's rounding mode nor on MPFR, which the prover uses.
//
// Invariant: m and r are finite. Where an operation cannot keep it, it throws Undefined. (Sums and products of finite
// balls are finite, as Arb's exponents are unbounded.)
#pragma once

#include <arb.h>
#include <flint/fmpq.h>
#include <gmpxx.h>

#include <utility>

#include "checker/kernel/errors.h"

namespace taut::checker {

/// Sets the precision [bits] of all results computed during its life, in this thread.
class WorkingPrecision {
 public:
  explicit WorkingPrecision(int bits) : previous_(std::exchange(bits_, bits)) {}
  ~WorkingPrecision() { bits_ = previous_; }
  WorkingPrecision(const WorkingPrecision&) = delete;
  WorkingPrecision& operator=(const WorkingPrecision&) = delete;
  [[nodiscard]] static int bits() { return bits_; }

 private:
  static inline thread_local int bits_ = 64;
  int previous_;
};

class Ball {
 public:
  Ball() { arb_init(x_); }
  explicit Ball(int x) : Ball() { arb_set_si(x_, x); }
  /// exact
  explicit Ball(double x) : Ball(make([x](arb_ptr r) { arb_set_d(r, x); })) {}
  explicit Ball(const mpq_class& x) : Ball() {
    fmpq_t q;
    fmpq_init(q);
    fmpq_set_mpq(q, x.get_mpq_t());
    arb_set_fmpq(x_, q, bits());
    fmpq_clear(q);
  }
  Ball(const Ball& other) : Ball() { arb_set(x_, other.x_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(x_, other.x_); }
  Ball& operator=(Ball other) noexcept {
    arb_swap(x_, other.x_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }

  [[nodiscard]] arb_srcptr get() const { return x_; }
  [[nodiscard]] bool is_zero() const { return arb_is_zero(x_) != 0; }
  [[nodiscard]] static int bits() { return WorkingPrecision::bits(); }

  /// The result of `operation(arb_ptr)`, which writes an enclosure. @throws Undefined unless it is finite.
  template <class Operation>
  [[nodiscard]] static Ball make(Operation operation) {
    Ball result;
    operation(result.x_);
    if (!arb_is_finite(result.x_)) throw Undefined("a value that may be undefined or infinite");
    return result;
  }
  /// The result of one of Arb's functions, rounded to the working precision.
  template <auto kArb, class... Operands>
  [[nodiscard]] static Ball by(const Operands&... operands) {
    return make([&](arb_ptr r) { kArb(r, operands.get()..., bits()); });
  }
  [[nodiscard]] static Ball pi() { return by<arb_const_pi>(); }
  /// a_0 b_0 + … of n numbers each, which are so far apart in memory.
  [[nodiscard]] static Ball sum_of_products(slong n, const Ball& a_0, slong a_step, const Ball& b_0, slong b_step) {
    static_assert(sizeof(Ball) == sizeof(arb_struct));
    Ball result;
    arb_dot(result.x_, nullptr, 0, a_0.x_, a_step, b_0.x_, b_step, n, bits());
    return result;
  }

  friend Ball operator+(const Ball& a, const Ball& b) { return finite<arb_add>(a, b); }
  friend Ball operator-(const Ball& a, const Ball& b) { return finite<arb_sub>(a, b); }
  friend Ball operator*(const Ball& a, const Ball& b) { return finite<arb_mul>(a, b); }
  friend Ball operator/(const Ball& a, const Ball& b) { return by<arb_div>(a, b); }
  friend Ball operator-(const Ball& a) {
    Ball result;
    arb_neg(result.x_, a.x_);
    return result;
  }
  Ball& operator+=(const Ball& b) {
    arb_add(x_, x_, b.x_, bits());
    return *this;
  }
  Ball& operator-=(const Ball& b) {
    arb_sub(x_, x_, b.x_, bits());
    return *this;
  }
  /// *this += a b
  Ball& add_product(const Ball& a, const Ball& b) {
    arb_addmul(x_, a.x_, b.x_, bits());
    return *this;
  }
  /// *this -= a b
  Ball& subtract_product(const Ball& a, const Ball& b) {
    arb_submul(x_, a.x_, b.x_, bits());
    return *this;
  }

 private:
  /// by(), of a function whose results are finite.
  template <auto kArb>
  [[nodiscard]] static Ball finite(const Ball& a, const Ball& b) {
    Ball result;
    kArb(result.x_, a.x_, b.x_, bits());
    return result;
  }

  arb_t x_;
};

inline Ball sqrt(const Ball& a) { return Ball::by<arb_sqrt>(a); }
/// a / 2, exactly.
inline Ball half(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arb_mul_2exp_si(r, a.get(), -1); });
}

// Comparisons have three values. Each of these is true only where it holds for every number in the ball.
inline bool certainly_positive(const Ball& a) { return arb_is_positive(a.get()) != 0; }
inline bool certainly_negative(const Ball& a) { return arb_is_negative(a.get()) != 0; }
inline bool certainly_nonnegative(const Ball& a) { return arb_is_nonnegative(a.get()) != 0; }
/// Every number in a is in b.
inline bool is_within(const Ball& a, const Ball& b) { return arb_contains(b.get(), a.get()) != 0; }

/// What one of Arb's functions says of the numbers in a, as one number (a ball of radius 0).
template <auto kArb>
Ball bound(const Ball& a) {
  return Ball::make([&](arb_ptr r) { kArb(arb_midref(r), a.get(), Ball::bits()); });
}
/// One number, not below |x| for any x in a; not above |x|; not below x; not above x.
inline Ball magnitude(const Ball& a) { return bound<arb_get_abs_ubound_arf>(a); }
inline Ball least_magnitude(const Ball& a) { return bound<arb_get_abs_lbound_arf>(a); }
inline Ball highest(const Ball& a) { return bound<arb_get_ubound_arf>(a); }
inline Ball lowest(const Ball& a) { return bound<arb_get_lbound_arf>(a); }
/// The number in the middle of a, exactly.
inline Ball middle(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arf_set(arb_midref(r), arb_midref(a.get())); });
}
/// Of two single numbers.
inline const Ball& larger(const Ball& a, const Ball& b) {
  return arf_cmp(arb_midref(a.get()), arb_midref(b.get())) < 0 ? b : a;
}
inline const Ball& smaller(const Ball& a, const Ball& b) { return &larger(a, b) == &a ? b : a; }

/// Every number from any in a to any in b.
inline Ball hull(const Ball& a, const Ball& b) { return Ball::by<arb_union>(a, b); }
/// Every number that is in both. @pre there is one
inline Ball intersection(const Ball& a, const Ball& b) { return Ball::by<arb_intersection>(a, b); }
/// a, widened by every number of magnitude up to that of b.
inline Ball plus_minus(const Ball& a, const Ball& b) {
  return Ball::make([&](arb_ptr r) {
    arb_set(r, a.get());
    arb_add_error(r, b.get());
  });
}
/// Every number of magnitude up to that of b.
inline Ball plus_minus(const Ball& b) { return plus_minus(Ball(), b); }
/// Every number in [0, b] or [b, 0], for each b in the ball.
inline Ball from_zero_to(const Ball& b) { return plus_minus(half(b), magnitude(half(b))); }
/// A square is not negative: where the ball of the product would hold negative numbers, [0, |a|^2] does instead.
inline Ball sqr(const Ball& a) {
  const Ball result = Ball::by<arb_sqr>(a);
  return certainly_nonnegative(result) ? result : hull(Ball(), Ball::by<arb_sqr>(magnitude(a)));
}

/// Analytic functions of one variable.
enum class Function { kInverse, kSqrt, kSin, kCos, kExp, kLog, kAsin, kAcos, kAtan };

/// f(x), f'(x), f''(x) for every x in the ball. @throws Undefined where f (or that derivative) may be undefined.
[[nodiscard]] Ball value(Function f, const Ball& x);
[[nodiscard]] Ball first_derivative(Function f, const Ball& x);
[[nodiscard]] Ball second_derivative(Function f, const Ball& x);
/// x^n for an integer n; 0^0 = 1, as in polynomials.
[[nodiscard]] Ball power(const Ball& x, int n);

}  // namespace taut::checker
