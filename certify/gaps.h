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
  /// Inner ends: the first and the last place in the gap where a violation is proved. They may be the same place; an
  /// open gap has none.
  std::optional<SegmentWitness> first, last;
  std::optional<SegmentWitness> singular;  ///< the first one in the gap that is about a singular pose
  Reason reason;                           ///< only of an open gap: of its first box
};

/// The gaps of a survey, in order along the segment.
[[nodiscard]] std::vector<Gap> gaps(const SegmentSurvey& survey);

}  // namespace taut
