// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/legs.h"

#include <fmt/format.h>

#include <initializer_list>
#include <span>
#include <string>

#include "checker/format/cursor.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

/// The values of a problem's parameters at a place of its path: x + pi half_turns, exactly.
struct ExactPoint {
  std::vector<mpq_class> x, half_turns;
};

/// Where the path begins, or where it ends. A spline is there at (P0 + 4 P1 + P2) / 6 of its three control points.
ExactPoint end_of(const Path& path, bool is_last) {
  const bool is_spline = path.law == Law::kCubicBSpline;
  const std::size_t count = is_spline ? 3 : 1;
  const std::span<const Waypoint> all = path.waypoints;
  if (has_poses(path.law) || all.size() < count) throw Rejected("a path without an end in parameters");
  const std::span<const Waypoint> controls = is_last ? all.last(count) : all.first(count);
  constexpr std::array<int, 3> kWeights = {1, 4, 1};
  ExactPoint point;
  for (std::size_t j = 0; j < controls[0].x.size(); ++j) {
    mpq_class x, half_turns;
    for (std::size_t k = 0; k < count; ++k) {
      const mpq_class weight = is_spline ? mpq_class(kWeights.at(k), 6) : mpq_class(1);
      x += weight * mpq_class(controls[k].x[j]);
      half_turns += weight * controls[k].half_turns[j];
    }
    point.x.push_back(x);
    point.half_turns.push_back(half_turns);
  }
  return point;
}

bool is_whole(const mpq_class& x) { return x.get_den() == 1; }

/// Whether b is the pose of a, by its parameters: whole turns of a periodic one are the same pose, and where the space
/// says so, phi + pi with -theta.
bool is_same_pose(const Problem& problem, const ExactPoint& a, const ExactPoint& b) {
  const auto agree = [&](bool is_flipped) {
    for (std::size_t j = 0; j < a.x.size(); ++j) {
      const bool is_phi = is_flipped && j == (*problem.flip)[0], is_theta = is_flipped && j == (*problem.flip)[1];
      const int sign = is_theta ? -1 : 1;
      const mpq_class turns = (b.half_turns[j] - sign * a.half_turns[j] - (is_phi ? 1 : 0)) / 2;
      if (b.x[j] != sign * a.x[j]) return false;
      const bool is_periodic = problem.parameters[j].kind == ParameterKind::kPeriodic;
      if (turns != 0 && !(is_periodic && is_whole(turns))) return false;
    }
    return true;
  };
  return agree(false) || (problem.flip && agree(true));
}

/// What has to be the same of each leg's problem, by its key.
Json same_of(const Json& problem, const std::string& key) {
  if (!problem.contains(key)) return {};
  const Json& value = problem[key];
  const auto with = [&](std::initializer_list<const char*> keys) {
    Json result = Json::object();
    for (const char* const part : keys) result[part] = value.value(part, Json());
    return result;
  };
  if (key == "load") return with({"gravity_m_s2", "point_m"});
  if (key == "bodies") return with({"cables", "exit_cones"});
  return value;
}

}  // namespace

void require_one_machine(const LegsCertificate& certificate) {
  const Json& first = certificate.legs.front().certificate.problem_json;
  for (std::size_t k = 1; k < certificate.legs.size(); ++k) {
    const Json& other = certificate.legs[k].certificate.problem_json;
    for (const auto* problem : {&first, &other}) {
      for (const auto& [key, value] : problem->items()) {
        if (key == "name" || key == "query" || same_of(first, key) == same_of(other, key)) continue;
        throw Rejected(fmt::format("leg {} is about another machine than leg 1: problem.{} differs", k + 1, key));
      }
    }
  }
}

void require_joined(const LegsCertificate& certificate) {
  for (std::size_t k = 1; k < certificate.legs.size(); ++k) {
    const Certificate& before = certificate.legs[k - 1].certificate;
    const Certificate& after = certificate.legs[k].certificate;
    if (is_same_pose(before.problem, end_of(before.path, true), end_of(after.path, false))) continue;
    throw Rejected(fmt::format("leg {} does not begin at the pose at which leg {} ends", k + 1, k));
  }
}

}  // namespace taut::checker
