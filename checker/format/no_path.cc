// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/no_path.h"

#include <algorithm>
#include <array>

#include "base/sha256.h"
#include "checker/format/claims.h"
#include "checker/format/expression_parser.h"
#include "checker/format/parts.h"
#include "checker/format/signature.h"
#include "checker/kernel/errors.h"

namespace taut::checker {

// ---- The tree -------------------------------------------------------------------------------------------------------

namespace {

using Kind = OutsideReason::Kind;

constexpr std::size_t kMaxNodes = std::size_t{1} << 30U;
/// The first letter of each kind; then come cables, and of each of them two sides.
constexpr std::array<std::pair<char, Kind>, 3> kFirstLetters = {
    {{'A', Kind::kLength}, {'a', Kind::kFollowing}, {'m', Kind::kFixed}}};

}  // namespace

char letter(const OutsideReason& reason) {
  const auto* const first = std::ranges::find(kFirstLetters, reason.kind, &std::pair<char, Kind>::second);
  return static_cast<char>(first->first + static_cast<char>(2 * reason.cable + reason.side));
}

std::optional<OutsideReason> CellTree::reason(std::size_t leaf) const {
  for (const auto& [first, kind] : kFirstLetters) {
    const int n = text_[leaf] - first;
    if (n < 0 || n >= static_cast<int>(2 * kCables)) continue;
    return OutsideReason{kind, static_cast<std::size_t>(n) / 2, static_cast<std::size_t>(n) % 2};
  }
  return std::nullopt;
}

bool CellTree::is_outside(std::size_t leaf) const { return text_[leaf] != kOpenLeaf; }
bool CellTree::is_contact(std::size_t leaf) const { return text_[leaf] == kContactLeaf; }

CellTree::CellTree(std::string text, std::size_t axes) : text_(std::move(text)) {
  const auto fail = [](const std::string& what) { throw Malformed("map.tree: expected " + what); };
  if (text_.size() > kMaxNodes) fail("at most 2^30 nodes");
  upper_.resize(text_.size());
  struct Open {
    std::uint32_t node;
    bool is_upper;  ///< whether its lower half is complete
  };
  std::vector<Open> open;  // the nodes above the next one
  std::array<int, kCellAxes> depth{};
  for (std::uint32_t node = 0; node < text_.size(); ++node) {
    if (node > 0 && open.empty()) fail("nothing behind the tree's last leaf");
    const bool is_known =
        !is_leaf(node) ? axis(node) < axes : !is_outside(node) || is_contact(node) || reason(node).has_value();
    if (!is_known) fail("an axis of the space, '.' or the letter of a reason, at node " + std::to_string(node));
    if (!is_leaf(node)) {
      if (++depth.at(axis(node)) > kMaxDepth) fail("no axis to be halved more than 30 times");
      open.push_back({node, false});
      continue;
    }
    while (!open.empty() && open.back().is_upper) {
      --depth.at(axis(open.back().node));
      open.pop_back();
    }
    if (open.empty()) continue;  // this was the last one
    open.back().is_upper = true;
    upper_[open.back().node] = node + 1;
  }
  if (text_.empty() || !open.empty()) fail("both halves of each cell that is halved");
}

// ---- The space ------------------------------------------------------------------------------------------------------

namespace {

/// Whether all poses repeat, by the form of their expressions, when parameter j grows by 2 pi.
bool repeats(const Problem& problem, std::size_t j) {
  for (std::size_t c = 0; c < 6; ++c) {
    const std::optional<long> k = turns(problem.pose[c], j);
    if (!k || (c < 3 && *k != 0)) return false;
  }
  return true;
}

CellFlip cell_flip(const Problem& problem) {
  const auto [phi, theta] = *problem.flip;
  CellFlip flip{phi, theta, {}};
  const Expression& sigma = problem.pose[5];
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    if (!mentions(sigma, j)) continue;
    const bool is_itself = sigma.nodes.size() == 1 && problem.parameters[j].kind == ParameterKind::kPeriodic;
    if (!is_itself) throw Malformed("problem.space.pose.sigma: expected a constant or a periodic parameter");
    flip.sigma = j;
  }
  return flip;
}

}  // namespace

CellSpace cell_space(const Problem& problem) {
  const std::size_t n = problem.parameters.size();
  if (n < 2 || n > kCellAxes) throw Malformed("problem.space.parameters: expected two or three");
  if (!problem.constraints.empty()) throw Malformed("problem.space.constraints: expected none");
  const auto constant = [](const char* text) { return parse_expression(text, {}, "axis"); };
  CellSpace space;
  for (std::size_t j = 0; j < n; ++j) {
    const Parameter& parameter = problem.parameters[j];
    if (problem.flip && (*problem.flip)[1] == j) {
      space.axes.push_back({CellAxis::Kind::kTilt, constant("0"), constant("pi")});
    } else if (parameter.kind == ParameterKind::kRange) {
      space.axes.push_back({CellAxis::Kind::kRange, parameter.lower, parameter.upper});
    } else if (repeats(problem, j)) {
      space.axes.push_back({CellAxis::Kind::kTurn, constant("-pi"), constant("pi")});
    } else {
      throw Malformed("problem.space.parameters[" + std::to_string(j) +
                      "]: expected a range, or an angle along which all poses repeat");
    }
  }
  if (problem.flip) space.flip = cell_flip(problem);
  return space;
}

// ---- The file -------------------------------------------------------------------------------------------------------

namespace {

auto is_digest(std::string_view digest) {
  return exactly(digest, "the digest of what the file contains: it was altered");
}

void require_version(const Cursor& top) {
  const Json version = top.json().value("version", Json());
  if (!version.is_number_integer() || version == kNoPathVersion || version == kNoPathVersionWithBodies) return;
  top["version"].fail(std::to_string(kNoPathVersion) + " or " + std::to_string(kNoPathVersionWithBodies) + ", got " +
                      version.dump() + ": only the taut-check that came with the taut that made it can check it");
}

ContactReason read_contact(const Cursor& json, const Problem& problem) {
  const Bodies& bodies = problem.bodies.value();
  json.require(!bodies.pairs.empty(), "no contact where no pair is checked");
  ContactReason result;
  const auto read_pair = [&](const Cursor& pair) {
    result.pair = static_cast<std::size_t>(pair.integer(0, static_cast<std::int64_t>(bodies.pairs.size()) - 1));
  };
  const auto read_points = [&](const Cursor& points) {
    const CheckedPair& of = bodies.pairs[result.pair];
    const bool may_be_four = of.kind != PairKind::kExitCone && !bodies.is_against_half_space(of);
    points.require(points.size() == 1 || (may_be_four && points.size() == 4),
                   may_be_four ? "the points of one or four places" : "the points of one place");
    points.elements([&](const Cursor& weights, std::size_t) {
      result.points.push_back(read_contact_weights(weights, result.pair, {}, problem));
    });
  };
  json.object("pair", read_pair, "points", read_points);
  return result;
}

/// `map`, where the problem has been read.
std::string read_map(const Cursor& json, NoPathCertificate& result) {
  std::string tree;
  const bool has_bodies = result.problem.bodies.has_value();
  const auto read_contacts = [&](const Cursor& contacts) {
    contacts.elements(
        [&](const Cursor& contact, std::size_t) { result.contacts.push_back(read_contact(contact, result.problem)); });
  };
  const auto read_indices = [&](const Cursor& indices) {
    const auto last = static_cast<std::int64_t>(result.contacts.size()) - 1;
    indices.elements([&](const Cursor& index, std::size_t) {
      result.contact_of_leaf.push_back(static_cast<std::size_t>(index.integer(0, last)));
    });
  };
  json.object("bits", integer(result.bits, 32, 4096), "tree", tree, has_bodies ? "contacts" : nullptr, read_contacts,
              has_bodies ? "contact_of_leaf" : nullptr, read_indices);
  const auto leaves = static_cast<std::size_t>(std::ranges::count(tree, kContactLeaf));
  if (leaves != result.contact_of_leaf.size()) {
    throw Malformed("map.contact_of_leaf: expected a number for each leaf of the tree with the letter of contact");
  }
  return tree;
}

}  // namespace

std::string no_path_claim(const Problem& problem) {
  std::string claim = kNoPathClaim;
  if (!problem.items.empty()) claim += kItemsClause;
  if (problem.bodies) claim += no_path_bodies_clause(problem.bodies->checks);
  if (problem.bodies && problem.bodies->has_zones()) claim += kContactZonesClause;
  if (problem.bodies && !problem.bodies->exit_cones.empty()) claim += kExitConesClause;
  return claim;
}

NoPathCertificate read_no_path(Outline outline) {
  const Cursor top(outline.json, "");
  require_version(top);
  NoPathCertificate result;
  std::string tree;
  const auto later = [](const Cursor& /*json*/) {};
  const auto read_problem_and_digest = [&](const Cursor& json) {
    is_digest(sha256(json.json()))(top["problem_sha256"]);
    result.problem = read_problem(json);
    json.require(!result.problem.bodies || !result.problem.bodies->has_meshes(), "a problem without meshes");
    json.require(!result.problem.time, "a problem without limits in time");
    exactly(result.problem.bodies ? kNoPathVersionWithBodies : kNoPathVersion)(top["version"]);
    exactly(no_path_claim(result.problem), "the text that belongs to the verdict")(top["claim"]);
  };
  const auto read_waypoints = [&](const Cursor& json) {
    json.require_size(2);
    const auto count = static_cast<std::int64_t>(result.problem.query.size());
    json.require(count >= 2, "waypoints of a query");
    const std::int64_t from = json.at(0).integer(0, count - 2);
    (void)json.at(1).integer(from + 1, from + 1);
    result.from = static_cast<std::size_t>(from);
  };
  const auto read_cells = [&](const Cursor& json) { tree = read_map(json, result); };
  top.object(
      "format", exactly(kNoPathFormat, "'taut-no-path-certificate'"), "version", later, "footer",
      [&](const Cursor& footer) { footer.object("sha256", is_digest(outline.body_sha256), "nodes", later); },
      "generator", [](const Cursor& json) { json.require(json.json().is_object(), "an object"); }, "illustration",
      later, "claim", later, "verdict", exactly("no path", "'no path'"), "problem", read_problem_and_digest,
      "problem_sha256", later, "waypoints", read_waypoints, "map", read_cells, "signature?",
      [&](const Cursor& json) { result.signer = verify_signature(json, outline.body_sha256); });
  const Cursor footer = top["footer"];
  exactly(tree.size())(footer["nodes"]);
  CellSpace space = cell_space(result.problem);
  result.tree = CellTree(std::move(tree), space.axes.size());
  result.axes = std::move(space.axes);
  result.flip = space.flip;
  result.problem_json = std::move(outline.json["problem"]);
  return result;
}

}  // namespace taut::checker
