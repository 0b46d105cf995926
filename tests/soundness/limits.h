// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities that limits are about, and margins by these limits.
#pragma once

#include <fmt/format.h>

#include <array>
#include <utility>

#include "tests/soundness/trial.h"

namespace taut::campaign {

/// About where a function of one variable is least.
template <class F>
double golden_section(F value, double low, double high) {
  constexpr double kRatio = 0.6180339887498949;
  double s1 = high - kRatio * (high - low);
  double s2 = low + kRatio * (high - low);
  double value1 = value(s1);
  double value2 = value(s2);
  for (int k = 0; k < 40; ++k) {
    if (value1 < value2) {
      high = std::exchange(s2, s1);
      value2 = value1;
      value1 = value(s1 = high - kRatio * (high - low));
    } else {
      low = std::exchange(s1, s2);
      value1 = value2;
      value2 = value(s2 = low + kRatio * (high - low));
    }
  }
  return 0.5 * (low + high);
}

inline DecimalText decimal(const BigFloat& x) {
  char* text = nullptr;
  mpfr_asprintf(&text, "%.45Re", x.get());
  DecimalText result = text;
  mpfr_free_str(text);
  return result;
}
inline DecimalText decimal(double x) { return fmt::format("{:.6e}", x); }

inline bool is_upper(MarginKind kind) { return kind == MarginKind::kTensionMax || kind == MarginKind::kLengthMax; }
inline bool is_tension(MarginKind kind) { return kind == MarginKind::kTensionMin || kind == MarginKind::kTensionMax; }

template <class S>
S quantity(const StaticsAt<S>& at, MarginId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case MarginKind::kTensionMin: return at.tension_low[i];
    case MarginKind::kTensionMax: return at.tension_high[i];
    case MarginKind::kLengthMin:
    case MarginKind::kLengthMax: break;
  }
  return at.length[i];
}

/// One quantity alone, in 200 bits.
inline BigFloat quantity(const MachineAt<BigFloat>& at, MarginId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  if (!is_tension(id.kind)) return lengths(at.machine, at.pose)[i];
  const Range<BigFloat> range = tension_range(at.machine, at.pose, i);
  return is_upper(id.kind) ? range.high : range.low;
}

inline DecimalText& limit(Problem& problem, MarginId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  Limits& limits = is_tension(id.kind) ? problem.robot.tension_N[i] : problem.robot.length_m[i];
  return is_upper(id.kind) ? limits.upper : limits.lower;
}

inline constexpr std::array<MarginKind, 4> kKinds = {MarginKind::kTensionMin, MarginKind::kTensionMax,
                                                     MarginKind::kLengthMin, MarginKind::kLengthMax};
inline constexpr std::size_t kMargins = kKinds.size() * kCables;
inline MarginId margin_id(std::size_t k) { return {kKinds[k / kCables], static_cast<int>(k % kCables)}; }

/// Limits as numbers; margins by them.
template <class S>
struct LimitsOf {
  explicit LimitsOf(Problem problem) {
    for (std::size_t k = 0; k < kMargins; ++k)
      value[k / kCables][k % kCables] = number<S>(limit(problem, margin_id(k)));
  }
  [[nodiscard]] S margin(const S& quantity, MarginId id) const {
    const S& bound = value[static_cast<std::size_t>(id.kind)][static_cast<std::size_t>(id.cable)];
    return is_upper(id.kind) ? bound - quantity : quantity - bound;
  }
  [[nodiscard]] S margin(const StaticsAt<S>& at, MarginId id) const { return margin(quantity(at, id), id); }
  std::array<std::array<S, kCables>, 4> value;
};

}  // namespace taut::campaign
