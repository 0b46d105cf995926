// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "certificate/certificate_reader.h"
#include "problem/decimal.h"
#include "reports/summary/numbers.h"
#include "reports/summary/time_statement.h"

namespace taut {

namespace {

constexpr std::size_t kPathSamples = 800;   ///< along the whole path; about one a pixel of a wide plot
constexpr std::size_t kManyBoxes = 20'000;  ///< more are not halved: each is a fraction of a pixel

PathRanges ranges_of(const Certificate& certificate, const std::vector<std::vector<DyadicBox>>& boxes) {
  const std::size_t count = count_boxes(certificate);
  if (count == 0) return {};
  RangeOptions options;
  if (count > kManyBoxes) options.most_halvings = 0;
  return path_ranges(Prover(certificate.problem), certificate.path, boxes, options);
}

/// Cuts off what the theorem's margin of this segment excludes; unless nothing is left, as where that margin is false.
void cut(Range& range, const Limits& limits, const DecimalText& margin) {
  const Rational distance = Decimal::parse(margin).rational();
  const double lower = std::max(range.lower, below(Rational(Decimal::parse(limits.lower).rational() + distance)));
  const double upper = std::min(range.upper, above(Rational(Decimal::parse(limits.upper).rational() - distance)));
  if (lower <= upper) range = {lower, upper};
}

/// The margins that the checker proved are sharper at some places than what is enclosed anew, so that two numbers would
/// be stated for one thing.
PathRanges tightened(PathRanges ranges, const Certificate& certificate) {
  const RobotText& robot = certificate.problem.robot;
  for (std::size_t k = 0; k < std::min(ranges.segments.size(), certificate.segments.size()); ++k) {
    const std::optional<Margins>& margins = certificate.segments[k].margins;
    if (!margins) continue;
    for (BoxRanges& box : ranges.segments[k]) {
      for (std::size_t i = 0; i < kCables; ++i) {
        cut(box.tension[i], robot.tension_N[i], margins->tension_N);
        cut(box.length[i], robot.length_m[i], margins->length_m);
      }
    }
  }
  return ranges;
}

std::vector<std::vector<DyadicBox>> boxes_of(const Certificate& certificate) {
  std::vector<std::vector<DyadicBox>> result;
  for (const CertificateSegment& segment : certificate.segments) result.push_back(dyadic_boxes(segment.boxes));
  return result;
}

bool is_covered(const std::vector<DyadicBox>& boxes) {
  Dyadic reached{0, 0};
  for (const DyadicBox& box : boxes) {
    if (box.lower() != reached) return false;
    reached = box.upper();
  }
  return reached == Dyadic{1, 0};
}

/// With the meshes that the checker was given.
Certificate certificate_of(const checker::CheckResult& checked) {
  if (!checked.theorem && checked.certificate == nullptr) {
    throw std::logic_error("a report was asked for of a malformed certificate");
  }
  Certificate certificate = read_certificate(checked.theorem ? checked.theorem->certificate() : *checked.certificate);
  if (!certificate.problem.bodies) return certificate;
  for (const checker::SuppliedMesh& mesh : checked.meshes) {
    const auto indexed = std::make_shared<const IndexedMesh>(TriangleMesh{mesh.points, mesh.triangles, mesh.needles});
    for (auto* bodies : {&certificate.problem.bodies->platform, &certificate.problem.bodies->obstacles}) {
      for (BodyText& body : *bodies) {
        auto* text = std::get_if<MeshText>(&body.shape);
        if (text != nullptr && text->sha256 == mesh.sha256) text->mesh = indexed;
      }
    }
  }
  return certificate;
}

Recheck recheck_of(const checker::CheckResult& checked) {
  Recheck result{Recheck::Result::kUnchecked, fmt::format("taut-check {}", TAUT_VERSION), checked.message,
                 checked.sha256};
  switch (checked.outcome) {
    case checker::Outcome::kAccepted: result.result = Recheck::Result::kConfirmed; break;
    case checker::Outcome::kUndecided: result.result = Recheck::Result::kNoClaim; break;
    case checker::Outcome::kUnchecked: break;
    case checker::Outcome::kRejected:
    case checker::Outcome::kMalformed: throw std::logic_error("a report was asked for of a rejected certificate");
  }
  return result;
}

/// What is left of a certificate that no theorem stands behind: problem, path and, where it claims nothing, why.
Certificate without_claims(Certificate certificate, Recheck::Result result) {
  certificate.verdict = Verdict::kUndecided;
  certificate.claim.clear();
  certificate.segments.clear();
  certificate.margins.reset();
  certificate.witness.reset();
  if (result == Recheck::Result::kNoClaim) {
    for (Stretch& stretch : certificate.stretches) stretch.violations.reset();
    return certificate;
  }
  certificate.undecided.reset();
  certificate.stretches.clear();
  return certificate;
}

Illustration illustration_of(const Certificate& certificate, Recheck::Result result) {
  Illustration illustration(certificate.illustration, certificate.problem.space.parameters.size());
  if (result == Recheck::Result::kUnchecked) illustration.headroom.reset();
  return illustration;
}

std::optional<Witness> gravest_of(const Certificate& certificate) {
  if (is_implied(certificate) || !certificate.witness) return certificate.witness;
  const Witness* gravest = &*certificate.witness;
  const auto consider = [&](const Witness& witness) {
    const Problem& problem = certificate.problem;
    if (severity_of(witness.violation, problem) > severity_of(gravest->violation, problem)) gravest = &witness;
  };
  for (const Stretch& stretch : certificate.stretches) {
    if (!stretch.violations) continue;
    consider(stretch.violations->first);
    consider(stretch.violations->second);
  }
  return *gravest;
}

std::optional<BodyDistances> distances_of(const Problem& problem) {
  const bool is_known = problem.bodies && are_meshes_read(*problem.bodies);
  return is_known ? std::optional<BodyDistances>(problem) : std::nullopt;
}

}  // namespace

ReportContext::ReportContext(const checker::CheckResult& checked)
    : ReportContext(certificate_of(checked), recheck_of(checked)) {}

ReportContext::ReportContext(Certificate stated, Recheck checked)
    : recheck(std::move(checked)),
      certificate(recheck.result == Recheck::Result::kConfirmed ? std::move(stated)
                                                                : without_claims(std::move(stated), recheck.result)),
      verdict(recheck.result == Recheck::Result::kUnchecked ? "unchecked" : name(certificate.verdict)),
      illustration(illustration_of(certificate, recheck.result)),
      boxes(boxes_of(certificate)),
      sampler(certificate.problem),
      samples(sampler.along(certificate.path, kPathSamples)),
      bodies(distances_of(certificate.problem)),
      travel(sampler, certificate.path),
      ranges(tightened(ranges_of(certificate, boxes), certificate)) {
  ranges_are_whole = !certificate.segments.empty() && certificate.segments.size() == certificate.path.segments() &&
                     ranges.missing == 0 && std::ranges::all_of(boxes, is_covered);
  gravest = gravest_of(certificate);
  if (bodies) distances = distances_along(*bodies, sampler, samples);
  if (bodies) shown_meshes = taut::shown_meshes(*certificate.problem.bodies);
}

bool found_no_path(const Certificate& certificate) {
  return certificate.undecided && !certificate.undecided->segment && certificate.stretches.empty();
}

bool is_implied(const Certificate& certificate) {
  return certificate.path.interpolation == Interpolation::kCableLengths ||
         !certificate.problem.space.constraints.empty();
}

double position(const PathPoint& point) { return point.index + (point.on_segment ? point.s.approx() : 0.0); }

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
