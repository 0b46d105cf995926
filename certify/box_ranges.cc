#include "certify/box_ranges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>

namespace taut {
namespace {

template <class I>
Range outward(const I& x) {
  return {lower_bound(x), upper_bound(x)};
}

/// How far a centred form may exceed the function that it encloses, about.
template <class I>
double excess(const Centered<I>& x, double radius) {
  return radius * (upper_bound(x.slope) - lower_bound(x.slope));
}

template <class I>
std::optional<BoxRanges> enclose(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& box) {
  const BoxEnclosure<I> enclosure = enclose_box(problem, segment, box);
  const bool is_known = enclosure.motion == MotionEnclosure<I>::Status::kKnown && enclosure.regular;
  if (!is_known || (problem.tolerance && !enclosure.disturbance)) return std::nullopt;
  const Model<I>& model = problem.model;
  BoxRanges ranges;
  ranges.box = box;
  const double radius = box.radius();
  for (std::size_t i = 0; i < kCables; ++i) {
    const Centered<I>& length = enclosure.length[i];
    Centered<I> low = length * (enclosure.density[i] - enclosure.variation[i]);
    Centered<I> high = length * (enclosure.density[i] + enclosure.variation[i]);
    low.tighten(enclosure.offset);
    high.tighten(enclosure.offset);
    I length_range = length.range;
    if (enclosure.disturbance) {
      const auto& [change_low, change_high] = enclosure.disturbance->tension[i];
      low.range = low.range + Scalars<I>::symmetric(change_low);
      high.range = high.range + Scalars<I>::symmetric(change_high);
      length_range = length_range + Scalars<I>::symmetric(enclosure.disturbance->length[i]);
    }
    ranges.tension[i] = {lower_bound(low.range), upper_bound(high.range)};
    ranges.length[i] = outward(length_range);
    const double tension_width = upper_bound(model.tension_upper[i]) - lower_bound(model.tension_lower[i]);
    const double length_width = upper_bound(model.length_upper[i]) - lower_bound(model.length_lower[i]);
    ranges.excess = std::max({ranges.excess, excess(low, radius) / tension_width, excess(high, radius) / tension_width,
                              excess(length, radius) / length_width});
  }
  return ranges;
}

/// A problem in binary64 and, made when first needed, in more bits: some boxes need them.
class RangeFinder {
 public:
  explicit RangeFinder(const Prover& prover) : prover_(prover) {}

  [[nodiscard]] std::optional<BoxRanges> operator()(const Segment& segment, const DyadicBox& box) {
    if (auto ranges = enclose_ranges(prover_.model(), segment, box)) return ranges;
    for (std::size_t k = 0; k < kBits.size(); ++k) {
      const PrecisionScope precision(kBits[k]);
      std::call_once(made_[k], [&] { fine_[k].emplace(make_mp_proof_model(prover_.problem())); });
      if (auto ranges = enclose_ranges(*fine_[k], segment, box)) return ranges;
    }
    return std::nullopt;
  }

 private:
  static constexpr std::array<mpfr_prec_t, 2> kBits = {256, 1024};
  const Prover& prover_;
  std::array<std::once_flag, kBits.size()> made_;
  std::array<std::optional<ProofModel<MpInterval>>, kBits.size()> fine_;
};

/// Appends pieces that cover the box; nothing, and false, where that can't be had.
bool append(RangeFinder& find, const Segment& segment, const DyadicBox& box, const RangeOptions& options, int halvings,
            std::vector<BoxRanges>& result) {
  std::optional<BoxRanges> ranges = find(segment, box);
  const bool is_last = halvings == options.most_halvings;
  if (!is_last && !(ranges && ranges->excess <= options.excess)) {
    const std::size_t before = result.size();
    if (append(find, segment, box.left(), options, halvings + 1, result) &&
        append(find, segment, box.right(), options, halvings + 1, result)) {
      return true;
    }
    result.resize(before);
  }
  if (!ranges) return false;
  result.push_back(std::move(*ranges));
  return true;
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
  RangeFinder find(prover);
  PathRanges result;
  result.segments.resize(std::min(boxes.size(), path.segments()));
  std::atomic<std::size_t> missing = 0;
  tbb::parallel_for(std::size_t{0}, result.segments.size(), [&](std::size_t k) {
    const Segment segment = path.segment(k);
    for (const DyadicBox& box : boxes[k]) {
      if (!append(find, segment, box, options, 0, result.segments[k])) ++missing;
    }
  });
  result.missing = missing;
  return result;
}

}  // namespace taut
