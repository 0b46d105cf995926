// SPDX-License-Identifier: GPL-3.0-or-later
// Case files: YAML in, exact Problem out (docs/case-format.md).
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "problem/problem.h"
#include "problem/units.h"

namespace taut {

enum class Strategy { kAStar, kGreedyBestFirst };
enum class Cost { kRotation, kGreatCircle, kParameters };
enum class Smoothing { kNone, kShorten, kSpline };
enum class Expectation { kNone, kProved, kRefuted, kUndecided };

/// How to search; floating point, since a search proves nothing. Lengths and angles share one scale, see
/// atlas/wrench_feasible_manifold.h.
struct PlannerOptions {
  Strategy strategy = Strategy::kAStar;
  Cost cost = Cost::kRotation;
  double radius = 0.15;   ///< chart radius r [rad]
  double epsilon = 0.15;  ///< largest distance from chart to manifold [rad]
  int max_charts = 200000;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< of planning and proving
  bool has_budget = false;                                       ///< the case states max_charts or max_seconds
  /// Least distance to a limit, over half its range, that a path should keep where start and goal do.
  double clearance = 0.01;
  Smoothing smoothing = Smoothing::kShorten;  ///< what is done to the path found, before it is proved as a whole
};

/// What a case says that something which is measured of its result should be, in SI: lower <= it <= upper.
struct Bound {
  std::string quantity;  ///< one of kBoundQuantities
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};
/// The proved margins [N, m, 1]; the way of the platform's origin [m] and the angle it turns by [rad]; the planner's cost; counts.
inline constexpr std::array<const char*, 10> kBoundQuantities = {
    "tension_margin", "length_margin", "wrench_scale", "length", "angle",
    "cost",           "segments",      "boxes",        "charts", "stretches"};

/// A path that a case is about: to be audited, where others are planned.
struct AuditedPath {
  std::string file;           ///< beside the case file
  std::string interpolation;  ///< empty: as the file suggests
  bool allow_repeats = false;
};

/// Without `space` in the file: coordinate_space(). Without `query`: none, such a case is for audits.
struct Case {
  Problem problem;
  PlannerOptions planner;
  Expectation expect = Expectation::kNone;
  std::vector<Bound> bounds;  ///< what else is expected
  std::optional<AuditedPath> audit;
  std::string description;                         ///< the file's leading comment block, for reports
  Unit length_unit = si_unit(Dimension::kLength);  ///< of bare lengths, for messages
};

/// What else is asked of a case: throws a FieldError, which then gets its place in the file.
using CaseCheck = std::function<void(const Case&)>;

/// @throws InputError with file, line, field, the value seen and what was expected.
[[nodiscard]] Case load_case(const std::string& path, const CaseCheck& check = {});
/// As load_case, from text; `name` stands for the file in messages.
[[nodiscard]] Case parse_case(const std::string& text, const std::string& name, const CaseCheck& check = {});

}  // namespace taut
