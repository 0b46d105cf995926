// SPDX-License-Identifier: GPL-3.0-or-later
// How far into the move a position on the path is: the distance travelled by the platform's origin, the angle that the
// platform has turned by, and the time. It is computed in floating point.
#pragma once

#include <optional>
#include <vector>

#include "reports/summary/samples.h"

namespace taut {

class Travel {
 public:
  /// Measures along a polygon with corners at all waypoints and some points between.
  Travel(const Sampler& sampler, const Path& path);

  /// The travel from the start to a position, which is counted in segments (PathSample::position).
  [[nodiscard]] double distance_m(double position) const { return at(distance_m_, position); }
  [[nodiscard]] double turned_rad(double position) const { return at(turned_rad_, position); }
  /// The time at a position: of a move when it first gets there; else from the path's times, uniform between waypoints.
  /// Nothing if the path has none, or is a spline, which does not pass through its control points.
  [[nodiscard]] std::optional<double> time_s(double position) const;

 private:
  [[nodiscard]] double at(const std::vector<double>& values, double position) const;

  std::size_t pieces_ = 1;  ///< a segment
  std::vector<double> distance_m_, turned_rad_;
  std::vector<double> times_s_;    ///< of the waypoints
  std::optional<TimeLaw> timing_;  ///< of a move
  double segments_ = 0;
};

}  // namespace taut
