// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of statics.h.
#pragma once

#include <algorithm>
#include <limits>

namespace taut {

namespace statics_detail {

/// Smallest |x| over an enclosure; 0 where it may vanish.
template <class S>
double mignitude(const S& x) {
  return std::max({0.0, lower_bound(x), -upper_bound(x)});
}

}  // namespace statics_detail

template <class S>
bool invert(const Matrix6<S>& matrix, Matrix6<S>& inverse, S& determinant) {
  Matrix6<S> a = matrix;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) inverse(i, j) = S(i == j ? 1.0 : 0.0);
  }
  determinant = S(1.0);
  for (int column = 0; column < 6; ++column) {
    int pivot = column;
    for (int row = column + 1; row < 6; ++row) {
      if (statics_detail::mignitude(a(row, column)) > statics_detail::mignitude(a(pivot, column))) pivot = row;
    }
    if (!(statics_detail::mignitude(a(pivot, column)) > 0)) return false;
    if (pivot != column) {
      for (int k = 0; k < 6; ++k) {
        std::swap(a(pivot, k), a(column, k));
        std::swap(inverse(pivot, k), inverse(column, k));
      }
      determinant = -determinant;
    }
    determinant = determinant * a(column, column);
    const S scale = S(1.0) / a(column, column);
    for (int k = column + 1; k < 6; ++k) a(column, k) = a(column, k) * scale;
    for (int k = 0; k < 6; ++k) inverse(column, k) = inverse(column, k) * scale;
    for (int row = 0; row < 6; ++row) {
      if (row == column) continue;
      const S factor = a(row, column);
      for (int k = column + 1; k < 6; ++k) a(row, k) = a(row, k) - factor * a(column, k);
      for (int k = 0; k < 6; ++k) inverse(row, k) = inverse(row, k) - factor * inverse(column, k);
    }
  }
  return true;
}

template <class S>
Statics<S> statics(const Model<S>& model, const Vector3<S>& p_WP, const Matrix3<S>& r_WP) {
  Statics<S> result;
  const CableGeometry<S> geometry = cable_geometry(model, p_WP, r_WP);
  for (std::size_t i = 0; i < kCables; ++i) result.length[i] = length(geometry.p_AB_W[i]);
  Matrix6<S> y;
  result.regular = invert(geometry.force_density, y, result.determinant);
  if (!result.regular) return result;
  Vector6<S> wrench = model.wrench;
  LoadsAtPose<S> loads;
  if (!model.loads.empty()) {
    loads = loads_at(model.loads, r_WP);
    wrench = wrench + loads.nominal;
  }
  for (int i = 0; i < kCables; ++i) {
    S density = S(0.0);
    S square = S(0.0);
    for (int j = 0; j < 6; ++j) density = density + y(i, j) * wrench(j);
    for (int j = 0; model.has_ellipsoid && j < 6; ++j) {
      S component = y(i, j) * model.ellipsoid_root(j, j);
      if (!model.ellipsoid_is_diagonal) {
        for (int k = 0; k < j; ++k) component = component + y(i, k) * model.ellipsoid_root(k, j);
      }
      square = square + sqr(component);
    }
    const auto n = static_cast<std::size_t>(i);
    result.tension[n] = result.length[n] * density;
    const S by_ellipsoid = model.has_ellipsoid ? S(result.length[n] * sqrt(square)) : S(0.0);
    result.tension_below[n] = result.tension_above[n] = by_ellipsoid;
    if (!model.loads.empty()) {
      const DensityRange<S> range = density_range(model.loads, loads, Vector6<S>(y.row(i).transpose()));
      result.tension_below[n] = by_ellipsoid + result.length[n] * range.below;
      result.tension_above[n] = by_ellipsoid + result.length[n] * range.above;
    }
    result.determinant = result.determinant / result.length[n];
  }
  return result;
}

}  // namespace taut
