// SPDX-License-Identifier: GPL-3.0-or-later
// How fast winches and load go along a part of a segment, whatever the law in time.
//
// A length L_i, the places of the load point and of the platform's origin, and the turning of the platform have by s a
// rate f, and f' = g, g' = h.
// By time that is f ṡ, which changes at f s̈ + g ṡ². All are enclosed over the part, and f and g once more at its
// middle m: by Taylor's theorem, for each component,
//   f(s) is in f(m) + (s − m) (g(m) + (s − m)/2 h),   g(s) in g(m) + (s − m) h,
// so that both are known more sharply on any piece of the part than over all of it. What a move asks for at parts of
// the times at which it is there needs no new enclosure of poses.
// docs/theory.md, "Parts of a box".
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "certify/arithmetic/neumann.h"
#include "certify/motion/forms_in_lanes.h"
#include "certify/motion/law_range.h"
#include "certify/motion/motion_rates.h"
#include "kinematics/moving_load.h"
#include "kinematics/time_limits.h"

namespace taut {

template <class I>
class RatesAlong {
 public:
  /// Nothing where the motion is not proved to be known. All arguments but the last two have to outlive this.
  /// @param known  of the same range
  [[nodiscard]] static std::unique_ptr<RatesAlong> over(const MotionRates<I>& rates, const Model<I>& model,
                                                        const Segment& segment, const I& range,
                                                        const KnownMotion<I>* known = nullptr) {
    std::optional<Over> path = rates.over(model, segment, range, known);
    if (!path) return nullptr;
    return std::unique_ptr<RatesAlong>(new RatesAlong(rates, model, segment, *std::move(path)));
  }

  [[nodiscard]] std::unique_ptr<RatesAlong> over_part(const I& part) const {
    return over(*rates_, *model_, *segment_, part);
  }

  [[nodiscard]] const Segment& segment() const { return *segment_; }
  [[nodiscard]] const I& range() const { return over_.range; }
  [[nodiscard]] const PathRates<I>& path() const { return over_.path; }

  /// From here on f and g are enclosed by those of the middle, too.
  void look_at_middle() {
    if (looked_at_middle_) return;
    looked_at_middle_ = true;
    if (lower_bound(over_.range) == upper_bound(over_.range)) return;  // it is all there is
    middle_ = rates_->at_middle(*model_, *segment_, over_);
  }

  /// At each place of `here`, which is in the range; the pose is that over all of the range, and without
  /// look_at_middle() so is the rest.
  [[nodiscard]] PathRates<I> path_on(const I& here) const {
    PathRates<I> result = over_.path;
    if (!middle_) return result;
    const I off = here - over_.mid;
    narrow(off, {middle_->p1, middle_->p2}, over_.path.p3, 3, result.p1, result.p2);
    narrow(off, {middle_->w, middle_->w1}, over_.path.w2, 3, result.w, result.w1);
    return result;
  }

  /// |f ṡ| or |f s̈ + g ṡ²|, of a place in `here`, which is in the range, and under a law there. Not of a power.
  [[nodiscard]] I magnitude(const RateId& id, const I& here, const LawRange<I>& law) {
    const Thing thing = thing_of(id);
    const Derivatives along = on(thing, here);
    return size(thing, is_speed(id.kind) ? velocity(thing, along, law) : acceleration(thing, along, law));
  }

  /// The magnitude of a speed at all times of a part, between any of which and m it is in `here`, as at m.
  [[nodiscard]] I speed_around(const RateId& id, const I& here, const LawRange<I>& law, const I& place,
                               const LawInstant<I>& m) {
    const Thing thing = thing_of(id);
    const Derivatives along = on(thing, here);
    const Vector3<I> v0 = velocity(thing, on(thing, place), {m.rate, I(0.0)}), a = acceleration(thing, along, law);
    if (is_winch(thing)) return absolute(v0(0) + plus_minus(m.reach) * a(0));
    // Its square changes at the rate 2 v·a.
    const I square = dot(v0, v0) + plus_minus(m.reach) * (I(2.0) * dot(velocity(thing, along, law), a));
    if (!(square.upper() >= 0)) return square;  // no number, and no bound
    return sqrt(hull(I(0.0), I(square.upper())));
  }

 private:
  using Thing = std::size_t;  ///< a winch, or one of these
  static constexpr Thing kLoadPoint = kCables, kTurning = kCables + 1, kThings = kCables + 2;
  using Over = typename MotionRates<I>::Over;
  /// Of a winch, the first number of each.
  struct Derivatives {
    Vector3<I> f, g;
  };
  struct AroundMiddle {
    Derivatives at_mid;
    Vector3<I> h;
  };

  RatesAlong(const MotionRates<I>& rates, const Model<I>& model, const Segment& segment, Over over)
      : rates_(&rates), model_(&model), segment_(&segment), over_(std::move(over)) {}

  [[nodiscard]] static bool is_winch(Thing thing) { return thing < kCables; }
  [[nodiscard]] static Thing thing_of(const RateId& id) {
    switch (id.kind) {
      case RateKind::kWinchSpeed:
      case RateKind::kWinchAcceleration:
      case RateKind::kWinchPower: return static_cast<Thing>(id.cable);
      case RateKind::kLoadSpeed:
      case RateKind::kLoadAcceleration: return kLoadPoint;
      case RateKind::kLoadAngularSpeed:
      case RateKind::kLoadAngularAcceleration: break;
    }
    return kTurning;
  }

  [[nodiscard]] static I plus_minus(const I& x) { return hull(-x, x); }
  [[nodiscard]] static I dot(const Vector3<I>& a, const Vector3<I>& b) {
    return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
  }
  [[nodiscard]] static I size(Thing thing, const Vector3<I>& v) {
    return is_winch(thing) ? absolute(v(0)) : euclidean_norm(v(0), v(1), v(2));
  }

  [[nodiscard]] Derivatives derivatives(Thing thing, const PathRates<I>& path) const {
    if (thing == kTurning) return {path.w, path.w1};
    const Rates<I> by_s{path.p1, path.p2, path.w, path.w1};
    if (is_winch(thing)) {
      const WinchRate<I> winch = winch_rate(*model_, thing, path.p, path.r_WP, by_s);
      Derivatives result;
      result.f(0) = winch.speed;
      result.g(0) = winch.acceleration;
      return result;
    }
    const Vector3<I> arm = turned(path.r_WP, model_->p_PM);
    return {velocity_at(by_s, arm), acceleration_at(by_s, arm)};
  }
  [[nodiscard]] const Derivatives& derivatives(Thing thing) {
    std::optional<Derivatives>& all = all_[thing];
    if (!all) {
      if (!is_winch(thing) || !set_winches()) all = derivatives(thing, over_.path);
    }
    return *all;
  }

  /// What is known beside derivatives().
  [[nodiscard]] const AroundMiddle& around_middle(Thing thing) {
    std::optional<AroundMiddle>& result = around_[thing];
    if (result) return *result;
    if (is_winch(thing) && set_winches_around_middle()) return *result;
    result.emplace(AroundMiddle{derivatives(thing, *middle_), over_.path.w2});
    if (thing == kLoadPoint) result->h = third_derivative_at(over_.path, turned(over_.path.r_WP, model_->p_PM));
    if (!is_winch(thing)) return *result;
    const Derivatives& all = derivatives(thing);
    result->h(0) = third_derivative_of_length(*model_, thing, over_.path, WinchRate<I>{all.f(0), all.g(0)});
    return *result;
  }

  /// The same of all winches at once, in lanes. Returns whether that is possible.
  [[nodiscard]] bool set_winches() {
    if constexpr (std::is_same_v<I, Interval>) {
      if (rates_->lanes() == nullptr) return false;
      lanes::LengthRates over;
      differentiate(lanes_rates(over_.path), lanes::Order::kThird, over);
      for (std::size_t i = 0; i < kCables; ++i) {
        all_[i] = of_winch(over, i);
        third_[i] = lanes_detail::interval(over.third, i);
      }
      return true;
    }
    return false;
  }
  [[nodiscard]] bool set_winches_around_middle() {
    if constexpr (std::is_same_v<I, Interval>) {
      if (rates_->lanes() == nullptr) return false;
      if (!all_[0]) static_cast<void>(set_winches());
      lanes::LengthRates at_mid;
      differentiate(lanes_rates(*middle_), lanes::Order::kSecond, at_mid);
      for (std::size_t i = 0; i < kCables; ++i) {
        around_[i].emplace(AroundMiddle{of_winch(at_mid, i), over_.path.w2});
        around_[i]->h(0) = third_[i];
      }
      return true;
    }
    return false;
  }
  void differentiate(const lanes::PlatformRates& by_s, lanes::Order order, lanes::LengthRates& result) const {
    if (lanes::kernels().differentiate_lengths(*rates_->lanes(), by_s, order, result) == lanes::Outcome::kYes) return;
    Faults<I>::raise();
    result = {};
  }
  [[nodiscard]] static Derivatives of_winch(const lanes::LengthRates& rates, std::size_t i) {
    Derivatives result;
    result.f(0) = lanes_detail::interval(rates.first, i);
    result.g(0) = lanes_detail::interval(rates.second, i);
    return result;
  }

  /// f and g, so far from the middle, by Taylor's theorem. @param components  how many they have
  static void narrow(const I& off, const Derivatives& at_mid, const Vector3<I>& h, int components, Vector3<I>& f,
                     Vector3<I>& g) {
    const I half = I(0.5) * off;
    for (int k = 0; k < components; ++k) {
      f(k) = intersect(f(k), at_mid.f(k) + off * (at_mid.g(k) + half * h(k)));
      g(k) = intersect(g(k), at_mid.g(k) + off * h(k));
    }
  }
  /// f and g at each place of `here`.
  [[nodiscard]] Derivatives on(Thing thing, const I& here) {
    Derivatives result = derivatives(thing);
    if (!middle_) return result;
    const auto& [at_mid, h] = around_middle(thing);
    narrow(here - over_.mid, at_mid, h, is_winch(thing) ? 1 : 3, result.f, result.g);
    return result;
  }
  [[nodiscard]] static Vector3<I> velocity(Thing thing, const Derivatives& along, const LawRange<I>& law) {
    Vector3<I> result;
    for (int k = 0; k < (is_winch(thing) ? 1 : 3); ++k) result(k) = along.f(k) * law.rate;
    return result;
  }
  [[nodiscard]] static Vector3<I> acceleration(Thing thing, const Derivatives& along, const LawRange<I>& law) {
    const I square = sqr(law.rate);
    Vector3<I> result;
    for (int k = 0; k < (is_winch(thing) ? 1 : 3); ++k) {
      result(k) = along.f(k) * law.acceleration + along.g(k) * square;
    }
    return result;
  }

  const MotionRates<I>* rates_;
  const Model<I>* model_;
  const Segment* segment_;
  Over over_;
  bool looked_at_middle_ = false;
  std::optional<PathRates<I>> middle_;
  std::array<std::optional<Derivatives>, kThings> all_;
  std::array<std::optional<AroundMiddle>, kThings> around_;
  std::array<I, kCables> third_;  ///< of winches over the part, where they were found in lanes
};

}  // namespace taut
