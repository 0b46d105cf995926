// SPDX-License-Identifier: GPL-3.0-or-later
// Paths: exact waypoints and the law that joins them.
//
// Two laws run through the parameters of the problem's space. Waypoint k is the parameter vector λ_k with
// λ_kj = x_kj + π half_turns_kj: binary64 numbers and integers, so that a pose reached the other way round a periodic
// angle is still exactly the pose that was asked for. A segment is a curve ℓ(s), s in [0, 1], polynomial in s with the
// waypoints as control points:
//   straight           ℓ(s) = (1−s) λ_0 + s λ_1
//   cubic B-spline     ℓ(s) = ((1−s)^3 λ_0 + (3s^3−6s^2+4) λ_1 + (−3s^3+3s^2+3s+1) λ_2 + s^3 λ_3) / 6
// Successive segments share all but one control point; a spline of them has a continuous second derivative and passes
// through a control point that stands three times in a row.
//
// Without constraints the motion is γ(s) = pose(ℓ(s)). With k constraints C(λ) = 0 (SpaceText::constraints) ℓ is not on
// them: the motion is γ(s) = pose(ℓ(s) + N(s) y(s)), where N(s) mixes the waypoints' normals as ℓ mixes the waypoints,
// and y(s) is the only zero of C(ℓ(s) + N(s) y) with |y_i| <= `tube` for all i. That there is exactly one is for the
// proof to show.
//
// Two laws know nothing of the space: their waypoints are poses (p, q) with R = R(q), the rotation of the quaternion q,
// which may have any length but 0: R(q) = matrix polynomial of q over |q|^2 (quaternion.h).
//   geodesic           p(s) = (1−s) p_0 + s p_1,  R(s) = R_0 exp(s log(R_0^T R_1)): at constant rate about one
//                      axis, by an angle below π
//   cable lengths      the commanded lengths L(s) = (1−s) L_0 + s L_1 [m]; the pose is implied by |d_i| = L_i(s). It is
//                      sought around a reference, which runs straight in p and q from waypoint to waypoint through the
//                      inner poses (s_j, p_j, q_j): between two of them, t = (s − s_j)/(s_{j+1} − s_j),
//                        p_ref(s) = (1−t) p_j + t p_{j+1},  R_ref(s) = R((1−t) q_j + t q_{j+1}),
//                        p = p_ref + r_p z_p,  R = R(r_u z_u, 1) R_ref,  z in [−1, 1]^6,
//                      where the quaternion of R_ref is never 0, (r_p [m], r_u) is the piece's tube, and z is the only
//                      one that has the lengths; again, that there is exactly one is for the proof to show
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "problem/scalar.h"
#include "problem/text.h"

namespace taut {

/// λ_k, where the law runs through parameters.
struct ParameterPoint {
  std::vector<double> x;        ///< one a parameter [m, rad], finite
  std::vector<int> half_turns;  ///< one a parameter; non-zero only where it is periodic
  /// N by rows, one row a parameter and one column a constraint; empty in a space without constraints.
  std::vector<double> normals = {};
  bool operator==(const ParameterPoint&) const = default;
};

/// px, py, pz [m], qx, qy, qz, qw.
using PoseNumbers = std::array<double, 7>;

/// Of a geodesic.
struct PosePoint {
  PoseNumbers pose{};
  bool operator==(const PosePoint&) const = default;
};

/// Of straight cable lengths; the pose has about these.
struct LengthsPoint {
  PoseNumbers pose{};
  std::array<double, kCables> length_m{};
  bool operator==(const LengthsPoint&) const = default;
};

/// What a waypoint is depends on the law: an access to another kind throws std::bad_variant_access.
class Waypoint {
 public:
  Waypoint() = default;
  Waypoint(std::vector<double> x, std::vector<int> half_turns, std::vector<double> normals = {})
      : point_(ParameterPoint{std::move(x), std::move(half_turns), std::move(normals)}) {}
  explicit(false) Waypoint(ParameterPoint point) : point_(std::move(point)) {}
  explicit(false) Waypoint(const PosePoint& point) : point_(point) {}
  explicit(false) Waypoint(const LengthsPoint& point) : point_(point) {}

  [[nodiscard]] ParameterPoint& parameters() { return std::get<ParameterPoint>(point_); }
  [[nodiscard]] const ParameterPoint& parameters() const { return std::get<ParameterPoint>(point_); }
  /// Of either law with poses.
  [[nodiscard]] const PoseNumbers& pose() const {
    const auto* const with_lengths = std::get_if<LengthsPoint>(&point_);
    return with_lengths != nullptr ? with_lengths->pose : std::get<PosePoint>(point_).pose;
  }
  [[nodiscard]] const std::array<double, kCables>& lengths_m() const { return std::get<LengthsPoint>(point_).length_m; }

  [[nodiscard]] const auto& point() const { return point_; }
  bool operator==(const Waypoint&) const = default;

 private:
  std::variant<ParameterPoint, PosePoint, LengthsPoint> point_;
};

enum class Interpolation { kStraight, kCubicBSpline, kGeodesic, kCableLengths };

/// The number of control points of one segment.
[[nodiscard]] constexpr std::size_t control_points(Interpolation law) {
  return law == Interpolation::kCubicBSpline ? 4 : 2;
}
/// Whether waypoints are poses, not parameters of the problem's space.
[[nodiscard]] constexpr bool has_poses(Interpolation law) {
  return law == Interpolation::kGeodesic || law == Interpolation::kCableLengths;
}
/// The numbers of a waypoint in a row, as files have them: parameters x; or a pose, and lengths behind it.
[[nodiscard]] inline std::vector<double> numbers(const Waypoint& waypoint) {
  if (const auto* at = std::get_if<ParameterPoint>(&waypoint.point())) return at->x;
  std::vector<double> result(waypoint.pose().begin(), waypoint.pose().end());
  if (const auto* at = std::get_if<LengthsPoint>(&waypoint.point())) {
    result.insert(result.end(), at->length_m.begin(), at->length_m.end());
  }
  return result;
}
/// Those of parameters; none of poses.
[[nodiscard]] inline std::vector<int> half_turns(const Waypoint& waypoint) {
  const auto* const point = std::get_if<ParameterPoint>(&waypoint.point());
  return point != nullptr ? point->half_turns : std::vector<int>();
}
/// Of the quaternion.
[[nodiscard]] inline double quaternion_length(const PoseNumbers& pose) {
  return std::hypot(std::hypot(pose[3], pose[4]), std::hypot(pose[5], pose[6]));
}
/// Whether all lengths are above 0. @pre the law of cable lengths
[[nodiscard]] inline bool have_lengths(const Waypoint& waypoint) {
  return std::ranges::all_of(waypoint.lengths_m(), [](double length) { return length > 0; });
}
/// How many these are under a law. @param parameters  of the space
[[nodiscard]] constexpr std::size_t number_count(Interpolation law, std::size_t parameters) {
  if (!has_poses(law)) return parameters;
  return std::tuple_size_v<PoseNumbers> + (law == Interpolation::kCableLengths ? kCables : 0);
}
/// The waypoint of these numbers. @pre number_count() of a law with poses @param half_turns  of parameters
[[nodiscard]] inline Waypoint waypoint_of(Interpolation law, std::vector<double> numbers, std::vector<int> half_turns) {
  if (!has_poses(law)) return ParameterPoint{std::move(numbers), std::move(half_turns)};
  LengthsPoint point;
  if (numbers.size() != number_count(law, 0)) throw std::logic_error("a waypoint of other numbers");
  std::copy_n(numbers.begin(), point.pose.size(), point.pose.begin());
  if (law == Interpolation::kGeodesic) return PosePoint{point.pose};
  std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(point.pose.size()), numbers.end(), point.length_m.begin());
  return point;
}

/// r_p [m] and r_u [1].
struct PoseTube {
  double position = 0;
  double turn = 0;
  bool operator==(const PoseTube&) const = default;
};

/// A point that the reference passes between two waypoints; its number s is exact.
struct InnerPose {
  double s = 0;     ///< in (0, 1)
  PoseNumbers x{};  ///< the pose there
  PoseTube tube;    ///< of the piece that begins here
  bool operator==(const InnerPose&) const = default;
};

/// When a move is where on a path (time_law.h): a uniform cubic B-spline s = σ(t) of time.
struct TimeLaw {
  double step_s = 0;             ///< h [s], above 0
  std::vector<double> controls;  ///< c

  [[nodiscard]] std::size_t pieces() const { return controls.size() < 4 ? 0 : controls.size() - 3; }
  [[nodiscard]] double duration_s() const { return step_s * static_cast<double>(pieces()); }  ///< T, rounded
  bool operator==(const TimeLaw&) const = default;
};

/// One segment of a path; refers to waypoints and a time law that outlive it.
struct Segment {
  Interpolation law = Interpolation::kStraight;
  std::array<const Waypoint*, 4> control{};
  double tube = 0;                          ///< bound of |y_i|; only in a space with constraints
  PoseTube pose_tube = {};                  ///< of the first piece; only under the law of cable lengths
  std::vector<InnerPose> inner_poses = {};  ///< by rising s; likewise
  const TimeLaw* timing = nullptr;          ///< of the path; null: only where the path leads is asked for
  std::size_t index = 0;                    ///< the segment's in the path

  [[nodiscard]] static Segment straight(const Waypoint& a, const Waypoint& b, double tube = 0) {
    return {Interpolation::kStraight, {&a, &b}, tube};
  }
  /// A law with poses, between two of them.
  [[nodiscard]] static Segment between(Interpolation law, const Waypoint& a, const Waypoint& b, PoseTube tube = {}) {
    return {law, {&a, &b}, 0, tube};
  }
  [[nodiscard]] std::span<const Waypoint* const> controls() const { return {control.data(), control_points(law)}; }
};

struct Path {
  std::vector<Waypoint> waypoints;
  Interpolation interpolation = Interpolation::kStraight;
  std::vector<double> tubes = {};  ///< one a segment, in a space with constraints; else empty
  std::vector<std::string> times =
      {};  ///< decimals, one a waypoint [s]; empty where the path has none. No part of any claim
  std::vector<PoseTube> pose_tubes = {};                 ///< one a segment, under the law of cable lengths; else empty
  std::vector<std::vector<InnerPose>> inner_poses = {};  ///< likewise
  std::optional<TimeLaw> timing = {};                    ///< of a move

  [[nodiscard]] std::size_t segments() const {
    const std::size_t controls = control_points(interpolation);
    return waypoints.size() < controls ? 0 : waypoints.size() - controls + 1;
  }
  /// Segment k; of a path of a single waypoint, segment 0 is that pose.
  [[nodiscard]] Segment segment(std::size_t k) const {
    Segment segment{interpolation, {}, k < tubes.size() ? tubes[k] : 0};
    if (k < pose_tubes.size()) segment.pose_tube = pose_tubes[k];
    if (k < inner_poses.size()) segment.inner_poses = inner_poses[k];
    if (timing) segment.timing = &*timing;
    segment.index = k;
    if (segments() == 0) {
      if (!has_poses(interpolation)) segment.law = Interpolation::kStraight;
      segment.control[0] = segment.control[1] = &waypoints.front();
      return segment;
    }
    for (std::size_t i = 0; i < control_points(interpolation); ++i) segment.control[i] = &waypoints[k + i];
    return segment;
  }
};

/// What the reference of a segment is on one of its pieces, [from, to] of s; refers to the segment.
struct ReferencePiece {
  double from = 0;
  double to = 1;
  std::span<const double> first;  ///< the pose at `from`
  std::span<const double> last;   ///< at `to`
  PoseTube tube;
};

/// The piece in which s is; at a joint, the one that begins there.
[[nodiscard]] inline ReferencePiece reference_piece(const Segment& segment, double s) {
  const auto& inner = segment.inner_poses;
  const auto next =
      std::upper_bound(inner.begin(), inner.end(), s, [](double x, const InnerPose& y) { return x < y.s; });
  ReferencePiece piece{0, 1, segment.control[0]->pose(), segment.control[1]->pose(), segment.pose_tube};
  if (next != inner.end()) {
    piece.to = next->s;
    piece.last = next->x;
  }
  if (next != inner.begin()) {
    const InnerPose& begin = *std::prev(next);
    piece.from = begin.s;
    piece.first = begin.x;
    piece.tube = begin.tube;
  }
  return piece;
}

/// One coordinate of a segment as a polynomial in s, in scalar S; exact up to S's rounding.
template <class S>
struct Polynomial {
  std::array<S, 4> c;
  bool cubic;

  [[nodiscard]] S at(const S& s) const { return cubic ? c[0] + s * (c[1] + s * (c[2] + s * c[3])) : c[0] + s * c[1]; }
  [[nodiscard]] S slope(const S& s) const { return cubic ? c[1] + s * (c[2] + c[2] + s * (c[3] + c[3] + c[3])) : c[1]; }
};

/// Of control values q_i, given the first value of q_1 (or q_0, straight) and the differences q_{i+1} − q_i.
template <class S>
[[nodiscard]] Polynomial<S> bspline_polynomial(const S& q1, const S& d01, const S& d12, const S& d23) {
  const S half(0.5);
  const S six(6.0);
  return {{q1 + (d12 - d01) / six, half * (d01 + d12), half * (d12 - d01), (d23 - d12 - (d12 - d01)) / six}, true};
}

/// p_k of a geodesic.
template <class S>
[[nodiscard]] Polynomial<S> position_polynomial(const Segment& segment, std::size_t k) {
  const S from(segment.control[0]->pose()[k]), to(segment.control[1]->pose()[k]);
  return {{from, to - from, S(0.0), S(0.0)}, false};
}

/// L_i [m]. @pre the law of cable lengths
template <class S>
[[nodiscard]] Polynomial<S> length_polynomial(const Segment& segment, std::size_t cable) {
  const S from(segment.control[0]->lengths_m()[cable]), to(segment.control[1]->lengths_m()[cable]);
  return {{from, to - from, S(0.0), S(0.0)}, false};
}

/// L(s), in floating point; likewise.
[[nodiscard]] inline std::array<double, kCables> lengths_at(const Segment& segment, double s) {
  const auto &from = segment.control[0]->lengths_m(), &to = segment.control[1]->lengths_m();
  std::array<double, kCables> result{};
  for (std::size_t i = 0; i < kCables; ++i) result[i] = (1 - s) * from[i] + s * to[i];
  return result;
}

/// ℓ_j. @pre a law through parameters
template <class S>
[[nodiscard]] Polynomial<S> coordinate_polynomial(const Segment& segment, std::size_t j) {
  using Point = ParameterPoint;
  const auto at = [&](std::size_t k) -> const Point& { return segment.control[k]->parameters(); };
  const auto turns = [](int n) { return S(static_cast<double>(n)) * ScalarTraits<S>::pi(); };
  const auto value = [&](const Point& w) {
    const S x(w.x[j]);
    return w.half_turns[j] == 0 ? x : x + turns(w.half_turns[j]);
  };
  const auto difference = [&](const Point& a, const Point& b) {
    const S x = S(b.x[j]) - S(a.x[j]);
    return a.half_turns[j] == b.half_turns[j] ? x : x + turns(b.half_turns[j] - a.half_turns[j]);
  };
  if (segment.law == Interpolation::kStraight) return {{value(at(0)), difference(at(0), at(1)), S(0.0), S(0.0)}, false};
  return bspline_polynomial(value(at(1)), difference(at(0), at(1)), difference(at(1), at(2)), difference(at(2), at(3)));
}

/// Entry `index` of N, as stored.
template <class S>
[[nodiscard]] Polynomial<S> normal_polynomial(const Segment& segment, std::size_t index) {
  const auto value = [&](std::size_t i) { return S(segment.control[i]->parameters().normals[index]); };
  if (segment.law == Interpolation::kStraight) return {{value(0), value(1) - value(0), S(0.0), S(0.0)}, false};
  return bspline_polynomial<S>(value(1), value(1) - value(0), value(2) - value(1), value(3) - value(2));
}

}  // namespace taut
