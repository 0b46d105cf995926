// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of bodies on their way to the checker and beside certificates.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "case/case_of_legs.h"
#include "checker/check.h"
#include "problem/problem.h"

namespace taut {

/// Supplies the meshes that a problem has, by their digests.
[[nodiscard]] checker::MeshSupplier meshes_of(const Problem& problem);
/// Supplies those of all legs.
[[nodiscard]] checker::MeshSupplier meshes_of(std::span<const CaseLeg> legs);
/// Supplies meshes from files in some folders. It throws InputError where one is not there.
[[nodiscard]] checker::MeshSupplier meshes_in(std::vector<std::filesystem::path> folders);

/// The meshes of a case as files to keep beside a certificate: names and contents.
/// @throws InputError if one cannot be read any more, or has changed
[[nodiscard]] std::vector<std::pair<std::string, std::string>> mesh_files(const Case& the_case);
/// Those of all legs.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> mesh_files(std::span<const CaseLeg> legs);

}  // namespace taut
