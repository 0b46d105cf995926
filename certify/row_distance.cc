// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/row_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "base/input_error.h"
#include "certify/arithmetic/interval.h"
#include "kinematics/geometry.h"
#include "kinematics/model.h"
#include "kinematics/quaternion.h"

namespace taut {
namespace {

/// All numbers of which x is the nearest binary64. Path files have none below 1e-300 but 0 (Decimal).
Interval around(double x) {
  if (x == 0) return {0.0, 0.0};
  constexpr double kEnd = std::numeric_limits<double>::infinity();
  return {std::nextafter(x, -kEnd), std::nextafter(x, kEnd)};
}

struct EnclosedPose {
  Vector3<Interval> p;
  Matrix3<Interval> r;
};

/// Of the square |R − S|² = 8 sin²(angle/2), where `angle` turns R into S.
double angle_above(const Matrix3<Interval>& r, const Matrix3<Interval>& s) {
  Interval square(0.0);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) square += sqr(r(i, j) - s(i, j));
  }
  const Interval sine = sqrt(square / Interval(8.0));
  constexpr double kAbovePi = 3.1416;
  if (!(sine.upper() < 1)) return kAbovePi;
  return (Interval(2.0) * asin(sine)).upper();
}

}  // namespace

struct RowDistances::Enclosures {
  explicit Enclosures(const Problem& problem)
      : angles(make_angles<Interval>(problem.space.angles)),
        pose(pose_tape(problem)),
        model(make_model_without_ellipsoid<Interval>(problem)) {}

  [[nodiscard]] EnclosedPose at(std::span<const Interval> parameters) const {
    const Pose<Interval> found = evaluate_pose(pose, parameters);
    return {found.p_WP, rotation(angles, found.angles)};
  }
  [[nodiscard]] EnclosedPose of(const RowPose& row) const {
    std::vector<Interval> x;
    for (std::size_t j = 0; j < row.x.size(); ++j) {
      x.push_back(around(row.x[j]));
      if (row.form == RowPose::Form::kParameters && row.half_turns[j] != 0) {
        x.back() += Interval(static_cast<double>(row.half_turns[j])) * ScalarTraits<Interval>::pi();
      }
    }
    if (row.form == RowPose::Form::kParameters) return at(x);
    return {{x[0], x[1], x[2]}, rotation(Quaternion<Interval>{x[3], x[4], x[5], x[6]})};
  }

  /// By how much a cable's length differs from that of the row, at most.
  [[nodiscard]] double length_off(const EnclosedPose& move, const RowPose& row) const {
    const CableGeometry<Interval> geometry = cable_geometry(model, move.p, move.r);
    double most = 0;
    for (std::size_t i = 0; i < kCables; ++i) {
      const double off = magnitude(length(geometry.p_AB_W[i]) - around(row.x[i]));
      if (!std::isfinite(off)) return off;
      most = std::max(most, off);
    }
    return most;
  }

  Angles<Interval> angles;
  Evaluator<Interval> pose;
  Model<Interval> model;
};

RowDistances::RowDistances(const Problem& problem, const Path& path) : path_(path) {
  if (!problem.space.constraints.empty()) throw std::logic_error("rows of a motion that constraints imply");
  const TimeLaw& law = path.timing.value();
  bool is_even = !has_poses(path.interpolation) && law.pieces() == path.segments() && law.step_s > 0;
  for (std::size_t i = 0; i < law.controls.size(); ++i) is_even &= law.controls[i] == static_cast<double>(i) - 1;
  if (!is_even) throw InputError("timing: got a law that is not even, expected the control values -1, 0, 1, 2 …");
  if (!run_upward([&] { enclosures_ = std::make_unique<Enclosures>(problem); })) {
    throw InputError("space: got a number beyond the range of binary64");
  }
}

RowDistances::~RowDistances() = default;

std::optional<RowDistance> RowDistances::at(const Rational& time_s, const RowPose& row) const {
  using boost::multiprecision::cpp_int;
  const Rational place = time_s / Rational(path_.timing->step_s);
  const std::size_t segments = path_.segments();
  std::size_t k = 0;
  Rational u = 0;
  if (place >= Rational(segments)) {
    k = segments - 1;
    u = 1;
  } else if (place > 0) {
    const cpp_int whole = numerator(place) / denominator(place);
    k = whole.convert_to<std::size_t>();
    u = place - Rational(whole);
  }
  RowDistance result;
  const bool is_sound = run_upward([&] {
    const Interval s = from_rational<Interval>(rational_text(u));
    const Segment segment = path_.segment(k);
    std::vector<Interval> parameters;
    for (std::size_t j = 0; j < path_.waypoints.front().parameters().x.size(); ++j) {
      parameters.push_back(coordinate_polynomial<Interval>(segment, j).at(s));
    }
    const EnclosedPose move = enclosures_->at(parameters);
    if (row.form == RowPose::Form::kLengths) {
      result.length_m = enclosures_->length_off(move, row);
      return;
    }
    const EnclosedPose stated = enclosures_->of(row);
    const Vector3<Interval> d = move.p - stated.p;
    result.position_m = euclidean_norm(d(0), d(1), d(2)).upper();
    result.angle_rad = angle_above(move.r, stated.r);
  });
  const bool is_bounded =
      std::isfinite(result.position_m) && std::isfinite(result.angle_rad) && std::isfinite(result.length_m);
  if (!is_sound || !is_bounded) return std::nullopt;
  return result;
}

}  // namespace taut
