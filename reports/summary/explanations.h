// SPDX-License-Identifier: GPL-3.0-or-later
// What the short code behind a message means, what usually causes it and what to do: for `taut explain`, of which
// docs/errors.md is a print, and for reports.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "certify/undecided.h"

namespace taut {

inline constexpr const char* kInternalCode = "F1";
inline constexpr const char* kUntrustworthyCode = "F2";
inline constexpr const char* kBrowserFailedCode = "F3";

struct Explanation {
  std::string code;
  const char* title;    ///< what is wrong or open, in a few words
  const char* meaning;  ///< sentences
  const char* causes;
  const char* remedy;
  const char* example;  ///< a line that a program prints
};

/// All explanations: reasons of "undecided" (certify/undecided.h), kinds of wrong input, failures.
[[nodiscard]] const std::vector<Explanation>& explanations();

/// That of the reason which the text of a message or certificate states; null if it states none.
[[nodiscard]] const Explanation* explanation_of(std::string_view text);

}  // namespace taut
