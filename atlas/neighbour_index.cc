// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/neighbour_index.h"

namespace taut {

NeighbourIndex::Point NeighbourIndex::locate(const AmbientPoint& ambient_point) {
  Point point{};
  std::copy_n(ambient_point.data(), std::min<Eigen::Index>(ambient_point.size(), kDimension), point.begin());
  return point;
}

NeighbourIndex::Entries NeighbourIndex::tree() const {
  Entries all(stored_.begin(), stored_.end());
  for (const Entries& tree : trees_) all.insert(all.end(), tree.begin(), tree.end());
  all.insert(all.end(), recent_.begin(), recent_.end());
  build(all, 0, all.size());
  return all;
}

void NeighbourIndex::insert(int id, const Point& point, double reach) {
  recent_.push_back({point, reach, 0, id, 0});
  if (recent_.size() < kBucket) return;
  Entries merged;
  merged.swap(recent_);
  std::size_t k = 0;
  for (; k < trees_.size() && !trees_[k].empty(); ++k) {
    merged.insert(merged.end(), trees_[k].begin(), trees_[k].end());
    trees_[k].clear();
  }
  if (k == trees_.size()) trees_.emplace_back();
  build(merged, 0, merged.size());
  trees_[k] = std::move(merged);
}

void NeighbourIndex::build(Entries& entries, std::size_t begin, std::size_t end) {
  if (end - begin <= kBucket) return;
  Point lower = entries[begin].point;
  Point upper = lower;
  double largest_reach = 0;
  for (std::size_t e = begin; e < end; ++e) {
    for (int k = 0; k < kDimension; ++k) {
      lower[k] = std::min(lower[k], entries[e].point[k]);
      upper[k] = std::max(upper[k], entries[e].point[k]);
    }
    largest_reach = std::max(largest_reach, entries[e].reach);
  }
  int split = 0;
  for (int k = 1; k < kDimension; ++k) {
    if (upper[k] - lower[k] > upper[split] - lower[split]) split = k;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t e) { return entries.begin() + static_cast<std::ptrdiff_t>(e); };
  std::nth_element(at(begin), at(middle), at(end),
                   [split](const Entry& a, const Entry& b) { return a.point[split] < b.point[split]; });
  entries[middle].largest_reach = largest_reach;
  entries[middle].split = split;
  build(entries, begin, middle);
  build(entries, middle + 1, end);
}

}  // namespace taut
