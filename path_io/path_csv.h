// SPDX-License-Identifier: GPL-3.0-or-later
// path.csv: the waypoints of a path, bit for bit, so that `taut audit` reads back exactly what was proved.
#pragma once

#include <string>
#include <string_view>

#include "kinematics/pose_sampler.h"
#include "kinematics/segment.h"

namespace taut {

/// Lines of path.csv. For a law in the parameters, the columns are waypoint (or control_point), x.NAME, half_turns.NAME
/// with λ = x + π half_turns, t if there are times, and the pose there, rounded (on the constraints, if there are any).
/// For a law of poses it is a table as described in docs/audits.md. The last line is certificate_line() of path_file.h.
class PathCsv {
 public:
  PathCsv(const Problem& problem, Interpolation law, bool has_times);
  [[nodiscard]] std::string header() const;
  /// @param time  a decimal [s], if there are times.
  [[nodiscard]] std::string row(std::size_t number, const Waypoint& waypoint, std::string_view time = {}) const;

 private:
  const Problem& problem_;
  Interpolation law_;
  bool has_times_;
  PoseSampler sampler_;
};

/// The whole file, with the path's times. Its last line names the certificate by this SHA-256.
[[nodiscard]] std::string path_csv(const Problem& problem, const Path& path, std::string_view certificate_sha256);

}  // namespace taut
