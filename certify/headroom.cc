// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/headroom.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>

#include "base/input_error.h"
#include "kinematics/move_sampler.h"
#include "problem/decimal.h"

namespace taut {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kLeastShare = 1e-3;
constexpr double kMostShare = 1e3;
constexpr double kResolution = 1.03;

/// Three digits, rounded towards 0.
DecimalText three_digits(double x) {
  if (!(x > 0)) return "0";
  const int exponent = static_cast<int>(std::floor(std::log10(x))) - 2;
  const auto mantissa = static_cast<long>(std::floor(x * std::pow(10.0, -exponent) * (1 + 1e-12)));
  return Decimal::parse(fmt::format("{}e{}", mantissa, exponent)).text();
}

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

/// The path's segments, ready to be proved about; one that stays where the path is a single pose. Refers to the path.
std::vector<Segment> segments_of(const Prover& prover, const Path& path) {
  std::vector<Segment> result;
  if (path.waypoints.empty()) return result;
  const std::size_t count = std::max<std::size_t>(1, path.segments());
  for (std::size_t k = 0; k < count; ++k) result.push_back(prover.prepared(path.segment(k)));
  return result;
}

// ---- Where it is tight, in floating point ---------------------------------------------------------------------------

/// The less, the tighter: beyond a limit negative, else the share of all uncertainties that is left room for; above all
/// shares, where nothing that is uncertain counts, by how far it is from the limit.
double tightness(const MarginBudget& budget) {
  constexpr double kAboveAllShares = 1e12;
  const double relative = budget.nominal / std::max({std::abs(budget.limit), std::abs(budget.quantity), 1e-300});
  if (!(budget.nominal > 0)) return relative - 1e-9;
  const double share = budget.share(UncertaintyKind::kAll);
  return std::isfinite(share) ? share : kAboveAllShares * (1 + relative);
}

/// Whether cables can balance the load only because of rounding, if at all: tensions far beyond the greatest limit.
bool is_as_good_as_singular(std::span<const MarginBudget> budgets) {
  constexpr double kFarBeyond = 1e6;
  double limit = 0;
  double tension = 0;
  for (const MarginBudget& budget : budgets) {
    if (budget.id.kind == MarginKind::kLengthMin || budget.id.kind == MarginKind::kLengthMax) continue;
    limit = std::max(limit, std::abs(budget.limit));
    tension = std::max(tension, std::abs(budget.quantity));
  }
  return tension > kFarBeyond * limit;
}

struct SegmentSamples {
  std::vector<double> least;  ///< the least share of each uncertainty that is asked for
  TightPlace tightest;
  double tightness = kInfinite;
};

/// Samples of the margins along a path.
class Sampling {
 public:
  /// @param asked  the uncertainties of which shares are wanted
  Sampling(const Prover& prover, const Path& path, const std::vector<Segment>& segments, std::vector<Uncertainty> asked)
      : prover_(prover),
        path_(path),
        segments_(segments),
        asked_(std::move(asked)),
        differentiator_(prover.problem(), !segments.empty() && prover.is_length_controlled(segments.front().law)) {
    if (is_in_time(prover.problem(), path)) move_.emplace(prover.problem());
    constexpr std::size_t kSamples = 3000;  // of a path
    constexpr std::size_t kMostOfSegment = 48;
    per_segment_ = std::clamp<std::size_t>(kSamples / std::max<std::size_t>(1, segments.size()), 1, kMostOfSegment);
    result_.resize(segments.size());
    tbb::parallel_for(std::size_t{0}, segments.size(), [&](std::size_t k) { result_[k] = sample(k); });
  }

  /// Of each segment, the share of an uncertainty that floating point expects.
  [[nodiscard]] std::vector<double> guesses(const Uncertainty& of) const {
    const auto n = static_cast<std::size_t>(std::ranges::find(asked_, of) - asked_.begin());
    std::vector<double> result;
    for (const SegmentSamples& samples : result_) result.push_back(samples.least.at(n));
    return result;
  }

  [[nodiscard]] std::optional<TightPlace> tightest() const {
    if (result_.empty()) return std::nullopt;
    const auto least = std::ranges::min_element(result_, {}, &SegmentSamples::tightness);
    return std::isfinite(least->tightness) || least->tightest.singular ? std::optional(refined(least->tightest))
                                                                       : std::nullopt;
  }

 private:
  [[nodiscard]] RigidPose pose(std::size_t k, double s) const { return prover_.sampler().rigid_pose(segments_[k], s); }

  [[nodiscard]] auto budgets(std::size_t k, double s, const RigidPose& at) const {
    if (!move_) return differentiator_.budgets(at);
    return differentiator_.budgets(at, move_->at_place(path_, static_cast<double>(k) + s).inertial_wrench);
  }

  [[nodiscard]] SegmentSamples sample(std::size_t k) const {
    SegmentSamples result;
    result.least.assign(asked_.size(), kInfinite);
    double last_determinant = 0;
    for (std::size_t i = 0; i <= per_segment_; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(per_segment_);
      const RigidPose at = pose(k, s);
      const double determinant = prover_.sampler().statics(at).determinant;
      const auto budgets = this->budgets(k, s, at);
      if (!budgets || determinant * last_determinant < 0 || is_as_good_as_singular(*budgets)) {
        result.least.assign(asked_.size(), 0);
        result.tightness = -kInfinite;
        result.tightest = {k, s, true, {}};
        return result;
      }
      last_determinant = determinant;
      for (const MarginBudget& budget : *budgets) take(budget, k, s, result);
    }
    return result;
  }

  void take(const MarginBudget& budget, std::size_t k, double s, SegmentSamples& result) const {
    for (std::size_t n = 0; n < asked_.size(); ++n) {
      result.least[n] = std::min(result.least[n], budget.share(asked_[n]));
    }
    if (tightness(budget) < result.tightness) {
      result.tightness = tightness(budget);
      result.tightest = {k, s, false, budget};
    }
  }

  /// The place next to a sample where the same margin is tightest.
  [[nodiscard]] TightPlace refined(TightPlace place) const {
    if (place.singular) return place;
    double step = 1.0 / static_cast<double>(per_segment_);
    constexpr int kHalvings = 12;
    for (int i = 0; i < kHalvings; ++i, step *= 0.5) {
      for (const double s : {place.s - step, place.s + step}) {
        if (s < 0 || s > 1) continue;
        const auto budgets = this->budgets(place.segment, s, pose(place.segment, s));
        if (!budgets) continue;
        const auto same = std::ranges::find_if(*budgets, [&](const auto& b) { return b.id == place.budget.id; });
        if (tightness(*same) < tightness(place.budget)) {
          place.s = s;
          place.budget = *same;
          break;
        }
      }
    }
    return place;
  }

  const Prover& prover_;
  const Path& path_;
  const std::vector<Segment>& segments_;
  std::vector<Uncertainty> asked_;
  MarginDifferentiator differentiator_;
  std::optional<MoveSampler> move_;  ///< where inertia counts
  std::size_t per_segment_ = 1;
  std::vector<SegmentSamples> result_;
};

// ---- Shares, proved -------------------------------------------------------------------------------------------------

/// The search for the largest provable share of one uncertainty.
class ShareSearch {
 public:
  /// @param guesses  for each segment, the share that floating point expects
  ShareSearch(Problem problem, Uncertainty of, const std::vector<Segment>& segments, std::vector<double> guesses,
              const std::stop_token& stop)
      : problem_(std::move(problem)),
        of_(std::move(of)),
        segments_(segments),
        guesses_(std::move(guesses)),
        stop_(stop) {}

  /// The largest share, at least `lower`, which is known to be proved, and below `upper`. Nothing where `stop` ended
  /// the search.
  std::optional<DecimalText> largest(double lower, double upper) {
    std::vector<std::size_t> order(segments_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return guesses_[k]; });
    double best = upper;
    bool is_first = true;
    for (const std::size_t k : order) {
      if (!std::exchange(is_first, false) && proves(best, k)) continue;
      best = largest_of(k, lower, best);
      if (stop_.stop_requested()) return std::nullopt;
      if (!(best > lower)) return three_digits(lower);
    }
    return three_digits(best);
  }

  [[nodiscard]] bool proves(double share, std::size_t k) {
    if (stop_.stop_requested()) return false;
    const DecimalText text = three_digits(share);
    if (!prover_ || text != share_of_prover_) {
      prover_.reset();
      share_of_prover_ = text;
      try {
        prover_ = std::make_unique<Prover>(with_uncertainty_scaled(problem_, of_, Decimal::parse(text)), kTrial);
      } catch (const InputError&) {
        return false;  // so large that there is no such problem
      }
    }
    return prover_->prove(segments_[k], 0, stop_).verdict == Verdict::kProved;
  }

 private:
  /// The largest share above `lower` and below `upper` at which segment k is proved, else `lower`.
  double largest_of(std::size_t k, double lower, double upper) {
    constexpr std::array kDown = {1.0, 0.95, 0.87, 0.75, 0.6, 0.4, 0.2, 0.1, 0.03, 0.01, 0.003, 0.001};
    constexpr double kExpected = 0.985;  // of the guess: a proof is cautious
    const double start = std::min({kExpected * guesses_[k], upper, kMostShare});
    double failed = upper;
    double proved = lower;
    for (const double factor : kDown) {
      const double share = number(three_digits(std::min(factor * start, 0.99 * failed)));
      if (share <= std::max(lower, kLeastShare)) break;
      if (proves(share, k)) {
        proved = share;
        break;
      }
      failed = share;
    }
    if (!(proved > lower)) return lower;
    double up = kResolution;
    while (failed == upper && up * proved < std::min(upper, kMostShare)) {  // the guess was too low
      (proves(up * proved, k) ? proved : failed) = number(three_digits(up * proved));
      up *= 1.3;
    }
    if (failed == upper && !(upper < kMostShare)) return proved;
    while (failed > kResolution * proved && !stop_.stop_requested()) {
      const double middle = number(three_digits(std::sqrt(failed * proved)));
      if (middle <= proved || middle >= failed) break;
      (proves(middle, k) ? proved : failed) = middle;
    }
    return proved;
  }

  Problem problem_;
  Uncertainty of_;
  const std::vector<Segment>& segments_;
  std::vector<double> guesses_;
  const std::stop_token& stop_;
  std::unique_ptr<Prover> prover_;
  DecimalText share_of_prover_;
};

double rounded_down(double x) { return x > 0 ? std::nextafter(x * (1 - 1e-15), 0.0) : 0; }

/// One uncertainty of one path.
class Search {
 public:
  Search(const Problem& problem, const Path& path, const std::vector<Segment>& segments, const Sampling& sampling,
         Verdict verdict, const std::stop_token& stop)
      : problem_(problem), path_(path), segments_(segments), sampling_(sampling), verdict_(verdict), stop_(stop) {}

  [[nodiscard]] ProvableShare find(const Uncertainty& of) const {
    ProvableShare result{of, size_of(problem_, of.kind)};
    const bool grows_from_nothing = of != UncertaintyKind::kAll && !is_stated(problem_, of);
    const bool is_proved = verdict_ == Verdict::kProved;
    Problem problem = grows_from_nothing ? with_unit_uncertainty(problem_, of.kind) : problem_;
    const double unit = size_of(problem, of.kind);
    if (!(unit > 0)) return result;
    const double lower = is_proved && !grows_from_nothing ? 1 : 0;
    const double upper = is_proved ? kInfinite : 1;
    std::vector<double> guesses = grows_from_nothing ? guesses_of(problem, of) : sampling_.guesses(of);
    const double least = *std::ranges::min_element(guesses);
    std::optional<DecimalText> found = "0";
    if (least > kLeastShare * 1e-3 || lower > 0) {
      found = ShareSearch(std::move(problem), of, segments_, std::move(guesses), stop_).largest(lower, upper);
    }
    result.is_complete = found.has_value();
    result.share = found.value_or(lower > 0 ? "1" : "0");
    result.proved = lower > 0 && result.share == "1" ? result.stated : rounded_down(unit * number(result.share));
    return result;
  }

  /// Whether the nominal machine is provable, and what refutes it.
  void examine_nominal(Headroom& result) const {
    const Prover nominal(with_uncertainty_scaled(problem_, UncertaintyKind::kAll, Decimal::parse("0")));
    result.nominal_provable = true;
    for (std::size_t k = 0; k < segments_.size() && !stop_.stop_requested(); ++k) {
      const SegmentProof proof = nominal.prove(segments_[k], 0, stop_);
      if (proof.verdict == Verdict::kProved) continue;
      result.nominal_provable = false;
      if (!proof.witness || proof.witness->rate) continue;
      result.nominal_violation = path_witness(nominal, segments_[k], static_cast<int>(k), *proof.witness);
      if (path_.segments() == 0) result.nominal_violation->at.on_segment = false;
      return;
    }
    if (stop_.stop_requested()) result.nominal_provable.reset();
  }

 private:
  [[nodiscard]] std::vector<double> guesses_of(const Problem& problem, const Uncertainty& of) const {
    const Prover prover(problem);
    return Sampling(prover, path_, segments_, {of}).guesses(of);
  }

  const Problem& problem_;
  const Path& path_;
  const std::vector<Segment>& segments_;
  const Sampling& sampling_;
  Verdict verdict_;
  const std::stop_token& stop_;
};

/// Whether a tolerance that the problem does not state may grow from nothing.
bool may_grow(const Problem& problem, UncertaintyKind kind, bool length_controlled) {
  switch (kind) {
    case UncertaintyKind::kCableLengths: return length_controlled && problem.tolerances->cable_length_m;
    case UncertaintyKind::kLoadPoint:
    case UncertaintyKind::kLoad: return problem.load.items.empty();  // items have tolerances of their own
    default: return kind != UncertaintyKind::kWrenchSet;
  }
}

std::vector<Uncertainty> sought(const Problem& problem, Verdict verdict, bool length_controlled) {
  std::vector<Uncertainty> result = stated_uncertainties(problem);
  if (verdict == Verdict::kProved && problem.tolerances) {
    for (const UncertaintyKind kind : single_uncertainties()) {
      if (!is_stated(problem, kind) && may_grow(problem, kind, length_controlled)) result.emplace_back(kind);
    }
  }
  if (result.empty() && verdict == Verdict::kProved) return result;
  if (result.size() == 1 && is_stated(problem, result.front())) result.clear();  // it is all
  result.insert(result.begin(), UncertaintyKind::kAll);
  return result;
}

}  // namespace

std::optional<TightPlace> tightest_place(const Problem& problem, const Path& path) {
  const Prover prover(problem);
  const std::vector<Segment> segments = segments_of(prover, path);
  return Sampling(prover, path, segments, {}).tightest();
}

Headroom find_headroom(const Problem& problem, const Path& path, Verdict verdict, const DecimalText& wrench_scale,
                       const HeadroomProgress& progress, const std::stop_token& stop) {
  Headroom result;
  const Prover prover(problem);
  const std::vector<Segment> segments = segments_of(prover, path);
  if (segments.empty() || !std::ranges::all_of(segments, [&](const auto& x) { return prover.is_admissible(x); })) {
    return result;
  }
  const std::vector<Uncertainty> kinds = sought(problem, verdict, prover.is_length_controlled(path.interpolation));
  const Sampling sampling(prover, path, segments, kinds);
  result.tightest = sampling.tightest();
  // The margin scales K. With items, as each move has them, that is something else: the two tolerances of a weight
  // multiply.
  if (verdict == Verdict::kProved && !problem.tolerances && problem.load.items.empty() && !wrench_scale.empty()) {
    result.shares = {{UncertaintyKind::kAll, 1, wrench_scale, rounded_down(number(wrench_scale))}};
    return result;
  }
  const Search search(problem, path, segments, sampling, verdict, stop);
  result.shares.resize(kinds.size());
  std::mutex reporting;
  std::size_t done = 0;
  const std::size_t tasks = kinds.size() + (verdict != Verdict::kProved && problem.bodies ? 1 : 0);
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t i) {
    if (i == kinds.size()) {
      result.free_ends = find_free_ends(prover, segments, stop);
    } else {
      result.shares[i] = search.find(kinds[i]);
      if (i == 0 && result.shares[0].is_complete && result.shares[0].share == "0") search.examine_nominal(result);
    }
    const std::scoped_lock lock(reporting);
    if (progress) progress(++done, tasks);
  });
  return result;
}

}  // namespace taut
