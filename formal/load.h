// SPDX-License-Identifier: GPL-3.0-or-later
// What the items of a load make of a row y of C, in binary64, as formal/Checker.v computes it. Nothing is proved here.
#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "formal/slope.h"
#include "problem/problem.h"

namespace taut::formal {

/// y.w of one of the load's wrenches w, and the range of what others add to that.
struct Part {
  Slope form;
  Interval others{0.0};
};

class Load {
 public:
  Load() = default;
  /// Under run_upward(). @pre an ellipsoid's matrix is symmetric and positive
  Load(const LoadText& load, const TolerancesText& tolerances);

  /// @param turn  images of the platform's axes
  [[nodiscard]] Part part(const std::array<Interval, 6>& y, const std::array<Vector, 3>& turn,
                          const Reach& reach) const;

 private:
  struct Ball {
    Interval radius;
  };
  struct Disc {
    Interval radius;
    Vector normal;
  };
  /// Around `middle` times the direction, by `half` of it.
  struct Along {
    Vector direction;
    Interval middle, half;
  };
  using Set = std::variant<Ball, Disc, Along>;

  /// A square a (z_k + k·z')^2, where z' are the coordinates after z_k.
  struct Square {
    Interval scale;
    std::vector<Interval> others;  ///< k
  };
  struct Ellipsoid {
    std::array<Interval, 6> center, shift;
    std::vector<Square> squares;  ///< the matrix's form is their sum
  };
  /// Points are given from the load point.
  struct Mass {
    Along range;  ///< of masses, along gravity
    Vector point;
    Interval tolerance;
  };
  struct Applied {
    Set set;
    Axes axes;
    std::optional<Vector> point;  ///< none: moments
  };
  struct Cases {
    std::vector<std::array<Vector, 2>> wrenches;  ///< of the second, and of each later one: its difference to the first
    Axes axes;
    Vector point;
  };
  using Item = std::variant<Ellipsoid, Mass, Applied, Cases>;

  class Row;

  static std::vector<Square> squares(const EllipsoidText& matrix);
  static Along along(const RationalVector& direction, const RationalText& lower, const RationalText& upper);
  static Set set(const VectorSet& stated);
  static Item item(const LoadItem& stated, const LoadText& load, Interval load_point_tolerance);

  std::vector<Item> items_;
};

}  // namespace taut::formal
