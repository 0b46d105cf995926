// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/cable_use.h"

#include <limits>

#include "reports/summary/hints.h"

namespace taut {

namespace {

constexpr double kFar = std::numeric_limits<double>::max();

std::array<Use, kCables> empty_uses(const std::array<Limits, kCables>& limits) {
  std::array<Use, kCables> uses;
  for (std::size_t i = 0; i < kCables; ++i) {
    uses[i].range = {kFar, -kFar};
    uses[i].lower_limit = ScalarTraits<double>::from_decimal(limits[i].lower);
    uses[i].upper_limit = ScalarTraits<double>::from_decimal(limits[i].upper);
  }
  return uses;
}

void widen(Use& use, const Range& range, double position) {
  if (range.lower < use.range.lower) {
    use.range.lower = range.lower;
    use.least_at = position;
  }
  if (range.upper > use.range.upper) {
    use.range.upper = range.upper;
    use.greatest_at = position;
  }
}

bool add_proved(const ReportContext& scene, CableUse& use) {
  bool is_any = false;
  for (std::size_t k = 0; k < scene.ranges.segments.size(); ++k) {
    for (const BoxRanges& box : scene.ranges.segments[k]) {
      const double position = static_cast<double>(k) + box.box.mid().approx();
      for (std::size_t i = 0; i < kCables; ++i) {
        widen(use.tension[i], box.tension[i], position);
        widen(use.length[i], box.length[i], position);
      }
      is_any = true;
    }
  }
  return is_any;
}

bool add_samples(const ReportContext& scene, CableUse& use) {
  bool is_any = false;
  for (const PathSample& sample : scene.samples) {
    if (is_nearly_singular(scene.sampler.model(), sample.statics)) continue;
    for (std::size_t i = 0; i < kCables; ++i) {
      const double tension = sample.statics.tension[i];
      const double length = sample.statics.length[i];
      widen(use.tension[i], {tension - sample.statics.tension_below[i], tension + sample.statics.tension_above[i]},
            sample.position);
      widen(use.length[i], {length, length}, sample.position);
    }
    is_any = true;
  }
  return is_any;
}

}  // namespace

CableUse cable_use(const ReportContext& scene) {
  const RobotText& robot = scene.certificate.problem.robot;
  CableUse use{CableUse::Source::kNone, empty_uses(robot.tension_N), empty_uses(robot.length_m)};
  if (add_proved(scene, use)) {
    use.source = scene.ranges_are_whole ? CableUse::Source::kProved : CableUse::Source::kProvedParts;
  } else if (!found_no_path(scene.certificate) && add_samples(scene, use)) {
    use.source = CableUse::Source::kSamples;
  }
  return use;
}

ClosestUse closest(const std::array<Use, kCables>& uses) {
  ClosestUse result;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kCables; ++i) {
    const Use& use = uses[i];
    const double width = use.upper_limit - use.lower_limit;
    for (const bool is_upper : {false, true}) {
      const double share = (is_upper ? use.upper_limit - use.range.upper : use.range.lower - use.lower_limit) / width;
      if (!(share < least)) continue;
      least = share;
      result = {static_cast<int>(i), is_upper, is_upper ? use.upper_limit : use.lower_limit,
                is_upper ? use.range.upper : use.range.lower, is_upper ? use.greatest_at : use.least_at};
    }
  }
  return result;
}

}  // namespace taut
