// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/segment_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/input_error.h"
#include "certify/reference_path.h"

namespace taut {

namespace {

/// Rung at which deviations are examined, of so many: their ways cost digits with each step.
std::size_t deviation_rung(std::size_t rungs) { return std::min<std::size_t>(1, rungs - 1); }

constexpr mpfr_prec_t kFirstRung = 128;

/// Where tolerances are too large for one part of a deviation's way, it is taken in so many more (kMostParts at most).
constexpr int kMoreParts = 4;

std::vector<mpfr_prec_t> ladder(mpfr_prec_t max_bits) {
  std::vector<mpfr_prec_t> bits = {kFirstRung};
  while (bits.back() < max_bits) bits.push_back(std::min(2 * bits.back(), max_bits));
  return bits;
}

}  // namespace

Prover::Prover(const Problem& problem, ProofOptions options)
    : problem_(problem),
      options_(options),
      fast_(make_proof_model(problem)),
      bits_(ladder(options.max_bits)),
      fine_(bits_.size()) {
  if (!problem.space.constraints.empty()) constraints_.emplace(problem);
}

Segment Prover::segment(const Waypoint& a, const Waypoint& b) const { return prepared(Segment::straight(a, b)); }

Segment Prover::prepared(Segment segment) const {
  if (constraints_ && !has_poses(segment.law)) segment.tube = suitable_tube(segment);
  if (segment.law == Interpolation::kCableLengths && is_admissible(segment)) {
    std::call_once(sampler_made_, [&] { sampler_.emplace(problem_); });
    propose_reference(fast_, sampler_->model(), segment);
  }
  return segment;
}

bool Prover::is_held_by_lengths(Interpolation law) const {
  return law == Interpolation::kCableLengths || (problem_.tolerances && problem_.tolerances->cable_length_m);
}

double Prover::suitable_tube(const Segment& segment) const {
  constexpr int kSamples = 8;  // intervals of s
  constexpr double kRoom =
      4.0;  // times the largest |y| seen: between ends on the constraints y is about a parabola, for which
            // (b) of motion.h needs 1 + 2/(1 − ρ), and little room would cost boxes
  constexpr double kLeast = 0x1p-30;
  double largest = 0;
  for (int k = 0; k <= kSamples; ++k) {
    const std::optional<double> deviation = constraints_->deviation(segment, static_cast<double>(k) / kSamples);
    if (!deviation) return kLeast;
    largest = std::max(largest, *deviation);
  }
  return std::max(kRoom * largest, kLeast);
}

const ProofModel<MpInterval>& Prover::fine(std::size_t k) const {
  Rung& rung = fine_[k];
  std::call_once(rung.made, [&] {
    const PrecisionScope precision(bits_[k]);
    rung.model.emplace(make_mp_proof_model(problem_));
  });
  return *rung.model;
}

namespace {

bool contains(const PoseTube& a, const PoseTube& b) { return b.position <= a.position && b.turn <= a.turn; }

/// In order, and of two successive tubes one contains the other: else the pieces' motions may be of different assemblies.
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

bool Prover::is_admissible(const Segment& segment) const {
  const auto is_finite = [](double x) { return std::isfinite(x); };
  return std::ranges::all_of(segment.controls(),
                             [&](const Waypoint* waypoint) {
                               if (!has_poses(segment.law)) return certainly_in_ranges(*waypoint);
                               return waypoint->x.size() == pose_numbers(segment.law) &&
                                      std::ranges::all_of(waypoint->x, is_finite);
                             }) &&
         has_joined_pieces(segment);
}

bool Prover::certainly_in_ranges(const Waypoint& waypoint) const {
  if (waypoint.x.size() != fast_.motion.ranges.size() || waypoint.half_turns.size() != fast_.motion.ranges.size())
    return false;
  for (std::size_t j = 0; j < fast_.motion.ranges.size(); ++j) {
    if (!std::isfinite(waypoint.x[j]) ||
        !(fast_.motion.ranges[j][0] <= waypoint.x[j] && waypoint.x[j] <= fast_.motion.ranges[j][1]))
      return false;
    if (waypoint.half_turns[j] != 0 && problem_.space.parameters[j].kind != ParameterKind::kPeriodic) return false;
  }
  return true;
}

namespace {

/// Why is_admissible() said no.
Undecided not_followed(Interpolation law) { return has_poses(law) ? Undecided::kNoMotion : Undecided::kWaypointRange; }

Undecided reason_of(BoxVerdict::Kind kind) {
  switch (kind) {
    case BoxVerdict::Kind::kFault: return Undecided::kUndefined;
    case BoxVerdict::Kind::kNoMotion: return Undecided::kNoMotion;
    default: return Undecided::kSingular;
  }
}

}  // namespace

BoxVerdict Prover::judge_at(std::size_t rung, const Segment& segment, const DyadicBox& box, double clearance,
                            int parts) const {
  if (rung == 0) return judge_box(fast_, segment, box, clearance, parts);
  const PrecisionScope precision(bits_[rung - 1]);
  return judge_box(fine(rung - 1), segment, box, clearance, parts);
}

BoxVerdict Prover::judge(const Segment& segment, const DyadicBox& box) const {
  BoxVerdict verdict;
  for (const int parts : {1, kMostParts}) {
    for (std::size_t rung = 0; rung <= fine_.size(); ++rung) {
      verdict = judge_at(rung, segment, box, 0, parts);
      if (verdict.kind == BoxVerdict::Kind::kProved || verdict.kind == BoxVerdict::Kind::kRefuted) return verdict;
    }
    if (!problem_.tolerances) break;
  }
  return verdict;
}

/// What is left to do on a segment, and what was done.
struct Prover::Walk {
  const Segment& segment;
  double clearance = 0;
  std::vector<Task> stack = {Task{}};
  int judged = 0;
  int multiprecision = 0;
  bool motion_given_up = false;  ///< somewhere on the segment, with all means
  int singular_open = 0;  ///< boxes next to singular poses, or where the pose is undefined, that all means left open
  bool deviation_found = false;    ///< that refutes it
  bool all_margins_tried = false;  ///< by deviations
  bool deviation_failed = false;   ///< none was found that can be followed to where it refutes: not sought again
  Task next() {
    const Task task = std::move(stack.back());
    stack.pop_back();
    return task;
  }
  void refine(Task task) {
    task.parts *= kMoreParts;
    stack.push_back(std::move(task));
  }
  /// The halves, the left one first.
  void split(const Task& task, std::size_t rung) {
    stack.push_back({task.box.right(), rung, task.is_hopeless});
    stack.push_back({task.box.left(), rung, task.is_hopeless});
  }
};

/// What to do with a box.
struct Prover::Step {
  enum class Kind {
    kProved,
    kRefuted,  ///< by `witness`
    kSplit,    ///< as it is
    kClimb,    ///< the same box on the next rung
    kRefine,   ///< the same box again, with deviations in more parts
    kGiveUp,   ///< for this box, for `reason`
    kStop,     ///< for all the rest, for `reason`
  };
  Kind kind;
  BoxVerdict verdict = {};
  std::optional<SegmentWitness> witness = {};
  Reason reason = {};
};

namespace {

/// Depth from which the rounding of s itself is as large as the box.
int deepest(std::size_t rung, const std::vector<mpfr_prec_t>& bits) {
  constexpr int kBinary64Depth = 48;
  return rung == 0 ? kBinary64Depth : static_cast<int>(std::min<mpfr_prec_t>(bits[rung - 1], DyadicBox::kMaxDepth));
}

/// For a reason whose words end with "at".
Reason at(Undecided reason, MarginId margin, std::string_view detail = {}) {
  std::string place = std::string(" margin ") + name(margin.kind) + " of cable " + std::to_string(margin.cable + 1);
  return {reason, place.append(detail)};
}

/// Of an enclosure at the working precision. Void if a fault is raised.
std::optional<SlopeForm<MpInterval>> margin_over(const ProofModel<MpInterval>& model, const Segment& segment,
                                                 const DyadicBox& box, MarginId id) {
  const BoxEnclosure<MpInterval> enclosure = enclose_box(model, segment, box);
  for (const auto& margin : enclosure.margins) {
    if (margin.id == id) return margin.value;
  }
  return std::nullopt;
}

BigFloat middle(const MpInterval& x) { return MpfrRounding<BigFloat>::median(x.lower(), x.upper()); }

}  // namespace

/// What bisection would find out about a margin that is next to 0, sooner: where in the box is it least? A claim is made by
/// judge_at() alone; the search for the point may go wrong, and then the box climbs one rung as it would anyway.
Prover::Step Prover::locate_minimum(Walk& walk, const Task& task, MarginId margin) const {
  constexpr int kMostSteps = 24;  // on one rung; secants gain digits like 1, 1, 2, 3, 5
  const Segment& segment = walk.segment;
  const Step climb{Step::Kind::kClimb};
  std::optional<BigFloat> s;
  std::optional<BigFloat> earlier;
  BigFloat slope_earlier;
  for (std::size_t rung = task.rung + 1; rung <= fine_.size(); ++rung) {
    const PrecisionScope precision(bits_[rung - 1]);
    const int depth = deepest(rung, bits_);
    const BigFloat lower = enclose<MpInterval>(task.box.lower()).lower();
    const BigFloat upper = enclose<MpInterval>(task.box.upper()).upper();
    const BigFloat resolution = BigFloat::apply_rounded(
        MPFR_RNDN, [depth](mpfr_ptr x, mpfr_rnd_t mode) { mpfr_set_ui_2exp(x, 1, -depth, mode); });
    if (!s) s = middle(enclose<MpInterval>(task.box.mid()));
    bool is_positive = false;
    for (int step = 0; step < kMostSteps; ++step) {
      // The box of that depth around s, within the task's.
      DyadicBox point{Dyadic::nearest(*s, depth).k, depth};
      const int finer = depth - task.box.depth;
      if (finer < 1) return climb;
      point.k =
          std::clamp<boost::multiprecision::cpp_int>(point.k, task.box.k << finer, ((task.box.k + 1) << finer) - 1);
      ++walk.judged;
      ++walk.multiprecision;
      const BoxVerdict verdict = judge_at(rung, segment, point, walk.clearance, task.parts);
      if (verdict.kind == BoxVerdict::Kind::kRefuted) {
        return {Step::Kind::kRefuted, verdict, SegmentWitness{false, verdict.worst, point}};
      }
      Faults<MpInterval>::clear();
      const auto value = margin_over(fine(rung - 1), segment, point, margin);
      if (!value || Faults<MpInterval>::raised()) return climb;
      const BigFloat slope = middle(value->slope);
      // Positive beyond what s may be off the least point.
      is_positive = value->at_mid.lower() > abs(slope) * resolution;
      const BigFloat at = *s;
      if (!earlier) {
        const BigFloat quarter = (upper - lower) / BigFloat(4.0);
        s = slope > BigFloat(0.0) ? at - quarter : at + quarter;
      } else {
        const BigFloat bend = slope - slope_earlier;
        const BigFloat moved = at - *earlier;
        if (!(abs(bend) > BigFloat(0.0)) || !(abs(moved) > BigFloat(0.0))) break;
        s = at - slope * moved / bend;
      }
      if (!(*s > lower)) s = lower;
      if (!(*s < upper)) s = upper;
      earlier = at;
      slope_earlier = slope;
      if (!(abs(*s - at) > resolution)) break;
    }
    if (is_positive) return climb;
  }
  return {Step::Kind::kGiveUp,
          {},
          {},
          at(Undecided::kPrecision, margin,
             ": it is zero, or too close to it for " + std::to_string(bits_.back()) + " bits to tell")};
}

bool Prover::is_singular_between_ends(const Segment& segment, const DyadicBox& box) const {
  for (std::size_t k = 0; k < fine_.size(); ++k) {
    const PrecisionScope precision(bits_[k]);
    const int lower = determinant_sign(fine(k), segment, box.lower());
    const int upper = determinant_sign(fine(k), segment, box.upper());
    if (lower != 0 && upper != 0) return lower != upper && is_motion_known(fine(k), segment, box);
  }
  return false;
}

bool Prover::is_proved_inside(Walk& walk, const Task& task) const {
  constexpr int kNarrower = 10;  // halvings
  const DyadicBox narrow{(task.box.k << kNarrower) + (1 << (kNarrower - 1)), task.box.depth + kNarrower};
  ++walk.judged;
  return judge_at(task.rung, walk.segment, narrow, walk.clearance, task.parts).kind == BoxVerdict::Kind::kProved;
}

Prover::Step Prover::examine(Walk& walk, const Task& task) const {
  using Kind = BoxVerdict::Kind;
  constexpr int kHastyMotionDepth = 5;  // where all means failed once, they are not tried again
  constexpr int kMostSingular = 256;    // open boxes: likewise
  constexpr int kHastySingularDepth = 8;
  constexpr std::size_t kSingularRung = 3;  // more bits show nothing about a Jacobian that is nearly singular
  const auto& [box, rung, is_hopeless, parts] = task;
  if (walk.judged >= options_.max_boxes || walk.multiprecision >= options_.max_multiprecision_boxes) {
    return {Step::Kind::kStop, {}, {}, Undecided::kBoxBudget};
  }
  if (interrupt != nullptr && interrupt->load(std::memory_order_relaxed)) {
    return {Step::Kind::kStop, {}, {}, Undecided::kInterrupted};
  }
  ++walk.judged;
  if (rung > 0) ++walk.multiprecision;
  const BoxVerdict verdict = judge_at(rung, walk.segment, box, walk.clearance, parts);
  const auto give_up = [&](Reason reason) { return Step{Step::Kind::kGiveUp, verdict, {}, std::move(reason)}; };
  const auto split = [&] { return Step{Step::Kind::kSplit, verdict}; };
  const auto climb = [&] { return Step{Step::Kind::kClimb, verdict}; };
  const auto refine = [&] { return Step{Step::Kind::kRefine, verdict}; };
  const bool higher_rung = rung < fine_.size() && !is_hopeless;
  switch (verdict.kind) {
    case Kind::kProved: return {Step::Kind::kProved, verdict};
    case Kind::kRefuted: return {Step::Kind::kRefuted, verdict, SegmentWitness{false, verdict.worst, box}};
    case Kind::kTooClose: return give_up(Undecided::kClearance);
    case Kind::kSplit:
      if (box.depth < deepest(rung, bits_)) return split();
      if (higher_rung) return locate_minimum(walk, task, verdict.worst);
      return give_up(at(Undecided::kDepth, verdict.worst));
    case Kind::kTolerance:
      if (parts == 1) return refine();
      if (box.depth < options_.tolerance_depth) {
        const bool parts_are_too_few = parts < kMostParts && !is_proved_inside(walk, task);
        return parts_are_too_few ? refine() : split();
      }
      // One deviation refutes; for the ends of a stretch the first and the last are looked for, which are costly.
      if (walk.deviation_found && box.upper() != Dyadic{1, 0})
        return give_up(at(Undecided::kTolerances, verdict.worst));
      if (auto witness = refuting_deviation(walk, box, verdict.worst)) {
        walk.deviation_found = true;
        return {Step::Kind::kRefuted, verdict, std::move(witness)};
      }
      if (parts < kMostParts) return refine();
      return give_up(at(Undecided::kTolerances, verdict.worst));
    case Kind::kPrecision:
      if (higher_rung) return locate_minimum(walk, task, verdict.worst);
      return give_up(at(Undecided::kPrecision, verdict.worst, ": it vanishes or nearly so"));
    case Kind::kOutOfRange: return give_up(Undecided::kParameterRange);
    case Kind::kSpansKnot:
      if (box.depth < DyadicBox::kMaxDepth) return split();
      return give_up(Undecided::kNoMotion);  // the inner pose is at no end of a box
    case Kind::kNoMotion:
      // The tube does not shrink with the box: what still fails here seldom succeeds in smaller boxes.
      if (box.depth < (walk.motion_given_up ? kHastyMotionDepth : options_.motion_depth)) return split();
      if (higher_rung && rung < kSingularRung && !walk.motion_given_up) return climb();
      walk.motion_given_up = true;
      return give_up(reason_of(verdict.kind));
    case Kind::kNearSingular:
    case Kind::kFault: break;
  }
  // A segment all along which the robot is singular (or the pose undefined) would cost all the budget.
  if (walk.singular_open > kMostSingular && box.depth >= kHastySingularDepth) return give_up(reason_of(verdict.kind));
  if (box.depth < options_.singular_depth) return split();
  if (verdict.kind == Kind::kNearSingular && box.depth == options_.singular_depth && rung == 0 &&
      is_singular_between_ends(walk.segment, box)) {
    return {Step::Kind::kRefuted, verdict, SegmentWitness{true, {}, box}};
  }
  if (higher_rung && rung < kSingularRung) return climb();
  if (box.depth < 2 * options_.singular_depth && !is_hopeless) return split();
  return give_up(reason_of(verdict.kind));
}

SegmentProof Prover::prove(const Segment& segment, double clearance) const {
  SegmentProof proof;
  proof.tension_N = proof.length_m = proof.wrench_scale = std::numeric_limits<double>::infinity();
  if (!is_admissible(segment)) {
    proof.reason = not_followed(segment.law);
    return proof;
  }
  Walk walk{segment, clearance};
  while (!walk.stack.empty()) {
    const Task task = walk.next();
    Step step = examine(walk, task);
    proof.boxes_judged = walk.judged;
    proof.boxes_multiprecision = walk.multiprecision;
    switch (step.kind) {
      case Step::Kind::kProved:
        proof.boxes.push_back(task.box);
        proof.tension_N = std::min(proof.tension_N, step.verdict.tension_N);
        proof.length_m = std::min(proof.length_m, step.verdict.length_m);
        proof.wrench_scale = std::min(proof.wrench_scale, step.verdict.wrench_scale);
        break;
      case Step::Kind::kRefuted:
        proof.verdict = Verdict::kRefuted;
        proof.witness = std::move(step.witness);
        return proof;
      case Step::Kind::kSplit: walk.split(task, task.rung); break;
      case Step::Kind::kClimb: walk.stack.push_back({task.box, task.rung + 1}); break;
      case Step::Kind::kRefine: walk.refine(task); break;
      case Step::Kind::kGiveUp:
        // What is not seen here may be elsewhere. Behind an inner pose it is of the path only if what leads there is proved.
        if (step.verdict.kind == BoxVerdict::Kind::kTolerance && segment.inner_poses.empty()) {
          proof.witness = refuting_deviation(walk, weakest_box(segment, step.verdict.worst), step.verdict.worst);
          if (proof.witness) {
            proof.verdict = Verdict::kRefuted;
            return proof;
          }
        }
        [[fallthrough]];
      case Step::Kind::kStop:
        proof.open_box = task.box;
        proof.reason = std::move(step.reason);
        return proof;
    }
  }
  proof.verdict = Verdict::kProved;
  return proof;
}

SegmentSurvey Prover::survey(const Segment& segment, const SurveyOptions& options) const {
  using Kind = SurveyedBox::Kind;
  SegmentSurvey survey;
  survey.tension_N = survey.length_m = survey.wrench_scale = std::numeric_limits<double>::infinity();
  if (!is_admissible(segment)) {
    survey.boxes.push_back({{}, Kind::kOpen, {}, not_followed(segment.law)});
    return survey;
  }
  Walk walk{segment};
  const auto follows_violation = [&] {
    return !survey.boxes.empty() && survey.boxes.back().kind != Kind::kProved &&
           survey.boxes.back().kind != Kind::kOpen;
  };
  while (!walk.stack.empty()) {
    Task task = walk.next();
    Step step = examine(walk, task);
    const bool is_fine = task.box.depth >= options.resolution_depth;
    const auto report = [&](Kind kind) {
      survey.boxes.push_back({task.box, kind, std::move(step.witness), std::move(step.reason)});
    };
    // Within what is violated anyway, the singular pose that tensions grow towards is not worth much.
    if (is_fine && step.verdict.kind == BoxVerdict::Kind::kNearSingular && step.kind != Step::Kind::kRefuted &&
        follows_violation()) {
      if (is_singular_between_ends(segment, task.box)) {
        step.witness = SegmentWitness{true, {}, task.box};
        report(Kind::kSingular);
      } else {
        step.reason = reason_of(step.verdict.kind);
        report(Kind::kOpen);
      }
      continue;
    }
    switch (step.kind) {
      case Step::Kind::kProved:
        survey.tension_N = std::min(survey.tension_N, step.verdict.tension_N);
        survey.length_m = std::min(survey.length_m, step.verdict.length_m);
        survey.wrench_scale = std::min(survey.wrench_scale, step.verdict.wrench_scale);
        report(Kind::kProved);
        break;
      case Step::Kind::kRefuted:
        if (step.witness->singular) {
          report(Kind::kSingular);
        } else if (step.verdict.throughout && step.witness->box == task.box) {
          report(Kind::kViolated);
        } else if (is_fine || step.witness->deviation) {
          report(Kind::kViolatedInside);
        } else {
          walk.split(task, 0);
        }
        break;
      case Step::Kind::kSplit: walk.split(task, task.rung); break;
      case Step::Kind::kClimb: walk.stack.push_back({task.box, task.rung + 1, task.is_hopeless}); break;
      case Step::Kind::kRefine: walk.refine(task); break;
      case Step::Kind::kGiveUp:
        // There may be violations next to what can't be decided, but no ladder will help.
        task.is_hopeless = true;
        if (step.verdict.kind == BoxVerdict::Kind::kNearSingular || step.verdict.kind == BoxVerdict::Kind::kFault) {
          ++walk.singular_open;
        }
        if (is_fine || step.verdict.kind == BoxVerdict::Kind::kTolerance ||
            step.verdict.kind == BoxVerdict::Kind::kNoMotion) {
          report(Kind::kOpen);
        } else {
          walk.split(task, 0);
        }
        break;
      case Step::Kind::kStop: report(Kind::kOpen); break;
    }
  }
  survey.boxes_judged = walk.judged;
  survey.boxes_multiprecision = walk.multiprecision;
  return survey;
}

std::optional<MpInterval> Prover::deviated_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin,
                                                  const Deviation& deviation) const {
  const std::size_t rung = deviation_rung(fine_.size());
  const PrecisionScope precision(bits_[rung]);
  const ProofModel<MpInterval>& model = fine(rung);
  Faults<MpInterval>::clear();
  const auto mid = enclose<MpInterval>(box.mid());
  const MotionEnclosure<MpInterval> commanded = undisturbed_motion(model, segment, {mid, mid}, MpInterval(0.0));
  if (commanded.status != MotionEnclosure<MpInterval>::Status::kKnown) return std::nullopt;
  const auto at_mid = [](const SlopeForm<MpInterval>& x) { return x.at_mid; };
  MpInterval quantity = deviated_quantity(model.model, *problem_.tolerances, commanded.p_WP.unaryExpr(at_mid),
                                          commanded.r_WP.unaryExpr(at_mid), deviation, margin);
  if (Faults<MpInterval>::raised()) return std::nullopt;
  return quantity;
}

MpInterval Prover::quantity_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin,
                                   const Deviation& deviation) const {
  std::optional<MpInterval> quantity = deviated_at_mid(segment, box, margin, deviation);
  if (!quantity) throw std::logic_error("a deviation has no enclosure");
  return *std::move(quantity);
}

DyadicBox Prover::weakest_box(const Segment& segment, MarginId margin) const {
  std::call_once(sampler_made_, [&] { sampler_.emplace(problem_); });
  DyadicBox weakest;
  double least = std::numeric_limits<double>::infinity();
  for (DyadicBox box{0, options_.tolerance_depth}; box.upper() <= Dyadic{1, 0}; ++box.k) {
    const Statics<double> statics = sampler_->statics(sampler_->rigid_pose(segment, box.mid().approx()));
    const double here = room(sampler_->model(), limited_quantity(statics, margin), margin);
    if (statics.regular && here < least) {
      least = here;
      weakest = box;
    }
  }
  return weakest;
}

std::optional<SegmentWitness> Prover::refuting_deviation(Walk& walk, const DyadicBox& box, MarginId margin) const {
  if (fine_.empty() || walk.deviation_failed) return std::nullopt;
  std::call_once(sampler_made_, [&] { sampler_.emplace(problem_); });
  const RigidPose pose = sampler_->rigid_pose(walk.segment, box.mid().approx());
  using Proposal = std::pair<MarginId, ProposedDeviation>;
  // Of those margins, what breaks them within this part of the tolerances, or leads nowhere.
  const auto breaking = [&](const std::vector<MarginId>& margins, double part) {
    std::vector<Proposal> result;
    for (const MarginId of : margins) {
      auto worst = worst_deviation(*problem_.tolerances, sampler_->model(), pose, of,
                                   is_held_by_lengths(walk.segment.law), part);
      if (worst) result.emplace_back(of, *std::move(worst));
    }
    return result;
  };
  enum class Outcome { kRefutes, kHarmless, kNotFollowed };
  const auto attempt = [&](const Proposal& proposal) {
    const auto& [of, proposed] = proposal;
    if (!proposed.leads_to_pose) return Outcome::kNotFollowed;
    const std::optional<MpInterval> quantity = deviated_at_mid(walk.segment, box, of, proposed.deviation);
    if (!quantity) return Outcome::kNotFollowed;
    const std::size_t rung = deviation_rung(fine_.size());
    const PrecisionScope precision(bits_[rung]);
    return certainly_nonpositive(room(fine(rung).model, *quantity, of)) ? Outcome::kRefutes : Outcome::kHarmless;
  };
  const auto witness = [&](const Proposal& proposal) {
    return SegmentWitness{false, proposal.first, box, std::make_shared<const Deviation>(proposal.second.deviation)};
  };
  constexpr auto kAll = all_margins();
  const std::vector<MarginId> all(kAll.begin(), kAll.end());
  std::vector<Proposal> proposals = breaking({margin}, 1);
  if (proposals.empty()) {
    // That is the weakest one undisturbed. Others may be more sensitive: tried where this is first asked, and at the segment's end.
    const bool is_last = box.upper() == Dyadic{1, 0};
    if (std::exchange(walk.all_margins_tried, true) && !is_last) return std::nullopt;
    proposals = breaking(all, 1);
    if (proposals.empty()) return std::nullopt;
  }
  switch (attempt(proposals.front())) {
    case Outcome::kRefutes: return witness(proposals.front());
    case Outcome::kHarmless: return std::nullopt;
    case Outcome::kNotFollowed: break;
  }
  // As towards a singular pose. On the way there some limit breaks first: the part is halved until none does, bisected, and
  // taken a little larger, so that it can be proved.
  constexpr double kLeast = 0x1p-20;
  constexpr int kBisections = 8;
  constexpr double kMore = 1 + 0x1p-5;
  std::vector<MarginId> margins = all;
  const auto breaks = [&](double part) {
    std::vector<Proposal> found = breaking(margins, part);
    if (found.empty()) return false;
    margins.clear();
    for (const Proposal& proposal : found) margins.push_back(proposal.first);
    return true;
  };
  double most = 1;
  while (most > kLeast && breaks(0.5 * most)) most *= 0.5;
  double none = 0.5 * most;
  for (int k = 0; k < kBisections; ++k) {
    const double part = 0.5 * (none + most);
    (breaks(part) ? most : none) = part;
  }
  constexpr int kAttempts = 2;  // a proof of a way takes long
  int attempts = 0;
  for (const Proposal& proposal : breaking(margins, std::min(1.0, kMore * most))) {
    if (!proposal.second.leads_to_pose || attempts == kAttempts) continue;
    ++attempts;
    if (attempt(proposal) == Outcome::kRefutes) return witness(proposal);
  }
  walk.deviation_failed = true;
  return std::nullopt;
}

MpInterval Prover::quantity_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin) const {
  const auto n = static_cast<std::size_t>(margin.cable);
  std::optional<MpInterval> quantity;
  for (std::size_t k = 0; k < fine_.size(); ++k) {
    const PrecisionScope precision(bits_[k]);
    const Model<MpInterval>& model = fine(k).model;
    Faults<MpInterval>::clear();
    const BoxEnclosure<MpInterval> enclosure = enclose_box(fine(k), segment, box);
    const bool is_known = std::ranges::any_of(enclosure.margins, [&](const auto& x) { return x.id == margin; });
    if (Faults<MpInterval>::raised() || !is_known) continue;
    switch (margin.kind) {
      case MarginKind::kTensionMin: quantity = enclosure.low[n].at_mid; break;
      case MarginKind::kTensionMax: quantity = enclosure.high[n].at_mid; break;
      case MarginKind::kLengthMin:
      case MarginKind::kLengthMax: quantity = enclosure.length[n].at_mid; break;
    }
    if (certainly_nonpositive(room(model, *quantity, margin))) break;
  }
  if (!quantity) throw std::logic_error("a refuted midpoint has no enclosure");
  return *quantity;
}

}  // namespace taut
