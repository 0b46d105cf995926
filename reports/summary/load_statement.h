// SPDX-License-Identifier: GPL-3.0-or-later
// The load of a problem, said again in kg, t, N, kN and metres, so that a slip of units or signs shows.
//
// Nothing here is a claim of a proof: what is proved is the problem's own exact numbers.
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "problem/problem.h"

namespace taut {

struct Case;

/// A range of numbers, rounded outward: for machines. In words ranges are rounded inward, so that no load is said to be
/// covered that is not.
struct StatedRange {
  double lower = 0;
  double upper = 0;
};

/// K in numbers and words. Wrenches are about the load point, in the axes of W, with the platform's axes parallel to
/// them (R = I).
struct LoadStatement {
  std::optional<StatedRange> mass_kg;                        ///< of all weights together; nothing if there is none
  std::optional<std::array<double, 3>> centre_of_gravity_m;  ///< of the nominal masses, axes of P; rounded
  std::array<double, 6> nominal{};                           ///< force [N], moment [N m]; rounded
  std::array<StatedRange, 6> extremes;                       ///< of each component over K, enclosed

  std::string total;    ///< "In all 19.76 to 20.24 t, …", or the nominal wrench where there are no weights
  std::string spread;   ///< the extremes of each component
  std::string inertia;  ///< of a problem with limits in time: which weights are boxes and which are points; else empty
  std::vector<std::pair<std::string, std::string>> items;  ///< name and words: "payload", "11.76 to 12.24 t, …"

  /// What was said of the items, about the same load point, where K is an ellipsoid that was made around them.
  std::shared_ptr<const LoadStatement> around_items;
};

/// @pre the load is valid.
/// @throws InputError for numbers beyond the range of binary64, and for an ellipsoid all but singular.
[[nodiscard]] LoadStatement load_statement(const LoadText& load);
/// The same with the inertia of a problem that has limits in time.
[[nodiscard]] LoadStatement load_statement(const Problem& problem);

/// The same of a case, whose K may be an ellipsoid around its items.
[[nodiscard]] LoadStatement load_statement(const Case& the_case);

/// An item's name between quotes, which none of its own characters can end: what stands outside of them is ours.
[[nodiscard]] std::string quoted_name(const std::string& name);

/// The load beside its arrow in a picture: the mass of all weights, "19.76 to 20.24 t", or the size of the nominal
/// force and the mass that weighs as much under standard gravity, "1 N (102 g)"; "no force" if there is none.
[[nodiscard]] std::string brief_load(const LoadText& load);

/// Total, spread and items: a sentence each. Items that an ellipsoid was made around come first.
[[nodiscard]] std::vector<std::string> lines(const LoadStatement& statement);
/// The same without the items one by one.
[[nodiscard]] std::vector<std::string> brief_lines(const LoadStatement& statement);
[[nodiscard]] nlohmann::json to_json(const LoadStatement& statement);

/// The centre load of a problem without items and by how much each component may differ from it, or the lines of one
/// with items, as one paragraph.
[[nodiscard]] std::string load_text(const LoadText& load);

/// The load of each item under which a limit is violated, rounded: "'payload' 11.76 t, its centre of gravity off by
/// …; 'wind' (28.9, 7.9, 0) kN". @param choices  `loads` of a certificate's witness
[[nodiscard]] std::string witness_load_text(const LoadText& load, const nlohmann::json& choices);

}  // namespace taut
