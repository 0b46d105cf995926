// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/waypoint_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taut {
namespace {

double largest_difference(const std::array<double, kCables>& a, const std::array<double, kCables>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < kCables; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

Interpolation usual_law(const PathHeader& header) {
  if (header.format == PathFormat::kTautControlPoints) return Interpolation::kCubicBSpline;
  switch (header.form) {
    case PathForm::kQuaternion: return Interpolation::kGeodesic;
    case PathForm::kCableLengths: return Interpolation::kCableLengths;
    default: return Interpolation::kStraight;
  }
}

WaypointMaker::WaypointMaker(const Problem& problem, const PathHeader& header, Interpolation law,
                             const std::string& file)
    : problem_(problem), header_(header), law_(law), file_(file), sampler_(problem) {
  const bool is_spline = header.format == PathFormat::kTautControlPoints;
  if (is_spline != (law == Interpolation::kCubicBSpline)) {
    throw InputError(fmt::format("{}: got {}", file,
                                 is_spline ? "a spline's control points, expected no other law for them"
                                           : "waypoints, expected a spline's control points"),
                     {file});
  }
  const bool has_lengths = header.form == PathForm::kCableLengths;
  if (has_lengths && law != Interpolation::kCableLengths) {
    throw InputError(fmt::format("{}: got cable lengths, expected the law cable-lengths for them", file), {file});
  }
  if (has_lengths && !header.start) {
    if (problem.query.empty()) {
      throw InputError(
          fmt::format("{}: got cable lengths and no pose, expected the pose to start from in the columns of the "
                      "first row, or a query in the case",
                      file),
          {file});
    }
    std::vector<double> parameters;
    for (const ExpressionText& value : problem.query.front()) parameters.push_back(evaluate_constant<double>(value));
    query_start_ = sampler_.rigid_pose(sampler_.pose(parameters));
  }
  const bool needs_angles = law == Interpolation::kStraight && header.form == PathForm::kQuaternion;
  is_converted_ = needs_angles || (law == Interpolation::kGeodesic && header.form != PathForm::kQuaternion) ||
                  (law == Interpolation::kCableLengths && !has_lengths);
  problem_.query.clear();
  const AnglesText& angles = header.angles;
  if (needs_angles && angles.kind != AngleKind::kTiltAndTorsion) {
    throw InputError(
        fmt::format("{}: got quaternions to be joined straight in {}, expected columns of these angles, or "
                    "the law geodesic",
                    file, angles_text(angles.kind)),
        {file});
  }
  if (has_poses(law)) {
    problem_.space = coordinate_space();
  } else if (header.form != PathForm::kParameters) {
    problem_.space = coordinate_space(angles);
  }
}

RigidPose WaypointMaker::pose_of(PathForm form, const std::vector<double>& x,
                                 const std::vector<int>& half_turns) const {
  if (form == PathForm::kQuaternion) {
    return {Vector3<double>(x[0], x[1], x[2]), Eigen::Quaterniond(x[6], x[3], x[4], x[5]).normalized()};
  }
  std::vector<double> values = x;
  for (std::size_t j = 0; j < half_turns.size(); ++j) values[j] += std::numbers::pi * half_turns[j];
  if (form == PathForm::kParameters) return sampler_.rigid_pose(sampler_.pose(values));
  Pose<double> pose{Vector3<double>(values[0], values[1], values[2]), {}};
  std::copy(values.begin() + 3, values.end(), pose.angles.begin());
  return sampler_.rigid_pose(pose);
}

std::optional<std::pair<std::size_t, std::size_t>> WaypointMaker::exchanged_lengths(double most_m) const {
  for (std::size_t i = 0; i < kCables; ++i) {
    for (std::size_t j = i + 1; j < kCables; ++j) {
      std::array<double, kCables> exchanged = first_lengths_;
      std::swap(exchanged[i], exchanged[j]);
      if (largest_difference(start_lengths_, exchanged) <= most_m) return std::pair(i, j);
    }
  }
  return std::nullopt;
}

void WaypointMaker::find_reference(const PathRow& row, const std::vector<double>& start) {
  std::array<double, kCables> lengths{};
  std::copy_n(row.x.begin(), kCables, lengths.begin());
  if (!pose_) {
    pose_ = header_.start ? pose_of(*header_.start, start, {}) : *query_start_;
    start_lengths_ = cable_lengths(sampler_.model(), *pose_);
    first_lengths_ = lengths;
    start_error_m_ = largest_difference(start_lengths_, first_lengths_);
  }
  if (lost_line_) return;
  if (const auto found = pose_of_lengths(sampler_.model(), lengths, *pose_)) {
    pose_ = found;
  } else {
    lost_line_ = row.line;
  }
}

const Waypoint& WaypointMaker::next(const PathRow& row, const std::vector<double>& start) {
  if (!is_converted_ && header_.form != PathForm::kCableLengths) {  // the law's own coordinates
    waypoint_ = waypoint_of(law_, row.x, row.half_turns);
    if (!has_poses(law_) && sampler_.constraints() && header_.form == PathForm::kParameters) {
      waypoint_.parameters().normals = sampler_.constraints()->normals(waypoint_);
    }
    return waypoint_;
  }
  if (header_.form == PathForm::kCableLengths) {
    find_reference(row, start);  // references turn as the motion does, even by more than half a turn
  } else {
    const std::optional<RigidPose> previous = pose_;
    pose_ = pose_of(header_.form, row.x, row.half_turns);
    if (previous && pose_->q.dot(previous->q) < 0) pose_->q.coeffs() = -pose_->q.coeffs();  // the shorter way
  }
  const RigidPose& pose = *pose_;
  if (law_ == Interpolation::kStraight) {
    angles_ = tilt_and_torsion(pose.q, angles_);
    const auto& [x, half_turns] = *angles_;
    waypoint_ = Waypoint({pose.p(0), pose.p(1), pose.p(2), x[0], x[1], x[2]},
                         {0, 0, 0, half_turns[0], half_turns[1], half_turns[2]});
    return waypoint_;
  }
  const PosePoint point{pose_numbers(pose)};
  waypoint_ = point;
  if (law_ != Interpolation::kCableLengths) return waypoint_;
  std::array<double, kCables> lengths = cable_lengths(sampler_.model(), pose);
  if (header_.form == PathForm::kCableLengths) std::copy_n(row.x.begin(), kCables, lengths.begin());
  for (std::size_t i = 0; i < kCables; ++i) {
    if (lengths[i] > 0) continue;
    throw InputError(fmt::format("{}:{}: got a pose in which cable {} has the length 0, expected lengths above 0",
                                 file_, row.line, i + 1),
                     {file_, row.line});
  }
  waypoint_ = LengthsPoint{point.pose, lengths};
  return waypoint_;
}

}  // namespace taut
