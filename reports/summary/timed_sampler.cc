// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/timed_sampler.h"

#include <algorithm>
#include <cmath>

#include "problem/expression.h"

namespace taut {
namespace {

using OfWinches = std::array<TimeText::Limit, kCables>;

const OfWinches& of_winches(const TimeText& time, RateKind kind) {
  return kind == RateKind::kWinchSpeed          ? time.winch_speed_m_s
         : kind == RateKind::kWinchAcceleration ? time.winch_acceleration_m_s2
                                                : time.winch_power_W;
}

const TimeText::Limit& stated(const TimeText& time, RateId id) {
  switch (id.kind) {
    case RateKind::kWinchSpeed:
    case RateKind::kWinchAcceleration:
    case RateKind::kWinchPower: return of_winches(time, id.kind).at(static_cast<std::size_t>(id.cable));
    case RateKind::kLoadSpeed: return time.load_speed_m_s;
    case RateKind::kLoadAcceleration: return time.load_acceleration_m_s2;
    case RateKind::kLoadAngularSpeed: return time.load_angular_speed_rad_s;
    case RateKind::kLoadAngularAcceleration: break;
  }
  return time.load_angular_acceleration_rad_s2;
}

}  // namespace

bool is_in_time(const Problem& problem, const Path& path) {
  return problem.time && path.timing && path.timing->pieces() > 0 && path.segments() > 0 &&
         problem.space.constraints.empty() && PathRatesModel<double>::knows(path.interpolation);
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

double TimedSample::size(RateId id) const {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case RateKind::kWinchSpeed: return std::abs(winches.speed.at(i));
    case RateKind::kWinchAcceleration: return std::abs(winches.acceleration.at(i));
    case RateKind::kWinchPower: return winch_power.at(i);
    case RateKind::kLoadSpeed: return load_speed;
    case RateKind::kLoadAcceleration: return load_acceleration;
    case RateKind::kLoadAngularSpeed: return load_angular_speed;
    case RateKind::kLoadAngularAcceleration: break;
  }
  return load_angular_acceleration;
}

TimedSampler::TimedSampler(const Problem& problem)
    : model_(make_model<double>(problem)), rates_(problem), bodies_(make_moving_bodies<double>(problem.load)) {}

TimedSample TimedSampler::at_time(const Path& path, double time_s) const {
  const TimeLaw& law = path.timing.value();
  TimedSample sample;
  sample.time_s = std::clamp(time_s, 0.0, law.duration_s());
  sample.place = taut::at_time(law, sample.time_s);
  const auto segments = static_cast<double>(path.segments());
  const double s = sample.place.s = std::clamp(sample.place.s, 0.0, segments);
  const auto k = static_cast<std::size_t>(std::min(std::floor(s), segments - 1));
  const PathRates<double> along = rates_.at(path.segment(k), s - static_cast<double>(k));
  sample.rates = by_time(along, sample.place.rate, sample.place.acceleration);
  sample.winches = winch_rates(model_, along.p, along.r_WP, sample.rates);
  const Vector3<double> arm = turned(along.r_WP, model_.p_PM);
  sample.load_speed = velocity_at(sample.rates, arm).norm();
  sample.load_acceleration = acceleration_at(sample.rates, arm).norm();
  sample.load_angular_speed = sample.rates.angular_velocity.norm();
  sample.load_angular_acceleration = sample.rates.angular_acceleration.norm();
  sample.inertial_wrench = inertial_wrench(bodies_, along.r_WP, sample.rates);
  Model<double> moving = model_;
  moving.wrench = model_.wrench - sample.inertial_wrench;
  sample.statics = statics(moving, along.p, along.r_WP);
  for (std::size_t i = 0; i < kCables && sample.statics.regular; ++i) {
    const double greatest = sample.statics.tension[i] + sample.statics.tension_above[i];
    sample.winch_power[i] = std::abs(greatest) * std::abs(sample.winches.speed[i]);
  }
  return sample;
}

TimedSample TimedSampler::at_place(const Path& path, double place) const {
  return at_time(path, time_of(path.timing.value(), place));
}

double TimedSampler::time_of(const TimeLaw& law, double place) {
  double from = 0, to = law.duration_s();
  constexpr int kHalvings = 60;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (from + to);
    (taut::at_time(law, middle).s < place ? from : to) = middle;
  }
  return to;
}

}  // namespace taut
