// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/arithmetic/dyadic.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace taut {
namespace {

using boost::multiprecision::cpp_int;

constexpr int kBinary64Bits = 53;

/// Number of bits of k >= 0.
int bits(const cpp_int& k) { return k == 0 ? 0 : static_cast<int>(boost::multiprecision::msb(k)) + 1; }

double power_of_two(int exponent) { return std::ldexp(1.0, exponent); }

/// k/2^depth rounded in the given direction.
BigFloat rounded(const Dyadic& x, mpfr_rnd_t direction) {
  BigFloat result;
  // Hexadecimal: MPFR rounds it once; the power of two is exact.
  mpfr_set_str(result.get(), x.k.str(0, std::ios_base::hex).c_str(), 16, direction);
  mpfr_div_2si(result.get(), result.get(), x.depth, direction);
  return result;
}

}  // namespace

Dyadic Dyadic::nearest(const BigFloat& x, int depth) {
  const PrecisionScope precision(std::max<mpfr_prec_t>(mpfr_get_prec(x.get()), 64));
  BigFloat scaled = x;
  mpfr_mul_2si(scaled.get(), scaled.get(), depth, MPFR_RNDN);
  if (!(scaled > BigFloat(0.0))) return {0, depth};
  mpfr_rint(scaled.get(), scaled.get(), MPFR_RNDN);
  char* text = nullptr;
  mpfr_asprintf(&text, "%.0Rf", scaled.get());
  const cpp_int k(text);
  mpfr_free_str(text);
  const cpp_int one = cpp_int(1) << depth;
  return {std::min(k, one), depth};
}

double Dyadic::approx() const {
  const PrecisionScope precision(kBinary64Bits);
  return rounded(*this, MPFR_RNDN).to_double();
}

std::string Dyadic::text() const {
  if (k == 0) return "0";
  const int common = std::min(static_cast<int>(boost::multiprecision::lsb(k)), depth);
  const cpp_int numerator = k >> common;
  const cpp_int denominator = cpp_int(1) << (depth - common);
  return denominator == 1 ? numerator.str() : numerator.str() + "/" + denominator.str();
}

std::strong_ordering operator<=>(const Dyadic& a, const Dyadic& b) {
  const int depth = std::max(a.depth, b.depth);
  const cpp_int left = a.k << (depth - a.depth);
  const cpp_int right = b.k << (depth - b.depth);
  return left.compare(right) <=> 0;
}

// Out of line: GCC 12 sees ends beyond the bounds of cpp_int's own storage where it inlines these.
Dyadic DyadicBox::lower() const { return {k, depth}; }
Dyadic DyadicBox::upper() const { return {k + 1, depth}; }
Dyadic DyadicBox::mid() const { return {2 * k + 1, depth + 1}; }
DyadicBox DyadicBox::left() const { return {2 * k, depth + 1}; }
DyadicBox DyadicBox::right() const { return {2 * k + 1, depth + 1}; }
double DyadicBox::radius() const { return power_of_two(-depth - 1); }

template <>
Interval enclose(const Dyadic& x) {
  const int surplus = bits(x.k) - kBinary64Bits;
  if (surplus <= 0) return {std::ldexp(static_cast<double>(static_cast<std::int64_t>(x.k)), -x.depth)};
  // k is next to a number of 53 bits, or between two such.
  const auto head = static_cast<std::int64_t>(x.k >> surplus);
  const double lower = std::ldexp(static_cast<double>(head), surplus - x.depth);
  const double upper = std::ldexp(static_cast<double>(head + 1), surplus - x.depth);
  return {lower, upper};
}

template <>
MpInterval enclose(const Dyadic& x) {
  return {rounded(x, MPFR_RNDD), rounded(x, MPFR_RNDU)};
}

template <>
EnclosedBox<Interval> enclose(const DyadicBox& box) {
  if (box.depth < kBinary64Bits) {  // k + 1/2 < 2^52 has at most 53 bits: all exact
    const auto k = static_cast<double>(static_cast<std::int64_t>(box.k));
    const double width = power_of_two(-box.depth);
    return {{k * width, (k + 1.0) * width}, {(k + 0.5) * width}};
  }
  return {hull(enclose<Interval>(box.lower()), enclose<Interval>(box.upper())), enclose<Interval>(box.mid())};
}

template <>
EnclosedBox<MpInterval> enclose(const DyadicBox& box) {
  return {hull(enclose<MpInterval>(box.lower()), enclose<MpInterval>(box.upper())), enclose<MpInterval>(box.mid())};
}

}  // namespace taut
