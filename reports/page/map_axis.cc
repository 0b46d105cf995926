// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/map_axis.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "problem/expression.h"
#include "reports/summary/numbers.h"
#include "reports/summary/scene.h"

namespace taut {

const char* axis_kind_name(MapAxis::Kind kind) {
  switch (kind) {
    case MapAxis::Kind::kRange: return "range";
    case MapAxis::Kind::kTurn: return "turn";
    case MapAxis::Kind::kTilt: break;
  }
  return "tilt";
}

const char* cell_kind_name(CellKind kind) {
  switch (kind) {
    case CellKind::kInside: return "inside";
    case CellKind::kLength: return "length";
    case CellKind::kTension: return "tension";
    case CellKind::kUnbalanced: return "unbalanced";
    case CellKind::kContact: return "contact";
    case CellKind::kUndecided: break;
  }
  return "undecided";
}

std::vector<ShownAxis> shown_axes(const SpaceText& text, const MapSpace& space, const DisplayUnits& units) {
  std::vector<ShownAxis> result;
  for (std::size_t k = 0; k < space.size(); ++k) {
    const MapAxis& axis = space.axes[k];
    const double lower = evaluate_constant<double>(axis.lower), upper = evaluate_constant<double>(axis.upper);
    const std::string si = unit(text, k);
    if (si == "m") {
      result.push_back({axis.name, units.length.name(), units.length.approx(lower), units.length.approx(upper),
                        units.length.approx(1)});
    } else if (si == "rad" && units.in_degrees) {
      result.push_back({axis.name, "deg", degrees(lower), degrees(upper), degrees(1)});
    } else {
      result.push_back({axis.name, si, lower, upper, 1});
    }
  }
  return result;
}

std::string value_text(const ShownAxis& axis, double value) {
  return fmt::format("{:.5g}{}{}", value + 0.0, axis.unit.empty() ? "" : " ", axis.unit);
}

std::string volume_unit(const std::vector<ShownAxis>& axes) {
  constexpr std::array<const char*, 4> kPowers = {"", "", "²", "³"};
  std::vector<std::pair<std::string, std::size_t>> times;
  for (const ShownAxis& axis : axes) {
    if (axis.unit.empty()) continue;
    if (times.empty() || times.back().first != axis.unit) times.emplace_back(axis.unit, 0);
    ++times.back().second;
  }
  std::string result;
  for (const auto& [unit, count] : times) result += (result.empty() ? "" : "·") + unit + kPowers.at(count);
  return result;
}

double whole_volume(const std::vector<ShownAxis>& axes) {
  double result = 1;
  for (const ShownAxis& axis : axes) result *= axis.upper - axis.lower;
  return result;
}

}  // namespace taut
