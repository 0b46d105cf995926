// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel is asked about, as exact numbers: a problem, a path through it, boxes of the path, and deviations.
//
// These are plain data. format/ fills them from a certificate and vouches for their form (sizes, signs, order); the
// kernel proves statements about them. docs/certificate-format.md says what each key means.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "checker/kernel/expression.h"
#include "checker/kernel/surface.h"

namespace taut::checker {

inline constexpr std::size_t kCables = 6;

struct Limits {
  mpq_class lower;
  mpq_class upper;
};

enum class ParameterKind { kReal, kPeriodic, kRange };

struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::kReal;
  Expression lower;  ///< a constant; of kRange only
  Expression upper;  ///< likewise
};

/// How far a machine may be from what a problem says of it, and a load. All but `wrench` are >= 0.
template <class Number, class Angle>
struct Tolerances {
  std::array<Number, kCables> base_anchors;                 ///< |a_i' - a_i| <= [m]
  std::array<Number, kCables> platform_anchors;             ///< |b_i' - b_i| <= [m]
  Number load_point;                                        ///< |p_m' - p_m| <= [m]
  std::array<Number, 6> wrench;                             ///< w0' = w0 + t wrench, |t| <= 1 [N, N m]
  Number position;                                          ///< tracking: |p' - p| <= [m]
  Angle orientation;                                        ///< tracking: of the rotation from R to R', in [0, 1) [rad]
  std::optional<std::array<Number, kCables>> cable_length;  ///< where the machine is length-controlled [m]
};
using ToleranceBounds = Tolerances<mpq_class, Expression>;  ///< the angle is a constant expression

/// How three angles x give R: rotations about fixed coordinate axes, or one about a fixed axis.
enum class AngleKind {
  kTiltAndTorsion,  ///< Rz(x0) Ry(x1) Rz(x2 - x0)
  kRollPitchYaw,    ///< Rz(x2) Ry(x1) Rx(x0)
  kZyz,             ///< Rz(x0) Ry(x1) Rz(x2)
  kAxis,            ///< by x0 about `axis`
};

using ExactVector = std::array<mpq_class, 3>;
using ExactWrench = std::array<mpq_class, 6>;  ///< force [N] and moment [N m]

/// a . b, exactly.
inline mpq_class dot(const ExactVector& a, const ExactVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// m times gravity, for every mass m from mass.lower >= 0 to mass.upper, which may be equal [kg], at every point within
/// `offset` >= 0 of the item's [m].
struct Weight {
  Limits mass;
  mpq_class offset;
  /// In a move: the sides of a box along the axes of P that the mass fills evenly around its centre of gravity; else it
  /// is a point [m].
  std::optional<ExactVector> inertia_box = std::nullopt;
};
/// All forces [N] or moments [N m] of magnitude up to `radius` >= 0; with a normal, which is not 0, those at right
/// angles to it.
struct BallOrDisc {
  bool is_moment = false;
  mpq_class radius;
  std::optional<ExactVector> normal;
};
/// The forces or moments f e / |e| for e = `direction`, not 0, and every f from range.lower to range.upper, which may
/// be equal.
struct LineSegment {
  bool is_moment = false;
  ExactVector direction;
  Limits range;
};
/// The convex hull of one or more wrenches about the item's point.
struct LoadCases {
  std::vector<ExactWrench> wrenches;
};

/// The axes in which a set is fixed: those of the world, or those that turn with the platform.
enum class Axes { kWorld, kPlatform };

using LoadSet = std::variant<Weight, BallOrDisc, LineSegment, LoadCases>;

/// A set of wrenches that act at a point of the platform.
struct LoadItem {
  LoadSet set;
  Axes axes = Axes::kWorld;  ///< of a weight always
  ExactVector at;            ///< c in P [m]; a moment has none
};

/// All points within `radius` >= 0 of the convex hull of one or more points [m].
struct HullShape {
  std::vector<ExactVector> points;
  mpq_class radius;
};
/// All x with normal . x <= 0, for a normal that is not 0, of any length.
struct HalfSpaceShape {
  ExactVector normal;
};
/// The elements of a mesh, and all points inside of it if it is closed. Coordinates are those of the file with this
/// digest, times `unit` > 0 [m].
struct MeshShape {
  std::string file;
  std::string sha256;
  mpq_class unit;
  std::shared_ptr<const Surface> surface = nullptr;  ///< as somebody read that file; null: nobody did
};
/// The points at + Rz(yaw) Ry(pitch) Rx(roll) x of all points x of a shape, in W of an obstacle, in P of a body of the
/// platform.
struct RigidBody {
  std::variant<HullShape, HalfSpaceShape, MeshShape> shape;
  ExactVector at;                      ///< [m]
  std::array<Expression, 3> rotation;  ///< roll, pitch, yaw: constants [rad]; not read of a half-space
};
/// All points within half the diameter of that part of the cable which is at least free_ends[0] from its base anchor
/// and free_ends[1] from its platform anchor. All are >= 0 [m].
struct CableBody {
  mpq_class diameter;
  std::array<mpq_class, 2> free_ends;
};

/// Which two bodies; obstacles may be half-spaces, all others are hulls or meshes.
enum class PairKind {
  kPlatformObstacle,  ///< a body of the platform and an obstacle
  kCableObstacle,
  kCableCable,
  kCablePlatform,  ///< a cable and a body of the platform
  kExitCone,       ///< a cable and an exit cone of its own
};
/// Of a cable's end: |d| sin(half_angle - t) is the distance of such a pair, where d is the vector from the cable's
/// anchor at this end to its other anchor, and t the angle between d and the axis.
struct ExitCone {
  std::size_t cable = 0;
  Axes end = Axes::kWorld;  ///< W: the base's end, with an axis in W; P: the platform's, in P
  ExactVector axis;         ///< not 0
  Expression half_angle;    ///< a constant
};
/// Where bodies may overlap by less than `depth`: with the platform's origin no farther than `within` from `at` [m].
struct ContactZone {
  ExactVector at;  ///< of W
  mpq_class within;
  mpq_class depth;
};
/// Two bodies that have to be farther apart than `clearance` >= 0 [m]; in zones, than minus the greatest depth.
struct CheckedPair {
  PairKind kind = PairKind::kPlatformObstacle;
  std::size_t first = 0;
  std::size_t second = 0;  ///< of kExitCone, an index of `exit_cones`
  mpq_class clearance;
  std::string name{};                ///< "cable 3 / stack"
  std::vector<ContactZone> zones{};  ///< of bodies of the platform and obstacles that are no meshes
};

struct Bodies {
  std::vector<RigidBody> platform;
  std::vector<RigidBody> obstacles;
  std::array<CableBody, kCables> cables;
  std::array<bool, 4> checks{};  ///< by PairKind: whether its pairs are checked
  std::vector<ExitCone> exit_cones;
  std::vector<CheckedPair> pairs;  ///< by rising kind; of one kind by first, then by second body; of cones as stated

  /// The first or the second body of a pair; null where it is a cable.
  [[nodiscard]] const RigidBody* rigid(const CheckedPair& pair, bool is_first) const {
    if (is_first) return pair.kind == PairKind::kPlatformObstacle ? &platform[pair.first] : nullptr;
    if (pair.kind == PairKind::kCableCable || pair.kind == PairKind::kExitCone) return nullptr;
    return pair.kind == PairKind::kCablePlatform ? &platform[pair.second] : &obstacles[pair.second];
  }
  /// The first or the second body of a pair, if it is a mesh; else null.
  [[nodiscard]] const MeshShape* mesh(const CheckedPair& pair, bool is_first) const {
    const RigidBody* const body = rigid(pair, is_first);
    return body == nullptr ? nullptr : std::get_if<MeshShape>(&body->shape);
  }
  [[nodiscard]] bool has_mesh(const CheckedPair& pair) const {
    return mesh(pair, true) != nullptr || mesh(pair, false) != nullptr;
  }

  [[nodiscard]] bool has_meshes() const {
    const auto is_mesh = [](const RigidBody& body) { return std::holds_alternative<MeshShape>(body.shape); };
    return std::ranges::any_of(platform, is_mesh) || std::ranges::any_of(obstacles, is_mesh);
  }

  [[nodiscard]] bool has_zones() const {
    return std::ranges::any_of(pairs, [](const CheckedPair& pair) { return !pair.zones.empty(); });
  }

  /// Whether the second body of a pair is a half-space.
  [[nodiscard]] bool is_against_half_space(const CheckedPair& pair) const {
    return (pair.kind == PairKind::kPlatformObstacle || pair.kind == PairKind::kCableObstacle) &&
           std::holds_alternative<HalfSpaceShape>(obstacles[pair.second].shape);
  }
};

/// A vector along which two bodies are told apart, of integers that are not all 0, in the axes of W or of P.
struct Direction {
  Axes axes = Axes::kWorld;
  std::array<int, 3> u{};
};

/// A point of each of two bodies: the weights, >= 0 and 1 in sum, of the points whose hull the body is, or of the two
/// ends of what the free ends leave of a cable; of a half-space none, whose nearest point is meant; of a mesh, of the
/// three corners of an element.
using ContactWeights = std::array<std::vector<mpq_class>, 2>;
/// Which element, of each of two bodies that is a mesh.
using ContactElements = std::array<std::optional<std::size_t>, 2>;

/// What a limit of a move is of: the magnitude of a rate.
enum class RateKind {
  kWinchSpeed,
  kWinchAcceleration,
  kWinchPower,
  kLoadSpeed,
  kLoadAcceleration,
  kLoadAngularSpeed,
  kLoadAngularAcceleration
};
/// Whether there is one for each cable.
inline bool is_of_winch(RateKind kind) {
  return kind == RateKind::kWinchSpeed || kind == RateKind::kWinchAcceleration || kind == RateKind::kWinchPower;
}

/// Rows of a table of lengths, between which these run straight: no two rows are farther apart in time than `step`.
struct Rows {
  mpq_class step;                        ///< above 0 [s]
  std::array<mpq_class, kCables> error;  ///< how far such lengths may be from those of path and law [m]
};

/// Limits of what a move does in time: constants above 0, if they are stated. Speeds [m/s, rad/s] and accelerations
/// [m/s^2, rad/s^2] of the commanded lengths |d_i|, of the load point, and of the platform's rotation.
struct TimeLimits {
  std::array<std::optional<Expression>, kCables> winch_speed, winch_acceleration;
  std::array<std::optional<Expression>, kCables> winch_power;  ///< of a cable's greatest tension times its speed [W]
  std::optional<Expression> load_speed, load_acceleration, load_angular_speed, load_angular_acceleration;
  std::optional<Expression> stopping_time;  ///< above 0; no limit of a rate, see moving.h [s]
  std::optional<Rows> rows;                 ///< likewise

  /// @param cable  of winches
  [[nodiscard]] const std::optional<Expression>& of(RateKind kind, std::size_t cable) const {
    switch (kind) {
      case RateKind::kWinchSpeed: return winch_speed.at(cable);
      case RateKind::kWinchAcceleration: return winch_acceleration.at(cable);
      case RateKind::kWinchPower: return winch_power.at(cable);
      case RateKind::kLoadSpeed: return load_speed;
      case RateKind::kLoadAcceleration: return load_acceleration;
      case RateKind::kLoadAngularSpeed: return load_angular_speed;
      case RateKind::kLoadAngularAcceleration: break;
    }
    return load_angular_acceleration;
  }
};

/// K is the sum of the items and of the ellipsoid { w0 + e : e' E e <= 1 }. Where there are items, load point and
/// wrench have no tolerances.
struct Problem {
  std::array<ExactVector, kCables> base_anchors;        ///< a_i in W [m]
  std::array<ExactVector, kCables> platform_anchors;    ///< b_i in P [m]
  std::array<Limits, kCables> tension;                  ///< [N]
  std::array<Limits, kCables> length;                   ///< [m]
  ExactVector load_point;                               ///< p_m in P [m]
  ExactWrench wrench;                                   ///< w0 about P_m; 0 where there is no ellipsoid
  std::optional<std::array<ExactWrench, 6>> ellipsoid;  ///< E, symmetric
  ExactVector gravity;                                  ///< in W [m/s^2]
  std::vector<LoadItem> items;                          ///< none only where there is an ellipsoid
  std::optional<ToleranceBounds> tolerances;
  std::optional<Bodies> bodies;
  std::optional<TimeLimits> time = std::nullopt;  ///< of moves
  std::vector<Parameter> parameters;
  std::optional<std::array<std::size_t, 2>> flip;
  AngleKind angles = AngleKind::kTiltAndTorsion;
  std::array<mpq_class, 3> axis;               ///< for kAxis: not 0, of any length
  std::array<Expression, 6> pose;              ///< px py pz [m], angles [rad]; of kAxis the last two are 0
  std::vector<Expression> constraints;         ///< 0 along the path; fewer than the parameters, of which there are <= 6
  std::vector<std::vector<Expression>> query;  ///< constants, one a parameter; none in an audit
};

enum class Law { kStraight, kCubicBSpline, kGeodesic, kCableLengths };

/// Whether waypoints are poses, not parameters of the problem's space.
inline bool has_poses(Law law) { return law == Law::kGeodesic || law == Law::kCableLengths; }

struct Waypoint {
  /// One a parameter [m, rad]; under a law of poses px, py, pz [m], qx, qy, qz, qw, and L_1 to L_6 [m] where lengths
  /// are straight.
  std::vector<double> x;
  std::vector<int> half_turns;  ///< one a parameter: x + pi half_turns is meant; none under a law of poses
  std::vector<double> normals;  ///< N by rows: one row a parameter, one column a constraint
  bool operator==(const Waypoint&) const = default;
};

/// Bounds r_p [m] and r_u of where the pose is sought that lengths imply.
struct PoseTube {
  double position = 0;
  double turn = 0;
};

/// A point that the reference polyline passes between two waypoints.
struct InnerPose {
  mpq_class s;                ///< in (0, 1)
  std::array<double, 7> x{};  ///< px, py, pz [m], qx, qy, qz, qw
  PoseTube tube;              ///< from here to the next
};

/// When a move is where on its path (moving.h).
struct TimeLaw {
  double step_s = 0;             ///< h > 0 [s]
  std::vector<double> controls;  ///< four or more, none below the one before it
};

struct Path {
  Law law = Law::kStraight;
  std::vector<Waypoint> waypoints;
  std::vector<double> tubes;                        ///< one a segment where the space has constraints, else none
  std::vector<PoseTube> pose_tubes;                 ///< one a segment under kCableLengths, up to its first inner pose
  std::vector<std::vector<InnerPose>> inner_poses;  ///< likewise, by rising s
  std::vector<Direction> directions;                ///< along which pairs of bodies are told apart, by their index
  std::optional<TimeLaw> timing = std::nullopt;     ///< of a move

  [[nodiscard]] std::size_t control_points() const { return law == Law::kCubicBSpline ? 4 : 2; }
  [[nodiscard]] std::size_t segments() const {
    return waypoints.size() < control_points() ? 0 : waypoints.size() - control_points() + 1;
  }
  /// The control points of segment k; a path of a single waypoint is one motionless segment of a single one.
  [[nodiscard]] std::span<const Waypoint> controls(std::size_t k) const {
    return std::span(waypoints).subspan(k, segments() == 0 ? 1 : control_points());
  }
};

/// Where the zero that implies a motion is, over a box s = m + r u, |u| <= 1: within `radius` of `at` + `slope` u in
/// each unknown. Unproved; the kernel proves it.
struct NearZero {
  std::vector<double> at;
  std::vector<double> slope;
  double radius = 0;
  int narrowings = 0;  ///< how often the enclosure is narrowed, 0 to 8
};

/// A part [begin, end] of one segment (or of the way of a deviation), and how the kernel is to prove it at one go.
struct Box {
  mpq_class begin;
  mpq_class end;
  int bits = 64;                 ///< working precision, 32 to 4096
  std::optional<NearZero> near;  ///< where the motion is implied, by constraints or lengths
  int parts = 1;                 ///< with tolerances: the way to each deviation is taken in so many parts, 1 to 64
  int guesses = 1;               ///< with tolerances: evaluations of the rates before the one that must hold, 1 to 16
};

/// For each pair of bodies: the index of a direction of the path; or, with a mesh, the indices of one or more; none
/// where the second body is a half-space, whose normal is taken.
using Apart = std::vector<std::vector<std::size_t>>;

/// One load of an item, by the kind of its set: of a weight a mass and where its centre of gravity is, of a ball or
/// disc a vector, of a line segment an amount, of load cases one of them.
struct WeightChoice {
  mpq_class mass;
  ExactVector offset;  ///< of the centre of gravity from the item's point, in W [m]
};
struct VectorChoice {
  ExactVector vector;  ///< in the item's axes
};
struct AmountChoice {
  mpq_class amount;  ///< f
};
struct CaseChoice {
  std::size_t index = 0;
};
using LoadChoice = std::variant<WeightChoice, VectorChoice, AmountChoice, CaseChoice>;

/// A function of several types, made of one for each: for std::visit().
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// Whether poses are zeros of equations (constraints or lengths), whose existence is part of the proof.
inline bool is_implied(const Problem& problem, const Path& path) {
  return path.law == Law::kCableLengths || !problem.constraints.empty();
}

/// Whether the lengths of the cables are what a controller commands, not the pose: anchors that deviate move it.
inline bool is_length_controlled(const Problem& problem, const Path& path) {
  return path.law == Law::kCableLengths || (problem.tolerances && problem.tolerances->cable_length);
}

/// How a move that may be slowed down is run at a time of its law, z = σ(τ(t)) with a stopping time T: τ' is `speed`,
/// between 0 and 1, and τ'' is `change` / T. Then τ may go on, and may have come, within its bounds.
struct Slowing {
  mpq_class speed;
  int change = 1;  ///< 1 or -1
};

/// A deviation, exactly: what is added to the numbers of the problem and to the commanded pose.
struct WitnessDeviation {
  std::array<std::array<mpq_class, 3>, kCables> base_anchors;
  std::array<std::array<mpq_class, 3>, kCables> platform_anchors;
  std::array<mpq_class, 3> load_point;
  mpq_class wrench;  ///< how many times the tolerance of the wrench
  std::array<mpq_class, 3> position;
  std::array<mpq_class, 3> turn;  ///< u: the rotation of the quaternion (u, 1)
  /// Where the machine is length-controlled: what is added to the lengths [m].
  std::optional<std::array<mpq_class, kCables>> cable_lengths;
  /// Where it is length-controlled and anchors or lengths deviate: how the pose is followed as the deviation grows,
  /// tau from 0 to 1. A reference polyline through `poses` (the first at tau = 0, the last at tau = 1; s stands for
  /// tau; tube i reaches from pose i to the next, that of the last is unused), and boxes that tile [0, 1], none across
  /// a pose.
  std::vector<InnerPose> poses;
  std::vector<Box> boxes;

  /// Whether the commanded pose is left: where lengths are controlled, and anchors or lengths deviate.
  [[nodiscard]] bool leads_away() const {
    const WitnessDeviation none;
    return cable_lengths && (base_anchors != none.base_anchors || platform_anchors != none.platform_anchors ||
                             *cable_lengths != std::array<mpq_class, kCables>());
  }
};

}  // namespace taut::checker
