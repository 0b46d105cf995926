// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/body_distances.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "certify/bodies/nearest_mesh.h"

namespace taut {
namespace {

using Point = Vector3<double>;

Point weighted(const Points& points, std::span<const double> shares) {
  Point result = Point::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) result += shares[k] * points[k];
  return result;
}

/// How far any point of the bodies of a pair moves, at most, between two poses, relative to the other body.
double moved(const CheckedPair<double>& pair, const RigidPose& from, const RigidPose& to, double reach) {
  // Near its cut end a cable's point moves by as much as the end and is shifted along the cable by as much again.
  const double moving = pair.kind == PairClass::kPlatformObstacles ? 1 : pair.kind == PairClass::kCablesCables ? 4 : 3;
  return moving * ((to.p - from.p).norm() + from.q.angularDistance(to.q) * reach);
}

double reach_of(const BodyModel<double>& bodies, const Model<double>& model) {
  double reach = 0;
  for (const ConvexBody<double>& body : bodies.platform) {
    for (const Point& x : body.points) reach = std::max(reach, x.norm());
  }
  for (const Point& b : model.p_PB) reach = std::max(reach, b.norm());
  return reach;
}

}  // namespace

BodyDistances::BodyDistances(const Problem& problem) : bodies_(problem) {
  for (const BodyPair& pair : taut::pairs(*problem.bodies)) names_.push_back(taut::name(*problem.bodies, pair));
}

std::array<BodyDistances::Placed, 2> BodyDistances::placed(const Model<double>& model, const RigidPose& pose,
                                                           std::size_t n) const {
  const BodyModel<double>& bodies = bodies_.bodies();
  const CheckedPair<double>& pair = bodies.pairs.at(n);
  const Matrix3<double> turn = pose.q.toRotationMatrix();
  const auto is_mesh = [](const Obstacle<double>& body) {
    const auto* convex = std::get_if<ConvexBody<double>>(&body);
    return convex != nullptr && convex->mesh != nullptr;
  };
  const bool has_obstacle = pair.kind == PairClass::kPlatformObstacles || pair.kind == PairClass::kCablesObstacles;
  const bool has_mesh = (pair.kind == PairClass::kPlatformObstacles && bodies.platform[pair.first].mesh) ||
                        (pair.kind == PairClass::kCablesPlatform && bodies.platform[pair.second].mesh) ||
                        (has_obstacle && is_mesh(bodies.obstacles[pair.second]));
  // Of a mesh, the element that is nearest stands for all of it.
  const auto elements =
      has_mesh ? bodies_.nearest(model, pose, n).elements : std::array<std::optional<std::uint32_t>, 2>{};
  const auto points_of = [&](const ConvexBody<double>& body, std::size_t which) {
    if (!body.mesh || !elements[which]) return Points(body.points.begin(), body.points.end());
    Points points;
    for (const auto& f : body.mesh->mesh->points(*elements[which])) points.push_back(body.mesh->place(f));
    return points;
  };
  const auto cable = [&](std::size_t i) -> Placed {
    const Point a = model.p_WA[i];
    const Point b = pose.p + turn * model.p_PB[i];
    const Point along = (b - a).normalized();
    return {{a + bodies.cable_free[i][0] * along, b - bodies.cable_free[i][1] * along}, bodies.cable_radius[i]};
  };
  const auto carried = [&](const ConvexBody<double>& body, std::size_t which) {
    Placed result{{}, body.radius};
    for (const Point& x : points_of(body, which)) result.points.emplace_back(pose.p + turn * x);
    return result;
  };
  const auto fixed = [&](const Obstacle<double>& body) -> Placed {
    if (const auto* half_space = std::get_if<HalfSpace<double>>(&body)) return {{}, 0, half_space};
    const auto& hull = std::get<ConvexBody<double>>(body);
    return {points_of(hull, 1), hull.radius};
  };
  switch (pair.kind) {
    case PairClass::kExitCones: return {cable(pair.first), {}};
    case PairClass::kPlatformObstacles: break;
    case PairClass::kCablesObstacles: return {cable(pair.first), fixed(bodies.obstacles[pair.second])};
    case PairClass::kCablesCables: return {cable(pair.first), cable(pair.second)};
    case PairClass::kCablesPlatform: return {cable(pair.first), carried(bodies.platform[pair.second], 1)};
  }
  return {carried(bodies.platform[pair.first], 0), fixed(bodies.obstacles[pair.second])};
}

namespace {

/// The first or the second body of a pair at a pose: a mesh, or else these points.
BodyInFrame in_frame(const BodyModel<double>& bodies, const CheckedPair<double>& pair, bool is_first,
                     const RigidPose& pose, const Points& points) {
  const bool is_of_platform = pair.kind == (is_first ? PairClass::kPlatformObstacles : PairClass::kCablesPlatform);
  const ConvexBody<double>* body = nullptr;
  if (is_of_platform) {
    body = &bodies.platform[is_first ? pair.first : pair.second];
  } else if (!is_first && pair.kind != PairClass::kCablesCables) {
    body = std::get_if<ConvexBody<double>>(&bodies.obstacles[pair.second]);
  }
  BodyInFrame result;
  if (body == nullptr || body->mesh == nullptr) {
    result.points = points;
    return result;
  }
  const PlacedMesh<double>& mesh = *body->mesh;
  result.mesh = mesh.mesh.get();
  result.origin = mesh.at;
  result.axes = mesh.unit * (mesh.turn ? *mesh.turn : Matrix3<double>::Identity());
  if (!is_of_platform) return result;
  const Matrix3<double> turn = pose.q.toRotationMatrix();
  result.origin = pose.p + turn * result.origin;
  result.axes = turn * result.axes;
  return result;
}

}  // namespace

BodyDistance BodyDistances::at(const Model<double>& model, const RigidPose& pose, std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.bodies().pairs.at(n);
  BodyDistance result{n, 0, required_distance(pair, pose.p).at_most};
  if (pair.kind == PairClass::kExitCones) {
    result.distance = bodies_.gap(model, pose, n);
    result.is_in_cone = true;
    const bool is_at_base = bodies_.bodies().exit_cones[pair.second].end == CableEnd::kBase;
    result.at.fill(is_at_base ? model.p_WA[pair.first] : Point(pose.p + pose.q * model.p_PB[pair.first]));
    return result;
  }
  auto [first, second] = placed(model, pose, n);
  const BodyInFrame a = in_frame(bodies_.bodies(), pair, true, pose, first.points);
  const BodyInFrame b = in_frame(bodies_.bodies(), pair, false, pose, second.points);
  bool is_inside = false;
  if (second.half_space != nullptr) {
    if (a.mesh != nullptr) first.points = points_of(a, lowest_element(a, second.half_space->normal));
  } else if (a.mesh != nullptr || b.mesh != nullptr) {  // what comes nearest of a mesh stands for it
    const auto [of_first, of_second] = nearest_elements(a, b).elements;
    first.points = points_of(a, of_first);
    second.points = points_of(b, of_second);
    is_inside = point_inside(a, b).has_value();
  }
  if (const HalfSpace<double>* half_space = second.half_space) {
    const Point normal = half_space->normal.normalized();
    const auto height = [&](const Point& x) { return normal.dot(x) - half_space->offset / half_space->normal.norm(); };
    const Point lowest = *std::ranges::min_element(first.points, {}, height);
    result.distance = height(lowest) - first.radius;
    result.at = {lowest - first.radius * normal, lowest - height(lowest) * normal};
    return result;
  }
  const NearestPoints nearest = nearest_points(first.points, second.points);
  result.at = {weighted(first.points, nearest.first), weighted(second.points, nearest.second)};
  double size = 0;
  for (const Point& x : first.points) size = std::max(size, x.cwiseAbs().maxCoeff());
  if (nearest.distance > 1e-9 * size) {
    const Point along = nearest.apart / nearest.distance;
    // Of what is inside of a mesh: how far its surface is, which is less than how deep the bodies are in each other.
    result.distance = (is_inside ? -nearest.distance : nearest.distance) - first.radius - second.radius;
    result.at[0] -= first.radius * along;
    result.at[1] += second.radius * along;
    return result;
  }
  result.distance = -overlap(first.points, second.points).depth - first.radius - second.radius;
  return result;
}

DecimalText asked_exactly(const BodyDistance& distance, const BodyPair& pair) {
  const auto is_it = [&](const ContactZoneText& zone) {
    return -ScalarTraits<double>::from_decimal(zone.depth_m) == distance.clearance;
  };
  const auto zone = std::ranges::find_if(pair.zones, is_it);
  return zone == pair.zones.end() ? pair.clearance_m : "-" + zone->depth_m;
}

std::vector<BodyDistance> BodyDistances::nearest(const Model<double>& model, const RigidPose& pose,
                                                 std::size_t most) const {
  std::vector<BodyDistance> all;
  for (std::size_t n = 0; n < pairs(); ++n) all.push_back(at(model, pose, n));
  std::ranges::stable_sort(all, {}, &BodyDistance::left);
  all.resize(std::min(most, all.size()));
  return all;
}

std::size_t DistancesAlong::worst() const {
  return static_cast<std::size_t>(std::ranges::min_element(least, {}, &BodyDistance::left) - least.begin());
}

DistancesAlong distances_along(const BodyDistances& distances, const Sampler& sampler,
                               const std::vector<PathSample>& samples) {
  DistancesAlong result;
  const std::size_t count = distances.pairs();
  if (count == 0 || samples.empty()) return result;
  const BodyModel<double>& bodies = distances.bodies();
  const double reach = reach_of(bodies, sampler.model());
  struct Known {
    double left = 0;  ///< when it was last measured
    double least = std::numeric_limits<double>::infinity();
    RigidPose pose{};
    bool is_measured = false;
  };
  std::vector<Known> known(count);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<RigidPose> poses;
  for (const PathSample& sample : samples) {
    const RigidPose& pose = poses.emplace_back(sampler.rigid_pose(sample));
    std::ranges::stable_sort(order, {}, [&](std::size_t n) { return known[n].left; });
    std::optional<BodyDistance> least;
    for (const std::size_t n : order) {
      Known& last = known[n];
      // A pair that was farther apart than it can have come nearer since is not the one.
      const bool is_out = last.is_measured && bodies.pairs[n].zones.empty() &&
                          bodies.pairs[n].kind != PairClass::kExitCones && least &&
                          last.left - moved(bodies.pairs[n], last.pose, pose, reach) > least->left();
      if (is_out) continue;
      const BodyDistance now = distances.at(sampler.model(), pose, n);
      last = {now.left(), std::min(last.least, now.left()), pose, true};
      if (!least || now.left() < least->left()) least = now;
    }
    result.least.push_back(*least);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t n) { return known[n].least; });
  order.resize(std::min(order.size(), DistancesAlong::kMostPairs));
  struct Column {
    std::size_t pair, least_at;
    double left;
    std::vector<double> distance, clearance;
  };
  std::vector<Column> columns;
  for (const std::size_t n : order) {
    Column& column = columns.emplace_back(Column{n, 0, std::numeric_limits<double>::infinity(), {}, {}});
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const BodyDistance now = distances.at(sampler.model(), poses[k], n);
      column.distance.push_back(now.distance);
      column.clearance.push_back(now.clearance);
      if (!(now.left() < column.left)) continue;
      column.left = now.left();
      column.least_at = k;
    }
  }
  std::ranges::stable_sort(columns, {}, &Column::left);
  for (Column& column : columns) {
    result.nearest.push_back(column.pair);
    result.nearest_at.push_back(column.least_at);
    result.clearance.push_back(std::move(column.clearance));
    result.distance.push_back(std::move(column.distance));
  }
  return result;
}

}  // namespace taut
