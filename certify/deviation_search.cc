// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/deviation_search.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "kinematics/statics.h"
#include "kinematics/time_limits.h"

namespace taut {
namespace {

/// The rung at which deviations are examined: each continuation step costs digits.
std::size_t rung_of(const PrecisionLadder& ladder) {
  constexpr std::size_t kWanted = 2;
  return std::min(kWanted, ladder.last());
}

}  // namespace

std::optional<MpInterval> deviated_at_mid(const Prover& prover, const Segment& segment, const DyadicBox& box,
                                          MarginId margin, const Deviation& deviation) {
  const std::size_t rung = rung_of(prover.ladder());
  const PrecisionScope precision(prover.ladder().bits(rung));
  const ProofModel<MpInterval>& model = prover.ladder().multiprecision(rung);
  Faults<MpInterval>::clear();
  const auto mid = enclose<MpInterval>(box.mid());
  const MotionEnclosure<MpInterval> commanded = undisturbed_motion(model, segment, {mid, mid}, MpInterval(0.0));
  if (commanded.status != MotionEnclosure<MpInterval>::Status::kKnown) return std::nullopt;
  const auto at_mid = [](const SlopeForm<MpInterval>& x) { return x.at_mid; };
  InertiaAt inertia;
  if (segment.timing != nullptr) {
    const std::optional<Moving<MpInterval>> moving = model.moving->at(model.model, segment, mid);
    if (!moving) return std::nullopt;
    inertia = [&model, rates = moving->rates](const Matrix3<MpInterval>& r) { return model.moving->inertia(r, rates); };
  }
  MpInterval quantity = deviated_quantity(model.model, *prover.problem().tolerances, commanded.p_WP.unaryExpr(at_mid),
                                          commanded.r_WP.unaryExpr(at_mid), deviation, margin, inertia);
  if (Faults<MpInterval>::raised()) return std::nullopt;
  return quantity;
}

namespace {

/// |L̇| of a winch at the midpoint of a box [m/s], enclosed. At the working precision, that of a rung.
std::optional<MpInterval> winch_speed_at_mid(const ProofModel<MpInterval>& model, const Segment& segment,
                                             const DyadicBox& box, int cable) {
  std::optional<Moving<MpInterval>> moving = model.moving->at(model.model, segment, enclose<MpInterval>(box.mid()));
  if (!moving) return std::nullopt;
  model.moving->bound_rates(*moving);
  return moving->winch_speed[static_cast<std::size_t>(cable)];
}

}  // namespace

std::optional<MpInterval> deviated_power_at_mid(const Prover& prover, const Segment& segment, const DyadicBox& box,
                                                int cable, const Deviation& deviation) {
  const std::optional<MpInterval> tension =
      deviated_at_mid(prover, segment, box, {MarginKind::kTensionMax, cable}, deviation);
  if (!tension) return std::nullopt;
  const std::size_t rung = rung_of(prover.ladder());
  const PrecisionScope precision(prover.ladder().bits(rung));
  Faults<MpInterval>::clear();
  const auto speed = winch_speed_at_mid(prover.ladder().multiprecision(rung), segment, box, cable);
  if (!speed) return std::nullopt;
  MpInterval power = *speed * absolute(*tension);
  if (Faults<MpInterval>::raised()) return std::nullopt;
  return power;
}

DeviationSearch::Place DeviationSearch::place(const DyadicBox& box) const {
  Place result{prover_.sampler().rigid_pose(segment_, box.mid().approx()), prover_.sampler().model()};
  if (segment_.timing == nullptr) return result;
  const PrecisionLadder& ladder = prover_.ladder();
  const std::size_t rung = rung_of(ladder);
  const PrecisionScope precision(ladder.bits(rung));
  const ProofModel<MpInterval>& model = ladder.multiprecision(rung);
  const auto moving = model.moving->at(model.model, segment_, enclose<MpInterval>(box.mid()));
  for (int k = 0; moving && k < 6; ++k) {
    const MpInterval& inertia = moving->load.wrench(k);
    result.model.wrench(k) -= (lower_bound(inertia) + upper_bound(inertia)) / 2;
  }
  return result;
}

template <class F>
DyadicBox DeviationSearch::least_box(F left) const {
  DyadicBox result;
  double least = std::numeric_limits<double>::infinity();
  for (DyadicBox box{0, prover_.options().tolerance_depth}; box.upper() <= Dyadic{1, 0}; ++box.k) {
    const Place at = place(box);
    const Statics<double> found = statics(at.model, at.pose.p, Matrix3<double>(at.pose.q.toRotationMatrix()));
    const double here = left(box, at, found);
    if (found.regular && here < least) {
      least = here;
      result = box;
    }
  }
  return result;
}

DyadicBox DeviationSearch::weakest_box(MarginId margin) const {
  return least_box([&](const DyadicBox&, const Place& at, const Statics<double>& found) {
    return slack(at.model, limited_quantity(found, margin), margin);
  });
}

DyadicBox DeviationSearch::strongest_box(RateId power) const {
  const std::size_t rung = rung_of(prover_.ladder());
  const PrecisionScope precision(prover_.ladder().bits(rung));
  return least_box([&](const DyadicBox& box, const Place&, const Statics<double>& found) {
    Faults<MpInterval>::clear();
    const auto speed = winch_speed_at_mid(prover_.ladder().multiprecision(rung), segment_, box, power.cable);
    if (!speed || Faults<MpInterval>::raised()) return std::numeric_limits<double>::infinity();
    return -(upper_bound(*speed) * limited_quantity(found, {MarginKind::kTensionMax, power.cable}));
  });
}

/// Those of `margins` that the worst deviation within this share of the tolerances breaks, or for which it
/// can't be followed.
std::vector<DeviationSearch::Proposal> DeviationSearch::breaking(const Place& place,
                                                                 const std::vector<MarginId>& margins,
                                                                 double share) const {
  std::vector<Proposal> result;
  for (const MarginId margin : margins) {
    auto worst = worst_deviation(*prover_.problem().tolerances, place.model, place.pose, margin,
                                 prover_.is_length_controlled(segment_.law), share);
    if (worst) result.emplace_back(margin, *std::move(worst));
  }
  return result;
}

DeviationSearch::Outcome DeviationSearch::attempt(const DyadicBox& box, const Proposal& proposal) const {
  const auto& [margin, proposed] = proposal;
  if (!proposed.leads_to_pose) return Outcome::kNotFollowed;
  const std::optional<MpInterval> quantity = deviated_at_mid(prover_, segment_, box, margin, proposed.deviation);
  if (!quantity) return Outcome::kNotFollowed;
  const PrecisionLadder& ladder = prover_.ladder();
  const std::size_t rung = rung_of(ladder);
  const PrecisionScope precision(ladder.bits(rung));
  const MpInterval left = slack(ladder.multiprecision(rung).model, *quantity, margin);
  return certainly_nonpositive(left) ? Outcome::kRefutes : Outcome::kHarmless;
}

namespace {

std::vector<MarginId> every_margin() {
  constexpr auto kAll = all_margins();
  return {kAll.begin(), kAll.end()};
}

SegmentWitness witness_of(const DyadicBox& box, MarginId margin, const Deviation& deviation) {
  return {false, margin, box, std::make_shared<const Deviation>(deviation)};
}

}  // namespace

std::optional<SegmentWitness> DeviationSearch::refute(const DyadicBox& box, MarginId margin) {
  if (has_failed_) return std::nullopt;
  const Place here = place(box);
  std::vector<Proposal> proposals = breaking(here, {margin}, 1);
  if (proposals.empty()) {
    // `margin` is the weakest one undisturbed, but others may be more sensitive. They cost more, so they are tried only
    // where this is first asked, and at the segment's end.
    const bool is_last = box.upper() == Dyadic{1, 0};
    if (std::exchange(all_margins_tried_, true) && !is_last) return std::nullopt;
    proposals = breaking(here, every_margin(), 1);
    if (proposals.empty()) return std::nullopt;
  }
  const auto& [broken, proposed] = proposals.front();
  switch (attempt(box, proposals.front())) {
    case Outcome::kRefutes: return witness_of(box, broken, proposed.deviation);
    case Outcome::kHarmless: return std::nullopt;
    case Outcome::kNotFollowed: break;
  }
  std::optional<SegmentWitness> witness = refute_by_smaller(box, here);
  if (!witness) has_failed_ = true;
  return witness;
}

std::optional<SegmentWitness> DeviationSearch::refute_power(const DyadicBox& box, RateId power) const {
  const auto cable = static_cast<std::size_t>(power.cable);
  const std::size_t rung = rung_of(prover_.ladder());
  const PrecisionScope precision(prover_.ladder().bits(rung));
  const ProofModel<MpInterval>& model = prover_.ladder().multiprecision(rung);
  Faults<MpInterval>::clear();
  const auto limit = evaluate_constant<MpInterval>(limit_of(prover_.problem().time.value(), power));
  const auto speed = winch_speed_at_mid(model, segment_, box, power.cable);
  if (!speed || Faults<MpInterval>::raised() || !certainly_positive(*speed)) return std::nullopt;
  // The tension at which the power is at its limit stands in for that of the cable.
  Place here = place(box);
  here.model.tension_upper[cable] = std::min(here.model.tension_upper[cable], lower_bound(limit) / upper_bound(*speed));
  for (const auto& [margin, proposed] : breaking(here, {{MarginKind::kTensionMax, power.cable}}, 1)) {
    if (!proposed.leads_to_pose) continue;
    const auto found = deviated_power_at_mid(prover_, segment_, box, power.cable, proposed.deviation);
    if (!found || !certainly_nonpositive(limit - *found)) continue;
    SegmentWitness witness = witness_of(box, margin, proposed.deviation);
    witness.rate = power;
    return witness;
  }
  return std::nullopt;
}

/// For a worst deviation that can't be followed, as on the way to a singular pose. Some limit breaks before that pose
/// is reached: the share of the tolerances is halved until no limit breaks, then bisected, and taken a little larger,
/// so that the violation can be proved.
std::optional<SegmentWitness> DeviationSearch::refute_by_smaller(const DyadicBox& box, const Place& place) const {
  constexpr double kLeast = 0x1p-20;
  constexpr int kBisections = 8;
  constexpr double kMore = 1 + 0x1p-5;
  constexpr int kAttempts = 2;  // following a deviation by proof takes long
  std::vector<MarginId> margins = every_margin();
  const auto breaks = [&](double share) {
    std::vector<Proposal> found = breaking(place, margins, share);
    if (found.empty()) return false;
    margins.clear();
    for (const Proposal& proposal : found) margins.push_back(proposal.first);
    return true;
  };
  double most = 1;
  while (most > kLeast && breaks(0.5 * most)) most *= 0.5;
  double none = 0.5 * most;
  for (int k = 0; k < kBisections; ++k) {
    const double share = 0.5 * (none + most);
    (breaks(share) ? most : none) = share;
  }
  int attempts = 0;
  for (const Proposal& proposal : breaking(place, margins, std::min(1.0, kMore * most))) {
    const auto& [broken, proposed] = proposal;
    if (!proposed.leads_to_pose || attempts == kAttempts) continue;
    ++attempts;
    if (attempt(box, proposal) == Outcome::kRefutes) return witness_of(box, broken, proposed.deviation);
  }
  return std::nullopt;
}

}  // namespace taut
