// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/worst_loads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "problem/rational.h"

namespace taut {
namespace {

using checker::Ball;
using checker::dot;
using checker::ExactVector;
using checker::MeanValueForm;
using Vector = Eigen::Vector3d;

double approx(const Ball& x) { return arf_get_d(arb_midref(x.get()), ARF_RND_NEAR); }
double approx(const MeanValueForm& x) { return approx(x.at); }
Vector approx(const ExactVector& x) { return {x[0].get_d(), x[1].get_d(), x[2].get_d()}; }

/// The vector of length `radius` along `direction`, or a hair shorter, never longer; at right angles to `normal`.
/// Its numbers are short.
ExactVector within(const mpq_class& radius, Vector direction, const ExactVector* normal = nullptr) {
  constexpr int kBits = 34;
  const double size = direction.lpNorm<Eigen::Infinity>();
  if (!(size > 0) || !std::isfinite(size) || radius == 0) return {};
  direction /= size;
  ExactVector v;
  for (int k = 0; k < 3; ++k)
    v[static_cast<std::size_t>(k)] = std::ldexp(std::round(std::ldexp(direction(k), kBits)), -kBits);
  if (normal != nullptr) {
    const mpq_class along = dot(v, *normal) / dot(*normal, *normal);
    for (std::size_t k = 0; k < 3; ++k) v[k] -= along * (*normal)[k];
  }
  const mpq_class square = dot(v, v);
  if (square == 0) return {};
  constexpr double kInside = 1 - 0x1p-40;
  mpq_class factor = std::ldexp(std::floor(std::ldexp(kInside / std::sqrt(square.get_d()), 50)), -50);
  for (mpq_class& x : v) {
    x *= factor * radius;
    x.canonicalize();
  }
  return v;
}

/// What the items are seen through: a row of D^-1, negative where the least is sought, and the platform's rotation.
struct View {
  Vector force, moment;  ///< y_F, y_M
  Eigen::Matrix3d r_WP;
  Vector load_point;

  [[nodiscard]] Vector lever(const ExactVector& at) const { return r_WP * (approx(at) - load_point); }
  /// What a force, or a moment, at `at` is multiplied by, in the item's axes.
  [[nodiscard]] Vector gradient(const checker::LoadItem& item, bool is_moment) const {
    Vector g = moment;
    if (!is_moment) g = force + moment.cross(lever(item.at));
    return in_axes_of(item, g);
  }
  [[nodiscard]] Vector in_axes_of(const checker::LoadItem& item, const Vector& x) const {
    if (item.axes == checker::Axes::kPlatform) return r_WP.transpose() * x;
    return x;
  }
};

checker::LoadChoice choose(const checker::LoadItem& item, const Vector& gravity, const View& view) {
  using Choice = checker::LoadChoice;
  const auto of_weight = [&](const checker::Weight& x) -> Choice {
    const Vector across = gravity.cross(view.moment);
    const double value = view.gradient(item, false).dot(gravity) + x.offset.get_d() * across.norm();
    return checker::WeightChoice{value > 0 ? x.mass.upper : x.mass.lower, within(x.offset, across)};
  };
  const auto of_ball_or_disc = [&](const checker::BallOrDisc& x) -> Choice {
    return checker::VectorChoice{within(x.radius, view.gradient(item, x.is_moment), x.normal ? &*x.normal : nullptr)};
  };
  const auto of_line_segment = [&](const checker::LineSegment& x) -> Choice {
    const bool rises = view.gradient(item, x.is_moment).dot(approx(x.direction)) > 0;
    return checker::AmountChoice{rises ? x.range.upper : x.range.lower};
  };
  const auto of_cases = [&](const checker::LoadCases& x) -> Choice {
    const Vector of_force = view.gradient(item, false), of_moment = view.gradient(item, true);
    const auto value = [&](const checker::ExactWrench& w) {
      return of_force.dot(approx(ExactVector{w[0], w[1], w[2]})) + of_moment.dot(approx(ExactVector{w[3], w[4], w[5]}));
    };
    const auto worst = std::ranges::max_element(x.wrenches, {}, value);
    return checker::CaseChoice{static_cast<std::size_t>(worst - x.wrenches.begin())};
  };
  return std::visit(checker::Overloaded{of_weight, of_ball_or_disc, of_line_segment, of_cases}, item.set);
}

std::string text(const mpq_class& x) { return rational_text(Rational(x.get_str())); }

}  // namespace

std::vector<checker::LoadChoice> worst_loads(const checker::Problem& problem, const checker::Geometry& geometry,
                                             std::size_t cable, bool is_least) {
  checker::Matrix6<Ball> identity;
  for (std::size_t i = 0; i < 6; ++i) identity[i][i] = Ball(1);
  const auto row = checker::Inverse(geometry.D).times(identity)[cable];
  const double sign = is_least ? -1 : 1;
  View view;
  for (int k = 0; k < 3; ++k) {
    view.force(k) = sign * approx(row[static_cast<std::size_t>(k)]);
    view.moment(k) = sign * approx(row[static_cast<std::size_t>(3 + k)]);
    for (int j = 0; j < 3; ++j) {
      view.r_WP(k, j) = approx(geometry.pose.R[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)]);
    }
  }
  view.load_point = approx(problem.load_point);
  std::vector<checker::LoadChoice> result;
  for (const checker::LoadItem& item : problem.items) result.push_back(choose(item, approx(problem.gravity), view));
  return result;
}

nlohmann::json to_json(const std::vector<checker::LoadChoice>& loads) {
  const auto vector = [](const ExactVector& x) { return nlohmann::json{text(x[0]), text(x[1]), text(x[2])}; };
  nlohmann::json result = nlohmann::json::array();
  for (const checker::LoadChoice& load : loads) {
    if (const auto* weight = std::get_if<checker::WeightChoice>(&load)) {
      result.push_back({{"mass_kg", text(weight->mass)}, {"offset_m", vector(weight->offset)}});
    } else if (const auto* of_vector = std::get_if<checker::VectorChoice>(&load)) {
      result.push_back({{"vector", vector(of_vector->vector)}});
    } else if (const auto* amount = std::get_if<checker::AmountChoice>(&load)) {
      result.push_back({{"amount", text(amount->amount)}});
    } else {
      result.push_back({{"case", std::get<checker::CaseChoice>(load).index}});
    }
  }
  return result;
}

}  // namespace taut
