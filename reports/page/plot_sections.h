// SPDX-License-Identifier: GPL-3.0-or-later
// The report's sections with pictures: the move, and plots of what happens along it.
//
// The page says in words what there is to see and has an empty place for each picture, a <div data-plot="…">, which the page's
// script fills (reports/web/main.js). Without the script there are the words, the tables, and still_picture().
#pragma once

#include <string>

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// The robot on its way; nothing where there is no path.
[[nodiscard]] Html move_section(const ReportContext& scene);
/// Tensions, lengths, margins and pose along the path, the plane of two parameters, tolerances; each where there is one.
[[nodiscard]] Html plot_sections(const ReportContext& scene);

/// The page's data and script, to stand at its end.
[[nodiscard]] std::string page_scripts(const ReportContext& scene);
/// The page's Content-Security-Policy: nothing is loaded from anywhere, and no script is run but that of page_scripts().
[[nodiscard]] std::string content_security_policy();

}  // namespace taut
