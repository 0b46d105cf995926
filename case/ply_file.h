// SPDX-License-Identifier: GPL-3.0-or-later
// PLY files, of text and binary in both orders of bytes.
//
// CGAL's reader is not used. It makes room for as many corners as a face states, takes a number of a type that it does
// not know for none, reads the next element where a list of faces breaks off, and lets alone what is left. To exclude
// that, the file would have to be followed number by number, which is the work of a reader.
#pragma once

#include <string>

#include "case/mesh_file.h"

namespace taut {

/// The points and faces of a PLY file. Its edges and all other numbers of points and faces are passed over; a file with
/// anything that can't be told apart from a part of the mesh is refused.
/// @throws InputError that says what is wrong with the file, "which …" or "in which …"
[[nodiscard]] PolygonSoup read_ply(const std::string& bytes);

}  // namespace taut
