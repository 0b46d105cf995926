// Where a machine is that holds the lengths of its cables, not its pose.
//
// Given a reference pose (p_ref, R_ref) and lengths L, functions of u over a box of the path, the pose is sought in a tube
//     p = p_ref + r_p z_p,   R = R(v, 1) R_ref,   v = r_u z_v,   z = (z_p, z_v) in [-1, 1]^6
// (R(v, 1) the rotation of the quaternion with vector part v and scalar part 1) as the zero of
//     g_i(z, u) = (|d_i|^2 - L_i^2) / 2,   d_i = p + R b_i - a_i.
// krawczyk.h shows that there is exactly one. As L_i > 0, g_i = 0 says |d_i| = L_i. The derivatives: when z moves, v turns
// the platform at the rate Omega = 2 (v' + v x v') / (1 + |v|^2), and d_i . (Omega x R b_i) = Omega . (R b_i x d_i), so
//     dg_i/dz_p = r_p d_i,    dg_i/dz_v = r_u 2/(1 + |v|^2) (x_i + x_i x v)  with x_i = R b_i x d_i,
//     dg_i/du   = d_i . (p_ref' + R(v, 1) R_ref' b_i) - L_i L_i'.
//
// Deviations (Tolerances) of the anchors and lengths make a family of such equations, whose d_i differ by no more than
// delta_i = delta_a,i + delta_b,i from the stated machine's d_i in the same pose, and whose lengths are L_i + e_i. So g_i
// differs by no more than |d_i| delta_i + delta_i^2 / 2 + L_i delta_L,i + delta_L,i^2 / 2. By (5) of krawczyk.h that bounds how
// far the pose is from the stated machine's; a straight line from v to v' turns the platform by at most 2 |v' - v|.
#pragma once

#include "certify/checker/motion.h"
#include "certify/checker/pose_proof.h"

namespace taut::checker {

/// The pose that a controller commands.
struct Commanded {
  Frame pose;       ///< of the machine as it is stated
  Interval moved;   ///< |p' - p| <= [m] of any machine within the tolerances, for the same u
  Interval turned;  ///< the angle between R' and R <= [rad], likewise
};

/// @throws Undefined unless there is exactly one pose in the tube with the lengths L, for every u and every machine of the
/// family; where null, for the machine as it is stated.
[[nodiscard]] Commanded held_by_lengths(const Model& model, const Frame& reference, const Vector6<Form>& L,
                                        const PoseTube& tube, const Deviation* deviation);

}  // namespace taut::checker
