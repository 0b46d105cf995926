// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/mesh_clearance.h"

#include <algorithm>

namespace taut::checker {
namespace {

/// Every number from a to b.
Ball between(double a, double b) { return hull(Ball(a), Ball(b)); }

/// A box of a mesh's tree, an element, or all of a body that is no mesh.
struct MeshPiece {
  const Surface* surface = nullptr;
  std::uint32_t index = 0;
  bool is_element = false;
  std::vector<Vector3<Ball>> places;  ///< what contains its points: of a node one box, of an element each of its points
  std::vector<Ball> shifts;           ///< by how much these may move
  mutable std::vector<std::optional<Ball>> extremes{};  ///< along each vector, once it was asked for

  [[nodiscard]] bool may_open() const { return surface != nullptr && !is_element; }
};

class MarginSearch {
 public:
  MarginSearch(const PlacedSurface* first, const PlacedSurface* second, std::span<const BothAlong> along,
               const MeshShift& shift, const Ball& needed, const std::optional<Ball>& enough)
      : first_(first), second_(second), along_(along), shift_(shift), needed_(needed), enough_(enough) {
    moves_ = first != nullptr && !(shift.position.is_zero() && shift.turn.is_zero());
    if (first != nullptr && second != nullptr) scale_ = ratio(second->unit, first->unit);
  }

  Ball run() {
    const MeshPiece a = first_ == nullptr ? MeshPiece{} : node(first_->surface.get(), 0, true);
    const MeshPiece b = second_ == nullptr ? MeshPiece{} : node(second_->surface.get(), 0, false);
    descend(a, b, evaluate(a, b));
    return result_.value();
  }

 private:
  static double ratio(const Ball& a, const Ball& b) {
    return arf_get_d(arb_midref((a / b).get()), ARF_RND_NEAR);  // decides what is opened first, and nothing else
  }

  [[nodiscard]] MeshPiece node(const Surface* surface, std::uint32_t index, bool is_first) const {
    const Surface::Node& box = surface->nodes()[index];
    MeshPiece piece{surface, index, false, {}, {}};
    piece.places.push_back({between(box.lower[0], box.upper[0]), between(box.lower[1], box.upper[1]),
                            between(box.lower[2], box.upper[2])});
    add_shifts(piece, is_first);
    return piece;
  }
  [[nodiscard]] MeshPiece element(const Surface* surface, std::uint32_t index, bool is_first) const {
    MeshPiece piece{surface, index, true, {}, {}};
    for (const Surface::Point& x : surface->corners(index)) {
      piece.places.push_back({Ball(x[0]), Ball(x[1]), Ball(x[2])});
    }
    add_shifts(piece, is_first);
    return piece;
  }
  void add_shifts(MeshPiece& piece, bool is_first) const {
    if (!is_first || !moves_) return;
    for (const Vector3<Ball>& f : piece.places) {
      const Ball lever = length_bound(first_->at + multiply(first_->R, first_->unit * f)).ball();
      piece.shifts.push_back(shift_.position + shift_.turn * lever);
    }
  }

  /// The least of a piece of the first body along vector k, or the largest of one of the second; one number.
  [[nodiscard]] const Ball& extreme(std::size_t k, const MeshPiece& piece, bool is_first) const {
    const SideAlong& along = along_[k][is_first ? 0 : 1];
    if (along.extreme) return *along.extreme;
    piece.extremes.resize(along_.size());
    std::optional<Ball>& known = piece.extremes[k];
    if (!known) known = compute_extreme(along, piece, is_first);
    return *known;
  }
  [[nodiscard]] static Ball compute_extreme(const SideAlong& along, const MeshPiece& piece, bool is_least) {
    std::optional<Ball> result;
    for (std::size_t k = 0; k < piece.places.size(); ++k) {
      const Vector3<Ball>& f = piece.places[k];
      Ball here = (along.constant + f[0] * along.by[0] + f[1] * along.by[1] + f[2] * along.by[2]).range();
      if (!piece.shifts.empty()) here = plus_minus(here, piece.shifts[k]);
      const Ball end = is_least ? lowest(here) : highest(here);
      result = !result ? end : is_least ? smaller(*result, end) : larger(*result, end);
    }
    return result.value();
  }

  /// What the vectors prove of two pieces, or as much as is asked for.
  Ball evaluate(const MeshPiece& a, const MeshPiece& b) {
    constexpr std::size_t kMost = 4'000'000;
    std::optional<Ball> best;
    for (std::size_t k = 0; k < along_.size(); ++k) {
      if (++evaluated_ > kMost) throw Undefined("the elements of meshes are not told apart within 4000000 steps");
      const Ball here = lowest(extreme(k, a, true) - extreme(k, b, false) - needed_);
      best = best ? larger(*best, here) : here;
      if (enough_ ? is_enough(*best) : least_ && certainly_nonnegative(*best - *least_)) break;
    }
    if (!best) throw Undefined("no direction is stated for a pair of bodies");
    return *best;
  }

  /// Whether pieces of such a margin need not be opened.
  [[nodiscard]] bool is_enough(const Ball& margin) const {
    if (enough_) return certainly_nonnegative(margin - *enough_);
    return least_ && certainly_nonnegative(margin - nearly_ * *least_);
  }
  /// Whether what is known is not what is asked for, so that nothing more matters.
  [[nodiscard]] bool is_lost() const {
    if (!result_) return false;
    return !certainly_positive(*result_) || (enough_ && certainly_negative(*result_ - *enough_));
  }

  /// Accounts for two pieces, of which `margin` is known.
  void descend(const MeshPiece& a, const MeshPiece& b, const Ball& margin) {
    const bool are_last = !a.may_open() && !b.may_open();
    if (are_last) least_ = least_ ? smaller(*least_, margin) : margin;
    if (are_last || is_lost() || is_enough(margin)) {
      result_ = result_ ? smaller(*result_, margin) : margin;
      return;
    }
    const bool opens_a = a.may_open() && (!b.may_open() || size(a) >= scale_ * size(b));
    std::vector<std::pair<MeshPiece, Ball>> parts;
    for (MeshPiece& part : open(opens_a ? a : b, opens_a)) {
      Ball of_part = opens_a ? evaluate(part, b) : evaluate(a, part);
      parts.emplace_back(std::move(part), std::move(of_part));
    }
    // The nearest first: what it shows saves looking into others.
    std::ranges::stable_sort(parts, [](const auto& x, const auto& y) {
      return arf_cmp(arb_midref(x.second.get()), arb_midref(y.second.get())) < 0;
    });
    for (const auto& [part, of_part] : parts) {
      opens_a ? descend(part, b, of_part) : descend(a, part, of_part);
    }
  }

  [[nodiscard]] std::vector<MeshPiece> open(const MeshPiece& piece, bool is_first) const {
    const Surface::Node& box = piece.surface->nodes()[piece.index];
    std::vector<MeshPiece> parts;
    if (box.children[0] != 0) {
      for (const std::uint32_t child : box.children) parts.push_back(node(piece.surface, child, is_first));
      return parts;
    }
    for (std::uint32_t k = box.begin; k < box.end; ++k) {
      parts.push_back(element(piece.surface, piece.surface->in_order(k), is_first));
    }
    return parts;
  }

  static double size(const MeshPiece& piece) {
    const Surface::Node& box = piece.surface->nodes()[piece.index];
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += box.upper[c] - box.lower[c];
    return sum;
  }

  const PlacedSurface* first_;
  const PlacedSurface* second_;
  std::span<const BothAlong> along_;
  const MeshShift& shift_;
  const Ball& needed_;
  const std::optional<Ball>& enough_;
  bool moves_ = false;
  double scale_ = 1;
  std::size_t evaluated_ = 0;
  const Ball nearly_{mpq_class(99, 100)};  ///< nothing is opened for a hundredth more
  std::optional<Ball> least_;              ///< of the elements that were looked at
  std::optional<Ball> result_;             ///< of all that is accounted for
};

}  // namespace

SideAlong along(const PlacedSurface& mesh, const MeanValueForm& origin, const Vector3<MeanValueForm>& u) {
  SideAlong result;
  result.constant = origin + dot(mesh.at, u);
  const Vector3<MeanValueForm> turned = multiply(transposed(mesh.R), u);
  for (std::size_t c = 0; c < 3; ++c) result.by[c] = mesh.unit * turned[c];
  return result;
}

Ball mesh_margin(const PlacedSurface* first, const PlacedSurface* second, std::span<const BothAlong> along,
                 const MeshShift& shift, const Ball& needed, const std::optional<Ball>& enough) {
  return MarginSearch(first, second, along, shift, needed, enough).run();
}

}  // namespace taut::checker
