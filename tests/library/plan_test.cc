// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "base/input_error.h"
#include "planner/planner.h"
#include "tests/atlas/sealed.h"
#include "tests/support/temporary_file.h"

namespace taut {
namespace {

using testing::TemporaryFile;

Case case_of(const std::string& name) { return load_case(TAUT_SOURCE_DIR "/cases/" + name + ".yaml"); }

/// With other waypoints.
Case with_query(Case the_case, const std::vector<std::vector<double>>& waypoints) {
  the_case.problem.query.clear();
  for (const std::vector<double>& waypoint : waypoints) {
    auto& values = the_case.problem.query.emplace_back();
    for (const double x : waypoint) values.push_back(fmt::format("{:.17f}", x));
  }
  return the_case;
}

std::vector<std::vector<double>> waypoints_of(const Plan& plan) {
  std::vector<std::vector<double>> result;
  for (const Waypoint& waypoint : plan.path.waypoints) result.push_back(waypoint.parameters().x);
  return result;
}

constexpr const char* kRobot1 = "robot1-slice-qs-qg";
constexpr const char* kRobot2 = "robot2-sphere-q1-q2-q3";

TEST(StoredAtlas, GivesThePathOfTheAtlasInMemory) {
  for (const char* name : {kRobot1, kRobot2}) {
    const Case the_case = case_of(name);
    Planner planner(the_case);
    ASSERT_EQ(planner.plan({}, {}).proof.verdict, Verdict::kProved);
    const TemporaryFile file(planner.atlas_bytes());
    const int stored = planner.atlas().size();
    const Plan in_memory = planner.plan({}, {});
    const Plan from_file = Planner(the_case, file.path()).plan({}, {});
    EXPECT_EQ(from_file.proof.verdict, Verdict::kProved);
    EXPECT_EQ(waypoints_of(from_file), waypoints_of(in_memory));
    EXPECT_EQ(from_file.statistics.cost, in_memory.statistics.cost);
    EXPECT_EQ(from_file.statistics.charts_stored, stored);
    EXPECT_EQ(from_file.statistics.charts, in_memory.statistics.charts);
  }
}

TEST(StoredAtlas, GrownAnswersQueriesWithoutNewChartsButThoseOfTheWaypoints) {
  const Case first = case_of(kRobot1);
  Planner planner(first);
  static_cast<void>(planner.plan({}, {}));
  ASSERT_TRUE(planner.grow_atlas({}, {}));
  const TemporaryFile file(planner.atlas_bytes());
  for (const double phi : {-2.0, -0.5, 0.5}) {
    const Case other = with_query(first, {{phi, 0.0}, {1.7, 1.7}});
    const Plan answer = Planner(other, file.path()).plan({}, {});
    EXPECT_EQ(answer.proof.verdict, Verdict::kProved) << answer.proof.reason;
    EXPECT_LE(answer.statistics.charts, planner.atlas().size() + 2);
  }
}

TEST(StoredAtlas, IsCarriedFromQueryToQuery) {
  const Case first = case_of("robot1-slice-qs1-qg");
  Planner one(first);
  static_cast<void>(one.plan({}, {}));
  const TemporaryFile file(one.atlas_bytes());
  const Case second = case_of(kRobot1);
  Planner two(second, file.path());
  EXPECT_EQ(two.plan({}, {}).proof.verdict, Verdict::kProved);
  EXPECT_GT(two.atlas().size(), one.atlas().size());
  const TemporaryFile grown(two.atlas_bytes());
  const Plan third = Planner(first, grown.path()).plan({}, {});
  EXPECT_EQ(third.proof.verdict, Verdict::kProved);
  EXPECT_EQ(third.statistics.charts_stored, two.atlas().size());
}

TEST(StoredAtlas, ServesAQueryNearerToALimitThanItsClearance) {
  Case the_case = case_of(kRobot1);
  the_case.planner.clearance = 0.05;  // q_s and q_g are not that far from their limits
  const Case roomy = with_query(the_case, {{0.5, 0.0}, {-0.5, 0.3}});
  Planner planner(roomy);
  ASSERT_EQ(planner.plan({}, {}).proof.verdict, Verdict::kProved);
  ASSERT_TRUE(planner.grow_atlas({}, {}));
  const TemporaryFile file(planner.atlas_bytes());
  Planner close(the_case, file.path());
  EXPECT_EQ(close.plan({}, {}).proof.verdict, Verdict::kProved);
  const TemporaryFile closer(close.atlas_bytes());  // holds charts beyond the clearance
  EXPECT_EQ(Planner(roomy, closer.path()).plan({}, {}).proof.verdict, Verdict::kProved);
}

TEST(StoredAtlas, ThatLeadsNowhereIsSetAside) {
  const Case the_case = case_of("robot1-slice-qs-qg");
  Case beginning = the_case;
  beginning.planner.max_charts = 20;
  Planner planner(beginning);
  ASSERT_EQ(planner.plan({}, {}).proof.verdict, Verdict::kUndecided);
  std::string bytes = planner.atlas_bytes();
  const testing::AtlasFilePlaces places(bytes);
  for (std::size_t id = 0; id < places.charts; ++id) bytes[places.complete + id] = 1;  // "nothing is left to grow"
  testing::seal(bytes, places);
  const TemporaryFile file(bytes);
  const Plan answer = Planner(the_case, file.path()).plan({}, {});
  EXPECT_EQ(answer.proof.verdict, Verdict::kProved);
  EXPECT_EQ(answer.statistics.charts_stored, 0);
}

// With its checksums made right: whatever a file says, it is refused or the answer is what it is without the file.
TEST(StoredAtlas, ThatIsForgedIsRefusedOrCostsTimeAtMost) {
  const Case the_case = case_of("robot1-slice-qs1-qg");
  Planner planner(the_case);
  static_cast<void>(planner.plan({}, {}));
  const std::string bytes = planner.atlas_bytes();
  const testing::AtlasFilePlaces places(bytes);
  std::mt19937 random(1);
  int proved = 0;
  for (int round = 0; round < 150; ++round) {
    std::string forged = bytes;
    const std::size_t from = round % 3 == 0 ? places.polytopes : testing::AtlasFilePlaces::kTables;
    for (int flips = 1 + round % 4; flips > 0; --flips) {
      const std::size_t at = from + random() % (forged.size() - from);
      forged[at] = static_cast<char>(forged[at] ^ (1u << random() % 8));
    }
    testing::seal(forged, places);
    const TemporaryFile file(forged);
    try {
      const Plan answer = Planner(the_case, file.path()).plan({}, {});
      ASSERT_EQ(answer.proof.verdict, Verdict::kProved) << round << ": " << answer.proof.reason;
      ++proved;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(proved, 20) << "some forgeries are plausible";
}

TEST(StoredAtlas, OfAnotherProblemIsRefused) {
  const Case the_case = case_of("robot1-slice-qs1-qg");
  Planner planner(the_case);
  static_cast<void>(planner.plan({}, {}));
  const TemporaryFile file(planner.atlas_bytes());
  const Case renamed = [&] {
    Case other = the_case;
    other.problem.name = "another name";
    return other;
  }();
  EXPECT_NO_THROW(Planner(renamed, file.path()));
  std::vector<Case> others(5, the_case);
  others[0].problem.robot.tension_N[4].upper = "0.51";
  others[1].problem.robot.base_anchors_m[0][0] = "0.0001";
  others[2].problem.load.wrench[2] = "1.001";
  others[3].planner.radius = 0.14;
  others[4].planner.clearance = 0.02;
  for (const Case& other : others) EXPECT_THROW(Planner(other, file.path()), InputError);
}

// The slice shows that nothing forces the origin to move.
TEST(Travel, KeepsTheOriginOfAFreePlatformInPlaceWhereRotationLetsItWander) {
  Case the_case = case_of("robot1-free-box-qs-qg");
  const auto way = [&](Cost cost) {
    the_case.planner.cost = cost;
    Planner planner(the_case);
    const Plan plan = planner.plan({}, {});
    EXPECT_EQ(plan.proof.verdict, Verdict::kProved) << plan.proof.reason;
    return planner.measure(plan.path);
  };
  const MotionLengths by_rotation = way(Cost::kRotation);
  const MotionLengths by_travel = way(Cost::kTravel);
  EXPECT_LT(by_travel.length_m, 0.02);
  EXPECT_LT(4 * by_travel.length_m, by_rotation.length_m);
  EXPECT_LT(by_travel.angle_rad, 1.2 * by_rotation.angle_rad);
}

}  // namespace
}  // namespace taut
