// SPDX-License-Identifier: GPL-3.0-or-later
// Loads that are stated as items: the nominal wrench, and how far their wrenches move a density above and below its
// nominal value. docs/theory.md, "Loads", has the table of which this is the code.
//
// For a row y = (y_F, y_M) of D^-1, y w takes over the sum of the items exactly the values from y w_nom − below to
// y w_nom + above, below and above being sums over the items. With g = y_F + y_M × r for a force at a point whose lever
// is r = R (c − p_m):
//
//   weight    M B + μ |A ∓ B|,  A = g·γ,  B = ρ |γ × y_M|       mass within μ of M, centre of gravity within ρ of c
//   ball      f |g|
//   disc      f |g − (g·n) n|
//   segment   ± (f_m − f_n) a + f_r |a|,  a = g·e               forces f e, f within f_r of f_m; nominal f_n
//   cases     max over j of ± y (w_j − mean)
//
// and moments likewise, with y_M for g.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

#include "problem/problem.h"
#include "problem/rational.h"
#include "problem/scalar.h"

namespace taut {

/// The items of a load in numbers of one scalar, as they are on the platform.
template <class K>
struct LoadModel {
  using Vector = Eigen::Matrix<K, 3, 1>;
  using Wrench = Eigen::Matrix<K, 6, 1>;

  /// Forces or moments f u with a unit vector u.
  enum class Shape : unsigned char { kPoint, kBall, kDisc, kSegment };
  enum class Kind : unsigned char { kWeight, kForce, kMoment, kCases };
  struct Item {
    Kind kind = Kind::kWeight;
    Shape shape = Shape::kPoint;  ///< of forces and moments
    Axes axes = Axes::kWorld;
    Vector lever;                    ///< c − p_m, axes of P [m]; 0 of a moment
    Vector direction;                ///< n, e or, of a weight, γ
    K nominal;                       ///< f_n, or M
    K offset;                        ///< f_m − f_n
    K radius;                        ///< f, f_r, or μ
    K reach;                         ///< ρ, of a weight
    bool varies = false;             ///< whether μ of a weight may differ from 0
    bool swings = false;             ///< whether ρ may
    Wrench mean;                     ///< of load cases, about c
    std::vector<Wrench> deviations;  ///< w_j − mean, likewise
  };
  std::vector<Item> items;

  [[nodiscard]] bool empty() const { return items.empty(); }
};

/// @throws InputError for what validate() refuses.
template <class K>
[[nodiscard]] LoadModel<K> make_load_model(const LoadText& load);

/// The items at a pose, in the axes of W.
template <class S>
struct LoadsAtPose {
  using Vector = Eigen::Matrix<S, 3, 1>;
  using Wrench = Eigen::Matrix<S, 6, 1>;
  struct Item {
    Vector lever;                    ///< r
    Vector direction;                ///< u or γ
    Wrench line;                     ///< about P_m: of the force or moment `direction`; of load cases the mean
    std::vector<Wrench> deviations;  ///< of load cases from their mean, about P_m
  };
  std::vector<Item> items;
  Wrench nominal;
};

template <class S, class K>
[[nodiscard]] LoadsAtPose<S> loads_at(const LoadModel<K>& model, const Eigen::Matrix<S, 3, 3>& r_WP);

/// How far y w may be below and above y w_nom.
template <class S>
struct DensityRange {
  S below;
  S above;
};
template <class S, class K>
[[nodiscard]] DensityRange<S> density_range(const LoadModel<K>& model, const LoadsAtPose<S>& at,
                                            const Eigen::Matrix<S, 6, 1>& y);

}  // namespace taut

#include "kinematics/loads_impl.h"
