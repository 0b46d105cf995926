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
#include <boost/container/static_vector.hpp>
#include <optional>
#include <vector>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"
#include "certify/arithmetic/slope_form.h"
#include "kinematics/jet.h"
#include "kinematics/model.h"
#include "kinematics/segment.h"

namespace taut {

/// The constraints C of a space, ready for scalar I.
template <class I>
struct ConstraintModel {
  Evaluator<I> values;
  Evaluator<Jet<I, kMaxConstrainedParameters>> jets;
  std::size_t count;
};
/// Constants at working_precision(). @pre the space has constraints
template <class I>
[[nodiscard]] ConstraintModel<I> make_constraint_model(const Problem& problem);

/// The space of a problem, ready for scalar I: pose and constraints compiled.
template <class I>
struct MotionModel {
  Evaluator<SlopeForm<I>> pose;
  Angles<I> angles;
  std::optional<ConstraintModel<I>> constraints;
  /// Binary64 numbers certainly inside the closed range of each parameter; all of them where it has none.
  std::vector<std::array<double, 2>> ranges;
};

/// Constants at working_precision().
template <class I>
[[nodiscard]] MotionModel<I> make_motion_model(const Problem& problem);

/// What constraints imply, over T and at m: y of segment.h, as the first of six unknowns of which the others are 0, and
/// λ.
template <class I>
struct ImpliedParameters {
  struct Where {
    Vector6<I> y;
    boost::container::static_vector<I, kMaxConstrainedParameters> lambda;
  };
  Where over, at_mid;
};
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
  std::optional<ImpliedParameters<I>> implied = {};  ///< in a space with constraints
};

/// For t in `range` with midpoint `mid`; `offset` encloses t − mid. Void if a fault was raised.
/// Ranges are examined in spaces with constraints only: elsewhere the waypoints being inside is enough
/// (MotionModel::ranges; ℓ is a convex combination of them).
/// @pre the law is not that of cable lengths
template <class I>
[[nodiscard]] MotionEnclosure<I> enclose_motion(const MotionModel<I>& model, const Segment& segment, const I& range,
                                                const I& mid, const I& offset);

/// Nothing where they are not shown to imply one motion in the tube. Parameters may be out of their ranges. Arguments
/// as of enclose_motion(). @pre the law runs through parameters
template <class I>
[[nodiscard]] std::optional<ImpliedParameters<I>> enclose_implied_parameters(const ConstraintModel<I>& constraints,
                                                                             const Segment& segment, const I& range,
                                                                             const I& mid, const I& offset);

/// A geodesic over T. p is straight, so that its slopes are p'; and R' = [turn] R all along.
template <class I>
struct Geodesic {
  Vector3<SlopeForm<I>> p_WP;  ///< [m]
  Matrix3<SlopeForm<I>> r_WP;
  Vector3<I> turn;  ///< [rad], axes of W
};
/// Nothing where it may be half a turn. Arguments as of enclose_motion().
template <class I>
[[nodiscard]] std::optional<Geodesic<I>> enclose_geodesic(const Segment& segment, const I& range, const I& mid,
                                                          const I& offset);

extern template MotionModel<Interval> make_motion_model(const Problem&);
extern template MotionModel<MpInterval> make_motion_model(const Problem&);
extern template MotionEnclosure<Interval> enclose_motion(const MotionModel<Interval>&, const Segment&, const Interval&,
                                                         const Interval&, const Interval&);
extern template MotionEnclosure<MpInterval> enclose_motion(const MotionModel<MpInterval>&, const Segment&,
                                                           const MpInterval&, const MpInterval&, const MpInterval&);

extern template ConstraintModel<Interval> make_constraint_model(const Problem&);
extern template ConstraintModel<MpInterval> make_constraint_model(const Problem&);
extern template std::optional<ImpliedParameters<Interval>> enclose_implied_parameters(const ConstraintModel<Interval>&,
                                                                                      const Segment&, const Interval&,
                                                                                      const Interval&, const Interval&);
extern template std::optional<ImpliedParameters<MpInterval>> enclose_implied_parameters(
    const ConstraintModel<MpInterval>&, const Segment&, const MpInterval&, const MpInterval&, const MpInterval&);
extern template std::optional<Geodesic<Interval>> enclose_geodesic(const Segment&, const Interval&, const Interval&,
                                                                   const Interval&);
extern template std::optional<Geodesic<MpInterval>> enclose_geodesic(const Segment&, const MpInterval&,
                                                                     const MpInterval&, const MpInterval&);

}  // namespace taut
