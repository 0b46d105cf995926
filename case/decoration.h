// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that pictures show beside the machine. Nothing checks them, and no claim is about them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
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

/// A mesh that a case names, and where it stands: a point x of the file is at `turn` x + `at`.
struct MeshFile {
  std::string name;   ///< as the case has it
  std::string where;  ///< in the case file, for messages: "crane.yaml:12:5: decoration.frame.mesh: "
  std::filesystem::path path;
  std::array<std::array<double, 3>, 3> turn;  ///< by rows, times the file's unit [m]
  std::array<double, 3> at;                   ///< [m]
};

/// As a case states it. The case can be read, compared and proved about without these files.
struct DecorationFiles {
  std::optional<MeshFile> frame, payload;
};

/// Reads the meshes. @throws InputError naming the place in the case, where a file can't be read, is no mesh, or is
/// more than a picture can show
[[nodiscard]] Decoration read_meshes(const DecorationFiles& files);

/// Whether a picture can show it: numbers within the bounds above, and indices that have a corner.
[[nodiscard]] bool is_shown_body(const ShownBody& body);

}  // namespace taut
