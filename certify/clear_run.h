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

/// Shared by segments that follow one another. Parts of the stretch are asked again for the pairs that the whole of it
/// leaves, since fewer bodies come near a part. Thread-safe.
class ClearRun {
 public:
  /// How many of so many segments share one: 1 where nothing can be shared, or where each takes so long, as with
  /// meshes, that it is not worth it.
  [[nodiscard]] static std::size_t length(const Prover& prover, std::size_t segments);

  /// @param segment  the k-th, 0 <= k < count; called by at() only
  /// @param count  at most what length() returned
  ClearRun(const Prover& prover, std::function<Segment(std::size_t k)> segment, std::size_t count);

  /// For the proof of segment k; null: nothing is known. It does not depend on what was asked before.
  [[nodiscard]] const ClearPoses* at(std::size_t k);

 private:
  static constexpr std::size_t kMostParts = 7;

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
  std::size_t part_;  ///< how many segments a part has
  std::mutex mutex_;
  std::vector<RigidPose> ends_;  ///< of segments
  Made whole_;
  std::array<Made, kMostParts> parts_;
};

}  // namespace taut
