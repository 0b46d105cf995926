// SPDX-License-Identifier: GPL-3.0-or-later
// layers CASE.yaml: a query's waypoints judged by the prover itself, and a plan by the library.
#include <taut/taut.h>

#include <iostream>

#include "atlas/atlas.h"
#include "case/case_file.h"
#include "certify/arithmetic/rounding.h"
#include "certify/path_proof.h"
#include "checker/check.h"
#include "reports/page/html_report.h"

int main(int argc, char** argv) {
  if (argc != 2) return 3;
  taut::rounding_self_test();
  const taut::Case robot = taut::load_case(argv[1]);
  const taut::Prover prover(robot.problem);
  for (const taut::Waypoint& waypoint : taut::query_waypoints(robot.problem)) {
    taut::Reason undecided;
    if (taut::refute_waypoint(prover, waypoint, 0, undecided) || !undecided.empty()) return 1;
  }
  const taut::v0::Certificate certificate = taut::v0::plan(taut::v0::Case::load(argv[1]));
  const taut::checker::CheckResult checked = taut::checker::check(certificate.text());
  std::cout << checked.message << "\n";
  return checked.outcome == taut::checker::Outcome::kAccepted ? 0 : 1;
}
