#include "certify/stretches.h"

#include <algorithm>
#include <utility>

namespace taut {
namespace {

PathPoint place(int segment, Dyadic s) {
  PathPoint result;
  result.on_segment = true;
  result.index = segment;
  result.s = std::move(s);
  return result;
}

/// The midpoint of a small box at the lower (upper) end of one that is violated throughout.
SegmentWitness at_end(const SegmentWitness& witness, bool is_upper) {
  constexpr int kEndDepth = 16;
  SegmentWitness result = witness;
  while (result.box.depth < kEndDepth) result.box = is_upper ? result.box.right() : result.box.left();
  return result;
}

}  // namespace

std::vector<Stretch> StretchFinder::add(const SegmentSurvey& survey) {
  using Kind = SurveyedBox::Kind;
  std::vector<Stretch> ended;
  for (const SurveyedBox& part : survey.boxes) {
    if (part.kind == Kind::kProved) {
      if (current_) ended.push_back(*std::exchange(current_, std::nullopt));
      continue;
    }
    has_stretches_ = true;
    if (!current_) {
      current_.emplace();
      current_->begin = place(segments_, part.box.lower());
      current_->reason = part.reason;
    }
    current_->end = place(segments_, part.box.upper());
    if (!part.witness) continue;
    is_refuted_ = true;
    const bool throughout = part.kind == Kind::kViolated;
    if (!current_->first) current_->first = {segments_, throughout ? at_end(*part.witness, false) : *part.witness};
    current_->last = {segments_, throughout ? at_end(*part.witness, true) : *part.witness};
    current_->reason.clear();
  }
  tension_N_ = std::min(tension_N_, survey.tension_N);
  length_m_ = std::min(length_m_, survey.length_m);
  wrench_scale_ = std::min(wrench_scale_, survey.wrench_scale);
  ++segments_;
  return ended;
}

std::optional<Stretch> StretchFinder::finish() { return std::exchange(current_, std::nullopt); }

Verdict StretchFinder::verdict() const {
  if (is_refuted_) return Verdict::kRefuted;
  return has_stretches_ || segments_ == 0 ? Verdict::kUndecided : Verdict::kProved;
}

}  // namespace taut
