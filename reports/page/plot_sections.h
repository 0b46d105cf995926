// SPDX-License-Identifier: GPL-3.0-or-later
// The report's sections with pictures: the move, and plots of what happens along it.
//
// The page describes each picture in words and has an empty place for it, a <div data-plot="…">, which the page's
// script fills (reports/web/main.js). Without the script the page has the words, the tables, and still_picture().
#pragma once

#include <string>

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// Whether there is a path to play and to plot: not where a planner found none, or the certificate has none or only one
/// pose.
[[nodiscard]] bool shows_path(const ReportContext& scene);
/// What move_section() shows: "The move", "Start and goal" where a planner found no path, or "The pose".
[[nodiscard]] const char* move_title(const ReportContext& scene);

/// The moving robot; nothing if there is no path to show.
[[nodiscard]] Html move_section(const ReportContext& scene);
/// Pose, tensions, lengths and margins along the path, the plane of two parameters, and tolerances, as far as they
/// exist.
[[nodiscard]] Html plot_sections(const ReportContext& scene);

/// The page's data and script, for the end of the page.
[[nodiscard]] std::string page_scripts(const ReportContext& scene);
/// The page's Content-Security-Policy: nothing is loaded from anywhere, and only the script of page_scripts() is run.
[[nodiscard]] std::string content_security_policy();

}  // namespace taut
