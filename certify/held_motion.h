// The pose of a machine that holds its cables' lengths: existence, uniqueness and an enclosure, over one box of a segment.
//
// The pose is sought around a reference (p_ref, R_ref)(t), in the pose tube (r_p, r_u):
//   p = p_ref + r_p z_p,  R = R(u, 1) R_ref,  u = r_u z_u,  z in [−1, 1]^6,                                            (h)
// as the zero of g_i(z, t) = (|d_i|^2 − L_i(t)^2) / 2, d_i = p + R b_i − a_i, by the Krawczyk operator (implied_zero.h) with
//   ∂g_i/∂z_p = r_p d_i,   ∂g_i/∂z_u = r_u (2 / (1 + |u|^2)) (x_i + x_i × u),  x_i = R b_i × d_i.
// The undisturbed machine has the anchors and lengths as stated; then the same tests, with enclosures of all deviations,
// prove that each deviation has exactly one pose in the tube, and how far it is from the undisturbed one.
// Proof: docs/theory.md, "Held by lengths" and "Existence of the commanded pose".
#pragma once

#include <array>
#include <optional>

#include "certify/tolerance.h"
#include "kinematics/segment.h"

namespace taut {

template <class I>
struct HeldMotion {
  MotionEnclosure<I> motion;     ///< undisturbed; status kUnproved where a test failed
  Displacement<I> displacement;  ///< by any deviation
};

/// @param reference      over the box; known.
/// @param lengths        L_i [m].
/// @param at_reference   the undisturbed machine is at the reference itself: L_i are its lengths there.
/// @param tolerance      null where there is none.
/// For Interval: only under run_upward(). Void if a fault was raised.
template <class I>
[[nodiscard]] HeldMotion<I> hold_by_lengths(const Model<I>& model, const MotionEnclosure<I>& reference,
                                            const std::array<Centered<I>, kCables>& lengths, bool at_reference,
                                            const PoseTube& tube, const ToleranceModel<I>* tolerance, const I& offset);

extern template HeldMotion<Interval> hold_by_lengths(const Model<Interval>&, const MotionEnclosure<Interval>&,
                                                     const std::array<Centered<Interval>, kCables>&, bool,
                                                     const PoseTube&, const ToleranceModel<Interval>*, const Interval&);
extern template HeldMotion<MpInterval> hold_by_lengths(const Model<MpInterval>&, const MotionEnclosure<MpInterval>&,
                                                       const std::array<Centered<MpInterval>, kCables>&, bool,
                                                       const PoseTube&, const ToleranceModel<MpInterval>*,
                                                       const MpInterval&);

}  // namespace taut
