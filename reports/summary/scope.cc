// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/scope.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "problem/decimal.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/time_statement.h"

namespace taut {
namespace {

/// Whether some length of a cable next to its ends is not checked.
bool has_free_ends(const BodiesText& bodies) {
  const auto is_some = [](const DecimalText& x) { return Decimal::parse(x).sign() != 0; };
  return std::ranges::any_of(bodies.cables.free_ends_m,
                             [&](const auto& ends) { return is_some(ends[0]) || is_some(ends[1]); });
}

/// What of collisions is not covered: all of them, or what is no body, and the classes of pairs that are not checked.
ScopeItem collisions(const std::optional<BodiesText>& bodies) {
  if (!bodies) {
    return {"collisions", "collisions", "Collisions of cables, platform, load and surroundings.",
            "Cables, platform and load collide with nothing."};
  }
  ScopeItem item{"collisions", "collisions with what is not stated as a body",
                 "Collisions with anything that is not among the stated bodies.",
                 "Nothing touches what is not among the stated bodies."};
  std::string classes;
  for (const PairClass kind : unchecked_classes(*bodies)) {
    classes += (classes.empty() ? "" : "; ") + std::string(words_of(kind));
  }
  if (!classes.empty()) {
    item.brief += "; of " + classes;
    item.text += " Collisions of " + classes + ".";
    item.goal += " Nor do these touch: " + classes + ".";
  }
  if (const std::vector<std::string> open = bodies_without_inside(*bodies); !open.empty()) {
    const std::string names = fmt::format("{}", fmt::join(open, ", "));
    item.brief += "; what is inside of " + names + ", whose surface is not closed";
    item.text +=
        " Whether anything is inside of " + names + ": the mesh is not closed, so only its surface is checked.";
    item.goal += " Nothing is inside of " + names + ".";
  }
  if (!bodies->contacts.empty()) {
    item.brief += "; what bodies that may touch do to each other";
    item.text += " Where bodies may touch, what they do to each other: the cables balance the whole load there, too.";
    item.goal += " Bodies that may touch do no harm to each other.";
  }
  const bool has_cables = bodies->clearance_m[1] || bodies->clearance_m[2] || bodies->clearance_m[3];
  if (has_cables && has_free_ends(*bodies)) {
    item.brief += "; of cables’ free ends";
    item.text += " Collisions of cables near their anchors, as far as their free ends reach.";
    item.goal += " Free ends of cables do no harm.";
  }
  return item;
}

/// What is assumed of forces of inertia.
ScopeItem speed(const Problem& problem, bool is_in_time) {
  if (is_in_time) {
    return {"inertia", "no inertia but that of the weights",
            "Nothing but the weights of the load has inertia: cables and drums have none, and the platform has it only "
            "where a weight stands for it. A weight is a box that its mass fills evenly where one is stated, else a "
            "point; its mass and its centre of gravity are anywhere within their tolerances.",
            ""};
  }
  if (problem.time) {
    return {
        "slow", "a platform at rest",
        std::string("The platform is at rest: neither inertia nor the limits of speed, acceleration and power were "
                    "looked at.") +
            (problem.time->rows ? " Lengths of cables are off as rows of a table leave them open in the move." : ""),
        ""};
  }
  return {"slow", "slow motion",
          "The motion is slow (quasi-static): inertia counts only as far as the set of loads contains it.", ""};
}

/// Who has to follow a move, and how well.
ScopeItem drives(bool has_tolerances, bool has_rows) {
  if (has_rows) {
    return {"control", "drives that run lengths straight between the rows of the move's table",
            "The drives follow the move in time, as its law states, or a table of it, between whose rows they run the "
            "lengths of cables straight, within the stated tolerances. A machine that deviates so has the commanded "
            "velocities and accelerations; how far the jumps at rows accelerate it besides is within the stated loads.",
            ""};
  }
  return {
      "control", "drives that keep to the commanded times, speeds and accelerations",
      std::string("The drives follow the move in time, as its law states") +
          (has_tolerances ? ", within the stated tolerances of place. A machine that deviates within the tolerances "
                            "has the commanded velocities and accelerations."
                          : ", exactly."),
      ""};
}

/// "speed and power": what of winches no limit is stated of; empty if all are limited.
std::string unlimited(const TimeText& time) {
  std::vector<std::string> open;
  const auto add = [&](const auto& limits, const char* what) {
    if (!std::ranges::all_of(limits, [](const TimeText::Limit& limit) { return limit.has_value(); })) {
      open.emplace_back(what);
    }
  };
  add(time.winch_speed_m_s, "speed");
  add(time.winch_acceleration_m_s2, "acceleration");
  add(time.winch_power_W, "power");
  return fmt::format("{}", fmt::join(open, " and "));
}

/// What of cables and winches is not covered.
ScopeItem cables(const Problem& problem, bool is_in_time) {
  if (!is_in_time) {
    return {"cables", "sag, stretch, mass and wear of cables; pulleys; winches' speed, power, brakes",
            "Sag, stretch, mass and wear of cables; pulleys; speed, power and brakes of winches.",
            "Cables, pulleys, winches and brakes are fit for the move; sag and stretch do no harm."};
  }
  const std::string open = unlimited(problem.time.value());
  const std::string brief = open.empty() ? "" : "; winches' " + open + ", of which no limit is stated for all of them";
  const std::string text =
      open.empty() ? "" : " Of winches also their " + open + ", as no limit is stated for all of them.";
  return {"cables", "sag, stretch, mass and wear of cables; pulleys; drums and brakes of winches" + brief,
          "Sag, stretch, mass and wear of cables; pulleys; inertia of drums, and brakes of winches." + text,
          "Cables, pulleys, winches and brakes are fit for the move; sag and stretch do no harm."};
}

ScopeItem dynamics(bool is_in_time) {
  if (!is_in_time) {
    return {"dynamics", "vibration, wind, inertia and shock beyond the stated loads",
            "Vibration, wind, inertia and impact beyond the set of loads.",
            "Vibration, wind, inertia and impact stay within the stated loads."};
  }
  return {"dynamics", "vibration and shock; jerk, which is planned, not proved; wind beyond the stated loads",
          "Vibration and impact; jerk, which is planned and not proved; wind beyond the set of loads.",
          "Vibration, wind, jerk and impact stay within the stated loads."};
}

}  // namespace

std::vector<ScopeItem> assumed(const Certificate& certificate) {
  return assumed(certificate.problem, certificate.path.interpolation, is_move(certificate));
}

std::vector<ScopeItem> not_covered(const Certificate& certificate) {
  std::vector<ScopeItem> result = not_covered(certificate.problem, is_move(certificate));
  const auto& illustration = certificate.illustration;
  const bool are_stated = illustration.is_object() && illustration.value("has_constraints", nlohmann::json()) == true;
  if (are_stated && certificate.problem.space.constraints.empty()) {
    result.push_back(
        {"constraints", "the constraints that the case states",
         "The constraints on poses that the case states: this path is one of poses, and nothing is said of "
         "how far off the constraints these are.",
         "The poses are as near to the case's constraints as they have to be."});
  }
  return result;
}

std::vector<ScopeItem> assumed(const Problem& problem, Interpolation law, bool is_in_time) {
  const bool has_tolerances = problem.tolerances.has_value();
  const bool is_held = law == Interpolation::kCableLengths || (has_tolerances && problem.tolerances->cable_length_m);
  const std::string exactness = has_tolerances ? ", within the stated tolerances." : ", exactly.";
  const auto item = [](const char* key, const std::string& brief, const std::string& text) {
    return ScopeItem{key, brief, text, ""};
  };
  std::vector<ScopeItem> result = {
      item("cables", "massless, straight, inextensible cables that end in points",
           "Cables are massless, straight and inextensible, and end in points: no sag, no stretch, no pulleys."),
      item("bodies", "a rigid base and a rigid platform",
           "Base and platform are rigid, and loads act at the stated points of the platform."),
      speed(problem, is_in_time),
      has_tolerances ? item("machine", "the machine as stated, within the tolerances",
                            "Anchors, load and tracking differ from the stated numbers by no more than the tolerances. "
                            "The limits and the shape of the set of loads are exactly as stated.")
                     : item("machine", "the machine exactly as stated, without tolerances",
                            "Anchors, limits and loads are exactly the stated numbers."),
      is_in_time ? drives(has_tolerances, problem.time->rows.has_value())
      : is_held  ? item("control", "winches that hold the lengths that the path asks for",
                        "The winches hold the lengths that the path asks for, between waypoints too" + exactness)
                 : item("control", "a controller that follows the path",
                        "The controller follows the path, between waypoints too, as its law states" + exactness),
      item("waypoints", "waypoints as the certificate states them",
           "Waypoints are the binary64 numbers of the certificate; a typed coordinate that is no such number was moved "
           "by at most half a unit in its last place."),
      item("programs", "a checker, libraries and a processor that compute correctly",
           "The checker, the libraries that it computes with, its compiler and the processor work correctly."),
  };
  if (problem.bodies) {
    result.insert(result.begin() + 2,
                  item("obstacles", "bodies shaped as stated, and obstacles that stand still",
                       "Obstacles do not move, bodies of the platform move with it, and the shapes of all are exactly "
                       "as stated; anchors of cables that are stated at the same place and with the same tolerance are "
                       "one point."));
  }
  return result;
}

std::vector<ScopeItem> not_covered(const Problem& problem, bool is_in_time) {
  const bool has_tolerances = problem.tolerances.has_value();
  const std::string errors = std::string("errors of manufacture, measurement and control") +
                             (has_tolerances ? " beyond the stated tolerances" : "");
  std::vector<ScopeItem> result = {
      collisions(problem.bodies),
      cables(problem, is_in_time),
      {"strength", "strength of anchors, fittings, rigging, structure, ground; factors of safety",
       "Strength of anchors, fittings, rigging, structure and ground; factors of safety that the limits do not "
       "contain.",
       "Anchors, fittings, rigging, structure and ground bear the greatest tensions, with the safety asked for."},
      {"loss", "loss of a cable, drive, sensor or power", "Failure or loss of a cable, drive, sensor or power.",
       "The loss of a cable, drive, sensor or power does no harm."},
      dynamics(is_in_time),
      {"errors", errors + "; whether the controller follows the path",
       "E" + errors.substr(1) + "; whether the controller follows the path.",
       has_tolerances ? "Errors of manufacture, measurement and control stay within the stated tolerances."
                      : "Errors of manufacture, measurement and control do no harm."},
      {"handling", "lifting off, setting down, and what precedes or follows the move",
       "Lifting off, setting down, and what precedes or follows the move.",
       "Lifting off, setting down, and what precedes or follows the move are safe."},
      {"numbers", "whether the stated numbers are those of the machine (or of a reconstruction)",
       "Whether the stated numbers are those of the machine that is used. Where a case says that its geometry is a "
       "reconstruction, the verdict is about the reconstruction.",
       "The stated numbers are those of the machine that is used."},
  };
  if (is_in_time) {
    const auto at = std::ranges::find(result, std::string_view("errors"), &ScopeItem::key);
    if (problem.time->rows) {
      result.insert(
          at + 1,
          {"drives", "errors of drives in speed, acceleration and power, and jumps at rows, beyond the stated loads",
           "Errors with which drives keep to speeds and accelerations, the jumps of speed at the rows "
           "of a table among them, beyond the set of loads; their power at other speeds than those of "
           "path and law.",
           "What drives and jumps of speed at rows add to accelerations is within the stated loads."});
    } else {
      result.insert(at + 1, {"drives", "errors of drives in speed and acceleration, and between the rows of a table",
                             "Errors with which drives keep to speeds and accelerations; how they move between the "
                             "rows of a table.",
                             "The drives keep to the commanded speeds and accelerations, between rows of tables too."});
    }
  }
  return result;
}

std::string in_full(const std::vector<ScopeItem>& items) {
  std::string result;
  for (const ScopeItem& item : items) result += (result.empty() ? "" : " ") + item.text;
  return result;
}

}  // namespace taut
