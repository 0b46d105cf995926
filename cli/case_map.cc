// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/case_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "cli/console.h"
#include "reports/summary/load_statement.h"

namespace taut {

// ---- What is mapped -------------------------------------------------------------------------------------------------

namespace {

/// A waypoint of the query by its number.
std::optional<MapStart> numbered_start(const Problem& problem, const std::string& from) {
  if (problem.query.empty() && from.empty()) return std::nullopt;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(from.data(), from.data() + from.size(), number);
  if (!from.empty() && (error != std::errc() || number >= problem.query.size())) {
    const std::string numbers =
        problem.query.empty() ? "no number, because the case has no query, but"
                              : fmt::format("a waypoint of the query, from 0 to {}, or", problem.query.size() - 1);
    throw InputError(ErrorCode::kUse,
                     fmt::format("--from: got '{}', expected {} coordinates such as 'phi: 10 deg, theta: 0.3'",
                                 excerpt(from), numbers));
  }
  return MapStart{fmt::format("waypoint {} of the query", number), problem.query.at(number)};
}

}  // namespace

MappedCase::MappedCase(const std::string& case_path, const std::string& from) {
  const auto set_space = [&](const Case& read) {
    require_no_meshes(read.problem);
    space = make_map_space(read.problem.space);
  };
  if (from.find_first_not_of("0123456789") == std::string::npos) {
    the_case = at_rest(load_case(case_path, set_space));
    start = numbered_start(the_case.problem, from);
    return;
  }
  MapStart typed{fmt::format("({})", from), {}};
  the_case = at_rest(load_case_and_waypoint(case_path, from, "--from", typed.waypoint, set_space));
  start = std::move(typed);
}

CaseMap::CaseMap(const MappedCase& mapped, CellMap map, double seconds)
    : map_(std::move(map)),
      seconds_(seconds),
      topology_(map_),
      result_{mapped.the_case.problem, map_, topology_, {}, {}, {}, {}, {}} {
  const Case& the_case = mapped.the_case;
  for (const auto& waypoint : the_case.problem.query) {
    places_.push_back(place_of(mapped.space, waypoint));
    const std::size_t n = places_.size();
    if (n > 1) connections_.push_back(topology_.connection(places_[n - 2], places_[n - 1]));
  }
  const std::string& title = the_case.document_fields.title;
  result_.title = title.empty() ? the_case.problem.name : title;
  result_.load = lines(load_statement(the_case));
  result_.axes = shown_axes(the_case.problem.space, mapped.space, DisplayUnits(the_case.units));
  if (!mapped.start) return;
  start_ = place_of(mapped.space, mapped.start->waypoint);
  result_.region.emplace(topology_, start_);
  result_.start = mapped.start->words;
}

// ---- Text -----------------------------------------------------------------------------------------------------------

namespace {

using Connection = MapTopology::Connection;

double share(const CellMap& map, CellKind kind) { return map.share[static_cast<std::size_t>(kind)]; }

/// Shares are rounded for people.
std::string percent(double share_of_all) { return fmt::format("{:.2f} %", 100 * share_of_all); }

/// Shares rounded down and up: for what is proved to be at least, or at most, so much.
std::string percent_down(double share_of_all) { return fmt::format("{:.2f} %", std::floor(1e4 * share_of_all) / 100); }
std::string percent_up(double share_of_all) { return fmt::format("{:.2f} %", std::ceil(1e4 * share_of_all) / 100); }

std::string axis_text(const ShownAxis& shown, const MapAxis& axis) {
  const std::string range =
      fmt::format("{} from {} to {}", shown.name, value_text(shown, shown.lower), value_text(shown, shown.upper));
  switch (axis.kind) {
    case MapAxis::Kind::kTurn: return range + ", a whole turn";
    case MapAxis::Kind::kTilt: return range + ", which is every tilt";
    case MapAxis::Kind::kRange: break;
  }
  return range + ", its range";
}

const char* text(CellMap::End end) {
  switch (end) {
    case CellMap::End::kShare: return "as little is undecided as was asked for";
    case CellMap::End::kWidth: return "undecided cells are as small as they may get";
    case CellMap::End::kCells: return "there are as many cells as there may be (--cells)";
    case CellMap::End::kTime: return "the time was over (--budget)";
    case CellMap::End::kStopped: break;
  }
  return "it was interrupted";
}

const char* text(Connection connection) {
  switch (connection) {
    case Connection::kJoined: return "joined: a motion exists, and every pose of it is feasible (proved)";
    case Connection::kApart: return "apart: no motion of the coordinates within their ranges joins them (proved)";
    case Connection::kOutside: return "apart: one of them is itself infeasible (proved)";
    case Connection::kOpen: break;
  }
  return "open: cells that are undecided lie between them";
}

void print_components(const char* what, const std::vector<MapComponent>& components) {
  constexpr std::size_t kMost = 6;
  std::string shares;
  for (std::size_t n = 0; n < std::min(components.size(), kMost); ++n) {
    shares += (n == 0 ? "" : ", ") + percent(components[n].volume);
  }
  fmt::print("  {:<26} {}: {}{}\n", what, plural(components.size(), "component"), shares,
             components.size() > kMost ? ", …" : "");
}

/// Shares of the volume in which a pair of bodies is too near, the largest first. A cell is counted for one pair, even
/// where others touch, too.
std::vector<std::pair<double, std::string>> contact_shares(const Problem& problem, const CellMap& map) {
  const std::vector<BodyPair> all = pairs(*problem.bodies);
  std::vector<double> sums(all.size());
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (map.nodes[node].kind == CellKind::kContact) sums.at(map.nodes[node].reason) += cell.volume();
  });
  std::vector<std::pair<double, std::string>> shares;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (sums[n] > 0) shares.emplace_back(sums[n], name(*problem.bodies, all[n]));
  }
  std::ranges::stable_sort(shares, std::ranges::greater(), &std::pair<double, std::string>::first);
  return shares;
}

void print_contacts(const Problem& problem, const CellMap& map) {
  constexpr std::size_t kMost = 4;
  const auto shares = contact_shares(problem, map);
  for (std::size_t n = 0; n < std::min(shares.size(), kMost); ++n) {
    fmt::print("                   {:>9}  {} are too near\n", percent(shares[n].first), sanitize(shares[n].second));
  }
  if (shares.size() > kMost) {
    fmt::print("                   {:>9}  and {}\n", "", plural(shares.size() - kMost, "other pair"));
  }
}

double down(double x) { return std::floor(x); }
double up(double x) { return std::ceil(x); }

/// A share of the space in the units of its volume, "6.99 rad², ", rounded to four digits; empty without units.
std::string size_text(const MapResult& result, double share, double (*rounded)(double)) {
  const std::string unit = volume_unit(result.axes);
  const double size = share * whole_volume(result.axes);
  if (unit.empty() || !(size > 0)) return "";
  const double last = std::pow(10.0, std::floor(std::log10(size)) - 3);
  return fmt::format("{:.4g} {}, ", rounded(size / last) * last, unit);
}

/// Where one may go. What is proved is at least so much.
void print_region(const CaseMap& made) {
  const MapResult& result = made.result();
  const MapRegion& region = *result.region;
  fmt::print("Where motions from {} may go:\n", sanitize(result.start));
  if (region.starts_outside()) {
    fmt::print("  nowhere: it is itself infeasible (proved)\n");
    return;
  }
  const double reachable = region.reachable(), open = region.possible() - reachable, cut_off = 1 - region.possible();
  fmt::print("  reachable, proved  {:>9}  {}joined by motions of which every pose is feasible\n",
             percent_down(reachable), size_text(result, reachable, down));
  fmt::print("  open               {:>9}  {}neither is proved\n", percent_up(open), size_text(result, open, up));
  fmt::print("  cut off, proved    {:>9}  {}outside, or behind it: no motion of the coordinates leads there\n",
             percent_down(cut_off), size_text(result, cut_off, down));
  if (reachable == 0) fmt::print("  The start itself is not proved inside: see --cell and --undecided.\n");
}

}  // namespace

void print(const Case& the_case, const CaseMap& made) {
  const CellMap& map = made.result().map;
  fmt::print("Map of {}, shares of the volume in its coordinates:\n", sanitize(the_case.problem.name));
  for (std::size_t k = 0; k < map.space.size(); ++k) {
    fmt::print("  {}\n", sanitize(axis_text(made.result().axes[k], map.space.axes[k])));
  }
  const double tension = share(map, CellKind::kTension), length = share(map, CellKind::kLength);
  const double unbalanced = share(map, CellKind::kUnbalanced), contact = share(map, CellKind::kContact);
  fmt::print("  inside, proved   {:>9}  every pose holds every load{}{}\n", percent(share(map, CellKind::kInside)),
             the_case.problem.tolerances ? " with every deviation within the tolerances" : "",
             the_case.problem.bodies ? ", and bodies stay clear" : "");
  const bool has_bodies = the_case.problem.bodies.has_value();
  fmt::print("  outside, proved  {:>9}  a tension beyond a limit {}, a length {}, some load not balanced {}{}\n",
             percent(tension + length + unbalanced + contact), percent(tension), percent(length), percent(unbalanced),
             has_bodies ? fmt::format(", bodies too near {}", percent(contact)) : "");
  if (has_bodies) print_contacts(the_case.problem, map);
  fmt::print(
      "  undecided        {:>9}  {}{}\n", percent(map.share[0]), text(map.end),
      map.tolerance_share > 0 ? fmt::format("; {} because of the tolerances", percent(map.tolerance_share)) : "");
  fmt::print("What hangs together:\n");
  print_components("inside", made.result().topology.inside());
  print_components("inside or undecided", made.result().topology.possible());
  for (std::size_t n = 0; n < made.connections().size(); ++n) {
    fmt::print("  from waypoint {} to {} of the query: {}\n", n, n + 1, text(made.connections()[n]));
  }
  if (made.result().region) print_region(made);
  fmt::print("{} from {} judged in {:.2f} s.\n", plural(map.leaves(), "cell"), map.judged, made.seconds());
}

// ---- JSON -----------------------------------------------------------------------------------------------------------

namespace {

const char* name(CellMap::End end) {
  switch (end) {
    case CellMap::End::kShare: return "share";
    case CellMap::End::kWidth: return "width";
    case CellMap::End::kCells: return "cells";
    case CellMap::End::kTime: return "time";
    case CellMap::End::kStopped: break;
  }
  return "stopped";
}

const char* name(Connection connection) {
  switch (connection) {
    case Connection::kJoined: return "joined";
    case Connection::kApart: return "apart";
    case Connection::kOutside: return "outside";
    case Connection::kOpen: break;
  }
  return "open";
}

nlohmann::json to_json(const std::vector<MapComponent>& components) {
  constexpr std::size_t kMost = 100;
  nlohmann::json result = {{"count", components.size()}, {"largest", nlohmann::json::array()}};
  for (std::size_t n = 0; n < std::min(components.size(), kMost); ++n) {
    result["largest"].push_back({{"share", components[n].volume}, {"cells", components[n].cells}});
  }
  return result;
}

/// Where one may go; null without a start.
nlohmann::json region_json(const CaseMap& made) {
  if (!made.result().region) return nullptr;
  const MapRegion& region = *made.result().region;
  return {{"start", made.result().start},
          {"starts_outside", region.starts_outside()},
          {"reachable", region.reachable()},
          {"open", region.possible() - region.reachable()},
          {"cut_off", 1 - region.possible()}};
}

}  // namespace

nlohmann::json to_json(const Case& the_case, const CaseMap& made) {
  const CellMap& map = made.result().map;
  nlohmann::json axes = nlohmann::json::array();
  for (const MapAxis& axis : map.space.axes) {
    axes.push_back(
        {{"name", axis.name}, {"kind", axis_kind_name(axis.kind)}, {"lower", axis.lower}, {"upper", axis.upper}});
  }
  nlohmann::json contacts = nlohmann::json::array();
  if (the_case.problem.bodies) {
    for (const auto& [share, pair] : contact_shares(the_case.problem, map)) {
      contacts.push_back({{"pair", pair}, {"share", share}});
    }
  }
  nlohmann::json connections = nlohmann::json::array();
  for (const Connection connection : made.connections()) connections.push_back(name(connection));
  return {{"command", "map"},
          {"name", the_case.problem.name},
          {"axes", axes},
          {"share",
           {{"inside", share(map, CellKind::kInside)},
            {"tension", share(map, CellKind::kTension)},
            {"length", share(map, CellKind::kLength)},
            {"unbalanced", share(map, CellKind::kUnbalanced)},
            {"contact", share(map, CellKind::kContact)},
            {"undecided", map.share[0]},
            {"undecided_by_tolerances", map.tolerance_share}}},
          {"cells", map.leaves()},
          {"judged", map.judged},
          {"end", name(map.end)},
          {"inside", to_json(made.result().topology.inside())},
          {"possible", to_json(made.result().topology.possible())},
          {"connections", connections},
          {"contacts", contacts},
          {"region", region_json(made)},
          {"map_seconds", made.seconds()},
          {"warnings", the_case.warnings}};
}

}  // namespace taut
