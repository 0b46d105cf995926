// SPDX-License-Identifier: GPL-3.0-or-later
// A problem whose uncertainties are a stated share of what its case says.
//
// Everything by which the machine or its load may differ from the nominal one is an uncertainty: each tolerance, and
// the deviations of the load from its nominal wrench, together and item by item. Whoever adds a kind adds it here, and
// all that asks for shares knows it.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "problem/decimal.h"
#include "problem/problem.h"

namespace taut {

enum class UncertaintyKind {
  kBaseAnchors,
  kPlatformAnchors,
  kLoadPoint,
  kLoad,  ///< tolerance of w0
  kPosition,
  kOrientation,
  kCableLengths,
  kWrenchSet,  ///< the load's deviations from its nominal wrench: K, of all items and the ellipsoid
  kAll,        ///< all of them, by one common factor
  kLoadItem,   ///< the deviations of one item, which are a part of kWrenchSet
};
/// Those that kAll consists of.
inline constexpr std::size_t kUncertaintyKinds = 8;
[[nodiscard]] constexpr std::array<UncertaintyKind, kUncertaintyKinds> single_uncertainties() {
  using enum UncertaintyKind;
  return {kBaseAnchors, kPlatformAnchors, kLoadPoint, kLoad, kPosition, kOrientation, kCableLengths, kWrenchSet};
}

/// An uncertainty of a problem.
struct Uncertainty {
  // NOLINTNEXTLINE(google-explicit-constructor): all but those of items are named by their kind alone
  Uncertainty(UncertaintyKind kind_of_it = UncertaintyKind::kAll, std::string name_of_item = "")
      : kind(kind_of_it), item(std::move(name_of_item)) {}
  UncertaintyKind kind;
  std::string item;  ///< of kLoadItem: the item's name
  bool operator==(const Uncertainty&) const = default;
};

/// "base_anchors", …: the key of a case file; "wrench_set", "all" and "load_item".
[[nodiscard]] const char* name(UncertaintyKind kind);

/// The unit of size_of(): "m", "rad", "N, N m", or "1".
[[nodiscard]] const char* unit(UncertaintyKind kind);

/// How large an uncertainty is, in floating point: of six tolerances the largest, of the load the largest of the
/// wrench's six numbers; 1 for kWrenchSet, kAll and kLoadItem, which are shares.
[[nodiscard]] double size_of(const Problem& problem, UncertaintyKind kind);

/// Whether the problem states more than nothing of the uncertainty.
[[nodiscard]] bool is_stated(const Problem& problem, const Uncertainty& uncertainty);

/// The names of the load's items that deviate from their nominal wrench.
[[nodiscard]] std::vector<std::string> deviating_items(const LoadText& load);

/// What the problem states: its tolerances, the deviations of the load, and those of each item. The load's are left out
/// where they are those of one item.
[[nodiscard]] std::vector<Uncertainty> stated_uncertainties(const Problem& problem);

/// The problem with a tolerance of `kind` that it does not state: 1 m or 0.1 rad, of the load w0 itself.
/// @pre it is a tolerance; where the load has items, not one of the load
[[nodiscard]] Problem with_unit_uncertainty(Problem problem, UncertaintyKind kind);

/// The problem in which the uncertainty is `factor` times as large, exactly. The deviations of an item are scaled about
/// its nominal wrench: the mass of a weight about the middle of its range, and how far its centre of gravity may be
/// from its place; the radius of a ball or a disc; a range of forces about 0 if it contains 0, else about its middle;
/// load cases about their mean. E is divided by the square of the factor and rounded so that the set contains the
/// scaled one, by a relative 1e-30 at most. A factor of 0 leaves the ellipsoid a millionth of a millionth of its size,
/// because an ellipsoid can't be a point.
/// @pre factor >= 0
/// @throws InputError where the result is no problem, as when an orientation error reaches 1 rad or a mass gets
/// negative, and for an item that there is not.
[[nodiscard]] Problem with_uncertainty_scaled(Problem problem, const Uncertainty& uncertainty, const Decimal& factor);

}  // namespace taut
