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

RigidPose pose_of(const Problem& problem) {
  const PoseSampler sampler(problem);
  return rigid_pose(sampler.pose(Waypoint{{0.5, 0.3}, {0, 0}}));
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
    case Kind::kTolerance: break;
  }
  return nullptr;
}

double left(const Problem& problem, bool length_controlled, const RigidPose& pose, MarginId id) {
  const auto all = MarginDifferentiator(problem, length_controlled).budgets(pose);
  return std::ranges::find_if(*all, [&](const auto& b) { return b.id == id; })->left();
}

TEST(MarginDifferentiator, DerivativesAreThoseOfChangedProblems) {
  for (const bool length_controlled : {false, true}) {
    Problem problem = tolerant_robot();
    if (length_controlled) problem.tolerances->cable_length_m.emplace().fill("0.0003");
    const RigidPose pose = pose_of(problem);
    const MarginDifferentiator differentiator(problem, length_controlled);
    for (const MarginId id : {MarginId{MarginKind::kTensionMin, 2}, MarginId{MarginKind::kTensionMax, 5},
                              MarginId{MarginKind::kLengthMax, 1}}) {
      const std::vector<Derivative> all = differentiator.derivatives(pose, id);
      for (const Derivative& derivative : all) {
        const bool is_factor = derivative.parameter.kind == DesignParameter::Kind::kTolerance;
        const double step = 1e-6;
        std::array<double, 2> moved{};
        for (const int sign : {-1, 1}) {
          Problem changed = problem;
          if (derivative.parameter.kind == DesignParameter::Kind::kWeight) {
            for (DecimalText& w : changed.load.wrench) w = fmt::format("{:.17g}", std::stod(w) * (1 + sign * step));
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
        // What the load's set takes changes a little what the tolerances take, which a tolerance's derivative leaves out.
        const double bound = is_factor ? 1e-2 * std::abs(difference) : 1e-5 * (1 + std::abs(difference));
        EXPECT_NEAR(derivative.value, difference, bound)
            << name(id.kind) << static_cast<int>(derivative.parameter.kind) << " " << derivative.parameter.index << " "
            << derivative.parameter.axis;
      }
    }
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
      const Rational exact = Decimal::parse(problem.load.ellipsoid[k][k]).rational() / Rational(f * f);
      const Rational found = Decimal::parse(scaled.load.ellipsoid[k][k]).rational();
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
  EXPECT_EQ(half.load.ellipsoid[0][0], "40000");
  EXPECT_NO_THROW(validate(half));
  EXPECT_NO_THROW(validate(with_uncertainty_scaled(problem, UncertaintyKind::kAll, Decimal::parse("0"))));
}

}  // namespace
}  // namespace taut
