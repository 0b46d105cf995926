// SPDX-License-Identifier: GPL-3.0-or-later
// Where each law leads, held against poses that come by other equations (tests/soundness/machine.h).
#include "checker/kernel/motion.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/checker/kernel.h"

namespace taut::checker {
namespace {

taut::Problem robot(int which) {
  return testing::free_flying(which % 2 == 0 ? testing::robot1_slice() : testing::robot2_sphere());
}

std::vector<double> random_coordinates(std::mt19937_64& random) {
  return {uniform(random, -0.08, 0.08), uniform(random, -0.08, 0.08), uniform(random, 0.2, 0.4),
          uniform(random, -3, 3),       uniform(random, -0.9, 0.9),   uniform(random, -0.8, 0.8)};
}
std::vector<double> random_pose(std::mt19937_64& random) {
  std::vector<double> x = {uniform(random, -0.08, 0.08), uniform(random, -0.08, 0.08), uniform(random, 0.2, 0.4)};
  for (int k = 0; k < 4; ++k) x.push_back(uniform(random, -1, 1));
  return x;
}
/// Where cables are far from each other's planes, so that lengths tell the pose.
std::vector<double> upright_pose(std::mt19937_64& random) {
  std::vector<double> x = random_pose(random);
  for (std::size_t i = 3; i < 6; ++i) x[i] *= 0.3;
  x[6] = 1;
  return x;
}
std::vector<double> near_to(std::vector<double> x, double step, std::mt19937_64& random) {
  for (double& c : x) c += step * uniform(random, -1, 1);
  return x;
}

campaign::RigidPose<BigFloat> pose_of(const std::vector<BigFloat>& x) {
  return {{x[0], x[1], x[2]}, campaign::orientation(x[3], x[4], x[5])};
}

Box random_box(std::mt19937_64& random) {
  const int depth = static_cast<int>(random() % 6);
  const int begin = static_cast<int>(random() % (1U << depth));
  return dyadic_box(begin, begin + 1, depth, random() % 2 == 0 ? 64 : 128);
}

/// The geometry over a box; nothing where cables may have no length, as they may over large boxes.
std::optional<Geometry> geometry(const Problem& problem, const Path& path, std::size_t k, const Box& box) {
  try {
    return commanded_geometry(Machine(problem), problem, path, k, box);
  } catch (const Undefined&) {
    return std::nullopt;
  }
}

TEST(Motion, StraightAndSplineSegmentsAreWhereTheirLawsSay) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(1);
  int shown_boxes = 0;
  for (int trial = 0; trial < 200 && !HasFailure(); ++trial) {
    const Problem problem = to_kernel(robot(trial));
    Path path;
    path.law = trial % 4 < 2 ? Law::kStraight : Law::kCubicBSpline;
    const double step = std::exp(uniform(random, -8, -1));
    const std::vector<double> first = random_coordinates(random);
    for (int k = 0; k < 5; ++k) {
      path.waypoints.push_back(waypoint(near_to(first, step, random)));
      if (trial % 5 == 0) path.waypoints.back().half_turns[3] = 7 + (k % 2);
    }
    const std::size_t k = random() % path.segments();
    const Box box = random_box(random);
    const WorkingPrecision precision(box.bits);
    const auto whole = geometry(problem, path, k, box);
    if (!whole) continue;
    ++shown_boxes;
    for (const double u : samples(random, 10)) {
      const BigFloat s = place(box, u), one(1.0), six(6.0);
      std::vector<BigFloat> weights = {one - s, s};
      if (path.law == Law::kCubicBSpline) {
        const BigFloat t = one - s, two(2.0), four(4.0), three(3.0);
        weights = {t * t * t / six, (three * s * s * s - six * s * s + four) / six,
                   (three * t * t * t - six * t * t + four) / six, s * s * s / six};
      }
      std::vector<BigFloat> x(6);
      for (std::size_t j = 0; j < 6; ++j) {
        for (std::size_t i = 0; i < weights.size(); ++i) {
          const Waypoint& w = path.waypoints[k + i];
          x[j] += weights[i] * (BigFloat(w.x[j]) + oracle::pi() * BigFloat(w.half_turns[j]));
        }
      }
      expect_pose(whole->pose, u, pose_of(x));
    }
  }
  EXPECT_GT(shown_boxes, 100);
}

TEST(Motion, AnglesGiveTheRotationThatTheyName) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(7);
  int shown_boxes = 0;
  for (int trial = 0; trial < 240 && !HasFailure(); ++trial) {
    AnglesText angles{static_cast<taut::AngleKind>(trial % 4)};
    if (trial % 8 >= 4) angles.axis = {"0.3", "-2", "0.007"};
    taut::Problem exact = robot(trial);
    exact.space = coordinate_space(angles);
    const Problem problem = to_kernel(exact);
    const std::size_t count = exact.space.parameters.size();
    Path path;
    const double step = std::exp(uniform(random, -8, -1));
    std::vector<double> first = random_coordinates(random);
    if (trial % 3 == 0) first[4] = std::numbers::pi / 2;  // of pitch: gimbal lock
    first.resize(count);
    for (int k = 0; k < 2; ++k) {
      path.waypoints.push_back(waypoint(near_to(first, step, random)));
      if (trial % 5 == 0) path.waypoints.back().half_turns[3] = 7;
    }
    const Box box = random_box(random);
    const WorkingPrecision precision(box.bits);
    const auto whole = geometry(problem, path, 0, box);
    if (!whole) continue;
    ++shown_boxes;
    for (const double u : samples(random, 10)) {
      const BigFloat s = place(box, u), one(1.0);
      std::vector<BigFloat> x(6, BigFloat(0.0));
      for (std::size_t j = 0; j < count; ++j) {
        const auto at = [&](const Waypoint& w) { return BigFloat(w.x[j]) + oracle::pi() * BigFloat(w.half_turns[j]); };
        x[j] = (one - s) * at(path.waypoints[0]) + s * at(path.waypoints[1]);
      }
      expect_pose(whole->pose, u, {{x[0], x[1], x[2]}, campaign::orientation(angles, x[3], x[4], x[5])});
    }
  }
  EXPECT_GT(shown_boxes, 120);
}

TEST(Motion, GeodesicsTurnAtAConstantRateTheShorterWay) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(2);
  int shown_boxes = 0;
  for (int trial = 0; trial < 200 && !HasFailure(); ++trial) {
    const Problem problem = to_kernel(robot(trial));
    Path path;
    path.law = Law::kGeodesic;
    const std::vector<double> first = random_pose(random);
    std::vector<double> second =
        trial % 3 == 0 ? random_pose(random) : near_to(first, std::exp(uniform(random, -8, -1)), random);
    if (trial % 4 == 0) {
      for (std::size_t i = 3; i < 7; ++i) second[i] *= -1;  // the same rotation
    }
    path.waypoints = {{first, {}, {}}, {second, {}, {}}};
    const Box box = random_box(random);
    const WorkingPrecision precision(box.bits);
    const auto whole = geometry(problem, path, 0, box);
    if (!whole) continue;
    ++shown_boxes;
    for (const double u : samples(random, 10)) {
      expect_pose(whole->pose, u, campaign::slerp(first, second, place(box, u)));
    }
  }
  EXPECT_GT(shown_boxes, 100);
}

TEST(Motion, AGeodesicOfHalfATurnIsRefused) {
  const Problem problem = to_kernel(robot(0));
  Path path;
  path.law = Law::kGeodesic;
  path.waypoints = {{{0, 0, 0.3, 0, 0, 0, 1}, {}, {}}, {{0, 0, 0.3, 0, 1, 0, 0}, {}, {}}};
  EXPECT_THROW((void)commanded_geometry(Machine(problem), problem, path, 0, dyadic_box(0, 1, 0)), Undefined);
}

/// Near where y is at u = -1, 0 and 1.
NearZero near_zero(const std::function<std::vector<double>(double u)>& y, double room, int narrowings) {
  const std::vector<double> first = y(-1), middle = y(0), last = y(1);
  NearZero near;
  near.narrowings = narrowings;
  double off = 0;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    near.slope.push_back((last[i] - first[i]) / 2);
    const double ends = (first[i] + last[i]) / 2;
    near.at.push_back((middle[i] + ends) / 2);
    off = std::max(off, std::abs(middle[i] - ends) / 2);
  }
  near.radius = room * off + 1e-9;
  return near;
}

/// As commanded_geometry(), with a radius that will do.
std::optional<Geometry> shown(const Machine& machine, const Problem& problem, const Path& path, Box box,
                              const std::function<std::vector<double>(double u)>& y, int narrowings) {
  for (double room = 4; room < 1e4; room *= 3) {
    box.near = near_zero(y, room, narrowings);
    try {
      return commanded_geometry(machine, problem, path, 0, box);
    } catch (const Undefined&) {
    }
  }
  return std::nullopt;
}

TEST(Motion, OnAConstraintItIsTheOneNextToTheLine) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(3);
  int proved = 0;
  for (int trial = 0; trial < 150 && !HasFailure(); ++trial) {
    taut::Problem stated = robot(trial);
    stated.space.constraints = {"px^2 + py^2 + pz^2 - 0.1"};
    const Problem problem = to_kernel(stated);
    Path path;
    const std::vector<double> first = random_coordinates(random);
    for (const std::vector<double>& x : {first, near_to(first, std::exp(uniform(random, -8, -2)), random)}) {
      path.waypoints.push_back(waypoint(x));
      const double size = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
      path.waypoints.back().normals = {x[0] / size, x[1] / size, x[2] / size, 0, 0, 0};
    }
    path.tubes = {0.25};
    const Box box = random_box(random);
    const auto solve = [&]<class S>(const S& s) {  // |l + N y|^2 = 0.1, the smaller |y|
      std::vector<S> l(6), n(6);
      S a(0.0), b(0.0), c(campaign::number<S>("-0.1"));
      for (std::size_t j = 0; j < 6; ++j) {
        const auto mixed = [&](double p, double q) { return S(p) * (S(1.0) - s) + S(q) * s; };
        l[j] = mixed(path.waypoints[0].x[j], path.waypoints[1].x[j]);
        n[j] = mixed(path.waypoints[0].normals[j], path.waypoints[1].normals[j]);
        if (j > 2) continue;
        a = a + n[j] * n[j];
        b = b + l[j] * n[j];
        c = c + l[j] * l[j];
      }
      const S y = (campaign::root(b * b - a * c) - b) / a;
      for (std::size_t j = 0; j < 6; ++j) l[j] = l[j] + n[j] * y;
      return std::pair{y, l};
    };
    const WorkingPrecision precision(box.bits);
    const auto whole = shown(
        Machine(problem), problem, path, box,
        [&](double u) { return std::vector{solve(place(box, u).to_double()).first}; }, trial % 4);
    if (!whole) continue;
    ++proved;
    for (const double u : samples(random, 10)) expect_pose(whole->pose, u, pose_of(solve(place(box, u)).second));
  }
  EXPECT_GT(proved, 75);
}

TEST(Motion, LengthsLeadToTheOnlyPoseInTheTube) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(4);
  int proved = 0;
  for (int trial = 0; trial < 150 && !HasFailure(); ++trial) {
    const taut::Problem stated = robot(trial);
    const Problem problem = to_kernel(stated);
    const auto machine = campaign::make_machine<double>(stated);
    const auto exact = campaign::make_machine<BigFloat>(stated);
    Path path;
    path.law = Law::kCableLengths;
    const std::vector<double> first = upright_pose(random);
    const std::vector<double> second = near_to(first, std::exp(uniform(random, -9, -3.5)), random);
    for (const std::vector<double>& x : {first, second}) {
      Waypoint& w = path.waypoints.emplace_back(Waypoint{x, {}, {}});
      const auto lengths = campaign::lengths(machine, campaign::mixed<double>(x, x, 0.0));
      w.x.insert(w.x.end(), lengths.begin(), lengths.end());
    }
    path.pose_tubes = {{0.004, 0.015}};
    path.inner_poses = {{}};
    const Box box = random_box(random);
    const auto solve = [&]<class S>(const campaign::Machine<S>& of, const S& s) {
      campaign::Six<S> wanted;
      for (std::size_t i = 0; i < 6; ++i) {
        wanted[i] = (S(1.0) - s) * S(path.waypoints[0].x[7 + i]) + s * S(path.waypoints[1].x[7 + i]);
      }
      return campaign::hold(of, campaign::mixed<S>(first, second, s), wanted, 40);
    };
    bool found = true;
    const auto unknowns = [&](double u) {
      const double s = place(box, u).to_double();
      const auto pose = solve(machine, s);
      if (!pose) {
        found = false;
        return std::vector<double>(6, 0);
      }
      const auto reference = campaign::mixed<double>(first, second, s);
      return in_tube(*pose, reference, path.pose_tubes[0]);
    };
    const WorkingPrecision precision(box.bits);
    const auto whole = shown(Machine(problem), problem, path, box, unknowns, trial % 4);
    if (!whole || !found) continue;
    ++proved;
    for (const double u : samples(random, 6)) {
      const auto pose = solve(exact, place(box, u));
      ASSERT_TRUE(pose) << "the kernel says that there is one";
      expect_pose(whole->pose, u, *pose);
      const auto lengths = campaign::lengths(exact, *pose);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(holds(whole->length[i], u, lengths[i]));
    }
  }
  EXPECT_GT(proved, 40);
}

TEST(Motion, ParametersOutsideOfTheirRangesAreNotAccepted) {
  Problem problem = to_kernel(robot(0));
  problem.parameters[2].kind = ParameterKind::kRange;
  problem.parameters[2].lower = parse_expression("1/4", {}, "test");
  problem.parameters[2].upper = parse_expression("3/8", {}, "test");
  const auto at = [](double x) {
    std::vector<MeanValueForm> result(6);
    result[2] = MeanValueForm(Ball(x), Ball(0x1p-10));
    return result;
  };
  EXPECT_NO_THROW(require_in_range(problem, at(0.3)));
  EXPECT_THROW(require_in_range(problem, at(0.25)), Undefined);
  EXPECT_THROW(require_in_range(problem, at(0.375)), Undefined);
  EXPECT_THROW(require_in_range(problem, at(0.5)), Undefined);
}

}  // namespace
}  // namespace taut::checker
