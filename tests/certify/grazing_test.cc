// SPDX-License-Identifier: GPL-3.0-or-later
// Segments that come so close to a limit that no sampling and no fixed precision tells, on either side of it.
//
// The extremum of a quantity along a segment is found by another route, in 1200 bits and without intervals; the limit
// is put next to it as a long decimal.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "certify/path_proof.h"
#include "tests/support/segments.h"

namespace taut::testing {
namespace {

constexpr mpfr_prec_t kGrazingBits = 1200;

/// What `id` limits, upside down for the upper limits: the least is what matters.
BigFloat quantity(const Space& space, const RandomSegment& segment, MarginId id, const BigFloat& s) {
  const auto at = oracle::statics(space.problem, space.pose(parameters_at(segment.a, segment.b, s)));
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case MarginKind::kTensionMin: return at.tension[i] - at.tension_radius[i];
    case MarginKind::kTensionMax: return -(at.tension[i] + at.tension_radius[i]);
    case MarginKind::kLengthMin: return at.length[i];
    case MarginKind::kLengthMax: break;
  }
  return -at.length[i];
}

bool is_upper(MarginId id) { return id.kind == MarginKind::kTensionMax || id.kind == MarginKind::kLengthMax; }
bool is_tension(MarginId id) { return id.kind == MarginKind::kTensionMin || id.kind == MarginKind::kTensionMax; }

/// The least value, if it is well inside of the segment.
std::optional<BigFloat> least_inside(const Space& space, const RandomSegment& segment, MarginId id) {
  constexpr int kSamples = 64;
  int least = 0;
  {
    const PrecisionScope precision(oracle::kBits);
    std::optional<BigFloat> value;
    for (int k = 0; k <= kSamples; ++k) {
      const BigFloat at = quantity(space, segment, id, BigFloat(static_cast<double>(k) / kSamples));
      if (!value || at < *value) {
        value = at;
        least = k;
      }
    }
  }
  if (least < 4 || least > kSamples - 4) return std::nullopt;
  // Secants on central differences over 2^-400: both their errors are about 2^-800.
  const BigFloat step(0x1p-400);
  const auto slope = [&](const BigFloat& s) {
    return (quantity(space, segment, id, s + step) - quantity(space, segment, id, s - step)) / (step + step);
  };
  BigFloat s0(static_cast<double>(least - 1) / kSamples);
  BigFloat s1(static_cast<double>(least) / kSamples + 0x1p-20);
  BigFloat slope0 = slope(s0);
  for (int k = 0; k < 40; ++k) {
    const BigFloat slope1 = slope(s1);
    if (!(abs(slope1 - slope0) > BigFloat(0x1p-780))) break;
    const BigFloat next = s1 - slope1 * (s1 - s0) / (slope1 - slope0);
    s0 = s1;
    slope0 = slope1;
    s1 = next;
  }
  if (!(abs(slope(s1)) < BigFloat(0x1p-700)) || !(s1 > BigFloat(0.0)) || !(s1 < BigFloat(1.0))) return std::nullopt;
  return quantity(space, segment, id, s1);
}

DecimalText decimal(const BigFloat& x) {
  char* text = nullptr;
  mpfr_asprintf(&text, "%.320Re", x.get());
  DecimalText result = text;
  mpfr_free_str(text);
  return result;
}

/// The limit moved to `away` below (above) the least (largest) value: a margin of `away`.
Problem with_limit(Problem problem, MarginId id, const BigFloat& least, const BigFloat& away) {
  const auto i = static_cast<std::size_t>(id.cable);
  auto& limits = is_tension(id) ? problem.robot.tension_N[i] : problem.robot.length_m[i];
  (is_upper(id) ? limits.upper : limits.lower) = decimal(is_upper(id) ? -(least - away) : least - away);
  return problem;
}

struct Grazing {
  RandomSegment segment;
  MarginId id;
  BigFloat least;
};

/// A segment of each kind of margin, proved as it is.
std::vector<Grazing> grazing_segments(const Space& space) {
  const PrecisionScope precision(kGrazingBits);
  const Prover prover(space.problem);
  Operands operands(5);
  std::vector<Grazing> found;
  for (const MarginKind kind :
       {MarginKind::kTensionMin, MarginKind::kTensionMax, MarginKind::kLengthMin, MarginKind::kLengthMax}) {
    for (int trial = 0; trial < 400; ++trial) {
      RandomSegment segment;
      for (const auto& [lower, upper] : space.box) {
        segment.a.parameters().x.push_back(operands.uniform(lower, upper));
        segment.b.parameters().x.push_back(segment.a.parameters().x.back() + operands.uniform(-0.4, 0.4));
      }
      segment.a.parameters().half_turns = segment.b.parameters().half_turns = {0, 0};
      const MarginId id{kind, operands.pick(6)};
      if (prover.prove(segment.a, segment.b).verdict != Verdict::kProved) continue;
      const auto least = least_inside(space, segment, id);
      if (!least) continue;
      found.push_back({segment, id, *least});
      break;
    }
  }
  return found;
}

TEST(Grazing, IsDecidedOnBothSidesHoweverClose) {
  const Space space = slice_space();
  const std::vector<Grazing> segments = grazing_segments(space);
  ASSERT_EQ(segments.size(), 4u) << "one of each kind of margin";
  for (const Grazing& grazing : segments) {
    for (const char* distance : {"1e-14", "1e-40", "1e-100"}) {
      if (distance == std::string("1e-100") && grazing.id.kind != MarginKind::kLengthMin) continue;  // takes seconds
      const PrecisionScope precision(kGrazingBits);
      const std::string where = std::string(name(grazing.id.kind)) + " by " + distance;
      const BigFloat away = oracle::big(distance);
      const Problem clear = with_limit(space.problem, grazing.id, grazing.least, away);
      const SegmentProof proved = Prover(clear).prove(grazing.segment.a, grazing.segment.b);
      EXPECT_EQ(proved.verdict, Verdict::kProved) << where << ": " << proved.reason;

      const Problem violated = with_limit(space.problem, grazing.id, grazing.least, -away);
      const SegmentProof refuted = Prover(violated).prove(grazing.segment.a, grazing.segment.b);
      ASSERT_EQ(refuted.verdict, Verdict::kRefuted) << where << ": " << refuted.reason;
      ASSERT_FALSE(refuted.witness->singular);
      EXPECT_EQ(refuted.witness->margin, grazing.id) << where;
      const BigFloat at = enclose<MpInterval>(refuted.witness->box.mid()).lower();
      EXPECT_LE(quantity(space, grazing.segment, grazing.id, at), grazing.least + away) << where << ": the witness";
      EXPECT_LT(refuted.boxes_judged, proved.boxes_judged) << where << ": found by secants, not by bisection";
    }
  }
}

/// With 17 digits it would read "0.5 at a limit of 0.5".
TEST(Grazing, TheWitnessIsPrintedWithAsManyDigitsAsItTakes) {
  const Space space = slice_space();
  for (const Grazing& grazing : grazing_segments(space)) {
    const PrecisionScope precision(kGrazingBits);
    const Problem problem = with_limit(space.problem, grazing.id, grazing.least, oracle::big("-1e-40"));
    const PathProof proof = prove_path(Prover(problem), {{grazing.segment.a, grazing.segment.b}});
    ASSERT_EQ(proof.verdict, Verdict::kRefuted);
    const PathWitness& witness = *proof.witness;
    EXPECT_LE(oracle::big(witness.value_lower), oracle::big(witness.value_upper));
    if (is_upper(grazing.id)) {
      EXPECT_GE(oracle::big(witness.value_lower), oracle::big(witness.limit));
    } else {
      EXPECT_LE(oracle::big(witness.value_upper), oracle::big(witness.limit));
    }
    EXPECT_LT(witness.value_lower.size(), 150u);
  }
}

TEST(Grazing, MoreThanTheLastRungTellsIsUndecided) {
  const Space space = slice_space();
  const Grazing grazing = grazing_segments(space)[0];
  const PrecisionScope precision(kGrazingBits);
  ProofOptions options;
  options.max_bits = 256;
  const Problem problem = with_limit(space.problem, grazing.id, grazing.least, oracle::big("1e-200"));
  const SegmentProof proof = Prover(problem, options).prove(grazing.segment.a, grazing.segment.b);
  EXPECT_EQ(proof.verdict, Verdict::kUndecided);
  EXPECT_NE(proof.reason.text().find("256 bits"), std::string::npos) << proof.reason;
}

/// Cable 1 of a platform that slides past below its anchor at exactly 0.5 m, its least length.
TEST(Grazing, WhatIsExactlyZeroStaysUndecidedAndDoesNotTakeLong) {
  Problem problem = free_flying(robot1_slice());
  problem.robot.base_anchors_m[0] = {"0", "0.25", "0"};
  problem.robot.platform_anchors_m[0] = {"0", "0.25", "0"};
  for (auto& limits : problem.robot.tension_N) limits = {"-1000", "1000"};
  for (auto& limits : problem.robot.length_m) limits = {"0.01", "10"};
  problem.robot.length_m[0].lower = "0.5";
  const Prover prover(problem);
  const auto at = [](double x) { return Waypoint{{x, 0, 0.5, 0, 0, 0}, std::vector<int>(6, 0)}; };
  const std::string reason =
      "precision reached at margin length_min of cable 1: it is zero, or too close to it for 4096 bits to tell";
  struct Slide {
    double from, to;
  };
  for (const auto& [from, to] : {Slide{-0.01, 0.02}, Slide{0, 0.02}, Slide{-0.02, 0}}) {
    const SegmentProof proof = prover.prove(at(from), at(to));
    EXPECT_EQ(proof.verdict, Verdict::kUndecided) << from << " to " << to;
    EXPECT_EQ(proof.reason.text(), reason);
    EXPECT_LT(proof.boxes_judged, 100);
  }
  // Where the arithmetic is exact the zero is known, and is a violation: limits are open.
  EXPECT_EQ(prover.prove(at(-0.02), at(0.02)).verdict, Verdict::kRefuted);
  EXPECT_EQ(prover.prove(at(0), at(0)).verdict, Verdict::kRefuted);
}

}  // namespace
}  // namespace taut::testing
