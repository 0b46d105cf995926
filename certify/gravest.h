// SPDX-License-Identifier: GPL-3.0-or-later
// Where a violation seems gravest on a segment, in floating point: it proposes what is then proved, and proves nothing.
#pragma once

#include <optional>

#include "certify/arithmetic/dyadic.h"
#include "certify/bodies/nearest.h"
#include "kinematics/margin.h"
#include "kinematics/pose_sampler.h"

namespace taut {

/// A place of a segment where the undisturbed machine seems to break a limit, or to pass a singular pose.
struct SuspectedViolation {
  bool singular = false;
  MarginId margin;      ///< unless singular
  Dyadic from, at, to;  ///< det J changes its sign between `from` and `to`; a limit is broken at `at`, between them
  double severity = 0;  ///< as of a witness (severity.h); below 0 where the limit is kept; unless singular
};

/// A place of a segment where two bodies seem to be too near.
struct SuspectedContact {
  std::size_t pair = 0;  ///< in the order of pairs() of problem/bodies.h
  Dyadic at;
  double gap = 0;  ///< how much farther apart than their clearance they are [m]; below 0
};

struct SampledViolations {
  std::optional<SuspectedViolation> singular;  ///< the first change of sign
  std::optional<SuspectedViolation> worst;     ///< of the limit that is broken most or, if none is, nearly so
  std::optional<SuspectedContact> contact;     ///< the deepest one; sample_violations() looks for none
};

/// The limit that the pose at s breaks most or, if it breaks none, nearly so.
[[nodiscard]] std::optional<SuspectedViolation> worst_margin(const PoseSampler& sampler, const Segment& segment,
                                                             const Dyadic& s);

/// Looks at about `count` places of [begin, end] on a segment, its ends among them.
/// @pre the law states the motion: there are neither constraints nor straight cable lengths.
[[nodiscard]] SampledViolations sample_violations(const PoseSampler& sampler, const Segment& segment,
                                                  const Dyadic& begin, const Dyadic& end, int count);

/// Where a pair of bodies is nearest among about `count` places of [begin, end] on a segment; nothing where it is not
/// too near. @pre as sample_violations()
[[nodiscard]] std::optional<SuspectedContact> deepest_contact(const PoseSampler& sampler, const BodySampler& bodies,
                                                              const Segment& segment, std::size_t pair,
                                                              const Dyadic& begin, const Dyadic& end, int count);

/// Looks closer: a change of sign within less, a limit where it is broken more.
[[nodiscard]] SuspectedViolation narrowed(const PoseSampler& sampler, const Segment& segment,
                                          const SuspectedViolation& suspected);

}  // namespace taut
