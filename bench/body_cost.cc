// SPDX-License-Identifier: GPL-3.0-or-later
// What clearance costs: proofs of a path with ten obstacles and all pairs of cables beside those of the same path
// without bodies, and a mesh of 131,072 triangles from file to checked certificate.
//
// Two paths: the 20 t portal crane over a row of containers, 8 m in 20 segments, as it is with and without its
// tolerances; and Robot 2 on its sphere around a post, as taut plans it. Each is proved with all its pairs, with those
// of platform and obstacles and of cables only, and without bodies, in turns in one run; ratios are medians of the
// rounds' ones. Times are of this thread's processor.
//
// Usage: body_cost [--quick | --proofs | --mesh]; Markdown on stdout. --proofs: without the mesh; --mesh: only it.
#include <tbb/global_control.h>

#include <string_view>

#include "bench/scenes.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "certify/path_proof.h"
#include "checker/check.h"
#include "planner/planner.h"

namespace taut {
namespace {

using bench::median;

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// ---- Proofs with and without bodies ---------------------------------------------------------------------------------

constexpr const char* kFew = "platform-obstacles, cables-cables";
constexpr const char* kAll = "platform-obstacles, cables-obstacles, cables-cables, cables-platform";

/// The straight way from the first waypoint of the query to the last, in so many segments.
Path straight_path(const Problem& problem, int segments) {
  const std::vector<Waypoint> query = query_waypoints(problem);
  Path path;
  for (int k = 0; k <= segments; ++k) {
    Waypoint at = query.front();
    const double s = static_cast<double>(k) / segments;
    for (std::size_t j = 0; j < at.parameters().x.size(); ++j)
      at.parameters().x[j] += s * (query.back().parameters().x[j] - at.parameters().x[j]);
    path.waypoints.push_back(at);
  }
  return path;
}

Path planned_path(const Case& the_case) {
  Planner planner(the_case);
  const Plan plan = planner.plan({}, {});
  if (plan.proof.verdict != Verdict::kProved) throw std::runtime_error("no path: " + plan.proof.reason.text());
  return plan.path;
}

struct Kind {
  std::string name;
  Problem problem;
  std::vector<double> us = {};  ///< a segment
  double boxes = 0;
  std::size_t proved = 0;
};

/// Proves each segment of the path, once each.
void measure(Kind& kind, const Prover& prover, const Path& path, int repeats) {
  const double begin = thread_seconds();
  long boxes = 0;
  kind.proved = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const PathProof whole = prove_path(prover, path);
    if (repeat > 0) continue;
    for (const SegmentProof& proof : whole.segments) {
      boxes += proof.boxes_judged;
      kind.proved += proof.verdict == Verdict::kProved ? 1 : 0;
    }
  }
  const auto segments = static_cast<double>(path.segments());
  kind.us.push_back(1e6 * (thread_seconds() - begin) / (segments * repeats));
  kind.boxes = static_cast<double>(boxes) / segments;
}

void compare(const std::string& name, const Path& path, std::vector<Kind> kinds, bool is_quick) {
  std::vector<std::unique_ptr<Prover>> provers;
  for (const Kind& kind : kinds) provers.push_back(std::make_unique<Prover>(kind.problem));
  const int rounds = is_quick ? 3 : 25;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < kinds.size(); ++k) measure(kinds[k], *provers[k], path, is_quick ? 1 : 20);
  }
  for (const Kind& kind : kinds) {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < kind.us.size(); ++round) ratios.push_back(kind.us[round] / kinds[0].us[round]);
    fmt::print("| {} | {} | {} | {}/{} | {:.2f} | {:.1f} | **{:.2f}** |\n", name, kind.name,
               kind.problem.bodies ? pairs(*kind.problem.bodies).size() : 0, kind.proved, path.segments(), kind.boxes,
               median(kind.us), median(ratios));
  }
}

std::vector<Kind> kinds(const std::string& file, const std::string& clearance, const char* bodies) {
  Problem without = parse_case(bench::text_without(file, "bodies:"), "without").problem;
  return {{"none", std::move(without)},
          {"obstacles, 15 of cables", parse_case(bench::case_with(file, clearance, kFew, bodies), "few").problem},
          {"all", parse_case(bench::case_with(file, clearance, kAll, bodies), "all").problem}};
}

void compare_proofs(bool is_quick) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  fmt::print("| path | pairs | of them | proved | boxes judged | a segment, us | **ratio** |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  const std::string crane = "cranes/portal-20t-between.yaml";
  std::vector<Kind> with =
      kinds(crane, "{default: 200 mm, cables-cables: 20 mm, cables-platform: 10 mm}", bench::kHall);
  for (Kind& kind : with) {
    kind.problem.query = {{"-4", "0", "6.8", "0", "0", "-0.1"}, {"4", "0", "6.8", "0", "0", "0.1"}};
  }
  const Path path = straight_path(with[0].problem, 20);
  compare("crane, with tolerances", path, with, is_quick);
  for (Kind& kind : with) kind.problem.tolerances.reset();
  compare("crane, without", path, with, is_quick);

  const std::string sphere = "robot2-sphere-q2-q3.yaml";
  const std::string clearance = "{default: 3, cables-cables: 1, cables-platform: 1}";
  const Case the_case = parse_case(bench::case_with(sphere, clearance, kAll, bench::kSphere), "sphere");
  compare("Robot 2, sphere", planned_path(the_case), kinds(sphere, clearance, bench::kSphere), is_quick);
}

// ---- A mesh ---------------------------------------------------------------------------------------------------------

checker::CheckOptions supplied(const Problem& problem) {
  checker::CheckOptions options;
  options.threads = 1;
  options.meshes = [&problem](const std::string&, const std::string& sha256) {
    for (const BodyText& body : problem.bodies->obstacles) {
      const auto* text = std::get_if<MeshText>(&body.shape);
      if (text == nullptr || text->sha256 != sha256) continue;
      const TriangleMesh& mesh = text->mesh->mesh();
      return checker::SuppliedMesh{sha256, mesh.vertices, mesh.triangles, mesh.needles};
    }
    return checker::SuppliedMesh{};
  };
  return options;
}

void measure_mesh(bool is_quick) {
  const bench::TemporaryFolder folder;
  const std::string file = bench::write_heap_case(folder.path()).string();
  std::vector<std::vector<double>> times(6);
  std::size_t segments = 0, bytes = 0, triangles = 0;
  for (int round = 0; round < (is_quick ? 1 : 5); ++round) {
    double last = bench::processor_seconds();
    const auto lap = [&](std::size_t step) {
      const double now = bench::processor_seconds();
      times[step].push_back(now - last);
      last = now;
    };
    const Case the_case = load_case(file);
    lap(0);
    Planner planner(the_case);
    lap(1);
    const Plan plan = planner.plan({}, {});
    lap(2);
    if (plan.proof.verdict != Verdict::kProved) throw std::runtime_error("no path: " + plan.proof.reason.text());
    const Prover prover(the_case.problem);
    last = bench::processor_seconds();
    const PathProof proof = prove_path(prover, plan.path);
    lap(3);
    const std::string text = certificate_text(elaborate(the_case.problem, plan.path, proof));
    lap(4);
    const checker::CheckResult checked = checker::check(text, supplied(the_case.problem));
    lap(5);
    if (checked.outcome != checker::Outcome::kAccepted) throw std::runtime_error(checked.message);
    segments = plan.path.segments();
    bytes = text.size();
    triangles = std::get<MeshText>(the_case.problem.bodies->obstacles[1].shape).mesh->mesh().triangles.size();
  }
  fmt::print("\n{} triangles, {} segments, a certificate of {:.0f} kB:\n\n| step | processor time, ms |\n|---|---|\n",
             triangles, segments, 1e-3 * static_cast<double>(bytes));
  const std::array<const char*, 6> names = {
      "read the file and look for its holes",     "make the planner and its models",
      "plan: search, proofs, shortening",         "of that, to prove the path once more",
      "find how the checker proves it; its text", "check it"};
  for (std::size_t k = 0; k < names.size(); ++k) fmt::print("| {} | {:.0f} |\n", names[k], 1e3 * median(times[k]));
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) {
  const std::string_view option = argc > 1 ? argv[1] : "";
  const bool is_quick = option == "--quick";
  taut::rounding_self_test();
  if (option != "--mesh") taut::compare_proofs(is_quick);
  if (option != "--proofs") taut::measure_mesh(is_quick);
}
