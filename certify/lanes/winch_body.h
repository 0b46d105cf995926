// SPDX-License-Identifier: GPL-3.0-or-later
// How six lengths change along a path: winch_rate() and third_derivative_of_length() of kinematics/moving_load.h, with
// the cables as lanes. The numbers are those of the templates.
#pragma once

#include "certify/lanes/pose_body.h"

namespace taut::lanes {
namespace {

TAUT_LANES_INLINE Vectors broadcast(const Ends (&v)[3]) {
  return {{broadcast(v[0]), broadcast(v[1]), broadcast(v[2])}};
}
TAUT_LANES_INLINE Vectors operator+(const Vectors& a, const Vectors& b) {
  return {{a.x[0] + b.x[0], a.x[1] + b.x[1], a.x[2] + b.x[2]}};
}

Outcome differentiate_lengths(const Machine& machine, const PlatformRates& by_s, Order order, LengthRates& result) {
  const Vectors arm = turned(by_s.r, machine.platform), w = broadcast(by_s.w), w1 = broadcast(by_s.w1);
  Vectors d;
  for (int k = 0; k < 3; ++k) d.x[k] = broadcast(by_s.p[k]) + arm.x[k] - load(machine.base[k]);
  const Intervals length = sqrt(squared_norm(d));
  if (!all(length.minus_lower < broadcast(0.0))) return Outcome::kFault;
  const Intervals over = reciprocal_of_positive(length);

  // The anchor's lever, and its velocity and acceleration.
  const Vectors lever1 = cross(w, arm), outer = cross(w1, arm), inner = cross(w, lever1);
  const Vectors v = broadcast(by_s.p1) + lever1;
  const Vectors a = broadcast(by_s.p2) + outer + inner;
  const Intervals first = dot(d, v) * over;
  const Intervals second = (squared_norm(v) - sqr(first) + dot(d, a)) * over;
  store(result.first, first);
  store(result.second, second);
  if (order == Order::kSecond) return Outcome::kYes;

  const Vectors lever2 = outer + inner, once = cross(w1, lever1);
  const Vectors j = broadcast(by_s.p3) + cross(broadcast(by_s.w2), arm) + (once + once) + cross(w, lever2);
  Intervals bend = -(first * second);
  for (int k = 0; k < 3; ++k) bend = bend + v.x[k] * a.x[k];
  const Lanes three = broadcast(3.0);
  const Intervals thrice{three * bend.minus_lower, three * bend.upper};
  store(result.third, (dot(d, j) + thrice) * over);
  return Outcome::kYes;
}

}  // namespace
}  // namespace taut::lanes
