// SPDX-License-Identifier: GPL-3.0-or-later
// What to change so that a path is proved: how the least margin depends on each number of a case, and the smallest
// changes of one number at a time with which the whole path is proved.
//
// Derivatives are floating point and say where to look. A change is stated only after a proof of the whole path, of the
// problem with exactly the changed decimals.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "certify/headroom.h"

namespace taut {

/// A change of one kind to a problem.
struct Change {
  enum class Kind {
    kTensionLower,    ///< of all cables; to `value` [N]
    kTensionUpper,    ///< likewise
    kLengthLower,     ///< of all cables; to `value` [m]
    kLengthUpper,     ///< likewise
    kWrench,          ///< w0 times `value`: the mass, where w0 is a weight
    kMass,            ///< both ends of the mass of the load item `item`, times `value`
    kBaseAnchor,      ///< coordinate `axis` of anchor `index`; to `value` [m]
    kPlatformAnchor,  ///< likewise
  };
  Kind kind = Kind::kTensionLower;
  std::size_t index = 0;
  std::size_t axis = 0;
  std::string item{};
};

/// "N" of a tension limit, "m" of a coordinate or a length limit, "1" of a factor.
[[nodiscard]] std::string_view unit(Change::Kind kind);

/// The problem with this change, exactly. Of limits, those of cables that have room already are left as they are.
/// @throws InputError where the result is no problem
[[nodiscard]] Problem with_change(Problem problem, const Change& change, const Decimal& value);

/// A change with which the whole path was proved.
struct ProvedChange {
  Change change;
  DecimalText before;                               ///< of six limits the first that is changed; of a factor "1"
  std::optional<DecimalText> value = std::nullopt;  ///< nothing: none was found
  bool is_complete = true;                          ///< false: time ended the search
};

struct Sensitivity {
  std::optional<TightPlace> tightest;   ///< where the derivatives were taken
  std::vector<Derivative> derivatives;  ///< by what natural steps gain, the most first; without those that are 0
  std::vector<ProvedChange> changes;    ///< of an unproved path
};

/// The step of a parameter that people think of, in the parameter's unit: 1 mm of a coordinate; 1 % of a tolerance, of
/// the weight, of a mass, of the range between two limits; of a component of w0 1 % of its force, or of that at the
/// platform's radius.
[[nodiscard]] double natural_step(const Problem& problem, const DesignParameter& parameter);

/// Differentiates what is left of the least margin, at the place where it is tightest; and of a path that is not proved
/// seeks the smallest changes that prove it, by bisection to within 2 % of the change.
/// @param unit_m  the length unit in which changed lengths are short decimals [m]
[[nodiscard]] Sensitivity find_sensitivity(const Problem& problem, const Path& path, Verdict verdict,
                                           const Decimal& unit_m, const HeadroomProgress& progress,
                                           const std::stop_token& stop);

}  // namespace taut
