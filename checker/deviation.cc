#include "checker/deviation.h"

namespace taut::checker {
namespace {

Interval length(const Vector3<Interval>& x) { return sqrt(squared_norm(x)); }

Vector3<Interval> widened(Vector3<Interval> x, const Vector3<Interval>& by) {
  for (std::size_t c = 0; c < 3; ++c) x[c] += by[c] * Interval::plus_minus_one();
  return x;
}
Vector3<Interval> widened(const Vector3<Interval>& x, const Interval& by) { return widened(x, {by, by, by}); }

Vector3<Interval> range(const Vector3<Form>& x) { return {x[0].range, x[1].range, x[2].range}; }

/// The first and the last three entries of a row of D^-1.
struct Row {
  Vector3<Interval> f;
  Vector3<Interval> m;
  explicit Row(const Vector6<Interval>& y) : f{y[0], y[1], y[2]}, m{y[3], y[4], y[5]} {}
};

/// Bounds of how far things are from where they are at t = 0, or of their rates: by coordinates.
struct Moves {
  std::array<Vector3<Interval>, 6> d, r, Rb;
  Vector3<Interval> Rp_m;
  Matrix6<Interval> Y;

  /// Calls visit(ours, a's, b's) for each number.
  template <class Visit>
  void with(const Moves& a, const Moves& b, const Visit& visit) {
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        visit(d[i][c], a.d[i][c], b.d[i][c]);
        visit(r[i][c], a.r[i][c], b.r[i][c]);
        visit(Rb[i][c], a.Rb[i][c], b.Rb[i][c]);
      }
      for (std::size_t k = 0; k < 6; ++k) visit(Y[i][k], a.Y[i][k], b.Y[i][k]);
    }
    for (std::size_t c = 0; c < 3; ++c) visit(Rp_m[c], a.Rp_m[c], b.Rp_m[c]);
  }
};

/// Everything that the rates are made of, for every u and every deviation, during one part of the way.
class Family {
 public:
  /// At t = 0.
  Family(const Model& model, const Geometry& geometry, const Inverse& inverse, const Frame& pose, bool is_held)
      : model_(model), is_held_(is_held), whole_(*model.deviation()) {
    const Matrix3<Interval> R = {range(pose.R[0]), range(pose.R[1]), range(pose.R[2])};
    for (std::size_t i = 0; i < 6; ++i) {
      d_start_[i] = range(geometry.d[i]);
      r_start_[i] = range(geometry.arm[i]);
      Rb_start_[i] = multiply(R, model.platform_anchors()[i]);
      length_start_[i] = geometry.length[i].range;
      b_size_[i] = length(model.platform_anchors()[i]) + whole_.platform[i];
      r_size_[i] = length(model.arms()[i]) + whole_.platform[i] + whole_.load_point;
      for (std::size_t j = 0; j < 6; ++j) Y_start_[i][j] = inverse.Y[i][j].range;
      if (is_held) {
        rho_[i] = (length_start_[i] + whole_.length[i]) * (whole_.length[i] + whole_.base[i] + whole_.platform[i]);
        rho_[i] = abs(rho_[i]);
      }
    }
    Rp_m_start_ = multiply(R, model.load_point());
    Rp_m_size_ = length(model.load_point()) + whole_.load_point;
  }

  /// The next part, `share` of the way, at the end of which the part `until` of the way is covered.
  /// @throws Undefined where no guess holds.
  void advance(const Interval& share, const Interval& until) {
    constexpr int kMostGuesses = 16;
    const Interval room = Interval(mpq_class(9, 8));
    const Interval least = power(Interval(mpq_class(1, 2)), 4 * WorkingPrecision::bits());
    const Moves before = moves_;
    set(before, until);
    for (int k = 0; k < kMostGuesses; ++k) {
      const Moves rate = rates();
      Moves guess;
      guess.with(before, rate, [&](Interval& x, const Interval& from, const Interval& by) {
        x = highest(from + room * share * by + least);
      });
      set(guess, until);
      Moves reached;
      bool holds = true;
      reached.with(before, rates(),
                   [&](Interval& x, const Interval& from, const Interval& by) { x = highest(from + share * by); });
      guess.with(guess, reached, [&](const Interval&, const Interval& allowed, const Interval& x) {
        holds = holds && certainly_nonnegative(allowed - x);
      });
      if (holds) {
        moves_ = reached;
        set_loads(until);
        return;
      }
      for (const Vector6<Interval>& row : reached.Y) {
        for (const Interval& x : row) {
          if (!certainly_nonnegative(Interval(kHopeless) * largest_Y_ - x)) throw Undefined(kNoPose);
        }
      }
    }
    throw Undefined(kNoPose);
  }

  /// Bounds of |F_r'|: for c = -1, 1, and for c = -k, k.
  [[nodiscard]] std::array<Interval, 4> tension_rates(std::size_t r, const Interval& k) const {
    Vectors turned;             // r_i x (h_ri + q_ri)
    Vector6<Interval> overlap;  // z_r . z_i / V_r
    for (std::size_t i = 0; i < 6; ++i) {
      turned[i] = cross(r_[i], h_[r][i] + q_[r][i]);
      for (std::size_t j = 0; j < 6; ++j) overlap[i] += i == r ? sqr(z_[r][j]) : z_[r][j] * z_[i][j];
    }
    const Interval V = sqrt(overlap[r]);
    for (std::size_t i = 0; i < 6; ++i) overlap[i] = i == r ? V : overlap[i] / V;
    return {tension_rate(r, Interval(-1), overlap, turned), tension_rate(r, Interval(1), overlap, turned),
            tension_rate(r, -k, overlap, turned), tension_rate(r, k, overlap, turned)};
  }

  /// A bound of the rate of |d_i|, of a machine that is not held by lengths.
  [[nodiscard]] Interval length_rate(std::size_t i) const {
    return whole_.position + whole_.angle * length(cross(Rb_[i], u_[i])) + whole_.base[i] + whole_.platform[i];
  }

 private:
  using Vectors = std::array<Vector3<Interval>, 6>;
  static constexpr int kHopeless = 64;
  static constexpr const char* kNoPose = "a deviation may lead to a singular pose";

  /// What is there up to the part `until` of the way, if all stays within `moves`.
  void set(const Moves& moves, const Interval& until) {
    largest_Y_ = Interval();
    for (std::size_t i = 0; i < 6; ++i) {
      d_[i] = widened(d_start_[i], moves.d[i]);
      r_[i] = widened(r_start_[i], moves.r[i]);
      Rb_[i] = widened(Rb_start_[i], moves.Rb[i]);
      for (std::size_t j = 0; j < 6; ++j) {
        Y_[i][j] = Y_start_[i][j] + moves.Y[i][j] * Interval::plus_minus_one();
        largest_Y_ = max(largest_Y_, abs(Y_start_[i][j]));
      }
      const Interval change = is_held_ ? whole_.length[i] : whole_.base[i] + whole_.platform[i];
      const Interval tracked = whole_.position + whole_.angle * b_size_[i];
      length_[i] = length_start_[i] + until * (change + tracked) * Interval::plus_minus_one();
      if (!certainly_positive(length_[i])) throw Undefined("a cable may have no length");
      for (std::size_t c = 0; c < 3; ++c) u_[i][c] = d_[i][c] / length_[i];
    }
    Rp_m_ = widened(Rp_m_start_, moves.Rp_m);
    for (std::size_t i = 0; i < 6; ++i) {
      const Row y(Y_[i]);
      for (std::size_t j = 0; j < 6; ++j) {
        w_[i][j] = cross(y.m, r_[j]);
        h_[i][j] = y.f + w_[i][j];
        q_[i][j] = cross(d_[j], y.m);
      }
    }
  }

  /// Of all that Moves is about, on what was set.
  [[nodiscard]] Moves rates() const {
    Interval spin;  // of the commanded pose
    for (std::size_t j = 0; j < 6; ++j) spin += rho_[j] * length(Row(Y_[j]).m);
    const Interval turn = whole_.angle * (Interval(1) + spin);
    Moves rate;
    Matrix6<Interval> YD;  // |y_r . D_i'|
    for (std::size_t i = 0; i < 6; ++i) {
      const Interval Rb_alone = turn * b_size_[i] + whole_.platform[i];
      const Interval d_alone = Rb_alone + whole_.position + whole_.base[i];
      const Interval r_alone = turn * r_size_[i] + whole_.platform[i] + whole_.load_point;
      rate.d[i].fill(d_alone);
      rate.r[i].fill(r_alone);
      rate.Rb[i].fill(Rb_alone);
      for (std::size_t r = 0; r < 6; ++r) YD[r][i] = length(h_[r][i]) * d_alone + length(q_[r][i]) * r_alone;
      for (std::size_t j = 0; j < 6 && is_held_; ++j) {
        const Vector3<Interval> sweep = cross(Row(Y_[j]).m, Rb_[i]);
        for (std::size_t c = 0; c < 3; ++c) {
          rate.d[i][c] += rho_[j] * abs(h_[j][i][c]);
          rate.r[i][c] += rho_[j] * abs(w_[j][i][c]);
          rate.Rb[i][c] += rho_[j] * abs(sweep[c]);
        }
        for (std::size_t r = 0; r < 6; ++r) {
          YD[r][i] += rho_[j] * abs(dot(h_[r][i], h_[j][i]) + dot(q_[r][i], w_[j][i]));
        }
      }
    }
    rate.Rp_m.fill((turn + spin) * Rp_m_size_ + whole_.load_point);
    Matrix6<Interval> Y = Y_;
    for (Vector6<Interval>& row : Y) {
      for (Interval& x : row) x = abs(x);
    }
    rate.Y = multiply(YD, Y);
    return rate;
  }

  void set_loads(const Interval& until) {
    Vector6<Interval> wrench;
    for (std::size_t i = 0; i < 6; ++i) {
      wrench[i] = model_.wrench()[i] + until * whole_.wrench[i] * Interval::plus_minus_one();
    }
    x_ = multiply(Y_, wrench);
    const Matrix6<Interval>& M_inverse = model_.ellipsoid_factor();
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        z_[i][k] = Interval();
        for (std::size_t j = 0; j <= k; ++j) z_[i][k] += M_inverse[k][j] * Y_[i][j];
      }
    }
  }

  [[nodiscard]] Interval tension_rate(std::size_t r, const Interval& c, const Vector6<Interval>& overlap,
                                      const Vectors& turned) const {
    Vector6<Interval> pull;  // |d_r| kappa_i
    for (std::size_t i = 0; i < 6; ++i) pull[i] = length_[r] * (x_[i] + c * overlap[i]);
    const Vector3<Interval> own = (x_[r] + c * overlap[r]) * u_[r];  // phi u_r

    Vector3<Interval> P = own;
    Vector3<Interval> Q = cross(r_[r], own);
    Vector3<Interval> of_load_point;
    for (std::size_t i = 0; i < 6; ++i) {
      P = P - pull[i] * h_[r][i];
      Q = Q - pull[i] * turned[i];
      of_load_point = of_load_point + pull[i] * q_[r][i];
    }
    const Interval P_size = length(P);
    const Interval turn_size = length(Q + cross(Rp_m_, P));
    Interval of_wrench;
    for (std::size_t k = 0; k < 6; ++k) of_wrench += Y_[r][k] * whole_.wrench[k];
    Interval rate = whole_.position * P_size + whole_.angle * turn_size + whole_.load_point * length(of_load_point) +
                    abs(length_[r] * of_wrench);
    for (std::size_t i = 0; i < 6; ++i) {
      Vector3<Interval> of_base = pull[i] * h_[r][i];
      Vector3<Interval> of_platform = -Interval(1) * (pull[i] * (h_[r][i] + q_[r][i]));
      if (i == r) {
        of_base = of_base - own;
        of_platform = of_platform + own;
      }
      if (is_held_) {
        const Row y(Y_[i]);
        // The angle turns W, by which Q + R p_m x P is multiplied, and p_m of the commanded pose.
        const Interval turning = whole_.angle * length(y.m) * (turn_size + Rp_m_size_ * P_size);
        const Interval of_rho = dot(P, y.f) + dot(Q, y.m) + turning * Interval::plus_minus_one();
        of_base = of_base + of_rho * d_[i];
        of_platform = of_platform - of_rho * widened(d_[i], whole_.angle * length_[i]);
        rate += whole_.length[i] * length_[i] * abs(of_rho);
      }
      rate += whole_.base[i] * length(of_base) + whole_.platform[i] * length(of_platform);
    }
    return rate;
  }

  const Model& model_;
  bool is_held_;
  const Deviation& whole_;
  Vectors d_start_, r_start_, Rb_start_;  ///< at t = 0
  Vector3<Interval> Rp_m_start_;
  Vector6<Interval> length_start_;
  Matrix6<Interval> Y_start_;
  Vector6<Interval> rho_;              ///< |rho_i| <=
  Vector6<Interval> b_size_, r_size_;  ///< |b_i'|, |b_i' - p_m'| <=
  Interval Rp_m_size_;
  Moves moves_;  ///< at the end of the part

  Vectors d_, r_, u_, Rb_;
  Vector3<Interval> Rp_m_;
  Vector6<Interval> length_;
  Matrix6<Interval> Y_;
  Interval largest_Y_;
  std::array<Vectors, 6> h_, q_, w_;
  Vector6<Interval> x_;
  Matrix6<Interval> z_;  ///< rows z_r
};

}  // namespace

Losses losses(const Model& model, const Geometry& geometry, const Inverse& inverse, const Frame& pose, bool is_held,
              const Interval& k, int parts) {
  Losses result;
  const Interval share = Interval(1) / Interval(parts);
  Family family(model, geometry, inverse, pose, is_held);
  for (int part = 1; part <= parts; ++part) {
    family.advance(share, Interval(mpq_class(part, parts)));
    for (std::size_t i = 0; i < 6; ++i) {
      if (!is_held) result.length[i] += share * family.length_rate(i);
      const std::array<Interval, 4> rates = family.tension_rates(i, k);
      for (std::size_t side = 0; side < 2; ++side) {
        result.tension[i][side] += share * rates[side];
        result.scaled[i][side] += share * rates[2 + side];
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
