// SPDX-License-Identifier: GPL-3.0-or-later
// Where two bodies come nearest, in floating point: what proposes directions and points. Nothing here is proved.
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "certify/bodies/body_gaps.h"
#include "kinematics/bodies.h"
#include "kinematics/pose_sampler.h"

namespace taut {

/// As many as a box has corners take no memory of their own.
template <class T>
struct FewOf : boost::container::small_vector<T, 8> {
  using boost::container::small_vector<T, 8>::small_vector;
  explicit(false) operator std::span<const T>() const { return {this->data(), this->size()}; }
};
using Points = FewOf<Vector3<double>>;
using Shares = FewOf<double>;

/// Nearest points of the convex hulls of two sets of points (Gilbert, Johnson and Keerthi's algorithm).
struct NearestPoints {
  double distance = 0;             ///< 0 where the hulls meet, up to rounding
  Vector3<double> apart{0, 0, 0};  ///< from the second's nearest point to the first's
  Shares first, second;            ///< of the points, nonnegative, summing to 1
};
[[nodiscard]] NearestPoints nearest_points(std::span<const Vector3<double>> first,
                                           std::span<const Vector3<double>> second);

/// About how deep two hulls that meet are in each other.
struct Overlap {
  double depth = 0;                ///< the least along any direction, sought from the best of many [m]
  Vector3<double> along{0, 0, 1};  ///< the unit vector that moves the first out of the second by it
};
[[nodiscard]] Overlap overlap(std::span<const Vector3<double>> first, std::span<const Vector3<double>> second);

struct BodyInFrame;

/// The bodies of a problem in doubles.
class BodySampler {
 public:
  explicit BodySampler(const Problem& problem);

  [[nodiscard]] const BodyModel<double>& bodies() const { return bodies_; }
  /// Whether elements of a mesh have to be told apart one by one.
  [[nodiscard]] bool needs_list(std::size_t pair) const;
  /// How much farther than required (required_distance()) a pair is apart at a pose [m]; where hulls meet, minus radii
  /// and clearance, unless they may meet somewhere; where a part of one body is inside of the other, a watertight mesh,
  /// minus how far surfaces are apart as well.
  [[nodiscard]] double gap(const Model<double>& model, const RigidPose& pose, std::size_t pair) const;
  /// gap() less what deviations within the tolerances take of it, no more than that: a pair without room can't be
  /// proved to be clear.
  [[nodiscard]] double room(const Model<double>& model, const RigidPose& pose, std::size_t pair) const;
  /// Along which a pair is farthest apart at a pose, with components up to `largest`; nothing where hulls meet that may
  /// not meet anywhere.
  [[nodiscard]] std::optional<Direction> direction(const Model<double>& model, const RigidPose& pose, std::size_t pair,
                                                   int largest = Direction::kLargest,
                                                   std::span<const RigidPose> around = {}) const;
  /// Those along which a pair with a mesh is apart at a pose, part by part: by at least this share of its gap, if there
  /// are not too many. Of other pairs, direction(). Empty where the bodies are not clear.
  [[nodiscard]] std::vector<Direction> directions(const Model<double>& model, const RigidPose& pose, std::size_t pair,
                                                  int largest, double share, std::span<const RigidPose> around) const;
  /// One along which a pair may well be apart there, from its bodies' axes and middles: much cheaper.
  [[nodiscard]] Direction rough_direction(const Model<double>& model, const RigidPose& pose, std::size_t pair) const;
  /// Of all pairs those to try first on a way from end to end: rough ones where it seems that they will do; else, and
  /// of the nearest pairs, those along which they are farthest apart in the middle.
  [[nodiscard]] PairDirections first_directions(const Model<double>& model, const RigidPose& middle,
                                                const std::array<RigidPose, 2>& ends) const;
  /// Of some pairs their rough_direction(); those of the others stay.
  void set_rough_directions(const Model<double>& model, const RigidPose& pose, std::span<const std::size_t> pairs,
                            PairDirections& directions) const;
  /// Of some pairs those along which they are farthest apart at a pose, between these ends. @returns how much farther
  /// than their clearances all of them are apart along these there [m]
  double set_sharp_directions(const Model<double>& model, const RigidPose& pose, const std::array<RigidPose, 2>& ends,
                              std::span<const std::size_t> pairs, PairDirections& directions) const;
  /// Its nearest points there.
  [[nodiscard]] PointPair nearest(const Model<double>& model, const RigidPose& pose, std::size_t pair) const;

  /// What may show that a pair touches at a pose, and at those near it.
  struct Touching {
    PointPair nearest;                               ///< its nearest points
    std::optional<std::array<PointPair, 4>> around;  ///< pairs of points, the vectors between which are around 0
  };
  /// Nothing where the pair is farther apart than required.
  [[nodiscard]] std::optional<Touching> touching(const Model<double>& model, const RigidPose& pose,
                                                 std::size_t pair) const;

  /// How a contact at a pose may be shown, simple ways first.
  [[nodiscard]] std::vector<PairContact> contacts(const Model<double>& model, const RigidPose& pose,
                                                  std::size_t pair) const;

  /// How far pairs were apart where they were measured: a pair is apart where no point of it has moved as far from one
  /// of these places.
  struct Carried {
    struct Gap {
      double gap = 0;
      RigidPose pose;
    };
    std::vector<std::vector<Gap>> pairs;
  };
  /// Whether all pairs have room(). @param carried  from earlier poses; at first empty
  [[nodiscard]] bool is_clear(const Model<double>& model, const RigidPose& pose, Carried& carried) const;

 private:
  /// The second body of a pair, where it is one; else null.
  [[nodiscard]] const HalfSpace<double>* half_space(const CheckedPair<double>& pair) const;
  /// Whether a pair needs no direction: its half-space or cone has one.
  [[nodiscard]] bool has_own_direction(std::size_t pair) const;
  [[nodiscard]] bool is_better_in_platform(const CheckedPair<double>& pair, const Vector3<double>& along,
                                           const RigidPose& pose, std::span<const RigidPose> around) const;
  [[nodiscard]] std::array<BodyInFrame, 2> in_world(const Model<double>& model, const RigidPose& pose,
                                                    std::size_t pair) const;
  struct Sketch;
  [[nodiscard]] Sketch sketch(const Model<double>& model, const RigidPose& pose) const;
  /// How far apart cables, and balls or boxes around bodies, are.
  struct RoughGap {
    Vector3<double> apart{0, 0, 0};
    double gap = -std::numeric_limits<double>::infinity();  ///< its length less the clearance
    double lost = 0;                                        ///< about how much of it along rough_direction(), at most
  };
  [[nodiscard]] RoughGap rough_gap(const Sketch& at, std::size_t pair) const;
  [[nodiscard]] RoughGap gap_of_aligned_boxes(const Sketch& at, std::size_t pair) const;
  [[nodiscard]] RoughGap gap_of_balls(const Sketch& at, std::size_t pair) const;
  /// @param apart  RoughGap::apart
  [[nodiscard]] Direction rough_direction(const Sketch& at, std::size_t pair, const Vector3<double>& apart,
                                          int largest = Direction::kCoarse) const;
  [[nodiscard]] std::optional<Direction> sharp_direction(const Model<double>& model, const Sketch& at,
                                                         const RigidPose& pose, const std::array<RigidPose, 2>& ends,
                                                         std::size_t pair) const;
  [[nodiscard]] double clear_along(const Sketch& at, std::size_t pair, const Direction& direction) const;
  struct Found;
  [[nodiscard]] Found find(const Model<double>& model, const RigidPose& pose, std::size_t pair) const;
  [[nodiscard]] double rough_gap_of_mesh(const Model<double>& model, const RigidPose& pose, std::size_t pair,
                                         double enough) const;
  [[nodiscard]] double lost(const Model<double>& model, const RigidPose& pose, std::size_t pair,
                            const Found& found) const;
  [[nodiscard]] double most_lost(const Model<double>& model, const RigidPose& pose) const;

  /// Greatest deviations [m, rad].
  struct Tolerances {
    std::array<double, kCables> base{}, anchor{};
    double position = 0;
    double turn = 0;
  };
  std::optional<Tolerances> tolerances_;  ///< unless they are none, or of cables' lengths
  BodyModel<double> bodies_;
  double reach_ = 0;  ///< of what the platform carries, from its origin [m]
};

}  // namespace taut
