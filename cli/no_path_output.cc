// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/no_path_output.h"

#include "app/no_path.h"
#include "app/recheck.h"
#include "base/files.h"

namespace taut {

std::vector<std::filesystem::path> write_no_path(const Case& the_case, const std::filesystem::path& out,
                                                 const std::stop_token& stop) {
  SeparationOptions options;
  options.seconds = kNoPathSeconds;
  options.stop = stop;
  const NoPathAttempt attempt = seek_no_path(the_case, options);
  if (attempt.answer != NoPathAttempt::Answer::kApart) return {};
  const checker::CheckResult checked = recheck(attempt.certificate, kCheckSeconds, stop);
  require_confirmed(checked);
  if (!checked.theorem) return {};
  const std::filesystem::path file = out / "certificate.json";
  write_whole({{file, attempt.certificate}});
  return {file};
}

}  // namespace taut
