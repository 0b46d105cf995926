// SPDX-License-Identifier: GPL-3.0-or-later
// Binary STL files for tests.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace taut::testing {

/// A binary STL file that says it holds `count` triangles and holds these corners.
inline std::string binary_stl(std::uint32_t count, const std::vector<float>& corners) {
  std::string text(80, ' ');
  const auto append = [&](std::uint32_t bits, int bytes) {
    for (int i = 0; i < bytes; ++i) text += static_cast<char>((bits >> (8 * i)) & 0xff);
  };
  append(count, 4);
  for (std::size_t i = 0; i < corners.size(); i += 9) {
    for (int k = 0; k < 3; ++k) append(0, 4);  // the normal
    for (std::size_t k = 0; k < 9; ++k) append(std::bit_cast<std::uint32_t>(corners[i + k]), 4);
    append(0, 2);
  }
  return text;
}

}  // namespace taut::testing
