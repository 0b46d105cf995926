// SPDX-License-Identifier: GPL-3.0-or-later
// When a move is where on its path.
//
// A path's place is s in [0, S]: s = k + x is the point x of segment k (segment.h), S the number of segments. A time
// law is s = σ(t), 0 <= t <= T = n h: a uniform cubic B-spline of time with the step h and control values c_0 …
// c_{n+2}, which never fall. On piece k, with u = t/h − k in [0, 1],
//   σ = ((1−u)³ c_k + (3u³−6u²+4) c_{k+1} + (−3u³+3u²+3u+1) c_{k+2} + u³ c_{k+3}) / 6.
// So σ is twice continuously differentiable; as σ' is a mean of (c_{i+1} − c_i)/h, it never falls; and
// c_0 + 4 c_1 + c_2 = 0 and c_n + 4 c_{n+1} + c_{n+2} = 6 S, exactly, say that it runs from 0 to S. Where four control
// values are equal the move stands still.
#pragma once

#include <string>

#include "kinematics/segment.h"

namespace taut {

/// What is wrong with a law over so many segments, decided exactly; empty if nothing is.
[[nodiscard]] std::string complaint(const TimeLaw& law, std::size_t segments);

/// What is wrong with a path's law, decided exactly: that of the law itself; or that the move does not rest where it
/// has to. It begins and ends at rest, and but for splines rests at every waypoint: there three control values are
/// equal, so that σ' = σ'' = 0 where σ is that number, or, at the ends of a spline, three control points are, with
/// their normals, so that the curve's derivatives are 0.
/// @pre path.timing
[[nodiscard]] std::string complaint(const Path& path);

/// σ on piece k as a polynomial in u; its slope is by u, too.
template <class S>
[[nodiscard]] Polynomial<S> law_polynomial(const TimeLaw& law, std::size_t k) {
  const auto c = [&](std::size_t i) { return S(law.controls[k + i]); };
  return bspline_polynomial<S>(c(1), c(1) - c(0), c(2) - c(1), c(3) - c(2));
}

/// σ and its derivatives by time, in floating point.
struct LawPoint {
  double s = 0;             ///< σ
  double rate = 0;          ///< σ' [1/s]
  double acceleration = 0;  ///< σ'' [1/s²]
};
/// @param t  [s], in [0, T]; what is beyond is taken for the nearest end
[[nodiscard]] LawPoint at_time(const TimeLaw& law, double t);

}  // namespace taut
