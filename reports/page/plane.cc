// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace taut {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kColumns = 320;
constexpr std::size_t kMaxPolygons = 6000;  ///< drawn; more would only blacken the picture and swell the page

Span nothing() { return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}; }

/// A map of the plane to itself that keeps every pose: turns of periodic parameters, and the flip.
struct Image {
  std::array<double, 2> offset{};
  std::array<double, 2> sign = {1, 1};
  [[nodiscard]] std::array<double, 2> of(const std::array<double, 2>& p) const {
    return {sign[0] * p[0] + offset[0], sign[1] * p[1] + offset[1]};
  }
};

std::vector<Image> images(const SpaceText& space) {
  std::vector<Image> result;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      Image image;
      const std::array<int, 2> half_turns = {i, j};
      bool valid = true;
      for (std::size_t c = 0; c < 2; ++c) {
        image.offset[c] = half_turns[c] * kPi;
        const bool periodic = space.parameters[c].kind == ParameterKind::kPeriodic;
        if (half_turns[c] == 0) continue;
        if (!periodic) valid = false;
        if (half_turns[c] % 2 == 0) continue;
        if (!space.flip || (*space.flip)[0] != static_cast<int>(c)) {
          valid = false;
        } else {
          image.sign[static_cast<std::size_t>((*space.flip)[1])] = -1;
        }
      }
      if (valid) result.push_back(image);
    }
  }
  return result;
}

/// The values of parameter j that are shown: the path's, and a full turn, the range, or half a turn of θ.
Span window(const ReportContext& scene, std::size_t j) {
  const SpaceText& space = scene.certificate.problem.space;
  const Parameter& parameter = space.parameters[j];
  Span path = nothing();
  for (const PathSample& sample : scene.samples) path.include(sample.parameters[j]);
  if (!(path.length() >= 0)) {  // no path: the query will do
    for (const auto& waypoint : scene.certificate.problem.query) path.include(evaluate_constant<double>(waypoint[j]));
  }
  if (!(path.length() >= 0)) path = {0, 0};
  const double pad = 0.05 * std::max(path.length(), 1e-3);
  if (parameter.kind == ParameterKind::kPeriodic) {
    if (path.lower >= -kPi && path.upper <= kPi) return {-kPi, kPi};
    const double middle = (path.lower + path.upper) / 2;
    return {std::min(path.lower - pad, middle - kPi), std::max(path.upper + pad, middle + kPi)};
  }
  if (parameter.kind == ParameterKind::kRange) {
    return {evaluate_constant<double>(parameter.range_lower), evaluate_constant<double>(parameter.range_upper)};
  }
  if (space.flip && (*space.flip)[1] == static_cast<int>(j)) {
    constexpr double kPad = 0.15;  // [rad]
    if (-path.lower > path.upper) return {std::min(path.lower - kPad, -kPi), path.upper > 0 ? path.upper + kPad : 0};
    return {path.lower < 0 ? path.lower - kPad : 0, std::max(path.upper + kPad, kPi)};
  }
  for (const Illustration::Chart& chart : scene.illustration.charts) {
    for (const auto& corner : chart.corners) path.include(corner[j]);
  }
  const double margin = std::max(0.08 * path.length(), 0.05);
  return {path.lower - margin, path.upper + margin};
}

/// Computes the cells, and the pieces of det J = 0 by marching squares on the cells' centres.
void sample_grid(const Sampler& sampler, Plane& plane) {
  const Span x = plane.window[0];  // no structured binding: clang 14 can't capture those
  const Span y = plane.window[1];
  const auto at = [&](double column, double row) -> std::array<double, 2> {
    return {x.lower + x.length() * (column + 0.5) / plane.columns, y.upper - y.length() * (row + 0.5) / plane.rows};
  };
  std::vector<double> determinant;
  for (int row = 0; row < plane.rows; ++row) {
    for (int column = 0; column < plane.columns; ++column) {
      const auto [u, v] = at(column, row);
      const Statics<double> s = statics(sampler.model(), sampler.pose({u, v}));
      plane.cells += static_cast<char>('0' + static_cast<int>(feasibility(sampler.model(), s)));
      determinant.push_back(s.regular ? s.determinant : 0);
    }
  }
  for (int row = 0; row + 1 < plane.rows; ++row) {
    for (int column = 0; column + 1 < plane.columns; ++column) {
      std::vector<std::array<double, 2>> ends;
      const auto edge = [&](int column0, int row0, int column1, int row1) {
        const double a = determinant[row0 * plane.columns + column0];
        const double b = determinant[row1 * plane.columns + column1];
        if (!(a * b < 0)) return;
        const double t = a / (a - b);
        ends.push_back(at(column0 + t * (column1 - column0), row0 + t * (row1 - row0)));
      };
      edge(column, row, column + 1, row);
      edge(column + 1, row, column + 1, row + 1);
      edge(column, row + 1, column + 1, row + 1);
      edge(column, row, column, row + 1);
      for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
        plane.singular.push_back({ends[i][0], ends[i][1], ends[i + 1][0], ends[i + 1][1]});
      }
    }
  }
}

}  // namespace

void Span::include(double x) {
  if (!std::isfinite(x)) return;
  lower = std::min(lower, x);
  upper = std::max(upper, x);
}

bool is_plane(const SpaceText& space) { return space.parameters.size() == 2 && space.constraints.empty(); }

std::optional<Plane> sample_plane(const ReportContext& scene) {
  if (!is_plane(scene.certificate.problem.space)) return std::nullopt;
  const SpaceText& space = scene.certificate.problem.space;
  Plane plane;
  plane.window = {window(scene, 0), window(scene, 1)};
  const auto& [x, y] = plane.window;
  const auto has_width = [](const Span& span) { return span.length() > 0 && std::isfinite(span.length()); };
  if (!has_width(x) || !has_width(y)) return std::nullopt;
  const double ratio = unit(space, 0) == unit(space, 1) ? std::clamp(y.length() / x.length(), 0.3, 1.0) : 0.6;
  plane.columns = kColumns;
  plane.rows = static_cast<int>(std::round(kColumns * ratio));
  sample_grid(scene.sampler, plane);
  for (const Illustration::Chart& chart : scene.illustration.charts) {
    for (const Image& image : images(space)) {
      const auto [u, v] = image.of({chart.centre[0], chart.centre[1]});
      const auto is_near = [](const Span& span, double c) {
        return std::abs(c - (span.lower + span.upper) / 2) < 0.52 * span.length();
      };
      if (!is_near(x, u) || !is_near(y, v)) continue;
      if (plane.charts.size() == kMaxPolygons) return plane;
      std::vector<std::array<double, 2>>& polygon = plane.charts.emplace_back();
      for (const auto& corner : chart.corners) polygon.push_back(image.of(corner));
    }
  }
  return plane;
}

}  // namespace taut
