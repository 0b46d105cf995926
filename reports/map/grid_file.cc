// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/map/grid_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace taut {
namespace {

constexpr std::array<const char*, 6> kValueMeanings = {
    "open: nothing is proved of all of the box",
    "inside: every pose of the box is feasible (proved); whether it is reached from the start is open, or no start is "
    "given",
    "outside: no pose of the box is feasible (proved)",
    "reachable: every pose of the box is feasible, and feasible motions from the start reach it (proved)",
    "cut off: no feasible motion from the start reaches any pose of the box (proved); some may be feasible",
    "inside and cut off: every pose of the box is feasible, and no feasible motion from the start reaches any (proved)",
};

const char* index_text(MapAxis::Kind kind) {
  switch (kind) {
    case MapAxis::Kind::kTurn: return "a whole turn: the last box is next to the first";
    case MapAxis::Kind::kTilt:
      return "every tilt: (phi, theta) and (phi + 180 degrees, -theta) are one pose, so a negative theta is looked up "
             "with its sign changed and phi half a turn further";
    case MapAxis::Kind::kRange: break;
  }
  return "a range: nothing is said beyond its ends";
}

}  // namespace

std::string grid_npy(const std::vector<GridValue>& values, const GridSize& size, std::size_t axes) {
  std::string shape;
  for (std::size_t k = 0; k < axes; ++k) shape += (k == 0 ? "" : ", ") + std::to_string(size[k]);
  std::string header = fmt::format("{{'descr': '|u1', 'fortran_order': False, 'shape': ({}), }}", shape);
  constexpr std::size_t kPrefix = 10, kAlignment = 64;
  header.append((kAlignment - (kPrefix + header.size() + 1) % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string result("\x93NUMPY\x01\x00", 8);
  result += static_cast<char>(header.size() % 256);
  result += static_cast<char>(header.size() / 256);
  result += header;
  for (const GridValue value : values) result += static_cast<char>(value);
  return result;
}

std::string grid_meaning(const MapResult& result, const std::vector<GridValue>& values, const GridSize& size,
                         const std::string& array) {
  std::array<std::size_t, kValueMeanings.size()> counts{};
  for (const GridValue value : values) ++counts.at(static_cast<std::size_t>(value));
  nlohmann::json stated = nlohmann::json::array();
  for (std::size_t n = 0; n < counts.size(); ++n) {
    stated.push_back({{"value", n}, {"meaning", kValueMeanings.at(n)}, {"boxes", counts.at(n)}});
  }
  nlohmann::json axes = nlohmann::json::array();
  for (std::size_t k = 0; k < result.axes.size(); ++k) {
    const ShownAxis& shown = result.axes[k];
    const MapAxis& axis = result.map.space.axes[k];
    axes.push_back({{"name", shown.name},
                    {"unit", shown.unit},
                    {"origin", shown.lower},
                    {"step", (shown.upper - shown.lower) / size[k]},
                    {"count", size[k]},
                    {"exact_lower_si", axis.lower},
                    {"exact_upper_si", axis.upper},
                    {"kind", axis_kind_name(axis.kind)},
                    {"beyond", index_text(axis.kind)}});
  }
  nlohmann::json document = {
      {"taut_map_grid", 1},
      {"name", result.problem.name},
      {"array", array},
      {"axes", axes},
      {"values", stated},
      {"load", result.load},
      {"meaning", meaning(result)},
      {"boxes",
       "array[i, ...] is about the closed box from origin + i * step to origin + (i + 1) * step along each axis, ends "
       "included. Its exact ends are lower + i/count * (upper - lower) with the exact lower and upper in SI units."}};
  if (result.region) document["start"] = result.start;
  return document.dump(1, ' ', true) + "\n";
}

}  // namespace taut
