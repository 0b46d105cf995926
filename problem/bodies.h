// SPDX-License-Identifier: GPL-3.0-or-later
// What may not touch: bodies on the platform, bodies that stand still, cables, and how far apart they have to be.
//
// A body is a set of points. One that stands still, an obstacle, is fixed in the world's axes W; a body of the
// platform, which may be its payload, is fixed in the platform's axes P. A point x of a body is, in those axes,
//   at + Rz(yaw) Ry(pitch) Rx(roll) x.                                                                            (1)
// The body "cable i" is made of the segment from A_i to B_i: of those points of it that are at least
// `free_ends_m[i][0]` from A_i and at least `free_ends_m[i][1]` from B_i, all points within half its diameter.
//
// A pair is two bodies of one of four classes. A class for which the problem states a clearance is checked: all its
// pairs have to be farther apart than their clearance. Numbers are exact decimals, as in the rest of a problem.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/json_cursor.h"
#include "problem/text.h"
#include "problem/triangle_mesh.h"

namespace taut {

using PointText = std::array<DecimalText, 3>;

/// All points within `radius_m` >= 0 of the convex hull of 1 to kMaxHullPoints points [m].
struct HullText {
  std::vector<PointText> points_m;
  DecimalText radius_m = "0";
  bool operator==(const HullText&) const = default;
};
/// All points x of W with n·(x − at) <= 0: the normal n, of any length but 0, points out of the body. Only an obstacle,
/// and without a rotation.
struct HalfSpaceText {
  PointText normal;
  bool operator==(const HalfSpaceText&) const = default;
};
/// The triangles of a file. Its coordinates are binary64 numbers times the unit.
struct MeshText {
  std::string file;    ///< as the case names it
  std::string sha256;  ///< of the file's bytes: 64 lower-case hex digits
  DecimalText unit_m;  ///< > 0 [m]
  /// What the file holds; null until it was read (case/mesh_file.h). No part of the problem's text, in which the digest
  /// stands for it.
  std::shared_ptr<const IndexedMesh> mesh = nullptr;
  bool operator==(const MeshText& other) const {
    return file == other.file && sha256 == other.sha256 && unit_m == other.unit_m;
  }
};

struct BodyText {
  std::string name;  ///< a label (base/labels.h), unique among all bodies, and no cable's name
  /// If given, the least clearance of the pairs that this body is in [m].
  std::optional<DecimalText> clearance_m = {};
  PointText at_m{"0", "0", "0"};  ///< `at` of (1) [m]; of a half-space, a point of its plane
  std::array<ExpressionText, 3> rotation_rad{"0", "0", "0"};  ///< roll, pitch, yaw of (1): constants [rad]
  std::variant<HullText, HalfSpaceText, MeshText> shape;
  bool operator==(const BodyText&) const = default;
};

struct CableBodiesText {
  std::array<DecimalText, kCables> diameter_m{"0", "0", "0", "0", "0", "0"};  ///< >= 0 [m]
  /// What is not checked of cable i: lengths >= 0 near A_i and near B_i [m].
  std::array<std::array<DecimalText, 2>, kCables> free_ends_m{
      {{"0", "0"}, {"0", "0"}, {"0", "0"}, {"0", "0"}, {"0", "0"}, {"0", "0"}}};
  bool operator==(const CableBodiesText&) const = default;
};

enum class PairClass {
  kPlatformObstacles,
  kCablesObstacles,
  kCablesCables,
  kCablesPlatform,
  kExitCones,  ///< a cable and an exit cone of its own; not one of those that have clearances
};
inline constexpr std::size_t kPairClasses = 4;  ///< that have clearances
[[nodiscard]] constexpr std::array<PairClass, kPairClasses> all_pair_classes() {
  using enum PairClass;
  return {kPlatformObstacles, kCablesObstacles, kCablesCables, kCablesPlatform};
}
/// "platform-obstacles", "cables-obstacles", "cables-cables", "cables-platform", "exit-cones".
[[nodiscard]] const char* name(PairClass kind);

/// The clearance of one pair, in place of any other.
struct PairClearanceText {
  std::array<std::string, 2> pair;  ///< two bodies, of which one may be a cable or both, in either order
  DecimalText clearance_m;          ///< >= 0 [m]
  bool operator==(const PairClearanceText&) const = default;
};

/// Where a body of the platform may touch an obstacle, such as a load the ground that it stands on: while the
/// platform's origin is no farther than `within_m` from `at_m`, the two may overlap by less than `depth_m`.
struct ContactZoneText {
  PointText at_m;        ///< in W [m]
  DecimalText within_m;  ///< > 0 [m]
  DecimalText depth_m;   ///< > 0 [m]
  bool operator==(const ContactZoneText&) const = default;
};
struct ContactText {
  std::array<std::string, 2> pair;  ///< a body of the platform and an obstacle, in either order; neither is a mesh
  ContactZoneText zone;
  bool operator==(const ContactText&) const = default;
};

enum class CableEnd { kBase, kPlatform };
[[nodiscard]] const char* name(CableEnd end);  ///< "base" or "platform"

/// Where the other end of a cable has to be as seen from this one, such as from a sheave that swivels so far only: the
/// vector d from the cable's anchor here to its other anchor makes an angle t with the axis that is less than the
/// half-angle a. The distance of this pair is |d| sin(a − t), that of the other anchor from the cone's surface; its
/// clearance is 0.
struct ExitConeText {
  std::size_t cable = 0;           ///< 0 to 5
  CableEnd end = CableEnd::kBase;  ///< at most one cone of each end
  PointText axis;                  ///< of any length but 0, out of this end: of W at the base, of P at the platform
  ExpressionText half_angle_rad;   ///< a constant, above 0 and below pi/2
  bool operator==(const ExitConeText&) const = default;
};

inline constexpr std::size_t kMaxContacts = 64;
inline constexpr std::size_t kMaxBodies = 64;  ///< of the platform, and as many obstacles
inline constexpr std::size_t kMaxHullPoints = 1000;

struct BodiesText {
  std::vector<BodyText> platform;   ///< at most kMaxBodies
  std::vector<BodyText> obstacles;  ///< at most kMaxBodies
  CableBodiesText cables;
  /// Of each PairClass the clearance of its pairs, >= 0 [m]; if there is none, the class is not checked.
  std::array<std::optional<DecimalText>, kPairClasses> clearance_m;
  std::vector<PairClearanceText> pair_clearances_m;  ///< of pairs that are checked, each at most once
  std::vector<ContactText> contacts;                 ///< of pairs that are checked; at most kMaxContacts
  std::vector<ExitConeText> exit_cones;              ///< all are checked
  bool operator==(const BodiesText&) const = default;
};

/// Two bodies that have to be farther apart than the clearance; or, while the platform's origin is in a zone, than
/// minus its depth, minus the greatest where zones overlap. The distance of bodies that overlap is minus the length of
/// the shortest translation of one of them after which they don't.
struct BodyPair {
  PairClass kind = PairClass::kPlatformObstacles;
  std::size_t first = 0;   ///< index of a platform body (kPlatformObstacles) or of a cable
  std::size_t second = 0;  ///< index of an obstacle, a cable (> first), a platform body or an exit cone
  DecimalText clearance_m;
  std::vector<ContactZoneText> zones = {};
  bool operator==(const BodyPair&) const = default;
};

/// The pairs that are checked, class by class, the first body's index in the outer loop, and then the exit cones in
/// their order; certificates count them so.
/// The clearance of a pair is its entry of `pair_clearances_m` if it has one, else the greatest of its two bodies' own
/// if one has any, else that of its class. @pre validate(bodies)
[[nodiscard]] std::vector<BodyPair> pairs(const BodiesText& bodies);

/// "cable 3", for i = 2.
[[nodiscard]] std::string cable_name(std::size_t i);
/// The names of the pair's first and second body.
[[nodiscard]] std::array<std::string, 2> names(const BodiesText& bodies, const BodyPair& pair);
/// "container / stack", "cable 3 / stack", "cable 2 / cable 5", "cable 3 / container", "cable 3 / exit cone at the
/// base".
[[nodiscard]] std::string name(const BodiesText& bodies, const BodyPair& pair);

/// Checks all that the types above promise, and that pairs with a clearance or a zone of their own exist and are
/// checked. What is wrong with a body is named "bodies.obstacles[NAME].radius". @throws FieldError
void validate(const BodiesText& bodies);

/// Whether each mesh of the bodies was read.
[[nodiscard]] bool are_meshes_read(const BodiesText& bodies);

/// The member `bodies` of a problem: "platform" and "obstacles", lists of bodies, "cables", "clearance_m", an object
/// with a member for each class that is checked, and, unless there are none, "pair_clearances_m", "contacts" and
/// "exit_cones".
[[nodiscard]] nlohmann::json to_json(const BodiesText& bodies);
/// Inverse of to_json, without validating. @throws FieldError
[[nodiscard]] BodiesText bodies_from_json(const JsonCursor& value);

}  // namespace taut
