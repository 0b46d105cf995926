// SPDX-License-Identifier: GPL-3.0-or-later
// The loads at which a density y w is extremal, where loads are stated as items: enclosures for many y at once.
//
// With y = (f, m) a row of D^-1 and w(z) the wrench of the choice z (masses, offsets of centres of gravity, forces,
// load cases), w* is enclosed for every z* that attains the extremum for any y and any pose given. A turn of the
// platform at the rate Ω moves w* so that y·ẇ* = T·Ω:
//   T = r × (F* × m)  of a force that keeps its axes in W,   T = F* × f + (r × F* + M*) × m  of what turns with P.
// docs/theory.md, "Loads stated as items".
#pragma once

#include "certify/arithmetic/neumann.h"
#include "kinematics/geometry.h"
#include "kinematics/loads.h"

namespace taut {

enum class Extremum { kLeast, kNominal, kGreatest };

template <class I>
struct ExtremalLoad {
  Vector6<I> wrench;   ///< w*, the sum of all items
  Vector3<I> by_turn;  ///< T, likewise
};

template <class I>
class ExtremalLoads {
 public:
  /// @param at  the items at every pose in question
  ExtremalLoads(const LoadModel<I>& model, const LoadsAtPose<I>& at) : model_(model), at_(at) {}

  [[nodiscard]] ExtremalLoad<I> find(const Vector3<I>& f, const Vector3<I>& m, Extremum which) const {
    ExtremalLoad<I> sum;
    sum.wrench.setConstant(I(0.0));
    sum.by_turn.setConstant(I(0.0));
    for (std::size_t n = 0; n < model_.items.size(); ++n) {
      const Vector6<I> w = wrench_of(model_.items[n], at_.items[n], f, m, which);
      const Vector3<I> force(w(0), w(1), w(2)), moment(w(3), w(4), w(5));
      const bool turns = model_.items[n].axes == Axes::kPlatform && model_.items[n].shape != Shape::kBall;
      const Vector3<I> turn = turns ? Vector3<I>(cross(force, f) + cross(moment, m))
                                    : Vector3<I>(cross(at_.items[n].lever, Vector3<I>(cross(force, m))));
      for (int k = 0; k < 6; ++k) sum.wrench(k) = sum.wrench(k) + w(k);
      for (int k = 0; k < 3; ++k) sum.by_turn(k) = sum.by_turn(k) + turn(k);
    }
    return sum;
  }

 private:
  using Kind = typename LoadModel<I>::Kind;
  using Shape = typename LoadModel<I>::Shape;
  using Item = typename LoadModel<I>::Item;
  using ItemAtPose = typename LoadsAtPose<I>::Item;

  static I dot(const Vector3<I>& a, const Vector3<I>& b) { return a(0) * b(0) + a(1) * b(1) + a(2) * b(2); }
  static I dot(const Vector6<I>& a, const Vector3<I>& f, const Vector3<I>& m) {
    return a(0) * f(0) + a(1) * f(1) + a(2) * f(2) + (a(3) * m(0) + a(4) * m(1) + a(5) * m(2));
  }
  static I signed_by(Extremum which, const I& x) { return which == Extremum::kLeast ? I(-x) : x; }

  /// The factors in [middle − radius, middle + radius] at which a multiple of `slope` is extremal.
  static I extremal_factor(const I& middle, const I& radius, const I& slope, Extremum which) {
    const I rising = signed_by(which, slope);
    if (certainly_positive(rising)) return middle + radius;
    if (certainly_positive(-rising)) return middle - radius;
    return hull(middle - radius, middle + radius);
  }
  /// v/|v| for every v != 0, and every vector of length <= 1 where v may be 0.
  static Vector3<I> unit(const Vector3<I>& v) {
    const I size = euclidean_norm(v(0), v(1), v(2));
    const I all(-1.0, 1.0);
    if (!certainly_positive(size)) return {all, all, all};
    const I inverse = reciprocal(size);
    return {intersect(v(0) * inverse, all), intersect(v(1) * inverse, all), intersect(v(2) * inverse, all)};
  }
  static Vector3<I> times(const I& k, const Vector3<I>& v) { return {k * v(0), k * v(1), k * v(2)}; }
  static Vector6<I> joined(const Vector3<I>& force, const Vector3<I>& moment) {
    Vector6<I> w;
    for (int k = 0; k < 3; ++k) {
      w(k) = force(k);
      w(3 + k) = moment(k);
    }
    return w;
  }

  static Vector6<I> wrench_of(const Item& item, const ItemAtPose& at, const Vector3<I>& f, const Vector3<I>& m,
                              Extremum which) {
    switch (item.kind) {
      case Kind::kWeight: return wrench_of_weight(item, at, f, m, which);
      case Kind::kCases: return wrench_of_cases(at, f, m, which);
      case Kind::kForce:
      case Kind::kMoment: break;
    }
    const bool is_moment = item.kind == Kind::kMoment;
    Vector3<I> vector(I(0.0), I(0.0), I(0.0));
    if (item.shape == Shape::kSegment) {
      const I amount = which == Extremum::kNominal
                           ? item.nominal
                           : extremal_factor(item.nominal + item.offset, item.radius, dot(at.line, f, m), which);
      vector = times(amount, at.direction);
    } else if (which != Extremum::kNominal) {
      Vector3<I> g = m;
      if (!is_moment) g = Vector3<I>(f + cross(m, at.lever));
      if (item.shape == Shape::kDisc) g = Vector3<I>(g - times(dot(g, at.direction), at.direction));
      vector = times(signed_by(which, item.radius), unit(g));
    }
    if (is_moment) return joined({I(0.0), I(0.0), I(0.0)}, vector);
    return joined(vector, cross(at.lever, vector));
  }

  static Vector6<I> wrench_of_weight(const Item& item, const ItemAtPose& at, const Vector3<I>& f, const Vector3<I>& m,
                                     Extremum which) {
    Vector3<I> lever = at.lever;
    I mass = item.nominal;
    if (which != Extremum::kNominal) {
      I slope = dot(at.line, f, m);
      if (item.swings) {
        const Vector3<I> across = cross(at.direction, m);  // γ × y_M
        slope = slope + signed_by(which, item.reach * euclidean_norm(across(0), across(1), across(2)));
        lever = Vector3<I>(lever + times(signed_by(which, item.reach), unit(across)));
      }
      if (item.varies) mass = extremal_factor(item.nominal, item.radius, slope, which);
    }
    const Vector3<I> force = times(mass, at.direction);
    return joined(force, cross(lever, force));
  }

  static Vector6<I> wrench_of_cases(const ItemAtPose& at, const Vector3<I>& f, const Vector3<I>& m, Extremum which) {
    Vector6<I> w = at.line;
    if (which == Extremum::kNominal) return w;
    std::vector<I> values;
    for (const Vector6<I>& deviation : at.deviations) values.push_back(signed_by(which, dot(deviation, f, m)));
    I greatest = values.front();
    for (const I& value : values) greatest = larger(greatest, value);
    std::optional<Vector6<I>> all;
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (certainly_positive(greatest - values[j])) continue;  // another is greater
      for (int k = 0; all && k < 6; ++k) (*all)(k) = hull((*all)(k), at.deviations[j](k));
      if (!all) all = at.deviations[j];
    }
    return w + all.value();
  }

  const LoadModel<I>& model_;
  const LoadsAtPose<I>& at_;
};

}  // namespace taut
