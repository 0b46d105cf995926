// The theorems, in words. A certificate carries the text that belongs to its verdict, letter by letter; whoever writes
// one includes this header. docs/certificate-format.md repeats them.
#pragma once

namespace taut::checker {

inline constexpr const char* kProvedClaim =
    "For every s along the path, every machine, load and pose within the stated tolerances, and every wrench w in K: "
    "the "
    "force Jacobian J is non-singular, the unique f with J f = w satisfies f_lo,i < f_i < f_hi,i, and d_lo,i < d_i < "
    "d_hi,i, for all six cables i = 1..6. The path is given by its exact waypoints and interpolation law; robot, load, "
    "limits and tolerances are the exact numbers of the problem. Where the pose is only implied, by constraints or by "
    "the lengths of the cables, it is the one in its tube, exactly one for every s. A machine that holds its cables' "
    "lengths and deviates is at the pose to which its deviation leads as it grows from zero. That these poses exist is "
    "part of the claim.";

inline constexpr const char* kRefutedClaim =
    "The path is not wrench-feasible: at the witness pose of the path some wrench w in K needs a tension outside its "
    "open limits, or a cable length is outside its open limits, or the force Jacobian J is singular at some pose "
    "between the two witness poses. Robot and load are there as the problem states them, or differ by the deviation "
    "that the witness states, which is within the tolerances. The pose of a machine that deviates is the one to which "
    "its deviation leads: where it holds its cables' lengths, as anchors and lengths deviate more and more from "
    "nothing on; and then by the deviation in tracking. Where stretches are listed, the claim of a proved path holds "
    "outside of them, and each stretch that has witnesses is violated at both of them.";

inline constexpr const char* kUndecidedClaim =
    "Nothing is claimed. The path was neither proved nor refuted; this does not mean that it is unsafe.";

}  // namespace taut::checker
