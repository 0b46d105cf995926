// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/pose_conversion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace taut {
namespace {

/// The one of x + 2π k that is nearest to `target`, as k whole turns.
int turns_towards(double x, double target) {
  return static_cast<int>(std::lround((target - x) / (2 * std::numbers::pi)));
}

/// Within (−π, π].
double principal(double angle) {
  const double reduced = std::remainder(angle, 2 * std::numbers::pi);
  return reduced <= -std::numbers::pi ? std::numbers::pi : reduced;
}

using Lengths = Eigen::Matrix<double, kCables, 1>;

Lengths lengths_at(const Model<double>& model, const RigidPose& pose) {
  const std::array<double, kCables> lengths = cable_lengths(model, pose);
  return Lengths(lengths.data());
}

/// |d_i|, and their derivatives by (p, rotation vector in W): rows (u_i ; R b_i × u_i).
struct LengthRates {
  Lengths lengths;
  Matrix6<double> jacobian;

  LengthRates(const Model<double>& model, const RigidPose& pose) {
    const Matrix3<double> r_WP = pose.q.toRotationMatrix();
    for (int i = 0; i < kCables; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const Vector3<double> arm = r_WP * model.p_PB[n];
      const Vector3<double> d = pose.p + arm - model.p_WA[n];
      lengths(i) = d.norm();
      const Vector3<double> direction = d / lengths(i);
      jacobian.row(i) << direction.transpose(), arm.cross(direction).transpose();
    }
  }
};

/// Newton's method; nothing unless it converges to the last digits, and well from its second step on: then hardly to
/// another pose than the one to which `pose` leads.
std::optional<RigidPose> newton(const Model<double>& model, const Lengths& target, RigidPose pose) {
  constexpr int kMaxIterations = 24;
  constexpr double kConverged = 1e-13;       // of the lengths; what rounding leaves is less
  constexpr double kExact = 2e-16;           // of the lengths
  constexpr double kMaxTurn = 0.5;           // rad in one step
  constexpr double kContraction = 1.0 / 16;  // of the second step, by which the distance to where it fails is judged
  double last_error = std::numeric_limits<double>::infinity();
  double last_size = 0;
  RigidPose last_pose = pose;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const LengthRates at(model, pose);
    const Lengths residual = target - at.lengths;
    const double error = residual.cwiseAbs().maxCoeff() / target.maxCoeff();
    if (!std::isfinite(error)) return std::nullopt;
    if (error <= kExact) return pose;
    if (last_error <= kConverged && error > 0.5 * last_error) return error < last_error ? pose : last_pose;
    const Vector6<double> step = Eigen::PartialPivLU<Matrix6<double>>(at.jacobian).solve(residual);
    const Vector3<double> turn = step.tail<3>();
    const double angle = turn.norm();
    const double size = std::hypot(step.head<3>().norm() / model.characteristic_length, angle);
    if (!std::isfinite(size) || angle > kMaxTurn) return std::nullopt;
    if (error > kConverged && iteration > 0 && size > (iteration == 1 ? kContraction : 0.5) * last_size) {
      return std::nullopt;
    }
    last_error = error;
    last_size = size;
    last_pose = pose;
    pose.p += step.head<3>();
    if (angle > 0) pose.q = (Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * pose.q).normalized();
  }
  return std::nullopt;
}

}  // namespace

namespace {

/// Of R = Rz(phi) Ry(theta) Rz(sigma − phi).
Eigen::Quaterniond quaternion(double phi, double theta, double sigma) {
  const SinCos<double> tilt = sincos(theta / 2);
  const SinCos<double> torsion = sincos(sigma / 2);
  const SinCos<double> direction = sincos(phi - sigma / 2);
  return {tilt.cos * torsion.cos, -(tilt.sin * direction.sin), tilt.sin * direction.cos, tilt.cos * torsion.sin};
}

/// By the angle x about the unit vector n.
Eigen::Quaterniond about(const Vector3<double>& n, double x) {
  const Vector3<double> v = std::sin(x / 2) * n;
  return {std::cos(x / 2), v(0), v(1), v(2)};
}

Eigen::Quaterniond quaternion(const Angles<double>& angles, const std::array<double, 3>& x) {
  switch (angles.kind) {
    case AngleKind::kTiltAndTorsion: break;
    case AngleKind::kRollPitchYaw:
      return about(Vector3<double>::UnitZ(), x[2]) * about(Vector3<double>::UnitY(), x[1]) *
             about(Vector3<double>::UnitX(), x[0]);
    case AngleKind::kZyz: return quaternion(x[0], x[1], x[0] + x[2]);
    case AngleKind::kAxis: return about({angles.cross(2, 1), angles.cross(0, 2), angles.cross(1, 0)}, x[0]);
  }
  return quaternion(x[0], x[1], x[2]);
}

}  // namespace

RigidPose rigid_pose(const Angles<double>& angles, const Pose<double>& pose) {
  return {pose.p_WP, quaternion(angles, pose.angles)};
}

RigidPose rigid_pose(const TiltedPose& pose) { return {pose.p, quaternion(pose.phi, pose.theta, pose.sigma)}; }

double TiltAndTorsion::value(std::size_t i) const { return x[i] + std::numbers::pi * half_turns[i]; }

TiltAndTorsion tilt_and_torsion(const Eigen::Quaterniond& q, const std::optional<TiltAndTorsion>& previous) {
  const double tilted = std::hypot(q.x(), q.y());
  const double upright = std::hypot(q.w(), q.z());
  const double theta = 2 * std::atan2(tilted, upright);
  const double old_phi = previous ? previous->value(0) : 0;
  const double old_sigma = previous ? previous->value(2) : 0;
  const double sigma = upright > 0 ? 2 * std::atan2(q.z(), q.w()) : old_sigma;
  const double phi = tilted > 0 ? std::atan2(-q.x(), q.y()) + sigma / 2 : old_phi;
  TiltAndTorsion result;
  result.x = {principal(phi), theta, principal(sigma)};
  if (!previous) return result;
  result.half_turns[2] = 2 * turns_towards(result.x[2], old_sigma);
  TiltAndTorsion flipped = result;
  flipped.x[1] = -theta;
  result.half_turns[0] = 2 * turns_towards(result.x[0], old_phi);
  flipped.half_turns[0] = 1 + 2 * turns_towards(result.x[0] + std::numbers::pi, old_phi);
  const auto distance = [&](const TiltAndTorsion& t) {
    return std::abs(t.value(0) - old_phi) + std::abs(t.value(1) - previous->value(1));
  };
  return distance(flipped) < distance(result) ? flipped : result;
}

std::array<double, kCables> cable_lengths(const Model<double>& model, const RigidPose& pose) {
  const Matrix3<double> r_WP = pose.q.toRotationMatrix();
  std::array<double, kCables> lengths{};
  for (std::size_t i = 0; i < kCables; ++i) {
    const Vector3<double> d = pose.p + r_WP * model.p_PB[i] - model.p_WA[i];
    lengths[i] = d.norm();
  }
  return lengths;
}

std::optional<RigidPose> pose_of_lengths(const Model<double>& model, const std::array<double, kCables>& lengths,
                                         const RigidPose& start) {
  constexpr double kLeastStep = 0x1p-48;
  constexpr int kMostSteps = 10000;
  const Lengths target(lengths.data());
  std::optional<Lengths> from;  // most ways are taken in one step, which does not ask for it
  RigidPose pose = start;
  double s = 0;
  double step = 1;
  for (int k = 0; k < kMostSteps && step >= kLeastStep; ++k) {
    const double next = std::min(1.0, s + step);
    if (next < 1 && !from) from = lengths_at(model, start);
    const auto found = newton(model, next < 1 ? Lengths(*from + (target - *from) * next) : target, pose);
    if (!found) {
      step /= 2;
      continue;
    }
    if (next == 1) return found;
    pose = *found;
    s = next;
    step *= 2;
  }
  return std::nullopt;
}

PoseNumbers pose_numbers(const RigidPose& pose) {
  return {pose.p(0), pose.p(1), pose.p(2), pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()};
}

RigidPose rigid_pose(const PoseNumbers& x) {
  return {{x[0], x[1], x[2]}, Eigen::Quaterniond(x[6], x[3], x[4], x[5]).normalized()};
}

RigidPose pose_between(const Segment& segment, double s) {
  const ReferencePiece piece = reference_piece(segment, s);
  const double t = (s - piece.from) / (piece.to - piece.from);
  const auto orientation = [](std::span<const double> x) { return Eigen::Quaterniond(x[6], x[3], x[4], x[5]); };
  RigidPose result;
  for (std::size_t k = 0; k < 3; ++k) result.p(static_cast<int>(k)) = (1 - t) * piece.first[k] + t * piece.last[k];
  const Eigen::Quaterniond first = orientation(piece.first);
  const Eigen::Quaterniond last = orientation(piece.last);
  if (segment.law == Interpolation::kGeodesic) {
    result.q = first.normalized().slerp(t, last.normalized());
  } else {
    result.q = Eigen::Quaterniond((1 - t) * first.coeffs() + t * last.coeffs()).normalized();
  }
  return result;
}

}  // namespace taut
