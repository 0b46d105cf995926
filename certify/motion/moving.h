// SPDX-License-Identifier: GPL-3.0-or-later
// What time adds to a box: what the load's inertia asks of the cables, and how fast winches and load move.
//
// Over the part `range` of a segment, and over all times at which a move is there: enclosures of ṡ = σ' and s̈ = σ''
// (law_range.h), with them of the platform's velocities and accelerations, and with these of w_in and of all rates
// (kinematics/moving_load.h). As boxes shrink, these enclosures do, in proportion. Speeds are bounded once more, from
// one time in the middle and the accelerations around it: a product such as that of ṡ and dL/ds can't see that one of
// them falls where the other rises, and a move at the limit of a speed would take boxes without number.
// Where a limit is not shown to be kept, these times are halved, and each half is looked at for itself, and then halves
// of the box likewise: that takes a small part of what smaller boxes take, of which all else is enclosed anew. Tensions
// likewise take the inertia of parts of these times.
// Where a move may be slowed down, ṡ is any share of σ', and s̈ what that leaves of σ'' and a change of the share.
// docs/theory.md, "Moves in time".
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"
#include "certify/motion/law_range.h"
#include "certify/motion/motion_rates.h"
#include "certify/motion/rates_along.h"
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

/// Of all limits that a problem may state: speeds, accelerations and powers of winches, and four of the load.
template <class I>
using RateMargins = boost::container::static_vector<RateMargin<I>, 3 * kCables + 4>;

/// w_in over a set of times.
template <class I>
struct InertialLoad {
  Vector6<I> wrench;       ///< about P_m, axes of W [N, N m]
  InertiaByLaw<I> by_law;  ///< the same; only where the move may be slowed down
};

/// Which speeds are meant: those of the law, or all at which the move may be run.
enum class Speeds { kOfLaw, kAny };

/// At a place, or over a part of a segment.
template <class I>
struct Moving {
  InertialLoad<I> load;
  Matrix3<I> r_WP;
  Rates<I> rates;

  /// After bound_rates(). Where the speed is any, of the speeds that no other exceeds.
  RateMargins<I> margins;              ///< of all limits that the problem states, but for those of power
  std::array<I, kCables> winch_speed;  ///< |L̇| when the move is fastest [m/s]; only where powers are limited

  /// All times at which the move is in a part of a segment, or some of these.
  struct Part {
    TimeCover times;
    I here;  ///< where the move is at these times, as far as that part is concerned
    LawRange<I> law;
    Speeds speeds;
  };
  Part part;
  std::unique_ptr<RatesAlong<I>> along;
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
                                            Speeds speeds = Speeds::kOfLaw,
                                            const KnownMotion<I>* known = nullptr) const;
  /// All over a part of the segment, of which the motion is known, at any speed at which the move may be run; likewise.
  [[nodiscard]] std::optional<Moving<I>> over(const Model<I>& model, const Segment& segment, const I& range,
                                              const KnownMotion<I>& known) const;
  /// w_in at some of the times of over(), at which the move is in a part of the path.
  struct LoadInPart {
    I here;
    InertialLoad<I> load;
  };
  static constexpr int kMostHalvings = 2;
  /// Of all times of over(), halved so often. @param halvings  at most kMostHalvings
  [[nodiscard]] boost::container::static_vector<LoadInPart, 1 << kMostHalvings> load_in_parts(const Moving<I>& over,
                                                                                              int halvings) const;
  /// Sets `margins` and `winch_speed`.
  void bound_rates(Moving<I>& moving) const;
  /// After that, bounds the margins of over() that are not positive once more, from parts of the times.
  void tighten(Moving<I>& moving) const;

  /// Whether a move may be slowed down at any place.
  [[nodiscard]] bool may_stop() const { return slowing_.has_value(); }

  /// w_in of a machine that is turned to r_WP, and has these velocities and accelerations.
  [[nodiscard]] Vector6<I> inertia(const Matrix3<I>& r_WP, const Rates<I>& rates) const;
  /// How far w_in may be from that of an undisturbed machine, where the platform is turned by up to `turn`.
  [[nodiscard]] Vector6<I> change(const Moving<I>& undisturbed, const I& turn) const;

  /// The limits of power that the problem states, where the greatest tensions of a box are `tension` [N].
  void add_powers(const Moving<I>& moving, const std::array<I, kCables>& tension, RateMargins<I>& margins) const;

 private:
  struct Limit {
    RateId id;
    I most;
  };
  using Part = typename Moving<I>::Part;
  /// Of a move that is slowed down everywhere.
  struct Pace {
    I speed;   ///< τ'
    I change;  ///< τ'' [1/s]
  };
  using Limits = std::uint32_t;                                       ///< a set of limits_
  using Sizes = boost::container::static_vector<I, 2 * kCables + 4>;  ///< one a limit

  [[nodiscard]] InertialLoad<I> inertial_load(const PathRates<I>& path, const Rates<I>& rates,
                                              const LawRange<I>& law) const;
  /// The law as it is run at these speeds.
  [[nodiscard]] LawRange<I> at_speeds(const LawRange<I>& at_full_speed, Speeds speeds) const;
  /// Some times at which the move is in along.range(), at any speed; nothing where it is not there at these times.
  [[nodiscard]] std::optional<Part> part_at(const RatesAlong<I>& along, const TimeCover& times) const;
  /// σ' and σ'' at these times, or what they are at that pace.
  [[nodiscard]] LawRange<I> law_over(const TimeLaw& law, const TimeCover& times) const;
  /// The middle of a part's times, and where the move is then: nothing where that is not certain to be in the part.
  struct Middle {
    LawInstant<I> time;
    I place;
  };
  [[nodiscard]] static std::optional<Middle> middle_of_times(const RatesAlong<I>& along, const Part& part);
  /// Where a part may be slowed down: at each time accelerations are convex in (τ'², τ''), so that none is larger than
  /// at the law's own speed or at one of these.
  using Corners = boost::container::static_vector<LawRange<I>, 3>;
  [[nodiscard]] Corners corners_of(const RatesAlong<I>& along, const Part& part) const;
  [[nodiscard]] I magnitude(RatesAlong<I>& along, const Part& part, const Corners& corners, const RateId& id) const;
  /// Encloses the rates of the open limits. Returns those of which that does not show that they are kept.
  [[nodiscard]] Limits narrow(RatesAlong<I>& along, const Part& part, Limits open, Sizes& sizes) const;
  /// How far the times of a box were halved until the last parts kept their limits: what is likely to do next.
  struct Halving {
    static constexpr int kMost = 3;  ///< more seldom do
    int likely = 1, kept = 0;
  };
  /// Whether limits are kept at all of these times at which the move is in along.range(). `sizes` grow by what is
  /// found.
  [[nodiscard]] bool are_kept(RatesAlong<I>& along, const TimeCover& times, Limits open, int depth, Halving& halving,
                              Sizes& sizes) const;
  /// Likewise; where that fails, of both halves of the part that `along` is over, and so on. All or none are found.
  [[nodiscard]] bool are_kept_over(RatesAlong<I>& along, const TimeCover& times, Limits open, Sizes& sizes,
                                   int bisections) const;
  static constexpr int kMostBisections = 2;  ///< more take as long as smaller boxes

  MotionRates<I> rates_;
  std::vector<MovingBody<I>> bodies_;
  std::vector<Limit> limits_, powers_;
  std::optional<I> slowing_;  ///< by which share of its speed a move may be slowed down, at most [1/s]
  std::optional<Pace> pace_;  ///< instead, where it is slowed down everywhere
};

extern template class MovingModel<Interval>;
extern template class MovingModel<MpInterval>;

}  // namespace taut
