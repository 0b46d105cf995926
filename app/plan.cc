// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/illustration.h"
#include "app/meshes.h"
#include "base/clock.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "certify/undecided.h"
#include "kinematics/navigation_manifold.h"
#include "planner/time_budget.h"
#include "reports/summary/display_units.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/illustration.h"
#include "reports/summary/shown_bodies.h"

namespace taut {

void require_plannable(const Case& the_case) {
  if (the_case.problem.query.empty()) {
    throw FieldError("query", "", "expected the key 'query': what to plan (a case without one is for taut audit)");
  }
  require_query_on_constraints(the_case.problem, the_case.units.length);
}

void require_limits_in_time(const Case& the_case, const std::string& option) {
  if (the_case.problem.time) return;
  throw InputError(ErrorCode::kUse,
                   fmt::format("{}: got a case without the key 'time', expected one that says what winches and load "
                               "may do (docs/case-format.md)",
                               option));
}

namespace {

/// Extrapolates from an atlas that grew by `grown` charts in `seconds`. A chart costs more the more there are: about as
/// the logarithm of their number.
GrowthEstimate estimated(const Case& the_case, const Planner& planner, int grown, double seconds) {
  const auto charts = static_cast<double>(planner.atlas().size());
  const auto most = static_cast<double>(the_case.planner.max_charts);
  const double per_chart = seconds / std::max(1, grown) * std::log2(std::max(2.0, most)) / std::log2(charts + 2);
  const double bytes_per_chart = static_cast<double>(planner.atlas_bytes().size()) / charts;
  return {the_case.planner.max_charts, std::max(0.0, most - charts) * per_chart, most * bytes_per_chart};
}

Growth grow(const Case& the_case, Planner& planner, const PlannedCaseOptions& options, const Progress& progress,
            const std::stop_token& stop) {
  constexpr double kTrySeconds = 0.2;
  const auto begin = Clock::now();
  const auto seconds = [&] { return seconds_since(begin); };
  const int before = planner.atlas().size();
  const TimeBudget budget(options.grow_seconds, stop);
  Growth growth;
  bool is_announced = !options.announce_growth;
  const bool is_whole = planner.grow_atlas(
      [&](const PlanProgress& at) {
        ++growth.complete_charts;
        if (!is_announced && seconds() > kTrySeconds && at.charts > before) {
          is_announced = true;
          options.announce_growth(estimated(the_case, planner, at.charts - before, seconds()));
        }
        if (progress) progress(at);
      },
      budget.token());
  growth.charts = planner.atlas().size();
  // Each call came before a chart was tried; the last of a growth that ended early was not.
  growth.complete_charts = is_whole ? growth.charts : std::max(0, growth.complete_charts - 1);
  growth.seconds = seconds();
  growth.time_is_up = !is_whole && budget.token().stop_requested() && !stop.stop_requested();
  return growth;
}

/// Whether the search ended without a path, and not because it was told to.
bool is_exhausted(const Plan& plan) {
  if (plan.proof.verdict != Verdict::kUndecided || plan.undecided_waypoint) return false;
  const std::optional<Undecided> reason = undecided_reason(plan.proof.reason.text());
  return reason == Undecided::kNoPathFound || reason == Undecided::kChartBudget;
}

/// @returns whether `result` is that of the proof that no path exists
bool try_no_path(const Case& the_case, const PlannedCaseOptions& options, const std::stop_token& stop,
                 PlannedCase& result) {
  if (!(options.no_path_seconds > 0) || stop.stop_requested() || !is_exhausted(result.plan)) return false;
  SeparationOptions separation;
  separation.seconds = options.no_path_seconds;
  separation.stop = stop;
  Case at_rest = the_case;  // the claim is about poses
  at_rest.problem = without_time(std::move(at_rest.problem));
  result.no_path = seek_no_path(at_rest, separation, options.key);
  if (result.no_path->answer != NoPathAttempt::Answer::kApart) return false;
  result.text = result.no_path->certificate;
  result.checked = recheck(result.text, options.max_seconds, stop, meshes_of(the_case.problem));
  require_confirmed(result.checked);
  return true;
}

}  // namespace

PlannedCase plan_case(const Case& the_case, Planner& planner, const PlannedCaseOptions& options,
                      const Progress& progress, const std::stop_token& stop) {
  const Decoration decoration = read_meshes(the_case.decoration);
  PlannedCase result;
  result.plan = planner.plan(progress, stop, options.move);
  if (options.grow) result.growth = grow(the_case, planner, options, progress, stop);
  if (try_no_path(the_case, options, stop, result)) return result;
  const Plan& plan = result.plan;
  Certificate certificate = elaborate(the_case.problem, plan.path, plan.proof);
  nlohmann::json& illustration = certificate.illustration;
  illustration = illustrate(the_case.problem, planner.atlas(), plan.statistics);
  add_stated(illustration, the_case, decoration);
  if (options.headroom_seconds > 0 && !stop.stop_requested()) {
    const DecimalText wrench_scale = certificate.margins ? certificate.margins->wrench_scale : "";
    result.headroom =
        plan_headroom(the_case, plan, wrench_scale, options.headroom_seconds, options.headroom_progress, stop);
    illustration["headroom"] = to_json(*result.headroom);
    result.as_items = prove_as_items(the_case, plan, certificate.margins, options.headroom_seconds, stop);
    if (result.as_items) illustration["as_items"] = to_json(result.as_items);
  }
  result.text = certificate_text(certificate, options.key);
  if (!options.is_checked) return result;
  result.checked = recheck(result.text, options.max_seconds, stop.stop_requested() ? std::stop_token() : stop,
                           meshes_of(the_case.problem));
  require_confirmed(result.checked);
  return result;
}

}  // namespace taut
