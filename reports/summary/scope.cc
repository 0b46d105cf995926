// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/scope.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "problem/decimal.h"
#include "reports/summary/bodies_statement.h"

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

}  // namespace

std::vector<ScopeItem> assumed(const Problem& problem, Interpolation law) {
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
      item("slow", "slow motion",
           "The motion is slow (quasi-static): inertia counts only as far as the set of loads contains it."),
      has_tolerances ? item("machine", "the machine as stated, within the tolerances",
                            "Anchors, load and tracking differ from the stated numbers by no more than the tolerances. "
                            "The limits and the shape of the set of loads are exactly as stated.")
                     : item("machine", "the machine exactly as stated, without tolerances",
                            "Anchors, limits and loads are exactly the stated numbers."),
      is_held ? item("control", "winches that hold the lengths that the path asks for",
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

std::vector<ScopeItem> not_covered(const Problem& problem) {
  const bool has_tolerances = problem.tolerances.has_value();
  const std::string errors = std::string("errors of manufacture, measurement and control") +
                             (has_tolerances ? " beyond the stated tolerances" : "");
  return {
      collisions(problem.bodies),
      {"cables", "sag, stretch, mass and wear of cables; pulleys; winches' speed, power, brakes",
       "Sag, stretch, mass and wear of cables; pulleys; speed, power and brakes of winches.",
       "Cables, pulleys, winches and brakes are fit for the move; sag and stretch do no harm."},
      {"strength", "strength of anchors, fittings, rigging, structure, ground; factors of safety",
       "Strength of anchors, fittings, rigging, structure and ground; factors of safety that the limits do not "
       "contain.",
       "Anchors, fittings, rigging, structure and ground bear the greatest tensions, with the safety asked for."},
      {"loss", "loss of a cable, drive, sensor or power", "Failure or loss of a cable, drive, sensor or power.",
       "The loss of a cable, drive, sensor or power does no harm."},
      {"dynamics", "vibration, wind, inertia and shock beyond the stated loads",
       "Vibration, wind, inertia and impact beyond the set of loads.",
       "Vibration, wind, inertia and impact stay within the stated loads."},
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
}

std::string in_full(const std::vector<ScopeItem>& items) {
  std::string result;
  for (const ScopeItem& item : items) result += (result.empty() ? "" : " ") + item.text;
  return result;
}

}  // namespace taut
