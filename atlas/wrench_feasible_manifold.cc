// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/wrench_feasible_manifold.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "kinematics/constraint_functions.h"
#include "kinematics/geometry.h"
#include "kinematics/jet.h"
#include "kinematics/statics.h"

namespace taut {
namespace {

CoordinateSymmetry symmetry_of(const SpaceText& space) {
  CoordinateSymmetry symmetry;
  for (std::size_t j = 0; j < space.parameters.size(); ++j) {
    symmetry.periodic[j] = space.parameters[j].kind == ParameterKind::kPeriodic;
  }
  symmetry.flip = space.flip;
  return symmetry;
}

/// Parameters and their derivatives in n directions; without constraints these are the directions of the parameters.
template <int N>
using ParameterJets = std::array<Jet<double, N>, kMaxCoordinates>;

/// The manifold for up to N dimensions; with fewer, the last partial derivatives are unused.
template <int N>
class WrenchFeasibleManifold final : public Manifold {
 public:
  WrenchFeasibleManifold(const Problem& problem, const PoseSampler& sampler, MetricWeights weights)
      : m_(static_cast<int>(problem.space.parameters.size())),
        n_(m_ - static_cast<int>(problem.space.constraints.size())),
        weights_(weights),
        symmetry_(symmetry_of(problem.space)),
        model_(sampler.model()),
        pose_(sampler.tape()),
        constraints_(sampler.constraints()) {
    for (const Parameter& parameter : problem.space.parameters) {
      ranges_.push_back(parameter.kind == ParameterKind::kRange
                            ? std::array<double, 2>{evaluate_constant<double>(parameter.range_lower),
                                                    evaluate_constant<double>(parameter.range_upper)}
                            : std::array<double, 2>{-HUGE_VAL, HUGE_VAL});
    }
  }

  [[nodiscard]] int dimension() const override { return n_; }
  [[nodiscard]] int ambient_dimension() const override { return kPoseSize + 2 * m_ + 3 * kCables; }
  [[nodiscard]] int coordinate_dimension() const override { return m_; }
  [[nodiscard]] CoordinateSymmetry symmetry() const override { return symmetry_; }

  [[nodiscard]] bool frame_at(const Coordinates& coordinates, Frame& frame) const override {
    using J = Jet<double, N>;
    frame.resize(m_, ambient_dimension(), n_);
    ParameterJets<N> parameters;
    if (!(constraints_ ? put_constrained(coordinates, parameters, frame) : put_free(coordinates, parameters, frame))) {
      return false;
    }
    for (std::size_t j = 0; j < ranges_.size(); ++j) {
      if (!(ranges_[j][0] <= parameters[j].value && parameters[j].value <= ranges_[j][1])) return false;
    }
    const Pose<J> pose = evaluate_pose(pose_, std::span<const J>(parameters.data(), static_cast<std::size_t>(m_)));
    const Matrix3<J> r_WP = rotation(model_.angles, pose.angles);
    const CableGeometry<J> geometry = cable_geometry(model_, pose.p_WP, r_WP);

    frame.coordinates() = coordinates;
    auto point = frame.point();
    auto tangent = frame.tangent();
    int row = 0;
    const auto put = [&](const J& x, double weight) {
      point[row] = weight * x.value;
      for (int k = 0; k < n_; ++k) tangent(row, k) = weight * x.partial[static_cast<std::size_t>(k)];
      ++row;
    };
    // The coordinates that distinguish poses best come first, because the neighbour index uses these.
    for (int i = 0; i < 3; ++i) put(r_WP(i, 2), std::sqrt(0.5));
    for (int i = 0; i < 3; ++i) put(pose.p_WP(i), 1.0 / model_.characteristic_length);
    for (int i = 0; i < 3; ++i) put(r_WP(i, 0), std::sqrt(0.5));
    for (int i = 0; i < 3; ++i) put(r_WP(i, 1), std::sqrt(0.5));
    for (int j = 0; j < m_; ++j) put_parameter(j, parameters[static_cast<std::size_t>(j)], put);
    if (!put_slacks(r_WP, geometry, put)) return false;
    return orthonormalise(frame);
  }

  /// With constraints, goes from the lifted point back to them, along the normals at the frame's coordinates.
  [[nodiscard]] bool project(const Frame& frame, const TangentVector& u, Coordinates& coordinates) const override {
    coordinates = frame.coordinates() + frame.lift() * u;
    if (!constraints_) return true;
    ConstraintFunctions::Vector values;
    ConstraintFunctions::Jacobian jacobian;
    constraints_->evaluate(frame.coordinates(), values, jacobian);
    const ConstraintFunctions::Jacobian normals = ConstraintFunctions::normals(jacobian);
    const auto y = constraints_->project(coordinates, normals);
    if (y) coordinates += normals * *y;
    return y.has_value();
  }

 private:
  static constexpr int kPoseSize = 12;

  bool put_free(const Coordinates& coordinates, ParameterJets<N>& parameters, Frame& frame) const {
    for (int j = 0; j < m_; ++j) parameters[static_cast<std::size_t>(j)] = Jet<double, N>(coordinates[j], j);
    frame.lift().setIdentity();
    return true;
  }

  /// Computes the point on the constraints near the coordinates, which may be slightly off them, and the directions in
  /// which it may move: an orthonormal basis of the null space of C'. Returns false if the rank is not full.
  bool put_constrained(const Coordinates& coordinates, ParameterJets<N>& parameters, Frame& frame) const {
    const auto at = constraints_->nearest(coordinates);
    if (!at) return false;
    ConstraintFunctions::Vector values;
    ConstraintFunctions::Jacobian jacobian;
    constraints_->evaluate(*at, values, jacobian);
    const Eigen::HouseholderQR<ConstraintFunctions::Jacobian> qr(jacobian.transpose());
    const ConstraintFunctions::Jacobian q = qr.householderQ();
    frame.lift() = q.rightCols(n_);
    for (int j = 0; j < m_; ++j) {
      Jet<double, N>& x = parameters[static_cast<std::size_t>(j)];
      x = Jet<double, N>((*at)[j]);
      for (int k = 0; k < n_; ++k) x.partial[static_cast<std::size_t>(k)] = frame.lift()(j, k);
    }
    return true;
  }

  template <class Put>
  void put_parameter(int j, const Jet<double, N>& x, Put&& put) const {
    const double weight = weights_.parameter;
    const bool flips = symmetry_.flip.has_value();
    if (flips && j == (*symmetry_.flip)[1]) {  // θ changes sign with a flip, so it can't be used; R contains it already
      put(Jet<double, N>(0.0), 0.0);
      put(Jet<double, N>(0.0), 0.0);
    } else if (symmetry_.periodic[static_cast<std::size_t>(j)]) {
      const double multiple = flips && j == (*symmetry_.flip)[0] ? 2.0 : 1.0;
      const auto sc = sincos(x * multiple);
      put(sc.cos, weight / multiple);
      put(sc.sin, weight / multiple);
    } else {
      put(x, weight);
      put(Jet<double, N>(0.0), 0.0);
    }
  }

  using Cables = std::array<Jet<double, N>, kCables>;
  struct Densities {
    Cables nominal, below, above;  ///< [N/m]
  };

  /// The κ log of the slack variables and their derivatives; false where a margin is within the clearance or D is
  /// singular.
  template <class Put>
  bool put_slacks(const Matrix3<Jet<double, N>>& r_WP, const CableGeometry<Jet<double, N>>& geometry, Put&& put) const {
    using J = Jet<double, N>;
    Cables lengths;
    for (std::size_t i = 0; i < kCables; ++i) {
      lengths[i] = length(geometry.p_AB_W[i]);
      if (!(model_.length_lower[i] < lengths[i].value && lengths[i].value < model_.length_upper[i])) return false;
    }
    Densities densities;
    if (!put_densities(r_WP, geometry, lengths, densities)) return false;
    bool clear = true;
    const auto put_margin = [&](const J& relative) {
      if (!(relative.value > weights_.clearance)) {
        clear = false;
        return;
      }
      put(log(relative), weights_.slack);  // −log of the slack variable
    };
    for (std::size_t i = 0; i < kCables && clear; ++i) {
      const double half = 0.5 * (model_.length_upper[i] - model_.length_lower[i]);
      const J slack = (lengths[i] - model_.length_lower[i]) * (-lengths[i] + model_.length_upper[i]);
      put_margin(slack * (1.0 / (half * half)));
    }
    for (std::size_t i = 0; i < kCables && clear; ++i) {
      const double half = 0.5 * (model_.tension_upper[i] - model_.tension_lower[i]);
      const J low = lengths[i] * (densities.nominal[i] - densities.below[i]) - model_.tension_lower[i];
      const J high = -(lengths[i] * (densities.nominal[i] + densities.above[i])) + model_.tension_upper[i];
      put_margin(low * (1.0 / half));
      if (clear) put_margin(high * (1.0 / half));
    }
    return clear;
  }

  /// Derivatives are computed where tensions are within their limits; false where they are not, or D is singular.
  bool put_densities(const Matrix3<Jet<double, N>>& r_WP, const CableGeometry<Jet<double, N>>& geometry,
                     const Cables& lengths, Densities& densities) const {
    Matrix6<double> d;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) d(i, j) = geometry.force_density(i, j).value;
    }
    Matrix6<double> y;
    double determinant = 0;
    if (!invert(d, y, determinant)) return false;
    if (!model_.loads.empty()) return put_item_densities(r_WP, geometry, y, lengths, densities);
    const Vector6<double> density = y * model_.wrench;
    const Matrix6<double> z = ellipsoid_rows(y);
    const Matrix6<double> zz = z * z.transpose();
    for (int i = 0; i < kCables; ++i) {
      const auto c = static_cast<std::size_t>(i);
      densities.nominal[c].value = density[i];
      densities.above[c].value = std::sqrt(zz(i, i));  // |z_i| = v_ii / d_i
      densities.below[c].value = densities.above[c].value;
    }
    if (!are_within_limits(lengths, densities)) return false;
    for (std::size_t k = 0; k < N; ++k) {
      if (static_cast<int>(k) >= n_) break;
      // λ' = −Y D' λ and |z_i|' = z_i·z_i'/|z_i| with Z' = −Y D' Z.
      const Matrix6<double> m = y * slope(geometry, k);
      const Vector6<double> density_slope = m * density;
      for (int i = 0; i < kCables; ++i) {
        const auto c = static_cast<std::size_t>(i);
        densities.nominal[c].partial[k] = -density_slope[i];
        densities.above[c].partial[k] = -m.row(i).dot(zz.col(i)) / densities.above[c].value;
        densities.below[c].partial[k] = densities.above[c].partial[k];
      }
    }
    return true;
  }

  /// Where K is a sum of items, with or without an ellipsoid: from the jets of Y' = −Y D' Y.
  bool put_item_densities(const Matrix3<Jet<double, N>>& r_WP, const CableGeometry<Jet<double, N>>& geometry,
                          const Matrix6<double>& y, const Cables& lengths, Densities& densities) const {
    using J = Jet<double, N>;
    Matrix6<J> inverse;
    for (int i = 0; i < 36; ++i) inverse(i) = J(y(i));
    for (std::size_t k = 0; k < N; ++k) {
      if (static_cast<int>(k) >= n_) break;
      const Matrix6<double> change = y * slope(geometry, k) * y;
      for (int i = 0; i < 36; ++i) inverse(i).partial[k] = -change(i);
    }
    const LoadsAtPose<J> loads = loads_at(model_.loads, r_WP);
    for (int i = 0; i < kCables; ++i) {
      const auto c = static_cast<std::size_t>(i);
      const Vector6<J> row = inverse.row(i).transpose();
      J nominal(0.0);
      for (int j = 0; j < 6; ++j) nominal = nominal + row(j) * (loads.nominal(j) + model_.wrench(j));
      J radius(0.0);
      for (int j = 0; model_.has_ellipsoid && j < 6; ++j) {
        J entry = row(0) * model_.ellipsoid_root(0, j);
        for (int l = 1; l <= j; ++l) entry = entry + row(l) * model_.ellipsoid_root(l, j);
        radius = radius + sqr(entry);
      }
      if (model_.has_ellipsoid) radius = sqrt(radius);
      const DensityRange<J> range = density_range(model_.loads, loads, row);
      densities.nominal[c] = nominal;
      densities.below[c] = radius + range.below;
      densities.above[c] = radius + range.above;
    }
    return are_within_limits(lengths, densities);
  }

  [[nodiscard]] bool are_within_limits(const Cables& lengths, const Densities& densities) const {
    for (std::size_t i = 0; i < kCables; ++i) {
      const double length = lengths[i].value;
      const double nominal = densities.nominal[i].value;
      const double low = length * (nominal - densities.below[i].value) - model_.tension_lower[i];
      const double high = model_.tension_upper[i] - length * (nominal + densities.above[i].value);
      if (!(low > 0 && high > 0)) return false;
    }
    return true;
  }

  /// Y L.
  [[nodiscard]] Matrix6<double> ellipsoid_rows(const Matrix6<double>& y) const {
    Matrix6<double> z;
    if (model_.ellipsoid_is_diagonal) {
      z.noalias() = y * model_.ellipsoid_root.diagonal().asDiagonal();
    } else {
      z.noalias() = y * model_.ellipsoid_root;
    }
    return z;
  }

  /// The derivative of D in the k-th direction.
  static Matrix6<double> slope(const CableGeometry<Jet<double, N>>& geometry, std::size_t k) {
    Matrix6<double> result;
    for (int i = 0; i < 36; ++i) result(i) = geometry.force_density(i).partial[k];
    return result;
  }

  /// Gram–Schmidt on the columns of dx/dv = Φ T, where v are coordinates along the columns of the lift L. Replaces L by
  /// dλ/du = L T^-1.
  bool orthonormalise(Frame& frame) const {
    auto tangent = frame.tangent();
    auto lift = frame.lift();
    for (int k = 0; k < n_; ++k) {
      for (int j = 0; j < k; ++j) {
        const double overlap = tangent.col(j).dot(tangent.col(k));
        tangent.col(k) -= overlap * tangent.col(j);
        lift.col(k) -= overlap * lift.col(j);
      }
      const double size = tangent.col(k).norm();
      if (!(size > 1e-9) || !std::isfinite(size)) return false;
      tangent.col(k) /= size;
      lift.col(k) /= size;
    }
    return true;
  }

  int m_;
  int n_;
  MetricWeights weights_;
  CoordinateSymmetry symmetry_;
  Model<double> model_;
  Evaluator<Jet<double, N>> pose_;
  std::optional<ConstraintFunctions> constraints_;
  std::vector<std::array<double, 2>> ranges_;
};

}  // namespace

std::unique_ptr<Manifold> make_wrench_feasible_manifold(const Problem& problem, MetricWeights weights) {
  return make_wrench_feasible_manifold(problem, PoseSampler(problem), weights);
}

std::unique_ptr<Manifold> make_wrench_feasible_manifold(const Problem& problem, const PoseSampler& sampler,
                                                        MetricWeights weights) {
  if (problem.space.parameters.size() > kMaxDimension) {
    throw FieldError("space.parameters", fmt::format("{} parameters", problem.space.parameters.size()),
                     fmt::format("expected at most {} to plan in", kMaxDimension));
  }
  switch (problem.space.parameters.size() - problem.space.constraints.size()) {
    case 1:
    case 2: return std::make_unique<WrenchFeasibleManifold<2>>(problem, sampler, weights);
    case 3: return std::make_unique<WrenchFeasibleManifold<3>>(problem, sampler, weights);
    default: return std::make_unique<WrenchFeasibleManifold<6>>(problem, sampler, weights);
  }
}

}  // namespace taut
