// SPDX-License-Identifier: GPL-3.0-or-later
// The parametric Krawczyk operator: the only zero y(t) in Y = [−r, r]^K of K equations g(y, t) = 0, for all t of a box
// T.
//
// For T with midpoint m, any ŷ in Y and any matrix A, let ρ be the largest row sum of |I − A g_y(Y, T)|. If ρ < 1 there
// is at most one zero in Y for every t in T; and exactly one, y(t), where Y contains the
// box                         (a)
//   ŷ ± w,   w = max_i (|A g(ŷ, m)|_i + |A g_t(Y, T)|_i |T|/2) / (1 − ρ),                                           (b)
// which then holds y(t). With any box Z around ŷ that holds it, in Y, the operator narrows it to
//   K(T) = ŷ − A g(ŷ, m) − A g_t(Z, T) (T − m) + (I − A g_y(Z, T)) (Z − ŷ).                                         (c)
// y is a centred form over T: its slopes from m are −(A g_y)^-1 A g_t, enclosed with the bound of neumann.h; at m alone
// a box of the size of the residual encloses y(m) tightly. Proof: docs/theory.md, "A motion that is only implied".
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

template <std::size_t K, class I>
struct EquationDerivatives {
  Square<I, K> by_y;  ///< g_y: one row an equation
  /// Slopes of g in t from m, at one y and for every t of T: g(y, t) − g(y, m) = (t − m)(by_t + (t − m) bend). Only
  /// over the box.
  std::array<I, K> by_t;
  std::array<I, K> bend;
};

/// `System` has  std::array<I, K> values(const std::array<I, K>& y)  enclosing g(y, m), and
/// EquationDerivatives<K, I> derivatives(const std::array<I, K>& y, EvaluationDomain)  for y in a box, at m or over T.
template <std::size_t K, class I, class System>
class ParametricKrawczyk {
 public:
  ParametricKrawczyk(const System& system, const I& offset, double radius)
      : system_(system), offset_(offset), radius_(radius) {}

  /// y over T; false if (a) or (b) fails.
  [[nodiscard]] bool enclose(std::array<SlopeForm<I>, K>& y) {
    if (!(radius_ > 0) || !std::isfinite(radius_) || !start_newton()) return false;
    Vector whole;
    whole.fill(I(-radius_, radius_));
    Vector inside;
    if (!stay_inside(krawczyk(whole), inside)) return false;
    const Step second = krawczyk(inside);
    Square<Upper, K> q;
    if (!neumann_bound<I>(magnitudes(second.rest), q)) return false;
    for (std::size_t i = 0; i < K; ++i) {
      Upper error(0.0);
      for (std::size_t k = 0; k < K; ++k) error += q[i][k] * Upper(magnitude(second.drift[k]));
      y[i].range = intersect(second.image[i], inside[i]);
      y[i].slope = ProofScalarTraits<I>::symmetric(error) - second.drift[i];
      y[i].at_mid = y[i].range;
    }
    enclose_at_mid(y);
    return true;
  }

 private:
  using Point = typename ProofScalarTraits<I>::Point;
  using Upper = UpperOf<I>;
  using Vector = std::array<I, K>;

  struct Step {
    Vector image;       ///< (c)
    Square<I, K> rest;  ///< I − A g_y
    Vector drift;       ///< A g_t: slopes from m
  };

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

  static Square<I, K> one_minus(Square<I, K> x) {
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) x[i][k] = I(i == k ? 1.0 : 0.0) - x[i][k];
    }
    return x;
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
    const Square<I, K> g_y = system_.derivatives(centre_, EvaluationDomain::kAtMid).by_y;
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

  /// The box ŷ ± w of (b), where it is inside the tube and ρ < 1.
  [[nodiscard]] bool stay_inside(const Step& over_tube, Vector& box) const {
    Upper rho(0.0);
    Upper largest(0.0);
    for (std::size_t i = 0; i < K; ++i) {
      Upper row_sum(0.0);
      for (const I& x : over_tube.rest[i]) row_sum += Upper(magnitude(x));
      if (!(row_sum < Upper(1.0))) return false;  // also where a NaN slipped in, which max() would drop
      rho = std::max(rho, row_sum);
      largest = std::max(largest, Upper(magnitude(residual_[i])) + Upper(magnitude(over_tube.drift[i] * offset_)));
    }
    const Upper gap = ProofScalarTraits<I>::one_minus_lower(rho);
    if (!(Upper(0.0) < gap)) return false;
    const I w = ProofScalarTraits<I>::symmetric(largest / gap);
    for (std::size_t i = 0; i < K; ++i) {
      box[i] = centre_[i] + w;
      if (!(lower_bound(box[i]) > -radius_ && upper_bound(box[i]) < radius_)) return false;
    }
    return true;
  }

  /// (c) for a box Z that contains ŷ.
  [[nodiscard]] Step krawczyk(const Vector& box) const {
    const EquationDerivatives<K, I> over = system_.derivatives(box, EvaluationDomain::kOverBox);
    Step step;
    step.rest = one_minus(times_a(over.by_y));
    step.drift = times_a(over.by_t);
    const Vector bend = times_a(over.bend);
    for (std::size_t i = 0; i < K; ++i) step.drift[i] = step.drift[i] + bend[i] * offset_;
    for (std::size_t i = 0; i < K; ++i) {
      I image = centre_[i] - residual_[i] - step.drift[i] * offset_;
      for (std::size_t k = 0; k < K; ++k) image = image + step.rest[i][k] * (box[k] - centre_[k]);
      step.image[i] = image;
    }
    return step;
  }

  /// Narrows y(m) by a Krawczyk test at m alone in a box ŷ ± δ within the tube: the zero in it is the one in the tube.
  void enclose_at_mid(std::array<SlopeForm<I>, K>& y) const {
    constexpr double kRoom = 4.0;
    double largest = 0;
    for (const I& r : residual_) largest = std::max(largest, ProofScalarTraits<I>::to_double(Upper(magnitude(r))));
    const double delta = kRoom * largest + std::numeric_limits<double>::min();
    Vector box;
    for (std::size_t i = 0; i < K; ++i) {
      box[i] = centre_[i] + I(-delta, delta);
      if (!(lower_bound(box[i]) > -radius_ && upper_bound(box[i]) < radius_)) return;
    }
    const Square<I, K> rest = one_minus(times_a(system_.derivatives(box, EvaluationDomain::kAtMid).by_y));
    Vector image;
    for (std::size_t i = 0; i < K; ++i) {
      I step = I(0.0) - residual_[i];
      for (std::size_t k = 0; k < K; ++k) step = step + rest[i][k] * I(-delta, delta);
      if (!(lower_bound(step) > -delta && upper_bound(step) < delta)) return;
      image[i] = centre_[i] + step;
    }
    for (std::size_t i = 0; i < K; ++i) y[i].at_mid = intersect(image[i], y[i].range);
  }

  const System& system_;
  const I& offset_;
  double radius_;
  Square<Point, K> a_;  ///< A; its entries are exact numbers once chosen
  Vector centre_;       ///< ŷ, thin
  Vector residual_;     ///< A g(ŷ, m)
};

}  // namespace taut
