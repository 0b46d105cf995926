// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/bodies/clear_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace taut {
namespace {

/// Where p(i) and R(i, j) are among the numbers of a pose.
constexpr std::size_t index_of(int i) { return static_cast<std::size_t>(i); }
constexpr std::size_t index_of(int i, int j) { return static_cast<std::size_t>(3 + 3 * i + j); }
using PoseNumbers = std::array<double, 12>;

PoseNumbers numbers_of(const RigidPose& pose) {
  const Matrix3<double> r = pose.q.toRotationMatrix();
  PoseNumbers result;
  for (int i = 0; i < 3; ++i) {
    result[index_of(i)] = pose.p(i);
    for (int j = 0; j < 3; ++j) result[index_of(i, j)] = r(i, j);
  }
  return result;
}

/// Widened, as enclosures of curved motions are wider than what they enclose: by the more the more differences of
/// poses change, where that can be told. @pre some poses
std::array<Interval, 12> box_around(std::span<const RigidPose> poses) {
  constexpr double kDifference = 0.2, kChange = 4, kMostDifference = 1.5;
  constexpr double kLeast = 1e-9;  // of the numbers
  PoseNumbers last = numbers_of(poses.front());
  PoseNumbers lowest = last, highest = last, before{}, difference{}, change{};
  for (std::size_t n = 1; n < poses.size(); ++n) {
    const PoseNumbers at = numbers_of(poses[n]);
    for (std::size_t k = 0; k < at.size(); ++k) {
      lowest[k] = std::min(lowest[k], at[k]);
      highest[k] = std::max(highest[k], at[k]);
      const double here = at[k] - last[k];
      difference[k] = std::max(difference[k], std::abs(here));
      if (n > 1) change[k] = std::max(change[k], std::abs(here - before[k]));
      before[k] = here;
    }
    last = at;
  }
  std::array<Interval, 12> result;
  for (std::size_t k = 0; k < result.size(); ++k) {
    const double most = kMostDifference * difference[k];
    const double wider = poses.size() > 2 ? std::min(kDifference * difference[k] + kChange * change[k], most) : most;
    const double little = kLeast * (1 + std::max(std::abs(lowest[k]), std::abs(highest[k])));
    result[k] = Interval(lowest[k] - wider - little, highest[k] + wider + little);
  }
  return result;
}

/// May be empty: lower > upper. Nothing is within it then.
Interval common(const Interval& a, const Interval& b) {
  return {std::max(a.lower(), b.lower()), std::min(a.upper(), b.upper())};
}

bool is_within(const Interval& inner, const Interval& outer) {
  return taut::contains(outer, inner.lower()) && taut::contains(outer, inner.upper());
}

}  // namespace

/// The machine over a box of poses.
struct ClearPoses::Gaps {
  Vector3<Form> p_WP;
  Matrix3<Form> r_WP;
  std::array<Form, kCables> length;
  Interval offset;  ///< of constants
  std::optional<BodiesBox<Interval>> box;
  std::optional<BodyGaps<Interval>> gaps;

  /// @pre under run_upward()
  void open(const Machine& machine, const PoseBox& poses) {
    offset = Interval(0.0);
    for (int i = 0; i < 3; ++i) {
      p_WP(i) = poses[index_of(i)];
      for (int j = 0; j < 3; ++j) r_WP(i, j) = poses[index_of(i, j)];
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<Interval>& b = machine.model.p_PB[i];
      std::array<Interval, 3> d;
      for (int k = 0; k < 3; ++k) {
        d[static_cast<std::size_t>(k)] = p_WP(k).range - machine.model.p_WA[i](k) + r_WP(k, 0).range * b(0) +
                                         r_WP(k, 1).range * b(1) + r_WP(k, 2).range * b(2);
      }
      length[i] = euclidean_norm(d[0], d[1], d[2]);
    }
    box.emplace(BodiesBox<Interval>{machine.bodies, machine.model, p_WP, r_WP, length, offset});
    gaps.emplace(*box);
  }
};

bool ClearPoses::sort_out(const Machine& machine, Gaps& over, std::span<const std::size_t> pairs,
                          const PairDirections& directions) {
  others_.reserve(others_.size() + pairs.size());
  const bool is_valid = run_upward([&] {
    if (!over.gaps) over.open(machine, box_);
    for (const std::size_t n : pairs) {
      const CheckedPair<Interval>& pair = machine.bodies.pairs[n];
      const double gap = pair.has_mesh ? 0 : over.gaps->rough(pair, directions.single[n]);
      if (gap > 0) {
        apart_.push_back({gap, n});
      } else {
        others_.push_back(n);
      }
    }
  });
  return is_valid && over.gaps->have_cables_length();
}

/// Of those that are apart, a few of the nearest: these may be what margins are measured from.
std::vector<std::size_t> ClearPoses::take_nearer_than(double gap) {
  constexpr std::size_t kMost = 1;
  const auto farther = std::ranges::partition(apart_, [&](const PairGap& x) { return x.gap < gap; });
  const auto nearer = std::span(apart_.begin(), farther.begin());
  const std::size_t count = std::min(kMost, nearer.size());
  std::ranges::partial_sort(nearer, nearer.begin() + static_cast<std::ptrdiff_t>(count), {}, &PairGap::gap);
  std::vector<std::size_t> result;
  for (const PairGap& x : nearer.first(count)) result.push_back(x.pair);
  apart_.erase(apart_.begin(), apart_.begin() + static_cast<std::ptrdiff_t>(count));
  return result;
}

std::unique_ptr<const ClearPoses> ClearPoses::around(const Machine& machine, std::span<const RigidPose> poses,
                                                     const ClearPoses* wider, Use use) {
  const std::size_t count = machine.bodies.pairs.size();
  ClearPoses result(box_around(poses));
  PairDirections directions;
  std::vector<std::size_t> all;
  std::span<const std::size_t> asked;
  result.apart_.reserve(count);
  if (wider == nullptr) {
    all.resize(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    asked = all;
  } else {
    directions = *wider->directions_;
    asked = wider->others_;
    result.apart_.assign(wider->apart_.begin(), wider->apart_.end());
  }
  const RigidPose& middle = poses[poses.size() / 2];
  machine.sampler.set_rough_directions(machine.in_doubles, middle, asked, directions);
  Gaps over;
  if (!result.sort_out(machine, over, asked, directions)) return nullptr;
  if (use == Use::kProofs || result.others_.empty()) {
    const std::array<RigidPose, 2> ends{poses.front(), poses.back()};
    const auto sharpen = [&](std::span<const std::size_t> pairs) {
      return machine.sampler.set_sharp_directions(machine.in_doubles, middle, ends, pairs, directions);
    };
    const std::vector<std::size_t> near = result.take_nearer_than(sharpen(result.others_));
    if (!near.empty()) {
      sharpen(near);
      if (!result.sort_out(machine, over, near, directions)) return nullptr;
    }
  }
  if (result.apart_.empty()) return nullptr;
  for (std::size_t k = 0; wider != nullptr && k < result.box_.size(); ++k) {
    result.box_[k] = common(result.box_[k], wider->box_[k]);
  }
  result.directions_ = std::make_shared<const PairDirections>(std::move(directions));
  return std::make_unique<const ClearPoses>(std::move(result));
}

bool ClearPoses::contains(const Vector3<Form>& p_WP, const Matrix3<Form>& r_WP) const {
  for (int i = 0; i < 3; ++i) {
    if (!is_within(p_WP(i).range, box_[index_of(i)])) return false;
    for (int j = 0; j < 3; ++j) {
      if (!is_within(r_WP(i, j).range, box_[index_of(i, j)])) return false;
    }
  }
  return true;
}

double ClearPoses::least_gap() const {
  double least = std::numeric_limits<double>::infinity();
  for (const PairGap& x : apart_) least = std::min(least, x.gap);
  return least;
}

}  // namespace taut
