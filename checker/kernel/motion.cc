// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/motion.h"

#include <algorithm>

#include "checker/kernel/curve.h"
#include "checker/kernel/rotation.h"

namespace taut::checker {
namespace {

/// The parameters l(u) + N(u) y, and g(y, u) = C(l(u) + N(u) y).
class OnConstraints : public Equations {
 public:
  OnConstraints(const Problem& problem, const Path& path, std::size_t k, const Box& box)
      : constraints_(problem.constraints) {
    const std::span<const Waypoint> controls = path.controls(k);
    for (std::size_t j = 0; j < controls[0].x.size(); ++j) {
      const auto [own, by_pi] = coordinate(controls, j);
      line_.push_back(form(over(own, box), over(by_pi, box)));
      std::vector<MeanValueForm>& row = normals_.emplace_back();
      for (std::size_t i = j * unknowns(); i < (j + 1) * unknowns(); ++i) {
        row.push_back(form(over(mixed(controls, [&](const Waypoint& w) { return w.normals[i]; }), box)));
      }
    }
  }

  [[nodiscard]] std::size_t unknowns() const override { return constraints_.size(); }

  [[nodiscard]] Vector6<MeanValueForm> residual(const Vector6<MeanValueForm>& y) const override {
    const std::vector<MeanValueForm> at = parameters(y);
    Vector6<MeanValueForm> result;
    for (std::size_t e = 0; e < unknowns(); ++e) result[e] = constraints_[e].evaluate<MeanValueForm>(at);
    return result;
  }

  [[nodiscard]] Matrix6<Ball> jacobian(const Vector6<Ball>& Y) const override {
    std::vector<Jet> at;
    for (std::size_t j = 0; j < line_.size(); ++j) {
      Jet& x = at.emplace_back(line_[j].range());
      for (std::size_t i = 0; i < unknowns(); ++i) {
        x.by[i] = normals_[j][i].range();
        x.value.add_product(x.by[i], Y[i]);
      }
    }
    Matrix6<Ball> result;
    for (std::size_t e = 0; e < unknowns(); ++e) result[e] = constraints_[e].evaluate<Jet>(at).by;
    return result;
  }

  [[nodiscard]] std::vector<MeanValueForm> parameters(const Vector6<MeanValueForm>& y) const {
    std::vector<MeanValueForm> result = line_;
    for (std::size_t j = 0; j < result.size(); ++j) {
      for (std::size_t i = 0; i < unknowns(); ++i) result[j] += normals_[j][i] * y[i];
    }
    return result;
  }

 private:
  const std::vector<Expression>& constraints_;
  std::vector<MeanValueForm> line_;                  ///< l, one a parameter
  std::vector<std::vector<MeanValueForm>> normals_;  ///< N, one row a parameter
};

// ---- Poses ----------------------------------------------------------------------------------------------------------

Frame frame(const Problem& problem, const Vector6<MeanValueForm>& pose) {
  return {{pose[0], pose[1], pose[2]}, orientation(problem, pose)};
}

/// The rotation of conj(q0) q1, of which c is not negative: about v by 2 atan(|v| / c).
struct RelativeTurn {
  ExactVector v;
  mpq_class c;

  /// @throws Undefined of half a turn
  explicit RelativeTurn(std::span<const Waypoint> controls) {
    const ExactVector u0 = vector(controls.front()), u1 = vector(controls.back()), u0_u1 = cross(u0, u1);
    const mpq_class w0(controls.front().x[6]), w1(controls.back().x[6]);
    c = dot(u0, u1) + w0 * w1;
    if (c == 0) throw Undefined("a geodesic of half a turn, whose axis is not defined");
    for (std::size_t i = 0; i < 3; ++i) v[i] = (w0 * u1[i] - w1 * u0[i] - u0_u1[i]) * (c < 0 ? -1 : 1);
    c = abs(c);
  }

  [[nodiscard]] static ExactVector vector(const Waypoint& w) { return {w.x[3], w.x[4], w.x[5]}; }
  [[nodiscard]] Ball size() const { return sqrt(Ball(dot(v, v))); }  ///< |v|
  [[nodiscard]] Ball angle() const { return Ball(2) * value(Function::kAtan, size() / Ball(c)); }
};

Matrix3<MeanValueForm> rotation_of(const Waypoint& pose) {
  const auto constant = [&](std::size_t j) { return MeanValueForm(Ball(pose.x[j])); };
  return rotation({constant(3), constant(4), constant(5), constant(6)});
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

  /// The pose at z.
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
  const LengthControlled machine_;
  Ball position_;  ///< r_p
  Ball turn_;      ///< r_u
};

const NearZero& near(const Box& box) {
  if (!box.near) throw std::logic_error("a box without the place of its implied motion");
  return *box.near;
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
  const OnConstraints motion(problem, path, k, box);
  if (motion.unknowns() == 0) return motion.parameters({});
  return motion.parameters(only_zero(motion, Ball(path.tubes.at(k)), near(box)));
}

Frame forward_kinematics(const LengthControlled& machine, const NearZero& near) {
  const ForwardKinematics motion(machine);
  return motion.pose(only_zero(motion, Ball(1), near));
}

Frame pose_at(const LengthControlled& machine, const Vector6<MeanValueForm>& z) {
  return ForwardKinematics(machine).pose(z);
}

LengthControlled length_controlled(const Machine& machine, const Path& path, std::size_t k, const Box& box,
                                   const Box& within) {
  const std::span<const Waypoint> controls = path.controls(k);
  LengthControlled result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.lengths[i] = form(over(mixed(controls, [&](const Waypoint& w) { return w.x[7 + i]; }), box));
    for (std::size_t c = 0; c < 3; ++c) {
      result.base[i][c] = MeanValueForm(machine.base[i][c]);
      result.platform[i][c] = MeanValueForm(machine.platform[i][c]);
    }
  }
  // The reference is a polyline from waypoint to waypoint through the inner poses.
  const std::vector<InnerPose>& inner = path.inner_poses.at(k);
  const auto end_pose = [](int s, const Waypoint& waypoint, const PoseTube& tube) {
    InnerPose pose{s, {}, tube};
    std::copy_n(waypoint.x.begin(), pose.x.size(), pose.x.begin());
    return pose;
  };
  const auto next = std::ranges::upper_bound(inner, within.begin, {}, &InnerPose::s);
  const InnerPose first =
      next == inner.begin() ? end_pose(0, controls.front(), path.pose_tubes.at(k)) : *std::prev(next);
  const InnerPose last = next == inner.end() ? end_pose(1, controls.back(), {}) : *next;
  if (within.end > last.s || box.begin < within.begin || box.end > within.end)
    throw std::logic_error("a box that reaches across an inner pose");
  result.reference = reference_line(first, last, box);
  result.tube = first.tube;
  return result;
}

Frame geodesic(std::span<const Waypoint> controls, const Box& box) {
  const auto position = [&](std::size_t i) {
    return form(over(mixed(controls, [i](const Waypoint& w) { return w.x[i]; }), box));
  };
  Frame result{{position(0), position(1), position(2)}, rotation_of(controls.front())};
  const RelativeTurn turn(controls);
  if (dot(turn.v, turn.v) == 0) return result;
  result.R = multiply(result.R, rotation_about(turn.v, turn.angle() * form(over({0, 1}, box))));
  return result;
}

Vector3<Ball> geodesic_turn(std::span<const Waypoint> controls) {
  const RelativeTurn turn(controls);
  if (dot(turn.v, turn.v) == 0) return {};
  const Vector3<Ball> in_first = turn.angle() / turn.size() * balls(turn.v);
  return multiply(range(rotation_of(controls.front())), in_first);
}

Frame reference_line(const InnerPose& begin, const InnerPose& end, const Box& box) {
  const auto number = [&](std::size_t j) {
    const mpq_class first(begin.x[j]);
    const mpq_class slope = (mpq_class(end.x[j]) - first) / (end.s - begin.s);
    return form(over({first - slope * begin.s, slope}, box));
  };
  return {{number(0), number(1), number(2)}, rotation({number(3), number(4), number(5), number(6)})};
}

Geometry commanded_geometry(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                            const Box& box, Ranges ranges) {
  if (path.law == Law::kGeodesic) return machine.geometry(geodesic(path.controls(k), box));
  if (path.law == Law::kCableLengths) {
    const LengthControlled controlled = length_controlled(machine, path, k, box, box);
    Geometry result = machine.geometry(forward_kinematics(controlled, near(box)));
    result.length = controlled.lengths;
    return result;
  }
  const std::vector<MeanValueForm> at = parameters(problem, path, k, box);
  // Between waypoints inside their ranges parameters stay inside, by convexity; those of an implied motion need not.
  if (!problem.constraints.empty() && ranges == Ranges::kRequired) require_in_range(problem, at);
  return machine.geometry(frame(problem, coordinates(problem, at)));
}

std::unique_ptr<Equations> motion_equations(const Machine& machine, const Problem& problem, const Path& path,
                                            std::size_t k, const Box& box) {
  if (path.law == Law::kCableLengths) return motion_equations(length_controlled(machine, path, k, box, box));
  return std::make_unique<OnConstraints>(problem, path, k, box);
}

std::unique_ptr<Equations> motion_equations(const LengthControlled& machine) {
  return std::make_unique<ForwardKinematics>(machine);
}

}  // namespace taut::checker
