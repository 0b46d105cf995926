// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel proves of distances between bodies, held against machines, poses and deviations in 200 bits.
#include "checker/kernel/clearance.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "checker/kernel/box_proof.h"
#include "tests/checker/bodies_oracle.h"
#include "tests/soundness/overlap.h"

namespace taut::checker {
namespace {

using campaign::best_direction, campaign::bodies_at, campaign::distance_at, campaign::nearest_points, campaign::rounded,
    campaign::weighted;
using campaign::BodyAt, campaign::HalfSpaceAt, campaign::HullAt, campaign::NearestPoints;
using campaign::Deviation;
using campaign::RigidPose;
using Vec = campaign::Vec<double>;

mpq_class ratio(double x, int denominator = 4096) {
  mpq_class result(std::lround(x * denominator), denominator);
  result.canonicalize();
  return result;
}

/// A robot with bodies, along a short straight path.
struct ClearanceTrial {
  taut::Problem stated;
  Problem problem;
  std::vector<TestBody> platform, obstacles;
  Path path;
  std::vector<double> from, to;
  Box box = dyadic_box(0, 1, 0, 128);

  [[nodiscard]] Bodies& bodies() { return *problem.bodies; }
  [[nodiscard]] const Bodies& bodies() const { return *problem.bodies; }

  template <class S>
  [[nodiscard]] RigidPose<S> pose(double u) const {
    std::array<S, 6> x;
    for (std::size_t j = 0; j < 6; ++j) x[j] = S(from[j]) + (S(to[j]) - S(from[j])) * (S(1.0) + S(u)) / S(2.0);
    return {{x[0], x[1], x[2]}, campaign::orientation(x[3], x[4], x[5])};
  }
  /// The bodies of a pair, at a pose of the path, or to where a deviation leads from there.
  template <class S>
  [[nodiscard]] std::pair<HullAt<S>, BodyAt<S>> at(const CheckedPair& pair, double u) const {
    return bodies_at(bodies(), platform, obstacles, pair, campaign::make_machine<S>(stated), pose<S>(u));
  }
  template <class S>
  [[nodiscard]] std::optional<Deviated<S>> led(double u, Deviation by) const {
    let_one_anchor_deviate_as_one(by);
    return deviated(campaign::make_machine<S>(stated), campaign::make_tolerances<S>(stated), pose<S>(u), by);
  }
  [[nodiscard]] double distance(const CheckedPair& pair, double u) const {
    const auto here = at<double>(pair, u);
    return distance_at(here, here);
  }

  /// Anchors that are stated at one place with one tolerance.
  void let_one_anchor_deviate_as_one(Deviation& by) const {
    if (!problem.tolerances) return;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (problem.base_anchors[i] == problem.base_anchors[j] &&
            problem.tolerances->base_anchors[i] == problem.tolerances->base_anchors[j]) {
          by.a[i] = by.a[j];
        }
        if (problem.platform_anchors[i] == problem.platform_anchors[j] &&
            problem.tolerances->platform_anchors[i] == problem.tolerances->platform_anchors[j]) {
          by.b[i] = by.b[j];
        }
      }
    }
  }

  /// A direction for each pair: the best one, or one that is off by about `error`.
  [[nodiscard]] Apart choose_directions(std::mt19937_64& random, double error) {
    path.directions.clear();
    Apart apart;
    for (const CheckedPair& pair : bodies().pairs) {
      if (bodies().is_against_half_space(pair)) {
        apart.emplace_back();
        continue;
      }
      const bool may_be_either = pair.kind == PairKind::kCableCable || pair.kind == PairKind::kPlatformObstacle;
      const bool in_P = pair.kind == PairKind::kCablePlatform || (may_be_either && random() % 2 == 0);
      Vec u = best_direction(at<double>(pair, 0));
      const double size = std::sqrt(campaign::dot(u, u));
      for (double& c : u) c += error * size * uniform(random, -1, 1);
      if (in_P) {
        const auto R = pose<double>(0).r;
        u = {R[0][0] * u[0] + R[1][0] * u[1] + R[2][0] * u[2], R[0][1] * u[0] + R[1][1] * u[1] + R[2][1] * u[2],
             R[0][2] * u[0] + R[1][2] * u[1] + R[2][2] * u[2]};
      }
      apart.push_back({path.directions.size()});
      path.directions.push_back({in_P ? Axes::kPlatform : Axes::kWorld, rounded(u)});
    }
    return apart;
  }

  struct Result {
    std::vector<Ball> margins;
    MarginLoss loss;
  };
  /// @pre the working precision is set
  [[nodiscard]] Result margins(const Apart& apart, int parts = 8) const {
    const Machine machine(problem);
    const Geometry geometry = commanded_geometry(machine, problem, path, 0, box);
    Result result;
    if (machine.tolerances) {
      result.loss = margin_loss(machine, geometry, Inverse(geometry.D), is_length_controlled(problem, path), parts, 4);
    }
    result.margins = clearance_margins(machine, geometry, result.loss, path.directions, apart);
    return result;
  }
};

HullShape random_box(std::mt19937_64& random, double size) {
  const std::array<double, 3> half = {uniform(random, 0.2, 1) * size, uniform(random, 0.2, 1) * size,
                                      uniform(random, 0.2, 1) * size};
  HullShape hull;
  for (int corner = 0; corner < 8; ++corner) {
    hull.points.push_back({ratio((corner & 1) != 0 ? half[0] : -half[0]), ratio((corner & 2) != 0 ? half[1] : -half[1]),
                           ratio((corner & 4) != 0 ? half[2] : -half[2])});
  }
  return hull;
}

HullShape random_points(std::mt19937_64& random, int count, double size, double radius) {
  HullShape hull{{}, ratio(radius)};
  for (int k = 0; k < count; ++k) {
    hull.points.push_back({ratio(uniform(random, -size, size)), ratio(uniform(random, -size, size)),
                           ratio(uniform(random, -size, size))});
  }
  return hull;
}

std::array<mpq_class, 3> random_angles(std::mt19937_64& random) {
  return {ratio(uniform(random, -3, 3)), ratio(uniform(random, -1.5, 1.5)), ratio(uniform(random, -3, 3))};
}

/// @param step  how long the path is; 0: it stays
ClearanceTrial random_trial(std::mt19937_64& random, const std::optional<TolerancesText>& tolerances, double step) {
  ClearanceTrial trial;
  trial.stated = testing::free_flying(random() % 2 == 0 ? testing::robot1_slice() : testing::robot2_sphere());
  if (random() % 3 == 0) trial.stated.load.point_m = {"0.02", "-0.03", "0.05"};
  trial.stated.tolerances = tolerances;
  trial.problem = to_kernel(trial.stated);
  trial.from = {uniform(random, -0.05, 0.05), uniform(random, -0.05, 0.05), uniform(random, 0.25, 0.38),
                uniform(random, -3, 3),       uniform(random, 0.2, 1.2),    uniform(random, -0.6, 0.6)};
  trial.to = trial.from;
  for (double& x : trial.to) x += step * uniform(random, -1, 1);
  trial.path.waypoints = {waypoint(trial.from), waypoint(trial.to)};

  const auto place = [&](double least, double most) {
    const double far = uniform(random, least, most);
    const double angle = uniform(random, -3.2, 3.2);
    return ExactVector{ratio(far * std::cos(angle)), ratio(far * std::sin(angle)), ratio(uniform(random, -0.1, 0.6))};
  };
  trial.platform = {
      test_body(random_box(random, 0.04), {0, 0, ratio(uniform(random, -0.02, 0.1))}, random_angles(random)),
      test_body(random_points(random, 1, 0.05, 0.02), {0, 0, ratio(0.05)})};
  trial.obstacles = {test_body(random_box(random, 0.1), place(0.3, 0.7), random_angles(random)),
                     test_body(random_points(random, 2, 0.2, 0.03), place(0.4, 0.8)),
                     test_body(random_points(random, 4, 0.1, 0), place(0.3, 0.6), random_angles(random)),
                     test_body(HalfSpaceShape{{ratio(uniform(random, -0.5, 0.5)), ratio(uniform(random, -0.5, 0.5)),
                                               ratio(uniform(random, 0.2, 3))}},
                               {0, 0, ratio(uniform(random, -0.4, -0.1))})};
  Bodies& bodies = trial.problem.bodies.emplace();
  for (const TestBody& body : trial.platform) bodies.platform.push_back(body.body);
  for (const TestBody& body : trial.obstacles) bodies.obstacles.push_back(body.body);
  for (CableBody& cable : bodies.cables) {
    cable.diameter = ratio(random() % 3 == 0 ? 0 : uniform(random, 0, 0.01));
    for (mpq_class& end : cable.free_ends) end = ratio(random() % 4 == 0 ? 0 : uniform(random, 0, 0.05));
  }
  bodies.checks.fill(true);
  bodies.pairs = all_pairs(bodies, ratio(uniform(random, 0, 0.01)));
  return trial;
}

/// The separation of two bodies along u of W, by (1) of the header.
BigFloat separation(const std::pair<HullAt<BigFloat>, BodyAt<BigFloat>>& pair, const campaign::Vec<BigFloat>& u) {
  const BigFloat size = campaign::root(campaign::dot(u, u));
  const auto extreme = [&](const HullAt<BigFloat>& hull, bool is_most) {
    BigFloat result = campaign::dot(u, hull.points[0]) / size;
    for (const auto& x : hull.points) {
      const BigFloat here = campaign::dot(u, x) / size;
      if (is_most ? here > result : here < result) result = here;
    }
    return is_most ? result + hull.radius : result - hull.radius;
  };
  if (const auto* half_space = std::get_if<HalfSpaceAt<BigFloat>>(&pair.second)) {
    return extreme(pair.first, false) - half_space->offset / size;
  }
  return extreme(pair.first, false) - extreme(std::get<HullAt<BigFloat>>(pair.second), true);
}

TEST(Clearance, IsTheSeparationAlongTheStatedDirection) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(128);
  std::mt19937_64 random(21);
  for (int k = 0; k < 30 && !::testing::Test::HasFailure(); ++k) {
    ClearanceTrial trial = random_trial(random, std::nullopt, 0);
    const Apart apart = trial.choose_directions(random, k % 2 == 0 ? 0 : 0.5);
    const std::vector<Ball> margins = trial.margins(apart).margins;
    for (std::size_t p = 0; p < margins.size(); ++p) {
      const CheckedPair& pair = trial.bodies().pairs[p];
      const auto there = trial.at<BigFloat>(pair, 0);
      campaign::Vec<BigFloat> u;
      if (!apart[p].empty()) {
        const Direction& direction = trial.path.directions[apart[p][0]];
        for (std::size_t c = 0; c < 3; ++c) u[c] = BigFloat(static_cast<double>(direction.u[c]));
        if (direction.axes == Axes::kPlatform) u = campaign::operator*(trial.pose<BigFloat>(0).r, u);
      } else {
        u = std::get<HalfSpaceAt<BigFloat>>(there.second).normal;
      }
      const BigFloat expected = separation(there, u) - exact<BigFloat>(pair.clearance);
      EXPECT_NEAR(approx(margins[p]), expected.to_double(), 1e-14) << "pair " << p << " of trial " << k;
      EXPECT_TRUE(lower_end(margins[p]) <= expected + BigFloat(1e-40)) << "pair " << p << " of trial " << k;
      EXPECT_LE(approx(margins[p]) + pair.clearance.get_d(), std::max(0.0, trial.distance(pair, 0)) + 1e-9);
    }
  }
}

struct SeenDistances {
  int boxes = 0;
  int undefined = 0;
  double largest = 0;        ///< share of what tolerances were said to take that a deviation took
  double largest_shift = 0;  ///< likewise of the pose's position
};

void expect_shift(const ClearanceTrial& trial, const Deviated<BigFloat>& there, double u, const MarginLoss& loss,
                  SeenDistances& seen) {
  const auto before = trial.pose<BigFloat>(u);
  const auto moved = campaign::operator-(there.pose.p, before.p);
  const BigFloat distance = campaign::root(campaign::dot(moved, moved));
  campaign::Rows<BigFloat> transposed;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) transposed[i][j] = before.r[j][i];
  }
  const auto Q = campaign::operator*(there.pose.r, transposed);
  const campaign::Vec<BigFloat> v = {Q[2][1] - Q[1][2], Q[0][2] - Q[2][0], Q[1][0] - Q[0][1]};
  const BigFloat turn =
      campaign::angle(campaign::root(campaign::dot(v, v)), Q[0][0] + Q[1][1] + Q[2][2] - BigFloat(1.0));
  EXPECT_TRUE(distance <= upper_end(loss.shift.position) + BigFloat(1e-35));
  EXPECT_TRUE(turn <= upper_end(loss.shift.turn) + BigFloat(1e-35));
  const double limit = approx(loss.shift.position);
  if (limit > 1e-9) seen.largest_shift = std::max(seen.largest_shift, distance.to_double() / limit);
}

void expect_no_nearer(ClearanceTrial& trial, std::mt19937_64& random, SeenDistances& seen) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  const Apart apart = trial.choose_directions(random, random() % 3 == 0 ? 0.2 : 0);
  ClearanceTrial::Result result;
  try {
    result = trial.margins(apart, 1 << (random() % 4));
  } catch (const Undefined&) {
    ++seen.undefined;
    return;
  }
  ++seen.boxes;
  const double u = random() % 3 == 0 ? (random() % 2 == 0 ? -1 : 1) : uniform(random, -1, 1);
  const auto distance_of = [&](const CheckedPair& pair, const Deviation& by) {
    const auto there = trial.led<double>(u, by);
    if (!there) return 1e9;
    const auto bodies = bodies_at(trial.bodies(), trial.platform, trial.obstacles, pair, there->machine, there->pose);
    return distance_at(bodies, bodies);
  };
  std::vector<Deviation> deviations = {random_deviation(random), random_deviation(random)};
  std::vector<std::size_t> attacked(deviations.size(), 0);
  for (int k = 0; k < 6; ++k) {
    const std::size_t p = random() % trial.bodies().pairs.size();
    attacked.push_back(p);
    deviations.push_back(steepest([&](const Deviation& by) { return -distance_of(trial.bodies().pairs[p], by); }));
  }
  for (std::size_t k = 0; k < deviations.size() && !::testing::Test::HasFailure(); ++k) {
    const auto there = trial.led<BigFloat>(u, deviations[k]);
    const auto nearly = trial.led<double>(u, deviations[k]);
    ASSERT_TRUE(there && nearly) << "the kernel says that this machine has its pose";
    expect_shift(trial, *there, u, result.loss, seen);
    for (std::size_t p = 0; p < result.margins.size(); ++p) {
      const CheckedPair& pair = trial.bodies().pairs[p];
      const auto bodies = bodies_at(trial.bodies(), trial.platform, trial.obstacles, pair, there->machine, there->pose);
      const auto search =
          bodies_at(trial.bodies(), trial.platform, trial.obstacles, pair, nearly->machine, nearly->pose);
      const BigFloat margin = distance_at(bodies, search) - exact<BigFloat>(pair.clearance);
      EXPECT_TRUE(margin >= lower_end(result.margins[p]) - BigFloat(1e-35))
          << "pair " << p << " of kind " << static_cast<int>(pair.kind) << " has " << margin.to_double() << ", not "
          << approx(result.margins[p]);
      if (k < 2 || attacked[k] != p) continue;
      const double stated = trial.distance(pair, u) - pair.clearance.get_d();
      const double limit = stated - approx(result.margins[p]);
      if (limit > 1e-6) seen.largest = std::max(seen.largest, (stated - margin.to_double()) / limit);
    }
  }
}

void expect_no_nearer(bool length_controlled) {
  std::mt19937_64 random(length_controlled ? 22 : 23);
  SeenDistances seen;
  for (int k = 0; k < 60 && !::testing::Test::HasFailure(); ++k) {
    TolerancesText within = tolerances(random, std::exp(uniform(random, -3, 1.2)), length_controlled);
    if (k % 2 == 0) {
      within.base_anchor_m.fill(within.base_anchor_m[0]);
      within.platform_anchor_m.fill(within.platform_anchor_m[0]);
    }
    ClearanceTrial trial = random_trial(random, within, std::exp(uniform(random, -12, -3)));
    expect_no_nearer(trial, random, seen);
  }
  std::printf("  %d boxes, %d undefined, at most %.3f of a bound, %.3f of a shift\n", seen.boxes, seen.undefined,
              seen.largest, seen.largest_shift);
  EXPECT_GT(seen.boxes, 25) << seen.undefined << " were undefined";
  EXPECT_GT(seen.largest, 0.6) << "no deviation comes close to what is bounded: is there an error in the test?";
  EXPECT_GT(seen.largest_shift, 0.4);
}

TEST(Clearance, IsKeptByEveryDeviationWhereThePoseIsControlled) { expect_no_nearer(false); }
TEST(Clearance, IsKeptByEveryDeviationWhereLengthsAreControlled) { expect_no_nearer(true); }

TEST(Clearance, HoldsAlongAWholeBox) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  std::mt19937_64 random(24);
  int boxes = 0;
  for (int k = 0; k < 40 && !::testing::Test::HasFailure(); ++k) {
    ClearanceTrial trial = random_trial(random, std::nullopt, std::exp(uniform(random, -8, -1)));
    const Apart apart = trial.choose_directions(random, 0);
    std::vector<Ball> margins;
    try {
      margins = trial.margins(apart).margins;
    } catch (const Undefined&) {
      continue;
    }
    ++boxes;
    for (const double u : samples(random, 12)) {
      for (std::size_t p = 0; p < margins.size(); ++p) {
        const CheckedPair& pair = trial.bodies().pairs[p];
        const auto there = trial.at<BigFloat>(pair, u);
        const BigFloat margin = distance_at(there, trial.at<double>(pair, u)) - exact<BigFloat>(pair.clearance);
        EXPECT_TRUE(margin >= lower_end(margins[p]) - BigFloat(1e-35)) << "pair " << p << " at u = " << u;
      }
    }
  }
  EXPECT_GT(boxes, 30);
}

/// A zone that holds all of the path takes the place of the clearance, one that may hold some of it only refutes less.
TEST(Clearance, IsMinusADepthWhereAZoneHoldsAllOfTheBox) {
  const WorkingPrecision precision(128);
  std::mt19937_64 random(27);
  for (int k = 0; k < 20; ++k) {
    ClearanceTrial trial = random_trial(random, std::nullopt, 0.01);
    const Apart apart = trial.choose_directions(random, 0);
    const std::vector<Ball> before = trial.margins(apart).margins;
    const auto with = [&](double offset, double within) {
      for (CheckedPair& pair : trial.bodies().pairs) {
        if (pair.kind != PairKind::kPlatformObstacle) continue;
        const ExactVector at = {mpq_class(trial.from[0] + offset), mpq_class(trial.from[1]), mpq_class(trial.from[2])};
        pair.zones = {{at, ratio(within), ratio(0.02)}, {at, ratio(within), ratio(0.01)}};
      }
      return trial.margins(apart).margins;
    };
    const std::vector<Ball> inside = with(0, 0.1), across = with(0, 1e-9), outside = with(1, 0.1);
    const Machine machine(trial.problem);
    for (std::size_t p = 0; p < before.size(); ++p) {
      const CheckedPair& pair = trial.bodies().pairs[p];
      const double more = pair.zones.empty() ? 0 : mpq_class(pair.clearance + ratio(0.02)).get_d();
      EXPECT_NEAR(approx(inside[p]), approx(before[p]) + more, 1e-12);
      EXPECT_EQ(approx(across[p]), approx(before[p]));
      EXPECT_EQ(approx(outside[p]), approx(before[p]));
    }
    const auto required = [&](std::size_t p, double x, bool at_most) {
      const Vector3<Ball> here = {Ball(x), Ball(trial.from[1]), Ball(trial.from[2])};
      const PlacedBodies& bodies = *machine.bodies;
      return approx(at_most ? bodies.required_at_most(p, here) : bodies.required_at_least(p, here));
    };
    EXPECT_NEAR(required(0, trial.from[0] + 1.09, true), -0.02, 1e-3);
    EXPECT_NEAR(required(0, trial.from[0] + 1.09, false), -0.02, 1e-3);
    EXPECT_GE(required(0, trial.from[0] + 1.11, false), 0);
    const Vector3<Ball> anywhere = {hull(Ball(-3), Ball(3)), Ball(trial.from[1]), Ball(trial.from[2])};
    EXPECT_GE(approx(machine.bodies->required_at_most(0, anywhere)), 0);
    EXPECT_NEAR(approx(machine.bodies->required_at_least(0, anywhere)), -0.02, 1e-3);
  }
}

TEST(Clearance, NeverIsProvedOfBodiesThatAreTooNear) {
  const WorkingPrecision precision(64);
  std::mt19937_64 random(25);
  int too_near = 0;
  for (int k = 0; k < 40; ++k) {
    ClearanceTrial trial = random_trial(random, std::nullopt, 0);
    for (CheckedPair& pair : trial.bodies().pairs) {  // somewhat more than there is
      pair.clearance = mpq_class(std::max(0.0, trial.distance(pair, 0)) * (1 + 1e-9) + 1e-9);
    }
    for (int n = 0; n < 10; ++n) {
      const Apart apart = trial.choose_directions(random, n == 0 ? 0 : uniform(random, 0, 2));
      for (const Ball& margin : trial.margins(apart).margins) {
        EXPECT_TRUE(certainly_negative(margin)) << print(margin);
        ++too_near;
      }
    }
  }
  EXPECT_GT(too_near, 10000);
}

/// A platform that stays at (0, 0, h), unturned, 1 mm of ball at its origin; distances are known exactly.
ClearanceTrial still_trial(const std::optional<TolerancesText>& within = std::nullopt) {
  ClearanceTrial trial;
  trial.stated = testing::free_flying(testing::robot1_slice());
  trial.stated.tolerances = within;
  trial.problem = to_kernel(trial.stated);
  trial.path.law = Law::kGeodesic;
  const std::vector<double> at = {0, 0, 0.375, 0, 0, 0, 1};
  trial.path.waypoints = {{at, {}, {}}, {at, {}, {}}};
  Bodies& bodies = trial.problem.bodies.emplace();
  for (CableBody& cable : bodies.cables) cable = {mpq_class(1, 500), {mpq_class(1, 50), mpq_class(1, 50)}};
  bodies.checks.fill(true);
  bodies.platform = {test_body(HullShape{{{0, 0, 0}}, mpq_class(1, 1000)}, {0, 0, mpq_class(-1, 8)}).body};
  bodies.obstacles = {
      test_body(HullShape{{{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}, 0}, {0, 0, mpq_class(1, 16)}).body,
      test_body(HalfSpaceShape{{0, 0, 7}}, {3, 4, mpq_class(1, 16)}).body};
  return trial;
}

/// One pair, told apart along direction k.
Apart along(std::size_t k) { return Apart(1, std::vector<std::size_t>(1, k)); }

TEST(Clearance, IsToldFromItsLimitByANanometre) {
  const WorkingPrecision precision(64);
  ClearanceTrial trial = still_trial();
  const mpq_class gap = mpq_class(3, 8) - mpq_class(1, 8) - mpq_class(1, 1000) - mpq_class(1, 16);
  const mpq_class nano(1, 1'000'000'000);
  trial.path.directions = {{Axes::kWorld, {0, 0, 3}}};
  for (std::size_t obstacle = 0; obstacle < 2; ++obstacle) {
    const Apart apart = obstacle == 0 ? along(0) : Apart(1);
    trial.bodies().pairs = {{PairKind::kPlatformObstacle, 0, obstacle, gap - nano}};
    EXPECT_NEAR(approx(trial.margins(apart).margins[0]), 1e-9, 1e-15);
    EXPECT_TRUE(certainly_positive(trial.margins(apart).margins[0]));
    trial.bodies().pairs = {{PairKind::kPlatformObstacle, 0, obstacle, gap + nano}};
    EXPECT_TRUE(certainly_negative(trial.margins(apart).margins[0]));
    trial.bodies().pairs = {{PairKind::kPlatformObstacle, 0, obstacle, gap}};
    EXPECT_FALSE(certainly_positive(trial.margins(apart).margins[0]));
  }
  // A direction that is turned round tells nothing apart.
  trial.path.directions = {{Axes::kWorld, {0, 0, -3}}};
  trial.bodies().pairs = {{PairKind::kPlatformObstacle, 0, 0, 0}};
  EXPECT_TRUE(certainly_negative(trial.margins(along(0)).margins[0]));
}

TEST(Clearance, NeedsDirectionsInAxesThatMakeSense) {
  const WorkingPrecision precision(64);
  ClearanceTrial trial = still_trial();
  trial.path.directions = {{Axes::kWorld, {0, 0, 1}}, {Axes::kPlatform, {0, 0, 1}}};
  const auto is_refused = [&](PairKind kind, std::size_t first, std::size_t second, const Apart& apart) {
    trial.bodies().pairs = {{kind, first, second, 0}};
    try {
      (void)trial.margins(apart);
      return false;
    } catch (const Undefined&) {
      return true;
    }
  };
  EXPECT_TRUE(is_refused(PairKind::kPlatformObstacle, 0, 0, {}));
  EXPECT_TRUE(is_refused(PairKind::kPlatformObstacle, 0, 0, Apart(1)));
  EXPECT_TRUE(is_refused(PairKind::kPlatformObstacle, 0, 0, along(2)));
  EXPECT_TRUE(is_refused(PairKind::kCableObstacle, 0, 0, along(1)));
  EXPECT_TRUE(is_refused(PairKind::kCablePlatform, 0, 0, along(0)));
  EXPECT_FALSE(is_refused(PairKind::kPlatformObstacle, 0, 0, along(0)));
  EXPECT_FALSE(is_refused(PairKind::kPlatformObstacle, 0, 0, along(1)));
  EXPECT_FALSE(is_refused(PairKind::kCablePlatform, 0, 0, along(1)));
  EXPECT_FALSE(is_refused(PairKind::kCableCable, 0, 1, along(0)));
  EXPECT_FALSE(is_refused(PairKind::kCableCable, 0, 1, along(1)));
  // No margin of a box is proved without directions.
  EXPECT_THROW((void)prove_box(Machine(trial.problem), trial.problem, trial.path, 0, trial.box), Undefined);
  EXPECT_TRUE(prove_box(Machine(trial.problem), trial.problem, trial.path, 0, trial.box, along(0)).clearance);
}

TEST(Clearance, NeedsCablesThatAreLongerThanTheirFreeEnds) {
  const WorkingPrecision precision(64);
  ClearanceTrial trial = still_trial();
  trial.path.directions = {{Axes::kWorld, {0, 0, 1}}};
  trial.bodies().pairs = {{PairKind::kCableCable, 0, 1, 0}};
  const auto length =
      lowest(Machine(trial.problem)
                 .geometry(commanded_geometry(Machine(trial.problem), trial.problem, trial.path, 0, trial.box).pose)
                 .length[1]
                 .range());
  CableBody& cable = trial.bodies().cables[1];
  cable.free_ends = {mpq_class(approx(length) - 1e-3), mpq_class(9, 10000)};
  EXPECT_NO_THROW((void)trial.margins(along(0)));
  cable.free_ends[1] = mpq_class(11, 10000);
  EXPECT_THROW((void)trial.margins(along(0)), Undefined);
}

/// Margins of the pair of cables 0 and 1, which hang from one base anchor.
Ball margin_of_neighbours(const char* of_first, const char* of_second) {
  TolerancesText within;
  within.base_anchor_m = {of_first, of_second, "0", "0", "0", "0"};
  ClearanceTrial trial = still_trial(within);
  trial.bodies().pairs = {{PairKind::kCableCable, 0, 1, 0}};
  trial.from = trial.to = {0, 0, 0.375, 0, 0, 0};
  std::mt19937_64 random(1);
  trial.path.directions.clear();
  const auto here =
      bodies_at(trial.bodies(), {}, {}, trial.bodies().pairs[0], campaign::make_machine<double>(trial.stated),
                RigidPose<double>{{0, 0, 0.375}, {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}}});
  trial.path.directions = {{Axes::kWorld, rounded(best_direction(here))}};
  return trial.margins(along(0)).margins[0];
}

TEST(Clearance, CountsTheDeviationOfOneAnchorOnce) {
  const WorkingPrecision precision(64);
  const Ball none = margin_of_neighbours("0", "0");
  const Ball one = margin_of_neighbours("0.003", "0.003");
  const Ball two = margin_of_neighbours("0.003", "0.002999999");
  EXPECT_GT(approx(none), 0.001);
  // Near the anchor, where the cables are nearest, the ends are moved back to where they are stated to be.
  EXPECT_GT(approx(one), approx(none) - 0.002);
  EXPECT_GT(approx(one), 0);
  EXPECT_LT(approx(two), approx(none) - 0.005);
}

// ---- Exit cones -----------------------------------------------------------------------------------------------------

/// |d| sin(a - t), by the cosine of t.
template <class S>
S distance_in_cone(const ExitCone& cone, double half_angle, const campaign::Machine<S>& machine,
                   const RigidPose<S>& pose) {
  using namespace campaign;
  const campaign::Vec<S> B = campaign::operator+(pose.p, campaign::operator*(pose.r, machine.b[cone.cable]));
  const campaign::Vec<S> out = campaign::operator-(B, machine.a[cone.cable]);
  campaign::Vec<S> d = out;
  for (std::size_t k = 0; k < 3 && cone.end == Axes::kPlatform; ++k) {
    d[k] = -(pose.r[0][k] * out[0] + pose.r[1][k] * out[1] + pose.r[2][k] * out[2]);
  }
  const campaign::Vec<S> n = exact<S>(cone.axis);
  const S size = root(campaign::dot(d, d)), cosine_t = campaign::dot(n, d) / (root(campaign::dot(n, n)) * size);
  const S rest = S(1.0) - cosine_t * cosine_t;
  const S sine_t = rest > S(0.0) ? root(rest) : S(0.0);
  return size * (sine(S(half_angle)) * cosine_t - cosine(S(half_angle)) * sine_t);
}

TEST(ExitCones, AreKeptByEveryDeviation) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  std::mt19937_64 random(28);
  int boxes = 0, inside = 0;
  double nearest = 1;
  for (int k = 0; k < 120 && !::testing::Test::HasFailure(); ++k) {
    const bool is_length_controlled = k % 2 == 1;
    const std::optional<TolerancesText> within =
        k % 3 == 0 ? std::nullopt
                   : std::optional(tolerances(random, std::exp(uniform(random, -3, 1)), is_length_controlled));
    ClearanceTrial trial = random_trial(random, within, std::exp(uniform(random, -12, -3)));
    const ExitCone cone{random() % 6,
                        random() % 2 == 0 ? Axes::kWorld : Axes::kPlatform,
                        {ratio(uniform(random, -1, 1)), ratio(uniform(random, -1, 1)), ratio(uniform(random, -1, 1))},
                        {}};
    const double half_angle = static_cast<double>(1 + random() % 99) / 64;  // exact
    trial.bodies().exit_cones = {cone};
    trial.bodies().exit_cones[0].half_angle =
        parse_expression(fmt::format("{:.10f}", half_angle), {}, "half_angle_rad");
    trial.bodies().pairs = {{PairKind::kExitCone, cone.cable, 0, 0}};
    std::optional<ClearanceTrial::Result> result;
    try {
      result = trial.margins({{}});
    } catch (const Undefined&) {
      continue;
    }
    ++boxes;
    const Ball& margin = result->margins.at(0);
    inside += certainly_positive(margin) ? 1 : 0;
    const double u = uniform(random, -1, 1);
    const auto deviant_distance = [&](const Deviation& by) {
      const auto there = trial.led<double>(u, by);
      return there ? distance_in_cone(cone, half_angle, there->machine, there->pose) : 1e9;
    };
    for (const Deviation& by :
         {random_deviation(random), steepest([&](const Deviation& x) { return -deviant_distance(x); })}) {
      const auto there = trial.led<BigFloat>(u, within ? by : Deviation());
      ASSERT_TRUE(there);
      const BigFloat distance = distance_in_cone(cone, half_angle, there->machine, there->pose);
      EXPECT_TRUE(distance >= lower_end(margin) - BigFloat(1e-35))
          << "trial " << k << ": " << distance.to_double() << " is less than " << approx(margin);
      nearest = std::min(nearest, distance.to_double() - approx(margin));
    }
    const Machine machine(trial.problem);
    trial.path.waypoints = {waypoint(trial.from), waypoint(trial.from)};
    const Geometry here = commanded_geometry(machine, trial.problem, trial.path, 0, trial.box);
    const BigFloat distance =
        distance_in_cone(cone, half_angle, campaign::make_machine<BigFloat>(trial.stated), trial.pose<BigFloat>(-1));
    EXPECT_TRUE(holds(contact_depth(machine, here, 0, {}), -distance, 1e-15)) << "trial " << k;
  }
  EXPECT_GT(boxes, 80);
  EXPECT_GT(inside, 8);
  EXPECT_LT(nearest, 1e-3);
}

TEST(ExitCones, NeedAHalfAngleBetweenNothingAndARightAngle) {
  std::mt19937_64 random(29);
  ClearanceTrial trial = random_trial(random, std::nullopt, 0);
  for (const char* angle : {"0", "-1", "pi/2", "2"}) {
    trial.bodies().exit_cones = {{0, Axes::kWorld, {0, 0, 1}, parse_expression(angle, {}, "")}};
    EXPECT_THROW((void)PlacedBodies(trial.problem), Undefined) << angle;
  }
}

// ---- Contact --------------------------------------------------------------------------------------------------------

TEST(Contact, IsAsDeepAsTheTwoPointsSay) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(128);
  std::mt19937_64 random(26);
  int contacts = 0;
  for (int k = 0; k < 40 && !::testing::Test::HasFailure(); ++k) {
    ClearanceTrial trial = random_trial(random, std::nullopt, 0);
    const double clearance = uniform(random, 0, 0.5);
    trial.bodies().pairs = all_pairs(trial.bodies(), ratio(clearance));
    const Machine machine(trial.problem);
    const Geometry geometry = commanded_geometry(machine, trial.problem, trial.path, 0, trial.box);
    for (std::size_t p = 0; p < trial.bodies().pairs.size(); ++p) {
      const CheckedPair& pair = trial.bodies().pairs[p];
      const auto there = trial.at<BigFloat>(pair, 0);
      const auto search = trial.at<double>(pair, 0);
      ContactWeights weights;
      const auto write = [&](std::size_t side, const std::vector<double>& from) {
        mpq_class sum = 0;
        for (const double x : from) sum += weights[side].emplace_back(x);
        *std::ranges::max_element(weights[side]) += 1 - sum;
      };
      BigFloat expected;
      if (std::holds_alternative<HalfSpaceAt<double>>(search.second)) {
        const auto& half_space = std::get<HalfSpaceAt<BigFloat>>(there.second);
        std::vector<double> of_lowest(search.first.points.size());
        const auto lowest_point = std::ranges::min_element(
            search.first.points, {}, [&](const Vec& x) { return campaign::dot(best_direction(search), x); });
        of_lowest[static_cast<std::size_t>(lowest_point - search.first.points.begin())] = 1;
        write(0, of_lowest);
        expected = (campaign::dot(half_space.normal, weighted(there.first.points, of_lowest)) - half_space.offset) /
                       campaign::root(campaign::dot(half_space.normal, half_space.normal)) -
                   there.first.radius;
      } else {
        const NearestPoints nearest =
            nearest_points(search.first.points, std::get<HullAt<double>>(search.second).points);
        write(0, nearest.first);
        write(1, nearest.second);
        expected = distance_at(there, search);
      }
      const BigFloat depth = exact<BigFloat>(pair.clearance) - expected;
      const Ball seen = contact_depth(machine, geometry, p, weights);
      EXPECT_TRUE(holds(seen, depth, 1e-30)) << "pair " << p << ": " << print(seen) << " and " << depth.to_double();
      EXPECT_LT(width(seen), 1e-15) << "pair " << p;
      contacts += certainly_positive(seen) ? 1 : 0;
    }
  }
  EXPECT_GT(contacts, 100);
}

/// An obstacle is moved to where the platform's body is, and corners of both are taken at random.
TEST(Contact, IsAtLeastAsDeepAsFourPairsOfPointsShow) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(128);
  std::mt19937_64 random(31);
  int around = 0;
  for (int k = 0; k < 40 && !::testing::Test::HasFailure(); ++k) {
    ClearanceTrial trial = random_trial(random, std::nullopt, 0);
    trial.bodies().pairs = {{PairKind::kPlatformObstacle, 0, k % 2 == 0 ? 0U : 2U, ratio(uniform(random, 0, 0.1))}};
    const CheckedPair& pair = trial.bodies().pairs[0];
    const auto before = trial.at<double>(pair, 0);
    const auto middle = [](const std::vector<Vec>& points) {
      Vec sum{0, 0, 0};
      for (const Vec& x : points) sum = sum + (1.0 / static_cast<double>(points.size())) * x;
      return sum;
    };
    const Vec by = middle(std::get<HullAt<double>>(before.second).points) - middle(before.first.points);
    for (std::size_t c = 0; c < 3; ++c) trial.from[c] += by[c] + uniform(random, -0.03, 0.03);
    trial.to = trial.from;
    trial.path.waypoints = {waypoint(trial.from), waypoint(trial.to)};
    const Machine machine(trial.problem);
    const Geometry geometry = commanded_geometry(machine, trial.problem, trial.path, 0, trial.box);
    const auto there = trial.at<BigFloat>(pair, 0);
    const auto& second = std::get<HullAt<BigFloat>>(there.second);
    const BigFloat overlap = campaign::depth_of(there.first.points, second.points).size;
    const BigFloat depth = overlap + there.first.radius + second.radius + exact<BigFloat>(pair.clearance);
    const auto corner = [&](std::size_t count) {
      std::vector<mpq_class> weights(count);
      weights[random() % count] = 1;
      return weights;
    };
    for (int time = 0; time < 100; ++time) {
      std::vector<ContactWeights> four(4);
      for (ContactWeights& of : four) of = {corner(there.first.points.size()), corner(second.points.size())};
      try {
        const Ball seen = depth_around(machine, geometry, 0, four);
        EXPECT_TRUE(overlap > BigFloat(0.0)) << "trial " << k;
        EXPECT_LE(approx(seen), depth.to_double()) << "trial " << k;
        EXPECT_GT(approx(seen), pair.clearance.get_d()) << "trial " << k;
        ++around;
      } catch (const Undefined&) {
        continue;
      }
    }
  }
  EXPECT_GT(around, 100);
}

}  // namespace
}  // namespace taut::checker
