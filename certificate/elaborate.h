// SPDX-License-Identifier: GPL-3.0-or-later
// Finds how the checker's kernel proves what the prover has proved: boxes, precisions, places of implied motions, ways of
// deviations, and the margins that the kernel confirms.
//
// A certificate leaves the checker nothing to search, so whatever has to be searched is searched here, by running the same
// kernel on what is about to be written. Nothing here is trusted: the checker proves each statement again. What the kernel
// can't be led to prove is left out, and the verdict with it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "certify/path_proof.h"
#include "checker/kernel/box_proof.h"
#include "checker/witness.h"

namespace taut {

/// A box that the kernel proves at one go, and the lower bounds that it finds there.
struct KernelBox {
  checker::Box box;
  double tension_N = 0;
  double length_m = 0;
  double wrench_scale = 0;
};

/// Boxes of one segment, and the margins that all of them keep, as decimals rounded down.
struct KernelSegment {
  std::vector<KernelBox> boxes;
  Margins margins;
};
[[nodiscard]] KernelSegment make_segment(std::vector<KernelBox> boxes);

/// A witness as the checker will confirm it.
struct KernelWitness {
  checker::Witness witness;
  DecimalText value_lower, value_upper;  ///< of the quantity, unless singular
};

/// Thread-safe.
class Elaborator {
 public:
  /// @throws InputError if the problem can't be enclosed.
  Elaborator(const Problem& problem, Interpolation law);

  /// Boxes that tile the given ones, in order; nothing where some part is not proved by the kernel.
  [[nodiscard]] std::optional<std::vector<KernelBox>> boxes(const Segment& segment,
                                                            std::span<const DyadicBox> proved) const;

  /// What the kernel proves of one box at one go, with the deviations' ways in so many parts; nothing where it does not
  /// prove that all margins are positive, nor of a box that reaches across an inner pose.
  [[nodiscard]] std::optional<KernelBox> one_box(const Segment& segment, const DyadicBox& box, int bits,
                                                 int parts) const;

  /// Halves boxes of a proved path that state its least margins, up to 64 times, until half of what there is next to their
  /// midpoints is stated.
  void tighten(const std::function<Segment(std::size_t k)>& segment, std::vector<std::vector<KernelBox>>& boxes) const;

  /// Boxes of [begin, end] over which the kernel shows the motion; nothing where it does not.
  [[nodiscard]] std::optional<std::vector<checker::Box>> motion(const Segment& segment, const Dyadic& begin,
                                                                const Dyadic& end) const;

  /// @param segment  the one of `at` (and `to`), as of which the kernel is asked; `motion` is left to the caller, but for that
  /// between the places of a singular witness.
  [[nodiscard]] std::optional<KernelWitness> witness(const Segment& segment, const PathWitness& found) const;

  /// Whether poses are implied by constraints or lengths.
  [[nodiscard]] bool is_implied() const { return is_implied_; }
  [[nodiscard]] bool has_tolerances() const { return problem_.tolerances.has_value(); }

 private:
  class Search;
  [[nodiscard]] const checker::Machine& machine(int bits) const;

  checker::Problem problem_;
  Interpolation law_;
  bool is_implied_ = false;
  Model<double> approx_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::unique_ptr<checker::Machine>> machines_;
};

/// A path's proof as the kernel confirms it.
struct KernelProof {
  Verdict verdict = Verdict::kUndecided;
  std::vector<KernelSegment> segments;   ///< only if proved
  Margins margins;                       ///< the least along the path; only if proved
  std::optional<KernelWitness> witness;  ///< only if refuted: as of the segment of the path's witness
  Reason reason;                         ///< only if undecided
};
/// Undecided, too, where the prover has a verdict that the kernel can't be led to confirm.
[[nodiscard]] KernelProof confirmed(const Problem& problem, const Path& path, const PathProof& proof);

/// The segment on which a witness is; that of a waypoint begins there.
[[nodiscard]] std::size_t segment_of(const PathWitness& witness);

/// Where the implied motion of a box of segment k is, at the precision of the box; nothing where it is not found. It
/// need not be what the kernel can prove.
/// @pre `machine` is of the precision of the box
[[nodiscard]] std::optional<checker::NearZero> find_motion(const checker::Machine& machine,
                                                           const checker::Problem& problem, const checker::Path& path,
                                                           std::size_t k, const checker::Box& box);
/// Fills in poses and boxes of the way that a deviation leads from `stated`; false where the kernel can't be led to its end.
/// @param model  the machine as the problem states it
[[nodiscard]] bool find_way(const checker::Machine& machine, const checker::Geometry& stated,
                            const Model<double>& model, checker::WitnessDeviation& deviation, int bits);

/// The certificate's numbers for a Dyadic.
[[nodiscard]] mpq_class to_rational(const Dyadic& x);

}  // namespace taut
