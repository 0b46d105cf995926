// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies for the tests of the clause "clearance", and where they are by a route of its own: points turned by
// quaternions in double and in 200 bits, and distances of convex hulls by Gilbert, Johnson and Keerthi's method, which
// the checker does not have. In double it searches; the distance of the two points that it finds, in 200 bits, is at
// least that of the bodies.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/checker/deviants.h"

namespace taut::checker {

template <class S>
S exact(const mpq_class& x) {
  if constexpr (std::is_same_v<S, double>) {
    return x.get_d();
  } else {
    BigFloat result;
    mpfr_set_q(result.get(), x.get_mpq_t(), MPFR_RNDN);
    return result;
  }
}
template <class S>
campaign::Vec<S> exact(const ExactVector& x) {
  return {exact<S>(x[0]), exact<S>(x[1]), exact<S>(x[2])};
}

/// A body with its roll, pitch and yaw as numbers.
struct TestBody {
  RigidBody body;
  std::array<mpq_class, 3> angles;
};

inline TestBody test_body(decltype(RigidBody::shape) shape, ExactVector at, std::array<mpq_class, 3> angles = {}) {
  TestBody result{{std::move(shape), std::move(at), {}}, std::move(angles)};
  for (std::size_t k = 0; k < 3; ++k) result.body.rotation[k] = parse_expression(result.angles[k].get_str(), {}, "");
  return result;
}

/// All pairs of all classes, with one clearance.
inline std::vector<CheckedPair> all_pairs(const Bodies& bodies, const mpq_class& clearance) {
  std::vector<CheckedPair> pairs;
  const auto add = [&](PairKind kind, std::size_t first, std::size_t second) {
    for (std::size_t i = 0; i < first; ++i) {
      for (std::size_t j = kind == PairKind::kCableCable ? i + 1 : 0; j < second; ++j) {
        pairs.push_back({kind, i, j, clearance});
      }
    }
  };
  add(PairKind::kPlatformObstacle, bodies.platform.size(), bodies.obstacles.size());
  add(PairKind::kCableObstacle, kCables, bodies.obstacles.size());
  add(PairKind::kCableCable, kCables, kCables);
  add(PairKind::kCablePlatform, kCables, bodies.platform.size());
  return pairs;
}

}  // namespace taut::checker

namespace taut::campaign {

using checker::Bodies, checker::CheckedPair, checker::HalfSpaceShape, checker::HullShape, checker::PairKind,
    checker::TestBody;
using checker::exact;
using checker::ExactVector;

template <class S>
struct HullAt {
  std::vector<Vec<S>> points;
  S radius;
};
template <class S>
struct HalfSpaceAt {
  Vec<S> normal;
  S offset;
};
template <class S>
using BodyAt = std::variant<HullAt<S>, HalfSpaceAt<S>>;

/// In the axes in which it is fixed.
template <class S>
BodyAt<S> body_at(const TestBody& test) {
  const Vec<S> at = exact<S>(test.body.at);
  const S zero(0.0);
  const auto angle = [&](std::size_t k) { return exact<S>(test.angles[k]); };
  const Rows<S> rotation =
      turn(Vec<S>{zero, zero, angle(2)}) * turn(Vec<S>{zero, angle(1), zero}) * turn(Vec<S>{angle(0), zero, zero});
  if (const auto* half_space = std::get_if<HalfSpaceShape>(&test.body.shape)) {
    const Vec<S> normal = exact<S>(half_space->normal);
    return HalfSpaceAt<S>{normal, dot(normal, at)};
  }
  const auto& hull = std::get<HullShape>(test.body.shape);
  HullAt<S> result{{}, exact<S>(hull.radius)};
  for (const ExactVector& x : hull.points) result.points.push_back(at + rotation * exact<S>(x));
  return result;
}

/// The two bodies of a pair of a machine that may deviate, at its pose, in W.
template <class S>
std::pair<HullAt<S>, BodyAt<S>> bodies_at(const Bodies& bodies, const std::vector<TestBody>& platform,
                                          const std::vector<TestBody>& obstacles, const CheckedPair& pair,
                                          const Machine<S>& machine, const RigidPose<S>& pose) {
  const auto carried = [&](std::size_t k) {
    auto result = std::get<HullAt<S>>(body_at<S>(platform[k]));
    for (Vec<S>& x : result.points) x = pose.p + pose.r * x;
    return result;
  };
  const auto cable = [&](std::size_t i) {
    const Vec<S> to = pose.p + pose.r * machine.b[i];
    const Vec<S> d = to - machine.a[i];
    const Vec<S> unit = (S(1.0) / root(dot(d, d))) * d;
    const auto& [diameter, free_ends] = bodies.cables[i];
    return HullAt<S>{{machine.a[i] + exact<S>(free_ends[0]) * unit, to - exact<S>(free_ends[1]) * unit},
                     exact<S>(diameter) / S(2.0)};
  };
  switch (pair.kind) {
    case PairKind::kPlatformObstacle: return {carried(pair.first), body_at<S>(obstacles[pair.second])};
    case PairKind::kCableObstacle: return {cable(pair.first), body_at<S>(obstacles[pair.second])};
    case PairKind::kCableCable: return {cable(pair.first), cable(pair.second)};
    case PairKind::kCablePlatform: return {cable(pair.first), carried(pair.second)};
    case PairKind::kExitCone: break;
  }
  throw std::logic_error("an exit cone is no body");
}

// ---- Distances ------------------------------------------------------------------------------------------------------

/// Weights of the points of two hulls that make the nearest ones, and the vector from the second to the first.
struct NearestPoints {
  std::vector<double> first, second;
  Vec<double> apart{};
};

/// The point nearest to 0 of the affine hull of some points, if its weights are not negative: they are written.
inline bool nearest_of_affine_hull(const std::vector<Vec<double>>& y, std::vector<double>& weights) {
  const std::size_t n = y.size() - 1;
  std::array<std::array<long double, 4>, 3> rows{};
  const auto edge = [&](std::size_t i, std::size_t c) { return static_cast<long double>(y[i + 1][c]) - y[0][c]; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t j = 0; j < n; ++j) rows[i][j] += edge(i, c) * edge(j, c);
      rows[i][n] -= edge(i, c) * y[0][c];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(rows[i][k]) > std::abs(rows[pivot][k])) pivot = i;
    }
    if (std::abs(rows[pivot][k]) < 1e-25L) return false;
    std::swap(rows[k], rows[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const long double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j <= n; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  long double rest = 1;
  weights.assign(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const long double t = rows[i][n] / rows[i][i];
    weights[i + 1] = static_cast<double>(t);
    rest -= t;
  }
  weights[0] = static_cast<double>(rest);
  return std::ranges::all_of(weights, [](double w) { return w >= 0; });
}

inline NearestPoints nearest_points(const std::vector<Vec<double>>& a, const std::vector<Vec<double>>& b) {
  std::vector<std::pair<std::size_t, std::size_t>> simplex = {{0, 0}};
  std::vector<double> weights = {1};
  Vec<double> v = a[0] - b[0];
  for (int step = 0; step < 200; ++step) {
    const auto along = [&](const Vec<double>& x) { return dot(v, x); };
    const auto k = static_cast<std::size_t>(std::ranges::min_element(a, {}, along) - a.begin());
    const auto l = static_cast<std::size_t>(std::ranges::max_element(b, {}, along) - b.begin());
    if (std::ranges::find(simplex, std::pair(k, l)) != simplex.end()) break;
    if (dot(v, v) - along(a[k] - b[l]) <= 1e-17) break;
    simplex.emplace_back(k, l);
    double least = dot(v, v);
    bool is_nearer = false;
    std::vector<std::pair<std::size_t, std::size_t>> best;
    for (unsigned subset = 1; subset < 1U << simplex.size(); ++subset) {
      std::vector<std::pair<std::size_t, std::size_t>> part;
      std::vector<Vec<double>> y;
      for (std::size_t i = 0; i < simplex.size(); ++i) {
        if ((subset >> i & 1U) == 0) continue;
        part.push_back(simplex[i]);
        y.push_back(a[simplex[i].first] - b[simplex[i].second]);
      }
      std::vector<double> of_part;
      if (y.size() > 4 || !nearest_of_affine_hull(y, of_part)) continue;
      Vec<double> x{};
      for (std::size_t i = 0; i < y.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) x[c] += of_part[i] * y[i][c];
      }
      if (dot(x, x) >= least) continue;
      least = dot(x, x);
      is_nearer = true;
      v = x;
      best = part;
      weights = of_part;
    }
    if (!is_nearer) {
      simplex.pop_back();
      break;
    }
    simplex = best;
    if (least < 1e-28) break;
  }
  NearestPoints result{std::vector<double>(a.size()), std::vector<double>(b.size()), v};
  for (std::size_t i = 0; i < simplex.size(); ++i) {
    result.first[simplex[i].first] += weights[i];
    result.second[simplex[i].second] += weights[i];
  }
  return result;
}

/// The sum of weights times points, the weights made 1 in sum by the largest.
template <class S>
Vec<S> weighted(const std::vector<Vec<S>>& points, const std::vector<double>& weights) {
  const auto largest = static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
  Vec<S> result = points[largest];
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (k != largest) result = result + S(weights[k]) * (points[k] - points[largest]);
  }
  return result;
}

/// The vector along which two bodies are best told apart.
inline Vec<double> best_direction(const std::pair<HullAt<double>, BodyAt<double>>& pair) {
  if (const auto* half_space = std::get_if<HalfSpaceAt<double>>(&pair.second)) return half_space->normal;
  return nearest_points(pair.first.points, std::get<HullAt<double>>(pair.second).points).apart;
}

/// At least the distance of two bodies, and next to it; negative where the balls around the nearest points overlap.
/// @param search  the same bodies, or nearly
template <class S>
S distance_at(const std::pair<HullAt<S>, BodyAt<S>>& pair, const std::pair<HullAt<double>, BodyAt<double>>& search) {
  if (const auto* half_space = std::get_if<HalfSpaceAt<S>>(&pair.second)) {
    const S size = root(dot(half_space->normal, half_space->normal));
    S least = (dot(half_space->normal, pair.first.points[0]) - half_space->offset) / size;
    for (const Vec<S>& x : pair.first.points) {
      const S here = (dot(half_space->normal, x) - half_space->offset) / size;
      if (here < least) least = here;
    }
    return least - pair.first.radius;
  }
  const auto& second = std::get<HullAt<S>>(pair.second);
  const NearestPoints nearest = nearest_points(search.first.points, std::get<HullAt<double>>(search.second).points);
  const Vec<S> apart = weighted(pair.first.points, nearest.first) - weighted(second.points, nearest.second);
  return root(dot(apart, apart)) - pair.first.radius - second.radius;
}

/// Integers up to 127 next to a direction; 1, 0, 0 for none.
inline std::array<int, 3> rounded(const Vec<double>& u, double largest = 127) {
  const double size = std::max({std::abs(u[0]), std::abs(u[1]), std::abs(u[2])});
  if (size < 1e-12) return {1, 0, 0};
  std::array<int, 3> result{};
  for (std::size_t c = 0; c < 3; ++c) result[c] = static_cast<int>(std::lround(u[c] / size * largest));
  return result;
}

}  // namespace taut::campaign
