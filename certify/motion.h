// Where the platform is during a box of a segment: enclosures of the motion γ, whatever law joins the waypoints.
//
// Without constraints γ(t) = pose(ℓ(t)) (kinematics/segment.h), a function of the waypoints. With constraints C(λ) = 0 the
// motion is only implied: γ(t) = pose(ℓ(t) + N(t) y(t)) with y(t) the zero of g(y, t) = C(ℓ(t) + N(t) y) in the tube
// Y = [−r, r]^k. For a box T with midpoint m, any ŷ in Y and any matrix A, let ρ be the largest row sum of |I − A g_y(Y, T)|. If
// ρ < 1 there is at most one zero in Y for every t in T; and exactly one, y(t), where Y contains the box                 (a)
//   ŷ ± w,   w = max_i (|A g(ŷ, m)|_i + |A g_t(Y, T)|_i |T|/2) / (1 − ρ),                                                (b)
// which then holds y(t). With any box Z around ŷ that holds it, in Y, the parametric Krawczyk operator narrows it to
//   K(T) = ŷ − A g(ŷ, m) − A g_t(Z, T) (T − m) + (I − A g_y(Z, T)) (Z − ŷ).                                              (c)
// y is differentiable, y' = −g_y^-1 g_t, enclosed with the bound of neumann.h; at m alone a box of the size of the residual
// encloses y(m) tightly. So the parameters are centred forms over T as in the explicit case.
// Proof: docs/theory.md, "A motion that is only implied".
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "certify/centered.h"
#include "certify/interval.h"
#include "certify/mp_interval.h"
#include "kinematics/jet.h"
#include "kinematics/model.h"
#include "kinematics/segment.h"

namespace taut {

/// The space of a problem, ready for scalar I: pose and constraints compiled.
template <class I>
struct MotionModel {
  Evaluator<Centered<I>> pose;
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
    kUnproved,    ///< (a) or (b) failed: T is too wide, the tube is too narrow or too wide, or there is no such motion
  };
  Status status = Status::kUnproved;
  Vector3<Centered<I>> p_WP;  ///< [m]
  Matrix3<Centered<I>> r_WP;
};

/// For t in `range` with midpoint `mid`; `offset` encloses t − mid. Void if a fault was raised.
/// Ranges are examined in spaces with constraints only: elsewhere the waypoints being inside is enough
/// (MotionModel::ranges; ℓ is a convex combination of them).
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
