// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/caspr.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "case/case_file.h"
#include "cli/xml_element.h"
#include "problem/decimal.h"
#include "problem/scalar.h"

namespace taut {
namespace {

using Point = std::array<DecimalText, 3>;

constexpr double kGravity = 9.81;       // m/s^2, along -z: CASPR's SystemModel.GRAVITY_CONSTANT
constexpr double kAssumedShare = 0.01;  // of the weight, by which the load may differ: CASPR's files say nothing

// --- What the files say ---------------------------------------------------------------------------------------------

/// Decimals separated by white space.
std::vector<DecimalText> decimals(const XmlElement& place, const std::string& what, const std::string& text,
                                  std::size_t count) {
  std::istringstream words(text);
  std::vector<DecimalText> result;
  for (std::string word; words >> word;) {
    try {
      static_cast<void>(Decimal::parse(word));
    } catch (const InputError& error) {
      place.fail(fmt::format("{}'{}'", what, excerpt(word)), "a decimal number such as 0.05 or 1e-4");
    }
    result.push_back(word);
  }
  if (result.size() != count) {
    place.fail(fmt::format("{}'{}', {} numbers", what, excerpt(text), result.size()), std::to_string(count));
  }
  return result;
}

DecimalText decimal(const XmlElement& element) { return decimals(element, "", element.text(), 1)[0]; }

Point point(const XmlElement& element) {
  const std::vector<DecimalText> all = decimals(element, "", element.text(), 3);
  return {all[0], all[1], all[2]};
}

double approx(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

Eigen::Vector3d approx(const Point& point) { return {approx(point[0]), approx(point[1]), approx(point[2])}; }

bool is_zero(const Point& point) {
  return std::ranges::all_of(point, [](const DecimalText& text) { return Decimal::parse(text).sign() == 0; });
}

/// The exact sum of two points.
Point sum(const XmlElement& place, const Point& a, const Point& b) {
  if (is_zero(b)) return a;
  Point result;
  for (std::size_t k = 0; k < 3; ++k) {
    auto exact = Decimal::parse(a[k]).rational() + Decimal::parse(b[k]).rational();
    int exponent = 0;
    for (; denominator(exact) != 1; --exponent) exact *= 10;
    try {
      result[k] = Decimal::parse(fmt::format("{}e{}", numerator(exact).str(), exponent)).text();
    } catch (const InputError&) {
      place.fail("numbers whose sum has too many digits", "coordinates of a robot");
    }
  }
  return result;
}

struct Body {
  std::string name;
  DecimalText mass;
  Point center_of_mass;          ///< from the body's joint
  std::optional<Point> start;    ///< of the joint, in the world
  Eigen::Vector3d start_angles;  ///< CASPR's alpha, beta, gamma [rad]
  std::optional<std::array<Point, 2>> position_range;
  std::string angle_range;  ///< as the file states it, if it is less than whole turns
};

struct Cable {
  Point base, platform;
  std::array<DecimalText, 2> force;
};

/// The range of the pose, if the joint states one.
void read_range(const XmlElement& joint, const Point& parent, Body& body) {
  if (!joint.has_attribute("q_min") && !joint.has_attribute("q_max")) return;
  std::array<std::vector<DecimalText>, 2> ends;
  body.position_range.emplace();
  for (std::size_t side = 0; side < 2; ++side) {
    const char* const name = side == 0 ? "q_min" : "q_max";
    ends[side] = decimals(joint, std::string(name) + " ", joint.attribute(name), 6);
    (*body.position_range)[side] = sum(joint, {ends[side][0], ends[side][1], ends[side][2]}, parent);
  }
  for (std::size_t k = 3; k < 6; ++k) {
    constexpr double kHalfTurn = 3.14;  // CASPR's files write pi as 3.1416, or 3.14
    if (approx(ends[0][k]) <= -kHalfTurn && approx(ends[1][k]) >= kHalfTurn) continue;
    body.angle_range =
        fmt::format("{} {} {} to {} {} {}", ends[0][3], ends[0][4], ends[0][5], ends[1][3], ends[1][4], ends[1][5]);
  }
}

void read_joint(const XmlElement& link, Body& body) {
  const XmlElement joint = link.child("joint");
  joint.require_known({}, {"type", "q_initial", "q_min", "q_max", "actuated"});
  if (const std::string type = joint.attribute("type"); type != "SPATIAL_EULER_XYZ") {
    joint.fail(fmt::format("type '{}'", excerpt(type)), "SPATIAL_EULER_XYZ: a body that is free to move in space");
  }
  if (joint.has_attribute("actuated") && joint.attribute("actuated") != "false") {
    joint.fail("an actuated joint", "a body that only its cables hold");
  }
  const XmlElement parent = link.child("parent");
  parent.require_known({"num", "location"}, {});
  if (const std::string number = parent.child("num").text(); number != "0") {
    parent.fail(fmt::format("the parent '{}'", excerpt(number)), "0, the base");
  }
  const Point origin = point(parent.child("location"));
  if (joint.has_attribute("q_initial")) {
    const std::vector<DecimalText> q = decimals(joint, "q_initial ", joint.attribute("q_initial"), 6);
    body.start = sum(joint, {q[0], q[1], q[2]}, origin);
    body.start_angles = {approx(q[3]), approx(q[4]), approx(q[5])};
  }
  read_range(joint, origin, body);
}

Body read_body(const XmlElement& root) {
  const bool is_system = root.name() == "bodies_system";
  if (is_system) root.require_known({"links", "operational_spaces"}, {});
  const XmlElement links = is_system ? root.child("links") : root;
  links.require_known({"link_rigid"}, {"display_range", "view_angle"});
  if (const std::size_t count = links.children().size(); count != 1) {
    links.fail(fmt::format("{} links", count), "one: taut's platform is a single rigid body");
  }
  const XmlElement link = links.child("link_rigid");
  link.require_known({"joint", "physical", "parent"}, {"num", "name"});
  if (const std::string number = link.attribute("num"); number != "1") {
    link.fail(fmt::format("num '{}'", excerpt(number)), "1");
  }
  const XmlElement physical = link.child("physical");
  physical.require_known({"mass", "com_location", "end_location", "inertia"}, {});
  const XmlElement mass = physical.child("mass");
  Body body;
  body.name = link.has_attribute("name") ? link.attribute("name") : "";
  body.mass = decimal(mass);
  if (Decimal::parse(body.mass).sign() <= 0) mass.fail(fmt::format("'{}'", body.mass), "a mass above 0");
  body.center_of_mass = point(physical.child("com_location"));
  read_joint(link, body);
  return body;
}

/// The set that was asked for, or the file's default.
XmlElement chosen_set(const XmlElement& root, const std::string& wanted) {
  root.require_known({"cable_set"}, {"default_cable_set"});
  const std::string id = !wanted.empty() ? wanted : root.attribute("default_cable_set");
  std::string known;
  std::optional<XmlElement> found;
  for (const XmlElement& set : root.children()) {
    const std::string name = set.attribute("id");
    known += (known.empty() ? "'" : ", '") + excerpt(name) + "'";
    if (name != id) continue;
    if (found) set.fail(fmt::format("a second cable_set '{}'", excerpt(id)), "one");
    found = set;
  }
  if (!found) {
    root.fail(fmt::format("no cable_set '{}'{}", excerpt(id), wanted.empty() ? ", its default" : ""),
              known.empty() ? "one" : known);
  }
  return *found;
}

Cable read_cable(const XmlElement& element, const Point& center_of_mass) {
  element.require_known({"properties", "attachments"}, {"name", "attachment_reference"});
  const XmlElement properties = element.child("properties");
  properties.require_known({"force_min", "force_max", "diameter"}, {});
  const std::string reference = element.attribute("attachment_reference");
  if (reference != "joint" && reference != "com") {
    element.fail(fmt::format("attachment_reference '{}'", excerpt(reference)), "'joint' or 'com'");
  }
  const XmlElement attachments = element.child("attachments");
  for (const XmlElement& end : attachments.children()) {
    if (end.name() == "attachment") continue;
    end.fail(fmt::format("<{}>", excerpt(end.name())), "<attachment>: taut's cables run between points, not pulleys");
  }
  attachments.require_known({"attachment"}, {});
  const std::vector<XmlElement> ends = attachments.children();
  if (ends.size() != 2) {
    attachments.fail(fmt::format("{} attachments", ends.size()), "2: one of the base, one of the platform");
  }
  Cable cable;
  cable.force = {decimal(properties.child("force_min")), decimal(properties.child("force_max"))};
  std::array<int, 2> count = {0, 0};
  for (const XmlElement& end : ends) {
    end.require_known({"link", "location"}, {});
    const std::string link = end.child("link").text();
    if (link != "0" && link != "1") end.child("link").fail(fmt::format("'{}'", excerpt(link)), "0 (base) or 1");
    const Point location = point(end.child("location"));
    ++count[link == "0" ? 0 : 1];
    (link == "0" ? cable.base : cable.platform) =
        link == "1" && reference == "com" ? sum(end, location, center_of_mass) : location;
  }
  if (count[0] != 1) attachments.fail("both ends on one link", "one of the base (0) and one of the platform (1)");
  return cable;
}

std::vector<Cable> read_cables(const XmlElement& set, const Point& center_of_mass) {
  std::vector<Cable> cables;
  const std::vector<XmlElement> elements = set.children();
  for (const XmlElement& element : elements) {
    if (element.name() == "cable_ideal") continue;
    element.fail(fmt::format("<{}>", excerpt(element.name())), "<cable_ideal>: taut's cables are straight and rigid");
  }
  set.require_known({"cable_ideal"}, {"id"});
  if (elements.size() != kCables) set.fail(fmt::format("{} cables", elements.size()), "6, as taut's robots have");
  for (const XmlElement& element : elements) cables.push_back(read_cable(element, center_of_mass));
  return cables;
}

// --- What the case says ---------------------------------------------------------------------------------------------

/// mantissa 10^exponent, with the mantissa 1, 2 or 5: the largest that is at most `value`.
struct Round {
  int mantissa = 1;
  int exponent = 0;
  [[nodiscard]] double value() const { return mantissa * std::pow(10.0, exponent); }
  /// 1/value^2, exactly.
  [[nodiscard]] std::string inverse_square() const {
    const int digits = mantissa == 1 ? 1 : mantissa == 2 ? 25 : 4;
    return fmt::format("{}e{}", digits, -2 * exponent - (mantissa == 1 ? 0 : 2));
  }
};

Round rounded_down(double value) {
  if (!(value > 0) || !std::isfinite(value)) return {};  // then reading the case says what is wrong
  const int exponent = static_cast<int>(std::floor(std::log10(value)));
  const double leading = value / std::pow(10.0, exponent);
  return {leading >= 5 ? 5 : leading >= 2 ? 2 : 1, exponent};
}

/// The smallest such number that is at least `value`.
Round rounded_up(double value) {
  const Round below = rounded_down(value);
  if (below.value() >= value) return below;
  if (below.mantissa == 5) return {1, below.exponent + 1};
  return {below.mantissa == 1 ? 2 : 5, below.exponent};
}

std::string bracketed(const Point& point) { return fmt::format("[{}, {}, {}]", point[0], point[1], point[2]); }

/// The box for the platform's origin: the joint's range, or one around the base and as far below it as it is wide.
std::array<Point, 2> box_of(const Body& body, const std::vector<Cable>& cables) {
  if (body.position_range) return *body.position_range;
  Eigen::Vector3d lower = approx(cables[0].base);
  Eigen::Vector3d upper = lower;
  for (const Cable& cable : cables) {
    lower = lower.cwiseMin(approx(cable.base));
    upper = upper.cwiseMax(approx(cable.base));
  }
  lower(2) -= std::max(upper(0) - lower(0), upper(1) - lower(1));
  if (body.start) {
    const Eigen::Vector3d around = 0.05 * (upper - lower);
    lower = lower.cwiseMin(approx(*body.start) - around);
    upper = upper.cwiseMax(approx(*body.start) + around);
  }
  std::array<Point, 2> box;
  for (int k = 0; k < 3; ++k) {
    box[0][static_cast<std::size_t>(k)] = fmt::format("{:.6g}", lower(k));
    box[1][static_cast<std::size_t>(k)] = fmt::format("{:.6g}", upper(k));
  }
  return box;
}

/// No cable is longer with the platform's origin in the box.
double longest(const std::array<Point, 2>& box, const std::vector<Cable>& cables) {
  double result = 0;
  for (const Cable& cable : cables) {
    const Eigen::Vector3d base = approx(cable.base);
    const Eigen::Vector3d reach = (approx(box[0]) - base).cwiseAbs().cwiseMax((approx(box[1]) - base).cwiseAbs());
    result = std::max(result, reach.norm() + approx(cable.platform).norm());
  }
  return result;
}

/// CASPR's R = Rx(alpha) Ry(beta) Rz(gamma) as tilt-and-torsion angles, R = Rz(phi) Ry(theta) Rz(sigma - phi).
Eigen::Vector3d tilt_and_torsion(const Eigen::Vector3d& angles) {
  using Turn = Eigen::AngleAxisd;
  const Eigen::Matrix3d r = (Turn(angles(0), Eigen::Vector3d::UnitX()) * Turn(angles(1), Eigen::Vector3d::UnitY()) *
                             Turn(angles(2), Eigen::Vector3d::UnitZ()))
                                .toRotationMatrix();
  const double tilt = std::hypot(r(0, 2), r(1, 2));
  constexpr double kLevel = 1e-12;  // below this the direction of the tilt is rounding error
  if (tilt < kLevel && r(2, 2) > 0) return {0, 0, std::atan2(r(1, 0), r(0, 0))};
  const double phi = std::atan2(r(1, 2), r(0, 2));
  return {phi, std::atan2(tilt, r(2, 2)), phi + std::atan2(r(2, 1), -r(2, 0))};
}

std::string waypoint(const Point& position, const Eigen::Vector3d& angles) {
  const auto angle = [](double value) { return value == 0 ? std::string("0") : fmt::format("{:.17g}", value); };
  return fmt::format("    - {{px: {}, py: {}, pz: {}, phi: {}, theta: {}, sigma: {}}}\n", position[0], position[1],
                     position[2], angle(angles(0)), angle(angles(1)), angle(angles(2)));
}

/// Puts the case together, section by section.
class CaseText {
 public:
  CaseText(const CasprRobot& robot, const std::string& set, const Body& body, const std::vector<Cable>& cables)
      : robot_(robot), set_(set), body_(body), cables_(cables), box_(box_of(body, cables)) {}

  ImportedCase write(const std::string& name) {
    const CasprUnits& units = robot_.units;
    if (units.mass_is_assumed) case_.not_said.emplace_back("the unit of masses: kg, as in CASPR's own robots");
    const std::string robot = robot_section();
    const std::string load = load_section();
    const std::string space = space_section();
    const std::string query = query_section();
    case_.read = {
        fmt::format("{}: cable_set '{}', six cables", robot_.cables.name, excerpt(set_)),
        fmt::format("{}: body '{}', {} {}", robot_.bodies.name, excerpt(body_.name), body_.mass, units.mass.name),
        fmt::format("Units, as asked for: lengths in {}, forces in {}{}. Angles are radians.", units.length.name,
                    units.force.name, units.mass_is_assumed ? "" : ", masses in " + units.mass.name)};
    std::string& text = case_.text;
    text = fmt::format("# {}: a robot of CASPR, imported by taut init.\n#\n", name);
    for (const std::string& line : case_.read) text += fmt::format("# {}\n", sanitize(line));
    text +=
        "#\n# Gravity pulls along -z, as CASPR has it. These files don't say, and this case assumes (MISSING below):\n";
    for (const std::string& line : case_.not_said) text += fmt::format("# - {}\n", line);
    text +=
        fmt::format("taut: 1\nname: \"{}\"\nunits: {{length: {}, force: {}, moment: N*m, mass: {}, angle: rad}}\n\n",
                    name, units.length.name, units.force.name, units.mass.name);
    text += robot + load + space + query;
    return std::move(case_);
  }

 private:
  static std::string limits(const Cable& cable) { return fmt::format(" [{}, {}]", cable.force[0], cable.force[1]); }

  std::string robot_section() {
    std::string text = "robot:\n  base_anchors:   # attachments of link 0\n";
    for (const Cable& cable : cables_) text += fmt::format("    - {}\n", bracketed(cable.base));
    text += "  platform_anchors:   # attachments of link 1, from its joint\n";
    for (const Cable& cable : cables_) text += fmt::format("    - {}\n", bracketed(cable.platform));
    const bool is_same = std::ranges::all_of(cables_, [&](const Cable& c) { return c.force == cables_[0].force; });
    text += fmt::format("  tension:{}   # force_min and force_max\n", is_same ? limits(cables_[0]) : "");
    for (const Cable& cable : cables_) text += is_same ? "" : fmt::format("    -{}\n", limits(cable));
    const Round most = rounded_up(longest(box_, cables_));
    const std::string limit = fmt::format("[0, {:g}]", most.value());
    case_.not_said.push_back(fmt::format("limits of cable length: {} {}, which no pose in the box of 'space' reaches",
                                         limit, robot_.units.length.name));
    return text + fmt::format("  length: {}   # MISSING: put the winches' limits here\n\n", limit);
  }

  std::string load_section() {
    const double weight_N = approx(body_.mass) * approx(robot_.units.mass.factor.text()) * kGravity;
    double arm_m = 0;
    for (const Cable& cable : cables_) arm_m = std::max(arm_m, approx(cable.platform).norm());
    arm_m *= approx(robot_.units.length.factor.text());
    const Round force = rounded_down(kAssumedShare * weight_N / approx(robot_.units.force.factor.text()));
    const Round moment = rounded_down(kAssumedShare * weight_N * (arm_m > 0 ? arm_m : 1));
    const std::string f = force.inverse_square();
    const std::string m = moment.inverse_square();
    case_.not_said.push_back(
        fmt::format("how much the load may differ: forces by {:g} {}, moments by {:g} N*m (some 1 % of the weight)",
                    force.value(), robot_.units.force.name, moment.value()));
    return fmt::format(
        "load:\n  point: {}   # com_location\n  mass: {}\n  gravity: [0, 0, -{}]   # m/s^2\n"
        "  ellipsoid: {{diagonal: [{}, {}, {}, {}, {}, {}]}}   # MISSING: 1/{:g}^2 and 1/{:g}^2\n\n",
        bracketed(body_.center_of_mass), body_.mass, kGravity, f, f, f, m, m, m, force.value(), moment.value());
  }

  std::string space_section() {
    std::string from = "q_min and q_max of the joint";
    if (!body_.position_range) {
      from = "MISSING: put the workspace here";
      case_.not_said.push_back("where the platform may go: a box around the base, and as far below it as it is wide");
    }
    std::string text = fmt::format("space:\n  free: {{px: [{}, {}], py: [{}, {}], pz: [{}, {}]}}   # {}\n", box_[0][0],
                                   box_[1][0], box_[0][1], box_[1][1], box_[0][2], box_[1][2], from);
    if (!body_.angle_range.empty()) {
      case_.not_said.push_back("how to keep its range of angles, " + body_.angle_range + ": here they are free");
    }
    return text + "\n";
  }

  std::string query_section() {
    const std::string planner = "\nplanner: {strategy: astar, cost: parameters, max_seconds: 1}\n";
    if (!body_.start) {
      case_.not_said.push_back("where to start (q_initial): this case has no query; add one to plan");
      return "# MISSING: poses to go through. Remove the # and put them in:\n# query:\n#   waypoints:\n"
             "#     - {px: 0, py: 0, pz: 0, phi: 0, theta: 0, sigma: 0}\n"
             "#     - {px: 0, py: 0, pz: 0, phi: 0, theta: 0, sigma: 0}\n" +
             planner;
    }
    const double height = approx(box_[1][2]) - approx(box_[0][2]);
    const double z = approx((*body_.start)[2]);
    constexpr double kShare = 0.05;
    const double down = z - kShare * height;
    Point end = *body_.start;
    end[2] = fmt::format("{:.6g}", down >= approx(box_[0][2]) ? down : z + kShare * height);
    case_.not_said.push_back("a move: from q_initial a little " + std::string(approx(end[2]) < z ? "down" : "up"));
    const Eigen::Vector3d angles = tilt_and_torsion(body_.start_angles);
    return "query:\n  waypoints:   # tilt-and-torsion angles\n" + waypoint(*body_.start, angles) +
           waypoint(end, angles).insert(0, "    # MISSING: where to go. For example:\n") + planner;
  }

  const CasprRobot& robot_;
  const std::string& set_;
  const Body& body_;
  const std::vector<Cable>& cables_;
  std::array<Point, 2> box_;
  ImportedCase case_;
};

}  // namespace

CasprUnits read_caspr_units(const std::string& text) {
  std::array<std::optional<Unit>, 3> units;
  constexpr std::array<Dimension, 3> kDimensions = {Dimension::kLength, Dimension::kForce, Dimension::kMass};
  const auto fail = [&](const std::string& seen, const std::string& expected) {
    throw InputError(ErrorCode::kUse, fmt::format("--units: got {}, expected {}", seen, expected));
  };
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t sign = part.find('=');
    const std::string key = part.substr(0, sign);
    const auto which = std::ranges::find(kDimensions, key, dimension_name);
    if (sign == std::string::npos || which == kDimensions.end()) {
      fail(fmt::format("'{}'", excerpt(part)), "length=UNIT, force=UNIT and mass=UNIT, separated by commas");
    }
    std::optional<Unit>& unit = units[static_cast<std::size_t>(which - kDimensions.begin())];
    if (unit) fail(fmt::format("'{}' twice", key), "it once");
    const std::string name = part.substr(sign + 1);
    unit = find_unit(name);
    if (!unit || unit->dimension != *which) {
      fail(fmt::format("'{}' for {}", excerpt(name), key), "one of " + unit_names(*which));
    }
  }
  if (!units[0] || !units[1]) fail(fmt::format("'{}'", excerpt(text)), "both length=UNIT and force=UNIT");
  return {*units[0], *units[1], units[2].value_or(si_unit(Dimension::kMass)), !units[2]};
}

ImportedCase case_from_caspr(const CasprRobot& robot, const std::string& name) {
  return with_error_code(ErrorCode::kCase, [&] {
    const XmlDocument cables_xml(robot.cables.name, robot.cables.text);
    const XmlDocument bodies_xml(robot.bodies.name, robot.bodies.text);
    const XmlElement cables_root(cables_xml, {"cables"});
    const Body body = read_body(XmlElement(bodies_xml, {"bodies_system", "links"}));
    const XmlElement set = chosen_set(cables_root, robot.cable_set);
    const std::string id = set.attribute("id");
    const std::vector<Cable> cables = read_cables(set, body.center_of_mass);
    ImportedCase result = CaseText(robot, id, body, cables).write(name);
    try {
      static_cast<void>(parse_case(result.text, "the case made from it"));
    } catch (const InputError& error) {
      set.fail("a robot that can't be a case", fmt::format("one that can ({})", error.what()));
    }
    return result;
  });
}

}  // namespace taut
