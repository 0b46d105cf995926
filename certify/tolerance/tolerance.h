// SPDX-License-Identifier: GPL-3.0-or-later
// What deviations within the tolerances can do to a box: how far lengths and tensions change.
//
// A deviation (docs/theory.md, "Tolerances") is a choice of anchors, load point, load, length errors and tracking
// error. It is scaled by τ from 0 to 1; where lengths are controlled, the commanded pose follows. The way from 0 to 1
// is taken in n continuation steps. Up to the end of a step, bounds of how far things move are guessed, which makes a
// set X of states; if everything that moves at rates as on X gets no farther than was guessed, no deviation leads out
// of X. Changes are kept as |d_i' − d_i|, |arm_i' − arm_i| … by coordinates, and as |S − I| <= Q of S = D'^-1 D, where
//   |S'| <= B (I + Q),   B_ri >= |y_r·D_i'| on X.                                                                   (i)
// That proves D non-singular, and that the commanded pose exists. Then the rates of tensions are bounded, Euclidean
// norms:
//   |F_r'| <= Σ_i (δ_a,i |A_ri + c_ri d_i| + δ_b,i (|B_ri − c_ri d_i| + ε |c_ri d_i|) + δ_L,i |d_i| |c_ri|)
//             + δ_m |M_r| + ℓ_r |y_r·ŵ| + δ_p |P_r| + ε |W_r|.                                                      (t)
// and those of lengths, where these are not controlled, by δ_p + ε min(|R b_i × u_i|, |b_i|) + δ_a,i + δ_b,i.
// Undisturbed quantities, widened by the means of these rates over the steps, enclose those of every deviation.
#pragma once

#include <array>
#include <optional>

#include "certify/arithmetic/neumann.h"
#include "certify/arithmetic/slope_form.h"
#include "certify/loads/item_rows.h"
#include "certify/motion/motion.h"
#include "kinematics/geometry.h"
#include "kinematics/model.h"

namespace taut {

/// What decides where the platform is, but for tracking.
enum class Lead {
  kPath,       ///< the pose that the path has
  kAsTyped,    ///< lengths near those of the path, which the robot has as it is typed (theory.md, 14, "Rows")
  kByAnchors,  ///< such lengths on anchors that deviate: a machine that is held by lengths
};

/// The δ and ε of theory.md, rounded upward.
template <class I>
struct ToleranceModel {
  using Upper = UpperOf<I>;
  std::array<Upper, kCables> base_anchor, platform_anchor;  ///< [m]
  std::array<Upper, kCables> cable_length;                  ///< what rows of a table leave open included [m]
  Upper load_point, position;                               ///< [m]
  Upper orientation;                                        ///< ε [rad]
  Vector6<I> wrench;                                        ///< ŵ [N, N m]
  Lead lead = Lead::kPath;  ///< under laws of poses; under that of cable lengths anchors always lead
};

/// Nothing where the problem states no tolerances. Where loads are items, those of load point and load have to be 0:
/// the bounds below take the items' wrenches to be about a point of the platform that stays where it is. At
/// working_precision(); for Interval under run_upward().
template <class I>
[[nodiscard]] std::optional<ToleranceModel<I>> make_tolerance_model(const Problem& problem);

/// Bounds on X of how the quantities of a box change from undisturbed ones.
template <class I>
struct DeviationBounds {
  using Upper = UpperOf<I>;
  std::array<Upper, kCables> length{};                  ///< of d_i [m]
  std::array<std::array<Upper, 2>, kCables> tension{};  ///< of f0_i − v_ii and f0_i + v_ii [N]
  /// How far K moves tensions of deviating machines below (side 0) and above (side 1) their nominal ones [N]; only
  /// where loads are items.
  std::optional<std::array<std::array<Upper, 2>, kCables>> reach;
  /// Of the platform's pose: a point x of it moves by no more than position + turn |x|.
  Upper position{};  ///< of its origin [m]
  Upper turn{};      ///< the angle between its orientations [rad]
};

/// What (t) needs to know of a box, undisturbed.
template <class I>
struct UndisturbedBox {
  const Model<I>& model;
  const ItemRows& item_rows;  ///< of model.loads; only for Interval
  const MotionEnclosure<I>& motion;
  const CableGeometry<SlopeForm<I>>& geometry;
  const std::array<SlopeForm<I>, kCables>&length, &density, &radius;  ///< d_i, λ_i, |Z_i|
  const Square<I>& root;                                              ///< rows Z_i of D^-1 L, over T
  const Matrix6<typename ProofScalarTraits<I>::Point>& c;             ///< C
  const Square<UpperOf<I>>& q;                                        ///< D^-1 = P C on T, |P − I| <= Q
  Lead lead;
  const Vector6<I>& wrench;         ///< of the load beside items, and of inertia, in all states [N, N m]
  const Vector6<I>& wrench_change;  ///< by what a deviation may change it, beside ŵ; it contains 0
  bool is_item_by_item = false;     ///< sharper and slower bounds where loads are items, for Interval
};

/// The largest number of continuation steps.
inline constexpr int kMostContinuationSteps = 16;

/// Nothing unless all commanded poses are proved to exist, and D to be non-singular, on X. For Interval: only under
/// run_upward().
/// @param continuation_steps  from τ = 0 to 1, a power of two: more are tighter, and hold for larger tolerances
template <class I>
[[nodiscard]] std::optional<DeviationBounds<I>> disturbance(const UndisturbedBox<I>& box,
                                                            const ToleranceModel<I>& tolerance, int continuation_steps);

extern template std::optional<ToleranceModel<Interval>> make_tolerance_model(const Problem&);
extern template std::optional<ToleranceModel<MpInterval>> make_tolerance_model(const Problem&);
extern template std::optional<DeviationBounds<Interval>> disturbance(const UndisturbedBox<Interval>&,
                                                                     const ToleranceModel<Interval>&, int);
extern template std::optional<DeviationBounds<MpInterval>> disturbance(const UndisturbedBox<MpInterval>&,
                                                                       const ToleranceModel<MpInterval>&, int);

}  // namespace taut
