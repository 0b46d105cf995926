// SPDX-License-Identifier: GPL-3.0-or-later
// Deviations within tolerances: random ones, and those that are worst to first order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tests/soundness/trial.h"

namespace taut::campaign {

inline constexpr double kWithin = 1 - 1e-12;  ///< so that rounding leaves no ball

inline void scale_to(std::span<double> block, double size) {
  double square = 0;
  for (const double c : block) square += c * c;
  if (!(square > 0) || !std::isfinite(square)) return;
  for (double& c : block) c *= size * kWithin / std::sqrt(square);
}

/// Mostly corners: every block on its sphere.
inline Deviation random_deviation(Random& random) {
  Deviation x;
  if (one_in(random, 8)) return x;
  const bool is_corner = !one_in(random, 4);
  for_each_block(x, [&](std::span<double> block) {
    for (double& c : block) c = uniform(random, -1, 1);
    scale_to(block, is_corner ? 1 : uniform(random, 0, 1));
  });
  return x;
}

/// Of the blocks of a deviation, in their order, those whose tolerance is not 0.
inline std::vector<bool> blocks_that_matter(const Tolerances<double>& t) {
  std::vector<bool> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    for (const double tolerance : {t.a[i], t.b[i], t.length[i]}) result.push_back(tolerance != 0);
  }
  for (const double tolerance : {t.load_point, t.position, t.turn}) result.push_back(tolerance != 0);
  result.push_back(std::ranges::any_of(t.wrench, [](double w) { return w != 0; }));
  return result;
}

/// Of each of N `values` the corner that makes it least, to first order around x: differences over whole balls, as
/// tolerances are small.
template <std::size_t N, class F>
std::array<Deviation, N> worst_deviations(const Deviation& x, const std::vector<bool>& matters, F values) {
  constexpr double kStep = 0.5;
  Deviation at = x;
  std::array<Deviation, N> worst;
  worst.fill(x);
  std::array<std::vector<std::span<double>>, N> blocks;
  for (std::size_t n = 0; n < N; ++n) {
    for_each_block(worst[n], [&](std::span<double> block) { blocks[n].push_back(block); });
  }
  std::size_t next = 0;
  for_each_block(at, [&](std::span<double> block) {
    const std::size_t b = next++;
    std::array<std::array<double, 3>, N> slopes{};
    for (std::size_t k = 0; k < block.size() && matters[b]; ++k) {
      const double kept = block[k];
      block[k] = kept + kStep;
      const std::array<double, N> above = values(at);
      block[k] = kept - kStep;
      const std::array<double, N> below = values(at);
      block[k] = kept;
      for (std::size_t n = 0; n < N; ++n) {
        const double slope = above[n] - below[n];
        slopes[n][k] = std::isfinite(slope) ? slope : 0;
      }
    }
    for (std::size_t n = 0; n < N; ++n) {
      const std::span<double> direction = blocks[n][b];
      for (std::size_t k = 0; k < block.size(); ++k) direction[k] = -slopes[n][k];
      scale_to(direction, 1);
    }
  });
  return worst;
}

}  // namespace taut::campaign
