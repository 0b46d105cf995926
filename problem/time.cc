// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/time.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "problem/expression.h"
#include "problem/rows.h"

namespace taut {
namespace {

using nlohmann::json;

using Limit = TimeText::Limit;
using WinchLimits = std::array<Limit, kCables>;

/// A member of TimeText, its key in JSON, and its place in a case.
template <class T>
struct Member {
  const char* key;
  const char* place;
  T TimeText::*member;
};

constexpr std::array<Member<Limit>, 4> kOfLoad = {{
    {"load_acceleration_m_s2", "time.load.acceleration", &TimeText::load_acceleration_m_s2},
    {"load_angular_acceleration_rad_s2", "time.load.angular_acceleration", &TimeText::load_angular_acceleration_rad_s2},
    {"load_angular_speed_rad_s", "time.load.angular_speed", &TimeText::load_angular_speed_rad_s},
    {"load_speed_m_s", "time.load.speed", &TimeText::load_speed_m_s},
}};
constexpr std::array<Member<WinchLimits>, 3> kOfWinches = {{
    {"winch_acceleration_m_s2", "time.winches.acceleration", &TimeText::winch_acceleration_m_s2},
    {"winch_power_W", "time.winches.power", &TimeText::winch_power_W},
    {"winch_speed_m_s", "time.winches.speed", &TimeText::winch_speed_m_s},
}};

constexpr const char* kStoppingTime = "stopping_time_s";
constexpr const char* kRows = "rows";

bool has_limit(const WinchLimits& limits) {
  return std::ranges::any_of(limits, [](const Limit& limit) { return limit.has_value(); });
}

void validate_limit(const std::string& where, const ExpressionText& limit) {
  double value = 0;
  try {
    value = evaluate_constant<double>(limit);
  } catch (const InputError& error) {
    throw FieldError(where, "", error.what());
  }
  if (!(value >= kLeastRateLimit && value <= kGreatestRateLimit)) {
    throw FieldError(where, "'" + excerpt(limit) + "'",
                     fmt::format("expected a limit above zero: from {:.0e} to {:.0e} in SI units and radians",
                                 kLeastRateLimit, kGreatestRateLimit));
  }
}

}  // namespace

void validate(const TimeText& time) {
  bool is_limited = false;
  for (const auto& [key, place, member] : kOfLoad) {
    const Limit& limit = time.*member;
    if (limit) validate_limit(place, *limit);
    is_limited |= limit.has_value();
  }
  for (const auto& [key, place, member] : kOfWinches) {
    const WinchLimits& limits = time.*member;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      if (limits[i]) validate_limit(fmt::format("{}[{}]", place, i), *limits[i]);
    }
    is_limited |= has_limit(limits);
  }
  if (time.stopping_time_s) validate_limit("time.may_stop", *time.stopping_time_s);
  if (time.rows) validate_rows(time);
  if (!is_limited) throw FieldError("time", "no limit", "expected at least one, of the winches or of the load");
}

json to_json(const TimeText& time) {
  json result = json::object();
  for (const auto& [key, place, member] : kOfLoad) {
    if (const Limit& limit = time.*member) result[key] = *limit;
  }
  for (const auto& [key, place, member] : kOfWinches) {
    const WinchLimits& limits = time.*member;
    if (!has_limit(limits)) continue;
    json& list = result[key] = json::array();
    for (const Limit& limit : limits) list.push_back(limit ? json(*limit) : json());
  }
  if (time.stopping_time_s) result[kStoppingTime] = *time.stopping_time_s;
  if (time.rows) result[kRows] = {{"error_m", time.rows->error_m}, {"step_s", time.rows->step_s}};
  return result;
}

TimeText time_from_json(const JsonCursor& value) {
  std::vector<std::string> keys;
  const auto is_stated = [&](const char* key) {
    if (!value.contains(key)) return false;
    keys.emplace_back(key);
    return true;
  };
  TimeText time;
  for (const auto& [key, place, member] : kOfLoad) {
    if (is_stated(key)) time.*member = value.at(key).text();
  }
  for (const auto& [key, place, member] : kOfWinches) {
    if (!is_stated(key)) continue;
    WinchLimits& limits = time.*member;
    const std::vector<JsonCursor> entries = value.at(key).elements(kCables);
    for (std::size_t i = 0; i < kCables; ++i) {
      if (!entries[i].is_null()) limits[i] = entries[i].text();
    }
    if (!has_limit(limits)) value.at(key).fail("a limit of at least one cable");
  }
  const bool is_limited = !keys.empty();
  if (is_stated(kStoppingTime)) time.stopping_time_s = value.at(kStoppingTime).text();
  if (is_stated(kRows)) {
    const JsonCursor rows = value.at(kRows);
    rows.expect_keys({"error_m", "step_s"});
    RowsText& text = time.rows.emplace();
    text.step_s = rows.at("step_s").text();
    const std::vector<JsonCursor> errors = rows.at("error_m").elements(kCables);
    for (std::size_t i = 0; i < kCables; ++i) text.error_m[i] = errors[i].text();
  }
  value.expect_keys(keys);
  if (!is_limited) value.fail("at least one limit");
  return time;
}

}  // namespace taut
