// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/box_proof.h"

#include "checker/kernel/deviation.h"
#include "checker/kernel/motion.h"

namespace taut::checker {

Bounds prove_box(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box) {
  const Geometry geometry = commanded_geometry(machine, problem, path, k, box);
  const Inverse inverse(geometry.D);  // J is non-singular on the box
  const Tensions tensions = machine.tensions(inverse);
  MarginLoss loss;
  if (machine.tolerances) {
    loss = margin_loss(machine, geometry, inverse, is_length_controlled(problem, path), box.parts, box.guesses);
  }
  std::optional<Bounds> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const MeanValueForm& length = geometry.length[i];
    // 2 v_i is the difference of the two extremes; so deviations change v_i by no more than half of what they change
    // these.
    const Ball largest_radius =
        magnitude((length * tensions.tension_radius[i]).range()) + half(loss.tension[i][0] + loss.tension[i][1]);
    for (const std::size_t side : {0, 1}) {
      const auto inside = [&](const MeanValueForm& quantity, const std::array<Ball, 2>& limits) {
        return side == 0 ? quantity - MeanValueForm(limits[0]) : MeanValueForm(limits[1]) - quantity;
      };
      const MeanValueForm extreme = length * (side == 0 ? tensions.density[i] - tensions.tension_radius[i]
                                                        : tensions.density[i] + tensions.tension_radius[i]);
      const Ball of_tension = lowest(inside(extreme, machine.tension_limits[i]).range() - loss.tension[i][side]);
      const Ball of_length = lowest(inside(length, machine.length_limits[i]).range() - loss.length[i]);
      // (f0 - f_lo) / v = 1 + (f0 - v - f_lo) / v; a negative margin may be divided by any v, as it is refused anyway.
      const Ball of_scale = lowest(Ball(1) + of_tension / largest_radius);
      if (!result) result = Bounds{of_tension, of_length, of_scale};
      result = Bounds{smaller(result->tension, of_tension), smaller(result->length, of_length),
                      smaller(result->wrench_scale, of_scale)};
    }
  }
  return *result;
}

}  // namespace taut::checker
