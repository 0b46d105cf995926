// SPDX-License-Identifier: GPL-3.0-or-later
// A still plot of one cable along the whole path, for the first page of a move that is not proved: samples, the limits,
// and the place where one is broken.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/broken_limits.h"
#include "reports/summary/scene.h"

namespace taut {

struct CablePlot {
  std::size_t cable = 0;  ///< 0…5
  bool is_length = false;
  std::optional<double> marked;  ///< a position on the path, which is marked
  bool is_of_deviant = false;    ///< the mark is where a machine within the tolerances breaks a limit
};

/// Nothing where the path has no samples. Values far beyond the limits are cut off at the frame.
[[nodiscard]] Html cable_plot(const ReportContext& scene, const CablePlot& plot);

/// The distance of two bodies along the move in floating-point samples, with their clearance and where it is broken.
/// Nothing if there is no path to plot. @pre broken.bodies
[[nodiscard]] Html distance_plot(const ReportContext& scene, const BrokenLimit& broken);

}  // namespace taut
