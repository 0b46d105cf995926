// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies of a problem, said again in m, mm and degrees, so that a slip of units or places shows.
//
// Nothing here is a claim of a proof: what is proved is the problem's own exact numbers.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "case/bodies.h"
#include "problem/bodies.h"

namespace taut {

struct BodiesStatement {
  std::string checked;  ///< "Pairs and their clearances: platform and obstacles, 6 pairs, 200 mm; …. Not checked: …."
  std::string cables;  ///< diameters and free ends; empty where no class with cables is checked
  /// Name and words, bodies of the platform first: "stack", "obstacle: a box of 2.4 × 6.1 × 2.6 m at (0, 1, 1.3) m, …".
  std::vector<std::pair<std::string, std::string>> bodies;
  std::vector<std::string> notes;  ///< clearances of single pairs; of a case, what prisms add and what meshes are
};

/// @pre the bodies are valid.
[[nodiscard]] BodiesStatement bodies_statement(const BodiesText& bodies);

/// The same of a case, which knows of cylinders and what is in meshes.
[[nodiscard]] BodiesStatement bodies_statement(const CaseBodies& bodies);

/// A sentence each: pairs, cables, bodies, notes.
[[nodiscard]] std::vector<std::string> lines(const BodiesStatement& statement);

}  // namespace taut
