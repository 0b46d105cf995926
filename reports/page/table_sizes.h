// SPDX-License-Identifier: GPL-3.0-or-later
// How long the page's tables get.
#pragma once

#include <cstddef>

namespace taut {

inline constexpr std::size_t kLongTable = 14;    ///< rows; longer tables are folded on the screen
inline constexpr std::size_t kMostRows = 300;    ///< of what the appendix lists in full; longer lists are shown in
inline constexpr std::size_t kMostBlocks = 100;  ///< so many rows at most
inline constexpr std::size_t kMostRounded = 60;  ///< rows of what is listed in full before the appendix; longer lists
inline constexpr std::size_t kBlocks = 40;       ///< are shown in so many blocks at most

/// How many of `count` things a row before the appendix stands for.
[[nodiscard]] constexpr std::size_t step_for(std::size_t count) {
  return count <= kMostRounded ? 1 : (count + kBlocks - 1) / kBlocks;
}

}  // namespace taut
