// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/gaps.h"

namespace taut {
namespace {

/// The midpoint of a small box at the lower (upper) end of one that is violated throughout.
SegmentWitness at_end(const SegmentWitness& witness, bool is_upper) {
  constexpr int kEndDepth = 16;
  SegmentWitness result = witness;
  while (result.box.depth < kEndDepth) result.box = is_upper ? result.box.right() : result.box.left();
  return result;
}

}  // namespace

std::vector<Gap> gaps(const SegmentSurvey& survey) {
  using Kind = SurveyedBox::Kind;
  std::vector<Gap> result;
  bool in_gap = false;
  for (const SurveyedBox& part : survey.boxes) {
    if (part.kind == Kind::kProved) {
      in_gap = false;
      continue;
    }
    if (!in_gap) result.push_back({part.box.lower(), part.box.upper(), {}, {}, {}, part.reason});
    in_gap = true;
    Gap& gap = result.back();
    gap.end = part.box.upper();
    if (!part.witness) continue;
    const bool throughout = part.kind == Kind::kViolated;
    if (!gap.first) gap.first = throughout ? at_end(*part.witness, false) : *part.witness;
    gap.last = throughout ? at_end(*part.witness, true) : *part.witness;
    if (part.witness->singular && !gap.singular) gap.singular = part.witness;
    gap.reason = {};
  }
  return result;
}

}  // namespace taut
