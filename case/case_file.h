// SPDX-License-Identifier: GPL-3.0-or-later
// Case files: YAML in, exact Problem out (docs/case-format.md).
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "case/bodies.h"
#include "case/decoration.h"
#include "case/document_fields.h"
#include "case/table_rounding.h"
#include "problem/problem.h"
#include "problem/units.h"

namespace taut {

enum class Strategy { kAStar, kGreedyBestFirst };
enum class Cost { kRotation, kGreatCircle, kParameters, kTravel };
enum class Smoothing { kNone, kShorten, kSpline };
enum class Expectation { kNone, kProved, kRefuted, kUndecided, kNoPath };

/// What Cost::kTravel adds up: how far a point of the platform moves, and a length for each radian that it turns.
struct TravelCost {
  std::array<double, 3> point_m{};     ///< in the platform's axes; its origin unless the case names another
  std::optional<double> per_radian_m;  ///< >= 0; by default the mean distance of the platform's anchors from the point
};

/// Options of the search. They are floating-point numbers, since a search proves nothing. Lengths and angles share one
/// scale; see atlas/wrench_feasible_manifold.h.
struct PlannerOptions {
  Strategy strategy = Strategy::kAStar;
  Cost cost = Cost::kRotation;
  TravelCost travel;      ///< for Cost::kTravel
  double radius = 0.15;   ///< chart radius r [rad]
  double epsilon = 0.15;  ///< largest distance from chart to manifold [rad]
  int max_charts = 200000;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< of planning and proving
  bool has_budget = false;                                       ///< the case states max_charts or max_seconds
  /// Least distance to a limit, over half its range, that a path should keep if start and goal do.
  double clearance = 0.01;
  Smoothing smoothing = Smoothing::kShorten;  ///< what is done to the path found, before it is proved as a whole
};

/// An expectation of a case: lower <= quantity <= upper, where the quantity is measured on the case's result, in SI.
struct Bound {
  std::string quantity;  ///< one of kBoundQuantities
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};
/// The proved margins [N, m, 1, m]; the distance that the platform's origin travels [m] and the angle that the platform
/// turns by [rad]; the planner's cost; counts; of a move the time that it takes [s].
inline constexpr std::array<const char*, 12> kBoundQuantities = {
    "tension_margin", "length_margin", "wrench_scale", "clearance_margin", "length",    "angle",
    "cost",           "segments",      "boxes",        "charts",           "stretches", "duration"};

/// The path of a case that is to be audited instead of planned.
struct AuditedPath {
  std::string file;                       ///< relative to the case file
  std::string interpolation;              ///< empty: as the file suggests
  bool timed = false;                     ///< as a move in time
  std::optional<TableRounding> rounding;  ///< of the table's rows; only if timed
};

/// How a move is planned; numbers for the planner, of which nothing is proved. What is proved is in Problem::time.
struct MoveOptions {
  double jerk_m_s3 = std::numeric_limits<double>::infinity();  ///< of the load point, at most; above 0
  double rate_Hz = 100;                                        ///< rows a second of tables, above 0
};

/// A case file's content. The space is coordinate_space() if the file has none; a case without a query is for audits.
struct Case {
  Problem problem;
  PlannerOptions planner;
  Expectation expect = Expectation::kNone;
  std::vector<Bound> bounds;  ///< expected besides the verdict
  std::optional<AuditedPath> audit;
  MoveOptions move;  ///< of problem.time
  /// The items as the case states them, where problem.load is an ellipsoid around them.
  std::optional<LoadText> items_in_ellipsoid;
  /// How problem.bodies was made, if the case states bodies.
  std::optional<CaseBodies> bodies;
  /// What may not be meant as it was typed, each with its place; for people, before a verdict.
  std::vector<std::string> warnings;
  DocumentFields document_fields;  ///< for the head of a report
  DecorationFiles decoration;      ///< for its pictures
  std::string description;         ///< the file's leading comment block, for reports
  CaseUnits units;                 ///< of numbers typed without one, for messages and results
};

/// A further check of a case. It throws FieldError, to which the reader adds the place in the file.
using CaseCheck = std::function<void(const Case&)>;

/// @throws InputError with file, line, field, the value seen and what was expected.
[[nodiscard]] Case load_case(const std::string& path, const CaseCheck& check = {});
/// As load_case, from text; `name` stands for the file in messages.
[[nodiscard]] Case parse_case(const std::string& text, const std::string& name, const CaseCheck& check = {});

}  // namespace taut
