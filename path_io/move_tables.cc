// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/move_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "kinematics/move_sampler.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/time_limits.h"

namespace taut {
namespace {

constexpr std::size_t kLeastTension = 1 + 3 * kCables;  ///< the column; the greatest ones follow the six least ones

/// The times of the rows.
std::vector<double> times(const TimeLaw& law, double rate_Hz) {
  const double end = law.duration_s();
  if (!(end * rate_Hz < kMostMoveRows)) {
    throw InputError(ErrorCode::kCase,
                     fmt::format("time.rate: got {} Hz, at which tables of a move of {:.6g} s take more than {} rows, "
                                 "expected a lower rate",
                                 rate_Hz, end, kMostMoveRows));
  }
  std::vector<double> result;
  constexpr double kLeast_s = 5e-10;  // no row so near the last one; rows of the proof may be 1e-9 s farther apart
  for (double k = 0; k / rate_Hz + kLeast_s < end; ++k) result.push_back(k / rate_Hz);
  result.push_back(end);
  return result;
}

/// Three digits, rounded up. @pre x > 0
std::string rounded_up(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2);
  return fmt::format("{:.3g}", std::ceil(x / unit * (1 - 1e-12)) * unit);
}

/// Whether lengths that run straight between rows at this rate are among those that the certificate is about.
bool are_proved(const Problem& problem, const TimeLimits& limits, double rate_Hz) {
  const auto& rows = problem.time->rows;
  if (!rows) return false;
  constexpr double kRounding_m = 0.9e-9;  // kRowRounding_m, and what is lost here
  for (std::size_t i = 0; i < kCables; ++i) {
    const double off = limits.winch_acceleration[i] / (8 * rate_Hz * rate_Hz) + kRounding_m;
    if (!(off <= ScalarTraits<double>::from_decimal(rows->error_m[i]))) return false;
  }
  return true;
}

/// What is true between two rows.
std::string between_rows(const Problem& problem, double rate_Hz) {
  const TimeLimits limits = make_time_limits(problem);
  const auto error_mm = [&](std::size_t i) {
    constexpr double kMillimetres = 1000;
    return rounded_up(kMillimetres * limits.winch_acceleration[i] / (8 * rate_Hz * rate_Hz));
  };
  std::string text;
  const auto& most = limits.winch_acceleration;
  const bool are_equal = std::ranges::all_of(most, [&](double x) { return x == most[0]; });
  const std::string how =
      "# Between two rows, at most h apart, a length that runs straight from one to the other is within h^2/8 times "
      "the proved\n# limit of that winch's acceleration of the proved length: ";
  if (are_equal && std::isfinite(most[0])) {
    text = fmt::format("{}{} mm of each cable, for {:.6g} m/s^2.\n", how, error_mm(0), most[0]);
  } else if (std::ranges::any_of(most, [](double x) { return std::isfinite(x); })) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < kCables; ++i) {
      parts.push_back(std::isfinite(most[i])
                          ? fmt::format("{} mm of cable {}, for {:.6g} m/s^2", error_mm(i), i + 1, most[i])
                          : fmt::format("nothing is known of cable {}, whose acceleration has no limit", i + 1));
    }
    text = fmt::format("{}{}.\n", how, fmt::join(parts, "; "));
  } else {
    text =
        "# The case limits no winch's acceleration, so that nothing is known of lengths that run straight from row to "
        "row.\n";
  }
  if (are_proved(problem, limits, rate_Hz)) {
    return text +
           "# What is proved of tensions, lengths, clearances and singular poses holds for lengths that are so far "
           "off. Limits in time\n# are kept by the move itself.\n";
  }
  return text +
         "# How drives join the rows is no part of the certificate, unless a tolerance of cable lengths "
         "(tolerances.cable_length)\n# covers it: the certificate states no rows, or such as are off by less "
         "(time.between_rows).\n";
}

/// What a table's head says of it and of its move.
struct Head {
  std::string name;  ///< of the case
  std::string legs;  ///< lines that say which there are
  double rate_Hz = 0;
  std::string_view sha256;  ///< of the certificate
};

std::string head_text(const Head& head, const MoveRows& rows, std::string_view what, std::string_view units,
                      std::string_view more) {
  return fmt::format(
      "{}{}. Case: {}\n"
      "# Rows: {}, every {:.6g} s ({:.6g} Hz), the last one where the move ends, at {} s.\n"
      "{}"
      "# Units: {}\n"
      "# What is proved is the move: the path by its law through the waypoints of {}, and the time law in the "
      "certificate.\n# These rows are on it but for rounding.\n"
      "{}"
      "# Certificate of the move: certificate.json, SHA-256 {}\n",
      kMoveTableBegin, what, sanitize(head.name), rows.poses.size(), 1 / head.rate_Hz, head.rate_Hz,
      rows.poses.back()[0], head.legs, units, head.legs.empty() ? "path.csv" : "the path.csv in each leg's folder",
      more, head.sha256);
}

MoveTables tables_of(const Head& head, const Problem& problem, const MoveRows& rows) {
  MoveTables tables;
  tables.winches_csv =
      head_text(
          head, rows, ", for its winches",
          "lengths l are in metres, from anchor to anchor; v and a are their first two derivatives by time; fmin and "
          "fmax\n"
          "# are the least and the greatest tension that the proof allows each cable from this row to the next, in "
          "newtons, over all\n# loads and deviations.",
          between_rows(problem, head.rate_Hz)) +
      fmt::format("{}\n", fmt::join(kWinchColumns, ","));
  const std::string pose_head =
      head_text(head, rows, ", as poses",
                "metres and seconds; the quaternion (qx, qy, qz, qw) turns the platform's axes into the base's.", "");
  tables.poses_csv = pose_head + fmt::format("{}\n", fmt::join(kPoseColumns, ","));
  tables.poses_tum = pose_head + "# t px py pz qx qy qz qw\n";
  for (const auto& row : rows.winches) {
    fmt::format_to(std::back_inserter(tables.winches_csv), "{}\n", fmt::join(row, ","));
  }
  for (const auto& row : rows.poses) {
    fmt::format_to(std::back_inserter(tables.poses_csv), "{}\n", fmt::join(row, ","));
    fmt::format_to(std::back_inserter(tables.poses_tum), "{}\n", fmt::join(row, " "));
  }
  return tables;
}

/// To each row, the least and the greatest tension of all pieces from its place to that of the next row.
void add_tensions(std::span<const double> places, std::span<const TensionPiece> pieces, MoveRows& rows) {
  constexpr double kRounding = 1e-12;  // of places, and as a share of them
  std::size_t first = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const double next = places[std::min(n + 1, places.size() - 1)];
    const double from = places[n] - kRounding * (1 + places[n]), to = next + kRounding * (1 + next);
    while (first + 1 < pieces.size() && pieces[first].upper < from) ++first;
    auto* const least = &rows.winches[n][kLeastTension];
    auto* const most = least + kCables;
    for (std::size_t i = 0; i < kCables; ++i) {
      least[i] = HUGE_VAL;
      most[i] = -HUGE_VAL;
    }
    for (std::size_t k = first; k < pieces.size() && (k == first || pieces[k].lower <= to); ++k) {
      for (std::size_t i = 0; i < kCables; ++i) {
        least[i] = std::min(least[i], pieces[k].tension[i][0]);
        most[i] = std::max(most[i], pieces[k].tension[i][1]);
      }
    }
  }
}

/// Appends the rows of a leg that begins where the rows end.
void append(MoveRows next, MoveRows& rows) {
  const bool is_first = rows.poses.empty();
  const double start = is_first ? 0 : rows.poses.back()[0];
  double sign = 1;
  if (!is_first) {  // q and -q are one orientation
    double product = 0;
    for (std::size_t k = 4; k < kPoseColumns.size(); ++k) product += rows.poses.back()[k] * next.poses.front()[k];
    sign = product < 0 ? -1 : 1;
  }
  for (std::size_t k = 0; k < kCables && !is_first; ++k) {  // in the row where they meet, with either load
    auto& least = rows.winches.back()[kLeastTension + k];
    auto& most = rows.winches.back()[kLeastTension + kCables + k];
    least = std::min(least, next.winches.front()[kLeastTension + k]);
    most = std::max(most, next.winches.front()[kLeastTension + kCables + k]);
  }
  for (std::size_t n = is_first ? 0 : 1; n < next.poses.size(); ++n) {
    next.winches[n][0] += start;
    next.poses[n][0] += start;
    for (std::size_t k = 4; k < kPoseColumns.size(); ++k) next.poses[n][k] *= sign;
    rows.winches.push_back(next.winches[n]);
    rows.poses.push_back(next.poses[n]);
  }
}

}  // namespace

MoveRows move_rows(const Problem& problem, const Path& path, std::span<const TensionPiece> tensions, double rate_Hz) {
  if (!is_in_time(problem, path)) throw std::logic_error("a table with times of a path without");
  const MoveSampler moves(problem);
  const PoseSampler poses(problem);
  MoveRows rows;
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  std::vector<double> places;
  for (const double t : times(path.timing.value(), rate_Hz)) {
    const MoveSample now = moves.at_time(path, t);
    RigidPose pose = poses.rigid_pose(path.segment(now.segment), now.s);
    const std::array<double, kCables> lengths = cable_lengths(poses.model(), pose);
    places.push_back(static_cast<double>(now.segment) + now.s);
    auto& winches = rows.winches.emplace_back();
    winches[0] = t;
    auto into = winches.begin() + 1;
    for (const auto* six : {&lengths, &now.winches.speed, &now.winches.acceleration}) {
      into = std::ranges::copy(*six, into).out;
    }
    if (pose.q.dot(last) < 0) pose.q.coeffs() = -pose.q.coeffs();  // the same orientation, without a jump
    last = pose.q;
    rows.poses.push_back({t, pose.p(0), pose.p(1), pose.p(2), pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()});
  }
  add_tensions(places, tensions, rows);
  return rows;
}

MoveTables move_tables(const Problem& problem, const Path& path, std::span<const TensionPiece> tensions, double rate_Hz,
                       std::string_view certificate_sha256) {
  return tables_of({problem.name, "", rate_Hz, certificate_sha256}, problem,
                   move_rows(problem, path, tensions, rate_Hz));
}

MoveRows move_rows(std::span<const MoveLeg> legs, double rate_Hz) {
  MoveRows rows;
  for (const MoveLeg& leg : legs) append(move_rows(leg.problem, leg.path, leg.tensions, rate_Hz), rows);
  return rows;
}

MoveTables move_tables(std::span<const MoveLeg> legs, const std::string& name, double rate_Hz,
                       std::string_view certificate_sha256) {
  MoveRows rows;
  std::string text = fmt::format(
      "# Legs: {}, each of which begins where the one before it ends, at rest, with a load "
      "of its own. Times go on without\n# a pause: taking a load and putting it down is no "
      "part of the move, and takes its time.\n",
      legs.size());
  for (const MoveLeg& leg : legs) {
    const double start = rows.poses.empty() ? 0 : rows.poses.back()[0];
    append(move_rows(leg.problem, leg.path, leg.tensions, rate_Hz), rows);
    text += fmt::format("# leg {}: from {} s to {} s\n", sanitize(leg.name), start, rows.poses.back()[0]);
  }
  return tables_of({name, text, rate_Hz, certificate_sha256}, legs.front().problem, rows);
}

}  // namespace taut
