// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/legs.h"

#include <algorithm>

#include "checker/format/claims.h"
#include "checker/format/cursor.h"
#include "checker/format/signature.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

constexpr std::array<std::pair<const char*, Verdict>, 3> kVerdicts = {
    {{"proved", Verdict::kProved}, {"refuted", Verdict::kRefuted}, {"undecided", Verdict::kUndecided}}};

Leg read_leg(std::size_t k, std::string_view text) {
  const std::string name = "legs[" + std::to_string(k) + "]";
  try {
    Leg leg{text, read_certificate(text)};
    const Problem& problem = leg.certificate.problem;
    if (problem.query.empty()) throw Malformed("problem.query.waypoints: expected those of a planned path");
    if (!problem.constraints.empty()) throw Malformed("problem.space.constraints: expected none of a leg");
    return leg;
  } catch (const Malformed& error) {
    throw Malformed(name + ": " + error.what());
  }
}

/// What follows from the legs.
Verdict verdict_of(const LegsCertificate& of) {
  const auto is = [](Verdict verdict) { return [=](const Leg& leg) { return leg.certificate.verdict == verdict; }; };
  if (std::ranges::any_of(of.legs, is(Verdict::kRefuted))) return Verdict::kRefuted;
  return std::ranges::all_of(of.legs, is(Verdict::kProved)) ? Verdict::kProved : Verdict::kUndecided;
}

std::string claim_of(const LegsCertificate& of) {
  switch (of.verdict) {
    case Verdict::kProved: {
      return legs_proved_claim(of.legs.size(), of.legs.front().certificate.path.timing.has_value());
    }
    case Verdict::kRefuted: return legs_refuted_claim(of.legs.size(), of.first_refuted + 1);
    case Verdict::kUndecided: break;
  }
  return kLegsUndecidedClaim;
}

}  // namespace

bool is_of_legs(const Outline& outline) {
  return outline.json.is_object() && outline.json.value("format", Json()) == "taut-certificate" &&
         outline.json.value("version", Json()) == kVersionOfLegs;
}

std::vector<std::string_view> leg_texts(const Outline& outline) {
  std::vector<std::string_view> texts;
  const auto list = outline.lists.find("legs");
  if (list == outline.lists.end()) return texts;
  for_each_element(list->second, [&](const Json& /*leg*/, std::string_view text) { texts.push_back(text); });
  return texts;
}

LegsCertificate read_legs(const Outline& outline) {
  const Cursor top(outline.json, "");
  LegsCertificate result;
  const auto later = [](const Cursor& /*json*/) {};
  const auto read_list = [&](const Cursor& json) {
    (void)json.size();
    const std::vector<std::string_view> texts = leg_texts(outline);
    json.require(texts.size() >= kLeastLegs && texts.size() <= kMostLegs, "2 to 64 legs");
    for (const std::string_view text : texts) result.legs.push_back(read_leg(result.legs.size(), text));
    result.verdict = verdict_of(result);
    for (const Leg& leg : result.legs) {
      if (leg.certificate.verdict == Verdict::kRefuted) break;
      ++result.first_refuted;
    }
  };
  const auto read_verdict = [&](const Cursor& json) {
    const auto stated = json.one_of<Verdict>(kVerdicts, "proved, refuted or undecided");
    json.require(stated == result.verdict, "the verdict that follows from those of the legs");
  };
  const auto read_footer = [&](const Cursor& footer) {
    footer.object("sha256", exactly(outline.body_sha256, "the digest of what the file contains: it was altered"),
                  "legs", later);
  };
  top.object(
      "format", exactly("taut-certificate", "'taut-certificate'"), "version",
      exactly(static_cast<std::size_t>(kVersionOfLegs)), "footer", read_footer, "generator",
      [](const Cursor& json) { json.require(json.json().is_object(), "an object"); }, "illustration", later, "legs",
      read_list, "verdict", read_verdict, "claim", later, "signature?",
      [&](const Cursor& json) { result.signer = verify_signature(json, outline.body_sha256); });
  exactly(claim_of(result), "the text that belongs to the verdict")(top["claim"]);
  const Cursor footer = top["footer"];
  exactly(result.legs.size())(footer["legs"]);
  return result;
}

}  // namespace taut::checker
