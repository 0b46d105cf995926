// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/angles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kinematics/geometry.h"

namespace taut {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// The greatest difference of any element of the two rotation matrices.
double difference(AngleKind kind, const std::array<double, 3>& x, const std::array<double, 3>& y) {
  Angles<double> angles;
  angles.kind = kind;
  const Matrix3<double> a = rotation(angles, x);
  const Matrix3<double> b = rotation(angles, y);
  double greatest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) greatest = std::max(greatest, std::abs(a(i, j) - b(i, j)));
  }
  return greatest;
}

TEST(Angles, StayTheSameOrientationInTheirRanges) {
  for (const AngleKind kind : {AngleKind::kTiltAndTorsion, AngleKind::kRollPitchYaw, AngleKind::kZyz}) {
    for (double a = -9; a < 9; a += 1.3) {
      for (double b = -9; b < 9; b += 0.7) {
        const std::array<double, 3> given{a, b, 0.4 * a + 2};
        const std::array<double, 3> shown = customary_angles(kind, given);
        EXPECT_LT(difference(kind, given, shown), 1e-12) << a << " " << b;
        for (const double x : shown) EXPECT_LE(std::abs(x), kPi + 1e-12);
        if (kind == AngleKind::kRollPitchYaw) {
          EXPECT_LE(std::abs(shown[1]), kPi / 2 + 1e-12);
        } else {
          EXPECT_GE(shown[1], 0);
        }
      }
    }
  }
}

TEST(Angles, OfTheExamplesAreWhatPeopleExpect) {
  const auto degrees = [](AngleKind kind, double a, double b, double c) {
    std::array<double, 3> result = customary_angles(kind, {a * kPi / 180, b * kPi / 180, c * kPi / 180});
    for (double& x : result) x = std::round(x * 180 / kPi * 1e6) / 1e6;
    return result;
  };
  using Three = std::array<double, 3>;
  EXPECT_EQ(degrees(AngleKind::kTiltAndTorsion, -262.597, 97.403, 34), (Three{97.403, 97.403, 34}));
  EXPECT_EQ(degrees(AngleKind::kTiltAndTorsion, 10, -20, 394), (Three{-170, 20, 34}));
  EXPECT_EQ(degrees(AngleKind::kRollPitchYaw, 0, 100, 0), (Three{180, 80, 180}));
  EXPECT_EQ(degrees(AngleKind::kAxis, 270, 0, 0), (Three{-90, 0, 0}));
  EXPECT_EQ(customary_angles(AngleKind::kAxis, {-3, 0, 0}), (Three{-3, 0, 0}));
}

TEST(Angles, OfARotationGiveItBack) {
  for (const AngleKind kind : {AngleKind::kTiltAndTorsion, AngleKind::kRollPitchYaw, AngleKind::kZyz}) {
    Angles<double> model;
    for (double a = -3; a < 3; a += 0.7) {
      for (const double b : {-kPi / 2, -1.0, -1e-12, 0.0, 0.3, kPi / 2, 2.0, kPi}) {
        const std::array<double, 3> given{a, b, 1 - a};
        model.kind = kind;
        const std::array<double, 3> found = angles_of(kind, rotation(model, given));
        EXPECT_LT(difference(kind, given, found), 1e-9) << name(kind) << " " << a << " " << b;
        EXPECT_EQ(found, customary_angles(kind, found));
        model.kind = AngleKind::kTiltAndTorsion;
        const std::array<double, 3> tilted = angles_of(AngleKind::kTiltAndTorsion, rotation(model, given));
        const std::array<double, 3> again = angles_of(kind, model, tilted);
        Angles<double> shown;
        shown.kind = kind;
        EXPECT_LT((rotation(shown, again) - rotation(model, given)).norm(), 1e-8);
      }
    }
  }
}

TEST(Angles, OfAPathHaveNoJumps) {
  for (const AngleKind kind : {AngleKind::kTiltAndTorsion, AngleKind::kRollPitchYaw, AngleKind::kZyz}) {
    std::array<double, 3> last{0.2, 0.1, -0.4};
    for (double t = 0; t < 20; t += 0.05) {  // the middle angle leaves its customary range, others turn on and on
      const std::array<double, 3> given{0.2 + t, 0.1 + 0.2 * t, -0.4 - 2 * t};
      const std::array<double, 3> shown = nearest_angles(kind, customary_angles(kind, given), last);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], given[c], 1e-9) << name(kind) << " " << t;
      last = shown;
    }
  }
}

TEST(Angles, OfALawBetweenPosesAreTheCases) {
  Certificate certificate;
  certificate.illustration = {{"angles", "roll-pitch-yaw"}};
  certificate.path.interpolation = Interpolation::kStraight;
  EXPECT_EQ(shown_angles(certificate).kind, AngleKind::kTiltAndTorsion) << "the space's own";
  certificate.path.interpolation = Interpolation::kGeodesic;
  EXPECT_EQ(shown_angles(certificate).kind, AngleKind::kRollPitchYaw);
  for (const nlohmann::json& other : {nlohmann::json("axis"), nlohmann::json("tilt"), nlohmann::json(3)}) {
    certificate.illustration["angles"] = other;
    EXPECT_EQ(shown_angles(certificate).kind, AngleKind::kTiltAndTorsion);
  }
  certificate.illustration = nullptr;
  EXPECT_EQ(shown_angles(certificate).kind, AngleKind::kTiltAndTorsion);
}

TEST(Angles, ThatAreNoNumbersStay) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(customary_angles(AngleKind::kZyz, {infinite, 9, 0}), (std::array<double, 3>{infinite, 9, 0}));
}

}  // namespace
}  // namespace taut
