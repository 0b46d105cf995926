// SPDX-License-Identifier: GPL-3.0-or-later
// What tolerances take from the margins, held against machines that deviate: at random, and as far as they can against
// one cable's tension.
#include "checker/kernel/deviation.h"

#include <gtest/gtest.h>

#include "tests/checker/deviants.h"
#include "tests/checker/loads_oracle.h"

namespace taut::checker {
namespace {

using campaign::Deviation;
using campaign::RigidPose;
using campaign::StaticsAt;

/// What says where the platform is.
enum class Lead { kPose, kLengths, kRows };

/// The same problem of a machine whose lengths may run straight between rows.
taut::Problem between_rows(taut::Problem problem, std::mt19937_64& random, double size) {
  TimeText& time = problem.time.emplace();
  time.winch_acceleration_m_s2.fill("1");
  RowsText& rows = time.rows.emplace();
  rows.step_s = "1e-9";
  for (DecimalText& error : rows.error_m) error = decimal(size * uniform(random, 1e-5, 5e-4));
  return problem;
}

struct Seen {
  int boxes = 0;
  int undefined = 0;
  double largest = 0;  ///< share of a bound that was reached
};

void expect_bounds(const taut::Problem& problem, bool length_controlled, std::mt19937_64& random, Seen& seen) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  const Problem stated = to_kernel(problem);
  const Machine machine(stated);
  std::vector<double> from = {uniform(random, -0.05, 0.05), uniform(random, -0.05, 0.05), uniform(random, 0.25, 0.38),
                              uniform(random, -3, 3),       uniform(random, 0.2, 1.2),    uniform(random, -0.6, 0.6)};
  std::vector<double> to = from;
  const double step = std::exp(uniform(random, -12, -4));
  for (double& x : to) x += step * uniform(random, -1, 1);
  Path path;
  path.waypoints = {waypoint(from), waypoint(to)};
  const int parts = 1 << (random() % 4);
  const int guesses = 1 + static_cast<int>(random() % 5);
  MarginLoss loss;
  try {
    const Geometry geometry = commanded_geometry(machine, stated, path, 0, dyadic_box(0, 1, 0, 64));
    loss = margin_loss(machine, geometry, Inverse(geometry.D), length_controlled, parts, guesses);
  } catch (const Undefined&) {
    ++seen.undefined;
    return;
  }
  ++seen.boxes;
  const auto big_machine = campaign::make_machine<BigFloat>(problem);
  const auto big_tolerances = campaign::make_tolerances<BigFloat>(problem);
  const auto machine_d = campaign::make_machine<double>(problem);
  const auto tolerances_d = campaign::make_tolerances<double>(problem);
  const double u = random() % 3 == 0 ? (random() % 2 == 0 ? -1 : 1) : uniform(random, -1, 1);
  const auto pose = [&]<class S>(S) {
    std::array<S, 6> x;
    for (std::size_t j = 0; j < 6; ++j) x[j] = S(from[j]) + (S(to[j]) - S(from[j])) * (S(1.0) + S(u)) / S(2.0);
    return RigidPose<S>{{x[0], x[1], x[2]}, campaign::orientation(x[3], x[4], x[5])};
  };
  const RigidPose<BigFloat> at = pose(BigFloat(0.0));
  const StaticsAt<BigFloat> before = campaign::statics(big_machine, at);

  std::vector<Deviation> deviations;
  for (int k = 0; k < 6; ++k) deviations.push_back(random_deviation(random));
  for (std::size_t i = 0; i < 6; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double side : {-1.0, 1.0}) {
        deviations.push_back(steepest([&](const Deviation& x) {
          const auto there = deviating(machine_d, tolerances_d, pose(0.0), x);
          return there ? sign * (side < 0 ? there->tension_low[i] : there->tension_high[i]) : 0;
        }));
      }
    }
    deviations.push_back(steepest([&](const Deviation& x) {
      const auto there = deviating(machine_d, tolerances_d, pose(0.0), x);
      return there ? there->length[i] : 0;
    }));
  }
  for (const Deviation& deviation : deviations) {
    const auto after = deviating(big_machine, big_tolerances, at, deviation);
    ASSERT_TRUE(after) << "the kernel says that this machine has its pose";
    for (std::size_t i = 0; i < 6; ++i) {
      const auto expect = [&](const Ball& bound, const BigFloat& change, const char* what) {
        const double limit = upper_end(bound).to_double(MPFR_RNDU);
        const double size = std::abs(change.to_double());
        EXPECT_TRUE(abs(change) <= upper_end(bound) + BigFloat(1e-35))
            << what << " of cable " << i << " changes by " << size << ", not by " << limit << "; parts " << parts
            << ", guesses " << guesses << ", lengths controlled " << length_controlled << ", step " << step;
        if (limit > 1e-9) seen.largest = std::max(seen.largest, size / limit);
      };
      expect(loss.tension[i][0], after->tension_low[i] - before.tension_low[i], "least tension");
      expect(loss.tension[i][1], after->tension_high[i] - before.tension_high[i], "largest tension");
      expect(loss.length[i], after->length[i] - before.length[i], "length");
    }
    if (::testing::Test::HasFailure()) return;
  }
}

void expect_bounds(Lead lead) {
  std::mt19937_64 random(lead == Lead::kLengths ? 11 : lead == Lead::kPose ? 12 : 15);
  const bool length_controlled = lead == Lead::kLengths;
  Seen seen;
  const std::array<taut::Problem, 2> robots = {testing::free_flying(testing::robot1_slice()),
                                               testing::free_flying(testing::robot2_sphere())};
  for (int trial = 0; trial < 120 && !::testing::Test::HasFailure(); ++trial) {
    taut::Problem problem = robots[static_cast<std::size_t>(trial % 2)];
    if (trial % 3 == 0) problem.load.point_m = {"0.02", "-0.03", "0.05"};
    const double size = std::exp(uniform(random, -3, 1.2));
    problem.tolerances = tolerances(random, size, length_controlled);
    if (lead == Lead::kRows) problem = between_rows(problem, random, trial % 5 == 0 ? 5 * size : size);
    expect_bounds(problem, length_controlled, random, seen);
  }
  std::printf("  %d boxes, %d undefined, at most %.3f of a bound\n", seen.boxes, seen.undefined, seen.largest);
  EXPECT_GT(seen.boxes, 40) << seen.undefined << " were undefined";
  EXPECT_GT(seen.largest, 0.6) << "no deviation comes close to what is bounded: is there an error in the test?";
}

TEST(Deviation, TakesNoMoreThanItsBoundWhereThePoseIsControlled) { expect_bounds(Lead::kPose); }
TEST(Deviation, TakesNoMoreThanItsBoundWhereLengthsAreControlled) { expect_bounds(Lead::kLengths); }
TEST(Deviation, TakesNoMoreThanItsBoundWhereLengthsRunStraightBetweenRows) { expect_bounds(Lead::kRows); }

/// A box of a robot with items: what tolerances take from tensions over all loads, and how much these may come to
/// differ from the nominal ones.
struct ItemTrial {
  taut::Problem stated;
  Problem problem;
  std::vector<double> from, to;
  double u = 0;
  MarginLoss loss;

  template <class S>
  [[nodiscard]] RigidPose<S> pose() const {
    std::array<S, 6> x;
    for (std::size_t j = 0; j < 6; ++j) x[j] = S(from[j]) + (S(to[j]) - S(from[j])) * (S(1.0) + S(u)) / S(2.0);
    return {{x[0], x[1], x[2]}, campaign::orientation(x[3], x[4], x[5])};
  }
  template <class S>
  [[nodiscard]] std::optional<std::array<Extremes<S>, 6>> tensions(const Deviation& by) const {
    const auto there = deviated(campaign::make_machine<S>(stated), campaign::make_tolerances<S>(stated), pose<S>(), by);
    if (!there) return std::nullopt;
    return tensions_of(problem, there->machine, there->pose);
  }
};

void expect_item_bounds(const ItemTrial& trial, std::mt19937_64& random, Seen& seen) {
  const PrecisionScope oracle(kOracleBits);
  const auto before = trial.tensions<BigFloat>({});
  std::vector<Deviation> deviations;
  for (int k = 0; k < 2; ++k) deviations.push_back(random_deviation(random));
  for (std::size_t i = 0; i < 6; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      for (const bool is_most : {false, true}) {
        deviations.push_back(steepest([&](const Deviation& x) {
          const auto there = trial.tensions<double>(x);
          return there ? sign * (is_most ? (*there)[i].most : (*there)[i].least) : 0;
        }));
      }
    }
  }
  for (const Deviation& deviation : deviations) {
    const auto after = trial.tensions<BigFloat>(deviation);
    ASSERT_TRUE(after) << "the kernel says that this machine has its pose";
    for (std::size_t i = 0; i < 6; ++i) {
      const auto expect = [&](const Ball& bound, const BigFloat& change, const char* what) {
        const double limit = upper_end(bound).to_double(MPFR_RNDU);
        const double size = std::abs(change.to_double());
        EXPECT_TRUE(abs(change) <= upper_end(bound) + BigFloat(1e-35))
            << what << " of cable " << i << " changes by " << size << ", not by " << limit;
        if (limit > 1e-9) seen.largest = std::max(seen.largest, size / limit);
      };
      const Extremes<BigFloat>& a = (*before)[i];
      const Extremes<BigFloat>& b = (*after)[i];
      expect(trial.loss.tension[i][0], b.least - a.least, "least tension");
      expect(trial.loss.tension[i][1], b.most - a.most, "largest tension");
      expect(trial.loss.radius[i][0], (b.nominal - b.least) - (a.nominal - a.least), "what the least is below");
      expect(trial.loss.radius[i][1], (b.most - b.nominal) - (a.most - a.nominal), "what the largest is above");
    }
    if (::testing::Test::HasFailure()) return;
  }
}

void expect_item_bounds(Lead lead) {
  std::mt19937_64 random(lead == Lead::kLengths ? 13 : lead == Lead::kPose ? 14 : 16);
  const bool length_controlled = lead == Lead::kLengths;
  Seen seen;
  const std::array<taut::Problem, 2> robots = {testing::free_flying(testing::robot1_slice()),
                                               testing::free_flying(testing::robot2_sphere())};
  for (int k = 0; k < 36 && !::testing::Test::HasFailure(); ++k) {
    ItemTrial trial;
    trial.stated = robots[static_cast<std::size_t>(k % 2)];
    if (k % 3 == 0) trial.stated.load.point_m = {"0.02", "-0.03", "0.05"};
    const double size = std::exp(uniform(random, -5, 1));
    trial.stated.tolerances = tolerances(random, size, length_controlled);
    trial.stated.tolerances->load_point_m = "0";
    trial.stated.tolerances->wrench.fill("0");
    if (k % 4 == 0) {  // the angle alone, so that what items do where they turn is most of the bound
      TolerancesText turning;
      turning.orientation_rad = "0.0005";
      if (length_controlled) turning.cable_length_m = std::array<DecimalText, 6>{"0", "0", "0", "0", "0", "0"};
      trial.stated.tolerances = turning;
    }
    if (lead == Lead::kRows) trial.stated = between_rows(trial.stated, random, k % 4 == 1 ? 5 * size : size);
    trial.problem = to_kernel(trial.stated);
    give_items(trial.problem, random, 1, k % 3 == 1);
    trial.from = {uniform(random, -0.05, 0.05), uniform(random, -0.05, 0.05), uniform(random, 0.25, 0.38),
                  uniform(random, -3, 3),       uniform(random, 0.2, 1.2),    uniform(random, -0.6, 0.6)};
    trial.to = trial.from;
    const double step = std::exp(uniform(random, -14, -5));
    for (double& x : trial.to) x += step * uniform(random, -1, 1);
    trial.u = uniform(random, -1, 1);
    const WorkingPrecision precision(64);
    const Machine machine(trial.problem);
    Path path;
    path.waypoints = {waypoint(trial.from), waypoint(trial.to)};
    try {
      const Geometry geometry = commanded_geometry(machine, trial.problem, path, 0, dyadic_box(0, 1, 0, 64));
      trial.loss = margin_loss(machine, geometry, Inverse(geometry.D), length_controlled, 1 << (random() % 4), 4);
    } catch (const Undefined&) {
      ++seen.undefined;
      continue;
    }
    ++seen.boxes;
    expect_item_bounds(trial, random, seen);
  }
  std::printf("  %d boxes, %d undefined, at most %.3f of a bound\n", seen.boxes, seen.undefined, seen.largest);
  EXPECT_GT(seen.boxes, 20) << seen.undefined << " were undefined";
  EXPECT_GT(seen.largest, 0.6) << "no deviation comes close to what is bounded: is there an error in the test?";
}

TEST(Deviation, OfItemsTakesNoMoreThanItsBoundWhereThePoseIsControlled) { expect_item_bounds(Lead::kPose); }
TEST(Deviation, OfItemsTakesNoMoreThanItsBoundWhereLengthsAreControlled) { expect_item_bounds(Lead::kLengths); }
TEST(Deviation, OfItemsTakesNoMoreThanItsBoundWhereLengthsRunStraightBetweenRows) { expect_item_bounds(Lead::kRows); }

/// At one pose, with these tolerances.
MarginLoss loss_at(const taut::Problem& problem, const std::vector<double>& at, bool length_controlled, int parts = 8) {
  const Problem stated = to_kernel(problem);
  const Machine machine(stated);
  Path path;
  path.waypoints = {waypoint(at), waypoint(at)};
  const Geometry geometry = commanded_geometry(machine, stated, path, 0, dyadic_box(0, 1, 0, 64));
  return margin_loss(machine, geometry, Inverse(geometry.D), length_controlled, parts, 4);
}
const std::vector<double> kPlain = {0.01, 0.02, 0.35, 0.3, 0.5, 0.6};

TEST(Deviation, NoToleranceTakesNothing) {
  taut::Problem problem = testing::free_flying(testing::robot1_slice());
  problem.tolerances = TolerancesText{};
  for (const bool length_controlled : {false, true}) {
    const MarginLoss loss = loss_at(problem, kPlain, length_controlled);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_LT(upper_end(loss.length[i]).to_double(), 1e-12);
      for (const Ball& x : loss.tension[i]) EXPECT_LT(upper_end(x).to_double(), 1e-12);
    }
  }
}

TEST(Deviation, MorePartsAreTighter) {
  taut::Problem problem = testing::free_flying(testing::robot1_slice());
  std::mt19937_64 random(3);
  for (const bool length_controlled : {false, true}) {
    problem.tolerances = tolerances(random, 0.5, length_controlled);
    double before = std::numeric_limits<double>::infinity();
    for (const int parts : {1, 2, 4, 8, 16}) {
      const double now = upper_end(loss_at(problem, kPlain, length_controlled, parts).tension[0][0]).to_double();
      EXPECT_LT(now, before * 1.01) << parts;
      before = now;
    }
  }
}

TEST(Deviation, ThatMayReachASingularPoseIsRefused) {
  taut::Problem problem = testing::free_flying(testing::robot1_slice());
  problem.tolerances = TolerancesText{};
  for (const std::string huge : {"0.05", "0.3", "10"}) {
    problem.tolerances = TolerancesText{};
    problem.tolerances->position_m = huge;
    problem.tolerances->orientation_rad = "0.9";
    EXPECT_THROW((void)loss_at(problem, kPlain, false), Undefined) << huge;
    problem.tolerances = TolerancesText{};
    problem.tolerances->cable_length_m = std::array<DecimalText, 6>{huge, huge, huge, huge, huge, huge};
    EXPECT_THROW((void)loss_at(problem, kPlain, true), Undefined) << huge;
  }
  // A platform that is almost in the plane of the base: every deviation of a few millimetres may bring it there.
  problem.tolerances = TolerancesText{};
  problem.tolerances->position_m = "0.005";
  EXPECT_THROW((void)loss_at(problem, {0.01, 0.02, 0.004, 0.3, 0.001, 0.2}, false), Undefined);
}

}  // namespace
}  // namespace taut::checker
