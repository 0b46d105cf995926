// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel's loads are held against: tensions of single loads of each item, by the equations of
// tests/soundness/machine.h, and the loads that are worst for a cable, found by what a tension does when one coordinate
// of a load changes.
#pragma once

#include <random>
#include <vector>

#include "tests/checker/kernel.h"

namespace taut::checker {

using campaign::Rows;
using campaign::Six;
using campaign::SixBySix;
using campaign::Vec;

template <class S>
S number(const mpq_class& x) {
  if constexpr (std::is_same_v<S, double>) {
    return x.get_d();
  } else {
    S result;
    mpfr_set_q(result.get(), x.get_mpq_t(), MPFR_RNDN);
    return result;
  }
}
template <class S>
Vec<S> vector_of(const ExactVector& x) {
  return {number<S>(x[0]), number<S>(x[1]), number<S>(x[2])};
}

/// Row i: what cable i pulls for a unit of each coordinate of the wrench about the load point.
template <class S>
SixBySix<S> responses(campaign::Machine<S> machine, const campaign::RigidPose<S>& pose) {
  SixBySix<S> result;
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t j = 0; j < 6; ++j) machine.wrench[j] = S(j == k ? 1.0 : 0.0);
    const auto at = campaign::statics(machine, pose);
    for (std::size_t i = 0; i < 6; ++i) result[i][k] = (at.tension_low[i] + at.tension_high[i]) / S(2.0);
  }
  return result;
}

/// One load of an item: of a weight the mass and the offset, of a ball or a disc the vector, of a segment the amount,
/// of load cases how much of each.
template <class S>
struct OneLoad {
  S amount = S(0.0);
  Vec<S> vector = {S(0.0), S(0.0), S(0.0)};
  std::vector<S> shares;
};

/// Where a load acts.
template <class S>
struct Platform {
  Rows<S> R;
  Vec<S> load_point;
  Vec<S> gravity;
};

/// The wrench about the load point, in axes of W.
template <class S>
Six<S> wrench_of(const LoadItem& item, const OneLoad<S>& load, const Platform<S>& on) {
  const S zero(0.0);
  Vec<S> F = {zero, zero, zero};
  Vec<S> M = F;
  Vec<S> r = multiply(on.R, vector_of<S>(item.at) - on.load_point);
  if (std::holds_alternative<Weight>(item.set)) {
    F = load.amount * on.gravity;
    r = r + load.vector;
  } else if (const auto* segment = std::get_if<LineSegment>(&item.set)) {
    const Vec<S> e = vector_of<S>(segment->direction);
    (segment->is_moment ? M : F) = (load.amount / campaign::root(dot(e, e))) * e;
  } else if (const auto* round = std::get_if<BallOrDisc>(&item.set)) {
    (round->is_moment ? M : F) = load.vector;
  } else {
    const auto& wrenches = std::get<LoadCases>(item.set).wrenches;
    for (std::size_t j = 0; j < wrenches.size(); ++j) {
      for (std::size_t c = 0; c < 3; ++c) {
        F[c] = F[c] + load.shares[j] * number<S>(wrenches[j][c]);
        M[c] = M[c] + load.shares[j] * number<S>(wrenches[j][3 + c]);
      }
    }
  }
  if (item.axes == Axes::kPlatform) {
    F = multiply(on.R, F);
    M = multiply(on.R, M);
  }
  M = M + cross(r, F);
  return {F[0], F[1], F[2], M[0], M[1], M[2]};
}

template <class S>
S dot_six(const Six<S>& a, const Six<S>& b) {
  S sum(0.0);
  for (std::size_t k = 0; k < 6; ++k) sum = sum + a[k] * b[k];
  return sum;
}

/// Null of a ball.
inline const ExactVector* normal_of(const BallOrDisc& set) { return set.normal ? &*set.normal : nullptr; }

/// The nominal load of an item.
template <class S>
OneLoad<S> nominal_load(const LoadItem& item) {
  OneLoad<S> load;
  if (const auto* weight = std::get_if<Weight>(&item.set)) {
    load.amount = number<S>((weight->mass.lower + weight->mass.upper) / 2);
  } else if (const auto* cases = std::get_if<LoadCases>(&item.set)) {
    load.shares.assign(cases->wrenches.size(), number<S>(mpq_class(1) / cases->wrenches.size()));
  } else if (const auto* segment = std::get_if<LineSegment>(&item.set)) {
    const auto& [lower, upper] = segment->range;
    if (lower > 0 || upper < 0) load.amount = number<S>((lower + upper) / 2);
  }
  return load;
}

/// Loads among which are one with the least and one with the largest y . w.
template <class S>
std::vector<OneLoad<S>> worst_loads(const LoadItem& item, const Six<S>& y, const Platform<S>& on) {
  std::vector<OneLoad<S>> result;
  const auto value = [&](const OneLoad<S>& load) { return dot_six(y, wrench_of(item, load, on)); };
  /// Both ways along the gradient by the vector, at right angles to `normal`.
  const auto both_ways = [&](OneLoad<S> load, const S& radius, const ExactVector* normal) {
    const S rest = value(load);
    Vec<S> up;
    for (std::size_t c = 0; c < 3; ++c) {
      OneLoad<S> moved = load;
      moved.vector[c] = S(1.0);
      up[c] = value(moved) - rest;
    }
    if (normal != nullptr) {
      const Vec<S> n = vector_of<S>(*normal);
      up = up - (dot(up, n) / dot(n, n)) * n;
    }
    const S size = campaign::root(dot(up, up));
    for (const double sign : {-1.0, 1.0}) {
      if (size > S(0.0)) load.vector = (S(sign) * radius / size) * up;
      result.push_back(load);
    }
  };
  if (const auto* weight = std::get_if<Weight>(&item.set)) {
    for (const mpq_class& mass : {weight->mass.lower, weight->mass.upper}) {
      OneLoad<S> load;
      load.amount = number<S>(mass);
      both_ways(load, number<S>(weight->offset), nullptr);
    }
  } else if (const auto* cases = std::get_if<LoadCases>(&item.set)) {
    for (std::size_t j = 0; j < cases->wrenches.size(); ++j) {
      OneLoad<S> load;
      load.shares.assign(cases->wrenches.size(), S(0.0));
      load.shares[j] = S(1.0);
      result.push_back(load);
    }
  } else if (const auto* segment = std::get_if<LineSegment>(&item.set)) {
    for (const mpq_class& f : {segment->range.lower, segment->range.upper}) {
      result.emplace_back();
      result.back().amount = number<S>(f);
    }
  } else {
    const auto& round = std::get<BallOrDisc>(item.set);
    both_ways({}, number<S>(round.radius), normal_of(round));
  }
  return result;
}

/// Any load of the item.
template <class S>
OneLoad<S> random_load(const LoadItem& item, std::mt19937_64& random) {
  OneLoad<S> load;
  const auto between = [&](const Limits& limits) {
    const S share(uniform(random, 0, 1));
    return number<S>(limits.lower) + share * number<S>(limits.upper - limits.lower);
  };
  const auto any_vector = [&](const mpq_class& radius, const ExactVector* normal) {
    Vec<S> v = {S(uniform(random, -1, 1)), S(uniform(random, -1, 1)), S(uniform(random, -1, 1))};
    if (normal != nullptr) {
      const Vec<S> n = vector_of<S>(*normal);
      v = v - (dot(v, n) / dot(n, n)) * n;
    }
    const S reach(random() % 2 == 0 ? 1 : uniform(random, 0, 1));
    load.vector = (reach * number<S>(radius) / campaign::root(dot(v, v))) * v;
  };
  if (const auto* weight = std::get_if<Weight>(&item.set)) {
    load.amount = between(weight->mass);
    any_vector(weight->offset, nullptr);
  } else if (const auto* cases = std::get_if<LoadCases>(&item.set)) {
    S sum(0.0);
    for (std::size_t j = 0; j < cases->wrenches.size(); ++j) {
      load.shares.push_back(S(uniform(random, 0, 1)));
      sum = sum + load.shares[j];
    }
    for (S& share : load.shares) share = share / sum;
  } else if (const auto* segment = std::get_if<LineSegment>(&item.set)) {
    load.amount = between(segment->range);
  } else {
    const auto& round = std::get<BallOrDisc>(item.set);
    any_vector(round.radius, normal_of(round));
  }
  return load;
}

/// The least, the largest and the nominal value of y . w over an item.
template <class S>
struct Extremes {
  S least, most, nominal;
};
template <class S>
Extremes<S> extremes_of(const LoadItem& item, const Six<S>& y, const Platform<S>& on) {
  const S nominal = dot_six(y, wrench_of(item, nominal_load<S>(item), on));
  Extremes<S> result = {nominal, nominal, nominal};
  for (const OneLoad<S>& load : worst_loads(item, y, on)) {
    const S value = dot_six(y, wrench_of(item, load, on));
    if (value < result.least) result.least = value;
    if (value > result.most) result.most = value;
  }
  return result;
}

/// The least, the largest and the nominal tension of each cable over all loads: items, and the machine's ellipsoid,
/// where `problem` has it.
template <class S>
std::array<Extremes<S>, 6> tensions_of(const Problem& problem, campaign::Machine<S> machine,
                                       const campaign::RigidPose<S>& pose) {
  std::array<Extremes<S>, 6> result;
  const Platform<S> on = {pose.r, machine.load_point, vector_of<S>(problem.gravity)};
  const auto ellipsoid = campaign::statics(machine, pose);
  const SixBySix<S> y = responses(machine, pose);
  for (std::size_t i = 0; i < 6; ++i) {
    result[i] = {S(0.0), S(0.0), S(0.0)};
    if (problem.ellipsoid) {
      const S nominal = (ellipsoid.tension_low[i] + ellipsoid.tension_high[i]) / S(2.0);
      result[i] = {ellipsoid.tension_low[i], ellipsoid.tension_high[i], nominal};
    }
    for (const LoadItem& item : problem.items) {
      const Extremes<S> x = extremes_of(item, y[i], on);
      result[i] = {result[i].least + x.least, result[i].most + x.most, result[i].nominal + x.nominal};
    }
  }
  return result;
}

/// A number of few digits between -most and most.
inline mpq_class random_number(std::mt19937_64& random, double most) {
  mpq_class x(static_cast<long>(uniform(random, -1, 1) * most * 36e4), 360'000L);
  x.canonicalize();
  return x;
}
inline ExactVector random_vector(std::mt19937_64& random, double most) {
  ExactVector x;
  do {
    for (mpq_class& c : x) c = random() % 4 == 0 ? mpq_class(0) : random_number(random, most);
  } while (x == ExactVector());
  return x;
}
inline Limits random_limits(std::mt19937_64& random, double most) {
  mpq_class a = random_number(random, most), b = random_number(random, most);
  if (random() % 6 == 0) a = 0;
  if (random() % 6 == 0) b = a;
  return {std::min(a, b), std::max(a, b)};
}

/// An item of any kind, with forces of about `size` N and moments of a tenth of that.
inline LoadItem random_item(std::mt19937_64& random, double size) {
  LoadItem item;
  item.at = random_vector(random, 0.08);
  const auto magnitude = [&](double most) {
    return random() % 6 == 0 ? mpq_class(0) : mpq_class(abs(random_number(random, most)));
  };
  const auto vectors = [&](bool is_moment, double most) -> LoadSet {
    switch (random() % 3) {
      case 0: return BallOrDisc{is_moment, magnitude(most), {}};
      case 1: return BallOrDisc{is_moment, magnitude(most), random_vector(random, 3)};
      default: return LineSegment{is_moment, random_vector(random, 1e-2), random_limits(random, most)};
    }
  };
  if (random() % 2 == 0) item.axes = Axes::kPlatform;
  switch (random() % 4) {
    case 0: {
      Limits mass = random_limits(random, size / 10);
      if (mass.lower < 0) mass = {mpq_class(0), mass.upper - mass.lower};
      item.axes = Axes::kWorld;
      item.set = Weight{mass, magnitude(0.03)};
      break;
    }
    case 1: item.set = vectors(false, size); break;
    case 2: item.set = vectors(true, size / 10); break;
    default: {
      LoadCases cases;
      for (std::size_t k = 1 + random() % 5; k > 0; --k) {
        const ExactVector F = random_vector(random, size), M = random_vector(random, size / 10);
        cases.wrenches.push_back({F[0], F[1], F[2], M[0], M[1], M[2]});
      }
      if (random() % 3 == 0) cases.wrenches.push_back(cases.wrenches.front());  // a tie
      item.set = cases;
    }
  }
  return item;
}

/// The load of a robot, replaced by items, or with items beside its ellipsoid.
inline void give_items(Problem& problem, std::mt19937_64& random, double size, bool keeps_ellipsoid) {
  problem.gravity = random() % 4 == 0 ? random_vector(random, 10) : ExactVector{0, 0, mpq_class(-981, 100)};
  problem.items.clear();
  for (std::size_t k = 1 + random() % 5; k > 0; --k) problem.items.push_back(random_item(random, size));
  if (keeps_ellipsoid) return;
  problem.ellipsoid.reset();
  problem.wrench = ExactWrench();
}

}  // namespace taut::checker
