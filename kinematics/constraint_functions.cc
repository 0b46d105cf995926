#include "kinematics/constraint_functions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

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

bool ConstraintFunctions::has_full_rank(const Jacobian& jacobian) {
  constexpr double kRankThreshold = 1e-9;  // relative; far above rounding
  if (!jacobian.allFinite()) return false;
  Eigen::ColPivHouseholderQR<Jacobian> qr(jacobian.transpose());
  qr.setThreshold(kRankThreshold);
  return qr.rank() == jacobian.rows();
}

ConstraintFunctions::Jacobian ConstraintFunctions::normals(const Jacobian& jacobian) {
  // Rows to unit length first, so that the units of the constraints do not matter.
  const Jacobian unit = jacobian.rowwise().normalized();
  const Jacobian gram = unit * unit.transpose();
  const Eigen::SelfAdjointEigenSolver<Jacobian> eigen(gram);
  return unit.transpose() * eigen.operatorInverseSqrt();
}

std::vector<double> ConstraintFunctions::normals(const Waypoint& waypoint) const {
  Vector lambda(parameters_);
  for (int j = 0; j < parameters_; ++j) {
    const auto i = static_cast<std::size_t>(j);
    lambda[j] = waypoint.x[i] + ScalarTraits<double>::pi() * waypoint.half_turns[i];
  }
  Vector values;
  Jacobian jacobian;
  evaluate(lambda, values, jacobian);
  std::vector<double> result(static_cast<std::size_t>(parameters_ * count_), 0.0);
  if (!has_full_rank(jacobian)) return result;
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(result.data(), parameters_,
                                                                                     count_) = normals(jacobian);
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

ConstraintFunctions::Place ConstraintFunctions::place(const Segment& segment, double s) const {
  Place result{Vector(parameters_), Jacobian(parameters_, count_)};
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

std::optional<double> ConstraintFunctions::deviation(const Segment& segment, double s) const {
  const Place at = place(segment, s);
  const std::optional<Vector> y = project(at.lambda, at.normals);
  if (!y) return std::nullopt;
  return y->lpNorm<Eigen::Infinity>();
}

std::vector<double> ConstraintFunctions::parameters(const Segment& segment, double s) const {
  Place at = place(segment, s);
  if (const std::optional<Vector> y = project(at.lambda, at.normals)) at.lambda += at.normals * *y;
  return {at.lambda.data(), at.lambda.data() + at.lambda.size()};
}

}  // namespace taut
