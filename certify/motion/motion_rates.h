// SPDX-License-Identifier: GPL-3.0-or-later
// How the platform moves along its path, enclosed, whatever law joins the waypoints: the pose and its first three
// derivatives by s, for every s of a part of a segment, and the first two in the part's middle.
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

  struct Over {
    I range, mid;  ///< `mid` is a number of the range
    ThirdPathRates<I> path;
    std::optional<ImpliedParameters<I>> implied;  ///< in a space with constraints
  };
  /// Nothing where the motion is not proved to be known on all of `range`, a part of [0, 1], or where it is not
  /// enclosed there well enough. Void if a fault was raised.
  [[nodiscard]] std::optional<Over> over(const Model<I>& model, const Segment& segment, const I& range) const;
  /// In the middle of that; likewise.
  [[nodiscard]] std::optional<PathRates<I>> at_middle(const Model<I>& model, const Segment& segment,
                                                      const Over& over) const;

 private:
  template <int N>
  struct Derivatives {
    explicit Derivatives(const Problem& problem);

    PathRatesModel<I, N> poses;
    std::optional<Evaluator<Taylor<I, N>>> constraints;
  };
  template <int N>
  [[nodiscard]] std::optional<PathRatesOf<I, N>> on_constraints(
      const Derivatives<N>& of, const Segment& segment, const I& range,
      const typename ImpliedParameters<I>::Where& implied) const;

  Derivatives<2> second_;
  Derivatives<3> third_;
  std::optional<ConstraintModel<I>> constraints_;
};

extern template class MotionRates<Interval>;
extern template class MotionRates<MpInterval>;

}  // namespace taut
