// SPDX-License-Identifier: GPL-3.0-or-later
// The exact problem: robot, load, space of poses and query, as exact decimals and expressions in SI units.
//
// A Problem is the meaning of a case file, after units are resolved and before anything is rounded. It is written into
// every certificate (docs/certificate-format.md, "problem"), and every number in it is still the decimal that the user
// typed, scaled exactly. kinematics/model.h makes scalars of any kind (doubles, intervals, multiprecision) from it.
// validate() evaluates waypoints and ranges in binary64 to find mistakes; nothing else here is computed in floating
// point.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "problem/bodies.h"
#include "problem/loads.h"
#include "problem/text.h"
#include "problem/time.h"

namespace taut {

/// An open interval of admissible values; lower < upper.
struct Limits {
  DecimalText lower;
  DecimalText upper;
  bool operator==(const Limits&) const = default;
};

struct RobotText {
  std::array<std::array<DecimalText, 3>, kCables> base_anchors_m;      ///< a_i in W [m]
  std::array<std::array<DecimalText, 3>, kCables> platform_anchors_m;  ///< b_i in P [m]
  std::array<Limits, kCables> tension_N;                               ///< 0 <= lower < upper [N]
  std::array<Limits, kCables> length_m;                                ///< 0 <= lower < upper [m]
};

/// E, symmetric positive definite [1/N^2, 1/(N m)^2]; 1/36 is no decimal.
using EllipsoidText = std::array<std::array<RationalText, 6>, 6>;

/// The set K of wrenches: the sum of the items and of { w0 + e : e' E e <= 1 }, where there is an E. There are items,
/// or there is an E, or both.
struct LoadText {
  std::array<DecimalText, 3> point_m;                               ///< p_m in P [m]
  std::array<DecimalText, 6> wrench{"0", "0", "0", "0", "0", "0"};  ///< w0: force [N], moment about P_m [N m], in W
  std::optional<EllipsoidText> ellipsoid;                           ///< if there is none, w0 is 0
  std::string ellipsoid_name;                                       ///< as items have one; empty: none was stated
  RationalVector gravity_m_s2{"0", "0", "0"};                       ///< in W; of the items that are weights
  std::vector<LoadItem> items;
};

/// How far the machine may deviate from the robot, the load and the path. All are >= 0; distances and angles hold in
/// any direction. The theorem is in docs/theory.md, "Tolerances".
struct TolerancesText {
  std::array<DecimalText, kCables> base_anchor_m{"0", "0", "0", "0", "0", "0"};      ///< |a_i' − a_i| <= [m]
  std::array<DecimalText, kCables> platform_anchor_m{"0", "0", "0", "0", "0", "0"};  ///< |b_i' − b_i| <= [m]
  DecimalText load_point_m = "0";                                                    ///< |p_m' − p_m| <= [m]
  std::array<DecimalText, 6> wrench{"0", "0", "0", "0", "0", "0"};  ///< w0' = w0 + τ wrench, |τ| <= 1 [N, N m]
  DecimalText position_m = "0";                                     ///< tracking: |p' − p| <= [m]
  ExpressionText orientation_rad = "0";  ///< tracking: the angle between R' and R, a constant below 1 [rad]
  /// If given, the machine is controlled by its cables' lengths, each of which is within this of the commanded length
  /// [m]. A path that is not given in lengths commands those that the robot, exactly as typed, has along it.
  std::optional<std::array<DecimalText, kCables>> cable_length_m;
};

enum class ParameterKind { kReal, kPeriodic, kRange };

struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::kReal;
  ExpressionText range_lower;  ///< constant expressions; empty unless kRange. SI.
  ExpressionText range_upper;
};

/// How three angles give R_WP, the rotation from the platform's axes to the world's. Rx, Ry and Rz are rotations about
/// fixed coordinate axes, products act from the right.
enum class AngleKind {
  kTiltAndTorsion,  ///< phi, theta, sigma: Rz(phi) Ry(theta) Rz(sigma - phi)
  kRollPitchYaw,    ///< roll, pitch, yaw: Rz(yaw) Ry(pitch) Rx(roll)
  kZyz,             ///< alpha, beta, gamma, Euler's angles: Rz(alpha) Ry(beta) Rz(gamma)
  kAxis,            ///< turn, about a fixed axis
};

struct AnglesText {
  AngleKind kind = AngleKind::kTiltAndTorsion;
  std::array<DecimalText, 3> axis{"0", "0", "1"};  ///< for kAxis: its direction, of any length but 0
  bool operator==(const AnglesText&) const = default;
};

/// Poses (p, R) as a function of the parameters.
struct SpaceText {
  std::vector<Parameter> parameters;
  std::map<std::string, DecimalText> constants;
  AnglesText angles;
  /// Indices of the parameters that are phi and theta themselves, if (phi, theta) and (phi + pi, -theta) are the same
  /// pose; no constraint mentions them then. Only of tilt-and-torsion angles.
  std::optional<std::array<int, 2>> flip;
  /// px, py, pz [m] and the angles [rad]; the last two are "0" for kAxis, which has one angle.
  std::array<ExpressionText, 6> pose;
  /// C of the paper's (15), each of which must be 0. There are fewer than parameters, and C' has full rank along a
  /// path.
  std::vector<ExpressionText> constraints;
};

/// The largest number of parameters of a space with constraints.
inline constexpr int kMaxConstrainedParameters = 6;

/// The name of a parametrisation, in case files and messages: "tilt-and-torsion", "roll-pitch-yaw", "zyz", "axis".
[[nodiscard]] const char* name(AngleKind kind);
/// For sentences: "tilt-and-torsion angles", "ZYZ Euler angles".
[[nodiscard]] const char* angles_text(AngleKind kind);
/// The names of a pose's coordinates: px, py, pz and three angles, or one for kAxis.
[[nodiscard]] std::vector<std::string> pose_names(AngleKind kind);

struct Problem {
  std::string name;
  RobotText robot;
  LoadText load;
  std::optional<TolerancesText> tolerances;
  SpaceText space;
  /// Waypoints of the query: one constant expression for each parameter (SI). There are none in an audit of a path from
  /// elsewhere.
  std::vector<std::vector<ExpressionText>> query;
  /// What may not touch, if anything is said of that.
  std::optional<BodiesText> bodies;
  /// What a move along a path may do in time, if anything is said of that: then a plan is a move.
  std::optional<TimeText> time = {};
};

/// What a message may add where `word` is a coordinate of other angles than `chosen`: "which is understood with
/// 'angles: roll-pitch-yaw' …, ". It ends with a space; empty where there is nothing to add.
[[nodiscard]] std::string angles_hint(const std::string& word, AngleKind chosen);

/// Whether coordinate i of a pose is an angle whose values 2π apart are the same pose, whatever the others are, and is
/// therefore periodic where it is a parameter.
[[nodiscard]] bool is_turn(AngleKind kind, std::size_t i);

/// The space of all poses with such angles: px, py, pz [m] and the angles [rad], without bounds. Of kAxis, all those
/// that are turned about the axis.
[[nodiscard]] SpaceText coordinate_space(const AnglesText& angles = {});

/// Checks all that the types above promise: decimals, 0 <= lower < upper, six different cables, a load with items or
/// with an E that is symmetric and positive definite (exactly), no tolerances of the load beside items, expressions
/// that parse, poses that by their form agree after a turn of a periodic parameter, a correct `flip`, tolerances >= 0,
/// bodies (problem/bodies.h), and either no waypoints or at least two, with one finite value for each parameter, within
/// its range up to rounding. Limits in time (problem/time.h) go with a load of which some has a mass; only with them
/// have weights a box of inertia.
/// @throws FieldError
void validate(const Problem& problem);

/// The problem of the path alone: without limits in time, and with weights of which only the centre of gravity counts.
[[nodiscard]] Problem without_time(Problem problem);

/// The `problem` object of a certificate.
[[nodiscard]] nlohmann::json to_json(const Problem& problem);
/// Inverse of to_json. @throws FieldError naming the key for anything missing, unknown, or of the wrong type, and for
/// everything that validate() rejects.
[[nodiscard]] Problem problem_from_json(const nlohmann::json& value);

}  // namespace taut
