// SPDX-License-Identifier: GPL-3.0-or-later
// One plan, end to end: atlas, search, path, proof.
//
// The search proposes and the prover decides. A path is sought on edges that look clear of limits at sampled poses
// (planner/sampled_motion_validator.h), and proved as a whole. If the proof fails, the path is sought again, now on
// edges that are each proved first, so that the search goes around those that are not. The proof of a path consists of
// the prover's results for its segments and is never inferred from the search.
//
// A* on a budget, or over more than three parameters, is an anytime search (atlas/search.h): each path that it finds is
// pulled taut on proved edges, and the shortest such path is the result. The budget only ends the search for a shorter
// one, and so does a path that is within a thousandth of the shortest motion without limits.
//
// A path is sought, and first proved, at rest. Where the case has limits in time, it then becomes a move.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "atlas/atlas.h"
#include "atlas/atlas_file.h"
#include "atlas/search.h"
#include "case/case_file.h"
#include "certify/path_proof.h"
#include "planner/move.h"
#include "planner/path_length.h"

namespace taut {

struct PlanStatistics {
  int charts = 0;
  int charts_stored = 0;  ///< charts among these that were in the atlas file
  int nodes_expanded = 0;
  int edges_checked = 0;  ///< by samples or by proof, for search and shortening
  int edges_rejected = 0;
  std::string cost_measure;   ///< what the case's cost measures, in words (planner/path_length.h)
  std::string cost_unit;      ///< "rad", "m", or empty for the parameters
  double cost_found = 0;      ///< of the path that the search found
  double factor = 1;          ///< that path is at most this many times as long as the shortest on the charts' graph
  bool budget_spent = false;  ///< the budget ended the search
  double cost = 0;            ///< of the final path
  double plan_seconds = 0;    ///< atlas and search, without the proofs of edges
  double smooth_seconds = 0;  ///< shortening, without the proofs of edges
  double prove_seconds = 0;
};

struct Plan {
  Path path;  ///< the path found; or the waypoint that refutes; or the query's waypoints if no path was found
  PathProof proof;
  PlanStatistics statistics;
  std::optional<std::size_t> refuted_waypoint;    ///< index in the query of the waypoint that `path` then consists of
  std::optional<std::size_t> undecided_waypoint;  ///< index in the query of the waypoint that is neither
  std::optional<MoveStatistics> move;             ///< where `path` has a time law
};

struct MotionLengths {
  double length_m = 0;   ///< distance that the platform's origin travels
  double angle_rad = 0;  ///< angle that the platform turns by
};

struct PlanProgress {
  int charts = 0;
  int edges_checked = 0;
  int move_tries = 0;  ///< time laws that were tried; 0 before there is a path
};

using Progress = std::function<void(const PlanProgress&)>;

/// A case prepared for planning: expressions parsed, models made, an atlas begun.
class Planner {
 public:
  /// @param the_case    must outlive the planner.
  /// @param atlas_file  the atlas to begin with; if empty, a new one.
  /// @throws InputError if the case has no model, or the file is refused (atlas/atlas_file.h).
  explicit Planner(const Case& the_case, const std::filesystem::path& atlas_file = {});

  /// Plans through the query's waypoints in order. Charts made by an earlier call are used again. If a stored atlas
  /// leads to no path, a new atlas is begun: a poor file costs time, never the answer. Where the problem has limits in
  /// time, the path is proved at rest first and then gets a time law (planner/move.h): the plan's proof is the move's.
  /// @throws InputError if the atlas file turns out to be damaged; as plan_move()
  [[nodiscard]] Plan plan(const Progress& progress, const std::stop_token& stop, const MoveRequest& request = {});

  /// Grows the atlas around all its charts, until nothing is left to cover, the case's max_charts are made, or `stop`
  /// is requested. @returns whether nothing is left to cover.
  bool grow_atlas(const Progress& progress, const std::stop_token& stop);

  [[nodiscard]] MotionLengths measure(const Path& path) const;

  [[nodiscard]] const Atlas& atlas() const { return *atlas_; }
  /// The content of a file with the atlas. @pre the atlas has a chart.
  [[nodiscard]] std::string atlas_bytes() const;

 private:
  class Edges;
  struct Leg;

  [[nodiscard]] std::optional<Plan> judge_query(const std::stop_token& stop) const;
  void seek_and_prove(const Progress& progress, const std::stop_token& stop, Plan& result);
  void make_move(const MoveRequest& request, const Progress& progress, const std::stop_token& stop, Plan& plan) const;
  [[nodiscard]] bool is_anytime() const;
  bool try_plan(const Prover* edge_prover, const Progress& progress, const std::stop_token& stop, Plan& result);
  struct FoundPath {
    Path path;
    std::vector<std::size_t> stops;  ///< indices of the path's waypoints that are the query's
  };
  [[nodiscard]] std::optional<FoundPath> find_path(Edges& edges, const Progress& progress, const std::stop_token& stop,
                                                   PlanStatistics& statistics, Reason& reason);
  void round_corners(const std::vector<std::size_t>& stops, const std::stop_token& stop, Plan& plan) const;
  [[nodiscard]] Leg find_leg(const SearchProblem& problem, Edges& edges, PlanStatistics& statistics);
  [[nodiscard]] double least_cost(const SearchProblem& problem) const;
  [[nodiscard]] Leg pull_taut(const SearchResult& found, const SearchProblem& problem, Edges& edges,
                              PlanStatistics& statistics) const;
  [[nodiscard]] double seconds_for_leg(std::size_t leg) const;
  [[nodiscard]] Reason no_path_reason(const SearchResult& result, std::size_t leg) const;

  const Case& case_;
  const Prover prover_;
  PoseSampler sampler_;
  std::vector<Waypoint> query_;
  PathLength length_;
  double clearance_;  ///< what the case asks for, or less if a waypoint of the query has less
  std::optional<AtlasFile> atlas_file_;
  double chart_clearance_;  ///< clearance_, or less if the stored atlas was made with less
  std::unique_ptr<Manifold> manifold_;
  std::optional<Atlas> atlas_;
  std::chrono::steady_clock::time_point begin_;  ///< when plan() was called
};

}  // namespace taut
