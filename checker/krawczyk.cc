#include "checker/krawczyk.h"

namespace taut::checker {
namespace {

constexpr int kMostRoom = 64;  ///< times as wide as what K of a single y is off

Matrix6<Interval> identity() {
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) result[i][i] = Interval(1);
  return result;
}

/// x in b + M x, as far as |x_i| <= max |b_i| / (1 - ||M||) says. @throws Undefined unless ||M|| < 1.
Vector6<Interval> contract(const Matrix6<Interval>& M, const Vector6<Interval>& b) {
  const Interval gap = Interval(1) - norm(M);
  if (!certainly_positive(gap)) throw Undefined("it may not be the only one in its tube");
  Interval largest;
  for (const Interval& x : b) largest = max(largest, abs(x));
  Vector6<Interval> rough;
  rough.fill(largest / gap * Interval::plus_minus_one());
  Vector6<Interval> result = multiply(M, rough);
  for (std::size_t i = 0; i < 6; ++i) result[i] += b[i];
  return result;
}

/// K for the box Y, and y' as far as y is in Y. @throws Undefined unless rho < 1.
Zero krawczyk(const Equations& equations, const Vector6<Interval>& Y) {
  const std::size_t k = equations.unknowns();
  Equations::Derivatives g = equations.derivatives(Y);
  for (std::size_t i = k; i < 6; ++i) g.by_y[i][i] = Interval(1);
  Zero result;
  const Matrix6<Interval> A = middle(inverse(middle(g.by_y)));
  const Matrix6<Interval> AG = multiply(A, g.by_y);
  Matrix6<Interval> M = identity();
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) M[i][j] -= AG[i][j];
  }
  const Interval u = Interval::plus_minus_one();
  const Interval half_u_squared = sqr(u) / Interval(2);
  const Vector6<Interval> Ah = multiply(A, g.by_u);
  const Vector6<Interval> Aj = multiply(A, g.by_uu);
  Vector6<Interval> drift;
  for (std::size_t i = 0; i < 6; ++i) drift[i] = -(Ah[i] + Aj[i] * u);
  result.slope = contract(M, drift);

  Vector6<Interval> c;
  Vector6<Interval> offset;
  for (std::size_t i = 0; i < k; ++i) {
    c[i] = middle(Y[i]);
    offset[i] = Y[i] - c[i];
  }
  const Vector6<Interval> Ag = multiply(A, equations.at_middle(c));
  const Vector6<Interval> M_offset = multiply(M, offset);
  for (std::size_t i = 0; i < k; ++i) {
    result.y[i] = c[i] - Ag[i] - Ah[i] * u - Aj[i] * half_u_squared + M_offset[i];
  }
  return result;
}

}  // namespace

Zero only_zero(const Equations& equations, const Interval& tube, const Vector6<Interval>& near) {
  const std::size_t k = equations.unknowns();
  Vector6<Interval> whole;
  for (std::size_t i = 0; i < k; ++i) whole[i] = tube * Interval::plus_minus_one();
  (void)krawczyk(equations, whole);  // so there is at most one

  const Vector6<Interval> guess = krawczyk(equations, near).y;
  Interval farthest;
  for (std::size_t i = 0; i < k; ++i) farthest = max(farthest, abs(guess[i] - near[i]));
  // A box with room for K: the wider, the smaller rho needs to be; but the equations change more across it.
  Vector6<Interval> Z;
  Zero result;
  bool exists = false;
  for (int room = 2; !exists; room *= 2) {
    if (room > kMostRoom) throw Undefined("it may not exist");
    Z = near;
    for (std::size_t i = 0; i < k; ++i) {
      if (!certainly_positive(tube - abs(near[i]))) throw Undefined("it may leave its tube");
      Z[i] = intersection(Z[i] + Interval(room) * farthest * Interval::plus_minus_one(), whole[i]);
    }
    result = krawczyk(equations, Z);
    exists = true;
    for (std::size_t i = 0; i < k; ++i) exists = exists && is_within(result.y[i], Z[i]);
  }
  constexpr int kNarrowings = 2;  // each takes away most of what the last one left of the curvature's part
  for (int step = 0; step < kNarrowings; ++step) {
    for (std::size_t i = 0; i < k; ++i) Z[i] = intersection(Z[i], result.y[i]);
    result = krawczyk(equations, Z);
  }
  for (std::size_t i = 0; i < k; ++i) result.y[i] = intersection(Z[i], result.y[i]);
  return result;
}

Vector6<Interval> approximate_zero(const Equations& equations) {
  constexpr int kMostSteps = 20;
  Vector6<Interval> y;
  Interval last;
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector6<Interval> next = krawczyk(equations, y).y;  // of a single y it is Newton's step
    Interval moved;
    for (std::size_t i = 0; i < 6; ++i) {
      moved = max(moved, abs(next[i] - y[i]));
      y[i] = middle(next[i]);
    }
    if (step > 0 && !certainly_positive(last - Interval(2) * moved)) break;  // what is left is rounding
    last = moved;
  }
  return y;
}

}  // namespace taut::checker
