// Where the path leads: parameters and poses, over a box of a segment.
//
// A box is a part [s0, s1] of one segment, written s = m + r u with u in [-1, 1].
//
//   curve        l(s), and the normals N(s), mix the control points by the path's law: polynomials in s, expanded about m
//                exactly, so that each is a Form in u of nearly no width.
//   parameters   Without constraints they are l. With k constraints C(lambda) = 0 they are l + N y, where y(u) is the zero
//                of g(y, u) = C(l(u) + N(u) y) in the tube |y_i| <= t. krawczyk.h shows that there is exactly one.
//   poses        by the case's expressions of the parameters, with R = Rz(phi) Ry(theta) Rz(sigma - phi), or of a geodesic
//                between two poses; or a reference near which lengths say what the pose is.
#pragma once

#include <vector>

#include "checker/certificate.h"
#include "checker/form.h"
#include "checker/linear.h"

namespace taut::checker {

/// The parameters on a box of segment k, at the working precision.
/// @throws Undefined where the motion is only implied, and was not shown to be the only one in its tube for every s of
/// the box.
[[nodiscard]] std::vector<Form> parameters(const Problem& problem, const Path& path, std::size_t k, const Box& box);

/// Of control point `waypoint` as it is stated, x + pi half_turns.
[[nodiscard]] std::vector<Form> stated_parameters(const Waypoint& waypoint);

/// px py pz [m], phi theta sigma [rad], by the case's expressions.
[[nodiscard]] Vector6<Form> coordinates(const Problem& problem, const std::vector<Form>& parameters);

/// A pose: position of the platform's origin in W [m], and its rotation.
struct Frame {
  Vector3<Form> p;
  Matrix3<Form> R;
};

[[nodiscard]] Frame frame(const Vector6<Form>& pose);

/// Of the quaternion q = (x, y, z, w), of any length but 0.
[[nodiscard]] Matrix3<Form> rotation(const std::array<Form, 4>& q);

/// On a box of segment k of a path of geodesics. @throws Undefined for one of half a turn.
[[nodiscard]] Frame geodesic(const Path& path, std::size_t k, const Box& box);

/// About where the pose is under the law by which lengths are straight.
struct Reference {
  Frame pose;             ///< p is straight
  Vector3<Form> turning;  ///< w: dR/du = [w] R, axes of W
  PoseTube tube;
};

/// On a box of segment k, which reaches across no inner pose.
///
/// R = R(q) with q = q0 + u q1 turns at the rate 2 vec(q1 conj(q)) / |q|^2, and q1 conj(q0 + u q1) = q1 conj(q0) + u |q1|^2: so its
/// axis is fixed.
[[nodiscard]] Reference reference(const Path& path, std::size_t k, const Box& box);

/// L_i [m] on a box of segment k, of the law by which they are straight.
[[nodiscard]] Vector6<Form> commanded_lengths(const Path& path, std::size_t k, const Box& box);

}  // namespace taut::checker
