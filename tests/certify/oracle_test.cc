// SPDX-License-Identifier: GPL-3.0-or-later
// Statics of single poses against two oracles: 600 poses printed to 50 digits, and J about the origin in 200 bits.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "certify/box_proof.h"
#include "kinematics/statics.h"
#include "tests/oracle/oracle_at_origin.h"
#include "tests/support/enclosing.h"
#include "tests/support/segments.h"

namespace taut::testing {
namespace {

using oracle::Big6;
using oracle::Big66;

struct PrintedPose {
  std::string robot;
  std::vector<double> pose;
  std::array<std::string, 6> length, tension, tension_radius;
  std::string determinant;
  bool feasible;
};

const std::vector<PrintedPose>& printed_poses() {
  static const std::vector<PrintedPose> poses = [] {
    std::vector<PrintedPose> result;
    std::ifstream file(TAUT_SOURCE_DIR "/tests/oracle/poses.jsonl");
    for (std::string line; std::getline(file, line);) {
      const nlohmann::json json = nlohmann::json::parse(line);
      result.push_back(
          {json["robot"], json["pose"], json["length_m"], json["f0_N"], json["v_N"], json["det_J"], json["feasible"]});
    }
    return result;
  }();
  return poses;
}

/// An enclosure holds a number that was printed to 50 digits.
template <class I>
::testing::AssertionResult holds_printed(const I& enclosure, const std::string& text) {
  const PrecisionScope precision(kExactBits);
  const BigFloat value = oracle::big(text);
  if (holds(enclosure, value, abs(value) * BigFloat(1e-49))) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << text << " is not in " << print(enclosure);
}

template <class I>
double relative_width(const I& x) {
  return (upper_end(x) - lower_end(x)).to_double() / std::max(std::abs(lower_bound(x)), std::abs(upper_bound(x)));
}

template <class I>
Pose<I> exact_pose(const std::vector<double>& q) {
  return {Vector3<I>(I(q[0]), I(q[1]), I(q[2])), {I(q[3]), I(q[4]), I(q[5])}};
}

class PrintedOracle : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(printed_poses().size(), 600u); }
  const Problem robot1_ = free_flying(robot1_slice());
  const Problem robot2_ = free_flying(robot2_sphere());
};

TEST_F(PrintedOracle, StaticsEncloseEveryPose) {
  const Model<MpInterval> model1 = make_model<MpInterval>(robot1_);
  const Model<MpInterval> model2 = make_model<MpInterval>(robot2_);
  double widest = 0;
  for (const PrintedPose& p : printed_poses()) {
    Faults<MpInterval>::clear();
    const Statics<MpInterval> s = statics(p.robot == "robot1" ? model1 : model2, exact_pose<MpInterval>(p.pose));
    ASSERT_TRUE(s.regular);
    ASSERT_FALSE(Faults<MpInterval>::raised());
    ASSERT_TRUE(holds_printed(s.determinant, p.determinant));
    widest = std::max(widest, relative_width(s.determinant));
    for (std::size_t i = 0; i < 6; ++i) {
      ASSERT_TRUE(holds_printed(s.length[i], p.length[i]));
      ASSERT_TRUE(holds_printed(s.tension[i], p.tension[i]));
      ASSERT_TRUE(holds_printed(s.tension_above[i], p.tension_radius[i]));
      widest = std::max(
          {widest, relative_width(s.length[i]), relative_width(s.tension[i]), relative_width(s.tension_above[i])});
    }
  }
  RecordProperty("widest_relative", std::to_string(std::log10(widest)));
  EXPECT_LT(widest, 1e-25);
}

TEST_F(PrintedOracle, FloatingPointAgreesToItsConditioning) {
  const Model<double> model1 = make_model<double>(robot1_);
  const Model<double> model2 = make_model<double>(robot2_);
  for (const PrintedPose& p : printed_poses()) {
    const Statics<double> s = statics(p.robot == "robot1" ? model1 : model2, exact_pose<double>(p.pose));
    ASSERT_TRUE(s.regular);
    const double determinant = std::stod(p.determinant);
    const double tolerance = 1e-13 / std::min(1.0, std::abs(determinant) * 1e3);
    ASSERT_NEAR(s.determinant, determinant, 1e-14);
    for (std::size_t i = 0; i < 6; ++i) {
      ASSERT_NEAR(s.length[i], std::stod(p.length[i]), 1e-15);
      const double scale = 1 + std::abs(std::stod(p.tension[i])) + std::stod(p.tension_radius[i]);
      ASSERT_NEAR(s.tension[i], std::stod(p.tension[i]), scale * tolerance * 100);
      ASSERT_NEAR(s.tension_above[i], std::stod(p.tension_radius[i]), scale * tolerance * 100);
    }
  }
}

/// The degenerate segment a → a.
template <class A, class Model>
void expect_boxes_enclose(const Model& model1, const Model& model2, double typical, double* widest) {
  using I = typename A::I;
  std::vector<double> widths;
  for (const PrintedPose& p : printed_poses()) {
    const Waypoint at{p.pose, std::vector<int>(6, 0)};
    BoxEnclosure<I> box;
    std::array<I, 6> tension, tension_radius;
    const bool sound = A::run([&] {
      box = enclose_box(p.robot == "robot1" ? model1 : model2, Segment::straight(at, at), {0, 0});
      if (!box.regular) return;
      for (std::size_t i = 0; i < 6; ++i) {
        tension[i] = box.length[i].range * box.density[i].range;
        tension_radius[i] = box.length[i].range * box.above[i].range;
      }
    });
    ASSERT_TRUE(sound && box.regular);
    double w = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      ASSERT_TRUE(holds_printed(box.length[i].range, p.length[i]));
      ASSERT_TRUE(holds_printed(tension[i], p.tension[i]));
      ASSERT_TRUE(holds_printed(tension_radius[i], p.tension_radius[i]));
      w = std::max({w, relative_width(box.length[i].range), relative_width(tension_radius[i])});
      w = std::max(w, spread(tension[i]) / (spread(tension[i]) + 1 + std::abs(lower_bound(tension[i]))));
    }
    widths.push_back(w);
  }
  std::sort(widths.begin(), widths.end());
  *widest = widths.back();
  EXPECT_LT(widths[widths.size() * 9 / 10], typical);
}

TEST_F(PrintedOracle, IntervalBoxesEncloseEveryPose) {
  double widest = 0;
  expect_boxes_enclose<Fast>(make_proof_model(robot1_), make_proof_model(robot2_), 1e-9, &widest);
  RecordProperty("widest_relative", std::to_string(std::log10(widest)));
}

TEST_F(PrintedOracle, MultiprecisionBoxesEncloseEveryPose) {
  double widest = 0;
  expect_boxes_enclose<Mp128>(make_mp_proof_model(robot1_), make_mp_proof_model(robot2_), 1e-30, &widest);
  RecordProperty("widest_relative", std::to_string(std::log10(widest)));
}

TEST_F(PrintedOracle, VerdictsAgreeOnFeasibility) {
  const ProofModel<Interval> model1 = make_proof_model(robot1_);
  const ProofModel<Interval> model2 = make_proof_model(robot2_);
  int feasible = 0;
  for (const PrintedPose& p : printed_poses()) {
    const Waypoint at{p.pose, std::vector<int>(6, 0)};
    const BoxVerdict verdict = judge_box(p.robot == "robot1" ? model1 : model2, Segment::straight(at, at), {0, 0});
    ASSERT_EQ(verdict.kind, p.feasible ? BoxVerdict::Kind::kProved : BoxVerdict::Kind::kRefuted);
    feasible += p.feasible ? 1 : 0;
  }
  EXPECT_GT(feasible, 20);
}

TEST_F(PrintedOracle, DeterminantsHaveTheirSign) {
  const ProofModel<MpInterval> model1 = make_mp_proof_model(robot1_);
  const ProofModel<MpInterval> model2 = make_mp_proof_model(robot2_);
  for (const PrintedPose& p : printed_poses()) {
    const Waypoint at{p.pose, std::vector<int>(6, 0)};
    const int sign = determinant_sign(p.robot == "robot1" ? model1 : model2, Segment::straight(at, at), {1, 1});
    ASSERT_EQ(sign, p.determinant[0] == '-' ? -1 : 1);
  }
}

// The two oracles share no code.
TEST_F(PrintedOracle, AgreesWithTheOracleAtTheOrigin) {
  const PrecisionScope precision(oracle::kBits);
  const auto expect_near = [](const BigFloat& x, const std::string& text) {
    const BigFloat printed = oracle::big(text);
    ASSERT_TRUE(abs(x - printed) <= abs(printed) * BigFloat(1e-48)) << text;
  };
  for (const PrintedPose& p : printed_poses()) {
    Big6 pose;
    for (std::size_t j = 0; j < 6; ++j) pose[j] = BigFloat(p.pose[j]);
    const oracle::OracleStatics s = oracle::statics(p.robot == "robot1" ? robot1_ : robot2_, pose);
    expect_near(s.determinant, p.determinant);
    for (std::size_t i = 0; i < 6; ++i) {
      expect_near(s.length[i], p.length[i]);
      expect_near(s.tension[i], p.tension[i]);
      expect_near(s.tension_radius[i], p.tension_radius[i]);
    }
  }
}

// ---- Random robots and full ellipsoids ------------------------------------------------------------------------------

DecimalText random_decimal(Operands& operands, double lower, double upper, int digits = 4) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, operands.uniform(lower, upper));
  return text;
}

/// Anchors about two circles, any load, E = M M^T with M lower triangular of integers.
Problem random_robot(Operands& operands) {
  Problem problem = free_flying(robot1_slice());
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      problem.robot.base_anchors_m[i][k] = random_decimal(operands, -0.3, 0.3);
      problem.robot.platform_anchors_m[i][k] = random_decimal(operands, -0.15, 0.15);
    }
  }
  for (auto& x : problem.load.point_m) x = random_decimal(operands, -0.05, 0.05);
  for (auto& x : problem.load.wrench) x = random_decimal(operands, -1, 1, 3);
  std::array<std::array<int, 6>, 6> m{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) m[i][j] = operands.pick(401) - 200;
    m[i][i] = 20 + operands.pick(300);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      int sum = 0;
      for (std::size_t k = 0; k < 6; ++k) sum += m[i][k] * m[j][k];
      problem.load.ellipsoid.value()[i][j] = std::to_string(sum);
    }
  }
  return problem;
}

std::vector<double> random_pose(Operands& operands) {
  return {operands.uniform(-0.1, 0.1), operands.uniform(-0.1, 0.1), operands.uniform(0.15, 0.4),
          operands.uniform(-3, 3),     operands.uniform(-0.1, 1.5), operands.uniform(-0.8, 0.8)};
}

Big6 big_pose(const std::vector<double>& q) {
  return {BigFloat(q[0]), BigFloat(q[1]), BigFloat(q[2]), BigFloat(q[3]), BigFloat(q[4]), BigFloat(q[5])};
}

TEST(OracleAtTheOrigin, IsEnclosedForRandomRobotsWithFullEllipsoids) {
  Operands operands(1);
  for (int n = 0; n < 100; ++n) {
    const Problem problem = random_robot(operands);
    const Model<MpInterval> model = make_model<MpInterval>(problem);
    const ProofModel<Interval> fast = make_proof_model(problem);
    ASSERT_FALSE(model.ellipsoid_is_diagonal);
    for (int k = 0; k < 5; ++k) {
      const std::vector<double> q = random_pose(operands);
      Faults<MpInterval>::clear();
      const Statics<MpInterval> s = statics(model, exact_pose<MpInterval>(q));
      ASSERT_TRUE(s.regular);
      ASSERT_FALSE(Faults<MpInterval>::raised());
      const Waypoint at{q, std::vector<int>(6, 0)};
      BoxEnclosure<Interval> box;
      const bool sound = run_upward([&] { box = enclose_box(fast, Segment::straight(at, at), {0, 0}); });
      const PrecisionScope precision(oracle::kBits);
      const oracle::OracleStatics exact = oracle::statics(problem, big_pose(q));
      ASSERT_TRUE(holds(s.determinant, exact.determinant));
      for (std::size_t i = 0; i < 6; ++i) {
        ASSERT_TRUE(holds(s.length[i], exact.length[i]));
        ASSERT_TRUE(holds(s.tension[i], exact.tension[i]));
        ASSERT_TRUE(holds(s.tension_above[i], exact.tension_radius[i]));
        ASSERT_LT(relative_width(s.tension_above[i]), 1e-22);
        if (!sound || !box.regular) continue;
        ASSERT_TRUE(holds(box.length[i].range, exact.length[i]));
        ASSERT_TRUE(holds(box.density[i].range, exact.tension[i] / exact.length[i]));
        ASSERT_TRUE(holds(box.above[i].range, exact.tension_radius[i] / exact.length[i]));
      }
    }
  }
}

/// M lower triangular with E = M M^T.
Big66 cholesky(const Problem& problem) {
  Big66 m;
  for (std::size_t j = 0; j < 6; ++j) {
    for (std::size_t i = j; i < 6; ++i) {
      BigFloat sum = oracle::big(problem.load.ellipsoid.value()[i][j]);
      for (std::size_t k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
      m[i][j] = i == j ? oracle::root(sum) : sum / m[j][j];
    }
  }
  return m;
}

/// z with M^T z' = z, so that z' lies on the surface of K − w0 for |z| = 1.
Big6 onto_surface(const Big66& m, Big6 z) {
  for (std::size_t i = 6; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k) z[i] -= m[k][i] * z[k];
    z[i] /= m[i][i];
  }
  return z;
}

// The definition itself: every wrench of K is balanced within f0 ± v, and some wrench of it at either end.
TEST(OracleAtTheOrigin, WrenchesOfKAreBalancedWithinTheEnclosuresWhichAreAttained) {
  Operands operands(2);
  for (int n = 0; n < 30; ++n) {
    const Problem problem = n == 0   ? free_flying(robot1_slice())
                            : n == 1 ? free_flying(robot2_sphere())
                                     : random_robot(operands);
    const Model<MpInterval> model = make_model<MpInterval>(problem);
    const std::vector<double> q = random_pose(operands);
    const Statics<MpInterval> s = statics(model, exact_pose<MpInterval>(q));
    std::array<MpInterval, 6> low, high;
    for (std::size_t i = 0; i < 6; ++i) {
      low[i] = s.tension[i] - s.tension_above[i];
      high[i] = s.tension[i] + s.tension_above[i];
    }
    const PrecisionScope precision(oracle::kBits);
    const oracle::OracleStatics at = oracle::statics(problem, big_pose(q));
    const Big66 m = cholesky(problem);
    // Tensions that balance w0 + the wrench `change` about P_m, solved about O.
    const auto balance = [&](const Big6& change) {
      std::vector<Big6> f(1);
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
          f[0][i] += at.transform[i][k] * (oracle::big(problem.load.wrench[k]) + change[k]);
        }
      }
      oracle::solve(at.jacobian, f);
      return f[0];
    };
    for (int k = 0; k < 20; ++k) {
      Big6 z;
      BigFloat norm;
      for (auto& x : z) {
        x = BigFloat(operands.uniform(-1, 1));
        norm += x * x;
      }
      for (auto& x : z) x /= oracle::root(norm);
      const Big6 f = balance(onto_surface(m, z));
      for (std::size_t i = 0; i < 6; ++i) {
        ASSERT_TRUE(lower_end(low[i]) <= f[i] && f[i] <= upper_end(high[i]));
      }
    }
    // f_i − f0_i is linear in z: its gradient, from six solves, points to the extremes.
    const Big6 centre = balance(Big6{});
    Big66 gradients;  // [i][k] = df_i/dz_k
    for (std::size_t k = 0; k < 6; ++k) {
      Big6 z;
      z[k] = BigFloat(1.0);
      const Big6 f = balance(onto_surface(m, z));
      for (std::size_t i = 0; i < 6; ++i) gradients[i][k] = f[i] - centre[i];
    }
    for (std::size_t i = 0; i < 6; ++i) {
      BigFloat norm;
      for (const BigFloat& g : gradients[i]) norm += g * g;
      Big6 z = gradients[i];
      for (auto& x : z) x /= oracle::root(norm);
      Big6 opposite = z;
      for (auto& x : opposite) x = -x;
      const BigFloat highest = balance(onto_surface(m, z))[i];
      const BigFloat lowest = balance(onto_surface(m, opposite))[i];
      const BigFloat tolerance(1e-9 * upper_bound(s.tension_above[i]));
      ASSERT_TRUE(highest <= upper_end(high[i]) + BigFloat(1e-45) && highest >= lower_end(high[i]) - tolerance);
      ASSERT_TRUE(lowest >= lower_end(low[i]) - BigFloat(1e-45) && lowest <= upper_end(low[i]) + tolerance);
    }
  }
}

}  // namespace
}  // namespace taut::testing
