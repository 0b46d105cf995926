// SPDX-License-Identifier: GPL-3.0-or-later
// The soundness campaign of moves in time: random machines, loads with mass, segments and laws, half of them with a
// hidden violation, against Newton and Euler at 256 bits (simulation.h).
//
// For each trial one quantity (a tension, a length, a rate of a winch or of the load, a power) is followed along the
// move to its extremum t*; where masses are ranges or the machine may deviate, for bad ones. Its limit is set, as an
// exact decimal of 45 digits, a distance δ from the oracle's value there: inside, a violation that may be as narrow as
// √δ, or outside. All other limits are twice as far away as sampling sees. Then
//   - a segment that is violated there must never be "proved";
//   - a "refuted" must stand up to the oracle at its witness, at the time at which the move is there;
//   - a "proved" must agree with the oracle at t*, at random times with random masses and deviations, and where a
//     search from there ends.
// Some moves are certified and given to the checker (--kernels), which must accept what is certified, and its kernel
// must not prove a box with a violation inside. δ runs over the decades from 1e-13 to 0.1 of the quantity's range. Any
// breach is printed with its seed, and the program exits with 1.
//
// Usage: moves_soundness [COUNT [SEED]] [--threads N] [--kernels N] [--compare N] [--undecided] [--mass-error X]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <ctime>
#include <mutex>
#include <thread>

#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "checker/check.h"
#include "kinematics/time_law.h"
#include "shards/dealing.h"
#include "tests/soundness/deviations.h"
#include "tests/soundness/simulation.h"

namespace taut::campaign {
namespace {

constexpr mpfr_prec_t kBits = 256;
constexpr double kError = 1e-25;  ///< of the oracle, in parts of a quantity's range or size
constexpr int kMoveDecades = 12;  ///< δ/range in [1e-13, 0.1]

struct MoveOptions {
  long count = 2000;
  std::uint64_t seed = 20261128;
  std::uint64_t kernels = 64;  ///< of so many seeds one is certified and given to the checker
  std::uint64_t compare = 64;  ///< of so many seeds one has the oracle held to 400 bits
  bool list_undecided = false;
  double mass_error = 0;  ///< of the oracle, as a share: a mutation, which is to be found out
  int boxes = 1000, multiprecision = 20;
  double budget = 0;  ///< [s]; 0: all seeds
};

using Count = std::atomic<long>;
struct Row {
  Count violated{0}, violated_refuted{0}, clear{0}, clear_proved{0}, clear_refuted{0};
};
enum class Kind { kTension, kLength, kWinchSpeed, kWinchAcceleration, kWinchPower, kLoadRate };
constexpr std::array<const char*, 6> kKindNames = {
    "tensions", "lengths", "speeds of winches", "accelerations of winches", "powers", "rates of the load"};
struct MoveTally {
  /// Of exact machines and loads, and of those with tolerances.
  std::array<std::array<std::array<Row, kMoveDecades>, kKindNames.size()>, 2> rows;
  Count trials{0}, skipped{0}, wrong{0}, proved{0}, refuted{0}, undecided{0}, boxes{0}, multiprecision{0};
  Count deviating{0}, held{0}, held_proved{0}, ranges{0}, slowed{0}, refuted_slowed{0}, refuted_deviating{0};
  Count between_rows{0}, rows_judged{0};
  Count looked_at{0}, judged{0}, compared{0};
  Count refuted_too_fast{0}, refuted_tension{0}, refuted_length{0}, refuted_singular{0};
  Count kernel_boxes{0}, kernel_moves{0}, kernel_proved{0}, kernel_refuted{0}, kernel_not_led{0}, kernel_open{0};
};

Kind kind_of(std::size_t id) {
  if (!is_rate(id)) return is_tension(margin_id(id).kind) ? Kind::kTension : Kind::kLength;
  switch (rate_id(id).kind) {
    case RateKind::kWinchSpeed: return Kind::kWinchSpeed;
    case RateKind::kWinchAcceleration: return Kind::kWinchAcceleration;
    case RateKind::kWinchPower: return Kind::kWinchPower;
    default: return Kind::kLoadRate;
  }
}

// ---- Random moves ---------------------------------------------------------------------------------------------------

/// A load with mass: every weight of the trial, or one that is added to its ellipsoid; half of them with a box.
void choose_masses(Trial& trial, Random& random, bool is_exact) {
  LoadText& load = trial.problem.load;
  if (load.items.empty()) {
    const double mass = std::max(1e-6, std::abs(number<double>(load.wrench[2])) / 9.81) * uniform(random, 0.05, 1);
    const double off = one_in(random, 2) ? 0 : std::pow(10.0, uniform(random, -6, -1));
    const double reach = one_in(random, 2) ? 0 : trial.size * std::pow(10.0, uniform(random, -6, -2));
    const auto at = [&] { return decimal(0.2 * trial.size * uniform(random, -1, 1)); };
    load.gravity_m_s2 = {"0", "0", one_in(random, 2) ? "9.81" : "-9.81"};
    load.items.push_back(
        {"mass", Weight{decimal(mass * (1 - off)), decimal(mass), {at(), at(), at()}, decimal(reach)}});
  }
  for (LoadItem& item : load.items) {
    auto* weight = std::get_if<Weight>(&item.what);
    if (weight == nullptr) continue;
    if (is_exact) {
      weight->mass_lower = weight->mass_upper;
      weight->at_tolerance = "0";
    }
    if (one_in(random, 2)) continue;
    const auto side = [&] { return decimal(trial.size * std::pow(10.0, uniform(random, -3, -0.3))); };
    weight->inertia_box = RationalVector{side(), side(), side()};
  }
}

/// Deviations of anchors, and of tracking or of cable lengths, alone.
void clear_other_tolerances(Trial& trial) {
  if (!trial.problem.tolerances) return;
  if (trial.tolerances != ToleranceKind::kCables) trial.problem.tolerances->cable_length_m.reset();
  trial.problem.tolerances->load_point_m = "0";
  trial.problem.tolerances->wrench.fill("0");
}

/// Through the trial's control points, of one segment or a few.
Path random_path(const Trial& trial, Random& random) {
  const auto& c = trial.controls;
  Path path;
  path.interpolation = trial.interpolation;
  if (trial.law == Law::kStraight) {
    path.waypoints.assign(c.begin(), c.begin() + 2 + static_cast<int>(random() % 3));
  } else if (one_in(random, 2)) {
    path.waypoints.assign(c.begin(), c.end());
  } else {
    path.waypoints = {c[0], c[0], c[0], c[1], c[2], c[3], c[3], c[3]};
  }
  return path;
}

/// With so much as the path of acceleration, about; at rest where a move has to be, or running through its ends.
TimeLaw random_law(const Path& path, double seconds_a_segment, bool rests, Random& random) {
  const auto segments = static_cast<int>(path.segments());
  const bool is_straight = path.interpolation == Interpolation::kStraight;
  const bool is_still_at_ends = path.waypoints.size() == 8;
  const bool rests_at_ends = rests && (!is_still_at_ends || one_in(random, 3));
  const auto dyadic = [](double x) { return std::ldexp(std::round(std::ldexp(x, 40)), -40); };
  const bool is_wild = one_in(random, 3);
  std::vector<double> values;
  for (int k = 0; k < segments; ++k) {
    if (k == 0 || (rests && is_straight)) values.push_back(k);
    const int knots = 1 + static_cast<int>(random() % (segments > 3 ? 5 : 12));
    std::vector<double> inner;
    for (int n = 0; n < knots; ++n) {
      inner.push_back(
          dyadic(k + (is_wild ? uniform(random, 0.01, 0.99) : (n + 1 + uniform(random, -0.4, 0.4)) / (knots + 1))));
    }
    std::ranges::sort(inner);
    values.insert(values.end(), inner.begin(), inner.end());
  }
  values.push_back(segments);
  TimeLaw law;
  for (const double value : values) {
    const bool is_whole = value == std::floor(value);
    const bool is_end = value == 0 || value == segments;
    int copies = 1;
    if (is_whole && (is_end ? rests_at_ends : rests && is_straight)) copies = 3;
    if (!is_whole && one_in(random, 40)) copies = 2 + static_cast<int>(random() % 3);  // 4: it stands still
    law.controls.insert(law.controls.end(), static_cast<std::size_t>(copies), value);
  }
  if (!rests_at_ends) {  // c0 + 4 c1 + c2 is 0 and c1 is, and likewise at the end
    law.controls.insert(law.controls.begin(), -law.controls[1]);
    law.controls.push_back(2.0 * segments - law.controls[law.controls.size() - 2]);
  }
  law.step_s = seconds_a_segment * segments / static_cast<double>(law.pieces());
  return law;
}

Choice random_weights(Random& random, std::size_t count) {
  Choice as{std::vector<WeightAs>(count)};
  for (WeightAs& weight : as.weights) {
    weight.mass = one_in(random, 4) ? uniform(random, 0, 1) : static_cast<double>(random() % 2);
    for (double& x : weight.offset) x = uniform(random, -1, 1);
    scale_to(weight.offset, one_in(random, 4) ? uniform(random, 0, 1) : 1);
  }
  return as;
}

// ---- A trial --------------------------------------------------------------------------------------------------------

class MoveJudge {
 public:
  MoveJudge(std::uint64_t seed, const MoveOptions& options, MoveTally& tally)
      : seed_(seed), options_(options), tally_(tally), random_(seed) {}

  void run() {
    ++tally_.trials;
    make_move();
    try {
      if (!find_extremum() || !set_limit()) {
        ++tally_.skipped;
        return;
      }
    } catch (const NoPose&) {  // and so there is no way to compare
      ++tally_.skipped;
      return;
    }
    const Prover prover(trial_.problem,
                        {.max_boxes = options_.boxes, .max_multiprecision_boxes = options_.multiprecision});
    const SegmentProof proof = prover.prove(path_.segment(segment_));
    tally_.boxes += proof.boxes_judged;
    tally_.multiprecision += proof.boxes_multiprecision;
    Row& row = tally_.rows[is_exact_ ? 0 : 1][static_cast<std::size_t>(kind_of(id_))][decade_];
    ++(violated_ ? row.violated : row.clear);
    switch (proof.verdict) {
      case Verdict::kProved:
        ++tally_.proved;
        if (!violated_) ++row.clear_proved;
        if (trial_.is_held()) ++tally_.held_proved;
        try {
          examine_proof();
        } catch (const NoPose&) {
          breach("proved where the machine finds no pose that it is held at");
        }
        break;
      case Verdict::kRefuted:
        ++tally_.refuted;
        ++(violated_ ? row.violated_refuted : row.clear_refuted);
        examine_witness(*proof.witness);
        break;
      case Verdict::kUndecided:
        ++tally_.undecided;
        if (options_.list_undecided) {
          report(violated_ ? "undecided violation" : "undecided",
                 fmt::format("{} boxes, {} of them in MPFR; from s = {:.6g}, depth {}: {}", proof.boxes_judged,
                             proof.boxes_multiprecision, proof.open_box.lower().approx(), proof.open_box.depth,
                             proof.reason.text()));
        }
        break;
    }
    if (seed_ % options_.compare == 0) hold_to_400_bits();
    if (is_for_kernel_) examine_kernel();
  }

 private:
  void breach(const std::string& what) {
    ++tally_.wrong;
    report("WRONG", what);
  }
  void report(const char* kind, const std::string& what) const {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    fmt::print(stderr, "{}: {} (seed {}, {}, segment {} of {}, tolerances {}, {}, delta {:.3e}, row {}, t* {:.17g})\n",
               kind, what, seed_, kLawNames[static_cast<std::size_t>(trial_.law)], segment_ + 1, path_.segments(),
               kToleranceNames[static_cast<std::size_t>(trial_.tolerances)], quantity_name(id_), delta_, decade_,
               best_t_);
  }

  void make_move() {
    is_for_kernel_ = seed_ % options_.kernels == 0;
    constexpr std::array<ToleranceKind, 4> kDeviating = {ToleranceKind::kAnchors, ToleranceKind::kTracking,
                                                         ToleranceKind::kTogether, ToleranceKind::kCables};
    const ToleranceKind tolerances = one_in(random_, 3) ? kDeviating[random_() % 4] : ToleranceKind::kNone;
    const int tries = is_for_kernel_ ? 100 : 1;
    for (int n = 0; n < tries && (n == 0 || !pulls()); ++n) {
      trial_ = make_trial(random_, one_in(random_, 2) ? Law::kStraight : Law::kSpline, tolerances, {});
      clear_other_tolerances(trial_);
      choose_masses(trial_, random_, one_in(random_, 2));
    }
    TimeText& time = trial_.problem.time.emplace();
    path_ = random_path(trial_, random_);
    const double acceleration = 9.81 * std::pow(10.0, uniform(random_, -3, is_for_kernel_ ? -0.5 : 1));
    path_.timing =
        random_law(path_, std::sqrt(0.15 * trial_.size / acceleration), is_for_kernel_ || one_in(random_, 2), random_);
    if (one_in(random_, 4))
      time.stopping_time_s = decimal(path_.timing->step_s * std::pow(10.0, uniform(random_, -1, 2)));
    if (one_in(random_, 5)) run_straight();
    segment_ = random_() % path_.segments();
    for (std::size_t k = 0; k < path_.segments(); ++k) segments_.push_back(on_segment(k));
    for (std::size_t k = 0; k < path_.segments(); ++k) {
      approx_.emplace_back(segments_[k], *path_.timing, k, options_.mass_error, 3e-3);
    }
    exact_.emplace(segments_[segment_], *path_.timing, segment_, options_.mass_error, oracle::big("1e-20"));
    matters_ = blocks_that_matter(make_tolerances<double>(trial_.problem));
    bool has_ranges = false;
    for (const LoadItem& item : trial_.problem.load.items) {
      const auto* weight = std::get_if<Weight>(&item.what);
      if (weight == nullptr) continue;
      has_ranges = has_ranges || weight->mass_lower != weight->mass_upper || number<double>(weight->at_tolerance) > 0;
    }
    if (has_tolerances()) ++tally_.deviating;
    if (trial_.is_held()) ++tally_.held;
    if (may_stop()) ++tally_.slowed;
    if (has_ranges) ++tally_.ranges;
    is_exact_ = !has_tolerances() && !has_ranges;
  }

  /// Lets lengths run straight between rows. How far these are apart follows from limits: state_step().
  void run_straight() {
    if (!has_tolerances()) trial_.problem.tolerances.emplace();
    RowsText& rows = trial_.problem.time->rows.emplace();
    const double most = trial_.size * std::pow(10.0, uniform(random_, -8, -2.5));
    for (DecimalText& error : rows.error_m) error = decimal(most * uniform(random_, 0.1, 1));
    rows.step_s = "1";
    ++tally_.between_rows;
  }
  /// So far that straight lengths take most of the errors.
  void state_step() {
    TimeText& time = trial_.problem.time.value();
    double step = HUGE_VAL;
    for (std::size_t i = 0; i < kCables; ++i) {
      auto& limit = time.winch_acceleration_m_s2[i];
      const double seen = high_[kMargins + kCables + i];
      if (!limit) limit = decimal(seen > 0 ? 2 * seen : 1.0);
      step = std::min(step, std::sqrt(8 * 0.99 * number<double>(time.rows->error_m[i]) / number<double>(*limit)));
    }
    time.rows->step_s = decimal(step);
  }

  /// Whether all cables are taut at rest where they are looked at: certificates know no others.
  [[nodiscard]] bool pulls() const {
    const Motion<double> motion(trial_);
    for (const double s : {0.0, 0.5, 1.0}) {
      const auto at = motion.statics(s, Deviation());
      if (!at || !(std::ranges::min(at->tension_low) > 0)) return false;
    }
    return true;
  }

  /// The trial with the control points of a segment.
  [[nodiscard]] Trial on_segment(std::size_t k) const {
    Trial result = trial_;
    const Segment segment = path_.segment(k);
    for (std::size_t i = 0; i < segment.controls().size(); ++i) result.controls[i] = *segment.control[i];
    return result;
  }

  [[nodiscard]] bool has_rows() const { return trial_.problem.time->rows.has_value(); }
  [[nodiscard]] bool has_tolerances() const { return trial_.problem.tolerances.has_value(); }
  [[nodiscard]] const Simulation<double>& approx() const { return approx_[segment_]; }
  [[nodiscard]] Deviation some_deviation() { return has_tolerances() ? random_deviation(random_) : Deviation(); }
  [[nodiscard]] bool may_stop() const { return trial_.problem.time->stopping_time_s.has_value(); }
  [[nodiscard]] Choice some_choice() {
    Choice as = random_weights(random_, exact_->bodies().size());
    if (!may_stop() || one_in(random_, 3)) return as;
    as.share = one_in(random_, 4) ? uniform(random_, 0, 1) : static_cast<double>(random_() % 2);
    as.change = one_in(random_, 4) ? uniform(random_, -1, 1) : one_in(random_, 2) ? -1 : 1;
    return as;
  }

  /// What is sought to be least.
  [[nodiscard]] double objective(double t, const Deviation& x, const Choice& as, std::size_t id) const {
    const double value = approx().quantity(t, x, as, id);
    return is_upper(id) ? -value : value;
  }
  [[nodiscard]] BigFloat exact_objective(double t) const {
    const BigFloat value = exact_->quantity(BigFloat(t), worst_, choice_, id_);
    return is_upper(id_) ? -value : value;
  }
  [[nodiscard]] Deviation worst_deviation(double t, const Deviation& x, const Choice& as, std::size_t id) const {
    return worst_deviations<1>(x, matters_, [&](const Deviation& y) { return std::array{objective(t, y, as, id)}; })[0];
  }

  /// Times between which the move is on a segment, and between them all knots and some times more.
  [[nodiscard]] std::vector<double> times(std::size_t segment, int between) const {
    const double begin = approx_[segment].time(0, 60), end = approx_[segment].time(1, 60);
    std::vector<double> result = {begin};
    for (std::size_t k = 0; k <= path_.timing->pieces(); ++k) {
      const double knot = static_cast<double>(k) * path_.timing->step_s;
      if (knot > begin && knot < end) result.push_back(knot);
    }
    result.push_back(end);
    std::vector<double> all;
    for (std::size_t k = 0; k + 1 < result.size(); ++k) {
      for (int n = 0; n < between; ++n) all.push_back(result[k] + (result[k + 1] - result[k]) * n / between);
    }
    all.push_back(end);
    return all;
  }

  void include(const Simulation<double>::All& all) {
    for (std::size_t id = 0; id < kQuantities; ++id) {
      low_[id] = std::min(low_[id], all.value[id]);
      high_[id] = std::max(high_[id], all.value[id]);
    }
  }

  /// t*, and what is bad there, in floating point; and the ranges of all quantities.
  bool find_extremum() {
    low_.fill(HUGE_VAL);
    high_.fill(-HUGE_VAL);
    const std::uint64_t drawn = random_() % 20;
    id_ = drawn < 9    ? random_() % (2 * kCables)
          : drawn < 10 ? 2 * kCables + random_() % (2 * kCables)
                       : kMargins + random_() % kRates;
    choice_ = some_choice();
    for (std::size_t k = 0; k < path_.segments(); ++k) {
      if (k == segment_) continue;
      for (const double t : times(k, 2)) include(approx_[k].quantities(t, {}, choice_));
    }
    const std::vector<double> samples = times(segment_, 5);
    double least = HUGE_VAL, determinant = 0;
    std::size_t best = 0;
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const auto all = approx().quantities(samples[n], {}, choice_);
      if (!std::isfinite(all.determinant) || !(determinant * all.determinant >= 0) || all.determinant == 0) {
        return false;
      }
      determinant = all.determinant;
      include(all);
      const double value = is_upper(id_) ? -all.value[id_] : all.value[id_];
      if (value < least) {
        least = value;
        best = n;
      }
    }
    begin_ = samples.front();
    end_ = samples.back();
    best_t_ = samples[best];
    const double from = samples[best == 0 ? 0 : best - 1], to = samples[std::min(best + 1, samples.size() - 1)];
    for (int round = 0; round < (is_exact_ ? 1 : 2); ++round) {
      const double t = golden_section([&](double x) { return objective(x, worst_, choice_, id_); }, from, to);
      if (objective(t, worst_, choice_, id_) < objective(best_t_, worst_, choice_, id_)) best_t_ = t;
      if (is_exact_) break;
      constexpr int kTries = 12;
      for (int n = 0; n < kTries; ++n) {
        const Choice other = some_choice();
        if (objective(best_t_, worst_, other, id_) < objective(best_t_, worst_, choice_, id_)) choice_ = other;
      }
      if (!has_tolerances()) continue;
      for (int k = 0; k < 2; ++k) worst_ = worst_deviation(best_t_, worst_, choice_, id_);
      const auto all = approx().quantities(best_t_, worst_, choice_);
      if (!(determinant * all.determinant > 0)) return false;
      include(all);
    }
    // Floating point sees differences to some 1e-7 only; parabolas of the oracle's values find the place.
    for (const double part : {1e-2, 1e-4, 1e-6}) {
      const double e = part * (to - from);
      if (!(best_t_ - e > from) || !(best_t_ + e < to)) break;
      const BigFloat a = exact_objective(best_t_ - e), b = exact_objective(best_t_), c = exact_objective(best_t_ + e);
      const double curvature = BigFloat(a - b - (b - c)).to_double(), slope = BigFloat(a - c).to_double();
      double t = best_t_;
      if (c < b && c < a) t = best_t_ + e;
      if (a < b && a < c) t = best_t_ - e;
      if (curvature > 0) t = best_t_ + std::clamp(0.5 * slope / curvature, -1.0, 1.0) * e;
      if (exact_objective(t) < b) best_t_ = t;
    }
    for (int n = 1; n < 8; ++n) {  // in [0, 1] beyond doubt
      const BigFloat s = exact_->place(BigFloat(best_t_));
      if (s >= BigFloat(0.0) && s <= BigFloat(1.0)) break;
      best_t_ += (s < BigFloat(0.0) ? 1e-15 : -1e-15) * std::pow(10.0, n) * (end_ - begin_);
      if (n == 7) return false;
    }
    positive_ = determinant > 0;
    return true;
  }

  /// All limits loose, then one of them δ inside or outside the oracle's value at t*.
  bool set_limit() {
    const double tension_low = *std::min_element(low_.begin(), low_.begin() + 2 * kCables);
    const double tension_high = *std::max_element(high_.begin(), high_.begin() + 2 * kCables);
    const double length_low = *std::min_element(low_.begin() + 2 * kCables, low_.begin() + kMargins);
    const double length_high = *std::max_element(high_.begin() + 2 * kCables, high_.begin() + kMargins);
    const double width = tension_high - tension_low;
    for (const double value : low_) {
      if (!std::isfinite(value)) return false;
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      trial_.problem.robot.tension_N[i] = {decimal(tension_low - width), decimal(tension_high + width)};
      // Certificates know no lower limit below 0.
      if (is_for_kernel_ && tension_low > 0) trial_.problem.robot.tension_N[i].lower = decimal(0.01 * tension_low);
      trial_.problem.robot.length_m[i] = {decimal(0.5 * length_low), decimal(2 * length_high)};
    }
    TimeText& time = trial_.problem.time.value();
    for (std::size_t id = kMargins; id < kQuantities; ++id) {
      if (one_in(random_, 2) && high_[id] > 0) rate_limit(time, rate_id(id)) = decimal(2 * high_[id]);
    }
    range_ = is_rate(id_) ? high_[id_] : is_tension(margin_id(id_).kind) ? width : length_high - 0.99 * length_low;
    if (!(range_ > 0)) return false;
    // Enclosures of inertia narrow in proportion to boxes only, so that of what is nearer than 1e-6 little is decided.
    decade_ = one_in(random_, 2) ? kMoveDecades - 1 - random_() % 5 : random_() % kMoveDecades;
    delta_ = range_ * std::pow(10.0, -13.0 + static_cast<double>(decade_) + uniform(random_, 0, 1));
    violated_ = one_in(random_, 2);
    const BigFloat extremum = exact_->quantity(BigFloat(best_t_), worst_, choice_, id_);
    const DecimalText text = decimal(extremum + BigFloat(violated_ == is_upper(id_) ? -delta_ : delta_));
    if (is_rate(id_)) {
      if (text.starts_with('-')) return false;
      rate_limit(time, rate_id(id_)) = text;
    } else {
      limit(trial_.problem, margin_id(id_)) = text;
    }
    if (has_rows()) state_step();
    approx_limits_.emplace(trial_.problem);
    exact_limits_.emplace(trial_.problem);
    const bool is_within = exact_limits_->margin(extremum, id_) > BigFloat(0.0);
    if (violated_ == is_within) breach("the trial does not violate what it should, or does");
    return true;
  }

  // ---- What is said of it -------------------------------------------------------------------------------------------

  /// The least margin in floating point, in parts of its range; where it is little, the point is judged.
  double look_at(double t, const Deviation& x, const Choice& as, std::size_t& least_id) {
    constexpr double kLittle = 1e-5;
    const auto all = approx().quantities(t, x, as);
    double least = HUGE_VAL;
    for (std::size_t id = 0; id < kQuantities; ++id) {
      const double size = is_rate(id) ? high_[id] : high_[id] - low_[id] + 0.01 * std::abs(high_[id]);
      const double margin = approx_limits_->margin(all.value[id], id) / size;
      if (margin < least || std::isnan(margin)) {
        least = std::isnan(margin) ? 0 : margin;
        least_id = id;
      }
    }
    if (least < kLittle) require_feasible(t, x, as, "where floating point says little");
    return least;
  }

  /// Of a machine whose lengths run straight between two rows of the segment, as near together as these have to be and
  /// as far off as they may be, at a random time between them.
  void examine_rows() {
    const Tolerances<BigFloat> within = make_tolerances<BigFloat>(trial_.problem);
    const BigFloat step = number<BigFloat>(trial_.problem.time->rows->step_s);
    const double t = uniform(random_, begin_, end_);
    const double apart = to_double(step) * (one_in(random_, 3) ? uniform(random_, 0, 1) : 1 - 1e-12);
    double before = t - apart * uniform(random_, 0, 1);
    double after = before + apart;
    before = std::max(before, begin_);
    after = std::min(after, end_);
    if (!(before < t && t < after)) return;
    const auto lengths_at = [&](double time) {
      return lengths(exact_->motion().machine({}), exact_->motion().reference(exact_->place(BigFloat(time))));
    };
    const Six<BigFloat> first = lengths_at(before), now = lengths_at(t), last = lengths_at(after);
    const BigFloat share = (BigFloat(t) - BigFloat(before)) / (BigFloat(after) - BigFloat(before));
    Deviation x = some_deviation();
    for (std::size_t i = 0; i < kCables; ++i) {
      const BigFloat limit = number<BigFloat>(*trial_.problem.time->winch_acceleration_m_s2[i]);
      const BigFloat rounding = within.rows[i] - limit * step * step / BigFloat(8.0);
      const BigFloat off = rounding * BigFloat(one_in(random_, 2) ? 1.0 : -1.0);
      const BigFloat straight = first[i] + share * (last[i] - first[i]) + off - now[i];
      if (magnitude(straight) > within.rows[i]) breach("straight lengths are farther off than their rows allow");
      x.length[i] = to_double((straight + within.held[i] * BigFloat(x.length[i])) / within.length[i]);
    }
    require_feasible(t, x, some_choice(), "where lengths run straight between rows");
    ++tally_.rows_judged;
  }

  void require_feasible(double t, const Deviation& x, const Choice& as, const char* where) {
    const BigFloat time(t), s = exact_->place(time);
    if (s < BigFloat(0.0) || s > BigFloat(1.0)) return;  // by rounding at an end
    ++tally_.judged;
    const auto all = exact_->quantities(time, x, as);
    for (std::size_t id = 0; id < kQuantities; ++id) {
      if (exact_limits_->margin(all.value[id], id) > -tolerance(id)) continue;
      breach(fmt::format("proved, but {} is violated by {:.3e} {} (t {:.17g})", quantity_name(id),
                         -to_double(exact_limits_->margin(all.value[id], id)), where, t));
    }
    if ((all.determinant > BigFloat(0.0)) != positive_) breach(fmt::format("proved, but singular {}", where));
  }
  [[nodiscard]] BigFloat tolerance(std::size_t id) const {
    constexpr double kLeastSpeed = 1e-8;  // of a path that stays where it is, rates are 0
    double least = kLeastSpeed;
    if (is_power(id)) {  // tensions times such a speed
      for (std::size_t k = 0; k < 2 * kCables; ++k) least = std::max(least, kLeastSpeed * std::abs(high_[k]));
    }
    return BigFloat(kError) * BigFloat(std::max({std::abs(low_[id]), std::abs(high_[id]), least}));
  }

  void examine_proof() {
    if (violated_) return breach("proved, but violated at t*");
    constexpr int kTimes = 32;
    double least = HUGE_VAL, least_t = best_t_;
    std::size_t id = id_;
    Deviation x = worst_;
    Choice as = choice_;
    for (int k = 0; k < kTimes; ++k) {
      ++tally_.looked_at;
      // Every fourth is near t*.
      const double t = k % 4 == 0 ? best_t_ + (end_ - begin_) * std::pow(10.0, uniform(random_, -8, -1)) *
                                                  (one_in(random_, 2) ? 1 : -1)
                                  : uniform(random_, begin_, end_);
      if (!(t > begin_ && t < end_)) continue;
      const Deviation other = some_deviation();
      const Choice choice = some_choice();
      std::size_t here = id;
      const double margin = look_at(t, other, choice, here);
      if (margin < least) {
        least = margin;
        least_t = t;
        id = here;
        x = other;
        as = choice;
      }
      if (k == 1) require_feasible(t, other, choice, "at a random time");
    }
    if (has_rows()) examine_rows();
    // Downhill from the least of them, in time and deviation.
    for (int round = 0; round < 2; ++round) {
      if (has_tolerances()) x = worst_deviation(least_t, x, as, id);
      const double away = 0.1 * (end_ - begin_);
      least_t = golden_section([&](double t) { return objective(t, x, as, id); }, std::max(begin_, least_t - away),
                               std::min(end_, least_t + away));
    }
    require_feasible(least_t, x, as, "where a search ended");
    require_feasible(best_t_, worst_, some_choice(), "at t* with other masses");
  }

  static BigFloat number_of(const Dyadic& s) { return enclose<MpInterval>(s).lower(); }

  void examine_witness(const SegmentWitness& witness) {
    if (witness.singular) {
      ++tally_.refuted_singular;
      const auto determinant_at = [&](const Dyadic& s) {
        return determinant(exact_->motion().machine({}), exact_->motion().reference(number_of(s)));
      };
      if (!(determinant_at(witness.box.lower()) * determinant_at(witness.box.upper()) < BigFloat(0.0))) {
        breach("refuted by a singular pose that is not there");
      }
      return;
    }
    if (witness.contact) return breach("refuted by bodies that are not there");
    std::size_t id = 0;
    while (id < kQuantities && !(is_rate(id) ? witness.rate && rate_id(id) == *witness.rate
                                             : !witness.rate && margin_id(id) == witness.margin)) {
      ++id;
    }
    if (id == kQuantities) return breach("refuted by what is no limit");
    ++(is_rate(id) ? tally_.refuted_too_fast : id < 2 * kCables ? tally_.refuted_tension : tally_.refuted_length);
    if (is_rate(id) && !rate_limit(trial_.problem.time.value(), rate_id(id))) {
      return breach("refuted by what is not limited");
    }
    constexpr int kHalvings = 2 * static_cast<int>(kBits);
    const BigFloat s = number_of(witness.box.mid());
    Choice as;
    if (const auto& slowing = witness.slowing) {
      if (!may_stop()) breach("refuted where it is slowed down, which it may not be");
      as.share = number<double>(slowing->speed);  // exact
      as.change = slowing->change;
      ++tally_.refuted_slowed;
    }
    if (witness.deviation) ++tally_.refuted_deviating;
    const Instant<BigFloat> commanded = exact_->at(exact_->time(s, kHalvings), as);
    if (witness.deviation && !exact_->motion().is_within(*witness.deviation)) {
      breach("refuted by what is beyond the tolerances");
    }
    // The prover's enclosure is of all masses that the load may have: each of them has to do.
    for (int k = 0; k < 3; ++k) {
      as.weights = some_choice().weights;
      const auto typed = witness.deviation ? exact_->motion().witnessed(s, *witness.deviation)
                                           : MachineAt<BigFloat>{exact_->motion().machine({}), commanded.pose};
      if (!typed) return breach("refuted where there is no pose");
      const BigFloat value = exact_->quantity(commanded, exact_->with_inertia(*typed, commanded, as), id);
      const BigFloat margin = exact_limits_->margin(value, id);
      if (margin > tolerance(id)) {
        return breach(fmt::format("refuted by a false witness: {}, margin {:.3e}, s {:.17g}", quantity_name(id),
                                  to_double(margin), to_double(s)));
      }
    }
  }

  /// All quantities at t*, with an error below a tenth of what is tolerated.
  void hold_to_400_bits() {
    const auto mine = exact_->quantities(BigFloat(best_t_), worst_, choice_);
    const PrecisionScope precision(400);
    const Simulation<BigFloat> finer(segments_[segment_], *path_.timing, segment_, options_.mass_error,
                                     oracle::big("1e-40"));
    const auto all = finer.quantities(BigFloat(best_t_), worst_, choice_);
    for (std::size_t id = 0; id < kQuantities; ++id) {
      ++tally_.compared;
      if (abs(all.value[id] - mine.value[id]) > BigFloat(0.1) * tolerance(id)) {
        breach(fmt::format("the oracle's error of {} is {:.3e}", quantity_name(id),
                           to_double(all.value[id] - mine.value[id])));
      }
    }
  }

  // ---- The checker --------------------------------------------------------------------------------------------------

  /// A problem that a certificate can state, with the ends that the path passes as its query; nothing where limits are
  /// negative.
  [[nodiscard]] std::optional<Problem> certifiable() const {
    Problem problem = trial_.problem;
    for (auto& limits : problem.robot.tension_N) {
      if (limits.lower.front() == '-') limits.lower = "0";
      if (limits.upper.front() == '-') return std::nullopt;
    }
    const auto typed = [](const Waypoint& waypoint) {
      std::vector<ExpressionText> result;
      for (const double x : waypoint.parameters().x) result.push_back(fmt::format("{:.17g}", x));
      return result;
    };
    problem.query.clear();
    const bool passes_its_ends = path_.waypoints.size() != control_points(Interpolation::kCubicBSpline) ||
                                 path_.interpolation == Interpolation::kStraight;
    if (passes_its_ends) problem.query = {typed(path_.waypoints.front()), typed(path_.waypoints.back())};
    bool has_limit = false;
    for (std::size_t id = kMargins; id < kQuantities; ++id) {
      has_limit = has_limit || rate_limit(problem.time.value(), rate_id(id));
    }
    if (!has_limit) problem.time->load_speed_m_s = "1e9";
    try {
      validate(problem);
    } catch (const InputError&) {
      return std::nullopt;
    }
    return problem;
  }

  /// What is certified has to be accepted, and no box be proved in which a limit is broken.
  void examine_kernel() {
    const std::optional<Problem> problem = certifiable();
    if (!problem) return;
    if (violated_) {
      const Elaborator elaborator(*problem, path_.interpolation);
      const double s = to_double(exact_->place(BigFloat(best_t_)));
      constexpr int kBoxes = 6;
      for (int k = 0; k < kBoxes; ++k) {
        const int depth = static_cast<int>(random_() % 40);
        const auto all = static_cast<std::uint64_t>(1) << static_cast<unsigned>(depth);
        const auto at = static_cast<std::uint64_t>(s * static_cast<double>(all));
        constexpr std::array<int, 4> kPrecisions = {32, 64, 128, 256};
        const DyadicBox box{std::min(at, all - 1), depth};
        if (s - box.lower().approx() < 1e-14 || box.upper().approx() - s < 1e-14) continue;
        ++tally_.kernel_boxes;
        const int parts = has_tolerances() ? 1 << (random_() % 5) : 1;
        if (elaborator.one_box(path_.segment(segment_), box, kPrecisions[random_() % 4], parts)) {
          breach(fmt::format("the kernel proves a box of depth {} in which a limit is broken", depth));
        }
      }
    }
    const Prover prover(*problem, {.max_boxes = options_.boxes, .max_multiprecision_boxes = options_.multiprecision});
    const PathProof proof = prove_path(prover, path_);
    if (violated_ && proof.verdict == Verdict::kProved) breach("the path is proved, but violated at t*");
    ++tally_.kernel_moves;
    if (proof.verdict == Verdict::kUndecided) {
      ++tally_.kernel_open;
      return;
    }
    const Certificate certificate = elaborate(*problem, path_, proof);
    if (certificate.verdict == Verdict::kUndecided) {
      ++tally_.kernel_not_led;
      if (options_.list_undecided) report("not led to confirm", name(proof.verdict));
      return;
    }
    if (certificate.verdict != proof.verdict) breach("certified is another verdict than what was found");
    const checker::CheckResult result = checker::check(certificate_text(certificate), {.threads = 1});
    ++(certificate.verdict == Verdict::kProved ? tally_.kernel_proved : tally_.kernel_refuted);
    if (result.outcome != checker::Outcome::kAccepted) {
      breach(fmt::format("{} is {}: {}", name(certificate.verdict), checker::name(result.outcome), result.message));
    }
  }

  std::uint64_t seed_;
  const MoveOptions& options_;
  MoveTally& tally_;
  Random random_;
  Trial trial_;
  Path path_;
  std::size_t segment_ = 0;
  std::vector<Trial> segments_;  ///< the trial on each segment; their limits are not set
  std::vector<Simulation<double>> approx_;
  std::optional<Simulation<BigFloat>> exact_;
  std::vector<bool> matters_;
  std::optional<AllLimits<double>> approx_limits_;
  std::optional<AllLimits<BigFloat>> exact_limits_;
  std::array<double, kQuantities> low_{}, high_{};  ///< as far as was seen
  std::size_t id_ = 0;
  double begin_ = 0, end_ = 0, best_t_ = 0;
  Deviation worst_;
  Choice choice_;
  bool is_exact_ = false, is_for_kernel_ = false, violated_ = false, positive_ = false;
  std::size_t decade_ = 0;
  double delta_ = 0, range_ = 0;
};

// ---- The campaign ---------------------------------------------------------------------------------------------------

void print_rows(const MoveTally& tally) {
  for (std::size_t group = 0; group < 2; ++group) {
    for (std::size_t kind = 0; kind < kKindNames.size(); ++kind) {
      fmt::print("\n{}, {}\ndelta/range      violated  refuted     clear   proved  refuted elsewhere\n",
                 kKindNames[kind], group == 0 ? "exact machines and masses" : "with tolerances");
      for (int k = 0; k < kMoveDecades; ++k) {
        const Row& row = tally.rows[group][kind][static_cast<std::size_t>(k)];
        fmt::print("1e{:<3} to 1e{:<3}  {:9d}{:9d} {:9d}{:9d}{:9d}\n", k - 13, k - 12, row.violated.load(),
                   row.violated_refuted.load(), row.clear.load(), row.clear_proved.load(), row.clear_refuted.load());
      }
    }
  }
}

void print_summary(const MoveTally& tally, double seconds) {
  const long trials = tally.trials;
  fmt::print(
      "\n{} segments ({} with machines that deviate, {} of them held by lengths, of which {} are proved; {} with "
      "masses in "
      "ranges, {} that may be slowed down, {} skipped): {} proved, {} refuted, {} undecided\n",
      trials, tally.deviating.load(), tally.held.load(), tally.held_proved.load(), tally.ranges.load(),
      tally.slowed.load(), tally.skipped.load(), tally.proved.load(), tally.refuted.load(), tally.undecided.load());
  fmt::print(
      "refuted by a tension {}, a rate {}, a length {}, a singular pose {}; {} of them where it is slowed down, {} by "
      "a deviation\n",
      tally.refuted_tension.load(), tally.refuted_too_fast.load(), tally.refuted_length.load(),
      tally.refuted_singular.load(), tally.refuted_slowed.load(), tally.refuted_deviating.load());
  fmt::print(
      "{} whose lengths run straight between rows, {} of them judged there after proofs\n"
      "{} boxes, {} of them in MPFR; {} times looked at after proofs, {} of them in {} bits; {} quantities held "
      "to 400 bits\n",
      tally.between_rows.load(), tally.rows_judged.load(), tally.boxes.load(), tally.multiprecision.load(),
      tally.looked_at.load(), tally.judged.load(), kBits, tally.compared.load());
  fmt::print(
      "the checker: {} moves, {} proved and {} refuted ones accepted or WRONG, {} open, {} not led to confirm; "
      "{} boxes with violations given to its kernel\n",
      tally.kernel_moves.load(), tally.kernel_proved.load(), tally.kernel_refuted.load(), tally.kernel_open.load(),
      tally.kernel_not_led.load(), tally.kernel_boxes.load());
  const double processor = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  fmt::print("{:.1f} s; {:.2f} ms of processor time each\n{} WRONG\n", seconds,
             1e3 * processor / static_cast<double>(std::max(1L, trials)), tally.wrong.load());
}

int run(const MoveOptions& options, std::size_t threads) {
  rounding_self_test();
  MoveTally tally;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  std::atomic<long> next = 0;
  const auto judge = [&] {
    const PrecisionScope precision(kBits);
    for (long k = next++; k < options.count; k = next++) {
      if (options.budget > 0 && elapsed() > options.budget) break;
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(k);
      try {
        MoveJudge(seed, options, tally).run();
      } catch (const std::exception& error) {
        ++tally.wrong;
        fmt::print(stderr, "WRONG: thrown: {} (seed {})\n", error.what(), seed);
      }
      constexpr long kNews = 5000;
      if (k % kNews == kNews - 1) {
        fmt::print(stderr, "{} segments, {} proved, {} refuted, {} WRONG, {:.0f} s\n", k + 1, tally.proved.load(),
                   tally.refuted.load(), tally.wrong.load(), elapsed());
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t n = 1; n < threads; ++n) others.emplace_back(judge);
    judge();
  }
  print_rows(tally);
  fmt::print("\nfrom seed {}", options.seed);
  print_summary(tally, elapsed());
  return tally.wrong == 0 && tally.proved > 0 && tally.refuted > 0 ? 0 : 1;
}

int main(int argc, char** argv) {
  CLI::App app("Proves random moves in time with hidden violations, and holds every verdict to Newton and Euler.",
               "moves_soundness");
  MoveOptions options;
  std::size_t threads = 0;
  app.add_option("COUNT", options.count, "segments");
  app.add_option("SEED", options.seed, "of the first; each has its own, one more");
  app.add_option("--kernels", options.kernels, "of so many seeds one is certified and checked (64)")
      ->check(CLI::PositiveNumber);
  app.add_option("--compare", options.compare, "of so many seeds one has the oracle held to 400 bits (64)")
      ->check(CLI::PositiveNumber);
  app.add_flag("--undecided", options.list_undecided, "list what is not decided, with reasons");
  app.add_option("--mass-error", options.mass_error,
                 "the oracle's masses are larger by this share in what makes them move, which is to be found out");
  app.add_option("--boxes", options.boxes, "after which a segment is left undecided (1000)")
      ->check(CLI::PositiveNumber);
  app.add_option("--multiprecision", options.multiprecision, "likewise of boxes in MPFR (20)")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", threads, "0: all");
  app.add_option("--budget", options.budget, "stop after so many seconds");
  CLI11_PARSE(app, argc, argv);
  return run(options, threads > 0 ? threads : usable_threads());
}

}  // namespace
}  // namespace taut::campaign

int main(int argc, char** argv) { return taut::campaign::main(argc, argv); }
