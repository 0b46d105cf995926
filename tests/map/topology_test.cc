// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbours against a brute force of another kind: cells share a pose exactly if two of their grid points have the
// same name, and names are held to rotation matrices.
#include "map/topology.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <random>
#include <set>

#include "kinematics/geometry.h"
#include "map/disjoint_sets.h"
#include "tests/map/problems.h"
#include "tests/map/random_map.h"

namespace taut::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

MapSpace space_of(bool flip, bool sigma) {
  if (sigma) return make_map_space(robot1_sigma_free().space);
  SpaceText text = robot1_slice().space;
  if (!flip) text.flip.reset();
  return make_map_space(text);
}

/// φ, θ with θ in a range: a wall.
MapSpace walled() {
  MapSpace space = space_of(true, false);
  space.axes[1] = {"theta", MapAxis::Kind::kRange, "0.1", "1.2"};
  space.flip.reset();
  return space;
}

/// φ, θ and a third coordinate of some kind, which is not σ; `order` says which axis is which.
MapSpace with_third(MapAxis::Kind kind, const std::array<std::size_t, 3>& order) {
  const MapSpace slice = space_of(true, false);
  MapSpace space;
  space.axes.resize(3);
  space.axes[order[0]] = slice.axes[slice.flip->phi];
  space.axes[order[1]] = slice.axes[slice.flip->theta];
  space.axes[order[2]] = {"x", kind, "0", "1"};
  space.flip = MapSpace::Flip{order[0], order[1], std::nullopt};
  return space;
}

/// Spaces with each kind of neighbours at the poles.
std::vector<MapSpace> all_spaces() {
  MapSpace sigma_first = with_third(MapAxis::Kind::kTurn, {2, 1, 0});
  sigma_first.flip->sigma = 0;
  return {space_of(true, false),
          space_of(false, false),
          walled(),
          space_of(true, true),
          sigma_first,
          with_third(MapAxis::Kind::kRange, {0, 1, 2}),
          with_third(MapAxis::Kind::kTurn, {1, 2, 0})};
}

using Point = std::array<int, 3>;  // in units of 2^-kDepth
constexpr int kOne = 1 << kDepth;

/// One name for all points that are the same pose.
Point name_of(const MapSpace& space, Point x) {
  for (std::size_t k = 0; k < space.size(); ++k) {
    if (space.axes[k].kind == MapAxis::Kind::kTurn) x[k] %= kOne;
  }
  if (!space.flip) return x;
  const auto [phi, theta, sigma] = *space.flip;
  if (x[theta] == 0) x[phi] = 0;
  if (x[theta] == kOne) {
    const int twist = (sigma ? x[*sigma] : 0) - 2 * x[phi];
    x[phi] = 0;
    if (sigma) x[*sigma] = (twist + 2 * kOne) % kOne;
    if (!sigma) x[phi] = ((-twist / 2) % (kOne / 2) + kOne) % (kOne / 2);
  }
  return x;
}

template <class Visit>
void for_each_point(const MapSpace& space, const Cell& cell, const Visit& visit) {
  std::array<std::array<int, 2>, 3> ends{};
  for (std::size_t k = 0; k < space.size(); ++k) {
    const int width = kOne >> cell.depth[k];
    ends[k] = {static_cast<int>(cell.k[k]) * width, static_cast<int>(cell.k[k] + 1) * width};
  }
  for (int a = ends[0][0]; a <= ends[0][1]; ++a) {
    for (int b = ends[1][0]; b <= ends[1][1]; ++b) {
      for (int c = ends[2][0]; c <= ends[2][1]; ++c) visit(Point{a, b, c});
    }
  }
}

TEST(MapTopology, NamesOfPosesAreThoseOfRotations) {
  for (const bool sigma : {false, true}) {
    const MapSpace space = space_of(true, sigma);
    std::vector<std::pair<Point, Matrix3<double>>> poses;
    for_each_point(space, Cell(), [&](const Point& x) {
      const auto turn = [](int t) { return (2.0 * t / kOne - 1) * kPi; };
      const double torsion = sigma ? turn(x[2]) : 0.6;
      poses.emplace_back(name_of(space, x), rotation(turn(x[0]), x[1] * kPi / kOne, torsion));
    });
    for (const auto& [name, r] : poses) {
      for (const auto& [other_name, other] : poses) {
        EXPECT_EQ(name == other_name, (r - other).norm() < 1e-9);
      }
    }
  }
}

TEST(MapTopology, FindsExactlyTheCellsThatShareAPose) {
  Random random(5);
  for (const MapSpace& space : all_spaces()) {
    for (int trial = 0; trial < 20; ++trial) {
      const CellMap map = random_map(random, space, 0.4, 0.3);
      std::map<Point, std::set<std::uint32_t>> at;
      map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
        for_each_point(space, cell, [&](const Point& x) { at[name_of(space, x)].insert(node); });
      });
      const MapTopology topology(map);
      map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
        std::set<std::uint32_t> expected = {node};
        for_each_point(space, cell, [&](const Point& x) {
          const auto& leaves = at[name_of(space, x)];
          expected.insert(leaves.begin(), leaves.end());
        });
        const std::vector<std::uint32_t> found = topology.neighbours(cell);
        EXPECT_EQ(std::set<std::uint32_t>(found.begin(), found.end()), expected);
      });
    }
  }
}

TEST(MapTopology, NumbersComponentsByTheirSize) {
  Random random(6);
  const MapSpace space = space_of(true, false);
  for (int trial = 0; trial < 30; ++trial) {
    const CellMap map = random_map(random, space, 0.3, 0.5);
    const MapTopology topology(map);
    std::vector<MapComponent> inside(topology.inside().size()), possible(topology.possible().size());
    map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
      const CellKind kind = map.nodes[node].kind;
      EXPECT_EQ(topology.inside_component(node) != MapTopology::kNone, kind == CellKind::kInside);
      EXPECT_EQ(topology.possible_component(node) != MapTopology::kNone, !is_outside(kind));
      if (kind == CellKind::kInside) inside.at(topology.inside_component(node)).volume += cell.volume();
      if (!is_outside(kind)) possible.at(topology.possible_component(node)).volume += cell.volume();
      for (const std::uint32_t other : topology.neighbours(cell)) {
        if (is_outside(kind) || is_outside(map.nodes[other].kind)) continue;
        EXPECT_EQ(topology.possible_component(node), topology.possible_component(other));
        if (kind != CellKind::kInside || map.nodes[other].kind != CellKind::kInside) continue;
        EXPECT_EQ(topology.inside_component(node), topology.inside_component(other));
      }
    });
    for (std::size_t k = 0; k < inside.size(); ++k) EXPECT_EQ(inside[k].volume, topology.inside()[k].volume);
    for (std::size_t k = 0; k < possible.size(); ++k) EXPECT_EQ(possible[k].volume, topology.possible()[k].volume);
    for (std::size_t k = 1; k < possible.size(); ++k) {
      EXPECT_GE(topology.possible()[k - 1].volume, topology.possible()[k].volume);
    }
  }
}

// Poles are joined in the order of the poses there, not by pairs: the components must be those of the pairs.
TEST(MapTopology, ComponentsAreThoseOfAllPairsOfNeighbours) {
  Random random(8);
  for (const MapSpace& space : all_spaces()) {
    std::size_t several = 0;
    for (int trial = 0; trial < 600; ++trial) {
      const CellMap map = random_map(random, space, 0.15, 0.7);
      DisjointSets inside(map.nodes.size()), possible(map.nodes.size());
      std::vector<std::uint32_t> leaves;
      map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
        const CellKind kind = map.nodes[node].kind;
        if (is_outside(kind)) return;
        leaves.push_back(node);
        for (const std::uint32_t other : neighbours(map, cell)) {
          if (is_outside(map.nodes[other].kind)) continue;
          possible.join(node, other);
          if (kind == CellKind::kInside && map.nodes[other].kind == CellKind::kInside) inside.join(node, other);
        }
      });
      const MapTopology topology(map);
      several += topology.possible().size() > 2 ? 1 : 0;
      for (const std::uint32_t a : leaves) {
        for (const std::uint32_t b : leaves) {
          EXPECT_EQ(topology.possible_component(a) == topology.possible_component(b),
                    possible.find(a) == possible.find(b));
          if (map.nodes[a].kind != CellKind::kInside || map.nodes[b].kind != CellKind::kInside) continue;
          EXPECT_EQ(topology.inside_component(a) == topology.inside_component(b), inside.find(a) == inside.find(b));
        }
      }
    }
    EXPECT_GT(several, 10U);
  }
}

bool holds(const std::vector<MapBox>& place, double t0, double t1) {
  return std::ranges::any_of(place, [&](const MapBox& box) {
    return box.lower[0] <= t0 && t0 <= box.upper[0] && box.lower[1] <= t1 && t1 <= box.upper[1] &&
           box.upper[0] - box.lower[0] < 1e-12 && box.upper[1] - box.lower[1] < 1e-12;
  });
}

TEST(MapTopology, FindsThePlaceOfAPose) {
  const MapSpace space = space_of(true, false);
  EXPECT_TRUE(holds(place_of(space, {"0", "pi/2"}), 0.5, 0.5));
  EXPECT_TRUE(holds(place_of(space, {"pi/2", "pi/4"}), 0.75, 0.25));
  EXPECT_TRUE(holds(place_of(space, {"pi/2 + 6*pi", "pi/4"}), 0.75, 0.25));
  EXPECT_TRUE(holds(place_of(space, {"pi", "pi/4"}), 0, 0.25));
  EXPECT_TRUE(holds(place_of(space, {"pi", "pi/4"}), 1, 0.25));
  EXPECT_TRUE(holds(place_of(space, {"pi/2", "-pi/4"}), 0.25, 0.25));         // the flip
  EXPECT_TRUE(holds(place_of(space, {"pi/2", "-2*pi - pi/4"}), 0.25, 0.25));  // and a turn
  EXPECT_TRUE(holds(place_of(space, {"pi/2", "5*pi/4"}), 0.25, 0.75));
  EXPECT_TRUE(holds(place_of(space, {"pi/2", "pi"}), 0.75, 1));
  EXPECT_TRUE(holds(place_of(space, {"pi/2", "0"}), 0.75, 0));
  EXPECT_FALSE(holds(place_of(space, {"0", "pi/2"}), 0.5, 0.49));
}

/// A map whose cells are given by a function of their middle.
CellMap grid(const MapSpace& space, int depth, const std::function<CellKind(double, double)>& kind) {
  return tree_of(space, [&](const Cell& cell) -> std::variant<CellKind, std::size_t> {
    const std::size_t axis = cell.depth[0] <= cell.depth[1] ? 0 : 1;
    if (cell.depth[axis] != depth) return axis;
    return kind(cell.mid(0), cell.mid(1));
  });
}

/// Two meridians that touch only on θ = 0, on θ = π, or across φ = ±π.
TEST(MapTopology, JoinsAcrossPolesAndTurns) {
  using enum MapTopology::Connection;
  const MapSpace space = space_of(true, false);
  const auto column = [](double t0, int k) { return std::abs(t0 * 16 - (k + 0.5)) < 0.1; };
  const auto connection = [&](const MapSpace& of, int a, int b, double from, double to) {
    const CellMap map = grid(of, 4, [&](double t0, double t1) {
      const bool is_in = (column(t0, a) || column(t0, b)) && t1 > from && t1 < to;
      return is_in ? CellKind::kInside : CellKind::kTension;
    });
    const auto place = [](int k) {
      MapBox box;
      box.lower = {(k + 0.5) / 16, 0.53, 0};
      box.upper = {(k + 0.5) / 16, 0.53, 1};
      return std::vector{box};
    };
    return MapTopology(map).connection(place(a), place(b));
  };
  EXPECT_EQ(connection(space, 2, 7, 0.25, 0.75), kApart);
  EXPECT_EQ(connection(space, 2, 7, 0, 0.75), kJoined);  // over θ = 0, whatever φ is
  EXPECT_EQ(connection(space, 2, 7, 0.25, 1), kApart);   // over θ = π only half a turn away
  EXPECT_EQ(connection(space, 2, 10, 0.25, 1), kJoined);
  EXPECT_EQ(connection(space, 2, 11, 0.25, 1), kJoined);  // corners of [2, 3] + 8 and [11, 12] touch
  EXPECT_EQ(connection(space, 2, 12, 0.25, 1), kApart);
  EXPECT_EQ(connection(space, 0, 15, 0.25, 0.75), kJoined);  // φ = ±π
  EXPECT_EQ(connection(walled(), 2, 7, 0, 1), kApart);       // walls
  EXPECT_EQ(connection(space, 2, 2, 0.25, 0.5), kOutside);
}

TEST(MapTopology, LeavesOpenWhatOnlyUndecidedCellsJoin) {
  const MapSpace space = space_of(true, false);
  const CellMap map = grid(space, 4, [&](double t0, double t1) {
    if (t1 < 0.5 || t1 > 0.57) return CellKind::kTension;
    return std::abs(t0 - 0.5) < 0.1 ? CellKind::kUndecided : CellKind::kInside;
  });
  // Round the other way, over φ = ±π, everything is inside; so cut it there.
  CellMap cut = map;
  cut.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (cell.lower(0) == 0) cut.nodes[node].kind = CellKind::kLength;
  });
  const auto place = [](double t0) {
    MapBox box;
    box.lower = {t0, 0.53, 0};
    box.upper = {t0, 0.53, 1};
    return std::vector{box};
  };
  EXPECT_EQ(MapTopology(map).connection(place(0.2), place(0.8)), MapTopology::Connection::kJoined);
  EXPECT_EQ(MapTopology(cut).connection(place(0.2), place(0.8)), MapTopology::Connection::kOpen);
  EXPECT_EQ(MapTopology(cut).connection(place(0.2), place(0.3)), MapTopology::Connection::kJoined);
}

}  // namespace
}  // namespace taut::testing
