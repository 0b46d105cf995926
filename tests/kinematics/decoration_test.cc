// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/decoration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/input_error.h"
#include "case/case_file.h"
#include "tests/support/binary_stl.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kObj = "v 0 0 0\nv 1000 0 0\nv 0 2000 0\nv 0 0 3000\nf 1 2 3\nf 1 2 4\n";

class DecorationOfACase : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("decoration-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  [[nodiscard]] Decoration read(const std::string& decoration) const {
    const std::string text =
        "taut: 1\nname: test\nunits: {length: mm, angle: deg}\nrobot:\n"
        "  base_anchors: [[0, 220, 0], [0, 220, 0], [-190, -110, 0], [-190, -110, 0], [190, -110, 0], [190, -110, 0]]\n"
        "  platform_anchors: [[-112, 65, 0], [112, 65, 0], [0, -130, 0], [-112, 65, 0], [112, 65, 0], [0, -130, 0]]\n"
        "  tension: [0.05, 0.5]\n  length: [100, 550]\n"
        "load: {wrench: [0, 0, 1, 0, 0, 0], ellipsoid: {diagonal: [1, 1, 1, 1, 1, 1]}}\n"
        "decoration: " +
        decoration + "\n";
    return read_meshes(parse_case(text, (folder_ / "test.yaml").string()).decoration);
  }
  void expect_rejected(const std::string& decoration, const std::string& message) const {
    EXPECT_THAT([&] { (void)read(decoration); },
                ThrowsMessage<InputError>(::testing::AllOf(HasSubstr("test.yaml:10:"), HasSubstr(message))))
        << decoration;
  }

 private:
  std::filesystem::path folder_;
};

using Corner = std::array<double, 3>;

TEST_F(DecorationOfACase, IsReadInItsUnitAndPutInItsPlace) {
  write("frame.obj", kObj);
  const Decoration there = read("{frame: {mesh: frame.obj, unit: mm, at: [100, 0, 0], rotation: {yaw: 90}}}");
  ASSERT_TRUE(there.frame.has_value());
  EXPECT_FALSE(there.payload.has_value());
  ASSERT_EQ(there.frame->corners.size(), 4u);
  const std::array<Corner, 4> expected = {{{0.1, 0, 0}, {0.1, 1, 0}, {-1.9, 0, 0}, {0.1, 0, 3}}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(there.frame->corners[i][k], expected[i][k], 1e-12);
  }
  EXPECT_THAT(there.frame->triangles,
              ::testing::ElementsAre(std::array<std::uint32_t, 3>{0, 1, 2}, std::array<std::uint32_t, 3>{0, 1, 3}));
}

TEST_F(DecorationOfACase, AnglesTurnInTheOrderOfRollPitchYaw) {
  write("frame.obj", kObj);
  const Decoration there = read("{payload: {mesh: frame.obj, unit: m, rotation: {roll: 90, yaw: 90}}}");
  // Rz(90°) Rx(90°) takes y to z, and z to x: z goes to −y by Rx, and that to x by Rz.
  const std::vector<Corner>& corners = there.payload->corners;
  EXPECT_NEAR(corners[2][2], 2000, 1e-9);
  EXPECT_NEAR(corners[3][0], 3000, 1e-9);
}

TEST_F(DecorationOfACase, MayBeStlOfEitherKindOrPly) {
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  write("binary.stl", testing::binary_stl(2, corners));
  write("text.STL",
        "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "endsolid x\n");
  write("quad.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  EXPECT_EQ(read("{frame: {mesh: binary.stl, unit: m}}").frame->triangles.size(), 2u);
  EXPECT_EQ(read("{frame: {mesh: text.STL, unit: m}}").frame->triangles.size(), 1u);
  EXPECT_EQ(read("{frame: {mesh: quad.ply, unit: m}}").frame->triangles.size(), 2u) << "a quadrangle";
}

TEST_F(DecorationOfACase, IsRefusedWhereItIsNoMesh) {
  write("frame.obj", kObj);
  write("empty.obj", "");
  write("words.stl", "solid but no more");
  write("cut.stl", testing::binary_stl(3, std::vector<float>(18, 1.0F)));
  write("huge.stl", testing::binary_stl(4'000'000'000U, std::vector<float>(9, 1.0F)));
  write("nan.stl", testing::binary_stl(1, std::vector<float>(9, std::numeric_limits<float>::quiet_NaN())));
  write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  write("far.obj", "v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n");
  std::string many = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (std::size_t i = 0; i <= kMostShownTriangles; ++i) many += "f 1 2 3\n";
  write("many.obj", many);
  expect_rejected("{frame: {mesh: none.obj, unit: mm}}", "No such file");
  expect_rejected("{frame: {mesh: ., unit: mm}}", "expected the name of an STL, OBJ or PLY file");
  expect_rejected("{frame: {mesh: frame.obj}}", "got no 'unit'");
  expect_rejected("{frame: {mesh: frame.obj, unit: kg}}", "expected the unit of the mesh's coordinates, one of m");
  expect_rejected("{frame: {mesh: frame.obj, unit: mm, at: [0, 0]}}", "expected a point");
  expect_rejected("{frame: {mesh: frame.obj, unit: mm, scale: 2}}", "decoration.frame");
  expect_rejected("{base: {mesh: frame.obj, unit: mm}}", "decoration");
  for (const char* name : {"empty.obj", "words.stl", "cut.stl", "huge.stl", "nan.stl", "index.obj", "far.obj"}) {
    expect_rejected(std::string("{payload: {mesh: ") + name + ", unit: m}}", "expected a mesh");
  }
  expect_rejected("{frame: {mesh: many.obj, unit: m}}", "a mesh of 20001 triangles, expected at most 20000");
}

}  // namespace
}  // namespace taut
