// SPDX-License-Identifier: GPL-3.0-or-later
// Linear algebra in three and six dimensions, over balls and mean value forms.
#pragma once

#include <array>

#include "checker/kernel/bound.h"
#include "checker/kernel/mean_value_form.h"

namespace taut::checker {

template <class T>
using Vector3 = std::array<T, 3>;
template <class T>
using Vector6 = std::array<T, 6>;
template <class T>
using Matrix3 = std::array<Vector3<T>, 3>;  ///< rows
template <class T>
using Matrix6 = std::array<Vector6<T>, 6>;  ///< rows

template <std::size_t N>
std::array<Ball, N> balls(const std::array<mpq_class, N>& x) {
  std::array<Ball, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = Ball(x[i]);
  return result;
}
template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector3<Ball> cross(const Vector3<Ball>& a, const Vector3<Ball>& b) {
  const auto entry = [&](std::size_t j, std::size_t k) { return (a[j] * b[k]).subtract_product(a[k], b[j]); };
  return {entry(1, 2), entry(2, 0), entry(0, 1)};
}
template <class S, class T>
auto dot(const Vector3<S>& a, const Vector3<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Ball dot(const Vector3<Ball>& a, const Vector3<Ball>& b) { return Ball::sum_of_products(3, a[0], 1, b[0], 1); }
inline Ball dot(const Vector6<Ball>& a, const Vector6<Ball>& b) { return Ball::sum_of_products(6, a[0], 1, b[0], 1); }
/// The sum of c_i v_i.
inline Vector3<Ball> combination(const Vector6<Ball>& c, const std::array<Vector3<Ball>, 6>& v) {
  const auto entry = [&](std::size_t k) { return Ball::sum_of_products(6, c[0], 1, v[0][k], 3); };
  return {entry(0), entry(1), entry(2)};
}
template <class T>
T determinant(const Vector3<T>& a, const Vector3<T>& b, const Vector3<T>& c) {
  return dot(a, cross(b, c));
}
/// The faces of a tetrahedron: 0 is inside exactly if the determinants of all of them have one sign.
inline constexpr std::array<std::array<std::size_t, 3>, 4> kTetrahedronFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
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
Vector3<T> operator-(const Vector3<T>& a) {
  return {-a[0], -a[1], -a[2]};
}
template <class S, class T>
Vector3<T> operator*(const S& a, const Vector3<T>& b) {
  return {a * b[0], a * b[1], a * b[2]};
}
template <class S, class T>
auto multiply(const Matrix3<S>& A, const Vector3<T>& x) {
  return Vector3<decltype(dot(A[0], x))>{dot(A[0], x), dot(A[1], x), dot(A[2], x)};
}
template <class T>
Matrix3<T> transposed(const Matrix3<T>& A) {
  return {{{A[0][0], A[1][0], A[2][0]}, {A[0][1], A[1][1], A[2][1]}, {A[0][2], A[1][2], A[2][2]}}};
}
template <class T>
Matrix3<T> multiply(const Matrix3<T>& A, const Matrix3<T>& B) {
  const Matrix3<T> columns = transposed(B);
  return transposed<T>({multiply(A, columns[0]), multiply(A, columns[1]), multiply(A, columns[2])});
}

/// Of the Euclidean length of every vector in a.
inline Bound length_bound(const Vector3<Ball>& a) { return hypot(Bound(a[0]), Bound(a[1]), Bound(a[2])); }
/// The Euclidean length of every vector in a.
template <std::size_t N>
Ball length_range(const std::array<Ball, N>& a) {
  Ball least;
  Ball most;
  for (const Ball& x : a) {
    least += sqr(least_magnitude(x));
    most += sqr(magnitude(x));
  }
  return hull(sqrt(lowest(least)), sqrt(most));
}
/// |a|. With a = x + y u, |a| = |x| + z u, |z| <= |y|, and z (|a| + |x|) = y . (a + x), as |a|^2 - |x|^2 = u y . (a +
/// x).
[[nodiscard]] MeanValueForm norm(const Vector3<MeanValueForm>& a);
inline Vector3<Ball> range(const Vector3<MeanValueForm>& a) { return {a[0].range(), a[1].range(), a[2].range()}; }
inline Matrix3<Ball> range(const Matrix3<MeanValueForm>& a) { return {range(a[0]), range(a[1]), range(a[2])}; }

/// f of each entry.
template <class T, class Map>
Matrix6<Ball> map(const Matrix6<T>& A, const Map& f) {
  Matrix6<Ball> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) result[i][j] = f(A[i][j]);
  }
  return result;
}
inline Vector6<Ball> multiply(const Matrix6<Ball>& A, const Vector6<Ball>& x) {
  return {dot(A[0], x), dot(A[1], x), dot(A[2], x), dot(A[3], x), dot(A[4], x), dot(A[5], x)};
}
template <class T>
Vector6<T> multiply(const Matrix6<Ball>& A, const Vector6<T>& x) {
  Vector6<T> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (!A[i][k].is_zero()) result[i] += A[i][k] * x[k];
    }
  }
  return result;
}
[[nodiscard]] Matrix6<Ball> multiply(const Matrix6<Ball>& A, const Matrix6<Ball>& B);

/// A bound of the largest row sum of magnitudes.
[[nodiscard]] Ball norm(const Matrix6<Ball>& A);

/// An approximate inverse of the matrix in the middle of A, exact numbers of which nothing is known.
/// @throws Undefined where none is found.
[[nodiscard]] Matrix6<Ball> approximate_inverse(const Matrix6<Ball>& A);

/// An enclosure of det A.
[[nodiscard]] Ball determinant(const Matrix6<Ball>& A);

}  // namespace taut::checker
