// SPDX-License-Identifier: GPL-3.0-or-later
// Finds how the checker's kernel proves what the prover has proved: boxes, precisions, where implied motions are, how
// deviations are followed, and the margins that the kernel confirms.
//
// A certificate leaves the checker nothing to search, so whatever has to be searched is searched here, by running the
// same kernel on what is about to be written. Nothing here is trusted: the checker proves each statement again. What
// the kernel cannot be led to prove is left out, and the verdict with it.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "certificate/certificate.h"
#include "certify/path_proof.h"
#include "checker/kernel/box_proof.h"

namespace taut {

/// A box that the kernel proves at one go, and the lower bounds that it finds there.
struct KernelBox {
  checker::Box box;
  double tension_N = 0;
  double length_m = 0;
  double wrench_scale = 0;
  std::optional<double> clearance_m = {};  ///< where the problem has bodies
  PairDirections directions{};             ///< along which that is proved, likewise
};

/// The least of the bounds of some boxes.
struct LeastBounds {
  double tension_N = std::numeric_limits<double>::infinity();
  double length_m = std::numeric_limits<double>::infinity();
  double wrench_scale = std::numeric_limits<double>::infinity();
  std::optional<double> clearance_m;

  void add(std::span<const KernelBox> boxes);
  /// The bounds as decimals, rounded down. @pre some box was added
  [[nodiscard]] Margins margins() const;
};

/// A segment with these boxes and the least margins that they keep.
[[nodiscard]] CertificateSegment make_segment(std::vector<KernelBox> boxes);

/// Thread-safe.
class Elaborator {
 public:
  /// @throws InputError if the problem can't be enclosed.
  Elaborator(const Problem& problem, Interpolation law);

  /// Boxes that tile the given ones, in order; nothing where the kernel does not prove some part of them.
  /// @param directions  one a box, where the problem has bodies
  [[nodiscard]] std::optional<std::vector<KernelBox>> boxes(
      const Segment& segment, std::span<const DyadicBox> proved,
      std::span<const std::shared_ptr<const PairDirections>> directions = {}) const;

  /// What the kernel proves of one box at one go, with the ways of deviations in so many parts. Nothing where it does
  /// not prove that all margins are positive, nor of a box that contains an inner pose between its ends.
  [[nodiscard]] std::optional<KernelBox> one_box(const Segment& segment, const DyadicBox& box, int bits,
                                                 int parts) const;

  /// Raises the margins that the boxes of a proved path state: halves the boxes that state the least ones, or takes the
  /// way to their deviations in more parts, until nearly all of what the kernel finds at their midpoints is stated or
  /// 96 steps are made for each kind of margin.
  void tighten(const std::function<Segment(std::size_t k)>& segment, std::vector<std::vector<KernelBox>>& boxes) const;

  /// Boxes that tile [begin, end], over each of which the kernel shows the motion; nothing where it does not.
  [[nodiscard]] std::optional<std::vector<checker::Box>> motion(const Segment& segment, const Dyadic& begin,
                                                                const Dyadic& end) const;

  /// The witness as the kernel proves it, with the values that it encloses; nothing where it does not. The motion from
  /// the path's beginning to the witness is left to the caller; a singular witness has that between its two places.
  /// @param segment  the one on which the witness is; a waypoint is the beginning of the segment
  [[nodiscard]] std::optional<Witness> witness(const Segment& segment, const PathWitness& found) const;

  /// Whether poses are implied by constraints or lengths.
  [[nodiscard]] bool is_implied() const { return is_implied_; }
  [[nodiscard]] bool has_tolerances() const { return problem_.tolerances.has_value(); }

 private:
  class Search;
  class Tightener;
  [[nodiscard]] const checker::Machine& machine(int bits) const;

  checker::Problem problem_;
  bool is_implied_ = false;
  Model<double> approx_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::unique_ptr<checker::Machine>> machines_;
};

/// The certificate of a path's proof. It is undecided, too, where the prover has a verdict that the kernel cannot be
/// led to confirm.
[[nodiscard]] Certificate elaborate(const Problem& problem, Path path, const PathProof& proof);

}  // namespace taut
