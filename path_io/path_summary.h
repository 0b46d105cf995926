// SPDX-License-Identifier: GPL-3.0-or-later
// What was read from a path file, at a glance: so that a wrong unit or a wrong column is seen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/pose_sampler.h"
#include "path_io/path_file.h"

namespace taut {

/// Gathers rows, in constant memory. Floating point: for people, not for proofs.
class PathSummary {
 public:
  /// @throws InputError if the problem has no model in doubles.
  PathSummary(const Problem& problem, PathHeader header);

  void add(const PathRow& row);

  [[nodiscard]] const PathHeader& header() const { return header_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] const PathRow& first() const { return first_; }
  [[nodiscard]] const PathRow& last() const { return last_; }
  /// Least and largest value of each coordinate, half turns included [SI].
  [[nodiscard]] const std::vector<double>& lower() const { return lower_; }
  [[nodiscard]] const std::vector<double>& upper() const { return upper_; }
  /// From first to last row [s].
  [[nodiscard]] std::optional<double> seconds() const;
  /// Of the polygon through the rows' positions of the platform's origin [m]; nothing for cable lengths, which don't say.
  [[nodiscard]] std::optional<double> origin_length_m() const;
  /// Rows at which an angle differs by more than a half turn from the row before, as it does where an export wraps angles at ±180
  /// degrees; the path follows the numbers, the long way round.
  [[nodiscard]] std::size_t jumps() const { return jumps_; }
  [[nodiscard]] std::size_t first_jump_line() const { return first_jump_line_; }

  /// Lines of text: number of rows; a line for each coordinate with first, last, least and largest value in the file's unit, and
  /// in SI where that is another; times; the length of the origin's way.
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] std::vector<double> values(const PathRow& row) const;

  PathHeader header_;
  PoseSampler sampler_;
  std::vector<bool> is_angle_;
  std::size_t rows_ = 0;
  PathRow first_, last_;
  std::vector<double> lower_, upper_, previous_;
  Vector3<double> origin_;
  double origin_length_m_ = 0;
  std::size_t jumps_ = 0, first_jump_line_ = 0;
};

}  // namespace taut
