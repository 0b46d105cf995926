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
  Point at{0, 0, 0};
  std::size_t first = 0, second = 0;
};

std::size_t farthest(std::span<const Point> points, const Point& along) {
  std::size_t best = 0;
  double height = points[0].dot(along);
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double here = points[k].dot(along);
    if (here > height) {
      height = here;
      best = k;
    }
  }
  return best;
}

/// How far apart along a vector, times its length.
double gap_along(const Point& u, std::span<const Point> first, std::span<const Point> second) {
  double least = u.dot(first[0]), greatest = u.dot(second[0]);
  for (const Point& a : first.subspan(1)) least = std::min(least, u.dot(a));
  for (const Point& b : second.subspan(1)) greatest = std::max(greatest, u.dot(b));
  return least - greatest;
}

/// Up to four vertices, and the point of their hull that is nearest to the origin, as shares of them.
struct Simplex {
  std::array<Vertex, 4> vertices;
  std::size_t size = 0;
  std::array<double, 4> shares{};
  Point at{0, 0, 0};
  double squared = std::numeric_limits<double>::infinity();
};

/// Finds the nearest point of the hull, looking only at faces that have its last vertex: the least of
/// |last + Σ_k along_k edge_k| of each, by Gram's matrix and Cramer's rule. Where a determinant is next to nothing, a
/// lower face has the same points.
void find_nearest(Simplex& simplex) {
  constexpr double kFlat = 1e-14;  // of what it would be at right angles
  const std::size_t edges = simplex.size - 1;
  const Point& last = simplex.vertices[edges].at;
  std::array<Point, 3> edge;
  std::array<double, 3> h{};
  std::array<std::array<double, 3>, 3> g{};
  for (std::size_t i = 0; i < edges; ++i) {
    edge[i] = simplex.vertices[i].at - last;
    h[i] = -edge[i].dot(last);
    for (std::size_t j = 0; j <= i; ++j) g[i][j] = g[j][i] = edge[i].dot(edge[j]);
  }
  simplex.squared = last.squaredNorm();
  simplex.at = last;
  simplex.shares = {};
  simplex.shares[edges] = 1;
  const auto consider = [&](const std::array<double, 3>& along) {
    double rest = 1;
    Point at = last;
    for (std::size_t k = 0; k < edges; ++k) {
      if (!(along[k] >= 0)) return;
      rest -= along[k];
      at += along[k] * edge[k];
    }
    const double squared = at.squaredNorm();
    if (!(rest >= 0) || !(squared < simplex.squared)) return;
    simplex.squared = squared;
    simplex.at = at;
    for (std::size_t k = 0; k < edges; ++k) simplex.shares[k] = along[k];
    simplex.shares[edges] = rest;
  };
  for (std::size_t i = 0; i < edges; ++i) {
    std::array<double, 3> along{};
    if (g[i][i] > 0) along[i] = h[i] / g[i][i];
    consider(along);
    for (std::size_t j = 0; j < i; ++j) {
      const double determinant = g[i][i] * g[j][j] - g[i][j] * g[i][j];
      if (!(determinant > kFlat * g[i][i] * g[j][j])) continue;
      along = {};
      along[i] = (h[i] * g[j][j] - h[j] * g[i][j]) / determinant;
      along[j] = (h[j] * g[i][i] - h[i] * g[i][j]) / determinant;
      consider(along);
    }
  }
  if (edges < 3) return;
  const double volume = edge[0].dot(edge[1].cross(edge[2]));
  if (!(volume * volume > kFlat * g[0][0] * g[1][1] * g[2][2])) return;
  std::array<double, 3> along{};
  for (std::size_t k = 0; k < 3; ++k) along[k] = -last.dot(edge[(k + 1) % 3].cross(edge[(k + 2) % 3])) / volume;
  consider(along);
}

/// Shares of the nearest points of two segments, of their second ends.
std::array<double, 2> nearest_on_segments(std::span<const Point> first, std::span<const Point> second) {
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
  return {s, t};
}

/// Of two segments. @returns false, and nothing, where rounding spoils it
bool find_nearest_of_segments(std::span<const Point> first, std::span<const Point> second, NearestPoints& result) {
  constexpr double kExact = 1 - 1e-12;
  const auto [s, t] = nearest_on_segments(first, second);
  const Point apart = (first[0] + s * (first[1] - first[0])) - (second[0] + t * (second[1] - second[0]));
  const double squared = apart.squaredNorm();
  if (!(gap_along(apart, first, second) > kExact * squared)) return false;
  result.distance = std::sqrt(squared);
  result.apart = apart;
  result.first[0] = 1 - s;
  result.first[1] = s;
  result.second[0] = 1 - t;
  result.second[1] = t;
  return true;
}

}  // namespace

NearestPoints nearest_points(std::span<const Point> first, std::span<const Point> second) {
  constexpr int kMostSteps = 100;
  constexpr double kEnough = 1e-14;  // of the squared distance
  constexpr double kMeet = 1e-28;    // of the squared distance of two points: all that rounding leaves where hulls meet
  NearestPoints result;
  result.first.resize(first.size(), 0.0);
  result.second.resize(second.size(), 0.0);
  if (first.size() == 2 && second.size() == 2 && find_nearest_of_segments(first, second, result)) return result;
  Simplex nearest;
  nearest.vertices[nearest.size++] = {first[0] - second[0], 0, 0};
  find_nearest(nearest);
  for (int step = 0; step < kMostSteps; ++step) {
    const Point down = -nearest.at;
    const std::size_t i = farthest(first, down);
    const std::size_t j = farthest(second, nearest.at);
    const Vertex next{first[i] - second[j], i, j};
    Simplex closer;
    bool is_known = false;
    for (std::size_t k = 0; k < nearest.size; ++k) {
      const Vertex& v = nearest.vertices[k];
      is_known = is_known || (v.first == i && v.second == j);
      if (nearest.shares[k] > 0) closer.vertices[closer.size++] = v;
    }
    if (is_known || nearest.squared - next.at.dot(nearest.at) <= kEnough * nearest.squared) break;
    if (closer.size == 4) {  // the origin is inside
      nearest.squared = 0;
      nearest.at = Point::Zero();
      break;
    }
    closer.vertices[closer.size++] = next;
    find_nearest(closer);
    if (!(closer.squared < nearest.squared)) break;
    nearest = closer;
  }
  double largest = 0;
  for (std::size_t k = 0; k < nearest.size; ++k) {
    largest = std::max(largest, nearest.vertices[k].at.squaredNorm());
  }
  if (nearest.squared <= kMeet * largest) {
    nearest.squared = 0;
    nearest.at = Point::Zero();
  }
  result.distance = std::sqrt(nearest.squared);
  result.apart = nearest.at;
  for (std::size_t k = 0; k < nearest.size; ++k) {
    result.first[nearest.vertices[k].first] += nearest.shares[k];
    result.second[nearest.vertices[k].second] += nearest.shares[k];
  }
  return result;
}

// ---- Overlap --------------------------------------------------------------------------------------------------------

Overlap overlap(std::span<const Point> first, std::span<const Point> second) {
  constexpr int kDirections = 600;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Overlap> tried;
  const auto consider = [&](const Point& u) { tried.push_back({-gap_along(u, first, second), u}); };
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
      const double depth = -gap_along(u, first, second);
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

/// Two points, of which one may be the other.
using Line = std::array<Point, 2>;

/// The two ends of the checked part of a cable from a to b.
Line cable_ends(const BodyModel<double>& bodies, const Point& a, const Point& b, std::size_t i) {
  const Point along = (b - a).normalized();
  return {a + bodies.cable_free[i][0] * along, b - bodies.cable_free[i][1] * along};
}

/// The same at a pose, in W.
Points cable_ends(const BodyModel<double>& bodies, const Model<double>& model, const RigidPose& pose, std::size_t i) {
  const Line ends = cable_ends(bodies, model.p_WA[i], pose.p + pose.q.toRotationMatrix() * model.p_PB[i], i);
  return {ends[0], ends[1]};
}

double distance_in_cone(const BodyModel<double>& bodies, const Model<double>& model, const RigidPose& pose,
                        const CheckedPair<double>& pair) {
  const ExitCone<double>& cone = bodies.exit_cones[pair.second];
  Point d = pose.p + pose.q * model.p_PB[pair.first] - model.p_WA[pair.first];
  if (cone.end == CableEnd::kPlatform) d = -(pose.q.conjugate() * d);
  return taut::distance_in_cone<double>(cone, {d(0), d(1), d(2)});
}

Points carried(const ConvexBody<double>& body, const RigidPose& pose) {
  const Matrix3<double> r = pose.q.toRotationMatrix();
  Points points;
  for (const Point& x : body.points) points.emplace_back(pose.p + r * x);
  return points;
}

/// As multiples of 1/kWhole that sum to kWhole.
std::vector<std::int64_t> rounded_shares(std::span<const double> shares) {
  std::vector<std::int64_t> result;
  if (shares.empty()) return result;
  for (const double share : shares) {
    result.push_back(std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(PointPair::kWhole)));
  }
  const std::int64_t sum = std::accumulate(result.begin(), result.end(), std::int64_t{0});
  *std::ranges::max_element(result) += PointPair::kWhole - sum;
  return result;
}

/// std::gcd of two numbers that are not negative. Those up to Direction::kCoarse, and those up to kFine with it, a
/// prime, are asked for again and again.
int common_divisor(int a, int b) {
  if (a == 1) return 1;
  if (a == Direction::kFine && b <= a) return b == 0 || b == a ? a : 1;
  constexpr std::size_t kSize = Direction::kCoarse + 1;
  static constexpr auto kTable = [] {
    std::array<std::array<std::int8_t, kSize>, kSize> table{};
    for (std::size_t i = 0; i < kSize; ++i) {
      for (std::size_t j = 0; j < kSize; ++j) table[i][j] = static_cast<std::int8_t>(std::gcd(i, j));
    }
    return table;
  }();
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return i < kSize && j < kSize ? kTable[i][j] : std::gcd(a, b);
}

/// @returns one along z where `along` has no direction.
Direction rounded_direction(const Point& along, bool in_platform, int largest) {
  constexpr double kLeast = 1e-290;  // so that nothing overflows
  const double size = along.cwiseAbs().maxCoeff();
  if (!along.allFinite() || !(size > kLeast)) return {in_platform, {0, 0, 1}};
  const Point scaled = along * (largest / size);
  Direction result{in_platform, {}};
  int divisor = largest;  // so large is one of them, or its opposite
  for (int k = 0; k < 3; ++k) {
    const int x = static_cast<int>(scaled(k) + std::copysign(0.5, scaled(k)));
    result.u[static_cast<std::size_t>(k)] = x;
    divisor = common_divisor(divisor, std::abs(x));
  }
  if (divisor == 1) return result;
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
  std::array<std::optional<std::uint32_t>, 2> elements = {};  ///< of meshes
  std::optional<std::size_t> inside = {};                     ///< as in PointPair; then the distance is negative
};

const HalfSpace<double>* BodySampler::half_space(const CheckedPair<double>& pair) const {
  const bool is_of_obstacle = pair.kind == PairClass::kPlatformObstacles || pair.kind == PairClass::kCablesObstacles;
  return is_of_obstacle ? std::get_if<HalfSpace<double>>(&bodies_.obstacles[pair.second]) : nullptr;
}

bool BodySampler::has_own_direction(std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  return half_space(pair) != nullptr || pair.kind == PairClass::kExitCones;
}

bool BodySampler::needs_list(std::size_t n) const { return bodies_.pairs.at(n).has_mesh && !has_own_direction(n); }

namespace {

/// A body that stands still, or one that the platform carries.
BodyInFrame in_frame(const ConvexBody<double>& body, const RigidPose* pose) {
  BodyInFrame result;
  if (body.mesh == nullptr) {
    result.points = pose != nullptr ? carried(body, *pose) : Points(body.points.begin(), body.points.end());
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
  found.needed = required_distance(pair, pose.p).at_most + pair.radii;
  if (const auto* half = half_space(pair)) {
    const Point normal = half->normal.normalized();
    Points points = bodies[0].points;
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
  if (bodies[0].mesh == nullptr && bodies[1].mesh == nullptr) {
    found.nearest = nearest_points(bodies[0].points, bodies[1].points);
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

/// Whether a body of the platform and an obstacle stay farther apart along a vector of P than along the same of W.
bool BodySampler::is_better_in_platform(const CheckedPair<double>& pair, const Point& along, const RigidPose& pose,
                                        std::span<const RigidPose> around) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Point u = along.normalized();
  const Point v = pose.q.toRotationMatrix().transpose() * u;
  const std::vector<Point>& obstacle = std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]).points;
  double of_world = kInfinity, of_platform = kInfinity;
  for (const RigidPose& there : around) {
    const Points body = carried(bodies_.platform[pair.first], there);
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
  const double needed = pair.clearance + pair.radii;
  const bool in_platform = is_best_in_platform(pair);
  for (Point along : covering_directions(bodies[0], bodies[1], needed, share)) {
    if (in_platform) along = pose.q.toRotationMatrix().transpose() * along;
    const Direction rounded = rounded_direction(along, in_platform, largest);
    if (std::ranges::find(result, rounded) == result.end()) result.push_back(rounded);
  }
  return result;
}

namespace {

/// Between the nearest points of two segments, from the second to the first.
Point between_segments(const Line& first, const Line& second) {
  const auto [s, t] = nearest_on_segments(first, second);
  return (first[0] + s * (first[1] - first[0])) - (second[0] + t * (second[1] - second[0]));
}

/// All between two corners.
struct AlignedBox {
  Point lowest, highest;
};

AlignedBox box_around(const Line& line) { return {line[0].cwiseMin(line[1]), line[0].cwiseMax(line[1])}; }

/// The shortest one, from the second to the first; 0 if they meet.
Point between_boxes(const AlignedBox& first, const AlignedBox& second) {
  const Point zero(0, 0, 0);
  return (first.lowest - second.highest).cwiseMax(zero) - (second.lowest - first.highest).cwiseMax(zero);
}

}  // namespace

/// Where the platform is, the checked parts of cables, and the middles of bodies and boxes around them, in W.
struct BodySampler::Sketch {
  struct Body {
    Point middle;
    AlignedBox box;
  };
  Point p_WP;
  Matrix3<double> r_WP;
  std::array<Line, kCables> cables;
  FewOf<Body> bodies;  ///< the platform's
};

BodySampler::Sketch BodySampler::sketch(const Model<double>& model, const RigidPose& pose) const {
  Sketch result{pose.p, pose.q.toRotationMatrix(), {}, {}};
  for (std::size_t i = 0; i < kCables; ++i) {
    result.cables[i] = cable_ends(bodies_, model.p_WA[i], pose.p + result.r_WP * model.p_PB[i], i);
  }
  for (const ConvexBody<double>& body : bodies_.platform) {
    const Point middle = pose.p + result.r_WP * (0.5 * (body.lowest + body.highest));
    const Point half = result.r_WP.cwiseAbs() * (0.5 * (body.highest - body.lowest));
    result.bodies.push_back({pose.p + result.r_WP * body.centre, {middle - half, middle + half}});
  }
  return result;
}

/// Between about the nearest points of a pair, from the second to the first, in W. @pre no half-space, no exit cone
BodySampler::RoughGap BodySampler::rough_gap(const Sketch& at, std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  const RoughGap of_boxes = gap_of_aligned_boxes(at, n);
  if (pair.kind == PairClass::kPlatformObstacles && of_boxes.gap > 0) return of_boxes;
  const RoughGap of_balls = gap_of_balls(at, n);
  return of_boxes.gap > of_balls.gap ? of_boxes : of_balls;
}

BodySampler::RoughGap BodySampler::gap_of_aligned_boxes(const Sketch& at, std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  if (pair.kind == PairClass::kCablesCables) return {};
  const bool is_of_platform = pair.kind == PairClass::kPlatformObstacles;
  const AlignedBox first = is_of_platform ? at.bodies[pair.first].box : box_around(at.cables[pair.first]);
  AlignedBox second;
  if (pair.kind == PairClass::kCablesPlatform) {
    second = at.bodies[pair.second].box;
  } else {
    const auto& body = std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]);
    second = {body.lowest, body.highest};
  }
  const Point apart = between_boxes(first, second);
  // Nothing is rounded along an axis of W.
  const bool is_exact = (apart.array() != 0).count() == 1 && !is_best_in_platform(pair);
  const double size = (first.highest - first.lowest + second.highest - second.lowest).lpNorm<1>();
  return {apart, apart.norm() - pair.radii - pair.clearance, is_exact ? 0 : size / (2 * Direction::kCoarse)};
}

BodySampler::RoughGap BodySampler::gap_of_balls(const Sketch& at, std::size_t n) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  Line first, second;
  double needed = pair.clearance;
  if (pair.kind == PairClass::kPlatformObstacles) {
    first.fill(at.bodies[pair.first].middle);
    needed += bodies_.platform[pair.first].reach;
  } else {
    first = at.cables[pair.first];
    needed += bodies_.cable_radius[pair.first];
  }
  if (pair.kind == PairClass::kCablesCables) {
    second = at.cables[pair.second];
    needed += bodies_.cable_radius[pair.second];
  } else if (pair.kind == PairClass::kCablesPlatform) {
    second.fill(at.bodies[pair.second].middle);
    needed += bodies_.platform[pair.second].reach;
  } else {
    const auto& body = std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]);
    const bool is_segment = body.points.size() == 2;
    second = is_segment ? Line{body.points[0], body.points[1]} : Line{body.centre, body.centre};
    needed += is_segment ? body.radius : body.reach;
  }
  const Point apart = between_segments(first, second);
  const double size = (first[1] - first[0]).lpNorm<1>() + (second[1] - second[0]).lpNorm<1>();
  return {apart, apart.norm() - needed, size / (2 * Direction::kCoarse)};
}

Direction BodySampler::rough_direction(const Sketch& at, std::size_t n, const Point& apart, int largest) const {
  const bool in_platform = is_best_in_platform(bodies_.pairs.at(n));
  return rounded_direction(in_platform ? Point(at.r_WP.transpose() * apart) : apart, in_platform, largest);
}

Direction BodySampler::rough_direction(const Model<double>& model, const RigidPose& pose, std::size_t n) const {
  const Sketch at = sketch(model, pose);
  return has_own_direction(n) ? Direction{} : rough_direction(at, n, rough_gap(at, n).apart);
}

/// How much farther than its clearance a pair is apart along a direction. @pre no half-space, exit cone or mesh
double BodySampler::clear_along(const Sketch& at, std::size_t n, const Direction& direction) const {
  const CheckedPair<double>& pair = bodies_.pairs.at(n);
  Point u(direction.u[0], direction.u[1], direction.u[2]);
  u.normalize();
  if (direction.in_platform) u = at.r_WP * u;
  const Point u_P = at.r_WP.transpose() * u;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto least = [](std::span<const Point> points, const Point& along) {
    double result = kInfinity;
    for (const Point& x : points) result = std::min(result, along.dot(x));
    return result;
  };
  const double first = pair.kind == PairClass::kPlatformObstacles
                           ? u.dot(at.p_WP) + least(bodies_.platform[pair.first].points, u_P)
                           : least(at.cables[pair.first], u);
  double beyond = 0;  // least of the second, along −u
  switch (pair.kind) {
    case PairClass::kCablesCables: beyond = least(at.cables[pair.second], -u); break;
    case PairClass::kCablesPlatform: beyond = least(bodies_.platform[pair.second].points, -u_P) - u.dot(at.p_WP); break;
    default: beyond = least(std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]).points, -u);
  }
  return first + beyond - pair.radii - pair.clearance;
}

PairDirections BodySampler::first_directions(const Model<double>& model, const RigidPose& middle,
                                             const std::array<RigidPose, 2>& ends) const {
  constexpr int kMostSharpened = 3;
  const Sketch at_middle = sketch(model, middle);
  std::optional<std::array<Sketch, 2>> at_ends;  // where all are far apart they are not asked for
  const double most = most_lost(model, middle);
  double moved = 0;
  for (const RigidPose& end : ends) {
    moved = std::max(moved, (end.p - middle.p).norm() + end.q.angularDistance(middle.q) * reach_);
  }
  PairDirections result;
  result.single.reserve(bodies_.pairs.size());
  std::vector<double> gaps(bodies_.pairs.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> is_sharp(bodies_.pairs.size());
  const auto choose = [&](std::size_t n, const Direction& direction) {
    if (!at_ends) at_ends = {sketch(model, ends[0]), sketch(model, ends[1])};
    result.single[n] = direction;
    gaps[n] = std::min(clear_along((*at_ends)[0], n, direction), clear_along((*at_ends)[1], n, direction));
  };
  const auto sharpen = [&](std::size_t n) {
    is_sharp[n] = true;
    if (const auto sharp = sharp_direction(model, at_middle, middle, ends, n)) choose(n, *sharp);
  };
  for (std::size_t n = 0; n < bodies_.pairs.size(); ++n) {
    Direction& chosen = result.single.emplace_back();
    if (has_own_direction(n)) continue;
    const RoughGap rough = rough_gap(at_middle, n);
    chosen = rough_direction(at_middle, n, rough.apart);
    gaps[n] = rough.gap - rough.lost - moved;
    if (needs_list(n)) {
      result.lists[n] = {chosen};
    } else if (!(gaps[n] > most)) {
      choose(n, chosen);
      if (!(gaps[n] > most)) sharpen(n);
    }
  }
  // The least of all gaps is what a proof can claim.
  for (int time = 0; time < kMostSharpened && !gaps.empty(); ++time) {
    const auto n = static_cast<std::size_t>(std::ranges::min_element(gaps) - gaps.begin());
    if (is_sharp[n] || needs_list(n) || !std::isfinite(gaps[n])) break;
    sharpen(n);
  }
  return result;
}

void BodySampler::set_rough_directions(const Model<double>& model, const RigidPose& pose,
                                       std::span<const std::size_t> pairs, PairDirections& directions) const {
  const Sketch at = sketch(model, pose);
  directions.single.resize(bodies_.pairs.size());
  for (const std::size_t n : pairs) {
    if (!has_own_direction(n)) directions.single[n] = rough_direction(at, n, rough_gap(at, n).apart);
    if (needs_list(n)) directions.lists[n] = {directions.single[n]};
  }
}

double BodySampler::set_sharp_directions(const Model<double>& model, const RigidPose& pose,
                                         const std::array<RigidPose, 2>& ends, std::span<const std::size_t> pairs,
                                         PairDirections& directions) const {
  const Sketch at = sketch(model, pose);
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t n : pairs) {
    if (has_own_direction(n) || needs_list(n)) continue;
    if (const auto sharp = sharp_direction(model, at, pose, ends, n)) directions.single[n] = *sharp;
    least = std::min(least, clear_along(at, n, directions.single[n]));
  }
  return least;
}

std::optional<Direction> BodySampler::sharp_direction(const Model<double>& model, const Sketch& at,
                                                      const RigidPose& pose, const std::array<RigidPose, 2>& ends,
                                                      std::size_t n) const {
  if (bodies_.pairs[n].kind != PairClass::kCablesCables) return direction(model, pose, n, Direction::kFine, ends);
  const Point apart = rough_gap(at, n).apart;  // of two segments that is where they are nearest
  if (!(apart.squaredNorm() > 0)) return std::nullopt;
  return rough_direction(at, n, apart, Direction::kFine);
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
  if (found.nearest.distance > kMeeting || needs_list(pair)) return result;
  const std::array<BodyInFrame, 2> bodies = in_world(model, pose, pair);
  const Points &first = bodies[0].points, &second = bodies[1].points;
  if (first.size() * second.size() < 4) return result;
  if (const auto vertices = around_zero(first, second, std::max(0.0, -found.needed))) {
    auto& around = result.around.emplace();
    for (std::size_t k = 0; k < 4; ++k) {
      around[k] = {one_of(first.size(), (*vertices)[k].first), one_of(second.size(), (*vertices)[k].second)};
    }
  }
  return result;
}

std::vector<PairContact> BodySampler::contacts(const Model<double>& model, const RigidPose& pose,
                                               std::size_t pair) const {
  std::vector<PairContact> result{{pair, nearest(model, pose, pair)}};
  if (has_own_direction(pair) || result.front().points.inside) return result;
  if (const auto found = touching(model, pose, pair); found && found->around) {
    result.push_back({pair, {}, found->around});
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
  const Points of_first =
      is_of_platform ? carried(bodies.platform[pair.first], pose) : cable_ends(bodies, model, pose, pair.first);
  const Points of_second =
      is_against_platform ? carried(second, pose) : Points(second.points.begin(), second.points.end());
  return nearest_points(of_first, of_second).distance - pair.radii - pair.clearance;
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
  const auto add_cable = [&](std::size_t i, std::span<const double> shares) {
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

/// A gap that is not larger than that of a pair with a mesh, unless it is `enough`.
double BodySampler::rough_gap_of_mesh(const Model<double>& model, const RigidPose& pose, std::size_t n,
                                      double enough) const {
  const CheckedPair<double>& pair = bodies_.pairs[n];
  const std::array<BodyInFrame, 2> bodies = in_world(model, pose, n);
  const double needed = pair.radii + pair.clearance;
  const double gap = distance_bound(bodies[0], bodies[1], needed + enough) - needed;
  return gap > 0 && point_inside(bodies[0], bodies[1]) ? -gap : gap;
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
    const bool is_carried = bodies_.pairs[n].zones.empty() && bodies_.pairs[n].kind != PairClass::kExitCones;
    const double bodies_moving = bodies_.pairs[n].kind == PairClass::kCablesCables ? 2 : 1;
    const auto is_near = [&](const Carried::Gap& known) {
      const double shifted = bodies_moving * (pose.p - known.pose.p).norm();
      return shifted < known.gap && shifted + bodies_moving * pose.q.angularDistance(known.pose.q) * reach_ < known.gap;
    };
    if (is_carried && std::ranges::any_of(carried.pairs[n], is_near)) continue;
    // Boxes around meshes, and balls around other bodies, may tell at once; else that a mesh is far enough.
    double left = 0;
    if (needs_list(n)) {
      left = gap_of_boxes(bodies_, model, pose, n) - most;
      if (!(left > 0)) left = rough_gap_of_mesh(model, pose, n, most) - most;
    } else if (!has_own_direction(n)) {
      left = rough_gap(at, n).gap - most;
    }
    if (!(left > 0)) left = room(model, pose, n);
    if (!(left > 0)) return false;
    if (is_carried) carried.pairs[n].push_back({left, pose});
  }
  return true;
}

}  // namespace taut
