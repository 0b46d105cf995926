// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/input_error.h"
#include "tests/support/binary_stl.h"

namespace taut {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A tetrahedron, whose faces look outward.
const PolygonSoup kTetrahedron = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

TEST(MeshRepair, LeavesAGoodMeshAsItIs) {
  const LoadedMesh loaded = repaired(kTetrahedron);
  EXPECT_EQ(loaded.mesh.vertices.size(), 4U);
  EXPECT_EQ(loaded.mesh.triangles.size(), 4U);
  EXPECT_TRUE(loaded.mesh.needles.empty());
  const MeshReport& report = loaded.report;
  EXPECT_EQ(report.split_faces + report.merged_points + report.unused_points + report.dropped_triangles, 0U);
  EXPECT_TRUE(report.is_watertight());
  EXPECT_EQ(report.closed_components, 1U);
  EXPECT_EQ(report.open_components, 0U);
  EXPECT_THAT(report.lower, ElementsAre(0, 0, 0));
  EXPECT_THAT(report.upper, ElementsAre(1, 1, 1));
}

TEST(MeshRepair, MergesEqualPoints) {
  PolygonSoup soup;  // each triangle has points of its own, and one of them a zero with a sign
  for (const auto& face : kTetrahedron.faces) {
    for (const std::size_t i : face) soup.points.push_back(kTetrahedron.points[i]);
    const std::size_t k = soup.points.size();
    soup.faces.push_back({k - 3, k - 2, k - 1});
  }
  soup.points[0][1] = -0.0;
  const LoadedMesh loaded = repaired(soup);
  EXPECT_EQ(loaded.mesh.vertices.size(), 4U);
  EXPECT_EQ(loaded.report.merged_points, 8U);
  EXPECT_TRUE(loaded.report.is_watertight());
  soup.points[0][1] = 5e-324;  // near is not equal
  EXPECT_FALSE(repaired(soup).report.is_watertight());
}

TEST(MeshRepair, DropsTrianglesThatAreThereTwice) {
  PolygonSoup soup = kTetrahedron;
  soup.faces.push_back({1, 2, 0});
  const LoadedMesh loaded = repaired(soup);
  EXPECT_EQ(loaded.mesh.triangles.size(), 4U);
  EXPECT_EQ(loaded.report.dropped_triangles, 1U);
  EXPECT_TRUE(loaded.report.is_watertight());
}

TEST(MeshRepair, LosesNothingOfTheSurface) {
  PolygonSoup soup = kTetrahedron;
  soup.points.insert(soup.points.end(), {{5, 0, 0}, {6, 0, 0}, {9, 9, 9}, {7, 7, 7}, {0.5, 0, 0}});
  soup.faces.push_back({0, 1, 1});  // an edge of the tetrahedron
  soup.faces.push_back({2, 2, 2});  // a corner of it
  soup.faces.push_back({4, 5, 4});  // a segment elsewhere
  soup.faces.push_back({7, 7, 7});  // a point elsewhere
  soup.faces.push_back({0, 8, 1});  // no area, but three corners
  const LoadedMesh loaded = repaired(soup);
  EXPECT_EQ(loaded.mesh.triangles.size(), 5U);
  EXPECT_EQ(loaded.report.dropped_triangles, 4U);
  EXPECT_EQ(loaded.report.flat_triangles, 1U);
  EXPECT_EQ(loaded.report.unused_points, 1U);
  ASSERT_EQ(loaded.mesh.needles.size(), 2U);
  const auto& vertices = loaded.mesh.vertices;
  EXPECT_THAT(vertices[loaded.mesh.needles[0][0]], ElementsAre(5, 0, 0));
  EXPECT_THAT(vertices[loaded.mesh.needles[0][1]], ElementsAre(6, 0, 0));
  EXPECT_THAT(vertices[loaded.mesh.needles[1][0]], ElementsAre(7, 7, 7));
  EXPECT_THAT(loaded.report.upper, ElementsAre(7, 7, 7));
}

TEST(MeshRepair, TellsFlatTrianglesExactly) {
  // The middle corner of 0.1 (1, 3, 7) and 0.3 (1, 3, 7) in binary64 is not on the line of its neighbours; that of
  // integers is.
  const auto flat = [](std::array<double, 3> a, std::array<double, 3> b, std::array<double, 3> c) {
    return repaired({{a, b, c}, {{0, 1, 2}}}).report.flat_triangles;
  };
  EXPECT_EQ(flat({1, 3, 7}, {2, 6, 14}, {3, 9, 21}), 1U);
  EXPECT_EQ(flat({1, 3, 7}, {2, 6, 14}, {3, 9, std::nextafter(21.0, 22.0)}), 0U);
  EXPECT_EQ(flat({0, 0, 0}, {1e-170, 1e-170, 0}, {2e-170, 2e-170, 0}), 1U);
  EXPECT_EQ(flat({0, 0, 0}, {1e-170, 1e-170, 0}, {2e-170, 3e-170, 0}), 0U);
  EXPECT_EQ(flat({0, 0, 0}, {0.1, 0.3, 0.7}, {0.2, 0.6, 1.4}), 1U);
  EXPECT_EQ(flat({0, 0, 0}, {0.1, 0.3, 0.7}, {0.1 * 3, 0.3 * 3, 0.7 * 3}), 0U);
}

TEST(MeshReport, CountsPartsAndTheirHoles) {
  PolygonSoup soup = kTetrahedron;  // two of them, the second without its last face
  for (const auto& p : kTetrahedron.points) soup.points.push_back({p[0] + 10, p[1], p[2]});
  for (std::size_t k = 0; k < 3; ++k) {
    soup.faces.push_back({});
    for (const std::size_t i : kTetrahedron.faces[k]) soup.faces.back().push_back(i + 4);
  }
  const MeshReport holed = repaired(soup).report;
  EXPECT_FALSE(holed.is_watertight());
  EXPECT_EQ(holed.edges_of_one, 3U);
  EXPECT_EQ(holed.closed_components, 1U);
  EXPECT_EQ(holed.open_components, 1U);
  soup.faces.push_back({5, 6, 7});
  EXPECT_EQ(repaired(soup).report.closed_components, 2U);
  EXPECT_TRUE(repaired(soup).report.is_watertight());
}

TEST(MeshReport, CountsEdgesOfMoreThanTwoTriangles) {
  PolygonSoup soup = kTetrahedron;
  soup.points.push_back({1, 1, 1});
  soup.faces.push_back({1, 2, 4});  // a fin
  const MeshReport report = repaired(soup).report;
  EXPECT_EQ(report.edges_of_many, 1U);
  EXPECT_EQ(report.edges_of_one, 2U);
  EXPECT_EQ(report.open_components, 1U);
  EXPECT_FALSE(report.is_watertight());
}

class MeshFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("mesh-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  LoadedMesh load(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return load_mesh(folder_ / name);
  }
  void expect_rejected(const std::string& name, const std::string& content, const std::string& message) {
    EXPECT_THAT([&] { (void)load(name, content); }, ThrowsMessage<InputError>(HasSubstr(message))) << name;
  }
  std::filesystem::path folder_;
};

std::string stl_of_tetrahedron() {
  std::vector<float> corners;
  for (const auto& face : kTetrahedron.faces) {
    for (const std::size_t i : face) {
      for (const double x : kTetrahedron.points[i]) corners.push_back(static_cast<float>(x) * 0.1F);
    }
  }
  return testing::binary_stl(4, corners);
}

TEST_F(MeshFiles, OfAllKindsHoldTheSameTetrahedron) {
  std::string
      text = "solid t\n",
      obj,
      ply =
          "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\n"
          "property double y\nproperty double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const auto line = [](const std::array<double, 3>& p) {
    return std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
  };
  for (const auto& p : kTetrahedron.points) {
    obj += "v " + line(p);
    ply += line(p);
  }
  for (const auto& face : kTetrahedron.faces) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const std::size_t i : face) text += "vertex " + line(kTetrahedron.points[i]);
    text += "endloop\nendfacet\n";
    obj += "f", ply += "3";
    for (const std::size_t i : face) {
      obj += " " + std::to_string(i + 1);
      ply += " " + std::to_string(i);
    }
    obj += "\n", ply += "\n";
  }
  text += "endsolid t\n";
  for (const LoadedMesh& loaded : {load("a.stl", text), load("b.OBJ", obj), load("c.ply", ply)}) {
    EXPECT_EQ(loaded.mesh.triangles.size(), 4U);
    EXPECT_TRUE(loaded.report.is_watertight());
    EXPECT_THAT(loaded.report.upper, ElementsAre(1, 1, 1));
  }
  const LoadedMesh binary = load("d.stl", stl_of_tetrahedron());
  EXPECT_TRUE(binary.report.is_watertight());
  EXPECT_EQ(binary.report.upper[0], static_cast<double>(0.1F));
}

TEST_F(MeshFiles, AreKnownByTheDigestOfTheirBytes) {
  EXPECT_EQ(load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").sha256,
            "697b00ab13410c52a542d2e9c63711fcc04e9cbf6c0d3439a9b43cc812e6e713");
  EXPECT_NE(load("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\n").sha256,
            load("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").sha256);
}

TEST_F(MeshFiles, WithLargeFacesAreSplitAroundTheFirstCorner) {
  const LoadedMesh loaded = load("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4 1\n");
  EXPECT_EQ(loaded.report.split_faces, 1U);
  ASSERT_EQ(loaded.mesh.triangles.size(), 2U);
  EXPECT_THAT(loaded.mesh.vertices[loaded.mesh.triangles[1][0]], ElementsAre(1, 0, 0));
}

TEST_F(MeshFiles, ThatAreNoMeshesAreRejected) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT([&] { (void)load_mesh(folder_ / "none.stl"); },
              ThrowsMessage<InputError>(HasSubstr("which could not be read: No such file")));
  expect_rejected("empty.stl", "", "which is no whole stl file");
  expect_rejected("empty.obj", "", "expected a mesh");
  expect_rejected("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "which is no whole obj file");
  expect_rejected("cut.stl", testing::binary_stl(3, std::vector<float>(18, 1.0F)), "which is no whole stl file");
  expect_rejected("lie.stl", testing::binary_stl(4'000'000'000U, std::vector<float>(9, 1.0F)),
                  "which is no whole stl file");
  expect_rejected("nan.stl", testing::binary_stl(1, std::vector<float>(9, kNan)), "is no number");
  expect_rejected("negative.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n",
                  "in which line 4 has the corner -9 of 3 points");
  expect_rejected("inf.stl", testing::binary_stl(1, std::vector<float>(9, 1 / 0.0F)), "is no number");
  expect_rejected("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "in which line 2 is no point");
  expect_rejected("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "in which line 4 has the corner 4 of 3 points");
  expect_rejected("later.obj", "f 1 2 4\nv 0 0 0\nv inf 0 0\nv 0 1 0\n", "in which line 3 is no point");
  ASSERT_EQ(::mkfifo((folder_ / "pipe.stl").c_str(), 0600), 0);  // NOLINT: read and write by its owner
  EXPECT_THAT([&] { (void)load_mesh(folder_ / "pipe.stl"); }, ThrowsMessage<InputError>(HasSubstr("no regular file")));
  EXPECT_THAT([&] { (void)load_mesh(folder_); }, ThrowsMessage<InputError>(HasSubstr("no regular file")));
  expect_rejected("far.obj", "v 0 0 0\nv 2e9 0 0\nv 0 1 0\nf 1 2 3\n", "point 2 is farther away than 1e+09");
  expect_rejected("point.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", "no triangle has three different corners");
  expect_rejected("huge.stl", std::string(kMostMeshBytes + 1, 'x'), "expected a mesh of at most 64 MB");
}

TEST_F(MeshFiles, OfWhichCgalWouldLoseAPartAreRejected) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  EXPECT_EQ(load("tabs.obj", points + "f 1 2\t4 3\n").mesh.triangles.size(), 2U);
  EXPECT_EQ(load("plain.obj", points + "f 1/1/1 2//2 -1 3 # four\r\n").mesh.triangles.size(), 2U);
  EXPECT_EQ(load("feeds.obj", points + "f 1\v2\f4 3\n").report.split_faces, 1U);
  expect_rejected("zero.obj", "v 0 0 0\nv 1 0 0\nf 1 2 0\nv 0 1 0\n", "in which line 3 is no face");
  expect_rejected("large.obj", points + "f 1 2 3 99999999999\n", "in which line 5 is no face");
  expect_rejected("long.obj", points + "f 1 2/" + std::string(300, '3') + " 3\n", "in which line 5 is no face");
  expect_rejected("word.obj", points + "f 1 2 3 x 4\n", "in which line 5 is no face");
  expect_rejected("joined.obj", points + "f 1 2 3-4 1\n", "in which line 5 is no face");
  expect_rejected("curved.obj", points + "f 1 2 3\nsurf 0 1 0 1 1 2 3 4\n", "a curved surface in line 6");
  // One corner of the second triangle is no number.
  std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0};
  EXPECT_EQ(load("good.stl", testing::binary_stl(2, corners)).mesh.triangles.size(), 2U);
  corners[10] = std::numeric_limits<float>::quiet_NaN();
  expect_rejected("nan.stl", testing::binary_stl(2, corners), "a coordinate of triangle 2 is no number");
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  std::string other = facet;
  other.replace(other.find("facet"), 5, "Facet");
  EXPECT_EQ(load("a.stl", "solid s\n" + facet + "endsolid s\n").mesh.triangles.size(), 1U);
  expect_rejected("b.stl", "solid s\n" + facet + other + "endsolid s\n", "which is no whole stl file");
  // CGAL would first take this for a binary file, and keep a point that it has read of it.
  const LoadedMesh tab = load("tab.stl", "solid\tt facet vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endfacet endsolid\t" +
                                             std::string(20, 't') + "\n");
  EXPECT_THAT(tab.mesh.vertices, ElementsAre(ElementsAre(0, 0, 0), ElementsAre(1, 0, 0), ElementsAre(0, 1, 0)));
  // And this one for text.
  std::string solid = stl_of_tetrahedron();
  solid.replace(0, 60, "solid facet vertex 5 5 5 vertex 6 5 5 vertex 5 6 5 endfacet ");
  EXPECT_THAT(load("solid.stl", solid).report.upper, ElementsAre(0.1F, 0.1F, 0.1F));
}

TEST_F(MeshFiles, WithEndsOfLinesOfAnyKindAreReadAlike) {
  const std::string lines = "v 0 0 0\nv 1 0 0\nv 0 1 0\n# f 1 2 3\nv 1 1 0\nf 1 2 3\ng a\nf 4 3 2\n";
  for (const char* end : {"\r", "\r\n", "\r\n\r"}) {
    std::string text;
    for (const char c : lines) text += c == '\n' ? std::string(end) : std::string(1, c);
    EXPECT_EQ(load("ends.obj", text).mesh.triangles.size(), 2U);
  }
  // Behind the single end of a line, CGAL would see neither the point nor the face.
  EXPECT_EQ(load("mixed.obj", "v 0 0 0\nv 1 0 0\n# a\rv 0 1 0\rv 1 1 0\nf 1 2 3\ng a\rf 4 3 2\n").mesh.triangles.size(),
            2U);
}

TEST_F(MeshFiles, WithMoreBehindANumberAreRejected) {
  const auto stl = [](const std::string& z) {
    return "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 " + z +
           "\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
  };
  const auto obj = [](const std::string& z) { return "v 0 0 " + z + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"; };
  for (const char* z : {"+1.5e0", "1.5", "1.50", "15.E-1"}) {
    EXPECT_THAT(load("z.stl", stl(z)).report.upper, ElementsAre(1, 1, 1.5)) << z;
    EXPECT_THAT(load("z.obj", obj(z)).report.upper, ElementsAre(1, 1, 1.5)) << z;
  }
  EXPECT_THAT(load("small.stl", stl("1e-400")).report.upper, ElementsAre(1, 1, 0));
  for (const char* z : {"1,5", "1mm", "1.5f", "0x1", "1-2", "1:"}) {
    expect_rejected("z.stl", stl(z), std::string("'") + z + "' is no number");
    expect_rejected("z.obj", obj(z), "in which line 1 is no point");
  }
  expect_rejected("large.stl", stl("1e999"), "which is no whole stl file");
  for (const std::string z : {"1 2", "1 0.5", "1 1 1", "1 1.01", "1 1 0 0 0"}) {
    expect_rejected("weight.obj", obj(z), "in which line 1 is no point");
  }
  for (const std::string z : {"1 1", "1 1.0", "1 0.5 0.5 0.5"}) EXPECT_EQ(load("z.obj", obj(z)).mesh.vertices[0][2], 1);
}

TEST_F(MeshFiles, OfPlyAreRead) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(load("a.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").mesh.triangles.size(), 1U);
  expect_rejected("corner.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "expected a mesh");
}

TEST(MeshLimits, AreOnTriangles) {
  PolygonSoup soup = kTetrahedron;
  soup.faces.assign(kMostMeshTriangles + 1, {0, 1, 2});
  EXPECT_THAT([&] { (void)repaired(soup); },
              ThrowsMessage<InputError>(HasSubstr("a mesh of 1000001 triangles, expected at most 1000000")));
  soup.faces.pop_back();
  EXPECT_EQ(repaired(soup).mesh.triangles.size(), 1U);
}

}  // namespace
}  // namespace taut
