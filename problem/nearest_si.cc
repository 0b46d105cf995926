// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/nearest_si.h"

#include <mpfr.h>

#include <cmath>
#include <optional>
#include <utility>

#include "problem/decimal.h"
#include "problem/scalar.h"

namespace taut {
namespace {

constexpr mpfr_prec_t kFirstBits = 128;  // decides the rounding of all but about one number in 10^20

class Number {
 public:
  explicit Number(mpfr_prec_t bits) { mpfr_init2(x_, bits); }
  ~Number() { mpfr_clear(x_); }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  [[nodiscard]] mpfr_ptr get() { return x_; }

 private:
  mpfr_t x_;
};

/// Whether a result is far inside the range that a Decimal may have.
bool is_usual(double x) {
  constexpr double kMost = 1e250;
  return std::abs(x) < kMost && std::abs(x) > 1 / kMost;
}

/// Whether this may be a decimal: mpfr_strtofr() also accepts "inf", "nan" and blanks.
bool has_only_decimal_characters(const std::string& text) {
  return text.find_first_not_of("+-.0123456789eE") == std::string::npos;
}

}  // namespace

NearestSi::NearestSi(Unit unit) : unit_(std::move(unit)), factor_(unit_.factor.text()) {}

std::optional<double> NearestSi::at_precision(const std::string& text, long bits) const {
  if (!has_only_decimal_characters(text)) return std::nullopt;
  Number value(bits), factor(bits), error(bits), bound(bits);
  char* end = nullptr;
  mpfr_strtofr(value.get(), text.c_str(), &end, 10, MPFR_RNDN);
  if (end != text.c_str() + text.size() || mpfr_regular_p(value.get()) == 0) return std::nullopt;
  if (unit_.is_degree) {
    mpfr_const_pi(factor.get(), MPFR_RNDN);
    mpfr_div_ui(factor.get(), factor.get(), 180, MPFR_RNDN);
  } else {
    mpfr_set_str(factor.get(), factor_.c_str(), 10, MPFR_RNDN);
  }
  mpfr_mul(value.get(), value.get(), factor.get(), MPFR_RNDN);
  // There are four roundings, each of at most 2^-bits of the value; 2^(4-bits) also covers the rounding of the bounds.
  mpfr_mul_2si(error.get(), value.get(), 4 - bits, MPFR_RNDA);
  mpfr_sub(bound.get(), value.get(), error.get(), MPFR_RNDN);
  const double one_side = mpfr_get_d(bound.get(), MPFR_RNDN);
  mpfr_add(bound.get(), value.get(), error.get(), MPFR_RNDN);
  if (mpfr_get_d(bound.get(), MPFR_RNDN) != one_side) return std::nullopt;
  return one_side;
}

double NearestSi::operator()(std::string_view typed) const {
  constexpr std::size_t kUsualSize = 40;
  if (typed == "0") return 0;
  if (typed.size() <= kUsualSize) {
    const auto result = at_precision(std::string(typed), kFirstBits);
    if (result && is_usual(*result)) return *result;
  }
  const Decimal value = Decimal::parse(typed);
  if (value.sign() == 0) return 0;
  if (!unit_.is_degree) return ScalarTraits<double>::from_decimal((value * unit_.factor).text());  // may be a tie
  const std::string text = value.text();
  for (mpfr_prec_t bits = 2 * kFirstBits;; bits *= 2) {  // ends: the value is irrational, so it is no tie
    if (const auto result = at_precision(text, bits)) return *result;
  }
}

}  // namespace taut
