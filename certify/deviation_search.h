// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for a deviation within the tolerances that refutes a segment.
//
// Floating point proposes deviations (tolerance/deviation.h); one refutes only where the margin that it breaks is
// enclosed and proved not to be positive.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "certify/prover.h"

namespace taut {

/// The search along one segment; remembers what failed. Refers to the prover and the segment, which outlive it.
class DeviationSearch {
 public:
  DeviationSearch(const Prover& prover, const Segment& segment) : prover_(prover), segment_(segment) {}

  /// A deviation that breaks `margin` at the midpoint of a box, proved; a smaller one that breaks any margin, where the
  /// worst (to first order) can't be followed. Nothing if the worst breaks none.
  [[nodiscard]] std::optional<SegmentWitness> refute(const DyadicBox& box, MarginId margin);

  /// Likewise for a winch's power, of a move: a deviation that tightens its cable most.
  [[nodiscard]] std::optional<SegmentWitness> refute_power(const DyadicBox& box, RateId power) const;

  /// The box of tolerance_depth in whose middle an undisturbed `margin` is least, in floating point.
  [[nodiscard]] DyadicBox weakest_box(MarginId margin) const;
  /// Likewise, in whose middle a winch needs most power.
  [[nodiscard]] DyadicBox strongest_box(RateId power) const;

 private:
  /// A margin, and the deviation that is to break it.
  using Proposal = std::pair<MarginId, ProposedDeviation>;
  enum class Outcome { kRefutes, kHarmless, kNotFollowed };

  /// The pose at the middle of a box, and the machine; of a move, with what inertia leaves of the load there.
  struct Place {
    RigidPose pose;
    Model<double> model;
  };
  [[nodiscard]] Place place(const DyadicBox& box) const;
  /// The box of tolerance_depth for which `left`, of its middle, is least.
  template <class F>
  [[nodiscard]] DyadicBox least_box(F left) const;
  [[nodiscard]] std::vector<Proposal> breaking(const Place& place, const std::vector<MarginId>& margins,
                                               double share) const;
  [[nodiscard]] Outcome attempt(const DyadicBox& box, const Proposal& proposal) const;
  [[nodiscard]] std::optional<SegmentWitness> refute_by_smaller(const DyadicBox& box, const Place& place) const;

  const Prover& prover_;
  const Segment& segment_;
  bool all_margins_tried_ = false;
  bool has_failed_ = false;  ///< none was found that can be followed to where it refutes: not sought again
};

/// Encloses what `margin` limits at the midpoint of a box, for a machine that deviates, which in a move has the
/// velocities and accelerations that are commanded; nothing where that is not proved.
[[nodiscard]] std::optional<MpInterval> deviated_at_mid(const Prover& prover, const Segment& segment,
                                                        const DyadicBox& box, MarginId margin,
                                                        const Deviation& deviation);
/// Likewise for the power [W] of a winch: the greatest tension there times the commanded speed.
[[nodiscard]] std::optional<MpInterval> deviated_power_at_mid(const Prover& prover, const Segment& segment,
                                                              const DyadicBox& box, int cable,
                                                              const Deviation& deviation);

}  // namespace taut
