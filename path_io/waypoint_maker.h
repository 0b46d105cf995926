// SPDX-License-Identifier: GPL-3.0-or-later
// Turns rows of a path file into waypoints of an interpolation law (segment.h), one at a time.
//
// If the law's coordinates are the file's, the waypoints are the file's numbers, bit for bit. Otherwise they are
// computed in floating point (pose_conversion.h), and is_converted() says so.
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "kinematics/pose_conversion.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/segment.h"
#include "path_io/path_file.h"

namespace taut {

/// The law used for such a file if the user names none.
[[nodiscard]] Interpolation usual_law(const PathHeader& header);

class WaypointMaker {
 public:
  /// @throws InputError, naming `file`, if such rows can't be joined by this law, or a start pose is missing.
  WaypointMaker(const Problem& problem, const PathHeader& header, Interpolation law, const std::string& file);

  /// The problem that is audited. It has no query, and its space is that of all poses unless the rows are the case's
  /// parameters and the law joins parameters.
  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] Interpolation law() const { return law_; }
  [[nodiscard]] bool is_converted() const { return is_converted_; }

  /// The waypoint of the next row, valid until the next call. `start` is PathFile::start(), which only the first row
  /// uses.
  /// @throws InputError if the law joins lengths and a cable has the length 0 at the pose.
  [[nodiscard]] const Waypoint& next(const PathRow& row, const std::vector<double>& start);

  /// For cable lengths: the first line for which no pose was found near that of the line before. From there on
  /// waypoints keep the last reference pose found, and no proof will succeed.
  [[nodiscard]] std::optional<std::size_t> lost_line() const { return lost_line_; }
  /// For cable lengths: the largest difference between the start pose's lengths and the first row's [m].
  [[nodiscard]] double start_error_m() const { return start_error_m_; }
  /// For cable lengths: two cables (from 0) such that the start pose has the first row's lengths to within `most_m` if
  /// these two are exchanged; nothing where there are no such two.
  [[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> exchanged_lengths(double most_m) const;

 private:
  [[nodiscard]] RigidPose pose_of(PathForm form, const std::vector<double>& x,
                                  const std::vector<int>& half_turns) const;
  void find_reference(const PathRow& row, const std::vector<double>& start);

  Problem problem_;
  PathHeader header_;
  Interpolation law_;
  std::string file_;
  bool is_converted_ = false;
  PoseSampler sampler_;  ///< of the case's space
  std::optional<RigidPose> query_start_;
  std::optional<RigidPose> pose_;
  std::optional<TiltAndTorsion> angles_;
  Waypoint waypoint_;
  std::optional<std::size_t> lost_line_;
  std::array<double, kCables> start_lengths_{};  ///< of the start pose [m]
  std::array<double, kCables> first_lengths_{};  ///< of the first row [m]
  double start_error_m_ = 0;
};

}  // namespace taut
