// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of kernel.h on lanes.h; what includes this defines TAUT_LANES_LEVEL. Formulas, one for one, are those
// of cable_geometry, InverseBound, box_proof.cc and SlopeForm, with the cables as lanes and one slope a variable.
#pragma once

#include "certify/lanes/lanes.h"

namespace taut::lanes {
namespace {

// ---- Centred forms --------------------------------------------------------------------------------------------------

template <int N>
struct Forms {
  Intervals at_mid, slope[N], range;
};

template <int N>
TAUT_LANES_INLINE Forms<N> load(const FormRow<N>& row) {
  Forms<N> r;
  r.at_mid = load(row.at_mid);
  for (int k = 0; k < N; ++k) r.slope[k] = load(row.slope[k]);
  r.range = load(row.range);
  return r;
}
template <int N>
TAUT_LANES_INLINE void store(FormRow<N>& row, const Forms<N>& a) {
  store(row.at_mid, a.at_mid);
  for (int k = 0; k < N; ++k) store(row.slope[k], a.slope[k]);
  store(row.range, a.range);
}
template <int N>
TAUT_LANES_INLINE Forms<N> operator+(const Forms<N>& a, const Forms<N>& b) {
  Forms<N> r;
  r.at_mid = a.at_mid + b.at_mid;
  for (int k = 0; k < N; ++k) r.slope[k] = a.slope[k] + b.slope[k];
  r.range = a.range + b.range;
  return r;
}
template <int N>
TAUT_LANES_INLINE Forms<N> operator-(const Forms<N>& a, const Forms<N>& b) {
  Forms<N> r;
  r.at_mid = a.at_mid - b.at_mid;
  for (int k = 0; k < N; ++k) r.slope[k] = a.slope[k] - b.slope[k];
  r.range = a.range - b.range;
  return r;
}
template <int N>
TAUT_LANES_INLINE Forms<N> operator*(const Form<N>& a, const SignedFactors& b) {
  Forms<N> r;
  r.at_mid = broadcast(a.at_mid) * b;
  for (int k = 0; k < N; ++k) r.slope[k] = broadcast(a.slope[k]) * b;
  r.range = broadcast(a.range) * b;
  return r;
}
template <int N>
TAUT_LANES_INLINE Forms<N> sqr(const Forms<N>& a) {
  Forms<N> r;
  r.at_mid = sqr(a.at_mid);
  const Intervals sum = a.at_mid + a.range;
  for (int k = 0; k < N; ++k) r.slope[k] = a.slope[k] * sum;
  r.range = sqr(a.range);
  return r;
}
/// @pre a is positive; where it is not, the flags say so or the result is not to be used
template <int N>
TAUT_LANES_INLINE Forms<N> sqrt(const Forms<N>& a) {
  Forms<N> r;
  r.at_mid = sqrt(a.at_mid);
  r.range = sqrt(a.range);
  const Intervals over = reciprocal_of_positive(r.at_mid + r.range);
  for (int k = 0; k < N; ++k) r.slope[k] = times_positive(a.slope[k], over);
  return r;
}
/// a b for a > 0.
template <int N>
TAUT_LANES_INLINE Forms<N> times_by_positive(const Forms<N>& a, const Forms<N>& b) {
  Forms<N> r;
  r.at_mid = times_positive(b.at_mid, a.at_mid);
  for (int k = 0; k < N; ++k) r.slope[k] = a.slope[k] * b.range + times_positive(b.slope[k], a.at_mid);
  r.range = times_positive(b.range, a.range);
  return r;
}
/// Intersects the range with the mean-value form. @returns where they do not meet
template <int N>
TAUT_LANES_INLINE Mask tighten(Forms<N>& a, const double (&radius)[N]) {
  Lanes reach = broadcast(radius[0]) * magnitude(a.slope[0]);
  for (int k = 1; k < N; ++k) reach = reach + broadcast(radius[k]) * magnitude(a.slope[k]);
  const Intervals mean_value = widened(a.at_mid, reach);
  a.range = {min(a.range.minus_lower, mean_value.minus_lower), min(a.range.upper, mean_value.upper)};
  return a.range.upper < -a.range.minus_lower;
}

// ---- Geometry -------------------------------------------------------------------------------------------------------

/// Row `row` of D: a(j) d(k) − a(k) d(j), at m and its slopes.
template <int N>
TAUT_LANES_INLINE void store_moment(const Forms<N>& arm_j, const Forms<N>& d_k, const Forms<N>& arm_k,
                                    const Forms<N>& d_j, int row, Box<N>& box) {
  store(box.d_mid[row], arm_j.at_mid * d_k.at_mid - arm_k.at_mid * d_j.at_mid);
  for (int n = 0; n < N; ++n) {
    const Intervals first = arm_j.slope[n] * d_k.range + arm_j.at_mid * d_k.slope[n];
    const Intervals second = arm_k.slope[n] * d_j.range + arm_k.at_mid * d_j.slope[n];
    store(box.d_slope[n][row], first - second);
  }
}

template <int N>
TAUT_LANES_INLINE Forms<N> turned(const Form<N> (&row)[3], const SignedRow (&point)[3]) {
  return row[0] * load(point[0]) + row[1] * load(point[1]) + row[2] * load(point[2]);
}

template <int N>
Outcome enclose_geometry(const Machine& machine, const PoseForms<N>& pose, Box<N>& box) {
  Forms<N> d[3], arm[3];
  for (int k = 0; k < N; ++k) box.radius[k] = pose.radius[k];
  for (int axis = 0; axis < 3; ++axis) {
    const Forms<N> reach = turned<N>(pose.r[axis], machine.platform);
    arm[axis] = machine.is_arm_platform ? reach : turned<N>(pose.r[axis], machine.arm);
    const Form<N>& p = pose.p[axis];
    const Intervals base = load(machine.base[axis]);
    d[axis].at_mid = broadcast(p.at_mid) - base + reach.at_mid;
    for (int k = 0; k < N; ++k) d[axis].slope[k] = broadcast(p.slope[k]) + reach.slope[k];
    d[axis].range = broadcast(p.range) - base + reach.range;
    store(box.d_mid[axis], d[axis].at_mid);
    for (int k = 0; k < N; ++k) store(box.d_slope[k][axis], d[axis].slope[k]);
  }
  store_moment<N>(arm[1], d[2], arm[2], d[1], 3, box);
  store_moment<N>(arm[2], d[0], arm[0], d[2], 4, box);
  store_moment<N>(arm[0], d[1], arm[1], d[0], 5, box);
  const Forms<N> square = sqr(d[0]) + sqr(d[1]) + sqr(d[2]);
  if (!all(square.range.minus_lower < broadcast(0.0))) return Outcome::kFault;
  Forms<N> length = sqrt(square);
  if (any(tighten<N>(length, pose.radius))) return Outcome::kFault;
  store(box.length, length);
  return Outcome::kYes;
}

// ---- The inverse ----------------------------------------------------------------------------------------------------

/// The rows of the identity; beyond it, its first column again.
constexpr Row kUnit[6] = {{{1, 0, 0, 0, 0, 0, 1, 1}}, {{0, 1, 0, 0, 0, 0, 0, 0}}, {{0, 0, 1, 0, 0, 0, 0, 0}},
                          {{0, 0, 0, 1, 0, 0, 0, 0}}, {{0, 0, 0, 0, 1, 0, 0, 0}}, {{0, 0, 0, 0, 0, 1, 0, 0}}};

enum class Entries { kByRows, kByColumns };

/// Gauss-Jordan elimination in place, with partial pivoting, of a matrix by rows, which is lost. @returns whether every
/// pivot is positive in size
template <Entries kEntries>
TAUT_LANES_INLINE bool invert(Row (&a)[6], Row (&inverse)[6]) {
  int order[6] = {0, 1, 2, 3, 4, 5};
  const Lanes zero = broadcast(0.0), one = broadcast(1.0);
#pragma GCC unroll 6
  for (int column = 0; column < 6; ++column) {
    int pivot = column;
    double largest = __builtin_fabs(a[order[column]].x[column]);
    for (int row = column + 1; row < 6; ++row) {
      const double size = __builtin_fabs(a[order[row]].x[column]);
      pivot = size > largest ? row : pivot;
      largest = size > largest ? size : largest;
    }
    if (!(largest > 0)) return false;
    const int chosen = order[pivot];
    order[pivot] = order[column];
    order[column] = chosen;
    const Mask is_column = zero < load(kUnit[column]);
    const Lanes pivot_row = select(is_column, one, load(a[chosen])) * broadcast(1.0 / a[chosen].x[column]);
    for (int row = 0; row < 6; ++row) {
      const Lanes factor = broadcast(a[row].x[column]);
      store(a[row], select(is_column, zero, load(a[row])) - factor * pivot_row);
    }
    store(a[chosen], pivot_row);
  }
  // Column j has become the one of the row that was chosen for it.
  for (int j = 0; j < 6; ++j) {
    const int to = order[j];
    for (int i = 0; i < 6; ++i) {
      (kEntries == Entries::kByRows ? inverse[i].x[to] : inverse[to].x[i]) = a[order[i]].x[j];
    }
  }
  for (int i = 0; i < 6; ++i) {
    for (int lane = 6; lane < kWidth; ++lane) inverse[i].x[lane] = inverse[i].x[0];
  }
  return true;
}

/// Σ_k factor[k] x[k][j]
TAUT_LANES_INLINE Intervals product(const Factors (&factor)[6], const IntervalRow (&x)[6], int j) {
  const auto entry = [&](int k) { return Intervals{broadcast(x[k].minus_lower.x[j]), broadcast(x[k].upper.x[j])}; };
  Intervals sum = factor[0] * entry(0);
  for (int k = 1; k < 6; ++k) sum = sum + factor[k] * entry(k);
  return sum;
}
template <int N>
Outcome precondition(Box<N>& box) {
  Row mid[6];
  for (int i = 0; i < 6; ++i) store(mid[i], midpoint_approx(load(box.d_mid[i])));
  if (!invert<Entries::kByColumns>(mid, box.c)) return Outcome::kNo;
  Factors c[6];
  for (int k = 0; k < 6; ++k) c[k] = factors(load(box.c[k]));
#pragma GCC unroll 1
  for (int j = 0; j < 6; ++j) {
    const Intervals a0 = product(c, box.d_mid, j);
    store(box.a0[j], a0);
    const Lanes diagonal = load(kUnit[j]);
    const Lanes n0 = max(a0.minus_lower + diagonal, a0.upper - diagonal);
    store(box.n0[j], n0);
    Lanes n = n0;
    for (int k = 0; k < N; ++k) {
      const Intervals a1 = product(c, box.d_slope[k], j);
      store(box.a1[k][j], a1);
      const Lanes size = magnitude(a1);
      store(box.a1_size[k][j], size);
      n = n + broadcast(box.radius[k]) * size;
    }
    store(box.n[j], n);
  }
  return Outcome::kYes;
}

/// (b) of inverse_bound.h.
TAUT_LANES_INLINE bool neumann_bound(const Row (&n)[6], Row (&q)[6]) {
  Lanes row_sum = load(n[0]);
  for (int j = 1; j < 6; ++j) row_sum = row_sum + load(n[j]);
  if (!all(row_sum < broadcast(1.0))) return false;
  Row sums;
  store(sums, row_sum);
  double rho = 0;
  for (int i = 0; i < 6; ++i) rho = sums.x[i] > rho ? sums.x[i] : rho;
  const double gap = -(rho - 1.0);  // rounded down
  if (!(0 < gap)) return false;
  const Lanes scaled = row_sum / broadcast(gap);
  for (int j = 0; j < 6; ++j) {
    double most = 0;
    for (int i = 0; i < 6; ++i) most = n[j].x[i] > most ? n[j].x[i] : most;
    store(q[j], load(n[j]) + scaled * broadcast(most));
  }
  return true;
}

template <int N>
Outcome bound_inverse(Box<N>& box) {
  if (!neumann_bound(box.n0, box.q0) || !neumann_bound(box.n, box.q)) return Outcome::kNo;
  return Outcome::kYes;
}

// ---- Tensions -------------------------------------------------------------------------------------------------------

/// Σ_k a[k] b[k], a matrix by columns times a column.
TAUT_LANES_INLINE Lanes product(const Row (&a)[6], const Row& b) {
  Lanes sum = load(a[0]) * broadcast(b.x[0]);
  for (int k = 1; k < 6; ++k) sum = sum + load(a[k]) * broadcast(b.x[k]);
  return sum;
}

/// P x over the box for a column x = C b: (c) of inverse_bound.h. (Of a factor near(k) < 0 the ends of A1 change
/// places.)
template <int N>
[[gnu::noinline]] Forms<N> times(const Box<N>& box, const Intervals& x) {
  const Lanes middle = midpoint_approx(x);
  Row near, size, error;  // |x - near| and |P(m) x - near| <= error, |x| <= size
  store(near, middle);
  store(size, magnitude(x));
  const Lanes mid_error = product(box.q0, size);
  store(error, max(x.minus_lower + middle, x.upper - middle) + mid_error);
  Forms<N> result;
  result.at_mid = widened(x, mid_error);
  Lanes reach = broadcast(0.0);
  for (int n = 0; n < N; ++n) {
    Intervals drift{broadcast(0.0), broadcast(0.0)};
    for (int k = 0; k < 6; ++k) {
      const IntervalRow& a1 = box.a1[n][k];
      const Row* ends[2] = {&a1.minus_lower, &a1.upper};
      const int negative = near.x[k] < 0 ? 1 : 0;
      const Lanes factor = broadcast(__builtin_fabs(near.x[k]));
      drift.minus_lower = drift.minus_lower + factor * load(*ends[negative]);
      drift.upper = drift.upper + factor * load(*ends[1 - negative]);
    }
    const Lanes drift_error = product(box.a1_size[n], error);
    Row drift_size;
    store(drift_size, magnitude(drift) + drift_error);
    const Lanes slope_error = drift_error + product(box.q, drift_size);
    result.slope[n] = {slope_error + drift.upper, slope_error + drift.minus_lower};
    reach = reach + broadcast(box.radius[n]) * magnitude(result.slope[n]);
  }
  result.range = widened(result.at_mid, reach);
  return result;
}

/// C b for a wrench b.
TAUT_LANES_INLINE Intervals loaded(const Factors (&c)[6], const Ends (&b)[6]) {
  Intervals sum = c[0] * broadcast(b[0]);
  for (int l = 1; l < 6; ++l) sum = sum + c[l] * broadcast(b[l]);
  return sum;
}

/// Column j of C L.
TAUT_LANES_INLINE Intervals root_column(const Machine& machine, const Factors (&c)[6], int j) {
  Intervals entry = c[j] * broadcast(machine.root[j][j]);
  if (!machine.is_ellipsoid_diagonal) {
    for (int l = 0; l < j; ++l) entry = entry + c[l] * broadcast(machine.root[l][j]);
  }
  return entry;
}

/// @returns where they are enclosed
template <int N>
TAUT_LANES_INLINE Mask enclose_spread(const Machine& machine, const Factors (&c)[6], const Box<N>& box,
                                      Forms<N>& spread) {
  Forms<N> square;
#pragma GCC unroll 1
  for (int j = 0; j < 6; ++j) {
    const Forms<N> form = times<N>(box, root_column(machine, c, j));
    square = j == 0 ? sqr(form) : square + sqr(form);
  }
  Mask is_void = tighten<N>(square, box.radius);
  const Lanes zero = broadcast(0.0), one = broadcast(1.0);
  const Mask is_positive = square.range.minus_lower < zero;
  // Where a spread may be 0, what follows is not used, and must not raise a fault.
  const auto where_positive = [&](const Intervals& x) {
    return Intervals{select(is_positive, x.minus_lower, -one), select(is_positive, x.upper, one)};
  };
  square.at_mid = where_positive(square.at_mid);
  square.range = where_positive(square.range);
  spread = sqrt(square);
  is_void = is_void | tighten<N>(spread, box.radius);
  return Mask(select(is_void, one, select(is_positive, zero, one)) < one);
}

template <int N>
Outcome enclose_tensions(const Machine& machine, const Ends (&wrench)[6], Box<N>& box) {
  Factors c[6];
  for (int k = 0; k < 6; ++k) c[k] = factors(load(box.c[k]));
  const Forms<N> nominal = times<N>(box, loaded(c, wrench));
  store(box.nominal, nominal);
  const Lanes zero = broadcast(0.0);
  Forms<N> spread;
  spread.at_mid = spread.range = {zero, zero};
  for (int k = 0; k < N; ++k) spread.slope[k] = {zero, zero};
  Mask enclosed = zero < broadcast(1.0);
  if (machine.has_ellipsoid) {
    enclosed = enclose_spread<N>(machine, c, box, spread);
  }
  store(box.spread, spread);
  box.enclosed = bits(enclosed);
  const Forms<N> length = load(box.length);
  Forms<N> low = times_by_positive(length, nominal - spread);
  Forms<N> high = times_by_positive(length, nominal + spread);
  const Mask is_void = tighten<N>(low, box.radius) | tighten<N>(high, box.radius);
  if ((bits(is_void) & box.enclosed) != 0) return Outcome::kFault;
  store(box.low, low);
  store(box.high, high);
  return Outcome::kYes;
}

template <int N>
void compare_work(const Machine& machine, const Ends (&wrench)[6], const Ends (&density)[6], const Box<N>& box,
                  WorkRow& work) {
  Factors c[6];
  for (int k = 0; k < 6; ++k) c[k] = factors(load(box.c[k]));
  const Intervals nominal = loaded(c, wrench);
  Intervals spread{broadcast(0.0), broadcast(0.0)};
  if (machine.has_ellipsoid) {
    Intervals square = sqr(root_column(machine, c, 0));
    for (int j = 1; j < 6; ++j) square = square + sqr(root_column(machine, c, j));
    spread = sqrt(square);
  }
  store(work.least, nominal.upper + spread.minus_lower);
  store(work.greatest, -(nominal.minus_lower + spread.minus_lower));
  Intervals sum{broadcast(0.0), broadcast(0.0)};
  for (int j = 0; j < 6; ++j) {
    Lanes reach = broadcast(box.radius[0]) * load(box.a1_size[0][j]);
    for (int k = 1; k < N; ++k) reach = reach + broadcast(box.radius[k]) * load(box.a1_size[k][j]);
    sum = sum + widened(load(box.a0[j]), reach) * broadcast(density[j]);
  }
  store(work.sum, sum);
}

// ---- The self-test --------------------------------------------------------------------------------------------------

/// volatile: operands are loaded at run time, so that no compiler knows the results.
struct Probe {
  volatile double one = 1.0, three = 3.0, ten = 10.0, tiny = 1e-17, third = 1.0 / 3.0;
};

const char* failed_rounding() {
  Probe p;
  const Lanes one = broadcast(p.one), ten = broadcast(p.ten), tiny = broadcast(p.tiny), third = broadcast(p.third);
  if (!all(one < one + tiny)) return "1 + 1e-17 rounded up exceeds 1 in every lane";
  if (any(-one - tiny < -one)) return "-1 - 1e-17 rounded up is -1 in every lane";
  if (!all(-(-one / ten) < one / ten)) return "1 / 10 differs between the directions in every lane";
  if (!all(-(-third * third) < third * third)) return "(1/3)^2 differs between the directions in every lane";
  constexpr double kBelowRootOfThree = 0x1.bb67ae8584caap+0;  // and the nearest number
  if (!all(broadcast(kBelowRootOfThree) < sqrt(broadcast(p.three)))) return "sqrt 3 is rounded up in every lane";
  return nullptr;
}

void divide(const Row& a, const Row& b, Row& quotient) { store(quotient, load(a) / load(b)); }

template <int N>
constexpr BoxKernel<N> box_kernel_of_level() {
  return {enclose_geometry<N>, precondition<N>, bound_inverse<N>, enclose_tensions<N>, compare_work<N>};
}

}  // namespace
}  // namespace taut::lanes
