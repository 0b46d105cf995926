// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/headroom_output.h"

#include <fmt/format.h>

#include "app/headroom.h"
#include "cli/number_option.h"
#include "cli/terminal.h"
#include "reports/summary/headroom_summary.h"

namespace taut {

void add_headroom_option(CLI::App& command, double& seconds) {
  command
      .add_option("--headroom", seconds,
                  fmt::format("seconds for finding the provable shares of tolerances and loads (default: {}; 0: none)",
                              kHeadroomSeconds))
      ->check(number("a number of seconds, 0 or more", [](double value) { return value >= 0; }));
}

void print_headroom(const std::optional<Headroom>& headroom, const Problem& problem, const CaseUnits& units) {
  if (!headroom) return;
  for (const std::string& sentence : headroom_sentences(*headroom, problem, DisplayUnits(units))) {
    print_wrapped(sentence);
  }
}

nlohmann::json headroom_json(const std::optional<Headroom>& headroom) {
  return headroom ? to_json(*headroom) : nlohmann::json();
}

std::string headroom_progress_text(std::size_t done, std::size_t all) {
  return fmt::format("seeking provable shares: {} of {}", done, all);
}

}  // namespace taut
