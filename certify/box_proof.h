// SPDX-License-Identifier: GPL-3.0-or-later
// The heart: enclosures of lengths, tensions and margins over one box of one segment.
//
// Over a box T with midpoint m, D^-1 is enclosed with its slopes (inverse_bound.h). Hence centred forms of the
// densities λ = D^-1 w of the nominal wrench, of how far K moves them (the rows of D^-1 L for an ellipsoid,
// kinematics/loads.h for items), of the least and the greatest tension, d_i times these, and of the margins
//   low_i − f_lo, f_hi − high_i, d_i − d_lo, d_hi − d_i.
// Proof of each step: docs/theory.md, "A box" and "Loads".
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "certify/arithmetic/dyadic.h"
#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"
#include "certify/arithmetic/slope_form.h"
#include "certify/bodies/body_gaps.h"
#include "certify/loads/item_rows.h"
#include "certify/motion/length_controlled_motion.h"
#include "certify/motion/motion.h"
#include "certify/motion/moving.h"
#include "certify/tolerance/tolerance.h"
#include "kinematics/geometry.h"
#include "kinematics/margin.h"
#include "kinematics/segment.h"

namespace taut {

class ClearPoses;

namespace lanes {
struct Machine;
}

/// The problem ready for scalar I: constants enclosed, expressions compiled.
template <class I>
struct ProofModel {
  Model<I> model;
  MotionModel<I> motion;
  std::optional<ToleranceModel<I>> tolerance;
  ItemRows item_rows;                           ///< of model.loads; only for Interval
  std::shared_ptr<const lanes::Machine> lanes;  ///< the machine for forms_in_lanes.h; only for Interval, else null
  std::optional<BodyModel<I>> bodies;           ///< where the problem has any
  std::optional<MovingModel<I>> moving = {};    ///< where it has limits in time
};

/// At working_precision(). @param slowing  of a move that is run so everywhere
/// @throws InputError where E can't be proved positive definite.
[[nodiscard]] ProofModel<MpInterval> make_mp_proof_model(const Problem& problem,
                                                         const std::optional<Slowing>& slowing = {});
/// In binary64 intervals. @throws InputError likewise.
[[nodiscard]] ProofModel<Interval> make_proof_model(const Problem& problem, const std::optional<Slowing>& slowing = {});

/// The commanded pose of the machine as typed, over a box. Conditions as for enclose_box.
template <class I>
[[nodiscard]] MotionEnclosure<I> undisturbed_motion(const ProofModel<I>& problem, const Segment& segment,
                                                    const EnclosedBox<I>& s, const I& offset);

/// Margins of one box: positive throughout if the claim holds on it.
template <class I>
struct MarginList {
  static constexpr std::size_t kCapacity = std::size_t{4} * kCables;
  struct Entry {
    MarginId id;
    SlopeForm<I> value;  ///< [N] or [m], of the undisturbed machine
    I disturbed;         ///< over all of T, for every deviation that BoxEnclosure::disturbance knows of
  };
  std::array<Entry, kCapacity> entries;
  std::size_t size = 0;

  void add(MarginId id, const SlopeForm<I>& value) { entries.at(size++) = {id, value, value.range}; }
  [[nodiscard]] Entry* begin() { return entries.data(); }
  [[nodiscard]] Entry* end() { return entries.data() + size; }
  [[nodiscard]] const Entry* begin() const { return entries.data(); }
  [[nodiscard]] const Entry* end() const { return entries.data() + size; }

  /// Whether every margin is positive on all of T, as far as disturbances are known.
  [[nodiscard]] bool are_positive() const {
    return std::all_of(begin(), end(), [](const Entry& margin) { return certainly_positive(margin.disturbed); });
  }
};

/// What is known over one box, of the undisturbed machine but for `disturbance`.
template <class I>
struct BoxEnclosure {
  typename MotionEnclosure<I>::Status motion;      ///< nothing below is claimed where it is unproved
  bool regular = false;                            ///< ρ < 1: J is non-singular on all of T, given positive lengths
  std::array<SlopeForm<I>, kCables> length;        ///< d_i [m]
  std::array<SlopeForm<I>, kCables> density;       ///< λ_i [N/m]; this and what follows only where regular
  std::array<SlopeForm<I>, kCables> below, above;  ///< how far K moves it down and up; of an ellipsoid v_ii / d_i
  std::array<SlopeForm<I>, kCables> low, high;     ///< the least and the greatest tension over K [N]
  I offset;                                        ///< contains t − m for all t in T
  MarginList<I> margins;                           ///< those of lengths, and where regular those of tensions
  std::optional<MotionEnclosure<I>> pose;          ///< only where the problem has bodies
  /// Of a move in time: limits less rates, at the midpoint and on all of T. Tensions are those with inertia then, of
  /// every time at which the move is there; their slopes are those at rest.
  struct Rates {
    RateMargins<I> at_mid, over;
    RateMargins<I> undisturbed;  ///< as `over`, with the undisturbed machine's tensions
  };
  std::optional<Rates> rates;
  /// Of a move that may be slowed down: at the midpoint, while it is, something is not shown to be within its limits.
  bool is_slowed_badly = false;
  /// What deviations may change: only where the problem has tolerances, the undisturbed margins are positive on all of
  /// T, and for every deviation the commanded pose is proved to exist, and J to be non-singular.
  std::optional<DeviationBounds<I>> disturbance;
};

/// Void if a fault was raised. For Interval: only under run_upward(); for MpInterval, see Faults<MpInterval>.
/// @param continuation_steps  of deviations (tolerance.h)
template <class I>
[[nodiscard]] BoxEnclosure<I> enclose_box(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& box,
                                          int continuation_steps = 1);

/// What the prover concludes from one box with one scalar.
struct BoxVerdict {
  enum class Kind {
    kProved,        ///< all margins positive (beyond the clearance) on all of T, J non-singular on it
    kTooClose,      ///< the midpoint is within the clearance of a limit, though not beyond it
    kRefuted,       ///< `worst` is proved not positive at the midpoint
    kSplit,         ///< the midpoint is fine; the box is too wide
    kTolerance,     ///< the midpoint is fine undisturbed, and no bound of what deviations change is small enough there
    kPrecision,     ///< at the midpoint itself this scalar can't tell
    kNearSingular,  ///< ρ < 1 could not be had: T is too wide, or D comes close to singular
    kNoMotion,      ///< the motion is only implied, and was not proved to exist on all of T
    kSpansKnot,     ///< T reaches across an inner pose of the reference, and nothing was tried
    kOutOfRange,    ///< at the midpoint a parameter may be outside of its range (only where the motion is implied)
    kNear,          ///< as kProved, but some pairs of bodies are not shown to be apart along the given directions
    kInside,   ///< as kProved, but of one pair a part of a body is inside of the other, a closed mesh, at the midpoint
    kSlowing,  ///< as kSplit, but while the move is slowed down at the midpoint, a limit may not be kept there
    kTooFast,  ///< as kProved, but at the midpoint `rate` is proved to be at its limit or beyond it
    kFault,    ///< some operation left its domain or overflowed: T is too wide, or the pose is not defined
  };
  Kind kind = Kind::kFault;
  MarginId worst;  ///< the margin that decided, or stood in the way
  /// If kTooFast. If kSplit, kPrecision or kTolerance: where all margins are positive, and this rate stands in the way.
  std::optional<RateId> rate;
  /// Only if kRefuted: `worst` is proved not positive on all of T.
  bool throughout = false;
  double tension_N = 0;  ///< proved lower bounds over the box; only if kProved
  double length_m = 0;
  double wrench_scale = 0;  ///< of a move 1: that K may grow is not claimed of it
  double clearance_m = 0;   ///< of all pairs, beyond their clearances; infinite where there are none
  struct NearPair {
    enum class AtMid {
      kApart,             ///< the direction does show it at the midpoint
      kApartUndisturbed,  ///< it does for the machine as typed; deviations may change as much
      kUnknown,
    };
    std::size_t pair = 0;
    AtMid at_mid = AtMid::kUnknown;
  };
  std::vector<NearPair> near;  ///< only if kNear, or one if kInside; none: the free ends of a cable may meet
  /// The largest share of its value at the midpoint that a margin may lose over the box: less than 1 if kProved. It
  /// proves nothing, and tells which size of box would do. Infinite where it is not known.
  double strain = std::numeric_limits<double>::infinity();
};

/// Never throws for mathematical reasons. A planner may ask for more than the claim: with a clearance c >= 0, margins
/// have to exceed c times half the range between the limits (in floating point; what is proved remains that they are
/// positive).
/// @param directions  one for each pair of bodies; null: nothing is asked of bodies
/// @param clear  what is known of poses near by, along the same directions; null: nothing
[[nodiscard]] BoxVerdict judge_box(const ProofModel<Interval>& problem, const Segment& segment, const DyadicBox& box,
                                   double clearance = 0, int continuation_steps = 1,
                                   const PairDirections* directions = nullptr, const ClearPoses* clear = nullptr);
[[nodiscard]] BoxVerdict judge_box(const ProofModel<MpInterval>& problem, const Segment& segment, const DyadicBox& box,
                                   double clearance = 0, int continuation_steps = 1,
                                   const PairDirections* directions = nullptr);

/// Where a pair of bodies is certainly not farther apart than required, on the undisturbed machine, as `found` shows.
enum class Contact {
  kUnknown,
  kAtMid,       ///< certainly at the box's midpoint
  kThroughout,  ///< certainly on all of the box
};
[[nodiscard]] Contact judge_contact(const ProofModel<Interval>& problem, const Segment& segment, const DyadicBox& box,
                                    const PairContact& found);
[[nodiscard]] Contact judge_contact(const ProofModel<MpInterval>& problem, const Segment& segment, const DyadicBox& box,
                                    const PairContact& found);

/// Whether on all of the box exactly one motion is proved to exist, with its parameters in their ranges.
[[nodiscard]] bool is_motion_known(const ProofModel<MpInterval>& problem, const Segment& segment, const DyadicBox& box);

/// Sign of det D at the point s of the segment, proved: −1, +1, or 0 where this precision does not tell, or where the
/// motion is not known.
[[nodiscard]] int determinant_sign(const ProofModel<MpInterval>& problem, const Segment& segment, const Dyadic& s);

extern template MotionEnclosure<Interval> undisturbed_motion(const ProofModel<Interval>&, const Segment&,
                                                             const EnclosedBox<Interval>&, const Interval&);
extern template MotionEnclosure<MpInterval> undisturbed_motion(const ProofModel<MpInterval>&, const Segment&,
                                                               const EnclosedBox<MpInterval>&, const MpInterval&);
extern template BoxEnclosure<Interval> enclose_box(const ProofModel<Interval>&, const Segment&, const DyadicBox&, int);
extern template BoxEnclosure<MpInterval> enclose_box(const ProofModel<MpInterval>&, const Segment&, const DyadicBox&,
                                                     int);

}  // namespace taut
