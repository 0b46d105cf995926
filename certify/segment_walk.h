// SPDX-License-Identifier: GPL-3.0-or-later
// The one loop that proves segments: it judges boxes from left to right, and splits them until each is decided.
//
// Each box is first judged in binary64 intervals; where the midpoint itself can't be told apart from its limit, it
// climbs the ladder of precisions (precision_ladder.h). Before it climbs, a box looks for the point where the margin is
// least, by secants: that point may refute, or show that no rung can tell. There are three verdicts, and "undecided" is
// not "unsafe".
//
// Before that loop, the walk tries to prove the segment in strides: how much of its margins a box lost
// (BoxVerdict::strain) tells how large the next one may be, as the error of a step does in the integration of
// differential equations, and larger boxes are halved without being judged. Unless that proves the segment, the loop
// begins anew and judges every box, because a violation may show at the middle of just such a larger box. So strides
// save boxes of what is proved, and change nothing of what is refuted or left undecided.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "certify/deviation_search.h"
#include "certify/prover.h"

namespace taut {

/// One walk along one segment. Refers to the prover, the segment and the stop token, which outlive it.
class SegmentWalk {
 public:
  enum class Extent {
    kWhole,          ///< until the boxes cover the segment
    kToFirstFailure  ///< or until a box is reported that is not proved; it is the last of the boxes then
  };

  /// @pre prover.is_admissible(segment)
  SegmentWalk(const Prover& prover, const Segment& segment, double clearance, Extent extent,
              const std::stop_token& stop, ProofAim aim = ProofAim::kDecide, const ClearPoses* clear = nullptr);

  /// The boxes of the segment, in order, as far as the extent goes.
  [[nodiscard]] SegmentSurvey run();

  /// After run(): where the last box was given up because of deviations, what one of them breaks elsewhere on the
  /// segment, if that is found.
  [[nodiscard]] std::optional<SegmentWitness> refute_elsewhere();

 private:
  /// A box that is still to be judged, and how.
  struct Task {
    DyadicBox box;
    std::size_t rung = 0;          ///< of the ladder; 0: binary64
    bool is_hopeless = false;      ///< no higher rung is worth trying
    int continuation_steps = 1;    ///< of deviations (tolerance.h)
    std::size_t redirections = 0;  ///< how often it was judged again with other directions of pairs
  };
  /// What to do with a box.
  struct Step {
    enum class Kind {
      kProved,
      kRefuted,   ///< by `witness`
      kSplit,     ///< into halves, on the same rung
      kClimb,     ///< judge the same box on the next rung
      kRefine,    ///< judge the same box again, with more continuation steps
      kRedirect,  ///< judge the same box again, with other directions of pairs of bodies
      kGiveUp,    ///< leave this box open, for `reason`
      kStop,      ///< leave all the rest open, for `reason`
    };
    Kind kind;
    BoxVerdict verdict = {};
    std::optional<SegmentWitness> witness = {};
    Reason reason = {};
  };

  /// Proves the whole segment by boxes of the sizes that earlier ones suggest, in binary64. Returns false as soon as
  /// one box fails for another reason than its width; nothing is reported then.
  [[nodiscard]] bool prove_in_strides();

  [[nodiscard]] Step examine(const Task& task);
  [[nodiscard]] Step examine_split(const Task& task, const BoxVerdict& verdict);
  [[nodiscard]] Step examine_deviations(const Task& task, const BoxVerdict& verdict);
  [[nodiscard]] Step examine_motion(const Task& task, const BoxVerdict& verdict);
  [[nodiscard]] Step examine_singular(const Task& task, const BoxVerdict& verdict);
  [[nodiscard]] Step examine_bodies(const Task& task, const BoxVerdict& verdict);
  [[nodiscard]] bool redirect(const DyadicBox& box, const BoxVerdict& verdict, std::size_t time);
  [[nodiscard]] std::optional<Step> refute_contact(const Task& task, const BoxVerdict& verdict, std::size_t pair);
  [[nodiscard]] std::string pair_name(std::size_t pair) const;
  [[nodiscard]] double gap(std::size_t pair, double s) const;
  [[nodiscard]] double room(std::size_t pair, double s) const;
  [[nodiscard]] double nearest_place(std::size_t pair, const DyadicBox& box) const;
  [[nodiscard]] Step locate_minimum(const Task& task, MarginId margin);
  [[nodiscard]] bool is_proved_inside(const Task& task);
  [[nodiscard]] bool is_singular_between_ends(const DyadicBox& box) const;
  [[nodiscard]] bool may_climb(const Task& task) const;
  [[nodiscard]] bool follows_violation() const;

  void take(const Task& task, Step step);
  void take_refuted(const Task& task, Step step);
  void take_given_up(const Task& task, Step step);
  void report(const Task& task, SurveyedBox::Kind kind, Step step);
  void split(const Task& task, std::size_t rung);

  static constexpr std::size_t kMostRedirections = 2;  ///< of one box

  const Prover& prover_;
  const PrecisionLadder& ladder_;
  const Segment& segment_;
  double clearance_;
  Extent extent_;
  const std::stop_token& stop_;
  ProofAim aim_;
  DeviationSearch deviations_;
  std::shared_ptr<const PairDirections> directions_;  ///< along which pairs were apart last; null: no bodies
  const ClearPoses* clear_;                           ///< along these directions; null: not known
  SegmentSurvey survey_;
  int boxes_of_strides_ = 0;  ///< judged by strides that did not prove the segment
  std::vector<Task> open_ = {Task{}};
  bool is_over_ = false;
  BoxVerdict last_verdict_;
  bool motion_given_up_ = false;                 ///< somewhere on the segment, with all means
  std::map<std::size_t, int> vain_refutations_;  ///< of a pair, with all means
  int singular_open_ = 0;  ///< boxes next to singular poses, or with an undefined pose, that all means left open
  bool deviation_refutes_ = false;  ///< one was found that refutes the segment
};

}  // namespace taut
