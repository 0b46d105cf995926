// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/loads.h"

#include <algorithm>

namespace taut::checker {
namespace {

/// v / |v| for each v != 0; where v may be 0, every vector of length up to 1.
Vector3<Ball> direction(const Vector3<Ball>& v) {
  const Ball unit = plus_minus(Ball(1));
  const Ball squared = dot(v, v);
  const Ball length = certainly_positive(squared) ? sqrt(squared) : length_range(v);
  if (!certainly_positive(length)) return {unit, unit, unit};
  const Ball inverse = Ball(1) / length;
  const auto entry = [&](const Ball& x) {
    const Ball result = x * inverse;
    return is_within(result, unit) ? result : intersection(result, unit);
  };
  return {entry(v[0]), entry(v[1]), entry(v[2])};
}

Wrench wrench_of(const Vector3<Ball>& vector, bool is_moment) {
  return is_moment ? Wrench{{}, vector} : Wrench{vector, {}};
}
Wrench wrench_of(const ExactWrench& w) {
  return {{Ball(w[0]), Ball(w[1]), Ball(w[2])}, {Ball(w[3]), Ball(w[4]), Ball(w[5])}};
}
Wrench operator+(const Wrench& a, const Wrench& b) { return {a.force + b.force, a.moment + b.moment}; }

}  // namespace

Load::Load(const LoadItem& item, const ExactVector& load_point, const ExactVector& gravity)
    : turns_(item.axes == Axes::kPlatform) {
  for (std::size_t c = 0; c < 3; ++c) from_load_point_[c] = Ball(mpq_class(item.at[c] - load_point[c]));
  std::visit(Overloaded{[&](const Weight& x) { set(x, gravity); }, [&](const auto& x) { set(x); }}, item.set);
}

void Load::set(const Weight& weight, const ExactVector& gravity) {
  Mass mass = {Ball(weight.mass.lower),
               Ball(weight.mass.upper),
               Ball(mpq_class((weight.mass.lower + weight.mass.upper) / 2)),
               Ball(mpq_class((weight.mass.upper - weight.mass.lower) / 2)),
               balls(gravity),
               Ball(weight.offset)};
  nominal_.force = mass.mean * mass.gravity;
  set_ = std::move(mass);
}

void Load::set(const BallOrDisc& x) {
  Matrix3<Ball> projection;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      mpq_class along_normal;
      if (x.normal) along_normal = (*x.normal)[i] * (*x.normal)[j] / dot(*x.normal, *x.normal);
      projection[i][j] = Ball(mpq_class((i == j ? 1 : 0) - along_normal));
    }
  }
  set_ = Round{Ball(x.radius), projection, x.is_moment};
}

void Load::set(const LineSegment& x) {
  const auto& [lower, upper] = x.range;
  const mpq_class f_n = lower <= 0 && upper >= 0 ? mpq_class(0) : mpq_class((lower + upper) / 2);
  const Vector3<Ball> unit = Ball(1) / sqrt(Ball(dot(x.direction, x.direction))) * balls(x.direction);
  const auto along = [&](const mpq_class& f) { return wrench_of(Ball(f) * unit, x.is_moment); };
  nominal_ = along(f_n);
  set_ = Corners{{along(lower - f_n), along(upper - f_n)}};
}

void Load::set(const LoadCases& cases) {
  ExactWrench mean;
  for (const ExactWrench& w : cases.wrenches) {
    for (std::size_t k = 0; k < 6; ++k) mean[k] += w[k] / cases.wrenches.size();
  }
  nominal_ = wrench_of(mean);
  Corners corners;
  for (ExactWrench w : cases.wrenches) {
    for (std::size_t k = 0; k < 6; ++k) w[k] -= mean[k];
    corners.from_nominal.push_back(wrench_of(w));
  }
  set_ = std::move(corners);
}

Vector6<MeanValueForm> Load::nominal_about_load_point(const Matrix3<MeanValueForm>& R) const {
  const auto in_W = [&](const Vector3<Ball>& x) {
    return turns_ ? multiply(R, x)
                  : Vector3<MeanValueForm>{MeanValueForm(x[0]), MeanValueForm(x[1]), MeanValueForm(x[2])};
  };
  const Vector3<MeanValueForm> F = in_W(nominal_.force);
  const Vector3<MeanValueForm> M = in_W(nominal_.moment) + cross(arm(R), F);
  return {F[0], F[1], F[2], M[0], M[1], M[2]};
}

MeanValueForm Load::above(const Lever<MeanValueForm>& y) const {
  const auto of_mass = [&](const Mass& x) {
    const Vector3<MeanValueForm> gamma = {MeanValueForm(x.gravity[0]), MeanValueForm(x.gravity[1]),
                                          MeanValueForm(x.gravity[2])};
    const MeanValueForm A = dot(x.gravity, y.g);
    const MeanValueForm B = x.offset * norm(cross(gamma, y.m));
    return x.mean * B + x.half_range * absolute(A + B);
  };
  const auto of_round = [&](const Round& x) {
    return x.radius * norm(multiply(x.projection, x.is_moment ? y.m : y.g));
  };
  const auto of_corners = [&](const Corners& x) {
    std::vector<MeanValueForm> values;
    for (const Wrench& w : x.from_nominal) values.push_back(of(y, w));
    return maximum(values);
  };
  return std::visit(Overloaded{of_mass, of_round, of_corners}, set_);
}

Load::Extremes Load::extremes(const Lever<Ball>& y) const {
  Extremes result;
  const auto of_mass = [&](const Mass& x) {
    const Ball A = dot(y.g, x.gravity);
    Ball B;
    Vector3<Ball> moment;  // of what is at rho towards B, per mass
    if (!x.offset.is_zero()) {
      const Vector3<Ball> across = cross(x.gravity, y.m);
      B = x.offset * length_range(across);
      moment = cross(x.offset * direction(across), x.gravity);
    }
    const auto add = [&](std::vector<Wrench>& to, const Ball& slope, const Vector3<Ball>& per_mass) {
      const auto add_mass = [&](const Ball& mass) { to.push_back({mass * x.gravity, mass * per_mass}); };
      const bool is_exact = x.half_range.is_zero();
      if (!is_exact && !certainly_positive(slope)) add_mass(x.least);
      if (is_exact || !certainly_negative(slope)) add_mass(x.most);
    };
    add(result.least, B - A, -moment);
    add(result.most, A + B, moment);
  };
  const auto of_round = [&](const Round& x) {
    const Vector3<Ball> v = x.radius * direction(multiply(x.projection, x.is_moment ? y.m : y.g));
    result = {{wrench_of(-v, x.is_moment)}, {wrench_of(v, x.is_moment)}};
  };
  const auto of_corners = [&](const Corners& x) {
    std::vector<Ball> values;
    for (const Wrench& w : x.from_nominal) values.push_back(of(y, w));
    Ball most_of_least = highest(values.front()), least_of_most = lowest(values.front());
    for (const Ball& value : values) {
      most_of_least = smaller(most_of_least, highest(value));
      least_of_most = larger(least_of_most, lowest(value));
    }
    for (std::size_t n = 0; n < values.size(); ++n) {
      const Wrench w = nominal_ + x.from_nominal[n];
      if (!certainly_positive(values[n] - most_of_least)) result.least.push_back(w);
      if (!certainly_negative(values[n] - least_of_most)) result.most.push_back(w);
    }
  };
  std::visit(Overloaded{of_mass, of_round, of_corners}, set_);
  return result;
}

Vector3<Ball> Load::turning(const Matrix3<Ball>& R, const Vector6<Ball>& y, const Wrench& w) const {
  const Vector3<Ball> y_F = {y[0], y[1], y[2]};
  const Vector3<Ball> y_M = {y[3], y[4], y[5]};
  const Vector3<Ball> r = arm(R);
  if (!turns_) return cross(r, cross(w.force, y_M));
  const Vector3<Ball> F = multiply(R, w.force);
  return cross(F, y_F) + cross(cross(r, F) + multiply(R, w.moment), y_M);
}

namespace {

/// The one load of an item. @throws Rejected unless it is in the item.
LoadSet chosen(const LoadSet& set, const LoadChoice& choice, const ExactVector& gravity) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw Rejected(std::string("the witness's load is not in its item: ") + what);
  };
  const auto of_weight = [&](const Weight& x) -> LoadSet {
    const auto& [mass, e] = std::get<WeightChoice>(choice);
    require(mass >= x.mass.lower && mass <= x.mass.upper, "the mass");
    require(dot(e, e) <= x.offset * x.offset, "the offset of the centre of gravity");
    const ExactVector F = {mass * gravity[0], mass * gravity[1], mass * gravity[2]}, M = cross(e, F);
    return LoadCases{{ExactWrench{F[0], F[1], F[2], M[0], M[1], M[2]}}};
  };
  const auto of_ball_or_disc = [&](const BallOrDisc& x) -> LoadSet {
    const ExactVector& v = std::get<VectorChoice>(choice).vector;
    require(!x.normal || dot(v, *x.normal) == 0, "a vector that is out of its plane");
    require(dot(v, v) <= x.radius * x.radius, "the magnitude of a vector");
    if (x.is_moment) return LoadCases{{ExactWrench{0, 0, 0, v[0], v[1], v[2]}}};
    return LoadCases{{ExactWrench{v[0], v[1], v[2], 0, 0, 0}}};
  };
  const auto of_line_segment = [&](const LineSegment& x) -> LoadSet {
    const mpq_class& f = std::get<AmountChoice>(choice).amount;
    require(f >= x.range.lower && f <= x.range.upper, "the amount");
    return LineSegment{x.is_moment, x.direction, {f, f}};
  };
  const auto of_cases = [&](const LoadCases& x) -> LoadSet {
    const std::size_t j = std::get<CaseChoice>(choice).index;
    require(j < x.wrenches.size(), "the load case");
    return LoadCases{{x.wrenches[j]}};
  };
  return std::visit(Overloaded{of_weight, of_ball_or_disc, of_line_segment, of_cases}, set);
}

}  // namespace

Problem acting(Problem problem, const std::vector<LoadChoice>& loads) {
  for (std::size_t i = 0; i < problem.items.size(); ++i) {
    problem.items[i].set = chosen(problem.items[i].set, loads.at(i), problem.gravity);
  }
  return problem;
}

}  // namespace taut::checker
