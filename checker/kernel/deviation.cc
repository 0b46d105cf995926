// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/deviation.h"

namespace taut::checker {
namespace {

Vector3<Ball> widened(const Vector3<Ball>& x, const Ball& by) {
  return {plus_minus(x[0], by), plus_minus(x[1], by), plus_minus(x[2], by)};
}

/// (f, m): the first and the last three entries of a row of D^-1.
struct Row {
  Vector3<Ball> f;
  Vector3<Ball> m;
  explicit Row(const Vector6<Ball>& y) : f{y[0], y[1], y[2]}, m{y[3], y[4], y[5]} {}
};

using Vectors = std::array<Vector3<Ball>, 6>;

/// What is followed: where it is, how far it has moved from where it was at t = 0, or at what rate; by coordinates.
struct Followed {
  Vectors d, r, Rb;
  Vector3<Ball> Rp_m;
  Matrix3<Ball> R;  ///< where there are items
  Matrix6<Ball> Y;
};

/// Calls visit with each number of all of these.
template <class Visit, class... All>
void for_each(const Visit& visit, All&... all) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      visit(all.d[i][c]...);
      visit(all.r[i][c]...);
      visit(all.Rb[i][c]...);
    }
    for (std::size_t k = 0; k < 6; ++k) visit(all.Y[i][k]...);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    visit(all.Rp_m[c]...);
    for (std::size_t k = 0; k < 3; ++k) visit(all.R[c][k]...);
  }
}

/// Everything that the rates are made of, for every u and every deviation, during one part of the way.
class Family {
 public:
  /// At t = 0.
  Family(const Machine& machine, const Geometry& geometry, const Inverse& inverse, bool length_controlled,
         const Vector6<Ball>& wrench, const Vector6<Ball>& wrench_tolerance)
      : machine_(machine),
        length_controlled_(length_controlled),
        whole_(*machine.tolerances),
        wrench_(wrench),
        wrench_tolerance_(wrench_tolerance) {
    if (whole_.cable_length) e_ = *whole_.cable_length;
    const Matrix3<Ball> R = range(geometry.pose.R);
    for (std::size_t i = 0; i < 6; ++i) {
      start_.d[i] = range(geometry.d[i]);
      start_.r[i] = range(geometry.arm[i]);
      start_.Rb[i] = multiply(R, machine.platform[i]);
      length_start_[i] = geometry.length[i].range();
      b_size_[i] = length_bound(machine.platform[i]) + whole_.platform_anchors[i];
      r_size_[i] = length_bound(machine.arms[i]) + whole_.platform_anchors[i] + whole_.load_point;
      if (!length_controlled) continue;
      rho_[i] = magnitude((length_start_[i] + e_[i]) * (e_[i] + whole_.base_anchors[i] + whole_.platform_anchors[i]));
    }
    start_.Rp_m = multiply(R, machine.load_point);
    start_.R = R;
    start_.Y = map(inverse.rows(), [](const MeanValueForm& y) { return y.range(); });
    Rp_m_size_ = length_bound(machine.load_point) + whole_.load_point;
  }

  /// The next part, `share` of the way, at the end of which the part `until` of the way is covered.
  /// @throws Undefined where the guess does not hold.
  void advance(const Ball& share, const Ball& until, int guesses) {
    // A guess is somewhat more than where the rates over the last guess lead, and more than 0 where these are 0.
    const Ball growth(1.125);
    const Ball least = Ball::make([](arb_ptr r) {
      arb_set_ui(r, 1);
      arb_mul_2exp_si(r, r, -4 * Ball::bits());
    });
    const Followed before = moves_;
    Followed guess = before;
    set(before, until);
    for (int k = 0; k < guesses; ++k) {
      const Followed rate = rates();
      const auto further = [&](Ball& x, const Ball& from, const Ball& by) {
        x = highest(from + growth * share * by + least);
      };
      for_each(further, guess, before, rate);
      set(guess, until);
    }
    const Followed rate = rates();
    const auto move = [&](Ball& x, const Ball& by, const Ball& allowed) {
      x = highest(x + share * by);
      if (!certainly_nonnegative(allowed - x)) throw Undefined("a deviation may lead to a singular pose");
    };
    for_each(move, moves_, rate, guess);
    set_loads(until);
  }

  /// Bounds of the rates of the least, the largest and the nominal tension.
  struct TensionRates {
    std::array<Ball, 2> extreme;
    Ball nominal;  ///< where there are items
  };
  [[nodiscard]] TensionRates tension_rates(std::size_t r) const {
    Vectors turned;         // r_i x (h_ri + q_ri)
    Vector6<Ball> overlap;  // z_r . z_i / V_r
    for (std::size_t i = 0; i < 6; ++i) {
      turned[i] = cross(now_.r[i], h_[r][i] + q_[r][i]);
      for (std::size_t j = 0; j < 6 && i != r; ++j) overlap[i] += z_[r][j] * z_[i][j];
    }
    if (machine_.ellipsoid) {
      const Ball V = length_range(z_[r]);
      for (std::size_t i = 0; i < 6; ++i) overlap[i] = i == r ? V : overlap[i] / V;
    }
    const auto extreme = [&](const Ball& c) {
      ExtremeLoad load;
      for (std::size_t i = 0; i < 6; ++i) load.kappa[i] = x_[i] + c * overlap[i];
      for (std::size_t k = 0; k < levers_.size(); ++k) {
        const Lever<Ball>& y = levers_[k][r];
        add_item(k, r, machine_.items[k].maximizers(certainly_positive(c) ? y : -y), load);
      }
      return tension_rate(r, load, turned);
    };
    TensionRates result = {{extreme(Ball(-1)), extreme(Ball(1))}, Ball()};
    if (levers_.empty()) return result;
    ExtremeLoad nominal = {x_, {}};
    for (std::size_t k = 0; k < levers_.size(); ++k) add_item(k, r, {machine_.items[k].nominal()}, nominal);
    result.nominal = tension_rate(r, nominal, turned);
    return result;
  }

  /// A bound of the rate of |d_i|, of a machine that is not length-controlled.
  [[nodiscard]] Ball length_rate(std::size_t i) const {
    const Ball by_turning = length_bound(cross(now_.Rb[i], u_[i]));
    const Ball lever = smaller(by_turning, highest(b_size_[i]));
    return whole_.position + whole_.orientation * lever + whole_.base_anchors[i] + whole_.platform_anchors[i];
  }

  /// Bounds of the rates of the commanded pose.
  [[nodiscard]] PoseShift commanded_pose_rate() const {
    PoseShift rate;
    for (std::size_t j = 0; j < 6 && length_controlled_; ++j) {
      const Row y(now_.Y[j]);
      rate.position += rho_[j] * length_bound(y.f - cross(y.m, now_.Rp_m));
      rate.turn += rho_[j] * length_bound(y.m);
    }
    return rate;
  }

  /// A bound of the change of |d_i| where that is L_i + e_i at the commanded pose, whatever leads there. Tracking is
  /// added to the whole deviation, not part by part.
  [[nodiscard]] Ball controlled_length_loss(std::size_t i) const {
    return e_[i] + whole_.position + whole_.orientation * b_size_[i];
  }

 private:
  /// What is there up to the part `until` of the way, if all stays within `moves`.
  void set(const Followed& moves, const Ball& until) {
    for_each([](Ball& x, const Ball& start, const Ball& move) { x = plus_minus(start, move); }, now_, start_, moves);
    for (std::size_t i = 0; i < 6; ++i) {
      const Ball change = length_controlled_ ? e_[i] : whole_.base_anchors[i] + whole_.platform_anchors[i];
      const Ball tracked = whole_.position + whole_.orientation * b_size_[i];
      length_[i] = plus_minus(length_start_[i], until * (change + tracked));
      if (!certainly_positive(length_[i])) throw Undefined("a cable may have no length");
      for (std::size_t c = 0; c < 3; ++c) u_[i][c] = now_.d[i][c] / length_[i];
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const Row y(now_.Y[i]);
      for (std::size_t j = 0; j < 6; ++j) {
        w_[i][j] = cross(y.m, now_.r[j]);
        h_[i][j] = y.f + w_[i][j];
        q_[i][j] = cross(now_.d[j], y.m);
      }
    }
  }

  /// Rates of all quantities in Followed, over what was set.
  [[nodiscard]] Followed rates() const {
    Ball spin;  // of the commanded pose
    for (std::size_t j = 0; j < 6; ++j) spin += rho_[j] * length_bound(Row(now_.Y[j]).m);
    const Ball turn = whole_.orientation * (Ball(1) + spin);
    Followed rate;
    Matrix6<Ball> YD;  // |y_r . D_i'|
    for (std::size_t i = 0; i < 6; ++i) {
      const Ball Rb_alone = turn * b_size_[i] + whole_.platform_anchors[i];
      const Ball d_alone = Rb_alone + whole_.position + whole_.base_anchors[i];
      const Ball r_alone = turn * r_size_[i] + whole_.platform_anchors[i] + whole_.load_point;
      rate.d[i].fill(d_alone);
      rate.r[i].fill(r_alone);
      rate.Rb[i].fill(Rb_alone);
      for (std::size_t r = 0; r < 6; ++r) {
        YD[r][i] = length_bound(h_[r][i]) * d_alone + length_bound(q_[r][i]) * r_alone;
      }
      for (std::size_t j = 0; j < 6 && length_controlled_; ++j) {
        const Vector3<Ball> sweep = cross(Row(now_.Y[j]).m, now_.Rb[i]);
        for (std::size_t c = 0; c < 3; ++c) {
          rate.d[i][c] += rho_[j] * magnitude(h_[j][i][c]);
          rate.r[i][c] += rho_[j] * magnitude(w_[j][i][c]);
          rate.Rb[i][c] += rho_[j] * magnitude(sweep[c]);
        }
        for (std::size_t r = 0; r < 6; ++r) {
          YD[r][i] += rho_[j] * magnitude(dot(h_[r][i], h_[j][i]) + dot(q_[r][i], w_[j][i]));
        }
      }
    }
    rate.Rp_m.fill((turn + spin) * Rp_m_size_ + whole_.load_point);
    if (!machine_.items.empty()) rate.R.fill({turn + spin, turn + spin, turn + spin});
    rate.Y = multiply(YD, map(now_.Y, magnitude));
    return rate;
  }

  void set_loads(const Ball& until) {
    Vector6<Ball> wrench;
    for (std::size_t i = 0; i < 6; ++i) wrench[i] = plus_minus(wrench_[i], until * wrench_tolerance_[i]);
    x_ = multiply(now_.Y, wrench);
    if (machine_.ellipsoid) z_ = multiply(now_.Y, *machine_.ellipsoid);
    levers_.resize(machine_.items.size());
    for (std::size_t k = 0; k < levers_.size(); ++k) {
      for (std::size_t i = 0; i < 6; ++i) levers_[k][i] = machine_.items[k].lever(now_.R, now_.Y[i]);
    }
  }

  /// What a rate depends on of w*.
  struct ExtremeLoad {
    Vector6<Ball> kappa;
    Vector3<Ball> T;
  };
  /// Adds item k's share, for row r, of whichever of these wrenches.
  void add_item(std::size_t k, std::size_t r, const std::vector<Wrench>& wrenches, ExtremeLoad& to) const {
    ExtremeLoad any;
    for (std::size_t n = 0; n < wrenches.size(); ++n) {
      const auto include = [&](Ball& all, const Ball& one) { all = n == 0 ? one : hull(all, one); };
      const Vector3<Ball> T = machine_.items[k].turning(now_.R, now_.Y[r], wrenches[n]);
      for (std::size_t i = 0; i < 6; ++i) include(any.kappa[i], of(levers_[k][i], wrenches[n]));
      for (std::size_t c = 0; c < 3; ++c) include(any.T[c], T[c]);
    }
    for (std::size_t i = 0; i < 6; ++i) to.kappa[i] += any.kappa[i];
    to.T = to.T + any.T;
  }

  [[nodiscard]] Ball tension_rate(std::size_t r, const ExtremeLoad& load, const Vectors& turned) const {
    Vector6<Ball> pull;  // |d_r| kappa_i
    for (std::size_t i = 0; i < 6; ++i) pull[i] = length_[r] * load.kappa[i];
    const Vector3<Ball> own = load.kappa[r] * u_[r];  // phi u_r

    Vector3<Ball> P = own;
    Vector3<Ball> Q = cross(now_.r[r], own);
    Vector3<Ball> of_load_point;
    for (std::size_t i = 0; i < 6; ++i) {
      P = P - pull[i] * h_[r][i];
      Q = Q - pull[i] * turned[i];
      of_load_point = of_load_point + pull[i] * q_[r][i];
    }
    if (!machine_.items.empty()) Q = Q + length_[r] * load.T;
    const Ball P_size = length_bound(P);
    const Ball turn_size = length_bound(Q + cross(now_.Rp_m, P));
    Ball of_wrench;
    for (std::size_t k = 0; k < 6; ++k) of_wrench += now_.Y[r][k] * wrench_tolerance_[k];
    Ball rate = whole_.position * P_size + whole_.orientation * turn_size +
                whole_.load_point * length_bound(of_load_point) + magnitude(length_[r] * of_wrench);
    for (std::size_t i = 0; i < 6; ++i) {
      Vector3<Ball> of_base = pull[i] * h_[r][i];
      Vector3<Ball> of_platform = Ball(-1) * (pull[i] * (h_[r][i] + q_[r][i]));
      if (i == r) {
        of_base = of_base - own;
        of_platform = of_platform + own;
      }
      if (length_controlled_) {
        const Row y(now_.Y[i]);
        // The angle turns W, by which Q + R p_m x P is multiplied, and p_m of the commanded pose.
        const Ball turning = whole_.orientation * length_bound(y.m) * (turn_size + Rp_m_size_ * P_size);
        const Ball of_rho = plus_minus(dot(P, y.f) + dot(Q, y.m), turning);
        of_base = of_base + of_rho * now_.d[i];
        of_platform = of_platform - of_rho * widened(now_.d[i], whole_.orientation * magnitude(length_[i]));
        rate += e_[i] * magnitude(length_[i]) * magnitude(of_rho);
      }
      rate += whole_.base_anchors[i] * length_bound(of_base) + whole_.platform_anchors[i] * length_bound(of_platform);
    }
    return highest(rate);
  }

  const Machine& machine_;
  bool length_controlled_;
  const Tolerances<Ball, Ball>& whole_;  ///< at t = 1, but for the wrench's
  const Vector6<Ball>&wrench_, &wrench_tolerance_;
  Vector6<Ball> length_start_;
  Vector6<Ball> e_, rho_;          ///< |e_i|, |rho_i| <=
  Vector6<Ball> b_size_, r_size_;  ///< |b_i'|, |b_i' - p_m'| <=
  Ball Rp_m_size_;
  Followed start_;  ///< at t = 0
  Followed moves_;  ///< at the end of the part

  // During the part, as the header names them:
  Followed now_;
  Vectors u_;
  Vector6<Ball> length_;              ///< |d_i|
  std::array<Vectors, 6> h_, q_, w_;  ///< [r][i]
  Vector6<Ball> x_;
  Matrix6<Ball> z_;                                 ///< rows z_r
  std::vector<std::array<Lever<Ball>, 6>> levers_;  ///< [item][r]
};

}  // namespace

MarginLoss margin_loss(const Machine& machine, const Geometry& geometry, const Inverse& inverse, bool length_controlled,
                       int parts, int guesses, const WrenchBeside* beside) {
  const Ball share = Ball(1) / Ball(parts);
  const auto go = [&](Family& family, const auto& at_part) {
    for (int part = 1; part <= parts; ++part) {
      family.advance(share, Ball(mpq_class(part, parts)), guesses);
      at_part();
    }
  };
  const Tolerances<Ball, Ball>& whole = *machine.tolerances;
  Vector6<Ball> wrench = machine.wrench, tolerance = whole.wrench;
  if (beside != nullptr) {
    Family family(machine, geometry, inverse, length_controlled, machine.wrench, whole.wrench);
    Ball turn = whole.orientation;
    go(family, [&] { turn += share * family.commanded_pose_rate().turn; });
    if (!certainly_positive(Ball(1) - turn)) throw Undefined("a deviation may turn the platform far");
    wrench = beside->wrench;
    for (std::size_t i = 0; i < 6; ++i) {
      tolerance[i] = plus_minus(tolerance[i], highest(magnitude(turn) * beside->change_by_turn[i]));
    }
  }

  MarginLoss result;
  Family family(machine, geometry, inverse, length_controlled, wrench, tolerance);
  Vector6<Ball> nominal;
  go(family, [&] {
    const PoseShift rate = family.commanded_pose_rate();
    result.shift.position += share * rate.position;
    result.shift.turn += share * rate.turn;
    for (std::size_t i = 0; i < 6; ++i) {
      if (!length_controlled) result.length[i] += share * family.length_rate(i);
      const Family::TensionRates rates = family.tension_rates(i);
      for (std::size_t side = 0; side < 2; ++side) result.tension[i][side] += share * rates.extreme[side];
      nominal[i] += share * rates.nominal;
    }
  });
  for (std::size_t i = 0; i < 6; ++i) {
    if (length_controlled) result.length[i] = family.controlled_length_loss(i);
    // Of the ellipsoid alone the two extremes differ by 2 v, which changes by no more than the sum of their changes.
    const auto& [least, most] = result.tension[i];
    result.radius[i].fill(half(least + most));
    if (!machine.items.empty()) result.radius[i] = {least + nominal[i], most + nominal[i]};
  }
  result.shift.position = highest(result.shift.position + whole.position);
  result.shift.turn = highest(result.shift.turn + whole.orientation);
  return result;
}

}  // namespace taut::checker
