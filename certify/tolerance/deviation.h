// SPDX-License-Identifier: GPL-3.0-or-later
// One deviation within the tolerances, as exact numbers: what a refutation shows where the undisturbed machine is safe.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "certify/arithmetic/mp_interval.h"
#include "kinematics/margin.h"
#include "kinematics/model.h"
#include "kinematics/pose_conversion.h"

namespace taut {

/// What is added to the numbers of a problem and to the commanded pose (docs/certificate-format.md, "witness").
struct Deviation {
  std::array<std::array<DecimalText, 3>, kCables> base_anchors_m;
  std::array<std::array<DecimalText, 3>, kCables> platform_anchors_m;
  std::array<DecimalText, 3> load_point_m;
  DecimalText wrench;                     ///< τ
  std::array<DecimalText, 3> position_m;  ///< tracking
  std::array<DecimalText, 3> turn;        ///< u of the rotation R(u, 1) by 2 atan |u|
  /// Of a machine that is held by lengths: their errors.
  std::optional<std::array<DecimalText, kCables>> cable_lengths_m = std::nullopt;
};

/// What may refute, as floating point sees it.
struct ProposedDeviation {
  Deviation deviation;
  bool leads_to_pose = false;  ///< else floating point can't follow it
};

/// The one within a `part` of the `tolerances` that brings a margin down furthest, to first order, in floating point.
/// It keeps a billionth off the tolerances. Nothing where it leads to a pose at which the margin stays positive.
[[nodiscard]] std::optional<ProposedDeviation> worst_deviation(const TolerancesText& tolerances,
                                                               const Model<double>& model, const RigidPose& commanded,
                                                               MarginId margin, bool length_controlled, double part);

/// Of a move: w_in where the platform is turned to a rotation.
using InertiaAt = std::function<Vector6<MpInterval>(const Matrix3<MpInterval>& r_WP)>;

/// Encloses what `margin` limits (f0 − v, f0 + v [N] or d [m]) for the machine that deviates from `model` and from the
/// pose (p, R) that is commanded undisturbed; one that is held by lengths, from where its deviation leads
/// (length_controlled_motion.h): a fault where that is not proved. Void if a fault is raised. At working_precision().
/// @param inertia  of a move, else none
[[nodiscard]] MpInterval deviated_quantity(const Model<MpInterval>& model, const TolerancesText& tolerances,
                                           const Vector3<MpInterval>& p_WP, const Matrix3<MpInterval>& r_WP,
                                           const Deviation& deviation, MarginId margin, const InertiaAt& inertia = {});

}  // namespace taut
