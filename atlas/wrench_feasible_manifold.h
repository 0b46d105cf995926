// SPDX-License-Identifier: GPL-3.0-or-later
// The wrench-feasible C-space as a manifold for the atlas.
//
// The navigation manifold F(x) = 0 of the paper is a graph over the pose, and its components and their derivatives
// are closed form. So a chart needs one 6x6 inverse and no iteration: coordinates are the parameters of the case's
// space, and a point over tangent coordinates u has the parameters λ_c + lift·u.
//
// With k constraints C(λ) = 0 (SpaceText::constraints) a point is still named by all m parameters, of which n = m − k
// are free. The tangent space consists of changes of the parameters in the null space of C', and a step along it ends
// with Newton's method on C alone. Coordinates may be slightly off the constraints, as typed waypoints are; the frame's
// point is then the nearest one on them.
//
// The metric is a matter of choice; it determines how many charts there are. Distances are measured between the vectors
//
//   ( R / √2,  p / ℓ,  ω λ̂,  κ log g,  κ log s,  κ log t )
//
//   R      rotation matrix: over √2, an angle of 1 rad has length 1
//   p, ℓ   position over the mean |b_i|: moving by the platform's size counts as 1 rad
//   λ̂      the parameters themselves, periodic ones as (cos, sin): keeps the embedding regular where the
//          parametrisation is not (θ = 0, a pole of a sphere); for a flip, φ enters as (cos 2φ, sin 2φ)/2
//   g, s, t  slack variables of the paper's (10)–(12), scaled to 1 at mid-range: half range / distance to the limit.
//   They
//          grow without bound towards a limit, so that charts shrink there and never reach across it. Logarithms are
//          used so that halving the distance to a limit always counts as κ log 2. (The slacks themselves, as in the
//          paper, would make M so long towards its boundary that nearly all charts would lie there.)
//
// The domain ends where a margin falls to `clearance` of half its range. A proof needs no clearance, but without it a
// search might never end.
//
// x, d, f0 and v_i do not help to distinguish poses and are left out (weight 0). To a user, r and ε are radians.
#pragma once

#include <memory>

#include "atlas/manifold.h"
#include "kinematics/pose_sampler.h"

namespace taut {

struct MetricWeights {
  double parameter = 0.1;   ///< ω
  double slack = 0.05;      ///< κ
  double clearance = 1e-2;  ///< least distance to a limit, over half its range
};

/// The manifold of the problem's space. @throws InputError if the problem has no model in doubles.
[[nodiscard]] std::unique_ptr<Manifold> make_wrench_feasible_manifold(const Problem& problem,
                                                                      MetricWeights weights = {});
/// The same for a problem whose model and tape exist already.
[[nodiscard]] std::unique_ptr<Manifold> make_wrench_feasible_manifold(const Problem& problem,
                                                                      const PoseSampler& sampler,
                                                                      MetricWeights weights = {});

}  // namespace taut
