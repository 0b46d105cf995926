// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/headroom_of_legs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "problem/decimal.h"
#include "reports/summary/headroom_summary.h"

namespace taut {
namespace {

const ProvableShare* share_of(const LegHeadroom& leg, const Uncertainty& of) {
  const auto found = std::ranges::find_if(leg.headroom->shares, [&](const auto& share) { return share.of == of; });
  return found == leg.headroom->shares.end() ? nullptr : &*found;
}

const LoadItem* item_of(const LegHeadroom& leg, const std::string& name) {
  const auto found = std::ranges::find(leg.problem.load.items, name, &LoadItem::name);
  return found == leg.problem.load.items.end() ? nullptr : &*found;
}

bool is_about_the_leg(const std::optional<Headroom>& headroom) {
  return headroom && !headroom->shares.empty() && headroom->shares.front().of == UncertaintyKind::kAll &&
         (headroom->subject == Headroom::Subject::kPath || headroom->subject == Headroom::Subject::kMove);
}

/// The least share of an uncertainty; nothing where it is not one thing in the legs, or not known of one.
std::optional<CommonShare> least(std::span<const LegHeadroom> legs, const Uncertainty& of) {
  const bool is_item = of.kind == UncertaintyKind::kLoadItem;
  const LoadItem* item = nullptr;
  std::optional<CommonShare> result;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    if (is_item) {
      const LoadItem* const here = item_of(legs[k], of.item);
      if (here == nullptr) continue;
      if (item != nullptr && !(*item == *here)) return std::nullopt;
      item = here;
    }
    const ProvableShare* const share = share_of(legs[k], of);
    if (share == nullptr) return std::nullopt;
    // A load's tolerance that is not stated grows along each leg's own load.
    if (of.kind == UncertaintyKind::kLoad && share->stated == 0) return std::nullopt;
    const bool is_less = result && Decimal::parse(share->share) < Decimal::parse(result->share.share);
    if (!result || is_less) result = {*share, k};
  }
  return result;
}

}  // namespace

std::vector<CommonShare> common_shares(std::span<const LegHeadroom> legs) {
  std::vector<CommonShare> result;
  if (!std::ranges::all_of(legs, [](const LegHeadroom& leg) { return is_about_the_leg(leg.headroom); })) return result;
  std::vector<Uncertainty> seen;
  for (const LegHeadroom& leg : legs) {
    for (const ProvableShare& share : leg.headroom->shares) {
      if (std::ranges::find(seen, share.of) != seen.end()) continue;
      seen.push_back(share.of);
      if (auto found = least(legs, share.of)) result.push_back(*std::move(found));
    }
  }
  return result;
}

std::vector<std::string> headroom_sentences(std::span<const LegHeadroom> legs, const DisplayUnits& units) {
  const std::vector<CommonShare> shares = common_shares(legs);
  if (shares.empty()) return {};
  constexpr const char* kAll = "all tolerances and deviations of the load";
  const CommonShare& all = shares.front();
  const std::string& leg = legs[all.leg].name;
  const std::string ended = all.share.is_complete ? "" : " (the search ended when its time did)";
  std::vector<std::string> result = {
      all.share.share == "0"
          ? fmt::format("The legs have no provable share of {} in common: {} has none{}.", kAll, leg, ended)
          : fmt::format("All legs are provable at {} of {}, together{}: {} has the least.",
                        percent_text(all.share.share), kAll, ended, leg)};
  std::string list;
  for (const CommonShare& common : shares) {
    Headroom alone;
    alone.shares = {common.share};
    for (const EachAlone& each : each_alone(alone, legs[common.leg].problem, units)) {
      list += fmt::format("{}{} {}, {}", list.empty() ? "" : "; ", each.what, each.words(), legs[common.leg].name);
    }
  }
  if (!list.empty()) {
    result.push_back(fmt::format(
        "Each alone, with all others as stated, in every leg that has it, and the leg with the least: {}.", list));
  }
  return result;
}

nlohmann::json headroom_json(std::span<const LegHeadroom> legs) {
  const std::vector<CommonShare> shares = common_shares(legs);
  if (shares.empty()) return {};
  nlohmann::json list = nlohmann::json::array();
  for (const CommonShare& common : shares) {
    Headroom alone;
    alone.shares = {common.share};
    nlohmann::json share = to_json(alone)["shares"][0];
    share["leg"] = legs[common.leg].name;
    list.push_back(std::move(share));
  }
  return {{"shares", std::move(list)}};
}

}  // namespace taut
