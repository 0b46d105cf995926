// SPDX-License-Identifier: GPL-3.0-or-later
// Rotations from angles, on any form.
#pragma once

#include <stdexcept>

#include "checker/kernel/linear.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// I + sin(angle) [n] + (1 - cos(angle)) [n]^2 with the unit vector n along an axis that is not 0.
template <class T>
Matrix3<T> rotation_about(const ExactVector& axis, const T& angle) {
  const mpq_class squared = dot(axis, axis);
  const Ball size = sqrt(Ball(squared));
  const T cosine = apply(Function::kCos, angle), sine = apply(Function::kSin, angle);
  Matrix3<T> R;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    // [n]^2 = n n' - I, whose entries are rational.
    const mpq_class ii = axis[i] * axis[i] / squared, ij = axis[i] * axis[j] / squared;
    R[i][i] = T(Ball(ii)) + Ball(mpq_class(1 - ii)) * cosine;
    const T both = Ball(ij) * (T(Ball(1)) - cosine);
    const T turned = Ball(axis[k]) / size * sine;
    R[i][j] = both - turned;
    R[j][i] = both + turned;
  }
  return R;
}

/// Rz(yaw) Ry(pitch) Rx(roll).
template <class T>
Matrix3<T> roll_pitch_yaw(const T& roll, const T& pitch, const T& yaw) {
  return multiply(multiply(rotation_about<T>({0, 0, 1}, yaw), rotation_about<T>({0, 1, 0}, pitch)),
                  rotation_about<T>({1, 0, 0}, roll));
}

/// R of a pose px py pz and its angles.
template <class T>
Matrix3<T> orientation(const Problem& problem, const Vector6<T>& pose) {
  const T &x = pose[3], &y = pose[4], &z = pose[5];
  const auto Ry = [](const T& angle) { return rotation_about<T>({0, 1, 0}, angle); };
  const auto Rz = [](const T& angle) { return rotation_about<T>({0, 0, 1}, angle); };
  switch (problem.angles) {
    case AngleKind::kTiltAndTorsion: return multiply(multiply(Rz(x), Ry(y)), Rz(z - x));
    case AngleKind::kRollPitchYaw: return roll_pitch_yaw(x, y, z);
    case AngleKind::kZyz: return multiply(multiply(Rz(x), Ry(y)), Rz(z));
    case AngleKind::kAxis: return rotation_about(problem.axis, x);
  }
  throw std::logic_error("angles of no known kind");
}

}  // namespace taut::checker
