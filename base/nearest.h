// SPDX-License-Identifier: GPL-3.0-or-later
// Which known word a misspelt one may mean.
#pragma once

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace taut {

/// Number of insertions, deletions and replacements that turn one word into the other.
[[nodiscard]] inline std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

/// The known word nearest to `seen`, unless it differs by more than a slip of typing.
[[nodiscard]] inline std::optional<std::string> nearest_word(const std::string& seen,
                                                             const std::vector<std::string>& known) {
  constexpr std::size_t kMostSlips = 3;
  constexpr std::size_t kLongestWord = 100;  // a longer one is no slip
  if (known.empty() || seen.size() > kLongestWord) return std::nullopt;
  const auto nearest =
      std::ranges::min_element(known, {}, [&](const std::string& word) { return edit_distance(word, seen); });
  const std::size_t most = std::min(kMostSlips, (seen.size() + 2) / 2);
  return edit_distance(*nearest, seen) <= most ? std::optional(*nearest) : std::nullopt;
}

}  // namespace taut
