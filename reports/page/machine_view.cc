// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/machine_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "problem/rational.h"
#include "reports/page/body_shapes.h"

namespace taut {

namespace {

using Eigen::Vector3d;

constexpr double kTooLarge = 1e15;  ///< [m]
constexpr double kNearlyAlong = 0.9;

Matrix3<double> level() { return Matrix3<double>::Identity(); }

MachineView::Grid grid_below(const MachineView& view) {
  const auto range = [&](const Vector3d& axis) {
    const auto [low, high] = std::ranges::minmax(view.swept, {}, [&](const Vector3d& p) { return axis.dot(p); });
    return std::pair(axis.dot(low), axis.dot(high));
  };
  const auto [lowest, highest] = range(view.up);
  const auto [left, right] = range(view.across);
  const auto [front, back] = range(view.inward);
  const double size = std::max({highest - lowest, right - left, back - front});
  MachineView::Grid grid;
  // The level through the origin, if it is close below the machine; else one that is.
  constexpr double kBelow = 0.06;
  grid.height = lowest >= 0 && lowest <= highest - lowest ? 0 : lowest - kBelow * size;
  constexpr double kCells = 3.5;
  grid.step = round_length(std::max({right - left, back - front, size / 2}) / kCells);
  const auto steps = [&](double low, double high) {
    constexpr double kBeyond = 0.15;  // of a step
    return std::array{static_cast<int>(std::floor(low / grid.step - kBeyond)),
                      static_cast<int>(std::ceil(high / grid.step + kBeyond))};
  };
  grid.across = steps(left, right);
  grid.inward = steps(front, back);
  return grid;
}

/// The height of a level half-space below the machine, on which it stands; nothing where there is none.
std::optional<double> floor_height(const MachineView& view, const std::vector<BodyShape>& bodies) {
  std::optional<double> height;
  for (const BodyShape& body : bodies) {
    if (!body.is_half_space || body.normal.dot(view.up) < 1 - 1e-9) continue;
    const bool is_below = std::ranges::all_of(view.swept, [&](const Vector3d& p) {
      return body.normal.dot(p) > body.offset - 1e-6 * std::abs(body.offset) - 1e-9;
    });
    if (is_below && (!height || body.offset > *height)) height = body.offset;
  }
  return height;
}

/// The area inside the outline of some points in the picture [m²].
double area(const std::vector<Point2>& points) {
  const std::vector<std::size_t> corners = hull(points);
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2& a = points[corners[i]];
    const Point2& b = points[corners[(i + 1) % corners.size()]];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

/// How much anchors, cables and the platform are in front of each other at a pose; 0 is best.
double clutter(const MachineView& view, const std::vector<Vector3d>& base, const std::vector<Vector3d>& platform,
               double size) {
  constexpr double kClose = 0.04;  // of the machine's size
  double result = 0;
  const std::vector<Vector3d> anchors = distinct(base);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      result += 1 / (kClose + std::abs(view.right().dot(anchors[i] - anchors[j])) / size);
    }
  }
  std::vector<Point2> outline;
  double width = 0;
  for (std::size_t i = 0; i < kCables; ++i) {
    outline.push_back(view(platform[i]));
    for (std::size_t j = 0; j < i; ++j) {
      width = std::max(width, (platform[i] - platform[j]).norm());
      for (const double t : {0.3, 0.6}) {
        const Vector3d apart = (1 - t) * (base[i] - base[j]) + t * (platform[i] - platform[j]);
        result += 0.5 / (kClose + view(apart).norm() / size);
      }
    }
  }
  constexpr double kSeenSideways = 0.05;
  return result + (width > 0 ? 3 / (kSeenSideways + area(outline) / (width * width)) : 0);
}

/// The azimuth at which the machine is best seen along its path, of steps of 10 degrees.
double best_azimuth(MachineView view, const ReportContext& scene, double size) {
  constexpr int kSteps = 36;
  constexpr std::size_t kPoses = 4;
  std::vector<std::vector<Vector3d>> poses;
  for (std::size_t k = 0; k <= kPoses; ++k) {
    poses.push_back(platform_at(scene, scene.samples[(scene.samples.size() - 1) * k / kPoses].pose));
  }
  const std::vector<Vector3d> base = base_of(scene);
  double best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kSteps; ++k) {
    const int steps = k % 2 == 0 ? -k / 2 : (k + 1) / 2;  // 0, 1, −1, 2, …
    const int from_axis = std::abs(steps) % (kSteps / 4);
    if (from_axis < 2 || from_axis > kSteps / 4 - 2) continue;  // along an axis depth can't be seen
    view.azimuth = 2 * std::numbers::pi / kSteps * steps;
    double total = 0;
    for (const std::vector<Vector3d>& platform : poses) total += clutter(view, base, platform, size);
    total *= 1 + 0.01 * k;  // rather from the front
    if (total < least) {
      least = total;
      best = view.azimuth;
    }
  }
  return best;
}

}  // namespace

Vector3d downward(const Model<double>& model, const LoadText& load) {
  Vector3d down = Vector3d::Zero();
  if (std::ranges::any_of(load.items, [](const LoadItem& i) { return std::holds_alternative<Weight>(i.what); })) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      down(k) = from_rational<double>(load.gravity_m_s2[static_cast<std::size_t>(k)]);
    }
  }
  if (!(down.norm() > 0)) down = nominal_wrench(model.loads, model.wrench, level()).head<3>();
  const double size = down.norm();
  if (!(size > 0) || !std::isfinite(size)) return -Vector3d::UnitZ();
  down /= size;
  Eigen::Index most = 0;
  down.cwiseAbs().maxCoeff(&most);
  // People's axes are upright: one that is nearly so is meant.
  if (std::abs(down(most)) > kNearlyAlong) return std::copysign(1.0, down(most)) * Vector3d::Unit(most);
  return down;
}

Vector3d across_of(const Vector3d& up) {
  const Vector3d reference = std::abs(up.x()) < kNearlyAlong ? Vector3d::UnitX() : Vector3d::UnitY();
  return (reference - reference.dot(up) * up).normalized();
}

std::vector<Vector3d> platform_at(const ReportContext& scene, const Pose<double>& pose) {
  const Model<double>& model = scene.sampler.model();
  const Matrix3<double> turn = rotation(model.angles, pose.angles);
  std::vector<Vector3d> result;
  for (const Vector3d& b : model.p_PB) result.emplace_back(pose.p_WP + turn * b);
  return result;
}

Vector3d load_point_at(const ReportContext& scene, const Pose<double>& pose) {
  return pose.p_WP + rotation(scene.sampler.model().angles, pose.angles) * scene.sampler.model().p_PM;
}

std::vector<Vector3d> weights_at(const ReportContext& scene, const Pose<double>& pose) {
  std::vector<Vector3d> result;
  for (const LoadItem& item : scene.certificate.problem.load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (!weight) continue;
    const Vector3d at(from_rational<double>(weight->at[0]), from_rational<double>(weight->at[1]),
                      from_rational<double>(weight->at[2]));
    result.emplace_back(pose.p_WP + rotation(scene.sampler.model().angles, pose.angles) * at);
  }
  return result;
}

std::vector<Vector3d> base_of(const ReportContext& scene) {
  const auto& anchors = scene.sampler.model().p_WA;
  return {anchors.begin(), anchors.end()};
}

std::vector<Vector3d> box_corners(const std::optional<ShownBody>& body) {
  return body ? box_corners(*body) : std::vector<Vector3d>();
}

std::vector<Vector3d> box_corners(const ShownBody& body) {
  Eigen::AlignedBox3d box;
  for (const std::array<double, 3>& corner : body.corners) box.extend(Vector3d(corner[0], corner[1], corner[2]));
  std::vector<Vector3d> result;
  for (int k = 0; k < 8; ++k) result.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)));
  return result;
}

MachineView::MachineView(const ReportContext& scene)
    : up(-downward(scene.sampler.model(), scene.certificate.problem.load)), elevation(0.3) {
  across = across_of(up);
  inward = up.cross(across);
  swept = base_of(scene);
  const Decoration& shown = scene.illustration.decoration;
  std::ranges::copy(box_corners(shown.frame), std::back_inserter(swept));
  std::vector<Vector3d> payload = box_corners(shown.payload);
  const std::vector<BodyShape> bodies = body_shapes(scene);
  for (const BodyShape& body : bodies) {
    if (!body.is_obstacle) std::ranges::copy(body.box(), std::back_inserter(payload));
  }
  const bool is_path = !found_no_path(scene.certificate);
  constexpr std::size_t kPoses = 120;
  const std::size_t stride = is_path ? std::max<std::size_t>(1, scene.samples.size() / kPoses) : 1;
  for (std::size_t k = 0; k < scene.samples.size(); k += stride) {
    const PathSample& sample = scene.samples[k + stride < scene.samples.size() ? k : scene.samples.size() - 1];
    if (!is_path && sample.position != std::floor(sample.position)) continue;  // nothing is between the waypoints
    std::ranges::copy(platform_at(scene, sample.pose), std::back_inserter(swept));
    swept.push_back(load_point_at(scene, sample.pose));
    std::ranges::copy(weights_at(scene, sample.pose), std::back_inserter(swept));
    const Matrix3<double> turn = rotation(scene.sampler.model().angles, sample.pose.angles);
    for (const Vector3d& corner : payload) swept.emplace_back(sample.pose.p_WP + turn * corner);
  }
  std::ranges::copy(near_parts(bodies, swept), std::back_inserter(swept));
  const auto is_number = [](const Vector3d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kTooLarge; };
  is_drawable = std::ranges::all_of(swept, is_number);
  if (!is_drawable) return;
  const auto apart = [&](const Vector3d& p) { return (p - swept.front()).norm(); };
  const double size = apart(*std::ranges::max_element(swept, {}, apart));
  // What is tiny and far away has no digits left to be drawn with.
  is_drawable = size > 0 && swept.front().norm() < 1e9 * size;
  if (!is_drawable) return;
  grid = grid_below(*this);
  if (const auto floor = floor_height(*this, bodies)) grid.height = *floor;
  if (!scene.samples.empty()) azimuth = best_azimuth(*this, scene, size);
}

std::array<Vector3d, 4> MachineView::plane(const Vector3d& normal, double offset) const {
  Vector3d along = up.cross(normal);
  along = along.norm() > 1e-6 ? along.normalized() : across;
  const Vector3d aside = normal.cross(along);
  Eigen::AlignedBox2d box;
  for (const Vector3d& p : swept) {
    box.extend(Point2(along.dot(p), aside.dot(p)));
    box.extend(Point2(along.dot(foot(p)), aside.dot(foot(p))));
  }
  constexpr double kMore = 0.06;  // of its size
  const Point2 more = Point2::Constant(kMore * box.sizes().maxCoeff());
  const Point2 low = box.min() - more;
  const Point2 high = box.max() + more;
  const auto at = [&](double a, double b) -> Vector3d { return a * along + b * aside + offset * normal; };
  return {at(low.x(), low.y()), at(high.x(), low.y()), at(high.x(), high.y()), at(low.x(), high.y())};
}

Vector3d MachineView::right() const { return std::cos(azimuth) * across + std::sin(azimuth) * inward; }
Vector3d MachineView::towards() const {
  return std::cos(elevation) * (std::sin(azimuth) * across - std::cos(azimuth) * inward) + std::sin(elevation) * up;
}
Vector3d MachineView::upward() const { return towards().cross(right()); }

}  // namespace taut
