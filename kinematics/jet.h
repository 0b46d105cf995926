// SPDX-License-Identifier: GPL-3.0-or-later
// First-order jets: a value and its N partial derivatives, for forward differentiation of the equations.
#pragma once

#include <array>
#include <string>

#include "problem/scalar.h"

namespace taut {

template <class S, int N>
struct Jet {
  S value;
  std::array<S, N> partial;

  Jet() = default;
  explicit(false) Jet(const S& constant) : value(constant) { partial.fill(S(0.0)); }
  /// The k-th independent variable.
  Jet(const S& x, int k) : Jet(x) { partial[static_cast<std::size_t>(k)] = S(1.0); }

  /// f(a) given f and f'.
  static Jet chain(const Jet& a, const S& f, const S& df) {
    Jet r;
    r.value = f;
    for (std::size_t k = 0; k < N; ++k) r.partial[k] = df * a.partial[k];
    return r;
  }
  /// f(a, b) given f and its two partial derivatives.
  static Jet chain(const Jet& a, const Jet& b, const S& f, const S& dfa, const S& dfb) {
    Jet r;
    r.value = f;
    for (std::size_t k = 0; k < N; ++k) r.partial[k] = dfa * a.partial[k] + dfb * b.partial[k];
    return r;
  }

  friend Jet operator+(const Jet& a, const Jet& b) {
    return combine(a, b, [](auto& x, auto& y) { return x + y; });
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return combine(a, b, [](auto& x, auto& y) { return x - y; });
  }
  friend Jet operator-(const Jet& a) { return chain(a, -a.value, S(-1.0)); }
  friend Jet operator*(const Jet& a, const Jet& b) { return chain(a, b, a.value * b.value, b.value, a.value); }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const S quotient = a.value / b.value;
    return chain(a, b, quotient, S(1.0) / b.value, -(quotient / b.value));
  }
  friend Jet operator+(Jet a, const S& k) {
    a.value = a.value + k;
    return a;
  }
  friend Jet operator-(Jet a, const S& k) {
    a.value = a.value - k;
    return a;
  }
  friend Jet operator*(const Jet& a, const S& k) { return chain(a, a.value * k, k); }

  friend Jet sqr(const Jet& a) { return chain(a, a.value * a.value, a.value + a.value); }
  friend Jet sqrt(const Jet& a) {
    const S root = sqrt(a.value);
    return chain(a, root, S(0.5) / root);
  }
  // Where these have no derivative, one of those from either side (of a norm at 0: 0).
  friend Jet absolute(const Jet& a) { return certainly_positive(a.value) ? a : -a; }
  friend Jet larger(const Jet& a, const Jet& b) { return certainly_positive(a.value - b.value) ? a : b; }
  friend Jet euclidean_norm(const Jet& x, const Jet& y, const Jet& z) {
    Jet r(euclidean_norm(x.value, y.value, z.value));
    if (!certainly_positive(r.value)) return r;
    for (std::size_t k = 0; k < N; ++k) {
      r.partial[k] = (x.value * x.partial[k] + y.value * y.partial[k] + z.value * z.partial[k]) / r.value;
    }
    return r;
  }
  friend SinCos<Jet> sincos(const Jet& a) {
    const SinCos<S> sc = sincos(a.value);
    return {chain(a, sc.sin, sc.cos), chain(a, sc.cos, -sc.sin)};
  }
  friend Jet sin(const Jet& a) { return sincos(a).sin; }
  friend Jet cos(const Jet& a) { return sincos(a).cos; }
  friend Jet tan(const Jet& a) {
    const SinCos<Jet> sc = sincos(a);
    return sc.sin / sc.cos;
  }
  friend Jet exp(const Jet& a) {
    const S power = exp(a.value);
    return chain(a, power, power);
  }
  friend Jet log(const Jet& a) { return chain(a, log(a.value), S(1.0) / a.value); }
  friend Jet asin(const Jet& a) { return chain(a, asin(a.value), slope_of_asin(a.value)); }
  friend Jet acos(const Jet& a) { return chain(a, acos(a.value), -slope_of_asin(a.value)); }
  friend Jet atan(const Jet& a) { return chain(a, atan(a.value), S(1.0) / (S(1.0) + sqr(a.value))); }
  friend Jet atan2(const Jet& y, const Jet& x) {
    const S square = sqr(x.value) + sqr(y.value);
    return chain(y, x, atan2(y.value, x.value), x.value / square, -(y.value / square));
  }
  friend Jet pow_int(const Jet& a, int n) {
    if (n == 0) return Jet(S(1.0));
    return chain(a, pow_int(a.value, n), S(static_cast<double>(n)) * pow_int(a.value, n - 1));
  }

 private:
  static S slope_of_asin(const S& x) { return S(1.0) / sqrt((S(1.0) + x) * (S(1.0) - x)); }
  template <class F>
  static Jet combine(const Jet& a, const Jet& b, F f) {
    Jet r;
    r.value = f(a.value, b.value);
    for (std::size_t k = 0; k < N; ++k) r.partial[k] = f(a.partial[k], b.partial[k]);
    return r;
  }
};

template <class S, int N>
struct ScalarTraits<Jet<S, N>> {
  static Jet<S, N> from_decimal(const std::string& text) { return ScalarTraits<S>::from_decimal(text); }
  static Jet<S, N> pi() { return ScalarTraits<S>::pi(); }
};

}  // namespace taut
