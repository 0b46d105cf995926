// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/inside.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <vector>

#include "problem/expression.h"
#include "problem/scalar.h"

namespace taut::case_fields {
namespace {

using Eigen::Vector3d;

Vector3d vector_approx(const PointText& point) {
  const auto number = [](const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); };
  return {number(point[0]), number(point[1]), number(point[2])};
}

Eigen::Matrix3d rotation_approx(const BodyText& body) {
  const auto turn = [&](std::size_t k, const Vector3d& axis) {
    return Eigen::AngleAxisd(evaluate_constant<double>(body.rotation_rad[k]), axis).toRotationMatrix();
  };
  return turn(2, Vector3d::UnitZ()) * turn(1, Vector3d::UnitY()) * turn(0, Vector3d::UnitX());
}

/// The point nearest to 0 of a simplex with at most four corners, of which those that it does not need are removed: of
/// all faces whose own nearest point is within them, the nearest one's.
Vector3d nearest_of_simplex(std::vector<Vector3d>& corners) {
  double least = std::numeric_limits<double>::infinity();
  Vector3d nearest = Vector3d::Zero();
  std::vector<Vector3d> needed;
  for (unsigned subset = 1; subset < 1U << corners.size(); ++subset) {
    std::vector<Vector3d> face;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if ((subset >> k & 1U) != 0) face.push_back(corners[k]);
    }
    const auto edges = static_cast<Eigen::Index>(face.size()) - 1;
    Eigen::MatrixXd along(3, edges);
    for (Eigen::Index k = 0; k < edges; ++k) along.col(k) = face[static_cast<std::size_t>(k) + 1] - face[0];
    Vector3d point = face[0];
    if (edges > 0) {
      const Eigen::VectorXd weights = along.colPivHouseholderQr().solve(-face[0]);
      if (!(weights.minCoeff() >= 0 && weights.sum() <= 1)) continue;
      point += along * weights;
    }
    if (point.norm() >= least) continue;
    least = point.norm();
    nearest = point;
    needed = std::move(face);
  }
  corners = std::move(needed);
  return nearest;
}

/// The distance of 0 from the convex hull of one point or more: the algorithm of Gilbert, Johnson and Keerthi.
double distance_approx(const std::vector<Vector3d>& points) {
  constexpr double kRounding = 1e-12;
  constexpr int kMostSteps = 200;  // it takes some ten
  std::vector<Vector3d> simplex = {points.front()};
  Vector3d nearest = points.front();
  const double size = std::ranges::max_element(points, {}, [](const Vector3d& p) { return p.norm(); })->norm();
  for (int step = 0; step < kMostSteps; ++step) {
    const auto next = *std::ranges::min_element(points, {}, [&](const Vector3d& p) { return p.dot(nearest); });
    if (nearest.norm() <= kRounding * size || nearest.dot(nearest - next) <= kRounding * nearest.squaredNorm()) break;
    simplex.push_back(next);
    const Vector3d closer = nearest_of_simplex(simplex);
    if (closer.norm() >= nearest.norm()) break;
    nearest = closer;
  }
  return nearest.norm() <= kRounding * size ? 0 : nearest.norm();
}

/// Corners of a polyhedron around the unit ball: the directions of a cube's corners, edges and faces, of one length.
/// Each of its 48 faces is at the distance kLength / 1.1281 from the origin.
std::vector<Vector3d> polyhedron_around_ball() {
  constexpr double kLength = 1.1282;
  std::vector<Vector3d> corners;
  for (int code = 0; code < 27; ++code) {
    const Vector3d direction(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    if (direction.norm() > 0) corners.push_back(kLength * direction.normalized());
  }
  return corners;
}

}  // namespace

bool contains_ball_approx(const BodyText& body, const PointText& centre, double radius, double reach) {
  const Vector3d from_origin = vector_approx(centre) - vector_approx(body.at_m);
  if (const auto* half_space = std::get_if<HalfSpaceText>(&body.shape)) {
    return vector_approx(half_space->normal).normalized().dot(from_origin) + radius <= reach;
  }
  const auto* hull = std::get_if<HullText>(&body.shape);
  if (!hull) return false;
  const Vector3d in_body = rotation_approx(body).transpose() * from_origin;
  std::vector<Vector3d> points;
  for (const PointText& point : hull->points_m) points.push_back(vector_approx(point));
  const double most = reach + ScalarTraits<double>::from_decimal(hull->radius_m);
  // All points within `most` of a convex hull are convex, too: they contain the ball if they contain the corners of a
  // polyhedron around it.
  return std::ranges::all_of(polyhedron_around_ball(), [&](const Vector3d& corner) {
    std::vector<Vector3d> relative = points;
    for (Vector3d& point : relative) point -= in_body + radius * corner;
    return distance_approx(relative) <= most;
  });
}

}  // namespace taut::case_fields
