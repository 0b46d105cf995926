// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/display_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "problem/decimal.h"
#include "problem/scalar.h"
#include "reports/summary/numbers.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

/// "kN·m" of "kN*m".
std::string shown_name(std::string name) {
  const std::size_t product = name.find('*');
  return product == std::string::npos ? name : name.replace(product, 1, "·");
}

}  // namespace

DisplayUnit::DisplayUnit(const Unit& unit, const char* otherwise) {
  const Unit& taken = unit.factor.is_power_of_ten() ? unit : *find_unit(otherwise);
  name_ = shown_name(taken.name);
  per_si_ = taken.factor.reciprocal_of_power_of_ten();
}

std::string DisplayUnit::exact(const DecimalText& si) const { return (Decimal::parse(si) * per_si_).text(); }

std::string DisplayUnit::down(double si, int digits) const {
  return is_absurd(si) ? rounded_down(approx(si), digits) : exact(rounded_down(si, digits));
}

std::string DisplayUnit::up(double si, int digits) const {
  return is_absurd(si) ? rounded_up(approx(si), digits) : exact(rounded_up(si, digits));
}

std::string DisplayUnit::nearest(double si, int digits) const {
  return is_absurd(si) ? rounded_to_nearest(approx(si), digits) : exact(rounded_to_nearest(si, digits));
}

double DisplayUnit::approx(double si) const { return si * ScalarTraits<double>::from_decimal(per_si_.text()); }

std::string DisplayUnit::fixed(double si, int decimals) const {
  const int shift = static_cast<int>(std::lround(std::log10(approx(1))));
  return fmt::format("{:.{}f}", approx(si) + 0.0, std::max(0, decimals - shift));
}

DisplayUnit DisplayUnit::with(const std::string& more) const {
  DisplayUnit result = *this;
  result.name_ += more;
  return result;
}

DisplayUnits::DisplayUnits(const CaseUnits& units)
    : length(units.length, "mm"),
      force(units.force, "N"),
      moment(units.moment, "N*m"),
      in_degrees(units.angle.is_degree) {}

std::string DisplayUnits::angle(double radians) const {
  return in_degrees ? fmt::format("{:.4g} deg", degrees(radians)) : fmt::format("{:.4g} rad", radians);
}

nlohmann::json to_json(const CaseUnits& units) {
  return {{"angle", units.angle.name},
          {"force", units.force.name},
          {"length", units.length.name},
          {"mass", units.mass.name},
          {"moment", units.moment.name}};
}

DisplayUnits display_units_from_json(const nlohmann::json& units) {
  CaseUnits result{.length = *find_unit("mm"), .angle = *find_unit("deg")};
  if (!units.is_object()) return DisplayUnits(result);
  for (Unit* unit : {&result.length, &result.force, &result.moment, &result.mass, &result.angle}) {
    const auto named = units.find(dimension_name(unit->dimension));
    if (named == units.end() || !named->is_string()) continue;
    const std::optional<Unit> found = find_unit(named->get_ref<const std::string&>());
    if (found && found->dimension == unit->dimension) *unit = *found;
  }
  return DisplayUnits(result);
}

}  // namespace taut
