// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/timed_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "app/meshes.h"
#include "app/path_hints.h"
#include "app/plan.h"
#include "app/prove.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "base/sha256.h"
#include "certificate/certificate_writer.h"
#include "certify/row_distance.h"
#include "kinematics/move_sampler.h"
#include "kinematics/pose_conversion.h"
#include "kinematics/time_limits.h"
#include "path_io/path_file.h"
#include "path_io/path_summary.h"
#include "path_io/waypoint_maker.h"
#include "planner/move_fit.h"
#include "problem/rows.h"
#include "reports/summary/angles.h"
#include "reports/summary/display_units.h"
#include "reports/summary/illustration.h"
#include "reports/summary/shown_bodies.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

/// "0.0123 mm": a bound, rounded up.
std::string millimetres_above(double metres) { return DisplayUnits().length.up(metres, 3) + " mm"; }
std::string degrees_above(double radians) {
  constexpr double kDegrees = 180 / std::numbers::pi * (1 + 1e-15);
  return rounded_up(kDegrees * radians, 3) + " deg";
}

/// Roll, pitch and yaw [rad] of R(q), roll and yaw by whole turns next to `previous`. Near a pitch of ±90 degrees only
/// one of roll and yaw matters.
std::array<double, 3> roll_pitch_yaw(const Eigen::Quaterniond& q,
                                     const std::optional<std::array<double, 3>>& previous) {
  std::array<double, 3> result = angles_of(AngleKind::kRollPitchYaw, q.toRotationMatrix());
  if (!previous) return result;
  for (const std::size_t i : {0U, 2U})
    result[i] += 2 * std::numbers::pi * std::round(((*previous)[i] - result[i]) / (2 * std::numbers::pi));
  return result;
}

/// Reads a table with times whole, and fits a move to it.
class TableReader {
 public:
  TableReader(const Problem& problem, const PathInput& input, const TableRounding& rounding)
      : with_query_(problem), problem_(problem), name_(input.name), bytes_(bytes_of(input)), rounding_(rounding) {
    problem_.query.clear();
  }

  MoveSource read() {
    read_rows();
    choose_space();
    MoveSource source;
    const MoveFit fit = fitted();
    source.path = fit.path;
    source.table = table(fit);
    source.table->jump_m_s = state_rows();
    source.problem = problem_;
    Sha256 digest;
    digest.update(bytes_);
    source.origin = {excerpt(std::filesystem::path(name_).filename().string()), digest.hex()};
    source.description = fmt::format("Read {}: {}Fitted: a cubic B-spline in {} pieces of {:.4g} s{}. {}\n",
                                     sanitize(name_), summary_, fit.path.segments(), fit.path.timing->step_s,
                                     source.table->angles.empty() ? "" : ", in position and " + source.table->angles,
                                     row_sentence(*source.table));
    source.remarks = column_hint_;
    return source;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(name_ + ": " + message, {name_}); }
  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line, message), {name_, line});
  }

  void read_rows() {
    PathFile file(std::make_unique<std::istringstream>(bytes_), name_, problem_.space);
    header_ = file.header();
    if (header_.format == PathFormat::kTautControlPoints) {
      fail(
          "got a spline's control points, which have no times, expected the certificate of a move or a table with "
          "times");
    }
    const bool has_lengths = header_.form == PathForm::kCableLengths;
    if (has_lengths != rounding_.is_of_lengths()) {
      fail(has_lengths
               ? "got cable lengths and a rounding of poses, expected by how much a length may be off, such as "
                 "0.1mm, or audit.rounding.length in the case"
               : "got poses and a rounding of cable lengths, expected by how much the platform may be displaced "
                 "and turned, such as 0.1mm,0.01deg, or audit.rounding.position and angle in the case");
    }
    if (!header_.time) {
      fail("got no column t, expected one with the time of each row, such as t[s]: the audit is of a move in time");
    }
    if (header_.form == PathForm::kParameters && !problem_.space.constraints.empty()) {
      fail(
          "got columns of the case's parameters in a case with constraints, which imply another motion than these "
          "follow, expected poses (px, py, pz and angles or a quaternion)");
    }
    PathSummary summary(problem_, header_);
    std::optional<WaypointMaker> poses;
    if (has_lengths) poses.emplace(with_query_, header_, Interpolation::kCableLengths, name_);
    for (PathRow row; file.next(row);) {
      if (rows_.empty()) column_hint_ = column_hint(PoseSampler(problem_), header_, row);
      summary.add(row);
      rows_.push_back(row);
      if (header_.form == PathForm::kQuaternion) poses_.push_back(row.x);
      if (poses) add_pose(*poses, row, file.start());
    }
    summary_ = summary.text();
    if (rows_.size() < kLeastFittedRows) {
      fail(
          fmt::format("got {}, expected at least {} of a move in time", plural(rows_.size(), "row"), kLeastFittedRows));
    }
  }

  /// Where the machine has the lengths of a row, in floating point.
  void add_pose(WaypointMaker& poses, const PathRow& row, const std::vector<double>& start) {
    const Waypoint& waypoint = poses.next(row, start);
    if (rows_.size() == 1) require_start(with_query_, header_, poses, name_, row.line);
    if (poses.lost_line()) {
      fail(row.line,
           "got cable lengths for which no pose was found that follows from that of the row before, expected a motion "
           "without jumps, clear of singular poses");
    }
    poses_.emplace_back(waypoint.pose().begin(), waypoint.pose().end());
  }

  /// The space of the fit: the rows' own parameters or angles; for quaternions and lengths three angles that are clear
  /// all along.
  void choose_space() {
    if (header_.form == PathForm::kAngles) problem_.space = coordinate_space(header_.angles);
    if (poses_.empty()) {
      for (const PathRow& row : rows_) {
        std::vector<double>& x = parameters_.emplace_back(row.x);
        for (std::size_t j = 0; j < x.size(); ++j) x[j] += std::numbers::pi * row.half_turns[j];
      }
      return;
    }
    constexpr double kClear = 10 * std::numbers::pi / 180;  // of where two of three angles turn about one axis
    if (is_clear_in(AngleKind::kRollPitchYaw, kClear)) return;
    if (is_clear_in(AngleKind::kTiltAndTorsion, kClear)) return;
    fail(
        "got poses that are neither clear of a pitch of 90 degrees nor of a tilt of 0 or 180 degrees, expected columns "
        "of the case's own parameters or angles");
  }

  [[nodiscard]] bool is_clear_in(AngleKind kind, double clear) {
    parameters_.clear();
    std::optional<std::array<double, 3>> rpy;
    std::optional<TiltAndTorsion> tilted;
    for (const std::vector<double>& x : poses_) {
      const Eigen::Quaterniond q = Eigen::Quaterniond(x[6], x[3], x[4], x[5]).normalized();
      std::array<double, 3> angles{};
      bool is_clear = false;
      if (kind == AngleKind::kRollPitchYaw) {
        rpy = roll_pitch_yaw(q, rpy);
        angles = *rpy;
        is_clear = std::abs(angles[1]) < std::numbers::pi / 2 - clear;
      } else {
        tilted = tilt_and_torsion(q, tilted);
        angles = {tilted->value(0), tilted->value(1), tilted->value(2)};
        is_clear = std::abs(std::sin(angles[1])) > std::sin(clear);
      }
      if (!is_clear) return false;
      parameters_.push_back({x[0], x[1], x[2], angles[0], angles[1], angles[2]});
    }
    problem_.space = coordinate_space({kind});
    angles_ = angles_text(kind);
    return true;
  }

  [[nodiscard]] Rational since_begin(const PathRow& row) const {
    return row.time_s->rational() - rows_.front().time_s->rational();
  }

  MoveFit fitted() {
    std::vector<TimedRow> rows;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows.push_back({since_begin(rows_[i]).convert_to<double>(), parameters_[i]});
    }
    times_s_.clear();
    for (const TimedRow& row : rows) times_s_.push_back(row.time_s);
    if (std::ranges::adjacent_find(times_s_, std::ranges::greater_equal()) != times_s_.end()) {
      fail("got times that are nearer to each other than binary64 can tell, expected a move in time");
    }
    constexpr double kLeast_s = 1e-3, kMost_s = 1e7;
    if (!(times_s_.back() >= kLeast_s && times_s_.back() <= kMost_s)) {
      fail(fmt::format("got rows over {:.3g} s, expected a move of {} s to {} s", times_s_.back(), kLeast_s, kMost_s));
    }
    const RowRounding rounding = {rounding_.position_m, rounding_.angle_rad, rounding_.length_m};
    MoveFit fit = fit_move(problem_, rows, since_begin(rows_.back()), rounding);
    if (fit.worst.share <= 1) return fit;
    if (const auto end = moving_end(problem_, rows, rounding)) {
      fail((end->is_last ? rows_.back() : rows_.front()).line,
           fmt::format(
               "got a platform that {} at {:.3g} m/s and {:.3g} deg/s in the {} row, expected a move that {} at "
               "rest",
               end->is_last ? "still goes" : "goes", end->speed_m_s, end->angular_speed_rad_s * 180 / std::numbers::pi,
               end->is_last ? "last" : "first", end->is_last ? "ends" : "begins"));
    }
    const RowOffset& worst = fit.worst;
    complain_of_row(worst.row, {worst.position_m, worst.angle_rad, worst.length_m}, fit.path.segments());
  }

  [[noreturn]] void complain_of_row(std::size_t row, const RowDistance& off, std::size_t pieces) const {
    constexpr double kMore = 1.2;
    const bool would_do = kMore * off.position_m <= kMostRounding_m && kMore * off.angle_rad <= kMostRounding_rad &&
                          kMore * off.length_m <= kMostRounding_m;
    const auto enough = [&](double by, double stated, const std::string& text, const auto& above) {
      return by > stated ? above(kMore * by) : text;
    };
    const std::string rounding =
        rounding_.is_of_lengths()
            ? enough(off.length_m, rounding_.length_m, rounding_.length, millimetres_above)
            : enough(off.position_m, rounding_.position_m, rounding_.position, millimetres_above) + "," +
                  enough(off.angle_rad, rounding_.angle_rad, rounding_.angle, degrees_above);
    const std::string advice =
        fmt::format("The rounding that would do for this row: {}; or is the row, or one next to it, wrong?", rounding);
    fail(rows_[row].line,
         fmt::format(
             "got a row that is {} off the nearest smooth move (a spline in {}, no more than one for two rows), "
             "expected one within the stated rounding of {}. {}",
             rounding_.is_of_lengths() ? millimetres_above(off.length_m) + " in a cable's length"
                                       : millimetres_above(off.position_m) + " and " + degrees_above(off.angle_rad),
             plural(pieces, "piece"), rounding_.text(),
             would_do ? advice
                      : "No rounding will do: is the row, or one next to it, wrong, or have rows been left out, "
                        "such as those of a rest?"));
  }

  /// Proves how far each row is from the move.
  [[nodiscard]] FittedTable table(const MoveFit& fit) const {
    FittedTable table;
    table.rounding = rounding_;
    table.begin_s = rows_.front().time_s.value();
    const TimeLaw& law = fit.path.timing.value();
    table.duration_off_s =
        Rational(Rational(law.step_s) * law.pieces() - since_begin(rows_.back())).convert_to<double>();
    table.times_s = times_s_;
    table.angles = angles_;
    const RowDistances distances(problem_, fit.path);
    for (const PathRow& row : rows_) {
      const std::size_t i = table.lines.size();
      table.lines.push_back(row.line);
      const auto off = distances.at(since_begin(row), {row_form(), row.x, row.half_turns});
      if (!off) fail(row.line, "got a row beyond what can be enclosed, expected numbers of a usual size");
      const bool is_near = off->position_m <= rounding_.position_m && off->angle_rad <= rounding_.angle_rad &&
                           off->length_m <= rounding_.length_m;
      if (!is_near) complain_of_row(i, *off, fit.path.segments());
      const auto add = [&](FittedTable::Farthest& farthest, double by) {
        if (i == 0 || by > farthest.by) farthest = {by, row.line};
      };
      add(table.position_m, off->position_m);
      add(table.angle_rad, off->angle_rad);
      add(table.length_m, off->length_m);
    }
    return table;
  }

  /// Where the case says that drives run straight between rows: these are the rows, as far apart and as far off as
  /// they may be, or as far apart as those of tables that are written. By how much lengths that run so may change
  /// their speed at a row, in floating point [m/s].
  std::optional<double> state_rows() {
    if (!problem_.time->rows) return std::nullopt;
    Rational step = 0;
    double quickest_s = times_s_.back();  // the time between two rows
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      step = std::max(step, Rational(rows_[i].time_s->rational() - rows_[i - 1].time_s->rational()));
      quickest_s = std::min(quickest_s, times_s_[i] - times_s_[i - 1]);
    }
    std::array<Rational, kCables> off_m;
    const Model<double> model = make_model_without_ellipsoid<double>(problem_);
    for (std::size_t i = 0; i < kCables; ++i) {
      off_m[i] = Rational(rounding_.position_m) + Rational(rounding_.angle_rad) * Rational(model.p_PB[i].norm()) +
                 Rational(rounding_.length_m);
    }
    const Rational usual = parse_rational(problem_.time->rows->step_s);
    const Rational rounded = step + parse_rational(kRowRounding_s);
    problem_.time->rows = rows_between(*problem_.time, std::max(usual, rounded), off_m);
    const TimeLimits limits = make_time_limits(problem_);
    double jump_m_s = 0;
    for (std::size_t i = 0; i < kCables; ++i) {
      jump_m_s = std::max(jump_m_s, limits.winch_acceleration[i] * step.convert_to<double>() +
                                        4 * off_m[i].convert_to<double>() / quickest_s);
    }
    return jump_m_s;
  }

  [[nodiscard]] RowPose::Form row_form() const {
    switch (header_.form) {
      case PathForm::kQuaternion: return RowPose::Form::kQuaternion;
      case PathForm::kCableLengths: return RowPose::Form::kLengths;
      default: return RowPose::Form::kParameters;
    }
  }

  const Problem& with_query_;
  Problem problem_;
  std::string name_, bytes_;
  TableRounding rounding_;
  PathHeader header_;
  std::vector<PathRow> rows_;
  std::vector<std::vector<double>> poses_;       ///< px … qw of the rows, where they are quaternions or lengths
  std::vector<std::vector<double>> parameters_;  ///< of the rows in the space of the fit
  std::vector<double> times_s_;
  std::string summary_, column_hint_, angles_;
};

/// The line of the row that a knot is at or behind, for each of the knots.
FileLines knot_lines(const FittedTable& table, const TimeLaw& law) {
  FileLines lines;
  for (std::size_t k = 0; k <= law.pieces(); ++k) lines.add(table.lines_at(law.step_s * static_cast<double>(k)).first);
  return lines;
}

}  // namespace

std::pair<std::size_t, std::size_t> FittedTable::lines_at(double time_s) const {
  const auto behind = static_cast<std::size_t>(std::ranges::lower_bound(times_s, time_s) - times_s.begin());
  if (behind == times_s.size()) return {lines.back(), lines.back()};
  if (behind == 0 || times_s[behind] == time_s) return {lines[behind], lines[behind]};
  return {lines[behind - 1], lines[behind]};
}

MoveSource read_move(const Problem& problem, const PathInput& input, const std::optional<TableRounding>& rounding) {
  if (input.text || !is_certificate_name(input.name)) {
    if (!rounding) {
      throw InputError(
          input.name +
              ": got a table and no rounding, expected how far its rows may be from the move that is fitted "
              "to them (--rounding 0.1mm,0.01deg, of cable lengths 0.1mm, or audit.rounding in the case): "
              "accelerations do not follow from digits",
          {input.name});
    }
    return TableReader(problem, input, *rounding).read();
  }
  if (rounding) {
    throw InputError(input.name + ": got a certificate and a rounding, expected no rounding: its path is exact",
                     {input.name});
  }
  const PathSource source(problem, input, std::nullopt, true);
  return {source.problem(), source.whole_path(), source.source(), source.description(), source.remarks(), std::nullopt};
}

std::string row_sentence(const FittedTable& table) {
  const std::string zero =
      table.begin_s.sign() == 0 ? "" : fmt::format(" The move's time 0 is {} s in the table.", table.begin_s.text());
  const std::string rows = plural(table.lines.size(), "row");
  const std::string within =
      table.rounding.is_of_lengths()
          ? fmt::format(
                "The cable lengths of all {} lie within {} of those of this move at their times (at most {}, "
                "line {}).",
                rows, table.rounding.length, millimetres_above(table.length_m.by), table.length_m.line)
          : fmt::format("All {} lie within {} of this move at their times (at most {}, line {}, and {}, line {}).",
                        rows, table.rounding.text(), millimetres_above(table.position_m.by), table.position_m.line,
                        degrees_above(table.angle_rad.by), table.angle_rad.line);
  if (table.jump_m_s) {
    return fmt::format(
        "{}{} The move is what is audited, and lengths that run straight from row to row of such a table; limits in "
        "time are those of the move. At a row these lengths may change their speed by up to {}/s at once: how far that "
        "accelerates the load is what the case's item 'acceleration' has to cover.",
        within, zero, millimetres_above(*table.jump_m_s));
  }
  return fmt::format(
      "{}{} The move is what is audited: neither the rows' last digits nor how a drive joins the rows are part of it.",
      within, zero);
}

namespace {

nlohmann::json rounding_json(const TableRounding& rounding) {
  if (rounding.is_of_lengths()) return {{"length", rounding.length}};
  return {{"position", rounding.position}, {"angle", rounding.angle}};
}

}  // namespace

nlohmann::json to_json(const FittedTable& table) {
  nlohmann::json json = {{"rows", table.lines.size()},
                         {"lines", {table.lines.front(), table.lines.back()}},
                         {"begin_s", table.begin_s.text()},
                         {"duration_off_s", table.duration_off_s},
                         {"rounding", rounding_json(table.rounding)}};
  if (table.rounding.is_of_lengths()) {
    json.update({{"length_m", table.length_m.by}, {"length_line", table.length_m.line}});
  } else {
    json.update({{"position_m", table.position_m.by},
                 {"position_line", table.position_m.line},
                 {"angle_rad", table.angle_rad.by},
                 {"angle_line", table.angle_rad.line}});
  }
  return json;
}

void require_timed(const AuditRequest& request, const Case& the_case, const std::string& option) {
  require_limits_in_time(the_case, option);
  if (request.law) {
    throw InputError(ErrorCode::kUse, fmt::format("{}: got a law between rows, too, expected none: a move is fitted to "
                                                  "the rows",
                                                  option));
  }
}

TimedAudit audit_move(const MoveSource& source, const Case& the_case, const TimedAuditOptions& options,
                      const std::stop_token& stop) {
  const auto begin = std::chrono::steady_clock::now();
  TimedAudit audit;
  const Decoration decoration = read_meshes(the_case.decoration);
  audit.certificate = prove_waypoints(source.problem, source.path, options.max_bits, stop);
  audit.prove_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  audit.interrupted = stop.stop_requested();
  if (audit.interrupted) return audit;
  Certificate& certificate = audit.certificate;
  certificate.source = source.origin;
  certificate.illustration = {{"kind", "audit"}};
  add_stated(certificate.illustration, the_case, decoration);
  if (source.table) {
    certificate.illustration["table"] = {{"rows", source.table->lines.size()},
                                         {"begin_s", source.table->begin_s.text()},
                                         {"rounding", rounding_json(source.table->rounding)}};
    certificate.illustration["lines"] = knot_lines(*source.table, *source.path.timing).to_json();
  }
  if (certificate.witness) {
    const PathPoint& at = certificate.witness->violation.at;
    audit.witness_s = MoveSampler::time_of(*source.path.timing, at.index + (at.on_segment ? at.s.approx() : 0));
  }
  audit.text = certificate_text(certificate, options.key);
  audit.checked = recheck(audit.text, options.max_seconds, stop, meshes_of(the_case.problem));
  require_confirmed(audit.checked);
  audit.interrupted = stop.stop_requested();
  return audit;
}

}  // namespace taut
