// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers that a move is judged by: how near it comes to going slack, to the greatest tension and to the ends of
// the cables, how near bodies come to their clearances, and by how much the loads could grow; of a move in time instead
// of
// the last how long it takes, and how much it uses of its limits of speed, acceleration and power. Page, terminal and
// JSON have the same ones.
#pragma once

#include <string>
#include <vector>

#include "reports/summary/cable_use.h"
#include "reports/summary/nearness.h"

namespace taut {

struct KeyNumber {
  const char* key;     ///< for machines: "slack", "top", "length", "clearance", "growth", "duration" or a RateKind's
  std::string title;   ///< "Closest to going slack"
  std::string value;   ///< "Cable 1: +1.86 %"
  std::string detail;  ///< "0.0509 N, limit 0.05 N · after 41° of turning (segment 3)"
  Nearness nearness;   ///< how near any of the six cables is
  bool is_proved = false;   ///< else it rests on floating-point samples, or on what nothing has checked
  bool is_of_rate = false;  ///< of a limit of speed, acceleration or power
};

/// Proved where the whole move is proved: then rounded so that every one of them is true of the move. Else of samples,
/// rounded towards the limit, and marked so in their details. The cable that is named has the least, or highest, of
/// what is printed. None where nothing is known, or nothing was checked.
[[nodiscard]] std::vector<KeyNumber> key_numbers(const ReportContext& scene, const CableUse& use);

/// How one cable uses its limits, as text of three digits, or of as many as tell it from the limit. Signs are those of
/// the exact limits.
struct CableLine {
  std::size_t cable = 0;    ///< 0…5
  std::string from, to;     ///< tension, rounded outward, without its unit
  std::string above_slack;  ///< "+1.86 %" of the lower limit, or "+0.8 N" where any cable's is not positive
  std::string of_top;       ///< "83.1 %" of the upper limit
  std::string length_left;  ///< "7.13 mm" to the nearer limit of length
  Nearness slack, top, length;
};

/// The six cables, those nearest to their limits first; none where nothing is known.
[[nodiscard]] std::vector<CableLine> cable_lines(const ReportContext& scene, const CableUse& use);

}  // namespace taut
