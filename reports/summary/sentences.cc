// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "certificate/worst_loads.h"
#include "certify/severity.h"
#include "certify/undecided.h"
#include "problem/decimal.h"
#include "reports/summary/around_items.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/broken_limits.h"
#include "reports/summary/explanations.h"
#include "reports/summary/hints.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/numbers.h"
#include "reports/summary/scope.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& items) {
  std::string result;
  for (std::size_t i = 0; i < items.size(); ++i) {
    result += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + items[i];
  }
  return result;
}

bool is_length(const PathWitness& witness) { return is_length(witness.margin); }
bool is_upper(const PathWitness& witness) { return is_upper(witness.margin); }

/// What a witness proves: the end of its value that is next to the limit.
const DecimalText& proved_value(const PathWitness& witness) {
  return is_upper(witness) ? witness.value_lower : witness.value_upper;
}

/// A tension or a length as it is printed, exactly, with its unit.
std::string quantity(const DecimalText& value, bool length, const DisplayUnits& units) {
  return fmt::format("{} {}", units.of(length).exact(value), units.of(length).name());
}

/// By how much a witness breaks its limit, at least.
double violation(const PathWitness& witness) {
  const auto value = Decimal::parse(proved_value(witness)).rational();
  const auto limit = Decimal::parse(witness.limit).rational();
  return below(is_upper(witness) ? Rational(value - limit) : Rational(limit - value));
}

// ---- Details of a verdict.

/// "3 stretches of the path have proved violations; …"
std::string stretches_text(const Certificate& certificate) {
  const auto violated = static_cast<std::size_t>(std::ranges::count_if(
      certificate.stretches, [](const Stretch& stretch) { return stretch.violations.has_value(); }));
  const std::size_t open = certificate.stretches.size() - violated;
  const bool has_boxes = count_boxes(certificate) > 0;
  std::string text = fmt::format("In all, {} of the path {} proved violations", plural(violated, "stretch"),
                                 violated == 1 ? "has" : "have");
  if (open > 0) text += fmt::format(", and {} could not be decided", plural(open, "stretch"));
  if (is_implied(certificate)) return text + ". " + implied_scope(has_boxes);
  return text + (has_boxes ? "; outside of these the path is proved." : "; no part of it is proved.");
}

/// The worst violation among the samples: the proved one is where the violation begins, and slight there. Nothing for
/// laws of implied poses, whose samples may not be poses of the motion.
std::vector<std::string> sampled_details(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  if (certificate.path.segments() == 0 || found_no_path(certificate) ||
      certificate.path.interpolation == Interpolation::kCableLengths ||
      (scene.gravest && scene.gravest->violation.singular)) {
    return {};
  }
  const std::vector<double> changes = sign_changes(scene.samples);
  if (!changes.empty()) {
    return {fmt::format(
        "In samples, which are floating point, det J changes its sign {}, as first seen {}: "
        "that suggests singular poses, next to which tensions grow without bound.",
        changes.size() == 1 ? "once" : fmt::format("{} times", changes.size()), place_text(scene, changes.front()))};
  }
  const auto singular = std::ranges::find_if(
      scene.samples, [&](const PathSample& s) { return is_nearly_singular(scene.sampler.model(), s.statics); });
  if (singular != scene.samples.end()) {
    return {
        fmt::format("A sample, in floating point, is at a singular pose: {}.", place_text(scene, singular->position))};
  }
  const auto worst = worst_violation(scene.sampler.model(), scene.samples);
  if (!worst) return {};
  const auto i = static_cast<std::size_t>(worst->cable);
  const Limits& limits =
      (worst->is_length ? certificate.problem.robot.length_m : certificate.problem.robot.tension_N)[i];
  const DisplayUnits& units = scene.illustration.units;
  const DecimalText& broken = worst->is_upper ? limits.upper : limits.lower;
  const std::string limit = quantity(broken, worst->is_length, units);
  const DisplayUnit& unit = units.of(worst->is_length);
  const std::string value = fmt::format("{} {}", sampled_text(worst->value, nearest_double(broken), unit), unit.name());
  return {
      fmt::format("Of samples of the stated machine, in floating point, the worst is {}: there the {} of cable {} {} "
                  "{}{}. Its {} limit is {}.",
                  place_text(scene, worst->position), worst->is_length ? "length" : "tension", worst->cable + 1,
                  worst->is_upper ? "reaches" : "falls to", value,
                  worst->is_length ? "" : " under a load that is covered", worst->is_upper ? "upper" : "lower", limit)};
}

/// "after 41° of turning (segment 3), p = (0, 0, 350) mm, …"
std::string place_and_pose(const ReportContext& scene, const PathPoint& point) {
  const double at = position(point);
  return fmt::format("{}, {}", place_text(scene, at),
                     pose_text(scene, scene.sampler.at(scene.certificate.path, at).pose));
}

std::string singular_details(const ReportContext& scene, const PathWitness& witness) {
  const std::string from = place_and_pose(scene, witness.at);
  const std::string to = place_and_pose(scene, witness.to);
  if (from == to) {
    return fmt::format(
        "Where: {}, rounded. It lies between two poses next to each other, at which the determinant of the force "
        "Jacobian has opposite signs.",
        from);
  }
  return fmt::format(
      "It lies between these two poses, at which the determinant of the force Jacobian has opposite signs: {}; and {}.",
      from, to);
}

/// " The machine there is not quite the stated one …", where that is so.
std::string machine_sentence(const PathWitness& witness) {
  if (!witness.deviation) return "";
  return fmt::format(
      " The machine there is not quite the stated one: it deviates within the tolerances, as the certificate says{}.",
      witness.deviation->cable_lengths_m
          ? ", and it is at the pose to which that and the lengths of its cables lead from this one"
          : "");
}

/// By how much a limit of a rate is broken, and where.
std::string rate_details(const ReportContext& scene, const PathWitness& witness) {
  const Problem& problem = scene.certificate.problem;
  const double beyond = 100 * severity_of(witness, problem);
  constexpr double kVisible = 1e-9;
  const std::string by = beyond > kVisible
                             ? fmt::format("It is beyond the limit by at least {} % of it.", rounded_down(beyond, 2))
                             : "It is at the limit or beyond it, and the limit itself is excluded.";
  const double at = position(witness.at);
  return fmt::format("{} Where: {}. The pose there, rounded: {}.{}", by, place_text(scene, at),
                     pose_text(scene, scene.sampler.at(scene.certificate.path, at).pose), machine_sentence(witness));
}

/// By how much a limit is broken, where, and on which machine.
std::string limit_details(const ReportContext& scene, const PathWitness& witness) {
  const double beyond = violation(witness);
  const double limit = nearest_double(witness.limit);
  const DisplayUnit& unit = scene.illustration.units.of(is_length(witness));
  std::string by = "It is at the limit or beyond it, and the limit itself is excluded.";
  if (is_all_but_singular(witness, scene.certificate.problem)) {
    by = "Next to a singular pose tensions grow without bound.";
  } else if (beyond > 0) {
    by = fmt::format("It is beyond the limit by at least {} {}{}", unit.down(beyond, 3), unit.name(),
                     limit > 0 ? fmt::format(", {} % of it.", rounded_down(100 * beyond / limit, 2)) : ".");
  }
  const double at = position(witness.at);
  return fmt::format("{} Where: {}. The pose there, rounded: {}.{}", by, place_text(scene, at),
                     pose_text(scene, scene.sampler.at(scene.certificate.path, at).pose), machine_sentence(witness));
}

/// How deep, where on the path and at which points two bodies are too near: in floating point but for the place.
std::string contact_details(const ReportContext& scene, const PathWitness& witness) {
  const double at = position(witness.at);
  const PathSample sample = scene.sampler.at(scene.certificate.path, at);
  const std::string where =
      fmt::format("Where: {}. The pose there, rounded: {}.", place_text(scene, at), pose_text(scene, sample.pose));
  if (!scene.bodies) return where;
  const BodyDistance distance =
      scene.bodies->at(scene.sampler.model(), scene.sampler.rigid_pose(sample), witness.contact->pair);
  const DisplayUnit& unit = scene.illustration.units.length;
  if (distance.is_in_cone) {
    return fmt::format("In floating point its other end is {} there. {}", apart_text(distance, unit), where);
  }
  const std::string points =
      distance.distance < 0 ? fmt::format("next to {}", point_in_space(distance.at[0], unit))
                            : fmt::format("at {} of the first and {} of the second",
                                          point_in_space(distance.at[0], unit), point_in_space(distance.at[1], unit));
  return fmt::format("In floating point they are {} there, {}. {} {} it.", apart_text(distance, unit), points, where,
                     witness.contact->around ? "Four points of either body prove" : "A point of either body proves");
}

/// What a violation at the only pose of a certificate means. The checker compares that pose with the waypoints of the
/// certificate's query; an audit has none. On constraints, other paths may pass next to a waypoint at other poses.
std::string only_pose_text(const Certificate& certificate) {
  if (certificate.problem.query.empty()) return "The certificate is about this pose alone.";
  if (is_implied(certificate)) return "The pose is the one next to a waypoint of the query, on the constraints.";
  return fmt::format("Every path of the query passes this pose, so that none is feasible{}.",
                     certificate.problem.tolerances ? " for all machines within the tolerances" : "");
}

std::vector<std::string> refuted_details(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  const PathWitness& witness = scene.gravest->violation;
  std::vector<std::string> result = {witness.singular  ? singular_details(scene, witness)
                                     : witness.contact ? contact_details(scene, witness)
                                     : witness.rate    ? rate_details(scene, witness)
                                                       : limit_details(scene, witness)};
  if (!witness.singular && scene.gravest->loads) {
    result.push_back(fmt::format("A load that breaks the limit there, with each part in its set by proof; rounded: {}.",
                                 witness_load_text(certificate.problem.load, to_json(*scene.gravest->loads))));
  }
  if (certificate.path.segments() == 0) {
    result.push_back(only_pose_text(certificate));
  } else if (!certificate.stretches.empty()) {
    result.push_back(stretches_text(certificate));
  } else {
    result.emplace_back("There may be other violations: the proof ends at the first.");
  }
  if (!witness.singular && !witness.contact && !witness.rate &&
      certificate.path.interpolation != Interpolation::kCableLengths) {
    const PathSample sample = scene.sampler.at(certificate.path, position(witness.at));
    const std::string hint = reversed_load_hint(scene.sampler.model(), sample.statics);
    if (!hint.empty()) result.push_back(hint);
  }
  std::ranges::copy(sampled_details(scene), std::back_inserter(result));
  return result;
}

std::vector<std::string> undecided_details(const ReportContext& scene) {
  const OpenPart& open = *scene.certificate.undecided;
  std::vector<std::string> result = {"This does not mean that the move is unsafe, nor is it evidence that it is safe.",
                                     fmt::format("What is open: {}.", open.reason)};
  if (open.segment) {
    const double from = *open.segment + (open.box ? open.box->first.approx() : 0.0);
    const std::string box =
        open.box ? fmt::format(", from s = {} to s = {}", open.box->first.text(), open.box->second.text()) : "";
    result.push_back(fmt::format("What is open begins {}, on {}{}. The pose there, rounded: {}.",
                                 place_text(scene, from), segment_text(scene.certificate, *open.segment), box,
                                 pose_text(scene, scene.sampler.at(scene.certificate.path, from).pose)));
  }
  if (!scene.certificate.stretches.empty()) {
    result.push_back(
        fmt::format("In all, {} could not be decided.", plural(scene.certificate.stretches.size(), "stretch")));
  }
  if (const Explanation* const explanation = explanation_of(open.reason)) {
    result.push_back(fmt::format("What would settle it: {}", explanation->remedy));
  }
  std::ranges::copy(sampled_details(scene), std::back_inserter(result));
  return result;
}

// ---- What the verdict is about.

std::string law_text(const Certificate& certificate) {
  const std::string onto = certificate.problem.space.constraints.empty() ? "" : ", and from there onto the constraints";
  switch (certificate.path.interpolation) {
    case Interpolation::kStraight: return "straight in the parameters of the case" + onto;
    case Interpolation::kCubicBSpline: return "a cubic spline in the parameters of the case" + onto;
    case Interpolation::kGeodesic: return "straight in position and at a constant rate of turning";
    case Interpolation::kCableLengths: break;
  }
  return "straight in the six cable lengths";
}

std::string motion_text(const ReportContext& scene) {
  const Path& path = scene.certificate.path;
  if (path.waypoints.empty() || found_no_path(scene.certificate) || path.segments() == 0) return move_text(scene);
  const auto segments = static_cast<double>(path.segments());
  const auto pose = [&](double position) { return pose_text(scene, scene.sampler.at(path, position).pose); };
  const std::string table = table_text(scene);
  return fmt::format("{} From {} to {}. Positions and angles here are rounded, and angles are up to whole turns.{}{}",
                     move_text(scene), pose(0), pose(segments), table.empty() ? "" : " ", table);
}

/// "above 0.05 N and below 0.5 N", for all six cables; or of each: "above … (cables 1, 2 and 5), above … (cable 3)".
std::string range_text(const std::array<Limits, kCables>& limits, bool length, const DisplayUnits& units) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto first = std::ranges::find(limits, limits[i]);
    if (first - limits.begin() != static_cast<std::ptrdiff_t>(i)) continue;  // it was said of an earlier cable
    std::vector<std::string> cables;
    for (std::size_t k = i; k < kCables; ++k) {
      if (limits[k] == limits[i]) cables.push_back(std::to_string(k + 1));
    }
    const std::string range = fmt::format("above {} and below {}", quantity(limits[i].lower, length, units),
                                          quantity(limits[i].upper, length, units));
    if (cables.size() == kCables) return range;
    parts.push_back(fmt::format("{} ({} {})", range, cables.size() == 1 ? "cable" : "cables", listed(cables)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string largest(const std::array<DecimalText, kCables>& metres, const DisplayUnits& units) {
  const auto largest = std::ranges::max_element(
      metres, [](const DecimalText& a, const DecimalText& b) { return Decimal::parse(a) < Decimal::parse(b); });
  return quantity(*largest, true, units);
}

}  // namespace

std::string limits_text(const RobotText& robot, const DisplayUnits& units) {
  return fmt::format("Every tension {}; every cable length {}.", range_text(robot.tension_N, false, units),
                     range_text(robot.length_m, true, units));
}

std::string margins_text(const DecimalText& tension_N, const DecimalText& length_m, const DecimalText& wrench_scale,
                         const DisplayUnits& units, const std::optional<DecimalText>& clearance_m) {
  return fmt::format("Proved margins: tension {}, length {}{}{}.", quantity(tension_N, false, units),
                     quantity(length_m, true, units),
                     wrench_scale.empty() ? "" : fmt::format(", wrench_scale {}", plain(wrench_scale)),
                     clearance_m ? fmt::format(", clearance {}", quantity(*clearance_m, true, units)) : "");
}

std::string bodies_text(const Problem& problem) {
  return fmt::format("{}", fmt::join(lines(bodies_statement(*problem.bodies)), " "));
}

std::string apart_text(const BodyDistance& distance, const DisplayUnit& unit) {
  constexpr int kDigits = 3;
  const std::string size = unit.nearest(std::abs(distance.distance), kDigits);
  if (distance.is_in_cone) {
    return fmt::format("about {} {} {} the cone", size, unit.name(),
                       distance.distance < 0 ? "outside of" : "inside of");
  }
  if (distance.distance < 0) return fmt::format("about {} {} deep in each other", size, unit.name());
  return fmt::format("about {} {} apart", size, unit.name());
}

std::string asked_text(const BodyDistance& distance, const BodiesText& bodies, const DisplayUnit& unit) {
  if (distance.is_in_cone) return "it has to be inside";
  const std::string asked = unit.exact(asked_exactly(distance, pairs(bodies).at(distance.pair)));
  if (distance.clearance < 0) return fmt::format("may be {} {} deep there", asked.substr(1), unit.name());
  return fmt::format("clearance {} {}", asked, unit.name());
}

std::string point_in_space(const Vector3<double>& at, const DisplayUnit& unit) {
  // To a tenth of a millimetre; 0.0 takes the sign from a 0.
  const auto shown = [&](double x) { return unit.fixed(std::round(1e4 * x) / 1e4 + 0.0, 4); };
  return fmt::format("({}, {}, {}) {}", shown(at(0)), shown(at(1)), shown(at(2)), unit.name());
}

std::string move_text(const ReportContext& scene) {
  const Path& path = scene.certificate.path;
  if (path.waypoints.empty()) return "The certificate contains no path.";
  if (found_no_path(scene.certificate)) {
    return "No path was found. What is shown of one joins the waypoints asked for by straight lines, and is not a "
           "plan.";
  }
  const auto segments = static_cast<double>(path.segments());
  if (path.segments() == 0) {
    return fmt::format("A single pose: {}.", pose_text(scene, scene.sampler.at(path, 0).pose));
  }
  std::string text =
      fmt::format("{}, {}. The platform's origin travels {} and the platform turns {:.4g}°",
                  plural(path.segments(), "segment"), law_text(scene.certificate),
                  distance_text(scene.travel.distance_m(segments)), degrees(scene.travel.turned_rad(segments)));
  const auto begin = scene.travel.time_s(0);
  const auto end = scene.travel.time_s(segments);
  if (is_move(scene.certificate)) {
    const bool stops = path.interpolation != Interpolation::kCubicBSpline && path.segments() > 1;
    return text + fmt::format(" in T = {}; it rests at {}.", seconds_text(path.timing->duration_s()),
                              stops ? "every waypoint" : "the start and the end");
  }
  if (begin && end) text += fmt::format(" in {:.6g} s", *end - *begin);
  return text + ".";
}

std::string tolerances_text(const std::optional<TolerancesText>& tolerances, const DisplayUnits& units) {
  if (!tolerances) {
    return "None. The verdict is about a machine that is exactly as stated and follows the path exactly.";
  }
  const TolerancesText& t = *tolerances;
  const auto is_zero = [](const DecimalText& x) { return Decimal::parse(x).sign() == 0; };
  std::vector<std::string> items;
  const auto add = [&](bool is_some, const std::string& text) {
    if (is_some) items.push_back(text);
  };
  add(!std::ranges::all_of(t.base_anchor_m, is_zero), "base anchors " + largest(t.base_anchor_m, units));
  add(!std::ranges::all_of(t.platform_anchor_m, is_zero), "platform anchors " + largest(t.platform_anchor_m, units));
  add(!is_zero(t.load_point_m), "load point " + quantity(t.load_point_m, true, units));
  if (!std::ranges::all_of(t.wrench, is_zero)) {
    std::string wrench;
    for (const DecimalText& x : t.wrench) wrench += (wrench.empty() ? "" : ", ") + plain(x);
    items.push_back(fmt::format("centre load ± ({}) N, N·m", wrench));
  }
  add(!is_zero(t.position_m), "position of the platform " + quantity(t.position_m, true, units));
  add(t.orientation_rad != "0", "its orientation " + angle_text(t.orientation_rad));
  if (t.cable_length_m) {
    items.push_back(std::ranges::all_of(*t.cable_length_m, is_zero)
                        ? "the winches hold the cables' lengths exactly"
                        : "cable lengths " + largest(*t.cable_length_m, units) + ", held by the winches");
  }
  if (items.empty()) return "All are zero.";
  return fmt::format("Up to, in any direction and all at once: {}.", listed(items));
}

namespace {

std::string recheck_text(const Recheck& recheck) {
  switch (recheck.result) {
    case Recheck::Result::kUnchecked: break;
    case Recheck::Result::kConfirmed:
      return fmt::format("{}, an independent program with other arithmetic, accepted the certificate: {}.",
                         recheck.checker, recheck.message);
    case Recheck::Result::kNoClaim:
      return fmt::format("{}, an independent program, found it well formed; it claims nothing.", recheck.checker);
  }
  return fmt::format("Not checked{}. Before relying on it run: taut-check certificate.json CASE.yaml",
                     recheck.message.empty() ? "" : fmt::format(": {}", recheck.message));
}

}  // namespace

const char* verdict_word(const ReportContext& scene) {
  if (scene.verdict == "unchecked") return "UNCHECKED";
  if (scene.verdict == "proved") return "PROVED";
  if (scene.verdict == "refuted") return "DO NOT RUN";
  return found_no_path(scene.certificate) ? "NO PATH FOUND" : "NO DECISION";
}

std::string headline(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  if (scene.verdict == "unchecked") {
    return "Whether this certificate is right is not known, and nothing that it claims is repeated here.";
  }
  if (scene.verdict == "proved") {
    const std::string clear = clear_bodies(certificate.problem.bodies, ", and ");
    if (is_move(certificate)) {
      return fmt::format(
          "At every time of this move, with the inertia of the load, for every load in the stated set{}, no cable goes "
          "slack, none exceeds its tension or length limit, no limit of speed, acceleration or power that is stated is "
          "reached, {}no singular pose is met{}.",
          certificate.problem.tolerances ? " and every machine within the stated tolerances" : "",
          clear.empty() ? "and " : "", clear);
    }
    return fmt::format(
        "Everywhere on this move, for every load in the stated set{}, no cable goes slack, none exceeds its tension or "
        "length limit, {}no singular pose is met{}.",
        certificate.problem.tolerances ? " and every machine within the stated tolerances" : "",
        clear.empty() ? "and " : "", clear);
  }
  if (found_no_path(certificate)) {
    return "The planner found no path. That does not prove that there is none. Nothing is claimed.";
  }
  if (scene.verdict == "undecided") {
    return "Undecided: this move was neither proved nor refuted, so nothing is claimed about it.";
  }
  const PathWitness& witness = scene.gravest->violation;
  if (witness.rate) {
    return fmt::format("Refuted: on this move {}, {}.",
                       rate_violation_text(witness, certificate.problem, scene.illustration.units),
                       place_text(scene, position(witness.at)));
  }
  const bool by_load = !witness.singular && !witness.contact && !is_length(witness);
  return fmt::format("Refuted: on this move {}{}.",
                     violation_text(witness, certificate.problem, scene.illustration.units),
                     !by_load            ? ""
                     : witness.deviation ? ", under a load that is covered"
                                         : ", under a load of the stated set");
}

namespace {

std::string contact_text(const PathWitness& witness, const BodiesText& bodies, const DisplayUnits& units) {
  const BodyPair pair = pairs(bodies).at(witness.contact->pair);
  const std::string both = pair_words(bodies, pair);
  if (pair.kind == PairClass::kExitCones) {
    return fmt::format("{} leaves its exit cone at the {}", cable_name(pair.first),
                       name(bodies.exit_cones.at(pair.second).end));
  }
  if (!pair.zones.empty()) {
    return fmt::format("{} are nearer to each other, or deeper in each other, than the case allows there", both);
  }
  const Decimal clearance = Decimal::parse(pair.clearance_m);
  const Rational depth = witness.depth_m.empty() ? Rational(0) : Decimal::parse(witness.depth_m).rational();
  const std::string allowed = quantity(pair.clearance_m, true, units);
  const std::string asked = clearance.sign() == 0 ? "" : fmt::format("; the clearance asked for is {}", allowed);
  const Rational apart = clearance.rational() - depth;
  if (apart < 0 && witness.contact->around) {
    const std::string deep = rounded_down(below(Rational(-apart)), 3);
    return fmt::format("{} are at least {} deep in each other{}", both, quantity(deep, true, units), asked);
  }
  if (apart <= 0) return fmt::format("{} touch{}", both, asked);
  const Decimal negligible = Decimal::parse("0.000001");  // m
  if (apart < negligible.rational()) {
    return fmt::format("{} touch or overlap, or are at most {} apart{}", both, quantity("0.000001", true, units),
                       asked);
  }
  for (const int digits : {3, 4, 6, 9, 12, 15}) {
    std::string shown = rounded_to_nearest(apart.convert_to<double>(), digits);
    if (Decimal::parse(shown).rational() < apart) shown = rounded_up(above(apart), digits);
    if (!(Decimal::parse(shown) < clearance)) continue;
    return fmt::format("{} come within {} of each other{}", both, quantity(shown, true, units), asked);
  }
  return fmt::format("{} come within {} of each other, the clearance asked for", both, allowed);
}

}  // namespace

std::string violation_text(const PathWitness& witness, const Problem& problem, const DisplayUnits& units) {
  if (witness.singular) return "the platform passes a singular pose, where the cables cannot balance every load";
  if (witness.contact) return contact_text(witness, problem.bodies.value(), units);
  if (witness.rate) return rate_violation_text(witness, problem, units);
  const bool length = is_length(witness);
  const bool upper = is_upper(witness);
  const char* const deviating = witness.deviation ? ", on a machine that deviates within the tolerances," : "";
  if (is_all_but_singular(witness, problem)) {
    return fmt::format(
        "the platform{} is at a singular pose, or so near one that the cables cannot balance the load: the tension of "
        "cable {} would be {} {} times the greatest limit",
        deviating, witness.margin.cable + 1, upper ? "more than" : "below minus", "a million");
    static_assert(kSingularTension == 1e6);
  }
  return fmt::format("{} of cable {}{} {} {}, {} its {} limit of {}{}", length ? "the length" : "the tension",
                     witness.margin.cable + 1, deviating, upper ? "reaches at least" : "falls to at most",
                     value_text(witness, units), upper ? "not below" : "not above", upper ? "upper" : "lower",
                     quantity(witness.limit, length, units), slowing_text(witness));
}

std::string value_text(const PathWitness& witness, const DisplayUnits& units) {
  const bool up = !is_upper(witness);
  const DecimalText& value = proved_value(witness);
  const double x = nearest_double(value);
  const Decimal limit = Decimal::parse(witness.limit);
  for (const int digits : {3, 4, 6, 9, 12, 15}) {
    const std::string text = up ? rounded_up(x, digits) : rounded_down(x, digits);
    const Decimal rounded = Decimal::parse(text);
    // `x` was rounded to nearest: a last check.
    const bool is_true = up ? rounded >= Decimal::parse(value) : rounded <= Decimal::parse(value);
    if (is_true && (up ? rounded < limit : rounded > limit)) return quantity(text, is_length(witness), units);
  }
  return quantity(value, is_length(witness), units);
}

bool is_all_but_singular(const PathWitness& witness, const Problem& problem) {
  // Where a move is absurdly fast, so are tensions.
  if (problem.time || witness.singular || witness.contact || witness.rate || is_length(witness)) return false;
  double greatest = 0;
  for (const Limits& limits : problem.robot.tension_N) greatest = std::max(greatest, nearest_double(limits.upper));
  return std::abs(nearest_double(proved_value(witness))) > kSingularTension * greatest;
}

std::string implied_scope(bool has_boxes) {
  return fmt::format(
      "As poses are implied here, this is about the only pose in each tube that the certificate states{}. It is proved "
      "that the move passes these poses up to the certificate's own witness, the violation that is named first; behind "
      "it, that is open.",
      has_boxes ? "; outside of these stretches, limits are proved to be kept at those poses" : "");
}

std::vector<std::string> verdict_details(const ReportContext& scene) {
  if (scene.verdict == "unchecked") {
    return {fmt::format("{}: {}.", scene.recheck.checker, scene.recheck.message),
            "Neither does it mean that the move is unsafe, nor is it evidence that it is safe. To know run: taut-check "
            "certificate.json CASE.yaml"};
  }
  if (scene.verdict == "proved") return {};
  return scene.verdict == "refuted" ? refuted_details(scene) : undecided_details(scene);
}

namespace {

/// By what the verdict was proved.
std::string proof_text(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  if (scene.verdict == "unchecked") return "None that was checked.";
  if (scene.verdict == "undecided") {
    const auto reason = certificate.undecided ? undecided_reason(certificate.undecided->reason) : std::nullopt;
    return "None: nothing is claimed." +
           (reason ? fmt::format(" The reason has the code {}, which taut explain {} and docs/errors.md explain.",
                                 code(*reason), code(*reason))
                   : "");
  }
  const std::size_t boxes = count_boxes(certificate);
  std::string witness;
  if (scene.gravest) {
    const PathWitness& violation = scene.gravest->violation;
    witness = "at the witness, " + point_text(certificate, violation.at);
    if (violation.singular) witness += " to " + point_text(certificate, violation.to);
  }
  if (boxes == 0) return fmt::format("Interval arithmetic {}.", witness);
  return fmt::format("Interval arithmetic, {} in {} without sampling{}.", plural(boxes, "box"),
                     plural(certificate.segments.size(), "segment"), witness.empty() ? "" : ", and " + witness);
}

std::string load_sentences(const Certificate& certificate) {
  LoadStatement load = stated_load(certificate);
  if (const auto items = stated_items(certificate)) load.around_items = std::make_shared<const LoadStatement>(*items);
  return fmt::format("{}", fmt::join(report_lines(load), " "));
}

}  // namespace

std::vector<Statement> statements(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  const Problem& problem = certificate.problem;
  const DisplayUnits& units = scene.illustration.units;
  const std::string in_time = is_move(certificate) ? " " + time_limits_text(*problem.time, units) : "";
  std::vector<Statement> result = {{"motion", "Motion", motion_text(scene)},
                                   {"load", "Loads", load_sentences(certificate)},
                                   {"limits", "Limits", limits_text(problem.robot, units) + in_time},
                                   {"tolerances", "Tolerances", tolerances_text(problem.tolerances, units)},
                                   {"assumptions", "Assumptions", in_full(assumed(certificate))},
                                   {"not_covered", "Not covered", in_full(not_covered(certificate))},
                                   {"proof", "Proof", proof_text(scene)},
                                   {"recheck", "Re-check", recheck_text(scene.recheck)}};
  if (problem.bodies) result.insert(result.begin() + 3, {"clearance", "Clearance", bodies_text(problem)});
  return result;
}

std::string use_caption(const ReportContext& scene, CableUse::Source source) {
  switch (source) {
    case CableUse::Source::kNone: break;
    case CableUse::Source::kSamples: return "Cables over the move, in floating-point samples: not proved";
    case CableUse::Source::kProvedParts:
      if (is_implied(scene.certificate)) return "Cables at those poses of the stated tubes at which limits are proved";
      return "Cables over those parts of the move that are proved";
    case CableUse::Source::kProved:
      if (is_move(scene.certificate)) {
        return "Cables over the whole move, with inertia, proved: no load of the set asks for more, or less";
      }
      return "Cables over the whole move, proved: no load of the set asks for more, or less";
  }
  return "";
}

}  // namespace taut
