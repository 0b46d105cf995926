// SPDX-License-Identifier: GPL-3.0-or-later
// The soundness campaign: random robots, segments of every law and tolerances, half of them with a hidden violation,
// against a 200-bit oracle (machine.h, trial.h).
//
// For each trial one quantity (f0 − v, f0 + v or d of one cable) is followed along the segment to its extremum s*, and
// with tolerances to the worst deviation x* that a local search finds there. Its limit is set, as an exact decimal of
// 45 digits, a distance δ from the oracle's value at (s*, x*): inside, a violation that may be as narrow as √δ, which
// no sampling sees, or outside. Then
//   - a segment that is violated there must never be "proved";
//   - a "refuted" must stand up to the oracle at its witness;
//   - a "proved" must agree with the oracle at s*, at random points with random deviations, and where a search from
//     there finds the worst ones; what is close in floating point is looked at in 200 bits. The determinant must keep
//     its sign. Where lengths are controlled along the path, there must be one pose in the tube, from wherever in it
//     Newton's method is started.
// Of every 16 seeds (--surveys) one is looked at more closely. Segments along which det J changes its sign get limits
// that nothing reaches: they must never be "proved", and at the two points of a witness the oracle must see the two
// signs. Others are surveyed, as an audit does: proved boxes and violations are held to the oracle. Any breach is
// printed with its seed, and the program exits with 1. δ runs over the decades from 1e-13 to 1 of the range.
//
// The oracle's poses, the quantity that sets the limit, witnesses and signs in doubt are computed in 200 bits. A margin
// at any other point is first asked of binary64 with a bound on its own error (guarded.h: the same templates, the same
// vertices and directions), and of 200 bits wherever it is not 16 times that bound above 0. So nothing is lost: a
// margin that 200 bits would find broken is negative, and then binary64 can't be that sure, unless its bound does not
// hold. This is tested, too: of seeds that are surveyed every margin is computed in both. Where a load has balls and
// discs, of which the judge tries 28 vectors for each cable, that saves most of the time of a judgement.
//
// One seed of eight (--bodies: each) has bodies around the machine, too: hulls, half-spaces, cables, walls thinner than
// any sampling (body_judge.cc, body_scene.cc, scene.h). There the hidden violation is of a pair's clearance, which is
// set δ more or less than the pair's least distance.
//
// Usage: soundness [COUNT [SEED]] [--law LAW] [--tolerances KIND] [--loads KIND] [--bodies] [--undecided] [--surveys N]
// [--kernels N] [--decades N] [--multiprecision N] [--threads N] [--budget SECONDS]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <stop_token>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "base/sha256.h"
#include "certificate/elaborate.h"
#include "shards/dealing.h"
#include "shards/part_files.h"
#include "shards/ranks.h"
#include "tests/soundness/body_judge.h"
#include "tests/soundness/deviations.h"
#include "tests/soundness/limits.h"
#include "tests/soundness/tally.h"
#include "tests/soundness/trial.h"

namespace taut::campaign {
namespace {

// ---- Tables ---------------------------------------------------------------------------------------------------------

/// Calls visit(count) for all of them, always in the same order.
template <class Visit>
void for_each_count(Tally& tally, const Visit& visit) {
  const auto visit_decades = [&](auto& tables) {
    for (Decades& table : tables) {
      for (auto* counts : {&table.violated, &table.violated_refuted, &table.clear, &table.clear_decided}) {
        for (Count& count : *counts) visit(count);
      }
    }
  };
  visit_decades(tally.decades);
  visit_decades(tally.bodies.decades);
  for (auto* counts : {&tally.counts, &tally.bodies.counts}) {
    for (auto& of_law : *counts) {
      for (Counts& c : of_law) {
        for (Count* count : {&c.trials, &c.skipped, &c.proved, &c.refuted, &c.undecided, &c.boxes, &c.multiprecision}) {
          visit(*count);
        }
      }
    }
  }
  for (auto& of_class : tally.bodies.classes) {
    for (Count& count : of_class) visit(count);
  }
  for (auto& of_angles : tally.angles) {
    for (Count& count : of_angles) visit(count);
  }
  for (Count* count :
       {&tally.wrong, &tally.looked_at, &tally.violated_elsewhere, &tally.crossing, &tally.crossing_refuted,
        &tally.surveyed, &tally.margins, &tally.margins_exact, &tally.margins_compared, &tally.kernel_asked,
        &tally.kernel_proofs, &tally.kernel_confirmed, &tally.bodies.with_clear_poses, &tally.bodies.walls,
        &tally.bodies.walls_refuted, &tally.bodies.pairs, &tally.bodies.zones}) {
    visit(*count);
  }
}
static_assert(sizeof(Tally) == sizeof(Count) * (9 * 4 * kDecades + 14 * kLaws * kToleranceKinds + 3 * 4 +
                                                3 * (kPairClasses + 1) + 17),
              "for_each_count() visits all that a Tally has");

std::string text_of(Tally& tally) {
  std::string text;
  for_each_count(tally, [&](Count& count) { text += fmt::format("{} ", count.load()); });
  return text;
}

void add(Tally& tally, const std::string& text) {
  std::istringstream numbers(text);
  for_each_count(tally, [&](Count& count) {
    long more = 0;
    if (!(numbers >> more)) throw InputError("a part of a campaign: got " + text + ", expected all counts");
    count += more;
  });
}

// ---- A trial --------------------------------------------------------------------------------------------------------

class Judge {
 public:
  Judge(std::uint64_t seed, const Options& options, Tally& tally)
      : seed_(seed),
        options_(options),
        random_(seed),
        tally_(tally),
        trial_(make_trial(random_, options.law, options.tolerances, options.loads)) {}

  void run() {
    Counts& counts = tally_.counts[static_cast<std::size_t>(trial_.law)][static_cast<std::size_t>(trial_.tolerances)];
    ++counts.trials;
    approx_.emplace(trial_);
    exact_.emplace(trial_);
    guarded_machine_ = make_machine<Guarded>(trial_.problem);
    guarded_tolerances_ = make_tolerances<Guarded>(trial_.problem);
    matters_ = blocks_that_matter(make_tolerances<double>(trial_.problem));
    id_ = {static_cast<MarginKind>(random_() % 4), static_cast<int>(random_() % 6)};
    if (trial_.law == Law::kCableLengths) propose_reference();
    if (!find_extremum() || !set_limits() || !choose_tube()) {
      ++counts.skipped;
      if (is_surveyed() && crosses_ && !trial_.is_held()) judge_crossing();
      return;
    }
    const Prover prover(trial_.problem, proof_options());
    const Segment segment = prepared(prover);
    const SegmentProof proof = prover.prove(segment);
    if (is_surveyed()) examine_survey(prover.survey(segment), proof.verdict);
    counts.boxes += proof.boxes_judged;
    counts.multiprecision += proof.boxes_multiprecision;
    if (seed_ % options_.kernels == 0) examine_kernel(segment, proof);
    Decades& decades = tally_.decades[table()];
    const auto d = static_cast<std::size_t>(decade_);
    const auto kind = static_cast<std::size_t>(trial_.problem.space.angles.kind);
    ++tally_.angles[kind][static_cast<std::size_t>(proof.verdict)];
    if (proof.verdict == Verdict::kUndecided && !violated_ && has_tolerances() && is_violated_elsewhere()) {
      ++counts.undecided;
      ++tally_.violated_elsewhere;
      return;
    }
    ++(violated_ ? decades.violated : decades.clear)[d];
    switch (proof.verdict) {
      case Verdict::kProved:
        ++counts.proved;
        if (!violated_) ++decades.clear_decided[d];
        examine_proof();
        break;
      case Verdict::kRefuted:
        ++counts.refuted;
        ++(violated_ ? decades.violated_refuted : decades.clear_decided)[d];
        examine_witness(*proof.witness);
        break;
      case Verdict::kUndecided:
        ++counts.undecided;
        // Of violations by tolerances many are.
        if (options_.list_undecided && !(violated_ && has_tolerances()) && !trial_.has_bad_reference) {
          report(violated_ ? "undecided violation" : "undecided",
                 fmt::format("{} boxes; from s = {:.6g}, depth {}: {}", proof.boxes_judged,
                             proof.open_box.lower().approx(), proof.open_box.depth, proof.reason.text()));
        }
        break;
    }
  }

 private:
  [[nodiscard]] ProofOptions proof_options() const {
    ProofOptions result;
    result.max_multiprecision_boxes = options_.multiprecision;
    return result;
  }
  /// The checker's kernel must not prove a box in which a limit is broken, and should confirm what is proved.
  void examine_kernel(const Segment& segment, const SegmentProof& proof) {
    if (trial_.has_bad_reference || trial_.has_lost_row) return;
    // Certificates know no lower limit of a tension below 0. A violated path stays so where the limit is 0.
    Problem problem = trial_.problem;
    problem.query.clear();
    for (auto& limits : problem.robot.tension_N) {
      if (limits.lower.front() != '-') continue;
      if (!violated_ || limits.upper.front() == '-') return;
      limits.lower = "0";
    }
    std::optional<Elaborator> made;
    try {
      made.emplace(problem, segment.law);
    } catch (const checker::Malformed&) {
      return;  // limits that no certificate may state
    }
    const Elaborator& elaborator = *made;
    if (violated_) {
      constexpr int kBoxes = 6;
      for (int k = 0; k < kBoxes; ++k) {
        const int depth = static_cast<int>(random_() % 50);
        const auto all = static_cast<std::uint64_t>(1) << static_cast<unsigned>(depth);
        const auto at = static_cast<std::uint64_t>(best_s_ * static_cast<double>(all));
        const DyadicBox box{std::min(at, all - 1), depth};
        constexpr std::array<int, 4> kBits = {32, 64, 128, 256};
        ++tally_.kernel_asked;
        if (elaborator.one_box(segment, box, kBits[random_() % 4], has_tolerances() ? 1 << (random_() % 5) : 1)) {
          breach(fmt::format("the kernel proves a box of depth {} in which a limit is broken", depth));
        }
      }
    } else if (proof.verdict == Verdict::kProved) {
      ++tally_.kernel_proofs;
      if (elaborator.boxes(segment, proof.boxes)) {
        ++tally_.kernel_confirmed;
      } else if (options_.list_undecided) {
        report("not confirmed by the kernel", fmt::format("{} boxes", proof.boxes.size()));
      }
    }
  }
  void breach(const std::string& what) {
    ++tally_.wrong;
    report("WRONG", what);
  }
  void report(const char* kind, const std::string& what) const {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    fmt::print(stderr,
               "{}: {} (seed {}, {}, tolerances {}, {} of cable {}, delta {:.3e}, row {}, effect {:.1e}, s* {:.17g})\n",
               kind, what, seed_, kLawNames[static_cast<std::size_t>(trial_.law)],
               kToleranceNames[static_cast<std::size_t>(trial_.tolerances)], name(id_.kind), id_.cable + 1, delta_,
               decade_, effect_, best_s_);
  }

  [[nodiscard]] bool is_surveyed() const { return seed_ % options_.surveys == 0; }
  [[nodiscard]] Segment prepared(const Prover& prover) const {
    return trial_.law == Law::kCableLengths ? trial_.curve() : prover.prepared(trial_.curve());
  }

  [[nodiscard]] std::size_t table() const {
    if (trial_.has_bad_reference) return 4;
    if (trial_.has_lost_row) return 5;
    if (has_tolerances()) return effect_ < kMild ? 2 : 3;
    return trial_.law == Law::kCableLengths ? 1 : 0;
  }
  /// Inner poses and tubes as an audit has them; of a bad reference, spoiled.
  void propose_reference() {
    const Segment segment = Prover(trial_.problem).prepared(trial_.curve());
    trial_.pose_tube = segment.pose_tube;
    trial_.inner_poses = segment.inner_poses;
    if (!trial_.has_bad_reference || one_in(random_, 4)) return;
    const auto spoil = [&](PoseTube& tube) {
      const double scale = std::pow(10.0, uniform(random_, -2, 4));
      tube = {scale * tube.position, scale * tube.turn};
    };
    if (one_in(random_, 2)) spoil(trial_.pose_tube);
    if (trial_.inner_poses.empty()) return;
    InnerPose& inner = trial_.inner_poses[random_() % trial_.inner_poses.size()];
    switch (random_() % 4) {
      case 0: spoil(inner.tube); break;
      case 1:
        for (double& x : inner.x) x += std::pow(10.0, uniform(random_, -9, 0)) * uniform(random_, -1, 1);
        break;
      case 2: trial_.inner_poses.erase(trial_.inner_poses.begin()); break;
      default:
        for (std::size_t k = 3; k < inner.x.size(); ++k) inner.x[k] = -inner.x[k];
    }
  }
  [[nodiscard]] bool has_tolerances() const { return trial_.tolerances != ToleranceKind::kNone; }

  /// What is sought to be least; not finite where there is no pose.
  [[nodiscard]] double objective(double s, const Deviation& x, MarginId id) const {
    const auto at = approx_->statics(s, x);
    if (!at) return std::numeric_limits<double>::quiet_NaN();
    return is_upper(id.kind) ? -quantity(*at, id) : quantity(*at, id);
  }

  /// The same for every margin.
  [[nodiscard]] std::array<double, kMargins> objectives(double s, const Deviation& x) const {
    std::array<double, kMargins> result;
    result.fill(std::numeric_limits<double>::quiet_NaN());
    const auto at = approx_->statics(s, x);
    for (std::size_t k = 0; k < kMargins && at; ++k) {
      result[k] = is_upper(margin_id(k).kind) ? -quantity(*at, margin_id(k)) : quantity(*at, margin_id(k));
    }
    return result;
  }

  /// Where to first order one quantity is worst, and every one.
  [[nodiscard]] Deviation worst_deviation(double s, const Deviation& x, MarginId id) const {
    return worst_deviations<1>(x, matters_, [&](const Deviation& y) { return std::array{objective(s, y, id)}; })[0];
  }
  [[nodiscard]] std::array<Deviation, kMargins> all_worst_deviations(double s) const {
    return worst_deviations<kMargins>({}, matters_, [&](const Deviation& y) { return objectives(s, y); });
  }

  /// s* and x*, in floating point, and the ranges of tensions and lengths.
  bool find_extremum() {
    constexpr int kSamples = 48;
    double least = HUGE_VAL;
    double determinant_sign = 0;
    for (int k = 0; k <= kSamples; ++k) {
      const double s = static_cast<double>(k) / kSamples;
      const auto at = approx_->statics(s, Deviation());
      if (!at || !std::isfinite(at->determinant) || determinant_sign * at->determinant < 0 || at->determinant == 0) {
        crosses_ = at && determinant_sign * at->determinant < 0;
        return false;
      }
      determinant_sign = at->determinant > 0 ? 1 : -1;
      include(*at);
      const double value = is_upper(id_.kind) ? -quantity(*at, id_) : quantity(*at, id_);
      if (value < least) {
        least = value;
        best_s_ = s;
      }
    }
    const int rounds = has_tolerances() ? 2 : 1;
    for (int round = 0; round < rounds; ++round) {
      const auto value = [&](double s) { return objective(s, worst_, id_); };
      const double s =
          golden_section(value, std::max(0.0, best_s_ - 1.0 / kSamples), std::min(1.0, best_s_ + 1.0 / kSamples));
      if (value(s) < value(best_s_)) best_s_ = s;
      if (!has_tolerances()) break;
      for (int k = 0; k < 2; ++k) {
        worst_ = worst_deviation(best_s_, worst_, id_);
      }
      const auto at = approx_->statics(best_s_, worst_);
      if (!at || !(determinant_sign * at->determinant > 0)) return false;
      include(*at);
    }
    return std::isfinite(tension_[1] - tension_[0]) && tension_[1] > tension_[0];
  }

  /// Of a path along which floating point sees the sign of det J change.
  void judge_crossing() {
    for (std::size_t i = 0; i < kCables; ++i) {
      trial_.problem.robot.tension_N[i] = {decimal(-1e30), decimal(1e30)};
      trial_.problem.robot.length_m[i] = {decimal(1e-12 * trial_.size), decimal(1e12 * trial_.size)};
    }
    exact_limits_.emplace(trial_.problem);
    const auto begin = exact_at(BigFloat(0.0), Deviation());
    if (!begin) return;
    sign_ = has_positive_determinant(*begin);
    constexpr int kSamples = 48;
    bool changes = false;
    for (int k = 1; k <= kSamples && !changes; ++k) {
      const auto at = exact_at(BigFloat(static_cast<double>(k) / kSamples), Deviation());
      if (!at) return;
      changes = has_positive_determinant(*at) != sign_;
    }
    if (!changes) return;
    ++tally_.crossing;
    const Prover prover(trial_.problem, proof_options());
    const SegmentProof proof = prover.prove(prepared(prover));
    if (proof.verdict == Verdict::kProved) breach("proved, but det J changes its sign");
    if (proof.verdict == Verdict::kUndecided && options_.list_undecided) {
      report("undecided across det J = 0", fmt::format("from s = {:.6g}, depth {}: {}", proof.open_box.lower().approx(),
                                                       proof.open_box.depth, proof.reason.text()));
    }
    if (proof.verdict != Verdict::kRefuted) return;
    ++tally_.crossing_refuted;
    examine_witness(*proof.witness);
  }

  void include(const StaticsAt<double>& at) {
    for (std::size_t i = 0; i < kCables; ++i) {
      tension_[0] = std::min(tension_[0], at.tension_low[i]);
      tension_[1] = std::max(tension_[1], at.tension_high[i]);
      length_[0] = std::min(length_[0], at.length[i]);
      length_[1] = std::max(length_[1], at.length[i]);
    }
  }

  /// All limits loose, then one of them δ inside or outside the oracle's value at (s*, x*).
  bool set_limits() {
    const double tension_width = tension_[1] - tension_[0];
    const double range = is_tension(id_.kind) ? tension_width : std::max(length_[1] - length_[0], 0.01 * length_[1]);
    for (std::size_t i = 0; i < kCables; ++i) {
      trial_.problem.robot.tension_N[i] = {decimal(tension_[0] - tension_width), decimal(tension_[1] + tension_width)};
      trial_.problem.robot.length_m[i] = {decimal(0.5 * length_[0]), decimal(2 * length_[1])};
    }
    decade_ = static_cast<int>(random_() % static_cast<std::uint64_t>(options_.decades));
    delta_ = range * std::pow(10.0, uniform(random_, -kDecades + decade_, -kDecades + decade_ + 1));
    violated_ = one_in(random_, 2);
    const auto at = exact_at(BigFloat(best_s_), worst_);
    if (!at) return false;
    sign_ = has_positive_determinant(*at);
    // Violated: a lower limit moves up, an upper one down. Clear: the other way.
    const BigFloat shift(violated_ == is_upper(id_.kind) ? -delta_ : delta_);
    const BigFloat extremum = quantity(*at, id_);
    limit(trial_.problem, id_) = decimal(extremum + shift);
    exact_limits_.emplace(trial_.problem);
    approx_limits_.emplace(trial_.problem);
    guarded_limits_.emplace(trial_.problem);
    if (has_tolerances() && !trial_.has_bad_reference && !trial_.has_lost_row) {
      const double effect = std::abs(objective(best_s_, Deviation(), id_) - objective(best_s_, worst_, id_));
      const double decade =
          std::floor(std::log10(delta_ / effect)) - kLeastEffect;  // infinite where there is no effect
      decade_ = static_cast<int>(std::clamp(decade, 0.0, kDecades - 1.0));
      effect_ = largest_effect();
    }
    const bool is_within = exact_limits_->margin(extremum, id_) > BigFloat(0.0);
    if (violated_ == is_within) breach("the trial does not violate what it should, or does");
    // Next to singular poses floating point may have seen too little of the other quantities' ranges.
    return violated_ || judge(*at, worst_).feasible;
  }

  /// Whether sampled deviations have poses; and a tube that holds those of the machine as typed, with room.
  bool choose_tube() {
    if (!trial_.is_held()) return true;
    constexpr int kSamples = 16;
    for (int k = 0; k <= kSamples; ++k) {
      const double s = static_cast<double>(k) / kSamples;
      const auto pose = approx_->commanded(s, Deviation());
      if (!pose || !approx_->commanded(s, worst_) || !approx_->commanded(s, random_deviation(random_))) return false;
    }
    return true;
  }

  /// The largest |r_p z| and |r_u z| that lead from one pose to the other.
  static PoseTube distance(const RigidPose<double>& from, const RigidPose<double>& to) {
    Rows<double> back;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) back[i][j] = from.r[j][i];
    }
    const Rows<double> q = to.r * back;
    const double scale = 1 / (1 + q[0][0] + q[1][1] + q[2][2]);
    const Vec<double> p = to.p - from.p;
    PoseTube away;
    for (std::size_t k = 0; k < 3; ++k) {
      away.position = std::max(away.position, std::abs(p[k]));
      const std::size_t i = (k + 1) % 3;
      const std::size_t j = (k + 2) % 3;
      away.turn = std::max(away.turn, std::abs(scale * (q[j][i] - q[i][j])));
    }
    return away;
  }

  /// The machine with a deviation, and where it has its platform, in 200 bits.
  [[nodiscard]] std::optional<MachineAt<BigFloat>> exact_at(const BigFloat& s, const Deviation& x) const {
    const auto pose = exact_->pose(s, x);
    if (!pose) return std::nullopt;
    return MachineAt<BigFloat>{exact_->machine(x), *pose};
  }
  static bool has_positive_determinant(const MachineAt<BigFloat>& at) {
    return determinant(at.machine, at.pose) > BigFloat(0.0);
  }

  struct Judgement {
    bool feasible = true;  ///< every margin is positive
    bool positive_determinant = false;
  };

  /// At one point. Each margin is asked of binary64 with a bound on its error, and of 200 bits unless it is 16 times
  /// that bound above 0. Of seeds that are surveyed every margin is, and the bound must hold.
  Judgement judge(const MachineAt<BigFloat>& at, const Deviation& x) {
    const auto guarded = [](const Vec<BigFloat>& v) {
      Vec<Guarded> result;
      for (std::size_t k = 0; k < 3; ++k) result[k] = Guarded::rounded(to_double(v[k]), 0);
      return result;
    };
    const RigidPose<Guarded> pose{guarded(at.pose.p),
                                  {guarded(at.pose.r[0]), guarded(at.pose.r[1]), guarded(at.pose.r[2])}};
    const StaticsAt<Guarded> first = statics(deviate(guarded_machine_, guarded_tolerances_, x), pose);
    Judgement result;
    for (std::size_t k = 0; k < kMargins; ++k) {
      const MarginId id = margin_id(k);
      const Guarded margin = guarded_limits_->margin(first, id);
      ++tally_.margins;
      if (margin.is_surely_positive() && !is_surveyed()) continue;
      ++tally_.margins_exact;
      const BigFloat exact = exact_limits_->margin(quantity(at, id), id);
      if (!(exact > BigFloat(0.0))) result.feasible = false;
      if (!is_surveyed() || !std::isfinite(margin.error)) continue;
      ++tally_.margins_compared;
      if (!(abs(exact - BigFloat(margin.value)) <= BigFloat(margin.error))) breach("the oracle's bound does not hold");
    }
    const bool is_sure = first.determinant.is_surely_positive() || first.determinant.is_surely_negative();
    result.positive_determinant = is_sure ? first.determinant.value > 0 : has_positive_determinant(at);
    return result;
  }

  void require_feasible(double s, const Deviation& x, const char* where) {
    ++tally_.looked_at;
    const auto at = exact_at(BigFloat(s), x);
    if (!at) return breach(fmt::format("proved, but there is no pose {} (s {:.17g})", where, s));
    const Judgement judgement = judge(*at, x);
    if (!judgement.feasible) breach(fmt::format("proved, but violated {} (s {:.17g})", where, s));
    if (judgement.positive_determinant != sign_) breach(fmt::format("proved, but singular {} (s {:.17g})", where, s));
  }

  /// The least margin in floating point, in parts of its range; where it is little, the point is judged.
  double look_at(double s, const Deviation& x, MarginId& least_id) {
    constexpr double kLittle = 1e-6;
    const auto at = approx_->statics(s, x);
    double least = at ? HUGE_VAL : 0;
    for (const MarginKind kind : kKinds) {
      if (!at) break;
      const double range = is_tension(kind) ? tension_[1] - tension_[0] : length_[1];
      for (int i = 0; i < kCables; ++i) {
        const double margin = approx_limits_->margin(*at, {kind, i}) / range;
        if (margin < least || !std::isfinite(margin)) {
          least = std::isfinite(margin) ? margin : 0;
          least_id = {kind, i};
        }
      }
    }
    if (least < kLittle) require_feasible(s, x, "where floating point says little");
    return least;
  }

  void examine_proof() {
    if (violated_) breach("proved, but violated at s*");
    constexpr int kPoints = 24;
    double least = HUGE_VAL;
    double least_s = best_s_;
    MarginId id = id_;
    for (int k = 0; k < kPoints; ++k) {
      const double s = uniform(random_, 0, 1);
      const Deviation x = has_tolerances() ? random_deviation(random_) : Deviation();
      MarginId here = id_;
      const double margin = look_at(s, x, here);
      if (margin < least) {
        least = margin;
        least_s = s;
        id = here;
      }
      if (k == 0) require_feasible(s, x, "at a random point");
    }
    // Downhill from the least of them, in s and deviation.
    Deviation x;
    const auto value = [&](double s) { return objective(s, x, id); };
    for (int round = 0; round < 2; ++round) {
      if (has_tolerances()) x = worst_deviation(least_s, x, id);
      least_s = golden_section(value, std::max(0.0, least_s - 0.1), std::min(1.0, least_s + 0.1));
    }
    require_feasible(least_s, x, "where a search ended");
    if (trial_.law == Law::kCableLengths) require_one_pose(least_s);
  }

  /// Newton's method, started anywhere in the tube, ends at one and the same pose if it ends in the tube.
  void require_one_pose(double s) {
    const RigidPose<double> reference = approx_->reference(s);
    const Segment curve = trial_.curve();
    const PoseTube tube = reference_piece(curve, s).tube;
    const auto expected = approx_->commanded(s, Deviation());
    if (!expected) return;
    const auto is_inside = [&](const RigidPose<double>& pose, double room) {
      const PoseTube away = distance(reference, pose);
      return away.position <= room * tube.position && away.turn <= room * tube.turn;
    };
    constexpr double kRoom = 1 + 1e-6;
    if (!is_inside(*expected, kRoom)) breach(fmt::format("proved, but the pose is outside its tube (s {:.17g})", s));
    for (int k = 0; k < 3; ++k) {
      const auto in_tube = [&](double size) {
        return Vec<double>{size * uniform(random_, -1, 1), size * uniform(random_, -1, 1),
                           size * uniform(random_, -1, 1)};
      };
      const Vec<double> u = in_tube(tube.turn);
      const RigidPose<double> start{reference.p + in_tube(tube.position),
                                    rotation(Quaternion<double>{u[0], u[1], u[2], 1.0}) * reference.r};
      const auto found = hold(approx_->machine(Deviation()), start, approx_->commanded_lengths(s, Deviation()), 25);
      if (!found || !is_inside(*found, 1 - 1e-6)) continue;
      const PoseTube apart = distance(*expected, *found);
      if (apart.position > 1e-3 * tube.position && apart.position > 1e-6 * trial_.size) {
        breach(fmt::format("proved, but there are two poses in the tube (s {:.17g})", s));
      }
    }
  }

  /// Of any quantity at s*, in parts of its range: what its worst deviation takes.
  double largest_effect() {
    double largest = 0;
    const std::array<Deviation, kMargins> worst = all_worst_deviations(best_s_);
    const std::array<double, kMargins> typed = objectives(best_s_, {});
    for (std::size_t k = 0; k < kMargins; ++k) {
      const MarginId id = margin_id(k);
      const double range = is_tension(id.kind) ? tension_[1] - tension_[0] : length_[1];
      const double effect = std::abs(typed[k] - objective(best_s_, worst[k], id)) / range;
      if (!(effect <= largest)) largest = effect;  // also a NaN
    }
    return largest;
  }

  /// Whether some deviation leads to a violation of any limit, or to a singular pose, as floating point sees it: the
  /// trial is not what it was made for.
  bool is_violated_elsewhere() {
    for (const double s : {best_s_, uniform(random_, 0, 1)}) {
      for (const Deviation& x : all_worst_deviations(s)) {
        const auto at = approx_->statics(s, x);
        if (!at || (at->determinant > 0) != sign_) return true;
        for (std::size_t k = 0; k < kMargins; ++k) {
          if (!(approx_limits_->margin(*at, margin_id(k)) > 0)) return true;
        }
      }
    }
    return false;
  }

  static BigFloat number_of(const Dyadic& s) { return enclose<MpInterval>(s).lower(); }

  /// What an audit says of the parts of a segment.
  void examine_survey(const SegmentSurvey& survey, Verdict verdict) {
    ++tally_.surveyed;
    const BigFloat s_violated(best_s_);
    Dyadic end{0, 0};
    bool all_proved = true;
    int looked_at = 0;
    for (const SurveyedBox& part : survey.boxes) {
      if (part.box.lower() != end) breach("surveyed with a hole or twice");
      end = part.box.upper();
      if (part.witness) examine_witness(*part.witness);
      if (part.kind != SurveyedBox::Kind::kProved) {
        all_proved = false;
        continue;
      }
      const BigFloat lower = number_of(part.box.lower());
      const BigFloat upper = number_of(part.box.upper());
      if (violated_ && !(s_violated < lower) && !(upper < s_violated)) breach("surveyed as proved at s*");
      constexpr int kBoxes = 8;
      if (looked_at++ < kBoxes) {
        const double s = uniform(random_, part.box.lower().approx(), part.box.upper().approx());
        require_feasible(s, has_tolerances() ? random_deviation(random_) : Deviation(), "in a surveyed part");
      }
    }
    if (end != Dyadic{1, 0}) breach("surveyed in part");
    if (verdict == Verdict::kRefuted && all_proved) breach("refuted, but surveyed as proved");
    if (verdict == Verdict::kProved && !all_proved) breach("proved, but not when surveyed");
  }

  void examine_witness(const SegmentWitness& witness) {
    if (witness.singular) {
      const auto lower = exact_at(number_of(witness.box.lower()), Deviation());
      const auto upper = exact_at(number_of(witness.box.upper()), Deviation());
      if (!lower || !upper ||
          !(determinant(lower->machine, lower->pose) * determinant(upper->machine, upper->pose) < BigFloat(0.0))) {
        breach("refuted by a singular pose that is not there");
      }
      return;
    }
    const BigFloat s = number_of(witness.box.mid());
    if (witness.deviation && !exact_->is_within(*witness.deviation)) breach("refuted by what is beyond the tolerances");
    const auto at = witness.deviation ? exact_->witnessed(s, *witness.deviation) : exact_at(s, Deviation());
    if (!at) return breach("refuted where there is no pose");
    if (exact_limits_->margin(quantity(*at, witness.margin), witness.margin) > BigFloat(0.0)) {
      breach("refuted by a false witness");
    }
    if (witness.deviation && trial_.is_held() && has_positive_determinant(*at) != sign_) {
      breach("refuted by a deviation beyond a singular pose");
    }
  }

  std::uint64_t seed_;
  const Options& options_;
  Random random_;
  Tally& tally_;
  Trial trial_;
  std::optional<Motion<double>> approx_;
  std::optional<Motion<BigFloat>> exact_;
  Machine<Guarded> guarded_machine_;
  Tolerances<Guarded> guarded_tolerances_;
  std::vector<bool> matters_;
  std::optional<LimitsOf<double>> approx_limits_;
  std::optional<LimitsOf<Guarded>> guarded_limits_;
  std::optional<LimitsOf<BigFloat>> exact_limits_;
  MarginId id_;
  double best_s_ = 0;
  Deviation worst_;
  bool violated_ = false;
  bool sign_ = false;     ///< of the determinant
  bool crosses_ = false;  ///< it changes
  int decade_ = 0;
  double effect_ = 0;  ///< of the tolerances, see largest_effect()
  double delta_ = 0;
  std::array<double, 2> tension_{HUGE_VAL, -HUGE_VAL};
  std::array<double, 2> length_{HUGE_VAL, -HUGE_VAL};
};

// ---- The campaign ---------------------------------------------------------------------------------------------------

/// @param unit   what δ is measured in; the first row's δ is 10^least of it
/// @returns the share decided of clear trials with δ from 10^from of it
double print_decades(const Decades& table, const char* title, const char* unit, int least, int from) {
  long clear = 0;
  long decided = 0;
  const auto is_empty = [](const auto& counts) {
    return std::ranges::all_of(counts, [](const Count& n) { return n == 0; });
  };
  if (is_empty(table.violated) && is_empty(table.clear)) return 1;
  const auto share = [](const Count& part, const Count& all) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max(1L, all.load()));
  };
  fmt::print("\n{}\n{:<15}  violated  refuted      clear  decided\n", title, fmt::format("delta/{}", unit));
  for (int k = 0; k < kDecades; ++k) {
    const auto d = static_cast<std::size_t>(k);
    fmt::print("1e{:<3} to 1e{:<3}  {:8d} {:7.3f}%   {:8d} {:7.3f}%\n", least + k, least + k + 1,
               table.violated[d].load(), share(table.violated_refuted[d], table.violated[d]), table.clear[d].load(),
               share(table.clear_decided[d], table.clear[d]));
    if (least + k < from) continue;
    clear += table.clear[d];
    decided += table.clear_decided[d];
  }
  return static_cast<double>(decided) / static_cast<double>(std::max(1L, clear));
}

/// Verdicts by law and tolerances.
void print_counts(const std::array<std::array<Counts, kToleranceKinds>, kLaws>& counts) {
  fmt::print("law            tolerances    trials  skipped   proved  refuted undecided  boxes/trial  in MPFR\n");
  for (std::size_t l = 0; l < kLaws; ++l) {
    for (std::size_t t = 0; t < kToleranceKinds; ++t) {
      const Counts& c = counts[l][t];
      if (c.trials == 0) continue;
      const long judged = std::max(1L, c.trials - c.skipped);
      fmt::print("{:<14} {:<10} {:9d} {:8d} {:8d} {:8d} {:9d} {:12.1f} {:8.3f}\n", kLawNames[l], kToleranceNames[t],
                 c.trials.load(), c.skipped.load(), c.proved.load(), c.refuted.load(), c.undecided.load(),
                 static_cast<double>(c.boxes) / static_cast<double>(judged),
                 static_cast<double>(c.multiprecision) / static_cast<double>(judged));
    }
  }
}

void print_angles(const Tally& tally) {
  for (const AngleKind kind :
       {AngleKind::kTiltAndTorsion, AngleKind::kRollPitchYaw, AngleKind::kZyz, AngleKind::kAxis}) {
    const auto& [proved, refuted, undecided] = tally.angles[static_cast<std::size_t>(kind)];
    fmt::print("angles {:<16} {:8d} proved {:8d} refuted {:8d} undecided\n", name(kind), proved.load(), refuted.load(),
               undecided.load());
  }
}

/// @returns the share decided of clear trials without tolerances
double print_bodies(const BodyTally& tally) {
  fmt::print("\nWith bodies\n");
  print_counts(tally.counts);
  for (std::size_t k = 0; k <= kPairClasses; ++k) {
    const auto kind = static_cast<PairClass>(k);
    const auto& [proved, refuted, undecided] = tally.classes[k];
    fmt::print("{:<20} {:8d} proved {:8d} refuted {:8d} undecided\n", name(kind), proved.load(), refuted.load(),
               undecided.load());
  }
  fmt::print("{} paths through thin walls, {} of them refuted\n", tally.walls.load(), tally.walls_refuted.load());
  fmt::print("{} proofs with what is known of poses around\n", tally.with_clear_poses.load());
  fmt::print("{} with a pair that may touch somewhere\n{} distances in 200 bits\n", tally.zones.load(),
             tally.pairs.load());
  const double share =
      print_decades(tally.decades[0], "Bodies along paths of poses, without tolerances", "size", -kDecades, -9);
  print_decades(tally.decades[1], "Bodies along paths of cable lengths, without tolerances", "size", -kDecades, -9);
  print_decades(tally.decades[2], "Bodies with tolerances", "size", -kDecades, -9);
  return share;
}

/// Of so many seeds one is of bodies, unless all are or none.
constexpr std::uint64_t kBodiesEvery = 8;

/// Seeds that are judged together, on one thread.
constexpr long kPart = 256;

/// What determines all counts.
nlohmann::json work_of(const Options& options) {
  const auto number = [](const auto& value) { return value ? static_cast<int>(*value) : -1; };
  return {{"command", "soundness"},         {"taut", TAUT_VERSION},
          {"count", options.count},         {"seed", options.seed},
          {"law", number(options.law)},     {"tolerances", number(options.tolerances)},
          {"loads", number(options.loads)}, {"bodies", number(options.bodies)},
          {"surveys", options.surveys},     {"kernels", options.kernels},
          {"decades", options.decades},     {"multiprecision", options.multiprecision}};
}

std::string run_part(const Options& options, const Task& task) {
  const PrecisionScope precision(oracle::kBits);
  Tally tally;
  const long first = kPart * static_cast<long>(task.part);
  for (long k = first; k < std::min(options.count, first + kPart); ++k) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(k);
    if (options.bodies.value_or(seed % kBodiesEvery == kBodiesEvery - 1)) {
      judge_bodies(seed, options, tally);
    } else {
      Judge(seed, options, tally).run();
    }
  }
  return text_of(tally);
}

/// How a campaign is run.
struct Campaign {
  double budget = 0;  ///< seconds; 0: all seeds
  std::size_t threads = 1;
  std::string parts;  ///< folder of files that keep what is judged, or empty
  std::optional<Shard> shard;
  Ranks* ranks = nullptr;  ///< that share in it
};

/// @returns how many segments were judged.
long judge_all(const Options& options, const Campaign& campaign, Tally& tally) {
  const long count = (options.count + kPart - 1) / kPart;
  std::optional<PartFiles> files;
  if (!campaign.parts.empty()) files.emplace(campaign.parts, work_of(options), static_cast<std::size_t>(count));
  long done = 0;
  const auto take = [&](std::size_t part, const std::string& text) {
    add(tally, text);
    done += std::min(kPart, options.count - kPart * static_cast<long>(part));
  };
  std::vector<Task> tasks;
  for (std::size_t part = 0; part < static_cast<std::size_t>(count); ++part) {
    if (campaign.shard && !campaign.shard->has(part)) continue;
    if (const auto known = files ? files->read(part) : std::nullopt) {
      take(part, *known);
    } else {
      tasks.push_back({part, ""});
    }
  }
  std::stop_source is_over;
  const auto start = std::chrono::steady_clock::now();
  const TaskDone keep = [&](std::size_t task, const std::string& text) {
    if (files) files->write(tasks[task].part, text);
    take(tasks[task].part, text);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (campaign.budget > 0 && seconds > campaign.budget) is_over.request_stop();
  };
  const RunTask run_task = [&](const Task& task) { return run_part(options, task); };
  if (campaign.ranks != nullptr) {
    campaign.ranks->deal(sha256(work_of(options)), tasks, run_task, keep, is_over.get_token());
  } else {
    deal_to_threads(tasks, campaign.threads, run_task, keep, is_over.get_token());
  }
  return done;
}

int run(const Options& options, const Campaign& campaign) {
  rounding_self_test();
  Tally tally;
  const auto start = std::chrono::steady_clock::now();
  const long done = judge_all(options, campaign, tally);
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  print_counts(tally.counts);
  print_angles(tally);
  const std::array<double, 4> share = {
      print_decades(tally.decades[0], "Paths of poses, without tolerances", "range", -kDecades, -9),
      print_decades(tally.decades[1], "Paths of cable lengths, without tolerances", "range", -kDecades, -9),
      print_decades(tally.decades[2], "With tolerances that take up to 1 % of the range of any tension or length",
                    "effect", kLeastEffect, -1),
      print_decades(tally.decades[3], "With larger ones", "effect", kLeastEffect, -1)};
  print_decades(tally.decades[4], "Paths of cable lengths with a bad reference, with and without tolerances", "range",
                -kDecades, -9);
  print_decades(
      tally.decades[5],
      "Paths of cable lengths with a lost row (a singular pose on the way to it), with and without tolerances", "range",
      -kDecades, -9);
  print_bodies(tally.bodies);
  fmt::print("\n{} segments, seed {}: {:.1f} s, {:.0f} a second, {:.2f} ms of processor time each\n", done,
             options.seed, elapsed, static_cast<double>(done) / elapsed,
             1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC / static_cast<double>(done));
  fmt::print("{} of {} proofs confirmed by the checker's kernel; {} boxes with violations given to it\n",
             tally.kernel_confirmed.load(), tally.kernel_proofs.load(), tally.kernel_asked.load());
  fmt::print("{} points judged after proofs; {} WRONG\n", tally.looked_at.load(), tally.wrong.load());
  fmt::print("{} margins judged there and at s*, {} of them in 200 bits; {} bounds of binary64 held to 200 bits\n",
             tally.margins.load(), tally.margins_exact.load(), tally.margins_compared.load());
  fmt::print("{} segments surveyed; {} across det J = 0, {} of them refuted\n", tally.surveyed.load(),
             tally.crossing.load(), tally.crossing_refuted.load());
  if (tally.violated_elsewhere > 0) {
    fmt::print("{} undecided left aside: some deviation leads to a singular pose or beyond another limit\n",
               tally.violated_elsewhere.load());
  }
  fmt::print(
      "Decided with margin > 1e-9 of the range: {:.4f} %; of cable lengths {:.4f} %; with tolerances, and margin > 0.1 "
      "of "
      "their effect: {:.4f} %, with large ones {:.4f} %\n",
      100 * share[0], 100 * share[1], 100 * share[2], 100 * share[3]);
  constexpr double kLeastShare = 0.999;
  return tally.wrong == 0 && share[0] >= kLeastShare ? 0 : 1;
}

template <class Names>
std::map<std::string, std::size_t> by_name(const Names& names) {
  std::map<std::string, std::size_t> result;
  for (std::size_t k = 0; k < names.size(); ++k) result[names[k]] = k;
  return result;
}

int main(int argc, char** argv) {
  CLI::App app("Proves random segments with hidden violations, and holds every verdict to a 200-bit oracle.",
               "soundness");
  Options options;
  Campaign campaign;
  std::size_t threads = 0;
  std::string shard;
  std::optional<std::size_t> law, tolerances, loads;
  app.add_option("COUNT", options.count, "segments");
  app.add_option("SEED", options.seed, "of the first; each has its own, one more");
  app.add_option("--law", law, "one law only")->transform(CLI::CheckedTransformer(by_name(kLawNames)));
  app.add_option("--tolerances", tolerances, "one kind only")
      ->transform(CLI::CheckedTransformer(by_name(kToleranceNames)));
  app.add_option("--loads", loads, "one kind only")->transform(CLI::CheckedTransformer(by_name(kLoadNames)));
  app.add_flag("--bodies,!--no-bodies", options.bodies,
               "with bodies around the machine, or without; else one seed of eight is");
  app.add_flag("--undecided", options.list_undecided,
               "list what is not decided, but for violations by tolerances, with reasons");
  app.add_option("--surveys", options.surveys,
                 "of so many seeds one is surveyed as an audit does, and judged also if it crosses det J = 0 (16)")
      ->check(CLI::PositiveNumber);
  app.add_option("--kernels", options.kernels,
                 "of so many seeds one is given to the checker's kernel, which takes most of the time (1)")
      ->check(CLI::PositiveNumber);
  app.add_option("--decades", options.decades, "only the so many smallest of 13 decades of margins")
      ->check(CLI::Range(1, kDecades));
  app.add_option("--multiprecision", options.multiprecision,
                 "boxes in MPFR after which a segment is left undecided (10000, which can take half a minute)")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", threads, "0: all");
  app.add_option("--budget", campaign.budget, "stop after so many seconds");
  CLI::Option* const parts =
      app.add_option("--parts", campaign.parts, "folder that keeps what is judged; what is there is not judged again");
  app.add_option("--shard", shard, "only shard k of m, as k/m")->needs(parts);
  CLI11_PARSE(app, argc, argv);
  if (law) options.law = static_cast<Law>(*law);
  if (tolerances) options.tolerances = static_cast<ToleranceKind>(*tolerances);
  if (loads) options.loads = static_cast<LoadKind>(*loads);
  if (!shard.empty()) campaign.shard = read_shard(shard);
  campaign.threads = threads > 0 ? threads : usable_threads();
  const auto ranks = Ranks::join([](const std::string& message) { fmt::print(stderr, "soundness: {}\n", message); });
  if (ranks && !ranks->is_first()) {
    ranks->serve(sha256(work_of(options)), [&](const Task& task) { return run_part(options, task); }, {});
    return 0;
  }
  campaign.ranks = ranks.get();
  return run(options, campaign);
}

}  // namespace
}  // namespace taut::campaign

int main(int argc, char** argv) {
  try {
    return taut::campaign::main(argc, argv);
  } catch (const taut::InputError& error) {
    fmt::print(stderr, "soundness: {}\n", error.what());
    return 3;
  }
}
