// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/clear_run.h"

#include <algorithm>
#include <span>

namespace taut {

std::size_t ClearRun::length(const Prover& prover) {
  constexpr std::size_t kLength = 16;
  if (prover.bodies() == nullptr || prover.problem().tolerances) return 1;
  const auto& pairs = prover.bodies()->bodies().pairs;
  return std::ranges::any_of(pairs, &CheckedPair<double>::has_mesh) ? 1 : kLength;
}

const ClearPoses* ClearRun::at(std::size_t k) {
  constexpr std::size_t kPart = 4;  // segments
  if (!is_asked_) {
    is_asked_ = true;
    if (prover_.bodies() == nullptr || count_ < 2) return nullptr;
    poses_.push_back(prover_.sampler().rigid_pose(segment_(0), 0));
    for (std::size_t j = 0; j < count_; ++j) poses_.push_back(prover_.sampler().rigid_pose(segment_(j), 1));
    whole_ = prover_.clear_poses(poses_, nullptr, ClearPoses::Use::kSmaller);
  }
  if (!whole_) return nullptr;
  if (whole_->others().empty()) return whole_.get();
  if (const std::size_t part = k / kPart; part != part_) {
    part_ = part;
    const std::size_t first = kPart * part, last = std::min(first + kPart, count_);
    of_part_ =
        prover_.clear_poses(std::span(poses_).subspan(first, last - first + 1), whole_.get(), ClearPoses::Use::kProofs);
  }
  return of_part_.get();
}

}  // namespace taut
