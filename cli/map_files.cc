// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/map_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "cli/browser.h"
#include "cli/no_path_output.h"
#include "map/both_limits.h"
#include "map/singular.h"
#include "reports/map/grid_file.h"
#include "reports/map/picture.h"
#include "reports/map/polygons.h"
#include "reports/map/slices.h"

namespace taut {
namespace {

constexpr std::size_t kMostBoxes = std::size_t{1} << 30;

[[noreturn]] void refuse_grid_size(const std::string& text, std::size_t axes) {
  throw InputError(ErrorCode::kUse,
                   fmt::format("--grid-size: got '{}', expected one number of boxes or {} separated by commas, each "
                               "from 1 to {}, and no more than {} boxes in all",
                               excerpt(text), axes, kMaxGridSize, kMostBoxes));
}

/// "1024" or "720,360".
GridSize read_grid_size(const std::string& text, std::size_t axes) {
  GridSize size{1, 1, 1};
  if (text.empty()) {
    std::fill_n(size.begin(), axes, axes == 2 ? 1024 : 128);
    return size;
  }
  std::size_t count = 0;
  for (std::string_view rest = text; count <= axes;) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (count == axes || error != std::errc() || value < 1 || value > kMaxGridSize) refuse_grid_size(text, axes);
    size.at(count++) = value;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    if (rest.empty()) break;
    if (rest.front() != ',') refuse_grid_size(text, axes);
    rest.remove_prefix(1);
  }
  if (count == 1) std::fill_n(size.begin(), axes, size[0]);
  if (count != 1 && count != axes) refuse_grid_size(text, axes);
  std::size_t boxes = 1;
  for (const std::uint32_t n : size) {
    boxes *= n;
    if (boxes > kMostBoxes) refuse_grid_size(text, axes);
  }
  return size;
}

void require_two(const char* option, const MapSpace& space, const char* reason) {
  if (space.size() == 2) return;
  throw InputError(ErrorCode::kUse, fmt::format("{}: got a case with {} free coordinates, expected two, because {}",
                                                option, space.size(), reason));
}

/// The middles of where marked poses are.
template <std::size_t N>
std::array<double, N> middle(const std::vector<MapBox>& place) {
  std::array<double, N> t{};
  for (std::size_t k = 0; k < N; ++k) t.at(k) = 0.5 * (place.front().lower.at(k) + place.front().upper.at(k));
  return t;
}

/// Calls add(name, place) for the start, the query's waypoints and its goal.
template <class Add>
void for_each_mark(const CaseMap& made, const Add& add) {
  const auto& places = made.places();
  const bool is_typed = !made.start().empty() && !made.result().start.ends_with("of the query");
  for (std::size_t n = 0; n < places.size(); ++n) {
    const std::string name = n == 0 ? (is_typed ? "0" : "start") : n + 1 == places.size() ? "goal" : std::to_string(n);
    add(name, places[n]);
  }
  if (is_typed) add("from here", made.start());
}

std::string picture(const CaseMap& made, const std::vector<MapLine>& path, const std::vector<MapLine>& charts) {
  constexpr double kEnclosure = 1.0 / 2048;  // of det J = 0: half a pixel
  constexpr double kBoth = 1.0 / 2048;
  const MapResult& result = made.result();
  MapOverlay overlay;
  overlay.singular = singular_cells(result.problem, result.map, kEnclosure);
  overlay.both = cells_beyond_both(result.problem, result.map, kBoth);
  overlay.path = path;
  overlay.charts = charts;
  for_each_mark(made, [&](const std::string& name, const std::vector<MapBox>& place) {
    overlay.marks.push_back({name, middle<2>(place)});
  });
  return map_svg(result, overlay);
}

std::string slices(const CaseMap& made) {
  std::vector<SliceMark> marks;
  for_each_mark(made, [&](const std::string& name, const std::vector<MapBox>& place) {
    marks.push_back({name, middle<3>(place)});
  });
  return slices_page(made.result(), marks);
}

}  // namespace

MapFiles::MapFiles(const MapArguments& arguments, const MappedCase& mapped) : arguments_(arguments), mapped_(mapped) {
  const MapSpace& space = mapped.space;
  if (!arguments.polygons.empty()) {
    require_two("--polygons", space, "polygons are flat: --grid has three, too");
    require_another(arguments.polygons, arguments.case_path);
    require_writable(arguments.polygons);
  }
  if (arguments.png) {
    require_two("--png", space, "the picture is flat");
    if (arguments.out.empty()) throw InputError(ErrorCode::kUse, "--png: got no --out, expected a folder to draw in");
  }
  if (!arguments.path.empty()) {
    require_two("--path", space, "it is drawn in a flat picture");
    if (arguments.out.empty()) throw InputError(ErrorCode::kUse, "--path: got no --out, expected a folder to draw in");
    path_ = path_on_map(arguments.path, mapped.the_case.problem, space);
  }
  if (!arguments.atlas.empty()) {
    require_two("--atlas", space, "charts are drawn in a flat picture");
    if (arguments.out.empty()) throw InputError(ErrorCode::kUse, "--atlas: got no --out, expected a folder to draw in");
    charts_ = charts_on_map(arguments.atlas, mapped.the_case, space);
  }
  if (arguments.grid.empty()) {
    if (!arguments.grid_size.empty()) {
      throw InputError(ErrorCode::kUse, "--grid-size: got no --grid, expected the file to write");
    }
    return;
  }
  if (!arguments.grid.ends_with(".npy")) {
    throw InputError(ErrorCode::kUse,
                     fmt::format("--grid: got '{}', expected a name that ends in .npy", excerpt(arguments.grid)));
  }
  if (arguments.polygons == arguments.grid || arguments.polygons == arguments.grid + ".json") {
    throw InputError(ErrorCode::kUse, fmt::format("--polygons: got '{}', expected another file than --grid writes",
                                                  excerpt(arguments.polygons)));
  }
  require_another(arguments.grid, arguments.case_path);
  require_writable(arguments.grid);
  grid_size_ = read_grid_size(arguments.grid_size, space.size());
}

std::optional<std::vector<std::filesystem::path>> MapFiles::write(const CaseMap& made,
                                                                  const std::stop_token& stop) const {
  const MapResult& result = made.result();
  std::vector<FileContent> files;
  if (!arguments_.out.empty()) {
    const std::filesystem::path folder = arguments_.out;
    if (result.axes.size() == 2) {
      files.push_back({folder / "map.svg", picture(made, path_, charts_)});
      if (arguments_.png) {
        const auto [width, height] = map_picture_size(result);
        std::optional<std::string> png = draw_as_png(files.back().content, width, height, stop);
        if (!png) return std::nullopt;
        files.push_back({folder / "map.png", std::move(*png)});
      }
    } else {
      files.push_back({folder / "map.html", slices(made)});
    }
  }
  const bool are_apart = std::ranges::find(made.connections(), CaseMap::Connection::kApart) != made.connections().end();
  if (!arguments_.out.empty() && are_apart) {
    if (std::optional<std::string> certificate = no_path_certificate(mapped_.the_case, stop)) {
      files.push_back({std::filesystem::path(arguments_.out) / "certificate.json", std::move(*certificate)});
    }
  }
  if (!arguments_.polygons.empty()) files.push_back({arguments_.polygons, polygons_text(result)});
  if (!arguments_.grid.empty()) {
    const std::filesystem::path array = arguments_.grid;
    const std::vector<GridValue> values = grid_of(result.map, result.region, grid_size_);
    files.push_back({array, grid_npy(values, grid_size_, result.axes.size())});
    files.push_back({arguments_.grid + ".json", grid_meaning(result, values, grid_size_, array.filename().string())});
  }
  if (!arguments_.out.empty()) make_directories(arguments_.out);
  write_whole(files);
  std::vector<std::filesystem::path> paths;
  for (const FileContent& file : files) paths.push_back(file.path);
  return paths;
}

}  // namespace taut
