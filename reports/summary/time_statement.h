// SPDX-License-Identifier: GPL-3.0-or-later
// A move in time in words and numbers: its limits, how much of them samples use, and what breaks one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "certify/path_proof.h"
#include "reports/summary/display_units.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/scene.h"

namespace taut {

/// Whether a certificate is about a move in time; else about a path that is passed slowly, or a pose at rest.
[[nodiscard]] bool is_move(const Certificate& certificate);
/// The load of a certificate, with its inertia if it is about a move.
[[nodiscard]] LoadStatement stated_load(const Certificate& certificate);

/// "In time: winches: speed below 1 m/s, acceleration below 0.5 m/s²; the load point: ….": exactly, in people's units.
[[nodiscard]] std::string time_limits_text(const TimeText& time, const DisplayUnits& units);

/// "0.00626 mm", rounded up: by how much straight lengths between rows may be off, at most.
[[nodiscard]] std::string row_error_text(const RowsText& rows);
/// Which weights are boxes and which are points for their inertia, by name. @pre some item is a weight
[[nodiscard]] std::string inertia_text(const LoadText& load);

/// "1 m/s": a stated limit, exactly.
[[nodiscard]] std::string rate_limit_text(const TimeText& time, RateId id, const DisplayUnits& units);

/// By how much of one kind of limit a move uses at most, in floating-point samples.
struct RateUse {
  RateLimit limit;
  double size = 0;      ///< SI; of the winch that uses most of its limit
  double time_s = 0;    ///< when
  double position = 0;  ///< and where

  [[nodiscard]] double share() const { return size / limit.value; }
};
/// One of each kind that is stated; none of what is no move.
[[nodiscard]] std::vector<RateUse> rate_uses(const ReportContext& scene);
/// "0.97 m/s", rounded towards the limit.
[[nodiscard]] std::string size_text(const RateUse& use, const DisplayUnits& units);

/// ", where the move is braked as hard as its stopping time allows at 99.9 % of its speed", rounded; empty of a witness
/// that is not about a move that is slowed down.
[[nodiscard]] std::string slowing_text(const PathWitness& witness);
/// "cable 3 would be wound at 1.2 m/s or more; its limit is 1 m/s". @pre witness.rate
[[nodiscard]] std::string rate_violation_text(const PathWitness& witness, const Problem& problem,
                                              const DisplayUnits& units);
/// "1.2 m/s": the least that a witness proves, rounded down. @pre witness.rate
[[nodiscard]] std::string rate_value_text(const PathWitness& witness, const Problem& problem,
                                          const DisplayUnits& units);
/// "wound too fast", behind the subject.
[[nodiscard]] const char* too_fast_text(RateKind kind);
/// "Cable 3", "Load point" or "Platform".
[[nodiscard]] std::string subject_of(RateId id);
/// severity() (certify/severity.h), and of a rate by how much of its limit it is proved to be beyond that.
[[nodiscard]] double severity_of(const PathWitness& witness, const Problem& problem);

/// "4.2 s", of four digits.
[[nodiscard]] std::string seconds_text(double seconds);

}  // namespace taut
