// SPDX-License-Identifier: GPL-3.0-or-later
// What time adds to a box: what the load's inertia asks of the cables, and how fast winches and load move.
//
// Over the part `range` of a segment, and over all times at which a move is there: enclosures of σ' and σ''
// (law_range.h), with them of the platform's velocities and accelerations, and with these of w_in and of all rates
// (kinematics/moving_load.h). Nothing here is a centred form: as boxes shrink, the enclosures do, in proportion.
// docs/theory.md, "Moves in time".
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"
#include "kinematics/moving_load.h"
#include "kinematics/path_rates.h"
#include "kinematics/time_limits.h"

namespace taut {

/// A limit of a rate, and how far below it the rate's magnitude is; over a box.
template <class I>
struct RateMargin {
  RateId id;
  I value;
};

/// Over a part of a segment.
template <class I>
struct Moving {
  Vector6<I> wrench;                   ///< w_in about P_m, axes of W [N, N m]
  std::vector<RateMargin<I>> margins;  ///< of all limits that the problem states
  Matrix3<I> r_WP;
  Rates<I> rates;
};

/// A problem with limits in time, ready for scalar I.
template <class I>
class MovingModel {
 public:
  /// At working_precision(); for Interval under run_upward(). @pre problem.time
  explicit MovingModel(const Problem& problem);

  /// @pre segment.timing, and PathRatesModel::knows(segment.law); the space has no constraints
  [[nodiscard]] Moving<I> over(const Model<I>& model, const Segment& segment, const I& range) const;

  /// How far w_in may be from that of an undisturbed machine, where the platform is turned by up to `turn`.
  [[nodiscard]] Vector6<I> change(const Moving<I>& undisturbed, const I& turn) const;

 private:
  struct Limit {
    RateId id;
    I most;
  };
  PathRatesModel<I> rates_;
  std::vector<MovingBody<I>> bodies_;
  std::vector<Limit> limits_;
};

extern template class MovingModel<Interval>;
extern template class MovingModel<MpInterval>;

}  // namespace taut
