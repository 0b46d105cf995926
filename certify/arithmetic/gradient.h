// SPDX-License-Identifier: GPL-3.0-or-later
// One slope for each of N variables: what SlopeForm (slope_form.h) has in place of a single slope over a box of N.
#pragma once

#include <array>
#include <cstddef>

namespace taut {

template <class I, std::size_t N>
struct Gradient {
  std::array<I, N> by;

  Gradient() = default;
  explicit Gradient(double x) { by.fill(I(x)); }

  I& operator[](std::size_t k) { return by[k]; }
  const I& operator[](std::size_t k) const { return by[k]; }

  friend Gradient operator+(const Gradient& a, const Gradient& b) {
    return make([&](std::size_t k) { return a[k] + b[k]; });
  }
  friend Gradient operator-(const Gradient& a, const Gradient& b) {
    return make([&](std::size_t k) { return a[k] - b[k]; });
  }
  friend Gradient operator-(const Gradient& a) {
    return make([&](std::size_t k) { return -a[k]; });
  }
  friend Gradient operator*(const Gradient& a, const I& x) {
    return make([&](std::size_t k) { return a[k] * x; });
  }
  friend Gradient operator*(const I& x, const Gradient& a) { return a * x; }
  friend Gradient operator/(const Gradient& a, const I& x) { return a * reciprocal(x); }
  /// Σ a_k b_k.
  friend I operator*(const Gradient& a, const Gradient& b) {
    I sum = a[0] * b[0];
    for (std::size_t k = 1; k < N; ++k) sum = sum + a[k] * b[k];
    return sum;
  }
  friend Gradient hull(const Gradient& a, const Gradient& b) {
    return make([&](std::size_t k) { return hull(a[k], b[k]); });
  }
  friend Gradient euclidean_norm(const Gradient& x, const Gradient& y, const Gradient& z) {
    return make([&](std::size_t k) { return euclidean_norm(x[k], y[k], z[k]); });
  }

 private:
  template <class F>
  static Gradient make(F f) {
    Gradient result;
    for (std::size_t k = 0; k < N; ++k) result.by[k] = f(k);
    return result;
  }
};

}  // namespace taut
