// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the witness of a refuted audit: the gravest violation that is found and proved.
//
// The witnesses of a stretch are where a violation begins and ends, so they break a limit by little. Here are gathered,
// as an audit comes by them, its own witnesses and what samples inside the violated stretches show; once all is known,
// a few of the gravest are proved.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/audit_batch.h"

namespace taut {

class GravestWitness {
 public:
  /// Refers to both, which outlive it.
  GravestWitness(const Prover& prover, const Elaborator& elaborator) : prover_(prover), elaborator_(elaborator) {}

  /// Takes what is known of a part of a stretch, on segment i of a batch. @pre the motion is not implied
  void add(const std::shared_ptr<const Batch>& batch, std::size_t i, const SegmentStretch& part);
  /// Ends a stretch: what was only suspected in it counts if the stretch is violated.
  void end_stretch(bool is_violated);

  /// The gravest violation: a singular pose before bodies that are too near before any limit, then by severity(); the
  /// first of equals. Nothing where
  /// there is no violated stretch.
  struct Found {
    Witness witness;
    std::shared_ptr<const Batch> batch;  ///< and the segment of it on which the witness is
    std::size_t segment;
  };
  [[nodiscard]] std::optional<Found> find();

 private:
  struct Touching {
    std::shared_ptr<const Batch> batch;
    std::size_t segment;
    SuspectedContact contact;
  };
  struct Suspect {
    std::shared_ptr<const Batch> batch;
    std::size_t segment;
    SuspectedViolation violation;
  };
  /// The first changes of sign, and the limits that seem to be broken most.
  struct Suspects {
    std::vector<Suspect> singular, limits;
    void add(Suspect suspect);
    void add(Suspects other);
  };

  void take(Found found);
  [[nodiscard]] std::optional<Found> prove(const Suspect& suspect) const;
  [[nodiscard]] std::optional<Found> prove_singular(const Suspect& suspect) const;
  [[nodiscard]] std::optional<Found> prove_limit(const Suspect& suspect) const;
  [[nodiscard]] std::optional<Found> prove_by_a_deviation(const Suspect& suspect) const;
  [[nodiscard]] std::optional<Found> prove_contact(const Touching& suspect) const;
  [[nodiscard]] std::optional<Found> elaborated(const std::shared_ptr<const Batch>& batch, std::size_t segment,
                                                const PathWitness& witness) const;

  const Prover& prover_;
  const Elaborator& elaborator_;
  std::optional<Found> gravest_;     ///< proved
  double severity_ = 0;              ///< of it
  std::optional<Touching> deepest_;  ///< contact that is suspected
  Suspects here_, all_;              ///< of the stretch that is being read, and of those before it that are violated
};

}  // namespace taut
