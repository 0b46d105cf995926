// SPDX-License-Identifier: GPL-3.0-or-later
// Loads as people state them: what the set K of wrenches is the sum of, as exact numbers.
//
// K is the Minkowski sum of the items and, where there is one, of the ellipsoid of LoadText. Everything that a case
// may say (a wind from an area and a speed, an acceleration of all masses, a box of forces) is made of these few sets;
// docs/theory.md, "Loads", has their support functions. Forces and moments act on the platform: a weight's force is
// m gravity. `at` is a platform point c [m, axes of P]; a force F there is the wrench (F ; R (c - p_m) x F) about P_m.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace taut {

/// An exact rational number: a decimal literal, or "a/b" with integers a and b > 0.
using RationalText = std::string;
using RationalVector = std::array<RationalText, 3>;

/// The axes in which a set of forces or moments is fixed: those of the world, or those that turn with the platform.
enum class Axes { kWorld, kPlatform };

/// All vectors of magnitude up to `radius` >= 0 [N or N m].
struct BallOfVectors {
  RationalText radius;
  bool operator==(const BallOfVectors&) const = default;
};
/// Those of them at right angles to `normal` != 0, which may have any length.
struct DiscOfVectors {
  RationalText radius;
  RationalVector normal;
  bool operator==(const DiscOfVectors&) const = default;
};
/// f e / |e| for the direction e != 0 and every f from `lower` to `upper`; lower <= upper [N or N m].
struct SegmentOfVectors {
  RationalVector direction;
  RationalText lower;
  RationalText upper;
  bool operator==(const SegmentOfVectors&) const = default;
};
using VectorSet = std::variant<BallOfVectors, DiscOfVectors, SegmentOfVectors>;

/// A mass m in [mass_lower, mass_upper], 0 <= mass_lower [kg], whose centre of gravity is within `at_tolerance` of
/// `at`, in any direction [m].
struct Weight {
  RationalText mass_lower;
  RationalText mass_upper;
  RationalVector at;
  RationalText at_tolerance;
  /// The sides of a box, along the axes of P, that the mass fills evenly around its centre of gravity [m]; else it is a
  /// point. Only of a problem with limits in time.
  std::optional<RationalVector> inertia_box = std::nullopt;
  bool operator==(const Weight&) const = default;
};
struct Force {
  VectorSet set;
  Axes axes = Axes::kWorld;
  RationalVector at;
  bool operator==(const Force&) const = default;
};
struct Moment {
  VectorSet set;
  Axes axes = Axes::kWorld;
  bool operator==(const Moment&) const = default;
};
/// Load cases: the convex hull of one or more wrenches, force [N] and moment about `at` [N m].
struct LoadCases {
  std::vector<std::array<RationalText, 6>> wrenches;
  Axes axes = Axes::kWorld;
  RationalVector at;
  bool operator==(const LoadCases&) const = default;
};

struct LoadItem {
  std::string name;  ///< unique; not empty
  std::variant<Weight, Force, Moment, LoadCases> what;
  bool operator==(const LoadItem&) const = default;
};

}  // namespace taut
