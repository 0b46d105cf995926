// SPDX-License-Identifier: GPL-3.0-or-later
// The machine of the campaign: poses along every law and statics with every deviation, by a route of its own.
//
// J about the origin O with columns (u_i ; a_i × u_i), wrenches carried there from the load point, slerp of
// quaternions, Newton's method on lengths: none of kinematics/, no force densities, no intervals. In double it
// searches, in 200-bit BigFloat it judges.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "problem/problem.h"
#include "tests/soundness/loads.h"
#include "tests/soundness/vectors.h"

namespace taut::campaign {

/// (x, y, z, w), of any length.
template <class S>
using Quaternion = std::array<S, 4>;

template <class S>
Rows<S> rotation(const Quaternion<S>& q) {
  const auto& [x, y, z, w] = q;
  const S two(2.0);
  const S n = x * x + y * y + z * z + w * w;
  const S one(1.0);
  return {Vec<S>{one - two * (y * y + z * z) / n, two * (x * y - w * z) / n, two * (x * z + w * y) / n},
          Vec<S>{two * (x * y + w * z) / n, one - two * (x * x + z * z) / n, two * (y * z - w * x) / n},
          Vec<S>{two * (x * z - w * y) / n, two * (y * z + w * x) / n, one - two * (x * x + y * y) / n}};
}

/// By the angle |v| about v.
template <class S>
Rows<S> turn(const Vec<S>& v) {
  const S size = root(dot(v, v));
  if (!(size > S(0.0))) return rotation(Quaternion<S>{S(0.0), S(0.0), S(0.0), S(1.0)});
  const S half = size / S(2.0);
  const Vec<S> axis = (sine(half) / size) * v;
  return rotation(Quaternion<S>{axis[0], axis[1], axis[2], cosine(half)});
}

/// R = Rz(phi) Ry(theta) Rz(sigma − phi).
template <class S>
Rows<S> orientation(const S& phi, const S& theta, const S& sigma) {
  const S zero(0.0);
  const S one(1.0);
  const auto rz = [&](const S& t) {
    return Rows<S>{Vec<S>{cosine(t), -sine(t), zero}, Vec<S>{sine(t), cosine(t), zero}, Vec<S>{zero, zero, one}};
  };
  const Rows<S> ry{Vec<S>{cosine(theta), zero, sine(theta)}, Vec<S>{zero, one, zero},
                   Vec<S>{-sine(theta), zero, cosine(theta)}};
  return rz(phi) * ry * rz(sigma - phi);
}

/// Of a pose's angles, as products of quaternions' rotations about fixed axes where they are not tilt and torsion.
template <class S>
Rows<S> orientation(const AnglesText& angles, const S& x, const S& y, const S& z) {
  const S zero(0.0);
  switch (angles.kind) {
    case AngleKind::kTiltAndTorsion: break;
    case AngleKind::kRollPitchYaw:
      return turn(Vec<S>{zero, zero, z}) * turn(Vec<S>{zero, y, zero}) * turn(Vec<S>{x, zero, zero});
    case AngleKind::kZyz:
      return turn(Vec<S>{zero, zero, x}) * turn(Vec<S>{zero, y, zero}) * turn(Vec<S>{zero, zero, z});
    case AngleKind::kAxis: {
      const Vec<S> n{number<S>(angles.axis[0]), number<S>(angles.axis[1]), number<S>(angles.axis[2])};
      return turn((x / root(dot(n, n))) * n);
    }
  }
  return orientation(x, y, z);
}

template <class S>
struct RigidPose {
  Vec<S> p;
  Rows<S> r;
};

/// Straight positions; orientations by spherical linear interpolation of quaternions, the shorter way.
template <class S>
RigidPose<S> slerp(std::span<const double> from, std::span<const double> to, const S& s) {
  const S one(1.0);
  const auto position = [](std::span<const double> x) { return Vec<S>{S(x[0]), S(x[1]), S(x[2])}; };
  const auto unit = [](std::span<const double> x) {
    Quaternion<S> q{S(x[3]), S(x[4]), S(x[5]), S(x[6])};
    const S n = root(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (S& c : q) c = c / n;
    return q;
  };
  RigidPose<S> pose;
  pose.p = (one - s) * position(from) + s * position(to);
  const Quaternion<S> a = unit(from);
  Quaternion<S> b = unit(to);
  S inner(0.0);
  for (std::size_t k = 0; k < 4; ++k) inner = inner + a[k] * b[k];
  if (inner < S(0.0)) {
    for (S& c : b) c = -c;
  }
  S sum(0.0), difference(0.0);  // |a + b|^2, |a − b|^2: the angle without cancellation
  for (std::size_t k = 0; k < 4; ++k) {
    sum = sum + (a[k] + b[k]) * (a[k] + b[k]);
    difference = difference + (a[k] - b[k]) * (a[k] - b[k]);
  }
  const S psi = S(2.0) * angle(root(difference), root(sum));
  if (!(psi > S(1e-28))) {
    pose.r = rotation(a);
    return pose;
  }
  Quaternion<S> q;
  for (std::size_t k = 0; k < 4; ++k) q[k] = (sine((one - s) * psi) * a[k] + sine(s * psi) * b[k]) / sine(psi);
  pose.r = rotation(q);
  return pose;
}

/// The reference of the law of cable lengths.
template <class S>
RigidPose<S> mixed(std::span<const double> from, std::span<const double> to, const S& s) {
  const S one(1.0);
  std::array<S, 7> x;
  for (std::size_t k = 0; k < 7; ++k) x[k] = (one - s) * S(from[k]) + s * S(to[k]);
  return {{x[0], x[1], x[2]}, rotation(Quaternion<S>{x[3], x[4], x[5], x[6]})};
}

/// The problem's numbers.
template <class S>
struct Machine {
  std::array<Vec<S>, kCables> a, b;
  Vec<S> load_point;
  Six<S> wrench;
  bool has_ellipsoid = false;
  SixBySix<S> inverse_ellipsoid;  ///< 0 where there is no ellipsoid
  Vec<S> gravity;
  std::vector<Load<S>> loads;
};

/// Gauss–Jordan elimination of a x = b with partial pivoting, several right-hand sides at once (columns of b).
/// @returns det a; 0 where it can't be solved.
template <class S, std::size_t N>
S solve(SixBySix<S> a, std::array<std::array<S, N>, 6>& b) {
  S determinant(1.0);
  for (std::size_t c = 0; c < 6; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < 6; ++i) {
      if (magnitude(a[i][c]) > magnitude(a[pivot][c])) pivot = i;
    }
    if (!(magnitude(a[pivot][c]) > S(0.0))) return S(0.0);
    if (pivot != c) {
      std::swap(a[c], a[pivot]);
      std::swap(b[c], b[pivot]);
      determinant = -determinant;
    }
    determinant = determinant * a[c][c];
    const S inverse = S(1.0) / a[c][c];
    for (std::size_t j = c; j < 6; ++j) a[c][j] = a[c][j] * inverse;
    for (S& x : b[c]) x = x * inverse;
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == c) continue;
      const S factor = a[i][c];
      for (std::size_t j = c; j < 6; ++j) a[i][j] = a[i][j] - factor * a[c][j];
      for (std::size_t k = 0; k < N; ++k) b[i][k] = b[i][k] - factor * b[c][k];
    }
  }
  return determinant;
}

template <class S>
Machine<S> make_machine(const Problem& problem) {
  Machine<S> machine;
  const auto vector = [](const std::array<DecimalText, 3>& t) {
    return Vec<S>{number<S>(t[0]), number<S>(t[1]), number<S>(t[2])};
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    machine.a[i] = vector(problem.robot.base_anchors_m[i]);
    machine.b[i] = vector(problem.robot.platform_anchors_m[i]);
  }
  machine.load_point = vector(problem.load.point_m);
  SixBySix<S> ellipsoid;
  for (std::size_t i = 0; i < 6; ++i) {
    machine.wrench[i] = number<S>(problem.load.wrench[i]);
    for (std::size_t k = 0; k < 6; ++k) {
      ellipsoid[i][k] = problem.load.ellipsoid ? number<S>((*problem.load.ellipsoid)[i][k]) : S(0.0);
      machine.inverse_ellipsoid[i][k] = S(problem.load.ellipsoid && i == k ? 1.0 : 0.0);
    }
  }
  machine.has_ellipsoid = problem.load.ellipsoid.has_value();
  if (machine.has_ellipsoid) solve(ellipsoid, machine.inverse_ellipsoid);
  machine.gravity = vector(problem.load.gravity_m_s2);
  for (const LoadItem& item : problem.load.items) machine.loads.push_back(make_load<S>(item));
  return machine;
}

/// One deviation within the tolerances: blocks in unit balls, to be scaled by them. 52 numbers, exact binary64.
struct Deviation {
  std::array<Vec<double>, kCables> a{}, b{};
  Vec<double> load_point{}, position{}, turn{};
  double wrench = 0;
  Six<double> length{};
};

/// The blocks of a deviation, each of which is to stay in its unit ball.
template <class F>
void for_each_block(Deviation& x, F visit) {
  for (std::size_t i = 0; i < kCables; ++i) {
    visit(std::span<double>(x.a[i]));
    visit(std::span<double>(x.b[i]));
    visit(std::span<double>(&x.length[i], 1));
  }
  visit(std::span<double>(x.load_point));
  visit(std::span<double>(x.position));
  visit(std::span<double>(x.turn));
  visit(std::span<double>(&x.wrench, 1));
}

/// The sizes of the tolerances, 0 for none.
template <class S>
struct Tolerances {
  Six<S> a, b;
  Six<S> held;    ///< of lengths, of a machine that is held by them
  Six<S> rows;    ///< by which straight lengths between rows may be off
  Six<S> length;  ///< both together
  S load_point, position, turn;
  Six<S> wrench;
  bool length_controlled = false;
  bool has_rows = false;

  /// Whether lengths of cables say where the platform is: of the machine as it is, or only of the one as typed.
  [[nodiscard]] bool lengths_lead() const { return length_controlled || has_rows; }
};

template <class S>
Tolerances<S> make_tolerances(const Problem& problem) {
  Tolerances<S> t;
  const TolerancesText text = problem.tolerances.value_or(TolerancesText{});
  for (std::size_t i = 0; i < kCables; ++i) {
    t.a[i] = number<S>(text.base_anchor_m[i]);
    t.b[i] = number<S>(text.platform_anchor_m[i]);
    t.held[i] = text.cable_length_m ? number<S>((*text.cable_length_m)[i]) : S(0.0);
    t.rows[i] = problem.time && problem.time->rows ? number<S>(problem.time->rows->error_m[i]) : S(0.0);
    t.length[i] = t.held[i] + t.rows[i];
    t.wrench[i] = number<S>(text.wrench[i]);
  }
  t.load_point = number<S>(text.load_point_m);
  t.position = number<S>(text.position_m);
  t.turn = number<S>(text.orientation_rad);
  t.length_controlled = text.cable_length_m.has_value();
  t.has_rows = problem.time && problem.time->rows;
  return t;
}

template <class S>
Vec<S> scaled(const S& k, const Vec<double>& x) {
  return {k * S(x[0]), k * S(x[1]), k * S(x[2])};
}

/// The machine as it really is.
template <class S>
Machine<S> deviate(Machine<S> machine, const Tolerances<S>& t, const Deviation& x) {
  for (std::size_t i = 0; i < kCables; ++i) {
    machine.a[i] = machine.a[i] + scaled(t.a[i], x.a[i]);
    machine.b[i] = machine.b[i] + scaled(t.b[i], x.b[i]);
    machine.wrench[i] = machine.wrench[i] + S(x.wrench) * t.wrench[i];
  }
  machine.load_point = machine.load_point + scaled(t.load_point, x.load_point);
  return machine;
}

template <class S>
Six<S> lengths(const Machine<S>& machine, const RigidPose<S>& pose) {
  Six<S> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Vec<S> d = pose.p + pose.r * machine.b[i] - machine.a[i];
    result[i] = root(dot(d, d));
  }
  return result;
}

/// The pose with these lengths near `pose`, by Newton's method; nothing where it does not converge.
template <class S>
std::optional<RigidPose<S>> hold(const Machine<S>& machine, RigidPose<S> pose, const Six<S>& wanted, int steps) {
  const double accuracy = std::is_same_v<S, double> ? 1e-13 : 1e-50;
  for (int step = 0; step < steps; ++step) {
    SixBySix<S> jacobian;
    std::array<std::array<S, 1>, 6> move;
    S largest(0.0);
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vec<S> arm = pose.r * machine.b[i];
      const Vec<S> d = pose.p + arm - machine.a[i];
      const S length = root(dot(d, d));
      const Vec<S> u = (S(1.0) / length) * d;
      const Vec<S> m = cross(arm, u);
      jacobian[i] = {u[0], u[1], u[2], m[0], m[1], m[2]};
      move[i][0] = wanted[i] - length;
      const S error = magnitude(move[i][0]) / wanted[i];
      if (error > largest) largest = error;
    }
    if (!(to_double(largest) < 1e3)) return std::nullopt;
    if (to_double(largest) < accuracy) return pose;
    if (!(magnitude(solve(jacobian, move)) > S(0.0))) return std::nullopt;
    pose.p = pose.p + Vec<S>{move[0][0], move[1][0], move[2][0]};
    const S half(0.5);
    pose.r = rotation(Quaternion<S>{half * move[3][0], half * move[4][0], half * move[5][0], S(1.0)}) * pose.r;
  }
  return std::nullopt;
}

/// Lengths, J^T about the origin (a row (u_i ; a_i × u_i) for each cable), and where the load's point is.
template <class S>
struct Geometry {
  Six<S> length;
  SixBySix<S> transposed_jacobian;
  Vec<S> load_point;
};

template <class S>
Geometry<S> geometry(const Machine<S>& machine, const RigidPose<S>& pose) {
  Geometry<S> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Vec<S> d = pose.p + pose.r * machine.b[i] - machine.a[i];
    result.length[i] = root(dot(d, d));
    const Vec<S> u = (S(1.0) / result.length[i]) * d;
    const Vec<S> m = cross(machine.a[i], u);
    result.transposed_jacobian[i] = {u[0], u[1], u[2], m[0], m[1], m[2]};
  }
  result.load_point = pose.p + pose.r * machine.load_point;
  return result;
}

/// Of some cables the rows y of J^-1 X, X carrying wrenches about P_m to the origin: a wrench w makes the tension y w.
/// @returns det J; 0 or not finite where it is singular
template <class S, std::size_t N>
S tension_rows(const Geometry<S>& at, const std::array<std::size_t, N>& cables, std::array<Six<S>, N>& rows) {
  std::array<std::array<S, N>, 6> z;
  for (std::size_t j = 0; j < 6; ++j) {
    for (std::size_t n = 0; n < N; ++n) z[j][n] = S(j == cables[n] ? 1.0 : 0.0);
  }
  const S determinant = solve(at.transposed_jacobian, z);
  for (std::size_t n = 0; n < N; ++n) {
    const Vec<S> moment{z[3][n], z[4][n], z[5][n]};
    const Vec<S> force = Vec<S>{z[0][n], z[1][n], z[2][n]} + cross(moment, at.load_point);
    rows[n] = {force[0], force[1], force[2], moment[0], moment[1], moment[2]};
  }
  return determinant;
}

template <class S>
S determinant(const Machine<S>& machine, const RigidPose<S>& pose) {
  std::array<Six<S>, 0> none;
  return tension_rows(geometry(machine, pose), std::array<std::size_t, 0>{}, none);
}

/// The range over K of a tension with row y.
template <class S>
Range<S> tension_range(const Machine<S>& machine, const RigidPose<S>& pose, const Six<S>& y) {
  S tension(0.0), square(0.0);
  for (std::size_t j = 0; j < 6; ++j) {
    tension = tension + y[j] * machine.wrench[j];
    if (!machine.has_ellipsoid) continue;
    S sum(0.0);
    for (std::size_t k = 0; k < 6; ++k) sum = sum + machine.inverse_ellipsoid[j][k] * y[k];
    square = square + y[j] * sum;
  }
  const S radius = root(square);
  Range<S> result{tension - radius, tension + radius};
  for (const Load<S>& load : machine.loads) {
    const Range<S> range = extremes(load, machine.gravity, pose.r, machine.load_point, TensionOf<S>{y});
    result = {result.low + range.low, result.high + range.high};
  }
  return result;
}

/// One cable's tensions over K.
template <class S>
Range<S> tension_range(const Machine<S>& machine, const RigidPose<S>& pose, std::size_t cable) {
  std::array<Six<S>, 1> row;
  tension_rows(geometry(machine, pose), std::array<std::size_t, 1>{cable}, row);
  return tension_range(machine, pose, row[0]);
}

template <class S>
struct StaticsAt {
  Six<S> length, tension_low, tension_high;  ///< tensions over K
  S determinant;                             ///< of J; not finite or 0 where it is singular
};

template <class S>
StaticsAt<S> statics(const Machine<S>& machine, const RigidPose<S>& pose) {
  const Geometry<S> at = geometry(machine, pose);
  StaticsAt<S> result;
  result.length = at.length;
  std::array<Six<S>, kCables> rows;
  result.determinant = tension_rows(at, std::array<std::size_t, kCables>{0, 1, 2, 3, 4, 5}, rows);
  for (std::size_t i = 0; i < kCables; ++i) {
    const Range<S> range = tension_range(machine, pose, rows[i]);
    result.tension_low[i] = range.low;
    result.tension_high[i] = range.high;
  }
  return result;
}

}  // namespace taut::campaign
