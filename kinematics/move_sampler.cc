// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/move_sampler.h"

#include <algorithm>
#include <cmath>

namespace taut {

bool is_in_time(const Problem& problem, const Path& path) {
  return problem.time && path.timing && path.timing->pieces() > 0 && path.segments() > 0;
}

double MoveSample::size(RateId id) const {
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

MoveSampler::MoveSampler(const Problem& problem)
    : model_(make_model<double>(problem)), rates_(problem), bodies_(make_moving_bodies<double>(problem.load)) {}

MoveSample MoveSampler::at_time(const Path& path, double time_s) const {
  const TimeLaw& law = path.timing.value();
  MoveSample sample;
  sample.time_s = std::clamp(time_s, 0.0, law.duration_s());
  sample.place = taut::at_time(law, sample.time_s);
  sample.place.s = std::clamp(sample.place.s, 0.0, static_cast<double>(path.segments()));
  sample.segment = std::min(static_cast<std::size_t>(sample.place.s), path.segments() - 1);
  sample.s = sample.place.s - static_cast<double>(sample.segment);
  const PathRates<double> along = rates_.at(path.segment(sample.segment), sample.s);
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

MoveSample MoveSampler::at_place(const Path& path, double place) const {
  return at_time(path, time_of(path.timing.value(), place));
}

double MoveSampler::time_of(const TimeLaw& law, double place) {
  double from = 0, to = law.duration_s();
  constexpr int kHalvings = 60;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (from + to);
    (taut::at_time(law, middle).s < place ? from : to) = middle;
  }
  return to;
}

}  // namespace taut
