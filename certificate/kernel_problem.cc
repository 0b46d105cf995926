// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/kernel_problem.h"

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "checker/format/parts.h"

namespace taut {
namespace {

std::shared_ptr<const checker::Surface> to_kernel(const TriangleMesh& mesh) {
  return std::make_shared<const checker::Surface>(mesh.vertices, mesh.triangles, mesh.needles);
}

/// Hands over the meshes of bodies, which the JSON of a problem only names.
void supply_meshes(const std::vector<BodyText>& texts, std::vector<checker::RigidBody>& bodies,
                   std::map<std::string, std::shared_ptr<const checker::Surface>>& known) {
  for (std::size_t k = 0; k < texts.size(); ++k) {
    const auto* text = std::get_if<MeshText>(&texts[k].shape);
    if (text == nullptr || text->mesh == nullptr) continue;
    std::shared_ptr<const checker::Surface>& surface = known[text->sha256];
    if (surface == nullptr) surface = to_kernel(text->mesh->mesh());
    std::get<checker::MeshShape>(bodies.at(k).shape).surface = surface;
  }
}

}  // namespace

checker::Problem to_kernel(const Problem& problem) {
  const nlohmann::json json = to_json(problem);
  checker::Problem result = checker::read_problem(checker::Cursor(json, "problem"));
  if (problem.bodies) {
    std::map<std::string, std::shared_ptr<const checker::Surface>> known;  // by digest
    supply_meshes(problem.bodies->platform, result.bodies->platform, known);
    supply_meshes(problem.bodies->obstacles, result.bodies->obstacles, known);
  }
  return result;
}

}  // namespace taut
