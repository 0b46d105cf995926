// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/edge_motion.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace taut {

EdgeMotion::EdgeMotion(const PoseSampler& sampler, const Coordinates& a, const Coordinates& b)
    : sampler_(sampler), start_(a), step_(b - a) {
  if (const auto& constraints = sampler.constraints()) {
    start_normals_ = constraints->normals_at(a);
    normals_step_ = constraints->normals_at(b) - start_normals_;
  }
}

Pose<double> EdgeMotion::pose(double s) const {
  Coordinates q = line(s);
  if (const auto& constraints = sampler_.constraints()) {
    if (const auto y = constraints->project(q, normals(s))) {
      q += normals(s) * *y;
    } else {
      q.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return sampler_.pose({q.data(), static_cast<std::size_t>(q.size())});
}

bool EdgeMotion::looks_single() const {
  constexpr double kRoom = 1.5;    // of the tube, times |y|, as in proofs
  constexpr double kExcess = 3.0;  // of interval arithmetic over corners of the tube, with some for other provers
  const auto& constraints = sampler_.constraints();
  if (!constraints) return true;
  for (const double s : {0.5, 0.0, 1.0}) {
    const ConstraintFunctions::Vector q = line(s);
    const ConstraintFunctions::Jacobian n = normals(s);
    const auto y = constraints->project(q, n);
    if (!y) return false;
    const double tube = kRoom * y->lpNorm<Eigen::Infinity>();
    ConstraintFunctions::Vector values;
    ConstraintFunctions::Jacobian jacobian;
    const auto newton_matrix = [&](const ConstraintFunctions::Vector& at) -> ConstraintFunctions::Jacobian {
      constraints->evaluate(q + n * at, values, jacobian);
      return jacobian * n;
    };
    const Eigen::PartialPivLU<ConstraintFunctions::Jacobian> at_motion(newton_matrix(*y));
    // Krawczyk's test: the image of the tube must lie inside it.
    ConstraintFunctions::Vector reach = ConstraintFunctions::Vector::Zero(y->size());
    for (Eigen::Index j = 0; j < y->size(); ++j) {
      ConstraintFunctions::Vector spread = ConstraintFunctions::Vector::Zero(y->size());
      for (const double end : {-tube, tube}) {
        ConstraintFunctions::Vector corner = *y;
        corner[j] = end;
        const ConstraintFunctions::Jacobian change = at_motion.solve(newton_matrix(corner) - newton_matrix(*y));
        spread = spread.cwiseMax(change.cwiseAbs() * (y->cwiseAbs().array() + tube).matrix());
      }
      reach += spread;
    }
    for (Eigen::Index i = 0; i < y->size(); ++i) {
      if (kExcess * reach[i] > tube - std::abs((*y)[i])) return false;
    }
  }
  return true;
}

}  // namespace taut
