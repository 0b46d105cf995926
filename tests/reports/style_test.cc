// SPDX-License-Identifier: GPL-3.0-or-later
// The style sheet's text colours must have a contrast of at least 4.5 to 1 (WCAG 2), in each theme and on paper.
#include "reports/page/style.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace taut {
namespace {

using Colours = std::map<std::string, std::string>;

/// "--name: #rrggbb" of the `index`th block `:root { … }`.
Colours colours(std::size_t index) {
  const std::string style = kStyle;
  std::size_t at = 0;
  for (std::size_t i = 0; i <= index; ++i) at = style.find(":root {", at + 1);
  const std::string block = style.substr(at, style.find('}', at) - at);
  Colours result;
  for (std::size_t i = block.find("--"); i != std::string::npos; i = block.find("--", i + 2)) {
    const std::size_t colon = block.find(':', i);
    const std::size_t hash = block.find_first_not_of(' ', colon + 1);
    if (block[hash] == '#') result[block.substr(i + 2, colon - i - 2)] = block.substr(hash + 1, 6);
  }
  return result;
}

/// WCAG 2: relative luminance of "rrggbb".
double luminance(const std::string& colour) {
  constexpr double kWeights[] = {0.2126, 0.7152, 0.0722};
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = std::stoi(colour.substr(2 * k, 2), nullptr, 16) / 255.0;
    sum += kWeights[k] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(const std::string& a, const std::string& b) {
  const double x = luminance(a) + 0.05;
  const double y = luminance(b) + 0.05;
  return std::max(x, y) / std::min(x, y);
}

TEST(Style, TextCanBeReadInEveryTheme) {
  EXPECT_NEAR(contrast("000000", "ffffff"), 21, 1e-9);
  EXPECT_NEAR(contrast("767676", "ffffff"), 4.54, 0.01);
  const std::vector<std::pair<const char*, const char*>> pairs = {
      {"ink", "paper"},    {"ink", "tile"},      {"soft", "paper"},      {"soft", "tile"},   {"accent", "paper"},
      {"proved", "paper"}, {"refuted", "paper"}, {"undecided", "paper"}, {"limit", "paper"}, {"accent", "tile"}};
  for (std::size_t theme = 0; theme < 3; ++theme) {
    Colours all = colours(theme);
    if (theme == 2) all.merge(colours(0));  // paper has those of the light theme, but for a few
    for (const auto& [text, ground] : pairs) {
      ASSERT_TRUE(all.contains(text) && all.contains(ground)) << theme << text << ground;
      EXPECT_GE(contrast(all.at(text), all.at(ground)), 4.5) << text << " on " << ground << ", theme " << theme;
    }
  }
}

}  // namespace
}  // namespace taut
