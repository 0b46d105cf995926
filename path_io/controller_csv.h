// SPDX-License-Identifier: GPL-3.0-or-later
// controller.csv: a path as a dense table of poses and cable lengths, for the controller that follows it.
//
// Its rows are on the path but for rounding. What is proved is the path itself, through the waypoints of path.csv under
// their law. A controller that joins these rows in another way follows another path; that of winches which run from row
// to row at constant rates is audited by `taut audit CASE controller.csv`, since the table is one of cable lengths.
#pragma once

#include <string>
#include <string_view>

#include "kinematics/segment.h"
#include "problem/problem.h"

namespace taut {

/// What controller.csv begins with.
inline constexpr std::string_view kControllerFileBegin =
    "# Samples of a proved path, for the controller that follows it.";

/// How far the platform travels from row to row at most.
struct ControllerStep {
  double metres = 0.01;
  std::string text = "10 mm";  ///< as typed, for people
};

/// Reads "10 mm", "10mm" or "0.5 in". @throws InputError, of kind kUse and naming `option`, unless it is a length from
/// 1 nm to 1000 km.
[[nodiscard]] ControllerStep read_controller_step(const std::string& text, const std::string& option);

/// The whole file. Comments at its top name the case, the law, the step, the units, what is proved, and the certificate
/// by its SHA-256. Columns are segment and s (the place on the path), t if the path has times, the pose of the platform
/// as position and quaternion, and the cables' lengths. Each segment is divided evenly; from row to row neither the
/// platform's origin nor a cable's end on it travels more than the step, so no cable's length changes by more.
/// @throws InputError if that takes more than 200,000 rows.
[[nodiscard]] std::string controller_csv(const Problem& problem, const Path& path, const ControllerStep& step,
                                         std::string_view certificate_sha256);

}  // namespace taut
