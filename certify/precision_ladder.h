// SPDX-License-Identifier: GPL-3.0-or-later
// One problem in interval arithmetic of rising precision.
//
// Rung 0 of the ladder is binary64; rung k > 0 is MPFR with bits(k) bits: 128, 256, 512, … up to a given maximum.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "certify/box_proof.h"

namespace taut {

/// Immutable from outside; may be shared between threads.
class PrecisionLadder {
 public:
  /// @param max_bits  of the last rung, at least 128 @param slowing  of a move that is run so everywhere
  /// @throws InputError if the problem can't be enclosed (E not positive definite).
  PrecisionLadder(const Problem& problem, mpfr_prec_t max_bits, const std::optional<Slowing>& slowing = {});

  /// The number of the last rung.
  [[nodiscard]] std::size_t last() const { return fine_.size(); }
  /// @pre 0 < rung <= last()
  [[nodiscard]] mpfr_prec_t bits(std::size_t rung) const { return bits_.at(rung - 1); }
  /// The depth from which the rounding of s itself is as large as a box.
  [[nodiscard]] int deepest(std::size_t rung) const;

  /// The problem at rung 0.
  [[nodiscard]] const ProofModel<Interval>& binary64() const { return fast_; }
  /// The problem at a rung above 0; made when it is first needed, because most problems never climb.
  /// @pre 0 < rung <= last()
  [[nodiscard]] const ProofModel<MpInterval>& multiprecision(std::size_t rung) const;

  /// judge_box() at a rung.
  [[nodiscard]] BoxVerdict judge(std::size_t rung, const Segment& segment, const DyadicBox& box, double clearance,
                                 int continuation_steps, const PairDirections* directions = nullptr,
                                 const ClearPoses* clear = nullptr) const;
  /// judge_contact() at a rung.
  [[nodiscard]] Contact judge_contact(std::size_t rung, const Segment& segment, const DyadicBox& box,
                                      const PairContact& found) const;

 private:
  struct Rung {
    std::once_flag made;
    std::unique_ptr<const ProofModel<MpInterval>> model;  // 30 kB each, which few problems ever need
  };

  Problem problem_;
  std::optional<Slowing> slowing_;
  ProofModel<Interval> fast_;
  std::vector<mpfr_prec_t> bits_;
  mutable std::vector<Rung> fine_;
};

}  // namespace taut
