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

/// By name and digest: how bytes are read depends on the name, too.
using MeshesRead = std::map<std::pair<std::string, std::string>, std::shared_ptr<const IndexedMesh>>;

void add_meshes(const Problem& problem, MeshesRead& meshes) {
  if (!problem.bodies) return;
  for (const auto* bodies : {&problem.bodies->platform, &problem.bodies->obstacles}) {
    for (const BodyText& body : *bodies) {
      const auto* text = std::get_if<MeshText>(&body.shape);
      if (text != nullptr && text->mesh != nullptr) meshes[{text->file, text->sha256}] = text->mesh;
    }
  }
}

checker::MeshSupplier supplier_of(MeshesRead meshes) {
  return [meshes = std::move(meshes)](const std::string& file, const std::string& sha256) {
    const auto found = meshes.find({file, sha256});
    if (found == meshes.end()) throw InputError("the mesh '" + excerpt(file) + "' was not read");
    return supplied(found->second->mesh(), sha256);
  };
}

std::vector<std::pair<std::string, std::string>> files_of(const std::vector<MeshOfBody>& meshes) {
  std::vector<std::pair<std::string, std::string>> files;
  std::map<std::string, std::string> digests;  // by name
  for (const MeshOfBody& mesh : meshes) {
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

}  // namespace

checker::MeshSupplier meshes_of(const Problem& problem) {
  MeshesRead meshes;
  add_meshes(problem, meshes);
  return supplier_of(std::move(meshes));
}

checker::MeshSupplier meshes_of(std::span<const CaseLeg> legs) {
  MeshesRead meshes;
  for (const CaseLeg& leg : legs) add_meshes(leg.content.problem, meshes);
  return supplier_of(std::move(meshes));
}

checker::MeshSupplier meshes_in(std::vector<std::filesystem::path> folders) {
  return [folders = std::move(folders)](const std::string& file, const std::string& sha256) {
    const LoadedMesh loaded = find_mesh(folders, file, sha256);
    return supplied(loaded.mesh, loaded.sha256);
  };
}

std::vector<std::pair<std::string, std::string>> mesh_files(const Case& the_case) {
  return the_case.bodies ? files_of(the_case.bodies->meshes) : std::vector<std::pair<std::string, std::string>>();
}

std::vector<std::pair<std::string, std::string>> mesh_files(std::span<const CaseLeg> legs) {
  std::vector<MeshOfBody> meshes;
  for (const CaseLeg& leg : legs) {
    if (const auto& bodies = leg.content.bodies) {
      meshes.insert(meshes.end(), bodies->meshes.begin(), bodies->meshes.end());
    }
  }
  return files_of(meshes);
}

}  // namespace taut
