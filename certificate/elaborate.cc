// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/elaborate.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <tuple>

#include "certificate/implied_motion.h"
#include "certificate/kernel_problem.h"
#include "certificate/worst_loads.h"
#include "certify/arithmetic/rounding.h"
#include "checker/format/cursor.h"
#include "checker/format/exact.h"
#include "checker/format/parts.h"
#include "checker/kernel/clearance.h"
#include "checker/kernel/deviant.h"
#include "checker/kernel/moving.h"
#include "checker/near_waypoints.h"
#include "checker/witness.h"

namespace taut {
namespace {

using checker::Ball;

constexpr std::array<int, 7> kBits = {64, 128, 256, 512, 1024, 2048, 4096};
constexpr int kMostWork = 40'000;   ///< of one search, in attempts at the least precision
constexpr int kMostHalvings = 900;  ///< of [0, 1]: a dyadic's denominator is at most 2^1000

double lower_bound(const Ball& x) { return arf_get_d(arb_midref(lowest(x).get()), ARF_RND_FLOOR); }

// ---- Into the kernel's types ----------------------------------------------------------------------------------------

mpq_class exact(const DecimalText& text) { return checker::parse_decimal(text).value(); }

template <std::size_t N>
std::array<mpq_class, N> exact(const std::array<DecimalText, N>& texts) {
  std::array<mpq_class, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = exact(texts[i]);
  return result;
}

checker::Law to_kernel(Interpolation law) {
  switch (law) {
    case Interpolation::kStraight: return checker::Law::kStraight;
    case Interpolation::kCubicBSpline: return checker::Law::kCubicBSpline;
    case Interpolation::kGeodesic: return checker::Law::kGeodesic;
    case Interpolation::kCableLengths: break;
  }
  return checker::Law::kCableLengths;
}

/// Which segment of to_kernel(segment) it is.
std::size_t index_in_kernel(const Segment& segment) { return segment.timing == nullptr ? 0 : segment.index; }

checker::Waypoint to_kernel(const Waypoint& waypoint) {
  const auto* const point = std::get_if<ParameterPoint>(&waypoint.point());
  if (point == nullptr) return {numbers(waypoint), {}, {}};
  return {point->x, point->half_turns, point->normals};
}

/// A path that is this one segment; of a move, with a waypoint (and tubes) in place of each earlier segment, as the law
/// knows the segment by its number.
checker::Path to_kernel(const Segment& segment, bool has_constraints) {
  checker::Path path;
  path.law = to_kernel(segment.law);
  if (segment.timing != nullptr) {
    path.timing = checker::TimeLaw{segment.timing->step_s, segment.timing->controls};
    path.waypoints.assign(segment.index, to_kernel(*segment.control[0]));
  }
  for (const Waypoint* control : segment.controls()) path.waypoints.push_back(to_kernel(*control));
  const std::size_t k = index_in_kernel(segment);
  if (has_constraints) path.tubes.assign(k + 1, segment.tube);
  if (segment.law == Interpolation::kCableLengths) {
    path.pose_tubes.assign(k + 1, {segment.pose_tube.position, segment.pose_tube.turn});
    path.inner_poses.resize(k + 1);
    std::vector<checker::InnerPose>& inner = path.inner_poses.back();
    for (const InnerPose& pose : segment.inner_poses) {
      inner.push_back({mpq_class(pose.s), pose.x, {pose.tube.position, pose.tube.turn}});
    }
  }
  return path;
}

checker::WitnessDeviation to_kernel(const Deviation& deviation) {
  checker::WitnessDeviation result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.base_anchors[i] = exact(deviation.base_anchors_m[i]);
    result.platform_anchors[i] = exact(deviation.platform_anchors_m[i]);
  }
  result.load_point = exact(deviation.load_point_m);
  result.wrench = exact(deviation.wrench);
  result.position = exact(deviation.position_m);
  result.turn = exact(deviation.turn);
  if (deviation.cable_lengths_m) result.cable_lengths = exact(*deviation.cable_lengths_m);
  return result;
}

checker::WitnessKind to_kernel(RateKind kind) {
  switch (kind) {
    case RateKind::kWinchSpeed: return checker::WitnessKind::kWinchSpeed;
    case RateKind::kWinchAcceleration: return checker::WitnessKind::kWinchAcceleration;
    case RateKind::kWinchPower: return checker::WitnessKind::kWinchPower;
    case RateKind::kLoadSpeed: return checker::WitnessKind::kLoadSpeed;
    case RateKind::kLoadAcceleration: return checker::WitnessKind::kLoadAcceleration;
    case RateKind::kLoadAngularSpeed: return checker::WitnessKind::kLoadAngularSpeed;
    case RateKind::kLoadAngularAcceleration: break;
  }
  return checker::WitnessKind::kLoadAngularAcceleration;
}

checker::WitnessKind to_kernel(const PathWitness& found) {
  if (found.singular) return checker::WitnessKind::kSingular;
  if (found.contact) return checker::WitnessKind::kContact;
  if (found.rate) return to_kernel(found.rate->kind);
  switch (found.margin.kind) {
    case MarginKind::kTensionMin: return checker::WitnessKind::kTensionMin;
    case MarginKind::kTensionMax: return checker::WitnessKind::kTensionMax;
    case MarginKind::kLengthMin: return checker::WitnessKind::kLengthMin;
    case MarginKind::kLengthMax: break;
  }
  return checker::WitnessKind::kLengthMax;
}

std::vector<mpq_class> exact_shares(const std::vector<std::int64_t>& shares) {
  std::vector<mpq_class> result;
  for (const std::int64_t share : shares) result.push_back(to_rational(dyadic_share(share)));
  return result;
}

/// The statement of a violation, as of segment k.
checker::Witness statement(const PathWitness& found, std::size_t k) {
  // On a segment, or at its beginning.
  const auto point = [](const PathPoint& at) { return at.on_segment ? to_rational(at.s) : mpq_class(0); };
  checker::Witness result;
  result.kind = to_kernel(found);
  result.at = {k, point(found.at)};
  if (found.singular) {
    result.to = {k, point(found.to)};
    return result;
  }
  if (found.contact) {
    result.pair = found.contact->pair;
    const PointPair& points = found.contact->points;
    result.weights = {exact_shares(points.first), exact_shares(points.second)};
    for (std::size_t side = 0; side < 2; ++side) result.elements[side] = points.elements[side];
    result.inside = points.inside;
    if (const auto& around = found.contact->around) {
      for (const PointPair& of : *around) result.around.push_back({exact_shares(of.first), exact_shares(of.second)});
    }
    return result;
  }
  result.cable = static_cast<std::size_t>(found.rate ? found.rate->cable : found.margin.cable);
  if (found.deviation) result.deviation = to_kernel(*found.deviation);
  if (found.slowing) result.slowing = {exact(found.slowing->speed), found.slowing->change};
  return result;
}

// ---- Witnesses ------------------------------------------------------------------------------------------------------

/// Decimals that enclose x, with as many digits as it takes for `is_enough`; nothing where none do.
template <class IsEnough>
std::optional<std::pair<DecimalText, DecimalText>> decimals(const Ball& x, const IsEnough& is_enough) {
  constexpr int kFewestDigits = 17;
  constexpr int kMostDigits = 600;
  const auto print = [](const Ball& end, int digits, mpfr_rnd_t rounding) {
    const PrecisionScope precision(std::max<mpfr_prec_t>(arf_bits(arb_midref(end.get())), 64));
    BigFloat number;
    arf_get_mpfr(number.get(), arb_midref(end.get()), MPFR_RNDN);  // exact
    return number.to_decimal(digits, rounding);
  };
  const Ball low = lowest(x);
  const Ball high = highest(x);
  for (int digits = kFewestDigits; digits <= kMostDigits; digits *= 2) {
    DecimalText below = print(low, digits, MPFR_RNDD);
    DecimalText above = print(high, digits, MPFR_RNDU);
    if (is_enough(exact(below), exact(above))) return {{std::move(below), std::move(above)}};
  }
  return std::nullopt;
}

/// The exact value of what a witness is about, widened a little: the checker sees the segment as a part of the path and
/// rounds otherwise.
Ball with_slack_for_rounding(const Ball& value, int bits) {
  const Ball rounding = Ball::make([bits](arb_ptr r) {
    arb_set_ui(r, 1);
    arb_mul_2exp_si(r, r, 12 - bits);
  });
  // Arb rounds radii to 30 bits.
  const Ball of_radius = Ball::make([&value](arb_ptr r) {
    arb_get_rad_arb(r, value.get());
    arb_mul_2exp_si(r, r, -20);
  });
  return plus_minus(plus_minus(value, rounding * magnitude(value)), magnitude(of_radius));
}

/// The segment on which a witness is; that of a waypoint begins there.
std::size_t segment_of(const PathWitness& witness) { return static_cast<std::size_t>(witness.at.index); }

}  // namespace

// ---- Searches on one segment ----------------------------------------------------------------------------------------

/// Looks for boxes and witnesses of one segment.
class Elaborator::Search {
 public:
  static constexpr int kMostWayParts = 64;  ///< that a box asks for

  Search(const Elaborator& elaborator, const Segment& segment)
      : elaborator_(elaborator),
        path_(to_kernel(segment, !elaborator.problem_.constraints.empty())),
        k_(index_in_kernel(segment)) {}

  /// Tells pairs of bodies apart along these from now on.
  void use(const PairDirections& directions) {
    directions_ = directions;
    path_.directions.clear();
    apart_.clear();
    for (std::size_t pair = 0; pair < directions.single.size(); ++pair) {
      std::vector<std::size_t>& of_pair = apart_.emplace_back();
      for (const Direction& direction : directions.of(pair)) {
        if (is_of_half_space(direction)) continue;
        of_pair.push_back(path_.directions.size());
        path_.directions.push_back(
            {direction.in_platform ? checker::Axes::kPlatform : checker::Axes::kWorld, direction.u});
      }
    }
  }

  /// Appends boxes that tile [begin, end] and that the kernel proves; false where it does not prove some part.
  bool prove(const mpq_class& begin, const mpq_class& end, std::vector<KernelBox>& out) {
    return cover(begin, end, [&](const checker::Box& box) {
      const std::optional<KernelBox> proved = attempt(box);
      if (proved && box.begin < box.end) out.push_back(*proved);
      return proved.has_value();
    });
  }

  /// Appends boxes that tile [begin, end] and over which the kernel shows the motion; false where it does not.
  bool show_motion(const mpq_class& begin, const mpq_class& end, checker::Ranges ranges,
                   std::vector<checker::Box>& out) {
    return cover(begin, end, [&](checker::Box box) {
      if (!place_motion(box)) return false;
      const checker::Machine& machine = elaborator_.machine(box.bits);
      try {
        const checker::WorkingPrecision precision(box.bits);
        (void)commanded_geometry(machine, elaborator_.problem_, path_, k_, box, ranges);
        require_near_waypoints(machine, elaborator_.problem_, path_, k_, box);
      } catch (const checker::Undefined&) {
        return false;
      }
      if (box.begin < box.end) out.push_back(box);
      return true;
    });
  }

  /// What the kernel shows of one box at one go: bounds of margins, which may be negative; nothing where it shows none.
  std::optional<KernelBox> bounds(checker::Box box) {
    work_ += work_at(box.bits);
    if (!place_motion(box)) return std::nullopt;
    for (const int guesses : {1, 2, 4, 12}) {
      box.guesses = guesses;
      try {
        const checker::Machine& machine = elaborator_.machine(box.bits);
        const checker::WorkingPrecision precision(box.bits);
        const checker::Bounds bounds = prove_box(machine, elaborator_.problem_, path_, k_, box, apart_);
        require_near_waypoints(machine, elaborator_.problem_, path_, k_, box);
        KernelBox result{box, lower_bound(bounds.tension), lower_bound(bounds.length),
                         lower_bound(bounds.wrench_scale)};
        if (bounds.clearance) {
          result.clearance_m = lower_bound(*bounds.clearance);
          result.directions = directions_;
        }
        return result;
      } catch (const checker::Undefined&) {
        if (!elaborator_.has_tolerances()) return std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// The same of a box that it proves: all margins are positive.
  std::optional<KernelBox> attempt(const checker::Box& box) {
    std::optional<KernelBox> result = bounds(box);
    if (!result) return std::nullopt;
    const bool is_clear = !result->clearance_m || *result->clearance_m > 0;
    if (!(result->tension_N > 0 && result->length_m > 0 && result->wrench_scale >= 1 && is_clear)) result.reset();
    return result;
  }

  std::optional<Witness> singular(const PathWitness& found) {
    checker::Witness witness = statement(found, k_);
    const bool changes_sign = at_some_precision([&](int bits) {
      if (!place_pose(witness.at.s, bits, witness.at_box) || !place_pose(witness.to.s, bits, witness.to_box)) {
        return false;
      }
      const checker::Machine& machine = elaborator_.machine(bits);
      const checker::WorkingPrecision precision(bits);
      return certainly_negative(determinant_at(machine, elaborator_.problem_, path_, witness.at, witness.at_box) *
                                determinant_at(machine, elaborator_.problem_, path_, witness.to, witness.to_box));
    });
    if (!changes_sign) return std::nullopt;
    std::vector<checker::Box> between;
    if (!show_motion(witness.at.s, witness.to.s, checker::Ranges::kRequired, between)) return std::nullopt;
    Witness result{found, witness.at_box, witness.to_box, {}, {}, {}};
    for (checker::Box& box : between) result.motion.push_back({segment_of(found), std::move(box)});
    return result;
  }

  std::optional<Witness> contact(const PathWitness& found) {
    checker::Witness witness = statement(found, k_);
    PathWitness deeper = found;
    const bool touches = at_some_precision([&](int bits) {
      const checker::Machine& machine = elaborator_.machine(bits);
      if (!place_pose(witness.at.s, bits, witness.at_box)) return false;
      const checker::WorkingPrecision precision(bits);
      // As in with_slack_for_rounding(): the checker sees the segment as a part of the path.
      const Ball slack = Ball::make([bits](arb_ptr r) {
        arb_set_ui(r, 1);
        arb_mul_2exp_si(r, r, 24 - bits);
      });
      const checker::Geometry geometry = commanded_geometry(machine, elaborator_.problem_, path_, k_, witness.at_box);
      const Ball depth = witnessed_depth(machine, geometry, witness) - slack;
      if (!certainly_nonnegative(depth)) return false;
      constexpr int kDigits = 6;
      deeper.depth_m = BigFloat(lower_bound(depth)).to_decimal(kDigits, MPFR_RNDD);
      return true;
    });
    if (!touches) return std::nullopt;
    return Witness{deeper, witness.at_box, {}, {}, {}, {}};
  }

  std::optional<Witness> violation(const PathWitness& found) {
    checker::Witness witness = statement(found, k_);
    Witness result{found, {}, {}, {}, {}, {}};
    const bool is_violated = at_some_precision([&](int bits) {
      const checker::Machine& machine = elaborator_.machine(bits);
      if (!place_pose(witness.at.s, bits, witness.at_box)) return false;
      const checker::WorkingPrecision precision(bits);
      if (!place_deviation(witness, bits)) return false;
      const auto value =
          violating_value(witnessed_quantity(machine, elaborator_.problem_, path_, witness), found, bits);
      if (!value) return false;
      std::tie(result.violation.value_lower, result.violation.value_upper) = *value;
      name_loads(machine, found, bits, witness, result);
      return true;
    });
    if (!is_violated) return std::nullopt;
    result.at_box = witness.at_box;
    if (witness.deviation) {
      result.way_poses = witness.deviation->poses;
      result.way_boxes = witness.deviation->boxes;
    }
    return result;
  }

 private:
  /// For a violated limit of tension: states loads of the items under which it is violated, if these are found.
  void name_loads(const checker::Machine& machine, const PathWitness& found, int bits, checker::Witness witness,
                  Witness& result) const {
    const checker::Problem& problem = elaborator_.problem_;
    const bool is_least = found.margin.kind == MarginKind::kTensionMin;
    if (path_.timing || problem.items.empty() || !(is_least || found.margin.kind == MarginKind::kTensionMax)) return;
    try {
      const checker::Geometry stated = commanded_geometry(machine, problem, path_, k_, witness.at_box);
      const checker::Geometry there =
          witness.deviation ? deviant(machine, problem, stated, *witness.deviation).geometry : stated;
      witness.loads = worst_loads(problem, there, witness.cable, is_least);
      const auto value = violating_value(witnessed_quantity(machine, problem, path_, witness), found, bits);
      if (!value) return;
      std::tie(result.violation.value_lower, result.violation.value_upper) = *value;
      result.loads = std::move(witness.loads);
    } catch (const checker::Undefined&) {
    }
  }

  /// A part of the segment that is still to be covered, and how the kernel is asked about it.
  struct Task {
    mpq_class begin, end;
    std::size_t rung = 0;  ///< of kBits
    int parts = 1;
    int halvings = 0;  ///< since the last change of rung or parts

    [[nodiscard]] checker::Box box() const {
      checker::Box result;
      result.begin = begin;
      result.end = end;
      result.bits = kBits[rung];
      result.parts = parts;
      return result;
    }
  };

  template <class Attempt>
  static bool at_some_precision(const Attempt& attempt) {
    for (const int bits : kBits) {
      try {
        if (attempt(bits)) return true;
      } catch (const checker::Undefined&) {
        continue;
      }
    }
    return false;
  }

  /// What an attempt takes, beside one at the least precision.
  static int work_at(int bits) { return bits / kBits.front(); }

  /// Finds where the motion is, if it is implied.
  bool place_motion(checker::Box& box) {
    if (!elaborator_.is_implied_) return true;
    box.near = find_motion(elaborator_.machine(box.bits), elaborator_.problem_, path_, k_, box);
    return box.near.has_value();
  }

  bool place_pose(const mpq_class& s, int bits, checker::Box& box) {
    box = {};
    box.begin = box.end = s;
    box.bits = bits;
    return place_motion(box);
  }

  /// Finds the way of a witness's deviation, if it has one that leads anywhere.
  bool place_deviation(checker::Witness& witness, int bits) {
    if (!witness.deviation || !witness.deviation->cable_lengths || !witness.deviation->leads_away()) return true;
    const checker::Machine& machine = elaborator_.machine(bits);
    const checker::Geometry stated = commanded_geometry(machine, elaborator_.problem_, path_, k_, witness.at_box);
    return find_way(machine, stated, elaborator_.approx_, *witness.deviation, bits);
  }

  /// Decimals that enclose what the checker will find and that violate the limit; nothing where none do.
  [[nodiscard]] std::optional<std::pair<DecimalText, DecimalText>> violating_value(const Ball& value,
                                                                                   const PathWitness& found,
                                                                                   int bits) const {
    if (found.rate) {
      const Ball limit = checker::rate_limit(elaborator_.problem_, checker::rate_of(to_kernel(found)).value(),
                                             static_cast<std::size_t>(found.rate->cable));
      return decimals(with_slack_for_rounding(value, bits), [&](const mpq_class& below, const mpq_class&) {
        return certainly_nonnegative(Ball(below) - limit);
      });
    }
    const bool is_lower = found.margin.kind == MarginKind::kTensionMin || found.margin.kind == MarginKind::kLengthMin;
    const mpq_class limit = exact(found.limit);
    return decimals(with_slack_for_rounding(value, bits), [&](const mpq_class& below, const mpq_class& above) {
      return is_lower ? above <= limit : below >= limit;
    });
  }

  /// Tiles [begin, end] with boxes for which `succeeds`; false where that is given up.
  template <class Try>
  bool cover(const mpq_class& begin, const mpq_class& end, const Try& succeeds) {
    std::vector<Task> open = tasks(begin, end);
    work_ = 0;
    while (!open.empty()) {
      const Task task = std::move(open.back());
      open.pop_back();
      work_ += work_at(kBits[task.rung]);
      if (work_ > kMostWork) return false;
      if (!succeeds(task.box()) && !try_otherwise(task, succeeds, open)) return false;
    }
    return true;
  }

  /// The parts of [begin, end] between inner poses, which no box may contain between its ends; the first one comes
  /// last.
  [[nodiscard]] std::vector<Task> tasks(const mpq_class& begin, const mpq_class& end) const {
    std::vector<Task> result;
    mpq_class at = begin;
    if (!path_.inner_poses.empty()) {
      for (const checker::InnerPose& inner : path_.inner_poses.at(k_)) {
        if (inner.s <= at || inner.s >= end) continue;
        result.push_back({at, inner.s});
        at = inner.s;
      }
    }
    result.push_back({at, end});
    std::ranges::reverse(result);
    return result;
  }

  /// After a box has failed: halves it, or asks with more parts or bits. What is left to do is appended to `open`.
  template <class Try>
  bool try_otherwise(Task task, const Try& succeeds, std::vector<Task>& open) {
    constexpr int kPatience = 4;
    const bool has_tolerances = elaborator_.has_tolerances();
    // If halving has not helped a few times, rounding or the loss to deviations may be in the way.
    if (task.halvings >= kPatience) {
      const Task before = task;
      task.halvings = 0;
      if (has_tolerances && task.parts < kMostWayParts) task.parts *= 4;
      if (task.rung + 1 < kBits.size()) ++task.rung;
      if (succeeds(task.box())) return true;
      if (!has_tolerances) task = before;
    }
    const mpq_class middle = (task.begin + task.end) / 2;
    if (task.begin < task.end && task.halvings < kMostHalvings &&
        succeeds(Task{middle, middle, task.rung, task.parts}.box())) {
      ++task.halvings;
      open.push_back({middle, task.end, task.rung, task.parts, task.halvings});
      open.push_back({task.begin, middle, task.rung, task.parts, task.halvings});
      return true;
    }
    if (has_tolerances && task.parts < kMostWayParts) {
      task.parts *= 4;
    } else if (task.rung + 1 < kBits.size()) {
      ++task.rung;
    } else {
      return false;
    }
    open.push_back(std::move(task));
    return true;
  }

  rounding_detail::NearestGuard nearest_;  ///< so that guesses are the same whatever mode the caller has
  const Elaborator& elaborator_;
  checker::Path path_;
  std::size_t k_;  ///< which of its segments it is about
  PairDirections directions_;
  checker::Apart apart_;
  int work_ = 0;
};

/// Halves the boxes that state a path's least margins, or takes the way to their deviations in more parts, until what
/// they state is nearly what the kernel shows of single poses.
class Elaborator::Tightener {
 public:
  using Bound = double (*)(const KernelBox&);

  Tightener(const Elaborator& elaborator, const std::function<Segment(std::size_t k)>& segment,
            std::vector<std::vector<KernelBox>>& boxes)
      : elaborator_(elaborator), segment_(segment), boxes_(boxes) {}

  /// @param enough  the share of what is shown of single poses
  void raise(Bound bound, double enough) {
    constexpr int kMostSteps = 96;
    double found = std::numeric_limits<double>::infinity();  // the least of single poses
    for (int step = 0; step < kMostSteps && improve_worst(bound, enough, found);) ++step;
  }

 private:
  using Boxes = std::vector<KernelBox>;
  /// Segment and place, bits, parts and directions.
  using Key = std::tuple<std::size_t, mpq_class, int, int, std::vector<Direction>,
                         std::map<std::size_t, std::vector<Direction>>>;

  [[nodiscard]] static Boxes::iterator worst_of(Boxes& boxes, Bound bound) {
    return std::ranges::min_element(boxes, {}, bound);
  }

  /// The segment with the worst box; null where none has boxes.
  [[nodiscard]] Boxes* worst_segment(Bound bound) {
    const auto is_worse = [&](Boxes& a, Boxes& b) {
      if (a.empty() || b.empty()) return !a.empty();
      return bound(*worst_of(a, bound)) < bound(*worst_of(b, bound));
    };
    const auto worst = std::ranges::min_element(boxes_, is_worse);
    return worst == boxes_.end() || worst->empty() ? nullptr : &*worst;
  }

  /// False where the worst box states enough, or can't be improved.
  bool improve_worst(Bound bound, double enough, double& found) {
    Boxes* const boxes = worst_segment(bound);
    if (boxes == nullptr) return false;
    const auto worst = worst_of(*boxes, bound);
    const auto k = static_cast<std::size_t>(boxes - boxes_.data());
    Search search(elaborator_, segment_(k));
    search.use(worst->directions);
    const checker::Box point = worst_place(search, k, *worst, bound);
    const std::optional<KernelBox> there = at(search, k, point, worst->directions);
    if (!there) return false;
    const std::optional<KernelBox> finer =
        may_have_more_parts(point) ? at(search, k, with_more_parts(point), worst->directions) : there;
    const double most = finer ? std::max(bound(*finer), bound(*there)) : bound(*there);
    found = std::min(found, most);
    if (!(bound(*worst) < enough * found)) return false;
    const double loss_to_width = bound(*there) - bound(*worst);
    const double loss_to_parts = most - bound(*there);
    if (loss_to_parts > loss_to_width) {
      const std::optional<KernelBox> replaced = search.attempt(with_more_parts(worst->box));
      if (replaced && bound(*replaced) > bound(*worst)) {
        *worst = *replaced;
        return true;
      }
    }
    return halve(search, *boxes, worst, [&](const KernelBox& half) { return bound(half) >= enough * found; });
  }

  /// Where a box states least, of its middle and its ends.
  [[nodiscard]] checker::Box worst_place(Search& search, std::size_t k, const KernelBox& of, Bound bound) {
    const checker::Box& box = of.box;
    checker::Box result = box;
    result.begin = result.end = (box.begin + box.end) / 2;
    double least = std::numeric_limits<double>::infinity();
    for (const mpq_class& s : {mpq_class(result.begin), box.begin, box.end}) {
      checker::Box point = box;
      point.begin = point.end = s;
      point.parts = 1;  // quick, and much the same for all three
      const std::optional<KernelBox> there = at(search, k, point, of.directions);
      if (!there || !(bound(*there) < least)) continue;
      least = bound(*there);
      result.begin = result.end = s;
    }
    return result;
  }

  /// bounds() at a pose, asked for once.
  const std::optional<KernelBox>& at(Search& search, std::size_t k, const checker::Box& point,
                                     const PairDirections& along) {
    const auto [known, is_new] =
        at_.try_emplace(Key{k, point.begin, point.bits, point.parts, along.single, along.lists});
    if (is_new) known->second = search.bounds(point);
    return known->second;
  }

  [[nodiscard]] bool may_have_more_parts(const checker::Box& box) const {
    return elaborator_.has_tolerances() && box.parts < Search::kMostWayParts;
  }
  [[nodiscard]] static checker::Box with_more_parts(checker::Box box) {
    box.parts *= 4;
    return box;
  }

  /// @param is_enough  what a half may state that is asked for with fewer parts
  template <class IsEnough>
  static bool halve(Search& search, Boxes& boxes, Boxes::iterator worst, const IsEnough& is_enough) {
    const checker::Box& box = worst->box;
    const mpq_class middle = (box.begin + box.end) / 2;
    Boxes halves;
    for (auto [begin, end] : {std::pair(box.begin, middle), std::pair(middle, box.end)}) {
      checker::Box half = box;
      half.begin = begin;
      half.end = end;
      std::optional<KernelBox> proved;
      if (half.parts > 1) {
        checker::Box coarse = half;
        coarse.parts /= 4;
        proved = search.attempt(coarse);
        if (proved && !is_enough(*proved)) proved.reset();
      }
      if (!proved) proved = search.attempt(half);
      if (proved) {
        halves.push_back(*proved);
      } else if (!search.prove(begin, end, halves)) {
        return false;
      }
    }
    const auto after = boxes.erase(worst);
    boxes.insert(after, halves.begin(), halves.end());
    return true;
  }

  const Elaborator& elaborator_;
  const std::function<Segment(std::size_t k)>& segment_;
  std::vector<Boxes>& boxes_;
  std::map<Key, std::optional<KernelBox>> at_;
};

// ---- Elaborator -----------------------------------------------------------------------------------------------------

Elaborator::Elaborator(const Problem& problem, Interpolation law)
    : problem_(to_kernel(problem)), approx_(make_model<double>(problem)) {
  is_implied_ = law == Interpolation::kCableLengths || !problem_.constraints.empty();
}

const checker::Machine& Elaborator::machine(int bits) const {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<checker::Machine>& result = machines_[bits];
  if (result == nullptr) {
    const checker::WorkingPrecision precision(bits);
    result = std::make_unique<checker::Machine>(problem_);
  }
  return *result;
}

std::optional<std::vector<KernelBox>> Elaborator::boxes(
    const Segment& segment, std::span<const DyadicBox> proved,
    std::span<const std::shared_ptr<const PairDirections>> directions) const {
  Search search(*this, segment);
  std::vector<KernelBox> result;
  for (std::size_t k = 0; k < proved.size(); ++k) {
    const DyadicBox& box = proved[k];
    if (!directions.empty()) search.use(*directions[k]);
    if (!search.prove(to_rational(box.lower()), to_rational(box.upper()), result)) return std::nullopt;
  }
  return result;
}

std::optional<KernelBox> Elaborator::one_box(const Segment& segment, const DyadicBox& box, int bits, int parts) const {
  checker::Box asked;
  asked.begin = to_rational(box.lower());
  asked.end = to_rational(box.upper());
  asked.bits = bits;
  asked.parts = parts;
  const auto is_inside = [&](const InnerPose& inner) { return asked.begin < inner.s && asked.end > inner.s; };
  if (std::ranges::any_of(segment.inner_poses, is_inside)) return std::nullopt;
  return Search(*this, segment).attempt(asked);
}

std::optional<std::vector<checker::Box>> Elaborator::motion(const Segment& segment, const Dyadic& begin,
                                                            const Dyadic& end) const {
  std::vector<checker::Box> result;
  if (begin == end) return result;
  if (!Search(*this, segment).show_motion(to_rational(begin), to_rational(end), checker::Ranges::kIgnored, result))
    return std::nullopt;
  return result;
}

void Elaborator::tighten(const std::function<Segment(std::size_t k)>& segment,
                         std::vector<std::vector<KernelBox>>& boxes) const {
  Tightener tightener(*this, segment, boxes);
  tightener.raise([](const KernelBox& x) { return x.tension_N; }, 0.98);
  tightener.raise([](const KernelBox& x) { return x.wrench_scale - 1; }, 0.98);
  tightener.raise([](const KernelBox& x) { return x.length_m; }, 0.998);
  if (problem_.bodies) tightener.raise([](const KernelBox& x) { return x.clearance_m.value(); }, 0.98);
}

std::optional<Witness> Elaborator::witness(const Segment& segment, const PathWitness& found) const {
  Search search(*this, segment);
  if (found.contact) return search.contact(found);
  return found.singular ? search.singular(found) : search.violation(found);
}

// ---- Certificates ---------------------------------------------------------------------------------------------------

void LeastBounds::add(std::span<const KernelBox> boxes) {
  for (const KernelBox& box : boxes) {
    tension_N = std::min(tension_N, box.tension_N);
    length_m = std::min(length_m, box.length_m);
    wrench_scale = std::min(wrench_scale, box.wrench_scale);
    if (box.clearance_m) clearance_m = std::min(clearance_m.value_or(*box.clearance_m), *box.clearance_m);
  }
}

Margins LeastBounds::margins() const { return margins_below(tension_N, length_m, wrench_scale, clearance_m); }

CertificateSegment make_segment(std::vector<KernelBox> boxes) {
  CertificateSegment result;
  if (boxes.empty()) return result;
  LeastBounds least;
  least.add(boxes);
  result.margins = least.margins();
  for (KernelBox& box : boxes) {
    result.boxes.push_back(std::move(box.box));
    if (box.clearance_m) result.directions.push_back(std::move(box.directions));
  }
  return result;
}

namespace {

/// Fills in segments and margins; false where the kernel does not prove some box.
bool confirm_proof(const Elaborator& elaborator, const PathProof& proof, Certificate& certificate) {
  const Path& path = certificate.path;
  std::vector<std::vector<KernelBox>> boxes(proof.segments.size());
  std::atomic<bool> is_confirmed = true;
  tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t k) {
    std::optional<std::vector<KernelBox>> found =
        elaborator.boxes(path.segment(k), proof.segments[k].boxes, proof.segments[k].directions);
    if (!found) is_confirmed = false;
    if (found) boxes[k] = std::move(*found);
  });
  if (!is_confirmed) return false;
  elaborator.tighten([&](std::size_t k) { return path.segment(k); }, boxes);
  LeastBounds least;
  for (std::vector<KernelBox>& of_segment : boxes) {
    least.add(of_segment);
    certificate.segments.push_back(make_segment(std::move(of_segment)));
  }
  certificate.margins = least.margins();
  return true;
}

/// Fills in the witness and, where the motion is implied, the motion from the path's beginning to it; false where the
/// kernel does not prove them.
bool confirm_refutation(const Elaborator& elaborator, const PathWitness& found, Certificate& certificate) {
  const Path& path = certificate.path;
  const bool is_still = path.segments() == 0;
  const std::size_t last = segment_of(found);
  std::optional<Witness> witness = elaborator.witness(path.segment(is_still ? 0 : last), found);
  if (!witness) return false;
  const Dyadic begin{0, 0};
  const Dyadic at = found.at.on_segment ? found.at.s : begin;
  for (std::size_t k = 0; elaborator.is_implied() && !is_still && k <= last; ++k) {
    std::optional<std::vector<checker::Box>> boxes =
        elaborator.motion(path.segment(k), begin, k < last ? Dyadic{1, 0} : at);
    if (!boxes) return false;
    for (checker::Box& box : *boxes) witness->motion.push_back({k, std::move(box)});
  }
  certificate.witness = std::move(*witness);
  return true;
}

OpenPart open_part(const PathProof& proof) {
  OpenPart result{proof.reason.text(), {}, {}};
  if (proof.open_segment >= 0) {
    const DyadicBox& box = proof.segments[static_cast<std::size_t>(proof.open_segment)].open_box;
    result.segment = proof.open_segment;
    result.box = {box.lower(), box.upper()};
  }
  return result;
}

}  // namespace

Certificate elaborate(const Problem& problem, Path path, const PathProof& proof) {
  Certificate result;
  result.problem = problem;
  result.path = std::move(path);
  if (proof.verdict == Verdict::kUndecided) {
    result.undecided = open_part(proof);
    return result;
  }
  const Elaborator elaborator(problem, result.path.interpolation);
  const bool is_confirmed = proof.verdict == Verdict::kProved ? confirm_proof(elaborator, proof, result)
                                                              : confirm_refutation(elaborator, *proof.witness, result);
  if (is_confirmed) {
    result.verdict = proof.verdict;
  } else {
    result.undecided = OpenPart{Reason(Undecided::kKernel).text(), {}, {}};
  }
  return result;
}

}  // namespace taut
