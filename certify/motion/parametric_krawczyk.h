// SPDX-License-Identifier: GPL-3.0-or-later
// The parametric Krawczyk operator: the only zero y(t) in Y = [−r, r]^K of K equations g(y, t) = 0, for all t of a box
// T.
//
// For T with midpoint m, any ŷ in Y and any matrix A, let ρ be the largest row sum of |I − A g_y(Y, T)|. If ρ < 1 there
// is at most one zero in Y for every t in T; and exactly one, y(t), where Y contains the boxes                      (a)
//   D = ŷ ± δ,  δ = max_i |A g(ŷ, m)|_i / (1 − ρ),
//   Z = ŷ ± w,  w = max_i (|A g(ŷ, m)|_i + |A g_t(D, T)|_i |T|/2) / (1 − ρ),                                        (b)
// which then hold y(m) and y(t). Any box Z' of Y with ŷ that holds y(t) is narrowed to
//   K(T) = ŷ − A g(ŷ, m) − A g_t(D, T) (T − m) + (I − A g_y(Z', T)) (Z' − ŷ).                                       (c)
// y is a centred form over T: its slopes from m are −(A g_y)^-1 A g_t(D, T), enclosed with the bound of neumann.h; at m
// alone (c) with D in place of Z' is as tight as the residual is small. Proof: docs/theory.md, "A motion that is only
// implied".
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "certify/arithmetic/neumann.h"
#include "certify/arithmetic/slope_form.h"

namespace taut {

/// Where equations are enclosed.
enum class EvaluationDomain { kAtMid, kOverBox };

/// Slopes of g in t from m, at one y and for every t of T: g(y, t) − g(y, m) = (t − m)(by_t + (t − m) bend).
template <std::size_t K, class I>
struct EquationSlopes {
  std::array<I, K> by_t;
  std::array<I, K> bend;
};

/// `System` has  std::array<I, K> values(const std::array<I, K>& y)  enclosing g(y, m);
/// Square<I, K> derivatives(const std::array<I, K>& y, EvaluationDomain)  enclosing g_y, one row an equation, for y in
/// a box, at m or over T; and  EquationSlopes<K, I> slopes(const std::array<I, K>& y)  for each y of a box.
template <std::size_t K, class I, class System>
class ParametricKrawczyk {
 public:
  ParametricKrawczyk(const System& system, const I& offset, double radius)
      : system_(system), offset_(offset), radius_(radius) {}

  /// y over T; false if (a) or (b) fails.
  [[nodiscard]] bool enclose(std::array<SlopeForm<I>, K>& y) {
    if (!(radius_ > 0) || !std::isfinite(radius_) || !start_newton()) return false;
    Vector box;
    box.fill(I(-radius_, radius_));
    const Square<I, K> over_tube = rest(box);
    Upper gap;
    if (!contracts(over_tube, gap)) return false;
    const I delta = ProofScalarTraits<I>::symmetric(largest(residual_) / gap);
    if (!stays_inside(delta, box)) return false;
    const Vector drift = drift_at(box);
    Vector reach = residual_;
    for (std::size_t i = 0; i < K; ++i) {
      reach[i] = ProofScalarTraits<I>::symmetric(Upper(magnitude(residual_[i])) + Upper(magnitude(drift[i] * offset_)));
    }
    const I w = ProofScalarTraits<I>::symmetric(largest(reach) / gap);
    if (!stays_inside(w, box)) return false;
    // Narrowed by (c) twice; ŷ stays in the box.
    const Vector known = narrowed(over_tube, box, drift);
    for (std::size_t i = 0; i < K; ++i) box[i] = hull(known[i], centre_[i]);
    const Square<I, K> over_box = rest(box);
    Square<Upper, K> q;
    if (!neumann_bound<I>(magnitudes(over_box), q)) return false;
    const Vector image = narrowed(over_box, box, drift);
    for (std::size_t i = 0; i < K; ++i) {
      Upper error(0.0);
      for (std::size_t k = 0; k < K; ++k) error += q[i][k] * Upper(magnitude(drift[k]));
      y[i].range = intersect(image[i], known[i]);
      y[i].slope = ProofScalarTraits<I>::symmetric(error) - drift[i];
      I at_mid = centre_[i] - residual_[i];
      for (std::size_t k = 0; k < K; ++k) at_mid = at_mid + over_box[i][k] * delta;
      y[i].at_mid = intersect(at_mid, y[i].range);
    }
    return true;
  }

 private:
  using Point = typename ProofScalarTraits<I>::Point;
  using Upper = UpperOf<I>;
  using Vector = std::array<I, K>;

  [[nodiscard]] Square<I, K> times_a(const Square<I, K>& x) const {
    Square<I, K> result;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) result[i][k] = a_[i][0] * x[0][k];
      for (std::size_t l = 1; l < K; ++l) {
        for (std::size_t k = 0; k < K; ++k) result[i][k] = result[i][k] + a_[i][l] * x[l][k];
      }
    }
    return result;
  }

  [[nodiscard]] Vector times_a(const Vector& x) const {
    Vector result;
    for (std::size_t i = 0; i < K; ++i) {
      result[i] = a_[i][0] * x[0];
      for (std::size_t l = 1; l < K; ++l) result[i] = result[i] + a_[i][l] * x[l];
    }
    return result;
  }

  static Square<Upper, K> magnitudes(const Square<I, K>& x) {
    Square<Upper, K> result;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) result[i][k] = Upper(magnitude(x[i][k]));
    }
    return result;
  }

  /// Chooses A and ŷ: any choice is sound, a good one is near g_y^-1 and y(m).
  [[nodiscard]] bool start_newton() {
    centre_.fill(I(0.0));
    const Square<I, K> g_y = system_.derivatives(centre_, EvaluationDomain::kAtMid);
    Eigen::Matrix<double, static_cast<int>(K), static_cast<int>(K)> mid;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) {
        mid(static_cast<int>(i), static_cast<int>(k)) = 0.5 * (lower_bound(g_y[i][k]) + upper_bound(g_y[i][k]));
      }
    }
    const auto inverse = mid.inverse().eval();
    if (!inverse.allFinite()) return false;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) a_[i][k] = Point(inverse(static_cast<int>(i), static_cast<int>(k)));
    }
    // Simplified Newton: each step gains the digits that the curvature over the tube leaves, or those of a binary64.
    constexpr int kMostSteps = 60;
    double last = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector correction = times_a(system_.values(centre_));
      double size = 0;
      for (std::size_t i = 0; i < K; ++i) {
        const Point y = ProofScalarTraits<I>::point(centre_[i] - correction[i]);
        centre_[i] = I(y);
        const double moved = ProofScalarTraits<I>::to_double(Upper(magnitude(correction[i])));
        size = std::max(size, moved);
        if (!(ProofScalarTraits<I>::to_double(Upper(magnitude(centre_[i]))) < radius_)) return false;
      }
      if (!(size < 0.5 * last)) break;  // what is left is the width of the enclosures
      last = size;
    }
    residual_ = times_a(system_.values(centre_));
    return true;
  }

  /// I − A g_y over a box and T.
  [[nodiscard]] Square<I, K> rest(const Vector& box) const {
    Square<I, K> result = times_a(system_.derivatives(box, EvaluationDomain::kOverBox));
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) result[i][k] = I(i == k ? 1.0 : 0.0) - result[i][k];
    }
    return result;
  }

  /// Whether ρ < 1, with 1 − ρ rounded down.
  [[nodiscard]] static bool contracts(const Square<I, K>& rest, Upper& gap) {
    Upper rho(0.0);
    for (const auto& row : rest) {
      Upper row_sum(0.0);
      for (const I& x : row) row_sum += Upper(magnitude(x));
      if (!(row_sum < Upper(1.0))) return false;  // also where a NaN slipped in, which max() would drop
      rho = std::max(rho, row_sum);
    }
    gap = ProofScalarTraits<I>::one_minus_lower(rho);
    return Upper(0.0) < gap;
  }

  static Upper largest(const Vector& x) {
    Upper result(0.0);
    for (const I& entry : x) result = std::max(result, Upper(magnitude(entry)));
    return result;
  }

  /// Sets `box` to ŷ + `around`. @returns whether it is inside the tube
  [[nodiscard]] bool stays_inside(const I& around, Vector& box) const {
    for (std::size_t i = 0; i < K; ++i) {
      box[i] = centre_[i] + around;
      if (!(lower_bound(box[i]) > -radius_ && upper_bound(box[i]) < radius_)) return false;
    }
    return true;
  }

  /// A g_t: slopes from m, at each y of a box.
  [[nodiscard]] Vector drift_at(const Vector& box) const {
    const EquationSlopes<K, I> slopes = system_.slopes(box);
    Vector drift = times_a(slopes.by_t);
    const Vector bend = times_a(slopes.bend);
    for (std::size_t i = 0; i < K; ++i) drift[i] = drift[i] + bend[i] * offset_;
    return drift;
  }

  /// (c) within a box that contains ŷ.
  [[nodiscard]] Vector narrowed(const Square<I, K>& rest, const Vector& box, const Vector& drift) const {
    Vector result;
    for (std::size_t i = 0; i < K; ++i) {
      I image = centre_[i] - residual_[i] - drift[i] * offset_;
      for (std::size_t k = 0; k < K; ++k) image = image + rest[i][k] * (box[k] - centre_[k]);
      result[i] = intersect(image, box[i]);
    }
    return result;
  }

  const System& system_;
  const I& offset_;
  double radius_;
  Square<Point, K> a_;  ///< A; its entries are exact numbers once chosen
  Vector centre_;       ///< ŷ, thin
  Vector residual_;     ///< A g(ŷ, m)
};

}  // namespace taut
