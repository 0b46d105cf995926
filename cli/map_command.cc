// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/map_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "case/case_file.h"
#include "cli/console.h"
#include "cli/no_path_output.h"
#include "cli/number_option.h"
#include "cli/output.h"
#include "map/singular.h"
#include "map/topology.h"
#include "reports/page/map_picture.h"
#include "reports/summary/display_units.h"
#include "reports/summary/load_statement.h"

namespace taut {
namespace {

using Connection = MapTopology::Connection;

/// A map of a case, and what is known of the ways between its waypoints.
struct CaseMap {
  CaseMap(const Problem& problem, const MapSpace& space, const SubdivisionOptions& options)
      : map(subdivide(problem, space, options)), seconds(stopwatch.seconds()), topology(map) {
    for (const auto& waypoint : problem.query) {
      places.push_back(place_of(space, waypoint));
      const std::size_t n = places.size();
      if (n > 1) connections.push_back(topology.connection(places[n - 2], places[n - 1]));
    }
  }
  CaseMap(const CaseMap&) = delete;  // the topology refers to the map
  CaseMap& operator=(const CaseMap&) = delete;

  Stopwatch stopwatch;
  CellMap map;
  double seconds;  ///< to subdivide
  MapTopology topology;
  std::vector<std::vector<MapBox>> places;  ///< of the waypoints
  std::vector<Connection> connections;      ///< from each to the next
};

/// "1 %" or "0.01", strictly between 0 and 1.
double share_of(const std::string& text) {
  std::string_view digits = text;
  const bool is_percent = digits.ends_with('%');
  if (is_percent) digits.remove_suffix(1);
  while (digits.ends_with(' ')) digits.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (is_percent) value /= 100;
  if (error != std::errc() || end != digits.data() + digits.size() || !(value > 0 && value < 1)) {
    throw InputError(
        ErrorCode::kUse,
        fmt::format("--undecided: got '{}', expected a share of the space such as 1% or 0.01", excerpt(text)));
  }
  return value;
}

double share(const CellMap& map, CellKind kind) { return map.share[static_cast<std::size_t>(kind)]; }

// ---- Text -----------------------------------------------------------------------------------------------------------

/// Shares are rounded for people.
std::string percent(double share_of_all) { return fmt::format("{:.2f} %", 100 * share_of_all); }

bool is_length(const Problem& problem, std::size_t axis) {
  const std::string& name = problem.space.parameters[axis].name;
  for (std::size_t i = 0; i < 3; ++i) {
    if (problem.space.pose[i] == name) return true;
  }
  return false;
}

/// An axis in the case's units.
MapPicture::Axis shown_axis(const Problem& problem, const MapSpace& space, std::size_t k, const DisplayUnits& units) {
  constexpr double kDegrees = 57.295779513082320877;
  const MapAxis& axis = space.axes[k];
  const double lower = evaluate_constant<double>(axis.lower), upper = evaluate_constant<double>(axis.upper);
  if (is_length(problem, k)) {
    return {fmt::format("{} [{}]", axis.name, units.length.name()), units.length.approx(lower),
            units.length.approx(upper)};
  }
  const double factor = units.in_degrees ? kDegrees : 1;
  return {fmt::format("{} [{}]", axis.name, units.in_degrees ? "°" : "rad"), factor * lower, factor * upper};
}

std::string axis_text(const MapPicture::Axis& shown, const MapAxis& axis) {
  const std::string range = fmt::format("{} from {:.5g} to {:.5g}", shown.title, shown.lower, shown.upper);
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
    case Connection::kApart: return "apart: no motion within the space joins them (proved)";
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

void print(const Case& the_case, const CaseMap& made) {
  const CellMap& map = made.map;
  const DisplayUnits units(the_case.units);
  fmt::print("Map of {}, shares of the volume in its coordinates:\n", sanitize(the_case.problem.name));
  for (std::size_t k = 0; k < map.space.size(); ++k) {
    const MapPicture::Axis shown = shown_axis(the_case.problem, map.space, k, units);
    fmt::print("  {}\n", sanitize(axis_text(shown, map.space.axes[k])));
  }
  const double tension = share(map, CellKind::kTension), length = share(map, CellKind::kLength);
  const double unbalanced = share(map, CellKind::kUnbalanced);
  fmt::print("  inside, proved   {:>9}  every pose holds every load{}\n", percent(share(map, CellKind::kInside)),
             the_case.problem.tolerances ? " with every deviation within the tolerances" : "");
  fmt::print("  outside, proved  {:>9}  a tension beyond a limit {}, a length {}, some load not balanced {}\n",
             percent(tension + length + unbalanced), percent(tension), percent(length), percent(unbalanced));
  fmt::print(
      "  undecided        {:>9}  {}{}\n", percent(map.share[0]), text(map.end),
      map.tolerance_share > 0 ? fmt::format("; {} because of the tolerances", percent(map.tolerance_share)) : "");
  fmt::print("What hangs together:\n");
  print_components("inside", made.topology.inside());
  print_components("inside or undecided", made.topology.possible());
  for (std::size_t n = 0; n < made.connections.size(); ++n) {
    fmt::print("  from waypoint {} to {} of the query: {}\n", n, n + 1, text(made.connections[n]));
  }
  fmt::print("{} from {} judged in {:.2f} s.\n", plural(map.leaves(), "cell"), map.judged, made.seconds);
}

// ---- JSON -----------------------------------------------------------------------------------------------------------

const char* name(MapAxis::Kind kind) {
  switch (kind) {
    case MapAxis::Kind::kRange: return "range";
    case MapAxis::Kind::kTurn: return "turn";
    case MapAxis::Kind::kTilt: break;
  }
  return "tilt";
}

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

nlohmann::json to_json(const Case& the_case, const CaseMap& made) {
  const CellMap& map = made.map;
  nlohmann::json axes = nlohmann::json::array();
  for (const MapAxis& axis : map.space.axes) {
    axes.push_back({{"name", axis.name}, {"kind", name(axis.kind)}, {"lower", axis.lower}, {"upper", axis.upper}});
  }
  nlohmann::json connections = nlohmann::json::array();
  for (const Connection connection : made.connections) connections.push_back(name(connection));
  return {{"command", "map"},
          {"name", the_case.problem.name},
          {"axes", axes},
          {"share",
           {{"inside", share(map, CellKind::kInside)},
            {"tension", share(map, CellKind::kTension)},
            {"length", share(map, CellKind::kLength)},
            {"unbalanced", share(map, CellKind::kUnbalanced)},
            {"undecided", map.share[0]},
            {"undecided_by_tolerances", map.tolerance_share}}},
          {"cells", map.leaves()},
          {"judged", map.judged},
          {"end", name(map.end)},
          {"inside", to_json(made.topology.inside())},
          {"possible", to_json(made.topology.possible())},
          {"connections", connections},
          {"map_seconds", made.seconds},
          {"warnings", the_case.warnings}};
}

// ---- Picture --------------------------------------------------------------------------------------------------------

std::string picture(const Case& the_case, const CaseMap& made) {
  constexpr double kEnclosure = 1.0 / 1024;  // of det J = 0
  const DisplayUnits units(the_case.units);
  const std::string& title = the_case.document_fields.title;
  MapPicture result{title.empty() ? the_case.problem.name : title, {}, {}, {}};
  for (std::size_t k = 0; k < 2; ++k) result.axes.at(k) = shown_axis(the_case.problem, made.map.space, k, units);
  result.singular = singular_cells(the_case.problem, made.map, kEnclosure);
  for (std::size_t n = 0; n < made.places.size(); ++n) {
    const MapBox& box = made.places[n].front();
    const std::string label = n == 0 ? "start" : n + 1 == made.places.size() ? "goal" : fmt::format("{}", n + 1);
    result.marks.push_back({label, {0.5 * (box.lower[0] + box.upper[0]), 0.5 * (box.lower[1] + box.upper[1])}});
  }
  return map_svg(made.map, result);
}

}  // namespace

void add_map_options(CLI::App& command, MapArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md)")->required();
  command.add_option("--undecided", arguments.undecided,
                     "share of the space that may stay undecided (default: 1% of two coordinates, 10% of three)");
  command
      .add_option("--cell", arguments.least_width,
                  "least width of a cell, as a share of each coordinate's range (default: 0.0005)")
      ->check(number("a share between 0 and 1", [](double x) { return x > 0 && x < 1; }));
  command.add_option("--budget", arguments.seconds, "seconds after which cells are halved no further")
      ->check(positive_number("a number of seconds above 0"));
  command
      .add_option("--cells", arguments.most_cells,
                  "the most cells, each of which takes up to 120 bytes of memory (default: 20000000)")
      ->check(CLI::Range(std::size_t{10'000}, std::size_t{1'000'000'000}));
  command.add_option("--out", arguments.out,
                     "folder to write map.svg to, a picture of two coordinates, and where waypoints of the query are "
                     "apart, certificate.json, which proves it");
  command.add_flag("--json", arguments.json, "print the result as JSON");
}

int run_map(const MapArguments& arguments) {
  const Stopwatch stopwatch;
  MapSpace space;
  const Case the_case =
      load_case(arguments.case_path, [&](const Case& read) { space = make_map_space(read.problem.space); });
  if (!arguments.out.empty() && space.size() != 2) {
    throw InputError(ErrorCode::kUse, fmt::format("--out: got a case with {} free coordinates, expected two, because "
                                                  "the picture is flat",
                                                  space.size()));
  }
  const Interruption interruption;
  SubdivisionOptions options;
  options.undecided_share = space.size() == 2 ? 0.01 : 0.1;
  if (!arguments.undecided.empty()) options.undecided_share = share_of(arguments.undecided);
  options.least_width = arguments.least_width;
  options.most_cells = arguments.most_cells;
  options.seconds = arguments.seconds;
  options.stop = interruption.token();
  announce(the_case, arguments.json);
  const CaseMap made(the_case.problem, space, options);
  if (made.map.end == CellMap::End::kStopped) return report_interruption("map", "interrupted", arguments.json);

  std::vector<std::filesystem::path> files;
  if (!arguments.out.empty()) {
    make_directories(arguments.out);
    files.push_back(std::filesystem::path(arguments.out) / "map.svg");
    write_whole({{files.front(), picture(the_case, made)}});
    if (std::ranges::find(made.connections, Connection::kApart) != made.connections.end()) {
      for (const auto& file : write_no_path(the_case, arguments.out, interruption.token())) files.push_back(file);
    }
  }
  if (arguments.json) {
    nlohmann::json document = to_json(the_case, made);
    document["load"] = to_json(load_statement(the_case));
    add_ending(document, stopwatch, kProvedExit, files);
    print_json(document);
  } else {
    print(the_case, made);
    for (const std::filesystem::path& file : files) fmt::print("Written: {}\n", sanitize(file.string()));
  }
  return kProvedExit;
}

}  // namespace taut
