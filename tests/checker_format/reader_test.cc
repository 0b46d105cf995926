// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of each kind, and what becomes of them after one edit: a base, a JSON patch, and the expected message.
#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <memory>

#include "base/sha256.h"
#include "checker/format/claims.h"
#include "checker/format/exact.h"
#include "checker/format/parts.h"
#include "checker/format/strict_json.h"
#include "checker/format/writer.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;

const std::string kOutside = "witness: expected a place between the outer ends of a violated stretch";

std::string canonical(const Json& json) { return json.dump(-1, ' ', true); }

std::string digest(const Json& json) { return sha256(json); }

Json repeated(std::size_t n, const Json& value) { return Json(n, value); }

Json numbers(std::initializer_list<double> values) {
  Json result = Json::array();
  for (const double x : values) result.push_back(print_binary64(x));
  return result;
}

Json problem() {
  Json ellipsoid = repeated(6, repeated(6, "0"));
  for (std::size_t i = 0; i < 6; ++i) ellipsoid[i][i] = "10000";
  const Json anchor = {"0", "0.22", "1e-1"};
  return {{"name", "a case"},
          {"robot",
           {{"base_anchors_m", repeated(6, anchor)},
            {"platform_anchors_m", repeated(6, anchor)},
            {"tension_N", repeated(6, {"0.05", "0.5"})},
            {"length_m", repeated(6, {"0.1", "0.55"})}}},
          {"load", {{"point_m", anchor}, {"wrench", {"0", "0", "1", "0", "0", "0"}}, {"ellipsoid", ellipsoid}}},
          {"tolerances", nullptr},
          {"space", coordinate_space()},
          {"query", {{"waypoints", Json::array()}}}};
}

Json tolerances() {
  return {{"base_anchor_m", repeated(6, "0.001")},
          {"platform_anchor_m", repeated(6, "0.001")},
          {"load_point_m", "0.002"},
          {"wrench", repeated(6, "-0.1")},
          {"position_m", "0.001"},
          {"orientation_rad", "(0.2)*pi/180"},
          {"cable_length_m", nullptr}};
}

Json waypoint() { return {{"x", numbers({0, 0, 0.35, 0, 0, 0.5})}, {"half_turns", repeated(6, 0)}}; }

Json box(const char* begin, const char* end) { return {{"bits", 64}, {"s", {begin, end}}}; }

Json segment(int k) {
  return {{"from", k},
          {"to", k + 1},
          {"boxes", {box("0", "1/2"), box("1/2", "1")}},
          {"margins", {{"tension_N", "0.0" + std::to_string(k + 1)}, {"length_m", "1e-2"}, {"wrench_scale", "2"}}}};
}

/// A proved audit of two segments that are straight in the free coordinates.
Json proved() {
  return {{"format", "taut-certificate"},
          {"version", 4},
          {"generator", {{"name", "taut"}}},
          {"verdict", "proved"},
          {"claim", kProvedClaim},
          {"problem", problem()},
          {"path",
           {{"interpolation", "straight-in-parameters"},
            {"waypoints", repeated(3, waypoint())},
            {"tubes", Json::array()},
            {"pose_tubes", Json::array()},
            {"times", {"0", "1.5", "2"}}}},
          {"segments", {segment(0), segment(1)}},
          {"margins", {{"tension_N", "0.01"}, {"length_m", "1e-2"}, {"wrench_scale", "2"}}},
          {"witness", nullptr},
          {"stretches", nullptr},
          {"source", {{"file", "path \"\u00fc\x7f\".csv"}, {"sha256", std::string(64, 'a')}}},
          {"undecided", nullptr},
          {"illustration", {{"kind", "audit"}, {"charts", {{1, 2, 3}, nullptr, true}}}}};
}

Json near(std::size_t unknowns) {
  const Json zeros = repeated(unknowns, "0x0p+0");
  return {{"at", zeros}, {"slope", zeros}, {"radius", "0x1p-20"}, {"narrowings", 2}};
}

Json witness() {
  return {{"at", {{"segment", 0}, {"s", "1/4"}}},
          {"cable", 3},
          {"kind", "tension_min"},
          {"limit", "0.05"},
          {"value", {"0.04", "0.05"}},
          {"proof", {{"bits", 64}}},
          {"motion", Json::array()}};
}

/// The same path, violated in [1/4, 1/2] of segment 0, and open in the second half of segment 1.
Json refuted() {
  Json json = proved();
  json["verdict"] = "refuted";
  json["claim"] = kRefutedClaim;
  json["margins"] = Json::object();
  json["segments"][0]["boxes"] = {box("0", "1/4"), box("1/2", "1")};
  json["segments"][1]["boxes"] = {box("0", "1/2")};
  json["witness"] = witness();
  const auto point = [](int k, const char* s) { return Json{{"segment", k}, {"s", s}}; };
  json["stretches"] = {
      {{"outer", {point(0, "1/4"), point(0, "1/2")}}, {"inner", {witness(), witness()}}, {"reason", nullptr}},
      {{"outer", {point(1, "1/2"), point(1, "1")}}, {"inner", nullptr}, {"reason", "no time"}}};
  return json;
}

/// A load with an item of each kind and no ellipsoid.
Json load_of_items() {
  return Json::parse(R"({"point_m": ["0", "0", "-0.4"], "gravity_m_s2": ["0", "0", "-9.81"], "items": [
    {"name": "payload", "weight": {"mass_kg": ["2", "35/11"], "at_m": ["0", "1/7", "0"], "at_tolerance_m": "0.05"}},
    {"name": "any", "force": {"ball": {"radius": "1/3"}, "axes": "W", "at_m": ["0", "0", "0"]}},
    {"name": "wind",
     "force": {"disc": {"radius": "6", "normal": ["0", "0", "2"]}, "axes": "P", "at_m": ["0", "0", "1"]}},
    {"name": "slewing", "moment": {"segment": {"direction": ["1", "0", "0"], "range": ["-1", "-1"]}, "axes": "P"}},
    {"name": "cases", "load_cases": {"wrenches": [["0", "0", "-1", "0", "0", "0"], ["1", "0", "0", "0", "0", "2"]],
                                     "axes": "W", "at_m": ["0", "0", "0"]}}]})");
}

/// Refuted by one load of each item.
Json refuted_by_loads() {
  Json json = refuted();
  json["problem"]["load"] = load_of_items();
  json["claim"] = std::string(kRefutedClaim) + kItemsClause;
  const Json loads = Json::parse(R"([{"mass_kg": "3", "offset_m": ["0", "0.05", "0"]}, {"vector": ["1/3", "0", "0"]},
                                     {"vector": ["0", "6", "0"]}, {"amount": "-1"}, {"case": 1}])");
  json["witness"]["loads"] = loads;
  for (Json& inner : json["stretches"][0]["inner"]) inner["loads"] = loads;
  return json;
}

Json limits_in_time() {
  return {{"load_speed_m_s", "1/3"},
          {"load_angular_speed_rad_s", "(5)*pi/180"},
          {"winch_power_W", {nullptr, "1e3", nullptr, nullptr, nullptr, "2*10^3"}},
          {"winch_speed_m_s", repeated(6, "1")}};
}

/// A proved move along the same path, whose load has a box.
Json moving() {
  Json json = proved();
  json["version"] = 6;
  json["problem"]["load"] = load_of_items();
  json["problem"]["load"]["items"][0]["weight"]["inertia_box_m"] = {"1", "1/2", "0.25"};
  json["problem"]["time"] = limits_in_time();
  json["path"]["times"] = nullptr;
  json["path"]["timing"] = {{"step_s", "0x1p-1"}, {"controls", numbers({0, 0, 0, 1, 1, 1, 2, 2, 2})}};
  json["claim"] = std::string(kProvedClaim) + kItemsClause + kMoveClause;
  return json;
}

Json of_rate(const char* kind, const Json& cable, const char* limit) {
  Json json = witness();
  json["kind"] = kind;
  json["cable"] = cable;
  json["limit"] = limit;
  json["value"] = {"3e3", "4e3"};
  return json;
}

/// Refuted by a winch's power.
Json refuted_move() {
  Json json = moving();
  json["verdict"] = "refuted";
  json["claim"] = std::string(kRefutedClaim) + kItemsClause + kMoveRefutedClause;
  json["margins"] = Json::object();
  json["segments"] = Json::array();
  json["witness"] = of_rate("winch_power", 6, "2*10^3");
  return json;
}

Json undecided() {
  Json json = proved();
  json["verdict"] = "undecided";
  json["claim"] = kUndecidedClaim;
  json["margins"] = Json::object();
  json["segments"] = Json::array();
  json["undecided"] = {{"reason", "no time"}, {"segment", 1}, {"box", {"0", "1/2"}}};
  return json;
}

/// Proved, with one constraint.
Json constrained() {
  Json json = proved();
  json["problem"]["space"]["constraints"] = {"px^2 - py"};
  for (Json& waypoint : json["path"]["waypoints"]) waypoint["normals"] = numbers({1, 0, 0, 0, 0, 0});
  json["path"]["tubes"] = numbers({0.5, 0.25});
  for (Json& segment : json["segments"]) {
    for (Json& box : segment["boxes"]) box["near"] = near(1);
  }
  return json;
}

Json inner_pose(const char* s) {
  return {{"s", s},
          {"position", numbers({0, 0, 0.5})},
          {"quaternion", numbers({0, 0, 0, 1})},
          {"tube", {{"position", "0x1p-5"}, {"turn", "0x1p-5"}}}};
}

/// Refuted, straight in the lengths of the cables, with tolerances and a witness that deviates.
Json length_controlled() {
  Json json = proved();
  json["verdict"] = "refuted";
  json["claim"] = kRefutedClaim;
  json["margins"] = Json::object();
  json["segments"] = Json::array();
  json["problem"]["tolerances"] = tolerances();
  Json& path = json["path"];
  path["interpolation"] = "straight-in-cable-lengths";
  path["waypoints"] = repeated(3, {{"position", numbers({0, 0, 0.5})},
                                   {"quaternion", numbers({0, 0, 0, 1})},
                                   {"lengths", numbers({1, 1, 1, 1, 1, 1})}});
  path["pose_tubes"] = {{{"position", "0x1p-4"}, {"turn", "0x1p-4"}, {"inner", {inner_pose("1/4"), inner_pose("1/2")}}},
                        {{"position", "0x1p-6"}, {"turn", "0x1p-5"}}};
  Json first = inner_pose("0");
  Json last = inner_pose("1");
  for (Json* pose : {&first, &last}) {
    (*pose)["tau"] = (*pose)["s"];
    pose->erase("s");
  }
  Json way_box = box("0", "1");
  way_box["near"] = near(6);
  Json motion = way_box;
  motion["segment"] = 0;
  motion["s"] = {"0", "1/4"};
  json["witness"] = witness();
  json["witness"]["proof"]["near"] = near(6);
  json["witness"]["motion"] = {motion};
  const Json zeros = repeated(3, "0");
  json["witness"]["deviation"] = {{"base_anchors_m", repeated(6, zeros)},
                                  {"platform_anchors_m", repeated(6, repeated(3, "0.0001"))},
                                  {"load_point_m", zeros},
                                  {"wrench", "1"},
                                  {"position_m", zeros},
                                  {"turn", zeros},
                                  {"cable_lengths_m", repeated(6, "0")},
                                  {"way", {{"poses", {first, last}}, {"boxes", {way_box}}}}};
  return json;
}

/// The file, with digests and counts that are right.
std::string sealed(Json json) {
  json["problem_sha256"] = digest(json["problem"]);
  json["path_sha256"] = digest(json["path"]);
  std::size_t boxes = 0;
  if (json["segments"].is_array()) {
    for (const Json& segment : json["segments"]) {
      if (segment.is_object() && segment.contains("boxes")) boxes += segment["boxes"].size();
    }
  }
  const std::string body = digest(json);
  json["footer"] = {{"waypoints", json["path"].contains("waypoints") ? json["path"]["waypoints"].size() : 0},
                    {"segments", json["segments"].size()},
                    {"boxes", boxes},
                    {"sha256", body}};
  return json.dump(1);
}

std::string message(const std::string& text) {
  try {
    (void)read_certificate(text);
  } catch (const Malformed& error) {
    return error.what();
  }
  return "none";
}

struct Edit {
  const char* path;
  Json value;  ///< discarded: the key is removed
  const char* message;
};

void expect_messages(const Json& base, const std::vector<Edit>& edits) {
  ASSERT_EQ(message(sealed(base)), "none");
  for (const Edit& edit : edits) {
    Json json = base;
    const Json::json_pointer pointer(edit.path);
    if (edit.value.is_discarded()) {
      json = json.patch({{{"op", "remove"}, {"path", edit.path}}});
    } else {
      json[pointer] = edit.value;
    }
    EXPECT_NE(message(sealed(json)).find(edit.message), std::string::npos)
        << edit.path << " " << edit.value << ": " << message(sealed(json));
  }
}

const Json kRemoved(Json::value_t::discarded);

TEST(Reader, ReadsAProvedCertificate) {
  const std::string text = sealed(proved());
  const Certificate certificate = read_certificate(text);
  EXPECT_EQ(certificate.verdict, Verdict::kProved);
  EXPECT_EQ(certificate.problem_json, problem());
  EXPECT_EQ(certificate.problem.length[5].upper, mpq_class(11, 20));
  ASSERT_EQ(certificate.path.waypoints.size(), 3U);
  EXPECT_EQ(certificate.path.waypoints[2].x[2], 0.35);
  EXPECT_EQ(certificate.boxes, 4U);
  ASSERT_EQ(certificate.segment_texts.size(), 2U);
  const Segment second = certificate.segment(1);
  ASSERT_EQ(second.boxes.size(), 2U);
  EXPECT_EQ(second.boxes[1].begin, mpq_class(1, 2));
  EXPECT_EQ(second.boxes[1].end, 1);
  EXPECT_EQ(second.boxes[1].bits, 64);
  EXPECT_FALSE(second.boxes[1].near);
  EXPECT_EQ(second.margins.tension, mpq_class(1, 50));
  EXPECT_EQ(certificate.margins[0], "0.01");
  EXPECT_EQ(certificate.source->file, proved()["source"]["file"]);
  EXPECT_EQ(certificate.signer, "");
  EXPECT_EQ(message(canonical(Json::parse(text))), "none");  // white space does not matter
}

TEST(Reader, ReadsARefutedCertificateWithStretches) {
  const std::string text = sealed(refuted());
  const Certificate certificate = read_certificate(text);
  EXPECT_EQ(certificate.verdict, Verdict::kRefuted);
  EXPECT_EQ(certificate.witness->cable, 2U);
  EXPECT_EQ(certificate.witness->at_box.begin, mpq_class(1, 4));
  ASSERT_EQ(certificate.stretch_texts.size(), 2U);
  EXPECT_EQ(certificate.stretch(0).inner.size(), 2U);
  EXPECT_EQ(certificate.stretch(1).begin.segment, 1U);
  EXPECT_TRUE(certificate.stretch(1).inner.empty());
}

TEST(Reader, ReadsALoadOfItemsAndTheLoadsOfAWitness) {
  const std::string text = sealed(refuted_by_loads());
  const Certificate certificate = read_certificate(text);
  const Problem& problem = certificate.problem;
  EXPECT_FALSE(problem.ellipsoid);
  EXPECT_EQ(problem.gravity[2], mpq_class(-981, 100));
  ASSERT_EQ(problem.items.size(), 5U);
  EXPECT_EQ(problem.items[0].at[1], mpq_class(1, 7));
  EXPECT_EQ(std::get<Weight>(problem.items[0].set).mass.upper, mpq_class(35, 11));
  EXPECT_EQ(std::get<Weight>(problem.items[0].set).offset, mpq_class(1, 20));
  const auto& ball = std::get<BallOrDisc>(problem.items[1].set);
  EXPECT_FALSE(ball.is_moment || ball.normal);
  EXPECT_EQ(ball.radius, mpq_class(1, 3));
  const auto& disc = std::get<BallOrDisc>(problem.items[2].set);
  EXPECT_FALSE(disc.is_moment);
  EXPECT_EQ(disc.normal.value()[2], 2);
  EXPECT_EQ(problem.items[2].axes, Axes::kPlatform);
  const auto& line_segment = std::get<LineSegment>(problem.items[3].set);
  EXPECT_TRUE(line_segment.is_moment);
  EXPECT_EQ(line_segment.range.upper, -1);
  EXPECT_EQ(problem.items[4].axes, Axes::kWorld);
  EXPECT_EQ(std::get<LoadCases>(problem.items[4].set).wrenches[1][5], 2);
  const std::vector<LoadChoice>& loads = certificate.witness->loads.value();
  ASSERT_EQ(loads.size(), 5U);
  EXPECT_EQ(std::get<WeightChoice>(loads[0]).offset[1], mpq_class(1, 20));
  EXPECT_EQ(std::get<VectorChoice>(loads[1]).vector[0], mpq_class(1, 3));
  EXPECT_EQ(std::get<AmountChoice>(loads[3]).amount, -1);
  EXPECT_EQ(std::get<CaseChoice>(loads[4]).index, 1U);

  Json both = refuted_by_loads();
  const Json of_ellipsoid = proved()["problem"];
  both["problem"]["load"]["wrench"] = of_ellipsoid["load"]["wrench"];
  both["problem"]["load"]["ellipsoid"] = of_ellipsoid["load"]["ellipsoid"];
  both["problem"]["load"]["ellipsoid"][0][0] = "1/36";
  EXPECT_EQ(message(sealed(both)), "none");
  both["problem"]["load"]["ellipsoid_name"] = "sway";
  EXPECT_EQ(message(sealed(both)), "none");
  expect_messages(
      both, {{"/problem/load/ellipsoid_name", "wind", "problem.load.ellipsoid_name: expected a name that no item has"},
             {"/problem/load/ellipsoid_name", "", "problem.load.ellipsoid_name: expected 1 to 100 characters"},
             {"/problem/load/ellipsoid_name", std::string(101, 'x'),
              "problem.load.ellipsoid_name: expected 1 to 100 characters"},
             {"/problem/load/ellipsoid_name", 1, "problem.load.ellipsoid_name: expected a string"}});
}

TEST(Reader, NamesWhatIsWrongWithALoadOfItems) {
  Json many = load_of_items()["items"];
  while (many.size() < 65) many.push_back(many[0]);
  const Json ball = {{"radius", "1"}};
  expect_messages(
      refuted_by_loads(),
      {{"/claim", kRefutedClaim, "claim: expected the text that belongs to the verdict"},
       {"/problem/load/items", Json::array(), "problem.load.items: expected 1 to 64 items"},
       {"/problem/load/items", many, "problem.load.items: expected 1 to 64 items"},
       {"/problem/load/gravity_m_s2", kRemoved, "problem.load: expected the key 'gravity_m_s2'"},
       {"/problem/load/wrench", repeated(6, "0"), "problem.load: expected the key 'ellipsoid'"},
       {"/problem/load/ellipsoid", repeated(6, repeated(6, "1")), "problem.load: expected the key 'wrench'"},
       {"/problem/load/ellipsoid_name", "sway", "problem.load: expected no key 'ellipsoid_name'"},
       {"/problem/load/items/0/name", "wind", "problem.load.items[2].name: expected a name that no other item has"},
       {"/problem/load/items/0/name", "", "problem.load.items[0].name: expected 1 to 100 characters"},
       {"/problem/load/items/0/name", std::string(101, 'x'), "problem.load.items[0].name: expected 1 to 100"},
       {"/problem/load/items/0/weight", kRemoved, "problem.load.items[0]: expected exactly one of the keys 'weight'"},
       {"/problem/load/items/0/load_cases", load_of_items()["items"][4]["load_cases"],
        "problem.load.items[0]: expected exactly one of the keys 'weight'"},
       {"/problem/load/items/0/weight/axes", "W", "problem.load.items[0].weight: expected no key 'axes'"},
       {"/problem/load/items/0/weight/mass_kg/0", "4", "problem.load.items[0].weight.mass_kg: expected ends in order"},
       {"/problem/load/items/0/weight/mass_kg/0", "-1", "problem.load.items[0].weight.mass_kg: expected a mass >= 0"},
       {"/problem/load/items/0/weight/at_tolerance_m", "-1/3", "at_tolerance_m: expected a tolerance >= 0"},
       {"/problem/load/items/0/weight/at_m/0", "1/0", "problem.load.items[0].weight.at_m[0]: got '1/0', expected such"},
       {"/problem/load/items/1/force/ball/radius", "-1", "force.ball.radius: expected a radius >= 0"},
       {"/problem/load/items/1/force/ball", kRemoved, "force: expected exactly one of the keys 'ball', 'disc'"},
       {"/problem/load/items/2/force/ball", ball, "force: expected exactly one of the keys 'ball', 'disc'"},
       {"/problem/load/items/2/force/axes", "w", "force.axes: expected W or P"},
       {"/problem/load/items/2/force/at_m", kRemoved, "force: expected the key 'at_m'"},
       {"/problem/load/items/2/force/disc/normal/2", "0", "force.disc.normal: expected a vector that is not 0"},
       {"/problem/load/items/3/moment/at_m", repeated(3, "0"), "moment: expected no key 'at_m'"},
       {"/problem/load/items/3/moment/segment/direction/0", "0/7", "direction: expected a vector that is not 0"},
       {"/problem/load/items/3/moment/segment/range/1", "-2", "segment.range: expected ends in order"},
       {"/problem/load/items/4/load_cases/wrenches", Json::array(), "wrenches: expected 1 to 64 load cases"},
       {"/problem/load/items/4/load_cases/wrenches", repeated(65, repeated(6, "0")), "wrenches: expected 1 to 64"},
       {"/problem/load/items/4/load_cases/wrenches/0/5", kRemoved, "wrenches[0]: expected an array of 6"},
       {"/problem/tolerances", tolerances(), "expected no tolerance of the load beside items"},
       {"/witness/loads/4", kRemoved, "witness.loads: expected an array of 5"},
       {"/witness/loads/4/case", 2, "witness.loads[4].case: expected an integer from 0 to 1"},
       {"/witness/loads/3/vector", repeated(3, "0"), "witness.loads[3]: expected no key 'vector'"},
       {"/witness/loads/0/offset_m", kRemoved, "witness.loads[0]: expected the key 'offset_m'"},
       {"/witness/kind", "length_min", "witness: expected no key 'loads'"}});
  Json without = refuted_by_loads();
  without["witness"].erase("loads");
  EXPECT_EQ(message(sealed(without)), "none");  // the witness of a path need not be one of a stretch
  without = refuted();
  without["witness"]["loads"] = Json::array();
  EXPECT_NE(message(sealed(without)).find("witness: expected no key 'loads'"), std::string::npos);
  without = proved();
  without["claim"] = std::string(kProvedClaim) + kItemsClause;
  EXPECT_NE(message(sealed(without)).find("claim: expected the text"), std::string::npos) << "there are no items";
}

TEST(Reader, ReadsAMachineThatIsLengthControlled) {
  const std::string text = sealed(length_controlled());
  const Certificate certificate = read_certificate(text);
  ASSERT_EQ(certificate.path.inner_poses.size(), 2U);
  ASSERT_EQ(certificate.path.inner_poses[0].size(), 2U);
  EXPECT_EQ(certificate.path.inner_poses[0][1].s, mpq_class(1, 2));
  EXPECT_EQ(certificate.path.inner_poses[0][1].tube.turn, 0x1p-5);
  EXPECT_EQ(certificate.path.waypoints[1].x.size(), 13U);
  const Witness& witness = *certificate.witness;
  EXPECT_EQ(witness.at_box.near->radius, 0x1p-20);
  ASSERT_EQ(witness.motion.size(), 1U);
  EXPECT_EQ(witness.motion[0].box.end, mpq_class(1, 4));
  EXPECT_EQ(witness.deviation->poses.size(), 2U);
  EXPECT_EQ(witness.deviation->boxes.size(), 1U);
  EXPECT_EQ(way_to_json(*witness.deviation), length_controlled()["witness"]["deviation"]["way"]);
  EXPECT_EQ(to_json(witness.motion[0]), length_controlled()["witness"]["motion"][0]);
  EXPECT_EQ(proof_to_json(witness.at_box), length_controlled()["witness"]["proof"]);
}

TEST(Reader, WritesTheBoxesThatItReads) {
  Json json = constrained();
  json["problem"]["tolerances"] = tolerances();
  for (Json& segment : json["segments"]) {
    for (Json& box : segment["boxes"]) box.update({{"parts", 7}, {"guesses", 3}});
  }
  const std::string text = sealed(json);
  const Certificate certificate = read_certificate(text);
  const Box box = certificate.segment(0).boxes[1];
  EXPECT_EQ(box.parts, 7);
  EXPECT_EQ(box.guesses, 3);
  EXPECT_EQ(to_json(box, true), json["segments"][0]["boxes"][1]);
}

TEST(Reader, ReadsUndecidedAndConstrainedCertificates) {
  const std::string text = sealed(undecided());
  EXPECT_EQ(read_certificate(text).undecided_reason, "no time");
  EXPECT_EQ(message(sealed(constrained())), "none");
}

TEST(Reader, RefusesWhatIsNoStrictJson) {
  const std::string good = sealed(proved());
  EXPECT_EQ(message(""), "no JSON, or cut: line 1");
  EXPECT_EQ(message("[]"), "certificate: expected an object");
  EXPECT_EQ(message("\xEF\xBB\xBF" + good), "no JSON: it begins with a byte order mark");
  EXPECT_EQ(message(good + std::string(1, '\0')), "no JSON: it contains a NUL byte");
  EXPECT_NE(message(good + "x").find("no JSON, or cut: line"), std::string::npos);
  EXPECT_NE(message(good.substr(0, good.size() / 2)).find("no JSON, or cut: line"), std::string::npos);
  EXPECT_EQ(message(std::string(33, '[') + std::string(33, ']')), "nested too deeply");
  EXPECT_EQ(message(std::string(32, '[') + std::string(32, ']')), "certificate: expected an object");
  EXPECT_EQ(message("{\"a\": 1.0}"), "a number that is no integer");
  EXPECT_EQ(message("{\"a\": 1, \"a\": 1}"), "the key 'a' appears twice in one object");
  EXPECT_EQ(message("{\"b\": {\"y\": 1, \"x\": 1}}"), "the key 'x' comes after 'y': expected keys in code-point order");
}

TEST(Reader, RefusesAlteredDigests) {
  Json json = Json::parse(sealed(proved()));
  const auto altered = [&](const char* key, const Json& value) {
    Json other = json;
    other[Json::json_pointer(key)] = value;
    return message(canonical(other));
  };
  EXPECT_EQ(message(canonical(json)), "none");
  EXPECT_NE(altered("/generator/name", "other").find("footer.sha256"), std::string::npos);
  EXPECT_NE(altered("/illustration/charts/0/0", 2).find("footer.sha256"), std::string::npos);
  EXPECT_NE(altered("/problem_sha256", std::string(64, '0')).find("footer.sha256"), std::string::npos);
  EXPECT_NE(altered("/footer/boxes", 5).find("footer.boxes: expected an integer from 4 to 4"), std::string::npos);
  EXPECT_NE(altered("/footer/waypoints", 1000000000).find("footer.waypoints"), std::string::npos);
  json["problem"]["name"] = "another";
  json.erase("footer");
  const std::string body = digest(json);
  json["footer"] = {{"waypoints", 3}, {"segments", 2}, {"boxes", 4}, {"sha256", body}};
  EXPECT_NE(message(canonical(json)).find("problem_sha256: expected the digest"), std::string::npos);
}

TEST(Reader, FindsTheFooterWhereverItStands) {
  const Json json = Json::parse(sealed(proved()));
  Json body = json;
  body.erase("footer");
  const std::string footer = "\"footer\":" + canonical(json["footer"]);
  EXPECT_EQ(message("{" + footer + "," + canonical(body).substr(1)), "none");
  EXPECT_EQ(message("{" + footer + "," + canonical(json).substr(1)), "the key 'footer' appears twice in one object");
}

std::string hex(const std::vector<unsigned char>& bytes) {
  std::string result;
  for (const unsigned char byte : bytes) {
    result += "0123456789abcdef"[byte / 16];
    result += "0123456789abcdef"[byte % 16];
  }
  return result;
}

TEST(Reader, SaysWhoSigned) {
  const std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)> key(EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519"),
                                                           EVP_PKEY_free);
  std::vector<unsigned char> public_key(32);
  std::size_t size = public_key.size();
  ASSERT_EQ(EVP_PKEY_get_raw_public_key(key.get(), public_key.data(), &size), 1);
  Json json = Json::parse(sealed(proved()));
  const std::string text = "taut certificate " + json["footer"]["sha256"].get<std::string>();
  const std::vector<unsigned char> bytes(text.begin(), text.end());
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  std::vector<unsigned char> value(64);
  size = value.size();
  ASSERT_EQ(EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key.get()), 1);
  ASSERT_EQ(EVP_DigestSign(context.get(), value.data(), &size, bytes.data(), bytes.size()), 1);
  json["signature"] = {{"algorithm", "Ed25519"}, {"public_key", hex(public_key)}, {"value", hex(value)}};
  const std::string signed_text = canonical(json);
  EXPECT_EQ(read_certificate(signed_text).signer, hex(public_key));

  Json other = json;
  other["footer"]["boxes"] = 5;
  EXPECT_EQ(message(canonical(other)).find("footer.boxes: expected"), 0U);
  value[5] ^= 1;
  json["signature"]["value"] = hex(value);
  EXPECT_EQ(message(canonical(json)).find("signature.value: expected a signature of this certificate by that key"), 0U);
  json["signature"]["value"] = "AB";
  EXPECT_EQ(message(canonical(json)), "signature.value: expected 128 lower-case hex digits");
  json["signature"]["algorithm"] = "RSA";
  EXPECT_EQ(message(canonical(json)), "signature.algorithm: expected 'Ed25519'");
}

TEST(Reader, ReadsAMove) {
  const std::string text = sealed(moving());
  const Certificate certificate = read_certificate(text);
  const TimeLimits& limits = certificate.problem.time.value();
  const auto value = [](const std::optional<Expression>& x) { return x.value().evaluate<MeanValueForm>({}).range(); };
  EXPECT_TRUE(is_within(Ball(1), value(limits.of(RateKind::kWinchSpeed, 5))));
  EXPECT_FALSE(limits.winch_power[0]);
  EXPECT_TRUE(is_within(Ball(2000), value(limits.of(RateKind::kWinchPower, 5))));
  EXPECT_FALSE(limits.winch_acceleration[0]);
  EXPECT_TRUE(certainly_positive(value(limits.of(RateKind::kLoadAngularSpeed, 0)) - Ball(mpq_class(8, 100))));
  EXPECT_TRUE(limits.load_speed);
  EXPECT_FALSE(limits.load_acceleration || limits.load_angular_acceleration);
  const auto& weight = std::get<Weight>(certificate.problem.items[0].set);
  EXPECT_EQ(weight.inertia_box.value()[1], mpq_class(1, 2));
  const TimeLaw& law = certificate.path.timing.value();
  EXPECT_EQ(law.step_s, 0.5);
  EXPECT_EQ(law.controls, (std::vector<double>{0, 0, 0, 1, 1, 1, 2, 2, 2}));
  EXPECT_EQ(digest(moving()["path"]), Json::parse(text)["path_sha256"]);
  std::string altered = text;
  altered.replace(altered.find("0x1p-1"), 6, "0x1p-2");
  EXPECT_NE(message(altered).find("it was altered"), std::string::npos);

  const std::string refuted_text = sealed(refuted_move());
  const Certificate refuted = read_certificate(refuted_text);
  EXPECT_EQ(refuted.witness->kind, WitnessKind::kWinchPower);
  EXPECT_EQ(refuted.witness->cable, 5U);
  EXPECT_EQ(refuted.witness->value_lower, 3000);
}

TEST(Reader, ReadsAMoveThatMayBeStopped) {
  Json json = moving();
  json["problem"]["time"]["stopping_time_s"] = "3/2";
  EXPECT_EQ(message(sealed(json)), "claim: expected the text that belongs to the verdict");
  json["claim"] = std::string(kProvedClaim) + kItemsClause + kMoveClause + kMayStopClause;
  const std::string text = sealed(json);
  const Certificate certificate = read_certificate(text);
  const Ball seconds = certificate.problem.time->stopping_time.value().evaluate<MeanValueForm>({}).range();
  EXPECT_TRUE(is_within(Ball(1.5), seconds));
  expect_messages(json,
                  {{"/problem/time/stopping_time_s", "0", "problem.time.stopping_time_s: expected a limit above 0"},
                   {"/problem/time/stopping_time_s", nullptr, "problem.time.stopping_time_s: expected a string"},
                   {"/problem/time", {{"stopping_time_s", "1"}}, "problem.time: expected at least one limit"},
                   {"/problem/time/stopping_time_s", kRemoved, "claim: expected the text that belongs"}});
  Json refuted = refuted_move();
  refuted["problem"]["time"]["stopping_time_s"] = "1";
  refuted["claim"] = std::string(kRefutedClaim) + kItemsClause + kMoveRefutedClause + kSlowedRefutedClause;
  EXPECT_EQ(message(sealed(refuted)), "none") << "it is refuted as its law runs it";
  expect_messages(refuted, {{"/claim", std::string(kRefutedClaim) + kItemsClause + kMoveRefutedClause, "claim:"}});
  refuted["witness"] = witness();
  refuted["witness"]["slowing"] = {{"change", -1}, {"speed", "0.25"}};
  const Certificate slowed = read_certificate(sealed(refuted));
  EXPECT_EQ(slowed.witness->slowing->change, -1);
  EXPECT_EQ(slowed.witness->slowing->speed, mpq_class(1, 4));
  constexpr const char* speed = "witness.slowing.speed: expected a number between 0 and 1";
  expect_messages(refuted, {{"/witness/slowing/speed", "1", speed},
                            {"/witness/slowing/speed", "0", speed},
                            {"/witness/slowing/speed", 0.5, "a number that is no integer"},
                            {"/witness/slowing/change", 0, "witness.slowing.change: expected -1 or 1"},
                            {"/witness/slowing/change", 2, "witness.slowing.change: expected an integer from -1 to 1"},
                            {"/witness/slowing/change", kRemoved, "witness.slowing: expected the key 'change'"},
                            {"/witness/kind", "length_min", "slowing"}});
}

TEST(Reader, ReadsWitnessesOfEveryRate) {
  Json base = refuted_move();
  base["problem"]["time"]["load_acceleration_m_s2"] = "1";
  base["problem"]["time"]["load_angular_acceleration_rad_s2"] = "1";
  base["problem"]["time"]["winch_acceleration_m_s2"] = repeated(6, "1");
  const std::vector<std::pair<Json, RateKind>> all = {
      {of_rate("winch_speed", 2, "1"), RateKind::kWinchSpeed},
      {of_rate("winch_acceleration", 1, "1"), RateKind::kWinchAcceleration},
      {of_rate("winch_power", 2, "1e3"), RateKind::kWinchPower},
      {of_rate("load_speed", nullptr, "1/3"), RateKind::kLoadSpeed},
      {of_rate("load_acceleration", nullptr, "1"), RateKind::kLoadAcceleration},
      {of_rate("load_angular_speed", nullptr, "(5)*pi/180"), RateKind::kLoadAngularSpeed},
      {of_rate("load_angular_acceleration", nullptr, "1"), RateKind::kLoadAngularAcceleration}};
  for (const auto& [witness, rate] : all) {
    base["witness"] = witness;
    const std::string text = sealed(base);
    const Certificate certificate = read_certificate(text);
    EXPECT_EQ(rate_of(certificate.witness->kind), rate);
    EXPECT_EQ(certificate.witness->cable, is_of_winch(rate) ? witness["cable"].get<std::size_t>() - 1 : 0U);
    Json other = base;
    other["witness"]["cable"] = is_of_winch(rate) ? Json() : Json(1);
    EXPECT_EQ(message(sealed(other)).find("witness.cable: expected"), 0U);
  }
  for (Json witness : {witness(), of_rate("length_max", 3, "0.55")}) {
    if (witness["kind"] == "length_max") witness["value"] = {"0.55", "0.6"};
    base["witness"] = witness;
    EXPECT_EQ(message(sealed(base)), "none") << "limits of tensions and lengths are those of moves, too";
  }
}

TEST(Reader, NamesWhatIsWrongWithLimitsInTime) {
  const std::string time = "/problem/time";
  const auto at = [&](const char* key) { return time + "/" + key; };
  const std::string speed = at("winch_speed_m_s"), third = speed + "/2", load = at("load_speed_m_s");
  const std::string box = "/problem/load/items/0/weight/inertia_box_m", side = box + "/2";
  const std::string moment_box = "/problem/load/items/3/moment/inertia_box_m";
  expect_messages(
      moving(),
      {{"/version", 4, "version: expected an integer from 6 to 6"},
       {"/version", 5, "version: expected an integer from 6 to 6"},
       {"/version", 7, "version: expected 4, 5 or 6, got 7"},
       {time.c_str(), nullptr, "problem.time: expected an object"},
       {time.c_str(), Json::object(), "problem.time: expected at least one limit"},
       {time.c_str(), kRemoved, "problem.load.items[0].weight: expected no key 'inertia_box_m' in a problem without"},
       {at("winch_jerk").c_str(), "1", "problem.time: expected no key 'winch_jerk'"},
       {load.c_str(), "0", "problem.time.load_speed_m_s: expected a limit above 0"},
       {load.c_str(), "-1", "problem.time.load_speed_m_s: expected a limit above 0"},
       {load.c_str(), "pi - pi", "problem.time.load_speed_m_s: expected a limit above 0"},
       {load.c_str(), "1/0", "problem.time.load_speed_m_s: expected a limit above 0, not"},
       {load.c_str(), "px", "problem.time.load_speed_m_s: 'px', column 3: expected a known name"},
       {load.c_str(), 1, "problem.time.load_speed_m_s: expected a string"},
       {load.c_str(), nullptr, "problem.time.load_speed_m_s: expected a string"},
       {speed.c_str(), repeated(5, "1"), "problem.time.winch_speed_m_s: expected an array of 6"},
       {speed.c_str(), repeated(6, nullptr), "problem.time.winch_speed_m_s: expected a limit of some cable"},
       {speed.c_str(), "1", "problem.time.winch_speed_m_s: expected an array of 6"},
       {third.c_str(), "0", "problem.time.winch_speed_m_s[2]: expected a limit above 0"},
       {box.c_str(), {"1", "1"}, "problem.load.items[0].weight.inertia_box_m: expected an array of 3"},
       {box.c_str(), nullptr, "problem.load.items[0].weight.inertia_box_m: expected an array of 3"},
       {side.c_str(), "0", "problem.load.items[0].weight.inertia_box_m[2]: expected a side > 0"},
       {side.c_str(), "pi", "problem.load.items[0].weight.inertia_box_m[2]: got 'pi', expected such a decimal"},
       {moment_box.c_str(), {"1", "1", "1"}, "problem.load.items[3].moment: expected no key 'inertia_box_m'"}});
  Json with_bodies_version = proved();
  with_bodies_version["version"] = 6;
  EXPECT_EQ(message(sealed(with_bodies_version)).find("version: expected an integer from 4 to 4"), 0U);
}

TEST(Reader, NamesWhatIsWrongWithAMove) {
  const auto law = [](std::initializer_list<double> controls) { return numbers(controls); };
  expect_messages(
      moving(),
      {{"/claim", std::string(kProvedClaim) + kItemsClause, "claim: expected the text that belongs"},
       {"/claim", std::string(kProvedClaim) + kItemsClause + kMoveRefutedClause, "claim: expected the text"},
       {"/path/timing", nullptr, "path.timing: expected an object"},
       {"/path/timing", Json::array(), "path.timing: expected an object"},
       {"/path/timing/step_s", kRemoved, "path.timing: expected the key 'step_s'"},
       {"/path/timing/start_s", "0x0p+0", "path.timing: expected no key 'start_s'"},
       {"/path/timing/step_s", "0.5", "path.timing.step_s: got '0.5', expected a finite binary64"},
       {"/path/timing/step_s", "0x0p+0", "path.timing: expected a law of a move along the path, not a law in time"},
       {"/path/timing/step_s", "-0x1p-1", "path.timing: expected a law of a move along the path, not a law in time"},
       {"/path/timing/controls", law({0, 0, 0}), "path.timing.controls: expected 4 to 20000 control values"},
       {"/path/timing/controls", repeated(20001, "0x0p+0"), "path.timing.controls: expected 4 to 20000"},
       {"/path/timing/controls/1", "nan", "path.timing.controls[1]: got 'nan', expected a finite binary64"},
       {"/path/timing/controls", law({0, 0, 0, 2, 2, 2}), "not a move that does not rest where it has to"},
       {"/path/timing/controls", law({0, 0, 0, 1, 1, 1}), "not a law in time of another path"},
       {"/path/timing/controls", law({0, 0, 0, 1, 1, 1, 3, 3, 3}), "not a law in time of another path"},
       {"/path/timing/controls", law({0, 0, 0, 1.5, 1, 1, 1, 2, 2, 2}), "not a law in time that goes back"},
       {"/stretches", Json::array(), "stretches: expected null where the problem has limits in time"}});
  Json at_rest = moving();
  at_rest["path"].erase("timing");
  at_rest["claim"] = std::string(kProvedClaim) + kItemsClause;
  EXPECT_EQ(message(sealed(at_rest)), "path: expected the key 'timing' of a proved move");
  Json timeless = moving();
  timeless["version"] = 4;
  timeless["problem"].erase("time");
  timeless["problem"]["load"]["items"][0]["weight"].erase("inertia_box_m");
  EXPECT_EQ(message(sealed(timeless)), "path.timing: expected no law in time where the problem has no limits in time");

  Json with_constraint = constrained();
  with_constraint["version"] = 6;
  with_constraint["problem"]["time"] = limits_in_time();
  with_constraint["path"]["timing"] = moving()["path"]["timing"];
  with_constraint["path"]["times"] = nullptr;
  with_constraint["claim"] = std::string(kProvedClaim) + kMoveClause;
  EXPECT_EQ(message(sealed(with_constraint)), "none");

  Json of_lengths = length_controlled();
  of_lengths["version"] = 6;
  of_lengths["problem"]["time"] = limits_in_time();
  of_lengths["claim"] = std::string(kRefutedClaim) + kAtRestClause;
  EXPECT_EQ(message(sealed(of_lengths)), "none") << "a path without a law may have any interpolation";
  of_lengths["path"]["timing"] = moving()["path"]["timing"];
  of_lengths["claim"] = std::string(kRefutedClaim) + kMoveRefutedClause;
  EXPECT_EQ(message(sealed(of_lengths)), "path.times: expected null in a move, whose law says when it is where");

  Json nothing = moving();
  nothing["verdict"] = "undecided";
  nothing["claim"] = kUndecidedClaim;
  nothing["margins"] = Json::object();
  nothing["segments"] = Json::array();
  nothing["undecided"] = {{"reason", "no time"}, {"segment", nullptr}, {"box", nullptr}};
  EXPECT_EQ(message(sealed(nothing)), "none");
  nothing["path"].erase("timing");
  EXPECT_EQ(message(sealed(nothing)), "none");
}

TEST(Reader, NamesWhatIsWrongWithTheWitnessOfAMove) {
  const Json loads = refuted_by_loads()["witness"]["loads"];
  expect_messages(refuted_move(),
                  {{"/claim", std::string(kRefutedClaim) + kItemsClause, "claim: expected the text that belongs"},
                   {"/claim", std::string(kRefutedClaim) + kItemsClause + kAtRestClause, "claim: expected the text"},
                   {"/claim", std::string(kRefutedClaim) + kItemsClause + kMoveClause, "claim: expected the text"},
                   {"/witness/kind", "winch_acceleration", "witness.kind: expected a limit that the problem states"},
                   {"/witness/kind", "jerk", "witness.kind: expected a kind of the format"},
                   {"/witness/cable", 1, "witness.kind: expected a limit that the problem states"},
                   {"/witness/cable", 2, "witness.limit: expected the limit in the problem"},
                   {"/witness/cable", 7, "witness.cable: expected an integer from 1 to 6"},
                   {"/witness/cable", kRemoved, "witness: expected the key 'cable'"},
                   {"/witness/limit", "2000", "witness.limit: expected the limit in the problem"},
                   {"/witness/limit", nullptr, "witness.limit: expected a string"},
                   {"/witness/value", {"4e3", "3e3"}, "witness.value: expected ends in order"},
                   {"/witness/proof", kRemoved, "witness: expected the key 'proof'"},
                   {"/witness/deviation", {{"wrench", "1"}}, "witness.deviation: expected tolerances to be within"},
                   {"/witness/loads", loads, "witness: expected no key 'loads'"}});
  Json of_tension = refuted_move();
  of_tension["witness"] = witness();
  expect_messages(of_tension, {{"/witness/loads", loads, "witness: expected no key 'loads'"},
                               {"/witness/deviation", {{"wrench", "1"}}, "expected tolerances to be within"},
                               {"/witness/slowing", {{"change", 1}, {"speed", "0.5"}}, "expected no key 'slowing'"}});
  Json at_rest = refuted_move();
  at_rest["path"].erase("timing");
  at_rest["claim"] = std::string(kRefutedClaim) + kItemsClause + kAtRestClause;
  EXPECT_EQ(message(sealed(at_rest)), "witness.kind: expected no limit in time where the path has no law in time");
  at_rest["witness"] = witness();
  at_rest["witness"]["loads"] = loads;
  EXPECT_EQ(message(sealed(at_rest)), "none");
  at_rest["claim"] = std::string(kRefutedClaim) + kItemsClause;
  EXPECT_EQ(message(sealed(at_rest)).find("claim: expected"), 0U);
}

TEST(Reader, NamesAnotherVersionFirst) {
  Json json = proved();
  json["version"] = 3;
  json["segments"][0]["boxes"] = {{"0", "1"}};
  EXPECT_EQ(message(sealed(json)).find("version: expected 4, 5 or 6, got 3"), 0U);
}

TEST(Reader, NamesWhatIsWrongWithAProvedCertificate) {
  expect_messages(
      proved(),
      {{"/witness", kRemoved, "certificate: expected the key 'witness'"},
       {"/more", 1, "certificate: expected no key 'more'"},
       {"/verdict", "sure", "verdict: expected proved, refuted or undecided"},
       {"/claim", kRefutedClaim, "claim: expected the text that belongs to the verdict"},
       {"/problem/robot/tension_N/2", {"0.5", "0.5"}, "problem.robot.tension_N[2]: expected 0 <= lower < upper"},
       {"/problem/load/ellipsoid/1/0", "1", "problem.load.ellipsoid: expected a symmetric matrix"},
       {"/problem/load/wrench/0", "0x1", "problem.load.wrench[0]: got '0x1', expected a decimal"},
       {"/problem/space/pose/px", "px + phi", "problem.space.pose.px: expected the same pose"},
       {"/problem/space/pose/px", "px + q", "problem.space.pose.px: 'px + q', column 7: expected a known name"},
       {"/problem/space/flip", {4, 3}, "problem.space.flip: expected the parameters that are phi and theta"},
       {"/problem/space/parameters/0/name", "pi", "problem.space.parameters[0].name"},
       {"/problem/space/parameters", Json::array(), "problem.space.parameters: expected 1 to 64 parameters"},
       {"/problem/space/parameters", repeated(65, nullptr), "problem.space.parameters: expected 1 to 64 parameters"},
       {"/problem/query/waypoints", {Json::array()}, "problem.query.waypoints: expected none, or at least two"},
       {"/path/interpolation", "geodesic", "path.waypoints[0]: expected the key 'position'"},
       {"/path/interpolation", "cubic-b-spline", "path.waypoints: expected at least four of a spline"},
       {"/path/waypoints/1/x/0", "0x1p0", "path.waypoints[1].x[0]: got '0x1p0', expected a finite binary64"},
       {"/path/waypoints/1/half_turns/0", 1, "path.waypoints[1].half_turns[0]: expected 0"},
       {"/path/waypoints/1/half_turns/3", 1000001,
        "path.waypoints[1].half_turns[3]: expected an integer from -1000000"},
       {"/path/waypoints/1/normals", numbers({1, 0, 0, 0, 0, 0}), "path.waypoints[1].normals: expected no such key"},
       {"/path/tubes", numbers({1, 1}), "path.tubes: expected an array of 0"},
       {"/path/times/2", "1.5", "path.times[2]"},
       {"/path/times/2", kRemoved, "path.times: expected an array of 3"},
       {"/segments/1", kRemoved, "segments: expected an array of 2"},
       {"/segments/0/from", 1, "segments[0].from: expected an integer from 0 to 0"},
       {"/segments/0/boxes/1", kRemoved, "segments[0].boxes: expected boxes that tile [0, 1]"},
       {"/segments/1/boxes/0/s/0", "1/4", "segments[1].boxes: expected boxes that tile [0, 1]"},
       {"/segments/1/boxes/1/s/0", "1/4", "segments[1].boxes[1].s: expected a box after the last one"},
       {"/segments/1/boxes/1/s/1", "1/2", "segments[1].boxes[1].s: expected begin < end"},
       {"/segments/0/boxes/0/bits", 31, "segments[0].boxes[0].bits: expected an integer from 32 to 4096"},
       {"/segments/0/boxes/0/bits", 4097, "segments[0].boxes[0].bits"},
       {"/segments/0/boxes/0/near", near(1), "segments[0].boxes[0]: expected no key 'near'"},
       {"/segments/0/boxes/0/parts", 1, "segments[0].boxes[0]: expected no key 'parts'"},
       {"/segments/0/margins", nullptr, "segments[0].margins: expected null where there is no box"},
       {"/margins/tension_N", "0.011", "margins.tension_N: expected not more than any segment's"},
       {"/margins/tension_N", "0.010", "margins.tension_N: expected the text of a segment's"},
       {"/stretches", Json::array(), "stretches: expected null"},
       {"/witness", witness(), "witness: expected null"},
       {"/undecided", {{"reason", ""}}, "undecided: expected null"},
       {"/source/sha256", "ab", "source.sha256: expected 64 lower-case hex digits"}});
}

TEST(Reader, NamesWhatIsWrongWithTolerances) {
  Json base = length_controlled();
  expect_messages(base,
                  {{"/problem/tolerances/position_m", "-1", "problem.tolerances.position_m: expected a tolerance"},
                   {"/problem/tolerances/orientation_rad", "1", "expected an angle from 0 to below 1"},
                   {"/problem/tolerances/orientation_rad", "-pi/180", "expected an angle from 0 to below 1"},
                   {"/problem/tolerances/orientation_rad", "1/0", "expected an angle from 0 to below 1, not"},
                   {"/problem/tolerances/base_anchor_m/5", "-0.1", "problem.tolerances.base_anchor_m[5]"}});
}

TEST(Reader, NamesWhatIsWrongWithImpliedMotion) {
  expect_messages(
      constrained(),
      {{"/path/tubes/0", "0x0p+0", "path.tubes[0]: expected a positive width"},
       {"/path/tubes/0", "-0x1p+0", "path.tubes[0]: expected a positive width"},
       {"/path/waypoints/2/normals", kRemoved, "path.waypoints[2].normals: expected an array of 6"},
       {"/segments/0/boxes/0/near", kRemoved, "segments[0].boxes[0]: expected the key 'near'"},
       {"/segments/0/boxes/0/near", near(2), "segments[0].boxes[0].near.at: expected an array of 1"},
       {"/segments/0/boxes/0/near/radius", "0x0p+0", "near.radius: expected a positive radius"},
       {"/segments/0/boxes/0/near/narrowings", 9, "near.narrowings: expected an integer from 0 to 8"},
       {"/problem/space/constraints", {"px - phi"}, "problem.space.constraints[0]: expected the same value"},
       {"/problem/tolerances", tolerances(), "segments[0].boxes[0]: expected the key 'guesses'"}});
  const std::string first = "/path/pose_tubes/0/inner/0";
  const std::string way = "/witness/deviation/way";
  const std::string tube = "expected tubes each of which contains the one before";
  const std::string second_tau = way + "/poses/1/tau";
  const std::string box_s = way + "/boxes/0/s";
  const std::string way_tube = way + "/poses/1/tube";
  const std::string way_near = way + "/boxes/0/near";
  const std::string first_s = first + "/s";
  const std::string first_tube = first + "/tube/turn";
  const std::string quaternion = first + "/quaternion";
  const std::string zero_way = "witness.deviation.way: expected null";
  expect_messages(
      length_controlled(),
      {{first_s.c_str(), "1/2", "path.pose_tubes[0].inner[1].s: expected rising s"},
       {first_s.c_str(), "0", "path.pose_tubes[0].inner[0].s: expected rising s"},
       {first_s.c_str(), "1/9007199254740992", "inner[0].s: expected a denominator of at most 2^52"},
       {first_tube.c_str(), "0x1p-3", tube.c_str()},
       {quaternion.c_str(), numbers({0, 0, 0, 0}), "inner[0].quaternion: expected a quaternion that is not 0"},
       {"/path/pose_tubes/1/turn", "0x0p+0", "path.pose_tubes[1]: expected a positive width"},
       {"/path/pose_tubes/1/turn", "0x1p-3", tube.c_str()},
       {"/path/pose_tubes/0/inner", Json::array(), "path.pose_tubes[0].inner: expected inner poses"},
       {"/path/waypoints/0/lengths/3", "0x0p+0", "path.waypoints[0].lengths: expected positive lengths"},
       {"/problem/space/constants", {{"c", "1"}}, "problem.space: expected the one of the free coordinates"},
       {"/witness/motion/0/s/1", "1/2", "witness.motion[0].s: expected a box that reaches across no pose"},
       {"/witness/motion/0/segment", 2, "witness.motion[0].segment: expected an integer from 0 to 1"},
       {"/witness/motion/0/parts", 1, "witness.motion[0]: expected no key 'parts'"},
       {"/witness/proof/near", kRemoved, "witness.proof: expected the key 'near'"},
       {"/witness/proof/s", {"0", "1"}, "witness.proof: expected no key 's'"},
       {"/witness/deviation/way", nullptr, "witness.deviation.way: expected an object"},
       {"/witness/deviation/platform_anchors_m", repeated(6, repeated(3, "0")), zero_way.c_str()},
       {second_tau.c_str(), "1/2", "witness.deviation.way.poses: expected tau = 1 at last"},
       {second_tau.c_str(), "0", "witness.deviation.way.poses[1].tau: expected 0 at first, then rising"},
       {box_s.c_str(), {"0", "1/2"}, "witness.deviation.way.boxes: expected boxes up to 1"},
       {box_s.c_str(), {"1/2", "1"}, "witness.deviation.way.boxes[0].s: expected a box that begins where"},
       {way_near.c_str(), near(5), "witness.deviation.way.boxes[0].near.at: expected an array of 6"},
       {way_tube.c_str(), {{"position", "0x1p-6"}, {"turn", "0x1p-4"}}, "poses[1].tube: expected a tube that contains"},
       {way_tube.c_str(), {{"position", "0x0p+0"}, {"turn", "0x0p+0"}}, "poses[1].tube: expected positive widths"}});
}

TEST(Reader, NamesWhatIsWrongWithARefutedCertificate) {
  Json singular = {{"at", {{"segment", 0}, {"s", "0"}}},
                   {"to", {{"waypoint", 1}}},
                   {"kind", "singular"},
                   {"at_proof", {{"bits", 64}}},
                   {"to_proof", {{"bits", 64}}}};
  expect_messages(
      refuted(),
      {{"/witness/value", {"0.04", "0.051"}, "witness.value: expected an enclosure that lies beyond the limit"},
       {"/witness/value", {"0.05", "0.04"}, "witness.value: expected ends in order"},
       {"/witness/limit", "0.5", "witness.limit: expected the cable's limit in the problem"},
       {"/witness/kind", "tension_max", "witness.limit"},
       {"/witness/kind", "slack", "witness.kind: expected a kind of the format"},
       {"/witness/cable", 7, "witness.cable: expected an integer from 1 to 6"},
       {"/witness/at/s", "1", kOutside.c_str()},
       {"/witness/at/s", "1/8", kOutside.c_str()},
       {"/witness/at/segment", 1, kOutside.c_str()},
       {"/witness/at", {{"segment", 1}, {"s", "3/4"}}, kOutside.c_str()},  // in an open stretch
       {"/witness/at", {{"waypoint", 1}}, kOutside.c_str()},
       {"/witness/deviation", Json::object(), "witness.deviation: expected tolerances to be within"},
       {"/witness", singular, "witness: expected the key 'motion'"},
       {"/witness", nullptr, "witness: expected an object with the key 'kind'"},
       {"/margins", {{"length_m", "1"}}, "margins: expected no key 'length_m'"},
       {"/stretches/0/outer/0/s", "1/8", "stretches: expected boxes and outer ends that tile the path"},
       {"/stretches/0/outer/1/s", "3/4", "stretches: expected boxes and outer ends that tile the path"},
       {"/stretches/1", kRemoved, "stretches: expected boxes and outer ends that tile the path"},
       {"/stretches/0/outer/1/s", "1/4", "stretches[0].outer: expected two places in order"},
       {"/stretches/0/inner/0/at/s", "3/4", "stretches[0].inner[0]: expected a place between the outer ends"},
       {"/stretches/0/inner/0/at/s", "1/2", "stretches[0].inner: expected two witnesses in order"},
       {"/stretches/0/reason", "why", "stretches[0].reason: expected null"},
       {"/stretches/1/reason", nullptr, "stretches[1].reason: expected a string"},
       {"/stretches", nullptr, "segments: expected an array of 0"}});
  Json motion = box("0", "1/4");
  motion["segment"] = 0;
  Json json = refuted();
  json["witness"]["motion"] = {motion};
  EXPECT_EQ(message(sealed(json)), "none");  // the witness of a stretch need not repeat it
  json = refuted();
  json["segments"][0]["boxes"] = Json::array();
  json["segments"][0]["margins"] = nullptr;
  json["stretches"][0]["outer"] = {{{"segment", 0}, {"s", "0"}}, {{"segment", 0}, {"s", "1"}}};
  EXPECT_EQ(message(sealed(json)), "none");
}

TEST(Reader, TakesAWitnessAnywhereInAViolatedStretchAndNowhereElse) {
  const auto seen = [](const Json& witness) {
    Json json = refuted();
    json["witness"] = witness;
    return message(sealed(json));
  };
  const auto between = [](int from, const char* s, int to, const char* t) {
    return Json{{"at", {{"segment", from}, {"s", s}}}, {"to", {{"segment", to}, {"s", t}}}, {"kind", "singular"},
                {"at_proof", {{"bits", 64}}},          {"to_proof", {{"bits", 64}}},        {"motion", Json::array()}};
  };
  Json inside = witness();
  inside["value"] = {"-7", "-6"};
  for (const char* s : {"1/4", "3/8", "1/2"}) {
    inside["at"]["s"] = s;
    EXPECT_EQ(seen(inside), "none") << s;
  }
  EXPECT_EQ(seen(between(0, "1/4", 0, "1/2")), "none");
  EXPECT_EQ(seen(between(0, "7/16", 0, "3/8")), "none");
  EXPECT_NE(seen(between(0, "1/8", 0, "1/2")).find(kOutside), std::string::npos);
  EXPECT_NE(seen(between(0, "3/8", 0, "5/8")).find(kOutside), std::string::npos);
  EXPECT_NE(seen(between(0, "5/8", 0, "3/8")).find(kOutside), std::string::npos);
  EXPECT_NE(seen(between(0, "3/8", 1, "3/8")).find(kOutside), std::string::npos);
  EXPECT_NE(seen(between(0, "3/8", 1, "3/4")).find(kOutside), std::string::npos);
}

TEST(Reader, TakesAWitnessWithinOneStretchOnly) {
  Json json = refuted();
  Json& stretches = json["stretches"];
  stretches.insert(stretches.begin(), stretches[0]);
  stretches[0]["outer"][1]["s"] = stretches[1]["outer"][0]["s"] = "3/8";
  for (Json& inner : stretches[1]["inner"]) inner["at"]["s"] = "3/8";
  EXPECT_EQ(message(sealed(json)), "none");  // two violated stretches that meet
  json["witness"] = {
      {"at", {{"segment", 0}, {"s", "1/4"}}}, {"to", {{"segment", 0}, {"s", "1/2"}}}, {"kind", "singular"},
      {"at_proof", {{"bits", 64}}},           {"to_proof", {{"bits", 64}}},           {"motion", Json::array()}};
  EXPECT_NE(message(sealed(json)).find(kOutside), std::string::npos);
}

TEST(Reader, NamesWhatIsWrongWithAnUndecidedCertificate) {
  expect_messages(undecided(), {{"/undecided/segment", nullptr, "undecided: expected segment and box, or neither"},
                                {"/undecided/box", {"1", "0"}, "undecided.box: expected ends in order"},
                                {"/undecided/segment", 2, "undecided.segment: expected an integer from 0 to 1"},
                                {"/stretches", refuted()["stretches"], "stretches: expected open ones only"}});
}

}  // namespace
}  // namespace taut::checker
