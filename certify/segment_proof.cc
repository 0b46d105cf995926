#include "certify/segment_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kinematics/input_error.h"

namespace taut {
namespace {

constexpr mpfr_prec_t kRangePrecision = 256;

}  // namespace

Prover::Prover(const Problem& problem, ProofOptions options)
    : problem_(problem),
      options_(std::move(options)),
      fast_(make_proof_model(problem)),
      fine_(options_.ladder_bits.size()) {
  const PrecisionScope precision(kRangePrecision);
  for (const Parameter& parameter : problem_.space.parameters) {
    constexpr double kEverything = std::numeric_limits<double>::infinity();
    if (parameter.kind == ParameterKind::kRange) {
      Faults<MpInterval>::clear();
      const double lowest = upper_bound(evaluate_constant<MpInterval>(parameter.range_lower));
      const double highest = lower_bound(evaluate_constant<MpInterval>(parameter.range_upper));
      if (Faults<MpInterval>::raised()) {
        throw InputError("space.parameters." + parameter.name + ": got a range whose ends are not defined");
      }
      ranges_.push_back({lowest, highest});
    } else {
      ranges_.push_back({-kEverything, kEverything});
    }
  }
}

const ProofModel<MpInterval>& Prover::fine(std::size_t k) const {
  Rung& rung = fine_[k];
  std::call_once(rung.made, [&] {
    const PrecisionScope precision(options_.ladder_bits[k]);
    rung.model.emplace(make_mp_proof_model(problem_));
  });
  return *rung.model;
}

bool Prover::certainly_in_ranges(const Waypoint& waypoint) const {
  if (waypoint.x.size() != ranges_.size() || waypoint.half_turns.size() != ranges_.size()) return false;
  for (std::size_t j = 0; j < ranges_.size(); ++j) {
    if (!std::isfinite(waypoint.x[j]) || !(ranges_[j][0] <= waypoint.x[j] && waypoint.x[j] <= ranges_[j][1]))
      return false;
    if (waypoint.half_turns[j] != 0 && problem_.space.parameters[j].kind != ParameterKind::kPeriodic) return false;
  }
  return true;
}

BoxVerdict Prover::judge_at(std::size_t rung, const Waypoint& a, const Waypoint& b, const DyadicBox& box,
                            double clearance) const {
  if (rung == 0) return judge_box(fast_, a, b, box, clearance);
  const PrecisionScope precision(options_.ladder_bits[rung - 1]);
  return judge_box(fine(rung - 1), a, b, box, clearance);
}

BoxVerdict Prover::judge(const Waypoint& a, const Waypoint& b, const DyadicBox& box) const {
  BoxVerdict verdict;
  for (std::size_t rung = 0; rung <= fine_.size(); ++rung) {
    verdict = judge_at(rung, a, b, box, 0);
    if (verdict.kind == BoxVerdict::Kind::kProved || verdict.kind == BoxVerdict::Kind::kRefuted) break;
  }
  return verdict;
}

SegmentProof Prover::prove(const Waypoint& a, const Waypoint& b, double clearance) const {
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

  if (!certainly_in_ranges(a) || !certainly_in_ranges(b)) {
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
    const BoxVerdict verdict = judge_at(rung, a, b, box, clearance);

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
      case Kind::kNearSingular:
      case Kind::kFault:
        if (box.depth < options_.singular_depth) {
          split();
        } else if (higher_rung) {
          climb();
        } else if (verdict.kind == Kind::kNearSingular && box.depth == options_.singular_depth) {
          const PrecisionScope precision(options_.ladder_bits.back());
          const int sign_lower = determinant_sign(fine(fine_.size() - 1), a, b, box.lower());
          const int sign_upper = determinant_sign(fine(fine_.size() - 1), a, b, box.upper());
          if (sign_lower * sign_upper < 0) {
            proof.verdict = Verdict::kRefuted;
            proof.witness = SegmentWitness{true, {}, box};
            return proof;
          }
          split();
        } else if (may_split && box.depth < 2 * options_.singular_depth) {
          split();
        } else {
          give_up(box, verdict.kind == Kind::kFault ? "the pose or an equation is not defined on all of the box"
                                                    : "the force Jacobian is singular or nearly so");
          return proof;
        }
        break;
    }
  }
  proof.verdict = Verdict::kProved;
  return proof;
}

MpInterval Prover::quantity_at_mid(const Waypoint& a, const Waypoint& b, const DyadicBox& box, MarginId margin) const {
  const PrecisionScope precision(options_.ladder_bits.back());
  Faults<MpInterval>::clear();
  const BoxEnclosure<MpInterval> enclosure = enclose_box(fine(fine_.size() - 1), a, b, box);
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
