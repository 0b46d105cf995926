// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/mesh_search.h"

#include <fmt/format.h>

#include <system_error>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "base/sha256.h"

namespace taut {

std::string mesh_name_beside(const std::string& file, const std::string& sha256, bool is_taken) {
  constexpr std::size_t kDigits = 8;  // of the digest
  const std::string name = std::filesystem::path(file).filename().string();
  return is_taken ? sha256.substr(0, kDigits) + "-" + name : name;
}

namespace {

/// Whether a name stays in the folder that it is looked for in. A certificate may come from anyone.
bool stays_inside(const std::string& file) {
  const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
  return path.is_relative() && !path.empty() && *path.begin() != "..";
}

}  // namespace

LoadedMesh find_mesh(const std::vector<std::filesystem::path>& folders, const std::string& file,
                     const std::string& sha256) {
  const auto fail = [&](const std::string& what) {
    throw InputError(ErrorCode::kCase, fmt::format("the mesh '{}': {}", excerpt(file), what));
  };
  if (!is_mesh_name(file)) fail(fmt::format("expected {}", kMeshNameExpected));
  std::string looked_at;
  bool has_other = false;
  for (const std::filesystem::path& folder : folders) {
    looked_at += (looked_at.empty() ? "" : ", ") + (folder.empty() ? std::string(".") : sanitize(folder.string()));
    std::vector<std::string> names = {mesh_name_beside(file, sha256), mesh_name_beside(file, sha256, true)};
    if (stays_inside(file)) names.insert(names.begin(), file);
    for (const std::string& name : names) {
      std::error_code ignored;
      const std::filesystem::path path = folder / name;
      if (!std::filesystem::is_regular_file(path, ignored)) continue;
      const std::string bytes = mesh_bytes(path);
      Sha256 digest;
      digest.update(bytes);
      if (digest.hex() != sha256) {
        has_other = true;
        continue;
      }
      LoadedMesh mesh = repaired(read_polygons(extension_of(name), bytes));
      mesh.sha256 = sha256;
      return mesh;
    }
  }
  fail(fmt::format("expected the file with SHA-256 {} in {}; {}", sha256, looked_at,
                   has_other ? "a file of this name is there, with another digest" : "there is no file of this name"));
  return {};
}

}  // namespace taut
