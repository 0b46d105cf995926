// SPDX-License-Identifier: GPL-3.0-or-later
// The data for the page's script: the robot, poses along the path, proved ranges and margins, and the plane of two
// parameters, as one JSON object in the page.
//
// Its size is bounded, however long the path is: there are about as many poses as a scene has samples, and boxes and
// segments are merged until there are few. What is proved stays true: ranges are united, the least margins are kept,
// and each is rounded outward. Everything else is floating point. All numbers are finite or null, with about seven
// digits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "reports/summary/scene.h"

namespace taut {

/// The object. Its keys are documented in reports/web/data.js, which reads it.
[[nodiscard]] nlohmann::json report_data(const ReportContext& scene);

/// `value` as the content of a script element of type application/json: without '<'.
[[nodiscard]] std::string script_safe(const nlohmann::json& value);

}  // namespace taut
