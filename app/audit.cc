// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/audit.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

#include "app/audit_batch.h"
#include "app/gravest_witness.h"
#include "base/clock.h"
#include "base/input_error.h"
#include "planner/time_budget.h"
#include "reports/summary/display_units.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/illustration.h"
#include "reports/summary/shown_bodies.h"

namespace taut {
namespace {

/// Takes batches in order, gives the writer what it needs, and keeps what a summary needs.
class BatchWriter {
 public:
  BatchWriter(const PathSource& source, const Prover& prover, const Elaborator& elaborator,
              CertificateWriter& certificate, const WriteText& csv)
      : elaborator_(elaborator),
        gravest_(prover, elaborator),
        problem_(source.problem()),
        tightens_(source.segments() <= kMostReported),
        has_times_(source.has_times()),
        has_lines_(source.counts_lines()),
        has_tubes_(!source.problem().space.constraints.empty()),
        has_pose_tubes_(source.law() == Interpolation::kCableLengths),
        certificate_(certificate),
        csv_(csv) {}

  void write(const std::shared_ptr<const Batch>& shared_batch) {
    const Batch& batch = *shared_batch;
    for (const std::string& text : batch.waypoint_texts) certificate_.add_waypoint(text);
    for (std::size_t i = batch.old_waypoints; has_times_ && i < batch.waypoints.size(); ++i) {
      certificate_.add_time(time_text(batch.waypoints[i]));
    }
    for (std::size_t i = batch.old_waypoints; has_lines_ && i < batch.waypoints.size(); ++i) {
      result_.lines.add(batch.waypoints[i].line);
    }
    csv_(batch.csv);
    for (std::size_t i = 0; i < batch.segments.size(); ++i) {
      const SegmentResult& result = batch.segments[i];
      const Segment& segment = result.segment;
      if (has_tubes_) certificate_.add_tube(segment.tube);
      if (has_pose_tubes_) certificate_.add_pose_tube(segment.pose_tube, segment.inner_poses);
      if (!tightens_) add_segment(result, batch.first_segment + i);
      result_.boxes += result.boxes.size();
      result_.boxes_judged += result.boxes_judged;
      least_.add(result.boxes);
      for (const SegmentStretch& stretch : result.stretches) add(shared_batch, i, stretch);
    }
    result_.segments += batch.segments.size();
    if (tightens_) kept_.push_back(shared_batch);
  }

  /// The summary, once all is written.
  [[nodiscard]] Audit finish() {
    close_stretch();
    if (tightens_) write_kept();
    if (result_.stretches_violated > 0) {
      result_.verdict = Verdict::kRefuted;
      choose_witness();
    } else if (result_.stretches_open == 0) {
      result_.verdict = Verdict::kProved;
      result_.margins = least_.margins();
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] static FilePlace place(const Batch& batch, std::size_t i, const Dyadic& s) {
    // Splines have no waypoint at their joints: the control points that weigh most there are the middle ones.
    const std::size_t shared = batch.waypoints.size() - batch.segments.size();
    const std::size_t before = i + (shared - 1) / 2;
    const SourceWaypoint& a = batch.waypoints[before];
    const SourceWaypoint& b = batch.waypoints[before + 1];
    FilePlace place{a.line, b.line, std::nullopt};
    if (s == Dyadic{0, 0}) place.line_behind = place.line_before;
    if (s == Dyadic{1, 0}) place.line_before = place.line_behind;
    if (a.time_s && b.time_s) {
      const double from = ScalarTraits<double>::from_decimal(a.time_s->text());
      const double to = ScalarTraits<double>::from_decimal(b.time_s->text());
      place.time_s = from + s.approx() * (to - from);
    }
    return place;
  }

  void add_segment(const SegmentResult& result, std::size_t k) {
    if (problem_.bodies) {
      certificate_.add_segment(make_segment(result.boxes), k);
    } else {
      certificate_.add_segment(result.text, result.boxes.size());
    }
  }

  /// Writes the segments of a path that is short enough to be looked at once more: with tighter margins, if it is
  /// proved.
  void write_kept() {
    std::vector<const SegmentResult*> all;
    for (const auto& batch : kept_) {
      for (const SegmentResult& segment : batch->segments) all.push_back(&segment);
    }
    if (result_.stretches_violated + result_.stretches_open > 0) {
      for (std::size_t k = 0; k < all.size(); ++k) add_segment(*all[k], k);
      return;
    }
    std::vector<std::vector<KernelBox>> boxes;
    for (const SegmentResult* segment : all) boxes.push_back(segment->boxes);
    elaborator_.tighten([&](std::size_t k) { return all[k]->segment; }, boxes);
    result_.boxes = 0;
    least_ = {};
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      least_.add(boxes[k]);
      result_.boxes += boxes[k].size();
      certificate_.add_segment(make_segment(std::move(boxes[k])), k);
    }
  }

  /// Adds a stretch of segment i of a batch, or continues the last one with it where they meet.
  void add(const std::shared_ptr<const Batch>& shared_batch, std::size_t i, const SegmentStretch& part) {
    const Batch& batch = *shared_batch;
    const Stretch& found = part.stretch;
    const FilePlace begin = place(batch, i, found.begin.s);
    const FilePlace end = place(batch, i, found.end.s);
    if (!continues(found)) {
      close_stretch();
      open_ = AuditedStretch{{found.begin, found.end, std::nullopt, found.reason}, begin, end, {}, {}};
    }
    if (!elaborator_.is_implied()) gravest_.add(shared_batch, i, part);
    Stretch& stretch = open_->stretch;
    stretch.end = found.end;
    open_->end = end;
    if (!found.violations || !is_connected(part)) {
      if (elaborator_.is_implied()) follow(part);
      if (found.violations && !stretch.violations) stretch.reason = Reason(Undecided::kKernel).text();
      return;
    }
    const auto& [first, last] = *found.violations;
    if (!stretch.violations) {
      stretch.violations = found.violations;
      stretch.reason.clear();
      open_->first = place(batch, i, first.violation.at.s);
      if (!has_witness_) {
        if (elaborator_.is_implied()) follow(part);
        std::vector<checker::MotionBox>& motion = stretch.violations->first.motion;
        motion.insert(motion.end(), way_.begin(), way_.end());
        has_witness_ = true;
        result_.witness = stretch.violations->first;
        result_.witness_place = open_->first;
      }
    }
    stretch.violations->second = last;
    open_->last = place(batch, i, last.violation.singular ? last.violation.to.s : last.violation.at.s);
  }

  /// Whether a stretch begins where the last one ends.
  [[nodiscard]] bool continues(const Stretch& next) const {
    return open_ && next.begin.s == Dyadic{0, 0} && open_->stretch.end.s == Dyadic{1, 0} &&
           open_->stretch.end.index + 1 == next.begin.index;
  }

  /// Whether a violation may refute: the first one may where the path is known to lead to it from its beginning, and
  /// those after it may.
  [[nodiscard]] bool is_connected(const SegmentStretch& part) const {
    return has_witness_ || !elaborator_.is_implied() || (is_followed_ && part.motion);
  }

  /// Adds what is known of the motion on a stretch to the way from the path's beginning.
  void follow(const SegmentStretch& part) {
    is_followed_ = is_followed_ && part.motion;
    if (is_followed_) way_.insert(way_.end(), part.motion->begin(), part.motion->end());
  }

  /// Takes the gravest violation in place of the first; not where the motion is implied, as it is followed to the first
  /// only.
  void choose_witness() {
    auto found = gravest_.find();
    if (!found) return;
    result_.witness_is_gravest = true;
    result_.witness_place = place(*found->batch, found->segment, found->witness.violation.at.s);
    result_.witness = std::move(found->witness);
  }

  void close_stretch() {
    if (!open_) return;
    certificate_.add_stretch(open_->stretch);
    const bool is_violated = open_->stretch.violations.has_value();
    ++(is_violated ? result_.stretches_violated : result_.stretches_open);
    gravest_.end_stretch(is_violated);
    // A refuted audit shows a violation, whatever is open before it.
    const bool is_first_violation = is_violated && result_.stretches_violated == 1;
    if (result_.stretches.size() < Audit::kMaxListed) {
      result_.stretches.push_back(std::move(*open_));
    } else if (is_first_violation) {
      result_.stretches.back() = std::move(*open_);
    }
    open_.reset();
  }

  const Elaborator& elaborator_;
  GravestWitness gravest_;
  const Problem& problem_;
  bool has_witness_ = false;             ///< whether there was a violation that may refute
  bool is_followed_ = true;              ///< by proved boxes and `way_`, up to now
  std::vector<checker::MotionBox> way_;  ///< of stretches before the first witness, where the motion is implied
  bool tightens_;
  std::vector<std::shared_ptr<const Batch>> kept_;  ///< whose segments are not written yet
  bool has_times_, has_lines_, has_tubes_, has_pose_tubes_;
  CertificateWriter& certificate_;
  const WriteText& csv_;
  Audit result_;
  LeastBounds least_;
  std::optional<AuditedStretch> open_;  ///< the last one, which the next segment may continue
};

/// Proves all segments, in a pipeline: read, prove on all cores, write.
Audit run_pipeline(const Prover& prover, PathSource& source, CertificateWriter& certificate, const WriteText& csv,
                   const AuditProgress& progress, const std::stop_token& stop) {
  const auto begin = Clock::now();
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  constexpr std::size_t kMostSegments = 128;
  constexpr std::size_t kBatchesPerThread = 8;  // few segments are spread evenly
  const std::size_t batch_segments =
      std::clamp<std::size_t>(source.segments() / (kBatchesPerThread * threads), 1, kMostSegments);
  BatchReader reader(source, batch_segments);
  const Elaborator elaborator(source.problem(), source.law());
  const BatchProver batch_prover(prover, elaborator, source);
  BatchWriter writer(source, prover, elaborator, certificate, csv);
  csv(batch_prover.csv_header());
  std::size_t done = 0;
  using BatchPointer = std::shared_ptr<Batch>;
  const auto read = [&](tbb::flow_control& control) {
    BatchPointer batch = stop.stop_requested() ? nullptr : reader.next();
    if (!batch) control.stop();
    return batch;
  };
  const auto prove = [&](BatchPointer batch) {
    batch_prover.prove(*batch, stop);
    return batch;
  };
  const auto write = [&](const BatchPointer& batch) {
    writer.write(batch);
    done += batch->segments.size();
    progress(done);
  };
  constexpr std::size_t kBatchesInFlight = 3;  // a thread
  tbb::parallel_pipeline(kBatchesInFlight * threads,
                         tbb::make_filter<void, BatchPointer>(tbb::filter_mode::serial_in_order, read) &
                             tbb::make_filter<BatchPointer, BatchPointer>(tbb::filter_mode::parallel, prove) &
                             tbb::make_filter<BatchPointer, void>(tbb::filter_mode::serial_in_order, write));
  Audit result;
  if (!stop.stop_requested()) result = writer.finish();
  result.interrupted = stop.stop_requested();
  result.seconds = seconds_since(begin);
  return result;
}

/// What an undecided audit has left open.
OpenPart open_part(const Audit& audit) {
  const Stretch& open = audit.stretches.front().stretch;
  const Dyadic end = open.end.index == open.begin.index ? open.end.s : Dyadic{1, 0};
  return {open.reason, open.begin.index, std::pair(open.begin.s, end)};
}

}  // namespace

const std::map<std::string, Interpolation>& audit_laws() {
  static const std::map<std::string, Interpolation> all = {{"straight", Interpolation::kStraight},
                                                           {"geodesic", Interpolation::kGeodesic},
                                                           {"cable-lengths", Interpolation::kCableLengths}};
  return all;
}

AuditRequest resolved(AuditRequest request, const Case& the_case, const std::string& case_path) {
  if (!request.path.name.empty()) {
    if (request.timed && !request.rounding && the_case.audit) request.rounding = the_case.audit->rounding;
    return request;
  }
  if (!the_case.audit) {
    throw InputError(case_path + ": got no PATH and no key 'audit', expected a path to audit", {case_path});
  }
  const auto& named = *the_case.audit;
  request.path = (std::filesystem::path(case_path).parent_path() / named.file).string();
  if (!request.law && !named.interpolation.empty()) request.law = audit_laws().at(named.interpolation);
  request.timed |= named.timed;
  if (!request.rounding) request.rounding = named.rounding;
  return request;
}

Audit audit_path(PathSource& source, const AuditOptions& options, const WriteText& certificate, const WriteText& csv,
                 const AuditProgress& progress, const std::stop_token& stop) {
  ProofOptions proof_options;
  proof_options.max_bits = options.max_bits;
  const Prover prover(source.problem(), proof_options);
  CertificateWriter writer(source.problem(), source.law(), options.folder);
  Audit audit = run_pipeline(prover, source, writer, csv, progress, stop);
  if (audit.interrupted) return audit;

  Certificate ending;
  ending.verdict = audit.verdict;
  ending.margins = audit.margins;
  ending.source = source.source();
  ending.illustration = {{"kind", "audit"}};
  add_stated(ending.illustration, options.the_case, options.decoration);
  if (source.counts_lines()) ending.illustration["lines"] = audit.lines.to_json();
  if (audit.verdict == Verdict::kRefuted) ending.witness = audit.witness;
  if (audit.verdict == Verdict::kUndecided && !audit.stretches.empty()) ending.undecided = open_part(audit);
  if (options.headroom_seconds > 0 && audit.segments <= kMostReported) {
    const TimeBudget budget(options.headroom_seconds, stop);
    audit.headroom =
        find_headroom(source.problem(), source.whole_path(), audit.verdict,
                      audit.margins ? audit.margins->wrench_scale : "", options.headroom_progress, budget.token());
    audit.as_items = prove_as_items(options.the_case, source.problem(), source.whole_path(), audit.margins,
                                    options.headroom_seconds, stop);
    audit.interrupted = stop.stop_requested();
    if (audit.interrupted) return audit;
    ending.illustration["headroom"] = to_json(*audit.headroom);
    if (audit.as_items) ending.illustration["as_items"] = to_json(audit.as_items);
  }
  CertificateWriter::Sign sign;
  if (options.key != nullptr) sign = [&](const std::string& digest) { return options.key->signature(digest); };
  writer.finish(ending, certificate, sign);
  return audit;
}

}  // namespace taut
