// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_space.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinematics/model.h"

namespace taut {
namespace {

/// Whether the pose is the same, and plainly so, when parameter j grows by 2π.
bool is_periodic(const SpaceText& space, const ExpressionTape& pose, std::size_t j) {
  if (space.parameters[j].kind == ParameterKind::kPeriodic) return true;
  for (int i = 0; i < 6; ++i) {
    const std::optional<int> turns = pose.turns(i, static_cast<int>(j));
    if (!turns || (i < 3 && *turns != 0)) return false;
  }
  return true;
}

MapAxis make_axis(const SpaceText& space, const ExpressionTape& pose, std::size_t j) {
  const Parameter& parameter = space.parameters[j];
  if (space.flip && static_cast<std::size_t>((*space.flip)[1]) == j) {
    return {parameter.name, MapAxis::Kind::kTilt, "0", "pi"};
  }
  if (parameter.kind == ParameterKind::kRange) {
    return {parameter.name, MapAxis::Kind::kRange, parameter.range_lower, parameter.range_upper};
  }
  if (is_periodic(space, pose, j)) return {parameter.name, MapAxis::Kind::kTurn, "-pi", "pi"};
  throw FieldError("space.parameters." + parameter.name, "a coordinate without bounds",
                   "expected a range [lower, upper] for it in 'slice', because a map covers all of its space");
}

/// φ, θ and σ. On θ = π the orientation depends on σ − 2φ alone, so σ has to be known as a coordinate or a constant.
std::optional<MapSpace::Flip> make_flip(const SpaceText& space, const ExpressionTape& pose) {
  if (!space.flip) return std::nullopt;
  MapSpace::Flip flip{static_cast<std::size_t>((*space.flip)[0]), static_cast<std::size_t>((*space.flip)[1]), {}};
  for (std::size_t j = 0; j < space.parameters.size(); ++j) {
    if (!pose.depends_on(5, static_cast<int>(j))) continue;
    if (space.pose[5] != space.parameters[j].name || space.parameters[j].kind != ParameterKind::kPeriodic) {
      throw FieldError("space.pose.sigma", "'" + space.pose[5] + "'",
                       "expected a number or a free periodic coordinate, where phi and theta are free");
    }
    flip.sigma = j;
  }
  return flip;
}

}  // namespace

MapSpace make_map_space(const SpaceText& space) {
  const std::size_t free = space.parameters.size();
  if (free < 2 || free > kMaxMapAxes) {
    std::string names;
    for (const Parameter& parameter : space.parameters) names += (names.empty() ? "" : ", ") + parameter.name;
    throw FieldError("space", fmt::format("{} free coordinate{} ({})", free, free == 1 ? "" : "s", names),
                     "expected two or three for a map: fix the others with 'slice'");
  }
  if (!space.constraints.empty()) {
    throw FieldError("space.constraints",
                     fmt::format("{} constraint{}", space.constraints.size(), space.constraints.size() == 1 ? "" : "s"),
                     "expected none for a map: state the surface by its parameters instead");
  }
  std::vector<std::string> names;
  for (const Parameter& parameter : space.parameters) names.push_back(parameter.name);
  const ExpressionTape pose({space.pose.begin(), space.pose.end()}, names, space.constants);
  MapSpace result;
  for (std::size_t j = 0; j < free; ++j) result.axes.push_back(make_axis(space, pose, j));
  result.flip = make_flip(space, pose);
  return result;
}

}  // namespace taut
