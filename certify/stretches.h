// Where a path is not proved: stretches of it, gathered segment by segment in memory that does not grow with the path.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "certify/path_proof.h"

namespace taut {

/// A maximal run of boxes that are not proved. Next to its outer ends, on either side, the path is proved or ends.
struct Stretch {
  PathPoint begin, end;  ///< on segments; an end at s = 1 is s = 0 of the next segment
  /// Inner ends, which may be the same: the first and the last place found in it where a violation is proved. None of an open stretch.
  struct Violation {
    int segment = 0;
    SegmentWitness witness;
  };
  std::optional<Violation> first, last;
  std::string reason;  ///< only of an open stretch: of its first box
};

/// Takes the surveys of a path's segments in order.
class StretchFinder {
 public:
  /// The survey of the next segment. @returns the stretches that have ended with it.
  [[nodiscard]] std::vector<Stretch> add(const SegmentSurvey& survey);
  /// The end of the path. @returns the stretch that it ends, if any.
  [[nodiscard]] std::optional<Stretch> finish();

  /// Of all segments so far: proved without stretches, refuted if a violation was found.
  [[nodiscard]] Verdict verdict() const;
  [[nodiscard]] int segments() const { return segments_; }
  /// Least over the proved boxes of all segments; infinite where there is none.
  [[nodiscard]] double tension_N() const { return tension_N_; }  // NOLINT(readability-identifier-naming): the unit
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double wrench_scale() const { return wrench_scale_; }

 private:
  std::optional<Stretch> current_;
  int segments_ = 0;
  bool has_stretches_ = false;
  bool is_refuted_ = false;
  double tension_N_ = std::numeric_limits<double>::infinity();
  double length_m_ = tension_N_;
  double wrench_scale_ = tension_N_;
};

}  // namespace taut
