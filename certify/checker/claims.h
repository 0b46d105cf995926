// The theorems, in words. A certificate carries the text that belongs to its verdict, letter by letter; whoever writes
// one includes this header. docs/certificate-format.md repeats them.
#pragma once

namespace taut::checker {

inline constexpr const char* kProvedClaim =
    "For every s along the path and every wrench w in K at gamma(s): the force Jacobian J is non-singular, the unique "
    "f with J f = w satisfies f_lo,i < f_i < f_hi,i, and d_lo,i < d_i < d_hi,i, for all six cables i = 1..6. Here "
    "gamma is the path given by its exact waypoints and interpolation law, and robot, load and limits are the exact "
    "decimals of the problem. Where the space has constraints, gamma(s) is the pose that fulfils them in the tube "
    "around "
    "that law's curve; that there is exactly one for every s is part of the claim.";

inline constexpr const char* kRefutedClaim =
    "The path is not wrench-feasible: at the witness pose of the path some wrench w in K needs a tension outside its "
    "open limits, or a cable length is outside its open limits, or the force Jacobian J is singular at some pose "
    "between the two witness poses.";

inline constexpr const char* kUndecidedClaim =
    "Nothing is claimed. The path was neither proved nor refuted; this does not mean that it is unsafe.";

}  // namespace taut::checker
