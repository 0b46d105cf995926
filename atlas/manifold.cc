// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/manifold.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace taut {

Image CoordinateSymmetry::nearest_image(const Coordinates& base, const Coordinates& near) const {
  Image best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const bool flipped : {false, true}) {
    if (flipped && !flip) break;
    Image image;
    image.flipped = flipped;
    double distance = 0;
    for (int j = 0; j < base.size(); ++j) {
      const bool negated = flipped && j == (*flip)[1];
      const int odd = flipped && j == (*flip)[0] ? 1 : 0;
      const double gap = near[j] - (negated ? -base[j] : base[j]);
      int& half_turns = image.half_turns[j];
      if (periodic[j]) {
        half_turns = odd + 2 * static_cast<int>(std::lround((gap / std::numbers::pi - odd) / 2));
      }
      const double rest = gap - std::numbers::pi * half_turns;
      distance += rest * rest;
    }
    if (distance < best_distance) {
      best_distance = distance;
      best = image;
    }
  }
  return best;
}

Coordinates CoordinateSymmetry::apply(const Coordinates& base, const Image& image) const {
  Coordinates result = base;
  if (image.flipped) result[(*flip)[1]] = -result[(*flip)[1]];
  for (int j = 0; j < base.size(); ++j) {
    if (image.half_turns[j] != 0) result[j] += std::numbers::pi * image.half_turns[j];
  }
  return result;
}

}  // namespace taut
