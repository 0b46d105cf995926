// SPDX-License-Identifier: GPL-3.0-or-later
// Loads that are stated as items, against explicit loads (tests/soundness/loads.h): the range of a density is reached
// and never left, centred forms enclose it, and the extremal loads of a box are its derivatives (Danskin's theorem).
#include "kinematics/loads.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "certify/arithmetic/slope_form.h"
#include "certify/tolerance/extremal_load.h"
#include "kinematics/geometry.h"
#include "kinematics/jet.h"
#include "tests/soundness/loads.h"

namespace taut::testing {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

RationalVector random_vector(Random& random) {
  RationalVector v;
  for (RationalText& x : v) x = fmt::format("{:.6f}", uniform(random, -2, 2));
  return v;
}

VectorSet random_set(Random& random) {
  switch (random() % 3) {
    case 0: return BallOfVectors{"1/3"};
    case 1: return DiscOfVectors{"0.7", random_vector(random)};
    default: break;
  }
  const double lower = uniform(random, -1, 1);
  return SegmentOfVectors{random_vector(random), fmt::format("{:.6f}", lower), fmt::format("{:.6f}", lower + 0.5)};
}

/// One of each kind, in either axes.
LoadText random_load(Random& random) {
  LoadText load;
  load.point_m = random_vector(random);
  load.gravity_m_s2 = {"0.5", "-1", "-9.81"};
  load.items.push_back({"fixed", Weight{"3", "3", random_vector(random), "0"}});
  load.items.push_back({"loose", Weight{"2", "5/2", random_vector(random), "0.125"}});
  for (const Axes axes : {Axes::kWorld, Axes::kPlatform}) {
    const char* name = axes == Axes::kWorld ? "world" : "platform";
    load.items.push_back({fmt::format("{} force", name), Force{random_set(random), axes, random_vector(random)}});
    load.items.push_back({fmt::format("{} moment", name), Moment{random_set(random), axes}});
    LoadCases cases;
    for (int j = 0; j < 3; ++j) {
      auto& w = cases.wrenches.emplace_back();
      for (RationalText& x : w) x = fmt::format("{:.6f}", uniform(random, -1, 1));
    }
    cases.axes = axes;
    cases.at = random_vector(random);
    load.items.push_back({fmt::format("{} cases", name), cases});
  }
  return load;
}

using Six = std::array<double, 6>;

Six random_row(Random& random) {
  Six y;
  for (double& x : y) x = uniform(random, -1, 1);
  return y;
}

Matrix3<double> random_rotation(Random& random) {
  return rotation(uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3));
}

/// What y w may be over all items, by explicit loads.
campaign::Range<double> range(const LoadText& load, const Matrix3<double>& r, const Six& y) {
  campaign::Rows<double> rows;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) rows[i][j] = r(static_cast<int>(i), static_cast<int>(j));
  }
  const campaign::TensionOf<double> value{y};
  campaign::Range<double> sum{0, 0};
  for (const LoadItem& item : load.items) {
    const auto of_item =
        campaign::extremes(campaign::make_load<double>(item), campaign::numbers<double>(load.gravity_m_s2), rows,
                           campaign::numbers<double>(load.point_m), value);
    sum.low += of_item.low;
    sum.high += of_item.high;
  }
  return sum;
}

template <class S>
Vector6<S> vector(const Six& y) {
  Vector6<S> result;
  for (int k = 0; k < 6; ++k) result(k) = S(y[static_cast<std::size_t>(k)]);
  return result;
}

template <class S>
S dot(const Vector6<S>& a, const Vector6<S>& b) {
  S sum = a(0) * b(0);
  for (int k = 1; k < 6; ++k) sum = sum + a(k) * b(k);
  return sum;
}

TEST(Loads, DensitiesFillTheRangeOfExplicitLoads) {
  Random random(1);
  for (int n = 0; n < 300; ++n) {
    const LoadText load = random_load(random);
    const LoadModel<double> model = make_load_model<double>(load);
    const Matrix3<double> r = random_rotation(random);
    const Six row = random_row(random);
    const LoadsAtPose<double> at = loads_at(model, r);
    const Vector6<double> y = vector<double>(row);
    const DensityRange<double> seen = density_range(model, at, y);
    const double nominal = dot(y, at.nominal);
    const campaign::Range<double> expected = range(load, r, row);
    ASSERT_NEAR(nominal - seen.below, expected.low, 1e-10);
    ASSERT_NEAR(nominal + seen.above, expected.high, 1e-10);
    ASSERT_GE(seen.below, 0);
    ASSERT_GE(seen.above, 0);
  }
}

TEST(Loads, AWeightInAnyBallOfMassesAndPlaces) {
  // By hand: 2 kg or 4 kg, at most 0.5 m off below the load point, under 10 m/s^2. A pure force row sees the mass
  // alone, a pure moment row the offset alone.
  LoadText load;
  load.point_m = {"0", "0", "0"};
  load.gravity_m_s2 = {"0", "0", "-10"};
  load.items.push_back({"block", Weight{"2", "4", {"0", "0", "-1"}, "1/2"}});
  const LoadModel<double> model = make_load_model<double>(load);
  const LoadsAtPose<double> at = loads_at(model, Matrix3<double>(Matrix3<double>::Identity()));
  EXPECT_EQ(at.nominal, (Vector6<double>() << 0, 0, -30, 0, 0, 0).finished());
  const DensityRange<double> of_force = density_range(model, at, vector<double>({0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(of_force.below, 10);
  EXPECT_EQ(of_force.above, 10);
  const DensityRange<double> of_moment = density_range(model, at, vector<double>({0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(of_moment.below, 20);
  EXPECT_EQ(of_moment.above, 20);
}

TEST(Loads, JetsAreTheDerivatives) {
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    const LoadModel<double> model = make_load_model<double>(random_load(random));
    const std::array<double, 3> angles = {uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3)};
    const Six row = random_row(random), direction = random_row(random);
    const auto evaluate = [&]<class S>(const S& t) {
      const Matrix3<S> r = rotation(S(t + angles[0]), S(t * 0.5 + angles[1]), S(-t + angles[2]));
      Vector6<S> y;
      for (int k = 0; k < 6; ++k) {
        y(k) = t * direction[static_cast<std::size_t>(k)] + row[static_cast<std::size_t>(k)];
      }
      const LoadsAtPose<S> at = loads_at(model, r);
      const DensityRange<S> seen = density_range(model, at, y);
      return std::array<S, 2>{dot(y, at.nominal) - seen.below, dot(y, at.nominal) + seen.above};
    };
    constexpr double kStep = 1e-6;
    const auto jets = evaluate(Jet<double, 1>(0.0, 0));
    const auto ahead = evaluate(kStep), behind = evaluate(-kStep);
    for (std::size_t side = 0; side < 2; ++side) {
      ASSERT_NEAR(jets[side].partial[0], (ahead[side] - behind[side]) / (2 * kStep), 2e-4) << n;
    }
  }
}

template <class I>
void expect_forms_to_enclose() {
  Random random(3);
  for (int n = 0; n < 60; ++n) {
    const LoadText load = random_load(random);
    const LoadModel<I> model = make_load_model<I>(load);
    const std::array<double, 3> angles = {uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3)};
    Six row = random_row(random);
    const Six direction = random_row(random);
    if (n % 3 == 0) row.fill(0);  // every norm vanishes at the midpoint
    const double radius = std::pow(2.0, -static_cast<double>(n % 12));
    const I offset(-radius, radius);
    using Form = SlopeForm<I>;
    const Form t(I(0.0), I(1.0), offset);
    const auto angle = [&](int k, double slope) { return t * I(slope) + I(angles[static_cast<std::size_t>(k)]); };
    const Matrix3<Form> r = rotation(angle(0, 1), angle(1, 0.5), angle(2, -1));
    Vector6<Form> y;
    for (int k = 0; k < 6; ++k) {
      y(k) = t * I(direction[static_cast<std::size_t>(k)]) + I(row[static_cast<std::size_t>(k)]);
    }
    const LoadsAtPose<Form> at = loads_at(model, r);
    const DensityRange<Form> seen = density_range(model, at, y);
    const std::array<Form, 2> forms = {dot(y, at.nominal) - seen.below, dot(y, at.nominal) + seen.above};
    for (const double x : {-1.0, -0.37, -0.001, 0.0, 0.25, 1.0}) {
      const double s = x * radius;
      Six here;
      for (std::size_t k = 0; k < 6; ++k) here[k] = row[k] + s * direction[k];
      const campaign::Range<double> exact =
          range(load, rotation(s + angles[0], 0.5 * s + angles[1], -s + angles[2]), here);
      const std::array<double, 2> values = {exact.low, exact.high};
      for (std::size_t side = 0; side < 2; ++side) {
        const I mean_value = forms[side].at_mid + forms[side].slope * I(s);
        constexpr double kRounding = 1e-12;  // of the explicit loads
        for (const I& enclosure : {mean_value, forms[side].range}) {
          ASSERT_LE(lower_bound(enclosure), values[side] + kRounding * 100) << n << " at " << x;
          ASSERT_GE(upper_bound(enclosure), values[side] - kRounding * 100) << n << " at " << x;
        }
      }
    }
  }
}

TEST(Loads, CentredFormsEncloseThem) {
  ASSERT_TRUE(run_upward([] { expect_forms_to_enclose<Interval>(); }));
  expect_forms_to_enclose<MpInterval>();
}

TEST(ExtremalLoads, AreDerivativesOfTheRange) {
  Random random(4);
  for (int n = 0; n < 60; ++n) {
    const LoadText load = random_load(random);
    const Matrix3<double> r = random_rotation(random);
    const Six row = random_row(random);
    const LoadModel<MpInterval> model = make_load_model<MpInterval>(load);
    const Matrix3<MpInterval> enclosed = r.unaryExpr([](double x) { return MpInterval(x); });
    const LoadsAtPose<MpInterval> at = loads_at(model, enclosed);
    const ExtremalLoads<MpInterval> loads(model, at);
    const auto part = [&](std::size_t first) {
      return Vector3<MpInterval>(MpInterval(row[first]), MpInterval(row[first + 1]), MpInterval(row[first + 2]));
    };
    for (const Extremum which : {Extremum::kLeast, Extremum::kGreatest}) {
      const ExtremalLoad<MpInterval> found = loads.find(part(0), part(3), which);
      const auto value = [&](const Six& y, const Matrix3<double>& turned) {
        const campaign::Range<double> all = range(load, turned, y);
        return which == Extremum::kLeast ? all.low : all.high;
      };
      constexpr double kStep = 1e-6;
      for (std::size_t k = 0; k < 6; ++k) {
        Six ahead = row, behind = row;
        ahead[k] += kStep;
        behind[k] -= kStep;
        const double slope = (value(ahead, r) - value(behind, r)) / (2 * kStep);
        ASSERT_NEAR(midpoint_approx(found.wrench(static_cast<int>(k))), slope, 2e-4) << n << ", component " << k;
        ASSERT_LT(upper_bound(found.wrench(static_cast<int>(k))) - lower_bound(found.wrench(static_cast<int>(k))),
                  1e-9);
      }
      for (int k = 0; k < 3; ++k) {
        const auto turned = [&](double by) {
          return Matrix3<double>(Eigen::AngleAxisd(by, Vector3<double>::Unit(k)).toRotationMatrix() * r);
        };
        const double slope = (value(row, turned(kStep)) - value(row, turned(-kStep))) / (2 * kStep);
        ASSERT_NEAR(midpoint_approx(found.by_turn(k)), slope, 2e-4) << n << ", turn about axis " << k;
      }
    }
  }
}

/// Where it can't be told which load is extremal, all candidates are enclosed.
TEST(ExtremalLoads, EncloseEveryCandidate) {
  LoadText load;
  load.point_m = {"0", "0", "0"};
  load.gravity_m_s2 = {"0", "0", "-10"};
  load.items.push_back({"block", Weight{"2", "4", {"0", "0", "0"}, "0.5"}});
  load.items.push_back({"any", Force{BallOfVectors{"3"}, Axes::kWorld, {"0", "0", "0"}}});
  const LoadModel<MpInterval> model = make_load_model<MpInterval>(load);
  Matrix3<MpInterval> identity;
  for (int i = 0; i < 9; ++i) identity(i) = MpInterval(i % 4 == 0 ? 1.0 : 0.0);
  const LoadsAtPose<MpInterval> at = loads_at(model, identity);
  const MpInterval around(-1e-9, 1e-9);
  const Vector3<MpInterval> nearly(around, around, around);
  const ExtremalLoad<MpInterval> found = ExtremalLoads<MpInterval>(model, at).find(nearly, nearly, Extremum::kGreatest);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE(lower_bound(found.wrench(k)), (k == 2 ? -40 : 0) - 3);
    EXPECT_GE(upper_bound(found.wrench(k)), (k == 2 ? -20 : 0) + 3);
  }
  for (const int k : {3, 4}) {  // of the centre of gravity, either way
    EXPECT_LE(lower_bound(found.wrench(k)), -20);
    EXPECT_GE(upper_bound(found.wrench(k)), 20);
  }
}

}  // namespace
}  // namespace taut::testing
