// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/stated_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "checker/format/exact.h"
#include "checker/format/expression_parser.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;

/// problem.bodies alone: the rest of a certificate may take gigabytes.
Json bodies_of(const std::string& certificate) {
  const auto keep = [](int depth, Json::parse_event_t event, Json& parsed) {
    if (event != Json::parse_event_t::key) return true;
    return depth == 1 ? parsed == "problem" : depth == 2 ? parsed == "bodies" : true;
  };
  return Json::parse(certificate, keep).at("problem").value("bodies", Json());
}

/// Of a decimal that the reader has accepted, in any locale.
double rounded(const Json& text) { return parse_decimal(text.get<std::string>()).value().get_d(); }

/// "20 degrees" of a constant that the reader has accepted, rounded; the expression itself if no precision here tells
/// its first digits.
std::string angle_text(const Json& text) {
  constexpr int kLeastBits = 64, kMostBits = 4096;
  constexpr int kSixDigits = 24;  // bits
  const Expression expression = parse_expression(text.get<std::string>(), {}, "");
  for (int bits = kLeastBits; bits <= kMostBits; bits *= 2) {
    const WorkingPrecision precision(bits);
    try {
      const Ball degrees = expression.evaluate<MeanValueForm>({}).range() * Ball(180) / Ball::pi();
      if (arb_rel_accuracy_bits(degrees.get()) < kSixDigits) continue;
      return fmt::format("{:.6g} degrees", arf_get_d(arb_midref(degrees.get()), ARF_RND_NEAR));
    } catch (const Undefined&) {  // with more bits it may be defined
    }
  }
  return text.dump(-1, ' ', true) + " rad";
}

std::string metres(const Json& text) { return fmt::format("{:.6g} m", rounded(text)); }

/// "platform-obstacles (2 pairs), 0.2 m", or nothing where the class has no clearance.
std::string class_text(const Json& bodies, const char* name, std::size_t pairs) {
  const Json& clearances = bodies.at("clearance_m");
  if (!clearances.contains(name)) return "";
  return fmt::format("{} ({} {}), {}", name, pairs, pairs == 1 ? "pair" : "pairs", metres(clearances[name]));
}

/// "on the platform: "container"", or nothing.
std::string names_text(const Json& list, const char* where) {
  std::string text;
  for (const Json& body : list) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", body.at("name").dump(-1, ' ', true));
    if (body.contains("clearance_m")) text += fmt::format(" (clearance {})", metres(body["clearance_m"]));
  }
  return text.empty() ? "" : fmt::format("; {}: {}", where, text);
}

/// The range of six numbers or pairs of them.
std::string range_text(const Json& list) {
  double least = 0, greatest = 0;
  bool is_first = true;
  for (const Json& entry : list) {
    const double x = rounded(entry);
    least = is_first ? x : std::min(least, x);
    greatest = is_first ? x : std::max(greatest, x);
    is_first = false;
  }
  return least == greatest ? fmt::format("{:.6g} m", least) : fmt::format("{:.6g} to {:.6g} m", least, greatest);
}

}  // namespace

std::string stated_bodies(const std::string& certificate) {
  const Json bodies = bodies_of(certificate);
  if (!bodies.is_object()) return "";
  constexpr std::size_t kCableCount = 6, kCablePairs = 15;
  const std::size_t platform = bodies.at("platform").size();
  const std::size_t obstacles = bodies.at("obstacles").size();
  const std::array<std::pair<const char*, std::size_t>, 4> classes = {{{"platform-obstacles", platform * obstacles},
                                                                       {"cables-obstacles", kCableCount * obstacles},
                                                                       {"cables-cables", kCablePairs},
                                                                       {"cables-platform", kCableCount * platform}}};
  std::string checked, others;
  for (const auto& [name, pairs] : classes) {
    const std::string text = class_text(bodies, name, pairs);
    (text.empty() ? others : checked) += (text.empty() ? others : checked).empty() ? "" : "; ";
    (text.empty() ? others : checked) += text.empty() ? name : text;
  }
  std::string text = "bodies: " + (checked.empty() ? "no class of pairs is checked" : "checked: " + checked);
  text += names_text(bodies["platform"], "on the platform") + names_text(bodies["obstacles"], "obstacles");
  const Json& cables = bodies.at("cables");
  Json base = Json::array(), top = Json::array();
  for (const Json& ends : cables.at("free_ends_m")) {
    base.push_back(ends.at(0));
    top.push_back(ends.at(1));
  }
  const Json& clearances = bodies["clearance_m"];
  const bool has_cables = clearances.contains("cables-obstacles") || clearances.contains("cables-cables") ||
                          clearances.contains("cables-platform");
  if (has_cables) {
    text += fmt::format("; cables {} thick, not checked on {} near the base and {} near the platform",
                        range_text(cables.at("diameter_m")), range_text(base), range_text(top));
  }
  if (bodies.contains("pair_clearances_m")) {
    for (const Json& entry : bodies["pair_clearances_m"]) {
      text += fmt::format("; {} and {}: {}", entry.at("pair").at(0).dump(-1, ' ', true),
                          entry["pair"].at(1).dump(-1, ' ', true), metres(entry.at("clearance_m")));
    }
  }
  if (bodies.contains("contacts")) {
    for (const Json& entry : bodies["contacts"]) {
      const Json& at = entry.at("at_m");
      text += fmt::format(
          "; {} and {} MAY TOUCH, up to {} deep, with the platform's origin within {} of ({:.6g}, "
          "{:.6g}, {:.6g}) m",
          entry.at("pair").at(0).dump(-1, ' ', true), entry["pair"].at(1).dump(-1, ' ', true),
          metres(entry.at("depth_m")), metres(entry.at("within_m")), rounded(at.at(0)), rounded(at.at(1)),
          rounded(at.at(2)));
    }
  }
  if (bodies.contains("exit_cones")) {
    for (const Json& cone : bodies["exit_cones"]) {
      text += fmt::format("; cable {} in a cone of half-angle {} around ({:.6g}, {:.6g}, {:.6g}) at the {}",
                          cone.at("cable").get<int>(), angle_text(cone.at("half_angle_rad")),
                          rounded(cone.at("axis").at(0)), rounded(cone["axis"].at(1)), rounded(cone["axis"].at(2)),
                          cone.at("end").get<std::string>());
    }
  }
  if (!others.empty()) text += ". NOT CHECKED: " + others;
  return text;
}

}  // namespace taut::checker
