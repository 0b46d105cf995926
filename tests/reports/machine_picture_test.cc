// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/machine_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "reports/page/robot_drawing.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

constexpr std::array<Nearness, kCables> kAllCalm{};

std::string picture(const nlohmann::json& certificate, double position,
                    const std::array<Nearness, kCables>& nearness = kAllCalm) {
  return machine_picture(sample::scene(certificate), position, nearness, "Worst place", {}).str();
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t result = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++result;
  return result;
}

/// Centres and half sizes of all words and numbered discs.
std::vector<LabelBox> labels(const std::string& svg) {
  std::vector<LabelBox> result;
  const std::regex disc(R"re(<circle class="disc [a-z]+" cx="([-0-9.]+)" cy="([-0-9.]+)" r="([0-9.]+)")re");
  for (std::sregex_iterator m(svg.begin(), svg.end(), disc), end; m != end; ++m) {
    const double r = std::stod((*m)[3]);
    result.push_back({{std::stod((*m)[1]), std::stod((*m)[2])}, {r, r}});
  }
  const std::regex words(R"re(<text class="(name|load-words|end)" x="([-0-9.]+)" y="([-0-9.]+)">([^<]+)<)re");
  for (std::sregex_iterator m(svg.begin(), svg.end(), words), end; m != end; ++m) {
    const Point2 half = half_size((*m)[4], 15);
    result.push_back({{std::stod((*m)[2]), std::stod((*m)[3]) - 5.4}, half});
  }
  return result;
}

TEST(MachinePicture, DrawsBodiesAndTheNearestPair) {
  const std::string svg = picture(sample::with_bodies(sample::proved()), 0.3);
  EXPECT_EQ(count(svg, "<path class=\"body half-space\""), 1);
  EXPECT_EQ(count(svg, "<path class=\"body\""), 1) << "the post";
  EXPECT_EQ(count(svg, "<path class=\"body carried\""), 1) << "the plate";
  for (const char* name : {">floor<", ">post<", ">plate<"}) EXPECT_EQ(count(svg, name), 1) << name;
  EXPECT_EQ(count(svg, "<circle class=\"apart-end\""), 2);
  EXPECT_EQ(count(picture(sample::proved(), 0.3), "class=\"body"), 0);
  const std::string note = bodies_note(sample::scene(sample::with_bodies(sample::proved()))).str();
  EXPECT_NE(note.find("checked"), std::string::npos);
  EXPECT_NE(note.find("post"), std::string::npos);
}

TEST(MachinePicture, OfAFarObstacleDrawsWhatIsNear) {
  nlohmann::json certificate = sample::with_bodies(sample::proved());
  const MachineView near(sample::scene(certificate));
  certificate["problem"]["bodies"]["obstacles"][1]["hull"]["points_m"] = {{"0", "0", "0"}, {"0", "5000", "0"}};
  const MachineView far(sample::scene(certificate));
  const auto size = [](const MachineView& view) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : view.swept) box.extend(p);
    return box.sizes().maxCoeff();
  };
  EXPECT_LT(size(far), 2 * size(near));
}

TEST(MachinePicture, NamesEverythingAndNoLabelHidesAnother) {
  for (const double position : {0.0, 0.3, 0.9, 1.4, 2.0}) {
    const std::string svg = picture(sample::proved(), position);
    const std::vector<LabelBox> all = labels(svg);
    EXPECT_EQ(all.size(), 6 + 3 + 1 + 2) << "discs, anchors, load, start and goal";
    for (const char* text : {">A1 A2<", ">A3 A4<", ">A5 A6<", ">1 N (102 g)<", ">S<", ">G<", ">x<", ">y<", ">z<",
                             ">100 mm (grid)<", "<figcaption>Worst place</figcaption>"}) {
      EXPECT_EQ(count(svg, text), 1) << text;
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Point2 apart = (all[i].centre - all[j].centre).cwiseAbs() - all[i].half - all[j].half;
        EXPECT_GE(apart.maxCoeff(), -0.2) << i << " and " << j << " at " << position;
      }
    }
  }
}

TEST(MachinePicture, ColoursACableByHowNearItIs) {
  std::array<Nearness, kCables> nearness = kAllCalm;
  nearness[1] = Nearness::kNear;
  nearness[4] = Nearness::kOut;
  const std::string svg = picture(sample::proved(), 0.5, nearness);
  EXPECT_EQ(count(svg, "class=\"disc near\""), 1);
  EXPECT_EQ(count(svg, "class=\"number near\""), 1);
  EXPECT_EQ(count(svg, "class=\"disc out\""), 1);
  EXPECT_EQ(count(svg, "class=\"disc calm\""), 4);
  EXPECT_NE(svg.find("class=\"cable out\""), std::string::npos);
  EXPECT_EQ(svg.find("class=\"cable close\""), std::string::npos);
}

TEST(MachinePicture, OfAPoseIsByAllLoadsAndByLengths) {
  const ReportContext scene = sample::scene(sample::proved());
  const Model<double>& model = scene.sampler.model();
  Statics<double> statics;
  statics.regular = true;
  statics.length.fill(0.3);
  statics.tension.fill(0.2);
  statics.tension_below.fill(0.01);
  statics.tension_above.fill(0.01);
  EXPECT_EQ(nearness_at(model, statics), kAllCalm);
  statics.tension_below[0] = 0.1501;  // to below the limit, 0.05 N
  statics.tension_above[1] = 0.181;   // 0.381 N of 0.5 N
  statics.length[2] = 0.545;          // 5 mm of 450 mm are left
  const std::array<Nearness, kCables> near = nearness_at(model, statics);
  EXPECT_EQ(near[0], Nearness::kOut);
  EXPECT_EQ(near[1], Nearness::kNear);
  EXPECT_EQ(near[2], Nearness::kClose);
  EXPECT_EQ(near[3], Nearness::kCalm);
  statics.regular = false;
  for (const Nearness each : nearness_at(model, statics)) EXPECT_EQ(each, Nearness::kOut);
}

TEST(MachinePicture, OfAPlanThatWasNotFoundHasNoPath) {
  nlohmann::json certificate = sample::undecided();
  certificate["problem"]["space"]["flip"] = nullptr;
  certificate["problem"]["space"]["pose"]["px"] = "0.1*theta";
  EXPECT_EQ(count(picture(certificate, 0), "class=\"track\""), 1);
  certificate["undecided"] = {{"reason", "no path was found"}, {"segment", nullptr}, {"box", nullptr}};
  EXPECT_EQ(count(picture(certificate, 0), "class=\"track\""), 0);
  EXPECT_EQ(picture(sample::no_path(), 0), "");
}

TEST(MachinePicture, DrawsTheTubeWhereItCanBeSeen) {
  nlohmann::json certificate = sample::proved();
  certificate["problem"]["tolerances"] = {{"base_anchor_m", {"0", "0", "0", "0", "0", "0"}},
                                          {"platform_anchor_m", {"0", "0", "0", "0", "0", "0"}},
                                          {"load_point_m", "0"},
                                          {"wrench", {"0", "0", "0", "0", "0", "0"}},
                                          {"position_m", "0.02"},
                                          {"orientation_rad", "0"},
                                          {"cable_length_m", nullptr}};
  EXPECT_EQ(count(picture(certificate, 0), "class=\"tube\""), 1);
  certificate["problem"]["tolerances"]["position_m"] = "0.0001";
  EXPECT_EQ(count(picture(certificate, 0), "class=\"tube\""), 0);
}

TEST(MachinePicture, OfHostileNumbersIsShortAndFinite) {
  EXPECT_EQ(coordinate(1e300), "100000");
  EXPECT_EQ(coordinate(-std::numeric_limits<double>::infinity()), "100000");
  EXPECT_EQ(coordinate(-0.01), "0");
  for (const char* x : {"9e299", "1e20", "1e14", "1e6", "-1e9"}) {
    for (const char* key : {"base_anchors_m", "platform_anchors_m"}) {
      nlohmann::json certificate = sample::undecided();
      certificate["problem"]["robot"][key][2][1] = x;
      const std::string svg = picture(certificate, 0.5);
      EXPECT_LT(svg.size(), 60'000) << x;
      EXPECT_EQ(svg.find("nan"), std::string::npos) << x;
      EXPECT_EQ(svg.find("inf"), std::string::npos) << x;
      EXPECT_FALSE(std::regex_search(svg, std::regex(R"re( (d|cx|cy|x|y|viewBox)="[^"]*e)re"))) << x;
    }
  }
  nlohmann::json certificate = sample::undecided();
  certificate["problem"]["robot"]["base_anchors_m"][4] = {"1e20", "0", "0"};
  EXPECT_NE(picture(certificate, 0).find("No picture"), std::string::npos);
}

TEST(MachineView, HasWeightsPullDownAndRightHandedAxes) {
  const MachineView view(sample::scene(sample::proved()));
  EXPECT_EQ(view.up, -Eigen::Vector3d::UnitZ()) << "the load pulls along z";
  EXPECT_LT((view.across.cross(view.inward) - view.up).norm(), 1e-15);
  EXPECT_LT((view.right().cross(view.upward()) - view.towards()).norm(), 1e-15);
  EXPECT_GT(view.towards().dot(view.up), 0) << "from above";
  for (const Eigen::Vector3d& p : view.swept) EXPECT_GT(view.up.dot(p), view.grid.height);
  EXPECT_EQ(view.grid.step, 0.1);
}

TEST(DimensionedViews, HaveTheSizeOfTheBaseAndHowFarThePlatformHangs) {
  const ReportContext scene = sample::scene(sample::proved());
  const std::string svg = dimensioned_views(scene).str();
  EXPECT_EQ(count(svg, ">381.1<"), 2) << "mm, from the front and from above";
  EXPECT_EQ(count(svg, ">330<"), 2) << "from the side and from above";
  double lowest = 0;  // z points down, and the base is at 0
  for (const Eigen::Vector3d& b : platform_at(scene, scene.samples.front().pose)) lowest = std::max(lowest, b.z());
  EXPECT_EQ(count(svg, fmt::format(">{:.4g}<", 1000 * lowest)), 2) << "from the front and from the side";
  EXPECT_NE(svg.find("dimensions in mm"), std::string::npos);
  EXPECT_EQ(dimensioned_views(sample::scene(sample::no_path())).str(), "");
}

TEST(HullFaces, AreThoseOfATetrahedronACubeAndAPlate) {
  const std::vector<Eigen::Vector3d> tetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(hull_faces(tetrahedron).size(), 4);
  std::vector<Eigen::Vector3d> cube;
  for (int k = 0; k < 8; ++k) cube.emplace_back(k & 1, (k >> 1) & 1, k >> 2);
  const std::vector<Face> sides = hull_faces(cube);
  EXPECT_EQ(sides.size(), 6);
  for (const Face& side : sides) {
    EXPECT_EQ(side.corners.size(), 4);
    const Eigen::Vector3d turn = (side.corners[1] - side.corners[0]).cross(side.corners[2] - side.corners[1]);
    EXPECT_GT(turn.dot(side.normal), 0) << "counter-clockwise from outside";
    EXPECT_GT(side.normal.dot(side.corners[0] - Eigen::Vector3d(0.5, 0.5, 0.5)), 0) << "outward";
  }
  EXPECT_EQ(hull_faces({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}).size(), 2);
  EXPECT_TRUE(hull_faces({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).empty());
}

TEST(Hatching, StaysInsideAndIsBounded) {
  const std::vector<Point2> square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const auto lines = hatching(square, 2);
  EXPECT_EQ(lines.size(), 7);
  for (const auto& [a, b] : lines) {
    for (const Point2& p : {a, b}) EXPECT_TRUE(p.minCoeff() >= -1e-9 && p.maxCoeff() <= 10 + 1e-9);
  }
  EXPECT_TRUE(hatching(square, 1e-9).empty());
}

}  // namespace
}  // namespace taut
