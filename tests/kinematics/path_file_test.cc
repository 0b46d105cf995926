// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/path_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "case/case_file.h"
#include "path_io/path_summary.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kDegree = 0x1.1df46a2529d39p-6;

SpaceText slice() { return testing::robot1_slice().space; }    // phi, theta
SpaceText sphere() { return testing::robot2_sphere().space; }  // alpha1, alpha2

struct Read {
  PathHeader header;
  std::vector<PathRow> rows;
  std::vector<double> start;

  [[nodiscard]] std::vector<std::vector<double>> x() const {
    std::vector<std::vector<double>> result;
    for (const PathRow& row : rows) result.push_back(row.x);
    return result;
  }
};

Read read(PathFile& file) {
  Read result;
  result.header = file.header();
  for (PathRow row; file.next(row);) result.rows.push_back(row);
  result.start = file.start();
  return result;
}

Read read(const std::string& text, const SpaceText& space = slice(), const std::string& name = "path.txt") {
  PathFile file(std::make_unique<std::istringstream>(text), name, space);
  return read(file);
}

void expect_rejected(const std::string& text, const std::string& message, const SpaceText& space = slice(),
                     const std::string& name = "path.txt") {
  EXPECT_THAT([&] { (void)read(text, space, name); }, ThrowsMessage<InputError>(HasSubstr(message))) << text;
}

// --- What is read ----------------------------------------------------------------------------------------------------

TEST(PathFile, ReadsTheCasesParametersInAnyOrderAndUnit) {
  const Read path = read("theta[deg], t[ms] ,phi [rad]\n# a comment\n\n90,0,1e-1\r\n  +45 ,2.5, -.5 \n");
  EXPECT_EQ(path.header.form, PathForm::kParameters);
  EXPECT_EQ(path.header.format, PathFormat::kTable);
  EXPECT_EQ(path.header.coordinates[1].unit, "deg");
  EXPECT_EQ(path.x(), (std::vector<std::vector<double>>{{0.1, 0x1.921fb54442d18p+0}, {-0.5, 0x1.921fb54442d18p-1}}));
  EXPECT_EQ(path.rows[0].line, 4u);
  EXPECT_EQ(path.rows[1].time_s->text(), "0.0025");
}

TEST(PathFile, ReadsPosesByAnglesWithTabsSemicolonsQuotesAndAByteOrderMark) {
  for (const char delimiter : {',', ';', '\t'}) {
    std::string text =
        "\xEF\xBB\xBF\"px[mm]\",py[cm],pz[m],phi[deg],theta[rad],sigma[deg]\n\"1\",2,3,0,0.5,-0\n2,2,3,0,0.5,180";
    for (char& c : text) c = c == ',' ? delimiter : c;
    const Read path = read(text);
    EXPECT_EQ(path.header.form, PathForm::kAngles);
    EXPECT_EQ(path.x(),
              (std::vector<std::vector<double>>{{0.001, 0.02, 3, 0, 0.5, 0}, {0.002, 0.02, 3, 0, 0.5, M_PI}}));
    EXPECT_FALSE(std::signbit(path.rows[0].x[5]));
  }
}

TEST(PathFile, ReadsQuaternionsAndTum) {
  const Read table = read("time[s],px[mm],py[mm],pz[mm],qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n1,1,2,3,0.6,0.8,0,0\n");
  EXPECT_EQ(table.header.form, PathForm::kQuaternion);
  EXPECT_THAT(table.rows[1].x, ElementsAre(0.001, 0.002, 0.003, 0.8, 0, 0, 0.6));
  const Read tum =
      read("# time x y z qx qy qz qw\n1305031102.175304 1.5 -2 3e-1  0 0 0 1\n1305031102.175305\t1 2 3 0 0 0 -1\n");
  EXPECT_EQ(tum.header.format, PathFormat::kTum);
  EXPECT_EQ(tum.header.form, PathForm::kQuaternion);
  EXPECT_THAT(tum.rows[0].x, ElementsAre(1.5, -2, 0.3, 0, 0, 0, 1));
  EXPECT_EQ(tum.rows[0].time_s->text(), "1305031102.175304");
}

TEST(PathFile, TellsTimesApartThatAreTheSameBinary64) {
  const Read path = read("1305031102.175304123 1 2 3 0 0 0 1\n1305031102.175304124 1 2 4 0 0 0 1\n");
  EXPECT_LT(*path.rows[0].time_s, *path.rows[1].time_s);
}

TEST(PathFile, ReadsCableLengthsWithTheirStart) {
  const std::string lengths = "l1[mm],l2[mm],d3[mm],l4[mm],l5[mm],l6[mm]";
  const std::string rows = "100,200,300,400,500,600\n101,200,300,400,500,600\n";
  const Read bare = read(lengths + "\n" + rows);
  EXPECT_EQ(bare.header.form, PathForm::kCableLengths);
  EXPECT_FALSE(bare.header.start);
  EXPECT_THAT(bare.rows[1].x, ElementsAre(0.101, 0.2, 0.3, 0.4, 0.5, 0.6));
  const Read angles =
      read("phi[deg],theta[deg]," + lengths + "\n90,180,100,200,300,400,500,600\n,,101,200,300,400,500,600\n");
  EXPECT_EQ(angles.header.start, PathForm::kParameters);
  EXPECT_THAT(angles.start, ElementsAre(M_PI_2, M_PI));
  const Read quaternion =
      read("px[m],py[m],pz[m],qx,qy,qz,qw," + lengths + "\n1,2,3,0,0,0,1,100,200,300,400,500,600\n");
  EXPECT_EQ(quaternion.header.start, PathForm::kQuaternion);
  EXPECT_THAT(quaternion.start, ElementsAre(1, 2, 3, 0, 0, 0, 1));
}

TEST(PathFile, ReadsTautsOwnPaths) {
  const Read path = read(
      "waypoint,x.phi,x.theta,half_turns.phi,half_turns.theta,px[m],py[m],pz[m],phi[rad],theta[rad],sigma[rad]\n"
      "0,-2.3,1.6,0,0,0,0,0.35,-2.3,1.6,0.5\n1,-2.3,1.6,-3,0,0,0,0.35,-2.3,1.6,0.5\n");
  EXPECT_EQ(path.header.format, PathFormat::kTautWaypoints);
  EXPECT_THAT(path.rows[1].half_turns, ElementsAre(-3, 0));
  EXPECT_EQ(read("control_point,half_turns.phi,x.phi,x.theta,half_turns.theta\n0,0,1,2,0\n1,0,1,2,0\n").header.format,
            PathFormat::kTautControlPoints);
}

TEST(PathFile, ReadsTautsOwnPathsOfPoses) {
  const std::string header =
      "waypoint,x.px,x.py,x.pz,x.phi,x.theta,x.sigma,half_turns.px,half_turns.py,half_turns.pz,half_turns.phi,"
      "half_turns.theta,half_turns.sigma,t[s]\n";
  const Read path = read(header + "0,0,0,0.35,1,2,3,0,0,0,-1,0,2,0.5\n");
  EXPECT_EQ(path.header.form, PathForm::kAngles);
  EXPECT_THAT(path.rows[0].half_turns, ElementsAre(0, 0, 0, -1, 0, 2));
  EXPECT_EQ(path.rows[0].time_s->text(), "0.5");
  expect_rejected(header + "0,0,0,0.35,1,2,3,0,0,0,-1,1,2,0.5\n", "half_turns.theta: got '1', expected 0");
}

TEST(PathFile, TheCasesOwnNamesGoFirst) {
  SpaceText space = sphere();
  space.parameters[0].name = "t";
  space.parameters[1].name = "d1";
  const Read path = read("t[deg],d1,time[s]\n90,2,0\n", space);
  EXPECT_THAT(path.rows[0].x, ElementsAre(M_PI_2, 2));
  EXPECT_EQ(path.rows[0].time_s->text(), "0");
}

TEST(PathFile, KeepsRowsThatRepeatTheOneBefore) {
  const Read path = read("phi[rad],theta[rad],t[s]\n1,2,0\n1,2,1\n1,2,2\n1,3,3\n");
  ASSERT_EQ(path.rows.size(), 4u);
  EXPECT_EQ(path.rows[2].x, path.rows[0].x);
  EXPECT_EQ(path.rows[2].line, 4u);
  EXPECT_EQ(path.rows[2].time_s->text(), "2");
}

// --- What is not -----------------------------------------------------------------------------------------------------

TEST(PathFile, NamesLineColumnAndWhatWasSeen) {
  const std::string header = "phi[rad],theta[deg]\n";
  expect_rejected(header + "1,2\n\n#\n3,x\n",
                  "path.txt:5: theta: got 'x', expected a decimal number such as 0.05 or 1e-4");
  for (const char* cell : {"nan", "NaN", "inf", "-Infinity", "", "1e", "1e400", "1e-400", "0x10", "1 2", "--1", ".",
                           "1_000", "1e999999999999"}) {
    expect_rejected(header + "1," + cell + "\n", fmt::format("path.txt:2: theta: got '{}', expected", cell));
  }
  expect_rejected("phi[rad];theta[deg]\n1,5;2\n",
                  "path.txt:2: phi: got '1,5', expected a decimal number such as 0.05 or 1e-4, with a decimal point");
  expect_rejected(header + "1,2,3\n", "path.txt:2: got 3 cells, expected 2, one for each column");
  expect_rejected(header + "1\n", "path.txt:2: got 1 cells, expected 2");
  expect_rejected(header + "1," + std::string(100'000, '1') + "\n", "path.txt:2: got a line of more than 65536 bytes");
  expect_rejected(header + "1," + std::string(2'000, '1') + "\n", "path.txt:2: theta: got '1111");
  expect_rejected(header + std::string("1,2\n\0\n", 6), "path.txt:3: got the byte 0x00, expected text");
  // NOLINTNEXTLINE(bugprone-string-literal-with-embedded-nul)
  expect_rejected("\xFF\xFEp\0x\0", "path.txt:1: got the byte 0xFF, expected text in UTF-8");
  expect_rejected(header + "1,\x80\n", "got '\\x80', expected");
  expect_rejected("", "path.txt: got no rows");
  expect_rejected("# nothing\n\n", "path.txt: got no rows");
  expect_rejected(header, "path.txt: got a header and no rows");
}

TEST(PathFile, HeadersSayWhatIsMeant) {
  expect_rejected("phi,theta[deg]\n1,2\n",
                  "path.txt:1: phi: got no unit, expected a unit in brackets, one of rad, deg");
  expect_rejected("phi[mm],theta[deg]\n1,2\n", "phi: got the unit 'mm', expected a unit in brackets, one of rad, deg");
  expect_rejected("phi[Deg],theta[deg]\n1,2\n", "phi: got the unit 'Deg'");
  expect_rejected("phi[deg,theta[deg]\n1,2\n", "got the column 'phi[deg', expected NAME[UNIT]");
  expect_rejected("phi[],theta[deg]\n1,2\n", "got the column 'phi[]', expected NAME[UNIT]");
  expect_rejected("phi[deg],theta[deg],\n1,2,3\n", "got the column '', expected a name");
  expect_rejected("phi[deg],phi[rad],theta[deg]\n1,2,3\n", "got the column 'phi' twice");
  expect_rejected("phi[deg],theta[deg],t[s],time[s]\n1,2,3,4\n",
                  "got the column 't' twice, expected each once (t and time are one)");
  expect_rejected("phi[deg],theta[deg],t\n1,2,3\n", "t: got no unit, expected a unit in brackets, one of s, ms");
  expect_rejected("phi[deg],theta[deg],t[kg]\n1,2,3\n",
                  "t: got the unit 'kg', expected a unit in brackets, one of s, ms");
  expect_rejected("phi[deg],thet[deg]\n1,2\n",
                  "got the unknown column 'thet', expected phi, theta (the case's parameters), or px, py");
  expect_rejected("phi[deg]\n1\n", "got the columns phi and no theta, expected");
  expect_rejected("px[m],py[m],pz[m],qx,qy,qz\n0,0,0,0,0,0\n", "and no qw, expected");
  expect_rejected("px[m],py[m],pz[m],qx,qy,qz,qw[rad]\n0,0,0,0,0,0\n", "qw: got the unit 'rad', expected no unit");
  expect_rejected("t[s]\n0\n", "got no coordinates, expected");
  expect_rejected("l1[m],l2[m],l3[m],l4[m],l5[m]\n1,2,3,4,5\n",
                  "got the cable lengths l1, l2, l3, l4, l5, expected all of l1, l2");
  expect_rejected("l1[m],l2[m],l3[m],l4[m],l5[m],l6\n1,2,3,4,5,6\n",
                  "l6: got no unit, expected a unit in brackets, one of m, mm");
  expect_rejected("l1[m],l2[m],l3[m],l4[m],l5[m],l6[m],px[m]\n1,2,3,4,5,6,7\n", "got the columns px and no py, pz");
  expect_rejected("1,2\n3,4\n", "got '1,2', expected a header such as px[mm]");
  expect_rejected("1 2 3\n", "path.txt:1: got '1 2 3', expected a header such as px[mm],py[mm]");
  expect_rejected("{\"format\": 1}\n", "got '{', expected a table; a certificate's name ends in .json");
  expect_rejected("alpha1,alpha2\n1,2\n", "alpha1: got no unit", sphere());
  EXPECT_THAT(read("alpha1[rad],alpha2\n1,2\n", sphere()).rows[0].x, ElementsAre(1, 2));
}

TEST(PathFile, NamesSayTheFormat) {
  expect_rejected("0 0 0 0 0 0 0 1\n", "expected a header", slice(), "path.csv");
  expect_rejected("phi[rad],theta[rad]\n1,2\n", "eight numbers of TUM", slice(), "path.tum");
  EXPECT_TRUE(is_certificate_name("a/certificate.json"));
  EXPECT_FALSE(is_certificate_name("a/json"));
}

TEST(PathFile, AnglesAreThoseOfTheCase) {
  SpaceText space = coordinate_space({AngleKind::kRollPitchYaw});
  space.parameters = {{"u", ParameterKind::kReal, "", ""}};
  const Read path = read("px[m],py[m],pz[m],roll[deg],pitch[rad],yaw[rad]\n0,0,1,180,2,3\n0,0,1,90,2,3\n", space);
  EXPECT_EQ(path.header.form, PathForm::kAngles);
  EXPECT_EQ(path.rows[0].x[3], 0x1.921fb54442d18p+1);
  const std::string own =
      "waypoint,x.px,x.py,x.pz,x.roll,x.pitch,x.yaw,half_turns.px,half_turns.py,half_turns.pz,"
      "half_turns.roll,half_turns.pitch,half_turns.yaw\n";
  EXPECT_EQ(read(own + "0,0,0,1,1,2,3,0,0,0,2,2,-2\n", space).rows[0].half_turns[4], 2);
  expect_rejected("px[m],py[m],pz[m],phi[rad],theta[rad],sigma[rad]\n0,0,1,1,2,3\n",
                  "got the unknown column 'phi', which is understood with 'angles: tilt-and-torsion' under 'space'",
                  space);
  expect_rejected("px[m],py[m],pz[m],roll[rad],pitch[rad],yaw[rad]\n0,0,1,1,2,3\n",
                  "got the unknown column 'roll', which is understood with 'angles: roll-pitch-yaw' under 'space'");
  SpaceText axis = coordinate_space({AngleKind::kAxis});
  EXPECT_EQ(read("turn[deg],px[m],py[m],pz[m]\n180,0,0,1\n", axis).x(),
            (std::vector<std::vector<double>>{{0, 0, 1, 0x1.921fb54442d18p+1}}));
}

TEST(PathFile, QuaternionsHaveUnitLength) {
  const std::string header = "px[m],py[m],pz[m],qx,qy,qz,qw\n";
  EXPECT_EQ(read(header + "0,0,0,0,0.0009,0,1\n0,0,0,0,0,0,0.9991\n").rows.size(), 2u);
  expect_rejected(header + "0,0,0,0,0,0,1.002\n",
                  "path.txt:2: got the quaternion (0, 0, 0, 1.002) of length 1.002, expected length 1 within 0.001");
  expect_rejected("0 0 0 0 0 0 0 0\n", "of length 0");
  EXPECT_EQ(read(header + "0,0,0,0,0,0.6,0.8\n0,0,0,0,-0,-.6,-0.8\n").rows[1].x[6], -0.8) << "as it stands";
}

TEST(PathFile, TimesIncrease) {
  const std::string header = "phi[rad],theta[rad],t[ms]\n";
  expect_rejected(header + "1,2,5\n1,3,5.0\n",
                  "path.txt:3: t: got 0.005 s behind the 0.005 s of line 2, expected a later time");
  expect_rejected(header + "1,2,5\n1,3,4\n", "expected a later time");
  expect_rejected(header + "1,2,5\n1,3,\n", "t: got '', expected a decimal");
}

TEST(PathFile, OwnPathsMustFitTheCase) {
  const std::string header = "waypoint,x.phi,x.theta,half_turns.phi,half_turns.theta\n";
  EXPECT_EQ(read(header + "0,1,2,0,0\n1,1,2,0,0\n").rows.size(), 2u) << "may repeat";
  expect_rejected(header + "0,1,2,0,0\n2,1,2,0,0\n",
                  "path.txt:3: waypoint: got '2', expected 1: they are numbered from 0");
  expect_rejected(header + "0,1,2,0,1\n", "half_turns.theta: got '1', expected 0, as the parameter is not periodic");
  expect_rejected(header + "0,1,2,0.5,0\n", "half_turns.phi: got '0.5', expected a whole number");
  expect_rejected(header + "0,1,2,1000001,0\n", "expected a whole number of at most 1000000");
  expect_rejected(header + "0,1,2,0,0\n",
                  "got no column 'x.alpha1', expected the parameters of the case: alpha1, alpha2", sphere());
  expect_rejected("waypoint,x.phi,x.theta,half_turns.phi\n0,1,2,0\n", "got no column 'half_turns.theta'");
  expect_rejected("waypoint,x.phi,x.theta,half_turns.phi,half_turns.theta,x.s\n", "got the unknown column 'x.s'");
}

TEST(PathFile, AFittedMoveHasRollPitchAndYawInAnyCase) {
  const std::string own =
      "control_point,x.px,x.py,x.pz,x.roll,x.pitch,x.yaw,half_turns.px,half_turns.py,half_turns.pz,"
      "half_turns.roll,half_turns.pitch,half_turns.yaw,px[m],py[m],pz[m],roll[rad],pitch[rad],yaw[rad]\n";
  for (const SpaceText& space : {slice(), coordinate_space(), sphere()}) {
    const Read path = read(own + "0,1,2,3,4,5,6,0,0,0,2,2,-2,1,2,3,4,5,6\n", space);
    EXPECT_EQ(path.header.form, PathForm::kAngles);
    EXPECT_EQ(path.header.angles.kind, AngleKind::kRollPitchYaw);
    EXPECT_THAT(path.rows[0].x, ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_THAT(path.rows[0].half_turns, ElementsAre(0, 0, 0, 2, 2, -2));
  }
  EXPECT_EQ(read("phi[rad],theta[rad]\n1,2\n").header.angles.kind, AngleKind::kTiltAndTorsion);
}

TEST(PathFile, ATableOfWinchRatesIsNoPath) {
  expect_rejected(
      "t[s],l1[m],l2[m],l3[m],l4[m],l5[m],l6[m],v1[m/s],a1[m/s^2],fmin1[N],fmax6[N]\n0,1,1,1,1,1,1,0,0,9,9\n",
      "got the column 'v1', a rate of a winch, expected a path: of a winches.csv of taut its columns t and l1 "
      "to l6 alone, or the poses.csv beside it");
  expect_rejected("phi[rad],theta[rad],v7\n", "got the unknown column 'v7'");
}

TEST(PathFile, FilesThatAreNone) {
  EXPECT_THAT([] { PathFile("/tmp", slice()); }, ThrowsMessage<InputError>(HasSubstr("/tmp: got a directory")));
  EXPECT_THAT([] { PathFile("/nowhere/x.csv", slice()); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("/nowhere/x.csv"), HasSubstr("No such file"))));
}

// --- Laws ------------------------------------------------------------------------------------------------------------

class Random {
 public:
  explicit Random(std::uint64_t seed) : random_(seed) {}
  double number() { return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random_), pick(40) - 30); }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  std::vector<double> numbers(std::size_t n) {
    std::vector<double> result(n);
    for (double& x : result) x = number();
    return result;
  }
  std::vector<double> quaternion_pose() {
    std::vector<double> x = numbers(7);
    const double norm = std::sqrt(x[3] * x[3] + x[4] * x[4] + x[5] * x[5] + x[6] * x[6]);
    for (std::size_t j = 3; j < 7; ++j) x[j] /= norm;
    return x;
  }

 private:
  std::mt19937_64 random_;
};

std::string row_text(const std::vector<double>& x, char delimiter) {
  std::string text;
  for (const double value : x) text += fmt::format("{}{}", text.empty() ? "" : std::string(1, delimiter), value);
  return text;
}

TEST(PathFile, WhatWasWrittenInSiIsReadBitForBit) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<std::vector<double>> angles, quaternions, parameters, lengths;
    std::string angle_text = "px[m],py[m],pz[m],phi[rad],theta[rad],sigma[rad]\n", tum_text,
                quaternion_text = "px[m];py[m];pz[m];qx;qy;qz;qw\n";
    std::string parameter_text = "waypoint,x.phi,x.theta,half_turns.phi,half_turns.theta\n";
    std::string length_text = "l1[m]\tl2[m]\tl3[m]\tl4[m]\tl5[m]\tl6[m]\n";
    const int rows = 1 + random.pick(30);
    for (int k = 0; k < rows; ++k) {
      angle_text += row_text(angles.emplace_back(random.numbers(6)), ',') + "\n";
      quaternion_text += row_text(quaternions.emplace_back(random.quaternion_pose()), ';') + "\r\n";
      tum_text += fmt::format("{} {}\n", k, row_text(quaternions.back(), ' '));
      parameter_text +=
          fmt::format("{},{},{},0\n", k, row_text(parameters.emplace_back(random.numbers(2)), ','), k % 3);
      lengths.push_back(random.numbers(6));
      for (double& length : lengths.back()) length = std::abs(length);  // above 0, as lengths have to be
      length_text += row_text(lengths.back(), '\t') + "\n";
    }
    EXPECT_EQ(read(angle_text).x(), angles);
    EXPECT_EQ(read(quaternion_text).x(), quaternions);
    EXPECT_EQ(read(tum_text).x(), quaternions);
    EXPECT_EQ(read(parameter_text).x(), parameters);
    EXPECT_EQ(read(length_text).x(), lengths);
  }
}

TEST(PathFile, AnyFileIsAPathOrAnInputError) {
  const std::vector<std::string> seeds = {
      "phi[rad],theta[deg],t[s]\n1,2,0\n1,3,1\n", "# c\n0 1 2 3 0 0 0 1\n1 1 2 4 0 0 0 1\n",
      "waypoint,x.phi,x.theta,half_turns.phi,half_turns.theta\n0,-2.3,1.6,0,0\n1,1,1,2,0\n",
      "l1[mm],l2[mm],l3[mm],l4[mm],l5[mm],l6[mm],phi[deg],theta[deg]\n1,2,3,4,5,6,7,8\n1,2,3,4,5,7,,\n",
      "px[m];py[in];pz[m];qx;qy;qz;qw\n0;0;0;0;0;0;1\n"};
  const std::string pieces[] = {",",     ";", "\t", "\n",    "\"",           "[",   "]", "e", "-", "nan",
                                "1e999", "#", "\r", "t[s],", "\xEF\xBB\xBF", "time"};
  const SpaceText space = slice();
  Random random(11);
  int accepted = 0;
  int rejected = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    std::string text = seeds[static_cast<std::size_t>(random.pick(static_cast<int>(seeds.size())))];
    for (int mutations = 1 + random.pick(3); mutations > 0 && !text.empty(); --mutations) {
      const auto at = static_cast<std::size_t>(random.pick(static_cast<int>(text.size())));
      switch (random.pick(6)) {
        case 0: text[at] = static_cast<char>(random.pick(256)); break;
        case 1: text.erase(at, static_cast<std::size_t>(random.pick(5)) + 1); break;
        case 2: text.insert(at, pieces[random.pick(16)]); break;
        case 3: text[at] = static_cast<char>('0' + random.pick(10)); break;
        case 4:
          text.insert(text.find('\n', at) == std::string::npos ? 0 : text.find('\n', at), 1, "0 \n"[random.pick(3)]);
          break;
        default: text.insert(at, text.substr(at / 2, static_cast<std::size_t>(random.pick(20)))); break;
      }
    }
    try {
      for (const PathRow& row : read(text, space).rows) {
        for (const double value : row.x) ASSERT_TRUE(std::isfinite(value)) << text;
      }
      ++accepted;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_THAT(message, ::testing::StartsWith("path.txt:"));
      for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), ' ') << text;
      ++rejected;
    }
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(rejected, 1000);
}

TEST(PathFile, ReadsFilesRowByRow) {
  const std::string path = (std::filesystem::temp_directory_path() / "taut_path_file_test.csv").string();
  {
    std::ofstream out(path);
    out << "phi[rad],theta[rad]\n";
    for (int k = 0; k < 100'000; ++k) out << k << ",0.5\n";
  }
  PathFile file(path, slice());
  EXPECT_LE(file.bytes_read(), 30u);
  PathRow row;
  std::size_t rows = 0;
  while (file.next(row)) EXPECT_EQ(row.x[0], static_cast<double>(rows++));
  EXPECT_EQ(rows, 100'000u);
  EXPECT_EQ(file.bytes_read(), std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

// --- Summary ---------------------------------------------------------------------------------------------------------

TEST(PathSummary, ShowsWhatWasRead) {
  const Problem problem = testing::robot1_slice();
  PathFile file(std::make_unique<std::istringstream>(
                    "px[mm],py[mm],pz[mm],phi[deg],theta[deg],sigma[deg],t[ms]\n"
                    "0,0,350,170,10,34,100\n30,40,350,-170,20,34,200\n30,40,300,-160,20,34,350\n"),
                "p.csv", problem.space);
  PathSummary summary(problem, file.header());
  for (PathRow row; file.next(row);) summary.add(row);
  EXPECT_EQ(summary.rows(), 3u);
  EXPECT_NEAR(*summary.origin_length_m(), 0.1, 1e-15);
  EXPECT_NEAR(*summary.seconds(), 0.25, 1e-15);
  EXPECT_NEAR(summary.lower()[3], -170 * kDegree, 1e-15);
  EXPECT_THAT(summary.text(),
              AllOf(HasSubstr("positions and tilt-and-torsion angles, 3 rows, lines 2 to 4"),
                    HasSubstr("px         from 0 to 30, within 0 … 30 mm (0 … 0.03 m)"),
                    HasSubstr("phi        from 170 to -160, within -170 … 170 deg"), HasSubstr("0.1 m long"),
                    HasSubstr("takes 0.25 s"),
                    HasSubstr("in 1 row, first in line 3, an angle is more than a half turn from the row before: the "
                              "path takes the long way round, as the numbers say")));
}

TEST(PathSummary, SaysWhereThePlatformRests) {
  const auto text = [](const std::string& rows) {
    PathFile file(std::make_unique<std::istringstream>(rows), "p.csv", slice());
    PathSummary summary(testing::robot1_slice(), file.header());
    for (PathRow row; file.next(row);) summary.add(row);
    return summary.text();
  };
  EXPECT_THAT(text("phi[rad],theta[rad],t[ms]\n1,2,0\n1,2,10\n1,3,20\n1,2,30\n1,2,40\n1,2,50\n"),
              HasSubstr("3 rows repeat the row before: the platform rests there, longest in lines 5 to 7, which take "
                        "0.02 s\n"));
  EXPECT_THAT(text("phi[rad],theta[rad],t[s]\n1,2,0\n1,2,4\n1,3,5\n"),
              HasSubstr("1 row repeats the row before: the platform rests there for 4 s\n"));
  EXPECT_THAT(text("phi[rad],theta[rad]\n1,2\n1,2\n"), HasSubstr("the platform rests there\n"));
  EXPECT_THAT(text("phi[rad],theta[rad]\n1,2\n1,3\n1,2\n"), Not(HasSubstr("rests")));
}

TEST(PathSummary, FollowsTheOriginThroughTheCasesSpace) {
  const Problem problem = testing::robot2_sphere();
  PathFile file(std::make_unique<std::istringstream>("alpha1[rad],alpha2[rad]\n0,0.75\n0.001,0.75\n"), "p.csv",
                problem.space);
  PathSummary summary(problem, file.header());
  for (PathRow row; file.next(row);) summary.add(row);
  EXPECT_NEAR(*summary.origin_length_m(), 0.13 * std::cos(0.75) * 0.001, 1e-10);
  EXPECT_FALSE(summary.seconds());
}

}  // namespace
}  // namespace taut
