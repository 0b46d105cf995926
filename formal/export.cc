// SPDX-License-Identifier: GPL-3.0-or-later
#include "formal/export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "base/input_error.h"
#include "problem/expression.h"

namespace taut::formal {
namespace {

/// The longest expression that is written: a tape's shared parts are repeated.
constexpr std::size_t kMostCharacters = 20000;

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(fmt::format("got {}, which formal/Statement.v does not express, expected a path without", what));
}

ExpressionTape pose_tape(const SpaceText& space) {
  std::vector<std::string> names;
  for (const Parameter& parameter : space.parameters) names.push_back(parameter.name);
  return {{space.pose.begin(), space.pose.end()}, names, space.constants};
}

/// A rational number as an argument.
std::string number(const RationalText& text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) return fmt::format("({} # {})", text.substr(0, slash), text.substr(slash + 1));
  return text.starts_with("-") ? "(" + text + ")" : text;
}

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

/// The pose's six expressions. @throws InputError for a function that Statement.v does not have.
std::array<std::string, 6> pose_text(const SpaceText& space) {
  const ExpressionTape tape = pose_tape(space);
  std::vector<std::string> slots;
  for (const Instruction& step : tape.instructions()) {
    if (step.op == Op::kCos) continue;  // written with the kSin before it
    if (step.op == Op::kPower && step.b > 64) refuse("a power above 64");
    slots.push_back(step_text(tape, step, slots));
    if (slots.back().empty()) refuse("tan, exp, log or an inverse of sine, cosine or tangent in an expression");
    if (slots.back().size() > kMostCharacters) refuse("an expression of so many parts");
    if (step.op == Op::kSin) slots.push_back(fmt::format("(Cos {})", slots.at(static_cast<std::size_t>(step.a))));
  }
  std::array<std::string, 6> text;
  for (std::size_t i = 0; i < 6; ++i) text[i] = slots.at(static_cast<std::size_t>(tape.outputs()[i]));
  return text;
}

void require_load_in_scope(const LoadText& load) {
  if (!load.items.empty()) refuse("items of the load");
  if (!load.ellipsoid) refuse("a load without an ellipsoid");
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      if (i != j && (*load.ellipsoid)[i][j] != "0") refuse("an ellipsoid whose matrix is not diagonal");
    }
  }
}

std::string machine_text(const Problem& problem) {
  const RobotText& robot = problem.robot;
  std::string text = "Definition robot : machine := {|\n  cables := Six";
  for (std::size_t i = 0; i < 6; ++i) {
    text += fmt::format("\n    (Cable {} {} ({}, {}) ({}, {}))", vec(robot.base_anchors_m[i]),
                        vec(robot.platform_anchors_m[i]), robot.tension_N[i].lower, robot.tension_N[i].upper,
                        robot.length_m[i].lower, robot.length_m[i].upper);
  }
  text += fmt::format(";\n  load_point := {};\n  load := [Ellipsoid {}\n    (Six", vec(problem.load.point_m),
                      six(problem.load.wrench));
  for (const auto& row : *problem.load.ellipsoid) text += "\n      " + six(row);
  const std::array<std::string, 6> pose = pose_text(problem.space);
  const AngleKind kind = problem.space.angles.kind;
  text += fmt::format(")];\n  pose_position := Vec {} {} {};\n  pose_angles := {} {} {} {}\n|}}.\n", pose[0], pose[1],
                      pose[2],
                      kind == AngleKind::kTiltAndTorsion ? "TiltTorsion"
                      : kind == AngleKind::kRollPitchYaw ? "RollPitchYaw"
                                                         : "Zyz",
                      pose[3], pose[4], pose[5]);
  return text;
}

std::string waypoint_text(const Waypoint& waypoint) {
  std::vector<std::string> coordinates;
  for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
    coordinates.push_back(fmt::format("({}, {}%Z)", hex(waypoint.x[j]), integer(waypoint.half_turns[j])));
  }
  return fmt::format("[{}]", fmt::join(coordinates, "; "));
}

std::string box_text(const Box& box) {
  const long end = box.index + 1;
  std::string text = fmt::format("Box ({} # {}) {} (Six", end, 1L << box.depth, box.scale);
  for (const auto& row : box.inverse) text += "\n       " + six(row);
  return text + fmt::format(")%Z\n       {}%Z", six(box.densities));
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
  if (certificate.path.interpolation != Interpolation::kStraight) {
    refuse(fmt::format("a path that is {}", interpolation_name(certificate.path.interpolation)));
  }
  if (certificate.path.segments() == 0) refuse("a path of a single waypoint");
  if (problem.tolerances) refuse("tolerances");
  if (problem.bodies) refuse("bodies");
  if (!problem.space.constraints.empty()) refuse("constraints");
  if (problem.space.angles.kind == AngleKind::kAxis) refuse("a platform that turns about an axis");
  require_load_in_scope(problem.load);
  (void)pose_text(problem.space);
}

std::string coq_file(const Certificate& certificate, const std::vector<std::vector<Box>>& boxes, Instance instance) {
  std::vector<std::string> waypoints;
  for (const Waypoint& waypoint : certificate.path.waypoints) waypoints.push_back(waypoint_text(waypoint));
  return fmt::format(
      "(* Written by taut formal. What is proved is at the end; its terms are defined in Statement.v.\n"
      "   Compile: coqc -Q FOLDER Taut THIS_FILE, where FOLDER has taut's Coq library. *)\n"
      "From Coq Require Import QArith ZArith List.\n"
      "From Taut Require Import Statement Certificate Verify.\n"
      "Import ListNotations.\n"
      "Open Scope Q_scope.\n\n"
      "{}\n"
      "Definition cert : certificate := {{|\n"
      "  subject := robot;\n"
      "  path := [{}];\n"
      "  tension_margin := 0; length_margin := 0;\n"
      "  bits := 30;\n"
      "  boxes := [\n{}]\n|}}.\n\n"
      "Theorem feasible : statement cert.\n"
      "Proof. apply {}.check_sound. vm_compute. reflexivity. Qed.\n"
      "Print Assumptions feasible.\n",
      machine_text(certificate.problem), fmt::join(waypoints, ";\n           "), boxes_text(boxes),
      instance == Instance::kExact ? "Exact" : "Fast");
}

}  // namespace taut::formal
