// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/angles.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "kinematics/geometry.h"

namespace taut {
namespace {

using std::numbers::pi;

/// Within (−π, π].
double wrapped(double angle) { return angle - 2 * pi * std::ceil((angle - pi) / (2 * pi)); }

}  // namespace

std::array<double, 3> customary_angles(AngleKind kind, const std::array<double, 3>& angles) {
  if (!std::ranges::all_of(angles, [](double x) { return std::isfinite(x); })) return angles;
  auto [a, b, c] = angles;
  b = wrapped(b);
  switch (kind) {
    case AngleKind::kTiltAndTorsion:  // Rz(φ + π) Ry(−θ) Rz(σ − φ − π) is Rz(φ) Ry(θ) Rz(σ − φ)
      if (b < 0) a += pi, b = -b;
      break;
    case AngleKind::kZyz:
      if (b < 0) a += pi, b = -b, c += pi;
      break;
    case AngleKind::kRollPitchYaw:  // Rz(y + π) Ry(π − p) Rx(r + π) is Rz(y) Ry(p) Rx(r)
      if (std::abs(b) > pi / 2) a += pi, b = (b < 0 ? -pi : pi) - b, c += pi;
      break;
    case AngleKind::kAxis: break;
  }
  return {wrapped(a), b, wrapped(c)};
}

namespace {

/// The other form of an orientation: each angle that is not wrapped may take it.
std::array<double, 3> flipped(AngleKind kind, const std::array<double, 3>& x) {
  switch (kind) {
    case AngleKind::kTiltAndTorsion: return {x[0] + pi, -x[1], x[2]};
    case AngleKind::kRollPitchYaw: return {x[0] + pi, pi - x[1], x[2] + pi};
    default: break;
  }
  return {x[0] + pi, -x[1], x[2] + pi};
}

}  // namespace

AnglesText shown_angles(const Certificate& certificate) {
  AnglesText result = certificate.problem.space.angles;
  if (!has_poses(certificate.path.interpolation) || !certificate.illustration.is_object()) return result;
  const auto stated = certificate.illustration.find("angles");
  if (stated == certificate.illustration.end() || !stated->is_string()) return result;
  for (const AngleKind kind : {AngleKind::kRollPitchYaw, AngleKind::kZyz}) {
    if (stated->get_ref<const std::string&>() == name(kind)) result.kind = kind;
  }
  return result;
}

std::array<double, 3> angles_of(AngleKind kind, const Matrix3<double>& r) {
  constexpr double kLocked = 1e-9;
  std::array<double, 3> x{};
  if (kind == AngleKind::kRollPitchYaw) {
    const double level = std::hypot(r(0, 0), r(1, 0));
    x = {std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), level), std::atan2(r(1, 0), r(0, 0))};
    if (level < kLocked) x[0] = 0, x[2] = std::atan2(-r(0, 1), r(1, 1));
    return customary_angles(kind, x);
  }
  const double tilt = std::hypot(r(0, 2), r(1, 2));
  x = {std::atan2(r(1, 2), r(0, 2)), std::atan2(tilt, r(2, 2)), std::atan2(r(2, 1), -r(2, 0))};
  if (tilt < kLocked) x[0] = 0, x[2] = std::atan2(r(1, 0), r(1, 1));
  if (kind == AngleKind::kTiltAndTorsion) x[2] += x[0];
  return customary_angles(kind, x);
}

std::array<double, 3> angles_of(AngleKind kind, const Angles<double>& model, const std::array<double, 3>& x) {
  return kind == model.kind ? customary_angles(kind, x) : angles_of(kind, rotation(model, x));
}

std::array<double, 3> nearest_angles(AngleKind kind, const std::array<double, 3>& angles,
                                     const std::array<double, 3>& previous) {
  std::array<double, 3> best{};
  double least = HUGE_VAL;
  for (std::array<double, 3> x : {angles, flipped(kind, angles)}) {
    double apart = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      x[c] += 2 * pi * std::round((previous[c] - x[c]) / (2 * pi));
      apart += std::abs(x[c] - previous[c]);
    }
    if (apart < least) least = apart, best = x;
  }
  return best;
}

}  // namespace taut
