// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/still_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

namespace taut {

namespace {

/// Coordinate in a picture: one decimal at most, and finite for any x, so that hostile numbers stay short.
std::string coordinate(double x) {
  constexpr double kFarAway = 1e5;  // anything beyond is outside every picture
  const double bounded = std::isfinite(x) ? std::clamp(x, -kFarAway, kFarAway) : kFarAway;
  const double tenths = std::round(bounded * 10);
  if (std::fmod(tenths, 10) == 0) return fmt::format("{:.0f}", tenths == 0 ? 0.0 : tenths / 10);
  return fmt::format("{:.1f}", tenths / 10);
}

Html panel(const Html& title, const Html& picture) {
  return html("<figure class=\"panel\"><figcaption>{}</figcaption>{}</figure>\n", title, picture);
}

using Point2 = Eigen::Vector2d;

/// Convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Point2> hull(std::vector<Point2> points) {
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Point2> result;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = result.size();
    for (const Point2& p : points) {
      while (result.size() >= begin + 2) {
        const Point2 u = result[result.size() - 1] - result[result.size() - 2];
        const Point2 v = p - result.back();
        if (u.x() * v.y() - u.y() * v.x() > 0) break;
        result.pop_back();
      }
      result.push_back(p);
    }
    result.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return result;
}

/// Looks at the world from the side and a little from above, with the load pulling down.
class Camera {
 public:
  explicit Camera(const Vector6<double>& wrench) {
    Eigen::Vector3d down = wrench.head<3>();
    down = down.norm() > 0 ? Eigen::Vector3d(down.normalized()) : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d reference = std::abs(down.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    const Eigen::Vector3d side = (reference - reference.dot(down) * down).normalized();
    const Eigen::Vector3d depth = down.cross(side);
    constexpr double kAzimuth = 0.35;    // [rad] turns the triangles out of the plane of view
    constexpr double kElevation = 0.35;  // [rad]
    right_ = std::cos(kAzimuth) * side + std::sin(kAzimuth) * depth;
    const Eigen::Vector3d away = -std::sin(kAzimuth) * side + std::cos(kAzimuth) * depth;
    down_ = std::cos(kElevation) * down - std::sin(kElevation) * away;
  }
  [[nodiscard]] Point2 operator()(const Eigen::Vector3d& p) const { return {right_.dot(p), down_.dot(p)}; }

 private:
  Eigen::Vector3d right_;
  Eigen::Vector3d down_;
};

struct Drawing {
  std::array<Point2, kCables> base;
  std::array<Point2, kCables> platform;
  Point2 load;
};

Drawing draw(const ReportContext& scene, const Camera& camera, const Pose<double>& pose) {
  const Model<double>& model = scene.sampler.model();
  const Matrix3<double> r_WP = rotation(model.angles, pose.angles);
  Drawing result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.base[i] = camera(model.p_WA[i]);
    result.platform[i] = camera(pose.p_WP + r_WP * model.p_PB[i]);
  }
  result.load = camera(pose.p_WP + r_WP * model.p_PM);
  return result;
}

std::string polygon(const std::vector<Point2>& points, const std::function<Point2(const Point2&)>& place) {
  std::string data;
  for (const Point2& point : points) {
    const Point2 p = place(point);
    data += fmt::format("{}{} {}", data.empty() ? 'M' : 'L', coordinate(p.x()), coordinate(p.y()));
  }
  return data + "Z";
}

}  // namespace

Html still_picture(const ReportContext& scene) {
  const Path& path = scene.certificate.path;
  if (path.waypoints.empty()) return {};
  std::vector<std::pair<Html, double>> views = {{html("Waypoint 0 (start)"), 0.0}};
  if (const auto& witness = scene.certificate.witness) {
    views.emplace_back(html("At the witness"), position(witness->violation.at));
  } else if (path.segments() > 1) {
    const std::size_t middle = path.segments() / 2;
    const char* what = path.interpolation == Interpolation::kStraight ? "Waypoint" : "Start of segment";
    views.emplace_back(html("{} {}", what, middle), static_cast<double>(middle));
  }
  if (path.segments() > 0) {
    views.emplace_back(html("Waypoint {} (goal)", path.waypoints.size() - 1), static_cast<double>(path.segments()));
  }

  const Model<double>& model = scene.sampler.model();
  const Camera camera(nominal_wrench(model.loads, model.wrench, Matrix3<double>(Matrix3<double>::Identity())));
  Eigen::AlignedBox2d bounds;
  std::vector<Drawing> drawings;
  for (const auto& [title, position] : views) {
    drawings.push_back(draw(scene, camera, scene.sampler.at(path, position).pose));
    for (const Point2& p : drawings.back().base) bounds.extend(p);
    for (const Point2& p : drawings.back().platform) bounds.extend(p);
    bounds.extend(drawings.back().load);
  }
  constexpr double kPad = 26;
  constexpr double kSide = 300;  // of the picture's longer side
  const double scale = kSide / bounds.sizes().maxCoeff();
  const auto place = [&](const Point2& p) -> Point2 { return (p - bounds.min()) * scale + Point2(kPad, kPad); };
  const Point2 size = bounds.sizes() * scale + Point2(2 * kPad, 2 * kPad);
  Html panels;
  for (std::size_t k = 0; k < views.size(); ++k) {
    const Drawing& d = drawings[k];
    Html cables;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Point2 a = place(d.base[i]);
      const Point2 b = place(d.platform[i]);
      const Point2 label = 0.62 * a + 0.38 * b;
      const bool marked = scene.certificate.witness && !scene.certificate.witness->violation.singular &&
                          scene.certificate.witness->violation.margin.cable == static_cast<int>(i);
      cables += html(
          "<path class=\"cable{}\" d=\"M{} {}L{} {}\"/><circle class=\"tag\" cx=\"{}\" cy=\"{}\" r=\"7\"/>"
          "<text class=\"letter dark\" x=\"{}\" y=\"{}\">{}</text>",
          marked ? " marked" : "", coordinate(a.x()), coordinate(a.y()), coordinate(b.x()), coordinate(b.y()),
          coordinate(label.x()), coordinate(label.y()), coordinate(label.x()), coordinate(label.y() + 3.6), i + 1);
    }
    const Point2 load = place(d.load);
    panels += panel(
        views[k].first,
        html("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"The robot\">"
             "<path class=\"base\" d=\"{}\"/>{}<path class=\"platform\" d=\"{}\"/>"
             "<circle class=\"load\" cx=\"{}\" cy=\"{}\" r=\"3.5\"/></svg>",
             coordinate(size.x()), coordinate(size.y()), polygon(hull({d.base.begin(), d.base.end()}), place), cables,
             polygon(hull({d.platform.begin(), d.platform.end()}), place), coordinate(load.x()), coordinate(load.y())));
  }
  return html("<div class=\"panels robots\">{}</div>\n", panels);
}

}  // namespace taut
