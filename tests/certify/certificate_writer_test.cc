// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/input_error.h"
#include "base/sha256.h"
#include "certificate/certificate_reader.h"
#include "certificate/elaborate.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using nlohmann::json;

/// What the writer makes of a certificate's parts, kept in files.
json streamed(const Certificate& certificate) {
  const Path& path = certificate.path;
  CertificateWriter writer(certificate.problem, path.interpolation, std::filesystem::temp_directory_path());
  for (const Waypoint& waypoint : path.waypoints) writer.add_waypoint(waypoint_text(path.interpolation, waypoint));
  for (const std::string& time : path.times) writer.add_time(time);
  for (const double tube : path.tubes) writer.add_tube(tube);
  for (std::size_t k = 0; k < path.pose_tubes.size(); ++k) {
    const bool has_inner_poses = k < path.inner_poses.size();
    writer.add_pose_tube(path.pose_tubes[k], has_inner_poses ? path.inner_poses[k] : std::vector<InnerPose>());
  }
  for (std::size_t k = 0; k < path.segments(); ++k) {
    const bool is_proved = k < certificate.segments.size();
    const CertificateSegment segment = is_proved ? certificate.segments[k] : CertificateSegment();
    writer.add_segment(segment_text(segment, k, certificate.problem, path.interpolation), segment.boxes.size());
  }
  std::string text;
  writer.finish(certificate, [&](std::string_view piece) { text += piece; });
  return json::parse(text);
}

/// A short way from the start of Robot 1's query in steps.
Path path_of(const Problem& problem, Interpolation law) {
  Path path;
  path.interpolation = law;
  path.waypoints = {query_waypoints(problem).front()};
  for (int k = 1; k < 5; ++k) {
    path.waypoints.push_back(path.waypoints.back());
    path.waypoints.back().parameters().x[0] += 0.01;
    path.waypoints.back().parameters().half_turns[0] = k == 4 ? 0 : 2;
  }
  for (int k = 0; k < 4; ++k) path.waypoints[static_cast<std::size_t>(k)].parameters().half_turns[0] = 0;
  return path;
}

TEST(CertificateWriter, WritesTheSameFromFilesAndFromMemory) {
  const Problem problem = testing::robot1_slice();
  const Prover prover(problem);
  for (const Interpolation law : {Interpolation::kStraight, Interpolation::kCubicBSpline}) {
    Path path = path_of(problem, law);
    path.times = {"0", "0.5", "1", "1.5", "1e3"};
    const PathProof proof = prove_path(prover, path);
    ASSERT_EQ(proof.verdict, Verdict::kProved);
    Certificate certificate = elaborate(problem, path, proof);
    certificate.illustration = {{"a \"quoted\" Gerät", {1, 2}}, {"b", nullptr}};
    EXPECT_EQ(streamed(certificate), json::parse(certificate_text(certificate)));
  }
}

TEST(CertificateWriter, WritesSegmentsOfWhichNothingIsProved) {
  const Problem problem = testing::robot1_slice();
  const Prover prover(problem);
  Path path;
  path.waypoints = query_waypoints(problem);  // straight from start to goal is infeasible
  const PathProof proof = prove_path(prover, path);
  ASSERT_EQ(proof.verdict, Verdict::kRefuted);
  const Certificate certificate = elaborate(problem, path, proof);
  json expected = json::parse(certificate_text(certificate));
  json seen = streamed(certificate);
  EXPECT_EQ(seen["segments"], json::parse(R"([{"boxes": [], "from": 0, "margins": null, "to": 1}])"));
  for (const char* key : {"segments", "footer"}) {
    expected.erase(key);
    seen.erase(key);
  }
  EXPECT_EQ(seen, expected);
}

TEST(CertificateWriter, WritesWaypointsOfAllKinds) {
  const Waypoint plain{{0.1, -2}, {0, -3}};
  EXPECT_EQ(waypoint_text(Interpolation::kStraight, plain),
            R"({"half_turns":[0,-3],"x":["0x1.999999999999ap-4","-0x1p+1"]})");
  const Waypoint implied{{0.1, -2}, {0, 0}, {1, 0.5}};
  EXPECT_EQ(waypoint_text(Interpolation::kCubicBSpline, implied),
            R"({"half_turns":[0,0],"normals":["0x1p+0","0x1p-1"],"x":["0x1.999999999999ap-4","-0x1p+1"]})");
  const PosePoint pose{{1, 2, 4, 0, 0, 0, 1}};
  EXPECT_EQ(waypoint_text(Interpolation::kGeodesic, pose),
            R"({"position":["0x1p+0","0x1p+1","0x1p+2"],"quaternion":["0x0p+0","0x0p+0","0x0p+0","0x1p+0"]})");
  const LengthsPoint with_lengths{pose.pose, {8, 8, 8, 8, 8, 16}};
  EXPECT_EQ(waypoint_text(Interpolation::kCableLengths, with_lengths).substr(0, 73),
            R"({"lengths":["0x1p+3","0x1p+3","0x1p+3","0x1p+3","0x1p+3","0x1p+4"],"posit)");
}

TEST(CertificateWriter, ReadsBackWithPosesAndTubes) {
  const Problem problem = testing::robot1_slice();
  for (const Interpolation law : {Interpolation::kGeodesic, Interpolation::kCableLengths}) {
    Path path;
    path.interpolation = law;
    for (int k = 0; k < 3; ++k) {
      std::vector<double> x = {0.1 * k, 2, 4, 0, 0.1, 0, 1};
      if (law == Interpolation::kCableLengths) x.insert(x.end(), 6, 0.3);
      path.waypoints.push_back(waypoint_of(law, x, {}));
    }
    path.pose_tubes = {{0.1, 0.2}, {0x1p-40, 1}};
    path.inner_poses = {{}, {{0x1p-40, {0.1, 2, 4, 0, 0.3, 0, 1}, {0.3, 0.7}}, {0.75, {1, 2, 3, 4, 5, 6, 7}, {1, 2}}}};
    path.tubes = {0.5, 0.25};
    const Path back = read_path(json::parse(certificate_text(elaborate(problem, path, {})))["path"]);
    EXPECT_EQ(back.waypoints, path.waypoints);
    EXPECT_EQ(back.pose_tubes, path.pose_tubes);
    EXPECT_EQ(back.inner_poses, path.inner_poses);
    EXPECT_EQ(back.tubes, path.tubes);
    EXPECT_EQ(back.interpolation, law);
  }
}

TEST(CertificateWriter, LengthsAreNotReadPastUnderALawThatHasNone) {
  Path path;
  path.interpolation = Interpolation::kCableLengths;
  path.waypoints.assign(2, LengthsPoint{{0, 0, 0.35, 0, 0, 0, 1}, {1, 1, 1, 1, 1, 1}});
  path.pose_tubes = {{0.1, 0.2}};
  path.inner_poses = {{}};
  json text = json::parse(certificate_text(elaborate(testing::robot1_slice(), path, {})))["path"];
  EXPECT_EQ(read_path(text).waypoints, path.waypoints);
  text["interpolation"] = "geodesic";
  EXPECT_THAT([&] { static_cast<void>(read_path(text)); },
              ::testing::Throws<FieldError>(
                  ::testing::Property(&FieldError::what, ::testing::HasSubstr("no such key under this law"))));
}

TEST(CertificateWriter, SignsWhatAWholeCertificateIsSignedFor) {
  const Problem problem = testing::robot1_slice();
  CertificateWriter writer(problem, Interpolation::kStraight);
  std::string text;
  std::string digest;
  Certificate certificate_end;
  certificate_end.undecided = OpenPart{"none", {}, {}};
  writer.finish(
      certificate_end, [&](std::string_view piece) { text += piece; },
      [&](const std::string& of) {
        digest = of;
        return json{{"value", "x"}};
      });
  json certificate = json::parse(text);
  EXPECT_EQ(certificate["signature"], json({{"value", "x"}}));
  EXPECT_EQ(certificate["footer"]["sha256"], digest);
  certificate.erase("signature");
  certificate.erase("footer");
  EXPECT_EQ(sha256(certificate), digest);
}

TEST(CertificateWriter, SaysWhereItCannotSpool) {
  EXPECT_THROW(CertificateWriter(testing::robot1_slice(), Interpolation::kStraight, "/nowhere/at/all"), InputError);
}

}  // namespace
}  // namespace taut
