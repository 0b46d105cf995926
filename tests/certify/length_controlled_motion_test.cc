// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/length_controlled_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include "certify/motion/pose_in_lanes.h"
#include "certify/path_proof.h"
#include "certify/prover.h"
#include "kinematics/pose_conversion.h"
#include "kinematics/quaternion.h"
#include "kinematics/statics.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

Waypoint at(const Model<double>& model, double phi, double theta) {
  constexpr double kSigma = 0.6;
  const RigidPose pose = rigid_pose({{0, 0, 0.35}, phi, theta, kSigma});
  return LengthsPoint{pose_numbers(pose), cable_lengths(model, pose)};
}

/// Robot 1 from one tilt to another in one step, its lengths straight.
struct Step {
  Step(std::array<double, 2> from, std::array<double, 2> to)
      : problem(in_free_coordinates()),
        model(make_model<double>(problem)),
        prover(problem),
        ends{at(model, from[0], from[1]), at(model, to[0], to[1])} {
    RigidPose last = rigid_pose(ends[1].pose());
    if (last.q.dot(rigid_pose(ends[0].pose()).q) < 0) last.q.coeffs() = -last.q.coeffs();
    ends[1] = LengthsPoint{pose_numbers(last), ends[1].lengths_m()};
    segment = prover.prepared(Segment::between(Interpolation::kCableLengths, ends[0], ends[1]));
  }

  static Problem in_free_coordinates() {
    Problem result = testing::robot1_slice();
    result.space = coordinate_space();
    result.query.clear();
    return result;
  }

  /// By the lengths, from the start.
  [[nodiscard]] RigidPose pose(double s) const {
    const auto found = pose_of_lengths(model, lengths_at(segment, s), rigid_pose(ends[0].pose()));
    EXPECT_TRUE(found);
    return *found;
  }

  Problem problem;
  Model<double> model;
  Prover prover;
  std::array<Waypoint, 2> ends;
  Segment segment;
};

constexpr std::array<double, 2> kStart = {-2.3, 1.6};
constexpr std::array<double, 2> kFar = {-1.7, 1.0};

TEST(HeldMotion, ALongStepIsProvedAlongInnerPoses) {
  const Step step(kStart, kFar);
  EXPECT_GE(step.segment.inner_poses.size(), 3U);
  EXPECT_EQ(step.prover.prove(step.segment).verdict, Verdict::kProved);
  // Straight from end to end no tube will do.
  Segment straight = step.segment;
  straight.inner_poses.clear();
  for (const double size : {0x1p-12, 0x1p-8, 0x1p-6, 0x1p-4}) {
    straight.pose_tube = {0.25 * size, size};
    EXPECT_EQ(step.prover.prove(straight).verdict, Verdict::kUndecided) << size;
  }
}

TEST(HeldMotion, AShortStepNeedsNoInnerPose) {
  const Step step(kStart, {-2.29, 1.59});
  EXPECT_TRUE(step.segment.inner_poses.empty());
  const SegmentProof proof = step.prover.prove(step.segment);
  EXPECT_EQ(proof.verdict, Verdict::kProved);
  EXPECT_EQ(proof.boxes.size(), 1U);
}

TEST(HeldMotion, InnerPosesAreOnTheMotionInOrderAndTheirTubesNested) {
  const Step step(kStart, kFar);
  PoseTube last_tube = step.segment.pose_tube;
  double last = 0;
  for (const InnerPose& inner : step.segment.inner_poses) {
    EXPECT_LT(last, inner.s);
    EXPECT_LT(inner.s, 1);
    last = inner.s;
    EXPECT_DOUBLE_EQ(inner.tube.position / inner.tube.turn, last_tube.position / last_tube.turn);
    last_tube = inner.tube;
    const RigidPose pose = step.pose(inner.s);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(inner.x[static_cast<std::size_t>(k)], pose.p(k), 1e-10);
    EXPECT_NEAR(pose_between(step.segment, inner.s).q.angularDistance(pose.q), 0, 1e-9);
  }
}

TEST(HeldMotion, BoxesEncloseThePosesThatTheLengthsImply) {
  const Step step(kStart, kFar);
  constexpr double kRounding = 1e-11;  // of the pose in floating point [m], [1]
  int enclosed = 0;
  for (const int depth : {3, 4, 6, 9}) {
    for (std::uint64_t k = 0; k<std::uint64_t{1} << depth; k += depth> 4 ? 5 : 1) {
      const DyadicBox box{k, depth};
      const double radius = box.radius();
      const double mid = box.mid().approx();
      MotionEnclosure<Interval> motion;
      ASSERT_TRUE(run_upward([&] {
        motion =
            undisturbed_motion(step.prover.model(), step.segment, enclose<Interval>(box), Interval(-radius, radius));
      }));
      if (!motion.is_enclosed()) continue;
      ++enclosed;
      for (const double h : {-1.0, -0.7, 0.0, 0.4, 1.0}) {
        const RigidPose pose = step.pose(mid + h * radius);
        const Matrix3<double> r = pose.q.toRotationMatrix();
        const auto expect_within = [&](const SlopeForm<Interval>& x, double value) {
          EXPECT_GE(value, x.range.lower() - kRounding);
          EXPECT_LE(value, x.range.upper() + kRounding);
          const double a = h * radius * x.slope.lower();
          const double b = h * radius * x.slope.upper();
          EXPECT_GE(value, x.at_mid.lower() + std::min(a, b) - kRounding);
          EXPECT_LE(value, x.at_mid.upper() + std::max(a, b) + kRounding);
        };
        for (int i = 0; i < 3; ++i) {
          expect_within(motion.p_WP(i), pose.p(i));
          for (int j = 0; j < 3; ++j) expect_within(motion.r_WP(i, j), r(i, j));
        }
      }
    }
  }
  EXPECT_GT(enclosed, 50);
}

/// Binary64 numbers as exact ones.
MpInterval exactly(const Interval& x) { return {BigFloat(x.lower()), BigFloat(x.upper())}; }

bool contains(const MpInterval& outer, const MpInterval& inner) {
  return !(inner.lower() < outer.lower()) && !(outer.upper() < inner.upper());
}

/// Calls `look` with each number of a pose over a box and what is known of it at a point of the box.
template <class F>
void for_each_number(const MotionEnclosure<Interval>& box, const MotionEnclosure<MpInterval>& point, const F& look) {
  for (int i = 0; i < 3; ++i) {
    look(box.p_WP(i), point.p_WP(i).range);
    for (int j = 0; j < 3; ++j) look(box.r_WP(i, j), point.r_WP(i, j).range);
  }
}

/// In lanes and by the templates: the centred forms hold what 200 bits say of points of the box.
TEST(HeldMotion, BoxesEncloseWhatTwoHundredBitsSay) {
  const Step step(kStart, kFar);
  const PrecisionScope precision(200);
  const ProofModel<MpInterval> fine = make_mp_proof_model(step.problem);
  const ProofModel<Interval> in_lanes = make_proof_model(step.problem);
  ProofModel<Interval> templates = make_proof_model(step.problem);
  ASSERT_TRUE(in_lanes.lanes);
  templates.lanes.reset();
  std::mt19937_64 random(3);
  int enclosed = 0;
  for (int n = 0; n < 25; ++n) {
    const int depth = std::uniform_int_distribution<int>(3, 12)(random);
    const DyadicBox box{std::uniform_int_distribution<int>(0, (1 << depth) - 1)(random), depth};
    const double radius = box.radius();
    for (const ProofModel<Interval>* model : {&in_lanes, static_cast<const ProofModel<Interval>*>(&templates)}) {
      MotionEnclosure<Interval> motion;
      const bool is_sound = run_upward([&] {
        motion = undisturbed_motion(*model, step.segment, enclose<Interval>(box), Interval(-radius, radius));
      });
      if (!is_sound || !motion.is_enclosed()) continue;
      ++enclosed;
      for (const double h : {-1.0, -0.375, 0.0, 0.5, 1.0}) {
        const MpInterval s(box.mid().approx() + h * radius);  // exact
        const auto point = undisturbed_motion(fine, step.segment, {s, s}, MpInterval(0.0));
        ASSERT_EQ(point.status, MotionEnclosure<MpInterval>::Status::kKnown);
        for_each_number(motion, point, [&](const SlopeForm<Interval>& form, const MpInterval& value) {
          EXPECT_TRUE(contains(exactly(form.range), value));
          EXPECT_TRUE(h != 0 || contains(exactly(form.at_mid), value));
          EXPECT_TRUE(contains(exactly(form.at_mid) + exactly(form.slope) * MpInterval(h * radius), value));
        });
      }
    }
  }
  EXPECT_GT(enclosed, 20);
}

TEST(HeldMotion, AllLevelsFindTheSamePose) {
  const Step step(kStart, kFar);
  const ProofModel<Interval>& model = step.prover.model();
  std::mt19937_64 random(4);
  int enclosed = 0;
  for (int n = 0; n < 400; ++n) {
    const int depth = std::uniform_int_distribution<int>(2, 20)(random);
    const DyadicBox box{std::uniform_int_distribution<int>(0, (1 << depth) - 1)(random), depth};
    const auto found = [&](lanes::Level level, std::vector<double>& numbers) {
      MotionEnclosure<Interval> motion;
      const bool is_sound = run_upward([&] {
        const EnclosedBox<Interval> s = enclose<Interval>(box);
        motion = forward_kinematics_in_lanes(*lanes::kernels_of(level), *model.lanes, model.model, step.segment,
                                             s.range, s.mid, Interval(-box.radius(), box.radius()));
      });
      numbers = {static_cast<double>(motion.status), is_sound ? 1.0 : 0.0};
      if (!is_sound || !motion.is_enclosed()) return false;
      const auto add = [&](const SlopeForm<Interval>& x) {
        for (const Interval& end : {x.at_mid, x.slope, x.range})
          numbers.insert(numbers.end(), {end.lower(), end.upper()});
      };
      for (int i = 0; i < 3; ++i) {
        add(motion.p_WP(i));
        for (int j = 0; j < 3; ++j) add(motion.r_WP(i, j));
      }
      return true;
    };
    std::vector<double> first, other;
    enclosed += found(lanes::Level::kSse2, first) ? 1 : 0;
    for (const lanes::Level level : {lanes::Level::kAvx2, lanes::Level::kAvx512}) {
      if (lanes::kernels_of(level) == nullptr) continue;
      static_cast<void>(found(level, other));
      ASSERT_EQ(other, first) << lanes::name(level) << ", box " << n;
    }
  }
  EXPECT_GT(enclosed, 200);
}

TEST(HeldMotion, ABoxAcrossAnInnerPoseIsSplit) {
  const Step step(kStart, kFar);
  MotionEnclosure<Interval> motion;
  ASSERT_TRUE(run_upward([&] {
    motion = undisturbed_motion(step.prover.model(), step.segment, enclose<Interval>(DyadicBox{}), Interval(-0.5, 0.5));
  }));
  EXPECT_EQ(motion.status, MotionEnclosure<Interval>::Status::kSpansKnot);
  for (const DyadicBox& box : step.prover.prove(step.segment).boxes) {
    for (const InnerPose& inner : step.segment.inner_poses) {
      EXPECT_FALSE(box.lower().approx() < inner.s && inner.s < box.upper().approx());
    }
  }
}

/// Robot 1's machine and a pose, enclosed, and what deviates.
struct Deviating {
  static RigidPose in_slice(double phi, double theta) { return rigid_pose({{0, 0, 0.35}, phi, theta, 0.6}); }
  static PoseEnclosure enclosed(const RigidPose& pose) {
    const auto of = [](double x) { return MpInterval(x); };
    PoseEnclosure result;
    result.p_WP = pose.p.unaryExpr(of);
    const Eigen::Vector4d q = pose.q.coeffs();
    // Not quite of length 1; R(u, 1) with u = v / w always is a rotation.
    const MpInterval w(q(3));
    result.r_WP = rotation(Quaternion<MpInterval>{of(q(0)) / w, of(q(1)) / w, of(q(2)) / w, of(1.0)});
    return result;
  }
  /// From `from`; the deviating machine's lengths are those that the stated one has there, plus these errors.
  [[nodiscard]] std::optional<PoseEnclosure> led(const RigidPose& from) const {
    std::array<MpInterval, kCables> errors;
    for (std::size_t i = 0; i < kCables; ++i) errors[i] = MpInterval(length_error[i]);
    Model<MpInterval> deviated = exact;
    for (std::size_t i = 0; i < kCables; ++i) {
      for (int k = 0; k < 3; ++k) {
        deviated.p_WA[i](k) += MpInterval(base[i](k));
        deviated.p_PB[i](k) += MpInterval(platform[i](k));
      }
    }
    return deviated_pose(exact, enclosed(from), deviated, errors);
  }
  [[nodiscard]] Model<double> deviated_approx() const {
    Model<double> result = approx;
    for (std::size_t i = 0; i < kCables; ++i) {
      result.p_WA[i] += base[i];
      result.p_PB[i] += platform[i];
    }
    return result;
  }
  /// Such that the deviating machine has `to` among its poses.
  void lead(const RigidPose& from, const RigidPose& to) {
    const auto before = cable_lengths(approx, from);
    const auto after = cable_lengths(deviated_approx(), to);
    for (std::size_t i = 0; i < kCables; ++i) length_error[i] = after[i] - before[i];
  }
  [[nodiscard]] double determinant(const RigidPose& pose) const {
    return statics(approx, pose.p, Matrix3<double>(pose.q.toRotationMatrix())).determinant;
  }

  PrecisionScope precision{128};
  Problem problem = testing::robot1_slice();
  Model<MpInterval> exact = make_model<MpInterval>(problem);
  Model<double> approx = make_model<double>(problem);
  std::array<Vector3<double>, kCables> base = zeros(), platform = zeros();
  std::array<double, kCables> length_error{};

  static std::array<Vector3<double>, kCables> zeros() {
    std::array<Vector3<double>, kCables> result;
    result.fill(Vector3<double>::Zero());
    return result;
  }
};

TEST(HeldMotion, ADeviationLeadsWhereThePoseFollowsIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 12; ++trial) {
    Deviating machine;
    const double size = std::pow(10.0, -4 - trial % 6);
    for (std::size_t i = 0; i < kCables; ++i) {
      for (int k = 0; k < 3; ++k) {
        machine.base[i](k) = size * uniform(random);
        machine.platform[i](k) = size * uniform(random);
      }
      machine.length_error[i] = size * uniform(random);
    }
    const RigidPose from = Deviating::in_slice(-2.3 + 0.05 * trial, 1.6 - 0.05 * trial);
    const auto led = machine.led(from);
    ASSERT_TRUE(led) << trial;
    std::array<double, kCables> lengths = cable_lengths(machine.approx, from);
    for (std::size_t i = 0; i < kCables; ++i) lengths[i] += machine.length_error[i];
    const auto expected = pose_of_lengths(machine.deviated_approx(), lengths, from);
    ASSERT_TRUE(expected) << trial;
    EXPECT_GT((expected->p - from.p).norm(), 0.05 * size) << trial;
    const Matrix3<double> r = expected->q.toRotationMatrix();
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(midpoint_approx(led->p_WP(i)), expected->p(i), 1e-12) << trial;
      EXPECT_LT(upper_bound(led->p_WP(i)) - lower_bound(led->p_WP(i)), 1e-15) << trial;
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(midpoint_approx(led->r_WP(i, j)), r(i, j), 1e-11) << trial;
    }
  }
}

TEST(HeldMotion, NoDeviationLeadsNowhereElse) {
  const RigidPose from = Deviating::in_slice(-2.3, 1.6);
  const auto led = Deviating().led(from);
  ASSERT_TRUE(led);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(midpoint_approx(led->p_WP(i)), from.p(i), 1e-15);
}

TEST(HeldMotion, ADeviationPastASingularPoseIsNotFollowed) {
  Deviating machine;
  const RigidPose from = Deviating::in_slice(-2.3, 1.6);
  const bool sign = machine.determinant(from) > 0;
  int tried = 0;
  for (int k = 1; k < 60; ++k) {
    const RigidPose to = Deviating::in_slice(-2.3 + 0.1 * k, 1.6);
    if ((machine.determinant(to) > 0) == sign) continue;
    machine.lead(from, to);
    EXPECT_FALSE(machine.led(from)) << k;
    // Nor across the singular poses that are next.
    const RigidPose before = Deviating::in_slice(-2.3 + 0.1 * (k - 1), 1.6);
    if ((machine.determinant(before) > 0) == sign) {
      machine.lead(before, to);
      EXPECT_FALSE(machine.led(before)) << k;
    }
    ++tried;
  }
  EXPECT_GT(tried, 3);
}

/// The base turns by half a turn, each anchor by a straight way: half-way all are on one line, and the machine is
/// singular. At the end it is regular again, and at the pose at which it began.
TEST(HeldMotion, ADeviationThroughASingularMachineIsNotFollowed) {
  const RigidPose from = Deviating::in_slice(-2.3, 1.6);
  for (const double part : {0.001, 1.0}) {
    Deviating machine;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<double>& a = machine.approx.p_WA[i];
      machine.base[i] = Vector3<double>(-2 * part * a(0), -2 * part * a(1), 0);
    }
    machine.lead(from, from);
    EXPECT_EQ(machine.led(from).has_value(), part < 0.5) << part;
  }
}

/// Ways on which no length changes and the machine is regular at both ends, and singular half-way: so that it takes the
/// anchors in between to see it. Pulled up to above the platform, which hangs level, base anchors pass its plane; and
/// so on.
TEST(HeldMotion, AnchorsOnTheWayCount) {
  const RigidPose level = rigid_pose({{0, 0, 0.35}, 0, 0, 34 * std::acos(-1.0) / 180});
  for (const auto& [moves_base, moves_platform, by] :
       {std::tuple(true, false, 0.7), std::tuple(false, true, -0.7), std::tuple(true, true, 0.0)}) {
    for (const double part : {0.001, 1.0}) {
      Deviating machine;
      for (std::size_t i = 0; i < kCables; ++i) {
        const auto along = [&](const Vector3<double>& x) -> Vector3<double> {
          if (by != 0) return {0, 0, part * by};
          return {-2 * part * x(0), -2 * part * x(1), 0};  // both rings turn by half a turn
        };
        if (moves_base) machine.base[i] = along(machine.approx.p_WA[i]);
        if (moves_platform) machine.platform[i] = along(machine.approx.p_PB[i]);
      }
      machine.lead(level, level);
      EXPECT_TRUE(part < 0.5 || machine.length_error == Deviating().length_error ||
                  std::ranges::all_of(machine.length_error, [](double e) { return std::abs(e) < 1e-9; }));
      EXPECT_EQ(machine.led(level).has_value(), part < 0.5) << by << " " << part;
    }
  }
}

TEST(HeldMotion, WrongInnerPosesProveNothing) {
  const Step step(kStart, kFar);
  const auto expect_undecided = [&](const char* what, auto edit) {
    Segment segment = step.segment;
    edit(segment.inner_poses);
    EXPECT_EQ(step.prover.prove(segment).verdict, Verdict::kUndecided) << what;
  };
  using Poses = std::vector<InnerPose>;
  expect_undecided("out of order", [](Poses& poses) { std::swap(poses.front(), poses.back()); });
  expect_undecided("at the start", [](Poses& poses) { poses.front().s = 0; });
  expect_undecided("at the end", [](Poses& poses) { poses.back().s = 1; });
  expect_undecided("no number", [](Poses& poses) { poses[1].x[2] = std::nan(""); });
  expect_undecided("moved", [](Poses& poses) { poses[1].x[2] += 0.005; });
  expect_undecided("of the other sign", [](Poses& poses) {
    for (std::size_t k = 3; k < 7; ++k) poses[1].x[k] = -poses[1].x[k];
  });
  expect_undecided("no tube", [](Poses& poses) { poses[1].tube = {}; });
  expect_undecided("a tube too narrow", [](Poses& poses) { poses[1].tube = {0x1p-40, 0x1p-40}; });
  expect_undecided("a tube too wide", [](Poses& poses) { poses[1].tube = {0.5, 1}; });
  expect_undecided("tubes of which neither contains the other", [&](Poses& poses) {
    const PoseTube& before = poses[0].tube;
    poses[1].tube = {before.position * 1.01, before.turn * 0.99};
  });
}

TEST(HeldMotion, WhereNoPoseHasTheLengthsOneShortPieceIsLeftOpen) {
  // The fifth cable is to become longer than the others let it: both ends have their lengths, the way between has not.
  Step step(kStart, {-2.2, 1.5});
  std::array<double, kCables> lengths = step.ends[1].lengths_m();
  lengths[0] = 0.9;
  step.ends[1] = LengthsPoint{step.ends[1].pose(), lengths};
  step.segment = step.prover.prepared(Segment::between(Interpolation::kCableLengths, step.ends[0], step.ends[1]));
  EXPECT_NE(step.prover.prove(step.segment).verdict, Verdict::kProved);
}

}  // namespace
}  // namespace taut
