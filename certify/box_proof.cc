#include "certify/box_proof.h"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>

#include "kinematics/input_error.h"
#include "kinematics/statics.h"

namespace taut {

const char* name(MarginKind kind) {
  switch (kind) {
    case MarginKind::kTensionMin: return "tension_min";
    case MarginKind::kTensionMax: return "tension_max";
    case MarginKind::kLengthMin: return "length_min";
    case MarginKind::kLengthMax: return "length_max";
  }
  return "?";
}

double DyadicBox::lower() const { return std::ldexp(static_cast<double>(k), -depth); }
double DyadicBox::upper() const { return std::ldexp(static_cast<double>(k + 1), -depth); }
double DyadicBox::mid() const { return std::ldexp(static_cast<double>(2 * k + 1), -depth - 1); }

// ---- Models ----------------------------------------------------------------------------------------------------------

namespace {

constexpr mpfr_prec_t kModelPrecision = 256;

/// Intervals are bounded (interval.h), so a number beyond binary64 is refused here.
Interval outward(const MpInterval& x) {
  const double lower = lower_bound(x);
  const double upper = upper_bound(x);
  if (!std::isfinite(lower) || !std::isfinite(upper)) {
    throw InputError("robot, load: got a number beyond the range of binary64");
  }
  return {lower, upper};
}

template <int Rows, int Columns>
Eigen::Matrix<Interval, Rows, Columns> outward(const Eigen::Matrix<MpInterval, Rows, Columns>& x) {
  Eigen::Matrix<Interval, Rows, Columns> result;
  for (int i = 0; i < Rows; ++i) {
    for (int j = 0; j < Columns; ++j) result(i, j) = outward(x(i, j));
  }
  return result;
}

template <class To, class From>
void outward_all(std::array<To, kCables>& to, const std::array<From, kCables>& from) {
  for (std::size_t i = 0; i < kCables; ++i) to[i] = outward(from[i]);
}

Model<Interval> outward(const Model<MpInterval>& fine) {
  Model<Interval> model;
  outward_all(model.p_WA, fine.p_WA);
  outward_all(model.p_PB, fine.p_PB);
  outward_all(model.p_MB, fine.p_MB);
  model.p_PM = outward(fine.p_PM);
  outward_all(model.tension_lower, fine.tension_lower);
  outward_all(model.tension_upper, fine.tension_upper);
  outward_all(model.length_lower, fine.length_lower);
  outward_all(model.length_upper, fine.length_upper);
  model.wrench = outward(fine.wrench);
  model.ellipsoid = outward(fine.ellipsoid);
  model.ellipsoid_root = outward(fine.ellipsoid_root);
  model.ellipsoid_is_diagonal = fine.ellipsoid_is_diagonal;
  model.characteristic_length = fine.characteristic_length;
  return model;
}

}  // namespace

ProofModel<MpInterval> make_mp_proof_model(const Problem& problem) {
  return {make_model<MpInterval>(problem), Evaluator<Centered<MpInterval>>(pose_tape(problem))};
}

ProofModel<Interval> make_proof_model(const Problem& problem) {
  const PrecisionScope precision(kModelPrecision);
  return {outward(make_model<MpInterval>(problem)), Evaluator<Centered<Interval>>(pose_tape(problem))};
}

// ---- Upper bounds of magnitudes --------------------------------------------------------------------------------------

namespace {

/// A nonnegative number; sums, products and quotients are rounded upward.
template <class I>
struct Scalars;

template <>
struct Scalars<Interval> {
  using Point = double;  ///< entries of C: approximations, but exact numbers once chosen
  using Upper = double;  ///< under run_upward(), plain double arithmetic rounds upward
  static Point point(const Interval& x) { return midpoint_approx(x); }
  static Interval symmetric(Upper radius) { return {-radius, radius}; }
  static Upper one_minus_lower(Upper x) { return -(x - 1.0); }  // rounded down
  static double to_double(Upper x) { return x; }
};

class BigUpper {
 public:
  BigUpper() = default;
  explicit(false) BigUpper(double x) : x_(x) {}
  explicit BigUpper(BigFloat x) : x_(std::move(x)) {}
  friend BigUpper operator+(const BigUpper& a, const BigUpper& b) { return up(mpfr_add, a, b); }
  friend BigUpper operator*(const BigUpper& a, const BigUpper& b) { return up(mpfr_mul, a, b); }
  friend BigUpper operator/(const BigUpper& a, const BigUpper& b) { return up(mpfr_div, a, b); }
  BigUpper& operator+=(const BigUpper& b) { return *this = *this + b; }
  friend bool operator<(const BigUpper& a, const BigUpper& b) { return a.x_ < b.x_; }
  [[nodiscard]] const BigFloat& value() const { return x_; }

 private:
  template <class F>
  static BigUpper up(F function, const BigUpper& a, const BigUpper& b) {
    return BigUpper(BigFloat::apply_rounded(MPFR_RNDU, function, a.x_, b.x_));
  }
  BigFloat x_;
};

template <>
struct Scalars<MpInterval> {
  using Point = BigFloat;
  using Upper = BigUpper;
  static Point point(const MpInterval& x) { return MpfrRounding<BigFloat>::median(x.lower(), x.upper()); }
  static MpInterval symmetric(const Upper& radius) { return {-radius.value(), radius.value()}; }
  static Upper one_minus_lower(const Upper& x) {
    return Upper(BigFloat::apply_rounded(MPFR_RNDD, mpfr_sub, BigFloat(1.0), x.value()));
  }
  static double to_double(const Upper& x) { return x.value().to_double(MPFR_RNDU); }
};

/// Row-major 6x6; plain arrays keep the inner loops visible to the vectoriser.
template <class T>
using Square = std::array<std::array<T, 6>, 6>;

template <class I>
using UpperOf = typename Scalars<I>::Upper;

/// row += factor * other, for an exact factor.
template <class Point, class I>
void add_multiple(std::array<I, 6>& row, const Point& factor, const std::array<I, 6>& other) {
  for (std::size_t j = 0; j < 6; ++j) row[j] = row[j] + factor * other[j];
}

template <class Upper>
Square<Upper> upper_product(const Square<Upper>& a, const Square<Upper>& b) {
  Square<Upper> c;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) c[i][j] = a[i][0] * b[0][j];
    for (std::size_t k = 1; k < 6; ++k) {
      for (std::size_t j = 0; j < 6; ++j) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

/// Q of (b) for N; nothing if ρ < 1 is not certain.
template <class I>
bool neumann_bound(const Square<UpperOf<I>>& n, Square<UpperOf<I>>& q) {
  using Upper = UpperOf<I>;
  std::array<Upper, 6> row_sum;
  std::array<Upper, 6> column_max;
  column_max.fill(Upper(0.0));
  Upper rho(0.0);
  for (std::size_t i = 0; i < 6; ++i) {
    row_sum[i] = Upper(0.0);
    for (std::size_t j = 0; j < 6; ++j) {
      row_sum[i] += n[i][j];
      column_max[j] = std::max(column_max[j], n[i][j]);
    }
    rho = std::max(rho, row_sum[i]);
  }
  if (!(rho < Upper(1.0))) return false;  // also where a NaN slipped in
  const Upper gap = Scalars<I>::one_minus_lower(rho);
  if (!(Upper(0.0) < gap)) return false;
  for (std::size_t i = 0; i < 6; ++i) {
    const Upper scaled = row_sum[i] / gap;
    for (std::size_t j = 0; j < 6; ++j) q[i][j] = n[i][j] + scaled * column_max[j];
  }
  return true;
}

// ---- The segment and the box -----------------------------------------------------------------------------------------

/// λ(t) = (1−t) λ_a + t λ_b over the box, one coordinate.
template <class I>
Centered<I> parameter(const I& start, const I& difference, const I& range, const I& mid) {
  return {start + mid * difference, difference, start + range * difference};
}

template <class I>
I waypoint_coordinate(const Waypoint& w, std::size_t j) {
  I value(w.x[j]);
  if (w.half_turns[j] != 0) value = value + I(static_cast<double>(w.half_turns[j])) * ScalarTraits<I>::pi();
  return value;
}

template <class I>
I coordinate_difference(const Waypoint& a, const Waypoint& b, std::size_t j) {
  I difference = I(b.x[j]) - I(a.x[j]);
  const int half_turns = b.half_turns[j] - a.half_turns[j];
  if (half_turns != 0) difference = difference + I(static_cast<double>(half_turns)) * ScalarTraits<I>::pi();
  return difference;
}

/// Parameters of a space that need no allocation.
constexpr std::size_t kFewParameters = 8;

template <class I>
Pose<Centered<I>> pose_over(const ProofModel<I>& problem, const Waypoint& a, const Waypoint& b, const I& range,
                            const I& mid) {
  boost::container::small_vector<Centered<I>, kFewParameters> parameters;
  for (std::size_t j = 0; j < a.x.size(); ++j) {
    parameters.push_back(parameter(waypoint_coordinate<I>(a, j), coordinate_difference<I>(a, b, j), range, mid));
  }
  return evaluate_pose(problem.pose, std::span<const Centered<I>>(parameters.data(), parameters.size()));
}

}  // namespace

template <class I>
BoxEnclosure<I> enclose_box(const ProofModel<I>& problem, const Waypoint& a, const Waypoint& b, const DyadicBox& box) {
  using Point = typename Scalars<I>::Point;
  using Upper = UpperOf<I>;
  const Model<I>& model = problem.model;
  const double radius = std::ldexp(1.0, -box.depth - 1);

  BoxEnclosure<I> result;
  result.offset = I(-radius, radius);
  const I& offset = result.offset;

  Pose<Centered<I>> pose = pose_over(problem, a, b, I(box.lower(), box.upper()), I(box.mid()));
  Matrix3<Centered<I>> r_WP = rotation(pose.phi, pose.theta, pose.sigma);
  for (int i = 0; i < 3; ++i) {
    pose.p_WP(i).tighten(offset);
    for (int j = 0; j < 3; ++j) r_WP(i, j).tighten(offset);
  }
  const CableGeometry<Centered<I>> geometry = cable_geometry(model, pose.p_WP, r_WP);
  for (std::size_t i = 0; i < kCables; ++i) {
    result.length[i] = length(geometry.p_AB_W[i]);
    result.length[i].tighten(offset);
  }

  // C ≈ D(m)^-1.
  Matrix6<Point> mid;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) mid(i, j) = Scalars<I>::point(geometry.force_density(i, j).at_mid);
  }
  Matrix6<Point> c;
  Point unused_determinant;
  if (!invert(mid, c, unused_determinant)) return result;

  // A0 = C D(m), A1 = C D'(T); N0, N; Q0, Q: (a), (b).
  Square<I> a0;
  Square<I> a1;
  Square<I> d_mid;
  Square<I> d_slope;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      const Centered<I>& entry = geometry.force_density(static_cast<int>(i), static_cast<int>(j));
      d_mid[i][j] = entry.at_mid;
      d_slope[i][j] = entry.slope;
    }
  }
  Square<Upper> n0;
  Square<Upper> n;
  Square<Upper> a1_magnitude;
  for (std::size_t i = 0; i < 6; ++i) {
    a0[i].fill(I(0.0));
    a1[i].fill(I(0.0));
    for (std::size_t k = 0; k < 6; ++k) {
      const Point& factor = c(static_cast<int>(i), static_cast<int>(k));
      add_multiple(a0[i], factor, d_mid[k]);
      add_multiple(a1[i], factor, d_slope[k]);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      n0[i][j] = Upper(magnitude(a0[i][j] - I(i == j ? 1.0 : 0.0)));
      a1_magnitude[i][j] = Upper(magnitude(a1[i][j]));
      n[i][j] = n0[i][j] + Upper(radius) * a1_magnitude[i][j];
    }
  }
  Square<Upper> q0;
  Square<Upper> q;
  if (!neumann_bound<I>(n0, q0) || !neumann_bound<I>(n, q)) return result;

  // W = |A1| Q + Q (|A1| + |A1| Q): (c).
  Square<Upper> w = upper_product(a1_magnitude, q);
  Square<Upper> sum = w;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) sum[i][j] += a1_magnitude[i][j];
  }
  const Square<Upper> second = upper_product(q, sum);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) w[i][j] += second[i][j];
  }

  // Columns: κ = C w0 first, then C L. A column x of C B has value P x at m and slope −(A1 ± W) x.
  std::array<std::array<I, 6>, 7> columns;
  for (std::size_t i = 0; i < 6; ++i) {
    const int row = static_cast<int>(i);
    I kappa(0.0);
    for (int k = 0; k < 6; ++k) kappa = kappa + c(row, k) * model.wrench(k);
    columns[0][i] = kappa;
    for (int j = 0; j < 6; ++j) {
      I entry = c(row, j) * model.ellipsoid_root(j, j);
      if (!model.ellipsoid_is_diagonal) {
        for (int k = 0; k < j; ++k) entry = entry + c(row, k) * model.ellipsoid_root(k, j);
      }
      columns[static_cast<std::size_t>(j) + 1][i] = entry;
    }
  }
  std::array<Centered<I>, 6> squares;
  squares.fill(Centered<I>(0.0));
  for (std::size_t column = 0; column < 7; ++column) {
    const std::array<I, 6>& x = columns[column];
    std::array<Upper, 6> x_magnitude;
    for (std::size_t k = 0; k < 6; ++k) x_magnitude[k] = Upper(magnitude(x[k]));
    for (std::size_t i = 0; i < 6; ++i) {
      I slope(0.0);
      Upper mid_error(0.0);
      Upper slope_error(0.0);
      for (std::size_t k = 0; k < 6; ++k) {
        slope = slope + a1[i][k] * x[k];
        mid_error += q0[i][k] * x_magnitude[k];
        slope_error += w[i][k] * x_magnitude[k];
      }
      Centered<I> value;
      value.at_mid = x[i] + Scalars<I>::symmetric(mid_error);
      value.slope = Scalars<I>::symmetric(slope_error) - slope;
      value.range = value.at_mid + value.slope * offset;
      if (column == 0) {
        result.density[i] = value;
      } else {
        squares[i] = squares[i] + sqr(value);
      }
    }
  }
  for (std::size_t i = 0; i < 6; ++i) {
    squares[i].tighten(offset);
    if (!certainly_positive(squares[i].range)) return result;  // the box is too wide
    result.variation[i] = sqrt(squares[i]);
    result.variation[i].tighten(offset);
  }
  result.regular = true;
  return result;
}

template BoxEnclosure<Interval> enclose_box(const ProofModel<Interval>&, const Waypoint&, const Waypoint&,
                                            const DyadicBox&);
template BoxEnclosure<MpInterval> enclose_box(const ProofModel<MpInterval>&, const Waypoint&, const Waypoint&,
                                              const DyadicBox&);

// ---- Margins ---------------------------------------------------------------------------------------------------------

template <class I>
void length_margins(const Model<I>& model, const BoxEnclosure<I>& box, MarginList<I>& margins) {
  for (int i = 0; i < kCables; ++i) {
    const auto n = static_cast<std::size_t>(i);
    margins.add({MarginKind::kLengthMin, i}, box.length[n] - model.length_lower[n]);
    margins.add({MarginKind::kLengthMax, i}, -box.length[n] + model.length_upper[n]);
  }
}

template <class I>
void tension_margins(const Model<I>& model, const BoxEnclosure<I>& box, MarginList<I>& margins) {
  if (!box.regular) return;
  for (int i = 0; i < kCables; ++i) {
    const auto n = static_cast<std::size_t>(i);
    Centered<I> low = box.length[n] * (box.density[n] - box.variation[n]) - model.tension_lower[n];
    Centered<I> high = -(box.length[n] * (box.density[n] + box.variation[n])) + model.tension_upper[n];
    low.tighten(box.offset);
    high.tighten(box.offset);
    margins.add({MarginKind::kTensionMin, i}, low);
    margins.add({MarginKind::kTensionMax, i}, high);
  }
}

namespace {

bool is_tension(MarginKind kind) { return kind == MarginKind::kTensionMin || kind == MarginKind::kTensionMax; }

/// Half the range between the limits that a margin is measured from, roughly.
template <class I>
double half_range(const Model<I>& model, MarginId id) {
  const auto n = static_cast<std::size_t>(id.cable);
  return is_tension(id.kind) ? 0.5 * (lower_bound(model.tension_upper[n]) - upper_bound(model.tension_lower[n]))
                             : 0.5 * (lower_bound(model.length_upper[n]) - upper_bound(model.length_lower[n]));
}

template <class I>
BoxVerdict judge(const ProofModel<I>& problem, const Waypoint& a, const Waypoint& b, const DyadicBox& box,
                 double clearance) {
  static constexpr std::array<MarginSource<I>, 2> kSources = {length_margins<I>, tension_margins<I>};
  const BoxEnclosure<I> enclosure = enclose_box(problem, a, b, box);
  MarginList<I> margins;
  for (const MarginSource<I> source : kSources) source(problem.model, enclosure, margins);

  BoxVerdict verdict;
  verdict.tension_N = verdict.length_m = verdict.wrench_scale = std::numeric_limits<double>::infinity();
  bool all_positive = true;
  bool midpoint_positive = true;
  bool refuted = false;
  bool too_close = false;
  double lowest = std::numeric_limits<double>::infinity();
  MarginId refuted_id;
  for (const auto& [id, value] : margins) {
    const double bound = lower_bound(value.range);
    const double required =
        clearance > 0 ? clearance * half_range(problem.model, id) : 0.0;  // >= 0: limits are ordered
    if (!(bound > 0 && bound > required)) all_positive = false;
    if (clearance > 0 && upper_bound(value.at_mid) <= required) too_close = true;
    if (!certainly_positive(value.at_mid)) midpoint_positive = false;
    if (!refuted && certainly_nonpositive(value.at_mid)) {
      refuted = true;
      refuted_id = id;
    }
    if (bound < lowest) {
      lowest = bound;
      verdict.worst = id;
    }
    if (is_tension(id.kind)) {
      verdict.tension_N = std::min(verdict.tension_N, bound);
      if (bound > 0) {
        // (f0 − f_lo)/v = 1 + (f0 − v − f_lo)/v, and likewise above.
        const auto n = static_cast<std::size_t>(id.cable);
        const I variation = enclosure.length[n].range * enclosure.variation[n].range;
        const I scale = I(1.0) + value.range / variation;
        verdict.wrench_scale = std::min(verdict.wrench_scale, lower_bound(scale));
      }
    } else {
      verdict.length_m = std::min(verdict.length_m, bound);
    }
  }
  using Kind = BoxVerdict::Kind;
  if (refuted) {
    verdict.kind = Kind::kRefuted;
    verdict.worst = refuted_id;
  } else if (too_close) {
    verdict.kind = Kind::kTooClose;
  } else if (!enclosure.regular) {
    verdict.kind = Kind::kNearSingular;
  } else if (all_positive) {
    verdict.kind = Kind::kProved;
  } else {
    verdict.kind = midpoint_positive ? Kind::kSplit : Kind::kPrecision;
  }
  return verdict;
}

}  // namespace

BoxVerdict judge_box(const ProofModel<Interval>& problem, const Waypoint& a, const Waypoint& b, const DyadicBox& box,
                     double clearance) {
  BoxVerdict verdict;
  if (!run_upward([&] { verdict = judge(problem, a, b, box, clearance); })) verdict.kind = BoxVerdict::Kind::kFault;
  return verdict;
}

BoxVerdict judge_box(const ProofModel<MpInterval>& problem, const Waypoint& a, const Waypoint& b, const DyadicBox& box,
                     double clearance) {
  Faults<MpInterval>::clear();
  BoxVerdict verdict = judge(problem, a, b, box, clearance);
  if (Faults<MpInterval>::raised()) verdict.kind = BoxVerdict::Kind::kFault;
  return verdict;
}

int determinant_sign(const ProofModel<MpInterval>& problem, const Waypoint& a, const Waypoint& b, double s) {
  Faults<MpInterval>::clear();
  const MpInterval point(s);
  const Pose<Centered<MpInterval>> centred = pose_over(problem, a, b, point, point);
  Pose<MpInterval> pose{Vector3<MpInterval>(centred.p_WP(0).at_mid, centred.p_WP(1).at_mid, centred.p_WP(2).at_mid),
                        centred.phi.at_mid, centred.theta.at_mid, centred.sigma.at_mid};
  Matrix6<MpInterval> inverse;
  MpInterval determinant;
  const bool regular = invert(cable_geometry(problem.model, pose).force_density, inverse, determinant);
  if (!regular || Faults<MpInterval>::raised()) return 0;
  if (certainly_positive(determinant)) return 1;
  return certainly_positive(-determinant) ? -1 : 0;
}

}  // namespace taut
