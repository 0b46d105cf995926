// SPDX-License-Identifier: GPL-3.0-or-later
// Where the platform is during a box of a segment: enclosures of the motion γ, whatever law joins the waypoints.
//
// Without constraints γ(t) = pose(ℓ(t)) (kinematics/segment.h), a function of the waypoints. With constraints C(λ) = 0
// the motion is only implied: γ(t) = pose(ℓ(t) + N(t) y(t)) with y(t) the only zero of g(y, t) = C(ℓ(t) + N(t) y) in
// the tube Y = [−r, r]^k, by the Krawczyk operator of parametric_krawczyk.h. A geodesic has p and R directly; under the
// law of cable lengths length_controlled_motion.h finds them. In every case p and R are centred forms over T. Proofs:
// docs/theory.md, "A motion that is only implied", "Motions between poses".
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"
#include "certify/arithmetic/slope_form.h"
#include "kinematics/jet.h"
#include "kinematics/model.h"
#include "kinematics/segment.h"

namespace taut {

/// The space of a problem, ready for scalar I: pose and constraints compiled.
template <class I>
struct MotionModel {
  Evaluator<SlopeForm<I>> pose;
  Angles<I> angles;
  /// C; only in a space with constraints.
  struct Constraints {
    Evaluator<I> values;
    Evaluator<Jet<I, kMaxConstrainedParameters>> jets;
    std::size_t count;
  };
  std::optional<Constraints> constraints;
  /// Binary64 numbers certainly inside the closed range of each parameter; all of them where it has none.
  std::vector<std::array<double, 2>> ranges;
};

/// Constants at working_precision().
template <class I>
[[nodiscard]] MotionModel<I> make_motion_model(const Problem& problem);

/// γ over a box T with midpoint m.
template <class I>
struct MotionEnclosure {
  enum class Status {
    kKnown,       ///< exactly one motion, enclosed below
    kOutOfRange,  ///< some parameter is not certainly in its range, at m itself
    kRangeWide,   ///< not certainly on all of T
    kUnproved,    ///< T is too wide, the tube is too narrow or too wide, or there is no such motion, or not one only
    kSpansKnot,   ///< T reaches across an inner pose of the reference: not asked
  };
  Status status = Status::kUnproved;
  [[nodiscard]] bool is_enclosed() const { return status != Status::kUnproved && status != Status::kSpansKnot; }
  Vector3<SlopeForm<I>> p_WP;  ///< [m]
  Matrix3<SlopeForm<I>> r_WP;
};

/// For t in `range` with midpoint `mid`; `offset` encloses t − mid. Void if a fault was raised.
/// Ranges are examined in spaces with constraints only: elsewhere the waypoints being inside is enough
/// (MotionModel::ranges; ℓ is a convex combination of them).
/// @pre the law is not that of cable lengths
template <class I>
[[nodiscard]] MotionEnclosure<I> enclose_motion(const MotionModel<I>& model, const Segment& segment, const I& range,
                                                const I& mid, const I& offset);

extern template MotionModel<Interval> make_motion_model(const Problem&);
extern template MotionModel<MpInterval> make_motion_model(const Problem&);
extern template MotionEnclosure<Interval> enclose_motion(const MotionModel<Interval>&, const Segment&, const Interval&,
                                                         const Interval&, const Interval&);
extern template MotionEnclosure<MpInterval> enclose_motion(const MotionModel<MpInterval>&, const Segment&,
                                                           const MpInterval&, const MpInterval&, const MpInterval&);

}  // namespace taut
