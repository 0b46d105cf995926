// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/chart_outlines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "planner/planner.h"

namespace taut {

std::vector<ChartOutline> chart_outlines(const Case& the_case, const std::filesystem::path& file) {
  constexpr int kMostCharts = 20'000;
  const Planner planner(the_case, file);
  const Atlas& atlas = planner.atlas();
  if (atlas.size() > kMostCharts) {
    throw InputError(ErrorCode::kUse,
                     fmt::format("{}: got an atlas of {} charts, expected at most {} in a picture, such as those of a "
                                 "case with a larger planner.radius",
                                 file.string(), atlas.size(), kMostCharts));
  }
  std::vector<ChartOutline> result;
  for (int id = 0; id < atlas.size(); ++id) {
    const Chart& chart = atlas.chart(id);
    ChartOutline outline{{chart.frame.coordinates()[0], chart.frame.coordinates()[1]}, {}};
    std::vector<TangentVector> corners;
    const auto& polygon = std::get<Polytope>(chart.polytope);
    for (int corner = 0; corner < polygon.corners(); ++corner) corners.push_back(polygon.corner(corner));
    std::ranges::sort(corners, {}, [](const TangentVector& u) { return std::atan2(u[1], u[0]); });
    bool is_finite = true;
    for (const TangentVector& u : corners) {
      const Eigen::Vector2d step = chart.frame.lift() * u;
      is_finite = is_finite && step.allFinite();
      outline.corners.push_back({step[0], step[1]});
    }
    if (is_finite) result.push_back(std::move(outline));
  }
  return result;
}

}  // namespace taut
