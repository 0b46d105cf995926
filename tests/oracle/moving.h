// SPDX-License-Identifier: GPL-3.0-or-later
// Moves in time at high precision, from quotients of differences of where points are: no derivative is written down.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "kinematics/segment.h"
#include "tests/oracle/oracle_at_origin.h"

namespace taut::oracle {

/// Where a point of the platform is at a pose px, py, pz [m], phi, theta, sigma [rad].
inline Big3 place(const Big6& pose, const Big3& point) {
  const auto about_z = [](const BigFloat& angle, const Big3& x) {
    const BigFloat c = cosine(angle), s = sine(angle);
    return Big3{c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
  };
  const auto& [px, py, pz, phi, theta, sigma] = pose;
  const Big3 x = about_z(sigma - phi, point);
  const BigFloat c = cosine(theta), n = sine(theta);
  const Big3 y = about_z(phi, {c * x[0] + n * x[2], x[1], c * x[2] - n * x[0]});
  return {px + y[0], py + y[1], pz + y[2]};
}

inline Big3 big(const std::array<DecimalText, 3>& text) { return {big(text[0]), big(text[1]), big(text[2])}; }
inline BigFloat distance(const Big3& a, const Big3& b) {
  BigFloat square(0.0);
  for (std::size_t k = 0; k < 3; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return root(square);
}

/// A point of the platform that has mass.
struct Particle {
  Big3 at;
  BigFloat mass;
};

/// Quotients of differences of h = 10^-40: at 400 bits their errors are far below 10^-30.
inline constexpr mpfr_prec_t kMovingBits = 400;

/// A move: the pose at a time. Call within PrecisionScope(kMovingBits).
class Move {
 public:
  explicit Move(std::function<Big6(const BigFloat& t)> pose) : pose_(std::move(pose)) {}

  [[nodiscard]] Big6 pose(const BigFloat& t) const { return pose_(t); }
  /// The first and the second derivative by time of where a point is.
  [[nodiscard]] std::pair<Big3, Big3> rates(const Big3& point, const BigFloat& t) const {
    const BigFloat h = big("1e-40");
    const Big3 before = place(pose_(t - h), point), now = place(pose_(t), point), after = place(pose_(t + h), point);
    std::pair<Big3, Big3> result;
    for (std::size_t k = 0; k < 3; ++k) {
      result.first[k] = (after[k] - before[k]) / (h + h);
      result.second[k] = (before[k] - now[k] - (now[k] - after[k])) / (h * h);
    }
    return result;
  }
  /// L' and L'' of a cable.
  [[nodiscard]] std::pair<BigFloat, BigFloat> winch(const Big3& base, const Big3& platform, const BigFloat& t) const {
    const BigFloat h = big("1e-40");
    const auto length = [&](const BigFloat& time) { return distance(place(pose_(time), platform), base); };
    const BigFloat before = length(t - h), now = length(t), after = length(t + h);
    return {(after - before) / (h + h), (before - now - (now - after)) / (h * h)};
  }
  /// What the particles' inertia asks for: the sum of m a, and of its moments about where the point `about` is.
  [[nodiscard]] Big6 inertia(const std::vector<Particle>& particles, const Big3& about, const BigFloat& t) const {
    const Big3 centre = place(pose_(t), about);
    Big6 sum;
    for (BigFloat& x : sum) x = BigFloat(0.0);
    for (const Particle& particle : particles) {
      Big3 force = rates(particle.at, t).second, arm = place(pose_(t), particle.at);
      for (std::size_t k = 0; k < 3; ++k) {
        force[k] *= particle.mass;
        arm[k] -= centre[k];
      }
      const Big3 moment = cross(arm, force);
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += force[k];
        sum[3 + k] += moment[k];
      }
    }
    return sum;
  }

 private:
  std::function<Big6(const BigFloat& t)> pose_;
};

/// A point of a uniform cubic B-spline, u in [0, 1].
inline BigFloat spline(const std::array<BigFloat, 4>& c, const BigFloat& u) {
  const BigFloat one(1.0), three(3.0), v = one - u;
  return (v * v * v * c[0] + (three * u * u * u - BigFloat(6.0) * u * u + BigFloat(4.0)) * c[1] +
          (three * (u + u * u - u * u * u) + one) * c[2] + u * u * u * c[3]) /
         BigFloat(6.0);
}

/// s at a time.
inline BigFloat place_on_path(const TimeLaw& law, const BigFloat& t) {
  const BigFloat in_steps = t / BigFloat(law.step_s);
  const double piece =
      std::clamp(std::floor(in_steps.to_double(MPFR_RNDN)), 0.0, static_cast<double>(law.pieces() - 1));
  const auto k = static_cast<std::size_t>(piece);
  const auto c = [&](std::size_t i) { return BigFloat(law.controls[k + i]); };
  return spline({c(0), c(1), c(2), c(3)}, in_steps - BigFloat(piece));
}

}  // namespace taut::oracle
