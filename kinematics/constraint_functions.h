// The implicit constraints C(λ) = 0 of a space in floating point: what the search needs, and the proof's first guess.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kinematics/jet.h"
#include "kinematics/model.h"
#include "kinematics/segment.h"

namespace taut {

class ConstraintFunctions {
 public:
  /// k x m or smaller: constraints by parameters.
  using Jacobian =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxConstrainedParameters, kMaxConstrainedParameters>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxConstrainedParameters, 1>;

  /// @pre the problem has constraints.
  explicit ConstraintFunctions(const Problem& problem);

  [[nodiscard]] int count() const { return count_; }
  /// C and dC/dλ at λ.
  void evaluate(const Vector& lambda, Vector& values, Jacobian& jacobian) const;

  /// Whether dC/dλ has full rank, numerically.
  [[nodiscard]] static bool has_full_rank(const Jacobian& jacobian);
  /// N = C'ᵀ (C' C'ᵀ)^(−1/2), m x k: orthonormal, spans the normal space, and varies smoothly with λ.
  [[nodiscard]] static Jacobian normals(const Jacobian& jacobian);
  /// The same for a waypoint, by rows; zeros where the rank is not full.
  [[nodiscard]] std::vector<double> normals(const Waypoint& waypoint) const;

  /// y with C(λ + N y) = 0, by Newton's method from y = 0; none where it does not converge.
  [[nodiscard]] std::optional<Vector> project(const Vector& lambda, const Jacobian& normals) const;

  /// max |y_i| of the motion (segment.h) at s; none where there is none.
  [[nodiscard]] std::optional<double> deviation(const Segment& segment, double s) const;
  /// ℓ(s) + N(s) y(s); ℓ(s) where there is no y.
  [[nodiscard]] std::vector<double> parameters(const Segment& segment, double s) const;

 private:
  struct Place {
    Vector lambda;
    Jacobian normals;
  };
  [[nodiscard]] Place place(const Segment& segment, double s) const;

  int count_;
  int parameters_;
  Evaluator<Jet<double, kMaxConstrainedParameters>> jets_;
};

}  // namespace taut
