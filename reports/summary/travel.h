// SPDX-License-Identifier: GPL-3.0-or-later
// How far into the move a place of the path is: the way of the platform's origin, the angle that the platform has turned, time.
// Floating point.
#pragma once

#include <optional>
#include <vector>

#include "reports/summary/samples.h"

namespace taut {

class Travel {
 public:
  /// Measured on a polygon with corners at all waypoints, and some between.
  Travel(const Sampler& sampler, const Path& path);

  /// Since the start, at a position counted in segments (PathSample::position).
  [[nodiscard]] double distance_m(double position) const { return at(distance_m_, position); }
  [[nodiscard]] double turned_rad(double position) const { return at(turned_rad_, position); }
  /// By the path's times, uniform between waypoints; nothing where it has none, and on splines, which don't pass through theirs.
  [[nodiscard]] std::optional<double> time_s(double position) const;

 private:
  [[nodiscard]] double at(const std::vector<double>& values, double position) const;

  std::size_t pieces_ = 1;  ///< a segment
  std::vector<double> distance_m_, turned_rad_;
  std::vector<double> times_s_;  ///< of the waypoints
};

}  // namespace taut
