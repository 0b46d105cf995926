// SPDX-License-Identifier: GPL-3.0-or-later
// What a proof costs, in units of what everybody else does: samples of the pose.
//
// Proves 2,000 random feasible segments of 0.15 rad of each robot's slice and sphere, and divides the time by that of
// one floating-point evaluation of lengths, f0, v and margins at a pose (what a sampled validity check does once a
// sample). Both are timed in the same run, alternately, and the medians are compared. The same with tolerances of all
// kinds, on such segments as are proved with them; and between the same poses under the law of cable lengths. Also: one
// interval product of ours, and of Boost.Interval with each operation directed by MPFR, which is why Interval exists.
//
// Usage: proof_cost [JSON_FILE]; Markdown on stdout.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "certify/prover.h"
#include "kinematics/pose_conversion.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/statics.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

/// Of this thread's processor, which a busy machine disturbs less than the wall clock.
double seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

class Sampler {
 public:
  explicit Sampler(const Problem& problem) : model_(make_model<double>(problem)), pose_(pose_tape(problem)) {}

  /// Smallest margin at a pose, relative to nothing: positive means feasible.
  [[nodiscard]] double margin(const std::array<double, 2>& q) const {
    const Statics<double> at = statics(model_, evaluate_pose(pose_, std::span<const double>(q)));
    if (!at.regular) return -1;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < kCables; ++i) {
      least = std::min({least, at.tension[i] - at.tension_below[i] - model_.tension_lower[i],
                        model_.tension_upper[i] - at.tension[i] - at.tension_above[i],
                        at.length[i] - model_.length_lower[i], model_.length_upper[i] - at.length[i]});
    }
    return least;
  }

 private:
  Model<double> model_;
  Evaluator<double> pose_;
};

struct Row {
  std::string name;
  double pose_us = 0, segment_us = 0, boxes = 0, judged = 0;
  int proved = 0, total = 0;
};

/// What a segment is proved with besides.
enum class Kind { kPlain, kTolerances, kCableLengths };

/// Small ones of every kind.
TolerancesText all_tolerances() {
  TolerancesText t;
  t.base_anchor_m.fill("1e-5");
  t.platform_anchor_m.fill("1e-5");
  t.load_point_m = "1e-5";
  t.wrench[2] = "1e-3";
  t.position_m = "1e-5";
  t.orientation_rad = "1e-4";
  t.cable_length_m.emplace().fill("1e-5");
  return t;
}

/// The pose, and the lengths there.
Waypoint on_lengths(const Model<double>& model, const RigidPose& pose) {
  return LengthsPoint{pose_numbers(pose), cable_lengths(model, pose)};
}

Row measure(const std::string& name, Problem problem, Kind kind, std::array<double, 2> low,
            std::array<double, 2> high) {
  constexpr int kSegments = 2000;
  constexpr int kChecks = 200;
  constexpr int kRounds = 15;
  constexpr double kLength = 0.15;  // [rad]
  const Sampler sampler(problem);
  const PoseSampler poses(problem);
  if (kind == Kind::kTolerances) problem.tolerances = all_tolerances();
  if (kind == Kind::kCableLengths) {
    problem.space = coordinate_space();
    problem.query.clear();
  }
  const Prover prover(problem);
  std::mt19937_64 random(1);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::vector<std::pair<Waypoint, Waypoint>> segments;
  std::vector<std::array<double, 2>> samples;
  const auto law = kind == Kind::kCableLengths ? Interpolation::kCableLengths : Interpolation::kStraight;
  const auto prove = [&](const std::pair<Waypoint, Waypoint>& ends) {
    return prover.prove(prover.prepared(Segment::between(law, ends.first, ends.second)));
  };
  while (segments.size() < kSegments) {
    const std::array<double, 2> from{uniform(low[0], high[0]), uniform(low[1], high[1])};
    const double direction = uniform(0, 6.2831853);
    const std::array<double, 2> to{from[0] + kLength * std::cos(direction), from[1] + kLength * std::sin(direction)};
    bool feasible = true;
    for (int k = 0; k <= kChecks && feasible; ++k) {
      const double s = static_cast<double>(k) / kChecks;
      feasible = sampler.margin({from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])}) > 0;
    }
    if (!feasible) continue;
    std::pair<Waypoint, Waypoint> ends{{{from[0], from[1]}, {0, 0}}, {{to[0], to[1]}, {0, 0}}};
    if (kind == Kind::kCableLengths) {
      const Segment straight = Segment::straight(ends.first, ends.second);
      const RigidPose first = poses.rigid_pose(straight, 0);
      RigidPose last = poses.rigid_pose(straight, 1);
      if (first.q.dot(last.q) < 0) last.q.coeffs() = -last.q.coeffs();
      ends = {on_lengths(poses.model(), first), on_lengths(poses.model(), last)};
    }
    if (kind != Kind::kPlain && prove(ends).verdict != Verdict::kProved) continue;
    segments.push_back(std::move(ends));
    samples.push_back(from);
  }
  Row row{name};
  row.total = kSegments;
  std::vector<double> pose_times;
  std::vector<double> segment_times;
  double sink = 0;
  for (int round = 0; round < kRounds; ++round) {
    double start = seconds();
    for (int repeat = 0; repeat < 10; ++repeat) {
      for (const std::array<double, 2>& q : samples) sink += sampler.margin(q);
    }
    pose_times.push_back(1e6 * (seconds() - start) / (10 * kSegments));
    start = seconds();
    long boxes = 0;
    long judged = 0;
    row.proved = 0;
    for (const auto& ends : segments) {
      const SegmentProof proof = prove(ends);
      row.proved += proof.verdict == Verdict::kProved ? 1 : 0;
      boxes += static_cast<long>(proof.boxes.size());
      judged += proof.boxes_judged;
    }
    segment_times.push_back(1e6 * (seconds() - start) / kSegments);
    row.boxes = static_cast<double>(boxes) / kSegments;
    row.judged = static_cast<double>(judged) / kSegments;
  }
  if (sink < 0) fmt::print(stderr, "\n");  // keeps the samples
  row.pose_us = median(pose_times);
  row.segment_us = median(segment_times);
  return row;
}

/// Nanoseconds of one product of a chain that stays bounded.
template <class I>
double product_ns() {
  constexpr int kOperations = 200000;
  I x(1.0);
  const I up = ScalarTraits<I>::from_decimal("1.000001");
  const I down = ScalarTraits<I>::from_decimal("0.999999");
  const double start = seconds();
  for (int k = 0; k < kOperations / 2; ++k) {
    x = x * up;
    x = x * down;
  }
  const double time = seconds() - start;
  return upper_bound(x) > 0 ? 1e9 * time / kOperations : 0;
}

int run(int argc, char** argv) {
  rounding_self_test();
  const auto robot1 = [](const std::string& name, Kind kind) {
    return measure(name, testing::robot1_slice(), kind, {-3.14, 0.0}, {3.14, 2.0});
  };
  const auto robot2 = [](const std::string& name, Kind kind) {
    return measure(name, testing::robot2_sphere(), kind, {-3.14, 0.0}, {3.14, 1.4});
  };
  const std::vector<Row> rows = {
      robot1("robot1-slice", Kind::kPlain),
      robot2("robot2-sphere", Kind::kPlain),
      robot1("robot1-slice, all tolerances", Kind::kTolerances),
      robot2("robot2-sphere, all tolerances", Kind::kTolerances),
      robot1("robot1-slice, cable lengths", Kind::kCableLengths),
      robot2("robot2-sphere, cable lengths", Kind::kCableLengths),
  };
  double ours = 0;
  const bool sound = run_upward([&] { ours = product_ns<Interval>(); });
  const double boost = product_ns<BoostInterval<double>>();

  fmt::print(
      "| segments of 0.15 rad | proved | boxes judged | pose sample, us | proof, us | **proof, in samples** |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  nlohmann::json json = nlohmann::json::array();
  for (const Row& row : rows) {
    fmt::print("| {} | {}/{} | {:.2f} | {:.3f} | {:.2f} | **{:.1f}** |\n", row.name, row.proved, row.total, row.judged,
               row.pose_us, row.segment_us, row.segment_us / row.pose_us);
    json.push_back({{"name", row.name},
                    {"proved", row.proved},
                    {"total", row.total},
                    {"boxes", row.boxes},
                    {"judged", row.judged},
                    {"pose_us", row.pose_us},
                    {"segment_us", row.segment_us},
                    {"samples", row.segment_us / row.pose_us}});
  }
  fmt::print(
      "\nOne interval product in a dependent chain: Interval {:.1f} ns{}, Boost.Interval directed by MPFR {:.0f} ns "
      "({:.0f}x).\n",
      ours, sound ? "" : " (fault)", boost, boost / ours);
  if (argc > 1) std::ofstream(argv[1]) << json.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) { return taut::run(argc, argv); }
