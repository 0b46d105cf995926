// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/box_proof.h"

#include <algorithm>

#include "checker/kernel/clearance.h"
#include "checker/kernel/deviation.h"
#include "checker/kernel/motion.h"
#include "checker/kernel/moving.h"

namespace taut::checker {
namespace {

constexpr int kLargestScale = 1'000'000;  ///< that is stated where there is none
constexpr int kFar = 1'000'000;           ///< likewise of a distance, where no pair is checked [m]

void add_clearance(const Machine& machine, const Geometry& geometry, const MarginLoss& loss,
                   const std::vector<Direction>& directions, const Apart& apart, const std::optional<mpq_class>& enough,
                   Bounds& to) {
  to.clearance = Ball(kFar);
  const std::optional<Ball> most = enough ? std::optional(highest(Ball(*enough))) : std::nullopt;
  const std::vector<Ball> margins = clearance_margins(machine, geometry, loss, directions, apart, most);
  for (std::size_t k = 0; k < margins.size(); ++k) {
    if (&smaller(*to.clearance, margins[k]) != &margins[k]) continue;
    to.clearance = margins[k];
    to.closest_pair = k;
  }
}

struct InTime {
  Moving moving;
  WrenchBeside beside;
};

InTime in_time(const Machine& machine, Moving at) {
  WrenchBeside beside{at.beside(machine), at.change_by_turn};
  return {std::move(at), std::move(beside)};
}

/// @param greatest  the tension of cable i, for every load and deviation, or more
void require_power(const Problem& problem, const Moving& at, std::size_t i, const Ball& greatest) {
  if (!problem.time->winch_power[i]) return;
  const Ball power = magnitude(greatest) * magnitude(at.winch_speed[i]);
  if (certainly_positive(rate_limit(problem, RateKind::kWinchPower, i) - power)) return;
  throw Undefined("a limit of a winch's power may not be kept");
}

/// Where the machine is over a box.
struct Place {
  const Machine& machine;
  const Problem& problem;
  const Path& path;
  const Box& box;
  const Geometry& geometry;
  const Inverse& inverse;
};

/// @param move  null: at rest
MarginLoss loss_to_deviations(const Place& at, const InTime* move) {
  if (!at.machine.tolerances) return {};
  return margin_loss(at.machine, at.geometry, at.inverse, is_length_controlled(at.problem, at.path), at.box.parts,
                     at.box.guesses, move == nullptr ? nullptr : &move->beside);
}

/// The bounds of tensions and lengths, at rest or at one speed.
Bounds bounds_at(const Place& at, const InTime* move, const MarginLoss& loss) {
  const Machine& machine = at.machine;
  const Tensions tensions =
      machine.tensions(at.geometry, at.inverse, move == nullptr ? machine.wrench : move->beside.wrench);
  std::optional<Bounds> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const MeanValueForm& length = at.geometry.length[i];
    for (const std::size_t side : {0, 1}) {
      const auto inside = [&](const MeanValueForm& quantity, const std::array<Ball, 2>& limits) {
        return side == 0 ? quantity - MeanValueForm(limits[0]) : MeanValueForm(limits[1]) - quantity;
      };
      const MeanValueForm extreme = length * tensions.extreme(i, side);
      if (move != nullptr && side == 1) {
        require_power(at.problem, move->moving, i, highest(extreme.range() + loss.tension[i][side]));
      }
      const Ball of_tension = lowest(inside(extreme, machine.tension_limits[i]).range() - loss.tension[i][side]);
      const Ball of_length = lowest(inside(length, machine.length_limits[i]).range() - loss.length[i]);
      // (f0 - f_lo) / v = 1 + (f0 - v - f_lo) / v; a negative margin may be divided by any v, as it is refused anyway.
      // Where K is one wrench, v is 0, and no scale is too large. In a move K may not grow: its weights have inertia.
      const Ball v = magnitude((length * tensions.radius[side][i]).range()) + loss.radius[i][side];
      const Ball of_scale = move != nullptr ? Ball(1)
                            : v.is_zero()   ? Ball(kLargestScale)
                                            : lowest(Ball(1) + of_tension / v);
      if (!result) result = Bounds{of_tension, of_length, of_scale, {}, 0};
      result = Bounds{smaller(result->tension, of_tension),
                      smaller(result->length, of_length),
                      smaller(result->wrench_scale, of_scale),
                      {},
                      0};
    }
  }
  return *result;
}

}  // namespace

Bounds prove_box(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box,
                 const Apart& apart, const std::optional<mpq_class>& enough) {
  const Geometry geometry = commanded_geometry(machine, problem, path, k, box);
  const Inverse inverse(geometry.D);  // J is non-singular on the box
  const Place at{machine, problem, path, box, geometry, inverse};
  MarginLoss loss;
  std::optional<Bounds> result;
  if (!path.timing) {
    loss = loss_to_deviations(at, nullptr);
    result = bounds_at(at, nullptr, loss);
  } else {
    for (Moving& at_corner : moving_within_limits(machine, problem, path, k, box)) {
      const InTime move = in_time(machine, std::move(at_corner));
      loss = loss_to_deviations(at, &move);
      const Bounds here = bounds_at(at, &move, loss);
      if (!result) result = here;
      result = Bounds{smaller(result->tension, here.tension), here.length, here.wrench_scale, {}, 0};
    }
  }
  if (machine.bodies) add_clearance(machine, geometry, loss, path.directions, apart, enough, *result);
  return *result;
}

}  // namespace taut::checker
