// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/worst_place.h"

#include <tuple>

#include "reports/summary/nearness.h"

namespace taut {

std::optional<double> worst_place(const ReportContext& scene, const CableUse& use) {
  if (const auto& witness = scene.gravest) return position(witness->violation.at);
  if (use.source == CableUse::Source::kNone) return std::nullopt;
  std::optional<std::tuple<Nearness, int, double>> worst;  // the kind of limit, and what is left, negated, of its width
  double place = 0;
  const auto consider = [&](Nearness nearness, int kind, double left, double at) {
    const std::tuple<Nearness, int, double> next = {nearness, kind, -left};
    if (worst && next <= *worst) return;
    worst = next;
    place = at;
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    const Use& f = use.tension[i];
    const Use& d = use.length[i];
    const double width = f.upper_limit - f.lower_limit;
    consider(nearness_to_slack(f.range, f.lower_limit, f.upper_limit), 2, (f.range.lower - f.lower_limit) / width,
             f.least_at);
    consider(nearness_to_top(f.range, f.upper_limit), 1, (f.upper_limit - f.range.upper) / width, f.greatest_at);
    const double below = d.range.lower - d.lower_limit;
    const double above = d.upper_limit - d.range.upper;
    consider(nearness_of_length(d.range, d.lower_limit, d.upper_limit), 0,
             std::min(below, above) / (d.upper_limit - d.lower_limit), below < above ? d.least_at : d.greatest_at);
  }
  const DistancesAlong& bodies = scene.distances;
  if (!bodies.least.empty()) {
    const std::size_t k = bodies.worst();
    const BodyDistance& nearest = bodies.least[k];
    double size = 0;
    for (const Use& d : use.length) size = std::max(size, d.upper_limit);
    consider(nearness_of_bodies(nearest.distance, nearest.clearance, size), 3, nearest.left() / size,
             scene.samples[k].position);
  }
  return place;
}

}  // namespace taut
