// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/outline.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "map/disjoint_sets.h"

namespace taut {
namespace {

using Corner = std::array<std::uint32_t, 2>;

/// Directions are numbered anticlockwise: +x, +y, −x, −y.
struct Edge {
  Corner begin, end;
  std::uint8_t direction = 0;
  std::uint32_t cell = 0;  ///< on its left
};

/// A cell's side on a line: of the cell beyond it, or of the cell before it.
struct Side {
  std::uint32_t line, begin, end, cell;
  auto operator<=>(const Side&) const = default;
};

std::uint64_t key(const Corner& corner) { return (std::uint64_t{corner[0]} << 32U) | corner[1]; }

class Outline {
 public:
  explicit Outline(const std::vector<Cell>& cells) : cells_(cells), sets_(cells.size()) {
    for (std::size_t axis = 0; axis < 2; ++axis) add_edges(axis);
    std::ranges::sort(edges_, {},
                      [](const Edge& edge) { return std::tuple(edge.begin[1], edge.begin[0], edge.direction); });
  }

  std::vector<OutlinePolygon> polygons() {
    taken_.assign(edges_.size(), false);
    for (std::size_t first = 0; first < edges_.size(); ++first) {
      if (!taken_[first]) trace(first);
    }
    std::vector<OutlinePolygon> result;
    for (OutlinePolygon& polygon : polygons_) {
      if (!polygon.outer.empty()) result.push_back(std::move(polygon));
    }
    return result;
  }

 private:
  // ---- Edges: what is a side of cells on one side of a line alone --------------------------------------------------

  void add_edges(std::size_t axis) {
    std::vector<Side> before, beyond;
    for (std::uint32_t n = 0; n < cells_.size(); ++n) {
      const Cell& cell = cells_[n];
      const auto ends = [&](std::size_t k) {
        const int unused = kMaxCellDepth - cell.depth[k];
        return std::pair(cell.k[k] << unused, (cell.k[k] + 1) << unused);
      };
      const auto [lower, upper] = ends(axis);
      const auto [begin, end] = ends(1 - axis);
      beyond.push_back({lower, begin, end, n});
      before.push_back({upper, begin, end, n});
    }
    std::ranges::sort(before);
    std::ranges::sort(beyond);
    std::size_t i = 0, j = 0;
    while (i < before.size() || j < beyond.size()) {
      const bool is_alone = j == beyond.size() || (i < before.size() && is_over(before[i], beyond[j]));
      const bool other_is_alone = i == before.size() || (j < beyond.size() && is_over(beyond[j], before[i]));
      if (is_alone) {
        add(axis, before[i++], true);
      } else if (other_is_alone) {
        add(axis, beyond[j++], false);
      } else {
        match(axis, before, i, beyond, j);
      }
    }
  }

  /// Whether a side ends before another begins.
  static bool is_over(const Side& side, const Side& other) {
    return std::pair(side.line, side.end) <= std::pair(other.line, other.begin);
  }

  /// Two sides that overlap: what is common to them is no edge.
  void match(std::size_t axis, std::vector<Side>& before, std::size_t& i, std::vector<Side>& beyond, std::size_t& j) {
    Side& a = before[i];
    Side& b = beyond[j];
    sets_.join(a.cell, b.cell);
    if (a.begin < b.begin) add(axis, {a.line, a.begin, b.begin, a.cell}, true);
    if (b.begin < a.begin) add(axis, {b.line, b.begin, a.begin, b.cell}, false);
    const std::uint32_t end = std::min(a.end, b.end);
    a.begin = b.begin = end;
    if (a.end == end) ++i;
    if (b.end == end) ++j;
  }

  /// @param is_upper  the cell is before the line
  void add(std::size_t axis, const Side& side, bool is_upper) {
    if (side.begin == side.end) return;
    const auto corner = [&](std::uint32_t along) {
      return axis == 0 ? Corner{side.line, along} : Corner{along, side.line};
    };
    const bool is_rising = is_upper == (axis == 0);
    const Corner lower = corner(side.begin), upper = corner(side.end);
    const auto direction = static_cast<std::uint8_t>((axis == 0 ? 1 : 0) + (is_rising ? 0 : 2));
    edges_.push_back({is_rising ? lower : upper, is_rising ? upper : lower, direction, side.cell});
  }

  // ---- Rings -------------------------------------------------------------------------------------------------------

  /// The edge that goes on: where two begin, the one on the left, which stays with the cell.
  [[nodiscard]] std::size_t next(const Edge& edge) const {
    const auto place = std::pair(edge.end[1], edge.end[0]);
    auto found =
        std::ranges::lower_bound(edges_, place, {}, [](const Edge& e) { return std::pair(e.begin[1], e.begin[0]); });
    const auto other = std::next(found);
    const bool are_two = other != edges_.end() && other->begin == edge.end;
    if (are_two && other->direction == (edge.direction + 1) % 4) found = other;
    return static_cast<std::size_t>(found - edges_.begin());
  }

  void trace(std::size_t first) {
    std::vector<Edge> open;                             // of the ring so far, without loops
    std::unordered_map<std::uint64_t, std::size_t> at;  // the place in `open` of the edge that begins at a corner
    std::size_t here = first;
    while (!taken_[here]) {
      taken_[here] = true;
      const Edge& edge = edges_[here];
      at[key(edge.begin)] = open.size();
      open.push_back(edge);
      if (const auto closed = at.find(key(edge.end)); closed != at.end()) {
        const std::size_t begin = closed->second;
        close({open.begin() + static_cast<std::ptrdiff_t>(begin), open.end()});
        for (std::size_t n = begin; n < open.size(); ++n) at.erase(key(open[n].begin));
        open.resize(begin);
      }
      here = next(edge);
    }
  }

  void close(const std::vector<Edge>& loop) {
    OutlineRing ring;
    for (std::size_t n = 0; n < loop.size(); ++n) {
      const Edge& previous = loop[n == 0 ? loop.size() - 1 : n - 1];
      if (previous.direction != loop[n].direction) ring.push_back(loop[n].begin);
    }
    const std::uint32_t set = sets_.find(loop.front().cell);
    const auto [found, is_new] = polygon_of_.try_emplace(set, polygons_.size());
    if (is_new) polygons_.emplace_back().cell = loop.front().cell;
    OutlinePolygon& polygon = polygons_[found->second];
    if (is_anticlockwise(loop)) {
      polygon.outer = std::move(ring);
    } else {
      polygon.holes.push_back(std::move(ring));
    }
  }

  /// The lowest of the leftmost edges runs down where the loop is anticlockwise.
  static bool is_anticlockwise(const std::vector<Edge>& loop) {
    const Edge* leftmost = nullptr;
    for (const Edge& edge : loop) {
      if (edge.direction % 2 == 1 && (leftmost == nullptr || edge.begin[0] < leftmost->begin[0])) leftmost = &edge;
    }
    return leftmost->direction == 3;
  }

  const std::vector<Cell>& cells_;
  DisjointSets sets_;  ///< of cells that share edges
  std::vector<Edge> edges_;
  std::vector<bool> taken_;
  std::unordered_map<std::uint32_t, std::size_t> polygon_of_;
  std::vector<OutlinePolygon> polygons_;
};

/// The area within a ring, negative where it runs clockwise, in units of 2^-60.
std::int64_t area_of(const OutlineRing& ring) {
  std::uint64_t sum = 0;  // wraps around; the result does not
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const auto& here = ring[n];
    const auto& next = ring[(n + 1) % ring.size()];
    sum += std::uint64_t{here[0]} * (std::uint64_t{next[1]} - std::uint64_t{here[1]});
  }
  return static_cast<std::int64_t>(sum);
}

}  // namespace

double OutlinePolygon::area() const {
  std::int64_t sum = area_of(outer);
  for (const OutlineRing& hole : holes) sum += area_of(hole);
  return std::ldexp(static_cast<double>(sum), -2 * kMaxCellDepth);
}

std::vector<OutlinePolygon> outline(const std::vector<Cell>& cells) { return Outline(cells).polygons(); }

}  // namespace taut
