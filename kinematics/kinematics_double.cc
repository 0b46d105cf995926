// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "kinematics/statics.h"

namespace taut {

double wrench_scale_approx(const Model<double>& model, const Statics<double>& statics) {
  if (!statics.regular) return -std::numeric_limits<double>::infinity();
  double scale = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kCables; ++i) {
    scale = std::min({scale, (statics.tension[i] - model.tension_lower[i]) / statics.tension_below[i],
                      (model.tension_upper[i] - statics.tension[i]) / statics.tension_above[i]});
  }
  return scale;
}

}  // namespace taut
