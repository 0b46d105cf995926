// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/linear.h"

#include <arb_mat.h>

namespace taut::checker {
namespace {

/// A 6 by 6 matrix of Arb's.
class ArbMatrix {
 public:
  ArbMatrix() { arb_mat_init(m_, 6, 6); }
  explicit ArbMatrix(const Matrix6<Ball>& A) : ArbMatrix() {
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) arb_set(arb_mat_entry(m_, i, j), A[i][j].get());
    }
  }
  ~ArbMatrix() { arb_mat_clear(m_); }
  ArbMatrix(const ArbMatrix&) = delete;
  ArbMatrix& operator=(const ArbMatrix&) = delete;
  [[nodiscard]] arb_mat_struct* get() { return m_; }
  [[nodiscard]] Matrix6<Ball> balls() const {
    Matrix6<Ball> result;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        result[i][j] = Ball::make([&](arb_ptr r) { arb_set(r, arb_mat_entry(m_, i, j)); });
      }
    }
    return result;
  }

 private:
  arb_mat_t m_;
};

}  // namespace

MeanValueForm norm(const Vector3<MeanValueForm>& a) {
  const Vector3<Ball> x = {a[0].at, a[1].at, a[2].at};
  const Vector3<Ball> y = {a[0].slope, a[1].slope, a[2].slope};
  const Ball both = length_range(x) + length_range(range(a));
  Ball z = plus_minus(Ball(), length_bound(y));
  if (certainly_positive(both)) z = intersection(z, dot(y, x + range(a)) / both);
  return {length_range(x), std::move(z)};
}

Matrix6<Ball> multiply(const Matrix6<Ball>& A, const Matrix6<Ball>& B) {
  ArbMatrix left(A), right(B), result;
  arb_mat_mul_classical(result.get(), left.get(), right.get(), Ball::bits());
  return result.balls();
}

Ball norm(const Matrix6<Ball>& A) {
  Ball largest;
  for (const Vector6<Ball>& row : A) {
    Ball sum;
    for (const Ball& x : row) sum += magnitude(x);
    largest = larger(largest, highest(sum));
  }
  return largest;
}

Matrix6<Ball> approximate_inverse(const Matrix6<Ball>& A) {
  ArbMatrix matrix(map(A, middle)), result;
  if (arb_mat_approx_inv(result.get(), matrix.get(), Ball::bits()) == 0) throw Undefined("a matrix may be singular");
  return map(result.balls(), middle);
}

Ball determinant(const Matrix6<Ball>& A) {
  ArbMatrix matrix(A);
  return Ball::make([&](arb_ptr r) { arb_mat_det(r, matrix.get(), Ball::bits()); });
}

}  // namespace taut::checker
