// SPDX-License-Identifier: GPL-3.0-or-later
// Clause "motion": where the path leads, over a box of one of its segments.
//
// A box is a part [s0, s1] of a segment, written s = m + r u with u in [-1, 1].
//
//   curve        l(s), and the normals N(s), mix the control points by the path's law: polynomials in s, expanded
//                about m exactly, c0 + c1 u + c2 u^2 + c3 u^3.
//   parameters   Without constraints they are l. With k constraints C(lambda) = 0 they are l + N y, where y(u) is the
//                only zero of g(y, u) = C(l(u) + N(u) y) in the tube |y_i| <= t (zero.h).
//   poses        by the problem's expressions of the parameters, and R by its angles (AngleKind); or of a geodesic
//                between two poses; or, where lengths L are straight, from forward kinematics:
//
// Given a reference, a straight line between two poses, and lengths L > 0, the pose is sought in the reference's tube
//     p = p_ref + r_p z_p,   R = R(v, 1) R_ref,   v = r_u z_v,   z = (z_p, z_v) in [-1, 1]^6
// (R(v, 1) the rotation of the quaternion with vector part v and scalar part 1) as the zero of
//     g_i(z, u) = (|d_i|^2 - L_i^2) / 2,   d_i = p + R b_i - a_i.
// As L_i > 0, g_i = 0 says |d_i| = L_i. When z moves, v turns the platform at the rate 2 (v' + v x v') / (1 + |v|^2),
// so
//     dg_i/dz_p = r_p d_i,    dg_i/dz_v = r_u 2 / (1 + |v|^2) (x_i + x_i x v),   x_i = R b_i x d_i = R b_i x (p - a_i).
#pragma once

#include <memory>
#include <span>

#include "checker/kernel/machine.h"
#include "checker/kernel/zero.h"

namespace taut::checker {

/// The parameters on a box of segment k. @throws Undefined where the motion is implied and was not shown to be the only
/// one in its tube for every s of the box.
[[nodiscard]] std::vector<MeanValueForm> parameters(const Problem& problem, const Path& path, std::size_t k,
                                                    const Box& box);

/// Each parameter of kind range is in its closed range. @throws Undefined where that is not certain.
void require_in_range(const Problem& problem, const std::vector<MeanValueForm>& parameters);

/// px py pz [m] and the angles [rad], by the problem's expressions.
[[nodiscard]] Vector6<MeanValueForm> coordinates(const Problem& problem, const std::vector<MeanValueForm>& parameters);

/// Of the quaternion (x, y, z, w), of any length but 0.
[[nodiscard]] Matrix3<MeanValueForm> rotation(const std::array<MeanValueForm, 4>& q);

/// From one pose to another: the position on a straight line, the rotation about one axis and at a constant rate; and
/// that rate w, with R' = [w] R by s [rad], axes of W. @throws Undefined of half a turn
[[nodiscard]] Frame geodesic(std::span<const Waypoint> controls, const Box& box);
[[nodiscard]] Vector3<Ball> geodesic_turn(std::span<const Waypoint> controls);

/// The straight line between two poses of a polyline, over a box between their abscissae.
[[nodiscard]] Frame reference_line(const InnerPose& begin, const InnerPose& end, const Box& box);

/// A machine whose cables have given lengths, its anchors and lengths functions of u, near a reference pose.
struct LengthControlled {
  std::array<Vector3<MeanValueForm>, 6> base;      ///< a_i
  std::array<Vector3<MeanValueForm>, 6> platform;  ///< b_i
  Vector6<MeanValueForm> lengths;                  ///< L_i [m]
  Frame reference;
  PoseTube tube;
};
/// The only pose in the tube. @throws Undefined unless there is exactly one for every u, and lengths are positive.
[[nodiscard]] Frame forward_kinematics(const LengthControlled& machine, const NearZero& near);

/// The pose at z.
[[nodiscard]] Frame pose_at(const LengthControlled& machine, const Vector6<MeanValueForm>& z);
/// As a path of lengths says over a box of segment k, with the piece of the reference in which `within` is: that
/// reaches across no inner pose, and contains the box.
[[nodiscard]] LengthControlled length_controlled(const Machine& machine, const Path& path, std::size_t k,
                                                 const Box& box, const Box& within);

/// Whether parameters of an implied motion have to be in their ranges. They need not on the way to a witness.
enum class Ranges { kRequired, kIgnored };

/// The machine as the problem states it, at the pose that is commanded: all of its geometry over a box of segment k
/// that reaches across no inner pose. @throws Undefined where that is not proved.
[[nodiscard]] Geometry commanded_geometry(const Machine& machine, const Problem& problem, const Path& path,
                                          std::size_t k, const Box& box, Ranges ranges = Ranges::kRequired);

/// The equations of segment k's motion over a box, where it is implied: for whoever looks for a NearZero.
[[nodiscard]] std::unique_ptr<Equations> motion_equations(const Machine& machine, const Problem& problem,
                                                          const Path& path, std::size_t k, const Box& box);
[[nodiscard]] std::unique_ptr<Equations> motion_equations(const LengthControlled& machine);

}  // namespace taut::checker
