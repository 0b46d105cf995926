// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes against the oracle: at points of each box, everything that is claimed about the whole of it.
#include "certify/box_proof.h"

#include <gtest/gtest.h>

#include "kinematics/statics.h"
#include "tests/support/enclosing.h"
#include "tests/support/segments.h"

namespace taut::testing {
namespace {

template <class I>
ProofModel<I> make(const Problem& problem) {
  if constexpr (std::is_same_v<I, Interval>) {
    return make_proof_model(problem);
  } else {
    return make_mp_proof_model(problem);
  }
}

DyadicBox random_box(Operands& operands) {
  constexpr int kBinary64Depth = 52;  // samples are binary64 numbers
  const int depth = operands.coin(0.6) ? operands.pick(5) : operands.pick(kBinary64Depth);
  return {static_cast<std::uint64_t>(operands.uniform(0, std::ldexp(1.0, depth))), depth};
}

/// What the oracle says at one point of a box.
struct Sample {
  double s;
  oracle::Big6 length, density, tension_radius;                                   // as in BoxEnclosure
  oracle::Big6 tension_low, tension_high, length_low, length_high, wrench_scale;  // margins
};

Sample sample(const Space& space, const Waypoint& a, const Waypoint& b, double s) {
  const PrecisionScope precision(oracle::kBits);
  const oracle::OracleStatics exact = oracle::statics(space.problem, space.pose(parameters_at(a, b, s)));
  Sample r;
  r.s = s;
  r.length = exact.length;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& [f_low, f_high] = space.problem.robot.tension_N[i];
    const auto& [d_low, d_high] = space.problem.robot.length_m[i];
    r.density[i] = exact.tension[i] / exact.length[i];
    r.tension_radius[i] = exact.tension_radius[i] / exact.length[i];
    r.tension_low[i] = exact.tension[i] - exact.tension_radius[i] - oracle::big(f_low);
    r.tension_high[i] = oracle::big(f_high) - exact.tension[i] - exact.tension_radius[i];
    r.length_low[i] = exact.length[i] - oracle::big(d_low);
    r.length_high[i] = oracle::big(d_high) - exact.length[i];
    r.wrench_scale[i] = std::min(exact.tension[i] - oracle::big(f_low), oracle::big(f_high) - exact.tension[i]) /
                        exact.tension_radius[i];
  }
  return r;
}

const oracle::Big6& margin(const Sample& x, MarginKind kind) {
  switch (kind) {
    case MarginKind::kTensionMin: return x.tension_low;
    case MarginKind::kTensionMax: return x.tension_high;
    case MarginKind::kLengthMin: return x.length_low;
    case MarginKind::kLengthMax: break;
  }
  return x.length_high;
}

struct Tally {
  int boxes = 0, regular = 0, faults = 0, proved = 0, refuted = 0;
};

/// A centred form against samples; the first is at the midpoint.
template <class I>
void expect_form(const SlopeForm<I>& form, const std::vector<Sample>& samples,
                 const std::function<const BigFloat&(const Sample&)>& value, const std::string& where) {
  const PrecisionScope precision(oracle::kBits);
  const BigFloat& at_mid = value(samples[0]);
  EXPECT_TRUE(holds(form.at_mid, at_mid))
      << where << ": at the midpoint " << digits(at_mid) << " is not in " << print(form.at_mid);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Sample& x = samples[k];
    EXPECT_TRUE(holds(form.range, value(x)))
        << where << ": at s = " << hex(x.s) << ", " << digits(value(x)) << " is not in " << print(form.range);
    const Sample& y = samples[0];
    if (std::abs(x.s - y.s) < 1e-14) continue;
    const BigFloat secant = (value(x) - value(y)) / (BigFloat(x.s) - BigFloat(y.s));
    EXPECT_TRUE(holds(form.slope, secant, abs(secant) * BigFloat(1e-25) + BigFloat(1e-25)))
        << where << ": from the midpoint to " << hex(x.s) << ", slope " << digits(secant) << " is not in "
        << print(form.slope);
  }
}

template <class A>
void expect_box(const Space& space, const ProofModel<typename A::I>& model, const RandomSegment& segment,
                const DyadicBox& box, int points, Operands& operands, Tally& tally) {
  using I = typename A::I;
  const auto& [a, b] = segment;
  const double lower = box.lower().approx();
  const double upper = box.upper().approx();
  const std::string where =
      "box " + box.k.str() + "/2^" + std::to_string(box.depth) + " from " + ::testing::PrintToString(a.parameters().x) +
      " to " + ::testing::PrintToString(b.parameters().x) + " half turns " +
      ::testing::PrintToString(a.parameters().half_turns) + ::testing::PrintToString(b.parameters().half_turns);
  ++tally.boxes;
  BoxEnclosure<I> enclosure;
  BoxVerdict verdict;
  const bool sound = A::run([&] { enclosure = enclose_box(model, Segment::straight(a, b), box); });
  (void)A::run([&] { verdict = judge_box(model, Segment::straight(a, b), box); });
  if (!sound) {
    ++tally.faults;
    EXPECT_EQ(verdict.kind, BoxVerdict::Kind::kFault) << where;
    return;
  }
  std::vector<Sample> samples = {sample(space, a, b, box.mid().approx())};
  // The ends, each with a point next to it: derivatives are often largest there.
  const double nearby = (upper - lower) / 1024;
  for (const double s : {lower, lower + nearby, upper - nearby, upper}) {
    samples.push_back(sample(space, a, b, s));
  }
  for (int k = 0; k < points; ++k) {
    samples.push_back(sample(space, a, b, operands.inside({lower, upper})));
  }
  tally.regular += enclosure.regular ? 1 : 0;
  ASSERT_EQ(enclosure.margins.size, enclosure.regular ? 24u : 12u);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string cable = where + ", cable " + std::to_string(i + 1);
    const auto component = [i](oracle::Big6 Sample::*member) {
      return [i, member](const Sample& x) -> const BigFloat& { return (x.*member)[i]; };
    };
    expect_form<I>(enclosure.length[i], samples, component(&Sample::length), cable + ", length");
    if (!enclosure.regular) continue;
    expect_form<I>(enclosure.density[i], samples, component(&Sample::density), cable + ", density");
    expect_form<I>(enclosure.above[i], samples, component(&Sample::tension_radius), cable + ", tension_radius");
  }
  for (const auto& entry : enclosure.margins) {
    const auto value = [&entry](const Sample& x) -> const BigFloat& {
      return margin(x, entry.id.kind)[static_cast<std::size_t>(entry.id.cable)];
    };
    const std::string which =
        where + ", margin " + name(entry.id.kind) + " of cable " + std::to_string(entry.id.cable + 1);
    expect_form<I>(entry.value, samples, value, which);
    for (const Sample& x : samples) EXPECT_TRUE(holds(entry.disturbed, value(x))) << which << " at s = " << hex(x.s);
  }

  if (verdict.kind == BoxVerdict::Kind::kProved) {
    ++tally.proved;
    EXPECT_GT(verdict.tension_N, 0.0);
    EXPECT_GT(verdict.length_m, 0.0);
    EXPECT_GE(verdict.wrench_scale, 1.0);
    for (const Sample& x : samples) {
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_TRUE(std::min(x.tension_low[i], x.tension_high[i]) >= BigFloat(verdict.tension_N)) << where;
        EXPECT_TRUE(std::min(x.length_low[i], x.length_high[i]) >= BigFloat(verdict.length_m)) << where;
        EXPECT_TRUE(x.wrench_scale[i] >= BigFloat(verdict.wrench_scale)) << where;
      }
    }
  } else if (verdict.kind == BoxVerdict::Kind::kRefuted) {
    ++tally.refuted;
    const auto cable = static_cast<std::size_t>(verdict.worst.cable);
    EXPECT_TRUE(margin(samples[0], verdict.worst.kind)[cable] <= BigFloat(0.0)) << where;
  }
}

template <class A>
class BoxEnclosures : public ::testing::Test {
 protected:
  static constexpr bool kFast = std::is_same_v<A, Fast>;

  static void expect_random_boxes(const Space& space) {
    const ProofModel<typename A::I> model = make<typename A::I>(space.problem);
    Operands operands(20261121);
    Tally tally;
    const int boxes = kFast ? 600 : 60;
    for (int n = 0; n < boxes && !::testing::Test::HasFailure(); ++n) {
      const RandomSegment segment = random_segment(space, operands);
      const int points = n % 10 == 0 ? 20 : 1;
      expect_box<A>(space, model, segment, random_box(operands), points, operands, tally);
    }
    record(tally);
    EXPECT_GT(tally.regular, boxes / 4);
    EXPECT_LT(tally.faults, boxes / 2);
    EXPECT_GT(tally.refuted, 0);
  }

  static void record(const Tally& tally) {
    RecordProperty("boxes", tally.boxes);
    RecordProperty("regular", tally.regular);
    RecordProperty("faults", tally.faults);
    RecordProperty("proved", tally.proved);
    RecordProperty("refuted", tally.refuted);
  }
};
using ProofArithmetics = ::testing::Types<Fast, Mp128>;
TYPED_TEST_SUITE(BoxEnclosures, ProofArithmetics);

TYPED_TEST(BoxEnclosures, HoldTheOracleOnASlice) { this->expect_random_boxes(slice_space()); }
TYPED_TEST(BoxEnclosures, HoldTheOracleOnASphere) { this->expect_random_boxes(sphere_space()); }
TYPED_TEST(BoxEnclosures, HoldTheOracleInFreeFlight) {
  this->expect_random_boxes(free_space(robot1_slice()));
  this->expect_random_boxes(free_space(robot2_sphere()));
}
TYPED_TEST(BoxEnclosures, HoldTheOracleOnACurvedSurface) { this->expect_random_boxes(curved_space()); }

TYPED_TEST(BoxEnclosures, HoldTheOracleWithAFullEllipsoid) {
  Space space = free_space(robot1_slice());
  Operands operands(3);
  // E = M M^T with M lower triangular of integers.
  std::array<std::array<int, 6>, 6> m{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) m[i][j] = operands.pick(81) - 40;
    m[i][i] = 50 + operands.pick(300);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      int sum = 0;
      for (std::size_t k = 0; k < 6; ++k) sum += m[i][k] * m[j][k];
      space.problem.load.ellipsoid.value()[i][j] = std::to_string(sum);
    }
  }
  space.problem.load.wrench = {"0.1", "-0.07", "1", "0.003", "-0.01", "0.02"};
  this->expect_random_boxes(space);
}

// Boxes next to and across a pose where det J changes sign, of every size: what is claimed regular must be so.
TYPED_TEST(BoxEnclosures, HoldTheOracleNextToSingularPoses) {
  using I = typename TypeParam::I;
  const Space space = free_space(robot1_slice());
  const ProofModel<I> model = make<I>(space.problem);
  const Model<double> approx = make_model<double>(space.problem);
  Operands operands(4);
  Tally tally;
  const auto determinant = [&](const RandomSegment& segment, double s) {
    const auto at = [&](std::size_t j) {
      return (1 - s) * segment.a.parameters().x[j] + s * segment.b.parameters().x[j];
    };
    return statics(approx, Pose<double>{Vector3<double>(at(0), at(1), at(2)), {at(3), at(4), at(5)}}).determinant;
  };
  const int wanted = this->kFast ? 40 : 4;
  int singular_across = 0;
  for (int found = 0; found < wanted && !this->HasFailure();) {
    RandomSegment segment;
    for (const auto& [lower, upper] : space.box) {
      segment.a.parameters().x.push_back(operands.uniform(lower, upper));
      segment.b.parameters().x.push_back(operands.uniform(lower, upper));
    }
    segment.a.parameters().half_turns.assign(6, 0);
    segment.b.parameters().half_turns.assign(6, 0);
    double low = 0, high = 1;
    if (determinant(segment, low) * determinant(segment, high) >= 0) continue;
    ++found;
    while (high - low > 1e-13) {
      const double mid = 0.5 * (low + high);
      (determinant(segment, low) * determinant(segment, mid) <= 0 ? high : low) = mid;
    }
    for (const int depth : {2, 6, 10, 14, 18, 24, 32, 40}) {
      const auto at = static_cast<std::uint64_t>(std::ldexp(low, depth));
      for (const int step : {0, operands.pick(7) - 3}) {
        const std::uint64_t k = at + static_cast<std::uint64_t>(step);
        if (k >= (std::uint64_t{1} << depth)) continue;
        const int before = tally.regular;
        expect_box<TypeParam>(space, model, segment, {k, depth}, 3, operands, tally);
        if (step == 0 && depth <= 32 && tally.regular > before) {
          // The box is thousands of times wider than the bracket of the root; it may only touch it at an end.
          const double margin = std::ldexp(1.0, -depth) * 1e-3;
          const DyadicBox box{k, depth};
          if (low > box.lower().approx() + margin && high < box.upper().approx() - margin) ++singular_across;
        }
      }
    }
    // Whole segments that end a little short of the singular pose: 1 − ratio of their half length away from it.
    for (const double size : {1e-1, 1e-2, 1e-4, 1e-7}) {
      for (const double ratio : {0.3, 0.6, 0.8, 0.9, 0.97}) {
        const double half = 0.5 * size * (operands.coin(0.5) ? 1 : -1);
        const double mid = low + half / ratio;
        RandomSegment short_of_it = segment;
        for (std::size_t j = 0; j < 6; ++j) {
          const auto at = [&](double s) {
            return (1 - s) * segment.a.parameters().x[j] + s * segment.b.parameters().x[j];
          };
          short_of_it.a.parameters().x[j] = at(mid - half);
          short_of_it.b.parameters().x[j] = at(mid + half);
        }
        expect_box<TypeParam>(space, model, short_of_it, {0, 0}, 0, operands, tally);
      }
    }
  }
  EXPECT_EQ(singular_across, 0) << "boxes with a singular pose inside were called regular";
  EXPECT_GT(tally.regular, 5);
  this->record(tally);
}

TEST(BoxProof, ProvesAPoseWithinItsLimitsAndRefutesOneBeyond) {
  const Problem problem = robot1_slice();
  const ProofModel<Interval> model = make_proof_model(problem);
  const Waypoint goal{{1.7, 1.7}, {0, 0}};
  const BoxVerdict proved = judge_box(model, Segment::straight(goal, goal), {0, 0});
  EXPECT_EQ(proved.kind, BoxVerdict::Kind::kProved);
  EXPECT_GT(proved.tension_N, 0.0);
  const Waypoint slack{{0.0, 1.9}, {0, 0}};
  const BoxVerdict refuted = judge_box(model, Segment::straight(slack, slack), {0, 0});
  EXPECT_EQ(refuted.kind, BoxVerdict::Kind::kRefuted);
}

TEST(BoxProof, JudgesTheSamePoseReachedTheOtherWayRound) {
  const ProofModel<Interval> model = make_proof_model(robot1_slice());
  const Waypoint plain{{1.7, 1.7}, {0, 0}};
  const std::vector<Waypoint> others = {{{1.7, 1.7}, {2, 0}}, {{1.7, -1.7}, {1, 0}}};
  const BoxVerdict expected = judge_box(model, Segment::straight(plain, plain), {0, 0});
  for (const Waypoint& same : others) {
    const BoxVerdict verdict = judge_box(model, Segment::straight(same, same), {0, 0});
    EXPECT_EQ(verdict.kind, expected.kind);
    EXPECT_NEAR(verdict.tension_N, expected.tension_N, 1e-9);
  }
}

// A proof must not rest on an expression that is undefined on the pose: the root's operand here is −1e-300.
TEST(BoxProof, AnUndefinedPoseIsAFaultInEveryScalar) {
  Problem problem = robot1_slice();
  problem.space.pose[0] = "sqrt(sqrt(2)*sqrt(2) - 2 - 1e-300)";
  const Waypoint goal{{1.7, 1.7}, {0, 0}};
  EXPECT_EQ(judge_box(make_proof_model(problem), Segment::straight(goal, goal), {0, 0}).kind, BoxVerdict::Kind::kFault);
  EXPECT_EQ(judge_box(make_mp_proof_model(problem), Segment::straight(goal, goal), {0, 0}).kind,
            BoxVerdict::Kind::kFault);
}

TEST(BoxProof, UsesEveryParameterOfMany) {
  Problem problem = robot1_slice();
  problem.space.flip.reset();
  for (int n = 0; n < 20; ++n) {
    problem.space.parameters.push_back({"extra" + std::to_string(n), ParameterKind::kReal, "", ""});
  }
  problem.space.pose[2] = "0.1 + extra19";
  Waypoint at;
  at.parameters().x.assign(22, 0.0);
  at.parameters().half_turns.assign(22, 0);
  at.parameters().x[0] = at.parameters().x[1] = 1.7;
  at.parameters().x[21] = 0.25;
  const ProofModel<Interval> model = make_proof_model(problem);
  EXPECT_EQ(judge_box(model, Segment::straight(at, at), {0, 0}).kind, BoxVerdict::Kind::kProved);
  at.parameters().x[21] = 0.75;  // far below
  const BoxVerdict verdict = judge_box(model, Segment::straight(at, at), {0, 0});
  EXPECT_NE(verdict.kind, BoxVerdict::Kind::kProved);
  EXPECT_EQ(verdict.worst.kind, MarginKind::kLengthMax);
}

}  // namespace
}  // namespace taut::testing
