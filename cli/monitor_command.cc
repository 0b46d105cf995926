// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/monitor_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/meshes.h"
#include "app/monitor.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "certificate/certificate_reader.h"
#include "cli/console.h"
#include "cli/measurements.h"
#include "cli/output.h"
#include "problem/scalar.h"
#include "problem/units.h"
#include "reports/summary/illustration.h"

namespace taut {
namespace {

/// An error of a gauge: "2 mm". A bare number could be meant in the case's units, or in SI.
double gauge_error(const std::string& text, const char* option, Dimension dimension) {
  if (text.empty()) return 0;
  const auto fail = [&] {
    return InputError(ErrorCode::kUse,
                      fmt::format("{}: got '{}', expected a number of 0 or more with a unit of {}, one of {}", option,
                                  excerpt(text), dimension_name(dimension), unit_names(dimension)));
  };
  const auto [number, unit] = split_unit(text);
  if (!unit && text == "0") return 0;
  if (!unit || unit->dimension != dimension) throw fail();
  const Unit& chosen = *unit;
  try {
    const Decimal value = Decimal::parse(number.substr(0, number.find_last_not_of(' ') + 1)) * chosen.factor;
    const double si = ScalarTraits<double>::from_decimal(value.text());
    constexpr double kRadiansPerDegree = 0.017453292519943295;
    const double result = chosen.is_degree ? si * kRadiansPerDegree : si;
    if (result >= 0 && std::isfinite(result)) return result;
  } catch (const InputError&) {
    throw fail();
  }
  throw fail();
}

GaugeErrors gauge_errors(const MonitorArguments& arguments) {
  return {gauge_error(arguments.length_error, "--length-error", Dimension::kLength),
          gauge_error(arguments.tension_error, "--tension-error", Dimension::kForce),
          gauge_error(arguments.position_error, "--position-error", Dimension::kLength),
          gauge_error(arguments.orientation_error, "--orientation-error", Dimension::kAngle),
          gauge_error(arguments.time_error, "--time-error", Dimension::kTime)};
}

std::string in_seconds(double seconds) { return fmt::format("{:.6g} s", seconds); }
std::string percent_text(double share) { return fmt::format("{:.4g} %", 100 * share); }

/// What has been seen so far.
struct Tally {
  struct LastGood {
    std::size_t row = 0;
    std::optional<double> time_s, place;
  };
  std::size_t rows = 0, rows_with_alarms = 0, bad_lines = 0;
  std::array<std::size_t, kAlarmKinds> alarms{};
  std::optional<LastGood> last_good;
  ResidualShares largest;
  std::optional<double> first_lead_s;  ///< of the first row that has one: the clock may begin at any time
  std::optional<double> most_lag_s, most_lead_s;

  void add(const MeasuredRow& row, const RowVerdict& verdict) {
    ++rows;
    if (verdict.is_good()) {
      last_good = {rows, row.time_s, verdict.place};
    } else {
      ++rows_with_alarms;
    }
    for (const Alarm& alarm : verdict.alarms) ++alarms[static_cast<std::size_t>(alarm.kind)];
    largest.place = std::max(largest.place, verdict.shares.place);
    largest.tension = std::max(largest.tension, verdict.shares.tension);
    largest.load = std::max(largest.load, verdict.shares.load);
    if (!verdict.lead_s) return;
    if (!first_lead_s) first_lead_s = verdict.lead_s;
    const double lead_s = *verdict.lead_s - *first_lead_s;
    most_lag_s = std::max(most_lag_s.value_or(-HUGE_VAL), -lead_s);
    most_lead_s = std::max(most_lead_s.value_or(-HUGE_VAL), lead_s);
  }
  [[nodiscard]] std::size_t count() const {
    std::size_t sum = 0;
    for (const std::size_t one : alarms) sum += one;
    return sum;
  }
};

/// Says what happens, each thing on a line that is written at once.
class Voice {
 public:
  Voice(bool json, DisplayUnits units) : json_(json), units_(std::move(units)) {}

  void begin(const Monitor& monitor, const GaugeErrors& errors, const MeasurementTable& table) const;
  void alarm(const Alarm& alarm, const Tally& tally, std::size_t line, const MeasuredRow& row,
             const RowVerdict& verdict) const;
  void bad_line(std::size_t line, const std::string& complaint) const;
  void end(const Tally& tally, int exit_code, bool is_interrupted) const;

 private:
  static void say(const std::string& line) {
    const std::string text = line + "\n";
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
      throw std::runtime_error("could not write to standard output");
    }
  }
  /// Without line breaks, so that each line is a document.
  static void say_json(nlohmann::json document) {
    document["command"] = "monitor";
    say(document.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  }
  [[nodiscard]] std::string length(double metres) const {
    return units_.length.nearest(metres, 6) + " " + units_.length.name();
  }
  [[nodiscard]] std::string force(double newtons) const {
    return units_.force.nearest(newtons) + " " + units_.force.name();
  }
  [[nodiscard]] std::string between(const DisplayUnit& unit, double lower, double upper, int digits) const {
    return fmt::format("{} to {} {}", unit.nearest(lower, digits), unit.nearest(upper, digits), unit.name());
  }
  [[nodiscard]] std::string words(const Alarm& alarm) const;
  [[nodiscard]] std::string guess(const LoadGuess& guess) const;

  bool json_;
  DisplayUnits units_;
};

nlohmann::json optional_json(const std::optional<double>& x) { return x ? nlohmann::json(*x) : nlohmann::json(); }

/// A share; null where nothing was compared, or nothing at all is allowed.
nlohmann::json share_json(double share) {
  return share >= 0 && share < 1e30 ? nlohmann::json(share) : nlohmann::json();
}

void Voice::begin(const Monitor& monitor, const GaugeErrors& errors, const MeasurementTable& table) const {
  const Path& path = monitor.proved().path;
  if (json_) {
    say_json({{"event", "start"},
              {"move_s", path.timing ? nlohmann::json(path.timing->duration_s()) : nlohmann::json()},
              {"segments", path.segments()},
              {"columns", table.columns()},
              {"gauge_errors",
               {{"length_m", errors.length_m},
                {"tension_N", errors.tension_N},
                {"position_m", errors.position_m},
                {"orientation_rad", errors.orientation_rad},
                {"time_s", errors.time_s}}},
              {"allowed",
               {{"length_m", monitor.length_allowed()},
                {"position_m", monitor.position_allowed()},
                {"orientation_rad", monitor.orientation_allowed()}}}});
    return;
  }
  say(
      fmt::format("Monitoring a proved {} of {}. Gauges err by up to: lengths {}, tensions {}, positions {}, "
                  "orientations {}, times {}.",
                  path.timing ? "move of " + in_seconds(path.timing->duration_s()) : "path",
                  plural(path.segments(), "segment"), length(errors.length_m), force(errors.tension_N),
                  length(errors.position_m), units_.angle(errors.orientation_rad), in_seconds(errors.time_s)));
  std::string allowed;
  if (table.has_lengths()) {
    const auto [least, most] = std::ranges::minmax(monitor.length_allowed());
    allowed += fmt::format("; lengths within {} of the path's",
                           least == most ? length(most) : between(units_.length, least, most, 4));
  }
  if (table.has_pose()) {
    allowed += monitor.is_length_controlled()
                   ? "; the pose by its lengths, as the machine is controlled by lengths"
                   : fmt::format("; the pose within {} and {}", length(monitor.position_allowed()),
                                 units_.angle(monitor.orientation_allowed()));
  }
  if (table.tensions() > 0) allowed += "; tensions within what is proved of the place";
  const bool has_load = table.tensions() == kCables && (!monitor.is_length_controlled() || table.has_pose());
  allowed += has_load ? "; the load" : "; not the load, for which six tensions are needed";
  if (!has_load && table.tensions() == kCables) allowed += " and a pose";
  const bool in_time = table.has_time() && monitor.is_move();
  allowed += in_time              ? "; the time"
             : !monitor.is_move() ? "; not the time, of which nothing is proved"
                                  : "; not the time, of which there is no column";
  say(fmt::format("Columns {}. Checked: {}.", sanitize(table.columns()), allowed.substr(2)));
}

std::string Voice::guess(const LoadGuess& guess) const {
  switch (guess.kind) {
    case LoadGuess::Kind::kMass: {
      const double mass = std::abs(guess.amount);
      const char* const more = guess.amount < 0 ? "less" : "more";
      return mass >= 1000 ? fmt::format("{:.3g} t {} of '{}'", mass / 1000, more, sanitize(guess.item))
                          : fmt::format("{:.3g} kg {} of '{}'", mass, more, sanitize(guess.item));
    }
    case LoadGuess::Kind::kForce: return fmt::format("{} more of '{}'", force(guess.amount), sanitize(guess.item));
    case LoadGuess::Kind::kMoment: break;
  }
  return fmt::format("{} {} more of '{}'", units_.moment.nearest(guess.amount), units_.moment.name(),
                     sanitize(guess.item));
}

std::string Voice::words(const Alarm& alarm) const {
  const int cable = alarm.cable + 1;
  const char* const alone = alarm.is_alone ? "; all else fits this place" : "";
  switch (alarm.kind) {
    case AlarmKind::kLength:
      return fmt::format("length of cable {}: measured {}, allowed {}{}", cable, length(alarm.measured),
                         between(units_.length, alarm.lower, alarm.upper, 6), alone);
    case AlarmKind::kPosition:
      return fmt::format("position: {} off the path, allowed {}{}", length(alarm.measured), length(alarm.upper), alone);
    case AlarmKind::kOrientation:
      return fmt::format("orientation: {} off the path, allowed {}{}", units_.angle(alarm.measured),
                         units_.angle(alarm.upper), alone);
    case AlarmKind::kAhead:
      return fmt::format("ahead of the law: it takes {} at least from the last row to here, {} passed",
                         in_seconds(alarm.measured), in_seconds(alarm.upper));
    case AlarmKind::kBackwards:
      return fmt::format("backwards: at s = {:.6g} at most, where it can't be before s = {:.6g}", alarm.measured,
                         alarm.lower);
    case AlarmKind::kWinchSpeed:
      return fmt::format("winch speed of cable {}: {} in {}, allowed {}", cable, length(alarm.measured),
                         in_seconds(alarm.over_s), length(alarm.upper));
    case AlarmKind::kTension:
      return fmt::format("tension of cable {}: measured {}, allowed {}", cable, force(alarm.measured),
                         between(units_.force, alarm.lower, alarm.upper, 4));
    case AlarmKind::kLoad: break;
  }
  return fmt::format("load: {} off the nominal load, allowed {}{}", force(alarm.measured), force(alarm.upper),
                     alarm.guess ? "; looks like " + guess(*alarm.guess) : "");
}

void Voice::alarm(const Alarm& alarm, const Tally& tally, std::size_t line, const MeasuredRow& row,
                  const RowVerdict& verdict) const {
  if (json_) {
    nlohmann::json guessed;
    if (alarm.guess) {
      constexpr std::array kUnits = {"mass_kg", "force_N", "moment_N_m"};
      guessed = {{"item", alarm.guess->item},
                 {"quantity", kUnits.at(static_cast<std::size_t>(alarm.guess->kind))},
                 {"amount", alarm.guess->amount}};
    }
    say_json({{"event", "alarm"},
              {"what", name(alarm.kind)},
              {"row", tally.rows},
              {"line", line},
              {"t_s", optional_json(row.time_s)},
              {"s", optional_json(verdict.place)},
              {"cable", alarm.cable < 0 ? nlohmann::json() : nlohmann::json(alarm.cable + 1)},
              {"measured", alarm.measured},
              {"allowed", {alarm.lower, alarm.upper}},
              {"guess", guessed},
              {"text", words(alarm)}});
    return;
  }
  say(fmt::format("ALARM row {}, line {}, t = {}, s = {}: {}", tally.rows, line,
                  row.time_s ? fmt::format("{} s", *row.time_s) : "-",
                  verdict.place ? fmt::format("{:.6g}", *verdict.place) : "-", words(alarm)));
}

void Voice::bad_line(std::size_t line, const std::string& complaint) const {
  if (json_) {
    say_json({{"event", "bad line"}, {"line", line}, {"text", sanitize(complaint)}});
  } else {
    say(fmt::format("BAD line {}: {}", line, sanitize(complaint)));
  }
}

void Voice::end(const Tally& tally, int exit_code, bool is_interrupted) const {
  nlohmann::json counts = nlohmann::json::object();
  std::vector<std::string> kinds;
  for (std::size_t k = 0; k < kAlarmKinds; ++k) {
    const char* const kind = name(static_cast<AlarmKind>(k));
    counts[kind] = tally.alarms[k];
    if (tally.alarms[k] > 0) kinds.push_back(fmt::format("{} {}", tally.alarms[k], kind));
  }
  if (json_) {
    nlohmann::json last_good;
    if (tally.last_good) {
      last_good = {{"row", tally.last_good->row},
                   {"t_s", optional_json(tally.last_good->time_s)},
                   {"s", optional_json(tally.last_good->place)}};
    }
    say_json({{"event", "summary"},
              {"rows", tally.rows},
              {"rows_with_alarms", tally.rows_with_alarms},
              {"alarms", counts},
              {"bad_lines", tally.bad_lines},
              {"last_good", last_good},
              {"largest_shares",
               {{"place", share_json(tally.largest.place)},
                {"tension", share_json(tally.largest.tension)},
                {"load", share_json(tally.largest.load)}}},
              {"most_lag_s", optional_json(tally.most_lag_s)},
              {"most_lead_s", optional_json(tally.most_lead_s)},
              {"interrupted", is_interrupted},
              {"exit_code", exit_code}});
    return;
  }
  if (is_interrupted) say("Interrupted.");
  say(fmt::format("{}, {} of them good. {}{}.{}", plural(tally.rows, "row"), tally.rows - tally.rows_with_alarms,
                  plural(tally.count(), "alarm"), kinds.empty() ? "" : fmt::format(" ({})", fmt::join(kinds, ", ")),
                  tally.bad_lines == 0 ? "" : fmt::format(" {} could not be read.", plural(tally.bad_lines, "line"))));
  if (tally.last_good) {
    const Tally::LastGood& last = *tally.last_good;
    say(fmt::format("Last good row: {}{}{}.", last.row, last.time_s ? fmt::format(", t = {} s", *last.time_s) : "",
                    last.place ? fmt::format(", s = {:.6g}", *last.place) : ""));
  }
  std::vector<std::string> shares;
  const auto add = [&](const char* what, double share) {
    if (share >= 0)
      shares.push_back(fmt::format("{} {}", what, share < 1e30 ? percent_text(share) : "beyond all bounds"));
  };
  add("place", tally.largest.place);
  add("tensions", tally.largest.tension);
  add("load", tally.largest.load);
  if (!shares.empty()) say(fmt::format("Largest residuals, of what is allowed: {}.", fmt::join(shares, ", ")));
  if (tally.most_lag_s) {
    const auto by = [](double seconds, const char* word, const char* opposite) {
      return fmt::format("{} {}", in_seconds(std::abs(seconds)), seconds < 0 ? opposite : word);
    };
    say(fmt::format("Against the law, rows are from {} to {}.", by(*tally.most_lag_s, "behind", "ahead"),
                    by(*tally.most_lead_s, "ahead", "behind")));
  }
}

/// Reads on to the first line that is neither blank nor a comment.
LineReader::Status next_row(LineReader& lines, std::string_view& line, const std::stop_token& stop) {
  for (;;) {
    const LineReader::Status status = lines.next(line, stop);
    const std::size_t begin = line.find_first_not_of(" \t\r");
    const bool is_empty = begin == std::string_view::npos || line[begin] == '#';
    if (is_empty && (status == LineReader::Status::kLine || status == LineReader::Status::kCut)) continue;
    return status;
  }
}

int watch(Monitor& monitor, LineReader& lines, MeasurementTable& table, const Voice& voice,
          const std::stop_token& stop) {
  Tally tally;
  std::string_view line;
  bool is_interrupted = false;
  for (;;) {
    const LineReader::Status status = next_row(lines, line, stop);
    is_interrupted = status == LineReader::Status::kInterrupted;
    if (is_interrupted || status == LineReader::Status::kEnd) break;
    std::string complaint;
    std::optional<MeasuredRow> row;
    if (status == LineReader::Status::kTooLong) {
      complaint = "got a line that is too long, expected a row";
    } else if (status == LineReader::Status::kCut) {
      complaint = "got no line end, expected a row that is not cut";
    } else {
      row = table.read(line, complaint);
    }
    if (!row) {
      ++tally.bad_lines;
      voice.bad_line(lines.number(), complaint);
      continue;
    }
    const RowVerdict verdict = monitor.judge(*row);
    tally.add(*row, verdict);
    for (const Alarm& alarm : verdict.alarms) voice.alarm(alarm, tally, lines.number(), *row, verdict);
  }
  const int code = tally.count() > 0     ? kRefutedExit
                   : is_interrupted      ? kUndecidedExit
                   : tally.bad_lines > 0 ? kBadInputExit
                                         : kProvedExit;
  voice.end(tally, code, is_interrupted);
  return code;
}

DisplayUnits units_of(const Certificate& certificate) {
  return Illustration(certificate.illustration, certificate.problem.space.parameters.size()).units;
}

}  // namespace

void add_monitor_options(CLI::App& command, MonitorArguments& arguments) {
  command.add_option("CERTIFICATE", arguments.certificate_path, "certificate.json of a proved path or move")
      ->required();
  command.add_option("MEASUREMENTS", arguments.measurements,
                     "table of measurements (docs/monitor.md), a file or a pipe; none or -: standard input");
  command.add_option("--length-error", arguments.length_error,
                     "how far a measured length may be off, such as 2mm (default: 0)");
  command.add_option("--tension-error", arguments.tension_error,
                     "how far a measured tension may be off, such as 0.5kN (default: 0)");
  command.add_option("--position-error", arguments.position_error,
                     "how far a measured position may be off (default: 0)");
  command.add_option("--orientation-error", arguments.orientation_error,
                     "how far a measured orientation may be off, such as 0.1deg (default: 0)");
  command.add_option("--time-error", arguments.time_error, "how far a row's time may be off, such as 5ms (default: 0)");
  add_max_seconds_option(command, arguments.max_seconds);
  command.add_flag("--json", arguments.json, "print a JSON document on each line");
}

int run_monitor(const MonitorArguments& arguments) {
  const GaugeErrors errors = gauge_errors(arguments);
  const Interruption interruption;
  const std::string& path = arguments.certificate_path;
  const std::string bytes = read_whole(path);
  const checker::CheckResult checked = recheck(bytes, arguments.max_seconds, interruption.token(),
                                               meshes_in({std::filesystem::path(path).parent_path()}));
  const auto stop = [&](int code) {
    const std::string message = fmt::format("{}: {} Nothing is monitored.", path, sentence(checked));
    complain(message);
    if (arguments.json)
      print_json(error_json("monitor", sanitize(message), text(ErrorCode::kCertificate), code, {path}));
    return code;
  };
  if (checked.outcome == checker::Outcome::kMalformed) {
    with_error_code(ErrorCode::kCertificate, path, [&] { (void)read_certificate(parse_certificate(bytes, path)); });
    throw InputError(ErrorCode::kCertificate, fmt::format("{}: got {}, expected a certificate", path, checked.message),
                     {path});
  }
  if (interruption.token().stop_requested()) {
    return report_interruption("monitor", "interrupted: nothing was monitored", arguments.json);
  }
  if (checked.outcome == checker::Outcome::kRejected) return stop(kRefutedExit);
  if (checked.outcome == checker::Outcome::kUnchecked) return stop(kUndecidedExit);
  const bool is_proved = checked.theorem && checked.theorem->verdict() == checker::Theorem::Verdict::kProved;
  if (!is_proved) {
    throw InputError(
        ErrorCode::kCertificate,
        fmt::format("{}: got the verdict '{}', expected a path that is proved", path, verdict_name(checked)), {path});
  }
  const Certificate certificate =
      with_error_code(ErrorCode::kCertificate, path, [&] { return read_certificate(checked.theorem->certificate()); });
  Monitor monitor =
      with_error_code(ErrorCode::kCertificate, path, [&] { return Monitor(proved_path(certificate), errors); });
  LineReader lines(arguments.measurements);
  std::string_view first;
  const LineReader::Status status = next_row(lines, first, interruption.token());
  if (status == LineReader::Status::kInterrupted) {
    return report_interruption("monitor", "interrupted before the first line", arguments.json);
  }
  if (status != LineReader::Status::kLine) {
    throw InputError(ErrorCode::kPath,
                     fmt::format("{}: got no complete line, expected a header and rows", lines.name()), {lines.name()});
  }
  MeasurementTable table(first, lines.name(), lines.number());
  const Voice voice(arguments.json,
                    with_error_code(ErrorCode::kCertificate, path, [&] { return units_of(certificate); }));
  voice.begin(monitor, errors, table);
  return watch(monitor, lines, table, voice, interruption.token());
}

}  // namespace taut
