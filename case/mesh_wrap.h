// SPDX-License-Identifier: GPL-3.0-or-later
// A closed mesh around a mesh, which may have holes, cross itself and be of many parts (CGAL's alpha_wrap_3).
//
// That the wrap contains what it is around is proved here, on the numbers of the file that is written, by CGAL's exact
// predicates: it is closed and does not cross itself, none of its triangles meets an element of the mesh, and a point
// of each part of the mesh that hangs together is inside. So a path from any point of the mesh, or from one that the
// mesh has inside, to infinity meets the wrap.
#pragma once

#include <string>

#include "problem/triangle_mesh.h"

namespace taut {

/// Lengths in the unit of the mesh.
struct WrapOptions {
  double alpha = 0;   ///< > 0: gaps that are narrower than about twice this are closed
  double offset = 0;  ///< > 0: how far the wrap stays from the mesh
};

struct MeshWrap {
  std::string file;     ///< the bytes of a mesh file
  IndexedMesh mesh;     ///< what they say; is_watertight()
  double farthest = 0;  ///< of a corner of the wrap from the mesh, about, in its unit
  double volume = 0;    ///< that is inside, about, in its unit's cube
};

/// The diagonal of the box around a mesh, in its unit.
[[nodiscard]] double diagonal(const TriangleMesh& mesh);

/// @param extension  ".stl", ".obj" or ".ply": of the file to be written, as text
/// @throws InputError where the wrap does not contain the mesh, and where there are too many triangles in it
[[nodiscard]] MeshWrap wrap(const TriangleMesh& mesh, const WrapOptions& options, const std::string& extension);

}  // namespace taut
