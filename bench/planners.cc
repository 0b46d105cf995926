// SPDX-License-Identifier: GPL-3.0-or-later
// taut beside OMPL on the paper's queries: time to a proved path against time to an unproved one, and both lengths.
//
// Every query is planned by taut (greedy and A*, each with the path as found and the path pulled taut, each by the
// case's own cost and by distance in the parameters), and by OMPL's RRTConnect and BIT*, whose validity check samples
// every motion at 0.1 % of the extent of the space and proves nothing. All evaluate poses in double with the same
// compiled equations. Rounds are interleaved: one run of each planner, then the next of each, so that whatever else the
// machine does hits all alike. bench/README.md says what is measured and what was chosen.
//
// Usage: planners RESULTS_DIR [--quick]; writes table.md and table.json there.
#include <fmt/format.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/samplers/informed/RejectionInfSampler.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <thread>

#include "bench/parameter_space.h"
#include "kinematics/geometry.h"
#include "kinematics/statics.h"
#include "planner/planner.h"

namespace taut {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Clock = std::chrono::steady_clock;
using Point = std::vector<double>;

constexpr double kPi = std::numbers::pi;
/// Steps of a motion that are checked, in units of the space's extent.
constexpr double kResolution = 0.001;
constexpr double kBitStarSeconds = 1.0;  // of the processor, so that a busy machine takes nothing from it
/// A* over six parameters is an anytime search; as found, it would take seconds to its end.
constexpr double kBudgetSeconds = 0.15;

struct Rounds {
  int taut = 21;
  int rrt = 21;
  int bit_star = 5;
};

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Wall clock and processor time (of all threads) since it was made [s].
class Stopwatch {
 public:
  [[nodiscard]] double wall() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  [[nodiscard]] double cpu() const { return process_seconds() - cpu_start_; }

 private:
  static double process_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  Clock::time_point start_ = Clock::now();
  double cpu_start_ = process_seconds();
};

// ---- Poses and lengths
// -------------------------------------------------------------------------------------------------

/// Poses of a problem in double: feasibility of one, and length of a path by either metric.
class Poses {
 public:
  explicit Poses(const Problem& problem) : model_(make_model<double>(problem)), pose_(pose_tape(problem)) {}

  /// Whether tensions over the whole wrench set and lengths are strictly within their limits.
  [[nodiscard]] bool feasible(std::span<const double> q) const {
    const Statics<double> at = statics(model_, evaluate_pose(pose_, q));
    if (!at.regular) return false;
    for (std::size_t i = 0; i < kCables; ++i) {
      const double low = at.tension[i] - at.tension_below[i];
      const double high = at.tension[i] + at.tension_above[i];
      if (!(model_.tension_lower[i] < low && high < model_.tension_upper[i] && model_.length_lower[i] < at.length[i] &&
            at.length[i] < model_.length_upper[i])) {
        return false;
      }
    }
    return true;
  }

  /// Angle turned [rad], distance covered by the origin [m], or distance in the parameters [rad, m] between two poses.
  [[nodiscard]] double distance(Cost cost, const Point& a, const Point& b) const {
    if (cost == Cost::kParameters) {
      double square = 0;
      for (std::size_t j = 0; j < a.size(); ++j) square += (b[j] - a[j]) * (b[j] - a[j]);
      return std::sqrt(square);
    }
    const Pose<double> from = evaluate_pose(pose_, std::span<const double>(a));
    const Pose<double> to = evaluate_pose(pose_, std::span<const double>(b));
    if (cost == Cost::kGreatCircle) return (to.p_WP - from.p_WP).norm();
    const double chord = (rotation(model_.angles, from.angles) - rotation(model_.angles, to.angles)).norm();
    return 2.0 * std::asin(std::min(1.0, chord / (2.0 * std::numbers::sqrt2)));
  }

  /// Length of a polyline of the parameters. Its segments curve in space, so each is summed up in pieces.
  [[nodiscard]] double length(Cost cost, const std::vector<Point>& path, int pieces = 500) const {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      Point from = path[k];
      for (int piece = 1; piece <= pieces; ++piece) {
        const double s = static_cast<double>(piece) / pieces;
        Point to = path[k];
        for (std::size_t j = 0; j < to.size(); ++j) to[j] += s * (path[k + 1][j] - path[k][j]);
        sum += distance(cost, from, to);
        from = std::move(to);
      }
    }
    return sum;
  }

 private:
  Model<double> model_;
  Evaluator<double> pose_;
};

// ---- Queries
// -----------------------------------------------------------------------------------------------------------

struct Query {
  std::string robot, name;
  Case case_;
};

/// The leg from waypoint `leg` of a case to the next.
Query leg_of(const std::string& robot, const std::string& name, const std::string& file, std::size_t leg = 0) {
  Query query{robot, name, load_case(std::string(TAUT_SOURCE_DIR "/cases/") + file + ".yaml")};
  auto& waypoints = query.case_.problem.query;
  waypoints = {waypoints.at(leg), waypoints.at(leg + 1)};
  return query;
}

std::vector<Query> all_queries() {
  return {leg_of("1", "q_s→q_g", "robot1-slice-qs-qg"),
          leg_of("1", "q_s′→q_g", "robot1-slice-qs1-qg"),
          leg_of("1", "q_s″→q_g", "robot1-slice-qs2-qg"),
          leg_of("2", "q1→q2", "robot2-sphere-q1-q2-q3", 0),
          leg_of("2", "q2→q3", "robot2-sphere-q1-q2-q3", 1),
          leg_of("2", "q2→q3, σ free", "robot2-sphere-sigma-free-q2-q3"),
          leg_of("2", "q2→q3, free-flying", "robot2-free-q2-q3")};
}

// ---- What a run yields
// -------------------------------------------------------------------------------------------------

struct Measurements {
  std::vector<double> wall, cpu;              ///< of the runs that found a path [s]
  std::vector<double> evaluations;            ///< of poses; OMPL only
  std::vector<double> cost, parameters;       ///< lengths of the path, by the case's cost and in the parameters
  std::vector<double> search, prove, smooth;  ///< parts of `wall`, by taut's own account [s]
  int runs = 0;
  std::string note;

  [[nodiscard]] bool found() const { return !wall.empty(); }
};

void add_lengths(Measurements& into, const Poses& poses, Cost cost, const std::vector<Point>& path) {
  into.cost.push_back(poses.length(cost, path));
  into.parameters.push_back(poses.length(Cost::kParameters, path));
}

// ---- taut
// --------------------------------------------------------------------------------------------------------------

struct Variant {
  std::string name;
  Strategy strategy;
  Smoothing smoothing;
  bool by_parameters;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {"greedy, as found", Strategy::kGreedyBestFirst, Smoothing::kNone, false},
      {"greedy, taut", Strategy::kGreedyBestFirst, Smoothing::kShorten, false},
      {"A*, as found", Strategy::kAStar, Smoothing::kNone, false},
      {"A*, taut", Strategy::kAStar, Smoothing::kShorten, false},
      {"greedy, taut, by parameters", Strategy::kGreedyBestFirst, Smoothing::kShorten, true},
      {"A*, taut, by parameters", Strategy::kAStar, Smoothing::kShorten, true},
  };
  return all;
}

// Indices into variants().
enum : std::size_t { kGreedyAsFound, kGreedyTaut, kAStarAsFound, kAStarTaut, kGreedyByParameters, kAStarByParameters };

/// Whether the variant is run until a budget is spent.
bool is_on_budget(const Query& query, const Variant& variant) {
  return query.case_.problem.space.parameters.size() == 6 && variant.strategy == Strategy::kAStar;
}

void run_taut(const Query& query, const Variant& variant, const Poses& poses, Measurements& into) {
  Case case_ = query.case_;
  case_.planner.strategy = variant.strategy;
  case_.planner.smoothing = variant.smoothing;
  if (variant.by_parameters) case_.planner.cost = Cost::kParameters;
  const bool on_budget = is_on_budget(query, variant);
  if (on_budget) {
    case_.planner.has_budget = true;
    case_.planner.max_seconds = kBudgetSeconds;
  }
  const Stopwatch watch;
  Planner planner(case_);
  const Plan result = planner.plan({}, {});
  const double wall = watch.wall();
  const double cpu = watch.cpu();
  ++into.runs;
  if (result.proof.verdict != Verdict::kProved) {
    into.note = fmt::format("no path: {} charts in {:.0f} s", result.statistics.charts, wall);
    return;
  }
  into.wall.push_back(wall);
  into.cpu.push_back(cpu);
  into.search.push_back(result.statistics.plan_seconds);
  into.prove.push_back(result.statistics.prove_seconds);
  into.smooth.push_back(result.statistics.smooth_seconds);
  if (into.cost.empty() || on_budget) {  // else the planner is deterministic
    std::vector<Point> path;
    for (const Waypoint& waypoint : result.path.waypoints) {
      Point q = waypoint.x;
      for (std::size_t j = 0; j < q.size(); ++j) q[j] += kPi * waypoint.half_turns[j];
      path.push_back(std::move(q));
    }
    add_lengths(into, poses, query.case_.planner.cost, path);
  }
}

// ---- OMPL
// --------------------------------------------------------------------------------------------------------------

/// The length of a motion, bounded from below by the distance of its ends. By a case's cost it is summed up in pieces,
/// since what is straight in the parameters curves in space.
///
/// OMPL's own path length would have BIT* draw its samples from ellipses that know nothing of periodic parameters, so
/// here they are drawn from the whole space and rejected by this bound.
class LengthObjective final : public ob::OptimizationObjective {
 public:
  LengthObjective(const ob::SpaceInformationPtr& information, const Poses& poses, Cost cost)
      : ob::OptimizationObjective(information),
        space_(*information->getStateSpace()->as<ParameterSpace>()),
        poses_(poses),
        cost_(cost) {
    setCostToGoHeuristic([this](const ob::State* state, const ob::Goal* goal) {
      const auto& goals = *goal->as<ob::GoalStates>();
      double least = HUGE_VAL;
      for (unsigned k = 0; k < goals.getStateCount(); ++k) {
        least = std::min(least, motionCostHeuristic(state, goals.getState(k)).value());
      }
      return ob::Cost(least);
    });
  }
  ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
  ob::Cost motionCost(const ob::State* a, const ob::State* b) const override {
    if (cost_ == Cost::kParameters) return motionCostHeuristic(a, b);
    constexpr double kPiece = 0.1;  // [rad]
    const int pieces = 1 + static_cast<int>(space_.distance(a, b) / kPiece);
    return ob::Cost(poses_.length(cost_, {point(a), space_.nearest(point(a), b)}, pieces));
  }
  ob::Cost motionCostHeuristic(const ob::State* a, const ob::State* b) const override {
    return ob::Cost(cost_ == Cost::kParameters ? space_.distance(a, b) : poses_.distance(cost_, point(a), point(b)));
  }
  ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& problem,
                                                   unsigned most_calls) const override {
    return std::make_shared<ob::RejectionInfSampler>(problem, most_calls);
  }

 private:
  [[nodiscard]] Point point(const ob::State* state) const {
    const auto q = space_.point(state);
    return {q.begin(), q.end()};
  }

  const ParameterSpace& space_;
  const Poses& poses_;
  Cost cost_;
};

enum class Tool { kRrtConnect, kBitStar, kBitStarByCost };

/// OMPL's problem of one query: its space, start, and goal in each of its names.
class OmplQuery {
 public:
  OmplQuery(const Query& query, const Poses& poses) : query_(query), poses_(poses) {
    const SpaceText& text = query.case_.problem.space;
    space_ = std::make_shared<ParameterSpace>(text);
    information_ = std::make_shared<ob::SpaceInformation>(space_);
    information_->setStateValidityChecker([this](const ob::State* state) {
      ++evaluations_;
      return poses_.feasible(space_->point(state));
    });
    information_->setStateValidityCheckingResolution(kResolution);
    information_->setup();
    const std::vector<Waypoint> waypoints = query_waypoints(query.case_.problem);
    start_ = waypoints[0].x;
    goals_ = {waypoints[1].x};
    if (text.flip) {
      Point other = goals_[0];
      const auto [phi, theta] = *text.flip;
      other[static_cast<std::size_t>(phi)] += kPi;
      other[static_cast<std::size_t>(theta)] *= -1;
      goals_.push_back(other);
    }
  }

  void run(Tool tool, unsigned seed, Measurements& into) {
    ompl::RNG::setSeed(seed);
    auto problem = std::make_shared<ob::ProblemDefinition>(information_);
    problem->addStartState(state(start_));
    auto goal = std::make_shared<ob::GoalStates>(information_);
    for (const Point& q : goals_) goal->addState(state(q));
    problem->setGoal(goal);
    if (tool != Tool::kRrtConnect) {
      const Cost cost = tool == Tool::kBitStar ? Cost::kParameters : query_.case_.planner.cost;
      problem->setOptimizationObjective(std::make_shared<LengthObjective>(information_, poses_, cost));
    }
    ob::PlannerPtr planner;
    if (tool == Tool::kRrtConnect) {
      planner = std::make_shared<og::RRTConnect>(information_);
    } else {
      planner = std::make_shared<og::BITstar>(information_);
    }
    planner->setProblemDefinition(problem);
    evaluations_ = 0;
    const Stopwatch watch;
    planner->setup();
    // Asked whenever the planner likes; no thread polls it.
    const bool anytime = tool != Tool::kRrtConnect;
    const ob::PlannerTerminationCondition enough(
        [&] { return watch.cpu() > (anytime ? kBitStarSeconds : 10 * kBitStarSeconds); });
    const ob::PlannerStatus status = planner->solve(enough);
    const double wall = watch.wall();
    const double cpu = watch.cpu();
    ++into.runs;
    if (status != ob::PlannerStatus::EXACT_SOLUTION) return;
    into.wall.push_back(wall);
    into.cpu.push_back(cpu);
    into.evaluations.push_back(static_cast<double>(evaluations_));
    add_lengths(into, poses_, query_.case_.planner.cost,
                unrolled(*problem->getSolutionPath()->as<og::PathGeometric>()));
  }

 private:
  [[nodiscard]] ob::ScopedState<> state(const Point& q) const {
    ob::ScopedState<> result(space_);
    const auto& text = query_.case_.problem.space;
    for (std::size_t j = 0; j < q.size(); ++j) {
      result[static_cast<unsigned>(j)] = text.parameters[j].kind == ParameterKind::kPeriodic ? wrap(q[j]) : q[j];
    }
    return result;
  }

  /// The path without jumps by whole turns.
  [[nodiscard]] std::vector<Point> unrolled(const og::PathGeometric& path) const {
    std::vector<Point> result;
    for (std::size_t k = 0; k < path.getStateCount(); ++k) {
      const ob::State* state = path.getState(static_cast<unsigned>(k));
      const auto q = space_->point(state);
      result.push_back(k == 0 ? Point(q.begin(), q.end()) : space_->nearest(result.back(), state));
    }
    return result;
  }

  const Query& query_;
  const Poses& poses_;
  std::shared_ptr<ParameterSpace> space_;
  ob::SpaceInformationPtr information_;
  long evaluations_ = 0;
  Point start_;
  std::vector<Point> goals_;
};

// ---- Rows
// --------------------------------------------------------------------------------------------------------------

struct Row {
  std::string robot, query;
  std::size_t n = 0;
  Cost cost = Cost::kRotation;
  double pose_us = 0;
  std::vector<Measurements> taut = {};  ///< as variants()
  Measurements rrt = {}, bit_star = {}, bit_star_by_cost = {};
};

double pose_microseconds(const Poses& poses, const std::vector<Waypoint>& query) {
  constexpr int kRepeats = 4000;
  std::vector<double> times;
  long feasible = 0;
  for (int round = 0; round < 9; ++round) {
    const Stopwatch watch;
    for (int k = 0; k < kRepeats; ++k) {
      Point q = query[0].x;
      q[0] += 1e-6 * k;
      feasible += poses.feasible(q) ? 1 : 0;
    }
    times.push_back(1e6 * watch.wall() / kRepeats);
  }
  return feasible < 0 ? 0 : median(times);
}

Row measure(const Query& query, const Rounds& rounds) {
  const Poses poses(query.case_.problem);
  Row row{query.robot, query.name};
  row.n = query.case_.problem.space.parameters.size();
  row.cost = query.case_.planner.cost;
  row.taut.resize(variants().size());
  row.pose_us = pose_microseconds(poses, query_waypoints(query.case_.problem));
  OmplQuery ompl_query(query, poses);
  const int most = std::max({rounds.taut, rounds.rrt, rounds.bit_star});
  for (int round = 0; round < most; ++round) {
    fmt::print(stderr, "\r{} {}: round {} of {} ", query.robot, query.name, round + 1, most);
    const auto seed = static_cast<unsigned>(round + 1);
    for (std::size_t v = 0; v < variants().size(); ++v) {
      if (round < rounds.taut) run_taut(query, variants()[v], poses, row.taut[v]);
    }
    if (round < rounds.rrt) ompl_query.run(Tool::kRrtConnect, seed, row.rrt);
    if (round < rounds.bit_star) {
      ompl_query.run(Tool::kBitStar, seed, row.bit_star);
      ompl_query.run(Tool::kBitStarByCost, seed, row.bit_star_by_cost);
    }
  }
  fmt::print(stderr, "\n");
  return row;
}

// ---- Output
// ------------------------------------------------------------------------------------------------------------

std::string milliseconds(const Measurements& m) {
  return m.found() ? fmt::format("{:.2f}", 1e3 * median(m.wall)) : m.note.empty() ? "—" : m.note;
}

/// Where the time of a call went [ms].
std::string parts(const Measurements& m, bool smoothed) {
  if (!m.found()) return "—";
  std::vector<double> rest;
  for (std::size_t k = 0; k < m.wall.size(); ++k) rest.push_back(m.wall[k] - m.search[k] - m.prove[k] - m.smooth[k]);
  return fmt::format("{:.2f} + {}{:.2f} + {:.2f}", 1e3 * median(m.search),
                     smoothed ? fmt::format("{:.2f} + ", 1e3 * median(m.smooth)) : "", 1e3 * median(m.prove),
                     1e3 * median(rest));
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.3f}", value) : "—"; }

std::string ratio(double a, double b) { return std::isfinite(a / b) ? fmt::format("{:.2f}", a / b) : "—"; }

double best(const std::vector<double>& values) {
  return values.empty() ? std::nan("") : *std::ranges::min_element(values);
}

const char* cost_name(Cost cost) {
  return cost == Cost::kRotation ? "rad turned" : cost == Cost::kGreatCircle ? "m on the sphere" : "parameters";
}

std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) {
      model = line.substr(line.find(':') + 2);
      break;
    }
  }
  return fmt::format("{}, {} cores; g++ {}, Release; OMPL {}", model, std::thread::hardware_concurrency(), __VERSION__,
                     TAUT_OMPL_VERSION);
}

std::string markdown(const std::vector<Row>& rows, const Rounds& rounds, double load) {
  std::string out = fmt::format(
      "# taut beside OMPL\n\n{}; load {:.1f} at the start.\n"
      "Medians of {} runs of taut, {} seeds of RRTConnect, and {} seeds of BIT* of {:.0f} s each.\n"
      "Made by `bench/run`; [bench/README.md](../README.md) says what is measured.\n\n",
      machine(), load, rounds.taut, rounds.rrt, rounds.bit_star, kBitStarSeconds);

  out +=
      "## Time, ms\n\n"
      "taut's columns are the whole call: search, every proof, and shortening where the path is pulled taut.\n"
      "RRTConnect's path is not proved. \"Found\" is a path as found. The last two columns divide by RRTConnect's time."
      "\n\n| robot | query | n | RRTConnect | greedy, found | greedy, taut | A*, found | A*, taut |"
      " **greedy, found, ÷** | A*, ÷ |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    const double rrt = median(row.rrt.wall);
    out +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | **{}** | {} |\n", row.robot, row.query, row.n,
                    milliseconds(row.rrt), milliseconds(row.taut[kGreedyAsFound]), milliseconds(row.taut[kGreedyTaut]),
                    milliseconds(row.taut[kAStarAsFound]), milliseconds(row.taut[kAStarTaut]),
                    ratio(median(row.taut[kGreedyAsFound].wall), rrt), ratio(median(row.taut[kAStarTaut].wall), rrt));
  }

  out +=
      "\n## Where the time goes, ms\n\n"
      "Greedy, as found: search + proofs + rest. A*, taut: search + shortening + proofs + rest. The rest is the time "
      "for"
      "\nmaking the models and the query's binary64.\n\n"
      "| robot | query | pose sample, µs | RRTConnect's samples | greedy, as found | A*, taut |\n"
      "|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    out += fmt::format("| {} | {} | {:.2f} | {:.0f} | {} | {} |\n", row.robot, row.query, row.pose_us,
                       median(row.rrt.evaluations), parts(row.taut[kGreedyAsFound], false),
                       parts(row.taut[kAStarTaut], true));
  }

  out +=
      "\nLengths below are sums over small pieces of the path. RRTConnect: median (largest). BIT*: median (how many\n"
      "runs found a path). \"Best\" is the shortest path that any run of BIT* found, whether it minimised the case's\n"
      "cost or the distance in the parameters; the columns with ÷ divide by it. \"Found\" is greedy search as found;\n"
      "greedy and A* are pulled taut. Lengths by cost are in rad turned, or in m on the sphere.\n";

  const auto lengths = [&](const std::string& title, bool by_parameters) {
    const std::size_t greedy = by_parameters ? kGreedyByParameters : kGreedyTaut;
    const std::size_t a_star = by_parameters ? kAStarByParameters : kAStarTaut;
    const auto of = [&](const Measurements& m) -> const std::vector<double>& {
      return by_parameters ? m.parameters : m.cost;
    };
    out += fmt::format(
        "\n## {}\n\n"
        "| robot | query | {}RRTConnect | BIT* | best | found | greedy | A* | A*, ÷ | greedy, ÷ | A*, ms |\n"
        "|---|---|{}---|---|---|---|---|---|---|---|---|\n",
        title, by_parameters ? "" : "unit | ", by_parameters ? "" : "---|");
    for (const Row& row : rows) {
      const Measurements& aimed = by_parameters ? row.bit_star : row.bit_star_by_cost;
      const double shortest = std::fmin(best(of(row.bit_star)), best(of(row.bit_star_by_cost)));
      const auto& rrt = of(row.rrt);
      out += fmt::format("| {} | {} | {}{} ({}) | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.robot, row.query,
                         by_parameters                    ? ""
                         : row.cost == Cost::kGreatCircle ? "m | "
                                                          : "rad | ",
                         number(median(rrt)), number(rrt.empty() ? std::nan("") : *std::ranges::max_element(rrt)),
                         fmt::format("{} ({}/{})", number(median(of(aimed))), aimed.wall.size(), aimed.runs),
                         number(shortest), number(median(of(row.taut[kGreedyAsFound]))),
                         number(median(of(row.taut[greedy]))), number(median(of(row.taut[a_star]))),
                         ratio(median(of(row.taut[a_star])), shortest), ratio(median(of(row.taut[greedy])), shortest),
                         milliseconds(row.taut[a_star]));
    }
  };
  lengths("Length by the case's cost, which taut and BIT* minimise", false);
  lengths("Length in the parameters, rad and m, which taut and BIT* minimise", true);
  return out;
}

nlohmann::json to_json(const Measurements& m) {
  nlohmann::json json = {{"runs", m.runs}, {"found", m.wall.size()}};
  const auto put = [&](const char* name, const std::vector<double>& values) {
    if (!values.empty()) json[name] = {{"median", median(values)}, {"min", best(values)}, {"all", values}};
  };
  put("wall_s", m.wall);
  put("cpu_s", m.cpu);
  put("search_s", m.search);
  put("smooth_s", m.smooth);
  put("prove_s", m.prove);
  put("evaluations", m.evaluations);
  put("length_cost", m.cost);
  put("length_parameters", m.parameters);
  if (!m.note.empty()) json["note"] = m.note;
  return json;
}

nlohmann::json to_json(const std::vector<Row>& rows, const Rounds& rounds, double load) {
  nlohmann::json all = nlohmann::json::array();
  for (const Row& row : rows) {
    nlohmann::json planners = {{"RRTConnect", to_json(row.rrt)},
                               {"BIT*", to_json(row.bit_star)},
                               {"BIT*, by the case's cost", to_json(row.bit_star_by_cost)}};
    for (std::size_t v = 0; v < row.taut.size(); ++v) planners["taut, " + variants()[v].name] = to_json(row.taut[v]);
    all.push_back({{"robot", row.robot},
                   {"query", row.query},
                   {"n", row.n},
                   {"cost", cost_name(row.cost)},
                   {"pose_sample_us", row.pose_us},
                   {"planners", std::move(planners)}});
  }
  return {{"machine", machine()},
          {"load_at_start", load},
          {"resolution", kResolution},
          {"rounds", {{"taut", rounds.taut}, {"RRTConnect", rounds.rrt}, {"BIT*", rounds.bit_star}}},
          {"rows", std::move(all)}};
}

int run(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: planners RESULTS_DIR [--quick]\n");
    return 3;
  }
  rounding_self_test();
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  Rounds rounds;
  if (argc > 2 && std::string(argv[2]) == "--quick") rounds = {3, 3, 1};
  double load[1] = {0};
  if (getloadavg(load, 1) < 1) load[0] = 0;
  std::vector<Row> rows;
  for (const Query& query : all_queries()) rows.push_back(measure(query, rounds));
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const std::string table = markdown(rows, rounds, load[0]);
  std::ofstream(folder / "table.md") << table;
  std::ofstream(folder / "table.json") << to_json(rows, rounds, load[0]).dump(1) << "\n";
  fmt::print("{}", table);
  return 0;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) { return taut::run(argc, argv); }
