// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/box_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/input_error.h"
#include "certify/bodies/clear_poses.h"
#include "certify/inverse_bound.h"
#include "certify/motion/forms_in_lanes.h"
#include "certify/motion/length_controlled_motion.h"
#include "certify/motion/pose_in_lanes.h"
#include "certify/row_forms.h"
#include "kinematics/statics.h"

namespace taut {

// ---- Models ---------------------------------------------------------------------------------------------------------

namespace {

/// Intervals are bounded (interval.h), so a number beyond binary64 is refused here.
Interval outward(const MpInterval& x) {
  const double lower = lower_bound(x);
  const double upper = upper_bound(x);
  if (!std::isfinite(lower) || !std::isfinite(upper)) {
    throw InputError("robot, load: got a number beyond the range of binary64");
  }
  return {lower, upper};
}

}  // namespace

ProofModel<MpInterval> make_mp_proof_model(const Problem& problem, const std::optional<Slowing>& slowing) {
  return {make_model<MpInterval>(problem),
          make_motion_model<MpInterval>(problem),
          make_tolerance_model<MpInterval>(problem),
          {},
          {},
          problem.bodies ? std::optional(make_body_model<MpInterval>(problem)) : std::nullopt,
          problem.time ? std::optional<MovingModel<MpInterval>>(std::in_place, problem, slowing) : std::nullopt};
}

ProofModel<Interval> make_proof_model(const Problem& problem, const std::optional<Slowing>& slowing) {
  ProofModel<Interval> result{{}, make_motion_model<Interval>(problem), std::nullopt, {}, {}, {}};
  Model<Interval>& model = result.model;
  const bool is_diagonal = has_diagonal_ellipsoid(problem.load);
  const bool is_bounded = run_upward([&] {
    model = make_model_without_ellipsoid<Interval>(problem);
    result.item_rows = ItemRows(model.loads);
    if (is_diagonal) set_ellipsoid(problem.load, model);
    result.tolerance = make_tolerance_model<Interval>(problem);
    if (problem.bodies) result.bodies = make_body_model<Interval>(problem);
    if (problem.time) result.moving.emplace(problem, slowing);
  });
  if (!is_bounded) throw InputError("robot, load: got a number beyond the range of binary64");
  if (is_diagonal) {
    result.lanes = make_lanes_machine(model);
    return result;
  }

  // E may be so close to singular that binary64 can't tell that it has a root.
  constexpr mpfr_prec_t kEllipsoidPrecision = 256;
  const PrecisionScope precision(kEllipsoidPrecision);
  Model<MpInterval> fine;
  set_ellipsoid(problem.load, fine);
  model.has_ellipsoid = true;
  model.ellipsoid_is_diagonal = false;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      model.ellipsoid(i, j) = outward(fine.ellipsoid(i, j));
      model.ellipsoid_root(i, j) = outward(fine.ellipsoid_root(i, j));
    }
  }
  result.lanes = make_lanes_machine(model);
  return result;
}

// ---- The box --------------------------------------------------------------------------------------------------------

namespace {

/// @pre problem.tolerance
template <class I>
Lead lead(const ProofModel<I>& problem, const Segment& segment) {
  return segment.law == Interpolation::kCableLengths ? Lead::kByAnchors : problem.tolerance->lead;
}

// One kind of margin each, from what is known over a box. A new kind of margin is a new one of these.

template <class I>
void add_length_margins(const Model<I>& model, BoxEnclosure<I>& box) {
  for (std::size_t i = 0; i < kCables; ++i) {
    const int cable = static_cast<int>(i);
    box.margins.add({MarginKind::kLengthMin, cable}, box.length[i] - model.length_lower[i]);
    box.margins.add({MarginKind::kLengthMax, cable}, -box.length[i] + model.length_upper[i]);
  }
}

template <class I>
void set_tensions(BoxEnclosure<I>& box) {
  for (std::size_t i = 0; i < kCables; ++i) {
    box.low[i] = box.length[i] * (box.density[i] - box.below[i]);
    box.high[i] = box.length[i] * (box.density[i] + box.above[i]);
    box.low[i].tighten(box.offset);
    box.high[i].tighten(box.offset);
  }
}

template <class I>
void add_tension_margins(const Model<I>& model, BoxEnclosure<I>& box) {
  for (std::size_t i = 0; i < kCables; ++i) {
    const int cable = static_cast<int>(i);
    box.margins.add({MarginKind::kTensionMin, cable}, box.low[i] - model.tension_lower[i]);
    box.margins.add({MarginKind::kTensionMax, cable}, -box.high[i] + model.tension_upper[i]);
  }
}

/// Force densities λ = D^-1 w over a box, for all wrenches of K.
template <class I>
struct Densities {
  bool are_enclosed = false;
  std::array<SlopeForm<I>, kCables> nominal, below, above;  ///< of the nominal wrench, and how far K moves it
  Square<I> root;                                           ///< the rows Z_i of D^-1 L over T, of the ellipsoid
  std::array<SlopeForm<I>, kCables> radius;                 ///< |Z_i|
};

/// C itself.
template <class I>
typename InverseBound<I>::template Columns<6> identity_columns(const InverseBound<I>& inverse) {
  typename InverseBound<I>::template Columns<6> x;
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t j = 0; j < 6; ++j) x[k][j] = I(inverse.c()(static_cast<int>(k), static_cast<int>(j)));
  }
  return x;
}

/// C w.
template <class I>
typename InverseBound<I>::template Columns<1> loaded_column(const InverseBound<I>& inverse, const Vector6<I>& w) {
  typename InverseBound<I>::template Columns<1> x;
  for (std::size_t k = 0; k < 6; ++k) {
    I kappa(0.0);
    for (int l = 0; l < 6; ++l) kappa = kappa + inverse.c()(static_cast<int>(k), l) * w(l);
    x[k][0] = kappa;
  }
  return x;
}

/// C w, and C L.
template <class I>
typename InverseBound<I>::template Columns<7> loaded_columns(const Model<I>& model, const InverseBound<I>& inverse,
                                                             const Vector6<I>& w) {
  typename InverseBound<I>::template Columns<7> x;
  const typename InverseBound<I>::template Columns<1> first = loaded_column(inverse, w);
  const auto& c = inverse.c();
  for (std::size_t k = 0; k < 6; ++k) {
    const int row = static_cast<int>(k);
    x[k][0] = first[k][0];
    for (int j = 0; j < 6; ++j) {
      I entry = c(row, j) * model.ellipsoid_root(j, j);
      if (!model.ellipsoid_is_diagonal) {
        for (int l = 0; l < j; ++l) entry = entry + c(row, l) * model.ellipsoid_root(l, j);
      }
      x[k][static_cast<std::size_t>(j) + 1] = entry;
    }
  }
  return x;
}

/// D^-1 B over a box.
template <class I, std::size_t N>
using Forms = std::array<std::array<SlopeForm<I>, N>, kCables>;

/// Sets root and radius; the last columns of `forms` are D^-1 L. Returns false where a radius may be 0.
template <class I>
bool set_radius(const Forms<I, 7>& forms, const I& offset, Densities<I>& densities) {
  for (std::size_t i = 0; i < kCables; ++i) {
    SlopeForm<I> square(0.0);
    for (std::size_t j = 1; j < 7; ++j) {
      square = square + sqr(forms[i][j]);
      densities.root[i][j - 1] = forms[i][j].range;
    }
    square.tighten(offset);
    if (!certainly_positive(square.range)) return false;
    densities.radius[i] = sqrt(square);
    densities.radius[i].tighten(offset);
  }
  return true;
}

/// A constant near the items' nominal wrench at the midpoint, which depends on the pose, is multiplied by D^-1 as w0
/// is, so that what cancels between its components does so before it is enclosed. What remains is added with the
/// items.
template <class I>
struct ItemsOverBox {
  ItemsOverBox(const ProofModel<I>& problem, const Matrix3<SlopeForm<I>>& r_WP, Vector6<I>& w)
      : model(problem.model), at(loads_at(model.loads, r_WP)) {
    for (int j = 0; j < 6; ++j) {
      const I near(ProofScalarTraits<I>::point(at.nominal(j).at_mid));
      w(j) = w(j) + near;
      remaining(j) = at.nominal(j) - near;
    }
  }

  void add(const InverseBound<I>& inverse, double, const I& offset, Densities<I>& densities) const {
    const Forms<I, 6> forms = inverse.times(identity_columns(inverse));
    for (std::size_t i = 0; i < kCables; ++i) {
      Vector6<SlopeForm<I>> y;
      for (int j = 0; j < 6; ++j) y(j) = forms[i][static_cast<std::size_t>(j)];
      SlopeForm<I>& nominal = densities.nominal[i];
      for (int j = 0; j < 6; ++j) nominal = nominal + y(j) * remaining(j);
      nominal.tighten(offset);
      const DensityRange<SlopeForm<I>> range = density_range(model.loads, at, y);
      densities.below[i] = densities.below[i] + range.below;
      densities.above[i] = densities.above[i] + range.above;
      densities.below[i].tighten(offset);
      densities.above[i].tighten(offset);
    }
  }

  const Model<I>& model;
  LoadsAtPose<SlopeForm<I>> at;
  Vector6<SlopeForm<I>> remaining;
};

/// In binary64, all rows at once.
template <>
struct ItemsOverBox<Interval> {
  ItemsOverBox(const ProofModel<Interval>& problem, const Matrix3<SlopeForm<Interval>>& r_WP, Vector6<Interval>& w)
      : items(problem.item_rows), rotation(ItemRows::rotation(r_WP)), remaining(items.nominal(rotation)) {
    for (int j = 0; j < 3; ++j) {
      const auto k = static_cast<std::size_t>(j);
      w(j) = w(j) + Interval(remaining.force.mid[k]);
      w(3 + j) = w(3 + j) + Interval(remaining.moment.mid[k]);
    }
    for (VectorForm<double>* v : {&remaining.force, &remaining.moment}) {
      v->mid.fill(0);
      v->mid_size = 0;
    }
  }

  void add(const InverseBound<Interval>& inverse, double radius, const Interval& offset,
           Densities<Interval>& densities) const {
    const RowForms rows = row_forms(inverse, radius);
    const ItemRows::Forms nominal = times(rows, remaining);
    const ItemRows::Reach reach = items.reach(rotation, rows);
    for (std::size_t i = 0; i < kCables; ++i) {
      densities.nominal[i] = densities.nominal[i] + nominal[i];
      densities.nominal[i].tighten(offset);
      densities.below[i] = densities.below[i] + reach.below[i];
      densities.above[i] = densities.above[i] + reach.above[i];
    }
  }

  const ItemRows& items;
  RotationForm rotation;
  NominalForm remaining;
};

/// @param w  the wrench beside the items and the ellipsoid's spread
template <class I>
Densities<I> enclose_densities(const ProofModel<I>& problem, const Matrix3<SlopeForm<I>>& r_WP,
                               const InverseBound<I>& inverse, double radius, const I& offset, Vector6<I> w) {
  const Model<I>& model = problem.model;
  Densities<I> result;
  std::optional<ItemsOverBox<I>> items;
  if (!model.loads.empty()) items.emplace(problem, r_WP, w);
  if (model.has_ellipsoid) {
    const Forms<I, 7> forms = inverse.times(loaded_columns(model, inverse, w));
    for (std::size_t i = 0; i < kCables; ++i) result.nominal[i] = forms[i][0];
    if (!set_radius(forms, offset, result)) return result;  // the box is too wide
  } else {
    const Forms<I, 1> forms = inverse.times(loaded_column(inverse, w));
    for (std::size_t i = 0; i < kCables; ++i) result.nominal[i] = forms[i][0];
    for (auto& row : result.root) row.fill(I(0.0));
    result.radius.fill(SlopeForm<I>(0.0));
  }
  result.below = result.above = result.radius;
  if (items) items->add(inverse, radius, offset, result);
  result.are_enclosed = true;
  return result;
}

/// Whether the least and the greatest tensions are within their limits all over a box.
template <class I>
bool are_within(const Model<I>& model, const std::array<SlopeForm<I>, kCables>& low,
                const std::array<SlopeForm<I>, kCables>& high) {
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!certainly_positive(low[i].range - model.tension_lower[i])) return false;
    if (!certainly_positive(model.tension_upper[i] - high[i].range)) return false;
  }
  return true;
}

/// Of a move in time: what inertia asks of the cables over all of a box, and at its midpoint where that is asked for.
template <class I>
struct Inertia {
  explicit Inertia(Moving<I> over_box) : over(std::move(over_box)) {}

  /// w0 − w_in.
  [[nodiscard]] static Vector6<I> rest(const Vector6<I>& w0, const Moving<I>& moving) {
    Vector6<I> w;
    for (int k = 0; k < 6; ++k) w(k) = w0(k) - moving.load.wrench(k);
    return w;
  }

  /// Adds what inertia takes of tensions to what they are at rest: over the box, and as much at the midpoint. Slopes
  /// remain those at rest.
  void add(const ProofModel<I>& problem, const InverseBound<I>& inverse, BoxEnclosure<I>& box) {
    const std::array<I, kCables> over_box = densities(problem, inverse, over.load);
    at_rest = {box.density, box.low, box.high};
    for (std::size_t i = 0; i < kCables; ++i) {
      const I tension = box.length[i].range * over_box[i];
      box.density[i].range = box.density[i].range - over_box[i];
      box.low[i].range = box.low[i].range - tension;
      box.high[i].range = box.high[i].range - tension;
      box.density[i].at_mid = box.density[i].at_mid - over_box[i];
      box.low[i].at_mid = box.low[i].at_mid - tension;
      box.high[i].at_mid = box.high[i].at_mid - tension;
    }
  }

  /// After add(), where tensions at rest would do: what they are at the times at which the move is on the box, from
  /// parts of these, in each of which both the law and the tensions at rest vary less.
  void tighten(const ProofModel<I>& problem, const InverseBound<I>& inverse, const I& mid, BoxEnclosure<I>& box) const {
    for (int halvings = 1; halvings <= MovingModel<I>::kMostHalvings; ++halvings) {
      std::array<std::optional<I>, kCables> low, high;
      const auto include = [](std::optional<I>& range, const I& part) { range = range ? hull(*range, part) : part; };
      for (const auto& [here, load] : problem.moving->load_in_parts(over, halvings)) {
        const std::array<I, kCables> density = densities(problem, inverse, load);
        const I offset = here - mid;
        for (std::size_t i = 0; i < kCables; ++i) {
          const I tension = box.length[i].range * density[i];
          SlopeForm<I> least = at_rest.low[i], greatest = at_rest.high[i];
          least.tighten(offset);
          greatest.tighten(offset);
          include(low[i], least.range - tension);
          include(high[i], greatest.range - tension);
        }
      }
      for (std::size_t i = 0; i < kCables; ++i) {
        const auto narrow = [](SlopeForm<I>& tension, const std::optional<I>& range) {
          if (!range) return;
          tension.range = intersect(tension.range, *range);
          tension.at_mid = intersect(tension.at_mid, tension.range);
        };
        narrow(box.low[i], low[i]);
        narrow(box.high[i], high[i]);
      }
      if (are_within(problem.model, box.low, box.high)) return;
    }
  }

  /// After add(), and after margins were added: what is known of the midpoint by itself.
  void look_at_mid(const ProofModel<I>& problem, const Segment& segment, const I& mid, const InverseBound<I>& inverse,
                   BoxEnclosure<I>& box) {
    const Model<I>& model = problem.model;
    at_mid = problem.moving->at(model, segment, mid);
    box.is_slowed_badly = problem.moving->may_stop();
    if (!at_mid) return;
    const Forms<I, 1> by_inertia = inverse.times(loaded_column(inverse, at_mid->load.wrench));
    for (std::size_t i = 0; i < kCables; ++i) {
      const I& density = by_inertia[i][0].at_mid;
      const I tension = box.length[i].at_mid * density;
      box.density[i].at_mid = at_rest.density[i].at_mid - density;
      box.low[i].at_mid = at_rest.low[i].at_mid - tension;
      box.high[i].at_mid = at_rest.high[i].at_mid - tension;
    }
    for (auto& margin : box.margins) {
      const auto i = static_cast<std::size_t>(margin.id.cable);
      if (margin.id.kind == MarginKind::kTensionMin) margin.value.at_mid = box.low[i].at_mid - model.tension_lower[i];
      if (margin.id.kind == MarginKind::kTensionMax) margin.value.at_mid = model.tension_upper[i] - box.high[i].at_mid;
    }
    if (!problem.moving->may_stop()) return;
    slowed_at_mid = problem.moving->at(model, segment, mid, Speeds::kAny);
    if (slowed_at_mid) problem.moving->bound_rates(*slowed_at_mid);
    box.is_slowed_badly = !slowed_at_mid || !is_slowed_well(problem, inverse, box);
  }

  /// Whether at the midpoint, where it is slowed down, all that is limited is shown to be within its limits.
  [[nodiscard]] bool is_slowed_well(const ProofModel<I>& problem, const InverseBound<I>& inverse,
                                    const BoxEnclosure<I>& box) const {
    const InertiaByLaw<I>&m = at_mid->load.by_law, &x = slowed_at_mid->load.by_law;
    const Forms<I, 1> by_acceleration = inverse.times(loaded_column(inverse, m.a));
    const Forms<I, 1> by_square = inverse.times(loaded_column(inverse, m.b));
    for (std::size_t i = 0; i < kCables; ++i) {
      const I density = by_acceleration[i][0].at_mid * (m.acceleration - x.acceleration) +
                        by_square[i][0].at_mid * (m.square - x.square);
      const I tension = box.length[i].at_mid * density;
      const bool is_tight = certainly_positive(box.low[i].at_mid + tension - problem.model.tension_lower[i]) &&
                            certainly_positive(problem.model.tension_upper[i] - box.high[i].at_mid - tension);
      if (!is_tight) return false;
    }
    return std::ranges::all_of(slowed_at_mid->margins, [](const auto& rate) { return certainly_positive(rate.value); });
  }

  Moving<I> over;
  std::optional<Moving<I>> at_mid{};         ///< only after look_at_mid(), as what follows
  std::optional<Moving<I>> slowed_at_mid{};  ///< where the move may be slowed down
  struct AtRest {
    std::array<SlopeForm<I>, kCables> density, low, high;
  };
  AtRest at_rest{};

 private:
  /// D^-1 w_in over the box, at the times that the load is of.
  [[nodiscard]] static std::array<I, kCables> densities(const ProofModel<I>& problem, const InverseBound<I>& inverse,
                                                        const InertialLoad<I>& load) {
    return problem.moving->may_stop() ? by_law(inverse, load.by_law) : by_wrench(inverse, load.wrench);
  }
  [[nodiscard]] static std::array<I, kCables> by_wrench(const InverseBound<I>& inverse, const Vector6<I>& wrench) {
    const Forms<I, 1> densities = inverse.times(loaded_column(inverse, wrench));
    std::array<I, kCables> result;
    for (std::size_t i = 0; i < kCables; ++i) result[i] = densities[i][0].range;
    return result;
  }
  /// From A and B, to which D^-1 is applied before s̈ and ṡ² vary: they vary much where a move is slowed down.
  [[nodiscard]] static std::array<I, kCables> by_law(const InverseBound<I>& inverse, const InertiaByLaw<I>& law) {
    const std::array<I, kCables> a = by_wrench(inverse, law.a), b = by_wrench(inverse, law.b);
    std::array<I, kCables> result;
    for (std::size_t i = 0; i < kCables; ++i) result[i] = a[i] * law.acceleration + b[i] * law.square;
    return result;
  }
};

/// The margins of rates as far as is known of tensions: over the box those of every deviation, if that is known.
template <class I>
typename BoxEnclosure<I>::Rates rate_margins(const ProofModel<I>& problem, const Inertia<I>& inertia,
                                             const BoxEnclosure<I>& box) {
  std::array<I, kCables> at_mid, over;
  for (const auto& [id, value, disturbed] : box.margins) {
    if (id.kind != MarginKind::kTensionMax) continue;
    const auto i = static_cast<std::size_t>(id.cable);
    at_mid[i] = box.high[i].at_mid;
    over[i] = problem.model.tension_upper[i] - disturbed;
  }
  std::array<I, kCables> undisturbed;
  for (std::size_t i = 0; i < kCables; ++i) undisturbed[i] = box.high[i].range;
  const Moving<I>& mid = inertia.at_mid ? *inertia.at_mid : inertia.over;
  typename BoxEnclosure<I>::Rates result{mid.margins, inertia.over.margins, inertia.over.margins};
  problem.moving->add_powers(mid, at_mid, result.at_mid);
  problem.moving->add_powers(inertia.over, over, result.over);
  problem.moving->add_powers(inertia.over, undisturbed, result.undisturbed);
  return result;
}

/// Whether everything that is limited is known to be within its limits at the midpoint, less what deviations take of
/// the box: of a move from what its rates are over all of the box. Without rates, of the rest.
template <class I>
bool is_midpoint_clear(const BoxEnclosure<I>& box) {
  const auto is_kept = [](const RateMargin<I>& rate) { return certainly_positive(rate.value); };
  const auto is_inside = [](const auto& margin) {
    const double lost = lower_bound(margin.value.range) - lower_bound(margin.disturbed);
    return lower_bound(margin.value.at_mid) > std::max(lost, 0.0);
  };
  return std::ranges::all_of(box.margins, is_inside) && (!box.rates || std::ranges::all_of(box.rates->over, is_kept));
}

/// How far a deviation may change a margin.
template <class I>
UpperOf<I> change_of(MarginId id, const DeviationBounds<I>& disturbance) {
  const auto i = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case MarginKind::kTensionMin: return disturbance.tension[i][0];
    case MarginKind::kTensionMax: return disturbance.tension[i][1];
    case MarginKind::kLengthMin:
    case MarginKind::kLengthMax: return disturbance.length[i];
  }
  throw std::logic_error("a margin of no kind");
}

template <class I>
void disturb(BoxEnclosure<I>& box) {
  for (auto& margin : box.margins) {
    margin.disturbed = margin.value.range + ProofScalarTraits<I>::symmetric(change_of(margin.id, *box.disturbance));
  }
}

/// Whether bounds item by item might do: some margin is not positive, but by less than a part of its change.
template <class I>
bool may_be_sharpened(const ProofModel<I>& problem, const BoxEnclosure<I>& box) {
  if (!std::is_same_v<I, Interval> || problem.model.loads.empty() || !problem.item_rows.has_extremes()) return false;
  constexpr double kPart = 0.25;  // sharper bounds are hardly ever smaller by more
  return !box.margins.are_positive() && std::ranges::all_of(box.margins, [&](const auto& margin) {
    const double change = ProofScalarTraits<I>::to_double(change_of(margin.id, *box.disturbance));
    return lower_bound(margin.disturbed) > -kPart * change;
  });
}

/// The equations of a box for all cables at once: the same numbers, of a problem without tolerances.
class BoxInLanes {
 public:
  explicit BoxInLanes(const ProofModel<Interval>& problem) : machine_(*problem.lanes), model_(problem.model) {}

  /// Sets lengths. Returns whether J is proved non-singular; what follows is void otherwise.
  [[nodiscard]] bool invert(const MotionEnclosure<Interval>& motion, double radius, BoxEnclosure<Interval>& result) {
    lanes::PoseForms<1> pose = lanes_pose<1>(motion.p_WP, motion.r_WP);
    pose.radius[0] = radius;
    if (kernel_.enclose_geometry(machine_, pose, box_) != lanes::Outcome::kYes) {
      Faults<Interval>::raise();
      return false;
    }
    for (std::size_t i = 0; i < kCables; ++i) set_from_lanes(box_.length, i, result.length[i]);
    add_length_margins(model_, result);
    return kernel_.precondition(box_) == lanes::Outcome::kYes && kernel_.bound_inverse(box_) == lanes::Outcome::kYes;
  }

  [[nodiscard]] const lanes::Box<1>& box() const { return box_; }

  /// Sets densities and tensions of a problem without items. Returns whether they are enclosed.
  [[nodiscard]] bool add_tensions(BoxEnclosure<Interval>& result) {
    lanes::Ends wrench[6];
    for (int j = 0; j < 6; ++j) wrench[j] = lanes_detail::ends(model_.wrench(j));
    if (kernel_.enclose_tensions(machine_, wrench, box_) != lanes::Outcome::kYes) {
      Faults<Interval>::raise();
      return false;
    }
    constexpr unsigned kAllCables = (1U << kCables) - 1;
    if (box_.enclosed != kAllCables) return false;  // the box is too wide
    for (std::size_t i = 0; i < kCables; ++i) {
      set_from_lanes(box_.nominal, i, result.density[i]);
      set_from_lanes(box_.spread, i, result.below[i]);
      result.above[i] = result.below[i];
      set_from_lanes(box_.low, i, result.low[i]);
      set_from_lanes(box_.high, i, result.high[i]);
    }
    return true;
  }

 private:
  const lanes::Machine& machine_;
  const Model<Interval>& model_;
  const lanes::BoxKernel<1>& kernel_ = lanes::kernels().box;
  lanes::Box<1> box_;
};

}  // namespace

template <class I>
MotionEnclosure<I> undisturbed_motion(const ProofModel<I>& problem, const Segment& segment, const EnclosedBox<I>& s,
                                      const I& offset) {
  if (segment.law == Interpolation::kCableLengths) {
    if constexpr (std::is_same_v<I, Interval>) {
      if (problem.lanes) {
        return forward_kinematics_in_lanes(lanes::kernels(), *problem.lanes, problem.model, segment, s.range, s.mid,
                                           offset);
      }
    }
    return forward_kinematics(problem.model, segment, s.range, s.mid, offset);
  }
  return enclose_motion(problem.motion, segment, s.range, s.mid, offset);
}

/// What deviations within the tolerances change, where that is enclosed.
template <class I>
void add_disturbance(const ProofModel<I>& problem, UndisturbedBox<I> undisturbed, int continuation_steps,
                     BoxEnclosure<I>& result) {
  result.disturbance = disturbance<I>(undisturbed, *problem.tolerance, continuation_steps);
  if (!result.disturbance) return;
  disturb(result);
  if (!may_be_sharpened(problem, result)) return;
  undisturbed.is_item_by_item = true;
  const auto sharper = disturbance<I>(undisturbed, *problem.tolerance, continuation_steps);
  if (!sharper) return;
  result.disturbance = sharper;
  disturb(result);
}

namespace {

/// Boxes less deep than this are likely to be too wide for a move, too, if they are at rest.
constexpr int kDeepestAtRest = 4;

/// Whether only the midpoint is shown to have its tensions within their limits.
template <class I>
bool is_too_wide_at_rest(const Model<I>& model, const BoxEnclosure<I>& box) {
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!certainly_positive(box.low[i].at_mid - model.tension_lower[i])) return false;
    if (!certainly_positive(model.tension_upper[i] - box.high[i].at_mid)) return false;
  }
  return !are_within(model, box.low, box.high);
}

/// enclose_box(). Of a move, `mid` may be left out where nothing depends on it: then statements about the midpoint are
/// no sharper than those about the box. And what inertia adds is left out where the box is too wide without it.
enum class Midpoint { kAlways, kIfUnproved };
template <class I>
BoxEnclosure<I> enclose(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& box,
                        int continuation_steps, Midpoint mid) {
  const Model<I>& model = problem.model;
  const double radius = box.radius();
  const EnclosedBox<I> s = enclose<I>(box);

  BoxEnclosure<I> result;
  result.offset = I(-radius, radius);
  const I& offset = result.offset;

  const MotionEnclosure<I> motion = undisturbed_motion(problem, segment, s, offset);
  result.motion = motion.status;
  if (!motion.is_enclosed()) return result;
  if (problem.bodies) result.pose = motion;
  const bool is_moving = segment.timing != nullptr;
  if (is_moving && !problem.moving) throw std::logic_error("a move of a problem without limits in time");
  std::optional<CableGeometry<SlopeForm<I>>> geometry;
  InverseBound<I> inverse;
  std::optional<BoxInLanes> in_lanes;
  if constexpr (std::is_same_v<I, Interval>) {
    if (problem.lanes && !problem.tolerance) {
      in_lanes.emplace(problem);
      if (!in_lanes->invert(motion, radius, result)) return result;
      if (is_moving || !model.loads.empty()) inverse.set(in_lanes->box());
    }
  }
  if (!in_lanes) {
    geometry = cable_geometry(model, motion.p_WP, motion.r_WP);
    for (std::size_t i = 0; i < kCables; ++i) {
      result.length[i] = length(geometry->p_AB_W[i]);
      result.length[i].tighten(offset);
    }
    add_length_margins(model, result);
    if (!inverse.set(geometry->force_density, radius)) return result;
  }
  Densities<I> densities;
  if constexpr (std::is_same_v<I, Interval>) {
    if (in_lanes && model.loads.empty()) {
      if (!in_lanes->add_tensions(result)) return result;
    }
  }
  if (!in_lanes || !model.loads.empty()) {
    densities = enclose_densities(problem, motion.r_WP, inverse, radius, offset, model.wrench);
    if (!densities.are_enclosed) return result;
    for (std::size_t i = 0; i < kCables; ++i) {
      result.density[i] = densities.nominal[i];
      result.below[i] = densities.below[i];
      result.above[i] = densities.above[i];
    }
    set_tensions(result);
  }
  if (is_moving && mid == Midpoint::kIfUnproved && box.depth < kDeepestAtRest && is_too_wide_at_rest(model, result)) {
    result.regular = true;
    add_tension_margins(model, result);
    return result;
  }
  std::optional<Inertia<I>> inertia;
  if (is_moving) {
    std::optional<Moving<I>> over = problem.moving->over(model, segment, s.range, {motion, s.mid});
    if (!over) {
      result.motion = MotionEnclosure<I>::Status::kUnproved;
      return result;
    }
    inertia.emplace(*std::move(over));
    inertia->add(problem, inverse, result);
    if (!are_within(model, result.low, result.high) && are_within(model, inertia->at_rest.low, inertia->at_rest.high)) {
      inertia->tighten(problem, inverse, s.mid, result);
    }
  }
  result.regular = true;
  add_tension_margins(model, result);
  // Of rates nothing is asked where a tension or a length is not proved.
  const bool are_rates_asked = inertia && (mid == Midpoint::kAlways || result.margins.are_positive());
  if (are_rates_asked) {
    problem.moving->bound_rates(inertia->over);
    if (result.margins.are_positive()) problem.moving->tighten(inertia->over);
    result.rates = rate_margins(problem, *inertia, result);
  }
  const auto look_at_mid = [&] {
    if (!inertia || (mid == Midpoint::kIfUnproved && is_midpoint_clear(result))) return;
    inertia->look_at_mid(problem, segment, s.mid, inverse, result);
    if (!are_rates_asked) return;
    if (inertia->at_mid) problem.moving->bound_rates(*inertia->at_mid);
    result.rates = rate_margins(problem, *inertia, result);
  };
  if (!problem.tolerance || !result.margins.are_positive()) {
    look_at_mid();
    return result;
  }
  Vector6<I> wrench = inertia ? Inertia<I>::rest(model.wrench, inertia->over) : model.wrench;
  Vector6<I> change;
  for (int k = 0; k < 6; ++k) change(k) = I(0.0);
  const UndisturbedBox<I> undisturbed{model,
                                      problem.item_rows,
                                      motion,
                                      *geometry,
                                      result.length,
                                      result.density,
                                      densities.radius,
                                      densities.root,
                                      inverse.c(),
                                      inverse.q(),
                                      lead(problem, segment),
                                      wrench,
                                      change};
  add_disturbance(problem, undisturbed, continuation_steps, result);
  if (!inertia) return result;
  if (result.disturbance) {
    // How far the platform turns does not depend on the load. Once it is known, so is what that changes of the inertia.
    change = problem.moving->change(inertia->over, I(ProofScalarTraits<I>::symmetric(result.disturbance->turn)));
    wrench -= change;
    change = -change;
    result.disturbance.reset();
    for (auto& margin : result.margins) margin.disturbed = margin.value.range;
    add_disturbance(problem, undisturbed, continuation_steps, result);
    result.rates = rate_margins(problem, *inertia, result);
  }
  look_at_mid();
  return result;
}

}  // namespace

template <class I>
BoxEnclosure<I> enclose_box(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& box,
                            int continuation_steps) {
  return enclose(problem, segment, box, continuation_steps, Midpoint::kAlways);
}

template MotionEnclosure<Interval> undisturbed_motion(const ProofModel<Interval>&, const Segment&,
                                                      const EnclosedBox<Interval>&, const Interval&);
template MotionEnclosure<MpInterval> undisturbed_motion(const ProofModel<MpInterval>&, const Segment&,
                                                        const EnclosedBox<MpInterval>&, const MpInterval&);
template BoxEnclosure<Interval> enclose_box(const ProofModel<Interval>&, const Segment&, const DyadicBox&, int);
template BoxEnclosure<MpInterval> enclose_box(const ProofModel<MpInterval>&, const Segment&, const DyadicBox&, int);

// ---- The verdict ----------------------------------------------------------------------------------------------------

namespace {

bool is_tension(MarginKind kind) { return kind == MarginKind::kTensionMin || kind == MarginKind::kTensionMax; }

/// Half the range between the limits that a margin is measured from, roughly.
template <class I>
double half_range(const Model<I>& model, MarginId id) {
  const auto n = static_cast<std::size_t>(id.cable);
  return is_tension(id.kind) ? 0.5 * (lower_bound(model.tension_upper[n]) - upper_bound(model.tension_lower[n]))
                             : 0.5 * (lower_bound(model.length_upper[n]) - upper_bound(model.length_lower[n]));
}

/// The margin of the least lower bound, over half its range.
template <class I>
MarginId weakest(const ProofModel<I>& problem, const BoxEnclosure<I>& enclosure) {
  MarginId weakest;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& [id, value, disturbed] : enclosure.margins) {
    const double relative = lower_bound(disturbed) / half_range(problem.model, id);
    if (relative < lowest) {
      lowest = relative;
      weakest = id;
    }
  }
  return weakest;
}

/// How far K moves a tension of any deviating machine below (side 0) or above (side 1) its nominal one, from that of
/// the undisturbed one. Of an ellipsoid alone both are v_ii, half the difference of the two bounds.
template <class I>
I disturbed_reach(const I& undisturbed, std::size_t cable, std::size_t side, const DeviationBounds<I>& disturbance) {
  if (disturbance.reach) return ProofScalarTraits<I>::symmetric((*disturbance.reach)[cable][side]);
  const auto& [low, high] = disturbance.tension[cable];
  return undisturbed + ProofScalarTraits<I>::symmetric(UpperOf<I>(0.5) * (low + high));
}

/// Everything is known of the box that pairs of bodies need.
template <class I>
BodiesBox<I> bodies_box(const ProofModel<I>& problem, const BoxEnclosure<I>& box) {
  const bool deviates = box.disturbance.has_value();
  return {*problem.bodies,
          problem.model,
          box.pose->p_WP,
          box.pose->r_WP,
          box.length,
          box.offset,
          deviates ? &*problem.tolerance : nullptr,
          deviates ? &*box.disturbance : nullptr};
}

using AtMid = BoxVerdict::NearPair::AtMid;

/// A lower bound of how much farther than its clearance a pair is apart, and what holds where it is not positive.
struct PairBound {
  double lower = 0;
  AtMid at_mid = AtMid::kUnknown;
};

template <class I>
PairBound bound_along(const BodyGaps<I>& gaps, const CheckedPair<I>& pair, const Direction& direction) {
  const GapBound<I> bound = gaps.along(pair, direction);
  PairBound result{lower_bound(bound.disturbed)};
  const double lost = lower_bound(bound.value.range) - result.lower;  // to deviations
  const double at_mid = lower_bound(bound.value.at_mid);
  if (at_mid > 0) result.at_mid = at_mid - lost > 0 ? AtMid::kApart : AtMid::kApartUndisturbed;
  return result;
}

template <class I>
PairBound bound_of_mesh(const BodyGaps<I>& gaps, const CheckedPair<I>& pair, std::span<const Direction> directions) {
  using Where = typename BodyGaps<I>::Where;
  PairBound result{gaps.of_mesh(pair, directions, Where::kBox)};
  if (result.lower > 0) return result;
  const auto is_apart = [&](Where where) { return gaps.of_mesh(pair, directions, where) > 0; };
  if (is_apart(Where::kMid)) {
    result.at_mid = AtMid::kApart;
  } else if (is_apart(Where::kMidUndisturbed)) {
    result.at_mid = AtMid::kApartUndisturbed;
  }
  return result;
}

/// Whether what is known of `clear` holds on the box.
bool is_of(const ClearPoses* clear, const BodiesBox<Interval>& box) {
  return clear != nullptr && box.tolerance == nullptr && clear->contains(box.p_WP, box.r_WP);
}
bool is_of(const ClearPoses* /*in binary64*/, const BodiesBox<MpInterval>& /*box*/) { return false; }

/// Of a box on which all else is proved.
template <class I>
void judge_bodies(const ProofModel<I>& problem, const BoxEnclosure<I>& enclosure, const PairDirections& directions,
                  const ClearPoses* clear, BoxVerdict& verdict) {
  if (directions.single.size() != problem.bodies->pairs.size()) throw std::logic_error("directions of other pairs");
  if (problem.tolerance && !enclosure.disturbance) throw std::logic_error("a proved box without its deviations");
  const BodiesBox<I> box = bodies_box(problem, enclosure);
  const BodyGaps<I> gaps(box);
  if (!gaps.have_cables_length()) verdict.kind = BoxVerdict::Kind::kNear;
  const auto judge_pair = [&](std::size_t n) {
    const CheckedPair<I>& pair = problem.bodies->pairs[n];
    PairBound bound{gaps.rough(pair, directions.single[n])};
    if (!(bound.lower > 0)) {
      bound =
          pair.has_mesh ? bound_of_mesh(gaps, pair, directions.of(n)) : bound_along(gaps, pair, directions.single[n]);
    }
    verdict.clearance_m = std::min(verdict.clearance_m, bound.lower);
    if (bound.lower > 0) return;
    verdict.kind = BoxVerdict::Kind::kNear;
    verdict.near.push_back({n, bound.at_mid});
  };
  if (is_of(clear, box)) {
    for (const std::size_t n : clear->others()) judge_pair(n);
    verdict.clearance_m = std::min(verdict.clearance_m, clear->least_gap());
  } else {
    for (std::size_t n = 0; n < directions.single.size(); ++n) judge_pair(n);
  }
  if (!problem.bodies->has_meshes) return;
  for (std::size_t n = 0; verdict.kind == BoxVerdict::Kind::kProved && n < directions.single.size(); ++n) {
    const CheckedPair<I>& pair = problem.bodies->pairs[n];
    const MeshSide side = pair.has_mesh ? gaps.side_at_mid(pair) : MeshSide::kOutside;
    if (side == MeshSide::kOutside) continue;
    const bool is_inside = side == MeshSide::kInside;
    verdict.kind = is_inside ? BoxVerdict::Kind::kInside : BoxVerdict::Kind::kNear;
    verdict.near.push_back({n, AtMid::kUnknown});
  }
}

/// Of a box on which all tensions and lengths are proved.
template <class I>
void judge_rates(const typename BoxEnclosure<I>::Rates& rates, BoxVerdict& verdict) {
  using Kind = BoxVerdict::Kind;
  for (std::size_t n = 0; n < rates.over.size(); ++n) {
    const I& at_mid = rates.at_mid[n].value;
    if (certainly_nonpositive(at_mid)) {
      verdict.kind = Kind::kTooFast;
      verdict.rate = rates.over[n].id;
      return;
    }
    if (verdict.kind == Kind::kPrecision || certainly_positive(rates.over[n].value)) continue;
    // To deviations, of which a smaller box would hardly know less.
    const double lost = lower_bound(rates.undisturbed[n].value) - lower_bound(rates.over[n].value);
    const bool is_lost = lost > 0 && !(lower_bound(at_mid) > lost);
    const Kind kind = !certainly_positive(at_mid) ? Kind::kPrecision : is_lost ? Kind::kTolerance : Kind::kSplit;
    if (verdict.kind == Kind::kSplit && kind == Kind::kTolerance) continue;
    verdict.kind = kind;
    verdict.rate = rates.over[n].id;
  }
}

/// BoxVerdict::strain.
template <class I>
double strain(const MarginList<I>& margins) {
  double largest = 0;
  for (const auto& margin : margins) {
    const double over_box = lower_bound(margin.value.range);
    const double at_mid = lower_bound(margin.value.at_mid);
    const double left_by_deviations = at_mid - (over_box - lower_bound(margin.disturbed));
    if (!(left_by_deviations > 0)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, (at_mid - over_box) / left_by_deviations);
  }
  return largest;
}

/// More than this is not claimed of the factor by which K may grow.
constexpr double kMostGrowth = 1e6;

/// By which factor K may grow at least before this tension, whose margin is at least `bound` > 0, reaches its limit:
/// (f0 − f_lo)/v = 1 + (f0 − v − f_lo)/v, and likewise above. `known`, that of other tensions, where it is less.
template <class I>
double wrench_scale(const BoxEnclosure<I>& enclosure, MarginId id, double bound, double known) {
  const auto n = static_cast<std::size_t>(id.cable);
  const bool is_low = id.kind == MarginKind::kTensionMin;
  I reach = enclosure.length[n].range * (is_low ? enclosure.below[n] : enclosure.above[n]).range;
  if (enclosure.disturbance) reach = disturbed_reach(reach, n, is_low ? 0 : 1, *enclosure.disturbance);
  const double most = upper_bound(reach);
  if (!(most > bound / (2 * kMostGrowth))) return known;  // K is nearly a single wrench
  if constexpr (std::is_same_v<I, Interval>) {            // rounding upward: 1 + bound/most is not below what is known
    if (bound >= (known - 1) * most) return known;
  }
  return std::min(known, lower_bound(I(1.0) + I(bound) / I(most)));
}

/// The verdict on a box in which not every pose is known to exist and to be in range.
template <class I>
std::optional<BoxVerdict::Kind> kind_without_motion(typename MotionEnclosure<I>::Status motion) {
  using Status = typename MotionEnclosure<I>::Status;
  switch (motion) {
    case Status::kSpansKnot: return BoxVerdict::Kind::kSpansKnot;
    case Status::kUnproved: return BoxVerdict::Kind::kNoMotion;
    case Status::kOutOfRange: return BoxVerdict::Kind::kOutOfRange;
    case Status::kRangeWide:
    case Status::kKnown: break;
  }
  return std::nullopt;
}

template <class I>
BoxVerdict judge(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& box, double clearance,
                 int continuation_steps, const PairDirections* directions, const ClearPoses* clear) {
  using Kind = BoxVerdict::Kind;
  using Status = typename MotionEnclosure<I>::Status;
  constexpr int kSmall = 6;  // depth of boxes from which on smaller ones would hardly narrow what deviations may do
  const BoxEnclosure<I> enclosure =
      enclose(problem, segment, box, continuation_steps, clearance > 0 ? Midpoint::kAlways : Midpoint::kIfUnproved);
  BoxVerdict verdict;
  if (const auto kind = kind_without_motion<I>(enclosure.motion)) {
    verdict.kind = *kind;
    return verdict;
  }
  verdict.tension_N = verdict.length_m = std::numeric_limits<double>::infinity();
  verdict.wrench_scale = kMostGrowth;
  if (enclosure.regular) verdict.strain = strain(enclosure.margins);
  bool all_positive = true, midpoint_positive = true, all_positive_undisturbed = true;
  bool refuted = false, too_close = false;
  MarginId refuted_id;
  bool within_tolerance = !problem.tolerance || enclosure.disturbance;
  for (const auto& [id, value, disturbed] : enclosure.margins) {
    const double bound = lower_bound(disturbed);
    const double required =
        clearance > 0 ? clearance * half_range(problem.model, id) : 0.0;  // >= 0: limits are ordered
    if (!(bound > 0 && bound > required)) all_positive = false;
    if (clearance > 0 && upper_bound(value.at_mid) <= required) too_close = true;
    if (!certainly_positive(value.at_mid)) midpoint_positive = false;
    if (!certainly_positive(value.range)) all_positive_undisturbed = false;
    const double left_at_mid = lower_bound(value.at_mid) + (bound - lower_bound(value.range));  // by deviations
    if (problem.tolerance && left_at_mid <= 0) within_tolerance = false;  // a smaller box would hardly do
    if (clearance > 0 && problem.tolerance && box.depth >= kSmall && left_at_mid <= required) too_close = true;
    if (certainly_nonpositive(value.at_mid)) {
      // Where a parameter may be out of its range, the box holds poses that are no witnesses.
      const bool throughout = enclosure.motion == Status::kKnown && certainly_nonpositive(value.range);
      if (!refuted || (throughout && !verdict.throughout)) {
        refuted = true;
        refuted_id = id;
        verdict.throughout = throughout;
      }
    }
    if (is_tension(id.kind)) {
      verdict.tension_N = std::min(verdict.tension_N, bound);
      if (bound > 0) verdict.wrench_scale = wrench_scale(enclosure, id, bound, verdict.wrench_scale);
    } else {
      verdict.length_m = std::min(verdict.length_m, bound);
    }
  }
  if (refuted) {
    verdict.kind = Kind::kRefuted;
    verdict.worst = refuted_id;
  } else if (too_close) {
    verdict.kind = Kind::kTooClose;
  } else if (!enclosure.regular) {
    verdict.kind = Kind::kNearSingular;
  } else if (all_positive && (!problem.tolerance || enclosure.disturbance)) {
    verdict.kind = enclosure.motion == Status::kKnown ? Kind::kProved : Kind::kSplit;
  } else if (!midpoint_positive) {
    verdict.kind = Kind::kPrecision;
  } else {
    verdict.kind = within_tolerance || !all_positive_undisturbed ? Kind::kSplit : Kind::kTolerance;
  }
  if (verdict.kind != Kind::kRefuted && verdict.kind != Kind::kProved) verdict.worst = weakest(problem, enclosure);
  if (segment.timing != nullptr) verdict.wrench_scale = 1;  // the growth of K is not claimed of moves
  if (verdict.kind == Kind::kProved && segment.timing != nullptr) {
    if (!enclosure.rates) throw std::logic_error("a box of a move without its rates");
    judge_rates<I>(*enclosure.rates, verdict);
  }
  if (verdict.kind == Kind::kSplit && enclosure.is_slowed_badly) verdict.kind = Kind::kSlowing;
  verdict.clearance_m = std::numeric_limits<double>::infinity();
  if (verdict.kind == Kind::kProved && directions != nullptr && problem.bodies) {
    judge_bodies(problem, enclosure, *directions, clear, verdict);
  }
  return verdict;
}

}  // namespace

BoxVerdict judge_box(const ProofModel<Interval>& problem, const Segment& segment, const DyadicBox& box,
                     double clearance, int continuation_steps, const PairDirections* directions,
                     const ClearPoses* clear) {
  BoxVerdict verdict;
  if (!run_upward([&] { verdict = judge(problem, segment, box, clearance, continuation_steps, directions, clear); }))
    verdict.kind = BoxVerdict::Kind::kFault;
  return verdict;
}

BoxVerdict judge_box(const ProofModel<MpInterval>& problem, const Segment& segment, const DyadicBox& box,
                     double clearance, int continuation_steps, const PairDirections* directions) {
  Faults<MpInterval>::clear();
  BoxVerdict verdict = judge(problem, segment, box, clearance, continuation_steps, directions, nullptr);
  if (Faults<MpInterval>::raised()) verdict.kind = BoxVerdict::Kind::kFault;
  return verdict;
}

namespace {

template <class I>
Contact contact(const ProofModel<I>& problem, const Segment& segment, const DyadicBox& dyadic,
                const PairContact& found) {
  const double radius = dyadic.radius();
  BoxEnclosure<I> box;
  box.offset = I(-radius, radius);
  box.pose = undisturbed_motion(problem, segment, enclose<I>(dyadic), box.offset);
  if (box.pose->status != MotionEnclosure<I>::Status::kKnown) return Contact::kUnknown;
  const CableGeometry<SlopeForm<I>> geometry = cable_geometry(problem.model, box.pose->p_WP, box.pose->r_WP);
  for (std::size_t i = 0; i < kCables; ++i) {
    box.length[i] = length(geometry.p_AB_W[i]);
    box.length[i].tighten(box.offset);
  }
  const BodiesBox<I> bodies = bodies_box(problem, box);
  const BodyGaps<I> gaps(bodies);
  const CheckedPair<I>& checked = problem.bodies->pairs.at(found.pair);
  const PointPair& points = found.points;
  if (!gaps.have_cables_length()) return Contact::kUnknown;
  if (found.around) return gaps.meet(checked, *found.around) ? Contact::kThroughout : Contact::kUnknown;
  if (points.inside) return gaps.is_inside_at_mid(checked, points) ? Contact::kAtMid : Contact::kUnknown;
  if (certainly_nonpositive(gaps.distance(checked, points, false))) return Contact::kThroughout;
  return certainly_nonpositive(gaps.distance(checked, points, true)) ? Contact::kAtMid : Contact::kUnknown;
}

}  // namespace

Contact judge_contact(const ProofModel<Interval>& problem, const Segment& segment, const DyadicBox& box,
                      const PairContact& found) {
  Contact result = Contact::kUnknown;
  if (!run_upward([&] { result = contact(problem, segment, box, found); })) return Contact::kUnknown;
  return result;
}

Contact judge_contact(const ProofModel<MpInterval>& problem, const Segment& segment, const DyadicBox& box,
                      const PairContact& found) {
  Faults<MpInterval>::clear();
  const Contact result = contact(problem, segment, box, found);
  return Faults<MpInterval>::raised() ? Contact::kUnknown : result;
}

bool is_motion_known(const ProofModel<MpInterval>& problem, const Segment& segment, const DyadicBox& box) {
  Faults<MpInterval>::clear();
  const MpInterval offset(-box.radius(), box.radius());
  const auto motion = undisturbed_motion(problem, segment, enclose<MpInterval>(box), offset);
  return motion.status == MotionEnclosure<MpInterval>::Status::kKnown && !Faults<MpInterval>::raised();
}

int determinant_sign(const ProofModel<MpInterval>& problem, const Segment& segment, const Dyadic& s) {
  Faults<MpInterval>::clear();
  const auto point = enclose<MpInterval>(s);
  const MotionEnclosure<MpInterval> motion = undisturbed_motion(problem, segment, {point, point}, MpInterval(0.0));
  if (motion.status != MotionEnclosure<MpInterval>::Status::kKnown) return 0;
  const auto at_mid = [](const SlopeForm<MpInterval>& x) { return x.at_mid; };
  const Vector3<MpInterval> p_WP = motion.p_WP.unaryExpr(at_mid);
  const Matrix3<MpInterval> r_WP = motion.r_WP.unaryExpr(at_mid);
  Matrix6<MpInterval> inverse;
  MpInterval determinant;
  const bool regular = invert(cable_geometry(problem.model, p_WP, r_WP).force_density, inverse, determinant);
  if (!regular || Faults<MpInterval>::raised()) return 0;
  if (certainly_positive(determinant)) return 1;
  return certainly_positive(-determinant) ? -1 : 0;
}

}  // namespace taut
