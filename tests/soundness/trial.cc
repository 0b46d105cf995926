// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/soundness/trial.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinematics/motion_length.h"
#include "kinematics/pose_conversion.h"
#include "tests/support/linear_system.h"
#include "tests/support/robots.h"

namespace taut::campaign {
namespace {

DecimalText decimal(double x) { return fmt::format("{:.6e}", x); }

/// The pose of a space in either scalar, from one generic function.
template <class F>
void set_pose(Trial& trial, F pose) {
  trial.pose = [pose](const Vector& q) { return pose(q); };
  trial.pose_approx = [pose](const std::vector<double>& q) { return pose(q); };
}

template <class S>
S pi() {
  if constexpr (std::is_same_v<S, double>) {
    return 3.14159265358979323846;
  } else {
    return oracle::pi();
  }
}

const auto slice_pose = []<class S>(const std::vector<S>& q) {
  return Six<S>{S(0.0), S(0.0), number<S>("0.35"), q[0], q[1], S(34.0) * pi<S>() / S(180.0)};
};

const auto sphere_pose = []<class S>(const std::vector<S>& q) {
  const S rs = number<S>("0.13");
  const S ring = rs * cosine(q[1]);
  return Six<S>{ring * cosine(q[0]), ring * sine(q[0]),       number<S>("0.306") - rs * sine(q[1]),
                q[0] - pi<S>(),      pi<S>() / S(2.0) - q[1], S(0.0)};
};

const auto five_coordinates = []<class S>(const std::vector<S>& q) {
  return Six<S>{q[0], q[1], q[2], q[3], q[4], S(0.0)};
};

const auto turned_coordinates = []<class S>(const std::vector<S>& q) {
  return Six<S>{q[0], q[1], q[2], q[3], S(0.0), S(0.0)};
};

const auto six_coordinates = []<class S>(const std::vector<S>& q) {
  return Six<S>{q[0], q[1], q[2], q[3], q[4], q[5]};
};

// ---- Robots ---------------------------------------------------------------------------------------------------------

/// Millimetres to kilometres, millinewtons to meganewtons; one in eight nearly flat, one in eight with a platform that
/// is nearly the base on a smaller scale, which is singular wherever both are level.
Problem random_robot(Random& random, double& size) {
  static const Problem like = testing::free_flying(testing::robot1_slice());
  Problem problem = like;
  size = std::pow(10.0, uniform(random, -3, 3));
  const double force = std::pow(10.0, uniform(random, -3, 6));
  const std::uint64_t kind = random() % 8;
  const double spread = kind == 0 ? std::pow(10.0, uniform(random, -6, -1)) : 0.3;
  const bool similar = kind == 1;
  const double difference = std::pow(10.0, uniform(random, -4, -1));
  const double ratio = uniform(random, 0.3, 0.7);
  for (std::size_t i = 0; i < kCables; ++i) {
    const double base_angle = 2.094395 * std::floor(static_cast<double>(i) / 2) + uniform(random, -spread, spread);
    const double platform_angle =
        similar ? base_angle + uniform(random, -difference, difference)
                : 1.047197 + 2.094395 * std::floor((static_cast<double>(i) + 1) / 2) + uniform(random, -spread, spread);
    const double base_radius = size * uniform(random, 0.8, 1.2);
    const double platform_radius = similar ? ratio * base_radius : size * uniform(random, 0.3, 0.7);
    const auto anchor = [&](double radius, double angle) {
      return std::array<DecimalText, 3>{decimal(radius * std::cos(angle)), decimal(radius * std::sin(angle)),
                                        decimal(size * uniform(random, -spread, spread))};
    };
    problem.robot.base_anchors_m[i] = anchor(base_radius, base_angle);
    problem.robot.platform_anchors_m[i] = anchor(platform_radius, platform_angle);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    problem.load.point_m[k] = decimal(size * uniform(random, -0.2, 0.2));
    problem.load.wrench[k] = decimal(force * (k == 2 ? 1.0 : uniform(random, -0.1, 0.1)));
    problem.load.wrench[3 + k] = decimal(force * size * uniform(random, -0.02, 0.02));
  }
  // E = G G^T + diagonal, in units of the load: semi-axes about a hundredth of it.
  std::array<std::array<double, 6>, 6> g{};
  for (auto& row : g) {
    for (double& x : row) x = uniform(random, -0.3, 0.3);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = i == j ? 1.0 : 0.0;
      for (std::size_t k = 0; k < 6; ++k) sum += g[i][k] * g[j][k];
      const double unit = (i < 3 ? force : force * size) * (j < 3 ? force : force * size);
      (*problem.load.ellipsoid)[i][j] = (*problem.load.ellipsoid)[j][i] = decimal(1e4 * sum / unit);
    }
  }
  return problem;
}

/// Pairs of cables with one anchor, as in an octahedral machine: at the base 1 and 2, 3 and 4, 5 and 6; at the platform
/// 2 and 3, 4 and 5, 6 and 1.
void share_anchors(Problem& problem, Random& random) {
  for (std::size_t k = 0; k < kCables; k += 2) {
    if (one_in(random, 2)) problem.robot.base_anchors_m[k + 1] = problem.robot.base_anchors_m[k];
    if (one_in(random, 2)) {
      problem.robot.platform_anchors_m[(k + 2) % kCables] = problem.robot.platform_anchors_m[k + 1];
    }
  }
}

// ---- Loads ----------------------------------------------------------------------------------------------------------

RationalVector random_vector(Random& random, double size) {
  RationalVector v;
  for (RationalText& x : v) x = one_in(random, 4) ? RationalText("0") : decimal(size * uniform(random, -1, 1));
  return v;
}

/// Not 0, of any length; often an axis.
RationalVector random_direction(Random& random) {
  RationalVector v{"0", "0", "0"};
  if (one_in(random, 2)) v = random_vector(random, std::pow(10.0, uniform(random, -3, 3)));
  v[random() % 3] = one_in(random, 2) ? "1" : decimal(uniform(random, 0.1, 2));
  return v;
}

VectorSet random_set(Random& random, double size) {
  const RationalText radius = one_in(random, 16) ? RationalText("0") : decimal(size * uniform(random, 0.1, 1));
  switch (random() % 3) {
    case 0: return BallOfVectors{radius};
    case 1: return DiscOfVectors{radius, random_direction(random)};
    default: break;
  }
  const double from = uniform(random, -1, 1);
  const double length = one_in(random, 8) ? 0 : uniform(random, 0, 1);
  return SegmentOfVectors{random_direction(random), decimal(size * from), decimal(size * (from + length))};
}

/// K as a sum of one to six items, with about the weight that the robot was made for, now and then beside its
/// ellipsoid. Their tolerances are their own.
void choose_items(Trial& trial, Random& random) {
  LoadText& load = trial.problem.load;
  const double force = std::abs(number<double>(load.wrench[2]));
  const double spread = std::pow(10.0, uniform(random, -4, -1));
  const auto axes = [&] { return one_in(random, 2) ? Axes::kWorld : Axes::kPlatform; };
  const auto at = [&] { return random_vector(random, 0.3 * trial.size); };
  for (RationalText& g : load.gravity_m_s2) g = decimal(uniform(random, -0.5, 0.5));
  load.gravity_m_s2[2] = decimal(9.81);
  const double mass = force / 9.81;
  const std::uint64_t count = 1 + random() % 6;
  for (std::uint64_t n = 0; n < count; ++n) {
    LoadItem& item = load.items.emplace_back();
    item.name = fmt::format("item {}", n + 1);
    const std::uint64_t kind = n == 0 ? 0 : random() % 4;
    if (kind == 0) {
      const double m = n == 0 ? mass : mass * uniform(random, 0, 0.3);
      const double off = one_in(random, 3) ? 0 : spread * uniform(random, 0, 1);
      const RationalText reach = one_in(random, 3) ? RationalText("0") : decimal(trial.size * spread);
      item.what = Weight{decimal(m * (1 - off)), decimal(m * (1 + off)), at(), reach};
    } else if (kind == 1) {
      item.what = Force{random_set(random, spread * force), axes(), at()};
    } else if (kind == 2) {
      item.what = Moment{random_set(random, spread * force * trial.size), axes()};
    } else {
      LoadCases cases;
      const std::uint64_t wrenches = 1 + random() % 4;
      for (std::uint64_t j = 0; j < wrenches; ++j) {
        auto& w = cases.wrenches.emplace_back();
        for (std::size_t k = 0; k < 6; ++k) {
          w[k] = decimal(spread * force * (k < 3 ? 1 : trial.size) * uniform(random, -1, 1));
        }
      }
      cases.axes = axes();
      cases.at = at();
      item.what = cases;
    }
  }
  if (trial.problem.tolerances) {
    trial.problem.tolerances->load_point_m = "0";
    trial.problem.tolerances->wrench.fill("0");
  }
  if (one_in(random, 4)) {
    for (std::size_t k = 0; k < 6; ++k) load.wrench[k] = decimal(0.01 * number<double>(load.wrench[k]));
  } else {
    load.ellipsoid.reset();
    load.wrench.fill("0");
  }
}

// ---- Spaces ---------------------------------------------------------------------------------------------------------

/// Robot 2 with its z axis through a fixed point, given by three constraints on five parameters (the paper's (16),
/// implicitly).
Problem implicit_sphere() {
  Problem problem = testing::robot2_sphere();
  problem.space = SpaceText{};
  for (const char* name : {"px", "py", "pz", "phi", "theta"}) {
    const bool periodic = std::string(name) == "phi";
    problem.space.parameters.push_back({name, periodic ? ParameterKind::kPeriodic : ParameterKind::kReal, "", ""});
  }
  problem.space.pose = {"px", "py", "pz", "phi", "theta", "0"};
  problem.space.constraints = {"px + 0.13*sin(theta)*cos(phi)", "py + 0.13*sin(theta)*sin(phi)",
                               "pz - 0.306 + 0.13*cos(theta)"};
  return problem;
}

OracleConstraints implicit_sphere_oracle() {
  const auto r = [] { return oracle::big("0.13"); };
  return {[r](const Vector& q) {
            const BigFloat ring = r() * oracle::sine(q[4]);
            return Vector{q[0] + ring * oracle::cosine(q[3]), q[1] + ring * oracle::sine(q[3]),
                          q[2] - oracle::big("0.306") + r() * oracle::cosine(q[4])};
          },
          [r](const Vector& q) {
            const BigFloat zero(0.0);
            const BigFloat one(1.0);
            const BigFloat c = oracle::cosine(q[3]);
            const BigFloat s = oracle::sine(q[3]);
            const BigFloat ring = r() * oracle::sine(q[4]);
            const BigFloat rise = r() * oracle::cosine(q[4]);
            return std::vector<Vector>{{one, zero, zero, -ring * s, rise * c},
                                       {zero, one, zero, ring * c, rise * s},
                                       {zero, zero, one, zero, -ring}};
          }};
}

/// p on a sphere about the origin through the first waypoint (up to six digits); orientation free.
void put_on_sphere(Trial& trial) {
  const std::vector<double>& x = trial.controls[0].parameters().x;
  const DecimalText square = decimal(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
  trial.problem.space.constraints = {"px^2 + py^2 + pz^2 - " + square};
  trial.constraints = OracleConstraints{
      [square](const Vector& q) { return Vector{q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - oracle::big(square)}; },
      [](const Vector& q) {
        const BigFloat two(2.0);
        const BigFloat zero(0.0);
        return std::vector<Vector>{{two * q[0], two * q[1], two * q[2], zero, zero, zero}};
      }};
}

/// Next to the constraints, as a planner would put it, but not on them; with normals.
void bring_near(const ConstraintFunctions& functions, Waypoint& waypoint, Random& random) {
  waypoint.parameters().normals = functions.normals(waypoint);
  const double distance = std::pow(10.0, uniform(random, -12, -2));
  const std::vector<double> on = functions.parameters(Segment::straight(waypoint, waypoint), 0);
  for (std::size_t j = 0; j < on.size(); ++j)
    waypoint.parameters().x[j] = on[j] + distance * (waypoint.parameters().x[j] - on[j]);
  waypoint.parameters().normals = functions.normals(waypoint);
}

/// Control points 1, 2, 3 by random steps from point 0, in proportion to `scale`.
void walk(Trial& trial, Random& random, const std::vector<double>& scale) {
  const double step = one_in(random, 8) ? 0.15 * std::pow(10.0, uniform(random, -6, 0)) : 0.15;
  trial.controls[0].parameters().half_turns.assign(trial.controls[0].parameters().x.size(), 0);
  for (std::size_t k = 1; k < 4; ++k) {
    trial.controls[k] = trial.controls[k - 1];
    if (one_in(random, 16)) continue;  // control points may be equal
    for (std::size_t j = 0; j < scale.size(); ++j)
      trial.controls[k].parameters().x[j] += step * scale[j] * uniform(random, -1, 1);
  }
}

std::vector<double> random_coordinates(Random& random, double size) {
  std::vector<double> q;
  for (int k = 0; k < 2; ++k) q.push_back(size * uniform(random, -0.4, 0.4));
  q.push_back(size * uniform(random, 0.7, 2.0));
  q.push_back(uniform(random, -3.2, 3.2));
  q.push_back(uniform(random, 0.0, 0.6));
  q.push_back(uniform(random, -0.5, 0.5));
  return q;
}

/// Free coordinates with other angles than tilt and torsion. Some begin where two of these turn about one axis.
void choose_angles(Trial& trial, Random& random, bool constrained) {
  const std::vector<ExpressionText> constraints = trial.problem.space.constraints;
  AnglesText angles{random() % 2 == 0 ? AngleKind::kRollPitchYaw : AngleKind::kZyz};
  if (!constrained && one_in(random, 3)) {
    angles.kind = AngleKind::kAxis;
    const double length = std::pow(10.0, uniform(random, -3, 3));
    for (DecimalText& x : angles.axis) x = one_in(random, 3) ? "0" : decimal(length * uniform(random, -1, 1));
    if (std::ranges::count(angles.axis, "0") == 3) angles.axis[2] = "-1";
    for (Waypoint& waypoint : trial.controls) {
      waypoint.parameters().x.resize(4);
      waypoint.parameters().half_turns.resize(4);
    }
    set_pose(trial, turned_coordinates);
  } else if (one_in(random, 4)) {
    const double locked = angles.kind == AngleKind::kRollPitchYaw ? 0x1.921fb54442d18p+0 : 0;
    const double shift = locked - trial.controls[0].parameters().x[4];
    for (Waypoint& waypoint : trial.controls) waypoint.parameters().x[4] += shift;
  }
  trial.problem.space = coordinate_space(angles);
  trial.problem.space.constraints = constraints;
  trial.problem.query.clear();
}

void choose_space(Trial& trial, Random& random, bool constrained) {
  static const Problem slice = testing::robot1_slice();
  static const Problem sphere = testing::robot2_sphere();
  static const Problem on_sphere = implicit_sphere();
  std::vector<double>& from = trial.controls[0].parameters().x;
  const std::uint64_t kind = random() % 6;
  if (constrained && kind < 3) {
    trial.problem = on_sphere;
    const double phi = uniform(random, -3.2, 3.2);
    const double theta = uniform(random, 0.1, 2.0);
    from = {-0.13 * std::sin(theta) * std::cos(phi), -0.13 * std::sin(theta) * std::sin(phi),
            0.306 - 0.13 * std::cos(theta), phi, theta};
    walk(trial, random, {0.01, 0.01, 0.01, 1, 1});
    trial.constraints = implicit_sphere_oracle();
    set_pose(trial, five_coordinates);
  } else if (!constrained && kind == 0) {
    trial.problem = slice;
    from = {uniform(random, -3.2, 3.2), uniform(random, -0.2, 2.0)};
    walk(trial, random, {1, 1});
    set_pose(trial, slice_pose);
  } else if (!constrained && kind == 1) {
    trial.problem = sphere;
    from = {uniform(random, -3.2, 3.2), uniform(random, -0.5, 1.1)};  // a spline's points stay below pi/2
    walk(trial, random, {1, 1});
    set_pose(trial, sphere_pose);
  } else {
    trial.problem = random_robot(random, trial.size);
    if (trial.shares_anchors) share_anchors(trial.problem, random);
    from = random_coordinates(random, trial.size);
    walk(trial, random, {trial.size, trial.size, trial.size, 1, 1, 1});
    set_pose(trial, six_coordinates);
    if (constrained) put_on_sphere(trial);
    if (one_in(random, 2)) choose_angles(trial, random, constrained);
    return;
  }
  trial.size = 0.3;
}

// ---- Laws between poses ---------------------------------------------------------------------------------------------

Quaternion<double> product(const Quaternion<double>& a, const Quaternion<double>& b) {
  const Vec<double> u{a[0], a[1], a[2]};
  const Vec<double> v{b[0], b[1], b[2]};
  const Vec<double> w = a[3] * v + b[3] * u + cross(u, v);
  return {w[0], w[1], w[2], a[3] * b[3] - dot(u, v)};
}

/// Quaternions of any length and sign; steps from none to nearly half a turn, mostly a tenth of a radian.
void choose_poses(Trial& trial, Random& random) {
  trial.problem = random_robot(random, trial.size);
  if (trial.shares_anchors) share_anchors(trial.problem, random);
  trial.problem.space = coordinate_space();
  trial.problem.query.clear();
  const auto direction = [&] {
    Vec<double> v{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    return (1 / (1e-3 + std::sqrt(dot(v, v)))) * v;
  };
  const auto about = [&](const Vec<double>& axis, double angle) {
    const double s = std::sin(angle / 2);
    return Quaternion<double>{s * axis[0], s * axis[1], s * axis[2], std::cos(angle / 2)};
  };
  const std::vector<double> q = random_coordinates(random, trial.size);
  const Vec<double> vertical{0, 0, 1};
  Quaternion<double> turned = product(about({-std::sin(q[3]), std::cos(q[3]), 0}, q[4]), about(vertical, q[5]));
  std::vector<double> x = {q[0], q[1], q[2]};
  // Positions step by a tenth of the robot. Poses held by lengths are known to be single for steps of its hundredth
  // only.
  const double usual = trial.law == Law::kGeodesic ? 1 : std::pow(10.0, uniform(random, -3, 0));
  const double step = one_in(random, 8) ? std::pow(10.0, uniform(random, -12, 0)) : usual;
  const auto random_length = [&] {
    return (one_in(random, 2) ? 1 : -1) * std::pow(10.0, one_in(random, 4) ? uniform(random, -3, 3) : 0);
  };
  double length = random_length();
  for (std::size_t k = 0; k < 2; ++k) {
    // Under the law of lengths another length or sign makes another reference, the wrong one.
    if (trial.law == Law::kGeodesic || (trial.has_bad_reference && one_in(random, 4))) length = random_length();
    PoseNumbers pose = {x[0], x[1], x[2]};
    for (std::size_t i = 0; i < 4; ++i) pose[3 + i] = length * turned[i];
    trial.controls[k] = PosePoint{pose};
    for (double& c : x) c += step * 0.1 * trial.size * uniform(random, -1, 1);
    const double angle = one_in(random, 12) ? uniform(random, 0, 2.5) : one_in(random, 8) ? 0 : uniform(random, 0, 0.2);
    turned = product(turned, about(direction(), step * angle));
  }
  set_pose(trial, six_coordinates);
}

/// Lengths near those of the poses; of a bad reference, which are left as they were.
void choose_lengths(Trial& trial, Random& random) {
  const Machine<double> machine = make_machine<double>(trial.problem);
  const Model<double> model = make_model<double>(trial.problem);
  const double error = one_in(random, 2) ? 0 : std::pow(10.0, uniform(random, -9, -3));
  for (std::size_t k = 0; k < 2; ++k) {
    PoseNumbers x = trial.controls[k].pose();
    std::array<double, kCables> wanted = lengths(machine, mixed(x, x, 0.0));
    for (double& length : wanted) length *= 1 + error * uniform(random, -1, 1);
    if (!trial.has_bad_reference) {
      // As a table of lengths is read: the pose to which they lead from that before.
      const auto pose = pose_of_lengths(model, wanted, taut::rigid_pose(trial.controls[0].pose()));
      if (pose) {
        x = pose_numbers(*pose);
      } else if (k == 0) {
        trial.has_bad_reference = true;  // next to a singular pose nothing near need have these lengths
      } else {
        trial.has_lost_row = true;
      }
    }
    trial.controls[k] = LengthsPoint{x, wanted};
  }
}

// ---- Tolerances -----------------------------------------------------------------------------------------------------

void choose_tolerances(Trial& trial, Random& random) {
  if (trial.tolerances == ToleranceKind::kNone) return;
  TolerancesText& t = trial.problem.tolerances.emplace();
  const auto has = [&](ToleranceKind kind) {
    return trial.tolerances == kind || (trial.tolerances == ToleranceKind::kTogether && !one_in(random, 4));
  };
  const double fraction = std::pow(10.0, uniform(random, -9, -3));
  const auto distance = [&] {
    return one_in(random, 8) ? DecimalText("0") : decimal(trial.size * fraction * uniform(random, 0.1, 1));
  };
  if (has(ToleranceKind::kAnchors)) {
    for (std::size_t i = 0; i < kCables; ++i) {
      t.base_anchor_m[i] = distance();
      t.platform_anchor_m[i] = distance();
    }
  }
  if (has(ToleranceKind::kLoad)) {
    t.load_point_m = distance();
    const double force = std::abs(number<double>(trial.problem.load.wrench[2]));
    for (std::size_t k = 0; k < 6; ++k) {
      t.wrench[k] = decimal(force * (k < 3 ? 1 : trial.size) * fraction * uniform(random, -1, 1));
    }
  }
  if (has(ToleranceKind::kTracking)) {
    t.position_m = distance();
    t.orientation_rad = one_in(random, 8) ? "0" : decimal(fraction * uniform(random, 0.1, 1));
  }
  if (has(ToleranceKind::kCables)) {
    t.cable_length_m.emplace();
    for (DecimalText& length : *t.cable_length_m) length = distance();
  }
}

// ---- Motion ---------------------------------------------------------------------------------------------------------

/// The segment's mix at s of what `value` reads from the control points.
template <class F>
BigFloat mix(const Trial& trial, const BigFloat& t, F value) {
  const BigFloat u = BigFloat(1.0) - t;
  if (trial.interpolation == Interpolation::kStraight)
    return u * value(trial.controls[0]) + t * value(trial.controls[1]);
  const BigFloat three(3.0);
  const BigFloat four(4.0);
  const BigFloat six(6.0);
  const BigFloat t2 = t * t;
  const BigFloat t3 = t2 * t;
  return (u * u * u * value(trial.controls[0]) + (three * t3 - six * t2 + four) * value(trial.controls[1]) +
          (three * t2 - three * t3 + three * t + BigFloat(1.0)) * value(trial.controls[2]) +
          t3 * value(trial.controls[3])) /
         six;
}

Vector parameters_at(const Trial& trial, const BigFloat& s) {
  Vector q;
  const std::size_t m = trial.controls[0].parameters().x.size();
  for (std::size_t j = 0; j < m; ++j)
    q.push_back(mix(trial, s, [&](const Waypoint& w) { return BigFloat(w.parameters().x[j]); }));
  if (!trial.constraints) return q;
  const std::size_t k = trial.problem.space.constraints.size();
  std::vector<Vector> normals(m);
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t i = 0; i < k; ++i) {
      normals[j].push_back(
          mix(trial, s, [&](const Waypoint& w) { return BigFloat(w.parameters().normals[j * k + i]); }));
    }
  }
  constexpr int kNewtonSteps = 9;  // doubling some 3 digits
  for (int step = 0; step < kNewtonSteps; ++step) {
    const std::vector<Vector> gradients = trial.constraints->gradients(q);
    std::vector<Vector> g_y(k, Vector(k));
    for (std::size_t i = 0; i < k; ++i) {
      for (std::size_t l = 0; l < k; ++l) {
        for (std::size_t j = 0; j < m; ++j) g_y[i][l] += gradients[i][j] * normals[j][l];
      }
    }
    const Vector y = testing::solve(g_y, trial.constraints->values(q));
    for (std::size_t j = 0; j < m; ++j) {
      for (std::size_t i = 0; i < k; ++i) q[j] -= normals[j][i] * y[i];
    }
  }
  return q;
}

}  // namespace

Trial make_trial(Random& random, std::optional<Law> law, std::optional<ToleranceKind> tolerances,
                 std::optional<LoadKind> loads, bool shares_anchors) {
  Trial trial;
  trial.shares_anchors = shares_anchors;
  // Half of all trials have no tolerances, and a quarter one kind of them.
  constexpr std::uint64_t kKinds = kToleranceKinds - 2;  // one at a time
  const std::uint64_t drawn = random() % (4 * kKinds);
  const ToleranceKind random_kind = drawn < 2 * kKinds   ? ToleranceKind::kNone
                                    : drawn < 3 * kKinds ? static_cast<ToleranceKind>(1 + drawn % kKinds)
                                                         : ToleranceKind::kTogether;
  const Law random_law = static_cast<Law>(random() % kLaws);
  trial.tolerances = tolerances.value_or(random_kind);
  trial.law = law.value_or(random_law);
  trial.has_bad_reference = trial.law == Law::kCableLengths && one_in(random, 6);
  switch (trial.law) {
    case Law::kStraight:
    case Law::kSpline: choose_space(trial, random, false); break;
    case Law::kImplied: choose_space(trial, random, true); break;
    case Law::kGeodesic:
    case Law::kCableLengths: choose_poses(trial, random); break;
  }
  if (trial.law == Law::kSpline || (trial.law == Law::kImplied && one_in(random, 3))) {
    trial.interpolation = Interpolation::kCubicBSpline;
  }
  if (trial.law == Law::kGeodesic) trial.interpolation = Interpolation::kGeodesic;
  if (trial.law == Law::kCableLengths) {
    trial.interpolation = Interpolation::kCableLengths;
    choose_lengths(trial, random);
  }
  if (trial.constraints) {
    const ConstraintFunctions functions(trial.problem);
    for (Waypoint& waypoint : trial.controls) bring_near(functions, waypoint, random);
  }
  choose_tolerances(trial, random);
  const LoadKind random_load = one_in(random, 2) ? LoadKind::kEllipsoid : LoadKind::kItems;
  if (loads.value_or(random_load) == LoadKind::kItems) choose_items(trial, random);
  return trial;
}

template <class S>
Motion<S>::Motion(const Trial& trial)
    : trial_(trial), machine_(make_machine<S>(trial.problem)), tolerances_(make_tolerances<S>(trial.problem)) {
  if (trial.constraints && std::is_same_v<S, double>) constraints_.emplace(trial.problem);
}

template <class S>
RigidPose<S> Motion<S>::reference(const S& s) const {
  if (trial_.law == Law::kGeodesic) return slerp(trial_.controls[0].pose(), trial_.controls[1].pose(), s);
  if (trial_.law == Law::kCableLengths) {
    PoseNumbers from = trial_.controls[0].pose(), to = trial_.controls[1].pose();
    double begin = 0;
    double end = 1;
    // Straight between the two poses next to s.
    for (const InnerPose& inner : trial_.inner_poses) {
      if (s < S(inner.s)) {
        end = inner.s;
        to = inner.x;
        break;
      }
      begin = inner.s;
      from = inner.x;
    }
    return mixed(from, to, S((s - S(begin)) / (S(end) - S(begin))));
  }
  Six<S> pose;
  if constexpr (std::is_same_v<S, double>) {
    pose = trial_.pose_approx(constraints_ ? constraints_->parameters(trial_.curve(), s)
                                           : curve_parameters(trial_.curve(), s));
  } else {
    pose = trial_.pose(parameters_at(trial_, s));
  }
  return {{pose[0], pose[1], pose[2]}, orientation(trial_.problem.space.angles, pose[3], pose[4], pose[5])};
}

template <class S>
Six<S> Motion<S>::commanded_lengths(const S& s, const Deviation& deviation) const {
  Six<S> result;
  if (trial_.law == Law::kCableLengths) {
    for (std::size_t i = 0; i < kCables; ++i) {
      result[i] = (S(1.0) - s) * S(trial_.controls[0].lengths_m()[i]) + s * S(trial_.controls[1].lengths_m()[i]);
    }
  } else {
    result = lengths(machine_, reference(s));
  }
  for (std::size_t i = 0; i < kCables; ++i) result[i] = result[i] + tolerances_.length[i] * S(deviation.length[i]);
  return result;
}

template <class S>
std::optional<RigidPose<S>> Motion<S>::commanded(const S& s, const Deviation& deviation) const {
  constexpr int kNewtonSteps = 25;
  const RigidPose<S> start = reference(s);
  if (!trial_.is_held() && !tolerances_.has_rows) return start;
  // The machine as typed is in its tube; from there the pose follows the deviation as it grows.
  std::optional<RigidPose<S>> pose = start;
  if (trial_.law == Law::kCableLengths) {
    pose = hold(machine_, start, commanded_lengths(s, Deviation()), kNewtonSteps);
  }
  if (!trial_.problem.tolerances) return pose;
  constexpr int kParts = 2;
  for (int part = 1; part <= kParts && pose; ++part) {
    Deviation scaled = deviation;
    for_each_block(scaled, [&](std::span<double> block) {
      for (double& x : block) x *= static_cast<double>(part) / kParts;
    });
    pose = hold(trial_.is_held() ? machine(scaled) : machine_, *pose, commanded_lengths(s, scaled), kNewtonSteps);
  }
  return pose;
}

template <class S>
std::optional<RigidPose<S>> Motion<S>::pose(const S& s, const Deviation& deviation) const {
  std::optional<RigidPose<S>> pose = commanded(s, deviation);
  if (!pose || !trial_.problem.tolerances) return pose;
  pose->p = pose->p + scaled(tolerances_.position, deviation.position);
  pose->r = turn(scaled(tolerances_.turn, deviation.turn)) * pose->r;
  return pose;
}

template <class S>
std::optional<StaticsAt<S>> Motion<S>::statics(const S& s, const Deviation& deviation) const {
  const std::optional<RigidPose<S>> at = pose(s, deviation);
  if (!at) return std::nullopt;
  return campaign::statics(trial_.problem.tolerances ? machine(deviation) : machine_, *at);
}

namespace {

template <class S>
Vec<S> vector(const std::array<DecimalText, 3>& text) {
  return {number<S>(text[0]), number<S>(text[1]), number<S>(text[2])};
}

}  // namespace

template <class S>
bool Motion<S>::is_within(const taut::Deviation& witness) const {
  const auto fits = [](const std::array<DecimalText, 3>& text, const S& tolerance) {
    const Vec<S> x = vector<S>(text);
    return dot(x, x) <= tolerance * tolerance;
  };
  if (witness.cable_lengths_m.has_value() != trial_.is_held()) return false;
  bool fit = fits(witness.load_point_m, tolerances_.load_point) && fits(witness.position_m, tolerances_.position) &&
             magnitude(number<S>(witness.wrench)) <= S(1.0);
  const Vec<S> u = vector<S>(witness.turn);
  fit = fit && S(2.0) * angle(root(dot(u, u)), S(1.0)) <= tolerances_.turn;
  for (std::size_t i = 0; i < kCables; ++i) {
    fit = fit && fits(witness.base_anchors_m[i], tolerances_.a[i]) &&
          fits(witness.platform_anchors_m[i], tolerances_.b[i]);
    if (witness.cable_lengths_m) {
      fit = fit && fits({(*witness.cable_lengths_m)[i], "0", "0"}, tolerances_.held[i]);
    }
  }
  return fit;
}

template <class S>
std::optional<MachineAt<S>> Motion<S>::witnessed(const S& s, const taut::Deviation& witness) const {
  std::optional<RigidPose<S>> pose = commanded(s, Deviation());
  constexpr int kParts = 16;
  constexpr int kNewtonSteps = 25;
  Machine<S> machine;
  bool last_sign = false;
  for (int part = trial_.is_held() ? 1 : kParts; part <= kParts && pose; ++part) {  // which the pose follows
    const S grown = S(static_cast<double>(part)) / S(static_cast<double>(kParts));
    machine = machine_;
    machine.load_point = machine.load_point + vector<S>(witness.load_point_m);
    Six<S> wanted = commanded_lengths(s, Deviation());
    for (std::size_t i = 0; i < kCables; ++i) {
      machine.a[i] = machine.a[i] + grown * vector<S>(witness.base_anchors_m[i]);
      machine.b[i] = machine.b[i] + grown * vector<S>(witness.platform_anchors_m[i]);
      machine.wrench[i] = machine.wrench[i] + number<S>(witness.wrench) * tolerances_.wrench[i];
      if (witness.cable_lengths_m) wanted[i] = wanted[i] + grown * number<S>((*witness.cable_lengths_m)[i]);
    }
    if (!trial_.is_held()) break;
    pose = hold(machine, *pose, wanted, kNewtonSteps);
    if (!pose) return std::nullopt;
    const bool sign = determinant(machine, *pose) > S(0.0);
    if (part > 1 && sign != last_sign) return std::nullopt;  // it has passed a singular pose
    last_sign = sign;
  }
  if (!pose) return std::nullopt;
  const Vec<S> u = vector<S>(witness.turn);
  pose->p = pose->p + vector<S>(witness.position_m);
  pose->r = rotation(Quaternion<S>{u[0], u[1], u[2], S(1.0)}) * pose->r;
  return MachineAt<S>{machine, *pose};
}

template class Motion<double>;
template class Motion<BigFloat>;

}  // namespace taut::campaign
