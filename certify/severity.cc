// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/severity.h"

#include <limits>

namespace taut {

const Limits& limits_of(const RobotText& robot, MarginId margin) {
  return (is_length(margin) ? robot.length_m : robot.tension_N)[static_cast<std::size_t>(margin.cable)];
}

double severity(const PathWitness& witness, const RobotText& robot) {
  constexpr double kOfContact = 1e6;
  const auto number = [](const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); };
  if (witness.singular) return std::numeric_limits<double>::infinity();
  if (witness.contact) return kOfContact + number(witness.depth_m);
  const Limits& limits = limits_of(robot, witness.margin);
  const double beyond = is_upper(witness.margin) ? number(witness.value_lower) - number(limits.upper)
                                                 : number(limits.lower) - number(witness.value_upper);
  return beyond / (number(limits.upper) - number(limits.lower));
}

}  // namespace taut
