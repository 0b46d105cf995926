// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates that no path exists ("No path" in docs/certificate-format.md) on the prover's side: how the checker's
// kernel proves that cells hold no feasible pose, and the file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "certificate/signature.h"
#include "checker/no_path.h"
#include "problem/problem.h"

namespace taut {

/// Runs the checker's kernel on cells. Thread-safe.
class OutsideCells {
 public:
  static constexpr int kBits = 64;

  /// @throws checker::Malformed where the space has no map; checker::Undefined where the problem's numbers can't be
  /// enclosed.
  explicit OutsideCells(const Problem& problem);
  OutsideCells(const OutsideCells&) = delete;
  OutsideCells& operator=(const OutsideCells&) = delete;

  /// The part of a certificate's tree that is this cell: a leaf with the reason that the kernel proves, or halves.
  /// Empty where the kernel does not prove it with a few halvings.
  /// @param cell   its part of each axis
  /// @param first  the reason to try first
  [[nodiscard]] std::string tree(const std::vector<checker::CellPart>& cell, const checker::OutsideReason& first) const;

 private:
  [[nodiscard]] std::string halved(std::vector<checker::CellPart> cell, const checker::OutsideReason& first,
                                   int halvings) const;

  checker::Problem problem_;
  checker::CellSpace space_;
  checker::StatedMachine machine_;
};

/// What such a certificate states.
struct NoPath {
  std::size_t from = 0;         ///< the waypoint of the query; the other is the next
  std::string tree;             ///< of halvings
  nlohmann::json illustration;  ///< proves nothing
};

/// The text of the certificate, as canonical JSON with a line for each key.
/// @param key  signs it; null: it is not signed.
[[nodiscard]] std::string certificate_text(const Problem& problem, const NoPath& no_path,
                                           const SigningKey* key = nullptr);

}  // namespace taut
