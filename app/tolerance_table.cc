// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/tolerance_table.h"

#include <fmt/format.h>

#include <cmath>

namespace taut {
namespace {

constexpr int kDigits = 3;

const char* unit(ToleranceKind kind) {
  switch (kind) {
    case ToleranceKind::kLoad: return "N, N m";
    case ToleranceKind::kOrientation: return "rad";
    default: return "m";
  }
}

/// The units that people read.
struct Shown {
  std::string unit;
  double factor;  ///< from SI
};

Shown shown(ToleranceKind kind, const DisplayUnits& units) {
  constexpr double kDegrees = 57.295779513082320;  // 180/π, to within an ulp
  switch (kind) {
    case ToleranceKind::kLoad: return {unit(kind), 1};
    case ToleranceKind::kOrientation: return {units.in_degrees ? "deg" : "rad", units.in_degrees ? kDegrees : 1};
    default: return {units.length.name(), units.length.approx(1)};
  }
}

/// Rounded towards 0: what is less than what was proved is proved.
std::string below(double x) {
  if (!(x > 0)) return "0";
  const double scale = std::pow(10.0, kDigits - 1 - std::floor(std::log10(x)));
  double digits = std::floor(x * scale);
  while (digits / scale > x) --digits;
  return fmt::format("{:.{}g}", digits / scale, kDigits);
}

}  // namespace

std::string tolerance_table(const std::vector<ToleranceLimit>& limits, const DisplayUnits& units) {
  if (limits.empty()) return "";
  std::string lines = "Tolerances, and how far each could grow alone with the path still proved:\n";
  for (const ToleranceLimit& limit : limits) {
    constexpr double kBelow = 1 - 1e-15;  // for the rounding of the factor and of the products
    const auto [unit, factor] = shown(limit.kind, units);
    lines += fmt::format("  {:<17} {:>10.4g}  up to {:>8} {}\n", name(limit.kind), factor * limit.stated,
                         below(kBelow * factor * limit.proved), unit);
  }
  return lines;
}

nlohmann::json to_json(const std::vector<ToleranceLimit>& limits) {
  nlohmann::json list = nlohmann::json::array();
  for (const ToleranceLimit& limit : limits) {
    list.push_back({{"tolerance", name(limit.kind)},
                    {"stated", fmt::format("{}", limit.stated)},
                    {"proved", below(limit.proved)},
                    {"unit", unit(limit.kind)}});
  }
  return list;
}

}  // namespace taut
