// SPDX-License-Identifier: GPL-3.0-or-later
// Directed rounding: the one place where the floating-point environment is touched.
//
// Interval (interval.h) keeps (−lower, upper) in one register and is right only while this thread rounds upward.
// run_upward() sets that mode, calls a function that the compiler can neither inline nor move across the
// switch, and restores the caller's mode. The processor's sticky flags tell afterwards whether any operation inside
// was invalid, divided by zero or overflowed: Faults<Interval>. A proof that raised one is not a proof.
//
// Trusted: that vector arithmetic obeys MXCSR (IEEE 754). rounding_self_test() checks it at start-up, on SSE2 and on
// the level that certify/lanes uses; under valgrind, which ignores rounding modes, it fails.
#pragma once

#ifdef __FAST_MATH__
#error "taut proves with directed rounding: -ffast-math (or -Ofast) breaks it"
#endif

#include <immintrin.h>

#include <stdexcept>
#include <string>

namespace taut {

/// The machine can't be trusted to round as told; exit code 4.
class UntrustworthyMachine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Checks that additions, products, quotients and square roots round upward under run_upward(), that underflow is
/// gradual, and that the mode is restored. @throws UntrustworthyMachine naming the operation that failed.
void rounding_self_test();

/// Sticky faults of this thread since the last clear(): invalid operation, division by zero, overflow, or a
/// function left its domain.
template <class I>
struct Faults;

class Interval;

template <>
struct Faults<Interval> {
  static constexpr unsigned kInvalid = 0x01, kDivideByZero = 0x04, kOverflow = 0x08;
  static void clear() { _mm_setcsr(_mm_getcsr() & ~0x3Fu); }
  static bool raised() { return (_mm_getcsr() & (kInvalid | kDivideByZero | kOverflow)) != 0; }
  static void raise() { _mm_setcsr(_mm_getcsr() | kInvalid); }
};

namespace rounding_detail {

inline constexpr unsigned kNearest = 0x1F80;  ///< all exceptions masked, round to nearest, no flush to zero
inline constexpr unsigned kUpward = 0x1F80 | 0x4000;

class UpwardGuard {
 public:
  UpwardGuard() : saved_(_mm_getcsr()) { _mm_setcsr(kUpward); }
  ~UpwardGuard() { _mm_setcsr(saved_); }
  UpwardGuard(const UpwardGuard&) = delete;
  UpwardGuard& operator=(const UpwardGuard&) = delete;

 private:
  unsigned saved_;
};

// noipa: no inlining, no cloning, and no knowledge of what the body reads or writes, so that none of its
// arithmetic can move out of the guard's scope. Clang lacks noipa; noinline and the clobber do there.
#ifdef __clang__
#define TAUT_OPAQUE __attribute__((noinline, optnone))
#else
#define TAUT_OPAQUE __attribute__((noipa))
#endif

template <class F>
TAUT_OPAQUE void call_opaque(F* function) {
  asm volatile("" : "+r"(function) : : "memory");
  (*function)();
  asm volatile("" : : : "memory");
}

/// Round-to-nearest while in scope: for calls into MPFR and libm from within run_upward().
class NearestGuard {
 public:
  NearestGuard() : saved_(_mm_getcsr()) { _mm_setcsr(kNearest); }
  /// Restores the mode and keeps the flags that were set before.
  ~NearestGuard() { _mm_setcsr(saved_); }
  NearestGuard(const NearestGuard&) = delete;
  NearestGuard& operator=(const NearestGuard&) = delete;

 private:
  unsigned saved_;
};

}  // namespace rounding_detail

/// Calls `function` with this thread rounding upward and its fault flags clear; restores the caller's mode and flags.
/// Results must leave through memory that `function` captures by reference.
/// @returns whether no fault was raised; if false, the results mean nothing. The flags are read here, outside the
/// opaque call, because inside it the compiler may move arithmetic past the reading.
template <class F>
[[nodiscard]] bool run_upward(F&& function) {
  const rounding_detail::UpwardGuard guard;
  rounding_detail::call_opaque(&function);
  return !Faults<Interval>::raised();
}

}  // namespace taut
