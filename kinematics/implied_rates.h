// SPDX-License-Identifier: GPL-3.0-or-later
// How motions move that equations imply (segment.h): their first N derivatives by s, N being 2 or 3.
//
// Where F(y(s), s) = 0 and F_y is regular at y(s), y is as smooth as F (implicit function theorem), and in turn
//   y_n = −F_y^-1 (F(y, s))_n,
// the n-th derivatives, where those of y below y_n are known and y_n is taken for 0.
// Constraints: F = C(ℓ + N y). Cable lengths: with R' = [w] R and x_i = R b_i, |d_i|² = L_i² gives three times, as L_i
// is straight,
//   d·(p' + w × x) = L L',   d·(p'' + w' × x) = L'² − |d'|² − d·(w × x'),
//   d·(p''' + w'' × x) = −3 d'·d'' − d·(2 w' × x' + w × x'').
// docs/theory.md, "Implied motions in time".
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <span>
#include <vector>

#include "kinematics/jet.h"
#include "kinematics/path_rates.h"

namespace taut {

/// λ = ℓ + N y in a space with constraints, for every s in `range`; unknowns are the first `count` of six.
template <class S, int N>
class ConstrainedCurve {
 public:
  using Parameters = boost::container::static_vector<Taylor<S, N>, kMaxConstrainedParameters>;

  /// @pre each control point has a finite entry of N for each constraint
  ConstrainedCurve(const Segment& segment, std::size_t count, const S& range) : count_(count) {
    for (std::size_t j = 0; j < segment.control[0]->parameters().x.size(); ++j) {
      line_.push_back(with_derivatives<N>(coordinate_polynomial<S>(segment, j), range));
      for (std::size_t i = 0; i < count; ++i) {
        normals_.push_back(with_derivatives<N>(normal_polynomial<S>(segment, j * count + i), range));
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  /// @param y  with its derivatives
  [[nodiscard]] Parameters at(const std::array<Taylor<S, N>, 6>& y) const {
    Parameters result = line_;
    for (std::size_t j = 0; j < line_.size(); ++j) {
      for (std::size_t i = 0; i < count_; ++i) result[j] = result[j] + normals_[j * count_ + i] * y[i];
    }
    return result;
  }

  using Gradients = boost::container::static_vector<Jet<S, kMaxConstrainedParameters>, kMaxConstrainedParameters>;
  /// C' at the parameters `lambda`.
  [[nodiscard]] Gradients gradients(const Evaluator<Jet<S, kMaxConstrainedParameters>>& constraints,
                                    std::span<const S> lambda) const {
    using J = Jet<S, kMaxConstrainedParameters>;
    std::array<J, kMaxConstrainedParameters> at;
    for (std::size_t j = 0; j < lambda.size(); ++j) at[j] = J(lambda[j], static_cast<int>(j));
    Gradients result(count_);
    constraints.evaluate(std::span<const J>(at.data(), lambda.size()), std::span<J>(result.data(), count_));
    return result;
  }

  /// F_y = C' N; the rest of it is that of the unit matrix.
  [[nodiscard]] Matrix6<S> by_unknowns(const Gradients& c) const {
    Matrix6<S> result;
    for (int e = 0; e < 6; ++e) {
      for (int i = 0; i < 6; ++i) result(e, i) = S(e == i ? 1.0 : 0.0);
    }
    for (std::size_t e = 0; e < count_; ++e) {
      for (std::size_t i = 0; i < count_; ++i) {
        S sum(0.0);
        for (std::size_t j = 0; j < line_.size(); ++j) sum = sum + c[e].partial[j] * normals_[j * count_ + i].d[0];
        result(static_cast<int>(e), static_cast<int>(i)) = sum;
      }
    }
    return result;
  }

  /// F_s = C' (ℓ' + N' y), likewise.
  [[nodiscard]] Vector6<S> by_place(const Gradients& c, const Vector6<S>& y) const {
    Vector6<S> result;
    result.fill(S(0.0));
    for (std::size_t j = 0; j < line_.size(); ++j) {
      S moved = line_[j].d[1];
      for (std::size_t i = 0; i < count_; ++i) moved = moved + normals_[j * count_ + i].d[1] * y(static_cast<int>(i));
      for (std::size_t e = 0; e < count_; ++e) {
        S& sum = result(static_cast<int>(e));
        sum = sum + c[e].partial[j] * moved;
      }
    }
    return result;
  }

 private:
  std::size_t count_;
  Parameters line_;  ///< ℓ
  /// N by rows.
  boost::container::static_vector<Taylor<S, N>, kMaxConstrainedParameters * kMaxConstrainedParameters> normals_;
};

/// λ with its derivatives, where y are the unknowns that satisfy C(λ) = 0, `gradients` are C' there and divide(v) is
/// F_y^-1 v.
template <class S, int N, class Divide>
[[nodiscard]] typename ConstrainedCurve<S, N>::Parameters implied_parameters(
    const Evaluator<Taylor<S, N>>& constraints, const ConstrainedCurve<S, N>& curve,
    const typename ConstrainedCurve<S, N>::Gradients& gradients, const Vector6<S>& y, const Divide& divide) {
  std::array<Taylor<S, N>, 6> unknowns;
  for (std::size_t i = 0; i < 6; ++i) unknowns[i] = Taylor<S, N>(y(static_cast<int>(i)));
  Vector6<S> left = curve.by_place(gradients, y);  // what F changes by if y^(n) is 0
  for (std::size_t n = 1; n <= N; ++n) {
    if (n > 1) {
      const auto at = curve.at(unknowns);
      std::array<Taylor<S, N>, kMaxConstrainedParameters> values;
      constraints.evaluate(std::span(at.data(), at.size()), std::span(values.data(), curve.count()));
      for (std::size_t e = 0; e < curve.count(); ++e) left(static_cast<int>(e)) = values[e].d[n];
    }
    Vector6<S> rest;
    for (int e = 0; e < 6; ++e) rest(e) = -left(e);
    const Vector6<S> found = divide(rest);
    for (std::size_t i = 0; i < curve.count(); ++i) unknowns[i].d[n] = found(static_cast<int>(i));
  }
  return curve.at(unknowns);
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
template <int N, class S, class Divide>
[[nodiscard]] PathRatesOf<S, N> rates_of_lengths(const Model<S>& model, const Vector3<S>& p_WP, const Matrix3<S>& r_WP,
                                                 const Segment& segment, const S& range, const Divide& divide) {
  struct Cable {
    S length, rate;
    Vector3<S> x, d, d1;
  };
  std::array<Cable, kCables> cables;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Polynomial<S> line = length_polynomial<S>(segment, i);
    Cable& cable = cables[i];
    cable.length = line.at(range);
    cable.rate = line.slope(range);
    cable.x = turned(r_WP, model.p_PB[i]);
    for (int k = 0; k < 3; ++k) cable.d(k) = p_WP(k) + cable.x(k) - model.p_WA[i](k);
  }
  const auto sum = [](const Vector3<S>& a, const Vector3<S>& b) {
    return Vector3<S>(a(0) + b(0), a(1) + b(1), a(2) + b(2));
  };
  const auto dot = [](const Vector3<S>& a, const Vector3<S>& b) { return S(a(0) * b(0) + a(1) * b(1) + a(2) * b(2)); };
  // A derivative of (p, turning), from its products with the rows of length_gradients().
  const auto solve = [&](const auto& product, Vector3<S>& p, Vector3<S>& w) {
    Vector6<S> products;
    for (int i = 0; i < 6; ++i) products(i) = product(cables[static_cast<std::size_t>(i)]);
    const Vector6<S> found = divide(products);
    for (int k = 0; k < 3; ++k) {
      p(k) = found(k);
      w(k) = found(3 + k);
    }
  };
  PathRatesOf<S, N> result;
  result.p = p_WP;
  result.r_WP = r_WP;
  solve([](const Cable& c) { return S(c.length * c.rate); }, result.p1, result.w);
  const auto first = [&](const Cable& c) { return Vector3<S>(cross(result.w, c.x)); };             // x'
  const auto centripetal = [&](const Cable& c) { return Vector3<S>(cross(result.w, first(c))); };  // w × x'
  for (Cable& c : cables) c.d1 = sum(result.p1, first(c));
  const auto of_second = [&](const Cable& c) {
    return S(sqr(c.rate) - (sqr(c.d1(0)) + sqr(c.d1(1)) + sqr(c.d1(2))) - dot(c.d, centripetal(c)));
  };
  solve(of_second, result.p2, result.w1);
  if constexpr (N == 3) {
    const auto of_third = [&](const Cable& c) {
      const Vector3<S> second = sum(cross(result.w1, c.x), centripetal(c)), once = cross(result.w1, first(c));
      return S(-(S(3.0) * dot(c.d1, sum(result.p2, second))) - dot(c.d, sum(sum(once, once), cross(result.w, second))));
    };
    solve(of_third, result.p3, result.w2);
  }
  return result;
}

}  // namespace taut
