// SPDX-License-Identifier: GPL-3.0-or-later
// A multiprecision number: mpfr_t with value semantics, at the precision that this thread works in.
//
// Arithmetic operators round to nearest and are for approximations; directed rounding goes through MpfrRounding
// (mp_interval.h). Boost.Multiprecision's mpfr_float is not used: in Boost 1.74 its default precision is one
// variable for all threads.
#pragma once

#include <mpfr.h>

#include <array>
#include <string>
#include <utility>

namespace taut {

namespace big_float_detail {
inline constinit thread_local mpfr_prec_t precision = 128;
}

/// Bits of every BigFloat that this thread makes from now on.
[[nodiscard]] inline mpfr_prec_t working_precision() { return big_float_detail::precision; }

/// Sets working_precision() while in scope.
class PrecisionScope {
 public:
  explicit PrecisionScope(mpfr_prec_t bits) : saved_(working_precision()) { big_float_detail::precision = bits; }
  ~PrecisionScope() { big_float_detail::precision = saved_; }
  PrecisionScope(const PrecisionScope&) = delete;
  PrecisionScope& operator=(const PrecisionScope&) = delete;

 private:
  mpfr_prec_t saved_;
};

/// Numbers of up to kInPlaceBits live where they are declared: allocations took a third of the soundness campaign's
/// time. Longer ones live on the heap.
class BigFloat {
 public:
  static constexpr mpfr_prec_t kInPlaceBits = 256;

  BigFloat() {
    make(working_precision());
    mpfr_set_zero(x_, 1);
  }
  /// Exact where the working precision is at least 53 bits (it always is).
  explicit(false) BigFloat(double x) {
    make(working_precision());
    mpfr_set_d(x_, x, MPFR_RNDN);
  }
  explicit(false) BigFloat(int x) : BigFloat(static_cast<double>(x)) {}
  BigFloat(const BigFloat& other) { copy(other); }
  BigFloat(BigFloat&& other) noexcept { take(other); }
  BigFloat& operator=(const BigFloat& other) {
    if (this == &other) return *this;
    clear();
    copy(other);
    return *this;
  }
  BigFloat& operator=(BigFloat&& other) noexcept {
    if (this == &other) return *this;
    clear();
    take(other);
    return *this;
  }
  ~BigFloat() { clear(); }

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

  /// `digits` significant digits (at least 2), rounded in the given direction: "-1.25e-03".
  [[nodiscard]] std::string to_decimal(int digits, mpfr_rnd_t rounding) const {
    if (mpfr_number_p(x_) == 0) return mpfr_nan_p(x_) != 0 ? "nan" : mpfr_sgn(x_) < 0 ? "-inf" : "inf";
    mpfr_exp_t exponent = 0;
    char* const all = mpfr_get_str(nullptr, &exponent, 10, static_cast<std::size_t>(digits), x_, rounding);
    std::string text = all;
    mpfr_free_str(all);
    text.insert(text.starts_with('-') ? 2 : 1, ".");
    exponent -= mpfr_zero_p(x_) != 0 ? 0 : 1;  // MPFR's point is before the first digit
    const std::string power = std::to_string(exponent < 0 ? -exponent : exponent);
    return text + (exponent < 0 ? "e-" : "e+") + (power.size() < 2 ? "0" : "") + power;
  }

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

  using Limbs = std::array<mp_limb_t, kInPlaceBits / (8 * sizeof(mp_limb_t))>;
  static_assert(kInPlaceBits % (8 * sizeof(mp_limb_t)) == 0);

  // MPFR's custom interface: it never moves or frees limbs that it was handed.
  [[nodiscard]] bool is_in_place() const { return mpfr_get_prec(x_) <= kInPlaceBits; }
  void make(mpfr_prec_t bits) {
    if (bits <= kInPlaceBits) {
      mpfr_custom_init_set(x_, MPFR_ZERO_KIND, 0, bits, limbs_.data());
    } else {
      mpfr_init2(x_, bits);
    }
  }
  void clear() {
    if (!is_in_place()) mpfr_clear(x_);
  }
  /// Into what holds no number yet.
  void copy(const BigFloat& other) {
    if (other.is_in_place()) {
      x_[0] = other.x_[0];
      limbs_ = other.limbs_;
      mpfr_custom_move(x_, limbs_.data());
      if (mpfr_nan_p(x_) != 0) mpfr_set_nanflag();  // as mpfr_set does: the flag is a fault's
    } else {
      mpfr_init2(x_, mpfr_get_prec(other.x_));
      mpfr_set(x_, other.x_, MPFR_RNDN);
    }
  }
  /// Likewise; `other` holds another number after it.
  void take(BigFloat& other) {
    if (other.is_in_place()) return copy(other);
    x_[0] = other.x_[0];
    other.make(MPFR_PREC_MIN);
  }

  mpfr_t x_;
  Limbs limbs_{};
};

inline double lower_bound(const BigFloat& x) { return x.to_double(MPFR_RNDD); }
inline double upper_bound(const BigFloat& x) { return x.to_double(MPFR_RNDU); }

}  // namespace taut
