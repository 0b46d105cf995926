// SPDX-License-Identifier: GPL-3.0-or-later
// Where a segment is not proved, from its survey.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "certify/segment_proof.h"

namespace taut {

/// A maximal run of boxes that are not proved: outside of [begin, end], next to it, the segment is proved or ends.
struct Gap {
  Dyadic begin, end;
  /// Inner ends, which may be the same: the first and the last place in it where a violation is proved; none of an open gap.
  std::optional<SegmentWitness> first, last;
  Reason reason;  ///< only of an open gap: of its first box
};

/// In order along the segment.
[[nodiscard]] std::vector<Gap> gaps(const SegmentSurvey& survey);

}  // namespace taut
