// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/margin_budget.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinematics/jet.h"
#include "kinematics/statics.h"
#include "problem/rows.h"

namespace taut {

// Elimination compares jets by their values.
template <class S, int N>
double lower_bound(const Jet<S, N>& a) {
  return lower_bound(a.value);
}
template <class S, int N>
double upper_bound(const Jet<S, N>& a) {
  return upper_bound(a.value);
}
template <class S, int N>
bool certainly_positive(const Jet<S, N>& a) {
  return certainly_positive(a.value);
}

namespace {

// The variables of the inner derivatives.
constexpr int kBase = 0;        // 18: base anchors
constexpr int kPlatform = 18;   // 18: platform anchors
constexpr int kLoadPoint = 36;  // 3
constexpr int kWrench = 39;     // 6
constexpr int kPosition = 45;   // 3: of the platform
constexpr int kTurn = 48;       // 3: of the platform, axes of W
constexpr int kVariables = 51;
constexpr int kDesign = kPosition;  // those before are parameters of the machine

template <class S>
using Inner = Jet<S, kVariables>;
/// One parameter at a time, outside of the others.
using Outer = Jet<double, 1>;

template <class S>
Model<Inner<S>> seeded(const Problem& problem) {
  auto model = make_model<Inner<S>>(problem);
  const auto seed = [](Vector3<Inner<S>>& x, int first) {
    for (int k = 0; k < 3; ++k) x(k) = Inner<S>(x(k).value, first + k);
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    seed(model.p_WA[i], kBase + 3 * static_cast<int>(i));
    seed(model.p_PB[i], kPlatform + 3 * static_cast<int>(i));
  }
  seed(model.p_PM, kLoadPoint);
  for (int k = 0; k < 6; ++k) model.wrench(k) = Inner<S>(model.wrench(k).value, kWrench + k);
  return model;
}

/// The first `kDesign` variables moved by the outer variable: number `variable` at the rate 1.
void vary(Model<Inner<Outer>>& model, int variable) {
  const auto move = [&](Inner<Outer>& x, int number) {
    if (number == variable) x.value = Outer(x.value.value, 0);
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    for (int k = 0; k < 3; ++k) {
      move(model.p_WA[i](k), kBase + 3 * static_cast<int>(i) + k);
      move(model.p_PB[i](k), kPlatform + 3 * static_cast<int>(i) + k);
    }
  }
  for (int k = 0; k < 3; ++k) move(model.p_PM(k), kLoadPoint + k);
  for (int k = 0; k < 6; ++k) move(model.wrench(k), kWrench + k);
}

/// Where the items of a load act, axes of P [m].
std::vector<Vector3<double>> item_places(const Model<double>& model) {
  std::vector<Vector3<double>> result;
  for (const auto& item : model.loads.items) result.emplace_back(model.p_PM + item.lever);
  return result;
}

/// Anchors and items from the load point follow from what was seeded.
template <class S>
void set_arms(Model<Inner<S>>& model, const std::vector<Vector3<double>>& places) {
  for (std::size_t i = 0; i < kCables; ++i) {
    for (int k = 0; k < 3; ++k) model.p_MB[i](k) = model.p_PB[i](k) - model.p_PM(k);
  }
  for (std::size_t n = 0; n < places.size(); ++n) {
    auto& item = model.loads.items[n];
    if (item.kind == LoadModel<Inner<S>>::Kind::kMoment) continue;  // it acts anywhere
    for (int k = 0; k < 3; ++k) item.lever(k) = Inner<S>(S(places[n](k))) - model.p_PM(k);
  }
}

/// The pose with its six variables.
template <class S>
Statics<Inner<S>> statics_at(const Model<Inner<S>>& model, const RigidPose& pose) {
  using T = Inner<S>;
  Vector3<T> p;
  for (int k = 0; k < 3; ++k) p(k) = T(S(pose.p(k)), kPosition + k);
  const Matrix3<double> r0 = pose.q.toRotationMatrix();
  Matrix3<T> r;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      r(i, j) = T(S(r0(i, j)));
      // (ω × r)_i
      const int a = (i + 1) % 3;
      const int b = (i + 2) % 3;
      r(i, j).partial[static_cast<std::size_t>(kTurn + a)] = S(r0(b, j));
      r(i, j).partial[static_cast<std::size_t>(kTurn + b)] = S(-r0(a, j));
    }
  }
  return statics(model, p, r);
}

template <class S>
S norm(const S* x, std::size_t n) {
  S square(0.0);
  for (std::size_t k = 0; k < n; ++k) square = square + sqr(x[k]);
  if (!certainly_positive(square)) return S(0.0);  // where a tolerance does nothing it takes nothing
  return sqrt(square);
}

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

/// Tolerances as numbers.
struct Sizes {
  std::array<double, kCables> base{}, platform{}, length{};
  double load_point = 0, position = 0, turn = 0;
  std::array<double, 6> wrench{};
};

Sizes sizes_of(const Problem& problem) {
  const std::optional<TolerancesText>& tolerances = problem.tolerances;
  Sizes result;
  if (!tolerances) return result;
  std::ranges::transform(tolerances->base_anchor_m, result.base.begin(), number);
  std::ranges::transform(tolerances->platform_anchor_m, result.platform.begin(), number);
  std::ranges::transform(tolerances->wrench, result.wrench.begin(), number);
  if (tolerances->cable_length_m) std::ranges::transform(*tolerances->cable_length_m, result.length.begin(), number);
  if (const RowsText* const rows = stated_rows(problem)) {
    for (std::size_t i = 0; i < kCables; ++i) result.length[i] += number(rows->error_m[i]);
  }
  result.load_point = number(tolerances->load_point_m);
  result.position = number(tolerances->position_m);
  result.turn = evaluate_constant<double>(tolerances->orientation_rad);
  return result;
}

/// M⁻¹ of M = ∂(lengths)/∂(pose), as far as it exists.
template <class S>
struct LengthControl {
  Matrix6<S> inverse;
  bool regular = false;
};

template <class S>
LengthControl<S> length_control(const Statics<Inner<S>>& statics) {
  Matrix6<S> by_pose;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      by_pose(i, k) = statics.length[static_cast<std::size_t>(i)].partial[static_cast<std::size_t>(kDesign + k)];
    }
  }
  LengthControl<S> result;
  S determinant;
  result.regular = invert(by_pose, result.inverse, determinant);
  return result;
}

/// The derivatives of a quantity by the machine's parameters where lengths hold the platform, and by the lengths.
template <class S>
std::array<S, kCables> follow_lengths(Inner<S>& quantity, const Statics<Inner<S>>& statics, const Matrix6<S>& inverse) {
  std::array<S, kCables> by_length;
  for (int i = 0; i < 6; ++i) {
    S sum(0.0);
    for (int k = 0; k < 6; ++k) {
      sum = sum + quantity.partial[static_cast<std::size_t>(kDesign + k)] * inverse(k, i);
    }
    by_length[static_cast<std::size_t>(i)] = sum;
  }
  for (std::size_t j = 0; j < kDesign; ++j) {
    for (std::size_t i = 0; i < kCables; ++i) {
      quantity.partial[j] = quantity.partial[j] - by_length[i] * statics.length[i].partial[j];
    }
  }
  return by_length;
}

/// Nominal margin and losses in scalar S.
template <class S>
struct Budget {
  S quantity, nominal;
  std::array<S, kUncertaintyKinds> loss;
};

bool is_tension(MarginId id) { return id.kind == MarginKind::kTensionMin || id.kind == MarginKind::kTensionMax; }

template <class S>
Budget<S> budget(const Model<Inner<S>>& model, const Statics<Inner<S>>& statics, const Sizes& sizes,
                 const std::optional<LengthControl<S>>& control, bool anchors_lead, MarginId id) {
  const auto n = static_cast<std::size_t>(id.cable);
  Inner<S> limited = limited_quantity(statics, id);
  const Inner<S>& nominal = is_tension(id) ? statics.tension[n] : statics.length[n];
  Budget<S> result;
  result.quantity = nominal.value;
  result.nominal = slack(model, nominal, id).value;
  result.loss.fill(S(0.0));
  const auto loss = [&](UncertaintyKind kind) -> S& { return result.loss[static_cast<std::size_t>(kind)]; };
  loss(UncertaintyKind::kWrenchSet) = result.nominal - slack(model, limited, id).value;
  std::array<S, kCables> by_length;
  by_length.fill(S(0.0));
  const std::array<S, 6> tracked = [&] {
    std::array<S, 6> x;
    std::copy_n(limited.partial.begin() + kDesign, 6, x.begin());
    return x;
  }();
  if (control) {
    Inner<S> led = limited;
    by_length = follow_lengths(led, statics, control->inverse);
    if (anchors_lead) limited = led;
  }
  const auto& g = limited.partial;
  for (std::size_t i = 0; i < kCables; ++i) {
    loss(UncertaintyKind::kBaseAnchors) =
        loss(UncertaintyKind::kBaseAnchors) + S(sizes.base[i]) * norm(&g[kBase + 3 * i], 3);
    loss(UncertaintyKind::kPlatformAnchors) =
        loss(UncertaintyKind::kPlatformAnchors) + S(sizes.platform[i]) * norm(&g[kPlatform + 3 * i], 3);
    loss(UncertaintyKind::kCableLengths) =
        loss(UncertaintyKind::kCableLengths) + S(sizes.length[i]) * absolute(by_length[i]);
  }
  S load(0.0);
  for (std::size_t k = 0; k < 6; ++k) load = load + S(sizes.wrench[k]) * g[kWrench + k];
  loss(UncertaintyKind::kLoad) = absolute(load);
  loss(UncertaintyKind::kLoadPoint) = S(sizes.load_point) * norm(&g[kLoadPoint], 3);
  loss(UncertaintyKind::kPosition) = S(sizes.position) * norm(tracked.data(), 3);
  loss(UncertaintyKind::kOrientation) = S(sizes.turn) * norm(tracked.data() + 3, 3);
  return result;
}

double limit_of(const Model<Inner<double>>& model, MarginId id) {
  const auto n = static_cast<std::size_t>(id.cable);
  switch (id.kind) {
    case MarginKind::kTensionMin: return model.tension_lower[n].value;
    case MarginKind::kTensionMax: return model.tension_upper[n].value;
    case MarginKind::kLengthMin: return model.length_lower[n].value;
    case MarginKind::kLengthMax: break;
  }
  return model.length_upper[n].value;
}

DesignParameter parameter(DesignParameter::Kind kind, std::size_t index = 0, std::size_t axis = 0) {
  DesignParameter result;
  result.kind = kind;
  result.index = index;
  result.axis = axis;
  return result;
}

DesignParameter parameter(DesignParameter::Kind kind, const Uncertainty& uncertainty) {
  DesignParameter result = parameter(kind);
  result.uncertainty = uncertainty;
  return result;
}

DesignParameter design_parameter(int variable) {
  using Kind = DesignParameter::Kind;
  const auto n = static_cast<std::size_t>(variable);
  if (variable < kPlatform) return parameter(Kind::kBaseAnchor, n / 3, n % 3);
  if (variable < kLoadPoint) return parameter(Kind::kPlatformAnchor, (n - kPlatform) / 3, n % 3);
  if (variable < kWrench) return parameter(Kind::kLoadPoint, 0, n - kLoadPoint);
  return parameter(Kind::kWrench, 0, n - kWrench);
}

DesignParameter limit_parameter(MarginId id) {
  using Kind = DesignParameter::Kind;
  constexpr std::array kKinds = {Kind::kTensionLower, Kind::kTensionUpper, Kind::kLengthLower, Kind::kLengthUpper};
  return parameter(kKinds.at(static_cast<std::size_t>(id.kind)), static_cast<std::size_t>(id.cable));
}

double loss_of(const MarginBudget& budget, const Uncertainty& uncertainty) {
  switch (uncertainty.kind) {
    case UncertaintyKind::kAll: return budget.all_losses();
    case UncertaintyKind::kLoadItem: {
      const auto found =
          std::ranges::find(budget.loss_by_item, uncertainty.item, [](const auto& x) { return x.first; });
      return found == budget.loss_by_item.end() ? 0 : found->second;
    }
    default: return budget.loss.at(static_cast<std::size_t>(uncertainty.kind));
  }
}

}  // namespace

double MarginBudget::all_losses() const { return std::accumulate(loss.begin(), loss.end(), 0.0); }

double MarginBudget::share(const Uncertainty& uncertainty) const {
  const double own = loss_of(*this, uncertainty);
  const double available = nominal - (all_losses() - own);
  if (!(available > 0)) return 0;
  return own > 0 ? available / own : std::numeric_limits<double>::infinity();
}

struct MarginDifferentiator::Data {
  Data(const Problem& of, bool is_length_controlled)
      : problem(of),
        plain(make_model<double>(of)),
        model(seeded<double>(of)),
        sizes(sizes_of(of)),
        stated(stated_uncertainties(of)),
        anchors_lead(is_length_controlled),
        lengths_lead(is_length_controlled || stated_rows(of) != nullptr) {}

  Problem problem;
  Model<double> plain;
  std::vector<Vector3<double>> places{};                               ///< of items
  std::vector<std::pair<std::string, LoadModel<double>>> deviating{};  ///< items that do, each alone
  Model<Inner<double>> model;
  Sizes sizes;
  std::vector<Uncertainty> stated;
  std::vector<std::string> weights{};  ///< the names of items that are, by their index; else empty
  bool anchors_lead, lengths_lead;  ///< to where the platform is: anchors and lengths, or lengths of the robot as typed

  /// What each deviating item may take of the tensions' margins at a pose, in the order of all_margins().
  [[nodiscard]] std::vector<std::vector<double>> item_losses(const RigidPose& pose) const;
  /// The derivative of what is left of a margin by the outer variable.
  [[nodiscard]] double derivative(Model<Inner<Outer>>& changed, const RigidPose& pose, MarginId margin) const;
};

std::vector<std::vector<double>> MarginDifferentiator::Data::item_losses(const RigidPose& pose) const {
  std::vector<std::vector<double>> result(deviating.size(), std::vector<double>(all_margins().size(), 0.0));
  if (deviating.empty()) return result;
  const Matrix3<double> r = pose.q.toRotationMatrix();
  const CableGeometry<double> geometry = cable_geometry(plain, Vector3<double>(pose.p), r);
  Matrix6<double> y;
  double determinant = 0;
  if (!invert(geometry.force_density, y, determinant)) return result;
  for (std::size_t n = 0; n < deviating.size(); ++n) {
    const LoadModel<double>& item = deviating[n].second;
    const LoadsAtPose<double> here = loads_at(item, r);
    for (std::size_t i = 0; i < kCables; ++i) {
      const auto row = Vector6<double>(y.row(static_cast<Eigen::Index>(i)).transpose());
      const DensityRange<double> range = density_range(item, here, row);
      result[n][i] = length(geometry.p_AB_W[i]) * range.below;
      result[n][kCables + i] = length(geometry.p_AB_W[i]) * range.above;
    }
  }
  return result;
}

double MarginDifferentiator::Data::derivative(Model<Inner<Outer>>& changed, const RigidPose& pose,
                                              MarginId margin) const {
  set_arms(changed, places);
  const Statics<Inner<Outer>> at = statics_at(changed, pose);
  std::optional<LengthControl<Outer>> control;
  if (lengths_lead) control = length_control(at);
  const Budget<Outer> found = budget(changed, at, sizes, control, anchors_lead, margin);
  Outer left = found.nominal;
  for (const Outer& loss : found.loss) left = left - loss;
  return left.partial[0];
}

MarginDifferentiator::MarginDifferentiator(const Problem& problem, bool length_controlled) {
  auto data = std::make_unique<Data>(problem, length_controlled);
  data->places = item_places(data->plain);
  set_arms(data->model, data->places);
  const std::vector<std::string> deviating = deviating_items(problem.load);
  for (std::size_t n = 0; n < problem.load.items.size(); ++n) {
    const LoadItem& item = problem.load.items[n];
    data->weights.push_back(std::holds_alternative<Weight>(item.what) ? item.name : "");
    if (std::ranges::find(deviating, item.name) == deviating.end()) continue;
    data->deviating.push_back({item.name, LoadModel<double>{{data->plain.loads.items[n]}}});
  }
  data_ = std::move(data);
}

MarginDifferentiator::~MarginDifferentiator() = default;

std::optional<std::array<MarginBudget, std::size_t{4} * kCables>> MarginDifferentiator::budgets(
    const RigidPose& pose, const Vector6<double>& inertial_wrench) const {
  Model<Inner<double>> model = data_->model;
  for (int k = 0; k < 6; ++k) model.wrench(k).value -= inertial_wrench(k);
  const Statics<Inner<double>> at = statics_at(model, pose);
  if (!at.regular) return std::nullopt;
  std::optional<LengthControl<double>> control;
  if (data_->lengths_lead) {
    control = length_control(at);
    if (!control->regular) return std::nullopt;
  }
  std::array<MarginBudget, std::size_t{4} * kCables> result;
  const std::vector<std::vector<double>> item_losses = data_->item_losses(pose);
  std::size_t n = 0;
  for (const MarginId id : all_margins()) {
    const Budget<double> found = budget(model, at, data_->sizes, control, data_->anchors_lead, id);
    result[n] = {id, found.quantity, limit_of(model, id), found.nominal, found.loss};
    for (std::size_t k = 0; k < item_losses.size(); ++k) {
      result[n].loss_by_item.emplace_back(data_->deviating[k].first, item_losses[k][n]);
    }
    if (!std::isfinite(result[n].left())) return std::nullopt;
    ++n;
  }
  return result;
}

std::vector<Derivative> MarginDifferentiator::derivatives(const RigidPose& pose, MarginId margin) const {
  std::vector<Derivative> result;
  // Models of nested jets are too large for a stack.
  const auto varied = std::make_unique<const Model<Inner<Outer>>>(seeded<Outer>(data_->problem));
  const bool has_wrench = data_->plain.has_ellipsoid;
  for (int variable = 0; variable < (has_wrench ? kDesign : kLoadPoint); ++variable) {
    const auto model = std::make_unique<Model<Inner<Outer>>>(*varied);
    vary(*model, variable);
    result.push_back({design_parameter(variable), data_->derivative(*model, pose, margin)});
  }
  if (has_wrench) {
    double by_weight = 0;
    for (int k = 0; k < 6; ++k) {
      by_weight += data_->model.wrench(k).value * result[static_cast<std::size_t>(kWrench + k)].value;
    }
    result.push_back({parameter(DesignParameter::Kind::kWeight), by_weight});
  }
  for (std::size_t n = 0; n < data_->weights.size(); ++n) {
    if (data_->weights[n].empty()) continue;
    const auto model = std::make_unique<Model<Inner<Outer>>>(*varied);
    Outer& mass = model->loads.items[n].nominal.value;
    mass = Outer(mass.value, 0);
    const Uncertainty item(UncertaintyKind::kLoadItem, data_->weights[n]);
    result.push_back({parameter(DesignParameter::Kind::kMass, item), data_->derivative(*model, pose, margin)});
  }
  const bool is_lower = margin.kind == MarginKind::kTensionMin || margin.kind == MarginKind::kLengthMin;
  for (const MarginId id : all_margins()) {
    result.push_back({limit_parameter(id), id == margin ? (is_lower ? -1.0 : 1.0) : 0.0});
  }
  const auto all = budgets(pose);
  const auto own = std::ranges::find_if(*all, [&](const MarginBudget& b) { return b.id == margin; });
  for (const Uncertainty& uncertainty : data_->stated) {
    result.push_back({parameter(DesignParameter::Kind::kTolerance, uncertainty), -loss_of(*own, uncertainty)});
  }
  return result;
}

}  // namespace taut
