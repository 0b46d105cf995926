// SPDX-License-Identifier: GPL-3.0-or-later
// Clause "time": how fast a move goes over a box, and what the load's inertia asks of the cables there.
//
// A path's place is z = k + s, the point s of segment k. A law z = σ(t) is a uniform cubic B-spline of time with the
// step h and control values that never fall, from 0 to the number of segments; so all times at which the move is on a
// box [a, b] of z are one closed interval. Since the control values are binary64 and boxes rational, σ is a rational
// polynomial on each of its pieces, and where σ(t) < a or σ(t) > b is decided exactly; halving finds such times near
// both ends of the interval. Over the times between, σ' and σ'' are enclosed.
//
// With p(s) and R(s), their first two derivatives by s and R' = [w] R (frame_jet.h),
//     velocity  X' σ',    acceleration  X'' σ'^2 + X' σ''   of a point X(s) = p + R x, and of a length |d_i|,
//     ω = w σ',           ω' = w' σ'^2 + w σ''              (by time).
// A speed is also bounded from one time m in the middle of those on the box, none of which is farther from m than some
// h: as a length's rate of change at t is that at m and h accelerations at most, and the square of a velocity v changes
// at the rate 2 v v'. What is run slower than the law is slower than this.
// A winch's power is the greatest tension of its cable, of every load and deviation, times that speed of |d_i|, whose
// magnitude counts: hoisting and lowering alike.
// Where a limit of speeds or accelerations is not shown to be kept on a box, its halves are looked at, and theirs: what
// holds on each of them holds on the box.
// Where the problem states a stopping time T, the move may be run as z = σ(τ(t)), too, with τ' from 0 to 1 and |τ''| <=
// 1/T. So ż^2 = u σ'^2 and z̈ = u σ'' + v σ' with u = τ'^2 in [0, 1] and v = τ'' in [-1/T, 1/T].
// At one time of the law, hence one place, all accelerations, w_in and every tension are affine in (z̈, ż^2), and so in
// (u, v), and speeds rise with u: what keeps its limits at the four corners of (u, v) keeps them inside, as limits are
// intervals and magnitudes convex.
//
// Where the problem states rows of a table, lengths may run straight from row to row: the machine that holds such
// lengths deviates from the path by errors of lengths (deviation.h). Run slower, it does so at the place τ(t) of them.
//
// At such a time, a witness may state τ' and τ'' itself.
//
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

/// Of every time at which the move is on the box.
struct RateMargin {
  RateKind kind = RateKind::kWinchSpeed;
  std::size_t cable = 0;  ///< of winches
  Ball rate;              ///< its magnitude
  Ball value;             ///< the limit less that
};

struct Moving {
  Vector6<Ball> inertia;         ///< w_in of the commanded motion [N, N m]
  Vector6<Ball> change_by_turn;  ///< bounds of how much a turn by t <= 1 may change it, over t
  /// Of each stated limit but those of power, for which tensions are needed; only by moving().
  std::vector<RateMargin> margins;
  /// Where that cable's power is limited: the magnitude of the rate of |d_i| when the move is fastest.
  std::array<Ball, kCables> winch_speed;
  /// What acts beside the items and the ellipsoid's spread: w0 less w_in.
  [[nodiscard]] Vector6<Ball> beside(const Machine& machine) const {
    Vector6<Ball> result = machine.wrench;
    for (std::size_t i = 0; i < 6; ++i) result[i] -= inertia[i];
    return result;
  }
};

/// A stated limit. @pre the problem states it @param cable  of winches
[[nodiscard]] Ball rate_limit(const Problem& problem, RateKind kind, std::size_t cable);

/// Asks of a path's law all that is said above: four control values or more, a step above 0, and that the move begins
/// and ends at rest and, but for splines, rests at every waypoint. Three control values are equal where it rests, so
/// that σ' = σ'' = 0 wherever σ is that number, or, at the ends of a spline, three control points are, with their
/// normals. @pre path.timing @throws Rejected
void require_time_law(const Path& path);

/// Asks of the rows of a table, if the problem states them, that each error is above a step^2/8, where a is the limit
/// of that winch's acceleration: the commanded length has a derivative by time that changes at less than a, so that it
/// is no farther than that from its chord over a time of at most `step`. The rest is for rows that are rounded.
/// And that there are tolerances, if all 0, as deviations are looked at only then. @throws Rejected
void require_rows(const Problem& problem);

/// Over a box of segment k, at every time at which the move is there, run as its law says or slowed down. @throws
/// Undefined where that is not proved. @pre require_time_law(), and the problem has limits in time; for a `slowing`, a
/// stopping time
[[nodiscard]] Moving moving(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                            const Box& box, const std::optional<Slowing>& slowing = {});
/// Likewise w_in of a machine that is at `pose` instead of where the path is, but with the velocities and accelerations
/// that path and law command.
[[nodiscard]] Vector6<Ball> inertia_of_deviant(const Machine& machine, const Problem& problem, const Path& path,
                                               std::size_t k, const Box& box, const std::optional<Slowing>& slowing,
                                               const Frame& pose);
/// Likewise at the corners of all speeds at which the move may be run there: what keeps its limits at each of them
/// keeps them. That is one speed where the problem states no stopping time.
/// Claim: at all of these speeds, limits of speeds and accelerations are kept all over the box. @throws Undefined where
/// that is not shown.
[[nodiscard]] std::vector<Moving> moving_within_limits(const Machine& machine, const Problem& problem, const Path& path,
                                                       std::size_t k, const Box& box);

}  // namespace taut::checker
