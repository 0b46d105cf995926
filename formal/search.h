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

/// Where lengths are held: nearly the inverse of the derivative of half the lengths' squares by the tube's coordinates;
/// how much is left of an error after a step of Newton's method with it; and coordinates near which the platform is,
/// and within what. All but the inverse times 2^-kTubeBits.
struct TubeBox {
  int scale = 0;
  std::array<std::array<long, 6>, 6> inverse{};
  long left = 0;
  std::array<long, 6> guess{};
  long within = 0;
};
inline constexpr int kTubeBits = 20;

/// [k, k + 1] / 2^depth of a segment, with integers times 2^-scale.
struct Box {
  int depth = 0;
  long index = 0;
  int scale = 0;
  std::array<std::array<long, 6>, 6> inverse{};  ///< nearly D^-1 in the middle, by rows
  std::array<long, 6> densities{};               ///< nearly D^-1 w0 there
  std::optional<TubeBox> tube{};
};

/// With how many bits Coq has to compute: more where coordinates are large, as those of a site are, and tubes thin.
[[nodiscard]] int bits(const Problem& problem, const Path& path);

/// @param done  segments that are finished
using SearchProgress = std::function<void(std::size_t done, std::size_t all, std::size_t boxes)>;

/// One list of boxes a segment, or a pair of held_poses(), which cover it in order. Nothing where somebody asked to
/// stop.
/// @pre require_in_scope(certificate)
/// @throws InputError where a box of 2^-20 of one of these is still too large.
[[nodiscard]] std::optional<std::vector<std::vector<Box>>> find_boxes(const Certificate& certificate,
                                                                      const SearchProgress& progress,
                                                                      const std::stop_token& stop);

}  // namespace taut::formal
