// SPDX-License-Identifier: GPL-3.0-or-later
// How fast a move goes where: enclosures of σ' and σ'' over all times at which the move is on a part of its path, and
// one time in the middle of these.
#pragma once

#include <algorithm>
#include <optional>

#include "kinematics/time_law.h"

namespace taut {

/// Of σ over a set of times.
template <class I>
struct LawRange {
  I rate;          ///< σ' [1/s]
  I acceleration;  ///< σ'' [1/s²]
};

/// A time m at which σ is within a part of a path. All times at which it is there are within `reach` of m.
template <class I>
struct LawInstant {
  I place;  ///< σ(m)
  I rate;   ///< σ'(m) [1/s]
  I reach;  ///< [s]
};

/// Times from u1 on piece `first` to u2 on piece `last`: exact numbers of pieces.
struct TimeCover {
  std::size_t first = 0, last = 0;
  double u1 = 0, u2 = 1;
};

namespace law_range_detail {

/// σ' and σ'' by u, for u in [from, to]: σ'' is a straight line in u, and σ' moves by no more than it says.
template <class I>
LawRange<I> over_part(const Polynomial<I>& x, double from, double to) {
  const I middle((from + to) / 2), u(from, to);
  const I acceleration = x.c[2] + x.c[2] + u * (I(6.0) * x.c[3]);
  return {x.slope(middle) + acceleration * (u - middle), acceleration};
}

/// A k in [0, n] for which is_before(k) holds, or 0; the greatest one where none of them holds behind one that does
/// not.
template <class F>
std::size_t last_before(std::size_t n, F is_before) {
  std::size_t from = 0;
  for (std::size_t to = n + 1; to - from > 1;) {
    const std::size_t middle = from + (to - from) / 2;
    (is_before(middle) ? from : to) = middle;
  }
  return from;
}

}  // namespace law_range_detail

/// All times at which σ is in `s`. For Interval under run_upward(); void if a fault was raised, as all that follows.
/// @pre complaint(law, …) is empty
///
/// The times t with a <= σ(t) <= b are one closed interval, since σ never falls. It lies between t1 and t2 where
/// σ(t1) < a, or t1 = 0, and σ(t2) > b, or t2 = T: such times are found by halving, and σ was enclosed at each.
template <class I>
[[nodiscard]] TimeCover time_cover(const TimeLaw& law, const I& s) {
  constexpr double kFinest = 0x1p-20;  // of a piece
  const double a = lower_bound(s), b = upper_bound(s);
  const std::size_t n = law.pieces();
  const auto at_knot = [&](std::size_t k) {
    return k < n ? law_polynomial<I>(law, k).at(I(0.0)) : law_polynomial<I>(law, n - 1).at(I(1.0));
  };
  TimeCover cover;
  // Knot `first` is before a, or 0; knot `last` + 1 is behind b, or n.
  cover.first =
      std::min(law_range_detail::last_before(n, [&](std::size_t k) { return upper_bound(at_knot(k)) < a; }), n - 1);
  cover.last = std::max(
      cover.first,
      n - 1 -
          std::min(law_range_detail::last_before(n, [&](std::size_t k) { return lower_bound(at_knot(n - k)) > b; }),
                   n - 1));
  const Polynomial<I> first_piece = law_polynomial<I>(law, cover.first),
                      last_piece = law_polynomial<I>(law, cover.last);
  for (double by = 0.5; by > kFinest; by /= 2) {
    if (upper_bound(first_piece.at(I(cover.u1 + by))) < a) cover.u1 += by;
    if (lower_bound(last_piece.at(I(cover.u2 - by))) > b) cover.u2 -= by;
  }
  if (cover.first == cover.last) cover.u2 = std::max(cover.u1, cover.u2);
  return cover;
}

/// Over these times.
template <class I>
[[nodiscard]] LawRange<I> law_range(const TimeLaw& law, const TimeCover& times) {
  const auto [first, last, u1, u2] = times;
  LawRange<I> result = law_range_detail::over_part(law_polynomial<I>(law, first), u1, first == last ? u2 : 1);
  for (std::size_t k = first + 1; k <= last; ++k) {
    const LawRange<I> next = law_range_detail::over_part(law_polynomial<I>(law, k), 0, k == last ? u2 : 1);
    result = {hull(result.rate, next.rate), hull(result.acceleration, next.acceleration)};
  }
  const I inverse = I(1.0) / I(law.step_s);
  return {result.rate * inverse, result.acceleration * sqr(inverse)};
}

/// The middle of these times; nothing where it is not certain that σ is in `s` then.
template <class I>
[[nodiscard]] std::optional<LawInstant<I>> law_instant(const TimeLaw& law, const TimeCover& times, const I& s) {
  const auto [first, last, u1, u2] = times;
  // In pieces, all of these are multiples of 2^-21 below 2^16, and exact.
  const double from = static_cast<double>(first) + u1, to = static_cast<double>(last) + u2, middle = (from + to) / 2;
  const std::size_t k = std::min(static_cast<std::size_t>(middle), law.pieces() - 1);
  const I u(middle - static_cast<double>(k));
  const Polynomial<I> piece = law_polynomial<I>(law, k);
  const I step(law.step_s);
  LawInstant<I> result{piece.at(u), piece.slope(u) / step, step * I((to - from) / 2)};
  const bool is_inside = result.place.lower() >= s.lower() && result.place.upper() <= s.upper();
  return is_inside ? std::optional(result) : std::nullopt;
}

}  // namespace taut
