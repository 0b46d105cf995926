// SPDX-License-Identifier: GPL-3.0-or-later
// What the segments of a stretch of a path share in their proofs: which bodies stay apart all along it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "certify/prover.h"

namespace taut {

/// Of segments that follow one another. It asks more of parts of them, as fewer bodies come near these. Not thread-safe.
class ClearRun {
 public:
  /// How many segments are worth one: 1 where they share nothing, or where each is work enough for a processor of its
  /// own, as with meshes.
  [[nodiscard]] static std::size_t length(const Prover& prover);

  /// @param segment  the k-th, 0 <= k < count; called by at() only
  ClearRun(const Prover& prover, std::function<Segment(std::size_t k)> segment, std::size_t count)
      : prover_(prover), segment_(std::move(segment)), count_(count) {}

  /// For the proof of segment k; null: nothing is known. Quick if k does not decrease.
  [[nodiscard]] const ClearPoses* at(std::size_t k);

 private:
  const Prover& prover_;
  std::function<Segment(std::size_t k)> segment_;
  std::size_t count_;
  bool is_asked_ = false;
  std::vector<RigidPose> poses_;  ///< at the ends of segments
  std::unique_ptr<const ClearPoses> whole_, of_part_;
  std::optional<std::size_t> part_;
};

}  // namespace taut
