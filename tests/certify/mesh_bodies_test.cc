// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes among the bodies, from proof to checker.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "case/case_file.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "certify/path_proof.h"
#include "checker/check.h"
#include "tests/support/meshes.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::at;
using testing::box_mesh;
using testing::mesh_text;
using testing::sphere_mesh;

/// The crane of the cases with tolerances. Its bodies are the caller's.
Problem crane() {
  Problem problem = load_case(TAUT_SOURCE_DIR "/cases/cranes/portal-20t.yaml").problem;
  problem.query.clear();
  BodiesText bodies;
  bodies.cables.diameter_m.fill("0.028");
  bodies.cables.free_ends_m.fill({"1.5", "0.4"});
  bodies.clearance_m = {"0.2", "0.2", std::nullopt, "0.01"};
  problem.bodies = bodies;
  return problem;
}

BodyText block(const std::string& name, const std::array<double, 3>& half, const PointText& place) {
  HullText hull;
  for (const auto& corner : box_mesh(half).vertices) {
    hull.points_m.push_back({std::to_string(corner[0]), std::to_string(corner[1]), std::to_string(corner[2])});
  }
  return {.name = name, .at_m = place, .shape = hull};
}

BodyText mesh_block(const std::string& name, const std::array<double, 3>& half, const PointText& place, char digest) {
  return {.name = name, .at_m = place, .shape = mesh_text(box_mesh(half), digest)};
}

constexpr std::array<double, 3> kContainer = {1.25, 3, 1.25};
const PointText kBelow = {"0", "0", "-2.25"};
const PointText kOnFloor = {"0", "1", "1.25"};

Path path_through(const std::vector<std::vector<double>>& points) {
  Path path;
  for (const std::vector<double>& x : points) path.waypoints.push_back(at(x));
  return path;
}

checker::CheckOptions supplied(const Problem& problem) {
  checker::CheckOptions options;
  options.meshes = [&problem](const std::string&, const std::string& sha256) {
    for (const auto* bodies : {&problem.bodies->platform, &problem.bodies->obstacles}) {
      for (const BodyText& body : *bodies) {
        const auto* text = std::get_if<MeshText>(&body.shape);
        if (text == nullptr || text->sha256 != sha256) continue;
        const TriangleMesh& mesh = text->mesh->mesh();
        return checker::SuppliedMesh{sha256, mesh.vertices, mesh.triangles, mesh.needles};
      }
    }
    return checker::SuppliedMesh{};
  };
  return options;
}

struct Outcome {
  Verdict verdict;
  std::string message;
  double clearance_m = 0;
};

/// Proves, elaborates and checks.
Outcome outcome_of(Problem problem, const Path& path) {
  validate(problem);
  const Prover prover(problem);
  const Certificate certificate = elaborate(problem, path, prove_path(prover, path, {}, {}));
  Outcome result{certificate.verdict, certificate.undecided.value_or(OpenPart{}).reason};
  if (certificate.verdict == Verdict::kUndecided) return result;
  const checker::CheckResult checked = checker::check(certificate_text(certificate), supplied(problem));
  EXPECT_EQ(checked.outcome, checker::Outcome::kAccepted) << checked.message;
  if (checked.theorem && certificate.verdict == Verdict::kProved) {
    result.clearance_m = std::stod(checked.theorem->margins()["clearance_m"].get<std::string>());
  }
  return result;
}

/// One of the two bodies or both as a mesh.
Problem hall(bool is_container_mesh, bool is_stack_mesh, bool has_floor = true) {
  Problem problem = crane();
  problem.bodies->platform = {is_container_mesh ? mesh_block("container", kContainer, kBelow, 'a')
                                                : block("container", kContainer, kBelow)};
  problem.bodies->obstacles = {is_stack_mesh ? mesh_block("stack", kContainer, kOnFloor, 'b')
                                             : block("stack", kContainer, kOnFloor)};
  problem.bodies->obstacles[0].rotation_rad[2] = "(10)*pi/180";
  if (has_floor) problem.bodies->obstacles.push_back({.name = "floor", .shape = HalfSpaceText{{"0", "0", "1"}}});
  return problem;
}

TEST(MeshBodies, OfABoxAreProvedAsItsHullIs) {
  const Path path = path_through({{-4, 0, 6.6, 0, 0, -0.1}, {0, 0, 6.7, 0, 0, 0}, {4, 0, 6.6, 0, 0, 0.1}});
  const Outcome hulls = outcome_of(hall(false, false), path);
  ASSERT_EQ(hulls.verdict, Verdict::kProved) << hulls.message;
  for (const auto& [container, stack] : {std::pair(false, true), {true, false}, {true, true}}) {
    const Outcome meshes = outcome_of(hall(container, stack), path);
    ASSERT_EQ(meshes.verdict, Verdict::kProved) << container << stack << ": " << meshes.message;
    EXPECT_GT(meshes.clearance_m, 0);
    EXPECT_NEAR(meshes.clearance_m, hulls.clearance_m, 0.1) << container << stack;
  }
}

TEST(MeshBodies, OfABoxAreRefutedAsItsHullIs) {
  const Path path = path_through({{-4, 0, 6.1, 0, 0, -0.1}, {4, 0, 6.1, 0, 0, 0.1}});
  for (const auto& [container, stack] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
    const Outcome outcome = outcome_of(hall(container, stack), path);
    EXPECT_EQ(outcome.verdict, Verdict::kRefuted) << container << stack << ": " << outcome.message;
  }
}

}  // namespace
}  // namespace taut
