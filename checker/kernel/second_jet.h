// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of one variable s with their first two derivatives, for every s of a box.
//
// f, f' and f'' are each in a ball, whatever s is. Sums, products and F(f) follow the rules of calculus:
//     (f g)'' = f'' g + 2 f' g' + f g'',    F(f)' = F'(f) f',    F(f)'' = F''(f) f'^2 + F'(f) f''.
#pragma once

#include "checker/kernel/mean_value_form.h"

namespace taut::checker {

/// A box may be a point, where f' and f'' may be 0 of an f that is no constant; so constants are known as such. Only of
/// them may functions be taken where they have no derivatives, as sqrt at 0.
struct SecondJet {
  Ball value, first, second;

  SecondJet() = default;  ///< the constant 0
  explicit SecondJet(Ball constant) : value(std::move(constant)) {}
  SecondJet(Ball f, Ball f1, Ball f2)
      : value(std::move(f)), first(std::move(f1)), second(std::move(f2)), is_constant_(false) {}

  [[nodiscard]] bool is_constant() const { return is_constant_; }

 private:
  bool is_constant_ = true;
};

inline Ball range(const SecondJet& f) { return f.value; }

inline SecondJet operator+(const SecondJet& a, const SecondJet& b) {
  if (a.is_constant() && b.is_constant()) return SecondJet(a.value + b.value);
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
inline SecondJet operator-(const SecondJet& a, const SecondJet& b) {
  if (a.is_constant() && b.is_constant()) return SecondJet(a.value - b.value);
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}
inline SecondJet operator-(const SecondJet& a) {
  return a.is_constant() ? SecondJet(-a.value) : SecondJet(-a.value, -a.first, -a.second);
}
inline SecondJet operator*(const Ball& a, const SecondJet& b) {
  return b.is_constant() ? SecondJet(a * b.value) : SecondJet(a * b.value, a * b.first, a * b.second);
}
inline SecondJet operator*(const SecondJet& a, const Ball& b) { return b * a; }
inline SecondJet operator*(const SecondJet& a, const SecondJet& b) {
  if (a.is_constant()) return a.value * b;
  if (b.is_constant()) return b.value * a;
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + Ball(2) * (a.first * b.first) + a.value * b.second};
}

/// F(f) from F, F' and F'' on all values of f.
inline SecondJet chain(const SecondJet& f, const Ball& value, const Ball& first, const Ball& second) {
  return {value, first * f.first, second * sqr(f.first) + first * f.second};
}
inline SecondJet apply(Function F, const SecondJet& f) {
  if (f.is_constant()) return SecondJet(value(F, f.value));
  return chain(f, value(F, f.value), first_derivative(F, f.value), second_derivative(F, f.value));
}
inline SecondJet power(const SecondJet& f, int n) {
  if (n == 0) return SecondJet(Ball(1));
  if (n == 1) return f;
  if (f.is_constant()) return SecondJet(power(f.value, n));
  return chain(f, power(f.value, n), Ball(n) * power(f.value, n - 1), Ball(n) * Ball(n - 1) * power(f.value, n - 2));
}
inline SecondJet sqr(const SecondJet& f) { return power(f, 2); }
inline SecondJet operator/(const SecondJet& a, const SecondJet& b) { return a * apply(Function::kInverse, b); }

}  // namespace taut::checker
