// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/around_items.h"

#include <CGAL/Approximate_min_ellipsoid_d.h>
#include <CGAL/Approximate_min_ellipsoid_d_traits_d.h>
#include <CGAL/Cartesian_d.h>
#include <CGAL/MP_Float.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/input_error.h"
#include "problem/rational.h"

namespace taut::case_fields {
namespace {

using Vector3 = std::array<Rational, 3>;
using Vector6 = std::array<Rational, 6>;
using Matrix3 = std::array<Vector3, 3>;
using Matrix6 = std::array<Vector6, 6>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

// --- Exact arithmetic ----------------------------------------------------------------------------------------------

template <std::size_t N>
std::array<Rational, N> values(const std::array<RationalText, N>& texts) {
  std::array<Rational, N> result;
  std::ranges::transform(texts, result.begin(), [](const RationalText& text) { return parse_rational(text); });
  return result;
}

Rational squared(const Vector3& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }
Vector3 operator-(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector3 operator+(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// |v| if that is a rational number; else not below it, and above it by less than 1e-12 of it.
Rational norm_above(const Vector3& v) {
  using boost::multiprecision::cpp_int;
  const Rational square = squared(v);
  const Rational root(cpp_int(sqrt(numerator(square))), cpp_int(sqrt(denominator(square))));
  return root * root == square ? root : root_above(square);
}

Matrix3 identity() {
  Matrix3 result;
  for (std::size_t k = 0; k < 3; ++k) result[k][k] = 1;
  return result;
}
/// v vᵀ / |v|²
Matrix3 along(const Vector3& v) {
  const Rational square = squared(v);
  Matrix3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = v[i] * v[j] / square;
  }
  return result;
}
/// I − v vᵀ / |v|²
Matrix3 across(const Vector3& v) {
  Matrix3 result = along(v);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = (i == j ? 1 : 0) - result[i][j];
  }
  return result;
}

/// Nothing unless the matrix, which is symmetric, is positive definite.
std::optional<Matrix6> inverse_if_positive_definite(Matrix6 a) {
  Matrix6 inverse;
  for (std::size_t k = 0; k < 6; ++k) inverse[k][k] = 1;
  for (std::size_t k = 0; k < 6; ++k) {
    const Rational pivot = a[k][k];
    if (pivot <= 0) return std::nullopt;
    for (std::size_t j = 0; j < 6; ++j) {
      a[k][j] /= pivot;
      inverse[k][j] /= pivot;
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const Rational factor = a[i][k];
      if (i == k || factor == 0) continue;
      for (std::size_t j = 0; j < 6; ++j) {
        a[i][j] -= factor * a[k][j];
        inverse[i][j] -= factor * inverse[k][j];
      }
    }
  }
  return inverse;
}

/// A decimal near the number, with so many digits.
Rational rounded(const Rational& x, int digits) {
  return parse_rational(fmt::format("{:.{}g}", x.convert_to<double>(), digits));
}
Rational rounded(double x, int digits) { return parse_rational(fmt::format("{:.{}g}", x, digits)); }

[[noreturn]] void give_up() {
  throw FieldError("load.ellipsoid", "items whose wrenches are too far apart in size for one ellipsoid",
                   "expected loads of sizes that belong to one platform");
}

// --- The sum that contains the items -------------------------------------------------------------------------------

/// Wrenches about the load point, in W, that contain those of the items whatever R is: `centre`, and the sum of sets
/// {x : x = Q^½ z, |z| <= 1}.
class Sum {
 public:
  Sum(const LoadText& load, const Vector3& point) : gravity_(values(load.gravity_m_s2)), point_(point) {
    for (const LoadItem& item : load.items) {
      std::visit(Overloaded{[&](const Weight& x) { add(x); }, [&](const Force& x) { add(x); },
                            [&](const Moment& x) { add(x); }, [&](const LoadCases& x) { add(x); }},
                 item.what);
    }
  }
  /// Adds what does not have a part of its own yet. Nothing may be added afterwards.
  /// @param thickness  a force and a moment that don't matter
  void finish(const std::array<Rational, 2>& thickness);

  [[nodiscard]] const Vector6& centre() const { return centre_; }
  [[nodiscard]] const std::vector<Matrix6>& parts() const { return parts_; }

 private:
  void add(const Weight& weight);
  void add(const Force& force);
  void add(const Moment& moment);
  void add(const LoadCases& cases);
  void add_set(const VectorSet& set, bool is_moment);
  void add_hull(const std::vector<Vector6>& wrenches, const std::array<Rational, 2>& thickness);
  void add_part(const Matrix3& shape, const Rational& square, bool is_moment);
  [[nodiscard]] Rational lever(const RationalVector& at) const { return norm_above(values(at) - point_); }

  Vector3 gravity_, point_;
  Vector6 centre_;
  std::vector<Matrix6> parts_;
  std::vector<std::vector<Vector6>> hulls_;  ///< of load cases
  Vector3 mass_moment_;                      ///< Σ M (c − p_m)
  Rational mass_deviation_;                  ///< Σ μ
  Rational mass_lever_;                      ///< Σ μ |c − p_m| + (M + μ) ρ
  std::array<Rational, 2> any_direction_;    ///< radii of a ball of forces and one of moments
};

void Sum::add(const Weight& weight) {
  const Rational lower = parse_rational(weight.mass_lower), upper = parse_rational(weight.mass_upper);
  const Rational mean = (lower + upper) / 2, deviation = (upper - lower) / 2;
  const Vector3 arm = values(weight.at) - point_;
  for (std::size_t k = 0; k < 3; ++k) {
    centre_[k] += mean * gravity_[k];
    mass_moment_[k] += mean * arm[k];
  }
  mass_deviation_ += deviation;
  mass_lever_ += deviation * norm_above(arm) + upper * parse_rational(weight.at_tolerance);
}

void Sum::add_part(const Matrix3& shape, const Rational& square, bool is_moment) {
  if (square == 0) return;
  Matrix6& part = parts_.emplace_back();
  const std::size_t first = is_moment ? 3 : 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) part[first + i][first + j] = square * shape[i][j];
  }
}

/// A set in the axes of W.
void Sum::add_set(const VectorSet& set, bool is_moment) {
  if (const auto* ball = std::get_if<BallOfVectors>(&set)) {
    any_direction_[is_moment ? 1 : 0] += parse_rational(ball->radius);
    return;
  }
  if (const auto* disc = std::get_if<DiscOfVectors>(&set)) {
    const Rational radius = parse_rational(disc->radius);
    return add_part(across(values(disc->normal)), radius * radius, is_moment);
  }
  const auto& segment = std::get<SegmentOfVectors>(set);
  const Vector3 e = values(segment.direction);
  const Rational lower = parse_rational(segment.lower), upper = parse_rational(segment.upper);
  const Rational middle = (lower + upper) / 2, half = (upper - lower) / 2;
  // If length is not |e|, it is above |e| by less than 1e-12 of it, and the true middle is off by no more.
  const Rational length = norm_above(e);
  for (std::size_t k = 0; k < 3; ++k) centre_[(is_moment ? 3 : 0) + k] += middle * e[k] / length;
  if (length * length != squared(e)) any_direction_[is_moment ? 1 : 0] += abs(middle) * parse_rational("1e-12");
  add_part(along(e), half * half, is_moment);
}

void Sum::add(const Force& force) {
  const Rational most = greatest(force.set), arm = lever(force.at);
  if (force.axes == Axes::kPlatform) {
    any_direction_[0] += most;
    any_direction_[1] += arm * most;
    return;
  }
  add_set(force.set, false);
  const auto* segment = std::get_if<SegmentOfVectors>(&force.set);
  if (segment) return add_part(across(values(segment->direction)), arm * arm * most * most, true);
  any_direction_[1] += arm * most;
}

void Sum::add(const Moment& moment) {
  if (moment.axes == Axes::kWorld) return add_set(moment.set, true);
  any_direction_[1] += greatest(moment.set);
}

void Sum::add(const LoadCases& cases) {
  const Vector3 arm = values(cases.at) - point_;
  std::vector<Vector6> wrenches;
  Rational force = 0, moment = 0;  // moment: about P_m, in the axes of P
  for (const auto& text : cases.wrenches) {
    const Vector6 w = values(text);
    const Vector3 f = {w[0], w[1], w[2]}, m = {w[3], w[4], w[5]};
    force = std::max(force, norm_above(f));
    moment = std::max(moment, norm_above(m + cross(arm, f)));
    wrenches.push_back(w);
  }
  if (cases.axes == Axes::kPlatform) {
    any_direction_[0] += force;
    any_direction_[1] += moment;
    return;
  }
  any_direction_[1] += norm_above(arm) * force;
  hulls_.push_back(std::move(wrenches));
}

/// The smallest ellipsoid around the points (c, Q^-1), nearly, in floating point.
std::pair<Vector6d, Matrix6d> smallest_ellipsoid(const std::vector<Vector6d>& points) {
  using Kernel = CGAL::Cartesian_d<double>;
  using Traits = CGAL::Approximate_min_ellipsoid_d_traits_d<Kernel, CGAL::MP_Float>;
  constexpr double kVolumeTolerance = 0.01;
  std::vector<Kernel::Point_d> input;
  for (const Vector6d& x : points) input.emplace_back(6, x.data(), x.data() + 6);
  const CGAL::Approximate_min_ellipsoid_d<Traits> found(kVolumeTolerance, input.begin(), input.end());
  if (!found.is_full_dimensional()) give_up();
  Matrix6d m;
  Vector6d half;
  for (int i = 0; i < 6; ++i) {
    half(i) = 0.5 * found.defining_vector(i);
    for (int j = 0; j < 6; ++j) m(i, j) = found.defining_matrix(i, j);
  }
  return {-m.ldlt().solve(half), m};  // the size of the ellipsoid is up to the caller
}

/// An ellipsoid around the hull of the wrenches, with this thickness at least where the hull is flat.
void Sum::add_hull(const std::vector<Vector6>& wrenches, const std::array<Rational, 2>& thickness) {
  Vector6 mean;
  for (const Vector6& w : wrenches) {
    for (std::size_t k = 0; k < 6; ++k) mean[k] += w[k] / wrenches.size();
  }
  const auto scale = [&](std::size_t k) { return thickness[k / 3]; };
  std::vector<Vector6d> points;
  for (const Vector6& w : wrenches) {
    Vector6d& x = points.emplace_back();
    for (std::size_t k = 0; k < 6; ++k) {
      x(static_cast<int>(k)) = Rational((w[k] - mean[k]) / scale(k)).convert_to<double>();
    }
  }
  for (int k = 0; k < 6; ++k) {
    points.emplace_back(Vector6d::Unit(k));
    points.emplace_back(-Vector6d::Unit(k));
  }
  const auto [centre, shape] = smallest_ellipsoid(points);
  constexpr int kDigits = 12;
  Matrix6 e;
  Vector6 c;
  for (std::size_t i = 0; i < 6; ++i) {
    c[i] = mean[i] + scale(i) * rounded(centre(static_cast<int>(i)), kDigits);
    for (std::size_t j = 0; j <= i; ++j) {
      e[i][j] = e[j][i] = rounded(shape(static_cast<int>(i), static_cast<int>(j)), kDigits) / (scale(i) * scale(j));
    }
  }
  const auto q = inverse_if_positive_definite(e);
  if (!q) give_up();
  Rational most = 0;  // of (w − c)ᵀ e (w − c)
  for (const Vector6& w : wrenches) {
    Rational value = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) value += (w[i] - c[i]) * e[i][j] * (w[j] - c[j]);
    }
    most = std::max(most, value);
  }
  Matrix6& part = parts_.emplace_back(*q);
  for (std::size_t i = 0; i < 6; ++i) {
    centre_[i] += c[i];
    for (Rational& x : part[i]) x *= most;
  }
}

void Sum::finish(const std::array<Rational, 2>& thickness) {
  for (const std::vector<Vector6>& hull : hulls_) {
    if (hull.size() > 1) {
      add_hull(hull, thickness);
    } else {
      for (std::size_t k = 0; k < 6; ++k) centre_[k] += hull[0][k];
    }
  }
  if (const Rational gamma = squared(gravity_); gamma > 0) {
    add_part(along(gravity_), mass_deviation_ * mass_deviation_ * gamma, false);
    const Rational arm = norm_above(mass_moment_) + mass_lever_;
    add_part(across(gravity_), arm * arm * gamma, true);
  }
  // The centre becomes decimals; what that changes is a deviation in any direction.
  for (std::size_t k = 0; k < 6; ++k) {
    constexpr std::size_t kShort = 20;
    constexpr int kDigits = 15;
    const RationalText text = rational_text(centre_[k]);
    if (text.size() <= kShort && text.find('/') == std::string::npos) continue;
    const Rational near = rounded(centre_[k], kDigits);
    any_direction_[k / 3] += abs(centre_[k] - near);
    centre_[k] = near;
  }
  for (const bool is_moment : {false, true}) {
    const Rational& radius = any_direction_[is_moment ? 1 : 0];
    add_part(identity(), radius * radius, is_moment);
  }
}

// --- One ellipsoid around the sum ------------------------------------------------------------------------------------

/// Shares p > 0 of each part, of sum 1 at most, for which Σ Q / p has a small determinant.
std::vector<Rational> shares(const std::vector<Matrix6>& parts, const std::array<Rational, 2>& thickness) {
  const std::size_t n = parts.size();
  std::vector<Matrix6d> scaled(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        scaled[k](static_cast<int>(i), static_cast<int>(j)) =
            Rational(parts[k][i][j] / (thickness[i / 3] * thickness[j / 3])).convert_to<double>();
      }
    }
  }
  std::vector<double> p(n, 1.0 / static_cast<double>(n));
  constexpr int kRounds = 300;
  for (int round = 0; round < kRounds; ++round) {
    Matrix6d sum = Matrix6d::Identity();
    for (std::size_t k = 0; k < n; ++k) sum += scaled[k] / p[k];
    const Matrix6d inverse = sum.inverse();
    double total = 0;
    constexpr double kLeast = 1e-6;
    for (std::size_t k = 0; k < n; ++k) total += p[k] = std::max(kLeast, std::sqrt((inverse * scaled[k]).trace()));
    for (double& share : p) share /= total;
  }
  // In whole numbers of ten-thousandths. The 0.3 keeps shares such as 1/2 away from where rounding errors decide.
  constexpr int kWhole = 10000;
  std::vector<Rational> result;
  for (const double share : p) {
    const double room = kWhole - 2 * static_cast<double>(n);
    result.emplace_back(std::max(1, static_cast<int>(std::floor(share * room + 0.3))), kWhole);
  }
  return result;
}

/// E with {x : xᵀ E x <= 1} around the sum of the parts, decided in exact arithmetic.
EllipsoidText around(const std::vector<Matrix6>& parts, const std::array<Rational, 2>& thickness) {
  Matrix6 q;
  for (std::size_t i = 0; i < 6; ++i) q[i][i] = thickness[i / 3] * thickness[i / 3];
  if (!parts.empty()) {
    const std::vector<Rational> p = shares(parts, thickness);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j) q[i][j] += parts[k][i][j] / p[k];
      }
    }
  }
  const auto inverse = inverse_if_positive_definite(q);
  if (!inverse) give_up();
  for (const char* inflation : {"1e-9", "1e-6", "1e-3"}) {
    EllipsoidText text;
    Matrix6 e, rest;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        constexpr int kDigits = 15;
        e[i][j] = e[j][i] = rounded(Rational((*inverse)[i][j] * (1 - parse_rational(inflation))), kDigits);
        rest[i][j] = rest[j][i] = (*inverse)[i][j] - e[i][j];
        text[i][j] = text[j][i] = rational_text(e[i][j]);
      }
    }
    if (inverse_if_positive_definite(e) && inverse_if_positive_definite(rest)) return text;
  }
  give_up();
}

/// A ten-thousandth of the greatest forces of all items together, and the moment of that at the arm.
std::array<Rational, 2> thickness_of(const LoadText& load, double arm_m) {
  const double gravity = norm_above(values(load.gravity_m_s2)).convert_to<double>();
  double force = 0, moment = 0;
  for (const LoadItem& item : load.items) {
    std::visit(Overloaded{[&](const Weight& x) { force += gravity * from_rational<double>(x.mass_upper); },
                          [&](const Force& x) { force += greatest(x.set).convert_to<double>(); },
                          [&](const Moment& x) { moment += greatest(x.set).convert_to<double>(); },
                          [&](const LoadCases& x) {
                            Rational most = 0, most_moment = 0;
                            for (const auto& w : x.wrenches) {
                              const Vector6 v = values(w);
                              most = std::max(most, norm_above({v[0], v[1], v[2]}));
                              most_moment = std::max(most_moment, norm_above({v[3], v[4], v[5]}));
                            }
                            force += most.convert_to<double>();
                            moment += most_moment.convert_to<double>();
                          }},
               item.what);
  }
  constexpr double kShare = 1e-4;
  const double thin = kShare * std::max(force, moment / arm_m);
  constexpr int kDigits = 2;
  return {rounded(thin, kDigits), rounded(thin * arm_m, kDigits)};
}

/// The nominal centre of gravity of the weights, nearly; the load point where there are none.
std::array<DecimalText, 3> centre_of(const LoadText& load) {
  Rational mass = 0;
  Vector3 moment;
  for (const LoadItem& item : load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (!weight) continue;
    const Rational mean = (parse_rational(weight->mass_lower) + parse_rational(weight->mass_upper)) / 2;
    mass += mean;
    for (std::size_t k = 0; k < 3; ++k) moment[k] += mean * parse_rational(weight->at[k]);
  }
  if (mass == 0) return load.point_m;
  std::array<DecimalText, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    constexpr int kDigits = 9;
    result[k] = rational_text(rounded(Rational(moment[k] / mass), kDigits));
  }
  return result;
}

}  // namespace

Rational greatest(const VectorSet& set) {
  if (const auto* segment = std::get_if<SegmentOfVectors>(&set)) {
    const Rational lower = abs(parse_rational(segment->lower)), upper = abs(parse_rational(segment->upper));
    return std::max(lower, upper);
  }
  const auto* disc = std::get_if<DiscOfVectors>(&set);
  return parse_rational(disc ? disc->radius : std::get<BallOfVectors>(set).radius);
}

LoadText ellipsoid_around_items(const LoadText& load, double arm_m) try {
  LoadText result;
  result.point_m = centre_of(load);
  const std::array<Rational, 2> thickness = thickness_of(load, arm_m);
  Sum sum(load, values(result.point_m));
  sum.finish(thickness);
  for (std::size_t k = 0; k < 6; ++k) result.wrench[k] = rational_text(sum.centre()[k]);
  result.ellipsoid = around(sum.parts(), thickness);
  return result;
} catch (const InputError&) {  // of a number beyond the range of decimals
  give_up();
} catch (const CGAL::Failure_exception&) {
  give_up();
}

}  // namespace taut::case_fields
