// SPDX-License-Identifier: GPL-3.0-or-later
// How fast a move goes where: enclosures of σ' and σ'' over all times at which the move is on a part of its path,
// halves of these times, and one time in their middle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

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

/// A quadratic polynomial on [0, 1] as a mean of three numbers, with the weights (1−u)², 2u(1−u) and u² (Bézier).
template <class I>
using Quadratic = std::array<I, 3>;

template <class I>
I mix(const I& p, const I& q, const I& t) {
  return p * (I(1.0) - t) + q * t;
}

/// Over [a, b] the polynomial is a mean of the values of its polar form at (a, a), (a, b) and (b, b), likewise: that is
/// linear in both of its arguments, symmetric, and the polynomial where they are equal.
template <class I>
I over_interval(const Quadratic<I>& q, double from, double to) {
  if (from == 0 && to == 1) return hull(hull(q[0], q[2]), q[1]);
  const I a(from), b(to);
  const I at_a0 = mix(q[0], q[1], a), at_a1 = mix(q[1], q[2], a);
  const I at_b = mix(mix(q[0], q[1], b), mix(q[1], q[2], b), b);
  return hull(hull(mix(at_a0, at_a1, a), at_b), mix(at_a0, at_a1, b));
}

/// σ' and σ'' on a piece, by u = t/h − k; σ'' is linear.
template <class I>
struct PieceRates {
  Quadratic<I> first, second;
  PieceRates(const TimeLaw& law, std::size_t k) {
    const I half(0.5), c0(law.controls[k]), c1(law.controls[k + 1]), c2(law.controls[k + 2]), c3(law.controls[k + 3]);
    const I step = c2 - c1, before = c1 - c0, after = c3 - c2;
    first = {half * (before + step), step, half * (step + after)};
    const I begin = step - before, end = after - step;
    second = {begin, half * (begin + end), end};
  }
};

/// f(piece, from, to) for the parts of all pieces at these times, joined.
template <class I, class F>
auto over_times(const TimeLaw& law, const TimeCover& times, F f, auto join) {
  const auto [first, last, u1, u2] = times;
  auto result = f(PieceRates<I>(law, first), u1, first == last ? u2 : 1);
  for (std::size_t k = first + 1; k <= last; ++k) {
    result = join(result, f(PieceRates<I>(law, k), 0.0, k == last ? u2 : 1));
  }
  return result;
}

/// About the u in [0, 1] at which a piece is x, or the nearer end: Newton's method, and halving where that is slow.
inline double place_on_piece(const Polynomial<double>& piece, double x) {
  constexpr double kFine = 0x1p-21;
  double u = 0.5;
  for (int k = 0; k < 6; ++k) {
    const double slope = piece.slope(u);
    if (!(slope > 0)) break;
    const double from = u;
    u = std::clamp(u - (piece.at(u) - x) / slope, 0.0, 1.0);
    if (std::abs(u - from) < kFine) return u;
  }
  u = 0;
  for (double by = 0.5; by >= kFine; by /= 2) {
    if (piece.at(u + by) < x) u += by;
  }
  return u;
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
/// σ(t1) < a, or t1 = 0, and σ(t2) > b, or t2 = T. Such times are sought in plain numbers, of which nothing is claimed,
/// and moved outward until enclosures of σ there say that they do.
template <class I>
[[nodiscard]] TimeCover time_cover(const TimeLaw& law, const I& s) {
  constexpr double kFinest = 0x1p-19;  // of a piece
  const double a = lower_bound(s), b = upper_bound(s);
  const std::size_t n = law.pieces();
  const std::vector<double>& c = law.controls;
  // Six times σ at knot k, and six times the ends of `s`.
  const auto approx_knot = [&](std::size_t k) { return c[k] + 4 * c[k + 1] + c[k + 2]; };
  const auto knot = [&](std::size_t k) { return I(c[k]) + I(4.0) * I(c[k + 1]) + I(c[k + 2]); };
  const I begin = I(6.0) * I(a), end = I(6.0) * I(b);
  const auto is_before = [&](std::size_t k) { return approx_knot(k) < 6 * a; };
  const auto is_behind = [&](std::size_t k) { return approx_knot(n - k) > 6 * b; };
  std::size_t first = law_range_detail::last_before(n, is_before);
  while (first > 0 && !(upper_bound(knot(first)) < lower_bound(begin))) --first;
  std::size_t behind = law_range_detail::last_before(n, is_behind);
  while (behind > 0 && !(lower_bound(knot(n - behind)) > upper_bound(end))) --behind;
  // Knot `first` is before a, or 0; knot n − `behind` is behind b, or n.
  TimeCover cover;
  cover.first = std::min(first, n - 1);
  cover.last = std::max(cover.first, n - 1 - std::min(behind, n - 1));
  const double finest = cover.last - cover.first > 4 ? 0x1p-8 : kFinest;
  const auto approx_number = [&](std::size_t k, double x) {  // of `finest`
    return law_range_detail::place_on_piece(law_polynomial<double>(law, k), x) / finest;
  };
  cover.u1 = std::max(0.0, finest * (std::ceil(approx_number(cover.first, a)) - 1));
  cover.u2 = std::min(1.0, finest * (std::floor(approx_number(cover.last, b)) + 1));
  const Polynomial<I> first_piece = law_polynomial<I>(law, cover.first),
                      last_piece = law_polynomial<I>(law, cover.last);
  for (double by = kFinest; cover.u1 > 0 && !(upper_bound(first_piece.at(I(cover.u1))) < a); by *= 2) {
    cover.u1 = std::max(0.0, cover.u1 - by);
  }
  for (double by = kFinest; cover.u2 < 1 && !(lower_bound(last_piece.at(I(cover.u2))) > b); by *= 2) {
    cover.u2 = std::min(1.0, cover.u2 + by);
  }
  if (cover.first == cover.last) cover.u2 = std::max(cover.u1, cover.u2);
  return cover;
}

/// Over these times.
template <class I>
[[nodiscard]] LawRange<I> law_range(const TimeLaw& law, const TimeCover& times) {
  using namespace law_range_detail;
  const auto on_piece = [&](std::size_t k, double from, double to) {
    const PieceRates<I> x(law, k);
    const auto second = [&](double u) { return x.second[0] + I(u) * (x.second[2] - x.second[0]); };
    return LawRange<I>{over_interval(x.first, from, to), hull(second(from), second(to))};
  };
  const auto [first, last, u1, u2] = times;
  LawRange<I> by_u = on_piece(first, u1, first == last ? u2 : 1);
  if (first < last) {
    const LawRange<I> end = on_piece(last, 0, u2);
    by_u = {hull(by_u.rate, end.rate), hull(by_u.acceleration, end.acceleration)};
  }
  // All of a piece: σ' is a mean of the steps at its knots and its own, σ'' of the two differences of these.
  if (last > first + 1) {
    const std::vector<double>& c = law.controls;
    I step = I(c[first + 2]) - I(c[first + 1]);
    for (std::size_t k = first + 1; k <= last; ++k) {
      const I next = I(c[k + 2]) - I(c[k + 1]);
      by_u.acceleration = hull(by_u.acceleration, next - step);  // at knot k
      by_u.rate = hull(by_u.rate, I(0.5) * (step + next));
      if (k < last) by_u.rate = hull(by_u.rate, next);
      step = next;
    }
  }
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
      [&](const law_range_detail::PieceRates<I>& x, double from, double to) {
        law_range_detail::Quadratic<I> sum;
        for (std::size_t j = 0; j < 3; ++j) sum[j] = x.second[j] + share * x.first[j];
        return law_range_detail::over_interval(sum, from, to);
      },
      [](const I& a, const I& b) { return hull(a, b); });
  return by_u * sqr(I(1.0) / I(law.step_s));
}

/// In pieces, all of these are multiples of 2^-32 below 2^16 while covers are halved no more than 12 times, and exact.
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
