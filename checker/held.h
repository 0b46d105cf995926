// Where a machine is that holds the lengths of its cables, not its pose.
//
// Given a reference pose (p_ref, R_ref) (motion.h) and lengths L, functions of u over a box of the path, the pose is sought in its tube
//     p = p_ref + r_p z_p,   R = R(v, 1) R_ref,   v = r_u z_v,   z = (z_p, z_v) in [-1, 1]^6
// (R(v, 1) the rotation of the quaternion with vector part v and scalar part 1) as the zero of
//     g_i(z, u) = (|d_i|^2 - L_i^2) / 2,   d_i = p + R b_i - a_i.
// krawczyk.h shows that there is exactly one. As L_i > 0, g_i = 0 says |d_i| = L_i. The derivatives: when z moves, v turns
// the platform at the rate Omega = 2 (v' + v x v') / (1 + |v|^2), and d_i . (Omega x R b_i) = Omega . (R b_i x d_i), so
//     dg_i/dz_p = r_p d_i,    dg_i/dz_v = r_u 2/(1 + |v|^2) (x_i + x_i x v)  with x_i = R b_i x d_i,
//     dg_i/du   = d_i . d_i' - L_i L_i',    d_i' = p_ref' + w x R b_i  with w = R(v, 1) w_ref,
//     d2g_i/du2 = |d_i'|^2 + d_i . (w' x R b_i + w x (w x R b_i)) - L_i'^2,
// w_ref being the rate at which R_ref turns, R_ref' = [w_ref] R_ref; p_ref and L are straight.
// This is the machine as it is stated; where all deviations within tolerances lead follows in deviation.h.
//
// Where a single one leads. Let a_i, b_i, L_i grow into a_i', b_i', L_i' at constant rates, by t from 0 to 1, which is taken in
// steps. Let the reference be the machine's pose at the beginning of a step from t0 to t1, still. If there is exactly one zero in the
// tube for every choice of anchors and lengths in intervals that hold those of all t in the step, then there is for every t. At t0 it is
// z = 0. By krawczyk.h the derivatives by z are non-singular on the tube, so the zero is continuous in t, and no pose on its way is
// singular: at t1 it is the pose to which the way leads, and the next step begins there. At t = 1 the deviation has led to it.
#pragma once

#include <functional>

#include "checker/motion.h"
#include "checker/pose_proof.h"

namespace taut::checker {

/// The pose that a controller commands. @throws Undefined unless there is exactly one in the tube with the lengths L, for
/// every u.
[[nodiscard]] Frame held_by_lengths(const Model& model, const Reference& reference, const Vector6<Form>& L);

/// At one place of the path: the pose to which a deviation leads the stated machine from its `pose`, where it has the lengths L;
/// then it has `deviant`'s anchors and its lengths are L + errors [m]. `before_step` may throw. @throws Undefined unless that is proved.
[[nodiscard]] Frame deviated_pose(const Model& stated, const Frame& pose, const Vector6<Form>& L, const Model& deviant,
                                  const Vector6<Interval>& errors, const std::function<void()>& before_step);

}  // namespace taut::checker
