// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of bodies of which one is a mesh, or both (docs/theory.md, "Meshes").
//
// Along a direction u of W, a point f of a mesh on the platform, in the file's unit, is at
//   u·p + (Rᵀu)·at + unit (turnᵀ Rᵀ u)·f,
// which is linear in f; one that stands still is at u·at + unit (turnᵀ u)·f. So its range over a box of f is known from
// four numbers for each direction.
#include <array>

#include "certify/bodies/body_gaps_detail.h"
#include "certify/bodies/mesh_cover.h"

namespace taut {

using namespace body_gaps_detail;

/// Gaps between parts of two bodies, along some directions.
template <class I, class Slope>
class BodyGaps<I, Slope>::MeshGaps {
 public:
  MeshGaps(const BodyGaps& gaps, const CheckedPair<I>& pair, std::span<const Direction> directions, Where where)
      : gaps_(gaps), pair_(pair), where_(where), first_(gaps.mesh(pair, true)), second_(gaps.mesh(pair, false)) {
    needed_ = pair.clearance;
    if (first_ == nullptr) needed_ = needed_ + gaps.box_.bodies.cable_radius[pair.first];
    for (const Direction& direction : directions) add(direction);
  }

  [[nodiscard]] double least() const {
    constexpr double kEnough = std::numeric_limits<double>::min();
    const auto root = [](const PlacedMesh<I>* mesh) { return MeshPart{mesh == nullptr ? nullptr : mesh->mesh.get()}; };
    const auto gap = [&](std::size_t k, std::span<const MeshBox> a, std::span<const MeshBox> b) {
      return lower_bound(I(first_of(sides_[k], a) - second_of(sides_[k], b) - needed_));
    };
    constexpr double kShare = 0.9;  // of the bound: only its sign matters much
    CoverOptions options{.enough = kEnough, .share = kShare, .floor = 0};
    if (first_ != nullptr && second_ != nullptr) {
      options.scale = lower_bound(second_->unit) / lower_bound(first_->unit);
    }
    return least_gap(root(first_), root(second_), sides_.size(), gap, options).gap;
  }

 private:
  /// c + Σ w_k f_k for points f of a mesh.
  struct OfMesh {
    Form c;
    std::array<Form, 3> w;
  };
  /// Either body along a direction, divided by its length: a mesh as a function, any other as its extreme value.
  struct Sides {
    OfMesh first, second;
    I first_value, second_value;
  };

  [[nodiscard]] static OfMesh of_mesh(const PlacedMesh<I>& mesh, const Form& origin, const std::array<Form, 3>& u) {
    OfMesh result{origin + u[0] * mesh.at(0) + u[1] * mesh.at(1) + u[2] * mesh.at(2), {}};
    for (int k = 0; k < 3; ++k) {
      Form& w = result.w[static_cast<std::size_t>(k)];
      w = mesh.turn ? u[0] * (*mesh.turn)(0, k) + u[1] * (*mesh.turn)(1, k) + u[2] * (*mesh.turn)(2, k)
                    : u[static_cast<std::size_t>(k)];
      w = w * mesh.unit;
    }
    return result;
  }

  void add(const Direction& direction) {
    const bool in_platform = !is_of_obstacle(pair_) && direction.in_platform;
    const std::array<I, 3> u = gaps_.vector(pair_, direction);
    const Turned turned = gaps_.turned(u, in_platform);
    const I unit = reciprocal(euclidean_norm(u[0], u[1], u[2]));
    const std::array<Form, 3> still = {Form(u[0] * unit), Form(u[1] * unit), Form(u[2] * unit)};
    Sides sides;
    if (first_ != nullptr) {  // on the platform, and seen from W
      sides.first = of_mesh(*first_, turned.of_origin * unit,
                            {turned.other[0] * unit, turned.other[1] * unit, turned.other[2] * unit});
    } else {
      sides.first_value = least_of_first(turned, in_platform, unit);
    }
    if (second_ != nullptr) {
      sides.second = of_mesh(*second_, Form(0.0), still);
    } else if (const auto* half = half_space(gaps_.box_.bodies, pair_)) {
      sides.second_value = half->offset * unit;
    } else {
      const ConvexBody<I>& body = second_hull(gaps_.box_.bodies, pair_);
      sides.second_value = dot(u, body.points.front());
      for (const Vector3<I>& x : body.points) sides.second_value = larger(sides.second_value, dot(u, x));
      sides.second_value = sides.second_value * unit + body.radius;
    }
    sides_.push_back(std::move(sides));
  }

  /// The least of a cable.
  [[nodiscard]] I least_of_first(const Turned& turned, bool in_platform, const I& unit) const {
    std::optional<I> result;
    for (Projection& a : gaps_.first(pair_, turned, in_platform)) {
      Form at = a.at * unit;
      at.tighten(gaps_.box_.offset);
      I value = where_ == Where::kBox ? at.range : at.at_mid;
      if (where_ != Where::kMidUndisturbed) value = value + ProofScalarTraits<I>::symmetric(a.shift);
      result = result ? lesser(*result, value) : value;
    }
    return result.value();
  }

  /// Values over a box, of the undisturbed machine.
  [[nodiscard]] I value(const OfMesh& along, const MeshBox& box) const {
    const std::array<I, 3> f = coordinates(box);
    const auto at = [&](auto part) {
      return along.c.*part + along.w[0].*part * f[0] + along.w[1].*part * f[1] + along.w[2].*part * f[2];
    };
    const I mid = at(&Form::at_mid);
    if (where_ != Where::kBox) return mid;
    return intersect(at(&Form::range), I(mid + at(&Form::slope) * gaps_.box_.offset));
  }

  [[nodiscard]] I first_of(const Sides& sides, std::span<const MeshBox> boxes) const {
    if (boxes.empty()) return sides.first_value;
    std::optional<I> result;
    for (const MeshBox& box : boxes) {
      const I here = value(sides.first, box) + shift(box);
      result = result ? lesser(*result, here) : here;
    }
    return result.value();
  }

  [[nodiscard]] I second_of(const Sides& sides, std::span<const MeshBox> boxes) const {
    if (boxes.empty()) return sides.second_value;
    std::optional<I> result;
    for (const MeshBox& box : boxes) {
      const I here = value(sides.second, box);
      result = result ? larger(*result, here) : here;
    }
    return result.value();
  }

  /// How far deviations may move the points of a box that the platform carries, to either side.
  [[nodiscard]] I shift(const MeshBox& box) const {
    if (gaps_.box_.tolerance == nullptr || where_ == Where::kMidUndisturbed) return I(0.0);
    const std::array<I, 3> f = coordinates(box);
    const Vector3<I> x = bodies_detail::placed_point<I>(
        first_->at, first_->turn, {first_->unit * f[0], first_->unit * f[1], first_->unit * f[2]});
    return ProofScalarTraits<I>::symmetric(gaps_.position_ + gaps_.turn_ * norm_above(x));
  }

  [[nodiscard]] static std::array<I, 3> coordinates(const MeshBox& box) {
    const auto side = [&](std::size_t k) { return I(box.lower[k], box.upper[k]); };
    return {side(0), side(1), side(2)};
  }

  const BodyGaps& gaps_;
  const CheckedPair<I>& pair_;
  Where where_;
  const PlacedMesh<I>* first_;
  const PlacedMesh<I>* second_;
  I needed_;  ///< clearance, and the radius of a cable
  std::vector<Sides> sides_;
};

template <class I, class Slope>
const PlacedMesh<I>* BodyGaps<I, Slope>::mesh(const CheckedPair<I>& pair, bool is_first) const {
  if (is_first) {
    return pair.kind == PairClass::kPlatformObstacles ? box_.bodies.platform[pair.first].mesh.get() : nullptr;
  }
  if (pair.kind == PairClass::kCablesCables || pair.kind == PairClass::kExitCones ||
      half_space(box_.bodies, pair) != nullptr) {
    return nullptr;
  }
  return second_hull(box_.bodies, pair).mesh.get();
}

template <class I, class Slope>
double BodyGaps<I, Slope>::of_mesh(const CheckedPair<I>& pair, std::span<const Direction> directions,
                                   Where where) const {
  return MeshGaps(*this, pair, directions, where).least();
}

template <class I, class Slope>
MeshSide BodyGaps<I, Slope>::side_at_mid(const CheckedPair<I>& pair, bool first_is_solid,
                                         const Vector3<I>& point) const {
  const PlacedMesh<I>& solid = *mesh(pair, first_is_solid);
  Vector3<I> x = point;
  const bool is_of_platform = first_is_solid || pair.kind == PairClass::kCablesPlatform;
  for (int k = 0; is_of_platform && k < 3; ++k) {
    x(k) = box_.r_WP(0, k).at_mid * (point(0) - box_.p_WP(0).at_mid) +
           box_.r_WP(1, k).at_mid * (point(1) - box_.p_WP(1).at_mid) +
           box_.r_WP(2, k).at_mid * (point(2) - box_.p_WP(2).at_mid);
  }
  const Vector3<I> from(x(0) - solid.at(0), x(1) - solid.at(1), x(2) - solid.at(2));
  std::array<I, 3> f;
  for (int k = 0; k < 3; ++k) {
    const I here =
        solid.turn ? I((*solid.turn)(0, k) * from(0) + (*solid.turn)(1, k) * from(1) + (*solid.turn)(2, k) * from(2))
                   : from(k);
    f[static_cast<std::size_t>(k)] = here / solid.unit;
  }
  return mesh_side(*solid.mesh, f);
}

/// Of the other body, one point of each part that hangs together is enough: it stays on one side of a surface that it
/// does not touch.
template <class I, class Slope>
MeshSide BodyGaps<I, Slope>::side_at_mid(const CheckedPair<I>& pair, bool first_is_solid) const {
  const PlacedMesh<I>* solid = mesh(pair, first_is_solid);
  if (solid == nullptr || !solid->mesh->is_watertight() || half_space(box_.bodies, pair) != nullptr) {
    return MeshSide::kOutside;
  }
  if (const PlacedMesh<I>* other = mesh(pair, !first_is_solid)) {
    for (const std::uint32_t vertex : other->mesh->components()) {
      Vector3<I> x = other->place(other->mesh->mesh().vertices[vertex]);
      if (!first_is_solid) {
        const Vector3<I> of_platform = x;
        for (int k = 0; k < 3; ++k) {
          x(k) = box_.p_WP(k).at_mid + box_.r_WP(k, 0).at_mid * of_platform(0) +
                 box_.r_WP(k, 1).at_mid * of_platform(1) + box_.r_WP(k, 2).at_mid * of_platform(2);
        }
      }
      if (const MeshSide side = side_at_mid(pair, first_is_solid, x); side != MeshSide::kOutside) return side;
    }
    return MeshSide::kOutside;
  }
  const Vector3<Form> x = points(pair, !first_is_solid, {}).front();
  return side_at_mid(pair, first_is_solid, {x(0).at_mid, x(1).at_mid, x(2).at_mid});
}

template <class I, class Slope>
bool BodyGaps<I, Slope>::is_inside_at_mid(const CheckedPair<I>& pair, const PointPair& shares) const {
  const bool first_is_solid = shares.inside == std::size_t{0};
  const PlacedMesh<I>* solid = mesh(pair, first_is_solid);
  if (solid == nullptr || !solid->mesh->is_watertight()) return false;
  const std::size_t other = first_is_solid ? 1 : 0;
  const Vector3<Form> x =
      mean(points(pair, !first_is_solid, shares.elements[other]), first_is_solid ? shares.second : shares.first);
  return side_at_mid(pair, first_is_solid, {x(0).at_mid, x(1).at_mid, x(2).at_mid}) == MeshSide::kInside;
}

template <class I, class Slope>
MeshSide BodyGaps<I, Slope>::side_at_mid(const CheckedPair<I>& pair) const {
  const MeshSide of_first = side_at_mid(pair, false);
  return of_first == MeshSide::kOutside ? side_at_mid(pair, true) : of_first;
}

template MeshSide BodyGaps<Interval>::side_at_mid(const CheckedPair<Interval>&, bool) const;
template MeshSide BodyGaps<MpInterval>::side_at_mid(const CheckedPair<MpInterval>&, bool) const;
template MeshSide BodyGaps<Interval>::side_at_mid(const CheckedPair<Interval>&, bool, const Vector3<Interval>&) const;
template MeshSide BodyGaps<MpInterval>::side_at_mid(const CheckedPair<MpInterval>&, bool,
                                                    const Vector3<MpInterval>&) const;
template bool BodyGaps<Interval>::is_inside_at_mid(const CheckedPair<Interval>&, const PointPair&) const;
template bool BodyGaps<MpInterval>::is_inside_at_mid(const CheckedPair<MpInterval>&, const PointPair&) const;
template const PlacedMesh<Interval>* BodyGaps<Interval>::mesh(const CheckedPair<Interval>&, bool) const;
template const PlacedMesh<MpInterval>* BodyGaps<MpInterval>::mesh(const CheckedPair<MpInterval>&, bool) const;
template const PlacedMesh<Interval>* BodyGaps<Interval, Gradient<Interval, 2>>::mesh(const CheckedPair<Interval>&,
                                                                                     bool) const;
template const PlacedMesh<Interval>* BodyGaps<Interval, Gradient<Interval, 3>>::mesh(const CheckedPair<Interval>&,
                                                                                     bool) const;
template MeshSide BodyGaps<Interval>::side_at_mid(const CheckedPair<Interval>&) const;
template MeshSide BodyGaps<MpInterval>::side_at_mid(const CheckedPair<MpInterval>&) const;
template double BodyGaps<Interval>::of_mesh(const CheckedPair<Interval>&, std::span<const Direction>, Where) const;
template double BodyGaps<MpInterval>::of_mesh(const CheckedPair<MpInterval>&, std::span<const Direction>, Where) const;

}  // namespace taut
