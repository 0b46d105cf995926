// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/precision_ladder.h"

#include <algorithm>

namespace taut {
namespace {

std::vector<mpfr_prec_t> bits_of_rungs(mpfr_prec_t max_bits) {
  constexpr mpfr_prec_t kFirst = 128;
  std::vector<mpfr_prec_t> bits = {kFirst};
  while (bits.back() < max_bits) bits.push_back(std::min(2 * bits.back(), max_bits));
  return bits;
}

}  // namespace

PrecisionLadder::PrecisionLadder(const Problem& problem, mpfr_prec_t max_bits, const std::optional<Slowing>& slowing)
    : problem_(problem),
      slowing_(slowing),
      fast_(make_proof_model(problem, slowing)),
      bits_(bits_of_rungs(max_bits)),
      fine_(bits_.size()) {}

int PrecisionLadder::deepest(std::size_t rung) const {
  constexpr int kBinary64Depth = 48;
  return rung == 0 ? kBinary64Depth : static_cast<int>(std::min<mpfr_prec_t>(bits(rung), DyadicBox::kMaxDepth));
}

const ProofModel<MpInterval>& PrecisionLadder::multiprecision(std::size_t rung) const {
  Rung& fine = fine_.at(rung - 1);
  std::call_once(fine.made, [&] {
    const PrecisionScope precision(bits(rung));
    fine.model = std::make_unique<const ProofModel<MpInterval>>(make_mp_proof_model(problem_, slowing_));
  });
  return *fine.model;
}

BoxVerdict PrecisionLadder::judge(std::size_t rung, const Segment& segment, const DyadicBox& box, double clearance,
                                  int continuation_steps, const PairDirections* directions,
                                  const ClearPoses* clear) const {
  if (rung == 0) return judge_box(fast_, segment, box, clearance, continuation_steps, directions, clear);
  const PrecisionScope precision(bits(rung));
  return judge_box(multiprecision(rung), segment, box, clearance, continuation_steps, directions);
}

Contact PrecisionLadder::judge_contact(std::size_t rung, const Segment& segment, const DyadicBox& box,
                                       const PairContact& found) const {
  if (rung == 0) return taut::judge_contact(fast_, segment, box, found);
  const PrecisionScope precision(bits(rung));
  return taut::judge_contact(multiprecision(rung), segment, box, found);
}

}  // namespace taut
