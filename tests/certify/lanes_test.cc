// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of certify/lanes: equal to the templates that it stands in for, and the same bits on all levels.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "certify/box_proof.h"
#include "certify/lanes/kernel.h"
#include "certify/motion/forms_in_lanes.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using lanes::Level;

constexpr Level kLevels[] = {Level::kSse2, Level::kAvx2, Level::kAvx512};

/// A segment of random length somewhere in the parameters' ranges, and a box of it.
struct RandomBox {
  Waypoint from, to;
  DyadicBox box;

  explicit RandomBox(std::mt19937_64& random) {
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    const double reach = std::exp2(uniform(-30, 0));
    for (const auto& [low, high] : {std::pair{-3.14, 3.14}, std::pair{0.0, 2.0}}) {
      from.parameters().x.push_back(uniform(low, high));
      to.parameters().x.push_back(from.parameters().x.back() + uniform(-reach, reach));
    }
    from.parameters().half_turns = to.parameters().half_turns = {0, 0};
    const int depth = std::uniform_int_distribution<int>(0, 3)(random);
    box = {std::uniform_int_distribution<int>(0, (1 << depth) - 1)(random), depth};
  }
};

void expect_equal(const Interval& a, const Interval& b, const char* what) {
  EXPECT_EQ(a.lower(), b.lower()) << what;
  EXPECT_EQ(a.upper(), b.upper()) << what;
}

void expect_equal(const SlopeForm<Interval>& a, const SlopeForm<Interval>& b, const char* what) {
  expect_equal(a.at_mid, b.at_mid, what);
  expect_equal(a.slope, b.slope, what);
  expect_equal(a.range, b.range, what);
}

/// @returns whether the box is regular
bool expect_equal_boxes(const ProofModel<Interval>& with, const ProofModel<Interval>& without, const RandomBox& at) {
  const Segment segment = Segment::straight(at.from, at.to);
  BoxEnclosure<Interval> a, b;
  const bool is_sound = run_upward([&] { a = enclose_box(with, segment, at.box); });
  EXPECT_EQ(is_sound, run_upward([&] { b = enclose_box(without, segment, at.box); }));
  if (!is_sound) return false;
  EXPECT_EQ(a.regular, b.regular);
  EXPECT_EQ(a.margins.size, b.margins.size);
  for (std::size_t i = 0; i < kCables; ++i) {
    expect_equal(a.length[i], b.length[i], "length");
    if (!a.regular || !b.regular) continue;
    expect_equal(a.density[i], b.density[i], "density");
    expect_equal(a.below[i], b.below[i], "below");
    expect_equal(a.above[i], b.above[i], "above");
    expect_equal(a.low[i], b.low[i], "low");
    expect_equal(a.high[i], b.high[i], "high");
  }
  for (std::size_t n = 0; n < std::min(a.margins.size, b.margins.size); ++n) {
    EXPECT_EQ(a.margins.entries[n].id, b.margins.entries[n].id);
    expect_equal(a.margins.entries[n].value, b.margins.entries[n].value, "margin");
  }
  return a.regular;
}

void expect_equal_to_templates(const Problem& problem) {
  const ProofModel<Interval> with = make_proof_model(problem);
  ASSERT_NE(with.lanes, nullptr);
  ProofModel<Interval> without = make_proof_model(problem);
  without.lanes.reset();
  std::mt19937_64 random(1);
  constexpr int kBoxes = 3000;
  int regular = 0;
  for (int n = 0; n < kBoxes && !::testing::Test::HasFailure(); ++n) {
    regular += expect_equal_boxes(with, without, RandomBox(random)) ? 1 : 0;
  }
  EXPECT_GT(regular, kBoxes / 4);
  EXPECT_LT(regular, kBoxes);  // boxes that are too wide, too
}

/// On a dense ellipsoid, and with a load point that is not the platform's origin.
Problem skewed(Problem problem) {
  problem.load.point_m = {"0.01", "-0.02", "0.015"};
  EllipsoidText& ellipsoid = problem.load.ellipsoid.value();
  ellipsoid[0][1] = ellipsoid[1][0] = "2000";
  ellipsoid[3][5] = ellipsoid[5][3] = "-300000";
  return problem;
}

TEST(Lanes, GiveWhatTheTemplatesGive) {
  expect_equal_to_templates(testing::robot1_slice());
  expect_equal_to_templates(testing::robot2_sphere());
}

TEST(Lanes, GiveWhatTheTemplatesGiveOnADenseEllipsoidAboutAnyPoint) {
  expect_equal_to_templates(skewed(testing::robot1_slice()));
}

TEST(Lanes, GiveWhatTheTemplatesGiveOfItems) {
  Problem problem = testing::robot1_slice();
  problem.load.point_m = {"0.01", "-0.02", "0.015"};
  problem.load.ellipsoid.reset();
  problem.load.wrench.fill("0");
  problem.load.gravity_m_s2 = {"0", "0", "10"};
  problem.load.items = {{"block", Weight{"0.0995", "0.1005", {"0.01", "0", "0"}, "0.0005"}},
                        {"wind", Force{DiscOfVectors{"0.004", {"0", "0", "1"}}, Axes::kWorld, {"0", "0", "0.1"}}}};
  expect_equal_to_templates(problem);
}

// ---- Rates ----------------------------------------------------------------------------------------------------------

/// How a platform may move somewhere near a place; all is thin or wide.
ThirdPathRates<Interval> random_rates(std::mt19937_64& random, const Vector3<double>& near) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double radius = random() % 3 == 0 ? 0 : std::exp2(uniform(-30, -4));
  const auto around = [&](double x) { return Interval(x - radius * uniform(0, 1), x + radius * uniform(0, 1)); };
  ThirdPathRates<Interval> x;
  for (int k = 0; k < 3; ++k) {
    x.p(k) = around(near(k) + uniform(-0.05, 0.05));
    for (Interval* rate : {&x.p1(k), &x.p2(k), &x.p3(k), &x.w(k), &x.w1(k), &x.w2(k)}) *rate = around(uniform(-2, 2));
  }
  const Eigen::Quaterniond turn(1, uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  const Eigen::Matrix3d r = turn.normalized().toRotationMatrix();
  for (int k = 0; k < 9; ++k) x.r_WP(k) = around(r(k));
  return x;
}

TEST(Lanes, LengthsChangeAsTheTemplatesSay) {
  const ProofModel<Interval> model = make_proof_model(skewed(testing::robot1_slice()));
  std::mt19937_64 random(3);
  int sound = 0;
  constexpr int kTrials = 2000;
  for (int n = 0; n < kTrials && !::testing::Test::HasFailure(); ++n) {
    ThirdPathRates<Interval> x;
    std::array<WinchRate<Interval>, kCables> by_s;
    std::array<Interval, kCables> third;
    const bool is_sound = run_upward([&] {
      x = random_rates(random, {0, 0, 0.35});
      for (std::size_t i = 0; i < kCables; ++i) {
        by_s[i] = winch_rate(model.model, i, x.p, x.r_WP, Rates<Interval>{x.p1, x.p2, x.w, x.w1});
        third[i] = third_derivative_of_length(model.model, i, x, by_s[i]);
      }
    });
    sound += is_sound ? 1 : 0;
    for (const Level level : kLevels) {
      const lanes::Kernels* const kernels = lanes::kernels_of(level);
      if (kernels == nullptr) continue;
      lanes::LengthRates all, two;
      lanes::Outcome outcome{};
      const bool is_sound_in_lanes = run_upward([&] {
        outcome = kernels->differentiate_lengths(*model.lanes, lanes_rates(x), lanes::Order::kThird, all);
        static_cast<void>(kernels->differentiate_lengths(
            *model.lanes, lanes_rates(static_cast<const PathRates<Interval>&>(x)), lanes::Order::kSecond, two));
      });
      ASSERT_EQ(is_sound_in_lanes && outcome == lanes::Outcome::kYes, is_sound) << lanes::name(level);
      if (!is_sound) continue;
      for (std::size_t i = 0; i < kCables; ++i) {
        expect_equal(lanes_detail::interval(all.first, i), by_s[i].speed, "first of three");
        expect_equal(lanes_detail::interval(all.second, i), by_s[i].acceleration, "second of three");
        expect_equal(lanes_detail::interval(all.third, i), third[i], "third");
        expect_equal(lanes_detail::interval(two.first, i), by_s[i].speed, "first of two");
        expect_equal(lanes_detail::interval(two.second, i), by_s[i].acceleration, "second of two");
      }
    }
  }
  EXPECT_GT(sound, kTrials / 2);
}

TEST(Lanes, RatesOfALengthThatMayBeZeroAreAFault) {
  const ProofModel<Interval> model = make_proof_model(testing::robot1_slice());
  for (std::size_t cable = 0; cable < kCables; ++cable) {
    for (const Level level : kLevels) {
      const lanes::Kernels* const kernels = lanes::kernels_of(level);
      if (kernels == nullptr) continue;
      lanes::LengthRates rates;
      lanes::Outcome outcome{};
      static_cast<void>(run_upward([&] {
        std::mt19937_64 random(4);
        ThirdPathRates<Interval> x = random_rates(random, {0, 0, 0.35});
        const Vector3<Interval> reach = turned(x.r_WP, model.model.p_PB[cable]);
        for (int k = 0; k < 3; ++k) x.p(k) = model.model.p_WA[cable](k) - reach(k);
        outcome = kernels->differentiate_lengths(*model.lanes, lanes_rates(x), lanes::Order::kSecond, rates);
      }));
      EXPECT_EQ(outcome, lanes::Outcome::kFault) << lanes::name(level) << ", cable " << cable;
    }
  }
}

// ---- Levels ---------------------------------------------------------------------------------------------------------

/// Everything that a kernel says of a pose over a box, numbers of the six cables as bits.
std::vector<std::uint64_t> bits_of(const lanes::BoxKernel<1>& kernel, const lanes::Machine& machine,
                                   const lanes::PoseForms<1>& pose, const lanes::Ends (&wrench)[6], bool& is_sound) {
  lanes::Box<1> box;
  std::memset(&box, 0, sizeof box);
  std::array<lanes::Outcome, 4> outcomes{};
  is_sound = run_upward([&] {
    outcomes[0] = kernel.enclose_geometry(machine, pose, box);
    outcomes[1] = kernel.precondition(box);
    if (outcomes[1] != lanes::Outcome::kYes) return;
    outcomes[2] = kernel.bound_inverse(box);
    if (outcomes[2] == lanes::Outcome::kYes) outcomes[3] = kernel.enclose_tensions(machine, wrench, box);
  });
  std::vector<std::uint64_t> result;
  for (const lanes::Outcome outcome : outcomes) result.push_back(static_cast<std::uint64_t>(outcome));
  result.push_back(box.enclosed);
  const auto add = [&](const auto& what) {
    const auto* row = reinterpret_cast<const lanes::Row*>(&what);
    const std::size_t bytes = sizeof(what);
    for (std::size_t n = 0; n < bytes / sizeof(lanes::Row); ++n) {
      for (std::size_t i = 0; i < kCables; ++i) result.push_back(std::bit_cast<std::uint64_t>(row[n].x[i]));
    }
  };
  add(box.length);
  add(box.d_mid);
  add(box.d_slope);
  add(box.c);
  add(box.a1);
  if (outcomes[2] != lanes::Outcome::kYes) return result;
  add(box.q0);
  add(box.q);
  if (outcomes[3] != lanes::Outcome::kYes) return result;
  add(box.nominal);
  add(box.spread);
  add(box.low);
  add(box.high);
  return result;
}

TEST(Lanes, AllLevelsOfTheProcessorGiveTheSameBits) {
  const ProofModel<Interval> model = make_proof_model(skewed(testing::robot1_slice()));
  lanes::Ends wrench[6];
  for (int j = 0; j < 6; ++j) wrench[j] = lanes_detail::ends(model.model.wrench(j));
  std::mt19937_64 random(2);
  constexpr int kBoxes = 3000;
  int sound = 0;
  for (int n = 0; n < kBoxes; ++n) {
    const RandomBox at(random);
    const Segment segment = Segment::straight(at.from, at.to);
    lanes::PoseForms<1> pose;
    const bool is_enclosed = run_upward([&] {
      const EnclosedBox<Interval> s = enclose<Interval>(at.box);
      const double radius = at.box.radius();
      const auto motion = undisturbed_motion(model, segment, s, Interval(-radius, radius));
      pose = lanes_pose<1>(motion.p_WP, motion.r_WP);
      pose.radius[0] = radius;
    });
    ASSERT_TRUE(is_enclosed);
    bool is_first_sound = false;
    const auto first = bits_of(lanes::kernels_of(Level::kSse2)->box, *model.lanes, pose, wrench, is_first_sound);
    sound += is_first_sound ? 1 : 0;
    for (const Level level : kLevels) {
      const lanes::Kernels* const kernels = lanes::kernels_of(level);
      if (kernels == nullptr) continue;
      bool is_sound = false;
      const auto bits = bits_of(kernels->box, *model.lanes, pose, wrench, is_sound);
      ASSERT_EQ(is_sound, is_first_sound) << lanes::name(level) << ", box " << n;
      if (!is_sound) continue;
      ASSERT_EQ(bits, first) << lanes::name(level) << ", box " << n;
    }
  }
  EXPECT_GT(sound, kBoxes / 2);
}

// ---- Several variables ----------------------------------------------------------------------------------------------

/// `pose` as a function of N variables: number `which` is t, and on the others, whose extent is anything, it does not
/// depend.
template <int N>
lanes::PoseForms<N> among(const lanes::PoseForms<1>& pose, int which) {
  lanes::PoseForms<N> result;
  const auto set = [&](const lanes::Form<1>& from, lanes::Form<N>& to) {
    to.at_mid = from.at_mid;
    to.range = from.range;
    for (int k = 0; k < N; ++k) to.slope[k] = k == which ? from.slope[0] : lanes::Ends{0, 0};
  };
  for (int i = 0; i < 3; ++i) {
    set(pose.p[i], result.p[i]);
    for (int j = 0; j < 3; ++j) set(pose.r[i][j], result.r[i][j]);
  }
  for (int k = 0; k < N; ++k) result.radius[k] = k == which ? pose.radius[0] : 0.37;
  return result;
}

/// Whether lengths and tensions of N variables are those of one, bit for bit.
template <int N>
void expect_as_of_one(const lanes::Kernels& kernels, const lanes::BoxKernel<N>& kernel, const lanes::Machine& machine,
                      const lanes::PoseForms<1>& pose, const lanes::Ends (&wrench)[6], int which) {
  using lanes::Outcome;
  lanes::Box<1> one;
  lanes::Box<N> many;
  std::array<Outcome, 4> of_one{}, of_many{};
  const auto run = [&](const auto& by, const auto& forms, auto& box, std::array<Outcome, 4>& outcomes) {
    return run_upward([&] {
      outcomes[0] = by.enclose_geometry(machine, forms, box);
      if (outcomes[0] == Outcome::kYes) outcomes[1] = by.precondition(box);
      if (outcomes[1] == Outcome::kYes) outcomes[2] = by.bound_inverse(box);
      if (outcomes[2] == Outcome::kYes) outcomes[3] = by.enclose_tensions(machine, wrench, box);
    });
  };
  of_one.fill(Outcome::kNo);
  of_many.fill(Outcome::kNo);
  const bool is_sound = run(kernels.box, pose, one, of_one);
  ASSERT_EQ(run(kernel, among<N>(pose, which), many, of_many), is_sound);
  ASSERT_EQ(of_many, of_one);
  if (!is_sound || of_one[3] != Outcome::kYes) return;
  const auto expect_same = [&](const lanes::FormRow<1>& a, const lanes::FormRow<N>& b) {
    for (std::size_t i = 0; i < kCables; ++i) {
      expect_equal(lanes_detail::interval(a.at_mid, i), lanes_detail::interval(b.at_mid, i), "at m");
      expect_equal(lanes_detail::interval(a.range, i), lanes_detail::interval(b.range, i), "range");
      for (int k = 0; k < N; ++k) {
        expect_equal(k == which ? lanes_detail::interval(a.slope[0], i) : Interval(0.0),
                     lanes_detail::interval(b.slope[k], i), "slope");
      }
    }
  };
  EXPECT_EQ(many.enclosed, one.enclosed);
  expect_same(one.length, many.length);
  expect_same(one.nominal, many.nominal);
  expect_same(one.spread, many.spread);
  expect_same(one.low, many.low);
  expect_same(one.high, many.high);
}

/// What Farkas's test compares, as bits.
template <int N>
std::vector<double> work_of(const lanes::BoxKernel<N>& kernel, const lanes::Machine& machine,
                            const lanes::PoseForms<N>& pose, const lanes::Ends (&wrench)[6]) {
  lanes::Box<N> box;
  lanes::WorkRow work;
  lanes::Ends density[kCables];
  for (int j = 0; j < kCables; ++j) density[j] = {-(j + 1.0), 10.0 + j};
  bool is_known = false;
  const bool is_sound = run_upward([&] {
    is_known = kernel.enclose_geometry(machine, pose, box) == lanes::Outcome::kYes &&
               kernel.precondition(box) == lanes::Outcome::kYes;
    if (is_known) kernel.compare_work(machine, wrench, density, box, work);
  });
  std::vector<double> result = {is_sound ? 1.0 : 0.0, is_known ? 1.0 : 0.0};
  if (!is_sound || !is_known) return result;
  for (const lanes::Row* row : {&work.least, &work.greatest, &work.sum.minus_lower, &work.sum.upper}) {
    result.insert(result.end(), row->x, row->x + kCables);
  }
  return result;
}

TEST(Lanes, OfSeveralVariablesGiveWhatOneGivesAndTheSameOnAllLevels) {
  const ProofModel<Interval> model = make_proof_model(skewed(testing::robot1_slice()));
  lanes::Ends wrench[6];
  for (int j = 0; j < 6; ++j) wrench[j] = lanes_detail::ends(model.model.wrench(j));
  std::mt19937_64 random(5);
  int compared = 0;
  for (int n = 0; n < 300 && !::testing::Test::HasFailure(); ++n) {
    const RandomBox at(random);
    const Segment segment = Segment::straight(at.from, at.to);
    lanes::PoseForms<1> pose;
    const double radius = at.box.radius();
    ASSERT_TRUE(run_upward([&] {
      const auto motion = undisturbed_motion(model, segment, enclose<Interval>(at.box), Interval(-radius, radius));
      pose = lanes_pose<1>(motion.p_WP, motion.r_WP);
      pose.radius[0] = radius;
    }));
    std::vector<double> first_of_two, first_of_three;
    for (const Level level : kLevels) {
      const lanes::Kernels* const kernels = lanes::kernels_of(level);
      if (kernels == nullptr) continue;
      for (const int which : {0, 1}) {
        expect_as_of_one<2>(*kernels, kernels->cell_of_two, *model.lanes, pose, wrench, which);
        expect_as_of_one<3>(*kernels, kernels->cell_of_three, *model.lanes, pose, wrench, 2 * which);
      }
      const auto of_two = work_of<2>(kernels->cell_of_two, *model.lanes, among<2>(pose, 1), wrench);
      const auto of_three = work_of<3>(kernels->cell_of_three, *model.lanes, among<3>(pose, 1), wrench);
      if (first_of_two.empty()) {
        first_of_two = of_two;
        first_of_three = of_three;
      }
      EXPECT_EQ(of_two, first_of_two) << lanes::name(level);
      EXPECT_EQ(of_three, first_of_three) << lanes::name(level);
      EXPECT_EQ(of_three, of_two);
      if (of_two.size() > 2) ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

TEST(Lanes, TheSelfTestPassesRoundingUpwardAndFailsRoundingToNearest) {
  for (const Level level : kLevels) {
    const lanes::Kernels* const kernels = lanes::kernels_of(level);
    if (kernels == nullptr) continue;
    EXPECT_EQ(kernels->level, level);
    const char* failed = "not run";
    EXPECT_TRUE(run_upward([&] { failed = kernels->failed_rounding(); }));
    EXPECT_EQ(failed, nullptr) << lanes::name(level);
    EXPECT_NE(kernels->failed_rounding(), nullptr) << lanes::name(level);
  }
}

TEST(Lanes, DivisionByZeroInAnyLaneIsAFault) {
  for (const Level level : kLevels) {
    const lanes::Kernels* const kernels = lanes::kernels_of(level);
    if (kernels == nullptr) continue;
    for (std::size_t lane = 0; lane <= kCables; ++lane) {
      lanes::Row ones, divisors, quotients;
      for (double& x : ones.x) x = 1.0;
      divisors = ones;
      if (lane < kCables) divisors.x[lane] = 0.0;
      EXPECT_EQ(run_upward([&] { kernels->divide(ones, divisors, quotients); }), lane == kCables)
          << lanes::name(level) << ", lane " << lane;
    }
  }
}

TEST(Lanes, AnAnchorOfUnknownSignIsLeftToTheTemplates) {
  ProofModel<Interval> model = make_proof_model(testing::robot1_slice());
  model.model.p_PB[2](1) = Interval(-1e-9, 2e-9);
  EXPECT_EQ(make_lanes_machine(model.model), nullptr);
}

}  // namespace
}  // namespace taut
