// SPDX-License-Identifier: GPL-3.0-or-later
// Which load breaks a limit: for a violation over all loads, one load of each item under which it stands.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "checker/kernel/machine.h"
#include "checker/kernel/statement.h"

namespace taut {

/// One load of each item, in it exactly, under which the least (or the greatest) tension of a cable is reached, or
/// nearly; proposed in floating point. @param geometry  of the machine at one pose @throws checker::Undefined
[[nodiscard]] std::vector<checker::LoadChoice> worst_loads(const checker::Problem& problem,
                                                           const checker::Geometry& geometry, std::size_t cable,
                                                           bool is_least);

/// As certificates state them (docs/certificate-format.md, "loads" of a witness).
[[nodiscard]] nlohmann::json to_json(const std::vector<checker::LoadChoice>& loads);

}  // namespace taut
