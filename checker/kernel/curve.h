// SPDX-License-Identifier: GPL-3.0-or-later
// The curve that mixes the control points of a segment, exactly, and over a box.
#pragma once

#include <array>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "checker/kernel/mean_value_form.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// c0 + c1 s + c2 s^2 + c3 s^3.
using Polynomial = std::array<mpq_class, 4>;

/// One coordinate of a segment, from those of its control points.
[[nodiscard]] inline Polynomial mix(const std::vector<mpq_class>& q) {
  switch (q.size()) {
    case 1: return {q[0]};
    case 2: return {q[0], q[1] - q[0]};
    case 4:
      return {(q[0] + 4 * q[1] + q[2]) / 6, (q[2] - q[0]) / 2, (q[0] - 2 * q[1] + q[2]) / 2,
              (q[3] - 3 * q[2] + 3 * q[1] - q[0]) / 6};
    default: throw std::logic_error("a segment has one, two or four control points");
  }
}

[[nodiscard]] inline Polynomial derivative(const Polynomial& p) { return {p[1], 2 * p[2], 3 * p[3], 0}; }

/// The coefficients of p(m + r u) as a polynomial in u.
[[nodiscard]] inline Polynomial over(const Polynomial& p, const Box& box) {
  const mpq_class m = (box.begin + box.end) / 2;
  const mpq_class r = (box.end - box.begin) / 2;
  if (p[2] == 0 && p[3] == 0) return {p[0] + m * p[1], r * p[1]};
  return {p[0] + m * (p[1] + m * (p[2] + m * p[3])), r * (p[1] + m * (2 * p[2] + m * 3 * p[3])),
          r * r * (p[2] + 3 * m * p[3]), r * r * r * p[3]};
}

/// One number of each control point, mixed.
template <class Number>
[[nodiscard]] Polynomial mixed(std::span<const Waypoint> controls, const Number& number) {
  std::vector<mpq_class> values;
  for (const Waypoint& waypoint : controls) values.emplace_back(number(waypoint));
  return mix(values);
}

/// Parameter j: a polynomial, and one that is to be multiplied by pi.
[[nodiscard]] inline std::pair<Polynomial, Polynomial> coordinate(std::span<const Waypoint> controls, std::size_t j) {
  return {mixed(controls, [j](const Waypoint& w) { return w.x[j]; }),
          mixed(controls, [j](const Waypoint& w) { return w.half_turns[j]; })};
}

/// Of a polynomial in u with coefficients a + b pi. They are summed before u enters: the two parts may nearly cancel.
[[nodiscard]] inline MeanValueForm form(const Polynomial& a, const Polynomial& b = {}) {
  std::array<Ball, 4> c;
  for (std::size_t i = 0; i < 4; ++i) {
    c[i] = Ball(a[i]);
    if (b[i] != 0) c[i] += Ball(b[i]) * Ball::pi();
  }
  return {c[0] + from_zero_to(c[2]), c[1] + from_zero_to(c[3])};  // u^2 is in [0, 1], u^3 = u u^2
}

}  // namespace taut::checker
