#include "certify/checker/deviation.h"

namespace taut::checker {
namespace {

Interval length(const Vector3<Interval>& x) { return sqrt(squared_norm(x)); }

Vector3<Interval> widened(Vector3<Interval> x, const Interval& by) {
  for (Interval& component : x) component += by * Interval::plus_minus_one();
  return x;
}

Vector3<Interval> range(const Vector3<Form>& x) { return {x[0].range, x[1].range, x[2].range}; }

/// The first and the last three entries of a row of D^-1.
struct Row {
  Vector3<Interval> f;
  Vector3<Interval> m;
  explicit Row(const Vector6<Interval>& y) : f{y[0], y[1], y[2]}, m{y[3], y[4], y[5]} {}
};

Deviation scaled(const Deviation& x, const Interval& part) {
  Deviation result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.base[i] = part * x.base[i];
    result.platform[i] = part * x.platform[i];
    result.length[i] = part * x.length[i];
    result.wrench[i] = part * x.wrench[i];
  }
  result.load_point = part * x.load_point;
  result.position = part * x.position;
  result.angle = part * x.angle;
  return result;
}

/// Everything that the rates are made of, for every u and every deviation scaled by no more than a part.
class Family {
 public:
  Family(const Model& model, const Geometry& geometry, const Inverse& inverse, const Commanded& commanded,
         const Interval& part)
      : model_(model) {
    const Deviation within = scaled(*model.deviation(), part);
    angle_ = within.angle;
    const Interval moved = part * commanded.moved + within.position;
    const Interval turned = part * commanded.turned + within.angle;  // a chord is no longer than its arc
    const Matrix3<Interval> R = {range(commanded.pose.R[0]), range(commanded.pose.R[1]), range(commanded.pose.R[2])};
    Matrix6<Interval> A = inverse.A;
    for (std::size_t i = 0; i < 6; ++i) {
      const Interval b_change = turned * checker::length(model.platform_anchors()[i]) + within.platform[i];
      const Interval d_change = moved + b_change + within.base[i];
      const Interval r_change = turned * checker::length(model.arms()[i]) + within.platform[i] + within.load_point;
      const Vector3<Interval> d = range(geometry.d[i]);
      const Vector3<Interval> r = range(geometry.arm[i]);
      for (std::size_t k = 0; k < 6; ++k) {  // C_k . (D_i' - D_i), as y_r . D_i' in the header, and to second order
        const Row C(inverse.C[k]);
        A[k][i] += (checker::length(C.f + cross(C.m, r)) * d_change + checker::length(cross(d, C.m)) * r_change +
                    checker::length(C.m) * d_change * r_change) *
                   Interval::plus_minus_one();
      }
      d_[i] = widened(d, d_change);
      r_[i] = widened(r, r_change);
      length_[i] = geometry.length[i].range + d_change * Interval::plus_minus_one();
      if (!certainly_positive(length_[i])) throw Undefined("a cable may have no length");
      for (std::size_t c = 0; c < 3; ++c) u_[i][c] = d_[i][c] / length_[i];
      Rb_[i] = widened(multiply(R, model.platform_anchors()[i]), b_change);
      wrench_[i] = model.wrench()[i] + within.wrench[i] * Interval::plus_minus_one();
    }
    Rp_m_ = widened(multiply(R, model.load_point()), turned * checker::length(model.load_point()) + within.load_point);
    Y_ = inverses(inverse.C, A);
    x_ = multiply(Y_, wrench_);
    const Matrix6<Interval>& M_inverse = model.ellipsoid_factor();
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        for (std::size_t j = 0; j <= k; ++j) z_[i][k] += M_inverse[k][j] * Y_[i][j];
      }
    }
  }

  /// Bounds of |F_r'| for c = factor and -factor, the second first.
  [[nodiscard]] std::array<Interval, 2> tension_rates(std::size_t r, const Interval& factor, bool is_held) const {
    const Row y(Y_[r]);
    std::array<Vector3<Interval>, 6> h, q;
    Vector6<Interval> overlap;  // z_r . z_i / V_r
    for (std::size_t i = 0; i < 6; ++i) {
      h[i] = y.f + cross(y.m, r_[i]);
      q[i] = cross(d_[i], y.m);
      for (std::size_t k = 0; k < 6; ++k) overlap[i] += i == r ? sqr(z_[r][k]) : z_[r][k] * z_[i][k];
    }
    const Interval V = sqrt(overlap[r]);
    for (std::size_t i = 0; i < 6; ++i) overlap[i] = i == r ? V : overlap[i] / V;
    return {tension_rate(r, -factor, overlap, h, q, is_held), tension_rate(r, factor, overlap, h, q, is_held)};
  }

  /// A bound of the rate of |d_i|.
  [[nodiscard]] Interval length_rate(std::size_t i) const {
    const Deviation& whole = *model_.deviation();
    return whole.position + whole.angle * length(cross(Rb_[i], u_[i])) + whole.base[i] + whole.platform[i];
  }

 private:
  using Vectors = std::array<Vector3<Interval>, 6>;

  [[nodiscard]] Interval tension_rate(std::size_t r, const Interval& c, const Vector6<Interval>& overlap,
                                      const Vectors& h, const Vectors& q, bool is_held) const {
    const Deviation& whole = *model_.deviation();
    Vector6<Interval> pull;  // |d_r| kappa_i
    for (std::size_t i = 0; i < 6; ++i) pull[i] = length_[r] * (x_[i] + c * overlap[i]);
    const Vector3<Interval> own = (x_[r] + c * overlap[r]) * u_[r];  // phi u_r

    Vector3<Interval> P = own;
    Vector3<Interval> Q = cross(Rb_[r], own);
    Vector3<Interval> of_load_point;
    for (std::size_t i = 0; i < 6; ++i) {
      P = P - pull[i] * h[i];
      Q = Q - pull[i] * (cross(Rb_[i], h[i]) + cross(r_[i], q[i]));
      of_load_point = of_load_point + pull[i] * q[i];
    }
    Interval of_wrench;
    for (std::size_t k = 0; k < 6; ++k) of_wrench += Y_[r][k] * whole.wrench[k];
    Interval rate = whole.position * length(P) + whole.angle * length(Q) + whole.load_point * length(of_load_point) +
                    abs(length_[r] * of_wrench);
    for (std::size_t i = 0; i < 6; ++i) {
      Vector3<Interval> of_base = pull[i] * h[i];
      Vector3<Interval> of_platform = -Interval(1) * (pull[i] * (h[i] + q[i]));
      if (i == r) {
        of_base = of_base - own;
        of_platform = of_platform + own;
      }
      if (is_held) {
        const Row y(Y_[i]);
        const Vector3<Interval> turning = widened(y.m, angle_ * length(y.m));
        const Interval of_rho = dot(P, y.f - cross(y.m, Rp_m_)) + dot(Q, turning);
        of_base = of_base + of_rho * d_[i];
        of_platform = of_platform - of_rho * widened(d_[i], angle_ * length_[i]);
        rate += whole.length[i] * length_[i] * abs(of_rho);
      }
      rate += whole.base[i] * length(of_base) + whole.platform[i] * length(of_platform);
    }
    return rate;
  }

  const Model& model_;
  Interval angle_;
  Vectors d_, r_, u_, Rb_;
  Vector3<Interval> Rp_m_;
  Vector6<Interval> length_;
  Vector6<Interval> wrench_;
  Matrix6<Interval> Y_;
  Vector6<Interval> x_;
  Matrix6<Interval> z_;  ///< rows z_r
};

}  // namespace

Losses losses(const Model& model, const Geometry& geometry, const Inverse& inverse, const Commanded& commanded,
              bool is_held, const Interval& k, int steps) {
  Losses result;
  const Interval share = Interval(1) / Interval(steps);
  for (int step = 1; step <= steps; ++step) {
    const Family family(model, geometry, inverse, commanded, Interval(mpq_class(step, steps)));
    for (std::size_t i = 0; i < 6; ++i) {
      if (!is_held) result.length[i] += share * family.length_rate(i);
      const auto plain = family.tension_rates(i, Interval(1), is_held);
      const auto wide = family.tension_rates(i, k, is_held);
      for (std::size_t side = 0; side < 2; ++side) {
        result.tension[i][side] += share * plain[side];
        result.scaled[i][side] += share * wide[side];
      }
    }
  }
  if (!is_held) return result;
  // |d_i| = L_i + e_i at the commanded pose, whatever leads to it; tracking is added to that whole, not part by part.
  const Deviation& whole = *model.deviation();
  for (std::size_t i = 0; i < 6; ++i) {
    const Interval reach = length(model.platform_anchors()[i]) + whole.platform[i];
    result.length[i] = whole.length[i] + whole.position + whole.angle * reach;
  }
  return result;
}

}  // namespace taut::checker
