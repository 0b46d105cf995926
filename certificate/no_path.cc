// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/no_path.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>

#include "base/sha256.h"
#include "certificate/kernel_problem.h"
#include "checker/format/claims.h"
#include "checker/format/parts.h"

namespace taut {
namespace {

using checker::OutsideReason;
using nlohmann::json;

constexpr int kMostCellHalvings = 4;  ///< of a cell that the kernel does not prove at one go

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

std::vector<mpq_class> exact_shares(const std::vector<std::int64_t>& shares, int bits) {
  std::vector<std::int64_t> rounded;
  const std::int64_t whole = std::int64_t{1} << bits, unit = PointPair::kWhole / whole;
  for (const std::int64_t share : shares) rounded.push_back((share + unit / 2) / unit);
  if (!rounded.empty()) {
    *std::ranges::max_element(rounded) += whole - std::accumulate(rounded.begin(), rounded.end(), std::int64_t{0});
  }
  std::vector<mpq_class> result;
  for (const std::int64_t share : rounded) {
    result.emplace_back(mpz_class(static_cast<long>(share)), mpz_class(static_cast<long>(whole)));
    result.back().canonicalize();
  }
  return result;
}

checker::ContactWeights weights(const PointPair& points, int bits) {
  return {exact_shares(points.first, bits), exact_shares(points.second, bits)};
}

bool holds(const checker::OutsideProof& proof, const checker::ContactReason& reason) {
  try {
    return proof.holds(reason);
  } catch (const checker::Undefined&) {
    return false;
  }
}

double approximately(const checker::Ball& x) { return arf_get_d(arb_midref(x.get()), ARF_RND_NEAR); }

json to_json(const checker::ContactReason& reason) {
  const auto texts = [](const std::vector<mpq_class>& weights) {
    json list = json::array();
    for (const mpq_class& weight : weights) list.push_back(weight.get_str());
    return list;
  };
  json points = json::array();
  for (const checker::ContactWeights& of : reason.points) points.push_back(json::array({texts(of[0]), texts(of[1])}));
  return {{"pair", reason.pair}, {"points", std::move(points)}};
}

/// `contacts` and `contact_of_leaf` of a map: each reason once.
void add_contacts(const std::vector<checker::ContactReason>& of_leaves, json& map) {
  std::map<std::string, std::size_t> known;
  json contacts = json::array(), indices = json::array();
  for (const checker::ContactReason& reason : of_leaves) {
    json one = to_json(reason);
    const auto [at, is_new] = known.try_emplace(one.dump(), contacts.size());
    if (is_new) contacts.push_back(std::move(one));
    indices.push_back(at->second);
  }
  map["contacts"] = std::move(contacts);
  map["contact_of_leaf"] = std::move(indices);
}

}  // namespace

OutsideCells::OutsideCells(const Problem& problem)
    : proposer_(problem.bodies ? std::optional<Proposer>(Proposer{PoseSampler(problem), BodySampler(problem)})
                               : std::nullopt),
      problem_(to_kernel(problem)),
      space_(checker::cell_space(problem_)),
      machine_([&] {
        const checker::WorkingPrecision precision(kBits);
        return checker::StatedMachine(problem_);
      }()) {}

OutsidePart OutsideCells::tree(const std::vector<checker::CellPart>& cell, const FirstReason& first) const {
  const checker::WorkingPrecision precision(kBits);
  return halved(cell, first, 0);
}

std::optional<checker::ContactReason> OutsideCells::contact(const checker::OutsideProof& proof, const RigidPose& pose,
                                                            std::size_t pair) const {
  const auto found = proposer_->bodies.touching(proposer_->poses.model(), pose, pair);
  if (!found) return std::nullopt;
  // Few different weights make small certificates.
  for (const int bits : {2, 6, 30}) {
    checker::ContactReason reason{pair, {weights(found->nearest, bits)}};
    if (holds(proof, reason)) return reason;
  }
  if (!found->around) return std::nullopt;
  checker::ContactReason reason{pair, {}};
  for (const PointPair& points : *found->around) reason.points.push_back(weights(points, 0));
  return holds(proof, reason) ? std::optional(std::move(reason)) : std::nullopt;
}

OutsidePart OutsideCells::leaf(checker::OutsideProof& proof, const Parameters& parameters,
                               const FirstReason& first) const {
  std::optional<RigidPose> pose;
  const auto of_pair = [&](std::size_t pair) -> OutsidePart {
    if (!pose) {
      std::vector<double> middle;
      for (const checker::CellForm& x : parameters) middle.push_back(approximately(x.at));
      pose = proposer_->poses.rigid_pose(proposer_->poses.pose(middle));
    }
    auto reason = contact(proof, *pose, pair);
    if (!reason) return {};
    return {std::string(1, checker::kContactLeaf), {std::move(*reason)}};
  };
  if (first.pair) {
    if (OutsidePart found = of_pair(*first.pair); !found.tree.empty()) return found;
  }
  if (const auto reason = proved_reason(proof, first.limit)) return {std::string(1, letter(*reason)), {}};
  for (std::size_t pair = 0; proposer_ && pair < proposer_->bodies.bodies().pairs.size(); ++pair) {
    if (OutsidePart found = of_pair(pair); !found.tree.empty()) return found;
  }
  return {};
}

OutsidePart OutsideCells::halved(std::vector<checker::CellPart> cell, const FirstReason& first, int halvings) const {
  try {
    const Parameters parameters = checker::parameters(space_.axes, cell);
    checker::OutsideProof proof(machine_, parameters);
    if (OutsidePart found = leaf(proof, parameters, first); !found.tree.empty()) return found;
  } catch (const checker::Undefined&) {
    // the poses of so large a cell are not enclosed
  }
  const auto widest = std::ranges::min_element(cell, {}, &checker::CellPart::depth);
  if (halvings == kMostCellHalvings || widest->depth == checker::CellTree::kMaxDepth) return {};
  OutsidePart result{std::string(1, static_cast<char>('0' + (widest - cell.begin()))), {}};
  *widest = {2 * widest->k, widest->depth + 1};
  for (int side = 0; side < 2; ++side) {
    OutsidePart half = halved(cell, first, halvings + 1);
    if (half.tree.empty()) return {};
    result.tree += half.tree;
    std::ranges::move(half.contacts, std::back_inserter(result.contacts));
    ++widest->k;
  }
  return result;
}

std::string certificate_text(const Problem& problem, const NoPath& no_path, const SigningKey* key) {
  const json problem_json = to_json(problem);
  json map = {{"bits", OutsideCells::kBits}, {"tree", no_path.cells.tree}};
  if (problem.bodies) add_contacts(no_path.cells.contacts, map);
  json body = {{"claim", checker::no_path_claim(to_kernel(problem))},
               {"format", checker::kNoPathFormat},
               {"generator", {{"name", "taut"}, {"version", TAUT_VERSION}}},
               {"illustration", no_path.illustration},
               {"map", map},
               {"problem", problem_json},
               {"problem_sha256", sha256(problem_json)},
               {"verdict", "no path"},
               {"version", problem.bodies ? checker::kNoPathVersionWithBodies : checker::kNoPathVersion},
               {"waypoints", {no_path.from, no_path.from + 1}}};
  const std::string digest = sha256(body);
  body["footer"] = {{"nodes", no_path.cells.tree.size()}, {"sha256", digest}};
  if (key != nullptr) body["signature"] = key->signature(digest);
  return body.dump(1, ' ', true) + "\n";
}

}  // namespace taut
