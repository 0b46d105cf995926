// SPDX-License-Identifier: GPL-3.0-or-later
// What the proof of a move costs beside that of its path at rest.
//
// Plans each of cases/moves, then proves the path with its law and without it, in turns in one run, and compares the
// processor time of all threads.
//
// Usage: move_proofs [--quick]; a JSON document on stdout.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "case/case_file.h"
#include "certify/path_proof.h"
#include "planner/planner.h"

namespace taut {
namespace {

double seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double time_of(const Prover& prover, const Path& path, int proofs) {
  const double begin = seconds();
  for (int k = 0; k < proofs; ++k) {
    if (prove_path(prover, path).verdict != Verdict::kProved) throw std::runtime_error("not proved");
  }
  return (seconds() - begin) / proofs;
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

std::size_t boxes(const PathProof& proof) {
  std::size_t sum = 0;
  for (const SegmentProof& segment : proof.segments) sum += segment.boxes.size();
  return sum;
}

nlohmann::json measure(const std::string& name, int repeats) {
  const Case the_case = load_case(std::string(TAUT_SOURCE_DIR "/cases/moves/") + name + ".yaml");
  Planner planner(the_case);
  const Path timed = planner.plan({}, {}).path;
  Path still = timed;
  still.timing.reset();
  const Prover prover(the_case.problem);
  constexpr double kLeastSeconds = 0.02;  // of one measurement
  const int proofs = 1 + static_cast<int>(kLeastSeconds / std::max(1e-6, time_of(prover, still, 1)));
  std::vector<double> ratios, with, without;
  for (int k = 0; k < repeats; ++k) {
    with.push_back(time_of(prover, timed, proofs));
    without.push_back(time_of(prover, still, proofs));
    ratios.push_back(with.back() / without.back());
  }
  return {{"case", name},
          {"timed_ms", 1e3 * quantile(with, 0.5)},
          {"untimed_ms", 1e3 * quantile(without, 0.5)},
          {"timed_boxes", boxes(prove_path(prover, timed))},
          {"untimed_boxes", boxes(prove_path(prover, still))},
          {"ratio", quantile(ratios, 0.5)},
          {"low", quantile(ratios, 0.25)},
          {"high", quantile(ratios, 0.75)}};
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) {
  const bool is_quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  nlohmann::json all = nlohmann::json::array();
  for (const char* name : {"portal-20t", "portal-20t-may-stop", "hexacrane", "hexacrane-on-equations", "roboprinter"}) {
    all.push_back(taut::measure(name, is_quick ? 3 : 15));
  }
  fmt::print("{}\n", all.dump(1));
}
