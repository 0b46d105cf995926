// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/time_statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "certify/severity.h"
#include "problem/decimal.h"
#include "problem/expression.h"
#include "problem/rational.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/numbers.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

/// A unit of rates, and by what SI values are multiplied for it, where that is no power of ten.
struct RateUnit {
  DisplayUnit unit;
  double factor = 1;
};

bool is_angular(RateKind kind) {
  return kind == RateKind::kLoadAngularSpeed || kind == RateKind::kLoadAngularAcceleration;
}
bool is_acceleration(RateKind kind) {
  return kind == RateKind::kWinchAcceleration || kind == RateKind::kLoadAcceleration ||
         kind == RateKind::kLoadAngularAcceleration;
}

/// Power is in W, or in kW where the limit is a kilowatt or more.
RateUnit unit_of(RateKind kind, double limit, const DisplayUnits& units) {
  const std::string by_time = is_acceleration(kind) ? "/s²" : "/s";
  if (kind == RateKind::kWinchPower) {
    constexpr double kKilo = 1000;
    return {DisplayUnit(limit < kKilo ? Unit{Dimension::kPower, "W", Decimal::parse("1")}
                                      : Unit{Dimension::kPower, "kW", Decimal::parse("1000")},
                        "W")};
  }
  if (!is_angular(kind)) return {units.length.with(by_time)};
  const DisplayUnit plain(si_unit(Dimension::kAngle), "rad");
  if (!units.in_degrees) return {plain.with(by_time)};
  return {DisplayUnit(Unit{Dimension::kAngle, "°" + by_time, Decimal::parse("1")}, "rad"), kDegrees};
}

/// "1 m/s", "5°/s": degrees stand next to their number.
std::string with_unit(const std::string& number, const RateUnit& unit) {
  const std::string& name = unit.unit.name();
  return number + (name.starts_with("°") ? "" : " ") + name;
}

std::string limit_text(const ExpressionText& text, RateKind kind, const DisplayUnits& units) {
  if (is_angular(kind)) {
    const std::string angle = angle_text(text);  // "5°", or "0.1 rad (5.72958°)"
    const std::string by_time = is_acceleration(kind) ? "/s²" : "/s";
    if (const std::size_t rad = angle.find(" rad"); rad != std::string::npos) {
      return angle.substr(0, rad) + " rad" + by_time;
    }
    return angle + by_time;
  }
  const RateUnit unit = unit_of(kind, evaluate_constant<double>(text), units);
  if (is_plain_decimal(text)) return with_unit(unit.unit.exact(text), unit);
  return fmt::format("{} {}", text, kind == RateKind::kWinchPower ? "W" : is_acceleration(kind) ? "m/s²" : "m/s");
}

/// "1 m/s", or of each: "1 m/s (cables 1 and 2), 2 m/s (cable 3)"; empty where there is none.
std::string winches_text(const std::vector<RateLimit>& limits, RateKind kind, const DisplayUnits& units) {
  std::vector<std::pair<ExpressionText, std::vector<int>>> groups;
  for (const RateLimit& limit : limits) {
    if (limit.id.kind != kind) continue;
    auto group = std::ranges::find(groups, limit.text, [](const auto& known) { return known.first; });
    if (group == groups.end()) group = groups.insert(groups.end(), {limit.text, {}});
    group->second.push_back(limit.id.cable + 1);
  }
  if (groups.size() == 1 && groups[0].second.size() == kCables) return limit_text(groups[0].first, kind, units);
  std::vector<std::string> parts;
  for (const auto& [text, cables] : groups) {
    parts.push_back(fmt::format("{} ({} {})", limit_text(text, kind, units), cables.size() == 1 ? "cable" : "cables",
                                fmt::join(cables, ", ")));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// "speed below 1 m/s, acceleration below 0.5 m/s²": the limits of these kinds that are stated.
std::string limits_of_kinds(const TimeText& time, const std::vector<std::pair<RateKind, const char*>>& kinds,
                            const DisplayUnits& units) {
  const std::vector<RateLimit> limits = rate_limits(time);
  std::vector<std::string> parts;
  for (const auto& [kind, what] : kinds) {
    std::string text;
    if (is_of_winch(kind)) {
      text = winches_text(limits, kind, units);
    } else if (const auto found = std::ranges::find(limits, kind, [](const RateLimit& limit) { return limit.id.kind; });
               found != limits.end()) {
      text = limit_text(found->text, kind, units);
    }
    if (!text.empty()) parts.push_back(fmt::format("{} below {}", what, text));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

bool is_move(const Certificate& certificate) { return is_in_time(certificate.problem, certificate.path); }

LoadStatement stated_load(const Certificate& certificate) {
  return is_move(certificate) ? load_statement(certificate.problem) : load_statement(certificate.problem.load);
}

std::string time_limits_text(const TimeText& time, const DisplayUnits& units) {
  std::vector<std::string> parts;
  const auto add = [&](const char* whose, const std::string& limits) {
    if (!limits.empty()) parts.push_back(fmt::format("{}: {}", whose, limits));
  };
  add("winches", limits_of_kinds(time,
                                 {{RateKind::kWinchSpeed, "speed"},
                                  {RateKind::kWinchAcceleration, "acceleration"},
                                  {RateKind::kWinchPower, "power"}},
                                 units));
  add("the load point",
      limits_of_kinds(time, {{RateKind::kLoadSpeed, "speed"}, {RateKind::kLoadAcceleration, "acceleration"}}, units));
  add("the platform", limits_of_kinds(time,
                                      {{RateKind::kLoadAngularSpeed, "angular speed"},
                                       {RateKind::kLoadAngularAcceleration, "angular acceleration"}},
                                      units));
  std::string text = fmt::format("In time: {}.", fmt::join(parts, "; "));
  if (time.stopping_time_s) {
    text += fmt::format(
        " The move may be run slower, stopped and started again anywhere: from full speed to rest in {} s or more.",
        is_plain_decimal(*time.stopping_time_s)
            ? *time.stopping_time_s
            : fmt::format("{:.6g}", evaluate_constant<double>(*time.stopping_time_s)));
  }
  if (time.rows) {
    constexpr int kDigits = 6;
    text += fmt::format(
        " Drives may run lengths straight between the rows of a table, at least {} a second, and be up to {} off by "
        "that; "
        "limits in time are those of the move itself.",
        rounded_up(1 / ScalarTraits<double>::from_decimal(time.rows->step_s), kDigits), row_error_text(*time.rows));
  }
  return text;
}

std::string row_error_text(const RowsText& rows) {
  double most_m = 0;
  for (const DecimalText& error : rows.error_m) most_m = std::max(most_m, ScalarTraits<double>::from_decimal(error));
  constexpr int kDigits = 3;
  return DisplayUnits().length.up(most_m, kDigits) + " mm";
}

std::string inertia_text(const LoadText& load) {
  std::vector<std::string> boxes, points;
  for (const LoadItem& item : load.items) {
    const auto* const weight = std::get_if<Weight>(&item.what);
    if (weight == nullptr) continue;
    const std::string name = quoted_name(item.name);
    if (!weight->inertia_box) {
      points.push_back(name);
      continue;
    }
    std::vector<std::string> sides;
    std::array<double, 3> squares{};
    bool is_typed = true;  // else they were made of moments of inertia
    constexpr std::size_t kTyped = 12;
    for (std::size_t k = 0; k < 3; ++k) {
      const RationalText& side = (*weight->inertia_box)[k];
      is_typed = is_typed && side.size() < kTyped;
      squares[k] = std::pow(from_rational<double>(side), 2);
      sides.push_back(side.size() < kTyped ? rational_text(parse_rational(side))
                                           : fmt::format("{:.6g}", from_rational<double>(side)));
    }
    std::string text = fmt::format("{} as an evenly filled box of {} m", name, fmt::join(sides, " × "));
    if (!is_typed) {
      const double twelfth =
          (from_rational<double>(weight->mass_lower) + from_rational<double>(weight->mass_upper)) / 24;
      text += fmt::format(" (moments of inertia {:.6g}, {:.6g} and {:.6g} kg·m²)", twelfth * (squares[1] + squares[2]),
                          twelfth * (squares[2] + squares[0]), twelfth * (squares[0] + squares[1]));
    }
    boxes.push_back(text);
  }
  if (!points.empty()) {
    boxes.push_back(
        fmt::format("{} as {}", fmt::join(points, ", "), points.size() == 1 ? "a point mass" : "point masses"));
  }
  return fmt::format("Inertia counts of all weights, with all masses and centres of gravity that they may have: {}.",
                     fmt::join(boxes, "; "));
}

std::string rate_limit_text(const TimeText& time, RateId id, const DisplayUnits& units) {
  return limit_text(limit_of(time, id), id.kind, units);
}

std::vector<RateUse> rate_uses(const ReportContext& scene) {
  std::vector<RateUse> result;
  if (!is_move(scene.certificate)) return result;
  for (const RateLimit& limit : rate_limits(*scene.certificate.problem.time)) {
    RateUse use{limit};
    for (const PathSample& sample : scene.samples) {
      if (!sample.in_time || (limit.id.kind == RateKind::kWinchPower && !sample.statics.regular)) continue;
      const double size = sample.in_time->size(limit.id);
      if (size > use.size) use = {limit, size, sample.in_time->time_s, sample.position};
    }
    if (result.empty() || result.back().limit.id.kind != limit.id.kind) {
      result.push_back(use);
    } else if (use.share() > result.back().share()) {
      result.back() = use;
    }
  }
  return result;
}

std::string size_text(const RateUse& use, const DisplayUnits& units) {
  const RateUnit unit = unit_of(use.limit.id.kind, use.limit.value, units);
  return with_unit(sampled_text(use.size * unit.factor, use.limit.value * unit.factor, unit.unit), unit);
}

std::string rate_value_text(const PathWitness& witness, const Problem& problem, const DisplayUnits& units) {
  const RateId id = witness.rate.value();
  const double limit = evaluate_constant<double>(limit_of(problem.time.value(), id));
  const RateUnit unit = unit_of(id.kind, limit, units);
  constexpr double kRounding = 1e-15;  // more than the factor of degrees errs by
  const double least =
      below(Decimal::parse(witness.value_lower).rational()) * unit.factor * (unit.factor == 1 ? 1 : 1 - kRounding);
  return with_unit(down_text(least, limit * unit.factor, unit.unit), unit);
}

std::string slowing_text(const PathWitness& witness) {
  if (!witness.slowing) return "";
  const auto& [speed, change] = *witness.slowing;
  return fmt::format(", where the move {} as its stopping time allows at {} % of its speed",
                     change < 0 ? "is braked as hard" : "speeds up as fast",
                     rounded_to_nearest(100 * ScalarTraits<double>::from_decimal(speed), 3));
}

std::string rate_violation_text(const PathWitness& witness, const Problem& problem, const DisplayUnits& units) {
  const RateId id = witness.rate.value();
  const std::string value = rate_value_text(witness, problem, units);
  const std::string limit =
      fmt::format("{}; its limit is {}", slowing_text(witness), rate_limit_text(problem.time.value(), id, units));
  const int cable = id.cable + 1;
  switch (id.kind) {
    case RateKind::kWinchSpeed: return fmt::format("cable {} would be wound at {} or more{}", cable, value, limit);
    case RateKind::kWinchAcceleration:
      return fmt::format("the winch of cable {} would accelerate by {} or more{}", cable, value, limit);
    case RateKind::kWinchPower:
      return fmt::format("the winch of cable {}{} would need a power of {} or more{}", cable,
                         witness.deviation ? ", on a machine that deviates within the tolerances," : "", value, limit);
    case RateKind::kLoadSpeed: return fmt::format("the load point would move at {} or more{}", value, limit);
    case RateKind::kLoadAcceleration:
      return fmt::format("the load point would accelerate by {} or more{}", value, limit);
    case RateKind::kLoadAngularSpeed: return fmt::format("the platform would turn at {} or more{}", value, limit);
    case RateKind::kLoadAngularAcceleration: break;
  }
  return fmt::format("the platform's turning would accelerate by {} or more{}", value, limit);
}

const char* too_fast_text(RateKind kind) {
  switch (kind) {
    case RateKind::kWinchSpeed: return "wound too fast";
    case RateKind::kWinchAcceleration: return "wound with too great an acceleration";
    case RateKind::kWinchPower: return "needs too much power";
    case RateKind::kLoadSpeed: return "too fast";
    case RateKind::kLoadAcceleration: return "accelerates too much";
    case RateKind::kLoadAngularSpeed: return "turns too fast";
    case RateKind::kLoadAngularAcceleration: break;
  }
  return "its turning accelerates too much";
}

std::string subject_of(RateId id) {
  if (is_of_winch(id.kind)) return fmt::format("Cable {}", id.cable + 1);
  return is_angular(id.kind) ? "Platform" : "Load point";
}

double severity_of(const PathWitness& witness, const Problem& problem) {
  if (!witness.rate) return severity(witness, problem.robot);
  return nearest_double(witness.value_lower) /
             evaluate_constant<double>(limit_of(problem.time.value(), *witness.rate)) -
         1;
}

std::string seconds_text(double seconds) { return fmt::format("{:.4g} s", seconds); }

}  // namespace taut
