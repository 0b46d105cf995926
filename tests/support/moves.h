// SPDX-License-Identifier: GPL-3.0-or-later
// Random moves in time of Robot 2 with a body that has mass, and the same moves for the oracle.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kinematics/time_law.h"
#include "tests/oracle/moving.h"
#include "tests/support/exact.h"
#include "tests/support/robots.h"

namespace taut::testing {

/// Robot 2 anywhere, with a body that adds inertia and no weight: K remains the paper's, which the oracle knows.
struct MovingMachine {
  Problem problem = free_flying(robot2_sphere());
  std::array<double, 3> box{}, at{};
  double mass = 0;

  explicit MovingMachine(Operands& operands) {
    mass = operands.pick(64) / 64.0;
    for (std::size_t k = 0; k < 3; ++k) {
      box[k] = operands.pick(32) / 128.0 + 0.0078125;
      at[k] = (operands.pick(32) - 16) / 256.0;
    }
    const auto text = [](double x) { return exact_text(x); };
    problem.load.gravity_m_s2 = {"0", "0", "0"};
    problem.load.items = {{"body", Weight{text(mass),
                                          text(mass),
                                          {text(at[0]), text(at[1]), text(at[2])},
                                          "0",
                                          RationalVector{text(box[0]), text(box[1]), text(box[2])}}}};
    problem.time.emplace();
  }

  static std::string exact_text(double x) { return fmt::format("{}", x); }

  /// Of the same mass, centre of gravity and inertia: a corner of the box is at ± side/√12.
  [[nodiscard]] std::vector<oracle::Particle> particles() const {
    std::vector<oracle::Particle> result;
    const BigFloat half = BigFloat(1.0) / oracle::root(BigFloat(12.0));
    for (int corner = 0; corner < 8; ++corner) {
      oracle::Particle particle;
      particle.mass = BigFloat(mass / 8);
      for (std::size_t k = 0; k < 3; ++k) {
        const BigFloat off = half * BigFloat(box[k]);
        particle.at[k] = BigFloat(at[k]) + ((corner >> k & 1) != 0 ? off : -off);
      }
      result.push_back(particle);
    }
    return result;
  }
};

inline Waypoint some_pose(Operands& operands) {
  return at({operands.uniform(-0.03, 0.03), operands.uniform(-0.03, 0.03), operands.uniform(0.26, 0.34),
             operands.uniform(-0.3, 0.3), operands.uniform(0, 0.25), operands.uniform(-0.3, 0.3)});
}

/// A law over so many segments, which takes some times `shortest_s` for each.
inline TimeLaw some_time_law(Operands& operands, double segments, double shortest_s) {
  const int pieces = 4 + operands.pick(12);
  TimeLaw law{0x1p-20 * std::ceil(std::ldexp(shortest_s * std::exp(operands.uniform(0, 3)) * segments / pieces, 20)),
              {}};
  std::vector<double> values = {0};
  for (int k = 1; k < pieces; ++k) {
    values.push_back(
        std::ldexp(std::round(std::ldexp(segments * (k + operands.uniform(-0.4, 0.4)) / pieces, 40)), -40));
  }
  values.push_back(segments);
  law.controls = {-values[1]};
  law.controls.insert(law.controls.end(), values.begin(), values.end());
  law.controls.push_back(segments + (segments - values[values.size() - 2]));
  return law;
}

/// A straight segment or a spline, and a law over it.
inline Path some_move(Operands& operands, double shortest_s) {
  Path path;
  const Waypoint a = some_pose(operands), b = some_pose(operands), c = some_pose(operands);
  if (operands.pick(3) == 0) {
    path.waypoints = {a, b};
  } else {
    path.waypoints =
        operands.pick(2) == 0 ? std::vector<Waypoint>{a, a, a, b, c, c, c} : std::vector<Waypoint>{a, a, b, c};
    path.interpolation = Interpolation::kCubicBSpline;
  }
  path.timing = some_time_law(operands, static_cast<double>(path.segments()), shortest_s);
  return path;
}

/// Where the machine is at a place that counts segments.
inline oracle::Big6 pose_on_path(const Path& path, const BigFloat& s) {
  const double segment = std::clamp(std::floor(s.to_double(MPFR_RNDN)), 0.0, static_cast<double>(path.segments() - 1));
  const BigFloat x = s - BigFloat(segment);
  const Segment on = path.segment(static_cast<std::size_t>(segment));
  oracle::Big6 pose;
  for (std::size_t j = 0; j < 6; ++j) {
    const auto q = [&](std::size_t i) { return BigFloat(on.control[i]->parameters().x[j]); };
    pose[j] = on.law == Interpolation::kStraight ? (BigFloat(1.0) - x) * q(0) + x * q(1)
                                                 : oracle::spline({q(0), q(1), q(2), q(3)}, x);
  }
  return pose;
}

inline oracle::Move oracle_of(const Path& path) {
  return oracle::Move(
      [&path](const BigFloat& t) { return pose_on_path(path, oracle::place_on_path(*path.timing, t)); });
}

/// A time at which the move is at s.
inline BigFloat time_at(const TimeLaw& law, const BigFloat& s) {
  BigFloat from(0.0), to = BigFloat(law.step_s) * BigFloat(static_cast<double>(law.pieces()));
  for (int k = 0; k < 380; ++k) {
    const BigFloat middle = (from + to) / BigFloat(2.0);
    (oracle::place_on_path(law, middle) < s ? from : to) = middle;
  }
  return to;
}

/// `move` at the time `at`, run at a share of its speed that changes at a rate: at t = 0.
inline oracle::Move slowed(const oracle::Move& move, const BigFloat& at, const BigFloat& share,
                           const BigFloat& change) {
  return oracle::Move([=](const BigFloat& t) { return move.pose(at + share * t + change * t * t / BigFloat(2.0)); });
}

/// The machine of `move` at another place and turned in its own axes: its rates in W are the same.
inline oracle::Move displaced(const oracle::Move& move, const oracle::Big3& by, const oracle::Big3& axis,
                              const BigFloat& angle) {
  return oracle::Move([=](const BigFloat& t) {
    const oracle::Big6 pose = move.pose(t);
    oracle::Big3 columns[3];
    for (std::size_t k = 0; k < 3; ++k) {
      oracle::Big3 e = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
      e[k] = BigFloat(1.0);
      const oracle::Big3 once = oracle::cross(axis, e), twice = oracle::cross(axis, once);
      for (std::size_t j = 0; j < 3; ++j) {
        e[j] += oracle::sine(angle) * once[j] + (BigFloat(1.0) - oracle::cosine(angle)) * twice[j];
      }
      columns[k] = oracle::place(pose, e);
      for (std::size_t j = 0; j < 3; ++j) columns[k][j] -= pose[j];
    }
    const BigFloat phi = atan2(columns[2][1], columns[2][0]);
    const BigFloat sine = oracle::root(columns[2][0] * columns[2][0] + columns[2][1] * columns[2][1]);
    return oracle::Big6{pose[0] + by[0],
                        pose[1] + by[1],
                        pose[2] + by[2],
                        phi,
                        atan2(sine, columns[2][2]),
                        phi + atan2(columns[1][2], -columns[0][2])};
  });
}

/// The machine of `move` off by a vector, and at the time t turned by R(u, 1), with the same rates in W.
inline oracle::Move tracked(const oracle::Move& move, const BigFloat& t, const oracle::Big3& by,
                            const oracle::Big3& u) {
  const oracle::Big3 none = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
  const BigFloat size = oracle::distance(u, none);
  if (!(size > BigFloat(0.0))) return displaced(move, by, none, BigFloat(0.0));
  const oracle::Big6 pose = move.pose(t);
  oracle::Big3 axis = none;
  for (std::size_t k = 0; k < 3; ++k) {
    oracle::Big3 e = none;
    e[k] = BigFloat(1.0);
    const oracle::Big3 tip = oracle::place(pose, e);
    for (std::size_t j = 0; j < 3; ++j) axis[k] += (tip[j] - pose[j]) * u[j] / size;
  }
  return displaced(move, by, axis, BigFloat(2.0) * atan2(size, BigFloat(1.0)));
}

inline oracle::Big3 some_vector(Operands& operands, double length) {
  oracle::Big3 v;
  BigFloat square(0.0);
  for (BigFloat& x : v) {
    x = BigFloat(operands.uniform(-1, 1));
    square += x * x;
  }
  for (BigFloat& x : v) x = x * BigFloat(length) / oracle::root(square);
  return v;
}

/// Tolerances of anchors and of tracking, and machines within them.
class SomeTolerances {
 public:
  SomeTolerances(Operands& operands, double most_turn)
      : anchor_(operands.uniform(0, 5e-4)),
        position_(operands.uniform(0, 2e-3)),
        turn_(operands.uniform(0, most_turn)) {}

  [[nodiscard]] TolerancesText text() const {
    TolerancesText text;
    text.base_anchor_m.fill(MovingMachine::exact_text(anchor_));
    text.platform_anchor_m.fill(MovingMachine::exact_text(anchor_));
    text.position_m = MovingMachine::exact_text(position_);
    text.orientation_rad = MovingMachine::exact_text(turn_);
    return text;
  }
  /// With anchors that deviate by nearly as much as they may.
  [[nodiscard]] Problem some_machine(Problem problem, Operands& operands) const {
    for (auto* const anchors : {&problem.robot.base_anchors_m, &problem.robot.platform_anchors_m}) {
      for (auto& texts : *anchors) {
        oracle::Big3 place = oracle::big(texts);
        const oracle::Big3 off = some_vector(operands, anchor_ * kNearly);
        for (std::size_t k = 0; k < 3; ++k) {
          place[k] += off[k];
          texts[k] = place[k].to_decimal(80, MPFR_RNDN);
        }
      }
    }
    return problem;
  }
  /// Tracked with an error.
  [[nodiscard]] oracle::Move some_move(const oracle::Move& commanded, Operands& operands) const {
    const oracle::Big3 by = some_vector(operands, position_ * kNearly), axis = some_vector(operands, 1);
    return displaced(commanded, by, axis, BigFloat(turn_ * kNearly * operands.uniform(-1, 1)));
  }

 private:
  static constexpr double kNearly = 1 - 1e-9;
  double anchor_, position_, turn_;
};

}  // namespace taut::testing
