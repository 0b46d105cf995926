// SPDX-License-Identifier: GPL-3.0-or-later
// A function of one variable with its first N derivatives, for forward differentiation of the equations.
//
// With x_k for the k-th derivative, (x y)_n = Σ_k C(n, k) x_k y_{n−k} (Leibniz); a quotient and a root are found from
// the products that they have to make, and a function f(x) with the derivative h(x) from f' = h x'. Every rule is an
// equation between derivatives at one place, so that of an enclosing scalar all is enclosed over a range of places.
#pragma once

#include <array>
#include <string>

#include "problem/scalar.h"

namespace taut {

template <class S, int N>
struct Taylor {
  static_assert(N >= 1 && N <= 3);
  std::array<S, N + 1> d;  ///< x, x', …

  Taylor() = default;
  explicit(false) Taylor(const S& constant) {
    d.fill(S(0.0));
    d[0] = constant;
  }
  explicit Taylor(std::array<S, N + 1> derivatives) : d(std::move(derivatives)) {}

  friend Taylor operator+(const Taylor& a, const Taylor& b) {
    Taylor r;
    for (std::size_t n = 0; n <= N; ++n) r.d[n] = a.d[n] + b.d[n];
    return r;
  }
  friend Taylor operator-(const Taylor& a, const Taylor& b) {
    Taylor r;
    for (std::size_t n = 0; n <= N; ++n) r.d[n] = a.d[n] - b.d[n];
    return r;
  }
  friend Taylor operator-(const Taylor& a) {
    Taylor r;
    for (std::size_t n = 0; n <= N; ++n) r.d[n] = -a.d[n];
    return r;
  }
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    Taylor r;
    for (std::size_t n = 0; n <= N; ++n) {
      r.d[n] = a.d[0] * b.d[n];
      for (std::size_t k = 1; k <= n; ++k) r.d[n] = r.d[n] + times(choose(n, k), a.d[k] * b.d[n - k]);
    }
    return r;
  }
  friend Taylor operator/(const Taylor& a, const Taylor& b) {
    Taylor r;
    for (std::size_t n = 0; n <= N; ++n) {
      r.d[n] = a.d[n];
      for (std::size_t k = 0; k < n; ++k) r.d[n] = r.d[n] - times(choose(n, k), r.d[k] * b.d[n - k]);
      r.d[n] = r.d[n] / b.d[0];
    }
    return r;
  }
  friend Taylor operator+(Taylor a, const S& k) {
    a.d[0] = a.d[0] + k;
    return a;
  }
  friend Taylor operator-(Taylor a, const S& k) {
    a.d[0] = a.d[0] - k;
    return a;
  }
  friend Taylor operator*(Taylor a, const S& k) {
    for (S& x : a.d) x = x * k;
    return a;
  }

  friend Taylor sqr(const Taylor& a) {
    Taylor r;
    r.d[0] = sqr(a.d[0]);
    for (std::size_t n = 1; n <= N; ++n) {  // each product twice, but for that of a number and itself
      r.d[n] = times(2, a.d[0] * a.d[n]);
      for (std::size_t k = 1; 2 * k < n; ++k) r.d[n] = r.d[n] + times(2 * choose(n, k), a.d[k] * a.d[n - k]);
      if (n % 2 == 0) r.d[n] = r.d[n] + times(choose(n, n / 2), sqr(a.d[n / 2]));
    }
    return r;
  }
  friend Taylor sqrt(const Taylor& a) {
    Taylor r;
    r.d[0] = sqrt(a.d[0]);
    const S twice = r.d[0] + r.d[0];
    for (std::size_t n = 1; n <= N; ++n) {
      r.d[n] = a.d[n];
      for (std::size_t k = 1; k < n; ++k) r.d[n] = r.d[n] - times(choose(n, k), r.d[k] * r.d[n - k]);
      r.d[n] = r.d[n] / twice;
    }
    return r;
  }
  friend SinCos<Taylor> sincos(const Taylor& a) {
    SinCos<Taylor> r;
    const SinCos<S> value = sincos(a.d[0]);
    r.sin.d[0] = value.sin;
    r.cos.d[0] = value.cos;
    for (std::size_t n = 1; n <= N; ++n) {
      r.sin.d[n] = chain(a, r.cos, n);
      r.cos.d[n] = -chain(a, r.sin, n);
    }
    return r;
  }
  friend Taylor sin(const Taylor& a) { return sincos(a).sin; }
  friend Taylor cos(const Taylor& a) { return sincos(a).cos; }
  friend Taylor tan(const Taylor& a) {
    const SinCos<Taylor> sc = sincos(a);
    return sc.sin / sc.cos;
  }
  friend Taylor exp(const Taylor& a) {
    Taylor r;
    r.d[0] = exp(a.d[0]);
    for (std::size_t n = 1; n <= N; ++n) r.d[n] = chain(a, r, n);
    return r;
  }
  friend Taylor log(const Taylor& a) { return with_derivative(a, log(a.d[0]), Taylor(S(1.0)) / a); }
  friend Taylor asin(const Taylor& a) { return with_derivative(a, asin(a.d[0]), derivative_of_asin(a)); }
  friend Taylor acos(const Taylor& a) { return with_derivative(a, acos(a.d[0]), -derivative_of_asin(a)); }
  friend Taylor atan(const Taylor& a) {
    return with_derivative(a, atan(a.d[0]), Taylor(S(1.0)) / (Taylor(S(1.0)) + sqr(a)));
  }
  friend Taylor atan2(const Taylor& y, const Taylor& x) {
    const Taylor square = sqr(x) + sqr(y), by_y = x / square, by_x = -(y / square);
    Taylor r;
    r.d[0] = atan2(y.d[0], x.d[0]);
    for (std::size_t n = 1; n <= N; ++n) r.d[n] = chain(y, by_y, n) + chain(x, by_x, n);
    return r;
  }
  friend Taylor pow_int(const Taylor& a, int n) {
    if (n == 0) return Taylor(S(1.0));
    if (n < 0) return Taylor(S(1.0)) / pow_int(a, -n);
    return with_derivative(a, pow_int(a.d[0], n), pow_int(a, n - 1) * S(static_cast<double>(n)));
  }

 private:
  /// C(n, k) for n <= 3.
  static constexpr int choose(std::size_t n, std::size_t k) { return k == 0 || k == n ? 1 : static_cast<int>(n); }
  static S times(int n, const S& x) { return n == 1 ? x : S(static_cast<double>(n)) * x; }
  /// The n-th derivative of an f with f' = h a'.
  static S chain(const Taylor& a, const Taylor& h, std::size_t n) {
    S sum = h.d[0] * a.d[n];
    for (std::size_t k = 1; k < n; ++k) sum = sum + times(choose(n - 1, k), h.d[k] * a.d[n - k]);
    return sum;
  }
  static Taylor with_derivative(const Taylor& a, const S& value, const Taylor& h) {
    Taylor r;
    r.d[0] = value;
    for (std::size_t n = 1; n <= N; ++n) r.d[n] = chain(a, h, n);
    return r;
  }
  static Taylor derivative_of_asin(const Taylor& a) {
    const Taylor one(S(1.0));
    return one / sqrt((one + a) * (one - a));
  }
};

template <class S, int N>
struct ScalarTraits<Taylor<S, N>> {
  static Taylor<S, N> from_decimal(const std::string& text) { return ScalarTraits<S>::from_decimal(text); }
  static Taylor<S, N> pi() { return ScalarTraits<S>::pi(); }
};

}  // namespace taut
