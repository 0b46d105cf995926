// SPDX-License-Identifier: GPL-3.0-or-later
// Newton and Euler for the campaign of moves: what a machine (machine.h) does at a time of a move along a segment.
//
// The load's weights are particles. Places are differentiated by differences: from the platform's poses a little before
// and after, on the same piece of the law, where everything is smooth. A particle's place is linear in p and R, so that
// the differences of these are those of all particles. No derivative is written down, no interval, none of kinematics/.
// In double it searches, in BigFloat it judges.
//
// Errors of BigFloat: a second difference with h = r times the law's step has an error of at most
//   8 · 2^-bits |x|/h² + h² M/12,
// |x| the size of what is differentiated and M that of its fourth derivative by time. In units of |x| and of the law's
// step, M is below 1e4 for the moves of the campaign (their law is a cubic between controls at most 1 apart, their
// poses are trigonometric functions of polynomials), and with r = 1e-20 and 256 bits the error below 1e-35. Statics
// magnify it by the condition of J, which trials next to singular poses take to 1e9 or so: 1e-25 is left to it. So
// much the campaign tolerates, and holds the oracle to it by 400 bits with r = 1e-40 (--compare).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/time_limits.h"
#include "tests/soundness/limits.h"

namespace taut::campaign {

// ---- What is limited ------------------------------------------------------------------------------------------------

/// Margins (limits.h), then the six of each rate of winches, then the rates of the load.
inline constexpr std::size_t kRates = 3 * kCables + 4;
inline constexpr std::size_t kQuantities = kMargins + kRates;

inline bool is_rate(std::size_t id) { return id >= kMargins; }
/// @pre is_rate(id)
inline RateId rate_id(std::size_t id) {
  const std::size_t k = id - kMargins;
  if (k < 3 * kCables) return {kRateKinds[k / kCables], static_cast<int>(k % kCables)};
  return {kRateKinds[3 + k - 3 * kCables], 0};
}
inline bool is_power(std::size_t id) { return is_rate(id) && rate_id(id).kind == RateKind::kWinchPower; }
inline bool is_upper(std::size_t id) { return is_rate(id) || is_upper(margin_id(id).kind); }
inline std::string quantity_name(std::size_t id) {
  return is_rate(id) ? fmt::format("{} {}", name(rate_id(id).kind), rate_id(id).cable + 1)
                     : fmt::format("{} {}", name(margin_id(id).kind), margin_id(id).cable + 1);
}

inline TimeText::Limit& rate_limit(TimeText& time, RateId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case RateKind::kWinchSpeed: return time.winch_speed_m_s[i];
    case RateKind::kWinchAcceleration: return time.winch_acceleration_m_s2[i];
    case RateKind::kWinchPower: return time.winch_power_W[i];
    case RateKind::kLoadSpeed: return time.load_speed_m_s;
    case RateKind::kLoadAcceleration: return time.load_acceleration_m_s2;
    case RateKind::kLoadAngularSpeed: return time.load_angular_speed_rad_s;
    case RateKind::kLoadAngularAcceleration: break;
  }
  return time.load_angular_acceleration_rad_s2;
}

/// How far a value is from its limit; huge where there is none.
template <class S>
class AllLimits {
 public:
  explicit AllLimits(Problem problem) : limits_(problem) {
    for (std::size_t id = kMargins; id < kQuantities; ++id) {
      if (const auto& text = rate_limit(problem.time.value(), rate_id(id))) most_[id - kMargins] = number<S>(*text);
    }
  }
  [[nodiscard]] S margin(const S& value, std::size_t id) const {
    if (!is_rate(id)) return limits_.margin(value, margin_id(id));
    const auto& most = most_[id - kMargins];
    return most ? *most - value : S(1e300);
  }

 private:
  LimitsOf<S> limits_;
  std::array<std::optional<S>, kRates> most_;
};

// ---- The load's mass ------------------------------------------------------------------------------------------------

/// Which of the masses and centres of gravity that it may have a weight has.
struct WeightAs {
  double mass = 0.5;     ///< in [0, 1], of the range
  Vec<double> offset{};  ///< in the unit ball, of the tolerance
};
/// What may be chosen while a move is run.
struct Choice {
  std::vector<WeightAs> weights;
  double share = 1, change = 0;  ///< it is slowed down: τ', and τ'' times the stopping time
};

template <class S>
struct Particle {
  Vec<S> at;
  S mass;
};

template <class S>
class Bodies {
 public:
  /// @param error  all masses are larger by this share, which is to be found out
  Bodies(const Problem& problem, double error) : scale_(S(1.0) + S(error)) {
    for (const LoadItem& item : problem.load.items) {
      const auto* weight = std::get_if<Weight>(&item.what);
      if (weight == nullptr) continue;
      bodies_.push_back({number<S>(weight->mass_lower),
                         number<S>(weight->mass_upper),
                         numbers<S>(weight->at),
                         number<S>(weight->at_tolerance),
                         {}});
      if (weight->inertia_box) bodies_.back().box = numbers<S>(*weight->inertia_box);
    }
  }
  [[nodiscard]] std::size_t size() const { return bodies_.size(); }

  /// Of the same masses, centres of gravity and inertias: a corner of a box is at ± side/√12.
  [[nodiscard]] std::vector<Particle<S>> particles(const Choice& as) const {
    std::vector<Particle<S>> result;
    for (std::size_t n = 0; n < bodies_.size(); ++n) {
      const Body& body = bodies_[n];
      const S mass = scale_ * (body.least + S(as.weights[n].mass) * (body.most - body.least));
      const Vec<S> centre = body.at + scaled(body.reach, as.weights[n].offset);
      if (!body.box) {
        result.push_back({centre, mass});
        continue;
      }
      const Vec<S> half = (S(1.0) / root(S(12.0))) * *body.box;
      for (unsigned corner = 0; corner < 8; ++corner) {
        Vec<S> at = centre;
        for (std::size_t k = 0; k < 3; ++k) at[k] = (corner >> k & 1U) != 0 ? at[k] + half[k] : at[k] - half[k];
        result.push_back({at, mass / S(8.0)});
      }
    }
    return result;
  }

 private:
  struct Body {
    S least, most;
    Vec<S> at;
    S reach;
    std::optional<Vec<S>> box;
  };
  std::vector<Body> bodies_;
  S scale_;
};

// ---- The move -------------------------------------------------------------------------------------------------------

/// σ at a time, by the polynomial of a piece.
template <class S>
S law_at(const TimeLaw& law, std::size_t piece, const S& t) {
  const S one(1.0), three(3.0), u = t / S(law.step_s) - S(static_cast<double>(piece)), v = one - u;
  const auto c = [&](std::size_t i) { return S(law.controls[piece + i]); };
  return (v * v * v * c(0) + (three * u * u * u - S(6.0) * u * u + S(4.0)) * c(1) +
          (three * (u + u * u - u * u * u) + one) * c(2) + u * u * u * c(3)) /
         S(6.0);
}
template <class S>
std::size_t piece_at(const TimeLaw& law, const S& t) {
  return static_cast<std::size_t>(
      std::clamp(std::floor(to_double(S(t / S(law.step_s)))), 0.0, static_cast<double>(law.pieces() - 1)));
}
template <class S>
S law_at(const TimeLaw& law, const S& t) {
  return law_at(law, piece_at(law, t), t);
}

/// The first time at which σ is s, to 2^-halvings of the move.
template <class S>
S time_of(const TimeLaw& law, const S& s, int halvings) {
  S from(0.0), to = S(law.step_s) * S(static_cast<double>(law.pieces()));
  for (int k = 0; k < halvings; ++k) {
    const S middle = (from + to) / S(2.0);
    (law_at(law, middle) < s ? from : to) = middle;
  }
  return to;
}

template <class S>
Rows<S> transpose(const Rows<S>& r) {
  return {Vec<S>{r[0][0], r[1][0], r[2][0]}, Vec<S>{r[0][1], r[1][1], r[2][1]}, Vec<S>{r[0][2], r[1][2], r[2][2]}};
}

/// At one time: the commanded pose, the first and second differences of p and R, and those of the cables' lengths.
template <class S>
struct Instant {
  S place;  ///< on the segment
  RigidPose<S> pose;
  Vec<S> p1, p2;
  Rows<S> r1, r2;
  Six<S> speed, acceleration;  ///< of lengths, of the machine as typed

  /// The same rates in W of a platform that is elsewhere, and turned.
  [[nodiscard]] Instant moved_to(const RigidPose<S>& to) const {
    Instant result = *this;
    const Rows<S> turned = transpose(pose.r) * to.r;
    result.pose = to;
    result.r1 = r1 * turned;
    result.r2 = r2 * turned;
    return result;
  }
  /// Of the same place, passed at a share τ' of its speed, which changes at the rate τ''.
  [[nodiscard]] Instant slowed(const S& share, const S& change) const {
    const auto second = [&](const S& a, const S& b) -> S { return share * share * b + change * a; };
    Instant result = *this;
    for (std::size_t i = 0; i < 3; ++i) {
      result.p1[i] = share * p1[i];
      result.p2[i] = second(p1[i], p2[i]);
      for (std::size_t j = 0; j < 3; ++j) {
        result.r1[i][j] = share * r1[i][j];
        result.r2[i][j] = second(r1[i][j], r2[i][j]);
      }
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      result.speed[i] = share * speed[i];
      result.acceleration[i] = second(speed[i], acceleration[i]);
    }
    return result;
  }
};

/// Of a machine that is held by lengths: it finds none next to the commanded pose.
class NoPose : public std::exception {};

template <class S>
class Simulation {
 public:
  /// Of a segment of a path, whose control points are the trial's. Refers to trial and law.
  /// @param difference  h, in steps of the law
  Simulation(const Trial& trial, const TimeLaw& law, std::size_t segment, double mass_error, const S& difference)
      : law_(law),
        segment_(S(static_cast<double>(segment))),
        h_(difference * S(law.step_s)),
        motion_(trial),
        machine_(make_machine<S>(trial.problem)),
        tolerances_(make_tolerances<S>(trial.problem)),
        bodies_(trial.problem, mass_error) {
    if (const auto& within = trial.problem.time->stopping_time_s) slowing_ = S(1.0) / number<S>(*within);
  }

  [[nodiscard]] const Bodies<S>& bodies() const { return bodies_; }
  [[nodiscard]] const Motion<S>& motion() const { return motion_; }
  [[nodiscard]] S place(const S& t) const { return law_at(law_, t) - segment_; }
  [[nodiscard]] S time(const S& s, int halvings) const { return time_of(law_, S(segment_ + s), halvings); }

  [[nodiscard]] Instant<S> at(const S& t, const Choice& as) const {
    return by_law(t).slowed(S(as.share), S(as.change) * slowing_);
  }
  [[nodiscard]] Instant<S> by_law(const S& t) const {
    const std::size_t piece = piece_at(law_, t);
    const auto pose = [&](const S& time) { return motion_.reference(law_at(law_, piece, time) - segment_); };
    const RigidPose<S> before = pose(t - h_), now = pose(t), after = pose(t + h_);
    const S twice = h_ + h_, square = h_ * h_;
    const auto first = [&](const S& a, const S& b) -> S { return (b - a) / twice; };
    const auto second = [&](const S& a, const S& x, const S& b) -> S { return (a - x - (x - b)) / square; };
    Instant<S> result;
    result.place = law_at(law_, piece, t) - segment_;
    result.pose = now;
    for (std::size_t i = 0; i < 3; ++i) {
      result.p1[i] = first(before.p[i], after.p[i]);
      result.p2[i] = second(before.p[i], now.p[i], after.p[i]);
      for (std::size_t j = 0; j < 3; ++j) {
        result.r1[i][j] = first(before.r[i][j], after.r[i][j]);
        result.r2[i][j] = second(before.r[i][j], now.r[i][j], after.r[i][j]);
      }
    }
    const Six<S> a = lengths(machine_, before), x = lengths(machine_, now), b = lengths(machine_, after);
    for (std::size_t i = 0; i < kCables; ++i) {
      result.speed[i] = first(a[i], b[i]);
      result.acceleration[i] = second(a[i], x[i], b[i]);
    }
    return result;
  }

  /// The machine and pose as they are, with what the load's mass asks for taken from the wrench.
  [[nodiscard]] MachineAt<S> machine_at(const Instant<S>& commanded, const Deviation& x, const Choice& as) const {
    const std::optional<RigidPose<S>> pose = motion_.pose(commanded.place, x);
    if (!pose) throw NoPose();
    return with_inertia({deviate(machine_, tolerances_, x), *pose}, commanded, as);
  }
  [[nodiscard]] MachineAt<S> with_inertia(MachineAt<S> at, const Instant<S>& commanded, const Choice& as) const {
    const Instant<S> x = commanded.moved_to(at.pose);
    for (const Particle<S>& particle : bodies_.particles(as)) {
      const Vec<S> force = particle.mass * (x.p2 + x.r2 * particle.at);
      const Vec<S> moment = cross(Vec<S>(x.pose.r * (particle.at - at.machine.load_point)), force);
      for (std::size_t k = 0; k < 3; ++k) {
        at.machine.wrench[k] = at.machine.wrench[k] - force[k];
        at.machine.wrench[3 + k] = at.machine.wrench[3 + k] - moment[k];
      }
    }
    return at;
  }

  /// @param at  of the same time
  [[nodiscard]] S quantity(const Instant<S>& commanded, const MachineAt<S>& at, std::size_t id) const {
    if (!is_rate(id)) {
      const MarginId margin = margin_id(id);
      const auto i = static_cast<std::size_t>(margin.cable);
      if (!is_tension(margin.kind)) return lengths(at.machine, at.pose)[i];
      const Range<S> range = tension_range(at.machine, at.pose, i);
      return campaign::is_upper(margin.kind) ? range.high : range.low;
    }
    if (!is_power(id)) return rate(commanded, rate_id(id));
    const auto i = static_cast<std::size_t>(rate_id(id).cable);
    return magnitude(commanded.speed[i]) * magnitude(tension_range(at.machine, at.pose, i).high);
  }
  [[nodiscard]] S quantity(const S& t, const Deviation& x, const Choice& as, std::size_t id) const {
    const Instant<S> commanded = this->at(t, as);
    return quantity(commanded, machine_at(commanded, x, as), id);
  }

  struct All {
    std::array<S, kQuantities> value;
    S determinant;
  };
  [[nodiscard]] All quantities(const S& t, const Deviation& x, const Choice& as) const {
    const Instant<S> commanded = this->at(t, as);
    const MachineAt<S> at = machine_at(commanded, x, as);
    const StaticsAt<S> statics = campaign::statics(at.machine, at.pose);
    All all;
    all.determinant = statics.determinant;
    for (std::size_t id = 0; id < kQuantities; ++id) {
      if (!is_rate(id)) {
        all.value[id] = campaign::quantity(statics, margin_id(id));
      } else if (is_power(id)) {
        const auto i = static_cast<std::size_t>(rate_id(id).cable);
        all.value[id] = magnitude(commanded.speed[i]) * magnitude(statics.tension_high[i]);
      } else {
        all.value[id] = rate(commanded, rate_id(id));
      }
    }
    return all;
  }

 private:
  /// Of the machine as typed. @pre not of power
  [[nodiscard]] S rate(const Instant<S>& x, RateId id) const {
    const auto size = [](const Vec<S>& v) -> S { return root(dot(v, v)); };
    // Of [w] = R' R^T, and likewise of its derivative, what is antisymmetric.
    const auto axis = [&](const Rows<S>& derivative) {
      const Rows<S> w = derivative * transpose(x.pose.r);
      return Vec<S>{(w[2][1] - w[1][2]) / S(2.0), (w[0][2] - w[2][0]) / S(2.0), (w[1][0] - w[0][1]) / S(2.0)};
    };
    switch (id.kind) {
      case RateKind::kWinchSpeed: return magnitude(x.speed[static_cast<std::size_t>(id.cable)]);
      case RateKind::kWinchAcceleration: return magnitude(x.acceleration[static_cast<std::size_t>(id.cable)]);
      case RateKind::kLoadSpeed: return size(x.p1 + x.r1 * machine_.load_point);
      case RateKind::kLoadAcceleration: return size(x.p2 + x.r2 * machine_.load_point);
      case RateKind::kLoadAngularSpeed: return size(axis(x.r1));
      default: return size(axis(x.r2));
    }
  }

  const TimeLaw& law_;
  S segment_, h_;
  Motion<S> motion_;
  Machine<S> machine_;
  Tolerances<S> tolerances_;
  Bodies<S> bodies_;
  S slowing_{0.0};  ///< 1 / the stopping time
};

}  // namespace taut::campaign
