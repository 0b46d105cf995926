// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/stated_load.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "checker/format/exact.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;

/// problem.load alone: the rest of a certificate may take gigabytes.
Json load_of(const std::string& certificate) {
  const auto keep = [](int depth, Json::parse_event_t event, Json& parsed) {
    if (event != Json::parse_event_t::key) return true;
    return depth == 1 ? parsed == "problem" : depth == 2 ? parsed == "load" : true;
  };
  return Json::parse(certificate, keep).at("problem").at("load");
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
  return text;
}

}  // namespace

std::string stated_load(const std::string& certificate) {
  const Json load = load_of(certificate);
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

}  // namespace taut::checker
