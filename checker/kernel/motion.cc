// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/motion.h"

#include <algorithm>

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
  if (p[2] == 0 && p[3] == 0) return {p[0] + m * p[1], r * p[1]};
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
MeanValueForm form(const Polynomial& a, const Polynomial& b = {}) {
  std::array<Ball, 4> c;
  for (std::size_t i = 0; i < 4; ++i) {
    c[i] = Ball(a[i]);
    if (b[i] != 0) c[i] += Ball(b[i]) * Ball::pi();
  }
  return {c[0] + from_zero_to(c[2]), c[1] + from_zero_to(c[3])};  // u^2 is in [0, 1], u^3 = u u^2
}

struct Curve {
  std::vector<MeanValueForm> line;                  ///< l, one a parameter
  std::vector<std::vector<MeanValueForm>> normals;  ///< N, one row a parameter
};

Curve curve(std::span<const Waypoint> controls, const Box& box, std::size_t constraints) {
  Curve result;
  const bool has_half_turns = !controls[0].half_turns.empty();
  for (std::size_t j = 0; j < controls[0].x.size(); ++j) {
    const Polynomial x = over(controls, box, [&](const Waypoint& w) { return w.x[j]; });
    const bool turns = has_half_turns && std::ranges::any_of(controls, [&](const auto& w) { return w.half_turns[j]; });
    result.line.push_back(turns ? form(x, over(controls, box, [&](const Waypoint& w) { return w.half_turns[j]; }))
                                : form(x));
    std::vector<MeanValueForm>& row = result.normals.emplace_back();
    for (std::size_t i = 0; i < constraints; ++i) {
      row.push_back(form(over(controls, box, [&](const Waypoint& w) { return w.normals[j * constraints + i]; })));
    }
  }
  return result;
}

// ---- The motion on constraints ---------------------------------------------------------------------------------------

/// g(y, u) = C(l(u) + N(u) y).
class OnConstraints : public Equations {
 public:
  OnConstraints(const std::vector<Expression>& constraints, const Curve& curve)
      : constraints_(constraints), curve_(curve) {}

  [[nodiscard]] std::size_t unknowns() const override { return constraints_.size(); }

  [[nodiscard]] Vector6<MeanValueForm> residual(const Vector6<MeanValueForm>& y) const override {
    const std::vector<MeanValueForm> at = parameters(y);
    Vector6<MeanValueForm> result;
    for (std::size_t e = 0; e < constraints_.size(); ++e) result[e] = constraints_[e].evaluate<MeanValueForm>(at);
    return result;
  }

  [[nodiscard]] Matrix6<Ball> jacobian(const Vector6<Ball>& Y) const override {
    std::vector<Jet> at;
    for (std::size_t j = 0; j < curve_.line.size(); ++j) {
      Jet& x = at.emplace_back(curve_.line[j].range());
      for (std::size_t i = 0; i < constraints_.size(); ++i) {
        x.by[i] = curve_.normals[j][i].range();
        x.value.add_product(x.by[i], Y[i]);
      }
    }
    Matrix6<Ball> result;
    for (std::size_t e = 0; e < constraints_.size(); ++e) result[e] = constraints_[e].evaluate<Jet>(at).by;
    return result;
  }

  /// l + N y.
  [[nodiscard]] std::vector<MeanValueForm> parameters(const Vector6<MeanValueForm>& y) const {
    std::vector<MeanValueForm> result = curve_.line;
    for (std::size_t j = 0; j < result.size(); ++j) {
      for (std::size_t i = 0; i < constraints_.size(); ++i) result[j] += curve_.normals[j][i] * y[i];
    }
    return result;
  }

 private:
  const std::vector<Expression>& constraints_;
  const Curve& curve_;
};

// ---- Poses -----------------------------------------------------------------------------------------------------------

using Quaternion = std::array<mpq_class, 4>;  ///< x, y, z, w

Quaternion quaternion(std::span<const double> pose) {
  return {mpq_class(pose[3]), mpq_class(pose[4]), mpq_class(pose[5]), mpq_class(pose[6])};
}

Frame frame(const Vector6<MeanValueForm>& pose) {
  const MeanValueForm &phi = pose[3], &theta = pose[4], psi = pose[5] - phi;
  const auto cos = [](const MeanValueForm& x) { return apply(Function::kCos, x); };
  const auto sin = [](const MeanValueForm& x) { return apply(Function::kSin, x); };
  const MeanValueForm ca = cos(phi), sa = sin(phi), cb = cos(theta), sb = sin(theta), cg = cos(psi), sg = sin(psi);
  const MeanValueForm ca_cb = ca * cb, sa_cb = sa * cb;
  return {{pose[0], pose[1], pose[2]},
          {{{ca_cb * cg - sa * sg, -(ca_cb * sg) - sa * cg, ca * sb},
            {sa_cb * cg + ca * sg, ca * cg - sa_cb * sg, sa * sb},
            {-(sb * cg), sb * sg, cb}}}};
}

/// The rotation from q0 at constant rate to q1; s a MeanValueForm of the place in between.
Matrix3<MeanValueForm> geodesic(const Quaternion& q0, const Quaternion& q1, const MeanValueForm& s) {
  const mpq_class c = q0[0] * q1[0] + q0[1] * q1[1] + q0[2] * q1[2] + q0[3] * q1[3];
  if (c == 0) throw Undefined("a geodesic of half a turn, whose axis is not defined");
  const Vector3<mpq_class> u = {-q0[0], -q0[1], -q0[2]};
  const Vector3<mpq_class> u1 = {q1[0], q1[1], q1[2]};
  const Vector3<mpq_class> u_u1 = cross(u, u1);
  Vector3<mpq_class> v;  // of conj(q0) q1, turned so that c is positive
  for (std::size_t i = 0; i < 3; ++i) v[i] = (q0[3] * u1[i] + q1[3] * u[i] + u_u1[i]) * (c < 0 ? -1 : 1);
  const Matrix3<MeanValueForm> R0 = rotation(
      {MeanValueForm(Ball(q0[0])), MeanValueForm(Ball(q0[1])), MeanValueForm(Ball(q0[2])), MeanValueForm(Ball(q0[3]))});
  const mpq_class squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  if (squared == 0) return R0;

  const Ball size = sqrt(Ball(squared));
  const MeanValueForm angle = Ball(2) * value(Function::kAtan, size / Ball(mpq_class(abs(c)))) * s;
  Vector3<Ball> n;
  for (std::size_t i = 0; i < 3; ++i) n[i] = Ball(v[i]) / size;
  const Matrix3<Ball> N = {{{Ball(), -n[2], n[1]}, {n[2], Ball(), -n[0]}, {-n[1], n[0], Ball()}}};
  const Matrix3<Ball> NN = multiply(N, N);
  const MeanValueForm sine = apply(Function::kSin, angle);
  const MeanValueForm rest = MeanValueForm(Ball(1)) - apply(Function::kCos, angle);
  Matrix3<MeanValueForm> turn;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      turn[i][j] = MeanValueForm(Ball(i == j ? 1 : 0)) + N[i][j] * sine + NN[i][j] * rest;
  }
  return multiply(R0, turn);
}

Frame geodesic(const Path& path, std::size_t k, const Box& box) {
  const std::span<const Waypoint> controls = path.controls(k);
  const std::vector<MeanValueForm> line = curve(controls, box, 0).line;
  return {{line[0], line[1], line[2]},
          geodesic(quaternion(controls.front().x), quaternion(controls.back().x), form(over({0, 1}, box)))};
}

/// R(v, 1) = I + 2 / (1 + |v|^2) ([v] + [v]^2), [v]^2 = v v' - |v|^2 I.
template <class T>
Matrix3<T> turn_by(const Vector3<T>& v) {
  const T one(Ball(1));
  const T scale = T(Ball(2)) / (one + squared_norm(v));
  Matrix3<T> R = {{{-sqr(v[1]) - sqr(v[2]), v[0] * v[1] - v[2], v[0] * v[2] + v[1]},
                   {v[0] * v[1] + v[2], -sqr(v[0]) - sqr(v[2]), v[1] * v[2] - v[0]},
                   {v[0] * v[2] - v[1], v[1] * v[2] + v[0], -sqr(v[0]) - sqr(v[1])}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R[i][j] = scale * R[i][j];
    R[i][i] = one + R[i][i];
  }
  return R;
}

/// g of the header.
class ForwardKinematics : public Equations {
 public:
  explicit ForwardKinematics(const LengthControlled& machine)
      : machine_(machine), position_(machine.tube.position), turn_(machine.tube.turn) {
    for (const MeanValueForm& L : machine.lengths) {
      if (!certainly_positive(L.range())) throw Undefined("a cable may have no length");
    }
  }

  [[nodiscard]] std::size_t unknowns() const override { return 6; }

  [[nodiscard]] Frame pose(const Vector6<MeanValueForm>& z) const {
    const Vector3<MeanValueForm> v = turn_ * Vector3<MeanValueForm>{z[3], z[4], z[5]};
    return {machine_.reference.p + position_ * Vector3<MeanValueForm>{z[0], z[1], z[2]},
            multiply(turn_by(v), machine_.reference.R)};
  }

  [[nodiscard]] Vector6<MeanValueForm> residual(const Vector6<MeanValueForm>& z) const override {
    const Frame at = pose(z);
    Vector6<MeanValueForm> result;
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector3<MeanValueForm> d = at.p + multiply(at.R, machine_.platform[i]) - machine_.base[i];
      result[i] = Ball(0.5) * (squared_norm(d) - sqr(machine_.lengths[i]));
    }
    return result;
  }

  [[nodiscard]] Matrix6<Ball> jacobian(const Vector6<Ball>& z) const override {
    const Vector3<Ball> v = turn_ * Vector3<Ball>{z[3], z[4], z[5]};
    const Vector3<Ball> p = range(machine_.reference.p) + position_ * Vector3<Ball>{z[0], z[1], z[2]};
    const Matrix3<Ball> R = multiply(turn_by(v), range(machine_.reference.R));
    const Ball turning = turn_ * Ball(2) / (Ball(1) + squared_norm(v));
    Matrix6<Ball> result;
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector3<Ball> Rb = multiply(R, range(machine_.platform[i]));
      const Vector3<Ball> from_a = p - range(machine_.base[i]);
      const Vector3<Ball> x = cross(Rb, from_a);
      const Vector3<Ball> x_turned = x + cross(x, v);
      for (std::size_t c = 0; c < 3; ++c) {
        result[i][c] = position_ * (from_a[c] + Rb[c]);
        result[i][3 + c] = turning * x_turned[c];
      }
    }
    return result;
  }

 private:
  const LengthControlled& machine_;
  Ball position_;
  Ball turn_;
};

LengthControlled length_controlled(const Machine& machine, const Path& path, std::size_t k, const Box& box) {
  const std::span<const Waypoint> controls = path.controls(k);
  LengthControlled result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.lengths[i] = form(over(controls, box, [&](const Waypoint& w) { return w.x[7 + i]; }));
    for (std::size_t c = 0; c < 3; ++c) {
      result.base[i][c] = MeanValueForm(machine.base[i][c]);
      result.platform[i][c] = MeanValueForm(machine.platform[i][c]);
    }
  }
  const std::vector<InnerPose>& inner = path.inner_poses[k];
  const auto next = std::ranges::upper_bound(inner, box.begin, {}, &InnerPose::s);
  const bool is_first = next == inner.begin();
  const bool is_last = next == inner.end();
  const mpq_class begin = is_first ? mpq_class(0) : std::prev(next)->s;
  const mpq_class end = is_last ? mpq_class(1) : next->s;
  if (box.end > end) throw std::logic_error("a box that reaches across an inner pose");
  const std::span<const double> first = is_first ? std::span<const double>(controls.front().x) : std::prev(next)->x;
  const std::span<const double> last = is_last ? std::span<const double>(controls.back().x) : next->x;
  result.reference = reference_line(first, begin, last, end, box);
  result.tube = is_first ? path.pose_tubes[k] : std::prev(next)->tube;
  return result;
}

Ball tube_of_constraints(const Path& path, std::size_t k) { return Ball(path.tubes[k]); }

const NearZero& near(const Box& box) {
  if (!box.near) throw std::logic_error("a box without the place of its implied motion");
  return *box.near;
}

/// At the end of the box where u = `end`.
void require_near(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box,
                  int end) {
  const std::span<const Waypoint> controls = path.controls(k);
  // At either end of a straight segment one matters, of a spline's three; the one of a path that stays matters itself.
  const std::size_t others = controls.size() == 1 ? 0 : 1;
  const auto stated = controls.subspan(end < 0 ? 0 : others, controls.size() - others);
  const auto near = path.law == Law::kCubicBSpline ? stated : end < 0 ? stated.first(1) : stated.last(1);
  std::vector<MeanValueForm> there = parameters(problem, path, k, box);
  for (MeanValueForm& x : there) x = MeanValueForm(x.at + Ball(end) * x.slope);
  const Vector6<MeanValueForm> reached = coordinates(problem, there);
  std::vector<Vector6<MeanValueForm>> asked;
  for (const Waypoint& waypoint : near) asked.push_back(coordinates(problem, stated_parameters(waypoint)));
  for (std::size_t i = 0; i < 6; ++i) {
    const Ball slack = Ball(mpq_class(1, 50)) * (i < 3 ? machine.platform_size() : Ball(1));
    for (const int side : {-1, 1}) {
      const auto is_as_far = [&](const Vector6<MeanValueForm>& other) {  // on that side
        return certainly_nonnegative(slack + Ball(side) * (other[i].range() - reached[i].range()));
      };
      if (std::ranges::none_of(asked, is_as_far)) {
        throw Undefined("the pose on the constraints may not be next to what the path states at a waypoint");
      }
    }
  }
}

}  // namespace

Matrix3<MeanValueForm> rotation(const std::array<MeanValueForm, 4>& q) {
  const auto& [x, y, z, w] = q;
  const MeanValueForm xx = sqr(x), yy = sqr(y), zz = sqr(z), ww = sqr(w);
  const MeanValueForm xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  const Ball two(2);
  Matrix3<MeanValueForm> R = {{{ww + xx - yy - zz, two * (xy - wz), two * (xz + wy)},
                               {two * (xy + wz), ww - xx + yy - zz, two * (yz - wx)},
                               {two * (xz - wy), two * (yz + wx), ww - xx - yy + zz}}};
  const MeanValueForm inverse = apply(Function::kInverse, xx + yy + zz + ww);
  for (Vector3<MeanValueForm>& row : R) {
    for (MeanValueForm& entry : row) entry = entry * inverse;
  }
  return R;
}

std::vector<MeanValueForm> stated_parameters(const Waypoint& waypoint) {
  std::vector<MeanValueForm> result;
  for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
    result.emplace_back(Ball(waypoint.x[j]) + Ball(waypoint.half_turns[j]) * Ball::pi());
  }
  return result;
}

void require_in_range(const Problem& problem, const std::vector<MeanValueForm>& parameters) {
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const Parameter& parameter = problem.parameters[j];
    if (parameter.kind != ParameterKind::kRange) continue;
    for (const MeanValueForm& excess : {parameters[j] - parameter.lower.evaluate<MeanValueForm>({}),
                                        parameter.upper.evaluate<MeanValueForm>({}) - parameters[j]}) {
      if (!certainly_nonnegative(excess.range())) throw Undefined(parameter.name + " may be outside its range");
    }
  }
}

Vector6<MeanValueForm> coordinates(const Problem& problem, const std::vector<MeanValueForm>& parameters) {
  Vector6<MeanValueForm> result;
  for (std::size_t c = 0; c < 6; ++c) result[c] = problem.pose[c].evaluate<MeanValueForm>(parameters);
  return result;
}

std::vector<MeanValueForm> parameters(const Problem& problem, const Path& path, std::size_t k, const Box& box) {
  const Curve over_box = curve(path.controls(k), box, problem.constraints.size());
  if (problem.constraints.empty()) return over_box.line;
  const OnConstraints equations(problem.constraints, over_box);
  return equations.parameters(only_zero(equations, tube_of_constraints(path, k), near(box)));
}

Frame forward_kinematics(const LengthControlled& machine, const NearZero& near) {
  const ForwardKinematics equations(machine);
  return equations.pose(only_zero(equations, Ball(1), near));
}

Frame reference_line(std::span<const double> begin, const mpq_class& s_begin, std::span<const double> end,
                     const mpq_class& s_end, const Box& box) {
  const auto number = [&](std::size_t j) {
    const mpq_class first(begin[j]);
    const mpq_class slope = (mpq_class(end[j]) - first) / (s_end - s_begin);
    return form(over(Polynomial{first - slope * s_begin, slope}, box));
  };
  return {{number(0), number(1), number(2)}, rotation({number(3), number(4), number(5), number(6)})};
}

Geometry commanded_geometry(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                            const Box& box, Ranges ranges) {
  if (path.law == Law::kGeodesic) return machine.geometry(geodesic(path, k, box));
  if (path.law == Law::kCableLengths) {
    const LengthControlled controlled = length_controlled(machine, path, k, box);
    Geometry result = machine.geometry(forward_kinematics(controlled, near(box)));
    result.length = controlled.lengths;
    return result;
  }
  const std::vector<MeanValueForm> at = parameters(problem, path, k, box);
  // Between waypoints inside their ranges parameters stay inside, by convexity; those of an implied motion need not.
  if (!problem.constraints.empty() && ranges == Ranges::kRequired) require_in_range(problem, at);
  return machine.geometry(frame(coordinates(problem, at)));
}

void require_near_waypoints(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                            const Box& box) {
  if (problem.constraints.empty() || has_poses(path.law)) return;
  if (box.begin == 0) require_near(machine, problem, path, k, box, -1);
  if (box.end == 1) require_near(machine, problem, path, k, box, 1);
}

void with_equations(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box,
                    const std::function<void(const Equations& equations, const Ball& tube)>& use) {
  if (path.law == Law::kCableLengths) {
    const LengthControlled controlled = length_controlled(machine, path, k, box);
    with_equations(controlled, use);
  } else {
    const Curve over_box = curve(path.controls(k), box, problem.constraints.size());
    use(OnConstraints(problem.constraints, over_box), tube_of_constraints(path, k));
  }
}

void with_equations(const LengthControlled& machine,
                    const std::function<void(const Equations& equations, const Ball& tube)>& use) {
  use(ForwardKinematics(machine), Ball(1));
}

}  // namespace taut::checker
