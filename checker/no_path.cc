// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/no_path.h"

#include <fmt/format.h>

#include <algorithm>

#include "checker/parallel.h"

namespace taut::checker {

// ---- Cells without a feasible pose ----------------------------------------------------------------------------------

std::vector<CellForm> parameters(std::span<const CellAxis> axes, std::span<const CellPart> cell) {
  std::vector<CellForm> result;
  for (std::size_t j = 0; j < axes.size(); ++j) {
    const Ball lower = axes[j].lower.evaluate<MeanValueForm>({}).range();
    const Ball extent = axes[j].upper.evaluate<MeanValueForm>({}).range() - lower;
    const mpq_class halves = mpz_class(1) << (cell[j].depth + 1);
    CellForm& x = result.emplace_back(lower + Ball(mpq_class((2 * mpq_class(cell[j].k) + 1) / halves)) * extent);
    x.slope[j] = Ball(mpq_class(1 / halves)) * extent;
  }
  return result;
}

namespace {

/// Ends along an axis, in units of 2^-30 of it: those of all cells are whole numbers.
constexpr std::int64_t kUnit = std::int64_t{1} << CellTree::kMaxDepth;
using Range = std::array<std::int64_t, 2>;
/// A closed box of the space; [0, kUnit] along axes that it does not have.
using CellBox = std::array<Range, kCellAxes>;
constexpr CellBox kWhole = {{{0, kUnit}, {0, kUnit}, {0, kUnit}}};

bool meet(const Range& a, const Range& b) { return a[0] <= b[1] && b[0] <= a[1]; }
bool meet(const CellBox& a, const CellBox& b) { return meet(a[0], b[0]) && meet(a[1], b[1]) && meet(a[2], b[2]); }

std::int64_t floor_to_units(std::int64_t x) {
  const std::int64_t rest = x % kUnit;
  return rest < 0 ? x - rest - kUnit : x - rest;
}
/// Whether two ranges meet modulo kUnit: some multiple of it is in a - b.
bool meet_modulo_unit(const Range& a, const Range& b) { return floor_to_units(a[1] - b[0]) >= a[0] - b[1]; }

CellBox half(CellBox box, std::size_t axis, bool is_upper) {
  const std::int64_t mid = (box[axis][0] + box[axis][1]) / 2;
  box[axis][is_upper ? 0 : 1] = mid;
  return box;
}

/// The parts of a range modulo kUnit within [0, kUnit].
std::vector<Range> wrapped(Range x) {
  if (x[1] - x[0] >= kUnit) return {{0, kUnit}};
  const std::int64_t turns = floor_to_units(x[0]);
  x = {x[0] - turns, x[1] - turns};
  std::vector<Range> parts = {{x[0], std::min(x[1], kUnit)}};
  if (x[1] >= kUnit) parts.push_back({0, x[1] - kUnit});
  return parts;
}

// ---- Which cells share a pose ---------------------------------------------------------------------------------------

/// Poses by the boxes in which their coordinates are; where torsion is free and the tilt is pi, by sigma - 2 phi.
struct Poses {
  CellBox box;
  std::optional<Range> twist;
};

class Flood {
 public:
  Flood(const NoPathCertificate& certificate, const std::function<void()>& before_step)
      : tree_(certificate.tree), axes_(certificate.axes), flip_(certificate.flip), before_step_(before_step) {
    // Children come behind their parents.
    open_.resize(tree_.size());
    for (std::size_t node = tree_.size(); node-- > 0;) {
      open_[node] = tree_.is_leaf(node) ? std::uint32_t{!tree_.is_outside(node)}
                                        : open_[CellTree::lower(node)] + open_[tree_.upper(node)];
    }
  }

  /// Floods from poses: through all cells without a reason that share a pose with them or with a flooded one.
  void run(const CellBox& from) {
    const auto flood = [&](const Poses& poses) { (void)take(poses, 0, kWhole); };
    for_each_image(from, flood);
    for (std::size_t steps = 0; !pending_.empty(); ++steps) {
      constexpr std::size_t kOften = 256;
      if (steps % kOften == 0) before_step_();
      const CellBox box = pending_.back();
      pending_.pop_back();
      for_each_image(box, flood);
    }
  }

  /// Whether some of the poses are in a flooded cell.
  [[nodiscard]] bool has_reached(const CellBox& box) {
    bool result = false;
    for_each_image(box, [&](const Poses& poses) { result = result || is_flooded(poses, 0, kWhole); });
    return result;
  }

 private:
  /// Calls visit with all coordinates of the poses in a box within the space, and perhaps those of more poses.
  template <class Visit>
  void for_each_image(const CellBox& box, const Visit& visit) {
    for_each_turn(box, 0, visit);
    if (!flip_) return;
    const auto [phi, theta, sigma] = *flip_;
    if (box[theta][0] <= 0) {  // the orientation is Rz(sigma), whatever phi is
      CellBox pole = box;
      pole[phi] = {0, kUnit};
      pole[theta] = {0, 0};
      for_each_turn(pole, 0, visit);
    }
    if (box[theta][1] < kUnit) return;
    CellBox pole = box;  // the orientation depends on sigma - 2 phi alone
    pole[theta] = {kUnit, kUnit};
    if (sigma) {
      pole[phi] = pole[*sigma] = {0, kUnit};
      visit(Poses{pole, twist(box)});
      return;
    }
    for (const Range& part : wrapped({box[phi][0] + kUnit / 2, box[phi][1] + kUnit / 2})) {
      pole[phi] = part;
      for_each_turn(pole, 0, visit);
    }
  }

  /// Where a box touches an end of a whole turn, it touches the other.
  template <class Visit>
  void for_each_turn(const CellBox& box, std::size_t axis, const Visit& visit) {
    if (axis == axes_.size() || axis >= kCellAxes) return visit(Poses{box, {}});
    for_each_turn(box, axis + 1, visit);
    if (axes_[axis].kind != CellAxis::Kind::kTurn) return;
    for (const std::size_t end : {0, 1}) {
      if (box[axis][end] != (end == 0 ? 0 : kUnit)) continue;
      CellBox beyond = box;
      beyond[axis].fill(end == 0 ? kUnit : 0);
      for_each_turn(beyond, axis + 1, visit);
    }
  }

  /// sigma - 2 phi, in turns and but for half a turn. @pre sigma is free
  [[nodiscard]] Range twist(const CellBox& box) const {
    const Range &phi = box[flip_->phi], &sigma = box[*flip_->sigma];
    return {sigma[0] - 2 * phi[1], sigma[1] - 2 * phi[0]};
  }
  [[nodiscard]] bool may_share(const Poses& poses, const CellBox& box) const {
    return meet(poses.box, box) && (!poses.twist || meet_modulo_unit(*poses.twist, twist(box)));
  }

  /// Floods the cells below a node. @returns how many of them there are
  std::uint32_t take(const Poses& poses, std::size_t node, const CellBox& box) {
    if (open_[node] == 0 || !may_share(poses, box)) return 0;
    std::uint32_t taken = 1;
    if (tree_.is_leaf(node)) {
      pending_.push_back(box);
    } else {
      const std::size_t axis = tree_.axis(node);
      taken = take(poses, CellTree::lower(node), half(box, axis, false));
      taken += take(poses, tree_.upper(node), half(box, axis, true));
    }
    open_[node] -= taken;
    return taken;
  }

  [[nodiscard]] bool is_flooded(const Poses& poses, std::size_t node, const CellBox& box) const {
    if (!may_share(poses, box)) return false;
    if (tree_.is_leaf(node)) return open_[node] == 0 && !tree_.is_outside(node);
    const std::size_t axis = tree_.axis(node);
    return is_flooded(poses, CellTree::lower(node), half(box, axis, false)) ||
           is_flooded(poses, tree_.upper(node), half(box, axis, true));
  }

  const CellTree& tree_;
  const std::vector<CellAxis>& axes_;
  const std::optional<CellFlip>& flip_;
  const std::function<void()>& before_step_;
  std::vector<std::uint32_t> open_;  ///< of a node: how many leaves below it are neither flooded nor have a reason
  std::vector<CellBox> pending_;     ///< flooded, and not looked around yet
};

// ---- Where a waypoint is --------------------------------------------------------------------------------------------

/// t in units of 2^-30, rounded outward, without regard to turns.
Range place(const CellAxis& axis, const Expression& coordinate, const std::string& name) {
  constexpr int kBits = 256;
  const WorkingPrecision precision(kBits);
  const auto value = [](const Expression& x) { return x.evaluate<MeanValueForm>({}).range(); };
  const Ball lower = value(axis.lower);
  const Ball extent = value(axis.upper) - lower;
  if (!certainly_positive(extent)) throw Rejected("a parameter's range is not shown to have its ends in order");
  const Ball units = (value(coordinate) - lower) / extent * Ball(mpq_class(mpz_class(kUnit)));
  const Ball most(mpq_class(mpz_class(1) << 60U));
  if (!certainly_positive(most - magnitude(units))) throw Rejected(name + ": a coordinate is too large");
  const auto whole = [](const Ball& x, arf_rnd_t rounding) {
    return static_cast<std::int64_t>(arf_get_si(arb_midref(x.get()), rounding));
  };
  Range result = {whole(lowest(units), ARF_RND_FLOOR), whole(highest(units), ARF_RND_CEIL)};
  if (axis.kind != CellAxis::Kind::kRange) return result;
  if (result[1] < 0 || result[0] > kUnit) throw Rejected(name + ": a parameter is not in its range");
  return {std::clamp<std::int64_t>(result[0], 0, kUnit), std::clamp<std::int64_t>(result[1], 0, kUnit)};
}

/// A place along theta within [0, pi], and by how much phi is turned there.
struct Tilt {
  Range theta;
  std::int64_t turned;
};
/// theta in units of pi: whole turns are two of them, and (phi, theta) = (phi + pi, -theta).
std::vector<Tilt> tilts(Range x) {
  if (x[1] - x[0] >= kUnit) return {{{0, kUnit}, 0}, {{0, kUnit}, kUnit / 2}};
  std::int64_t turns = floor_to_units(x[0]);
  if (turns / kUnit % 2 != 0) turns -= kUnit;  // an even number of units
  x = {x[0] - turns, x[1] - turns};            // begins in [0, 2)
  std::vector<Tilt> result;
  for (const std::int64_t n : {0, 2}) {  // theta, less whole turns
    const Range y = {x[0] - n * kUnit, x[1] - n * kUnit};
    if (meet(y, {0, kUnit})) result.push_back({{std::max<std::int64_t>(y[0], 0), std::min(y[1], kUnit)}, 0});
    if (meet(y, {-kUnit, 0})) {
      result.push_back({{std::max<std::int64_t>(-y[1], 0), std::min(-y[0], kUnit)}, kUnit / 2});
    }
  }
  return result;
}

/// Boxes of the space that hold the pose of a waypoint.
std::vector<CellBox> places(const NoPathCertificate& certificate, std::size_t waypoint) {
  const std::vector<Expression>& typed = certificate.problem.query[waypoint];
  std::vector<Range> at;
  for (std::size_t j = 0; j < typed.size(); ++j) {
    at.push_back(place(certificate.axes[j], typed[j], "query waypoint " + std::to_string(waypoint)));
  }
  const auto& flip = certificate.flip;
  std::vector<CellBox> result;
  for (const auto& [theta, turned] : flip ? tilts(at[flip->theta]) : std::vector<Tilt>{{}}) {
    std::vector<CellBox> boxes = {kWhole};
    for (std::size_t j = 0; j < at.size(); ++j) {
      std::vector<Range> parts = {at[j]};
      if (flip && j == flip->theta) {
        parts = {theta};
      } else if (certificate.axes[j].kind == CellAxis::Kind::kTurn) {
        const std::int64_t shift = flip && j == flip->phi ? turned : 0;
        parts = wrapped({at[j][0] + shift, at[j][1] + shift});
      }
      std::vector<CellBox> longer;
      for (CellBox box : boxes) {
        for (const Range& part : parts) {
          box[j] = part;
          longer.push_back(box);
        }
      }
      boxes = std::move(longer);
    }
    result.insert(result.end(), boxes.begin(), boxes.end());
  }
  return result;
}

// ---- The whole ------------------------------------------------------------------------------------------------------

/// A leaf that has a reason.
struct OutsideCell {
  std::size_t node = 0;
  std::array<CellPart, kCellAxes> parts;
  const ContactReason* contact = nullptr;  ///< if that is it
};

/// @param contacts  how many leaves before this node are in contact
void collect(const NoPathCertificate& certificate, const OutsideCell& at, std::size_t& contacts,
             std::vector<OutsideCell>& cells) {
  const CellTree& tree = certificate.tree;
  if (tree.is_leaf(at.node)) {
    if (tree.is_outside(at.node)) cells.push_back(at);
    if (tree.is_contact(at.node)) {
      cells.back().contact = &certificate.contacts.at(certificate.contact_of_leaf.at(contacts++));
    }
    return;
  }
  for (const std::uint32_t side : {0U, 1U}) {
    OutsideCell below = at;
    CellPart& part = below.parts.at(tree.axis(at.node));
    part = {2 * part.k + side, part.depth + 1};
    below.node = side == 0 ? CellTree::lower(at.node) : tree.upper(at.node);
    collect(certificate, below, contacts, cells);
  }
}

void require_outside(const NoPathCertificate& certificate, const StatedMachine& machine, const OutsideCell& cell) {
  const std::string name = fmt::format("the cell at node {}", cell.node);
  try {
    OutsideProof proof(machine, parameters(certificate.axes, cell.parts));
    const bool holds =
        cell.contact != nullptr ? proof.holds(*cell.contact) : proof.holds(certificate.tree.reason(cell.node).value());
    if (!holds) throw Undefined("its reason is not proved");
  } catch (const Undefined& why) {
    throw Rejected("not confirmed: " + name + ": " + why.what());
  }
}

}  // namespace

bool is_parted(const NoPathCertificate& certificate, const std::function<void()>& before_step) {
  Flood flood(certificate, before_step);
  for (const CellBox& box : places(certificate, certificate.from)) flood.run(box);
  return std::ranges::none_of(places(certificate, certificate.from + 1),
                              [&](const CellBox& box) { return flood.has_reached(box); });
}

Theorem::Counts confirm(const NoPathCertificate& certificate, const ConfirmOptions& options) {
  try {
    if (!is_parted(certificate, options.before_box)) throw Rejected("cells without a reason join the two waypoints");
  } catch (const Undefined& why) {
    throw Rejected(std::string("not confirmed: the waypoints: ") + why.what());
  }
  std::vector<OutsideCell> cells;
  std::size_t contacts = 0;
  collect(certificate, {}, contacts, cells);
  std::unique_ptr<StatedMachine> machine;
  const auto prepare = [&] {
    const WorkingPrecision precision(certificate.bits);
    machine = std::make_unique<StatedMachine>(certificate.problem);
  };
  try {
    prepare();
  } catch (const Undefined& why) {
    throw Rejected(std::string("not confirmed: the problem's numbers: ") + why.what());
  }
  for_each(cells.size(), options.threads, [&](std::size_t k) {
    options.before_box();
    const WorkingPrecision precision(certificate.bits);
    require_outside(certificate, *machine, cells[k]);
  });
  return {0, cells.size(), certificate.bits};
}

}  // namespace taut::checker
