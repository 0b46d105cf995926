#include "certify/tolerance.h"

#include <algorithm>
#include <cmath>

namespace taut {

/// Not an enclosing scalar: what is computed with it is a guess.
template <>
struct Scalars<double> {
  using Upper = double;
  static double symmetric(double) { return 0; }
  static double root(double x) { return std::sqrt(x); }
};

namespace {

double magnitude(double x) { return std::abs(x); }
double approx(const Interval& x) { return midpoint_approx(x); }
double approx(const MpInterval& x) { return 0.5 * x.lower().to_double() + 0.5 * x.upper().to_double(); }

/// For a tolerance >= 0.
template <class I>
UpperOf<I> above(const I& x) {
  return UpperOf<I>(magnitude(x));
}

template <class I>
UpperOf<I> norm_above(const Vector3<I>& x) {
  const UpperOf<I> a = above(x(0)), b = above(x(1)), c = above(x(2));
  return Scalars<I>::root(a * a + b * b + c * c);
}

template <class I>
I dot(const Vector3<I>& a, const Vector3<I>& b) {
  return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
}

template <class I>
Vector3<I> scaled(const I& k, const Vector3<I>& a) {
  return {k * a(0), k * a(1), k * a(2)};
}

template <class I>
using Bounds3 = std::array<UpperOf<I>, 3>;

/// a ± radius, by coordinates.
template <class I>
Vector3<I> widened(const Vector3<I>& a, const Bounds3<I>& radius) {
  return {a(0) + Scalars<I>::symmetric(radius[0]), a(1) + Scalars<I>::symmetric(radius[1]),
          a(2) + Scalars<I>::symmetric(radius[2])};
}

template <class I>
Vector3<I> ranges(const Vector3<Centered<I>>& a) {
  return {a(0).range, a(1).range, a(2).range};
}

template <class I>
Vector3<I> rotated_range(const Matrix3<Centered<I>>& r, const Vector3<I>& x) {
  Vector3<I> result;
  for (int i = 0; i < 3; ++i) {
    Centered<I> sum = r(i, 0) * x(0) + r(i, 1) * x(1) + r(i, 2) * x(2);
    result(i) = sum.range;
  }
  return result;
}

/// Bounds of how far a deviation moves what it does, or of the rates at which it does.
template <class Upper>
struct Change {
  std::array<std::array<Upper, 3>, kCables> d, reach, arm;
  std::array<Upper, 3> load_point;
  Square<Upper> s;  ///< |S − I|

  /// Sets each number to function(a's, b's).
  template <class A, class B, class F>
  void set(const Change<A>& a, const Change<B>& b, F function) {
    for (std::size_t i = 0; i < kCables; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        d[i][k] = function(a.d[i][k], b.d[i][k]);
        reach[i][k] = function(a.reach[i][k], b.reach[i][k]);
        arm[i][k] = function(a.arm[i][k], b.arm[i][k]);
      }
      for (std::size_t k = 0; k < kCables; ++k) s[i][k] = function(a.s[i][k], b.s[i][k]);
    }
    for (std::size_t k = 0; k < 3; ++k) load_point[k] = function(a.load_point[k], b.load_point[k]);
  }

  /// Whether each number is positive, and not less than the other's.
  [[nodiscard]] bool covers(const Change& other) const {
    bool result = true;
    const Upper zero(0.0);
    Change unused;
    unused.set(*this, other, [&](const Upper& ours, const Upper& theirs) {
      if (!(zero < ours) || !(theirs < ours)) result = false;  // also a NaN
      return ours;
    });
    return result;
  }
};

/// What is known at τ = 0, and what is the same for every X.
template <class I>
struct Origin {
  using Upper = UpperOf<I>;
  std::array<Vector3<I>, kCables> d, reach, arm;
  Vector3<I> load_point;                                  ///< R p_m
  std::array<I, kCables> length;                          ///< |d_i|
  std::array<std::array<I, 6>, kCables> y;                ///< Y
  std::array<std::array<Upper, 6>, kCables> y_magnitude;  ///< |Y|
  std::array<Upper, kCables> reach_size, arm_size;        ///< |b_i|, |b_i − p_m| of every deviation
  Upper load_point_size;                                  ///< |p_m|, likewise
  std::array<Upper, kCables> pull;                        ///< >= |ρ_i|: 0 unless held by lengths
};

/// Everything on X that (i) and (t) are made of.
template <class I>
struct OnAll {
  std::array<Vector3<I>, kCables> d;                           ///< d_i
  std::array<Vector3<I>, kCables> reach;                       ///< R b_i
  std::array<Vector3<I>, kCables> arm;                         ///< R (b_i − p_m)
  Vector3<I> load_point;                                       ///< R p_m
  std::array<Vector3<I>, kCables> force, moment;               ///< the rows of D^-1: y_r^f, y_r^m
  std::array<std::array<Vector3<I>, kCables>, kCables> h;      ///< h_ri = y_r^f + y_r^m × arm_i
  std::array<std::array<Vector3<I>, kCables>, kCables> twist;  ///< d_i × y_r^m
  std::array<I, kCables> density;                              ///< λ_r
  std::array<std::array<I, 6>, kCables> root;                  ///< the rows of D^-1 L
};

template <class I>
Origin<I> make_origin(const UndisturbedBox<I>& box, const ToleranceModel<I>& tolerance) {
  using Upper = UpperOf<I>;
  const Model<I>& model = box.model;
  Origin<I> origin;
  Square<Upper> c;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) c[i][j] = above(I(box.c(static_cast<int>(i), static_cast<int>(j))));
  }
  const Square<Upper> error = upper_product(box.q, c);
  for (std::size_t i = 0; i < kCables; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      origin.y[i][j] = I(box.c(static_cast<int>(i), static_cast<int>(j))) + Scalars<I>::symmetric(error[i][j]);
      origin.y_magnitude[i][j] = c[i][j] + error[i][j];
    }
    origin.d[i] = ranges(box.geometry.p_AB_W[i]);
    origin.reach[i] = rotated_range(box.motion.r_WP, model.p_PB[i]);
    origin.arm[i] = rotated_range(box.motion.r_WP, model.p_MB[i]);
    origin.length[i] = box.length[i].range;
    origin.reach_size[i] = norm_above(model.p_PB[i]) + tolerance.platform_anchor[i];
    origin.arm_size[i] = norm_above(model.p_MB[i]) + tolerance.platform_anchor[i] + tolerance.load_point;
    origin.pull[i] = Upper(0.0);
    if (!box.held_by_lengths) continue;
    const Upper commanded = above(box.length[i].range) + tolerance.cable_length[i];
    origin.pull[i] = commanded * (tolerance.cable_length[i] + tolerance.base_anchor[i] + tolerance.platform_anchor[i]);
  }
  const Vector3<I> load_point = model.p_PB[0] - model.p_MB[0];
  origin.load_point = rotated_range(box.motion.r_WP, load_point);
  origin.load_point_size = norm_above(load_point) + tolerance.load_point;
  return origin;
}

/// X for a guess, as far as (i) needs it; and bounds of all rates on it.
template <class I>
Change<UpperOf<I>> rates(const Origin<I>& origin, const ToleranceModel<I>& tolerance, const Change<UpperOf<I>>& guess,
                         OnAll<I>& x) {
  using Upper = UpperOf<I>;
  const std::array<std::array<Upper, 6>, kCables> y_error = upper_product(guess.s, origin.y_magnitude);
  Upper spin(0.0);  // >= |Ω_c|
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto entry = [&](std::size_t j) { return I(origin.y[i][j] + Scalars<I>::symmetric(y_error[i][j])); };
    x.force[i] = {entry(0), entry(1), entry(2)};
    x.moment[i] = {entry(3), entry(4), entry(5)};
    x.d[i] = widened<I>(origin.d[i], guess.d[i]);
    x.reach[i] = widened<I>(origin.reach[i], guess.reach[i]);
    x.arm[i] = widened<I>(origin.arm[i], guess.arm[i]);
    if (Upper(0.0) < origin.pull[i]) spin += origin.pull[i] * norm_above(x.moment[i]);
  }
  x.load_point = widened<I>(origin.load_point, guess.load_point);

  const Upper turn = tolerance.orientation + tolerance.orientation * spin;  // ω, and Ω_c turned by T
  Change<Upper> rate;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Upper reach_rate = turn * origin.reach_size[i] + tolerance.platform_anchor[i];
    rate.reach[i].fill(reach_rate);
    rate.arm[i].fill(turn * origin.arm_size[i] + tolerance.platform_anchor[i] + tolerance.load_point);
    rate.d[i].fill(reach_rate + tolerance.position + tolerance.base_anchor[i]);
    for (std::size_t j = 0; j < kCables; ++j) {
      const Vector3<I> swing = cross(x.moment[j], x.arm[i]);
      x.h[j][i] = x.force[j] + swing;
      x.twist[j][i] = cross(x.d[i], x.moment[j]);
      const Upper& pull = origin.pull[j];
      if (!(Upper(0.0) < pull)) continue;
      const Vector3<I> sweep = cross(x.moment[j], x.reach[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        const int n = static_cast<int>(k);
        rate.d[i][k] += pull * above(x.h[j][i](n));
        rate.arm[i][k] += pull * above(swing(n));
        rate.reach[i][k] += pull * above(sweep(n));
      }
    }
  }
  rate.load_point.fill((turn + spin) * origin.load_point_size + tolerance.load_point);

  Square<Upper> b;
  Square<Upper> s = guess.s;
  for (std::size_t r = 0; r < kCables; ++r) {
    for (std::size_t i = 0; i < kCables; ++i) {
      b[r][i] = Upper(0.0);
      for (std::size_t k = 0; k < 3; ++k) {
        const int n = static_cast<int>(k);
        b[r][i] += above(x.h[r][i](n)) * rate.d[i][k] + above(x.twist[r][i](n)) * rate.arm[i][k];
      }
    }
    s[r][r] += Upper(1.0);
  }
  rate.s = upper_product(b, s);
  return rate;
}

/// The rates at τ = 0 and the middle of the box, about.
template <class I>
Change<double> approx_rates(const Origin<I>& origin, const ToleranceModel<I>& tolerance) {
  const auto to_double = [](const UpperOf<I>& x) { return Scalars<I>::to_double(x); };
  const auto vector = [](const Vector3<I>& x) { return Vector3<double>(approx(x(0)), approx(x(1)), approx(x(2))); };
  Origin<double> here;
  ToleranceModel<double> by;
  for (std::size_t i = 0; i < kCables; ++i) {
    here.d[i] = vector(origin.d[i]);
    here.reach[i] = vector(origin.reach[i]);
    here.arm[i] = vector(origin.arm[i]);
    for (std::size_t j = 0; j < 6; ++j) {
      here.y[i][j] = approx(origin.y[i][j]);
      here.y_magnitude[i][j] = to_double(origin.y_magnitude[i][j]);
    }
    here.reach_size[i] = to_double(origin.reach_size[i]);
    here.arm_size[i] = to_double(origin.arm_size[i]);
    here.pull[i] = to_double(origin.pull[i]);
    by.base_anchor[i] = to_double(tolerance.base_anchor[i]);
    by.platform_anchor[i] = to_double(tolerance.platform_anchor[i]);
  }
  here.load_point = vector(origin.load_point);
  here.load_point_size = to_double(origin.load_point_size);
  by.load_point = to_double(tolerance.load_point);
  by.position = to_double(tolerance.position);
  by.orientation = to_double(tolerance.orientation);
  OnAll<double> unused;
  Change<double> rate = rates(here, by, Change<double>{}, unused);
  // What is next to 0 here need not be elsewhere in the box.
  const auto level = [](auto& row) {
    constexpr double kShare = 0.5;
    const double least = kShare * *std::ranges::max_element(row);
    for (double& x : row) x = std::max(x, least);
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    level(rate.d[i]);
    level(rate.reach[i]);
    level(rate.arm[i]);
    level(rate.s[i]);
  }
  return rate;
}

/// The states of all deviations, τ from 0 to a part of the whole: see theory.md 7, "Where the states are".
template <class I>
class States {
 public:
  using Upper = UpperOf<I>;

  /// At τ = 0.
  States(const Origin<I>& origin, const ToleranceModel<I>& tolerance)
      : origin_(origin), tolerance_(tolerance), rate_(upper(approx_rates(origin, tolerance))) {}

  /// Goes on by `share` of the whole, a power of two. @returns false where no guess holds.
  [[nodiscard]] bool advance(double share, OnAll<I>& x) {
    constexpr int kMostGuesses = 12;
    constexpr double kRoom = 1.25;  // over the rates on the last X
    constexpr double kHopeless = 8;
    constexpr double kLeast = 0x1p-200;  // so that every guess is positive
    for (int k = 0; k < kMostGuesses; ++k) {
      Change<Upper> guess;
      guess.set(reached_, rate_,
                [&](const Upper& from, const Upper& by) { return from + Upper(room_ * share) * by + Upper(kLeast); });
      rate_ = rates(origin_, tolerance_, guess, x);
      room_ = kRoom;
      Change<Upper> moved;
      moved.set(reached_, rate_, [&](const Upper& from, const Upper& by) { return from + Upper(share) * by; });
      if (guess.covers(moved)) {
        reached_ = moved;
        return true;
      }
      for (const auto& row : moved.s) {
        for (const Upper& entry : row) {
          if (!(entry < Upper(kHopeless))) return false;  // also a NaN
        }
      }
    }
    return false;
  }

 private:
  static Change<Upper> upper(const Change<double>& x) {
    Change<Upper> result;
    result.set(x, x, [](double ours, double) { return Upper(ours); });
    return result;
  }

  const Origin<I>& origin_;
  const ToleranceModel<I>& tolerance_;
  Change<Upper> reached_{};
  Change<Upper> rate_;  ///< the last
  double room_ = 2;     ///< over that, for the next guess: much over rates at one point
};

template <class I>
void set_loads(const Model<I>& model, const Vector6<I>& wrench, OnAll<I>& x) {
  for (std::size_t r = 0; r < kCables; ++r) {
    const std::array<I, 6> y = {x.force[r](0),  x.force[r](1),  x.force[r](2),
                                x.moment[r](0), x.moment[r](1), x.moment[r](2)};
    I density(0.0);
    for (std::size_t k = 0; k < 6; ++k) density = density + y[k] * wrench(static_cast<int>(k));
    x.density[r] = density;
    for (std::size_t j = 0; j < 6; ++j) {
      const int column = static_cast<int>(j);
      I entry = y[j] * model.ellipsoid_root(column, column);
      if (!model.ellipsoid_is_diagonal) {
        for (int k = 0; k < column; ++k)
          entry = entry + y[static_cast<std::size_t>(k)] * model.ellipsoid_root(k, column);
      }
      x.root[r][j] = entry;
    }
  }
}

/// (t) for the tension bounds φ_r = λ_r ∓ V_r of cable r; `moved` of each cable i is arm_i × (h_ri + d_i × y_r^m).
template <class I>
UpperOf<I> tension_rate(const Origin<I>& origin, const ToleranceModel<I>& tolerance, const OnAll<I>& x, std::size_t r,
                        const std::array<I, kCables>& kappa, const std::array<Vector3<I>, kCables>& moved) {
  using Upper = UpperOf<I>;
  const I& length = origin.length[r];
  const Vector3<I> pull = scaled(I(kappa[r] / length), x.d[r]);  // φ_r u_r
  Vector3<I> by_position = pull;                                 // P_r
  Vector3<I> by_turn = cross(x.arm[r], pull);                    // of the turn about P_m: W_r − R p_m × P_r
  Vector3<I> by_load_point(I(0.0), I(0.0), I(0.0));              // M_r
  std::array<Vector3<I>, kCables> by_base;                       // A_ri
  std::array<Vector3<I>, kCables> by_platform;                   // B_ri
  for (std::size_t i = 0; i < kCables; ++i) {
    const I weight = length * kappa[i];
    const Vector3<I> h = scaled(weight, x.h[r][i]);
    const Vector3<I> twist = scaled(weight, x.twist[r][i]);
    by_position = by_position - h;
    by_turn = by_turn - scaled(weight, moved[i]);
    by_load_point = by_load_point + twist;
    by_base[i] = h;
    by_platform[i] = -(h + twist);
  }
  by_base[r] = by_base[r] - pull;
  by_platform[r] = by_platform[r] + pull;

  I by_load(0.0);
  for (int k = 0; k < 3; ++k) {
    by_load = by_load + x.force[r](k) * tolerance.wrench(k) + x.moment[r](k) * tolerance.wrench(k + 3);
  }
  const Upper by_position_size = norm_above(by_position);
  const Upper by_turn_size = norm_above(Vector3<I>(by_turn + cross(x.load_point, by_position)));  // |W_r|
  Upper bound = tolerance.load_point * norm_above(by_load_point) + above(I(length * by_load)) +
                tolerance.position * by_position_size + tolerance.orientation * by_turn_size;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (Upper(0.0) < origin.pull[i]) {
      // c_ri; T turns Ω_c, and R_c p_m to R p_m.
      const I turned = Scalars<I>::symmetric(tolerance.orientation * norm_above(x.moment[i]) *
                                             (by_turn_size + origin.load_point_size * by_position_size));
      const I c = dot(by_position, x.force[i]) + dot(by_turn, x.moment[i]) + turned;
      const Vector3<I> along = scaled(c, x.d[i]);
      const Upper size = above(c) * above(origin.length[i]);
      by_base[i] = by_base[i] + along;
      by_platform[i] = by_platform[i] - along;
      bound += tolerance.cable_length[i] * size + tolerance.platform_anchor[i] * tolerance.orientation * size;
    }
    bound += tolerance.base_anchor[i] * norm_above(by_base[i]);
    bound += tolerance.platform_anchor[i] * norm_above(by_platform[i]);
  }
  return bound;
}

/// (t) for f0_r − v_rr and f0_r + v_rr of each cable. Void where v_rr may be 0.
template <class I>
std::optional<std::array<std::array<UpperOf<I>, 2>, kCables>> tension_rates(const Origin<I>& origin,
                                                                            const ToleranceModel<I>& tolerance,
                                                                            const OnAll<I>& x) {
  std::array<std::array<UpperOf<I>, 2>, kCables> result;
  for (std::size_t r = 0; r < kCables; ++r) {
    I square(0.0);
    for (const I& entry : x.root[r]) square = square + sqr(entry);
    if (!certainly_positive(square)) return std::nullopt;
    const I spread = sqrt(square);  // V_r
    const I inverse = reciprocal(spread);
    std::array<I, kCables> low;   // κ_ri of λ − V
    std::array<I, kCables> high;  // of λ + V
    for (std::size_t i = 0; i < kCables; ++i) {
      I share = spread;  // Z_r·Z_i / V_r
      if (i != r) {
        share = I(0.0);
        for (std::size_t k = 0; k < 6; ++k) share = share + x.root[r][k] * x.root[i][k];
        share = share * inverse;
      }
      low[i] = x.density[i] - share;
      high[i] = x.density[i] + share;
    }
    std::array<Vector3<I>, kCables> moved;
    for (std::size_t i = 0; i < kCables; ++i) moved[i] = cross(x.arm[i], Vector3<I>(x.h[r][i] + x.twist[r][i]));
    result[r] = {tension_rate(origin, tolerance, x, r, low, moved), tension_rate(origin, tolerance, x, r, high, moved)};
  }
  return result;
}

}  // namespace

template <class I>
std::optional<ToleranceModel<I>> make_tolerance_model(const Problem& problem) {
  if (!problem.tolerances) return std::nullopt;
  const TolerancesText& text = *problem.tolerances;
  const auto decimal = [](const DecimalText& x) { return above(I(ScalarTraits<I>::from_decimal(x))); };
  ToleranceModel<I> model;
  for (std::size_t i = 0; i < kCables; ++i) {
    model.base_anchor[i] = decimal(text.base_anchor_m[i]);
    model.platform_anchor[i] = decimal(text.platform_anchor_m[i]);
    model.cable_length[i] = text.cable_length_m ? decimal((*text.cable_length_m)[i]) : UpperOf<I>(0.0);
    model.wrench(static_cast<int>(i)) = ScalarTraits<I>::from_decimal(text.wrench[i]);
  }
  model.load_point = decimal(text.load_point_m);
  model.position = decimal(text.position_m);
  model.orientation = above(evaluate_constant<I>(text.orientation_rad));
  model.held_by_lengths = text.cable_length_m.has_value();
  return model;
}

template <class I>
std::optional<Disturbance<I>> disturbance(const UndisturbedBox<I>& box, const ToleranceModel<I>& tolerance, int parts) {
  using Upper = UpperOf<I>;
  const Model<I>& model = box.model;
  Disturbance<I> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Upper reach = norm_above(model.p_PB[i]) + tolerance.platform_anchor[i];
    const Upper held =
        box.held_by_lengths ? tolerance.cable_length[i] : tolerance.base_anchor[i] + tolerance.platform_anchor[i];
    result.length[i] = tolerance.position + tolerance.orientation * reach + held;
    if (!certainly_positive(I(box.length[i].range + Scalars<I>::symmetric(result.length[i])))) return std::nullopt;
  }
  Origin<I> origin = make_origin(box, tolerance);
  States<I> states(origin, tolerance);
  const double share = 1.0 / parts;
  OnAll<I> x;
  for (int part = 1; part <= parts; ++part) {
    if (!states.advance(share, x)) return std::nullopt;
    const Upper until(share * part);
    for (std::size_t i = 0; i < kCables; ++i) {
      origin.length[i] = box.length[i].range + Scalars<I>::symmetric(until * result.length[i]);
    }
    Vector6<I> wrench;
    for (int k = 0; k < 6; ++k) {
      wrench(k) = model.wrench(k) + Scalars<I>::symmetric(until * above(tolerance.wrench(k)));
    }
    set_loads(model, wrench, x);
    const auto rates = tension_rates(origin, tolerance, x);
    if (!rates) return std::nullopt;
    for (std::size_t r = 0; r < kCables; ++r) {
      for (std::size_t side = 0; side < 2; ++side) result.tension[r][side] += Upper(share) * (*rates)[r][side];
    }
  }
  return result;
}

template std::optional<ToleranceModel<Interval>> make_tolerance_model(const Problem&);
template std::optional<ToleranceModel<MpInterval>> make_tolerance_model(const Problem&);
template std::optional<Disturbance<Interval>> disturbance(const UndisturbedBox<Interval>&,
                                                          const ToleranceModel<Interval>&, int);
template std::optional<Disturbance<MpInterval>> disturbance(const UndisturbedBox<MpInterval>&,
                                                            const ToleranceModel<MpInterval>&, int);

}  // namespace taut
