// SPDX-License-Identifier: GPL-3.0-or-later
// What a certificate says of a path that is proved, as the monitor and tables of moves need it.
#pragma once

#include <vector>

#include "certificate/certificate.h"
#include "checker/check.h"
#include "path_io/move_tables.h"

namespace taut {

struct ProvedPath {
  Problem problem;
  Path path;
  std::vector<std::vector<DyadicBox>> boxes;  ///< of each segment
  std::vector<Margins> margins;               ///< likewise
};
/// @throws InputError if the certificate's verdict is not "proved", or it states no margins.
/// @pre the checker has accepted it
[[nodiscard]] ProvedPath proved_path(const Certificate& certificate);

/// Tensions along all of it, for every load in K and every deviation within the tolerances: enclosed anew over pieces
/// of the proof's boxes and cut by the margins, which are all that is said where a piece can't be enclosed; rounded
/// outward.
[[nodiscard]] std::vector<TensionPiece> tension_pieces(const ProvedPath& proved);
/// Of a certificate that the checker has accepted. @throws as proved_path()
[[nodiscard]] std::vector<TensionPiece> tension_pieces(const checker::CheckResult& checked);

}  // namespace taut
