// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/angles.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Within (−π, π].
double wrapped(double angle) { return angle - 2 * kPi * std::ceil((angle - kPi) / (2 * kPi)); }

}  // namespace

std::array<double, 3> customary_angles(AngleKind kind, const std::array<double, 3>& angles) {
  if (!std::ranges::all_of(angles, [](double x) { return std::isfinite(x); })) return angles;
  auto [a, b, c] = angles;
  b = wrapped(b);
  switch (kind) {
    case AngleKind::kTiltAndTorsion:  // Rz(φ + π) Ry(−θ) Rz(σ − φ − π) is Rz(φ) Ry(θ) Rz(σ − φ)
      if (b < 0) a += kPi, b = -b;
      break;
    case AngleKind::kZyz:
      if (b < 0) a += kPi, b = -b, c += kPi;
      break;
    case AngleKind::kRollPitchYaw:  // Rz(y + π) Ry(π − p) Rx(r + π) is Rz(y) Ry(p) Rx(r)
      if (std::abs(b) > kPi / 2) a += kPi, b = (b < 0 ? -kPi : kPi) - b, c += kPi;
      break;
    case AngleKind::kAxis: break;
  }
  return {wrapped(a), b, wrapped(c)};
}

}  // namespace taut
