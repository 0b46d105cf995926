// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of a box for all six cables at once: lengths and their derivatives, the inverse of D, densities,
// tensions.
//
// Claim.  Under run_upward(), on forms of a pose over a box of N variables (slope_form.h), each result encloses what
// box_proof.h says of a box, or kinematics/moving_load.h of lengths. It is what the templates there compute for
// Interval, operation by operation: of N = 1 all numbers are equal to theirs (tests/certify/lanes_test.cc).
//
// The same source is compiled for SSE2, AVX2 and AVX-512F (level_*.cc), and the processor decides at start which is
// used; results are the same, bit for bit (lanes.h). The environment variable TAUT_SIMD = sse2, avx2 or avx512 asks for
// no more than that level.
#pragma once

namespace taut::lanes {

inline constexpr int kCables = 6;
inline constexpr int kWidth = 8;  ///< numbers of a row in memory: six cables, and what fills a register

struct alignas(64) Row {
  double x[kWidth];
};
/// Six intervals.
struct IntervalRow {
  Row minus_lower, upper;
};
/// Six intervals with members of one sign each: [least, greatest], or minus that where sign < 0.
struct SignedRow {
  Row least, greatest, sign;
};
/// One interval.
struct Ends {
  double minus_lower, upper;
};

/// Centred forms over a box of N variables, for six cables.
template <int N>
struct FormRow {
  IntervalRow at_mid, slope[N], range;
};
/// One centred form.
template <int N>
struct Form {
  Ends at_mid, slope[N], range;
};

/// What is constant: anchors, wrench, load.
struct Machine {
  IntervalRow base[3];    ///< a_i
  SignedRow platform[3];  ///< b_i
  SignedRow arm[3];       ///< b_i − p_m
  bool is_arm_platform;   ///< p_m = 0
  bool has_ellipsoid;     ///< else root is not used
  bool is_ellipsoid_diagonal;
  Ends root[kCables][kCables];  ///< L
};

/// A pose over a box.
template <int N>
struct PoseForms {
  Form<N> p[3], r[3][3];
  double radius[N];  ///< r_k: of the box
};

/// A machine that is held by cable lengths: where its pose is sought (certify/motion/length_controlled_motion.h), for
/// |t − m| <= radius.
struct LengthControl {
  Ends p_mid[3], p_slope[3], p_range[3];  ///< p_ref
  /// R_ref(t) = r_mid + (t − m)(r_slope + (t − m) r_bend), and R_ref over T.
  Ends r_mid[3][3], r_slope[3][3], r_bend[3][3], r_range[3][3];
  double position, turn;                 ///< the tube, r_p and r_u
  IntervalRow length_mid, length_slope;  ///< L(m) and L'
  double radius;
};

/// How the platform moves by s, at a place or over a part (kinematics/moving_load.h).
struct PlatformRates {
  Ends p[3], p1[3], p2[3], p3[3];  ///< p and its derivatives
  Ends r[3][3];
  Ends w[3], w1[3], w2[3];
};
/// The derivatives of lengths by s.
struct LengthRates {
  IntervalRow first, second, third;
};

/// All that is known of a box. Matrices have one row of lanes for each column: entry (i, j) is row j, lane i.
template <int N>
struct Box {
  double radius[N];
  FormRow<N> length;
  IntervalRow d_mid[6], d_slope[N][6];  ///< D, entry (k, j): row k, lane j
  Row c[6];                             ///< C by columns
  IntervalRow a0[6], a1[N][6];          ///< C D(m), C S_k
  Row a1_size[N][6];                    ///< |A1_k|
  Row n0[6], n[6];                      ///< N of theory.md at m, and over the box
  Row q0[6], q[6];                      ///< bounds of |P − I| at m, and over the box
  FormRow<N> nominal, spread;           ///< λ_i, and |Z_i| of the ellipsoid
  unsigned enclosed;                    ///< bit i: what follows of cable i from K is enclosed; else the box is too wide
  FormRow<N> low, high;                 ///< the least and the greatest tension; not of items
};

/// The functions of one level. Each returns whether the forms hold; a fault is not in their results but in the
/// processor's flags or, where a form is not defined, in kFault.
enum class Outcome { kYes, kNo, kFault };

/// Farkas's test on the rows of C (map/cell_proof.h), for y row i of C: over K, y·w takes values from at most `least`
/// to at least `greatest`; and what balances it is in `sum`.
struct WorkRow {
  Row least, greatest;
  IntervalRow sum;
};

template <int N>
struct BoxKernel {
  /// Sets `length`, `d_mid`, `d_slope`. kFault where a length may be 0.
  Outcome (*enclose_geometry)(const Machine&, const PoseForms<N>&, Box<N>&);
  /// Sets what depends on C, but for q. kNo: no C.
  Outcome (*precondition)(Box<N>&);
  /// Sets q0 and q. kNo: not proved non-singular.
  Outcome (*bound_inverse)(Box<N>&);
  /// Sets the rest, for the nominal wrench.
  Outcome (*enclose_tensions)(const Machine&, const Ends (&wrench)[6], Box<N>&);
  /// For force densities λ_j in density[j]. @pre precondition()
  void (*compare_work)(const Machine&, const Ends (&wrench)[6], const Ends (&density)[6], const Box<N>&, WorkRow&);
};

/// The only zero z(t) of the equations of lengths with z in [−1, 1]^6, as ParametricKrawczyk encloses it; its lanes are
/// the six unknowns. kNo: not proved to be the only one, or to be there.
using FindPose = Outcome (*)(const Machine&, const LengthControl&, FormRow<1>& z);

/// Sets as many derivatives as are asked for; of `by_s`, third ones are read only for the third. kFault where a length
/// may be 0.
enum class Order { kSecond, kThird };
using DifferentiateLengths = Outcome (*)(const Machine&, const PlatformRates& by_s, Order, LengthRates&);

enum class Level { kSse2, kAvx2, kAvx512 };
[[nodiscard]] const char* name(Level level);

struct Kernels {
  Level level;
  BoxKernel<1> box;            ///< of segments
  BoxKernel<2> cell_of_two;    ///< of maps of two coordinates
  BoxKernel<3> cell_of_three;  ///< of three
  FindPose find_pose;
  DifferentiateLengths differentiate_lengths;
  /// Whether this level's sums, products, quotients and roots round upward in every lane. Under run_upward().
  /// @returns what does not, or null
  const char* (*failed_rounding)();
  void (*divide)(const Row& a, const Row& b, Row& quotient);
};

/// Those of the highest level that this processor has, or that TAUT_SIMD asks for. @throws InputError for any other
/// value of TAUT_SIMD, and where the processor lacks the level.
[[nodiscard]] const Kernels& kernels();
/// Those of a level; null where the processor lacks it.
[[nodiscard]] const Kernels* kernels_of(Level level);

}  // namespace taut::lanes
