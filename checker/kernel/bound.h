// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds: each stands for a number >= 0 that we do not know exactly, and is not below it. Sums, products and roots of
// bounds bound those of the numbers: all of these grow with their operands, and Arb rounds them up, to 30 bits.
#pragma once

#include <mag.h>

#include "checker/kernel/ball.h"

namespace taut::checker {

class Bound {
 public:
  Bound() { mag_init(x_); }
  /// Of the magnitude of every number in the ball.
  explicit Bound(const Ball& a) : Bound() { arb_get_mag(x_, a.get()); }
  Bound(const Bound& other) : Bound() { mag_set(x_, other.x_); }
  Bound(Bound&& other) noexcept : Bound() { mag_swap(x_, other.x_); }
  Bound& operator=(Bound other) noexcept {
    mag_swap(x_, other.x_);
    return *this;
  }
  ~Bound() { mag_clear(x_); }

  [[nodiscard]] mag_srcptr get() const { return x_; }
  /// It as a number, exactly.
  [[nodiscard]] Ball ball() const {
    return Ball::make([this](arb_ptr r) { arf_set_mag(arb_midref(r), x_); });
  }
  /// 2^n, exactly.
  [[nodiscard]] static Bound power_of_two(int n) {
    Bound result;
    mag_one(result.x_);
    mag_mul_2exp_si(result.x_, result.x_, n);
    return result;
  }

  friend Bound operator+(const Bound& a, const Bound& b) { return by<mag_add>(a, b); }
  friend Bound operator*(const Bound& a, const Bound& b) { return by<mag_mul>(a, b); }
  Bound& operator+=(const Bound& b) {
    mag_add(x_, x_, b.x_);
    return *this;
  }
  /// *this += a b
  Bound& add_product(const Bound& a, const Bound& b) {
    mag_addmul(x_, a.x_, b.x_);
    return *this;
  }
  /// Of the root of the sum of squares.
  friend Bound hypot(const Bound& a, const Bound& b) { return by<mag_hypot>(a, b); }
  friend Bound hypot(const Bound& a, const Bound& b, const Bound& c) { return hypot(hypot(a, b), c); }
  friend Bound smaller(const Bound& a, const Bound& b) { return a <= b ? a : b; }
  friend Bound larger(const Bound& a, const Bound& b) { return a <= b ? b : a; }
  friend bool operator<=(const Bound& a, const Bound& b) { return mag_cmp(a.x_, b.x_) <= 0; }

 private:
  template <auto kMag>
  [[nodiscard]] static Bound by(const Bound& a, const Bound& b) {
    Bound result;
    kMag(result.x_, a.x_, b.x_);
    return result;
  }

  mag_t x_;
};

/// a, widened by every number of a magnitude up to b.
inline Ball plus_minus(const Ball& a, const Bound& b) {
  return Ball::make([&](arb_ptr r) {
    arb_set(r, a.get());
    arb_add_error_mag(r, b.get());
  });
}

}  // namespace taut::checker
