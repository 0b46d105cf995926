// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/bodies.h"

#include "checker/kernel/rotation.h"

namespace taut::checker {
namespace {

Matrix3<Ball> rotation(const RigidBody& body) {
  const auto angle = [&](std::size_t k) { return body.rotation[k].evaluate<MeanValueForm>({}); };
  return range(roll_pitch_yaw(angle(0), angle(1), angle(2)));
}

PlacedHull placed(const MeshShape& mesh, const RigidBody& body) {
  if (mesh.surface == nullptr) throw Undefined("a mesh was not read");
  PlacedHull result;
  result.mesh = PlacedSurface{mesh.surface, Ball(mesh.unit), balls(body.at), rotation(body)};
  return result;
}

PlacedHull placed(const HullShape& hull, const RigidBody& body) {
  const Matrix3<Ball> R = rotation(body);
  PlacedHull result;
  for (const ExactVector& x : hull.points) result.points.push_back(balls(body.at) + multiply(R, balls(x)));
  result.radius = Ball(hull.radius);
  return result;
}

PlacedHalfSpace placed(const HalfSpaceShape& half_space, const RigidBody& body) {
  return {balls(half_space.normal), Ball(dot(half_space.normal, body.at))};
}

PlacedExitCone placed(const ExitCone& cone) {
  const Ball angle = cone.half_angle.evaluate<MeanValueForm>({}).range();
  if (!certainly_positive(angle) || !certainly_positive(half(Ball::pi()) - angle)) {
    throw Undefined("the half-angle of an exit cone may not be above 0 and below a right angle");
  }
  const Vector3<Ball> axis = balls(cone.axis);
  const MeanValueForm form(angle);
  return {cone.end, (Ball(1) / sqrt(squared_norm(axis))) * axis, apply(Function::kSin, form).range(),
          apply(Function::kCos, form).range()};
}

}  // namespace

PlacedBodies::PlacedBodies(const Problem& problem) {
  const Bodies& bodies = problem.bodies.value();
  for (const ExitCone& cone : bodies.exit_cones) exit_cones.push_back(placed(cone));
  for (const RigidBody& body : bodies.platform) {
    const auto* const mesh = std::get_if<MeshShape>(&body.shape);
    platform.push_back(mesh != nullptr ? placed(*mesh, body) : placed(std::get<HullShape>(body.shape), body));
  }
  for (const RigidBody& body : bodies.obstacles) {
    std::visit([&](const auto& shape) { obstacles.emplace_back(placed(shape, body)); }, body.shape);
  }
  for (const CheckedPair& pair : bodies.pairs) {
    pairs.push_back(pair);
    clearance.emplace_back(pair.clearance);
    std::vector<PlacedZone>& placed_zones = zones.emplace_back();
    for (const ContactZone& zone : pair.zones) {
      placed_zones.push_back({balls(zone.at), Ball(zone.within), Ball(zone.depth)});
    }
  }
  const auto& tolerances = problem.tolerances;
  for (std::size_t i = 0; i < kCables; ++i) {
    cable_radius[i] = half(Ball(bodies.cables[i].diameter));
    free_ends[i] = balls(bodies.cables[i].free_ends);
    for (std::size_t j = 0; j < kCables; ++j) {
      shares[i][j] = {problem.base_anchors[i] == problem.base_anchors[j] &&
                          (!tolerances || tolerances->base_anchors[i] == tolerances->base_anchors[j]),
                      problem.platform_anchors[i] == problem.platform_anchors[j] &&
                          (!tolerances || tolerances->platform_anchors[i] == tolerances->platform_anchors[j])};
    }
  }
}

namespace {

/// within - |p - at|: the platform's origin is in the zone where this is not negative.
Ball depth_in(const PlacedZone& zone, const Vector3<Ball>& p) { return zone.within - length_range(p - zone.at); }

}  // namespace

Ball PlacedBodies::required_at_most(std::size_t k, const Vector3<Ball>& p) const {
  Ball result = clearance[k];
  for (const PlacedZone& zone : zones[k]) {
    if (certainly_nonnegative(depth_in(zone, p))) result = smaller(result, -lowest(zone.depth));
  }
  return result;
}

Ball PlacedBodies::required_at_least(std::size_t k, const Vector3<Ball>& p) const {
  Ball result = clearance[k];
  for (const PlacedZone& zone : zones[k]) {
    if (!certainly_negative(depth_in(zone, p))) result = smaller(result, -highest(zone.depth));
  }
  return result;
}

}  // namespace taut::checker
