// SPDX-License-Identifier: GPL-3.0-or-later
// What a case says of bodies (docs/case-format.md, "bodies"): what may not touch what, and how far apart it has to
// stay.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "case/mesh_file.h"
#include "problem/bodies.h"
#include "problem/problem.h"

namespace taut {

/// A cylinder, in whose place the problem has a prism around it.
struct EnclosedCylinder {
  std::string body;      ///< its name
  DecimalText excess_m;  ///< no point of the prism is farther than this from the cylinder [m]
};

/// A mesh of a problem, as it was read.
struct MeshOfBody {
  std::string body;  ///< its name
  std::shared_ptr<const LoadedMesh> mesh;
  std::filesystem::path path;  ///< of its file
};

/// The bodies of a case: the exact problem, and what people should know of how it was made.
struct CaseBodies {
  BodiesText text;  ///< valid
  std::vector<EnclosedCylinder> cylinders;
  std::vector<MeshOfBody> meshes;
};

namespace case_fields {

class Field;
class Units;

/// Reads the node of `bodies`, at the path "bodies", and the meshes that it names.
///
/// @param folder  of the case file: names of meshes are relative to it
/// @param robot   its anchors are decimals; bodies that contain them deeper than free ends are refused
/// @throws InputError with file, line, field, the value seen and what was expected; FieldError, of which Places knows
/// the place, for what validate(BodiesText) rejects
[[nodiscard]] CaseBodies read_bodies(const Field& field, const Units& units, const std::filesystem::path& folder,
                                     const RobotText& robot);

}  // namespace case_fields
}  // namespace taut
