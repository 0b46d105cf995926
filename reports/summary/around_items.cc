// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/around_items.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/json_cursor.h"
#include "base/sanitize.h"
#include "problem/decimal.h"
#include "problem/scalar.h"
#include "reports/summary/numbers.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<const char*, DecimalText Margins::*>, 3> kMargins = {
    {{"tension_N", &Margins::tension_N}, {"length_m", &Margins::length_m}, {"wrench_scale", &Margins::wrench_scale}}};

json margins_json(const std::optional<Margins>& margins) {
  if (!margins) return {};
  json result = json::object();
  for (const auto& [key, member] : kMargins) result[key] = (*margins).*member;
  return result;
}

std::optional<Margins> margins_from(const JsonCursor& object) {
  if (object.is_null()) return std::nullopt;
  Margins result;
  for (const auto& [key, member] : kMargins) {
    (void)decimal_from_json(object.at(key));
    result.*member = object.at(key).text();
  }
  return result;
}

/// One line that can be shown as it is.
std::string line_from(const JsonCursor& field) {
  constexpr std::size_t kLongest = 4000;
  const std::string& text = field.text();
  if (text.empty() || text.size() > kLongest || sanitize(text) != text) field.fail("one line of text");
  return text;
}

double number_from(const JsonCursor& field) {
  const std::string& text = field.text();
  double value = 0;
  const auto [read, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || read != text.data() + text.size() || !std::isfinite(value)) {
    field.fail("a number in a string");
  }
  return value;
}

/// Certificates have no numbers but integers.
json with_numbers_in_strings(json value) {
  if (value.is_number()) return fmt::format("{}", value.get<double>());
  if (value.is_structured()) {
    for (json& element : value) element = with_numbers_in_strings(std::move(element));
  }
  return value;
}

StatedRange range_from(const JsonCursor& field) {
  const std::vector<JsonCursor> ends = field.elements(2);
  return {number_from(ends[0]), number_from(ends[1])};
}

LoadStatement statement_from(const JsonCursor& object) {
  LoadStatement result;
  if (!object.at("mass_kg").is_null()) result.mass_kg = range_from(object.at("mass_kg"));
  if (!object.at("centre_of_gravity_m").is_null()) {
    const std::vector<JsonCursor> centre = object.at("centre_of_gravity_m").elements(3);
    result.centre_of_gravity_m = {number_from(centre[0]), number_from(centre[1]), number_from(centre[2])};
  }
  const std::vector<JsonCursor> nominal = object.at("nominal_wrench").elements(6);
  const std::vector<JsonCursor> extremes = object.at("extreme_wrenches").elements(6);
  for (std::size_t i = 0; i < 6; ++i) {
    result.nominal[i] = number_from(nominal[i]);
    result.extremes[i] = range_from(extremes[i]);
  }
  for (const JsonCursor& item : object.at("items").elements()) {
    result.items.emplace_back(line_from(item.at("name")), line_from(item.at("text")));
  }
  const std::vector<JsonCursor> text = object.at("text").elements(2 + result.items.size());
  result.total = line_from(text[0]);
  result.spread = line_from(text[1]);
  return result;
}

/// `read` of the object at a key of the illustration.
template <class Read>
auto read_illustration(const Certificate& certificate, const char* key, Read read)
    -> std::optional<decltype(read(JsonCursor(certificate.illustration, "")))> {
  const json& illustration = certificate.illustration;
  if (!illustration.is_object() || !illustration.contains(key) || illustration.at(key).is_null()) return std::nullopt;
  try {
    return read(JsonCursor(illustration.at(key), key));
  } catch (const InputError&) {
    return std::nullopt;  // anybody can alter an illustration
  }
}

}  // namespace

nlohmann::json to_json(const std::optional<AsItems>& found) {
  if (!found) return {};
  return {{"subject", found->subject},
          {"verdict", name(found->verdict)},
          {"margins", margins_json(found->margins)},
          {"of_ellipsoid", margins_json(found->of_ellipsoid)}};
}

std::string sentence(const AsItems& found, const DisplayUnits& units) {
  const std::string instead = "With the items in place of the ellipsoid around them";
  if (found.verdict != Verdict::kProved) {
    return fmt::format("{}, {} is {}.", instead, found.subject,
                       found.verdict == Verdict::kRefuted ? "refuted, too" : "not proved, either");
  }
  constexpr int kDigits = 3;
  const auto tension = [&](const Margins& margins) {
    return fmt::format("{} {}", units.force.down(nearest_double(margins.tension_N), kDigits), units.force.name());
  };
  const auto growth = [&](const Margins& margins) {
    return rounded_down(nearest_double(margins.wrench_scale), kDigits);
  };
  if (found.margins && found.of_ellipsoid) {
    return fmt::format(
        "{}, {} is proved with a tension margin of {} in place of {}, and the load's deviations may grow by the factor "
        "{} in place of {}.",
        instead, found.subject, tension(*found.margins), tension(*found.of_ellipsoid), growth(*found.margins),
        growth(*found.of_ellipsoid));
  }
  return fmt::format(
      "{}, {} is proved{}: what stands in the way is the ellipsoid, not the items. Take 'ellipsoid: around_items' out "
      "of the case to have a proof about the items.",
      instead, found.subject,
      found.margins ? fmt::format(" with a tension margin of {}", tension(*found.margins)) : "");
}

nlohmann::json stated_json(const LoadStatement& items) { return with_numbers_in_strings(to_json(items)); }

std::optional<LoadStatement> stated_items(const Certificate& certificate) {
  return read_illustration(certificate, "around_items", [](const JsonCursor& items) { return statement_from(items); });
}

std::optional<AsItems> stated_as_items(const Certificate& certificate) {
  return read_illustration(certificate, "as_items", [](const JsonCursor& object) {
    AsItems result{line_from(object.at("subject")), Verdict::kUndecided, margins_from(object.at("margins")),
                   margins_from(object.at("of_ellipsoid"))};
    for (const Verdict verdict : {Verdict::kProved, Verdict::kRefuted}) {
      if (object.at("verdict").text() == name(verdict)) result.verdict = verdict;
    }
    return result;
  });
}

std::vector<std::string> report_lines(const LoadStatement& load) {
  if (!load.around_items) return lines(load);
  LoadStatement ellipsoid = load;
  ellipsoid.around_items.reset();
  std::vector<std::string> result = lines(ellipsoid);
  result.emplace_back(kItemsNotChecked);
  for (std::string& line : lines(*load.around_items)) result.push_back(std::move(line));
  return result;
}

nlohmann::json report_json(const LoadStatement& load) {
  json result = to_json(load);
  result["text"] = report_lines(load);
  return result;
}

}  // namespace taut
