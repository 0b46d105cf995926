// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/body_distances.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "reports/summary/broken_limits.h"
#include "reports/summary/key_numbers.h"
#include "reports/summary/sentences.h"
#include "reports/summary/summary.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t kPlateAndFloor = 0, kPlateAndPost = 1, kCable1AndFloor = 2;

ReportContext proved() { return sample::scene(sample::with_bodies(sample::proved())); }

/// The plate's corners in W.
std::vector<Vector3<double>> plate_at(const ReportContext& scene, const PathSample& sample) {
  const Matrix3<double> turn = rotation(scene.sampler.model().angles, sample.pose.angles);
  std::vector<Vector3<double>> corners;
  for (const double x : {-0.1, 0.1}) {
    for (const double y : {-0.1, 0.1}) corners.emplace_back(sample.pose.p_WP + turn * Vector3<double>(x, y, 0));
  }
  return corners;
}

TEST(BodyDistances, AreThoseOfTheShapes) {
  const ReportContext scene = proved();
  const PathSample& sample = scene.samples.front();
  const RigidPose pose = scene.sampler.rigid_pose(sample);
  double lowest = 1, nearest = 1;
  for (const Vector3<double>& corner : plate_at(scene, sample)) lowest = std::min(lowest, corner(2));
  const std::vector<Vector3<double>> corners = plate_at(scene, sample);
  for (int i = 0; i <= 200; ++i) {  // another route: a grid on the plate, against the post's axis
    for (int j = 0; j <= 200; ++j) {
      const Vector3<double> p =
          corners[0] + i / 200.0 * (corners[2] - corners[0]) + j / 200.0 * (corners[1] - corners[0]);
      const double z = std::clamp(p(2), 0.0, 0.5);
      nearest = std::min(nearest, (p - Vector3<double>(0.3, 0, z)).norm());
    }
  }
  const BodyDistance floor = scene.bodies->at(scene.sampler.model(), pose, kPlateAndFloor);
  EXPECT_NEAR(floor.distance, lowest + 0.05 - 0.002, 1e-12);
  EXPECT_EQ(floor.clearance, 0.02);
  EXPECT_NEAR(floor.at[1](2), -0.05, 1e-12);
  const BodyDistance post = scene.bodies->at(scene.sampler.model(), pose, kPlateAndPost);
  EXPECT_NEAR(post.distance, nearest - 0.022, 1e-5);
  EXPECT_EQ(post.clearance, 0.03) << "the post's own";
  EXPECT_NEAR((post.at[0] - post.at[1]).norm(), post.distance, 1e-12);
  EXPECT_NEAR((post.at[1].head<2>() - Eigen::Vector2d(0.3, 0)).norm(), 0.02, 1e-9);
  EXPECT_EQ(scene.bodies->name(kPlateAndPost), "plate / post");
  const BodyDistance cable = scene.bodies->at(scene.sampler.model(), pose, kCable1AndFloor);
  const Vector3<double> a = scene.sampler.model().p_WA[0];
  const Vector3<double> along = (pose.p + pose.q * scene.sampler.model().p_PB[0] - a).normalized();
  EXPECT_NEAR(cable.distance, 0.02 * along(2) + 0.05 - 0.0005, 1e-12) << "beyond its free end";
}

TEST(BodyDistances, SayAboutHowDeepBodiesAreInEachOther) {
  nlohmann::json certificate = sample::with_bodies(sample::proved());
  nlohmann::json& bodies = certificate["problem"]["bodies"];
  const auto box = [](double half) {
    nlohmann::json points = nlohmann::json::array();
    for (const int k : {0, 1, 2, 3, 4, 5, 6, 7}) {
      nlohmann::json point = nlohmann::json::array();
      for (const int c : {0, 1, 2}) point.push_back(std::to_string((k >> c & 1) != 0 ? half : -half));
      points.push_back(point);
    }
    return nlohmann::json{{"radius_m", "0"}, {"points_m", points}};
  };
  // The platform's origin stays at (0, 0, 0.35), and a cube is a ball's worth around it at least.
  bodies["platform"][0]["hull"] = nlohmann::json::parse(R"({"radius_m": "0.05", "points_m": [["0","0","0"]]})");
  bodies["obstacles"][1] = {{"name", "post"}, {"at_m", {"0.03", "0.01", "0.36"}}, {"hull", box(0.1)}};
  const ReportContext scene = sample::scene(certificate);
  const RigidPose pose = scene.sampler.rigid_pose(scene.samples.front());
  const BodyDistance found = scene.bodies->at(scene.sampler.model(), pose, kPlateAndPost);
  // Out of the cube through the side x = −0.07, which is 0.07 away, and the ball's radius beyond it.
  EXPECT_NEAR(found.distance, -(0.07 + 0.05), 1e-6);
  EXPECT_LT(found.left(), found.distance);
}

TEST(BodyDistances, FindTheNearestPairsAlongThePathThatAllPairsGive) {
  const ReportContext scene = proved();
  const DistancesAlong& along = scene.distances;
  ASSERT_EQ(along.least.size(), scene.samples.size());
  std::vector<double> least(scene.bodies->pairs(), 1e9);
  for (std::size_t k = 0; k < scene.samples.size(); ++k) {
    double here = 1e9;
    for (std::size_t n = 0; n < scene.bodies->pairs(); ++n) {
      const double left = scene.bodies->at(scene.sampler.model(), scene.sampler.rigid_pose(scene.samples[k]), n).left();
      here = std::min(here, left);
      least[n] = std::min(least[n], left);
    }
    ASSERT_EQ(along.least[k].left(), here) << "at sample " << k;
  }
  std::ranges::sort(least);
  EXPECT_EQ(along.least[along.worst()].left(), least[0]);
  ASSERT_EQ(along.nearest.size(), DistancesAlong::kMostPairs);
  for (std::size_t n = 0; n < along.nearest.size(); ++n) {
    EXPECT_EQ(along.distance[n][along.nearest_at[n]] - along.clearance[n][along.nearest_at[n]], least[n]) << n;
    EXPECT_EQ(along.distance[n].size(), scene.samples.size());
  }
}

TEST(BodyDistances, AreNoneOfAProblemWithoutBodies) {
  const ReportContext scene = sample::scene(sample::proved());
  EXPECT_FALSE(scene.bodies);
  EXPECT_TRUE(scene.distances.least.empty());
  EXPECT_TRUE(to_json(Summary(scene, {})).at("bodies").is_null());
}

// ---- What reports say of them.

TEST(ReportOfBodies, SaysWhatIsCheckedAndWhatIsNot) {
  const ReportContext scene = proved();
  const Summary summary(scene, {});
  EXPECT_THAT(summary.headline, HasSubstr("all checked bodies keep their clearances"));
  const auto statement = std::ranges::find(summary.statements, std::string("clearance"), &Statement::key);
  ASSERT_NE(statement, summary.statements.end());
  EXPECT_THAT(statement->text,
              AllOf(HasSubstr("platform and obstacles, 2 pairs, 20 mm"), HasSubstr("cables and obstacles, 12 pairs"),
                    HasSubstr("Not checked: cables among each other, cables and platform."), HasSubstr("'post'")));
  const ScopeItem collisions = not_covered(scene.certificate.problem).front();
  EXPECT_THAT(collisions.text, AllOf(HasSubstr("not among the stated bodies"), HasSubstr("cables among each other"),
                                     HasSubstr("free ends")));
  const std::string assumed_text = in_full(assumed(scene.certificate.problem, Interpolation::kStraight));
  EXPECT_THAT(assumed_text, AllOf(HasSubstr("Obstacles do not move"), HasSubstr("are one point")));
  const auto item = std::ranges::find(summary.lift_plan, std::string("clearances"), &LiftPlanItem::key);
  EXPECT_THAT(item->filled, AllOf(HasSubstr("farther apart than their clearances"), HasSubstr("20 mm")));
}

TEST(ReportOfBodies, HasTheProvedClearanceAndTheNearestPair) {
  const ReportContext scene = proved();
  const std::vector<KeyNumber> numbers = Summary(scene, {}).key_numbers;
  const auto number = std::ranges::find(numbers, std::string("clearance"), &KeyNumber::key);
  ASSERT_NE(number, numbers.end());
  EXPECT_EQ(number->value, "12.3 mm left");
  EXPECT_THAT(number->detail, AllOf(HasSubstr(scene.bodies->name(scene.distances.least[scene.distances.worst()].pair)),
                                    HasSubstr("clearance "), HasSubstr("sampled")));
  EXPECT_TRUE(number->is_proved);
  const nlohmann::json json = to_json(Summary(scene, {})).at("bodies");
  EXPECT_EQ(json.at("proved_left_m"), 0.0123);
  EXPECT_EQ(json.at("not_checked"), nlohmann::json({"cables-cables", "cables-platform"}));
  EXPECT_EQ(json.at("checked")[0],
            (nlohmann::json{{"class", "platform-obstacles"}, {"pairs", 2}, {"clearance_m", 0.02}}));
  EXPECT_EQ(json.at("nearest").size(), 6U);
}

TEST(ReportOfBodies, NamesAContactWithPairPlaceDepthAndPoints) {
  const ReportContext scene = sample::scene(sample::contact());
  // 30 mm are asked for, and 31.5 mm are missing.
  EXPECT_EQ(headline(scene), "Refuted: on this move 'plate' and 'post' touch; the clearance asked for is 30 mm.");
  const std::vector<BrokenLimit> broken = broken_limits(scene);
  ASSERT_FALSE(broken.empty());
  ASSERT_TRUE(broken.front().bodies);
  EXPECT_TRUE(broken.front().is_proved());
  EXPECT_EQ(subject_text(scene, broken.front()), "plate / post");
  EXPECT_EQ(what_text(broken.front()), "in each other");
  EXPECT_THAT(amount_text(scene, broken.front()), AllOf(HasSubstr("deep in each other"), HasSubstr("clearance 30 mm")));
  EXPECT_THAT(where_text(scene, broken.front()), AllOf(HasSubstr("segment 1"), HasSubstr("about (")));
  EXPECT_EQ(std::ranges::count_if(broken, [](const BrokenLimit& b) { return b.bodies && b.bodies->pair == 1; }), 1)
      << "once, though samples show it, too";
  const std::string text = to_text(Summary(scene, {}));
  EXPECT_THAT(text, AllOf(HasSubstr("Bodies too near"), HasSubstr("deep in each other")));
  EXPECT_THAT(Summary(scene, {}).lift_plan,
              Contains(::testing::Field(&LiftPlanItem::open, HasSubstr("proves no clearances"))));
}

TEST(ReportOfBodies, SaysHowFarAwayTheNearerPointsAreProvedToBe) {
  nlohmann::json certificate = sample::contact();
  const auto said = [&](const char* depth) {
    certificate["witness"]["depth_m"] = depth;
    return headline(sample::scene(certificate));
  };
  EXPECT_THAT(said("0.0099"), HasSubstr("come within 20.1 mm of each other; the clearance asked for is 30 mm"));
  EXPECT_THAT(said("0.00000001"), HasSubstr("come within 29.99999 mm of each other; the clearance asked for is 30 mm"));
  EXPECT_THAT(said("0"), HasSubstr("come within 30 mm of each other, the clearance asked for"));
  EXPECT_THAT(said("0.03"), HasSubstr("touch; "));
  EXPECT_THAT(said("0.0299999999"), HasSubstr("touch or overlap, or are at most 0.001 mm apart; the clearance"));
}

TEST(ReportOfBodies, ClaimsNothingOfAnUncheckedCertificate) {
  const ReportContext scene = sample::unchecked(sample::with_bodies(sample::proved()));
  const Summary summary(scene, {});
  EXPECT_TRUE(to_json(summary).at("bodies").at("proved_left_m").is_null());
  EXPECT_THAT(to_text(summary), Not(HasSubstr("12.3 mm")));
}

}  // namespace
}  // namespace taut
