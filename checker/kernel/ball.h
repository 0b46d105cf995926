// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that enclose: balls over Arb, at the precision set by the innermost WorkingPrecision.
//
// A Ball stands for a real number x that we do not know exactly: it holds a binary number m and a bound r with
// |x - m| <= r. Each operation returns a Ball that holds the result for every choice of operands (F. Johansson, "Arb:
// efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Trans. Computers 2017). Arb computes with
// integers; it depends neither on the processor's rounding mode nor on MPFR, which the prover uses.
//
// Invariant: m and r are finite. Where an operation cannot keep it, it throws Undefined.
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
  explicit WorkingPrecision(int bits) : previous_(bits_) { bits_ = bits; }
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
  explicit Ball(double x) : Ball() {
    arb_set_d(x_, x);
    require_finite();
  }  ///< exact
  explicit Ball(const mpq_class& x) : Ball() {
    fmpq_t q;
    fmpq_init(q);
    fmpq_set_mpq(q, x.get_mpq_t());
    arb_set_fmpq(x_, q, bits());
    fmpq_clear(q);
  }
  Ball(const Ball& other) : Ball() { arb_set(x_, other.x_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(x_, other.x_); }
  Ball& operator=(const Ball& other) {
    arb_set(x_, other.x_);
    return *this;
  }
  Ball& operator=(Ball&& other) noexcept {
    arb_swap(x_, other.x_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }

  [[nodiscard]] static Ball pi() {
    return make([](arb_ptr r) { arb_const_pi(r, bits()); });
  }

  [[nodiscard]] arb_srcptr get() const { return x_; }
  [[nodiscard]] bool is_zero() const { return arb_is_zero(x_) != 0; }

  /// The result of `operation(arb_ptr)`, which writes an enclosure. @throws Undefined unless it is finite.
  template <class Operation>
  [[nodiscard]] static Ball make(Operation operation) {
    Ball result;
    operation(result.x_);
    result.require_finite();
    return result;
  }
  [[nodiscard]] static int bits() { return WorkingPrecision::bits(); }

  friend Ball operator+(const Ball& a, const Ball& b) {
    return make([&](arb_ptr r) { arb_add(r, a.x_, b.x_, bits()); });
  }
  friend Ball operator-(const Ball& a, const Ball& b) {
    return make([&](arb_ptr r) { arb_sub(r, a.x_, b.x_, bits()); });
  }
  friend Ball operator*(const Ball& a, const Ball& b) {
    return make([&](arb_ptr r) { arb_mul(r, a.x_, b.x_, bits()); });
  }
  friend Ball operator/(const Ball& a, const Ball& b) {
    return make([&](arb_ptr r) { arb_div(r, a.x_, b.x_, bits()); });
  }
  friend Ball operator-(const Ball& a) {
    return make([&](arb_ptr r) { arb_neg(r, a.x_); });
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

 private:
  void require_finite() const {
    if (!arb_is_finite(x_)) throw Undefined("a value that may be undefined or infinite");
  }
  arb_t x_;
};

inline Ball sqrt(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arb_sqrt(r, a.get(), Ball::bits()); });
}

// Comparisons have three values. Each of these is true only where it holds for every number in the ball.
inline bool certainly_positive(const Ball& a) { return arb_is_positive(a.get()) != 0; }
inline bool certainly_negative(const Ball& a) { return arb_is_negative(a.get()) != 0; }
inline bool certainly_nonnegative(const Ball& a) { return arb_is_nonnegative(a.get()) != 0; }
/// Every number in a is in b.
inline bool is_within(const Ball& a, const Ball& b) { return arb_contains(b.get(), a.get()) != 0; }

/// One number, not below |x| for any x in a.
inline Ball magnitude(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arb_get_abs_ubound_arf(arb_midref(r), a.get(), Ball::bits()); });
}
/// One number, not below (not above) any x in a.
inline Ball highest(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arb_get_ubound_arf(arb_midref(r), a.get(), Ball::bits()); });
}
inline Ball lowest(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arb_get_lbound_arf(arb_midref(r), a.get(), Ball::bits()); });
}
/// One number, not above |x| for any x in a.
inline Ball least_magnitude(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arb_get_abs_lbound_arf(arb_midref(r), a.get(), Ball::bits()); });
}
/// The number in the middle of a, exactly.
inline Ball middle(const Ball& a) {
  return Ball::make([&](arb_ptr r) { arf_set(arb_midref(r), arb_midref(a.get())); });
}
/// Every number from any in a to any in b.
inline Ball hull(const Ball& a, const Ball& b) {
  return Ball::make([&](arb_ptr r) { arb_union(r, a.get(), b.get(), Ball::bits()); });
}
/// A square is not negative: where the ball of the product would hold negative numbers, [0, |a|^2] does instead.
inline Ball sqr(const Ball& a) {
  const auto square = [](const Ball& x) { return Ball::make([&](arb_ptr r) { arb_sqr(r, x.get(), Ball::bits()); }); };
  Ball result = square(a);
  return certainly_nonnegative(result) ? result : hull(Ball(), square(magnitude(a)));
}

/// a, widened by every number of magnitude up to that of b.
inline Ball plus_minus(const Ball& a, const Ball& b) {
  return Ball::make([&](arb_ptr r) {
    arb_set(r, a.get());
    arb_add_error(r, b.get());
  });
}
/// Every number of magnitude up to that of b.
inline Ball plus_minus(const Ball& b) { return plus_minus(Ball(), b); }
/// The larger of two nonnegative single numbers.
inline const Ball& larger(const Ball& a, const Ball& b) {
  return arf_cmp(arb_midref(a.get()), arb_midref(b.get())) < 0 ? b : a;
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
