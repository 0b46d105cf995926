// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/bodies/nearest_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <queue>

#include "certify/bodies/mesh_cover.h"
#include "certify/bodies/mesh_side.h"

namespace taut {
namespace {

using Point = Vector3<double>;

Point vector(const std::array<double, 3>& x) { return {x[0], x[1], x[2]}; }

/// A ball around a part of a body.
struct Bound {
  Point centre{0, 0, 0};
  double radius = 0;
};

/// What a search asks of one of two bodies.
class Side {
 public:
  explicit Side(const BodyInFrame& body) : body_(body), scale_(body.axes.col(0).norm()) {
    if (body.mesh != nullptr) return;
    for (const Point& x : body.points) all_.centre += x / static_cast<double>(body.points.size());
    for (const Point& x : body.points) all_.radius = std::max(all_.radius, (x - all_.centre).norm());
  }

  [[nodiscard]] MeshPart root() const { return {body_.mesh}; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] bool is_mesh() const { return body_.mesh != nullptr; }

  [[nodiscard]] Bound ball(const MeshPart& part) const {
    if (part.mesh == nullptr) return all_;
    if (part.is_element) {
      const Points x = points(part);
      Bound result{(x[0] + x[1] + x[2]) / 3};
      for (const Point& corner : x) result.radius = std::max(result.radius, (corner - result.centre).norm());
      return result;
    }
    const MeshBox& box = part.mesh->nodes()[part.index].box;
    const Point low = vector(box.lower), high = vector(box.upper);
    return {body_.origin + body_.axes * (0.5 * (low + high)), 0.5 * scale_ * (high - low).norm()};
  }

  /// The corners of a node, the points of an element or those of the whole body.
  [[nodiscard]] Points points(const MeshPart& part) const {
    if (part.mesh == nullptr || part.is_element) {
      return points_of(body_, part.is_element ? std::optional(part.index) : std::nullopt);
    }
    const MeshBox& box = part.mesh->nodes()[part.index].box;
    Points corners;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Point f;
      for (std::size_t k = 0; k < 3; ++k) {
        f(static_cast<int>(k)) = (corner >> k & 1U) != 0 ? box.upper[k] : box.lower[k];
      }
      corners.emplace_back(body_.origin + body_.axes * f);
    }
    return corners;
  }

 private:
  const BodyInFrame& body_;
  double scale_;
  Bound all_;
};

using AxisBox = Eigen::AlignedBox<double, 3>;

/// Around a part of a mesh, in the axes of its file.
AxisBox box_around(const MeshPart& part) {
  AxisBox result;
  const PartBoxes boxes(part);
  for (const MeshBox& box : boxes.all()) result.extend(AxisBox(vector(box.lower), vector(box.upper)));
  return result;
}

/// Around the points of a convex body, in the axes of a mesh's file.
AxisBox box_around(const BodyInFrame& convex, const BodyInFrame& mesh) {
  AxisBox result;
  const double squared_scale = mesh.axes.col(0).squaredNorm();
  for (const Point& x : convex.points) {
    result.extend(Point(mesh.axes.transpose() * (x - mesh.origin) / squared_scale));
  }
  return result;
}

double distance_to_segment(const Point& x, const Point& a, const Point& b) {
  const Point along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp((x - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (x - a - t * along).norm();
}

}  // namespace

Points points_of(const BodyInFrame& body, const std::optional<std::uint32_t>& element) {
  if (!element) return body.points;
  Points result;
  for (const auto& corner : body.mesh->points(*element)) {
    result.emplace_back(body.origin + body.axes * vector(corner));
  }
  return result;
}

namespace {

/// The nearest elements of two bodies, best first. Each part of either is inside of a ball and of the hull of some
/// points.
class ElementSearch {
 public:
  ElementSearch(const BodyInFrame& first, const BodyInFrame& second)
      : first_(first), a_(first), b_(second), scale_(b_.scale() / a_.scale()) {
    best_.nearest.distance = std::numeric_limits<double>::infinity();
    if (first.mesh == nullptr) of_convex_ = box_around(first, second);
    if (second.mesh == nullptr) of_convex_ = box_around(second, first);
    consider(a_.root(), b_.root());
  }

  /// Until the nearest elements are known.
  void run() { run(std::numeric_limits<double>::infinity()); }
  /// Until they are known to be farther apart than that, or how far.
  void run(double enough) {
    while (!open_.empty() && open_.top().bound < std::min(enough, best_.nearest.distance)) look_at_nearest();
  }

  [[nodiscard]] const NearestElements& best() const { return best_; }
  [[nodiscard]] double lower_bound() const {
    return open_.empty() ? best_.nearest.distance : std::min(best_.nearest.distance, open_.top().bound);
  }

 private:
  struct Task {
    MeshPart first, second;
    double bound;
    bool is_of_hulls = false;                                                ///< the bound is the distance of the hulls
    bool operator<(const Task& other) const { return bound > other.bound; }  // the least comes first
  };

  /// Bounds from balls and boxes are quick, hulls are asked for only where these are the least.
  void look_at_nearest() {
    Task task = open_.top();
    open_.pop();
    if (!task.is_of_hulls) {
      NearestPoints nearest = nearest_points(a_.points(task.first), b_.points(task.second));
      if (!task.first.may_open() && !task.second.may_open()) {
        if (nearest.distance < best_.nearest.distance) keep(task, std::move(nearest));
        return;
      }
      task.bound = std::max(task.bound, nearest.distance);
      task.is_of_hulls = true;
      if (!open_.empty() && open_.top().bound < task.bound) {
        open_.push(task);
        return;
      }
    }
    if (opens_first(task.first, task.second, scale_)) {
      for (const MeshPart& part : parts_of(task.first)) consider(part, task.second);
    } else {
      for (const MeshPart& part : parts_of(task.second)) consider(task.first, part);
    }
  }

  void consider(const MeshPart& x, const MeshPart& y) {
    const Bound p = a_.ball(x), q = b_.ball(y);
    const double middles = (p.centre - q.centre).norm();
    const bool is_of_cable = x.mesh == nullptr && first_.points.size() == 2;
    double bound = is_of_cable ? distance_to_segment(q.centre, first_.points[0], first_.points[1]) - q.radius
                               : middles - p.radius - q.radius;
    if (of_convex_) {
      const bool is_first = x.mesh == nullptr;
      const double apart = of_convex_->exteriorDistance(box_around(is_first ? y : x));
      bound = std::max(bound, (is_first ? b_ : a_).scale() * apart);
    }
    if (bound < best_.nearest.distance) open_.push({x, y, bound});
  }

  void keep(const Task& task, NearestPoints&& nearest) {
    const auto element = [](const MeshPart& part) {
      return part.is_element ? std::optional(part.index) : std::nullopt;
    };
    best_.nearest = std::move(nearest);
    best_.elements = {element(task.first), element(task.second)};
  }

  const BodyInFrame& first_;
  Side a_, b_;
  double scale_;
  std::optional<AxisBox> of_convex_;  ///< around the body that is no mesh, in the axes of the other's file
  NearestElements best_;
  std::priority_queue<Task> open_;
};

}  // namespace

NearestElements nearest_elements(const BodyInFrame& first, const BodyInFrame& second) {
  ElementSearch search(first, second);
  search.run();
  return search.best();
}

double distance_bound(const BodyInFrame& first, const BodyInFrame& second, double enough) {
  ElementSearch search(first, second);
  search.run(enough);
  return search.lower_bound();
}

namespace {

bool is_inside(const BodyInFrame& solid, const Point& point) {
  const Point f = solid.axes.transpose() * (point - solid.origin) / solid.axes.col(0).squaredNorm();
  MeshSide side = MeshSide::kUnknown;
  const bool is_known = run_upward([&] {
    side = mesh_side<Interval>(*solid.mesh, {Interval(f(0)), Interval(f(1)), Interval(f(2))});
  });
  return is_known && side == MeshSide::kInside;
}

/// An element with a vertex, and the vertex as shares of its points.
std::pair<std::uint32_t, Shares> element_with(const IndexedMesh& mesh, std::uint32_t vertex) {
  const auto& at = mesh.mesh().vertices[vertex];
  for (std::uint32_t element = 0;; ++element) {
    const auto corners = mesh.points(element);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (corners[k] != at) continue;
      Shares shares(corners.size());
      shares[k] = 1;
      return {element, shares};
    }
  }
}

}  // namespace

std::optional<PointInside> point_inside(const BodyInFrame& first, const BodyInFrame& second) {
  const std::array<const BodyInFrame*, 2> bodies = {&first, &second};
  for (std::size_t k = 0; k < 2; ++k) {
    const BodyInFrame &solid = *bodies[k], &other = *bodies[1 - k];
    if (solid.mesh == nullptr || !solid.mesh->is_watertight()) continue;
    if (other.mesh == nullptr) {
      if (!is_inside(solid, other.points.front())) continue;
      Shares shares(other.points.size());
      shares.front() = 1;
      return PointInside{k, std::move(shares), {}};
    }
    for (const std::uint32_t vertex : other.mesh->components()) {
      if (!is_inside(solid, other.origin + other.axes * vector(other.mesh->mesh().vertices[vertex]))) continue;
      auto [element, shares] = element_with(*other.mesh, vertex);
      return PointInside{k, std::move(shares), element};
    }
  }
  return std::nullopt;
}

namespace {

/// A body along a unit vector: of a mesh c + w·f, of others the extreme value.
struct AlongUnit {
  double value = 0;
  Point of_file{0, 0, 0};
};

AlongUnit along(const BodyInFrame& body, const Point& u, bool is_least) {
  if (body.mesh != nullptr) return {u.dot(body.origin), body.axes.transpose() * u};
  double value = u.dot(body.points.front());
  for (const Point& x : body.points) value = is_least ? std::min(value, u.dot(x)) : std::max(value, u.dot(x));
  return {value};
}

double extreme(const AlongUnit& along, std::span<const MeshBox> boxes, bool is_least) {
  if (boxes.empty()) return along.value;
  double result = is_least ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  for (const MeshBox& box : boxes) {
    double here = along.value;
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = along.of_file(static_cast<int>(k));
      here += w * ((w > 0) == is_least ? box.lower[k] : box.upper[k]);
    }
    result = is_least ? std::min(result, here) : std::max(result, here);
  }
  return result;
}

}  // namespace

std::uint32_t lowest_element(const BodyInFrame& body, const Point& u) {
  const AlongUnit of_body = along(body, u, true);
  const auto height = [&](std::size_t /*k*/, std::span<const MeshBox> boxes, std::span<const MeshBox> /*none*/) {
    return extreme(of_body, boxes, true);
  };
  return least_gap({body.mesh}, {}, 1, height).first.index;
}

std::vector<Point> covering_directions(const BodyInFrame& first, const BodyInFrame& second, double needed,
                                       double share) {
  constexpr std::size_t kMost = 64;
  const NearestElements nearest = nearest_elements(first, second);
  const double gap = nearest.nearest.distance - needed;
  std::vector<Point> result;
  if (!(gap > 0) || !(nearest.nearest.distance > 0)) return result;
  std::vector<std::array<AlongUnit, 2>> sides;
  const auto add = [&](const Point& apart) {
    result.push_back(apart.normalized());
    sides.push_back({along(first, result.back(), true), along(second, result.back(), false)});
  };
  add(nearest.nearest.apart);
  const Side a(first), b(second);
  CoverOptions options;
  options.enough = needed + share * gap;
  options.scale = b.scale() / a.scale();
  while (result.size() < kMost) {
    const auto gap_along = [&](std::size_t k, std::span<const MeshBox> x, std::span<const MeshBox> y) {
      return extreme(sides[k][0], x, true) - extreme(sides[k][1], y, false);
    };
    const LeastGap least = least_gap(a.root(), b.root(), sides.size(), gap_along, options);
    if (least.gap >= options.enough || (least.first.mesh == nullptr && least.second.mesh == nullptr)) break;
    const NearestPoints apart = nearest_points(a.points(least.first), b.points(least.second));
    if (!(apart.distance > options.enough)) break;  // rounding
    add(apart.apart);
  }
  return result;
}

}  // namespace taut
