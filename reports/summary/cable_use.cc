// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/cable_use.h"

#include <limits>

#include "reports/summary/hints.h"
#include "reports/summary/numbers.h"

namespace taut {

namespace {

constexpr double kFar = std::numeric_limits<double>::max();

std::array<Use, kCables> empty_uses(const std::array<Limits, kCables>& limits) {
  std::array<Use, kCables> uses;
  for (std::size_t i = 0; i < kCables; ++i) {
    uses[i].range = {kFar, -kFar};
    uses[i].lower_limit = nearest_double(limits[i].lower);
    uses[i].upper_limit = nearest_double(limits[i].upper);
  }
  return uses;
}

void widen(Use& use, const Range& range, double position) {
  if (range.lower < use.range.lower) {
    use.range.lower = use.least_seen = range.lower;
    use.least_at = position;
  }
  if (range.upper > use.range.upper) {
    use.range.upper = use.greatest_seen = range.upper;
    use.greatest_at = position;
  }
}

Range sampled_range(const Statics<double>& statics, std::size_t cable, bool is_length) {
  if (is_length) return {statics.length[cable], statics.length[cable]};
  const double tension = statics.tension[cable];
  return {tension - statics.tension_below[cable], tension + statics.tension_above[cable]};
}

/// Ranges of boxes are sharp to about this share of the width between limits; nearer ones are not told apart.
constexpr double kSharpness = 0.005;

/// Moves the places of a proved range to those boxes, of all whose bounds are as extreme, whose midpoints are.
class Places {
 public:
  explicit Places(Use& use) : use_(use), sharp_(kSharpness * (use.upper_limit - use.lower_limit)) {}

  [[nodiscard]] bool is_candidate(const Range& box) const { return is_low(box) || is_high(box); }

  void consider(const Range& box, const Range& sample, double position) {
    if (is_low(box) && (!has_low_ || sample.lower < use_.least_seen)) {
      has_low_ = true;
      use_.least_seen = sample.lower;
      use_.least_at = position;
    }
    if (is_high(box) && (!has_high_ || sample.upper > use_.greatest_seen)) {
      has_high_ = true;
      use_.greatest_seen = sample.upper;
      use_.greatest_at = position;
    }
  }

 private:
  [[nodiscard]] bool is_low(const Range& box) const { return box.lower <= use_.range.lower + sharp_; }
  [[nodiscard]] bool is_high(const Range& box) const { return box.upper >= use_.range.upper - sharp_; }

  Use& use_;
  double sharp_;
  bool has_low_ = false, has_high_ = false;
};

/// A box's place is its midpoint.
double position_of(std::size_t segment, const BoxRanges& box) {
  return static_cast<double>(segment) + box.box.mid().approx();
}

void locate(const ReportContext& scene, std::array<Use, kCables>& uses, bool is_length) {
  std::vector<Places> places(uses.begin(), uses.end());
  for (std::size_t k = 0; k < scene.ranges.segments.size(); ++k) {
    for (const BoxRanges& box : scene.ranges.segments[k]) {
      const std::array<Range, kCables>& ranges = is_length ? box.length : box.tension;
      std::optional<PathSample> sample;
      for (std::size_t i = 0; i < kCables; ++i) {
        if (!places[i].is_candidate(ranges[i])) continue;
        if (!sample) sample = scene.sampler.at(scene.certificate.path, position_of(k, box));
        if (!is_length && !sample->statics.regular) continue;
        places[i].consider(ranges[i], sampled_range(sample->statics, i, is_length), sample->position);
      }
    }
  }
}

bool add_proved(const ReportContext& scene, CableUse& use) {
  bool is_any = false;
  for (std::size_t k = 0; k < scene.ranges.segments.size(); ++k) {
    for (const BoxRanges& box : scene.ranges.segments[k]) {
      const double position = position_of(k, box);
      for (std::size_t i = 0; i < kCables; ++i) {
        widen(use.tension[i], box.tension[i], position);
        widen(use.length[i], box.length[i], position);
      }
      is_any = true;
    }
  }
  locate(scene, use.tension, false);
  locate(scene, use.length, true);
  return is_any;
}

bool add_samples(const ReportContext& scene, CableUse& use) {
  bool is_any = false;
  for (const PathSample& sample : scene.samples) {
    if (is_nearly_singular(scene.sampler.model(), sample.statics)) continue;
    for (std::size_t i = 0; i < kCables; ++i) {
      widen(use.tension[i], sampled_range(sample.statics, i, false), sample.position);
      widen(use.length[i], sampled_range(sample.statics, i, true), sample.position);
    }
    is_any = true;
  }
  return is_any;
}

CableUse empty_use(const ReportContext& scene) {
  const RobotText& robot = scene.certificate.problem.robot;
  return {CableUse::Source::kNone, empty_uses(robot.tension_N), empty_uses(robot.length_m)};
}

}  // namespace

CableUse cable_use(const ReportContext& scene) {
  CableUse use = empty_use(scene);
  if (!add_proved(scene, use)) return sampled_use(scene);
  use.source = scene.ranges_are_whole ? CableUse::Source::kProved : CableUse::Source::kProvedParts;
  return use;
}

CableUse sampled_use(const ReportContext& scene) {
  CableUse use = empty_use(scene);
  const bool is_implied = scene.certificate.path.interpolation == Interpolation::kCableLengths;
  if (!is_implied && !found_no_path(scene.certificate) && add_samples(scene, use)) {
    use.source = CableUse::Source::kSamples;
  }
  return use;
}

}  // namespace taut
