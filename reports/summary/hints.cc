// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/hints.h"

#include <algorithm>
#include <cmath>

#include "reports/summary/samples.h"

namespace taut {

bool is_nearly_singular(const Model<double>& model, const Statics<double>& statics) {
  if (!statics.regular) return true;
  const double greatest = *std::ranges::max_element(model.tension_upper);
  for (std::size_t i = 0; i < kCables; ++i) {
    const double beyond = std::abs(statics.tension[i]) + std::max(statics.tension_below[i], statics.tension_above[i]);
    if (!(beyond <= kSingularTension * greatest)) return true;
  }
  return false;
}

std::string reversed_load_hint(const Model<double>& model, const Statics<double>& statics) {
  if (is_nearly_singular(model, statics)) return "";
  for (std::size_t i = 0; i < kCables; ++i) {
    const double reversed = -statics.tension[i];
    if (!(reversed > 0 && model.tension_lower[i] < reversed && reversed < model.tension_upper[i])) return "";
  }
  return "Every cable would be slack under this load, and under the opposite one every tension would be within its "
         "limits: does gravity point the wrong way, or the z axis?";
}

std::string reversed_load_hint(const Problem& problem, const Path& path) {
  const Sampler sampler(problem);
  return reversed_load_hint(sampler.model(), sampler.at(path, 0).statics);
}

}  // namespace taut
