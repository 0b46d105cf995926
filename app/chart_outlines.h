// SPDX-License-Identifier: GPL-3.0-or-later
// The charts of an atlas file as outlines, for pictures.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "case/case_file.h"

namespace taut {

/// A chart of a manifold of two dimensions whose points are named by two parameters (SI), in floating point.
struct ChartOutline {
  std::array<double, 2> centre{};
  /// The corners of the chart's polygon around its centre: by how much each parameter changes up to there, to first
  /// order. Where nothing is beside the chart, these are corners of the square that it begins as.
  std::vector<std::array<double, 2>> corners;
};

/// The outlines of all charts of a file that `taut plan --save-atlas` wrote. A chart whose parameters do not tell its
/// places apart to first order, such as one at θ = 0, is left out.
/// @pre the case has two parameters and no constraints
/// @throws InputError where the file is refused (docs/atlas-file.md), or has more charts than a picture shows
[[nodiscard]] std::vector<ChartOutline> chart_outlines(const Case& the_case, const std::filesystem::path& file);

}  // namespace taut
