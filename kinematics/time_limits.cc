// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/time_limits.h"

#include "problem/expression.h"

namespace taut {
namespace {

void read(const TimeText::Limit& text, double& limit) {
  if (text) limit = evaluate_constant<double>(*text);
}

const TimeText::Limit& stated(const TimeText& time, RateId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case RateKind::kWinchSpeed: return time.winch_speed_m_s.at(i);
    case RateKind::kWinchAcceleration: return time.winch_acceleration_m_s2.at(i);
    case RateKind::kWinchPower: return time.winch_power_W.at(i);
    case RateKind::kLoadSpeed: return time.load_speed_m_s;
    case RateKind::kLoadAcceleration: return time.load_acceleration_m_s2;
    case RateKind::kLoadAngularSpeed: return time.load_angular_speed_rad_s;
    case RateKind::kLoadAngularAcceleration: break;
  }
  return time.load_angular_acceleration_rad_s2;
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

const ExpressionText& limit_of(const TimeText& time, RateId id) { return stated(time, id).value(); }

std::vector<RateLimit> rate_limits(const TimeText& time) {
  std::vector<RateLimit> result;
  for (const RateKind kind : kRateKinds) {
    for (int i = 0; i < (is_of_winch(kind) ? kCables : 1); ++i) {
      const TimeText::Limit& limit = stated(time, {kind, i});
      if (limit) result.push_back({{kind, i}, *limit, evaluate_constant<double>(*limit)});
    }
  }
  return result;
}

}  // namespace taut
