// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/headroom_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "problem/decimal.h"
#include "reports/summary/sentences.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> kSubjects = {"path", "waypoint", "straight way"};

// ---- JSON -----------------------------------------------------------------------------------------------------------

std::string text(double x) { return fmt::format("{:.6g}", x); }

double number(const JsonCursor& field) {
  double value = 0;
  const std::string& digits = field.text();
  const char* const end = digits.data() + digits.size();
  const auto [read, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc() || read != end || !std::isfinite(value)) field.fail("a number in a string");
  return value;
}

template <class T, std::size_t N>
T one_of(const JsonCursor& field, const std::array<T, N>& all, const char* expected) {
  const auto found = std::ranges::find_if(all, [&](const T& x) { return field.text() == name(x); });
  if (found == all.end()) field.fail(expected);
  return *found;
}

UncertaintyKind kind_of(const JsonCursor& field) {
  if (field.text() == name(UncertaintyKind::kAll)) return UncertaintyKind::kAll;
  return one_of(field, single_uncertainties(), "an uncertainty");
}

bool boolean(const JsonCursor& field) {
  if (!field.value().is_boolean()) field.fail("true or false");
  return field.value().get<bool>();
}

constexpr std::int64_t kMostSegments = 1'000'000'000;

json margin_json(MarginId margin) { return {{"margin", name(margin.kind)}, {"cable", margin.cable + 1}}; }

MarginId margin_of(const JsonCursor& object) {
  const auto kind = one_of(
      object.at("margin"),
      std::array{MarginKind::kTensionMin, MarginKind::kTensionMax, MarginKind::kLengthMin, MarginKind::kLengthMax},
      "a margin");
  return {kind, static_cast<int>(object.at("cable").integer(1, kCables)) - 1};
}

json to_json(const TightPlace& place) {
  json result = {{"segment", place.segment}, {"s", text(place.s)}, {"singular", place.singular}};
  if (place.singular) return result;
  const MarginBudget& budget = place.budget;
  result.update(margin_json(budget.id));
  json losses = json::object();
  for (const UncertaintyKind kind : single_uncertainties()) {
    const double loss = budget.loss.at(static_cast<std::size_t>(kind));
    if (loss > 0) losses[name(kind)] = text(loss);
  }
  result.update({{"quantity", text(budget.quantity)},
                 {"limit", text(budget.limit)},
                 {"nominal", text(budget.nominal)},
                 {"left", text(budget.left())},
                 {"losses", losses}});
  return result;
}

TightPlace place_from_json(const JsonCursor& object) {
  TightPlace result;
  result.segment = static_cast<std::size_t>(object.at("segment").integer(0, kMostSegments));
  result.s = number(object.at("s"));
  result.singular = boolean(object.at("singular"));
  if (result.singular) return result;
  MarginBudget& budget = result.budget;
  budget.id = margin_of(object);
  budget.quantity = number(object.at("quantity"));
  budget.limit = number(object.at("limit"));
  budget.nominal = number(object.at("nominal"));
  const JsonCursor losses = object.at("losses");
  for (const UncertaintyKind kind : single_uncertainties()) {
    if (losses.contains(name(kind))) budget.loss.at(static_cast<std::size_t>(kind)) = number(losses.at(name(kind)));
  }
  return result;
}

json to_json(const PathWitness& witness) {
  if (witness.singular) return {{"segment", witness.at.index}, {"singular", true}};
  json result = margin_json(witness.margin);
  result.update({{"singular", false},
                 {"segment", witness.at.index},
                 {"value_lower", witness.value_lower},
                 {"value_upper", witness.value_upper},
                 {"limit", witness.limit}});
  return result;
}

PathWitness violation_from_json(const JsonCursor& object) {
  PathWitness result;
  result.singular = boolean(object.at("singular"));
  result.at.on_segment = true;
  result.at.index = static_cast<int>(object.at("segment").integer(0, kMostSegments));
  if (result.singular) return result;
  result.margin = margin_of(object);
  for (const auto& [key, decimal] :
       {std::pair("value_lower", &result.value_lower), std::pair("value_upper", &result.value_upper),
        std::pair("limit", &result.limit)}) {
    (void)decimal_from_json(object.at(key));
    *decimal = object.at(key).text();
  }
  return result;
}

// ---- Words ----------------------------------------------------------------------------------------------------------

bool is_length(MarginId margin) {
  return margin.kind == MarginKind::kLengthMin || margin.kind == MarginKind::kLengthMax;
}
bool is_lower(MarginId margin) {
  return margin.kind == MarginKind::kTensionMin || margin.kind == MarginKind::kLengthMin;
}

std::string quantity(double x, bool length) {
  return length ? fmt::format("{:.4g} mm", 1000 * x) : fmt::format("{:.4g} N", x);
}

std::string place_of(const Headroom& headroom, std::size_t segment, double s) {
  switch (headroom.subject) {
    case Headroom::Subject::kWaypoint: return fmt::format("at waypoint {} of the query", headroom.waypoint);
    case Headroom::Subject::kStraightWay:
      return fmt::format("on the straight way from waypoint {} to {} of the query, at s = {:.3g}", segment, segment + 1,
                         s);
    case Headroom::Subject::kPath: break;
  }
  return fmt::format("at s = {:.3g} of segment {}", s, segment);
}

/// The size that was proved, of the unit's `factor`.
std::string proved_size(const ProvableShare& share, double factor = 1) {
  return share.share == "1" ? fmt::format("{:.6g}", factor * share.stated) : rounded_down(factor * share.proved, 3);
}

/// "0.5 mm"; empty of sets.
std::string size_text(const ProvableShare& share) {
  constexpr double kDegrees = 180 / 3.14159265358979323846 * (1 - 1e-15);
  constexpr double kMillimetres = 1000;
  switch (share.of) {
    case UncertaintyKind::kLoad: return proved_size(share) + " N or N·m";
    case UncertaintyKind::kOrientation: return proved_size(share, kDegrees) + "°";
    case UncertaintyKind::kWrenchSet:
    case UncertaintyKind::kAll: return "";
    default: return proved_size(share, kMillimetres) + " mm";
  }
}

const char* words(UncertaintyKind kind) {
  switch (kind) {
    case UncertaintyKind::kBaseAnchors: return "base anchors";
    case UncertaintyKind::kPlatformAnchors: return "platform anchors";
    case UncertaintyKind::kLoadPoint: return "load point";
    case UncertaintyKind::kLoad: return "load";
    case UncertaintyKind::kPosition: return "position";
    case UncertaintyKind::kOrientation: return "orientation";
    case UncertaintyKind::kCableLengths: return "cable lengths";
    case UncertaintyKind::kWrenchSet: return "deviations of the load";
    case UncertaintyKind::kAll: break;
  }
  return "all tolerances and deviations of the load";
}

std::string tightest_sentence(const Headroom& headroom, bool is_proved) {
  const TightPlace& place = *headroom.tightest;
  const std::string where = place_of(headroom, place.segment, place.s);
  const char* const begin = is_proved ? "Tightest" : "In the way";
  if (place.singular) return fmt::format("{}: a singular pose, or nearly so, {} (in floating point).", begin, where);
  const MarginBudget& budget = place.budget;
  const bool length = is_length(budget.id);
  const auto amount = [&](double x) { return quantity(x, length); };
  const std::string margin =
      fmt::format("the {} of cable {} {}, limit {} {}", length ? "length" : "tension", budget.id.cable + 1, where,
                  is_lower(budget.id) ? "above" : "below", amount(budget.limit));
  if (!(budget.nominal > 0)) {
    return fmt::format("{}: {}. The nominal machine is beyond it by {} (in floating point).", begin, margin,
                       amount(-budget.nominal));
  }
  std::string takes;
  for (const UncertaintyKind kind : single_uncertainties()) {
    const double loss = budget.loss.at(static_cast<std::size_t>(kind));
    if (loss > 0) takes += fmt::format("{}{} {}", takes.empty() ? "" : ", ", words(kind), amount(loss));
  }
  if (takes.empty()) takes = "nothing";
  const double left = budget.left();
  return fmt::format(
      "{}: {}. The nominal machine has {} there; of that take: {}. {} (to first order, in floating point).", begin,
      margin, amount(budget.nominal), takes, left > 0 ? amount(left) + " are left" : amount(-left) + " are missing");
}

std::string nominal_sentence(const Headroom& headroom) {
  if (!headroom.nominal_provable) return "";
  if (*headroom.nominal_provable) return " The nominal machine, under the nominal load, is proved.";
  if (!headroom.nominal_violation) return " Not even the nominal machine, under the nominal load, could be proved.";
  return fmt::format(" The nominal machine itself breaks a limit: {}.", violation_text(*headroom.nominal_violation));
}

std::string subject_text(const Headroom& headroom) {
  switch (headroom.subject) {
    case Headroom::Subject::kWaypoint: return fmt::format("Waypoint {} of the query is", headroom.waypoint);
    case Headroom::Subject::kStraightWay: return "The straight way through the query's waypoints is";
    case Headroom::Subject::kPath: break;
  }
  return "The path is";
}

bool is_above_one(const ProvableShare& share) { return Decimal::parse(share.share) >= Decimal::parse("1"); }

std::string common_sentence(const Headroom& headroom) {
  const ProvableShare& all = headroom.shares.front();
  const std::string ended = all.is_complete ? "" : " (the search ended when its time did)";
  if (all.share == "0") {
    return fmt::format("{} {} {}{}.{}", subject_text(headroom),
                       all.is_complete ? "provable at no share of" : "so far not proved at any share of", words(all.of),
                       ended, nominal_sentence(headroom));
  }
  return fmt::format("{} provable at {} of {}, together{}.", subject_text(headroom), percent_text(all.share),
                     words(all.of), ended);
}

std::string each_sentence(const Headroom& headroom) {
  std::string list;
  for (const ProvableShare& share : headroom.shares) {
    if (share.of == UncertaintyKind::kAll || (share.stated == 0 && share.share == "0")) continue;
    const std::string size = share.share == "0" ? "" : size_text(share);
    const std::string part = share.stated == 0 ? "" : share.share == "0" ? "none" : percent_text(share.share);
    list += fmt::format("{}{} {}{}{}", list.empty() ? "" : "; ", words(share.of), part,
                        size.empty()   ? ""
                        : part.empty() ? "up to " + size
                                       : " (" + size + ")",
                        share.is_complete ? "" : " (time ended the search)");
  }
  if (list.empty()) return "";
  return fmt::format("Each alone, with all others as stated: {}.", list);
}

}  // namespace

std::string percent_text(const DecimalText& share) {
  return (Decimal::parse(share) * Decimal::parse("100")).text() + " %";
}

nlohmann::json to_json(const Headroom& headroom) {
  json shares = json::array();
  for (const ProvableShare& share : headroom.shares) {
    shares.push_back({{"of", name(share.of)},
                      {"share", share.share},
                      {"stated", text(share.stated)},
                      {"proved", proved_size(share)},
                      {"unit", unit(share.of)},
                      {"complete", share.is_complete}});
  }
  json nominal;
  if (headroom.nominal_provable) {
    nominal = {{"provable", *headroom.nominal_provable},
               {"violation", headroom.nominal_violation ? to_json(*headroom.nominal_violation) : json()}};
  }
  return {{"subject", kSubjects.at(static_cast<std::size_t>(headroom.subject))},
          {"waypoint", headroom.subject == Headroom::Subject::kWaypoint ? json(headroom.waypoint) : json()},
          {"shares", shares},
          {"tightest", headroom.tightest ? to_json(*headroom.tightest) : json()},
          {"nominal", nominal}};
}

Headroom headroom_from_json(const JsonCursor& object) {
  Headroom result;
  object.expect_keys({"subject", "waypoint", "shares", "tightest", "nominal"});
  const auto subject = std::ranges::find(kSubjects, object.at("subject").text());
  if (subject == kSubjects.end()) object.at("subject").fail("\"path\", \"waypoint\" or \"straight way\"");
  result.subject = static_cast<Headroom::Subject>(subject - kSubjects.begin());
  if (result.subject == Headroom::Subject::kWaypoint) {
    result.waypoint = static_cast<std::size_t>(object.at("waypoint").integer(0, kMostSegments));
  }
  for (const JsonCursor& share : object.at("shares").elements()) {
    (void)decimal_from_json(share.at("share"));
    result.shares.push_back({kind_of(share.at("of")), number(share.at("stated")), share.at("share").text(),
                             number(share.at("proved")), boolean(share.at("complete"))});
  }
  if (!object.at("tightest").is_null()) result.tightest = place_from_json(object.at("tightest"));
  if (const JsonCursor nominal = object.at("nominal"); !nominal.is_null()) {
    result.nominal_provable = boolean(nominal.at("provable"));
    if (!nominal.at("violation").is_null()) result.nominal_violation = violation_from_json(nominal.at("violation"));
  }
  return result;
}

std::vector<std::string> headroom_sentences(const Headroom& headroom) {
  std::vector<std::string> result;
  if (headroom.shares.empty()) return result;
  const bool is_proved = is_above_one(headroom.shares.front());
  if (headroom.tightest) result.push_back(tightest_sentence(headroom, is_proved));
  result.push_back(common_sentence(headroom));
  if (std::string each = each_sentence(headroom); !each.empty()) result.push_back(std::move(each));
  return result;
}

}  // namespace taut
