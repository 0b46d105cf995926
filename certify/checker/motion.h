// Where the platform is on its path: the parameters, over a box of a segment.
//
// A box is a part [s0, s1] of one segment, written s = m + r u with u in [-1, 1].
//
//   curve     l(s), and the normals N(s), mix the control points by the path's law: polynomials in s, expanded about m
//             exactly, so that each is a Form in u of nearly no width.
//   explicit  Without constraints the parameters are l.
//   implied   With k constraints C(lambda) = 0 they are l + N y, where y(u) is the zero of g(y, u) = C(l(u) + N(u) y) in
//             the tube |y_i| <= t. That there is exactly one is shown as follows.
//
// Let Y be a box, c its middle, and let G and h enclose the partial derivatives of g by y and by u, on all of Y and for
// all u (by the chain rule, from those of C on a box of parameters). Between (c, 0) and (y, u) the mean value theorem says
//     g(y, u) = g(c, 0) + h' u + G' (y - c)   for some h' in h and G' in G.                                          (1)
// Take any matrix A, M = I - A G, ||M|| <= rho < 1 (row sums), and
//     K = c - A g(c, 0) - A h [-1, 1] + M (Y - c).
// For each u, y -> y - A g(y, u) maps Y into K by (1), and shrinks distances (largest component) by rho. Since
// A G' = I - M' is non-singular, so is A, and the fixed points of this map are the zeros of g. So Y has
//     at most one zero,   and exactly one where K is within Y.                                                       (2)
// The first half is shown of the whole tube, the second of a small box in it. Whatever Y and A are,
//     a zero in Y is in K too,                                                                                       (3)
// by which Y is narrowed about y(u). By (1) between two zeros, y is continuous in u, hence differentiable by the
// implicit function theorem, with G' y' = -h', that is y' = -A h' + M' y':
//     |y'_i| <= max_k |(A h)_k| / (1 - rho),   and y' in -A h + M y'.                                                (4)
#pragma once

#include <vector>

#include "certify/checker/certificate.h"
#include "certify/checker/form.h"

namespace taut::checker {

/// The parameters on a box of segment k, at the working precision.
/// @throws Undefined where the motion is only implied, and was not shown to be the only one in its tube for every s of
/// the box.
[[nodiscard]] std::vector<Form> parameters(const Problem& problem, const Path& path, std::size_t k, const Box& box);

}  // namespace taut::checker
