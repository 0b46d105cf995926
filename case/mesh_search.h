// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for the file of a mesh that a problem names, beside a case or a certificate.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "case/mesh_file.h"

namespace taut {

/// The name under which a mesh is kept beside a certificate: that of its file, without folders. @param is_taken  by
/// another mesh: then the digest's beginning comes before it.
[[nodiscard]] std::string mesh_name_beside(const std::string& file, const std::string& sha256, bool is_taken = false);

/// The mesh of the file with this digest in one of some folders: under the name that the problem has for it, where
/// that does not leave the folder, or under mesh_name_beside().
/// @throws InputError naming file, digest and folders, and for a file that is no mesh
[[nodiscard]] LoadedMesh find_mesh(const std::vector<std::filesystem::path>& folders, const std::string& file,
                                   const std::string& sha256);

}  // namespace taut
