// SPDX-License-Identifier: GPL-3.0-or-later
// One ellipsoid around the items of a load: it contains every sum of explicit loads (tests/soundness/loads.h) in every
// orientation, and is about as small as the smallest ellipsoid around such sums.
#include "case/around_items.h"

#include <CGAL/Approximate_min_ellipsoid_d.h>
#include <CGAL/Approximate_min_ellipsoid_d_traits_d.h>
#include <CGAL/Cartesian_d.h>
#include <CGAL/MP_Float.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "kinematics/geometry.h"
#include "problem/load.h"
#include "problem/rational.h"
#include "tests/soundness/loads.h"

namespace taut::testing {
namespace {

using case_fields::ellipsoid_around_items;
using Engine = std::mt19937_64;
using Shape6 = Eigen::Matrix<double, 6, 6>;
using Six = std::array<double, 6>;

double uniform(Engine& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vector6<double> random_direction(Engine& random) {
  Vector6<double> u;
  for (int k = 0; k < 6; ++k) u(k) = std::normal_distribution<double>()(random);
  return u.normalized();
}

RationalVector random_vector(Engine& random) {
  RationalVector v;
  for (RationalText& x : v) x = fmt::format("{:.3f}", uniform(random, -2, 2));
  return v;
}

VectorSet random_set(Engine& random) {
  switch (random() % 3) {
    case 0: return BallOfVectors{"1/3"};
    case 1: return DiscOfVectors{"0.7", random_vector(random)};
    default: break;
  }
  const double lower = uniform(random, -1, 1);
  return SegmentOfVectors{random_vector(random), fmt::format("{:.6f}", lower), fmt::format("{:.6f}", lower + 0.5)};
}

LoadCases random_cases(Engine& random, Axes axes) {
  LoadCases cases;
  for (std::size_t j = 0; j < 1 + random() % 4; ++j) {
    auto& w = cases.wrenches.emplace_back();
    for (RationalText& x : w) x = fmt::format("{:.6f}", uniform(random, -1, 1));
  }
  cases.axes = axes;
  cases.at = random_vector(random);
  return cases;
}

/// Some of all kinds, in either axes, and a weight.
LoadText random_load(Engine& random) {
  LoadText load;
  load.point_m = random_vector(random);
  load.gravity_m_s2 = {"0.5", "-1", "-9.81"};
  load.items.push_back({"weight", Weight{"0.2", "1/4", random_vector(random), random() % 2 == 0 ? "0.125" : "0"}});
  if (random() % 2 == 0) load.items.push_back({"second", Weight{"1/7", "0.2", random_vector(random), "0.01"}});
  for (const Axes axes : {Axes::kWorld, Axes::kPlatform}) {
    const std::string name = axes == Axes::kWorld ? "world" : "platform";
    if (random() % 2 == 0) {
      load.items.push_back({name + " force", Force{random_set(random), axes, random_vector(random)}});
    }
    if (random() % 2 == 0) load.items.push_back({name + " moment", Moment{random_set(random), axes}});
    if (random() % 2 == 0) load.items.push_back({name + " cases", random_cases(random, axes)});
  }
  return load;
}

/// The 20 t crane, of cases/cranes/portal-20t.yaml.
LoadText crane_load() {
  LoadText load;
  load.point_m = {"0", "0", "0"};
  load.gravity_m_s2 = {"0", "0", "-9.81"};
  load.items = {{"platform", Weight{"8000", "8000", {"0", "0", "0"}, "0"}},
                {"payload", Weight{"11760", "12240", {"0", "0", "-1.2"}, "0.05"}},
                {"wind", Force{DiscOfVectors{"6000", {"0", "0", "1"}}, Axes::kWorld, {"0", "0", "-1"}}}};
  return load;
}

struct Ellipsoid {
  Vector6<double> centre;
  Shape6 e;

  explicit Ellipsoid(const LoadText& load) {
    for (int i = 0; i < 6; ++i) {
      centre(i) = from_rational<double>(load.wrench.at(i));
      for (int j = 0; j < 6; ++j) e(i, j) = from_rational<double>(load.ellipsoid->at(i).at(j));
    }
  }
  /// How far y w goes beyond y centre.
  [[nodiscard]] double reach(const Vector6<double>& y) const { return std::sqrt(y.dot(e.ldlt().solve(y))); }
  /// How many times as long its axes would have to be to contain w.
  [[nodiscard]] double scale(const Vector6<double>& w) const {
    const Vector6<double> from_centre = w - centre;
    return std::sqrt(from_centre.dot(e * from_centre));
  }
};

/// The items of a load about a point, in an orientation.
class Items {
 public:
  Items(const LoadText& load, const std::array<DecimalText, 3>& point, const Matrix3<double>& r)
      : gravity_(campaign::numbers<double>(load.gravity_m_s2)),
        point_(campaign::numbers<double>({point[0], point[1], point[2]})) {
    for (const LoadItem& item : load.items) loads_.push_back(campaign::make_load<double>(item));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) rows_[i][j] = r(static_cast<int>(i), static_cast<int>(j));
    }
  }
  /// The greatest y w, by explicit loads.
  [[nodiscard]] double highest(const Vector6<double>& y) const {
    Six row;
    for (int k = 0; k < 6; ++k) row.at(k) = y(k);
    double sum = 0;
    for (const auto& load : loads_) {
      sum += campaign::extremes(load, gravity_, rows_, point_, campaign::TensionOf<double>{row}).high;
    }
    return sum;
  }
  /// A wrench with that y w, nearly: the gradient of highest().
  [[nodiscard]] Vector6<double> extreme(const Vector6<double>& y) const {
    constexpr double kStep = 1e-6;
    Vector6<double> w;
    for (int k = 0; k < 6; ++k) {
      const Vector6<double> step = kStep * y.norm() * Vector6<double>::Unit(k);
      w(k) = (highest(y + step) - highest(y - step)) / (2 * kStep * y.norm());
    }
    return w;
  }

 private:
  campaign::Vec<double> gravity_, point_;
  campaign::Rows<double> rows_;
  std::vector<campaign::Load<double>> loads_;
};

Matrix3<double> random_rotation(Engine& random) {
  return rotation(uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3));
}

/// The most of the ellipsoid's reach that the items use in some direction and orientation, sought from all over.
double greatest_share(const LoadText& load, Engine& random, int tries) {
  const LoadText around = ellipsoid_around_items(load, 1.5);
  const Ellipsoid ellipsoid(around);
  const Shape6 root = Eigen::LLT<Shape6>(ellipsoid.e).matrixL();
  double greatest = 0;
  for (int n = 0; n < tries; ++n) {
    const Items items(load, around.point_m, random_rotation(random));
    Vector6<double> y = root * random_direction(random);
    for (int step = 0; step < 4; ++step) {
      const double used = items.highest(y) - y.dot(ellipsoid.centre);
      greatest = std::max(greatest, used / ellipsoid.reach(y));
      y = ellipsoid.e * (items.extreme(y) - ellipsoid.centre);  // the normal of the ellipsoid there
      if (!(y.norm() > 0)) break;
    }
  }
  return greatest;
}

constexpr double kRounding = 1e-9;

TEST(AroundItems, ContainsEverySumOfExplicitLoadsInEveryOrientation) {
  Engine random(1);
  for (int n = 0; n < 100; ++n) ASSERT_LE(greatest_share(random_load(random), random, 30), 1 + kRounding) << n;
  EXPECT_LE(greatest_share(crane_load(), random, 400), 1 + kRounding);
}

TEST(AroundItems, IsReachedByEachItemAlone) {
  Engine random(2);
  const RationalVector at = {"0.5", "-1", "2"};
  const std::vector<decltype(LoadItem::what)> items = {
      Weight{"2", "3", at, "0"},
      Weight{"3", "3", at, "0.25"},
      Force{BallOfVectors{"2"}, Axes::kWorld, at},
      Force{DiscOfVectors{"2", {"1", "2", "3"}}, Axes::kWorld, at},
      Force{SegmentOfVectors{{"1", "2", "3"}, "2", "5"}, Axes::kWorld, at},
      Force{SegmentOfVectors{{"1", "2", "3"}, "-2", "5"}, Axes::kPlatform, at},
      Moment{BallOfVectors{"2"}, Axes::kWorld},
      Moment{DiscOfVectors{"2", {"1", "2", "3"}}, Axes::kPlatform},
      Moment{SegmentOfVectors{{"1", "2", "3"}, "2", "5"}, Axes::kWorld},
      LoadCases{{{"1", "0", "0", "0", "0", "0"}, {"0", "0", "1", "3", "0", "0"}, {"0", "2", "0", "0", "1", "0"}},
                Axes::kWorld,
                {"0", "0", "0"}},
      LoadCases{{{"1", "0", "0", "0", "0", "0"}, {"0", "0", "1", "3", "0", "0"}}, Axes::kPlatform, at}};
  for (std::size_t k = 0; k < items.size(); ++k) {
    LoadText load;
    load.point_m = {"0", "0", "0"};
    load.gravity_m_s2 = {"0", "3", "-4"};
    load.items.push_back({"item", items[k]});
    const double share = greatest_share(load, random, 300);
    EXPECT_LE(share, 1 + kRounding) << k;
    EXPECT_GE(share, 0.8) << k;
  }
}

TEST(AroundItems, OfTheCraneIsNearlyTheSmallestInVolume) {
  // Whatever contains the items in these orientations contains these wrenches, and CGAL bounds the volume of that.
  using Kernel = CGAL::Cartesian_d<double>;
  using Traits = CGAL::Approximate_min_ellipsoid_d_traits_d<Kernel, CGAL::MP_Float>;
  const LoadText load = crane_load();
  const LoadText around = ellipsoid_around_items(load, 1.5);
  const Ellipsoid ellipsoid(around);
  const Shape6 root = Eigen::LLT<Shape6>(ellipsoid.e).matrixL();
  Engine random(3);
  std::vector<Kernel::Point_d> points;
  for (int n = 0; n < 4000; ++n) {
    const Items items(load, around.point_m, random_rotation(random));
    Vector6<double> y = root * random_direction(random);
    y = ellipsoid.e * (items.extreme(y) - ellipsoid.centre);
    const Vector6<double> x = root.transpose() * (items.extreme(y) - ellipsoid.centre);  // the ellipsoid is |x| <= 1
    points.emplace_back(6, x.data(), x.data() + 6);
  }
  constexpr double kTolerance = 0.01;
  const CGAL::Approximate_min_ellipsoid_d<Traits> smallest(kTolerance, points.begin(), points.end());
  ASSERT_TRUE(smallest.is_full_dimensional());
  // {x : x' M x + 2 m x + mu <= (1 + eps) 7}, CGAL's representation of what contains the points.
  Shape6 m;
  Vector6<double> half;
  for (int i = 0; i < 6; ++i) {
    half(i) = 0.5 * smallest.defining_vector(i);
    for (int j = 0; j < 6; ++j) m(i, j) = smallest.defining_matrix(i, j);
  }
  const double size =
      (1 + smallest.achieved_epsilon()) * 7 - smallest.defining_scalar() + half.dot(m.ldlt().solve(half));
  const double volume = std::sqrt(std::pow(size, 6) / m.determinant());  // of the unit ball's, which is ours
  EXPECT_LE(volume, 1.05);
  const double mean_axis = std::pow(volume, 1.0 / 6);
  EXPECT_GE(mean_axis, 0.97);
  RecordProperty("mean_axis_of_the_smallest", fmt::format("{:.4f}", mean_axis));
}

TEST(AroundItems, ContainsManyLoadCases) {
  Engine random(4);
  LoadText load = crane_load();
  LoadCases cases;
  for (int j = 0; j < 64; ++j) {
    auto& w = cases.wrenches.emplace_back();
    for (RationalText& x : w) x = fmt::format("{:.3f}", uniform(random, -5000, 5000));
  }
  cases.at = {"0", "0", "-1"};
  load.items.push_back({"cases", cases});
  const double share = greatest_share(load, random, 100);
  EXPECT_LE(share, 1 + kRounding);
  EXPECT_GE(share, 0.6);
}

TEST(AroundItems, AreRefusedIfTheirSizesAreTooFarApart) {
  LoadText load = crane_load();
  load.items.push_back({"speck", Force{BallOfVectors{"1e290"}, Axes::kWorld, {"0", "0", "0"}}});
  EXPECT_THROW(static_cast<void>(ellipsoid_around_items(load, 1.5)), FieldError);
}

double semi_axis(const LoadText& load, int k) { return 1 / std::sqrt(Ellipsoid(load).e(k, k)); }

TEST(AroundItems, ByHand) {
  // A ball of forces at the load point and one of moments: the smallest ellipsoid around both has √2 times the radii.
  LoadText load;
  load.point_m = {"0", "0", "0"};
  load.items = {{"force", Force{BallOfVectors{"6"}, Axes::kWorld, {"0", "0", "0"}}},
                {"moment", Moment{BallOfVectors{"3"}, Axes::kWorld}},
                {"pull", Force{SegmentOfVectors{{"0", "0", "-1"}, "100", "100"}, Axes::kWorld, {"0", "0", "0"}}}};
  const LoadText around = ellipsoid_around_items(load, 1);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(semi_axis(around, k), std::sqrt(2) * (k < 3 ? 6 : 3), 0.01);
  EXPECT_EQ(around.wrench[2], "-100");
  EXPECT_TRUE(around.items.empty());
  EXPECT_NO_THROW(validate(around));
}

TEST(AroundItems, IsAboutTheCentreOfGravitySoThatTiltingCostsNothing) {
  const LoadText around = ellipsoid_around_items(crane_load(), 1.5);
  EXPECT_EQ(around.point_m, (std::array<DecimalText, 3>{"0", "0", "-0.72"}));
  EXPECT_EQ(around.wrench, (std::array<DecimalText, 6>{"0", "0", "-196200", "0", "0", "0"}));
}

TEST(AroundItems, OfAnExactLoadIsThinButNoPoint) {
  LoadText load = crane_load();
  load.items = {{"payload", Weight{"10000", "10000", {"1", "2", "3"}, "0"}}};
  const LoadText around = ellipsoid_around_items(load, 1.5);
  EXPECT_EQ(around.point_m, (std::array<DecimalText, 3>{"1", "2", "3"}));
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(semi_axis(around, k), k < 3 ? 9.8 : 15, 0.01);
  EXPECT_NO_THROW(validate(around));
}

}  // namespace
}  // namespace taut::testing
