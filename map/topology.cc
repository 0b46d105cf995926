// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "certify/arithmetic/mp_interval.h"
#include "map/disjoint_sets.h"
#include "problem/expression.h"

namespace taut {

MapBox box_of(const Cell& cell) {
  MapBox box;
  for (std::size_t k = 0; k < kMaxMapAxes; ++k) {
    box.lower[k] = cell.lower(k);
    box.upper[k] = cell.upper(k);
  }
  return box;
}

// ---- Where a pose is ------------------------------------------------------------------------------------------------

namespace {

using Interval2 = std::array<double, 2>;

/// Places are widened by this much, far more than what is rounded below.
constexpr double kRounding = 1e-14;

/// The parts of [x[0], x[1]] modulo 1 within [0, 1].
std::vector<Interval2> wrapped(Interval2 x) {
  x = {x[0] - kRounding, x[1] + kRounding};
  if (!(x[1] - x[0] < 1)) return {{0, 1}};
  const double turns = std::floor(x[0]);
  x = {x[0] - turns, x[1] - turns};
  std::vector<Interval2> parts = {{std::min(x[0], 1.0), std::min(x[1], 1.0)}};
  if (x[1] >= 1) parts.push_back({0, x[1] - 1});
  return parts;
}

/// λ in t along an axis, enclosed, without regard to turns.
Interval2 enclosed_t(const MapAxis& axis, const ExpressionText& coordinate) {
  constexpr mpfr_prec_t kPrecision = 128;
  const PrecisionScope precision(kPrecision);
  const auto lower = evaluate_constant<MpInterval>(axis.lower);
  const MpInterval t =
      (evaluate_constant<MpInterval>(coordinate) - lower) / (evaluate_constant<MpInterval>(axis.upper) - lower);
  return {lower_bound(t), upper_bound(t)};
}

/// A possible place along θ, and by how much φ is shifted there.
struct Tilt {
  Interval2 t;
  double shift;
};

/// θ/π in [0, 1]: by whole turns, which are 2, and (φ, θ) = (φ + π, −θ).
std::vector<Tilt> tilts(Interval2 t) {
  t = {t[0] - kRounding, t[1] + kRounding};
  if (!(t[1] - t[0] < 1)) return {{{0, 1}, 0}, {{0, 1}, 0.5}};
  const double turns = 2 * std::floor((t[0] + 1) / 2);
  t = {t[0] - turns, t[1] - turns};  // begins in [−1, 1]
  std::vector<Tilt> parts;
  const auto add = [&](double lower, double upper, double shift) {
    if (lower <= upper) parts.push_back({{lower, upper}, shift});
  };
  add(std::max(t[0], 0.0), std::min(t[1], 1.0), 0);
  if (t[0] <= 0) add(std::max(-t[1], 0.0), std::min(-t[0], 1.0), 0.5);
  if (t[1] >= 1) add(std::max(2 - t[1], 0.0), std::min(2 - t[0], 1.0), 0.5);
  return parts;
}

}  // namespace

std::vector<MapBox> place_of(const MapSpace& space, const std::vector<ExpressionText>& coordinates) {
  std::vector<Interval2> t;
  for (std::size_t k = 0; k < space.size(); ++k) t.push_back(enclosed_t(space.axes[k], coordinates.at(k)));
  std::vector<Tilt> tilted = {{{0, 0}, 0}};
  if (space.flip) tilted = tilts(t[space.flip->theta]);
  std::vector<MapBox> result;
  for (const Tilt& tilt : tilted) {
    std::vector<MapBox> boxes(1);
    for (std::size_t k = 0; k < space.size(); ++k) {
      std::vector<Interval2> parts;
      switch (space.axes[k].kind) {
        case MapAxis::Kind::kRange: parts = {{std::clamp(t[k][0], 0.0, 1.0), std::clamp(t[k][1], 0.0, 1.0)}}; break;
        case MapAxis::Kind::kTilt: parts = {tilt.t}; break;
        case MapAxis::Kind::kTurn: {
          const double shift = space.flip && space.flip->phi == k ? tilt.shift : 0;
          parts = wrapped({t[k][0] + shift, t[k][1] + shift});
          break;
        }
      }
      std::vector<MapBox> next;
      for (const MapBox& box : boxes) {
        for (const Interval2& part : parts) {
          next.push_back(box);
          next.back().lower[k] = part[0];
          next.back().upper[k] = part[1];
        }
      }
      boxes = std::move(next);
    }
    result.insert(result.end(), boxes.begin(), boxes.end());
  }
  return result;
}

// ---- Cells that share a pose ----------------------------------------------------------------------------------------

namespace {

bool meet(double a_lower, double a_upper, double b_lower, double b_upper) {
  return a_lower <= b_upper && b_lower <= a_upper;
}

/// Whether closed intervals meet modulo 1. Exact for dyadic ends.
bool meet_modulo_1(const Interval2& a, const Interval2& b) {
  // Some integer n has a − b ∋ n.
  return std::ceil(a[0] - b[1]) <= a[1] - b[0];
}

/// σ − 2φ in turns, over a box.
Interval2 twist(const MapBox& box, const MapSpace::Flip& flip) {
  return {box.lower[*flip.sigma] - 2 * box.upper[flip.phi], box.upper[*flip.sigma] - 2 * box.lower[flip.phi]};
}

/// Finds leaves that share a pose with a box.
class Neighbourhood {
 public:
  Neighbourhood(const CellMap& map, std::vector<std::uint32_t>& found) : map_(map), found_(found) {}

  /// Those that meet the box, as it is and across whole turns.
  void add_around(const MapBox& box, std::size_t axis = 0) {
    if (axis == map_.space.size() || axis >= kMaxMapAxes) {
      add([&](const MapBox& other) { return meets(box, other); }, MapBox(), 0);
      return;
    }
    add_around(box, axis + 1);
    if (map_.space.axes[axis].kind != MapAxis::Kind::kTurn) return;
    for (const double end : {0.0, 1.0}) {
      if ((end == 0 ? box.lower : box.upper)[axis] != end) continue;
      MapBox beyond = box;
      beyond.lower[axis] = beyond.upper[axis] = 1 - end;
      add_around(beyond, axis + 1);
    }
  }

  /// Those that share a pose of θ = 0, where (φ, θ) flip: φ is anything there.
  void add_at_zero(const MapBox& box) {
    const MapSpace::Flip& flip = *map_.space.flip;
    if (box.lower[flip.theta] > 0) return;
    MapBox pole = box;
    pole.lower[flip.phi] = 0;
    pole.upper[flip.phi] = 1;
    pole.lower[flip.theta] = pole.upper[flip.theta] = 0;
    add_around(pole);
  }

  /// Those that share a pose of θ = π where σ is fixed: half a turn of φ away.
  void add_opposite(const MapBox& box) {
    const MapSpace::Flip& flip = *map_.space.flip;
    if (box.upper[flip.theta] < 1) return;
    MapBox pole = box;
    pole.lower[flip.theta] = pole.upper[flip.theta] = 1;
    pole.lower[flip.phi] += 0.5;
    pole.upper[flip.phi] += 0.5;
    for (const double turn : {0.0, 1.0}) {
      MapBox part = pole;
      part.lower[flip.phi] = std::max(0.0, pole.lower[flip.phi] - turn);
      part.upper[flip.phi] = std::min(1.0, pole.upper[flip.phi] - turn);
      if (part.lower[flip.phi] <= part.upper[flip.phi]) add_around(part);
    }
  }

  /// Those that share a pose of θ = π where σ is free: they share σ − 2φ.
  void add_of_twist(const MapBox& box) {
    const MapSpace::Flip& flip = *map_.space.flip;
    if (box.upper[flip.theta] < 1) return;
    MapBox pole = box;
    pole.lower[flip.theta] = pole.upper[flip.theta] = 1;
    const Interval2 sought = twist(pole, flip);
    pole.lower[flip.phi] = pole.lower[*flip.sigma] = 0;
    pole.upper[flip.phi] = pole.upper[*flip.sigma] = 1;
    add([&](const MapBox& other) { return meets(pole, other) && meet_modulo_1(sought, twist(other, flip)); }, MapBox(),
        0);
  }

 private:
  bool meets(const MapBox& a, const MapBox& b) const {
    for (std::size_t k = 0; k < map_.space.size(); ++k) {
      if (!meet(a.lower[k], a.upper[k], b.lower[k], b.upper[k])) return false;
    }
    return true;
  }

  /// Leaves below a node for which `is_met` holds, which is true of a box wherever it is of a part of it.
  template <class Test>
  void add(const Test& is_met, const MapBox& box, std::uint32_t node) {
    if (!is_met(box)) return;
    const MapNode& here = map_.nodes[node];
    if (here.axis == MapNode::kLeaf) {
      found_.push_back(node);
      return;
    }
    const double mid = 0.5 * (box.lower[here.axis] + box.upper[here.axis]);  // exact
    MapBox half = box;
    half.upper[here.axis] = mid;
    add(is_met, half, here.child);
    half.upper[here.axis] = box.upper[here.axis];
    half.lower[here.axis] = mid;
    add(is_met, half, here.child + 1);
  }

  const CellMap& map_;
  std::vector<std::uint32_t>& found_;
};

/// Joins leaves that share a point of the coordinates, where the ends of a turn are one. It goes down the tree in pairs
/// of nodes that touch, so that leaves need not be sought from the root each by itself.
template <class Join>
class Contacts {
 public:
  /// Calls join(a, b) for each two leaves, neither of which is outside. Refers to its arguments.
  Contacts(const CellMap& map, const Join& join) : map_(map), join_(join), is_possible_(map.nodes.size()) {
    for (std::size_t node = map.nodes.size(); node-- > 0;) {  // a node's halves come after it
      const MapNode& here = map.nodes[node];
      is_possible_[node] = here.axis == MapNode::kLeaf ? !is_outside(here.kind)
                                                       : is_possible_[here.child] || is_possible_[here.child + 1];
    }
  }

  void run() const {
    const Place whole{0, 0, MapBox()};
    join_within(whole);
    join_across_turns(whole, whole, 0, false);
  }

 private:
  struct Place {
    std::uint32_t node;
    int halvings;
    MapBox box;
  };

  [[nodiscard]] bool is_leaf(const Place& place) const { return map_.nodes[place.node].axis == MapNode::kLeaf; }

  /// The halves of a node that is no leaf.
  [[nodiscard]] std::array<Place, 2> halves(const Place& place) const {
    const MapNode& here = map_.nodes[place.node];
    const double mid = 0.5 * (place.box.lower[here.axis] + place.box.upper[here.axis]);  // exact
    std::array<Place, 2> result = {place, place};
    for (unsigned side = 0; side < 2; ++side) {
      result[side].node = here.child + side;
      ++result[side].halvings;
      (side == 0 ? result[side].box.upper : result[side].box.lower)[here.axis] = mid;
    }
    return result;
  }

  void join_within(const Place& place) const {
    if (!is_possible_[place.node] || is_leaf(place)) return;
    const auto [lower, upper] = halves(place);
    join_within(lower);
    join_within(upper);
    join_between(lower, upper);
  }

  /// @pre the boxes meet
  void join_between(const Place& a, const Place& b) const {
    if (!is_possible_[a.node] || !is_possible_[b.node]) return;
    if (is_leaf(a) && is_leaf(b)) return join_(a.node, b.node);
    if (is_leaf(a) || (!is_leaf(b) && b.halvings < a.halvings)) return join_between(b, a);
    const std::size_t axis = map_.nodes[a.node].axis;
    const auto [lower, upper] = halves(a);
    if (b.box.lower[axis] <= lower.box.upper[axis]) join_between(lower, b);
    if (upper.box.lower[axis] <= b.box.upper[axis]) join_between(upper, b);
  }

  /// Joins what meets `whole`, moved by a turn to either side or by none, along this axis and those after it.
  void join_across_turns(const Place& whole, const Place& moved, std::size_t axis, bool is_moved) const {
    if (axis == map_.space.size()) {
      if (is_moved) join_between(whole, moved);
      return;
    }
    join_across_turns(whole, moved, axis + 1, is_moved);
    if (axis >= kMaxMapAxes || map_.space.axes[axis].kind != MapAxis::Kind::kTurn) return;  // for the compiler
    for (const double turn : {1.0, -1.0}) {
      if (turn < 0 && !is_moved) continue;  // the same pairs, the other way round
      Place next = moved;
      next.box.lower[axis] += turn;
      next.box.upper[axis] += turn;
      join_across_turns(whole, next, axis + 1, true);
    }
  }

  const CellMap& map_;
  const Join& join_;
  std::vector<bool> is_possible_;  ///< by node: whether a leaf of it is not outside
};

/// Leaves at a pole, each with what tells its poses there: σ − 2φ on θ = π, and on θ = 0 the coordinate besides φ and
/// θ. There are so many that to look at each pair would take most of the time of a map of three coordinates.
class Pole {
 public:
  explicit Pole(bool is_circle) : is_circle_(is_circle) {}

  void add(std::uint32_t node, Interval2 at) {
    if (!is_circle_) {
      leaves_.push_back({node, at});
      return;
    }
    const double turns = std::floor(at[0]);
    at = at[1] - at[0] < 1 ? Interval2{at[0] - turns, at[1] - turns} : Interval2{0, 1};  // exact for dyadic ends
    leaves_.push_back({node, at});
    if (at[1] >= 1) leaves_.push_back({node, {at[0] - 1, at[1] - 1}});
  }

  /// Joins all that share a pose. In the order in which intervals begin, one that begins no later than some earlier one
  /// ends shares its begin with that one.
  void join(DisjointSets& sets) {
    std::ranges::sort(leaves_, {}, [](const Leaf& leaf) { return leaf.at[0]; });
    std::uint32_t last = 0;
    double end = -std::numeric_limits<double>::infinity();
    for (const Leaf& leaf : leaves_) {
      if (leaf.at[0] <= end) sets.join(last, leaf.node);
      last = leaf.node;
      end = std::max(end, leaf.at[1]);
    }
  }

 private:
  struct Leaf {
    std::uint32_t node;
    Interval2 at;
  };
  bool is_circle_;
  std::vector<Leaf> leaves_;
};

/// Both poles of a space where (φ, θ) flip.
class Poles {
 public:
  explicit Poles(const MapSpace& space)
      : flip_(*space.flip),
        other_(kMaxMapAxes - flip_.phi - flip_.theta),
        zero_(space.size() == kMaxMapAxes && space.axes[other_].kind == MapAxis::Kind::kTurn),
        pi_(true) {}

  void add(std::uint32_t node, const MapBox& box) {
    if (box.lower[flip_.theta] <= 0) zero_.add(node, {box.lower[other_], box.upper[other_]});
    if (flip_.sigma && box.upper[flip_.theta] >= 1) pi_.add(node, twist(box, flip_));
  }
  void join(DisjointSets& sets) {
    zero_.join(sets);
    pi_.join(sets);
  }

 private:
  static_assert(kMaxMapAxes == 3, "besides phi and theta there is one coordinate, of number 3 - phi - theta");
  MapSpace::Flip flip_;
  std::size_t other_;  ///< in a space of two coordinates one that all boxes have all of
  Pole zero_, pi_;
};

/// Numbers the components of the leaves that `is_member` names, the largest first; of equal ones, that with the least
/// node. Only such leaves are joined in `sets`.
template <class IsMember>
std::vector<MapComponent> number(const CellMap& map, DisjointSets& sets, const IsMember& is_member,
                                 std::vector<std::uint32_t>& component_of) {
  struct Found {
    std::uint32_t root;
    MapComponent component;
  };
  std::vector<Found> found;
  component_of.assign(map.nodes.size(), MapTopology::kNone);
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (!is_member(map.nodes[node].kind)) return;
    const std::uint32_t root = sets.find(node);
    if (component_of[root] == MapTopology::kNone) {
      component_of[root] = static_cast<std::uint32_t>(found.size());
      found.push_back({root, {}});
    }
    component_of[node] = component_of[root];
    MapComponent& component = found[component_of[root]].component;
    component.volume += cell.volume();
    ++component.cells;
  });
  std::vector<std::uint32_t> order(found.size()), number_of(found.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const double difference = found[a].component.volume - found[b].component.volume;
    return difference != 0 ? difference > 0 : found[a].root < found[b].root;
  });
  std::vector<MapComponent> result;
  for (const std::uint32_t n : order) {
    number_of[n] = static_cast<std::uint32_t>(result.size());
    result.push_back(found[n].component);
  }
  for (std::uint32_t& n : component_of) n = n == MapTopology::kNone ? n : number_of[n];
  return result;
}

/// Joins leaves that share a pose where (φ, θ) flip.
template <class Join>
void join_at_poles(const CellMap& map, DisjointSets& inside, DisjointSets& possible, const Join& join) {
  Poles inside_poles(map.space), possible_poles(map.space);
  std::vector<std::uint32_t> found;
  Neighbourhood around(map, found);
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    const CellKind kind = map.nodes[node].kind;
    if (is_outside(kind)) return;
    const MapBox box = box_of(cell);
    possible_poles.add(node, box);
    if (kind == CellKind::kInside) inside_poles.add(node, box);
    if (map.space.flip->sigma) return;
    found.clear();
    around.add_opposite(box);
    for (const std::uint32_t other : found) {
      if (!is_outside(map.nodes[other].kind)) join(node, other);
    }
  });
  inside_poles.join(inside);
  possible_poles.join(possible);
}

}  // namespace

MapTopology::MapTopology(const CellMap& map) : map_(map) {
  DisjointSets inside(map.nodes.size()), possible(map.nodes.size());
  const auto is_inside = [&](std::uint32_t node) { return map.nodes[node].kind == CellKind::kInside; };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    possible.join(a, b);
    if (is_inside(a) && is_inside(b)) inside.join(a, b);
  };
  Contacts(map, join).run();
  if (map.space.flip) join_at_poles(map, inside, possible, join);
  inside_ = number(
      map, inside, [](CellKind kind) { return kind == CellKind::kInside; }, inside_of_);
  possible_ = number(
      map, possible, [](CellKind kind) { return !is_outside(kind); }, possible_of_);
}

std::vector<std::uint32_t> neighbours(const CellMap& map, const Cell& cell) {
  std::vector<std::uint32_t> found;
  Neighbourhood around(map, found);
  const MapBox box = box_of(cell);
  around.add_around(box);
  if (map.space.flip) {
    around.add_at_zero(box);
    map.space.flip->sigma ? around.add_of_twist(box) : around.add_opposite(box);
  }
  return found;
}

std::vector<std::uint32_t> leaves_at(const CellMap& map, const std::vector<MapBox>& place) {
  std::vector<std::uint32_t> found;
  Neighbourhood around(map, found);
  for (const MapBox& box : place) around.add_around(box);
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  return found;
}

auto MapTopology::connection(const std::vector<MapBox>& from, const std::vector<MapBox>& to) const -> Connection {
  const auto first = leaves_at(from), second = leaves_at(to);
  // A place is in one of its leaves, and which one is not known: what is certain holds for all of them.
  const auto is_possible = [&](std::uint32_t node) { return possible_of_[node] != kNone; };
  if (std::ranges::none_of(first, is_possible) || std::ranges::none_of(second, is_possible)) {
    return Connection::kOutside;
  }
  const std::uint32_t component = inside_of_[first.front()];
  const auto is_in_it = [&](std::uint32_t node) { return inside_of_[node] == component; };
  if (component != kNone && std::ranges::all_of(first, is_in_it) && std::ranges::all_of(second, is_in_it)) {
    return Connection::kJoined;
  }
  for (const std::uint32_t a : first) {
    for (const std::uint32_t b : second) {
      if (is_possible(a) && possible_of_[a] == possible_of_[b]) return Connection::kOpen;
    }
  }
  return Connection::kApart;
}

}  // namespace taut
