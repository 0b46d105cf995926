// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/plane_map.h"

#include <fmt/format.h>

#include "base/input_error.h"
#include "map/both_limits.h"
#include "map/region.h"
#include "map/singular.h"
#include "reports/page/map_axis.h"
#include "reports/page/map_frame.h"

namespace taut {
namespace {

constexpr double kLeastWidth = 1.0 / 512;    ///< of a cell: about a dot of the picture
constexpr double kOverlayWidth = 1.0 / 256;  ///< of those on top of these

SubdivisionOptions options_of(std::size_t most_cells) {
  SubdivisionOptions options;
  options.least_width = kLeastWidth;
  options.most_cells = most_cells;
  return options;
}

/// Inside cells that no motion from the query's first waypoint reaches.
std::vector<Cell> cut_off_cells(const Problem& problem, const CellMap& map) {
  std::vector<Cell> result;
  if (problem.query.empty()) return result;
  const MapTopology topology(map);
  const MapRegion region(topology, place_of(map.space, problem.query.front()));
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (map.nodes[node].kind != CellKind::kInside) return;
    if (region.reach(node) == MapRegion::Reach::kCutOff) result.push_back(cell);
  });
  return result;
}

/// Everything but cut_off.
PlaneMap drawn(const Problem& problem, const CellMap& map) {
  PlaneMap result;
  std::array<std::vector<Cell>, kCellKinds> cells;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    cells.at(static_cast<std::size_t>(map.nodes[node].kind)).push_back(cell);
  });
  const auto add = [&](const char* kind, const std::vector<Cell>& of) {
    if (!of.empty()) result.areas.push_back({kind, area_path(of)});
  };
  for (std::size_t kind = 0; kind < kCellKinds; ++kind) {
    add(cell_kind_name(static_cast<CellKind>(kind)), cells.at(kind));
  }
  add("both", cells_beyond_both(problem, map, kOverlayWidth));
  add("singular", singular_cells(problem, map, kOverlayWidth));
  for (std::size_t k = 0; k < 2; ++k) {
    const MapAxis& axis = map.space.axes[k];
    result.window.at(k) = {evaluate_constant<double>(axis.lower), evaluate_constant<double>(axis.upper)};
    result.turns.at(k) = axis.kind != MapAxis::Kind::kRange;
  }
  if (map.space.flip) result.flip = {map.space.flip->phi, map.space.flip->theta};
  result.share = map.share;
  result.cells = map.leaves();
  return result;
}

/// Nothing where `make` finds that there is no map.
template <class Make>
std::optional<PlaneMap> if_mapped(const ReportContext& scene, const Make& make) {
  const Problem& problem = scene.certificate.problem;
  if (!is_plane(problem.space) || scene.recheck.result == Recheck::Result::kUnchecked) return std::nullopt;
  try {
    return make(problem);
  } catch (const InputError&) {  // FieldError among them
    return std::nullopt;
  }
}

}  // namespace

std::optional<PlaneMap> plane_map(const ReportContext& scene) {
  constexpr std::size_t kMostCells = 60'000;
  return if_mapped(scene, [&](const Problem& problem) {
    const CellMap map = subdivide(problem, make_map_space(problem.space), options_of(kMostCells));
    PlaneMap result = drawn(problem, map);
    const std::vector<Cell> cut_off = cut_off_cells(problem, map);
    if (!cut_off.empty()) result.areas.push_back({"cut_off", area_path(cut_off)});
    return result;
  });
}

std::optional<PlaneMap> plane_map(const ReportContext& scene, const std::array<Span, 2>& window) {
  constexpr std::size_t kMostCells = 10'000;
  return if_mapped(scene, [&](const Problem& problem) {
    MapSpace space;
    for (std::size_t k = 0; k < 2; ++k) {
      const Span& span = window.at(k);
      space.axes.push_back({problem.space.parameters[k].name, MapAxis::Kind::kRange, fmt::format("{:.20f}", span.lower),
                            fmt::format("{:.20f}", span.upper)});
    }
    return drawn(problem, subdivide(problem, space, options_of(kMostCells)));
  });
}

}  // namespace taut
