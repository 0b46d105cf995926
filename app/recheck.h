// What the independent checker says of a certificate that this program wrote or reports: run here, so that nobody forgets to.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "reports/summary/report_options.h"

namespace taut {

/// @param boxes   boxes and witnesses: checking takes a time in proportion
/// @param wanted  whether to check; nothing: where it takes a few seconds at most.
/// Stopped, it was not run, and says so. @throws std::exception where the checker itself fails.
[[nodiscard]] Recheck recheck(const std::string& text, std::size_t boxes, bool has_tolerances,
                              std::optional<bool> wanted, const std::stop_token& stop);

/// The same, of a certificate of unknown make: what it takes is told by what is in it.
[[nodiscard]] Recheck recheck(const std::string& text, const nlohmann::json& certificate, std::optional<bool> wanted,
                              const std::stop_token& stop);

/// One line for the terminal.
[[nodiscard]] std::string sentence(const Recheck& recheck);
[[nodiscard]] nlohmann::json to_json(const Recheck& recheck);

/// Of a certificate that this program has just written: prover and checker disagree about nothing, or one of them has a bug.
/// @throws std::logic_error where the checker rejects it.
void require_confirmed(const Recheck& recheck);

/// "2024-02-29": today in UTC, or the day of SOURCE_DATE_EPOCH where that is set. @throws InputError where that is no number.
[[nodiscard]] std::string report_date();

}  // namespace taut
