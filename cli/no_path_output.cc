// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/no_path_output.h"

#include "app/no_path.h"
#include "app/recheck.h"

namespace taut {

std::optional<std::string> no_path_certificate(const Case& the_case, const std::stop_token& stop) {
  SeparationOptions options;
  options.seconds = kNoPathSeconds;
  options.stop = stop;
  NoPathAttempt attempt = seek_no_path(the_case, options);
  if (attempt.answer != NoPathAttempt::Answer::kApart) return std::nullopt;
  const checker::CheckResult checked = recheck(attempt.certificate, kCheckSeconds, stop);
  require_confirmed(checked);
  if (!checked.theorem) return std::nullopt;
  return std::move(attempt.certificate);
}

}  // namespace taut
