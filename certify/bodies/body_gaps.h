// SPDX-License-Identifier: GPL-3.0-or-later
// Whether two bodies stay apart over a box of a segment, or over a cell of a map: the gap along a given direction, and
// the distance of two given points.
//
// For every vector u and all points a_k, b_l and radii of two bodies,
//   gap ‖u‖ >= min_k (u·a_k(t) − r_k ‖u‖) − max_l (u·b_l(t) + r_l ‖u‖).
// Each u·a_k is a centred form over the box. Any direction will do; a good one is proposed by floating point. In the
// axes of the world
//   u·(p + R x) = u·p + (Rᵀu)·x,   the ends of cable i: u·a_i and u·p + (Rᵀu)·b_i,
// and in those of the platform its points stand still, a point x of an obstacle is at (R u)·(x − p), and the ends of
// cable i are (R u)·(a_i − p) and u·b_i. A cable's points at the shares λ of its length lie between them. All of this
// holds of bodies that overlap, too: their distance is minus the length of the shortest translation of one of them
// after which they don't. Proofs: docs/theory.md, "Clearance".
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "certify/arithmetic/dyadic.h"
#include "certify/arithmetic/gradient.h"
#include "certify/arithmetic/neumann.h"
#include "certify/arithmetic/slope_form.h"
#include "certify/bodies/mesh_side.h"
#include "certify/tolerance/tolerance.h"
#include "kinematics/bodies.h"

namespace taut {

/// A vector along which two bodies are to be shown apart; it points from the second to the first.
struct Direction {
  static constexpr int kLargest = 32767;  ///< of its components; certificates hold no larger ones
  static constexpr int kFine = 127;       ///< enough for most pairs
  static constexpr int kCoarse = 15;      ///< enough for pairs that are far apart; many have the same one
  bool in_platform = false;               ///< in the axes of P, else of W
  std::array<int, 3> u{};                 ///< not all 0, but where the second body is a half-space: not used
  auto operator<=>(const Direction&) const = default;
};

/// Whether it stands for the normal of a half-space.
[[nodiscard]] inline bool is_of_half_space(const Direction& direction) { return direction.u == std::array<int, 3>{}; }

/// Along what the pairs of a BodyModel are told apart.
struct PairDirections {
  std::vector<Direction> single;  ///< of each pair, in their order; of one with a list, the list's first
  /// Of each pair with a mesh, but those against half-spaces: each pair of their elements is apart along one of these.
  std::map<std::size_t, std::vector<Direction>> lists;
  bool operator==(const PairDirections&) const = default;

  /// Those of pair n.
  [[nodiscard]] std::span<const Direction> of(std::size_t n) const {
    const auto list = lists.find(n);
    return list == lists.end() ? std::span(&single.at(n), 1) : std::span<const Direction>(list->second);
  }
  /// @pre some directions; one unless the pair has a list
  void set(std::size_t n, std::vector<Direction> directions) {
    single.at(n) = directions.at(0);
    if (const auto list = lists.find(n); list != lists.end()) list->second = std::move(directions);
  }
};

/// A point of each of two bodies, as shares of its points: multiples of 1/kWhole that sum to kWhole. Of a cable, the
/// points are the two ends of its checked part; of a half-space there are none: its nearest point is meant. Of a mesh,
/// they are the three points of one of its elements; or none, where the other body's point is inside of it.
struct PointPair {
  static constexpr std::int64_t kWhole = std::int64_t{1} << 30;
  std::vector<std::int64_t> first, second;
  std::array<std::optional<std::uint32_t>, 2> elements = {};  ///< of meshes only
  std::optional<std::size_t> inside = {};  ///< the body, 0 or 1, of which the other's point is inside: a closed mesh
};

/// What shows that a pair of bodies is not farther apart than required.
struct PairContact {
  std::size_t pair = 0;  ///< in the order of pairs() of problem/bodies.h
  PointPair points;      ///< near each other
  /// In their place: the vectors from the second to the first of these are around 0, so that both bodies have a common
  /// point.
  std::optional<std::array<PointPair, 4>> around = {};
};

/// A share as a number in [0, 1].
[[nodiscard]] inline Dyadic dyadic_share(std::int64_t share) { return {share, 30}; }

/// Where everything is over a box T with midpoint m, of the undisturbed machine but for `deviations`. Over a cell of
/// several variables, Slope is a Gradient.
template <class I, class Slope = I>
struct BodiesBox {
  const BodyModel<I>& bodies;
  const Model<I>& model;
  const Vector3<SlopeForm<I, Slope>>& p_WP;
  const Matrix3<SlopeForm<I, Slope>>& r_WP;
  const std::array<SlopeForm<I, Slope>, kCables>& length;  ///< |d_i|
  const Slope& offset;                                     ///< contains t − m for all t in T
  const ToleranceModel<I>* tolerance = nullptr;  ///< null: no deviations; else all of its, with their bounds on T:
  const DeviationBounds<I>* deviations = nullptr;
};

/// A lower bound of how much farther than required (required_distance()) a pair is apart [m].
template <class I, class Slope = I>
struct GapBound {
  SlopeForm<I, Slope> value;  ///< of the undisturbed machine
  I disturbed;                ///< over all of T, for every deviation
};

/// Evaluates pairs over one box. For Interval: only under run_upward(). Void if a fault was raised.
template <class I, class Slope = I>
class BodyGaps {
 public:
  using Upper = UpperOf<I>;

  explicit BodyGaps(const BodiesBox<I, Slope>& box);

  /// Whether every cable is certainly longer than both its free ends, on T, for every deviation: what follows is void
  /// for cables else.
  [[nodiscard]] bool have_cables_length() const { return have_length_; }

  /// Claim: for every t in T and every deviation the bodies of the pair are farther apart than required by at least
  /// `disturbed`.
  /// @pre neither body is a mesh
  [[nodiscard]] GapBound<I, Slope> along(const CheckedPair<I>& pair, const Direction& direction) const;
  /// What a bound is about: all of T, or m, of all deviations or of the undisturbed machine.
  enum class Where { kBox, kMid, kMidUndisturbed };
  /// The same for a pair with a mesh: each pair of the bodies' elements is farther apart than the clearance by at least
  /// what is returned, along one of the directions.
  /// Of bounds that are positive any will do.
  [[nodiscard]] double of_mesh(const CheckedPair<I>& pair, std::span<const Direction> directions, Where where) const;
  /// Of a pair whose surfaces do not touch: kOutside if at m, of the undisturbed machine, no part of either body is
  /// inside of the other, where that is a watertight mesh; kInside if a part certainly is.
  [[nodiscard]] MeshSide side_at_mid(const CheckedPair<I>& pair) const;
  /// The same from ranges alone, of boxes around bodies and of the ends of cables' checked parts: a lower bound, for
  /// pairs that are far apart.
  [[nodiscard]] double rough(const CheckedPair<I>& pair, const Direction& direction) const;

  /// Contains how much farther than the least that may be required of the pair two of its bodies' points are apart, on
  /// the undisturbed machine, at every t of T; `only_at_mid`: at m. Where it is not positive, the pair is not farther
  /// apart than required there. @pre as many shares as either body has points
  [[nodiscard]] I distance(const CheckedPair<I>& pair, const PointPair& shares, bool only_at_mid) const;
  /// Claim, if true: at m, on the undisturbed machine, this point of one body is inside of the other, a watertight
  /// mesh. @pre points.inside
  [[nodiscard]] bool is_inside_at_mid(const CheckedPair<I>& pair, const PointPair& points) const;
  /// Claim, if true: the two bodies of the pair, of the undisturbed machine, have a common point at every t of T and
  /// are nowhere farther apart than required. The vectors from the second to the first of these four pairs of points
  /// are around 0, and around a ball about it where bodies may overlap. @pre neither is a half-space, and neither a
  /// mesh
  [[nodiscard]] bool meet(const CheckedPair<I>& pair, const std::array<PointPair, 4>& shares) const;

 private:
  using Form = SlopeForm<I, Slope>;
  /// A point of a body projected on a direction, and by how much deviations may move it.
  struct Projection {
    Form at;
    Upper shift;
  };
  using Projections = boost::container::small_vector<Projection, 8>;
  /// PairDirections are turned into the other axes once.
  struct Turned {
    std::array<I, 3> u;         ///< in its own axes
    std::array<Form, 3> other;  ///< in the other ones
    Form of_origin;             ///< u·p, in W; (R u)·p in P
  };
  /// The shares λ of a cable's length at which its checked part begins and ends: λ_0 and 1 − λ_1.
  struct Cut {
    std::array<Form, 2> share;
  };

  /// A direction as it is used for a pair: the normal of a half-space, else that given.
  [[nodiscard]] std::array<I, 3> vector(const CheckedPair<I>& pair, const Direction& direction) const;
  [[nodiscard]] bool is_in_platform(const CheckedPair<I>& pair, const Direction& direction) const;
  [[nodiscard]] Upper obstacle_shift(const Vector3<I>& x) const;
  [[nodiscard]] Turned turned(const std::array<I, 3>& u, bool in_platform) const;
  [[nodiscard]] std::array<Projection, 2> cable(std::size_t i, const Turned& u, bool in_platform,
                                                const std::array<Upper, 2>& shifts) const;
  [[nodiscard]] Projections platform_points(const ConvexBody<I>& body, const Turned& u, bool in_platform) const;
  [[nodiscard]] std::array<Upper, 2> end_shifts(const CheckedPair<I>& pair, std::size_t i, bool in_platform) const;
  [[nodiscard]] Projections first(const CheckedPair<I>& pair, const Turned& u, bool in_platform) const;
  [[nodiscard]] std::vector<Vector3<Form>> points(const CheckedPair<I>& pair, bool is_first,
                                                  const std::optional<std::uint32_t>& element) const;
  /// The sum of shares times points.
  [[nodiscard]] static Vector3<Form> mean(const std::vector<Vector3<Form>>& points,
                                          const std::vector<std::int64_t>& shares);
  /// How much longer or shorter than stated a deviating cable may be [m].
  [[nodiscard]] I length_change(std::size_t cable) const;
  [[nodiscard]] const Cut& cut(std::size_t cable) const;
  /// λ_0 and λ_1, anywhere in T.
  [[nodiscard]] const std::array<I, 2>& shares(std::size_t cable) const;
  [[nodiscard]] Vector3<I> range_in_world(const Vector3<I>& x_P) const;
  [[nodiscard]] const Vector3<I>& platform_anchor(std::size_t cable) const;  ///< in W, anywhere in T
  [[nodiscard]] const Vector3<I>& platform_body(std::size_t body) const;     ///< a box around its points, likewise
  /// Of an exit cone: how far the cable's other end is inside of it.
  [[nodiscard]] Form in_cone(const CheckedPair<I>& pair) const;
  /// Of the pair on T, or at m.
  [[nodiscard]] RequiredDistance<I> required(const CheckedPair<I>& pair, bool only_at_mid) const;
  template <class Number>
  [[nodiscard]] double rough(const CheckedPair<I>& pair, const std::array<Number, 3>& u, bool in_platform) const;
  [[nodiscard]] const PlacedMesh<I>* mesh(const CheckedPair<I>& pair, bool is_first) const;
  class MeshGaps;
  [[nodiscard]] MeshSide side_at_mid(const CheckedPair<I>& pair, bool first_is_solid) const;
  /// On which side of the first or the second body, a watertight mesh, a point of W is at m.
  [[nodiscard]] MeshSide side_at_mid(const CheckedPair<I>& pair, bool first_is_solid, const Vector3<I>& point) const;

  const BodiesBox<I, Slope>& box_;
  Upper position_{}, turn_{};                       ///< of the platform, by deviations
  std::array<Upper, kCables> base_{}, platform_{};  ///< tolerances of anchors
  bool have_length_ = true;
  // Computed when they are first asked for.
  mutable std::array<std::optional<Cut>, kCables> cut_;
  mutable std::array<std::optional<std::array<I, 2>>, kCables> shares_;
  mutable std::array<std::optional<Vector3<I>>, kCables> platform_anchors_;
  mutable boost::container::small_vector<std::optional<Vector3<I>>, 4> platform_bodies_;
};

extern template class BodyGaps<Interval>;
extern template class BodyGaps<MpInterval>;
extern template class BodyGaps<Interval, Gradient<Interval, 2>>;
extern template class BodyGaps<Interval, Gradient<Interval, 3>>;

}  // namespace taut
