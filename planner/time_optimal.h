// SPDX-License-Identifier: GPL-3.0-or-later
// How fast a path can be run: a time law near the fastest one, within limits of winches, load and tensions.
//
// By the arc length l, with x = l̇² and u = l̈, every limit is a set of rows a u + b x <= c, c >= 0: speeds and
// accelerations are linear in (u, x), and so is the inertia of the load, hence every tension; norms become polygons. As
// x' = 2 u, the fastest law is found by reachability (TOPP-RA, H. Pham and Q.-C. Pham, IEEE T-RO 2018): backwards over
// a grid of l, the largest x from which the next one's is reached; then forwards, always as fast as that allows.
// Standing still obeys all rows, since the path is feasible: neither pass fails. A winch's power is not linear; tension
// at rest bounds the speed by it, and what inertia adds is left to tightening. That law's acceleration jumps. Its mean
// over a moving window of time is smooth, and s of that mean becomes the control values of a TimeLaw. The window is as
// long as the jerk asks for. By l and not by s, since a spline whose control points are tripled rests there by itself:
// the motion's jerk is bounded where s has none. Where samples of the law break a limit, the rows are tightened there,
// and all is done again; in the end the whole is slowed down as far as samples need it.
//
// Floating point: a law is proposed here, and proves nothing.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kinematics/moving_load.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/time_law.h"
#include "kinematics/time_limits.h"

namespace taut {

/// What deviations may take at a place.
struct TensionLoss {
  /// Of what a tension has to its lower (side 0) and upper limit (side 1), at rest [N].
  std::array<std::array<double, 2>, kCables> newtons{};
  double turn = 0;  ///< by which the platform, and with it the wrench of inertia, may be turned [rad]
};

struct TimedPathProblem {
  const Problem& problem;
  std::vector<MovingBody<double>> bodies;  ///< of the load: what of it has mass
  TimeLimits limits;
  double slowing = 0;          ///< one over the time in which the move may be slowed down to rest [1/s]; 0: it may not
  double slack = 0.01;         ///< the share of each limit that is left alone
  std::size_t grid = 64;       ///< places a segment, and 1024 of the path at least
  std::size_t most_tries = 8;  ///< of tightening
  /// At `grid` places of each segment, from s = 0 to the end; empty: nothing is lost.
  std::vector<TensionLoss> tension_loss = {};
  /// Where limits are to be used less than rows say, by a factor above 1: from and to are places of the path.
  struct Tightened {
    double from = 0, to = 0, factor = 1;
  };
  std::vector<Tightened> tightened = {};
};

struct TimedMove {
  TimeLaw law;
  /// Of the grid's optimum, without a limit of jerk [s]: what the law is compared with.
  double fastest_s = 0;
};

/// How much of its limits a move uses at a place: the largest quotient of a quantity and its limit; of a tension, of
/// what inertia takes and what there is for it.
/// @param s  the place on the path, which only tension_loss asks for
[[nodiscard]] double usage(const TimedPathProblem& problem, const PoseSampler& sampler, const PathRates<double>& path,
                           double rate, double acceleration, double s = 0);

/// A spline rests where three control points are equal, a path of straight segments at each waypoint. Nothing where the
/// path is not feasible at rest, as far as samples tell, or no limit bounds the speed.
[[nodiscard]] std::optional<TimedMove> time_optimal(const Path& path, const TimedPathProblem& problem);

}  // namespace taut
