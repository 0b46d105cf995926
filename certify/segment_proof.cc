#include "certify/segment_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kinematics/input_error.h"

namespace taut {

Prover::Prover(const Problem& problem, ProofOptions options)
    : problem_(problem),
      options_(std::move(options)),
      fast_(make_proof_model(problem)),
      fine_(options_.ladder_bits.size()) {
  if (!problem.space.constraints.empty()) constraints_.emplace(problem);
}

Segment Prover::segment(const Waypoint& a, const Waypoint& b) const {
  Segment result = Segment::straight(a, b);
  if (constraints_) result.tube = suitable_tube(result);
  return result;
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
    const PrecisionScope precision(options_.ladder_bits[k]);
    rung.model.emplace(make_mp_proof_model(problem_));
  });
  return *rung.model;
}

bool Prover::may_follow(const Segment& segment) const {
  const auto is_finite = [](double x) { return std::isfinite(x); };
  return std::ranges::all_of(segment.controls(), [&](const Waypoint* waypoint) {
    if (!has_poses(segment.law)) return certainly_in_ranges(*waypoint);
    return waypoint->x.size() == pose_numbers(segment.law) && std::ranges::all_of(waypoint->x, is_finite);
  });
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

const char* undecided_reason(BoxVerdict::Kind kind) {
  switch (kind) {
    case BoxVerdict::Kind::kFault: return "the pose or an equation is not defined on all of the box";
    case BoxVerdict::Kind::kNoMotion: return "no single motion on the constraints was proved to exist there";
    default: return "the force Jacobian is singular or nearly so";
  }
}

}  // namespace

BoxVerdict Prover::judge_at(std::size_t rung, const Segment& segment, const DyadicBox& box, double clearance) const {
  if (rung == 0) return judge_box(fast_, segment, box, clearance);
  const PrecisionScope precision(options_.ladder_bits[rung - 1]);
  return judge_box(fine(rung - 1), segment, box, clearance);
}

BoxVerdict Prover::judge(const Segment& segment, const DyadicBox& box) const {
  BoxVerdict verdict;
  for (std::size_t rung = 0; rung <= fine_.size(); ++rung) {
    verdict = judge_at(rung, segment, box, 0);
    if (verdict.kind == BoxVerdict::Kind::kProved || verdict.kind == BoxVerdict::Kind::kRefuted) break;
  }
  return verdict;
}

SegmentProof Prover::prove(const Segment& segment, double clearance) const {
  using Kind = BoxVerdict::Kind;
  struct Task {
    DyadicBox box;
    std::size_t rung;
  };
  SegmentProof proof;
  proof.tension_N = proof.length_m = proof.wrench_scale = std::numeric_limits<double>::infinity();
  const auto give_up = [&](const DyadicBox& box, std::string reason) {
    proof.verdict = Verdict::kUndecided;
    proof.open_box = box;
    proof.reason = std::move(reason);
  };

  if (!may_follow(segment)) {
    give_up({}, "a waypoint lies outside the closed range of a parameter, or may");
    return proof;
  }
  std::vector<Task> stack = {{{0, 0}, 0}};
  while (!stack.empty()) {
    const DyadicBox box = stack.back().box;
    const std::size_t rung = stack.back().rung;
    stack.pop_back();
    if (rung > 0) ++proof.boxes_multiprecision;
    if (++proof.boxes_judged > options_.max_boxes || proof.boxes_multiprecision > options_.max_multiprecision_boxes) {
      give_up(box, "the budget of boxes is spent");
      return proof;
    }
    if (interrupt != nullptr && interrupt->load(std::memory_order_relaxed)) {
      give_up(box, "interrupted");
      return proof;
    }
    const BoxVerdict verdict = judge_at(rung, segment, box, clearance);

    const bool higher_rung = rung < fine_.size();
    const bool may_split = box.depth < options_.max_depth;
    const auto split = [&] {
      stack.push_back({box.right(), rung});
      stack.push_back({box.left(), rung});
    };
    const auto climb = [&] { stack.push_back({box, rung + 1}); };
    switch (verdict.kind) {
      case Kind::kProved:
        proof.boxes.push_back(box);
        proof.tension_N = std::min(proof.tension_N, verdict.tension_N);
        proof.length_m = std::min(proof.length_m, verdict.length_m);
        proof.wrench_scale = std::min(proof.wrench_scale, verdict.wrench_scale);
        break;
      case Kind::kRefuted:
        proof.verdict = Verdict::kRefuted;
        proof.witness = SegmentWitness{false, verdict.worst, box};
        return proof;
      case Kind::kTooClose: give_up(box, "closer to a limit than the clearance asked for"); return proof;
      case Kind::kSplit:
        if (!may_split) {
          give_up(box, std::string("bisection depth reached at margin ") + name(verdict.worst.kind) + " of cable " +
                           std::to_string(verdict.worst.cable + 1));
          return proof;
        }
        split();
        break;
      case Kind::kPrecision:
        if (higher_rung) {
          climb();
        } else if (may_split) {
          split();
        } else {
          give_up(box, std::string("precision reached at margin ") + name(verdict.worst.kind) + " of cable " +
                           std::to_string(verdict.worst.cable + 1) + ": it vanishes or nearly so");
          return proof;
        }
        break;
      case Kind::kOutOfRange: give_up(box, "a parameter leaves its closed range, or may"); return proof;
      case Kind::kNoMotion:
        // The tube does not shrink with the box: what still fails here seldom succeeds in smaller boxes.
        if (box.depth < options_.motion_depth) {
          split();
        } else if (higher_rung) {
          climb();
        } else {
          give_up(box, undecided_reason(verdict.kind));
          return proof;
        }
        break;
      case Kind::kNearSingular:
      case Kind::kFault:
        if (box.depth < options_.singular_depth) {
          split();
        } else if (higher_rung) {
          climb();
        } else if (verdict.kind == Kind::kNearSingular && box.depth == options_.singular_depth) {
          const PrecisionScope precision(options_.ladder_bits.back());
          const int sign_lower = determinant_sign(fine(fine_.size() - 1), segment, box.lower());
          const int sign_upper = determinant_sign(fine(fine_.size() - 1), segment, box.upper());
          if (sign_lower * sign_upper < 0) {
            proof.verdict = Verdict::kRefuted;
            proof.witness = SegmentWitness{true, {}, box};
            return proof;
          }
          split();
        } else if (may_split && box.depth < 2 * options_.singular_depth) {
          split();
        } else {
          give_up(box, undecided_reason(verdict.kind));
          return proof;
        }
        break;
    }
  }
  proof.verdict = Verdict::kProved;
  return proof;
}

MpInterval Prover::quantity_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin) const {
  const PrecisionScope precision(options_.ladder_bits.back());
  Faults<MpInterval>::clear();
  const BoxEnclosure<MpInterval> enclosure = enclose_box(fine(fine_.size() - 1), segment, box);
  if (Faults<MpInterval>::raised()) throw std::logic_error("a refuted midpoint has no enclosure");
  const auto n = static_cast<std::size_t>(margin.cable);
  const MpInterval& length = enclosure.length[n].at_mid;
  switch (margin.kind) {
    case MarginKind::kTensionMin: return length * (enclosure.density[n].at_mid - enclosure.variation[n].at_mid);
    case MarginKind::kTensionMax: return length * (enclosure.density[n].at_mid + enclosure.variation[n].at_mid);
    case MarginKind::kLengthMin:
    case MarginKind::kLengthMax: break;
  }
  return length;
}

}  // namespace taut
