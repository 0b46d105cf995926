// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/as_items.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "certificate/elaborate.h"
#include "certify/path_proof.h"
#include "planner/time_budget.h"
#include "reports/summary/illustration.h"
#include "reports/summary/shown_bodies.h"

namespace taut {

void add_stated(nlohmann::json& illustration, const Case& the_case) {
  illustration["units"] = to_json(the_case.units);
  illustration["document_fields"] = to_json(the_case.document_fields);
  if (!the_case.problem.space.constraints.empty()) illustration["has_constraints"] = true;
  const LoadStatement load = load_statement(the_case);
  if (load.around_items) illustration["around_items"] = stated_json(*load.around_items);
  const AngleKind angles = the_case.problem.space.angles.kind;
  if (angles != AngleKind::kTiltAndTorsion && angles != AngleKind::kAxis) illustration["angles"] = name(angles);
}

void add_stated(nlohmann::json& illustration, const Case& the_case, const Decoration& decoration) {
  add_stated(illustration, the_case);
  illustration["decoration"] = to_json(decoration);
}

std::optional<AsItems> prove_as_items(const Case& the_case, const Problem& problem, const Path& path,
                                      const std::optional<Margins>& of_ellipsoid, double seconds,
                                      const std::stop_token& stop) {
  if (!the_case.items_in_ellipsoid || seconds <= 0) return std::nullopt;
  Problem with_items = problem;
  with_items.load = *the_case.items_in_ellipsoid;
  const TimeBudget budget(seconds, stop);
  const Prover prover(with_items);
  AsItems result;
  result.of_ellipsoid = of_ellipsoid;
  if (path.segments() == 0) {
    Reason undecided;
    const auto witness = refute_waypoint(prover, path.waypoints.at(0), 0, undecided, budget.token());
    if (witness || undecided.empty()) result.verdict = witness ? Verdict::kRefuted : Verdict::kProved;
    return result;
  }
  const PathProof proof = prove_path(prover, path, {}, budget.token());
  result.verdict = proof.verdict;
  if (proof.verdict != Verdict::kProved) return result;
  const Certificate certificate = elaborate(with_items, path, proof);  // margins as of_ellipsoid are
  result.verdict = certificate.verdict;
  result.margins = certificate.margins;
  return result;
}

std::optional<AsItems> prove_as_items(const Case& the_case, const Plan& plan,
                                      const std::optional<Margins>& of_ellipsoid, double seconds,
                                      const std::stop_token& stop) {
  Path path = plan.path;
  const std::optional<std::size_t> waypoint = plan.refuted_waypoint ? plan.refuted_waypoint : plan.undecided_waypoint;
  if (waypoint) {
    path.waypoints = {query_waypoints(the_case.problem).at(*waypoint)};
    path.tubes.clear();
  }
  auto result = prove_as_items(the_case, the_case.problem, path, of_ellipsoid, seconds, stop);
  if (!result) return result;
  if (waypoint) {
    result->subject = fmt::format("waypoint {} of the query", *waypoint);
  } else if (plan.proof.verdict == Verdict::kUndecided && plan.proof.open_segment < 0) {
    result->subject = "the straight way through the query's waypoints";
  }
  return result;
}

}  // namespace taut
