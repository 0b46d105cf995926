// SPDX-License-Identifier: GPL-3.0-or-later
// Clause "deviations": by how much tensions and lengths of a machine within the tolerances differ from the stated
// one's.
//
// Scale a deviation (Tolerances in statement.h) by t from 0 to 1, the rotation along its axis: that is within the
// tolerances, too. Let f' be the rate of a quantity f along this family. The way from t = 0 to t = 1 is taken in n
// parts; during part j everything is enclosed for t in [0, j/n], for every u of the box and every deviation, and f
// changes by no more than |f'| / n.
//
// Let the pose move at the rates p' and W (of rotation, about the axes of W). Then
//     d_i' = p' + W x R b_i + b_i' - a_i',   r_i' = W x r_i + b_i' - p_m'      (b_i' and p_m' along the axes of W)
// and with y_r = (f, m) row r of Y = D^-1, column i of D being (d_i ; r_i x d_i),
//     y_r . D_i' = h_ri . d_i' + q_ri . r_i',   h_ri = f + m x r_i,   q_ri = d_i x m.
//
// Where things are.  A length-controlled machine follows its anchors and lengths: |d_i| = L_i + t e_i at the commanded
// pose. Where only cable j has a rate, D' (v, W) = (rho_j in place j, else 0) for the velocity v of P_m, with
//     rho_j = |d_j| e_j' - d_j . (b_j' - a_j'),  so that W = m_j rho_j,  v = f_j rho_j,
// and B_i moves by h_ji rho_j, the arm r_i by w_ji rho_j, w_ji = m_j x r_i. Tracking errors come on top: they turn W,
// b_i' and these motions by no more than their angle. So the rates of d_i and r_i are bounded by what Y, d_i and r_i
// themselves are, and that of Y by Y' = -Y D' Y. Now guess how far all of these come from where they are at t = 0, up
// to j/n. If, on everything that this guess allows, they move by less than is left of it, they stay within it: as long
// as they do, D is non-singular, since Y is bounded, and so there is one pose that continues the last (implicit
// function theorem); and none of them can be the first to leave. So each deviation has its pose, the one to which it
// leads from the stated machine's. Any guess will do.
//
// What tensions do.  From D x = w and D Z = L (machine.h) follow x' = Y w' - Y D' x and Z' = -Y D' Z. For the rows z_r
// of Z and V_r = |z_r|, the tension with tension_radius F_r = |d_r| (x_r + c V_r), c = -1 or 1, has therefore the rate
//     F_r' = phi u_r . d_r' + |d_r| (y_r . w' - sum_i kappa_i y_r . D_i'),
//     kappa_i = x_i + c (z_r . z_i) / V_r,   phi = kappa_r,   u_r = d_r / |d_r|,
// It is the rate of |d_r| y_r . w* for a w* of K at which y_r . w is extreme: kappa_i = y_i . w*. The same holds for
// every compact K whose members are differentiable functions of t of some z from one compact set: then the extreme is
// Lipschitz in t, and its derivative, wherever it exists, is that of y_r . w(z*) for any z* that attains it (Danskin).
// So with the items of a load (loads.h), kappa_i gains y_i . w* of each item, where w* is one of a few wrenches that
// certainly include one that attains the extreme; w' is W . T: Q_r below gains |d_r| T. The items have no other
// tolerances. With w_nominal for w*, F_r' is the rate of f0_r.
//
// The rate is linear in p', W, a_i', b_i', p_m', w'. Its coefficient of p' is P_r; that of W is Q_r + R p_m x P_r,
// where Q_r is the one of a rotation about P_m; a coefficient's length times the tolerance bounds what that deviation
// does. Where lengths are controlled, rho_j adds to it P_r . f_j + Q_r . m_j, up to what tracking turns.
//
// Rows of a table (TimeLimits::rows) let lengths be off by more, e_i. Where lengths are not controlled, they lead to
// the pose that the stated robot has with lengths L_i + e_i, which is then the commanded one: rho_j = |d_j| e_j' alone,
// and anchors deviate where they are. That robot at that pose, about whatever load point deviates, is among the
// deviations: it is the one without others.
//
// The length |d_i| of a cable changes at the rate u_i . d_i', by no more than |p'| + min(|W x R b_i . u_i|, |W||b_i|) +
// ... Where lengths lead, it is L_i + e_i at the commanded pose of the whole deviation, from which tracking then takes
// it by no more than the distance and the angle times |b_i'|, and anchors that do not lead by their tolerances.
//
// In a move, w0 is less than stated by the inertia w_in of the commanded motion, and a deviating machine's differs from
// that by an e in E, which the turn of its pose bounds (moving.h). The family has the load w - w_in - t e then, so that
// e enters like a tolerance of w0. E is known once the pose is, which no load moves: so the way is gone twice.
//
// The pose itself.  The platform's origin is -R p_m from P_m, so where lengths are controlled the commanded pose moves
// at the rates
//     p_c' = sum_j rho_j (f_j - m_j x R p_m),   W_c = sum_j rho_j m_j,
// by no more than the sum over all parts of their bounds; a turn at the rate W_c turns by no more than |W_c| (angles
// between rotations satisfy the triangle inequality). Tracking adds its distance and its angle to the whole deviation.
#pragma once

#include "checker/kernel/machine.h"

namespace taut::checker {

/// By how much poses differ, each a bound.
struct PoseShift {
  Ball position;  ///< |p' - p| [m]
  Ball turn;      ///< of the angle of the rotation from R to R' [rad]
};

/// For each cable: bounds that hold for every u and every machine within the tolerances.
struct MarginLoss {
  std::array<std::array<Ball, 2>, 6> tension;  ///< of the change of the least and of the largest tension [N]
  std::array<std::array<Ball, 2>, 6> radius;   ///< of the change of what they differ by from the nominal one [N]
  Vector6<Ball> length;                        ///< of the change of |d_i| [m]
  PoseShift shift;                             ///< of the pose
};

/// What acts beside the items and the ellipsoid's spread. In a move, inertia belongs to it.
struct WrenchBeside {
  Vector6<Ball> wrench;          ///< of the machine as stated
  Vector6<Ball> change_by_turn;  ///< how much more than by the tolerance it may differ, over the pose's turn <= 1
};

/// @param parts    n above: more are tighter
/// @param guesses  how often rates are evaluated before each part's guess must hold
/// @param beside   null: w0
/// @throws Undefined unless every machine within the tolerances has its pose, and D is non-singular there, for every u.
/// @pre machine.tolerances
[[nodiscard]] MarginLoss margin_loss(const Machine& machine, const Geometry& geometry, const Inverse& inverse,
                                     bool length_controlled, int parts, int guesses,
                                     const WrenchBeside* beside = nullptr);

}  // namespace taut::checker
