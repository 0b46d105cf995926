// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/moving.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "checker/kernel/curve.h"
#include "checker/kernel/frame_jet.h"

namespace taut::checker {
namespace {

// ---- The law --------------------------------------------------------------------------------------------------------

/// σ on its pieces, by u = t/h - k.
class PiecewiseLaw {
 public:
  explicit PiecewiseLaw(const TimeLaw& law) : controls_(law.controls) {}

  [[nodiscard]] std::size_t pieces() const { return controls_.size() - 3; }
  [[nodiscard]] Polynomial piece(std::size_t k) const {
    std::vector<mpq_class> q;
    for (std::size_t i = k; i < k + 4; ++i) q.emplace_back(controls_[i]);
    return mix(q);
  }
  /// σ where piece k begins, or where the last one ends.
  [[nodiscard]] mpq_class at_knot(std::size_t k) const {
    return (mpq_class(controls_[k]) + 4 * mpq_class(controls_[k + 1]) + mpq_class(controls_[k + 2])) / 6;
  }

 private:
  const std::vector<double>& controls_;
};

/// The last k in [0, n] with is_before(k), of which none holds behind one that does not; 0 if there is none.
template <class Predicate>
std::size_t last_before(std::size_t n, const Predicate& is_before) {
  std::size_t from = 0;
  for (std::size_t to = n + 1; to - from > 1;) {
    const std::size_t middle = from + (to - from) / 2;
    (is_before(middle) ? from : to) = middle;
  }
  return from;
}

/// From u1 on piece `first` to u2 on piece `last`: all times at which σ is in [a, b] are among these.
struct Times {
  std::size_t first = 0, last = 0;
  mpq_class u1 = 0, u2 = 1;

  /// @param halvings  of a piece, by which its ends are found
  Times(const PiecewiseLaw& law, const mpq_class& a, const mpq_class& b, int halvings) {
    const std::size_t n = law.pieces();
    first = std::min(last_before(n, [&](std::size_t k) { return law.at_knot(k) < a; }), n - 1);
    const std::size_t behind = n - last_before(n, [&](std::size_t k) { return law.at_knot(n - k) > b; });
    last = std::max(first, behind == 0 ? 0 : behind - 1);
    const Polynomial first_piece = law.piece(first), last_piece = law.piece(last);
    mpq_class by(1, 2);
    for (int k = 0; k < halvings; ++k, by /= 2) {
      if (at(first_piece, u1 + by) < a) u1 += by;
      if (at(last_piece, u2 - by) > b) u2 -= by;
    }
    if (first == last) u2 = std::max(u2, u1);
  }

  static mpq_class at(const Polynomial& p, const mpq_class& u) { return p[0] + u * (p[1] + u * (p[2] + u * p[3])); }
};

/// Of the times of a box: the narrower it is, the more, so that they are not much longer than the move takes on it.
int halvings_for(const Box& box) {
  constexpr int kLeast = 16, kMost = 144;
  int result = kLeast;
  for (mpq_class width = box.end - box.begin; width < 1 && result < kMost; width *= 2) ++result;
  return result;
}

/// How fast z changes over a box.
struct Speed {
  Ball rate;          ///< ż [1/s]
  Ball acceleration;  ///< z̈ [1/s^2]
  Ball fastest;       ///< the greatest ż that the move may have there
};

/// σ' and σ'' over those times.
Speed law_range(const PiecewiseLaw& law, const Times& times, const Ball& step) {
  Speed result;
  for (std::size_t k = times.first; k <= times.last; ++k) {
    Box part;
    part.begin = k == times.first ? times.u1 : mpq_class(0);
    part.end = k == times.last ? times.u2 : mpq_class(1);
    const Polynomial p = law.piece(k);
    const Ball rate = form(over(derivative(p), part)).range();
    const Ball acceleration = form(over(derivative(derivative(p)), part)).range();
    if (k == times.first) {
      result = {rate, acceleration, {}};
    } else {
      result = {hull(result.rate, rate), hull(result.acceleration, acceleration), {}};
    }
  }
  const Ball rate = result.rate / step;
  return {rate, result.acceleration / sqr(step), rate};
}

/// A time at which σ is in [a, b]; no other one at which it is there is farther from it than `reach`.
struct Instant {
  mpq_class place;  ///< σ
  Ball rate;        ///< σ' [1/s]
  Ball reach;       ///< [s]
};

/// The middle of those times, unless σ is not in [a, b] then.
std::optional<Instant> middle_of(const PiecewiseLaw& law, const Times& times, const mpq_class& step, const mpq_class& a,
                                 const mpq_class& b) {
  const mpq_class from = times.u1 + times.first, to = times.u2 + times.last, middle = (from + to) / 2;
  const mpz_class whole = middle.get_num() / middle.get_den();
  const std::size_t k = std::min<std::size_t>(whole.get_ui(), law.pieces() - 1);
  const Polynomial p = law.piece(k);
  Box here;
  here.begin = here.end = middle - k;
  const mpq_class place = Times::at(p, here.begin), reach = (to - from) / 2 * step;
  if (place < a || place > b) return std::nullopt;
  return Instant{place, form(over(derivative(p), here)).range() / Ball(step), Ball(reach)};
}

// ---- The platform ---------------------------------------------------------------------------------------------------

class Rates {
 public:
  Rates(FrameJet frame, Speed law) : frame_(std::move(frame)), law_(std::move(law)) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t j = 0; j < 3; ++j) R[c][j] = frame_.R[c][j].value;
      spin[c] = speed(SecondJet(Ball(), frame_.w[c], Ball()));
      spin_change[c] = acceleration(SecondJet(Ball(), frame_.w[c], frame_.w1[c]));
    }
  }

  [[nodiscard]] Vector3<SecondJet> point(const Vector3<Ball>& x) const { return frame_.p + multiply(frame_.R, x); }
  /// The length of cable i by s.
  [[nodiscard]] SecondJet length(const Machine& machine, std::size_t i) const {
    if (frame_.length) return (*frame_.length)[i];
    Vector3<SecondJet> d = point(machine.platform[i]);
    for (std::size_t c = 0; c < 3; ++c) d[c] = d[c] - SecondJet(machine.base[i][c]);
    return apply(Function::kSqrt, squared_norm(d));
  }
  [[nodiscard]] Ball speed(const SecondJet& x) const { return x.first * law_.rate; }
  [[nodiscard]] Ball fastest(const SecondJet& x) const { return x.first * law_.fastest; }
  [[nodiscard]] Ball acceleration(const SecondJet& x) const {
    return x.second * sqr(law_.rate) + x.first * law_.acceleration;
  }
  [[nodiscard]] Vector3<Ball> velocity(const Vector3<SecondJet>& X) const {
    return {speed(X[0]), speed(X[1]), speed(X[2])};
  }
  [[nodiscard]] Vector3<Ball> acceleration(const Vector3<SecondJet>& X) const {
    return {acceleration(X[0]), acceleration(X[1]), acceleration(X[2])};
  }

  Matrix3<Ball> R;
  Vector3<Ball> spin, spin_change;  ///< ω and its rate, axes of W

 private:
  FrameJet frame_;
  Speed law_;
};

// ---- Inertia --------------------------------------------------------------------------------------------------------

void add_weight(const Weight& weight, const LoadItem& item, const Machine& machine, const Rates& rates, Moving& to) {
  const Ball mass = hull(Ball(weight.mass.lower), Ball(weight.mass.upper));
  Vector3<Ball> c, arm;
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = plus_minus(Ball(item.at[i]), Ball(weight.offset));
    arm[i] = c[i] - machine.load_point[i];
  }
  Vector3<Ball> moments;  // the diagonal of I
  if (weight.inertia_box) {
    const ExactVector& side = *weight.inertia_box;
    for (std::size_t i = 0; i < 3; ++i) {
      const mpq_class &x = side[(i + 1) % 3], &y = side[(i + 2) % 3];
      moments[i] = mass * Ball(mpq_class((x * x + y * y) / 12));
    }
  }
  const Vector3<Ball> a = rates.acceleration(rates.point(c));
  const Vector3<Ball> force = mass * a;
  const Matrix3<Ball> back = transposed(rates.R);
  const auto momentum = [&](const Vector3<Ball>& x) {  // R I R^T x
    Vector3<Ball> own = multiply(back, x);
    for (std::size_t i = 0; i < 3; ++i) own[i] = moments[i] * own[i];
    return multiply(rates.R, own);
  };
  const Vector3<Ball> moment =
      cross(multiply(rates.R, arm), force) + momentum(rates.spin_change) + cross(rates.spin, momentum(rates.spin));
  const Bound spin = length_bound(rates.spin);
  const Bound q = length_bound(rates.spin_change) + spin * spin;
  const Bound two = Bound::power_of_two(1);
  const Bound of_acceleration = Bound(mass) * length_bound(c) * q;
  Bound largest;
  for (const Ball& x : moments) largest = larger(largest, Bound(x));
  const Ball of_force = of_acceleration.ball();
  const Ball of_moment =
      (length_bound(arm) * (Bound(mass) * length_bound(a) + two * of_acceleration) + two * largest * q).ball();
  for (std::size_t i = 0; i < 3; ++i) {
    to.inertia[i] += force[i];
    to.inertia[3 + i] += moment[i];
    to.change_by_turn[i] += of_force;
    to.change_by_turn[3 + i] += of_moment;
  }
}

}  // namespace

void require_time_law(const Path& path) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw Rejected(what);
  };
  require(path.segments() > 0, "a law in time of a pose");
  const std::vector<double>& c = path.timing->controls;
  require(path.timing->step_s > 0 && c.size() >= 4, "a law in time without a step or a piece");
  require(std::ranges::is_sorted(c), "a law in time that goes back");
  const PiecewiseLaw law(*path.timing);
  const std::size_t end = path.segments();
  require(law.at_knot(0) == 0 && law.at_knot(law.pieces()) == mpq_class(end), "a law in time of another path");
  const auto rests = [&](std::size_t place) { return std::ranges::count(c, static_cast<double>(place)) >= 3; };
  constexpr const char* kNoRest = "a move that does not rest where it has to";
  if (path.law == Law::kCubicBSpline) {
    const auto is_still = [](const auto& points) { return points[0] == points[1] && points[1] == points[2]; };
    require(rests(0) || is_still(std::span(path.waypoints).first<3>()), kNoRest);
    require(rests(end) || is_still(std::span(path.waypoints).last<3>()), kNoRest);
  } else {
    for (std::size_t k = 0; k <= end; ++k) require(rests(k), kNoRest);
  }
}

void require_rows(const Problem& problem) {
  if (!problem.time || !problem.time->rows) return;
  const auto& [step, error] = *problem.time->rows;
  if (!problem.tolerances) throw Rejected("rows of a table without tolerances");
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!problem.time->winch_acceleration[i]) throw Rejected("rows of a table without limits of all accelerations");
    const Ball room = Ball(mpq_class(8 * error[i])) -
                      rate_limit(problem, RateKind::kWinchAcceleration, i) * Ball(mpq_class(step * step));
    if (!certainly_positive(room)) {
      throw Rejected("rows of a table too far apart for the error of cable " + std::to_string(i + 1));
    }
  }
}

namespace {

/// No magnitude of a speed is above these while the move is run as its law says, or slower.
struct Fastest {
  std::array<Ball, kCables> winch;
  Ball load, spin;
};

/// The magnitude of a velocity that is v0 at one time, and in v with the rate a for `reach` about it: its square
/// changes at the rate 2 v a.
Ball magnitude_within(const Vector3<Ball>& v0, const Vector3<Ball>& v, const Vector3<Ball>& a, const Ball& reach) {
  const Ball change = reach * Ball(2) * (v[0] * a[0] + v[1] * a[1] + v[2] * a[2]);
  return highest(sqrt(highest(squared_norm(v0) + plus_minus(magnitude(change)))));
}

bool limits_a_speed(const TimeLimits& limits) {
  const auto is_stated = [](const auto& limit) { return limit.has_value(); };
  return limits.load_speed || limits.load_angular_speed || std::ranges::any_of(limits.winch_speed, is_stated) ||
         std::ranges::any_of(limits.winch_power, is_stated);
}

/// By the speeds in the middle of a box, and the accelerations of the law all over it.
Fastest fastest(const Machine& machine, const CommandedMotion& motion, std::size_t k, const Instant& middle,
                const Rates& all) {
  const Rates here(motion.at(middle.place - k), {middle.rate, Ball(), middle.rate});
  Fastest result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Ball change = middle.reach * all.acceleration(all.length(machine, i));
    result.winch[i] = magnitude(here.speed(here.length(machine, i)) + plus_minus(magnitude(change)));
  }
  const Vector3<SecondJet> load = all.point(machine.load_point);
  result.load = magnitude_within(here.velocity(here.point(machine.load_point)), all.velocity(load),
                                 all.acceleration(load), middle.reach);
  result.spin = magnitude_within(here.spin, all.spin, all.spin_change, middle.reach);
  return result;
}

/// All that the speeds at which a move may be run on a box have in common.
struct OnBox {
  FrameJet frame;
  Speed law;
  std::optional<Fastest> most;

  OnBox(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box) {
    if (!path.timing || !problem.time) throw std::logic_error("a move without a law, or without limits");
    const CommandedMotion motion(machine, problem, path, k, box);
    frame = motion.over_box();
    const PiecewiseLaw pieces(*path.timing);
    const mpq_class step(path.timing->step_s), begin = k + box.begin, end = k + box.end;
    const Times times(pieces, begin, end, halvings_for(box));
    law = law_range(pieces, times, Ball(step));
    if (!limits_a_speed(*problem.time)) return;
    const std::optional<Instant> middle = middle_of(pieces, times, step, begin, end);
    if (middle) most = fastest(machine, motion, k, *middle, Rates(frame, law));
  }
};

/// By how much z̈ may change at most where the move is slowed down. @pre the problem states a stopping time
Ball by_slowing(const Problem& problem, const Speed& law) {
  return law.rate / problem.time->stopping_time.value().evaluate<MeanValueForm>({}).range();
}

/// The corners of all speeds at which the move may be run: at each time, of the square of τ' in [0, 1] and of τ''.
std::vector<Speed> extreme_speeds(const Problem& problem, const Speed& law) {
  if (!problem.time->stopping_time) return {law};
  const Ball most = by_slowing(problem, law);
  std::vector<Speed> corners;
  for (const Ball& change : {most, -most}) {
    corners.push_back({Ball(), change, law.fastest});
    corners.push_back({law.rate, law.acceleration + change, law.fastest});
  }
  return corners;
}

/// As the law says, where it is not slowed down.
Speed speed_of(const Problem& problem, const Speed& law, const std::optional<Slowing>& slowing) {
  if (!slowing) return law;
  const Ball share(slowing->speed);
  const Ball rate = share * law.rate;
  return {rate, sqr(share) * law.acceleration + Ball(slowing->change) * by_slowing(problem, law), rate};
}

/// The frame at another pose, with the same velocities and accelerations by s: R' = [w] R, R'' = [w'] R + [w]^2 R.
FrameJet at_pose(FrameJet frame, const Frame& pose) {
  const Matrix3<Ball> R = range(pose.R);
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3<Ball> column = {R[0][j], R[1][j], R[2][j]};
    const Vector3<Ball> first = cross(frame.w, column);
    const Vector3<Ball> second = cross(frame.w1, column) + cross(frame.w, first);
    for (std::size_t c = 0; c < 3; ++c) frame.R[c][j] = SecondJet(column[c], first[c], second[c]);
  }
  for (std::size_t c = 0; c < 3; ++c) frame.p[c] = {pose.p[c].range(), frame.p[c].first, frame.p[c].second};
  return frame;
}

/// w_in and its change.
Moving inertia(const Machine& machine, const Problem& problem, const Rates& rates) {
  Moving result;
  for (const LoadItem& item : problem.items) {
    if (const auto* weight = std::get_if<Weight>(&item.set)) add_weight(*weight, item, machine, rates, result);
  }
  return result;
}

/// What is said of one of these speeds.
class AtSpeed {
 public:
  AtSpeed(const Machine& machine, const Problem& problem, const OnBox& on_box, const Speed& speed)
      : machine_(machine), problem_(problem), most_(on_box.most), rates_(on_box.frame, speed) {}

  /// All but the margins.
  [[nodiscard]] Moving moving() const {
    Moving result = inertia(machine_, problem_, rates_);
    for (std::size_t i = 0; i < kCables; ++i) {
      if (problem_.time->winch_power[i]) result.winch_speed[i] = fast(rates_.fastest(rates_.length(machine_, i)), i);
    }
    return result;
  }

  [[nodiscard]] std::vector<RateMargin> margins() const {
    std::vector<RateMargin> result;
    const auto add = [&](RateKind kind, std::size_t cable, const auto& magnitude_of_rate) {
      if (!problem_.time->of(kind, cable)) return;
      const Ball rate = magnitude_of_rate();
      result.push_back({kind, cable, rate, rate_limit(problem_, kind, cable) - rate});
    };
    for (std::size_t i = 0; i < kCables; ++i) {
      add(RateKind::kWinchSpeed, i, [&] { return fast(rates_.speed(rates_.length(machine_, i)), i); });
      add(RateKind::kWinchAcceleration, i, [&] { return size(rates_.acceleration(rates_.length(machine_, i))); });
    }
    const auto no_more_than = [&](const Ball& x, Ball Fastest::*than) { return most_ ? no_more(x, *most_.*than) : x; };
    const Vector3<SecondJet> load_point = rates_.point(machine_.load_point);
    add(RateKind::kLoadSpeed, 0,
        [&] { return no_more_than(length_range(rates_.velocity(load_point)), &Fastest::load); });
    add(RateKind::kLoadAcceleration, 0, [&] { return length_range(rates_.acceleration(load_point)); });
    add(RateKind::kLoadAngularSpeed, 0, [&] { return no_more_than(length_range(rates_.spin), &Fastest::spin); });
    add(RateKind::kLoadAngularAcceleration, 0, [&] { return length_range(rates_.spin_change); });
    return result;
  }

 private:
  static Ball size(const Ball& x) { return hull(least_magnitude(x), magnitude(x)); }
  static Ball no_more(const Ball& x, const Ball& than) {
    return certainly_positive(highest(x) - than) ? hull(lowest(x), than) : x;
  }
  [[nodiscard]] Ball fast(const Ball& speed, std::size_t cable) const {
    return most_ ? no_more(size(speed), most_->winch[cable]) : size(speed);
  }

  const Machine& machine_;
  const Problem& problem_;
  const std::optional<Fastest>& most_;
  Rates rates_;
};

enum class Half { kFirst, kSecond };
/// The guess for a half of a box, in the u of that half; the kernel proves it like any other.
void take_half(std::optional<NearZero>& near, Half half) {
  if (!near) return;
  for (std::size_t i = 0; i < near->at.size(); ++i) {
    near->slope[i] /= 2;
    near->at[i] += half == Half::kFirst ? -near->slope[i] : near->slope[i];
  }
}

/// Whether all limits but those of power are shown to be kept over a box, or over all parts of it.
bool are_kept(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box,
              const OnBox& on_box, int halvings) {
  const auto keeps = [&](const Speed& speed) {
    return std::ranges::all_of(AtSpeed(machine, problem, on_box, speed).margins(),
                               [](const RateMargin& margin) { return certainly_positive(margin.value); });
  };
  if (std::ranges::all_of(extreme_speeds(problem, on_box.law), keeps)) return true;
  if (halvings == 0) return false;
  Box first = box, second = box;
  first.end = second.begin = (box.begin + box.end) / 2;
  take_half(first.near, Half::kFirst);
  take_half(second.near, Half::kSecond);
  return std::ranges::all_of(std::array{&first, &second}, [&](const Box* half) {
    return are_kept(machine, problem, path, k, *half, OnBox(machine, problem, path, k, *half), halvings - 1);
  });
}

}  // namespace

Ball rate_limit(const Problem& problem, RateKind kind, std::size_t cable) {
  return problem.time.value().of(kind, cable).value().evaluate<MeanValueForm>({}).range();
}

Moving moving(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box,
              const std::optional<Slowing>& slowing) {
  const OnBox on_box(machine, problem, path, k, box);
  const AtSpeed at_speed(machine, problem, on_box, speed_of(problem, on_box.law, slowing));
  Moving result = at_speed.moving();
  result.margins = at_speed.margins();
  return result;
}

Vector6<Ball> inertia_of_deviant(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                                 const Box& box, const std::optional<Slowing>& slowing, const Frame& pose) {
  const OnBox on_box(machine, problem, path, k, box);
  const Rates rates(at_pose(on_box.frame, pose), speed_of(problem, on_box.law, slowing));
  return inertia(machine, problem, rates).inertia;
}

std::vector<Moving> moving_within_limits(const Machine& machine, const Problem& problem, const Path& path,
                                         std::size_t k, const Box& box) {
  constexpr int kHalvings = 7;  // of the box; what takes more is next to a limit
  const OnBox on_box(machine, problem, path, k, box);
  if (!are_kept(machine, problem, path, k, box, on_box, kHalvings)) {
    throw Undefined("a limit of speeds or accelerations may not be kept");
  }
  std::vector<Moving> result;
  for (const Speed& speed : extreme_speeds(problem, on_box.law)) {
    result.push_back(AtSpeed(machine, problem, on_box, speed).moving());
  }
  return result;
}

}  // namespace taut::checker
