// SPDX-License-Identifier: GPL-3.0-or-later
// How wide the interval arithmetics' results are: of each operation on points, in ulps of the exact result, against
// MPFR at 2100 bits. A correctly rounded operation gives 1 (or 0, where the result is exact).
//
// Usage: interval_widths; Markdown on stdout.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/checker_enclosing.h"
#include "tests/support/interval_operations.h"

namespace taut::testing {
namespace {

constexpr int kPoints = 4000;

struct Widths {
  double median = 0;
  double percentile = 0;  ///< 99 of 100 are at most this
  double largest = 0;
};

/// Of results of points, plainly sized ones: half of them in [-8, 8], half with any logarithm between those of 1e-6 and
/// 1e6.
template <class A, class Op>
Widths widths() {
  Operands operands(1);
  const auto point = [&] {
    double x = operands.coin(0.5) ? operands.uniform(-8, 8) : std::exp(operands.uniform(-13.8, 13.8));
    if (Op::kUnit && std::abs(x) > 1) x = 1 / x;
    return Operand{x, x};
  };
  std::vector<double> all;
  while (all.size() < kPoints) {
    const Operand a = point();
    const Operand b = Op::kOperands == 2 ? point() : a;
    if (!Op::defined(a, b)) continue;
    typename A::I result;
    if (!A::run([&] { result = Op::apply(A::make(a), A::make(b)); })) continue;  // exp of 1e6
    const PrecisionScope precision(kOracleBits);
    const Range range = Op::range(a, b);
    all.push_back(ulps_beyond(lower_end(result), range.lower, A::kBits) +
                  ulps_beyond(upper_end(result), range.upper, A::kBits));
  }
  std::ranges::sort(all);
  return {all[kPoints / 2], all[kPoints * 99 / 100], all.back()};
}

std::string shown(double ulps) {
  if (ulps == 0) return "0";
  return ulps < 100 ? fmt::format("{:.0f}", ulps) : fmt::format("{:.0e}", ulps);
}

template <class Op, class... As>
void print_row() {
  fmt::print("| {} |", Op::kName);
  const auto print = [](const Widths& w) {
    fmt::print(" {} · {} · {} |", shown(w.median), shown(w.percentile), shown(w.largest));
  };
  (print(widths<As, Op>()), ...);
  fmt::print("\n");
}

void run() {
  fmt::print(
      "# Widths of interval operations\n\n"
      "Widths of {} results each, for single points, in ulps of the exact result: median · 99th percentile · largest.\n"
      "The best is 0 where the result is exact, and 1 elsewhere. Half of the points are in [−8, 8], the others between "
      "1e-6\n"
      "and 1e6, logarithmically (for asin and acos: their reciprocals). Written by `bench/interval_widths.cc`;\n"
      "`tests/certify/interval_laws_test.cc` tests that each result contains the exact one. The twin of `Interval` is\n"
      "`BoostInterval<double>`; the numbers after the other names are bits.\n\n"
      "Sine and cosine of `Interval` are 4 ulps of 1 wide within [−8, 8], which is many ulps of the result near a "
      "zero.\n"
      "Beyond |x| = 8, an ulp of 2 π is lost with each turn.\n\n"
      "| | `Interval` | its twin | `MpInterval`, 128 | 512 | the checker's, 128 | 512 |\n"
      "|---|---|---|---|---|---|---|\n",
      kPoints);
  for_each_operation([]<class Op>() { print_row<Op, Fast, Twin, Mp128, Mp512, Checker<128>, Checker<512>>(); });
}

}  // namespace
}  // namespace taut::testing

int main() { taut::testing::run(); }
