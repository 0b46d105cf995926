// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/illustration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace taut {

nlohmann::json illustrate(const Problem& problem, const Atlas& atlas, const PlanStatistics& statistics) {
  constexpr int kMostCharts = 4000;
  const auto point = [](const Coordinates& q) {
    return nlohmann::json{fmt::format("{:.5g}", q[0]), fmt::format("{:.5g}", q[1])};
  };
  nlohmann::json charts = nlohmann::json::array();
  if (problem.space.parameters.size() == 2 && problem.space.constraints.empty()) {
    for (int id = 0; id < std::min(atlas.size(), kMostCharts); ++id) {
      const Chart& chart = atlas.chart(id);
      std::vector<std::pair<double, Coordinates>> corners;
      const auto& polytope = std::get<Polytope>(chart.polytope);
      for (int v = 0; v < polytope.corners(); ++v) {
        const TangentVector u = polytope.corner(v);
        corners.emplace_back(std::atan2(u[1], u[0]), chart.frame.coordinates() + chart.frame.lift() * u);
      }
      std::ranges::sort(corners, {}, [](const auto& corner) { return corner.first; });
      nlohmann::json polygon = nlohmann::json::array();
      for (const auto& corner : corners) polygon.push_back(point(corner.second));
      charts.push_back({{"c", point(chart.frame.coordinates())}, {"p", std::move(polygon)}});
    }
  }
  nlohmann::json parameters = nlohmann::json::array();
  for (const Parameter& parameter : problem.space.parameters) parameters.push_back(parameter.name);
  const std::string cost = fmt::format("{:.6g}", statistics.cost);
  return {{"kind", "atlas"},
          {"parameters", std::move(parameters)},
          {"charts", std::move(charts)},
          {"stats",
           {{"charts", statistics.charts},
            {"expanded", statistics.nodes_expanded},
            {"edges_checked", statistics.edges_checked},
            {"edges_rejected", statistics.edges_rejected},
            {"cost", statistics.cost_unit.empty() ? cost : cost + " " + statistics.cost_unit},
            {"cost_measure", statistics.cost_measure}}}};
}

}  // namespace taut
