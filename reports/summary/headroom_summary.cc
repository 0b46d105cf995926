// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/headroom_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "certify/severity.h"
#include "problem/decimal.h"
#include "problem/rational.h"
#include "problem/rows.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/numbers.h"
#include "reports/summary/sentences.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 4> kSubjects = {"path", "waypoint", "straight way", "move"};

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

Uncertainty uncertainty_of(const JsonCursor& share) {
  const JsonCursor field = share.at("of");
  for (const UncertaintyKind kind : {UncertaintyKind::kAll, UncertaintyKind::kLoadItem}) {
    if (field.text() == name(kind)) {
      return {kind, kind == UncertaintyKind::kLoadItem ? share.at("item").text() : ""};
    }
  }
  return one_of(field, single_uncertainties(), "an uncertainty");
}

bool boolean(const JsonCursor& field) {
  if (!field.value().is_boolean()) field.fail("true or false");
  return field.value().get<bool>();
}

constexpr std::int64_t kMostSegments = 1'000'000'000;
constexpr std::int64_t kMostPairs = 1'000'000;

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
  json item_losses = json::array();
  for (const auto& [item, loss] : budget.loss_by_item) item_losses.push_back({{"item", item}, {"loss", text(loss)}});
  result.update({{"quantity", text(budget.quantity)},
                 {"limit", text(budget.limit)},
                 {"nominal", text(budget.nominal)},
                 {"left", text(budget.left())},
                 {"losses", losses},
                 {"item_losses", item_losses}});
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
  for (const JsonCursor& part : object.at("item_losses").elements()) {
    budget.loss_by_item.emplace_back(part.at("item").text(), number(part.at("loss")));
  }
  return result;
}

json to_json(const PathWitness& witness) {
  if (witness.singular) return {{"segment", witness.at.index}, {"singular", true}};
  if (witness.contact) {
    return {{"segment", witness.at.index}, {"singular", false}, {"pair", witness.contact->pair}};
  }
  json result = margin_json(witness.margin);
  result.update({{"singular", false},
                 {"segment", witness.at.index},
                 {"value_lower", witness.value_lower},
                 {"value_upper", witness.value_upper},
                 {"limit", witness.limit}});
  return result;
}

constexpr std::array<const char*, 2> kEnds = {"base", "platform"};

json to_json(const ProvedFreeEnds& found) {
  json result = {{"complete", found.is_complete}};
  for (std::size_t end = 0; end < kEnds.size(); ++end) {
    result[kEnds[end]] = found.free_ends[end] ? json(*found.free_ends[end]) : json();
  }
  return result;
}

ProvedFreeEnds free_ends_from_json(const JsonCursor& object) {
  ProvedFreeEnds result;
  object.expect_keys({"base", "platform", "complete"});
  result.is_complete = boolean(object.at("complete"));
  for (std::size_t end = 0; end < kEnds.size(); ++end) {
    const JsonCursor length = object.at(kEnds[end]);
    if (length.is_null()) continue;
    (void)decimal_from_json(length);
    result.free_ends[end] = length.text();
  }
  return result;
}

PathWitness violation_from_json(const JsonCursor& object) {
  PathWitness result;
  result.singular = boolean(object.at("singular"));
  result.at.on_segment = true;
  result.at.index = static_cast<int>(object.at("segment").integer(0, kMostSegments));
  if (result.singular) return result;
  if (object.contains("pair")) {
    result.contact.emplace().pair = static_cast<std::size_t>(object.at("pair").integer(0, kMostPairs));
    return result;
  }
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

std::string quantity(double x, const DisplayUnit& unit) {
  return fmt::format("{:.4g} {}", unit.approx(x), unit.name());
}

std::string place_of(const Headroom& headroom, std::size_t segment, double s) {
  switch (headroom.subject) {
    case Headroom::Subject::kWaypoint: return fmt::format("at waypoint {} of the query", headroom.waypoint);
    case Headroom::Subject::kStraightWay:
      return fmt::format("on the straight way from waypoint {} to {} of the query, at s = {:.3g}", segment, segment + 1,
                         s);
    case Headroom::Subject::kMove:
    case Headroom::Subject::kPath: break;
  }
  return fmt::format("at s = {:.3g} of segment {}", s, segment);
}

/// The size that was proved, of the unit's `factor`.
std::string proved_size(const ProvableShare& share, double factor = 1) {
  return share.share == "1" ? fmt::format("{:.6g}", factor * share.stated) : rounded_down(factor * share.proved, 3);
}

/// "up to 14.1 kN", "from 3 to 5 kN": of an item's set, rounded inward.
std::string size_text(const VectorSet& set, const DisplayUnit& unit) {
  const auto approx = [](const RationalText& x) { return from_rational<double>(x); };
  const auto up_to = [&](const RationalText& radius) {
    return fmt::format("up to {} {}", unit.down(approx(radius), 3), unit.name());
  };
  if (const auto* ball = std::get_if<BallOfVectors>(&set)) return up_to(ball->radius);
  if (const auto* disc = std::get_if<DiscOfVectors>(&set)) return up_to(disc->radius);
  const auto& segment = std::get<SegmentOfVectors>(set);
  return fmt::format("from {} to {} {}", unit.up(approx(segment.lower), 3), unit.down(approx(segment.upper), 3),
                     unit.name());
}

/// "11.5 to 12.5 t, its centre of gravity within 0.06 m": an item at its share, rounded inward; empty of load cases and
/// of what the problem has not.
std::string item_size_text(const ProvableShare& share, const Problem& problem, const DisplayUnits& units) {
  const auto scaled = [&]() -> std::optional<LoadItem> {
    try {
      const LoadText load = with_uncertainty_scaled(problem, share.of, Decimal::parse(share.share)).load;
      return *std::ranges::find(load.items, share.of.item, &LoadItem::name);
    } catch (const InputError&) {
      return std::nullopt;  // an illustration proves nothing, and anybody can alter it
    }
  }();
  if (!scaled) return "";
  if (const auto* force = std::get_if<Force>(&scaled->what)) return size_text(force->set, units.force);
  if (const auto* moment = std::get_if<Moment>(&scaled->what)) return size_text(moment->set, units.moment);
  const auto* weight = std::get_if<Weight>(&scaled->what);
  if (!weight) return "";
  const double lower = from_rational<double>(weight->mass_lower);
  const double upper = from_rational<double>(weight->mass_upper);
  constexpr double kTonne = 1000;
  const bool is_heavy = upper >= kTonne;
  const double unit = is_heavy ? kTonne : 1;
  std::string result =
      fmt::format("{} to {} {}", rounded_up(lower / unit), rounded_down(upper / unit), is_heavy ? "t" : "kg");
  if (const double reach = from_rational<double>(weight->at_tolerance); reach > 0) {
    result += fmt::format(", its centre of gravity within {} {}", units.length.down(reach, 3), units.length.name());
  }
  return result;
}

/// "0.5 mm"; empty of sets.
std::string size_text(const ProvableShare& share, const Problem& problem, const DisplayUnits& units) {
  constexpr double kDegrees = 180 / 3.14159265358979323846 * (1 - 1e-15);
  switch (share.of.kind) {
    case UncertaintyKind::kLoad: return proved_size(share) + " N or N·m";
    case UncertaintyKind::kOrientation:
      return units.in_degrees ? proved_size(share, kDegrees) + "°" : proved_size(share) + " rad";
    case UncertaintyKind::kLoadItem: return item_size_text(share, problem, units);
    case UncertaintyKind::kWrenchSet:
    case UncertaintyKind::kAll: return "";
    default: return fmt::format("{} {}", proved_size(share, units.length.approx(1)), units.length.name());
  }
}

std::string words(const Uncertainty& of) {
  switch (of.kind) {
    case UncertaintyKind::kBaseAnchors: return "base anchors";
    case UncertaintyKind::kPlatformAnchors: return "platform anchors";
    case UncertaintyKind::kLoadPoint: return "load point";
    case UncertaintyKind::kLoad: return "load";
    case UncertaintyKind::kPosition: return "position";
    case UncertaintyKind::kOrientation: return "orientation";
    case UncertaintyKind::kCableLengths: return "cable lengths";
    case UncertaintyKind::kWrenchSet: return "deviations of the load";
    case UncertaintyKind::kLoadItem: return quoted_name(of.item);
    case UncertaintyKind::kAll: break;
  }
  return "all tolerances and deviations of the load";
}

/// "deviations of the load 5.1 kN (payload 2.1 kN, wind 3 kN), base anchors 1 kN": what takes something.
std::string losses_text(const MarginBudget& budget, const DisplayUnit& unit) {
  std::string result;
  for (const UncertaintyKind kind : single_uncertainties()) {
    const double loss = budget.loss.at(static_cast<std::size_t>(kind));
    if (!(loss > 0)) continue;
    result += fmt::format("{}{} {}", result.empty() ? "" : ", ", words(kind), quantity(loss, unit));
    if (kind != UncertaintyKind::kWrenchSet || budget.loss_by_item.empty()) continue;
    std::string items;
    for (const auto& [item, part] : budget.loss_by_item) {
      items += fmt::format("{}{} {}", items.empty() ? "" : ", ", quoted_name(item), quantity(part, unit));
    }
    result += fmt::format(" ({})", items);
  }
  return result.empty() ? "nothing" : result;
}

std::string tightest_sentence(const Headroom& headroom, const Problem& problem, const DisplayUnits& units,
                              bool is_proved) {
  const TightPlace& place = *headroom.tightest;
  const std::string where = place_of(headroom, place.segment, place.s);
  const char* const begin = is_proved ? "Tightest limit of a cable" : "In the way";
  if (place.singular) return fmt::format("{}: a singular pose, or nearly so, {} (in floating point).", begin, where);
  const MarginBudget& budget = place.budget;
  const bool in_time = headroom.subject == Headroom::Subject::kMove;
  if (!is_proved && (problem.bodies || in_time) && budget.left() > 0) {
    return fmt::format("In the way: no limit of a cable, as far as samples show, but {}{}{}.",
                       in_time ? "a limit in time" : "", in_time && problem.bodies ? ", or " : "",
                       problem.bodies ? "a clearance of bodies or an exit cone" : "");
  }
  const bool length = is_length(budget.id);
  const DisplayUnit& unit = units.of(length);
  const auto amount = [&](double x) { return quantity(x, unit); };
  const std::string margin =
      fmt::format("the {} of cable {} {}, limit {} {}", length ? "length" : "tension", budget.id.cable + 1, where,
                  is_upper(budget.id) ? "below" : "above", amount(budget.limit));
  if (!(budget.nominal > 0)) {
    return fmt::format("{}: {}. The nominal machine is beyond it by {} (in floating point).", begin, margin,
                       amount(-budget.nominal));
  }
  const double left = budget.left();
  // What is left of a proved margin is stated as proved, elsewhere.
  const std::string missing = is_proved  ? ""
                              : left > 0 ? fmt::format(" {} are left.", amount(left))
                                         : fmt::format(" {} are missing.", amount(-left));
  const RowsText* const stated = stated_rows(problem);
  const std::string rows = stated != nullptr ? " Cable lengths take part as rows of a table leave them open, " +
                                                   row_error_text(*stated) + " at most (time.between_rows)."
                                             : "";
  return fmt::format(
      "{}: {}. The nominal machine has a margin of {} there; of that take, to first order and in floating point: "
      "{}.{}{}",
      begin, margin, amount(budget.nominal), losses_text(budget, unit), missing, rows);
}

std::string nominal_sentence(const Headroom& headroom, const Problem& problem, const DisplayUnits& units) {
  if (!headroom.nominal_provable) return "";
  if (*headroom.nominal_provable) return " The nominal machine, under the nominal load, is proved.";
  if (!headroom.nominal_violation) {
    return fmt::format(" Not even the nominal machine, under the nominal load{}, could be proved.",
                       stated_rows(problem) != nullptr ? ", with lengths that are off between rows" : "");
  }
  return fmt::format(" The nominal machine itself breaks a limit: {}.",
                     violation_text(*headroom.nominal_violation, problem, units));
}

std::string subject_text(const Headroom& headroom) {
  switch (headroom.subject) {
    case Headroom::Subject::kWaypoint: return fmt::format("Waypoint {} of the query is", headroom.waypoint);
    case Headroom::Subject::kStraightWay: return "The straight way through the query's waypoints is";
    case Headroom::Subject::kMove: return "The move, by its law in time, is";
    case Headroom::Subject::kPath: break;
  }
  return "The path is";
}

bool is_above_one(const ProvableShare& share) { return Decimal::parse(share.share) >= Decimal::parse("1"); }

std::string common_sentence(const Headroom& headroom, const Problem& problem, const DisplayUnits& units) {
  const ProvableShare& all = headroom.shares.front();
  const std::string ended = all.is_complete ? "" : " (the search ended when its time did)";
  if (all.share == "0") {
    return fmt::format("{} {} {}{}.{}", subject_text(headroom),
                       all.is_complete ? "provable at no share of" : "so far not proved at any share of", words(all.of),
                       ended, nominal_sentence(headroom, problem, units));
  }
  return fmt::format("{} provable at {} of {}, together{}.", subject_text(headroom), percent_text(all.share),
                     words(all.of), ended);
}

std::string each_sentence(const Headroom& headroom, const Problem& problem, const DisplayUnits& units) {
  std::string list;
  for (const EachAlone& alone : each_alone(headroom, problem, units)) {
    list += fmt::format("{}{} {}", list.empty() ? "" : "; ", alone.what, alone.words());
  }
  if (list.empty()) return "";
  return fmt::format("Each alone, with all others as stated: {}.", list);
}

/// "The path is provable with free ends of 120 mm near the platform's anchors. …"; empty where none were found.
std::string free_ends_sentence(const Headroom& headroom, const DisplayUnits& units) {
  if (!headroom.free_ends) return "";
  std::string list;
  for (std::size_t end = 0; end < kEnds.size(); ++end) {
    const std::optional<DecimalText>& length = headroom.free_ends->free_ends[end];
    if (!length) continue;
    list += fmt::format("{}{} {} near the {}'s anchors", list.empty() ? "" : " and ", units.length.exact(*length),
                        units.length.name(), kEnds[end]);
  }
  return fmt::format(
      "{} provable where cables have free ends of {}, all else as stated{}. What a cable touches within its free ends "
      "is not checked.",
      subject_text(headroom), list, headroom.free_ends->is_complete ? "" : " (time ended the search for shorter ones)");
}

}  // namespace

std::vector<EachAlone> each_alone(const Headroom& headroom, const Problem& problem, const DisplayUnits& units) {
  std::vector<EachAlone> result;
  for (const ProvableShare& found : headroom.shares) {
    if (found.of == UncertaintyKind::kAll || (found.stated == 0 && found.share == "0")) continue;
    EachAlone alone{found.of, words(found.of), "", "", 0, found.is_complete};
    constexpr double kPercent = 100;
    constexpr double kNone = 1000;  // more than any axis shows
    if (found.stated != 0) {
      const double share = nearest_double(found.share);
      alone.share = found.share == "0" ? "none" : percent_text(found.share);
      alone.used = share > 0 ? std::min(kPercent / share, kNone) : kNone;
    }
    if (found.share != "0") alone.size = size_text(found, problem, units);
    result.push_back(std::move(alone));
  }
  return result;
}

std::string EachAlone::words() const {
  const std::string of_size = size.empty() ? "" : share.empty() ? "up to " + size : " (" + size + ")";
  return share + of_size + (is_complete ? "" : " (time ended the search)");
}

std::string percent_text(const DecimalText& share) {
  return (Decimal::parse(share) * Decimal::parse("100")).text() + " %";
}

nlohmann::json to_json(const Headroom& headroom) {
  json shares = json::array();
  for (const ProvableShare& share : headroom.shares) {
    const bool is_item = share.of.kind == UncertaintyKind::kLoadItem;
    shares.push_back({{"of", name(share.of.kind)},
                      {"item", is_item ? json(share.of.item) : json()},
                      {"share", share.share},
                      {"stated", text(share.stated)},
                      {"proved", proved_size(share)},
                      {"unit", unit(share.of.kind)},
                      {"complete", share.is_complete}});
  }
  json nominal;
  if (headroom.nominal_provable) {
    nominal = {{"provable", *headroom.nominal_provable},
               {"violation", headroom.nominal_violation ? to_json(*headroom.nominal_violation) : json()}};
  }
  json result = {{"subject", kSubjects.at(static_cast<std::size_t>(headroom.subject))},
                 {"waypoint", headroom.subject == Headroom::Subject::kWaypoint ? json(headroom.waypoint) : json()},
                 {"shares", shares},
                 {"tightest", headroom.tightest ? to_json(*headroom.tightest) : json()},
                 {"nominal", nominal}};
  if (headroom.free_ends) result["free_ends"] = to_json(*headroom.free_ends);
  return result;
}

Headroom headroom_from_json(const JsonCursor& object) {
  Headroom result;
  std::vector<std::string> keys = {"subject", "waypoint", "shares", "tightest", "nominal"};
  if (object.contains("free_ends")) keys.emplace_back("free_ends");
  object.expect_keys(keys);
  const auto subject = std::ranges::find(kSubjects, object.at("subject").text());
  if (subject == kSubjects.end()) object.at("subject").fail("\"path\", \"waypoint\", \"straight way\" or \"move\"");
  result.subject = static_cast<Headroom::Subject>(subject - kSubjects.begin());
  if (result.subject == Headroom::Subject::kWaypoint) {
    result.waypoint = static_cast<std::size_t>(object.at("waypoint").integer(0, kMostSegments));
  }
  for (const JsonCursor& share : object.at("shares").elements()) {
    (void)decimal_from_json(share.at("share"));
    result.shares.push_back({uncertainty_of(share), number(share.at("stated")), share.at("share").text(),
                             number(share.at("proved")), boolean(share.at("complete"))});
  }
  if (!object.at("tightest").is_null()) result.tightest = place_from_json(object.at("tightest"));
  if (const JsonCursor nominal = object.at("nominal"); !nominal.is_null()) {
    result.nominal_provable = boolean(nominal.at("provable"));
    if (!nominal.at("violation").is_null()) result.nominal_violation = violation_from_json(nominal.at("violation"));
  }
  if (object.contains("free_ends")) result.free_ends = free_ends_from_json(object.at("free_ends"));
  return result;
}

std::vector<std::string> headroom_sentences(const Headroom& headroom, const Problem& problem,
                                            const DisplayUnits& units) {
  std::vector<std::string> result;
  if (headroom.shares.empty()) return result;
  const bool is_proved = is_above_one(headroom.shares.front());
  if (headroom.tightest) result.push_back(tightest_sentence(headroom, problem, units, is_proved));
  result.push_back(common_sentence(headroom, problem, units));
  if (std::string each = each_sentence(headroom, problem, units); !each.empty()) result.push_back(std::move(each));
  if (std::string ends = free_ends_sentence(headroom, units); !ends.empty()) result.push_back(std::move(ends));
  return result;
}

}  // namespace taut
