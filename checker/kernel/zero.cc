// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/zero.h"

namespace taut::checker {

Contraction::Contraction(const Equations& equations, const Vector6<Ball>& Y) {
  Matrix6<Ball> G = equations.jacobian(Y);
  for (std::size_t i = equations.unknowns(); i < 6; ++i) G[i][i] = Ball(1);
  A = approximate_inverse(G);
  M = multiply(A, G);
  for (std::size_t i = 0; i < 6; ++i) M[i][i] -= Ball(1);
  M = map(M, magnitude);
  if (!certainly_positive(Ball(1) - norm(M))) throw Undefined("the pose may not be the only one in its tube");
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

  Vector6<MeanValueForm> K;
  for (int step = 0; step <= near.narrowings; ++step) {
    Vector6<Ball> Z;
    for (std::size_t i = 0; i < k; ++i) {
      Z[i] = plus_minus(c[i].range(), w[i]);
      if (step == 0 && !is_within(Z[i], whole[i])) throw Undefined("the pose may leave its tube");
    }
    const Contraction contraction(equations, Z);
    const Vector6<MeanValueForm> moved = multiply(contraction.A, equations.residual(c));
    const Vector6<Ball> left = multiply(contraction.M, w);
    for (std::size_t i = 0; i < k; ++i) {
      if (step == 0 && !certainly_nonnegative(w[i] - (magnitude(moved[i].range()) + left[i]))) {
        throw Undefined("the pose may not exist");  // K(u) in Z(u)
      }
      K[i] = c[i] - moved[i];
      K[i].at = plus_minus(K[i].at, left[i]);
      c[i] = {middle(K[i].at), middle(K[i].slope)};
      w[i] = magnitude((K[i] - c[i]).range());
    }
  }
  return K;
}

}  // namespace taut::checker
