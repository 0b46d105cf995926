// SPDX-License-Identifier: GPL-3.0-or-later
// path.csv: the waypoints that were proved, bit for bit, so that `taut audit` reads them back.
#pragma once

#include <string>
#include <string_view>

#include "kinematics/pose_sampler.h"
#include "kinematics/segment.h"

namespace taut {

/// Lines of path.csv. Under a law through parameters: waypoint (or control_point), x.NAME, half_turns.NAME with
/// λ = x + π half_turns, t if there are times, and the pose there (rounded; on the constraints, where there are some). Under a
/// law of poses a table as docs/audits.md has it. The last line is certificate_line() of path_file.h.
class PathCsv {
 public:
  PathCsv(const Problem& problem, Interpolation law, bool has_times);
  [[nodiscard]] std::string header() const;
  /// `time`: a decimal [s], if there are times.
  [[nodiscard]] std::string row(std::size_t number, const Waypoint& waypoint, std::string_view time = {}) const;

 private:
  const Problem& problem_;
  Interpolation law_;
  bool has_times_;
  PoseSampler sampler_;
};

/// All of it, with the path's times; its last line names the certificate of these bytes' SHA-256.
[[nodiscard]] std::string path_csv(const Problem& problem, const Path& path, std::string_view certificate_sha256);

}  // namespace taut
