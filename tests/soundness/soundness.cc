// The soundness campaign: random robots and segments, half of them with a hidden violation, against a 200-bit oracle.
//
// Segments are straight or of a spline, and in some spaces the motion is only implied by constraints: then the oracle finds it
// by Newton's method at 200 bits, with gradients of its own.
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
#include "kinematics/constraint_functions.h"
#include "kinematics/motion_length.h"
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

using Vector = std::vector<BigFloat>;

/// Constraints and their gradients, written a second time.
struct OracleConstraints {
  std::function<Vector(const Vector&)> values;
  std::function<std::vector<Vector>(const Vector&)> gradients;
};

/// A problem, a segment of it, and its pose at s by a route of its own.
struct Trial {
  Problem problem;
  std::array<Waypoint, 4> controls;
  Interpolation law = Interpolation::kStraight;
  std::optional<OracleConstraints> constraints;
  std::function<oracle::Big6(const Vector&)> pose;

  [[nodiscard]] Segment segment(const Prover& prover) const {
    Segment segment = curve();
    if (constraints) segment.tube = prover.suitable_tube(segment);
    return segment;
  }
  [[nodiscard]] Segment curve() const { return {law, {&controls[0], &controls[1], &controls[2], &controls[3]}, 0}; }
};

oracle::Big6 slice_pose(const Vector& q) {
  return {BigFloat(0.0), BigFloat(0.0), oracle::big("0.35"),
          q[0],          q[1],          BigFloat(34.0) * oracle::pi() / BigFloat(180.0)};
}

oracle::Big6 sphere_pose(const Vector& q) {
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

/// Robot 2 with its z axis through a fixed point, given by three constraints on five parameters (the paper's (16), implicitly).
Problem implicit_sphere() {
  Problem problem = testing::robot2_sphere();
  problem.space = SpaceText{};
  for (const char* name : {"px", "py", "pz", "phi", "theta"}) {
    const bool periodic = std::string(name) == "phi";
    problem.space.parameters.push_back({name, periodic ? ParameterKind::kPeriodic : ParameterKind::kReal, "", ""});
  }
  problem.space.pose = {"px", "py", "pz", "phi", "theta", "0"};
  problem.space.constraints = {"px + 0.13*sin(theta)*cos(phi)", "py + 0.13*sin(theta)*sin(phi)",
                               "pz - 0.306 + 0.13*cos(theta)"};
  return problem;
}

OracleConstraints implicit_sphere_oracle() {
  const auto r = [] { return oracle::big("0.13"); };
  return {[r](const Vector& q) {
            const BigFloat ring = r() * oracle::sine(q[4]);
            return Vector{q[0] + ring * oracle::cosine(q[3]), q[1] + ring * oracle::sine(q[3]),
                          q[2] - oracle::big("0.306") + r() * oracle::cosine(q[4])};
          },
          [r](const Vector& q) {
            const BigFloat zero(0.0);
            const BigFloat one(1.0);
            const BigFloat c = oracle::cosine(q[3]);
            const BigFloat s = oracle::sine(q[3]);
            const BigFloat ring = r() * oracle::sine(q[4]);
            const BigFloat rise = r() * oracle::cosine(q[4]);
            return std::vector<Vector>{{one, zero, zero, -ring * s, rise * c},
                                       {zero, one, zero, ring * c, rise * s},
                                       {zero, zero, one, zero, -ring}};
          }};
}

/// p on a sphere about the origin through the first waypoint (up to six digits); orientation free.
void put_on_sphere(Trial& trial) {
  const std::vector<double>& x = trial.controls[0].x;
  const DecimalText square = decimal(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
  trial.problem.space.constraints = {"px^2 + py^2 + pz^2 - " + square};
  trial.constraints = OracleConstraints{
      [square](const Vector& q) { return Vector{q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - oracle::big(square)}; },
      [](const Vector& q) {
        const BigFloat two(2.0);
        const BigFloat zero(0.0);
        return std::vector<Vector>{{two * q[0], two * q[1], two * q[2], zero, zero, zero}};
      }};
}

/// Next to the constraints, as a planner would put it, but not on them; with normals.
void bring_near(const ConstraintFunctions& functions, Waypoint& waypoint, Random& random) {
  waypoint.normals = functions.normals(waypoint);
  const double distance = std::pow(10.0, uniform(random, -12, -2));
  const std::vector<double> on = functions.parameters(Segment::straight(waypoint, waypoint), 0);
  for (std::size_t j = 0; j < on.size(); ++j) waypoint.x[j] = on[j] + distance * (waypoint.x[j] - on[j]);
  waypoint.normals = functions.normals(waypoint);
}

/// Control points 1, 2, 3 by random steps from point 0, in proportion to `scale`.
void walk(Trial& trial, Random& random, double step, const std::vector<double>& scale) {
  trial.controls[0].half_turns.assign(trial.controls[0].x.size(), 0);
  trial.law = random() % 3 == 0 ? Interpolation::kCubicBSpline : Interpolation::kStraight;
  for (std::size_t k = 1; k < 4; ++k) {
    trial.controls[k] = trial.controls[k - 1];
    if (random() % 16 == 0) continue;  // control points may be equal
    for (std::size_t j = 0; j < scale.size(); ++j) trial.controls[k].x[j] += step * scale[j] * uniform(random, -1, 1);
  }
}

Trial make_trial(Random& random) {
  static const Problem slice = testing::robot1_slice();
  static const Problem sphere = testing::robot2_sphere();
  static const Problem on_sphere = implicit_sphere();
  constexpr double kStep = 0.15;
  Trial trial;
  std::vector<double>& from = trial.controls[0].x;
  switch (random() % 6) {
    case 0:
      trial.problem = slice;
      from = {uniform(random, -3.2, 3.2), uniform(random, -0.2, 2.0)};
      walk(trial, random, kStep, {1, 1});
      trial.pose = slice_pose;
      break;
    case 1:
      trial.problem = sphere;
      from = {uniform(random, -3.2, 3.2), uniform(random, -0.5, 1.1)};  // a spline's points stay below pi/2
      walk(trial, random, kStep, {1, 1});
      trial.pose = sphere_pose;
      break;
    case 2: {
      trial.problem = on_sphere;
      const double phi = uniform(random, -3.2, 3.2);
      const double theta = uniform(random, 0.1, 2.0);
      from = {-0.13 * std::sin(theta) * std::cos(phi), -0.13 * std::sin(theta) * std::sin(phi),
              0.306 - 0.13 * std::cos(theta), phi, theta};
      walk(trial, random, kStep, {0.01, 0.01, 0.01, 1, 1});
      trial.constraints = implicit_sphere_oracle();
      trial.pose = [](const Vector& q) { return oracle::Big6{q[0], q[1], q[2], q[3], q[4], BigFloat(0.0)}; };
      break;
    }
    default: {
      double size = 1;
      trial.problem = random_robot(random, size);
      for (int k = 0; k < 2; ++k) from.push_back(size * uniform(random, -0.4, 0.4));
      from.push_back(size * uniform(random, 0.7, 2.0));
      from.push_back(uniform(random, -3.2, 3.2));
      from.push_back(uniform(random, 0.0, 0.6));
      from.push_back(uniform(random, -0.5, 0.5));
      walk(trial, random, kStep, {size, size, size, 1, 1, 1});
      trial.pose = [](const Vector& q) { return oracle::Big6{q[0], q[1], q[2], q[3], q[4], q[5]}; };
      if (random() % 3 == 0) put_on_sphere(trial);
    }
  }
  if (trial.constraints) {
    const ConstraintFunctions functions(trial.problem);
    for (Waypoint& waypoint : trial.controls) bring_near(functions, waypoint, random);
  }
  return trial;
}

/// The segment's mix at s of what `value` reads from the control points.
template <class F>
BigFloat mix(const Trial& trial, const BigFloat& t, F value) {
  const BigFloat u = BigFloat(1.0) - t;
  if (trial.law == Interpolation::kStraight) return u * value(trial.controls[0]) + t * value(trial.controls[1]);
  const BigFloat three(3.0);
  const BigFloat four(4.0);
  const BigFloat six(6.0);
  const BigFloat t2 = t * t;
  const BigFloat t3 = t2 * t;
  return (u * u * u * value(trial.controls[0]) + (three * t3 - six * t2 + four) * value(trial.controls[1]) +
          (three * t2 - three * t3 + three * t + BigFloat(1.0)) * value(trial.controls[2]) +
          t3 * value(trial.controls[3])) /
         six;
}

/// Gauss elimination of a small system.
Vector solve(std::vector<Vector> a, Vector b) {
  const std::size_t n = b.size();
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < n; ++i) {
      if (abs(a[i][c]) > abs(a[pivot][c])) pivot = i;
    }
    std::swap(a[c], a[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == c) continue;
      const BigFloat factor = a[i][c] / a[c][c];
      for (std::size_t j = c; j < n; ++j) a[i][j] -= factor * a[c][j];
      b[i] -= factor * b[c];
    }
  }
  for (std::size_t i = 0; i < n; ++i) b[i] /= a[i][i];
  return b;
}

Vector parameters_at(const Trial& trial, const BigFloat& s) {
  Vector q;
  const std::size_t m = trial.controls[0].x.size();
  for (std::size_t j = 0; j < m; ++j) q.push_back(mix(trial, s, [&](const Waypoint& w) { return BigFloat(w.x[j]); }));
  if (!trial.constraints) return q;
  const std::size_t k = trial.problem.space.constraints.size();
  std::vector<Vector> normals(m);
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t i = 0; i < k; ++i) {
      normals[j].push_back(mix(trial, s, [&](const Waypoint& w) { return BigFloat(w.normals[j * k + i]); }));
    }
  }
  constexpr int kNewtonSteps = 9;  // doubling some 3 digits
  for (int step = 0; step < kNewtonSteps; ++step) {
    const std::vector<Vector> gradients = trial.constraints->gradients(q);
    std::vector<Vector> g_y(k, Vector(k));
    for (std::size_t i = 0; i < k; ++i) {
      for (std::size_t l = 0; l < k; ++l) {
        for (std::size_t j = 0; j < m; ++j) g_y[i][l] += gradients[i][j] * normals[j][l];
      }
    }
    const Vector y = solve(g_y, trial.constraints->values(q));
    for (std::size_t j = 0; j < m; ++j) {
      for (std::size_t i = 0; i < k; ++i) q[j] -= normals[j][i] * y[i];
    }
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
  std::optional<ConstraintFunctions> constraints;
  if (trial.constraints) constraints.emplace(trial.problem);
  const auto evaluate = [&](double s) {
    const std::vector<double> q =
        constraints ? constraints->parameters(trial.curve(), s) : curve_parameters(trial.curve(), s);
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
  const SegmentProof proof = prover.prove(trial.segment(prover));
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
      const auto at = oracle::statics(
          trial.problem, trial.pose(parameters_at(trial, enclose<MpInterval>(proof.witness->box.mid()).lower())));
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
