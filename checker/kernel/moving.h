// SPDX-License-Identifier: GPL-3.0-or-later
// Clause "time": how fast a move goes over a box, and what the load's inertia asks of the cables there.
//
// A path's place is z = k + s, the point s of segment k. A law z = σ(t) is a uniform cubic B-spline of time with the
// step h and control values that never fall, from 0 to the number of segments; so all times at which the move is on a
// box [a, b] of z are one closed interval. Since the control values are binary64 and boxes rational, σ is a rational
// polynomial on each of its pieces, and where σ(t) < a or σ(t) > b is decided exactly; halving finds such times near
// both ends of the interval. Over the times between, σ' and σ'' are enclosed.
//
// p(s) and R(s) with their first two derivatives by s are SecondJets. With R' = [w] R and R'' R^T = [w'] + [w]^2, whose
// second term is symmetric,
//     velocity  X' σ',    acceleration  X'' σ'^2 + X' σ''   of a point X(s) = p + R x, and of a length |d_i|,
//     ω = w σ',           ω' = w' σ'^2 + w σ''              (by time).
// Bodies of the load, each of mass m with its centre of gravity c and with a diagonal inertia I about it in the axes of
// P, take from what acts from outside the wrench about P_m
//     w_in = sum of ( m a_c ; R (c - p_m) x m a_c + R I R^T ω' + ω x R I R^T ω ).
//
// Deviations. Let R be turned by an angle t <= 1, the platform's origin be anywhere, and the rates p'', ω, ω' by time
// stay. With q = |ω'| + |ω|^2, a_c changes by no more than t |c| q, so that its force changes by m t |c| q, its moment
// by t m |c - p_m| (|a_c| + 2 |c| q), and the rest by 2 t |I| q, as |S I S^T - I| <= 2 t |I| for a turn S.
#pragma once

#include "checker/kernel/machine.h"

namespace taut::checker {

/// What a stated limit is of.
enum class RateKind {
  kWinchSpeed,
  kWinchAcceleration,
  kLoadSpeed,
  kLoadAcceleration,
  kLoadAngularSpeed,
  kLoadAngularAcceleration
};

/// A limit less a rate's magnitude, for every time at which the move is on the box.
struct RateMargin {
  RateKind kind = RateKind::kWinchSpeed;
  std::size_t cable = 0;  ///< of winches
  Ball value;
};

struct Moving {
  Vector6<Ball> inertia;            ///< w_in of the commanded motion [N, N m]
  Vector6<Ball> change_by_turn;     ///< bounds of how much a turn by t <= 1 may change it, over t
  std::vector<RateMargin> margins;  ///< of each stated limit
};

/// Asks of a path's law all that is said above: four control values or more, a step above 0, and that the move begins
/// and ends at rest and rests at every corner. Three control values are equal where it rests, so that σ' = σ'' = 0
/// wherever σ is that number, or, at the ends of a spline, three control points are. @pre path.timing @throws Rejected
void require_time_law(const Problem& problem, const Path& path);

/// Over a box of segment k, at every time at which the move is there. @throws Undefined where that is not proved.
/// @pre require_time_law(), and the problem has limits in time
[[nodiscard]] Moving moving(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                            const Box& box);

}  // namespace taut::checker
