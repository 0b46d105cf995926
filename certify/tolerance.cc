#include "certify/tolerance.h"

#include <algorithm>

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

/// a ± radius in each coordinate.
template <class I>
Vector3<I> widened(const Vector3<Centered<I>>& a, const UpperOf<I>& radius) {
  const I room = Scalars<I>::symmetric(radius);
  return {a(0).range + room, a(1).range + room, a(2).range + room};
}

template <class I>
Vector3<Centered<I>> rotated(const Matrix3<Centered<I>>& r, const Vector3<I>& x) {
  Vector3<Centered<I>> result;
  for (int i = 0; i < 3; ++i) result(i) = r(i, 0) * x(0) + r(i, 1) * x(1) + r(i, 2) * x(2);
  return result;
}

/// Everything on X that (t) is made of.
template <class I>
struct OnAll {
  std::array<Vector3<I>, kCables> d;              ///< d_i
  std::array<Vector3<I>, kCables> reach;          ///< R b_i
  std::array<Vector3<I>, kCables> arm;            ///< R (b_i − p_m)
  std::array<I, kCables> length;                  ///< |d_i|
  std::array<Vector3<I>, kCables> force, moment;  ///< the rows of D^-1: y_r^f, y_r^m
  std::array<I, kCables> density;                 ///< λ_r
  std::array<std::array<I, 6>, kCables> root;     ///< the rows of D^-1 L
};

/// Rows of Y = P C on X, with |P − I| <= Q.
template <class I>
void set_rows(const Matrix6<typename Scalars<I>::Point>& c, const Square<UpperOf<I>>& q, OnAll<I>& x) {
  using Upper = UpperOf<I>;
  Square<Upper> magnitudes;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      magnitudes[i][j] = above(I(c(static_cast<int>(i), static_cast<int>(j))));
    }
  }
  const Square<Upper> error = upper_product(q, magnitudes);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto entry = [&](std::size_t j) {
      return I(c(static_cast<int>(i), static_cast<int>(j))) + Scalars<I>::symmetric(error[i][j]);
    };
    x.force[i] = {entry(0), entry(1), entry(2)};
    x.moment[i] = {entry(3), entry(4), entry(5)};
  }
}

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

/// (t) for the tension bound φ_r = λ_r + sign V_r of cable r.
template <class I>
UpperOf<I> rate(const UndisturbedBox<I>& box, const ToleranceModel<I>& tolerance, const OnAll<I>& x, std::size_t r,
                const std::array<I, kCables>& kappa) {
  using Upper = UpperOf<I>;
  const I& length = x.length[r];
  const I& phi = kappa[r];
  const Vector3<I> pull = scaled(phi / length, x.d[r]);  // φ_r u_r
  Vector3<I> by_position = pull;                         // P_r
  Vector3<I> by_turn = cross(x.reach[r], pull);          // W_r
  Vector3<I> by_load_point(I(0.0), I(0.0), I(0.0));      // M_r
  std::array<Vector3<I>, kCables> by_base;               // A_ri
  std::array<Vector3<I>, kCables> by_platform;           // B_ri
  for (std::size_t i = 0; i < kCables; ++i) {
    const I weight = length * kappa[i];
    const Vector3<I> h = scaled(weight, Vector3<I>(x.force[r] + cross(x.moment[r], x.arm[i])));
    const Vector3<I> twist = scaled(weight, cross(x.d[i], x.moment[r]));
    by_position = by_position - h;
    by_turn = by_turn - cross(x.reach[i], h) - cross(x.arm[i], twist);
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
  Upper bound = tolerance.load_point * norm_above(by_load_point) + above(I(length * by_load)) +
                tolerance.position * norm_above(by_position) + tolerance.orientation * norm_above(by_turn);
  for (std::size_t i = 0; i < kCables; ++i) {
    if (box.held_by_lengths) {
      // c_ri; R_c p_m = R_c b_i − arm_i.
      const Vector3<I> load_point = x.reach[i] - x.arm[i];
      const Vector3<I> velocity = x.force[i] - cross(x.moment[i], load_point);
      const I turned = Scalars<I>::symmetric(tolerance.orientation * norm_above(by_turn) * norm_above(x.moment[i]));
      const I c = dot(by_position, velocity) + dot(by_turn, x.moment[i]) + turned;
      const Vector3<I> along = scaled(c, x.d[i]);
      const Upper size = above(c) * above(x.length[i]);
      by_base[i] = by_base[i] + along;
      by_platform[i] = by_platform[i] - along;
      bound += tolerance.cable_length[i] * size + tolerance.platform_anchor[i] * tolerance.orientation * size;
    }
    bound += tolerance.base_anchor[i] * norm_above(by_base[i]);
    bound += tolerance.platform_anchor[i] * norm_above(by_platform[i]);
  }
  return bound;
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
std::optional<Disturbance<I>> disturbance(const UndisturbedBox<I>& box, const ToleranceModel<I>& tolerance) {
  using Upper = UpperOf<I>;
  const Model<I>& model = box.model;
  const Upper position = box.displacement.position + tolerance.position;  // π
  const Upper angle = box.displacement.angle + tolerance.orientation;     // θ

  // η_i, ζ_i and |C| ΔD.
  OnAll<I> x;
  Disturbance<I> result;
  std::array<Upper, kCables> force_change;
  std::array<Upper, kCables> moment_change;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Upper reach = norm_above(model.p_PB[i]);
    const Upper arm = norm_above(model.p_MB[i]);
    const Upper reach_change = angle * reach + tolerance.platform_anchor[i];
    const Upper arm_change = angle * arm + tolerance.platform_anchor[i] + tolerance.load_point;  // ζ_i
    const Upper change = position + reach_change + tolerance.base_anchor[i];                     // η_i
    const Upper length = above(box.length[i].range);
    force_change[i] = change;
    moment_change[i] = arm_change * length + arm * change + arm_change * change;
    x.reach[i] = widened(rotated(box.motion.r_WP, model.p_PB[i]), reach_change);
    x.arm[i] = widened(rotated(box.motion.r_WP, model.p_MB[i]), arm_change);
    x.d[i] = widened(box.geometry.p_AB_W[i], change);

    const Upper tracking = tolerance.position + tolerance.orientation * (reach + tolerance.platform_anchor[i]);
    result.length[i] = tracking + (box.held_by_lengths ? tolerance.cable_length[i]
                                                       : tolerance.base_anchor[i] + tolerance.platform_anchor[i]);
    x.length[i] = box.length[i].range + Scalars<I>::symmetric(result.length[i]);
    if (!certainly_positive(x.length[i])) return std::nullopt;
  }
  Square<Upper> n;
  for (std::size_t i = 0; i < 6; ++i) {
    Upper forces(0.0);
    Upper moments(0.0);
    for (int k = 0; k < 3; ++k) {
      forces += above(I(box.c(static_cast<int>(i), k)));
      moments += above(I(box.c(static_cast<int>(i), k + 3)));
    }
    for (std::size_t j = 0; j < 6; ++j) {
      n[i][j] = box.n[i][j] + forces * force_change[j] + moments * moment_change[j];
    }
  }
  Square<Upper> q;
  if (!neumann_bound<I>(n, q)) return std::nullopt;
  set_rows(box.c, q, x);
  Vector6<I> wrench;
  for (int k = 0; k < 6; ++k) {
    wrench(k) = model.wrench(k) + Scalars<I>::symmetric(above(tolerance.wrench(k)));
  }
  set_loads(model, wrench, x);

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
    result.tension[r] = {rate(box, tolerance, x, r, low), rate(box, tolerance, x, r, high)};
  }
  return result;
}

template std::optional<ToleranceModel<Interval>> make_tolerance_model(const Problem&);
template std::optional<ToleranceModel<MpInterval>> make_tolerance_model(const Problem&);
template std::optional<Disturbance<Interval>> disturbance(const UndisturbedBox<Interval>&,
                                                          const ToleranceModel<Interval>&);
template std::optional<Disturbance<MpInterval>> disturbance(const UndisturbedBox<MpInterval>&,
                                                            const ToleranceModel<MpInterval>&);

}  // namespace taut
