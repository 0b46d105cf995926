// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/refutation.h"

#include <algorithm>

namespace taut::checker {
namespace {

void require_within(const std::array<mpq_class, 3>& x, const mpq_class& tolerance, const char* what) {
  if (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] > tolerance * tolerance) {
    throw Rejected(std::string("false: the witness's deviation is within the tolerance of ") + what);
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
  const Ball u = sqrt(Ball(mpq_class(by.turn[0] * by.turn[0] + by.turn[1] * by.turn[1] + by.turn[2] * by.turn[2])));
  const Ball angle = within.orientation.evaluate<MeanValueForm>({}).range() - Ball(2) * value(Function::kAtan, u);
  if (certainly_negative(angle)) throw Rejected("false: the witness's deviation is within the tolerance of the angle");
  if (!certainly_nonnegative(angle)) throw Undefined("whether the deviation's angle is within its tolerance");
  problem.tolerances.reset();
  return problem;
}

Frame at_end(const Frame& pose) {  // at u = 1
  const auto end = [](const MeanValueForm& f) { return MeanValueForm(f.at + f.slope); };
  Frame result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.p[i] = end(pose.p[i]);
    for (std::size_t j = 0; j < 3; ++j) result.R[i][j] = end(pose.R[i][j]);
  }
  return result;
}

/// Whether a pose is in the tube around a reference pose. @throws Undefined otherwise.
void require_in_tube(const Frame& pose, const Frame& reference, const PoseTube& tube) {
  // With R = R(v, 1) R_ref, Q = R R_ref' has Q - Q' = 4 [v] / (1 + |v|^2) and 1 + tr Q = 4 / (1 + |v|^2).
  Matrix3<MeanValueForm> transposed;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) transposed[i][j] = reference.R[j][i];
  }
  const Matrix3<MeanValueForm> Q = multiply(pose.R, transposed);
  const Ball trace = (Q[0][0] + Q[1][1] + Q[2][2]).range() + Ball(1);
  for (std::size_t i = 0; i < 3; ++i) {
    const Ball off = (pose.p[i] - reference.p[i]).range();
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const Ball v = (Q[k][j] - Q[j][k]).range() / trace;
    if (!certainly_positive(trace) || !is_within(off, plus_minus(Ball(tube.position))) ||
        !is_within(v, plus_minus(Ball(tube.turn)))) {
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
  Box begin;
  require_in_tube(stated.pose, reference_line(first.x, first.s, second.x, second.s, begin), first.tube);
  Frame pose;
  for (const Box& box : by.boxes) {
    pose = forward_kinematics(growing_deviation(machine, stated, by, box), box.near.value());
  }
  return at_end(pose);
}

/// Whether anchors or lengths deviate; else a length-controlled machine stays where it is.
bool moves_platform(const WitnessDeviation& by) {
  const auto is_zero = [](const mpq_class& x) { return x == 0; };
  const auto are_zero = [&](const auto& rows) {
    return std::ranges::all_of(rows, [&](const auto& row) { return std::ranges::all_of(row, is_zero); });
  };
  return !are_zero(by.base_anchors) || !are_zero(by.platform_anchors) ||
         !std::ranges::all_of(*by.cable_lengths, is_zero);
}

/// The geometry of the machine that the witness is about.
Geometry deviating_geometry(const Machine& machine, const Machine& deviant, const Geometry& stated,
                            const WitnessDeviation& by) {
  const bool uses_continuation = by.cable_lengths && moves_platform(by);
  Frame pose = uses_continuation ? deviated_pose(machine, stated, by) : stated.pose;
  Vector3<MeanValueForm> u;
  for (std::size_t c = 0; c < 3; ++c) {
    pose.p[c] += MeanValueForm(Ball(by.position[c]));
    u[c] = MeanValueForm(Ball(by.turn[c]));
  }
  pose.R = multiply(rotation({u[0], u[1], u[2], MeanValueForm(Ball(1))}), pose.R);
  return deviant.geometry(pose);
}

/// f0 - v, f0 + v, or d of the witness's cable.
Ball quantity(const Machine& machine, const Geometry& geometry, const Witness& witness) {
  const MeanValueForm& length = geometry.length[witness.cable];
  if (witness.kind == WitnessKind::kLengthMin || witness.kind == WitnessKind::kLengthMax) return length.range();
  const Tensions tensions = machine.tensions(Inverse(geometry.D));
  const MeanValueForm& tension_radius = tensions.tension_radius[witness.cable];
  const MeanValueForm& density = tensions.density[witness.cable];
  return (length * (witness.kind == WitnessKind::kTensionMin ? density - tension_radius : density + tension_radius))
      .range();
}

Box at_place(const PathPoint& place, Box how) {
  how.begin = how.end = place.s;
  return how;
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
  result.reference = reference_line(first.x, first.s, second.x, second.s, box);
  result.tube = first.tube;
  return result;
}

Ball determinant_at(const Machine& machine, const Problem& problem, const Path& path, const PathPoint& place,
                    const Box& how) {
  const Geometry geometry = commanded_geometry(machine, problem, path, place.segment, at_place(place, how));
  Matrix6<Ball> D;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) D[i][j] = geometry.D[i][j].at;
  }
  return determinant(D);
}

Ball witnessed_quantity(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness) {
  const Geometry stated =
      commanded_geometry(machine, problem, path, witness.at.segment, at_place(witness.at, witness.at_box));
  if (!witness.deviation) return quantity(machine, stated, witness);
  const Machine deviant(deviating(problem, *witness.deviation));
  return quantity(deviant, deviating_geometry(machine, deviant, stated, *witness.deviation), witness);
}

void confirm_violation(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness) {
  const Ball seen = witnessed_quantity(machine, problem, path, witness);
  for (const Ball& excess : {seen - Ball(witness.value_lower), Ball(witness.value_upper) - seen}) {
    if (certainly_negative(excess)) throw Rejected("false: the value of the witness");
    if (!certainly_nonnegative(excess)) throw Undefined("the value of the witness");
  }
}

}  // namespace taut::checker
