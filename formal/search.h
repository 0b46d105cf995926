// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes and numbers by which Coq can prove a path: found in binary64 by the arithmetic that Coq repeats.
//
// Nothing is claimed of what is found: a mistake here makes Coq refuse a true certificate, never accept a false one.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "certificate/certificate.h"

namespace taut::formal {

/// [k, k + 1] / 2^depth of a segment, with integers times 2^-scale.
struct Box {
  int depth = 0;
  long index = 0;
  int scale = 0;
  std::array<std::array<long, 6>, 6> inverse{};  ///< nearly D^-1 in the middle, by rows
  std::array<long, 6> densities{};               ///< nearly D^-1 w0 there
};

/// With how many bits Coq has to compute: more where coordinates are large, as those of a site are.
[[nodiscard]] int bits(const Problem& problem);

/// @param done  segments that are finished
using SearchProgress = std::function<void(std::size_t done, std::size_t all, std::size_t boxes)>;

/// One list of boxes a segment, which cover it in order; nothing where somebody asked to stop.
/// @pre in_scope(certificate)
/// @throws InputError where a box of 2^-20 of a segment is still too large.
[[nodiscard]] std::optional<std::vector<std::vector<Box>>> find_boxes(const Certificate& certificate,
                                                                      const SearchProgress& progress,
                                                                      const std::stop_token& stop);

}  // namespace taut::formal
