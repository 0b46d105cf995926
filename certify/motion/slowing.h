// SPDX-License-Identifier: GPL-3.0-or-later
// How a move that may be slowed down is run at one time of its law.
#pragma once

#include <array>

#include "problem/text.h"

namespace taut {

/// s = σ(τ(t)) with τ' = speed and τ'' = change / T_s, T_s being the stopping time of the problem.
struct Slowing {
  DecimalText speed;  ///< between 0 and 1: a share of the law's
  int change = 1;     ///< 1: speeding up; -1: braking
  bool operator==(const Slowing&) const = default;
};

/// Nearly the corners of all at which a move may be run (docs/theory.md, "Slowing down"); each may come before and
/// after others.
[[nodiscard]] inline std::array<Slowing, 4> extreme_slowings() {
  constexpr const char *kAlmostAll = "0.9990234375", *kAlmostNone = "0.0009765625";  // 1 - 2^-10, 2^-10
  return {{{kAlmostAll, -1}, {kAlmostAll, 1}, {kAlmostNone, -1}, {kAlmostNone, 1}}};
}

}  // namespace taut
