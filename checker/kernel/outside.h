// SPDX-License-Identifier: GPL-3.0-or-later
// Clause "outside": that no pose of a cell is feasible, for the machine exactly as the problem states it.
//
// A cell is a box of the parameters; over it every quantity is a CellForm. Three kinds of reasons:
//
//   length     at every pose |d_i| >= d_hi,i, or |d_i| <= d_lo,i (limits are open).
//   balance    for a row y(u) of numbers and a wrench w(u) of K at each u,
//                  y . w  >  sum_j  max { (y . J_j) f : f_lo,j <= f <= f_hi,j },    J_j = column j of J,          (1)
//              so that no tensions within limits, not even at them, balance w: J f = w would give y . w =
//              sum_j (y . J_j) f_j, which is at most the right-hand side. Nothing is asked of J, which may be singular.
//
// Any y and any w of K do, so how they are chosen need not be trusted. Of cable i and a side, with C close to the
// inverse of D in the middle of the cell, y is row i of C, or minus that (kFixed); or that row and its first-order
// change, -(row i) S_k C with S_k the slopes of D (kFollowing). The latter y . J_j is 1/d_i or 0 but for terms of
// second order, so that (1) says that tension i is beyond its limit; the former is for cells next to det J = 0. w is a
// sum of one wrench of the ellipsoid and one of each item, constant in the item's axes, such that y . w is about as
// large as it gets in the middle of the cell.
//
//   contact    of a pair of bodies, points x_k of the first and y_k of the second at each u, convex combinations with
//              constant weights, and v_k = x_k - y_k. Either one of them, and at every pose
//                  |v| <= both radii + c,                                                                         (2)
//              c being the clearance, or minus the greatest depth of the zones that p may be in: balls around x and y
//              can not be told apart by a translation that is shorter than both radii - |v|. Or four, and at every pose
//              0 is in their hull: then a convex combination of all x_k is that of all y_k, and the bodies meet. As
//                  det(v1 v2 v3) v0 - det(v0 v2 v3) v1 + det(v0 v1 v3) v2 - det(v0 v1 v2) v3 = 0
//              for all vectors, 0 is in the hull if these four coefficients are positive, or if all are negative. The
//              size of each, divided by that of the normal (b - a) x (c - a) of the three vectors in it, is the
//              distance of 0 from their plane. Where the bodies may overlap, none of the four is less than
//              -c - both radii: then no translation that is shorter than -c tells the bodies apart. Of a cable and an
//              exit cone nothing but the pair: (2) of clearance.h is not positive at any pose.
#pragma once

#include <span>

#include "checker/kernel/bodies.h"
#include "checker/kernel/cell_form.h"
#include "checker/kernel/linear.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// How a cell is proved to be outside: 36 reasons.
struct OutsideReason {
  enum class Kind { kLength, kFollowing, kFixed };
  Kind kind = Kind::kLength;
  std::size_t cable = 0;  ///< i above
  std::size_t side = 0;   ///< 0: |d_i| <= d_lo,i, or y = -(row i); 1: |d_i| >= d_hi,i, or y = row i
  bool operator==(const OutsideReason&) const = default;
};

/// That two bodies are not farther apart than they have to be.
struct ContactReason {
  std::size_t pair = 0;
  std::vector<ContactWeights> points;  ///< one, or four where neither body is a half-space
};

/// The machine exactly as a problem states it, at the working precision. Refers to the problem.
struct StatedMachine {
  /// @throws Undefined where the ellipsoid's matrix has no inverse, or a body has no place.
  explicit StatedMachine(const Problem& stated);

  const Problem& problem;
  std::array<Vector3<Ball>, kCables> base;      ///< a_i
  std::array<Vector3<Ball>, kCables> platform;  ///< b_i
  std::array<Vector3<Ball>, kCables> arms;      ///< b_i - p_m
  std::array<std::array<Ball, 2>, kCables> tension_limits;
  Vector6<Ball> wrench;  ///< w0
  struct Ellipsoid {
    Matrix6<Ball> E;
    Matrix6<Ball> near_inverse;  ///< numbers
  };
  std::optional<Ellipsoid> ellipsoid;
  std::vector<Vector3<Ball>> item_arms;  ///< c - p_m of each item
  std::optional<PlacedBodies> bodies;
};

/// One cell, at the working precision of `machine`, which outlives it.
class OutsideProof {
 public:
  /// @throws Undefined where the poses of the cell can't be enclosed.
  OutsideProof(const StatedMachine& machine, std::span<const CellForm> parameters);

  /// Claim, if true. For every pose of the cell: a cable's length is not inside its open limits, or no tensions inside
  /// their limits balance some wrench of K. @throws Undefined where that can't be told.
  [[nodiscard]] bool holds(const OutsideReason& reason);
  /// Claim, if true. For every pose of the cell: the two bodies of the pair are not farther apart than the pair's
  /// clearance or, in zones of contact, than minus their depth. @throws Undefined where that can't be told, such as
  /// where a cable may not be longer than its free ends.
  /// @pre the problem has this pair, and the weights are as many as either body has points
  [[nodiscard]] bool holds(const ContactReason& reason) const;

 private:
  using Point = Vector3<CellForm>;
  [[nodiscard]] Point of_platform(const PlacedHull& hull, const std::vector<mpq_class>& weights) const;
  [[nodiscard]] Point of_cable(std::size_t i, const std::vector<mpq_class>& weights) const;
  /// x_k of (2), and y_k unless it is of a half-space.
  [[nodiscard]] Point first_point(const CheckedPair& pair, const ContactWeights& weights) const;
  [[nodiscard]] Point second_point(const CheckedPair& pair, const ContactWeights& weights) const;
  /// Claim, if true: at every pose of the cell this cable is not inside of the cone.
  [[nodiscard]] bool is_out_of_cone(std::size_t i, const PlacedExitCone& cone) const;
  [[nodiscard]] bool is_beyond_length(std::size_t cable, std::size_t side) const;
  [[nodiscard]] bool is_unbalanced(const OutsideReason& reason);
  void set_columns();
  [[nodiscard]] Vector6<CellForm> row(const OutsideReason& reason) const;
  [[nodiscard]] CellForm work(const Vector6<CellForm>& y) const;

  const StatedMachine& machine_;
  Vector3<CellForm> p_;
  Matrix3<CellForm> R_;
  std::array<Vector3<CellForm>, kCables> d_;    ///< [m]
  std::array<CellForm, kCables> squared_;       ///< |d_i|^2
  bool has_columns_ = false;                    ///< whether what follows is set
  std::array<Vector3<CellForm>, kCables> arm_;  ///< R (b_i - p_m)
  Matrix6<CellForm> J_;
  Matrix6<Ball> C_;                         ///< numbers
  std::array<Matrix6<Ball>, kCellAxes> S_;  ///< numbers, close to the slopes of D
};

}  // namespace taut::checker
