// SPDX-License-Identifier: GPL-3.0-or-later
// Whether six measured tensions can balance any load that was proved: the wrench that they take up, J f, against the
// set of all that it may be.
//
// At a pose of the robot as stated (axes of W, about the load point), with gauges that err by up to e,
//   J f ∈ T = (K − w_in) ⊕ J [−e, e]⁶ ⊕ D,
// where D holds what deviations change: of J f, as cables run elsewhere, and of K and w_in, as levers turn. Two balls,
// one of forces and one of moments, hold D; docs/monitor.md derives their radii. A direction y with
// y·J f > max over T of y·t proves that J f is outside, whichever way y was found; Gilbert's method looks for it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/pose_conversion.h"
#include "kinematics/rates_sampler.h"
#include "kinematics/time_law.h"
#include "problem/problem.h"

namespace taut {

/// How far a machine's numbers may be from the stated ones, in floating point [m, rad]; 0 where none are stated.
struct ToleranceNumbers {
  std::array<double, kCables> base_anchor{}, platform_anchor{};
  double position = 0, orientation = 0;
  double load_point = 0;
  Vector6<double> wrench = Vector6<double>::Zero();  ///< ŵ, by which the ellipsoid's centre may be off, either way
  std::optional<std::array<double, kCables>> cable_length;  ///< of a machine that is controlled by lengths
};
[[nodiscard]] ToleranceNumbers tolerance_numbers(const Problem& problem);

/// Which item's change explains a wrench best, and how much of it that takes.
struct LoadGuess {
  enum class Kind { kMass, kForce, kMoment };
  std::string item;
  Kind kind = Kind::kMass;
  double amount = 0;  ///< [kg, N, N m]; of masses negative where there seems to be less
};

struct WrenchVerdict {
  bool is_outside = false;
  double share = 0;     ///< of what is allowed in the direction that shows most; above 1 exactly where it is outside
  double residual = 0;  ///< how far it is from the nominal wrench in that direction; moments over reach() [N]
  double allowed = 0;   ///< how far it may be [N]
  std::optional<LoadGuess> guess;
};

class WrenchTest {
 public:
  /// @throws InputError as make_model()
  explicit WrenchTest(const Problem& problem);

  /// A pose near which the machine is.
  struct Place {
    RigidPose pose;              ///< of the robot as stated
    double position_off = 0;     ///< how far the real platform's origin may be from there [m]
    double turn_off = 0;         ///< and how far it may be turned from there [rad]
    std::vector<double> places;  ///< of a move: the likeliest place, and others between which it may be
    double commanded_turn = 0;   ///< how far the platform may be turned from the commanded pose [rad]
  };
  /// @param path  that of the problem; `timing` as proved, if it is a move
  [[nodiscard]] WrenchVerdict judge(const Path& path, const Place& place, const std::array<double, kCables>& tension,
                                    double tension_error) const;

  /// The length by which moments are divided where they are compared with forces [m].
  [[nodiscard]] double reach() const { return reach_; }

 private:
  /// By how much K may change for each rad by which the platform is turned [N, N m].
  struct TurnEffect {
    double force = 0, moment = 0;
  };
  /// w_in over some places of a move.
  struct Inertia {
    Vector6<double> middle = Vector6<double>::Zero(), half_width = Vector6<double>::Zero();
    double force = 0, moment = 0;                            ///< by which masses and centres of gravity may change it
    double force_turn = 0, moment_turn = 0;                  ///< for each rad of a turn
    Vector3<double> acceleration = Vector3<double>::Zero();  ///< of the load point, for guesses [m/s²]
  };
  struct Set;  // T
  [[nodiscard]] Inertia inertia_at(const Path& path, const std::vector<double>& places) const;
  [[nodiscard]] std::optional<LoadGuess> guess(const Vector6<double>& residual, const Matrix3<double>& r_WP,
                                               const Vector3<double>& acceleration) const;

  Model<double> model_;
  LoadText load_;
  ToleranceNumbers tolerances_;
  std::optional<RatesSampler> rates_;  ///< where the problem limits moves in time
  std::vector<MovingBody<double>> bodies_;
  std::vector<std::array<double, 2>> body_ranges_;  ///< half the range of each mass [kg], and ρ [m]
  double slowing_ = 0;                              ///< greatest |τ''| of a move that may be slowed down [1/s]
  bool may_stop_ = false;
  TurnEffect turn_effect_;
  double reach_ = 1;
};

}  // namespace taut
