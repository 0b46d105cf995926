// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/tolerance_limits.h"

#include <gtest/gtest.h>

#include "certify/path_proof.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::robot1_slice;

Path short_path() {
  Path path;
  for (const double theta : {0.2, 0.26, 0.33}) path.waypoints.push_back({{0.5, theta}, {0, 0}});
  return path;
}

Problem with(Problem problem, ToleranceKind kind, double size) {
  TolerancesText& t = problem.tolerances ? *problem.tolerances : problem.tolerances.emplace();
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.17g", size);
  const std::string text = buffer.data();
  switch (kind) {
    case ToleranceKind::kBaseAnchors: t.base_anchor_m.fill(text); break;
    case ToleranceKind::kPlatformAnchors: t.platform_anchor_m.fill(text); break;
    case ToleranceKind::kLoadPoint: t.load_point_m = text; break;
    case ToleranceKind::kLoad: t.wrench[2] = text; break;
    case ToleranceKind::kPosition: t.position_m = text; break;
    case ToleranceKind::kOrientation: t.orientation_rad = text; break;
    case ToleranceKind::kCableLengths: t.cable_length_m.emplace().fill(text); break;
  }
  return problem;
}

Verdict verdict(const Problem& problem) {
  const Prover prover(problem);
  Path path = short_path();
  for (std::size_t k = 0; k < path.segments(); ++k) {
    if (prover.prove(prover.prepared(path.segment(k))).verdict != Verdict::kProved) return Verdict::kUndecided;
  }
  return Verdict::kProved;
}

TEST(ToleranceLimits, AreProvedAndNotFarFromWhereTheProofFails) {
  Problem problem = robot1_slice();
  problem.tolerances.emplace().position_m = "0.0002";
  problem.tolerances->cable_length_m.emplace().fill("0");
  const std::vector<ToleranceLimit> limits = tolerance_limits(problem, short_path(), {});
  ASSERT_EQ(limits.size(), 7U);
  for (const ToleranceLimit& limit : limits) {
    EXPECT_GT(limit.proved, limit.kind == ToleranceKind::kPosition ? 0.0002 : 1e-6) << name(limit.kind);
    EXPECT_EQ(verdict(with(problem, limit.kind, limit.proved)), Verdict::kProved) << name(limit.kind);
    EXPECT_NE(verdict(with(problem, limit.kind, 1.05 * limit.proved)), Verdict::kProved)
        << name(limit.kind) << " " << limit.proved;
  }
  EXPECT_EQ(limits[4].stated, 0.0002);
}

TEST(ToleranceLimits, AreAsStatedWhenThereIsNoTimeToLook) {
  Problem problem = robot1_slice();
  problem.tolerances.emplace().position_m = "0.0002";
  std::stop_source source;
  source.request_stop();
  for (const ToleranceLimit& limit : tolerance_limits(problem, short_path(), source.get_token())) {
    EXPECT_EQ(limit.proved, limit.stated);
  }
}

}  // namespace
}  // namespace taut
