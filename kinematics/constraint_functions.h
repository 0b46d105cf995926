// SPDX-License-Identifier: GPL-3.0-or-later
// The implicit constraints C(λ) = 0 of a space in floating point: what the search needs, and the proof's first guess.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kinematics/jet.h"
#include "kinematics/model.h"
#include "kinematics/segment.h"
#include "problem/units.h"

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

  /// The rank of dC/dλ, numerically; 0 where it is not finite.
  [[nodiscard]] static int rank(const Jacobian& jacobian);
  [[nodiscard]] static bool has_full_rank(const Jacobian& jacobian) { return rank(jacobian) == jacobian.rows(); }
  /// N = C'ᵀ (C' C'ᵀ)^(−1/2), m x k: orthonormal, spans the normal space, and varies smoothly with λ.
  [[nodiscard]] static Jacobian normals(const Jacobian& jacobian);
  /// N at λ; zeros where the rank is not full.
  [[nodiscard]] Jacobian normals_at(const Vector& lambda) const;
  /// The same for a waypoint, by rows; zeros where the rank is not full.
  [[nodiscard]] std::vector<double> normals(const Waypoint& waypoint) const;

  /// y with C(λ + N y) = 0, by Newton's method from y = 0; none where it does not converge.
  [[nodiscard]] std::optional<Vector> project(const Vector& lambda, const Jacobian& normals) const;
  /// The point on the constraints that λ's own normals lead to; none where the rank is not full or Newton's method
  /// fails.
  [[nodiscard]] std::optional<Vector> nearest(const Vector& lambda) const;

  /// y of the motion (segment.h) at s; none where there is none.
  [[nodiscard]] std::optional<Vector> unknowns(const Segment& segment, double s) const;
  /// max |y_i| of it.
  [[nodiscard]] std::optional<double> deviation(const Segment& segment, double s) const;
  /// ℓ(s) + N(s) y(s); ℓ(s) where there is no y.
  [[nodiscard]] std::vector<double> parameters(const Segment& segment, double s) const;

 private:
  struct ReferencePoint {
    Vector lambda;     ///< ℓ(s)
    Jacobian normals;  ///< N(s)
  };
  [[nodiscard]] ReferencePoint reference_point(const Segment& segment, double s) const;

  int count_;
  int parameters_;
  Evaluator<Jet<double, kMaxConstrainedParameters>> jets_;
};

/// How far a waypoint may be off the constraints: a path goes through what it projects to. Angles [rad] and lengths
/// over the mean |b_i| count alike, so this is 1.3 mm for a platform of 130 mm.
inline constexpr double kWaypointTolerance = 0.01;

/// Checks that the query's waypoints lie on the constraints, if there are any, and that the constraints have full rank
/// there.
/// @throws FieldError saying how far off, in `length_unit`, or which rank
void require_query_on_constraints(const Problem& problem, const Unit& length_unit);

}  // namespace taut
