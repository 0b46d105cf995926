// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/prover.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "certify/reference_path.h"
#include "certify/segment_walk.h"
#include "certify/severity.h"

namespace taut {

Prover::Prover(const Problem& problem, ProofOptions options) : Prover(problem, options, std::nullopt) {}

Prover::Prover(const Problem& problem, ProofOptions options, const std::optional<Slowing>& slowing)
    : problem_(problem),
      options_(options),
      is_slowed_(slowing.has_value()),
      ladder_(problem, options.max_bits, slowing) {
  if (!problem.space.constraints.empty()) constraints_.emplace(problem);
  if (problem.bodies) bodies_.emplace(problem);
}

const PoseSampler& Prover::sampler() const {
  std::call_once(sampler_made_, [&] { sampler_.emplace(problem_); });
  return *sampler_;
}

Segment Prover::segment(const Waypoint& a, const Waypoint& b) const { return prepared(Segment::straight(a, b)); }

Segment Prover::prepared(Segment segment) const {
  if (constraints_ && !has_poses(segment.law)) segment.tube = suitable_tube(segment);
  if (segment.law == Interpolation::kCableLengths && is_admissible(segment)) {
    propose_reference(model(), sampler().model(), segment);
  }
  return segment;
}

bool Prover::is_length_controlled(Interpolation law) const {
  return law == Interpolation::kCableLengths || (problem_.tolerances && problem_.tolerances->cable_length_m);
}

double Prover::suitable_tube(const Segment& segment) const {
  constexpr int kSamples = 8;  // intervals of s
  // Times the largest |y| seen. Between ends on the constraints y is about a parabola, for which (b) of motion.h needs
  // 1 + 2/(1 − ρ); a narrower tube would cost boxes.
  constexpr double kFactor = 4.0;
  constexpr double kLeast = 0x1p-30;
  double largest = 0;
  for (int k = 0; k <= kSamples; ++k) {
    const std::optional<double> deviation = constraints_->deviation(segment, static_cast<double>(k) / kSamples);
    if (!deviation) return kLeast;
    largest = std::max(largest, *deviation);
  }
  return std::max(kFactor * largest, kLeast);
}

namespace {

bool contains(const PoseTube& a, const PoseTube& b) { return b.position <= a.position && b.turn <= a.turn; }

/// In order, and of two successive tubes one contains the other: else the pieces' motions may be of different
/// assemblies.
bool has_joined_pieces(const Segment& segment) {
  double last = 0;
  PoseTube tube = segment.pose_tube;
  for (const InnerPose& inner : segment.inner_poses) {
    const bool is_number = std::ranges::all_of(inner.x, [](double x) { return std::isfinite(x); });
    if (!(last < inner.s && inner.s < 1) || !is_number) return false;
    if (!contains(tube, inner.tube) && !contains(inner.tube, tube)) return false;
    last = inner.s;
    tube = inner.tube;
  }
  return true;
}

}  // namespace

namespace {

/// Whether the waypoint has what the law reads.
bool is_of_law(Interpolation law, const Waypoint& waypoint) {
  const auto& point = waypoint.point();
  if (law == Interpolation::kCableLengths) return std::holds_alternative<LengthsPoint>(point);
  return std::holds_alternative<ParameterPoint>(point) != has_poses(law);
}

/// "px is 1.7, its range is from -1.5 to 1.1 (SI: m, rad)": how a value lies to its range.
std::string range_text(const Parameter& parameter, double x, const std::array<double, 2>& range) {
  constexpr double kRounding = 1e-14;  // relative: some tens of units in the last place
  const double end = x < range[0] ? range[0] : range[1];
  const bool is_at_end = std::abs(x - end) <= kRounding * std::max(1.0, std::abs(end));
  return fmt::format("{} is {}{}, its range is from {} to {} (SI: m, rad)", parameter.name, x,
                     is_at_end ? " and so, but for rounding, at an end of its range" : "", parameter.range_lower,
                     parameter.range_upper);
}

}  // namespace

bool Prover::is_admissible(const Segment& segment) const {
  const auto is_finite = [](double x) { return std::isfinite(x); };
  const auto fits = [&](const Waypoint* waypoint) {
    if (!is_of_law(segment.law, *waypoint)) return false;
    if (!has_poses(segment.law)) return certainly_in_ranges(*waypoint);
    return std::ranges::all_of(numbers(*waypoint), is_finite);
  };
  return std::ranges::all_of(segment.controls(), fits) && has_joined_pieces(segment);
}

bool Prover::certainly_in_ranges(const Waypoint& waypoint) const {
  const auto& ranges = model().motion.ranges;
  const auto& [x, half_turns, normals] = waypoint.parameters();
  if (x.size() != ranges.size() || half_turns.size() != ranges.size()) return false;
  for (std::size_t j = 0; j < ranges.size(); ++j) {
    if (!std::isfinite(x[j]) || !(ranges[j][0] <= x[j] && x[j] <= ranges[j][1])) return false;
    if (half_turns[j] != 0 && problem_.space.parameters[j].kind != ParameterKind::kPeriodic) return false;
  }
  return true;
}

std::string Prover::range_violation(const Segment& segment) const {
  if (has_poses(segment.law)) return "";
  const auto& ranges = model().motion.ranges;
  for (const Waypoint* waypoint : segment.controls()) {
    if (!is_of_law(segment.law, *waypoint)) continue;
    for (std::size_t j = 0; j < std::min(ranges.size(), waypoint->parameters().x.size()); ++j) {
      const double x = waypoint->parameters().x[j];
      if (ranges[j][0] <= x && x <= ranges[j][1]) continue;
      const Parameter& parameter = problem_.space.parameters[j];
      if (parameter.kind != ParameterKind::kRange) continue;
      return fmt::format(": {}", range_text(parameter, x, ranges[j]));
    }
  }
  return "";
}

BoxVerdict Prover::judge(const Segment& segment, const DyadicBox& box) const {
  BoxVerdict verdict;
  for (const int continuation_steps : {1, kMostContinuationSteps}) {
    for (std::size_t rung = 0; rung <= ladder_.last(); ++rung) {
      verdict = ladder_.judge(rung, segment, box, 0, continuation_steps);
      if (verdict.kind == BoxVerdict::Kind::kProved || verdict.kind == BoxVerdict::Kind::kRefuted) return verdict;
    }
    if (!problem_.tolerances) break;
  }
  return verdict;
}

namespace {

/// The survey of a segment that is not admissible; `range_violation` as Prover's.
SegmentSurvey open_survey(Interpolation law, const std::string& range_violation) {
  SegmentSurvey survey;
  survey.tension_N = survey.length_m = survey.wrench_scale = survey.clearance_m =
      std::numeric_limits<double>::infinity();
  const Reason reason =
      has_poses(law) ? Reason(Undecided::kNoMotion) : Reason(Undecided::kWaypointRange, range_violation);
  survey.boxes.push_back({{}, SurveyedBox::Kind::kOpen, {}, reason});
  return survey;
}

/// What a walk to the first failure says; undecided unless all boxes are proved, or one has a witness.
SegmentProof to_proof(SegmentSurvey survey) {
  SegmentProof proof;
  proof.tension_N = survey.tension_N;
  proof.length_m = survey.length_m;
  proof.wrench_scale = survey.wrench_scale;
  proof.clearance_m = survey.clearance_m;
  proof.boxes_judged = survey.boxes_judged;
  proof.boxes_multiprecision = survey.boxes_multiprecision;
  proof.verdict = Verdict::kProved;
  for (SurveyedBox& box : survey.boxes) {
    if (box.kind == SurveyedBox::Kind::kProved) {
      proof.boxes.push_back(std::move(box.box));
      if (box.directions) proof.directions.push_back(std::move(box.directions));
    } else if (box.witness) {
      proof.verdict = Verdict::kRefuted;
      proof.witness = std::move(box.witness);
    } else {
      proof.verdict = Verdict::kUndecided;
      proof.open_box = std::move(box.box);
      proof.reason = std::move(box.reason);
    }
  }
  return proof;
}

}  // namespace

namespace {

/// The problem of a move that is run as its law says.
Problem by_law(Problem problem) {
  problem.time->stopping_time_s.reset();
  return problem;
}

}  // namespace

bool Prover::may_stop(const Segment& segment) const {
  return segment.timing != nullptr && problem_.time && problem_.time->stopping_time_s && !is_slowed_;
}

const Prover& Prover::run(const std::optional<Slowing>& slowing) const {
  const auto all = extreme_slowings();
  const auto n = slowing ? 1 + static_cast<std::size_t>(std::ranges::find(all, *slowing) - all.begin()) : 0;
  Run& run = runs_.at(n);
  std::call_once(run.made, [&] {
    run.prover.reset(slowing ? new Prover(problem_, options_, slowing) : new Prover(by_law(problem_), options_));
  });
  return *run.prover;
}

/// What refutes the law, or a move that is slowed down in one way, refutes the one that may be.
std::optional<SegmentProof> Prover::refute_by_slowing(const Segment& segment, double clearance,
                                                      const std::stop_token& stop) const {
  SegmentProof at_full_speed = run({}).prove(segment, clearance, stop);
  if (at_full_speed.verdict == Verdict::kRefuted) return at_full_speed;
  for (const Slowing& slowing : extreme_slowings()) {
    SegmentProof slowed = run(slowing).prove(segment, clearance, stop);
    if (slowed.verdict != Verdict::kRefuted) continue;
    SegmentWitness& witness = *slowed.witness;
    const bool is_of_pose = !witness.rate && (witness.singular || witness.contact || is_length(witness.margin));
    if (!is_of_pose) witness.slowing = slowing;
    return slowed;
  }
  return std::nullopt;
}

std::unique_ptr<const ClearPoses> Prover::clear_poses(std::span<const RigidPose> poses, const ClearPoses* wider,
                                                      ClearPoses::Use use) const {
  if (!bodies_ || problem_.tolerances) return nullptr;
  return ClearPoses::around({*model().bodies, model().model, *bodies_, sampler().model()}, poses, wider, use);
}

SegmentProof Prover::prove(const Segment& segment, double clearance, const std::stop_token& stop, ProofAim aim,
                           const ClearPoses* clear) const {
  if (!is_admissible(segment)) return to_proof(open_survey(segment.law, range_violation(segment)));
  SegmentWalk walk(*this, segment, clearance, SegmentWalk::Extent::kToFirstFailure, stop, aim, clear);
  SegmentProof proof = to_proof(walk.run());
  if (proof.verdict != Verdict::kUndecided || aim == ProofAim::kProve) return proof;
  if (may_stop(segment)) return refute_by_slowing(segment, clearance, stop).value_or(std::move(proof));
  proof.witness = walk.refute_elsewhere();
  if (proof.witness) {
    proof.verdict = Verdict::kRefuted;
    proof.open_box = {};
    proof.reason = {};
  }
  return proof;
}

SegmentSurvey Prover::survey(const Segment& segment, const std::stop_token& stop) const {
  if (!is_admissible(segment)) return open_survey(segment.law, range_violation(segment));
  return SegmentWalk(*this, segment, 0, SegmentWalk::Extent::kWhole, stop).run();
}

MpInterval Prover::witnessed_quantity(const Segment& segment, const SegmentWitness& witness) const {
  if (may_stop(segment)) return run(witness.slowing).witnessed_quantity(segment, witness);
  if (!witness.deviation) {
    return witness.rate ? rate_at_mid(segment, witness.box, *witness.rate)
                        : margin_at_mid(segment, witness.box, witness.margin);
  }
  std::optional<MpInterval> quantity =
      witness.rate ? deviated_power_at_mid(*this, segment, witness.box, witness.rate->cable, *witness.deviation)
                   : deviated_at_mid(*this, segment, witness.box, witness.margin, *witness.deviation);
  if (!quantity) throw std::logic_error("a deviation has no enclosure");
  return *std::move(quantity);
}

MpInterval Prover::margin_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin) const {
  const auto n = static_cast<std::size_t>(margin.cable);
  std::optional<MpInterval> quantity;
  for (std::size_t rung = 1; rung <= ladder_.last(); ++rung) {
    const PrecisionScope precision(ladder_.bits(rung));
    const ProofModel<MpInterval>& model = ladder_.multiprecision(rung);
    Faults<MpInterval>::clear();
    const BoxEnclosure<MpInterval> enclosure = enclose_box(model, segment, box);
    const bool is_known = std::ranges::any_of(enclosure.margins, [&](const auto& x) { return x.id == margin; });
    if (Faults<MpInterval>::raised() || !is_known) continue;
    switch (margin.kind) {
      case MarginKind::kTensionMin: quantity = enclosure.low[n].at_mid; break;
      case MarginKind::kTensionMax: quantity = enclosure.high[n].at_mid; break;
      case MarginKind::kLengthMin:
      case MarginKind::kLengthMax: quantity = enclosure.length[n].at_mid; break;
    }
    if (certainly_nonpositive(slack(model.model, *quantity, margin))) break;
  }
  if (!quantity) throw std::logic_error("a refuted midpoint has no enclosure");
  return *quantity;
}

MpInterval Prover::rate_at_mid(const Segment& segment, const DyadicBox& box, RateId rate) const {
  std::optional<MpInterval> quantity;
  for (std::size_t rung = 1; rung <= ladder_.last(); ++rung) {
    const PrecisionScope precision(ladder_.bits(rung));
    Faults<MpInterval>::clear();
    const BoxEnclosure<MpInterval> enclosure = enclose_box(ladder_.multiprecision(rung), segment, box);
    if (Faults<MpInterval>::raised() || !enclosure.rates) continue;
    const auto& margins = enclosure.rates->at_mid;
    const auto it = std::ranges::find(margins, rate, &RateMargin<MpInterval>::id);
    if (it == margins.end()) continue;
    quantity = it->size;
    if (certainly_nonpositive(it->value)) break;
  }
  if (!quantity) throw std::logic_error("a refuted rate has no enclosure");
  return *quantity;
}

}  // namespace taut
