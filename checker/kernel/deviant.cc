// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/deviant.h"

#include <algorithm>

namespace taut::checker {
namespace {

void require_within(const std::array<mpq_class, 3>& x, const mpq_class& tolerance, const char* what) {
  if (dot(x, x) > tolerance * tolerance) {
    throw Rejected(std::string("the witness's deviation of ") + what + " is larger than its tolerance");
  }
}

/// The problem of the machine that deviates. @throws Rejected unless the deviation is within the tolerances.
Problem deviating(Problem problem, const WitnessDeviation& by) {
  const ToleranceBounds within = problem.tolerances.value();
  for (std::size_t i = 0; i < kCables; ++i) {
    require_within(by.base_anchors[i], within.base_anchors[i], "a base anchor");
    require_within(by.platform_anchors[i], within.platform_anchors[i], "a platform anchor");
    if (by.cable_lengths) {
      require_within({(*by.cable_lengths)[i], 0, 0}, within.cable_length ? (*within.cable_length)[i] : mpq_class(0),
                     "a cable's length");
    }
    for (std::size_t c = 0; c < 3; ++c) {
      problem.base_anchors[i][c] += by.base_anchors[i][c];
      problem.platform_anchors[i][c] += by.platform_anchors[i][c];
    }
    problem.wrench[i] += by.wrench * within.wrench[i];
  }
  require_within(by.load_point, within.load_point, "the load point");
  require_within({by.wrench, 0, 0}, 1, "the wrench");
  require_within(by.position, within.position, "the position");
  for (std::size_t c = 0; c < 3; ++c) problem.load_point[c] += by.load_point[c];
  const Ball u = sqrt(Ball(dot(by.turn, by.turn)));
  const Ball angle = within.orientation.evaluate<MeanValueForm>({}).range() - Ball(2) * value(Function::kAtan, u);
  if (certainly_negative(angle))
    throw Rejected("the witness's deviation of the orientation is larger than its tolerance");
  if (!certainly_nonnegative(angle))
    throw Undefined("the witness's deviation of the orientation may be larger than its tolerance");
  problem.tolerances.reset();
  return problem;
}

/// Whether a pose is in the tube around a reference pose. @throws Undefined otherwise.
void require_in_tube(const Frame& pose, const Frame& reference, const PoseTube& tube) {
  // With R = R(v, 1) R_ref, Q = R R_ref' has Q - Q' = 4 [v] / (1 + |v|^2) and 1 + tr Q = 4 / (1 + |v|^2).
  const Matrix3<Ball> Q = range(multiply(pose.R, transposed(reference.R)));
  const Ball trace = Q[0][0] + Q[1][1] + Q[2][2] + Ball(1);
  if (!certainly_positive(trace))
    throw Undefined("the commanded pose may be half a turn from where the deviation begins");
  const Vector3<Ball> v = {Q[2][1] - Q[1][2], Q[0][2] - Q[2][0], Q[1][0] - Q[0][1]};
  const Vector3<Ball> off = range(pose.p - reference.p);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_within(off[i], plus_minus(Ball(tube.position))) || !is_within(v[i] / trace, plus_minus(Ball(tube.turn)))) {
      throw Undefined("the commanded pose may be outside the tube in which the deviation begins");
    }
  }
}

/// The poses between which the reference of a deviation's way is straight over the box.
std::pair<const InnerPose&, const InnerPose&> reference_ends(const WitnessDeviation& by, const Box& box) {
  auto next = std::ranges::upper_bound(by.poses, box.begin, {}, &InnerPose::s);
  if (next == by.poses.end()) --next;  // tau = 1
  return {*std::prev(next), *next};
}

/// The pose to which the deviation leads from `stated`, where the machine has the lengths there.
Frame deviated_pose(const Machine& machine, const Geometry& stated, const WitnessDeviation& by) {
  if (by.boxes.empty() || by.boxes.back().end != 1) throw Rejected("the deviation's way is not stated to its end");
  const auto& [first, second] = reference_ends(by, by.boxes.front());
  require_in_tube(stated.pose, reference_line(first, second, Box{}), first.tube);  // tau = 0
  Frame pose;
  for (const Box& box : by.boxes) {
    pose = forward_kinematics(growing_deviation(machine, stated, by, box), box.near.value());
  }
  const auto end = [](const MeanValueForm& f) { return MeanValueForm(f.at + f.slope); };  // tau = 1
  for (std::size_t i = 0; i < 3; ++i) {
    pose.p[i] = end(pose.p[i]);
    for (MeanValueForm& x : pose.R[i]) x = end(x);
  }
  return pose;
}

}  // namespace

LengthControlled growing_deviation(const Machine& machine, const Geometry& stated, const WitnessDeviation& by,
                                   const Box& box) {
  const auto growing = [&](const Ball& from, const mpq_class& by_tau) {
    const mpq_class mid = (box.begin + box.end) / 2 * by_tau;
    const mpq_class slope = (box.end - box.begin) / 2 * by_tau;
    return MeanValueForm(from + Ball(mid), Ball(slope));
  };
  LengthControlled result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.lengths[i] = growing(stated.length[i].range(), (*by.cable_lengths)[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      result.base[i][c] = growing(machine.base[i][c], by.base_anchors[i][c]);
      result.platform[i][c] = growing(machine.platform[i][c], by.platform_anchors[i][c]);
    }
  }
  const auto& [first, second] = reference_ends(by, box);
  result.reference = reference_line(first, second, box);
  result.tube = first.tube;
  return result;
}

Deviant deviant(const Machine& machine, const Problem& problem, const Geometry& stated, const WitnessDeviation& by) {
  const Machine other(deviating(problem, by));
  Frame pose = by.leads_away() ? deviated_pose(machine, stated, by) : stated.pose;
  Vector3<MeanValueForm> u;
  for (std::size_t c = 0; c < 3; ++c) {
    pose.p[c] += MeanValueForm(Ball(by.position[c]));
    u[c] = MeanValueForm(Ball(by.turn[c]));
  }
  pose.R = multiply(rotation({u[0], u[1], u[2], MeanValueForm(Ball(1))}), pose.R);
  return {other, other.geometry(pose)};
}

}  // namespace taut::checker
