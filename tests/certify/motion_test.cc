// SPDX-License-Identifier: GPL-3.0-or-later
// Implied motions and splines against 200-bit samples: y(t) by Newton's method, on constraints that are written a
// second time.
#include "certify/motion/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>

#include "certify/prover.h"
#include "kinematics/constraint_functions.h"
#include "tests/soundness/machine.h"
#include "tests/support/enclosing.h"
#include "tests/support/linear_system.h"
#include "tests/support/segments.h"

namespace taut::testing {
namespace {

/// All six coordinates of the pose are parameters, so that an enclosure of the pose is one of them.
struct Surface {
  const char* name;
  Problem problem;
  std::function<Vector(const Vector&)> constraints;
};

Surface surface(const char* name, std::vector<ExpressionText> texts, std::function<Vector(const Vector&)> constraints) {
  Surface result{name, free_flying(robot2_sphere()), std::move(constraints)};
  result.problem.space.parameters[3].kind = ParameterKind::kPeriodic;
  result.problem.space.constraints = std::move(texts);
  return result;
}

Surface sphere() {
  return surface("sphere", {"px^2 + py^2 + (pz - 0.306)^2 - 0.13^2"}, [](const Vector& q) {
    const BigFloat z = q[2] - oracle::big("0.306");
    return Vector{q[0] * q[0] + q[1] * q[1] + z * z - oracle::big("0.0169")};
  });
}
Surface cylinder() {
  return surface("cylinder", {"sqrt(px^2 + py^2) - 0.13"},
                 [](const Vector& q) { return Vector{sqrt(q[0] * q[0] + q[1] * q[1]) - oracle::big("0.13")}; });
}
Surface sphere_and_tilt() {
  return surface("sphere and tilt", {"px^2 + py^2 + (pz - 0.306)^2 - 0.13^2", "theta - 2*px*exp(-py)"},
                 [](const Vector& q) {
                   const BigFloat z = q[2] - oracle::big("0.306");
                   return Vector{q[0] * q[0] + q[1] * q[1] + z * z - oracle::big("0.0169"),
                                 q[4] - BigFloat(2.0) * q[0] * exp(-q[1])};
                 });
}
/// As many constraints as there can be, with every other function of the grammar.
Surface curve() {
  return surface("curve",
                 {"px - 0.1*tan(sigma/2)", "py - 0.05*log(2 + sigma)", "pz - 0.3 - 0.02*sigma^3",
                  "sin(phi) - 0.3*cos(sigma)", "theta - atan2(sigma, 2 + sigma)/4"},
                 [](const Vector& q) {
                   const BigFloat &s = q[5], two(2.0);
                   return Vector{q[0] - oracle::big("0.1") * tan(s / two), q[1] - oracle::big("0.05") * log(two + s),
                                 q[2] - oracle::big("0.3") - oracle::big("0.02") * s * s * s,
                                 sin(q[3]) - oracle::big("0.3") * cos(s), q[4] - atan2(s, two + s) / BigFloat(4.0)};
                 });
}

/// The format's mixing of control points, at a binary64 s.
template <class Value>
BigFloat mixed(const Segment& segment, double s_double, const Value& value) {
  const BigFloat s(s_double), one(1.0), r = one - s, three(3.0), six(6.0);
  std::vector<BigFloat> weights = {r, s};
  if (segment.law == Interpolation::kCubicBSpline) {
    weights = {r * r * r, three * s * s * s - six * s * s + BigFloat(4.0), three * s * (one + s - s * s) + one,
               s * s * s};
    for (BigFloat& weight : weights) weight /= six;
  }
  BigFloat sum;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * value(*segment.control[i]);
  return sum;
}

/// ℓ(s) + N(s) y(s) and y(s), to about 1e-70.
struct Exact {
  Vector parameters;
  Vector y;
};
Exact exact_motion(const Surface& surface, const Segment& segment, double s) {
  const std::size_t m = surface.problem.space.parameters.size();
  const std::size_t k = surface.problem.space.constraints.size();
  Vector line;
  Vector normals;
  for (std::size_t j = 0; j < m; ++j) {
    line.push_back(mixed(segment, s, [&](const Waypoint& w) {
      return BigFloat(w.parameters().x[j]) + oracle::pi() * BigFloat(w.parameters().half_turns[j]);
    }));
    for (std::size_t i = 0; i < k; ++i) {
      normals.push_back(
          mixed(segment, s, [&](const Waypoint& w) { return BigFloat(w.parameters().normals[j * k + i]); }));
    }
  }
  Exact exact{line, Vector(k)};
  const auto move = [&](const Vector& y) {
    Vector result = line;
    for (std::size_t j = 0; j < m; ++j) {
      for (std::size_t i = 0; i < k; ++i) result[j] += normals[j * k + i] * y[i];
    }
    return result;
  };
  const BigFloat h(std::ldexp(1.0, -90));
  for (int step = 0; step < 12; ++step) {
    const Vector c = surface.constraints(move(exact.y));
    std::vector<Vector> jacobian(k, Vector(k));
    for (std::size_t i = 0; i < k; ++i) {
      Vector nudged = exact.y;
      nudged[i] += h;
      const Vector d = surface.constraints(move(nudged));
      for (std::size_t e = 0; e < k; ++e) jacobian[e][i] = (d[e] - c[e]) / h;
    }
    const Vector correction = solve(jacobian, c);
    for (std::size_t i = 0; i < k; ++i) exact.y[i] -= correction[i];
  }
  exact.parameters = move(exact.y);
  return exact;
}

/// Four control points along the surface, not on it, within `step` of each other; the segment refers to them.
struct Trial {
  std::array<Waypoint, 4> points;
  Segment segment;
};
std::unique_ptr<Trial> random_trial(const Surface& surface, const Prover& prover, Operands& operands) {
  const ConstraintFunctions functions(surface.problem);
  auto trial = std::make_unique<Trial>();
  const double step = std::exp2(-operands.uniform(2, 12));
  std::vector<double> x = {operands.uniform(0.03, 0.1), operands.uniform(0.03, 0.1), operands.uniform(0.2, 0.4),
                           operands.uniform(-0.5, 0.9), operands.uniform(0.1, 0.5),  operands.uniform(-0.5, 0.5)};
  for (Waypoint& waypoint : trial->points) {
    for (double& value : x) value += 0.2 * step * operands.uniform(-1, 1);
    waypoint = {x, {0, 0, 0, 2, 0, 0}};
    waypoint.parameters().x[3] -= 2 * 3.14159265358979323846;
    for (int newton = 0; newton < 8; ++newton) {
      waypoint.parameters().normals = functions.normals(waypoint);
      waypoint.parameters().x = functions.parameters(Segment::straight(waypoint, waypoint), 0);
      waypoint.parameters().x[3] -= 2 * 3.14159265358979323846;  // parameters() has counted the half turns
    }
    for (double& value : waypoint.parameters().x) value += 1e-3 * step * operands.uniform(-1, 1);
  }
  const bool spline = operands.coin(0.5);
  if (spline && operands.coin(0.3)) trial->points[1] = trial->points[2] = trial->points[0];  // where a spline begins
  trial->segment = {spline ? Interpolation::kCubicBSpline : Interpolation::kStraight, {}, 0};
  for (std::size_t i = 0; i < control_points(trial->segment.law); ++i) trial->segment.control[i] = &trial->points[i];
  trial->segment.tube = prover.suitable_tube(trial->segment);
  return trial;
}

template <class Scalar>
class Motion : public ::testing::Test {};
using ProofScalarTraits = ::testing::Types<Fast, Mp128>;
TYPED_TEST_SUITE(Motion, ProofScalarTraits);

TYPED_TEST(Motion, HoldsEverySampleOfABoxAndItsSlopes) {
  using I = typename TypeParam::I;
  for (const Surface& surface : {sphere(), cylinder(), sphere_and_tilt(), curve()}) {
    SCOPED_TRACE(surface.name);
    const Prover prover(surface.problem);
    std::optional<MotionModel<I>> model;
    {
      const PrecisionScope precision(std::max<mpfr_prec_t>(TypeParam::kBits, 128));
      model.emplace(make_motion_model<I>(surface.problem));
    }
    Operands operands(11);
    int known = 0;
    for (int trial_index = 0; trial_index < 60; ++trial_index) {
      const auto trial = random_trial(surface, prover, operands);
      const Segment& segment = trial->segment;
      const int depth = operands.pick(6);
      const double radius = std::ldexp(1.0, -depth - 1);
      const double lower = 2 * radius * operands.pick(1 << depth);
      const double mid = lower + radius;
      const double upper = mid + radius;
      MotionEnclosure<I> motion;
      const bool sound = TypeParam::run(
          [&] { motion = enclose_motion(*model, segment, I(lower, upper), I(mid), I(-radius, radius)); });
      if (!sound || motion.status != MotionEnclosure<I>::Status::kKnown) continue;
      ++known;
      const PrecisionScope precision(oracle::kBits);
      const BigFloat error(1e-45);
      const Vector at_mid = exact_motion(surface, segment, mid).parameters;
      for (const double s : {lower, mid, operands.uniform(lower, upper), upper}) {
        const Exact exact = exact_motion(surface, segment, s);
        for (const BigFloat& y : exact.y) ASSERT_LE(abs(y).to_double(), segment.tube);
        for (std::size_t j = 0; j < 3; ++j) {
          const SlopeForm<I>& p = motion.p_WP(static_cast<int>(j));
          EXPECT_TRUE(holds(p.range, exact.parameters[j], error)) << j << " at " << s << " " << print(p.range);
          EXPECT_TRUE(s != mid || holds(p.at_mid, exact.parameters[j], error)) << j << " " << print(p.at_mid);
          if (s != mid) {
            const BigFloat quotient = (exact.parameters[j] - at_mid[j]) / (BigFloat(s) - BigFloat(mid));
            EXPECT_TRUE(holds(p.slope, quotient, BigFloat(1e-40))) << j << " at " << s;
          }
        }
        const BigFloat &phi = exact.parameters[3], &theta = exact.parameters[4], &sigma = exact.parameters[5];
        EXPECT_TRUE(holds(motion.r_WP(2, 2).range, cos(theta), error));
        EXPECT_TRUE(holds(motion.r_WP(0, 2).range, cos(phi) * sin(theta), error));
        EXPECT_TRUE(holds(motion.r_WP(2, 0).range, -(sin(theta) * cos(sigma - phi)), error));
      }
    }
    EXPECT_GT(known, 20);
  }
}

/// Rows of R(q) for the product of unit quaternions about axes: another route than products of matrices.
campaign::Rows<BigFloat> exact_rotation(const AnglesText& angles, const Vector& x) {
  return campaign::orientation(angles, x[3], x[4], x[5]);
}

TYPED_TEST(Motion, HoldsTheRotationsOfAllAngles) {
  using I = typename TypeParam::I;
  Operands operands(19);
  for (const AnglesText& angles :
       {AnglesText{}, AnglesText{AngleKind::kRollPitchYaw}, AnglesText{AngleKind::kZyz}, AnglesText{AngleKind::kAxis},
        AnglesText{AngleKind::kAxis, {"0.3", "-2", "0.007"}}, AnglesText{AngleKind::kAxis, {"0", "1e-8", "1e8"}}}) {
    SCOPED_TRACE(name(angles.kind));
    Problem problem = robot2_sphere();
    problem.space = coordinate_space(angles);
    problem.query.clear();
    const std::size_t count = problem.space.parameters.size();
    const auto model = [&] {
      const PrecisionScope precision(std::max<mpfr_prec_t>(TypeParam::kBits, 128));
      return make_motion_model<I>(problem);
    }();
    for (int trial = 0; trial < 60; ++trial) {
      const double step = std::exp2(-operands.uniform(0, 12));
      std::array<Waypoint, 2> ends;
      for (Waypoint& end : ends) {
        for (std::size_t j = 0; j < count; ++j) {
          end.parameters().x.push_back(ends[0].parameters().x.size() > j && &end != &ends[0]
                                           ? ends[0].parameters().x[j] + step * operands.uniform(-1, 1)
                                           : operands.uniform(-3, 3));
        }
        end.parameters().half_turns.assign(count, 0);
      }
      if (trial % 4 == 0 && count == 6)
        ends[trial / 4 % 2].parameters().x[4] = std::numbers::pi / 2;  // of pitch: gimbal lock
      const Segment segment = Segment::straight(ends[0], ends[1]);
      const int depth = operands.pick(6);
      const double radius = std::ldexp(1.0, -depth - 1);
      const double lower = 2 * radius * operands.pick(1 << depth);
      const double mid = lower + radius;
      const double upper = mid + radius;
      MotionEnclosure<I> motion;
      const bool sound =
          TypeParam::run([&] { motion = enclose_motion(model, segment, I(lower, upper), I(mid), I(-radius, radius)); });
      ASSERT_TRUE(sound && motion.is_enclosed());
      const PrecisionScope precision(oracle::kBits);
      const auto at = [&](double s) {
        Vector x(6, BigFloat(0.0));
        for (std::size_t j = 0; j < count; ++j) {
          x[j] = mixed(segment, s, [&](const Waypoint& w) { return BigFloat(w.parameters().x[j]); });
        }
        return exact_rotation(angles, x);
      };
      const auto at_mid = at(mid);
      const BigFloat error(1e-45);
      for (const double s : {lower, mid, operands.uniform(lower, upper), upper}) {
        const auto exact = at(s);
        for (std::size_t i = 0; i < 9; ++i) {
          const SlopeForm<I>& r = motion.r_WP(static_cast<int>(i / 3), static_cast<int>(i % 3));
          const BigFloat& expected = exact[i / 3][i % 3];
          EXPECT_TRUE(holds(r.range, expected, error)) << i << " at " << s << " " << print(r.range);
          EXPECT_TRUE(s != mid || holds(r.at_mid, expected, error)) << i << " " << print(r.at_mid);
          if (s == mid) continue;
          const BigFloat quotient = (expected - at_mid[i / 3][i % 3]) / (BigFloat(s) - BigFloat(mid));
          EXPECT_TRUE(holds(r.slope, quotient, BigFloat(1e-40))) << i << " at " << s;
        }
      }
      if (TypeParam::kBits < 128) continue;
      // Tight, too: the midpoint is a point.
      for (int i = 0; i < 9; ++i) EXPECT_LT(spread(motion.r_WP(i / 3, i % 3).at_mid), 1e-30);
    }
  }
}

TYPED_TEST(Motion, IsSecondOrderTight) {
  using I = typename TypeParam::I;
  const Surface surface = sphere();
  const Prover prover(surface.problem);
  const PrecisionScope model_precision(128);
  const auto model = make_motion_model<I>(surface.problem);
  Operands operands(3);
  int tight = 0;
  for (int trial_index = 0; trial_index < 40; ++trial_index) {
    const auto trial = random_trial(surface, prover, operands);
    const auto width = [&](int depth) {
      const double radius = std::ldexp(1.0, -depth - 1);
      MotionEnclosure<I> motion;
      const bool sound = TypeParam::run(
          [&] { motion = enclose_motion(model, trial->segment, I(0.0, 2 * radius), I(radius), I(-radius, radius)); });
      const bool known = sound && motion.status == MotionEnclosure<I>::Status::kKnown;
      return known ? spread(motion.p_WP(2).slope) : std::nan("");
    };
    const double coarse = width(3), fine = width(6);
    if (std::isnan(coarse) || std::isnan(fine)) continue;
    EXPECT_LT(fine, coarse / 4 + 1e-12);  // a slope whose width halves with the box would make 8
    ++tight;
  }
  EXPECT_GT(tight, 20);
}

TEST(Motion, NormalsThatAreMissingOrNotFiniteProveNothing) {
  const Surface surface = sphere();
  const Prover prover(surface.problem);
  Operands operands(5);
  const auto trial = random_trial(surface, prover, operands);
  Segment segment = Segment::straight(trial->points[0], trial->points[0], 0x1p-12);
  ASSERT_NE(prover.judge(segment, {}).kind, BoxVerdict::Kind::kNoMotion);
  for (const double tube : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    segment.tube = tube;
    EXPECT_NE(prover.judge(segment, {}).kind, BoxVerdict::Kind::kProved) << tube;
  }
  segment.tube = 0x1p-12;
  const std::vector<double> good = trial->points[0].parameters().normals;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    trial->points[0].parameters().normals[1] = bad;
    EXPECT_EQ(prover.judge(segment, {}).kind, BoxVerdict::Kind::kNoMotion) << bad;
  }
  trial->points[0].parameters().normals = {};
  EXPECT_EQ(prover.judge(segment, {}).kind, BoxVerdict::Kind::kNoMotion);
  trial->points[0].parameters().normals = good;
  EXPECT_NE(prover.judge(segment, {}).kind, BoxVerdict::Kind::kNoMotion);
}

}  // namespace
}  // namespace taut::testing
