#include "certify/held_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "certify/path_proof.h"
#include "certify/segment_proof.h"
#include "kinematics/pose_conversion.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

Waypoint at(const Model<double>& model, double phi, double theta) {
  constexpr double kSigma = 0.6;
  const RigidPose pose = rigid_pose({{0, 0, 0.35}, phi, theta, kSigma});
  Waypoint result;
  for (int k = 0; k < 3; ++k) result.x.push_back(pose.p(k));
  for (int k = 0; k < 4; ++k) result.x.push_back(pose.q.coeffs()(k));
  for (const double length : cable_lengths(model, pose)) result.x.push_back(length);
  result.half_turns.assign(result.x.size(), 0);
  return result;
}

/// Robot 1 from one tilt to another in one step, its lengths straight.
struct Step {
  Step(std::array<double, 2> from, std::array<double, 2> to)
      : problem(in_free_coordinates()),
        model(make_model<double>(problem)),
        prover(problem),
        ends{at(model, from[0], from[1]), at(model, to[0], to[1])} {
    double dot = 0;
    for (std::size_t k = 3; k < 7; ++k) dot += ends[0].x[k] * ends[1].x[k];
    for (std::size_t k = 3; dot < 0 && k < 7; ++k) ends[1].x[k] = -ends[1].x[k];
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
    std::array<double, kCables> lengths{};
    for (std::size_t i = 0; i < kCables; ++i) lengths[i] = (1 - s) * ends[0].x[7 + i] + s * ends[1].x[7 + i];
    const auto& x = ends[0].x;
    const auto found =
        pose_of_lengths(model, lengths, {{x[0], x[1], x[2]}, Eigen::Quaterniond(x[6], x[3], x[4], x[5])});
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
        const auto expect_within = [&](const Centered<Interval>& x, double value) {
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

TEST(HeldMotion, ABoxAcrossAnInnerPoseIsSplit) {
  const Step step(kStart, kFar);
  MotionEnclosure<Interval> motion;
  ASSERT_TRUE(run_upward([&] {
    motion = undisturbed_motion(step.prover.model(), step.segment, enclose<Interval>(DyadicBox{}), Interval(-0.5, 0.5));
  }));
  EXPECT_EQ(motion.status, MotionEnclosure<Interval>::Status::kAcross);
  for (const DyadicBox& box : step.prover.prove(step.segment).boxes) {
    for (const InnerPose& inner : step.segment.inner_poses) {
      EXPECT_FALSE(box.lower().approx() < inner.s && inner.s < box.upper().approx());
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
  step.ends[1].x[7] = 0.9;
  step.segment = step.prover.prepared(Segment::between(Interpolation::kCableLengths, step.ends[0], step.ends[1]));
  EXPECT_NE(step.prover.prove(step.segment).verdict, Verdict::kProved);
}

}  // namespace
}  // namespace taut
