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
