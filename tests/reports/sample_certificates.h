// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates for the tests of a report's words: Robot 1 on its slice. Right in form, and the first steps of a real
// path; digests, boxes and margins are made up. No theorem can be made of them: what a report does with a theorem, and
// what it does without one, is theorem_test.cc's and tests/cli/report_test.py's to look at.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "certificate/certificate_reader.h"
#include "reports/summary/scene.h"

namespace taut::sample {

inline const std::string kProblemDigest(64, 'a');
inline const std::string kPathDigest(64, 'b');
inline const std::string kFooterDigest(64, 'c');

/// Without verdict.
inline nlohmann::json certificate() {
  using nlohmann::json;
  json ellipsoid = json::array();
  for (int i = 0; i < 6; ++i) {
    ellipsoid.push_back(json::array({"0", "0", "0", "0", "0", "0"}));
    ellipsoid[i][i] = i < 3 ? "10000" : "1000000";
  }
  const json problem = json::parse(R"({
    "name": "robot1-slice",
    "robot": {
      "base_anchors_m": [["0","0.22","0"], ["0","0.22","0"], ["-0.1905256","-0.11","0"], ["-0.1905256","-0.11","0"],
                         ["0.1905256","-0.11","0"], ["0.1905256","-0.11","0"]],
      "platform_anchors_m": [["-0.1125833","0.065","0"], ["0.1125833","0.065","0"], ["0","-0.13","0"],
                             ["-0.1125833","0.065","0"], ["0.1125833","0.065","0"], ["0","-0.13","0"]],
      "tension_N": [["0.05","0.5"], ["0.05","0.5"], ["0.05","0.5"], ["0.05","0.5"], ["0.05","0.5"], ["0.05","0.5"]],
      "length_m": [["0.1","0.55"], ["0.1","0.55"], ["0.1","0.55"], ["0.1","0.55"], ["0.1","0.55"], ["0.1","0.55"]]},
    "load": {"point_m": ["0.03","0.014","-0.021"], "wrench": ["0","0","1","0","0","0"], "ellipsoid": []},
    "tolerances": null,
    "space": {"parameters": [{"name": "phi", "kind": "periodic"}, {"name": "theta", "kind": "real"}],
              "constants": {"sigma0": "34"}, "flip": [0, 1],
              "pose": {"px": "0", "py": "0", "pz": "0.35", "phi": "phi", "theta": "theta",
                       "sigma": "sigma0*pi/180"}, "constraints": []},
    "query": {"waypoints": [["-2.3","1.6"], ["-2.3","1.3"]]}})");
  json result = {{"format", "taut-certificate"},
                 {"version", 4},
                 {"generator", {{"name", "taut"}, {"version", "0.1.0"}}},
                 {"verdict", ""},
                 {"claim", "The claim of this certificate, word by word: f_lo,i < f_i < f_hi,i."},
                 {"problem", problem},
                 {"problem_sha256", kProblemDigest},
                 {"path", json::parse(R"({"interpolation": "straight-in-parameters", "waypoints": [
                 {"x": ["-0x1.2666666666666p+1", "0x1.999999999999ap+0"], "half_turns": [0, 0]},
                 {"x": ["-0x1.263f9b9445fddp+1", "0x1.916f44c547a8cp+0"], "half_turns": [0, 0]},
                 {"x": ["0x1.f8c4f8b6f0b0cp+1", "0x1.80b204f3ebddbp+0"], "half_turns": [-2, 0]}],
                 "tubes": [], "pose_tubes": [], "times": null})")},
                 {"path_sha256", kPathDigest},
                 {"segments", json::array()},
                 {"margins", json::object()},
                 {"witness", nullptr},
                 {"stretches", nullptr},
                 {"source", nullptr},
                 {"undecided", nullptr},
                 {"illustration", json::parse(R"({"kind": "atlas", "parameters": ["phi", "theta"], "charts": [
                 {"c": ["-2.3", "1.6"], "p": [["-2.3117","1.584"], ["-2.2914","1.5844"], ["-2.286","1.6051"]]}],
                 "stats": {"charts": 1, "plan_ms": "0.5"}})")},
                 {"footer", {{"waypoints", 3}, {"segments", 0}, {"boxes", 0}, {"sha256", kFooterDigest}}}};
  result["problem"]["load"]["ellipsoid"] = ellipsoid;
  return result;
}

inline nlohmann::json proved() {
  nlohmann::json result = certificate();
  result["verdict"] = "proved";
  result["segments"] = nlohmann::json::parse(R"([
      {"from": 0, "to": 1, "boxes": [{"bits": 64, "s": ["0", "1/2"]}, {"bits": 64, "s": ["1/2", "1"]}],
       "margins": {"tension_N": "5.11e-02", "length_m": "1.061e-02", "wrench_scale": "2.92e+00"}},
      {"from": 1, "to": 2, "boxes": [{"bits": 64, "s": ["0", "1"]}],
       "margins": {"tension_N": "4.25e-02", "length_m": "1.234e-02", "wrench_scale": "2.71e+00"}}])");
  result["margins"] = {{"tension_N", "4.25e-02"}, {"length_m", "1.061e-02"}, {"wrench_scale", "2.71e+00"}};
  result["footer"]["segments"] = 2;
  result["footer"]["boxes"] = 3;
  return result;
}

/// Adds bodies to a certificate: a plate on the platform, a floor and a post. Cables are not checked against each other
/// nor against the plate.
inline nlohmann::json with_bodies(nlohmann::json certificate) {
  using nlohmann::json;
  certificate["version"] = 5;
  certificate["problem"]["bodies"] = json::parse(R"({
    "platform": [{"name": "plate", "at_m": ["0","0","0"], "hull": {"radius_m": "0.002", "points_m": [
      ["-0.1","-0.1","0"], ["0.1","-0.1","0"], ["0.1","0.1","0"], ["-0.1","0.1","0"]]}}],
    "obstacles": [
      {"name": "floor", "at_m": ["0","0","-0.05"], "half_space": {"normal": ["0","0","2"]}},
      {"name": "post", "clearance_m": "0.03", "at_m": ["0.3","0","0"],
       "hull": {"radius_m": "0.02", "points_m": [["0","0","0"], ["0","0","0.5"]]}}],
    "cables": {"diameter_m": ["0.001","0.001","0.001","0.001","0.001","0.001"], "free_ends_m": [
      ["0.02","0.01"], ["0.02","0.01"], ["0.02","0.01"], ["0.02","0.01"], ["0.02","0.01"], ["0.02","0.01"]]},
    "clearance_m": {"platform-obstacles": "0.02", "cables-obstacles": "0.005"}})");
  certificate["path"]["directions"] = json::parse(R"([["W", -1, 0, 0]])");
  json apart = json::array();
  for (int n = 0; n < 14; ++n) apart.push_back(n % 2 == 0 ? json() : json(0));
  for (json& segment : certificate["segments"]) {
    segment["apart"] = apart;
    segment["margins"]["clearance_m"] = "0.0123";
  }
  if (!certificate["margins"].empty()) certificate["margins"]["clearance_m"] = "0.0123";
  return certificate;
}

/// Refuted, as the plate comes too near to the post.
inline nlohmann::json contact() {
  nlohmann::json result = with_bodies(certificate());
  result["verdict"] = "refuted";
  // The post stands where the plate is.
  result["problem"]["bodies"]["obstacles"][1]["at_m"] = {"0", "0", "0"};
  result["witness"] = nlohmann::json::parse(R"({"at": {"segment": 1, "s": "3/8"}, "kind": "contact", "pair": 1,
      "depth_m": "0.0315", "weights": [["1/4","1/4","1/4","1/4"], ["1/2","1/2"]], "proof": {"bits": 64},
      "motion": []})");
  return result;
}

inline nlohmann::json refuted() {
  nlohmann::json result = certificate();
  result["verdict"] = "refuted";
  result["witness"] = nlohmann::json::parse(R"({"at": {"segment": 1, "s": "3/8"}, "kind": "tension_max", "cable": 3,
                                                "value": ["0.8123", "0.8129"], "limit": "0.5",
                                                "proof": {"bits": 64}, "motion": []})");
  return result;
}

inline nlohmann::json singular() {
  nlohmann::json result = certificate();
  result["verdict"] = "refuted";
  result["witness"] =
      nlohmann::json::parse(R"({"at": {"waypoint": 0}, "to": {"segment": 1, "s": "5/8"}, "kind": "singular",
                               "at_proof": {"bits": 64}, "to_proof": {"bits": 64}, "motion": []})");
  return result;
}

inline nlohmann::json undecided() {
  nlohmann::json result = certificate();
  result["verdict"] = "undecided";
  result["undecided"] = {{"reason", "the determinant may vanish"}, {"segment", 1}, {"box", {"1/4", "3/8"}}};
  return result;
}

inline nlohmann::json no_path() {
  nlohmann::json result = certificate();
  result["verdict"] = "undecided";
  result["path"]["waypoints"] = nlohmann::json::array();
  result["undecided"] = {{"reason", "no path was found"}, {"segment", nullptr}, {"box", nullptr}};
  result["illustration"] = nullptr;
  return result;
}

/// No path was found: the certificate has the waypoints that were asked for.
inline nlohmann::json no_path_of_query() {
  nlohmann::json result = no_path();
  result["path"] = certificate()["path"];
  return result;
}

/// What a report would show if the checker had confirmed it; what claims nothing stays so.
inline ReportContext scene(const nlohmann::json& certificate) {
  Certificate stated = read_certificate(certificate);
  const bool is_claim = stated.verdict != Verdict::kUndecided;
  return {std::move(stated),
          {is_claim ? Recheck::Result::kConfirmed : Recheck::Result::kNoClaim, "taut-check 9.9", "so <it> is"}};
}

/// The proved path as a move in time, of a load with two weights and no gravity, that rests at each waypoint.
inline Certificate timed(double step_s = 0.5) {
  Certificate certificate = read_certificate(proved());
  Problem& problem = certificate.problem;
  problem.load.items = {
      {"payload", Weight{"0.02", "0.022", {"0", "0", "-0.02"}, "0.001", RationalVector{"0.05", "1/20", "0.04"}}},
      {"probe", Weight{"0.01", "0.01", {"0.03", "0", "0"}, "0"}}};
  TimeText& time = problem.time.emplace();
  time.winch_speed_m_s.fill("0.1");
  time.winch_power_W[2] = "2";
  time.load_acceleration_m_s2 = "0.25";
  time.load_angular_speed_rad_s = "(30)*pi/180";
  certificate.path.timing = TimeLaw{step_s, {0, 0, 0, 0.25, 0.75, 1, 1, 1, 1.25, 1.75, 2, 2, 2}};
  // Inertia takes some of the margins of tension, so that those of the path alone would be false.
  certificate.margins->wrench_scale = "1";
  certificate.margins->tension_N = "1e-3";
  for (CertificateSegment& segment : certificate.segments) {
    segment.margins->wrench_scale = "1";
    segment.margins->tension_N = "1e-3";
  }
  return certificate;
}
inline ReportContext scene(const Certificate& certificate) {
  const bool is_claim = certificate.verdict != Verdict::kUndecided;
  return {certificate,
          {is_claim ? Recheck::Result::kConfirmed : Recheck::Result::kNoClaim, "taut-check 9.9", "so <it> is"}};
}
/// The same refuted, as a winch would be too fast.
inline Certificate too_fast(RateId rate = {RateKind::kWinchSpeed, 2}) {
  Certificate certificate = timed();
  certificate.verdict = Verdict::kRefuted;
  certificate.segments.clear();
  certificate.margins.reset();
  Witness& witness = certificate.witness.emplace();
  witness.violation.at = {true, 1, Dyadic{1, 1}};
  witness.violation.rate = rate;
  witness.violation.value_lower = "123.4567";
  witness.violation.value_upper = "123.4568";
  return certificate;
}

/// The same if the checker had not come to an end.
inline ReportContext unchecked(const nlohmann::json& certificate) {
  return {read_certificate(certificate), {Recheck::Result::kUnchecked, "taut-check 9.9", "so <it> is"}};
}

/// Every string that a report may show tries to break out of it.
inline const std::string kAttack = R"("'></title></style><script>alert(1)</script><img src=x onerror=alert(2)>)";

inline nlohmann::json hostile() {
  nlohmann::json result = proved();
  for (const char* key : {"claim", "problem_sha256", "path_sha256"}) result[key] = kAttack;
  result["generator"] = {{"name", kAttack}, {"version", kAttack}};
  result["problem"]["name"] = kAttack;
  result["footer"]["sha256"] = kAttack;
  result["illustration"]["stats"] = {{kAttack, kAttack}, {"list", {kAttack}}};
  return result;
}

}  // namespace taut::sample
