// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/soundness/body_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "tests/soundness/limits.h"

namespace taut::campaign {
namespace {

PointText text(const Vec<double>& x) { return {decimal(x[0]), decimal(x[1]), decimal(x[2])}; }

double log_uniform(Random& random, double low, double high) { return std::pow(10.0, uniform(random, low, high)); }

Vec<double> in_cube(Random& random, double size) {
  return {size * uniform(random, -1, 1), size * uniform(random, -1, 1), size * uniform(random, -1, 1)};
}

Vec<double> direction(Random& random) {
  const Vec<double> v = in_cube(random, 1);
  return (1 / (1e-3 + std::sqrt(dot(v, v)))) * v;
}

HullText box(const Vec<double>& half, double radius) {
  HullText hull{{}, decimal(radius)};
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec<double> x = half;
    for (std::size_t k = 0; k < 3; ++k) x[k] *= (corner >> k & 1U) != 0 ? 1 : -1;
    hull.points_m.push_back(text(x));
  }
  return hull;
}

/// A ball, a capsule, a box, often a flat one, any polytope, or hardly more than a point.
HullText random_hull(Random& random, double extent) {
  const double radius = one_in(random, 3) ? 0 : extent * log_uniform(random, -3, -0.3);
  HullText hull{{}, decimal(radius)};
  switch (random() % 5) {
    case 0: hull.points_m.push_back(text({0, 0, 0})); break;
    case 1: hull.points_m = {text(in_cube(random, extent)), text(in_cube(random, extent))}; break;
    case 2: {
      Vec<double> half{extent * uniform(random, 0.2, 1), extent * uniform(random, 0.2, 1), extent};
      if (one_in(random, 3)) half[random() % 3] *= log_uniform(random, -6, -1);
      return box(half, radius);
    }
    case 3: {
      const std::uint64_t points = 3 + random() % 5;
      for (std::uint64_t k = 0; k < points; ++k) hull.points_m.push_back(text(in_cube(random, extent)));
      break;
    }
    default: hull = {{text({0, 0, 0})}, decimal(one_in(random, 2) ? 0 : extent * log_uniform(random, -9, -3))}; break;
  }
  return hull;
}

BodyText random_body(Random& random, const std::string& name, const Vec<double>& at, HullText hull) {
  BodyText body{.name = name, .shape = std::move(hull)};
  body.at_m = text(at);
  if (!one_in(random, 3)) {
    for (ExpressionText& angle : body.rotation_rad) angle = fmt::format("{:.6f}", uniform(random, -3.2, 3.2));
  }
  return body;
}

/// Of points, from the body's origin.
double reach(const HullText& hull) {
  double square = 0;
  for (const PointText& x : hull.points_m) {
    const Vec<double> v{number<double>(x[0]), number<double>(x[1]), number<double>(x[2])};
    square = std::max(square, dot(v, v));
  }
  return std::sqrt(square) + number<double>(hull.radius_m);
}

BodyText obstacle(Random& random, const std::string& name, double size, const Vec<double>& near, double apart) {
  const Vec<double> away = direction(random);
  if (one_in(random, 5)) {
    BodyText body{.name = name, .shape = HalfSpaceText{text(log_uniform(random, -2, 2) * away)}};
    body.at_m = text(near - (apart + size * log_uniform(random, -4, 0)) * away);
    return body;
  }
  const HullText hull = random_hull(random, size * log_uniform(random, -2, -0.3));
  const double far = apart + reach(hull) + size * log_uniform(random, -4, -0.5);
  return random_body(random, name, near + far * away, hull);
}

/// A plate about a point.
BodyText plate(Random& random, double size, const Vec<BigFloat>& at) {
  const double thickness = size * log_uniform(random, -13, -4);
  BodyText body =
      random_body(random, "wall", {0, 0, 0},
                  box({size * uniform(random, 0.02, 0.3), size * uniform(random, 0.02, 0.3), 0.5 * thickness}, 0));
  for (std::size_t k = 0; k < 3; ++k) body.at_m[k] = decimal(at[k]);
  return body;
}

/// The first point of the platform's body, or a point of a cable.
template <class S>
Vec<S> moving_point(const BodiesText& bodies, const KnownContact& contact, double share, const Machine<S>& machine,
                    const RigidPose<S>& pose) {
  const bool is_cable = contact.kind == PairClass::kCablesObstacles;
  const PairClass kind = is_cable ? PairClass::kCablesCables : PairClass::kCablesPlatform;
  const std::size_t other = is_cable ? (contact.first + 1) % kCables : contact.first;
  const auto solids = Scene<S>(bodies).at({kind, is_cable ? contact.first : 0, other, "0"}, machine, pose);
  const auto& points = solids[is_cable ? 0 : 1].points;
  return is_cable ? points[0] + S(share) * (points[1] - points[0]) : points[0];
}

}  // namespace

void choose_load(Trial& trial, const RigidPose<double>& middle, Random& random) {
  LoadText& load = trial.problem.load;
  const double force = std::abs(number<double>(load.wrench[2]));
  if (!load.items.empty() || one_in(random, 4) || !(force > 0)) return;
  const Geometry<double> at = geometry(make_machine<double>(trial.problem), middle);
  Six<double> wrench{};
  for (std::size_t i = 0; i < kCables; ++i) {
    const double f = force * uniform(random, 0.5, 1.5);
    for (std::size_t k = 0; k < 6; ++k) wrench[k] += f * at.transposed_jacobian[i][k];
  }
  const Vec<double> moment = cross(at.load_point, Vec<double>{wrench[0], wrench[1], wrench[2]});
  for (std::size_t k = 0; k < 3; ++k) wrench[3 + k] -= moment[k];
  for (std::size_t k = 0; k < 6; ++k) load.wrench[k] = decimal(wrench[k]);
}

std::optional<KnownContact> choose_bodies(Trial& trial, const Motion<double>& approx, const Motion<BigFloat>& exact,
                                          double shortest, bool wall, Random& random) {
  BodiesText bodies;
  for (std::size_t i = 0; i < kCables; ++i) {
    bodies.cables.diameter_m[i] = one_in(random, 4) ? "0" : decimal(trial.size * log_uniform(random, -5, -1.5));
    for (DecimalText& end : bodies.cables.free_ends_m[i]) {
      end = one_in(random, 4) ? "0" : decimal(shortest * log_uniform(random, -3, -0.5));
    }
  }
  for (auto& clearance : bodies.clearance_m) clearance = "0";
  const std::uint64_t carried = random() % 3;
  for (std::uint64_t k = 0; k < carried; ++k) {
    bodies.platform.push_back(random_body(random, fmt::format("part {}", k + 1), in_cube(random, 0.3 * trial.size),
                                          random_hull(random, trial.size * log_uniform(random, -2, -0.7))));
  }
  const auto about = [&] {
    const bool is_cable = bodies.platform.empty() || one_in(random, 2);
    const double s = one_in(random, 8) ? 0 : one_in(random, 8) ? 1 : uniform(random, 0, 1);
    return KnownContact{is_cable ? PairClass::kCablesObstacles : PairClass::kPlatformObstacles,
                        random() % (is_cable ? kCables : bodies.platform.size()), 0, s};
  };
  const std::uint64_t obstacles = wall ? random() % 2 : 1 + random() % 3;
  for (std::uint64_t k = 0; k < obstacles; ++k) {
    const KnownContact near = about();
    const auto pose = approx.commanded(near.s, Deviation());
    if (!pose) continue;
    const double apart = near.kind == PairClass::kCablesObstacles
                             ? 0.5 * number<double>(bodies.cables.diameter_m[near.first])
                             : 2 * reach(std::get<HullText>(bodies.platform[near.first].shape));
    const Vec<double> point =
        moving_point<double>(bodies, near, uniform(random, 0, 1), approx.machine(Deviation()), *pose);
    bodies.obstacles.push_back(obstacle(random, fmt::format("thing {}", k + 1), trial.size, point, apart));
  }
  for (std::size_t i = 0; i < kCables && one_in(random, 2); ++i) {  // about where the cable points somewhere
    ExitConeText cone;
    cone.cable = i;
    cone.end = one_in(random, 2) ? CableEnd::kBase : CableEnd::kPlatform;
    const auto pose = approx.commanded(uniform(random, 0, 1), Deviation());
    if (!pose) continue;
    const Machine<double> machine = approx.machine(Deviation());
    Vec<double> d = pose->p + pose->r * machine.b[i] - machine.a[i];
    if (cone.end == CableEnd::kPlatform) {
      const Vec<double> of_base = d;
      for (std::size_t k = 0; k < 3; ++k) {
        d[k] = -(pose->r[0][k] * of_base[0] + pose->r[1][k] * of_base[1] + pose->r[2][k] * of_base[2]);
      }
    }
    const double size = std::sqrt(dot(d, d)) * log_uniform(random, -2, 0);
    for (std::size_t k = 0; k < 3; ++k) cone.axis[k] = decimal(d[k] + size * uniform(random, -1, 1));
    cone.half_angle_rad = fmt::format("{:.6f}", uniform(random, 0.1, 1.5));
    bodies.exit_cones.push_back(cone);
  }
  std::optional<KnownContact> known;
  if (wall) {
    known = about();
    known->second = bodies.obstacles.size();
    const auto pose = exact.commanded(BigFloat(known->s), Deviation());
    if (!pose) return std::nullopt;
    bodies.obstacles.push_back(
        plate(random, trial.size,
              moving_point<BigFloat>(bodies, *known, uniform(random, 0.02, 0.98), exact.machine(Deviation()), *pose)));
  }
  trial.problem.bodies = bodies;
  return known;
}

}  // namespace taut::campaign
