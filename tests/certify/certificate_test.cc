// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include "base/input_error.h"
#include "base/sha256.h"
#include "certificate/certificate_reader.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "certify/path_proof.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using nlohmann::json;
using testing::robot1_slice;

Path short_path() { return {{{{-2.3, 1.6}, {0, 0}}, {{-2.25, 1.5}, {0, 0}}, {{-2.25, 1.4}, {0, 0}}}}; }

json written(const Problem& problem, const Path& path, const PathProof& proof) {
  return json::parse(certificate_text(elaborate(problem, path, proof)));
}

TEST(HexFloat, ReadsBackBitForBit) {
  for (const double x : {0.0, 1.0, -2.3, 0.1, 5e-324, 1.7976931348623157e308, std::nextafter(1.0, 2.0)}) {
    EXPECT_EQ(std::strtod(hex_float(x).c_str(), nullptr), x);
  }
  EXPECT_EQ(hex_float(-2.3), "-0x1.2666666666666p+1");
}

TEST(HexFloat, IsWhatCPrints) {
  std::mt19937_64 random(20261122);
  for (int trial = 0; trial < 100'000; ++trial) {
    std::uint64_t bits = random();
    if (trial % 4 == 0) bits &= ~(std::uint64_t{0x7FF} << 52U);  // subnormal
    if (trial % 5 == 0) bits &= ~std::uint64_t{0} << (random() % 53);
    const auto x = std::bit_cast<double>(bits);
    if (!std::isfinite(x)) continue;
    std::array<char, 40> printed{};
    std::snprintf(printed.data(), printed.size(), "%a", x);
    ASSERT_EQ(hex_float(x), printed.data());
  }
}

TEST(Sha256, IsThatOfTheCanonicalText) {
  EXPECT_EQ(sha256(json::object()), "44136fa355b3678a1146ad16f7e8649e94fb4fc21fe77e8310c060f61caaff8a");  // of {}
}

TEST(NearestBinary64, RoundsTheExactValueOfWhatWasTyped) {
  EXPECT_EQ(nearest_binary64("-2.3"), -2.3);
  EXPECT_EQ(nearest_binary64("pi/2"), 0x1.921fb54442d18p+0);
  EXPECT_EQ(nearest_binary64("(34)*pi/180"), 34.0 * 3.14159265358979323846 / 180.0);
  EXPECT_EQ(nearest_binary64("1 + 1.110223024625156540423631668090820312500e-16"), 1.0) << "a tie goes to even";
  EXPECT_EQ(nearest_binary64("1 + 1.1102230246251565404236316680908203126e-16"), std::nextafter(1.0, 2.0));
  EXPECT_THROW((void)nearest_binary64("1/0"), InputError);
  EXPECT_THROW((void)nearest_binary64("sqrt(-1)"), InputError);
}

TEST(Elaborate, MarginsAreTheSmallestOfTheSegments) {
  const Problem problem = robot1_slice();
  const Certificate certificate = elaborate(problem, short_path(), prove_path(Prover(problem), short_path()));
  ASSERT_EQ(certificate.verdict, Verdict::kProved);
  ASSERT_EQ(certificate.segments.size(), 2u);
  const auto smallest = [&](DecimalText Margins::*member) {
    return std::min(std::stod((*certificate.segments[0].margins).*member),
                    std::stod((*certificate.segments[1].margins).*member));
  };
  EXPECT_EQ(std::stod(certificate.margins->tension_N), smallest(&Margins::tension_N));
  EXPECT_EQ(std::stod(certificate.margins->length_m), smallest(&Margins::length_m));
  EXPECT_EQ(std::stod(certificate.margins->wrench_scale), smallest(&Margins::wrench_scale));
  EXPECT_GE(std::stod(certificate.margins->wrench_scale), 1.0);
}

TEST(PathProof, RefutesAPathWithOneBadSegmentAndEnclosesTheViolation) {
  Path path = short_path();
  path.waypoints.push_back({{1.7, 1.7}, {0, 0}});
  const PathProof proof = prove_path(Prover(robot1_slice()), path);
  ASSERT_EQ(proof.verdict, Verdict::kRefuted);
  ASSERT_TRUE(proof.witness.has_value());
  EXPECT_TRUE(proof.witness->at.on_segment);
  EXPECT_EQ(proof.witness->at.index, 2);
  EXPECT_LE(std::stod(proof.witness->value_lower), std::stod(proof.witness->value_upper));
}

TEST(PathProof, OneInfeasibleWaypointIsRefutedWithItsCable) {
  const PathProof proof = prove_path(Prover(robot1_slice()), {{{{0.0, 1.6}, {0, 0}}}});
  ASSERT_EQ(proof.verdict, Verdict::kRefuted);
  EXPECT_FALSE(proof.witness->at.on_segment);
  EXPECT_FALSE(proof.witness->limit.empty());
}

TEST(PathProof, OneFeasibleWaypointIsNoPath) {
  const PathProof proof = prove_path(Prover(robot1_slice()), {{{{-2.3, 1.6}, {0, 0}}}});
  EXPECT_EQ(proof.verdict, Verdict::kUndecided);
}

TEST(PathProof, AnUntouchedResultClaimsNothing) { EXPECT_EQ(PathProof{}.verdict, Verdict::kUndecided); }

TEST(Certificate, StatesDigestsAndCountsOfWhatItHolds) {
  const Problem problem = robot1_slice();
  const PathProof proof = prove_path(Prover(problem), short_path());
  const json certificate = written(problem, short_path(), proof);
  EXPECT_EQ(certificate["problem_sha256"], sha256(certificate["problem"]));
  EXPECT_EQ(certificate["path_sha256"], sha256(certificate["path"]));
  json body = certificate;
  body.erase("footer");
  EXPECT_EQ(certificate["footer"]["sha256"], sha256(body));
  EXPECT_EQ(certificate["footer"]["waypoints"], 3);
  EXPECT_EQ(certificate["footer"]["segments"], 2);
  std::size_t boxes = 0;
  for (const json& segment : certificate["segments"]) boxes += segment["boxes"].size();
  EXPECT_EQ(certificate["footer"]["boxes"], boxes);
  EXPECT_GE(boxes, 2u);
  EXPECT_EQ(certificate["version"], 4);
}

TEST(Certificate, HoldsNoFractionalNumber) {
  const Problem problem = robot1_slice();
  const json certificate = written(problem, short_path(), prove_path(Prover(problem), short_path()));
  const std::function<void(const json&)> visit = [&](const json& value) {
    EXPECT_FALSE(value.is_number_float());
    if (value.is_structured()) {
      for (const json& child : value) visit(child);
    }
  };
  visit(certificate);
}

TEST(Certificate, ItsPathReadsBackBitForBit) {
  const Path path = {{{{-2.3, 0.1}, {0, 0}}, {{5e-324, -0.25}, {-2, 0}}}};
  const json certificate = written(robot1_slice(), path, PathProof{});
  EXPECT_EQ(read_path(certificate["path"]).waypoints, path.waypoints);
}

TEST(Certificate, MalformedPathsAreRefusedWithTheirPlace) {
  const json good = written(robot1_slice(), short_path(), PathProof{})["path"];
  const auto complaint = [&](const char* patch) -> std::string {
    try {
      (void)read_path(good.patch(json::array({json::parse(patch)})));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(R"({"op":"remove","path":"/times"})"), "path: expected the key 'times'");
  EXPECT_EQ(complaint(R"({"op":"remove","path":"/waypoints/1/x"})"), "path.waypoints[1]: expected the key 'x'");
  EXPECT_EQ(complaint(R"({"op":"add","path":"/interpolation","value":"bent"})"),
            "path.interpolation: got \"bent\", expected one of straight-in-parameters, cubic-b-spline, geodesic, "
            "straight-in-cable-lengths");
  EXPECT_EQ(complaint(R"({"op":"add","path":"/waypoints/0/half_turns","value":[]})"),
            "path.waypoints[0].half_turns: got [], expected a list of 2");
  for (const char* value : {R"("0x1p")", R"("nan")", R"("inf")", R"("1")", R"("0x2p+0")", R"("")"}) {
    const std::string patch = R"({"op":"replace","path":"/waypoints/2/x/1","value":)" + std::string(value) + "}";
    EXPECT_EQ(complaint(patch.c_str()), "path.waypoints[2].x[1]: got " + std::string(value) +
                                            ", expected a finite binary64 as %a prints it, such as \"0x1.8p+1\"");
  }
  for (const char* value : {"1000001", "-1000001", "0.5", "18446744073709551615", "null", R"("1")"}) {
    const std::string patch =
        R"({"op":"replace","path":"/waypoints/2/half_turns/0","value":)" + std::string(value) + "}";
    EXPECT_EQ(complaint(patch.c_str()), "path.waypoints[2].half_turns[0]: got " + std::string(value) +
                                            ", expected a whole number from -1000000 to 1000000");
  }
  for (const char* value : {R"([1])", R"("1")", "3", "{}"}) {
    const std::string patch = R"({"op":"replace","path":"/times","value":)" + std::string(value) + "}";
    EXPECT_THAT(complaint(patch.c_str()), ::testing::StartsWith("path.times"));
  }
}

}  // namespace
}  // namespace taut
