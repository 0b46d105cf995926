// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

namespace taut {

namespace {

using Eigen::Vector3d;

constexpr double kFlat = 1e-3;  ///< how far, as a share of a body's size, the corners of a side may be from its plane

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

double size_of(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return points.empty() ? 0 : box.sizes().maxCoeff();
}

/// How far two rectangles are into each other: the area, widened so that labels keep a little apart.
double overlap(const LabelBox& a, const LabelBox& b) {
  constexpr double kApart = 2;
  const Point2 depth = a.half + b.half + Point2(kApart, kApart) - (a.centre - b.centre).cwiseAbs();
  return depth.minCoeff() > 0 ? depth.x() * depth.y() : 0;
}

double distance(const Point2& p, const std::pair<Point2, Point2>& line) {
  const Point2 along = line.second - line.first;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((p - line.first).dot(along) / square, 0.0, 1.0) : 0;
  return (p - line.first - t * along).norm();
}

}  // namespace

std::string coordinate(double x) {
  constexpr double kFarAway = 1e5;  // anything beyond is outside every picture
  const double bounded = std::isfinite(x) ? std::clamp(x, -kFarAway, kFarAway) : kFarAway;
  const double tenths = std::round(bounded * 10);
  if (std::fmod(tenths, 10) == 0) return fmt::format("{:.0f}", tenths == 0 ? 0.0 : tenths / 10);
  return fmt::format("{:.1f}", tenths / 10);
}

std::string path_data(const std::vector<Point2>& points, bool closed) {
  std::string result;
  for (const Point2& p : points) {
    result += fmt::format("{}{} {}", result.empty() ? 'M' : 'L', coordinate(p.x()), coordinate(p.y()));
  }
  return closed ? result + "Z" : result;
}

double round_length(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= most) return step * power;
  }
  return power;
}

// Andrew's monotone chain.
std::vector<std::size_t> hull(const std::vector<Point2>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::size_t i) { return std::pair(points[i].x(), points[i].y()); };
  std::ranges::sort(order, {}, key);
  const auto repeated = std::ranges::unique(order, {}, key);
  order.erase(repeated.begin(), repeated.end());
  if (order.size() < 3) return order;
  std::vector<std::size_t> result;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = result.size();
    for (const std::size_t i : order) {
      while (result.size() >= begin + 2) {
        const Point2& last = points[result.back()];
        if (cross(last - points[result[result.size() - 2]], points[i] - last) > 0) break;
        result.pop_back();
      }
      result.push_back(i);
    }
    result.pop_back();
    std::ranges::reverse(order);
  }
  return result;
}

std::vector<Point2> outline_of(const std::vector<Point2>& points, double radius) {
  constexpr int kCorners = 32;  // of a circle
  std::vector<Point2> all;
  for (const Point2& p : points) {
    all.push_back(p);
    for (int k = 0; radius > 0 && k < kCorners; ++k) {
      const double angle = 2 * std::numbers::pi / kCorners * k;
      all.emplace_back(p + radius * Point2(std::cos(angle), std::sin(angle)));
    }
  }
  std::vector<Point2> outline;
  for (const std::size_t i : hull(all)) outline.push_back(all[i]);
  return outline;
}

std::vector<Vector3d> distinct(const std::vector<Vector3d>& points) {
  const double least = 1e-6 * size_of(points);
  std::vector<Vector3d> result;
  for (const Vector3d& p : points) {
    if (std::ranges::none_of(result, [&](const Vector3d& q) { return (p - q).norm() <= least; })) result.push_back(p);
  }
  return result;
}

std::vector<Face> hull_faces(const std::vector<Vector3d>& all) {
  const std::vector<Vector3d> points = distinct(all);
  const double size = size_of(points);
  std::vector<Face> result;
  std::set<std::pair<std::vector<std::size_t>, bool>> seen;  // the points of a side, and which way it faces
  const auto consider = [&](const Vector3d& corner, const Vector3d& normal, bool is_turned) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double height = normal.dot(points[i] - corner);
      if (height > kFlat * size) return;
      if (height >= -kFlat * size) members.push_back(i);
    }
    if (!seen.emplace(members, is_turned && members.size() == points.size()).second) return;
    const Vector3d u = normal.unitOrthogonal();
    const Vector3d v = normal.cross(u);
    std::vector<Point2> flat;
    for (const std::size_t i : members) flat.emplace_back(u.dot(points[i]), v.dot(points[i]));
    Face face{{}, normal};
    for (const std::size_t i : hull(flat)) face.corners.push_back(points[members[i]]);
    if (face.corners.size() > 2) result.push_back(std::move(face));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        const Vector3d normal = (points[j] - points[i]).cross(points[k] - points[i]);
        if (!(normal.norm() > kFlat * size * size)) continue;
        consider(points[i], normal.normalized(), false);
        consider(points[i], -normal.normalized(), true);
      }
    }
  }
  return result;
}

std::vector<std::pair<Point2, Point2>> hatching(const std::vector<Point2>& polygon, double spacing) {
  std::vector<std::pair<Point2, Point2>> result;
  if (polygon.size() < 3) return result;
  const auto level = [](const Point2& p) { return p.x() + p.y(); };
  const auto [low, high] = std::ranges::minmax(polygon, {}, level);
  const double step = spacing * std::sqrt(2.0);
  constexpr double kMost = 200;  // lines
  if (!((level(high) - level(low)) / step < kMost)) return result;
  for (double c = level(low) + step / 2; c < level(high); c += step) {
    std::vector<Point2> cuts;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point2& a = polygon[i];
      const Point2& b = polygon[(i + 1) % polygon.size()];
      if ((level(a) < c) != (level(b) < c)) cuts.push_back(a + (c - level(a)) / (level(b) - level(a)) * (b - a));
    }
    if (cuts.size() == 2) result.emplace_back(cuts[0], cuts[1]);
  }
  return result;
}

Point2 half_size(const std::string& text, double font_size) {
  const auto letters =
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
  constexpr double kWidth = 0.6;  // of a letter, in font sizes
  constexpr double kHeight = 1.1;
  return {0.5 * kWidth * font_size * static_cast<double>(letters), 0.5 * kHeight * font_size};
}

double LabelPlacer::cost(const LabelBox& box, int own_line) const {
  constexpr double kCovered = 1000;
  constexpr double kPartly = 1;  // for each unit of area
  double result = 0;
  const Point2 beyond = (box.half - box.centre).cwiseMax(box.centre + box.half - frame_).cwiseMax(0);
  if (beyond.maxCoeff() > 0) result += kCovered + 100 * kPartly * beyond.sum();
  for (const LabelBox& other : taken_) {
    if (const double area = overlap(box, other); area > 0) result += kCovered + kPartly * area;
  }
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (static_cast<int>(i) == own_line) continue;
    const double away = distance(box.centre, lines_[i]) / (box.half.minCoeff() + 2);
    if (away < 1) result += 1 - 0.5 * away;
  }
  return result;
}

std::size_t LabelPlacer::place(const Point2& half, const std::vector<Candidate>& candidates) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double total = candidates[i].cost + cost({candidates[i].centre, half}, candidates[i].own_line);
    if (total < least) {
      least = total;
      best = i;
    }
  }
  taken_.push_back({candidates[best].centre, half});
  return best;
}

}  // namespace taut
