// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/prove.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "certificate/elaborate.h"
#include "certify/path_proof.h"
#include "kinematics/pose_conversion.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/time_law.h"
#include "problem/decimal.h"

namespace taut {
namespace {

constexpr long kLeastBits = 128;
constexpr long kMostBits = 1 << 20;

[[noreturn]] void fail(const std::string& field, const std::string& message) {
  throw InputError(fmt::format("{}: {}", field, message), {"", 0, field});
}

void require_finite(const std::vector<double>& x, std::size_t count, const std::string& where) {
  if (x.size() != count) fail(where + ".x", fmt::format("got {} numbers, expected {}", x.size(), count));
  for (std::size_t j = 0; j < count; ++j) {
    if (std::isfinite(x[j])) continue;
    fail(fmt::format("{}.x[{}]", where, j), fmt::format("got {}, expected a finite number", x[j]));
  }
}

void require_half_turns(const std::vector<int>& half_turns, const SpaceText& space, const std::string& where) {
  if (half_turns.size() != space.parameters.size()) {
    fail(where + ".half_turns", fmt::format("got {} numbers, expected {}", half_turns.size(), space.parameters.size()));
  }
  for (std::size_t j = 0; j < half_turns.size(); ++j) {
    const int most = space.parameters[j].kind == ParameterKind::kPeriodic ? kMostHalfTurns : 0;
    if (std::abs(half_turns[j]) <= most) continue;
    fail(fmt::format("{}.half_turns[{}]", where, j),
         fmt::format("got {}, expected {}", half_turns[j],
                     most == 0 ? "0, of a parameter that is not periodic" : fmt::format("{} at most", most)));
  }
}

void require_fit(const Waypoint& waypoint, Interpolation law, const SpaceText& space, const std::string& where) {
  require_finite(numbers(waypoint), number_count(law, space.parameters.size()), where);
  if (!has_poses(law)) {
    require_half_turns(waypoint.parameters().half_turns, space, where);
    return;
  }
  constexpr double kMostOff = 1e-2;
  const double norm = quaternion_length(waypoint.pose());
  if (!(std::abs(norm - 1) <= kMostOff)) {
    fail(where + ".x", fmt::format("got a quaternion of length {:.6g}, expected 1 within {}", norm, kMostOff));
  }
  if (law == Interpolation::kCableLengths && !have_lengths(waypoint)) {
    fail(where + ".x", "got a length that is not above 0");
  }
}

void require_times(const Path& path) {
  if (path.times.empty()) return;
  if (path.times.size() != path.waypoints.size()) {
    fail("times", fmt::format("got {}, expected one a waypoint, or none", path.times.size()));
  }
  std::optional<Decimal> last;
  for (std::size_t k = 0; k < path.times.size(); ++k) {
    const Decimal time = Decimal::parse(path.times[k]);
    if (last && !(time > *last)) fail(fmt::format("times[{}]", k), "got a time that is not later than the one before");
    last = time;
  }
}

void require_on_constraints(const Path& path, const Problem& problem) {
  if (problem.space.constraints.empty()) return;
  const PoseSampler sampler(problem);
  for (std::size_t k = 0; k <= path.segments(); ++k) {
    const bool is_last = k == path.segments();
    const double off = sampler.distance_to_constraints(path.segment(is_last ? k - 1 : k), is_last);
    if (off > kWaypointTolerance) {
      fail(fmt::format("waypoints[{}]", k),
           fmt::format("got a pose {:.3g} of the platform's size, or [rad], off the constraints, expected at most {}",
                       off, kWaypointTolerance));
    }
  }
}

/// Replaces poses that do not have the lengths beside them by the ones next to them that have: around a rough pose no
/// motion is found. The lengths, which are what is commanded, stay.
void refine_references(Path& path, const Model<double>& model) {
  constexpr double kNearEnough = 1e-6;  // of the platform's size: proofs bear a hundred times as much
  std::optional<Eigen::Quaterniond> before;
  for (Waypoint& waypoint : path.waypoints) {
    const std::array<double, kCables> lengths = waypoint.lengths_m();
    const RigidPose pose = rigid_pose(waypoint.pose());
    double off = 0;
    const std::array<double, kCables> has = cable_lengths(model, pose);
    for (std::size_t i = 0; i < kCables; ++i) off = std::max(off, std::abs(has[i] - lengths[i]));
    if (off > kNearEnough * model.characteristic_length) {
      if (auto found = pose_of_lengths(model, lengths, pose)) {
        if (before && found->q.dot(*before) < 0) found->q.coeffs() = -found->q.coeffs();  // the shorter way
        waypoint = LengthsPoint{pose_numbers(*found), lengths};
      }
    }
    before = rigid_pose(waypoint.pose()).q;
  }
}

/// Checks waypoints and times against the space; a single waypoint becomes a segment that stays there.
void require_proper(Path& path, const SpaceText& space) {
  const Interpolation law = path.interpolation;
  if (path.waypoints.size() == 1 && law != Interpolation::kCubicBSpline && path.times.empty()) {
    path.waypoints.push_back(path.waypoints.front());
  }
  if (path.segments() == 0) {
    fail("waypoints", fmt::format("got {}, expected at least {}", path.waypoints.size(), control_points(law)));
  }
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    require_fit(path.waypoints[k], law, space, fmt::format("waypoints[{}]", k));
  }
  require_times(path);
}

/// Makes the tubes in which implied motions are sought.
void add_tubes(Path& path, const Prover& prover, const std::stop_token& stop) {
  const std::size_t segments = path.segments();
  path.tubes.assign(prover.problem().space.constraints.empty() ? 0 : segments, 0);
  path.pose_tubes.assign(path.interpolation == Interpolation::kCableLengths ? segments : 0, {});
  path.inner_poses.assign(path.pose_tubes.size(), {});
  tbb::parallel_for(std::size_t{0}, segments, [&](std::size_t k) {
    if (stop.stop_requested()) return;
    Segment prepared = prover.prepared(path.segment(k));
    if (!path.tubes.empty()) path.tubes[k] = prepared.tube;
    if (path.pose_tubes.empty()) return;
    path.pose_tubes[k] = prepared.pose_tube;
    path.inner_poses[k] = std::move(prepared.inner_poses);
  });
}

}  // namespace

Certificate prove_waypoints(const Problem& problem, Path path, long max_bits, const std::stop_token& stop) {
  const Interpolation law = path.interpolation;
  if (max_bits < kLeastBits || max_bits > kMostBits) {
    fail("max_bits", fmt::format("got {}, expected {} to {}", max_bits, kLeastBits, kMostBits));
  }
  require_proper(path, problem.space);

  if (path.timing) {
    if (!problem.time) fail("timing", "got a law in time, expected a problem that states limits in time");
    if (const std::string text = complaint(path); !text.empty()) fail("timing", text);
  }
  Problem audited = path.timing ? problem : without_time(problem);
  audited.query.clear();
  if (has_poses(law)) audited.space = coordinate_space();
  if (!has_poses(law) && !problem.space.constraints.empty()) {
    const PoseSampler sampler(problem);
    for (Waypoint& waypoint : path.waypoints) waypoint.parameters().normals = sampler.constraints()->normals(waypoint);
  }
  if (law == Interpolation::kCableLengths) refine_references(path, PoseSampler(problem).model());
  require_on_constraints(path, audited);
  ProofOptions options;
  options.max_bits = max_bits;
  const Prover prover(audited, options);
  add_tubes(path, prover, stop);
  const PathProof proof = prove_path(prover, path, {}, stop);
  return elaborate(audited, std::move(path), proof);
}

}  // namespace taut
