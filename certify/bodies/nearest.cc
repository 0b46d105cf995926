// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/bodies/nearest.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "certify/bodies/nearest_mesh.h"

namespace taut {
namespace {

using Point = Vector3<double>;

/// A vertex a_i − b_j of the difference of two hulls.
struct Vertex {
  Point at;
  std::size_t first = 0, second = 0;
};

std::size_t farthest(std::span<const Point> points, const Point& along) {
  const auto height = [&](const Point& x) { return x.dot(along); };
  return static_cast<std::size_t>(std::ranges::max_element(points, {}, height) - points.begin());
}

/// The point of the hull of up to four vertices that is nearest to the origin, as shares of these.
struct OnSimplex {
  Point at{0, 0, 0};
  std::array<double, 4> shares{};
  double squared = std::numeric_limits<double>::infinity();
};

/// The nearest point of the affine hull of some of the vertices; not if it is outside of their hull.
std::optional<OnSimplex> nearest_on_face(std::span<const Vertex> vertices, unsigned members) {
  std::array<std::size_t, 4> index{};
  std::size_t n = 0;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if ((members >> k & 1U) != 0) index[n++] = k;
  }
  const Point& origin = vertices[index[0]].at;
  std::array<Point, 3> edge;
  for (std::size_t k = 1; k < n; ++k) edge[k - 1] = vertices[index[k]].at - origin;
  // The least of |origin + Σ along_k edge_k|, by Gram's matrix and Cramer's rule; where its determinant is next to
  // nothing a lower face has the same points.
  constexpr double kFlat = 1e-14;  // of what it would be at right angles
  std::array<double, 3> along{};
  const auto g = [&](std::size_t i, std::size_t j) { return edge[i].dot(edge[j]); };
  const auto h = [&](std::size_t i) { return -edge[i].dot(origin); };
  if (n == 2) {
    if (!(g(0, 0) > 0)) return std::nullopt;
    along[0] = h(0) / g(0, 0);
  } else if (n == 3) {
    const double determinant = g(0, 0) * g(1, 1) - g(0, 1) * g(0, 1);
    if (!(determinant > kFlat * g(0, 0) * g(1, 1))) return std::nullopt;
    along[0] = (h(0) * g(1, 1) - h(1) * g(0, 1)) / determinant;
    along[1] = (h(1) * g(0, 0) - h(0) * g(0, 1)) / determinant;
  } else if (n == 4) {
    const double volume = edge[0].dot(edge[1].cross(edge[2]));
    if (!(volume * volume > kFlat * g(0, 0) * g(1, 1) * g(2, 2))) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) along[k] = -origin.dot(edge[(k + 1) % 3].cross(edge[(k + 2) % 3])) / volume;
  }
  OnSimplex result;
  double rest = 1;
  result.at = origin;
  for (std::size_t k = 1; k < n; ++k) {
    const double share = along[k - 1];
    if (!(share >= 0)) return std::nullopt;
    result.shares[index[k]] = share;
    result.at += share * edge[k - 1];
    rest -= share;
  }
  if (!(rest >= 0)) return std::nullopt;
  result.shares[index[0]] = rest;
  result.squared = result.at.squaredNorm();
  return result;
}

OnSimplex nearest_on_simplex(std::span<const Vertex> vertices) {
  OnSimplex best;
  for (unsigned members = 1; members < 1U << vertices.size(); ++members) {
    const auto candidate = nearest_on_face(vertices, members);
    if (candidate && candidate->squared < best.squared) best = *candidate;
  }
  return best;
}

}  // namespace

NearestPoints nearest_points(std::span<const Point> first, std::span<const Point> second) {
  constexpr int kMostSteps = 100;
  constexpr double kEnough = 1e-14;  // of the squared distance
  constexpr double kMeet = 1e-28;    // of the squared distance of two points: all that rounding leaves where hulls meet
  std::vector<Vertex> simplex{{first[0] - second[0], 0, 0}};
  OnSimplex nearest = nearest_on_simplex(simplex);
  for (int step = 0; step < kMostSteps; ++step) {
    const Point down = -nearest.at;
    const std::size_t i = farthest(first, down);
    const std::size_t j = farthest(second, -down);
    const Vertex next{first[i] - second[j], i, j};
    const bool is_known = std::ranges::any_of(simplex, [&](const Vertex& v) { return v.first == i && v.second == j; });
    if (is_known || nearest.squared - next.at.dot(nearest.at) <= kEnough * nearest.squared) break;
    std::vector<Vertex> kept;
    for (std::size_t k = 0; k < simplex.size(); ++k) {
      if (nearest.shares[k] > 0) kept.push_back(simplex[k]);
    }
    if (kept.size() == 4) {  // the origin is inside
      nearest.squared = 0;
      nearest.at = Point::Zero();
      break;
    }
    kept.push_back(next);
    const OnSimplex closer = nearest_on_simplex(kept);
    if (!(closer.squared < nearest.squared)) break;
    simplex = std::move(kept);
    nearest = closer;
  }
  double largest = 0;
  for (const Vertex& v : simplex) largest = std::max(largest, v.at.squaredNorm());
  if (nearest.squared <= kMeet * largest) nearest = {Point::Zero(), nearest.shares, 0};
  NearestPoints result{std::sqrt(nearest.squared), nearest.at, std::vector<double>(first.size()),
                       std::vector<double>(second.size())};
  for (std::size_t k = 0; k < simplex.size(); ++k) {
    result.first[simplex[k].first] += nearest.shares[k];
    result.second[simplex[k].second] += nearest.shares[k];
  }
  return result;
}

// ---- Overlap --------------------------------------------------------------------------------------------------------

namespace {

/// How far the first has to be moved along a unit vector until a plane across it is between the two.
double overlap_along(std::span<const Point> first, std::span<const Point> second, const Point& u) {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -least;
  for (const Point& a : first) least = std::min(least, u.dot(a));
  for (const Point& b : second) greatest = std::max(greatest, u.dot(b));
  return greatest - least;
}

}  // namespace

Overlap overlap(std::span<const Point> first, std::span<const Point> second) {
  constexpr int kDirections = 600;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Overlap> tried;
  const auto consider = [&](const Point& u) { tried.push_back({overlap_along(first, second, u), u}); };
  for (int k = 0; k < kDirections; ++k) {  // points that are spread over a sphere
    const double z = 1 - (2 * k + 1.0) / kDirections;
    const double across = std::sqrt(1 - z * z);
    consider({across * std::cos(golden * k), across * std::sin(golden * k), z});
  }
  for (int k = 0; k < 3; ++k) {  // across faces of boxes that stand straight
    consider(Point::Unit(k));
    consider(-Point::Unit(k));
  }
  constexpr std::size_t kStarts = 6;
  constexpr int kTurns = 50;
  constexpr double kBeyond = 1.25;  // the first is moved farther than out, so that nearest points tell a direction
  std::ranges::partial_sort(tried, tried.begin() + kStarts, {}, &Overlap::depth);
  Overlap best = tried.front();
  std::vector<Point> moved(first.size());
  for (std::size_t start = 0; start < kStarts; ++start) {
    // Let the first, moved by t along u, be at the distance d from the second, along v. Then the overlap along v is
    // t u·v − d, and d is at least t minus the overlap along u. So the overlap along v is the lesser, unless v = u.
    Overlap here = tried[start];
    for (int turn = 0; turn < kTurns && here.depth > 0; ++turn) {
      for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = first[k] + kBeyond * here.depth * here.along;
      const NearestPoints nearest = nearest_points(moved, second);
      if (!(nearest.distance > 0)) break;
      const Point u = nearest.apart.normalized();
      const double depth = overlap_along(first, second, u);
      if (!(depth < here.depth)) break;
      here = {depth, u};
    }
    if (here.depth < best.depth) best = here;
  }
  best.depth = std::max(best.depth, 0.0);
  return best;
}

// ---- Pairs of a problem ---------------------------------------------------------------------------------------------

namespace {

/// The two ends of a cable's checked part, in W.
std::vector<Point> cable_ends(const BodyModel<double>& bodies, const Model<double>& model, const RigidPose& pose,
                              std::size_t i) {
  const Point a = model.p_WA[i];
  const Point b = pose.p + pose.q.toRotationMatrix() * model.p_PB[i];
  const Point along = (b - a).normalized();
  return {a + bodies.cable_free[i][0] * along, b - bodies.cable_free[i][1] * along};
}

double distance_in_cone(const BodyModel<double>& bodies, const Model<double>& model, const RigidPose& pose,
                        const CheckedPair<double>& pair) {
  const ExitCone<double>& cone = bodies.exit_cones[pair.second];
  Point d = pose.p + pose.q * model.p_PB[pair.first] - model.p_WA[pair.first];
  if (cone.end == CableEnd::kPlatform) d = -(pose.q.conjugate() * d);
  return taut::distance_in_cone<double>(cone, {d(0), d(1), d(2)});
}

std::vector<Point> carried(const ConvexBody<double>& body, const RigidPose& pose) {
  const Matrix3<double> r = pose.q.toRotationMatrix();
  std::vector<Point> points;
  points.reserve(body.points.size());
  for (const Point& x : body.points) points.emplace_back(pose.p + r * x);
  return points;
}

/// As multiples of 1/kWhole that sum to kWhole.
std::vector<std::int64_t> rounded_shares(const std::vector<double>& shares) {
  std::vector<std::int64_t> result;
  if (shares.empty()) return result;
  for (const double share : shares) {
    result.push_back(std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(PointPair::kWhole)));
  }
  const std::int64_t sum = std::accumulate(result.begin(), result.end(), std::int64_t{0});
  *std::ranges::max_element(result) += PointPair::kWhole - sum;
  return result;
}

/// @returns one along z where `along` has no direction.
Direction rounded_direction(const Point& along, bool in_platform, int largest) {
  const double size = along.cwiseAbs().maxCoeff();
  if (!along.allFinite() || !(size > 0)) return {in_platform, {0, 0, 1}};
  const Point scaled = (along / size) * largest;
  Direction result{in_platform, {}};
  int divisor = 0;
  for (int k = 0; k < 3; ++k) {
    const int x = static_cast<int>(std::lround(scaled(k)));
    result.u[static_cast<std::size_t>(k)] = x;
    divisor = std::gcd(divisor, x);
  }
  for (int& x : result.u) x /= divisor;
  return result;
}

/// Two cables on one point of the platform are best seen from it; where deviations matter little, W is as good.
bool is_best_in_platform(const CheckedPair<double>& pair) {
  return pair.kind == PairClass::kCablesPlatform || (pair.kind == PairClass::kCablesCables && pair.shares_platform);
}

}  // namespace

BodySampler::BodySampler(const Problem& problem) : bodies_(make_body_model<double>(problem)) {
  for (const ConvexBody<double>& body : bodies_.platform) {
    for (const Point& x : body.points) reach_ = std::max(reach_, x.norm());
  }
  for (const Point& b : make_model_without_ellipsoid<double>(problem).p_PB) reach_ = std::max(reach_, b.norm());
  if (!problem.tolerances || problem.tolerances->cable_length_m) return;
  const auto number = [](const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); };
  Tolerances& of = tolerances_.emplace();
  std::ranges::transform(problem.tolerances->base_anchor_m, of.base.begin(), number);
  std::ranges::transform(problem.tolerances->platform_anchor_m, of.anchor.begin(), number);
  of.position = number(problem.tolerances->position_m);
  of.turn = evaluate_constant<double>(problem.tolerances->orientation_rad);
}

/// Of a half-space no shares, and `apart` along its normal, whose height it is.
struct BodySampler::Found {
  NearestPoints nearest;
  double needed = 0;  ///< radii, and how far the pair has to be apart here
  bool is_half_space = false;
  std::array<std::vector<Point>, 2> points;                   ///< of either body; of neither a half-space nor a mesh
  std::array<std::optional<std::uint32_t>, 2> elements = {};  ///< of meshes
  std::optional<std::size_t> inside = {};                     ///< as in PointPair; then the distance is negative
};

const HalfSpace<double>* BodySampler::half_space(const CheckedPair<double>& pair) const {
  const bool is_of_obstacle = pair.kind == PairClass::kPlatformObstacles || pair.kind == PairClass::kCablesObstacles;
  return is_of_obstacle ? std::get_if<HalfSpace<double>>(&bodies_.obstacles[pair.second]) : nullptr;
}

bool BodySampler::needs_list(std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  if (pair.kind == PairClass::kCablesCables || pair.kind == PairClass::kExitCones || half_space(pair) != nullptr)
    return false;
  const auto is_mesh = [](const ConvexBody<double>& body) { return body.mesh != nullptr; };
  if (pair.kind == PairClass::kCablesPlatform) return is_mesh(bodies_.platform[pair.second]);
  return is_mesh(std::get<ConvexBody<double>>(bodies_.obstacles[pair.second])) ||
         (pair.kind == PairClass::kPlatformObstacles && is_mesh(bodies_.platform[pair.first]));
}

namespace {

/// A body that stands still, or one that the platform carries.
BodyInFrame in_frame(const ConvexBody<double>& body, const RigidPose* pose) {
  BodyInFrame result;
  if (body.mesh == nullptr) {
    result.points = pose != nullptr ? carried(body, *pose) : body.points;
    return result;
  }
  const PlacedMesh<double>& mesh = *body.mesh;
  result.mesh = mesh.mesh.get();
  result.origin = mesh.at;
  result.axes = mesh.unit * (mesh.turn ? *mesh.turn : Matrix3<double>::Identity());
  if (pose == nullptr) return result;
  const Matrix3<double> r = pose->q.toRotationMatrix();
  result.origin = pose->p + r * result.origin;
  result.axes = r * result.axes;
  return result;
}

}  // namespace

/// The bodies of a pair at a pose; a half-space has no points.
std::array<BodyInFrame, 2> BodySampler::in_world(const Model<double>& model, const RigidPose& pose,
                                                 std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  std::array<BodyInFrame, 2> result;
  if (pair.kind == PairClass::kPlatformObstacles) {
    result[0] = in_frame(bodies_.platform[pair.first], &pose);
  } else {
    result[0].points = cable_ends(bodies_, model, pose, pair.first);
  }
  if (pair.kind == PairClass::kCablesCables) {
    result[1].points = cable_ends(bodies_, model, pose, pair.second);
  } else if (pair.kind == PairClass::kCablesPlatform) {
    result[1] = in_frame(bodies_.platform[pair.second], &pose);
  } else if (half_space(pair) == nullptr) {
    result[1] = in_frame(std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]), nullptr);
  }
  return result;
}

BodySampler::Found BodySampler::find(const Model<double>& model, const RigidPose& pose, std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  Found found;
  if (pair.kind == PairClass::kExitCones) {
    found.is_half_space = true;
    found.nearest.distance = distance_in_cone(bodies_, model, pose, pair);
    return found;
  }
  const std::array<BodyInFrame, 2> bodies = in_world(model, pose, n);
  found.needed = required_distance(pair, pose.p).at_most + (pair.kind == PairClass::kPlatformObstacles
                                                                ? bodies_.platform[pair.first].radius
                                                                : bodies_.cable_radius[pair.first]);
  if (const auto* half = half_space(pair)) {
    const Point normal = half->normal.normalized();
    std::vector<Point> points = bodies[0].points;
    if (bodies[0].mesh != nullptr) {
      found.elements[0] = lowest_element(bodies[0], normal);
      points = points_of(bodies[0], found.elements[0]);
    }
    const std::size_t lowest = farthest(points, -normal);
    found.is_half_space = true;
    found.nearest.distance = points[lowest].dot(normal) - half->offset / half->normal.norm();
    found.nearest.apart = normal;
    found.nearest.first.assign(points.size(), 0.0);
    found.nearest.first[lowest] = 1;
    return found;
  }
  switch (pair.kind) {
    case PairClass::kCablesCables: found.needed += bodies_.cable_radius[pair.second]; break;
    case PairClass::kCablesPlatform: found.needed += bodies_.platform[pair.second].radius; break;
    case PairClass::kExitCones: break;
    case PairClass::kPlatformObstacles:
    case PairClass::kCablesObstacles:
      found.needed += std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]).radius;
  }
  if (bodies[0].mesh == nullptr && bodies[1].mesh == nullptr) {
    found.nearest = nearest_points(bodies[0].points, bodies[1].points);
    found.points = {bodies[0].points, bodies[1].points};
    if (!pair.zones.empty() && !(found.nearest.distance > 0)) {
      const Overlap deep = overlap(bodies[0].points, bodies[1].points);
      found.nearest.distance = -deep.depth;
      found.nearest.apart = deep.along;
    }
    return found;
  }
  NearestElements nearest = nearest_elements(bodies[0], bodies[1]);
  found.nearest = std::move(nearest.nearest);
  found.elements = nearest.elements;
  if (!(found.nearest.distance > 0)) return found;
  if (auto point = point_inside(bodies[0], bodies[1])) {
    found.inside = point->solid;
    found.nearest.distance *= -1;
    found.elements[point->solid].reset();
    found.elements[1 - point->solid] = point->element;
    (point->solid == 0 ? found.nearest.first : found.nearest.second).clear();
    (point->solid == 0 ? found.nearest.second : found.nearest.first) = std::move(point->shares);
  }
  return found;
}

double BodySampler::gap(const Model<double>& model, const RigidPose& pose, std::size_t pair) const {
  const Found found = find(model, pose, pair);
  return found.nearest.distance - found.needed;
}

namespace {

/// How far apart along a unit vector.
double gap_along(const Point& u, const std::vector<Point>& first, const std::vector<Point>& second) {
  return u.dot(first[farthest(first, -u)]) - u.dot(second[farthest(second, u)]);
}

}  // namespace

/// Whether a body of the platform and an obstacle stay farther apart along a vector of P than along the same of W.
bool BodySampler::is_better_in_platform(const CheckedPair<double>& pair, const Point& along, const RigidPose& pose,
                                        std::span<const RigidPose> around) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Point u = along.normalized();
  const Point v = pose.q.toRotationMatrix().transpose() * u;
  const std::vector<Point>& obstacle = std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]).points;
  double of_world = kInfinity, of_platform = kInfinity;
  for (const RigidPose& there : around) {
    const std::vector<Point> body = carried(bodies_.platform[pair.first], there);
    of_world = std::min(of_world, gap_along(u, body, obstacle));
    of_platform = std::min(of_platform, gap_along(there.q.toRotationMatrix() * v, body, obstacle));
  }
  return of_platform > of_world;
}

std::optional<Direction> BodySampler::direction(const Model<double>& model, const RigidPose& pose, std::size_t n,
                                                int largest, std::span<const RigidPose> around) const {
  const Found found = find(model, pose, n);
  if (found.is_half_space) return Direction{};
  const CheckedPair<double>& pair = bodies_.pairs[n];
  if (!(found.nearest.distance > 0) && pair.zones.empty()) return std::nullopt;
  Point along = found.nearest.apart;
  const bool in_platform = is_best_in_platform(pair) || (pair.kind == PairClass::kPlatformObstacles &&
                                                         is_better_in_platform(pair, along, pose, around));
  if (in_platform) along = pose.q.toRotationMatrix().transpose() * along;
  return rounded_direction(along, in_platform, largest);
}

std::vector<Direction> BodySampler::directions(const Model<double>& model, const RigidPose& pose, std::size_t n,
                                               int largest, double share, std::span<const RigidPose> around) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  std::vector<Direction> result;
  if (!needs_list(n)) {
    if (const auto one = direction(model, pose, n, largest, around)) result.push_back(*one);
    return result;
  }
  const std::array<BodyInFrame, 2> bodies = in_world(model, pose, n);
  double needed = pair.clearance;  // a mesh has no radius
  if (pair.kind != PairClass::kPlatformObstacles) {
    needed += bodies_.cable_radius[pair.first];
  } else {
    needed += bodies_.platform[pair.first].radius + std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]).radius;
  }
  const bool in_platform = is_best_in_platform(pair);
  for (Point along : covering_directions(bodies[0], bodies[1], needed, share)) {
    if (in_platform) along = pose.q.toRotationMatrix().transpose() * along;
    const Direction rounded = rounded_direction(along, in_platform, largest);
    if (std::ranges::find(result, rounded) == result.end()) result.push_back(rounded);
  }
  return result;
}

namespace {

/// Two points, of which one may be the other.
using Line = std::array<Point, 2>;

/// Between the nearest points of two segments, from the second to the first.
Point between_segments(const Line& first, const Line& second) {
  const Point d = first[1] - first[0], e = second[1] - second[0], r = first[0] - second[0];
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e), dr = d.dot(r), er = e.dot(r);
  const auto share = [](double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; };
  double s = share(de * er - dr * ee, dd * ee - de * de);  // where the lines are nearest
  double t = ee > 0 ? (de * s + er) / ee : 0.0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = share(de * t - dr, dd);
  } else if (!(ee > 0)) {
    s = share(-dr, dd);
  }
  return r + s * d - t * e;
}

}  // namespace

/// Cables from anchor to anchor, and the middles of bodies, in W.
struct BodySampler::Sketch {
  Matrix3<double> r_WP;
  std::array<Line, kCables> cables;
  std::vector<Point> middles;  ///< of the platform's bodies
};

BodySampler::Sketch BodySampler::sketch(const Model<double>& model, const RigidPose& pose) const {
  Sketch result{pose.q.toRotationMatrix(), {}, {}};
  for (std::size_t i = 0; i < kCables; ++i) {
    result.cables[i] = {model.p_WA[i], pose.p + result.r_WP * model.p_PB[i]};
  }
  for (const ConvexBody<double>& body : bodies_.platform) {
    result.middles.emplace_back(pose.p + result.r_WP * body.centre);
  }
  return result;
}

/// Of a half-space, its gap is not looked for.
BodySampler::RoughDirection BodySampler::rough_direction(const Sketch& at, std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  if (half_space(pair) != nullptr || pair.kind == PairClass::kExitCones) return {};
  Line first, second;
  double needed = pair.clearance;
  if (pair.kind == PairClass::kPlatformObstacles) {
    first.fill(at.middles[pair.first]);
    needed += bodies_.platform[pair.first].reach;
  } else {
    first = at.cables[pair.first];
    needed += bodies_.cable_radius[pair.first];
  }
  if (pair.kind == PairClass::kCablesCables) {
    second = at.cables[pair.second];
    needed += bodies_.cable_radius[pair.second];
  } else if (pair.kind == PairClass::kCablesPlatform) {
    second.fill(at.middles[pair.second]);
    needed += bodies_.platform[pair.second].reach;
  } else {
    const auto& body = std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]);
    const bool is_segment = body.points.size() == 2;
    second = is_segment ? Line{body.points[0], body.points[1]} : Line{body.centre, body.centre};
    needed += body.reach;
  }
  Point along = between_segments(first, second);
  const double lost = ((first[1] - first[0]).norm() + (second[1] - second[0]).norm()) / (2 * Direction::kCoarse);
  const double gap = along.norm() - needed - lost;
  const bool in_platform = is_best_in_platform(pair);
  if (in_platform) along = at.r_WP.transpose() * along;
  return {rounded_direction(along, in_platform, Direction::kCoarse), gap};
}

Direction BodySampler::rough_direction(const Model<double>& model, const RigidPose& pose, std::size_t n) const {
  return rough_direction(sketch(model, pose), n).direction;
}

PairDirections BodySampler::first_directions(const Model<double>& model, const RigidPose& middle,
                                             const std::array<RigidPose, 2>& ends) const {
  const Sketch at = sketch(model, middle);
  double moved = 0;
  for (const RigidPose& end : ends) {
    moved = std::max(moved, (end.p - middle.p).norm() + end.q.angularDistance(middle.q) * reach_);
  }
  PairDirections result;
  result.single.reserve(bodies_.pairs.size());
  for (std::size_t n = 0; n < bodies_.pairs.size(); ++n) {
    const RoughDirection rough = rough_direction(at, n);
    Direction chosen = rough.direction;
    const bool has_list = needs_list(n);
    if (!(rough.gap > moved) && !has_list && !is_of_half_space(chosen)) {
      chosen = direction(model, middle, n, Direction::kFine, ends).value_or(chosen);
    }
    result.single.push_back(chosen);
    if (has_list) result.lists[n] = {chosen};
  }
  return result;
}

PointPair BodySampler::nearest(const Model<double>& model, const RigidPose& pose, std::size_t pair) const {
  const Found found = find(model, pose, pair);
  return {rounded_shares(found.nearest.first), rounded_shares(found.nearest.second), found.elements, found.inside};
}

namespace {

using FourVertices = std::array<Vertex, 4>;

/// How far 0 is inside of a tetrahedron, negative where it is outside: the least of its heights over the faces. Where
/// that is the least, `outward` is the face's normal.
double depth(const FourVertices& v, Point& outward) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) {
    const Point& a = v[(k + 1) % 4].at;
    Point normal = (v[(k + 2) % 4].at - a).cross(v[(k + 3) % 4].at - a);
    const double size = normal.norm();
    const double towards = normal.dot(v[k].at - a);
    if (!(size > 0) || towards == 0) return -std::numeric_limits<double>::infinity();  // flat
    normal *= (towards > 0 ? -1 : 1) / size;
    const double height = normal.dot(a);
    if (height >= least) continue;
    least = height;
    outward = normal;
  }
  return least;
}

/// Vertices of the difference of two hulls with a ball about 0 of this radius well inside of their own hull, if such
/// are found: from four far ones, again and again one is replaced by the farthest beyond the face that is nearest to 0.
std::optional<FourVertices> around_zero(std::span<const Point> first, std::span<const Point> second, double radius) {
  constexpr int kMostSteps = 16;
  const auto beyond = [&](const Point& along) {
    const std::size_t i = farthest(first, along), j = farthest(second, -along);
    return Vertex{first[i] - second[j], i, j};
  };
  for (const double sign : {1.0, -1.0}) {
    FourVertices best{beyond(sign * Point(1, 1, 1)), beyond(sign * Point(1, -1, -1)), beyond(sign * Point(-1, 1, -1)),
                      beyond(sign * Point(-1, -1, 1))};
    Point outward(0, 0, 0);
    double deepest = depth(best, outward);
    for (int step = 0; step < kMostSteps && std::isfinite(deepest); ++step) {
      const Vertex next = beyond(outward);
      const FourVertices before = best;
      const double reached = deepest;
      for (std::size_t k = 0; k < 4; ++k) {
        FourVertices changed = before;
        changed[k] = next;
        Point normal(0, 0, 0);
        const double here = depth(changed, normal);
        if (!(here > deepest)) continue;
        deepest = here;
        best = changed;
        outward = normal;
      }
      if (!(deepest > reached)) break;
    }
    if (deepest > radius) return best;
  }
  return std::nullopt;
}

std::vector<std::int64_t> one_of(std::size_t size, std::size_t index) {
  std::vector<std::int64_t> shares(size, 0);
  shares[index] = PointPair::kWhole;
  return shares;
}

}  // namespace

std::optional<BodySampler::Touching> BodySampler::touching(const Model<double>& model, const RigidPose& pose,
                                                           std::size_t pair) const {
  const Found found = find(model, pose, pair);
  constexpr double kMeeting = 1e-9;  // of the distance of hulls that meet [m]
  if (found.nearest.distance > found.needed + kMeeting) return std::nullopt;
  Touching result{{rounded_shares(found.nearest.first), {}, found.elements}, {}};
  if (found.is_half_space) return result;
  result.nearest.second = rounded_shares(found.nearest.second);
  const auto& [first, second] = found.points;
  if (found.nearest.distance > kMeeting || first.size() * second.size() < 4) return result;
  if (const auto vertices = around_zero(first, second, std::max(0.0, -found.needed))) {
    auto& around = result.around.emplace();
    for (std::size_t k = 0; k < 4; ++k) {
      around[k] = {one_of(first.size(), (*vertices)[k].first), one_of(second.size(), (*vertices)[k].second)};
    }
  }
  return result;
}

namespace {

/// A gap that is not larger than that of a pair, from boxes around meshes. @pre it is not against a half-space
double gap_of_boxes(const BodyModel<double>& bodies, const Model<double>& model, const RigidPose& pose, std::size_t n) {
  const CheckedPair<double>& pair = bodies.pairs[n];
  const bool is_of_platform = pair.kind == PairClass::kPlatformObstacles;
  const bool is_against_platform = pair.kind == PairClass::kCablesPlatform;
  const ConvexBody<double>& second =
      is_against_platform ? bodies.platform[pair.second] : std::get<ConvexBody<double>>(bodies.obstacles[pair.second]);
  const std::vector<Point> of_first =
      is_of_platform ? carried(bodies.platform[pair.first], pose) : cable_ends(bodies, model, pose, pair.first);
  const std::vector<Point> of_second = is_against_platform ? carried(second, pose) : second.points;
  const double radii =
      (is_of_platform ? bodies.platform[pair.first].radius : bodies.cable_radius[pair.first]) + second.radius;
  return nearest_points(of_first, of_second).distance - radii - pair.clearance;
}

}  // namespace

/// How much of a pair's gap deviations take, from where on the bodies their nearest points are: as they
/// move them in the axes, the world's or the platform's, in which that is less.
double BodySampler::lost(const Model<double>& model, const RigidPose& pose, std::size_t n, const Found& found) const {
  if (!tolerances_) return 0;
  const Tolerances& of = *tolerances_;
  const CheckedPair<double>& pair = bodies_.pairs[n];
  if (pair.kind == PairClass::kPlatformObstacles) {
    const ConvexBody<double>& body = bodies_.platform[pair.first];
    const bool has_shares = body.mesh == nullptr && found.nearest.first.size() == body.points.size();
    Point nearest{0, 0, 0};
    for (std::size_t k = 0; has_shares && k < body.points.size(); ++k) {
      nearest += found.nearest.first[k] * body.points[k];
    }
    // What is nearest to it on the obstacle may be nearer to the platform's origin.
    return of.position + of.turn * std::max(0.0, nearest.norm() - std::abs(found.nearest.distance));
  }
  if (pair.kind == PairClass::kExitCones) {
    const bool is_at_platform = bodies_.exit_cones[pair.second].end == CableEnd::kPlatform;
    const double lever = is_at_platform ? (model.p_WA[pair.first] - pose.p).norm() : model.p_PB[pair.first].norm();
    return of.base[pair.first] + of.anchor[pair.first] + of.position + of.turn * lever;
  }
  std::array<double, 2> moved{0, 0};  // in W, in P
  const auto add_cable = [&](std::size_t i, const std::vector<double>& shares) {
    if (shares.size() != 2) return;
    const double base = pair.shares_base ? 0 : of.base[i], anchor = pair.shares_platform ? 0 : of.anchor[i];
    const double by_pose = of.position + of.turn * model.p_PB[i].norm();
    const double by_base_pose = of.position + of.turn * (model.p_WA[i] - pose.p).norm();
    moved[0] += shares[0] * base + shares[1] * (anchor + by_pose);
    moved[1] += shares[0] * (base + by_base_pose) + shares[1] * anchor;
  };
  add_cable(pair.first, found.nearest.first);
  if (pair.kind == PairClass::kCablesObstacles) return moved[0];
  if (pair.kind == PairClass::kCablesPlatform) return moved[1];
  add_cable(pair.second, found.nearest.second);
  return std::min(moved[0], moved[1]);
}

double BodySampler::room(const Model<double>& model, const RigidPose& pose, std::size_t pair) const {
  const Found found = find(model, pose, pair);
  return found.nearest.distance - found.needed - lost(model, pose, pair, found);
}

/// No less than lost() of any pair.
double BodySampler::most_lost(const Model<double>& model, const RigidPose& pose) const {
  if (!tolerances_) return 0;
  double far = reach_;
  for (const Point& a : model.p_WA) far = std::max(far, (a - pose.p).norm());
  return 2 * (std::ranges::max(tolerances_->base) + std::ranges::max(tolerances_->anchor) + tolerances_->position +
              tolerances_->turn * far);
}

bool BodySampler::is_clear(const Model<double>& model, const RigidPose& pose, Carried& carried) const {
  carried.pairs.resize(bodies_.pairs.size());
  const Sketch at = sketch(model, pose);
  const double most = most_lost(model, pose);
  for (std::size_t n = 0; n < bodies_.pairs.size(); ++n) {
    std::optional<Carried::Gap>& last = carried.pairs[n];
    const bool is_carried = bodies_.pairs[n].zones.empty() && bodies_.pairs[n].kind != PairClass::kExitCones;
    if (last && is_carried) {
      const double bodies_moving = bodies_.pairs[n].kind == PairClass::kCablesCables ? 2 : 1;
      const double moved =
          bodies_moving * ((pose.p - last->pose.p).norm() + pose.q.angularDistance(last->pose.q) * reach_);
      if (moved < last->gap) continue;
    }
    // Boxes around meshes, and balls around other bodies, may tell at once.
    double left = (needs_list(n) ? gap_of_boxes(bodies_, model, pose, n) : rough_direction(at, n).gap) - most;
    if (!(left > 0)) left = room(model, pose, n);
    last = {left, pose};
    if (!(last->gap > 0)) return false;
  }
  return true;
}

}  // namespace taut
