// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/no_path.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <map>

#include "app/as_items.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "certificate/no_path.h"
#include "kinematics/margin.h"
#include "reports/page/map_axis.h"
#include "reports/summary/display_units.h"
#include "reports/summary/illustration.h"

namespace taut {
namespace {

using checker::OutsideReason;

/// The kernel's reason that is closest to the prover's.
FirstReason first_reason(const MapNode& leaf) {
  using Kind = OutsideReason::Kind;
  if (leaf.kind == CellKind::kContact) return {{}, leaf.reason};
  if (leaf.kind == CellKind::kUnbalanced) {
    return {{Kind::kFixed, static_cast<std::size_t>(leaf.reason / 2), leaf.reason % 2 == 0 ? std::size_t{1} : 0}};
  }
  const MarginId margin = all_margins().at(leaf.reason);
  const bool is_most = margin.kind == MarginKind::kTensionMax || margin.kind == MarginKind::kLengthMax;
  const Kind kind = leaf.kind == CellKind::kLength ? Kind::kLength : Kind::kFollowing;
  return {{kind, static_cast<std::size_t>(margin.cable), is_most ? std::size_t{1} : 0}};
}

/// Makes the certificate's tree of a map: reasons have the outside cells next to all that hangs together with one of
/// two places.
class Wall {
 public:
  Wall(const Problem& problem, CellMap map, std::vector<MapBox> from, std::vector<MapBox> to)
      : outside_(problem), map_(std::move(map)), places_{widened(std::move(from)), widened(std::move(to))} {}

  /// Empty where the kernel does not prove enough of the cells.
  OutsidePart cells() {
    constexpr int kMostRounds = 8;
    for (int round = 0; round < kMostRounds; ++round) {
      const auto first = cells_around(places_[0], places_[1]), second = cells_around(places_[1], places_[0]);
      if (!first || !second) return {};
      if (prove(first->size() <= second->size() ? *first : *second)) return part(0);
    }
    return {};
  }

 private:
  struct Leaf {
    Cell cell;
    std::uint32_t node = 0;
  };

  static std::vector<MapBox> widened(std::vector<MapBox> place) {
    constexpr double kRounding = 1e-8;  // more than the checker's 2^-30
    for (MapBox& box : place) {
      for (std::size_t k = 0; k < kMaxMapAxes; ++k) {
        box.lower[k] = std::max(0.0, box.lower[k] - kRounding);
        box.upper[k] = std::min(1.0, box.upper[k] + kRounding);
      }
    }
    return place;
  }

  /// The outside cells next to all that hangs together with a place; nothing if the other place is there, too.
  [[nodiscard]] std::optional<std::vector<Leaf>> cells_around(const std::vector<MapBox>& place,
                                                              const std::vector<MapBox>& other) const {
    const std::vector<bool> reached = reached_leaves(map_, place);
    for (const std::uint32_t leaf : leaves_at(map_, other)) {
      if (reached[leaf]) return std::nullopt;
    }
    std::vector<bool> is_wall(map_.nodes.size(), false);
    const auto add = [&](const std::vector<std::uint32_t>& leaves) {
      for (const std::uint32_t leaf : leaves) is_wall[leaf] = is_outside(map_.nodes[leaf].kind);
    };
    add(leaves_at(map_, place));  // a waypoint may be in outside cells alone
    map_.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
      if (reached[node]) add(neighbours(map_, cell));
    });
    std::vector<Leaf> wall;
    map_.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
      if (is_wall[node]) wall.push_back({cell, node});
    });
    return wall;
  }

  /// Those that the kernel does not prove are undecided from then on. @returns whether it proves all
  bool prove(const std::vector<Leaf>& wall) {
    std::vector<OutsidePart> parts_of_wall(wall.size());
    tbb::parallel_for(std::size_t{0}, wall.size(), [&](std::size_t n) {
      const auto& [cell, node] = wall[n];
      if (const auto known = proved_.find(node); known != proved_.end()) {
        parts_of_wall[n] = known->second;
        return;
      }
      std::vector<checker::CellPart> parts;
      for (std::size_t k = 0; k < map_.space.size(); ++k) parts.push_back({cell.k[k], cell.depth[k]});
      parts_of_wall[n] = outside_.tree(parts, first_reason(map_.nodes[node]));
    });
    bool is_whole = true;
    for (std::size_t n = 0; n < wall.size(); ++n) {
      if (parts_of_wall[n].tree.empty()) {
        map_.nodes[wall[n].node].kind = CellKind::kUndecided;
        is_whole = false;
      } else {
        proved_[wall[n].node] = std::move(parts_of_wall[n]);
      }
    }
    return is_whole;
  }

  [[nodiscard]] OutsidePart part(std::uint32_t node) const {
    const OutsidePart open{std::string(1, checker::kOpenLeaf), {}};
    const MapNode& here = map_.nodes[node];
    if (here.axis == MapNode::kLeaf) {
      const auto found = proved_.find(node);
      return found == proved_.end() ? open : found->second;
    }
    OutsidePart lower = part(here.child), upper = part(here.child + 1);
    if (lower.tree == open.tree && upper.tree == open.tree) return open;
    lower.tree = static_cast<char>('0' + here.axis) + lower.tree + upper.tree;
    std::ranges::move(upper.contacts, std::back_inserter(lower.contacts));
    return lower;
  }

  OutsideCells outside_;
  CellMap map_;
  std::array<std::vector<MapBox>, 2> places_;
  std::map<std::uint32_t, OutsidePart> proved_;  ///< parts of the tree, by node
};

}  // namespace

std::string describe_open(const Case& the_case, const NoPathAttempt& attempt) {
  using Answer = NoPathAttempt::Answer;
  if (attempt.answer == Answer::kUnsupported) return "Whether no path exists was not tried: " + attempt.why + ".";
  const std::string tried =
      fmt::format("A map of {} was tried for {:.2g} s", plural(attempt.cells, "cell"), attempt.seconds);
  if (attempt.answer == Answer::kJoined) {
    return tried +
           ": the machine without deviations can go from each waypoint to the next. So a path exists for it, "
           "and a finer search may find one.";
  }
  if (attempt.answer == Answer::kApart || !attempt.open) return tried + ".";
  const Separation& open = *attempt.open;
  std::string place;
  const std::vector<ShownAxis> axes = shown_axes(the_case.problem.space, *attempt.space, DisplayUnits(the_case.units));
  for (std::size_t k = 0; open.gap && k < axes.size(); ++k) {
    const ShownAxis& axis = axes[k];
    place += fmt::format("{}{} = {} (± {})", k == 0 ? "" : ", ", axis.name, value_text(axis, axis.at(open.gap->at[k])),
                         value_text(axis, open.gap->half_width[k] * (axis.upper - axis.lower)));
  }
  return fmt::format(
      "{}, and did not show whether a path exists from waypoint {} of the query to {}: {:.3g} % of the "
      "space is undecided around the part that waypoint {} is in{}.",
      tried, attempt.from, attempt.from + 1, 100 * open.open_share, attempt.from,
      open.gap ? fmt::format(", and a way might lead through {}, the middle one at {}",
                             plural(open.gap->cells, "undecided cell"), place)
               : "");
}

NoPathAttempt seek_no_path(const Case& the_case, const SeparationOptions& options, const SigningKey* key) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const Problem& problem = the_case.problem;
  NoPathAttempt result;
  try {
    require_no_meshes(problem);
    result.space = make_map_space(problem.space);
  } catch (const FieldError& error) {
    result.why = error.what();
    return result;
  }
  result.answer = NoPathAttempt::Answer::kJoined;
  for (std::size_t from = 0; from + 1 < problem.query.size(); ++from) {
    SeparationOptions left = options;
    left.seconds = (options.seconds - seconds()) / static_cast<double>(problem.query.size() - 1 - from);
    Separation found = separate(problem, *result.space, problem.query[from], problem.query[from + 1], left);
    result.cells += found.map.leaves();
    if (found.answer == Separation::Answer::kApart) {
      Wall wall(problem, found.map, place_of(*result.space, problem.query[from]),
                place_of(*result.space, problem.query[from + 1]));
      NoPath no_path{from, wall.cells(), {}};
      no_path.illustration = {{"kind", "no path"}};
      add_stated(no_path.illustration, the_case);
      if (!no_path.cells.tree.empty()) {
        result.answer = NoPathAttempt::Answer::kApart;
        result.from = from;
        result.certificate = certificate_text(problem, no_path, key);
        result.open.reset();
        break;
      }
      found.answer = Separation::Answer::kOpen;
    }
    if (found.answer == Separation::Answer::kOpen && result.answer != NoPathAttempt::Answer::kOpen) {
      result.answer = NoPathAttempt::Answer::kOpen;
      result.from = from;
      result.open = std::move(found);
    }
  }
  result.seconds = seconds();
  return result;
}

}  // namespace taut
