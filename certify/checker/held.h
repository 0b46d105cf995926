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
// This is the machine as it is stated; where others are follows in deviation.h.
#pragma once

#include "certify/checker/motion.h"
#include "certify/checker/pose_proof.h"

namespace taut::checker {

/// The pose that a controller commands. @throws Undefined unless there is exactly one in the tube with the lengths L, for
/// every u.
[[nodiscard]] Frame held_by_lengths(const Model& model, const Frame& reference, const Vector6<Form>& L,
                                    const PoseTube& tube);

}  // namespace taut::checker
