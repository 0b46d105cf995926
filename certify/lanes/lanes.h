// SPDX-License-Identifier: GPL-3.0-or-later
// Six binary64 numbers or intervals at once, one for each cable, on one level of the processor's vector instructions.
//
// A source file defines TAUT_LANES_LEVEL (2: SSE2, 3: AVX2, 5: AVX-512F), is compiled for that level, and includes
// this. Everything here is in an unnamed namespace: the linker merges functions of one name, and one that was compiled
// for AVX-512 must never be called on a processor that lacks it. For the same reason nothing of the standard library is
// used (tests/certify/lanes_symbols_test.py).
//
// Every level computes the same IEEE 754 operations on each lane, in the same order, and nothing is fused. So results
// are the same on all levels, bit for bit. Lanes beyond the sixth repeat the first one's numbers, so that they raise no
// fault of their own.
#pragma once

#include <immintrin.h>

#include "certify/lanes/kernel.h"

#ifdef __FAST_MATH__
#error "taut proves with directed rounding: -ffast-math (or -Ofast) breaks it"
#endif

#define TAUT_LANES_INLINE [[gnu::always_inline]] inline

namespace taut::lanes {
namespace {

#if TAUT_LANES_LEVEL == 5
#ifndef __clang__  // g++ 12 warns of its own _mm512_max_pd (GCC bug 105593)
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
using Native = __m512d;
using NativeMask = __mmask8;
constexpr int kParts = 1;
TAUT_LANES_INLINE Native load_native(const double* x) { return _mm512_load_pd(x); }
TAUT_LANES_INLINE void store_native(double* x, Native v) { _mm512_store_pd(x, v); }
TAUT_LANES_INLINE Native broadcast_native(double x) { return _mm512_set1_pd(x); }
TAUT_LANES_INLINE Native max_native(Native a, Native b) { return _mm512_max_pd(a, b); }
TAUT_LANES_INLINE Native min_native(Native a, Native b) { return _mm512_min_pd(a, b); }
TAUT_LANES_INLINE Native sqrt_native(Native a) { return _mm512_sqrt_pd(a); }
TAUT_LANES_INLINE Native below_native(Native a) {
  return _mm512_castsi512_pd(_mm512_sub_epi64(_mm512_castpd_si512(a), _mm512_set1_epi64(1)));
}
TAUT_LANES_INLINE NativeMask less_native(Native a, Native b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
TAUT_LANES_INLINE Native select_native(NativeMask m, Native a, Native b) { return _mm512_mask_blend_pd(m, b, a); }
TAUT_LANES_INLINE bool any_native(NativeMask m) { return m != 0; }
TAUT_LANES_INLINE bool all_native(NativeMask m) { return m == 0xFF; }
TAUT_LANES_INLINE NativeMask or_native(NativeMask a, NativeMask b) { return static_cast<NativeMask>(a | b); }
TAUT_LANES_INLINE unsigned bits_native(NativeMask m) { return m; }
#elif TAUT_LANES_LEVEL == 3
using Native = __m256d;
using NativeMask = __m256d;
constexpr int kParts = 2;
TAUT_LANES_INLINE Native load_native(const double* x) { return _mm256_load_pd(x); }
TAUT_LANES_INLINE void store_native(double* x, Native v) { _mm256_store_pd(x, v); }
TAUT_LANES_INLINE Native broadcast_native(double x) { return _mm256_set1_pd(x); }
TAUT_LANES_INLINE Native max_native(Native a, Native b) { return _mm256_max_pd(a, b); }
TAUT_LANES_INLINE Native min_native(Native a, Native b) { return _mm256_min_pd(a, b); }
TAUT_LANES_INLINE Native sqrt_native(Native a) { return _mm256_sqrt_pd(a); }
TAUT_LANES_INLINE Native below_native(Native a) {
  return _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_castpd_si256(a), _mm256_set1_epi64x(1)));
}
TAUT_LANES_INLINE NativeMask less_native(Native a, Native b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
TAUT_LANES_INLINE Native select_native(NativeMask m, Native a, Native b) { return _mm256_blendv_pd(b, a, m); }
TAUT_LANES_INLINE bool any_native(NativeMask m) { return _mm256_movemask_pd(m) != 0; }
TAUT_LANES_INLINE bool all_native(NativeMask m) { return _mm256_movemask_pd(m) == 0xF; }
TAUT_LANES_INLINE NativeMask or_native(NativeMask a, NativeMask b) { return _mm256_or_pd(a, b); }
TAUT_LANES_INLINE unsigned bits_native(NativeMask m) { return static_cast<unsigned>(_mm256_movemask_pd(m)); }
#elif TAUT_LANES_LEVEL == 2
using Native = __m128d;
using NativeMask = __m128d;
constexpr int kParts = 3;
TAUT_LANES_INLINE Native load_native(const double* x) { return _mm_load_pd(x); }
TAUT_LANES_INLINE void store_native(double* x, Native v) { _mm_store_pd(x, v); }
TAUT_LANES_INLINE Native broadcast_native(double x) { return _mm_set1_pd(x); }
TAUT_LANES_INLINE Native max_native(Native a, Native b) { return _mm_max_pd(a, b); }
TAUT_LANES_INLINE Native min_native(Native a, Native b) { return _mm_min_pd(a, b); }
TAUT_LANES_INLINE Native sqrt_native(Native a) { return _mm_sqrt_pd(a); }
TAUT_LANES_INLINE Native below_native(Native a) {
  return _mm_castsi128_pd(_mm_sub_epi64(_mm_castpd_si128(a), _mm_set1_epi64x(1)));
}
TAUT_LANES_INLINE NativeMask less_native(Native a, Native b) { return _mm_cmplt_pd(a, b); }
TAUT_LANES_INLINE Native select_native(NativeMask m, Native a, Native b) {
  return _mm_or_pd(_mm_and_pd(m, a), _mm_andnot_pd(m, b));
}
TAUT_LANES_INLINE bool any_native(NativeMask m) { return _mm_movemask_pd(m) != 0; }
TAUT_LANES_INLINE bool all_native(NativeMask m) { return _mm_movemask_pd(m) == 0x3; }
TAUT_LANES_INLINE NativeMask or_native(NativeMask a, NativeMask b) { return _mm_or_pd(a, b); }
TAUT_LANES_INLINE unsigned bits_native(NativeMask m) { return static_cast<unsigned>(_mm_movemask_pd(m)); }
#else
#error "TAUT_LANES_LEVEL: 2 (SSE2), 3 (AVX2) or 5 (AVX-512F)"
#endif

constexpr int kNative = sizeof(Native) / sizeof(double);  ///< lanes in one register

// ---- Numbers --------------------------------------------------------------------------------------------------------

struct Lanes {
  Native v[kParts];
};
struct Mask {
  NativeMask v[kParts];
};

TAUT_LANES_INLINE Lanes load(const Row& row) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = load_native(row.x + p * kNative);
  return r;
}
TAUT_LANES_INLINE void store(Row& row, const Lanes& a) {
  for (int p = 0; p < kParts; ++p) store_native(row.x + p * kNative, a.v[p]);
}
TAUT_LANES_INLINE Lanes broadcast(double x) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = broadcast_native(x);
  return r;
}
TAUT_LANES_INLINE Lanes operator+(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = a.v[p] + b.v[p];
  return r;
}
TAUT_LANES_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = a.v[p] - b.v[p];
  return r;
}
TAUT_LANES_INLINE Lanes operator-(const Lanes& a) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = -a.v[p];
  return r;
}
TAUT_LANES_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = a.v[p] * b.v[p];
  return r;
}
TAUT_LANES_INLINE Lanes operator/(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = a.v[p] / b.v[p];
  return r;
}
TAUT_LANES_INLINE Lanes max(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = max_native(a.v[p], b.v[p]);
  return r;
}
TAUT_LANES_INLINE Lanes min(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = min_native(a.v[p], b.v[p]);
  return r;
}
TAUT_LANES_INLINE Lanes sqrt(const Lanes& a) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = sqrt_native(a.v[p]);
  return r;
}
/// The next number below. @pre positive
TAUT_LANES_INLINE Lanes predecessor(const Lanes& a) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = below_native(a.v[p]);
  return r;
}
TAUT_LANES_INLINE Mask operator<(const Lanes& a, const Lanes& b) {
  Mask r;
  for (int p = 0; p < kParts; ++p) r.v[p] = less_native(a.v[p], b.v[p]);
  return r;
}
TAUT_LANES_INLINE Mask operator|(const Mask& a, const Mask& b) {
  Mask r;
  for (int p = 0; p < kParts; ++p) r.v[p] = or_native(a.v[p], b.v[p]);
  return r;
}
TAUT_LANES_INLINE Lanes select(const Mask& m, const Lanes& a, const Lanes& b) {
  Lanes r;
  for (int p = 0; p < kParts; ++p) r.v[p] = select_native(m.v[p], a.v[p], b.v[p]);
  return r;
}
TAUT_LANES_INLINE bool any(const Mask& m) {
  bool r = false;
  for (int p = 0; p < kParts; ++p) r = r || any_native(m.v[p]);
  return r;
}
TAUT_LANES_INLINE bool all(const Mask& m) {
  bool r = true;
  for (int p = 0; p < kParts; ++p) r = r && all_native(m.v[p]);
  return r;
}
TAUT_LANES_INLINE Lanes abs(const Lanes& a) { return max(a, -a); }
/// Bit i: lane i.
TAUT_LANES_INLINE unsigned bits(const Mask& m) {
  unsigned r = 0;
  for (int p = 0; p < kParts; ++p) r |= bits_native(m.v[p]) << (p * kNative);
  return r & 0x3F;
}

// ---- Intervals ------------------------------------------------------------------------------------------------------
//
// While rounding upward, as Interval (certify/arithmetic/interval.h): ends are kept as −lower and upper, so both are
// rounded outward.

struct Intervals {
  Lanes minus_lower, upper;
};

/// Numbers as factors: sizes and signs.
struct Factors {
  Lanes size;
  Mask negative;
};
/// Intervals as factors of which none has members of both signs: [least, greatest] or minus that.
struct SignedFactors {
  Lanes least, greatest;
  Mask negative;
};

TAUT_LANES_INLINE Intervals load(const IntervalRow& row) { return {load(row.minus_lower), load(row.upper)}; }
TAUT_LANES_INLINE void store(IntervalRow& row, const Intervals& a) {
  store(row.minus_lower, a.minus_lower);
  store(row.upper, a.upper);
}
TAUT_LANES_INLINE Intervals broadcast(const Ends& x) { return {broadcast(x.minus_lower), broadcast(x.upper)}; }
TAUT_LANES_INLINE SignedFactors load(const SignedRow& row) {
  return {load(row.least), load(row.greatest), load(row.sign) < broadcast(0.0)};
}
TAUT_LANES_INLINE Factors factors(const Lanes& x) { return {abs(x), x < broadcast(0.0)}; }

TAUT_LANES_INLINE Intervals operator+(const Intervals& a, const Intervals& b) {
  return {a.minus_lower + b.minus_lower, a.upper + b.upper};
}
TAUT_LANES_INLINE Intervals operator-(const Intervals& a, const Intervals& b) {
  return {a.minus_lower + b.upper, a.upper + b.minus_lower};
}
TAUT_LANES_INLINE Intervals operator-(const Intervals& a) { return {a.upper, a.minus_lower}; }
/// a ± radius
TAUT_LANES_INLINE Intervals widened(const Intervals& a, const Lanes& radius) {
  return {a.minus_lower + radius, a.upper + radius};
}
TAUT_LANES_INLINE Intervals operator*(const Intervals& a, const Intervals& b) {
  const Lanes na = a.minus_lower, nb = b.minus_lower;
  const Lanes lower = -na, minus_upper = -a.upper;
  return {max(max(na * b.upper, a.upper * nb), max(lower * nb, minus_upper * b.upper)),
          max(max(na * nb, a.upper * b.upper), max(lower * b.upper, minus_upper * nb))};
}
TAUT_LANES_INLINE Intervals operator*(const Factors& c, const Intervals& a) {
  return {c.size * select(c.negative, a.upper, a.minus_lower), c.size * select(c.negative, a.minus_lower, a.upper)};
}
/// For x <= y: of factors with one sign an end of the product is a product of the same end of `a`.
TAUT_LANES_INLINE Intervals operator*(const Intervals& a, const SignedFactors& b) {
  const Lanes n = select(b.negative, a.upper, a.minus_lower);
  const Lanes u = select(b.negative, a.minus_lower, a.upper);
  return {max(n * b.greatest, n * b.least), max(u * b.greatest, u * b.least)};
}
/// @pre b >= 0
TAUT_LANES_INLINE Intervals times_positive(const Intervals& a, const Intervals& b) {
  const Lanes least = -b.minus_lower;
  return {max(a.minus_lower * b.upper, a.minus_lower * least), max(a.upper * b.upper, a.upper * least)};
}
TAUT_LANES_INLINE Lanes magnitude(const Intervals& a) { return max(a.minus_lower, a.upper); }
TAUT_LANES_INLINE Lanes midpoint_approx(const Intervals& a) {
  return broadcast(0.5) * -a.minus_lower + broadcast(0.5) * a.upper;
}
TAUT_LANES_INLINE Intervals sqr(const Intervals& a) {
  const Lanes least = max(max(-a.minus_lower, -a.upper), broadcast(0.0));
  const Lanes most = magnitude(a);
  return {-least * least, most * most};
}
/// Invalid (a fault) where a member is negative.
TAUT_LANES_INLINE Intervals sqrt(const Intervals& a) {
  const Lanes lower = -a.minus_lower;
  const Lanes below = predecessor(sqrt(lower));
  const Lanes zero = broadcast(0.0);
  return {-select(zero < lower, below, zero), sqrt(a.upper)};
}
/// @pre a >= 0. Divides by zero (a fault) where a contains 0.
TAUT_LANES_INLINE Intervals reciprocal_of_positive(const Intervals& a) {
  return {broadcast(-1.0) / a.upper, broadcast(1.0) / -a.minus_lower};
}

}  // namespace
}  // namespace taut::lanes
