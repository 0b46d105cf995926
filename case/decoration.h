// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that pictures show beside the machine. Nothing checks them, and no claim is about them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace taut {

struct ShownBody {
  std::vector<std::array<double, 3>> corners;           ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of corners
  bool operator==(const ShownBody&) const = default;
};

/// What a picture can show without growing beyond all use.
inline constexpr std::size_t kMostShownTriangles = 20'000;  ///< of one body
inline constexpr double kFarthestShown = 1e6;               ///< of a corner, in each coordinate [m]

struct Decoration {
  std::optional<ShownBody> frame;    ///< what the base anchors are on, in the axes of the base
  std::optional<ShownBody> payload;  ///< what moves with the platform, in the axes of the platform
  bool operator==(const Decoration&) const = default;
};

/// Whether a picture can show it: numbers within the bounds above, and indices that have a corner.
[[nodiscard]] bool is_shown_body(const ShownBody& body);

}  // namespace taut
