// Interval arithmetic over MPFI, at the precision set by the innermost WorkingPrecision.
//
// An Interval stands for a real number x that we do not know exactly, and holds two binary numbers with
// lower <= x <= upper. Each operation returns an Interval that holds the result for every choice of operands:
// MPFR rounds correctly, MPFI rounds outward, and neither depends on the processor's rounding mode.
//
// Invariant: both ends are finite and lower <= upper. Where an operation cannot keep it, it throws Undefined; so no
// NaN and no infinity is ever compared or intersected away.
#pragma once

#include <gmpxx.h>
#include <mpfi.h>
#include <mpfr.h>

#include <string>
#include <utility>

#include "checker/errors.h"

namespace taut::checker {

/// Sets the precision [bits] of all results computed during its life.
class WorkingPrecision {
 public:
  explicit WorkingPrecision(int bits) : previous_(bits_) { bits_ = bits; }
  ~WorkingPrecision() { bits_ = previous_; }
  WorkingPrecision(const WorkingPrecision&) = delete;
  WorkingPrecision& operator=(const WorkingPrecision&) = delete;
  [[nodiscard]] static int bits() { return bits_; }

 private:
  static inline thread_local int bits_ = 128;
  int previous_;
};

class Interval {
 public:
  Interval() : Interval(0) {}
  explicit Interval(int x) : Interval(kUnset) { mpfi_set_si(x_, x); }
  explicit Interval(const mpq_class& x) : Interval(kUnset) {
    mpfi_set_q(x_, x.get_mpq_t());
    require_bounded();
  }
  Interval(const Interval& other) {
    mpfi_init2(x_, mpfi_get_prec(other.x_));
    mpfi_set(x_, other.x_);
  }
  Interval(Interval&& other) noexcept {  // A moved-from Interval owns nothing; it may be assigned to or destroyed.
    *x_ = *other.x_;
    other.x_->left._mpfr_d = nullptr;
  }
  Interval& operator=(const Interval& other) { return *this = Interval(other); }
  Interval& operator=(Interval&& other) noexcept {
    std::swap(*x_, *other.x_);
    return *this;
  }
  ~Interval() {
    if (x_->left._mpfr_d != nullptr) mpfi_clear(x_);
  }

  [[nodiscard]] static Interval pi() {
    return make([](mpfi_ptr r) { mpfi_const_pi(r); });
  }
  [[nodiscard]] static Interval plus_minus_one() {
    return make([](mpfi_ptr r) { mpfi_interv_si(r, -1, 1); });
  }

  [[nodiscard]] mpfr_srcptr lower() const { return &x_->left; }
  [[nodiscard]] mpfr_srcptr upper() const { return &x_->right; }
  [[nodiscard]] bool is_exactly_zero() const { return mpfr_zero_p(lower()) && mpfr_zero_p(upper()); }

  friend Interval operator+(const Interval& a, const Interval& b) {
    return make([&](mpfi_ptr r) { mpfi_add(r, a.x_, b.x_); });
  }
  friend Interval operator-(const Interval& a, const Interval& b) {
    return make([&](mpfi_ptr r) { mpfi_sub(r, a.x_, b.x_); });
  }
  friend Interval operator*(const Interval& a, const Interval& b) {
    return make([&](mpfi_ptr r) { mpfi_mul(r, a.x_, b.x_); });
  }
  friend Interval operator/(const Interval& a, const Interval& b) {
    if (mpfr_sgn(b.lower()) <= 0 && mpfr_sgn(b.upper()) >= 0) throw Undefined("division by what may be zero");
    return make([&](mpfi_ptr r) { mpfi_div(r, a.x_, b.x_); });
  }
  friend Interval operator-(const Interval& a) {
    return make([&](mpfi_ptr r) { mpfi_neg(r, a.x_); });
  }
  Interval& operator+=(const Interval& b) {
    mpfi_add(x_, x_, b.x_);
    require_bounded();
    return *this;
  }
  Interval& operator-=(const Interval& b) {
    mpfi_sub(x_, x_, b.x_);
    require_bounded();
    return *this;
  }

  friend Interval abs(const Interval& a) {
    return make([&](mpfi_ptr r) { mpfi_abs(r, a.x_); });
  }
  friend Interval sqr(const Interval& a) {
    return make([&](mpfi_ptr r) { mpfi_sqr(r, a.x_); });
  }
  friend Interval sqrt(const Interval& a) {
    if (mpfr_sgn(a.lower()) < 0) throw Undefined("square root of what may be negative");
    return make([&](mpfi_ptr r) { mpfi_sqrt(r, a.x_); });
  }
  friend Interval sin(const Interval& a) {
    a.require_angle();
    return make([&](mpfi_ptr r) { mpfi_sin(r, a.x_); });
  }
  friend Interval cos(const Interval& a) {
    a.require_angle();
    return make([&](mpfi_ptr r) { mpfi_cos(r, a.x_); });
  }
  friend Interval exp(const Interval& a) {
    return make([&](mpfi_ptr r) { mpfi_exp(r, a.x_); });
  }
  friend Interval log(const Interval& a) {
    if (mpfr_sgn(a.lower()) <= 0) throw Undefined("logarithm of what may not be positive");
    return make([&](mpfi_ptr r) { mpfi_log(r, a.x_); });
  }
  friend Interval asin(const Interval& a) {
    a.require_sine();
    return make([&](mpfi_ptr r) { mpfi_asin(r, a.x_); });
  }
  friend Interval acos(const Interval& a) {
    a.require_sine();
    return make([&](mpfi_ptr r) { mpfi_acos(r, a.x_); });
  }
  friend Interval atan(const Interval& a) {
    return make([&](mpfi_ptr r) { mpfi_atan(r, a.x_); });
  }

  /// An Interval that holds all of both.
  friend Interval hull(const Interval& a, const Interval& b) {
    return make([&](mpfi_ptr r) { mpfi_union(r, a.x_, b.x_); });
  }
  /// Both a and b hold x; so does the result. An empty one would mean that this program is wrong.
  friend Interval intersection(const Interval& a, const Interval& b) {
    Interval result(kUnset);
    mpfi_intersect(result.x_, a.x_, b.x_);
    if (mpfi_is_empty(result.x_)) throw std::logic_error("two enclosures of one number do not meet");
    result.require_bounded();
    return result;
  }
  /// The one-point Intervals at the ends of a.
  friend Interval lowest(const Interval& a) {
    return make([&](mpfi_ptr r) { mpfi_set_fr(r, a.lower()); });
  }
  friend Interval highest(const Interval& a) {
    return make([&](mpfi_ptr r) { mpfi_set_fr(r, a.upper()); });
  }
  /// The one-point Interval in the middle of a (to rounding).
  friend Interval middle(const Interval& a) {
    return make([&](mpfi_ptr r) {
      mpfi_mid(&r->left, a.x_);
      mpfr_set(&r->right, &r->left, MPFR_RNDN);  // equal precisions: exact
    });
  }

 private:
  enum Unset { kUnset };
  explicit Interval(Unset) { mpfi_init2(x_, WorkingPrecision::bits()); }
  template <class Operation>
  static Interval make(Operation operation) {
    Interval result(kUnset);
    operation(result.x_);
    result.require_bounded();
    return result;
  }
  void require_bounded() const {
    if (!mpfr_number_p(lower()) || !mpfr_number_p(upper()) || mpfr_greater_p(lower(), upper())) {
      throw Undefined("a value beyond the range of the arithmetic");
    }
  }
  void require_sine() const {
    if (mpfr_cmp_si(lower(), -1) < 0 || mpfr_cmp_si(upper(), 1) > 0) {
      throw Undefined("arcsine or arccosine of what may be beyond [-1, 1]");
    }
  }
  /// Every binary64 passes; an argument like 10^1000000 would only burn time and memory in the reduction by pi.
  void require_angle() const {
    constexpr mpfr_exp_t kLargestExponent = 1100;
    for (mpfr_srcptr end : {lower(), upper()}) {
      if (mpfr_regular_p(end) && mpfr_get_exp(end) > kLargestExponent)
        throw Undefined("sine or cosine of a huge number");
    }
  }

  mpfi_t x_;
};

// Comparisons have three values. Each of these is true only where it holds for every number in the interval.
inline bool certainly_positive(const Interval& a) { return mpfr_sgn(a.lower()) > 0; }
inline bool certainly_negative(const Interval& a) { return mpfr_sgn(a.upper()) < 0; }
inline bool certainly_nonnegative(const Interval& a) { return mpfr_sgn(a.lower()) >= 0; }
inline bool certainly_nonpositive(const Interval& a) { return mpfr_sgn(a.upper()) <= 0; }

/// Every number in a is in b.
inline bool is_within(const Interval& a, const Interval& b) {
  return mpfr_lessequal_p(b.lower(), a.lower()) && mpfr_lessequal_p(a.upper(), b.upper());
}

inline Interval max(const Interval& a, const Interval& b) {  // (a + b + |a - b|) / 2 would lose bits
  if (certainly_nonnegative(a - b)) return a;
  if (certainly_nonnegative(b - a)) return b;
  return hull(a, b);
}

/// x^n for an integer n; 0^0 = 1, as in polynomials.
inline Interval power(const Interval& x, int n) {
  if (n < 0) return Interval(1) / power(x, -n);
  if (n == 0) return Interval(1);
  if (n == 1) return x;
  if (n % 2 == 0) return sqr(power(x, n / 2));
  if (certainly_nonnegative(x) || certainly_nonpositive(x)) return x * power(x, n - 1);
  return hull(power(lowest(x), n), power(highest(x), n));  // it increases
}

/// The angle of (x, y) in (-pi, pi]; throws Undefined where (x, y) may be the origin or cross the cut y = 0, x < 0.
inline Interval atan2(const Interval& y, const Interval& x) {
  if (certainly_positive(x)) return atan(y / x);
  const Interval right_angle = Interval::pi() / Interval(2);
  if (certainly_positive(y)) return right_angle - atan(x / y);
  if (certainly_negative(y)) return -right_angle - atan(x / y);
  if (y.is_exactly_zero() && certainly_negative(x)) return Interval::pi();
  throw Undefined("atan2 at what may be the origin or its cut");
}

}  // namespace taut::checker
