#include "certify/checker/motion.h"

#include "certify/checker/linear.h"

namespace taut::checker {
namespace {

// ---- The curve ------------------------------------------------------------------------------------------------------

/// c0 + c1 s + c2 s^2 + c3 s^3.
using Polynomial = std::array<mpq_class, 4>;

/// One coordinate of a segment, from those of its control points.
Polynomial mix(const std::vector<mpq_class>& q) {
  switch (q.size()) {
    case 1: return {q[0]};
    case 2: return {q[0], q[1] - q[0]};
    case 4:
      return {(q[0] + 4 * q[1] + q[2]) / 6, (q[2] - q[0]) / 2, (q[0] - 2 * q[1] + q[2]) / 2,
              (q[3] - 3 * q[2] + 3 * q[1] - q[0]) / 6};
    default: throw std::logic_error("a segment has one, two or four control points");
  }
}

/// The coefficients of p(m + r u) as a polynomial in u.
Polynomial over(const Polynomial& p, const Box& box) {
  const mpq_class m = (box.begin + box.end) / 2;
  const mpq_class r = (box.end - box.begin) / 2;
  return {p[0] + m * (p[1] + m * (p[2] + m * p[3])), r * (p[1] + m * (2 * p[2] + m * 3 * p[3])),
          r * r * (p[2] + 3 * m * p[3]), r * r * r * p[3]};
}

/// One number of each control point, mixed, over the box.
template <class Number>
Polynomial over(std::span<const Waypoint> controls, const Box& box, const Number& number) {
  std::vector<mpq_class> values;
  for (const Waypoint& waypoint : controls) values.emplace_back(number(waypoint));
  return over(mix(values), box);
}

/// Of a polynomial in u with coefficients a + b pi. They are summed before u enters: the two parts may nearly cancel.
Form form(const Polynomial& a, const Polynomial& b) {
  std::array<Interval, 4> c;
  for (std::size_t i = 0; i < 4; ++i) {
    c[i] = Interval{a[i]};
    if (b[i] != 0) c[i] += Interval{b[i]} * Interval::pi();
  }
  const Interval u = Interval::plus_minus_one();
  return Form::enclose(c[0], c[1] + Interval(2) * c[2] * u + Interval(3) * c[3] * sqr(u),
                       c[0] + (c[1] + (c[2] + c[3] * u) * u) * u);
}

struct Curve {
  std::vector<Form> line;                  ///< l, one a parameter
  std::vector<std::vector<Form>> normals;  ///< N, one row a parameter
};

Curve curve(std::span<const Waypoint> controls, const Box& box, std::size_t constraints) {
  Curve result;
  for (std::size_t j = 0; j < controls[0].x.size(); ++j) {
    result.line.push_back(form(over(controls, box, [&](const Waypoint& w) { return w.x[j]; }),
                               over(controls, box, [&](const Waypoint& w) { return w.half_turns[j]; })));
    std::vector<Form>& row = result.normals.emplace_back();
    for (std::size_t i = 0; i < constraints; ++i) {
      row.push_back(form(over(controls, box, [&](const Waypoint& w) { return w.normals[j * constraints + i]; }), {}));
    }
  }
  return result;
}

// ---- The motion that is only implied ---------------------------------------------------------------------------------
//
// There are k <= 5 unknowns y_i. Vectors and matrices of six are used; what is beyond k is that of g_i = y_i.

/// What is known of y(u) for every u.
struct Zero {
  Vector6<Interval> y;
  Vector6<Interval> slope;  ///< y'
};

/// The partial derivative by parameter j over a box of values: with mid equal to range, Forms differentiate.
Interval derivative(const Expression& f, const std::vector<Interval>& values, std::size_t j) {
  std::vector<Form> forms(values.begin(), values.end());
  forms[j].slope = Interval(1);
  return f.evaluate(forms).slope;
}

Matrix6<Interval> identity() {
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) result[i][i] = Interval(1);
  return result;
}

class ImpliedMotion {
 public:
  ImpliedMotion(const std::vector<Expression>& constraints, const Curve& curve)
      : constraints_(constraints), curve_(curve) {}

  /// From an approximation of y at the middle of the box. @throws Undefined unless there is exactly one zero with
  /// |y_i| <= tube, for every u.
  [[nodiscard]] Zero zero(double tube, const Vector6<Interval>& near) const {
    const std::size_t k = constraints_.size();
    const Interval t{mpq_class(tube)};
    Vector6<Interval> whole;
    for (std::size_t i = 0; i < k; ++i) whole[i] = t * Interval::plus_minus_one();
    (void)krawczyk(whole);  // so there is at most one

    const Vector6<Interval> guess = krawczyk(near).y;
    Interval farthest;
    for (std::size_t i = 0; i < k; ++i) farthest = max(farthest, abs(guess[i] - near[i]));
    Vector6<Interval> Z = near;
    for (std::size_t i = 0; i < k; ++i) {
      Z[i] += Interval(2) * farthest * Interval::plus_minus_one();
      if (!certainly_positive(t - abs(Z[i]))) throw Undefined("it may leave its tube");
    }
    Zero result = krawczyk(Z);
    for (std::size_t i = 0; i < k; ++i) {
      if (!is_within(result.y[i], Z[i])) throw Undefined("it may not exist");
    }
    constexpr int kNarrowings = 2;  // each takes away most of what the last one left of the curvature's part
    for (int step = 0; step < kNarrowings; ++step) {
      for (std::size_t i = 0; i < k; ++i) Z[i] = intersection(Z[i], result.y[i]);
      result = krawczyk(Z);
    }
    for (std::size_t i = 0; i < k; ++i) result.y[i] = intersection(Z[i], result.y[i]);
    return result;
  }

  /// About where y is, of a box that is a single s: Newton's method, which is what K of a single y is.
  [[nodiscard]] Vector6<Interval> approximate_zero() const {
    constexpr int kMostSteps = 20;
    Vector6<Interval> y;
    Interval last;
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector6<Interval> next = krawczyk(y).y;
      Interval moved;
      for (std::size_t i = 0; i < 6; ++i) {
        moved = max(moved, abs(next[i] - y[i]));
        y[i] = middle(next[i]);
      }
      if (step > 0 && !certainly_positive(last - Interval(2) * moved)) break;  // what is left is rounding
      last = moved;
    }
    return y;
  }

 private:
  /// K for the box Y, and y' as far as y is in Y. @throws Undefined unless rho < 1.
  [[nodiscard]] Zero krawczyk(const Vector6<Interval>& Y) const {
    const std::size_t k = constraints_.size();
    const std::vector<Interval> values = parameters(Y, &Form::range);
    Matrix6<Interval> G = identity();
    Vector6<Interval> h;
    for (std::size_t e = 0; e < k; ++e) {
      G[e][e] = Interval(0);
      for (std::size_t j = 0; j < values.size(); ++j) {
        const Interval partial = derivative(constraints_[e], values, j);
        Interval drift = curve_.line[j].slope;
        for (std::size_t i = 0; i < k; ++i) {
          G[e][i] += partial * curve_.normals[j][i].range;
          drift += curve_.normals[j][i].slope * Y[i];
        }
        h[e] += partial * drift;
      }
    }
    const Matrix6<Interval> A = middle(inverse(middle(G)));
    const Matrix6<Interval> AG = multiply(A, G);
    Matrix6<Interval> M = identity();
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) M[i][j] -= AG[i][j];
    }
    const Interval gap = Interval(1) - norm(M);
    if (!certainly_positive(gap)) throw Undefined("it may not be the only one in its tube");

    Vector6<Interval> c;
    Vector6<Interval> offset;
    for (std::size_t i = 0; i < k; ++i) {
      c[i] = middle(Y[i]);
      offset[i] = Y[i] - c[i];
    }
    const Vector6<Interval> Ag = multiply(A, constraints_at(parameters(c, &Form::mid)));
    const Vector6<Interval> Ah = multiply(A, h);
    const Vector6<Interval> M_offset = multiply(M, offset);
    Interval largest;
    for (const Interval& x : Ah) largest = max(largest, abs(x));
    Vector6<Interval> rough;
    rough.fill(largest / gap * Interval::plus_minus_one());
    const Vector6<Interval> M_rough = multiply(M, rough);

    Zero result;
    for (std::size_t i = 0; i < k; ++i) {
      result.y[i] = c[i] - Ag[i] - Ah[i] * Interval::plus_minus_one() + M_offset[i];
      result.slope[i] = M_rough[i] - Ah[i];
    }
    return result;
  }

  /// l + N y.
  [[nodiscard]] std::vector<Interval> parameters(const Vector6<Interval>& y, Interval Form::*where) const {
    std::vector<Interval> result;
    for (std::size_t j = 0; j < curve_.line.size(); ++j) {
      result.push_back(curve_.line[j].*where);
      for (std::size_t i = 0; i < constraints_.size(); ++i) result[j] += curve_.normals[j][i].*where * y[i];
    }
    return result;
  }

  [[nodiscard]] Vector6<Interval> constraints_at(const std::vector<Interval>& values) const {
    const std::vector<Form> forms(values.begin(), values.end());
    Vector6<Interval> result;
    for (std::size_t e = 0; e < constraints_.size(); ++e) result[e] = constraints_[e].evaluate(forms).range;
    return result;
  }

  const std::vector<Expression>& constraints_;
  const Curve& curve_;
};

/// y(u), as Forms.
Vector6<Form> implied(const Problem& problem, std::span<const Waypoint> controls, double tube, const Box& box,
                      const Curve& over_box) {
  const std::size_t k = problem.constraints.size();
  const mpq_class m = (box.begin + box.end) / 2;
  const Curve at_mid = curve(controls, {m, m}, k);
  const ImpliedMotion motion_at_mid(problem.constraints, at_mid);
  const Vector6<Interval> near = motion_at_mid.approximate_zero();
  const Zero mid = motion_at_mid.zero(tube, near);
  const Zero range = ImpliedMotion(problem.constraints, over_box).zero(tube, near);
  Vector6<Form> result;
  for (std::size_t i = 0; i < k; ++i) result[i] = Form::enclose(mid.y[i], range.slope[i], range.y[i]);
  return result;
}

}  // namespace

std::vector<Form> parameters(const Problem& problem, const Path& path, std::size_t k, const Box& box) {
  const std::span<const Waypoint> controls = path.controls(k);
  Curve over_box = curve(controls, box, problem.constraints.size());
  if (problem.constraints.empty()) return over_box.line;
  try {
    const Vector6<Form> y = implied(problem, controls, path.tubes[k], box, over_box);
    for (std::size_t j = 0; j < over_box.line.size(); ++j) {
      for (std::size_t i = 0; i < problem.constraints.size(); ++i) over_box.line[j] += over_box.normals[j][i] * y[i];
    }
    return over_box.line;
  } catch (const Undefined& why) {
    throw Undefined(std::string("the motion on the constraints: ") + why.what());
  }
}

}  // namespace taut::checker
