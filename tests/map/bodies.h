// SPDX-License-Identifier: GPL-3.0-or-later
// Problems with bodies whose spaces are mapped, and distances of their bodies in 200 bits by another route.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "checker/format/exact.h"
#include "checker/format/parts.h"
#include "tests/checker/bodies_oracle.h"
#include "tests/map/problems.h"
#include "tests/soundness/overlap.h"

namespace taut::testing {

inline BodyText box_body(const std::string& name, const std::array<std::string, 3>& half, PointText place) {
  HullText hull;
  for (unsigned k = 0; k < 8; ++k) {
    const auto side = [&](unsigned axis) { return ((k >> axis & 1U) != 0 ? "" : "-") + half[axis]; };
    hull.points_m.push_back({side(0), side(1), side(2)});
  }
  return {.name = name, .at_m = std::move(place), .shape = hull};
}

inline BodyText capsule(const std::string& name, PointText from, PointText to, const std::string& radius) {
  return {.name = name, .shape = HullText{{std::move(from), std::move(to)}, radius}};
}

/// Robot 1, which turns a stick and a box, beside two bars, a turned plate, a ball and a floor. Two of its pairs have
/// no thickness at all.
inline Problem with_bodies(Problem problem) {
  BodiesText bodies;
  bodies.platform = {capsule("stick", {"0", "0", "0"}, {"0", "0", "0.15"}, "0.006"),
                     box_body("box", {"0.05", "0.03", "0.01"}, {"0.02", "0", "0.05"})};
  bodies.obstacles = {capsule("bar", {"0.02", "0.16", "0.4"}, {"-0.14", "0.02", "0.43"}, "0.01"),
                      box_body("plate", {"0.004", "0.06", "0.05"}, {"0.1", "-0.03", "0.4"}),
                      capsule("post", {"-0.19", "-0.19", "0.1"}, {"-0.17", "-0.17", "0.5"}, "0.012"),
                      {.name = "ball", .shape = HullText{{{"0.05", "-0.1", "0.45"}}, "0.02"}},
                      {.name = "floor", .at_m = {"0", "0", "0.485"}, .shape = HalfSpaceText{{"0", "0.1", "-2"}}}};
  bodies.obstacles[1].rotation_rad = {"0.2", "0", "0.5"};
  bodies.obstacles[1].clearance_m = "0";
  bodies.cables.diameter_m.fill("0.002");
  bodies.cables.free_ends_m.fill({"0.03", "0.04"});
  bodies.clearance_m = {"0.004", "0.003", "0.001", "0.002"};
  bodies.pair_clearances_m = {{{"box", "plate"}, "0"}};
  problem.bodies = bodies;
  validate(problem);
  return problem;
}

/// The same, but where stick and box may be in some of the obstacles, in overlapping balls.
inline Problem with_zones(Problem problem) {
  problem = with_bodies(std::move(problem));
  const auto zone = [](const char* x, const char* y, const char* z, const char* within, const char* depth) {
    return ContactZoneText{{x, y, z}, within, depth};
  };
  problem.bodies->contacts = {{{"box", "plate"}, zone("0.05", "0", "0.3", "0.12", "0.004")},
                              {{"plate", "box"}, zone("0.1", "0.05", "0.35", "0.1", "0.05")},
                              {{"stick", "plate"}, zone("0.1", "0", "0.3", "0.1", "0.01")},
                              {{"box", "ball"}, zone("0", "-0.1", "0.3", "0.1", "0.03")},
                              {{"box", "floor"}, zone("0", "0", "0.4", "0.1", "0.02")},
                              {{"stick", "floor"}, zone("0", "0.1", "0.4", "0.15", "0.03")}};
  validate(problem);
  return problem;
}

/// No bodies, but exit cones at either end, that part of the poses keep to.
inline Problem with_exit_cones(Problem problem) {
  BodiesText bodies;
  bodies.exit_cones = {{0, CableEnd::kBase, {"-0.1", "-0.3", "1"}, "0.6"},
                       {3, CableEnd::kPlatform, {"-1", "0", "1.5"}, "0.9"}};
  problem.bodies = bodies;
  validate(problem);
  return problem;
}

/// Distances of pairs of a problem's bodies.
class BodiesOracle {
 public:
  explicit BodiesOracle(const Problem& problem) : cones_(problem.bodies->exit_cones) {
    const nlohmann::json text = to_json(problem);
    bodies_ = checker::read_problem(checker::Cursor(text, "problem")).bodies.value();
    for (const auto& [from, to] :
         {std::pair{&problem.bodies->platform, &platform_}, std::pair{&problem.bodies->obstacles, &obstacles_}}) {
      const auto& read = to == &platform_ ? bodies_.platform : bodies_.obstacles;
      for (std::size_t n = 0; n < from->size(); ++n) {
        checker::TestBody body{read[n], {}};
        for (std::size_t k = 0; k < 3; ++k) {
          body.angles[k] = checker::parse_decimal((*from)[n].rotation_rad[k]).value();
        }
        to->push_back(std::move(body));
      }
    }
  }

  [[nodiscard]] std::size_t pairs() const { return bodies_.pairs.size(); }
  [[nodiscard]] const std::string& name(std::size_t pair) const { return bodies_.pairs[pair].name; }

  /// How much farther than required a pair is apart, at least, and next to it; where hulls meet that may not meet
  /// anywhere, minus radii and clearance. @pre for BigFloat: in PrecisionScope(oracle::kBits)
  template <class S>
  [[nodiscard]] S slack(const campaign::Machine<S>& machine, const campaign::RigidPose<S>& pose,
                        std::size_t pair) const {
    const checker::CheckedPair& of = bodies_.pairs[pair];
    if (of.kind == checker::PairKind::kExitCone) return left_in_cone(cones_.at(of.second), machine, pose);
    const auto here = campaign::bodies_at<S>(bodies_, platform_, obstacles_, of, machine, pose);
    const S clearance = required<S>(of, pose.p);
    const auto deeper = [&](const S& distance) {  // where the hulls meet
      const auto* second = std::get_if<campaign::HullAt<S>>(&here.second);
      if (of.zones.empty() || second == nullptr) return distance;
      const S radii = here.first.radius + second->radius;
      if (distance + radii > S(1e-9)) return distance;
      const S deep = campaign::depth_of(here.first.points, second->points).size;
      return deep > S(0.0) ? S(-deep - radii) : distance;
    };
    if constexpr (std::is_same_v<S, double>) {
      return deeper(campaign::distance_at(here, here)) - clearance;
    } else {
      campaign::Machine<double> rough;
      campaign::RigidPose<double> rough_pose;
      for (std::size_t k = 0; k < 3; ++k) {
        rough_pose.p[k] = pose.p[k].to_double();
        for (std::size_t l = 0; l < 3; ++l) rough_pose.r[k][l] = pose.r[k][l].to_double();
        for (std::size_t i = 0; i < kCables; ++i) {
          rough.a[i][k] = machine.a[i][k].to_double();
          rough.b[i][k] = machine.b[i][k].to_double();
        }
      }
      const auto search = campaign::bodies_at<double>(bodies_, platform_, obstacles_, of, rough, rough_pose);
      return deeper(campaign::distance_at(here, search)) - clearance;
    }
  }
  /// |d| sin(a − t), by a and t.
  template <class S>
  [[nodiscard]] static S left_in_cone(const ExitConeText& cone, const campaign::Machine<S>& machine,
                                      const campaign::RigidPose<S>& pose) {
    using namespace campaign;
    const auto out = pose.p + pose.r * machine.b[cone.cable] - machine.a[cone.cable];
    auto d = out;
    for (std::size_t k = 0; k < 3 && cone.end == CableEnd::kPlatform; ++k) {
      d[k] = -(pose.r[0][k] * out[0] + pose.r[1][k] * out[1] + pose.r[2][k] * out[2]);
    }
    const campaign::Vec<S> n{number<S>(cone.axis[0]), number<S>(cone.axis[1]), number<S>(cone.axis[2])};
    const campaign::Vec<S> across = cross(d, n);
    const S t = angle(root(dot(across, across)), dot(d, n));
    return root(dot(d, d)) * sine(number<S>(cone.half_angle_rad) - t);
  }
  template <class S>
  [[nodiscard]] static S required(const checker::CheckedPair& pair, const campaign::Vec<S>& p) {
    S result = campaign::exact<S>(pair.clearance);
    for (const checker::ContactZone& zone : pair.zones) {
      const campaign::Vec<S> from = campaign::operator-(p, campaign::exact<S>(zone.at));
      const S within = campaign::exact<S>(zone.within), depth = campaign::exact<S>(zone.depth);
      if (!(campaign::dot(from, from) > within * within) && -depth < result) result = -depth;
    }
    return result;
  }

  /// The least of all pairs.
  template <class S>
  [[nodiscard]] S least_slack(const campaign::Machine<S>& machine, const campaign::RigidPose<S>& pose) const {
    S least = slack(machine, pose, 0);
    for (std::size_t n = 1; n < pairs(); ++n) {
      const S here = slack(machine, pose, n);
      if (here < least) least = here;
    }
    return least;
  }

 private:
  std::vector<ExitConeText> cones_;
  checker::Bodies bodies_;
  std::vector<checker::TestBody> platform_, obstacles_;
};

}  // namespace taut::testing
