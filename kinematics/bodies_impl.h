// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of bodies.h.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "kinematics/geometry.h"
#include "problem/decimal.h"
#include "problem/problem.h"

namespace taut {

namespace bodies_detail {

template <class S>
Vector3<S> vector(const std::array<DecimalText, 3>& x) {
  return {ScalarTraits<S>::from_decimal(x[0]), ScalarTraits<S>::from_decimal(x[1]),
          ScalarTraits<S>::from_decimal(x[2])};
}

/// Rz(yaw) Ry(pitch) Rx(roll), if that is not typed as none.
template <class S>
std::optional<Matrix3<S>> rotation(const BodyText& body) {
  if (std::ranges::all_of(body.rotation_rad, [](const ExpressionText& x) { return x == "0"; })) return std::nullopt;
  const auto angle = [&](std::size_t k) { return evaluate_constant<S>(body.rotation_rad[k]); };
  return rotation_zyx<S>(angle(2), angle(1), angle(0));
}

/// at + r x.
template <class S>
Vector3<S> placed_point(const Vector3<S>& at, const std::optional<Matrix3<S>>& r, const Vector3<S>& x) {
  Vector3<S> placed = at;
  for (int i = 0; i < 3; ++i) {
    placed(i) = placed(i) + (r ? S((*r)(i, 0) * x(0) + (*r)(i, 1) * x(1) + (*r)(i, 2) * x(2)) : x(i));
  }
  return placed;
}

/// Finds the ball and the box around the body's points.
template <class S>
void surround(ConvexBody<S>& body) {
  // Around the first point and the last, which of a box are opposite corners.
  for (int i = 0; i < 3; ++i) {
    body.centre(i) = S(0.5 * (lower_bound(body.points.front()(i)) + lower_bound(body.points.back()(i))));
  }
  body.reach = body.radius;
  for (const Vector3<S>& x : body.points) {
    const Vector3<S>& c = body.centre;
    body.reach = larger(body.reach, S(euclidean_norm(x(0) - c(0), x(1) - c(1), x(2) - c(2)) + body.radius));
  }
  body.lowest = body.highest = body.points.front();
  for (const Vector3<S>& x : body.points) {
    for (int i = 0; i < 3; ++i) {
      body.lowest(i) = -larger(S(-body.lowest(i)), S(-x(i)));
      body.highest(i) = larger(body.highest(i), x(i));
    }
  }
}

template <class S>
ConvexBody<S> placed(const BodyText& body, const HullText& hull) {
  const Vector3<S> at = vector<S>(body.at_m);
  const std::optional<Matrix3<S>> r = rotation<S>(body);
  ConvexBody<S> result;
  result.radius = ScalarTraits<S>::from_decimal(hull.radius_m);
  for (const auto& point : hull.points_m) result.points.push_back(placed_point<S>(at, r, vector<S>(point)));
  surround(result);
  return result;
}

template <class S>
ConvexBody<S> placed(const BodyText& body, const MeshText& text) {
  if (text.mesh == nullptr) throw InputError("the mesh '" + sanitize(text.file) + "' of a body was not read");
  const PlacedMesh<S> mesh{text.mesh, ScalarTraits<S>::from_decimal(text.unit_m), vector<S>(body.at_m),
                           rotation<S>(body)};
  ConvexBody<S> result;
  result.radius = S(0.0);
  const MeshBox& box = text.mesh->nodes().front().box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<double, 3> f{};
    for (std::size_t k = 0; k < 3; ++k) f[k] = (corner >> k & 1U) != 0 ? box.upper[k] : box.lower[k];
    result.points.push_back(mesh.place(f));
  }
  surround(result);
  result.mesh = std::make_shared<const PlacedMesh<S>>(mesh);
  return result;
}

template <class S>
Obstacle<S> obstacle(const BodyText& body) {
  if (const auto* hull = std::get_if<HullText>(&body.shape)) return placed<S>(body, *hull);
  if (const auto* mesh = std::get_if<MeshText>(&body.shape)) return placed<S>(body, *mesh);
  const auto& half = std::get<HalfSpaceText>(body.shape);
  const Vector3<S> normal = vector<S>(half.normal);
  const Vector3<S> at = vector<S>(body.at_m);
  return HalfSpace<S>{normal, normal(0) * at(0) + normal(1) * at(1) + normal(2) * at(2)};
}

inline bool is_same(const DecimalText& a, const DecimalText& b) { return Decimal::parse(a) == Decimal::parse(b); }

inline bool is_same(const std::array<DecimalText, 3>& a, const std::array<DecimalText, 3>& b) {
  return is_same(a[0], b[0]) && is_same(a[1], b[1]) && is_same(a[2], b[2]);
}

}  // namespace bodies_detail

template <class S>
Vector3<S> PlacedMesh<S>::place(const std::array<double, 3>& f) const {
  return bodies_detail::placed_point<S>(at, turn, {unit * S(f[0]), unit * S(f[1]), unit * S(f[2])});
}

template <class S, class C>
S distance_in_cone(const ExitCone<C>& cone, const std::array<S, 3>& d) {
  const Vector3<C>& n = cone.axis;
  const S along = d[0] * n(0) + d[1] * n(1) + d[2] * n(2);
  const S across =
      euclidean_norm(S(d[1] * n(2) - d[2] * n(1)), S(d[2] * n(0) - d[0] * n(2)), S(d[0] * n(1) - d[1] * n(0)));
  return along * cone.sine - across * cone.cosine;
}

template <class S>
RequiredDistance<S> required_distance(const CheckedPair<S>& pair, const Vector3<S>& p) {
  RequiredDistance<S> result{pair.clearance, pair.clearance};
  const auto lower_to = [](S& distance, const S& depth) { distance = -larger(S(-distance), depth); };
  for (const ContactZone<S>& zone : pair.zones) {
    S left = zone.within * zone.within;
    for (int k = 0; k < 3; ++k) left = left - (p(k) - zone.at(k)) * (p(k) - zone.at(k));
    if (lower_bound(left) >= 0) lower_to(result.at_most, zone.depth);
    if (!(upper_bound(left) < 0)) lower_to(result.at_least, zone.depth);
  }
  return result;
}

namespace bodies_detail {

/// What a pair knows of its bodies. @pre the model has all bodies
template <class S>
void set_bodies(const BodyModel<S>& model, CheckedPair<S>& pair) {
  const auto add = [&](const S& radius, bool is_mesh) {
    pair.radii = pair.radii + radius;
    pair.has_mesh = pair.has_mesh || is_mesh;
  };
  const auto add_body = [&](const ConvexBody<S>& body) { add(body.radius, body.mesh != nullptr); };
  pair.radii = S(0.0);
  switch (pair.kind) {
    case PairClass::kPlatformObstacles: add_body(model.platform[pair.first]); break;
    default: add(model.cable_radius[pair.first], false);
  }
  switch (pair.kind) {
    case PairClass::kCablesCables: add(model.cable_radius[pair.second], false); break;
    case PairClass::kCablesPlatform: add_body(model.platform[pair.second]); break;
    case PairClass::kExitCones: break;
    default:
      if (const auto* hull = std::get_if<ConvexBody<S>>(&model.obstacles[pair.second])) add_body(*hull);
  }
}

}  // namespace bodies_detail

template <class S>
BodyModel<S> make_body_model(const Problem& problem) {
  using namespace bodies_detail;
  const BodiesText& text = *problem.bodies;
  BodyModel<S> model;
  for (const BodyText& body : text.platform) {
    model.platform.push_back(std::get<ConvexBody<S>>(obstacle<S>(body)));  // none is a half-space
  }
  for (const BodyText& body : text.obstacles) model.obstacles.push_back(obstacle<S>(body));
  for (std::size_t i = 0; i < kCables; ++i) {
    model.cable_radius[i] = ScalarTraits<S>::from_decimal(text.cables.diameter_m[i]) * S(0.5);
    for (std::size_t end = 0; end < 2; ++end) {
      const DecimalText& free = text.cables.free_ends_m[i][end];
      model.cable_free[i][end] = ScalarTraits<S>::from_decimal(free);
      model.is_cut[i][end] = Decimal::parse(free).sign() != 0;
    }
  }
  for (const ExitConeText& cone : text.exit_cones) {
    const Vector3<S> axis = vector<S>(cone.axis);
    const S size = euclidean_norm(axis(0), axis(1), axis(2));
    model.exit_cones.push_back({cone.end,
                                {axis(0) / size, axis(1) / size, axis(2) / size},
                                evaluate_constant<S>("sin(" + cone.half_angle_rad + ")"),
                                evaluate_constant<S>("cos(" + cone.half_angle_rad + ")")});
  }
  const auto is_one = [&](const auto& anchors, const std::array<DecimalText, kCables>* tolerances, std::size_t i,
                          std::size_t j) {
    return is_same(anchors[i], anchors[j]) && (tolerances == nullptr || is_same((*tolerances)[i], (*tolerances)[j]));
  };
  const TolerancesText* tolerances = problem.tolerances ? &*problem.tolerances : nullptr;
  for (const BodyPair& pair : pairs(text)) {
    CheckedPair<S> checked{pair.kind, pair.first, pair.second, ScalarTraits<S>::from_decimal(pair.clearance_m)};
    if (pair.kind == PairClass::kCablesCables) {
      const auto* base = tolerances != nullptr ? &tolerances->base_anchor_m : nullptr;
      const auto* platform = tolerances != nullptr ? &tolerances->platform_anchor_m : nullptr;
      checked.shares_base = is_one(problem.robot.base_anchors_m, base, pair.first, pair.second);
      checked.shares_platform = is_one(problem.robot.platform_anchors_m, platform, pair.first, pair.second);
    }
    for (const ContactZoneText& zone : pair.zones) {
      checked.zones.push_back({vector<S>(zone.at_m), ScalarTraits<S>::from_decimal(zone.within_m),
                               ScalarTraits<S>::from_decimal(zone.depth_m)});
    }
    set_bodies(model, checked);
    model.has_meshes = model.has_meshes || checked.has_mesh;
    model.pairs.push_back(std::move(checked));
  }
  return model;
}

}  // namespace taut
