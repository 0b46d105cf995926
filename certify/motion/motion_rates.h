// SPDX-License-Identifier: GPL-3.0-or-later
// How the platform moves along its path, enclosed, whatever law joins the waypoints: the pose and its first two
// derivatives by s, for every s of a part of a segment.
//
// What equations imply is first enclosed as in motion.h, which proves that there is one zero; at it the equations are
// regular, so that its derivatives follow (kinematics/implied_rates.h). docs/theory.md, "Implied motions in time".
#pragma once

#include <optional>

#include "certify/motion/motion.h"
#include "kinematics/path_rates.h"

namespace taut {

template <class I>
class MotionRates {
 public:
  /// At working_precision(); for Interval under run_upward(). @throws InputError as make_model()
  explicit MotionRates(const Problem& problem);

  /// Nothing where the motion is not proved to be known on all of `range`, a part of [0, 1], or where it is not
  /// enclosed there well enough. Void if a fault was raised.
  [[nodiscard]] std::optional<PathRates<I>> over(const Model<I>& model, const Segment& segment, const I& range) const;

 private:
  [[nodiscard]] std::optional<PathRates<I>> on_constraints(const Segment& segment, const I& range) const;

  PathRatesModel<I> poses_;
  std::optional<ConstraintModel<I>> constraints_;
  std::optional<Evaluator<SecondJet<I>>> constraint_jets_;
};

extern template class MotionRates<Interval>;
extern template class MotionRates<MpInterval>;

}  // namespace taut
