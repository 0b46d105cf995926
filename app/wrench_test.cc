// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/wrench_test.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinematics/geometry.h"
#include "kinematics/loads.h"
#include "kinematics/move_sampler.h"
#include "problem/expression.h"
#include "reports/summary/numbers.h"

namespace taut {
namespace {

using Vector = Vector3<double>;
using Wrench = Vector6<double>;
using Kind = LoadModel<double>::Kind;
using Shape = LoadModel<double>::Shape;

/// Of all that is summed here, far more than it is rounded by.
constexpr double kNoiseOfRounding = 1e-9;

Vector direction_of(const Vector& v) {
  const double size = v.norm();
  return size > 0 ? Vector(v / size) : Vector::Zero();
}

Wrench wrench_of(const Vector& force, const Vector& moment) {
  Wrench w;
  w << force, moment;
  return w;
}

/// The greatest force of an item of forces or moments.
double greatest(const LoadModel<double>::Item& item) {
  return item.shape == Shape::kSegment ? std::abs(item.nominal + item.offset) + item.radius : item.radius;
}

/// The vector of its set that is farthest along g. @param direction  of the item, in the axes of W
Vector farthest(const LoadModel<double>::Item& item, const Vector& direction, const Vector& g) {
  switch (item.shape) {
    case Shape::kBall: return item.radius * direction_of(g);
    case Shape::kDisc: return item.radius * direction_of(g - g.dot(direction) * direction);
    case Shape::kSegment:
      return (item.nominal + item.offset + (g.dot(direction) < 0 ? -item.radius : item.radius)) * direction;
    case Shape::kPoint: break;
  }
  return Vector::Zero();
}

/// The wrench of an item that is farthest along (y_force, y_moment).
Wrench farthest(const LoadModel<double>::Item& item, const LoadsAtPose<double>::Item& here, const Vector& y_force,
                const Vector& y_moment) {
  switch (item.kind) {
    case Kind::kWeight: {
      const Vector offset = item.reach * direction_of(here.direction.cross(y_moment));
      const Wrench pull = wrench_of(here.direction, (here.lever + offset).cross(here.direction));
      const double along = y_force.dot(pull.head<3>()) + y_moment.dot(pull.tail<3>());
      return (item.nominal + (along < 0 ? -item.radius : item.radius)) * pull;
    }
    case Kind::kForce: {
      const Vector force = farthest(item, here.direction, y_force + y_moment.cross(here.lever));
      return wrench_of(force, here.lever.cross(force));
    }
    case Kind::kMoment: return wrench_of(Vector::Zero(), farthest(item, here.direction, y_moment));
    case Kind::kCases: break;
  }
  const Wrench y = wrench_of(y_force, y_moment);
  const auto most = std::ranges::max_element(here.deviations, {}, [&](const Wrench& w) { return y.dot(w); });
  return here.line + *most;
}

double numbers_of(const DecimalText& text) { return nearest_double(text); }

}  // namespace

ToleranceNumbers tolerance_numbers(const Problem& problem) {
  ToleranceNumbers result;
  if (!problem.tolerances) return result;
  const TolerancesText& text = *problem.tolerances;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.base_anchor[i] = numbers_of(text.base_anchor_m[i]);
    result.platform_anchor[i] = numbers_of(text.platform_anchor_m[i]);
  }
  result.position = numbers_of(text.position_m);
  result.orientation = evaluate_constant<double>(text.orientation_rad);
  result.load_point = numbers_of(text.load_point_m);
  for (int k = 0; k < 6; ++k) result.wrench(k) = numbers_of(text.wrench[static_cast<std::size_t>(k)]);
  if (text.cable_length_m) {
    result.cable_length.emplace();
    std::ranges::transform(*text.cable_length_m, result.cable_length->begin(), numbers_of);
  }
  return result;
}

/// T as it is known by the point of it that is farthest in a direction.
struct WrenchTest::Set {
  const WrenchTest& test;
  const LoadsAtPose<double>& loads;
  const Inertia& inertia;
  const Matrix6<double>& jacobian;
  double tension_error, force, moment;  ///< the radii of D

  [[nodiscard]] Wrench nominal() const { return test.model_.wrench + loads.nominal - inertia.middle; }

  [[nodiscard]] Wrench farthest(const Wrench& y) const {
    const Vector y_force = y.head<3>(), y_moment = y.tail<3>();
    Wrench sum = test.model_.wrench - inertia.middle;
    for (std::size_t n = 0; n < test.model_.loads.items.size(); ++n) {
      sum += taut::farthest(test.model_.loads.items[n], loads.items[n], y_force, y_moment);
    }
    if (test.model_.has_ellipsoid) {
      const Wrench along = test.model_.ellipsoid_root.triangularView<Eigen::Upper>().transpose() * y;
      const double size = along.norm();
      if (size > 0) sum += test.model_.ellipsoid_root.triangularView<Eigen::Upper>() * (along / size);
    }
    for (int k = 0; k < 6; ++k) {
      sum(k) += y(k) < 0 ? -inertia.half_width(k) : inertia.half_width(k);
    }
    sum += (y.dot(test.tolerances_.wrench) < 0 ? -1.0 : 1.0) * test.tolerances_.wrench;
    for (int i = 0; i < kCables; ++i) {
      const Wrench column = jacobian.col(i);
      sum += (y.dot(column) < 0 ? -tension_error : tension_error) * column;
    }
    return sum + wrench_of(force * direction_of(y_force), moment * direction_of(y_moment));
  }
};

WrenchTest::WrenchTest(const Problem& problem)
    : model_(make_model<double>(problem)), load_(problem.load), tolerances_(tolerance_numbers(problem)) {
  reach_ = model_.characteristic_length;
  for (const auto& item : model_.loads.items) {
    const double lever = item.lever.norm();
    const bool turns = item.axes == Axes::kPlatform;
    switch (item.kind) {
      case Kind::kWeight: turn_effect_.moment += (item.nominal + item.radius) * item.direction.norm() * lever; break;
      case Kind::kForce:
        turn_effect_.moment += greatest(item) * lever;
        if (turns) turn_effect_.force += greatest(item);
        break;
      case Kind::kMoment:
        if (turns) turn_effect_.moment += greatest(item);
        break;
      case Kind::kCases: {
        double force = 0, moment = 0;
        for (const Wrench& deviation : item.deviations) {
          const Wrench w = item.mean + deviation;
          force = std::max(force, w.head<3>().norm());
          moment = std::max(moment, w.tail<3>().norm());
        }
        turn_effect_.moment += force * lever;
        if (turns) turn_effect_.force += force;
        if (turns) turn_effect_.moment += moment;
        break;
      }
    }
  }
  if (!problem.time) return;
  rates_.emplace(problem);
  bodies_ = make_moving_bodies<double>(problem.load);
  for (const LoadItem& item : problem.load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (weight == nullptr) continue;
    const double lower = from_rational<double>(weight->mass_lower), upper = from_rational<double>(weight->mass_upper);
    body_ranges_.push_back({0.5 * (upper - lower), from_rational<double>(weight->at_tolerance)});
  }
  may_stop_ = problem.time->stopping_time_s.has_value();
  if (may_stop_) slowing_ = 1 / evaluate_constant<double>(*problem.time->stopping_time_s);
}

WrenchTest::Inertia WrenchTest::inertia_at(const Path& path, const std::vector<double>& places) const {
  Inertia result;
  if (!path.timing || !rates_) return result;
  Wrench least = Wrench::Constant(std::numeric_limits<double>::infinity()), most = -least;
  Wrench least_by_law = least, most_by_law = most;
  for (const double s : places) {
    const LawPoint law = at_time(*path.timing, MoveSampler::time_of(*path.timing, s));
    const auto k = std::min(static_cast<std::size_t>(std::max(s, 0.0)), path.segments() - 1);
    const PathRates<double> along = rates_->at(path.segment(k), s - static_cast<double>(k));
    const Rates<double> rates = by_time(along, law.rate, law.acceleration);
    const Wrench full = inertial_wrench(bodies_, along.r_WP, rates);
    Wrench low = full, high = full;
    double slowing = 0;
    if (may_stop_) {  // of s = σ(τ(t)): w_in τ'² and what τ'' adds
      const Wrench braked = inertial_wrench(bodies_, along.r_WP, by_time(along, 0.0, law.rate)).cwiseAbs() * slowing_;
      low = full.cwiseMin(0.0) - braked;
      high = full.cwiseMax(0.0) + braked;
      slowing = slowing_ * law.rate;
    }
    least_by_law = least_by_law.cwiseMin(full);
    most_by_law = most_by_law.cwiseMax(full);
    least = least.cwiseMin(low);
    most = most.cwiseMax(high);
    const double spin = rates.angular_velocity.norm();
    const double turning = rates.angular_acceleration.norm() + slowing * along.w.norm() + spin * spin;
    double force = 0, moment = 0, force_turn = 0, moment_turn = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const MovingBody<double>& body = bodies_[b];
      const auto [mass_off, reach] = body_ranges_[b];
      const double greatest_mass = body.mass + mass_off, lever = body.p_MC.norm();
      const double acceleration = acceleration_at(rates, turned(along.r_WP, body.p_PC)).norm() +
                                  slowing * (along.p1.norm() + along.w.norm() * body.p_PC.norm());
      const double inertia = body.inertia.norm() / std::max(body.mass, 1e-300) * greatest_mass;
      const double inertia_off = body.inertia.norm() / std::max(body.mass, 1e-300) * mass_off;
      force += mass_off * acceleration + greatest_mass * reach * turning;
      moment += mass_off * acceleration * lever + inertia_off * turning +
                greatest_mass * (reach * acceleration + (lever + reach) * reach * turning);
      force_turn += greatest_mass * (body.p_PC.norm() + reach) * turning;
      moment_turn += greatest_mass * (lever + reach) * (acceleration + 2 * (body.p_PC.norm() + reach) * turning) +
                     2 * inertia * turning;
    }
    result.force = std::max(result.force, force);
    result.moment = std::max(result.moment, moment);
    result.force_turn = std::max(result.force_turn, force_turn);
    result.moment_turn = std::max(result.moment_turn, moment_turn);
    if (s == places.front()) result.acceleration = acceleration_at(rates, turned(along.r_WP, model_.p_PM));
  }
  // The places between these differ by less than these do from each other.
  result.middle = 0.5 * (least + most);
  result.half_width = 0.5 * (most - least) + 0.5 * (most_by_law - least_by_law);
  if (places.size() > 1) {
    constexpr double kBetween = 1.1;
    for (double* radius : {&result.force, &result.moment, &result.force_turn, &result.moment_turn}) {
      *radius *= kBetween;
    }
  }
  return result;
}

WrenchVerdict WrenchTest::judge(const Path& path, const Place& place, const std::array<double, kCables>& tension,
                                double tension_error) const {
  const Matrix3<double> r_WP = place.pose.q.toRotationMatrix();
  const CableGeometry<double> geometry = cable_geometry(model_, place.pose.p, r_WP);
  const LoadsAtPose<double> loads = loads_at(model_.loads, r_WP);
  const Inertia inertia = inertia_at(path, place.places);

  Matrix6<double> jacobian;
  double force = turn_effect_.force * place.turn_off + inertia.force + inertia.force_turn * place.commanded_turn;
  double moment = turn_effect_.moment * place.turn_off + inertia.moment + inertia.moment_turn * place.commanded_turn;
  Wrench measured = Wrench::Zero();
  double size = model_.wrench.head<3>().norm();
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto column = static_cast<int>(i);
    const double length = geometry.p_AB_W[i].norm();
    jacobian.col(column) = geometry.force_density.col(column) / length;
    measured += tension[i] * jacobian.col(column);
    // The real cable's ends are within `ends` of where they are here, so that its direction is within `tilt`.
    const double arm = model_.p_MB[i].norm();
    const double ends = place.position_off + place.turn_off * (model_.p_PB[i].norm() + tolerances_.platform_anchor[i]) +
                        tolerances_.platform_anchor[i] + tolerances_.base_anchor[i];
    const double tilt = ends < length ? std::min(2.0, 2 * ends / (2 * length - ends)) : 2.0;
    const double arm_off = place.turn_off * arm + tolerances_.platform_anchor[i] + tolerances_.load_point;
    const double pull = std::abs(tension[i]) + tension_error;
    force += pull * tilt;
    moment += pull * (arm_off + arm * tilt);
    size += pull;
  }
  force += kNoiseOfRounding * size;
  moment += kNoiseOfRounding * size * reach_;

  const Set set{*this, loads, inertia, jacobian, tension_error, force, moment};
  // With moments over reach_, all in newtons; y there is what multiplies such numbers.
  Wrench scale = Wrench::Ones();
  scale.tail<3>().setConstant(1 / reach_);
  const Wrench nominal = set.nominal();
  const Wrench off = (measured - nominal).cwiseProduct(scale);
  WrenchVerdict verdict;
  Wrench nearest = Wrench::Zero();  // of T − nominal, scaled
  constexpr int kMostSteps = 40;
  for (int step = 0; step < kMostSteps; ++step) {
    const Wrench y = off - nearest;
    const double distance = y.norm();
    if (!(distance > kNoiseOfRounding * size)) break;
    const Wrench point = (set.farthest(y.cwiseProduct(scale)) - nominal).cwiseProduct(scale);
    const double reached = y.dot(off), most = y.dot(point);
    const double share = reached / std::max(most, std::numeric_limits<double>::min());
    if (share > verdict.share) {
      verdict.share = share;
      verdict.residual = reached / distance;
      verdict.allowed = most / distance;
    }
    const Wrench way = point - nearest;
    const double square = way.squaredNorm();
    if (!(square > 0)) break;
    nearest += std::clamp(y.dot(way) / square, 0.0, 1.0) * way;
  }
  verdict.is_outside = verdict.share > 1;
  if (verdict.is_outside) verdict.guess = guess(measured - nominal, r_WP, inertia.acceleration);
  return verdict;
}

std::optional<LoadGuess> WrenchTest::guess(const Wrench& residual, const Matrix3<double>& r_WP,
                                           const Vector& acceleration) const {
  const auto size = [&](const Wrench& w) { return std::hypot(w.head<3>().norm(), w.tail<3>().norm() / reach_); };
  const auto dot = [&](const Wrench& a, const Wrench& b) {
    return a.head<3>().dot(b.head<3>()) + a.tail<3>().dot(b.tail<3>()) / (reach_ * reach_);
  };
  // A force or a moment in any direction, which has three numbers to choose, has to explain more than a mass; where a
  // mass explains nearly all, it is that.
  constexpr double kMostLeft = 0.5, kHardlyAny = 0.15, kPenalty = 2;
  std::optional<LoadGuess> best;
  const double whole = size(residual);
  double least = kMostLeft * whole;
  // What explains about as much is guessed by which is known less well.
  std::vector<std::size_t> order(load_.items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t n) { return model_.loads.items[n].radius; });
  constexpr double kAsMuch = 0.02;
  const auto consider = [&](const std::string& item, LoadGuess::Kind kind, double amount, double left) {
    if (!(left < least - (best ? kAsMuch * whole : 0.0))) return;
    least = left;
    best = LoadGuess{item, kind, amount};
  };
  for (const bool of_masses : {true, false}) {
    if (!of_masses && best && least <= kHardlyAny * whole) break;
    for (const std::size_t n : order) {
      const auto& item = model_.loads.items[n];
      const std::string& name = load_.items[n].name;
      const Vector lever = r_WP * item.lever;
      if ((item.kind == Kind::kWeight) != of_masses) continue;
      if (item.kind == Kind::kWeight) {
        const Vector pull = item.direction - acceleration;
        const Wrench of_mass = wrench_of(pull, lever.cross(pull));
        const double square = dot(of_mass, of_mass);
        if (!(square > 0)) continue;
        const double mass = dot(of_mass, residual) / square;
        consider(name, LoadGuess::Kind::kMass, mass, size(residual - mass * of_mass));
      } else if (item.kind == Kind::kForce) {
        // The force at that point which leaves least of the residual.
        Matrix3<double> cross;
        cross << 0, -lever(2), lever(1), lever(2), 0, -lever(0), -lever(1), lever(0), 0;
        const double share = 1 / (reach_ * reach_);
        const Matrix3<double> normal = Matrix3<double>::Identity() + share * cross.transpose() * cross;
        const Vector right = residual.head<3>() + share * cross.transpose() * residual.tail<3>();
        const Vector force = normal.inverse() * right;
        consider(name, LoadGuess::Kind::kForce, force.norm(),
                 kPenalty * size(residual - wrench_of(force, lever.cross(force))));
      } else if (item.kind == Kind::kMoment) {
        const Vector moment = residual.tail<3>();
        consider(name, LoadGuess::Kind::kMoment, moment.norm(),
                 kPenalty * size(residual - wrench_of(Vector::Zero(), moment)));
      }
    }
  }
  return best;
}

}  // namespace taut
