// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/navigation_manifold.h"

namespace taut {

template bool navigation_tangent(const Model<double>&, const Pose<double>&, NavigationTangent<double>&);
template Eigen::Matrix<double, kNavigationEquations, 1> navigation_residual(const Model<double>&,
                                                                            const NavigationPoint<double>&);

}  // namespace taut
