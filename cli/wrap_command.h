// SPDX-License-Identifier: GPL-3.0-or-later
// `taut wrap`: a closed mesh around one that is not (case/mesh_wrap.h).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace taut {

struct WrapArguments {
  std::string mesh;
  std::string out;
  double alpha = 0;   ///< 0: a share of the mesh's diagonal
  double offset = 0;  ///< likewise
};

void add_wrap_options(CLI::App& command, WrapArguments& arguments);

/// @returns the exit code. @throws InputError for a mesh that can't be read or wrapped, and for impossible lengths
[[nodiscard]] int run_wrap(const WrapArguments& arguments);

}  // namespace taut
