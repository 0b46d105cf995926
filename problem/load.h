// SPDX-License-Identifier: GPL-3.0-or-later
// The load of a problem: its checks and its JSON, as problem.h has them for the whole. Internal.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/json_cursor.h"
#include "problem/problem.h"

namespace taut {

inline constexpr std::size_t kMaxLoadItems = 64;
inline constexpr std::size_t kMaxLoadCases = 64;  ///< of one item
inline constexpr std::size_t kMaxItemName = 100;
inline constexpr int kGreatestInertiaBox_m = 1'000'000;  ///< a side of it

/// Checks all that the types of problem/loads.h and LoadText promise, that there is a load at all, that weights have
/// gravity, and that where there is gravity something pulls along it. Content of an item is named
/// "load.items[NAME].mass". @throws FieldError
void validate(const LoadText& load);

/// The `load` object of a certificate: with items, or in the form with `wrench` and `ellipsoid` alone.
[[nodiscard]] nlohmann::json to_json(const LoadText& load);
/// Inverse of to_json, without validating. @throws FieldError
[[nodiscard]] LoadText load_from_json(const JsonCursor& value);

}  // namespace taut
