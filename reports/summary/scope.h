// SPDX-License-Identifier: GPL-3.0-or-later
// What a verdict assumes and what it does not cover: one list of each for the first page, the section behind it, the
// summaries and the assurance case. docs/theory.md, section 11, repeats the sentences.
#pragma once

#include <string>
#include <vector>

#include "certificate/certificate.h"

namespace taut {

struct ScopeItem {
  const char* key;    ///< for machines: "collisions"
  std::string brief;  ///< for a list: "collisions"
  std::string text;   ///< a sentence or two
  std::string goal;   ///< what somebody else has to show: "Nothing collides." Only of what is not covered
};

/// What the machine must be like for the verdict to apply to it.
/// @param is_in_time  of a move in time, with inertia (time_statement.h); else of slow motion, or of standing still
[[nodiscard]] std::vector<ScopeItem> assumed(const Problem& problem, Interpolation law, bool is_in_time = false);
/// What the verdict says nothing about.
[[nodiscard]] std::vector<ScopeItem> not_covered(const Problem& problem, bool is_in_time = false);
/// Both of a certificate.
[[nodiscard]] std::vector<ScopeItem> assumed(const Certificate& certificate);
[[nodiscard]] std::vector<ScopeItem> not_covered(const Certificate& certificate);

/// The items' sentences, one after another.
[[nodiscard]] std::string in_full(const std::vector<ScopeItem>& items);

}  // namespace taut
