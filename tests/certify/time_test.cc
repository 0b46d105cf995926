// SPDX-License-Identifier: GPL-3.0-or-later
// Time laws, motions in time and what they do to a load: enclosures against sampled times and against quotients of
// differences of 10^-40, at 400 bits, of poses and momenta that are written a second time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "certify/motion/law_range.h"
#include "certify/motion/length_controlled_motion.h"
#include "certify/motion/motion_rates.h"
#include "certify/motion/rates_along.h"
#include "kinematics/moving_load.h"
#include "kinematics/path_rates.h"
#include "kinematics/rates_sampler.h"
#include "tests/oracle/moving.h"
#include "tests/support/enclosing.h"
#include "tests/support/implied_moves.h"
#include "tests/support/segments.h"

namespace taut::testing {
namespace {

using ::testing::HasSubstr;

/// A law over so many segments that begins and ends without a rest of its own.
TimeLaw some_law(std::mt19937_64& random, std::size_t segments, bool stands_still = false) {
  std::uniform_int_distribution<int> jump(1, 1000);
  constexpr double kUnit = 0x1p-12;
  TimeLaw law{0.015625 * jump(random), {}};
  const double first = kUnit * jump(random);
  law.controls = {-first, 0, first};
  while (law.controls.back() < static_cast<double>(segments)) {
    const bool rests = stands_still && random() % 4 == 0;
    for (int k = rests ? 5 : 1; k > 0; --k) law.controls.push_back(law.controls.back());
    law.controls.back() += kUnit * jump(random);
  }
  while (law.controls.back() >= static_cast<double>(segments)) law.controls.pop_back();
  const auto end = static_cast<double>(segments);
  const double last = end - law.controls.back();
  law.controls.insert(law.controls.end(), {end, end + last});
  return law;
}

TEST(TimeLaw, RunsFromEndToEndAndNeverBack) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t segments = 1 + random() % 5;
    const TimeLaw law = some_law(random, segments, trial % 2 == 0);
    ASSERT_EQ(complaint(law, segments), "");
    EXPECT_EQ(at_time(law, 0).s, 0);
    EXPECT_EQ(at_time(law, law.duration_s()).s, segments);
    LawPoint before = at_time(law, 0);
    constexpr int kTimes = 300;
    for (int k = 1; k <= kTimes; ++k) {
      const LawPoint now = at_time(law, law.duration_s() * k / kTimes);
      EXPECT_GE(now.s, before.s - 1e-12);
      EXPECT_GE(now.rate, -1e-12);
      before = now;
    }
    EXPECT_NE(complaint(law, segments + 1), "");
  }
}

TEST(TimeLaw, ThatIsNoneIsNamed) {
  const TimeLaw good{0.5, {-1, 0, 1, 2, 3}};  // (1 + 8 + 3) / 6 = 2
  EXPECT_EQ(complaint(good, 2), "");
  const auto with = [&](auto edit) {
    TimeLaw law = good;
    edit(law);
    return complaint(law, 2);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(with([](TimeLaw& x) { x.step_s = 0; }), HasSubstr("got a step of 0 s, expected a finite time above 0"));
  EXPECT_THAT(with([](TimeLaw& x) { x.step_s = kNan; }), HasSubstr("got a step of nan s"));
  EXPECT_THAT(with([](TimeLaw& x) { x.controls.resize(3); }), HasSubstr("got 3 control values, expected 4 or more"));
  EXPECT_THAT(with([](TimeLaw& x) { x.controls[2] = kNan; }), HasSubstr("control value 2: got nan"));
  EXPECT_THAT(with([](TimeLaw& x) { x.controls[3] = 0.5; }), HasSubstr("control value 3: got 0.5, below the 1 before"));
  EXPECT_THAT(with([](TimeLaw& x) { x.controls[1] = -0x1p-52; }), HasSubstr("the first three control values"));
  EXPECT_THAT(with([](TimeLaw& x) { x.controls[4] += 0x1p-50; }), HasSubstr("expected such with a + 4 b + c = 12"));
}

TEST(TimeLaw, RestsWhereItHasTo) {
  const auto at = [](double x) { return Waypoint{{x, 0, 0, 0, 0, 0}, std::vector<int>(6, 0)}; };
  const auto of = [](std::vector<Waypoint> points, Interpolation law, std::vector<double> controls) {
    Path path{std::move(points), law};
    path.timing = TimeLaw{0.5, std::move(controls)};
    return complaint(path);
  };
  const std::vector<Waypoint> corner = {at(0), at(1), at(0.5)};
  constexpr Interpolation kStraight = Interpolation::kStraight, kSpline = Interpolation::kCubicBSpline;
  EXPECT_EQ(of(corner, kStraight, {0, 0, 0, 0.5, 1, 1, 1, 1.5, 2, 2, 2}), "");
  EXPECT_EQ(of(corner, kStraight, {0, 0, 0, 0.5, 1, 1, 1, 1, 1, 1.5, 2, 2, 2}), "");  // stands still there
  EXPECT_THAT(of(corner, kStraight, {0, 0, 0, 0.5, 1, 1.5, 2, 2, 2}), HasSubstr("three control values of 1, where"));
  EXPECT_THAT(of(corner, kStraight, {-0.25, 0, 0.25, 0.75, 1.25, 1.75, 2, 2.25}),
              HasSubstr("three control values of 0"));
  EXPECT_THAT(of(corner, kStraight, {0, 0, 0, 1, 1, 1, 1.5, 2, 2.5}), HasSubstr("three control values of 2"));
  EXPECT_THAT(of(corner, kStraight, {0, 0, 0, 1, 1, 1, 2, 3, 3, 3}), HasSubstr("expected such with a + 4 b + c = 12"));
  const std::vector<double> moving = {-0.25, 0, 0.25, 0.75, 1, 1.25};
  const std::vector<Waypoint> still = {at(0), at(0), at(0), at(1), at(1), at(1)};
  EXPECT_EQ(of({still.begin(), still.end()}, kSpline, {-1, 0, 1, 2, 3, 4}), "");
  EXPECT_THAT(of({at(0), at(0), at(1), at(1)}, kSpline, moving), HasSubstr("three control values of 0"));
  EXPECT_EQ(of({at(0), at(0), at(1), at(1)}, kSpline, {0, 0, 0, 0.5, 1, 1, 1}), "");
  // Only with its normals a control point that is repeated holds a motion on constraints.
  std::vector<Waypoint> constrained = still;
  for (Waypoint& point : constrained) point.parameters().normals.assign(6, 0.5);
  EXPECT_EQ(of(constrained, kSpline, {-1, 0, 1, 2, 3, 4}), "");
  constrained[2].parameters().normals[5] = 0.25;
  EXPECT_THAT(of(constrained, kSpline, {-1, 0, 1, 2, 3, 4}), HasSubstr("three control values of 0"));
  for (const Interpolation law : {Interpolation::kGeodesic, Interpolation::kCableLengths}) {
    EXPECT_THAT(of({at(0), at(1)}, law, {-0.25, 0, 0.25, 0.75, 1, 1.25}), HasSubstr("three control values of 0"));
    EXPECT_EQ(of({at(0), at(1)}, law, {0, 0, 0, 0.5, 1, 1, 1}), "");
  }
}

template <class Scalar>
class InTime : public ::testing::Test {};
using Scalars = ::testing::Types<Fast, Mp128>;
TYPED_TEST_SUITE(InTime, Scalars);

TYPED_TEST(InTime, LawsAreEnclosedWhereverTheyAre) {
  using I = typename TypeParam::I;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  double widest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t segments = 1 + random() % 3;
    const TimeLaw law = some_law(random, segments, trial % 2 == 0);
    const double t1 = share(random) * law.duration_s(), t2 = t1 + share(random) * 0.1 * (law.duration_s() - t1);
    LawRange<I> range;
    EXPECT_TRUE(
        TypeParam::run([&] { range = law_range<I>(law, time_cover(law, I(at_time(law, t1).s, at_time(law, t2).s))); }));
    const auto is_in = [](const I& x, double value) {
      const double slack = 1e-12 * (1 + std::abs(value));  // of the sample
      return lower_bound(x) <= value + slack && value - slack <= upper_bound(x);
    };
    double least = 1e300, greatest = -1e300;
    constexpr int kTimes = 200;
    for (int k = 0; k <= kTimes; ++k) {
      const LawPoint now = at_time(law, t1 + (t2 - t1) * k / kTimes);
      EXPECT_TRUE(is_in(range.rate, now.rate));
      EXPECT_TRUE(is_in(range.acceleration, now.acceleration));
      least = std::min(least, now.acceleration);
      greatest = std::max(greatest, now.acceleration);
    }
    const double scale = 1 / (law.step_s * law.step_s);
    widest = std::max(widest, (upper_bound(range.acceleration) - lower_bound(range.acceleration)) / scale -
                                  (greatest - least) / scale);
  }
  EXPECT_LT(widest, 0.01);  // not much more than what is sampled
}

/// A few points that have mass.
struct Cloud {
  std::vector<std::array<double, 3>> points;
  std::vector<double> masses;

  [[nodiscard]] double mass() const { return std::accumulate(masses.begin(), masses.end(), 0.0); }
};
/// Of four points whose mass is a power of two, so that all sums here are exact.
Cloud some_cloud(Operands& operands) {
  Cloud cloud;
  for (int k = 0; k < 4; ++k) {
    cloud.masses.push_back(2);
    cloud.points.push_back({operands.pick(64) / 256.0, operands.pick(64) / 256.0, operands.pick(64) / 256.0});
  }
  return cloud;
}
template <class I>
MovingBody<I> body_of(const Cloud& cloud, const Vector3<I>& load_point) {
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  const auto point = [&](std::size_t n) { return Eigen::Vector3d(cloud.points[n].data()); };
  for (std::size_t n = 0; n < cloud.points.size(); ++n) c += cloud.masses[n] * point(n) / cloud.mass();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < cloud.points.size(); ++n) {
    const Eigen::Vector3d r = point(n) - c;
    inertia += cloud.masses[n] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  MovingBody<I> body;
  body.mass = I(cloud.mass());
  for (int k = 0; k < 3; ++k) {
    body.p_PC(k) = I(c(k));
    body.p_MC(k) = I(c(k)) - load_point(k);
    for (int l = 0; l < 3; ++l) body.inertia(k, l) = I(inertia(k, l));
  }
  return body;
}

/// That enclosures at time 0 of a move hold what quotients of differences say.
template <class I>
void expect_as_differences(const Problem& problem, const oracle::Move& move, const Cloud& cloud,
                           const Vector6<I>& wrench, const WinchRates<I>& winches) {
  std::vector<oracle::Particle> particles;
  for (std::size_t n = 0; n < cloud.points.size(); ++n) {
    const auto& [x, y, z] = cloud.points[n];
    particles.push_back({{BigFloat(x), BigFloat(y), BigFloat(z)}, BigFloat(cloud.masses[n])});
  }
  const BigFloat now(0.0);
  const oracle::Big6 sum = move.inertia(particles, oracle::big(problem.load.point_m), now);
  const BigFloat error = oracle::big("1e-30");
  for (int k = 0; k < 6; ++k) EXPECT_TRUE(holds(wrench(k), sum[static_cast<std::size_t>(k)], error)) << k;
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto [speed, change] =
        move.winch(oracle::big(problem.robot.base_anchors_m[i]), oracle::big(problem.robot.platform_anchors_m[i]), now);
    EXPECT_TRUE(holds(winches.speed[i], speed, error));
    EXPECT_TRUE(holds(winches.acceleration[i], change, error));
  }
}

/// w and its first two derivatives as [w] = R' Rᵀ says, of R and its derivatives.
template <class S>
std::array<Vector3<S>, 3> turning_of(const Matrix3<Taylor<S, 3>>& r) {
  std::array<Vector3<S>, 3> w;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 2) % 3, j = (k + 1) % 3;
    Taylor<S, 2> sum(S(0.0));
    for (int l = 0; l < 3; ++l) {
      const auto &a = r(i, l).d, &b = r(j, l).d;
      sum = sum + Taylor<S, 2>({a[1], a[2], a[3]}) * Taylor<S, 2>({b[0], b[1], b[2]});
    }
    for (std::size_t n = 0; n < 3; ++n) w[n](k) = sum.d[n];
  }
  return w;
}

TYPED_TEST(InTime, AnglesTurnAPlatformAsItsMatrixSays) {
  using I = typename TypeParam::I;
  Operands operands(29);
  const std::array<AnglesText, 4> kinds = {{{AngleKind::kTiltAndTorsion},
                                            {AngleKind::kRollPitchYaw},
                                            {AngleKind::kZyz},
                                            {AngleKind::kAxis, {"1", "-2", "0.5"}}}};
  for (int trial = 0; trial < 400; ++trial) {
    const AnglesText& kind = kinds[static_cast<std::size_t>(trial) % kinds.size()];
    std::array<std::array<double, 4>, 3> derivatives;  // at 0
    for (auto& of_angle : derivatives) {
      for (double& x : of_angle) x = operands.uniform(-3, 3);
    }
    const auto angles_at = [&](const auto& u) {
      using S = std::decay_t<decltype(u)>;
      std::array<Taylor<S, 3>, 3> result;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto c = [&](std::size_t n) { return S(derivatives[k][n]); };
        result[k].d = {c(0) + u * (c(1) + u * (c(2) / S(2.0) + u * (c(3) / S(6.0)))),
                       c(1) + u * (c(2) + u * (c(3) / S(2.0))), c(2) + u * c(3), c(3)};
      }
      return result;
    };
    const double radius = operands.pick(2) == 0 ? 0 : 0.02;
    std::array<Vector3<I>, 3> w;
    std::array<Vector3<I>, 2> fewer;
    ASSERT_TRUE(TypeParam::run([&] {
      const Angles<I> angles = make_angles<I>(kind);
      const std::array<Taylor<I, 3>, 3> x = angles_at(I(-radius, radius));
      const Matrix3<I> r_WP = rotation(angles, std::array<I, 3>{x[0].d[0], x[1].d[0], x[2].d[0]});
      w = turning<3>(angles, x, r_WP);
      std::array<Taylor<I, 2>, 3> y;
      for (std::size_t k = 0; k < 3; ++k) y[k].d = {x[k].d[0], x[k].d[1], x[k].d[2]};
      fewer = turning<2>(angles, y, r_WP);
    }));

    using Fine = MpInterval;
    const PrecisionScope precision(400);
    const Angles<Fine> angles = make_angles<Fine>(kind);
    const auto expected = turning_of(rotation(angles, angles_at(Fine(radius * operands.uniform(-1, 1)))));
    const BigFloat error = oracle::big("1e-100");
    for (std::size_t n = 0; n < 3; ++n) {
      for (int k = 0; k < 3; ++k) {
        const BigFloat value = lower_end(expected[n](k));
        EXPECT_TRUE(holds(w[n](k), value, error)) << name(kind.kind) << ", derivative " << n << ", axis " << k;
        EXPECT_TRUE(n == 2 || holds(fewer[n](k), value, error));
        EXPECT_TRUE(radius > 0 || spread(w[n](k)) < 1e-11);
      }
    }
  }
}

TYPED_TEST(InTime, LoadsAndWinchesMoveAsDifferencesSay) {
  using I = typename TypeParam::I;
  const std::vector<Space> spaces = {slice_space(), sphere_space(), free_space(robot2_sphere()), curved_space()};
  Operands operands(17);
  int enclosed = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Space& space = spaces[static_cast<std::size_t>(trial) % spaces.size()];
    const RandomSegment ends = random_segment(space, operands);
    const double s = operands.uniform(0, 1), rate = operands.uniform(0, 2), acceleration = operands.uniform(-2, 2);
    const double radius = operands.pick(2) == 0 ? 0 : std::min({0.01, s, 1 - s});
    const Cloud cloud = some_cloud(operands);
    const Segment segment = Segment::straight(ends.a, ends.b);

    Vector6<I> wrench;
    WinchRates<I> winches;
    const bool is_sound = TypeParam::run([&] {
      const Model<I> model = make_model_without_ellipsoid<I>(space.problem);
      const PathRates<I> path = PathRatesModel<I, 2>(space.problem).along_curve(segment, I(s - radius, s + radius));
      const Rates<I> rates = by_time(path, I(rate), I(acceleration));
      wrench = inertial_wrench<I>({body_of<I>(cloud, model.p_PM)}, path.r_WP, rates);
      winches = winch_rates(model, path.p, path.r_WP, rates);
    });
    if (!is_sound) continue;
    ++enclosed;

    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move move([&](const BigFloat& tau) {
      const BigFloat place = BigFloat(s) + tau * (BigFloat(rate) + BigFloat(acceleration) * tau / BigFloat(2.0));
      return space.pose(parameters_at(ends.a, ends.b, place));
    });
    expect_as_differences(space.problem, move, cloud, wrench, winches);
    if (radius == 0) {
      const BigFloat width = upper_end(wrench(0)) - lower_end(wrench(0));
      EXPECT_LT(width.to_double(MPFR_RNDN), 1e-9);
    }
  }
  EXPECT_GT(enclosed, kTrials * 9 / 10);
}

TYPED_TEST(InTime, MotionsThatAreImpliedMoveAsDifferencesSay) {
  using I = typename TypeParam::I;
  Operands operands(23);
  std::array<int, ImpliedMove::kKinds> enclosed{};
  double widest = 0;
  constexpr int kTrials = 64;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto kind = static_cast<std::size_t>(trial % ImpliedMove::kKinds);
    const ImpliedMove implied(operands, static_cast<ImpliedMove::Kind>(kind), 0.2);
    const auto k = static_cast<std::size_t>(operands.pick(static_cast<int>(implied.path.segments())));
    const Segment segment = implied.path.segment(k);
    const double s = operands.uniform(0.01, 0.99), rate = operands.uniform(0, 2), change = operands.uniform(-2, 2);
    const double radius = operands.coin(0.5) ? 0 : 0.004;
    const Cloud cloud = some_cloud(operands);
    const Problem& problem = implied.machine.problem;
    std::optional<ThirdPathRates<I>> path;
    Vector6<I> wrench;
    WinchRates<I> winches;
    const MotionModel<I> motions = make_motion_model<I>(problem);
    const bool is_known = operands.coin(0.5);
    const bool is_sound = TypeParam::run([&] {
      const Model<I> model = make_model_without_ellipsoid<I>(problem);
      const I range(s - radius, s + radius), mid(s), offset = range - mid;
      MotionEnclosure<I> motion;
      if (is_known && segment.law == Interpolation::kCableLengths) {
        motion = forward_kinematics(model, segment, range, mid, offset);
      } else if (is_known) {
        motion = enclose_motion(motions, segment, range, mid, offset);
      }
      const KnownMotion<I> known{motion, mid};
      const MotionRates<I> rates_of(problem);
      const auto over = rates_of.over(model, segment, range, motion.is_enclosed() ? &known : nullptr);
      if (over) path = over->path;
      if (!path) return;
      const Rates<I> rates = by_time(*path, I(rate), I(change));
      wrench = inertial_wrench<I>({body_of<I>(cloud, model.p_PM)}, path->r_WP, rates);
      winches = winch_rates(model, path->p, path->r_WP, rates);
    });
    if (!is_sound || !path) continue;
    ++enclosed[kind];

    const PrecisionScope precision(oracle::kMovingBits);
    // In the middle of the part and elsewhere in it.
    for (const double at : {s, s + radius * operands.uniform(-1, 1)}) {
      const oracle::Move move([&](const BigFloat& tau) {
        const BigFloat along = tau * (BigFloat(rate) + BigFloat(change) * tau / BigFloat(2.0));
        return implied.pose(BigFloat(static_cast<double>(k)) + BigFloat(at) + along);
      });
      expect_as_differences(problem, move, cloud, wrench, winches);
    }
    if (radius > 0) continue;
    for (int c = 0; c < 6; ++c) widest = std::max(widest, spread(wrench(c)));
    const PathRates<double> sampled = RatesSampler(problem).at(segment, s);
    const auto expect_near = [](const Vector3<I>& said, const Vector3<double>& seen) {
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(holds(said(c), BigFloat(seen(c)), BigFloat(1e-8 * (1 + seen.norm()))));
    };
    expect_near(path->p, sampled.p);
    expect_near(path->p1, sampled.p1);
    expect_near(path->p2, sampled.p2);
    expect_near(path->w, sampled.w);
    expect_near(path->w1, sampled.w1);
  }
  for (const int count : enclosed) EXPECT_GT(count, kTrials / ImpliedMove::kKinds * 3 / 4);
  EXPECT_LT(widest, 1e-7);
}

/// A rate of a move at time 0, without its sign.
BigFloat size_of(const Problem& problem, const oracle::Move& move, const RateId& id) {
  const BigFloat now(0.0);
  const oracle::Big3 none = {now, now, now};
  const bool of_speed = is_speed(id.kind);
  if (is_of_winch(id.kind)) {
    const auto i = static_cast<std::size_t>(id.cable);
    const auto [speed, change] =
        move.winch(oracle::big(problem.robot.base_anchors_m[i]), oracle::big(problem.robot.platform_anchors_m[i]), now);
    return abs(of_speed ? speed : change);
  }
  if (id.kind == RateKind::kLoadSpeed || id.kind == RateKind::kLoadAcceleration) {
    const auto [velocity, acceleration] = move.rates(oracle::big(problem.load.point_m), now);
    return oracle::distance(of_speed ? velocity : acceleration, none);
  }
  // ω = Σ e × ė / 2 of the three axes e of P, and its derivative Σ e × ë / 2.
  oracle::Big3 sum = none;
  const oracle::Big3 origin = oracle::place(move.pose(now), none);
  const auto at_origin = move.rates(none, now);
  for (std::size_t k = 0; k < 3; ++k) {
    oracle::Big3 axis = none;
    axis[k] = BigFloat(1.0);
    const auto at_tip = move.rates(axis, now);
    oracle::Big3 e = oracle::place(move.pose(now), axis), rate = of_speed ? at_tip.first : at_tip.second;
    for (std::size_t j = 0; j < 3; ++j) {
      e[j] -= origin[j];
      rate[j] -= (of_speed ? at_origin.first : at_origin.second)[j];
    }
    const oracle::Big3 moment = oracle::cross(e, rate);
    for (std::size_t j = 0; j < 3; ++j) sum[j] += moment[j] / BigFloat(2.0);
  }
  return oracle::distance(sum, none);
}

TYPED_TEST(InTime, RatesAlongAPartAreThoseOfEachOfItsPlaces) {
  using I = typename TypeParam::I;
  Operands operands(29);
  std::vector<RateId> ids;
  for (int cable = 0; cable < 6; ++cable) {
    ids.push_back({RateKind::kWinchSpeed, cable});
    ids.push_back({RateKind::kWinchAcceleration, cable});
  }
  for (const RateKind kind : {RateKind::kLoadSpeed, RateKind::kLoadAcceleration, RateKind::kLoadAngularSpeed,
                              RateKind::kLoadAngularAcceleration}) {
    ids.push_back({kind, 0});
  }
  constexpr int kTrials = 100, kKinds = ImpliedMove::kKinds + 1;
  std::array<int, kKinds> enclosed{};
  std::array<double, 2> widths{};  // without the middle, and with it
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto kind = static_cast<std::size_t>(trial % kKinds);
    const bool is_implied = kind < ImpliedMove::kKinds;
    std::optional<ImpliedMove> implied;
    std::optional<MovingMachine> machine;
    Path path;
    if (is_implied) {
      implied.emplace(operands, static_cast<ImpliedMove::Kind>(kind), 0.2);
      path = implied->path;
    } else {
      machine.emplace(operands);
      path = some_move(operands, 0.2);
    }
    const Problem& problem = is_implied ? implied->machine.problem : machine->problem;
    const auto k = static_cast<std::size_t>(operands.pick(static_cast<int>(path.segments())));
    const Segment segment = path.segment(k);
    const double radius = operands.coin(0.5) ? 0.002 : 0.02;
    const double s = operands.uniform(0.03, 0.97), rate = operands.uniform(0, 2), change = operands.uniform(-2, 2);
    // A piece of the part, and a place in it.
    const double from = s + radius * operands.uniform(-1, 1), size = radius * operands.uniform(0, 0.2);
    const double to = std::min(from + size, s + radius), place = std::min(to, from + size * operands.uniform(0, 1));
    std::array<std::vector<I>, 2> said;
    const bool is_sound = TypeParam::run([&] {
      const Model<I> model = make_model_without_ellipsoid<I>(problem);
      const MotionRates<I> rates(problem);
      auto along = RatesAlong<I>::over(rates, model, segment, I(s - radius, s + radius));
      if (!along) return;
      for (std::vector<I>& sizes : said) {
        for (const RateId& id : ids) sizes.push_back(along->magnitude(id, I(from, to), {I(rate), I(change)}));
        along->look_at_middle();
      }
    });
    if (!is_sound || said[1].empty()) continue;
    ++enclosed[kind];

    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move move([&](const BigFloat& tau) {
      const BigFloat at = BigFloat(static_cast<double>(k)) + BigFloat(place) +
                          tau * (BigFloat(rate) + BigFloat(change) * tau / BigFloat(2.0));
      return is_implied ? implied->pose(at) : pose_on_path(path, at);
    });
    for (std::size_t n = 0; n < ids.size(); ++n) {
      const BigFloat truth = size_of(problem, move, ids[n]);
      for (std::size_t with = 0; with < 2; ++with) {
        EXPECT_TRUE(holds(said[with][n], truth, oracle::big("1e-30"))) << name(ids[n].kind) << " of kind " << kind;
        widths[with] += spread(said[with][n]);
      }
    }
  }
  for (const int count : enclosed) EXPECT_GT(count, kTrials / kKinds * 3 / 4);
  EXPECT_LT(widths[1], 0.25 * widths[0]);
}

TYPED_TEST(InTime, AGeodesicThatMayBeHalfATurnHasNoRates) {
  using I = typename TypeParam::I;
  const Problem problem = free_flying(robot2_sphere());
  const auto pose = [](double qz, double qw) { return Waypoint(PosePoint{{0, 0, 0.3, 0, 0, qz, qw}}); };
  const auto are_known = [&](const Waypoint& a, const Waypoint& b) {
    bool result = false;
    const bool is_sound = TypeParam::run([&] {
      const Model<I> model = make_model_without_ellipsoid<I>(problem);
      result = MotionRates<I>(problem)
                   .over(model, Segment::between(Interpolation::kGeodesic, a, b), I(0.25, 0.5))
                   .has_value();
    });
    return is_sound && result;
  };
  EXPECT_FALSE(are_known(pose(0, 1), pose(1, 0)));
  EXPECT_TRUE(are_known(pose(0, 1), pose(1, 0x1p-20)));
  EXPECT_TRUE(are_known(pose(0, 1), pose(0, 1)));  // no turn at all
  EXPECT_TRUE(are_known(pose(0.5, 1), pose(-1, -2)));
}

}  // namespace
}  // namespace taut::testing
