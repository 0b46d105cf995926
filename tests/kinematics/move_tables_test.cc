// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of a move: read back, against differences of their own rows and against the path.
#include "path_io/move_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "base/input_error.h"
#include "kinematics/move_sampler.h"
#include "kinematics/pose_sampler.h"
#include "problem/rows.h"
#include "tests/support/robots.h"

namespace taut::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Table {
  std::vector<std::string> comments;
  std::string header;  ///< empty: none
  std::vector<std::vector<double>> rows;
};
Table read(const std::string& text, char separator, bool has_header) {
  Table table;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) {
      table.comments.push_back(line);
    } else if (has_header && table.header.empty()) {
      table.header = line;
    } else {
      auto& row = table.rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, separator);) {
        const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), row.emplace_back());
        EXPECT_TRUE(error == std::errc() && end == cell.data() + cell.size()) << cell;
      }
    }
  }
  return table;
}

class MoveTablesTest : public ::testing::Test {
 protected:
  Problem problem_ = [] {
    Problem problem = free_flying(robot2_sphere());
    problem.time.emplace().winch_acceleration_m_s2.fill("0.5");
    return problem;
  }();
  Path path_ = [] {
    const Waypoint a = at({-0.03, 0, 0.3, 0, 0, 0}), b = at({0, 0.03, 0.32, 0.3, 0.1, 0.2}),
                   c = at({0.03, 0.01, 0.28, 0.2, 0.2, 0.5});
    Path path{{a, a, a, b, c, c, c}, Interpolation::kCubicBSpline};
    path.timing = TimeLaw{0x1p-1 + 0x1p-20, {0, 0, 0, 1, 2, 3, 4, 4, 4}};
    return path;
  }();
  /// Of one piece a tenth of the path; cable i from 100 k + i to 100 k + 50 + i in piece k.
  std::vector<TensionPiece> pieces_ = [this] {
    std::vector<TensionPiece> pieces(10);
    const auto end = static_cast<double>(path_.segments());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      pieces[k].lower = end * static_cast<double>(k) / 10;
      pieces[k].upper = end * static_cast<double>(k + 1) / 10;
      for (std::size_t i = 0; i < kCables; ++i) {
        const double from = 100.0 * static_cast<double>(k) + static_cast<double>(i);
        pieces[k].tension[i] = {from, from + 50};
      }
    }
    return pieces;
  }();
};

TEST_F(MoveTablesTest, RowsAreAtEvenTimesAndAtTheEndExactly) {
  const double end = path_.timing->duration_s();
  const MoveTables tables = move_tables(problem_, path_, pieces_, 1000, "abc");
  for (const auto& [text, separator] :
       {std::pair(&tables.winches_csv, ','), std::pair(&tables.poses_csv, ','), std::pair(&tables.poses_tum, ' ')}) {
    const Table table = read(*text, separator, separator == ',');
    ASSERT_EQ(table.rows.size(), static_cast<std::size_t>(std::ceil(end * 1000)) + 1);
    for (std::size_t k = 0; k + 1 < table.rows.size(); ++k) {
      EXPECT_EQ(table.rows[k][0], static_cast<double>(k) / 1000);
      EXPECT_LT(table.rows[k][0], end);
    }
    EXPECT_EQ(table.rows.back()[0], end);
    EXPECT_THAT(table.comments.back(), HasSubstr(separator == ',' ? "SHA-256 abc" : "t px py pz qx qy qz qw"));
    EXPECT_TRUE(text->starts_with(kMoveTableBegin));
  }
}

TEST_F(MoveTablesTest, AFullPeriodAtTheEndGivesNoRowTwice) {
  path_.timing->step_s = 0.25;  // 1.5 s
  const Table table = read(move_tables(problem_, path_, pieces_, 100, "").winches_csv, ',', true);
  EXPECT_EQ(table.rows.size(), 151U);
  EXPECT_EQ(table.rows[149][0], 1.49);
  EXPECT_EQ(table.rows[150][0], 1.5);
}

TEST_F(MoveTablesTest, SpeedsAndAccelerationsAreDerivativesOfLengths) {
  constexpr double kRate = 1000;
  const Table table = read(move_tables(problem_, path_, pieces_, kRate, "").winches_csv, ',', true);
  EXPECT_TRUE(table.header.starts_with("t[s],l1[m],")) << table.header;
  double fastest = 0, hardest = 0;
  for (std::size_t k = 1; k + 2 < table.rows.size(); ++k) {
    const auto& before = table.rows[k - 1];
    const auto& now = table.rows[k];
    const auto& after = table.rows[k + 1];
    ASSERT_EQ(now.size(), 31U);
    for (std::size_t i = 1; i <= kCables; ++i) {
      EXPECT_NEAR(now[6 + i], (after[i] - before[i]) * kRate / 2, 1e-4);
      EXPECT_NEAR(now[12 + i], (after[6 + i] - before[6 + i]) * kRate / 2, 0.01);
      fastest = std::max(fastest, std::abs(now[6 + i]));
      hardest = std::max(hardest, std::abs(now[12 + i]));
    }
  }
  EXPECT_GT(fastest, 0.03);
  EXPECT_GT(hardest, 0.03);
  for (std::size_t i = 7; i <= 12; ++i) {
    EXPECT_EQ(table.rows.front()[i], 0);
    EXPECT_NEAR(table.rows.back()[i], 0, 1e-12);
  }
}

TEST_F(MoveTablesTest, StraightLengthsStayWithinWhatTheCommentSays) {
  constexpr double kRate = 20, kLimit = 0.5;
  const Table table = read(move_tables(problem_, path_, pieces_, kRate, "").winches_csv, ',', true);
  // h^2/8 times the limit: 0.15625 mm.
  std::string all;
  for (const std::string& line : table.comments) all += line + "\n";
  EXPECT_THAT(all, HasSubstr("0.157 mm of each cable, for 0.5 m/s^2"));
  const MoveSampler sampler(problem_);
  const PoseSampler poses(problem_);
  double most = 0;
  for (std::size_t k = 0; k + 1 < table.rows.size(); ++k) {
    for (const double part : {0.25, 0.5, 0.75}) {
      const MoveSample now = sampler.at_time(path_, std::lerp(table.rows[k][0], table.rows[k + 1][0], part));
      const auto length = cable_lengths(poses.model(), poses.rigid_pose(path_.segment(now.segment), now.s));
      for (std::size_t i = 0; i < kCables; ++i) {
        EXPECT_LT(std::abs(now.winches.acceleration[i]), kLimit) << "as a certificate would say";
        const double straight = std::lerp(table.rows[k][i + 1], table.rows[k + 1][i + 1], part);
        most = std::max(most, std::abs(length[i] - straight));
      }
    }
  }
  EXPECT_LT(most, 0.157e-3);
  EXPECT_GT(most, 0.01e-3);
}

TEST_F(MoveTablesTest, SaysWhetherStraightLengthsAreProved) {
  problem_.time->rows = rows_between(*problem_.time, Rational(1, 100) + Rational(1, 1'000'000'000), {});
  for (const double rate : {100.0, 200.0}) {
    const std::string text = move_tables(problem_, path_, pieces_, rate, "").winches_csv;
    EXPECT_THAT(text, HasSubstr(rate == 100 ? "0.00625 mm of each cable" : "0.00157 mm of each cable"));
    EXPECT_THAT(text,
                HasSubstr("What is proved of tensions, lengths, clearances and singular poses holds for lengths"));
    EXPECT_THAT(text, Not(HasSubstr("no part of the certificate")));
  }
  // Rows that are off for another reason may be farther apart.
  problem_.time->rows = rows_between(*problem_.time, Rational(1, 1000), {1, 1, 1, 1, 1, 1});
  EXPECT_THAT(move_tables(problem_, path_, pieces_, 10, "").winches_csv, HasSubstr("lengths that are so far off"));
  problem_.time->rows = rows_between(*problem_.time, Rational(1, 100), {});
  const std::string coarser = move_tables(problem_, path_, pieces_, 99, "").winches_csv;
  EXPECT_THAT(coarser, HasSubstr("How drives join the rows is no part of the certificate"));
}

TEST_F(MoveTablesTest, RowsHaveTheTensionsOfAllPlacesUntilTheNext) {
  const Table table = read(move_tables(problem_, path_, pieces_, 20, "").winches_csv, ',', true);
  ASSERT_TRUE(
      table.header.ends_with("a6[m/s^2],fmin1[N],fmin2[N],fmin3[N],fmin4[N],fmin5[N],fmin6[N],fmax1[N],"
                             "fmax2[N],fmax3[N],fmax4[N],fmax5[N],fmax6[N]"));
  std::size_t several = 0;
  for (std::size_t n = 0; n < table.rows.size(); ++n) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    const double from = table.rows[n][0], to = table.rows[std::min(n + 1, table.rows.size() - 1)][0];
    for (int k = 0; k <= 50; ++k) {
      const double place =
          at_time(*path_.timing, std::lerp(from, to, k / 50.0)).s / static_cast<double>(path_.segments());
      const double piece = std::clamp(std::floor(10 * place), 0.0, 9.0);
      least = std::min(least, 100 * piece);
      most = std::max(most, 100 * piece + 50);
    }
    if (most - least > 50) ++several;
    for (std::size_t i = 0; i < kCables; ++i) {
      EXPECT_LE(table.rows[n][19 + i], least + static_cast<double>(i)) << n;
      EXPECT_GE(table.rows[n][25 + i], most + static_cast<double>(i)) << n;
      EXPECT_GE(table.rows[n][19 + i], least + static_cast<double>(i) - 100) << n;  // a piece that ends there
      EXPECT_LE(table.rows[n][25 + i], most + static_cast<double>(i) + 100) << n;
    }
  }
  EXPECT_GT(several, 5U);
}

TEST_F(MoveTablesTest, SaysWhichWinchesHaveNoLimit) {
  problem_.time->winch_acceleration_m_s2[2].reset();
  const std::string some = move_tables(problem_, path_, pieces_, 100, "").winches_csv;
  EXPECT_THAT(some, HasSubstr("0.00625 mm of cable 2, for 0.5 m/s^2; nothing is known of cable 3, whose"));
  problem_.time->winch_acceleration_m_s2 = {};
  const std::string none = move_tables(problem_, path_, pieces_, 100, "").winches_csv;
  EXPECT_THAT(none, HasSubstr("The case limits no winch's acceleration"));
  EXPECT_THAT(none, Not(HasSubstr(" mm of ")));
}

TEST_F(MoveTablesTest, PosesAreOnThePath) {
  const MoveTables tables = move_tables(problem_, path_, pieces_, 50, "");
  const Table csv = read(tables.poses_csv, ',', true), tum = read(tables.poses_tum, ' ', false);
  EXPECT_EQ(csv.header, "t[s],px[m],py[m],pz[m],qx,qy,qz,qw");
  EXPECT_EQ(csv.rows, tum.rows);
  const PoseSampler sampler(problem_);
  for (std::size_t k = 0; k < csv.rows.size(); ++k) {
    const auto& row = csv.rows[k];
    ASSERT_EQ(row.size(), 8U);
    const double place = at_time(*path_.timing, row[0]).s;
    const std::size_t segment = std::min(static_cast<std::size_t>(place), path_.segments() - 1);
    const RigidPose pose = sampler.rigid_pose(path_.segment(segment), place - static_cast<double>(segment));
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(row[1 + static_cast<std::size_t>(axis)], pose.p(axis), 1e-12);
    const Eigen::Quaterniond q(row[7], row[4], row[5], row[6]);
    EXPECT_NEAR(std::abs(q.dot(pose.q)), 1, 1e-12);
    if (k == 0) continue;
    const auto& last = csv.rows[k - 1];
    EXPECT_GT(q.dot(Eigen::Quaterniond(last[7], last[4], last[5], last[6])), 0.9) << "no jump of sign";
  }
}

TEST_F(MoveTablesTest, TooManyRowsAreRefused) {
  path_.timing->step_s = 60;
  EXPECT_THROW((void)move_tables(problem_, path_, pieces_, 10'000, ""), InputError);
}

}  // namespace
}  // namespace taut::testing
