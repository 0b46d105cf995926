#include "checker/pose_proof.h"

#include <gtest/gtest.h>

#include "checker/claims.h"
#include "checker/exact.h"
#include "checker/motion.h"
#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

constexpr std::array<const char*, 6> kPoseNames = {"px", "py", "pz", "phi", "theta", "sigma"};

/// The robot of an accepted certificate, free in all six coordinates.
Problem free_robot(const std::string& name) {
  nlohmann::json json = accepted(name);
  nlohmann::json parameters = nlohmann::json::array();
  nlohmann::json pose;
  for (const char* p : kPoseNames) {
    parameters.push_back({{"name", p}, {"kind", "real"}});
    pose[p] = p;
  }
  json["problem"]["space"] = {{"parameters", parameters},
                              {"constants", nlohmann::json::object()},
                              {"flip", nullptr},
                              {"pose", pose},
                              {"constraints", nlohmann::json::array()}};
  json["problem"]["query"]["waypoints"] = {{"0", "0", "0", "0", "0", "0"}, {"0", "0", "0", "0", "0", "0"}};
  json["path"]["waypoints"] = nlohmann::json::array();
  json["segments"] = nlohmann::json::array();
  json["margins"] = nlohmann::json::object();
  json["verdict"] = "undecided";
  json["claim"] = kUndecidedClaim;
  json["undecided"] = {{"reason", "a test"}, {"segment", nullptr}, {"box", nullptr}};
  seal(json);
  return read_certificate(json).problem;
}

const Box kStart = {0, 0};

Waypoint waypoint(const std::vector<double>& x) { return {x, std::vector<int>(x.size(), 0), {}}; }

/// Of a box of the straight segment.
Frame pose(const Problem& problem, const Waypoint& from, const Waypoint& to, const Box& box) {
  return frame(coordinates(problem, parameters(problem, {Interpolation::kStraight, {from, to}, {}}, 0, box)));
}

void expect_tight(const Interval& enclosure, const std::string& decimal) {
  Interval exact;
  {
    const WorkingPrecision fine(512);
    exact = Interval(parse_decimal(decimal, "oracle"));
  }
  EXPECT_TRUE(contains(enclosure, exact)) << decimal;
  EXPECT_LT(width(enclosure), 1e-25 * std::abs(mpfr_get_d(exact.lower(), MPFR_RNDN))) << decimal;
}

TEST(PoseProof, HoldsTheOracleTightly) {
  const std::map<std::string, Problem> problems = {{"robot1", free_robot("robot1_near_start")},
                                                   {"robot2", free_robot("robot2_sphere")}};
  std::map<std::string, Model> models;
  for (const auto& [name, problem] : problems) models.emplace(name, Model(problem, 128));
  std::istringstream lines(read_text(TAUT_SOURCE_DIR "/tests/oracle/poses.jsonl"));
  int poses = 0;
  for (std::string line; std::getline(lines, line); ++poses) {
    const nlohmann::json oracle = nlohmann::json::parse(line);
    const Model& model = models.at(oracle["robot"]);
    const Waypoint at = waypoint(oracle["pose"]);
    const Geometry geometry = model.geometry(pose(problems.at(oracle["robot"]), at, at, kStart));
    const Tensions tensions = model.tensions(geometry);
    Interval det = determinant(mid(geometry.D));
    Interval scale;
    for (std::size_t i = 0; i < kCables; ++i) {
      expect_tight(geometry.length[i].range, oracle["length_m"][i]);
      expect_tight(tensions.centre[i].range, oracle["f0_N"][i]);
      expect_tight(tensions.spread[i].range, oracle["v_N"][i]);
      det = det / geometry.length[i].range;
      const Interval f0 = tensions.centre[i].range;
      const Interval v = tensions.spread[i].range;
      for (const Interval& ratio :
           {(f0 - model.tension_limit(i, false)) / v, (model.tension_limit(i, true) - f0) / v}) {
        scale = i == 0 && scale.is_exactly_zero() ? ratio : -max(-scale, -ratio);
      }
    }
    expect_tight(det, oracle["det_J"]);
    expect_tight(scale, oracle["wrench_scale"]);
  }
  EXPECT_EQ(poses, 600);
}

TEST(PoseProof, HoldsEveryPoseOfABox) {
  const Problem problem = free_robot("robot1_near_start");
  const Model model(problem, 128);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  int invertible = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> from = {0.1 * unit(random), 0.1 * unit(random), 0.3 + 0.1 * unit(random),
                                3 * unit(random),   0.9 * unit(random), 0.8 * unit(random)};
    std::vector<double> to = from;
    const double step = std::ldexp(0.2, -(trial % 6));
    for (double& x : to) x += step * unit(random);
    const Waypoint a = waypoint(from), b = waypoint(to);
    const Box box = {mpq_class(trial % 3, 4), mpq_class(trial % 3 + 1, 4)};
    try {
      const Geometry whole = model.geometry(pose(problem, a, b, box));
      const Tensions tensions = model.tensions(whole);
      ++invertible;
      for (int sample = 0; sample < 8; ++sample) {
        const mpq_class s = box.begin + (box.end - box.begin) * random_rational(random, 0, 1);
        const Geometry at = model.geometry(pose(problem, a, b, {s, s}));
        const Tensions at_tensions = model.tensions(at);
        for (std::size_t i = 0; i < kCables; ++i) {
          EXPECT_TRUE(meet(whole.length[i].range, at.length[i].range));
          EXPECT_TRUE(meet(tensions.centre[i].range, at_tensions.centre[i].range));
          EXPECT_TRUE(meet(tensions.spread[i].range, at_tensions.spread[i].range));
        }
      }
    } catch (const Undefined&) {
    }
  }
  EXPECT_GT(invertible, 30);
}

TEST(PoseProof, ASingularMatrixHasNoInverseAndNoDeterminant) {
  const Problem problem = free_robot("robot1_near_start");
  const Model model(problem, 128);
  const Waypoint flat = waypoint({0, 0, 0, 0, 0, 0});  // all cables in one plane
  const Geometry geometry = model.geometry(pose(problem, flat, flat, kStart));
  EXPECT_THROW((void)model.tensions(geometry), Undefined);
  EXPECT_THROW((void)determinant(mid(geometry.D)), Undefined);
}

TEST(PoseProof, ABoxAcrossASingularPoseIsNeverInverted) {
  const Problem problem = free_robot("robot1_near_start");
  const Model model(problem, 128);
  int sign_changes = 0;
  for (int k = 1; k < 30; ++k) {
    const Waypoint above = waypoint({0.01, 0.02, -std::ldexp(0.3, -k), 0.3, 0.01, 0.2});
    const Waypoint below = waypoint({0.01, 0.02, std::ldexp(0.2, -k), 0.3, 0.01, 0.2});
    const auto det = [&](const Waypoint& w) { return determinant(mid(model.geometry(pose(problem, w, w, kStart)).D)); };
    if (!certainly_negative(det(above) * det(below))) continue;
    ++sign_changes;
    EXPECT_THROW((void)model.tensions(model.geometry(pose(problem, above, below, {0, 1}))), Undefined) << k;
  }
  EXPECT_GT(sign_changes, 5);
}

TEST(PoseProof, ACableWithoutLengthIsUndefined) {
  Problem problem = free_robot("robot1_near_start");
  problem.platform_anchors[2] = problem.base_anchors[2];
  const Model model(problem, 128);
  const Waypoint origin = waypoint({0, 0, 0, 0, 0, 0});
  EXPECT_THROW((void)model.geometry(pose(problem, origin, origin, kStart)), Undefined);
}

TEST(PoseProof, AnEllipsoidThatIsNotPositiveDefiniteIsRefused) {
  Problem problem = free_robot("robot1_near_start");
  problem.ellipsoid[0][1] = problem.ellipsoid[1][0] = problem.ellipsoid[0][0];
  EXPECT_THROW((Model(problem, 512)), Undefined);
  problem.ellipsoid[0][1] = problem.ellipsoid[1][0] = 0;
  problem.ellipsoid[5][5] = -1;
  EXPECT_THROW((Model(problem, 512)), Undefined);
}

TEST(PoseProof, ATiltedEllipsoidIsTheSameAsTiltedForces) {
  // K' = S K, that is E' = S^-T E S^-1: the spread of row y under E' is that of S'y under E. With S a shear of forces.
  Problem sheared = free_robot("robot1_near_start");
  auto& E = sheared.ellipsoid;  // S^-1 = I - 1/2 e0 e1', so that E' = E - (E01 terms)
  const mpq_class e = E[0][0];
  E[0][1] = E[1][0] = -e / 2;
  E[1][1] += e / 4;
  const Problem plain = free_robot("robot1_near_start");
  const Model tilted(sheared, 128);
  const Model straight(plain, 128);
  const Waypoint at = waypoint({0.01, 0.02, 0.35, 0.3, 0.5, 0.6});
  const Geometry geometry = straight.geometry(pose(plain, at, at, kStart));
  // S = I + 1/2 e0 e1'. Rows of J^-1 are what the wrench's unit vectors pull: with e1 -> e1 + e0 / 2.
  const auto spread_along = [&](const Vector6<mpq_class>& w) {
    Problem loaded = plain;
    loaded.wrench = w;
    return Model(loaded, 128).tensions(geometry).centre;
  };
  Vector6<Interval> squared;
  for (std::size_t k = 0; k < 6; ++k) {
    Vector6<mpq_class> w;
    w[k] = 1;
    if (k == 1) w[0] = mpq_class(1, 2);
    const Vector6<Form> f = spread_along(w);
    for (std::size_t i = 0; i < 6; ++i) squared[i] += sqr(f[i].range) / Interval(plain.ellipsoid[k][k]);
  }
  const Tensions tensions = tilted.tensions(geometry);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_TRUE(meet(tensions.spread[i].range, sqrt(squared[i])));
    EXPECT_LT(width(tensions.spread[i].range), 1e-28);
  }
}

}  // namespace
}  // namespace taut::checker
