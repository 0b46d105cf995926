// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/headroom.h"

#include <optional>
#include <utility>

#include "planner/time_budget.h"

namespace taut {

Headroom plan_headroom(const Case& the_case, const Plan& plan, const DecimalText& wrench_scale, double seconds,
                       const HeadroomProgress& progress, const std::stop_token& stop) {
  const TimeBudget budget(seconds, stop);
  Path path = plan.path;
  auto subject = Headroom::Subject::kPath;
  const std::optional<std::size_t> waypoint = plan.refuted_waypoint ? plan.refuted_waypoint : plan.undecided_waypoint;
  if (waypoint) {
    subject = Headroom::Subject::kWaypoint;
    path.waypoints = {query_waypoints(the_case.problem).at(*waypoint)};
    path.tubes.clear();
  } else if (plan.proof.verdict == Verdict::kUndecided && plan.proof.open_segment < 0) {
    subject = Headroom::Subject::kStraightWay;
  } else if (path.timing) {
    subject = Headroom::Subject::kMove;
  }
  Headroom result = find_headroom(the_case.problem, path, plan.proof.verdict, wrench_scale, progress, budget.token());
  result.subject = subject;
  result.waypoint = waypoint.value_or(0);
  return result;
}

}  // namespace taut
