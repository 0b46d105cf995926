// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/move.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/input_error.h"
#include "certify/box_proof.h"
#include "certify/undecided.h"

namespace taut {
namespace {

constexpr std::size_t kMostControls = 20'000;

/// Rounded up to a multiple of 2^-20 s, above 0.
double law_step(double seconds) { return std::ldexp(std::max(1.0, std::ceil(std::ldexp(seconds, 20))), -20); }

class MovePlanner {
 public:
  MovePlanner(const Prover& prover, const Path& path, const std::stop_token& stop,
              const std::function<void(int)>& progress)
      : prover_(prover),
        quick_(prover.problem(), quick_options(prover)),
        path_(path),
        stop_(stop),
        progress_(progress) {}

  PlannedMove run(const Case& the_case, const MoveRequest& request) {
    propose(the_case);
    for (int round = 0; round < kLocalRounds && !is_proved() && !stop_.stop_requested(); ++round) {
      if (!tighten_where_open()) break;
    }
    if (!is_proved()) slow_down();
    statistics_.planned_s = law().duration_s();
    if (is_proved() && request.speed_share < 1) run_at(request.speed_share);
    if (is_proved() && request.seeks_greatest_speed) seek_greatest_speed();
    statistics_.duration_s = law().duration_s();
    statistics_.speed_share = statistics_.planned_s / statistics_.duration_s;
    return {std::move(best_.path), std::move(best_.proof), std::move(statistics_)};
  }

 private:
  static constexpr int kLocalRounds = 4;
  static constexpr double kNearEnough = 1.005;  ///< quotient of speeds at which bisection ends

  enum class Effort {
    kProve,   ///< what is not proved is undecided, soon
    kRefute,  ///< it may also be refuted
    kAll,     ///< likewise, with all that the prover may spend
  };
  struct Try {
    Path path;
    PathProof proof;
  };

  [[nodiscard]] const TimeLaw& law() const { return *best_.path.timing; }
  [[nodiscard]] bool is_proved() const { return best_.proof.verdict == Verdict::kProved; }

  [[nodiscard]] Try prove(TimeLaw law, Effort effort) {
    if (progress_) progress_(statistics_.tries);
    ++statistics_.tries;
    Try result{path_, {}};
    result.path.timing = std::move(law);
    const auto start = Clock::now();
    result.proof = prove_path(effort == Effort::kAll ? prover_ : quick_, result.path, {}, stop_,
                              effort == Effort::kProve ? ProofAim::kProve : ProofAim::kDecide);
    statistics_.prove_seconds += seconds_since(start);
    return result;
  }
  /// The law `planned`, that many times as slow.
  [[nodiscard]] static TimeLaw slower(TimeLaw planned, double factor) {
    planned.step_s = law_step(planned.step_s * factor);
    return planned;
  }

  void propose(const Case& the_case) {
    const auto start = Clock::now();
    problem_.emplace(TimedPathProblem{prover_.problem(), make_moving_bodies<double>(prover_.problem().load),
                                      make_time_limits(prover_.problem())});
    problem_->limits.jerk = the_case.move.jerk_m_s3;
    if (const auto& within = prover_.problem().time->stopping_time_s) {
      problem_->slowing = 1 / evaluate_constant<double>(*within);
    }
    problem_->tension_loss = tension_losses(prover_, path_, problem_->grid);
    const std::optional<TimedMove> move = time_optimal(path_, *problem_);
    const bool is_usable = move && move->law.controls.size() <= kMostControls;
    if (move) statistics_.fastest_s = move->fastest_s;
    TimeLaw law = is_usable ? move->law : resting_law(path_);
    may_tighten_ = is_usable;
    if (law.controls.size() > kMostControls) {
      throw InputError(
          fmt::format("time: got a path of {} segments, at each of which the move rests, expected a path "
                      "that takes at most {} control values of a time law (planner.smooth: spline)",
                      path_.segments(), kMostControls));
    }
    statistics_.plan_seconds += seconds_since(start);
    best_ = prove(std::move(law), Effort::kProve);
  }

  /// Proposes anew with less of the limits used where the proof failed. @returns whether there was anything to change
  bool tighten_where_open() {
    if (!may_tighten_) return false;
    constexpr double kFactor = 1.04, kAround = 1.0 / 16;
    const auto start = Clock::now();
    for (std::size_t k = 0; k < best_.proof.segments.size(); ++k) {
      const SegmentProof& segment = best_.proof.segments[k];
      if (segment.verdict == Verdict::kProved) continue;
      const DyadicBox& box = segment.witness ? segment.witness->box : segment.open_box;
      const auto begin = static_cast<double>(k);
      problem_->tightened.push_back(
          {begin + box.lower().approx() - kAround, begin + box.upper().approx() + kAround, kFactor});
    }
    const std::optional<TimedMove> move = time_optimal(path_, *problem_);
    statistics_.plan_seconds += seconds_since(start);
    if (!move || move->law.controls.size() > kMostControls) return false;
    best_ = prove(move->law, Effort::kProve);
    return true;
  }

  /// Until it is proved: by factors that grow, then back between the last two.
  void slow_down() {
    const TimeLaw planned = law();
    constexpr int kMostDoublings = 17;  // some 1300 times as slow
    double failed = 1;
    for (int k = 0; k < kMostDoublings && !stop_.stop_requested(); ++k) {
      const double factor = 1 + std::ldexp(0.01, k);
      // What the last one says of itself is the verdict.
      const bool is_last = k + 1 == kMostDoublings;
      best_ = prove(slower(planned, factor), is_last ? Effort::kAll : Effort::kProve);
      if (is_proved()) {
        approach(planned, failed, factor);
        return;
      }
      failed = factor;
    }
  }

  /// Between a factor that is proved, best_, and a smaller one that is not.
  void approach(const TimeLaw& planned, double failed, double proved) {
    while (proved / failed > 2 * kNearEnough - 1 && !stop_.stop_requested()) {
      const double middle = std::sqrt(proved * failed);
      Try next = prove(slower(planned, middle), Effort::kProve);
      if (next.proof.verdict == Verdict::kProved) {
        best_ = std::move(next);
        proved = middle;
      } else {
        failed = middle;
      }
    }
  }

  /// At a share of the planned speed, or slower where that is not proved (power alone may be in the way).
  void run_at(double share) {
    const Try planned = best_;
    double factor = 1 / share;
    constexpr int kMostTries = 40;
    for (int k = 0; k < kMostTries && !stop_.stop_requested(); ++k) {
      best_ = prove(slower(*planned.path.timing, factor), Effort::kProve);
      if (is_proved()) return;
      factor *= 1.1;
    }
    if (!stop_.stop_requested()) best_ = prove(law(), Effort::kAll);
  }

  void seek_greatest_speed() {
    const TimeLaw planned = law();
    GreatestSpeed greatest;
    double proved = 1, failed = 0;
    const auto attempt = [&](double share) {
      Try next = prove(slower(planned, 1 / share), Effort::kRefute);
      const double reached = planned.step_s / next.path.timing->step_s;
      if (next.proof.verdict == Verdict::kRefuted && (!greatest.refuted || reached < *greatest.refuted)) {
        greatest.refuted = reached;
        greatest.witness = next.proof.witness;
      }
      if (next.proof.verdict != Verdict::kProved) {
        failed = share;
      } else if (reached > proved) {
        proved = reached;
        best_ = std::move(next);
      }
    };
    constexpr int kMostDoublings = 17;
    for (int k = 0; k < kMostDoublings && failed == 0 && !stop_.stop_requested(); ++k) {
      attempt(1 + std::ldexp(0.01, k));
    }
    // A step is a multiple of 2^-20 s: below that nothing changes.
    const double finest = 1 + std::ldexp(2 / planned.step_s, -20);
    while (failed / proved > std::max(kNearEnough, finest) && !stop_.stop_requested()) {
      attempt(std::sqrt(proved * failed));
    }
    greatest.proved = proved;
    statistics_.greatest = std::move(greatest);
  }

  /// Of laws that leave a limit nothing, boxes without end would be halved; a slower law takes a few.
  static ProofOptions quick_options(const Prover& prover) {
    ProofOptions options = prover.options();
    options.max_boxes = std::min(options.max_boxes, 10'000);
    options.max_multiprecision_boxes = std::min(options.max_multiprecision_boxes, 20);
    return options;
  }

  const Prover& prover_;
  const Prover quick_;  ///< of the same problem, and gives up sooner
  const Path& path_;
  const std::stop_token& stop_;
  const std::function<void(int)>& progress_;
  std::optional<TimedPathProblem> problem_;
  bool may_tighten_ = false;
  Try best_;  ///< the last one tried; once one is proved, the one that counts
  MoveStatistics statistics_;
};

}  // namespace

PlannedMove plan_move(const Case& the_case, const Prover& prover, const Path& path, const MoveRequest& request,
                      const std::stop_token& stop, const std::function<void(int tries)>& progress) {
  return MovePlanner(prover, path, stop, progress).run(the_case, request);
}

std::vector<TensionLoss> tension_losses(const Prover& prover, const Path& path, std::size_t grid) {
  std::vector<TensionLoss> losses;
  if (!prover.problem().tolerances) return losses;
  constexpr int kDepth = 20;  // so small a box that little is lost to its width
  constexpr long kBoxes = 1L << kDepth;
  Path at_rest = path;
  at_rest.timing.reset();
  for (std::size_t i = 0; i <= path.segments() * grid; ++i) {
    const std::size_t k = std::min(i / grid, path.segments() - 1);
    const double s = static_cast<double>(i - k * grid) / static_cast<double>(grid);
    const long number = std::min(std::lround(s * static_cast<double>(kBoxes)), kBoxes - 1);
    BoxEnclosure<Interval> box;
    bool is_sound = false;
    for (const int continuation_steps : {1, kMostContinuationSteps}) {
      is_sound = run_upward([&] {
        box = enclose_box(prover.model(), at_rest.segment(k), DyadicBox{number, kDepth}, continuation_steps);
      });
      if (is_sound && box.disturbance && box.margins.are_positive()) break;
    }
    TensionLoss& loss = losses.emplace_back();
    if (!is_sound || !box.regular || !box.disturbance) {
      if (i > 0) loss = losses[i - 1];  // as far as is known
      continue;
    }
    loss.turn = box.disturbance->turn;
    for (const auto& margin : box.margins) {
      const bool is_low = margin.id.kind == MarginKind::kTensionMin;
      if (!is_low && margin.id.kind != MarginKind::kTensionMax) continue;
      const double taken = margin.value.at_mid.upper() - margin.disturbed.lower();
      loss.newtons[static_cast<std::size_t>(margin.id.cable)][is_low ? 0 : 1] = std::max(0.0, taken);
    }
  }
  return losses;
}

TimeLaw resting_law(const Path& path) {
  constexpr std::size_t kResting = 3;  // equal control values
  const bool is_spline = path.interpolation == Interpolation::kCubicBSpline;
  TimeLaw law{1, {}};
  for (std::size_t k = 0; k <= path.segments(); ++k) {
    const bool rests = !is_spline || k == 0 || k == path.segments();
    law.controls.insert(law.controls.end(), rests ? kResting : 1, static_cast<double>(k));
  }
  return law;
}

}  // namespace taut
