// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/elaborate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::robot1_slice;

Waypoint at(double phi, double theta) { return {{phi, theta}, {0, 0}}; }

/// What sampling finds along a path.
struct Sampled {
  double tension = 1e300;
  double scale = 1e300;
};

Sampled sample(const Problem& problem, const Path& path) {
  constexpr int kSamples = 4000;
  const PoseSampler sampler(problem);
  Sampled least;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    for (int i = 0; i <= kSamples; ++i) {
      const RigidPose pose = sampler.rigid_pose(path.segment(k), static_cast<double>(i) / kSamples);
      const Statics<double> s = statics(sampler.model(), pose.p, Matrix3<double>(pose.q.toRotationMatrix()));
      for (std::size_t c = 0; c < kCables; ++c) {
        least.tension = std::min({least.tension, s.tension[c] - s.tension_below[c] - sampler.model().tension_lower[c],
                                  sampler.model().tension_upper[c] - s.tension[c] - s.tension_above[c]});
      }
      least.scale = std::min(least.scale, wrench_scale_approx(sampler.model(), s));
    }
  }
  return least;
}

/// Segments are proved in few boxes; a certificate states nearly all of the path's least margins all the same.
TEST(Elaborate, StatesNearlyAllOfTheLeastMargins) {
  const Problem problem = robot1_slice();
  const Prover prover(problem);
  Path path;
  path.waypoints = {at(-2.3372182, 0.9996711), at(-2.3663992, 0.9026033), at(-2.4146207, 0.8187704)};
  const PathProof proof = prove_path(prover, path);
  ASSERT_EQ(proof.verdict, Verdict::kProved) << proof.reason;
  const Certificate certificate = elaborate(problem, path, proof);
  ASSERT_EQ(certificate.verdict, Verdict::kProved);
  const Sampled least = sample(problem, path);
  const double tension = std::stod(certificate.margins->tension_N);
  const double scale = std::stod(certificate.margins->wrench_scale);
  EXPECT_LE(tension, least.tension);
  EXPECT_LE(scale, least.scale);
  EXPECT_GE(tension, 0.95 * least.tension);
  EXPECT_GE(scale - 1, 0.95 * (least.scale - 1));

  double before = 1e300;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    before = std::min(before, prover.prove(path.segment(k)).tension_N);
    const std::vector<checker::Box>& boxes = certificate.segments[k].boxes;
    ASSERT_FALSE(boxes.empty());
    EXPECT_EQ(boxes.front().begin, 0);
    EXPECT_EQ(boxes.back().end, 1);
    for (std::size_t i = 1; i < boxes.size(); ++i) EXPECT_EQ(boxes[i].begin, boxes[i - 1].end);
  }
  EXPECT_LT(before, 0.45 * least.tension) << "a path that shows nothing";
}

}  // namespace
}  // namespace taut
