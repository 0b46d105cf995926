// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/tolerance/tolerance.h"

#include <algorithm>
#include <stdexcept>

#include "certify/loads/extremal_load.h"
#include "problem/decimal.h"
#include "problem/rows.h"

namespace taut {

namespace {

/// For a tolerance >= 0.
template <class I>
UpperOf<I> above(const I& x) {
  return UpperOf<I>(magnitude(x));
}

template <class I>
UpperOf<I> norm_above(const Vector3<I>& x) {
  const UpperOf<I> a = above(x(0)), b = above(x(1)), c = above(x(2));
  return ProofScalarTraits<I>::root(a * a + b * b + c * c);
}

template <class I>
UpperOf<I> norm_above(const std::array<UpperOf<I>, 3>& x) {
  return ProofScalarTraits<I>::root(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
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
  return {a(0) + ProofScalarTraits<I>::symmetric(radius[0]), a(1) + ProofScalarTraits<I>::symmetric(radius[1]),
          a(2) + ProofScalarTraits<I>::symmetric(radius[2])};
}

template <class I>
Vector3<I> ranges(const Vector3<SlopeForm<I>>& a) {
  return {a(0).range, a(1).range, a(2).range};
}

template <class I>
Vector3<I> rotated_range(const Matrix3<SlopeForm<I>>& r, const Vector3<I>& x) {
  Vector3<I> result;
  for (int i = 0; i < 3; ++i) {
    SlopeForm<I> sum = r(i, 0) * x(0) + r(i, 1) * x(1) + r(i, 2) * x(2);
    result(i) = sum.range;
  }
  return result;
}

/// Bounds of how far a deviation moves what it does, or of the rates at which it does.
template <class Upper>
struct Change {
  std::array<std::array<Upper, 3>, kCables> d, reach, arm;
  std::array<Upper, 3> load_point;
  Upper position;   ///< of the platform's origin
  Upper turn;       ///< the angle by which the platform turns
  Square<Upper> s;  ///< |S − I|

  /// Calls visit(ours, a's, b's) for each number.
  template <class Visit>
  void with(const Change& a, const Change& b, const Visit& visit) {
    for (std::size_t i = 0; i < kCables; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        visit(d[i][k], a.d[i][k], b.d[i][k]);
        visit(reach[i][k], a.reach[i][k], b.reach[i][k]);
        visit(arm[i][k], a.arm[i][k], b.arm[i][k]);
      }
      for (std::size_t k = 0; k < kCables; ++k) visit(s[i][k], a.s[i][k], b.s[i][k]);
    }
    for (std::size_t k = 0; k < 3; ++k) visit(load_point[k], a.load_point[k], b.load_point[k]);
    visit(position, a.position, b.position);
    visit(turn, a.turn, b.turn);
  }
};

/// For each row r of D^-1 and each cable i a vector: row r has those of all cables.
template <class T>
using Table = std::array<std::array<std::array<T, 3>, kCables>, kCables>;

/// As 6 x 18 matrices.
template <class Upper>
Table<Upper> upper_product(const Square<Upper>& a, const Table<Upper>& b) {
  Table<Upper> c;
  for (std::size_t r = 0; r < kCables; ++r) {
    for (std::size_t i = 0; i < kCables; ++i) {
      for (std::size_t n = 0; n < 3; ++n) c[r][i][n] = a[r][0] * b[0][i][n];
    }
    for (std::size_t k = 1; k < kCables; ++k) {
      for (std::size_t i = 0; i < kCables; ++i) {
        for (std::size_t n = 0; n < 3; ++n) c[r][i][n] += a[r][k] * b[k][i][n];
      }
    }
  }
  return c;
}

/// What depends linearly on the row y = (f, m) and on a vector of a cable, such as f + m × arm_i: for the rows of C, on
/// T.
template <class I>
struct Products {
  Table<I> of_c;
  Table<UpperOf<I>> magnitude;

  void set(std::size_t r, std::size_t i, const std::array<I, 3>& x) {
    for (std::size_t n = 0; n < 3; ++n) {
      of_c[r][i][n] = x[n];
      magnitude[r][i][n] = above(x[n]);
    }
  }
};

/// m × a for the exact m.
template <class I>
std::array<I, 3> cross_exact(const std::array<typename ProofScalarTraits<I>::Point, 3>& m, const Vector3<I>& a) {
  return {m[1] * a(2) - m[2] * a(1), m[2] * a(0) - m[0] * a(2), m[0] * a(1) - m[1] * a(0)};
}

/// What is known at τ = 0 on all of T, and what is the same for every X.
template <class I>
struct Origin {
  using Upper = UpperOf<I>;
  std::array<Vector3<I>, kCables> d, reach, arm;
  Vector3<I> load_point;                                   ///< R p_m
  Square<I> c;                                             ///< C, points
  Square<Upper> c_magnitude, q;                            ///< Y = P C, |P − I| <= q
  Products<I> h, twist;                                    ///< f + m × arm_i; d_i × m
  Products<I> swing, sweep;                                ///< m × arm_i, m × R b_i; only where lengths lead
  std::array<I, kCables> length, density, tension_radius;  ///< |d_i|, λ_i, |Z_i|
  Square<I> gram;                                          ///< Z_r·Z_i
  std::array<Upper, kCables> reach_size, arm_size;         ///< |b_i|, |b_i − p_m| of every deviation
  Upper load_point_size;                                   ///< |p_m|, likewise
  std::array<Upper, kCables> pull;                         ///< >= |ρ_i|: 0 where the path leads
  Lead lead;
  Matrix3<I> r_WP;         ///< R
  bool has_items = false;  ///< K is not an ellipsoid alone
  bool has_ellipsoid = true;
};

/// How far what Products has may be from that of C, on X.
template <class I>
struct Errors {
  using Upper = UpperOf<I>;
  Square<Upper> y;
  Table<Upper> h, twist;
};

/// The load at which a tension of cable r is extremal.
template <class I>
struct ItemLoad {
  std::array<I, kCables> kappa;  ///< y_i·w*
  Vector3<I> turn;               ///< T
  UpperOf<I> reach;              ///< how far y_r·w* may be from y_r·w_nom
};
/// By cable r, at its least (0) and its greatest (1) tension.
template <class I>
using ItemLoads = std::array<std::array<ItemLoad<I>, 2>, kCables>;

/// Everything on X that (t) is made of.
template <class I>
struct OnAll {
  std::array<Vector3<I>, kCables> d;                           ///< d_i
  std::array<Vector3<I>, kCables> reach;                       ///< R b_i
  std::array<Vector3<I>, kCables> arm;                         ///< R (b_i − p_m)
  Vector3<I> load_point;                                       ///< R p_m
  std::array<Vector3<I>, kCables> force, moment;               ///< the rows of D^-1: y_r^f, y_r^m
  std::array<std::array<Vector3<I>, kCables>, kCables> h;      ///< h_ri = y_r^f + y_r^m × arm_i
  std::array<std::array<Vector3<I>, kCables>, kCables> twist;  ///< d_i × y_r^m
  std::array<I, kCables> length, density, tension_radius;      ///< |d_i|, λ_i, V_i
  std::array<I, kCables> load_rate;                            ///< y_r·ŵ
  Square<I> gram;                                              ///< Z_r·Z_i
  ItemLoads<I> items;                                          ///< only where loads are items
};

template <class I>
Origin<I> make_origin(const UndisturbedBox<I>& box, const ToleranceModel<I>& tolerance) {
  using Upper = UpperOf<I>;
  const Model<I>& model = box.model;
  Origin<I> origin;
  origin.lead = box.lead;
  origin.has_items = !model.loads.empty();
  origin.has_ellipsoid = model.has_ellipsoid;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) origin.r_WP(i, j) = box.motion.r_WP(i, j).range;
  }
  origin.q = box.q;
  for (std::size_t i = 0; i < kCables; ++i) {
    origin.d[i] = ranges(box.geometry.p_AB_W[i]);
    origin.reach[i] = rotated_range(box.motion.r_WP, model.p_PB[i]);
    origin.arm[i] = rotated_range(box.motion.r_WP, model.p_MB[i]);
    origin.length[i] = box.length[i].range;
    origin.density[i] = box.density[i].range;
    origin.tension_radius[i] = box.radius[i].range;
    origin.reach_size[i] = norm_above(model.p_PB[i]) + tolerance.platform_anchor[i];
    origin.arm_size[i] = norm_above(model.p_MB[i]) + tolerance.platform_anchor[i] + tolerance.load_point;
    origin.pull[i] = Upper(0.0);
    if (box.lead == Lead::kPath) continue;
    Upper off = tolerance.cable_length[i];
    if (box.lead == Lead::kByAnchors) off += tolerance.base_anchor[i] + tolerance.platform_anchor[i];
    origin.pull[i] = (above(box.length[i].range) + tolerance.cable_length[i]) * off;
  }
  for (std::size_t r = 0; r < kCables; ++r) {
    std::array<typename ProofScalarTraits<I>::Point, 6> y;
    for (std::size_t j = 0; j < 6; ++j) {
      y[j] = box.c(static_cast<int>(r), static_cast<int>(j));
      origin.c[r][j] = I(y[j]);
      origin.c_magnitude[r][j] = above(origin.c[r][j]);
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      const std::array<I, 3> swing = cross_exact<I>({y[3], y[4], y[5]}, origin.arm[i]);
      const std::array<I, 3> twist = cross_exact<I>({y[3], y[4], y[5]}, origin.d[i]);
      origin.h.set(r, i, {origin.c[r][0] + swing[0], origin.c[r][1] + swing[1], origin.c[r][2] + swing[2]});
      origin.twist.set(r, i, {-twist[0], -twist[1], -twist[2]});
      if (box.lead == Lead::kPath) continue;
      origin.swing.set(r, i, swing);
      origin.sweep.set(r, i, cross_exact<I>({y[3], y[4], y[5]}, origin.reach[i]));
    }
    if (!origin.has_ellipsoid) continue;
    for (std::size_t i = 0; i < r; ++i) {
      I sum(0.0);
      for (std::size_t k = 0; k < 6; ++k) sum = sum + box.root[r][k] * box.root[i][k];
      origin.gram[r][i] = origin.gram[i][r] = sum;
    }
    origin.gram[r][r] = sqr(origin.tension_radius[r]);
  }
  const Vector3<I> load_point = model.p_PB[0] - model.p_MB[0];
  origin.load_point = rotated_range(box.motion.r_WP, load_point);
  origin.load_point_size = norm_above(load_point) + tolerance.load_point;
  return origin;
}

/// |a × b| by coordinates, from bounds of those of a and b.
template <class Upper>
std::array<Upper, 3> cross_above(const std::array<Upper, 3>& a, const std::array<Upper, 3>& b) {
  return {a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]};
}

/// How far, on X, what is linear in y and in a vector that moves by `moved` is from that of C: with Y = S P C, |S P −
/// I| <= q,
///   y(τ) ∘ a(τ) = Σ_k (S P)_rk c_k ∘ a(0) + y_r(τ) ∘ (a(τ) − a(0)).
template <class I>
Table<UpperOf<I>> product_errors(const Products<I>& products, const Square<UpperOf<I>>& q,
                                 const std::array<std::array<UpperOf<I>, 3>, kCables>& moment,
                                 const std::array<std::array<UpperOf<I>, 3>, kCables>& moved) {
  Table<UpperOf<I>> errors = upper_product(q, products.magnitude);
  for (std::size_t r = 0; r < kCables; ++r) {
    for (std::size_t i = 0; i < kCables; ++i) {
      const auto more = cross_above(moment[r], moved[i]);
      for (std::size_t n = 0; n < 3; ++n) errors[r][i][n] += more[n];
    }
  }
  return errors;
}

/// Bounds of all rates on the X of a guess, by (i).
template <class I>
Change<UpperOf<I>> rates(const Origin<I>& origin, const ToleranceModel<I>& tolerance, const Change<UpperOf<I>>& guess,
                         Errors<I>& errors) {
  using Upper = UpperOf<I>;
  // |S P − I| <= |S − I| + |P − I| + |S − I||P − I|
  Square<Upper> q = taut::upper_product(guess.s, origin.q);
  for (std::size_t r = 0; r < kCables; ++r) {
    for (std::size_t k = 0; k < kCables; ++k) q[r][k] += guess.s[r][k] + origin.q[r][k];
  }
  errors.y = taut::upper_product(q, origin.c_magnitude);
  std::array<std::array<Upper, 3>, kCables> moment;
  Upper spin(0.0);   // >= |Ω_c|
  Upper drift(0.0);  // >= |ṗ_c|
  for (std::size_t r = 0; r < kCables; ++r) {
    for (std::size_t n = 0; n < 3; ++n) moment[r][n] = origin.c_magnitude[r][3 + n] + errors.y[r][3 + n];
    if (origin.lead == Lead::kPath) continue;
    const Upper moment_size = norm_above<I>(moment[r]);
    std::array<Upper, 3> force;
    for (std::size_t n = 0; n < 3; ++n) force[n] = origin.c_magnitude[r][n] + errors.y[r][n];
    spin += origin.pull[r] * moment_size;
    drift += origin.pull[r] * (norm_above<I>(force) + moment_size * origin.load_point_size);
  }
  errors.h = product_errors(origin.h, q, moment, guess.arm);
  errors.twist = product_errors(origin.twist, q, moment, guess.d);

  const Upper turn = tolerance.orientation + tolerance.orientation * spin;  // ω, and Ω_c turned by T
  Change<Upper> rate;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Upper reach_rate = turn * origin.reach_size[i] + tolerance.platform_anchor[i];
    rate.reach[i].fill(reach_rate);
    rate.arm[i].fill(turn * origin.arm_size[i] + tolerance.platform_anchor[i] + tolerance.load_point);
    rate.d[i].fill(reach_rate + tolerance.position + tolerance.base_anchor[i]);
  }
  if (origin.lead != Lead::kPath) {
    const Table<Upper> swing = product_errors(origin.swing, q, moment, guess.arm);
    const Table<Upper> sweep = product_errors(origin.sweep, q, moment, guess.reach);
    for (std::size_t j = 0; j < kCables; ++j) {
      const Upper& pull = origin.pull[j];
      for (std::size_t i = 0; i < kCables; ++i) {
        for (std::size_t n = 0; n < 3; ++n) {
          rate.d[i][n] += pull * (origin.h.magnitude[j][i][n] + errors.h[j][i][n]);
          rate.arm[i][n] += pull * (origin.swing.magnitude[j][i][n] + swing[j][i][n]);
          rate.reach[i][n] += pull * (origin.sweep.magnitude[j][i][n] + sweep[j][i][n]);
        }
      }
    }
  }
  rate.load_point.fill((turn + spin) * origin.load_point_size + tolerance.load_point);
  rate.position = drift + tolerance.position;
  rate.turn = turn + spin;

  Square<Upper> b;
  Square<Upper> s = guess.s;
  for (std::size_t r = 0; r < kCables; ++r) {
    for (std::size_t i = 0; i < kCables; ++i) {
      b[r][i] = Upper(0.0);
      for (std::size_t n = 0; n < 3; ++n) {
        b[r][i] += (origin.h.magnitude[r][i][n] + errors.h[r][i][n]) * rate.d[i][n] +
                   (origin.twist.magnitude[r][i][n] + errors.twist[r][i][n]) * rate.arm[i][n];
      }
    }
    s[r][r] += Upper(1.0);
  }
  rate.s = taut::upper_product(b, s);
  return rate;
}

/// κ_ri for the nominal wrench `w` of K.
template <class I>
std::array<I, kCables> densities(const OnAll<I>& x, const Vector6<I>& w) {
  std::array<I, kCables> kappa;
  for (std::size_t i = 0; i < kCables; ++i) {
    kappa[i] = I(0.0);
    for (int k = 0; k < 3; ++k) kappa[i] = kappa[i] + x.force[i](k) * w(k) + x.moment[i](k) * w(3 + k);
  }
  return kappa;
}

/// The extremal loads of the items on X, row by row.
template <class I>
ItemLoads<I> item_loads(const UndisturbedBox<I>& box, const Matrix3<I>& r_WP, const OnAll<I>& x) {
  const LoadsAtPose<I> at = loads_at(box.model.loads, r_WP);
  const ExtremalLoads<I> loads(box.model.loads, at);
  ItemLoads<I> result;
  for (std::size_t r = 0; r < kCables; ++r) {
    Vector6<I> y;
    for (int k = 0; k < 3; ++k) {
      y(k) = x.force[r](k);
      y(3 + k) = x.moment[r](k);
    }
    const DensityRange<I> range = density_range(box.model.loads, at, y);
    for (std::size_t side = 0; side < 2; ++side) {
      const Extremum which = side == 0 ? Extremum::kLeast : Extremum::kGreatest;
      const ExtremalLoad<I> load = loads.find(x.force[r], x.moment[r], which);
      result[r][side] = {densities(x, Vector6<I>(load.wrench + box.wrench)), load.by_turn,
                         above(side == 0 ? range.below : range.above)};
    }
  }
  return result;
}

/// The rows of D^-1 on X, off those of C by at most `errors`.
RowBalls row_balls(const Matrix6<double>& c, const Square<double>& errors) {
  const auto ball = [&](int first) {
    VectorBall<Six> v;
    for (int k = 0; k < 3; ++k) {
      v.mid[static_cast<std::size_t>(k)] = Six::generate([&](int r) { return c(r, first + k); });
    }
    v.size = size_of(v.mid) + Six(kUnderflow);
    const auto column = [&](std::size_t j) { return Six::generate([&](std::size_t r) { return errors[r][j]; }); };
    const auto j = static_cast<std::size_t>(first);
    v.error = size_of(std::array<Six, 3>{column(j), column(j + 1), column(j + 2)}) + Six(kUnderflow);
    return v;
  };
  return {ball(0), ball(3)};
}

/// Adds y_i·w(r) to the densities κ_ri for each r, w(r) being `load` of row r.
void add_products(const Matrix6<double>& c, const RowBalls& rows, const ExtremalRows::Side& load, std::size_t side,
                  ItemLoads<Interval>& loads) {
  const auto force_size = rows.force.size.values(), moment_size = rows.moment.size.values();
  const auto force_error = rows.force.error.values(), moment_error = rows.moment.error.values();
  const Six force_most = load.force.size + load.force.error, moment_most = load.moment.size + load.moment.error;
  const Six force_off = load.force.error + Six(kRounding) * load.force.size;
  const Six moment_off = load.moment.error + Six(kRounding) * load.moment.size;
  for (std::size_t i = 0; i < kCables; ++i) {
    const int row = static_cast<int>(i);
    Six product(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      product += Six(c(row, static_cast<int>(k))) * load.force.mid[k];
      product += Six(c(row, 3 + static_cast<int>(k))) * load.moment.mid[k];
    }
    const Six error = Six(force_error[i]) * force_most + Six(force_size[i]) * force_off +
                      Six(moment_error[i]) * moment_most + Six(moment_size[i]) * moment_off + Six(kUnderflow);
    const auto minus_lower = (error - product).values(), upper = (error + product).values();
    for (std::size_t r = 0; r < kCables; ++r) {
      Interval& kappa = loads[r][side].kappa[i];
      kappa = kappa + Interval(-minus_lower[r], upper[r]);
    }
  }
}

/// The same as item_loads(), all rows at once.
ItemLoads<Interval> item_loads_of_all_rows(const UndisturbedBox<Interval>& box, const Matrix3<Interval>& r_WP,
                                           const OnAll<Interval>& x, const Square<double>& errors) {
  const RowBalls rows = row_balls(box.c, errors);
  const ExtremalRows extremes = box.item_rows.extremes(ItemRows::rotation(r_WP), rows);
  const Vector6<Interval> nominal = box.item_rows.nominal_wrench(r_WP) + box.wrench;
  const std::array<Interval, kCables> kappa = densities(x, nominal);
  ItemLoads<Interval> result;
  for (std::size_t side = 0; side < 2; ++side) {
    const ExtremalRows::Side& load = extremes.sides[side];
    const auto reach = load.reach.values();
    for (std::size_t r = 0; r < kCables; ++r) {
      result[r][side].kappa = kappa;
      result[r][side].reach = reach[r];
    }
    add_products(box.c, rows, load, side, result);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto minus_lower = (load.turn.error - load.turn.mid[k]).values();
      const auto upper = (load.turn.error + load.turn.mid[k]).values();
      for (std::size_t r = 0; r < kCables; ++r) {
        result[r][side].turn(static_cast<int>(k)) = Interval(-minus_lower[r], upper[r]);
      }
    }
  }
  return result;
}

/// In all of X, where the rows of D^-1 are off those of C by at most `errors`.
template <class I>
ItemLoads<I> item_loads(const UndisturbedBox<I>& box, const Matrix3<I>& r_WP, const OnAll<I>& x,
                        const Square<UpperOf<I>>& errors) {
  if constexpr (std::is_same_v<I, Interval>) {
    if (box.item_rows.has_extremes() && !box.is_item_by_item) return item_loads_of_all_rows(box, r_WP, x, errors);
  }
  return item_loads(box, r_WP, x);
}

/// The states of all deviations, τ from 0 to a part of the whole: see theory.md 7, "Where the states are".
template <class I>
class States {
 public:
  using Upper = UpperOf<I>;

  /// At τ = 0.
  States(const UndisturbedBox<I>& box, const Origin<I>& origin, const ToleranceModel<I>& tolerance)
      : box_(box), origin_(origin), tolerance_(tolerance) {
    reached_.with(reached_, reached_, [](Upper& x, const Upper&, const Upper&) { x = Upper(0.0); });
    rate_ = rates(origin, tolerance, reached_, errors_);
  }

  /// Goes on by `share` of the whole, a power of two. @returns false where no guess holds.
  [[nodiscard]] bool advance(double share) {
    constexpr int kMostGuesses = 12;
    constexpr double kRoom = 1.25;  // over the rates on the last X
    constexpr double kHopeless = 8;
    constexpr double kLeast = 0x1p-200;  // so that every guess is positive
    for (int k = 0; k < kMostGuesses; ++k) {
      guess_.with(reached_, rate_, [&](Upper& x, const Upper& from, const Upper& by) {
        x = from + Upper(kRoom * share) * by + Upper(kLeast);
      });
      rate_ = rates(origin_, tolerance_, guess_, errors_);
      Change<Upper> moved;
      bool holds = true;
      moved.with(reached_, rate_, [&](Upper& x, const Upper& from, const Upper& by) { x = from + Upper(share) * by; });
      moved.with(moved, guess_, [&](const Upper&, const Upper& x, const Upper& guessed) {
        if (!(x < guessed)) holds = false;  // also a NaN
      });
      if (holds) {
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

  /// X of the last part, which ends at τ = `until`. Void where some V_r may be 0.
  /// @param length_change  of a whole deviation
  [[nodiscard]] std::optional<OnAll<I>> enclosed(const Upper& until,
                                                 const std::array<Upper, kCables>& length_change) const {
    OnAll<I> x;
    x.load_point = widened<I>(origin_.load_point, guess_.load_point);
    std::array<Upper, kCables> tension_radius;  // >= |Z_r| at τ = 0
    for (std::size_t r = 0; r < kCables; ++r) tension_radius[r] = above(origin_.tension_radius[r]);
    std::array<Upper, kCables> root_moved;  // >= |Z_r(τ) − Z_r(0)|, as Z(τ) = S Z(0)
    for (std::size_t r = 0; r < kCables; ++r) {
      const auto entry = [&](std::size_t j) {
        return I(origin_.c[r][j] + ProofScalarTraits<I>::symmetric(errors_.y[r][j]));
      };
      const auto near = [](const std::array<I, 3>& of_c, const std::array<Upper, 3>& error) {
        return widened<I>(Vector3<I>(of_c[0], of_c[1], of_c[2]), error);
      };
      x.d[r] = widened<I>(origin_.d[r], guess_.d[r]);
      x.reach[r] = widened<I>(origin_.reach[r], guess_.reach[r]);
      x.arm[r] = widened<I>(origin_.arm[r], guess_.arm[r]);
      x.force[r] = {entry(0), entry(1), entry(2)};
      x.moment[r] = {entry(3), entry(4), entry(5)};
      for (std::size_t i = 0; i < kCables; ++i) {
        x.h[r][i] = near(origin_.h.of_c[r][i], errors_.h[r][i]);
        x.twist[r][i] = near(origin_.twist.of_c[r][i], errors_.twist[r][i]);
      }
      I load_rate(0.0);
      for (int n = 0; n < 3; ++n) {
        load_rate = load_rate + x.force[r](n) * (tolerance_.wrench(n) + box_.wrench_change(n)) +
                    x.moment[r](n) * (tolerance_.wrench(n + 3) + box_.wrench_change(n + 3));
      }
      x.load_rate[r] = load_rate;
      // λ(τ) = S λ(0) + τ Y(τ) ŵ.
      Upper density_moved = until * above(load_rate);
      root_moved[r] = Upper(0.0);
      for (std::size_t k = 0; k < kCables; ++k) {
        density_moved += guess_.s[r][k] * above(origin_.density[k]);
        if (origin_.has_ellipsoid) root_moved[r] += guess_.s[r][k] * tension_radius[k];
      }
      x.density[r] = origin_.density[r] + ProofScalarTraits<I>::symmetric(density_moved);
      x.tension_radius[r] = origin_.tension_radius[r] + ProofScalarTraits<I>::symmetric(root_moved[r]);
      if (origin_.has_ellipsoid && !certainly_positive(x.tension_radius[r])) return std::nullopt;
      x.length[r] = origin_.length[r] + ProofScalarTraits<I>::symmetric(until * length_change[r]);
    }
    for (std::size_t r = 0; origin_.has_ellipsoid && r < kCables; ++r) {
      for (std::size_t i = 0; i < r; ++i) {
        const Upper moved =
            root_moved[r] * tension_radius[i] + tension_radius[r] * root_moved[i] + root_moved[r] * root_moved[i];
        x.gram[r][i] = x.gram[i][r] = origin_.gram[r][i] + ProofScalarTraits<I>::symmetric(moved);
      }
    }
    if (origin_.has_items) {
      Matrix3<I> r_WP = origin_.r_WP;  // a turn by an angle moves no unit vector farther than that
      for (int i = 0; i < 9; ++i) r_WP(i) = r_WP(i) + ProofScalarTraits<I>::symmetric(guess_.turn);
      x.items = item_loads(box_, r_WP, x, errors_.y);
    }
    return x;
  }

  /// How far things have moved at the end of the last part, at most.
  [[nodiscard]] const Change<Upper>& reached() const { return reached_; }

 private:
  const UndisturbedBox<I>& box_;
  const Origin<I>& origin_;
  const ToleranceModel<I>& tolerance_;
  Change<Upper> reached_;
  Change<Upper> guess_;
  Change<Upper> rate_;  ///< the last
  Errors<I> errors_;    ///< for the last guess
};

/// Bounds of how far a deviation changes |d_i|, wherever the platform is. Where lengths are controlled, the commanded
/// pose has the lengths L_i + e_i, whatever leads to it, and tracking changes them further; so do anchors that do not
/// lead.
template <class I>
std::array<UpperOf<I>, kCables> length_changes(const UndisturbedBox<I>& box, const ToleranceModel<I>& tolerance) {
  using Upper = UpperOf<I>;
  std::array<Upper, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Upper reach = norm_above(box.model.p_PB[i]) + tolerance.platform_anchor[i];
    result[i] = tolerance.position + tolerance.orientation * reach;
    if (box.lead != Lead::kPath) result[i] += tolerance.cable_length[i];
    if (box.lead != Lead::kByAnchors) result[i] += tolerance.base_anchor[i] + tolerance.platform_anchor[i];
  }
  return result;
}

/// A bound on X of the rate of |d_i|, where the path leads. A turn at the rate ω changes |d_i| at the rate
/// u_i·(ω × R b_i) = ω·(R b_i × u_i), |ω| <= ε, and |R b_i × u_i| <= |b_i|: the lesser of the two bounds counts.
template <class I>
UpperOf<I> length_rate(const Origin<I>& origin, const ToleranceModel<I>& tolerance, const OnAll<I>& x, std::size_t i) {
  const Vector3<I> direction = scaled(I(reciprocal(x.length[i])), x.d[i]);  // u_i
  const UpperOf<I> across = norm_above(Vector3<I>(cross(x.reach[i], direction)));
  const UpperOf<I>& lever = across < origin.reach_size[i] ? across : origin.reach_size[i];
  return tolerance.position + tolerance.orientation * lever + tolerance.base_anchor[i] + tolerance.platform_anchor[i];
}

/// (t) for a tension bound φ_r of cable r, at loads w* with κ_ri = y_i·w* that a turn moves by `load_turn`; `moved` of
/// each cable i is arm_i × (h_ri + d_i × y_r^m).
template <class I>
UpperOf<I> tension_rate(const Origin<I>& origin, const ToleranceModel<I>& tolerance, const OnAll<I>& x, std::size_t r,
                        const std::array<I, kCables>& kappa, const Vector3<I>& load_turn,
                        const std::array<Vector3<I>, kCables>& moved) {
  using Upper = UpperOf<I>;
  const I& length = x.length[r];
  const Vector3<I> pull = scaled(I(kappa[r] / length), x.d[r]);  // φ_r u_r
  Vector3<I> by_position = pull;                                 // P_r
  Vector3<I> by_turn = cross(x.arm[r], pull);                    // of the turn about P_m: W_r − R p_m × P_r
  if (origin.has_items) by_turn = by_turn + scaled(length, load_turn);
  Vector3<I> by_load_point(I(0.0), I(0.0), I(0.0));  // M_r
  std::array<Vector3<I>, kCables> by_base;           // A_ri
  std::array<Vector3<I>, kCables> by_platform;       // B_ri
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

  const Upper by_position_size = norm_above(by_position);
  const Upper by_turn_size = norm_above(Vector3<I>(by_turn + cross(x.load_point, by_position)));  // |W_r|
  Upper bound = tolerance.load_point * norm_above(by_load_point) + above(I(length * x.load_rate[r])) +
                tolerance.position * by_position_size + tolerance.orientation * by_turn_size;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (origin.lead != Lead::kPath) {
      // c_ri; T turns Ω_c, and R_c p_m to R p_m.
      const I turned = ProofScalarTraits<I>::symmetric(tolerance.orientation * norm_above(x.moment[i]) *
                                                       (by_turn_size + origin.load_point_size * by_position_size));
      const I c = dot(by_position, x.force[i]) + dot(by_turn, x.moment[i]) + turned;
      const Vector3<I> along = scaled(c, x.d[i]);
      const Upper size = above(c) * above(x.length[i]);
      bound += tolerance.cable_length[i] * size;
      if (origin.lead == Lead::kByAnchors) {
        by_base[i] = by_base[i] + along;
        by_platform[i] = by_platform[i] - along;
        bound += tolerance.platform_anchor[i] * tolerance.orientation * size;
      }
    }
    bound += tolerance.base_anchor[i] * norm_above(by_base[i]);
    bound += tolerance.platform_anchor[i] * norm_above(by_platform[i]);
  }
  return bound;
}

/// (t) for the least and the greatest tension of cable r.
template <class I>
std::array<UpperOf<I>, 2> tension_rates(const Origin<I>& origin, const ToleranceModel<I>& tolerance, const OnAll<I>& x,
                                        std::size_t r) {
  std::array<Vector3<I>, kCables> moved;
  std::array<I, kCables> share;  // Z_r·Z_i / V_r
  share.fill(I(0.0));
  const I inverse = origin.has_ellipsoid ? reciprocal(x.tension_radius[r]) : I(0.0);
  for (std::size_t i = 0; i < kCables; ++i) {
    if (origin.has_ellipsoid) share[i] = i == r ? x.tension_radius[r] : I(x.gram[r][i] * inverse);
    moved[i] = cross(x.arm[i], Vector3<I>(x.h[r][i] + x.twist[r][i]));
  }
  std::array<UpperOf<I>, 2> rates;
  for (std::size_t side = 0; side < 2; ++side) {
    std::array<I, kCables> kappa = origin.has_items ? x.items[r][side].kappa : x.density;
    if (origin.has_ellipsoid) {
      for (std::size_t i = 0; i < kCables; ++i) kappa[i] = side == 0 ? kappa[i] - share[i] : kappa[i] + share[i];
    }
    const Vector3<I> turn = origin.has_items ? x.items[r][side].turn : Vector3<I>(I(0.0), I(0.0), I(0.0));
    rates[side] = tension_rate(origin, tolerance, x, r, kappa, turn, moved);
  }
  return rates;
}

/// How far K moves tensions on X, by cable and side.
template <class I>
std::array<std::array<UpperOf<I>, 2>, kCables> reach_above(const Origin<I>& origin, const OnAll<I>& x) {
  std::array<std::array<UpperOf<I>, 2>, kCables> reach;
  for (std::size_t r = 0; r < kCables; ++r) {
    for (std::size_t side = 0; side < 2; ++side) {
      UpperOf<I> of_density = x.items[r][side].reach;
      if (origin.has_ellipsoid) of_density += above(x.tension_radius[r]);
      reach[r][side] = above(x.length[r]) * of_density;
    }
  }
  return reach;
}

}  // namespace

template <class I>
std::optional<ToleranceModel<I>> make_tolerance_model(const Problem& problem) {
  if (!problem.tolerances) return std::nullopt;
  const TolerancesText& text = *problem.tolerances;
  const auto decimal = [](const DecimalText& x) { return above(I(ScalarTraits<I>::from_decimal(x))); };
  const RowsText* const rows = stated_rows(problem);
  ToleranceModel<I> model;
  for (std::size_t i = 0; i < kCables; ++i) {
    model.base_anchor[i] = decimal(text.base_anchor_m[i]);
    model.platform_anchor[i] = decimal(text.platform_anchor_m[i]);
    model.cable_length[i] = text.cable_length_m ? decimal((*text.cable_length_m)[i]) : UpperOf<I>(0.0);
    if (rows != nullptr) model.cable_length[i] += decimal(rows->error_m[i]);
    model.wrench(static_cast<int>(i)) = ScalarTraits<I>::from_decimal(text.wrench[i]);
  }
  model.load_point = decimal(text.load_point_m);
  const auto is_nothing = [](const DecimalText& x) { return Decimal::parse(x).sign() == 0; };
  if (!problem.load.items.empty() && !(is_nothing(text.load_point_m) && std::ranges::all_of(text.wrench, is_nothing))) {
    throw std::logic_error("tolerances of the load beside items");
  }
  model.position = decimal(text.position_m);
  model.orientation = above(evaluate_constant<I>(text.orientation_rad));
  if (text.cable_length_m) {
    model.lead = Lead::kByAnchors;
  } else if (rows != nullptr) {
    model.lead = Lead::kAsTyped;
  }
  return model;
}

template <class I>
std::optional<DeviationBounds<I>> disturbance(const UndisturbedBox<I>& box, const ToleranceModel<I>& tolerance,
                                              int continuation_steps) {
  using Upper = UpperOf<I>;
  const std::array<Upper, kCables> farthest = length_changes(box, tolerance);
  for (std::size_t i = 0; i < kCables; ++i) {
    const I length = box.length[i].range + ProofScalarTraits<I>::symmetric(farthest[i]);
    if (!certainly_positive(length)) return std::nullopt;
  }
  const Origin<I> origin = make_origin(box, tolerance);
  States<I> states(box, origin, tolerance);
  DeviationBounds<I> result;
  const double share = 1.0 / continuation_steps;
  for (int step = 1; step <= continuation_steps; ++step) {
    if (!states.advance(share)) return std::nullopt;
    const std::optional<OnAll<I>> x = states.enclosed(Upper(share * step), farthest);
    if (!x) return std::nullopt;
    for (std::size_t r = 0; r < kCables; ++r) {
      if (box.lead == Lead::kPath) result.length[r] += Upper(share) * length_rate(origin, tolerance, *x, r);
      const std::array<Upper, 2> rate = tension_rates(origin, tolerance, *x, r);
      for (std::size_t side = 0; side < 2; ++side) result.tension[r][side] += Upper(share) * rate[side];
    }
    if (origin.has_items) result.reach = reach_above(origin, *x);  // the last X holds all states
  }
  if (box.lead != Lead::kPath) result.length = farthest;
  result.position = states.reached().position;
  result.turn = states.reached().turn;
  return result;
}

template std::optional<ToleranceModel<Interval>> make_tolerance_model(const Problem&);
template std::optional<ToleranceModel<MpInterval>> make_tolerance_model(const Problem&);
template std::optional<DeviationBounds<Interval>> disturbance(const UndisturbedBox<Interval>&,
                                                              const ToleranceModel<Interval>&, int);
template std::optional<DeviationBounds<MpInterval>> disturbance(const UndisturbedBox<MpInterval>&,
                                                                const ToleranceModel<MpInterval>&, int);

}  // namespace taut
