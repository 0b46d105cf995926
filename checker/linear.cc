#include "checker/linear.h"

#include <algorithm>
#include <utility>

namespace taut::checker {
namespace {

/// Brings to row c the row below it whose entry in column c is largest in the middle (any choice is sound).
/// Returns whether rows were exchanged.
template <class Row>
bool exchange_pivot(std::array<Row, 6>& A, std::size_t c) {
  std::size_t best = c;
  for (std::size_t i = c + 1; i < 6; ++i) {
    if (certainly_positive(abs(middle(A[i][c])) - abs(middle(A[best][c])))) best = i;
  }
  if (best == c) return false;
  std::swap(A[c], A[best]);
  return true;
}

}  // namespace

Matrix6<Interval> inverse(const Matrix6<Interval>& A) {
  std::array<std::array<Interval, 12>, 6> W;
  for (std::size_t i = 0; i < 6; ++i) {
    std::copy(A[i].begin(), A[i].end(), W[i].begin());
    W[i][6 + i] = Interval(1);
  }
  for (std::size_t c = 0; c < 6; ++c) {
    exchange_pivot(W, c);
    for (std::size_t j = c + 1; j < 12; ++j) W[c][j] = W[c][j] / W[c][c];
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == c) continue;
      for (std::size_t j = c + 1; j < 12; ++j) W[i][j] -= W[i][c] * W[c][j];
    }
  }
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) std::copy(W[i].begin() + 6, W[i].end(), result[i].begin());
  return result;
}

Matrix6<Interval> multiply(const Matrix6<Interval>& A, const Matrix6<Interval>& B) {
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (A[i][k].is_exactly_zero()) continue;
      for (std::size_t j = 0; j < 6; ++j) result[i][j] += A[i][k] * B[k][j];
    }
  }
  return result;
}

Vector6<Interval> multiply(const Matrix6<Interval>& A, const Vector6<Interval>& x) {
  Vector6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) result[i] += A[i][j] * x[j];
  }
  return result;
}

Matrix6<Interval> middle(Matrix6<Interval> A) {
  for (Vector6<Interval>& row : A) {
    for (Interval& x : row) x = middle(x);
  }
  return A;
}

Interval norm(const Matrix6<Interval>& A) {
  Interval result;
  for (const Vector6<Interval>& row : A) {
    Interval sum;
    for (const Interval& x : row) sum += abs(x);
    result = max(result, sum);
  }
  return result;
}

Interval determinant(Matrix6<Interval> A) {
  Interval result(1);
  for (std::size_t c = 0; c < 6; ++c) {
    if (exchange_pivot(A, c)) result = -result;
    result = result * A[c][c];
    for (std::size_t i = c + 1; i < 6; ++i) {
      const Interval factor = A[i][c] / A[c][c];
      for (std::size_t j = c + 1; j < 6; ++j) A[i][j] -= factor * A[c][j];
    }
  }
  return result;
}

}  // namespace taut::checker
