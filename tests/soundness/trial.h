// SPDX-License-Identifier: GPL-3.0-or-later
// Random trials: a robot, a segment of some law, and tolerances.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "certify/prover.h"
#include "kinematics/constraint_functions.h"
#include "tests/soundness/machine.h"

namespace taut::campaign {

using Random = std::mt19937_64;
using Vector = std::vector<BigFloat>;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline bool one_in(Random& random, std::uint64_t n) { return random() % n == 0; }

/// As the command line names them: straight, spline, implied, geodesic, cable-lengths.
enum class Law { kStraight, kSpline, kImplied, kGeodesic, kCableLengths };
inline constexpr std::array<const char*, 5> kLawNames = {"straight", "spline", "implied", "geodesic", "cable-lengths"};
inline constexpr std::size_t kLaws = kLawNames.size();

/// none; or one of these, the others being exact; or any number of them at once.
enum class ToleranceKind { kNone, kAnchors, kLoad, kTracking, kCables, kTogether };
inline constexpr std::array<const char*, 6> kToleranceNames = {"none",     "anchors", "load",
                                                               "tracking", "cables",  "together"};
inline constexpr std::size_t kToleranceKinds = kToleranceNames.size();

/// What the set of loads is: an ellipsoid, or a sum of items (with or without an ellipsoid).
enum class LoadKind { kEllipsoid, kItems };
inline constexpr std::array<const char*, 2> kLoadNames = {"ellipsoid", "items"};

/// Constraints and their gradients, written a second time.
struct OracleConstraints {
  std::function<Vector(const Vector&)> values;
  std::function<std::vector<Vector>(const Vector&)> gradients;
};

struct Trial {
  Problem problem;
  std::array<Waypoint, 4> controls;
  Law law = Law::kStraight;
  ToleranceKind tolerances = ToleranceKind::kNone;
  Interpolation interpolation = Interpolation::kStraight;
  double size = 1;              ///< of the robot [m]
  bool shares_anchors = false;  ///< of a random robot: some cables share anchors
  PoseTube pose_tube;
  std::vector<InnerPose> inner_poses;
  /// Under the law of cable lengths: made to mislead, not proposed as an audit does.
  bool has_bad_reference = false;
  /// Under the law of cable lengths: the way to the second row's lengths ends at a singular pose, so that no motion
  /// leads there.
  bool has_lost_row = false;
  std::optional<OracleConstraints> constraints;
  /// The pose's six coordinates, of the parameters.
  std::function<oracle::Big6(const Vector&)> pose;
  std::function<Six<double>(const std::vector<double>&)> pose_approx;

  /// Refers to this trial.
  [[nodiscard]] Segment curve() const {
    return {interpolation, {&controls[0], &controls[1], &controls[2], &controls[3]}, 0, pose_tube, inner_poses};
  }
  [[nodiscard]] bool is_held() const {
    return law == Law::kCableLengths || (problem.tolerances && problem.tolerances->cable_length_m);
  }
};

/// All but limits, pose tubes and inner poses. Within PrecisionScope(oracle::kBits).
[[nodiscard]] Trial make_trial(Random& random, std::optional<Law> law, std::optional<ToleranceKind> tolerances,
                               std::optional<LoadKind> loads, bool shares_anchors = false);

template <class S>
struct MachineAt {
  Machine<S> machine;
  RigidPose<S> pose;
};

/// What the machine does along a trial, in scalar S (double or BigFloat).
template <class S>
class Motion {
 public:
  explicit Motion(const Trial& trial);

  /// Where the path says that the platform is, the machine being as typed; under the law of lengths the reference.
  [[nodiscard]] RigidPose<S> reference(const S& s) const;
  /// The commanded pose, near the reference; nothing where Newton's method finds none.
  [[nodiscard]] std::optional<RigidPose<S>> commanded(const S& s, const Deviation& deviation) const;
  /// Where the machine as it is has its platform, tracking error included.
  [[nodiscard]] std::optional<RigidPose<S>> pose(const S& s, const Deviation& deviation) const;
  [[nodiscard]] std::optional<StaticsAt<S>> statics(const S& s, const Deviation& deviation) const;

  /// The machine of a witness, and where it has its platform. @pre is_within(witness)
  [[nodiscard]] std::optional<MachineAt<S>> witnessed(const S& s, const taut::Deviation& witness) const;
  /// Whether a witness keeps to the tolerances.
  [[nodiscard]] bool is_within(const taut::Deviation& witness) const;

  /// [m], deviation included.
  [[nodiscard]] Six<S> commanded_lengths(const S& s, const Deviation& deviation) const;
  [[nodiscard]] Machine<S> machine(const Deviation& deviation) const {
    return deviate(machine_, tolerances_, deviation);
  }

 private:
  const Trial& trial_;
  Machine<S> machine_;
  Tolerances<S> tolerances_;
  std::optional<ConstraintFunctions> constraints_;
};

}  // namespace taut::campaign
