// SPDX-License-Identifier: GPL-3.0-or-later
// How the platform moves along its path, in binary64, whatever law joins the waypoints. Nothing here is proved.
#pragma once

#include <optional>

#include "kinematics/path_rates.h"
#include "kinematics/pose_sampler.h"

namespace taut {

class RatesSampler {
 public:
  /// @throws InputError if the problem has no model in doubles.
  explicit RatesSampler(const Problem& problem);

  /// The pose and its derivatives by s at a point of a segment. Where no pose is found that equations imply, the
  /// reference stands in for it.
  [[nodiscard]] PathRates<double> at(const Segment& segment, double s) const;

 private:
  /// In a space with constraints.
  [[nodiscard]] PathRates<double> on_constraints(const Segment& segment, double s) const;
  [[nodiscard]] PathRates<double> along_geodesic(const Segment& segment, double s) const;
  [[nodiscard]] PathRates<double> of_lengths(const Segment& segment, double s) const;

  PoseSampler poses_;
  PathRatesModel<double, 2> rates_;
  struct Constraints {
    Evaluator<Jet<double, kMaxConstrainedParameters>> gradients;
    Evaluator<Taylor<double, 2>> derivatives;
  };
  std::optional<Constraints> constraints_;
};

}  // namespace taut
