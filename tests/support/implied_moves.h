// SPDX-License-Identifier: GPL-3.0-or-later
// Random moves whose poses equations imply, or that run between poses; and the same for the oracle: Newton's method at
// 400 bits on equations that are written a second time, whose derivatives are quotients of differences.
#pragma once

#include <Eigen/LU>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "certify/prover.h"
#include "kinematics/constraint_functions.h"
#include "kinematics/pose_sampler.h"
#include "tests/support/moves.h"

namespace taut::testing {

using BigVector = std::vector<BigFloat>;

/// The zero of F next to `start`, where that is good to binary64: each step gains some dozen digits.
inline BigVector zero_near(const std::function<BigVector(const BigVector&)>& F, const std::vector<double>& start) {
  BigVector x;
  for (const double value : start) x.emplace_back(value);
  const auto n = static_cast<Eigen::Index>(start.size());
  const BigFloat h = oracle::big("1e-30");
  Eigen::MatrixXd jacobian(n, n);
  const BigVector here = F(x);
  for (Eigen::Index j = 0; j < n; ++j) {
    BigVector nudged = x;
    nudged[static_cast<std::size_t>(j)] += h;
    const BigVector there = F(nudged);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto row = static_cast<std::size_t>(i);
      jacobian(i, j) = ((there[row] - here[row]) / h).to_double(MPFR_RNDN);
    }
  }
  const Eigen::MatrixXd inverse = jacobian.inverse();
  constexpr int kMostSteps = 40;
  for (int step = 0; step < kMostSteps; ++step) {
    const BigVector value = F(x);
    BigFloat largest(0.0);
    for (Eigen::Index i = 0; i < n; ++i) {
      BigFloat correction(0.0);
      for (Eigen::Index j = 0; j < n; ++j) correction += BigFloat(inverse(i, j)) * value[static_cast<std::size_t>(j)];
      x[static_cast<std::size_t>(i)] -= correction;
      if (largest < abs(correction)) largest = abs(correction);
    }
    if (largest < oracle::big("1e-113")) return x;
  }
  throw std::runtime_error("the oracle's Newton method does not converge");
}

/// A problem with limits in time, a path with a law, and where the machine is at a place of the path.
struct ImpliedMove {
  enum class Kind { kSphere, kSphereAndTilt, kGeodesic, kLengths };
  static constexpr int kKinds = 4;

  MovingMachine machine;
  Kind kind;
  Path path;

  ImpliedMove(Operands& operands, Kind of_kind, double shortest_s) : machine(operands), kind(of_kind) {
    switch (kind) {
      case Kind::kSphere:
      case Kind::kSphereAndTilt: make_constrained(operands); break;
      case Kind::kGeodesic:
      case Kind::kLengths: make_between_poses(operands); break;
    }
    path.timing = some_time_law(operands, static_cast<double>(path.segments()), shortest_s);
    const Prover prover(machine.problem);
    for (std::size_t k = 0; k < path.segments(); ++k) {
      const Segment prepared = prover.prepared(path.segment(k));
      if (is_constrained()) path.tubes.push_back(prepared.tube);
      if (kind != Kind::kLengths) continue;
      path.pose_tubes.push_back(prepared.pose_tube);
      path.inner_poses.push_back(prepared.inner_poses);
    }
  }

  [[nodiscard]] bool is_constrained() const { return kind == Kind::kSphere || kind == Kind::kSphereAndTilt; }

  /// px, py, pz [m], phi, theta, sigma [rad] at a place that counts segments. Within PrecisionScope(kMovingBits).
  [[nodiscard]] oracle::Big6 pose(const BigFloat& place) const {
    const double whole =
        std::clamp(std::floor(place.to_double(MPFR_RNDN)), 0.0, static_cast<double>(path.segments() - 1));
    const Segment segment = path.segment(static_cast<std::size_t>(whole));
    const BigFloat s = place - BigFloat(whole);
    if (is_constrained()) return on_constraints(segment, s);
    return kind == Kind::kGeodesic ? on_geodesic(segment, s) : of_lengths(segment, s);
  }
  [[nodiscard]] oracle::Move move() const {
    return oracle::Move([this](const BigFloat& t) { return pose(oracle::place_on_path(*path.timing, t)); });
  }

 private:
  void make_constrained(Operands& operands) {
    Problem& problem = machine.problem;
    problem.space.constraints =
        kind == Kind::kSphere
            ? std::vector<ExpressionText>{"px + 0.13*sin(theta)*cos(phi)", "py + 0.13*sin(theta)*sin(phi)",
                                          "pz - 0.306 + 0.13*cos(theta)"}
            : std::vector<ExpressionText>{"px^2 + py^2 + (pz - 0.306)^2 - 0.13^2", "theta - 2*px*exp(-py)"};
    const ConstraintFunctions functions(problem);
    const auto onto = [&](Waypoint point) {
      for (int newton = 0; newton < 8; ++newton) {
        point.parameters().normals = functions.normals(point);
        point.parameters().x = functions.parameters(Segment::straight(point, point), 0);
      }
      point.parameters().normals = functions.normals(point);
      return point;
    };
    const auto some_point = [&] {
      return onto(at({operands.uniform(0.02, 0.09), operands.uniform(0.02, 0.09), operands.uniform(0.2, 0.22),
                      operands.uniform(-2.8, -2.2), operands.uniform(0.1, 0.3), operands.uniform(-0.3, 0.3)}));
    };
    const auto between = [&](const Waypoint& from, const Waypoint& to, double share) {
      Waypoint result = from;
      for (std::size_t j = 0; j < result.parameters().x.size(); ++j)
        result.parameters().x[j] += share * (to.parameters().x[j] - from.parameters().x[j]);
      return result;
    };
    const Waypoint a = some_point(), c = onto(between(a, some_point(), operands.uniform(0.2, 0.5)));
    Waypoint b = between(a, c, operands.uniform(0.3, 0.7));  // not on them, where it is a control point
    b.parameters().normals = functions.normals(b);
    path.interpolation = operands.coin(0.5) ? Interpolation::kCubicBSpline : Interpolation::kStraight;
    if (path.interpolation == Interpolation::kStraight) {
      path.waypoints = {a, c};
    } else {
      path.waypoints =
          operands.coin(0.5) ? std::vector<Waypoint>{a, a, a, b, c, c, c} : std::vector<Waypoint>{a, a, b, c};
    }
  }

  void make_between_poses(Operands& operands) {
    const bool by_lengths = kind == Kind::kLengths;
    path.interpolation = by_lengths ? Interpolation::kCableLengths : Interpolation::kGeodesic;
    const PoseSampler sampler(machine.problem);
    const Waypoint from = some_pose(operands);
    Waypoint to = from;
    const double part = by_lengths ? 0.3 : 1;
    const Waypoint far = some_pose(operands);
    for (std::size_t j = 0; j < to.parameters().x.size(); ++j)
      to.parameters().x[j] += part * (far.parameters().x[j] - from.parameters().x[j]);
    for (const Waypoint& corner : {from, to}) {
      const RigidPose pose = rigid_pose(
          TiltedPose{Vector3<double>(corner.parameters().x[0], corner.parameters().x[1], corner.parameters().x[2]),
                     corner.parameters().x[3], corner.parameters().x[4], corner.parameters().x[5]});
      const double size = operands.uniform(0.5, 2);  // a quaternion may have any
      const Eigen::Vector4d q = size * pose.q.coeffs();
      const PoseNumbers x = {pose.p(0), pose.p(1), pose.p(2), q(0), q(1), q(2), q(3)};
      if (by_lengths) {
        path.waypoints.emplace_back(LengthsPoint{x, cable_lengths(sampler.model(), pose)});
      } else {
        path.waypoints.emplace_back(PosePoint{x});
      }
    }
  }

  [[nodiscard]] static BigFloat mixed(const Segment& segment, const BigFloat& s,
                                      const std::function<double(const Waypoint&)>& number) {
    const auto q = [&](std::size_t i) { return BigFloat(number(*segment.control[i])); };
    if (segment.law == Interpolation::kCubicBSpline) return oracle::spline({q(0), q(1), q(2), q(3)}, s);
    return (BigFloat(1.0) - s) * q(0) + s * q(1);
  }

  [[nodiscard]] BigVector constraints_at(const BigVector& q) const {
    const BigFloat z = q[2] - oracle::big("0.306"), r = oracle::big("0.13");
    if (kind == Kind::kSphereAndTilt) {
      return {q[0] * q[0] + q[1] * q[1] + z * z - r * r, q[4] - BigFloat(2.0) * q[0] * exp(-q[1])};
    }
    const BigFloat sine = r * oracle::sine(q[4]);
    return {q[0] + sine * oracle::cosine(q[3]), q[1] + sine * oracle::sine(q[3]), z + r * oracle::cosine(q[4])};
  }

  [[nodiscard]] oracle::Big6 on_constraints(const Segment& segment, const BigFloat& s) const {
    const std::size_t k = machine.problem.space.constraints.size();
    BigVector line, normals;
    for (std::size_t j = 0; j < 6; ++j) {
      line.push_back(mixed(segment, s, [j](const Waypoint& w) { return w.parameters().x[j]; }));
      for (std::size_t i = j * k; i < (j + 1) * k; ++i) {
        normals.push_back(mixed(segment, s, [i](const Waypoint& w) { return w.parameters().normals[i]; }));
      }
    }
    const auto at_unknowns = [&](const BigVector& y) {
      BigVector result = line;
      for (std::size_t j = 0; j < 6; ++j) {
        for (std::size_t i = 0; i < k; ++i) result[j] += normals[j * k + i] * y[i];
      }
      return result;
    };
    const auto start = ConstraintFunctions(machine.problem).unknowns(segment, s.to_double(MPFR_RNDN)).value();
    const BigVector y = zero_near([&](const BigVector& unknowns) { return constraints_at(at_unknowns(unknowns)); },
                                  {start.data(), start.data() + start.size()});
    const BigVector x = at_unknowns(y);
    return {x[0], x[1], x[2], x[3], x[4], x[5]};
  }

  /// The turn from R0 to R1, as 2 atan(|v| / |c|) about v, of conj(q0) q1 = (v, c).
  [[nodiscard]] oracle::Big6 on_geodesic(const Segment& segment, const BigFloat& s) const {
    const auto vector = [&](std::size_t i) {
      const PoseNumbers& x = segment.control[i]->pose();
      return oracle::Big3{BigFloat(x[3]), BigFloat(x[4]), BigFloat(x[5])};
    };
    const oracle::Big3 u0 = vector(0), u1 = vector(1), across = oracle::cross(u0, u1);
    const BigFloat w0(segment.control[0]->pose()[6]), w1(segment.control[1]->pose()[6]);
    BigFloat c = w0 * w1, square(0.0);
    oracle::Big3 v;
    for (std::size_t k = 0; k < 3; ++k) {
      c += u0[k] * u1[k];
      v[k] = w0 * u1[k] - w1 * u0[k] - across[k];
      square += v[k] * v[k];
    }
    const BigFloat size = oracle::root(square), half = s * atan2(c < BigFloat(0.0) ? -size : size, abs(c));
    // q0 (sin half v/|v|, cos half)
    const BigFloat cosine = oracle::cosine(half), scale = oracle::sine(half) / size;
    oracle::Big3 u;
    BigFloat w = w0 * cosine;
    const oracle::Big3 beside = oracle::cross(u0, v);
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = cosine * u0[k] + scale * (w0 * v[k] + beside[k]);
      w -= scale * u0[k] * v[k];
    }
    BigFloat norm = w * w;
    for (const BigFloat& x : u) norm += x * x;
    std::array<oracle::Big3, 3> columns;
    for (std::size_t k = 0; k < 3; ++k) {  // e + 2 (w u x e + u x (u x e)) / |q|^2
      oracle::Big3 e = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
      e[k] = BigFloat(1.0);
      const oracle::Big3 once = oracle::cross(u, e), twice = oracle::cross(u, once);
      for (std::size_t j = 0; j < 3; ++j) {
        columns[k][j] = e[j] + BigFloat(2.0) * (w * once[j] + twice[j]) / norm;
      }
    }
    const BigFloat phi = atan2(columns[2][1], columns[2][0]);
    const BigFloat sine = oracle::root(columns[2][0] * columns[2][0] + columns[2][1] * columns[2][1]);
    const auto p = [&](std::size_t j) { return mixed(segment, s, [j](const Waypoint& x) { return x.pose()[j]; }); };
    return {p(0), p(1), p(2), phi, atan2(sine, columns[2][2]), phi + atan2(columns[1][2], -columns[0][2])};
  }

  [[nodiscard]] oracle::Big6 of_lengths(const Segment& segment, const BigFloat& s) const {
    const std::vector<double> start = PoseSampler(machine.problem).parameters(segment, s.to_double(MPFR_RNDN));
    const auto excess = [&](const BigVector& x) {
      const oracle::Big6 pose = {x[0], x[1], x[2], x[3], x[4], x[5]};
      BigVector result;
      for (std::size_t i = 0; i < kCables; ++i) {
        const BigFloat length =
            oracle::distance(oracle::place(pose, oracle::big(machine.problem.robot.platform_anchors_m[i])),
                             oracle::big(machine.problem.robot.base_anchors_m[i]));
        result.push_back(length - mixed(segment, s, [i](const Waypoint& w) { return w.lengths_m()[i]; }));
      }
      return result;
    };
    const BigVector x = zero_near(excess, start);
    return {x[0], x[1], x[2], x[3], x[4], x[5]};
  }
};

}  // namespace taut::testing
