// SPDX-License-Identifier: GPL-3.0-or-later
// The theorems in words. A certificate carries the text that belongs to its verdict, character by character, and
// whoever writes a certificate includes this header. docs/certificate-format.md repeats the texts.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace taut::checker {

inline constexpr const char* kProvedClaim =
    "For every s along the path, every machine, load and pose within the stated tolerances, and every wrench w in K: "
    "the force Jacobian J is non-singular, the unique f with J f = w satisfies f_lo,i < f_i < f_hi,i, and d_lo,i < d_i "
    "< d_hi,i, for all six cables i = 1..6. The path is given by its exact waypoints and interpolation law; robot, "
    "load, limits and tolerances are the exact numbers of the problem. Where the pose is implied by constraints or by "
    "the lengths of the cables, it is the only such pose in its tube, for every s. A length-controlled machine that "
    "deviates is at the pose to which its deviation leads as it grows from zero. The claim includes that these poses "
    "exist.";

/// Follows the claim of a verdict but "undecided", where the problem's load has items.
inline constexpr const char* kItemsClause =
    " K is the sum of the items that the problem's load states, and of its ellipsoid where it states one: the wrenches "
    "about the load point that are a sum of one wrench of each.";

/// Follows "proved", and the clause of items, where the path has a law in time.
inline constexpr const char* kMoveClause =
    " The path is a move: at each time t from 0 to the end of its law sigma the machine is commanded to be at the "
    "point s of segment k, counted from 0, with k + s = sigma(t). All that is claimed holds at each of these times,"
    " and there w - w_in takes the place of w in J f = w. w_in is the wrench about the load point that makes the "
    "load's weights move with the platform, the force m a and the moment r x m a + H' of each: a is the "
    "acceleration of its centre of gravity, r the vector from the load point to it, H' the rate of its angular "
    "momentum about it. The claim holds for every mass m and every centre of gravity of a weight that the problem "
    "allows; its mass is in that point or, where the problem states a box, fills the box evenly around it, with "
    "sides along the axes of the platform. Nothing else has inertia. A machine that deviates has the velocity and "
    "the acceleration of the platform's origin, and those of its rotation, that path and law command. The magnitude"
    " of what the problem limits in time is below each such limit: the speed and the acceleration of a length d_i, "
    "of the load point and of the rotation, as path and law command them of the machine as the problem states it; "
    "and as power, that speed of d_i times the f_i of the same time, for every machine, load and pose within the "
    "tolerances, every w and every w_in.";

/// Follows kMoveClause where the problem states a stopping time.
inline constexpr const char* kMayStopClause =
    " The move may be run slower, and be slowed down, stopped and started again at any place: all this holds, too, if "
    "sigma(tau(t)) takes the place of sigma(t), for every tau with a first derivative from 0 to 1 and a second one of "
    "magnitude up to one divided by the stopping time that the problem states.";

/// Follows all that, where the problem states rows.
inline constexpr const char* kRowsClause =
    " The lengths that are commanded may be those of a table: of rows from time 0 to the end of the law, of which "
    "neighbours are no farther apart in time than the stated step h, and which have lengths within e_i - a_i h^2 / 8 "
    "of the d_i that path and law command at their times of the machine as the problem states it, where e_i is the "
    "stated error of rows and a_i the stated limit of acceleration of d_i; and from row to row they run straight in "
    "time. They are at each time within e_i of the d_i of path and law. All that is claimed of each machine, load and "
    "pose within the tolerances holds, too, for every error of each length up to e_i. Of a length-controlled machine, "
    "it is added to what the tolerances allow. Any other deviates within its tolerances from the pose to which these "
    "errors lead as they grow from zero, where the machine as the problem states it has such lengths. Velocities and "
    "accelerations remain those of path and law: what a table's straight lengths accelerate beside that counts only "
    "as far as K contains its forces. If the move is run slower, so is the table.";

/// Follows "refuted", and the clause of items, where the path has a law in time.
inline constexpr const char* kMoveRefutedClause =
    " The path is a move: at each time t from 0 to the end of its law sigma the machine is commanded to be at the "
    "point s of segment k, counted from 0, with k + s = sigma(t). At every time at which it is at the witness's "
    "place of the path, w - w_in takes the place of w in J f = w, for some w and w_in of one load. w_in is the "
    "wrench about the load point that makes the load's weights move with the platform, the force m a and the moment"
    " r x m a + H' of each: a is the acceleration of its centre of gravity, r the vector from the load point to it,"
    " H' the rate of its angular momentum about it. A weight has a mass m and a centre of gravity that the problem "
    "allows; its mass is in that point or, where the problem states a box, fills the box evenly around it, with "
    "sides along the axes of the platform. Nothing else has inertia. Or, where the witness is of a speed or an "
    "acceleration, the magnitude of that of its length d_i, of the load point or of the rotation, as path and law "
    "command it, is not below the limit that the problem states for it, at every such time; where it is of power, "
    "that speed of d_i times f_i is not, for some w and w_in of one load. Where the machine deviates, it has the "
    "velocity and the acceleration of the platform's origin, and those of its rotation, that path and law command.";

/// Follows kMoveRefutedClause where the problem states a stopping time.
inline constexpr const char* kSlowedRefutedClause =
    " The move may be run slower: where the witness states a slowing, all this is about sigma(tau(t)) in place of "
    "sigma(t), at a time at which tau has the first and the second derivative that the witness states, between 0 and 1"
    " and plus or minus one divided by the stopping time that the problem states.";

/// Follows "refuted", and the clause of items, where the problem states limits in time and the path has no law.
inline constexpr const char* kAtRestClause =
    " The platform is at rest at the witness pose: the path has no law in time, and nothing is claimed of limits of "
    "speeds, accelerations and power.";

/// Follows "proved" where the problem states bodies, before kBodiesClause.
inline constexpr const char* kClearClause =
    " For every s along the path and every machine, load and pose within the stated tolerances, the two bodies of "
    "every "
    "checked pair are farther apart than the pair's clearance.";

/// Follows "refuted" where the problem states bodies, before kBodiesClause.
inline constexpr const char* kContactClause =
    " Or, where the witness is of kind contact, the two bodies of its pair, of the machine as the problem states it, "
    "are "
    "not farther apart at the witness pose than the pair's clearance. The claim of a proved path includes that those "
    "of every checked pair are, for every machine, load and pose within the tolerances.";

/// Then follows which pairs are checked: bodies_clause().
inline constexpr const char* kBodiesClause =
    " Obstacles do not move, and bodies of the platform move with it; their shapes are exactly as stated. The body of "
    "a "
    "cable is all points within half its diameter of the straight line between its anchors, but for what is nearer to "
    "an anchor than the stated free end; every cable of a checked pair is longer than its free ends together. As far "
    "as distances of bodies are concerned, anchors of cables that are stated at the same place and with the same "
    "tolerance "
    "are one point, which deviates as one.";

/// Follows kBodiesClause and what comes with it, where a body is a mesh.
inline constexpr const char* kMeshClause =
    " A mesh is made of the triangles, segments and points that the faces of its file have, the file being the one "
    "with the stated SHA-256. If each edge of its triangles belongs to exactly two of them, and each part of it that "
    "hangs together by edges has two sides, the points inside of it are part of the body, too: those about which the "
    "winding number of such a part is not 0. Else there is no inside.";

/// Follows all others, where the problem states contacts.
inline constexpr const char* kContactZonesClause =
    " While the origin of the platform, of the machine as the problem states it, is within the stated distance of the "
    "place of a contact of the problem, minus the contact's depth takes the place of the clearance of its pair, minus "
    "the greatest one where several contacts of the pair apply. The distance of two bodies that overlap is minus the "
    "length of the shortest translation of one of them after which they do not.";

/// Follows all others, where the problem states exit cones.
inline constexpr const char* kExitConesClause =
    " A cable and each exit cone that the problem states for it are a checked pair, too. Its distance is |d| sin(a - "
    "t), where d is the vector from the cable's anchor at the stated end to its other anchor, in W at the base and in "
    "P at the platform, t the angle between d and the stated axis, and a the stated half-angle, which is above 0 and "
    "below a right angle; its clearance is 0.";

/// The classes of pairs, in the order in which certificates count them.
inline constexpr std::array kPairClassNames = {"platform-obstacles", "cables-obstacles", "cables-cables",
                                               "cables-platform"};

/// @param checked  by class
inline std::string checked_classes(const std::array<bool, 4>& checked) {
  const auto list = [&](bool is_checked) {
    std::string names;
    for (std::size_t k = 0; k < checked.size(); ++k) {
      if (checked[k] == is_checked) names += (names.empty() ? "" : ", ") + std::string(kPairClassNames[k]);
    }
    return names.empty() ? std::string("none") : names;
  };
  return " Pairs that are checked: " + list(true) + ". Pairs that are not checked: " + list(false) + ".";
}

/// Follows the claim of "proved" or "refuted", and the clause of items, where the problem states bodies.
/// @param checked  by class
inline std::string bodies_clause(bool is_proved, const std::array<bool, 4>& checked) {
  return std::string(is_proved ? kClearClause : kContactClause) + kBodiesClause + checked_classes(checked);
}

/// Follows the claim of "no path", and the clause of items, where the problem states bodies.
/// @param checked  by class
inline std::string no_path_bodies_clause(const std::array<bool, 4>& checked) {
  return " What is more, a pose is feasible only if the two bodies of every checked pair are farther apart than the "
         "pair's clearance. Obstacles do not move, and bodies of the platform move with it; their shapes are exactly "
         "as stated. The body of a cable is all points within half its diameter of the straight line between its "
         "anchors, but for what is nearer to an anchor than the stated free end." +
         checked_classes(checked);
}

inline constexpr const char* kRefutedClaim =
    "The path is not wrench-feasible: at the witness pose of the path some wrench w in K needs a tension outside its "
    "open limits, or a cable length is outside its open limits, or the force Jacobian J is singular at some pose "
    "between the two witness poses. Where poses are implied by constraints or by the lengths of the cables, the motion "
    "of the path leads from its beginning to the witness pose. Robot and load are there as the problem states them, or "
    "they differ by the deviation that the witness states, which is within the tolerances. A machine that deviates is "
    "at the pose to which its deviation leads: if it is length-controlled, first as anchors and lengths deviate more "
    "and more, beginning with no deviation; then by the tracking error. Where stretches are listed, the claim of a "
    "proved path holds outside of them, and each stretch that has witnesses is violated at both of them; where poses "
    "are implied, the boxes and the witnesses of stretches are about the poses in the stated tubes around the "
    "reference, and it is not claimed that the motion from the beginning of the path reaches them.";

inline constexpr const char* kNoPathClaim =
    "No path exists from the first of the two stated waypoints of the query to the second: there is no continuous "
    "motion of the parameters within the space that leads from the one to the other, however fast and of whatever "
    "shape, of which every pose is feasible. A pose is feasible if every cable has d_lo,i < d_i < d_hi,i and, for "
    "every wrench w in K, some f with f_lo,i < f_i < f_hi,i for all six cables i = 1..6 has J f = w. The machine is "
    "exactly as stated, without deviations. So no path between these waypoints is feasible for every machine, load "
    "and pose within the tolerances, either; but some machine within them may have a path. The ends of ranges are "
    "walls. Values of a parameter without a range are one if they differ by whole turns, and where the space states a "
    "flip, values of phi, theta and sigma that are one orientation are one. Robot, load, limits and space are the "
    "exact numbers of the problem.";

inline constexpr const char* kUndecidedClaim =
    "Nothing is claimed. The path was neither proved nor refuted; this does not mean that it is unsafe.";

/// Of a certificate of legs, after their number: legs_proved_claim().
inline constexpr const char* kLegsProvedClaim =
    " legs, which follow one another in the order of the certificate. What the certificate of each leg claims of its "
    "path is proved, with the load and the bodies that the leg's own problem states; these may differ from leg to leg. "
    "Robot, limits, tolerances, gravity, load point, space, exit cones and limits in time are the same in all legs. "
    "Legs that state bodies state the same bodies of cables. A body that two legs state under one name is the same one "
    "in both, of the platform or an obstacle at one place, and clearances and contacts of any two such bodies are the "
    "same in both. The path of each leg but the first begins at the very pose at which the path of the one before it "
    "ends.";

/// Follows it where the legs are moves.
inline constexpr const char* kLegsOfMovesClause =
    " The platform, as path and law command it, is at rest at the beginning and at the end of every leg.";

/// Follows it where they are not.
inline constexpr const char* kLegsOfPathsClause =
    " The claim is about the poses of each leg, at which the platform is taken to be at rest.";

/// Ends it.
inline constexpr const char* kBetweenLegsClause =
    " Between two legs the platform is to rest at that pose. Nothing is claimed of how a load or a body is taken or "
    "put down there, of what the platform carries while that is done, or of how long it takes; nor that a body that "
    "one leg carries stands where the obstacles of another leg say.";

/// After the number of the leg, and that of all: legs_refuted_claim().
inline constexpr const char* kLegsRefutedClaim =
    " legs, counted from 1, is refuted: what its certificate claims is true. So it is not true that all legs can be "
    "run, each with its load, as the certificate states them. Nothing is claimed of the others beside what their own "
    "certificates claim.";

inline constexpr const char* kLegsUndecidedClaim =
    "Nothing is claimed of the legs together. Not all of them were proved, and none was refuted; this does not mean "
    "that they are unsafe. What each leg's own certificate claims is that alone.";

/// The whole text of a certificate of so many legs, all of which are proved.
inline std::string legs_proved_claim(std::size_t count, bool are_moves) {
  return "There are " + std::to_string(count) + kLegsProvedClaim +
         (are_moves ? kLegsOfMovesClause : kLegsOfPathsClause) + kBetweenLegsClause;
}

/// Likewise of one of which leg `refuted` is the first that is refuted. @param refuted  from 1
inline std::string legs_refuted_claim(std::size_t count, std::size_t refuted) {
  return "Leg " + std::to_string(refuted) + " of " + std::to_string(count) + kLegsRefutedClaim;
}

/// What the text of a claim depends on, beside the verdict.
struct ClaimSubject {
  bool has_items = false;                       ///< the load of the problem
  bool has_time = false;                        ///< the problem: limits in time
  bool is_move = false;                         ///< the path has a law in time
  bool may_stop = false;                        ///< the problem: a stopping time
  bool has_rows = false;                        ///< the problem: rows of a table
  std::optional<std::array<bool, 4>> checks{};  ///< where the problem has bodies: which classes of pairs are checked
  bool has_meshes = false, has_zones = false, has_exit_cones = false;  ///< the bodies; zones are `contacts`
};

/// The whole text of "proved" or "refuted".
inline std::string claim_text(bool is_proved, const ClaimSubject& of) {
  std::string claim = is_proved ? kProvedClaim : kRefutedClaim;
  if (of.has_items) claim += kItemsClause;
  if (of.is_move) {
    claim += is_proved ? kMoveClause : kMoveRefutedClause;
    if (of.may_stop) claim += is_proved ? kMayStopClause : kSlowedRefutedClause;
    if (of.has_rows && is_proved) claim += kRowsClause;
  } else if (of.has_time && !is_proved) {
    claim += kAtRestClause;
  }
  if (!of.checks) return claim;
  claim += bodies_clause(is_proved, *of.checks);
  if (of.has_meshes) claim += kMeshClause;
  if (of.has_zones) claim += kContactZonesClause;
  if (of.has_exit_cones) claim += kExitConesClause;
  return claim;
}

}  // namespace taut::checker
