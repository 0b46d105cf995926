// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/margin_budget.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinematics/pose_sampler.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

Problem tolerant_robot() {
  Problem problem = testing::robot1_slice();
  TolerancesText& t = problem.tolerances.emplace();
  t.base_anchor_m.fill("0.001");
  t.platform_anchor_m = {"0.001", "0.002", "0", "0.001", "0.001", "0.001"};
  t.load_point_m = "0.0005";
  t.wrench = {"0.001", "0", "0.01", "0", "0", "0.0001"};
  t.position_m = "0.0007";
  t.orientation_rad = "0.002";
  return problem;
}

/// The same load, more or less, as items of every kind.
Problem robot_with_items() {
  Problem problem = tolerant_robot();
  problem.load = {};
  problem.load.point_m = {"0.01", "-0.02", "0.03"};
  problem.load.gravity_m_s2 = {"0", "0", "9.81"};
  problem.load.items = {
      {"block", Weight{"0.09", "0.1", {"0.02", "0.014", "-0.021"}, "0.002"}},
      {"exact", Weight{"0.004", "0.004", {"0.05", "0", "0"}, "0"}},
      {"wind", Force{DiscOfVectors{"0.02", {"0", "0", "1"}}, Axes::kWorld, {"0.03", "0.014", "0"}}},
      {"gust", Force{SegmentOfVectors{{"1", "0", "0"}, "-0.005", "0.01"}, Axes::kPlatform, {"0.01", "0", "0"}}},
      {"pull", Force{SegmentOfVectors{{"0", "1", "0"}, "0.01", "0.03"}, Axes::kWorld, {"0.03", "0.014", "-0.021"}}},
      {"twist", Moment{BallOfVectors{"0.001"}, Axes::kWorld}},
      {"cases", LoadCases{{{"0", "0", "0.01", "0", "0", "0"},
                           {"0.01", "0", "0", "0", "0", "0.001"},
                           {"0", "0.01", "0", "0", "0", "0"}},
                          Axes::kWorld,
                          {"0.03", "0.014", "-0.021"}}}};
  TolerancesText& t = *problem.tolerances;  // small: what items take changes what they take
  t.base_anchor_m.fill("1e-5");
  t.platform_anchor_m.fill("1e-5");
  t.position_m = "1e-5";
  t.orientation_rad = "1e-5";
  t.load_point_m = "0";
  t.wrench.fill("0");
  return problem;
}

RigidPose pose_of(const Problem& problem) {
  const PoseSampler sampler(problem);
  return sampler.rigid_pose(sampler.pose(Waypoint{{0.5, 0.3}, {0, 0}}));
}

DecimalText* text_of(Problem& problem, const DesignParameter& parameter) {
  using Kind = DesignParameter::Kind;
  switch (parameter.kind) {
    case Kind::kBaseAnchor: return &problem.robot.base_anchors_m[parameter.index][parameter.axis];
    case Kind::kPlatformAnchor: return &problem.robot.platform_anchors_m[parameter.index][parameter.axis];
    case Kind::kLoadPoint: return &problem.load.point_m[parameter.axis];
    case Kind::kWrench: return &problem.load.wrench[parameter.axis];
    case Kind::kTensionLower: return &problem.robot.tension_N[parameter.index].lower;
    case Kind::kTensionUpper: return &problem.robot.tension_N[parameter.index].upper;
    case Kind::kLengthLower: return &problem.robot.length_m[parameter.index].lower;
    case Kind::kLengthUpper: return &problem.robot.length_m[parameter.index].upper;
    case Kind::kWeight:
    case Kind::kMass:
    case Kind::kTolerance: break;
  }
  return nullptr;
}

double left(const Problem& problem, bool length_controlled, const RigidPose& pose, MarginId id) {
  const auto all = MarginDifferentiator(problem, length_controlled).budgets(pose);
  return std::ranges::find_if(*all, [&](const auto& b) { return b.id == id; })->left();
}

void expect_derivatives_of_changed_problems(const Problem& stated, std::size_t least_count) {
  for (const bool length_controlled : {false, true}) {
    Problem problem = stated;
    if (length_controlled) problem.tolerances->cable_length_m.emplace().fill("0.0003");
    const RigidPose pose = pose_of(problem);
    const MarginDifferentiator differentiator(problem, length_controlled);
    for (const MarginId id : {MarginId{MarginKind::kTensionMin, 2}, MarginId{MarginKind::kTensionMax, 5},
                              MarginId{MarginKind::kLengthMax, 1}}) {
      const std::vector<Derivative> all = differentiator.derivatives(pose, id);
      EXPECT_GE(all.size(), least_count);
      for (const Derivative& derivative : all) {
        const bool is_factor = derivative.parameter.kind == DesignParameter::Kind::kTolerance;
        const double step = 1e-6;
        std::array<double, 2> moved{};
        for (const int sign : {-1, 1}) {
          Problem changed = problem;
          if (derivative.parameter.kind == DesignParameter::Kind::kWeight) {
            for (DecimalText& w : changed.load.wrench) w = fmt::format("{:.17g}", std::stod(w) * (1 + sign * step));
          } else if (derivative.parameter.kind == DesignParameter::Kind::kMass) {
            auto& item = *std::ranges::find(changed.load.items, derivative.parameter.uncertainty.item, &LoadItem::name);
            auto& weight = std::get<Weight>(item.what);
            weight.mass_lower = fmt::format("{:.17g}", std::stod(weight.mass_lower) + sign * step);
            weight.mass_upper = fmt::format("{:.17g}", std::stod(weight.mass_upper) + sign * step);
          } else if (is_factor) {
            changed = with_uncertainty_scaled(problem, derivative.parameter.uncertainty,
                                              Decimal::parse(fmt::format("{:.9f}", 1 + sign * step)));
          } else {
            DecimalText& text = *text_of(changed, derivative.parameter);
            text = fmt::format("{:.17g}", std::stod(text) + sign * step);
          }
          moved.at(sign < 0 ? 0 : 1) = left(changed, length_controlled, pose, id);
        }
        const double difference = (moved[1] - moved[0]) / (2 * step);
        // A tolerance's derivative leaves out what is of second order: what the load's set takes changes a little what
        // the tolerances take, and the two tolerances of a weight multiply.
        const double bound = is_factor ? 1e-12 + 1e-2 * std::abs(difference) : 1e-5 * (1 + std::abs(difference));
        EXPECT_NEAR(derivative.value, difference, bound)
            << name(id.kind) << static_cast<int>(derivative.parameter.kind) << " " << derivative.parameter.index << " "
            << derivative.parameter.axis;
      }
    }
  }
}

TEST(MarginDifferentiator, DerivativesAreThoseOfChangedProblems) {
  constexpr std::size_t kAll = 18 + 18 + 3 + 6 + 1 + 24 + 7;
  expect_derivatives_of_changed_problems(tolerant_robot(), kAll);
}

TEST(MarginDifferentiator, DerivativesOfItemsAreThoseOfChangedProblems) {
  constexpr std::size_t kTwoMasses = 2, kSixItemsAndTheirSum = 7, kOtherTolerances = 4;
  Problem problem = robot_with_items();
  std::get<Weight>(problem.load.items[0].what).mass_lower = "0.0995";
  expect_derivatives_of_changed_problems(problem, 18 + 18 + 24 + kTwoMasses + kSixItemsAndTheirSum + kOtherTolerances);
}

TEST(MarginDifferentiator, LossesOfItemsAreThePartsOfTheLoads) {
  const Problem problem = robot_with_items();
  const auto budgets = MarginDifferentiator(problem, false).budgets(pose_of(problem));
  ASSERT_TRUE(budgets);
  for (const MarginBudget& budget : *budgets) {
    ASSERT_EQ(budget.loss_by_item.size(), 6U);
    EXPECT_EQ(budget.loss_by_item[0].first, "block");
    EXPECT_EQ(budget.loss_by_item[1].first, "wind");
    double sum = 0;
    for (const auto& [item, loss] : budget.loss_by_item) sum += loss;
    const double all = budget.loss[static_cast<std::size_t>(UncertaintyKind::kWrenchSet)];
    EXPECT_NEAR(sum, all, 1e-12);
    const bool is_tension = budget.id.kind == MarginKind::kTensionMin || budget.id.kind == MarginKind::kTensionMax;
    EXPECT_EQ(all > 0, is_tension);
  }
}

/// Of a machine that is moved by no more than its tolerances, nothing is lost beyond the budget but second-order terms.
TEST(MarginDifferentiator, LossesAreReachedByTheWorstAnchors) {
  const Problem problem = tolerant_robot();
  const RigidPose pose = pose_of(problem);
  const MarginDifferentiator differentiator(problem, false);
  const auto budgets = differentiator.budgets(pose);
  ASSERT_TRUE(budgets);
  const PoseSampler sampler(problem);
  for (const MarginBudget& budget : *budgets) {
    double expected = 0;
    for (std::size_t i = 0; i < kCables; ++i) {
      Vector3<double> slope;
      for (int k = 0; k < 3; ++k) {
        std::array<double, 2> at{};
        for (const int sign : {-1, 1}) {
          Model<double> model = sampler.model();
          model.p_WA[i](k) += sign * 1e-6;
          const auto s = statics(model, pose.p, Matrix3<double>(pose.q.toRotationMatrix()));
          at.at(sign < 0 ? 0 : 1) = slack(model, limited_quantity(s, budget.id), budget.id);
        }
        slope(k) = (at[1] - at[0]) / 2e-6;
      }
      expected += 0.001 * slope.norm();
    }
    EXPECT_NEAR(budget.loss[static_cast<std::size_t>(UncertaintyKind::kBaseAnchors)], expected, 1e-6 * (1 + expected));
    EXPECT_NEAR(budget.share(UncertaintyKind::kAll), budget.nominal / budget.all_losses(), 1e-12);
  }
}

TEST(Scaled, TheScaledSetContainsTheShareOfTheSet) {
  Problem problem = testing::robot1_slice();
  for (const char* factor : {"0.62", "0.001", "1", "3", "987"}) {
    const Problem scaled = with_uncertainty_scaled(problem, UncertaintyKind::kWrenchSet, Decimal::parse(factor));
    for (std::size_t k = 0; k < 6; ++k) {
      const auto f = Decimal::parse(factor).rational();
      using Rational = boost::multiprecision::cpp_rational;
      const Rational exact = Decimal::parse((*problem.load.ellipsoid)[k][k]).rational() / Rational(f * f);
      const Rational found = Decimal::parse((*scaled.load.ellipsoid)[k][k]).rational();
      EXPECT_LE(found, exact);
      EXPECT_GT(found, Rational(exact * Decimal::parse("0.9999999999999999999999999").rational()));
    }
  }
}

TEST(Scaled, RefusesAnOrientationErrorThatIsNoTolerance) {
  const Problem problem = tolerant_robot();
  EXPECT_NO_THROW(with_uncertainty_scaled(problem, UncertaintyKind::kOrientation, Decimal::parse("499")));
  EXPECT_THROW(with_uncertainty_scaled(problem, UncertaintyKind::kOrientation, Decimal::parse("500")), InputError);
}

TEST(Scaled, ScalesEveryToleranceTogether) {
  const Problem problem = tolerant_robot();
  const Problem half = with_uncertainty_scaled(problem, UncertaintyKind::kAll, Decimal::parse("0.5"));
  for (const UncertaintyKind kind : single_uncertainties()) {
    if (kind == UncertaintyKind::kWrenchSet) continue;
    EXPECT_DOUBLE_EQ(size_of(half, kind), 0.5 * size_of(problem, kind)) << name(kind);
  }
  EXPECT_EQ((*half.load.ellipsoid)[0][0], "40000");
  EXPECT_NO_THROW(validate(half));
  EXPECT_NO_THROW(validate(with_uncertainty_scaled(problem, UncertaintyKind::kAll, Decimal::parse("0"))));
}

TEST(Scaled, ScalesItemsAboutTheirNominalWrench) {
  const Problem problem = robot_with_items();
  const Problem twice = with_uncertainty_scaled(problem, UncertaintyKind::kAll, Decimal::parse("2"));
  const auto& items = twice.load.items;
  EXPECT_EQ(items[0].what, (LoadItem{"", Weight{"0.085", "0.105", {"0.02", "0.014", "-0.021"}, "0.004"}}.what));
  EXPECT_EQ(items[1], problem.load.items[1]);
  EXPECT_EQ(std::get<DiscOfVectors>(std::get<Force>(items[2].what).set).radius, "0.04");
  const auto range = [](const LoadItem& item) {
    const auto& set = std::get<SegmentOfVectors>(std::get<Force>(item.what).set);
    return std::pair(set.lower, set.upper);
  };
  EXPECT_EQ(range(items[3]), std::pair(std::string("-0.01"), std::string("0.02")));
  EXPECT_EQ(range(items[4]), std::pair(std::string("0"), std::string("0.04")));
  EXPECT_EQ(std::get<BallOfVectors>(std::get<Moment>(items[5].what).set).radius, "0.002");
  const auto& cases = std::get<LoadCases>(items[6].what).wrenches;  // about the mean of 1/300 N
  EXPECT_EQ(cases[0], (std::array<RationalText, 6>{"-1/300", "-1/300", "1/60", "0", "0", "-1/3000"}));
  EXPECT_NO_THROW(validate(twice));
  EXPECT_NO_THROW(validate(with_uncertainty_scaled(problem, UncertaintyKind::kAll, Decimal::parse("0"))));
}

TEST(Scaled, ScalesOneItemAlone) {
  const Problem problem = robot_with_items();
  const Uncertainty wind(UncertaintyKind::kLoadItem, "wind");
  const Problem half = with_uncertainty_scaled(problem, wind, Decimal::parse("0.5"));
  for (std::size_t n = 0; n < problem.load.items.size(); ++n) {
    EXPECT_EQ(half.load.items[n] == problem.load.items[n], problem.load.items[n].name != "wind");
  }
  EXPECT_EQ(std::get<DiscOfVectors>(std::get<Force>(half.load.items[2].what).set).radius, "0.01");
  EXPECT_EQ(half.tolerances->position_m, problem.tolerances->position_m);
  const Uncertainty none(UncertaintyKind::kLoadItem, "snow");
  EXPECT_THROW(with_uncertainty_scaled(problem, none, Decimal::parse("0.5")), InputError);
}

TEST(Scaled, RefusesAMassThatWouldBeNegative) {
  const Problem problem = robot_with_items();
  const Uncertainty block(UncertaintyKind::kLoadItem, "block");
  EXPECT_NO_THROW(with_uncertainty_scaled(problem, block, Decimal::parse("19")));
  EXPECT_THROW(with_uncertainty_scaled(problem, block, Decimal::parse("19.1")), InputError);
}

TEST(Scaled, NamesWhatDeviates) {
  Problem problem = robot_with_items();
  EXPECT_EQ(deviating_items(problem.load),
            (std::vector<std::string>{"block", "wind", "gust", "pull", "twist", "cases"}));
  problem.load.items = {problem.load.items[0], problem.load.items[1]};
  problem.tolerances.reset();
  EXPECT_EQ(stated_uncertainties(problem),
            (std::vector<Uncertainty>{{UncertaintyKind::kLoadItem, "block"}}));  // the load's deviations are its
  problem.load.items.erase(problem.load.items.begin());
  EXPECT_FALSE(is_stated(problem, UncertaintyKind::kWrenchSet));
  EXPECT_FALSE(is_stated(problem, UncertaintyKind::kAll));
  EXPECT_EQ(stated_uncertainties(problem), std::vector<Uncertainty>());
}

}  // namespace
}  // namespace taut
