// SPDX-License-Identifier: GPL-3.0-or-later
// Manifolds with known answers, for the tests of atlas/.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "atlas/atlas.h"
#include "atlas/manifold.h"

namespace taut::testing {

inline constexpr double kPi = std::numbers::pi;
/// The weight of a greedy search.
inline constexpr double kGreedy = std::numeric_limits<double>::infinity();

inline Coordinates coordinates(std::initializer_list<double> values) {
  Coordinates result(values.size());
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

inline AtlasOptions options(double radius, double epsilon) {
  AtlasOptions result;
  result.radius = radius;
  result.epsilon = epsilon;
  return result;
}

/// f(x) = 0 in R^3, named by x itself; projection along the normal by Newton iteration.
class ImplicitSurface : public Manifold {
 public:
  using Function = std::function<double(const Eigen::Vector3d&)>;
  using Gradient = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;
  ImplicitSurface(Function f, Gradient gradient) : f_(std::move(f)), gradient_(std::move(gradient)) {}

  int dimension() const override { return 2; }
  int ambient_dimension() const override { return 3; }
  int coordinate_dimension() const override { return 3; }

  bool frame_at(const Coordinates& x, Frame& frame) const override {
    const Eigen::Vector3d normal = gradient_(x).normalized();
    const Eigen::Vector3d first = normal.unitOrthogonal();
    frame.resize(3, 3, 2);
    frame.coordinates() = x;
    frame.point() = x;
    frame.tangent().col(0) = first;
    frame.tangent().col(1) = normal.cross(first);
    frame.lift() = frame.tangent();
    return true;
  }

  bool project(const Frame& frame, const TangentVector& u, Coordinates& x) const override {
    const Eigen::Vector3d normal = gradient_(frame.point()).normalized();
    const Eigen::Vector3d foot = frame.point() + frame.tangent() * u;
    double height = 0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Eigen::Vector3d at = foot + height * normal;
      const double step = f_(at) / gradient_(at).dot(normal);
      height -= step;
      if (!std::isfinite(height)) return false;
      if (std::abs(step) < 1e-13) {
        x = foot + height * normal;
        return true;
      }
    }
    return false;
  }

  double value(const Eigen::Vector3d& x) const { return f_(x); }

 private:
  Function f_;
  Gradient gradient_;
};

inline ImplicitSurface unit_sphere() {
  return {[](const Eigen::Vector3d& x) { return x.squaredNorm() - 1; },
          [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return 2 * x; }};
}

/// Torus around the z axis, with the radii 1 of its circle and 0.4 of its tube.
inline constexpr double kTubeRadius = 0.4;
inline ImplicitSurface torus() {
  return {[](const Eigen::Vector3d& x) {
            const double across = std::hypot(x[0], x[1]) - 1;
            return across * across + x[2] * x[2] - kTubeRadius * kTubeRadius;
          },
          [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
            const double rho = std::hypot(x[0], x[1]);
            const double across = rho - 1;
            return {2 * across * x[0] / rho, 2 * across * x[1] / rho, 2 * x[2]};
          }};
}

/// 3 + 8 (x^4 + y^4 + z^4) = 8 (x^2 + y^2 + z^2), which is T(x) + T(y) + T(z) = 0 with Chebyshev's T(x) = 8x^4 - 8x^2 +
/// 1. The critical points of the left side have each coordinate 0 (T = 1, a maximum) or ±1/sqrt 2 (T = -1, a minimum).
/// Below zero lie 8 minima and 12 saddles of index 1 that join them as a cube's edges join its corners: the inside is a
/// connected handlebody with Euler characteristic 8 - 12 = -4, so its boundary is one surface of genus 5, with -8.
inline ImplicitSurface chmutov() {
  return {
      [](const Eigen::Vector3d& x) {
        const Eigen::Array3d square = x.array().square();
        return 3 + 8 * (square * square).sum() - 8 * square.sum();
      },
      [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return (32 * x.array().cube() - 16 * x.array()).matrix(); }};
}

/// A graph over one or more parameters; a flat one is R^n itself. Restricted to the parameters where `inside` holds.
class FlatSpace : public Manifold {
 public:
  explicit FlatSpace(int dimension, std::function<bool(const Coordinates&)> inside = {})
      : dimension_(dimension), inside_(std::move(inside)) {}

  int dimension() const override { return dimension_; }
  int ambient_dimension() const override { return dimension_; }
  int coordinate_dimension() const override { return dimension_; }
  bool frame_at(const Coordinates& x, Frame& frame) const override {
    if (inside_ && !inside_(x)) return false;
    frame.resize(dimension_, dimension_, dimension_);
    frame.coordinates() = x;
    frame.point() = x;
    frame.tangent().setIdentity();
    frame.lift().setIdentity();
    return true;
  }

 private:
  int dimension_;
  std::function<bool(const Coordinates&)> inside_;
};

/// The product of circles of radius 1, or of circles and bounded lines, in R^(2n): locally flat.
/// Coordinates are the angles, periodic; those with a half width w > 0 are lengths in [-w, w] instead.
class FlatTorus : public Manifold {
 public:
  explicit FlatTorus(std::vector<double> half_widths) : half_widths_(std::move(half_widths)) {}

  int dimension() const override { return static_cast<int>(half_widths_.size()); }
  int ambient_dimension() const override { return 2 * dimension(); }
  int coordinate_dimension() const override { return dimension(); }
  CoordinateSymmetry symmetry() const override {
    CoordinateSymmetry symmetry;
    for (int j = 0; j < dimension(); ++j) symmetry.periodic[j] = half_widths_[j] == 0;
    return symmetry;
  }
  bool frame_at(const Coordinates& x, Frame& frame) const override {
    const int n = dimension();
    frame.resize(n, 2 * n, n);
    frame.coordinates() = x;
    frame.point().setZero();
    frame.tangent().setZero();
    frame.lift().setIdentity();
    for (int j = 0; j < n; ++j) {
      if (half_widths_[j] > 0) {
        if (std::abs(x[j]) > half_widths_[j]) return false;
        frame.point()[2 * j] = x[j];
        frame.tangent()(2 * j, j) = 1;
      } else {
        frame.point().segment<2>(2 * j) << std::cos(x[j]), std::sin(x[j]);
        frame.tangent().col(j).segment<2>(2 * j) << -std::sin(x[j]), std::cos(x[j]);
      }
    }
    return true;
  }

 private:
  std::vector<double> half_widths_;
};

/// The sphere by longitude phi and co-latitude theta of either sign, (phi, theta) ~ (phi + pi, -theta), as
/// tilt-and-torsion angles name directions. Smooth at the poles, where the coordinates are not. With `cap` > 0, only
/// the points within that angle of the pole theta = 0.
class PolarSphere : public Manifold {
 public:
  explicit PolarSphere(double cap = 0) : cap_(cap) {}

  int dimension() const override { return 2; }
  int ambient_dimension() const override { return 3; }
  int coordinate_dimension() const override { return 2; }
  CoordinateSymmetry symmetry() const override {
    CoordinateSymmetry symmetry;
    symmetry.periodic = {true, true};
    symmetry.flip = {0, 1};
    return symmetry;
  }
  static Eigen::Vector3d at(const Coordinates& x) {
    return {std::sin(x[1]) * std::cos(x[0]), std::sin(x[1]) * std::sin(x[0]), std::cos(x[1])};
  }
  bool frame_at(const Coordinates& x, Frame& frame) const override {
    const Eigen::Vector3d point = at(x);
    if (cap_ > 0 && point.z() < std::cos(cap_)) return false;
    frame.resize(2, 3, 2);
    frame.coordinates() = x;
    frame.point() = point;
    frame.tangent().col(0) << -std::sin(x[0]), std::cos(x[0]), 0;
    frame.tangent().col(1) << std::cos(x[1]) * std::cos(x[0]), std::cos(x[1]) * std::sin(x[0]), -std::sin(x[1]);
    frame.lift().setZero();  // not used: project() is exact
    return true;
  }
  bool project(const Frame& frame, const TangentVector& u, Coordinates& x) const override {
    const Eigen::Vector3d point = (frame.point() + frame.tangent() * u).normalized();
    x.resize(2);
    x << std::atan2(point.y(), point.x()), std::atan2(std::hypot(point.x(), point.y()), point.z());
    return true;
  }

 private:
  double cap_;
};

/// Points (phi, theta) of a flat cylinder with (phi, theta) ~ (phi + pi, -theta), theta in [-w, w]: an open Moebius
/// strip.
class MoebiusStrip : public Manifold {
 public:
  explicit MoebiusStrip(double half_width) : half_width_(half_width) {}
  int dimension() const override { return 2; }
  int ambient_dimension() const override { return 4; }
  int coordinate_dimension() const override { return 2; }
  CoordinateSymmetry symmetry() const override {
    CoordinateSymmetry symmetry;
    symmetry.periodic = {true, false};
    symmetry.flip = {0, 1};
    return symmetry;
  }
  bool frame_at(const Coordinates& x, Frame& frame) const override {
    if (std::abs(x[1]) > half_width_) return false;
    const double c = std::cos(x[0]), s = std::sin(x[0]), c2 = std::cos(2 * x[0]), s2 = std::sin(2 * x[0]);
    frame.resize(2, 4, 2);
    frame.coordinates() = x;
    frame.point() << c2, s2, x[1] * c, x[1] * s;
    Eigen::Matrix<double, 4, 2> derivative;
    derivative << -2 * s2, 0, 2 * c2, 0, -x[1] * s, c, x[1] * c, s;
    const Eigen::Vector2d lengths = derivative.colwise().norm();  // the columns are orthogonal
    frame.tangent() = derivative * lengths.cwiseInverse().asDiagonal();
    frame.lift() = lengths.cwiseInverse().asDiagonal();
    return true;
  }

 private:
  double half_width_;
};

}  // namespace taut::testing
