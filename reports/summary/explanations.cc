// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/explanations.h"

namespace taut {

namespace {

Explanation explained(Undecided reason) {
  const auto entry = [&](const char* title, const char* meaning, const char* causes, const char* remedy,
                         const char* example) {
    return Explanation{code(reason), title, meaning, causes, remedy, example};
  };
  switch (reason) {
    case Undecided::kWaypointRange:
      return entry(
          "A waypoint is outside the range of a parameter, or may be",
          "The case gives a parameter a closed range, and a waypoint could not be shown to lie in it.",
          "A waypoint typed at an end of the range, which rounding to binary64 may put outside by half a unit in its "
          "last place. A path from elsewhere that leaves the range.",
          "Widen the range a little, or move the waypoint inside.",
          "undecided: waypoint 0 of the query: it lies outside the closed range of a parameter, or its nearest "
          "binary64 does: px is 1.7, its range is from -1.5 to 1.1 (SI: m, rad) [U1].");
    case Undecided::kParameterRange:
      return entry(
          "The motion leaves the range of a parameter, or may",
          "Between two waypoints, a parameter could not be shown to stay in its closed range.",
          "A path along an end of the range. In a space with constraints, a motion that bends away from the straight "
          "line between waypoints.",
          "Widen the range a little, or set waypoints further inside.",
          "open: a parameter leaves its closed range, or may [U2]");
    case Undecided::kUndefined:
      return entry(
          "The pose or an equation is not defined there",
          "An expression of the case's space has no value somewhere on the stretch: it takes the root of a negative "
          "number, divides by zero, or takes asin or acos of a number beyond 1; or its derivative is infinite there.",
          "A surface that ends there. sqrt(x) or acos(x) at the end of the range in which it is defined.",
          "Keep the path away from there by giving the parameter a range, or write the pose with expressions that are "
          "defined everywhere around the path.",
          "open: the pose or an equation is not defined on all of the box [U3]");
    case Undecided::kNoMotion:
      return entry(
          "No single motion was proved to exist",
          "The platform's motion is given only indirectly there, by constraints or by the six cable lengths (or it "
          "turns by nearly half a turn at once), and it could not be proved that exactly one such motion exists.",
          "Waypoints far apart. Constraints that meet at a small angle, so that two motions come close. Cable lengths "
          "that lead to a singular pose. Two orientations half a turn apart.",
          "Set more waypoints in between. In a table of cable lengths, this happens near a pose beyond which no pose "
          "has the lengths: use other lengths, or start in another assembly of the robot.",
          "open: no single motion was proved to exist there (on the constraints, with the cables' lengths, or "
          "between orientations half a turn apart) [U4]");
    case Undecided::kSingular:
      return entry(
          "The force Jacobian is singular, or nearly so",
          "The determinant of the force Jacobian could not be told from zero. At a singular pose the cables can't "
          "balance every load.",
          "The path touches or grazes the singular locus (red in the report's plane), or runs along it. If it happens "
          "at every waypoint, the anchors are arranged so that nothing resists some motion. An example is a level "
          "platform whose anchors are a scaled copy of the base's: no cable then keeps it from turning about the "
          "vertical.",
          "Lead the path around it: close to a singular pose, tensions exceed every limit. If the arrangement is the "
          "cause, let the cables cross in pairs, as in the case that taut init writes: two cables from each of three "
          "places of the base, to two different places of the platform.",
          "undecided: waypoint 1 of the query: the force Jacobian is singular, or nearly so, there [U5].");
    case Undecided::kTolerances:
      return entry(
          "The tolerances are too large for a proof of this margin",
          "The machine as stated keeps its limits. That every machine within all the tolerances keeps the named margin "
          "could be neither proved nor refuted.",
          "A small margin at the place that is named, or tolerances whose effects add up there; or rows of a table "
          "that "
          "are far apart (time.between_rows). Proofs with tolerances are cautious: they may need a little more margin "
          "than "
          "the machine does.",
          "Read the lines that begin \"In the way\": they name cable, limit, place and amount, and which share of the "
          "tolerances is provable. taut sensitivity seeks changes that prove the path, at rest. Of rows, state a "
          "higher "
          "time.rate, or lower limits of the winches' acceleration.",
          "open: the tolerances are too large for a proof at margin tension_min of cable 1 [U6]");
    case Undecided::kPrecision:
      return entry(
          "A margin vanishes there, or nearly so",
          "At some pose, a tension or a length equals its limit to all digits that were tried, so that it could be "
          "proved neither inside nor outside. The limits themselves count as outside.",
          "A waypoint exactly on a limit. A path that touches a limit without crossing it.",
          "Move the waypoint or the limit by the smallest amount that can be measured. taut audit --bits tries more "
          "digits.",
          "undecided: waypoint 1 of the query: a margin vanishes there, or nearly so [U7].");
    case Undecided::kDepth:
      return entry("Bisection came to its end",
                   "The stretch was halved as often as the precision allows, and a margin is still open in what is "
                   "left of it.",
                   "A margin that is zero between two poses, at a place that is not a dyadic number.",
                   "Move the path or the limit a little, as for U7.",
                   "open: bisection depth reached at margin length_max of cable 3 [U8]");
    case Undecided::kBoxBudget:
      return entry("The budget of boxes is spent", "One segment took more boxes than a proof is allowed.",
                   "A very long segment very near a limit or a singular pose. Numbers chosen to be difficult.",
                   "Set more waypoints in between, or lead the path through poses with more margin.",
                   "open: the budget of boxes is spent [U9]");
    case Undecided::kClearance:
      return entry(
          "Closer to a limit than the clearance asked for",
          "While planning, an edge is refused that comes closer to a limit than planner.clearance, although it may be "
          "feasible.",
          "A clearance that is large for this robot.", "Lower planner.clearance.",
          "closer to a limit than the clearance asked for [U10]");
    case Undecided::kInterrupted:
      return entry("Interrupted", "Somebody pressed Ctrl-C, or sent a signal, before there was a verdict.",
                   "A run that took longer than expected.",
                   "Run it again. With a budget of time (--budget, planner.max_seconds), planning ends with the best "
                   "path found so far.",
                   "undecided: interrupted [U11].");
    case Undecided::kNoSegment:
      return entry("The path has no segment", "A single pose is not a motion, so nothing was claimed.",
                   "A path with fewer waypoints than its law needs, made by other means than taut's commands.",
                   "Give the path as many waypoints as its law needs.", "undecided: the path has no segment [U12].");
    case Undecided::kNoPathFound:
      return entry(
          "No path was found: all that can be reached was searched",
          "The charts cover everything that was reached from the start, and the goal is not in it. This is evidence, "
          "not proof, that there is no path.",
          "Start and goal lie in different components of the wrench-feasible poses, or a passage between them is "
          "narrower than the charts.",
          "Look at the report's plane. A smaller planner.radius finds narrower passages; a smaller planner.clearance, "
          "wider limits or a freer space may open one.",
          "undecided: no path from waypoint 0 to 1 of the query: the component of the start was covered by 83 "
          "charts of radius 0.15 and the goal was not met; … [U13].");
    case Undecided::kChartBudget:
      return entry(
          "No path was found within the budget of charts", "The search ended at planner.max_charts charts.",
          "A large space of poses (four to six parameters), charts that are small for it, or no path at all.",
          "Raise planner.max_charts or planner.radius, or set waypoints in between. The strategy greedy finds a first "
          "path soonest.",
          "undecided: no path from waypoint 0 to 1 of the query: the budget of 100 charts is spent; … [U14].");
    case Undecided::kTimeBudget:
      return entry("No path was found within the budget of time",
                   "The search ended when the time of planner.max_seconds, or of --budget, was over.",
                   "The causes of U14, or a slow or busy machine.", "Allow more time, or do what U14 suggests.",
                   "undecided: no path from waypoint 0 to 1 of the query: the budget of 0.1 s is spent; … [U15].");
    case Undecided::kOutsideManifold:
      return entry("A waypoint of the query is infeasible in floating point",
                   "The planner could not begin or end there, although the proof did not refute the waypoint.",
                   "A waypoint at, or very near, a limit or a singular pose.",
                   "taut show prints the waypoint's tensions, lengths and margins. Move it to where all margins are "
                   "positive.",
                   "undecided: waypoint 0 or 1 of the query cannot be held within the limits, in floating point "
                   "[U16].");
    case Undecided::kKernel:
      return entry(
          "The checker's kernel does not confirm the proof",
          "The prover came to a verdict, but found no boxes, or no way to a witness, with which the checker's own "
          "equations confirm it.",
          "A motion very close to a limit or to a singular pose. In a space with constraints, or under the law of "
          "cable "
          "lengths, a violation to which the motion could not be followed from the path's beginning.",
          "Keep the path a little further from limits and singular poses there, or make the tolerances smaller.",
          "open: the checker's kernel does not confirm what was found [U17].");
    case Undecided::kBodies:
      return entry(
          "Bodies were not proved to stay apart",
          "Two bodies come so near to their clearance that no proof of either verdict was found, a deviation within "
          "the tolerances may bring them nearer, or a cable may be shorter than its free ends.",
          "A path that just touches a clearance; tolerances that use up what is free; cables that meet at an anchor "
          "with free ends that are too short; free ends that are together longer than a cable.",
          "Keep the path further from the bodies named, or state a smaller clearance or smaller tolerances; longer "
          "free ends of cables that meet, shorter ones of cables that may be shorter than these.",
          "open: bodies were not proved to stay apart: cable 1 / cable 2 [U18].");
    case Undecided::kSlowing:
      return entry(
          "A limit may not be kept while the move is slowed down",
          "At its full speed the move keeps its limits at this place. While it is slowed down to rest, or up again, "
          "within the stated time, a tension or an acceleration may not be within its limit. No place was found where "
          "it is proved to be beyond it, either.",
          "A time.may_stop that is short for this machine: braking takes more than its limits allow.",
          "State a longer time.may_stop, or run the move at a lower speed.",
          "open: a limit may not be kept while the move is slowed down [U19]");
  }
  return {};
}

Explanation explained(ErrorCode code) {
  const auto entry = [&](const char* title, const char* meaning, const char* causes, const char* remedy,
                         const char* example) {
    return Explanation{text(code), title, meaning, causes, remedy, example};
  };
  switch (code) {
    case ErrorCode::kUse:
      return entry("The command line", "An option or argument is not one that the command takes. Nothing was done.",
                   "A misspelt option. Two options that exclude each other. A value of another kind.",
                   "taut COMMAND --help lists the options.", "--bits: Value 12 not in range 128 to 1048576 [E1]");
    case ErrorCode::kFile:
      return entry(
          "A file can't be read or written", "The system refused; the message says why.",
          "A wrong name, a folder without write permission, a full disk.",
          "Correct the name or the folder. Files are written whole or not at all, so an earlier file is still there.",
          "taut: crane.yaml: could not read: No such file or directory [E2]");
    case ErrorCode::kCase:
      return entry(
          "The case is wrong",
          "The case file, or the robot's file from which taut init should make one, can't be used. The message names "
          "line and field, what was seen and what was expected.",
          "A misspelt key. A unit of another kind of quantity. Limits in the wrong order. An ellipsoid that is not "
          "positive definite. A query outside its space.",
          "docs/case-format.md describes every key. taut show prints what was understood, and taut init writes a case "
          "that is right.",
          "taut: crane.yaml:38:9: load.mass: got 'NaN', expected a decimal number such as 0.05 or 1e-4 [E3]");
    case ErrorCode::kPath:
      return entry("The path file is wrong",
                   "The path to be audited, or the table of measurements, can't be read, or does not fit the case.",
                   "A column without a unit or with an unknown name. A row with a missing number. Lengths "
                   "whose first row is not at the start pose.",
                   "docs/audits.md describes the formats of path files, docs/monitor.md that of measurements.",
                   "taut: path.csv:2: theta: got 'x', expected a decimal number such as 0.05 or 1e-4 [E4]");
    case ErrorCode::kCertificate:
      return entry(
          "No certificate, or not this one",
          "The file is not a certificate, was altered or cut after it was written, or has another version of the "
          "format.",
          "A wrong file. A certificate that was edited, or that was made by a newer or older taut.",
          "Use the file as it was written. If it has another version, check it with the taut-check that belongs to the "
          "taut which made it.",
          "taut: certificate.json: version: got 3, expected 4: only the taut that made it can make its report, or "
          "one of that time [E5]");
    case ErrorCode::kAtlas:
      return entry(
          "The atlas file is refused", "The file belongs to another robot, load, space or planner, or is damaged.",
          "The case was changed after the atlas was saved.",
          "Save the atlas again: taut plan CASE --save-atlas FILE. docs/atlas-file.md says which cases a file fits.",
          "taut: robot1.atlas: the atlas is of another problem: its robot, load or space is not the case's [E6]");
    case ErrorCode::kKey:
      return entry("The key can't sign",
                   "The file given to --sign does not hold an unencrypted Ed25519 private key in PEM.",
                   "A public key, an RSA key, or a key with a passphrase.",
                   "Make a key: openssl genpkey -algorithm ed25519 -out key.pem",
                   "taut: key.pem: got a private key of type RSA, expected an unencrypted Ed25519 private key in PEM "
                   "(openssl genpkey -algorithm ed25519) [E7]");
    case ErrorCode::kBrowser:
      return entry(
          "There is no browser to print with",
          "taut report --pdf and taut map --png draw with an installed Chromium, and found none.",
          "None is installed, or TAUT_BROWSER names a program that does not exist.",
          "Install Debian's package chromium, set TAUT_BROWSER, or open report.html or map.svg in any browser.",
          "taut: --pdf: found no browser (chromium, …), expected Chromium: … [E8]");
    case ErrorCode::kRegress:
      return entry(
          "The folder of cases can't be used", "There are no cases in it, or the baseline file is not a baseline.",
          "A wrong folder. A baseline that was edited.", "See docs/regress.md. --update writes the baseline again.",
          "taut: cases: got no *.yaml, expected a folder of cases [E9]");
  }
  return {};
}

}  // namespace

const std::vector<Explanation>& explanations() {
  static const std::vector<Explanation> all = [] {
    std::vector<Explanation> result;
    for (std::size_t k = 0; k < kUndecidedReasons; ++k) result.push_back(explained(static_cast<Undecided>(k)));
    for (std::size_t k = 0; k < kErrorCodes; ++k) result.push_back(explained(static_cast<ErrorCode>(k)));
    result.push_back({kInternalCode, "taut failed",
                      "taut itself failed: a check in its own code did not hold. Nothing was claimed.",
                      "A bug, or memory that ran out.", "Report it, with the case and the whole message.",
                      "taut: internal failure: std::bad_alloc [F1]"});
    result.push_back({kUntrustworthyCode, "The machine can't be trusted with proofs",
                      "Directed rounding does not work as proofs need it, so taut refuses to prove anything.",
                      "An emulator that ignores the rounding mode. A build with -ffast-math.",
                      "taut doctor says more. Use another machine, or build as CMake does.",
                      "taut: rounding self-test failed: … [F2]"});
    result.push_back({kBrowserFailedCode, "The browser failed",
                      "Chromium was started to print the page, and ended without a complete PDF.",
                      "No memory, a sandbox that the system forbids, or a browser that hangs.",
                      "The message quotes the browser's last output. Print report.html from any browser instead.",
                      "taut: chromium: no PDF in 300 s [F3]"});
    return result;
  }();
  return all;
}

const Explanation* explanation_of(std::string_view text) {
  const std::optional<Undecided> reason = undecided_reason(text);
  return reason ? &explanations()[static_cast<std::size_t>(*reason)] : nullptr;
}

}  // namespace taut
