// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/illustration.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_cursor.h"
#include "base/labels.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/shown_bodies.h"

namespace taut {
namespace {

/// Nearest double of a decimal.
double approximation(const JsonCursor& field) {
  double value = 0;
  const std::string& text = field.text();
  const char* const end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || read != end || !std::isfinite(value)) field.fail("a number in a string");
  return value;
}

}  // namespace

nlohmann::json to_json(const DocumentFields& fields) {
  nlohmann::json result = nlohmann::json::object();
  for (const auto& [name, member] : kDocumentFields) {
    if (!(fields.*member).empty()) result[name] = fields.*member;
  }
  return result;
}

DocumentFields document_fields_from_json(const nlohmann::json& fields) {
  DocumentFields result;
  if (!fields.is_object()) return result;
  for (const auto& [name, member] : kDocumentFields) {
    const auto stated = fields.find(name);
    if (stated == fields.end() || !stated->is_string()) continue;
    const auto& text = stated->get_ref<const std::string&>();
    const bool is_fit = is_label(text) && (member != &DocumentFields::document || is_document_label(text));
    if (is_fit) result.*member = text;
  }
  return result;
}

namespace {

/// Nothing where it is not as taut writes it: anybody can alter an illustration.
std::optional<Illustration::Table> table_from_json(const nlohmann::json& table) {
  if (!table.is_object() || !table.contains("rows") || !table["rows"].is_number_unsigned()) return std::nullopt;
  const nlohmann::json rounding = table.value("rounding", nlohmann::json());
  const auto text = [&](const char* key) -> std::string {
    if (!rounding.is_object() || !rounding.contains(key) || !rounding[key].is_string()) return "";
    const auto& stated = rounding[key].get_ref<const std::string&>();
    return is_label(stated) ? stated : "";
  };
  const auto rows = table["rows"].get<std::size_t>();
  if (!text("length").empty()) return Illustration::Table{rows, text("length"), true};
  if (text("position").empty() || text("angle").empty()) return std::nullopt;
  return Illustration::Table{rows, text("position") + " and " + text("angle"), false};
}

}  // namespace

Illustration::Illustration(const nlohmann::json& json, std::size_t parameters) {
  const JsonCursor illustration(json, "illustration");
  if (!illustration.value().is_object()) return;
  if (illustration.contains("units")) units = display_units_from_json(illustration.at("units").value());
  if (illustration.contains("document_fields")) {
    document_fields = document_fields_from_json(illustration.at("document_fields").value());
  }
  if (illustration.contains("decoration")) {
    decoration = decoration_from_json(illustration.at("decoration").value());
  }
  if (illustration.contains("stats") && illustration.at("stats").value().is_object()) {
    for (const auto& [key, value] : illustration.value()["stats"].items()) {
      stats[key] = value.is_string() ? value.get<std::string>() : value.dump();
    }
  }
  if (illustration.contains("lines")) lines = FileLines(illustration.at("lines").value());
  if (illustration.contains("table")) table = table_from_json(illustration.at("table").value());
  if (illustration.contains("headroom")) headroom = headroom_from_json(illustration.at("headroom"));
  if (!illustration.contains("charts") || parameters != 2) return;
  for (const JsonCursor& entry : illustration.at("charts").elements()) {
    if (!entry.contains("c") || entry.at("c").size() != 2) continue;
    Chart chart;
    for (const JsonCursor& c : entry.at("c").elements()) chart.centre.push_back(approximation(c));
    if (entry.contains("p")) {
      for (const JsonCursor& corner : entry.at("p").elements()) {
        const std::vector<JsonCursor> at = corner.elements(2);
        chart.corners.push_back({approximation(at[0]), approximation(at[1])});
      }
    }
    charts.push_back(std::move(chart));
  }
}

}  // namespace taut
