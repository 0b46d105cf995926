// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/time.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "problem/rows.h"

namespace taut::case_fields {
namespace {

constexpr int kUsualRate_Hz = 100, kGreatestRate_Hz = 10'000;
constexpr int kMostStep_s = 1000;  ///< between two rows of which something is proved

bool is_angular(Dimension dimension) {
  return dimension == Dimension::kAngularSpeed || dimension == Dimension::kAngularAcceleration;
}

/// The unit of bare numbers: that of SI, and of angular rates in degrees where the case's angles are.
Unit bare_unit(const Units& units, Dimension dimension) {
  if (!is_angular(dimension) || !units[Dimension::kAngle].is_degree) return si_unit(dimension);
  return *find_unit(dimension == Dimension::kAngularSpeed ? "deg/s" : "deg/s^2");
}

/// Refuses a bare number where `units` has other lengths or times than this unit's: it could be meant in those.
void require_clear_unit(const Field& field, const Units& units, const Unit& bare) {
  const bool has_length = bare.dimension == Dimension::kSpeed || bare.dimension == Dimension::kAcceleration ||
                          bare.dimension == Dimension::kJerk;
  const bool is_clear = (!has_length || units[Dimension::kLength].name == "m") &&
                        (!(has_length || is_angular(bare.dimension)) || units[Dimension::kTime].name == "s");
  if (is_clear || !field.node().IsScalar() || field.node().Scalar().empty()) return;
  if (split_unit(field.node().Scalar()).second) return;
  field.fail(fmt::format("a number with its unit, one of {}, as 'units' has others", unit_names(bare.dimension)));
}

/// An exact constant in SI.
ExpressionText read_limit(const Field& field, const Units& units, Dimension dimension) {
  const Unit bare = bare_unit(units, dimension);
  require_clear_unit(field, units, bare);
  if (is_angular(dimension)) return read_expression(field, bare, {});
  return text_of(field, read_rational(field, bare));
}

std::array<TimeText::Limit, kCables> read_winch_limits(const Field& field, const Units& units, Dimension dimension) {
  std::array<TimeText::Limit, kCables> limits;
  if (field.node().IsScalar()) {
    limits.fill(read_limit(field, units, dimension));
    for (std::size_t i = 0; i < kCables; ++i) field.remember_as(fmt::format("{}[{}]", field.path(), i));
    return limits;
  }
  const std::vector<Field> entries =
      field.list(kCables, fmt::format("a limit of {}, or six of them", dimension_name(dimension)));
  for (std::size_t i = 0; i < kCables; ++i) limits[i] = read_limit(entries[i], units, dimension);
  return limits;
}

/// A map with at least one of these keys.
Map limits_map(const Field& field, const std::vector<std::string>& keys) {
  Map map = field.map(keys);
  if (map.entries().empty()) field.complain(fmt::format("got no limit, expected at least one of {}", join(keys)));
  return map;
}

void read_winches(const Field& field, const Units& units, TimeText& limits) {
  const Map map = limits_map(field, {"speed", "acceleration", "power"});
  if (const auto speed = map.find("speed")) {
    limits.winch_speed_m_s = read_winch_limits(*speed, units, Dimension::kSpeed);
  }
  if (const auto acceleration = map.find("acceleration")) {
    limits.winch_acceleration_m_s2 = read_winch_limits(*acceleration, units, Dimension::kAcceleration);
  }
  if (const auto power = map.find("power")) {
    limits.winch_power_W = read_winch_limits(*power, units, Dimension::kPower);
  }
}

void read_load_rates(const Field& field, const Units& units, TimeText& limits) {
  const Map map = limits_map(field, {"speed", "acceleration", "angular_speed", "angular_acceleration"});
  const auto read = [&](const char* key, Dimension dimension, TimeText::Limit& limit) {
    if (const auto entry = map.find(key)) limit = read_limit(*entry, units, dimension);
  };
  read("speed", Dimension::kSpeed, limits.load_speed_m_s);
  read("acceleration", Dimension::kAcceleration, limits.load_acceleration_m_s2);
  read("angular_speed", Dimension::kAngularSpeed, limits.load_angular_speed_rad_s);
  read("angular_acceleration", Dimension::kAngularAcceleration, limits.load_angular_acceleration_rad_s2);
}

double read_jerk(const Field& field, const Units& units) {
  const Unit unit = bare_unit(units, Dimension::kJerk);
  require_clear_unit(field, units, unit);
  const auto jerk = read_rational(field, unit).convert_to<double>();
  if (!(jerk >= kLeastRateLimit && jerk <= kGreatestRateLimit)) {
    field.fail(fmt::format("a jerk above zero: from {:.0e} to {:.0e} m/s^3", kLeastRateLimit, kGreatestRateLimit));
  }
  return jerk;
}

/// A time, which has to have its unit where the case has another than seconds: neighbours are in those.
ExpressionText read_stopping_time(const Field& field, const Units& units) {
  const bool is_bare = field.node().IsScalar() && !split_unit(field.node().Scalar()).second;
  if (is_bare && !field.node().Scalar().empty() && units[Dimension::kTime].name != "s") {
    field.fail(fmt::format("a number with its unit, one of {}, as 'units' has another", unit_names(Dimension::kTime)));
  }
  return text_of(field, read_rational(field, units[Dimension::kTime]));
}

Rational read_rate(const Field& field) {
  const Rational rate = read_rational(field, si_unit(Dimension::kFrequency));
  if (rate <= 0 || rate > kGreatestRate_Hz) {
    field.fail(fmt::format("a rate above zero, and at most {} Hz", kGreatestRate_Hz));
  }
  return rate;
}

/// Whether a load has an item of accelerations.
bool has_acceleration(const Field& load) {
  const YAML::Node items = load.node().IsMap() ? load.node()["items"] : YAML::Node();
  return items && items.IsSequence() &&
         std::any_of(items.begin(), items.end(), [](const YAML::Node& item) { return item["acceleration"]; });
}

/// Rows of tables with times that are rounded to binary64.
RowsText read_between_rows(const Field& field, const TimeText& limits, const Rational& rate_Hz, const Field& load) {
  constexpr const char* kExpected =
      "'straight': drives run the length of each cable straight from row to row of winches.csv";
  if (field.text(kExpected) != "straight") field.fail(kExpected);
  if (!has_acceleration(load)) {
    field.complain(
        "got no item 'acceleration' in the load, expected one: lengths that run straight from row to row change their "
        "speed at each row, and how far that accelerates the load, as the machine follows them, has to be stated");
  }
  if (rate_Hz * kMostStep_s < 1)
    field.complain(fmt::format("got it with a rate below 1/{} Hz, expected more", kMostStep_s));
  try {
    return rows_between(limits, 1 / rate_Hz + parse_rational(kRowRounding_s), {});
  } catch (const FieldError& error) {
    field.complain(fmt::format("got {}, {}", error.seen(), error.expected()));
  }
}

bool has_part_without_mass(const LoadText& load) {
  return load.ellipsoid || std::ranges::any_of(load.items, [](const LoadItem& item) {
           return std::holds_alternative<LoadCases>(item.what);
         });
}

}  // namespace

CaseTime read_time(const Field& field, const Units& units, const Field& load_of_case) {
  const Map map = field.map({"winches", "load", "jerk", "rate", "may_stop", "between_rows"});
  const auto winches = map.find("winches"), load = map.find("load");
  if (!winches && !load) field.complain("got no limit, expected at least one, under 'winches' or 'load'");
  CaseTime result;
  if (winches) read_winches(*winches, units, result.limits);
  if (load) read_load_rates(*load, units, result.limits);
  if (const auto jerk = map.find("jerk")) result.move.jerk_m_s3 = read_jerk(*jerk, units);
  if (const auto within = map.find("may_stop")) result.limits.stopping_time_s = read_stopping_time(*within, units);
  Rational rate_Hz = kUsualRate_Hz;
  if (const auto rate = map.find("rate")) rate_Hz = read_rate(*rate);
  result.move.rate_Hz = rate_Hz.convert_to<double>();
  if (const auto rows = map.find("between_rows")) {
    result.limits.rows = read_between_rows(*rows, result.limits, rate_Hz, load_of_case);
  }
  return result;
}

void check_load_in_time(const Field& time, const LoadText& load, bool around_items,
                        std::vector<std::string>& warnings) {
  if (around_items) {
    time.complain(
        "got a load with 'ellipsoid: around_items', expected the items alone: the ellipsoid around them has no mass");
  }
  const bool has_weight =
      std::ranges::any_of(load.items, [](const LoadItem& item) { return std::holds_alternative<Weight>(item.what); });
  if (!has_weight || !has_part_without_mass(load)) return;
  warnings.push_back(time.remark(
      "inertia is that of the items with a mass; what is stated as a wrench has none, and adds no inertia"));
}

}  // namespace taut::case_fields
