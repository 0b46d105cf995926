// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/deviation.h"

namespace taut::checker {
namespace {

Vector3<Ball> widened(const Vector3<Ball>& x, const Bound& by) {
  return {plus_minus(x[0], by), plus_minus(x[1], by), plus_minus(x[2], by)};
}

/// (f, m): the first and the last three entries of a row of D^-1.
struct Split {
  Vector3<Ball> f;
  Vector3<Ball> m;
  explicit Split(const Vector6<Ball>& y) : f{y[0], y[1], y[2]}, m{y[3], y[4], y[5]} {}
};

using Vectors = std::array<Vector3<Ball>, 6>;

/// What is followed: where it is (Balls), how far at most it has moved from where it was at t = 0, or at what rate
/// (Bounds); by coordinates.
template <class Number>
struct Followed {
  std::array<Vector3<Number>, 6> d, r, Rb;
  Vector3<Number> Rp_m;
  Matrix3<Number> R;  ///< where there are items
  Matrix6<Number> Y;
};
using Places = Followed<Ball>;
using Moves = Followed<Bound>;

template <std::size_t N>
std::array<Bound, N> bounds(const std::array<Ball, N>& x) {
  std::array<Bound, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = Bound(x[i]);
  return result;
}

Tolerances<Bound, Bound> bounds(const Tolerances<Ball, Ball>& x) {
  Tolerances<Bound, Bound> result{bounds(x.base_anchors),
                                  bounds(x.platform_anchors),
                                  Bound(x.load_point),
                                  {},
                                  Bound(x.position),
                                  Bound(x.orientation),
                                  {}};
  if (x.cable_length) result.cable_length = bounds(*x.cable_length);
  return result;
}

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
        lengths_lead_(length_controlled || machine.row_errors),
        anchors_lead_(length_controlled),
        whole_(bounds(*machine.tolerances)),
        wrench_(wrench),
        wrench_tolerance_(wrench_tolerance) {
    if (whole_.cable_length) e_ = *whole_.cable_length;
    for (std::size_t i = 0; i < 6 && machine.row_errors; ++i) e_[i] = e_[i] + Bound((*machine.row_errors)[i]);
    const Matrix3<Ball> R = range(geometry.pose.R);
    for (std::size_t i = 0; i < 6; ++i) {
      start_.d[i] = range(geometry.d[i]);
      start_.r[i] = range(geometry.arm[i]);
      start_.Rb[i] = multiply(R, machine.platform[i]);
      length_start_[i] = geometry.length[i].range();
      b_size_[i] = length_bound(machine.platform[i]) + whole_.platform_anchors[i];
      r_size_[i] = length_bound(machine.arms[i]) + whole_.platform_anchors[i] + whole_.load_point;
      if (lengths_lead_) rho_[i] = (Bound(length_start_[i]) + e_[i]) * (anchors_lead_ ? e_[i] + ends(i) : e_[i]);
    }
    start_.Rp_m = multiply(R, machine.load_point);
    start_.R = R;
    start_.Y = map(inverse.rows(), [](const MeanValueForm& y) { return y.range(); });
    Rp_m_size_ = length_bound(machine.load_point) + whole_.load_point;
  }

  /// The next part, `share` of the way, at the end of which the part `until` of the way is covered.
  /// @throws Undefined where the guess does not hold.
  void advance(const Bound& share, const Bound& until, int guesses) {
    // A guess is somewhat more than where the rates over the last guess lead, and more than 0 where these are 0.
    const Bound step = share * Bound(Ball(1.125));
    const Bound least = Bound::power_of_two(-4 * Ball::bits());
    const Moves before = moves_;
    Moves guess = before;
    set(before, until);
    for (int k = 0; k < guesses; ++k) {
      const Moves rate = rates();
      const auto further = [&](Bound& x, const Bound& from, const Bound& by) { x = from + step * by + least; };
      for_each(further, guess, before, rate);
      set(guess, until);
    }
    const Moves rate = rates();
    const auto move = [&](Bound& x, const Bound& by, const Bound& allowed) {
      x.add_product(share, by);
      if (!(x <= allowed)) throw Undefined("a deviation may lead to a singular pose");
    };
    for_each(move, moves_, rate, guess);
    set_directions_and_loads(until);
  }

  /// Of the rates of the least, the largest and the nominal tension.
  struct TensionRates {
    std::array<Bound, 2> extreme;
    Bound nominal;  ///< where there are items
  };
  [[nodiscard]] TensionRates tension_rates(std::size_t r) const {
    Row row;
    Vector6<Ball> overlap;  // z_r . z_i / V_r
    for (std::size_t i = 0; i < 6; ++i) {
      row.hq[i] = h_[r][i] + q_[r][i];
      row.turned[i] = cross(now_.r[i], row.hq[i]);
      row.h_size[i] = length_bound(h_[r][i]);
      row.hq_size[i] = length_bound(row.hq[i]);
    }
    if (machine_.ellipsoid) {
      const Ball V = length_range(z_[r]);
      for (std::size_t i = 0; i < 6; ++i) overlap[i] = i == r ? V : dot(z_[r], z_[i]) / V;
    }
    ExtremeLoad least{x_, {}}, most{x_, {}}, nominal{x_, {}};
    for (std::size_t i = 0; i < 6; ++i) {
      least.kappa[i] -= overlap[i];
      most.kappa[i] += overlap[i];
    }
    for (std::size_t k = 0; k < levers_.size(); ++k) {
      const Load& item = machine_.items[k];
      const Load::Extremes extremes = item.extremes(levers_[k][r]);
      add_item(k, r, extremes.least, least);
      add_item(k, r, extremes.most, most);
      add_item(k, r, {item.nominal()}, nominal);
    }
    TensionRates result = {{tension_rate(r, least, row), tension_rate(r, most, row)}, {}};
    if (!levers_.empty()) result.nominal = tension_rate(r, nominal, row);
    return result;
  }

  /// Whether the pose follows lengths of cables.
  [[nodiscard]] bool lengths_lead() const { return lengths_lead_; }

  /// Of the rate of |d_i|, where no lengths lead.
  [[nodiscard]] Bound length_rate(std::size_t i) const {
    const Bound lever = smaller(length_bound(cross(now_.Rb[i], u_[i])), b_size_[i]);
    return whole_.position + whole_.orientation * lever + whole_.base_anchors[i] + whole_.platform_anchors[i];
  }

  struct PoseRate {
    Bound position, turn;
  };
  /// Of the rates of the commanded pose.
  [[nodiscard]] PoseRate commanded_pose_rate() const {
    PoseRate rate;
    for (std::size_t j = 0; j < 6 && lengths_lead_; ++j) {
      const Split y(now_.Y[j]);
      rate.position.add_product(rho_[j], length_bound(y.f - cross(y.m, now_.Rp_m)));
      rate.turn.add_product(rho_[j], length_bound(y.m));
    }
    return rate;
  }

  /// Of the change of |d_i| where that is L_i + e_i at the commanded pose, whatever leads there, if not on anchors that
  /// deviate. Tracking is added to the whole deviation, not part by part.
  [[nodiscard]] Bound led_length_loss(std::size_t i) const {
    return own_length_loss(i) + whole_.position + whole_.orientation * b_size_[i];
  }

 private:
  [[nodiscard]] Bound ends(std::size_t i) const { return whole_.base_anchors[i] + whole_.platform_anchors[i]; }
  /// Without tracking.
  [[nodiscard]] Bound own_length_loss(std::size_t i) const { return anchors_lead_ ? e_[i] : e_[i] + ends(i); }

  /// What is there up to the part `until` of the way, if all stays within `moves`.
  void set(const Moves& moves, const Bound& until) {
    for_each([](Ball& x, const Ball& start, const Bound& move) { x = plus_minus(start, move); }, now_, start_, moves);
    for (std::size_t i = 0; i < 6; ++i) {
      length_[i] = plus_minus(length_start_[i], until * led_length_loss(i));
      if (!certainly_positive(length_[i])) throw Undefined("a cable may have no length");
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const Split y(now_.Y[i]);
      for (std::size_t j = 0; j < 6; ++j) {
        w_[i][j] = cross(y.m, now_.r[j]);
        h_[i][j] = y.f + w_[i][j];
        q_[i][j] = cross(now_.d[j], y.m);
      }
    }
  }

  /// Of the rates of all that is followed, over what was set.
  [[nodiscard]] Moves rates() const {
    Bound spin;  // of the commanded pose
    for (std::size_t j = 0; j < 6; ++j) spin.add_product(rho_[j], length_bound(Split(now_.Y[j]).m));
    const Bound turn = whole_.orientation * (Bound::power_of_two(0) + spin);
    Moves rate;
    Matrix6<Bound> YD;  // |y_r . D_i'|
    for (std::size_t i = 0; i < 6; ++i) {
      const Bound Rb_alone = turn * b_size_[i] + whole_.platform_anchors[i];
      const Bound d_alone = Rb_alone + whole_.position + whole_.base_anchors[i];
      const Bound r_alone = turn * r_size_[i] + whole_.platform_anchors[i] + whole_.load_point;
      rate.d[i].fill(d_alone);
      rate.r[i].fill(r_alone);
      rate.Rb[i].fill(Rb_alone);
      for (std::size_t r = 0; r < 6; ++r) {
        YD[r][i] = length_bound(h_[r][i]) * d_alone + length_bound(q_[r][i]) * r_alone;
      }
      for (std::size_t j = 0; j < 6 && lengths_lead_; ++j) {
        const Vector3<Ball> sweep = cross(Split(now_.Y[j]).m, now_.Rb[i]);
        for (std::size_t c = 0; c < 3; ++c) {
          rate.d[i][c].add_product(rho_[j], Bound(h_[j][i][c]));
          rate.r[i][c].add_product(rho_[j], Bound(w_[j][i][c]));
          rate.Rb[i][c].add_product(rho_[j], Bound(sweep[c]));
        }
        for (std::size_t r = 0; r < 6; ++r) {
          YD[r][i].add_product(rho_[j], Bound(dot(h_[r][i], h_[j][i]) + dot(q_[r][i], w_[j][i])));
        }
      }
    }
    rate.Rp_m.fill((turn + spin) * Rp_m_size_ + whole_.load_point);
    if (!machine_.items.empty()) rate.R.fill({turn + spin, turn + spin, turn + spin});
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        const Bound y(now_.Y[i][j]);
        for (std::size_t r = 0; r < 6; ++r) rate.Y[r][j].add_product(YD[r][i], y);
      }
    }
    return rate;
  }

  void set_directions_and_loads(const Bound& until) {
    Vector6<Ball> wrench;
    for (std::size_t i = 0; i < 6; ++i) wrench[i] = plus_minus(wrench_[i], until * Bound(wrench_tolerance_[i]));
    for (std::size_t i = 0; i < 6; ++i) u_[i] = Ball(1) / length_[i] * now_.d[i];
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

  /// What the rates of row r's tensions have in common.
  struct Row {
    Vectors hq, turned;              ///< h_ri + q_ri, r_i x (h_ri + q_ri)
    Vector6<Bound> h_size, hq_size;  ///< |h_ri|, |h_ri + q_ri|
  };

  [[nodiscard]] Bound tension_rate(std::size_t r, const ExtremeLoad& load, const Row& row) const {
    Vector6<Ball> pull;  // |d_r| kappa_i
    for (std::size_t i = 0; i < 6; ++i) pull[i] = length_[r] * load.kappa[i];
    const Vector3<Ball> own = load.kappa[r] * u_[r];  // phi u_r

    const Vector3<Ball> P = own - combination(pull, h_[r]);
    Vector3<Ball> Q = cross(now_.r[r], own) - combination(pull, row.turned);
    if (!machine_.items.empty()) Q = Q + length_[r] * load.T;
    const Bound P_size = length_bound(P);
    const Bound turn_size = length_bound(Q + cross(now_.Rp_m, P));
    Bound rate = whole_.position * P_size + whole_.orientation * turn_size +
                 whole_.load_point * length_bound(combination(pull, q_[r])) +
                 Bound(length_[r] * dot(now_.Y[r], wrench_tolerance_));
    for (std::size_t i = 0; i < 6; ++i) {
      if (i != r && !lengths_lead_) {
        const Bound size(pull[i]);
        rate.add_product(whole_.base_anchors[i], size * row.h_size[i]);
        rate.add_product(whole_.platform_anchors[i], size * row.hq_size[i]);
        continue;
      }
      Vector3<Ball> of_base = pull[i] * h_[r][i];
      Vector3<Ball> of_platform = -(pull[i] * row.hq[i]);
      if (i == r) {
        of_base = of_base - own;
        of_platform = of_platform + own;
      }
      if (lengths_lead_) {
        const Split y(now_.Y[i]);
        // The angle turns W, by which Q + R p_m x P is multiplied, and p_m of the commanded pose.
        const Bound turning = whole_.orientation * length_bound(y.m) * (turn_size + Rp_m_size_ * P_size);
        const Ball of_rho = plus_minus(dot(P, y.f) + dot(Q, y.m), turning);
        if (anchors_lead_) {
          of_base = of_base + of_rho * now_.d[i];
          of_platform = of_platform - of_rho * widened(now_.d[i], whole_.orientation * Bound(length_[i]));
        }
        rate.add_product(e_[i], Bound(length_[i]) * Bound(of_rho));
      }
      rate.add_product(whole_.base_anchors[i], length_bound(of_base));
      rate.add_product(whole_.platform_anchors[i], length_bound(of_platform));
    }
    return rate;
  }

  const Machine& machine_;
  bool lengths_lead_, anchors_lead_;
  Tolerances<Bound, Bound> whole_;  ///< at t = 1, but for the wrench's
  const Vector6<Ball>&wrench_, &wrench_tolerance_;
  Vector6<Ball> length_start_;
  Vector6<Bound> e_, rho_;          ///< |e_i|, |rho_i| <=
  Vector6<Bound> b_size_, r_size_;  ///< |b_i'|, |b_i' - p_m'| <=
  Bound Rp_m_size_;
  Places start_;  ///< at t = 0
  Moves moves_;   ///< at the end of the part

  // During the part, as the header names them:
  Places now_;
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
  const Bound share(Ball(1) / Ball(parts));
  const auto go = [&](Family& family, const auto& at_part) {
    for (int part = 1; part <= parts; ++part) {
      family.advance(share, Bound(Ball(mpq_class(part, parts))), guesses);
      at_part();
    }
  };
  const Tolerances<Ball, Ball>& whole = *machine.tolerances;
  Vector6<Ball> wrench = machine.wrench, tolerance = whole.wrench;
  if (beside != nullptr) {
    Family family(machine, geometry, inverse, length_controlled, machine.wrench, whole.wrench);
    Bound turn(whole.orientation);
    go(family, [&] { turn.add_product(share, family.commanded_pose_rate().turn); });
    if (!certainly_positive(Ball(1) - turn.ball())) throw Undefined("a deviation may turn the platform far");
    wrench = beside->wrench;
    for (std::size_t i = 0; i < 6; ++i) {
      tolerance[i] = plus_minus(tolerance[i], turn * Bound(beside->change_by_turn[i]));
    }
  }

  Family family(machine, geometry, inverse, length_controlled, wrench, tolerance);
  Bound position(whole.position), turn(whole.orientation);
  Vector6<Bound> length, nominal;
  std::array<std::array<Bound, 2>, 6> tension;
  go(family, [&] {
    const Family::PoseRate rate = family.commanded_pose_rate();
    position.add_product(share, rate.position);
    turn.add_product(share, rate.turn);
    for (std::size_t i = 0; i < 6; ++i) {
      if (!family.lengths_lead()) length[i].add_product(share, family.length_rate(i));
      const Family::TensionRates rates = family.tension_rates(i);
      for (std::size_t side = 0; side < 2; ++side) tension[i][side].add_product(share, rates.extreme[side]);
      nominal[i].add_product(share, rates.nominal);
    }
  });
  MarginLoss result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.length[i] = (family.lengths_lead() ? family.led_length_loss(i) : length[i]).ball();
    const auto& [least, most] = tension[i];
    result.tension[i] = {least.ball(), most.ball()};
    // Of the ellipsoid alone the two extremes differ by 2 v, which changes by no more than the sum of their changes.
    result.radius[i].fill(half((least + most).ball()));
    if (!machine.items.empty()) result.radius[i] = {(least + nominal[i]).ball(), (most + nominal[i]).ball()};
  }
  result.shift = {position.ball(), turn.ball()};
  return result;
}

}  // namespace taut::checker
