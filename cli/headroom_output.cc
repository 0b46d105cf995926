// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/headroom_output.h"

#include <fmt/format.h>

#include <string_view>

#include "app/headroom.h"
#include "cli/number_option.h"
#include "reports/summary/headroom_summary.h"

namespace taut {

namespace {

/// Lines of at most 120 columns; all but the first are indented.
std::string wrapped(const std::string& sentence) {
  constexpr std::size_t kColumns = 120;
  std::string result;
  std::string_view rest = sentence;
  for (std::size_t width = kColumns; rest.size() > width; width = kColumns - 2) {
    const std::size_t space = rest.rfind(' ', width);
    if (space == std::string_view::npos) break;
    result += std::string(rest.substr(0, space)) + "\n  ";
    rest.remove_prefix(space + 1);
  }
  return result + std::string(rest);
}

}  // namespace

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
    fmt::print("{}\n", wrapped(sentence));
  }
}

nlohmann::json headroom_json(const std::optional<Headroom>& headroom) {
  return headroom ? to_json(*headroom) : nlohmann::json();
}

std::string headroom_progress_text(std::size_t done, std::size_t all) {
  return fmt::format("seeking provable shares: {} of {}", done, all);
}

}  // namespace taut
