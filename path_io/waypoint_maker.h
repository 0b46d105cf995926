// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a path file as waypoints of an interpolation law (segment.h), one at a time.
//
// Where the law's coordinates are the file's, the waypoints are the file's numbers, bit for bit. Otherwise they are computed in
// floating point (pose_conversion.h): is_converted().
#pragma once

#include <optional>

#include "kinematics/pose_conversion.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/segment.h"
#include "path_io/path_file.h"

namespace taut {

/// The law that rows of such a file have if nobody says another.
[[nodiscard]] Interpolation usual_law(const PathHeader& header);

class WaypointMaker {
 public:
  /// @throws InputError, naming `file`, where such rows can't be joined by that law, or a start pose is missing.
  WaypointMaker(const Problem& problem, const PathHeader& header, Interpolation law, const std::string& file);

  /// The problem that is audited: without a query, and in the space of all poses unless the rows are parameters of the case's.
  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] Interpolation law() const { return law_; }
  [[nodiscard]] bool is_converted() const { return is_converted_; }

  /// The next row's. `start` is PathFile::start(), of which the first row needs to know. The result is valid until the
  /// next call. @throws InputError where the pose gives a cable the length 0 and the law joins lengths.
  [[nodiscard]] const Waypoint& next(const PathRow& row, const std::vector<double>& start);

  /// Of cable lengths: the first line for which no pose was found next to that of the line before. Its waypoint's reference stays
  /// where it was, and no proof will succeed.
  [[nodiscard]] std::optional<std::size_t> lost_line() const { return lost_line_; }
  /// Of cable lengths: how much the start pose's lengths differ from the first row's, at most [m].
  [[nodiscard]] double start_error_m() const { return start_error_m_; }

 private:
  [[nodiscard]] RigidPose pose_of(PathForm form, const std::vector<double>& x,
                                  const std::vector<int>& half_turns) const;
  void find_reference(const PathRow& row, const std::vector<double>& start);

  Problem problem_;
  PathHeader header_;
  Interpolation law_;
  std::string file_;
  bool is_converted_ = false;
  PoseSampler sampler_;  ///< of the case
  std::optional<RigidPose> query_start_;
  std::optional<RigidPose> pose_;
  std::optional<TiltAndTorsion> angles_;
  Waypoint waypoint_;
  std::optional<std::size_t> lost_line_;
  double start_error_m_ = 0;
};

}  // namespace taut
