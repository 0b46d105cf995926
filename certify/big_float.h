// A multiprecision number: mpfr_t with value semantics, at the precision that this thread works in.
//
// Arithmetic operators round to nearest and are for approximations; directed rounding goes through MpfrRounding
// (mp_interval.h). Boost.Multiprecision's mpfr_float is not used: in Boost 1.74 its default precision is one
// variable for all threads.
#pragma once

#include <mpfr.h>

#include <string>
#include <utility>

namespace taut {

/// Bits of every BigFloat that this thread makes from now on.
[[nodiscard]] mpfr_prec_t working_precision();

/// Sets working_precision() while in scope.
class PrecisionScope {
 public:
  explicit PrecisionScope(mpfr_prec_t bits);
  ~PrecisionScope();
  PrecisionScope(const PrecisionScope&) = delete;
  PrecisionScope& operator=(const PrecisionScope&) = delete;

 private:
  mpfr_prec_t saved_;
};

class BigFloat {
 public:
  BigFloat() {
    mpfr_init2(x_, working_precision());
    mpfr_set_zero(x_, 1);
  }
  /// Exact where the working precision is at least 53 bits (it always is).
  explicit(false) BigFloat(double x) {
    mpfr_init2(x_, working_precision());
    mpfr_set_d(x_, x, MPFR_RNDN);
  }
  explicit(false) BigFloat(int x) : BigFloat(static_cast<double>(x)) {}
  BigFloat(const BigFloat& other) {
    mpfr_init2(x_, mpfr_get_prec(other.x_));
    mpfr_set(x_, other.x_, MPFR_RNDN);
  }
  BigFloat(BigFloat&& other) noexcept {
    mpfr_init2(x_, MPFR_PREC_MIN);
    mpfr_swap(x_, other.x_);
  }
  BigFloat& operator=(const BigFloat& other) {
    if (this != &other) {
      mpfr_set_prec(x_, mpfr_get_prec(other.x_));
      mpfr_set(x_, other.x_, MPFR_RNDN);
    }
    return *this;
  }
  BigFloat& operator=(BigFloat&& other) noexcept {
    mpfr_swap(x_, other.x_);
    return *this;
  }
  ~BigFloat() { mpfr_clear(x_); }

  [[nodiscard]] mpfr_srcptr get() const { return x_; }
  [[nodiscard]] mpfr_ptr get() { return x_; }

  /// Exact, whatever the precision of `a`: interval ends are negated by it.
  friend BigFloat operator-(BigFloat a) {
    mpfr_neg(a.x_, a.x_, MPFR_RNDN);
    return a;
  }
  /// Exact likewise.
  friend BigFloat abs(BigFloat a) {
    mpfr_abs(a.x_, a.x_, MPFR_RNDN);
    return a;
  }
  friend BigFloat operator+(const BigFloat& a, const BigFloat& b) { return apply(mpfr_add, a, b); }
  friend BigFloat operator-(const BigFloat& a, const BigFloat& b) { return apply(mpfr_sub, a, b); }
  friend BigFloat operator*(const BigFloat& a, const BigFloat& b) { return apply(mpfr_mul, a, b); }
  friend BigFloat operator/(const BigFloat& a, const BigFloat& b) { return apply(mpfr_div, a, b); }
  BigFloat& operator+=(const BigFloat& b) { return *this = *this + b; }
  BigFloat& operator-=(const BigFloat& b) { return *this = *this - b; }
  BigFloat& operator*=(const BigFloat& b) { return *this = *this * b; }
  BigFloat& operator/=(const BigFloat& b) { return *this = *this / b; }

  friend bool operator<(const BigFloat& a, const BigFloat& b) { return mpfr_less_p(a.x_, b.x_) != 0; }
  friend bool operator>(const BigFloat& a, const BigFloat& b) { return mpfr_greater_p(a.x_, b.x_) != 0; }
  friend bool operator<=(const BigFloat& a, const BigFloat& b) { return mpfr_lessequal_p(a.x_, b.x_) != 0; }
  friend bool operator>=(const BigFloat& a, const BigFloat& b) { return mpfr_greaterequal_p(a.x_, b.x_) != 0; }
  friend bool operator==(const BigFloat& a, const BigFloat& b) { return mpfr_equal_p(a.x_, b.x_) != 0; }
  friend bool operator!=(const BigFloat& a, const BigFloat& b) { return !(a == b); }

  [[nodiscard]] double to_double(mpfr_rnd_t rounding = MPFR_RNDN) const { return mpfr_get_d(x_, rounding); }

  /// Calls an MPFR function (result, arguments…, rounding).
  template <class F, class... Args>
  static BigFloat apply_rounded(mpfr_rnd_t rounding, F function, const Args&... args) {
    BigFloat result;
    function(result.x_, args.x_..., rounding);
    return result;
  }

 private:
  template <class F, class... Args>
  static BigFloat apply(F function, const Args&... args) {
    return apply_rounded(MPFR_RNDN, function, args...);
  }

  mpfr_t x_;
};

inline double lower_bound(const BigFloat& x) { return x.to_double(MPFR_RNDD); }
inline double upper_bound(const BigFloat& x) { return x.to_double(MPFR_RNDU); }

}  // namespace taut
