// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/gravest.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

namespace taut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Statics<double> statics_at(const PoseSampler& sampler, const Segment& segment, const Dyadic& s) {
  return sampler.statics(sampler.rigid_pose(segment, s.approx()));
}

/// The width between the two limits of what `margin` limits.
double width(const Model<double>& model, MarginId margin) {
  const auto i = static_cast<std::size_t>(margin.cable);
  const bool is_tension = margin.kind == MarginKind::kTensionMin || margin.kind == MarginKind::kTensionMax;
  return is_tension ? model.tension_upper[i] - model.tension_lower[i] : model.length_upper[i] - model.length_lower[i];
}

/// The limit that a pose breaks most, or nearly.
void worsen(const Model<double>& model, const Statics<double>& statics, const Dyadic& s,
            std::optional<SuspectedViolation>& worst) {
  for (const MarginId margin : all_margins()) {
    const bool is_length = margin.kind == MarginKind::kLengthMin || margin.kind == MarginKind::kLengthMax;
    if (!is_length && !statics.regular) continue;
    const double severity = -slack(model, limited_quantity(statics, margin), margin) / width(model, margin);
    if (!(severity > (worst ? worst->severity : -kInfinity))) continue;  // nor where the pose is undefined
    worst = SuspectedViolation{false, margin, s, s, s, severity};
  }
}

/// Multiples of a power of two within [begin, end], about `count` of them, and both ends.
std::vector<Dyadic> grid(const Dyadic& begin, const Dyadic& end, int count) {
  using boost::multiprecision::cpp_int;
  const int depth = std::max(begin.depth, end.depth);
  const cpp_int from = begin.k << (depth - begin.depth);
  const cpp_int to = end.k << (depth - end.depth);
  // The step is the greatest power of two of which `count` fit between the ends, or a part of 2^-depth.
  const cpp_int steps = (to - from) / count;
  const int coarser = steps > 0 ? static_cast<int>(msb(steps)) : 0;
  const int finer = steps > 0 ? 0 : static_cast<int>(std::bit_width(static_cast<unsigned>(count)));
  const cpp_int step = cpp_int(1) << coarser;
  const cpp_int first = from << finer;
  const cpp_int last = to << finer;
  std::vector<Dyadic> result = {begin};
  for (cpp_int k = (first / step + 1) * step; k < last; k += step) {
    result.push_back({k >> coarser, depth + finer - coarser});
  }
  if (begin != end) result.push_back(end);
  return result;
}

Dyadic middle(const Dyadic& a, const Dyadic& b) {
  const int depth = std::max(a.depth, b.depth);
  return {(a.k << (depth - a.depth)) + (b.k << (depth - b.depth)), depth + 1};
}

SuspectedViolation narrowed_sign_change(const PoseSampler& sampler, const Segment& segment, SuspectedViolation found) {
  constexpr double kNarrow = 0x1p-20;
  const Statics<double> before = statics_at(sampler, segment, found.from);
  while (found.to.approx() - found.from.approx() > kNarrow) {
    const Dyadic mid = middle(found.from, found.to);
    const Statics<double> there = statics_at(sampler, segment, mid);
    if (!there.regular || there.determinant == 0) break;
    ((there.determinant > 0) == (before.determinant > 0) ? found.from : found.to) = mid;
  }
  found.at = found.from;
  return found;
}

}  // namespace

std::optional<SuspectedViolation> worst_margin(const PoseSampler& sampler, const Segment& segment, const Dyadic& s) {
  std::optional<SuspectedViolation> worst;
  worsen(sampler.model(), statics_at(sampler, segment, s), s, worst);
  return worst;
}

SampledViolations sample_violations(const PoseSampler& sampler, const Segment& segment, const Dyadic& begin,
                                    const Dyadic& end, int count) {
  SampledViolations result;
  const std::vector<Dyadic> places = grid(begin, end, count);
  std::optional<std::size_t> last_regular;
  bool was_positive = false;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Statics<double> statics = statics_at(sampler, segment, places[i]);
    worsen(sampler.model(), statics, places[i], result.worst);
    if (result.worst && result.worst->at == places[i]) worst = i;
    if (!statics.regular) continue;
    const bool is_positive = statics.determinant > 0;
    if (!result.singular && last_regular && is_positive != was_positive) {
      result.singular = SuspectedViolation{true, {}, places[*last_regular], places[*last_regular], places[i], 0};
    }
    was_positive = is_positive;
    last_regular = i;
  }
  if (result.worst) {
    result.worst->from = places[worst == 0 ? 0 : worst - 1];
    result.worst->to = places[std::min(worst + 1, places.size() - 1)];
  }
  return result;
}

std::optional<SuspectedContact> deepest_contact(const PoseSampler& sampler, const BodySampler& bodies,
                                                const Segment& segment, std::size_t pair, const Dyadic& begin,
                                                const Dyadic& end, int count) {
  std::optional<SuspectedContact> result;
  for (const Dyadic& s : grid(begin, end, count)) {
    const double gap = bodies.gap(sampler.model(), sampler.rigid_pose(segment, s.approx()), pair);
    if (gap < (result ? result->gap : 0)) result = SuspectedContact{pair, s, gap};
  }
  return result;
}

SuspectedViolation narrowed(const PoseSampler& sampler, const Segment& segment, const SuspectedViolation& suspected) {
  constexpr int kRounds = 2;
  constexpr int kPlaces = 16;
  if (suspected.singular) return narrowed_sign_change(sampler, segment, suspected);
  SuspectedViolation result = suspected;
  for (int round = 0; round < kRounds; ++round) {
    if (result.from == result.to) break;
    const auto closer = sample_violations(sampler, segment, result.from, result.to, kPlaces).worst;
    if (!closer || !(closer->severity > result.severity)) break;
    result = *closer;
  }
  return result;
}

}  // namespace taut
