// SPDX-License-Identifier: GPL-3.0-or-later
// What a case says of bodies: what may not touch what, and how far apart it has to stay. The key `bodies` is not read
// by load_case() yet; read_bodies() is called with its node.
//
// --- For docs/case-format.md, when the key is registered ---
//
// ## bodies
//
// Optional. Bodies that may not touch each other: what is on the platform, what stands still (obstacles), and the
// cables. What is proved then is that, all along the path, for every machine, load and pose within the tolerances, the
// two bodies of every checked pair are farther apart than their clearance.
//
//     bodies:
//       clearance: {default: 200 mm, cables-cables: 20 mm, cables-platform: 10 mm}
//       cables: {diameter: 28 mm, free_ends: [0.5, 0.4]}
//       platform:
//         - {name: deck, box: [2, 1.6, 0.2], at: [0, 0, -0.15]}
//         - {name: container, box: [2.4, 6.1, 2.6], at: [0, 0, -2.2]}
//       obstacles:
//         - {name: floor, half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}
//         - {name: stack, box: [2.4, 6.1, 2.6], at: [0, 1, 1.3], yaw: 10}
//         - {name: post, capsule: {from: [7, 5, 0], to: [7, 5, 6], radius: 0.15}}
//
// - `platform`, `obstacles`: lists of bodies, at most 64 each. A body of the platform, its payload for one, is given in
//   the platform's axes and moves with it; an obstacle is given in the world's axes. Each has a `name` of its own
//   ("cable 1" to "cable 6" are those of the cables) and exactly one shape:
//   - `box: [x, y, z]`: its three sides, centred at the body's origin.
//   - `ball: {radius, at}`: `at` is [0, 0, 0] unless stated.
//   - `capsule: {from, to, radius}`: all points within the radius of the segment between two points.
//   - `cylinder: {from, to, radius}`: with flat ends. A prism of 16 sides around it takes its place, which is proved to
//     contain it; `taut show` says how much farther it reaches, about 2 % of the radius.
//   - `points: [[x, y, z], …]` and perhaps `radius`: all points within the radius of the convex hull of 1 to 1000
//     points; the radius is 0 unless stated.
//   - `half_space: {point, normal}`: all that is behind the plane through the point; the normal, of any length, points
//     out of the body, to where the machine is. Only among the obstacles, and without `at` and `rotation`.
//   - `mesh: FILE` and `unit`: the triangles of an STL, OBJ or PLY file, at most 64 MB and 10^6 of them. The file has
//     no unit; `unit` is that of its coordinates. Its SHA-256 is a part of the problem.
//
//   `at` places the body's origin (0 unless stated), and `rotation: {roll, pitch, yaw}`, or `yaw` alone, turns it: a
//   point x is at + Rz(yaw) Ry(pitch) Rx(roll) x. A `clearance` of the body's own takes the place of its class's.
// - `cables: {diameter, free_ends}`: a diameter, or six. `free_ends` are lengths near the base's anchor and near the
//   platform's that are not checked, a length for both, a pair, or six pairs: near its anchors a cable touches what it
//   is fixed to, and other cables with the same anchor. Without `cables`, cables are not checked.
// - `clearance`: one length for all classes, or a map with the keys `default` and those of the classes. 0 means that
//   bodies may come as near as they will, but not touch.
// - `pairs`: which classes of pairs are checked, of `platform-obstacles`, `cables-obstacles`, `cables-cables` and
//   `cables-platform`. Unless stated, all of those for which there are bodies.
// - `pair_clearances: [{pair: [stack, container], clearance: 0.5}, …]`: the clearance of single pairs. It goes before
//   those of the two bodies, of which the greater one counts, and before those of classes.
//
// An obstacle that contains a cable's base anchor so deep that the free end is all inside, or a body of the platform
// that contains a platform anchor so, is an error: that cable would always touch it. Meshes are not examined for that.
// ---
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
/// case_file.cc will have, behind the robot, and with "bodies" among the keys of a case:
///   if (const auto field = map.find("bodies")) {
///     result.bodies = read_bodies(*field, units, folder, result.problem.robot);
///     result.problem.bodies = result.bodies->text;
///   }
///
/// @param folder  of the case file: names of meshes are relative to it
/// @param robot   its anchors are decimals; bodies that contain them deeper than free ends are refused
/// @throws InputError with file, line, field, the value seen and what was expected; FieldError, of which Places knows
/// the place, for what validate(BodiesText) rejects
[[nodiscard]] CaseBodies read_bodies(const Field& field, const Units& units, const std::filesystem::path& folder,
                                     const RobotText& robot);

}  // namespace case_fields
}  // namespace taut
