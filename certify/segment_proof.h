// SPDX-License-Identifier: GPL-3.0-or-later
// Proves or refutes one segment, or says of each of its parts which: boxes from box_proof.h, bisection, a ladder of
// precisions.
//
// Each box is first judged in binary64 intervals; where the midpoint itself can't be told apart from its limit, in MPFR
// intervals of 128, 256, 512, … bits. Before it climbs, a box looks for the point where the margin is least, by secants: that
// point may refute, or show that no rung can tell. Verdicts are three: undecided is not unsafe.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "certify/box_proof.h"
#include "certify/tolerance/deviation.h"
#include "certify/undecided.h"
#include "kinematics/constraint_functions.h"
#include "kinematics/pose_sampler.h"

namespace taut {

enum class Verdict { kProved, kRefuted, kUndecided };

struct ProofOptions {
  /// The last rung of the ladder [bits], at least 128: only what is exactly zero, or takes more, stays undecided.
  mpfr_prec_t max_bits = 4096;
  int max_boxes = 200'000;                ///< boxes judged in one segment
  int max_multiprecision_boxes = 10'000;  ///< of them in MPFR, each of which takes about a millisecond
  /// Depth from which a box for which no motion on the constraints was proved climbs the ladder, and is not split.
  int motion_depth = 12;
  /// Depth from which a box that can't be inverted climbs the ladder and is examined for a change of sign of det J.
  int singular_depth = 16;
  /// Depth from which a box is given up whose margin deviations may exceed: a smaller box would hardly narrow what they
  /// may do.
  int tolerance_depth = 6;
};

/// What refutes a segment, itself proved: a margin that is not positive at the midpoint of `box`, or det D of opposite
/// signs at its two ends.
struct SegmentWitness {
  bool singular = false;
  MarginId margin;  ///< unless singular
  DyadicBox box;
  std::shared_ptr<const Deviation> deviation = nullptr;  ///< of the machine whose margin it is; null: undisturbed
};

struct SegmentProof {
  Verdict verdict = Verdict::kUndecided;
  std::vector<DyadicBox> boxes;  ///< cover [0, 1] in order; only if proved
  double tension_N = 0;          ///< proved lower bounds along the segment; only if proved
  double length_m = 0;
  double wrench_scale = 0;
  std::optional<SegmentWitness> witness;  ///< only if refuted
  DyadicBox open_box;                     ///< only if undecided: the smallest box left
  Reason reason;                          ///< only if undecided
  int boxes_judged = 0;                   ///< including those that were split
  int boxes_multiprecision = 0;
};

/// A part of a segment, and what is known about it.
struct SurveyedBox {
  enum class Kind {
    kProved,
    kViolated,        ///< at every point of it, by one margin
    kViolatedInside,  ///< at the witness
    kSingular,        ///< somewhere between its ends
    kOpen,
  };
  DyadicBox box;
  Kind kind = Kind::kOpen;
  std::optional<SegmentWitness>
      witness;    ///< within `box`; unless kProved or kOpen. kViolated: any of its midpoints will do
  Reason reason;  ///< only if kOpen
};

struct SurveyOptions {
  /// Ends of what is violated are located to boxes of this depth; what is thinner shows in the midpoint of a deeper one.
  int resolution_depth = 12;
};

struct SegmentSurvey {
  std::vector<SurveyedBox> boxes;  ///< cover [0, 1] in order
  double tension_N = 0;            ///< proved lower bounds over the boxes that are proved; infinite where none is
  double length_m = 0;
  double wrench_scale = 0;
  int boxes_judged = 0;
  int boxes_multiprecision = 0;
};

/// A problem ready to be proved about, at every rung of the ladder. Immutable; share it between threads.
class Prover {
 public:
  /// @throws InputError if the problem can't be enclosed (E not positive definite).
  explicit Prover(const Problem& problem, ProofOptions options = {});

  /// The straight segment a→b; where the space has constraints, with a tube that suits it: some room around what floating
  /// point finds on the constraints (2^-30, which will prove nothing, where it finds nothing).
  [[nodiscard]] Segment segment(const Waypoint& a, const Waypoint& b) const;
  [[nodiscard]] double suitable_tube(const Segment& segment) const;

  /// Whether the machine is held by its cables' lengths along a path of this law.
  [[nodiscard]] bool is_held_by_lengths(Interpolation law) const;
  /// `segment` with the tubes that it needs; under the law of cable lengths with inner poses, too (reference_path.h).
  [[nodiscard]] Segment prepared(Segment segment) const;

  /// Claim (docs/certificate-format.md): for every s in [0, 1] the motion γ(s) exists (segment.h), its parameters stay
  /// in their closed ranges, and for every wrench in K at γ(s), J is non-singular and all tensions and lengths are
  /// strictly inside their limits. With a clearance (judge_box) the proof also fails, as undecided, where the segment
  /// comes closer to a limit than that. Thread-safe; restores the caller's rounding mode.
  [[nodiscard]] SegmentProof prove(const Segment& segment, double clearance = 0) const;
  [[nodiscard]] SegmentProof prove(const Waypoint& a, const Waypoint& b, double clearance = 0) const {
    return prove(segment(a, b), clearance);
  }

  /// The claim of prove() box by box, where it does not stop at what it can't prove: for paths of which all violations
  /// are asked for. A segment that is proved costs what prove() takes.
  [[nodiscard]] SegmentSurvey survey(const Segment& segment, const SurveyOptions& options = {}) const;

  /// One box, at the cheapest rung that decides it.
  [[nodiscard]] BoxVerdict judge(const Segment& segment, const DyadicBox& box) const;

  /// Encloses what `margin` limits (f0 − v, f0 + v [N] or d [m]) at the midpoint of a box, at the least precision at
  /// which the margin is seen not to be positive, else at the highest that works.
  /// @throws std::logic_error if there is none.
  [[nodiscard]] MpInterval quantity_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin) const;
  /// The same, of a machine that deviates.
  [[nodiscard]] MpInterval quantity_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin,
                                           const Deviation& deviation) const;

  /// Whether all control points are such as the law asks for, and certainly in their ranges where it runs through parameters.
  [[nodiscard]] bool is_admissible(const Segment& segment) const;
  /// Whether λ lies in the closed ranges of the parameters, certainly. Then so does every segment between two such waypoints.
  [[nodiscard]] bool certainly_in_ranges(const Waypoint& waypoint) const;

  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] const ProofModel<Interval>& model() const { return fast_; }

  /// Set to make prove() return undecided soon, from any thread.
  std::atomic<bool>* interrupt = nullptr;

 private:
  struct Task {
    DyadicBox box;
    std::size_t rung = 0;      ///< 0: binary64
    bool is_hopeless = false;  ///< not worth the ladder
    int parts = 1;             ///< of the ways of deviations (tolerance.h)
  };
  struct Walk;
  struct Step;
  [[nodiscard]] BoxVerdict judge_at(std::size_t rung, const Segment& segment, const DyadicBox& box, double clearance,
                                    int parts) const;
  [[nodiscard]] Step examine(Walk& walk, const Task& task) const;
  [[nodiscard]] Step locate_minimum(Walk& walk, const Task& task, MarginId margin) const;
  /// Whether a box would do that is much narrower, in the middle, with deviations in as many parts.
  [[nodiscard]] bool is_proved_inside(Walk& walk, const Task& task) const;
  [[nodiscard]] bool is_singular_between_ends(const Segment& segment, const DyadicBox& box) const;

  /// That box of tolerance_depth in whose middle an undisturbed `margin` is least, in floating point.
  [[nodiscard]] DyadicBox weakest_box(const Segment& segment, MarginId margin) const;
  /// quantity_at_mid() of a machine that deviates; nothing where that is not proved.
  [[nodiscard]] std::optional<MpInterval> deviated_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin,
                                                          const Deviation& deviation) const;
  /// A deviation that breaks `margin` at the midpoint of a box, proved; a smaller one that breaks any margin, where the worst (to
  /// first order) can't be followed. Nothing if the worst breaks none.
  [[nodiscard]] std::optional<SegmentWitness> refuting_deviation(Walk& walk, const DyadicBox& box,
                                                                 MarginId margin) const;

  Problem problem_;
  ProofOptions options_;
  std::optional<ConstraintFunctions> constraints_;
  ProofModel<Interval> fast_;
  mutable std::once_flag sampler_made_;
  mutable std::optional<PoseSampler> sampler_;  ///< made when first needed, for references
  std::vector<mpfr_prec_t> bits_;               ///< of the rungs
  /// One a rung of the ladder, made when first needed: most problems never climb it.
  struct Rung {
    std::once_flag made;
    std::optional<ProofModel<MpInterval>> model;
  };
  [[nodiscard]] const ProofModel<MpInterval>& fine(std::size_t k) const;
  mutable std::vector<Rung> fine_;
};

}  // namespace taut
