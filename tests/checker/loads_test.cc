// SPDX-License-Identifier: GPL-3.0-or-later
// Loads as items, held against the worst load of each, found by another route, and against loads at random.
#include "checker/kernel/loads.h"

#include <gtest/gtest.h>

#include "checker/kernel/box_proof.h"
#include "tests/checker/loads_oracle.h"

namespace taut::checker {
namespace {

BigFloat big(double x) { return BigFloat(x); }

MeanValueForm line(double at, double slope) { return {Ball(at), Ball(slope)}; }

TEST(Norm, HoldsAlsoWhereItVanishes) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 2000 && !HasFailure(); ++trial) {
    std::array<double, 3> at{}, slope{};
    const double size = std::exp(uniform(random, -20, 3));
    for (std::size_t c = 0; c < 3; ++c) {
      slope[c] = random() % 5 == 0 ? 0 : uniform(random, -1, 1);
      at[c] = trial % 3 == 0 ? 0 : trial % 3 == 1 ? size * slope[c] : size * uniform(random, -1, 1);
    }
    const Vector3<MeanValueForm> v = {line(at[0], slope[0]), line(at[1], slope[1]), line(at[2], slope[2])};
    const MeanValueForm length = norm(v);
    for (const double u : samples(random, 8)) {
      BigFloat square(0.0);
      for (std::size_t c = 0; c < 3; ++c) {
        const BigFloat x = big(at[c]) + big(slope[c]) * big(u);
        square = square + x * x;
      }
      EXPECT_TRUE(holds(length, u, campaign::root(square))) << trial << " at " << u;
    }
    EXPECT_LE(approx(magnitude(length.slope)), 2) << "no steeper than the vector";
  }
}

TEST(Norm, IsAsSteepAsTheVectorAlongItself) {
  const WorkingPrecision precision(64);
  const MeanValueForm length = norm({line(3, 0.003), line(4, 0.004), line(0, 0)});
  EXPECT_TRUE(holds(length.slope, big(0.005), 1e-4));
  EXPECT_LT(width(length.slope), 1e-4);
  EXPECT_LT(width(length.at), 1e-15);
}

TEST(Maximum, HoldsWhereOneOvertakesAnother) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 2000 && !HasFailure(); ++trial) {
    std::vector<std::array<double, 2>> lines;
    std::vector<MeanValueForm> forms;
    const std::size_t count = 1 + random() % 5;
    for (std::size_t k = 0; k < count; ++k) {
      lines.push_back({uniform(random, -1, 1), uniform(random, -1, 1) * std::exp(uniform(random, -5, 2))});
      if (k > 0 && random() % 4 == 0) lines[k] = lines[0];
      if (k > 0 && random() % 4 == 0) lines[k][0] = lines[0][0];
      forms.push_back(line(lines[k][0], lines[k][1]));
    }
    const MeanValueForm largest = maximum(forms);
    for (const double u : samples(random, 8)) {
      BigFloat most = big(lines[0][0]) + big(lines[0][1]) * big(u);
      for (const auto& [at, slope] : lines) {
        const BigFloat value = big(at) + big(slope) * big(u);
        if (value > most) most = value;
      }
      EXPECT_TRUE(holds(largest, u, most)) << trial << " at " << u;
    }
  }
}

TEST(Maximum, LeavesOutWhatIsNeverTheLargest) {
  const WorkingPrecision precision(64);
  const MeanValueForm largest = maximum(std::array{line(0, 5), line(10, 1), line(3, -5)});
  EXPECT_TRUE(is_within(largest.at, Ball(10)));
  EXPECT_TRUE(is_within(largest.slope, Ball(1)));
  const MeanValueForm size = absolute(line(-2, 1));
  EXPECT_TRUE(is_within(size.at, Ball(2)));
  EXPECT_TRUE(is_within(size.slope, Ball(-1)));
}

/// A row of D^-1 along u, exactly: at + slope u.
struct Row {
  std::array<double, 6> at{}, slope{};
  [[nodiscard]] Vector6<MeanValueForm> forms() const {
    Vector6<MeanValueForm> y;
    for (std::size_t k = 0; k < 6; ++k) y[k] = line(at[k], slope[k]);
    return y;
  }
  [[nodiscard]] Six<BigFloat> exact(double u) const {
    Six<BigFloat> y;
    for (std::size_t k = 0; k < 6; ++k) y[k] = big(at[k]) + big(slope[k]) * big(u);
    return y;
  }
};

/// Rows for which g, m, A or A + B may vanish within the box, at its middle or everywhere.
Row hostile_row(std::mt19937_64& random, const LoadItem& item) {
  Row row;
  for (std::size_t k = 0; k < 6; ++k) {
    row.at[k] = uniform(random, -1, 1);
    row.slope[k] = uniform(random, -1, 1) * std::exp(uniform(random, -20, 1));
  }
  const auto is = [&](unsigned n) { return random() % n == 0; };
  if (is(3)) std::fill(row.at.begin() + 3, row.at.end(), 0.0);  // m vanishes
  if (is(3)) std::fill(row.slope.begin() + 3, row.slope.end(), 0.0);
  if (is(3)) {  // g nearly vanishes in the middle
    const double size = is(2) ? 0 : 1e-9;
    const auto at = vector_of<double>(item.at);
    const Vec<double> m = {row.at[3], row.at[4], row.at[5]};
    const Vec<double> swing = cross(m, at);
    for (std::size_t c = 0; c < 3; ++c) row.at[c] = -swing[c] + size * uniform(random, -1, 1);
  }
  if (is(6)) row.at = {};
  if (is(12)) row.slope = {};
  return row;
}

TEST(Load, AboveAndBelowHoldTheWorstLoad) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  std::mt19937_64 random(3);
  Matrix3<MeanValueForm> identity;
  for (std::size_t c = 0; c < 3; ++c) identity[c][c] = MeanValueForm(Ball(1));
  for (int trial = 0; trial < 3000 && !HasFailure(); ++trial) {
    const LoadItem item = random_item(random, std::exp(uniform(random, -3, 10)));
    const ExactVector gravity = random() % 8 == 0 ? ExactVector() : random_vector(random, 10);
    const Load load(item, {}, gravity);
    Platform<BigFloat> on;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) on.R[i][j] = big(i == j ? 1 : 0);
      on.load_point[i] = big(0);
    }
    on.gravity = vector_of<BigFloat>(gravity);
    const Row row = hostile_row(random, item);
    const Lever<MeanValueForm> y = load.lever(identity, row.forms());
    const MeanValueForm above = load.above(y);
    const MeanValueForm below = load.above(-y);
    const Vector6<MeanValueForm> nominal = load.nominal_about_load_point(identity);
    const Load::Extremes extremes = load.extremes({range(y.g), range(y.m)});
    ASSERT_FALSE(extremes.least.empty() || extremes.most.empty());
    for (const double u : samples(random, 6)) {
      const Six<BigFloat> exact = row.exact(u);
      const Extremes<BigFloat> x = extremes_of(item, exact, on);
      EXPECT_TRUE(holds(above, u, x.most - x.nominal, 1e-30)) << trial << " at " << u;
      EXPECT_TRUE(holds(below, u, x.nominal - x.least, 1e-30)) << trial << " at " << u;
      MeanValueForm value;
      for (std::size_t k = 0; k < 6; ++k) value += nominal[k] * row.forms()[k];
      EXPECT_TRUE(holds(value, u, x.nominal, 1e-30)) << trial << " at " << u;
      for (int k = 0; k < 5; ++k) {
        const BigFloat any = dot_six(exact, wrench_of(item, random_load<BigFloat>(item, random), on));
        EXPECT_TRUE(any <= x.most + big(1e-40) && any >= x.least - big(1e-40)) << "the test's own worst load is not";
      }
      // One of the wrenches, as far as they are known, has the least value, and one the largest.
      Vector6<Ball> now;
      for (std::size_t c = 0; c < 6; ++c) now[c] = row.forms()[c].at + row.forms()[c].slope * Ball(u);
      const auto attained = [&](const std::vector<Wrench>& wrenches) {
        std::optional<Ball> result;
        for (const Wrench& w : wrenches) {
          const Ball one = of(load.lever(range(identity), now), w);
          result = result ? hull(*result, one) : one;
        }
        return *result;
      };
      EXPECT_TRUE(holds(attained(extremes.least), x.least, 1e-30)) << trial << " at " << u;
      EXPECT_TRUE(holds(attained(extremes.most), x.most, 1e-30)) << trial << " at " << u;
    }
  }
}

Path stays_or_moves(std::mt19937_64& random, std::vector<double>& from, std::vector<double>& to, double step) {
  from = {uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), uniform(random, 0.2, 0.4),
          uniform(random, -3, 3),     uniform(random, -0.9, 0.9), uniform(random, -0.8, 0.8)};
  to = from;
  for (double& x : to) x += step * uniform(random, -1, 1);
  Path path;
  path.waypoints = {waypoint(from), waypoint(to)};
  return path;
}

/// Tensions of a robot with items along a box, and how much wider than they are the enclosures of their extremes may be
/// at its middle.
void expect_tensions(std::mt19937_64& random, int trial, int& shown) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(128);
  const taut::Problem stated =
      testing::free_flying(trial % 2 == 0 ? testing::robot1_slice() : testing::robot2_sphere());
  Problem problem = to_kernel(stated);
  give_items(problem, random, 1, trial % 3 == 0);
  const auto exact = campaign::make_machine<BigFloat>(stated);
  const Machine machine(problem);
  std::vector<double> from, to;
  const double step = trial % 4 == 0 ? 0 : std::exp(uniform(random, -12, -2));
  const Path path = stays_or_moves(random, from, to, step);
  const Box box = dyadic_box(0, 1, 0);
  Tensions tensions;
  Geometry geometry;
  try {
    geometry = commanded_geometry(machine, problem, path, 0, box);
    tensions = machine.tensions(geometry, Inverse(geometry.D));
  } catch (const Undefined&) {
    return;
  }
  ++shown;
  for (const double u : samples(random, 5)) {
    const BigFloat s = place(box, u);
    std::array<BigFloat, 6> x;
    for (std::size_t j = 0; j < 6; ++j) x[j] = big(from[j]) + (big(to[j]) - big(from[j])) * s;
    const auto truth = tensions_of(problem, exact, {{x[0], x[1], x[2]}, campaign::orientation(x[3], x[4], x[5])});
    for (std::size_t i = 0; i < 6; ++i) {
      const MeanValueForm& length = geometry.length[i];
      const auto expect = [&](const MeanValueForm& density, const BigFloat& value) {
        EXPECT_TRUE(holds(length * density, u, value, 1e-30)) << "trial " << trial << ", cable " << i << " at " << u;
        const double size = 1 + std::abs(value.to_double());
        if (step == 0) {
          EXPECT_LT(width((length * density).range()), 1e-25 * size) << trial;
        }
      };
      expect(tensions.density[i], truth[i].nominal);
      expect(tensions.extreme(i, 0), truth[i].least);
      expect(tensions.extreme(i, 1), truth[i].most);
    }
  }
}

TEST(Tensions, HoldTheWorstLoadOfEachItemAlongABox) {
  std::mt19937_64 random(4);
  int shown = 0;
  for (int trial = 0; trial < 160 && !HasFailure(); ++trial) expect_tensions(random, trial, shown);
  EXPECT_GT(shown, 60);
}

TEST(Tensions, OfASingleWrenchAreThoseOfItsVector) {
  const WorkingPrecision precision(128);
  const Problem stated = to_kernel(testing::free_flying(testing::robot1_slice()));
  Problem cases = stated;
  cases.ellipsoid.reset();
  cases.wrench = ExactWrench();
  cases.items = {{LoadCases{{stated.wrench}}, Axes::kWorld, stated.load_point}};
  Path path;
  path.waypoints = {waypoint({0.01, 0.02, 0.35, 0.3, 0.5, 0.6}), waypoint({0.01, 0.02, 0.35, 0.3, 0.5, 0.6})};
  const Machine one(cases);
  const Machine other(stated);
  const Geometry geometry = commanded_geometry(one, cases, path, 0, dyadic_box(0, 1, 0));
  const Inverse inverse(geometry.D);
  for (std::size_t i = 0; i < 6; ++i) {
    const Ball difference =
        (one.tensions(geometry, inverse).density[i] - other.tensions(geometry, inverse).density[i]).at;
    EXPECT_LT(approx(magnitude(difference)), 1e-25);
    for (const auto& radius : one.tensions(geometry, inverse).radius) EXPECT_TRUE(radius[i].range().is_zero());
  }
}

/// With limits so wide that no margin is negative.
Problem with_wide_limits(const taut::Problem& stated) {
  Problem problem = to_kernel(stated);
  for (Limits& limits : problem.tension) limits = {-1000, 1000};
  return problem;
}

TEST(BoxProof, MarginAndScaleHoldForEveryLoadOfTheItems) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(64);
  std::mt19937_64 random(6);
  const taut::Problem stated = testing::free_flying(testing::robot1_slice());
  const auto exact = campaign::make_machine<BigFloat>(stated);
  int shown = 0;
  for (int trial = 0; trial < 60 && !HasFailure(); ++trial) {
    Problem problem = with_wide_limits(stated);
    give_items(problem, random, 1, trial % 3 == 0);
    std::vector<double> from, to;
    const Path path = stays_or_moves(random, from, to, std::exp(uniform(random, -12, -4)));
    Bounds bounds;
    try {
      bounds = prove_box(Machine(problem), problem, path, 0, dyadic_box(0, 1, 0));
    } catch (const Undefined&) {
      continue;
    }
    ++shown;
    const double u = uniform(random, -1, 1);
    std::array<BigFloat, 6> x;
    for (std::size_t j = 0; j < 6; ++j) x[j] = big(from[j]) + (big(to[j]) - big(from[j])) * (big(1) + big(u)) / big(2);
    for (const auto& t : tensions_of(problem, exact, {{x[0], x[1], x[2]}, campaign::orientation(x[3], x[4], x[5])})) {
      const BigFloat limit(1000.0);
      EXPECT_TRUE(t.least + limit >= lower_end(bounds.tension) && limit - t.most >= lower_end(bounds.tension));
      const BigFloat scale = lower_end(bounds.wrench_scale);
      EXPECT_TRUE(t.nominal + limit >= scale * (t.nominal - t.least)) << trial;
      EXPECT_TRUE(limit - t.nominal >= scale * (t.most - t.nominal)) << trial;
    }
  }
  EXPECT_GT(shown, 30);
}

TEST(BoxProof, AnExactLoadMayGrowByAsMuchAsIsEverStated) {
  const WorkingPrecision precision(64);
  Problem problem = with_wide_limits(testing::free_flying(testing::robot1_slice()));
  problem.ellipsoid.reset();
  problem.wrench = ExactWrench();
  problem.gravity = {0, 0, -10};
  problem.items = {{Weight{{mpq_class(1, 10), mpq_class(1, 10)}, 0}, Axes::kWorld, {}},
                   {LineSegment{false, {1, 2, 3}, {mpq_class(1, 7), mpq_class(1, 7)}}, Axes::kPlatform, {}},
                   {BallOrDisc{true, 0, ExactVector{1, 2, 3}}, Axes::kPlatform, {}}};
  Path path;
  path.waypoints = {waypoint({0.01, 0.02, 0.35, 0.3, 0.5, 0.6}), waypoint({0.011, 0.02, 0.35, 0.3, 0.5, 0.6})};
  const Bounds bounds = prove_box(Machine(problem), problem, path, 0, dyadic_box(0, 1, 0));
  EXPECT_EQ(approx(bounds.wrench_scale), 1e6);
  problem.items.push_back({BallOrDisc{false, mpq_class(1, 10), {}}, Axes::kWorld, {}});
  EXPECT_LT(approx(prove_box(Machine(problem), problem, path, 0, dyadic_box(0, 1, 0)).wrench_scale), 1e6);
}

// ---- Loads of a witness ---------------------------------------------------------------------------------------------

Problem with_one(const LoadItem& item) {
  Problem problem;
  problem.gravity = {0, 0, -10};
  problem.items = {item};
  return problem;
}
bool is_in(const LoadItem& item, const LoadChoice& choice) {
  try {
    (void)acting(with_one(item), {choice});
    return true;
  } catch (const Rejected&) {
    return false;
  }
}
const mpq_class kTiny = mpq_class(1, mpz_class(1) << 400);

TEST(Acting, AcceptsTheEdgesOfAnItemAndNothingBeyond) {
  const LoadItem weight = {Weight{{2, 3}, mpq_class(5, 10)}, Axes::kWorld, {}};
  EXPECT_TRUE(is_in(weight, WeightChoice{2, {mpq_class(3, 10), 0, mpq_class(-4, 10)}}));
  EXPECT_TRUE(is_in(weight, WeightChoice{3, {}}));
  EXPECT_FALSE(is_in(weight, WeightChoice{2 - kTiny, {}}));
  EXPECT_FALSE(is_in(weight, WeightChoice{3 + kTiny, {}}));
  EXPECT_FALSE(is_in(weight, WeightChoice{2, {mpq_class(3, 10), kTiny, mpq_class(-4, 10)}}));
  for (const bool is_moment : {false, true}) {
    const auto item = [](const LoadSet& set) { return LoadItem{set, Axes::kPlatform, {}}; };
    const LoadItem ball = item(BallOrDisc{is_moment, 5, {}});
    EXPECT_TRUE(is_in(ball, VectorChoice{{3, 0, 4}}));
    EXPECT_FALSE(is_in(ball, VectorChoice{{3, kTiny, 4}}));
    EXPECT_TRUE(is_in(item(BallOrDisc{is_moment, 0, {}}), VectorChoice{}));
    EXPECT_FALSE(is_in(item(BallOrDisc{is_moment, 0, {}}), VectorChoice{{kTiny, 0, 0}}));
    const LoadItem disc = item(BallOrDisc{is_moment, 5, ExactVector{0, 7, 0}});
    EXPECT_TRUE(is_in(disc, VectorChoice{{3, 0, -4}}));
    EXPECT_FALSE(is_in(disc, VectorChoice{{3, kTiny, 0}})) << "out of the plane";
    EXPECT_FALSE(is_in(disc, VectorChoice{{3 + kTiny, 0, 4}}));
    const LoadItem segment = item(LineSegment{is_moment, {1, 1, 0}, {-1, 2}});
    EXPECT_TRUE(is_in(segment, AmountChoice{-1}));
    EXPECT_TRUE(is_in(segment, AmountChoice{2}));
    EXPECT_FALSE(is_in(segment, AmountChoice{2 + kTiny}));
    EXPECT_FALSE(is_in(segment, AmountChoice{-1 - kTiny}));
  }
  const LoadItem cases = {LoadCases{{{}, {1, 2, 3, 4, 5, 6}}}, Axes::kWorld, {}};
  EXPECT_TRUE(is_in(cases, CaseChoice{1}));
  EXPECT_FALSE(is_in(cases, CaseChoice{2}));
}

TEST(Acting, IsTheWrenchOfTheseLoads) {
  const PrecisionScope oracle(kOracleBits);
  const WorkingPrecision precision(128);
  std::mt19937_64 random(5);
  const taut::Problem stated = testing::free_flying(testing::robot1_slice());
  const auto exact = campaign::make_machine<BigFloat>(stated);
  for (int trial = 0; trial < 60 && !HasFailure(); ++trial) {
    Problem problem = to_kernel(stated);
    give_items(problem, random, 1, trial % 2 == 0);
    std::vector<LoadChoice> choices;
    std::vector<OneLoad<BigFloat>> loads;
    for (const LoadItem& item : problem.items) {
      OneLoad<BigFloat>& load = loads.emplace_back();
      const auto some_vector = [&](const mpq_class& radius, const ExactVector* normal) {
        ExactVector v = random_vector(random, 1);
        if (normal != nullptr) {
          const ExactVector& n = *normal;
          v = {v[1] * n[2] - v[2] * n[1], v[2] * n[0] - v[0] * n[2], v[0] * n[1] - v[1] * n[0]};
        }
        const mpq_class size = abs(v[0]) + abs(v[1]) + abs(v[2]);
        for (mpq_class& c : v) c = size == 0 ? mpq_class(0) : mpq_class(c * radius / size);
        load.vector = vector_of<BigFloat>(v);
        return v;
      };
      if (const auto* weight = std::get_if<Weight>(&item.set)) {
        const mpq_class mass = (2 * weight->mass.lower + weight->mass.upper) / 3;
        load.amount = number<BigFloat>(mass);
        choices.emplace_back(WeightChoice{mass, some_vector(weight->offset, nullptr)});
      } else if (const auto* cases = std::get_if<LoadCases>(&item.set)) {
        const std::size_t j = random() % cases->wrenches.size();
        load.shares.assign(cases->wrenches.size(), BigFloat(0.0));
        load.shares[j] = BigFloat(1.0);
        choices.emplace_back(CaseChoice{j});
      } else if (const auto* segment = std::get_if<LineSegment>(&item.set)) {
        load.amount = number<BigFloat>(segment->range.upper);
        choices.emplace_back(AmountChoice{segment->range.upper});
      } else {
        const auto& round = std::get<BallOrDisc>(item.set);
        choices.emplace_back(VectorChoice{some_vector(round.radius, normal_of(round))});
      }
    }
    const Machine machine(acting(problem, choices));
    std::vector<double> from, to;
    const Path path = stays_or_moves(random, from, to, 0);
    const Geometry geometry = commanded_geometry(machine, problem, path, 0, dyadic_box(0, 1, 0));
    const Tensions tensions = machine.tensions(geometry, Inverse(geometry.D));
    const campaign::RigidPose<BigFloat> pose{{big(from[0]), big(from[1]), big(from[2])},
                                             campaign::orientation(big(from[3]), big(from[4]), big(from[5]))};
    const Platform<BigFloat> on = {pose.r, exact.load_point, vector_of<BigFloat>(problem.gravity)};
    const auto y = responses(exact, pose);
    const auto of_ellipsoid = campaign::statics(exact, pose);
    for (std::size_t i = 0; i < 6; ++i) {
      BigFloat least = problem.ellipsoid ? of_ellipsoid.tension_low[i] : BigFloat(0.0);
      BigFloat most = problem.ellipsoid ? of_ellipsoid.tension_high[i] : BigFloat(0.0);
      for (std::size_t k = 0; k < loads.size(); ++k) {
        const BigFloat of_load = dot_six(y[i], wrench_of(problem.items[k], loads[k], on));
        least = least + of_load;
        most = most + of_load;
      }
      EXPECT_TRUE(holds((geometry.length[i] * tensions.extreme(i, 0)).range(), least, 1e-30)) << trial;
      EXPECT_TRUE(holds((geometry.length[i] * tensions.extreme(i, 1)).range(), most, 1e-30)) << trial;
    }
  }
}

}  // namespace
}  // namespace taut::checker
