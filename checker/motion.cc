#include "checker/motion.h"

#include "checker/krawczyk.h"

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

// ---- The motion on constraints ---------------------------------------------------------------------------------------

/// The partial derivative by parameter j over a box of values: with mid equal to range, Forms differentiate.
Interval derivative(const Expression& f, const std::vector<Interval>& values, std::size_t j) {
  std::vector<Form> forms(values.begin(), values.end());
  forms[j].slope = Interval(1);
  return f.evaluate(forms).slope;
}

/// g(y, u) = C(l(u) + N(u) y); its derivatives by the chain rule, from those of C on a box of parameters.
class OnConstraints : public Equations {
 public:
  OnConstraints(const std::vector<Expression>& constraints, const Curve& curve)
      : constraints_(constraints), curve_(curve) {}

  [[nodiscard]] std::size_t unknowns() const override { return constraints_.size(); }

  [[nodiscard]] Derivatives derivatives(const Vector6<Interval>& Y) const override {
    const std::size_t k = constraints_.size();
    const std::vector<Interval> values = parameters(Y, &Form::range);
    Derivatives result;
    for (std::size_t e = 0; e < k; ++e) {
      for (std::size_t j = 0; j < values.size(); ++j) {
        const Interval partial = derivative(constraints_[e], values, j);
        Interval drift = curve_.line[j].slope;
        for (std::size_t i = 0; i < k; ++i) {
          result.by_y[e][i] += partial * curve_.normals[j][i].range;
          drift += curve_.normals[j][i].slope * Y[i];
        }
        result.by_u[e] += partial * drift;
      }
    }
    return result;
  }

  [[nodiscard]] Vector6<Interval> at_middle(const Vector6<Interval>& y) const override {
    const std::vector<Interval> values = parameters(y, &Form::mid);
    const std::vector<Form> forms(values.begin(), values.end());
    Vector6<Interval> result;
    for (std::size_t e = 0; e < constraints_.size(); ++e) result[e] = constraints_[e].evaluate(forms).range;
    return result;
  }

 private:
  /// l + N y.
  [[nodiscard]] std::vector<Interval> parameters(const Vector6<Interval>& y, Interval Form::*where) const {
    std::vector<Interval> result;
    for (std::size_t j = 0; j < curve_.line.size(); ++j) {
      result.push_back(curve_.line[j].*where);
      for (std::size_t i = 0; i < constraints_.size(); ++i) result[j] += curve_.normals[j][i].*where * y[i];
    }
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
  const OnConstraints motion_at_mid(problem.constraints, at_mid);
  const OnConstraints motion(problem.constraints, over_box);
  const Interval t{mpq_class(tube)};
  const Vector6<Interval> near = approximate_zero(motion_at_mid);
  const Zero mid = only_zero(motion_at_mid, t, near);
  const Zero range = only_zero(motion, t, near);
  Vector6<Form> result;
  for (std::size_t i = 0; i < k; ++i) result[i] = Form::enclose(mid.y[i], range.slope[i], range.y[i]);
  return result;
}

// ---- Poses -----------------------------------------------------------------------------------------------------------

using Quaternion = std::array<mpq_class, 4>;  ///< x, y, z, w

Quaternion quaternion(const Waypoint& waypoint) {
  Quaternion q;
  for (std::size_t i = 0; i < 4; ++i) q[i] = mpq_class(waypoint.x[3 + i]);
  return q;
}

/// The part of a segment's reference between two successive poses.
struct Piece {
  mpq_class begin = 0;
  mpq_class end = 1;
  std::span<const double> first, last;  ///< the numbers of the poses there
  PoseTube tube;
};

/// That in which the box is.
Piece piece_of(const Path& path, std::size_t k, const Box& box) {
  const std::span<const Waypoint> controls = path.controls(k);
  Piece piece;
  piece.first = controls.front().x;
  piece.last = controls.back().x;
  piece.tube = path.pose_tubes[k];
  const std::vector<InnerPose>& inner = path.inner_poses[k];
  const auto next = first_after(inner, box.begin);
  if (next != inner.end()) {
    piece.end = next->s;
    piece.last = next->x;
  }
  if (next != inner.begin()) {
    const InnerPose& begin = *std::prev(next);
    piece.begin = begin.s;
    piece.first = begin.x;
    piece.tube = begin.tube;
  }
  if (box.end > piece.end) throw std::logic_error("a box that reaches across an inner pose");
  return piece;
}

std::array<Form, 4> constant(const Quaternion& q) {
  return {Form(Interval(q[0])), Form(Interval(q[1])), Form(Interval(q[2])), Form(Interval(q[3]))};
}

/// The rotation from q0 at constant rate to q1; s a Form of the place in between.
Matrix3<Form> geodesic(const Quaternion& q0, const Quaternion& q1, const Form& s) {
  const mpq_class c = q0[0] * q1[0] + q0[1] * q1[1] + q0[2] * q1[2] + q0[3] * q1[3];
  if (c == 0) throw Undefined("a geodesic of half a turn: about which axis?");
  const Vector3<mpq_class> u = {-q0[0], -q0[1], -q0[2]};
  const Vector3<mpq_class> u1 = {q1[0], q1[1], q1[2]};
  const Vector3<mpq_class> u_u1 = cross(u, u1);
  Vector3<mpq_class> v;  // of conj(q0) q1, turned so that c is positive
  for (std::size_t i = 0; i < 3; ++i) v[i] = (q0[3] * u1[i] + q1[3] * u[i] + u_u1[i]) * (c < 0 ? -1 : 1);
  const Matrix3<Form> R0 = rotation(constant(q0));
  const mpq_class squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  if (squared == 0) return R0;

  const Interval size = sqrt(Interval(squared));
  const Form angle = s * Form(Interval(2) * atan(size / Interval(mpq_class(abs(c)))));
  Vector3<Form> n;
  for (std::size_t i = 0; i < 3; ++i) n[i] = Form(Interval(v[i]) / size);
  const Matrix3<Form> N = {{{Form(), -n[2], n[1]}, {n[2], Form(), -n[0]}, {-n[1], n[0], Form()}}};
  const Matrix3<Form> NN = multiply(N, N);
  const Form sine = sin(angle);
  const Form rest = Form(Interval(1)) - cos(angle);
  Matrix3<Form> turn;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) turn[i][j] = Form(Interval(i == j ? 1 : 0)) + sine * N[i][j] + rest * NN[i][j];
  }
  return multiply(R0, turn);
}

}  // namespace

Matrix3<Form> rotation(const std::array<Form, 4>& q) {
  const auto& [x, y, z, w] = q;
  const Form xx = sqr(x), yy = sqr(y), zz = sqr(z), ww = sqr(w);
  const Form xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  const Form two{Interval(2)};
  Matrix3<Form> R = {{{ww + xx - yy - zz, two * (xy - wz), two * (xz + wy)},
                      {two * (xy + wz), ww - xx + yy - zz, two * (yz - wx)},
                      {two * (xz - wy), two * (yz + wx), ww - xx - yy + zz}}};
  const Form squared = xx + yy + zz + ww;
  for (Vector3<Form>& row : R) {
    for (Form& entry : row) entry = entry / squared;
  }
  return R;
}

Frame frame(const Vector6<Form>& pose) {
  const Form &phi = pose[3], &theta = pose[4], psi = pose[5] - phi;
  const Form ca = cos(phi), sa = sin(phi), cb = cos(theta), sb = sin(theta), cg = cos(psi), sg = sin(psi);
  return {{pose[0], pose[1], pose[2]},
          {{{ca * cb * cg - sa * sg, -(ca * cb * sg) - sa * cg, ca * sb},
            {sa * cb * cg + ca * sg, ca * cg - sa * cb * sg, sa * sb},
            {-(sb * cg), sb * sg, cb}}}};
}

std::vector<Form> stated_parameters(const Waypoint& waypoint) {
  std::vector<Form> result;
  for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
    result.emplace_back(Interval{mpq_class(waypoint.x[j])} + Interval(waypoint.half_turns[j]) * Interval::pi());
  }
  return result;
}

Vector6<Form> coordinates(const Problem& problem, const std::vector<Form>& parameters) {
  Vector6<Form> result;
  for (std::size_t c = 0; c < 6; ++c) result[c] = problem.pose[c].evaluate(parameters);
  return result;
}

Frame geodesic(const Path& path, std::size_t k, const Box& box) {
  const std::span<const Waypoint> controls = path.controls(k);
  const std::vector<Form> line = curve(controls, box, 0).line;
  return {{line[0], line[1], line[2]},
          geodesic(quaternion(controls.front()), quaternion(controls.back()), form(over({0, 1}, box), {}))};
}

Reference reference(const Path& path, std::size_t k, const Box& box) {
  const Piece piece = piece_of(path, k, box);
  const mpq_class length = piece.end - piece.begin;
  // Number j of the poses, as a polynomial in u: exact.
  const auto number = [&](std::size_t j) {
    const mpq_class first(piece.first[j]);
    const mpq_class slope = (mpq_class(piece.last[j]) - first) / length;
    return over({first - slope * piece.begin, slope}, box);
  };
  Reference result;
  result.tube = piece.tube;
  for (std::size_t i = 0; i < 3; ++i) result.pose.p[i] = form(number(i), {});

  std::array<Form, 4> q;
  Quaternion q0, q1;
  Polynomial squared;  // |q|^2
  for (std::size_t i = 0; i < 4; ++i) {
    const Polynomial qi = number(3 + i);
    q[i] = form(qi, {});
    q0[i] = qi[0];
    q1[i] = qi[1];
    squared[0] += qi[0] * qi[0];
    squared[1] += 2 * qi[0] * qi[1];
    squared[2] += qi[1] * qi[1];
  }
  result.pose.R = rotation(q);
  const Vector3<mpq_class> v0 = {q0[0], q0[1], q0[2]};
  const Vector3<mpq_class> v1 = {q1[0], q1[1], q1[2]};
  const Vector3<mpq_class> v0_v1 = cross(v0, v1);
  const Form norm = form(squared, {});
  for (std::size_t i = 0; i < 3; ++i) {
    const mpq_class twice = 2 * (q0[3] * v1[i] - q1[3] * v0[i] + v0_v1[i]);
    result.turning[i] = Form(Interval(twice)) / norm;
  }
  return result;
}

Vector6<Form> commanded_lengths(const Path& path, std::size_t k, const Box& box) {
  const std::vector<Form> line = curve(path.controls(k), box, 0).line;
  Vector6<Form> result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = line[7 + i];
  return result;
}

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
