// SPDX-License-Identifier: GPL-3.0-or-later
// How the platform moves along its path, enclosed, whatever law joins the waypoints: the pose and its first three
// derivatives by s, for every s of a part of a segment, and the first two in the part's middle.
//
// What equations imply is first enclosed as in motion.h, which proves that there is one zero; at it the equations are
// regular, so that its derivatives follow (kinematics/implied_rates.h). docs/theory.md, "Implied motions in time".
// Where that was done for the box already, it is not done again.
#pragma once

#include <memory>
#include <optional>

#include "certify/lanes/kernel.h"
#include "certify/motion/motion.h"
#include "kinematics/path_rates.h"

namespace taut {

/// A motion that is enclosed already. Refers to what has to outlive it.
template <class I>
struct KnownMotion {
  const MotionEnclosure<I>& motion;
  const I& mid;  ///< the middle that its forms are about
};

template <class I>
class MotionRates {
 public:
  /// At working_precision(); for Interval under run_upward(). @throws InputError as make_model()
  explicit MotionRates(const Problem& problem);

  struct Over {
    I range, mid;  ///< `mid` encloses a number of the range
    ThirdPathRates<I> path;
    /// The pose in the middle, where that is known.
    struct AtMid {
      Vector3<I> p;
      Matrix3<I> r_WP;
    };
    std::optional<AtMid> at_mid;
    std::optional<ImpliedParameters<I>> implied;  ///< in a space with constraints
  };
  /// Nothing where the motion is not proved to be known on all of `range`, a part of [0, 1], or where it is not
  /// enclosed there well enough. Void if a fault was raised.
  /// @param known  of the same range
  [[nodiscard]] std::optional<Over> over(const Model<I>& model, const Segment& segment, const I& range,
                                         const KnownMotion<I>* known = nullptr) const;
  /// In the middle of that; likewise.
  [[nodiscard]] std::optional<PathRates<I>> at_middle(const Model<I>& model, const Segment& segment,
                                                      const Over& over) const;

  /// The machine for forms_in_lanes.h; only for Interval, else null.
  [[nodiscard]] const lanes::Machine* lanes() const { return lanes_.get(); }

 private:
  template <int N>
  struct Derivatives {
    explicit Derivatives(const Problem& problem);

    PathRatesModel<I, N> poses;
    std::optional<Evaluator<Taylor<I, N>>> constraints;
  };
  template <int N>
  [[nodiscard]] std::optional<PathRatesOf<I, N>> on_constraints(const Derivatives<N>& of, const Segment& segment,
                                                                const I& range,
                                                                const typename ImpliedParameters<I>::Where& implied,
                                                                const Matrix3<I>* known) const;

  Derivatives<2> second_;
  Derivatives<3> third_;
  std::optional<ConstraintModel<I>> constraints_;
  std::shared_ptr<const lanes::Machine> lanes_;
};

extern template class MotionRates<Interval>;
extern template class MotionRates<MpInterval>;

}  // namespace taut
