// SPDX-License-Identifier: GPL-3.0-or-later
// winches.csv, poses.csv and poses.tum: a proved move as tables in time, for the drives that follow it and for programs
// that show it.
//
// Their rows are on the move but for rounding. What is proved is the move itself: its path, through the waypoints of
// path.csv, and its time law, which is in the certificate. What drives do between two rows is another motion.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/segment.h"
#include "problem/problem.h"

namespace taut {

/// What the tables begin with, all three.
inline constexpr std::string_view kMoveTableBegin = "# Samples of a proved move";

/// Columns of winches.csv and poses.csv.
inline constexpr std::array<std::string_view, 1 + 5 * kCables> kWinchColumns = {
    "t[s]",                                                                        //
    "l1[m]",     "l2[m]",     "l3[m]",     "l4[m]",     "l5[m]",     "l6[m]",      //
    "v1[m/s]",   "v2[m/s]",   "v3[m/s]",   "v4[m/s]",   "v5[m/s]",   "v6[m/s]",    //
    "a1[m/s^2]", "a2[m/s^2]", "a3[m/s^2]", "a4[m/s^2]", "a5[m/s^2]", "a6[m/s^2]",  //
    "fmin1[N]",  "fmin2[N]",  "fmin3[N]",  "fmin4[N]",  "fmin5[N]",  "fmin6[N]",   //
    "fmax1[N]",  "fmax2[N]",  "fmax3[N]",  "fmax4[N]",  "fmax5[N]",  "fmax6[N]"};
inline constexpr std::array<std::string_view, 8> kPoseColumns = {"t[s]", "px[m]", "py[m]", "pz[m]",
                                                                 "qx",   "qy",    "qz",    "qw"};

/// Tables take fewer rows than that, but for the last one.
inline constexpr double kMostMoveRows = 500'000;

/// Between which tensions each cable is proved to be on a part of a path.
struct TensionPiece {
  using Ranges = std::array<std::array<double, 2>, kCables>;
  double lower = 0, upper = 0;  ///< places, which count segments: k + s is the point s of segment k
  Ranges tension{};             ///< the least and the greatest [N]
};

/// The numbers of the tables.
struct MoveRows {
  std::vector<std::array<double, kWinchColumns.size()>> winches;
  std::vector<std::array<double, kPoseColumns.size()>> poses;
};

/// Rows at t = 0, 1/rate, 2/rate, … and at the end of the move. Quaternions go on without a change of sign.
/// @param tensions  in order, over all of the path: a row has the ranges of all places from it to the next; none
/// where only poses are needed
/// @pre path.timing @throws InputError if there are more than kMostMoveRows.
[[nodiscard]] MoveRows move_rows(const Problem& problem, const Path& path, std::span<const TensionPiece> tensions,
                                 double rate_Hz);

struct MoveTables {
  std::string winches_csv;  ///< t; lengths, their first two derivatives by time, proved tensions, of six cables
  std::string poses_csv;    ///< t; position of the platform's origin, and the quaternion that turns P into W
  std::string poses_tum;    ///< the same with blanks between, as programs for trajectories read it
};

/// move_rows() as text: numbers that read back to the same binary64. Comments at the top name the case, units, what is
/// proved, by how much cables that run straight from row to row miss the proved lengths at most, and the certificate by
/// its SHA-256.
/// @pre, @throws  as move_rows()
[[nodiscard]] MoveTables move_tables(const Problem& problem, const Path& path, std::span<const TensionPiece> tensions,
                                     double rate_Hz, std::string_view certificate_sha256);

/// A proved move, one of several that follow one another.
struct MoveLeg {
  const Problem& problem;
  const Path& path;
  std::string name;
  std::vector<TensionPiece> tensions;  ///< as move_rows() takes them
};

/// The rows of legs one after the other, as move_tables() has them. @pre, @throws  as there
[[nodiscard]] MoveRows move_rows(std::span<const MoveLeg> legs, double rate_Hz);

/// The tables of legs one after the other: times go on from leg to leg, without a pause, and the row where two legs
/// meet stands once. Comments say between which times each leg is.
/// @param name  of the case @param certificate_sha256  of the certificate of all legs
/// @pre one leg or more, each with path.timing, and each begins where the one before it ends @throws as move_rows()
[[nodiscard]] MoveTables move_tables(std::span<const MoveLeg> legs, const std::string& name, double rate_Hz,
                                     std::string_view certificate_sha256);

}  // namespace taut
