// SPDX-License-Identifier: GPL-3.0-or-later
// A problem whose uncertainties are a stated share of what its case says.
//
// Everything by which the machine or its load may differ from the nominal one is an uncertainty: each tolerance, and
// the deviations of the load from w0. Whoever adds a kind adds it here, and all that asks for shares knows it.
#pragma once

#include <array>
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
  kWrenchSet,  ///< the load's deviations from w0: K
  kAll,        ///< all of them, by one common factor
};
/// Without kAll.
inline constexpr std::size_t kUncertaintyKinds = 8;
[[nodiscard]] constexpr std::array<UncertaintyKind, kUncertaintyKinds> single_uncertainties() {
  using enum UncertaintyKind;
  return {kBaseAnchors, kPlatformAnchors, kLoadPoint, kLoad, kPosition, kOrientation, kCableLengths, kWrenchSet};
}

/// "base_anchors", …: the key of a case file; "wrench_set" and "all".
[[nodiscard]] const char* name(UncertaintyKind kind);

/// The unit of size_of(): "m", "rad", "N, N m", or "1".
[[nodiscard]] const char* unit(UncertaintyKind kind);

/// How large an uncertainty is, in floating point: of six tolerances the largest, of the load the largest of the
/// wrench's six numbers; 1 for kWrenchSet and kAll.
[[nodiscard]] double size_of(const Problem& problem, UncertaintyKind kind);

/// Whether the uncertainty is more than nothing. kWrenchSet and kAll always are.
[[nodiscard]] bool is_stated(const Problem& problem, UncertaintyKind kind);

/// The problem with a tolerance of `kind` that it does not state: 1 m or 0.1 rad, of the load w0 itself.
/// @pre not kWrenchSet, not kAll
[[nodiscard]] Problem with_unit_uncertainty(Problem problem, UncertaintyKind kind);

/// The problem in which the uncertainty is `factor` times as large, exactly. The set K is scaled about w0; E is divided
/// by the square of the factor and rounded so that the set contains the scaled one, by a relative 1e-30 at most. Of
/// kAll a factor of 0 leaves K a millionth of a millionth of its size, because an ellipsoid can't be a point.
/// @pre factor >= 0
/// @throws InputError where the result is no problem, as when an orientation error reaches 1 rad.
[[nodiscard]] Problem with_uncertainty_scaled(Problem problem, UncertaintyKind kind, const Decimal& factor);

}  // namespace taut
