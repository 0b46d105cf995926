// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes with bodies that benchmarks measure, and their clock.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "case/case_file.h"
#include "tests/support/meshes.h"

namespace taut::bench {

/// Processor time of this process, all threads of it, which a busy machine disturbs less than the wall clock [s].
inline double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

inline double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// The text of a case of `cases/`, without the section whose first line begins with `key`, if it has one.
inline std::string text_without(const std::string& file, const std::string& key) {
  std::ifstream in(std::string(TAUT_SOURCE_DIR "/cases/") + file);
  if (!in) throw std::runtime_error("no case " + file);
  std::string text;
  bool is_in_section = false;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line[0] != ' ' && line[0] != '#') is_in_section = line.starts_with(key);
    if (!is_in_section) text += line + "\n";
  }
  return text;
}

/// The 20 t portal crane and its container in a hall: a floor, four containers in a row below its way, a post, a pipe,
/// two balls and a wall. 10 obstacles, with 10 pairs of container and obstacle, 15 of cables, 60 of cables and
/// obstacles, 6 of cables and container.
inline constexpr const char* kHall = R"(
  cables: {diameter: 28 mm, free_ends: [0.5, 0.4]}
  platform:
    - {name: container, box: [2.4, 6.1, 2.6], at: [0, 0, -2.2]}
  obstacles:
    - {name: floor, half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}
    - {name: first, box: [2.4, 6.1, 2.6], at: [-4.5, 0, 1.3]}
    - {name: second, box: [2.4, 6.1, 2.6], at: [-1.5, 0, 1.3], yaw: 5}
    - {name: third, box: [2.4, 6.1, 2.6], at: [1.5, 0, 1.3], yaw: -5}
    - {name: fourth, box: [2.4, 6.1, 2.6], at: [4.5, 0, 1.3]}
    - {name: post, capsule: {from: [-6, 6, 0], to: [-6, 6, 5], radius: 0.15}}
    - {name: pipe, cylinder: {from: [-6, -5.5, 4], to: [6, -5.5, 4], radius: 0.2}}
    - {name: tank, ball: {radius: 1.5, at: [0, 7, 1.5]}}
    - {name: lamp, ball: {radius: 0.3, at: [0, -2, 13]}}
    - {name: wall, half_space: {point: [18, 0, 0], normal: [-1, 0, 0]}}
)";

/// Ten obstacles around Robot 2 on its sphere: the sphere, a post in the way, a floor, posts on it, blocks and balls.
inline constexpr const char* kSphere = R"(
  cables: {diameter: 1, free_ends: 20}
  platform:
    - {name: plate, points: [[-129.9038, 75, 0], [129.9038, 75, 0], [0, -150, 0]], radius: 2}
  obstacles:
    - {name: sphere, ball: {radius: 100, at: [0, 0, 306]}}
    - {name: post, capsule: {from: [0, 45.7, 217.06], to: [0, 51.18, 206.4], radius: 4}}
    - {name: floor, half_space: {point: [0, 0, 450], normal: [0, 0, -1]}}
    - {name: east post, capsule: {from: [260, 0, 450], to: [260, 0, 330], radius: 5}}
    - {name: west post, capsule: {from: [-260, 0, 450], to: [-260, 0, 330], radius: 5}}
    - {name: south post, cylinder: {from: [0, -250, 450], to: [0, -250, 200], radius: 5}}
    - {name: block, box: [40, 60, 80], at: [150, 220, 410], yaw: 0.5}
    - {name: other block, box: [40, 60, 80], at: [-150, 220, 410], yaw: -0.5}
    - {name: lamp, ball: {radius: 15, at: [0, 0, 40]}}
    - {name: tank, ball: {radius: 40, at: [0, -200, 400]}}
)";

/// A case of `cases/` with these bodies; `classes` is the list of those that are checked.
inline std::string case_with(const std::string& file, const std::string& clearance, const std::string& classes,
                             const char* bodies) {
  return text_without(file, "bodies:") + "bodies:\n  clearance: " + clearance + "\n  pairs: [" + classes + "]" + bodies;
}

/// A heap of gravel, 2.5 m high: a bumpy sphere of 131,072 triangles, closed, with its centre on the floor.
inline TriangleMesh heap() {
  TriangleMesh mesh = testing::sphere_mesh(1, 7);
  for (auto& [x, y, z] : mesh.vertices) {
    const double r = 2.4 + 0.05 * std::sin(23 * x) * std::sin(19 * y + 1) + 0.05 * std::sin(31 * z + 5 * x);
    x *= r, y *= r, z *= r;
  }
  return mesh;
}

/// Writes a binary STL file.
inline void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&](const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
  put(std::array<char, 80>{});
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    put(std::array<float, 3>{});
    for (const std::uint32_t corner : triangle) {
      for (const double x : mesh.vertices[corner]) put(static_cast<float>(x));
    }
    put(std::uint16_t{0});
  }
}

/// Writes a case, with its heap beside it, in which the crane carries its container over the heap.
/// @returns the file of the case
inline std::filesystem::path write_heap_case(const std::filesystem::path& folder) {
  write_stl(heap(), folder / "heap.stl");
  const std::filesystem::path path = folder / "heap.yaml";
  std::ofstream(path) << text_without("cranes/portal-20t-stack.yaml", "bodies:") << R"(
bodies:
  clearance: {default: 200 mm, cables-cables: 20 mm, cables-platform: 10 mm}
  cables: {diameter: 28 mm, free_ends: [0.5, 0.4]}
  platform:
    - {name: container, box: [2.4, 6.1, 2.6], at: [0, 0, -2.2]}
  obstacles:
    - {name: floor, half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}
    - {name: heap, mesh: heap.stl, unit: m}
)";
  return path;
}

/// A folder that goes away.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "taut-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace taut::bench
