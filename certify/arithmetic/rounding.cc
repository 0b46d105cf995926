// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/arithmetic/rounding.h"

#include <cmath>
#include <limits>

#include "certify/lanes/kernel.h"

namespace taut {
namespace {

// volatile: each operand is loaded and each result stored, so that the operation happens at run time.
struct Probe {
  volatile double one = 1.0;
  volatile double ten = 10.0;
  volatile double tiny = 1e-17;
  volatile double two = 2.0;
  volatile double third = 1.0 / 3.0;
  volatile double smallest = std::numeric_limits<double>::min();
};

double square_root(double x) { return _mm_cvtsd_f64(_mm_sqrt_sd(_mm_set_sd(x), _mm_set_sd(x))); }

/// `operation` as done by the vector instructions of a level.
std::string in_lanes(lanes::Level level, const char* operation) {
  return std::string(operation) + " (" + lanes::name(level) + ")";
}

}  // namespace

void rounding_self_test() {
  Probe p;
  std::string failed;
  const unsigned before = _mm_getcsr();
  const bool sound = run_upward([&] {
    const auto expect = [&](bool ok, const char* operation) {
      if (!ok && failed.empty()) failed = operation;
    };
    const double sum = p.one + p.tiny;
    const double minus_sum = -p.one - p.tiny;
    expect(sum > 1.0, "1 + 1e-17 rounded up exceeds 1");
    expect(minus_sum == -1.0, "-1 - 1e-17 rounded up is -1");
    const double quotient_up = p.one / p.ten;
    const double quotient_down = -(-p.one / p.ten);
    expect(quotient_up > quotient_down, "1 / 10 differs between the directions");
    const double product_up = p.third * p.third;
    const double product_down = -(-p.third * p.third);
    expect(product_up > product_down, "(1/3)^2 differs between the directions");
    const double root = square_root(p.two);
    const double root_error = std::fma(root, root, -2.0);
    expect(root_error > 0.0, "sqrt 2 is rounded up");
    const double subnormal = p.smallest / p.two;
    expect(subnormal > 0.0 && subnormal < p.smallest, "underflow is gradual");
    const __m128d packed = _mm_add_pd(_mm_set1_pd(p.one), _mm_set1_pd(p.tiny));
    expect(_mm_cvtsd_f64(packed) > 1.0, "packed 1 + 1e-17 rounded up exceeds 1");
  });
  const lanes::Kernels& kernels = lanes::kernels();
  const char* failed_lanes = nullptr;
  const bool lanes_sound = run_upward([&] { failed_lanes = kernels.failed_rounding(); });
  if (failed.empty() && failed_lanes != nullptr) failed = in_lanes(kernels.level, failed_lanes);
  if (failed.empty() && !lanes_sound) failed = in_lanes(kernels.level, "sound operations raise no fault");
  lanes::Row ones{}, zeros{}, quotients{};
  for (double& x : ones.x) x = 1.0;
  if (failed.empty() && run_upward([&] { kernels.divide(ones, zeros, quotients); })) {
    failed = in_lanes(kernels.level, "division by zero raises a fault");
  }
  if (failed.empty() && run_upward([&] { kernels.divide(zeros, zeros, quotients); })) {
    failed = in_lanes(kernels.level, "0 / 0 raises a fault");
  }
  volatile double zero = 0.0;
  volatile double quotient = 0.0;
  if (failed.empty() && !sound) failed = "sound operations raise no fault";
  if (failed.empty() && run_upward([&] { quotient = p.one / zero; })) failed = "division by zero raises a fault";
  if (failed.empty() && run_upward([&] { quotient = zero / zero; })) failed = "0 / 0 raises a fault";
  if (failed.empty() && (_mm_getcsr() & 0x6000u) != (before & 0x6000u)) failed = "the caller's mode is restored";
  if (!failed.empty()) {
    throw UntrustworthyMachine("rounding self-test failed: expected that " + failed +
                               ". This machine (or an emulator such as valgrind) does not round as told, so nothing "
                               "can be proved on it.");
  }
}

}  // namespace taut
