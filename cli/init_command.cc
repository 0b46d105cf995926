// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/init_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "cli/console.h"
#include "cli/new_case_text.h"

namespace taut {

std::string new_case(const std::string& name) {
  constexpr std::string_view kPlaceholder = "NAME";
  std::string text = kNewCaseText;
  for (std::size_t at = text.find(kPlaceholder); at != std::string::npos; at = text.find(kPlaceholder, at)) {
    text.replace(at, kPlaceholder.size(), name);
    at += name.size();
  }
  return text;
}

int run_init(const std::string& path) {
  std::error_code unknown;  // then writing it says why
  if (std::filesystem::exists(path, unknown))
    throw InputError(ErrorCode::kUse, path + ": got a file that exists, expected a new one", {path});
  std::string name = std::filesystem::path(path).stem().string();
  const bool is_plain = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
  });
  if (name.empty() || !is_plain || name.size() > 100) name = "new-case";
  write_whole({{path, new_case(name)}});
  fmt::print("Written: {0}. Change it to your machine, then: taut plan {0}\n", sanitize(path));
  return kProvedExit;
}

}  // namespace taut
