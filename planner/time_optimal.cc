// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/time_optimal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinematics/rates_sampler.h"

namespace taut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Corners of the polygon that a limit of a norm becomes: at most 1 − cos(π/32), half a percent, is lost.
constexpr int kCorners = 32;

/// a u + b x + root √x <= c.
struct Row {
  double a, b, c;
  double root = 0;
};

using Vector = Vector3<double>;

/// What is linear in (u, x) at a place: v = of_u u + of_x x.
struct Linear {
  Vector of_u, of_x;
};

/// |of_u u + of_x x| <= limit, in the plane of the two vectors.
void add_norm(const Linear& v, double limit, std::vector<Row>& rows) {
  if (!std::isfinite(limit)) return;
  Vector e1 = v.of_u.norm() > v.of_x.norm() ? v.of_u : v.of_x;
  if (!(e1.norm() > 0)) return;
  e1.normalize();
  const Vector across = (v.of_u - e1 * e1.dot(v.of_u)) + (v.of_x - e1 * e1.dot(v.of_x));
  // What is left of parallel vectors is rounding, in any direction, along e1 as well.
  constexpr double kRounding = 1e-9;
  const bool is_line = !(across.norm() > kRounding * std::min(v.of_u.norm(), v.of_x.norm()));
  const Vector e2 = is_line ? Vector::Zero() : Vector(across.normalized());
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    const Vector direction = std::cos(angle) * e1 + std::sin(angle) * e2;
    rows.push_back({direction.dot(v.of_u), direction.dot(v.of_x), limit * std::cos(std::numbers::pi / kCorners)});
  }
}

void add_magnitude(double of_u, double of_x, double limit, std::vector<Row>& rows) {
  if (!std::isfinite(limit)) return;
  rows.push_back({of_u, of_x, limit});
  rows.push_back({-of_u, -of_x, limit});
}

/// speed² = square x <= limit².
void add_speed(double square, double limit, std::vector<Row>& rows) {
  if (std::isfinite(limit)) rows.push_back({0, square, limit * limit});
}

/// All rows of one place of a path; empty if the path is not feasible there at rest.
class RowsAt {
 public:
  /// @param loss  null: none
  RowsAt(const TimedPathProblem& problem, const PoseSampler& sampler, const PathRates<double>& path,
         const TensionLoss* loss) {
    const TimeLimits& limits = problem.limits;
    const Model<double>& model = sampler.model();
    const Rates<double> by_u = by_time(path, 0.0, 1.0), by_x = by_time(path, 1.0, 0.0);
    const Vector arm = path.r_WP * model.p_PM;
    add_speed((path.p1 + path.w.cross(arm)).squaredNorm(), limits.speed, rows_);
    add_speed(path.w.squaredNorm(), limits.angular_speed, rows_);
    add_norm({acceleration_at(by_u, arm), acceleration_at(by_x, arm)}, limits.acceleration, rows_);
    add_norm({by_u.angular_acceleration, by_x.angular_acceleration}, limits.angular_acceleration, rows_);
    const WinchRates<double> winches_u = winch_rates(model, path.p, path.r_WP, by_u);
    const WinchRates<double> winches_x = winch_rates(model, path.p, path.r_WP, by_x);
    for (std::size_t i = 0; i < kCables; ++i) {
      // L' is L̈ at u = 1, x = 0.
      add_speed(sqr(winches_u.acceleration[i]), limits.winch_speed[i], rows_);
      add_magnitude(winches_u.acceleration[i], winches_x.acceleration[i], limits.winch_acceleration[i], rows_);
    }
    add_tensions(problem, model, path, by_u, by_x, loss);
    for (std::size_t i = 0; i < kCables && is_feasible_; ++i) {
      power_[i] = {std::abs(winches_u.acceleration[i]), limits.winch_power[i]};
      if (!std::isfinite(limits.winch_power[i]) || !(greatest_[i].at_rest > 0)) continue;
      // At rest's tension; what inertia changes is not linear, and left to power_usage().
      add_speed(sqr(winches_u.acceleration[i]), limits.winch_power[i] / greatest_[i].at_rest, rows_);
    }
  }

  /// The largest share of a winch's power that is used, with inertia.
  [[nodiscard]] double power_usage(double rate, double acceleration) const {
    double most = 0;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Greatest& f = greatest_[i];
      const double tension = std::abs(f.at_rest - f.of_u * acceleration - f.of_x * sqr(rate));
      most = std::max(most, tension * power_[i].speed * rate / power_[i].limit);
    }
    return most;
  }

  [[nodiscard]] bool is_feasible_at_rest() const { return is_feasible_; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

 private:
  void add_tensions(const TimedPathProblem& problem, const Model<double>& model, const PathRates<double>& path,
                    const Rates<double>& by_u, const Rates<double>& by_x, const TensionLoss* loss) {
    const Statics<double> at_rest = statics(model, path.p, path.r_WP);
    Matrix6<double> inverse;
    double determinant = 0;
    is_feasible_ =
        at_rest.regular && invert(cable_geometry(model, path.p, path.r_WP).force_density, inverse, determinant);
    if (!is_feasible_) return;
    const Vector6<double> w_u = inertial_wrench(problem.bodies, path.r_WP, by_u);
    const Vector6<double> w_x = inertial_wrench(problem.bodies, path.r_WP, by_x);
    const Vector6<double> u = inverse * w_u, x = inverse * w_x;
    for (std::size_t i = 0; i < kCables; ++i) {
      const auto row = static_cast<int>(i);
      const double of_u = at_rest.length[i] * u(row), of_x = at_rest.length[i] * x(row);
      const double greatest = at_rest.tension[i] + at_rest.tension_above[i];
      const double above_low = at_rest.tension[i] - at_rest.tension_below[i] - model.tension_lower[i];
      const double below_high = model.tension_upper[i] - greatest;
      is_feasible_ = is_feasible_ && above_low > 0 && below_high > 0;
      if (loss == nullptr) {
        rows_.push_back({of_u, of_x, above_low});
        rows_.push_back({-of_u, -of_x, below_high});
      } else {
        const Vector6<double> y = at_rest.length[i] * inverse.row(row).transpose();
        const double turned_u = loss->turn * size_of_product(y, w_u), turned_x = loss->turn * size_of_product(y, w_x);
        for (const double sign : {-1.0, 1.0}) {
          rows_.push_back({of_u + sign * turned_u, of_x + turned_x, left(above_low, loss->newtons[i][0])});
          rows_.push_back({-of_u + sign * turned_u, -of_x + turned_x, left(below_high, loss->newtons[i][1])});
        }
      }
      greatest_[i] = {greatest, of_u, of_x};
    }
  }

  /// The most that y·w can be for turned forces and moments.
  static double size_of_product(const Vector6<double>& y, const Vector6<double>& w) {
    return y.head<3>().norm() * w.head<3>().norm() + y.tail<3>().norm() * w.tail<3>().norm();
  }
  /// What of a slack at rest inertia may take, where deviations may take `lost`. A part is left for the proof, which
  /// bounds what deviations do over boxes; at rest all rows hold.
  static double left(double slack, double lost) {
    constexpr double kUsable = 0.9, kLeast = 1e-6;
    return std::max(kUsable * (slack - lost), kLeast * slack);
  }

  /// A cable's greatest tension over K: at rest, and what inertia takes from it.
  struct Greatest {
    double at_rest = 0, of_u = 0, of_x = 0;
  };
  struct Power {
    double speed = 0;  ///< |L'|
    double limit = kInfinity;
  };

  std::vector<Row> rows_;
  bool is_feasible_ = false;
  std::array<Greatest, kCables> greatest_;
  std::array<Power, kCables> power_;
};

/// By which factor limits are to be used less at s.
double tightening_at(const TimedPathProblem& problem, double s) {
  double factor = 1;
  for (const auto& part : problem.tightened) {
    if (part.from <= s && s <= part.to) factor *= part.factor;
  }
  return factor;
}

/// What deviations take at the place of the grid that is nearest to s.
const TensionLoss* loss_near(const TimedPathProblem& problem, double s) {
  if (problem.tension_loss.empty()) return nullptr;
  const double place = std::round(s * static_cast<double>(problem.grid));
  const auto last = static_cast<double>(problem.tension_loss.size() - 1);
  return &problem.tension_loss[static_cast<std::size_t>(std::clamp(place, 0.0, last))];
}

/// The u that rows leave: empty where lower > upper.
struct Range {
  double lower = -kInfinity, upper = kInfinity;

  /// For the x at a place, `ahead` of which x has become x + 2 ahead u, where the rows hold.
  void narrow(const std::vector<Row>& rows, double share, double x, double ahead) {
    const double rate = std::sqrt(std::max(0.0, x));
    for (const Row& row : rows) {
      const double of_u = row.a + 2 * ahead * row.b, left = share * row.c - row.b * x - row.root * rate;
      if (of_u > 0) {
        upper = std::min(upper, left / of_u);
      } else if (of_u < 0) {
        lower = std::max(lower, left / of_u);
      } else if (left < 0) {
        upper = -kInfinity;
      }
    }
  }
};

/// How fast a path's parameter goes along its arc: s' and s'' by the arc length l.
struct ByArc {
  double first, second;
};

/// Rows in (s̈, ṡ²) as rows in (l̈, l̇²). Where a move may be slowed down, u' from min(s̈, 0) − ṡ slowing to
/// max(s̈, 0) + ṡ slowing, and x' from 0 to ṡ², have to obey the rows, too: as the prover takes them (theory.md, 14c).
std::vector<Row> by_arc(const std::vector<Row>& rows, const ByArc& s, double slowing) {
  std::vector<Row> result;
  for (const Row& row : rows) {
    const Row of_u{row.a * s.first, row.a * s.second, row.c};
    const double of_x = row.b * sqr(s.first);
    if (slowing == 0 || (row.a == 0 && row.b >= 0)) {
      result.push_back({of_u.a, of_u.b + of_x, row.c});
      continue;
    }
    const double root = std::abs(row.a) * s.first * slowing;
    for (const double x : {0.0, of_x}) {
      result.push_back({0, x, row.c, root});
      result.push_back({of_u.a, of_u.b + x, row.c, root});
    }
  }
  return result;
}

/// A part of the path from rest to rest, between which the move is smooth, sampled by its arc length l: that of
/// the load point and, across it, of points as far away as the anchors are, roughly. By l the path has a direction
/// everywhere, where a spline's three equal control points let it rest, too.
class Run {
 public:
  /// @param stands  whether the path itself rests at the begin and at the end, whatever ṡ is
  Run(std::size_t first_segment, std::size_t segments, std::array<bool, 2> stands)
      : first_(first_segment), segments_(segments), stands_(stands) {}

  bool sample(const Path& path, const TimedPathProblem& problem, const PoseSampler& sampler, const RatesSampler& rates,
              std::size_t count) {
    const Vector load_point = sampler.model().p_PM;
    const double reach = sampler.model().characteristic_length;
    const auto rates_at = [&](double s) {
      const std::size_t segment = std::min(static_cast<std::size_t>(s), segments_ - 1);
      return rates.at(path.segment(first_ + segment), s - static_cast<double>(segment));
    };
    const auto speed_at = [&](double s) {
      const PathRates<double> at = rates_at(s);
      return std::hypot((at.p1 + at.w.cross(at.r_WP * load_point)).norm(), at.w.norm() * reach);
    };
    measure(speed_at);
    if (!(length() > 0)) return false;
    std::vector<Vector> curvatures;
    for (std::size_t i = 0; i <= count; ++i) {
      // Close together at the ends, where the speed changes within a short way.
      const double turn = std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
      nodes_.push_back(length() * (1 - std::cos(turn)) / 2);
      places_.push_back(place_at(nodes_[i]));
      // Where the path rests it has no rate. Behind that it is straight for a segment.
      constexpr double kInside = 0.01;
      const double s = std::clamp(places_[i], stands_[0] ? kInside : 0.0,
                                  static_cast<double>(segments_) - (stands_[1] ? kInside : 0.0));
      const PathRates<double> at = rates_at(s);
      const RowsAt rows(problem, sampler, at, loss_near(problem, static_cast<double>(first_) + s));
      if (!rows.is_feasible_at_rest()) return false;
      const Vector arm = at.r_WP * load_point;
      const Vector velocity = at.p1 + at.w.cross(arm);
      const double square = velocity.squaredNorm() + sqr(reach) * at.w.squaredNorm();
      const double change = velocity.dot(acceleration_at(by_time(at, 1.0, 0.0), arm)) + sqr(reach) * at.w.dot(at.w1);
      const ByArc arc{1 / std::sqrt(square), -change / sqr(square)};
      rows_.push_back(by_arc(rows.rows(), arc, problem.slowing));
      curvatures.push_back(acceleration_at(by_time(at, arc.first, arc.second), arm));
      of_point_.push_back(velocity.norm() * arc.first);
    }
    for (std::size_t i = 0; i <= count; ++i) {
      const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, count);
      bends_.push_back((curvatures[after] - curvatures[before]).norm() / (nodes_[after] - nodes_[before]));
    }
    shares_.assign(rows_.size(), 1 - problem.slack);
    for (const auto& [from, to, used] : problem.tightened) {
      for (std::size_t i = 0; i <= count; ++i) {
        const double s = static_cast<double>(first_) + places_[i];
        if (from <= s && s <= to) shares_[i] /= used;
      }
    }
    return true;
  }

  /// Limits l' by what the path's own bends take of a jerk of the load point, |γ'''| l'³.
  void set_jerk(double jerk) {
    if (!std::isfinite(jerk)) return;
    constexpr double kPart = 0.8;
    const auto power = [](double x) { return std::pow(x, 2.0 / 3); };
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].push_back({0, power(bends_[i]), power(kPart * jerk)});
  }

  /// False where nothing bounds the speed.
  bool find_fastest() {
    const std::size_t n = rows_.size() - 1;
    std::vector<double> most(n + 1, 0);
    bool is_bounded = false;
    for (std::size_t i = n; i-- > 1;) {
      most[i] = largest(i, most[i + 1]);
      is_bounded = is_bounded || std::isfinite(most[i]);
    }
    if (!is_bounded) return false;
    // Where nothing bounds it, as fast as beside that.
    for (std::size_t i = 2; i < n; ++i) most[i] = std::isfinite(most[i]) ? most[i] : most[i - 1];
    for (std::size_t i = n - 1; i-- > 1;) most[i] = std::isfinite(most[i]) ? most[i] : most[i + 1];
    x_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
      x_[i + 1] = std::clamp(x_[i] + 2 * step_at(i) * range_from(i, x_[i]).upper, 0.0, most[i + 1]);
    }
    times_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const double sum = std::sqrt(x_[i]) + std::sqrt(x_[i + 1]);
      if (!(sum > 0)) return false;
      times_[i + 1] = times_[i] + 2 * step_at(i) / sum;
    }
    return true;
  }

  [[nodiscard]] double duration() const { return times_.back(); }
  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t segments() const { return segments_; }
  [[nodiscard]] const std::array<bool, 2>& stands() const { return stands_; }

  /// The place on the path, from the run's begin, behind an arc of length l.
  [[nodiscard]] double place_at(double l) const {
    if (l <= 0) return 0;
    if (l >= length()) return static_cast<double>(segments_);
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(arcs_, l) - arcs_.begin());
    const double h = 1.0 / kCells;
    const std::size_t k = next - 1;
    // Hermite's cubic, which rises, as far as speeds differ little.
    double low = 0, high = 1;
    for (int round = 0; round < 52; ++round) {
      const double u = (low + high) / 2;
      const double rise = u * u * (3 - 2 * u);
      const double at =
          arcs_[k] + (arcs_[k + 1] - arcs_[k]) * rise + h * u * (1 - u) * (speeds_[k] * (1 - u) - speeds_[k + 1] * u);
      (at < l ? low : high) = u;
    }
    return (static_cast<double>(k) + low) * h;
  }

  /// How far and how fast the fastest law is at time t, from the run's begin; before and after, it stands.
  [[nodiscard]] double length_at(double t) const {
    if (t <= 0) return 0;
    if (t >= duration()) return length();
    const std::size_t i = node_at(t);
    const double from = std::sqrt(x_[i]), to = std::sqrt(x_[i + 1]);
    const double part = t - times_[i], whole = times_[i + 1] - times_[i];
    return nodes_[i] + part * (from + part * (to - from) / (2 * whole));
  }
  [[nodiscard]] double speed_at(double t) const {
    if (t <= 0 || t >= duration()) return 0;
    const std::size_t i = node_at(t);
    const double from = std::sqrt(x_[i]), to = std::sqrt(x_[i + 1]);
    return from + (t - times_[i]) / (times_[i + 1] - times_[i]) * (to - from);
  }
  /// Where its mean over a window around t is.
  [[nodiscard]] double mean_at(double t, double window) const {
    constexpr int kPoints = 64;
    double sum = 0;
    for (int k = 0; k < kPoints; ++k) sum += length_at(t + window * ((k + 0.5) / kPoints - 0.5));
    return place_at(sum / kPoints);
  }
  /// The largest jerk that the load point has along the path with that mean.
  [[nodiscard]] double jerk_of_mean(double window) const {
    constexpr int kTimes = 1000;
    double most = 0;
    const double h = window / kStepsOfWindow;
    const auto acceleration = [&](double t) { return (speed_at(t + h / 2) - speed_at(t - h / 2)) / h; };
    for (int k = 0; k <= kTimes; ++k) {
      const double t = (duration() + window) * k / kTimes - window / 2;
      const double change = acceleration(t + window / 2) - acceleration(t - window / 2);
      most = std::max(most, std::abs(change) / window * of_point_[node_at(t)]);
    }
    return most;
  }
  /// At place s, from the run's begin, the mean over a window used a limit that much.
  void tighten(double s, double used, double window) {
    const auto place = static_cast<std::size_t>(std::ranges::lower_bound(places_, s) - places_.begin());
    const double t = times_[std::min(place, times_.size() - 1)];
    const std::size_t from = node_at(t - window / 2), to = node_at(t + window / 2) + 1;
    tightened_.resize(rows_.size(), 1);
    for (std::size_t k = from; k <= to; ++k) tightened_[k] = std::max(tightened_[k], used);
  }
  void apply_tightening() {
    for (std::size_t k = 0; k < tightened_.size(); ++k) shares_[k] /= tightened_[k];
    tightened_.clear();
  }

  static constexpr int kStepsOfWindow = 4;  ///< of a law's pieces

 private:
  static constexpr int kCells = 64;  ///< a segment, of the table of arcs

  [[nodiscard]] double length() const { return arcs_.back(); }

  /// To the next node.
  [[nodiscard]] double step_at(std::size_t i) const { return nodes_[i + 1] - nodes_[i]; }

  /// Arcs by s: of a cell by Simpson's rule.
  template <class Speed>
  void measure(const Speed& speed_at) {
    const double h = 1.0 / kCells;
    arcs_ = {0};
    speeds_ = {speed_at(0)};
    for (std::size_t k = 0; k < segments_ * kCells; ++k) {
      const double begin = static_cast<double>(k) * h;
      const double middle = speed_at(begin + h / 2), end = speed_at(begin + h);
      arcs_.push_back(arcs_.back() + h / 6 * (speeds_.back() + 4 * middle + end));
      speeds_.push_back(end);
    }
  }

  /// The last node that the fastest law has reached at t, but for the end.
  [[nodiscard]] std::size_t node_at(double t) const {
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times_, t) - times_.begin());
    return std::clamp<std::size_t>(next, 1, times_.size() - 1) - 1;
  }

  /// Between two nodes u is one, and obeys the rows of both: with those of one alone it would jump from node to node
  /// where a row's a passes 0.
  [[nodiscard]] Range range_from(std::size_t i, double x) const {
    Range range;
    range.narrow(rows_[i], shares_[i], x, 0);
    range.narrow(rows_[i + 1], shares_[i + 1], x, step_at(i));
    return range;
  }

  /// The largest x at place i from which some u leads to at most `next` at the next one. All x from 0 to it do.
  [[nodiscard]] double largest(std::size_t i, double next) const {
    const auto is_possible = [&](double x) {
      Range range = range_from(i, x);
      range.upper = std::min(range.upper, (next - x) / (2 * step_at(i)));
      range.lower = std::max(range.lower, -x / (2 * step_at(i)));
      return range.lower <= range.upper;
    };
    double low = 0, high = 1;
    while (is_possible(high)) {
      low = high;
      high *= 4;
      if (high > 1e12) return kInfinity;
    }
    for (int k = 0; k < 60; ++k) (is_possible((low + high) / 2) ? low : high) = (low + high) / 2;
    return low;
  }

  std::size_t first_, segments_;
  std::array<bool, 2> stands_;
  std::vector<double> arcs_, speeds_;  ///< length and its derivative by s, at ends of cells
  std::vector<double> nodes_;          ///< l
  std::vector<double> places_;         ///< s, by node
  std::vector<double> of_point_;       ///< by how much of the arc the load point moves
  std::vector<double> bends_;          ///< |γ'''| of the load point, by l
  std::vector<std::vector<Row>> rows_;
  std::vector<double> shares_;  ///< of the rows' c, by node
  std::vector<double> x_, times_, tightened_;
};

/// The next multiple of 2^-20 s.
double rounded_up(double seconds) { return std::ldexp(std::ceil(std::ldexp(seconds, 20)), -20); }
/// Sums of such numbers are exact.
double rounded(double s) { return std::ldexp(std::round(std::ldexp(s, 40)), -40); }

/// The runs' laws, smoothed over `window` and joined.
TimeLaw joined(const std::vector<Run>& runs, double window) {
  const double step = rounded_up(window / Run::kStepsOfWindow);
  TimeLaw law{step, {}};
  for (const Run& run : runs) {
    const auto begin = static_cast<double>(run.first()), end = static_cast<double>(run.segments());
    // A mean begins and ends by half a window before and after. Where the law rests, three values are equal; what that
    // cuts off the second one would be a jerk at the third, which 0.4 of a step more avoids.
    constexpr double kLead = 0.4;
    const double before = window / 2 + (run.stands()[0] ? 0 : kLead * step);
    const double duration = run.duration() + before + window / 2 + (run.stands()[1] ? 0 : kLead * step);
    const auto pieces = static_cast<std::size_t>(std::max(4.0, std::ceil(duration / step)));
    const double stretch = duration / (static_cast<double>(pieces) * step);
    std::vector<double> values;
    for (std::size_t k = 0; k <= pieces; ++k) {
      const double t = static_cast<double>(k) * step * stretch - before;
      values.push_back(rounded(std::clamp(run.mean_at(t, window), 0.0, end)));
    }
    values.front() = 0;
    values.back() = end;
    // Where the path does not rest by itself, three equal values: the law does.
    if (!run.stands()[0]) values[1] = 0;
    if (!run.stands()[1]) values[pieces - 1] = end;
    for (std::size_t k = 1; k < values.size(); ++k) values[k] = std::max(values[k], values[k - 1]);
    const double ahead = values[1], behind = end - values[pieces - 1];
    if (law.controls.empty()) law.controls.push_back(begin - ahead);
    for (std::size_t k = law.controls.size() > 1 ? 1 : 0; k <= pieces; ++k) law.controls.push_back(begin + values[k]);
    if (&run == &runs.back()) law.controls.push_back(begin + end + behind);
  }
  return law;
}

/// How long a mean has to be, so that the load point's jerk stays within a limit and a law has few pieces.
double window_within(double jerk, const std::vector<Run>& runs, double duration) {
  // A mean costs its length at each rest: a hundredth of a run. Laws of very many runs have pieces enough.
  constexpr double kWindowsOfARun = 100, kMostWindows = 4000;
  double window = duration / std::min(kWindowsOfARun * static_cast<double>(runs.size()), kMostWindows);
  const auto is_too_short = [&](const Run& run) { return run.jerk_of_mean(window) > jerk; };
  while (window < duration && std::ranges::any_of(runs, is_too_short)) window *= 1.05;
  return window;
}

/// Parts of a path between places where the move has to rest.
std::vector<Run> runs_of(const Path& path) {
  std::vector<Run> runs;
  if (path.interpolation != Interpolation::kCubicBSpline) {
    for (std::size_t k = 0; k < path.segments(); ++k) runs.emplace_back(k, 1, std::array{false, false});
    return runs;
  }
  const auto stands_at = [&](std::size_t k) {
    const auto& points = path.waypoints;
    return points[k] == points[k + 1] && points[k + 1] == points[k + 2];
  };
  std::size_t begin = 0;
  for (std::size_t k = 1; k <= path.segments(); ++k) {
    if (k < path.segments() && !stands_at(k)) continue;
    runs.emplace_back(begin, k - begin, std::array{stands_at(begin), stands_at(k)});
    begin = k;
  }
  return runs;
}

}  // namespace

double usage(const TimedPathProblem& problem, const PoseSampler& sampler, const PathRates<double>& path, double rate,
             double acceleration, double s) {
  const RowsAt all(problem, sampler, path, loss_near(problem, s));
  if (!all.is_feasible_at_rest()) return kInfinity;
  double most = all.power_usage(rate, acceleration);
  for (const Row& row : all.rows()) {
    const double at_full_speed = row.a * acceleration + row.b * sqr(rate);
    const double slowed = std::max(0.0, row.a * acceleration) + std::max(0.0, row.b) * sqr(rate) +
                          std::abs(row.a) * rate * problem.slowing;
    const double used = (problem.slowing > 0 ? slowed : at_full_speed) / row.c;
    most = std::max(most, row.a == 0 ? std::sqrt(std::max(0.0, used)) : used);
  }
  return most;
}

std::optional<TimedMove> time_optimal(const Path& path, const TimedPathProblem& problem) {
  if (path.segments() == 0) return std::nullopt;
  const PoseSampler sampler(problem.problem);
  const RatesSampler rates(problem.problem);
  std::vector<Run> runs = runs_of(path);
  constexpr std::size_t kLeastNodes = 1024;
  TimedMove move;
  for (Run& run : runs) {
    const std::size_t nodes = std::max(problem.grid * run.segments(), kLeastNodes / runs.size());
    if (!run.sample(path, problem, sampler, rates, nodes) || !run.find_fastest()) return std::nullopt;
    move.fastest_s += run.duration();
    run.set_jerk(problem.limits.jerk);
  }
  for (std::size_t tries = 0;; ++tries) {
    double duration = 0;
    for (Run& run : runs) {
      if (!run.find_fastest()) return std::nullopt;
      duration += run.duration();
    }
    const double window = window_within(problem.limits.jerk, runs, duration);
    move.law = joined(runs, window);

    double most = 0, most_jerk = 0;
    std::optional<Vector> before;
    constexpr std::size_t kSamplesOfAPiece = 4, kLeastSamples = 6000;
    const std::size_t samples = std::max(kSamplesOfAPiece * move.law.pieces(), kLeastSamples);
    const double apart = move.law.duration_s() / static_cast<double>(samples);
    for (std::size_t k = 0; k <= samples; ++k) {
      const LawPoint at = at_time(move.law, static_cast<double>(k) * apart);
      const double s = std::clamp(at.s, 0.0, static_cast<double>(path.segments()));
      const std::size_t segment = std::min(static_cast<std::size_t>(s), path.segments() - 1);
      const PathRates<double> by_s = rates.at(path.segment(segment), s - static_cast<double>(segment));
      const double used =
          usage(problem, sampler, by_s, at.rate, at.acceleration, s) * tightening_at(problem, s) / (1 - problem.slack);
      most = std::max(most, used);
      const Vector acceleration =
          acceleration_at(by_time(by_s, at.rate, at.acceleration), Vector(by_s.r_WP * sampler.model().p_PM));
      const double jerk = before ? (acceleration - *before).norm() / apart / problem.limits.jerk : 0;
      before = acceleration;
      most_jerk = std::max(most_jerk, jerk);
      // A jerk goes with the cube of the rate, an acceleration with its square.
      const double excess = std::max(used, std::pow(jerk, 2.0 / 3));
      if (!(excess > 1)) continue;
      const auto run =
          std::ranges::find_if(runs, [&](const Run& part) { return segment < part.first() + part.segments(); });
      run->tighten(s - static_cast<double>(run->first()), excess, window);
    }
    constexpr double kNearEnough = 1.002, kJerkNearEnough = 1.05;
    if ((most <= kNearEnough && most_jerk <= kJerkNearEnough) || tries == problem.most_tries) {
      // Speeds go with the rate, accelerations with its square, jerks with its cube.
      const double of_jerk = std::cbrt(most_jerk / kJerkNearEnough);
      move.law.step_s = rounded_up(move.law.step_s * std::max(most > 1 ? most : std::sqrt(most), of_jerk));
      return move;
    }
    for (Run& run : runs) run.apply_tightening();
  }
}

}  // namespace taut
