// SPDX-License-Identifier: GPL-3.0-or-later
// The units in which results are shown to people: those of the case. JSON and certificates are in SI.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "problem/problem.h"
#include "problem/units.h"

namespace taut {

/// A unit of length, force or moment that is a power of ten of SI's, so that every decimal is shown exactly.
class DisplayUnit {
 public:
  /// @param unit  one that is no power of ten of SI's, such as a foot, is replaced by `otherwise`.
  DisplayUnit(const Unit& unit, const char* otherwise);

  [[nodiscard]] const std::string& name() const { return name_; }  ///< "mm", "kN·m"
  /// An SI value in this unit, exactly; without the unit's name.
  [[nodiscard]] std::string exact(const DecimalText& si) const;
  /// `digits` significant digits of an SI value in this unit, rounded towards −∞ or +∞.
  [[nodiscard]] std::string down(double si, int digits = 4) const;
  [[nodiscard]] std::string up(double si, int digits = 4) const;
  /// The same rounded to nearest.
  [[nodiscard]] std::string nearest(double si, int digits = 4) const;
  /// An SI value in this unit, rounded to nearest: for text that claims nothing.
  [[nodiscard]] double approx(double si) const;
  /// The same with as many decimals as `decimals` decimals in SI are: 6 decimals of metres are 3 of millimetres.
  [[nodiscard]] std::string fixed(double si, int decimals) const;
  /// A unit of the same size with more behind its name: "mm/s".
  [[nodiscard]] DisplayUnit with(const std::string& more) const;

 private:
  std::string name_;
  Decimal per_si_;
};

struct DisplayUnits {
  DisplayUnits()
      : DisplayUnits(CaseUnits{.length = *find_unit("mm"), .angle = *find_unit("deg")}) {}  ///< mm, N, N·m, degrees
  explicit DisplayUnits(const CaseUnits& units);

  DisplayUnit length;
  DisplayUnit force;
  DisplayUnit moment;
  bool in_degrees;  ///< angles; else in radians

  [[nodiscard]] const DisplayUnit& of(bool is_length) const { return is_length ? length : force; }
  /// "3.04 rad" or "174 deg": rounded.
  [[nodiscard]] std::string angle(double radians) const;
};

/// The units as a certificate's `illustration` has them, so that its report shows what the case used.
[[nodiscard]] nlohmann::json to_json(const CaseUnits& units);
/// Reads them. A unit that is missing, unknown or of another kind is taken as DisplayUnits() has it.
[[nodiscard]] DisplayUnits display_units_from_json(const nlohmann::json& units);

}  // namespace taut
