// SPDX-License-Identifier: GPL-3.0-or-later
// Six binary64 numbers at once, one for each cable: what is the same formula for all rows of D^-1.
//
// Under run_upward() every operation rounds upward, so that sums, products, quotients and roots of upper bounds that
// are not negative are upper bounds.
#pragma once

#include <immintrin.h>

#include <array>
#include <cstddef>

namespace taut {

class Six {
 public:
  Six() = default;  // uninitialised, as double
  explicit(false) Six(double x) : v_{_mm_set1_pd(x), _mm_set1_pd(x), _mm_set1_pd(x)} {}
  /// x(0) … x(5)
  template <class F>
  [[nodiscard]] static Six generate(const F& x) {
    return {_mm_set_pd(x(1), x(0)), _mm_set_pd(x(3), x(2)), _mm_set_pd(x(5), x(4))};
  }
  [[nodiscard]] std::array<double, 6> values() const {
    std::array<double, 6> result;
    for (std::size_t k = 0; k < 3; ++k) _mm_storeu_pd(&result[2 * k], v_[k]);
    return result;
  }

  friend Six operator+(const Six& a, const Six& b) {
    return {_mm_add_pd(a.v_[0], b.v_[0]), _mm_add_pd(a.v_[1], b.v_[1]), _mm_add_pd(a.v_[2], b.v_[2])};
  }
  friend Six operator-(const Six& a, const Six& b) {
    return {_mm_sub_pd(a.v_[0], b.v_[0]), _mm_sub_pd(a.v_[1], b.v_[1]), _mm_sub_pd(a.v_[2], b.v_[2])};
  }
  friend Six operator-(const Six& a) {
    const __m128d sign = _mm_set1_pd(-0.0);
    return {_mm_xor_pd(a.v_[0], sign), _mm_xor_pd(a.v_[1], sign), _mm_xor_pd(a.v_[2], sign)};
  }
  friend Six operator*(const Six& a, const Six& b) {
    return {_mm_mul_pd(a.v_[0], b.v_[0]), _mm_mul_pd(a.v_[1], b.v_[1]), _mm_mul_pd(a.v_[2], b.v_[2])};
  }
  friend Six operator/(const Six& a, const Six& b) {
    return {_mm_div_pd(a.v_[0], b.v_[0]), _mm_div_pd(a.v_[1], b.v_[1]), _mm_div_pd(a.v_[2], b.v_[2])};
  }
  Six& operator+=(const Six& b) { return *this = *this + b; }
  friend Six sqrt(const Six& a) { return {_mm_sqrt_pd(a.v_[0]), _mm_sqrt_pd(a.v_[1]), _mm_sqrt_pd(a.v_[2])}; }
  friend Six max(const Six& a, const Six& b) {
    return {_mm_max_pd(a.v_[0], b.v_[0]), _mm_max_pd(a.v_[1], b.v_[1]), _mm_max_pd(a.v_[2], b.v_[2])};
  }
  friend Six abs(const Six& a) { return max(a, -a); }
  /// a > b ? x : y, each by itself.
  friend Six if_greater(const Six& a, const Six& b, const Six& x, const Six& y) {
    Six result;
    for (std::size_t k = 0; k < 3; ++k) {
      const __m128d is_greater = _mm_cmpgt_pd(a.v_[k], b.v_[k]);
      result.v_[k] = _mm_or_pd(_mm_and_pd(is_greater, x.v_[k]), _mm_andnot_pd(is_greater, y.v_[k]));
    }
    return result;
  }

 private:
  Six(__m128d a, __m128d b, __m128d c) : v_{a, b, c} {}
  __m128d v_[3];
};

}  // namespace taut
