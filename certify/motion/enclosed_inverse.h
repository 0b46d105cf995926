// SPDX-License-Identifier: GPL-3.0-or-later
// Linear equations in six unknowns whose matrix is enclosed, for both proof scalars.
#pragma once

#include <Eigen/LU>
#include <cstddef>

#include "certify/arithmetic/neumann.h"
#include "kinematics/model.h"

namespace taut {

/// M^-1 v for every matrix M of an enclosure: with A near an inverse of its middle and |I − A M| <= N entry by entry,
/// M^-1 v = (A M)^-1 A v is in A v ± Q |A v| (neumann.h). For Interval under run_upward().
template <class I>
class EnclosedInverse {
 public:
  /// @returns whether every such M is shown to be regular; else times() may not be called
  [[nodiscard]] bool set(const Matrix6<I>& m) {
    Matrix6<double> middle;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) middle(i, j) = 0.5 * (lower_bound(m(i, j)) + upper_bound(m(i, j)));
    }
    const Matrix6<double> inverse = middle.inverse();
    if (!inverse.allFinite()) return false;
    Square<UpperOf<I>> rest;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) a_(i, j) = I(inverse(i, j));  // exact numbers once chosen
    }
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        I x(i == j ? 1.0 : 0.0);
        for (int k = 0; k < 6; ++k) x = x - a_(i, k) * m(k, j);
        rest[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = UpperOf<I>(magnitude(x));
      }
    }
    return neumann_bound<I>(rest, q_);
  }

  [[nodiscard]] Vector6<I> times(const Vector6<I>& v) const {
    Vector6<I> x, result;
    for (int i = 0; i < 6; ++i) {
      x(i) = I(0.0);
      for (int k = 0; k < 6; ++k) x(i) = x(i) + a_(i, k) * v(k);
    }
    for (int i = 0; i < 6; ++i) {
      UpperOf<I> error(0.0);
      for (int k = 0; k < 6; ++k) {
        error += q_[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] * UpperOf<I>(magnitude(x(k)));
      }
      result(i) = x(i) + ProofScalarTraits<I>::symmetric(error);
    }
    return result;
  }

 private:
  Matrix6<I> a_;            ///< A
  Square<UpperOf<I>> q_{};  ///< Q
};

}  // namespace taut
