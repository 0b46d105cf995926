// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/moving.h"

#include <algorithm>
#include <stdexcept>

#include "base/input_error.h"

namespace taut {
namespace {

/// Places of a segment, among those of its path.
template <class I>
I on_path(const Segment& segment, const I& places) {
  return I(static_cast<double>(segment.index)) + places;
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

/// `size`, but not above `most`.
template <class I>
I no_more(const I& size, const I& most) {
  return most.upper() < size.upper() ? hull(I(size.lower()), I(most.upper())) : size;
}

}  // namespace

template <class I>
auto MovingModel<I>::middle_of_times(const RatesAlong<I>& along, const Part& part) -> std::optional<Middle> {
  const Segment& segment = along.segment();
  const I index(static_cast<double>(segment.index));
  const std::optional<LawInstant<I>> time = law_instant(*segment.timing, part.times, on_path(segment, part.here));
  if (!time) return std::nullopt;
  // Beside the index, a number of the range may have been rounded: the place has to be in what accelerations are of.
  const I place = time->place - index;
  if (!(place.lower() >= part.here.lower() && place.upper() <= part.here.upper())) return std::nullopt;
  return Middle{*time, place};
}

template <class I>
auto MovingModel<I>::corners_of(const RatesAlong<I>& along, const Part& part) const -> Corners {
  if (part.speeds != Speeds::kAny || !slowing_) return {};
  const TimeLaw& law = *along.segment().timing;
  const I& rate = part.law.rate;
  return {LawRange<I>{rate, law_braking<I>(law, part.times, I(-*slowing_))},
          LawRange<I>{rate, law_braking<I>(law, part.times, *slowing_)}, LawRange<I>{I(0.0), rate * *slowing_}};
}

template <class I>
I MovingModel<I>::magnitude(RatesAlong<I>& along, const Part& part, const Corners& corners, const RateId& id) const {
  I size = along.magnitude(id, part.here, part.law);
  if (is_speed(id.kind)) return size;
  for (const LawRange<I>& corner : corners) size = hull(size, along.magnitude(id, part.here, corner));
  return size;
}

template <class I>
typename MovingModel<I>::Limits MovingModel<I>::narrow(RatesAlong<I>& along, const Part& part, Limits open,
                                                       Sizes& sizes) const {
  const auto is_open = [&](std::size_t n) { return (open >> n & 1U) != 0; };
  const auto close = [&](std::size_t n) {
    if (certainly_positive(I(limits_[n].most - sizes[n]))) open &= ~(Limits{1} << n);
  };
  const Corners corners = corners_of(along, part);
  bool any_speed = false;
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if (!is_open(n)) continue;
    sizes[n] = magnitude(along, part, corners, limits_[n].id);
    close(n);
    any_speed = any_speed || (is_open(n) && is_speed(limits_[n].id.kind));
  }
  if (open == 0) return open;
  const std::optional<Middle> middle = any_speed ? middle_of_times(along, part) : std::nullopt;
  if (!middle) return open;
  along.look_at_middle();
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    const RateId& id = limits_[n].id;
    if (!is_open(n) || !is_speed(id.kind)) continue;
    sizes[n] = no_more(sizes[n], along.speed_around(id, part.here, part.law, middle->place, middle->time));
    close(n);
  }
  return open;
}

template <class I>
LawRange<I> MovingModel<I>::law_over(const TimeLaw& law, const TimeCover& times) const {
  const LawRange<I> at_full_speed = law_range<I>(law, times);
  if (!pace_) return at_full_speed;
  const auto& [rate, acceleration] = at_full_speed;
  return {pace_->speed * rate, sqr(pace_->speed) * acceleration + pace_->change * rate};
}

template <class I>
auto MovingModel<I>::part_at(const RatesAlong<I>& along, const TimeCover& times) const -> std::optional<Part> {
  const TimeLaw& law = *along.segment().timing;
  const I places = law_places<I>(law, times) - I(static_cast<double>(along.segment().index));
  const I& range = along.range();
  if (places.upper() < range.lower() || places.lower() > range.upper()) return std::nullopt;
  const I &begin = places.lower() > range.lower() ? places : range,
          &end = places.upper() < range.upper() ? places : range;
  return Part{times, hull(I(begin.lower()), I(end.upper())), law_over(law, times), Speeds::kAny};
}

template <class I>
bool MovingModel<I>::are_kept(RatesAlong<I>& along, const TimeCover& times, Limits open, int depth, Halving& halving,
                              Sizes& sizes) const {
  const auto are_halves_kept = [&](Limits limits) {
    return std::ranges::all_of(
        halves(times), [&](const TimeCover& half) { return are_kept(along, half, limits, depth + 1, halving, sizes); });
  };
  if (depth < halving.likely) return are_halves_kept(open);
  const std::optional<Part> part = part_at(along, times);
  if (!part) return true;
  Sizes found = sizes;
  const Limits left = narrow(along, *part, open, found);
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
bool MovingModel<I>::are_kept_over(RatesAlong<I>& along, const TimeCover& times, Limits open, Sizes& sizes,
                                   int bisections) const {
  along.look_at_middle();
  Sizes found = sizes;
  Halving halving;
  if (are_kept(along, times, open, 0, halving, found)) {
    sizes = std::move(found);
    return true;
  }
  if (bisections == 0) return false;
  const Segment& segment = along.segment();
  const I& range = along.range();
  const double middle = midpoint_approx(range);
  return std::ranges::all_of(
      std::array{hull(I(lower_bound(range)), I(middle)), hull(I(middle), I(upper_bound(range)))}, [&](const I& half) {
        const std::unique_ptr<RatesAlong<I>> on_half = along.over_part(half);
        return on_half != nullptr && are_kept_over(*on_half, time_cover(*segment.timing, on_path(segment, half)), open,
                                                   sizes, bisections - 1);
      });
}

template <class I>
LawRange<I> MovingModel<I>::at_speeds(const LawRange<I>& at_full_speed, Speeds speeds) const {
  return speeds == Speeds::kAny && slowing_ ? slowed(at_full_speed, *slowing_) : at_full_speed;
}

template <class I>
InertialLoad<I> MovingModel<I>::inertial_load(const PathRates<I>& path, const Rates<I>& rates,
                                              const LawRange<I>& law) const {
  InertialLoad<I> result;
  result.wrench = inertial_wrench(bodies_, path.r_WP, rates);
  if (slowing_) {
    const I one(1.0), none(0.0);
    result.by_law = {inertial_wrench(bodies_, path.r_WP, by_time(path, none, one)),
                     inertial_wrench(bodies_, path.r_WP, by_time(path, one, none)), law.acceleration, sqr(law.rate)};
  }
  return result;
}

template <class I>
auto MovingModel<I>::load_in_parts(const Moving<I>& over, int halvings) const
    -> boost::container::static_vector<LoadInPart, 1 << kMostHalvings> {
  RatesAlong<I>& along = *over.along;
  along.look_at_middle();
  boost::container::static_vector<TimeCover, 1 << kMostHalvings> times{over.part.times};
  for (int k = 0; k < halvings; ++k) {
    const auto wholes = times;
    times.clear();
    for (const TimeCover& whole : wholes) {
      for (const TimeCover& half : halves(whole)) times.push_back(half);
    }
  }
  boost::container::static_vector<LoadInPart, 1 << kMostHalvings> result;
  for (const TimeCover& some : times) {
    const std::optional<Part> part = part_at(along, some);
    if (!part) continue;
    const LawRange<I> law = at_speeds(part->law, part->speeds);
    const PathRates<I> path = along.path_on(part->here);
    result.push_back({part->here, inertial_load(path, by_time(path, law.rate, law.acceleration), law)});
  }
  return result;
}

template <class I>
std::optional<Moving<I>> MovingModel<I>::at(const Model<I>& model, const Segment& segment, const I& place,
                                            Speeds speeds, const KnownMotion<I>* known) const {
  if (segment.timing == nullptr) throw std::logic_error("a segment without a time law");
  std::unique_ptr<RatesAlong<I>> along = RatesAlong<I>::over(rates_, model, segment, place, known);
  if (along == nullptr) return std::nullopt;
  const PathRates<I>& path = along->path();
  const TimeCover times = time_cover(*segment.timing, on_path(segment, place));
  const LawRange<I> at_full_speed = law_over(*segment.timing, times);
  const LawRange<I> law = at_speeds(at_full_speed, speeds);
  std::optional<Moving<I>> result(std::in_place);
  result->r_WP = path.r_WP;
  result->rates = by_time(path, law.rate, law.acceleration);
  result->load = inertial_load(path, result->rates, law);
  result->part = {times, place, at_full_speed, speeds};
  result->along = std::move(along);
  return result;
}

template <class I>
void MovingModel<I>::bound_rates(Moving<I>& moving) const {
  RatesAlong<I>& along = *moving.along;
  const Part& part = moving.part;
  const Corners corners = corners_of(along, part);
  moving.margins.clear();
  for (const Limit& limit : limits_) {
    const I size = magnitude(along, part, corners, limit.id);
    moving.margins.push_back({limit.id, size, limit.most - size});
  }
  if (powers_.empty()) return;
  // Slowed down everywhere, speeds have no longer these accelerations for derivatives.
  const std::optional<Middle> middle = pace_ ? std::nullopt : middle_of_times(along, part);
  if (middle) along.look_at_middle();
  for (const Limit& limit : powers_) {
    I& speed = moving.winch_speed[static_cast<std::size_t>(limit.id.cable)];
    const RateId id{RateKind::kWinchSpeed, limit.id.cable};
    speed = along.magnitude(id, part.here, part.law);
    if (middle) speed = no_more(speed, along.speed_around(id, part.here, part.law, middle->place, middle->time));
  }
}

template <class I>
std::optional<Moving<I>> MovingModel<I>::over(const Model<I>& model, const Segment& segment, const I& range,
                                              const KnownMotion<I>& known) const {
  return at(model, segment, range, Speeds::kAny, &known);
}

template <class I>
void MovingModel<I>::tighten(Moving<I>& moving) const {
  Limits open = 0;
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if (!certainly_positive(moving.margins[n].value)) open |= Limits{1} << n;
  }
  if (open == 0) return;
  Sizes sizes(limits_.size(), I(0.0));
  if (!are_kept_over(*moving.along, moving.part.times, open, sizes, kMostBisections)) return;
  for (std::size_t n = 0; n < limits_.size(); ++n) {
    if ((open >> n & 1U) != 0) moving.margins[n] = {limits_[n].id, sizes[n], limits_[n].most - sizes[n]};
  }
}

template <class I>
void MovingModel<I>::add_powers(const Moving<I>& moving, const std::array<I, kCables>& tension,
                                RateMargins<I>& margins) const {
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
