// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/time_limits.h"

#include "problem/expression.h"

namespace taut {
namespace {

void read(const TimeText::Limit& text, double& limit) {
  if (text) limit = evaluate_constant<double>(*text);
}

}  // namespace

TimeLimits make_time_limits(const Problem& problem) {
  TimeLimits limits;
  if (!problem.time) return limits;
  const TimeText& time = *problem.time;
  for (std::size_t i = 0; i < kCables; ++i) {
    read(time.winch_speed_m_s[i], limits.winch_speed[i]);
    read(time.winch_acceleration_m_s2[i], limits.winch_acceleration[i]);
    read(time.winch_power_W[i], limits.winch_power[i]);
  }
  read(time.load_speed_m_s, limits.speed);
  read(time.load_acceleration_m_s2, limits.acceleration);
  read(time.load_angular_speed_rad_s, limits.angular_speed);
  read(time.load_angular_acceleration_rad_s2, limits.angular_acceleration);
  return limits;
}

}  // namespace taut
