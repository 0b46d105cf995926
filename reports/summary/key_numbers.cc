// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/key_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "problem/decimal.h"
#include "reports/summary/numbers.h"
#include "reports/summary/sentences.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

/// Of a move that may be stopped anywhere, braking may do what samples don't show.
const char* sampled_text(const ReportContext& scene) {
  const auto& time = scene.certificate.problem.time;
  return time && time->stopping_time_s ? "sampled at full speed, not proved" : "sampled, not proved";
}

constexpr int kDigits = 3;

/// A bound as the exact number that it is. Infinite ones, of which there are none on a path that can be shown, become
/// large.
Rational exact(double x) {
  constexpr double kLarge = 1e300;
  return {std::isfinite(x) ? x : std::copysign(kLarge, x)};
}
Rational exact(const DecimalText& text) { return Decimal::parse(text).rational(); }

/// The digits of x >= 0, on the side of x that `rounding` asks for.
std::string digits_of(const Rational& x, int digits, Rounding rounding) {
  constexpr double kRounding = 1e-15;  // more than conversion and multiplication err by
  constexpr double kLargest = 1e290;
  const auto nearest = x.convert_to<double>();
  std::string text = rounded_to_nearest(nearest, digits);
  if (!(nearest < kLargest)) return text;
  const Rational shown = exact(text);
  if (rounding == Rounding::kDown ? shown <= x : shown >= x) return text;
  return rounding == Rounding::kDown ? rounded_down(nearest * (1 - kRounding), digits)
                                     : rounded_up(nearest * (1 + kRounding), digits);
}

/// "+1.86", "−18.7", "0": rounded towards 0, which is the limit; the sign is that of x itself, whatever the digits are.
std::string signed_digits(const Rational& x, const char* plus) {
  if (x == 0) return "0";
  return (x > 0 ? plus : "−") + digits_of(abs(x), kDigits, Rounding::kDown);
}

/// The limits of one quantity of the cables, exactly.
struct Exact {
  Rational least, greatest;    ///< of the move: bounds, or of samples
  Rational lower, upper;       ///< limits
  Rational seen_low, seen_up;  ///< where they are: what tells cables apart whose bounds are the same

  Exact(const Use& use, const Limits& limits)
      : least(exact(use.range.lower)),
        greatest(exact(use.range.upper)),
        lower(exact(limits.lower)),
        upper(exact(limits.upper)),
        seen_low(exact(use.least_seen)),
        seen_up(exact(use.greatest_seen)) {}

  [[nodiscard]] bool is_above() const { return least > lower; }
  [[nodiscard]] bool is_below() const { return greatest < upper; }
  /// What is left to the nearer limit.
  [[nodiscard]] Rational left() const { return std::min<Rational>(least - lower, upper - greatest); }
  [[nodiscard]] Rational left_as_seen() const { return std::min<Rational>(seen_low - lower, upper - seen_up); }
};

/// What is said of the six cables: from here are all numbers of tiles and tables.
class Cables {
 public:
  Cables(const ReportContext& scene, const CableUse& use)
      : scene_(scene), use_(use), is_sampled_(use.source == CableUse::Source::kSamples) {
    const RobotText& robot = scene.certificate.problem.robot;
    for (std::size_t i = 0; i < kCables; ++i) {
      tension_.emplace_back(use.tension[i], robot.tension_N[i]);
      length_.emplace_back(use.length[i], robot.length_m[i]);
    }
    slack_in_percent_ = std::ranges::all_of(tension_, [](const Exact& t) { return t.lower > 0; });
    top_in_percent_ = std::ranges::all_of(tension_, [](const Exact& t) { return t.upper > 0; });
  }

  [[nodiscard]] CableLine line(std::size_t i) const {
    const Use& t = use_.tension[i];
    return {i,
            low(t, t.lower_limit, force()),
            high(t, t.upper_limit, force()),
            above_slack(i),
            of_top(i),
            left(i),
            slack(i),
            top(i),
            length(i)};
  }

  [[nodiscard]] KeyNumber slack_number() const {
    const bool is_kept = std::ranges::all_of(tension_, &Exact::is_above);
    const std::size_t i = least(
        [&](const Exact& t, const Rational& value) -> Rational {
          if (is_kept) return slack_in_percent_ ? Rational(value / t.lower) : Rational(value - t.lower);
          return value;  // of those that are not above their limits, whose tensions are printed
        },
        tension_, &Exact::least, &Exact::seen_low, [&](const Exact& t) { return is_kept || !t.is_above(); });
    const Use& t = use_.tension[i];
    const std::string value = low(t, t.lower_limit, force());
    const std::string limit = force().exact(limits(i).lower);
    const char* const title =
        is_kept || has_one(&Limits::lower) ? "Closest to going slack" : "Lowest tension below its limit";
    return {"slack", title, fmt::format("Cable {}: {}", i + 1, is_kept ? above_slack(i) : with_unit(value, force())),
            fmt::format("{} {} {} · {}", is_kept ? with_unit(value, force()) + ", limit" : "slack limit", limit,
                        force().name(), at(t.least_at)),
            worst(&Cables::slack)};
  }

  [[nodiscard]] KeyNumber top_number() const {
    const bool is_kept = std::ranges::all_of(tension_, &Exact::is_below);
    const std::size_t i = least(
        [&](const Exact& t, const Rational& value) -> Rational {
          if (is_kept) return top_in_percent_ ? Rational(-value / t.upper) : Rational(t.upper - value);
          return -value;
        },
        tension_, &Exact::greatest, &Exact::seen_up, [&](const Exact& t) { return is_kept || !t.is_below(); });
    const Use& t = use_.tension[i];
    const std::string value = high(t, t.upper_limit, force());
    const std::string limit = force().exact(limits(i).upper);
    const char* const title = has_one(&Limits::upper) ? "Highest tension"
                              : is_kept               ? "Tension nearest its top limit"
                                                      : "Highest tension beyond its limit";
    return {"top", title, fmt::format("Cable {}: {}", i + 1, is_kept ? of_top(i) : with_unit(value, force())),
            fmt::format("{} {} {} · {}", is_kept ? with_unit(value, force()) + " of" : "top limit", limit,
                        force().name(), at(t.greatest_at)),
            worst(&Cables::top)};
  }

  [[nodiscard]] KeyNumber length_number() const {
    std::size_t i = 0;
    for (std::size_t k = 1; k < kCables; ++k) {
      const auto left = [&](std::size_t c) { return std::pair(length_[c].left(), length_[c].left_as_seen()); };
      if (left(k) < left(i)) i = k;
    }
    const Use& d = use_.length[i];
    const Exact& e = length_[i];
    const bool is_upper = e.upper - e.greatest < e.least - e.lower;
    const DisplayUnit& unit = units().length;
    const Limits& limits = scene_.certificate.problem.robot.length_m[i];
    return {"length", "Least length left", fmt::format("Cable {}: {}", i + 1, left(i)),
            fmt::format("{} of {} {} {} · {}",
                        with_unit(is_upper ? high(d, d.upper_limit, unit) : low(d, d.lower_limit, unit), unit),
                        is_upper ? "at most" : "at least", unit.exact(is_upper ? limits.upper : limits.lower),
                        unit.name(), at(is_upper ? d.greatest_at : d.least_at)),
            worst(&Cables::length)};
  }

 private:
  [[nodiscard]] const DisplayUnits& units() const { return scene_.illustration.units; }
  [[nodiscard]] const DisplayUnit& force() const { return units().force; }
  [[nodiscard]] const Limits& limits(std::size_t i) const { return scene_.certificate.problem.robot.tension_N[i]; }
  /// Whether all six cables have the same limit.
  [[nodiscard]] bool has_one(DecimalText Limits::*limit) const {
    const auto& all = scene_.certificate.problem.robot.tension_N;
    return std::ranges::all_of(all, [&](const Limits& l) { return exact(l.*limit) == exact(all[0].*limit); });
  }

  /// The ends of a range, without their unit.
  [[nodiscard]] std::string low(const Use& use, double limit, const DisplayUnit& unit) const {
    return is_sampled_ ? sampled_text(use.range.lower, limit, unit) : down_text(use.range.lower, limit, unit);
  }
  [[nodiscard]] std::string high(const Use& use, double limit, const DisplayUnit& unit) const {
    return is_sampled_ ? sampled_text(use.range.upper, limit, unit) : up_text(use.range.upper, limit, unit);
  }
  static std::string with_unit(const std::string& number, const DisplayUnit& unit) {
    return fmt::format("{} {}", number, unit.name());
  }

  static std::string amount(const Rational& si, const char* plus, const DisplayUnit& unit) {
    const std::string text = signed_digits(si, plus);
    const std::size_t sign = text.find_first_of("0123456789");
    return fmt::format("{}{} {}", text.substr(0, sign), unit.exact(text.substr(sign)), unit.name());
  }

  [[nodiscard]] std::string above_slack(std::size_t i) const {
    const Exact& t = tension_[i];
    const Rational above = t.least - t.lower;
    if (!slack_in_percent_) return amount(above, "+", force());
    return signed_digits(100 * above / t.lower, "+") + " %";
  }

  [[nodiscard]] std::string of_top(std::size_t i) const {
    const Exact& t = tension_[i];
    if (!top_in_percent_) return amount(t.upper - t.greatest, "", force()) + " left";
    const Rational percent = 100 * t.greatest / t.upper;
    if (percent < 0) return "0 %";  // of a cable that only pushes
    std::string text;
    for (const int digits : {3, 4, 6, 9, 12, 15, 17}) {
      text = digits_of(percent, digits, percent > 100 ? Rounding::kDown : Rounding::kUp);
      const Rational shown = exact(text);
      if ((shown < 100) == (percent < 100) && (shown > 100) == (percent > 100)) break;
    }
    return text + " %";
  }

  [[nodiscard]] std::string left(std::size_t i) const { return amount(length_[i].left(), "", units().length); }

  /// How near, with the limits as they are: these are rounded where colours are chosen.
  static Nearness truly(bool is_kept, Nearness nearness) {
    if (!is_kept) return Nearness::kOut;
    return nearness == Nearness::kOut ? Nearness::kClose : nearness;
  }
  [[nodiscard]] Nearness slack(std::size_t i) const {
    const Use& t = use_.tension[i];
    return truly(tension_[i].is_above(), nearness_to_slack(t.range, t.lower_limit, t.upper_limit));
  }
  [[nodiscard]] Nearness top(std::size_t i) const {
    const Use& t = use_.tension[i];
    return truly(tension_[i].is_below(), nearness_to_top(t.range, t.upper_limit));
  }
  [[nodiscard]] Nearness length(std::size_t i) const {
    const Use& d = use_.length[i];
    return truly(length_[i].left() > 0, nearness_of_length(d.range, d.lower_limit, d.upper_limit));
  }
  /// Of the six cables: the one that is named has the least of what is printed, and another may be nearer by share.
  [[nodiscard]] Nearness worst(Nearness (Cables::*of)(std::size_t) const) const {
    Nearness result = Nearness::kCalm;
    for (std::size_t i = 0; i < kCables; ++i) result = worse(result, (this->*of)(i));
    return result;
  }

  /// The index of the cable with the least `rank` of its bound, and of those whose bounds are the same, of what is seen
  /// at their places; among those that `is_meant`.
  template <class Rank, class IsMeant>
  static std::size_t least(const Rank& rank, const std::vector<Exact>& all, Rational Exact::*bound,
                           Rational Exact::*seen, const IsMeant& is_meant) {
    std::optional<std::size_t> best;
    const auto both = [&](const Exact& e) { return std::pair(rank(e, e.*bound), rank(e, e.*seen)); };
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (is_meant(all[i]) && (!best || both(all[i]) < both(all[*best]))) best = i;
    }
    return best.value_or(0);
  }

  /// Where, and on what it rests.
  [[nodiscard]] std::string at(double position) const {
    const std::string place = place_text(scene_, position);
    return use_.source == CableUse::Source::kProved ? place : fmt::format("{}; {}", place, sampled_text(scene_));
  }

  const ReportContext& scene_;
  const CableUse& use_;
  bool is_sampled_;
  bool slack_in_percent_ = true;  ///< what is above the slack limits; else an amount, for all cables
  bool top_in_percent_ = true;
  std::vector<Exact> tension_, length_;
};

/// By which cables are put in order: how much of a limit is used, the more the worse. Beyond a limit it exceeds 1.
double slack_use(const Use& use) {
  if (use.lower_limit > 0 && use.range.lower > 0) return use.lower_limit / use.range.lower;
  return 1 - (use.range.lower - use.lower_limit) / (use.upper_limit - use.lower_limit);
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
  const double factor = nearest_double(scale);
  constexpr double kMost = 1e6;  // that a certificate states
  if (factor >= kMost) detail += "; there is hardly any";
  return {"growth", "Load uncertainty could grow", "× " + growth_text(scale), detail, growth_nearness(factor), true};
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
                   detail + "; not re-checked", growth_nearness(nearest_double(all.share))};
}

/// The greatest length that a cable may have: the size of the machine.
double machine_size(const RobotText& robot) {
  double size = 0;
  for (const Limits& limits : robot.length_m) size = std::max(size, nearest_double(limits.upper));
  return size;
}

/// What is proved to be left of all clearances, or what samples show; nothing where no pairs are checked.
std::optional<KeyNumber> clearance_number(const ReportContext& scene, bool is_proved) {
  if (!scene.bodies || scene.distances.least.empty()) return {};
  const std::size_t k = scene.distances.worst();
  const BodyDistance& nearest = scene.distances.least[k];
  const DisplayUnit& unit = scene.illustration.units.length;
  constexpr double kSmall = 0.1;  // in mm below
  const DisplayUnit millimetres(*find_unit("mm"), "mm");
  const auto& proved = scene.certificate.margins ? scene.certificate.margins->clearance_m : std::nullopt;
  const bool has_bound = is_proved && proved;
  // Beyond its clearance, at least, with what deviations take; of samples, of the machine as stated.
  const double left = has_bound ? nearest_double(*proved) : nearest.left();
  const DisplayUnit& of_left = unit.name() == "m" && std::abs(left) < kSmall ? millimetres : unit;
  const std::string size = has_bound ? truncated(*proved) : "";
  const std::string value = has_bound  ? fmt::format("{} {} left", of_left.exact(size), of_left.name())
                            : left > 0 ? fmt::format("about {} {} left", of_left.down(left, kDigits), of_left.name())
                                       : fmt::format("{} {}", of_left.nearest(-left, kDigits), of_left.name());
  const std::string asked = asked_text(nearest, *scene.certificate.problem.bodies, unit);
  // What is proved is of all pairs and deviations, and may be another pair's.
  const bool is_of_all = has_bound && scene.distances.least.size() > 1;
  const char* const of_all = is_of_all ? "of all pairs, at least; nearest of the machine as stated: " : "";
  return KeyNumber{
      "clearance",
      left > 0             ? "Least clearance left"
      : nearest.is_in_cone ? "Out of an exit cone, by about"
                           : "Bodies too near, by about",
      value,
      fmt::format("{}{}, {}, {} · {}; sampled{}", of_all, scene.bodies->name(nearest.pair), apart_text(nearest, unit),
                  asked, place_text(scene, scene.samples[k].position), has_bound ? "" : ", not proved"),
      worse(nearness_of_bodies(left + nearest.clearance, nearest.clearance,
                               machine_size(scene.certificate.problem.robot)),
            Nearness::kCalm),
      has_bound};
}

const char* title_of_rate(RateKind kind) {
  switch (kind) {
    case RateKind::kWinchSpeed: return "Fastest winch";
    case RateKind::kWinchAcceleration: return "Greatest acceleration of a winch";
    case RateKind::kWinchPower: return "Greatest power of a winch";
    case RateKind::kLoadSpeed: return "Greatest speed of the load point";
    case RateKind::kLoadAcceleration: return "Greatest acceleration of the load point";
    case RateKind::kLoadAngularSpeed: return "Fastest turning of the platform";
    case RateKind::kLoadAngularAcceleration: break;
  }
  return "Greatest angular acceleration of the platform";
}

KeyNumber duration_number(const ReportContext& scene, bool is_proved) {
  const TimeLaw& law = *scene.certificate.path.timing;
  return {"duration",
          "Duration of the move",
          "T = " + seconds_text(law.duration_s()),
          "from rest to rest, as the certificate states it",
          Nearness::kCalm,
          is_proved};
}

/// Samples of the machine as stated; what is proved is that the limits are kept. A fast move uses its limits on
/// purpose: colours only tell whether they are kept.
KeyNumber rate_number(const ReportContext& scene, const RateUse& use, bool is_proved) {
  const DisplayUnits& units = scene.illustration.units;
  const RateId id = use.limit.id;
  constexpr double kPercent = 100;
  const std::string size = size_text(use, units);
  const double percent = kPercent * use.share();
  const std::string share = percent < kPercent ? rounded_down(percent, kDigits) : rounded_up(percent, kDigits);
  KeyNumber result{name(id.kind), title_of_rate(id.kind),
                   is_of_winch(id.kind) ? fmt::format("cable {}, {}", id.cable + 1, size) : size,
                   fmt::format("{} % of {} at t = {} · {}", share,
                               rate_limit_text(*scene.certificate.problem.time, id, units), seconds_text(use.time_s),
                               is_proved ? "sampled; that the limit is kept is proved" : sampled_text(scene)),
                   use.share() < 1 ? Nearness::kCalm : Nearness::kOut};
  result.is_of_rate = true;
  return result;
}

}  // namespace

std::vector<KeyNumber> key_numbers(const ReportContext& scene, const CableUse& use) {
  std::vector<KeyNumber> numbers;
  if (scene.verdict == "unchecked") return numbers;
  const bool is_proved = use.source == CableUse::Source::kProved && scene.verdict == "proved";
  if (is_proved || use.source == CableUse::Source::kSamples) {
    const Cables cables(scene, use);
    numbers = {cables.slack_number(), cables.top_number(), cables.length_number()};
    for (KeyNumber& number : numbers) number.is_proved = is_proved;
  }
  if (const auto clearance = clearance_number(scene, is_proved); clearance && !numbers.empty()) {
    numbers.push_back(*clearance);
  }
  if (is_move(scene.certificate)) {
    if (numbers.empty()) return numbers;
    numbers.push_back(duration_number(scene, is_proved));
    for (const RateUse& rate : rate_uses(scene)) numbers.push_back(rate_number(scene, rate, is_proved));
  } else if (is_proved) {
    numbers.push_back(growth_number(scene));
  } else if (const std::optional<KeyNumber> share = share_number(scene)) {
    numbers.push_back(*share);
  }
  return numbers;
}

std::vector<CableLine> cable_lines(const ReportContext& scene, const CableUse& use) {
  std::vector<CableLine> lines;
  if (use.source == CableUse::Source::kNone) return lines;
  const Cables cables(scene, use);
  for (std::size_t i = 0; i < kCables; ++i) lines.push_back(cables.line(i));
  const auto badness = [&](const CableLine& line) {
    const Use& t = use.tension[line.cable];
    return std::pair(worse(worse(line.slack, line.top), line.length), std::max(slack_use(t), t.used()));
  };
  std::ranges::stable_sort(lines, [&](const CableLine& a, const CableLine& b) { return badness(a) > badness(b); });
  return lines;
}

}  // namespace taut
