// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes among the bodies, from proof to checker.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <random>
#include <utility>

#include "base/input_error.h"
#include "case/case_file.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "certify/bodies/nearest_mesh.h"
#include "certify/path_proof.h"
#include "checker/check.h"
#include "tests/support/meshes.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::at;
using testing::box_mesh;
using testing::joined_meshes;
using testing::mesh_text;
using testing::one_sided_mesh;
using testing::sphere_mesh;
using testing::twice_wound_mesh;

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
  constexpr double kLeast = 0.4;  // 3.2 m, less 2.6 m and the clearance, in the middle; of which both are lower bounds
  EXPECT_GT(hulls.clearance_m, 0);
  EXPECT_LT(hulls.clearance_m, kLeast);
  for (const auto& [container, stack] : {std::pair(false, true), {true, false}, {true, true}}) {
    const Outcome meshes = outcome_of(hall(container, stack), path);
    ASSERT_EQ(meshes.verdict, Verdict::kProved) << container << stack << ": " << meshes.message;
    EXPECT_GT(meshes.clearance_m, 0);
    EXPECT_LT(meshes.clearance_m, kLeast);
  }
}

TEST(MeshBodies, OfABoxAreRefutedAsItsHullIs) {
  const Path path = path_through({{-4, 0, 6.1, 0, 0, -0.1}, {4, 0, 6.1, 0, 0, 0.1}});
  for (const auto& [container, stack] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
    const Outcome outcome = outcome_of(hall(container, stack), path);
    EXPECT_EQ(outcome.verdict, Verdict::kRefuted) << container << stack << ": " << outcome.message;
  }
}

// ---- More than one direction ----------------------------------------------------------------------------------------

/// An arch of three boxes in one mesh: two legs and a beam on top of them, 12 m wide and 9 m high inside, along x.
TriangleMesh arch() {
  TriangleMesh mesh;
  const auto add = [&](const std::array<double, 3>& half, const std::array<double, 3>& at) {
    const TriangleMesh box = box_mesh(half);
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& x : box.vertices) mesh.vertices.push_back({x[0] + at[0], x[1] + at[1], x[2] + at[2]});
    for (const auto& [a, b, c] : box.triangles) mesh.triangles.push_back({a + offset, b + offset, c + offset});
  };
  add({1, 1, 4.5}, {0, -7, 4.5});
  add({1, 1, 4.5}, {0, 7, 4.5});
  add({1, 8, 0.5}, {0, 0, 9.5});
  return mesh;
}

/// The container moves through the arch, whose hull it enters.
Problem through_arch(std::optional<DecimalText> clearance) {
  Problem problem = crane();
  problem.bodies->platform = {block("load", {0.5, 0.5, 0.5}, {"0", "0", "-1"})};
  problem.bodies->obstacles = {{.name = "arch", .shape = mesh_text(arch(), 'c')}};
  problem.bodies->clearance_m = {std::move(clearance), std::nullopt, std::nullopt, std::nullopt};
  return problem;
}

TEST(MeshBodies, MayBeEnteredWhereTheyAreHollow) {
  const Path path = path_through({{-3, 0, 6, 0, 0, 0}, {3, 0, 6, 0, 0, 0}});
  const Outcome outcome = outcome_of(through_arch("0.5"), path);
  ASSERT_EQ(outcome.verdict, Verdict::kProved) << outcome.message;
  // 9 m less 5.5 m above the load, 6 m less 0.5 m to either side; less what deviations may do.
  EXPECT_GT(outcome.clearance_m, 1);
  EXPECT_LT(outcome.clearance_m, 3);
  EXPECT_EQ(outcome_of(through_arch("3.6"), path).verdict, Verdict::kRefuted);
}

// ---- Inside ---------------------------------------------------------------------------------------------------------

Problem with_sphere_around(TriangleMesh sphere, bool is_on_platform) {
  Problem problem = crane();
  const BodyText ball{.name = "ball", .shape = HullText{{{"0", "0", "0"}}, "0.1"}};
  BodyText shell{.name = "shell", .shape = mesh_text(std::move(sphere), 'd')};
  problem.bodies->platform = {is_on_platform ? shell : ball};
  problem.bodies->obstacles = {is_on_platform ? ball : shell};
  problem.bodies->obstacles[0].at_m = {"0", "0", "6.6"};
  problem.bodies->clearance_m = {"0.1", std::nullopt, std::nullopt, std::nullopt};
  return problem;
}

TEST(MeshBodies, AreSolidIfTheyAreClosed) {
  const Path path = path_through({{-0.2, 0, 6.6, 0, 0, 0}, {0.2, 0, 6.6, 0, 0, 0}});
  for (const bool is_on_platform : {false, true}) {
    const Outcome closed = outcome_of(with_sphere_around(sphere_mesh(2, 3), is_on_platform), path);
    EXPECT_EQ(closed.verdict, Verdict::kRefuted) << closed.message;
    // With a hole far away it is a surface, whose both sides are outside.
    TriangleMesh open = sphere_mesh(2, 3);
    open.triangles.pop_back();
    const Outcome hollow = outcome_of(with_sphere_around(std::move(open), is_on_platform), path);
    EXPECT_EQ(hollow.verdict, Verdict::kProved) << hollow.message;
    // And outside of the closed one the ball is clear.
    const Path outside = path_through({{-4, 0, 6.6, 0, 0, 0}, {-3.6, 0, 6.6, 0, 0, 0}});
    const Outcome clear = outcome_of(with_sphere_around(sphere_mesh(2, 3), is_on_platform), outside);
    EXPECT_EQ(clear.verdict, Verdict::kProved) << clear.message;
  }
}

TEST(MeshBodies, AreSolidWhereTheyOverlap) {
  const Path path = path_through({{-0.2, 0, 6.6, 0, 0, 0}, {0.2, 0, 6.6, 0, 0, 0}});
  const std::array solids = {joined_meshes(box_mesh({2, 2, 2}), box_mesh({2, 2, 2}), {1, 0.5, 0}),
                             joined_meshes(sphere_mesh(3, 3), sphere_mesh(2, 3), {0, 0, 0}), twice_wound_mesh()};
  for (const TriangleMesh& solid : solids) {
    for (const bool is_on_platform : {false, true}) {
      const Outcome outcome = outcome_of(with_sphere_around(solid, is_on_platform), path);
      EXPECT_EQ(outcome.verdict, Verdict::kRefuted) << outcome.message;
    }
  }
  const IndexedMesh one_sided(one_sided_mesh());
  EXPECT_FALSE(one_sided.is_watertight());
}

// ---- The checker ----------------------------------------------------------------------------------------------------

TEST(MeshBodies, AreTheProblemsOwnToTheChecker) {
  const Problem problem = through_arch("0.5");
  const Path path = path_through({{-3, 0, 6, 0, 0, 0}, {3, 0, 6, 0, 0, 0}});
  const Prover prover(problem);
  const std::string text = certificate_text(elaborate(problem, path, prove_path(prover, path, {}, {})));
  EXPECT_EQ(checker::check(text, supplied(problem)).outcome, checker::Outcome::kAccepted);
  EXPECT_EQ(checker::check(text, {}).outcome, checker::Outcome::kRejected);
  const auto with = [&](const auto& change) {
    checker::CheckOptions options;
    options.meshes = [&](const std::string& file, const std::string& sha256) {
      checker::SuppliedMesh mesh = supplied(problem).meshes(file, sha256);
      change(mesh);
      return mesh;
    };
    return checker::check(text, options).outcome;
  };
  EXPECT_EQ(with([](checker::SuppliedMesh& mesh) { mesh.sha256[0] = 'e'; }), checker::Outcome::kRejected);
  EXPECT_EQ(with([](checker::SuppliedMesh& mesh) { mesh.triangles.clear(); }), checker::Outcome::kRejected);
  EXPECT_EQ(with([](checker::SuppliedMesh& mesh) { mesh.triangles[0][0] = 1000; }), checker::Outcome::kRejected);
  EXPECT_EQ(with([](checker::SuppliedMesh& mesh) { mesh.points[0] = {0, 0, 5}; }), checker::Outcome::kRejected);
  EXPECT_EQ(with([](checker::SuppliedMesh& mesh) {
              mesh.points[0] = {0, 0, std::nan("")};
            }),
            checker::Outcome::kRejected);
}

/// Of certificates that were changed before they were written.
checker::Outcome outcome_of_changed(const Problem& problem, const Certificate& certificate,
                                    const std::function<void(Certificate&)>& change) {
  Certificate changed = certificate;
  change(changed);
  return checker::check(certificate_text(changed), supplied(problem)).outcome;
}

TEST(MeshBodies, AreTouchedByWhatIsInside) {
  const Path path = path_through({{-0.2, 0, 6.6, 0, 0, 0}, {0.2, 0, 6.6, 0, 0, 0}});
  for (const bool is_on_platform : {false, true}) {
    const Problem problem = with_sphere_around(sphere_mesh(2, 3), is_on_platform);
    const std::size_t solid = is_on_platform ? 0 : 1;
    const Certificate certificate = elaborate(problem, path, prove_path(Prover(problem), path, {}, {}));
    ASSERT_EQ(certificate.verdict, Verdict::kRefuted);
    const PairContact& contact = *certificate.witness->violation.contact;
    EXPECT_EQ(contact.points.inside, solid);
    EXPECT_NEAR(std::stod(certificate.witness->violation.depth_m), 0.1, 1e-6);  // the clearance
    const auto with = [&](const std::function<void(PathWitness&)>& change) {
      return outcome_of_changed(problem, certificate,
                                [&](Certificate& changed) { change(changed.witness->violation); });
    };
    EXPECT_EQ(with([](PathWitness&) {}), checker::Outcome::kAccepted);
    EXPECT_EQ(with([](PathWitness& witness) { witness.depth_m = "0.1000001"; }), checker::Outcome::kRejected);
    EXPECT_EQ(with([](PathWitness& witness) { witness.contact->points.inside.reset(); }), checker::Outcome::kMalformed);
    EXPECT_EQ(with([&](PathWitness& witness) { witness.contact->points.inside = 1 - solid; }),
              checker::Outcome::kMalformed);
    // The mesh next to the ball, which is stated to be at another place, is not around it.
    Problem aside = problem;
    aside.bodies->obstacles[0].at_m = {"0", "0", "12"};
    const auto aside_certificate = [&] {
      Certificate changed = certificate;
      changed.problem = aside;
      return checker::check(certificate_text(changed), supplied(aside)).outcome;
    };
    EXPECT_EQ(aside_certificate(), checker::Outcome::kRejected);
    // With a hole in it, the mesh has no inside.
    checker::CheckOptions options;
    options.meshes = [&](const std::string& file, const std::string& sha256) {
      checker::SuppliedMesh mesh = supplied(problem).meshes(file, sha256);
      mesh.triangles.pop_back();
      return mesh;
    };
    EXPECT_EQ(checker::check(certificate_text(certificate), options).outcome, checker::Outcome::kRejected);
  }
}

TEST(MeshBodies, NeedAllTheirDirections) {
  const Problem problem = through_arch("0.5");
  const Path path = path_through({{-3, 0, 6, 0, 0, 0}, {3, 0, 6, 0, 0, 0}});
  const Certificate certificate = elaborate(problem, path, prove_path(Prover(problem), path, {}, {}));
  ASSERT_EQ(certificate.verdict, Verdict::kProved);
  ASSERT_FALSE(certificate.segments.empty());
  std::size_t most = 0;
  for (const PairDirections& directions : certificate.segments[0].directions) {
    most = std::max(most, directions.of(0).size());
  }
  EXPECT_GE(most, 2U);
  const auto with = [&](const std::function<void(std::vector<Direction>&)>& change) {
    return outcome_of_changed(problem, certificate, [&](Certificate& changed) {
      for (PairDirections& directions : changed.segments[0].directions) {
        std::vector<Direction> list = directions.lists.at(0);
        change(list);
        directions.set(0, list);
      }
    });
  };
  using List = std::vector<Direction>;
  EXPECT_EQ(with([](List&) {}), checker::Outcome::kAccepted);
  EXPECT_EQ(with([](List& list) { list.resize(1); }), checker::Outcome::kRejected);
  EXPECT_EQ(with([](List& list) {
              for (Direction& direction : list) {
                for (int& x : direction.u) x = -x;
              }
            }),
            checker::Outcome::kRejected);
  EXPECT_EQ(with([](List& list) {
              for (Direction& direction : list) direction.in_platform = true;
            }),
            checker::Outcome::kMalformed);
  EXPECT_EQ(with([](List& list) {
              while (list.size() <= 256) list.push_back(list[0]);
            }),
            checker::Outcome::kMalformed);
}

TEST(MeshBodies, AreTouchedInOneOfTheirElements) {
  const Problem problem = through_arch("3.6");
  const Path path = path_through({{-3, 0, 6, 0, 0, 0}, {3, 0, 6, 0, 0, 0}});
  const Certificate certificate = elaborate(problem, path, prove_path(Prover(problem), path, {}, {}));
  ASSERT_EQ(certificate.verdict, Verdict::kRefuted);
  const auto with = [&](std::optional<std::uint32_t> element) {
    return outcome_of_changed(problem, certificate, [&](Certificate& changed) {
      changed.witness->violation.contact->points.elements[1] = element;
    });
  };
  const std::uint32_t element = certificate.witness->violation.contact->points.elements[1].value();
  EXPECT_GE(element, 24U);  // of the beam
  EXPECT_EQ(with(element), checker::Outcome::kAccepted);
  EXPECT_EQ(with(0), checker::Outcome::kRejected);  // of a leg
  EXPECT_EQ(with(36), checker::Outcome::kRejected);
  EXPECT_EQ(with(std::nullopt), checker::Outcome::kMalformed);
}

TEST(MeshBodies, AreClearOfWhatHasRoom) {
  std::mt19937_64 random(29);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (const Problem& problem : {hall(false, true), hall(true, true)}) {
    const PoseSampler sampler(problem);
    const BodySampler bodies(problem);
    BodySampler::Carried none;
    int clear = 0, near = 0;
    for (int trial = 0; trial < 300; ++trial) {
      const Waypoint here =
          at({uniform(-6, 6), uniform(-5, 5), uniform(4, 9), uniform(-3, 3), uniform(0, 0.3), uniform(-0.5, 0.5)});
      const RigidPose pose = sampler.rigid_pose(Segment::straight(here, here), 0);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t n = 0; n < bodies.bodies().pairs.size(); ++n) {
        least = std::min(least, bodies.room(sampler.model(), pose, n));
      }
      BodySampler::Carried carried;
      EXPECT_EQ(bodies.is_clear(sampler.model(), pose, carried), least > 0) << trial << ": " << least;
      ++(least > 0 ? clear : near);
    }
    EXPECT_GT(clear, 50);
    EXPECT_GT(near, 50);
  }
}

TEST(MeshBodies, AreNoNearerThanABoundOfTheirDistanceWhichIsThatOrEnough) {
  std::mt19937_64 random(30);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&](double size) {
    return Vector3<double>(size * coordinate(random), size * coordinate(random), size * coordinate(random));
  };
  const IndexedMesh ball(sphere_mesh(1, 3)), box(box_mesh({0.5, 1, 0.2}));
  const auto placed = [&](const IndexedMesh& mesh) {
    BodyInFrame body;
    body.mesh = &mesh;
    body.origin = point(4);
    body.axes = Eigen::Quaterniond(coordinate(random), coordinate(random), coordinate(random), 1.5)
                    .normalized()
                    .toRotationMatrix();
    return body;
  };
  for (int trial = 0; trial < 300; ++trial) {
    const BodyInFrame first = placed(ball);
    BodyInFrame second = placed(box);
    if (trial % 3 == 0) second = {.points = {point(4), point(4)}};  // a cable
    if (trial % 3 == 1) second = {.points = {point(4)}};
    const double truth = nearest_elements(first, second).nearest.distance;
    for (const double enough : {0.5 * truth, truth, 2 * truth}) {
      for (const double bound : {distance_bound(first, second, enough), distance_bound(second, first, enough)}) {
        EXPECT_LE(bound, truth * (1 + 1e-12)) << trial;
        EXPECT_GE(bound, std::min(truth, enough) * (1 - 1e-12)) << trial;
      }
    }
  }
}

TEST(MeshBodies, HaveToBeRead) {
  Problem problem = through_arch("0.5");
  std::get<MeshText>(problem.bodies->obstacles[0].shape).mesh = nullptr;
  EXPECT_THROW((void)Prover(problem), InputError);
}

// ---- Size -----------------------------------------------------------------------------------------------------------

TEST(MeshBodies, MayHaveAHundredThousandTriangles) {
  Problem problem = crane();
  problem.bodies->platform = {block("container", kContainer, kBelow)};
  problem.bodies->obstacles = {{.name = "dome", .shape = mesh_text(sphere_mesh(2.5, 7), 'f')}};
  validate(problem);
  std::clock_t last = std::clock();
  const auto lap = [&] {  // of all threads
    const std::clock_t now = std::clock();
    return static_cast<double>(now - std::exchange(last, now)) / CLOCKS_PER_SEC;
  };
  const Path path = path_through({{-4, 0, 6.6, 0, 0, -0.1}, {0, 0, 6.7, 0, 0, 0}, {4, 0, 6.6, 0, 0, 0.1}});
  const Prover prover(problem);
  const double prepared = lap();
  const PathProof proof = prove_path(prover, path, {}, {});
  const double proved = lap();
  ASSERT_EQ(proof.verdict, Verdict::kProved) << proof.reason.text();
  const std::string text = certificate_text(elaborate(problem, path, proof));
  const double elaborated = lap();
  const checker::CheckResult checked = checker::check(text, supplied(problem));
  const double confirmed = lap();
  EXPECT_EQ(checked.outcome, checker::Outcome::kAccepted) << checked.message;
  std::printf("131072 triangles: prepared %.3f s, proved %.3f s, elaborated %.3f s, checked %.3f s\n", prepared, proved,
              elaborated, confirmed);
}

/// How a file is read depends on its name: the same bytes may be one mesh as STL and another one as OBJ.
TEST(MeshBodies, AreReadBodyByBodyWhereNamesDiffer) {
  Problem problem = hall(true, true, false);
  auto& container = std::get<MeshText>(problem.bodies->platform[0].shape);
  auto& stack = std::get<MeshText>(problem.bodies->obstacles[0].shape);
  stack.sha256 = container.sha256;
  container.file = "same.stl";
  stack.file = "same.obj";
  const Path path = path_through({{-4, 0, 8, 0, 0, 0}, {-3.9, 0, 8, 0, 0, 0}});
  const Prover prover(problem);
  const std::string text = certificate_text(elaborate(problem, path, prove_path(prover, path, {}, {})));
  std::vector<std::string> asked;
  checker::CheckOptions options;
  options.meshes = [&](const std::string& file, const std::string& sha256) {
    asked.push_back(file);
    const TriangleMesh& mesh = (file == container.file ? container : stack).mesh->mesh();
    return checker::SuppliedMesh{sha256, mesh.vertices, mesh.triangles, mesh.needles};
  };
  EXPECT_EQ(checker::check(text, options).outcome, checker::Outcome::kAccepted);
  EXPECT_EQ(asked, (std::vector<std::string>{"same.stl", "same.obj"}));
}

}  // namespace
}  // namespace taut
