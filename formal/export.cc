// SPDX-License-Identifier: GPL-3.0-or-later
#include "formal/export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/input_error.h"
#include "checker/format/claims.h"
#include "formal/held_poses.h"
#include "problem/decimal.h"
#include "problem/expression.h"
#include "problem/rational.h"

namespace taut::formal {
namespace {

/// The longest expression that is written: a tape's shared parts are repeated.
constexpr std::size_t kMostCharacters = 20000;

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(fmt::format("got {}, expected a certificate without: docs/formal.md says what Coq is told", what));
}

ExpressionTape pose_tape(const SpaceText& space) {
  std::vector<std::string> names;
  for (const Parameter& parameter : space.parameters) names.push_back(parameter.name);
  return {{space.pose.begin(), space.pose.end()}, names, space.constants};
}

/// A rational number as an argument, in the canonical form, which Coq reads: ".5" and "+1" it does not.
std::string number(const RationalText& stated) {
  const RationalText text = rational_text(parse_rational(stated));
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) return fmt::format("({} # {})", text.substr(0, slash), text.substr(slash + 1));
  return text.starts_with("-") ? "(" + text + ")" : text;
}

std::string fraction(const Rational& x) { return fmt::format("{} # {}", numerator(x).str(), denominator(x).str()); }

std::string hex(double x) {
  const std::string text = hex_float(x);
  return text.starts_with("-") ? "(" + text + ")" : text;
}

std::string integer(long n) { return n < 0 ? fmt::format("({})", n) : fmt::format("{}", n); }

template <class Range>
std::string six(const Range& numbers) {
  std::string text = "(Six";
  for (const auto& x : numbers) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(x)>>) {
      text += " " + integer(x);
    } else {
      text += " " + number(x);
    }
  }
  return text + ")";
}

std::string vec(const std::array<DecimalText, 3>& v) {
  return fmt::format("(Vec {} {} {})", number(v[0]), number(v[1]), number(v[2]));
}

std::string pair(const Limits& limits) { return fmt::format("({}, {})", number(limits.lower), number(limits.upper)); }

std::string power(const std::string& base, int exponent) {
  std::string product = base;
  for (int i = 1; i < exponent; ++i) product = fmt::format("(Times {} {})", product, base);
  return product;
}

/// One step of a tape in Coq; empty where Statement.v has no such operation, and for the cosine beside a sine.
std::string step_text(const ExpressionTape& tape, const Instruction& step, const std::vector<std::string>& slots) {
  const auto a = [&]() -> const std::string& { return slots.at(static_cast<std::size_t>(step.a)); };
  const auto two = [&](const char* name) {
    return fmt::format("({} {} {})", name, a(), slots.at(static_cast<std::size_t>(step.b)));
  };
  switch (step.op) {
    case Op::kConstant: {
      const DecimalText& text = tape.constants().at(static_cast<std::size_t>(step.a));
      return text == "pi" ? "Pi" : fmt::format("(Number {})", number(text));
    }
    case Op::kParameter: return fmt::format("(Param {})", step.a);
    case Op::kAdd: return two("Plus");
    case Op::kSubtract: return two("Sub");
    case Op::kMultiply: return two("Times");
    case Op::kDivide: return two("Over");
    case Op::kNegate: return fmt::format("(Minus {})", a());
    case Op::kPower: return power(a(), step.b);
    case Op::kSqrt: return fmt::format("(Sqrt {})", a());
    case Op::kSin: return fmt::format("(Sin {})", a());
    default: return {};
  }
}

/// A tape's expressions. @throws InputError for a function that Statement.v does not have.
std::vector<std::string> expression_texts(const ExpressionTape& tape) {
  std::vector<std::string> slots;
  for (const Instruction& step : tape.instructions()) {
    if (step.op == Op::kCos) continue;  // written with the kSin before it
    slots.push_back(step_text(tape, step, slots));
    if (slots.back().empty()) refuse("tan, exp, log or an inverse of sine, cosine or tangent in an expression");
    if (slots.back().size() > kMostCharacters) refuse("an expression of so many parts");
    if (step.op == Op::kSin) slots.push_back(fmt::format("(Cos {})", slots.at(static_cast<std::size_t>(step.a))));
  }
  std::vector<std::string> texts;
  for (const int output : tape.outputs()) texts.push_back(slots.at(static_cast<std::size_t>(output)));
  return texts;
}

/// The angle of a platform that may be turned.
std::string orientation_text(const TolerancesText& tolerances) {
  return expression_texts(ExpressionTape({tolerances.orientation_rad}, {}, {})).front();
}

/// The problem with everything that machine_text() writes, and with what says nothing of which motions are feasible:
/// names, the query, which parameters are periodic or have a range. Fields are copied one by one, so that a new field
/// of a problem is missing here until somebody has thought of it.
Problem stated_part(const Problem& problem) {
  Problem stated;
  stated.robot.base_anchors_m = problem.robot.base_anchors_m;
  stated.robot.platform_anchors_m = problem.robot.platform_anchors_m;
  stated.robot.tension_N = problem.robot.tension_N;
  stated.robot.length_m = problem.robot.length_m;
  stated.load.point_m = problem.load.point_m;
  stated.load.wrench = problem.load.wrench;
  stated.load.ellipsoid = problem.load.ellipsoid;
  stated.load.ellipsoid_name = problem.load.ellipsoid_name;
  stated.load.gravity_m_s2 = problem.load.gravity_m_s2;
  stated.load.items = problem.load.items;
  for (const Parameter& parameter : problem.space.parameters) {
    stated.space.parameters.push_back({parameter.name, parameter.kind, parameter.range_lower, parameter.range_upper});
  }
  stated.space.constants = problem.space.constants;
  stated.space.angles = AnglesText{problem.space.angles.kind, problem.space.angles.axis};
  stated.space.flip = problem.space.flip;
  stated.space.pose = problem.space.pose;
  if (problem.tolerances) {
    TolerancesText& tolerances = stated.tolerances.emplace();
    tolerances.base_anchor_m = problem.tolerances->base_anchor_m;
    tolerances.platform_anchor_m = problem.tolerances->platform_anchor_m;
    tolerances.load_point_m = problem.tolerances->load_point_m;
    tolerances.wrench = problem.tolerances->wrench;
    tolerances.position_m = problem.tolerances->position_m;
    tolerances.orientation_rad = problem.tolerances->orientation_rad;
  }
  stated.name = problem.name;
  stated.query = problem.query;
  return stated;
}

/// Names the first thing that is in the problem and not in what is written.
void require_all_is_stated(const Problem& problem) {
  const nlohmann::json whole = to_json(problem);
  const nlohmann::json rest = nlohmann::json::diff(to_json(stated_part(problem)), whole);
  if (!rest.empty()) refuse(fmt::format("'problem{}'", rest.front().at("path").get<std::string>()));
}

std::string vectors_text(const VectorSet& set) {
  if (const auto* ball = std::get_if<BallOfVectors>(&set)) return fmt::format("(Ball {})", number(ball->radius));
  if (const auto* disc = std::get_if<DiscOfVectors>(&set)) {
    return fmt::format("(Disc {} {})", number(disc->radius), vec(disc->normal));
  }
  const auto& segment = std::get<SegmentOfVectors>(set);
  return fmt::format("(Along {} {} {})", vec(segment.direction), number(segment.lower), number(segment.upper));
}

std::string item_text(const LoadItem& item, const RationalVector& gravity) {
  const auto axes = [](Axes in) { return in == Axes::kWorld ? "OfWorld" : "OfPlatform"; };
  if (const auto* weight = std::get_if<Weight>(&item.what)) {
    return fmt::format("Weight {} {} {} {} {}", number(weight->mass_lower), number(weight->mass_upper), vec(gravity),
                       vec(weight->at), number(weight->at_tolerance));
  }
  if (const auto* force = std::get_if<taut::Force>(&item.what)) {
    return fmt::format("Force {} {} {}", vectors_text(force->set), axes(force->axes), vec(force->at));
  }
  if (const auto* moment = std::get_if<Moment>(&item.what)) {
    return fmt::format("Moment {} {}", vectors_text(moment->set), axes(moment->axes));
  }
  const auto& cases = std::get<LoadCases>(item.what);
  std::vector<std::string> wrenches;
  for (const auto& w : cases.wrenches) {
    wrenches.push_back(fmt::format("({}, {})", vec({w[0], w[1], w[2]}), vec({w[3], w[4], w[5]})));
  }
  return fmt::format("LoadCases [{}] {} {}", fmt::join(wrenches, "; "), axes(cases.axes), vec(cases.at));
}

std::string load_text(const LoadText& load, const TolerancesText& tolerances) {
  std::vector<std::string> items;
  if (load.ellipsoid) {
    std::string text = fmt::format("Ellipsoid {} {}\n    (Six", six(load.wrench), six(tolerances.wrench));
    for (const auto& row : *load.ellipsoid) text += "\n      " + six(row);
    items.push_back(text + ")");
  }
  for (const LoadItem& item : load.items) items.push_back(item_text(item, load.gravity_m_s2));
  return fmt::format("[{}]", fmt::join(items, ";\n    "));
}

/// @param pose  the position's expressions and the angles'
std::string angles_text(const AnglesText& angles, const std::vector<std::string>& pose) {
  switch (angles.kind) {
    case AngleKind::kTiltAndTorsion: return fmt::format("TiltTorsion {} {} {}", pose[3], pose[4], pose[5]);
    case AngleKind::kRollPitchYaw: return fmt::format("RollPitchYaw {} {} {}", pose[3], pose[4], pose[5]);
    case AngleKind::kZyz: return fmt::format("Zyz {} {} {}", pose[3], pose[4], pose[5]);
    case AngleKind::kAxis: break;
  }
  return fmt::format("About {} {}", vec(angles.axis), pose[3]);
}

std::string machine_text(const Problem& stated) {
  const RobotText& robot = stated.robot;
  std::string text = "Definition robot : machine := {|\n  cables := Six";
  for (std::size_t i = 0; i < 6; ++i) {
    text += fmt::format("\n    (Cable {} {} {} {})", vec(robot.base_anchors_m[i]), vec(robot.platform_anchors_m[i]),
                        pair(robot.tension_N[i]), pair(robot.length_m[i]));
  }
  const TolerancesText tolerances = stated.tolerances.value_or(TolerancesText{});
  text +=
      fmt::format(";\n  load_point := {};\n  load := {}", vec(stated.load.point_m), load_text(stated.load, tolerances));
  const std::vector<std::string> pose = expression_texts(pose_tape(stated.space));
  text += fmt::format(";\n  pose_position := Vec {} {} {};\n  pose_angles := {}", pose[0], pose[1], pose[2],
                      angles_text(stated.space.angles, pose));
  text += ";\n  tolerance := Tolerances (Six";
  for (std::size_t i = 0; i < 6; ++i) {
    text += fmt::format(" ({}, {})", number(tolerances.base_anchor_m[i]), number(tolerances.platform_anchor_m[i]));
  }
  text += fmt::format(") {} {} {}\n|}}.\n", number(tolerances.load_point_m), number(tolerances.position_m),
                      orientation_text(tolerances));
  return text;
}

std::string law_text(Interpolation law) {
  if (law == Interpolation::kGeodesic) return "Geodesic";
  if (law == Interpolation::kCableLengths) return "Lengths";
  return law == Interpolation::kStraight ? "Straight" : "Spline";
}

std::string waypoint_text(const Waypoint& waypoint) {
  std::vector<std::string> coordinates;
  const std::vector<double> x = numbers(waypoint);
  std::vector<int> turns = half_turns(waypoint);
  turns.resize(x.size());
  for (std::size_t j = 0; j < x.size(); ++j)
    coordinates.push_back(fmt::format("({}, {}%Z)", hex(x[j]), integer(turns[j])));
  return fmt::format("[{}]", fmt::join(coordinates, "; "));
}

std::string waypoint_text(const HeldPose& pose) {
  std::vector<std::string> coordinates;
  for (const double x : pose.pose) coordinates.push_back(hex(x));
  for (const Rational& x : pose.lengths) coordinates.push_back(fmt::format("({})", fraction(x)));
  for (const double x : {pose.tube.position, pose.tube.turn}) coordinates.push_back(hex(x));
  for (std::string& x : coordinates) x = fmt::format("({}, 0%Z)", x);
  return fmt::format("[{}]", fmt::join(coordinates, "; "));
}

std::vector<std::string> waypoint_texts(const Path& path) {
  std::vector<std::string> texts;
  if (path.interpolation == Interpolation::kCableLengths) {
    for (const HeldPose& pose : held_poses(path)) texts.push_back(waypoint_text(pose));
  } else {
    for (const Waypoint& waypoint : path.waypoints) texts.push_back(waypoint_text(waypoint));
  }
  return texts;
}

std::string coordinate_names(const Certificate& certificate) {
  switch (certificate.path.interpolation) {
    case Interpolation::kGeodesic: return "px, py, pz, qx, qy, qz, qw";
    case Interpolation::kCableLengths: return "px, py, pz, qx, qy, qz, qw, six lengths, the tube's two sizes";
    default: break;
  }
  std::vector<std::string> names;
  for (const Parameter& parameter : certificate.problem.space.parameters) names.push_back(parameter.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string tube_text(const std::optional<TubeBox>& tube) {
  if (!tube) return "None";
  std::string text = fmt::format("(Some (TubeBox {} (Six", tube->scale);
  for (const auto& row : tube->inverse) text += "\n       " + six(row);
  const auto share = [](long n) { return fmt::format("({} # {})", n, 1L << kTubeBits); };
  text += fmt::format(")%Z {} (Six", share(tube->left));
  for (const long n : tube->guess) text += " " + share(n);
  return text + fmt::format(") {}))", share(tube->within));
}

std::string box_text(const Box& box) {
  const long end = box.index + 1;
  std::string text = fmt::format("Box ({} # {}) {} (Six", end, 1L << box.depth, box.scale);
  for (const auto& row : box.inverse) text += "\n       " + six(row);
  return text + fmt::format(")%Z\n       {}%Z {}", six(box.densities), tube_text(box.tube));
}

std::string boxes_text(const std::vector<std::vector<Box>>& boxes) {
  std::vector<std::string> segments;
  for (const std::vector<Box>& segment : boxes) {
    std::vector<std::string> texts;
    for (const Box& box : segment) texts.push_back(box_text(box));
    segments.push_back(fmt::format("    [{}]", fmt::join(texts, ";\n     ")));
  }
  return fmt::format("{}", fmt::join(segments, ";\n"));
}

}  // namespace

void require_in_scope(const Certificate& certificate) {
  const Problem& problem = certificate.problem;
  const Interpolation law = certificate.path.interpolation;
  if (law == Interpolation::kCableLengths && problem.tolerances) {
    refuse("a machine controlled by its cables' lengths, with tolerances");
  }
  if (certificate.path.segments() == 0) refuse("a path of a single waypoint");
  if (problem.tolerances && problem.tolerances->cable_length_m) refuse("a machine controlled by its cables' lengths");
  if (problem.bodies) refuse("bodies");
  if (!problem.space.constraints.empty()) refuse("constraints");
  require_all_is_stated(problem);
  const std::string items = problem.load.items.empty() ? "" : checker::kItemsClause;
  if (certificate.claim != checker::kProvedClaim + items) refuse("a claim of more than tensions and lengths");
  (void)expression_texts(pose_tape(problem.space));
  if (problem.tolerances) (void)orientation_text(*problem.tolerances);
}

std::string coq_file(const Certificate& certificate, const std::string& sha256,
                     const std::vector<std::vector<Box>>& boxes, Instance instance) {
  const Problem stated = stated_part(certificate.problem);
  return fmt::format(
      "(* Written by taut formal from the certificate with the SHA-256 {}.\n"
      "   The theorem is at the end; its terms are defined in Statement.v. A waypoint's coordinates are: {}.\n"
      "   Coq reads this with: coqc -Q FOLDER Taut THIS_FILE, where FOLDER has what formal/build compiles. *)\n"
      "From Coq Require Import QArith ZArith List.\n"
      "From Taut Require Import Statement Certificate Verify.\n"
      "Import ListNotations.\n"
      "Open Scope Q_scope.\n\n"
      "{}\n"
      "Definition cert : certificate := {{|\n"
      "  subject := robot;\n"
      "  motion := {};\n"
      "  path := [{}];\n"
      "  tension_margin := 0; length_margin := 0;\n"
      "  bits := {};\n"
      "  boxes := [\n{}]\n|}}.\n\n"
      "Theorem feasible : statement cert.\n"
      "Proof. apply {}.check_sound. vm_cast_no_check (eq_refl true). Qed.\n"
      "Print Assumptions feasible.\n",
      sha256, coordinate_names(certificate), machine_text(stated), law_text(certificate.path.interpolation),
      fmt::join(waypoint_texts(certificate.path), ";\n           "), bits(certificate.problem, certificate.path),
      boxes_text(boxes), instance == Instance::kExact ? "Exact" : "Fast");
}

std::string boxes_file(const Certificate& certificate, const std::vector<std::vector<Box>>& boxes) {
  nlohmann::json all = nlohmann::json::array();
  for (const std::vector<Box>& segment : boxes) {
    nlohmann::json list = nlohmann::json::array();
    for (const Box& box : segment) {
      list.push_back({{"upto", fmt::format("{}/{}", box.index + 1, 1L << box.depth)},
                      {"scale", box.scale},
                      {"inverse", box.inverse},
                      {"densities", box.densities}});
      if (box.tube) {
        const auto share = [](long n) { return fmt::format("{}/{}", n, 1L << kTubeBits); };
        std::vector<std::string> guess;
        for (const long n : box.tube->guess) guess.push_back(share(n));
        list.back()["tube"] = {{"scale", box.tube->scale},
                               {"inverse", box.tube->inverse},
                               {"left", share(box.tube->left)},
                               {"guess", guess},
                               {"within", share(box.tube->within)}};
      }
    }
    all.push_back(std::move(list));
  }
  return nlohmann::json{{"bits", bits(certificate.problem, certificate.path)}, {"boxes", std::move(all)}}.dump() + "\n";
}

}  // namespace taut::formal
