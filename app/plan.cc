// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/plan.h"

#include "app/illustration.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "kinematics/navigation_manifold.h"
#include "reports/summary/headroom_summary.h"

namespace taut {

void require_plannable(const Case& the_case) {
  if (the_case.problem.query.empty()) {
    throw FieldError("query", "", "expected the key 'query': what to plan (a case without is for taut audit)");
  }
  require_query_on_constraints(the_case.problem, the_case.length_unit);
}

PlannedCase plan_case(const Case& the_case, Planner& planner, const PlannedCaseOptions& options,
                      const Progress& progress, const std::stop_token& stop) {
  PlannedCase result;
  result.plan = planner.plan(progress, stop);
  if (options.grow) result.whole_atlas = planner.grow_atlas(progress, stop);
  const Plan& plan = result.plan;
  nlohmann::json illustration = illustrate(the_case.problem, planner.atlas(), plan.statistics);
  if (options.headroom_seconds > 0 && !stop.stop_requested()) {
    result.headroom = plan_headroom(the_case, plan, options.headroom_seconds, options.headroom_progress, stop);
    illustration["headroom"] = to_json(*result.headroom);
  }
  Certificate certificate = elaborate(the_case.problem, plan.path, plan.proof);
  certificate.illustration = std::move(illustration);
  result.text = certificate_text(certificate, options.key);
  result.checked = recheck(result.text, options.max_seconds, stop.stop_requested() ? std::stop_token() : stop);
  require_confirmed(result.checked);
  return result;
}

}  // namespace taut
