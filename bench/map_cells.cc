// SPDX-License-Identifier: GPL-3.0-or-later
// What maps cost: cells, time and memory as cells get smaller, of two coordinates and of three.
//
// Two: the slice of cases/robot1-slice-qs-qg.yaml, of which cells are halved down to a width and nothing is left out.
// Three: cases/robot2-sphere-sigma-free-q2-q3.yaml, to so many cells. Times are of all threads' processors, which a
// busy machine disturbs less than the wall clock. A sample is one evaluation of all tensions over K at a pose in
// binary64. Memory is the largest that the process ever had, so far; sizes rise, so that it is the last map's.
//
// Usage: map_cells [--quick]; Markdown on stdout.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <ctime>
#include <string_view>
#include <vector>

#include "case/case_file.h"
#include "kinematics/pose_sampler.h"
#include "map/topology.h"

namespace taut {
namespace {

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double most_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Seconds that a sample takes.
double sample_seconds(const Problem& problem) {
  const PoseSampler sampler(problem);
  constexpr int kSamples = 20000;
  double sum = 0;
  std::vector<double> parameters(problem.space.parameters.size());
  const double begin = processor_seconds();
  for (int n = 0; n < kSamples; ++n) {
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      parameters[k] = 0.1 + 1.3 * std::fmod(n * (0.618 + 0.137 * static_cast<double>(k)), 1.0);
    }
    sum += sampler.clearance(sampler.statics(sampler.pose(parameters)));
  }
  const double seconds = (processor_seconds() - begin) / kSamples;
  return std::isnan(sum) ? 0 : seconds;
}

void print_row(const Problem& problem, const SubdivisionOptions& options, double sample, std::string_view name) {
  const double begin = processor_seconds();
  const CellMap map = subdivide(problem, make_map_space(problem.space), options);
  const double subdivided = processor_seconds();
  const MapTopology topology(map);
  const double seconds = subdivided - begin, joining = processor_seconds() - subdivided;
  const auto judged = static_cast<double>(map.judged);
  const double megabytes = most_megabytes();
  fmt::print("| {} | {} | {:.3f} % | {} | {:.2f} | {:.0f} | {:.1f} | {:.2f} | {} | {:.0f} | {:.0f} |\n", name,
             map.leaves(), 100 * map.share[0], map.judged, seconds, judged / seconds / 1000, seconds / judged / sample,
             joining, topology.inside().size(), megabytes, megabytes * 1024 * 1024 / static_cast<double>(map.leaves()));
  std::fflush(stdout);
}

void run(bool is_quick) {
  const std::string cases = std::string(TAUT_SOURCE_DIR) + "/cases/";
  const Problem slice = load_case(cases + "robot1-slice-qs-qg.yaml").problem;
  const Problem sphere = load_case(cases + "robot2-sphere-sigma-free-q2-q3.yaml").problem;
  constexpr const char* kHead =
      "| cells | undecided | judged | time, s | 1000/s | samples/cell | joining, s | parts | MB | bytes/cell "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  const double sample_of_two = sample_seconds(slice), sample_of_three = sample_seconds(sphere);
  fmt::print("Robot 1's slice, all cells halved to a width; a sample takes {:.2f} us.\n\n| least width {}",
             1e6 * sample_of_two, kHead);
  for (int depth = 7; depth <= (is_quick ? 10 : 16); ++depth) {
    print_row(slice, {.least_width = std::ldexp(1.0, -depth), .undecided_share = 0, .most_cells = 1'000'000'000},
              sample_of_two, fmt::format("1/{}", 1 << depth));
  }
  fmt::print(
      "\nRobot 2 on the sphere with sigma free, to a number of cells; a sample takes {:.2f} us.\n\n| cells may be {}",
      1e6 * sample_of_three, kHead);
  for (const std::size_t most : {100'000, 1'000'000, 10'000'000}) {
    if (is_quick && most > 100'000) break;
    print_row(sphere, {.least_width = std::ldexp(1.0, -12), .undecided_share = 0, .most_cells = most}, sample_of_three,
              fmt::format("{:.0e}", static_cast<double>(most)));
  }
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) {
  taut::run(argc > 1 && std::string_view(argv[1]) == "--quick");
  return 0;
}
