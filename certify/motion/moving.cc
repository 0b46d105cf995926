// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/moving.h"

#include <algorithm>
#include <stdexcept>

#include "base/input_error.h"

namespace taut {
namespace {

bool is_speed(RateKind kind) {
  return kind == RateKind::kWinchSpeed || kind == RateKind::kLoadSpeed || kind == RateKind::kLoadAngularSpeed;
}

}  // namespace

template <class I>
MovingModel<I>::MovingModel(const Problem& problem, const std::optional<Slowing>& slowing)
    : rates_(problem), bodies_(make_moving_bodies<I>(problem.load)) {
  if (bodies_.empty()) throw InputError("time: got a load without a mass, expected items of which one has some");
  const TimeText& text = problem.time.value();
  const auto add = [&](RateId id, const TimeText::Limit& limit) {
    std::vector<Limit>& limits = id.kind == RateKind::kWinchPower ? powers_ : limits_;
    if (slowing && is_speed(id.kind)) return;
    if (limit) limits.push_back({id, evaluate_constant<I>(*limit)});
  };
  for (int cable = 0; cable < static_cast<int>(kCables); ++cable) {
    const auto i = static_cast<std::size_t>(cable);
    add({RateKind::kWinchSpeed, cable}, text.winch_speed_m_s[i]);
    add({RateKind::kWinchAcceleration, cable}, text.winch_acceleration_m_s2[i]);
    add({RateKind::kWinchPower, cable}, text.winch_power_W[i]);
  }
  if (text.stopping_time_s) slowing_ = I(1.0) / evaluate_constant<I>(*text.stopping_time_s);
  if (slowing) {
    pace_ = {ScalarTraits<I>::from_decimal(slowing->speed), I(static_cast<double>(slowing->change)) * slowing_.value()};
    slowing_.reset();
  }
  add({RateKind::kLoadSpeed}, text.load_speed_m_s);
  add({RateKind::kLoadAcceleration}, text.load_acceleration_m_s2);
  add({RateKind::kLoadAngularSpeed}, text.load_angular_speed_rad_s);
  add({RateKind::kLoadAngularAcceleration}, text.load_angular_acceleration_rad_s2);
}

namespace {

/// Where the law is run as s = σ(τ(t)) with τ' in [0, 1] and |τ''| <= slowing: ṡ = σ' τ', s̈ = σ'' τ'² + σ' τ''.
template <class I>
LawRange<I> slowed(const LawRange<I>& law, const I& slowing) {
  const I share = hull(I(0.0), I(1.0));
  return {law.rate * share, law.acceleration * share + law.rate * hull(-slowing, slowing)};
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

/// `size`, but not above `most`.
template <class I>
I no_more(const I& size, const I& most) {
  return most.upper() < size.upper() ? hull(I(size.lower()), I(most.upper())) : size;
}

}  // namespace

/// Magnitudes of rates over a part of a box, at one (s̈, ṡ²) or all of a range. Those of a winch are enclosed when they
/// are asked for.
template <class I>
class MovingModel<I>::Magnitudes {
 public:
  Magnitudes(const Model<I>& model, const PathRates<I>& path, const LawRange<I>& law)
      : model_(model), path_(path), rates_(by_time(path, law.rate, law.acceleration)) {}

  [[nodiscard]] const Rates<I>& rates() const { return rates_; }
  /// L̇ and L̈ of a winch.
  [[nodiscard]] const WinchRate<I>& winch(std::size_t i) {
    if (!winches_[i]) winches_[i] = winch_rate(model_, i, path_.p, path_.r_WP, rates_);
    return *winches_[i];
  }

  [[nodiscard]] I operator()(const RateId& id) {
    const auto i = static_cast<std::size_t>(id.cable);
    const auto arm = [&] { return turned(path_.r_WP, model_.p_PM); };
    switch (id.kind) {
      case RateKind::kWinchSpeed: return absolute(winch(i).speed);
      case RateKind::kWinchAcceleration: return absolute(winch(i).acceleration);
      case RateKind::kLoadSpeed: return norm(velocity_at(rates_, arm()));
      case RateKind::kLoadAcceleration: return norm(acceleration_at(rates_, arm()));
      case RateKind::kLoadAngularSpeed: return norm(rates_.angular_velocity);
      case RateKind::kWinchPower: throw std::logic_error("a power without a tension");
      case RateKind::kLoadAngularAcceleration: break;
    }
    return norm(rates_.angular_acceleration);
  }

 private:
  const Model<I>& model_;
  const PathRates<I>& path_;
  Rates<I> rates_;
  std::array<std::optional<WinchRate<I>>, kCables> winches_;
};

template <class I>
std::optional<typename MovingModel<I>::Fastest> MovingModel<I>::fastest(const Part& part, Magnitudes& by_law,
                                                                        const std::array<bool, kCables>& cables,
                                                                        bool load) const {
  const I index(static_cast<double>(part.segment.index));
  const std::optional<LawInstant<I>> middle = law_instant(*part.segment.timing, part.times, I(index + part.range));
  if (!middle) return std::nullopt;
  // Beside the index, a number of the range may have been rounded: the place has to be in what accelerations are of.
  const I place = middle->place - index;
  if (!(place.lower() >= part.range.lower() && place.upper() <= part.range.upper())) return std::nullopt;
  const Model<I>& model = part.model;
  const PathRates<I>& path = part.path;
  const std::optional<PathRates<I>> at_place = rates_.over(model, part.segment, place);
  if (!at_place) return std::nullopt;
  const PathRates<I>& at = *at_place;
  const Rates<I>& all = by_law.rates();
  const Rates<I> here = by_time(at, middle->rate, I(0.0));
  Fastest result;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!cables[i]) continue;
    const I change = plus_minus(middle->reach) * by_law.winch(i).acceleration;
    result.winch[i] = absolute(winch_rate(model, i, at.p, at.r_WP, here).speed + change);
  }
  if (!load) return result;
  const Vector3<I> arm = turned(path.r_WP, model.p_PM), arm_here = turned(at.r_WP, model.p_PM);
  result.load =
      magnitude_within(velocity_at(here, arm_here), velocity_at(all, arm), acceleration_at(all, arm), middle->reach);
  result.spin = magnitude_within(here.angular_velocity, all.angular_velocity, all.angular_acceleration, middle->reach);
  return result;
}

template <class I>
typename MovingModel<I>::Limits MovingModel<I>::narrow(const Part& part, Limits open, std::vector<I>& sizes) const {
  const auto is_open = [&](std::size_t n) { return (open >> n & 1U) != 0; };
  const auto close = [&](std::size_t n) {
    if (certainly_positive(I(limits_[n].most - sizes[n]))) open &= ~(Limits{1} << n);
  };
  Magnitudes at_speed(part.model, part.path, part.law);
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if (is_open(n)) sizes[n] = at_speed(limits_[n].id);
  }
  if (part.speeds == Speeds::kAny && slowing_) {
    const TimeLaw& law = *part.segment.timing;
    const I &rate = part.law.rate, braking = law_braking<I>(law, part.times, I(-*slowing_)),
            gaining = law_braking<I>(law, part.times, *slowing_);
    // At each time all are convex in (τ'², τ''): none is larger than at one of the corners of these.
    for (const LawRange<I>& corner :
         {LawRange<I>{rate, braking}, LawRange<I>{rate, gaining}, LawRange<I>{I(0.0), rate * *slowing_}}) {
      Magnitudes slowed_down(part.model, part.path, corner);
      for (std::size_t n = 0; n < limits_.size(); ++n) {
        if (is_open(n) && !is_speed(limits_[n].id.kind)) sizes[n] = hull(sizes[n], slowed_down(limits_[n].id));
      }
    }
  }
  std::array<bool, kCables> cables{};
  bool load = false, any = false;
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if (!is_open(n)) continue;
    close(n);
    if (!is_open(n) || !is_speed(limits_[n].id.kind)) continue;
    any = true;
    if (is_of_winch(limits_[n].id.kind)) {
      cables[static_cast<std::size_t>(limits_[n].id.cable)] = true;
    } else {
      load = true;
    }
  }
  if (!any) return open;
  const std::optional<Fastest> most = fastest(part, at_speed, cables, load);
  if (!most) return open;
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if (!is_open(n)) continue;
    switch (limits_[n].id.kind) {
      case RateKind::kWinchSpeed:
        sizes[n] = no_more(sizes[n], most->winch[static_cast<std::size_t>(limits_[n].id.cable)]);
        break;
      case RateKind::kLoadSpeed: sizes[n] = no_more(sizes[n], most->load); break;
      case RateKind::kLoadAngularSpeed: sizes[n] = no_more(sizes[n], most->spin); break;
      default: continue;
    }
    close(n);
  }
  return open;
}

template <class I>
std::optional<typename MovingModel<I>::Part> MovingModel<I>::part_of(const Model<I>& model, const Segment& segment,
                                                                     const I& range, Speeds speeds) const {
  if (segment.timing == nullptr) throw std::logic_error("a segment without a time law");
  const std::optional<PathRates<I>> path = rates_.over(model, segment, range);
  if (!path) return std::nullopt;
  const TimeCover times = time_cover(*segment.timing, I(I(static_cast<double>(segment.index)) + range));
  return Part{model, segment, times, range, *path, law_over(*segment.timing, times), speeds};
}

template <class I>
LawRange<I> MovingModel<I>::law_over(const TimeLaw& law, const TimeCover& times) const {
  const LawRange<I> at_full_speed = law_range<I>(law, times);
  if (!pace_) return at_full_speed;
  const auto& [rate, acceleration] = at_full_speed;
  return {pace_->speed * rate, sqr(pace_->speed) * acceleration + pace_->change * rate};
}

/// Whether limits are kept at all of these times at which the move is in `whole.range`. `sizes` grow by what is found.
template <class I>
bool MovingModel<I>::are_kept(const Whole& whole, const TimeCover& times, Limits open, int depth, Halving& halving,
                              std::vector<I>& sizes) const {
  const auto are_halves_kept = [&](Limits limits) {
    return std::ranges::all_of(
        halves(times), [&](const TimeCover& half) { return are_kept(whole, half, limits, depth + 1, halving, sizes); });
  };
  if (depth < halving.likely) return are_halves_kept(open);
  const TimeLaw& law = *whole.segment.timing;
  const I places = law_places<I>(law, times) - I(static_cast<double>(whole.segment.index));
  const I& range = whole.range;
  if (places.upper() < range.lower() || places.lower() > range.upper()) return true;  // not at these times
  const I &begin = places.lower() > range.lower() ? places : range,
          &end = places.upper() < range.upper() ? places : range;
  const I here = hull(I(begin.lower()), I(end.upper()));
  const std::optional<PathRates<I>> path = rates_.over(whole.model, whole.segment, here);
  if (!path) return false;
  const Part part{whole.model, whole.segment, times, here, *path, law_over(law, times), Speeds::kAny};
  std::vector<I> found = sizes;
  const Limits left = narrow(part, open, found);
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    const Limits limit = Limits{1} << n;
    if ((left & limit) != 0 && certainly_nonpositive(I(limits_[n].most - found[n]))) return false;
    if ((open & limit) != 0 && (left & limit) == 0) sizes[n] = hull(sizes[n], found[n]);
  }
  if (left == 0) {
    if (++halving.kept % 2 == 0) halving.likely = depth - 1;
    return true;
  }
  if (depth == Halving::kMost) return false;
  halving = {depth + 1, 0};
  return are_halves_kept(left);
}

template <class I>
Moving<I> MovingModel<I>::moving(const Part& part) const {
  const PathRates<I>& path = part.path;
  Moving<I> result;
  LawRange<I> law = part.law;
  if (part.speeds == Speeds::kAny && slowing_) law = slowed(law, *slowing_);
  result.r_WP = path.r_WP;
  result.rates = by_time(path, law.rate, law.acceleration);
  result.wrench = inertial_wrench(bodies_, path.r_WP, result.rates);
  if (slowing_) {
    const I one(1.0), none(0.0);
    result.by_law = {inertial_wrench(bodies_, path.r_WP, by_time(path, none, one)),
                     inertial_wrench(bodies_, path.r_WP, by_time(path, one, none)), law.acceleration, sqr(law.rate)};
  }
  if (powers_.empty()) return result;
  Magnitudes at_speed(part.model, path, part.law);
  std::array<bool, kCables> cables{};
  for (const Limit& limit : powers_) cables[static_cast<std::size_t>(limit.id.cable)] = true;
  // Slowed down everywhere, speeds have no longer these accelerations for derivatives.
  const std::optional<Fastest> most = pace_ ? std::nullopt : fastest(part, at_speed, cables, false);
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!cables[i]) continue;
    result.winch_speed[i] = at_speed({RateKind::kWinchSpeed, static_cast<int>(i)});
    if (most) result.winch_speed[i] = no_more(result.winch_speed[i], most->winch[i]);
  }
  return result;
}

template <class I>
Moving<I> MovingModel<I>::at_any_time(const Part& part) const {
  Moving<I> result = moving(part);
  std::vector<I> sizes(limits_.size(), I(0.0));
  (void)narrow(part, all_limits(), sizes);
  add_margins(sizes, result);
  return result;
}

template <class I>
std::optional<Moving<I>> MovingModel<I>::at(const Model<I>& model, const Segment& segment, const I& place,
                                            Speeds speeds) const {
  const std::optional<Part> part = part_of(model, segment, place, speeds);
  return part ? std::optional(at_any_time(*part)) : std::nullopt;
}

template <class I>
std::optional<Moving<I>> MovingModel<I>::over(const Model<I>& model, const Segment& segment, const I& range) const {
  return at(model, segment, range, Speeds::kAny);
}

template <class I>
void MovingModel<I>::tighten(const Model<I>& model, const Segment& segment, const I& range, Moving<I>& moving) const {
  Limits open = 0;
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if (!certainly_positive(moving.margins[n].value)) open |= Limits{1} << n;
  }
  if (open == 0) return;
  std::vector<I> sizes(limits_.size(), I(0.0));
  Halving halving;
  const TimeCover times = time_cover(*segment.timing, I(I(static_cast<double>(segment.index)) + range));
  if (!are_kept({model, segment, range}, times, open, 0, halving, sizes)) return;
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if ((open >> n & 1U) != 0) moving.margins[n] = {limits_[n].id, sizes[n], limits_[n].most - sizes[n]};
  }
}

template <class I>
void MovingModel<I>::add_margins(const std::vector<I>& sizes, Moving<I>& to) const {
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    to.margins.push_back({limits_[n].id, sizes[n], limits_[n].most - sizes[n]});
  }
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
Vector6<I> MovingModel<I>::inertia(const Matrix3<I>& r_WP, const Rates<I>& rates) const {
  return inertial_wrench(bodies_, r_WP, rates);
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
