// SPDX-License-Identifier: GPL-3.0-or-later
// A binary64 number that carries a bound on its own error: the first instance of the campaign's judge. Where even many
// times the bound leaves no doubt, nothing is asked of 200 bits.
#pragma once

#include <cmath>
#include <limits>

namespace taut::campaign {

/// The true number is within `error` of `value`: a running error analysis, in which each operation adds a whole ulp for
/// its own rounding, in whatever direction. Comparisons ask for what may be: a < b compares the numbers' lower ends and
/// a > b their upper ends, so that the least of several numbers has the least lower end. NaN and infinity say nothing.
struct Guarded {
  double value = 0, error = 0;

  Guarded() = default;
  explicit Guarded(double x) : value(x) {}
  Guarded(double x, double bound) : value(x), error(bound) {}
  /// `x` is the result of one operation on numbers whose errors change it by up to `bound`.
  static Guarded rounded(double x, double bound) {
    return {x, bound + std::numeric_limits<double>::epsilon() * std::abs(x)};
  }

  friend Guarded operator-(const Guarded& a) { return {-a.value, a.error}; }
  friend Guarded operator+(const Guarded& a, const Guarded& b) { return rounded(a.value + b.value, a.error + b.error); }
  friend Guarded operator-(const Guarded& a, const Guarded& b) { return rounded(a.value - b.value, a.error + b.error); }
  friend Guarded operator*(const Guarded& a, const Guarded& b) {
    const double product = a.value * b.value;
    if (std::abs(product) < std::numeric_limits<double>::min() && a.value != 0 && b.value != 0) return nothing();
    return rounded(product, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error);
  }
  friend Guarded operator/(const Guarded& a, const Guarded& b) {
    if (!(std::abs(b.value) > 2 * b.error)) return nothing();
    const double quotient = a.value / b.value;
    if (std::abs(quotient) < std::numeric_limits<double>::min() && a.value != 0) return nothing();
    return rounded(quotient, (a.error + std::abs(quotient) * b.error) / (std::abs(b.value) - b.error));
  }
  friend bool operator<(const Guarded& a, const Guarded& b) { return a.value - a.error < b.value - b.error; }
  friend bool operator>(const Guarded& a, const Guarded& b) { return a.value + a.error > b.value + b.error; }

  /// Positive beyond doubt, at any sixteenth of its distance from 0.
  [[nodiscard]] bool is_surely_positive() const { return value > 16 * error; }
  [[nodiscard]] bool is_surely_negative() const { return -value > 16 * error; }

 private:
  static Guarded nothing() { return {0, std::numeric_limits<double>::infinity()}; }
};

inline Guarded root(const Guarded& x) {
  if (!(x.value > 2 * x.error)) return {std::sqrt(std::abs(x.value)), 2 * std::sqrt(std::abs(x.value) + x.error)};
  const double value = std::sqrt(x.value);
  return Guarded::rounded(value, x.error / value);
}
inline Guarded magnitude(const Guarded& x) { return {std::abs(x.value), x.error}; }

}  // namespace taut::campaign
