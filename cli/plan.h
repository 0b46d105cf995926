// One plan, end to end: atlas, search with every edge proved, path, proof.
//
// The search proposes edges; an edge that the prover does not prove is not used, and the search goes around it. So what
// comes back as a path is proved already; its proof is gathered, never inferred from the search.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <stop_token>

#include "atlas/search.h"
#include "certify/path_proof.h"
#include "kinematics/case_file.h"

namespace taut {

struct PlanStatistics {
  int charts = 0;
  int nodes_expanded = 0;
  int edges_checked = 0;
  int edges_rejected = 0;
  double cost_found = 0;      ///< of the path that the search found, by the case's cost function
  double cost = 0;            ///< of the path
  double plan_seconds = 0;    ///< atlas and search, without the proofs made within
  double smooth_seconds = 0;  ///< shortening, without the proofs made within
  double prove_seconds = 0;
};

struct Plan {
  Path path;  ///< found path; or the waypoint that refutes; or the waypoints of the query where there is no path
  PathProof proof;
  PlanStatistics statistics;
  nlohmann::json illustration;  ///< charts, for the report
};

struct PlanProgress {
  int charts = 0;
  int edges_checked = 0;
};

/// Plans through the query's waypoints in order. @throws InputError if the case has no model.
[[nodiscard]] Plan plan(const Case& case_, const std::function<void(const PlanProgress&)>& progress,
                        const std::stop_token& stop);

}  // namespace taut
