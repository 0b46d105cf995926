// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/soundness/body_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "certificate/elaborate.h"
#include "tests/soundness/body_scene.h"
#include "tests/soundness/deviations.h"
#include "tests/soundness/limits.h"

namespace taut::campaign {
namespace {

/// With dozens of pairs a box takes long; more of them decide little.
constexpr int kMostMultiprecisionBoxes = 60;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_equal(const DecimalText& a, const DecimalText& b) {
  return !(number<BigFloat>(a) < number<BigFloat>(b)) && !(number<BigFloat>(b) < number<BigFloat>(a));
}

/// What is counted as one anchor, being stated at one place with one tolerance, deviates as one.
class SharedAnchors {
 public:
  explicit SharedAnchors(const Problem& problem) {
    const TolerancesText tolerances = problem.tolerances.value_or(TolerancesText{});
    const auto find = [](const auto& anchors, const auto& sizes, std::array<std::size_t, kCables>& leader) {
      for (std::size_t j = 0; j < kCables; ++j) {
        leader[j] = j;
        for (std::size_t i = j; i-- > 0;) {
          bool same = is_equal(sizes[i], sizes[j]);
          for (std::size_t k = 0; k < 3; ++k) same = same && is_equal(anchors[i][k], anchors[j][k]);
          if (same) leader[j] = leader[i];
        }
      }
    };
    find(problem.robot.base_anchors_m, tolerances.base_anchor_m, base_);
    find(problem.robot.platform_anchors_m, tolerances.platform_anchor_m, platform_);
  }
  [[nodiscard]] Deviation tied(Deviation x) const {
    for (std::size_t j = 0; j < kCables; ++j) {
      x.a[j] = x.a[base_[j]];
      x.b[j] = x.b[platform_[j]];
    }
    return x;
  }

 private:
  std::array<std::size_t, kCables> base_{}, platform_{};
};

class BodyJudge {
 public:
  BodyJudge(std::uint64_t seed, const Options& options, Tally& tally)
      : seed_(seed),
        options_(options),
        random_(seed),
        tally_(tally),
        trial_(make_trial(random_, options.law, options.tolerances, options.loads, seed % 2 == 0)) {}

  void run() {
    BodyTally& bodies = tally_.bodies;
    Counts& counts = bodies.counts[static_cast<std::size_t>(trial_.law)][static_cast<std::size_t>(trial_.tolerances)];
    ++counts.trials;
    if (!make_machine_and_bodies() || !choose_target() || !find_extremum() || !set_clearance()) {
      ++counts.skipped;
      return;
    }
    ProofOptions options;
    options.max_multiprecision_boxes = std::min(options_.multiprecision, kMostMultiprecisionBoxes);
    const Prover prover(trial_.problem, options);
    const Segment segment = trial_.law == Law::kCableLengths ? trial_.curve() : prover.prepared(trial_.curve());
    const std::unique_ptr<const ClearPoses> clear = some_clear_poses(prover, segment);
    const SegmentProof proof = prover.prove(segment, 0, {}, ProofAim::kDecide, clear.get());
    if (clear) ++bodies.with_clear_poses;
    counts.boxes += proof.boxes_judged;
    counts.multiprecision += proof.boxes_multiprecision;
    const bool is_closely_looked_at = seed_ % options_.surveys == 0;
    if (is_closely_looked_at) examine_survey(prover.survey(segment), proof.verdict);
    if (seed_ % options_.kernels == 0) examine_kernel(segment, proof, is_closely_looked_at);
    ++bodies.classes[static_cast<std::size_t>(target_.kind)][static_cast<std::size_t>(proof.verdict)];
    Decades& decades = bodies.decades[has_tolerances() ? 2 : trial_.law == Law::kCableLengths ? 1 : 0];
    const auto d = static_cast<std::size_t>(decade_);
    if (known_) {
      ++bodies.walls;
      if (proof.verdict == Verdict::kRefuted) ++bodies.walls_refuted;
    } else {
      ++(violated_ ? decades.violated : decades.clear)[d];
    }
    switch (proof.verdict) {
      case Verdict::kProved:
        ++counts.proved;
        if (!violated_) ++decades.clear_decided[d];
        examine_proof(proof);
        break;
      case Verdict::kRefuted:
        ++counts.refuted;
        if (!known_) ++(violated_ ? decades.violated_refuted : decades.clear_decided)[d];
        examine_witness(*proof.witness);
        break;
      case Verdict::kUndecided:
        ++counts.undecided;
        if (options_.list_undecided && !(violated_ && has_tolerances())) {
          report(violated_ ? "undecided contact" : "undecided",
                 fmt::format("{} boxes; from s = {:.6g}, depth {}: {}", proof.boxes_judged,
                             proof.open_box.lower().approx(), proof.open_box.depth, proof.reason.text()));
        }
        break;
    }
  }

 private:
  void breach(const std::string& what) {
    ++tally_.wrong;
    report("WRONG", what);
  }
  void report(const char* kind, const std::string& what) const {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    fmt::print(
        stderr, "{}: {} (seed {} with bodies, {}, tolerances {}, {} {} {}, {}, delta {:.3e} of {:.3e}, s* {:.17g})\n",
        kind, what, seed_, kLawNames[static_cast<std::size_t>(trial_.law)],
        kToleranceNames[static_cast<std::size_t>(trial_.tolerances)], name(target_.kind), target_.first, target_.second,
        known_      ? "wall"
        : violated_ ? "too near"
                    : "clear",
        delta_, trial_.size, best_s_);
  }
  /// What a path's proof may know around a segment: nothing, or what holds at poses along it.
  [[nodiscard]] std::unique_ptr<const ClearPoses> some_clear_poses(const Prover& prover, const Segment& segment) {
    const auto around = [&](int steps, const ClearPoses* wider, ClearPoses::Use use) {
      std::vector<taut::RigidPose> poses;
      for (int k = 0; k <= steps; ++k) {
        poses.push_back(prover.sampler().rigid_pose(segment, static_cast<double>(k) / steps));
      }
      return prover.clear_poses(poses, wider, use);
    };
    if (one_in(random_, 3)) return nullptr;
    if (one_in(random_, 2)) return around(1, nullptr, ClearPoses::Use::kProofs);
    const std::unique_ptr<const ClearPoses> wider = around(2, nullptr, ClearPoses::Use::kSmaller);
    return wider ? around(4, wider.get(), ClearPoses::Use::kProofs) : nullptr;
  }
  [[nodiscard]] bool has_tolerances() const { return trial_.tolerances != ToleranceKind::kNone; }
  [[nodiscard]] Deviation some_deviation() {
    return has_tolerances() ? anchors_->tied(random_deviation(random_)) : Deviation();
  }

  // ---- Making a trial ----

  /// Limits that nothing reaches, and bodies.
  bool make_machine_and_bodies() {
    if (trial_.problem.tolerances) {  // of anchors that are one
      TolerancesText& t = *trial_.problem.tolerances;
      for (std::size_t k = 0; k < kCables; ++k) {
        if (one_in(random_, 4)) continue;
        if (k % 2 == 1) t.base_anchor_m[k] = t.base_anchor_m[k - 1];
        if (k % 2 == 1) t.platform_anchor_m[(k + 1) % kCables] = t.platform_anchor_m[k];
      }
    }
    if (trial_.law == Law::kCableLengths) {
      const Segment segment = Prover(trial_.problem).prepared(trial_.curve());
      trial_.pose_tube = segment.pose_tube;
      trial_.inner_poses = segment.inner_poses;
    }
    approx_.emplace(trial_);
    const auto middle = approx_->commanded(0.5, Deviation());
    if (!middle) return false;
    choose_load(trial_, *middle, random_);
    approx_.emplace(trial_);
    exact_.emplace(trial_);
    anchors_.emplace(trial_.problem);
    matters_ = blocks_that_matter(make_tolerances<double>(trial_.problem));
    double shortest = kInfinity;
    if (!set_limits(shortest)) return false;
    const bool is_wall = one_in(random_, 6);
    known_ = choose_bodies(trial_, *approx_, *exact_, shortest, is_wall, random_);
    return known_.has_value() == is_wall;
  }

  bool set_limits(double& shortest) {
    constexpr int kPoses = 16;
    std::array<double, 2> tension{kInfinity, -kInfinity}, length = tension;
    double sign = 0;
    for (int k = 0; k <= kPoses; ++k) {
      const auto at = approx_->statics(static_cast<double>(k) / kPoses, Deviation());
      if (!at || !std::isfinite(at->determinant) || !(at->determinant * (sign == 0 ? at->determinant : sign) > 0)) {
        return false;
      }
      sign = at->determinant > 0 ? 1 : -1;
      for (std::size_t i = 0; i < kCables; ++i) {
        tension = {std::min(tension[0], at->tension_low[i]), std::max(tension[1], at->tension_high[i])};
        length = {std::min(length[0], at->length[i]), std::max(length[1], at->length[i])};
      }
    }
    const double width = tension[1] - tension[0];
    if (!std::isfinite(width) || !(width > 0)) return false;
    const bool is_pulling = tension[0] > 0.01 * width;
    for (std::size_t i = 0; i < kCables; ++i) {
      trial_.problem.robot.tension_N[i] = {is_pulling ? DecimalText("0") : decimal(tension[0] - 10 * width),
                                           decimal(tension[1] + 10 * width)};
      trial_.problem.robot.length_m[i] = {decimal(0.1 * length[0]), decimal(10 * length[1])};
    }
    shortest = length[0];
    return true;
  }

  /// The least distance of each pair, of so many samples of the machine as typed.
  struct Scanned {
    ScenePair pair;
    double least = kInfinity, s = 0;
  };
  static constexpr int kSamples = 20;
  std::vector<Scanned> scan() {
    std::vector<Scanned> result;
    for (const ScenePair& pair : scene_pairs(*trial_.problem.bodies)) result.push_back({pair});
    approx_scene_.emplace(*trial_.problem.bodies);
    for (int k = 0; k <= kSamples; ++k) {
      const double s = static_cast<double>(k) / kSamples;
      const auto pose = approx_->pose(s, Deviation());
      if (!pose) return {};
      const Machine<double> machine = approx_->machine(Deviation());
      for (Scanned& of : result) {
        if (!of.pair.cone && rough_distance(approx_scene_->at(of.pair, machine, *pose)) > of.least) continue;
        const double distance = approx_scene_->distance(of.pair, machine, *pose);
        if (distance < of.least) of = {of.pair, distance, s};
      }
    }
    return result;
  }

  /// Which pair decides, and the clearances of all others: some are not checked.
  bool choose_target() {
    std::vector<Scanned> scanned = scan();
    if (scanned.empty()) return false;
    const auto is_left = [&](const Scanned& of) { return of.pair.cone && !(of.least > 0.01 * trial_.size); };
    if (std::ranges::any_of(scanned, is_left)) {
      std::vector<ExitConeText> kept;
      for (const Scanned& of : scanned) {
        if (of.pair.cone && !is_left(of)) kept.push_back(*of.pair.cone);
      }
      trial_.problem.bodies->exit_cones = kept;
      scanned = scan();
      if (scanned.empty()) return false;
    }
    const auto nearest = [&](PairClass kind) {
      const Scanned* least = nullptr;
      for (const Scanned& of : scanned) {
        if (of.pair.kind == kind && (least == nullptr || of.least < least->least)) least = &of;
      }
      return least;
    };
    const double touching = 1e-9 * trial_.size;
    std::vector<PairClass> usable;
    for (const PairClass kind : all_pair_classes()) {
      const Scanned* least = nearest(kind);
      if (least != nullptr && least->least > touching) usable.push_back(kind);
    }
    if (nearest(PairClass::kExitCones) != nullptr) usable.push_back(PairClass::kExitCones);
    if (known_) {
      target_ = {known_->kind, known_->first, known_->second, "0"};
    } else {
      if (usable.empty()) return false;
      const Scanned* target = nearest(usable[random_() % usable.size()]);
      if (target->pair.kind <= PairClass::kCablesObstacles && one_in(random_, 2)) {
        bring_nearer(*target);
        scanned = scan();
        if (scanned.empty()) return false;
        target = nearest(target_.kind);
        if (!(target->least > 0)) return false;
      }
      target_ = target->pair;
      best_s_ = target->s;
    }
    BodiesText& bodies = *trial_.problem.bodies;
    for (const PairClass kind : all_pair_classes()) {
      auto& clearance = bodies.clearance_m[static_cast<std::size_t>(kind)];
      const Scanned* least = nearest(kind);
      if (least == nullptr) continue;
      const double little = 0.3 * std::max(0.0, least->least);
      if (kind == target_.kind) {
        clearance = known_ || one_in(random_, 3) ? "0" : decimal(little);
      } else if (!(least->least > touching) || one_in(random_, 4)) {
        clearance.reset();
      } else {
        clearance = one_in(random_, 3) ? "0" : decimal(little);
      }
    }
    choose_own_clearance(scanned);
    return true;
  }

  /// Moves the obstacle of a pair towards the other body, at the sample at which it is nearest.
  void bring_nearer(const Scanned& target) {
    target_ = target.pair;
    const auto pose = approx_->pose(target.s, Deviation());
    const auto solids = approx_scene_->at(target.pair, approx_->machine(Deviation()), *pose);
    const double left = trial_.size * std::pow(10.0, uniform(random_, -6, -1));
    if (!(left < target.least)) return;
    Vec<double> apart = solids[1].normal;
    if (!solids[1].is_half_space) apart = nearest_features(solids[0].points, solids[1].points).apart;
    apart = ((target.least - left) / std::sqrt(dot(apart, apart))) * apart;
    BodyText& body = trial_.problem.bodies->obstacles[target.pair.second];
    for (std::size_t k = 0; k < 3; ++k) {
      body.at_m[k] = fmt::format("{:.15e}", number<double>(body.at_m[k]) + apart[k]);
    }
  }

  /// Of some body, one that changes no verdict.
  void choose_own_clearance(const std::vector<Scanned>& scanned) {
    BodiesText& bodies = *trial_.problem.bodies;
    const bool is_carried = bodies.obstacles.empty() || one_in(random_, 2);
    std::vector<BodyText>& list = is_carried ? bodies.platform : bodies.obstacles;
    if (list.empty() || one_in(random_, 2)) return;
    BodyText& body = list[random_() % list.size()];
    double least = kInfinity;
    for (const Scanned& of : scanned) {
      const PairClass kind = of.pair.kind;
      if (of.pair.cone || !bodies.clearance_m[static_cast<std::size_t>(kind)]) continue;
      if (name_of_first(bodies, kind, of.pair.first) == body.name ||
          name_of_second(bodies, kind, of.pair.second) == body.name) {
        least = std::min(least, of.least);
      }
    }
    if (least > 0 && std::isfinite(least)) body.clearance_m = decimal(0.3 * least);
  }

  /// Of a pair at s, of a machine that deviates.
  [[nodiscard]] double distance(double s, const Deviation& x, const ScenePair& pair) const {
    const auto pose = approx_->pose(s, x);
    if (!pose) return std::numeric_limits<double>::quiet_NaN();
    if (pair.cone) return angle_left(pair, approx_->machine(x), *pose);
    return approx_scene_->distance(pair, approx_->machine(x), *pose);
  }
  /// Of an exit cone: a − t, which has the sign of its distance, wherever that is largest.
  [[nodiscard]] static double angle_left(const ScenePair& pair, const Machine<double>& machine,
                                         const RigidPose<double>& pose) {
    return number<double>(pair.cone->half_angle_rad) - angle_in_cone(pair, machine, pose);
  }
  /// What the pair has to be farther apart than at s, which the machine as typed decides.
  [[nodiscard]] double asked(double s, const ScenePair& pair) const {
    if (pair.zones.empty()) return number<double>(pair.clearance);
    const auto pose = approx_->pose(s, Deviation());
    return pose ? required(pair, pose->p) : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] BigFloat exactly_asked(double s, const ScenePair& pair) const {
    const auto pose = pair.zones.empty() ? std::nullopt : exact_->pose(BigFloat(s), Deviation());
    return pose ? required(pair, pose->p) : number<BigFloat>(pair.clearance);
  }
  [[nodiscard]] Deviation worst_deviation(double s, const Deviation& x, const ScenePair& pair) const {
    return anchors_->tied(worst_deviations<1>(
        x, matters_, [&](const Deviation& y) { return std::array{distance(s, anchors_->tied(y), pair)}; })[0]);
  }
  /// In 200 bits; nothing where there is no pose.
  [[nodiscard]] std::optional<BigFloat> exact_distance(double s, const Deviation& x, const ScenePair& pair) const {
    const auto exact = exact_->pose(BigFloat(s), x);
    if (!exact) return std::nullopt;
    RigidPose<double> rounded;
    for (std::size_t i = 0; i < 3; ++i) {
      rounded.p[i] = to_double(exact->p[i]);
      for (std::size_t j = 0; j < 3; ++j) rounded.r[i][j] = to_double(exact->r[i][j]);
    }
    ++tally_.bodies.pairs;
    if (pair.is_signed()) return exact_scene_->distance(pair, exact_->machine(x), *exact);
    return distance_of(exact_scene_->at(pair, exact_->machine(x), *exact),
                       approx_scene_->at(pair, approx_->machine(x), rounded));
  }

  /// s* and x* of the pair that decides.
  bool find_extremum() {
    exact_scene_.emplace(*trial_.problem.bodies);
    if (known_) {
      best_s_ = known_->s;
      return true;
    }
    for (int round = 0; round < (has_tolerances() ? 2 : 1); ++round) {
      const auto value = [&](double s) { return distance(s, worst_, target_); };
      const double s =
          golden_section(value, std::max(0.0, best_s_ - 1.0 / kSamples), std::min(1.0, best_s_ + 1.0 / kSamples));
      if (value(s) < value(best_s_)) best_s_ = s;
      if (!has_tolerances()) break;
      for (int k = 0; k < 2; ++k) worst_ = worst_deviation(best_s_, worst_, target_);
    }
    return std::isfinite(distance(best_s_, worst_, target_));
  }

  /// Lets the target touch, as deep as it is at (s*, x*) when the obstacle has been moved into the other body, more or
  /// less δ; or only where p is nearer to a place than at s*, more or less δ, where it is as near as it is.
  bool set_zone(BigFloat found) {
    BodiesText& bodies = *trial_.problem.bodies;
    const auto at_random = exact_->pose(BigFloat(uniform(random_, 0, 1)), Deviation());
    if (!at_random) return false;
    ContactZoneText zone;
    for (std::size_t k = 0; k < 3; ++k) zone.at_m[k] = fmt::format("{:.9f}", to_double(at_random->p[k]));
    zone.within_m = decimal(100 * trial_.size);
    zone.depth_m = "1";
    const std::array<std::string, 2> pair{bodies.platform[target_.first].name, bodies.obstacles[target_.second].name};
    const auto set = [&] {
      bodies.contacts = {{one_in(random_, 2) ? pair : std::array{pair[1], pair[0]}, zone}};
      target_.zones = {zone};
    };
    set();
    if (one_in(random_, 2)) {  // at the rim
      const auto at_s = exact_->pose(BigFloat(best_s_), Deviation());
      if (!at_s) return false;
      BigFloat square(0.0);
      for (std::size_t k = 0; k < 3; ++k) {
        const BigFloat d = at_s->p[k] - number<BigFloat>(zone.at_m[k]);
        square = square + d * d;
      }
      const BigFloat within = root(square) + BigFloat(violated_ ? -delta_ : delta_);
      if (!(within > BigFloat(0.0))) return false;
      zone.within_m = decimal(within);
      zone.depth_m = decimal(trial_.size);
      target_.clearance = decimal(found + BigFloat(0.1 * trial_.size));
      bodies.clearance_m[static_cast<std::size_t>(target_.kind)] = target_.clearance;
      for (auto* list : {&bodies.platform, &bodies.obstacles}) {
        for (BodyText& body : *list) body.clearance_m.reset();
      }
      set();
      return true;
    }
    const auto pose = approx_->pose(best_s_, worst_);
    if (!pose) return false;
    const auto solids = approx_scene_->at(target_, approx_->machine(worst_), *pose);
    Vec<double> apart = solids[1].normal;
    if (!solids[1].is_half_space) apart = nearest_features(solids[0].points, solids[1].points).apart;
    const double deep =
        to_double(found) + solids[0].radius + solids[1].radius + trial_.size * std::pow(10.0, uniform(random_, -4, -1));
    apart = (deep / std::sqrt(dot(apart, apart))) * apart;
    BodyText& body = bodies.obstacles[target_.second];
    for (std::size_t k = 0; k < 3; ++k) {
      body.at_m[k] = fmt::format("{:.15e}", number<double>(body.at_m[k]) + apart[k]);
    }
    approx_scene_.emplace(bodies);
    exact_scene_.emplace(bodies);
    const auto now = exact_distance(best_s_, worst_, target_);
    if (!now) return false;
    const BigFloat depth = BigFloat(violated_ ? -delta_ : delta_) - *now;
    if (!(depth > BigFloat(0.0))) return false;
    zone.depth_m = decimal(depth);
    set();
    return true;
  }

  /// The cable's other end is δ inside of the cone at (s*, x*), or as far outside.
  bool set_half_angle() {
    const auto pose = exact_->pose(BigFloat(best_s_), worst_);
    if (!pose) return false;
    const Machine<BigFloat> machine = exact_->machine(worst_);
    const Vec<BigFloat> d = pose->p + pose->r * machine.b[target_.first] - machine.a[target_.first];
    const BigFloat change = BigFloat(delta_) / root(dot(d, d));
    const BigFloat t = angle_in_cone(target_, machine, *pose);
    const BigFloat a = violated_ ? t - change : t + change;
    if (!(a > BigFloat(1e-3)) || !(a < BigFloat(1.57))) return false;
    target_.cone->half_angle_rad = decimal(a);
    trial_.problem.bodies->exit_cones.at(target_.second) = *target_.cone;
    return true;
  }

  /// δ more or less than the pair has at (s*, x*), as the clearance of its class or as its own.
  bool set_clearance() {
    auto found = exact_distance(best_s_, worst_, target_);
    if (!found) return false;
    BodiesText& bodies = *trial_.problem.bodies;
    if (known_) {
      violated_ = true;
    } else {
      if (!(*found > BigFloat(0.0))) return false;
      decade_ = static_cast<int>(random_() % static_cast<std::uint64_t>(options_.decades));
      delta_ = trial_.size * std::pow(10.0, uniform(random_, -kDecades + decade_, -kDecades + decade_ + 1));
      violated_ = one_in(random_, 2) || !(BigFloat(delta_) < *found);
      const DecimalText clearance = decimal(*found + BigFloat(violated_ ? delta_ : -delta_));
      if (target_.kind == PairClass::kPlatformObstacles && one_in(random_, 2)) {
        if (!set_zone(*found)) return false;
        ++tally_.bodies.zones;
        found = exact_distance(best_s_, worst_, target_);
        if (!found) return false;
      } else if (target_.cone) {
        if (!set_half_angle()) return false;
        found = exact_distance(best_s_, worst_, target_);
        if (!found) return false;
      } else if (one_in(random_, 2)) {
        bodies.clearance_m[static_cast<std::size_t>(target_.kind)] = clearance;
        for (auto* list : {&bodies.platform, &bodies.obstacles}) {
          for (BodyText& body : *list) body.clearance_m.reset();
        }
      } else {
        std::array<std::string, 2> pair{name_of_first(bodies, target_.kind, target_.first),
                                        name_of_second(bodies, target_.kind, target_.second)};
        if (one_in(random_, 2)) std::swap(pair[0], pair[1]);
        bodies.pair_clearances_m.push_back({pair, clearance});
      }
    }
    validate(bodies);
    pairs_ = scene_pairs(bodies);
    clearances_.clear();
    for (const ScenePair& pair : pairs_) clearances_.push_back(number<double>(pair.clearance));
    const BigFloat own = exactly_asked(best_s_, pairs_[target_index()]);
    if ((*found > own) == violated_) {
      breach("the trial does not violate what it should, or does");
      return false;
    }
    return true;
  }

  // ---- Judging ----

  /// The pair is farther apart than its clearance, in 200 bits.
  void require_apart(double s, const Deviation& x, std::size_t n, const char* where) {
    ++tally_.looked_at;
    const auto found = exact_distance(s, x, pairs_[n]);
    if (!found) return breach(fmt::format("proved, but there is no pose {} (s {:.17g})", where, s));
    const BigFloat least = exactly_asked(s, pairs_[n]);
    if (!(*found > least)) {
      breach(fmt::format("proved, but pair {} of {} is too near by {:.3e} {} (s {:.17g})", n, pairs_.size(),
                         to_double(least - *found), where, s));
    }
  }

  /// The least margin at a point, in floating point; what is close is asked of 200 bits.
  double look_at(double s, const Deviation& x, std::size_t& least_pair) {
    const auto pose = approx_->pose(s, x);
    if (!pose) {
      require_apart(s, x, 0, "at a random point");
      return 0;
    }
    const Machine<double> machine = approx_->machine(x);
    double least = kInfinity;
    for (std::size_t n = 0; n < pairs_.size(); ++n) {
      if (!pairs_[n].cone && rough_distance(approx_scene_->at(pairs_[n], machine, *pose)) - clearances_[n] > least) {
        continue;
      }
      const double margin = approx_scene_->distance(pairs_[n], machine, *pose) - asked(s, pairs_[n]);
      if (!(margin > 1e-9 * trial_.size)) require_apart(s, x, n, "where floating point says little");
      if (margin < least) {
        least = margin;
        least_pair = n;
      }
    }
    return least;
  }

  /// Downhill from a point, in s and deviation.
  void descend(double s, Deviation x, std::size_t n, double width) {
    const auto value = [&](double at) { return distance(at, x, pairs_[n]) - asked(at, pairs_[n]); };
    for (int round = 0; round < 2; ++round) {
      if (has_tolerances()) x = worst_deviation(s, x, pairs_[n]);
      const double found = golden_section(value, std::max(0.0, s - width), std::min(1.0, s + width));
      if (value(found) < value(s)) s = found;
    }
    require_apart(s, x, n, "where a search ended");
  }

  [[nodiscard]] std::size_t target_index() const {
    const auto is_target = [&](const ScenePair& pair) {
      return pair.kind == target_.kind && pair.first == target_.first && pair.second == target_.second;
    };
    return static_cast<std::size_t>(std::ranges::find_if(pairs_, is_target) - pairs_.begin());
  }

  void examine_proof(const SegmentProof& proof) {
    if (violated_) breach("proved, but too near at s*");
    if (!(proof.clearance_m > 0)) breach("proved with a clearance that is not positive");
    constexpr int kPoints = 16;
    double least = kInfinity, least_s = best_s_;
    std::size_t pair = target_index();
    Deviation least_x;
    for (int k = 0; k < kPoints; ++k) {
      const double s = uniform(random_, 0, 1);
      const Deviation x = some_deviation();
      std::size_t here = pair;
      const double margin = look_at(s, x, here);
      if (!(margin < least)) continue;
      least = margin;
      least_s = s;
      least_x = x;
      pair = here;
    }
    descend(least_s, least_x, pair, 1.0 / kPoints);
    descend(best_s_, worst_, target_index(), 1e-3);
    // The margin that is stated holds, too.
    const auto at_s = exact_distance(best_s_, worst_, target_);
    const BigFloat margin = *at_s - exactly_asked(best_s_, pairs_[target_index()]);
    if (margin < BigFloat(proof.clearance_m)) breach("proved with a larger clearance than there is at s*");
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
      if (violated_ && !(s_violated < number_of(part.box.lower())) && !(number_of(part.box.upper()) < s_violated)) {
        breach("surveyed as proved at s*");
      }
      constexpr int kBoxes = 8;
      if (looked_at++ < kBoxes) {
        std::size_t pair = 0;
        look_at(uniform(random_, part.box.lower().approx(), part.box.upper().approx()), some_deviation(), pair);
      }
    }
    if (end != Dyadic{1, 0}) breach("surveyed in part");
    if (verdict == Verdict::kRefuted && all_proved) breach("refuted, but surveyed as proved");
    if (verdict == Verdict::kProved && !all_proved) breach("proved, but not when surveyed");
  }

  void examine_witness(const SegmentWitness& witness) {
    const auto at = [&](const Dyadic& s) { return exact_->commanded(number_of(s), Deviation()); };
    if (witness.singular) {
      const auto lower = at(witness.box.lower()), upper = at(witness.box.upper());
      const Machine<BigFloat> machine = exact_->machine(Deviation());
      if (!lower || !upper || !(determinant(machine, *lower) * determinant(machine, *upper) < BigFloat(0.0))) {
        breach("refuted by a singular pose that is not there");
      }
      return;
    }
    if (witness.deviation && !exact_->is_within(*witness.deviation)) breach("refuted by what is beyond the tolerances");
    std::optional<MachineAt<BigFloat>> found;
    if (witness.deviation) {
      found = exact_->witnessed(number_of(witness.box.mid()), *witness.deviation);
    } else if (const auto pose = at(witness.box.mid())) {
      found = MachineAt<BigFloat>{exact_->machine(Deviation()), *pose};
    }
    if (!found) return breach("refuted where there is no pose");
    if (witness.contact) return examine_contact(*witness.contact, *found);
    const LimitsOf<BigFloat> limits(trial_.problem);
    if (limits.margin(quantity(*found, witness.margin), witness.margin) > BigFloat(0.0)) {
      breach("refuted by a false witness");
    }
  }

  /// The two points are points of the bodies, and not farther apart than they may be; or the bodies overlap, by all
  /// faces of their difference.
  void examine_contact(const PairContact& contact, const MachineAt<BigFloat>& at) {
    if (contact.pair >= pairs_.size()) return breach("refuted by a pair that is not there");
    if (pairs_[contact.pair].cone) {
      if (!contact.points.first.empty() || !contact.points.second.empty()) breach("refuted by points of an exit cone");
      if (exact_scene_->distance(pairs_[contact.pair], at.machine, at.pose) > BigFloat(0.0)) {
        breach("refuted by a cable that is inside of its exit cone");
      }
      return;
    }
    const auto solids = exact_scene_->at(pairs_[contact.pair], at.machine, at.pose);
    const auto point = [&](const Solid<BigFloat>& solid, const std::vector<std::int64_t>& shares) {
      std::int64_t sum = 0;
      Vec<BigFloat> result{BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
      if (shares.size() != solid.points.size()) breach("refuted by shares of other points");
      for (std::size_t k = 0; k < std::min(shares.size(), solid.points.size()); ++k) {
        if (shares[k] < 0) breach("refuted by a negative share");
        sum += shares[k];
        const BigFloat share =
            BigFloat(static_cast<double>(shares[k])) / BigFloat(static_cast<double>(PointPair::kWhole));
        result = result + share * solid.points[k];
      }
      if (sum != PointPair::kWhole) breach("refuted by shares that are not 1 in sum");
      return result;
    };
    if (contact.around) {
      for (const PointPair& of : *contact.around) {
        static_cast<void>(point(solids[0], of.first));
        static_cast<void>(point(solids[1], of.second));
      }
      if (solids[1].is_half_space || signed_distance_of(solids) > required(pairs_[contact.pair], at.pose.p)) {
        breach("refuted by points around no common point");
      }
      return;
    }
    const Vec<BigFloat> x = point(solids[0], contact.points.first);
    BigFloat apart;
    if (solids[1].is_half_space) {
      Solid<BigFloat> alone;
      alone.points = {x};
      alone.radius = solids[0].radius;
      apart = height_over(alone, solids[1]);
    } else {
      const Vec<BigFloat> v = x - point(solids[1], contact.points.second);
      apart = root(dot(v, v)) - solids[0].radius - solids[1].radius;
    }
    if (apart > required(pairs_[contact.pair], at.pose.p)) breach("refuted by points that are clear");
  }

  /// The checker's kernel should confirm what is proved, and must not prove a box in which bodies touch, whatever the
  /// directions that it is given.
  void examine_kernel(const Segment& segment, const SegmentProof& proof, bool also_violated) {
    if (trial_.problem.robot.tension_N[0].lower.front() == '-' || trial_.has_bad_reference) return;
    if (proof.verdict != Verdict::kProved && !(violated_ && also_violated)) return;
    Problem problem = trial_.problem;
    problem.query.clear();
    std::optional<Elaborator> made;
    try {
      made.emplace(problem, segment.law);
    } catch (const checker::Malformed&) {
      return;
    }
    if (proof.verdict == Verdict::kProved) {
      ++tally_.kernel_proofs;
      if (made->boxes(segment, proof.boxes, proof.directions)) {
        ++tally_.kernel_confirmed;
      } else if (options_.list_undecided) {
        report("not confirmed by the kernel", fmt::format("{} boxes", proof.boxes.size()));
      }
    }
    if (!violated_ || !also_violated) return;
    const int depth = static_cast<int>(random_() % 50);
    const auto all = static_cast<std::uint64_t>(1) << static_cast<unsigned>(depth);
    const auto at = static_cast<std::uint64_t>(best_s_ * static_cast<double>(all));
    const std::array box{DyadicBox{std::min(at, all - 1), depth}};
    const std::array directions{std::make_shared<const PairDirections>(best_directions())};
    ++tally_.kernel_asked;
    if (made->boxes(segment, box, directions)) {
      breach(fmt::format("the kernel proves a box of depth {} in which bodies are too near", depth));
    }
  }

  /// Of each pair, along its nearest points at s*.
  [[nodiscard]] PairDirections best_directions() const {
    PairDirections result;
    const auto pose = approx_->pose(best_s_, worst_);
    for (const ScenePair& pair : pairs_) {
      Direction direction;
      if (pair.cone) {
        result.single.push_back(direction);
        continue;
      }
      const auto solids = approx_scene_->at(pair, approx_->machine(worst_), *pose);
      if (!solids[1].is_half_space) {
        const NearestFeatures<double> nearest = nearest_features(solids[0].points, solids[1].points);
        const Vec<double> u = nearest.overlap ? depth_of(solids[0].points, solids[1].points).out : nearest.apart;
        const double largest = std::max({std::abs(u[0]), std::abs(u[1]), std::abs(u[2])});
        direction.u = {1, 0, 0};
        for (std::size_t k = 0; k < 3 && largest > 0; ++k) {
          direction.u[k] = static_cast<int>(std::lround(u[k] / largest * Direction::kLargest));
        }
      }
      result.single.push_back(direction);
    }
    return result;
  }

  std::uint64_t seed_;
  const Options& options_;
  Random random_;
  Tally& tally_;
  Trial trial_;
  std::optional<Motion<double>> approx_;
  std::optional<Motion<BigFloat>> exact_;
  std::optional<Scene<double>> approx_scene_;
  std::optional<Scene<BigFloat>> exact_scene_;
  std::optional<SharedAnchors> anchors_;
  std::vector<bool> matters_;
  std::optional<KnownContact> known_;
  ScenePair target_{};
  std::vector<ScenePair> pairs_;
  std::vector<double> clearances_;
  double best_s_ = 0;
  Deviation worst_;
  bool violated_ = false;
  int decade_ = 0;
  double delta_ = 0;
};

}  // namespace

void judge_bodies(std::uint64_t seed, const Options& options, Tally& tally) { BodyJudge(seed, options, tally).run(); }

}  // namespace taut::campaign
