// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/explain_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/sanitize.h"
#include "certify/undecided.h"
#include "cli/console.h"

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
          "A waypoint typed at an end of the range: rounding it to binary64 may put it outside by half a unit in "
          "its last place. A path from elsewhere that leaves the range.",
          "Widen the range a little, or move the waypoint inside.",
          "undecided: waypoint 0 of the query: it lies outside the closed range of a parameter, or its nearest "
          "binary64 does [U1].");
    case Undecided::kParameterRange:
      return entry(
          "The motion leaves the range of a parameter, or may",
          "Between two waypoints a parameter could not be shown to stay in its closed range.",
          "A path along an end of the range; with constraints, the true motion bends beyond the straight line.",
          "Widen the range a little, or set waypoints further inside.",
          "open: a parameter leaves its closed range, or may [U2]");
    case Undecided::kUndefined:
      return entry(
          "The pose or an equation is not defined there",
          "An expression of the case's space has no value somewhere on the stretch: a root of a negative number, "
          "a division by zero, asin or acos beyond 1, or a derivative that is infinite there.",
          "A surface that ends there; sqrt(x) or acos(x) at the end of what they are defined for.",
          "Keep the path away from there, by a range of the parameter, or write the pose by expressions that are "
          "defined all around.",
          "open: the pose or an equation is not defined on all of the box [U3]");
    case Undecided::kNoMotion:
      return entry(
          "No single motion was proved to exist",
          "The platform's motion is only implied there, by constraints or by the six cable lengths (or turns by "
          "nearly half a turn at once), and it could not be proved that there is exactly one.",
          "Waypoints far apart; constraints that meet at a flat angle, so that two motions come close; cable "
          "lengths that lead to a singular pose; two orientations half a turn apart.",
          "Set more waypoints in between. In a table of cable lengths it is near a pose beyond which no pose has the "
          "lengths: other lengths, or a start in another assembly.",
          "open: no single motion was proved to exist there (on the constraints, with the cables' lengths, or "
          "between orientations half a turn apart) [U4]");
    case Undecided::kSingular:
      return entry(
          "The force Jacobian is singular, or nearly so",
          "The determinant of the force Jacobian could not be told from zero. At a singular pose the cables "
          "can't balance every load.",
          "The path touches or grazes the singular locus (red in the report's plane), or runs along it. At every "
          "waypoint: an "
          "arrangement of anchors that resists nothing in some direction, such as a level platform whose anchors are "
          "the base's, scaled: no cable then keeps it from turning about the vertical.",
          "Lead the path around it; tensions there are out of every limit in practice. If it is the arrangement, let "
          "the "
          "cables cross in pairs, as in the case that taut init writes: two from each of three places of the base, "
          "to two different ones of the platform.",
          "undecided: waypoint 1 of the query: the force Jacobian is singular, or nearly so, there [U5].");
    case Undecided::kTolerances:
      return entry(
          "The tolerances are too large for a proof here",
          "The stated machine keeps its limits, but with all tolerances at once it could neither be proved nor "
          "refuted that every machine within them does.",
          "A small margin at the place that is named, or tolerances that add up there. Proofs with tolerances "
          "are cautious: they may need some more room than there must be.",
          "Tighten the tolerance that bites (the report says which, for a proved path), widen the limit that is "
          "named, or lead the path through more margin.",
          "open: the tolerances are too large for a proof at margin tension_min of cable 1 [U6]");
    case Undecided::kPrecision:
      return entry(
          "A margin vanishes there, or nearly so",
          "At some pose a tension or a length is at its limit to all digits that were tried: neither inside nor "
          "outside could be proved. Limits themselves count as outside.",
          "A waypoint that lies exactly on a limit; a path that touches a limit without crossing it.",
          "Move the waypoint or the limit by as little as can be measured. taut audit --bits tries more digits.",
          "undecided: waypoint 1 of the query: a margin vanishes there, or nearly so [U7].");
    case Undecided::kDepth:
      return entry("Bisection came to its end",
                   "The stretch was halved as often as the precision allows, and a margin at its end is still open.",
                   "A margin that touches zero between two poses, at a place that is no dyadic number.",
                   "As for U7: move the path or the limit a little.",
                   "open: bisection depth reached at margin length_max of cable 3 [U8]");
    case Undecided::kBoxBudget:
      return entry("The budget of boxes is spent", "One segment took more boxes than a proof is allowed.",
                   "A very long segment very near a limit or a singular pose; hostile numbers.",
                   "Set more waypoints in between; lead the path through more margin.",
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
                   "Impatience.",
                   "Run it again. A budget of time (--budget, planner.max_seconds) ends with the best path so far.",
                   "undecided: interrupted [U11].");
    case Undecided::kNoSegment:
      return entry("The path has no segment", "A single pose is no motion: nothing was claimed.",
                   "A path with fewer waypoints than its law takes, made by other means than taut's commands.",
                   "Give the path as many waypoints as its law takes.", "undecided: the path has no segment [U12].");
    case Undecided::kNoPathFound:
      return entry(
          "No path was found: all that can be reached was searched",
          "Charts cover all that was reached from the start, and the goal is not among it. That is evidence, not "
          "proof, that there is no path.",
          "Start and goal lie in different components of the wrench-feasible poses; or a passage between them is "
          "narrower than the charts.",
          "Look at the report's plane. A smaller planner.radius sees narrower passages; less planner.clearance, wider "
          "limits or a freer space open some.",
          "undecided: no path from waypoint 0 to 1 of the query: the component of the start was covered by 83 "
          "charts of radius 0.15 and the goal was not met; … [U13].");
    case Undecided::kChartBudget:
      return entry(
          "No path was found within the budget of charts", "The search ended at planner.max_charts charts.",
          "A large space of poses (four to six parameters), charts that are small for it, or no path at all.",
          "Raise planner.max_charts, or planner.radius; set waypoints in between; strategy: greedy finds a first "
          "path soonest.",
          "undecided: no path from waypoint 0 to 1 of the query: the budget of 100 charts is spent; … [U14].");
    case Undecided::kTimeBudget:
      return entry("No path was found within the budget of time",
                   "The search ended when planner.max_seconds, or --budget, was over.",
                   "As for U14; a slow or busy machine.", "Give it more time, or as for U14.",
                   "undecided: no path from waypoint 0 to 1 of the query: the budget of 0.1 s is spent; … [U15].");
    case Undecided::kOutsideManifold:
      return entry("A waypoint of the query is infeasible in floating point",
                   "The planner could not begin or end there, although the proof did not refute the waypoint.",
                   "A waypoint at, or very near, a limit or a singular pose.",
                   "taut show prints its tensions, lengths and margins: move it to where all are positive.",
                   "undecided: waypoint 0 or 1 of the query is outside the manifold in floating point [U16].");
    case Undecided::kKernel:
      return entry(
          "The checker's kernel does not confirm the proof",
          "The prover came to a verdict, but found no boxes, or no way to a witness, with which the checker's own "
          "equations confirm it.",
          "A motion very close to a limit or to a singular pose. Where poses are implied by cable lengths or "
          "constraints, a violation to which the motion could not be followed from the path's beginning.",
          "Keep a little more away from limits and singular poses there, or make the tolerances smaller.",
          "open: the checker's kernel does not confirm what was found [U17].");
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
      return entry("The command line", "An option or argument is not what the command takes; nothing was done.",
                   "A misspelt option; two that exclude each other; a value of another kind.",
                   "taut COMMAND --help lists what there is.", "--bits: Value 12 not in range 128 to 1048576 [E1]");
    case ErrorCode::kFile:
      return entry(
          "A file can't be read or written", "The system refused; it says why.",
          "A wrong name, a folder without write permission, a full disk.",
          "Correct the name or the folder. Files are written whole or not at all: what was there before still is.",
          "taut: crane.yaml: could not read: No such file or directory [E2]");
    case ErrorCode::kCase:
      return entry(
          "The case is wrong",
          "The case file can't be used: the message names line and field, what was seen and what was "
          "expected.",
          "A misspelt key; a unit of another kind; limits in the wrong order; an ellipsoid that is not positive "
          "definite; a query outside its space.",
          "docs/case-format.md has every key; taut show prints what was understood; taut init writes a case that is "
          "right.",
          "taut: crane.yaml:38:9: load.mass: got 'NaN', expected a decimal number such as 0.05 or 1e-4 [E3]");
    case ErrorCode::kPath:
      return entry(
          "The path file is wrong", "The path to be audited can't be read, or does not fit the case.",
          "A column without a unit or with an unknown name; a row with a missing number; a repeated pose; lengths "
          "whose first row is not at the start pose.",
          "docs/audits.md lists the forms of files. --allow-repeats drops repeated rows.",
          "taut: path.csv:2: theta: got 'x', expected a decimal number such as 0.05 or 1e-4 [E4]");
    case ErrorCode::kCertificate:
      return entry(
          "No certificate, or not this one",
          "The file is no certificate, was altered or cut after it was written, or is of another version of the "
          "format.",
          "Another file; an edited one; one from a newer or older taut.",
          "Take the file as it was written. One of another version is checked by the taut-check that came with "
          "the taut which made it.",
          "taut: certificate.json: version: got 2, expected 3: only the taut that made it can make its report, or "
          "one of that time [E5]");
    case ErrorCode::kAtlas:
      return entry(
          "The atlas file is refused", "The file belongs to another robot, load, space or planner, or is damaged.",
          "The case was changed since the atlas was saved.",
          "Save it again: taut plan CASE --save-atlas FILE. docs/atlas-file.md says what a file belongs to.",
          "taut: robot1.atlas: the atlas is of another problem: its robot, load or space is not the case's [E6]");
    case ErrorCode::kKey:
      return entry("The key can't sign", "The file of --sign holds no unencrypted Ed25519 private key in PEM.",
                   "A public key; an RSA key; a key with a passphrase.",
                   "openssl genpkey -algorithm ed25519 -out key.pem",
                   "taut: key.pem: got a private key of type RSA, expected an unencrypted Ed25519 private key in PEM "
                   "(openssl genpkey -algorithm ed25519) [E7]");
    case ErrorCode::kBrowser:
      return entry("There is no browser to print with",
                   "taut report --pdf prints the page by a Chromium that you have, and found none.",
                   "None is installed, or TAUT_BROWSER names a program that isn't there.",
                   "Install Debian's package chromium, set TAUT_BROWSER, or print report.html from any browser.",
                   "taut: --pdf: found no browser (chromium, …), expected Chromium: … [E8]");
    case ErrorCode::kRegress:
      return entry("The folder of cases can't be used", "There are no cases in it, or the baseline is no baseline.",
                   "A wrong folder; a baseline that was edited.",
                   "docs/regress.md. --update writes the baseline afresh.",
                   "taut: cases: got no *.yaml, expected a folder of cases [E9]");
  }
  return {};
}

std::string to_text(const Explanation& e) {
  return fmt::format("{}  {}\n\n{}\nUsual causes: {}\nWhat to do: {}\nExample: {}\n", e.code, e.title, e.meaning,
                     e.causes, e.remedy, e.example);
}

std::string to_markdown(const std::vector<Explanation>& all) {
  std::string text =
      "# Messages and their codes\n\nBehind a reason for *undecided* and behind an error stands a short code that "
      "stays the same. "
      "`taut explain` lists them, `taut explain CODE` says what is below.\n"
      "Undecided does not mean unsafe: neither a proof nor a refutation was found.\n\n"
      "*(This page is what `taut explain --markdown` prints.)*\n";
  char family = 0;
  for (const Explanation& e : all) {
    if (e.code[0] != family) {
      family = e.code[0];
      text += family == 'U'   ? "\n## Why something stayed undecided (exit code 2)\n"
              : family == 'E' ? "\n## What is wrong with the input (exit code 3)\n"
                              : "\n## Failures (exit code 4)\n";
    }
    text += fmt::format("\n### {}: {}\n\n{}\n\n- **Usual causes:** {}\n- **What to do:** {}\n- **Example:** `{}`\n",
                        e.code, e.title, e.meaning, e.causes, e.remedy, e.example);
  }
  return text;
}

}  // namespace

const std::vector<Explanation>& explanations() {
  static const std::vector<Explanation> all = [] {
    std::vector<Explanation> result;
    for (std::size_t k = 0; k < kUndecidedReasons; ++k) result.push_back(explained(static_cast<Undecided>(k)));
    for (std::size_t k = 0; k < kErrorCodes; ++k) result.push_back(explained(static_cast<ErrorCode>(k)));
    result.push_back({kInternalCode, "taut failed",
                      "An error of taut itself: a promise that its code makes was broken. Nothing was "
                      "claimed.",
                      "A bug, or memory that ran out.", "Report it, with the case and the whole message.",
                      "taut: internal failure: std::bad_alloc [F1]"});
    result.push_back({kUntrustworthyCode, "The machine can't be trusted with proofs",
                      "Directed rounding does not work as proofs need it; taut refuses to prove anything.",
                      "An emulator that ignores the rounding mode; a build with -ffast-math.",
                      "taut doctor says more. Use another machine, or build as CMake does.",
                      "taut: rounding self-test failed: … [F2]"});
    result.push_back({kBrowserFailedCode, "The browser failed",
                      "The Chromium that was to print the page ended without a whole PDF.",
                      "No memory, a sandbox that the system forbids, or a browser that hangs.",
                      "Its last words are in the message. Print report.html from any browser.",
                      "taut: chromium: no PDF in 300 s [F3]"});
    return result;
  }();
  return all;
}

void add_explain_options(CLI::App& command, ExplainArguments& arguments) {
  command.add_option("CODE", arguments.code, "the code behind a message, such as U3 or E5 (default: list all)");
  command.add_flag("--markdown", arguments.markdown, "print all of them, as docs/errors.md");
}

int run_explain(const ExplainArguments& arguments) {
  if (arguments.markdown) {
    fmt::print("{}", to_markdown(explanations()));
    return kProvedExit;
  }
  if (arguments.code.empty()) {
    for (const Explanation& e : explanations()) fmt::print("{:<4} {}\n", e.code, e.title);
    return kProvedExit;
  }
  std::string wanted = arguments.code;
  if (wanted.starts_with('[') && wanted.ends_with(']')) wanted = wanted.substr(1, wanted.size() - 2);  // as it is shown
  for (char& c : wanted) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto found = std::ranges::find(explanations(), wanted, &Explanation::code);
  if (found == explanations().end()) {
    throw InputError(ErrorCode::kUse, fmt::format("CODE: got '{}', expected one of those that taut explain lists",
                                                  excerpt(arguments.code)));
  }
  fmt::print("{}", to_text(*found));
  return kProvedExit;
}

}  // namespace taut
