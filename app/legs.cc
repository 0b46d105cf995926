// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/legs.h"

#include <utility>

#include "app/meshes.h"
#include "base/clock.h"
#include "certificate/legs.h"

namespace taut {
namespace {

PlannedLeg plan_leg(const Case& leg, const PlannedCaseOptions& options, const Progress& progress,
                    const std::stop_token& stop) {
  const auto begin = Clock::now();
  Planner planner(leg);
  PlannedLeg result{plan_case(leg, planner, options, progress, stop), {}, 0};
  const Plan& plan = result.planned.plan;
  if (plan.proof.verdict == Verdict::kProved) result.lengths = planner.measure(plan.path);
  std::string& text = result.planned.text;
  if (text.ends_with('\n')) text.pop_back();  // so that it can stand in a list
  result.seconds = seconds_since(begin);
  return result;
}

}  // namespace

PlannedLegs plan_legs(std::span<const CaseLeg> legs, PlannedCaseOptions options,
                      const std::function<void(std::size_t)>& at_leg, const Progress& progress,
                      const std::stop_token& stop) {
  options.is_checked = false;  // once, with the whole
  options.no_path_seconds = 0;
  PlannedLegs result;
  std::vector<std::string> texts;
  for (const CaseLeg& leg : legs) {
    at_leg(result.legs.size());
    result.legs.push_back(plan_leg(leg.content, options, progress, stop));
    texts.push_back(result.legs.back().planned.text);
  }
  result.text = legs_certificate_text(texts, options.key);
  result.checked =
      recheck(result.text, options.max_seconds, stop.stop_requested() ? std::stop_token() : stop, meshes_of(legs));
  require_confirmed(result.checked);
  for (std::size_t k = 0; k < result.legs.size(); ++k) result.legs[k].planned.checked = result.checked.legs.at(k);
  return result;
}

}  // namespace taut
