// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/map/problems.h"

namespace taut::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(MapSpace, OfTiltAndTorsionHasHalfATurnOfTilt) {
  const MapSpace space = make_map_space(robot1_slice().space);
  ASSERT_EQ(space.size(), 2);
  EXPECT_EQ(space.axes[0].kind, MapAxis::Kind::kTurn);
  EXPECT_EQ(space.axes[1].kind, MapAxis::Kind::kTilt);
  ASSERT_TRUE(space.flip);
  EXPECT_EQ(space.flip->phi, 0);
  EXPECT_EQ(space.flip->theta, 1);
  EXPECT_FALSE(space.flip->sigma);
  EXPECT_EQ(make_map_space(robot1_sigma_free().space).flip->sigma, 2);
}

TEST(MapSpace, KeepsRangesAsTyped) {
  const MapSpace space = make_map_space(robot2_sphere().space);
  EXPECT_EQ(space.axes[0].kind, MapAxis::Kind::kTurn);
  EXPECT_EQ(space.axes[1].kind, MapAxis::Kind::kRange);
  EXPECT_EQ(space.axes[1].upper, robot2_sphere().space.parameters[1].range_upper);
  EXPECT_FALSE(space.flip);
}

TEST(MapSpace, TakesARealAngleForAWholeTurn) {
  SpaceText text = robot1_slice().space;
  text.flip.reset();
  EXPECT_EQ(make_map_space(text).axes[1].kind, MapAxis::Kind::kTurn);
}

TEST(MapSpace, RefusesWhatCannotBeCovered) {
  SpaceText one = robot1_slice().space;
  one.flip.reset();
  one.parameters.pop_back();
  one.pose[4] = "0.1";
  EXPECT_THAT([&] { (void)make_map_space(one); }, ThrowsMessage<FieldError>(HasSubstr("1 free coordinate (phi)")));

  EXPECT_THAT([&] { (void)make_map_space(coordinate_space()); },
              ThrowsMessage<FieldError>(HasSubstr("6 free coordinates (px, py, pz, phi, theta, sigma)")));

  SpaceText unbounded = robot1_slice().space;
  unbounded.parameters.push_back({"px", ParameterKind::kReal, "", ""});
  unbounded.pose[0] = "px";
  EXPECT_THAT(
      [&] { (void)make_map_space(unbounded); },
      ThrowsMessage<FieldError>(HasSubstr(
          "space.parameters.px: got a coordinate without bounds, expected a range [lower, upper] for it in 'slice'")));

  SpaceText implied = robot1_sigma_free().space;
  implied.constraints = {"sin(sigma)"};
  EXPECT_THAT([&] { (void)make_map_space(implied); }, ThrowsMessage<FieldError>(HasSubstr("got 1 constraint,")));
}

}  // namespace
}  // namespace taut::testing
