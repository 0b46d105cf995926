// SPDX-License-Identifier: GPL-3.0-or-later
// Clauses "machine", "loads" and "limits": tensions and lengths at every pose of a box, and how far inside their
// limits.
//
// Every quantity is a MeanValueForm in u in [-1, 1], which stands for the place in the box (motion.h).
//
//   geometry   d_i = p + R b_i - a_i,   lengths |d_i|,   arms r_i = R (b_i - p_m) from the load point P_m
//   statics    cable i pulls along d_i / |d_i| with force f_i. With the force density x_i = f_i / |d_i|, J f = w reads
//              D x = w; column i of D is (d_i ; r_i x d_i), and J = D diag(1 / |d_i|). So, lengths being positive, J is
//              non-singular exactly where D is, and row i of J^-1 is |d_i| times row i of D^-1.
//   extremes   over K, f_i fills [f0_i - |d_i| below_i, f0_i + |d_i| above_i], with f0_i = |d_i| x_i and x = D^-1 w for
//              the nominal wrench w. Over the ellipsoid { w0 + e : e' E e <= 1 } (Cauchy-Schwarz) w is w0, and both
//              below_i and above_i are V_i = | row i of D^-1 L |,  L = M^-T,
//              where E = M M' (Cholesky). A factorisation that succeeds in balls proves E positive definite. To these,
//              the items' are added (loads.h).
//
// D^-1 on a whole box.  Let C be any fixed matrix, A(u) = C D(u) - I and |A(u)| <= N entry by entry for every u. If
// rho = ||N|| < 1 (largest row sum), then C D = I + A is non-singular, hence so is D (Neumann), and with P = (I + A)^-1
//     D^-1 = P C,    P y = y - A y + A A P y,    |P y|_i <= q_i := |y_i| + sum_j N_ij max_k |y_k| / (1 - rho)    (1)
// for every vector y, so that D^-1 B = P (C B) is known to first order, up to N (N q), for each column y of C B.
#pragma once

#include "checker/kernel/bodies.h"
#include "checker/kernel/linear.h"
#include "checker/kernel/loads.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// A pose: position of the platform's origin in W [m], and its rotation.
struct Frame {
  Vector3<MeanValueForm> p;
  Matrix3<MeanValueForm> R;
};

/// Of all six cables.
struct Geometry {
  Frame pose;
  std::array<Vector3<MeanValueForm>, 6> d;    ///< d_i [m]
  std::array<Vector3<MeanValueForm>, 6> arm;  ///< r_i [m]
  Vector6<MeanValueForm> length;              ///< |d_i| [m]; certainly positive
  Matrix6<MeanValueForm> D;
};

/// (1): that there is one proves D non-singular for every u.
class Inverse {
 public:
  /// @throws Undefined unless rho < 1.
  explicit Inverse(const Matrix6<MeanValueForm>& D);
  /// D^-1 b, and D^-1 B.
  [[nodiscard]] Vector6<MeanValueForm> times(const Vector6<Ball>& b) const { return times_P(multiply(C_, b)); }
  [[nodiscard]] Matrix6<MeanValueForm> times(const Matrix6<Ball>& B) const;
  /// D^-1
  [[nodiscard]] Matrix6<MeanValueForm> rows() const;

 private:
  /// P y, by (1).
  [[nodiscard]] Vector6<MeanValueForm> times_P(const Vector6<Ball>& y) const;

  Matrix6<Ball> C_;  ///< close to the inverse of D in the middle of the box
  Matrix6<MeanValueForm> A_;
  Matrix6<Ball> N_;
  Ball gap_;  ///< 1 - rho
};

/// As force densities [N/m].
struct Tensions {
  Vector6<MeanValueForm> density;                ///< x_i, of the nominal wrench
  std::array<Vector6<MeanValueForm>, 2> radius;  ///< below_i and above_i
  [[nodiscard]] MeanValueForm extreme(std::size_t i, std::size_t side) const {
    return side == 0 ? density[i] - radius[0][i] : density[i] + radius[1][i];
  }
};

/// One problem's numbers at one precision. All functions compute at that working precision, which the caller sets.
struct Machine {
  /// @throws Undefined where E can't be shown to be positive definite at this precision, or a body has no place.
  explicit Machine(const Problem& problem);

  std::array<Vector3<Ball>, 6> base;       ///< a_i
  std::array<Vector3<Ball>, 6> platform;   ///< b_i
  std::array<Vector3<Ball>, 6> arms;       ///< b_i - p_m
  Vector3<Ball> load_point;                ///< p_m
  Vector6<Ball> wrench;                    ///< w0
  std::optional<Matrix6<Ball>> ellipsoid;  ///< L: { w0 + L z : |z| <= 1 }
  std::vector<Load> items;
  std::array<std::array<Ball, 2>, 6> tension_limits;
  std::array<std::array<Ball, 2>, 6> length_limits;
  std::optional<Tolerances<Ball, Ball>> tolerances;
  std::optional<Vector6<Ball>> row_errors;  ///< of lengths that run straight from row to row
  std::optional<PlacedBodies> bodies;

  /// @throws Undefined where a cable may have no length.
  [[nodiscard]] Geometry geometry(const Frame& pose) const;
  /// @param beside  what acts beside the items and the ellipsoid's spread: w0, less inertia in a move
  [[nodiscard]] Tensions tensions(const Geometry& geometry, const Inverse& inverse, const Vector6<Ball>& beside) const;
  [[nodiscard]] Tensions tensions(const Geometry& geometry, const Inverse& inverse) const {
    return tensions(geometry, inverse, wrench);
  }

 private:
  void add_items(const Matrix3<MeanValueForm>& R, const Inverse& inverse, const Vector6<Ball>& beside,
                 Tensions& to) const;
};

}  // namespace taut::checker
