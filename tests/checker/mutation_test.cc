// SPDX-License-Identifier: GPL-3.0-or-later
// Every field of a certificate matters: alter one, and the checker must notice, or what is said must still be true.
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <regex>
#include <set>

#include "checker/check.h"
#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;
using Pointer = Json::json_pointer;

struct Mutant {
  std::string what;  ///< "/json/pointer: how"
  Json json;
};

/// Of so many alterations one is tried.
int share() { return is_sampled() ? 8 : 1; }

/// Calls `visit` with every one-place alteration of `original`.
void for_each_mutant(const Json& original, const std::function<void(const Mutant&)>& visit) {
  int count = 0;
  const std::function<void(const Pointer&)> walk = [&](const Pointer& at) {
    const Json& node = original[at];
    const auto alter = [&](const std::string& how, const Json& value) {
      if (value == node || ++count % share() != 0) return;
      Mutant mutant{at.to_string() + ": " + how, original};
      mutant.json[at] = value;
      visit(mutant);
    };
    for (const Json& value : {Json(nullptr), Json(true), Json(0), Json(""), Json("x"), Json::array(), Json::object()}) {
      alter("becomes " + value.dump(), value);
    }
    if (node.is_string()) {
      const auto text = node.get<std::string>();
      alter("gets an x", text + "x");
      alter("changes its sign", text[0] == '-' ? text.substr(1) : "-" + text);
      alter("gets a leading 2", text[0] == '-' ? "-2" + text.substr(1) : "2" + text);
      for (const char* value : {"nan", "inf", "1e400", "-1e400", "1e-400", "1e5000", "0x1p+0"}) {
        alter(std::string("becomes ") + value, value);
      }
    } else if (node.is_number_integer()) {
      for (const std::int64_t step : {-1, 1, 2}) alter("plus " + std::to_string(step), node.get<std::int64_t>() + step);
      alter("becomes huge", std::int64_t{1} << 62);
      alter("becomes a string", node.dump());
    } else if (node.is_array()) {
      Json shorter = node, longer = node, reversed = node;
      if (!node.empty()) {
        shorter.erase(shorter.size() - 1);
        alter("loses its last", shorter);
        longer.push_back(node.back());
        alter("gets one more", longer);
        std::reverse(reversed.begin(), reversed.end());
        alter("is reversed", reversed);
      }
      for (std::size_t i = 0; i < node.size(); ++i) walk(at / i);
    } else if (node.is_object()) {
      Json longer = node;
      longer["extra"] = "1";
      alter("gets a key", longer);
      for (const auto& item : node.items()) {
        Json shorter = node;
        shorter.erase(item.key());
        alter("loses " + item.key(), shorter);
        shorter[item.key() + "_"] = item.value();
        alter("renames " + item.key(), shorter);
        walk(at / item.key());
      }
    }
  };
  walk(Pointer());
}

TEST(Mutation, WithoutNewDigestsNothingPasses) {
  for (const char* name :
       {"robot1_start_is_goal", "robot2_sphere", "refuted_singular", "spline_flipped", "implied_start_is_goal",
        "refuted_implied_singular", "geodesic_still", "lengths_still", "lengths_inner_still", "tight_position",
        "refuted_by_a_deviation", "refuted_by_held_anchors_and_lengths", "loads_exact", "refuted_by_loads", "contact",
        "legs"}) {
    int mutants = 0;
    for_each_mutant(accepted(name), [&](const Mutant& mutant) {
      EXPECT_EQ(check(mutant.json.dump()).outcome, Outcome::kMalformed) << name << mutant.what;
      ++mutants;
    });
    EXPECT_GT(mutants, 1000 / share());
  }
}

/// The alterations below `root` that are accepted although they were sealed.
std::set<std::string> accepted_mutants(const Json& original, const std::string& root) {
  std::set<std::string> result;
  for_each_mutant(original, [&](Mutant mutant) {
    const bool sealed_away = mutant.what.starts_with("/footer") || mutant.what.starts_with(": loses footer") ||
                             mutant.what.find("_sha256") != std::string::npos;
    if (sealed_away || !mutant.what.starts_with(root)) return;
    if (original.contains("legs")) {
      seal_legs(mutant.json);
    } else {
      seal(mutant.json);
    }
    if (check(mutant.json.dump()).outcome == Outcome::kAccepted) result.insert(mutant.what);
  });
  return result;
}

struct Rule {
  const char* why;
  std::regex what;
  bool of_zero = false;  ///< only where the original is "0" or "0x0p+0"
  int uses = 0;
};

/// What only says how the kernel is to find a proof: alterations with which it still finds one prove the same claim.
const char* const kHow =
    "/(segments/./boxes/.|witness/(motion/.|proof|at_proof|to_proof|deviation/way/boxes/.)|stretches/.*proof)"
    "/(bits|parts|guesses|near/(at/.|slope/.|radius|narrowings)): .*"
    "|.*/near/(at|slope): is reversed|/witness/motion: gets one more"
    "|/witness/deviation/way/poses/./tube/(position|turn): .*";

/// Each accepted alteration below `root` is one of these, and each of these occurs.
void expect_accepted_mutants(const std::string& name, const std::string& root, std::vector<Rule> rules) {
  const Json original = accepted(name);
  for (const std::string& what : accepted_mutants(original, root)) {
    const Pointer at(what.substr(0, what.find(": ")));
    static const std::regex how(kHow);
    if (std::regex_match(what, how)) continue;
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const Rule& r) {
      return std::regex_match(what, r.what) && (!r.of_zero || original[at] == "0" || original[at] == "0x0p+0");
    });
    if (rule == rules.end()) {
      ADD_FAILURE() << "accepted: " << what;
    } else {
      ++rule->uses;
    }
  }
  if (share() > 1) return;
  for (const Rule& rule : rules) EXPECT_GT(rule.uses, 0) << rule.why;
}

TEST(Mutation, WithNewDigestsOnlyTrueStatementsPass) {
  expect_accepted_mutants(
      "robot1_start_is_goal", "",
      {{"Who wrote it, what it is called and its pictures prove nothing.",
        std::regex("/(generator|illustration|problem/name).*")},
       {"-0 is 0.", std::regex("/problem/.*: changes its sign"), true},
       {"Far less than the 0.5 % between the margins claimed and the true ones.",
        std::regex("/problem/.*: becomes 1e-400"), true},
       {"A higher upper limit.",
        std::regex("/problem/robot/(tension_N|length_m)/./1: (gets a leading 2|becomes 1e400)")},
       {"A lower lower limit.", std::regex("/problem/robot/(tension_N|length_m)/./0: becomes 1e-400")},
       {"A larger E is a smaller K.", std::regex("/problem/load/ellipsoid/(.)/\\1: (gets a leading 2|becomes 1e400)")},
       {"Start and goal are one: the query may say so once, twice or three times.",
        std::regex("/problem/query/waypoints: (gets one more|loses its last)")},
       {"An audit of the same path.", std::regex("/problem/query/waypoints: becomes \\[\\]")},
       {"A constant that nothing uses.", std::regex("/problem/space/constants: gets a key")},
       {"The path does not use the flip.", std::regex("/problem/space/flip: becomes null")},
       {"Another robot, of which the claim holds as well (by the equations of make_bases.py).",
        std::regex("/problem/robot/base_anchors_m/(2/0|4/1|5/1): becomes 1e-400|"
                   "/problem/robot/(base|platform)_anchors_m: is reversed")}});
}

TEST(Mutation, OfAnglesOnlyTrueStatementsPass) {
  const std::string axis = "/problem/space/angles/axis";
  expect_accepted_mutants("robot1_axis", axis,
                          {{"Other axes about which the claim holds as well (by the equations of make_bases.py).",
                            std::regex(axis + "/(0: (changes its sign|becomes 1e-400)|2: gets a leading 2)")}});
  expect_accepted_mutants("robot1_roll_pitch_yaw", "/problem/space/angles", {});
}

TEST(Mutation, OfASplineOnlyTrueStatementsPass) { expect_accepted_mutants("spline_flipped", "/path", {}); }

TEST(Mutation, OfAnImpliedMotionOnlyTrueStatementsPass) {
  const Rule minus_zero = {"-0 is 0.", std::regex("/path/waypoints/./x/.: changes its sign"), true};
  const Rule other_normals = {"Any normals will do that do not lie in the surface.",
                              std::regex("/path/waypoints/./normals/.: (becomes 0x1p\\+0|changes its sign)")};
  expect_accepted_mutants("implied_start_is_goal", "/path", {minus_zero, other_normals});
  expect_accepted_mutants(
      "implied_start_is_goal", "/problem/space",
      {{"The radius stands squared.", std::regex("/problem/space/constants/rs: changes its sign")},
       {"A constant that nothing uses.", std::regex("/problem/space/constants: gets a key")},
       {"The path does not use the flip.", std::regex("/problem/space/flip: becomes null")},
       {"sigma is 0.", std::regex("/problem/space/pose/sigma: (becomes 1e-400|changes its sign)")}});
  expect_accepted_mutants("implied_within_range", "/path",
                          {minus_zero,
                           other_normals,
                           {"A wider tube, with one motion too.", std::regex("/path/tubes/0: becomes 0x1p\\+0")}});
  expect_accepted_mutants("implied_within_range", "/problem/space/constraints", {});
}

TEST(Mutation, OfLawsOfPosesOnlyTrueStatementsPass) {
  const Rule minus_zero = {"-0 is 0.", std::regex("/path/waypoints/./position/.: changes its sign"), true};
  expect_accepted_mutants("geodesic_still", "/path", {minus_zero});
  expect_accepted_mutants("lengths_still", "/path", {minus_zero});
  expect_accepted_mutants(
      "lengths_inner_still", "/path",
      {minus_zero, {"-0 is 0.", std::regex("/path/pose_tubes/0/inner/0/position/.: changes its sign"), true}});
}

TEST(Mutation, OfLegsThatMeetOnOneMachineNothingMayDiffer) {
  for (const char* of_leg : {"/legs/1/path", "/legs/1/problem/robot", "/legs/1/problem/space"}) {
    EXPECT_EQ(accepted_mutants(accepted("legs"), of_leg), std::set<std::string>{}) << of_leg;
  }
  EXPECT_EQ(accepted_mutants(accepted("legs_of_moves"), "/legs/1/problem/time"), std::set<std::string>{});
  for (const char* of_bodies :
       {"cables", "clearance_m", "obstacles/0/at_m", "obstacles/0/half_space", "pair_clearances_m/0"}) {
    const std::string root = std::string("/legs/1/problem/bodies/") + of_bodies;
    EXPECT_EQ(accepted_mutants(accepted("legs_with_bodies"), root), std::set<std::string>{}) << root;
  }
}

TEST(Mutation, OfBodiesOnlyTrueStatementsPass) {
  expect_accepted_mutants("contact", "/witness",
                          {{"They are in contact at the other waypoints, too.", std::regex("/witness/at/waypoint: .*")},
                           {"A lesser depth.", std::regex("/witness/depth_m: becomes 1e-400")},
                           {"-0 is 0.", std::regex("/witness/weights/./.: changes its sign"), true}});
  expect_accepted_mutants("contact_around_a_point", "/witness/around",
                          {{"They are around the point in any order.", std::regex("/witness/around: is reversed")},
                           {"-0 is 0.", std::regex("/witness/around/././.: changes its sign"), true}});
  // A direction only says how: whatever it is, what is claimed is proved along it, or not at all.
  expect_accepted_mutants("clearance_of_obstacles", "/segments/0/apart",
                          {{"Another direction will do.", std::regex("/segments/0/apart/.*: (plus .*|becomes 0)")}});
  expect_accepted_mutants("clearance_of_obstacles", "/directions", {});
  // Bodies that state something else are proved, too, if that is true; comparing with the case is what refuses them.
  expect_accepted_mutants("clearance_of_obstacles", "/problem/bodies/clearance_m",
                          {{"A smaller clearance.", std::regex("/.*: (becomes 1e-400|changes its sign)")}});
}

/// What is left when all that only says how is left out.
std::set<std::string> claims(std::set<std::string> accepted) {
  static const std::regex how(kHow);
  std::erase_if(accepted, [](const std::string& what) { return std::regex_match(what, how); });
  return accepted;
}

TEST(Mutation, OfHowItIsProvedNoAlterationIsAFault) {
  // Each is accepted, rejected, or malformed; none is an error of the program, and most are noticed.
  for (const char* name : {"implied_start_is_goal", "lengths_inner_still", "tight_position",
                           "refuted_by_held_anchors_and_lengths", "refuted_implied_singular"}) {
    int noticed = 0;
    int tried = 0;
    static const std::regex how(kHow);
    for_each_mutant(accepted(name), [&](Mutant mutant) {
      if (!std::regex_match(mutant.what, how)) return;
      seal(mutant.json);
      const Outcome outcome = check(mutant.json.dump()).outcome;
      EXPECT_TRUE(outcome == Outcome::kAccepted || outcome == Outcome::kRejected || outcome == Outcome::kMalformed)
          << name << mutant.what;
      ++tried;
      noticed += outcome == Outcome::kAccepted ? 0 : 1;
    });
    EXPECT_GT(tried, 20 / share()) << name;
    EXPECT_GT(noticed, tried / 2) << name;
  }
}

TEST(Mutation, OfTolerancesOnlyTrueStatementsPass) {
  const Rule minus_zero = {"-0 is 0.", std::regex("/.*: changes its sign"), true};
  const Rule tiny = {"Far less than the 0.4 % that the margin claimed leaves, or a smaller tolerance.",
                     std::regex("/.*: becomes 1e-400")};
  expect_accepted_mutants("tight_position", "/problem/tolerances", {minus_zero, tiny});
  expect_accepted_mutants("refuted_by_a_deviation", "/witness/deviation", {minus_zero});
  const Rule no_load = {"No load deviates.", std::regex("/witness/deviation/wrench: becomes 1e-400")};
  expect_accepted_mutants("refuted_by_held_lengths", "/witness/deviation", {minus_zero, no_load});
  expect_accepted_mutants("refuted_by_held_anchors", "/witness/deviation", {minus_zero, no_load});
  const Rule larger = {"A larger tolerance allows the deviation, too.",
                       std::regex("/problem/tolerances/.*: (becomes -?1e400|gets a leading .)")};
  const Rule needless = {"Only lengths deviate.", std::regex("/problem/tolerances/(?!cable_length).*: becomes 1e-400")};
  expect_accepted_mutants("refuted_by_held_lengths", "/problem/tolerances", {minus_zero, larger, needless});
}

TEST(Mutation, AWitnessMayOnlyBeStatedMoreLoosely) {
  if (share() > 1) GTEST_SKIP() << "tries all of them";
  EXPECT_EQ(claims(accepted_mutants(accepted("refuted_tension_min"), "/witness")),
            (std::set<std::string>{"/witness/value/0: becomes -1e400", "/witness/value/0: gets a leading 2",
                                   "/witness/value/1: becomes 1e-400"}));  // both ends of it are negative
  EXPECT_EQ(claims(accepted_mutants(accepted("refuted_singular"), "/witness")), std::set<std::string>{});
  EXPECT_EQ(claims(accepted_mutants(accepted("refuted_implied_singular"), "/witness")), std::set<std::string>{});
  EXPECT_EQ(claims(accepted_mutants(accepted("refuted_spline_singular"), "/witness")), std::set<std::string>{});
}

TEST(Mutation, AWitnessInsideAStretchMayOnlyBeStatedMoreLoosely) {
  if (share() > 1) GTEST_SKIP() << "tries all of them";
  EXPECT_EQ(claims(accepted_mutants(accepted("stretches_of_a_graver_witness"), "/witness")),
            (std::set<std::string>{"/witness/value/1: becomes 1e400", "/witness/value/1: gets a leading 2"}));
  EXPECT_EQ(claims(accepted_mutants(accepted("stretches_of_a_singular_witness"), "/witness")), std::set<std::string>{});
}

TEST(Mutation, ACutFileIsMalformed) {
  const std::string text = read_text(TAUT_CERTIFICATES "/accepted/robot1_near_start.json");
  const std::size_t end = text.find_last_of('}');
  for (std::size_t length = 0; length <= end; length += 97) {
    EXPECT_EQ(check(text.substr(0, length)).outcome, Outcome::kMalformed) << length;
  }
  EXPECT_EQ(check(text.substr(0, end)).outcome, Outcome::kMalformed);
}

TEST(Mutation, AFlippedBitIsMalformed) {
  const std::string text = read_text(TAUT_CERTIFICATES "/accepted/robot1_near_goal.json");
  std::mt19937 random(6);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string flipped = text;
    char& byte = flipped[random() % text.size()];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << (random() % 8)));
    EXPECT_EQ(check(flipped).outcome, Outcome::kMalformed) << trial;
  }
}

TEST(Mutation, HostileTextsAreMalformed) {
  const std::string huge_integer = "{\"version\": 123456789012345678901234567890}";
  for (const std::string& text :
       {std::string("null"), std::string("[]"), std::string("{}"), std::string("\"taut\""), huge_integer,
        std::string("{\"a\":1e999}"), std::string("\xff\xfe"), std::string("{\"a\":\"\xc3\"}"), std::string("[NaN]"),
        std::string("{\"a\":1,}"), std::string("// {}"), std::string(1 << 20, '['), std::string(1 << 20, '{'),
        std::string("\0", 1)}) {
    EXPECT_EQ(check(text).outcome, Outcome::kMalformed) << text.substr(0, 40);
  }
}

}  // namespace
}  // namespace taut::checker
