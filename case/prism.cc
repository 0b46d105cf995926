// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/prism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "problem/decimal.h"

namespace taut::case_fields {
namespace {

using boost::multiprecision::cpp_int;

Rational dot(const RationalPoint& a, const RationalPoint& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

RationalPoint cross(const RationalPoint& a, const RationalPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

RationalPoint combined(const Rational& a, const RationalPoint& u, const Rational& b, const RationalPoint& v) {
  RationalPoint sum;
  for (std::size_t k = 0; k < 3; ++k) sum[k] = a * u[k] + b * v[k];
  return sum;
}

/// The least multiple of 10^-places that is >= x.
Rational decimal_above(const Rational& x, unsigned places) {
  const cpp_int scale = pow(cpp_int(10), places);
  const Rational scaled = x * scale;
  cpp_int whole = numerator(scaled) / denominator(scaled);  // rounded towards 0
  if (Rational(whole) < scaled) ++whole;
  return Rational(whole, scale);
}

/// The corners of a polygon around the unit circle, for the first quarter of a turn; the rest is symmetric. They are
/// those of the regular polygon of that many sides, rounded outward.
constexpr std::array<std::array<const char*, 2>, kPrismSides / 4> kQuarter = {
    {{"1.0196", "0"}, {"0.94199", "0.39019"}, {"0.72097", "0.72097"}, {"0.39019", "0.94199"}}};

using PlanePoint = std::array<Rational, 2>;

std::vector<PlanePoint> polygon_around_circle(const Rational& radius) {
  std::vector<PlanePoint> corners;
  for (int turn = 0; turn < 4; ++turn) {
    for (const auto& [x, y] : kQuarter) {
      PlanePoint corner = {radius * parse_rational(x), radius * parse_rational(y)};
      for (int k = 0; k < turn; ++k) corner = {-corner[1], corner[0]};
      corners.push_back(corner);
    }
  }
  return corners;
}

/// A unit vector, up to rounding to 12 decimals; exact along an axis.
RationalPoint unit_vector(const std::array<double, 3>& direction) {
  constexpr double kPlaces = 1e12;
  const double size = std::hypot(direction[0], direction[1], direction[2]);
  RationalPoint unit;
  for (std::size_t k = 0; k < 3; ++k) {
    unit[k] =
        Rational(static_cast<long long>(std::round(direction[k] / size * kPlaces)), static_cast<long long>(kPlaces));
  }
  return unit;
}

class CylinderPrism {
 public:
  CylinderPrism(const PointText& from, const PointText& to, const DecimalText& radius)
      : radius_(parse_rational(radius)) {
    for (std::size_t k = 0; k < 3; ++k) {
      from_[k] = parse_rational(from[k]);
      w_[k] = parse_rational(to[k]) - from_[k];
    }
    choose_axes();
    polygon_ = polygon_around_circle(radius_);
    choose_overhang();
  }

  /// Whether the prism contains the cylinder: the header's argument.
  [[nodiscard]] bool contains_cylinder() const {
    const auto [m0, m1, m2] = inverse();
    const Rational ww = dot(w_, w_), along = dot(m0, w_);
    const Rational across = dot(m0, m0) - along * along / ww;
    if (radius_ * radius_ * across > overhang_ * overhang_ || overhang_ < 0) return false;
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
      const PlanePoint& here = polygon_[k];
      const PlanePoint& next = polygon_[(k + 1) % polygon_.size()];
      const PlanePoint normal = {next[1] - here[1], here[0] - next[0]};
      const Rational h = normal[0] * here[0] + normal[1] * here[1];
      const RationalPoint g = combined(normal[0], m1, normal[1], m2);
      // A convex polygon around 0, counted anticlockwise, has h > 0 and all of its corners on one side of each edge.
      if (h <= 0 || dot(g, w_) != 0 || radius_ * radius_ * dot(g, g) > h * h) return false;
      for (const PlanePoint& corner : polygon_) {
        if (normal[0] * corner[0] + normal[1] * corner[1] > h) return false;
      }
    }
    return true;
  }

  [[nodiscard]] Prism result() const {
    Prism prism;
    Rational excess = 0;
    for (const Rational& t : {Rational(-overhang_), Rational(1 + overhang_)}) {
      for (const PlanePoint& corner : polygon_) {
        const RationalPoint y = combined(corner[0], u_, corner[1], v_);
        const RationalPoint from_start = combined(1, y, t, w_);
        PointText& text = prism.points_m.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) text[k] = rational_text(from_[k] + from_start[k]);
        excess = std::max(excess, distance_above(from_start));
      }
    }
    // As many decimals as three digits of the excess take.
    unsigned places = 0;
    for (Rational scaled = excess; scaled < 100 && places < 100; scaled *= 10) ++places;
    prism.excess_m = rational_text(decimal_above(excess, places));
    return prism;
  }

 private:
  /// U and V, across the cylinder's axis but for rounding.
  void choose_axes() {
    std::array<double, 3> w{};
    for (std::size_t k = 0; k < 3; ++k) w[k] = w_[k].convert_to<double>();
    const auto least =
        static_cast<std::size_t>(std::ranges::min_element(w, {}, [](double x) { return std::abs(x); }) - w.begin());
    std::array<double, 3> e{};
    e[least] = 1;
    const auto across = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
      return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const std::array<double, 3> v = across(w, e);
    u_ = unit_vector(across(v, w));
    v_ = unit_vector(v);
    if (dot(cross(w_, u_), v_) == 0) {
      throw InputError("expected a cylinder whose length and radius are of sizes that can be compared");
    }
  }

  /// The rows of [w U V]^-1.
  [[nodiscard]] std::array<RationalPoint, 3> inverse() const {
    const Rational determinant = dot(w_, cross(u_, v_));
    std::array<RationalPoint, 3> rows = {cross(u_, v_), cross(v_, w_), cross(w_, u_)};
    for (RationalPoint& row : rows) {
      for (Rational& x : row) x /= determinant;
    }
    return rows;
  }

  /// τ: what U and V lean along w.
  void choose_overhang() {
    const auto m0 = inverse()[0];
    const Rational along = dot(m0, w_);
    const Rational across = dot(m0, m0) - along * along / dot(w_, w_);
    constexpr unsigned kPlaces = 30;
    overhang_ = across == 0 ? Rational(0) : decimal_above(root_above(radius_ * radius_ * across), kPlaces);
  }

  /// Not below the distance of from + y from the cylinder.
  [[nodiscard]] Rational distance_above(const RationalPoint& y) const {
    const Rational ww = dot(w_, w_), t = dot(y, w_) / ww;
    const Rational across = dot(y, y) - t * t * ww;
    const Rational outward = std::max(Rational(0), Rational(root_above(across) - radius_));
    const Rational past = std::max({Rational(0), Rational(-t), Rational(t - 1)});
    return root_above(outward * outward + past * past * ww);
  }

  Rational radius_, overhang_;
  RationalPoint from_, w_, u_, v_;
  std::vector<PlanePoint> polygon_;
};

}  // namespace

Prism prism_around_cylinder(const PointText& from, const PointText& to, const DecimalText& radius) {
  const CylinderPrism prism(from, to, radius);
  const auto refuse = [] {
    throw InputError("expected a cylinder whose length and radius are of sizes that can be compared");
  };
  if (!prism.contains_cylinder()) refuse();
  Prism result = prism.result();
  constexpr int kMostShare = 10;  // five times what 16 sides take; more is due to rounding
  if (kMostShare * parse_rational(result.excess_m) > parse_rational(radius)) refuse();
  return result;
}

}  // namespace taut::case_fields
