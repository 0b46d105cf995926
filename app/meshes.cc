// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/meshes.h"

#include <map>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "case/mesh_search.h"

namespace taut {
namespace {

checker::SuppliedMesh supplied(const TriangleMesh& mesh, std::string sha256) {
  return {std::move(sha256), mesh.vertices, mesh.triangles, mesh.needles};
}

}  // namespace

checker::MeshSupplier meshes_of(const Problem& problem) {
  // By name and digest: how bytes are read depends on the name, too.
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const IndexedMesh>> meshes;
  if (problem.bodies) {
    for (const auto* bodies : {&problem.bodies->platform, &problem.bodies->obstacles}) {
      for (const BodyText& body : *bodies) {
        const auto* text = std::get_if<MeshText>(&body.shape);
        if (text != nullptr && text->mesh != nullptr) meshes[{text->file, text->sha256}] = text->mesh;
      }
    }
  }
  return [meshes = std::move(meshes)](const std::string& file, const std::string& sha256) {
    const auto found = meshes.find({file, sha256});
    if (found == meshes.end()) throw InputError("the mesh '" + excerpt(file) + "' was not read");
    return supplied(found->second->mesh(), sha256);
  };
}

checker::MeshSupplier meshes_in(std::vector<std::filesystem::path> folders) {
  return [folders = std::move(folders)](const std::string& file, const std::string& sha256) {
    const LoadedMesh loaded = find_mesh(folders, file, sha256);
    return supplied(loaded.mesh, loaded.sha256);
  };
}

std::vector<std::pair<std::string, std::string>> mesh_files(const Case& the_case) {
  std::vector<std::pair<std::string, std::string>> files;
  if (!the_case.bodies) return files;
  std::map<std::string, std::string> digests;  // by name
  for (const MeshOfBody& mesh : the_case.bodies->meshes) {
    const std::string& digest = mesh.mesh->sha256;
    std::string name = mesh_name_beside(mesh.path.string(), digest);
    if (const auto [at, is_new] = digests.emplace(name, digest); !is_new && at->second != digest) {
      name = mesh_name_beside(mesh.path.string(), digest, true);
      digests.emplace(name, digest);
    } else if (!is_new) {
      continue;
    }
    std::string bytes = mesh_bytes(mesh.path);
    if (checker::sha256(bytes) != digest) {
      throw InputError("the mesh '" + excerpt(mesh.path.string()) + "' has changed since it was read");
    }
    files.emplace_back(std::move(name), std::move(bytes));
  }
  return files;
}

}  // namespace taut
