#include "kinematics/rigid_pose.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace taut {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Eigen::Quaterniond quaternion(const Waypoint& waypoint) {
  return Eigen::Quaterniond(waypoint.x[6], waypoint.x[3], waypoint.x[4], waypoint.x[5]);
}

/// ∂|d_i|²/2 by (p, rotation vector in W): rows (d_i ; R b_i × d_i).
Matrix6d jacobian(const Model<double>& model, const RigidPose& pose) {
  Matrix6d result;
  for (int i = 0; i < kCables; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Eigen::Vector3d reach = pose.r_WP * model.p_PB[n];
    const Eigen::Vector3d d = pose.p_WP + reach - model.p_WA[n];
    result.block<1, 3>(i, 0) = d.transpose();
    result.block<1, 3>(i, 3) = reach.cross(d).transpose();
  }
  return result;
}

RigidPose moved(const RigidPose& pose, const Vector6d& step) {
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  RigidPose result = pose;
  result.p_WP += step.head<3>();
  if (angle > 0) result.r_WP = Eigen::AngleAxisd(angle, turn / angle) * pose.r_WP;
  return result;
}

}  // namespace

RigidPose pose_between(const Segment& segment, double s) {
  const Waypoint& a = *segment.control[0];
  const Waypoint& b = *segment.control[1];
  RigidPose result;
  for (int k = 0; k < 3; ++k) {
    const auto j = static_cast<std::size_t>(k);
    result.p_WP(k) = (1 - s) * a.x[j] + s * b.x[j];
  }
  const Eigen::Quaterniond q0 = quaternion(a);
  const Eigen::Quaterniond q1 = quaternion(b);
  const Eigen::Quaterniond q = segment.law == Interpolation::kGeodesic
                                   ? q0.normalized().slerp(s, q1.normalized())
                                   : Eigen::Quaterniond((1 - s) * q0.coeffs() + s * q1.coeffs()).normalized();
  result.r_WP = q.toRotationMatrix();
  return result;
}

std::array<double, 7> pose_numbers(const RigidPose& pose, const std::array<double, 4>& near) {
  Eigen::Quaterniond q(pose.r_WP);
  q.normalize();
  if (q.x() * near[0] + q.y() * near[1] + q.z() * near[2] + q.w() * near[3] < 0) q.coeffs() *= -1;
  return {pose.p_WP(0), pose.p_WP(1), pose.p_WP(2), q.x(), q.y(), q.z(), q.w()};
}

std::array<double, kCables> lengths(const Model<double>& model, const RigidPose& pose) {
  std::array<double, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result[i] = (pose.p_WP + pose.r_WP * model.p_PB[i] - model.p_WA[i]).norm();
  }
  return result;
}

std::optional<RigidPose> pose_of_lengths(const Model<double>& model, const RigidPose& start,
                                         const std::array<double, kCables>& wanted) {
  constexpr int kMostSteps = 30;
  constexpr double kRounding = 1e-14;  // of the platform's size
  RigidPose pose = start;
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    const std::array<double, kCables> have = lengths(model, pose);
    Vector6d residual;
    for (int i = 0; i < kCables; ++i) {
      const auto n = static_cast<std::size_t>(i);
      residual(i) = 0.5 * (have[n] - wanted[n]) * (have[n] + wanted[n]);
    }
    const Vector6d correction = jacobian(model, pose).partialPivLu().solve(-residual);
    const double size = std::max(correction.head<3>().norm() / model.characteristic_length, correction.tail<3>().norm());
    if (!(size < 1)) return std::nullopt;  // also where it is no number
    pose = moved(pose, correction);
    if (size < kRounding || (size < 1e-9 && size > 0.5 * last)) return pose;
    last = size;
  }
  return std::nullopt;
}

std::optional<std::array<double, 6>> displacement(const Model<double>& model, const RigidPose& pose,
                                                  const std::array<double, kCables>& errors) {
  const Matrix6d inverse = jacobian(model, pose).inverse();
  if (!inverse.allFinite()) return std::nullopt;
  const std::array<double, kCables> have = lengths(model, pose);
  std::array<double, 6> result{};
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < kCables; ++i) {
      const auto n = static_cast<std::size_t>(i);
      result[static_cast<std::size_t>(k)] += std::abs(inverse(k, i)) * have[n] * errors[n];
    }
  }
  return result;
}

}  // namespace taut
