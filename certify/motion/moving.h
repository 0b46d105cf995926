// SPDX-License-Identifier: GPL-3.0-or-later
// What time adds to a box: what the load's inertia asks of the cables, and how fast winches and load move.
//
// Over the part `range` of a segment, and over all times at which a move is there: enclosures of ṡ = σ' and s̈ = σ''
// (law_range.h), with them of the platform's velocities and accelerations, and with these of w_in and of all rates
// (kinematics/moving_load.h). As boxes shrink, these enclosures do, in proportion. Speeds are bounded once more, from
// one time in the middle and the accelerations around it: a product such as that of ṡ and dL/ds can't see that one of
// them falls where the other rises, and a move at the limit of a speed would take boxes without number.
// Where a limit is not shown to be kept, these times are halved, and each half is looked at for itself: that takes a
// small part of what a smaller box takes, of which all else is enclosed anew.
// Where a move may be slowed down, ṡ is any share of σ', and s̈ what that leaves of σ'' and a change of the share.
// docs/theory.md, "Moves in time".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"
#include "certify/motion/law_range.h"
#include "certify/motion/motion_rates.h"
#include "certify/motion/slowing.h"
#include "kinematics/moving_load.h"
#include "kinematics/time_limits.h"

namespace taut {

/// A rate's magnitude, and how far below its limit that is; over a box.
template <class I>
struct RateMargin {
  RateId id;
  I size;
  I value;
};

/// w_in = A s̈ + B ṡ², of which A and B depend on the place alone.
template <class I>
struct InertiaByLaw {
  Vector6<I> a, b;
  I acceleration;  ///< s̈ [1/s²]
  I square;        ///< ṡ² [1/s²]
};

/// Which speeds are meant: those of the law, or all at which the move may be run.
enum class Speeds { kOfLaw, kAny };

/// At a place, or over a part of a segment.
template <class I>
struct Moving {
  Vector6<I> wrench;       ///< w_in about P_m, axes of W [N, N m]
  InertiaByLaw<I> by_law;  ///< the same; only where the move may be slowed down
  /// Where the speed is any, of the speeds that no other exceeds.
  std::vector<RateMargin<I>> margins;  ///< of all limits that the problem states, but for those of power
  std::array<I, kCables> winch_speed;  ///< |L̇| when the move is fastest [m/s]
  Matrix3<I> r_WP;
  Rates<I> rates;
};

/// A problem with limits in time, ready for scalar I.
template <class I>
class MovingModel {
 public:
  /// At working_precision(); for Interval under run_upward(). With a `slowing`, of the move that is run so everywhere;
  /// of speeds then nothing is asked, which are least where it is slowed down.
  /// @pre problem.time, and with a slowing, a stopping time
  explicit MovingModel(const Problem& problem, const std::optional<Slowing>& slowing = {});

  /// At one place; nothing where the motion is not proved to be known (MotionRates::over()). @pre segment.timing
  [[nodiscard]] std::optional<Moving<I>> at(const Model<I>& model, const Segment& segment, const I& place,
                                            Speeds speeds = Speeds::kOfLaw) const;
  /// All over a part of the segment, at any speed at which the move may be run; likewise.
  [[nodiscard]] std::optional<Moving<I>> over(const Model<I>& model, const Segment& segment, const I& range) const;
  /// Bounds the margins of over() that are not positive once more, from parts of the times.
  void tighten(const Model<I>& model, const Segment& segment, const I& range, Moving<I>& moving) const;

  /// Whether a move may be slowed down at any place.
  [[nodiscard]] bool may_stop() const { return slowing_.has_value(); }

  /// w_in of a machine that is turned to r_WP, and has these velocities and accelerations.
  [[nodiscard]] Vector6<I> inertia(const Matrix3<I>& r_WP, const Rates<I>& rates) const;
  /// How far w_in may be from that of an undisturbed machine, where the platform is turned by up to `turn`.
  [[nodiscard]] Vector6<I> change(const Moving<I>& undisturbed, const I& turn) const;

  /// The limits of power that the problem states, where the greatest tensions of a box are `tension` [N].
  void add_powers(const Moving<I>& moving, const std::array<I, kCables>& tension,
                  std::vector<RateMargin<I>>& margins) const;

 private:
  struct Limit {
    RateId id;
    I most;
  };
  /// All times at which the move is in a part of a segment, or some of these.
  struct Part {
    const Model<I>& model;
    const Segment& segment;
    TimeCover times;
    I range;  ///< where the move is at these times, as far as that part is concerned
    PathRates<I> path;
    LawRange<I> law;
    Speeds speeds;
  };
  /// No magnitude of a speed is above these while the law is run at its full speed, or slower.
  struct Fastest {
    std::array<I, kCables> winch;
    I load, spin;
  };
  /// Of a move that is slowed down everywhere.
  struct Pace {
    I speed;   ///< τ'
    I change;  ///< τ'' [1/s]
  };
  using Limits = std::uint32_t;  ///< a set of limits_
  [[nodiscard]] Limits all_limits() const { return (Limits{1} << limits_.size()) - 1; }

  class Magnitudes;

  /// σ' and σ'' at these times, or what they are at that pace.
  [[nodiscard]] LawRange<I> law_over(const TimeLaw& law, const TimeCover& times) const;
  [[nodiscard]] std::optional<Part> part_of(const Model<I>& model, const Segment& segment, const I& range,
                                            Speeds speeds) const;
  [[nodiscard]] Moving<I> at_any_time(const Part& part) const;
  /// All but the margins.
  [[nodiscard]] Moving<I> moving(const Part& part) const;
  /// @param by_law  over the part @param cables, load  of which winches, and whether of the load
  [[nodiscard]] std::optional<Fastest> fastest(const Part& part, Magnitudes& by_law,
                                               const std::array<bool, kCables>& cables, bool load) const;
  /// Encloses the rates of the open limits. Returns those of which that does not show that they are kept.
  [[nodiscard]] Limits narrow(const Part& part, Limits open, std::vector<I>& sizes) const;
  /// All of a box, at any speed.
  struct Whole {
    const Model<I>& model;
    const Segment& segment;
    I range;
  };
  /// How far the times of a box were halved until the last parts kept their limits: what is likely to do next.
  struct Halving {
    static constexpr int kMost = 6;  ///< more take as long as smaller boxes
    int likely = 1, kept = 0;
  };
  [[nodiscard]] bool are_kept(const Whole& whole, const TimeCover& times, Limits open, int depth, Halving& halving,
                              std::vector<I>& sizes) const;
  void add_margins(const std::vector<I>& sizes, Moving<I>& to) const;

  MotionRates<I> rates_;
  std::vector<MovingBody<I>> bodies_;
  std::vector<Limit> limits_, powers_;
  std::optional<I> slowing_;  ///< by which share of its speed a move may be slowed down, at most [1/s]
  std::optional<Pace> pace_;  ///< instead, where it is slowed down everywhere
};

extern template class MovingModel<Interval>;
extern template class MovingModel<MpInterval>;

}  // namespace taut
