// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/body_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/plural.h"
#include "reports/page/machine_view.h"
#include "reports/summary/load_statement.h"

namespace taut {
namespace {

BodyShape shape_of(const ConvexBody<double>& hull) {
  BodyShape shape;
  shape.points = {hull.points.begin(), hull.points.end()};
  shape.radius = hull.radius;
  return shape;
}

BodyShape shape_of(const Obstacle<double>& obstacle) {
  if (const auto* hull = std::get_if<ConvexBody<double>>(&obstacle)) return shape_of(*hull);
  const auto& half_space = std::get<HalfSpace<double>>(obstacle);
  BodyShape shape;
  shape.is_half_space = true;
  shape.normal = half_space.normal.normalized();
  shape.offset = half_space.offset / half_space.normal.norm();
  return shape;
}

}  // namespace

std::vector<Eigen::Vector3d> BodyShape::box() const {
  if (is_half_space) return {};
  if (mesh) return box_corners(*mesh);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) {
    box.extend(Eigen::Vector3d(p.array() - radius));
    box.extend(Eigen::Vector3d(p.array() + radius));
  }
  std::vector<Eigen::Vector3d> result;
  for (int k = 0; k < 8; ++k) result.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)));
  return result;
}

std::vector<BodyShape> body_shapes(const ReportContext& scene) {
  if (!scene.bodies) return {};
  return body_shapes(*scene.certificate.problem.bodies, scene.bodies->bodies(), scene.shown_meshes);
}

std::vector<BodyShape> body_shapes(const BodiesText& bodies, const BodyModel<double>& model,
                                   const std::map<std::string, ShownBody>& meshes) {
  std::vector<BodyShape> result;
  const auto add = [&](const BodyText& body, BodyShape shape, bool is_obstacle) {
    shape.name = body.name;
    shape.is_obstacle = is_obstacle;
    if (std::holds_alternative<MeshText>(body.shape)) shape.mesh = &meshes.at(body.name);
    result.push_back(std::move(shape));
  };
  for (std::size_t k = 0; k < bodies.obstacles.size(); ++k) {
    add(bodies.obstacles[k], shape_of(model.obstacles[k]), true);
  }
  for (std::size_t k = 0; k < bodies.platform.size(); ++k) {
    add(bodies.platform[k], shape_of(model.platform[k]), false);
  }
  return result;
}

std::vector<Eigen::Vector3d> near_parts(const std::vector<BodyShape>& bodies,
                                        const std::vector<Eigen::Vector3d>& points) {
  constexpr double kBeyond = 0.25;  // of the size of the machine
  Eigen::AlignedBox3d machine;
  for (const Eigen::Vector3d& p : points) machine.extend(p);
  const Eigen::Vector3d more = Eigen::Vector3d::Constant(kBeyond * machine.sizes().maxCoeff());
  machine = Eigen::AlignedBox3d(Eigen::Vector3d(machine.min() - more), Eigen::Vector3d(machine.max() + more));
  std::vector<Eigen::Vector3d> result;
  for (const BodyShape& body : bodies) {
    if (!body.is_obstacle || body.is_half_space) continue;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : body.box()) box.extend(p);
    box = box.intersection(machine);
    if (box.isEmpty()) continue;
    for (int k = 0; k < 8; ++k) result.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)));
  }
  return result;
}

std::string edges_data(const ShownBody& body, const Eigen::Vector3d& towards,
                       const std::function<Point2(const Eigen::Vector3d&)>& place) {
  constexpr std::size_t kMostEdges = 2000;
  struct Edge {
    Point2 a, b;
  };
  std::vector<Edge> edges;
  for (const auto& [a, b] : feature_edges(body, towards)) {
    edges.push_back({place(Eigen::Vector3d(a[0], a[1], a[2])), place(Eigen::Vector3d(b[0], b[1], b[2]))});
  }
  std::ranges::sort(edges, std::greater(), [](const Edge& e) { return (e.a - e.b).norm(); });
  edges.resize(std::min(edges.size(), kMostEdges), {Point2::Zero(), Point2::Zero()});
  std::string data;
  for (const Edge& edge : edges) data += path_data({edge.a, edge.b}, false);
  return data;
}

std::string body_names(const std::vector<BodyText>& bodies, std::size_t most) {
  std::string names;
  for (std::size_t k = 0; k < std::min(most, bodies.size()); ++k) {
    names += (k == 0 ? "" : ", ") + quoted_name(bodies[k].name);
  }
  return bodies.size() > most ? names + " and " + std::to_string(bodies.size() - most) + " more" : names;
}

}  // namespace taut
