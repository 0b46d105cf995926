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

/// In a move: what acts beside items and ellipsoid, inertia included. @throws Undefined where a limit in time may not
/// be kept.
std::optional<WrenchBeside> beside_in_time(const Machine& machine, const Problem& problem, const Path& path,
                                           std::size_t k, const Box& box) {
  if (!path.timing) return std::nullopt;
  const Moving at = moving(machine, problem, path, k, box);
  for (const RateMargin& margin : at.margins) {
    if (!certainly_positive(margin.value)) throw Undefined("a limit of speeds or accelerations may not be kept");
  }
  WrenchBeside result{machine.wrench, at.change_by_turn};
  for (std::size_t i = 0; i < 6; ++i) result.wrench[i] -= at.inertia[i];
  return result;
}

}  // namespace

Bounds prove_box(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box,
                 const Apart& apart, const std::optional<mpq_class>& enough) {
  const Geometry geometry = commanded_geometry(machine, problem, path, k, box);
  const Inverse inverse(geometry.D);  // J is non-singular on the box
  const std::optional<WrenchBeside> in_time = beside_in_time(machine, problem, path, k, box);
  const Tensions tensions = machine.tensions(geometry, inverse, in_time ? in_time->wrench : machine.wrench);
  MarginLoss loss;
  if (machine.tolerances) {
    loss = margin_loss(machine, geometry, inverse, is_length_controlled(problem, path), box.parts, box.guesses,
                       in_time ? &*in_time : nullptr);
  }
  std::optional<Bounds> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const MeanValueForm& length = geometry.length[i];
    for (const std::size_t side : {0, 1}) {
      const auto inside = [&](const MeanValueForm& quantity, const std::array<Ball, 2>& limits) {
        return side == 0 ? quantity - MeanValueForm(limits[0]) : MeanValueForm(limits[1]) - quantity;
      };
      const MeanValueForm extreme = length * tensions.extreme(i, side);
      const Ball of_tension = lowest(inside(extreme, machine.tension_limits[i]).range() - loss.tension[i][side]);
      const Ball of_length = lowest(inside(length, machine.length_limits[i]).range() - loss.length[i]);
      // (f0 - f_lo) / v = 1 + (f0 - v - f_lo) / v; a negative margin may be divided by any v, as it is refused anyway.
      // Where K is one wrench, v is 0, and no scale is too large.
      const Ball v = magnitude((length * tensions.radius[side][i]).range()) + loss.radius[i][side];
      const Ball of_scale = v.is_zero() ? Ball(kLargestScale) : lowest(Ball(1) + of_tension / v);
      if (!result) result = Bounds{of_tension, of_length, of_scale, {}, 0};
      result = Bounds{smaller(result->tension, of_tension),
                      smaller(result->length, of_length),
                      smaller(result->wrench_scale, of_scale),
                      {},
                      0};
    }
  }
  if (machine.bodies) add_clearance(machine, geometry, loss, path.directions, apart, enough, *result);
  return *result;
}

}  // namespace taut::checker
