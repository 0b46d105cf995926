// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/body_shapes.h"

#include <Eigen/Geometry>

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
  std::vector<BodyShape> result;
  if (!scene.bodies) return result;
  const BodiesText& text = *scene.certificate.problem.bodies;
  const BodyModel<double>& model = scene.bodies->bodies();
  const auto add = [&](const BodyText& body, BodyShape shape, bool is_obstacle) {
    shape.name = body.name;
    shape.is_obstacle = is_obstacle;
    if (std::holds_alternative<MeshText>(body.shape)) shape.mesh = &scene.shown_meshes.at(body.name);
    result.push_back(std::move(shape));
  };
  for (std::size_t k = 0; k < text.obstacles.size(); ++k) add(text.obstacles[k], shape_of(model.obstacles[k]), true);
  for (std::size_t k = 0; k < text.platform.size(); ++k) add(text.platform[k], shape_of(model.platform[k]), false);
  return result;
}

std::string body_names(const std::vector<BodyText>& bodies, std::size_t most) {
  std::string names;
  for (std::size_t k = 0; k < std::min(most, bodies.size()); ++k) {
    names += (k == 0 ? "" : ", ") + quoted_name(bodies[k].name);
  }
  return bodies.size() > most ? names + " and " + std::to_string(bodies.size() - most) + " more" : names;
}

}  // namespace taut
