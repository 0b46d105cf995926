// The soundness campaign: random robots and segments, half of them with a hidden violation, against a 200-bit oracle.
//
// For each trial one quantity (f0 − v, f0 + v or d of one cable) is followed along a segment to its extremum s*, and its limit is
// set, as an exact decimal of 45 digits, a distance δ from the oracle's value there: inside the path's range by δ (a violation
// as narrow as √δ, which no sampling sees), or outside it by δ. Then:
//   - a violated segment must never be "proved";
//   - a "refuted" must stand up to the oracle at its witness;
//   - "proved" must agree with the oracle at s* and at random points.
// Any breach is printed with its seed and the program exits 1. δ runs over the decades from 1e-13 to 1e-1 of the range.
//
// Usage: soundness [COUNT [SEED]]
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <random>

#include "certify/segment_proof.h"
#include "kinematics/statics.h"
#include "tests/oracle/oracle_at_origin.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

DecimalText decimal(const BigFloat& x) {
  char* text = nullptr;
  mpfr_asprintf(&text, "%.45Re", x.get());
  DecimalText result = text;
  mpfr_free_str(text);
  return result;
}
DecimalText decimal(double x) { return fmt::format("{:.6e}", x); }

/// A problem, a segment of it, and its pose at s by a route of its own.
struct Trial {
  Problem problem;
  Waypoint a, b;
  std::function<oracle::Big6(const std::vector<BigFloat>&)> pose;
};

oracle::Big6 slice_pose(const std::vector<BigFloat>& q) {
  return {BigFloat(0.0), BigFloat(0.0), oracle::big("0.35"),
          q[0],          q[1],          BigFloat(34.0) * oracle::pi() / BigFloat(180.0)};
}

oracle::Big6 sphere_pose(const std::vector<BigFloat>& q) {
  const BigFloat rs = oracle::big("0.13");
  const BigFloat ring = rs * oracle::cosine(q[1]);
  return {
      ring * oracle::cosine(q[0]), ring * oracle::sine(q[0]),           oracle::big("0.306") - rs * oracle::sine(q[1]),
      q[0] - oracle::pi(),         oracle::pi() / BigFloat(2.0) - q[1], BigFloat(0.0)};
}

Problem random_robot(Random& random, double& size) {
  Problem problem = testing::free_flying(testing::robot1_slice());
  size = std::pow(10.0, uniform(random, -2, 3));
  const double force = std::pow(10.0, uniform(random, -2, 6));
  const bool flat = random() % 8 == 0;  // nearly flat or nearly singular robots
  const double spread = flat ? 1e-3 : 0.3;
  for (std::size_t i = 0; i < kCables; ++i) {
    const double base_angle = 2.094395 * std::floor(static_cast<double>(i) / 2) + uniform(random, -spread, spread);
    const double platform_angle =
        1.047197 + 2.094395 * std::floor((static_cast<double>(i) + 1) / 2) + uniform(random, -spread, spread);
    const double base_radius = size * uniform(random, 0.8, 1.2);
    const double platform_radius = size * uniform(random, 0.3, 0.7);
    const auto anchor = [&](double radius, double angle) {
      return std::array<DecimalText, 3>{decimal(radius * std::cos(angle)), decimal(radius * std::sin(angle)),
                                        decimal(size * uniform(random, -spread, spread))};
    };
    problem.robot.base_anchors_m[i] = anchor(base_radius, base_angle);
    problem.robot.platform_anchors_m[i] = anchor(platform_radius, platform_angle);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    problem.load.point_m[k] = decimal(size * uniform(random, -0.2, 0.2));
    problem.load.wrench[k] = decimal(force * (k == 2 ? 1.0 : uniform(random, -0.1, 0.1)));
    problem.load.wrench[3 + k] = decimal(force * size * uniform(random, -0.02, 0.02));
  }
  // E = G G^T + diagonal, in units of the load: semi-axes about a hundredth of it.
  std::array<std::array<double, 6>, 6> g{};
  for (auto& row : g) {
    for (double& x : row) x = uniform(random, -0.3, 0.3);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = i == j ? 1.0 : 0.0;
      for (std::size_t k = 0; k < 6; ++k) sum += g[i][k] * g[j][k];
      const double unit = (i < 3 ? force : force * size) * (j < 3 ? force : force * size);
      problem.load.ellipsoid[i][j] = problem.load.ellipsoid[j][i] = decimal(1e4 * sum / unit);
    }
  }
  return problem;
}

Trial make_trial(Random& random) {
  static const Problem slice = testing::robot1_slice();
  static const Problem sphere = testing::robot2_sphere();
  const auto straight = [&](std::vector<double> from, double step) {
    std::vector<double> to = from;
    for (double& x : to) x += step * uniform(random, -1, 1);
    const std::vector<int> none(from.size(), 0);
    return std::pair{Waypoint{std::move(from), none}, Waypoint{std::move(to), none}};
  };
  Trial trial;
  switch (random() % 4) {
    case 0: {
      trial.problem = slice;
      std::tie(trial.a, trial.b) = straight({uniform(random, -3.2, 3.2), uniform(random, -0.2, 2.0)}, 0.15);
      trial.pose = slice_pose;
      break;
    }
    case 1: {
      trial.problem = sphere;
      std::tie(trial.a, trial.b) = straight({uniform(random, -3.2, 3.2), uniform(random, -0.5, 1.4)}, 0.15);
      trial.pose = sphere_pose;
      break;
    }
    default: {
      double size = 1;
      trial.problem = random_robot(random, size);
      std::vector<double> from;
      for (int k = 0; k < 2; ++k) from.push_back(size * uniform(random, -0.4, 0.4));
      from.push_back(size * uniform(random, 0.7, 2.0));
      from.push_back(uniform(random, -3.2, 3.2));
      from.push_back(uniform(random, 0.0, 0.6));
      from.push_back(uniform(random, -0.5, 0.5));
      std::tie(trial.a, trial.b) = straight(from, 0.15);
      for (std::size_t k = 0; k < 3; ++k) trial.b.x[k] = from[k] + size * (trial.b.x[k] - from[k]);
      trial.pose = [](const std::vector<BigFloat>& q) { return oracle::Big6{q[0], q[1], q[2], q[3], q[4], q[5]}; };
    }
  }
  return trial;
}

std::vector<BigFloat> parameters_at(const Trial& trial, double s) {
  std::vector<BigFloat> q;
  for (std::size_t j = 0; j < trial.a.x.size(); ++j) {
    const BigFloat start(trial.a.x[j]);
    q.push_back(start + BigFloat(s) * (BigFloat(trial.b.x[j]) - start));
  }
  return q;
}

BigFloat quantity(const oracle::OracleStatics& statics, MarginId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case MarginKind::kTensionMin: return statics.tension[i] - statics.variation[i];
    case MarginKind::kTensionMax: return statics.tension[i] + statics.variation[i];
    case MarginKind::kLengthMin:
    case MarginKind::kLengthMax: break;
  }
  return statics.length[i];
}

double quantity(const Statics<double>& statics, MarginId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case MarginKind::kTensionMin: return statics.tension[i] - statics.variation[i];
    case MarginKind::kTensionMax: return statics.tension[i] + statics.variation[i];
    case MarginKind::kLengthMin:
    case MarginKind::kLengthMax: break;
  }
  return statics.length[i];
}

bool is_upper(MarginKind kind) { return kind == MarginKind::kTensionMax || kind == MarginKind::kLengthMax; }

DecimalText& limit(Problem& problem, MarginId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case MarginKind::kTensionMin: return problem.robot.tension_N[i].lower;
    case MarginKind::kTensionMax: return problem.robot.tension_N[i].upper;
    case MarginKind::kLengthMin: return problem.robot.length_m[i].lower;
    case MarginKind::kLengthMax: break;
  }
  return problem.robot.length_m[i].upper;
}

/// Whether every margin is positive, by the oracle.
bool oracle_feasible(Problem problem, const oracle::OracleStatics& statics) {
  for (int cable = 0; cable < kCables; ++cable) {
    for (const MarginKind kind :
         {MarginKind::kTensionMin, MarginKind::kTensionMax, MarginKind::kLengthMin, MarginKind::kLengthMax}) {
      const BigFloat bound = oracle::big(limit(problem, {kind, cable}));
      const BigFloat value = quantity(statics, {kind, cable});
      if (is_upper(kind) ? !(value < bound) : !(value > bound)) return false;
    }
  }
  return true;
}

constexpr int kDecades = 13;  // δ/range in [1e-13, 1e-1]

struct Tally {
  std::array<std::atomic<long>, kDecades> violated{}, violated_refuted{}, clear{}, clear_decided{};
  std::atomic<long> proved{0}, refuted{0}, undecided{0}, wrong{0}, skipped{0}, boxes{0}, multiprecision{0};
};

void run_trial(std::uint64_t seed, Tally& tally) {
  Random random(seed);
  const PrecisionScope precision(oracle::kBits);
  Trial trial = make_trial(random);

  // Follow one quantity to its extremum in floating point.
  const MarginId id{static_cast<MarginKind>(random() % 4), static_cast<int>(random() % 6)};
  const Model<double> model = make_model<double>(trial.problem);
  const Evaluator<double> pose_of(pose_tape(trial.problem));
  const auto evaluate = [&](double s) {
    std::vector<double> q;
    for (std::size_t j = 0; j < trial.a.x.size(); ++j) {
      q.push_back(trial.a.x[j] + s * (trial.b.x[j] - trial.a.x[j]));
    }
    return statics(model, evaluate_pose(pose_of, std::span<const double>(q)));
  };
  const double sign = is_upper(id.kind) ? -1.0 : 1.0;
  constexpr int kSamples = 48;
  std::array<double, 2> tension_range{HUGE_VAL, -HUGE_VAL};
  std::array<double, 2> length_range{HUGE_VAL, -HUGE_VAL};
  double best_s = 0;
  double best = HUGE_VAL;
  double determinant_sign_seen = 0;
  bool singular = false;
  for (int k = 0; k <= kSamples; ++k) {
    const double s = static_cast<double>(k) / kSamples;
    const Statics<double> at = evaluate(s);
    if (!at.regular || !std::isfinite(at.determinant)) {
      singular = true;
      break;
    }
    if (determinant_sign_seen * at.determinant < 0) singular = true;
    determinant_sign_seen = at.determinant > 0 ? 1 : -1;
    for (std::size_t i = 0; i < kCables; ++i) {
      tension_range[0] = std::min(tension_range[0], at.tension[i] - at.variation[i]);
      tension_range[1] = std::max(tension_range[1], at.tension[i] + at.variation[i]);
      length_range[0] = std::min(length_range[0], at.length[i]);
      length_range[1] = std::max(length_range[1], at.length[i]);
    }
    const double value = sign * quantity(at, id);
    if (value < best) {
      best = value;
      best_s = s;
    }
  }
  const double tension_width = tension_range[1] - tension_range[0];
  if (singular || !std::isfinite(tension_width) || !(tension_width > 0)) {
    ++tally.skipped;
    return;
  }
  double low = std::max(0.0, best_s - 1.0 / kSamples);
  double high = std::min(1.0, best_s + 1.0 / kSamples);
  for (int k = 0; k < 40; ++k) {
    const double s1 = low + 0.381966 * (high - low);
    const double s2 = low + 0.618034 * (high - low);
    if (sign * quantity(evaluate(s1), id) < sign * quantity(evaluate(s2), id)) {
      high = s2;
    } else {
      low = s1;
    }
  }
  const double middle = 0.5 * (low + high);
  if (sign * quantity(evaluate(middle), id) < best) best_s = middle;

  // All limits loose, then this one δ inside or outside the oracle's value at s*.
  const double length_width = length_range[1] - length_range[0];
  const double range = id.kind == MarginKind::kTensionMin || id.kind == MarginKind::kTensionMax
                           ? tension_width
                           : std::max(length_width, 0.01 * length_range[1]);
  for (std::size_t i = 0; i < kCables; ++i) {
    trial.problem.robot.tension_N[i] = {decimal(tension_range[0] - tension_width),
                                        decimal(tension_range[1] + tension_width)};
    trial.problem.robot.length_m[i] = {decimal(0.5 * length_range[0]), decimal(2 * length_range[1])};
  }
  const int decade = static_cast<int>(random() % kDecades);
  const double delta = range * std::pow(10.0, uniform(random, -kDecades + decade, -kDecades + decade + 1));
  const bool violated = random() % 2 == 0;
  const oracle::OracleStatics at_extremum = oracle::statics(trial.problem, trial.pose(parameters_at(trial, best_s)));
  // Violated: a lower limit moves up, an upper one down. Clear: the other way.
  const BigFloat shift(violated == is_upper(id.kind) ? -delta : delta);
  limit(trial.problem, id) = decimal(quantity(at_extremum, id) + shift);

  const Prover prover(trial.problem);
  const SegmentProof proof = prover.prove(trial.a, trial.b);
  tally.boxes += proof.boxes_judged;
  tally.multiprecision += proof.boxes_multiprecision;
  const auto breach = [&](const char* what) {
    ++tally.wrong;
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    fmt::print(stderr, "WRONG: {} (seed {}, {} of cable {}, delta {:.3e}, s* {:.17g})\n", what, seed, name(id.kind),
               id.cable + 1, delta, best_s);
  };
  const bool feasible_at_extremum = oracle_feasible(trial.problem, at_extremum);
  if (violated == feasible_at_extremum) breach("the trial does not violate what it should, or does");
  const auto d = static_cast<std::size_t>(decade);
  ++(violated ? tally.violated : tally.clear)[d];
  switch (proof.verdict) {
    case Verdict::kProved:
      ++tally.proved;
      if (!feasible_at_extremum) breach("proved, but violated at s*");
      for (int k = 0; k < 2; ++k) {
        const auto at = oracle::statics(trial.problem, trial.pose(parameters_at(trial, uniform(random, 0, 1))));
        if (!oracle_feasible(trial.problem, at)) breach("proved, but violated at a random point");
      }
      if (!violated) ++tally.clear_decided[d];
      break;
    case Verdict::kRefuted: {
      ++tally.refuted;
      if (proof.witness->singular) break;
      const auto at = oracle::statics(trial.problem, trial.pose(parameters_at(trial, proof.witness->box.mid())));
      const BigFloat value = quantity(at, proof.witness->margin);
      const BigFloat bound = oracle::big(limit(trial.problem, proof.witness->margin));
      if (is_upper(proof.witness->margin.kind) ? value < bound : value > bound) breach("refuted by a false witness");
      ++(violated ? tally.violated_refuted : tally.clear_decided)[d];
      break;
    }
    case Verdict::kUndecided: ++tally.undecided; break;
  }
}

int run(long count, std::uint64_t seed) {
  rounding_self_test();
  Tally tally;
  const auto start = std::chrono::steady_clock::now();
  tbb::parallel_for(0L, count, [&](long k) { run_trial(seed + static_cast<std::uint64_t>(k), tally); });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const auto total = [](const auto& counts, int from) {
    long sum = 0;
    for (int k = from; k < kDecades; ++k) sum += counts[static_cast<std::size_t>(k)];
    return sum;
  };
  fmt::print(
      "{} segments, seed {}: {} proved, {} refuted, {} undecided, {} skipped (singular on the samples); {} WRONG.\n",
      count, seed, tally.proved.load(), tally.refuted.load(), tally.undecided.load(), tally.skipped.load(),
      tally.wrong.load());
  fmt::print("{} boxes judged, {} in multiprecision, {:.1f} s.\n", tally.boxes.load(), tally.multiprecision.load(),
             seconds);
  fmt::print("delta/range      violated  refuted      clear  decided\n");
  for (int k = 0; k < kDecades; ++k) {
    const auto d = static_cast<std::size_t>(k);
    fmt::print("1e{:<3} to 1e{:<3}  {:8d} {:8d}   {:8d} {:8d}\n", k - kDecades, k - kDecades + 1,
               tally.violated[d].load(), tally.violated_refuted[d].load(), tally.clear[d].load(),
               tally.clear_decided[d].load());
  }
  constexpr int kFromMillionth = kDecades - 6;
  const double share = static_cast<double>(total(tally.clear_decided, kFromMillionth)) /
                       static_cast<double>(std::max(1L, total(tally.clear, kFromMillionth)));
  fmt::print("decided with margin > 1e-6 of the range: {:.4f} %\n", 100 * share);
  constexpr double kLeastShare = 0.999;
  return tally.wrong == 0 && share >= kLeastShare ? 0 : 1;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 2000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 20261121;
  return taut::run(count, seed);
}
