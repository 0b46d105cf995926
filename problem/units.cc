// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace taut {
namespace {

const std::vector<Unit>& units() {
  static const std::vector<Unit> all = [] {
    const auto d = [](const char* text) { return Decimal::parse(text); };
    std::vector<Unit> list = {
        {Dimension::kLength, "m", d("1")},
        {Dimension::kLength, "mm", d("1e-3")},
        {Dimension::kLength, "cm", d("1e-2")},
        {Dimension::kLength, "km", d("1e3")},
        {Dimension::kLength, "in", d("0.0254")},
        {Dimension::kLength, "ft", d("0.3048")},
        {Dimension::kForce, "N", d("1")},
        {Dimension::kForce, "mN", d("1e-3")},
        {Dimension::kForce, "kN", d("1e3")},
        {Dimension::kForce, "MN", d("1e6")},
        {Dimension::kMass, "kg", d("1")},
        {Dimension::kMass, "g", d("1e-3")},
        {Dimension::kMass, "t", d("1e3")},
        {Dimension::kAngle, "rad", d("1")},
        {Dimension::kAngle, "deg", d("1"), true},
        {Dimension::kTime, "s", d("1")},
        {Dimension::kTime, "ms", d("1e-3")},
        {Dimension::kTime, "min", d("60")},
        {Dimension::kTime, "h", d("3600")},
        {Dimension::kAcceleration, "m/s^2", d("1")},
        {Dimension::kAcceleration, "cm/s^2", d("1e-2")},
        {Dimension::kAcceleration, "mm/s^2", d("1e-3")},
        {Dimension::kArea, "m^2", d("1")},
        {Dimension::kArea, "cm^2", d("1e-4")},
        {Dimension::kArea, "mm^2", d("1e-6")},
        {Dimension::kSpeed, "m/s", d("1")},
        {Dimension::kSpeed, "cm/s", d("1e-2")},
        {Dimension::kSpeed, "mm/s", d("1e-3")},
        {Dimension::kSpeed, "km/h", d("1e3"), false, 3600},
        {Dimension::kSpeed, "m/min", d("1"), false, 60},
        {Dimension::kDensity, "kg/m^3", d("1")},
        {Dimension::kJerk, "m/s^3", d("1")},
        {Dimension::kJerk, "cm/s^3", d("1e-2")},
        {Dimension::kJerk, "mm/s^3", d("1e-3")},
        {Dimension::kPower, "W", d("1")},
        {Dimension::kPower, "mW", d("1e-3")},
        {Dimension::kPower, "kW", d("1e3")},
        {Dimension::kPower, "MW", d("1e6")},
        {Dimension::kFrequency, "Hz", d("1")},
        {Dimension::kFrequency, "kHz", d("1e3")},
        {Dimension::kAngularSpeed, "rad/s", d("1")},
        {Dimension::kAngularSpeed, "deg/s", d("1"), true},
        {Dimension::kAngularAcceleration, "rad/s^2", d("1")},
        {Dimension::kAngularAcceleration, "deg/s^2", d("1"), true},
        {Dimension::kInertia, "kg*m^2", d("1")},
        {Dimension::kInertia, "t*m^2", d("1e3")},
        {Dimension::kInertia, "kg*cm^2", d("1e-4")},
        {Dimension::kInertia, "kg*mm^2", d("1e-6")},
        {Dimension::kInertia, "g*cm^2", d("1e-7")},
        {Dimension::kInertia, "g*mm^2", d("1e-9")},
    };
    // Moments have no units with inches or feet: E divides by the moment's unit, and 1/0.0254 is no decimal.
    std::vector<Unit> moments;
    for (const Unit& force : list) {
      for (const Unit& length : list) {
        if (force.dimension != Dimension::kForce || length.dimension != Dimension::kLength) continue;
        if (length.name == "in" || length.name == "ft") continue;
        moments.push_back({Dimension::kMoment, force.name + "*" + length.name, force.factor * length.factor});
      }
    }
    list.insert(list.end(), moments.begin(), moments.end());
    return list;
  }();
  return all;
}

}  // namespace

const char* dimension_name(Dimension dimension) {
  switch (dimension) {
    case Dimension::kLength: return "length";
    case Dimension::kForce: return "force";
    case Dimension::kMoment: return "moment";
    case Dimension::kMass: return "mass";
    case Dimension::kAngle: return "angle";
    case Dimension::kTime: return "time";
    case Dimension::kAcceleration: return "acceleration";
    case Dimension::kArea: return "area";
    case Dimension::kSpeed: return "speed";
    case Dimension::kDensity: return "density";
    case Dimension::kJerk: return "jerk";
    case Dimension::kPower: return "power";
    case Dimension::kFrequency: return "frequency";
    case Dimension::kAngularSpeed: return "angular speed";
    case Dimension::kAngularAcceleration: return "angular acceleration";
    case Dimension::kInertia: return "moment of inertia";
  }
  return "";
}

std::string unit_names(Dimension dimension) {
  std::string names;
  for (const Unit& unit : units()) {
    if (unit.dimension == dimension) names += (names.empty() ? "" : ", ") + unit.name;
  }
  return names;
}

std::optional<Unit> find_unit(std::string_view name) {
  const auto found = std::find_if(units().begin(), units().end(), [&](const Unit& unit) { return unit.name == name; });
  return found == units().end() ? std::nullopt : std::optional(*found);
}

Unit si_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::kLength: return *find_unit("m");
    case Dimension::kForce: return *find_unit("N");
    case Dimension::kMoment: return *find_unit("N*m");
    case Dimension::kMass: return *find_unit("kg");
    case Dimension::kAngle: return *find_unit("rad");
    case Dimension::kTime: return *find_unit("s");
    case Dimension::kAcceleration: return *find_unit("m/s^2");
    case Dimension::kArea: return *find_unit("m^2");
    case Dimension::kSpeed: return *find_unit("m/s");
    case Dimension::kDensity: return *find_unit("kg/m^3");
    case Dimension::kJerk: return *find_unit("m/s^3");
    case Dimension::kPower: return *find_unit("W");
    case Dimension::kFrequency: return *find_unit("Hz");
    case Dimension::kAngularSpeed: return *find_unit("rad/s");
    case Dimension::kAngularAcceleration: return *find_unit("rad/s^2");
    case Dimension::kInertia: break;
  }
  return *find_unit("kg*m^2");
}

std::pair<std::string, std::optional<Unit>> split_unit(const std::string& text) {
  const auto may_end_value = [](std::string_view value) {
    if (value.ends_with(' ') || value.ends_with(')')) return true;
    return !value.empty() && value.find_first_not_of("0123456789.eE+-") == std::string_view::npos;
  };
  const Unit* longest = nullptr;
  for (const Unit& unit : units()) {
    const std::size_t size = unit.name.size();
    if (text.size() <= size || !text.ends_with(unit.name)) continue;
    if (!may_end_value(std::string_view(text).substr(0, text.size() - size))) continue;
    // After an operator a name is an operand: t in "1.5 + t" is a parameter, not tonnes.
    const std::size_t before = text.find_last_not_of(" \t", text.size() - size - 1);
    if (before == std::string::npos || std::string_view("+-*/^(,").find(text[before]) != std::string_view::npos)
      continue;
    if (!longest || size > longest->name.size()) longest = &unit;
  }
  if (!longest) return {text, std::nullopt};
  std::string value = text.substr(0, text.size() - longest->name.size());
  while (value.ends_with(' ')) value.pop_back();
  return {value, *longest};
}

std::string decimal_to_si(const std::string& text, const Unit& unit) {
  const Decimal value = Decimal::parse(text) * unit.factor;
  return unit.is_degree && value.sign() != 0 ? fmt::format("({})*pi/180", value.text()) : value.text();
}

std::string expression_to_si(const std::string& text, const Unit& unit) {
  if (unit.is_degree) return fmt::format("({})*pi/180", text);
  const std::string factor = unit.factor.text();
  return factor == "1" ? text : fmt::format("({})*{}", text, factor);
}

std::string expression_from_si(const std::string& text, const Unit& unit) {
  if (unit.factor.text() == "1") return text;
  if (unit.factor.is_power_of_ten()) {
    return fmt::format("({}*{})", unit.factor.reciprocal_of_power_of_ten().text(), text);
  }
  return fmt::format("({}/{})", text, unit.factor.text());
}

}  // namespace taut
