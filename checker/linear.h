// Linear algebra in three and six dimensions, in intervals and Forms.
#pragma once

#include <array>

#include "checker/interval.h"

namespace taut::checker {

template <class T>
using Vector3 = std::array<T, 3>;
template <class T>
using Vector6 = std::array<T, 6>;
template <class T>
using Matrix3 = std::array<Vector3<T>, 3>;  ///< rows
template <class T>
using Matrix6 = std::array<Vector6<T>, 6>;  ///< rows

template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
T squared_norm(const Vector3<T>& a) {
  return sqr(a[0]) + sqr(a[1]) + sqr(a[2]);
}
template <class T>
Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class T>
Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
Vector3<T> operator*(const T& a, const Vector3<T>& b) {
  return {a * b[0], a * b[1], a * b[2]};
}
template <class T>
Vector3<T> multiply(const Matrix3<T>& A, const Vector3<T>& x) {
  return {dot(A[0], x), dot(A[1], x), dot(A[2], x)};
}
template <class T>
Matrix3<T> multiply(const Matrix3<T>& A, const Matrix3<T>& B) {
  Matrix3<T> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
  }
  return result;
}

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
