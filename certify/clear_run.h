// SPDX-License-Identifier: GPL-3.0-or-later
// What the segments of a stretch of a path share in their proofs: which bodies stay apart all along it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "certify/prover.h"

namespace taut {

/// Of segments that follow one another. It asks more of parts of them, as fewer bodies come near these. Thread-safe.
class ClearRun {
 public:
  /// How many segments are worth one: 1 where they share nothing, or where each is work enough by itself, as with
  /// meshes.
  [[nodiscard]] static std::size_t length(const Prover& prover);

  /// @param segment  the k-th, 0 <= k < count; called by at() only
  /// @param count  at most length()
  ClearRun(const Prover& prover, std::function<Segment(std::size_t k)> segment, std::size_t count)
      : prover_(prover), segment_(std::move(segment)), count_(count) {}

  /// For the proof of segment k; null: nothing is known. It does not depend on what was asked before.
  [[nodiscard]] const ClearPoses* at(std::size_t k);

 private:
  static constexpr std::size_t kParts = 4, kPart = 4;  ///< a part's segments

  /// Made once, by the first that asks; std::call_once() takes longer to see that it was.
  struct Made {
    std::atomic<bool> is_made = false;
    std::unique_ptr<const ClearPoses> poses;
  };
  template <class F>
  const ClearPoses* get(Made& made, F&& make);

  [[nodiscard]] std::unique_ptr<const ClearPoses> make_whole();
  [[nodiscard]] std::unique_ptr<const ClearPoses> make_part(std::size_t part) const;

  const Prover& prover_;
  std::function<Segment(std::size_t k)> segment_;
  std::size_t count_;
  std::mutex mutex_;
  std::vector<RigidPose> ends_;  ///< of segments
  Made whole_;
  std::array<Made, kParts> parts_;
};

}  // namespace taut
