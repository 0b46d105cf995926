// SPDX-License-Identifier: GPL-3.0-or-later
// Counts in words.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace taut {

/// "1 box", "2 boxes".
[[nodiscard]] inline std::string plural(std::size_t count, std::string_view noun) {
  const bool hisses = noun.ends_with('x') || noun.ends_with("ch");
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : hisses ? "es" : "s");
}

}  // namespace taut
