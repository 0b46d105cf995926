// SPDX-License-Identifier: GPL-3.0-or-later
// Fits a move in time to a table of poses with times, in floating point.
//
// The move is a cubic B-spline in the parameters of the space, with equally spaced knots in time (s = t/h), that begins
// and ends with three equal control points: at rest. It is the least squares of the rows, with a penalty on its third
// differences. Digits of a table are noise to accelerations, so a spline is not to follow them: it has at least two
// rows a piece, as few pieces as bring the rows near, and as large a penalty as leaves them there. How near is for
// certify/row_distance.h to prove.
#pragma once

#include <span>
#include <vector>

#include "kinematics/pose_sampler.h"
#include "kinematics/segment.h"
#include "problem/rational.h"

namespace taut {

struct TimedRow {
  double time_s = 0;               ///< since the first row
  std::vector<double> parameters;  ///< of the space; they have no jumps of whole turns
};

/// How far a row may be from the move at its time: by so much the platform's origin is displaced, and the platform
/// turned; or by so much each cable is longer or shorter, where that is above 0.
struct RowRounding {
  double position_m = 0;
  double angle_rad = 0;
  double length_m = 0;
};

/// How far a row is from a move, in floating point.
struct RowOffset {
  std::size_t row = 0;
  double position_m = 0;
  double angle_rad = 0;
  double length_m = 0;  ///< of the cable of which it is largest
  /// The greatest of these over the rounding: 1 or less if the row is within it.
  double share = 0;
};

struct MoveFit {
  Path path;        ///< a spline with its law
  RowOffset worst;  ///< of all rows
};

/// A table with fewer rows has too few pieces to rest at both ends.
inline constexpr std::size_t kLeastFittedRows = 7;

/// The nearest fit, and where that is within the rounding, the smoothest one that is not much farther.
/// @param problem   whose space the parameters are of
/// @param rows      kLeastFittedRows or more, by rising time
/// @param duration  [s], the last row's time, exactly; above 0
[[nodiscard]] MoveFit fit_move(const Problem& problem, std::span<const TimedRow> rows, const Rational& duration,
                               const RowRounding& rounding);

/// An end of a table at which the platform does not rest.
struct MovingEnd {
  bool is_last = false;  ///< else the first row
  double speed_m_s = 0, angular_speed_rad_s = 0;
};
/// The first such end, if rows next to one leave it at a rate instead of ever faster; a guess for messages.
[[nodiscard]] std::optional<MovingEnd> moving_end(const Problem& problem, std::span<const TimedRow> rows,
                                                  const RowRounding& rounding);

}  // namespace taut
