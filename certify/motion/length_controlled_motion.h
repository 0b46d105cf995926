// SPDX-License-Identifier: GPL-3.0-or-later
// The pose of a length-controlled machine: existence, uniqueness and an enclosure, over one box of a
// segment.
//
// The pose is sought around the reference (p_ref, R_ref)(t) of the piece in which the box is (kinematics/segment.h), in
// that piece's tube (r_p, r_u):
//   p = p_ref + r_p z_p,  R = R(u, 1) R_ref,  u = r_u z_u,  z in [−1, 1]^6,                                         (h)
// as the zero of g_i(z, t) = (|d_i|^2 − L_i(t)^2) / 2, d_i = p + R b_i − a_i, by the Krawczyk operator
// (parametric_krawczyk.h) with
//   ∂g_i/∂z_p = r_p d_i,   ∂g_i/∂z_u = r_u (2 / (1 + |u|^2)) (x_i + x_i × u),  x_i = R b_i × d_i.
// Proof: docs/theory.md, "Held by lengths". This is the machine as typed; where deviations lead all at once is
// tolerance.h's, where a single one leads is deviated_pose()'s, by the same operator.
#pragma once

#include <array>
#include <optional>

#include "certify/motion/motion.h"
#include "kinematics/model.h"
#include "kinematics/segment.h"

namespace taut {

/// For t in `range` with midpoint `mid`; `offset` encloses t − mid.
/// @param segment  of the law of cable lengths
/// @returns status kUnproved where a test failed. For Interval: only under run_upward(). Void if a fault was raised.
template <class I>
[[nodiscard]] MotionEnclosure<I> forward_kinematics(const Model<I>& model, const Segment& segment, const I& range,
                                                    const I& mid, const I& offset);

/// A pose [m], enclosed.
struct PoseEnclosure {
  Vector3<MpInterval> p_WP;
  Matrix3<MpInterval> r_WP;
};

/// The pose to which one deviation leads a machine that is held by lengths: as anchors and lengths change from those
/// that `model` has at `pose` to those of `deviated` and to lengths longer by `length_error` [m], steadily and all at a
/// time, the pose is proved to move continuously and past no singular one.
/// @returns nothing where a proof failed. Void if a fault was raised. At working_precision().
[[nodiscard]] std::optional<PoseEnclosure> deviated_pose(const Model<MpInterval>& model, const PoseEnclosure& pose,
                                                         const Model<MpInterval>& deviated,
                                                         const std::array<MpInterval, kCables>& length_error);

extern template MotionEnclosure<Interval> forward_kinematics(const Model<Interval>&, const Segment&, const Interval&,
                                                             const Interval&, const Interval&);
extern template MotionEnclosure<MpInterval> forward_kinematics(const Model<MpInterval>&, const Segment&,
                                                               const MpInterval&, const MpInterval&, const MpInterval&);

}  // namespace taut
