#include "atlas/edge_motion.h"

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
  Coordinates q = start_ + s * step_;
  if (const auto& constraints = sampler_.constraints()) {
    const ConstraintFunctions::Jacobian normals = start_normals_ + s * normals_step_;
    if (const auto y = constraints->project(q, normals)) {
      q += normals * *y;
    } else {
      q.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return sampler_.pose({q.data(), static_cast<std::size_t>(q.size())});
}

}  // namespace taut
