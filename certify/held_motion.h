// The pose of a machine that holds its cables' lengths: existence, uniqueness and an enclosure, over one box of a segment.
//
// The pose is sought around the reference (p_ref, R_ref)(t) of the piece in which the box is (kinematics/segment.h), in that piece's
// tube (r_p, r_u):
//   p = p_ref + r_p z_p,  R = R(u, 1) R_ref,  u = r_u z_u,  z in [−1, 1]^6,                                            (h)
// as the zero of g_i(z, t) = (|d_i|^2 − L_i(t)^2) / 2, d_i = p + R b_i − a_i, by the Krawczyk operator (implied_zero.h) with
//   ∂g_i/∂z_p = r_p d_i,   ∂g_i/∂z_u = r_u (2 / (1 + |u|^2)) (x_i + x_i × u),  x_i = R b_i × d_i.
// Proof: docs/theory.md, "Held by lengths". This is the machine as typed; poses of deviations are tolerance.h's.
#pragma once

#include "certify/motion.h"
#include "kinematics/model.h"
#include "kinematics/segment.h"

namespace taut {

/// For t in `range` with midpoint `mid`; `offset` encloses t − mid.
/// @param segment  of the law of cable lengths
/// @returns status kUnproved where a test failed. For Interval: only under run_upward(). Void if a fault was raised.
template <class I>
[[nodiscard]] MotionEnclosure<I> hold_by_lengths(const Model<I>& model, const Segment& segment, const I& range,
                                                 const I& mid, const I& offset);

extern template MotionEnclosure<Interval> hold_by_lengths(const Model<Interval>&, const Segment&, const Interval&,
                                                          const Interval&, const Interval&);
extern template MotionEnclosure<MpInterval> hold_by_lengths(const Model<MpInterval>&, const Segment&, const MpInterval&,
                                                            const MpInterval&, const MpInterval&);

}  // namespace taut
