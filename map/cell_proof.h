// SPDX-License-Identifier: GPL-3.0-or-later
// What is proved of one cell: that all its poses are wrench-feasible, or that none is, with the reason.
//
// Inside.   For every pose of the closed cell, every deviation within the tolerances and every wrench of K: J is
//           non-singular, and the tensions that balance the wrench and the lengths are strictly inside their limits;
//           and the two bodies of every checked pair are farther apart than the pair's clearance.
// Outside.  For every pose of the closed cell the machine exactly as typed violates a limit for some wrench of K, or
//           two bodies of a checked pair are not farther apart than its clearance: so no motion of which the claim of
//           a certificate is true passes through any pose of the cell.
// Proofs: docs/theory.md, "Maps".
#pragma once

#include <memory>

#include "kinematics/margin.h"
#include "map/cell.h"
#include "map/map_space.h"

namespace taut {

enum class CellKind : std::uint8_t {
  kUndecided,
  kInside,
  kLength,      ///< outside: one length is beyond one of its limits at every pose
  kTension,     ///< outside: J is non-singular, and one tension beyond a limit for some wrench of K, at every pose
  kUnbalanced,  ///< outside: Farkas's test; at every pose no tensions and lengths within limits balance some wrench
  kContact,     ///< outside: two bodies are not farther apart than their clearance at every pose
};
inline constexpr std::size_t kCellKinds = 6;
[[nodiscard]] constexpr bool is_outside(CellKind kind) { return kind >= CellKind::kLength; }

struct CellVerdict {
  CellKind kind = CellKind::kUndecided;
  /// Of kLength and kTension: the number of the limit in all_margins(). Of kUnbalanced: 2 i, where y is row i of C, or
  /// 2 i + 1, where it is minus that. Of kContact: the pair, by its index in pairs() (problem/bodies.h).
  std::uint16_t reason = 0;
  bool regular = false;  ///< J is proved non-singular on all of the cell, where lengths are positive
  /// What is proved on the cell of the machine as typed. Bit j below kFirstPairBit: margin j of all_margins() is
  /// positive. Bit kFirstPairBit + k: all pairs of bodies whose number is k modulo kPairBits are apart.
  std::uint64_t proved = 0;
  std::uint8_t axis = 0;  ///< if undecided: along which to halve
  /// If undecided: the machine as typed is feasible on all of the cell, and what deviations may change at its midpoint,
  /// if that can be bounded, is more than any of its poses has to spare. Halves would hardly fare better.
  bool is_tolerance = false;

  static constexpr std::size_t kFirstPairBit = 4 * kCables;
  static constexpr std::size_t kPairBits = 64 - kFirstPairBit;
};

/// Immutable; may be shared between threads.
class CellProof {
 public:
  virtual ~CellProof() = default;
  CellProof() = default;
  CellProof(const CellProof&) = delete;
  CellProof& operator=(const CellProof&) = delete;

  /// In binary64 intervals. Never throws; a function of its arguments alone.
  /// @param proved  of a cell that contains this one: what holds there holds here
  [[nodiscard]] virtual CellVerdict judge(const Cell& cell, std::uint64_t proved = 0) const = 0;
};

/// @throws FieldError where a body is a mesh, of which cells know nothing
void require_no_meshes(const Problem& problem);

/// @throws InputError where the problem can't be enclosed in binary64; FieldError as require_no_meshes()
[[nodiscard]] std::unique_ptr<CellProof> make_cell_proof(const Problem& problem, const MapSpace& space);

}  // namespace taut
