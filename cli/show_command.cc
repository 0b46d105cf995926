// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/show_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "case/case_of_legs.h"
#include "cli/console.h"
#include "cli/output.h"
#include "reports/page/robot_drawing.h"
#include "reports/summary/case_summary.h"

namespace taut {

void add_show_options(CLI::App& command, ShowArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md)")->required();
  command.add_option("--out", arguments.out,
                     "draw the robot at the first waypoint, of the first leg, into this SVG file");
  command.add_flag("--json", arguments.json, "print it as JSON, in SI units");
}

int run_show(const ShowArguments& arguments) {
  if (!arguments.out.empty() && !arguments.out.ends_with(".svg")) {
    throw InputError(ErrorCode::kUse,
                     fmt::format("--out: got '{}', expected a file that ends in .svg", excerpt(arguments.out)));
  }
  if (!arguments.out.empty()) require_another(arguments.out, arguments.case_path);
  const CaseOfLegs the_case = load_case_of_legs(arguments.case_path);
  for (const std::string& warning : the_case.whole.warnings) complain("warning: " + warning);
  const std::vector<CaseSummary> summaries = summaries_of(the_case);
  if (!arguments.out.empty()) write_whole({{arguments.out, robot_drawing(summaries.front())}});
  if (arguments.json) {
    nlohmann::json document = to_json(the_case, summaries);
    document["command"] = "show";
    print_json(document);
  } else {
    fmt::print("{}", sanitize_lines(to_text(the_case, summaries)));
    if (!arguments.out.empty()) fmt::print("\nWritten: {}\n", sanitize(arguments.out));
  }
  return kProvedExit;
}

}  // namespace taut
