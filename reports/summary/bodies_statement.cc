// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/bodies_statement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/plural.h"
#include "problem/expression.h"
#include "problem/rational.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using ExactPoint = std::array<Rational, 3>;

ExactPoint exact_point(const PointText& point) {
  return {parse_rational(point[0]), parse_rational(point[1]), parse_rational(point[2])};
}

/// Lengths from 1 m on are in m, smaller ones in mm; all are exact.
struct LengthUnit {
  const char* name;
  int per_metre;
  explicit LengthUnit(const Rational& largest)
      : name(largest == 0 || largest >= 1 ? "m" : "mm"), per_metre(largest == 0 || largest >= 1 ? 1 : 1000) {}
  [[nodiscard]] std::string text(const Rational& metres) const { return rational_text(metres * per_metre); }
};

/// "200 mm", "0 m"
std::string exact_length(const Rational& metres) {
  const LengthUnit unit(abs(metres));
  return fmt::format("{} {}", unit.text(metres), unit.name);
}
std::string exact_length(const DecimalText& metres) { return exact_length(parse_rational(metres)); }

Rational largest_of(const ExactPoint& point) {
  return std::max({Rational(abs(point[0])), Rational(abs(point[1])), Rational(abs(point[2]))});
}

/// "(0, 1, 1.3) m"
std::string exact_place(const ExactPoint& point) {
  const LengthUnit unit(largest_of(point));
  return fmt::format("({}, {}, {}) {}", unit.text(point[0]), unit.text(point[1]), unit.text(point[2]), unit.name);
}

/// "2.4 × 6.1 × 2.6 m"
std::string exact_sides(const ExactPoint& sides) {
  const LengthUnit unit(largest_of(sides));
  return fmt::format("{} × {} × {} {}", unit.text(sides[0]), unit.text(sides[1]), unit.text(sides[2]), unit.name);
}

/// Whether the angle is 0, to be seen from how it was typed.
bool is_zero(const ExpressionText& radians) { return angle_text(radians) == "0°"; }

bool is_turned(const BodyText& body) { return !std::ranges::all_of(body.rotation_rad, is_zero); }

/// " at (0, 1, 1.3) m, turned by yaw 10°"; empty where the body is not moved.
std::string placement_text(const BodyText& body) {
  std::string text;
  const ExactPoint at = exact_point(body.at_m);
  if (at != ExactPoint{}) text = " at " + exact_place(at);
  constexpr std::array<const char*, 3> kAngles = {"roll", "pitch", "yaw"};
  std::vector<std::string> turns;
  for (std::size_t k = 0; k < 3; ++k) {
    const ExpressionText& angle = body.rotation_rad[k];
    if (!is_zero(angle)) turns.push_back(fmt::format("{} {}", kAngles[k], angle_text(angle)));
  }
  return turns.empty() ? text : fmt::format("{}, turned by {}", text, fmt::join(turns, ", "));
}

struct ExtentOfPoints {
  ExactPoint lower, upper;
  [[nodiscard]] ExactPoint sides() const { return {upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]}; }
};

ExtentOfPoints extent_of(const std::vector<ExactPoint>& points) {
  ExtentOfPoints extent{points.front(), points.front()};
  for (const ExactPoint& point : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      extent.lower[k] = std::min(extent.lower[k], point[k]);
      extent.upper[k] = std::max(extent.upper[k], point[k]);
    }
  }
  return extent;
}

/// Whether the points are the eight corners of a box along the axes.
bool are_corners_of_box(const std::vector<ExactPoint>& points, const ExtentOfPoints& extent) {
  const auto is_corner = [&](const ExactPoint& point) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (point[k] != extent.lower[k] && point[k] != extent.upper[k]) return false;
    }
    return true;
  };
  const bool is_thick = std::ranges::none_of(extent.sides(), [](const Rational& side) { return side == 0; });
  return is_thick && points.size() == 8 && std::ranges::all_of(points, is_corner) &&
         std::set<ExactPoint>(points.begin(), points.end()).size() == 8;
}

std::string hull_text(const BodyText& body, const HullText& hull) {
  std::vector<ExactPoint> points;
  for (const PointText& point : hull.points_m) points.push_back(exact_point(point));
  const Rational radius = parse_rational(hull.radius_m);
  std::string placement = placement_text(body);
  if (points.size() <= 2 && !is_turned(body)) {  // named by where it is
    const ExactPoint at = exact_point(body.at_m);
    for (ExactPoint& point : points) {
      for (std::size_t k = 0; k < 3; ++k) point[k] += at[k];
    }
    placement.clear();
  }
  const std::string around = radius == 0 ? "" : fmt::format("all within {} of ", exact_length(radius));
  if (points.size() == 1) {
    if (radius == 0) return fmt::format("the point {}{}", exact_place(points[0]), placement);
    return fmt::format("a ball of radius {} around {}{}", exact_length(radius), exact_place(points[0]), placement);
  }
  if (points.size() == 2) {
    return fmt::format("{}the segment from {} to {}{}", around, exact_place(points[0]), exact_place(points[1]),
                       placement);
  }
  const ExtentOfPoints extent = extent_of(points);
  if (are_corners_of_box(points, extent)) {
    ExactPoint middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = (extent.lower[k] + extent.upper[k]) / 2;
    const std::string centre = middle == ExactPoint{} ? "" : fmt::format(" around {}", exact_place(middle));
    return fmt::format("{}a box of {}{}{}", around, exact_sides(extent.sides()), centre, placement);
  }
  return fmt::format("{}the convex hull of {} points from {} to {}{}", around, points.size(), exact_place(extent.lower),
                     exact_place(extent.upper), placement);
}

/// "(0, 0, 1)"
std::string normal_text(const PointText& normal) {
  const ExactPoint n = exact_point(normal);
  return fmt::format("({}, {}, {})", rational_text(n[0]), rational_text(n[1]), rational_text(n[2]));
}

std::string body_text(const BodyText& body, bool is_obstacle) {
  std::string text = is_obstacle ? "obstacle: " : "on the platform: ";
  if (const auto* hull = std::get_if<HullText>(&body.shape)) {
    text += hull_text(body, *hull);
  } else if (const auto* half_space = std::get_if<HalfSpaceText>(&body.shape)) {
    text += fmt::format("all behind the plane through {}, which faces along {}", exact_place(exact_point(body.at_m)),
                        normal_text(half_space->normal));
  } else {
    const auto& mesh = std::get<MeshText>(body.shape);
    text += fmt::format("the mesh {}, in units of {}{}", quoted_name(mesh.file), exact_length(mesh.unit_m),
                        placement_text(body));
  }
  if (has_no_inside(body)) text += "; it has no inside: only its surface is checked";
  if (body.clearance_m) text += fmt::format("; clearance {}", exact_length(*body.clearance_m));
  return text;
}

/// "200 mm", or "10 mm to 200 mm, as some have their own".
std::string clearance_text(const DecimalText& of_class, const std::vector<BodyPair>& all, PairClass kind) {
  std::vector<Rational> clearances;
  for (const BodyPair& pair : all) {
    if (pair.kind == kind) clearances.push_back(parse_rational(pair.clearance_m));
  }
  if (clearances.empty()) return exact_length(of_class);
  const auto [least, most] = std::ranges::minmax(clearances);
  if (least == most) return exact_length(least);
  return fmt::format("{} to {}, as some have their own", exact_length(least), exact_length(most));
}

std::string checked_text(const BodiesText& bodies) {
  std::array<std::size_t, kPairClasses + 1> counts{};  // exit cones last
  const std::vector<BodyPair> all = pairs(bodies);
  for (const BodyPair& pair : all) ++counts.at(static_cast<std::size_t>(pair.kind));
  std::vector<std::string> checked, others;
  for (const PairClass kind : all_pair_classes()) {
    const auto k = static_cast<std::size_t>(kind);
    if (!bodies.clearance_m[k]) {
      others.emplace_back(words_of(kind));
      continue;
    }
    checked.push_back(fmt::format("{}, {}, {}", words_of(kind), plural(counts[k], "pair"),
                                  clearance_text(*bodies.clearance_m[k], all, kind)));
  }
  std::string text = checked.empty() ? "" : fmt::format("Pairs and their clearances: {}.", fmt::join(checked, "; "));
  if (others.empty()) return text;
  return fmt::format("{}{}Not checked: {}.", text, text.empty() ? "" : " ", fmt::join(others, ", "));
}

std::string cables_text(const BodiesText& bodies) {
  const bool are_checked = bodies.clearance_m[1] || bodies.clearance_m[2] || bodies.clearance_m[3];
  if (!are_checked) return "";
  const CableBodiesText& cables = bodies.cables;
  const auto one = [&](std::size_t i) {
    return fmt::format("{} thick, not checked on the {} near the base and the {} near the platform",
                       exact_length(cables.diameter_m[i]), exact_length(cables.free_ends_m[i][0]),
                       exact_length(cables.free_ends_m[i][1]));
  };
  std::vector<std::string> each;
  for (std::size_t i = 0; i < kCables; ++i) each.push_back(one(i));
  if (std::ranges::all_of(each, [&](const std::string& text) { return text == each[0]; })) {
    return fmt::format("Cables: {}.", each[0]);
  }
  for (std::size_t i = 0; i < kCables; ++i) each[i] = fmt::format("{}: {}", i + 1, each[i]);
  return fmt::format("Cables: {}.", fmt::join(each, "; "));
}

/// "Exit cones: cable 1 at the base, 60° around (0, 0, -1); …."
std::string exit_cones_text(const std::vector<ExitConeText>& cones) {
  std::string text;
  for (const ExitConeText& cone : cones) {
    text +=
        fmt::format("{}{} at the {}, {} around {}", text.empty() ? "Exit cones, in half-angles: " : "; ",
                    cable_name(cone.cable), name(cone.end), angle_text(cone.half_angle_rad), normal_text(cone.axis));
  }
  return text.empty() ? text : text + ".";
}

/// What was repaired, and whether there is an inside.
std::string mesh_note(const BodyText& body, const LoadedMesh& loaded) {
  const MeshReport& report = loaded.report;
  const Rational unit_m = parse_rational(std::get<MeshText>(body.shape).unit_m);
  const auto millimetres_of = [&](double x) {
    return fmt::format("{:.6g}", x * Rational(unit_m * 1000).convert_to<double>() + 0.0);
  };
  const auto corner = [&](const std::array<double, 3>& p) {
    return fmt::format("({}, {}, {})", millimetres_of(p[0]), millimetres_of(p[1]), millimetres_of(p[2]));
  };
  std::string text =
      fmt::format("{}: {}, from {} to {} mm in its own axes", quoted_name(body.name),
                  plural(loaded.mesh.triangles.size(), "triangle"), corner(report.lower), corner(report.upper));
  text += report.is_watertight() ? fmt::format(", watertight, {}", plural(report.closed_components, "closed part"))
                                 : fmt::format(
                                       ", not watertight: {} of one triangle, {} of more than two: it has no "
                                       "inside, and only its surface is checked",
                                       plural(report.edges_of_one, "edge"), report.edges_of_many);
  if (report.is_watertight() && has_no_inside(body)) {
    text += ", but a part has one side only: it has no inside, and only its surface is checked";
  }
  std::vector<std::string> repairs;
  const auto add = [&](std::size_t count, const char* what, const char* done) {
    if (count > 0) repairs.push_back(fmt::format("{} {}", plural(count, what), done));
  };
  add(report.split_faces, "face", "split into triangles");
  add(report.merged_points, "point", "merged with an equal one");
  add(report.unused_points, "unused point", "left out");
  add(report.dropped_triangles, "triangle", "left out: it is there twice, or is a segment, which stays");
  add(report.flat_triangles, "triangle", "without area kept");
  return repairs.empty() ? text : fmt::format("{}; {}", text, fmt::join(repairs, ", "));
}

const BodyText* find_body(const BodiesText& bodies, const std::string& name) {
  for (const auto* list : {&bodies.platform, &bodies.obstacles}) {
    const auto found = std::ranges::find(*list, name, &BodyText::name);
    if (found != list->end()) return &*found;
  }
  return nullptr;
}

}  // namespace

const char* words_of(PairClass kind) {
  switch (kind) {
    case PairClass::kPlatformObstacles: return "platform and obstacles";
    case PairClass::kCablesObstacles: return "cables and obstacles";
    case PairClass::kCablesCables: return "cables among each other";
    case PairClass::kCablesPlatform: return "cables and platform";
    case PairClass::kExitCones: break;
  }
  return "cables and their exit cones";
}

bool has_no_inside(const BodyText& body) {
  const auto* mesh = std::get_if<MeshText>(&body.shape);
  return mesh != nullptr && mesh->mesh != nullptr && !mesh->mesh->is_watertight();
}

std::vector<std::string> bodies_without_inside(const BodiesText& bodies) {
  std::vector<std::string> names;
  for (const auto* list : {&bodies.obstacles, &bodies.platform}) {
    for (const BodyText& body : *list) {
      if (has_no_inside(body)) names.push_back(quoted_name(body.name));
    }
  }
  return names;
}

std::vector<PairClass> unchecked_classes(const BodiesText& bodies) {
  std::vector<PairClass> result;
  for (const PairClass kind : all_pair_classes()) {
    if (!bodies.clearance_m[static_cast<std::size_t>(kind)]) result.push_back(kind);
  }
  return result;
}

std::string pair_words(const BodiesText& bodies, const BodyPair& pair) {
  const auto [first, second] = names(bodies, pair);
  if (pair.kind == PairClass::kCablesCables) return fmt::format("cables {} and {}", pair.first + 1, pair.second + 1);
  if (pair.kind == PairClass::kPlatformObstacles) {
    return fmt::format("{} and {}", quoted_name(first), quoted_name(second));
  }
  if (pair.kind == PairClass::kExitCones) return fmt::format("{} and its {}", first, second);
  return fmt::format("{} and {}", first, quoted_name(second));
}

BodiesStatement bodies_statement(const BodiesText& bodies) {
  BodiesStatement result;
  result.checked = checked_text(bodies);
  result.cables = cables_text(bodies);
  for (const BodyText& body : bodies.platform) result.bodies.emplace_back(body.name, body_text(body, false));
  for (const BodyText& body : bodies.obstacles) result.bodies.emplace_back(body.name, body_text(body, true));
  for (const auto& [pair, clearance] : bodies.pair_clearances_m) {
    result.notes.push_back(
        fmt::format("{} and {}: clearance {}", quoted_name(pair[0]), quoted_name(pair[1]), exact_length(clearance)));
  }
  for (const auto& [pair, zone] : bodies.contacts) {
    result.contacts +=
        fmt::format("{}{} and {}, up to {} deep, while the platform's origin is within {} of {}",
                    result.contacts.empty() ? "These may touch: " : "; ", quoted_name(pair[0]), quoted_name(pair[1]),
                    exact_length(zone.depth_m), exact_length(zone.within_m), exact_place(exact_point(zone.at_m)));
  }
  if (!result.contacts.empty()) result.contacts += ".";
  result.exit_cones = exit_cones_text(bodies.exit_cones);
  return result;
}

std::string clear_bodies(const std::optional<BodiesText>& bodies, const char* before) {
  if (!bodies) return "";
  std::vector<std::string> clauses;
  if (unchecked_classes(*bodies).size() < all_pair_classes().size()) {
    clauses.push_back(fmt::format("all checked bodies keep their clearances{}", but_in_contacts(*bodies)));
  }
  if (!bodies->exit_cones.empty()) clauses.emplace_back("cables that have exit cones stay in them");
  return clauses.empty() ? "" : fmt::format("{}{}", before, fmt::join(clauses, ", and "));
}

const char* but_in_contacts(const BodiesText& bodies) {
  return bodies.contacts.empty() ? "" : ", but where they may touch";
}

BodiesStatement bodies_statement(const CaseBodies& bodies) {
  BodiesStatement result = bodies_statement(bodies.text);
  for (const EnclosedCylinder& cylinder : bodies.cylinders) {
    result.notes.push_back(fmt::format("{}: a prism takes the place of the cylinder, and reaches up to {} farther",
                                       quoted_name(cylinder.body), exact_length(cylinder.excess_m)));
  }
  for (const MeshOfBody& mesh : bodies.meshes) {
    const BodyText* body = find_body(bodies.text, mesh.body);
    if (!body) continue;
    result.notes.push_back(mesh_note(*body, *mesh.mesh));
  }
  return result;
}

std::vector<std::string> lines(const BodiesStatement& statement) {
  std::vector<std::string> result;
  for (const std::string& line : {statement.checked, statement.contacts, statement.cables, statement.exit_cones}) {
    if (!line.empty()) result.push_back(line);
  }
  for (const auto& [name, words] : statement.bodies) result.push_back(fmt::format("{}, {}.", quoted_name(name), words));
  for (const std::string& note : statement.notes) result.push_back(note + ".");
  return result;
}

nlohmann::json to_json(const BodiesText& bodies, const BodiesStatement& statement) {
  std::array<std::size_t, kPairClasses + 1> counts{};  // exit cones last
  for (const BodyPair& pair : pairs(bodies)) ++counts.at(static_cast<std::size_t>(pair.kind));
  nlohmann::json checked = nlohmann::json::array();
  nlohmann::json not_checked = nlohmann::json::array();
  for (const PairClass kind : all_pair_classes()) {
    const auto k = static_cast<std::size_t>(kind);
    if (bodies.clearance_m[k]) {
      checked.push_back({{"class", name(kind)},
                         {"pairs", counts[k]},
                         {"clearance_m", ScalarTraits<double>::from_decimal(*bodies.clearance_m[k])}});
    } else {
      not_checked.push_back(name(kind));
    }
  }
  return {{"checked", checked}, {"not_checked", not_checked}, {"text", lines(statement)}};
}

nlohmann::json stated_bodies_json(const std::optional<CaseBodies>& bodies) {
  return bodies ? to_json(bodies->text, bodies_statement(*bodies)) : nlohmann::json();
}

}  // namespace taut
