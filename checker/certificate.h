// A certificate as data: read from JSON with every rule of docs/certificate-format.md about form, before anything is proved.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "checker/expression.h"

namespace taut::checker {

inline constexpr int kCables = 6;

enum class Verdict { kProved, kRefuted, kUndecided };
enum class Kind { kReal, kPeriodic, kRange };

struct Limits {
  mpq_class lower;
  mpq_class upper;
};

struct Parameter {
  std::string name;
  Kind kind = Kind::kReal;
  Expression lower;  ///< constant; of kRange only
  Expression upper;
};

/// How far a machine may be from what a problem says of it: "tolerances" in the format. All but `wrench` are >= 0.
struct Tolerances {
  std::array<mpq_class, kCables> base_anchors;                 ///< |a_i' - a_i| <= [m]
  std::array<mpq_class, kCables> platform_anchors;             ///< |b_i' - b_i| <= [m]
  mpq_class load_point;                                        ///< |p_m' - p_m| <= [m]
  std::array<mpq_class, 6> wrench;                             ///< w0' = w0 + t wrench, |t| <= 1 [N, N m]
  mpq_class position;                                          ///< tracking: |p' - p| <= [m]
  Expression orientation;                                      ///< tracking: a constant below 1 [rad]
  std::optional<std::array<mpq_class, kCables>> cable_length;  ///< where the machine is held by lengths [m]
};

struct Problem {
  std::array<std::array<mpq_class, 3>, kCables> base_anchors;      ///< a_i in W [m]
  std::array<std::array<mpq_class, 3>, kCables> platform_anchors;  ///< b_i in P [m]
  std::array<Limits, kCables> tension;                             ///< [N]
  std::array<Limits, kCables> length;                              ///< [m]
  std::array<mpq_class, 3> load_point;                             ///< p_m in P [m]
  std::array<mpq_class, 6> wrench;                                 ///< w0 about P_m: force [N], moment [N m]
  std::array<std::array<mpq_class, 6>, 6> ellipsoid;               ///< E, symmetric
  std::optional<Tolerances> tolerances;
  std::vector<Parameter> parameters;
  std::optional<std::array<int, 2>> flip;
  std::array<Expression, 6> pose;              ///< px py pz [m], phi theta sigma [rad]
  std::vector<Expression> constraints;         ///< C: 0 along the path; fewer than the parameters
  std::vector<std::vector<Expression>> query;  ///< constants, one a parameter; none in an audit
};

/// Parameters that a space with constraints may have.
inline constexpr std::size_t kMaxConstrainedParameters = 6;

struct Waypoint {
  /// One a parameter [m, rad]; of a law of poses px, py, pz [m], qx, qy, qz, qw, and L_1 to L_6 [m] where these are straight.
  std::vector<double> x;
  std::vector<int> half_turns;
  std::vector<double> normals;  ///< N by rows: one row a parameter, one column a constraint
  bool operator==(const Waypoint&) const = default;
};

enum class Interpolation { kStraight, kCubicBSpline, kGeodesic, kCableLengths };

/// Whether waypoints are poses, not parameters of the problem's space.
inline bool has_poses(Interpolation law) {
  return law == Interpolation::kGeodesic || law == Interpolation::kCableLengths;
}

/// The numbers r_p [m] and r_u that bound where the pose is sought that lengths imply.
struct PoseTube {
  double position = 0;
  double turn = 0;
};

/// A point that the reference passes between two waypoints.
struct InnerPose {
  mpq_class s;                ///< in (0, 1)
  std::array<double, 7> x{};  ///< px, py, pz [m], qx, qy, qz, qw
  PoseTube tube;              ///< from here to the next
};

/// The first of them beyond s.
inline std::vector<InnerPose>::const_iterator first_after(const std::vector<InnerPose>& inner, const mpq_class& s) {
  return std::upper_bound(inner.begin(), inner.end(), s,
                          [](const mpq_class& x, const InnerPose& y) { return x < y.s; });
}

struct Path {
  Interpolation interpolation = Interpolation::kStraight;
  std::vector<Waypoint> waypoints;
  std::vector<double> tubes;  ///< one a segment where the space has constraints, else none
  std::vector<PoseTube>
      pose_tubes{};  ///< one a segment under the law of cable lengths, else none: up to its first inner pose
  std::vector<std::vector<InnerPose>> inner_poses{};  ///< likewise, by rising s

  [[nodiscard]] std::size_t control_points() const { return interpolation == Interpolation::kCubicBSpline ? 4 : 2; }
  [[nodiscard]] std::size_t segments() const {
    return waypoints.size() < control_points() ? 0 : waypoints.size() - control_points() + 1;
  }
  /// The control points of segment k; a path of a single waypoint is one motionless segment of a single one.
  [[nodiscard]] std::span<const Waypoint> controls(std::size_t k) const {
    return std::span(waypoints).subspan(k, segments() == 0 ? 1 : control_points());
  }
};

struct Box {
  mpq_class begin;
  mpq_class end;
};

struct Margins {
  mpq_class tension;       ///< [N]
  mpq_class length;        ///< [m]
  mpq_class wrench_scale;  ///< [1]
};

struct Segment {
  std::vector<Box> boxes;
  Margins margins;
};

/// Whether the cables' lengths are what a controller commands, not the pose.
inline bool is_held_by_lengths(const Problem& problem, const Path& path) {
  return path.interpolation == Interpolation::kCableLengths || (problem.tolerances && problem.tolerances->cable_length);
}

enum class WitnessKind { kTensionMin, kTensionMax, kLengthMin, kLengthMax, kSingular };

/// ℓ(s) of a segment.
struct Place {
  std::size_t segment = 0;
  mpq_class s;
};

/// Of the machine at a witness from what the problem states: what is added to its numbers.
struct WitnessDeviation {
  std::array<std::array<mpq_class, 3>, kCables> base_anchors;
  std::array<std::array<mpq_class, 3>, kCables> platform_anchors;
  std::array<mpq_class, 3> load_point;
  mpq_class wrench;  ///< how many times the tolerance of the wrench
  std::array<mpq_class, 3> position;
  std::array<mpq_class, 3> turn;  ///< u: the rotation of the quaternion (u, 1)
  /// Where the machine is held by lengths: what is added to these [m].
  std::optional<std::array<mpq_class, kCables>> cable_lengths = std::nullopt;
};

struct Witness {
  WitnessKind kind = WitnessKind::kSingular;
  Place at;
  Place to;       ///< kSingular only; the others use what follows
  int cable = 0;  ///< 0 to 5
  mpq_class value_lower;
  mpq_class value_upper;
  std::optional<WitnessDeviation> deviation;
};

/// A part of an audited path that is not proved.
struct Stretch {
  Place begin;
  Place end;
  std::vector<Witness> inner;  ///< none where it is open, else its first and last violation that are proved
};

struct Certificate {
  Verdict verdict = Verdict::kUndecided;
  Problem problem;
  Path path;
  std::vector<Segment> segments;
  std::array<std::string, 3> margins;  ///< top level, as written: tension_N, length_m, wrench_scale
  std::optional<Witness> witness;
  std::vector<Stretch> stretches;
  std::string undecided_reason;
  std::size_t boxes = 0;
};

/// JSON with duplicate keys, fractional numbers, trailing text, NUL bytes, a byte order mark and nesting beyond 32
/// refused.
/// @throws Malformed
[[nodiscard]] nlohmann::json parse_json(const std::string& text);

/// SHA-256 of the canonical form of `value`, 64 lower-case hex digits.
[[nodiscard]] std::string digest(const nlohmann::json& value);

/// Of the free coordinates px py pz phi theta sigma, as `problem.space` has it where the path has a law of poses.
[[nodiscard]] const nlohmann::json& coordinate_space();

/// Reads and checks form: keys, types, counts, digests, claim text, boxes that tile [0, 1], limits in order, E
/// symmetric, boxes and stretches that tile the path, periodic parameters along which pose and constraints close,
/// normals and tubes of the right sizes, the top-level margins those of the worst segments. Proves nothing about the
/// robot.
/// @throws Malformed naming the key.
[[nodiscard]] Certificate read_certificate(const nlohmann::json& json);

}  // namespace taut::checker
