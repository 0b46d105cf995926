// SPDX-License-Identifier: GPL-3.0-or-later
// Queries on a stored atlas: what a new query costs, proof included, where an earlier run has charted everything that
// can be reached (docs/atlas-file.md), beside the same query without the file.
//
// Starts and goals are drawn at random (fixed seed) within the charts of the atlas, at least the case's clearance away
// from every limit. Each query is run in turn with and without the file. Times are wall clock and contain all of it:
// opening the file, setting up, searching, pulling taut, proving; for a process also its start, the case file,
// certificate and report.
//
// Usage: stored_atlas RESULTS_DIR TAUT [--quick]; writes stored_atlas.md and stored_atlas.json there.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "planner/planner.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;
using Point = std::vector<double>;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, at);
  return *at;
}

struct Query {
  Point start, goal;
};

/// Points inside of charts and of the manifold's domain.
std::vector<Query> draw_queries(const Atlas& atlas, int count) {
  std::mt19937 random(1);
  Frame frame;
  std::uniform_int_distribution<int> any_chart(0, atlas.size() - 1);
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  const auto draw = [&] {
    while (true) {
      const Chart& chart = atlas.chart(any_chart(random));
      TangentVector u(atlas.manifold().dimension());
      for (double& x : u) x = offset(random) * chart.radius;
      const Coordinates q = chart.frame.coordinates() + chart.frame.lift() * u;
      if (atlas.manifold().frame_at(q, frame)) return Point(q.data(), q.data() + q.size());
    }
  };
  std::vector<Query> queries;
  for (int k = 0; k < count; ++k) queries.push_back({draw(), draw()});
  return queries;
}

Case with_query(Case the_case, const Query& query) {
  the_case.problem.query.clear();
  for (const Point& point : {query.start, query.goal}) {
    auto& waypoint = the_case.problem.query.emplace_back();
    for (const double x : point) waypoint.push_back(fmt::format("{:.17f}", x));
  }
  return the_case;
}

/// The case file with another query.
std::string text_with_query(const std::string& file, const Problem& problem, const Query& query) {
  std::ifstream in(file);
  std::string result;
  bool in_query = false;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line[0] != ' ' && line[0] != '#') in_query = line.starts_with("query:");
    if (!in_query) result += line + "\n";
  }
  result += "query:\n  waypoints:\n";
  for (const Point& point : {query.start, query.goal}) {
    std::string values;
    for (std::size_t j = 0; j < point.size(); ++j) {
      values += fmt::format("{}{}: {:.17f}", j > 0 ? ", " : "", problem.space.parameters[j].name, point[j]);
    }
    result += fmt::format("    - {{{}}}\n", values);
  }
  return result;
}

/// Wall clock of a child process, its output thrown away [ms].
double run_process(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const auto start = Clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0) {
    throw std::runtime_error(fmt::format("{} ended with status {}", arguments[0], status));
  }
  return milliseconds_since(start);
}

struct Times {
  std::vector<double> all, set_up, search, smooth, prove;  ///< [ms]
  int not_proved = 0;

  void run(const Case& the_case, const std::filesystem::path& atlas) {
    const auto start = Clock::now();
    Planner planner(the_case, atlas);
    const double ready = milliseconds_since(start);
    const Plan plan = planner.plan({}, {});
    all.push_back(milliseconds_since(start));
    set_up.push_back(ready);
    search.push_back(1e3 * plan.statistics.plan_seconds);
    smooth.push_back(1e3 * plan.statistics.smooth_seconds);
    prove.push_back(1e3 * plan.statistics.prove_seconds);
    if (plan.proof.verdict != Verdict::kProved) ++not_proved;
  }

  [[nodiscard]] nlohmann::json to_json() const {
    return {{"ms", all}, {"median_ms", quantile(all, 0.5)}, {"not_proved", not_proved}};
  }
};

struct Variant {
  const char* name;
  Strategy strategy;
  Smoothing smoothing;
};

constexpr std::array<Variant, 4> kVariants = {{{"A*, taut", Strategy::kAStar, Smoothing::kShorten},
                                               {"A*, as found", Strategy::kAStar, Smoothing::kNone},
                                               {"greedy, taut", Strategy::kGreedyBestFirst, Smoothing::kShorten},
                                               {"greedy, as found", Strategy::kGreedyBestFirst, Smoothing::kNone}}};

struct Row {
  std::string name;
  std::size_t n = 0;
  int charts = 0;
  std::size_t bytes = 0;
  double grow_ms = 0;
  std::array<Times, kVariants.size()> stored, fresh;
  std::vector<double> process_stored, process_fresh;
};

Row measure(const std::string& name, const std::string& file, const std::string& taut, int count,
            const std::filesystem::path& scratch) {
  const Case the_case = load_case(file);
  Row row;
  row.name = name;
  row.n = the_case.problem.space.parameters.size();
  const std::filesystem::path atlas = scratch / "atlas";
  std::vector<Query> queries;
  {
    Planner planner(the_case);
    const auto start = Clock::now();
    static_cast<void>(planner.plan({}, {}));
    if (!planner.grow_atlas({}, {})) throw std::runtime_error("max_charts reached: " + file);
    row.grow_ms = milliseconds_since(start);
    const std::string bytes = planner.atlas_bytes();
    std::ofstream(atlas, std::ios::binary) << bytes;
    row.charts = planner.atlas().size();
    row.bytes = bytes.size();
    queries = draw_queries(planner.atlas(), count);
  }
  for (std::size_t k = 0; k < queries.size(); ++k) {
    fmt::print(stderr, "\r{}: query {} of {} ", name, k + 1, count);
    for (std::size_t v = 0; v < kVariants.size(); ++v) {
      Case query = with_query(the_case, queries[k]);
      query.planner.strategy = kVariants[v].strategy;
      query.planner.smoothing = kVariants[v].smoothing;
      row.stored[v].run(query, atlas);
      row.fresh[v].run(query, {});
    }
    const std::string case_file = scratch / "case.yaml";
    std::ofstream(case_file) << text_with_query(file, the_case.problem, queries[k]);
    const std::string out = scratch / "out";
    row.process_stored.push_back(run_process({taut, "plan", case_file, "--out", out, "--atlas", atlas.string()}));
    row.process_fresh.push_back(run_process({taut, "plan", case_file, "--out", out}));
  }
  fmt::print(stderr, "\n");
  return row;
}

std::string markdown(const std::vector<Row>& rows, std::size_t count, double load) {
  std::string text = fmt::format(
      "# Queries on a stored atlas\n\n{} new random queries for each row, with the atlas of everything that can be "
      "reached, and without; times in ms,\neverything included. Load {:.1f} on {} cores at the start. Made by "
      "`bench/run`; the head of\n[stored_atlas.cc](../stored_atlas.cc) says what is measured.\n\n"
      "| case | n | charts | file, MB | made in | variant | with the atlas: median (90 %, worst) | without: median | "
      "proved |\n|---|---|---|---|---|---|---|---|---|\n",
      count, load, std::thread::hardware_concurrency());
  for (const Row& row : rows) {
    for (std::size_t v = 0; v < kVariants.size(); ++v) {
      const Times& stored = row.stored[v];
      text += fmt::format("| {} | {} | {} | {:.2f} | {:.0f} | {} | **{:.2f}** ({:.2f}, {:.2f}) | {:.2f} | {} of {} |\n",
                          row.name, row.n, row.charts, 1e-6 * static_cast<double>(row.bytes), row.grow_ms,
                          kVariants[v].name, quantile(stored.all, 0.5), quantile(stored.all, 0.9),
                          quantile(stored.all, 1.0), quantile(row.fresh[v].all, 0.5),
                          stored.all.size() - static_cast<std::size_t>(stored.not_proved), stored.all.size());
    }
  }
  text +=
      "\n## Where the time goes (A*, taut, with the atlas), medians, and whole processes\n\n"
      "| case | set-up and file | search | shortening | proofs | process with the atlas | process without |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    const Times& t = row.stored[0];
    text += fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} | {:.1f} |\n", row.name,
                        quantile(t.set_up, 0.5), quantile(t.search, 0.5), quantile(t.smooth, 0.5),
                        quantile(t.prove, 0.5), quantile(row.process_stored, 0.5), quantile(row.process_fresh, 0.5));
  }
  return text;
}

nlohmann::json json_of(const std::vector<Row>& rows) {
  nlohmann::json all = nlohmann::json::array();
  for (const Row& row : rows) {
    nlohmann::json variants = nlohmann::json::array();
    for (std::size_t v = 0; v < kVariants.size(); ++v) {
      variants.push_back(
          {{"name", kVariants[v].name}, {"with_atlas", row.stored[v].to_json()}, {"without", row.fresh[v].to_json()}});
    }
    all.push_back({{"case", row.name},
                   {"n", row.n},
                   {"charts", row.charts},
                   {"bytes", row.bytes},
                   {"grow_ms", row.grow_ms},
                   {"variants", std::move(variants)},
                   {"process_with_atlas_ms", row.process_stored},
                   {"process_without_ms", row.process_fresh}});
  }
  return all;
}

double load_average() {
  double load = 0;
  return ::getloadavg(&load, 1) == 1 ? load : std::nan("");
}

int run(const std::filesystem::path& results, const std::string& taut, bool quick) {
  const int count = quick ? 5 : 21;
  const double load = load_average();
  const std::filesystem::path scratch =
      std::filesystem::temp_directory_path() / fmt::format("taut_stored_atlas.{}", ::getpid());
  std::filesystem::create_directories(scratch);
  std::vector<Row> rows;
  for (const auto& [name, file] :
       {std::pair("Robot 1, slice", "robot1-slice-qs-qg"), std::pair("Robot 2, sphere", "robot2-sphere-q1-q2-q3"),
        std::pair("Robot 2, sphere, σ free", "robot2-sphere-sigma-free-q2-q3")}) {
    rows.push_back(measure(name, fmt::format(TAUT_SOURCE_DIR "/cases/{}.yaml", file), taut, count, scratch));
  }
  std::filesystem::remove_all(scratch);
  const std::string text = markdown(rows, static_cast<std::size_t>(count), load);
  fmt::print("{}", text);
  std::ofstream(results / "stored_atlas.md") << text;
  std::ofstream(results / "stored_atlas.json") << json_of(rows).dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: stored_atlas RESULTS_DIR TAUT [--quick]\n");
    return 3;
  }
  try {
    return taut::run(argv[1], argv[2], argc > 3 && std::string_view(argv[3]) == "--quick");
  } catch (const std::exception& error) {
    fmt::print(stderr, "stored_atlas: {}\n", error.what());
    return 4;
  }
}
