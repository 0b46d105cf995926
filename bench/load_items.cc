// SPDX-License-Identifier: GPL-3.0-or-later
// What load items cost: the proof of a segment whose load is six items, beside that of the same segment with an
// ellipsoid; and what an ellipsoid costs in margins.
//
// The crane is that of cases/cranes/portal-20t.yaml with tensions to 400 kN, so that all of it is proved. Its segments
// move it by 1 m and turn it by 5 degrees, from random poses that are tilted by up to 2 degrees. There are two
// ellipsoids: `around_items`, and the smaller one whose semi-axes are the items' greatest deviations in each component,
// which is what people type. All three are timed in turns in the same run; the ratio is the median of the rounds' ones.
// Margins are those of the straight move of cases/cranes/portal-20t.yaml, as it is and with `ellipsoid: around_items`.
//
// Usage: load_items [JSON_FILE] [--quick]; Markdown on stdout.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string_view>

#include "case/case_file.h"
#include "certificate/elaborate.h"

namespace taut {
namespace {

/// Of this thread's processor time, which a busy machine disturbs less than the wall clock [s].
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

constexpr const char* kCrane = R"(taut: 1
name: portal-crane
units: {length: m, force: kN, moment: kN*m, mass: t, angle: deg}
robot:
  base_anchors: [[15, 10, 15], [15, 10, 15], [-15, 10, 15], [-15, 10, 15], [0, -10, 15], [0, -10, 15]]
  platform_anchors: [[0, 1.5, 0], [1.3, -0.75, 0], [0, 1.5, 0], [-1.3, -0.75, 0], [1.3, -0.75, 0], [-1.3, -0.75, 0]]
  tension: [0, 400]
  length: [1, 45]
space:
  free: {px: [-8, 8], py: [-5, 5], pz: [3, 10]}
)";
constexpr const char* kItems = R"(load:
  gravity: [0, 0, -9.81 m/s^2]
  items:
    - {name: platform, mass: 8, at: [0, 0, 0]}
    - {name: payload, mass: 12, mass_tolerance: 2 %, at: [0, 0, -1.2], at_tolerance: 50 mm}
    - {name: wind, force: 2, direction: horizontal, at: [0, 0, -1]}
    - {name: tool, force: 1, direction: any, at: [0.5, 0, -0.5]}
    - {name: friction, moment: 1, direction: any}
    - {name: rope, force: [0, 1], direction: [0, 1, 1], axes: P, at: [0, -1, 0]}
)";
constexpr const char* kSmallTolerances =
    "tolerances: {base_anchors: 1 mm, platform_anchors: 1 mm, position: 5 mm, orientation: 0.05}\n";

/// The items' extents in each component while the platform is level, as semi-axes: wind, tool, rope and weight, and
/// their moments about the centre of gravity.
constexpr const char* kEllipsoid = R"(load:
  point: [0, 0, -0.72]
  wrench: [0, 0, -196.2, 0, 0, 0]
  ellipsoid: {semi_axes: [3, 3.7, 4.1, 11, 10.5, 2.5]}
)";

struct Load {
  std::string name;
  std::string yaml;
};

struct Row {
  std::string name;
  double segment_us = 0, boxes = 0, ratio = 1;
  std::size_t proved = 0, total = 0;
};

std::vector<std::pair<Waypoint, Waypoint>> random_segments(std::size_t count) {
  constexpr double kDegree = 0.017453292519943295;
  std::mt19937_64 random(1);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::vector<std::pair<Waypoint, Waypoint>> segments;
  while (segments.size() < count) {
    const std::vector<double> from = {uniform(-3, 3),
                                      uniform(-2, 2),
                                      uniform(4, 7),
                                      uniform(-3.1, 3.1),
                                      kDegree * uniform(0.1, 2),
                                      kDegree * uniform(-10, 10)};
    std::vector<double> to = from;
    const double direction = uniform(-3.1, 3.1);
    to[0] += std::cos(direction);
    to[1] += std::sin(direction);
    to[5] += kDegree * 5;
    segments.push_back({{from, std::vector<int>(6, 0)}, {to, std::vector<int>(6, 0)}});
  }
  return segments;
}

std::vector<Row> measure(const std::vector<Load>& loads, const std::string& tolerances, bool is_quick) {
  const std::size_t kSegments = is_quick ? 50 : 500;
  const int kRounds = is_quick ? 3 : 21;
  std::vector<Row> rows;
  std::vector<std::unique_ptr<Prover>> provers;
  for (const Load& load : loads) {
    provers.push_back(std::make_unique<Prover>(parse_case(kCrane + load.yaml + tolerances, load.name).problem));
    rows.push_back({load.name});
  }
  const auto prove = [](const Prover& prover, const std::pair<Waypoint, Waypoint>& ends) {
    return prover.prove(prover.prepared(Segment::between(Interpolation::kStraight, ends.first, ends.second)));
  };
  std::vector<std::pair<Waypoint, Waypoint>> segments = random_segments(kSegments);
  // Only what is proved with every load is compared.
  std::erase_if(segments, [&](const auto& ends) {
    return !std::ranges::all_of(provers, [&](const auto& p) { return prove(*p, ends).verdict == Verdict::kProved; });
  });
  std::vector<std::vector<double>> ratios(loads.size()), times(loads.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k = 0; k < loads.size(); ++k) {
      Row& row = rows[k];
      row.proved = 0;
      std::size_t boxes = 0;
      const double start = now();
      for (const auto& ends : segments) {
        const SegmentProof proof = prove(*provers[k], ends);
        row.proved += proof.verdict == Verdict::kProved ? 1 : 0;
        boxes += static_cast<std::size_t>(proof.boxes_judged);
      }
      const auto count = static_cast<double>(segments.size());
      times[k].push_back(1e6 * (now() - start) / count);
      row.boxes = static_cast<double>(boxes) / count;
      row.total = segments.size();
    }
    for (std::size_t k = 0; k < loads.size(); ++k) ratios[k].push_back(times[0].back() / times[k].back());
  }
  for (std::size_t k = 0; k < loads.size(); ++k) {
    rows[k].segment_us = median(times[k]);
    rows[k].ratio = median(ratios[k]);
  }
  return rows;
}

struct MarginRow {
  std::string load;
  bool tolerances;
  Certificate certificate;
};

/// The crane's straight move with its load as items and as the ellipsoid around them.
std::vector<MarginRow> margins() {
  std::ifstream file(TAUT_SOURCE_DIR "/cases/cranes/portal-20t.yaml");
  const std::string items{std::istreambuf_iterator<char>(file), {}};
  std::string around = items;
  around.insert(around.find("  items:"), "  ellipsoid: around_items\n");
  std::vector<MarginRow> rows;
  for (const bool tolerances : {false, true}) {
    for (const Load& load : {Load{"items", items}, Load{"around_items", around}}) {
      Problem problem = parse_case(load.yaml, load.name).problem;
      if (!tolerances) problem.tolerances.reset();
      const Path path{query_waypoints(problem)};
      rows.push_back({load.name, tolerances, elaborate(problem, path, prove_path(Prover(problem), path))});
    }
  }
  return rows;
}

void print_margins(nlohmann::json& json) {
  fmt::print("\n| load of the crane | tolerances | verdict | tension margin, N | K may grow by | boxes |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const MarginRow& row : margins()) {
    const Certificate& certificate = row.certificate;
    const bool is_proved = certificate.verdict == Verdict::kProved;
    const std::string margin = is_proved ? certificate.margins->tension_N : "–";
    const std::string growth = is_proved ? certificate.margins->wrench_scale : "–";
    const char* verdict = is_proved ? "proved" : certificate.verdict == Verdict::kRefuted ? "refuted" : "undecided";
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", row.load, row.tolerances ? "yes" : "none", verdict, margin, growth,
               count_boxes(certificate));
    json.push_back({{"load", row.load},
                    {"tolerances", row.tolerances},
                    {"verdict", verdict},
                    {"tension_margin_N", is_proved ? nlohmann::json(margin) : nlohmann::json()},
                    {"wrench_scale", is_proved ? nlohmann::json(growth) : nlohmann::json()}});
  }
}

int run(int argc, char** argv) {
  const bool is_quick = argc > 1 && std::string_view(argv[argc - 1]) == "--quick";
  rounding_self_test();
  std::string around = kItems;
  around.insert(around.find("  items:"), "  ellipsoid: around_items\n");
  const std::vector<Load> loads = {
      {"six items", kItems}, {"around_items", around}, {"semi_axes of their extents", kEllipsoid}};
  fmt::print("| load | tolerances | proved | boxes judged | proof, us | **items' time / this one's** |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  nlohmann::json json = {{"speed", nlohmann::json::array()}, {"margins", nlohmann::json::array()}};
  for (const bool with_tolerances : {false, true}) {
    for (const Row& row : measure(loads, with_tolerances ? kSmallTolerances : "", is_quick)) {
      fmt::print("| {} | {} | {}/{} | {:.2f} | {:.1f} | **{:.2f}** |\n", row.name, with_tolerances ? "yes" : "none",
                 row.proved, row.total, row.boxes, row.segment_us, row.ratio);
      json["speed"].push_back({{"load", row.name},
                               {"tolerances", with_tolerances},
                               {"proved", row.proved},
                               {"total", row.total},
                               {"judged", row.boxes},
                               {"segment_us", row.segment_us},
                               {"items_over_this", row.ratio}});
    }
  }
  print_margins(json["margins"]);
  if (argc > 1 && std::string_view(argv[1]) != "--quick") std::ofstream(argv[1]) << json.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) { return taut::run(argc, argv); }
