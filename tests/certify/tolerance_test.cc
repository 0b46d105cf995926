// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/tolerance/tolerance.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

#include "certify/path_proof.h"
#include "kinematics/quaternion.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::at;
using testing::robot1_slice;

/// A deviation in binary64: the machine, and what tracking adds.
struct Deviated {
  Model<double> model;
  Vector3<double> shift = Vector3<double>::Zero();
  Vector3<double> turn = Vector3<double>::Zero();  ///< rotation vector
  std::array<double, kCables> length_error{};
};

Vector3<double> random_in_ball(std::mt19937& random, double radius, bool at_the_rim) {
  std::normal_distribution<double> normal;
  Vector3<double> x(normal(random), normal(random), normal(random));
  const double size = at_the_rim ? 1.0 : std::cbrt(std::uniform_real_distribution<double>(0, 1)(random));
  return x.normalized() * (radius * size);
}

double number(const std::string& text) { return ScalarTraits<double>::from_decimal(text); }

bool has_rows(const Problem& problem) { return problem.time && problem.time->rows; }

Deviated random_deviation(const Problem& problem, std::mt19937& random) {
  const TolerancesText& t = *problem.tolerances;
  Deviated result{make_model<double>(problem)};
  const bool rim = random() % 4 != 0;
  std::uniform_real_distribution<double> sign(-1, 1);
  const auto pick = [&](double size) { return rim ? std::copysign(size, sign(random)) : size * sign(random); };
  const Vector3<double> load_point = random_in_ball(random, number(t.load_point_m), rim);
  result.model.p_PM += load_point;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.model.p_WA[i] += random_in_ball(random, number(t.base_anchor_m[i]), rim);
    result.model.p_PB[i] += random_in_ball(random, number(t.platform_anchor_m[i]), rim);
    result.model.p_MB[i] = result.model.p_PB[i] - result.model.p_PM;
    double length = t.cable_length_m ? number((*t.cable_length_m)[i]) : 0;
    if (has_rows(problem)) length += number(problem.time->rows->error_m[i]);
    result.length_error[i] = pick(length);
  }
  const double load = pick(1.0);
  for (int k = 0; k < 6; ++k) result.model.wrench(k) += load * number(t.wrench[static_cast<std::size_t>(k)]);
  result.shift = random_in_ball(random, number(t.position_m), rim);
  result.turn = random_in_ball(random, evaluate_constant<double>(t.orientation_rad), rim);
  return result;
}

/// The pose that a deviation leads to from the commanded one.
RigidPose deviated_pose(const Problem& problem, const Deviated& deviated, const RigidPose& undisturbed) {
  RigidPose pose = undisturbed;
  const bool is_held = problem.tolerances->cable_length_m.has_value();
  if (is_held || has_rows(problem)) {
    const Model<double> typed = make_model<double>(problem);
    std::array<double, kCables> wanted = cable_lengths(typed, undisturbed);
    for (std::size_t i = 0; i < kCables; ++i) wanted[i] += deviated.length_error[i];
    const auto held = pose_of_lengths(is_held ? deviated.model : typed, wanted, undisturbed);
    EXPECT_TRUE(held.has_value());
    pose = *held;
  }
  pose.p += deviated.shift;
  if (deviated.turn.norm() > 0) {
    pose.q = Eigen::AngleAxisd(deviated.turn.norm(), deviated.turn.normalized()) * pose.q;
  }
  return pose;
}

struct Least {
  double tension = 1e300;
  double length = 1e300;
  double scale = 1e300;
};

void update(Least& least, const Model<double>& model, const RigidPose& pose) {
  const Statics<double> s = statics(model, pose.p, Matrix3<double>(pose.q.toRotationMatrix()));
  for (std::size_t i = 0; i < kCables; ++i) {
    least.tension = std::min({least.tension, s.tension[i] - s.tension_below[i] - model.tension_lower[i],
                              model.tension_upper[i] - s.tension[i] - s.tension_above[i]});
    least.length = std::min({least.length, s.length[i] - model.length_lower[i], model.length_upper[i] - s.length[i]});
  }
  least.scale = std::min(least.scale, wrench_scale_approx(model, s));
}

using Edit = std::function<void(TolerancesText&)>;

/// Lets lengths run straight between rows.
void run_straight(Problem& problem) {
  TimeText& time = problem.time.emplace();
  time.winch_acceleration_m_s2.fill("1");
  problem.load.items = {{"of a mass without weight", Weight{"1", "1", {"0", "0", "0"}, "0", std::nullopt}}};
  time.rows = RowsText{"0.001", {"0.0003", "0.0002", "0.0003", "0.0003", "0.0001", "0.0003"}};
}

/// One kind alone, or all together, of sizes that matter.
const std::vector<std::pair<const char*, Edit>>& kinds() {
  static const std::vector<std::pair<const char*, Edit>> kKinds = {
      {"base anchors", [](TolerancesText& t) { t.base_anchor_m.fill("0.0004"); }},
      {"platform anchors", [](TolerancesText& t) { t.platform_anchor_m.fill("0.0003"); }},
      {"load point", [](TolerancesText& t) { t.load_point_m = "0.001"; }},
      {"load", [](TolerancesText& t) { t.wrench = {"0.001", "0", "0.01", "0", "0.0002", "0"}; }},
      {"position", [](TolerancesText& t) { t.position_m = "0.001"; }},
      {"orientation", [](TolerancesText& t) { t.orientation_rad = "(0.3)*pi/180"; }},
      {"lengths",
       [](TolerancesText& t) { t.cable_length_m = {"0.0003", "0.0002", "0.0003", "0.0003", "0", "0.0003"}; }},
      {"anchors of a machine held by lengths",
       [](TolerancesText& t) {
         t.cable_length_m = {"0", "0", "0", "0", "0", "0"};
         t.base_anchor_m.fill("0.0001");
         t.platform_anchor_m.fill("0.0001");
       }},
      {"rows", [](TolerancesText&) {}},
      {"rows of a machine whose anchors and platform are off",
       [](TolerancesText& t) {
         t.base_anchor_m.fill("0.0003");
         t.platform_anchor_m.fill("0.0003");
         t.position_m = "0.0002";
         t.orientation_rad = "0.001";
       }},
      {"rows of a machine held by lengths",
       [](TolerancesText& t) {
         t.cable_length_m = {"0.0001", "0", "0.0001", "0.0001", "0.0001", "0.0001"};
         t.platform_anchor_m.fill("0.0001");
       }},
      {"all",
       [](TolerancesText& t) {
         t.base_anchor_m.fill("0.0001");
         t.platform_anchor_m.fill("0.0001");
         t.load_point_m = "0.0003";
         t.wrench[2] = "0.005";
         t.position_m = "0.0002";
         t.orientation_rad = "0.001";
         t.cable_length_m = {"0.0001", "0.0001", "0.0001", "0.0001", "0.0001", "0.0001"};
       }},
  };
  return kKinds;
}

/// Margins claimed with tolerances hold for sampled deviations, and are not far below the least that sampling finds.
TEST(Tolerance, MarginsHoldForEveryDeviationAndAreTight) {
  for (const auto& [name, edit] : kinds()) {
    Problem problem = robot1_slice();
    const Waypoint a = at({0.5, 0.2});
    const Waypoint b = at({0.56, 0.27});
    const SegmentProof undisturbed = Prover(problem).prove(a, b);
    ASSERT_EQ(undisturbed.verdict, Verdict::kProved);
    edit(problem.tolerances.emplace());
    if (std::string_view(name).find("rows") != std::string_view::npos) run_straight(problem);
    const Prover prover(problem);
    const Segment segment = prover.segment(a, b);
    const SegmentProof proof = prover.prove(segment);
    ASSERT_EQ(proof.verdict, Verdict::kProved) << name << ": " << proof.reason;
    EXPECT_LT(proof.boxes.size(), 20U) << name;
    RecordProperty(name, static_cast<int>(proof.boxes.size()));

    const PoseSampler sampler(problem);
    std::mt19937 random(7);
    Least least;
    Least without;
    for (int k = 0; k < 20000; ++k) {
      const double s = k % 3 == 0 ? k % 2 : std::uniform_real_distribution<double>(0, 1)(random);
      const Deviated deviated = random_deviation(problem, random);
      update(least, deviated.model, deviated_pose(problem, deviated, sampler.rigid_pose(segment, s)));
      update(without, sampler.model(), sampler.rigid_pose(segment, s));
    }
    EXPECT_LE(proof.tension_N, least.tension + 1e-12) << name;
    EXPECT_LE(proof.length_m, least.length + 1e-12) << name;
    EXPECT_LE(proof.wrench_scale, least.scale + 1e-9) << name;
    // Random deviations find a sixth to all of what the worst one does.
    const double found = without.tension - least.tension;
    const double allowed = undisturbed.tension_N - proof.tension_N;
    EXPECT_LT(allowed, 6 * found + 1e-6) << name << ": tension " << undisturbed.tension_N << " " << proof.tension_N
                                         << " sampled " << least.tension;
  }
}

/// The gradient of a margin by finite differences, and along it the worst deviation to first order.
TEST(Tolerance, ABoundIsReachedToFirstOrderByTheWorstDeviation) {
  Problem problem = robot1_slice();
  const Waypoint a = at({0.5, 0.2});
  const double undisturbed = Prover(problem).prove(a, a).tension_N;
  constexpr double kSize = 1e-5;
  const Model<double> nominal = make_model<double>(problem);
  const PoseSampler sampler(problem);
  const RigidPose pose = sampler.rigid_pose(Segment::straight(a, a), 0);
  const auto margin = [&](const Model<double>& model, const RigidPose& where) {
    Least least;
    update(least, model, where);
    return least.tension;
  };
  const auto check = [&](const char* name, const Edit& edit, double worst) {
    Problem disturbed = problem;
    edit(disturbed.tolerances.emplace());
    const double proved = Prover(disturbed).prove(a, a).tension_N;
    EXPECT_LE(proved, undisturbed - worst * 0.999) << name;
    EXPECT_NEAR(proved, undisturbed - worst, 0.08 * worst + 1e-10) << name;
  };
  const auto slope = [&](const std::function<void(Model<double>&, RigidPose&, double)>& move) {
    const auto moved = [&](double step) {
      Model<double> model = nominal;
      RigidPose where = pose;
      move(model, where, step);
      for (std::size_t i = 0; i < kCables; ++i) model.p_MB[i] = model.p_PB[i] - model.p_PM;
      return margin(model, where);
    };
    return (moved(1e-6) - moved(-1e-6)) / 2e-6;
  };
  Vector3<double> by_position, by_load_point, by_turn;
  double by_base = 0;
  double by_platform = 0;
  for (std::size_t i = 0; i < kCables; ++i) {
    Vector3<double> base, platform;
    for (int k = 0; k < 3; ++k) {
      base(k) = slope([&](Model<double>& m, RigidPose&, double x) { m.p_WA[i](k) += x; });
      platform(k) = slope([&](Model<double>& m, RigidPose&, double x) { m.p_PB[i](k) += x; });
    }
    by_base += base.norm();
    by_platform += platform.norm();
  }
  for (int k = 0; k < 3; ++k) {
    by_position(k) = slope([&](Model<double>&, RigidPose& p, double x) { p.p(k) += x; });
    by_load_point(k) = slope([&](Model<double>& m, RigidPose&, double x) { m.p_PM(k) += x; });
    by_turn(k) = slope(
        [&](Model<double>&, RigidPose& p, double x) { p.q = Eigen::AngleAxisd(x, Vector3<double>::Unit(k)) * p.q; });
  }
  check(
      "base", [](TolerancesText& t) { t.base_anchor_m.fill("1e-5"); }, kSize * by_base);
  check(
      "platform", [](TolerancesText& t) { t.platform_anchor_m.fill("1e-5"); }, kSize * by_platform);
  check(
      "position", [](TolerancesText& t) { t.position_m = "1e-5"; }, kSize * by_position.norm());
  check(
      "load point", [](TolerancesText& t) { t.load_point_m = "1e-5"; }, kSize * by_load_point.norm());
  check(
      "orientation", [](TolerancesText& t) { t.orientation_rad = "1e-5"; }, kSize * by_turn.norm());

  // Held by lengths: what each length, and each anchor of such a machine, does to the pose and so to the margin.
  const std::array<double, kCables> held = cable_lengths(nominal, pose);
  const auto slope_held = [&](const std::function<void(Model<double>&, std::array<double, kCables>&, double)>& move) {
    const auto moved = [&](double step) {
      Model<double> model = nominal;
      std::array<double, kCables> wanted = held;
      move(model, wanted, step);
      for (std::size_t i = 0; i < kCables; ++i) model.p_MB[i] = model.p_PB[i] - model.p_PM;
      return margin(model, pose_of_lengths(model, wanted, pose).value());
    };
    return (moved(1e-6) - moved(-1e-6)) / 2e-6;
  };
  double by_length = 0;
  double by_base_held = 0;
  double by_platform_held = 0;
  for (std::size_t i = 0; i < kCables; ++i) {
    by_length += std::abs(slope_held([&](Model<double>&, auto& wanted, double x) { wanted[i] += x; }));
    Vector3<double> base, platform;
    for (int k = 0; k < 3; ++k) {
      base(k) = slope_held([&](Model<double>& m, auto&, double x) { m.p_WA[i](k) += x; });
      platform(k) = slope_held([&](Model<double>& m, auto&, double x) { m.p_PB[i](k) += x; });
    }
    by_base_held += base.norm();
    by_platform_held += platform.norm();
  }
  const auto lengths_of = [](const char* size) {
    std::array<DecimalText, kCables> result;
    result.fill(size);
    return result;
  };
  check(
      "lengths", [&](TolerancesText& t) { t.cable_length_m = lengths_of("1e-5"); }, kSize * by_length);
  check(
      "base, held",
      [&](TolerancesText& t) {
        t.cable_length_m = lengths_of("0");
        t.base_anchor_m.fill("1e-5");
      },
      kSize * by_base_held);
  check(
      "platform, held",
      [&](TolerancesText& t) {
        t.cable_length_m = lengths_of("0");
        t.platform_anchor_m.fill("1e-5");
      },
      kSize * by_platform_held);
}

/// A turn by ε changes |d_i| by no more than ε |b_i|, and to first order by ε |R b_i × u_i|: whatever is less.
TEST(Tolerance, LengthsChangeByTheLesserOfTwoBounds) {
  constexpr double kTurn = 1e-3;
  Problem problem = robot1_slice();
  problem.tolerances.emplace().orientation_rad = "0.001";
  const Waypoint waypoint = at({0.5, 0.2});
  const Segment segment = Segment::straight(waypoint, waypoint);
  const PoseSampler sampler(problem);
  const RigidPose pose = sampler.rigid_pose(segment, 0);
  const Model<double>& model = sampler.model();

  const PrecisionScope precision(128);
  const ProofModel<MpInterval> proof_model = make_mp_proof_model(problem);
  Faults<MpInterval>::clear();
  const BoxEnclosure<MpInterval> box = enclose_box(proof_model, segment, DyadicBox{});
  ASSERT_FALSE(Faults<MpInterval>::raised());
  ASSERT_TRUE(box.disturbance);

  std::size_t steepest = 0;  // the cable whose two bounds differ most
  double least_ratio = 1;
  std::array<double, kCables> proved{};
  const std::array<double, kCables> lengths = cable_lengths(model, pose);
  for (std::size_t i = 0; i < kCables; ++i) {
    const Vector3<double> reach = pose.q * model.p_PB[i];
    const Vector3<double> d = pose.p + reach - model.p_WA[i];
    const double first_order = kTurn * reach.cross(d.normalized()).norm();
    proved[i] = ProofScalarTraits<MpInterval>::to_double(box.disturbance->length[i]);
    EXPECT_GE(proved[i], first_order) << i;
    EXPECT_LE(proved[i], 1.05 * first_order) << i;
    EXPECT_LE(proved[i], kTurn * reach.norm() * (1 + 1e-12)) << i;
    const double ratio = proved[i] / (kTurn * reach.norm());
    if (ratio < least_ratio) {
      least_ratio = ratio;
      steepest = i;
    }
  }
  EXPECT_LT(least_ratio, 0.9) << "no cable for which the second bound is the lesser one";

  std::mt19937 random(3);
  for (int k = 0; k < 2000; ++k) {
    const Deviated deviated = random_deviation(problem, random);
    const std::array<double, kCables> now = cable_lengths(deviated.model, deviated_pose(problem, deviated, pose));
    for (std::size_t i = 0; i < kCables; ++i) EXPECT_LE(std::abs(now[i] - lengths[i]), proved[i]) << i;
  }

  // A limit that the first bound would reach, and the second does not.
  const double far = kTurn * model.p_PB[steepest].norm();
  ASSERT_GT(far, proved[steepest]);
  problem.robot.length_m[steepest].lower = fmt::format("{:.12f}", lengths[steepest] - 0.5 * (far + proved[steepest]));
  EXPECT_EQ(Prover(problem).prove(segment).verdict, Verdict::kProved);
}

/// With more continuation steps, deviations are enclosed more tightly, and tolerances may be larger; what is proved
/// with them holds all the same.
/// At one pose, where boxes take nothing: the worst of all corners of the errors of lengths, of the robot as typed, and
/// of anchors besides.
TEST(Tolerance, RowsTakeWhatTheirLengthsLeadTo) {
  for (const char* const anchors : {"0", "0.00001"}) {
    Problem problem = robot1_slice();
    const Waypoint a = at({0.5, 0.2});
    const double undisturbed = Prover(problem).prove(a, a).tension_N;
    problem.tolerances.emplace();
    problem.tolerances->base_anchor_m.fill(anchors);
    const double before = Prover(problem).prove(a, a).tension_N;
    run_straight(problem);
    for (DecimalText& error : problem.time->rows->error_m) error = "0.00001";
    const double proved = Prover(problem).prove(a, a).tension_N;
    const Model<double> typed = make_model<double>(problem);
    const RigidPose pose = PoseSampler(problem).rigid_pose(Segment::straight(a, a), 0);
    Least least;
    for (unsigned corner = 0; corner < 64; ++corner) {
      std::array<double, kCables> lengths = cable_lengths(typed, pose);
      for (std::size_t i = 0; i < kCables; ++i) lengths[i] += (corner >> i & 1U) != 0 ? 1e-5 : -1e-5;
      const auto led = pose_of_lengths(typed, lengths, pose);
      ASSERT_TRUE(led);
      update(least, typed, *led);
    }
    const double taken = undisturbed - least.tension;
    EXPECT_GT(taken, 1e-5);
    EXPECT_LE(proved, before - 0.999 * taken);
    EXPECT_GE(proved, before - 1.1 * taken);
  }
}

TEST(Tolerance, MoreContinuationStepsProveLargerOnes) {
  const DyadicBox whole{0, 0};
  const auto scaled = [](double factor) {
    Problem problem = robot1_slice();
    TolerancesText& t = problem.tolerances.emplace();
    const auto size = [factor](double x) { return fmt::format("{:.9f}", factor * x); };
    t.base_anchor_m.fill(size(2e-4));
    t.platform_anchor_m.fill(size(2e-4));
    t.position_m = size(2e-4);
    t.orientation_rad = size(1e-3);
    t.cable_length_m.emplace().fill(size(2e-4));
    return problem;
  };
  const Waypoint a = at({0.5, 0.2});
  const Waypoint b = at({0.501, 0.2});
  const Segment segment = Prover(scaled(1)).segment(a, b);
  double largest = 0;
  BoxVerdict verdict;
  for (const int steps : {1, 4, kMostContinuationSteps}) {
    double proved = 0;
    for (double factor = 1; factor < 100; factor *= 1.05) {
      const BoxVerdict here = judge_box(make_proof_model(scaled(factor)), segment, whole, 0, steps);
      if (here.kind != BoxVerdict::Kind::kProved) break;
      proved = factor;
      verdict = here;
    }
    EXPECT_GT(proved, 1.05 * largest) << steps;
    largest = proved;
  }
  const Problem problem = scaled(largest);
  // Where the platform hardly moves, narrower boxes would not do; more steps do.
  EXPECT_EQ(Prover(problem).prove(segment).boxes.size(), 1U);
  const PoseSampler sampler(problem);
  std::mt19937 random(11);
  Least least;
  for (int k = 0; k < 20000; ++k) {
    const Deviated deviated = random_deviation(problem, random);
    update(least, deviated.model, deviated_pose(problem, deviated, sampler.rigid_pose(segment, 0.5)));
  }
  EXPECT_LE(verdict.tension_N, least.tension + 1e-12);
  EXPECT_LE(verdict.length_m, least.length + 1e-12);
  EXPECT_LE(verdict.wrench_scale, least.scale + 1e-9);
}

TEST(Tolerance, TooLargeOnesAreSoonDoneWith) {
  for (const auto& [name, edit] : std::vector<std::pair<const char*, Edit>>{
           {"position", [](TolerancesText& t) { t.position_m = "0.5"; }},
           {"base", [](TolerancesText& t) { t.base_anchor_m.fill("0.2"); }},
           {"orientation", [](TolerancesText& t) { t.orientation_rad = "0.9"; }},
           {"load", [](TolerancesText& t) { t.wrench[2] = "2"; }},
           {"lengths", [](TolerancesText& t) { t.cable_length_m.emplace().fill("0.2"); }}}) {
    Problem problem = robot1_slice();
    edit(problem.tolerances.emplace());
    const SegmentProof proof = Prover(problem).prove(at({0.5, 0.2}), at({0.56, 0.27}));
    EXPECT_NE(proof.verdict, Verdict::kProved) << name;
    EXPECT_LT(proof.boxes_judged, 100) << name << ": " << proof.reason;
  }
}

/// Of sizes between what is proved and what is hopeless, most are refuted by a machine that the witness states.
TEST(Tolerance, AreRefutedByADeviationThatIsWithinThem) {
  for (const auto& [name, edit] : std::vector<std::pair<const char*, Edit>>{
           {"position", [](TolerancesText& t) { t.position_m = "0.03"; }},
           {"base", [](TolerancesText& t) { t.base_anchor_m.fill("0.02"); }},
           {"platform", [](TolerancesText& t) { t.platform_anchor_m.fill("0.012"); }},
           {"orientation", [](TolerancesText& t) { t.orientation_rad = "0.2"; }},
           {"load point", [](TolerancesText& t) { t.load_point_m = "0.03"; }},
           {"load", [](TolerancesText& t) { t.wrench[2] = "0.5"; }},
           {"base, held by lengths",
            [](TolerancesText& t) {
              t.cable_length_m.emplace().fill("0");
              t.base_anchor_m.fill("0.0005");
            }},
           {"platform, held by lengths",
            [](TolerancesText& t) {
              t.cable_length_m.emplace().fill("0");
              t.platform_anchor_m.fill("0.0005");
            }},
           {"lengths", [](TolerancesText& t) { t.cable_length_m.emplace().fill("0.0005"); }},
           {"all of these, and tracking",
            [](TolerancesText& t) {
              t.cable_length_m.emplace().fill("0.0002");
              t.base_anchor_m.fill("0.0002");
              t.platform_anchor_m.fill("0.0002");
              t.position_m = "0.0002";
              t.wrench[2] = "0.1";
            }}}) {
    Problem problem = robot1_slice();
    edit(problem.tolerances.emplace());
    Path path;
    path.waypoints = {at({0.5, 0.2}), at({0.56, 0.27})};
    if (problem.tolerances->cable_length_m) {
      // Far less is tolerated then: limits are next to what a platform that stays needs.
      path.waypoints[1] = path.waypoints[0];
      const RigidPose pose = PoseSampler(problem).rigid_pose(path.segment(0), 0);
      const Statics<double> still =
          statics(make_model<double>(problem), pose.p, Matrix3<double>(pose.q.toRotationMatrix()));
      for (std::size_t i = 0; i < kCables; ++i) {
        problem.robot.tension_N[i].lower = fmt::format("{:.9f}", still.tension[i] - still.tension_below[i] - 1e-4);
      }
    }
    const Prover prover(problem);
    const PathProof proof = prove_path(prover, path);
    ASSERT_EQ(proof.verdict, Verdict::kRefuted) << name << ": " << proof.reason;
    ASSERT_TRUE(proof.witness->deviation) << name;
    // Again in binary64, from the numbers stated.
    const Deviation& d = *proof.witness->deviation;
    const auto vector = [](const std::array<DecimalText, 3>& x) {
      return Vector3<double>(number(x[0]), number(x[1]), number(x[2]));
    };
    Deviated deviated{make_model<double>(problem)};
    const TolerancesText& t = *problem.tolerances;
    double moved = 0;  // what a machine held by lengths follows
    EXPECT_LE(vector(d.load_point_m).norm(), number(t.load_point_m));
    EXPECT_LE(vector(d.position_m).norm(), number(t.position_m));
    EXPECT_LE(2 * std::atan(vector(d.turn).norm()), evaluate_constant<double>(t.orientation_rad));
    deviated.model.p_PM += vector(d.load_point_m);
    for (std::size_t i = 0; i < kCables; ++i) {
      EXPECT_LE(vector(d.base_anchors_m[i]).norm(), number(t.base_anchor_m[i]));
      EXPECT_LE(vector(d.platform_anchors_m[i]).norm(), number(t.platform_anchor_m[i]));
      deviated.model.p_WA[i] += vector(d.base_anchors_m[i]);
      deviated.model.p_PB[i] += vector(d.platform_anchors_m[i]);
      deviated.model.p_MB[i] = deviated.model.p_PB[i] - deviated.model.p_PM;
      ASSERT_EQ(d.cable_lengths_m.has_value(), t.cable_length_m.has_value());
      if (!d.cable_lengths_m) continue;
      deviated.length_error[i] = number((*d.cable_lengths_m)[i]);
      EXPECT_LE(std::abs(deviated.length_error[i]), number((*t.cable_length_m)[i]));
      moved += std::abs(deviated.length_error[i]) + vector(d.base_anchors_m[i]).norm() +
               vector(d.platform_anchors_m[i]).norm();
    }
    EXPECT_TRUE(!d.cable_lengths_m || moved > 1e-4) << name;
    for (int k = 0; k < 6; ++k) {
      deviated.model.wrench(k) += number(d.wrench) * number(t.wrench[static_cast<std::size_t>(k)]);
    }
    deviated.shift = vector(d.position_m);
    const double half = std::atan(vector(d.turn).norm());
    if (half > 0) deviated.turn = 2 * half * vector(d.turn).normalized();
    const RigidPose pose = deviated_pose(
        problem, deviated, PoseSampler(problem).rigid_pose(path.segment(0), proof.witness->at.s.approx()));
    Least least;
    update(least, deviated.model, pose);
    EXPECT_LT(std::min(least.tension, least.length), 1e-12) << name;
  }
}

/// By a part in 1e30, which no floating point sees. (At the tolerance itself it is not certainly within; none is
/// proposed there.)
TEST(Tolerance, NothingIsKnownOfADeviationBeyondThem) {
  const PrecisionScope precision(128);
  const Problem problem = robot1_slice();
  const Model<MpInterval> model = make_model<MpInterval>(problem);
  TolerancesText tolerances;
  tolerances.base_anchor_m[1] = tolerances.platform_anchor_m[2] = tolerances.load_point_m = tolerances.position_m =
      "0.001";
  tolerances.cable_length_m.emplace().fill("0.001");
  tolerances.orientation_rad = "0.001";
  tolerances.wrench[2] = "0.1";
  Deviation none;
  none.base_anchors_m.fill({"0", "0", "0"});
  none.platform_anchors_m = none.base_anchors_m;
  none.load_point_m = none.position_m = none.turn = {"0", "0", "0"};
  none.wrench = "0";
  none.cable_lengths_m.emplace().fill("0");
  const auto is_known = [&](const auto& edit) {
    Deviation deviation = none;
    edit(deviation);
    Faults<MpInterval>::clear();
    const Vector3<MpInterval> p(MpInterval(0.0), MpInterval(0.0), MpInterval(0.35));
    const Matrix3<MpInterval> r =
        rotation(Quaternion<MpInterval>{MpInterval(0.0), MpInterval(0.0), MpInterval(0.3), MpInterval(1.0)});
    (void)deviated_quantity(model, tolerances, p, r, deviation, {MarginKind::kLengthMin, 0});
    return !Faults<MpInterval>::raised();
  };
  EXPECT_TRUE(is_known([](Deviation&) {}));
  const DecimalText inside = "-0.000999999999";
  const DecimalText beyond = "-0.001000000000000000000000000000001";
  EXPECT_TRUE(is_known([&](Deviation& d) { d.base_anchors_m[1][0] = inside; }));
  EXPECT_FALSE(is_known([&](Deviation& d) { d.base_anchors_m[1][0] = beyond; }));
  EXPECT_FALSE(is_known([&](Deviation& d) { d.base_anchors_m[0][0] = inside; }));
  EXPECT_TRUE(is_known([&](Deviation& d) { d.platform_anchors_m[2][1] = "0.00099"; }));
  EXPECT_FALSE(is_known([&](Deviation& d) { d.platform_anchors_m[2][1] = beyond; }));
  EXPECT_FALSE(is_known([&](Deviation& d) { d.load_point_m[2] = beyond; }));
  EXPECT_FALSE(is_known([&](Deviation& d) { d.position_m = {"0.0008", "0", "0.00061"}; }));
  EXPECT_FALSE(is_known([&](Deviation& d) { (*d.cable_lengths_m)[5] = beyond; }));
  EXPECT_FALSE(is_known([&](Deviation& d) { d.wrench = "1.000000000000000000000000000001"; }));
  EXPECT_TRUE(is_known([&](Deviation& d) { d.turn[0] = "0.0005"; }));  // its arc tangent is less
  EXPECT_FALSE(is_known([&](Deviation& d) { d.turn[0] = "0.000500001"; }));
}

TEST(Tolerance, ZerosChangeNothing) {
  Problem problem = robot1_slice();
  const SegmentProof without = Prover(problem).prove(at({0.5, 0.2}), at({0.56, 0.27}));
  problem.tolerances.emplace();
  const SegmentProof with = Prover(problem).prove(at({0.5, 0.2}), at({0.56, 0.27}));
  EXPECT_EQ(with.verdict, Verdict::kProved);
  EXPECT_NEAR(with.tension_N, without.tension_N, 1e-12);
  EXPECT_NEAR(with.wrench_scale, without.wrench_scale, 1e-9);
}

}  // namespace
}  // namespace taut
