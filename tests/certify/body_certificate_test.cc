// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates about bodies, from proof to checker.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "case/case_file.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "certify/path_proof.h"
#include "checker/check.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::at;
using ::testing::HasSubstr;

BodyText block(const std::string& name, const PointText& half, const PointText& place) {
  HullText hull;
  for (unsigned k = 0; k < 8; ++k) {
    PointText corner;
    for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] = ((k >> axis & 1U) != 0 ? "" : "-") + half[axis];
    hull.points_m.push_back(corner);
  }
  return {.name = name, .at_m = place, .shape = hull};
}

/// The crane of the cases with tolerances, its container, and what stands in the hall.
Problem crane() {
  Problem problem = load_case(TAUT_SOURCE_DIR "/cases/cranes/portal-20t.yaml").problem;
  problem.query.clear();
  BodiesText bodies;
  bodies.platform = {block("container", {"1.2", "3.05", "1.3"}, {"0", "0", "-2.2"})};
  bodies.obstacles = {block("stack", {"1.2", "3.05", "1.3"}, {"0", "1", "1.3"}),
                      {.name = "floor", .shape = HalfSpaceText{{"0", "0", "1"}}}};
  bodies.obstacles[0].rotation_rad[2] = "(10)*pi/180";
  bodies.cables.diameter_m.fill("0.028");
  bodies.cables.free_ends_m.fill({"1.5", "0.4"});
  bodies.clearance_m = {"0.2", "0.2", std::nullopt, "0.01"};
  problem.bodies = bodies;
  validate(problem);
  return problem;
}

Path path_through(const std::vector<std::vector<double>>& points) {
  Path path;
  for (const std::vector<double>& x : points) path.waypoints.push_back(at(x));
  return path;
}

Certificate certificate_of(const Problem& problem, const Path& path) {
  const Prover prover(problem);
  return elaborate(problem, path, prove_path(prover, path, {}, {}));
}

TEST(BodyCertificate, OfAProvedPathIsAccepted) {
  const Problem problem = crane();
  const Path path = path_through({{-4, 0, 6.6, 0, 0, -0.1}, {0, 0, 6.7, 0, 0, 0}, {4, 0, 6.6, 0, 0, 0.1}});
  const Certificate certificate = certificate_of(problem, path);
  ASSERT_EQ(certificate.verdict, Verdict::kProved) << certificate.undecided.value_or(OpenPart{}).reason;
  const std::string text = certificate_text(certificate);
  const checker::CheckResult result = checker::check(text, {});
  ASSERT_EQ(result.outcome, checker::Outcome::kAccepted) << result.message;
  ASSERT_TRUE(result.theorem);
  EXPECT_THAT(result.theorem->claim(), HasSubstr("farther apart than the pair's clearance"));
  EXPECT_THAT(result.theorem->claim(), HasSubstr("Pairs that are not checked: cables-cables."));
  const double clearance = std::stod(result.theorem->margins()["clearance_m"].get<std::string>());
  // There are 6.6 - 3.5 - 2.6 - 0.2 = 0.3 m, less 50 mm and 0.3 degrees. Along the first direction that proves a pair,
  // less may be stated.
  EXPECT_GT(clearance, 0);
  EXPECT_LT(clearance, 0.25);
}

TEST(BodyCertificate, OfAContactIsAccepted) {
  const Problem problem = crane();
  const Certificate certificate =
      certificate_of(problem, path_through({{-4, 0, 6.2, 0, 0, -0.1}, {4, 0, 6.2, 0, 0, 0.1}}));
  ASSERT_EQ(certificate.verdict, Verdict::kRefuted) << certificate.undecided.value_or(OpenPart{}).reason;
  const checker::CheckResult result = checker::check(certificate_text(certificate), {});
  ASSERT_EQ(result.outcome, checker::Outcome::kAccepted) << result.message;
  EXPECT_EQ(result.theorem->witness()["kind"], "contact");
}

}  // namespace
}  // namespace taut
