// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh file is refused with an InputError, or it is a mesh of finite points and of triangles of them. The input's
// first byte tells the kind of file.
#include "case/mesh_file.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/input_error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut;
  if (size == 0) return 0;
  constexpr std::array<const char*, 3> kExtensions = {".stl", ".obj", ".ply"};
  const std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    const LoadedMesh loaded = repaired(read_polygons(kExtensions[data[0] % kExtensions.size()], bytes));
    for (const auto& point : loaded.mesh.vertices) {
      for (const double x : point) {
        if (!(std::abs(x) <= kFarthestMesh)) __builtin_trap();
      }
    }
    if (loaded.mesh.triangles.empty()) __builtin_trap();
    for (const auto& triangle : loaded.mesh.triangles) {
      for (const std::size_t corner : triangle) {
        if (corner >= loaded.mesh.vertices.size()) __builtin_trap();
      }
    }
  } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): what bad input is for
  }
  return 0;
}
