// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/sampled_polytope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "atlas/bytes.h"

namespace taut {
namespace {

using Directions = Eigen::MatrixXd;  // one in each row

Directions make_directions(int n) {
  Directions result = Directions::Zero(2 * n * n, n);
  int row = 0;
  for (int i = 0; i < n; ++i) {
    for (const double sign : {-1.0, 1.0}) result(row++, i) = sign;
    for (int j = 0; j < i; ++j) {
      for (const double a : {-1.0, 1.0}) {
        for (const double b : {-1.0, 1.0}) {
          result(row, j) = a / std::numbers::sqrt2;
          result(row++, i) = b / std::numbers::sqrt2;
        }
      }
    }
  }
  return result;
}

const Directions& directions(int n) {
  static const std::array<Directions, kMaxDimension> all = [] {
    std::array<Directions, kMaxDimension> result;
    for (int k = 1; k <= kMaxDimension; ++k) result[static_cast<std::size_t>(k - 1)] = make_directions(k);
    return result;
  }();
  return all[static_cast<std::size_t>(n - 1)];
}

}  // namespace

SampledPolytope::SampledPolytope(int dimension, double reach)
    : dimension_(dimension),
      circumradius_(reach),
      rays_(static_cast<std::size_t>(2 * dimension * dimension), {static_cast<float>(reach), kNone}) {}

bool SampledPolytope::clip(const TangentVector& normal, double offset, int facet) {
  if (offset >= circumradius_ * normal.norm()) return false;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRays, 1> along(corners());
  along.noalias() = directions(dimension_) * normal;
  bool shortened = false;
  float longest = 0;
  for (int k = 0; k < corners(); ++k) {
    Ray& ray = rays_[k];
    if (along[k] * ray.reach > offset) {
      ray = {static_cast<float>(offset / along[k]), facet};
      shortened = true;
    }
    longest = std::max(longest, ray.reach);
  }
  circumradius_ = longest;
  return shortened;
}

TangentVector SampledPolytope::corner(int ray) const {
  return rays_[ray].reach * directions(dimension_).row(ray).transpose();
}

std::vector<int> SampledPolytope::cutting_facets() const {
  std::vector<int> result;
  for (const Ray& ray : rays_) {
    if (ray.facet != kNone) result.push_back(ray.facet);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

bool SampledPolytope::has_facet(int facet) const {
  return std::any_of(rays_.begin(), rays_.end(), [facet](const Ray& ray) { return ray.facet == facet; });
}

void SampledPolytope::append_bytes(std::string& bytes) const {
  append_values(bytes, &circumradius_, 1);
  append_values(bytes, rays_.data(), rays_.size());
  for (int k = 0; k < corners(); ++k) bytes += is_marked(k) ? '\1' : '\0';
}

std::optional<SampledPolytope> SampledPolytope::from_bytes(int dimension, std::span<const std::byte> bytes,
                                                           int facet_end) {
  SampledPolytope result(dimension, 1.0);
  if (bytes.size() != sizeof circumradius_ + result.rays_.size() * (sizeof(Ray) + 1)) return {};
  take_values(bytes, &result.circumradius_, 1);
  take_values(bytes, result.rays_.data(), result.rays_.size());
  for (int k = 0; k < result.corners(); ++k) {
    const Ray& ray = result.rays_[k];
    if (!(ray.reach > 0 && std::isfinite(ray.reach)) || ray.facet < kNone || ray.facet >= facet_end) return {};
    if (bytes[k] != std::byte{0}) result.mark(k);
  }
  return std::isfinite(result.circumradius_) ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace taut
