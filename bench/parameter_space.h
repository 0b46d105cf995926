// SPDX-License-Identifier: GPL-3.0-or-later
// A case's parameters as a state space of OMPL.
#pragma once

#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "problem/expression.h"
#include "problem/problem.h"

namespace taut {

/// Of real parameters without a range: theta, which may pass through 0 to either side; both goals are reachable.
inline constexpr double kThetaBound = 2.2;

inline double wrap(double angle) {
  return angle - 2.0 * std::numbers::pi * std::round(angle / (2.0 * std::numbers::pi));
}

/// The box of the parameters with its periodic sides glued; Euclidean distance, as taut's `parameters`.
class ParameterSpace final : public ompl::base::RealVectorStateSpace {
 public:
  explicit ParameterSpace(const SpaceText& space)
      : ompl::base::RealVectorStateSpace(static_cast<unsigned>(space.parameters.size())) {
    for (std::size_t j = 0; j < space.parameters.size(); ++j) {
      const Parameter& parameter = space.parameters[j];
      periodic_.push_back(parameter.kind == ParameterKind::kPeriodic);
      double low = -std::numbers::pi;
      double high = std::numbers::pi;
      if (parameter.kind == ParameterKind::kRange) {
        low = evaluate_constant<double>(parameter.range_lower);
        high = evaluate_constant<double>(parameter.range_upper);
      } else if (!periodic_.back()) {
        low = -kThetaBound;
        high = kThetaBound;
      }
      bounds_.setLow(static_cast<unsigned>(j), low);
      bounds_.setHigh(static_cast<unsigned>(j), high);
    }
  }

  [[nodiscard]] double step(std::size_t j, double from, double to) const {
    return periodic_[j] ? wrap(to - from) : to - from;
  }
  [[nodiscard]] std::span<const double> point(const ompl::base::State* state) const {
    return {state->as<StateType>()->values, dimension_};
  }

  /// The image of `state` that is nearest to `from`.
  [[nodiscard]] std::vector<double> nearest(const std::vector<double>& from, const ompl::base::State* state) const {
    std::vector<double> q = from;
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += step(j, from[j], point(state)[j]);
    return q;
  }

  double distance(const ompl::base::State* a, const ompl::base::State* b) const override {
    double square = 0;
    for (std::size_t j = 0; j < dimension_; ++j) {
      const double d = step(j, point(a)[j], point(b)[j]);
      square += d * d;
    }
    return std::sqrt(square);
  }
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override {
    double* values = state->as<StateType>()->values;
    for (std::size_t j = 0; j < dimension_; ++j) {
      const double start = point(from)[j];
      const double value = start + t * step(j, start, point(to)[j]);
      values[j] = periodic_[j] ? wrap(value) : value;
    }
  }
  double getMaximumExtent() const override {
    double square = 0;
    for (std::size_t j = 0; j < dimension_; ++j) {
      const double side = (bounds_.high[j] - bounds_.low[j]) * (periodic_[j] ? 0.5 : 1.0);
      square += side * side;
    }
    return std::sqrt(square);
  }
  double getMeasure() const override {
    double product = 1;
    for (std::size_t j = 0; j < dimension_; ++j) product *= bounds_.high[j] - bounds_.low[j];
    return product;
  }

 private:
  std::vector<bool> periodic_;
};

}  // namespace taut
