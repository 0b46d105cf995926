// SPDX-License-Identifier: GPL-3.0-or-later
// What load items do to all six densities of a box at once, in binary64.
//
// kinematics/loads.h states it for one density and any scalar. Here rows of D^-1 and vectors of the platform are kept
// around middles (vector_form.h). What all items together do, Σ above_n and Σ below_n, is a convex function of such
// vectors, and Lipschitz. Along mid + slope (t − m) it is convex in t, so its values at the midpoint and at both ends
// of T bound its slopes from m; the errors add what the Lipschitz constants say. docs/theory.md, "Items, all rows at
// once".
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/slope_form.h"
#include "certify/loads/vector_form.h"
#include "kinematics/loads.h"
#include "kinematics/model.h"

namespace taut {

/// R over a box, with Frobenius norms for sizes and errors.
struct RotationForm {
  std::array<std::array<double, 3>, 3> mid, slope;
  double mid_error, slope_error, mid_size, slope_size;
};

/// The rows of D^-1, P C, over a box.
struct RowForms {
  VectorForm<Six> force, moment;
  double radius;  ///< of the box
};

/// The nominal wrench of all items over a box, about P_m in W.
struct NominalForm {
  VectorForm<double> force, moment;
};

/// The rows of D^-1 in all of a set of states.
struct RowBalls {
  VectorBall<Six> force, moment;
};
/// For each row y of D^-1 the loads w* at which y w is least (side 0) and greatest (side 1), in all of a set of states.
struct ExtremalRows {
  struct Side {
    VectorBall<Six> force, moment;  ///< w* less the nominal wrench
    VectorBall<Six> turn;           ///< T (extremal_load.h)
    Six reach;                      ///< an upper bound of how far y w is below or above y w_nom
  };
  std::array<Side, 2> sides;
};

class ItemRows {
 public:
  ItemRows() = default;
  /// Under run_upward(), as all that follows.
  explicit ItemRows(const LoadModel<Interval>& model);

  [[nodiscard]] static RotationForm rotation(const Matrix3<SlopeForm<Interval>>& r_WP);
  /// Of a set of states; its slope is 0.
  [[nodiscard]] static RotationForm rotation(const Matrix3<Interval>& r_WP);
  [[nodiscard]] NominalForm nominal(const RotationForm& rotation) const;

  using Forms = std::array<SlopeForm<Interval>, kCables>;
  struct Reach {
    Forms below, above;
  };
  /// How far y w may be below and above y w_nom, for each row y.
  [[nodiscard]] Reach reach(const RotationForm& rotation, const RowForms& rows) const;

  /// Whether extremes() is defined: no item is a list of load cases.
  [[nodiscard]] bool has_extremes() const { return !has_cases_; }
  [[nodiscard]] ExtremalRows extremes(const RotationForm& rotation, const RowBalls& rows) const;
  /// That of all items, about P_m in W.
  [[nodiscard]] Vector6<Interval> nominal_wrench(const Matrix3<Interval>& r_WP) const;

 private:
  using Model = LoadModel<Interval>;
  struct Item {
    Model::Kind kind = Model::Kind::kWeight;
    Model::Shape shape = Model::Shape::kPoint;
    bool turns = false;  ///< with P
    bool varies = false, swings = false;
    KnownVector direction, moment;               ///< u or γ; c × u
    KnownNumber nominal, offset, radius, reach;  ///< as in LoadModel
    /// Of load cases: forces, and moments about c or, if they turn with P, about P_m.
    std::vector<std::array<KnownVector, 2>> deviations;
  };
  /// Items that need g at their point of the platform.
  struct Point {
    std::optional<KnownVector> lever;  ///< unless it is 0
    std::vector<Item> items;
  };
  /// A force that keeps its axes in W.
  struct ForceAtPoint {
    KnownVector lever, force;
  };
  struct NominalSum;
  class Sum;
  struct Place;

  static Item packed(const Model::Item& item);
  static void add(const Item& item, const RotationForm& rotation, const RowForms& rows, const VectorForm<Six>& g,
                  Sum& sum);
  static void add_cases(const Item& item, const RotationForm& rotation, const RowForms& rows, const VectorForm<Six>& g,
                        Sum& sum);
  static void add_weight(const Item& item, const RowForms& rows, const VectorForm<Six>& g, Sum& sum);
  static void add_segment(const Item& item, const NumberForm<Six>& a, Sum& sum);

  static void add(const Item& item, const Place& at, ExtremalRows& sum);
  static void add_weight(const Item& item, const Place& at, ExtremalRows& sum);
  static void add_segment(const Item& item, const Place& at, ExtremalRows& sum);
  static void add_round(const Item& item, const Place& at, ExtremalRows& sum);

  bool has_cases_ = false;
  std::vector<Point> points_;
  std::vector<Item> elsewhere_;                                 ///< all others that reach anywhere
  std::vector<ForceAtPoint> nominal_at_points_;                 ///< what they add to the nominal moment
  std::array<KnownVector, 2> fixed_nominal_, turning_nominal_;  ///< force and moment in the axes of W, of P
};

/// y·w for the rows y.
[[nodiscard]] std::array<SlopeForm<Interval>, kCables> times(const RowForms& rows, const NominalForm& w);

}  // namespace taut
