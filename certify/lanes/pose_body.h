// SPDX-License-Identifier: GPL-3.0-or-later
// The pose that six cable lengths imply, over a box: ParametricKrawczyk (parametric_krawczyk.h) for the equations of
// length_controlled_motion.h. Lanes are the cables, or the six unknowns. The numbers are not those of the templates:
// R b is computed as R(u, 1)(R_ref b), since the vectors R_ref b are the same for all u, and a box of z is kept as what
// it extends from ŷ. Proof: docs/theory.md, "Held by lengths".
#pragma once

#include "certify/lanes/kernel_body.h"

namespace taut::lanes {
namespace {

// ---- One interval ---------------------------------------------------------------------------------------------------

TAUT_LANES_INLINE double larger(double a, double b) { return a > b ? a : b; }

TAUT_LANES_INLINE Ends operator+(const Ends& a, const Ends& b) {
  return {a.minus_lower + b.minus_lower, a.upper + b.upper};
}
TAUT_LANES_INLINE Ends operator-(const Ends& a, const Ends& b) {
  return {a.minus_lower + b.upper, a.upper + b.minus_lower};
}
TAUT_LANES_INLINE Ends operator*(const Ends& a, const Ends& b) {
  const double lower = -a.minus_lower, minus_upper = -a.upper;
  return {larger(larger(a.minus_lower * b.upper, a.upper * b.minus_lower),
                 larger(lower * b.minus_lower, minus_upper * b.upper)),
          larger(larger(a.minus_lower * b.minus_lower, a.upper * b.upper),
                 larger(lower * b.upper, minus_upper * b.minus_lower))};
}
/// @pre x >= 0
TAUT_LANES_INLINE Ends scaled(double x, const Ends& a) { return {x * a.minus_lower, x * a.upper}; }
/// @pre b >= 0
TAUT_LANES_INLINE Ends times_positive(const Ends& a, const Ends& b) {
  const double least = -b.minus_lower;
  return {larger(a.minus_lower * b.upper, a.minus_lower * least), larger(a.upper * b.upper, a.upper * least)};
}
TAUT_LANES_INLINE double times_positive(double a, double b) { return a * b; }
TAUT_LANES_INLINE Ends sqr(const Ends& a) {
  const double least = larger(larger(-a.minus_lower, -a.upper), 0.0);
  const double most = larger(a.minus_lower, a.upper);
  return {-least * least, most * most};
}

// ---- Turns ----------------------------------------------------------------------------------------------------------

/// R(u, 1) = 1 + s ([u] + [u]^2) with s = 2 / (1 + |u|^2).
template <class T>
struct SmallTurn {
  T u[3], scale, matrix[3][3];
};

template <class T>
TAUT_LANES_INLINE void set_matrix(const T (&square)[3], const T& one, const T (&minus)[3], const T (&plus)[3],
                                  SmallTurn<T>& turn) {
  // minus, plus: u_j u_k ∓ u_i for i, j, k = 0, 1, 2 and so on in turns
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    turn.matrix[i][i] = one - times_positive(square[j] + square[k], turn.scale);
    turn.matrix[j][k] = times_positive(minus[i], turn.scale);
    turn.matrix[k][j] = times_positive(plus[i], turn.scale);
  }
}

TAUT_LANES_INLINE SmallTurn<Ends> small_turn(const Ends (&z)[6], double size) {
  SmallTurn<Ends> turn;
  Ends square[3], minus[3], plus[3];
  Ends norm = {-1.0, 1.0};
  for (int i = 0; i < 3; ++i) {
    turn.u[i] = scaled(size, z[3 + i]);
    square[i] = sqr(turn.u[i]);
    norm = norm + square[i];
  }
  turn.scale = {-2.0 / norm.upper, 2.0 / -norm.minus_lower};
  for (int i = 0; i < 3; ++i) {
    const Ends product = turn.u[(i + 1) % 3] * turn.u[(i + 2) % 3];
    minus[i] = product - turn.u[i];
    plus[i] = product + turn.u[i];
  }
  set_matrix(square, Ends{-1.0, 1.0}, minus, plus, turn);
  return turn;
}

/// Rounded.
TAUT_LANES_INLINE SmallTurn<double> small_turn(const Row& z, double size) {
  SmallTurn<double> turn;
  double square[3], minus[3], plus[3];
  double norm = 1.0;
  for (int i = 0; i < 3; ++i) {
    turn.u[i] = size * z.x[3 + i];
    square[i] = turn.u[i] * turn.u[i];
    norm += square[i];
  }
  turn.scale = 2.0 / norm;
  for (int i = 0; i < 3; ++i) {
    const double product = turn.u[(i + 1) % 3] * turn.u[(i + 2) % 3];
    minus[i] = product - turn.u[i];
    plus[i] = product + turn.u[i];
  }
  set_matrix(square, 1.0, minus, plus, turn);
  return turn;
}

// ---- The equations --------------------------------------------------------------------------------------------------

struct Vectors {
  Intervals x[3];
};

TAUT_LANES_INLINE Vectors turned(const Ends (&r)[3][3], const SignedRow (&point)[3]) {
  Vectors v;
  for (int i = 0; i < 3; ++i) {
    v.x[i] =
        broadcast(r[i][0]) * load(point[0]) + broadcast(r[i][1]) * load(point[1]) + broadcast(r[i][2]) * load(point[2]);
  }
  return v;
}
TAUT_LANES_INLINE Vectors turned(const SmallTurn<Ends>& by, const Vectors& v) {
  Vectors result;
  for (int i = 0; i < 3; ++i) {
    result.x[i] =
        broadcast(by.matrix[i][0]) * v.x[0] + broadcast(by.matrix[i][1]) * v.x[1] + broadcast(by.matrix[i][2]) * v.x[2];
  }
  return result;
}
TAUT_LANES_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
  return {{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2], a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}
TAUT_LANES_INLINE Intervals dot(const Vectors& a, const Vectors& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}
TAUT_LANES_INLINE Intervals squared_norm(const Vectors& a) { return sqr(a.x[0]) + sqr(a.x[1]) + sqr(a.x[2]); }
TAUT_LANES_INLINE Intervals half(const Intervals& a) {
  return {broadcast(0.5) * a.minus_lower, broadcast(0.5) * a.upper};
}
TAUT_LANES_INLINE double greatest(const Lanes& x) {
  Row row;
  store(row, x);
  double result = row.x[0];
  for (int i = 1; i < 6; ++i) result = larger(result, row.x[i]);
  return result;
}

/// Of one box of T.
struct PoseSearch {
  const LengthControl& at;
  Vectors base_mid, base_range;     ///< p_ref − a_i, at m and over T
  Vectors mid, slope, bend, range;  ///< R_ref b_i, as LengthControl has R_ref
  Row a[6];                         ///< A by columns
  Row centre;                       ///< ŷ
  Intervals residual;               ///< A g(ŷ, m)

  /// Σ_l A_kl x_l
  TAUT_LANES_INLINE Intervals times_a(const IntervalRow& x) const {
    Intervals sum = factors(load(a[0])) * Intervals{broadcast(x.minus_lower.x[0]), broadcast(x.upper.x[0])};
    for (int l = 1; l < 6; ++l) {
      sum = sum + factors(load(a[l])) * Intervals{broadcast(x.minus_lower.x[l]), broadcast(x.upper.x[l])};
    }
    return sum;
  }
  TAUT_LANES_INLINE Intervals times_a(const Intervals& x) const {
    IntervalRow row;
    store(row, x);
    return times_a(row);
  }
  /// ŷ + extent, each between −1 and 1. @returns whether it is
  TAUT_LANES_INLINE bool box_around(const Intervals& extent, Ends (&z)[6]) const {
    IntervalRow row;
    const Lanes middle = load(centre);
    store(row, {extent.minus_lower - middle, extent.upper + middle});
    bool is_inside = true;
    for (int k = 0; k < 6; ++k) {
      z[k] = {row.minus_lower.x[k], row.upper.x[k]};
      is_inside = is_inside && z[k].minus_lower < 1 && z[k].upper < 1;
    }
    return is_inside;
  }
  TAUT_LANES_INLINE Vectors moved(const Vectors& base, const Ends (&z)[6]) const {
    Vectors result;
    for (int i = 0; i < 3; ++i) result.x[i] = base.x[i] + broadcast(scaled(at.position, z[i]));
    return result;
  }
};

TAUT_LANES_INLINE Vectors from_base(const Ends (&p)[3], const Machine& machine) {
  Vectors result;
  for (int i = 0; i < 3; ++i) result.x[i] = broadcast(p[i]) - load(machine.base[i]);
  return result;
}

/// Chooses A and ŷ: near the inverse of g_y at z = 0, and near z(m), by simplified Newton steps.
[[gnu::noinline]] bool choose_centre(PoseSearch& search) {
  const LengthControl& at = search.at;
  Lanes base[3], reach[3], d[3];
  for (int i = 0; i < 3; ++i) {
    base[i] = midpoint_approx(search.base_mid.x[i]);
    reach[i] = midpoint_approx(search.mid.x[i]);
    d[i] = base[i] + reach[i];
  }
  Row g_y[6];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    store(g_y[i], broadcast(at.position) * d[i]);
    store(g_y[3 + i], broadcast(2.0 * at.turn) * (reach[j] * base[k] - reach[k] * base[j]));
  }
  // Row k of g_y is its column k, so what are rows of the inverse here are the columns of A.
  if (!invert<Entries::kByRows>(g_y, search.a)) return false;
  const Lanes length = midpoint_approx(load(at.length_mid));
  const Lanes squared_length = length * length;
  store(search.centre, broadcast(0.0));
  constexpr int kMostSteps = 60;
  constexpr double kEnough = 0x1p-46;
  double last = __builtin_inf();
  for (int step = 0; step < kMostSteps; ++step) {
    const SmallTurn<double> turn = small_turn(search.centre, at.turn);
    Lanes square = -squared_length;
    for (int i = 0; i < 3; ++i) {
      const Lanes x = base[i] + broadcast(at.position * search.centre.x[i]) + broadcast(turn.matrix[i][0]) * reach[0] +
                      broadcast(turn.matrix[i][1]) * reach[1] + broadcast(turn.matrix[i][2]) * reach[2];
      square = square + x * x;
    }
    Row g;
    store(g, broadcast(0.5) * square);
    const Lanes correction = product(search.a, g);
    const Lanes next = load(search.centre) - correction;
    store(search.centre, next);
    const double size = greatest(abs(correction));
    if (!(greatest(abs(next)) < 1.0)) return false;
    if (!(size < 0.5 * last) || size < kEnough) break;
    last = size;
  }
  return true;
}

/// I − A g_y over a box of z and T, by columns. @returns its row sums
[[gnu::noinline]] Lanes contraction(const PoseSearch& search, const Ends (&z)[6], IntervalRow (&rest)[6]) {
  const LengthControl& at = search.at;
  const SmallTurn<Ends> turn = small_turn(z, at.turn);
  const Vectors reach = turned(turn, search.range);
  const Vectors base = search.moved(search.base_range, z);
  const Vectors moment = cross(reach, base);  // = R b_i × d_i, and tighter
  Vectors u;
  for (int i = 0; i < 3; ++i) u.x[i] = broadcast(turn.u[i]);
  const Vectors swung = cross(moment, u);
  const Intervals scale = broadcast(scaled(at.turn, turn.scale));
  const Lanes position = broadcast(at.position);
  IntervalRow g_y[6];
  for (int i = 0; i < 3; ++i) {
    const Intervals d = base.x[i] + reach.x[i];
    store(g_y[i], {position * d.minus_lower, position * d.upper});
    store(g_y[3 + i], times_positive(moment.x[i] + swung.x[i], scale));
  }
  Lanes row_sum = broadcast(0.0);
#pragma GCC unroll 1
  for (int j = 0; j < 6; ++j) {
    const Intervals product = search.times_a(g_y[j]);
    const Lanes diagonal = load(kUnit[j]);
    const Intervals entry = {product.upper - diagonal, product.minus_lower + diagonal};
    store(rest[j], entry);
    row_sum = row_sum + magnitude(entry);
  }
  return row_sum;
}

/// A g_t at each z of a box: slopes from m.
[[gnu::noinline]] Intervals drift_at(const PoseSearch& search, const Ends (&z)[6]) {
  const LengthControl& at = search.at;
  const SmallTurn<Ends> turn = small_turn(z, at.turn);
  const Vectors reach = turned(turn, search.mid);
  const Vectors reach_slope = turned(turn, search.slope);
  const Vectors reach_bend = turned(turn, search.bend);
  const Vectors base = search.moved(search.base_mid, z);
  const Lanes radius = broadcast(at.radius);
  Vectors d, sigma, over;
  for (int i = 0; i < 3; ++i) {
    d.x[i] = base.x[i] + reach.x[i];
    sigma.x[i] = broadcast(at.p_slope[i]) + reach_slope.x[i];
    over.x[i] = widened(sigma.x[i], radius * magnitude(reach_bend.x[i]));
  }
  const Intervals length = load(at.length_mid), length_slope = load(at.length_slope);
  const Intervals by_t = dot(d, sigma) - length_slope * length;
  const Intervals bend = dot(d, reach_bend) + half(squared_norm(over) - sqr(length_slope));
  const Intervals bent = search.times_a(bend);
  return widened(search.times_a(by_t), radius * magnitude(bent));
}

[[gnu::noinline]] void set_residual(PoseSearch& search) {
  Ends z[6];
  for (int k = 0; k < 6; ++k) z[k] = {-search.centre.x[k], search.centre.x[k]};
  const Vectors reach = turned(small_turn(z, search.at.turn), search.mid);
  Vectors d = search.moved(search.base_mid, z);
  for (int i = 0; i < 3; ++i) d.x[i] = d.x[i] + reach.x[i];
  search.residual = search.times_a(half(squared_norm(d) - sqr(load(search.at.length_mid))));
}

/// 1 − ρ, rounded down; not positive where that is not certain.
TAUT_LANES_INLINE double gap_of(const Lanes& row_sum) {
  if (!all(row_sum < broadcast(1.0))) return 0.0;  // also where a NaN slipped in
  return -(greatest(row_sum) - 1.0);
}

Outcome find_pose(const Machine& machine, const LengthControl& at, FormRow<1>& z) {
  PoseSearch search{at,
                    from_base(at.p_mid, machine),
                    from_base(at.p_range, machine),
                    turned(at.r_mid, machine.platform),
                    turned(at.r_slope, machine.platform),
                    turned(at.r_bend, machine.platform),
                    turned(at.r_range, machine.platform),
                    {},
                    {},
                    {}};
  if (!choose_centre(search)) return Outcome::kNo;

  // (a) and (b) of parametric_krawczyk.h.
  Ends box[6];
  IntervalRow rest[6];
  for (Ends& x : box) x = {1.0, 1.0};
  const Lanes over_tube = contraction(search, box, rest);
  const double gap = gap_of(over_tube);
  if (!(gap > 0)) return Outcome::kNo;
  set_residual(search);
  const Intervals& residual = search.residual;
  const double delta = greatest(magnitude(residual)) / gap;
  if (!search.box_around({broadcast(delta), broadcast(delta)}, box)) return Outcome::kNo;
  const Intervals drift = drift_at(search, box);
  const Lanes drift_size = magnitude(drift);
  const Lanes reach = broadcast(at.radius) * drift_size;
  const double w = greatest(magnitude(residual) + reach) / gap;
  const Lanes most = broadcast(w);
  if (!search.box_around({most, most}, box)) return Outcome::kNo;

  // (c), of what z(t) extends from ŷ: first in ŷ ± w, then in what that leaves, and ŷ.
  const Intervals moved = widened(-residual, reach);
  const Intervals within = widened(moved, most * over_tube);
  const Intervals known = {min(within.minus_lower, most), min(within.upper, most)};
  const Lanes zero = broadcast(0.0);
  IntervalRow extent;
  store(extent, {max(known.minus_lower, zero), max(known.upper, zero)});
  static_cast<void>(search.box_around(load(extent), box));
  const Lanes over_box = contraction(search, box, rest);
  Row size[6], q[6];
  for (int j = 0; j < 6; ++j) store(size[j], magnitude(load(rest[j])));
  if (!neumann_bound(size, q)) return Outcome::kNo;
  Intervals image = moved;
  for (int j = 0; j < 6; ++j) {
    image = image + load(rest[j]) * Intervals{broadcast(extent.minus_lower.x[j]), broadcast(extent.upper.x[j])};
  }
  image = {min(image.minus_lower, known.minus_lower), min(image.upper, known.upper)};
  Intervals at_mid = widened(-residual, broadcast(delta) * over_box);
  at_mid = {min(at_mid.minus_lower, image.minus_lower), min(at_mid.upper, image.upper)};
  if (any(at_mid.upper < -at_mid.minus_lower)) return Outcome::kFault;
  Row sizes;
  store(sizes, drift_size);
  const Lanes middle = load(search.centre);
  Forms<1> result;
  result.at_mid = {at_mid.minus_lower - middle, at_mid.upper + middle};
  result.slope[0] = widened(-drift, product(q, sizes));
  result.range = {image.minus_lower - middle, image.upper + middle};
  store(z, result);
  return Outcome::kYes;
}

}  // namespace
}  // namespace taut::lanes
