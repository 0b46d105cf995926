// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/length_controlled_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "certify/motion/forms_in_lanes.h"
#include "certify/motion/parametric_krawczyk.h"
#include "certify/motion/pose_in_lanes.h"
#include "kinematics/geometry.h"
#include "kinematics/quaternion.h"

namespace taut {
namespace {

constexpr std::size_t kUnknowns = 6;
constexpr std::size_t kPoseNumbers = std::tuple_size_v<PoseNumbers>;

template <class I>
using Lengths = std::array<SlopeForm<I>, kCables>;

template <class I>
Vector3<I> apply(const Matrix3<I>& r, const Vector3<I>& x) {
  Vector3<I> result;
  for (int i = 0; i < 3; ++i) result(i) = r(i, 0) * x(0) + r(i, 1) * x(1) + r(i, 2) * x(2);
  return result;
}

template <class I>
Matrix3<I> times(const Matrix3<I>& a, const Matrix3<I>& b) {
  Matrix3<I> result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  }
  return result;
}

// ---- The reference --------------------------------------------------------------------------------------------------

/// The symmetric bilinear form of which M of quaternion.h is the quadratic one.
template <class I>
Matrix3<I> bilinear(const Quaternion<I>& a, const Quaternion<I>& b) {
  const I xx = a.x * b.x;
  const I yy = a.y * b.y;
  const I zz = a.z * b.z;
  const I ww = a.w * b.w;
  const I xy = a.x * b.y + a.y * b.x;
  const I xz = a.x * b.z + a.z * b.x;
  const I yz = a.y * b.z + a.z * b.y;
  const I wx = a.w * b.x + a.x * b.w;
  const I wy = a.w * b.y + a.y * b.w;
  const I wz = a.w * b.z + a.z * b.w;
  Matrix3<I> m;
  m(0, 0) = ww + xx - yy - zz;
  m(0, 1) = xy - wz;
  m(0, 2) = xz + wy;
  m(1, 0) = xy + wz;
  m(1, 1) = ww - xx + yy - zz;
  m(1, 2) = yz - wx;
  m(2, 0) = xz - wy;
  m(2, 1) = yz + wx;
  m(2, 2) = ww - xx - yy + zz;
  return m;
}

template <class I>
I inner(const Quaternion<I>& a, const Quaternion<I>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

/// p_ref and R_ref over a box with midpoint m; of second order, R_ref(t) = r_mid + (t − m)(r_slope + (t − m) r_bend).
template <class I>
struct Reference {
  Vector3<SlopeForm<I>> p;
  Matrix3<I> r_mid, r_slope, r_bend, r_range;
  PoseTube tube;
};

/// Nothing where the box reaches across an inner pose.
template <class I>
std::optional<Reference<I>> enclose_reference(const Segment& segment, const I& range, const I& mid, const I& offset) {
  const ReferencePiece piece = reference_piece(segment, lower_bound(range));
  if (!(lower_bound(range) >= piece.from && upper_bound(range) <= piece.to)) return std::nullopt;
  std::array<SlopeForm<I>, kPoseNumbers> x;
  const I from(piece.from);
  const I length = I(piece.to) - from;
  for (std::size_t j = 0; j < kPoseNumbers; ++j) {
    const I first(piece.first[j]);
    const I slope = (I(piece.last[j]) - first) / length;
    x[j] = {first + slope * (mid - from), slope, first + slope * (range - from)};
  }
  const Quaternion<I> q = {x[3].at_mid, x[4].at_mid, x[5].at_mid, x[6].at_mid};
  const Quaternion<I> q_slope = {x[3].slope, x[4].slope, x[5].slope, x[6].slope};

  // With R = M(q)/|q|^2, h = t − m, n1 = 2 q·q', n2 = |q'|^2: R(t) − R(m) = h (S1 + h B)/|q(t)|^2, S1 = 2 M(q, q') − n1
  // R(m) and B = M(q', q') − n2 R(m); and 1/|q(t)|^2 = 1/|q(m)|^2 − h (n1 + h n2)/(|q(m)|^2 |q(t)|^2).
  const I scale_mid = reciprocal(I(sqr(q.x) + sqr(q.y) + sqr(q.z) + sqr(q.w)));
  const I scale = reciprocal(I(sqr(x[3].range) + sqr(x[4].range) + sqr(x[5].range) + sqr(x[6].range)));
  const I half_n1 = inner(q, q_slope);
  const I n1 = half_n1 + half_n1;
  const I n2 = sqr(q_slope.x) + sqr(q_slope.y) + sqr(q_slope.z) + sqr(q_slope.w);
  const I growth = n1 + offset * n2;
  const Matrix3<I> m = bilinear(q, q);
  const Matrix3<I> m1 = bilinear(q, q_slope);
  const Matrix3<I> m2 = bilinear(q_slope, q_slope);
  Reference<I> result;
  for (int i = 0; i < 3; ++i) {
    result.p(i) = x[static_cast<std::size_t>(i)];
    for (int j = 0; j < 3; ++j) {
      result.r_mid(i, j) = m(i, j) * scale_mid;
      result.r_slope(i, j) = (m1(i, j) + m1(i, j) - n1 * result.r_mid(i, j)) * scale_mid;
      result.r_bend(i, j) = (m2(i, j) - n2 * result.r_mid(i, j) - result.r_slope(i, j) * growth) * scale;
      result.r_range(i, j) = result.r_mid(i, j) + offset * (result.r_slope(i, j) + offset * result.r_bend(i, j));
    }
  }
  result.tube = piece.tube;
  return result;
}

// ---- The equations --------------------------------------------------------------------------------------------------

/// g of the header.
template <class I>
class LengthSystem {
 public:
  using Vector = std::array<I, kUnknowns>;

  LengthSystem(const Model<I>& model, const Reference<I>& reference, const Lengths<I>& lengths, const I& offset)
      : model_(model), reference_(reference), lengths_(lengths), offset_(offset) {}

  [[nodiscard]] Vector values(const Vector& z) const {
    const Vector3<I> p = position(z, &SlopeForm<I>::at_mid);
    const Matrix3<I> r = times(local_turn(z), reference_.r_mid);
    Vector result;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<I> reach = apply(r, model_.p_PB[i]);
      I square(0.0);
      for (int k = 0; k < 3; ++k) square = square + sqr(I(p(k) + reach(k) - model_.p_WA[i](k)));
      result[i] = I(0.5) * (square - sqr(lengths_[i].at_mid));
    }
    return result;
  }

  [[nodiscard]] Square<I, kUnknowns> derivatives(const Vector& z, EvaluationDomain domain) const {
    const bool over_box = domain == EvaluationDomain::kOverBox;
    const Vector3<I> p = position(z, over_box ? &SlopeForm<I>::range : &SlopeForm<I>::at_mid);
    const Matrix3<I> r = times(local_turn(z), over_box ? reference_.r_range : reference_.r_mid);
    const Vector3<I> u = turn(z);
    const I scale = I(2.0 * reference_.tube.turn) / (I(1.0) + sqr(u(0)) + sqr(u(1)) + sqr(u(2)));
    Square<I, kUnknowns> result;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<I> reach = apply(r, model_.p_PB[i]);
      const Vector3<I>& base = model_.p_WA[i];
      const Vector3<I> from_base = {p(0) - base(0), p(1) - base(1), p(2) - base(2)};
      const Vector3<I> d = {from_base(0) + reach(0), from_base(1) + reach(1), from_base(2) + reach(2)};
      const Vector3<I> moment = cross(reach, from_base);  // = R b_i × d_i, and tighter
      const Vector3<I> turned = moment + cross(moment, u);
      for (int k = 0; k < 3; ++k) {
        result[i][static_cast<std::size_t>(k)] = I(reference_.tube.position) * d(k);
        result[i][static_cast<std::size_t>(k) + 3] = scale * turned(k);
      }
    }
    return result;
  }

  /// With d(t) = d(m) + h (σ + h τ), h = t − m: (|d(t)|^2 − |d(m)|^2)/2 = h (d(m)·σ + h (d(m)·τ + |σ + h τ|^2/2)).
  [[nodiscard]] EquationSlopes<kUnknowns, I> slopes(const Vector& z) const {
    const Vector3<I> p = position(z, &SlopeForm<I>::at_mid);
    const Matrix3<I> local = local_turn(z);
    const Matrix3<I> r = times(local, reference_.r_mid);
    const Matrix3<I> r_slope = times(local, reference_.r_slope);
    const Matrix3<I> r_bend = times(local, reference_.r_bend);
    EquationSlopes<kUnknowns, I> result;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<I> reach = apply(r, model_.p_PB[i]);
      const Vector3<I> reach_slope = apply(r_slope, model_.p_PB[i]);
      const Vector3<I> reach_bend = apply(r_bend, model_.p_PB[i]);
      I slope(0.0);
      I bend(0.0);
      I square(0.0);
      for (int k = 0; k < 3; ++k) {
        const I d = p(k) + reach(k) - model_.p_WA[i](k);
        const I sigma = reference_.p(k).slope + reach_slope(k);
        slope = slope + d * sigma;
        bend = bend + d * reach_bend(k);
        square = square + sqr(I(sigma + offset_ * reach_bend(k)));
      }
      result.by_t[i] = slope - lengths_[i].slope * lengths_[i].at_mid;
      result.bend[i] = bend + I(0.5) * (square - sqr(lengths_[i].slope));
    }
    return result;
  }

  [[nodiscard]] MotionEnclosure<I> pose(const std::array<SlopeForm<I>, kUnknowns>& z) const {
    using C = SlopeForm<I>;
    MotionEnclosure<I> result;
    result.status = MotionEnclosure<I>::Status::kKnown;
    const I turn(reference_.tube.turn);
    const Matrix3<C> local = rotation(Quaternion<C>{z[3] * turn, z[4] * turn, z[5] * turn, C(1.0)});
    Matrix3<C> r;
    for (int i = 0; i < 3; ++i) {
      result.p_WP(i) = reference_.p(i) + z[static_cast<std::size_t>(i)] * I(reference_.tube.position);
      result.p_WP(i).tighten(offset_);
      for (int j = 0; j < 3; ++j) {
        r(i, j) = {reference_.r_mid(i, j), reference_.r_slope(i, j) + offset_ * reference_.r_bend(i, j),
                   reference_.r_range(i, j)};
      }
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        result.r_WP(i, j) = local(i, 0) * r(0, j) + local(i, 1) * r(1, j) + local(i, 2) * r(2, j);
        result.r_WP(i, j).tighten(offset_);
      }
    }
    return result;
  }

 private:
  [[nodiscard]] Vector3<I> turn(const Vector& z) const {
    const I size(reference_.tube.turn);
    return {size * z[3], size * z[4], size * z[5]};
  }
  [[nodiscard]] Vector3<I> position(const Vector& z, I SlopeForm<I>::*where) const {
    const I size(reference_.tube.position);
    Vector3<I> p;
    for (int k = 0; k < 3; ++k) p(k) = reference_.p(k).*where + size * z[static_cast<std::size_t>(k)];
    return p;
  }
  /// R(u, 1).
  [[nodiscard]] Matrix3<I> local_turn(const Vector& z) const {
    const Vector3<I> u = turn(z);
    return rotation(Quaternion<I>{u(0), u(1), u(2), I(1.0)});
  }

  const Model<I>& model_;
  const Reference<I>& reference_;
  const Lengths<I>& lengths_;
  const I& offset_;  ///< holds t − m
};

}  // namespace

namespace {

/// What a pose is sought from.
template <class I>
struct PoseQuestion {
  Reference<I> reference;
  Lengths<I> lengths;
};

/// Sets the question. @returns kKnown, or the status that there is no pose to find
template <class I>
typename MotionEnclosure<I>::Status ask(const Segment& segment, const I& range, const I& mid, const I& offset,
                                        PoseQuestion<I>& question) {
  using Status = typename MotionEnclosure<I>::Status;
  auto reference = enclose_reference(segment, range, mid, offset);
  if (!reference) return Status::kSpansKnot;
  const auto is_size = [](double x) { return x > 0 && std::isfinite(x); };
  if (!is_size(reference->tube.position) || !is_size(reference->tube.turn)) return Status::kUnproved;
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto line = length_polynomial<I>(segment, i);
    question.lengths[i] = {line.at(mid), line.slope(range), line.at(range)};
    if (!certainly_positive(question.lengths[i].range)) return Status::kUnproved;
  }
  question.reference = *std::move(reference);
  return Status::kKnown;
}

}  // namespace

template <class I>
MotionEnclosure<I> forward_kinematics(const Model<I>& model, const Segment& segment, const I& range, const I& mid,
                                      const I& offset) {
  PoseQuestion<I> question;
  const auto status = ask(segment, range, mid, offset, question);
  if (status != MotionEnclosure<I>::Status::kKnown) return {status, {}, {}};
  using System = LengthSystem<I>;
  const System system(model, question.reference, question.lengths, offset);
  std::array<SlopeForm<I>, kUnknowns> z;
  if (!ParametricKrawczyk<kUnknowns, I, System>(system, offset, 1.0).enclose(z)) return {};
  return system.pose(z);
}

namespace {

lanes::LengthControl length_control(const PoseQuestion<Interval>& question, const Interval& offset) {
  using lanes_detail::ends;
  const Reference<Interval>& reference = question.reference;
  lanes::LengthControl result;
  for (int i = 0; i < 3; ++i) {
    result.p_mid[i] = ends(reference.p(i).at_mid);
    result.p_slope[i] = ends(reference.p(i).slope);
    result.p_range[i] = ends(reference.p(i).range);
    for (int j = 0; j < 3; ++j) {
      result.r_mid[i][j] = ends(reference.r_mid(i, j));
      result.r_slope[i][j] = ends(reference.r_slope(i, j));
      result.r_bend[i][j] = ends(reference.r_bend(i, j));
      result.r_range[i][j] = ends(reference.r_range(i, j));
    }
  }
  result.position = reference.tube.position;
  result.turn = reference.tube.turn;
  result.radius = magnitude(offset);
  for (std::size_t lane = 0; lane < lanes::kWidth; ++lane) {
    const SlopeForm<Interval>& length = question.lengths[lane < kCables ? lane : 0];
    const lanes::Ends mid = ends(length.at_mid), slope = ends(length.slope);
    result.length_mid.minus_lower.x[lane] = mid.minus_lower;
    result.length_mid.upper.x[lane] = mid.upper;
    result.length_slope.minus_lower.x[lane] = slope.minus_lower;
    result.length_slope.upper.x[lane] = slope.upper;
  }
  return result;
}

}  // namespace

MotionEnclosure<Interval> forward_kinematics_in_lanes(const lanes::Kernels& kernels, const lanes::Machine& machine,
                                                      const Model<Interval>& model, const Segment& segment,
                                                      const Interval& range, const Interval& mid,
                                                      const Interval& offset) {
  PoseQuestion<Interval> question;
  const auto status = ask(segment, range, mid, offset, question);
  if (status != MotionEnclosure<Interval>::Status::kKnown) return {status, {}, {}};
  lanes::FormRow<1> found;
  const lanes::Outcome outcome = kernels.find_pose(machine, length_control(question, offset), found);
  if (outcome == lanes::Outcome::kFault) Faults<Interval>::raise();
  if (outcome != lanes::Outcome::kYes) return {};
  std::array<SlopeForm<Interval>, kUnknowns> z;
  for (std::size_t k = 0; k < kUnknowns; ++k) set_from_lanes(found, k, z[k]);
  return LengthSystem<Interval>(model, question.reference, question.lengths, offset).pose(z);
}

namespace {

/// Does not move, as what is deviated moves about it.
Reference<MpInterval> still(const PoseEnclosure& pose, const PoseTube& tube) {
  const MpInterval zero(0.0);
  Reference<MpInterval> result;
  result.tube = tube;
  for (int i = 0; i < 3; ++i) {
    result.p(i) = {pose.p_WP(i), zero, pose.p_WP(i)};
    for (int j = 0; j < 3; ++j) {
      result.r_mid(i, j) = result.r_range(i, j) = pose.r_WP(i, j);
      result.r_slope(i, j) = result.r_bend(i, j) = zero;
    }
  }
  return result;
}

/// The only pose in the reference's tube that has such lengths, for all that they and the model enclose.
std::optional<PoseEnclosure> only_pose(const Model<MpInterval>& model, const Reference<MpInterval>& reference,
                                       const std::array<MpInterval, kCables>& lengths) {
  using System = LengthSystem<MpInterval>;
  const MpInterval zero(0.0);
  Lengths<MpInterval> constant;
  for (std::size_t i = 0; i < kCables; ++i) {
    constant[i] = {lengths[i], zero, lengths[i]};
    if (!certainly_positive(lengths[i])) return std::nullopt;
  }
  const System system(model, reference, constant, zero);
  std::array<SlopeForm<MpInterval>, kUnknowns> z;
  if (!ParametricKrawczyk<kUnknowns, MpInterval, System>(system, zero, 1.0).enclose(z)) return std::nullopt;
  const MotionEnclosure<MpInterval> found = system.pose(z);
  const auto at_mid = [](const SlopeForm<MpInterval>& x) { return x.at_mid; };
  return PoseEnclosure{found.p_WP.unaryExpr(at_mid), found.r_WP.unaryExpr(at_mid)};
}

/// |d_i| at a pose.
std::array<MpInterval, kCables> lengths_at(const Model<MpInterval>& model, const PoseEnclosure& pose) {
  std::array<MpInterval, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Vector3<MpInterval> reach = apply(pose.r_WP, model.p_PB[i]);
    MpInterval square(0.0);
    for (int k = 0; k < 3; ++k) square = square + sqr(MpInterval(pose.p_WP(k) + reach(k) - model.p_WA[i](k)));
    result[i] = sqrt(square);
  }
  return result;
}

/// The largest coordinate of a platform anchor.
double platform_size(const Model<MpInterval>& model) {
  double size = 0;
  for (const Vector3<MpInterval>& b : model.p_PB) {
    for (int k = 0; k < 3; ++k) size = std::max(size, std::abs(upper_bound(b(k))));
  }
  return size;
}

}  // namespace

std::optional<PoseEnclosure> deviated_pose(const Model<MpInterval>& model, const PoseEnclosure& pose,
                                           const Model<MpInterval>& deviated,
                                           const std::array<MpInterval, kCables>& length_error) {
  const std::array<MpInterval, kCables> stated_lengths = lengths_at(model, pose);
  const double size = platform_size(model);
  if (!(size > 0 && std::isfinite(size))) return std::nullopt;
  // The only pose in a tube around `here` of all machines that deviate τ times as much, τ in `part`.
  const auto pose_in_tube = [&](const PoseEnclosure& here, const PoseTube& tube, const MpInterval& part) {
    Model<MpInterval> machine = model;
    std::array<MpInterval, kCables> lengths;
    for (std::size_t i = 0; i < kCables; ++i) {
      for (int k = 0; k < 3; ++k) {
        machine.p_WA[i](k) += part * (deviated.p_WA[i](k) - model.p_WA[i](k));
        machine.p_PB[i](k) += part * (deviated.p_PB[i](k) - model.p_PB[i](k));
      }
      lengths[i] = stated_lengths[i] + part * length_error[i];
    }
    return only_pose(machine, still(here, tube), lengths);
  };
  // In steps of 2^-h of the way, as large as can be proved. Towards singular poses both tests ask for narrower tubes,
  // and smaller steps for narrower ones yet, so that is where they are sought.
  constexpr int kMostHalvings = 6;  // the checker goes further down, so that it should follow where this does
  constexpr int kTubes = 8;
  constexpr int kMoreTubes = 4;  // for each halving
  constexpr int kNarrowest = 32;
  constexpr int kSteady = 4;  // steps of a size before a larger one is tried
  int widest = 1;
  const auto follow = [&](const PoseEnclosure& here, double from, double to,
                          int halvings) -> std::optional<PoseEnclosure> {
    for (int k = widest; k < widest + kTubes + kMoreTubes * halvings && k <= kNarrowest; ++k) {
      const double turn = std::ldexp(1.0, -k);
      const PoseTube tube{turn * size, turn};
      if (!pose_in_tube(here, tube, MpInterval(from, to))) continue;
      if (auto found = pose_in_tube(here, tube, MpInterval(to))) {
        widest = k;
        return found;
      }
    }
    return std::nullopt;
  };
  PoseEnclosure here = pose;
  int halvings = 0, steady = 0;
  for (double at = 0; at < 1;) {  // all of these are dyadic, hence exact
    const double next = std::min(1.0, at + std::ldexp(1.0, -halvings));
    if (auto found = follow(here, at, next, halvings)) {
      here = *std::move(found);
      at = next;
      if (++steady == kSteady) {
        steady = 0;
        halvings = std::max(0, halvings - 1);
        widest = std::max(1, widest - 1);
      }
    } else {
      steady = 0;
      widest = std::max(1, widest - 2);
      if (++halvings > kMostHalvings) return std::nullopt;
    }
  }
  return here;
}

template MotionEnclosure<Interval> forward_kinematics(const Model<Interval>&, const Segment&, const Interval&,
                                                      const Interval&, const Interval&);
template MotionEnclosure<MpInterval> forward_kinematics(const Model<MpInterval>&, const Segment&, const MpInterval&,
                                                        const MpInterval&, const MpInterval&);

}  // namespace taut
