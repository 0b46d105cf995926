// SPDX-License-Identifier: GPL-3.0-or-later
// The independent checker, called on a certificate that this program wrote or reports: its theorem is the verdict.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>

#include "checker/check.h"

namespace taut {

/// How long the checker may take if nobody says [s]. A check takes about as long as the proof did.
inline constexpr double kCheckSeconds = 300;
/// The longest certificate that `taut audit` has checked: the checker takes some fifteen times as much memory.
inline constexpr std::uintmax_t kMostCheckedBytes = std::uintmax_t{128} << 20U;

/// What the checker says of a certificate's bytes: "unchecked" if it is asked to stop.
/// @param max_seconds  the budget; 0: the certificate is read, and unchecked where it claims anything.
/// @param meshes  where the certificate's problem may have some (app/meshes.h)
[[nodiscard]] checker::CheckResult recheck(const std::string& bytes, double max_seconds, const std::stop_token& stop,
                                           const checker::MeshSupplier& meshes = {});

/// The result for a certificate that is too long to be checked here.
[[nodiscard]] checker::CheckResult too_long_to_check();

/// "proved", "refuted" or "no path" where there is a theorem, "undecided" where nothing is claimed, else "unchecked".
/// @pre neither rejected nor malformed.
[[nodiscard]] const char* verdict_name(const checker::CheckResult& checked);

/// One line for the terminal.
[[nodiscard]] std::string sentence(const checker::CheckResult& checked);
/// result, checker and message, as in a summary.
[[nodiscard]] nlohmann::json to_json(const checker::CheckResult& checked);

/// For a certificate that this program has just written: if the checker rejects it, prover or checker has a bug.
/// @throws std::logic_error where the checker rejects it.
void require_confirmed(const checker::CheckResult& checked);

}  // namespace taut
