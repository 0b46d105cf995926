// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel's tests share: the robots as the kernel reads them, and numbers of 200 bits to hold its balls
// against, which come from MPFR by other equations than the kernel's (tests/soundness/machine.h).
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "checker/format/expression_parser.h"
#include "checker/format/parts.h"
#include "checker/kernel/errors.h"
#include "checker/kernel/motion.h"
#include "tests/soundness/machine.h"
#include "tests/support/checker_enclosing.h"
#include "tests/support/robots.h"

namespace taut::checker {

/// Bits of the BigFloats that the kernel is held against.
inline constexpr mpfr_prec_t kOracleBits = 200;

inline Problem to_kernel(taut::Problem problem) {
  problem.query.clear();  // of other parameters, where the space was replaced
  const Json json = to_json(problem);
  return read_problem(Cursor(json, "problem"));
}

/// Whether the ball may hold the value, which is known to about 1e-40 of what it is made of.
inline bool holds(const Ball& ball, const BigFloat& value, double error = 1e-40) {
  if (mpfr_number_p(value.get()) == 0) return false;
  const WorkingPrecision precision(4096);
  return arb_overlaps(ball.get(), plus_minus(exactly(value), Ball(error)).get()) != 0;
}
/// Whether the form may have the value at u.
inline bool holds(const MeanValueForm& form, double u, const BigFloat& value, double error = 1e-40) {
  const WorkingPrecision precision(4096);
  return holds(form.at + form.slope * Ball(u), value, error);
}

inline double width(const Ball& x) { return 2 * mag_get_d(arb_radref(x.get())); }
inline double approx(const Ball& x) { return arf_get_d(arb_midref(x.get()), ARF_RND_NEAR); }

inline std::string print(const Ball& x) {
  return testing::digits(lower_end(x)) + " to " + testing::digits(upper_end(x));
}

inline double uniform(std::mt19937_64& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

/// A box of so many 2^-depth; both ends exact.
inline Box dyadic_box(int begin, int end, int depth, int bits = 128) {
  Box box;
  box.begin = mpq_class(begin, 1 << depth);
  box.end = mpq_class(end, 1 << depth);
  box.begin.canonicalize();
  box.end.canonicalize();
  box.bits = bits;
  return box;
}

/// The place of u in the box.
inline BigFloat place(const Box& box, double u) {
  const auto big = [](const mpq_class& x) {
    BigFloat result;
    mpfr_set_q(result.get(), x.get_mpq_t(), MPFR_RNDN);
    return result;
  };
  return big((box.begin + box.end) / 2) + big((box.end - box.begin) / 2) * BigFloat(u);
}

/// u = -1, 1, 0 and then at random.
inline std::vector<double> samples(std::mt19937_64& random, int count) {
  std::vector<double> result = {-1, 1, 0};
  while (static_cast<int>(result.size()) < count) result.push_back(uniform(random, -1, 1));
  return result;
}

inline void expect_pose(const Frame& frame, double u, const campaign::RigidPose<BigFloat>& pose) {
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(holds(frame.p[i], u, pose.p[i])) << "p" << i << " at u = " << u;
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_TRUE(holds(frame.R[i][j], u, pose.r[i][j])) << "R" << i << j << " at " << u;
  }
}

/// z of motion.h: where a pose is in the tube around a reference.
inline std::vector<double> in_tube(const campaign::RigidPose<double>& pose,
                                   const campaign::RigidPose<double>& reference, const PoseTube& tube) {
  campaign::Rows<double> transposed;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) transposed[i][j] = reference.r[j][i];
  }
  const auto Q = multiply(pose.r, transposed);
  const double scale = tube.turn * (1 + Q[0][0] + Q[1][1] + Q[2][2]);
  std::vector<double> z;
  for (std::size_t c = 0; c < 3; ++c) z.push_back((pose.p[c] - reference.p[c]) / tube.position);
  z.insert(z.end(), {(Q[2][1] - Q[1][2]) / scale, (Q[0][2] - Q[2][0]) / scale, (Q[1][0] - Q[0][1]) / scale});
  return z;
}

inline Waypoint waypoint(std::vector<double> x) {
  std::vector<int> none(x.size(), 0);
  return {std::move(x), std::move(none), {}};
}

}  // namespace taut::checker
