// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/ball.h"

namespace taut::checker {
Ball value(Function f, const Ball& x) {
  switch (f) {
    case Function::kInverse: return Ball(1) / x;
    case Function::kSqrt: return sqrt(x);
    case Function::kSin: return Ball::by<arb_sin>(x);
    case Function::kCos: return Ball::by<arb_cos>(x);
    case Function::kExp: return Ball::by<arb_exp>(x);
    case Function::kLog: return Ball::by<arb_log>(x);
    case Function::kAsin: return Ball::by<arb_asin>(x);
    case Function::kAcos: return Ball::by<arb_acos>(x);
    case Function::kAtan: return Ball::by<arb_atan>(x);
  }
  throw std::logic_error("a function without a value");
}

Ball first_derivative(Function f, const Ball& x) {
  switch (f) {
    case Function::kInverse: return -(Ball(1) / sqr(x));
    case Function::kSqrt: return Ball(1) / (Ball(2) * sqrt(x));
    case Function::kSin: return Ball::by<arb_cos>(x);
    case Function::kCos: return -Ball::by<arb_sin>(x);
    case Function::kExp: return Ball::by<arb_exp>(x);
    case Function::kLog: return Ball(1) / x;
    case Function::kAsin: return Ball(1) / sqrt(Ball(1) - sqr(x));
    case Function::kAcos: return -(Ball(1) / sqrt(Ball(1) - sqr(x)));
    case Function::kAtan: return Ball(1) / (Ball(1) + sqr(x));
  }
  throw std::logic_error("a function without a derivative");
}

Ball second_derivative(Function f, const Ball& x) {
  switch (f) {
    case Function::kInverse: return Ball(2) / power(x, 3);
    case Function::kSqrt: return -(Ball(1) / (Ball(4) * x * sqrt(x)));
    case Function::kSin: return -Ball::by<arb_sin>(x);
    case Function::kCos: return -Ball::by<arb_cos>(x);
    case Function::kExp: return Ball::by<arb_exp>(x);
    case Function::kLog: return -(Ball(1) / sqr(x));
    case Function::kAsin:
    case Function::kAcos: {
      const Ball rest = Ball(1) - sqr(x);
      const Ball result = x / (rest * sqrt(rest));
      return f == Function::kAsin ? result : -result;
    }
    case Function::kAtan: return -(Ball(2) * x / sqr(Ball(1) + sqr(x)));
  }
  throw std::logic_error("a function without a second derivative");
}

Ball power(const Ball& x, int n) {
  if (n < 0) return Ball(1) / power(x, -n);
  return Ball::make([&](arb_ptr r) { arb_pow_ui(r, x.get(), static_cast<ulong>(n), Ball::bits()); });
}

}  // namespace taut::checker
