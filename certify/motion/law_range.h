// SPDX-License-Identifier: GPL-3.0-or-later
// How fast a move goes where: enclosures of σ' and σ'' over all times at which the move is on a part of its path,
// halves of these times, and one time in their middle.
#pragma once

#include <algorithm>
#include <array>
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

/// A quadratic polynomial over an interval of the given width, from its values at both ends and its slope at the first:
/// with β = q(a) + q'(a) (b − a)/2 each q(x) is a mean of q(a), β and q(b), whose weights (1−y)², 2y(1−y) and y² are
/// not negative, for y = (x − a)/(b − a).
template <class I>
I over_interval(const I& at_begin, const I& slope_at_begin, const I& at_end, const I& width) {
  return hull(hull(at_begin, at_end), at_begin + slope_at_begin * width / I(2.0));
}

/// The derivatives by u of a piece at u.
template <class I>
struct PieceRates {
  I first, second, third;
  PieceRates(const Polynomial<I>& x, const I& u)
      : first(x.slope(u)), second(x.c[2] + x.c[2] + u * (I(6.0) * x.c[3])), third(I(6.0) * x.c[3]) {}
};

/// σ' and σ'' by u, for u in [from, to].
template <class I>
LawRange<I> over_part(const Polynomial<I>& x, double from, double to) {
  const PieceRates<I> begin(x, I(from)), end(x, I(to));
  return {over_interval<I>(begin.first, begin.second, end.first, I(to) - I(from)), hull(begin.second, end.second)};
}

/// f(x, from, to) for the parts of all pieces at these times, joined.
template <class I, class F>
auto over_times(const TimeLaw& law, const TimeCover& times, F f, auto join) {
  const auto [first, last, u1, u2] = times;
  auto result = f(law_polynomial<I>(law, first), u1, first == last ? u2 : 1);
  for (std::size_t k = first + 1; k <= last; ++k) {
    result = join(result, f(law_polynomial<I>(law, k), 0.0, k == last ? u2 : 1));
  }
  return result;
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
  const LawRange<I> by_u = law_range_detail::over_times<I>(
      law, times, [](const auto&... part) { return law_range_detail::over_part<I>(part...); },
      [](const LawRange<I>& a, const LawRange<I>& b) {
        return LawRange<I>{hull(a.rate, b.rate), hull(a.acceleration, b.acceleration)};
      });
  const I inverse = I(1.0) / I(law.step_s);
  return {by_u.rate * inverse, by_u.acceleration * sqr(inverse)};
}

/// σ'' + v σ' over these times [1/s²], a quadratic polynomial on each piece: where a move that brakes is next to a
/// limit, one of them falls where the other rises. @param v  [1/s]
template <class I>
[[nodiscard]] I law_braking(const TimeLaw& law, const TimeCover& times, const I& v) {
  const I share = v * I(law.step_s);
  const I by_u = law_range_detail::over_times<I>(
      law, times,
      [&](const Polynomial<I>& x, double from, double to) {
        const law_range_detail::PieceRates<I> a(x, I(from)), b(x, I(to));
        return law_range_detail::over_interval<I>(a.second + share * a.first, a.third + share * a.second,
                                                  b.second + share * b.first, I(to) - I(from));
      },
      [](const I& a, const I& b) { return hull(a, b); });
  return by_u * sqr(I(1.0) / I(law.step_s));
}

/// In pieces, all of these are multiples of 2^-40 below 2^16 while covers are halved no more than 16 times, and exact.
[[nodiscard]] inline double middle_of(const TimeCover& times) {
  return (static_cast<double>(times.first) + times.u1 + static_cast<double>(times.last) + times.u2) / 2;
}

/// Both halves of these times.
[[nodiscard]] inline std::array<TimeCover, 2> halves(const TimeCover& times) {
  const double middle = middle_of(times);
  const std::size_t k = std::min(static_cast<std::size_t>(middle), times.last);
  const double u = middle - static_cast<double>(k);
  return {{{times.first, k, times.u1, u}, {k, times.last, u, times.u2}}};
}

/// Places at these times, as σ never falls.
template <class I>
[[nodiscard]] I law_places(const TimeLaw& law, const TimeCover& times) {
  return hull(law_polynomial<I>(law, times.first).at(I(times.u1)), law_polynomial<I>(law, times.last).at(I(times.u2)));
}

/// The middle of these times; nothing where it is not certain that σ is in `s` then.
template <class I>
[[nodiscard]] std::optional<LawInstant<I>> law_instant(const TimeLaw& law, const TimeCover& times, const I& s) {
  const double from = static_cast<double>(times.first) + times.u1, middle = middle_of(times);
  const std::size_t k = std::min(static_cast<std::size_t>(middle), law.pieces() - 1);
  const I u(middle - static_cast<double>(k));
  const Polynomial<I> piece = law_polynomial<I>(law, k);
  const I step(law.step_s);
  LawInstant<I> result{piece.at(u), piece.slope(u) / step, step * I(middle - from)};
  const bool is_inside = result.place.lower() >= s.lower() && result.place.upper() <= s.upper();
  return is_inside ? std::optional(result) : std::nullopt;
}

}  // namespace taut
