// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the way of a proof, or how far it reaches, as plan and audit print it.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "certify/headroom.h"
#include "problem/units.h"

namespace taut {

/// "--headroom": the budget for finding it.
void add_headroom_option(CLI::App& command, double& seconds);

/// Prints the sentences, if it was sought.
void print_headroom(const std::optional<Headroom>& headroom, const Problem& problem, const CaseUnits& units);

/// The JSON of a result; null if it was not sought.
[[nodiscard]] nlohmann::json headroom_json(const std::optional<Headroom>& headroom);

/// "seeking provable shares: 3 of 9"
[[nodiscard]] std::string headroom_progress_text(std::size_t done, std::size_t all);

}  // namespace taut
