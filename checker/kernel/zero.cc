// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/zero.h"

namespace taut::checker {

namespace {

Matrix6<Ball> partial_derivatives(const Equations& equations, const Vector6<Ball>& Y) {
  Matrix6<Ball> G = equations.jacobian(Y);
  for (std::size_t i = equations.unknowns(); i < 6; ++i) G[i][i] = Ball(1);
  return G;
}

/// Z of (2).
Vector6<Ball> around(const Vector6<MeanValueForm>& c, const Vector6<Ball>& w, std::size_t unknowns) {
  Vector6<Ball> Z;
  for (std::size_t i = 0; i < unknowns; ++i) Z[i] = plus_minus(c[i].range(), w[i]);
  return Z;
}

}  // namespace

Contraction::Contraction(const Equations& equations, const Vector6<Ball>& Y)
    : Contraction(partial_derivatives(equations, Y)) {}

Contraction::Contraction(const Matrix6<Ball>& G) : A(approximate_inverse(G)), M(multiply(A, G)) {
  for (std::size_t i = 0; i < 6; ++i) M[i][i] -= Ball(1);
  M = map(M, magnitude);
  if (!certainly_positive(Ball(1) - norm(M))) throw Undefined("the pose may not be the only one in its tube");
}

Vector6<Ball> Contraction::divide(const Vector6<Ball>& b) const {
  const Vector6<Ball> Ab = multiply(A, b);
  Ball largest;
  for (const Ball& x : Ab) largest = larger(largest, magnitude(x));
  Vector6<Ball> size;
  size.fill(highest(largest / (Ball(1) - norm(M))));
  constexpr int kRefinements = 2;
  for (int step = 0; step < kRefinements; ++step) {
    const Vector6<Ball> rest = multiply(M, size);
    for (std::size_t i = 0; i < 6; ++i) size[i] = highest(magnitude(Ab[i]) + rest[i]);
  }
  const Vector6<Ball> rest = multiply(M, size);
  Vector6<Ball> result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = plus_minus(Ab[i], highest(rest[i]));
  return result;
}

Vector6<MeanValueForm> only_zero(const Equations& equations, const Ball& tube, const NearZero& near) {
  const std::size_t k = equations.unknowns();
  Vector6<Ball> whole;
  Vector6<MeanValueForm> c;
  Vector6<Ball> w;
  for (std::size_t i = 0; i < k; ++i) {
    whole[i] = plus_minus(tube);
    c[i] = {Ball(near.at[i]), Ball(near.slope[i])};
    w[i] = Ball(near.radius);
  }
  const Contraction at_most_one(equations, whole);  // (1)

  const Vector6<Ball> Z = around(c, w, k);
  for (std::size_t i = 0; i < k; ++i) {
    if (!is_within(Z[i], whole[i])) throw Undefined("the pose may leave its tube");
  }
  const Contraction contraction(equations, Z);
  const Vector6<MeanValueForm> moved = multiply(contraction.A, equations.residual(c));
  const Vector6<Ball> left = multiply(contraction.M, w);
  Vector6<MeanValueForm> K;
  for (std::size_t i = 0; i < k; ++i) {
    if (!certainly_nonnegative(w[i] - (magnitude(moved[i].range()) + left[i]))) {
      throw Undefined("the pose may not exist");  // K(u) in Z(u)
    }
    K[i] = c[i] - moved[i];
    K[i].at = plus_minus(K[i].at, left[i]);
  }
  return narrowed(equations, K, near.narrowings);
}

Vector6<MeanValueForm> narrowed(const Equations& equations, Vector6<MeanValueForm> known, int narrowings) {
  const std::size_t k = equations.unknowns();
  for (int step = 0; step < narrowings; ++step) {
    Vector6<MeanValueForm> c;
    Vector6<Ball> w;
    for (std::size_t i = 0; i < k; ++i) {
      c[i] = {middle(known[i].at), middle(known[i].slope)};
      w[i] = magnitude((known[i] - c[i]).range());
    }
    const Contraction contraction(equations, around(c, w, k));
    const Vector6<MeanValueForm> moved = multiply(contraction.A, equations.residual(c));
    const Vector6<Ball> left = multiply(contraction.M, w);
    for (std::size_t i = 0; i < k; ++i) {
      known[i] = c[i] - moved[i];
      known[i].at = plus_minus(known[i].at, left[i]);
    }
  }
  return known;
}

}  // namespace taut::checker
