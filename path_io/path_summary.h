// SPDX-License-Identifier: GPL-3.0-or-later
// A short summary of a path file, in which a wrong unit or a wrong column is easy to see.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/pose_sampler.h"
#include "path_io/path_file.h"

namespace taut {

/// What the law means, without a full stop: "geodesic: between two waypoints the platform's origin moves straight, …".
[[nodiscard]] std::string law_sentence(Interpolation law, const Problem& problem);

/// Gathers statistics of the rows in constant memory. They are computed in floating point, for people, not for proofs.
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
  /// Time from the first to the last row [s].
  [[nodiscard]] std::optional<double> seconds() const;
  /// Length of the polygon through the positions of the platform's origin [m]; nothing for cable lengths, which don't
  /// give positions.
  [[nodiscard]] std::optional<double> origin_length_m() const;
  /// Lines of text: the number of rows; for each coordinate the first, last, least and largest value in the file's
  /// unit, and in SI if that is another; the distance that the origin travels; the duration; where the platform rests;
  /// a warning if there are jumps.
  [[nodiscard]] std::string text() const;

 private:
  /// Successive rows of one pose, each after the first a repeat of it.
  struct Rest {
    std::size_t repeats = 0;
    std::size_t first_line = 0, last_line = 0;
    std::optional<Decimal> begin_s, end_s;
  };

  [[nodiscard]] std::vector<double> values(const PathRow& row) const;
  void add_rest(const PathRow& row);
  [[nodiscard]] std::string rest_text() const;

  PathHeader header_;
  AngleKind angles_;
  PoseSampler sampler_;
  std::vector<bool> is_angle_;
  std::size_t rows_ = 0;
  PathRow first_, last_;
  std::vector<double> lower_, upper_, previous_;
  Vector3<double> origin_;
  double origin_length_m_ = 0;
  std::size_t jumps_ = 0, first_jump_line_ = 0;
  std::size_t repeats_ = 0;
  Rest rest_;  ///< the one that the last row belongs to
  Rest longest_rest_;
};

}  // namespace taut
