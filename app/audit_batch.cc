// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/audit_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "certificate/certificate_writer.h"

namespace taut {
namespace {

/// How many places of a stretch are sampled on a segment, so that all of them take next to no time.
int samples_for(std::size_t segments) {
  constexpr std::size_t kInAll = 16'384;
  constexpr std::size_t kFewest = 2;
  constexpr std::size_t kMost = 256;
  return static_cast<int>(std::clamp(kInAll / std::max<std::size_t>(segments, 1), kFewest, kMost));
}

}  // namespace

Segment Batch::segment(Interpolation law, std::size_t i) const {
  Segment result{law, {}, 0};
  for (std::size_t c = 0; c < control_points(law); ++c) result.control[c] = &waypoints[i + c].waypoint;
  return result;
}

std::string time_text(const SourceWaypoint& waypoint) { return waypoint.time_s ? waypoint.time_s->text() : ""; }

// ---- BatchReader ----------------------------------------------------------------------------------------------------

BatchReader::BatchReader(PathSource& source, std::size_t batch_segments)
    : source_(source),
      batch_segments_(batch_segments),
      shared_(control_points(source.law()) - 1),
      sampler_(source.problem()) {}

std::shared_ptr<Batch> BatchReader::next() {
  auto batch = std::make_shared<Batch>();
  batch->first_segment = next_segment_;
  batch->waypoints = std::move(tail_);
  batch->old_waypoints = batch->waypoints.size();
  const std::size_t wanted = batch_segments_ + shared_;
  SourceWaypoint waypoint;
  while (batch->waypoints.size() < wanted && source_.next(waypoint)) {
    if (waypoint.is_copy) {
      waypoint.waypoint = batch->waypoints.back().waypoint;
      waypoint.line = batch->waypoints.back().line;
    }
    batch->waypoints.push_back(waypoint);
  }
  if (batch->waypoints.size() == batch->old_waypoints) return nullptr;
  const std::size_t segments = batch->waypoints.size() - shared_;
  batch->segments.resize(segments);
  next_segment_ += segments;
  require_on_constraints(*batch);
  tail_.assign(batch->waypoints.end() - static_cast<std::ptrdiff_t>(shared_), batch->waypoints.end());
  return batch;
}

void BatchReader::require_on_constraints(const Batch& batch) const {
  if (!sampler_.constraints()) return;
  for (std::size_t i = 0; i < batch.segments.size(); ++i) {
    const Segment segment = batch.segment(source_.law(), i);
    for (const bool at_end : {false, true}) {
      const double off = sampler_.distance_to_constraints(segment, at_end);
      if (off <= kWaypointTolerance) continue;
      const std::size_t line = batch.waypoints[i + (at_end ? 1 : 0)].line;
      throw InputError(
          fmt::format("{}, {} {}: got a pose off the constraints, by {:.3g} of the platform's size or {:.3g} rad, "
                      "expected at most {}: what is proved is the motion on the constraints",
                      source_.name(), source_.place_name(), line, off, off, kWaypointTolerance),
          {source_.name(), line});
    }
  }
}

// ---- BatchProver ----------------------------------------------------------------------------------------------------

BatchProver::BatchProver(const Prover& prover, const Elaborator& elaborator, const PathSource& source)
    : elaborator_(elaborator),
      prover_(prover),
      problem_(source.problem()),
      law_(source.law()),
      csv_(source.problem(), source.law(), source.has_times()),
      samples_(samples_for(source.segments())) {}

void BatchProver::prove(Batch& batch, const std::stop_token& stop) const {
  const std::size_t first_waypoint = batch.first_segment;
  for (std::size_t i = batch.old_waypoints; i < batch.waypoints.size(); ++i) {
    const SourceWaypoint& waypoint = batch.waypoints[i];
    batch.waypoint_texts.push_back(waypoint_text(law_, waypoint.waypoint));
    if (!waypoint.is_copy) batch.csv += csv_.row(first_waypoint + i, waypoint.waypoint, time_text(waypoint));
  }
  for (std::size_t i = 0; i < batch.segments.size(); ++i) batch.segments[i] = prove(batch, i, stop);
}

SegmentResult BatchProver::prove(const Batch& batch, std::size_t i, const std::stop_token& stop) const {
  SegmentResult result;
  result.segment = prover_.prepared(batch.segment(law_, i));
  SegmentSurvey survey = prover_.survey(result.segment, stop);
  result.boxes_judged = survey.boxes_judged;
  const std::size_t number = batch.first_segment + i;
  for (SurveyedBox& box : survey.boxes) {
    if (box.kind != SurveyedBox::Kind::kProved) continue;
    const bool has_bodies = box.directions != nullptr;
    const auto confirmed =
        elaborator_.boxes(result.segment, std::span(&box.box, 1), std::span(&box.directions, has_bodies ? 1 : 0));
    if (confirmed) {
      result.boxes.insert(result.boxes.end(), confirmed->begin(), confirmed->end());
    } else {
      box.kind = SurveyedBox::Kind::kOpen;
      box.reason = Undecided::kKernel;
    }
  }
  for (const Gap& gap : gaps(survey)) result.stretches.push_back(stretch(result.segment, number, gap));
  if (!problem_.bodies) result.text = segment_text(make_segment(result.boxes), number, problem_, law_);
  return result;
}

SegmentStretch BatchProver::stretch(const Segment& segment, std::size_t number, const Gap& gap) const {
  const auto index = static_cast<int>(number);
  SegmentStretch result;
  result.stretch = {{true, index, gap.begin}, {true, index, gap.end}, std::nullopt, gap.reason.text()};
  if (gap.first) {
    const auto witness = [&](const SegmentWitness& end) {
      return elaborator_.witness(segment, path_witness(prover_, segment, index, end));
    };
    std::optional<Witness> first = witness(*gap.first);
    std::optional<Witness> last = witness(*gap.last);
    if (first && last) {
      result.stretch.violations = {std::move(*first), std::move(*last)};
    } else {
      result.stretch.reason = Reason(Undecided::kKernel).text();
    }
  }
  if (!elaborator_.is_implied()) result.sampled = sampled(segment, gap);
  if (elaborator_.is_implied()) {
    const auto& violations = result.stretch.violations;
    const Dyadic end = violations ? violations->first.violation.at.s : gap.end;
    if (auto boxes = elaborator_.motion(segment, gap.begin, end)) {
      result.motion.emplace();
      for (checker::Box& box : *boxes) result.motion->push_back({number, std::move(box)});
    }
  }
  return result;
}

SampledViolations BatchProver::sampled(const Segment& segment, const Gap& gap) const {
  SampledViolations result = sample_violations(prover_.sampler(), segment, gap.begin, gap.end, samples_);
  if (gap.singular) {
    const DyadicBox& box = gap.singular->box;
    result.singular = SuspectedViolation{true, {}, box.lower(), box.lower(), box.upper(), 0};
  }
  for (const auto* end : {&gap.first, &gap.last}) {
    if (!*end || !(*end)->contact) continue;
    const auto deepest = deepest_contact(prover_.sampler(), *prover_.bodies(), segment, (*end)->contact->pair,
                                         gap.begin, gap.end, samples_);
    if (deepest && (!result.contact || deepest->gap < result.contact->gap)) result.contact = deepest;
  }
  return result;
}

}  // namespace taut
