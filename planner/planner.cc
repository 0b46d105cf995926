// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "atlas/wrench_feasible_manifold.h"
#include "base/clock.h"
#include "base/plural.h"
#include "base/sha256.h"
#include "certify/undecided.h"
#include "kinematics/geometry.h"
#include "kinematics/motion_length.h"
#include "planner/detours.h"
#include "planner/sampled_motion_validator.h"
#include "planner/shorten.h"
#include "planner/smooth.h"
#include "planner/time_budget.h"

namespace taut {
namespace {

// ---- Waypoints and the planner's coordinates
// --------------------------------------------------------------------------

Coordinates to_coordinates(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<int>(x.size()));
}
Coordinates to_coordinates(const Waypoint& waypoint) { return to_coordinates(waypoint.parameters().x); }

Waypoint to_waypoint(const Coordinates& q, const PoseSampler& sampler) {
  Waypoint waypoint{std::vector<double>(q.data(), q.data() + q.size()),
                    std::vector<int>(static_cast<std::size_t>(q.size()), 0)};
  if (sampler.constraints()) waypoint.parameters().normals = sampler.constraints()->normals(waypoint);
  return waypoint;
}

/// The same pose in the image `image`, exactly. Normals stay, because constraints repeat with a turn and mention no
/// angle of a flip.
Waypoint apply(const Image& image, const std::optional<std::array<int, 2>>& flip, Waypoint waypoint) {
  auto& [x, half_turns, normals] = waypoint.parameters();
  for (std::size_t j = 0; j < x.size(); ++j) {
    const bool negated = image.flipped && flip && static_cast<std::size_t>((*flip)[1]) == j;
    if (negated) x[j] = 0.0 - x[j];
    half_turns[j] += image.half_turns[j];
  }
  return waypoint;
}

/// The composition of two images: first `first`, then `second`.
Image compose(Image first, const Image& second) {
  for (std::size_t j = 0; j < first.half_turns.size(); ++j) first.half_turns[j] += second.half_turns[j];
  first.flipped = first.flipped != second.flipped;
  return first;
}

/// Appends a leg in the image that the path has reached, without its first vertex, which the path has already. Vertices
/// between the query's waypoints may be rounded; the goal is kept exact.
void append_leg(Path& path, const std::vector<Coordinates>& leg, const PathVertex& goal, const Image& reached,
                const std::optional<std::array<int, 2>>& flip, const PoseSampler& sampler) {
  for (std::size_t k = 1; k + 1 < leg.size(); ++k) {
    path.waypoints.push_back(apply(reached, flip, to_waypoint(leg[k], sampler)));
  }
  path.waypoints.push_back(apply(reached, flip, apply(goal.image, flip, to_waypoint(goal.base, sampler))));
}

/// Moves coordinates onto the constraints; returns false if that fails.
bool project(const PoseSampler& sampler, Coordinates& q) {
  const auto reached = sampler.constraints()->nearest(q);
  if (reached) q = *reached;
  return reached.has_value();
}

/// Gives each segment, or the only waypoint, the tube that it needs.
void set_tubes(Path& path, const Prover& prover) {
  if (prover.problem().space.constraints.empty() || !path.tubes.empty()) return;
  const std::size_t count = std::max<std::size_t>(1, path.segments());
  for (std::size_t k = 0; k < count; ++k) path.tubes.push_back(prover.suitable_tube(path.segment(k)));
}

std::vector<Coordinates> to_coordinates(const std::vector<Waypoint>& waypoints) {
  std::vector<Coordinates> all;
  for (const Waypoint& waypoint : waypoints) all.push_back(to_coordinates(waypoint));
  return all;
}

/// The point halfway between a and b in the parameters, moved back onto the constraints if there are any.
Waypoint halfway(const PoseSampler& sampler, const Waypoint& a, const Waypoint& b) {
  const ParameterPoint &from = a.parameters(), &to = b.parameters();
  ParameterPoint middle = from;
  for (std::size_t j = 0; j < from.x.size(); ++j) {
    const double turned = std::numbers::pi * (to.half_turns[j] - from.half_turns[j]);
    middle.x[j] = 0.5 * (from.x[j] + to.x[j] + turned);
  }
  if (!sampler.constraints()) return middle;
  // Half turns of a shift the constraints by nothing but rounding.
  Coordinates q = to_coordinates(middle);
  project(sampler, q);
  middle.x = {q.data(), q.data() + q.size()};
  middle.normals = sampler.constraints()->normals(middle);
  return middle;
}

/// The clearance asked for, reduced as far as it takes to keep the query's waypoints inside the manifold.
double possible_clearance(double wanted, const PoseSampler& sampler, const std::vector<Waypoint>& query) {
  constexpr double kLeastClearance = 1e-9;
  double least = HUGE_VAL;
  for (const Waypoint& waypoint : query) {
    least = std::min(least, sampler.clearance(sampler.statics(sampler.pose(waypoint))));
  }
  double clearance = wanted;
  while (clearance >= least && clearance > kLeastClearance) clearance *= 0.3;
  return clearance > kLeastClearance ? clearance : 0.0;
}

AtlasOptions atlas_options(const PlannerOptions& planner) {
  AtlasOptions options;
  options.radius = planner.radius;
  options.epsilon = planner.epsilon;
  options.max_charts = planner.max_charts;
  return options;
}

double search_weight(Strategy strategy) {
  return strategy == Strategy::kGreedyBestFirst ? std::numeric_limits<double>::infinity() : 1.0;
}

AtlasKey atlas_key(const Case& the_case) {
  nlohmann::json problem = to_json(without_time(the_case.problem));  // charts are of poses at rest
  problem.erase("name");
  problem.erase("query");
  return {sha256(problem), {.clearance = the_case.planner.clearance}, atlas_options(the_case.planner)};
}

/// Edges longer than this in the parameters are measured along their curve [rad, m].
constexpr double kLongEdge = 0.5;

/// The fraction of the charts' clearance that edges must keep.
constexpr double kEdgeClearanceShare = 0.5;

/// An anytime search ends with a path that is longer than the shortest motion without limits by no more than this
/// fraction.
constexpr double kNearlyShortest = 1e-3;

/// With more parameters there are too many charts for a plain A*, which needs all of them.
constexpr int kMostParametersForAllCharts = 3;

}  // namespace

/// The part of the path between two consecutive waypoints of the query.
struct Planner::Leg {
  SearchResult found;
  std::vector<Coordinates> vertices;  ///< of the path found, pulled taut if the case asks for that
  double cost_found = 0;
  double cost = std::numeric_limits<double>::infinity();
  bool is_nearly_shortest = false;  ///< no motion, whatever the limits, costs noticeably less
};

/// Which edges search and shortening may use: those that look clear and, with a prover, are proved.
class Planner::Edges {
 public:
  Edges(const SampledMotionValidator& looks_clear, const PoseSampler& sampler, const Prover* prover)
      : looks_clear_(looks_clear), sampler_(sampler), prover_(prover) {}

  [[nodiscard]] bool looks_clear(const Coordinates& a, const Coordinates& b) const { return looks_clear_(a, b); }

  bool ok(const Coordinates& a, const Coordinates& b, const std::stop_token& stop) {
    ++checked_;
    const bool accepted =
        looks_clear(a, b) && (prover_ == nullptr || proved(to_waypoint(a, sampler_), to_waypoint(b, sampler_), stop));
    if (!accepted) ++rejected_;
    return accepted;
  }

  /// The proof of an edge at rest, if one was made and succeeded; else null.
  [[nodiscard]] const SegmentProof* find(const Segment& segment) const {
    if (segment.law != Interpolation::kStraight || segment.timing != nullptr) return nullptr;
    const ParameterPoint &a = segment.control[0]->parameters(), &b = segment.control[1]->parameters();
    const auto shifted = [](int half_turns) { return half_turns != 0; };
    if (std::ranges::any_of(a.half_turns, shifted) || std::ranges::any_of(b.half_turns, shifted)) return nullptr;
    const auto it = proofs_.find({a.x, b.x});
    return it == proofs_.end() || it->second.verdict != Verdict::kProved ? nullptr : &it->second;
  }

  [[nodiscard]] bool are_proved() const { return prover_ != nullptr; }
  [[nodiscard]] double proving_seconds() const { return proving_seconds_; }
  [[nodiscard]] int checked() const { return checked_; }
  [[nodiscard]] int rejected() const { return rejected_; }

 private:
  bool proved(const Waypoint& a, const Waypoint& b, const std::stop_token& stop) {
    const auto [it, is_new] = proofs_.try_emplace({a.parameters().x, b.parameters().x});
    if (is_new) {
      const auto start = Clock::now();
      it->second = prover_->prove(a, b, 0, stop, ProofAim::kProve);
      proving_seconds_ += seconds_since(start);
    }
    return it->second.verdict == Verdict::kProved;
  }

  const SampledMotionValidator& looks_clear_;
  const PoseSampler& sampler_;
  const Prover* prover_;
  std::map<std::pair<std::vector<double>, std::vector<double>>, SegmentProof> proofs_;
  double proving_seconds_ = 0;
  int checked_ = 0;
  int rejected_ = 0;
};

Planner::Planner(const Case& the_case, const std::filesystem::path& atlas_file)
    : case_(the_case),
      prover_(the_case.problem),
      sampler_(the_case.problem),
      query_(query_waypoints(the_case.problem)),
      length_(sampler_, the_case.planner.cost, to_coordinates(query_), the_case.planner.travel),
      clearance_(possible_clearance(the_case.planner.clearance, sampler_, query_)),
      chart_clearance_(clearance_) {
  if (!atlas_file.empty()) {
    atlas_file_.emplace(atlas_file, atlas_key(the_case));
    chart_clearance_ = std::min(clearance_, atlas_file_->clearance());
  }
  manifold_ = make_wrench_feasible_manifold(the_case.problem, sampler_, {.clearance = chart_clearance_});
  if (atlas_file_) {
    atlas_.emplace(*manifold_, atlas_options(the_case.planner), *atlas_file_);
  } else {
    atlas_.emplace(*manifold_, atlas_options(the_case.planner));
  }
}

std::string Planner::atlas_bytes() const { return AtlasFile::bytes_of(*atlas_, atlas_key(case_), chart_clearance_); }

/// The answer if a waypoint of the query is infeasible or undecided.
std::optional<Plan> Planner::judge_query(const std::stop_token& stop) const {
  for (std::size_t k = 0; k < query_.size(); ++k) {
    Plan answer;
    Reason undecided;
    answer.proof.witness = refute_waypoint(prover_, query_[k], 0, undecided, stop);
    if (answer.proof.witness) {
      answer.path.waypoints = {query_[k]};
      answer.refuted_waypoint = k;
      answer.proof.verdict = Verdict::kRefuted;
      return answer;
    }
    if (!undecided.empty()) {
      answer.path.waypoints = query_;
      answer.undecided_waypoint = k;
      answer.proof.reason = undecided.preceded_by(fmt::format("waypoint {} of the query: ", k));
      return answer;
    }
  }
  return std::nullopt;
}

/// A path through the query on edges that `edges` accepts. If none is found, nothing, and `reason` is set.
std::optional<Planner::FoundPath> Planner::find_path(Edges& edges, const Progress& progress,
                                                     const std::stop_token& stop, PlanStatistics& statistics,
                                                     Reason& reason) {
  const auto distance = [&](const Coordinates& a, const Coordinates& b) { return length_.distance(a, b); };
  SearchProblem search_problem;
  // Neighbouring charts are so close that the distance is accurate enough. If only part of a pose counts, many costs
  // are then equal, which ends a search soon.
  search_problem.cost = [&](const Coordinates& a, const Coordinates& b) {
    return (b - a).squaredNorm() > kLongEdge * kLongEdge ? length_.along(a, b) : length_.distance(a, b);
  };
  search_problem.straight_to_goal = true;
  search_problem.heuristic = distance;
  // Where a path is to be pulled taut, that takes longer than charts, and a path along charts leaves it more to choose.
  if (case_.planner.smoothing == Smoothing::kNone && !edges.are_proved() && !sampler_.constraints()) {
    search_problem.detours = [&](const Coordinates& a, const Coordinates& b) {
      return Detours(case_.problem.space, sampler_, length_, manifold_->symmetry())(a, b);
    };
  }
  search_problem.edge_ok = [&](const Coordinates& a, const Coordinates& b) {
    return edges.ok(a, b, search_problem.stop);
  };
  search_problem.edge_likely = [&](const Coordinates& a, const Coordinates& b) { return edges.looks_clear(a, b); };
  if (progress) {
    search_problem.progress = [&](const SearchProgress& p) { progress({p.charts, edges.checked()}); };
  }
  Path path;
  path.waypoints = {query_.front()};
  std::vector<std::size_t> stops = {0};
  Image reached;
  for (std::size_t leg = 0; leg + 1 < query_.size(); ++leg) {
    search_problem.start = to_coordinates(query_[leg]);
    search_problem.goal = to_coordinates(query_[leg + 1]);
    TimeBudget budget(seconds_for_leg(leg), stop);
    search_problem.stop = budget.token();
    const Leg best = find_leg(search_problem, edges, statistics);
    if (best.found.status != SearchStatus::kFound) {
      const bool ran_out = best.found.status == SearchStatus::kChartLimit || search_problem.stop.stop_requested();
      statistics.budget_spent = ran_out && !stop.stop_requested();
      reason = stop.stop_requested() ? Undecided::kInterrupted : no_path_reason(best.found, leg);
      return std::nullopt;
    }
    if (stop.stop_requested()) statistics.budget_spent = false;
    statistics.cost_found += best.cost_found;
    statistics.cost += best.cost;
    append_leg(path, best.vertices, best.found.path.back(), reached, case_.problem.space.flip, sampler_);
    stops.push_back(path.waypoints.size() - 1);
    reached = compose(reached, best.found.path.back().image);
  }
  return FoundPath{std::move(path), std::move(stops)};
}

/// The shortest path of a leg that strategy and budget allow; or its status if none was found.
Planner::Leg Planner::find_leg(const SearchProblem& problem, Edges& edges, PlanStatistics& statistics) {
  Leg best;
  const double least = least_cost(problem);
  const auto keep_better = [&](const SearchResult& found) {
    Leg leg = pull_taut(found, problem, edges, statistics);
    if (leg.cost < best.cost) best = std::move(leg);
    best.is_nearly_shortest = best.cost <= (1 + kNearlyShortest) * least;
    return !best.is_nearly_shortest;
  };
  SearchResult last;
  if (is_anytime()) {
    last = search_anytime(*atlas_, problem, keep_better);
    if (best.is_nearly_shortest) last.factor = std::min(last.factor, std::max(1.0, best.cost_found / least));
    statistics.budget_spent |= last.factor > 1 && !best.is_nearly_shortest;
  } else {
    last = search(*atlas_, problem, {.weight = search_weight(case_.planner.strategy)});
    if (last.status == SearchStatus::kFound) keep_better(last);
  }
  statistics.nodes_expanded += last.nodes_expanded;
  statistics.factor = std::max(statistics.factor, last.factor);
  if (last.status != SearchStatus::kFound) best.found = std::move(last);
  return best;
}

/// No motion from start to goal costs less, whatever the limits.
double Planner::least_cost(const SearchProblem& problem) const {
  const CoordinateSymmetry symmetry = manifold_->symmetry();
  return problem.heuristic(problem.start,
                           symmetry.apply(problem.goal, symmetry.nearest_image(problem.goal, problem.start)));
}

Planner::Leg Planner::pull_taut(const SearchResult& found, const SearchProblem& problem, Edges& edges,
                                PlanStatistics& statistics) const {
  const auto length = [&](const Coordinates& a, const Coordinates& b) { return length_.along(a, b); };
  Leg leg;
  leg.found = found;
  for (const PathVertex& vertex : found.path) leg.vertices.push_back(vertex.coordinates);
  for (std::size_t k = 1; k < leg.vertices.size(); ++k) leg.cost_found += length(leg.vertices[k - 1], leg.vertices[k]);
  leg.cost = leg.cost_found;
  constexpr double kNoLength = 1e-12;  // rounding of a leg whose ends are the same pose in different coordinates
  const bool is_shortest = leg.vertices.size() <= 2 && leg.cost <= kNoLength;
  if (case_.planner.smoothing != Smoothing::kNone && !is_shortest) {
    const auto start = Clock::now();
    const double proving_before = edges.proving_seconds();
    std::function<bool(Coordinates&)> onto_constraints;
    if (sampler_.constraints()) onto_constraints = [&](Coordinates& q) { return project(sampler_, q); };
    const auto through = [&](const Coordinates& before, const Coordinates& after) {
      return [by = PathLength::Through(length_, before, after)](const Coordinates& x) { return by(x); };
    };
    const ShortenProblem taut{length, problem.edge_ok, problem.stop, onto_constraints, least_cost(problem), through};
    leg.cost = shorten(leg.vertices, taut).cost_after;
    statistics.smooth_seconds += seconds_since(start) - (edges.proving_seconds() - proving_before);
  }
  return leg;
}

bool Planner::is_anytime() const {
  return case_.planner.strategy == Strategy::kAStar &&
         (case_.planner.has_budget || manifold_->dimension() > kMostParametersForAllCharts);
}

/// The remaining legs share the remaining time.
double Planner::seconds_for_leg(std::size_t leg) const {
  return (case_.planner.max_seconds - seconds_since(begin_)) / static_cast<double>(query_.size() - 1 - leg);
}

Reason Planner::no_path_reason(const SearchResult& result, std::size_t leg) const {
  const std::string what = fmt::format("no path from waypoint {} to {} of the query: ", leg, leg + 1);
  const std::string unit = length_.unit();
  const std::string best = fmt::format("; best so far: a chart whose distance to waypoint {} is {:.3g}{} ({})", leg + 1,
                                       result.nearest, unit.empty() ? "" : " " + unit, length_.measure());
  switch (result.status) {
    case SearchStatus::kExhausted: {
      const std::string charts = fmt::format(
          " {} of radius {}{} and the goal was not met{}. That is evidence, not proof, that none exists; charts of a "
          "smaller planner.radius see finer",
          plural(static_cast<std::size_t>(atlas_->size()), "chart"), atlas_->options().radius,
          manifold_->dimension() > Polytope::kMaxDimension ? ", as densely as sampled directions tell," : "", best);
      return Reason(Undecided::kNoPathFound, charts).preceded_by(what);
    }
    case SearchStatus::kChartLimit:
      return Reason(Undecided::kChartBudget, best)
          .preceded_by(fmt::format("{}the budget of {} ", what, atlas_->options().max_charts));
    case SearchStatus::kInterrupted:
      return Reason(Undecided::kTimeBudget, best)
          .preceded_by(fmt::format("{}the budget of {}", what, case_.planner.max_seconds));
    case SearchStatus::kOutside:
      return Reason(Undecided::kOutsideManifold).preceded_by(fmt::format("waypoint {} or {} ", leg, leg + 1));
    case SearchStatus::kFound: break;
  }
  return {};
}

Plan Planner::plan(const Progress& progress, const std::stop_token& stop, const MoveRequest& request) {
  const auto start = begin_ = Clock::now();
  Plan result;
  if (auto answer = judge_query(stop)) {
    result = std::move(*answer);
    if (result.proof.verdict == Verdict::kUndecided && stop.stop_requested())
      result.proof.reason = Undecided::kInterrupted;
    result.statistics.prove_seconds = seconds_since(start);
  } else {
    result.statistics.prove_seconds = seconds_since(start);
    seek_and_prove(progress, stop, result);
    const bool may_go_on = !stop.stop_requested() && !result.statistics.budget_spent;
    if (result.proof.verdict == Verdict::kUndecided && atlas_file_ && may_go_on) {
      atlas_.emplace(*manifold_, atlas_options(case_.planner));
      atlas_file_.reset();
      seek_and_prove(progress, stop, result);
    }
  }
  set_tubes(result.path, prover_);
  if (case_.problem.time && result.proof.verdict == Verdict::kProved) make_move(request, progress, stop, result);
  PlanStatistics& statistics = result.statistics;
  statistics.cost_measure = length_.measure();
  statistics.cost_unit = length_.unit();
  statistics.charts = atlas_->size();
  statistics.charts_stored = atlas_file_ ? atlas_file_->size() : 0;
  statistics.plan_seconds = seconds_since(start) - statistics.prove_seconds - statistics.smooth_seconds;
  return result;
}

/// Gives the path, proved at rest, a time law; from then on the plan's proof is that of the move.
void Planner::make_move(const MoveRequest& request, const Progress& progress, const std::stop_token& stop,
                        Plan& plan) const {
  const auto show = [&](int tries) {
    if (progress) progress({atlas_->size(), 0, tries + 1});
  };
  PlannedMove move = plan_move(case_, prover_, plan.path, request, stop, show);
  plan.path = std::move(move.path);
  plan.proof = std::move(move.proof);
  if (plan.proof.verdict == Verdict::kUndecided && stop.stop_requested()) plan.proof.reason = Undecided::kInterrupted;
  plan.statistics.prove_seconds += move.statistics.prove_seconds;
  plan.move = std::move(move.statistics);
}

/// Seeks a path on edges that look clear and proves it. If that fails, seeks one on proved edges. An anytime search
/// uses proved edges from the start, because it keeps the best path so far.
void Planner::seek_and_prove(const Progress& progress, const std::stop_token& stop, Plan& result) {
  const Prover* const edge_prover = is_anytime() ? &prover_ : nullptr;
  const bool done = try_plan(edge_prover, progress, stop, result) || stop.stop_requested();
  if (!done && edge_prover == nullptr) try_plan(&prover_, progress, stop, result);
}

bool Planner::grow_atlas(const Progress& progress, const std::stop_token& stop) {
  return atlas_->grow_all([&] {
    if (progress) progress({atlas_->size(), 0});
    return !stop.stop_requested();
  });
}

/// Seeks a path on edges that look clear and, with a prover, are proved one by one; then proves the path. Returns false
/// if a path was found that is not proved.
bool Planner::try_plan(const Prover* edge_prover, const Progress& progress, const std::stop_token& stop, Plan& result) {
  PlanStatistics& statistics = result.statistics;
  statistics.cost = statistics.cost_found = 0;
  statistics.factor = 1;
  statistics.budget_spent = false;
  const SampledMotionValidator looks_clear(sampler_, kEdgeClearanceShare * clearance_, prover_.bodies());
  Edges edges(looks_clear, sampler_, edge_prover);
  result.proof = {};
  std::optional<FoundPath> found = find_path(edges, progress, stop, statistics, result.proof.reason);
  statistics.edges_checked += edges.checked();
  statistics.edges_rejected += edges.rejected();
  statistics.prove_seconds += edges.proving_seconds();
  if (!found) {
    result.path = {};
    result.path.waypoints = query_;
    return true;
  }
  const auto start = Clock::now();
  result.path = std::move(found->path);
  set_tubes(result.path, prover_);
  const ProofAim aim = edge_prover == nullptr ? ProofAim::kProve : ProofAim::kDecide;  // another path is sought
  result.proof = prove_path(
      prover_, result.path, [&](const Segment& segment) { return edges.find(segment); }, stop, aim);
  statistics.prove_seconds += seconds_since(start);
  if (result.proof.verdict != Verdict::kProved) return false;
  // A move's law rests at stops by itself: where there is nothing but stops, no corner is left to be rounded.
  const bool has_corners = found->stops.size() < result.path.waypoints.size();
  if (case_.planner.smoothing == Smoothing::kSpline && (has_corners || !case_.problem.time)) {
    round_corners(found->stops, stop, result);
  }
  return true;
}

/// Replaces the path by a spline, if a proved one is found.
void Planner::round_corners(const std::vector<std::size_t>& stops, const std::stop_token& stop, Plan& plan) const {
  const auto start = Clock::now();
  const auto curve = [&](const Segment& segment, double s) { return sampler_.parameters(segment, s); };
  const auto length = [&](const Path& path) {
    return motion_length(path, curve, [&](const std::vector<double>& a, const std::vector<double>& b) {
      return length_.distance(to_coordinates(a), to_coordinates(b));
    });
  };
  const auto middle = [&](const Waypoint& a, const Waypoint& b) { return halfway(sampler_, a, b); };
  const SmoothProblem problem{prover_, kEdgeClearanceShare * clearance_, length, middle, stop};
  if (std::optional<SmoothPath> rounded = smooth(plan.path, stops, problem)) {
    plan.path = std::move(rounded->path);
    plan.proof = std::move(rounded->proof);
    plan.statistics.cost = rounded->length;
  }
  plan.statistics.smooth_seconds += seconds_since(start);
}

MotionLengths Planner::measure(const Path& path) const {
  const auto curve = [&](const Segment& segment, double s) { return sampler_.parameters(segment, s); };
  const auto length = [&](auto distance) {
    return motion_length(path, curve, [&](const std::vector<double>& a, const std::vector<double>& b) {
      return distance(sampler_.pose(a), sampler_.pose(b));
    });
  };
  const auto way = [](const Pose<double>& a, const Pose<double>& b) { return (a.p_WP - b.p_WP).norm(); };
  const auto turn = [&](const Pose<double>& a, const Pose<double>& b) {
    return rotation_angle(sampler_.rotation(a), sampler_.rotation(b));
  };
  return {length(way), length(turn)};
}

}  // namespace taut
