// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/key_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "problem/decimal.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

constexpr auto kDigits = {3, 4, 6, 9, 12, 15};
constexpr double kPercent = 100;

/// A percentage or factor, rounded away from what it is a bound of, in the fewest digits that tell it from `limit`.
std::string apart(double value, double limit, bool is_upper) {
  std::string text;
  for (const int digits : kDigits) {
    text = is_upper ? rounded_up(value, digits) : rounded_down(value, digits);
    const double shown = number_in(text);
    if ((shown < limit) == (value < limit) && (shown > limit) == (value > limit)) break;
  }
  return text;
}

/// A number that is below x, though it was computed with a few roundings.
double below(double x) { return x - 1e-14 * std::abs(x); }

std::string above_slack(const Use& use, const DisplayUnit& unit) {
  const double above = use.range.lower - use.lower_limit;
  // The limit was rounded to nearest, by less than 2^-53 of it.
  const double sure = above - 1e-15 * (std::abs(use.range.lower) + std::abs(use.lower_limit));
  const char* const sign = above > 0 ? "+" : "−";
  if (!(use.lower_limit > 0)) return fmt::format("{}{} {}", sign, unit.down(std::abs(sure), 3), unit.name());
  const double percent = kPercent * std::abs(sure) / use.lower_limit;
  return fmt::format("{}{} %", sign, above > 0 ? rounded_down(below(percent), 3) : rounded_up(percent, 3));
}

std::string of_top(const Use& use) { return apart(use.used_percent(), kPercent, true) + " %"; }

double length_left(const Use& use) {
  const double left = std::min(use.range.lower - use.lower_limit, use.upper_limit - use.range.upper);
  return left - 1e-15 * (std::abs(use.range.upper) + std::abs(use.upper_limit));
}

Nearness slack_nearness(const Use& use) { return nearness_to_slack(use.range, use.lower_limit, use.upper_limit); }
Nearness top_nearness(const Use& use) { return nearness_to_top(use.range, use.upper_limit); }
Nearness length_nearness(const Use& use) { return nearness_of_length(use.range, use.lower_limit, use.upper_limit); }

/// By which cables are put in order: how much of a limit is used, the more the worse. Beyond a limit it exceeds 1.
double slack_use(const Use& use) {
  if (use.lower_limit > 0 && use.range.lower > 0) return use.lower_limit / use.range.lower;
  return 1 - (use.range.lower - use.lower_limit) / (use.upper_limit - use.lower_limit);
}
double length_use(const Use& use) { return 1 - length_left(use) / (use.upper_limit - use.lower_limit); }

/// The index with the greatest of six.
template <class F>
std::size_t greatest(const F& of) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < kCables; ++i) {
    if (of(i) > of(best)) best = i;
  }
  return best;
}

/// Where, and on what it rests.
std::string at(const ReportContext& scene, const CableUse& use, double position) {
  const std::string place = place_text(scene, position);
  return use.source == CableUse::Source::kProved ? place : place + "; sampled, not proved";
}

/// "−18.8 N": a value beyond a limit, rounded towards it.
std::string amount(double value, const DisplayUnit& unit) {
  return fmt::format("{}{} {}", value < 0 ? "−" : "", unit.down(std::abs(value), 3), unit.name());
}

KeyNumber slack_number(const ReportContext& scene, const CableUse& use) {
  const DisplayUnit& force = scene.illustration.units.force;
  const std::size_t i = greatest([&](std::size_t k) { return slack_use(use.tension[k]); });
  const Use& t = use.tension[i];
  const bool is_kept = t.range.lower > t.lower_limit;
  return {"slack", "Closest to going slack",
          fmt::format("Cable {}: {}", i + 1, is_kept ? above_slack(t, force) : amount(t.range.lower, force)),
          fmt::format("{}limit {} {} · {}",
                      is_kept ? down_text(t.range.lower, t.lower_limit, force) + " " + force.name() + ", " : "slack ",
                      force.exact(scene.certificate.problem.robot.tension_N[i].lower), force.name(),
                      at(scene, use, t.least_at)),
          slack_nearness(t)};
}

KeyNumber top_number(const ReportContext& scene, const CableUse& use) {
  const DisplayUnit& force = scene.illustration.units.force;
  const std::size_t i = greatest([&](std::size_t k) { return use.tension[k].used(); });
  const Use& t = use.tension[i];
  const bool is_kept = t.range.upper < t.upper_limit;
  return {
      "top", "Highest tension", fmt::format("Cable {}: {}", i + 1, is_kept ? of_top(t) : amount(t.range.upper, force)),
      fmt::format("{}{} {} · {}",
                  is_kept ? up_text(t.range.upper, t.upper_limit, force) + " " + force.name() + " of " : "top limit ",
                  force.exact(scene.certificate.problem.robot.tension_N[i].upper), force.name(),
                  at(scene, use, t.greatest_at)),
      top_nearness(t)};
}

KeyNumber length_number(const ReportContext& scene, const CableUse& use) {
  const DisplayUnit& length = scene.illustration.units.length;
  const std::size_t i = greatest([&](std::size_t k) { return length_use(use.length[k]); });
  const Use& d = use.length[i];
  const Limits& limits = scene.certificate.problem.robot.length_m[i];
  const bool is_upper = d.upper_limit - d.range.upper < d.range.lower - d.lower_limit;
  const double left = length_left(d);
  return {
      "length", "Least length left",
      fmt::format("Cable {}: {}{} {}", i + 1, left > 0 ? "" : "−", length.down(std::abs(left), 3), length.name()),
      fmt::format(
          "{} {} of {} {} {} · {}",
          is_upper ? up_text(d.range.upper, d.upper_limit, length) : down_text(d.range.lower, d.lower_limit, length),
          length.name(), is_upper ? "at most" : "at least", length.exact(is_upper ? limits.upper : limits.lower),
          length.name(), at(scene, use, is_upper ? d.greatest_at : d.least_at)),
      length_nearness(d)};
}

/// The same thresholds as of a tension: 4/3 and 20/19 are 75 % and 95 % used.
Nearness growth_nearness(double factor) {
  if (!(factor > 1)) return Nearness::kOut;
  constexpr double kClose = 1 / 0.95;
  constexpr double kNear = 1 / 0.75;
  return factor <= kClose ? Nearness::kClose : factor <= kNear ? Nearness::kNear : Nearness::kCalm;
}

KeyNumber growth_number(const ReportContext& scene) {
  const std::string& scale = scene.certificate.margins->wrench_scale;
  const std::optional<TolerancesText>& tolerances = scene.certificate.problem.tolerances;
  std::string detail = "the whole set of loads, about the nominal one";
  if (tolerances) detail += ", with all tolerances as stated";
  return {"growth",
          "Load uncertainty could grow",
          "× " + growth_text(scale),
          detail,
          growth_nearness(ScalarTraits<double>::from_decimal(scale)),
          true};
}

/// What share of the uncertainties is provable, as the program says that sought it; nothing where that is of another
/// path than this.
std::optional<KeyNumber> share_number(const ReportContext& scene) {
  const std::optional<Headroom>& headroom = scene.illustration.headroom;
  if (!headroom || headroom->shares.empty() || headroom->shares.front().of.kind != UncertaintyKind::kAll) return {};
  if (headroom->subject == Headroom::Subject::kStraightWay) return {};
  const ProvableShare& all = headroom->shares.front();
  const bool is_none = Decimal::parse(all.share).sign() == 0;
  std::string detail = is_none ? "not even the nominal machine under its nominal load"
                               : "of all that is stated, together; no permission to run with so much";
  if (headroom->subject == Headroom::Subject::kWaypoint) {
    detail = fmt::format("at waypoint {} alone, {}", headroom->waypoint, detail);
  }
  return KeyNumber{"growth", "Provable share of tolerances and loads",
                   is_none ? "none" : truncated((Decimal::parse(all.share) * Decimal::parse("100")).text(), 3) + " %",
                   detail + "; not re-checked", growth_nearness(ScalarTraits<double>::from_decimal(all.share))};
}

}  // namespace

std::vector<KeyNumber> key_numbers(const ReportContext& scene, const CableUse& use) {
  std::vector<KeyNumber> numbers;
  if (scene.verdict == "unchecked") return numbers;
  const bool is_proved = use.source == CableUse::Source::kProved && scene.verdict == "proved";
  if (is_proved || use.source == CableUse::Source::kSamples) {
    for (const auto& make : {slack_number, top_number, length_number}) {
      numbers.push_back(make(scene, use));
      numbers.back().is_proved = is_proved;
    }
  }
  if (is_proved) {
    numbers.push_back(growth_number(scene));
  } else if (const std::optional<KeyNumber> share = share_number(scene)) {
    numbers.push_back(*share);
  }
  return numbers;
}

std::vector<CableLine> cable_lines(const ReportContext& scene, const CableUse& use) {
  std::vector<CableLine> lines;
  if (use.source == CableUse::Source::kNone) return lines;
  const DisplayUnit& force = scene.illustration.units.force;
  const DisplayUnit& length = scene.illustration.units.length;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Use& t = use.tension[i];
    const Use& d = use.length[i];
    const double left = length_left(d);
    lines.push_back({i, down_text(t.range.lower, t.lower_limit, force), up_text(t.range.upper, t.upper_limit, force),
                     above_slack(t, force), of_top(t),
                     fmt::format("{}{} {}", left > 0 ? "" : "−", length.down(std::abs(left), 3), length.name()),
                     slack_nearness(t), top_nearness(t), length_nearness(d)});
  }
  const auto badness = [&](const CableLine& line) {
    const Use& t = use.tension[line.cable];
    return std::pair(worse(worse(line.slack, line.top), line.length), std::max(slack_use(t), t.used()));
  };
  std::ranges::stable_sort(lines, [&](const CableLine& a, const CableLine& b) { return badness(a) > badness(b); });
  return lines;
}

}  // namespace taut
