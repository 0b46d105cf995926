// SPDX-License-Identifier: GPL-3.0-or-later
// The exact problem: robot, load, space of poses and query, as exact decimals and expressions in SI units.
//
// A Problem is what a case file means, after units are resolved and before anything is rounded. It is written
// into every certificate (docs/certificate-format.md, "problem") and every number of it is still the decimal that the
// user typed, scaled exactly. ProofScalarTraits of any kind (double, intervals, multiprecision) are made from it by
// model.h; nothing here computes with floating point.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/input_error.h"

namespace taut {

inline constexpr int kCables = 6;

/// A decimal literal such as "-0.0210" or "1e-4": exactly that rational number.
using DecimalText = std::string;
/// An expression in the grammar of docs/certificate-format.md.
using ExpressionText = std::string;

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

struct LoadText {
  std::array<DecimalText, 3> point_m;                   ///< p_m in P [m]
  std::array<DecimalText, 6> wrench;                    ///< w0: force [N], moment about P_m [N m], axes of W
  std::array<std::array<DecimalText, 6>, 6> ellipsoid;  ///< E, symmetric positive definite [1/N^2, 1/(N m)^2]
};

/// How far the machine may be from what the robot, the load and the path say. Distances and angles >= 0, in any direction.
/// docs/theory.md, "Tolerances", has the theorem.
struct TolerancesText {
  std::array<DecimalText, kCables> base_anchor_m{"0", "0", "0", "0", "0", "0"};      ///< |a_i' − a_i| <= [m]
  std::array<DecimalText, kCables> platform_anchor_m{"0", "0", "0", "0", "0", "0"};  ///< |b_i' − b_i| <= [m]
  DecimalText load_point_m = "0";                                                    ///< |p_m' − p_m| <= [m]
  std::array<DecimalText, 6> wrench{"0", "0", "0", "0", "0", "0"};  ///< w0' = w0 + τ wrench, |τ| <= 1 [N, N m]
  DecimalText position_m = "0";                                     ///< tracking: |p' − p| <= [m]
  ExpressionText orientation_rad = "0";  ///< tracking: the angle between R' and R, a constant below 1 [rad]
  /// Where given, the machine is held by its cables' lengths, each within this of what is commanded [m]. A path that is not
  /// given in lengths commands those that the robot, exactly as typed, has along it.
  std::optional<std::array<DecimalText, kCables>> cable_length_m;
};

enum class ParameterKind { kReal, kPeriodic, kRange };

struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::kReal;
  ExpressionText range_lower;  ///< constant expressions; empty unless kRange. SI.
  ExpressionText range_upper;
};

/// Poses (p, R) as a function of the parameters; R = Rz(phi) Ry(theta) Rz(sigma - phi).
struct SpaceText {
  std::vector<Parameter> parameters;
  std::map<std::string, DecimalText> constants;
  /// Indices of the parameters that are phi and theta themselves, where (phi, theta) ~ (phi + pi, -theta); no constraint
  /// mentions them then.
  std::optional<std::array<int, 2>> flip;
  /// px, py, pz [m], phi, theta, sigma [rad].
  std::array<ExpressionText, 6> pose;
  /// C of the paper's (15): poses must make each of them 0. Fewer than the parameters, of full rank along a path.
  std::vector<ExpressionText> constraints;
};

/// Parameters that a space with constraints may have.
inline constexpr int kMaxConstrainedParameters = 6;

inline constexpr std::array<const char*, 6> kPoseNames = {"px", "py", "pz", "phi", "theta", "sigma"};

struct Problem {
  std::string name;
  RobotText robot;
  LoadText load;
  std::optional<TolerancesText> tolerances;
  SpaceText space;
  /// Waypoints of the query: one constant expression a parameter (SI); none where a path is audited that something else made.
  std::vector<std::vector<ExpressionText>> query;
};

/// The space of all poses: px, py, pz [m], phi, theta, sigma [rad], without bounds.
[[nodiscard]] SpaceText coordinate_space();

/// Checks all that the types above promise: decimals, 0 <= lower < upper, six different cables, E symmetric and
/// positive definite (exactly), expressions that parse, poses that plainly agree after a turn of a periodic
/// parameter, a `flip` that is one, tolerances >= 0, and no or at least two waypoints with one finite value a parameter, within its range
/// up to rounding. @throws FieldError
void validate(const Problem& problem);

/// The `problem` object of a certificate.
[[nodiscard]] nlohmann::json to_json(const Problem& problem);
/// Inverse of to_json. @throws FieldError naming the key for anything missing, unknown, or of the wrong type, and
/// whatever `validate` objects to.
[[nodiscard]] Problem problem_from_json(const nlohmann::json& value);

}  // namespace taut
