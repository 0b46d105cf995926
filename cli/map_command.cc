// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/map_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "cli/case_map.h"
#include "cli/console.h"
#include "cli/map_files.h"
#include "cli/map_parts.h"
#include "cli/number_option.h"
#include "cli/output.h"
#include "reports/summary/load_statement.h"

namespace taut {
namespace {

/// "1 %" or "0.01", strictly between 0 and 1.
double share_of(const std::string& text) {
  std::string_view digits = text;
  const bool is_percent = digits.ends_with('%');
  if (is_percent) digits.remove_suffix(1);
  while (digits.ends_with(' ')) digits.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (is_percent) value /= 100;
  if (error != std::errc() || end != digits.data() + digits.size() || !(value > 0 && value < 1)) {
    throw InputError(
        ErrorCode::kUse,
        fmt::format("--undecided: got '{}', expected a share of the space such as 1% or 0.01", excerpt(text)));
  }
  return value;
}

/// What a leaf takes: its nodes in the tree, what hangs together, and what is pending. [bytes]
constexpr double kBytesPerCell = 80;

/// Memory that programs may take without swapping [bytes]; nothing where the system does not tell.
std::optional<double> available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  double kibibytes = 0;
  while (file >> key >> kibibytes) {
    std::getline(file, unit);
    if (key == "MemAvailable:") return 1024 * kibibytes;
  }
  return std::nullopt;
}

/// @throws InputError where so many cells would not fit into memory.
void require_memory(std::size_t cells) {
  const std::optional<double> available = available_memory();
  const double needed = kBytesPerCell * static_cast<double>(cells);
  if (!available || needed <= *available) return;
  constexpr double kGigabyte = 1e9;
  throw InputError(
      ErrorCode::kUse,
      fmt::format("--cells: got {}, which may take {:.1f} GB of memory ({:.0f} bytes each), expected at most {:.0f}, "
                  "because {:.1f} GB are available",
                  cells, needed / kGigabyte, kBytesPerCell, std::floor(*available / kBytesPerCell),
                  *available / kGigabyte));
}

/// @throws InputError for options that a map in parts has no use for.
void require_options_of_parts(const MapArguments& arguments, const SubdivisionOptions& options) {
  if (std::isfinite(options.seconds)) {
    throw InputError(ErrorCode::kUse,
                     "--budget: got a number of seconds for a map in parts, expected none, because "
                     "what they suffice for differs from run to run");
  }
  if (!arguments.parts.shard.empty() && !arguments.undecided.empty()) {
    throw InputError(ErrorCode::kUse,
                     "--undecided: got a share for a shard, expected it with --merge, because a shard "
                     "does not know what others leave undecided: its cells are halved to --cell");
  }
}

/// Of three coordinates, who asks for nothing in particular gets a map within seconds.
bool is_brief(const MapArguments& arguments, const MappedCase& mapped) {
  const bool asks = !arguments.undecided.empty() || arguments.least_width || arguments.most_cells ||
                    std::isfinite(arguments.seconds) || arguments.parts.merge || !arguments.parts.shard.empty();
  return mapped.space.size() == 3 && !asks;
}

constexpr std::size_t kMostCells = 20'000'000, kMostCellsOfBriefMap = 1'000'000;

SubdivisionOptions options_of(const MapArguments& arguments, const MappedCase& mapped, bool is_parted) {
  SubdivisionOptions options;
  options.undecided_share = mapped.space.size() == 2 ? 0.01 : 0.1;
  if (arguments.parts.merge) options.undecided_share = 0;
  if (!arguments.undecided.empty()) options.undecided_share = share_of(arguments.undecided);
  options.least_width = arguments.least_width.value_or(options.least_width);
  options.most_cells = arguments.most_cells.value_or(is_brief(arguments, mapped) ? kMostCellsOfBriefMap : kMostCells);
  options.seconds = arguments.seconds;
  if (is_parted) require_options_of_parts(arguments, options);
  return options;
}

PartedMap::PartDone shown_on(ProgressLine& line) {
  return [&line](std::size_t done, std::size_t all) {
    line.show([&] { return fmt::format("{} of {} parts", done, all); });
  };
}

/// Makes one shard of the parts, and no map.
int run_shard(const MapArguments& arguments, const MappedCase& mapped, const SubdivisionOptions& options,
              const Shard& shard, const Stopwatch& stopwatch) {
  PartedMap parts(mapped, options, arguments.parts.folder);
  ProgressLine line(!arguments.json);
  const auto made = parts.make_shard(shard, shown_on(line));
  line.clear();
  if (!made) return report_interruption("map", "interrupted: finished parts are kept", arguments.json);
  if (arguments.json) {
    nlohmann::json document = {{"command", "map"},
                               {"name", mapped.the_case.problem.name},
                               {"shard", arguments.parts.shard},
                               {"parts", parts.size()},
                               {"parts_of_shard", made->parts},
                               {"computed", made->computed},
                               {"warnings", mapped.the_case.warnings}};
    add_ending(document, stopwatch, kProvedExit, {});
    print_json(document);
  } else {
    fmt::print("Shard {}: {} of {} in {}, {} of them computed now, in {:.2f} s.\n", sanitize(arguments.parts.shard),
               made->parts, plural(parts.size(), "part"), sanitize(arguments.parts.folder), made->computed,
               stopwatch.seconds());
  }
  return kProvedExit;
}

/// @returns nothing where it was interrupted.
std::optional<CellMap> make_map(const MapArguments& arguments, const MappedCase& mapped, SubdivisionOptions options,
                                std::unique_ptr<Ranks>& ranks) {
  ProgressLine line(!arguments.json);
  if (!ranks && !arguments.parts.any()) {
    options.progress = [&](const MapProgress& at) {
      line.show([&] { return fmt::format("{} cells, {:.1f} % undecided", at.cells, 100 * at.undecided); });
    };
    CellMap map = subdivide(mapped.the_case.problem, mapped.space, options);
    if (map.end == CellMap::End::kStopped) return std::nullopt;
    return map;
  }
  PartedMap parts(mapped, options, arguments.parts.folder);
  if (arguments.parts.merge) return parts.merge();
  if (!parts.judge(ranks.get(), shown_on(line))) return std::nullopt;
  ranks.reset();  // the others go while this one puts the map together, which takes long enough to seem dead
  return parts.map();
}

/// What `taut map` does, and rank 0 under mpirun.
int run_first(const MapArguments& arguments, std::unique_ptr<Ranks>& ranks) {
  const Stopwatch stopwatch;
  const MappedCase mapped(arguments.case_path, arguments.from);
  const Case& the_case = mapped.the_case;
  const MapFiles files(arguments, mapped);
  const Interruption interruption;
  SubdivisionOptions options = options_of(arguments, mapped, ranks || arguments.parts.any());
  options.stop = interruption.token();
  require_memory(options.most_cells);
  announce(the_case, arguments.json);
  if (const auto shard = shard_of(arguments.parts)) return run_shard(arguments, mapped, options, *shard, stopwatch);
  const Stopwatch map_stopwatch;
  std::optional<CellMap> map = make_map(arguments, mapped, options, ranks);
  if (!map) return report_interruption("map", "interrupted", arguments.json);
  const CaseMap made(mapped, std::move(*map), map_stopwatch.seconds());
  const auto written = files.write(made, interruption.token());
  if (!written) return report_interruption("map", "interrupted", arguments.json);
  if (arguments.json) {
    nlohmann::json document = to_json(the_case, made);
    document["load"] = to_json(load_statement(the_case));
    add_ending(document, stopwatch, kProvedExit, *written);
    print_json(document);
  } else {
    print(the_case, made);
    if (is_brief(arguments, mapped) && made.result().map.end == CellMap::End::kCells) {
      fmt::print(
          "Of three coordinates a map ends at {} cells unless something else is asked for: --undecided 10% goes "
          "on, which takes minutes, and --budget for so many seconds.\n",
          kMostCellsOfBriefMap);
    }
    for (const std::filesystem::path& file : *written) fmt::print("Written: {}\n", sanitize(file.string()));
  }
  return kProvedExit;
}

/// What other ranks do: they compute, print nothing and write nothing.
void serve(const MapArguments& arguments, Ranks& ranks, const std::stop_token& stop) {
  const MappedCase mapped(arguments.case_path, arguments.from);
  const SubdivisionOptions options = options_of(arguments, mapped, true);
  const PartedMap parts(mapped, options, "");
  ranks.serve(
      parts.digest(), [&](const Task& task) { return parts.run(task); }, stop);
}

}  // namespace

void add_map_options(CLI::App& command, MapArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md)")->required();
  command.add_option("--undecided", arguments.undecided,
                     "share of the space that may stay undecided (default: 1% of two coordinates, 10% of three)");
  command
      .add_option("--cell", arguments.least_width,
                  "least width of a cell, as a share of each coordinate's range (default: 0.0005)")
      ->check(number("a share between 0 and 1", [](double x) { return x > 0 && x < 1; }));
  command.add_option("--budget", arguments.seconds, "seconds after which cells are halved no further")
      ->check(positive_number("a number of seconds above 0"));
  command
      .add_option(
          "--cells", arguments.most_cells,
          "the most cells, each of which takes up to 80 bytes of memory (default: 20000000; of three coordinates "
          "1000000, unless --undecided, --cell or --budget asks for more)")
      ->check(CLI::Range(std::size_t{10'000}, std::size_t{1'000'000'000}));
  command.add_option("--from", arguments.from,
                     "where one starts: a waypoint of the query by its number, or coordinates such as 'phi: 10 deg, "
                     "theta: 0.3' (default: 0)");
  command.add_option("--out", arguments.out,
                     "folder to write a picture to, map.svg of two coordinates, map.html of three, and where waypoints "
                     "of the query are apart, certificate.json, which proves it");
  command.add_flag("--png", arguments.png, "draw map.png beside map.svg, by an installed Chromium; only with --out");
  command.add_option("--path", arguments.path, "path to draw there, such as path.csv; only with --out");
  command.add_option("--atlas", arguments.atlas,
                     "atlas file whose charts to draw there (taut plan --save-atlas); only with --out");
  command.add_option("--polygons", arguments.polygons, "file to write polygons to, as GeoJSON; two coordinates only");
  command.add_option("--grid", arguments.grid,
                     "NumPy file (.npy) to write a grid to; its meaning is written beside it");
  command.add_option("--grid-size", arguments.grid_size,
                     "boxes of the grid along each coordinate, such as 1024 or 720,360 (default: 1024 of two "
                     "coordinates, 128 of three)");
  add_parts_options(command, arguments.parts);
  command.add_flag("--json", arguments.json, "print the result as JSON");
}

int run_map(const MapArguments& arguments) {
  return run_in_ranks(
      arguments.parts, [&](std::unique_ptr<Ranks>& ranks) { return run_first(arguments, ranks); },
      [&](Ranks& ranks, const std::stop_token& stop) { serve(arguments, ranks, stop); });
}

}  // namespace taut
