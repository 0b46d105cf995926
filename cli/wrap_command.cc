// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/wrap_command.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/files.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "case/mesh_file.h"
#include "case/mesh_wrap.h"
#include "cli/console.h"
#include "cli/number_option.h"
#include "cli/terminal.h"

namespace taut {
namespace {

// Shares of the mesh's diagonal.
constexpr double kAlpha = 0.02, kOffset = 0.001;
constexpr double kLeastAlpha = 1e-4, kLeastOffset = 1e-6, kMost = 10;

/// What was asked for, or that share of the diagonal with two digits.
double length(const char* option, double asked, double share, double least, double diagonal) {
  if (asked == 0) return std::stod(fmt::format("{:.1e}", share * diagonal));
  if (asked >= least * diagonal && asked <= kMost * diagonal) return asked;
  throw InputError(ErrorCode::kUse,
                   fmt::format("{}: got {:.6g}, expected {:.6g} to {:.6g}: the mesh's diagonal is {:.6g}", option,
                               asked, least * diagonal, kMost * diagonal, diagonal));
}

LoadedMesh load(const std::string& path) {
  try {
    return load_mesh(path);
  } catch (const InputError& error) {
    throw InputError(ErrorCode::kCase, fmt::format("got '{}', {}", excerpt(path), error.what()));
  }
}

void require_mesh_name(const char* argument, const std::string& name) {
  if (is_mesh_name(name)) return;
  throw InputError(ErrorCode::kUse,
                   fmt::format("{}: got '{}', expected {}", argument, excerpt(name), kMeshNameExpected));
}

}  // namespace

void add_wrap_options(CLI::App& command, WrapArguments& arguments) {
  command.add_option("MESH", arguments.mesh, "STL, OBJ or PLY file of a mesh, closed or not")->required();
  command.add_option("--out", arguments.out, "file to write, a closed mesh: its name ends in .stl, .obj or .ply")
      ->required();
  command
      .add_option("--alpha", arguments.alpha,
                  "gaps narrower than about twice this are closed, in the file's unit; 2 % of the mesh's diagonal if "
                  "not given")
      ->check(positive_number());
  command
      .add_option("--offset", arguments.offset,
                  "how far the wrap stays from the mesh, in the file's unit; 0.1 % of the diagonal if not given")
      ->check(positive_number());
}

int run_wrap(const WrapArguments& arguments) {
  require_mesh_name("MESH", arguments.mesh);
  require_mesh_name("--out", arguments.out);
  require_another(arguments.out, arguments.mesh);
  require_writable(arguments.out);
  const LoadedMesh loaded = load(arguments.mesh);
  const double size = diagonal(loaded.mesh);
  const WrapOptions options{length("--alpha", arguments.alpha, kAlpha, kLeastAlpha, size),
                            length("--offset", arguments.offset, kOffset, kLeastOffset, size)};
  const MeshWrap wrapped = [&] {
    ProgressLine progress(true);
    progress.show([&] { return fmt::format("wrapping {}", plural(loaded.mesh.triangles.size(), "triangle")); });
    return wrap(loaded.mesh, options, extension_of(arguments.out));
  }();
  write_whole({{arguments.out, wrapped.file}});
  print_wrapped(
      fmt::format("Read: {}, {} that hang together by edges, {}.\n", plural(loaded.mesh.triangles.size(), "triangle"),
                  plural(loaded.report.closed_components + loaded.report.open_components, "part"),
                  loaded.report.is_watertight()
                      ? "closed"
                      : fmt::format("not closed: {} of one triangle, {} of more than two",
                                    plural(loaded.report.edges_of_one, "edge"), loaded.report.edges_of_many)));
  print_wrapped(
      fmt::format("Wrapped with alpha {:.6g} and offset {:.6g}, in the file's unit, the mesh's diagonal being "
                  "{:.6g}.\n",
                  options.alpha, options.offset, size));
  print_wrapped(fmt::format(
      "Written: {}, {}, closed. Proved by exact predicates, on the numbers in the file: it does not cross itself, and "
      "all of the mesh is inside. Its corners are up to about {:.3g} away from the mesh, and about {:.3g} of the cubed "
      "unit are inside.\n",
      sanitize(arguments.out), plural(wrapped.mesh.mesh().triangles.size(), "triangle"), wrapped.farthest,
      wrapped.volume));
  return kProvedExit;
}

}  // namespace taut
