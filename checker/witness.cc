// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/witness.h"

#include <algorithm>

#include "checker/kernel/moving.h"

namespace taut::checker {
namespace {

/// The least or the largest tension of the witness's cable.
/// @param beside  what acts beside the items and the ellipsoid's spread
Ball tension(const Machine& machine, const Geometry& geometry, const Witness& witness, const Vector6<Ball>& beside) {
  const Tensions tensions = machine.tensions(geometry, Inverse(geometry.D), beside);
  const std::size_t side = witness.kind == WitnessKind::kTensionMin ? 0 : 1;
  return (geometry.length[witness.cable] * tensions.extreme(witness.cable, side)).range();
}

/// The least or the largest tension, or the length, of the witness's cable.
Ball quantity(const Machine& machine, const Geometry& geometry, const Witness& witness, const Vector6<Ball>& beside) {
  const bool is_length = witness.kind == WitnessKind::kLengthMin || witness.kind == WitnessKind::kLengthMax;
  return is_length ? geometry.length[witness.cable].range() : tension(machine, geometry, witness, beside);
}

/// The same of a move, or a rate that has a limit, for every time at which the move is at the place.
Ball quantity_of_move(const Machine& machine, const Geometry& geometry, const Moving& moving, const Witness& witness) {
  const std::optional<RateKind> rate = rate_of(witness.kind);
  if (!rate) return quantity(machine, geometry, witness, moving.beside(machine));
  if (rate == RateKind::kWinchPower) {
    return tension(machine, geometry, witness, moving.beside(machine)) * moving.winch_speed[witness.cable];
  }
  const auto is_witnessed = [&](const RateMargin& of) { return of.kind == *rate && of.cable == witness.cable; };
  return std::ranges::find_if(moving.margins, is_witnessed)->rate;
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
  const Box there = at_place(witness.at, witness.at_box);
  const Geometry stated = commanded_geometry(machine, problem, path, witness.at.segment, there);
  if (path.timing) {
    if (witness.loads) throw Rejected("the witness of a move states loads");
    const std::optional<RateKind> rate = rate_of(witness.kind);
    if (rate && !problem.time.value().of(*rate, witness.cable)) {
      throw Rejected("the witness is of a limit that the problem does not state");
    }
    const std::size_t k = witness.at.segment;
    // That the move may be run slower as well does not help it.
    const std::optional<Slowing>& slowing = witness.slowing;
    if (!witness.deviation) {
      return quantity_of_move(machine, stated, moving(machine, problem, path, k, there, slowing), witness);
    }
    if (rate && rate != RateKind::kWinchPower) throw Rejected("the witness of a limit in time states a deviation");
    const Deviant deviates = deviant(machine, problem, stated, *witness.deviation);
    const Vector6<Ball> inertia = inertia_of_deviant(machine, problem, path, k, there, slowing, deviates.geometry.pose);
    Vector6<Ball> beside = deviates.machine.wrench;
    for (std::size_t c = 0; c < 6; ++c) beside[c] -= inertia[c];
    const Ball found = quantity(deviates.machine, deviates.geometry, witness, beside);
    if (!rate) return found;
    return found * moving(machine, problem, path, k, there, slowing).winch_speed[witness.cable];
  }
  if (rate_of(witness.kind)) throw Rejected("the witness is of a limit in time, and the path has no law");
  const auto quantity_at_rest = [&](const Machine& of, const Geometry& geometry) {
    return quantity(of, geometry, witness, of.wrench);
  };
  if (!witness.loads && !witness.deviation) return quantity_at_rest(machine, stated);
  const Problem loaded = witness.loads ? acting(problem, *witness.loads) : problem;
  if (!witness.deviation) return quantity_at_rest(Machine(loaded), stated);
  const Deviant deviates = deviant(machine, loaded, stated, *witness.deviation);
  return quantity_at_rest(deviates.machine, deviates.geometry);
}

void confirm_violation(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness) {
  const Ball seen = witnessed_quantity(machine, problem, path, witness);
  const std::optional<RateKind> rate = rate_of(witness.kind);
  const std::string what = rate ? "the rate" : "the tension or length";
  for (const Ball& excess : {seen - Ball(witness.value_lower), Ball(witness.value_upper) - seen}) {
    if (certainly_negative(excess)) throw Rejected(what + " at the witness is outside the stated bounds");
    if (!certainly_nonnegative(excess)) throw Undefined(what + " at the witness may be outside the stated bounds");
  }
  if (!rate) return;
  const Ball beyond = Ball(witness.value_lower) - rate_limit(problem, *rate, witness.cable);
  if (certainly_negative(beyond)) throw Rejected("the witness states a rate that may be below its limit");
  if (!certainly_nonnegative(beyond)) throw Undefined("the witness's rate may be below its limit");
}

Ball witnessed_depth(const Machine& machine, const Geometry& geometry, const Witness& witness) {
  if (!witness.around.empty()) return depth_around(machine, geometry, witness.pair, witness.around);
  if (!witness.inside) return contact_depth(machine, geometry, witness.pair, witness.weights, witness.elements);
  return depth_inside(machine, geometry, witness.pair, *witness.inside, witness.weights, witness.elements);
}

void confirm_contact(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness) {
  const Geometry geometry =
      commanded_geometry(machine, problem, path, witness.at.segment, at_place(witness.at, witness.at_box));
  const Ball depth = witnessed_depth(machine, geometry, witness);
  const bool are_around = !witness.around.empty();
  if (certainly_negative(depth)) {
    throw Rejected(are_around ? "the points show less depth than their pair may have"
                              : "the two points are farther apart than the clearance of their pair");
  }
  const Ball excess = depth - Ball(witness.depth);
  if (certainly_negative(excess)) {
    throw Rejected(are_around ? "the points show less than the stated depth"
                              : "the two points are nearer to each other by less than the stated depth");
  }
  if (!certainly_nonnegative(excess)) {
    throw Undefined(are_around ? "the points may show less than the stated depth"
                               : "the two points may be farther apart than the clearance of their pair, less the "
                                 "stated depth");
  }
}

}  // namespace taut::checker
