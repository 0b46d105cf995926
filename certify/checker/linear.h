// Linear algebra in six dimensions, in intervals.
#pragma once

#include <array>

#include "certify/checker/interval.h"

namespace taut::checker {

template <class T>
using Vector3 = std::array<T, 3>;
template <class T>
using Vector6 = std::array<T, 6>;
template <class T>
using Matrix3 = std::array<Vector3<T>, 3>;  ///< rows
template <class T>
using Matrix6 = std::array<Vector6<T>, 6>;  ///< rows

/// Gauss-Jordan elimination of [A | I] in intervals: it runs to the end only if no pivot contains zero, which proves
/// every matrix in A non-singular and encloses its inverse. @throws Undefined otherwise.
[[nodiscard]] Matrix6<Interval> inverse(const Matrix6<Interval>& A);

[[nodiscard]] Matrix6<Interval> multiply(const Matrix6<Interval>& A, const Matrix6<Interval>& B);
[[nodiscard]] Vector6<Interval> multiply(const Matrix6<Interval>& A, const Vector6<Interval>& x);

/// Entry by entry.
[[nodiscard]] Matrix6<Interval> middle(Matrix6<Interval> A);

/// Of any matrix in A: the largest row sum of magnitudes.
[[nodiscard]] Interval norm(const Matrix6<Interval>& A);

/// Enclosure of det A, by elimination. @throws Undefined where A may be singular.
[[nodiscard]] Interval determinant(Matrix6<Interval> A);

}  // namespace taut::checker
