// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

namespace taut {
namespace {

constexpr unsigned kKindBits = 0x0F, kAxisShift = 4, kAxisBits = 0x03, kRegularBit = 0x40, kReasonBit = 0x80;
constexpr unsigned kToleranceKind = 6, kNotJudgedKind = 7, kHalvedKind = 8;
static_assert(kToleranceKind == kCellKinds);
constexpr std::size_t kReasonBytes = 2, kProvedBytes = 8;

/// One node as the bytes tell it.
struct TreeNode {
  unsigned kind = kNotJudgedKind;  ///< of a leaf CellKind, or one of the above
  std::uint8_t axis = 0;
  bool regular = false;
  std::uint16_t reason = 0;
  std::uint64_t proved = 0;
};

/// The lowest byte first.
void append(std::string& bytes, std::uint64_t number, std::size_t size) {
  for (std::size_t n = 0; n < size; ++n) bytes += static_cast<char>((number >> (8 * n)) & 0xFFU);
}

void append(std::string& bytes, const TreeNode& node) {
  unsigned head = node.kind;
  if (node.kind == kHalvedKind) head |= static_cast<unsigned>(node.axis) << kAxisShift;
  if (node.regular) head |= kRegularBit;
  if (node.reason != 0) head |= kReasonBit;
  bytes += static_cast<char>(head);
  if (node.reason != 0) append(bytes, node.reason, kReasonBytes);
  if (node.kind == kNotJudgedKind) append(bytes, node.proved, kProvedBytes);
}

TreeNode node_of(const CellVerdict& verdict, std::optional<std::size_t> axis) {
  TreeNode result;
  result.kind = axis ? kHalvedKind : verdict.is_tolerance ? kToleranceKind : static_cast<unsigned>(verdict.kind);
  result.axis = static_cast<std::uint8_t>(axis.value_or(0));
  result.regular = verdict.regular;
  result.reason = verdict.reason;
  return result;
}

/// Reads a tree node by node, and holds it to what a tree of a cell may be.
class TreeReader {
 public:
  TreeReader(std::string_view bytes, const MapSpace& space, const HalvingRule& rule)
      : bytes_(bytes), axes_(space.size()), rule_(rule) {}

  /// The next node, which is about this cell.
  TreeNode next(const Cell& cell) {
    TreeNode node;
    const std::size_t first = at_;
    const unsigned head = byte();
    node.kind = head & kKindBits;
    node.axis = static_cast<std::uint8_t>((head >> kAxisShift) & kAxisBits);
    node.regular = (head & kRegularBit) != 0;
    if ((head & kReasonBit) != 0) {
      node.reason = static_cast<std::uint16_t>(number(kReasonBytes));
      if (node.reason == 0) refuse(first, "a reason that is 0");
    }
    if (node.kind > kHalvedKind) refuse(first, "a kind that there is not");
    if (node.kind != kHalvedKind && node.axis != 0) refuse(first, "an axis of a cell that is not halved");
    if (node.kind == kNotJudgedKind) {
      node.proved = number(kProvedBytes);
      if (node.regular || node.reason != 0) refuse(first, "a verdict on a cell that is not judged");
    }
    require_halving(first, cell, node);
    return node;
  }

  void finish() const {
    if (at_ != bytes_.size()) refuse(at_, "more than one tree");
  }

 private:
  /// That the cell is halved where it may be, and only there.
  void require_halving(std::size_t at, const Cell& cell, const TreeNode& node) const {
    CellVerdict verdict;
    verdict.axis = node.axis;
    if (node.kind == kHalvedKind) {
      if (node.axis >= axes_) refuse(at, "an axis that the space does not have");
      if (rule_.axis(cell, verdict) != node.axis) refuse(at, "a cell halved below its least width");
    } else if (node.kind == static_cast<unsigned>(CellKind::kUndecided) && rule_.axis(cell, verdict)) {
      refuse(at, "an undecided cell that may be halved");
    }
  }

  std::uint64_t number(std::size_t size) {
    std::uint64_t result = 0;
    for (std::size_t n = 0; n < size; ++n) result |= std::uint64_t{byte()} << (8 * n);
    return result;
  }

  unsigned byte() {
    if (at_ == bytes_.size()) refuse(at_, "the end of the tree before its last leaf");
    return static_cast<unsigned char>(bytes_[at_++]);
  }

  [[noreturn]] void refuse(std::size_t at, const char* what) const {
    throw MalformedTree(fmt::format("byte {} of {}: got {}, expected the tree of a part", at, bytes_.size(), what));
  }

  std::string_view bytes_;
  std::size_t axes_;
  const HalvingRule& rule_;
  std::size_t at_ = 0;
};

/// Copies a tree and judges what is not judged yet.
class Refinement {
 public:
  Refinement(TreeReader reader, const CellProof& proof, const HalvingRule& rule, int halvings)
      : reader_(reader), proof_(proof), rule_(rule), halvings_(halvings) {}

  std::string run(const Cell& cell) {
    copy(cell);
    reader_.finish();
    return std::move(made_);
  }

 private:
  void copy(const Cell& cell) {
    const TreeNode node = reader_.next(cell);
    if (node.kind == kNotJudgedKind) {
      judge(cell, node.proved);
      return;
    }
    append(made_, node);
    if (node.kind != kHalvedKind) return;
    for (unsigned side = 0; side < 2; ++side) copy(cell.half(node.axis, side));
  }

  void judge(const Cell& cell, std::uint64_t proved) {
    if (cell.halvings() >= halvings_) {
      TreeNode leaf;
      leaf.proved = proved;
      append(made_, leaf);
      return;
    }
    const CellVerdict verdict = proof_.judge(cell, proved);
    const std::optional<std::size_t> axis = rule_.axis(cell, verdict);
    append(made_, node_of(verdict, axis));
    if (!axis) return;
    for (unsigned side = 0; side < 2; ++side) judge(cell.half(*axis, side), verdict.proved);
  }

  TreeReader reader_;
  const CellProof& proof_;
  const HalvingRule& rule_;
  int halvings_;
  std::string made_;
};

/// Calls visit(cell, node) for all nodes of a tree in preorder. @returns the volume of its leaves.
template <class Visit>
double walk(TreeReader& reader, const Cell& cell, const Visit& visit) {
  const TreeNode node = reader.next(cell);
  visit(cell, node);
  if (node.kind != kHalvedKind) return cell.volume();
  double volume = 0;
  for (unsigned side = 0; side < 2; ++side) volume += walk(reader, cell.half(node.axis, side), visit);
  return volume;
}

template <class Visit>
void walk_whole(TreeReader reader, const Cell& cell, const Visit& visit) {
  const double volume = walk(reader, cell, visit);
  reader.finish();
  if (volume != cell.volume()) throw std::logic_error("the leaves of a tree do not add up to its cell");
}

/// A verdict as a map's node, whose children are not known yet.
MapNode map_node(const TreeNode& node) {
  MapNode result;
  result.regular = node.regular;
  result.reason = node.reason;
  switch (node.kind) {
    case kHalvedKind: result.axis = node.axis; break;
    case kToleranceKind: result.axis = KnownVerdicts::kTolerance; break;
    case kNotJudgedKind: result.axis = KnownVerdicts::kNotJudged; break;
    default: result.kind = static_cast<CellKind>(node.kind); break;
  }
  return result;
}

/// Puts trees together, the parts' in the place of the leaves of the first that are not judged.
class Assembly {
 public:
  Assembly(const MapSpace& space, const HalvingRule& rule, const std::vector<std::string>& trees)
      : space_(space), rule_(rule), trees_(trees) {}

  KnownVerdicts run(const std::string& top) {
    known_.nodes.emplace_back();
    TreeReader reader(top, space_, rule_);
    const double volume = add(reader, {}, 0, true);
    reader.finish();
    if (next_ != trees_.size() || volume != 1) throw std::logic_error("the parts of a map do not cover its space once");
    return std::move(known_);
  }

 private:
  /// @returns the volume of all leaves that were added.
  double add(TreeReader& reader, const Cell& cell, std::size_t number, bool is_top) {
    const TreeNode node = reader.next(cell);
    if (is_top && node.kind == kNotJudgedKind) {
      TreeReader part(trees_.at(next_++), space_, rule_);
      const double volume = add(part, cell, number, false);
      part.finish();
      return volume;
    }
    known_.nodes[number] = map_node(node);
    if (node.kind != kHalvedKind) return cell.volume();
    const std::size_t child = known_.nodes.size();
    known_.nodes[number].child = static_cast<std::uint32_t>(child);
    known_.nodes.resize(child + 2);
    double volume = 0;
    for (unsigned side = 0; side < 2; ++side) volume += add(reader, cell.half(node.axis, side), child + side, is_top);
    return volume;
  }

  const MapSpace& space_;
  const HalvingRule& rule_;
  const std::vector<std::string>& trees_;
  std::size_t next_ = 0;
  KnownVerdicts known_;
};

void count(TreeExtent& extent, const Cell& cell, const TreeNode& node) {
  const auto level = static_cast<std::size_t>(cell.halvings());
  if (node.kind == kHalvedKind) {
    ++extent.halved.at(level);
  } else if (node.kind == kNotJudgedKind) {
    extent.first_open = std::min(extent.first_open, level);
  } else if (node.kind != kToleranceKind && node.kind != static_cast<unsigned>(CellKind::kUndecided)) {
    extent.decided.at(level) += cell.volume();
  }
}

std::string not_judged(std::uint64_t proved) {
  std::string bytes;
  TreeNode leaf;
  leaf.proved = proved;
  append(bytes, leaf);
  return bytes;
}

}  // namespace

void TreeExtent::add(const TreeExtent& part) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    decided.at(level) += part.decided.at(level);
    halved.at(level) += part.halved.at(level);
  }
  first_open = std::min(first_open, part.first_open);
}

double TreeExtent::undecided(std::size_t level) const {
  return std::accumulate(decided.begin(), decided.begin() + static_cast<std::ptrdiff_t>(level) + 1, 1.0, std::minus());
}

std::size_t TreeExtent::cells(std::size_t level) const {
  return std::accumulate(halved.begin(), halved.begin() + static_cast<std::ptrdiff_t>(level) + 1, std::size_t{1});
}

MapParts::MapParts(const Problem& problem, const MapSpace& space, double least_width)
    : space_(space),
      rule_(space, least_width),
      halvings_(std::clamp(rule_.most_halvings() / 2, kLeastHalvings, kMostHalvings)),
      proof_(make_cell_proof(problem, space)) {
  const std::string nothing = not_judged(0);
  top_ = Refinement(TreeReader(nothing, space_, rule_), *proof_, rule_, halvings_).run({});
  walk_whole(TreeReader(top_, space_, rule_), {}, [&](const Cell& cell, const TreeNode& node) {
    if (node.kind == kNotJudgedKind) {
      cells_.push_back({cell, node.proved});
    } else {
      count(top_extent_, cell, node);
    }
  });
}

std::string MapParts::start(std::size_t part) const { return not_judged(cells_.at(part).proved); }

std::string MapParts::refine(std::size_t part, std::string_view tree, int halvings) const {
  return Refinement(TreeReader(tree, space_, rule_), *proof_, rule_, halvings).run(cells_.at(part).cell);
}

TreeExtent MapParts::extent(std::size_t part, std::string_view tree) const {
  TreeExtent result;
  walk_whole(TreeReader(tree, space_, rule_), cells_.at(part).cell,
             [&](const Cell& cell, const TreeNode& node) { count(result, cell, node); });
  return result;
}

bool MapParts::is_enough(const TreeExtent& all, const SubdivisionOptions& options) {
  if (all.is_complete()) return true;
  if (all.first_open == 0) return false;
  const std::size_t level = all.first_open - 1;
  return all.undecided(level) <= options.undecided_share || all.cells(level) > options.most_cells;
}

CellMap MapParts::assemble(const std::vector<std::string>& trees, const SubdivisionOptions& options) const {
  const KnownVerdicts known = Assembly(space_, rule_, trees).run(top_);
  return subdivide(known, space_, options);
}

}  // namespace taut
