// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/time_optimal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinematics/path_rates.h"

namespace taut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Corners of the polygon that a limit of a norm becomes: at most 1 − cos(π/32), half a percent, is lost.
constexpr int kCorners = 32;

/// Jerks by how short a part of a move they take to change its acceleration: one that costs nothing, and one that costs
/// little.
constexpr double kVast = 2000, kGentle = 150;

/// a u + b x <= c.
struct Row {
  double a, b, c;
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
  const Vector e2 = across.norm() > 0 ? Vector(across.normalized()) : Vector::Zero();
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
  [[nodiscard]] std::vector<Row> rows() && { return std::move(rows_); }

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

/// The u that rows leave for an x: empty where lower > upper. Where a move may be slowed down, u' and x' with u'
/// between min(u, 0) − √x slowing and max(u, 0) + √x slowing, and x' from 0 to x, have to obey the rows, too.
struct Range {
  double lower = -kInfinity, upper = kInfinity;
};
Range range_of_u(const std::vector<Row>& rows, double share, double x, double slowing) {
  Range range;
  for (const Row& row : rows) {
    const double of_x = slowing > 0 ? std::max(0.0, row.b) * x : row.b * x;
    const double left = share * row.c - of_x - std::abs(row.a) * std::sqrt(std::max(0.0, x)) * slowing;
    if (slowing > 0 && left < 0) return {1, 0};
    if (row.a > 0) {
      range.upper = std::min(range.upper, left / row.a);
    } else if (row.a < 0) {
      range.lower = std::max(range.lower, left / row.a);
    } else if (left < 0) {
      return {1, 0};
    }
  }
  return range;
}

/// A part of the path along which the move is smooth, sampled.
class Run {
 public:
  /// @param rests  at both ends, where it does not end by itself
  Run(std::size_t first_segment, std::size_t segments, bool rests)
      : first_(first_segment), segments_(segments), rests_(rests) {}

  bool sample(const Path& path, const TimedPathProblem& problem, const PoseSampler& sampler,
              const PathRatesModel<double>& rates) {
    const std::size_t count = segments_ * problem.grid;
    step_ = 1.0 / static_cast<double>(problem.grid);
    slowing_ = problem.slowing;
    const Vector load_point = sampler.model().p_PM;
    // Of the load point, and of a point as far away from it as the anchors are, roughly.
    std::vector<std::pair<Vector, Vector>> curvatures;
    const double reach = sampler.model().characteristic_length;
    for (std::size_t i = 0; i <= count; ++i) {
      const std::size_t segment = std::min(i / problem.grid, segments_ - 1);
      const double s = static_cast<double>(i - segment * problem.grid) / static_cast<double>(problem.grid);
      const PathRates<double> at = rates.at(path.segment(first_ + segment), s);
      RowsAt rows(problem, sampler, at, loss_near(problem, static_cast<double>(first_ + segment) + s));
      if (!rows.is_feasible_at_rest()) return false;
      rows_.push_back(std::move(rows).rows());
      const Vector arm = at.r_WP * load_point;
      curvatures.emplace_back(acceleration_at(by_time(at, 1.0, 0.0), arm), at.w1 * reach);
      length_ += step_ * std::hypot((at.p1 + at.w.cross(arm)).norm(), at.w.norm() * reach);
    }
    for (std::size_t i = 0; i <= count; ++i) {
      const auto& before = curvatures[i == 0 ? 0 : i - 1];
      const auto& after = curvatures[std::min(i + 1, count)];
      const double between = step_ * (i == 0 || i == count ? 1 : 2);
      const double of_point = (after.first - before.first).norm() / between;
      bends_.push_back({of_point, std::hypot(of_point, (after.second - before.second).norm() / between)});
    }
    shares_.assign(rows_.size(), 1 - problem.slack);
    for (const auto& [from, to, used] : problem.tightened) {
      const auto begin = static_cast<double>(first_);
      for (std::size_t i = 0; i <= count; ++i) {
        const double s = begin + step_ * static_cast<double>(i);
        if (from - step_ <= s && s <= to + step_) shares_[i] /= used;
      }
    }
    return true;
  }

  /// A move that speeds up and slows down evenly goes length/2 = A (T/2)^2/2: a jerk that changes such an acceleration
  /// within T/k.
  [[nodiscard]] double jerk_of_size(double k) const { return 4 * k * length_ / std::pow(duration(), 3); }

  /// Limits s' by what the path's own bends take of a jerk, |γ'''| s'^3: of the load point `jerk`, and of points around
  /// it `around`.
  void set_jerk(double jerk, double around) {
    constexpr double kPart = 0.8;
    const auto power = [](double x) { return std::pow(x, 2.0 / 3); };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i].resize(rows_[i].size() - bends_[i].rows);
      bends_[i].rows = 0;
      for (const auto& [third, limit] : {std::pair(bends_[i].of_point, jerk), std::pair(bends_[i].around, around)}) {
        if (!std::isfinite(limit)) continue;
        rows_[i].push_back({0, power(third), power(kPart * limit)});
        ++bends_[i].rows;
      }
    }
  }

  /// False where nothing bounds the speed.
  bool find_fastest() {
    const std::size_t n = rows_.size() - 1;
    std::vector<double> most(n + 1);
    bool is_bounded = false;
    for (std::size_t i = n + 1; i-- > 0;) {
      most[i] = rests_ && (i == 0 || i == n) ? 0 : largest(i, i == n ? kInfinity : most[i + 1]);
      is_bounded = is_bounded || (i > 0 && i < n && std::isfinite(most[i]));
      // Where three equal control points stand, a spline rests, whatever ṡ is: within it, as fast as behind that.
      if (!std::isfinite(most[i]) && i > 0 && i < n) most[i] = most[i + 1];
    }
    if (!is_bounded) return false;
    x_.assign(n + 1, std::isfinite(most[0]) ? most[0] : most[1]);
    for (std::size_t i = 0; i < n; ++i) {
      const double u = range_of_u(rows_[i], shares_[i], x_[i], slowing_).upper;
      x_[i + 1] = std::isfinite(most[i + 1]) ? std::clamp(x_[i] + 2 * step_ * u, 0.0, most[i + 1]) : x_[i];
    }
    times_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const double sum = std::sqrt(x_[i]) + std::sqrt(x_[i + 1]);
      if (!(sum > 0)) return false;
      times_[i + 1] = times_[i] + 2 * step_ / sum;
    }
    return true;
  }

  [[nodiscard]] double duration() const { return times_.back(); }
  [[nodiscard]] std::size_t segments() const { return segments_; }
  [[nodiscard]] bool rests() const { return rests_; }

  /// Where the fastest law is at time t, from the run's begin. Before it begins and after it ends it stands, if it
  /// rests there, or goes on as at the end.
  [[nodiscard]] double at(double t) const {
    const auto end = static_cast<double>(segments_);
    if (t <= 0) return rests_ ? 0 : t * std::sqrt(x_.front());
    if (t >= duration()) return rests_ ? end : end + (t - duration()) * std::sqrt(x_.back());
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times_, t) - times_.begin());
    const std::size_t i = next - 1;
    const double from = std::sqrt(x_[i]), to = std::sqrt(x_[i + 1]);
    const double part = t - times_[i], whole = times_[i + 1] - times_[i];
    return step_ * static_cast<double>(i) + part * (from + part * (to - from) / (2 * whole));
  }
  /// Its mean over a window around t.
  [[nodiscard]] double mean_at(double t, double window) const {
    constexpr int kPoints = 64;
    double sum = 0;
    for (int k = 0; k < kPoints; ++k) sum += at(t + window * ((k + 0.5) / kPoints - 0.5));
    return sum / kPoints;
  }
  /// Between two places a limit was used that much.
  void tighten(double s, double used) {
    const auto i =
        static_cast<std::size_t>(std::clamp(std::round(s / step_), 0.0, static_cast<double>(rows_.size() - 1)));
    const std::size_t from = i < kAround ? 0 : i - kAround, to = std::min(i + kAround, rows_.size() - 1);
    for (std::size_t k = from; k <= to; ++k) tightened_.emplace_back(k, used);
  }
  void apply_tightening() {
    std::vector<double> most(rows_.size(), 1);
    for (const auto& [k, used] : tightened_) most[k] = std::max(most[k], used);
    for (std::size_t k = 0; k < most.size(); ++k) shares_[k] /= most[k];
    tightened_.clear();
  }

 private:
  static constexpr std::size_t kAround = 4;

  /// The largest x at place i from which some u leads to at most `next` at the next one. All x from 0 to it do.
  [[nodiscard]] double largest(std::size_t i, double next) const {
    const auto is_possible = [&](double x) {
      Range range = range_of_u(rows_[i], shares_[i], x, slowing_);
      range.upper = std::min(range.upper, (next - x) / (2 * step_));
      range.lower = std::max(range.lower, -x / (2 * step_));
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

  struct Bend {
    double of_point = 0, around = 0;  ///< |γ'''| by s [m]
    std::size_t rows = 0;             ///< that set_jerk() added
  };

  std::size_t first_, segments_;
  bool rests_;
  double step_ = 0, length_ = 0, slowing_ = 0;
  std::vector<Bend> bends_;
  std::vector<std::vector<Row>> rows_;
  std::vector<double> shares_;  ///< of the rows' c, by place
  std::vector<double> x_, times_;
  std::vector<std::pair<std::size_t, double>> tightened_;
};

/// The next multiple of 2^-20 s.
double rounded_up(double seconds) { return std::ldexp(std::ceil(std::ldexp(seconds, 20)), -20); }
/// Sums of such numbers are exact.
double rounded(double s) { return std::ldexp(std::round(std::ldexp(s, 40)), -40); }

/// The runs' laws, smoothed over `window` and joined.
TimeLaw joined(const std::vector<Run>& runs, double window, double step) {
  TimeLaw law{step, {}};
  double begin = 0;
  for (const Run& run : runs) {
    const auto end = static_cast<double>(run.segments());
    // A run that rests is begun and ended by half a window.
    const double before = run.rests() ? window / 2 : 0;
    const auto pieces = static_cast<std::size_t>(std::max(4.0, std::ceil((run.duration() + 2 * before) / step)));
    const double stretch = (run.duration() + 2 * before) / (static_cast<double>(pieces) * step);
    std::vector<double> values;
    for (std::size_t k = 0; k <= pieces; ++k) {
      values.push_back(rounded(
          std::clamp(run.mean_at(static_cast<double>(k) * step * stretch - before, window * stretch), 0.0, end)));
    }
    values.front() = 0;
    values.back() = end;
    for (std::size_t k = 1; k < values.size(); ++k) values[k] = std::max(values[k], values[k - 1]);
    const double ahead = run.rests() ? 0 : values[1], behind = run.rests() ? 0 : end - values[pieces - 1];
    if (run.rests() && values.size() > 2) {
      values[1] = 0;  // three equal values: at rest
      values[pieces - 1] = end;
    }
    if (law.controls.empty()) law.controls.push_back(begin - ahead);
    for (std::size_t k = law.controls.size() > 1 ? 1 : 0; k <= pieces; ++k) law.controls.push_back(begin + values[k]);
    begin += end;
    if (&run == &runs.back()) law.controls.push_back(begin + behind);
  }
  return law;
}

}  // namespace

double usage(const TimedPathProblem& problem, const PoseSampler& sampler, const PathRates<double>& path, double rate,
             double acceleration, double s) {
  RowsAt all(problem, sampler, path, loss_near(problem, s));
  if (!all.is_feasible_at_rest()) return kInfinity;
  double most = all.power_usage(rate, acceleration);
  for (const Row& row : std::move(all).rows()) {
    const double at_full_speed = row.a * acceleration + row.b * sqr(rate);
    const double slowed = std::max(0.0, row.a * acceleration) + std::max(0.0, row.b) * sqr(rate) +
                          std::abs(row.a) * rate * problem.slowing;
    const double used = (problem.slowing > 0 ? slowed : at_full_speed) / row.c;
    most = std::max(most, row.a == 0 ? std::sqrt(std::max(0.0, used)) : used);
  }
  return most;
}

std::optional<TimedMove> time_optimal(const Path& path, const TimedPathProblem& problem) {
  using Rates = PathRatesModel<double>;
  if (!Rates::knows(path.interpolation) || !problem.problem.space.constraints.empty() || path.segments() == 0) {
    return std::nullopt;
  }
  const PoseSampler sampler(problem.problem);
  const Rates rates(problem.problem);
  std::vector<Run> runs;
  if (path.interpolation == Interpolation::kCubicBSpline) {
    runs.emplace_back(0, path.segments(), false);
  } else {
    for (std::size_t k = 0; k < path.segments(); ++k) runs.emplace_back(k, 1, true);
  }
  for (Run& run : runs) {
    if (!run.sample(path, problem, sampler, rates)) return std::nullopt;
  }

  TimedMove move;
  double jerk = 0;
  for (Run& run : runs) {
    if (!run.find_fastest()) return std::nullopt;
    // Where a spline begins and ends, nothing but a jerk bounds the speed by s.
    run.set_jerk(kInfinity, run.jerk_of_size(kVast));
    if (!run.find_fastest()) return std::nullopt;
    move.fastest_s += run.duration();
    jerk = std::max(jerk, run.jerk_of_size(kGentle));
  }
  for (Run& run : runs) run.set_jerk(problem.limits.jerk, jerk);
  for (std::size_t tries = 0;; ++tries) {
    double duration = 0;
    for (Run& run : runs) {
      if (!run.find_fastest()) return std::nullopt;
      duration += run.duration();
    }
    // From one greatest acceleration to the opposite one within the window.
    const TimeLimits& limits = problem.limits;
    const double acceleration = std::min(limits.acceleration, jerk * duration / kGentle);  // that the path makes use of
    const double window = std::max(2 * acceleration / std::min(limits.jerk, jerk), duration / 200);
    move.law = joined(runs, window, rounded_up(window / 4));

    double most = 0;
    std::vector<double> begins = {0};
    for (const Run& run : runs) begins.push_back(begins.back() + static_cast<double>(run.segments()));
    constexpr std::size_t kSamplesOfAPiece = 4, kLeastSamples = 6000;
    const std::size_t samples = std::max(kSamplesOfAPiece * move.law.pieces(), kLeastSamples);
    for (std::size_t k = 0; k <= samples; ++k) {
      const LawPoint at =
          at_time(move.law, move.law.duration_s() * (static_cast<double>(k) / static_cast<double>(samples)));
      const double s = std::clamp(at.s, 0.0, static_cast<double>(path.segments()));
      const std::size_t segment = std::min(static_cast<std::size_t>(s), path.segments() - 1);
      const double used = usage(problem, sampler, rates.at(path.segment(segment), s - static_cast<double>(segment)),
                                at.rate, at.acceleration, s) *
                          tightening_at(problem, s) / (1 - problem.slack);
      most = std::max(most, used);
      if (!(used > 1)) continue;
      const std::size_t n = runs.size() == 1 ? 0 : segment;
      runs[n].tighten(s - begins[n], used);
    }
    if (!(most > 1) || tries == problem.most_tries) {
      // Speeds go with the rate, accelerations with its square.
      move.law.step_s = rounded_up(move.law.step_s * (most > 1 ? most : std::sqrt(most)));
      return move;
    }
    for (Run& run : runs) run.apply_tightening();
  }
}

}  // namespace taut
