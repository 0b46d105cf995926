// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/sensitivity.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>

#include "base/input_error.h"
#include "problem/rational.h"

namespace taut {
namespace {

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

/// The coordinate that an anchor's change is about.
DecimalText& anchor(Problem& problem, const Change& change) {
  auto& all =
      change.kind == Change::Kind::kBaseAnchor ? problem.robot.base_anchors_m : problem.robot.platform_anchors_m;
  return all.at(change.index).at(change.axis);
}

enum class Side { kLower, kUpper };

/// Widens what is narrower.
void widen(std::array<Limits, kCables>& all, Side side, const Decimal& value) {
  for (Limits& limits : all) {
    DecimalText& limit = side == Side::kLower ? limits.lower : limits.upper;
    const Decimal old = Decimal::parse(limit);
    if (side == Side::kLower ? value < old : value > old) limit = value.text();
  }
}

/// The number before the change: of limits, the one that moves furthest.
DecimalText before(Problem problem, const Change& change) {
  const auto extreme = [](const std::array<Limits, kCables>& all, Side side) {
    const auto key = [&](const Limits& x) { return number(side == Side::kLower ? x.lower : x.upper); };
    const auto [least, greatest] = std::ranges::minmax_element(all, {}, key);
    return side == Side::kLower ? greatest->lower : least->upper;
  };
  switch (change.kind) {
    case Change::Kind::kTensionLower: return extreme(problem.robot.tension_N, Side::kLower);
    case Change::Kind::kTensionUpper: return extreme(problem.robot.tension_N, Side::kUpper);
    case Change::Kind::kLengthLower: return extreme(problem.robot.length_m, Side::kLower);
    case Change::Kind::kLengthUpper: return extreme(problem.robot.length_m, Side::kUpper);
    case Change::Kind::kWrench:
    case Change::Kind::kMass: return "1";
    default: break;
  }
  return anchor(problem, change);
}

/// The weight of this name. @throws InputError
Weight& weight_named(Problem& problem, const std::string& name) {
  for (LoadItem& item : problem.load.items) {
    auto* weight = std::get_if<Weight>(&item.what);
    if (weight != nullptr && item.name == name) return *weight;
  }
  throw FieldError("load.items", "no weight '" + name + "'", "expected one of that name");
}

/// The middle of its mass [kg].
double mass_of(Problem problem, const std::string& name) {
  const Weight& weight = weight_named(problem, name);
  return 0.5 * (from_rational<double>(weight.mass_lower) + from_rational<double>(weight.mass_upper));
}

/// A change, a direction in which it may go, and how far at most.
struct Candidate {
  Change change;
  double expected = 0;  ///< the signed change that floating point expects to do
  double most = 0;      ///< its largest size
  bool is_length = false;
};

/// One candidate's search.
class ChangeSearch {
 public:
  ChangeSearch(const Problem& problem, const Path& path, std::size_t tight_segment, const Decimal& unit_m,
               const std::stop_token& stop)
      : problem_(problem), path_(path), tight_segment_(tight_segment), unit_m_(unit_m), stop_(stop) {}

  [[nodiscard]] ProvedChange find(const Candidate& candidate) const {
    ProvedChange result{candidate.change, before(problem_, candidate.change)};
    const double from = number(result.before);
    const double sign = candidate.expected < 0 ? -1 : 1;
    const double first = std::min(std::abs(candidate.expected), candidate.most);
    const Decimal unit = candidate.is_length ? unit_m_ : Decimal::parse("1");
    const double unit_size = number(unit.text());
    constexpr double kFinest = 50;  // steps of the grid in the change that is expected
    const int exponent =
        static_cast<int>(std::floor(std::log10(std::max(first, 1e-9 * candidate.most) / unit_size / kFinest)));
    // Values are whole multiples of a power of ten, next to the wanted one and beyond it.
    const auto value_at = [&](double size) {
      const double steps = (from + sign * size) / unit_size * std::pow(10.0, -exponent);
      const auto whole = static_cast<long>(sign > 0 ? std::ceil(steps - 1e-6) : std::floor(steps + 1e-6));
      return Decimal::parse(fmt::format("{}e{}", whole, exponent)) * unit;
    };
    const auto size_of_value = [&](const Decimal& value) { return sign * (number(value.text()) - from); };
    constexpr std::array kFactors = {1.05, 1.25, 1.6, 2.2, 3.5, 6.0, 12.0, 30.0, 100.0};
    double failed = 0;
    std::optional<Decimal> proved;
    for (const double factor : kFactors) {
      const double size = std::min(factor * first, candidate.most);
      const Decimal value = value_at(size);
      if (proves(candidate.change, value)) {
        proved = value;
        break;
      }
      failed = size_of_value(value);
      if (size >= candidate.most || stop_.stop_requested()) break;
    }
    constexpr int kBisections = 7;
    for (int k = 0; proved && k < kBisections && !stop_.stop_requested(); ++k) {
      const Decimal middle = value_at(0.5 * (failed + size_of_value(*proved)));
      const double size = size_of_value(middle);
      if (middle == *proved || !(size > failed)) break;
      if (proves(candidate.change, middle)) {
        proved = middle;
      } else {
        failed = size;
      }
    }
    if (proved) result.value = proved->text();
    result.is_complete = !stop_.stop_requested();
    return result;
  }

 private:
  [[nodiscard]] bool proves(const Change& change, const Decimal& value) const {
    if (stop_.stop_requested()) return false;
    try {
      Problem changed = with_change(problem_, change, value);
      const Prover prover(changed, kTrial);
      const auto is_proved = [&](std::size_t k) {
        return prover.prove(prover.prepared(path_.segment(k)), 0, stop_).verdict == Verdict::kProved;
      };
      if (!is_proved(tight_segment_)) return false;
      for (std::size_t k = 0; k < std::max<std::size_t>(1, path_.segments()); ++k) {
        if (k != tight_segment_ && !is_proved(k)) return false;
      }
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  const Problem& problem_;
  const Path& path_;
  std::size_t tight_segment_;
  const Decimal& unit_m_;
  const std::stop_token& stop_;
};

bool is_tension(MarginId id) { return id.kind == MarginKind::kTensionMin || id.kind == MarginKind::kTensionMax; }

/// How far apart the base's anchors are, at most.
double reach(const Problem& problem) {
  double result = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    double least = number(problem.robot.base_anchors_m[0][k]);
    double greatest = least;
    for (const auto& a : problem.robot.base_anchors_m) {
      least = std::min(least, number(a[k]));
      greatest = std::max(greatest, number(a[k]));
    }
    result = std::max(result, greatest - least);
  }
  return result;
}

/// What floating point expects to be missing, with a little for the proof's caution.
double missing(const MarginBudget& budget) {
  constexpr double kCaution = 0.02;
  return std::max(-budget.left(), 0.0) + kCaution * budget.all_losses() + 1e-6 * std::abs(budget.limit);
}

std::vector<Candidate> limit_candidates(const Problem& problem, const MarginBudget& budget) {
  using Kind = Change::Kind;
  const double lack = missing(budget);
  std::vector<Candidate> result;
  const auto add = [&](Kind kind, double sign, double most, bool is_length) {
    const bool is_own = is_length != is_tension(budget.id);
    const double other = 0.01 * most;  // of a limit that is not the tightest, where only trying tells
    result.push_back({{kind}, sign * (is_own ? lack : other), most, is_length});
  };
  const auto from = [&](Kind kind) { return number(before(problem, {kind})); };
  add(Kind::kTensionLower, -1, from(Kind::kTensionLower), false);
  add(Kind::kTensionUpper, 1, 9 * from(Kind::kTensionUpper), false);
  add(Kind::kLengthLower, -1, from(Kind::kLengthLower), true);
  add(Kind::kLengthUpper, 1, 3 * from(Kind::kLengthUpper), true);
  // Only the limits of the kind that is in the way can help alone.
  const MarginKind own = budget.id.kind;
  std::erase_if(result, [&](const Candidate& c) { return static_cast<int>(c.change.kind) != static_cast<int>(own); });
  std::erase_if(result, [](const Candidate& c) { return !(c.most > 0); });
  return result;
}

constexpr std::size_t kMostAnchors = 4;

std::vector<Candidate> candidates(const Problem& problem, const Sensitivity& found) {
  const MarginBudget& budget = found.tightest->budget;
  const double lack = missing(budget);
  std::vector<Candidate> result = limit_candidates(problem, budget);
  std::size_t anchors = 0;
  const double robot = reach(problem);
  for (const Derivative& derivative : found.derivatives) {
    using Kind = DesignParameter::Kind;
    const DesignParameter& p = derivative.parameter;
    constexpr double kMostWeight = 0.8;
    if (p.kind == Kind::kWeight) {
      result.push_back({{Change::Kind::kWrench}, lack / derivative.value, kMostWeight, false});
    }
    if (const double mass = p.kind == Kind::kMass ? mass_of(problem, p.uncertainty.item) : 0; mass > 0) {
      const Change change{Change::Kind::kMass, 0, 0, p.uncertainty.item};
      result.push_back({change, lack / derivative.value / mass, kMostWeight, false});
    }
    if ((p.kind != Kind::kBaseAnchor && p.kind != Kind::kPlatformAnchor) || anchors == kMostAnchors) continue;
    ++anchors;
    const auto kind = p.kind == Kind::kBaseAnchor ? Change::Kind::kBaseAnchor : Change::Kind::kPlatformAnchor;
    result.push_back({{kind, p.index, p.axis}, lack / derivative.value, 0.25 * robot, true});
  }
  return result;
}

}  // namespace

std::string_view unit(Change::Kind kind) {
  switch (kind) {
    case Change::Kind::kTensionLower:
    case Change::Kind::kTensionUpper: return "N";
    case Change::Kind::kWrench:
    case Change::Kind::kMass: return "1";
    default: return "m";
  }
}

Problem with_change(Problem problem, const Change& change, const Decimal& value) {
  using Kind = Change::Kind;
  switch (change.kind) {
    case Kind::kTensionLower: widen(problem.robot.tension_N, Side::kLower, value); break;
    case Kind::kTensionUpper: widen(problem.robot.tension_N, Side::kUpper, value); break;
    case Kind::kLengthLower: widen(problem.robot.length_m, Side::kLower, value); break;
    case Kind::kLengthUpper: widen(problem.robot.length_m, Side::kUpper, value); break;
    case Kind::kWrench:
      for (DecimalText& w : problem.load.wrench) w = (Decimal::parse(w) * value).text();
      break;
    case Kind::kMass: {
      Weight& weight = weight_named(problem, change.item);
      for (RationalText* mass : {&weight.mass_lower, &weight.mass_upper}) {
        *mass = rational_text(parse_rational(*mass) * value.rational());
      }
      break;
    }
    case Kind::kBaseAnchor:
    case Kind::kPlatformAnchor: anchor(problem, change) = value.text(); break;
  }
  validate(problem);
  return problem;
}

double natural_step(const Problem& problem, const DesignParameter& parameter) {
  using Kind = DesignParameter::Kind;
  constexpr double kMillimetre = 1e-3;
  constexpr double kPercent = 0.01;
  const auto range = [](const Limits& limits) { return number(limits.upper) - number(limits.lower); };
  switch (parameter.kind) {
    case Kind::kBaseAnchor:
    case Kind::kPlatformAnchor:
    case Kind::kLoadPoint: return kMillimetre;
    case Kind::kWrench: {
      const auto& w = problem.load.wrench;
      const double force = std::hypot(number(w[0]), number(w[1]), number(w[2]));
      return kPercent * force * (parameter.axis < 3 ? 1 : make_model<double>(problem).characteristic_length);
    }
    case Kind::kTensionLower:
    case Kind::kTensionUpper: return kPercent * range(problem.robot.tension_N.at(parameter.index));
    case Kind::kLengthLower:
    case Kind::kLengthUpper: return kPercent * range(problem.robot.length_m.at(parameter.index));
    case Kind::kMass: return kPercent * mass_of(problem, parameter.uncertainty.item);
    case Kind::kWeight:
    case Kind::kTolerance: break;
  }
  return kPercent;
}

Sensitivity find_sensitivity(const Problem& problem, const Path& path, Verdict verdict, const Decimal& unit_m,
                             const HeadroomProgress& progress, const std::stop_token& stop) {
  Sensitivity result;
  const Prover prover(problem);
  result.tightest = tightest_place(problem, path);
  if (!result.tightest || result.tightest->singular) return result;
  const bool length_controlled = prover.is_length_controlled(path.interpolation);
  const Segment segment = prover.prepared(path.segment(result.tightest->segment));
  const RigidPose pose = prover.sampler().rigid_pose(segment, result.tightest->s);
  result.derivatives = MarginDifferentiator(problem, length_controlled).derivatives(pose, result.tightest->budget.id);
  std::erase_if(result.derivatives, [](const Derivative& d) { return d.value == 0 || !std::isfinite(d.value); });
  std::ranges::stable_sort(result.derivatives, std::greater(),
                           [&](const Derivative& d) { return std::abs(d.value) * natural_step(problem, d.parameter); });
  if (verdict == Verdict::kProved) return result;
  const std::vector<Candidate> tried = candidates(problem, result);
  const ChangeSearch search(problem, path, result.tightest->segment, unit_m, stop);
  result.changes.resize(tried.size());
  std::mutex reporting;
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, tried.size(), [&](std::size_t i) {
    result.changes[i] = search.find(tried[i]);
    const std::scoped_lock lock(reporting);
    if (progress) progress(++done, tried.size());
  });
  return result;
}

}  // namespace taut
