// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges against the oracle at points of boxes, against deviating machines, and against the margins that were proved.
#include "certify/box_ranges.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "certify/path_proof.h"
#include "tests/support/segments.h"

namespace taut::testing {
namespace {

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

/// Robot 1's slice: its motion from q_s, as far as it is proved.
Path slice_path() {
  Path path;
  path.waypoints = {{{-2.3, 1.6}, {0, 0}}, {{-2.3, 1.5}, {0, 0}}, {{-2.25, 1.45}, {0, 0}}};
  return path;
}

std::vector<std::vector<DyadicBox>> boxes_of(const PathProof& proof) {
  std::vector<std::vector<DyadicBox>> boxes;
  for (const SegmentProof& segment : proof.segments) boxes.push_back(segment.boxes);
  return boxes;
}

double width(const DyadicBox& box) { return 2 * box.radius(); }

/// The least distances to limits that the ranges leave.
std::array<double, 2> margins(const Problem& problem, const PathRanges& ranges) {
  std::array<double, 2> least = {1e300, 1e300};
  for (const auto& segment : ranges.segments) {
    for (const BoxRanges& box : segment) {
      for (std::size_t i = 0; i < kCables; ++i) {
        const Limits& tension = problem.robot.tension_N[i];
        const Limits& length = problem.robot.length_m[i];
        least[0] = std::min(
            {least[0], box.tension[i].lower - number(tension.lower), number(tension.upper) - box.tension[i].upper});
        least[1] = std::min(
            {least[1], box.length[i].lower - number(length.lower), number(length.upper) - box.length[i].upper});
      }
    }
  }
  return least;
}

TEST(EncloseRanges, HoldsTheOracleAtPointsOfEachBox) {
  Operands operands(11);
  int enclosed = 0;
  for (const Space& space : {slice_space(), sphere_space(), free_space(robot1_slice()), curved_space()}) {
    const ProofModel<Interval> fast = make_proof_model(space.problem);
    const PrecisionScope fine_bits(256);
    const ProofModel<MpInterval> fine = make_mp_proof_model(space.problem);
    for (int trial = 0; trial < 300; ++trial) {
      const RandomSegment random = random_segment(space, operands);
      const Segment segment = Segment::straight(random.a, random.b);
      const int depth = operands.pick(7);
      const DyadicBox box{operands.pick(1 << depth), depth};
      for (const bool in_bits : {false, true}) {
        const auto ranges = in_bits ? enclose_ranges(fine, segment, box) : enclose_ranges(fast, segment, box);
        if (!ranges) continue;
        ++enclosed;
        for (const double u : {0.0, 0.25, 0.5, 0.8125, 1.0}) {
          const PrecisionScope precision(oracle::kBits);
          const double s = box.lower().approx() + u * width(box);
          const auto exact = oracle::statics(space.problem, space.pose(parameters_at(random.a, random.b, BigFloat(s))));
          for (std::size_t i = 0; i < kCables; ++i) {
            EXPECT_LE(BigFloat(ranges->tension[i].lower), exact.tension[i] - exact.tension_radius[i]);
            EXPECT_GE(BigFloat(ranges->tension[i].upper), exact.tension[i] + exact.tension_radius[i]);
            EXPECT_LE(BigFloat(ranges->length[i].lower), exact.length[i]);
            EXPECT_GE(BigFloat(ranges->length[i].upper), exact.length[i]);
          }
        }
      }
    }
  }
  EXPECT_GT(enclosed, 300);
}

TEST(PathRanges, LeaveTheMarginsThatWereProved) {
  const Problem problem = robot1_slice();
  const Prover prover(problem);
  const Path path = slice_path();
  const PathProof proof = prove_path(prover, path);
  ASSERT_EQ(proof.verdict, Verdict::kProved);
  const PathRanges whole = path_ranges(prover, path, boxes_of(proof), {.excess = 1, .most_halvings = 0});
  const auto [tension, length] = margins(problem, whole);
  constexpr double kRounding = 1e-12;  // limits are subtracted here in binary64
  EXPECT_NEAR(tension, std::min(proof.segments[0].tension_N, proof.segments[1].tension_N), kRounding);
  EXPECT_NEAR(length, std::min(proof.segments[0].length_m, proof.segments[1].length_m), kRounding);

  const PathRanges pieces = path_ranges(prover, path, boxes_of(proof));
  const auto [sharper_tension, sharper_length] = margins(problem, pieces);
  EXPECT_GE(sharper_tension, tension);
  EXPECT_GE(sharper_length, length);
}

TEST(PathRanges, CoverEachBoxInPiecesAsSharpAsAskedFor) {
  const Problem problem = robot1_slice();
  const Prover prover(problem);
  const Path path = slice_path();
  const PathProof proof = prove_path(prover, path);
  const PathRanges ranges = path_ranges(prover, path, boxes_of(proof), {.excess = 0.0005, .most_halvings = 20});
  EXPECT_EQ(ranges.missing, 0u);
  ASSERT_EQ(ranges.segments.size(), 2u);
  for (const auto& segment : ranges.segments) {
    EXPECT_GT(segment.size(), proof.segments[0].boxes.size());
    Dyadic reached{0, 0};
    for (const BoxRanges& piece : segment) {
      EXPECT_EQ(piece.box.lower(), reached);
      reached = piece.box.upper();
      EXPECT_LE(piece.excess, 0.0005);
    }
    EXPECT_EQ(reached, (Dyadic{1, 0}));
  }
}

TEST(PathRanges, CoverDeviatingMachines) {
  Problem problem = robot1_slice();
  problem.tolerances.emplace();
  problem.tolerances->base_anchor_m.fill("0.0001");
  problem.tolerances->load_point_m = "0.0003";
  problem.tolerances->wrench[2] = "0.005";
  problem.tolerances->position_m = "0.0002";
  const Prover prover(problem);
  const Path path = slice_path();
  const PathRanges ranges = path_ranges(prover, path, {{DyadicBox{}}, {DyadicBox{}}});
  ASSERT_EQ(ranges.missing, 0u);
  const PathRanges stated = path_ranges(Prover(robot1_slice()), path, {{DyadicBox{}}, {DyadicBox{}}});

  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto direction = [&](double size) {
    return Vector3<double>(Vector3<double>(normal(random), normal(random), normal(random)).normalized() * size);
  };
  const PoseSampler sampler(robot1_slice());
  double widest = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    for (const BoxRanges& piece : ranges.segments[k]) {
      for (int trial = 0; trial < 20; ++trial) {
        Model<double> model = sampler.model();
        for (std::size_t i = 0; i < kCables; ++i) model.p_WA[i] += direction(0.0001);
        model.p_PM += direction(0.0003);
        for (std::size_t i = 0; i < kCables; ++i) model.p_MB[i] = model.p_PB[i] - model.p_PM;
        model.wrench(2) += (trial % 2 == 0 ? 0.005 : -0.005);
        const double s = piece.box.lower().approx() + width(piece.box) * trial / 20;
        const RigidPose pose = sampler.rigid_pose(path.segment(k), s);
        const Statics<double> x =
            statics(model, Vector3<double>(pose.p + direction(0.0002)), Matrix3<double>(pose.q.toRotationMatrix()));
        constexpr double kRounding = 1e-9;  // of the sampled machine
        for (std::size_t i = 0; i < kCables; ++i) {
          EXPECT_GE(x.tension[i] - x.tension_below[i], piece.tension[i].lower - kRounding);
          EXPECT_LE(x.tension[i] + x.tension_above[i], piece.tension[i].upper + kRounding);
          EXPECT_GE(x.length[i], piece.length[i].lower - kRounding);
          EXPECT_LE(x.length[i], piece.length[i].upper + kRounding);
          const Range& alone = stated.segments[k].front().length[i];
          widest = std::max({widest, alone.lower - x.length[i], x.length[i] - alone.upper});
        }
      }
    }
  }
  EXPECT_GT(widest, 0.0) << "some deviating machine should be outside of what is stated";
}

TEST(PathRanges, LeaveOutWhatIsSingular) {
  // Straight to q_g the motion is not feasible.
  const Prover prover(robot1_slice());
  Path path;
  path.waypoints = {{{-2.3, 1.6}, {0, 0}}, {{1.7, 1.7}, {0, 0}}};
  const PathRanges ranges = path_ranges(prover, path, {{DyadicBox{}}});
  EXPECT_EQ(ranges.missing, 1u);
  EXPECT_TRUE(ranges.segments[0].empty());
}

TEST(PathRanges, GiveUpOnWhatIsFalseInGoodTime) {
  const Prover prover(robot1_slice());
  Path path;
  path.waypoints = {{{-2.3, 1.6}, {0, 0}}};
  std::vector<std::vector<DyadicBox>> boxes;
  for (int k = 0; k < 2000; ++k) {  // back and forth through singular poses
    path.waypoints.push_back({{k % 2 == 0 ? 1.7 : -2.3, k % 2 == 0 ? 1.7 : 1.6}, {0, 0}});
    boxes.push_back({DyadicBox{}});
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(path_ranges(prover, path, boxes, {.most_hard = 10}).missing, 2000u);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(PathRanges, TryHardBoxesWithMoreBits) {
  // Next to a singular pose, on the way straight to q_g.
  const Prover prover(robot1_slice());
  Path path;
  path.waypoints = {{{-2.3, 1.6}, {0, 0}}, {{1.7, 1.7}, {0, 0}}};
  const Segment segment = path.segment(0);
  const PoseSampler sampler(robot1_slice());
  const auto determinant = [&](double s) {
    const RigidPose pose = sampler.rigid_pose(segment, s);
    return statics(sampler.model(), Vector3<double>(pose.p), Matrix3<double>(pose.q.toRotationMatrix())).determinant;
  };
  double low = 0;
  double high = 1.0 / 64;
  while (high < 1 && determinant(high) * determinant(0) > 0) high += 1.0 / 64;
  low = high - 1.0 / 64;
  ASSERT_LT(high, 1);
  for (int i = 0; i < 60; ++i) (determinant((low + high) / 2) * determinant(0) > 0 ? low : high) = (low + high) / 2;

  bool is_hard = false;
  for (int distance = 1; distance < (1 << 20) && !is_hard; distance *= 2) {
    const DyadicBox box{static_cast<std::int64_t>(std::ldexp(low, 50)) - distance, 50};
    const PrecisionScope precision(1024);
    is_hard = !enclose_ranges(prover.model(), segment, box) &&
              enclose_ranges(make_mp_proof_model(prover.problem()), segment, box);
    if (!is_hard) continue;
    EXPECT_EQ(path_ranges(prover, path, {{box}}, {.most_hard = 0}).missing, 1u);
    EXPECT_EQ(path_ranges(prover, path, {{box}}).missing, 0u);
  }
  EXPECT_TRUE(is_hard);
}

}  // namespace
}  // namespace taut::testing
