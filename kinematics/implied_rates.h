// SPDX-License-Identifier: GPL-3.0-or-later
// How motions move that equations imply (segment.h): their derivatives by s, for any scalar.
//
// Where F(y(s), s) = 0 and F_y is regular at y(s), y is as smooth as F (implicit function theorem). With y, y' and y''
// in jets of jets,
//   y'  = −F_y^-1 (F(y, s))'   where y' is taken for 0,
//   y'' = −F_y^-1 (F(y, s))''  where y' is known and y'' is taken for 0.
// Constraints: F = C(ℓ + N y). Cable lengths: with v = p' and R' = [w] R, |d_i|² = L_i² gives twice
//   d_i·(p' + w × x_i) = L_i L_i',   d_i·(p'' + w' × x_i) = L_i'² − |d_i'|² − d_i·(w × (w × x_i)),   x_i = R b_i.
// docs/theory.md, "Implied motions in time".
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kinematics/path_rates.h"

namespace taut {

/// λ = ℓ + N y in a space with constraints, for every s in `range`; unknowns are the first `count` of six.
template <class S>
class ConstrainedCurve {
 public:
  /// @pre each control point has a finite entry of N for each constraint
  ConstrainedCurve(const Segment& segment, std::size_t count, const S& range) : count_(count) {
    for (std::size_t j = 0; j < segment.control[0]->x.size(); ++j) {
      line_.push_back(second_jet(coordinate_polynomial<S>(segment, j), range));
      for (std::size_t i = 0; i < count; ++i) {
        normals_.push_back(second_jet(normal_polynomial<S>(segment, j * count + i), range));
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] std::vector<SecondJet<S>> at(const Vector6<S>& y, const Vector6<S>& y1, const Vector6<S>& y2) const {
    std::vector<SecondJet<S>> result = line_;
    for (std::size_t j = 0; j < line_.size(); ++j) {
      for (std::size_t i = 0; i < count_; ++i) {
        const auto n = static_cast<int>(i);
        result[j] = result[j] + normals_[j * count_ + i] * second_jet<S>(y(n), y1(n), y2(n));
      }
    }
    return result;
  }

  /// F_y = C' N at the parameters `lambda`; the rest of it is that of the unit matrix.
  [[nodiscard]] Matrix6<S> by_unknowns(const Evaluator<Jet<S, kMaxConstrainedParameters>>& constraints,
                                       std::span<const S> lambda) const {
    using J = Jet<S, kMaxConstrainedParameters>;
    std::vector<J> at(lambda.size()), c(count_);
    for (std::size_t j = 0; j < lambda.size(); ++j) at[j] = J(lambda[j], static_cast<int>(j));
    constraints.evaluate(at, c);
    Matrix6<S> result;
    for (int e = 0; e < 6; ++e) {
      for (int i = 0; i < 6; ++i) result(e, i) = S(e == i ? 1.0 : 0.0);
    }
    for (std::size_t e = 0; e < count_; ++e) {
      for (std::size_t i = 0; i < count_; ++i) {
        S sum(0.0);
        for (std::size_t j = 0; j < lambda.size(); ++j) {
          sum = sum + c[e].partial[j] * value_of(normals_[j * count_ + i]);
        }
        result(static_cast<int>(e), static_cast<int>(i)) = sum;
      }
    }
    return result;
  }

 private:
  std::size_t count_;
  std::vector<SecondJet<S>> line_;     ///< ℓ
  std::vector<SecondJet<S>> normals_;  ///< N by rows
};

namespace implied_rates_detail {

template <class S>
[[nodiscard]] Vector6<S> zeros() {
  Vector6<S> result;
  for (int k = 0; k < 6; ++k) result(k) = S(0.0);
  return result;
}

}  // namespace implied_rates_detail

/// λ with its derivatives, where y are the unknowns that satisfy C(λ) = 0 and divide(v) is F_y^-1 v.
template <class S, class Divide>
[[nodiscard]] std::vector<SecondJet<S>> implied_parameters(const Evaluator<SecondJet<S>>& constraints,
                                                           const ConstrainedCurve<S>& curve, const Vector6<S>& y,
                                                           const Divide& divide) {
  const Vector6<S> none = implied_rates_detail::zeros<S>();
  const auto minus_divided = [&](const Vector6<S>& y1, const S& (*derivative)(const SecondJet<S>&)) {
    std::vector<SecondJet<S>> values(curve.count());
    constraints.evaluate(curve.at(y, y1, none), values);
    Vector6<S> rest = none;
    for (std::size_t e = 0; e < values.size(); ++e) rest(static_cast<int>(e)) = -derivative(values[e]);
    return Vector6<S>(divide(rest));
  };
  const Vector6<S> y1 = minus_divided(none, first_of<S>);
  const Vector6<S> y2 = minus_divided(y1, second_of<S>);
  return curve.at(y, y1, y2);
}

/// Row i is (d_i ; R b_i × d_i), which multiplied by (p' ; w) is d_i·d_i'.
template <class S>
[[nodiscard]] Matrix6<S> length_gradients(const Model<S>& model, const Vector3<S>& p_WP, const Matrix3<S>& r_WP) {
  Matrix6<S> result;
  for (int i = 0; i < 6; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Vector3<S> x = turned(r_WP, model.p_PB[n]);
    Vector3<S> from_base;
    for (int k = 0; k < 3; ++k) from_base(k) = p_WP(k) - model.p_WA[n](k);
    const Vector3<S> moment = cross(x, from_base);  // = x × d
    for (int k = 0; k < 3; ++k) {
      result(i, k) = from_base(k) + x(k);
      result(i, 3 + k) = moment(k);
    }
  }
  return result;
}

/// For every s in `range`, of a segment that is straight in cable lengths: (p, R) is the pose there, and divide(v) is
/// the inverse of length_gradients() times v.
template <class S, class Divide>
[[nodiscard]] PathRates<S> rates_of_lengths(const Model<S>& model, const Vector3<S>& p_WP, const Matrix3<S>& r_WP,
                                            const Segment& segment, const S& range, const Divide& divide) {
  constexpr std::size_t kFirstLength = 7;
  std::array<S, kCables> lengths, length_rates;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Polynomial<S> line = coordinate_polynomial<S>(segment, kFirstLength + i);
    lengths[i] = line.at(range);
    length_rates[i] = line.slope(range);
  }
  PathRates<S> result;
  result.p = p_WP;
  result.r_WP = r_WP;
  Vector6<S> products;
  for (int i = 0; i < 6; ++i) {
    const auto n = static_cast<std::size_t>(i);
    products(i) = lengths[n] * length_rates[n];
  }
  const Vector6<S> first = divide(products);
  for (int k = 0; k < 3; ++k) {
    result.p1(k) = first(k);
    result.w(k) = first(3 + k);
  }
  Vector6<S> rest;
  for (int i = 0; i < 6; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Vector3<S> x = turned(r_WP, model.p_PB[n]);
    const Vector3<S> turning = cross(result.w, x), centripetal = cross(result.w, turning);
    rest(i) = sqr(length_rates[n]);
    for (int k = 0; k < 3; ++k) {
      const S d = p_WP(k) + x(k) - model.p_WA[n](k);
      rest(i) = rest(i) - sqr(S(result.p1(k) + turning(k))) - d * centripetal(k);
    }
  }
  const Vector6<S> second = divide(rest);
  for (int k = 0; k < 3; ++k) {
    result.p2(k) = second(k);
    result.w1(k) = second(3 + k);
  }
  return result;
}

}  // namespace taut
