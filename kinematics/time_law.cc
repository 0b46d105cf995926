// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/time_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "problem/rational.h"

namespace taut {

std::string complaint(const TimeLaw& law, std::size_t segments) {
  if (!std::isfinite(law.step_s) || !(law.step_s > 0)) {
    return fmt::format("got a step of {} s, expected a finite time above 0", law.step_s);
  }
  const std::vector<double>& c = law.controls;
  if (c.size() < 4) return fmt::format("got {} control values, expected 4 or more", c.size());
  for (std::size_t k = 0; k < c.size(); ++k) {
    if (!std::isfinite(c[k])) return fmt::format("control value {}: got {}, expected a finite number", k, c[k]);
    if (k > 0 && c[k] < c[k - 1]) {
      return fmt::format("control value {}: got {}, below the {} before it: a move does not go back", k, c[k],
                         c[k - 1]);
    }
  }
  const auto six_times = [&](std::size_t k) {
    return Rational(Rational(c[k]) + 4 * Rational(c[k + 1]) + Rational(c[k + 2]));
  };
  if (six_times(0) != 0) return "the first three control values: expected such with c0 + 4 c1 + c2 = 0";
  if (six_times(c.size() - 3) != 6 * Rational(segments)) {
    return fmt::format("the last three control values: expected such with a + 4 b + c = {}", 6 * segments);
  }
  return "";
}

std::string complaint(const Path& path) {
  const bool is_spline = path.interpolation == Interpolation::kCubicBSpline;
  const TimeLaw& law = path.timing.value();
  if (std::string text = complaint(law, path.segments()); !text.empty()) return text;
  const std::vector<Waypoint>& points = path.waypoints;
  const auto is_still = [&](std::size_t k) {  // the spline at three control points
    return is_spline && points[k] == points[k + 1] && points[k + 1] == points[k + 2];
  };
  const auto rests_at = [&](std::size_t place) {
    const auto [from, to] = std::ranges::equal_range(law.controls, static_cast<double>(place));
    return to - from >= 3;
  };
  for (std::size_t place = 0; place <= path.segments(); ++place) {
    const bool is_end = place == 0 || place == path.segments();
    if ((is_spline && !is_end) || rests_at(place)) continue;
    if (is_end && is_still(place == 0 ? 0 : points.size() - 3)) continue;
    return fmt::format("expected three control values of {}, where the move has to rest", place);
  }
  return "";
}

LawPoint at_time(const TimeLaw& law, double t) {
  const auto last = static_cast<double>(law.pieces() - 1);
  const double piece = std::clamp(std::floor(t / law.step_s), 0.0, last);
  const double u = std::clamp(t / law.step_s - piece, 0.0, 1.0);
  const Polynomial<double> x = law_polynomial<double>(law, static_cast<std::size_t>(piece));
  return {x.at(u), x.slope(u) / law.step_s, (2 * x.c[2] + 6 * u * x.c[3]) / (law.step_s * law.step_s)};
}

}  // namespace taut
