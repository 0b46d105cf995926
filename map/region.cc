// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/region.h"

#include <algorithm>

namespace taut {

MapRegion::MapRegion(const MapTopology& topology, const std::vector<MapBox>& from) : topology_(topology) {
  const std::vector<std::uint32_t> leaves = topology.leaves_at(from);
  for (const std::uint32_t node : leaves) {
    const std::uint32_t component = topology.possible_component(node);
    if (component != MapTopology::kNone) from_possible_.push_back(component);
  }
  std::ranges::sort(from_possible_);
  from_possible_.erase(std::ranges::unique(from_possible_).begin(), from_possible_.end());
  for (const std::uint32_t component : from_possible_) possible_ += topology.possible()[component].volume;
  if (leaves.empty()) return;
  // Which of these leaves has the place is not known, so all of them must be in one component.
  const std::uint32_t inside = topology.inside_component(leaves.front());
  const auto is_in_it = [&](std::uint32_t node) { return topology.inside_component(node) == inside; };
  if (inside == MapTopology::kNone || !std::ranges::all_of(leaves, is_in_it)) return;
  from_inside_ = inside;
  reachable_ = topology.inside()[inside].volume;
}

auto MapRegion::reach(std::uint32_t node) const -> Reach {
  const std::uint32_t inside = topology_.inside_component(node);
  if (inside != MapTopology::kNone && inside == from_inside_) return Reach::kReachable;
  return std::ranges::binary_search(from_possible_, topology_.possible_component(node)) ? Reach::kOpen : Reach::kCutOff;
}

}  // namespace taut
