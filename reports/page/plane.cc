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
constexpr int kDetailColumns = 160;
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

/// The fields over a window with so many cells; without `sampler` they are empty.
PlaneGrid sampled(const Sampler* sampler, const std::array<Span, 2>& window, int columns, int rows) {
  PlaneGrid grid{window, columns, rows, {}, {}, {}};
  if (sampler == nullptr) return grid;
  const auto& [x, y] = window;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double u = x.lower + x.length() * (column + 0.5) / columns;
      const double v = y.upper - y.length() * (row + 0.5) / rows;
      const Statics<double> s = statics(sampler->model(), sampler->pose({u, v}));
      const Reserves left = reserves(sampler->model(), s);
      grid.tension.push_back(std::max(-1.0, left.tension));  // next to a singular pose it grows without bound
      grid.length.push_back(left.length);
      grid.determinant.push_back(s.regular ? s.determinant : 0);
    }
  }
  return grid;
}

/// The part of the window around the path, in the window's proportions; nothing if the path can be seen without it, or
/// has no extent.
std::optional<std::array<Span, 2>> detail_window(const ReportContext& scene, const std::array<Span, 2>& window) {
  constexpr double kSmall = 0.25;  ///< of the window
  constexpr double kLeast = 0.01;
  constexpr double kAround = 1.7;  ///< times the path
  std::array<Span, 2> path = {nothing(), nothing()};
  for (const PathSample& sample : scene.samples) {
    for (std::size_t j = 0; j < 2; ++j) path[j].include(sample.parameters[j]);
  }
  const double share = std::max(path[0].length() / window[0].length(), path[1].length() / window[1].length());
  if (!(share > 0 && share < kSmall)) return std::nullopt;
  const double shown = kAround * std::max(share, kLeast);
  std::array<Span, 2> result;
  for (std::size_t j = 0; j < 2; ++j) {
    const double width = shown * window[j].length();
    const double middle = (path[j].lower + path[j].upper) / 2;
    const double lower = std::clamp(middle - width / 2, window[j].lower, window[j].upper - width);
    result[j] = {lower, lower + width};
  }
  return result;
}

}  // namespace

void Span::include(double x) {
  if (!std::isfinite(x)) return;
  lower = std::min(lower, x);
  upper = std::max(upper, x);
}

bool is_plane(const SpaceText& space) { return space.parameters.size() == 2 && space.constraints.empty(); }

std::string contour_text(const std::vector<double>& field, int columns) {
  constexpr int kLetters = 26;
  constexpr double kLettersPerDecade = 6.25;
  const int rows = static_cast<int>(field.size()) / columns;
  const auto index = [&](int row, int column) { return static_cast<std::size_t>(row * columns + column); };
  const auto is_positive = [&](std::size_t k) { return field[k] > 0; };
  const auto is_at_contour = [&](int row, int column) {
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows - 1); ++r) {
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns - 1); ++c) {
        if (is_positive(index(r, c)) != is_positive(index(row, column))) return true;
      }
    }
    return false;
  };
  std::vector<bool> matters(field.size());
  double scale = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::size_t k = index(row, column);
      matters[k] = is_at_contour(row, column);
      if (matters[k] && std::isfinite(field[k])) scale = std::max(scale, std::abs(field[k]));
    }
  }
  const auto letter = [&](std::size_t k) {
    int level = kLetters - 1;
    const double share = std::abs(field[k]) / scale;
    if (matters[k] && share < 1) {  // not for NaN and infinity
      const double below = std::min(-std::log10(share) * kLettersPerDecade, kLetters - 1.0);
      level -= static_cast<int>(std::round(below));
    }
    return static_cast<char>((is_positive(k) ? 'A' : 'a') + level);
  };
  std::string text;
  for (std::size_t k = 0; k < field.size();) {
    const char here = letter(k);
    std::size_t end = k + 1;
    while (end < field.size() && letter(end) == here) ++end;
    if (end - k > 1) text += std::to_string(end - k);
    text += here;
    k = end;
  }
  return text;
}

std::optional<Plane> sample_plane(const ReportContext& scene, bool has_fields) {
  if (!is_plane(scene.certificate.problem.space)) return std::nullopt;
  const SpaceText& space = scene.certificate.problem.space;
  const std::array<Span, 2> shown = {window(scene, 0), window(scene, 1)};
  const auto& [x, y] = shown;
  const auto has_width = [](const Span& span) { return span.length() > 0 && std::isfinite(span.length()); };
  if (!has_width(x) || !has_width(y)) return std::nullopt;
  const double ratio = unit(space, 0) == unit(space, 1) ? std::clamp(y.length() / x.length(), 0.3, 1.0) : 0.6;
  Plane plane;
  const Sampler* const sampler = has_fields ? &scene.sampler : nullptr;
  plane.grid = sampled(sampler, shown, kColumns, static_cast<int>(std::round(kColumns * ratio)));
  if (const auto part = found_no_path(scene.certificate) ? std::nullopt : detail_window(scene, shown)) {
    plane.detail = sampled(sampler, *part, kDetailColumns, static_cast<int>(std::round(kDetailColumns * ratio)));
  }
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
