// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace taut {

namespace {

constexpr std::size_t kPathSamples = 800;   ///< along the whole path; about one a pixel of a wide plot
constexpr std::size_t kManyBoxes = 20'000;  ///< more are not halved: each is a fraction of a pixel

PathRanges ranges_of(const CertificateView& view) {
  if (view.boxes == 0) return {};
  RangeOptions options;
  if (view.boxes > kManyBoxes) options.most_halvings = 0;
  return path_ranges(Prover(view.problem), view.path, view.segment_boxes, options);
}

bool is_covered(const std::vector<DyadicBox>& boxes) {
  Dyadic reached{0, 0};
  for (const DyadicBox& box : boxes) {
    if (box.lower() != reached) return false;
    reached = box.upper();
  }
  return reached == Dyadic{1, 0};
}

CertificateView view_of(const checker::CheckResult& checked) {
  if (checked.theorem) return read_certificate(checked.theorem->certificate());
  if (checked.certificate == nullptr) throw std::logic_error("a report was asked for of a malformed certificate");
  return read_certificate(*checked.certificate);
}

Recheck recheck_of(const checker::CheckResult& checked) {
  Recheck result{Recheck::Result::kUnchecked, fmt::format("taut-check {}", TAUT_VERSION), checked.message};
  switch (checked.outcome) {
    case checker::Outcome::kAccepted: result.result = Recheck::Result::kConfirmed; break;
    case checker::Outcome::kUndecided: result.result = Recheck::Result::kNoClaim; break;
    case checker::Outcome::kUnchecked: break;
    case checker::Outcome::kRejected:
    case checker::Outcome::kMalformed: throw std::logic_error("a report was asked for of a rejected certificate");
  }
  return result;
}

/// The part of a certificate without a theorem that may be shown: problem, path and, if it claims nothing, the reason.
CertificateView without_claims(CertificateView view, Recheck::Result result) {
  view.claim.clear();
  view.segments.clear();
  view.segment_boxes.clear();
  view.boxes = 0;
  view.margins.reset();
  view.witness.reset();
  view.tolerance_limits.clear();
  if (result == Recheck::Result::kNoClaim) {
    for (StretchView& stretch : view.stretches) stretch.first = stretch.last = std::nullopt;
    return view;
  }
  view.verdict = "unchecked";
  view.undecided.reset();
  view.stretches.clear();
  return view;
}

}  // namespace

ReportContext::ReportContext(const checker::CheckResult& checked)
    : ReportContext(view_of(checked), recheck_of(checked)) {}

ReportContext::ReportContext(CertificateView certificate, Recheck checked)
    : recheck(std::move(checked)),
      view(recheck.result == Recheck::Result::kConfirmed ? std::move(certificate)
                                                         : without_claims(std::move(certificate), recheck.result)),
      sampler(view.problem),
      samples(sampler.along(view.path, kPathSamples)),
      travel(sampler, view.path),
      ranges(ranges_of(view)) {
  ranges_are_whole = !view.segments.empty() && view.segments.size() == view.path.segments() && ranges.missing == 0 &&
                     std::ranges::all_of(view.segment_boxes, is_covered);
}

std::string unit(const SpaceText& space, std::size_t j) {
  const Parameter& parameter = space.parameters[j];
  for (std::size_t c = 0; c < space.pose.size(); ++c) {
    if (space.pose[c] == parameter.name) return c < 3 ? "m" : "rad";
  }
  const bool angular = parameter.kind == ParameterKind::kPeriodic ||
                       (parameter.range_lower + parameter.range_upper).find("pi") != std::string::npos;
  return angular ? "rad" : "";
}

std::string in_brackets(const std::string& unit) { return unit.empty() ? "" : fmt::format("[{}]", unit); }

}  // namespace taut
