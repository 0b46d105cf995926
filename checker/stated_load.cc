// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/stated_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "checker/format/exact.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;

/// A part of the problem alone, or null: the rest of a certificate may take gigabytes.
Json part_of(const std::string& certificate, const char* key) {
  const auto keep = [key](int depth, Json::parse_event_t event, Json& parsed) {
    if (event != Json::parse_event_t::key) return true;
    return depth == 1 ? parsed == "problem" : depth == 2 ? parsed == key : true;
  };
  return Json::parse(certificate, keep).at("problem").value(key, Json());
}

/// Of a decimal or "a/b" that the reader has accepted, rounded to 6 digits, in any locale.
std::string number(const Json& text) {
  return fmt::format("{:.6g}", parse_rational(text.get<std::string>()).value().get_d());
}

std::string vector(const Json& list, std::size_t first = 0) {
  return fmt::format("({}, {}, {})", number(list.at(first)), number(list.at(first + 1)), number(list.at(first + 2)));
}

std::string range(const Json& ends, const char* unit) {
  const std::string lower = number(ends.at(0)), upper = number(ends.at(1));
  return lower == upper ? fmt::format("{} {}", lower, unit) : fmt::format("{} to {} {}", lower, upper, unit);
}

std::string vectors(const Json& set, const char* unit) {
  std::string text;
  if (set.contains("ball")) {
    text = fmt::format("up to {} {} in any direction", number(set["ball"].at("radius")), unit);
  } else if (set.contains("disc")) {
    text = fmt::format("up to {} {} at right angles to {}", number(set["disc"].at("radius")), unit,
                       vector(set["disc"].at("normal")));
  } else {
    text =
        fmt::format("{} along {}", range(set.at("segment").at("range"), unit), vector(set["segment"].at("direction")));
  }
  if (set.at("axes") == "P") text += " of the platform's axes";
  if (set.contains("at_m")) text += fmt::format(" at {} m", vector(set["at_m"]));
  return text;
}

std::string item_text(const Json& item) {
  if (item.contains("force")) return vectors(item["force"], "N");
  if (item.contains("moment")) return vectors(item["moment"], "N m");
  if (item.contains("load_cases")) {
    const Json& cases = item["load_cases"];
    return fmt::format("one of {} wrenches at {} m", cases.at("wrenches").size(), vector(cases.at("at_m")));
  }
  const Json& weight = item.at("weight");
  std::string text = fmt::format("{} at {} m", range(weight.at("mass_kg"), "kg"), vector(weight.at("at_m")));
  if (number(weight.at("at_tolerance_m")) != "0") {
    text += fmt::format(" within {} m", number(weight["at_tolerance_m"]));
  }
  if (weight.contains("inertia_box_m")) {
    const Json& box = weight["inertia_box_m"];
    text += fmt::format(", in a box of {} x {} x {} m", number(box.at(0)), number(box.at(1)), number(box.at(2)));
  }
  return text;
}

}  // namespace

std::string stated_load(const std::string& certificate) {
  const Json load = part_of(certificate, "load");
  std::string text;
  for (const Json& item : load.value("items", Json::array())) {
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", item.at("name").dump(-1, ' ', true), item_text(item));
  }
  if (load.contains("ellipsoid")) {
    const std::string name =
        load.contains("ellipsoid_name") ? " " + load["ellipsoid_name"].dump(-1, ' ', true) + "," : "";
    text += fmt::format("{}an ellipsoid{} around {} N and {} N m about {} m", text.empty() ? "" : "; and ", name,
                        vector(load.at("wrench")), vector(load["wrench"], 3), vector(load.at("point_m")));
  }
  if (load.contains("items")) text += fmt::format("; under {} m/s^2", vector(load.at("gravity_m_s2")));
  if (load.contains("items") || load.contains("ellipsoid_name")) text += ". Names are not checked";
  return "load: " + text;
}

std::string stated_time(const std::string& certificate) {
  struct Limit {
    const char *key, *what, *unit;
  };
  static constexpr std::array<Limit, 7> kLimits = {
      {{"winch_speed_m_s", "winch speed", "m/s"},
       {"winch_acceleration_m_s2", "winch acceleration", "m/s^2"},
       {"winch_power_W", "winch power", "W"},
       {"load_speed_m_s", "speed of the load point", "m/s"},
       {"load_acceleration_m_s2", "acceleration of the load point", "m/s^2"},
       {"load_angular_speed_rad_s", "angular speed", "rad/s"},
       {"load_angular_acceleration_rad_s2", "angular acceleration", "rad/s^2"}}};
  const auto text_of = [](const Json& limit) { return limit.is_null() ? "no limit" : limit.get<std::string>(); };
  const Json time = part_of(certificate, "time");
  std::string text;
  for (const auto& [key, what, unit] : kLimits) {
    if (!time.contains(key)) continue;
    const Json& limit = time[key];
    std::string value;
    if (limit.is_array() && std::ranges::any_of(limit, [&](const Json& one) { return one != limit[0]; })) {
      for (const Json& one : limit) value += (value.empty() ? "(" : ", ") + text_of(one);
      value += ")";
    } else {
      value = text_of(limit.is_array() ? limit[0] : limit);
    }
    text += fmt::format("{}{} below {} {}", text.empty() ? "limits in time: " : "; ", what, value, unit);
  }
  if (time.contains("stopping_time_s")) {
    text += fmt::format("; may be stopped in {} s or more", time["stopping_time_s"].get<std::string>());
  }
  if (time.contains("rows")) {
    const Json& rows = time["rows"];
    std::string errors;
    for (const Json& error : rows["error_m"]) errors += (errors.empty() ? "" : ", ") + error.get<std::string>();
    text +=
        fmt::format("; lengths run straight between rows of a table {} s apart at most, and are off by ({}) m at most",
                    rows["step_s"].get<std::string>(), errors);
  }
  return text;
}

}  // namespace taut::checker
