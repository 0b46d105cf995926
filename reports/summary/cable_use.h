// SPDX-License-Identifier: GPL-3.0-or-later
// The use of each cable in a move: the least and greatest tension and length, and how close they come to the limits.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "reports/summary/scene.h"

namespace taut {

/// The range of one quantity of one cable over the move.
struct Use {
  Range range;             ///< [N] or [m]
  double lower_limit = 0;  ///< rounded to nearest; the certificate has it exactly
  double upper_limit = 0;  ///< likewise
  double least_at = 0;     ///< position of `range.lower`, counted in segments (PathSample::position)
  double greatest_at = 0;  ///< position of `range.upper`
  /// The sampled values there, in floating point. Many pieces of a path may share one bound, as their ranges are cut at
  /// a margin or loose: then the place is the piece whose sample comes nearest to it.
  double least_seen = 0;
  double greatest_seen = 0;

  /// Utilisation: the greatest value as a fraction of the upper limit [1], and in percent. Rounded up, so that it is
  /// never below the utilisation with the exact limit.
  [[nodiscard]] double used() const { return not_below(range.upper / upper_limit); }
  [[nodiscard]] double used_percent() const { return not_below(100 * (range.upper / upper_limit)); }

 private:
  /// Covers the roundings of the limit, the quotient, the product and this sum, each at most 2^-53 of the value.
  static double not_below(double x) { return x + 1e-15 * std::abs(x); }
};

struct CableUse {
  enum class Source {
    kNone,         ///< nothing is known: there is no path, or its samples contain no regular pose
    kSamples,      ///< floating-point samples, which prove nothing
    kProvedParts,  ///< proved for the parts of the path that the certificate proves
    kProved,       ///< proved for the whole path
  };
  Source source = Source::kNone;
  std::array<Use, kCables> tension;
  std::array<Use, kCables> length;
};

/// What is proved where anything is, else of samples.
[[nodiscard]] CableUse cable_use(const ReportContext& scene);
/// Of samples of the whole path; nothing for laws of implied poses, whose samples may not be poses of the motion.
[[nodiscard]] CableUse sampled_use(const ReportContext& scene);

}  // namespace taut
