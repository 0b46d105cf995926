// SPDX-License-Identifier: GPL-3.0-or-later
// What each margin of a machine has at one pose, and what each uncertainty may take of it, to first order.
//
// Everything here is floating point: it guesses where and why a proof falls short, and proves nothing. Derivatives are
// those of the equations, by forward differentiation.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinematics/margin.h"
#include "kinematics/pose_conversion.h"
#include "problem/scaled.h"

namespace taut {

/// One margin at one pose.
struct MarginBudget {
  MarginId id{};
  double quantity = 0;                           ///< f0 [N] or d [m] of the nominal machine under w0
  double limit = 0;                              ///< [N] or [m]
  double nominal = 0;                            ///< the distance of `quantity` from the limit; negative beyond it
  std::array<double, kUncertaintyKinds> loss{};  ///< what each uncertainty may take of it, by UncertaintyKind; >= 0
  /// Parts of what kWrenchSet takes: of each item that deviates, with its name.
  std::vector<std::pair<std::string, double>> loss_by_item{};

  [[nodiscard]] double all_losses() const;
  /// What is left with all uncertainties.
  [[nodiscard]] double left() const { return nominal - all_losses(); }
  /// The largest factor of the uncertainty for which something is left, all others as stated: infinite where it takes
  /// nothing of a margin that is kept, 0 where no factor will do.
  [[nodiscard]] double share(const Uncertainty& uncertainty) const;
};

/// What a design can change: the parameters by which MarginGradient differentiates.
struct DesignParameter {
  enum class Kind {
    kBaseAnchor,      ///< `index` 0…5, `axis` 0…2 [m]
    kPlatformAnchor,  ///< likewise
    kLoadPoint,       ///< `axis` [m]
    kWrench,          ///< w0: `axis` 0…5 [N, N m]
    kWeight,          ///< w0 as a whole, as a factor [1]
    kMass,            ///< the middle of the mass of the load item `uncertainty.item`, whose range moves along [kg]
    kTensionLower,    ///< of cable `index` [N]
    kTensionUpper,
    kLengthLower,  ///< [m]
    kLengthUpper,
    kTolerance,  ///< the uncertainty `uncertainty`, as a factor of what is stated [1]
  };
  Kind kind = Kind::kBaseAnchor;
  std::size_t index = 0;
  std::size_t axis = 0;
  Uncertainty uncertainty{};
  bool operator==(const DesignParameter&) const = default;
};

/// d left() / d parameter of one margin.
struct Derivative {
  DesignParameter parameter;
  double value = 0;  ///< [N or m, per unit of the parameter]
};

/// A problem ready to be differentiated. Immutable.
class MarginDifferentiator {
 public:
  /// @param length_controlled  whether the cables' lengths decide where the platform is
  /// @throws InputError as make_model()
  MarginDifferentiator(const Problem& problem, bool length_controlled);
  ~MarginDifferentiator();
  MarginDifferentiator(const MarginDifferentiator&) = delete;
  MarginDifferentiator& operator=(const MarginDifferentiator&) = delete;

  /// All margins at a pose; of a singular pose nothing.
  /// @param inertial_wrench  what a load in motion takes of the tensions, as MoveSample has it
  [[nodiscard]] std::optional<std::array<MarginBudget, std::size_t{4} * kCables>> budgets(
      const RigidPose& pose, const Vector6<double>& inertial_wrench = Vector6<double>::Zero()) const;

  /// The derivatives of what is left of a margin at a pose, by every parameter that the case states: w0 and the
  /// load point where there is an ellipsoid, masses of items. What tolerances take is differentiated, too. The pose
  /// stays. @pre the pose is not singular
  [[nodiscard]] std::vector<Derivative> derivatives(const RigidPose& pose, MarginId margin) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace taut
