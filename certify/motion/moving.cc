// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/moving.h"

#include <algorithm>
#include <stdexcept>

#include "base/input_error.h"

namespace taut {

template <class I>
MovingModel<I>::MovingModel(const Problem& problem) : rates_(problem), bodies_(make_moving_bodies<I>(problem.load)) {
  if (bodies_.empty()) throw InputError("time: got a load without a mass, expected items of which one has some");
  const TimeText& text = problem.time.value();
  const auto add = [&](RateId id, const TimeText::Limit& limit) {
    std::vector<Limit>& limits = id.kind == RateKind::kWinchPower ? powers_ : limits_;
    if (limit) limits.push_back({id, evaluate_constant<I>(*limit)});
  };
  for (int cable = 0; cable < static_cast<int>(kCables); ++cable) {
    const auto i = static_cast<std::size_t>(cable);
    add({RateKind::kWinchSpeed, cable}, text.winch_speed_m_s[i]);
    add({RateKind::kWinchAcceleration, cable}, text.winch_acceleration_m_s2[i]);
    add({RateKind::kWinchPower, cable}, text.winch_power_W[i]);
  }
  if (text.stopping_time_s) slowing_ = I(1.0) / evaluate_constant<I>(*text.stopping_time_s);
  add({RateKind::kLoadSpeed}, text.load_speed_m_s);
  add({RateKind::kLoadAcceleration}, text.load_acceleration_m_s2);
  add({RateKind::kLoadAngularSpeed}, text.load_angular_speed_rad_s);
  add({RateKind::kLoadAngularAcceleration}, text.load_angular_acceleration_rad_s2);
  has_speeds_ = !powers_.empty() || std::ranges::any_of(limits_, [](const Limit& limit) {
    return limit.id.kind == RateKind::kWinchSpeed || limit.id.kind == RateKind::kLoadSpeed ||
           limit.id.kind == RateKind::kLoadAngularSpeed;
  });
}

namespace {

/// Where the law is run as s = σ(τ(t)) with τ' in [0, 1] and |τ''| <= slowing: ṡ = σ' τ', s̈ = σ'' τ'² + σ' τ''.
template <class I>
LawRange<I> slowed(const LawRange<I>& law, const I& slowing) {
  const I share = hull(I(0.0), I(1.0));
  return {law.rate * share, law.acceleration * share + law.rate * hull(-slowing, slowing)};
}

/// All magnitudes that are limited are convex in (s̈, ṡ²), or rise with ṡ: none is larger than at one of these.
template <class I>
std::vector<LawRange<I>> corners_of(const LawRange<I>& law) {
  std::vector<LawRange<I>> corners;
  const I none(0.0);
  for (const I& rate : {none, I(law.rate.upper())}) {
    for (const I& acceleration : {I(law.acceleration.lower()), I(law.acceleration.upper())}) {
      corners.push_back({rate, acceleration});
    }
  }
  return corners;
}

/// ± x.
template <class I>
I plus_minus(const I& x) {
  return hull(-x, x);
}

template <class I>
I dot(const Vector3<I>& a, const Vector3<I>& b) {
  return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
}

template <class I>
I norm(const Vector3<I>& v) {
  return euclidean_norm(v(0), v(1), v(2));
}

/// The magnitude of a velocity that is v0 at a time, v in between, and changes at the rate a, for `reach` at most: its
/// square changes at the rate 2 v·a.
template <class I>
I magnitude_within(const Vector3<I>& v0, const Vector3<I>& v, const Vector3<I>& a, const I& reach) {
  const I square = dot(v0, v0) + plus_minus(reach) * (I(2.0) * dot(v, a));
  if (!(square.upper() >= 0)) return square;  // no number, and no bound
  return sqrt(hull(I(0.0), I(square.upper())));
}

}  // namespace

template <class I>
std::optional<typename MovingModel<I>::Fastest> MovingModel<I>::fastest(const Model<I>& model, const Segment& segment,
                                                                        const I& range, const PathRates<I>& path,
                                                                        const LawRange<I>& law,
                                                                        const LawInstant<I>& middle) const {
  // Beside the index, a number of the range may have been rounded: the place has to be in what accelerations are of.
  const I place = middle.place - I(static_cast<double>(segment.index));
  if (!(place.lower() >= range.lower() && place.upper() <= range.upper())) return std::nullopt;
  const std::optional<PathRates<I>> at_place = rates_.over(model, segment, place);
  if (!at_place) return std::nullopt;
  const PathRates<I>& at = *at_place;
  const Rates<I> all = by_time(path, law.rate, law.acceleration), here = by_time(at, middle.rate, I(0.0));
  const WinchRates<I> winches = winch_rates(model, path.p, path.r_WP, all),
                      winches_here = winch_rates(model, at.p, at.r_WP, here);
  const Vector3<I> arm = turned(path.r_WP, model.p_PM), arm_here = turned(at.r_WP, model.p_PM);
  Fastest result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.winch[i] = absolute(winches_here.speed[i] + plus_minus(middle.reach) * winches.acceleration[i]);
  }
  result.load =
      magnitude_within(velocity_at(here, arm_here), velocity_at(all, arm), acceleration_at(all, arm), middle.reach);
  result.spin = magnitude_within(here.angular_velocity, all.angular_velocity, all.angular_acceleration, middle.reach);
  return result;
}

template <class I>
std::optional<Moving<I>> MovingModel<I>::over(const Model<I>& model, const Segment& segment, const I& range,
                                              Speeds speeds) const {
  if (segment.timing == nullptr) throw std::logic_error("a segment without a time law");
  const std::optional<PathRates<I>> rates_by_s = rates_.over(model, segment, range);
  if (!rates_by_s) return std::nullopt;
  const PathRates<I>& path = *rates_by_s;
  const I places = I(static_cast<double>(segment.index)) + range;
  const TimeCover times = time_cover(*segment.timing, places);
  LawRange<I> law = law_range<I>(*segment.timing, times);
  std::optional<Fastest> most;
  if (has_speeds_) {
    const std::optional<LawInstant<I>> middle = law_instant(*segment.timing, times, places);
    if (middle) most = fastest(model, segment, range, path, law, *middle);
  }
  std::vector<LawRange<I>> corners = {law};
  if (speeds == Speeds::kAny && slowing_) {
    law = slowed(law, *slowing_);
    corners = corners_of(law);
  }
  Moving<I> result;
  result.r_WP = path.r_WP;
  result.rates = by_time(path, law.rate, law.acceleration);
  result.wrench = inertial_wrench(bodies_, path.r_WP, result.rates);
  if (slowing_) {
    const I one(1.0), none(0.0);
    result.by_law = {inertial_wrench(bodies_, path.r_WP, by_time(path, none, one)),
                     inertial_wrench(bodies_, path.r_WP, by_time(path, one, none)), law.acceleration, sqr(law.rate)};
  }

  const Vector3<I> arm = turned(path.r_WP, model.p_PM);
  const auto rate_of = [&](const RateId& id, const Rates<I>& rates, const WinchRates<I>& winches) -> I {
    const auto i = static_cast<std::size_t>(id.cable);
    switch (id.kind) {
      case RateKind::kWinchSpeed: return absolute(winches.speed[i]);
      case RateKind::kWinchAcceleration: return absolute(winches.acceleration[i]);
      case RateKind::kLoadSpeed: return norm(velocity_at(rates, arm));
      case RateKind::kLoadAcceleration: return norm(acceleration_at(rates, arm));
      case RateKind::kLoadAngularSpeed: return norm(rates.angular_velocity);
      case RateKind::kWinchPower: throw std::logic_error("a power without a tension");
      case RateKind::kLoadAngularAcceleration: break;
    }
    return norm(rates.angular_acceleration);
  };
  for (const LawRange<I>& corner : corners) {
    const Rates<I> rates = by_time(path, corner.rate, corner.acceleration);
    const WinchRates<I> winches = winch_rates(model, path.p, path.r_WP, rates);
    for (std::size_t i = 0; i < kCables; ++i)
      result.winch_speed[i] = absolute(winches.speed[i]);  // at last the fastest
    for (std::size_t n = 0; n < limits_.size(); ++n) {
      const I size = rate_of(limits_[n].id, rates, winches);
      const I value = limits_[n].most - size;
      if (&corner == &corners.front()) {
        result.margins.push_back({limits_[n].id, size, value});
      } else {
        result.margins[n].size = hull(result.margins[n].size, size);
        result.margins[n].value = hull(result.margins[n].value, value);
      }
    }
  }
  if (!most) return result;
  const auto cut = [](I& size, const I& other) {
    if (other.upper() < size.upper()) size = hull(I(size.lower()), I(other.upper()));
  };
  for (std::size_t i = 0; i < kCables; ++i) cut(result.winch_speed[i], most->winch[i]);
  for (RateMargin<I>& margin : result.margins) {
    switch (margin.id.kind) {
      case RateKind::kWinchSpeed: cut(margin.size, most->winch[static_cast<std::size_t>(margin.id.cable)]); break;
      case RateKind::kLoadSpeed: cut(margin.size, most->load); break;
      case RateKind::kLoadAngularSpeed: cut(margin.size, most->spin); break;
      default: continue;
    }
    const auto limit = std::ranges::find(limits_, margin.id, &Limit::id);
    margin.value = limit->most - margin.size;
  }
  return result;
}

template <class I>
void MovingModel<I>::add_powers(const Moving<I>& moving, const std::array<I, kCables>& tension,
                                std::vector<RateMargin<I>>& margins) const {
  for (const Limit& limit : powers_) {
    const auto i = static_cast<std::size_t>(limit.id.cable);
    const I size = moving.winch_speed[i] * absolute(tension[i]);
    margins.push_back({limit.id, size, limit.most - size});
  }
}

template <class I>
Vector6<I> MovingModel<I>::change(const Moving<I>& undisturbed, const I& turn) const {
  // On the straight line from R to another rotation R', by u from 0 to 1: a turn by an angle moves no unit vector
  // farther than that, and w_in, a polynomial in R, changes by some value of its derivative by u.
  using J = Jet<I, 1>;
  const I off = hull(-turn, turn);
  Matrix3<J> r_WP;
  for (int i = 0; i < 9; ++i) {
    r_WP(i) = J(I(undisturbed.r_WP(i) + off));
    r_WP(i).partial[0] = off;
  }
  const auto constant = [](const Vector3<I>& v) { return Vector3<J>(J(v(0)), J(v(1)), J(v(2))); };
  std::vector<MovingBody<J>> bodies;
  for (const MovingBody<I>& body : bodies_) {
    MovingBody<J> next;
    next.mass = J(body.mass);
    next.p_PC = constant(body.p_PC);
    next.p_MC = constant(body.p_MC);
    for (int i = 0; i < 9; ++i) next.inertia(i) = J(body.inertia(i));
    bodies.push_back(next);
  }
  const Rates<I>& x = undisturbed.rates;
  const Rates<J> rates{constant(x.velocity), constant(x.acceleration), constant(x.angular_velocity),
                       constant(x.angular_acceleration)};
  const Vector6<J> wrench = inertial_wrench(bodies, r_WP, rates);
  Vector6<I> result;
  for (int k = 0; k < 6; ++k) result(k) = hull(I(0.0), wrench(k).partial[0]);
  return result;
}

template class MovingModel<Interval>;
template class MovingModel<MpInterval>;

}  // namespace taut
