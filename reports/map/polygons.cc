// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/map/polygons.h"

#include <map>
#include <nlohmann/json.hpp>

#include "map/outline.h"

namespace taut {
namespace {

using Reach = MapRegion::Reach;

/// What cells have in common that make one feature.
struct FeatureKey {
  CellKind kind;
  std::uint32_t component;  ///< of inside cells; else kNone
  Reach reach;
  auto operator<=>(const FeatureKey&) const = default;
};

const char* kind_meaning(CellKind kind) {
  switch (kind) {
    case CellKind::kInside: return "every pose is feasible (proved)";
    case CellKind::kLength: return "no pose is feasible: a length is beyond a limit (proved)";
    case CellKind::kTension: return "no pose is feasible: a tension is beyond a limit for some load (proved)";
    case CellKind::kUnbalanced: return "no pose is feasible: no tensions within the limits balance some load (proved)";
    case CellKind::kContact: return "no pose is feasible: two bodies are too near (proved)";
    case CellKind::kUndecided: break;
  }
  return "nothing is proved of these poses";
}

const char* reach_name(Reach reach) {
  switch (reach) {
    case Reach::kReachable: return "reachable";
    case Reach::kCutOff: return "cut_off";
    case Reach::kOpen: break;
  }
  return "open";
}

nlohmann::json ring_json(const OutlineRing& ring, const std::vector<ShownAxis>& axes) {
  nlohmann::json result = nlohmann::json::array();
  for (std::size_t n = 0; n <= ring.size(); ++n) {  // the first corner is repeated
    const auto& corner = ring[n % ring.size()];
    const auto value = [&](std::size_t k) { return axes[k].at(static_cast<double>(corner[k]) / kOutlineUnits); };
    result.push_back({value(0), value(1)});
  }
  return result;
}

nlohmann::json feature_json(const MapResult& result, const FeatureKey& key, const std::vector<Cell>& cells) {
  nlohmann::json polygons = nlohmann::json::array();
  double share = 0;
  for (const OutlinePolygon& polygon : outline(cells)) {
    nlohmann::json rings = {ring_json(polygon.outer, result.axes)};
    for (const OutlineRing& hole : polygon.holes) rings.push_back(ring_json(hole, result.axes));
    polygons.push_back(std::move(rings));
    share += polygon.area();
  }
  nlohmann::json properties = {{"kind", cell_kind_name(key.kind)},
                               {"meaning", kind_meaning(key.kind)},
                               {"share", share},
                               {"area", share * whole_volume(result.axes)},
                               {"cells", cells.size()}};
  if (key.component != MapTopology::kNone) properties["component"] = key.component;
  if (result.region && !is_outside(key.kind)) properties["from_start"] = reach_name(key.reach);
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", {{"type", "MultiPolygon"}, {"coordinates", std::move(polygons)}}}};
}

}  // namespace

std::vector<std::string> meaning(const MapResult& result) {
  const bool has_tolerances = result.problem.tolerances.has_value();
  const bool has_bodies = result.problem.bodies.has_value();
  const bool has_contacts = has_bodies && !result.problem.bodies->contacts.empty();
  std::vector<std::string> sentences = {
      std::string("Inside: at every pose of the closed cell, every load ") +
          (has_tolerances ? "and every deviation within the tolerances leave" : "leaves") +
          " all cable tensions and lengths strictly within their limits" +
          (has_bodies ? ", and the bodies of every checked pair farther apart than its clearance (proved)."
                      : " (proved)."),
      std::string("Outside: at every pose of the closed cell the machine as typed breaks a limit for some load") +
          (has_bodies ? ", or two bodies are no farther apart than their clearance (proved)." : " (proved)."),
      "Undecided: nothing is proved.",
      "What is proved here is proved by taut, in interval arithmetic. No certificate states it, so taut-check has not "
      "confirmed it.",
  };
  if (has_contacts) {
    sentences.push_back("Where bodies may touch, minus the depth allowed takes the place of their clearance.");
  }
  if (!result.region) return sentences;
  sentences.push_back(
      "Reachable: inside, and a motion from the start leads to every pose, all along which every pose "
      "is inside (proved).");
  sentences.push_back(
      "Cut off: no motion of the coordinates within the space, of any speed or shape, of which every "
      "pose is feasible, leads from the start to any pose of it (proved).");
  sentences.push_back("Open: whether it is reached from the start is not proved.");
  return sentences;
}

std::string polygons_text(const MapResult& result) {
  std::map<FeatureKey, std::vector<Cell>> features;
  result.map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    const CellKind kind = result.map.nodes[node].kind;
    const Reach reach = result.region && !is_outside(kind) ? result.region->reach(node) : Reach::kOpen;
    features[{kind, result.topology.inside_component(node), reach}].push_back(cell);
  });
  nlohmann::json collection = {{"type", "FeatureCollection"}, {"features", nlohmann::json::array()}};
  for (const auto& [key, cells] : features) collection["features"].push_back(feature_json(result, key, cells));
  nlohmann::json axes = nlohmann::json::array();
  for (std::size_t k = 0; k < 2; ++k) {
    const ShownAxis& shown = result.axes[k];
    const MapAxis& axis = result.map.space.axes[k];
    axes.push_back({{"name", shown.name},
                    {"unit", shown.unit},
                    {"lower", shown.lower},
                    {"upper", shown.upper},
                    {"exact_lower_si", axis.lower},
                    {"exact_upper_si", axis.upper},
                    {"kind", axis_kind_name(axis.kind)},
                    {"units", kOutlineUnits}});
  }
  collection["taut_map"] = {{"name", result.problem.name},
                            {"axes", std::move(axes)},
                            {"area_unit", volume_unit(result.axes)},
                            {"load", result.load},
                            {"meaning", meaning(result)},
                            {"exactness",
                             "Edges are edges of cells: each coordinate is lower + k/units * (upper - lower) for a "
                             "whole number k, rounded to "
                             "binary64. k = round((x - lower)/(upper - lower) * units) is exact."}};
  if (result.region) collection["taut_map"]["start"] = result.start;
  return collection.dump(-1, ' ', true) + "\n";
}

}  // namespace taut
