// SPDX-License-Identifier: GPL-3.0-or-later
// Where on a path a machine may be that has certain lengths or a certain pose: a table of the path in short cells.
//
// Within a cell each length, the position and the quaternion run straight from one node to the next, up to a slack that
// is four times as much as the path's bend there (a parabola over twice the cell, which bends four times as much, is
// what the slack is taken from). So the places at which a measured number is within a distance of the path's are one
// interval of the cell, and those at which all of them are is their intersection: a few divisions, and no iteration.
// Everything is in floating point, with a share of rounding in each slack.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "kinematics/pose_sampler.h"
#include "path_io/move_tables.h"

namespace taut {

/// Places from `lower` to `upper`; they count segments: k + s is the point s of segment k.
struct PlaceInterval {
  double lower = 0;
  double upper = 0;
};

/// What is measured of one row, as numbers with the path's numbers to compare them with, and by how much they may
/// differ. A number that is not measured allows everything.
struct PlaceTarget {
  static constexpr std::size_t kLengths = 2 * kCables;  ///< measured lengths, then those that the measured pose has
  static constexpr std::size_t kPosition = kLengths;    ///< number of the check of the position
  static constexpr std::size_t kTurn = kLengths + 1;    ///< and of the quaternion
  static constexpr std::size_t kChecks = kLengths + 2;
  using Mask = unsigned;  ///< bit k: check k is made
  [[nodiscard]] static constexpr Mask bit(std::size_t check) { return Mask{1} << check; }

  Mask mask = 0;
  std::array<double, kLengths> length{};          ///< [m]
  std::array<double, kLengths> length_allowed{};  ///< [m]
  Vector3<double> position;
  double position_allowed = 0;  ///< [m]
  Eigen::Vector4d turn;         ///< of length 1
  double turn_allowed = 0;      ///< distance of quaternions: 2 sin(angle/4)
};

class PlaceTable {
 public:
  struct Node {
    double s = 0;
    RigidPose pose;                        ///< of the robot as stated; q runs on without a change of sign
    std::array<double, kCables> length{};  ///< that it commands [m]
  };
  using Piece = TensionPiece;
  /// What slacks are to be small against, each at least 10⁻⁷ [m, m, 1].
  struct Resolution {
    std::array<double, kCables> length{};
    double position = 0, turn = 0;
  };

  /// @param pieces  in order and without gaps: nodes have to be where they meet; the first begins at 0 and the last
  /// ends at path.segments().
  PlaceTable(const PoseSampler& sampler, const Path& path, std::vector<Piece> pieces, const Resolution& resolution);

  [[nodiscard]] std::size_t cells() const { return cells_.size(); }
  [[nodiscard]] const Node& node(std::size_t k) const { return nodes_[k]; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// The cell in which a place is; at a node, the one that begins there.
  [[nodiscard]] std::size_t cell_at(double s) const;
  /// Pieces that some of these places are in.
  [[nodiscard]] std::span<const Piece> pieces_at(const PlaceInterval& places) const;

  /// The places of these cells at which every measured number may be, with differences up to `factor` times what is
  /// allowed: intervals in order, which touch nowhere.
  [[nodiscard]] std::vector<PlaceInterval> places(const PlaceTarget& target, PlaceTarget::Mask mask,
                                                  std::size_t first_cell, std::size_t end_cell,
                                                  double factor = 1) const;

  /// The place that fits best, and the least factor with which there is one.
  struct Fit {
    double s = 0;
    double factor = 0;
  };
  [[nodiscard]] Fit best_fit(const PlaceTarget& target, PlaceTarget::Mask mask, std::size_t first_cell,
                             std::size_t end_cell) const;

  /// The pose on the chord of a cell, and the lengths.
  [[nodiscard]] Node at(double s) const;
  /// How far poses at these places may be from that at s: of the origin [m], and turned by [rad].
  struct Spread {
    double position = 0, turn = 0;
  };
  [[nodiscard]] Spread spread(const PlaceInterval& places, const Node& from) const;

 private:
  struct Cell {
    std::array<double, kCables> length_slack{};
    double position_slack = 0, turn_slack = 0;
  };
  void append(const PoseSampler& sampler, const Segment& segment, const Node& end, const Resolution& resolution,
              int depth);
  [[nodiscard]] std::optional<PlaceInterval> window(std::size_t cell, const PlaceTarget& target, PlaceTarget::Mask mask,
                                                    double factor) const;

  std::vector<Node> nodes_;
  std::vector<Cell> cells_;  ///< cell k is between nodes k and k + 1
  std::vector<Piece> pieces_;
};

}  // namespace taut
