// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/constraint_functions.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace taut {

ConstraintFunctions::ConstraintFunctions(const Problem& problem)
    : count_(static_cast<int>(problem.space.constraints.size())),
      parameters_(static_cast<int>(problem.space.parameters.size())),
      jets_(constraint_tape(problem)) {}

void ConstraintFunctions::evaluate(const Vector& lambda, Vector& values, Jacobian& jacobian) const {
  using J = Jet<double, kMaxConstrainedParameters>;
  std::array<J, kMaxConstrainedParameters> jets;
  for (int j = 0; j < parameters_; ++j) jets[static_cast<std::size_t>(j)] = J(lambda[j], j);
  std::array<J, kMaxConstrainedParameters> c;
  jets_.evaluate(std::span<const J>(jets.data(), static_cast<std::size_t>(parameters_)),
                 std::span<J>(c.data(), static_cast<std::size_t>(count_)));
  values.resize(count_);
  jacobian.resize(count_, parameters_);
  for (int i = 0; i < count_; ++i) {
    values[i] = c[static_cast<std::size_t>(i)].value;
    for (int j = 0; j < parameters_; ++j) {
      jacobian(i, j) = c[static_cast<std::size_t>(i)].partial[static_cast<std::size_t>(j)];
    }
  }
}

int ConstraintFunctions::rank(const Jacobian& jacobian) {
  constexpr double kRankThreshold = 1e-9;  // relative; far above rounding
  if (!jacobian.allFinite()) return 0;
  Eigen::ColPivHouseholderQR<Jacobian> qr(jacobian.rowwise().normalized().transpose());
  qr.setThreshold(kRankThreshold);
  return static_cast<int>(qr.rank());
}

ConstraintFunctions::Jacobian ConstraintFunctions::normals(const Jacobian& jacobian) {
  // Rows to unit length first, so that the units of the constraints do not matter.
  const Jacobian unit = jacobian.rowwise().normalized();
  const Jacobian gram = unit * unit.transpose();
  const Eigen::SelfAdjointEigenSolver<Jacobian> eigen(gram);
  return unit.transpose() * eigen.operatorInverseSqrt();
}

ConstraintFunctions::Jacobian ConstraintFunctions::normals_at(const Vector& lambda) const {
  Vector values;
  Jacobian jacobian;
  evaluate(lambda, values, jacobian);
  if (!has_full_rank(jacobian)) return Jacobian::Zero(parameters_, count_);
  return normals(jacobian);
}

std::vector<double> ConstraintFunctions::normals(const Waypoint& waypoint) const {
  Vector lambda(parameters_);
  for (int j = 0; j < parameters_; ++j) {
    const auto i = static_cast<std::size_t>(j);
    lambda[j] = waypoint.parameters().x[i] + ScalarTraits<double>::pi() * waypoint.parameters().half_turns[i];
  }
  std::vector<double> result(static_cast<std::size_t>(parameters_ * count_));
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(result.data(), parameters_,
                                                                                     count_) = normals_at(lambda);
  return result;
}

std::optional<ConstraintFunctions::Vector> ConstraintFunctions::project(const Vector& lambda,
                                                                        const Jacobian& normals) const {
  constexpr int kMostSteps = 20;
  constexpr double kConverged = 1e-13;  // relative to the parameters, in metres and radians
  const double scale = std::max(1.0, lambda.lpNorm<Eigen::Infinity>());
  Vector y = Vector::Zero(count_);
  Vector values;
  Jacobian jacobian;
  for (int step = 0; step < kMostSteps; ++step) {
    evaluate(lambda + normals * y, values, jacobian);
    const Jacobian g_y = jacobian * normals;
    const Vector correction = g_y.partialPivLu().solve(values);
    if (!correction.allFinite()) return std::nullopt;
    y -= correction;
    if (correction.lpNorm<Eigen::Infinity>() <= kConverged * scale) return y;
  }
  return std::nullopt;
}

std::optional<ConstraintFunctions::Vector> ConstraintFunctions::nearest(const Vector& lambda) const {
  Vector values;
  Jacobian jacobian;
  evaluate(lambda, values, jacobian);
  if (!has_full_rank(jacobian)) return std::nullopt;
  const Jacobian n = normals(jacobian);
  const std::optional<Vector> y = project(lambda, n);
  if (!y) return std::nullopt;
  return lambda + n * *y;
}

ConstraintFunctions::ReferencePoint ConstraintFunctions::reference_point(const Segment& segment, double s) const {
  ReferencePoint result{Vector(parameters_), Jacobian(parameters_, count_)};
  for (int j = 0; j < parameters_; ++j) {
    const auto row = static_cast<std::size_t>(j);
    result.lambda[j] = coordinate_polynomial<double>(segment, row).at(s);
    for (int i = 0; i < count_; ++i) {
      const std::size_t index = row * static_cast<std::size_t>(count_) + static_cast<std::size_t>(i);
      result.normals(j, i) = normal_polynomial<double>(segment, index).at(s);
    }
  }
  return result;
}

std::optional<ConstraintFunctions::Vector> ConstraintFunctions::unknowns(const Segment& segment, double s) const {
  const ReferencePoint at = reference_point(segment, s);
  return project(at.lambda, at.normals);
}

std::optional<double> ConstraintFunctions::deviation(const Segment& segment, double s) const {
  const std::optional<Vector> y = unknowns(segment, s);
  if (!y) return std::nullopt;
  return y->lpNorm<Eigen::Infinity>();
}

std::vector<double> ConstraintFunctions::parameters(const Segment& segment, double s) const {
  ReferencePoint at = reference_point(segment, s);
  if (const std::optional<Vector> y = project(at.lambda, at.normals)) at.lambda += at.normals * *y;
  return {at.lambda.data(), at.lambda.data() + at.lambda.size()};
}

namespace {

/// How far apart two parameter vectors are, whose parameters are coordinates of the pose.
struct Deviation {
  double length = 0;  ///< [m]
  double angle = 0;   ///< [rad]
};

Deviation deviation_between(const SpaceText& space, const ConstraintFunctions::Vector& a,
                            const ConstraintFunctions::Vector& b) {
  Deviation result;
  for (int j = 0; j < a.size(); ++j) {
    const std::string& name = space.parameters[static_cast<std::size_t>(j)].name;
    double& part = name == "px" || name == "py" || name == "pz" ? result.length : result.angle;
    part = std::hypot(part, a[j] - b[j]);
  }
  return result;
}

}  // namespace

void require_query_on_constraints(const Problem& problem, const Unit& length_unit) {
  if (problem.space.constraints.empty()) return;
  const ConstraintFunctions constraints(problem);
  const double size = make_model<double>(problem).characteristic_length;
  for (std::size_t k = 0; k < problem.query.size(); ++k) {
    const std::string here = fmt::format("query.waypoints[{}]", k);
    ConstraintFunctions::Vector lambda(static_cast<int>(problem.query[k].size()));
    for (int j = 0; j < lambda.size(); ++j) {
      lambda[j] = evaluate_constant<double>(problem.query[k][static_cast<std::size_t>(j)]);
    }
    ConstraintFunctions::Vector values;
    ConstraintFunctions::Jacobian jacobian;
    constraints.evaluate(lambda, values, jacobian);
    if (const int rank = ConstraintFunctions::rank(jacobian); rank < constraints.count()) {
      throw FieldError(
          "space.constraints", "",
          fmt::format("got constraints of rank {} at {}, expected rank {}: there they contradict or repeat each "
                      "other, or their derivatives vanish",
                      rank, here, constraints.count()));
    }
    const auto reached = constraints.nearest(lambda);
    if (!reached) {
      throw FieldError(here, "a waypoint off the constraints",
                       "expected one on them: no pose on them was found near it");
    }
    const Deviation off = deviation_between(problem.space, lambda, *reached);
    if (std::hypot(off.length / size, off.angle) <= kWaypointTolerance) continue;
    const double factor = ScalarTraits<double>::from_decimal(length_unit.factor.text());
    throw FieldError(here,
                     fmt::format("a waypoint that is {:.3g} {} and {:.3g} rad off the constraints", off.length / factor,
                                 length_unit.name, off.angle),
                     fmt::format("expected at most {:.3g} {}, or {} rad", kWaypointTolerance * size / factor,
                                 length_unit.name, kWaypointTolerance));
  }
}

}  // namespace taut
