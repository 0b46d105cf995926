// A real function of one variable u in [-1, 1], enclosed to first order.
//
// A Form says of a function f, continuously differentiable on [-1, 1]:
//     f(0) is in mid,   f'(u) is in slope for every u,   f(u) is in range for every u.
// By the mean value theorem f(u) is in mid + slope * [-1, 1]; `enclose` intersects range with that. Each operation
// below applies the chain rule to these three statements, and throws Undefined unless its result is defined and
// differentiable on the whole of [-1, 1]. So the existence of a Form also proves that its function is continuous.
//
// Where mid is range, nothing is cut off, and the same rules differentiate functions of several variables over a box of
// values: with slope 1 for one variable and 0 for the others, slope holds the partial derivative at every point of the box.
#pragma once

#include "checker/interval.h"

namespace taut::checker {

struct Form {
  Interval mid;
  Interval slope;
  Interval range;

  Form() = default;  ///< the constant 0
  explicit Form(const Interval& constant) : mid(constant), range(constant) {}

  [[nodiscard]] static Form enclose(Interval mid, Interval slope, const Interval& range) {
    Form f;
    f.range = slope.is_exactly_zero() ? mid : intersection(range, mid + slope * Interval::plus_minus_one());
    f.mid = std::move(mid);
    f.slope = std::move(slope);
    return f;
  }
  /// A zero slope on all of [-1, 1]: range is mid, and functions need no derivative of what they are applied to.
  [[nodiscard]] bool is_constant() const { return slope.is_exactly_zero(); }
};

inline Form operator+(const Form& a, const Form& b) {
  return Form::enclose(a.mid + b.mid, a.slope + b.slope, a.range + b.range);
}
inline Form operator-(const Form& a, const Form& b) {
  return Form::enclose(a.mid - b.mid, a.slope - b.slope, a.range - b.range);
}
inline Form operator-(const Form& a) { return Form::enclose(-a.mid, -a.slope, -a.range); }

inline Form operator*(const Form& a, const Form& b) {
  if (a.is_constant() && b.is_constant()) return Form(a.mid * b.mid);
  if (a.is_constant()) return Form::enclose(a.mid * b.mid, a.mid * b.slope, a.mid * b.range);
  if (b.is_constant()) return Form::enclose(a.mid * b.mid, a.slope * b.mid, a.range * b.mid);
  return Form::enclose(a.mid * b.mid, a.slope * b.range + a.range * b.slope, a.range * b.range);
}
inline Form operator/(const Form& a, const Form& b) {
  if (a.is_constant() && b.is_constant()) return Form(a.mid / b.mid);
  const Interval quotient = a.range / b.range;
  return Form::enclose(a.mid / b.mid, (a.slope - quotient * b.slope) / b.range, quotient);
}
inline Form& operator+=(Form& a, const Form& b) { return a = a + b; }

inline Form sqr(const Form& a) {
  if (a.is_constant()) return Form(sqr(a.mid));
  return Form::enclose(sqr(a.mid), Interval(2) * a.range * a.slope, sqr(a.range));
}
inline Form sqrt(const Form& a) {
  if (a.is_constant()) return Form(sqrt(a.mid));
  const Interval root = sqrt(a.range);
  return Form::enclose(sqrt(a.mid), a.slope / (Interval(2) * root), root);
}
inline Form sin(const Form& a) {
  if (a.is_constant()) return Form(sin(a.mid));
  return Form::enclose(sin(a.mid), cos(a.range) * a.slope, sin(a.range));
}
inline Form cos(const Form& a) {
  if (a.is_constant()) return Form(cos(a.mid));
  return Form::enclose(cos(a.mid), -sin(a.range) * a.slope, cos(a.range));
}
inline Form exp(const Form& a) {
  if (a.is_constant()) return Form(exp(a.mid));
  const Interval range = exp(a.range);
  return Form::enclose(exp(a.mid), range * a.slope, range);
}
inline Form log(const Form& a) {
  if (a.is_constant()) return Form(log(a.mid));
  return Form::enclose(log(a.mid), a.slope / a.range, log(a.range));
}
inline Form power(const Form& a, int n) {
  if (n == 0) return Form(Interval(1));
  if (a.is_constant()) return Form(power(a.mid, n));
  return Form::enclose(power(a.mid, n), Interval(n) * power(a.range, n - 1) * a.slope, power(a.range, n));
}
inline Form asin(const Form& a) {
  if (a.is_constant()) return Form(asin(a.mid));
  return Form::enclose(asin(a.mid), a.slope / sqrt(Interval(1) - sqr(a.range)), asin(a.range));
}
inline Form acos(const Form& a) {
  if (a.is_constant()) return Form(acos(a.mid));
  return Form::enclose(acos(a.mid), -a.slope / sqrt(Interval(1) - sqr(a.range)), acos(a.range));
}
inline Form atan(const Form& a) {
  if (a.is_constant()) return Form(atan(a.mid));
  return Form::enclose(atan(a.mid), a.slope / (Interval(1) + sqr(a.range)), atan(a.range));
}
inline Form atan2(const Form& y, const Form& x) {
  if (y.is_constant() && x.is_constant()) return Form(atan2(y.mid, x.mid));
  const Interval slope = (x.range * y.slope - y.range * x.slope) / (sqr(x.range) + sqr(y.range));
  return Form::enclose(atan2(y.mid, x.mid), slope, atan2(y.range, x.range));
}

}  // namespace taut::checker
