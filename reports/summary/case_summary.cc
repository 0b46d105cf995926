// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/case_summary.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/sanitize.h"
#include "certify/path_proof.h"
#include "problem/decimal.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/display_units.h"
#include "reports/summary/hints.h"
#include "reports/summary/illustration.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/numbers.h"
#include "reports/summary/samples.h"
#include "reports/summary/scene.h"
#include "reports/summary/sentences.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

std::string triple(const DisplayUnit& unit, const std::array<DecimalText, 3>& si) {
  return fmt::format("({}, {}, {})", unit.exact(si[0]), unit.exact(si[1]), unit.exact(si[2]));
}

/// For numbers that are floating point.
std::string about(const DisplayUnit& unit, double si) { return fmt::format("{:.6g}", unit.approx(si) + 0.0); }

/// A text table; each column is as wide as its widest cell, and the first row is the head.
std::string columns(const std::vector<std::vector<std::string>>& rows) {
  const auto width = [](const std::string& text) {  // characters, not bytes
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
  };
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  std::string text;
  for (const auto& row : rows) {
    text += " ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += " " + row[c];
      if (c + 1 < row.size()) text += std::string(widths[c] - width(row[c]) + 1, ' ');
    }
    text += "\n";
  }
  return text;
}

/// What the case states for the head of a report.
std::string document_text(const DocumentFields& fields) {
  std::string text;
  for (const auto& [name, member] : kDocumentFields) {
    std::string label = name;
    std::ranges::replace(label, '_', ' ');
    if (!(fields.*member).empty()) text += fmt::format("  {:<12} {}\n", label, fields.*member);
  }
  return text.empty() ? text : "For the head of the report; nothing checks it\n" + text + "\n";
}

std::string robot_text(const RobotText& robot, const DisplayUnits& units) {
  const DisplayUnit& length = units.length;
  std::vector<std::vector<std::string>> rows = {
      {"cable", fmt::format("base anchor a [{}]", length.name()), fmt::format("platform anchor b [{}]", length.name()),
       fmt::format("tension [{}]", units.force.name()), fmt::format("length [{}]", length.name())}};
  for (std::size_t i = 0; i < kCables; ++i) {
    const Limits& f = robot.tension_N[i];
    const Limits& d = robot.length_m[i];
    rows.push_back({std::to_string(i + 1), triple(length, robot.base_anchors_m[i]),
                    triple(length, robot.platform_anchors_m[i]),
                    fmt::format("{} to {}", units.force.exact(f.lower), units.force.exact(f.upper)),
                    fmt::format("{} to {}", length.exact(d.lower), length.exact(d.upper))});
  }
  return "Robot (a in the world frame, b in the platform frame; limits are themselves excluded)\n" + columns(rows);
}

/// Directions and sizes of the semi-axes of the ellipsoid, if there is one and forces and moments are not coupled.
std::string axes_text(const Model<double>& model, const DisplayUnits& units) {
  if (!model.has_ellipsoid) return "";
  const Matrix6<double>& e = model.ellipsoid;
  if (!e.topRightCorner<3, 3>().isZero(0)) return "  Its axes mix forces and moments: E is in --json.\n";
  std::string text;
  for (const int first : {0, 3}) {
    const DisplayUnit& unit = first == 0 ? units.force : units.moment;
    const Eigen::SelfAdjointEigenSolver<Matrix3<double>> axes(Matrix3<double>(e.block<3, 3>(first, first)));
    for (int k = 0; k < 3; ++k) {
      Vector3<double> v = axes.eigenvectors().col(k);
      Eigen::Index largest = 0;
      v.cwiseAbs().maxCoeff(&largest);
      if (v(largest) < 0) v = -v;
      text += fmt::format("  semi-axis of the {}: {:.6g} {} along ({:.4g}, {:.4g}, {:.4g})\n",
                          first == 0 ? "force" : "moment", unit.approx(1 / std::sqrt(axes.eigenvalues()(k))),
                          unit.name(), v(0) + 0.0, v(1) + 0.0, v(2) + 0.0);
    }
  }
  return text;
}

std::string space_text(const SpaceText& space) {
  std::string text = "Space of poses (SI: m, rad)\n";
  std::vector<std::vector<std::string>> rows;
  for (std::size_t j = 0; j < space.parameters.size(); ++j) {
    const Parameter& parameter = space.parameters[j];
    std::string kind = "any real number";
    if (parameter.kind == ParameterKind::kPeriodic) kind = "an angle; values 2π apart are the same";
    if (parameter.kind == ParameterKind::kRange) {
      kind = fmt::format("from {} to {}", parameter.range_lower, parameter.range_upper);
    }
    rows.push_back({"parameter " + parameter.name, in_brackets(unit(space, j)), kind});
  }
  text += columns(rows);
  for (const auto& [name, value] : space.constants) text += fmt::format("  constant {} = {}\n", name, value);
  const std::vector<std::string> names = pose_names(space.angles.kind);
  for (std::size_t c = 0; c < names.size(); ++c) {
    text += fmt::format("  {:<5} = {} {}\n", names[c], space.pose[c], c < 3 ? "m" : "rad");
  }
  text += fmt::format("  Angles: {}\n", rotation_formula(space.angles));
  for (const ExpressionText& constraint : space.constraints) text += fmt::format("  constraint: {} = 0\n", constraint);
  if (space.flip) text += "  (phi, theta) and (phi + pi, -theta) are the same pose\n";
  return text;
}

/// "12.3 ± 0.45" where K moves the tension as far down as up, else "12.3, 11.9 to 13.1".
std::string tension_text(const Statics<double>& s, std::size_t i, const DisplayUnit& unit) {
  const auto shown = [&](double x) { return unit.approx(x) + 0.0; };
  if (s.tension_below[i] == s.tension_above[i]) {
    return fmt::format("{:.5g} ± {:.3g}", shown(s.tension[i]), shown(s.tension_above[i]));
  }
  return fmt::format("{:.5g}, {:.5g} to {:.5g}", shown(s.tension[i]), shown(s.tension[i] - s.tension_below[i]),
                     shown(s.tension[i] + s.tension_above[i]));
}

std::string waypoint_text(const CaseSummary& summary, std::size_t k, const DisplayUnits& units) {
  const DisplayUnit& length = units.length;
  const WaypointSummary& waypoint = summary.waypoints[k];
  const SpaceText& space = summary.source.problem.space;
  const Statics<double>& s = waypoint.statics;
  std::string typed;
  for (std::size_t j = 0; j < space.parameters.size(); ++j) {
    typed += fmt::format("{}{} = {}", j == 0 ? "" : ", ", space.parameters[j].name, summary.source.problem.query[k][j]);
  }
  std::string text =
      fmt::format("Waypoint {}: {}\n  p = ({}, {}, {}) {}", k, typed, about(length, waypoint.pose.p_WP(0)),
                  about(length, waypoint.pose.p_WP(1)), about(length, waypoint.pose.p_WP(2)), length.name());
  const std::vector<std::string> names = pose_names(space.angles.kind);
  for (std::size_t c = 3; c < names.size(); ++c) {
    text += fmt::format(", {} = {:.6g}°", names[c], degrees(waypoint.pose.angles[c - 3]) + 0.0);
  }
  text += "\n";
  if (is_nearly_singular(summary.sampler.model(), s)) {
    return text + "  The force Jacobian is singular here, or nearly so: the cables can't balance the load.\n";
  }
  std::vector<std::vector<std::string>> rows = {{"cable", fmt::format("length [{}]", length.name()), "margin",
                                                 fmt::format("tension f0 ± v [{}]", units.force.name()), "margin", ""}};
  for (std::size_t i = 0; i < kCables; ++i) {
    const double f = tension_margin(summary.sampler.model(), s, i);
    const double d = length_margin(summary.sampler.model(), s, i);
    rows.push_back({std::to_string(i + 1), about(length, s.length[i]), about(length, d),
                    tension_text(s, i, units.force), fmt::format("{:.4g}", units.force.approx(f)),
                    f > 0 && d > 0 ? "" : "out of its limits"});
  }
  return text + columns(rows) +
         fmt::format("  wrench_scale {:.4g}: by so much could K grow before a tension reaches a limit{}\n",
                     waypoint.wrench_scale, waypoint.wrench_scale > 1 ? "" : "; it has to be above 1") +
         (reversed_load_hint(summary.sampler.model(), s).empty()
              ? ""
              : fmt::format("  {}\n", reversed_load_hint(summary.sampler.model(), s)));
}

/// The pairs that are nearest at a waypoint.
std::string bodies_text(const CaseSummary& summary, const WaypointSummary& waypoint, const DisplayUnit& length) {
  if (waypoint.nearest.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"bodies", fmt::format("apart [{}]", length.name()),
                                                 fmt::format("clearance [{}]", length.name()),
                                                 fmt::format("left [{}]", length.name()), ""}};
  const std::vector<BodyPair> all = pairs(*summary.source.problem.bodies);
  for (const BodyDistance& pair : waypoint.nearest) {
    const bool is_in = pair.distance < 0 && !pair.is_in_cone;
    rows.push_back({summary.bodies->name(pair.pair), is_in ? "–" : fmt::format("{:.4g}", length.approx(pair.distance)),
                    length.exact(asked_exactly(pair, all.at(pair.pair))),
                    fmt::format("{:.4g}", length.approx(pair.left())),
                    pair.clearance < 0 && pair.left() > 0 ? fmt::format("may touch, {}", apart_text(pair, length))
                    : is_in                               ? fmt::format("in contact, {}", apart_text(pair, length))
                    : pair.is_in_cone                     ? (pair.left() > 0 ? "inside the cone" : "outside the cone")
                    : pair.left() > 0                     ? ""
                                                          : "nearer than the clearance"});
  }
  const std::size_t others = summary.bodies->pairs() - waypoint.nearest.size();
  return columns(rows) + (others == 0 ? ""
                                      : fmt::format("  and {} that {} farther apart\n", plural(others, "pair"),
                                                    others == 1 ? "is" : "are"));
}

const char* law_text(const Case& the_case) {
  if (the_case.audit && the_case.audit->timed) {
    return "a cubic spline of time, which is fitted to the rows of a table; of a certificate its own path";
  }
  if (the_case.audit && !the_case.audit->interpolation.empty()) return the_case.audit->interpolation.c_str();
  if (the_case.problem.query.empty()) return "as the audited file suggests";
  return the_case.planner.smoothing == Smoothing::kSpline
             ? "a cubic spline in the parameters where that can be proved, else straight"
             : "straight in the parameters";
}

}  // namespace

double tension_margin(const Model<double>& model, const Statics<double>& s, std::size_t i) {
  return std::min(s.tension[i] - s.tension_below[i] - model.tension_lower[i],
                  model.tension_upper[i] - s.tension[i] - s.tension_above[i]);
}

double length_margin(const Model<double>& model, const Statics<double>& s, std::size_t i) {
  return std::min(s.length[i] - model.length_lower[i], model.length_upper[i] - s.length[i]);
}

CaseSummary::CaseSummary(const Case& the_case) : source(the_case), sampler(the_case.problem) {
  if (the_case.problem.bodies) bodies.emplace(the_case.problem);
  for (const Waypoint& waypoint : query_waypoints(the_case.problem)) {
    WaypointSummary& next = waypoints.emplace_back();
    next.parameters = resolved(waypoint);
    next.pose = sampler.pose(waypoint);
    next.statics = sampler.statics(next.pose);
    if (next.statics.regular) next.wrench_scale = wrench_scale_approx(sampler.model(), next.statics);
    if (bodies) next.nearest = bodies->nearest(sampler.model(), sampler.rigid_pose(next.pose), kNearestPairs);
  }
}

namespace {

/// Which move limits in time are about.
const char* time_subject(const Case& the_case) {
  const bool is_timed = the_case.audit && the_case.audit->timed;
  if (!the_case.audit || (!is_timed && !the_case.problem.query.empty())) {
    return "the move between the waypoints; at these the platform is at rest";
  }
  return is_timed ? "the move of the audited file, with its times; it begins and ends at rest"
                  : "moves; this case's audit is of a path at rest, to which they do not apply";
}

std::string head_text(const Problem& problem, const DisplayUnits& units) {
  return fmt::format(
      "{}, as it was understood. Nothing is proved here.\n"
      "Lengths in {}, forces in {} and moments in {}. Numbers of the case are exact, computed ones floating point.\n\n",
      problem.name, units.length.name(), units.force.name(), units.moment.name());
}

std::string load_text(const CaseSummary& summary, const DisplayUnits& units) {
  std::string text = "Load\n";
  for (const std::string& line : lines(load_statement(summary.source))) text += "  " + line + "\n";
  return text + axes_text(summary.sampler.model(), units) + "\n";
}

std::string tolerances_section(const Problem& problem, const DisplayUnits& units) {
  return fmt::format("Tolerances\n  {}\n\n", tolerances_text(problem.tolerances, units));
}

std::string stated_bodies_text(const Case& the_case) {
  if (!the_case.bodies) return "";
  std::string text = "Bodies that may not touch\n";
  for (const std::string& line : lines(bodies_statement(*the_case.bodies))) text += "  " + line + "\n";
  return text + "\n";
}

/// @param what  rests or moves: "the move between the waypoints; at these the platform is at rest"
std::string time_text(const Case& the_case, const DisplayUnits& units, const char* what) {
  if (!the_case.problem.time) return "";
  std::string text = fmt::format("Time (of {})\n", what);
  text += "  " + time_limits_text(*the_case.problem.time, units) + "\n";
  if (the_case.audit) return text + "\n";
  if (const double jerk = the_case.move.jerk_m_s3; std::isfinite(jerk)) {
    text += fmt::format("  Planned with a jerk of the load point of at most {:.6g} {}/s³; that is not proved.\n",
                        units.length.approx(jerk), units.length.name());
  }
  return text + fmt::format("  Tables have {:.6g} rows a second.\n\n", the_case.move.rate_Hz);
}

/// Which path an audit is of.
std::string audit_text(const Case& the_case) {
  if (!the_case.audit) return "";
  const AuditedPath& audit = *the_case.audit;
  std::string text = fmt::format("Audit of '{}'{}", sanitize(audit.file), audit.timed ? ", as a move in time" : "");
  if (audit.rounding) {
    text += fmt::format(", each row within a rounding of {}{}", audit.rounding->text(),
                        audit.rounding->is_of_lengths() ? " in the cables' lengths" : "");
  }
  return text + "\n";
}

std::string waypoints_text(const CaseSummary& summary, const DisplayUnits& units) {
  std::string text;
  for (std::size_t k = 0; k < summary.waypoints.size(); ++k) {
    text += "\n" + waypoint_text(summary, k, units) + bodies_text(summary, summary.waypoints[k], units.length);
  }
  return text;
}

}  // namespace

std::string to_text(const CaseSummary& summary) {
  const Problem& problem = summary.source.problem;
  const DisplayUnits units(summary.source.units);
  std::string text = head_text(problem, units) + document_text(summary.source.document_fields) +
                     robot_text(problem.robot, units) + "\n" + load_text(summary, units) +
                     tolerances_section(problem, units) + stated_bodies_text(summary.source) +
                     space_text(problem.space) + "\n" + time_text(summary.source, units, time_subject(summary.source)) +
                     fmt::format("Path between waypoints: {}\n", law_text(summary.source)) + audit_text(summary.source);
  if (summary.waypoints.empty()) return text + "No query: a case for taut audit.\n";
  return text + waypoints_text(summary, units);
}

std::vector<CaseSummary> summaries_of(const CaseOfLegs& the_case) {
  std::vector<CaseSummary> result;
  result.reserve(std::max(the_case.legs.size(), std::size_t{1}));
  for (const CaseLeg& leg : the_case.legs) result.emplace_back(leg.content);
  if (the_case.legs.empty()) result.emplace_back(the_case.whole);
  return result;
}

std::string to_text(const CaseOfLegs& the_case, std::span<const CaseSummary> summaries) {
  if (the_case.legs.empty()) return to_text(summaries.front());
  const Case& whole = the_case.whole;
  const DisplayUnits units(whole.units);
  std::string text = head_text(whole.problem, units) + document_text(whole.document_fields) +
                     robot_text(whole.problem.robot, units) + "\n" + tolerances_section(whole.problem, units) +
                     space_text(whole.problem.space) + "\n" +
                     time_text(whole, units, "each leg; at all waypoints the platform is at rest") +
                     fmt::format("Path between waypoints: {}\n", law_text(summaries.front().source));
  for (std::size_t k = 0; k < summaries.size(); ++k) {
    text += fmt::format("\nLeg {} of {}, {}\n\n", k + 1, summaries.size(), the_case.legs[k].name) +
            load_text(summaries[k], units) + stated_bodies_text(summaries[k].source);
    text += waypoints_text(summaries[k], units).substr(1);  // without a second empty line
  }
  return text;
}

namespace {

nlohmann::json nearest_json(const CaseSummary& summary, const WaypointSummary& waypoint) {
  nlohmann::json result = nlohmann::json::array();
  const auto point = [](const Vector3<double>& x) { return nlohmann::json{x(0), x(1), x(2)}; };
  for (const BodyDistance& pair : waypoint.nearest) {
    const BodiesText& bodies = *summary.source.problem.bodies;
    result.push_back({{"pair", names(bodies, pairs(bodies).at(pair.pair))},
                      {"distance_m", pair.distance},
                      {"clearance_m", pair.clearance},
                      {"left_m", pair.left()},
                      {"points_m", {point(pair.at[0]), point(pair.at[1])}}});
  }
  return result;
}

}  // namespace

nlohmann::json to_json(const CaseSummary& summary) {
  using nlohmann::json;
  json waypoints = json::array();
  for (const WaypointSummary& waypoint : summary.waypoints) {
    const Pose<double>& pose = waypoint.pose;
    json cables = json::array();
    for (std::size_t i = 0; i < kCables; ++i) {
      const Statics<double>& s = waypoint.statics;
      cables.push_back(
          {{"cable", i + 1},
           {"length_m", s.length[i]},
           {"length_margin_m", length_margin(summary.sampler.model(), s, i)},
           {"f0_N", s.regular ? json(s.tension[i]) : json()},
           {"lowest_N", s.regular ? json(s.tension[i] - s.tension_below[i]) : json()},
           {"highest_N", s.regular ? json(s.tension[i] + s.tension_above[i]) : json()},
           {"tension_margin_N", s.regular ? json(tension_margin(summary.sampler.model(), s, i)) : json()}});
    }
    json coordinates = json::object();
    const std::vector<std::string> names = pose_names(summary.source.problem.space.angles.kind);
    for (std::size_t c = 0; c < names.size(); ++c) {
      coordinates[names[c]] = c < 3 ? pose.p_WP(static_cast<Eigen::Index>(c)) : pose.angles[c - 3];
    }
    waypoints.push_back({{"parameters", waypoint.parameters},
                         {"pose", std::move(coordinates)},
                         {"nearest_bodies", nearest_json(summary, waypoint)},
                         {"regular", waypoint.statics.regular},
                         {"wrench_scale", waypoint.statics.regular ? json(waypoint.wrench_scale) : json()},
                         {"cables", cables}});
  }
  return {{"problem", to_json(summary.source.problem)},
          {"document_fields", to_json(summary.source.document_fields)},
          {"load", to_json(load_statement(summary.source))},
          {"bodies", stated_bodies_json(summary.source.bodies)},
          {"warnings", summary.source.warnings},
          {"path_law", law_text(summary.source)},
          {"waypoints", waypoints}};
}

nlohmann::json to_json(const CaseOfLegs& the_case, std::span<const CaseSummary> summaries) {
  if (the_case.legs.empty()) return to_json(summaries.front());
  nlohmann::json result = {{"legs", nlohmann::json::array()}, {"warnings", the_case.whole.warnings}};
  for (std::size_t k = 0; k < summaries.size(); ++k) {
    result["legs"].push_back({{"name", the_case.legs[k].name}, {"case", to_json(summaries[k])}});
  }
  return result;
}

}  // namespace taut
