// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/clear_run.h"

#include <algorithm>
#include <span>

namespace taut {
namespace {

constexpr std::size_t kShortest = 16;     ///< run of a path that is not shorter; up to 31
constexpr std::size_t kShortestPart = 4;  ///< of a run; up to 7

/// The length of stretches of about the same length, the last of which may be shorter: where there are `shortest`, none
/// but that one is shorter, and none is twice as long.
std::size_t even_length(std::size_t count, std::size_t shortest) {
  const std::size_t stretches = std::max<std::size_t>(count / shortest, 1);
  return (count + stretches - 1) / stretches;
}

}  // namespace

std::size_t ClearRun::length(const Prover& prover, std::size_t segments) {
  if (prover.bodies() == nullptr || prover.problem().tolerances) return 1;
  return prover.bodies()->bodies().has_meshes ? 1 : even_length(segments, kShortest);
}

ClearRun::ClearRun(const Prover& prover, std::function<Segment(std::size_t k)> segment, std::size_t count)
    : prover_(prover), segment_(std::move(segment)), count_(count), part_(even_length(count, kShortestPart)) {}

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
  return get(parts_.at(k / part_), [this, k] { return make_part(k / part_); });
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
  const std::size_t first = part_ * part, last = std::min(first + part_, count_);
  return prover_.clear_poses(std::span(ends_).subspan(first, last - first + 1), whole_.poses.get(),
                             ClearPoses::Use::kProofs);
}

}  // namespace taut
