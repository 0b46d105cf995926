// SPDX-License-Identifier: GPL-3.0-or-later
// How far bodies are apart, in floating point: what is said and drawn of them at single poses. Nothing here is proved.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "certify/bodies/nearest.h"
#include "problem/bodies.h"
#include "reports/summary/samples.h"

namespace taut {

/// A pair of bodies at one pose.
struct BodyDistance {
  std::size_t pair = 0;  ///< in the order of pairs() of problem/bodies.h
  /// Between the two surfaces; where the bodies overlap, minus about how far one has to be moved until they don't [m].
  double distance = 0;
  double clearance = 0;     ///< asked there; where the pair may touch, minus the depth allowed [m]
  bool is_in_cone = false;  ///< of a cable and an exit cone: how far the cable's other end is inside of it
  /// A point of either body, in W: the nearest ones, or one of both where they overlap [m].
  std::array<Vector3<double>, 2> at{Vector3<double>::Zero(), Vector3<double>::Zero()};

  [[nodiscard]] double left() const { return distance - clearance; }
};

/// `clearance`, exactly. @param pair  the same
[[nodiscard]] DecimalText asked_exactly(const BodyDistance& distance, const BodyPair& pair);

/// The pairs of one problem.
class BodyDistances {
 public:
  /// @pre problem.bodies
  explicit BodyDistances(const Problem& problem);

  [[nodiscard]] std::size_t pairs() const { return names_.size(); }
  /// "container / stack"
  [[nodiscard]] const std::string& name(std::size_t pair) const { return names_.at(pair); }
  [[nodiscard]] const BodyModel<double>& bodies() const { return bodies_.bodies(); }
  [[nodiscard]] BodyDistance at(const Model<double>& model, const RigidPose& pose, std::size_t pair) const;
  /// The pairs with the least left at a pose, at most `most` of them, the least first.
  [[nodiscard]] std::vector<BodyDistance> nearest(const Model<double>& model, const RigidPose& pose,
                                                  std::size_t most) const;
  /// What bodies of the pair consist of at a pose: all within the radius of the hull of some points in W [m]. Of a mesh
  /// the element that is nearest to the other body.
  struct Placed {
    Points points;
    double radius = 0;
    const HalfSpace<double>* half_space = nullptr;  ///< in place of both
  };
  [[nodiscard]] std::array<Placed, 2> placed(const Model<double>& model, const RigidPose& pose, std::size_t pair) const;

 private:
  BodySampler bodies_;
  std::vector<std::string> names_;
};

/// The distances along a path, at samples.
struct DistancesAlong {
  /// At each sample, of all pairs the one with the least left.
  std::vector<BodyDistance> least;
  std::vector<std::size_t> nearest;             ///< pairs that come nearest, with the least left first
  std::vector<std::vector<double>> distance;    ///< of each of these at each sample [m]
  std::vector<std::vector<double>> clearance;   ///< asked of each of these at each sample, as in BodyDistance [m]
  std::vector<std::size_t> nearest_at;          ///< of each of these, the sample with the least left
  static constexpr std::size_t kMostPairs = 6;  ///< in `nearest`

  /// The sample at which the least is left of all. @pre there are samples
  [[nodiscard]] std::size_t worst() const;
};

/// @returns nothing in its lists where there are no pairs or no samples.
[[nodiscard]] DistancesAlong distances_along(const BodyDistances& distances, const Sampler& sampler,
                                             const std::vector<PathSample>& samples);

}  // namespace taut
