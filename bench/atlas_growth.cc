// SPDX-License-Identifier: GPL-3.0-or-later
// What charts cost as atlases grow: time and memory per chart, from 10^2 to 10^5 charts of the wrench-feasible C-spaces
// of the cases, with two, three and six free parameters.
//
// An atlas is grown from the query's first waypoint, chart after chart in the order of creation, until it has N charts.
// The radius is so small that the component has more than 10^5 charts. All runs of one dimension are made of the same
// first charts, so that the growth of the cost with N is seen and little else: a cost of N log N shows as a constant in
// bold. With six parameters little is not nothing: 10^5 charts make a ball that is seven charts across, and up to there
// charts still gain neighbours and come to meet the boundary. Times are the processor's, the best of a few runs; memory
// is what the allocator has handed out for the atlas, neighbour index included.
//
// Usage: atlas_growth RESULTS_DIR [--quick]; writes atlas_growth.md and atlas_growth.json there.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/wrench_feasible_manifold.h"
#include "case/case_file.h"
#include "certify/path_proof.h"

namespace taut {
namespace {

struct Subject {
  const char* case_name;
  double radius;  // of charts; as large as more than 10^5 charts allow
};
constexpr Subject kSubjects[] = {
    {"robot1-slice-qs-qg", 0.006}, {"robot2-sphere-sigma-free-q2-q3", 0.03}, {"robot2-free-q2-q3", 0.15}};

struct Row {
  std::string case_name;
  int dimension = 0;
  int charts = 0;
  double seconds = 0;
  double bytes_per_chart = 0;
  double distances_per_chart = 0;  // computed by the neighbour index
  double frames_per_chart = 0;     // evaluated

  [[nodiscard]] double microseconds_per_chart() const { return 1e6 * seconds / charts; }
  [[nodiscard]] double nanoseconds_per_n_log_n() const { return 1e9 * seconds / (charts * std::log2(charts)); }
};

double allocated_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

Coordinates first_waypoint(const Problem& problem) {
  const Waypoint waypoint = query_waypoints(problem).front();
  return Eigen::Map<const Eigen::VectorXd>(waypoint.parameters().x.data(),
                                           static_cast<Eigen::Index>(waypoint.parameters().x.size()));
}

Row grow(const Manifold& manifold, const Coordinates& start, const AtlasOptions& options, int runs) {
  Row row;
  row.seconds = HUGE_VAL;
  for (int run = 0; run < runs; ++run) {
    const double before = allocated_bytes();
    const std::clock_t begin = std::clock();
    Atlas atlas(manifold, options);
    atlas.add(start);
    atlas.grow_all();
    row.seconds = std::min(row.seconds, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    row.dimension = manifold.dimension();
    row.charts = atlas.size();
    row.bytes_per_chart = (allocated_bytes() - before) / atlas.size();
    row.distances_per_chart = static_cast<double>(atlas.distance_evaluations()) / atlas.size();
    row.frames_per_chart = static_cast<double>(atlas.frame_evaluations()) / atlas.size();
  }
  return row;
}

std::vector<Row> measure(const Subject& subject, int largest) {
  const Case case_ = load_case(fmt::format("{}/cases/{}.yaml", TAUT_SOURCE_DIR, subject.case_name));
  const auto manifold = make_wrench_feasible_manifold(case_.problem, {.clearance = case_.planner.clearance});
  const Coordinates start = first_waypoint(case_.problem);
  AtlasOptions options;
  options.radius = subject.radius;
  options.epsilon = subject.radius;
  std::vector<Row> rows;
  for (int charts = 100; charts <= largest; charts *= 10) {
    options.max_charts = charts;
    rows.push_back(grow(*manifold, start, options, charts <= 10'000 ? 5 : 2));
    rows.back().case_name = subject.case_name;
    fmt::print(stderr, "{}: {} charts, {:.3g} s\n", subject.case_name, charts, rows.back().seconds);
  }
  return rows;
}

std::string markdown(const std::vector<Row>& rows) {
  std::string text =
      "# Growth of an atlas\n\nMade by `bench/run`; the head of "
      "[bench/atlas_growth.cc](../atlas_growth.cc) says what is measured.\n\n"
      "| case | n | charts N | time, ms | µs a chart | ns / (N log2 N) | frames a chart | distances a chart | bytes a "
      "chart "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    text +=
        fmt::format("| {} | {} | {} | {:.2f} | {:.2f} | **{:.0f}** | {:.2f} | {:.0f} | {:.0f} |\n", row.case_name,
                    row.dimension, row.charts, 1e3 * row.seconds, row.microseconds_per_chart(),
                    row.nanoseconds_per_n_log_n(), row.frames_per_chart, row.distances_per_chart, row.bytes_per_chart);
  }
  return text;
}

nlohmann::json to_json(const std::vector<Row>& rows) {
  nlohmann::json json = nlohmann::json::array();
  for (const Row& row : rows) {
    json.push_back({{"case", row.case_name},
                    {"dimension", row.dimension},
                    {"charts", row.charts},
                    {"seconds", row.seconds},
                    {"frames_per_chart", row.frames_per_chart},
                    {"distances_per_chart", row.distances_per_chart},
                    {"bytes_per_chart", row.bytes_per_chart}});
  }
  return json;
}

int run(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: atlas_growth RESULTS_DIR [--quick]\n");
    return 3;
  }
  const std::filesystem::path folder = argv[1];
  const int largest = argc > 2 && std::string_view(argv[2]) == "--quick" ? 1000 : 100'000;
  std::vector<Row> rows;
  for (const Subject& subject : kSubjects) {
    for (Row& row : measure(subject, largest)) rows.push_back(std::move(row));
  }
  std::ofstream(folder / "atlas_growth.md") << markdown(rows);
  std::ofstream(folder / "atlas_growth.json") << to_json(rows).dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) { return taut::run(argc, argv); }
