// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/no_path.h"

#include <algorithm>
#include <optional>

#include "base/sha256.h"
#include "checker/format/claims.h"
#include "checker/format/parts.h"

namespace taut {
namespace {

using checker::OutsideReason;
using nlohmann::json;

constexpr int kMostHalvings = 4;  ///< of a cell that the kernel does not prove at one go

checker::Problem to_kernel(const Problem& problem) {
  const json text = to_json(problem);
  return checker::read_problem(checker::Cursor(text, "problem"));
}

/// All reasons, those of one cable and side first.
std::vector<OutsideReason> reasons(const OutsideReason& first) {
  using Kind = OutsideReason::Kind;
  std::vector<OutsideReason> result = {first};
  const auto add = [&](const OutsideReason& reason) {
    if (std::ranges::find(result, reason) == result.end()) result.push_back(reason);
  };
  for (const Kind kind : {Kind::kFollowing, Kind::kFixed}) add({kind, first.cable, first.side});
  for (const Kind kind : {Kind::kFollowing, Kind::kFixed, Kind::kLength}) {
    for (std::size_t n = 0; n < 2 * checker::kCables; ++n) add({kind, n / 2, n % 2});
  }
  return result;
}

std::optional<OutsideReason> proved_reason(checker::OutsideProof& proof, const OutsideReason& first) {
  for (const OutsideReason& reason : reasons(first)) {
    try {
      if (proof.holds(reason)) return reason;
    } catch (const checker::Undefined&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace

OutsideCells::OutsideCells(const Problem& problem)
    : problem_(to_kernel(problem)), space_(checker::cell_space(problem_)), machine_([&] {
        const checker::WorkingPrecision precision(kBits);
        return checker::StatedMachine(problem_);
      }()) {}

std::string OutsideCells::tree(const std::vector<checker::CellPart>& cell, const OutsideReason& first) const {
  const checker::WorkingPrecision precision(kBits);
  return halved(cell, first, 0);
}

std::string OutsideCells::halved(std::vector<checker::CellPart> cell, const OutsideReason& first, int halvings) const {
  try {
    checker::OutsideProof proof(machine_, checker::parameters(space_.axes, cell));
    if (const auto reason = proved_reason(proof, first)) return {letter(*reason)};
  } catch (const checker::Undefined&) {
    // the poses of so large a cell are not enclosed
  }
  const auto widest = std::ranges::min_element(cell, {}, &checker::CellPart::depth);
  if (halvings == kMostHalvings || widest->depth == checker::CellTree::kMaxDepth) return "";
  std::string result(1, static_cast<char>('0' + (widest - cell.begin())));
  *widest = {2 * widest->k, widest->depth + 1};
  for (int side = 0; side < 2; ++side) {
    const std::string half = halved(cell, first, halvings + 1);
    if (half.empty()) return "";
    result += half;
    ++widest->k;
  }
  return result;
}

std::string certificate_text(const Problem& problem, const NoPath& no_path, const SigningKey* key) {
  const json problem_json = to_json(problem);
  const bool has_items = problem_json["load"].contains("items");
  json body = {{"claim", checker::kNoPathClaim + std::string(has_items ? checker::kItemsClause : "")},
               {"format", checker::kNoPathFormat},
               {"generator", {{"name", "taut"}, {"version", TAUT_VERSION}}},
               {"illustration", no_path.illustration},
               {"map", {{"bits", OutsideCells::kBits}, {"tree", no_path.tree}}},
               {"problem", problem_json},
               {"problem_sha256", sha256(problem_json)},
               {"verdict", "no path"},
               {"version", checker::kNoPathVersion},
               {"waypoints", {no_path.from, no_path.from + 1}}};
  const std::string digest = sha256(body);
  body["footer"] = {{"nodes", no_path.tree.size()}, {"sha256", digest}};
  if (key != nullptr) body["signature"] = key->signature(digest);
  return body.dump(1, ' ', true) + "\n";
}

}  // namespace taut
