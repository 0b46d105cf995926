// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/still_picture.h"

#include <fmt/format.h>

#include "reports/page/machine_picture.h"

namespace taut {

Html still_picture(const ReportContext& scene) {
  const Path& path = scene.certificate.path;
  if (path.waypoints.empty()) return {};
  std::vector<std::pair<std::string, double>> places = {{"Waypoint 0 (start)", 0.0}};
  if (const auto& witness = scene.gravest) {
    places.emplace_back("At the witness", position(witness->violation.at));
  } else if (path.segments() > 1 && !found_no_path(scene.certificate)) {
    const std::size_t middle = path.segments() / 2;
    const char* what = path.interpolation == Interpolation::kStraight ? "Waypoint" : "Start of segment";
    places.emplace_back(fmt::format("{} {}", what, middle), static_cast<double>(middle));
  }
  if (path.segments() > 0) {
    places.emplace_back(fmt::format("Waypoint {} (goal)", path.waypoints.size() - 1),
                        static_cast<double>(path.segments()));
  }
  const MachineView view(scene);
  constexpr PictureSize kSize = {340, 420};
  Html panels;
  for (const auto& [caption, at] : places) {
    const PathSample sample = scene.sampler.at(path, at);
    panels += machine_picture(scene, view, at, nearness_at(scene.sampler.model(), sample.statics), caption, kSize);
  }
  return html("<div class=\"panels robots\">{}</div>\n", panels) + bodies_note(scene) + shown_bodies_note(scene);
}

}  // namespace taut
