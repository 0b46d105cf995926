#include "certify/held_motion.h"

#include <cmath>

#include "certify/implied_zero.h"
#include "kinematics/geometry.h"
#include "kinematics/quaternion.h"

namespace taut {
namespace {

constexpr std::size_t kUnknowns = 6;

/// g of the header.
template <class I>
class LengthSystem {
 public:
  using Vector = std::array<I, kUnknowns>;

  LengthSystem(const Model<I>& model, const MotionEnclosure<I>& reference,
               const std::array<Centered<I>, kCables>& lengths, const PoseTube& tube)
      : model_(model), reference_(reference), lengths_(lengths), tube_(tube) {}

  [[nodiscard]] Vector values(const Vector& z) const {
    const Vector3<I> p = position(z, &Centered<I>::at_mid);
    const Matrix3<I> r = orientation(z, &Centered<I>::at_mid);
    Vector result;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<I> reach = apply(r, model_.p_PB[i]);
      I square(0.0);
      for (int k = 0; k < 3; ++k) square = square + sqr(I(p(k) + reach(k) - model_.p_WA[i](k)));
      result[i] = I(0.5) * (square - sqr(lengths_[i].at_mid));
    }
    return result;
  }

  [[nodiscard]] EquationDerivatives<kUnknowns, I> derivatives(const Vector& z, Place place) const {
    const auto where = place == Place::kAtMid ? &Centered<I>::at_mid : &Centered<I>::range;
    const Vector3<I> p = position(z, where);
    const Matrix3<I> local = local_turn(z);
    const Matrix3<I> r = times(local, reference_.r_WP, where);
    const Vector3<I> u = turn(z);
    const I scale = I(2.0 * tube_.turn) / (I(1.0) + sqr(u(0)) + sqr(u(1)) + sqr(u(2)));
    EquationDerivatives<kUnknowns, I> result;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<I> reach = apply(r, model_.p_PB[i]);
      const Vector3<I>& base = model_.p_WA[i];
      const Vector3<I> from_base = {p(0) - base(0), p(1) - base(1), p(2) - base(2)};
      const Vector3<I> d = {from_base(0) + reach(0), from_base(1) + reach(1), from_base(2) + reach(2)};
      const Vector3<I> moment = cross(reach, from_base);  // = R b_i × d_i, and tighter
      const Vector3<I> turned = moment + cross(moment, u);
      for (int k = 0; k < 3; ++k) {
        result.by_y[i][static_cast<std::size_t>(k)] = I(tube_.position) * d(k);
        result.by_y[i][static_cast<std::size_t>(k) + 3] = scale * turned(k);
      }
      if (place == Place::kAtMid) continue;
      const Matrix3<I> r_slope = times(local, reference_.r_WP, &Centered<I>::slope);
      const Vector3<I> reach_slope = apply(r_slope, model_.p_PB[i]);
      I slope(0.0);
      for (int k = 0; k < 3; ++k) slope = slope + d(k) * (reference_.p_WP(k).slope + reach_slope(k));
      result.by_t[i] = slope - lengths_[i].slope * lengths_[i].range;
    }
    return result;
  }

 private:
  [[nodiscard]] Vector3<I> turn(const Vector& z) const {
    const I size(tube_.turn);
    return {size * z[3], size * z[4], size * z[5]};
  }
  [[nodiscard]] Vector3<I> position(const Vector& z, I Centered<I>::*where) const {
    const I size(tube_.position);
    Vector3<I> p;
    for (int k = 0; k < 3; ++k) p(k) = reference_.p_WP(k).*where + size * z[static_cast<std::size_t>(k)];
    return p;
  }
  /// R(u, 1).
  [[nodiscard]] Matrix3<I> local_turn(const Vector& z) const {
    const Vector3<I> u = turn(z);
    return rotation(Quaternion<I>{u(0), u(1), u(2), I(1.0)});
  }
  static Matrix3<I> times(const Matrix3<I>& a, const Matrix3<Centered<I>>& b, I Centered<I>::*where) {
    Matrix3<I> result;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        result(i, j) = a(i, 0) * (b(0, j).*where) + a(i, 1) * (b(1, j).*where) + a(i, 2) * (b(2, j).*where);
      }
    }
    return result;
  }
  [[nodiscard]] Matrix3<I> orientation(const Vector& z, I Centered<I>::*where) const {
    return times(local_turn(z), reference_.r_WP, where);
  }
  static Vector3<I> apply(const Matrix3<I>& r, const Vector3<I>& x) {
    Vector3<I> result;
    for (int i = 0; i < 3; ++i) result(i) = r(i, 0) * x(0) + r(i, 1) * x(1) + r(i, 2) * x(2);
    return result;
  }

  const Model<I>& model_;
  const MotionEnclosure<I>& reference_;
  const std::array<Centered<I>, kCables>& lengths_;
  const PoseTube& tube_;
};

}  // namespace

template <class I>
MotionEnclosure<I> hold_by_lengths(const Model<I>& model, const MotionEnclosure<I>& reference,
                                   const std::array<Centered<I>, kCables>& lengths, const PoseTube& tube,
                                   const I& offset) {
  const auto is_size = [](double x) { return x > 0 && std::isfinite(x); };
  if (!is_size(tube.position) || !is_size(tube.turn)) return {};
  for (const Centered<I>& length : lengths) {
    if (!certainly_positive(length.range)) return {};
  }
  using System = LengthSystem<I>;
  const System system(model, reference, lengths, tube);
  std::array<Centered<I>, kUnknowns> z;
  if (!ImpliedZero<kUnknowns, I, System>(system, offset, 1.0).enclose(z)) return {};

  MotionEnclosure<I> result = reference;
  using C = Centered<I>;
  const I turn(tube.turn);
  for (int k = 0; k < 3; ++k) {
    C& p = result.p_WP(k);
    p = p + z[static_cast<std::size_t>(k)] * I(tube.position);
    p.tighten(offset);
  }
  const Matrix3<C> local = rotation(Quaternion<C>{z[3] * turn, z[4] * turn, z[5] * turn, C(1.0)});
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      C& r = result.r_WP(i, j);
      r = local(i, 0) * reference.r_WP(0, j) + local(i, 1) * reference.r_WP(1, j) + local(i, 2) * reference.r_WP(2, j);
      r.tighten(offset);
    }
  }
  return result;
}

template MotionEnclosure<Interval> hold_by_lengths(const Model<Interval>&, const MotionEnclosure<Interval>&,
                                                   const std::array<Centered<Interval>, kCables>&, const PoseTube&,
                                                   const Interval&);
template MotionEnclosure<MpInterval> hold_by_lengths(const Model<MpInterval>&, const MotionEnclosure<MpInterval>&,
                                                     const std::array<Centered<MpInterval>, kCables>&, const PoseTube&,
                                                     const MpInterval&);

}  // namespace taut
