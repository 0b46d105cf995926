// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/cell_proof.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "certify/bodies/nearest.h"
#include "certify/box_proof.h"
#include "certify/motion/forms_in_lanes.h"
#include "map/cell_inverse.h"

namespace taut {
namespace {

constexpr std::array<MarginId, 4 * kCables> kMargins = all_margins();

/// The number of a margin in all_margins().
constexpr std::size_t number(MarginKind kind, std::size_t cable) {
  return static_cast<std::size_t>(kind) * kCables + cable;
}
constexpr bool is_numbered_by_kind() {
  for (std::size_t n = 0; n < kMargins.size(); ++n) {
    if (number(kMargins[n].kind, static_cast<std::size_t>(kMargins[n].cable)) != n) return false;
  }
  return true;
}
static_assert(is_numbered_by_kind());

constexpr std::uint64_t kAllMargins = (std::uint64_t{1} << kMargins.size()) - 1;
static_assert(CellVerdict::kFirstPairBit == kMargins.size());

/// What proposes directions and points for pairs of bodies.
struct BodyProposer {
  explicit BodyProposer(const Problem& problem)
      : bodies(problem), model(make_model_without_ellipsoid<double>(problem)) {}

  BodySampler bodies;
  Model<double> model;
};

/// The problem ready for cells of N coordinates.
template <std::size_t N>
struct CellModel {
  ProofModel<Interval> proof;
  Evaluator<CellForm<N>> pose;
  std::array<Interval, N> lower, extent;   ///< λ_k = lower_k + t_k extent_k
  std::optional<BodyProposer> proposer;    ///< where the problem has bodies
  std::uint64_t all_proved = kAllMargins;  ///< CellVerdict::proved where the machine as typed is feasible
};

std::uint64_t pair_bit(std::size_t pair) {
  return std::uint64_t{1} << (CellVerdict::kFirstPairBit + pair % CellVerdict::kPairBits);
}

template <std::size_t N>
CellModel<N> make_cell_model(const Problem& problem, const MapSpace& space) {
  CellModel<N> model{make_proof_model(problem), Evaluator<CellForm<N>>(pose_tape(problem)), {}, {}, {}};
  if (problem.bodies) {
    model.proposer.emplace(problem);
    const std::size_t pairs = model.proof.bodies->pairs.size();
    for (std::size_t n = 0; n < pairs; ++n) model.all_proved |= pair_bit(n);
  }
  const bool is_bounded = run_upward([&] {
    for (std::size_t k = 0; k < N; ++k) {
      model.lower[k] = evaluate_constant<Interval>(space.axes[k].lower);
      model.extent[k] = evaluate_constant<Interval>(space.axes[k].upper) - model.lower[k];
    }
  });
  if (!is_bounded) throw InputError("space: got a range whose ends are beyond the range of binary64, or not defined");
  return model;
}

template <std::size_t N>
const lanes::BoxKernel<static_cast<int>(N)>& cell_kernel() {
  if constexpr (N == 2) {
    return lanes::kernels().cell_of_two;
  } else {
    return lanes::kernels().cell_of_three;
  }
}

/// Of deviations (certify/tolerance/tolerance.h).
constexpr int kContinuationSteps = 1;
/// Cells so small are not halved further where deviations can't be bounded even at their midpoints.
constexpr int kManyHalvings = 14;

/// How far a deviation may change a margin.
double change_of(MarginId margin, const DeviationBounds<Interval>& change) {
  const auto i = static_cast<std::size_t>(margin.cable);
  switch (margin.kind) {
    case MarginKind::kTensionMin: return change.tension[i][0];
    case MarginKind::kTensionMax: return change.tension[i][1];
    case MarginKind::kLengthMin:
    case MarginKind::kLengthMax: break;
  }
  return change.length[i];
}

/// The axis that was halved least.
template <std::size_t N>
std::uint8_t widest_axis(const Cell& cell) {
  return static_cast<std::uint8_t>(std::min_element(cell.depth.begin(), cell.depth.begin() + N) - cell.depth.begin());
}

/// The judgement of one cell.
template <std::size_t N>
class Judgement {
 public:
  using Form = CellForm<N>;

  enum class Extent { kCell, kMidpoint };

  Judgement(const CellModel<N>& problem, const Cell& cell, CellVerdict& verdict, Extent extent = Extent::kCell)
      : problem_(problem), model_(problem.proof.model), cell_(cell), verdict_(verdict) {
    for (std::size_t k = 0; k < N; ++k) {
      radius_[k] = extent == Extent::kCell ? cell.radius(k) : 0;
      offset_[k] = Interval(-radius_[k], radius_[k]);
      Form& x = parameters_[k];
      const Interval mid(cell.mid(k));
      x.at_mid = problem.lower[k] + mid * problem.extent[k];
      x.range = problem.lower[k] + (mid + offset_[k]) * problem.extent[k];
      x.slope = Gradient<Interval, N>(0.0);
      x.slope[k] = problem.extent[k];
    }
  }

  /// Encloses what deviations() takes. @returns whether J is non-singular
  bool enclose_all() {
    enclose_pose();
    enclose_geometry();
    if (!inverse_.set(geometry_.force_density, radius_) || !inverse_.is_regular()) return false;
    prepare_columns();
    return true;
  }
  /// What deviations may change. @pre enclose_all(), or what decide() does before it asks
  [[nodiscard]] std::optional<DeviationBounds<Interval>> deviations() const;

  void decide() {
    enclose_pose();
    if (problem_.proof.lanes && model_.loads.empty() && !problem_.proof.tolerance) {
      decide_in_lanes();
      return;
    }
    enclose_geometry();
    if (is_outside_by_length()) return;
    if (!inverse_.set(geometry_.force_density, radius_)) {
      verdict_.axis = widest_axis<N>(cell_);
      return;
    }
    verdict_.regular = inverse_.is_regular();
    prepare_columns();
    if (inverse_.is_regular() && is_outside_by_tension()) return;
    if (!are_proved(kAllMargins) && is_unbalanced()) return;
    if (is_decided_by_bodies()) return;
    if (is_inside()) return;
    suggest_axis([&](std::size_t axis) { return inverse_.reach(axis); });
  }

 private:
  using LanesBox = lanes::Box<static_cast<int>(N)>;

  /// decide() for a machine with neither items nor tolerances, for all cables at once (certify/lanes).
  void decide_in_lanes();
  bool is_outside_by_tension(LanesBox& box);
  bool is_unbalanced(const LanesBox& box);
  /// Numbers in which the wrench of the kernel is.
  using LanesWrench = lanes::Ends[6];
  void set_wrench(LanesWrench& wrench) const {
    for (int j = 0; j < 6; ++j) wrench[j] = lanes_detail::ends(model_.wrench(j));
  }
  /// What a cable's force density may be within limits, where lengths are within theirs. @returns false where a length
  /// is beyond them: then there is nothing to show
  [[nodiscard]] bool set_densities(std::array<Interval, kCables>& density) const;

  [[nodiscard]] bool is_proved(std::size_t margin) const { return (verdict_.proved >> margin & 1U) != 0; }
  [[nodiscard]] bool are_proved(std::uint64_t bits) const { return (verdict_.proved & bits) == bits; }
  void end(CellKind kind, std::size_t reason) {
    verdict_.kind = kind;
    verdict_.reason = static_cast<std::uint16_t>(reason);
  }

  void enclose_pose();
  void enclose_geometry();
  bool is_outside_by_length();
  void prepare_columns();
  bool is_outside_by_tension();
  bool is_unbalanced();
  bool is_decided_by_bodies();
  bool is_inside();
  /// @param reach  how much the cell's extent along an axis adds to the row sums of N
  template <class F>
  void suggest_axis(const F& reach);

  /// Notes what is known of a margin. @returns whether it is not positive on all of the cell.
  bool examine(std::size_t margin, const Form& value) {
    if (certainly_nonpositive(value.range)) return true;
    if (certainly_positive(value.range)) {
      verdict_.proved |= std::uint64_t{1} << margin;
    } else {
      weigh(value);
    }
    return false;
  }
  /// Adds to how much halving along each axis would help: by how much a margin changes, over its own size.
  void weigh(const Form& value) {
    std::array<double, N> change;
    double total = 0;
    for (std::size_t k = 0; k < N; ++k) total += change[k] = radius_[k] * magnitude(value.slope[k]);
    for (std::size_t k = 0; k < N && total > 0; ++k) weight_[k] += change[k] / total;
  }

  /// Force densities λ_i = (D^-1 w)_i of one cable over the cell, for all wrenches of K.
  struct Density {
    bool is_enclosed = false;
    Form nominal, below, above;      ///< of the nominal wrench, and how far K moves it
    std::array<Interval, 6> root{};  ///< row Z_i of D^-1 L, of the ellipsoid
    Form radius{0.0};                ///< |Z_i|
  };
  [[nodiscard]] Density density(std::size_t i) const;
  void add_items(const Vector6<Form>& y, Density& density) const;
  /// f_i − f_lo and f_hi − f_i of the least and the greatest tension.
  [[nodiscard]] std::array<Form, 2> tension_margins(std::size_t i, const Density& density) const;
  [[nodiscard]] bool holds_for_deviations();

  using Gaps = BodyGaps<Interval, Gradient<Interval, N>>;
  using Gap = GapBound<Interval, Gradient<Interval, N>>;
  [[nodiscard]] BodiesBox<Interval, Gradient<Interval, N>> bodies_box(const DeviationBounds<Interval>* change) const {
    return {*problem_.proof.bodies,
            model_,
            p_WP_,
            r_WP_,
            length_,
            offset_,
            change != nullptr ? &*problem_.proof.tolerance : nullptr,
            change};
  }
  /// The pose in the middle of the cell, in floating point.
  [[nodiscard]] RigidPose middle_pose() const;
  /// Whether a pair is shown to be apart, for every deviation that `gaps` knows of. @param best  if not: the best bound
  [[nodiscard]] bool is_apart(const Gaps& gaps, std::size_t pair, const RigidPose& pose,
                              std::optional<Gap>& best) const;
  [[nodiscard]] bool is_touching(const Gaps& gaps, std::size_t pair, const RigidPose& pose) const;
  /// Whether all pairs are apart for these deviations. @param at_mid  what is known at the midpoint alone, if it is
  [[nodiscard]] bool are_apart(const DeviationBounds<Interval>& change, const DeviationBounds<Interval>* at_mid);

  /// The values that y·w takes over K at one pose, for y row i of C: from at most `least` to at least `greatest`.
  struct Work {
    double least, greatest;
  };
  [[nodiscard]] Work work(std::size_t i) const;

  const CellModel<N>& problem_;
  const Model<Interval>& model_;
  const Cell& cell_;
  CellVerdict& verdict_;
  std::array<double, N> radius_;
  Gradient<Interval, N> offset_;
  std::array<Form, N> parameters_;
  std::array<double, N> weight_{};

  Vector3<Form> p_WP_;
  Matrix3<Form> r_WP_;
  CableGeometry<Form> geometry_;
  std::array<Form, kCables> length_;
  CellInverse<N> inverse_;
  LoadsAtPose<Form> loads_;
  Vector6<Interval> wrench_;  ///< the nominal one near the midpoint, a constant
  Vector6<Form> remaining_;   ///< what the nominal wrench is more than that; of items only
  CellColumns<7> columns_;    ///< C w and C L; without an ellipsoid, C w and C
  CellColumns<6> identity_;   ///< C; only with both items and an ellipsoid
};

template <std::size_t N>
void Judgement<N>::enclose_pose() {
  const Pose<Form> pose = evaluate_pose(problem_.pose, std::span<const Form>(parameters_));
  p_WP_ = pose.p_WP;
  r_WP_ = rotation(model_.angles, pose.angles);
  for (int i = 0; i < 3; ++i) {
    p_WP_(i).tighten(offset_);
    for (int j = 0; j < 3; ++j) r_WP_(i, j).tighten(offset_);
  }
}

template <std::size_t N>
void Judgement<N>::enclose_geometry() {
  geometry_ = cable_geometry(model_, p_WP_, r_WP_);
  for (std::size_t i = 0; i < kCables; ++i) {
    length_[i] = length(geometry_.p_AB_W[i]);
    length_[i].tighten(offset_);
  }
}

template <std::size_t N>
bool Judgement<N>::is_outside_by_length() {
  for (std::size_t i = 0; i < kCables; ++i) {
    const std::size_t least = number(MarginKind::kLengthMin, i), most = number(MarginKind::kLengthMax, i);
    if (!is_proved(least) && examine(least, length_[i] - model_.length_lower[i])) {
      end(CellKind::kLength, least);
      return true;
    }
    if (!is_proved(most) && examine(most, -length_[i] + model_.length_upper[i])) {
      end(CellKind::kLength, most);
      return true;
    }
  }
  return false;
}

template <std::size_t N>
void Judgement<N>::prepare_columns() {
  wrench_ = model_.wrench;
  if (!model_.loads.empty()) {
    loads_ = loads_at(model_.loads, r_WP_);
    for (int j = 0; j < 6; ++j) {
      const Interval near(midpoint_approx(loads_.nominal(j).at_mid));
      wrench_(j) = wrench_(j) + near;
      remaining_(j) = loads_.nominal(j) - near;
    }
  }
  const Matrix6<double>& c = inverse_.c();
  for (std::size_t i = 0; i < 6; ++i) {
    const int row = static_cast<int>(i);
    Interval sum(0.0);
    for (int l = 0; l < 6; ++l) sum = sum + c(row, l) * wrench_(l);
    columns_.value[i][0] = sum;
    for (int j = 0; j < 6; ++j) {
      const auto column = static_cast<std::size_t>(j);
      identity_.value[i][column] = Interval(c(row, j));
      Interval& entry = columns_.value[i][column + 1];
      entry = Interval(c(row, j));
      if (!model_.has_ellipsoid) continue;
      entry = c(row, j) * model_.ellipsoid_root(j, j);
      for (int l = 0; l < j && !model_.ellipsoid_is_diagonal; ++l) {
        entry = entry + c(row, l) * model_.ellipsoid_root(l, j);
      }
    }
  }
  columns_.finish();
  if (model_.has_ellipsoid && !model_.loads.empty()) identity_.finish();
}

template <std::size_t N>
auto Judgement<N>::density(std::size_t i) const -> Density {
  std::array<Form, 7> forms;
  inverse_.row(i, columns_, forms);
  Density result;
  result.nominal = forms[0];
  if (model_.has_ellipsoid) {
    Form square(0.0);
    for (std::size_t j = 1; j < 7; ++j) {
      square = square + sqr(forms[j]);
      result.root[j - 1] = forms[j].range;
    }
    square.tighten(offset_);
    if (!certainly_positive(square.range)) return result;  // the cell is too wide
    result.radius = sqrt(square);
    result.radius.tighten(offset_);
  } else {
    result.root.fill(Interval(0.0));
  }
  result.below = result.above = result.radius;
  if (!model_.loads.empty()) {
    std::array<Form, 6> rows;
    if (model_.has_ellipsoid) {
      inverse_.row(i, identity_, rows);
    } else {
      std::copy(forms.begin() + 1, forms.end(), rows.begin());
    }
    Vector6<Form> y;
    for (int j = 0; j < 6; ++j) y(j) = rows[static_cast<std::size_t>(j)];
    for (int j = 0; j < 6; ++j) result.nominal = result.nominal + y(j) * remaining_(j);
    result.nominal.tighten(offset_);
    add_items(y, result);
  }
  result.is_enclosed = true;
  return result;
}

template <std::size_t N>
void Judgement<N>::add_items(const Vector6<Form>& y, Density& density) const {
  const DensityRange<Form> range = density_range(model_.loads, loads_, y);
  density.below = density.below + range.below;
  density.above = density.above + range.above;
  density.below.tighten(offset_);
  density.above.tighten(offset_);
}

template <std::size_t N>
auto Judgement<N>::tension_margins(std::size_t i, const Density& density) const -> std::array<Form, 2> {
  Form low = length_[i] * (density.nominal - density.below);
  Form high = length_[i] * (density.nominal + density.above);
  low.tighten(offset_);
  high.tighten(offset_);
  return {low - model_.tension_lower[i], -high + model_.tension_upper[i]};
}

template <std::size_t N>
bool Judgement<N>::is_outside_by_tension() {
  for (std::size_t i = 0; i < kCables; ++i) {
    const std::array<std::size_t, 2> both = {number(MarginKind::kTensionMin, i), number(MarginKind::kTensionMax, i)};
    if (is_proved(both[0]) && is_proved(both[1])) continue;
    const Density here = density(i);
    if (!here.is_enclosed) continue;
    const std::array<Form, 2> margins = tension_margins(i, here);
    for (std::size_t side = 0; side < 2; ++side) {
      if (is_proved(both[side]) || !examine(both[side], margins[side])) continue;
      end(CellKind::kTension, both[side]);
      return true;
    }
  }
  return false;
}

/// @pre all else is asked of the machine as typed
template <std::size_t N>
bool Judgement<N>::is_inside() {
  if (!verdict_.regular || !are_proved(problem_.all_proved)) return false;
  if (problem_.proof.tolerance && !holds_for_deviations()) return false;
  end(CellKind::kInside, 0);
  return true;
}

/// Each pose of the cell is taken as a constant that is known as well as the cell is small.
template <std::size_t N>
auto Judgement<N>::deviations() const -> std::optional<DeviationBounds<Interval>> {
  using Constant = SlopeForm<Interval>;
  const auto constant = [](const Form& x) { return Constant(x.range); };
  MotionEnclosure<Interval> motion;
  motion.status = MotionEnclosure<Interval>::Status::kKnown;
  motion.p_WP = p_WP_.unaryExpr(constant);
  motion.r_WP = r_WP_.unaryExpr(constant);
  CableGeometry<Constant> geometry;
  geometry.force_density = geometry_.force_density.unaryExpr(constant);
  std::array<Constant, kCables> lengths, densities, radii;
  Square<Interval> root;
  for (std::size_t i = 0; i < kCables; ++i) {
    geometry.p_AB_W[i] = geometry_.p_AB_W[i].unaryExpr(constant);
    const Density here = density(i);
    if (!here.is_enclosed) return std::nullopt;
    lengths[i] = constant(length_[i]);
    densities[i] = constant(here.nominal);
    radii[i] = constant(here.radius);
    root[i] = here.root;
  }
  const ToleranceModel<Interval>& tolerance = *problem_.proof.tolerance;
  constexpr bool kItemByItem = true;
  const Vector6<Interval> none = Vector6<Interval>::Constant(Interval(0.0));
  return disturbance<Interval>({model_, problem_.proof.item_rows, motion, geometry, lengths, densities, radii, root,
                                inverse_.c(), inverse_.q(), tolerance.lead, model_.wrench, none, kItemByItem},
                               tolerance, kContinuationSteps);
}

/// The bounds of deviations at the midpoint alone, without what the extent of the cell adds to them.
template <std::size_t N>
std::optional<DeviationBounds<Interval>> deviations_at_mid(const CellModel<N>& problem, const Cell& cell) {
  CellVerdict unused;
  Judgement<N> point(problem, cell, unused, Judgement<N>::Extent::kMidpoint);
  return point.enclose_all() ? point.deviations() : std::nullopt;
}

template <std::size_t N>
bool Judgement<N>::holds_for_deviations() {
  const auto bounds = deviations();
  bool holds = bounds.has_value();
  std::array<Form, kMargins.size()> margins;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Density here = density(i);
    if (!here.is_enclosed) return false;  // the cell is too wide
    const std::array<Form, 2> tensions = tension_margins(i, here);
    margins[number(MarginKind::kTensionMin, i)] = tensions[0];
    margins[number(MarginKind::kTensionMax, i)] = tensions[1];
    margins[number(MarginKind::kLengthMin, i)] = length_[i] - model_.length_lower[i];
    margins[number(MarginKind::kLengthMax, i)] = -length_[i] + model_.length_upper[i];
  }
  const auto left = [&](std::size_t margin, const DeviationBounds<Interval>& change) {
    return margins[margin].range - Interval(change_of(kMargins[margin], change));
  };
  for (std::size_t n = 0; bounds && n < margins.size(); ++n) {
    if (certainly_positive(left(n, *bounds))) continue;
    holds = false;
    weigh(margins[n]);
  }
  if (holds && (!problem_.proof.bodies || are_apart(*bounds, nullptr))) return true;
  const auto at_mid = deviations_at_mid(problem_, cell_);
  verdict_.is_tolerance = !at_mid && cell_.halvings() >= kManyHalvings;
  if (at_mid && bounds && problem_.proof.bodies) (void)are_apart(*bounds, &*at_mid);
  for (std::size_t n = 0; at_mid && n < margins.size(); ++n) {
    verdict_.is_tolerance = verdict_.is_tolerance || certainly_nonpositive(left(n, *at_mid));
  }
  return false;
}

// ---- Bodies ---------------------------------------------------------------------------------------------------------

template <std::size_t N>
RigidPose Judgement<N>::middle_pose() const {
  RigidPose pose;
  Matrix3<double> r;
  for (int i = 0; i < 3; ++i) {
    pose.p(i) = midpoint_approx(p_WP_(i).at_mid);
    for (int j = 0; j < 3; ++j) r(i, j) = midpoint_approx(r_WP_(i, j).at_mid);
  }
  pose.q = Eigen::Quaterniond(r).normalized();
  return pose;
}

template <std::size_t N>
bool Judgement<N>::is_apart(const Gaps& gaps, std::size_t pair, const RigidPose& pose, std::optional<Gap>& best) const {
  const auto& [bodies, model] = *problem_.proposer;
  const CheckedPair<Interval>& checked = problem_.proof.bodies->pairs[pair];
  if (gaps.rough(checked, bodies.rough_direction(model, pose, pair)) > 0) return true;
  const std::optional<Direction> direction = bodies.direction(model, pose, pair, Direction::kFine);
  if (!direction) return false;
  best = gaps.along(checked, *direction);
  return certainly_positive(best->disturbed);
}

template <std::size_t N>
bool Judgement<N>::is_touching(const Gaps& gaps, std::size_t pair, const RigidPose& pose) const {
  const auto& [bodies, model] = *problem_.proposer;
  const std::optional<BodySampler::Touching> found = bodies.touching(model, pose, pair);
  if (!found) return false;
  const CheckedPair<Interval>& checked = problem_.proof.bodies->pairs[pair];
  constexpr bool kOnlyAtMid = false;
  if (certainly_nonpositive(gaps.distance(checked, found->nearest, kOnlyAtMid))) return true;
  return found->around && gaps.meet(checked, *found->around);
}

/// Notes which pairs are apart. @returns whether two bodies touch throughout
template <std::size_t N>
bool Judgement<N>::is_decided_by_bodies() {
  if (!problem_.proof.bodies || are_proved(problem_.all_proved & ~kAllMargins)) return false;
  const auto box = bodies_box(nullptr);
  const Gaps gaps(box);
  if (!gaps.have_cables_length()) return false;
  const RigidPose pose = middle_pose();
  const std::size_t pairs = problem_.proof.bodies->pairs.size();
  std::uint64_t near = 0;
  for (std::size_t n = 0; n < pairs; ++n) {
    std::optional<Gap> best;
    if (are_proved(pair_bit(n)) || is_apart(gaps, n, pose, best)) continue;
    near |= pair_bit(n);
    if (best) weigh(best->value);
    if (!is_touching(gaps, n, pose)) continue;
    end(CellKind::kContact, n);
    return true;
  }
  verdict_.proved |= problem_.all_proved & ~kAllMargins & ~near;
  return false;
}

template <std::size_t N>
bool Judgement<N>::are_apart(const DeviationBounds<Interval>& change, const DeviationBounds<Interval>* at_mid) {
  const auto box = bodies_box(&change);
  const Gaps gaps(box);
  if (!gaps.have_cables_length()) return false;
  const auto at_mid_box = bodies_box(at_mid != nullptr ? at_mid : &change);
  const Gaps gaps_at_mid(at_mid_box);
  const RigidPose pose = middle_pose();
  bool all = true;
  for (std::size_t n = 0; n < problem_.proof.bodies->pairs.size(); ++n) {
    std::optional<Gap> best;
    if (is_apart(gaps, n, pose, best)) continue;
    all = false;
    if (best) weigh(best->value);
    if (at_mid == nullptr || !gaps_at_mid.have_cables_length() || is_apart(gaps_at_mid, n, pose, best) || !best)
      continue;
    // What is lost to deviations is no less anywhere on the cell.
    const double lost = lower_bound(best->value.range) - lower_bound(best->disturbed);
    verdict_.is_tolerance = verdict_.is_tolerance || upper_bound(best->value.range) <= lost;
  }
  return all;
}

// ---- Balance --------------------------------------------------------------------------------------------------------

template <std::size_t N>
auto Judgement<N>::work(std::size_t i) const -> Work {
  Form nominal(columns_.value[i][0]);
  Form below(0.0), above(0.0);
  if (model_.has_ellipsoid) {
    Interval square(0.0);
    for (std::size_t j = 1; j < 7; ++j) square = square + sqr(columns_.value[i][j]);
    below = above = Form(sqrt(square));
  }
  if (!model_.loads.empty()) {
    Vector6<Form> y;
    for (int j = 0; j < 6; ++j) {
      const Interval entry(inverse_.c()(static_cast<int>(i), j));
      y(j) = Form(entry);
      nominal = nominal + remaining_(j) * entry;
    }
    nominal.tighten(offset_);
    Density items;
    items.below = below;
    items.above = above;
    add_items(y, items);
    below = items.below;
    above = items.above;
  }
  return {(nominal.range - below.range).upper(), (nominal.range + above.range).lower()};
}

template <std::size_t N>
bool Judgement<N>::set_densities(std::array<Interval, kCables>& density) const {
  for (std::size_t j = 0; j < kCables; ++j) {
    const double least = std::max(length_[j].range.lower(), model_.length_lower[j].lower());
    const double most = std::min(length_[j].range.upper(), model_.length_upper[j].upper());
    if (!(least > 0 && least <= most)) return false;
    density[j] = Interval(model_.tension_lower[j].lower(), model_.tension_upper[j].upper()) / Interval(least, most);
  }
  return true;
}

/// At a pose of the cell that balances every w of K within limits, D λ = w with λ_j = f_j/d_j, and so y·w = Σ_j (y·D_j)
/// λ_j for y row i of C. The greatest y·w over K must not exceed the greatest such sum, nor the least fall below.
template <std::size_t N>
bool Judgement<N>::is_unbalanced() {
  std::array<Interval, kCables> density;
  if (!set_densities(density)) return false;
  for (std::size_t i = 0; i < kCables; ++i) {
    Interval sum(0.0);
    for (std::size_t j = 0; j < kCables; ++j) sum = sum + inverse_.product(i, j) * density[j];
    const Work needed = work(i);
    const bool is_above = needed.greatest > sum.upper();
    if (!is_above && !(needed.least < sum.lower())) continue;
    end(CellKind::kUnbalanced, 2 * i + (is_above ? 0 : 1));
    return true;
  }
  return false;
}

template <std::size_t N>
template <class F>
void Judgement<N>::suggest_axis(const F& reach) {
  if (std::all_of(weight_.begin(), weight_.end(), [](double x) { return !(x > 0); }) || !verdict_.regular) {
    for (std::size_t k = 0; k < N; ++k) weight_[k] = reach(k);
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < N; ++k) {
    if (weight_[k] > weight_[best]) best = k;
  }
  verdict_.axis = static_cast<std::uint8_t>(best);
}

template <std::size_t N>
void Judgement<N>::decide_in_lanes() {
  using lanes::Outcome;
  constexpr int kSlopes = static_cast<int>(N);
  const lanes::BoxKernel<kSlopes>& kernel = cell_kernel<N>();
  lanes::PoseForms<kSlopes> pose = lanes_pose<kSlopes>(p_WP_, r_WP_);
  std::copy(radius_.begin(), radius_.end(), pose.radius);
  LanesBox box;
  if (kernel.enclose_geometry(*problem_.proof.lanes, pose, box) != Outcome::kYes) {
    Faults<Interval>::raise();
    return;
  }
  for (std::size_t i = 0; i < kCables; ++i) set_from_lanes(box.length, i, length_[i]);
  if (is_outside_by_length()) return;
  if (kernel.precondition(box) != Outcome::kYes) {
    verdict_.axis = widest_axis<N>(cell_);
    return;
  }
  verdict_.regular = kernel.bound_inverse(box) == Outcome::kYes;
  if (verdict_.regular && is_outside_by_tension(box)) return;
  if (!are_proved(kAllMargins) && is_unbalanced(box)) return;
  if (is_decided_by_bodies()) return;
  if (is_inside()) return;
  suggest_axis([&](std::size_t axis) {
    double most = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      double sum = 0;
      for (const lanes::Row& column : box.a1_size[axis]) sum += column.x[i];
      most = std::max(most, sum);
    }
    return radius_[axis] * most;
  });
}

template <std::size_t N>
bool Judgement<N>::is_outside_by_tension(LanesBox& box) {
  constexpr std::uint64_t kTensions = (std::uint64_t{1} << 2 * kCables) - 1;
  static_assert(number(MarginKind::kTensionMin, 0) == 0 && number(MarginKind::kTensionMax, 0) == kCables);
  if (!are_proved(kTensions)) {
    LanesWrench wrench;
    set_wrench(wrench);
    if (cell_kernel<N>().enclose_tensions(*problem_.proof.lanes, wrench, box) != lanes::Outcome::kYes) {
      Faults<Interval>::raise();
      return true;
    }
  }
  for (std::size_t i = 0; i < kCables; ++i) {
    const std::array<std::size_t, 2> both = {number(MarginKind::kTensionMin, i), number(MarginKind::kTensionMax, i)};
    for (std::size_t side = 0; side < 2; ++side) {
      if (is_proved(both[side]) || (box.enclosed >> i & 1U) == 0) continue;
      Form tension;
      set_from_lanes(side == 0 ? box.low : box.high, i, tension);
      const Form margin = side == 0 ? tension - model_.tension_lower[i] : -tension + model_.tension_upper[i];
      if (!examine(both[side], margin)) continue;
      end(CellKind::kTension, both[side]);
      return true;
    }
  }
  return false;
}

template <std::size_t N>
bool Judgement<N>::is_unbalanced(const LanesBox& box) {
  std::array<Interval, kCables> density;
  if (!set_densities(density)) return false;
  lanes::Ends densities[kCables];
  for (std::size_t j = 0; j < kCables; ++j) densities[j] = lanes_detail::ends(density[j]);
  LanesWrench wrench;
  set_wrench(wrench);
  lanes::WorkRow work;
  cell_kernel<N>().compare_work(*problem_.proof.lanes, wrench, densities, box, work);
  for (std::size_t i = 0; i < kCables; ++i) {
    const bool is_above = work.greatest.x[i] > work.sum.upper.x[i];
    if (!is_above && !(work.least.x[i] < -work.sum.minus_lower.x[i])) continue;
    end(CellKind::kUnbalanced, 2 * i + (is_above ? 0 : 1));
    return true;
  }
  return false;
}

template <std::size_t N>
class CellProofOf final : public CellProof {
 public:
  CellProofOf(const Problem& problem, const MapSpace& space) : model_(make_cell_model<N>(problem, space)) {}

  [[nodiscard]] CellVerdict judge(const Cell& cell, std::uint64_t proved) const override {
    CellVerdict verdict;
    const bool is_valid = run_upward([&] {
      verdict.proved = proved;
      Judgement<N>(model_, cell, verdict).decide();
    });
    if (is_valid) return verdict;
    verdict = CellVerdict();
    verdict.proved = proved;
    verdict.axis = widest_axis<N>(cell);
    return verdict;
  }

 private:
  CellModel<N> model_;
};

}  // namespace

void require_no_meshes(const Problem& problem) {
  if (!problem.bodies) return;
  for (const auto* list : {&problem.bodies->platform, &problem.bodies->obstacles}) {
    for (const BodyText& body : *list) {
      if (!std::holds_alternative<MeshText>(body.shape)) continue;
      const char* const where = list == &problem.bodies->platform ? "platform" : "obstacles";
      throw FieldError("bodies." + std::string(where) + "[" + body.name + "]", "a mesh",
                       "expected hulls and half-spaces for a map");
    }
  }
}

std::unique_ptr<CellProof> make_cell_proof(const Problem& problem, const MapSpace& space) {
  require_no_meshes(problem);
  switch (space.size()) {
    case 2: return std::make_unique<CellProofOf<2>>(problem, space);
    case 3: return std::make_unique<CellProofOf<3>>(problem, space);
    default: throw std::logic_error("a map of neither two nor three axes");
  }
}

}  // namespace taut
