// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/robot_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/input_error.h"
#include "reports/page/markup.h"
#include "reports/summary/display_units.h"

namespace taut {

namespace {

using Point = Eigen::Vector2d;

constexpr double kSide = 360;  ///< of a view [px]
constexpr double kPad = 46;    ///< around what is drawn: room for names
constexpr double kHead = 58;   ///< above the views
constexpr double kFoot = 64;   ///< below them: axes and scale

/// Looks along `away`, with `down` downwards on the page.
struct View {
  std::string title;
  Vector3<double> right;
  Vector3<double> down;
  [[nodiscard]] Point operator()(const Vector3<double>& p) const { return {right.dot(p), down.dot(p)}; }
};

/// The axis of the world that is most nearly perpendicular to `v`, made perpendicular to it.
Vector3<double> square_to(const Vector3<double>& v) {
  Eigen::Index least = 0;
  v.cwiseAbs().minCoeff(&least);
  const Vector3<double> axis = Vector3<double>::Unit(least);
  return (axis - axis.dot(v) * v).normalized();
}

std::array<View, 3> views(const Vector3<double>& down) {
  const Vector3<double> right = square_to(down);
  const Vector3<double> other = down.cross(right);
  return {View{"From the front", right, down}, View{"From the side", other, down},
          View{"Along the load", right, other}};
}

Html line(const char* kind, const Point& a, const Point& b) {
  return html("<line class=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>", kind, fmt::format("{:.1f}", a.x()),
              fmt::format("{:.1f}", a.y()), fmt::format("{:.1f}", b.x()), fmt::format("{:.1f}", b.y()));
}

Html words(const char* kind, const Point& at, const std::string& text) {
  return html("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>", kind, fmt::format("{:.1f}", at.x()),
              fmt::format("{:.1f}", at.y()), text);
}

Html arrow(const char* kind, const Point& from, const Point& to) {
  const Point along = (to - from).normalized();
  const Point across(-along.y(), along.x());
  const double head = std::min(8.0, 0.5 * (to - from).norm());
  return line(kind, from, to) + line(kind, to, to - head * along + 0.5 * head * across) +
         line(kind, to, to - head * along - 0.5 * head * across);
}

/// Names of points; coinciding points share one label: "A1 A2".
std::vector<std::pair<Point, std::string>> names(const std::array<Point, kCables>& points, char letter) {
  std::vector<std::pair<Point, std::string>> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto same =
        std::ranges::find_if(result, [&](const auto& entry) { return (entry.first - points[i]).norm() < 4; });
    const std::string name = fmt::format("{}{}", letter, i + 1);
    if (same == result.end()) {
      result.emplace_back(points[i], name);
    } else {
      same->second += " " + name;
    }
  }
  return result;
}

/// Lines between all pairs of distinct points, each pair once.
Html frame(const char* kind, const std::array<Point, kCables>& points) {
  Html result;
  for (std::size_t i = 0; i < kCables; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((points[i] - points[j]).norm() > 1) result += line(kind, points[i], points[j]);
    }
  }
  return result;
}

/// A round length of about a quarter of the view, as text and in metres.
std::pair<std::string, double> scale_bar(double metres_across) {
  const double wanted = metres_across / 4;
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  double length = power;
  for (const double step : {2.0, 5.0}) {
    if (step * power <= wanted) length = step * power;
  }
  return {length < 1 ? fmt::format("{:g} mm", length * 1000) : fmt::format("{:g} m", length), length};
}

constexpr const char* kStyle =
    "svg{background:#fff;font:12px "
    "sans-serif}.base{stroke:#8b949e;stroke-width:1.2}.platform{stroke:#1f5f99;stroke-width:1.6}"
    ".cable{stroke:#1d2329;stroke-width:1.2}.load{stroke:#b3261e;stroke-width:2.4}.axis{stroke:#59636e;stroke-width:1."
    "2}"
    ".scale{stroke:#1d2329;stroke-width:2}.tag{fill:#fff;stroke:#59636e}.number{text-anchor:middle;font-weight:600}"
    ".a{fill:#59636e}.b{fill:#1f5f99}.title{font-weight:600;font-size:14px}.soft{fill:#59636e}.loaded{fill:#b3261e}";

}  // namespace

std::string robot_drawing(const CaseSummary& summary) {
  if (summary.waypoints.empty()) {
    throw InputError(ErrorCode::kUse,
                     "--out: the case has no query, expected one: the robot is drawn at its first waypoint");
  }
  const Model<double>& model = summary.sampler.model();
  const Pose<double>& pose = summary.waypoints.front().pose;
  const Matrix3<double> turn = summary.sampler.rotation(pose);
  const Vector3<double> load = pose.p_WP + turn * model.p_PM;
  const Vector3<double> force = nominal_wrench(model.loads, model.wrench, turn).head<3>();
  const bool pulls = force.norm() > 0;
  const Vector3<double> down = pulls ? Vector3<double>(force.normalized()) : Vector3<double>(-Vector3<double>::UnitZ());

  Html drawn;
  const std::array<View, 3> all = views(down);
  double widest = 0;  // one scale for all of them [m]
  std::array<Eigen::AlignedBox2d, 3> bounds;
  for (std::size_t v = 0; v < all.size(); ++v) {
    for (std::size_t i = 0; i < kCables; ++i) {
      bounds[v].extend(all[v](model.p_WA[i]));
      bounds[v].extend(all[v](pose.p_WP + turn * model.p_PB[i]));
    }
    bounds[v].extend(all[v](load));
    widest = std::max(widest, bounds[v].sizes().maxCoeff());
  }
  if (!(widest > 0) || !std::isfinite(widest) || !load.allFinite() || !turn.allFinite()) {
    throw InputError(ErrorCode::kUse, "--out: the robot has no pose or size there that can be drawn");
  }
  const double scale = kSide / widest;
  for (std::size_t v = 0; v < all.size(); ++v) {
    const Point corner(kPad + static_cast<double>(v) * (kSide + 2 * kPad), kHead + kPad);
    const Point centre = corner + Point(kSide / 2, kSide / 2);
    const auto place = [&](const Vector3<double>& p) -> Point {
      return (all[v](p) - bounds[v].center()) * scale + centre;
    };
    std::array<Point, kCables> a;
    std::array<Point, kCables> b;
    for (std::size_t i = 0; i < kCables; ++i) {
      a[i] = place(model.p_WA[i]);
      b[i] = place(pose.p_WP + turn * model.p_PB[i]);
    }
    drawn += words("title", {corner.x() - kPad / 2, kHead + 6}, all[v].title);
    drawn += frame("base", a) + frame("platform", b);
    for (std::size_t i = 0; i < kCables; ++i) drawn += line("cable", a[i], b[i]);
    for (std::size_t i = 0; i < kCables; ++i) {
      const Point tag =
          (0.66 - 0.06 * static_cast<double>(i % 2)) * a[i] + (0.34 + 0.06 * static_cast<double>(i % 2)) * b[i];
      drawn += html("<circle class=\"tag\" cx=\"{}\" cy=\"{}\" r=\"8\"/>", fmt::format("{:.1f}", tag.x()),
                    fmt::format("{:.1f}", tag.y()));
      drawn += words("number", tag + Point(0, 4), std::to_string(i + 1));
    }
    for (const auto& [at, name] : names(a, 'A')) drawn += words("a", at + Point(5, -6), name);
    for (const auto& [at, name] : names(b, 'B')) drawn += words("b", at + Point(5, 15), name);
    const Point from = place(load);
    const Point pull = all[v](down) * 44;
    drawn += html("<circle class=\"load\" cx=\"{}\" cy=\"{}\" r=\"3\"/>", fmt::format("{:.1f}", from.x()),
                  fmt::format("{:.1f}", from.y()));
    if (pulls && pull.norm() > 1) drawn += arrow("load", from, from + pull);
    // The world's axes, those that are seen.
    const Point origin(corner.x(), kHead + 2 * kPad + kSide + 12);
    for (int c = 0; c < 3; ++c) {
      const Point axis = all[v](Vector3<double>::Unit(c)) * 26;
      if (axis.norm() < 3) continue;
      drawn += arrow("axis", origin, origin + axis) +
               words("soft", origin + 1.35 * axis + Point(-3, 4), std::string(1, "xyz"[c]));
    }
  }
  const auto [length, metres] = scale_bar(widest);
  const double y = kHead + 2 * kPad + kSide + 30;
  const double x = 3 * (kSide + 2 * kPad) - kPad - metres * scale;
  drawn += line("scale", {x, y}, {x + metres * scale, y}) + line("scale", {x, y - 4}, {x, y + 4}) +
           line("scale", {x + metres * scale, y - 4}, {x + metres * scale, y + 4}) + words("soft", {x, y - 8}, length);
  const double width = 3 * (kSide + 2 * kPad);
  const double height = kHead + 2 * kPad + kSide + kFoot;
  const std::string& name = summary.source.problem.name;
  const DisplayUnit unit = DisplayUnits(summary.source.units).force;
  const std::string pulling =
      pulls ? fmt::format("Red: the load, {:.4g} {} along ({:.3g}, {:.3g}, {:.3g})", unit.approx(force.norm()),
                          unit.name(), down(0) + 0.0, down(1) + 0.0, down(2) + 0.0)
            : "Red: the load point; the centre load has no force";
  drawn += words("title", {kPad / 2, 22}, name + ", at the first waypoint of its query") +
           words("loaded", {kPad / 2, 42}, pulling);
  return html(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} "
             "{}\"><title>{}</title>"
             "<style>{}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{}</svg>\n",
             fmt::format("{:.0f}", width), fmt::format("{:.0f}", height), fmt::format("{:.0f}", width),
             fmt::format("{:.0f}", height), name, kStyle, drawn)
      .str();
}

}  // namespace taut
