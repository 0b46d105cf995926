// SPDX-License-Identifier: GPL-3.0-or-later
// Clause "clearance": the two bodies of every checked pair are farther apart than the pair's clearance; or, in zones of
// contact, than minus the greatest depth of those that the platform's origin p of the stated machine is in. The
// distance of bodies that overlap is minus the length of the shortest translation of one of them after which they do
// not.
//
// Every body is a half-space, a mesh (mesh_clearance.h), or the hull of finitely many balls, which is convex. Let the
// first body of a pair be the hull of balls (a_k, r_k), the second that of balls (b_l, s_l). For every vector u that is
// not 0 their distance is at least
//     min_k (u . a_k / |u| - r_k)  -  max_l (u . b_l / |u| + s_l),                                                (1)
// as no point of the first has a smaller u . x / |u| than the first term, and none of the second a larger one than the
// second. Where (1) is -g, a translation by g along u makes it 0, and tells bodies apart that overlap. The second term
// of a half-space {x : n . x <= c} is c / |n| for u = n. Any u will do: a poor one proves less.
//
// Where bodies are.  Along u of W, with v = R' u,
//     platform's point x:   u . p + v . x                    an obstacle's point q:   u . q
//     cable i:              at A_i u . a_i, at B_i that plus u . d_i;
// along u of P, for which what the platform carries stands still, an obstacle's point q is at (R u) . (q - p), and
//     cable i:              at B_i u . b_i, at A_i that minus (R u) . d_i.
// A cable's body begins delta_0 from A_i and ends delta_1 from B_i. Let e bound what deviations change |d_i| by, and
// let |d_i| - e > delta_0 + delta_1. The point at the share t of the way from A_i' to B_i' is part of the body of the
// cable that deviates only for t from t_0 = delta_0 / (|d_i| + e) to 1 - t_1, t_1 = delta_1 / (|d_i| + e).
//
// Deviations.  Let P bound |p' - p|, and let R' = S R, S a turn by no more than Omega (PoseShift). So |S x - x| <=
// Omega |x|. beta_i and mu_i are the tolerances of anchors. Then these points are no farther from where they are
// stated to be than
//                      in W                         in P'
//     platform's x     P + Omega |x|                0
//     A_i'             beta_i                       beta_i + P + Omega |a_i - p|   (A_i' is at R'' (a_i' - p'))
//     obstacle's q     0                            P + Omega |q - p|              (likewise)
//     B_i'             P + Omega |b_i| + mu_i       mu_i
// and the point at the share t of a cable is within that share of what its ends are: (1 - t) x + t y, say. Both point
// and bound being linear in t, every point of the body that deviates is in the hull of the balls with these radii, plus
// half the diameter, around the two points that the cuts t_0 and 1 - t_1 have in the stated machine.
//
// One anchor.  Two cables whose base anchors are stated at the same place with the same tolerance hang from one point,
// which deviates by one vector. Their distance stays the same if both are moved back by that vector. So with the bounds
// x for A' and y_1, y_2 for the two B', 0 for A' and x + y_1, x + y_2 for B' will do, too; and likewise for platform
// anchors. The larger of what these prove is proved.
//
// Exit cones.  Let d be the vector from a cable's anchor at one end to its other anchor, in W at the base, in P at the
// platform, n a unit vector and a in (0, pi/2). Where t is the angle between d and n,
//     |d| sin(a - t) = sin(a) n . d - cos(a) |d x n|,                                                               (2)
// as |d| cos t = n . d and |d| sin t = |d x n|. (n . d, |d x n|) moves by no more than d does, and (2) by no more than
// that, since sin^2 + cos^2 = 1. d moves by no more than the sum of what its ends do in these axes, as above.
#pragma once

#include <optional>
#include <span>

#include "checker/kernel/deviation.h"

namespace taut::checker {

/// For each pair: a number that its distance, minus what it has to be more than, is not less than, for every s of the
/// box and every machine and pose within the tolerances [m].
/// @param loss  what tolerances take away; of length and pose only
/// @throws Undefined where a cable may not be longer than its free ends, and where `apart` has no direction that may be
/// used for a pair: of W for a cable against an obstacle, of P for a cable against a body of the platform, else either;
/// of W for a mesh and an obstacle.
/// @param enough  if given, no larger margin of a pair with a mesh is asked for [m]
/// @pre machine.bodies
[[nodiscard]] std::vector<Ball> clearance_margins(const Machine& machine, const Geometry& geometry,
                                                  const MarginLoss& loss, std::span<const Direction> directions,
                                                  const Apart& apart, const std::optional<Ball>& enough = {});

/// By how much these points of a pair's bodies are nearer to each other than both radii and the clearance together
/// allow, or minus a depth where a zone may give it in place of the clearance [m]: the pair is not clear where that is
/// not negative. @pre geometry is that of one place
/// @throws Undefined where a cable may not be longer than its free ends.
[[nodiscard]] Ball contact_depth(const Machine& machine, const Geometry& geometry, std::size_t pair,
                                 const ContactWeights& weights, const ContactElements& elements = {});

/// By how much a pair of hulls or cables is nearer, or deeper in each other, than radii and clearance together allow,
/// at least, as four pairs of points show [m]: with v_k the vectors from the second point to the first, 0 is inside of
/// the tetrahedron of the v_k, at least so far from each of its faces.
/// @pre geometry is that of one place; four pairs of points of bodies that are neither a half-space nor a mesh
/// @throws Undefined where 0 may be outside, and where a cable may not be longer than its free ends.
[[nodiscard]] Ball depth_around(const Machine& machine, const Geometry& geometry, std::size_t pair,
                                const std::vector<ContactWeights>& around);

/// Confirms that this point of one body of a pair is inside of the other, `solid`: 0 the first, 1 the second, a closed
/// mesh, so that the bodies have it in common. @returns the pair's clearance [m]
/// @pre geometry is that of one place
/// @throws Undefined where this is not certain, and where a cable may not be longer than its free ends.
[[nodiscard]] Ball depth_inside(const Machine& machine, const Geometry& geometry, std::size_t pair, std::size_t solid,
                                const ContactWeights& weights, const ContactElements& elements = {});

}  // namespace taut::checker
