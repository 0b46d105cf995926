// SPDX-License-Identifier: GPL-3.0-or-later
// Where on a segment: exact binary fractions of [0, 1].
//
// Nearly all boxes are so shallow that their ends are binary64 numbers; a margin of 1e-40 takes boxes of width 2^-67.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <compare>
#include <string>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"

namespace taut {

/// k/2^depth in [0, 1], not necessarily in lowest terms.
struct Dyadic {
  boost::multiprecision::cpp_int k = 0;
  int depth = 0;

  /// The one of this depth nearest to x, or to the end of [0, 1] where x is outside. @pre x is a number, below 2^1000
  [[nodiscard]] static Dyadic nearest(const BigFloat& x, int depth);

  [[nodiscard]] double approx() const;     ///< nearest binary64
  [[nodiscard]] std::string text() const;  ///< "0", "1" or "k/m" in lowest terms: exact

  // As numbers: 1/2 is 2/4.
  friend std::strong_ordering operator<=>(const Dyadic& a, const Dyadic& b);
  friend bool operator==(const Dyadic& a, const Dyadic& b) { return std::is_eq(a <=> b); }
};

/// [k/2^depth, (k+1)/2^depth] within [0, 1].
struct DyadicBox {
  static constexpr int kMaxDepth = 999;  ///< a certificate's denominators are at most 2^1000, those of midpoints too

  boost::multiprecision::cpp_int k = 0;
  int depth = 0;

  [[nodiscard]] Dyadic lower() const;
  [[nodiscard]] Dyadic upper() const;
  [[nodiscard]] Dyadic mid() const;
  [[nodiscard]] double radius() const;  ///< half the width; exact
  [[nodiscard]] DyadicBox left() const;
  [[nodiscard]] DyadicBox right() const;
  bool operator==(const DyadicBox&) const = default;
};

/// Enclosures in I, exact where I can hold the numbers. For Interval: in any rounding mode.
template <class I>
[[nodiscard]] I enclose(const Dyadic& x);
template <class I>
struct EnclosedBox {
  I range;
  I mid;
};
template <class I>
[[nodiscard]] EnclosedBox<I> enclose(const DyadicBox& box);

template <>
Interval enclose(const Dyadic& x);
template <>
MpInterval enclose(const Dyadic& x);
template <>
EnclosedBox<Interval> enclose(const DyadicBox& box);
template <>
EnclosedBox<MpInterval> enclose(const DyadicBox& box);

}  // namespace taut
