// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates that no path exists ("No path" in docs/certificate-format.md) on the prover's side: how the checker's
// kernel proves that cells hold no feasible pose, and the file.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "certificate/signature.h"
#include "certify/bodies/nearest.h"
#include "checker/no_path.h"
#include "kinematics/pose_sampler.h"
#include "problem/problem.h"

namespace taut {

/// A part of a certificate's tree.
struct OutsidePart {
  std::string tree;
  std::vector<checker::ContactReason> contacts;  ///< of its leaves that are in contact, in their order
};

/// The reason to try first: that of a limit, or a pair of bodies.
struct FirstReason {
  checker::OutsideReason limit;
  std::optional<std::size_t> pair = {};
};

/// Runs the checker's kernel on cells. Thread-safe.
class OutsideCells {
 public:
  static constexpr int kBits = 64;

  /// @throws checker::Malformed where the space has no map; checker::Undefined where the problem's numbers can't be
  /// enclosed.
  explicit OutsideCells(const Problem& problem);
  OutsideCells(const OutsideCells&) = delete;
  OutsideCells& operator=(const OutsideCells&) = delete;
  ~OutsideCells() = default;

  /// The part of a certificate's tree that is this cell: a leaf with the reason that the kernel proves, or halves.
  /// Empty where the kernel does not prove it with a few halvings.
  /// @param cell   its part of each axis
  [[nodiscard]] OutsidePart tree(const std::vector<checker::CellPart>& cell, const FirstReason& first) const;

 private:
  using Parameters = std::vector<checker::CellForm>;
  [[nodiscard]] OutsidePart halved(std::vector<checker::CellPart> cell, const FirstReason& first, int halvings) const;
  /// A leaf, or nothing.
  [[nodiscard]] OutsidePart leaf(checker::OutsideProof& proof, const Parameters& parameters,
                                 const FirstReason& first) const;
  /// The contact of a pair, if it is proved.
  [[nodiscard]] std::optional<checker::ContactReason> contact(const checker::OutsideProof& proof, const RigidPose& pose,
                                                              std::size_t pair) const;

  /// Where the problem has bodies: proposes the points that touch.
  struct Proposer {
    PoseSampler poses;
    BodySampler bodies;
  };
  std::optional<Proposer> proposer_;
  checker::Problem problem_;
  checker::CellSpace space_;
  checker::StatedMachine machine_;
};

/// What such a certificate states.
struct NoPath {
  std::size_t from = 0;         ///< the waypoint of the query; the other is the next
  OutsidePart cells;            ///< the whole space
  nlohmann::json illustration;  ///< proves nothing
};

/// The text of the certificate, as canonical JSON with a line for each key.
/// @param key  signs it; null: it is not signed.
[[nodiscard]] std::string certificate_text(const Problem& problem, const NoPath& no_path,
                                           const SigningKey* key = nullptr);

}  // namespace taut
