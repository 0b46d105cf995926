// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/reference_path.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "certify/arithmetic/rounding.h"
#include "kinematics/pose_conversion.h"

namespace taut {
namespace {

constexpr int kMostPieces =
    4096;  ///< of a segment, either way: next to a singular pose all along, thousands are needed
constexpr int kMostHalvings = 40;  ///< of [0, 1]
/// Of a tube, in units of the robot's size: what rounding may need, and Newton's method next to a singular pose.
constexpr std::array<double, 3> kLeastTubes = {0x1p-36, 0x1p-30, 0x1p-24};
/// Of a tube, times what the motion bends away from a piece: a box as long as the piece sees two or three times that.
constexpr double kRoom = 6;
constexpr double kRoomAtEnds = 3;  ///< and times the distance of a waypoint's pose from the motion

/// Follows the motion along a segment, piece by piece.
class ReferenceFinder {
 public:
  ReferenceFinder(const ProofModel<Interval>& model, const Model<double>& approx, const Segment& segment)
      : model_(model),
        approx_(approx),
        segment_(segment),
        unit_(std::exp2(std::ceil(std::log2(approx.characteristic_length)))) {}

  struct Point {
    double s = 0;
    PoseNumbers x{};  ///< of the reference
    RigidPose pose{Vector3<double>::Zero(), Eigen::Quaterniond::Identity()};
  };
  struct Piece {
    Point first, last;  ///< by rising s
    PoseTube tube;
  };

  /// Pieces from s = 0 up to `until`, or from 1 down to it; fewer where none that is short enough is proved.
  std::vector<Piece> follow(bool forward, double until) {
    std::vector<Piece> pieces;
    Point at = at_waypoint(forward ? 0 : 1);
    const Point finish = at_waypoint(forward ? 1 : 0);
    int depth = 0;
    while (at.s != until && depth <= kMostHalvings && pieces.size() < kMostPieces) {
      const double step = std::ldexp(forward ? 1.0 : -1.0, -depth);
      const double s = at.s + step;
      if (forward ? s > until : s < until) {
        ++depth;
        continue;
      }
      std::optional<Piece> piece;
      if (auto next = point(at, s)) {
        if (s == finish.s) next->x = finish.x;
        piece = forward ? proved(at, *next) : proved(*next, at);
        if (piece) {
          at = *next;
          pieces.push_back(*piece);
        }
      }
      if (!piece) {
        ++depth;
      } else if (depth > 0 && std::fmod(at.s, 2 * step) == 0) {
        --depth;  // so that pieces are boxes of bisection
      }
    }
    return pieces;
  }

  [[nodiscard]] PoseTube least_tube() const { return tube(kLeastTubes.front()); }
  [[nodiscard]] PoseTube tube(double size) const { return {unit_ * size, size}; }

 private:
  [[nodiscard]] std::array<double, kCables> lengths(double s) const { return lengths_at(segment_, s); }

  /// Its pose is the one next to the reference that has the lengths, where Newton's method finds that.
  [[nodiscard]] Point at_waypoint(std::size_t k) const {
    Point result;
    result.s = static_cast<double>(k);
    result.x = segment_.control[k]->pose();
    result.pose = rigid_pose(result.x);
    result.pose = pose_of_lengths(approx_, lengths(result.s), result.pose).value_or(result.pose);
    return result;
  }

  /// The pose that the lengths at s lead to from `near`.
  std::optional<Point> point(const Point& near, double s) const {
    const auto pose = pose_of_lengths(approx_, lengths(s), near.pose);
    if (!pose) return std::nullopt;
    Eigen::Quaterniond q = pose->q;
    const auto& x = near.x;
    // Of the waypoints' length and sign, so that the piece to either is near a rotation at constant rate.
    const auto length_at = [&](std::size_t k) { return quaternion_length(segment_.control[k]->pose()); };
    q.coeffs() *= (1 - s) * length_at(0) + s * length_at(1);
    if (q.x() * x[3] + q.y() * x[4] + q.z() * x[5] + q.w() * x[6] < 0) q.coeffs() = -q.coeffs();
    return Point{s, pose_numbers({pose->p, q}), *pose};
  }

  /// In units of a tube of size 1.
  [[nodiscard]] double distance(const RigidPose& from, const RigidPose& to) const {
    const Eigen::Quaterniond turn = to.q * from.q.conjugate();
    const double turned = turn.vec().cwiseAbs().maxCoeff() / std::abs(turn.w());
    return std::max((to.p - from.p).cwiseAbs().maxCoeff() / unit_, turned);
  }

  std::optional<Piece> proved(const Point& first, const Point& last) const {
    const double s = 0.5 * (first.s + last.s);
    PoseNumbers x{};
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = 0.5 * (first.x[k] + last.x[k]);
    const RigidPose chord = rigid_pose(x);
    const auto pose = pose_of_lengths(approx_, lengths(s), chord);
    if (!pose) return std::nullopt;
    const double away = std::max(distance(rigid_pose(first.x), first.pose), distance(rigid_pose(last.x), last.pose));
    const double bend = distance(chord, *pose);
    const double size = kRoom * std::max(0.0, bend - away) + kRoomAtEnds * away;
    if (!std::isfinite(size)) return std::nullopt;
    for (const double least : kLeastTubes) {
      const Piece piece{first, last, tube(std::max(size, least))};
      if (is_proved(piece)) return piece;
      if (size > least) break;
    }
    return std::nullopt;
  }

  /// Whether one pose in the tube is proved all along the piece.
  [[nodiscard]] bool is_proved(const Piece& piece) const {
    Segment trial = segment_;
    trial.inner_poses.clear();
    trial.pose_tube = piece.tube;
    if (piece.first.s > 0) trial.inner_poses.push_back({piece.first.s, piece.first.x, piece.tube});
    if (piece.last.s < 1) trial.inner_poses.push_back({piece.last.s, piece.last.x, piece.tube});
    const double mid = 0.5 * (piece.first.s + piece.last.s);
    const double radius = 0.5 * (piece.last.s - piece.first.s);
    bool is_known = false;
    const bool is_sound = run_upward([&] {
      const EnclosedBox<Interval> box{Interval(piece.first.s, piece.last.s), Interval(mid)};
      is_known = undisturbed_motion(model_, trial, box, Interval(-radius, radius)).is_enclosed();
    });
    return is_known && is_sound;
  }

  const ProofModel<Interval>& model_;
  const Model<double>& approx_;
  const Segment& segment_;
  double unit_;
};

}  // namespace

void propose_reference(const ProofModel<Interval>& model, const Model<double>& approx, Segment& segment) {
  ReferenceFinder finder(model, approx, segment);
  auto pieces = finder.follow(true, 1);
  const double reached = pieces.empty() ? 0 : pieces.back().last.s;
  if (reached < 1) {
    const auto back = finder.follow(false, reached);
    const double resumed = back.empty() ? 1 : back.back().first.s;
    if (reached < resumed) {
      ReferenceFinder::Piece open;
      open.first.s = reached;
      if (!pieces.empty()) open.first = pieces.back().last;
      open.tube = finder.least_tube();
      pieces.push_back(open);
    }
    pieces.insert(pieces.end(), back.rbegin(), back.rend());
  }
  segment.pose_tube = pieces.front().tube;
  segment.inner_poses.clear();
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    segment.inner_poses.push_back({pieces[k].first.s, pieces[k].first.x, pieces[k].tube});
  }
}

}  // namespace taut
