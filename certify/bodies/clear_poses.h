// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of bodies that stay apart at all poses of a box: what segments that run through it need not ask again.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "certify/bodies/body_gaps.h"
#include "certify/bodies/nearest.h"

namespace taut {

/// Claim: at every pose (p, R) of a box, each pair but the others() is farther apart than required by at least
/// least_gap(), along its direction. Of the undisturbed machine. The bounds are BodyGaps::rough()'s, which holds of all
/// poses within the ranges it is given, whatever motion they are ranges of (docs/theory.md, "Clearance").
class ClearPoses {
 public:
  using Form = SlopeForm<Interval>;

  struct Machine {
    const BodyModel<Interval>& bodies;
    const Model<Interval>& model;
    const BodySampler& sampler;
    const Model<double>& in_doubles;
  };
  enum class Use {
    kProofs,   ///< its directions are to be stated in certificates: those of near pairs are chosen with care
    kSmaller,  ///< smaller boxes within it are asked first for the pairs that it leaves
  };

  /// In a box around some poses and, it is to be hoped, all on a smooth way through them. Restores the caller's
  /// rounding mode.
  /// @param wider  what is known of more poses: then of those in both boxes
  /// @returns null where no pair is apart at all of them
  [[nodiscard]] static std::unique_ptr<const ClearPoses> around(const Machine& machine,
                                                                std::span<const RigidPose> poses,
                                                                const ClearPoses* wider, Use use);

  /// Whether all poses within these ranges are in the box.
  [[nodiscard]] bool contains(const Vector3<Form>& p_WP, const Matrix3<Form>& r_WP) const;

  /// Of all pairs.
  [[nodiscard]] const std::shared_ptr<const PairDirections>& directions() const { return directions_; }
  [[nodiscard]] double least_gap() const;                                        ///< [m]
  [[nodiscard]] std::span<const std::size_t> others() const { return others_; }  ///< pairs of which nothing is known

 private:
  using PoseBox = std::array<Interval, 12>;  ///< p, and R row by row
  struct PairGap {
    double gap = 0;
    std::size_t pair = 0;
  };

  explicit ClearPoses(const PoseBox& box) : box_(box) {}
  /// Whether pairs are apart. @returns false where something is undefined
  struct Gaps;
  [[nodiscard]] bool sort_out(const Machine& machine, Gaps& over, std::span<const std::size_t> pairs,
                              const PairDirections& directions);
  [[nodiscard]] std::vector<std::size_t> take_nearer_than(double gap);

  PoseBox box_;
  std::shared_ptr<const PairDirections> directions_;
  std::vector<PairGap> apart_;
  std::vector<std::size_t> others_;
};

}  // namespace taut
