// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/gravest_witness.h"

#include <algorithm>
#include <utility>

#include "certify/deviation_search.h"
#include "certify/severity.h"

namespace taut {
namespace {

constexpr std::size_t kMostProved = 4;  ///< of either kind that are tried

/// The largest of some boxes around the place of a violation whose midpoint is still next to that place; nothing where
/// none is.
std::optional<DyadicBox> box_around(const SuspectedViolation& violation) {
  using boost::multiprecision::cpp_int;
  const Dyadic& s = violation.at;
  for (const int depth : {8, 12, 16, 24}) {
    const cpp_int cells = cpp_int(1) << depth;
    const cpp_int k = (s.k << depth) >> s.depth;
    const DyadicBox box{k < cells ? k : cpp_int(cells - 1), depth};
    if (box.mid() >= violation.from && box.mid() <= violation.to) return box;
  }
  return std::nullopt;
}

}  // namespace

void GravestWitness::Suspects::add(Suspect suspect) {
  std::vector<Suspect>& all = suspect.violation.singular ? singular : limits;
  const auto is_graver = [](const Suspect& a, const Suspect& b) { return a.violation.severity > b.violation.severity; };
  all.insert(std::ranges::upper_bound(all, suspect, is_graver), std::move(suspect));
  if (all.size() > kMostProved) all.pop_back();
}

void GravestWitness::Suspects::add(Suspects other) {
  for (std::vector<Suspect>* of : {&other.singular, &other.limits}) {
    for (Suspect& suspect : *of) add(std::move(suspect));
  }
}

void GravestWitness::add(const std::shared_ptr<const Batch>& batch, std::size_t i, const SegmentStretch& part) {
  for (const auto& suspected : {part.sampled.singular, part.sampled.worst}) {
    if (suspected) here_.add({batch, i, *suspected});
  }
  if (!part.stretch.violations) return;
  const auto& contact = part.sampled.contact;
  if (contact && (!deepest_ || contact->gap < deepest_->contact.gap)) deepest_ = Touching{batch, i, *contact};
  take({part.stretch.violations->first, batch, i});
  take({part.stretch.violations->second, batch, i});
}

void GravestWitness::end_stretch(bool is_violated) {
  const Suspects here = std::exchange(here_, {});
  if (is_violated) all_.add(here);
}

void GravestWitness::take(Found found) {
  const double grave = severity(found.witness.violation, prover_.problem().robot);
  if (gravest_ && !(grave > severity_)) return;
  severity_ = grave;
  gravest_ = std::move(found);
}

std::optional<GravestWitness::Found> GravestWitness::find() {
  if (deepest_) {
    if (auto proved = prove_contact(*deepest_)) take(*std::move(proved));
  }
  for (const std::vector<Suspect>& suspects : {all_.singular, all_.limits}) {
    for (const Suspect& suspect : suspects) {
      if (!gravest_ || gravest_->witness.violation.singular) return std::move(gravest_);
      if (!suspect.violation.singular && suspect.violation.severity <= severity_) break;
      if (auto proved = prove(suspect)) {
        take(*std::move(proved));
        break;
      }
    }
  }
  const bool may_deviate = prover_.problem().tolerances && gravest_ && gravest_->witness.violation.deviation;
  if (may_deviate && !all_.limits.empty()) {
    if (auto proved = prove_by_a_deviation(all_.limits.front())) take(*std::move(proved));
  }
  return std::move(gravest_);
}

std::optional<GravestWitness::Found> GravestWitness::prove(const Suspect& suspect) const {
  return suspect.violation.singular ? prove_singular(suspect) : prove_limit(suspect);
}

std::optional<GravestWitness::Found> GravestWitness::prove_singular(const Suspect& suspect) const {
  const Segment& segment = suspect.batch->segments[suspect.segment].segment;
  const auto index = static_cast<int>(suspect.batch->first_segment + suspect.segment);
  for (const SuspectedViolation& tried : {narrowed(prover_.sampler(), segment, suspect.violation), suspect.violation}) {
    PathWitness witness;
    witness.singular = true;
    witness.at = {true, index, tried.from};
    witness.to = {true, index, tried.to};
    if (auto proved = elaborated(suspect.batch, suspect.segment, witness)) return proved;
  }
  return std::nullopt;
}

std::optional<GravestWitness::Found> GravestWitness::prove_limit(const Suspect& suspect) const {
  const Segment& segment = suspect.batch->segments[suspect.segment].segment;
  const SuspectedViolation worst = narrowed(prover_.sampler(), segment, suspect.violation);
  const Limits& limits = limits_of(prover_.problem().robot, worst.margin);
  PathWitness witness;
  witness.at = {true, static_cast<int>(suspect.batch->first_segment + suspect.segment), worst.at};
  witness.margin = worst.margin;
  witness.limit = is_upper(worst.margin) ? limits.upper : limits.lower;
  return elaborated(suspect.batch, suspect.segment, witness);
}

/// Where only deviations break limits: where the undisturbed machine comes nearest to one.
std::optional<GravestWitness::Found> GravestWitness::prove_by_a_deviation(const Suspect& suspect) const {
  const Segment& segment = suspect.batch->segments[suspect.segment].segment;
  const SuspectedViolation worst = narrowed(prover_.sampler(), segment, suspect.violation);
  const auto box = box_around(worst);
  if (!box) return std::nullopt;
  const auto found = DeviationSearch(prover_, segment).refute(*box, worst.margin);
  if (!found) return std::nullopt;
  const auto index = static_cast<int>(suspect.batch->first_segment + suspect.segment);
  return elaborated(suspect.batch, suspect.segment, path_witness(prover_, segment, index, *found));
}

std::optional<GravestWitness::Found> GravestWitness::prove_contact(const Touching& suspect) const {
  const Segment& segment = suspect.batch->segments[suspect.segment].segment;
  const PoseSampler& sampler = prover_.sampler();
  const auto& [pair, at, gap] = suspect.contact;
  PathWitness witness;
  witness.at = {true, static_cast<int>(suspect.batch->first_segment + suspect.segment), at};
  for (PairContact& way : prover_.bodies()->contacts(sampler.model(), sampler.rigid_pose(segment, at.approx()), pair)) {
    witness.contact = std::move(way);
    if (auto found = elaborated(suspect.batch, suspect.segment, witness)) return found;
  }
  return std::nullopt;
}

std::optional<GravestWitness::Found> GravestWitness::elaborated(const std::shared_ptr<const Batch>& batch,
                                                                std::size_t segment, const PathWitness& witness) const {
  auto proved = elaborator_.witness(batch->segments[segment].segment, witness);
  if (!proved) return std::nullopt;
  return Found{*std::move(proved), batch, segment};
}

}  // namespace taut
