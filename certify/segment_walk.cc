// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/segment_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace taut {
namespace {

/// Factor by which the number of continuation steps grows when a step is too coarse (up to kMostContinuationSteps).
constexpr int kMoreSteps = 4;

/// A survey locates the ends of a violation to boxes of this depth; a thinner violation shows in the midpoint of a
/// deeper box.
constexpr int kResolutionDepth = 12;

/// More bits than those of this rung show nothing about a Jacobian that is nearly singular.
constexpr std::size_t kSingularRung = 3;

bool is_fine(const DyadicBox& box) { return box.depth >= kResolutionDepth; }

Undecided reason_of(BoxVerdict::Kind kind) {
  switch (kind) {
    case BoxVerdict::Kind::kFault: return Undecided::kUndefined;
    case BoxVerdict::Kind::kNoMotion: return Undecided::kNoMotion;
    default: return Undecided::kSingular;
  }
}

/// For a reason whose words end with "at".
Reason at(Undecided reason, MarginId margin, std::string_view detail = {}) {
  std::string place = std::string(" margin ") + name(margin.kind) + " of cable " + std::to_string(margin.cable + 1);
  return {reason, place.append(detail)};
}

/// The form of one margin over a box, at the working precision. Void if a fault is raised.
std::optional<SlopeForm<MpInterval>> margin_over(const ProofModel<MpInterval>& model, const Segment& segment,
                                                 const DyadicBox& box, MarginId id) {
  const BoxEnclosure<MpInterval> enclosure = enclose_box(model, segment, box);
  for (const auto& margin : enclosure.margins) {
    if (margin.id == id) return margin.value;
  }
  return std::nullopt;
}

/// Whether smaller boxes may be proved where this one was not.
bool may_be_too_wide(BoxVerdict::Kind kind) {
  using Kind = BoxVerdict::Kind;
  return kind == Kind::kSplit || kind == Kind::kNearSingular || kind == Kind::kFault || kind == Kind::kSpansKnot ||
         kind == Kind::kNoMotion;
}

/// The depth of the largest box that is likely to be proved next to one that was judged.
int likely_depth_after(const DyadicBox& box, const BoxVerdict& verdict) {
  // Strain grows like this power of the width: between 1, of slopes, and 2, of what slopes vary by.
  constexpr double kOrder = 1.5;
  constexpr double kLeast = 1e-9, kGreatest = 1e9;
  const double halvings = std::log2(std::clamp(verdict.strain, kLeast, kGreatest)) / kOrder;
  if (verdict.kind == BoxVerdict::Kind::kProved) return box.depth + static_cast<int>(std::min(0.0, halvings));
  if (verdict.kind != BoxVerdict::Kind::kSplit) return box.depth + 1;
  return box.depth + std::max(1, static_cast<int>(halvings));
}

/// The depth of boxes about as long as the longest that are usually proved of paths through parameters.
int likely_first_depth(const Segment& segment) {
  if (segment.law != Interpolation::kStraight) return 0;
  constexpr double kUsual = 0.5;  // in the parameters [rad, m]
  constexpr double kGreatest = 1e3;
  const ParameterPoint &a = segment.control[0]->parameters(), &b = segment.control[1]->parameters();
  double square = 0;
  for (std::size_t j = 0; j < a.x.size(); ++j) {
    const double step = b.x[j] - a.x[j] + std::numbers::pi * (b.half_turns[j] - a.half_turns[j]);
    square += step * step;
  }
  const double halvings = std::log2(std::clamp(std::sqrt(square), kUsual, kGreatest) / kUsual);
  return static_cast<int>(halvings);
}

BigFloat middle(const MpInterval& x) { return MpfrRounding<BigFloat>::median(x.lower(), x.upper()); }

/// 2^-depth
BigFloat resolution_at(int depth) {
  return BigFloat::apply_rounded(MPFR_RNDN,
                                 [depth](mpfr_ptr x, mpfr_rnd_t mode) { mpfr_set_ui_2exp(x, 1, -depth, mode); });
}

/// The box of `depth` within `box` that is nearest to s.
DyadicBox box_around(const BigFloat& s, const DyadicBox& box, int depth) {
  const int finer = depth - box.depth;
  DyadicBox result{Dyadic::nearest(s, depth).k, depth};
  result.k = std::clamp<boost::multiprecision::cpp_int>(result.k, box.k << finer, ((box.k + 1) << finer) - 1);
  return result;
}

/// A secant method for the zero of a margin's slope in a box. It proves nothing.
class SlopeSecants {
 public:
  /// At the working precision; begins in the middle of the box, and goes on from where it was at the last precision.
  void use_precision(const DyadicBox& box) {
    lower_ = enclose<MpInterval>(box.lower()).lower();
    upper_ = enclose<MpInterval>(box.upper()).upper();
    if (!s_) s_ = middle(enclose<MpInterval>(box.mid()));
  }

  [[nodiscard]] const BigFloat& s() const { return *s_; }

  /// Moves on from s(), where the slope is `slope`. @returns whether s() has moved by more than `resolution`.
  bool advance(const BigFloat& slope, const BigFloat& resolution) {
    const BigFloat at = *s_;
    if (!earlier_) {
      const BigFloat quarter = (upper_ - lower_) / BigFloat(4.0);
      s_ = slope > BigFloat(0.0) ? at - quarter : at + quarter;
    } else {
      const BigFloat bend = slope - slope_earlier_;
      const BigFloat moved = at - *earlier_;
      if (!(abs(bend) > BigFloat(0.0)) || !(abs(moved) > BigFloat(0.0))) return false;
      s_ = at - slope * moved / bend;
    }
    if (!(*s_ > lower_)) s_ = lower_;
    if (!(*s_ < upper_)) s_ = upper_;
    earlier_ = at;
    slope_earlier_ = slope;
    return abs(*s_ - at) > resolution;
  }

 private:
  BigFloat lower_, upper_;
  std::optional<BigFloat> s_, earlier_;
  BigFloat slope_earlier_;
};

}  // namespace

SegmentWalk::SegmentWalk(const Prover& prover, const Segment& segment, double clearance, Extent extent,
                         const std::stop_token& stop, ProofAim aim, const ClearPoses* clear)
    : prover_(prover),
      ladder_(prover.ladder()),
      segment_(segment),
      clearance_(clearance),
      extent_(extent),
      stop_(stop),
      aim_(aim),
      deviations_(prover, segment),
      clear_(clear) {
  survey_.tension_N = survey_.length_m = survey_.wrench_scale = survey_.clearance_m =
      std::numeric_limits<double>::infinity();
  if (prover.bodies() == nullptr) return;
  if (clear_ != nullptr) {
    directions_ = clear_->directions();
    return;
  }
  const PoseSampler& sampler = prover.sampler();
  const std::array<RigidPose, 2> ends{sampler.rigid_pose(segment, 0), sampler.rigid_pose(segment, 1)};
  directions_ = std::make_shared<const PairDirections>(
      prover.bodies()->first_directions(sampler.model(), sampler.rigid_pose(segment, 0.5), ends));
}

SegmentSurvey SegmentWalk::run() {
  if (prove_in_strides()) return std::move(survey_);
  while (!open_.empty() && !is_over_) {
    const Task task = std::move(open_.back());
    open_.pop_back();
    take(task, examine(task));
  }
  survey_.boxes_judged += boxes_of_strides_;
  return std::move(survey_);
}

bool SegmentWalk::prove_in_strides() {
  if (directions_ && clear_ == nullptr) return false;  // they change along the way
  constexpr int kDeepest = 12;  // what takes smaller boxes is next to a limit, where the loop looks more closely
  const int most_boxes = std::min(1000, prover_.options().max_boxes / 2);  // little that a failure can waste
  SegmentSurvey proved = survey_;
  std::vector<DyadicBox> open = {DyadicBox{}};
  int likely_depth = likely_first_depth(segment_);
  const auto halve = [&](const DyadicBox& box) {
    open.push_back(box.right());
    open.push_back(box.left());  // judged first
  };
  while (!open.empty()) {
    const DyadicBox box = std::move(open.back());
    open.pop_back();
    if (box.depth < likely_depth) {
      halve(box);
      continue;
    }
    if (box.depth > kDeepest || boxes_of_strides_ >= most_boxes || stop_.stop_requested()) return false;
    ++boxes_of_strides_;
    const BoxVerdict verdict = ladder_.judge(0, segment_, box, clearance_, 1, directions_.get(), clear_);
    likely_depth = std::min(likely_depth_after(box, verdict), kDeepest);
    if (verdict.kind == BoxVerdict::Kind::kProved) {
      proved.tension_N = std::min(proved.tension_N, verdict.tension_N);
      proved.length_m = std::min(proved.length_m, verdict.length_m);
      proved.wrench_scale = std::min(proved.wrench_scale, verdict.wrench_scale);
      proved.clearance_m = std::min(proved.clearance_m, verdict.clearance_m);
      proved.boxes.push_back({box, SurveyedBox::Kind::kProved, {}, {}, directions_});
    } else if (may_be_too_wide(verdict.kind)) {
      halve(box);
    } else {
      return false;
    }
  }
  proved.boxes_judged = boxes_of_strides_;
  survey_ = std::move(proved);
  return true;
}

std::optional<SegmentWitness> SegmentWalk::refute_elsewhere() {
  // A witness behind an inner pose is about the path only if what leads there is proved.
  if (last_verdict_.kind != BoxVerdict::Kind::kTolerance || !segment_.inner_poses.empty()) return std::nullopt;
  if (last_verdict_.rate) {
    return deviations_.refute_power(deviations_.strongest_box(*last_verdict_.rate), *last_verdict_.rate);
  }
  return deviations_.refute(deviations_.weakest_box(last_verdict_.worst), last_verdict_.worst);
}

// ---- What to do with a box ------------------------------------------------------------------------------------------

bool SegmentWalk::may_climb(const Task& task) const { return task.rung < ladder_.last() && !task.is_hopeless; }

SegmentWalk::Step SegmentWalk::examine(const Task& task) {
  using Kind = BoxVerdict::Kind;
  const ProofOptions& options = prover_.options();
  if (survey_.boxes_judged + boxes_of_strides_ >= options.max_boxes ||
      survey_.boxes_multiprecision >= options.max_multiprecision_boxes) {
    return {Step::Kind::kStop, {}, {}, Undecided::kBoxBudget};
  }
  if (stop_.stop_requested()) return {Step::Kind::kStop, {}, {}, Undecided::kInterrupted};
  ++survey_.boxes_judged;
  if (task.rung > 0) ++survey_.boxes_multiprecision;
  const BoxVerdict verdict =
      ladder_.judge(task.rung, segment_, task.box, clearance_, task.continuation_steps, directions_.get(), clear_);
  switch (verdict.kind) {
    case Kind::kNear: return examine_bodies(task, verdict);
    case Kind::kInside: {
      if (auto refuted = refute_contact(task, verdict, verdict.near.front().pair)) return *std::move(refuted);
      const std::string where = " " + pair_name(verdict.near.front().pair) + " (inside)";
      return {Step::Kind::kGiveUp, verdict, {}, {Undecided::kBodies, where}};
    }
    case Kind::kProved: return {Step::Kind::kProved, verdict};
    case Kind::kRefuted: return {Step::Kind::kRefuted, verdict, SegmentWitness{false, verdict.worst, task.box}};
    case Kind::kTooFast:
      return {Step::Kind::kRefuted, verdict, SegmentWitness{false, {}, task.box, nullptr, {}, *verdict.rate}};
    case Kind::kSlowing: return {Step::Kind::kGiveUp, verdict, {}, Undecided::kSlowing};
    case Kind::kTooClose: return {Step::Kind::kGiveUp, verdict, {}, Undecided::kClearance};
    case Kind::kOutOfRange: return {Step::Kind::kGiveUp, verdict, {}, Undecided::kParameterRange};
    case Kind::kSplit:
    case Kind::kPrecision: return examine_split(task, verdict);
    case Kind::kTolerance: return examine_deviations(task, verdict);
    case Kind::kSpansKnot:
    case Kind::kNoMotion: return examine_motion(task, verdict);
    case Kind::kNearSingular:
    case Kind::kFault: break;
  }
  return examine_singular(task, verdict);
}

SegmentWalk::Step SegmentWalk::examine_split(const Task& task, const BoxVerdict& verdict) {
  const bool is_imprecise = verdict.kind == BoxVerdict::Kind::kPrecision;
  if (!is_imprecise && task.box.depth < ladder_.deepest(task.rung)) return {Step::Kind::kSplit, verdict};
  if (may_climb(task) && verdict.rate) return {Step::Kind::kClimb, verdict};
  if (may_climb(task)) return locate_minimum(task, verdict.worst);
  if (verdict.rate) {
    const Undecided reason = is_imprecise ? Undecided::kPrecision : Undecided::kDepth;
    return {Step::Kind::kGiveUp, verdict, {}, {reason, " a limit of speeds or accelerations"}};
  }
  return {Step::Kind::kGiveUp,
          verdict,
          {},
          is_imprecise ? at(Undecided::kPrecision, verdict.worst, ": it vanishes or nearly so")
                       : at(Undecided::kDepth, verdict.worst)};
}

SegmentWalk::Step SegmentWalk::examine_deviations(const Task& task, const BoxVerdict& verdict) {
  const Step refine{Step::Kind::kRefine, verdict};
  const bool steps_are_few = task.continuation_steps < kMostContinuationSteps;
  if (task.continuation_steps == 1) return refine;
  if (task.box.depth < prover_.options().tolerance_depth) {
    return steps_are_few && !is_proved_inside(task) ? refine : Step{Step::Kind::kSplit, verdict};
  }
  const Step give_up{
      Step::Kind::kGiveUp,
      verdict,
      {},
      verdict.rate ? Reason{Undecided::kTolerances, " a limit of power"} : at(Undecided::kTolerances, verdict.worst)};
  // In a move the search takes longer than more steps do.
  if (steps_are_few && (aim_ == ProofAim::kProve || segment_.timing != nullptr)) return refine;
  if (aim_ == ProofAim::kProve) return give_up;
  // Once a deviation refutes the segment, only its last box is searched again: a survey states the first and the last
  // violation of a stretch, and each search is costly.
  if (deviation_refutes_ && task.box.upper() != Dyadic{1, 0}) return give_up;
  auto witness =
      verdict.rate ? deviations_.refute_power(task.box, *verdict.rate) : deviations_.refute(task.box, verdict.worst);
  if (witness) {
    deviation_refutes_ = true;
    return {Step::Kind::kRefuted, verdict, std::move(witness)};
  }
  return steps_are_few ? refine : give_up;
}

SegmentWalk::Step SegmentWalk::examine_motion(const Task& task, const BoxVerdict& verdict) {
  constexpr int kHastyDepth = 5;  // where all means failed once on the segment, they are not tried again
  const Step give_up{Step::Kind::kGiveUp, verdict, {}, Undecided::kNoMotion};
  if (verdict.kind == BoxVerdict::Kind::kSpansKnot) {
    if (task.box.depth < DyadicBox::kMaxDepth) return {Step::Kind::kSplit, verdict};
    return give_up;  // no box ends at the inner pose
  }
  // The tube does not shrink with the box, so smaller boxes seldom succeed where this one fails.
  const int depth = motion_given_up_ ? kHastyDepth : prover_.options().motion_depth;
  if (task.box.depth < depth) return {Step::Kind::kSplit, verdict};
  if (may_climb(task) && task.rung < kSingularRung && !motion_given_up_) return {Step::Kind::kClimb, verdict};
  motion_given_up_ = true;
  return give_up;
}

SegmentWalk::Step SegmentWalk::examine_singular(const Task& task, const BoxVerdict& verdict) {
  // A segment all along which the robot is singular (or the pose undefined) would use up the budget; after this many
  // open boxes, large ones are given up.
  constexpr int kMostOpen = 256;
  constexpr int kHastyDepth = 8;
  const int singular_depth = prover_.options().singular_depth;
  const Step give_up{Step::Kind::kGiveUp, verdict, {}, reason_of(verdict.kind)};
  const Step split{Step::Kind::kSplit, verdict};
  if (singular_open_ > kMostOpen && task.box.depth >= kHastyDepth) return give_up;
  if (task.box.depth < singular_depth) return split;
  if (verdict.kind == BoxVerdict::Kind::kNearSingular && task.box.depth == singular_depth && task.rung == 0 &&
      is_singular_between_ends(task.box)) {
    return {Step::Kind::kRefuted, verdict, SegmentWitness{true, {}, task.box}};
  }
  if (may_climb(task) && task.rung < kSingularRung) return {Step::Kind::kClimb, verdict};
  if (task.box.depth < 2 * singular_depth && !task.is_hopeless) return split;
  return give_up;
}

// ---- Bodies ---------------------------------------------------------------------------------------------------------

SegmentWalk::Step SegmentWalk::examine_bodies(const Task& task, const BoxVerdict& verdict) {
  const bool may_split = task.box.depth < ladder_.deepest(task.rung);
  if (verdict.near.empty()) {
    if (task.box.depth < prover_.options().tolerance_depth) return {Step::Kind::kSplit, verdict};
    return {Step::Kind::kGiveUp, verdict, {}, {Undecided::kBodies, " a cable may be shorter than its free ends"}};
  }
  const double s = task.box.mid().approx();
  for (std::size_t time = task.redirections; time < kMostRedirections; ++time) {
    if (redirect(task.box, verdict, time)) return {Step::Kind::kRedirect, verdict};
  }

  const auto gap_of = [&](const BoxVerdict::NearPair& near) { return gap(near.pair, s); };
  const BoxVerdict::NearPair nearest = *std::ranges::min_element(verdict.near, {}, gap_of);
  if (auto refuted = refute_contact(task, verdict, nearest.pair)) return *std::move(refuted);

  using AtMid = BoxVerdict::NearPair::AtMid;
  const Step give_up{Step::Kind::kGiveUp, verdict, {}, {Undecided::kBodies, " " + pair_name(nearest.pair)}};
  if (aim_ == ProofAim::kProve && !(room(nearest.pair, s) > 0)) return give_up;
  switch (nearest.at_mid) {
    case AtMid::kApart:
      if (may_split) return {Step::Kind::kSplit, verdict};
      break;
    case AtMid::kApartUndisturbed:
      if (task.box.depth < prover_.options().tolerance_depth) return {Step::Kind::kSplit, verdict};
      return give_up;
    case AtMid::kUnknown: break;
  }
  if (may_climb(task) && task.rung < kSingularRung) return {Step::Kind::kClimb, verdict};
  return give_up;
}

/// Takes the directions along which the near pairs are farthest apart at the middle of a box, with more digits and for
/// meshes more of them each time. @returns whether any is another one.
bool SegmentWalk::redirect(const DyadicBox& box, const BoxVerdict& verdict, std::size_t time) {
  constexpr std::array<int, kMostRedirections> kLargest = {Direction::kFine, Direction::kLargest};
  constexpr std::array<double, kMostRedirections> kShare = {0.5, 0.9};  // of a mesh's gap
  const PoseSampler& sampler = prover_.sampler();
  const auto pose_at = [&](const Dyadic& s) { return sampler.rigid_pose(segment_, s.approx()); };
  const RigidPose pose = pose_at(box.mid());
  const std::array<RigidPose, 2> ends{pose_at(box.lower()), pose_at(box.upper())};
  PairDirections turned = *directions_;
  for (const auto& near : verdict.near) {
    std::vector<Direction> directions =
        prover_.bodies()->directions(sampler.model(), pose, near.pair, kLargest.at(time), kShare.at(time), ends);
    if (!directions.empty()) turned.set(near.pair, std::move(directions));
  }
  if (turned == *directions_) return false;
  directions_ = std::make_shared<const PairDirections>(std::move(turned));
  clear_ = nullptr;
  return true;
}

double SegmentWalk::room(std::size_t pair, double s) const {
  const PoseSampler& sampler = prover_.sampler();
  return prover_.bodies()->room(sampler.model(), sampler.rigid_pose(segment_, s), pair);
}

double SegmentWalk::gap(std::size_t pair, double s) const {
  const PoseSampler& sampler = prover_.sampler();
  return prover_.bodies()->gap(sampler.model(), sampler.rigid_pose(segment_, s), pair);
}

/// Where in a box a pair comes nearest, as floating point finds it: from samples, then by golden sections.
double SegmentWalk::nearest_place(std::size_t pair, const DyadicBox& box) const {
  constexpr int kSamples = 8;
  constexpr int kSections = 40;
  constexpr double kGolden = 0.6180339887498949;
  const double begin = box.lower().approx(), width = box.upper().approx() - begin;
  const auto place = [&](double share) { return begin + share * width; };
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kSamples; ++k) {
    const double found = gap(pair, place(static_cast<double>(k) / kSamples));
    if (found < least) {
      least = found;
      best = k;
    }
  }
  double low = place(static_cast<double>(std::max(best - 1, 0)) / kSamples);
  double high = place(static_cast<double>(std::min(best + 1, kSamples)) / kSamples);
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = gap(pair, left), at_right = gap(pair, right);
  for (int k = 0; k < kSections; ++k) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = gap(pair, left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = gap(pair, right);
    }
  }
  return at_left < at_right ? left : right;
}

/// A pair that bisection would find to be too near only at the onset of contact, where nothing can be refuted, is
/// refuted where it is nearest.
std::optional<SegmentWalk::Step> SegmentWalk::refute_contact(const Task& task, const BoxVerdict& verdict,
                                                             std::size_t pair) {
  constexpr int kEvery = 4;           // halvings between two searches, each of which takes some fifty distances
  constexpr int kPlace = 44;          // halvings to a place
  constexpr double kTouching = 1e-9;  // what floating point may take for the gap of bodies that overlap [m]
  constexpr int kMostInVain = 8;      // bodies without a volume may touch where no precision tells
  if (aim_ == ProofAim::kProve) return std::nullopt;
  const PoseSampler& sampler = prover_.sampler();
  const auto judge = [&](const DyadicBox& box) -> std::optional<Step> {
    const RigidPose pose = sampler.rigid_pose(segment_, box.mid().approx());
    int& in_vain = vain_refutations_[pair];
    const std::size_t last = in_vain < kMostInVain ? std::min(ladder_.last(), kSingularRung) : 0;
    const std::vector<PairContact> ways = prover_.bodies()->contacts(sampler.model(), pose, pair);
    for (std::size_t rung = 0; rung <= last; ++rung) {
      for (const PairContact& way : ways) {
        const Contact contact = ladder_.judge_contact(rung, segment_, box, way);
        if (contact == Contact::kUnknown) continue;
        Step step{Step::Kind::kRefuted, verdict, SegmentWitness{}};
        step.witness->box = box;
        step.witness->contact = way;
        step.verdict.throughout = contact == Contact::kThroughout;
        return step;
      }
    }
    ++in_vain;
    return std::nullopt;
  };
  const bool is_narrow = task.box.depth + 1 >= kPlace;
  if (const double middle = task.box.mid().approx(); gap(pair, middle) <= kTouching) {
    if (auto step = judge(task.box)) return step;
    if (is_narrow) return std::nullopt;
    if (auto step = judge(box_around(BigFloat(middle), task.box, kPlace))) return step;
  }
  if (task.box.depth % kEvery != 0 || is_narrow) return std::nullopt;
  const double s = nearest_place(pair, task.box);
  if (gap(pair, s) > kTouching) return std::nullopt;
  return judge(box_around(BigFloat(s), task.box, kPlace));
}

std::string SegmentWalk::pair_name(std::size_t pair) const {
  const BodiesText& bodies = *prover_.problem().bodies;
  return name(bodies, pairs(bodies).at(pair));
}

// ---- Singular poses -------------------------------------------------------------------------------------------------

bool SegmentWalk::is_singular_between_ends(const DyadicBox& box) const {
  for (std::size_t rung = 1; rung <= ladder_.last(); ++rung) {
    const PrecisionScope precision(ladder_.bits(rung));
    const ProofModel<MpInterval>& model = ladder_.multiprecision(rung);
    const int lower = determinant_sign(model, segment_, box.lower());
    const int upper = determinant_sign(model, segment_, box.upper());
    if (lower != 0 && upper != 0) return lower != upper && is_motion_known(model, segment_, box);
  }
  return false;
}

/// Whether a much narrower box in the middle would be proved with as many continuation steps.
bool SegmentWalk::is_proved_inside(const Task& task) {
  constexpr int kNarrower = 10;  // halvings
  const DyadicBox narrow{(task.box.k << kNarrower) + (1 << (kNarrower - 1)), task.box.depth + kNarrower};
  ++survey_.boxes_judged;
  const BoxVerdict verdict = ladder_.judge(task.rung, segment_, narrow, clearance_, task.continuation_steps);
  return verdict.kind == BoxVerdict::Kind::kProved;
}

/// For a margin that is next to 0: looks for the point of the box where it is least, which shows sooner than bisection
/// what bisection would find. Only the ladder's verdicts make claims; should the search go wrong, the box climbs one
/// rung as it would anyway.
SegmentWalk::Step SegmentWalk::locate_minimum(const Task& task, MarginId margin) {
  constexpr int kMostSteps = 24;  // on one rung; secants gain digits like 1, 1, 2, 3, 5
  const Step climb{Step::Kind::kClimb};
  SlopeSecants secants;
  for (std::size_t rung = task.rung + 1; rung <= ladder_.last(); ++rung) {
    const PrecisionScope precision(ladder_.bits(rung));
    const int depth = ladder_.deepest(rung);
    if (depth <= task.box.depth) return climb;
    const BigFloat resolution = resolution_at(depth);
    secants.use_precision(task.box);
    bool is_positive = false;
    for (int step = 0; step < kMostSteps; ++step) {
      const DyadicBox point = box_around(secants.s(), task.box, depth);
      ++survey_.boxes_judged;
      ++survey_.boxes_multiprecision;
      const BoxVerdict verdict = ladder_.judge(rung, segment_, point, clearance_, task.continuation_steps);
      if (verdict.kind == BoxVerdict::Kind::kRefuted) {
        return {Step::Kind::kRefuted, verdict, SegmentWitness{false, verdict.worst, point}};
      }
      Faults<MpInterval>::clear();
      const auto value = margin_over(ladder_.multiprecision(rung), segment_, point, margin);
      if (!value || Faults<MpInterval>::raised()) return climb;
      const BigFloat slope = middle(value->slope);
      // It stays positive as far from s as the least point may be.
      is_positive = value->at_mid.lower() > abs(slope) * resolution;
      if (!secants.advance(slope, resolution)) break;
    }
    if (is_positive) return climb;
  }
  const std::string bits = std::to_string(ladder_.bits(ladder_.last()));
  return {Step::Kind::kGiveUp,
          {},
          {},
          at(Undecided::kPrecision, margin, ": it is zero, or too close to it for " + bits + " bits to tell")};
}

// ---- Doing it -------------------------------------------------------------------------------------------------------

void SegmentWalk::report(const Task& task, SurveyedBox::Kind kind, Step step) {
  const bool is_proved = kind == SurveyedBox::Kind::kProved;
  survey_.boxes.push_back(
      {task.box, kind, std::move(step.witness), std::move(step.reason), is_proved ? directions_ : nullptr});
  last_verdict_ = step.verdict;
  if (extent_ == Extent::kToFirstFailure && kind != SurveyedBox::Kind::kProved) is_over_ = true;
}

void SegmentWalk::split(const Task& task, std::size_t rung) {
  open_.push_back({task.box.right(), rung, task.is_hopeless});
  open_.push_back({task.box.left(), rung, task.is_hopeless});  // judged first
}

bool SegmentWalk::follows_violation() const {
  if (survey_.boxes.empty()) return false;
  const SurveyedBox::Kind kind = survey_.boxes.back().kind;
  return kind != SurveyedBox::Kind::kProved && kind != SurveyedBox::Kind::kOpen;
}

void SegmentWalk::take(const Task& task, Step step) {
  using Kind = SurveyedBox::Kind;
  // Tensions grow towards a singular pose. Where they are violated already, it is not worth locating precisely.
  if (is_fine(task.box) && step.verdict.kind == BoxVerdict::Kind::kNearSingular && step.kind != Step::Kind::kRefuted &&
      follows_violation()) {
    if (is_singular_between_ends(task.box)) {
      step.witness = SegmentWitness{true, {}, task.box};
      report(task, Kind::kSingular, std::move(step));
    } else {
      step.reason = reason_of(step.verdict.kind);
      report(task, Kind::kOpen, std::move(step));
    }
    return;
  }
  switch (step.kind) {
    case Step::Kind::kProved:
      survey_.tension_N = std::min(survey_.tension_N, step.verdict.tension_N);
      survey_.length_m = std::min(survey_.length_m, step.verdict.length_m);
      survey_.wrench_scale = std::min(survey_.wrench_scale, step.verdict.wrench_scale);
      survey_.clearance_m = std::min(survey_.clearance_m, step.verdict.clearance_m);
      report(task, Kind::kProved, std::move(step));
      break;
    case Step::Kind::kRefuted: take_refuted(task, std::move(step)); break;
    case Step::Kind::kSplit: split(task, task.rung); break;
    case Step::Kind::kClimb: open_.push_back({task.box, task.rung + 1, task.is_hopeless}); break;
    case Step::Kind::kRefine:
      open_.push_back(task);
      open_.back().continuation_steps *= kMoreSteps;
      break;
    case Step::Kind::kRedirect:
      open_.push_back(task);
      ++open_.back().redirections;
      break;
    case Step::Kind::kGiveUp: take_given_up(task, std::move(step)); break;
    case Step::Kind::kStop: report(task, Kind::kOpen, std::move(step)); break;
  }
}

void SegmentWalk::take_refuted(const Task& task, Step step) {
  using Kind = SurveyedBox::Kind;
  if (step.witness->singular) {
    report(task, Kind::kSingular, std::move(step));
  } else if (step.verdict.throughout && step.witness->box == task.box) {
    report(task, Kind::kViolated, std::move(step));
  } else if (is_fine(task.box) || step.witness->deviation || extent_ == Extent::kToFirstFailure) {
    report(task, Kind::kViolatedInside, std::move(step));
  } else {
    split(task, 0);
  }
}

void SegmentWalk::take_given_up(const Task& task, Step step) {
  using Kind = BoxVerdict::Kind;
  const Kind kind = step.verdict.kind;
  if (kind == Kind::kNearSingular || kind == Kind::kFault) ++singular_open_;
  if (is_fine(task.box) || kind == Kind::kTolerance || kind == Kind::kNoMotion || extent_ == Extent::kToFirstFailure) {
    report(task, SurveyedBox::Kind::kOpen, std::move(step));
    return;
  }
  // There may be violations next to what can't be decided, but climbing the ladder will not help.
  Task hopeless = task;
  hopeless.is_hopeless = true;
  split(hopeless, 0);
}

}  // namespace taut
