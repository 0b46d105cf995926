// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/clear_run.h"

#include <algorithm>
#include <span>

namespace taut {

std::size_t ClearRun::length(const Prover& prover) {
  if (prover.bodies() == nullptr || prover.problem().tolerances) return 1;
  const auto& pairs = prover.bodies()->bodies().pairs;
  return std::ranges::any_of(pairs, &CheckedPair<double>::has_mesh) ? 1 : kParts * kPart;
}

template <class F>
const ClearPoses* ClearRun::get(Made& made, F&& make) {
  if (!made.is_made.load(std::memory_order_acquire)) {
    const std::lock_guard lock(mutex_);
    if (!made.is_made.load(std::memory_order_relaxed)) {
      made.poses = make();
      made.is_made.store(true, std::memory_order_release);
    }
  }
  return made.poses.get();
}

const ClearPoses* ClearRun::at(std::size_t k) {
  if (count_ < 2) return nullptr;
  const ClearPoses* whole = get(whole_, [this] { return make_whole(); });
  if (whole == nullptr || whole->others().empty()) return whole;
  return get(parts_.at(k / kPart), [this, k] { return make_part(k / kPart); });
}

std::unique_ptr<const ClearPoses> ClearRun::make_whole() {
  ends_.reserve(count_ + 1);
  for (std::size_t k = 0; k < count_; ++k) {
    const Segment segment = segment_(k);
    if (!prover_.is_admissible(segment)) return nullptr;
    if (k == 0) ends_.push_back(prover_.sampler().rigid_pose(segment, 0));
    ends_.push_back(prover_.sampler().rigid_pose(segment, 1));
  }
  return prover_.clear_poses(ends_, nullptr, ClearPoses::Use::kSmaller);
}

std::unique_ptr<const ClearPoses> ClearRun::make_part(std::size_t part) const {
  const std::size_t first = kPart * part, last = std::min(first + kPart, count_);
  return prover_.clear_poses(std::span(ends_).subspan(first, last - first + 1), whole_.poses.get(),
                             ClearPoses::Use::kProofs);
}

}  // namespace taut
