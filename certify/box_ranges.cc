// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/box_ranges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>

namespace taut {
namespace {

/// How far a centred form may exceed the function that it encloses, about.
template <class I>
double excess(const SlopeForm<I>& x, double radius) {
  return radius * (upper_bound(x.slope) - lower_bound(x.slope));
}

template <class I>
bool is_known(const ProofModel<I>& problem, const BoxEnclosure<I>& enclosure) {
  return enclosure.motion == MotionEnclosure<I>::Status::kKnown && enclosure.regular &&
         (!problem.tolerance || enclosure.disturbance);
}

template <class I>
BoxRanges ranges_of(const Model<I>& model, const BoxEnclosure<I>& enclosure, const DyadicBox& box) {
  BoxRanges ranges;
  ranges.box = box;
  const double radius = box.radius();
  for (std::size_t i = 0; i < kCables; ++i) {
    I low = enclosure.low[i].range;
    I high = enclosure.high[i].range;
    I length = enclosure.length[i].range;
    if (enclosure.disturbance) {
      const auto& [change_low, change_high] = enclosure.disturbance->tension[i];
      low = low + ProofScalarTraits<I>::symmetric(change_low);
      high = high + ProofScalarTraits<I>::symmetric(change_high);
      length = length + ProofScalarTraits<I>::symmetric(enclosure.disturbance->length[i]);
    }
    ranges.tension[i] = {lower_bound(low), upper_bound(high)};
    ranges.length[i] = {lower_bound(length), upper_bound(length)};
    const double tension_width = upper_bound(model.tension_upper[i]) - lower_bound(model.tension_lower[i]);
    const double length_width = upper_bound(model.length_upper[i]) - lower_bound(model.length_lower[i]);
    ranges.excess = std::max({ranges.excess, excess(enclosure.low[i], radius) / tension_width,
                              excess(enclosure.high[i], radius) / tension_width,
                              excess(enclosure.length[i], radius) / length_width});
  }
  return ranges;
}

/// With as many continuation steps as it takes to show what was proved.
template <class I>
std::optional<BoxRanges> enclose(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& box) {
  BoxEnclosure<I> enclosure = enclose_box(problem, segment, box);
  if (problem.tolerance && !(is_known(problem, enclosure) && enclosure.margins.are_positive())) {
    BoxEnclosure<I> tighter = enclose_box(problem, segment, box, kMostContinuationSteps);
    if (is_known(problem, tighter)) enclosure = std::move(tighter);
  }
  if (!is_known(problem, enclosure)) return std::nullopt;
  return ranges_of(problem.model, enclosure, box);
}

/// Where not even a box's half or quarter can be enclosed, smaller ones are not tried: what a false certificate claims
/// would take for ever.
constexpr int kMostFailures = 2;

/// Appends pieces that cover the box; nothing, and false, where that can't be had.
template <class I>
bool append(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& box, const RangeOptions& options,
            int halvings, int failures, std::vector<BoxRanges>& result) {
  std::optional<BoxRanges> ranges = enclose_ranges(problem, segment, box);
  if (!ranges) ++failures;
  const bool is_last = halvings == options.most_halvings || failures > kMostFailures;
  if (!is_last && !(ranges && ranges->excess <= options.excess)) {
    const std::size_t before = result.size();
    if (append(problem, segment, box.left(), options, halvings + 1, failures, result) &&
        append(problem, segment, box.right(), options, halvings + 1, failures, result)) {
      return true;
    }
    result.resize(before);
  }
  if (!ranges) return false;
  result.push_back(std::move(*ranges));
  return true;
}

/// A box that binary64 can't enclose.
struct Hard {
  std::size_t segment = 0;
  std::size_t box = 0;
  std::vector<BoxRanges> pieces;  ///< found with more bits
};

/// With more bits: few boxes of a right certificate need them.
void enclose_hard(const Prover& prover, const Path& path, const std::vector<std::vector<DyadicBox>>& boxes,
                  const RangeOptions& options, std::vector<Hard>& hard) {
  for (const mpfr_prec_t bits : {mpfr_prec_t{256}, mpfr_prec_t{1024}}) {
    if (std::ranges::all_of(hard, [](const Hard& h) { return !h.pieces.empty(); })) return;
    const PrecisionScope made_with(bits);
    const ProofModel<MpInterval> model = make_mp_proof_model(prover.problem());
    tbb::parallel_for(std::size_t{0}, hard.size(), [&](std::size_t k) {
      const PrecisionScope precision(bits);
      Hard& h = hard[k];
      if (!h.pieces.empty()) return;
      append(model, path.segment(h.segment), boxes[h.segment][h.box], options, 0, kMostFailures, h.pieces);
    });
  }
}

}  // namespace

std::optional<BoxRanges> enclose_ranges(const ProofModel<Interval>& problem, const Segment& segment,
                                        const DyadicBox& box) {
  std::optional<BoxRanges> ranges;
  if (!run_upward([&] { ranges = enclose(problem, segment, box); })) return std::nullopt;
  return ranges;
}

std::optional<BoxRanges> enclose_ranges(const ProofModel<MpInterval>& problem, const Segment& segment,
                                        const DyadicBox& box) {
  Faults<MpInterval>::clear();
  std::optional<BoxRanges> ranges = enclose(problem, segment, box);
  if (Faults<MpInterval>::raised()) return std::nullopt;
  return ranges;
}

PathRanges path_ranges(const Prover& prover, const Path& path, const std::vector<std::vector<DyadicBox>>& boxes,
                       const RangeOptions& options) {
  const std::size_t segments = std::min(boxes.size(), path.segments());
  // Pieces of each box.
  std::vector<std::vector<std::vector<BoxRanges>>> found(segments);
  tbb::parallel_for(std::size_t{0}, segments, [&](std::size_t k) {
    const Segment segment = path.segment(k);
    found[k].resize(boxes[k].size());
    for (std::size_t b = 0; b < boxes[k].size(); ++b) {
      append(prover.model(), segment, boxes[k][b], options, 0, 0, found[k][b]);
    }
  });
  // The first of those that are hard, whatever thread found them.
  std::vector<Hard> hard;
  for (std::size_t k = 0; k < segments; ++k) {
    for (std::size_t b = 0; b < boxes[k].size() && hard.size() < options.most_hard; ++b) {
      if (found[k][b].empty()) hard.push_back({k, b, {}});
    }
  }
  enclose_hard(prover, path, boxes, options, hard);
  for (Hard& h : hard) found[h.segment][h.box] = std::move(h.pieces);

  PathRanges result;
  result.segments.resize(segments);
  for (std::size_t k = 0; k < segments; ++k) {
    for (std::vector<BoxRanges>& pieces : found[k]) {
      if (pieces.empty()) ++result.missing;
      std::ranges::move(pieces, std::back_inserter(result.segments[k]));
    }
  }
  return result;
}

}  // namespace taut
