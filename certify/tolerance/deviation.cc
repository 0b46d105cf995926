// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/tolerance/deviation.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "certify/arithmetic/interval.h"
#include "certify/motion/length_controlled_motion.h"
#include "kinematics/quaternion.h"
#include "kinematics/statics.h"

namespace taut {
namespace {

/// A machine in binary64 that may be moved about.
struct Machine {
  Model<double> model;
  RigidPose pose;
  std::optional<std::array<double, kCables>> held = std::nullopt;  ///< the lengths that it holds, if it does

  /// To the pose that anchors and lengths lead to; nowhere, in NaNs, where none is found.
  void follow() {
    if (!held) return;
    const std::optional<RigidPose> found = pose_of_lengths(model, *held, pose);
    if (found) {
      pose = *found;
    } else {
      pose.p.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
};

/// How far inside its limit a margin is [N or m].
double margin_value(Machine machine, MarginId id) {
  Model<double>& model = machine.model;
  for (std::size_t i = 0; i < kCables; ++i) model.p_MB[i] = model.p_PB[i] - model.p_PM;
  return slack(model,
               limited_quantity(statics(model, machine.pose.p, Matrix3<double>(machine.pose.q.toRotationMatrix())), id),
               id);
}

using Move = std::function<void(Machine&, const Vector3<double>&)>;

/// Downhill by `size`; nowhere where nothing may move.
Vector3<double> downhill(const Machine& machine, MarginId id, double size, double step, const Move& move) {
  constexpr double kInside = 1 - 1e-9;  // far more than twelve digits may be off
  Vector3<double> slope = Vector3<double>::Zero();
  constexpr double kLeast = 1e-300;  // below, a billionth off it is not below it
  for (int k = 0; size > kLeast && k < 3; ++k) {
    const auto at = [&](double x) {
      Machine moved = machine;
      move(moved, x * Vector3<double>::Unit(k));
      return margin_value(std::move(moved), id);
    };
    slope(k) = at(step) - at(-step);
  }
  const double norm = slope.norm();
  if (!(norm > 0) || !std::isfinite(norm)) return Vector3<double>::Zero();
  return -slope / norm * (kInside * size);
}

DecimalText decimal(double x) { return fmt::format("{:.12g}", x + 0.0); }

std::array<DecimalText, 3> decimals(const Vector3<double>& x) { return {decimal(x(0)), decimal(x(1)), decimal(x(2))}; }

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

Vector3<MpInterval> vector(const std::array<DecimalText, 3>& text) {
  const auto number = [](const DecimalText& x) { return ScalarTraits<MpInterval>::from_decimal(x); };
  return {number(text[0]), number(text[1]), number(text[2])};
}

}  // namespace

std::optional<ProposedDeviation> worst_deviation(const TolerancesText& tolerances, const Model<double>& model,
                                                 const RigidPose& commanded, MarginId margin, bool length_controlled,
                                                 double part) {
  Machine machine{model, commanded};
  if (length_controlled) machine.held = cable_lengths(model, commanded);
  const double step = 1e-6 * model.characteristic_length;
  constexpr double kAngleStep = 1e-6;
  Machine worst = machine;
  const auto worsen = [&](double size, double by, const Move& move) {
    const Vector3<double> x = downhill(machine, margin, part * size, by, move);
    if (!x.isZero(0)) move(worst, x);
    return x;
  };
  Deviation result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.base_anchors_m[i] =
        decimals(worsen(number(tolerances.base_anchor_m[i]), step, [i](Machine& m, const Vector3<double>& x) {
          m.model.p_WA[i] += x;
          m.follow();
        }));
    result.platform_anchors_m[i] =
        decimals(worsen(number(tolerances.platform_anchor_m[i]), step, [i](Machine& m, const Vector3<double>& x) {
          m.model.p_PB[i] += x;
          m.follow();
        }));
  }
  if (length_controlled) {
    result.cable_lengths_m.emplace().fill("0");
    for (std::size_t i = 0; tolerances.cable_length_m && i < kCables; ++i) {
      // Along the first axis, which stands for the length.
      (*result.cable_lengths_m)[i] =
          decimal(worsen(number((*tolerances.cable_length_m)[i]), step, [i](Machine& m, const Vector3<double>& x) {
            (*m.held)[i] += x(0);
            m.follow();
          })(0));
    }
  }
  result.load_point_m = decimals(
      worsen(number(tolerances.load_point_m), step, [](Machine& m, const Vector3<double>& x) { m.model.p_PM += x; }));
  result.position_m = decimals(
      worsen(number(tolerances.position_m), step, [](Machine& m, const Vector3<double>& x) { m.pose.p += x; }));
  const Vector3<double> turn = worsen(
      evaluate_constant<double>(tolerances.orientation_rad), kAngleStep, [](Machine& m, const Vector3<double>& x) {
        m.pose.q = Eigen::Quaterniond(Eigen::AngleAxisd(x.norm(), x.normalized())) * m.pose.q;
      });
  result.turn = decimals(std::tan(0.5 * turn.norm()) * turn.normalized());
  const auto loaded = [&](double by) {
    Machine moved = worst;
    for (int k = 0; k < 6; ++k) moved.model.wrench(k) += by * number(tolerances.wrench[static_cast<std::size_t>(k)]);
    return margin_value(std::move(moved), margin);
  };
  result.wrench = decimal(loaded(part) < loaded(-part) ? part : -part);
  constexpr double kNothing = 1e-9;  // floating point may be off
  if (std::min(loaded(part), loaded(-part)) > kNothing * margin_value(std::move(machine), margin)) return std::nullopt;
  return ProposedDeviation{std::move(result), !worst.pose.p.hasNaN()};
}

namespace {

bool moves_held_platform(const Deviation& deviation) {
  if (!deviation.cable_lengths_m) return false;
  const auto is_zero = [](const DecimalText& x) { return x == "0"; };
  const auto are_zero = [&](const auto& rows) {
    return std::ranges::all_of(rows, [&](const auto& row) { return std::ranges::all_of(row, is_zero); });
  };
  return !are_zero(deviation.base_anchors_m) || !are_zero(deviation.platform_anchors_m) ||
         !std::ranges::all_of(*deviation.cable_lengths_m, is_zero);
}

/// Whether it is certainly within the tolerances, all of them.
bool is_within(const Deviation& deviation, const TolerancesText& tolerances) {
  using I = MpInterval;
  const auto exact = [](const DecimalText& x) { return ScalarTraits<I>::from_decimal(x); };
  const auto squared_norm = [](const Vector3<I>& x) { return I(sqr(x(0)) + sqr(x(1)) + sqr(x(2))); };
  const auto fits = [&](const std::array<DecimalText, 3>& x, const DecimalText& tolerance) {
    return certainly_nonpositive(I(squared_norm(vector(x)) - sqr(exact(tolerance))));
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!fits(deviation.base_anchors_m[i], tolerances.base_anchor_m[i])) return false;
    if (!fits(deviation.platform_anchors_m[i], tolerances.platform_anchor_m[i])) return false;
    if (!deviation.cable_lengths_m) continue;
    const DecimalText of_length = tolerances.cable_length_m ? (*tolerances.cable_length_m)[i] : "0";
    if (!fits({(*deviation.cable_lengths_m)[i], "0", "0"}, of_length)) return false;
  }
  const I angle = I(2.0) * atan(sqrt(squared_norm(vector(deviation.turn))));
  return fits(deviation.load_point_m, tolerances.load_point_m) && fits({deviation.wrench, "0", "0"}, "1") &&
         fits(deviation.position_m, tolerances.position_m) &&
         certainly_nonpositive(I(angle - evaluate_constant<I>(tolerances.orientation_rad)));
}

}  // namespace

MpInterval deviated_quantity(const Model<MpInterval>& model, const TolerancesText& tolerances,
                             const Vector3<MpInterval>& p_WP, const Matrix3<MpInterval>& r_WP,
                             const Deviation& deviation, MarginId margin, const InertiaAt& inertia) {
  using I = MpInterval;
  if (!is_within(deviation, tolerances)) {
    Faults<I>::raise();
    return I(0.0);
  }
  Model<I> deviated = model;
  deviated.p_PM += vector(deviation.load_point_m);
  for (std::size_t i = 0; i < kCables; ++i) {
    deviated.p_WA[i] += vector(deviation.base_anchors_m[i]);
    deviated.p_PB[i] += vector(deviation.platform_anchors_m[i]);
    deviated.p_MB[i] = deviated.p_PB[i] - deviated.p_PM;
  }
  const I load = ScalarTraits<I>::from_decimal(deviation.wrench);
  for (int k = 0; k < 6; ++k) {
    deviated.wrench(k) += load * ScalarTraits<I>::from_decimal(tolerances.wrench[static_cast<std::size_t>(k)]);
  }
  PoseEnclosure commanded{p_WP, r_WP};
  if (moves_held_platform(deviation)) {
    std::array<I, kCables> errors;
    for (std::size_t i = 0; i < kCables; ++i) {
      errors[i] = ScalarTraits<I>::from_decimal((*deviation.cable_lengths_m)[i]);
    }
    const auto led = deviated_pose(model, commanded, deviated, errors);
    if (!led) {
      Faults<I>::raise();
      return I(0.0);
    }
    commanded = *led;
  }
  const Vector3<I> u = vector(deviation.turn);
  const Matrix3<I> turn = rotation(Quaternion<I>{u(0), u(1), u(2), I(1.0)});
  Matrix3<I> r;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      r(i, j) =
          turn(i, 0) * commanded.r_WP(0, j) + turn(i, 1) * commanded.r_WP(1, j) + turn(i, 2) * commanded.r_WP(2, j);
    }
  }
  if (inertia) deviated.wrench -= inertia(r);
  const Statics<I> s = statics(deviated, Vector3<I>(commanded.p_WP + vector(deviation.position_m)), r);
  const bool is_of_length = margin.kind == MarginKind::kLengthMin || margin.kind == MarginKind::kLengthMax;
  if (!is_of_length && !s.regular) Faults<I>::raise();
  return limited_quantity(s, margin);
}

}  // namespace taut
