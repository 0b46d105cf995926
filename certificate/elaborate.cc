// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/elaborate.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "certify/arithmetic/rounding.h"
#include "checker/format/cursor.h"
#include "checker/format/exact.h"
#include "checker/format/parts.h"
#include "checker/near_waypoints.h"
#include "kinematics/pose_conversion.h"

namespace taut {
namespace {

using checker::Ball;
using checker::MeanValueForm;

constexpr std::array<int, 7> kBits = {64, 128, 256, 512, 1024, 2048, 4096};
constexpr int kMostAttempts = 20'000;  ///< of one search
constexpr int kMostHalvings = 900;     ///< of [0, 1]: a dyadic's denominator is at most 2^1000

double lower_bound(const Ball& x) { return arf_get_d(arb_midref(lowest(x).get()), ARF_RND_FLOOR); }
double approx(const Ball& x) { return arf_get_d(arb_midref(x.get()), ARF_RND_NEAR); }
double largest(const Ball& x) { return arf_get_d(arb_midref(magnitude(x).get()), ARF_RND_CEIL); }

/// Not below x, with few digits.
double short_above(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return std::ldexp(std::ceil(mantissa * 64) / 64, exponent);
}

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

/// A path of this one segment.
checker::Path to_kernel(const Segment& segment, bool has_constraints) {
  checker::Path path;
  path.law = to_kernel(segment.law);
  for (const Waypoint* control : segment.controls()) {
    path.waypoints.push_back({control->x, control->half_turns, control->normals});
  }
  if (has_constraints) path.tubes = {segment.tube};
  if (segment.law == Interpolation::kCableLengths) {
    path.pose_tubes = {{segment.pose_tube.position, segment.pose_tube.turn}};
    std::vector<checker::InnerPose>& inner = path.inner_poses.emplace_back();
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

// ---- Where implied motions are ---------------------------------------------------------------------------------------

/// Newton's method at u = 0, from y; nothing where it fails.
std::optional<std::vector<double>> newton(const checker::Equations& equations, std::vector<double> y) {
  constexpr int kMostSteps = 25;
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    checker::Vector6<Ball> at;
    checker::Vector6<MeanValueForm> curve;
    for (std::size_t i = 0; i < y.size(); ++i) {
      at[i] = Ball(y[i]);
      curve[i] = MeanValueForm(at[i]);
    }
    checker::Matrix6<Ball> G = equations.jacobian(at);
    for (std::size_t i = y.size(); i < 6; ++i) G[i][i] = Ball(1);
    const checker::Vector6<MeanValueForm> moved = multiply(approximate_inverse(G), equations.residual(curve));
    double size = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double by = approx(moved[i].at);
      y[i] -= by;
      size = std::max(size, std::abs(by));
    }
    if (!(size < 1e3)) return std::nullopt;
    if (size == 0 || (size < 1e-9 && size > last / 2)) return y;  // what is left is rounding
    last = size;
  }
  return last < 1e-9 ? std::optional(y) : std::nullopt;
}

using EquationsOver = std::function<std::unique_ptr<checker::Equations>(const checker::Box&)>;

/// Where the zero is over a box: close to a straight line in u, within a radius that should do.
std::optional<checker::NearZero> near_zero(const EquationsOver& equations_over, const checker::Box& box) {
  const auto zero_at = [&](const mpq_class& s, const std::optional<std::vector<double>>& start) {
    checker::Box place = box;
    place.begin = place.end = s;
    const auto equations = equations_over(place);
    return newton(*equations, start ? *start : std::vector<double>(equations->unknowns(), 0.0));
  };
  const auto middle = zero_at((box.begin + box.end) / 2, std::nullopt);
  if (!middle) return std::nullopt;
  checker::NearZero near;
  near.at = *middle;
  near.slope.assign(middle->size(), 0.0);
  for (int bits = 64; bits < box.bits; bits *= 2) ++near.narrowings;
  if (box.begin < box.end) {
    const auto first = zero_at(box.begin, middle);
    const auto last = zero_at(box.end, middle);
    if (!first || !last) return std::nullopt;
    for (std::size_t i = 0; i < near.at.size(); ++i) {
      near.slope[i] = ((*last)[i] - (*first)[i]) / 2;
      near.at[i] = ((*middle)[i] + ((*first)[i] + (*last)[i]) / 2) / 2;
    }
  }
  const auto equations = equations_over(box);
  checker::Vector6<MeanValueForm> curve;
  checker::Vector6<Ball> range;
  for (std::size_t i = 0; i < near.at.size(); ++i) {
    curve[i] = {Ball(near.at[i]), Ball(near.slope[i])};
    range[i] = curve[i].range();
  }
  const checker::Contraction contraction(*equations, range);
  const checker::Vector6<MeanValueForm> off = multiply(contraction.A, equations->residual(curve));
  double farthest = 0;
  for (std::size_t i = 0; i < near.at.size(); ++i) farthest = std::max(farthest, largest(off[i].range()));
  constexpr double kRoom = 2.5;
  near.radius = short_above(std::max(kRoom * farthest, 0x1p-1000));
  return near;
}

}  // namespace

std::optional<checker::NearZero> find_motion(const checker::Machine& machine, const checker::Problem& problem,
                                             const checker::Path& path, std::size_t k, const checker::Box& box) {
  const auto equations = [&](const checker::Box& over) { return motion_equations(machine, problem, path, k, over); };
  try {
    const checker::WorkingPrecision precision(box.bits);
    return near_zero(equations, box);
  } catch (const checker::Undefined&) {
    return std::nullopt;
  }
}

mpq_class to_rational(const Dyadic& x) {
  mpq_class result(mpz_class(x.k.str()), mpz_class(1) << static_cast<unsigned long>(x.depth));
  result.canonicalize();
  return result;
}

/// Looks for boxes of one segment.
class Elaborator::Search {
 public:
  Search(const Elaborator& elaborator, const Segment& segment)
      : elaborator_(elaborator), path_(to_kernel(segment, !elaborator.problem_.constraints.empty())) {}

  [[nodiscard]] const checker::Path& path() const { return path_; }

  /// Proves [begin, end] into `out`.
  bool prove(const mpq_class& begin, const mpq_class& end, std::vector<KernelBox>& out) {
    return cover(begin, end, [&](const checker::Box& box) {
      const std::optional<KernelBox> proved = attempt(box);
      if (proved && box.begin < box.end) out.push_back(*proved);
      return proved.has_value();
    });
  }

  bool show_motion(const mpq_class& begin, const mpq_class& end, checker::Ranges ranges,
                   std::vector<checker::Box>& out) {
    return cover(begin, end, [&](checker::Box box) {
      if (!place_motion(box)) return false;
      const checker::Machine& machine = elaborator_.machine(box.bits);
      try {
        const checker::WorkingPrecision precision(box.bits);
        (void)commanded_geometry(machine, elaborator_.problem_, path_, 0, box, ranges);
        require_near_waypoints(machine, elaborator_.problem_, path_, 0, box);
      } catch (const checker::Undefined&) {
        return false;
      }
      if (box.begin < box.end) out.push_back(box);
      return true;
    });
  }

  /// The kernel's proof of one box at one go, positive.
  std::optional<KernelBox> attempt(checker::Box box) {
    ++attempts_;
    if (!place_motion(box)) return std::nullopt;
    for (const int guesses : {1, 2, 4, 12}) {
      box.guesses = guesses;
      try {
        const checker::Machine& machine = elaborator_.machine(box.bits);
        const checker::WorkingPrecision precision(box.bits);
        const checker::Bounds bounds = prove_box(machine, elaborator_.problem_, path_, 0, box);
        require_near_waypoints(machine, elaborator_.problem_, path_, 0, box);
        const KernelBox result{box, lower_bound(bounds.tension), lower_bound(bounds.length),
                               lower_bound(bounds.wrench_scale)};
        if (result.tension_N > 0 && result.length_m > 0 && result.wrench_scale >= 1) return result;
        return std::nullopt;
      } catch (const checker::Undefined&) {
        if (!elaborator_.has_tolerances()) return std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// Where the motion is, if it is implied.
  bool place_motion(checker::Box& box) {
    if (!elaborator_.is_implied_) return true;
    box.near = find_motion(elaborator_.machine(box.bits), elaborator_.problem_, path_, 0, box);
    return box.near.has_value();
  }

 private:
  struct Task {
    mpq_class begin, end;
    std::size_t rung = 0;
    int parts = 1;
    int halvings = 0;
  };

  template <class Try>
  bool cover(const mpq_class& begin, const mpq_class& end, const Try& succeeds) {
    constexpr int kMostWayParts = 64;
    constexpr int kPatience = 4;
    const bool has_tolerances = elaborator_.has_tolerances();
    std::vector<Task> open;
    mpq_class at = begin;
    if (!path_.inner_poses.empty()) {  // no box reaches across one
      for (const checker::InnerPose& inner : path_.inner_poses[0]) {
        if (inner.s <= at || inner.s >= end) continue;
        open.push_back({at, inner.s});
        at = inner.s;
      }
    }
    open.push_back({at, end});
    std::ranges::reverse(open);
    attempts_ = 0;
    while (!open.empty()) {
      if (++attempts_ > kMostAttempts) return false;
      Task task = open.back();
      open.pop_back();
      const auto box = [&](const mpq_class& from, const mpq_class& to) {
        checker::Box result;
        result.begin = from;
        result.end = to;
        result.bits = kBits[task.rung];
        result.parts = task.parts;
        return result;
      };
      if (succeeds(box(task.begin, task.end))) continue;
      const mpq_class middle = (task.begin + task.end) / 2;
      // Where halving has not helped a few times it may be rounding, or what deviations take, that stands in the way.
      if (task.halvings >= kPatience) {
        const Task before = task;
        task.halvings = 0;
        if (has_tolerances && task.parts < kMostWayParts) task.parts *= 4;
        if (task.rung + 1 < kBits.size()) ++task.rung;
        if (succeeds(box(task.begin, task.end))) continue;
        if (!has_tolerances) task = before;
      }
      if (task.begin < task.end && task.halvings < kMostHalvings && succeeds(box(middle, middle))) {
        ++task.halvings;
        open.push_back({middle, task.end, task.rung, task.parts, task.halvings});
        open.push_back({task.begin, middle, task.rung, task.parts, task.halvings});
      } else if (has_tolerances && task.parts < kMostWayParts) {
        task.parts *= 4;
        open.push_back(task);
      } else if (task.rung + 1 < kBits.size()) {
        ++task.rung;
        open.push_back(task);
      } else {
        return false;
      }
    }
    return true;
  }

  rounding_detail::NearestGuard nearest_;  ///< so that guesses are the same whatever mode the caller has
  const Elaborator& elaborator_;
  checker::Path path_;
  int attempts_ = 0;
};

namespace {

checker::Problem to_kernel(const Problem& problem) {
  const nlohmann::json json = to_json(problem);
  return checker::read_problem(checker::Cursor(json, "problem"));
}

}  // namespace

Elaborator::Elaborator(const Problem& problem, Interpolation law)
    : problem_(to_kernel(problem)), law_(law), approx_(make_model<double>(problem)) {
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

std::optional<std::vector<KernelBox>> Elaborator::boxes(const Segment& segment,
                                                        std::span<const DyadicBox> proved) const {
  Search search(*this, segment);
  std::vector<KernelBox> result;
  for (const DyadicBox& box : proved) {
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
  constexpr int kMostSplits = 64;
  constexpr double kEnough = 0.5;
  int splits = 0;
  using Bound = double (*)(const KernelBox&);
  for (const Bound bound : {Bound([](const KernelBox& x) { return x.tension_N; }),
                            Bound([](const KernelBox& x) { return x.wrench_scale - 1; }),
                            Bound([](const KernelBox& x) { return x.length_m; })}) {
    const auto less = [&](const KernelBox& a, const KernelBox& b) { return bound(a) < bound(b); };
    double found = std::numeric_limits<double>::infinity();  // at midpoints
    while (splits < kMostSplits) {
      const auto worst_of = [&](const std::vector<KernelBox>& x) { return std::ranges::min_element(x, less); };
      const auto segment_less = [&](const auto& a, const auto& b) {
        if (a.empty() || b.empty()) return !a.empty();
        return less(*worst_of(a), *worst_of(b));
      };
      const auto least = std::ranges::min_element(boxes, segment_less);
      if (least == boxes.end() || least->empty()) return;
      const auto worst = least->begin() + (worst_of(*least) - least->begin());
      Search search(*this, segment(static_cast<std::size_t>(least - boxes.begin())));
      checker::Box point = worst->box;
      point.begin = point.end = (worst->box.begin + worst->box.end) / 2;
      const std::optional<KernelBox> there = search.attempt(point);
      if (!there) break;
      found = std::min(found, bound(*there));
      if (!(bound(*worst) < kEnough * found)) break;
      std::vector<KernelBox> halves;
      if (!search.prove(worst->box.begin, point.begin, halves) || !search.prove(point.begin, worst->box.end, halves)) {
        break;
      }
      ++splits;
      const auto after = least->erase(worst);
      least->insert(after, halves.begin(), halves.end());
    }
  }
}

namespace {

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

RigidPose rigid_pose(const checker::Frame& frame) {
  RigidPose result;
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) {
    result.p(i) = approx(frame.p[static_cast<std::size_t>(i)].at);
    for (int j = 0; j < 3; ++j) {
      R(i, j) = approx(frame.R[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].at);
    }
  }
  result.q = Eigen::Quaterniond(R).normalized();
  return result;
}

/// Follows a deviation as it grows, by floating point and the kernel in turn.
class Way {
 public:
  Way(const checker::Machine& machine, const checker::Geometry& stated, Model<double> model,
      checker::WitnessDeviation& by, int bits)
      : machine_(machine), stated_(stated), model_(std::move(model)), by_(by), bits_(bits) {}

  /// Fills in poses and boxes.
  bool follow() {
    constexpr int kMostStepHalvings = 8;
    RigidPose here = rigid_pose(stated_.pose);
    by_.poses = {inner_pose(0, here)};
    by_.boxes.clear();
    mpq_class tau = 0;
    int halvings = 0;
    while (tau < 1) {
      mpq_class next = tau + mpq_class(1, 1 << halvings);
      if (next > 1) next = 1;
      const std::optional<RigidPose> there = pose_at(next, here);
      if (there && show(tau, next, *there)) {
        tau = next;
        here = *there;
      } else if (++halvings > kMostStepHalvings) {
        return false;
      }
    }
    return show_end();
  }

 private:
  static checker::InnerPose inner_pose(const mpq_class& tau, const RigidPose& pose) {
    return {tau, {pose.p(0), pose.p(1), pose.p(2), pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()}, {}};
  }

  std::optional<RigidPose> pose_at(const mpq_class& tau, const RigidPose& start) const {
    Model<double> model = model_;
    std::array<double, kCables> lengths{};
    const double part = tau.get_d();
    for (std::size_t i = 0; i < kCables; ++i) {
      lengths[i] = approx(stated_.length[i].at) + part * (*by_.cable_lengths)[i].get_d();
      for (std::size_t c = 0; c < 3; ++c) {
        model.p_WA[i](static_cast<Eigen::Index>(c)) += part * by_.base_anchors[i][c].get_d();
        model.p_PB[i](static_cast<Eigen::Index>(c)) += part * by_.platform_anchors[i][c].get_d();
      }
    }
    std::optional<RigidPose> result = pose_of_lengths(model, lengths, start);
    if (result && result->q.dot(start.q) < 0) result->q.coeffs() = -result->q.coeffs();
    return result;
  }

  /// One box from tau to `next`, in the widest tube of some in which the kernel finds exactly one pose.
  bool show(const mpq_class& tau, const mpq_class& next, const RigidPose& there) {
    constexpr int kNarrowest = 34;
    by_.poses.push_back(inner_pose(next, there));
    for (int k = 3; k < kNarrowest; k += 2) {
      checker::PoseTube& tube = by_.poses[by_.poses.size() - 2].tube;
      tube.turn = std::ldexp(1.0, -k);
      tube.position = short_above(model_.characteristic_length) * tube.turn;
      if (add_box(tau, next)) return true;
    }
    by_.poses.pop_back();
    return false;
  }

  /// At tau = 1 alone, where the pose is known best.
  bool show_end() {
    by_.poses.back().tube = by_.poses[by_.poses.size() - 2].tube;
    return add_box(1, 1);
  }

  bool add_box(const mpq_class& begin, const mpq_class& end) {
    checker::Box box;
    box.begin = begin;
    box.end = end;
    box.bits = bits_;
    const auto equations = [&](const checker::Box& over) {
      return motion_equations(growing_deviation(machine_, stated_, by_, over));
    };
    try {
      box.near = near_zero(equations, box);
      if (!box.near) return false;
      (void)forward_kinematics(growing_deviation(machine_, stated_, by_, box), *box.near);
    } catch (const checker::Undefined&) {
      return false;
    }
    by_.boxes.push_back(std::move(box));
    return true;
  }

  const checker::Machine& machine_;
  const checker::Geometry& stated_;
  Model<double> model_;
  checker::WitnessDeviation& by_;
  int bits_;
};

}  // namespace

bool find_way(const checker::Machine& machine, const checker::Geometry& stated, const Model<double>& model,
              checker::WitnessDeviation& deviation, int bits) {
  return Way(machine, stated, model, deviation, bits).follow();
}

namespace {

checker::WitnessKind to_kernel(const PathWitness& found) {
  if (found.singular) return checker::WitnessKind::kSingular;
  switch (found.margin.kind) {
    case MarginKind::kTensionMin: return checker::WitnessKind::kTensionMin;
    case MarginKind::kTensionMax: return checker::WitnessKind::kTensionMax;
    case MarginKind::kLengthMin: return checker::WitnessKind::kLengthMin;
    case MarginKind::kLengthMax: break;
  }
  return checker::WitnessKind::kLengthMax;
}

}  // namespace

std::optional<KernelWitness> Elaborator::witness(const Segment& segment, const PathWitness& found) const {
  Search search(*this, segment);
  KernelWitness result;
  checker::Witness& witness = result.witness;
  witness.kind = to_kernel(found);
  // On a segment, or at one of its ends: a waypoint is s = 0 of the segment that is given.
  const auto place = [](const PathPoint& point) { return point.on_segment ? to_rational(point.s) : mpq_class(0); };
  witness.at = {0, place(found.at)};
  for (const int bits : kBits) {
    const auto placed = [&](const mpq_class& s) {
      checker::Box box;
      box.begin = box.end = s;
      box.bits = bits;
      return search.place_motion(box) ? std::optional(box) : std::nullopt;
    };
    try {
      const checker::Machine& machine = this->machine(bits);
      const std::optional<checker::Box> at_box = placed(witness.at.s);
      if (!at_box) continue;
      witness.at_box = *at_box;
      const checker::WorkingPrecision precision(bits);
      if (found.singular) {
        witness.to = {0, place(found.to)};
        const std::optional<checker::Box> to_box = placed(witness.to.s);
        if (!to_box) continue;
        witness.to_box = *to_box;
        const Ball product = determinant_at(machine, problem_, search.path(), witness.at, witness.at_box) *
                             determinant_at(machine, problem_, search.path(), witness.to, witness.to_box);
        if (!certainly_negative(product)) continue;
        std::vector<checker::Box> between;
        if (!search.show_motion(witness.at.s, witness.to.s, checker::Ranges::kRequired, between)) return std::nullopt;
        for (checker::Box& box : between) witness.motion.push_back({0, std::move(box)});
        return result;
      }
      witness.cable = static_cast<std::size_t>(found.margin.cable);
      if (found.deviation) {
        witness.deviation = to_kernel(*found.deviation);
        if (witness.deviation->leads_away()) {
          const checker::Geometry stated = commanded_geometry(machine, problem_, search.path(), 0, witness.at_box);
          if (!find_way(machine, stated, approx_, *witness.deviation, bits)) continue;
        }
      }
      // With some room for rounding: the checker sees the segment as a part of the path.
      const Ball exact_value = witnessed_quantity(machine, problem_, search.path(), witness);
      const Ball rounding = Ball::make([bits](arb_ptr r) {
        arb_set_ui(r, 1);
        arb_mul_2exp_si(r, r, 12 - bits);
      });
      const Ball seen = plus_minus(exact_value, rounding * magnitude(exact_value));
      const bool is_lower =
          witness.kind == checker::WitnessKind::kTensionMin || witness.kind == checker::WitnessKind::kLengthMin;
      const mpq_class limit = exact(found.limit);
      const auto value = decimals(seen, [&](const mpq_class& below, const mpq_class& above) {
        return is_lower ? above <= limit : below >= limit;
      });
      if (!value) continue;
      std::tie(result.value_lower, result.value_upper) = *value;
      witness.value_lower = exact(result.value_lower);
      witness.value_upper = exact(result.value_upper);
      return result;
    } catch (const checker::Undefined&) {
      continue;
    }
  }
  return std::nullopt;
}

KernelSegment make_segment(std::vector<KernelBox> boxes) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double tension_N = kNone;
  double length_m = kNone;
  double wrench_scale = kNone;
  for (const KernelBox& box : boxes) {
    tension_N = std::min(tension_N, box.tension_N);
    length_m = std::min(length_m, box.length_m);
    wrench_scale = std::min(wrench_scale, box.wrench_scale);
  }
  return {std::move(boxes), tension_N == kNone ? Margins{} : margins_below(tension_N, length_m, wrench_scale)};
}

std::size_t segment_of(const PathWitness& witness) { return static_cast<std::size_t>(witness.at.index); }

namespace {

KernelProof not_confirmed() {
  KernelProof result;
  result.reason = Undecided::kKernel;
  return result;
}

KernelProof confirmed_proof(const Elaborator& elaborator, const Path& path, const PathProof& proof) {
  std::vector<std::vector<KernelBox>> boxes(proof.segments.size());
  std::atomic<bool> is_confirmed = true;
  tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t k) {
    std::optional<std::vector<KernelBox>> found = elaborator.boxes(path.segment(k), proof.segments[k].boxes);
    if (!found) is_confirmed = false;
    if (found) boxes[k] = std::move(*found);
  });
  if (!is_confirmed) return not_confirmed();
  elaborator.tighten([&](std::size_t k) { return path.segment(k); }, boxes);
  KernelProof result;
  result.verdict = Verdict::kProved;
  std::vector<KernelBox> all;
  for (std::vector<KernelBox>& of_segment : boxes) {
    all.insert(all.end(), of_segment.begin(), of_segment.end());
    result.segments.push_back(make_segment(std::move(of_segment)));
  }
  result.margins = make_segment(std::move(all)).margins;
  return result;
}

/// The witness, and the motion from the path's beginning to it where the motion is implied.
KernelProof confirmed_refutation(const Elaborator& elaborator, const Path& path, const PathWitness& witness) {
  const std::size_t last = segment_of(witness);
  const bool is_still = path.segments() == 0;
  const Segment segment = path.segment(is_still ? 0 : last);
  KernelProof result;
  result.witness = elaborator.witness(segment, witness);
  if (!result.witness) return not_confirmed();
  result.verdict = Verdict::kRefuted;
  if (!elaborator.is_implied() || is_still) return result;
  std::vector<checker::MotionBox>& motion = result.witness->witness.motion;
  const Dyadic begin{0, 0};
  const Dyadic at = witness.at.on_segment ? witness.at.s : begin;
  for (std::size_t k = 0; k <= last; ++k) {
    std::optional<std::vector<checker::Box>> boxes =
        elaborator.motion(path.segment(k), begin, k < last ? Dyadic{1, 0} : at);
    if (!boxes) return not_confirmed();
    // The kernel's witness counts segments from that of the witness: see to_json().
    for (checker::Box& box : *boxes) motion.push_back({k - last, std::move(box)});
  }
  return result;
}

}  // namespace

KernelProof confirmed(const Problem& problem, const Path& path, const PathProof& proof) {
  if (proof.verdict != Verdict::kUndecided) {
    const Elaborator elaborator(problem, path.interpolation);
    return proof.verdict == Verdict::kProved ? confirmed_proof(elaborator, path, proof)
                                             : confirmed_refutation(elaborator, path, *proof.witness);
  }
  KernelProof result;
  result.reason = proof.reason;
  return result;
}

}  // namespace taut
