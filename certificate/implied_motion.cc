// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/implied_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "checker/kernel/motion.h"
#include "kinematics/pose_conversion.h"

namespace taut {
namespace {

using checker::Ball;
using checker::MeanValueForm;

double nearest_double(const Ball& x) { return arf_get_d(arb_midref(x.get()), ARF_RND_NEAR); }
double largest(const Ball& x) { return arf_get_d(arb_midref(magnitude(x).get()), ARF_RND_CEIL); }

/// A number with few digits that is not below x.
double short_above(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return std::ldexp(std::ceil(mantissa * 64) / 64, exponent);
}

/// Newton's method at u = 0, from y; nothing where it fails.
std::optional<std::vector<double>> newton(const checker::Equations& equations, std::vector<double> y) {
  constexpr int kMostSteps = 25;
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    checker::Vector6<Ball> at;
    checker::Vector6<MeanValueForm> curve;
    for (std::size_t i = 0; i < y.size(); ++i) {
      at[i] = Ball(y[i]);
      curve[i] = MeanValueForm(at[i]);
    }
    checker::Matrix6<Ball> G = equations.jacobian(at);
    for (std::size_t i = y.size(); i < 6; ++i) G[i][i] = Ball(1);
    const checker::Vector6<MeanValueForm> moved = multiply(approximate_inverse(G), equations.residual(curve));
    double size = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double by = nearest_double(moved[i].at);
      y[i] -= by;
      size = std::max(size, std::abs(by));
    }
    if (!(size < 1e3)) return std::nullopt;
    if (size == 0 || (size < 1e-9 && size > last / 2)) return y;  // what is left is rounding
    last = size;
  }
  return last < 1e-9 ? std::optional(y) : std::nullopt;
}

using EquationsOver = std::function<std::unique_ptr<checker::Equations>(const checker::Box&)>;

/// How far the zero may be from `near.at` + `near.slope` u over a box, with some slack for the proof.
double radius_around(const EquationsOver& equations_over, const checker::Box& box, const checker::NearZero& near) {
  constexpr double kSlack = 2.5;
  constexpr double kLeast = 0x1p-1000;
  double farthest = 0;
  const auto equations = equations_over(box);
  checker::Vector6<MeanValueForm> curve;
  checker::Vector6<Ball> range;
  for (std::size_t i = 0; i < near.at.size(); ++i) {
    curve[i] = {Ball(near.at[i]), Ball(near.slope[i])};
    range[i] = curve[i].range();
  }
  const checker::Contraction contraction(*equations, range);
  const checker::Vector6<MeanValueForm> off = multiply(contraction.A, equations->residual(curve));
  for (std::size_t i = 0; i < near.at.size(); ++i) farthest = std::max(farthest, largest(off[i].range()));
  return short_above(std::max(kSlack * farthest, kLeast));
}

/// Where the zero is over a box: close to a straight line in u, within a radius that should do.
std::optional<checker::NearZero> near_zero(const EquationsOver& equations_over, const checker::Box& box) {
  const auto zero_at = [&](const mpq_class& s, const std::optional<std::vector<double>>& start) {
    checker::Box place = box;
    place.begin = place.end = s;
    const auto equations = equations_over(place);
    return newton(*equations, start ? *start : std::vector<double>(equations->unknowns(), 0.0));
  };
  const auto middle = zero_at((box.begin + box.end) / 2, std::nullopt);
  if (!middle) return std::nullopt;
  checker::NearZero near;
  near.at = *middle;
  near.slope.assign(middle->size(), 0.0);
  for (int bits = 64; bits < box.bits; bits *= 2) ++near.narrowings;
  if (box.begin < box.end) {
    const auto first = zero_at(box.begin, middle);
    const auto last = zero_at(box.end, middle);
    if (!first || !last) return std::nullopt;
    for (std::size_t i = 0; i < near.at.size(); ++i) {
      near.slope[i] = ((*last)[i] - (*first)[i]) / 2;
      near.at[i] = ((*middle)[i] + ((*first)[i] + (*last)[i]) / 2) / 2;
    }
  }
  near.radius = radius_around(equations_over, box, near);
  return near;
}

}  // namespace

std::optional<checker::NearZero> find_motion(const checker::Machine& machine, const checker::Problem& problem,
                                             const checker::Path& path, std::size_t k, const checker::Box& box) {
  const auto equations = [&](const checker::Box& over) { return motion_equations(machine, problem, path, k, over); };
  try {
    const checker::WorkingPrecision precision(box.bits);
    return near_zero(equations, box);
  } catch (const checker::Undefined&) {
    return std::nullopt;
  }
}

namespace {

RigidPose rigid_pose(const checker::Frame& frame) {
  RigidPose result;
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) {
    result.p(i) = nearest_double(frame.p[static_cast<std::size_t>(i)].at);
    for (int j = 0; j < 3; ++j) {
      R(i, j) = nearest_double(frame.R[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].at);
    }
  }
  result.q = Eigen::Quaterniond(R).normalized();
  return result;
}

/// Follows a deviation as it grows, by floating point and the kernel in turn.
class Way {
 public:
  Way(const checker::Machine& machine, const checker::Geometry& stated, Model<double> model,
      checker::WitnessDeviation& by, int bits)
      : machine_(machine), stated_(stated), model_(std::move(model)), by_(by), bits_(bits) {}

  /// Fills in poses and boxes. @returns false where it does not come to tau = 1.
  bool follow() {
    constexpr int kMostStepHalvings = 8;
    RigidPose here = rigid_pose(stated_.pose);
    by_.poses = {inner_pose(0, here)};
    by_.boxes.clear();
    mpq_class tau = 0;
    int halvings = 0;
    while (tau < 1) {
      mpq_class next = tau + mpq_class(1, 1 << halvings);
      if (next > 1) next = 1;
      const std::optional<RigidPose> there = pose_at(next, here);
      if (there && show(tau, next, *there)) {
        tau = next;
        here = *there;
      } else if (++halvings > kMostStepHalvings) {
        return false;
      }
    }
    return show_end();
  }

 private:
  static checker::InnerPose inner_pose(const mpq_class& tau, const RigidPose& pose) {
    return {tau, pose_numbers(pose), {}};
  }

  std::optional<RigidPose> pose_at(const mpq_class& tau, const RigidPose& start) const {
    Model<double> model = model_;
    std::array<double, kCables> lengths{};
    const double part = tau.get_d();
    for (std::size_t i = 0; i < kCables; ++i) {
      lengths[i] = nearest_double(stated_.length[i].at) + part * (*by_.cable_lengths)[i].get_d();
      for (std::size_t c = 0; c < 3; ++c) {
        model.p_WA[i](static_cast<Eigen::Index>(c)) += part * by_.base_anchors[i][c].get_d();
        model.p_PB[i](static_cast<Eigen::Index>(c)) += part * by_.platform_anchors[i][c].get_d();
      }
    }
    std::optional<RigidPose> result = pose_of_lengths(model, lengths, start);
    if (result && result->q.dot(start.q) < 0) result->q.coeffs() = -result->q.coeffs();
    return result;
  }

  /// Adds one box from tau to `next`, in the widest of some tubes in which the kernel finds exactly one pose.
  bool show(const mpq_class& tau, const mpq_class& next, const RigidPose& there) {
    constexpr int kNarrowest = 34;
    by_.poses.push_back(inner_pose(next, there));
    for (int k = 3; k < kNarrowest; k += 2) {
      checker::PoseTube& tube = by_.poses[by_.poses.size() - 2].tube;
      tube.turn = std::ldexp(1.0, -k);
      tube.position = short_above(model_.characteristic_length) * tube.turn;
      if (add_box(tau, next)) return true;
    }
    by_.poses.pop_back();
    return false;
  }

  /// Adds a box at tau = 1 alone, where the pose is known best.
  bool show_end() {
    by_.poses.back().tube = by_.poses[by_.poses.size() - 2].tube;
    return add_box(1, 1);
  }

  bool add_box(const mpq_class& begin, const mpq_class& end) {
    checker::Box box;
    box.begin = begin;
    box.end = end;
    box.bits = bits_;
    const auto equations = [&](const checker::Box& over) {
      return motion_equations(growing_deviation(machine_, stated_, by_, over));
    };
    try {
      box.near = near_zero(equations, box);
      if (!box.near) return false;
      (void)forward_kinematics(growing_deviation(machine_, stated_, by_, box), *box.near);
    } catch (const checker::Undefined&) {
      return false;
    }
    by_.boxes.push_back(std::move(box));
    return true;
  }

  const checker::Machine& machine_;
  const checker::Geometry& stated_;
  Model<double> model_;
  checker::WitnessDeviation& by_;
  int bits_;
};

}  // namespace

bool find_way(const checker::Machine& machine, const checker::Geometry& stated, const Model<double>& model,
              checker::WitnessDeviation& deviation, int bits) {
  return Way(machine, stated, model, deviation, bits).follow();
}

}  // namespace taut
