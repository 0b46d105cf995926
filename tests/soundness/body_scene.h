// SPDX-License-Identifier: GPL-3.0-or-later
// Random bodies for a trial.
#pragma once

#include <cstddef>
#include <optional>

#include "tests/soundness/scene.h"
#include "tests/soundness/trial.h"

namespace taut::campaign {

/// A pair of bodies that have a common point at s, by construction: on the machine as typed.
struct KnownContact {
  PairClass kind;
  std::size_t first, second;
  double s = 0;
};

/// Tensions of either sign are rare where the load is what tensions of one size carry at the middle of a path.
void choose_load(Trial& trial, const RigidPose<double>& middle, Random& random);

/// Bodies on the platform, obstacles near what moves, and cables, with all classes of pairs on and clearances 0.
/// @param wall  one obstacle is a plate, often far thinner than any step of a sampled path, in which a point of a cable
/// or of the platform's body lies at some s
/// @returns that contact
std::optional<KnownContact> choose_bodies(Trial& trial, const Motion<double>& approx, const Motion<BigFloat>& exact,
                                          double shortest, bool wall, Random& random);

}  // namespace taut::campaign
