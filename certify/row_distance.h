// SPDX-License-Identifier: GPL-3.0-or-later
// How far a row of a table is from where a move is at the row's time, proved.
//
// Claim.  The bounds hold for the row's exact decimals, of which its numbers are the nearest binary64, and for the move
// of exactly these control points at exactly that time.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "kinematics/segment.h"
#include "problem/problem.h"
#include "problem/rational.h"

namespace taut {

/// A row in the numbers of a table.
struct RowPose {
  enum class Form {
    kParameters,  ///< of the space [m, rad]
    kQuaternion,  ///< px, py, pz [m], qx, qy, qz, qw
    kLengths,     ///< of the cables, from anchor to anchor [m]
  };
  Form form = Form::kParameters;
  std::vector<double> x;        ///< each next to what was typed, in SI
  std::vector<int> half_turns;  ///< of parameters
};

/// Upper bounds: by so much the platform's origin is displaced, and the platform turned; or of a row of lengths, by so
/// much each cable of the machine as typed is longer or shorter.
struct RowDistance {
  double position_m = 0;
  double angle_rad = 0;
  double length_m = 0;
};

class RowDistances {
 public:
  /// @param path  of `problem`'s parameters: straight segments or a spline, with the law σ(t) = t/h, so that a law's
  ///              control value i is i − 1; outlives this
  /// @throws InputError where the law is another one. @throws std::logic_error where the space has constraints, which
  /// imply another motion than that of the parameters alone.
  RowDistances(const Problem& problem, const Path& path);
  ~RowDistances();
  RowDistances(const RowDistances&) = delete;
  RowDistances& operator=(const RowDistances&) = delete;

  /// @param time_s  of the move, exactly; before and after it the platform rests at its ends
  /// @returns nothing where a number is beyond what can be enclosed.
  [[nodiscard]] std::optional<RowDistance> at(const Rational& time_s, const RowPose& row) const;

 private:
  struct Enclosures;
  const Path& path_;
  std::unique_ptr<const Enclosures> enclosures_;
};

}  // namespace taut
