// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/witness.h"

#include <stdexcept>

namespace taut::checker {
namespace {

/// The least or the largest tension, or the length, of the witness's cable.
Ball quantity(const Machine& machine, const Geometry& geometry, const Witness& witness) {
  const MeanValueForm& length = geometry.length[witness.cable];
  if (witness.kind == WitnessKind::kLengthMin || witness.kind == WitnessKind::kLengthMax) return length.range();
  const Tensions tensions = machine.tensions(geometry, Inverse(geometry.D));
  return (length * tensions.extreme(witness.cable, witness.kind == WitnessKind::kTensionMin ? 0 : 1)).range();
}

Box at_place(const PathPoint& place, Box how) {
  how.begin = how.end = place.s;
  return how;
}

}  // namespace

Ball determinant_at(const Machine& machine, const Problem& problem, const Path& path, const PathPoint& place,
                    const Box& how) {
  const Geometry geometry = commanded_geometry(machine, problem, path, place.segment, at_place(place, how));
  return determinant(map(geometry.D, [](const MeanValueForm& f) { return f.range(); }));
}

Ball witnessed_quantity(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness) {
  if (path.timing) throw std::logic_error("a witness of a move, whose inertia is not known here");
  const Geometry stated =
      commanded_geometry(machine, problem, path, witness.at.segment, at_place(witness.at, witness.at_box));
  if (!witness.loads && !witness.deviation) return quantity(machine, stated, witness);
  const Problem loaded = witness.loads ? acting(problem, *witness.loads) : problem;
  if (!witness.deviation) return quantity(Machine(loaded), stated, witness);
  const Deviant deviates = deviant(machine, loaded, stated, *witness.deviation);
  return quantity(deviates.machine, deviates.geometry, witness);
}

void confirm_violation(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness) {
  const Ball seen = witnessed_quantity(machine, problem, path, witness);
  for (const Ball& excess : {seen - Ball(witness.value_lower), Ball(witness.value_upper) - seen}) {
    if (certainly_negative(excess)) throw Rejected("the tension or length at the witness is outside the stated bounds");
    if (!certainly_nonnegative(excess))
      throw Undefined("the tension or length at the witness may be outside the stated bounds");
  }
}

Ball witnessed_depth(const Machine& machine, const Geometry& geometry, const Witness& witness) {
  if (!witness.inside) return contact_depth(machine, geometry, witness.pair, witness.weights, witness.elements);
  return depth_inside(machine, geometry, witness.pair, *witness.inside, witness.weights, witness.elements);
}

void confirm_contact(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness) {
  const Geometry geometry =
      commanded_geometry(machine, problem, path, witness.at.segment, at_place(witness.at, witness.at_box));
  const Ball depth = witnessed_depth(machine, geometry, witness);
  if (certainly_negative(depth)) throw Rejected("the two points are farther apart than the clearance of their pair");
  const Ball excess = depth - Ball(witness.depth);
  if (certainly_negative(excess))
    throw Rejected("the two points are nearer to each other by less than the stated depth");
  if (!certainly_nonnegative(excess)) {
    throw Undefined("the two points may be farther apart than the clearance of their pair, less the stated depth");
  }
}

}  // namespace taut::checker
