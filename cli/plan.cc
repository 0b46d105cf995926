#include "cli/plan.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "atlas/shorten.h"
#include "atlas/wrench_feasible_manifold.h"
#include "kinematics/geometry.h"
#include "kinematics/input_error.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// ---- Cost functions --------------------------------------------------------------------------------------------------

using CostFunction = std::function<double(const Coordinates&, const Coordinates&)>;

class PoseFunction {
 public:
  explicit PoseFunction(const Problem& problem) : pose_(pose_tape(problem)) {}
  [[nodiscard]] Pose<double> operator()(const Coordinates& q) const {
    return evaluate_pose(pose_, std::span<const double>(q.data(), static_cast<std::size_t>(q.size())));
  }

 private:
  Evaluator<double> pose_;
};

/// The rotation angle ‖log(R_a^T R_b)‖, from the chord ‖R_a − R_b‖_F = 2√2 sin(angle/2).
double rotation_angle(const Pose<double>& a, const Pose<double>& b) {
  const double chord = (rotation(a.phi, a.theta, a.sigma) - rotation(b.phi, b.theta, b.sigma)).norm();
  return 2.0 * std::asin(std::min(1.0, chord / (2.0 * std::numbers::sqrt2)));
}

struct Sphere {
  Eigen::Vector3d centre;
  double radius;
};

/// The sphere that the space's positions lie on. @throws InputError if they do not lie on one.
Sphere fit_sphere(const Problem& problem, const PoseFunction& pose, const std::vector<Waypoint>& query) {
  constexpr int kSamples = 24;
  const int n = static_cast<int>(problem.space.parameters.size());
  Eigen::MatrixXd equations(kSamples, 4);
  Eigen::VectorXd squares(kSamples);
  for (int k = 0; k < kSamples; ++k) {
    const Waypoint& near = query[static_cast<std::size_t>(k) % query.size()];
    Coordinates q(n);
    for (int j = 0; j < n; ++j) q[j] = near.x[static_cast<std::size_t>(j)] + 0.7 * std::sin(1.0 + 2.3 * k + 5.1 * j);
    const Eigen::Vector3d p = pose(q).p_WP;
    equations.row(k) << 2.0 * p.transpose(), 1.0;
    squares[k] = p.squaredNorm();
  }
  const Eigen::Vector4d solution = equations.colPivHouseholderQr().solve(squares);
  const Sphere sphere{solution.head<3>(), std::sqrt(std::max(0.0, solution[3] + solution.head<3>().squaredNorm()))};
  const double misfit = (equations * solution - squares).lpNorm<Eigen::Infinity>();
  if (!(misfit <= 1e-9 * squares.lpNorm<Eigen::Infinity>()) || !(sphere.radius > 0)) {
    throw InputError("planner.cost: got 'great_circle', expected a space whose positions p lie on one sphere");
  }
  return sphere;
}

CostFunction make_cost(const Case& case_, const PoseFunction& pose, const std::vector<Waypoint>& query) {
  switch (case_.planner.cost) {
    case Cost::kRotation:
      return [&pose](const Coordinates& a, const Coordinates& b) { return rotation_angle(pose(a), pose(b)); };
    case Cost::kGreatCircle: {
      const Sphere sphere = fit_sphere(case_.problem, pose, query);
      return [&pose, sphere](const Coordinates& a, const Coordinates& b) {
        const double chord = (pose(a).p_WP - pose(b).p_WP).norm();
        return 2.0 * sphere.radius * std::asin(std::min(1.0, chord / (2.0 * sphere.radius)));
      };
    }
    case Cost::kParameters: break;
  }
  return [](const Coordinates& a, const Coordinates& b) { return (a - b).norm(); };
}

// ---- Waypoints and the planner's coordinates --------------------------------------------------------------------------

Coordinates to_coordinates(const Waypoint& waypoint) {
  Coordinates q(static_cast<int>(waypoint.x.size()));
  for (int j = 0; j < q.size(); ++j) q[j] = waypoint.x[static_cast<std::size_t>(j)];
  return q;
}

Waypoint to_waypoint(const Coordinates& q) {
  return {std::vector<double>(q.data(), q.data() + q.size()), std::vector<int>(static_cast<std::size_t>(q.size()), 0)};
}

/// The same pose in the image `image`, exactly.
Waypoint apply(const Image& image, const std::optional<std::array<int, 2>>& flip, Waypoint waypoint) {
  for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
    const bool negated = image.flipped && flip && static_cast<std::size_t>((*flip)[1]) == j;
    if (negated) waypoint.x[j] = 0.0 - waypoint.x[j];
    waypoint.half_turns[j] += image.half_turns[j];
  }
  return waypoint;
}

/// First `first`, then `second`.
Image compose(Image first, const Image& second) {
  for (std::size_t j = 0; j < first.half_turns.size(); ++j) first.half_turns[j] += second.half_turns[j];
  first.flipped = first.flipped != second.flipped;
  return first;
}

/// Appends a leg, seen in the image that the path has reached; its first vertex is there already. Vertices between the
/// query's waypoints are ours to choose; the goal is kept exact.
void append_leg(Path& path, const std::vector<Coordinates>& leg, const PathVertex& goal, const Image& reached,
                const std::optional<std::array<int, 2>>& flip) {
  for (std::size_t k = 1; k + 1 < leg.size(); ++k) {
    path.waypoints.push_back(apply(reached, flip, to_waypoint(leg[k])));
  }
  path.waypoints.push_back(apply(reached, flip, apply(goal.image, flip, to_waypoint(goal.base))));
}

// ---- Proofs made on the way -------------------------------------------------------------------------------------------

/// Proofs of the edges that the search asked about.
class ProvedEdges {
 public:
  ProvedEdges(const Prover& prover, double clearance) : prover_(prover), clearance_(clearance) {}

  bool edge_ok(const Coordinates& a, const Coordinates& b) {
    const auto start = Clock::now();
    const Waypoint from = to_waypoint(a);
    const Waypoint to = to_waypoint(b);
    SegmentProof proof = prover_.prove(from, to, clearance_);
    const bool proved = proof.verdict == Verdict::kProved;
    ++checked_;
    if (!proved) ++rejected_;
    if (proved) proofs_.insert_or_assign({from.x, to.x}, std::move(proof));
    seconds_ += seconds_since(start);
    return proved;
  }

  [[nodiscard]] const SegmentProof* find(const Segment& segment) const {
    if (segment.law != Interpolation::kStraight) return nullptr;
    const Waypoint& a = *segment.control[0];
    const Waypoint& b = *segment.control[1];
    const auto shifted = [](int half_turns) { return half_turns != 0; };
    if (std::ranges::any_of(a.half_turns, shifted) || std::ranges::any_of(b.half_turns, shifted)) return nullptr;
    const auto it = proofs_.find({a.x, b.x});
    return it == proofs_.end() ? nullptr : &it->second;
  }

  [[nodiscard]] double seconds() const { return seconds_; }
  [[nodiscard]] int checked() const { return checked_; }
  [[nodiscard]] int rejected() const { return rejected_; }

 private:
  const Prover& prover_;
  const double clearance_;
  std::map<std::pair<std::vector<double>, std::vector<double>>, SegmentProof> proofs_;
  double seconds_ = 0;
  int checked_ = 0;
  int rejected_ = 0;
};

// ---- Illustration ----------------------------------------------------------------------------------------------------

nlohmann::json illustrate(const Problem& problem, const Atlas& atlas, const PlanStatistics& statistics) {
  constexpr int kMostCharts = 4000;
  const auto point = [](const Coordinates& q) {
    return nlohmann::json{fmt::format("{:.5g}", q[0]), fmt::format("{:.5g}", q[1])};
  };
  nlohmann::json charts = nlohmann::json::array();
  if (problem.space.parameters.size() == 2) {
    for (int id = 0; id < std::min(atlas.size(), kMostCharts); ++id) {
      const Chart& chart = atlas.chart(id);
      std::vector<std::pair<double, Coordinates>> corners;
      const auto& polytope = std::get<Polytope>(chart.polytope);
      for (int v = 0; v < polytope.corners(); ++v) {
        const TangentVector u = polytope.corner(v);
        corners.emplace_back(std::atan2(u[1], u[0]), chart.frame.coordinates() + chart.frame.lift() * u);
      }
      std::ranges::sort(corners, {}, [](const auto& corner) { return corner.first; });
      nlohmann::json polygon = nlohmann::json::array();
      for (const auto& corner : corners) polygon.push_back(point(corner.second));
      charts.push_back({{"c", point(chart.frame.coordinates())}, {"p", std::move(polygon)}});
    }
  }
  nlohmann::json parameters = nlohmann::json::array();
  for (const Parameter& parameter : problem.space.parameters) parameters.push_back(parameter.name);
  return {{"kind", "atlas"},
          {"parameters", std::move(parameters)},
          {"charts", std::move(charts)},
          {"stats",
           {{"charts", statistics.charts},
            {"expanded", statistics.nodes_expanded},
            {"edges_checked", statistics.edges_checked},
            {"edges_rejected", statistics.edges_rejected},
            {"cost", fmt::format("{:.6g}", statistics.cost)}}}};
}

/// As much of the clearance asked for as keeps the query's waypoints inside the manifold.
double possible_clearance(const Case& case_, const std::vector<Waypoint>& query) {
  constexpr double kLeastClearance = 1e-9;
  for (double clearance = case_.planner.clearance; clearance > kLeastClearance; clearance *= 0.3) {
    const auto manifold = make_wrench_feasible_manifold(case_.problem, {.clearance = clearance});
    Frame frame;
    const bool all_inside = std::ranges::all_of(
        query, [&](const Waypoint& waypoint) { return manifold->frame_at(to_coordinates(waypoint), frame); });
    if (all_inside) return clearance;
  }
  return 0;
}

std::string no_path_reason(const SearchResult& result, const Atlas& atlas, std::size_t leg) {
  switch (result.status) {
    case SearchStatus::kExhausted:
      return fmt::format(
          "no path from waypoint {} to {} of the query: the component of the start was covered by {} charts of radius "
          "{} "
          "and the goal was not met. That is evidence, not proof, that none exists",
          leg, leg + 1, atlas.size(), atlas.options().radius);
    case SearchStatus::kChartLimit:
      return fmt::format("no path from waypoint {} to {} of the query within {} charts: budget spent", leg, leg + 1,
                         atlas.size());
    case SearchStatus::kOutside:
      return fmt::format("waypoint {} or {} of the query is outside the manifold in floating point", leg, leg + 1);
    case SearchStatus::kInterrupted: return "interrupted";
    case SearchStatus::kFound: break;
  }
  return "";
}

}  // namespace

/// Edges may come this much closer to a limit than the charts' centres that they join.
constexpr double kEdgeClearanceShare = 0.5;

Plan plan(const Case& case_, const std::function<void(const PlanProgress&)>& progress, const std::stop_token& stop) {
  const Problem& problem = case_.problem;
  Plan result;
  std::atomic<bool> interrupted = false;
  const std::stop_callback on_stop(stop, [&] { interrupted = true; });
  Prover prover(problem);
  prover.interrupt = &interrupted;
  const std::vector<Waypoint> query = query_waypoints(problem);

  auto start = Clock::now();
  for (std::size_t k = 0; k < query.size(); ++k) {
    std::string undecided;
    if (auto witness = refute_waypoint(prover, query[k], 0, undecided)) {
      result.path.waypoints = {query[k]};
      result.proof.verdict = Verdict::kRefuted;
      result.proof.witness = std::move(witness);
      return result;
    }
    if (!undecided.empty()) {
      result.path.waypoints = query;
      result.proof.reason = fmt::format("waypoint {} of the query: {}", k, undecided);
      return result;
    }
  }
  result.statistics.prove_seconds = seconds_since(start);

  start = Clock::now();
  const PoseFunction pose(problem);
  const CostFunction cost = make_cost(case_, pose, query);
  const double clearance = possible_clearance(case_, query);
  const auto manifold = make_wrench_feasible_manifold(problem, {.clearance = clearance});
  AtlasOptions options;
  options.radius = case_.planner.radius;
  options.epsilon = case_.planner.epsilon;
  options.max_charts = case_.planner.max_charts;
  Atlas atlas(*manifold, options);
  ProvedEdges edges(prover, kEdgeClearanceShare * clearance);
  PlanStatistics& statistics = result.statistics;

  const bool is_greedy = case_.planner.strategy == Strategy::kGreedyBestFirst;
  const double weight = is_greedy ? std::numeric_limits<double>::infinity() : 1.0;

  result.path.waypoints = {query.front()};
  Image reached;
  bool found = true;
  for (std::size_t leg = 0; found && leg + 1 < query.size(); ++leg) {
    SearchProblem search_problem;
    search_problem.start = to_coordinates(query[leg]);
    search_problem.goal = to_coordinates(query[leg + 1]);
    search_problem.cost = cost;
    search_problem.heuristic = cost;
    search_problem.edge_ok = [&](const Coordinates& a, const Coordinates& b) { return edges.edge_ok(a, b); };
    if (progress) {
      search_problem.progress = [&](const SearchProgress& p) { progress({p.charts, edges.checked()}); };
    }
    search_problem.stop = stop;
    const SearchResult searched = search(atlas, search_problem, {.weight = weight});
    statistics.nodes_expanded += searched.nodes_expanded;
    statistics.cost_found += searched.cost;
    found = searched.status == SearchStatus::kFound;
    if (!found) {
      // An edge whose proof was interrupted looks rejected, and the search exhausted.
      result.proof.reason = stop.stop_requested() ? "interrupted" : no_path_reason(searched, atlas, leg);
      break;
    }
    std::vector<Coordinates> vertices;
    for (const PathVertex& vertex : searched.path) vertices.push_back(vertex.coordinates);
    double leg_cost = searched.cost;
    if (case_.planner.smoothing == Smoothing::kShorten) {
      const auto smooth_start = Clock::now();
      const double proving_before = edges.seconds();
      leg_cost = shorten(vertices, {cost, search_problem.edge_ok, stop}).cost_after;
      statistics.smooth_seconds += seconds_since(smooth_start) - (edges.seconds() - proving_before);
    }
    statistics.cost += leg_cost;
    append_leg(result.path, vertices, searched.path.back(), reached, problem.space.flip);
    reached = compose(reached, searched.path.back().image);
  }
  statistics.charts = atlas.size();
  statistics.edges_checked = edges.checked();
  statistics.edges_rejected = edges.rejected();
  statistics.plan_seconds = seconds_since(start) - edges.seconds() - statistics.smooth_seconds;
  statistics.prove_seconds += edges.seconds();
  result.illustration = illustrate(problem, atlas, statistics);
  if (!found) {
    result.path.waypoints = query;
    return result;
  }

  start = Clock::now();
  result.proof = prove_path(prover, result.path, [&](const Segment& segment) { return edges.find(segment); });
  statistics.prove_seconds += seconds_since(start);
  return result;
}

}  // namespace taut
