// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/sensitivity.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "planner/time_budget.h"

namespace taut {
namespace {

/// Of the path as it is: refuted where a segment is.
Verdict path_verdict(const Problem& problem, const Path& path, const std::stop_token& stop) {
  const Prover prover(problem);
  std::vector<Verdict> verdicts(std::max<std::size_t>(1, path.segments()), Verdict::kUndecided);
  tbb::parallel_for(std::size_t{0}, verdicts.size(), [&](std::size_t k) {
    verdicts[k] = prover.prove(prover.prepared(path.segment(k)), 0, stop).verdict;
  });
  const auto has = [&](Verdict verdict) { return std::ranges::find(verdicts, verdict) != verdicts.end(); };
  return has(Verdict::kRefuted) ? Verdict::kRefuted : has(Verdict::kUndecided) ? Verdict::kUndecided : Verdict::kProved;
}

/// Of a path alone, whatever limits in time there are.
CaseSensitivity examine(const Problem& stated, Path path, Headroom::Subject subject, const Unit& length_unit,
                        double seconds, const SensitivityProgress& progress, const std::stop_token& stop) {
  const Problem problem = without_time(stated);
  path.timing.reset();
  CaseSensitivity result;
  result.segments = path.segments();
  result.verdict = path_verdict(problem, path, stop);
  const auto of_stage = [&](const char* stage) {
    return [&progress, stage](std::size_t done, std::size_t all) {
      if (progress) progress(stage, done, all);
    };
  };
  {
    const TimeBudget budget(0.5 * seconds, stop);
    result.headroom =
        find_headroom(problem, path, result.verdict, "", of_stage("seeking provable shares"), budget.token());
    result.headroom.subject = subject;
  }
  const TimeBudget budget(0.5 * seconds, stop);
  result.sensitivity =
      find_sensitivity(problem, path, result.verdict, length_unit.factor, of_stage("trying changes"), budget.token());
  return result;
}

}  // namespace

CaseSensitivity plan_sensitivity(const Case& the_case, double seconds, const SensitivityProgress& progress,
                                 const std::stop_token& stop) {
  Planner planner(the_case);
  const auto planning = [&](const PlanProgress& at) {
    if (progress) progress("planning", static_cast<std::size_t>(at.charts), 0);
  };
  const Plan plan = planner.plan(planning, stop);
  const bool is_found = !plan.refuted_waypoint && !plan.undecided_waypoint &&
                        (plan.proof.verdict != Verdict::kUndecided || plan.proof.open_segment >= 0);
  Path path = plan.path;
  if (!is_found) {
    path = {};
    path.waypoints = query_waypoints(the_case.problem);
  }
  return examine(the_case.problem, path, is_found ? Headroom::Subject::kPath : Headroom::Subject::kStraightWay,
                 the_case.units.length, seconds, progress, stop);
}

CaseSensitivity audit_sensitivity(const Case& the_case, PathSource& source, double seconds,
                                  const SensitivityProgress& progress, const std::stop_token& stop) {
  if (source.segments() > kMostReported) {
    throw InputError(
        fmt::format("{}: got {} segments, expected {} at most", source.name(), source.segments(), kMostReported),
        {source.name()});
  }
  return examine(source.problem(), source.whole_path(), Headroom::Subject::kPath, the_case.units.length, seconds,
                 progress, stop);
}

}  // namespace taut
