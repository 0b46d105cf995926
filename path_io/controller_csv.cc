// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/controller_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <vector>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "kinematics/pose_sampler.h"
#include "path_io/path_summary.h"
#include "problem/decimal.h"
#include "problem/units.h"

namespace taut {
namespace {

constexpr std::size_t kMostRows = 200'000;

/// A row before it is text.
struct ControllerRow {
  RigidPose pose;
  std::array<double, kCables> lengths{};
};

/// Walks along a path and samples it.
class PathWalk {
 public:
  PathWalk(const Problem& problem, const Path& path, const ControllerStep& step)
      : problem_(problem), path_(path), step_(step), sampler_(problem) {}

  /// The rows of segment k at s = 0, 1/n, …, 1; segments are asked for in their order.
  [[nodiscard]] std::vector<ControllerRow> rows(std::size_t k) {
    // Travel is measured along several chords from row to row, as a motion may turn or lead back between two rows.
    constexpr std::size_t kChords = 4;
    const Segment segment = path_.segment(k);
    for (std::size_t pieces = first_guess(segment);;) {
      if (pieces > kMostRows) complain();
      const std::vector<ControllerRow> fine = sample(segment, pieces * kChords);
      double most = 0;
      for (std::size_t i = 0; i < pieces; ++i) {
        double travel = 0;
        for (std::size_t j = i * kChords; j < (i + 1) * kChords; ++j) {
          travel += distance(fine[j].pose, fine[j + 1].pose);
        }
        most = std::max(most, travel);
      }
      if (most <= step_.metres) {
        std::vector<ControllerRow> result;
        for (std::size_t i = 0; i <= pieces; ++i) result.push_back(fine[i * kChords]);
        last_ = result.back().pose;
        return result;
      }
      const double wanted = std::ceil(static_cast<double>(pieces) * most / step_.metres);
      if (!(wanted <= kMostRows)) complain();
      pieces = std::max(pieces + 1, static_cast<std::size_t>(wanted));
    }
  }

  [[noreturn]] void complain() const {
    throw InputError(ErrorCode::kUse, fmt::format("--step: got {}, at which controller.csv takes more than {} rows, "
                                                  "expected a longer step",
                                                  step_.text, kMostRows));
  }

 private:
  /// Pieces that are short enough for nothing to happen unseen: of a turn, a quarter at most.
  [[nodiscard]] std::size_t first_guess(const Segment& segment) const {
    if (has_poses(segment.law)) return 1 + 4 * segment.inner_poses.size();
    constexpr double kQuarterTurn = 1.5707963267948966;
    double most = 0;
    for (const Waypoint* control : segment.controls()) {
      const ParameterPoint &here = control->parameters(), &first = segment.control[0]->parameters();
      for (std::size_t j = 0; j < here.x.size(); ++j) {
        if (problem_.space.parameters[j].kind != ParameterKind::kPeriodic) continue;
        const double halves = 2.0 * (here.half_turns[j] - first.half_turns[j]);
        most = std::max(most, std::abs((here.x[j] - first.x[j]) / kQuarterTurn + halves));
      }
    }
    return static_cast<std::size_t>(std::min(1 + most, 2.0 * kMostRows));
  }

  [[nodiscard]] std::vector<ControllerRow> sample(const Segment& segment, std::size_t pieces) const {
    std::vector<ControllerRow> result;
    std::optional<RigidPose> last = last_;
    for (std::size_t i = 0; i <= pieces; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(pieces);
      ControllerRow row = at(segment, s, last);
      if (last && row.pose.q.dot(last->q) < 0) row.pose.q.coeffs() = -row.pose.q.coeffs();
      last = row.pose;
      result.push_back(std::move(row));
    }
    return result;
  }

  [[nodiscard]] ControllerRow at(const Segment& segment, double s, const std::optional<RigidPose>& last) const {
    const Model<double>& model = sampler_.model();
    if (segment.law != Interpolation::kCableLengths) {
      const RigidPose pose = sampler_.rigid_pose(segment, s);
      return {pose, cable_lengths(model, pose)};
    }
    ControllerRow row;
    row.lengths = lengths_at(segment, s);
    const auto pose = pose_of_lengths(model, row.lengths, last.value_or(pose_between(segment, 0)));
    if (!pose) throw std::runtime_error("controller.csv: no pose was found for the cable lengths of a proved path");
    row.pose = *pose;
    return row;
  }

  /// The way of whichever of the platform's origin and the cables' ends on it moves furthest [m].
  [[nodiscard]] double distance(const RigidPose& a, const RigidPose& b) const {
    double most = (b.p - a.p).norm();
    for (const Vector3<double>& p_PB : sampler_.model().p_PB) {
      most = std::max(most, (b.p + b.q * p_PB - a.p - a.q * p_PB).norm());
    }
    return most;
  }

  const Problem& problem_;
  const Path& path_;
  const ControllerStep& step_;
  PoseSampler sampler_;
  std::optional<RigidPose> last_;  ///< of the segment before
};

double time_at(const Path& path, std::size_t k, double s) {
  const double from = ScalarTraits<double>::from_decimal(path.times[k]);
  const double to = ScalarTraits<double>::from_decimal(path.times[k + 1]);
  return from + s * (to - from);
}

std::string head(const Problem& problem, const Path& path, const ControllerStep& step, std::string_view sha256) {
  return fmt::format(
      "{} Case: {}\n"
      "# Law of the path: {}.\n"
      "# Step: {}. From row to row neither the platform's origin nor a cable's end on it travels further.\n"
      "# Units: s is the share of the segment that is behind the platform; lengths are in metres, from anchor to "
      "anchor;\n"
      "# the quaternion (qx, qy, qz, qw) turns the platform's axes into the base's.\n"
      "# What is proved is the path by its law through the waypoints of path.csv. These rows are on it but for "
      "rounding.\n"
      "# What a controller does between them is another path. For winches that run from row to row at constant rates,\n"
      "# 'taut audit CASE controller.csv' examines it.\n"
      "# Certificate of the path: certificate.json, SHA-256 {}\n",
      kControllerFileBegin, sanitize(problem.name), law_sentence(path.interpolation, problem), step.text, sha256);
}

}  // namespace

ControllerStep read_controller_step(const std::string& text, const std::string& option) {
  const auto fail = [&]() -> InputError {
    return {ErrorCode::kUse,
            fmt::format("{}: got '{}', expected a length with its unit from 1 nm to 1000 km, such as 10mm (units: {})",
                        option, excerpt(text), unit_names(Dimension::kLength))};
  };
  const std::size_t end = text.find_first_not_of("+-.0123456789");
  if (end == std::string::npos || end == 0) throw fail();
  const std::size_t unit_begin = text.find_first_not_of(' ', end);
  const auto unit = find_unit(unit_begin == std::string::npos ? "" : text.substr(unit_begin));
  if (!unit || unit->dimension != Dimension::kLength) throw fail();
  constexpr double kLeast = 1e-9;
  constexpr double kMost = 1e6;
  try {
    const Decimal exact = Decimal::parse(text.substr(0, end)) * unit->factor;
    const double metres = ScalarTraits<double>::from_decimal(exact.text());
    if (metres >= kLeast && metres <= kMost) return {metres, text.substr(0, end) + " " + unit->name};
  } catch (const InputError&) {
    throw fail();
  }
  throw fail();
}

std::string controller_csv(const Problem& problem, const Path& path, const ControllerStep& step,
                           std::string_view certificate_sha256) {
  std::string text = head(problem, path, step, certificate_sha256);
  const bool has_times = !path.times.empty() && path.interpolation != Interpolation::kCubicBSpline;
  text += fmt::format("segment,s,{}px[m],py[m],pz[m],qx,qy,qz,qw,l1[m],l2[m],l3[m],l4[m],l5[m],l6[m]\n",
                      has_times ? "t[s]," : "");
  PathWalk walk(problem, path, step);
  std::size_t written = 0;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    const std::vector<ControllerRow> rows = walk.rows(k);
    const std::size_t pieces = rows.size() - 1;
    const bool is_last = k + 1 == path.segments();
    for (std::size_t i = 0; i < rows.size() - (is_last ? 0 : 1); ++i) {
      if (++written > kMostRows) walk.complain();
      const double s = static_cast<double>(i) / static_cast<double>(pieces);
      const auto& [p, q] = rows[i].pose;
      const auto out = std::back_inserter(text);
      fmt::format_to(out, "{},{},", k, s);
      if (has_times) fmt::format_to(out, "{},", time_at(path, k, s));
      fmt::format_to(out, "{},{},{},{},{},{},{},{}\n", p(0), p(1), p(2), q.x(), q.y(), q.z(), q.w(),
                     fmt::join(rows[i].lengths, ","));
    }
  }
  return text;
}

}  // namespace taut
