// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "certificate/elaborate.h"
#include "certify/arithmetic/rounding.h"
#include "certify/bodies/body_gaps.h"
#include "certify/bodies/nearest.h"
#include "certify/clear_run.h"
#include "certify/path_proof.h"
#include "certify/prover.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::at;
using Point = Vector3<double>;

// ---- Distances of boxes, segments and points by another route: the least over all pairs of features ----------------

using Triangle = std::array<Point, 3>;

/// From a point to a triangle: to its plane, where the foot is inside, else to its edges.
double distance_to_segment(const Point& x, const Point& a, const Point& b) {
  const Point along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((x - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (x - a - t * along).norm();
}

double distance_to_triangle(const Point& x, const Triangle& t) {
  const Point normal = (t[1] - t[0]).cross(t[2] - t[0]);
  double least = std::numeric_limits<double>::infinity();
  bool inside = normal.norm() > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point& a = t[k];
    const Point& b = t[(k + 1) % 3];
    least = std::min(least, distance_to_segment(x, a, b));
    inside = inside && (b - a).cross(x - a).dot(normal) >= 0;
  }
  return inside ? std::min(least, std::abs((x - t[0]).dot(normal.normalized()))) : least;
}

double distance_of_segments(const Point& a, const Point& b, const Point& c, const Point& d) {
  double least = std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d), distance_to_segment(c, a, b),
                           distance_to_segment(d, a, b)});
  const Point u = b - a, v = d - c, n = u.cross(v);
  if (n.squaredNorm() <= 1e-24 * u.squaredNorm() * v.squaredNorm()) return least;
  const Point w = c - a;
  const double s = w.cross(v).dot(n) / n.squaredNorm(), t = w.cross(u).dot(n) / n.squaredNorm();
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, std::abs(w.dot(n.normalized())));
  return least;
}

/// A point, a segment, or a box's surface.
struct Features {
  std::vector<Point> points;
  std::vector<std::array<Point, 2>> edges;
  std::vector<Triangle> faces;
};

Features features(const std::vector<Point>& points) {
  Features result{points, {}, {}};
  if (points.size() == 2) result.edges.push_back({points[0], points[1]});
  if (points.size() == 8) {  // corner k has the signs of k's bits
    for (unsigned k = 0; k < 8; ++k) {
      for (const unsigned bit : {1U, 2U, 4U}) {
        if ((k & bit) == 0) result.edges.push_back({points[k], points[k | bit]});
      }
    }
    for (const auto& [fixed, u, v] : {std::array{1U, 2U, 4U}, std::array{2U, 1U, 4U}, std::array{4U, 1U, 2U}}) {
      for (const unsigned side : {0U, fixed}) {
        result.faces.push_back({points[side], points[side | u], points[side | u | v]});
        result.faces.push_back({points[side], points[side | v], points[side | u | v]});
      }
    }
  }
  return result;
}

/// Of two hulls that do not meet.
double distance_of_hulls(const std::vector<Point>& first, const std::vector<Point>& second) {
  const Features a = features(first), b = features(second);
  double least = std::numeric_limits<double>::infinity();
  for (const Point& x : a.points) {
    for (const Point& y : b.points) least = std::min(least, (x - y).norm());
    for (const auto& [y, z] : b.edges) least = std::min(least, distance_to_segment(x, y, z));
    for (const Triangle& t : b.faces) least = std::min(least, distance_to_triangle(x, t));
  }
  for (const Point& y : b.points) {
    for (const auto& [x, z] : a.edges) least = std::min(least, distance_to_segment(y, x, z));
    for (const Triangle& t : a.faces) least = std::min(least, distance_to_triangle(y, t));
  }
  for (const auto& [x, y] : a.edges) {
    for (const auto& [z, w] : b.edges) least = std::min(least, distance_of_segments(x, y, z, w));
  }
  return least;
}

// ---- A machine with bodies ------------------------------------------------------------------------------------------

std::string text(double x) { return fmt::format("{}", x); }

PointText text(const Point& x) { return {text(x(0)), text(x(1)), text(x(2))}; }

BodyText box_body(const std::string& name, const Point& size, const Point& place) {
  HullText hull;
  for (unsigned k = 0; k < 8; ++k) {
    const auto side = [&](unsigned bit, int axis) { return ((k & bit) != 0 ? 0.5 : -0.5) * size(axis); };
    hull.points_m.push_back(text(Point(side(1, 0), side(2, 1), side(4, 2))));
  }
  BodyText body{.name = name, .shape = hull};
  body.at_m = text(place);
  return body;
}

BodyText capsule(const std::string& name, const Point& from, const Point& to, double radius) {
  return {.name = name, .shape = HullText{{text(from), text(to)}, text(radius)}};
}

/// The crane of the design, without load items: six free coordinates.
Problem crane() {
  Problem problem = testing::free_flying(testing::robot1_slice());
  problem.query.clear();
  const std::array<Point, kCables> base{Point(15, 10, 15),  Point(15, 10, 15), Point(-15, 10, 15),
                                        Point(-15, 10, 15), Point(0, -10, 15), Point(0, -10, 15)};
  const std::array<Point, 3> corners{Point(0, 1.5, 0), Point(1.3, -0.75, 0), Point(-1.3, -0.75, 0)};
  const std::array<std::size_t, kCables> corner{0, 1, 0, 2, 1, 2};
  for (std::size_t i = 0; i < kCables; ++i) {
    problem.robot.base_anchors_m[i] = text(base[i]);
    problem.robot.platform_anchors_m[i] = text(corners[corner[i]]);
    problem.robot.tension_N[i] = {"2000", "160000"};
    problem.robot.length_m[i] = {"3", "35"};
  }
  problem.load = LoadText{};
  problem.load.point_m = {"0", "0", "-0.5"};
  problem.load.wrench = {"0", "0", "-150000", "0", "0", "0"};
  EllipsoidText e;
  for (std::size_t j = 0; j < 6; ++j) {
    for (std::size_t k = 0; k < 6; ++k) e[j][k] = j != k ? "0" : j < 3 ? "1e-6" : "1e-6";
  }
  problem.load.ellipsoid = e;
  BodiesText bodies;
  bodies.platform = {box_body("container", {2.4, 6.1, 2.6}, {0, 0, -2.2})};
  bodies.obstacles = {box_body("stack", {2.4, 6.1, 2.6}, {0, 1, 1.3}), capsule("post", {7, 5, 0}, {7, 5, 6}, 0.15)};
  bodies.obstacles[0].rotation_rad = {"0", "0", "(10)*pi/180"};
  BodyText floor{.name = "floor", .shape = HalfSpaceText{{"0", "0", "1"}}};
  bodies.obstacles.push_back(floor);
  bodies.cables.diameter_m.fill("0.028");
  bodies.cables.free_ends_m.fill({"0.5", "0.4"});
  bodies.clearance_m = {"0.2", "0.2", "0.02", "0.01"};
  bodies.exit_cones = {{0, CableEnd::kBase, {"-15", "-10", "-10"}, "1.2"},
                       {3, CableEnd::kPlatform, {"-1", "1", "1"}, "(70)*pi/180"}};
  problem.bodies = bodies;
  validate(problem);
  return problem;
}

Problem deviating_crane() {
  Problem problem = crane();
  problem.tolerances.emplace();
  problem.tolerances->base_anchor_m.fill("0.01");
  problem.tolerances->platform_anchor_m.fill("0.01");
  problem.tolerances->position_m = "0.05";
  problem.tolerances->orientation_rad = "0.3*pi/180";
  return problem;
}

/// Bodies in W at a pose, of one machine.
struct Placed {
  std::vector<Point> points;
  double radius = 0;
};

struct DeviatingMachine {
  Model<double> model;
  Point p;
  Matrix3<double> r;
};

std::vector<Point> in_world(const DeviatingMachine& machine, const ConvexBody<double>& body) {
  std::vector<Point> points;
  for (const Point& x : body.points) points.emplace_back(machine.p + machine.r * x);
  return points;
}

Placed cable(const DeviatingMachine& machine, const BodyModel<double>& bodies, std::size_t i) {
  const Point a = machine.model.p_WA[i], b = machine.p + machine.r * machine.model.p_PB[i];
  const Point u = (b - a).normalized();
  return {{a + bodies.cable_free[i][0] * u, b - bodies.cable_free[i][1] * u}, bodies.cable_radius[i]};
}

/// How much farther than its clearance a pair is apart.
double true_gap(const DeviatingMachine& machine, const BodyModel<double>& bodies, const CheckedPair<double>& pair) {
  if (pair.kind == PairClass::kExitCones) {
    const ExitCone<double>& cone = bodies.exit_cones[pair.second];
    Point d = machine.p + machine.r * machine.model.p_PB[pair.first] - machine.model.p_WA[pair.first];
    if (cone.end == CableEnd::kPlatform) d = -machine.r.transpose() * d;
    const double t = std::acos(std::clamp(d.normalized().dot(cone.axis), -1.0, 1.0));
    return d.norm() * std::sin(std::atan2(cone.sine, cone.cosine) - t);
  }
  const bool is_first_platform = pair.kind == PairClass::kPlatformObstacles;
  const Placed first = is_first_platform
                           ? Placed{in_world(machine, bodies.platform[pair.first]), bodies.platform[pair.first].radius}
                           : cable(machine, bodies, pair.first);
  Placed second;
  if (pair.kind == PairClass::kCablesCables) {
    second = cable(machine, bodies, pair.second);
  } else if (pair.kind == PairClass::kCablesPlatform) {
    second = {in_world(machine, bodies.platform[pair.second]), bodies.platform[pair.second].radius};
  } else if (const auto* half = std::get_if<HalfSpace<double>>(&bodies.obstacles[pair.second])) {
    double least = std::numeric_limits<double>::infinity();
    for (const Point& x : first.points) least = std::min(least, (half->normal.dot(x) - half->offset));
    return least / half->normal.norm() - first.radius - pair.clearance;
  } else {
    const auto& body = std::get<ConvexBody<double>>(bodies.obstacles[pair.second]);
    second = {body.points, body.radius};
  }
  return distance_of_hulls(first.points, second.points) - first.radius - second.radius - pair.clearance;
}

TEST(NearestPoints, AgreeWithTheLeastDistanceOfFeatures) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&](double size) {
    return Point(size * coordinate(random), size * coordinate(random), size * coordinate(random));
  };
  int apart = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto body = [&](std::size_t kind) {
      std::vector<Point> points;
      const Point centre = point(3), half = point(1).cwiseAbs();
      const Eigen::Quaterniond turn =
          Eigen::Quaterniond(coordinate(random), coordinate(random), coordinate(random), 1.5).normalized();
      if (kind == 0) return std::vector<Point>{centre};
      if (kind == 1) return std::vector<Point>{centre, centre + point(2)};
      for (unsigned k = 0; k < 8; ++k) {
        const Point corner((k & 1U) != 0 ? half(0) : -half(0), (k & 2U) != 0 ? half(1) : -half(1),
                           (k & 4U) != 0 ? half(2) : -half(2));
        points.emplace_back(centre + turn * corner);
      }
      return points;
    };
    const std::vector<Point> first = body(random() % 3), second = body(random() % 3);
    const NearestPoints found = nearest_points(first, second);
    const double truth = distance_of_hulls(first, second);
    if (found.distance < 1e-9) continue;  // the features' distance is of surfaces
    ++apart;
    EXPECT_NEAR(found.distance, truth, 1e-9) << trial;
    Point a = Point::Zero(), b = Point::Zero();
    for (std::size_t k = 0; k < first.size(); ++k) a += found.first[k] * first[k];
    for (std::size_t k = 0; k < second.size(); ++k) b += found.second[k] * second[k];
    EXPECT_NEAR((a - b).norm(), truth, 1e-9) << trial;
    EXPECT_NEAR((found.apart - (a - b)).norm(), 0, 1e-9) << trial;
  }
  EXPECT_GT(apart, 2000);
}

std::vector<double> random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return {8 * unit(random), 5 * unit(random),   6.5 + 3 * unit(random),
          3 * unit(random), 0.2 * unit(random), 0.3 * unit(random)};
}

/// A machine within the tolerances at s, anchors that are typed as one point staying one.
DeviatingMachine deviating(const Problem& problem, const PoseSampler& sampler, const Segment& segment, double s,
                           std::mt19937& random, bool deviates) {
  const RigidPose pose = sampler.rigid_pose(segment, s);
  DeviatingMachine machine{sampler.model(), pose.p, pose.q.toRotationMatrix()};
  if (!deviates) return machine;
  std::normal_distribution<double> normal;
  const auto on_ball = [&](double radius) {
    return Point(Point(normal(random), normal(random), normal(random)).normalized() * radius);
  };
  const auto number = [](const std::string& x) { return ScalarTraits<double>::from_decimal(x); };
  const TolerancesText& t = *problem.tolerances;
  // Anchors that are typed as one point move as one.
  const auto move = [&](std::array<Point, kCables>& anchors, const std::array<DecimalText, kCables>& tolerances) {
    const std::array<Point, kCables> typed = anchors;
    for (std::size_t i = 0; i < kCables; ++i) {
      const auto one = static_cast<std::size_t>(std::ranges::find(typed, typed[i]) - typed.begin());
      anchors[i] = one < i ? anchors[one] : Point(typed[i] + on_ball(number(tolerances[i])));
    }
  };
  move(machine.model.p_WA, t.base_anchor_m);
  move(machine.model.p_PB, t.platform_anchor_m);
  machine.p += on_ball(number(t.position_m));
  machine.r =
      Eigen::AngleAxisd(evaluate_constant<double>(t.orientation_rad), on_ball(1)).toRotationMatrix() * machine.r;
  return machine;
}

void expect_bounds(const Problem& problem, bool deviates, unsigned seed) {
  const Prover prover(problem);
  const BodyModel<double>& bodies = prover.bodies()->bodies();
  std::mt19937 random(seed);
  int bounds = 0, positive = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < 60; ++trial) {
    const std::vector<double> from = random_pose(random);
    std::vector<double> to = from;
    const double size = std::pow(10.0, -static_cast<double>(trial % 4));
    for (double& x : to) x += size * std::uniform_real_distribution<double>(-0.3, 0.3)(random);
    const Waypoint begin = at(from), end = at(to);  // which the segment refers to
    const Segment segment = prover.segment(begin, end);
    PairDirections directions;
    const RigidPose middle = prover.sampler().rigid_pose(segment, 0.5);
    for (std::size_t n = 0; n < bodies.pairs.size(); ++n) {
      const auto direction = prover.bodies()->direction(prover.sampler().model(), middle, n);
      directions.single.push_back(
          direction.value_or(Direction{bodies.pairs[n].kind == PairClass::kCablesPlatform, {1, 2, 3}}));
    }
    const BoxEnclosure<MpInterval> enclosure = enclose_box(prover.ladder().multiprecision(1), segment, DyadicBox{}, 4);
    if (!enclosure.pose || (deviates && !enclosure.disturbance)) continue;
    const PrecisionScope precision(128);
    const ProofModel<MpInterval>& model = prover.ladder().multiprecision(1);
    const BodiesBox<MpInterval> box{*model.bodies,
                                    model.model,
                                    enclosure.pose->p_WP,
                                    enclosure.pose->r_WP,
                                    enclosure.length,
                                    enclosure.offset,
                                    deviates ? &*model.tolerance : nullptr,
                                    deviates ? &*enclosure.disturbance : nullptr};
    const BodyGaps<MpInterval> gaps(box);
    ASSERT_TRUE(gaps.have_cables_length());
    std::vector<double> lower, rough;
    for (std::size_t n = 0; n < directions.single.size(); ++n) {
      lower.push_back(lower_bound(gaps.along(model.bodies->pairs[n], directions.single[n]).disturbed));
      rough.push_back(gaps.rough(model.bodies->pairs[n], directions.single[n]));
    }
    for (int sample = 0; sample < 12; ++sample) {
      const double s = sample / 11.0;
      const DeviatingMachine machine = deviating(problem, prover.sampler(), segment, s, random, deviates);
      for (std::size_t n = 0; n < directions.single.size(); ++n) {
        const double truth = true_gap(machine, bodies, bodies.pairs[n]);
        ++bounds;
        if (lower[n] > 0) ++positive;
        EXPECT_LE(rough[n], truth + 1e-9) << trial << ", pair " << n << ", s = " << s;
        EXPECT_LE(lower[n], truth + 1e-9) << trial << ", pair " << n << ", s = " << s;
        if (size < 0.01 && lower[n] > 0) nearest = std::min(nearest, truth - lower[n]);
      }
    }
  }
  EXPECT_GT(bounds, 5000);
  EXPECT_GT(positive, bounds / 2);
  if (!deviates) {
    EXPECT_LT(nearest, 1e-3) << "the bounds are vacuous";
  }
}

TEST(BodyGaps, AreNoLargerThanTheGapsOfPosesAlongTheSegment) { expect_bounds(crane(), false, 2); }

TEST(BodyGaps, AreNoLargerThanTheGapsOfDeviatingMachines) { expect_bounds(deviating_crane(), true, 3); }

// ---- Boxes of poses -------------------------------------------------------------------------------------------------

/// A pose between some of a path, moved and turned by up to as much as a box around them is wider.
DeviatingMachine some_machine(const Problem& problem, const std::vector<RigidPose>& poses, std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const std::size_t k = random() % (poses.size() - 1);
  const double s = uniform(-0.5, 1.5);
  const RigidPose &a = poses[k], &b = poses[k + 1];
  return {make_model<double>(problem), a.p + s * (b.p - a.p), a.q.slerp(s, b.q).toRotationMatrix()};
}

TEST(ClearPoses, AreClearAtAllPosesOfTheirBox) {
  const Problem problem = crane();
  const Prover prover(problem);
  const BodyModel<double> bodies = make_body_model<double>(problem);
  std::mt19937_64 random(5);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int known = 0, inside = 0, outside = 0, nested = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double size = std::pow(10.0, uniform(-3, 0));
    std::vector<RigidPose> poses;
    const Waypoint from = at({uniform(-2, 2), uniform(-2, 2), uniform(6, 7), 0, 0, uniform(-0.2, 0.2)});
    Waypoint to = from;
    for (double& x : to.parameters().x) x += uniform(-size, size);
    const Segment segment = Segment::straight(from, to);
    for (int k = 0; k <= 4; ++k) poses.push_back(prover.sampler().rigid_pose(segment, k / 4.0));
    const auto whole = prover.clear_poses(poses, nullptr, ClearPoses::Use::kSmaller);
    if (!whole) continue;
    const auto part = prover.clear_poses(std::span(poses).first(3), whole.get(), ClearPoses::Use::kProofs);
    if (part && part->others().size() < whole->others().size()) ++nested;
    for (const ClearPoses* clear : {whole.get(), part.get()}) {
      if (clear == nullptr) continue;
      EXPECT_GT(clear->least_gap(), 0);
      for (int sample = 0; sample < 10; ++sample) {
        const DeviatingMachine machine = some_machine(problem, poses, random);
        Vector3<SlopeForm<Interval>> p;
        Matrix3<SlopeForm<Interval>> r;
        for (int i = 0; i < 3; ++i) {
          p(i) = Interval(machine.p(i));
          for (int j = 0; j < 3; ++j) r(i, j) = Interval(machine.r(i, j));
        }
        if (!clear->contains(p, r)) {
          ++outside;
          continue;
        }
        ++inside;
        for (std::size_t n = 0; n < bodies.pairs.size(); ++n) {
          if (std::ranges::find(clear->others(), n) != clear->others().end()) continue;
          ++known;
          EXPECT_LE(clear->least_gap(), true_gap(machine, bodies, bodies.pairs[n]) + 1e-9) << trial << ", " << n;
        }
      }
    }
  }
  EXPECT_GT(known, 5000);
  EXPECT_GT(inside, 300);
  EXPECT_GT(outside, 20);
  EXPECT_GT(nested, 5);
}

TEST(ClearPoses, ChangeNoVerdict) {
  const Prover prover(crane());
  const Waypoint from = at({-2, 0, 6.5, 0, 0, 0});
  int proved = 0, others = 0;
  for (int k = 0; k < 40; ++k) {
    Waypoint to = from;
    to.parameters().x = {-2 + 0.03 * k, 0.015 * k, 6.5 - 0.02 * k, 0, 0, 0.003 * k};
    const Segment segment = Segment::straight(from, to);
    std::vector<RigidPose> poses;
    for (const double s : {0.0, 0.5, 1.0}) poses.push_back(prover.sampler().rigid_pose(segment, s));
    const auto clear = prover.clear_poses(poses, nullptr, ClearPoses::Use::kProofs);
    const SegmentProof with = prover.prove(segment, 0, {}, ProofAim::kDecide, clear.get());
    const SegmentProof without = prover.prove(segment);
    EXPECT_EQ(with.verdict, without.verdict) << k;
    ++(with.verdict == Verdict::kProved ? proved : others);
  }
  EXPECT_GT(proved, 5);
  EXPECT_GT(others, 5);
}

TEST(ClearRun, KnowsOfEachOfItsSegments) {
  const Prover prover(crane());
  const auto is_within = [](const ClearPoses& clear, const RigidPose& pose) {
    const Matrix3<double> turn = pose.q.toRotationMatrix();
    Vector3<SlopeForm<Interval>> p;
    Matrix3<SlopeForm<Interval>> r;
    for (int i = 0; i < 3; ++i) {
      p(i) = Interval(pose.p(i));
      for (int j = 0; j < 3; ++j) r(i, j) = Interval(turn(i, j));
    }
    return clear.contains(p, r);
  };
  int known = 0;
  for (const std::size_t segments : {1, 2, 3, 5, 7, 8, 15, 16, 17, 31, 32, 47, 63, 64, 100}) {
    std::vector<Waypoint> waypoints;
    for (std::size_t k = 0; k <= segments; ++k) {
      waypoints.push_back(at({-2 + 4.0 * static_cast<double>(k) / static_cast<double>(segments), 0, 7, 0, 0, 0}));
    }
    const std::size_t length = ClearRun::length(prover, segments);
    ASSERT_GE(length, std::min<std::size_t>(segments, 16));
    ASSERT_LE(length, 31);
    for (std::size_t begin = 0; begin < segments; begin += length) {
      const auto segment = [&](std::size_t k) {
        return Segment::straight(waypoints[begin + k], waypoints[begin + k + 1]);
      };
      const std::size_t count = std::min(length, segments - begin);
      ClearRun run(prover, segment, count);
      for (std::size_t k = count; k-- > 0;) {
        const ClearPoses* clear = run.at(k);
        if (clear == nullptr) continue;  // where steps are long, no pair is apart on all of it
        ++known;
        EXPECT_GT(count, 1);
        for (const double s : {0.0, 1.0}) {
          EXPECT_TRUE(is_within(*clear, prover.sampler().rigid_pose(segment(k), s))) << k << " of " << count;
        }
      }
    }
  }
  EXPECT_GT(known, 300);
}

// ---- Segments -------------------------------------------------------------------------------------------------------

TEST(Prover, ProvesAMoveBesideAnObstacleAndRefutesOneIntoIt) {
  Problem problem = crane();
  const Prover prover(problem);
  // The container's underside is 3.5 m below P, so that it passes 0.4 m above the stack, and then 0.1 m.
  const SegmentProof above = prover.prove(at({-4, 0, 6.5, 0, 0, 0}), at({4, 0, 6.5, 0, 0, 0}));
  ASSERT_EQ(above.verdict, Verdict::kProved) << above.reason;
  EXPECT_GT(above.clearance_m, 0);
  EXPECT_LT(above.clearance_m, 0.2);
  ASSERT_EQ(above.directions.size(), above.boxes.size());
  const SegmentProof low = prover.prove(at({-4, 0, 6.2, 0, 0, 0}), at({4, 0, 6.2, 0, 0, 0}));
  ASSERT_EQ(low.verdict, Verdict::kRefuted) << low.reason;
  ASSERT_TRUE(low.witness->contact);
  EXPECT_EQ(name(*problem.bodies, pairs(*problem.bodies)[low.witness->contact->pair]), "container / stack");
}

/// Two points of hulls that are not larger than themselves are never shown to be one.
TEST(Prover, RefutesHullsThatOverlapThoughNoClearanceIsAskedFor) {
  Problem problem = crane();
  problem.bodies->clearance_m = {"0", "0", {}, {}};
  problem.bodies->cables.diameter_m.fill("0");
  problem.bodies->exit_cones.clear();
  const auto refuted_pair = [&](const Waypoint& from, const Waypoint& to) -> std::string {
    const SegmentProof proof = Prover(problem).prove(from, to);
    if (proof.verdict != Verdict::kRefuted) return fmt::format("{}", proof.reason.text());
    if (!proof.witness->contact || !proof.witness->contact->around) return "without points around 0";
    return name(*problem.bodies, pairs(*problem.bodies)[proof.witness->contact->pair]);
  };
  EXPECT_EQ(refuted_pair(at({-4, 0, 5, 0, 0, 0}), at({4, 0, 5, 0, 0, 0})), "container / stack");
  EXPECT_EQ(refuted_pair(at({-4, 0, 5, 0.3, 0.1, 0.2}), at({4, 0, 5, 0.3, 0.1, 0.2})), "container / stack");
  EXPECT_EQ(refuted_pair(at({0, 0, 5, 0, 0, 0}), at({0.01, 0, 5, 0, 0, 0})), "container / stack");
  // Across the corner of one that is as thin as paper, and through a cable.
  problem.bodies->obstacles.resize(1);
  problem.bodies->obstacles[0] = box_body("sheet", {0.0001, 2, 2}, {-0.3, 0, 3});
  EXPECT_EQ(refuted_pair(at({-4, 0, 5, 0, 0, 0}), at({4, 0, 5, 0, 0, 0})), "container / sheet");
  problem.bodies->platform = {box_body("container", {2.4, 6.1, 2.6}, {0, 0, -2.2})};
  problem.bodies->obstacles[0] = box_body("sheet", {2, 2, 0.0001}, {7.5, 5.75, 10});
  EXPECT_EQ(refuted_pair(at({-1, 0, 5, 0, 0, 0}), at({1, 0, 5, 0, 0, 0})), "cable 1 / sheet");
}

TEST(Prover, DecidesAClearanceToAHundredthOfAMillimetre) {
  // Level, over the stack: 3.5 m below P and 2.6 m high, so the gap is pz - 6.1 m and nothing else is nearer.
  for (const auto& [height, expected] : {std::pair{6.30001, Verdict::kProved}, {6.29999, Verdict::kRefuted}}) {
    const SegmentProof proof = Prover(crane()).prove(at({-4, 0, height, 0, 0, 0}), at({4, 0, height, 0, 0, 0}));
    EXPECT_EQ(proof.verdict, expected) << height << ": " << proof.reason;
  }
}

/// The container, whose underside is 3.5 m below P, stands on the floor or on the stack, which is 2.6 m high.
TEST(Prover, LetsALoadLeaveWhatItStandsOn) {
  for (const bool on_stack : {false, true}) {
    const double ground = on_stack ? 6.1 : 3.5;
    const double x = on_stack ? 0 : -4;
    const auto standing = [&](const char* within, const char* depth, bool has_tolerances = false) {
      Problem problem = has_tolerances ? deviating_crane() : crane();
      const DecimalText where = on_stack ? "6.1" : "3.5";
      problem.bodies->contacts = {
          {{"container", on_stack ? "stack" : "floor"}, {{text(x), "0", where}, within, depth}}};
      validate(problem);
      return problem;
    };
    const auto lift_from = [&](double height) {
      Path path;
      path.waypoints = {at({x, 0, height, 0, 0, 0}), at({x, 0.5, ground + 1, 0, 0, 0})};
      return path;
    };
    const auto verdict = [&](double height, const char* within, const char* depth, bool has_tolerances = false) {
      return Prover(standing(within, depth, has_tolerances)).prove(lift_from(height).segment(0));
    };
    const SegmentProof lifted = verdict(ground, "0.5", "0.005");
    EXPECT_EQ(lifted.verdict, Verdict::kProved) << lifted.reason;
    EXPECT_GT(lifted.clearance_m, 0);
    EXPECT_LE(lifted.clearance_m, 0.005);
    const Problem problem = standing("0.5", "0.005");
    const Certificate certificate =
        elaborate(problem, lift_from(ground), prove_path(Prover(problem), lift_from(ground)));
    EXPECT_NEAR(std::stod(certificate.margins.value().clearance_m.value()), 0.005, 1e-3);
    EXPECT_EQ(verdict(ground - 0.004, "0.5", "0.005").verdict, Verdict::kProved);
    EXPECT_NE(verdict(ground - 0.006, "0.5", "0.005").verdict, Verdict::kProved);
    if (!on_stack) {
      EXPECT_EQ(verdict(ground - 0.006, "0.5", "0.005").verdict, Verdict::kRefuted);
    }
    // 0.1 m off the place it is not 0.2 m off the ground yet.
    EXPECT_EQ(verdict(ground, "0.1", "0.005").verdict, Verdict::kRefuted);
    // Deviations move the container's corners by up to 79 mm, and the crane is held to 50 mm.
    EXPECT_EQ(verdict(ground, "0.6", "0.1", true).verdict, Verdict::kProved);
    EXPECT_NE(verdict(ground, "0.6", "0.04", true).verdict, Verdict::kProved);
  }
}

TEST(RequiredDistance, IsMinusTheGreatestDepthOfTheZonesThatHoldThePlace) {
  CheckedPair<double> pair{PairClass::kPlatformObstacles, 0, 0, 0.2};
  pair.zones = {{{1, 2, 3}, 0.5, 0.25}, {{1, 2, 4}, 0.75, 0.125}};
  const auto at = [&](double x, double y, double z) {
    const RequiredDistance<double> required = required_distance(pair, {x, y, z});
    EXPECT_EQ(required.at_most, required.at_least);
    return required.at_most;
  };
  EXPECT_EQ(at(1, 2, 3), -0.25);
  EXPECT_EQ(at(1, 2, 2.5), -0.25);  // the surface of a ball belongs to it
  EXPECT_EQ(at(1, 2, 2.49), 0.2);
  EXPECT_EQ(at(1, 2, 3.375), -0.25);  // in both
  EXPECT_EQ(at(1, 2, 4.75), -0.125);
  EXPECT_EQ(at(1, 2.76, 4), 0.2);
}

TEST(RequiredDistance, IsNeitherMoreNorLessThanItsBoundsSay) {
  (void)run_upward([] {  // NaN raises a fault
    CheckedPair<Interval> pair{PairClass::kPlatformObstacles, 0, 0, Interval(0.2)};
    pair.zones = {{{Interval(1.0), Interval(2.0), Interval(3.0)}, Interval(0.5), Interval(0.25)}};
    const auto at = [&](Interval z) { return required_distance(pair, {Interval(1.0), Interval(2.0), z}); };
    EXPECT_EQ(at(Interval(2.5, 3.5)).at_most.upper(), -0.25);
    EXPECT_EQ(at(Interval(2.4, 3.5)).at_most.upper(), 0.2);
    EXPECT_EQ(at(Interval(2.4, 3.5)).at_least.lower(), -0.25);
    EXPECT_EQ(at(Interval(3.5, 4.0)).at_least.lower(), -0.25);
    EXPECT_EQ(at(Interval(3.5625, 4.0)).at_least.lower(), 0.2);
    EXPECT_EQ(at(Interval(std::numeric_limits<double>::quiet_NaN())).at_most.upper(), 0.2);
    EXPECT_EQ(at(Interval(std::numeric_limits<double>::quiet_NaN())).at_least.lower(), -0.25);
  });
}

/// Cable 1 leaves its anchor at (15, 10, 15) for the platform's (0, 1.5, 0).
TEST(Prover, DecidesWhetherACableStaysInItsExitCone) {
  const Waypoint from = at({-4, 0, 6.5, 0, 0, 0}), to = at({4, 0, 6.5, 0, 0, 0});
  const Point n = Point(-15, -10, -10).normalized();
  double widest = 0;
  for (int k = 0; k <= 1000; ++k) {
    const Point d(-4 + 8 * k / 1000.0 - 15, 1.5 - 10, 6.5 - 15);
    widest = std::max(widest, std::acos(d.normalized().dot(n)));
  }
  for (const double more : {1e-5, -1e-5}) {
    Problem problem = crane();
    problem.bodies->exit_cones = {{0, CableEnd::kBase, {"-15", "-10", "-10"}, fmt::format("{:.12f}", widest + more)}};
    const SegmentProof proof = Prover(problem).prove(from, to);
    EXPECT_EQ(proof.verdict, more > 0 ? Verdict::kProved : Verdict::kRefuted) << proof.reason;
    if (more > 0 || !proof.witness || !proof.witness->contact) continue;
    EXPECT_EQ(name(*problem.bodies, pairs(*problem.bodies).at(proof.witness->contact->pair)),
              "cable 1 / exit cone at the base");
  }
}

/// A cable along the axis of its cone: what is across is 0 there, and has no derivative.
TEST(Prover, ProvesACableAlongTheAxisOfItsExitCone) {
  Problem problem = crane();
  problem.bodies->exit_cones = {{0, CableEnd::kBase, {"-15", "-8.5", "-8.5"}, "0.3"}};
  const SegmentProof proof = Prover(problem).prove(at({-1, 0, 6.5, 0, 0, 0}), at({1, 0, 6.5, 0, 0, 0}));
  EXPECT_EQ(proof.verdict, Verdict::kProved) << proof.reason;
}

TEST(Overlap, IsTheShortestWayOut) {
  std::mt19937_64 random(22);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int trial = 0; trial < 50; ++trial) {
    std::array<std::vector<Point>, 2> bodies;
    for (auto& points : bodies) {
      const Matrix3<double> r = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
      const Point half(uniform(0.2, 1), uniform(0.2, 1), uniform(0.2, 1));
      const Point middle(uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-0.3, 0.3));
      for (int k = 0; k < 8; ++k) {
        const Point corner((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
        points.emplace_back(middle + r * corner.cwiseProduct(half));
      }
    }
    const Overlap found = overlap(bodies[0], bodies[1]);
    ASSERT_GT(found.depth, 0);
    EXPECT_NEAR(found.along.norm(), 1, 1e-12);
    const auto distance_after = [&](const Point& way) {
      std::vector<Point> moved = bodies[0];
      for (Point& x : moved) x += way;
      return nearest_points(moved, bodies[1]).distance;
    };
    EXPECT_NEAR(distance_after(1.1 * found.depth * found.along), 0.1 * found.depth, 1e-9);
    for (int k = 0; k < 100; ++k) {  // and none that is shorter leads out
      const Point u = Point(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
      EXPECT_EQ(distance_after(0.99 * found.depth * u), 0);
    }
    EXPECT_EQ(distance_after(0.99 * found.depth * found.along), 0);
  }
}

TEST(Prover, LooksForNothingThatRefutesIfAProofIsAllThatIsWanted) {
  const Prover prover(crane());
  const auto verdict = [&](double height, ProofAim aim) {
    const SegmentProof proof =
        prover.prove(at({-4, 0, height, 0, 0, 0}), at({4, 0, height, 0, 0, 0}), 0, std::stop_token{}, aim);
    EXPECT_EQ(proof.witness.has_value(), proof.verdict == Verdict::kRefuted);
    return proof.verdict;
  };
  EXPECT_EQ(verdict(6.5, ProofAim::kProve), Verdict::kProved);
  EXPECT_EQ(verdict(6.2, ProofAim::kProve), Verdict::kUndecided);
  EXPECT_EQ(verdict(6.2, ProofAim::kDecide), Verdict::kRefuted);
}

// ---- Samples --------------------------------------------------------------------------------------------------------

/// Balls around bodies decide most pairs; they must not say more than distances do.
TEST(BodySampler, IsClearWhereAllPairsHaveRoom) {
  std::mt19937_64 random(21);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (const Problem& problem : {crane(), deviating_crane()}) {
    const PoseSampler sampler(problem);
    const BodySampler bodies(problem);
    int clear = 0, near = 0;
    for (int trial = 0; trial < 1500; ++trial) {
      const Waypoint here =
          at({uniform(-8, 8), uniform(-5, 5), uniform(3.5, 10), uniform(-3, 3), uniform(0, 0.5), uniform(-0.5, 0.5)});
      const RigidPose pose = sampler.rigid_pose(Segment::straight(here, here), 0);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t n = 0; n < bodies.bodies().pairs.size(); ++n) {
        const double room = bodies.room(sampler.model(), pose, n);
        const double gap = bodies.gap(sampler.model(), pose, n);
        EXPECT_LE(room, gap);
        if (!problem.tolerances) {
          EXPECT_EQ(room, gap);
        }
        least = std::min(least, room);
      }
      BodySampler::Carried carried;
      EXPECT_EQ(bodies.is_clear(sampler.model(), pose, carried), least > 0) << trial << ": " << least;
      ++(least > 0 ? clear : near);
    }
    EXPECT_GT(clear, 300);
    EXPECT_GT(near, 300);
  }
}

/// Level, 3.5 m above the container's underside: nothing but the stack below is near, and what has no room there can't
/// be proved.
TEST(BodySampler, HasRoomWhereDeviationsLeaveTheClearance) {
  Problem problem = crane();
  problem.tolerances.emplace();
  problem.tolerances->position_m = "0.05";
  const Prover prover(problem);
  for (const double height : {6.3499, 6.3501}) {
    const Waypoint here = at({-1, 0, height, 0, 0, 0});
    const RigidPose pose = prover.sampler().rigid_pose(Segment::straight(here, here), 0);
    BodySampler::Carried carried;
    const bool is_clear = prover.bodies()->is_clear(prover.sampler().model(), pose, carried);
    EXPECT_EQ(is_clear, height > 6.35);
    EXPECT_EQ(prover.prove(here, at({1, 0, height, 0, 0, 0})).verdict == Verdict::kProved, is_clear) << height;
  }
}

/// The crane carries a ball past a post that stands upright, as a curve in its coordinates would: the pose turns while
/// it moves, so the distance has its least value between any samples.
TEST(Prover, FindsPenetrationsThinnerThanAnySampling) {
  Problem problem = crane();
  problem.bodies->platform = {{.name = "hook", .shape = HullText{{{"0", "0", "0"}}, "0.05"}}};
  problem.bodies->platform[0].at_m = {"0.7", "0", "-1.2"};
  problem.bodies->obstacles = {capsule("post", {1, 3, 0}, {1, 3, 12}, 0.1)};
  problem.bodies->clearance_m = {"0.1", std::nullopt, std::nullopt, std::nullopt};
  const Waypoint from = at({-3, 0, 6.5, 0, 0, -0.1}), to = at({4, 1, 6.5, 0, 0, 0.2});
  // Where the post has to stand so that the least distance is its clearance: by samples, then by thirds.
  const Prover prover(problem);
  const Segment segment = prover.segment(from, to);
  const auto gap = [&](double s) {
    return prover.bodies()->gap(prover.sampler().model(), prover.sampler().rigid_pose(segment, s), 0);
  };
  double low = 0, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (gap(a) < gap(b) ? high : low) = gap(a) < gap(b) ? b : a;
  }
  const double least = gap(0.5 * (low + high));
  ASSERT_GT(least, 0.5);
  for (int digits = 2; digits <= 9; ++digits) {
    const double deep = std::pow(10.0, -digits);
    for (const bool touches : {true, false}) {
      problem.bodies->clearance_m[0] = text(0.1 + least + (touches ? deep : -deep));
      const SegmentProof proof = Prover(problem).prove(from, to);
      EXPECT_EQ(proof.verdict, touches ? Verdict::kRefuted : Verdict::kProved) << deep << ": " << proof.reason;
      EXPECT_LT(proof.boxes_judged, 2000) << deep;
    }
  }
}

TEST(Prover, LeavesATouchOpenAndNamesThePair) {
  Problem problem = crane();
  problem.tolerances.emplace();
  problem.tolerances->position_m = "0.3";
  const SegmentProof proof = Prover(problem).prove(at({-1, 0, 6.5, 0, 0, 0}), at({1, 0, 6.5, 0, 0, 0}));
  EXPECT_EQ(proof.verdict, Verdict::kUndecided);
  EXPECT_NE(proof.reason.text().find("container / stack"), std::string::npos) << proof.reason;
}

}  // namespace
}  // namespace taut
