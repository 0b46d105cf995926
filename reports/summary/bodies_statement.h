// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies of a problem, said again in m, mm and degrees, so that a slip of units or places shows.
//
// Nothing here is a claim of a proof: what is proved is the problem's own exact numbers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "case/bodies.h"
#include "problem/bodies.h"

namespace taut {

struct BodiesStatement {
  std::string checked;  ///< "Pairs and their clearances: platform and obstacles, 6 pairs, 200 mm; …. Not checked: …."
  std::string cables;      ///< diameters and free ends; empty where no class with cables is checked
  std::string contacts;    ///< which pairs may touch, where and how deep; empty where none may
  std::string exit_cones;  ///< where cables may leave their ends; empty where that is not stated
  /// Name and words, bodies of the platform first: "stack", "obstacle: a box of 2.4 × 6.1 × 2.6 m at (0, 1, 1.3) m, …".
  std::vector<std::pair<std::string, std::string>> bodies;
  std::vector<std::string> notes;  ///< clearances of single pairs; of a case, what prisms add and what meshes are
};

/// @pre the bodies are valid.
[[nodiscard]] BodiesStatement bodies_statement(const BodiesText& bodies);

/// The same of a case, which knows of cylinders and what is in meshes.
[[nodiscard]] BodiesStatement bodies_statement(const CaseBodies& bodies);

/// ", but where they may touch", or nothing where no pair may.
[[nodiscard]] const char* but_in_contacts(const BodiesText& bodies);
/// What a proved verdict says of bodies, after `before`: "; all checked bodies keep their clearances". Empty where
/// nothing is checked.
[[nodiscard]] std::string clear_bodies(const std::optional<BodiesText>& bodies, const char* before);

/// "'container' and 'stack'", "cable 3 and 'stack'", "cables 2 and 5".
[[nodiscard]] std::string pair_words(const BodiesText& bodies, const BodyPair& pair);
/// "platform and obstacles", "cables and obstacles", "cables among each other", "cables and platform".
[[nodiscard]] const char* words_of(PairClass kind);
/// Whether a body is a mesh, which was read, without an inside: only its surface is checked.
[[nodiscard]] bool has_no_inside(const BodyText& body);
/// The quoted names of those.
[[nodiscard]] std::vector<std::string> bodies_without_inside(const BodiesText& bodies);
/// The classes of pairs that are not checked.
[[nodiscard]] std::vector<PairClass> unchecked_classes(const BodiesText& bodies);
/// For JSON: `checked`, a list of `class`, `pairs` and `clearance_m`, `not_checked`, a list of classes, and `text`, the
/// sentences.
[[nodiscard]] nlohmann::json to_json(const BodiesText& bodies, const BodiesStatement& statement);

/// The same of a case; null where it has none.
[[nodiscard]] nlohmann::json stated_bodies_json(const std::optional<CaseBodies>& bodies);

/// A sentence each: pairs, cables, bodies, notes.
[[nodiscard]] std::vector<std::string> lines(const BodiesStatement& statement);

}  // namespace taut
