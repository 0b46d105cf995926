// SPDX-License-Identifier: GPL-3.0-or-later
// Units of a case file, as exact factors to SI.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "problem/decimal.h"

namespace taut {

/// Those up to kTime have a unit in `units:`; bare numbers of the others are in SI.
enum class Dimension {
  kLength,
  kForce,
  kMoment,
  kMass,
  kAngle,
  kTime,
  kAcceleration,
  kArea,
  kSpeed,
  kDensity,
  kJerk,
  kPower,
  kFrequency,
  kAngularSpeed,
  kAngularAcceleration,
  kInertia
};
/// The number of dimensions that have a unit in `units:`.
inline constexpr std::size_t kDimensionsOfUnits = 6;

/// A unit of known dimension: value in SI = value · factor / divisor, except that a degree is pi/180. All units but
/// some of speeds have the divisor 1.
struct Unit {
  Dimension dimension;
  std::string name;
  Decimal factor;
  bool is_degree = false;  ///< deg, deg/s, deg/s^2
  int divisor = 1;
};

/// "length", "force", …: for the first ones, the keys of `units:`.
[[nodiscard]] const char* dimension_name(Dimension dimension);
/// The names of all units of this dimension, for messages: "m, mm, cm, …".
[[nodiscard]] std::string unit_names(Dimension dimension);

[[nodiscard]] std::optional<Unit> find_unit(std::string_view name);
/// m, N, N*m, kg, rad, s, m/s^2, m^2, m/s, kg/m^3, m/s^3, W, Hz, rad/s, rad/s^2, kg*m^2.
[[nodiscard]] Unit si_unit(Dimension dimension);

/// The units of numbers that a case states without one, in which results are shown as well.
struct CaseUnits {
  Unit length = si_unit(Dimension::kLength);
  Unit force = si_unit(Dimension::kForce);
  Unit moment = si_unit(Dimension::kMoment);
  Unit mass = si_unit(Dimension::kMass);
  Unit angle = si_unit(Dimension::kAngle);
};

/// "34 deg" → {"34", degree}; the text itself and nothing if it doesn't end in a unit that follows a space, a closing
/// parenthesis or a number.
[[nodiscard]] std::pair<std::string, std::optional<Unit>> split_unit(const std::string& text);

/// Converts a decimal from `unit` (divisor 1) to SI: canonical text, or "(34)*pi/180" for degrees. @throws InputError
[[nodiscard]] std::string decimal_to_si(const std::string& text, const Unit& unit);
/// Converts an expression from `unit` to SI: "(x)*0.001"; the text itself if the factor is one. @pre the divisor
/// is 1
[[nodiscard]] std::string expression_to_si(const std::string& text, const Unit& unit);
/// Converts an SI expression to `unit`: "(1000*px)", "(px/0.0254)". @pre the text is a name or in parentheses, and the
/// unit is not degrees and has the divisor 1.
[[nodiscard]] std::string expression_from_si(const std::string& text, const Unit& unit);

}  // namespace taut
