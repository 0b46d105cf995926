// SPDX-License-Identifier: GPL-3.0-or-later
// What the page's script draws: the robot, poses along the path, proved ranges and margins, and the plane of two parameters, as
// one JSON object that the page carries.
//
// Its size is bounded, however long the path: poses are about kMostSamples, boxes and segments are put together until they are
// as few. What is proved stays so: put together, ranges are united, margins are the least, and each is rounded outward.
// Everything else is floating point. All numbers are finite or null, with about seven digits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "reports/summary/scene.h"

namespace taut {

/// The object; its keys are told where it is read, in reports/web/data.js.
[[nodiscard]] nlohmann::json report_data(const ReportContext& scene);

/// `value` as it may stand in a page, in a script element of type application/json: no '<' in it.
[[nodiscard]] std::string script_safe(const nlohmann::json& value);

}  // namespace taut
