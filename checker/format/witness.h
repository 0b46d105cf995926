// SPDX-License-Identifier: GPL-3.0-or-later
// What a certificate states of its boxes and witnesses, beyond what the kernel is asked (checker/kernel/statement.h).
#pragma once

#include <utility>
#include <vector>

#include "checker/kernel/statement.h"

namespace taut::checker {

/// Proved lower bounds.
struct Margins {
  mpq_class tension;       ///< [N]
  mpq_class length;        ///< [m]
  mpq_class wrench_scale;  ///< [1]
  mpq_class clearance;     ///< of distances, minus the clearances of their pairs [m]; 0 where no bodies are stated
};

/// Pairs, by rising index, and the directions of each: what differs of a box from `apart` of its segment.
using ApartChanges = std::vector<std::pair<std::size_t, std::vector<std::size_t>>>;

/// A place of the path.
struct PathPoint {
  std::size_t segment = 0;
  mpq_class s;
};

/// A Box of a path's segment, of which only the motion is shown.
struct MotionBox {
  std::size_t segment = 0;
  Box box;
};

enum class WitnessKind {
  kTensionMin,
  kTensionMax,
  kLengthMin,
  kLengthMax,
  kSingular,
  kContact,
  // Of a move:
  kWinchSpeed,
  kWinchAcceleration,
  kWinchPower,
  kLoadSpeed,
  kLoadAcceleration,
  kLoadAngularSpeed,
  kLoadAngularAcceleration,
};

/// What is too large, if the limit is one in time.
[[nodiscard]] inline std::optional<RateKind> rate_of(WitnessKind kind) {
  switch (kind) {
    case WitnessKind::kTensionMin:
    case WitnessKind::kTensionMax:
    case WitnessKind::kLengthMin:
    case WitnessKind::kLengthMax:
    case WitnessKind::kSingular:
    case WitnessKind::kContact: return std::nullopt;
    case WitnessKind::kWinchSpeed: return RateKind::kWinchSpeed;
    case WitnessKind::kWinchAcceleration: return RateKind::kWinchAcceleration;
    case WitnessKind::kWinchPower: return RateKind::kWinchPower;
    case WitnessKind::kLoadSpeed: return RateKind::kLoadSpeed;
    case WitnessKind::kLoadAcceleration: return RateKind::kLoadAcceleration;
    case WitnessKind::kLoadAngularSpeed: return RateKind::kLoadAngularSpeed;
    case WitnessKind::kLoadAngularAcceleration: break;
  }
  return RateKind::kLoadAngularAcceleration;
}

struct Witness {
  WitnessKind kind = WitnessKind::kSingular;
  PathPoint at;
  Box at_box;                          ///< [s, s] and how the pose there is shown
  PathPoint to;                        ///< kSingular only
  Box to_box;                          ///< likewise
  std::size_t pair = 0;                ///< kContact only, as the next
  ContactWeights weights;              ///< of the two points that are too near to each other
  std::vector<ContactWeights> around;  ///< four in their place, or none: depth_around()
  ContactElements elements;
  std::optional<std::size_t> inside;  ///< the body, 0 or 1, of which the other's point is inside: then it has no point
  mpq_class depth;                    ///< >= 0: by how much they are nearer than is allowed, at least [m]
  std::size_t cable = 0;              ///< 0 to 5; of limits only, as what follows but for `motion`; of the load 0
  mpq_class value_lower;
  mpq_class value_upper;
  std::optional<WitnessDeviation> deviation;     ///< not of a limit in time
  std::optional<Slowing> slowing;                ///< of a move that may be slowed down, and no speed or length
  std::optional<std::vector<LoadChoice>> loads;  ///< one an item, of its kind; of a tension only, and not of a move
  /// Connects the witness: for kSingular the boxes over which the path is shown to be continuous between `at` and
  /// `to`; where the motion is implied, for the witness of the certificate, boxes that with the proved ones cover the
  /// path from its beginning to the witness.
  std::vector<MotionBox> motion;
};

}  // namespace taut::checker
