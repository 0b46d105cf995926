// SPDX-License-Identifier: GPL-3.0-or-later
// Loads that are stated as items, against explicit loads (tests/soundness/loads.h): the range of a density is reached
// and never left, centred forms enclose it, and the extremal loads of a box are its derivatives (Danskin's theorem).
#include "kinematics/loads.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

#include "certify/arithmetic/slope_form.h"
#include "certify/loads/extremal_load.h"
#include "certify/loads/item_rows.h"
#include "certify/row_forms.h"
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
  load.items.push_back({"swinging", Weight{"4", "4", random_vector(random), "0.2"}});
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

/// Rows that move along straight lines, and are off them by as much as they say.
struct MovingRows {
  std::array<Six, kCables> row, direction, error, slope_error;

  MovingRows(Random& random, bool are_exact) {
    const double off = are_exact ? 0 : 1e-3;
    for (std::size_t i = 0; i < kCables; ++i) {
      row[i] = random_row(random);
      direction[i] = random_row(random);
      for (std::size_t k = 0; k < 6; ++k) {
        error[i][k] = off * uniform(random, -1, 1);
        slope_error[i][k] = off * uniform(random, -1, 1);
      }
    }
  }
  [[nodiscard]] Six at(std::size_t i, double t) const {
    Six y;
    for (std::size_t k = 0; k < 6; ++k) y[k] = row[i][k] + error[i][k] + t * (direction[i][k] + slope_error[i][k]);
    return y;
  }
  [[nodiscard]] RowForms forms(double radius) const {
    const auto size = [](const std::array<Six, kCables>& of, std::size_t i, std::size_t first) {
      return 1e-9 + std::hypot(of[i][first], of[i][first + 1], of[i][first + 2]);
    };
    RowForms rows;
    rows.radius = radius;
    for (const std::size_t first : {0, 3}) {
      VectorForm<taut::Six>& v = first == 0 ? rows.force : rows.moment;
      for (std::size_t k = 0; k < 3; ++k) {
        v.mid[k] = taut::Six::generate([&](std::size_t i) { return row[i][first + k]; });
        v.slope[k] = taut::Six::generate([&](std::size_t i) { return direction[i][first + k]; });
      }
      v.mid_error = taut::Six::generate([&](std::size_t i) { return size(error, i, first); });
      v.slope_error = taut::Six::generate([&](std::size_t i) { return size(slope_error, i, first); });
      v.mid_size = taut::Six::generate([&](std::size_t i) { return size(row, i, first); });
      v.slope_size = taut::Six::generate([&](std::size_t i) { return size(direction, i, first); });
    }
    return rows;
  }
};

void expect_in_form(const SlopeForm<Interval>& form, double t, double value, const std::string& what) {
  constexpr double kRounding = 1e-10;  // of the explicit loads
  for (const Interval& enclosure : {Interval(form.at_mid + form.slope * Interval(t)), form.range}) {
    ASSERT_LE(lower_bound(enclosure), value + kRounding) << what << " at " << t;
    ASSERT_GE(upper_bound(enclosure), value - kRounding) << what << " at " << t;
  }
}

void expect_rows_to_enclose() {
  Random random(5);
  for (int n = 0; n < 60; ++n) {
    const LoadText load = random_load(random);
    const ItemRows items(make_load_model<Interval>(load));
    const std::array<double, 3> angles = {uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3)};
    MovingRows moving(random, n % 2 == 0);
    if (n % 3 == 0) moving.row[2].fill(0);  // every norm nearly vanishes at the midpoint
    const double radius = std::pow(2.0, -static_cast<double>(n % 12));
    const SlopeForm<Interval> t(Interval(0.0), Interval(1.0), Interval(-radius, radius));
    const auto angle = [&](std::size_t k, double slope) { return t * Interval(slope) + Interval(angles[k]); };
    const RotationForm turn = ItemRows::rotation(rotation(angle(0, 1), angle(1, 0.5), angle(2, -1)));
    const RowForms rows = moving.forms(radius);
    const ItemRows::Forms nominal = times(rows, items.nominal(turn));
    const ItemRows::Reach reach = items.reach(turn, rows);
    for (const double x : {-1.0, -0.37, -0.001, 0.0, 0.25, 1.0}) {
      const double s = x * radius;
      const Matrix3<double> r = rotation(s + angles[0], 0.5 * s + angles[1], -s + angles[2]);
      const Vector6<double> exact_nominal = loads_at(make_load_model<double>(load), r).nominal;
      for (std::size_t i = 0; i < kCables; ++i) {
        const Six y = moving.at(i, s);
        const campaign::Range<double> exact = range(load, r, y);
        const double middle = dot(vector<double>(y), exact_nominal);
        const std::string what = fmt::format("case {}, row {}", n, i);
        expect_in_form(nominal[i], s, middle, what + ", nominal");
        expect_in_form(reach.below[i], s, middle - exact.low, what + ", below");
        expect_in_form(reach.above[i], s, exact.high - middle, what + ", above");
      }
    }
  }
}

TEST(ItemRows, EncloseTheRangeOfExplicitLoads) {
  ASSERT_TRUE(run_upward([] { expect_rows_to_enclose(); }));
}

/// At a point, with exact rows, nothing but rounding is added.
TEST(ItemRows, AreTightAtAPoint) {
  Random random(6);
  ASSERT_TRUE(run_upward([&] {
    for (int n = 0; n < 20; ++n) {
      const LoadText load = random_load(random);
      const MovingRows moving(random, true);
      RowForms rows = moving.forms(0x1p-30);
      for (VectorForm<taut::Six>* v : {&rows.force, &rows.moment}) v->mid_error = v->slope_error = taut::Six(0.0);
      const Matrix3<double> r = Matrix3<double>::Identity();
      const Matrix3<SlopeForm<Interval>> still = r.unaryExpr([](double x) { return SlopeForm<Interval>(x); });
      const ItemRows items(make_load_model<Interval>(load));
      const ItemRows::Reach reach = items.reach(ItemRows::rotation(still), rows);
      for (std::size_t i = 0; i < kCables; ++i) {
        const Six y = moving.at(i, 0);
        const campaign::Range<double> exact = range(load, r, y);
        const double middle = dot(vector<double>(y), loads_at(make_load_model<double>(load), r).nominal);
        EXPECT_NEAR(lower_bound(reach.above[i].at_mid), exact.high - middle, 1e-10);
        EXPECT_NEAR(upper_bound(reach.above[i].at_mid), exact.high - middle, 1e-10);
        EXPECT_NEAR(lower_bound(reach.below[i].range), middle - exact.low, 1e-6);
        EXPECT_NEAR(upper_bound(reach.below[i].range), middle - exact.low, 1e-6);
      }
    }
  }));
}

/// The rows of the inverse of a matrix that moves along a straight line.
TEST(ItemRows, AreThoseOfTheInverse) {
  Random random(7);
  const auto random_matrix = [&] {
    return Matrix6<double>(Matrix6<double>::NullaryExpr([&] { return uniform(random, -1, 1); }));
  };
  int compared = 0;
  for (int n = 0; n < 60; ++n) {
    const Matrix6<double> at_mid = random_matrix(), slope = random_matrix();
    const double radius = std::pow(2.0, -4 - static_cast<double>(n % 12));
    RowForms rows;
    bool is_set = false;
    ASSERT_TRUE(run_upward([&] {
      Matrix6<SlopeForm<Interval>> d;
      const SlopeForm<Interval> t(Interval(0.0), Interval(1.0), Interval(-radius, radius));
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) d(i, j) = t * Interval(slope(i, j)) + Interval(at_mid(i, j));
      }
      InverseBound<Interval> inverse;
      is_set = inverse.set(d, radius);
      if (is_set) rows = row_forms(inverse, radius);
    }));
    if (!is_set) continue;
    ++compared;
    for (const double x : {-1.0, -0.3, 0.0, 0.5, 1.0}) {
      const double s = x * radius;
      const Matrix6<double> exact = (at_mid + s * slope).inverse();
      for (const int first : {0, 3}) {
        const VectorForm<taut::Six>& v = first == 0 ? rows.force : rows.moment;
        const auto mid_error = v.mid_error.values(), slope_error = v.slope_error.values();
        for (std::size_t i = 0; i < kCables; ++i) {
          double square = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const double line = v.mid[k].values()[i] + s * v.slope[k].values()[i];
            const double off = exact(static_cast<int>(i), first + static_cast<int>(k)) - line;
            square += off * off;
          }
          ASSERT_LE(std::sqrt(square), mid_error[i] + std::abs(s) * slope_error[i] + 1e-10) << n << ", row " << i;
        }
      }
    }
  }
  EXPECT_GT(compared, 30);
}

/// In all of a set of rows and rotations: those of the midst, and others as far away as the set reaches.
void expect_extremes_to_enclose() {
  Random random(8);
  for (int n = 0; n < 60; ++n) {
    LoadText load = random_load(random);
    std::erase_if(load.items, [](const LoadItem& item) { return std::holds_alternative<LoadCases>(item.what); });
    const ItemRows items(make_load_model<Interval>(load));
    ASSERT_TRUE(items.has_extremes());
    const LoadModel<MpInterval> model = make_load_model<MpInterval>(load);
    const double off = n % 3 == 0 ? 0 : std::pow(10.0, -static_cast<double>(n % 7));
    const Matrix3<double> r = random_rotation(random);
    const MovingRows moving(random, true);
    const RowForms forms = moving.forms(1);
    const taut::Six error(std::sqrt(3.0) * off + 1e-12);
    const RowBalls rows{{forms.force.mid, error, forms.force.mid_size},
                        {forms.moment.mid, error, forms.moment.mid_size}};
    const Matrix3<Interval> turns =
        r.unaryExpr([&](double x) { return Interval(-(off + 1e-12 - x), x + off + 1e-12); });
    const ExtremalRows extremes = items.extremes(ItemRows::rotation(turns), rows);
    const Vector6<Interval> nominal = items.nominal_wrench(turns);
    for (int m = 0; m < 4; ++m) {
      const double by = m == 0 ? 0 : off;
      const Vector3<double> axis(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
      const Matrix3<double> turned = Eigen::AngleAxisd(0.5 * by, axis.normalized()).toRotationMatrix() * r;
      const Matrix3<MpInterval> here = turned.unaryExpr([](double x) { return MpInterval(x); });
      const LoadsAtPose<MpInterval> at = loads_at(model, here);
      for (int k = 0; k < 6; ++k) {
        ASSERT_LE(lower_bound(nominal(k)), midpoint_approx(at.nominal(k)) + 1e-10);
        ASSERT_GE(upper_bound(nominal(k)), midpoint_approx(at.nominal(k)) - 1e-10);
      }
      for (std::size_t i = 0; i < kCables; ++i) {
        Six y = moving.row[i];
        for (double& x : y) x += by * uniform(random, -1, 1);
        const auto part = [&](std::size_t k) {
          return Vector3<MpInterval>(MpInterval(y[k]), MpInterval(y[k + 1]), MpInterval(y[k + 2]));
        };
        const DensityRange<MpInterval> range = density_range(model, at, vector<MpInterval>(y));
        for (std::size_t side = 0; side < 2; ++side) {
          const ExtremalLoad<MpInterval> exact = ExtremalLoads<MpInterval>(model, at).find(
              part(0), part(3), side == 0 ? Extremum::kLeast : Extremum::kGreatest);
          const ExtremalRows::Side& seen = extremes.sides[side];
          const auto expect_within = [&](const VectorBall<taut::Six>& ball, const auto& entry, const char* what) {
            double square = 0;
            for (std::size_t k = 0; k < 3; ++k) {
              const double gap = ball.mid[k].values()[i] - entry(static_cast<int>(k));
              square += gap * gap;
            }
            ASSERT_LE(std::sqrt(square), ball.error.values()[i] + 1e-9) << what << " of row " << i << ", case " << n;
          };
          const Vector6<MpInterval> moved = exact.wrench - at.nominal;
          expect_within(
              seen.force, [&](int k) { return midpoint_approx(moved(k)); }, "force");
          expect_within(
              seen.moment, [&](int k) { return midpoint_approx(moved(3 + k)); }, "moment");
          expect_within(
              seen.turn, [&](int k) { return midpoint_approx(exact.by_turn(k)); }, "turn");
          const double reach = midpoint_approx(side == 0 ? range.below : range.above);
          ASSERT_GE(seen.reach.values()[i], reach - 1e-10);
          if (off == 0) {  // nothing but rounding is added
            ASSERT_LE(seen.reach.values()[i], reach + 1e-8);
            ASSERT_LE(seen.turn.error.values()[i], 1e-6);
          }
        }
      }
    }
  }
}

TEST(ItemRows, ExtremesEncloseThoseOfEveryRow) {
  ASSERT_TRUE(run_upward([] { expect_extremes_to_enclose(); }));
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
