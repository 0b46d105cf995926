// What tolerances take away: by how much a deviating machine's tensions and lengths differ from the stated one's.
//
// Scale a deviation (pose_proof.h) by t in [0, 1], the rotation along its axis: that is within the tolerances, too. Along
// this family let f' be the rate of a quantity f. At t = 1 it differs from t = 0 by the integral of f', which is no more
// than the mean over j = 1 … n of the bound of |f'| for t in [0, j/n]. Everything below is enclosed for every u of the box
// and every deviation scaled by no more than j/n.
//
// Let the pose move by the rates p' and W (of rotation, about the axes of W). Then
//     d_i' = p' + W x R b_i + b_i' - a_i',   r_i' = W x r_i + b_i' - p_m'      (b_i' and p_m' along the axes of W)
// and with y_r = (f, m) row r of Y = D^-1, column i of D being (d_i ; r_i x d_i),
//     y_r . D_i' = h_ri . d_i' + q_ri . r_i',   h_ri = f + m x r_i,   q_ri = d_i x m.
// From D x = w and D Z = (the columns of M^-T) follow x' = Y w' - Y D' x and Z' = -Y D' Z. For the rows z_r of Z = Y M^-T and
// V_r = |z_r|, the tension with variation F_r = |d_r| (x_r + c V_r), c a constant, has therefore the rate
//     F_r' = phi u_r . d_r' + |d_r| (y_r . w' - sum_i kappa_i y_r . D_i'),
//     kappa_i = x_i + c (z_r . z_i) / V_r,   phi = kappa_r,   u_r = d_r / |d_r|,
// linear in p', W, a_i', b_i', p_m', w'. Its coefficient of p' is P_r, that of W is Q_r; a coefficient's length times the
// tolerance bounds what that deviation does.
//
// A machine held by lengths follows its anchors and lengths: |d_i| = L_i + e_i at the commanded pose. Where only cable i has
// a rate, D' (v, W) = (rho_i in place i, else 0) for the velocity v of P_m, with
//     rho_i = |d_i| e_i' - d_i . (b_i' - a_i'),  so that W = m_i rho_i,  p' = (f_i - m_i x R p_m) rho_i,
// (f_i, m_i) row i of Y. Tracking errors come on top: they turn W, and b_i', by no more than their angle.
//
// The length |d_i| of a cable changes at the rate u_i . d_i'. Held by lengths, it is L_i + e_i at the commanded pose of the whole
// deviation, from which tracking then takes it by no more than the distance and the angle times |b_i'|.
#pragma once

#include "certify/checker/held.h"

namespace taut::checker {

/// For each cable: bounds that hold for every u and every machine within the tolerances.
struct Losses {
  std::array<std::array<Interval, 2>, 6> tension;  ///< of the change of f0_i - v_i, and of f0_i + v_i [N]
  std::array<std::array<Interval, 2>, 6> scaled;   ///< of the change of f0_i - k v_i, and of f0_i + k v_i [N]
  Vector6<Interval> length;                        ///< of the change of |d_i| [m]
};

/// @param commanded  the pose of `geometry`, and how far those of deviating machines are from it
/// @param k          the wrench scale of `Losses::scaled`
/// @param steps      n above: more are tighter
/// @throws Undefined unless D is non-singular for every u and every machine within the tolerances.
/// @pre model.deviation() is not null.
[[nodiscard]] Losses losses(const Model& model, const Geometry& geometry, const Inverse& inverse,
                            const Commanded& commanded, bool is_held, const Interval& k, int steps);

}  // namespace taut::checker
