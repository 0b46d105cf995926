// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/path_csv.h"

#include <fmt/format.h>

#include <iterator>
#include <span>

#include "path_io/path_file.h"

namespace taut {

PathCsv::PathCsv(const Problem& problem, Interpolation law, bool has_times)
    : problem_(problem), law_(law), has_times_(has_times), sampler_(problem) {}

std::string PathCsv::header() const {
  const std::string time = has_times_ ? "t[s]," : "";
  if (has_poses(law_)) {
    const char* lengths = law_ == Interpolation::kCableLengths ? ",l1[m],l2[m],l3[m],l4[m],l5[m],l6[m]" : "";
    return fmt::format("{}px[m],py[m],pz[m],qx,qy,qz,qw{}\n", time, lengths);
  }
  std::string text = law_ == Interpolation::kStraight ? "waypoint" : "control_point";
  for (const Parameter& parameter : problem_.space.parameters) text += fmt::format(",x.{}", parameter.name);
  for (const Parameter& parameter : problem_.space.parameters) text += fmt::format(",half_turns.{}", parameter.name);
  const std::vector<std::string> names = pose_names(problem_.space.angles.kind);
  text += fmt::format(",{}px[m],py[m],pz[m]", time);
  for (std::size_t i = 3; i < names.size(); ++i) text += fmt::format(",{}[rad]", names[i]);
  return text + "\n";
}

std::string PathCsv::row(std::size_t number, const Waypoint& waypoint, std::string_view time) const {
  std::string text;
  const auto out = std::back_inserter(text);
  if (has_poses(law_)) {
    if (has_times_) fmt::format_to(out, "{},", time);
    fmt::format_to(out, "{}\n", fmt::join(numbers(waypoint), ","));  // shortest decimals that read back
    return text;
  }
  const ParameterPoint& point = waypoint.parameters();
  fmt::format_to(out, "{},{},{}", number, fmt::join(point.x, ","), fmt::join(point.half_turns, ","));
  if (has_times_) fmt::format_to(out, ",{}", time);
  const Pose<double> pose = sampler_.pose(waypoint);
  const std::size_t angles = pose_names(problem_.space.angles.kind).size() - 3;
  fmt::format_to(out, ",{},{},{},{}\n", pose.p_WP(0), pose.p_WP(1), pose.p_WP(2),
                 fmt::join(std::span(pose.angles).first(angles), ","));
  return text;
}

std::string path_csv(const Problem& problem, const Path& path, std::string_view certificate_sha256) {
  const PathCsv csv(problem, path.interpolation, !path.times.empty());
  std::string text = csv.header();
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    text += csv.row(k, path.waypoints[k], path.times.empty() ? std::string_view() : path.times[k]);
  }
  return text + certificate_line(certificate_sha256);
}

}  // namespace taut
