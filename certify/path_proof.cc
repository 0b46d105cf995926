// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/path_proof.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>

#include "base/input_error.h"
#include "certify/clear_run.h"
#include "certify/gravest.h"
#include "certify/undecided.h"
#include "kinematics/time_law.h"
#include "problem/decimal.h"

namespace taut {
namespace {

constexpr int kMarginDigits = 6;
constexpr int kWitnessDigits = 17;       // or as many as it takes to show the violation,
constexpr int kMostWitnessDigits = 600;  // if not more than this

DecimalText decimal_below(double x) { return BigFloat(x).to_decimal(kMarginDigits, MPFR_RNDD); }

const DecimalText& limit_text(const Problem& problem, MarginId margin) {
  const auto cable = static_cast<std::size_t>(margin.cable);
  switch (margin.kind) {
    case MarginKind::kTensionMin: return problem.robot.tension_N[cable].lower;
    case MarginKind::kTensionMax: return problem.robot.tension_N[cable].upper;
    case MarginKind::kLengthMin: return problem.robot.length_m[cable].lower;
    case MarginKind::kLengthMax: break;
  }
  return problem.robot.length_m[cable].upper;
}

PathWitness make_witness(const Prover& prover, const Segment& segment, const SegmentWitness& found,
                         const PathPoint& at) {
  PathWitness witness;
  witness.at = at;
  if (found.contact) {
    witness.contact = found.contact;
    witness.depth_m = "0";  // certificates state more where the kernel shows more
    return witness;
  }
  witness.slowing = found.slowing;
  witness.deviation = found.deviation;
  const MpInterval value = prover.witnessed_quantity(segment, found);
  if (found.rate) {
    witness.rate = found.rate;
    witness.limit = limit_of(prover.problem().time.value(), *found.rate);
    witness.value_lower = value.lower().to_decimal(kWitnessDigits, MPFR_RNDD);  // certificates state the kernel's
    witness.value_upper = value.upper().to_decimal(kWitnessDigits, MPFR_RNDU);
    return witness;
  }
  const MarginId margin = found.margin;
  witness.margin = margin;
  witness.limit = limit_text(prover.problem(), margin);
  const Decimal limit = Decimal::parse(witness.limit);
  const bool is_lower = margin.kind == MarginKind::kTensionMin || margin.kind == MarginKind::kLengthMin;
  for (int digits = kWitnessDigits; digits <= kMostWitnessDigits; digits *= 2) {
    witness.value_lower = value.lower().to_decimal(digits, MPFR_RNDD);
    witness.value_upper = value.upper().to_decimal(digits, MPFR_RNDU);
    if (is_lower ? Decimal::parse(witness.value_upper) <= limit : Decimal::parse(witness.value_lower) >= limit) break;
  }
  return witness;
}

/// Whether `margin` is proved not to be positive where a segment stays.
bool is_violated(const Prover& prover, const Segment& still, MarginId margin) {
  const PrecisionLadder& ladder = prover.ladder();
  for (std::size_t rung = 1; rung <= ladder.last(); ++rung) {
    const PrecisionScope precision(ladder.bits(rung));
    Faults<MpInterval>::clear();
    const BoxEnclosure<MpInterval> enclosure = enclose_box(ladder.multiprecision(rung), still, DyadicBox());
    const auto is_it = [&](const auto& of) { return of.id == margin && certainly_nonpositive(of.value.at_mid); };
    if (std::ranges::any_of(enclosure.margins, is_it) && !Faults<MpInterval>::raised()) return true;
  }
  return false;
}

/// The limit that a refuted pose breaks by the largest share of the width between limits, as floating point sees it;
/// `found`, which is proved, where that one is not.
MarginId gravest_margin(const Prover& prover, const Segment& still, MarginId found) {
  const DyadicBox whole;
  const auto worst = worst_margin(prover.sampler(), still, whole.mid());
  const bool is_other = worst && worst->severity > 0 && worst->margin != found;
  return is_other && is_violated(prover, still, worst->margin) ? worst->margin : found;
}

/// Of waypoint `index`: refute_waypoint() on a segment that stays there.
std::optional<PathWitness> refute_pose(const Prover& prover, const Segment& still, int index, Reason& undecided,
                                       const std::stop_token& stop) {
  const DyadicBox whole;
  const SegmentProof proof = prover.prove(still, 0, stop);
  if (proof.verdict == Verdict::kProved) return std::nullopt;
  if (!prover.is_admissible(still)) {
    undecided = Reason::at_pose(Undecided::kWaypointRange, prover.range_violation(still));
    return std::nullopt;
  }
  const BoxVerdict verdict = prover.judge(still, whole);
  if (verdict.kind == BoxVerdict::Kind::kRefuted) {
    return make_witness(prover, still, {false, gravest_margin(prover, still, verdict.worst), whole},
                        PathPoint{false, index, {}});
  }
  if (proof.witness && (proof.witness->deviation || proof.witness->contact)) {
    return make_witness(prover, still, *proof.witness, PathPoint{false, index, {}});
  }
  if (verdict.kind == BoxVerdict::Kind::kProved) {  // and the bodies are not
    undecided = proof.reason;
    return std::nullopt;
  }
  const Undecided reason = verdict.kind == BoxVerdict::Kind::kNearSingular ? Undecided::kSingular
                           : verdict.kind == BoxVerdict::Kind::kNoMotion   ? Undecided::kNoMotion
                           : verdict.kind == BoxVerdict::Kind::kOutOfRange ? Undecided::kParameterRange
                           : verdict.kind == BoxVerdict::Kind::kTolerance  ? Undecided::kTolerances
                           : verdict.kind == BoxVerdict::Kind::kFault      ? Undecided::kUndefined
                                                                           : Undecided::kPrecision;
  undecided =
      reason == Undecided::kTolerances
          ? Reason(reason, fmt::format(" margin {} of cable {}", name(verdict.worst.kind), verdict.worst.cable + 1))
          : Reason::at_pose(reason);
  return std::nullopt;
}

}  // namespace

Margins margins_below(double tension_N, double length_m, double wrench_scale, std::optional<double> clearance_m) {
  Margins margins{decimal_below(tension_N), decimal_below(length_m), decimal_below(wrench_scale)};
  if (clearance_m) margins.clearance_m = decimal_below(*clearance_m);
  return margins;
}

PathProof prove_path(const Prover& prover, const Path& path, const KnownProof& known, const std::stop_token& stop,
                     ProofAim aim) {
  if (path.timing) {
    if (const std::string text = complaint(path); !text.empty()) throw InputError("time law: " + text);
  }
  PathProof result;
  if (path.segments() == 0) {
    if (path.waypoints.size() == 1) result.witness = refute_pose(prover, path.segment(0), 0, result.reason, stop);
    if (result.witness) result.verdict = Verdict::kRefuted;
    if (result.reason.empty()) result.reason = Undecided::kNoSegment;
    return result;
  }
  result.segments.resize(path.segments());
  const std::size_t length = path.timing ? 1 : ClearRun::length(prover, path.segments());
  std::deque<ClearRun> runs;
  for (std::size_t begin = 0; length > 1 && begin < path.segments(); begin += length) {
    const auto segment = [&path, begin](std::size_t k) { return path.segment(begin + k); };
    runs.emplace_back(prover, segment, std::min(length, path.segments() - begin));
  }
  const auto prove = [&](std::size_t k) {
    const Segment segment = path.segment(k);
    // Known proofs are of the path alone.
    const SegmentProof* earlier = known && !path.timing ? known(segment) : nullptr;
    const auto clear = [&] { return runs.empty() ? nullptr : runs[k / length].at(k % length); };
    result.segments[k] = earlier != nullptr ? *earlier : prover.prove(segment, 0, stop, aim, clear());
  };
  // Making threads takes longer than most short paths.
  constexpr std::chrono::milliseconds kAlone{1};
  const auto start = std::chrono::steady_clock::now();
  std::size_t next = 0;
  while (next < result.segments.size() && std::chrono::steady_clock::now() - start < kAlone) prove(next++);
  tbb::parallel_for(next, result.segments.size(), prove);
  result.verdict = Verdict::kProved;
  for (std::size_t k = 0; k < result.segments.size(); ++k) {
    const SegmentProof& segment = result.segments[k];
    result.boxes += static_cast<long>(segment.boxes.size());
    result.boxes_judged += segment.boxes_judged;
    if (segment.verdict == Verdict::kRefuted && result.verdict != Verdict::kRefuted) {
      result.verdict = Verdict::kRefuted;
      result.witness = path_witness(prover, path.segment(k), static_cast<int>(k), *segment.witness);
    } else if (segment.verdict == Verdict::kUndecided && result.verdict == Verdict::kProved) {
      result.verdict = Verdict::kUndecided;
      result.reason = segment.reason;
      result.open_segment = static_cast<int>(k);
    }
  }
  return result;
}

PathWitness path_witness(const Prover& prover, const Segment& segment, int index, const SegmentWitness& witness) {
  if (!witness.singular) {
    return make_witness(prover, segment, witness, PathPoint{true, index, witness.box.mid()});
  }
  PathWitness result;
  result.singular = true;
  result.at = {true, index, witness.box.lower()};
  result.to = {true, index, witness.box.upper()};
  return result;
}

std::optional<PathWitness> refute_waypoint(const Prover& prover, const Waypoint& waypoint, int index, Reason& undecided,
                                           const std::stop_token& stop) {
  return refute_pose(prover, prover.segment(waypoint, waypoint), index, undecided, stop);
}

namespace {

/// The binary64 nearest to every number of an interval, −0 as 0; not-a-number where there is none, or it is not finite.
double common_binary64(const MpInterval& value) {
  const double low = value.lower().to_double(MPFR_RNDN);
  const double high = value.upper().to_double(MPFR_RNDN);
  return low == high && std::isfinite(low) ? low + 0.0 : std::numeric_limits<double>::quiet_NaN();
}

/// nearest_binary64() of several expressions. What they have in common is evaluated once; sines and cosines are often.
std::vector<double> nearest_binary64s(const std::vector<ExpressionText>& expressions) {
  constexpr mpfr_prec_t kBits = 128;  // enough, but for expressions that are all but a tie
  std::size_t length = 0;             // at least the number of operations
  for (const ExpressionText& expression : expressions) length += expression.size();
  const PrecisionScope precision(kBits);
  Faults<MpInterval>::clear();
  std::vector<MpInterval> values(expressions.size(), MpInterval(0.0));
  const bool are_few = length <= ExpressionTape::kMaxInstructions;
  if (are_few) Evaluator<MpInterval>(ExpressionTape(expressions, {}, {})).evaluate({}, values);
  const bool are_known = are_few && !Faults<MpInterval>::raised();
  std::vector<double> nearest;
  for (std::size_t i = 0; i < expressions.size(); ++i) {
    const double value = are_known ? common_binary64(values[i]) : std::numeric_limits<double>::quiet_NaN();
    nearest.push_back(std::isfinite(value) ? value : nearest_binary64(expressions[i]));
  }
  return nearest;
}

}  // namespace

double nearest_binary64(const ExpressionText& expression) {
  if (is_plain_decimal(expression)) return ScalarTraits<double>::from_decimal(expression) + 0.0;  // −0 to 0
  constexpr mpfr_prec_t kMostBits = 4096;
  for (mpfr_prec_t bits = 128; bits <= kMostBits; bits *= 2) {
    const PrecisionScope precision(bits);
    Faults<MpInterval>::clear();
    const auto value = evaluate_constant<MpInterval>(expression);
    if (Faults<MpInterval>::raised()) break;
    const double nearest = common_binary64(value);
    if (std::isfinite(nearest)) return nearest;
  }
  throw InputError(fmt::format("query: got '{}', expected a finite number", expression));
}

std::vector<Waypoint> query_waypoints(const Problem& problem) {
  std::vector<Waypoint> waypoints;
  std::optional<ConstraintFunctions> constraints;
  if (!problem.space.constraints.empty()) constraints.emplace(problem);
  for (const auto& typed : problem.query) {
    Waypoint& waypoint = waypoints.emplace_back(nearest_binary64s(typed), std::vector<int>(typed.size(), 0));
    if (constraints) waypoint.parameters().normals = constraints->normals(waypoint);
  }
  return waypoints;
}

}  // namespace taut
