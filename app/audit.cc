// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/audit.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>

#include "certify/gaps.h"
#include "checker/format/writer.h"
#include "path_io/path_csv.h"

namespace taut {
namespace {

using nlohmann::json;

/// A gap with its inner ends as a certificate states them.
struct StatedGap {
  Gap gap;
  std::optional<std::pair<PathWitness, PathWitness>> inner;
  std::optional<std::pair<KernelWitness, KernelWitness>> kernel;  ///< the same
  /// Where the motion is implied: boxes that show it from the gap's beginning to the first witness, or all along an open
  /// gap; nothing where the kernel does not.
  std::optional<std::vector<checker::MotionBox>> motion;
};

/// What is known of one segment, and what the files say of it.
struct SegmentResult {
  Segment segment;  ///< between waypoints of its batch
  SegmentSurvey survey;
  std::vector<KernelBox> boxes;  ///< proved
  std::vector<StatedGap> gaps;
  std::string text;
};

/// Some successive segments, on their way through the pipeline.
struct Batch {
  std::size_t first_segment = 0;
  std::size_t old_waypoints = 0;  ///< that the batch before has written
  std::vector<SourceWaypoint> waypoints;
  std::vector<std::string> waypoint_texts;  ///< of the new ones
  std::string csv;
  std::vector<SegmentResult> segments;

  /// Number i of the batch, which it refers to.
  [[nodiscard]] Segment segment(Interpolation law, std::size_t i) const {
    Segment segment{law, {}, 0};
    for (std::size_t c = 0; c < control_points(law); ++c) segment.control[c] = &waypoints[i + c].waypoint;
    return segment;
  }
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string time_text(const SourceWaypoint& waypoint) { return waypoint.time_s ? waypoint.time_s->text() : ""; }

json place_json(std::size_t segment, const Dyadic& s) { return {{"segment", segment}, {"s", s.text()}}; }

// --- Reading and proving -----------------------------------------------------------------------------------------------

/// Batches of waypoints in order; each begins with the control points that it shares with the one before.
class BatchReader {
 public:
  BatchReader(PathSource& source, std::size_t batch_segments)
      : source_(source),
        batch_segments_(batch_segments),
        shared_(control_points(source.law()) - 1),
        sampler_(source.problem()) {}

  /// Null behind the last. @throws InputError where a waypoint is off the space's constraints, and as PathSource::next().
  std::shared_ptr<Batch> next() {
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

 private:
  /// What is proved is about the poses on the constraints: these have to be those of the file, but for its rounding.
  void require_on_constraints(const Batch& batch) const {
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

  PathSource& source_;
  std::size_t batch_segments_;
  std::size_t shared_;
  PoseSampler sampler_;
  std::size_t next_segment_ = 0;
  std::vector<SourceWaypoint> tail_;
};

/// Proves the segments of batches, and says it in the files' words.
class BatchProver {
 public:
  BatchProver(const Prover& prover, const Elaborator& elaborator, const PathSource& source)
      : elaborator_(elaborator),
        prover_(prover),
        law_(source.law()),
        csv_(source.problem(), source.law(), source.has_times()) {}

  [[nodiscard]] std::string csv_header() const { return csv_.header(); }

  void prove(Batch& batch, const std::stop_token& stop) const {
    const std::size_t first_waypoint = batch.first_segment;
    for (std::size_t i = batch.old_waypoints; i < batch.waypoints.size(); ++i) {
      const SourceWaypoint& waypoint = batch.waypoints[i];
      batch.waypoint_texts.push_back(waypoint_text(law_, waypoint.waypoint));
      if (!waypoint.is_copy) batch.csv += csv_.row(first_waypoint + i, waypoint.waypoint, time_text(waypoint));
    }
    for (std::size_t i = 0; i < batch.segments.size(); ++i) {
      batch.segments[i] = prove(batch, i, stop);
    }
  }

 private:
  [[nodiscard]] SegmentResult prove(const Batch& batch, std::size_t i, const std::stop_token& stop) const {
    SegmentResult result;
    result.segment = prover_.prepared(batch.segment(law_, i));
    result.survey = prover_.survey(result.segment, stop);
    const std::size_t number = batch.first_segment + i;
    for (SurveyedBox& box : result.survey.boxes) {
      if (box.kind != SurveyedBox::Kind::kProved) continue;
      const auto confirmed = elaborator_.boxes(result.segment, std::span(&box.box, 1));
      if (confirmed) {
        result.boxes.insert(result.boxes.end(), confirmed->begin(), confirmed->end());
      } else {
        box.kind = SurveyedBox::Kind::kOpen;
        box.reason = Undecided::kKernel;
      }
    }
    for (Gap& gap : gaps(result.survey)) result.gaps.push_back(stated(result.segment, number, std::move(gap)));
    result.text = segment_text(make_segment(result.boxes), number, number + control_points(law_) - 1,
                               elaborator_.has_tolerances());
    return result;
  }

  [[nodiscard]] StatedGap stated(const Segment& segment, std::size_t number, Gap gap) const {
    StatedGap result{std::move(gap), std::nullopt, std::nullopt, std::nullopt};
    if (result.gap.first) {
      const auto witness = [&](const SegmentWitness& end) {
        return path_witness(prover_, segment, static_cast<int>(number), end);
      };
      std::pair<PathWitness, PathWitness> inner = {witness(*result.gap.first), witness(*result.gap.last)};
      std::optional<KernelWitness> first = elaborator_.witness(segment, inner.first);
      std::optional<KernelWitness> last = elaborator_.witness(segment, inner.second);
      if (first && last) {
        result.inner = std::move(inner);
        result.kernel = {std::move(*first), std::move(*last)};
      } else {
        result.gap.reason = Undecided::kKernel;
      }
    }
    if (elaborator_.is_implied()) {
      const Dyadic end = result.inner ? result.inner->first.at.s : result.gap.end;
      if (auto boxes = elaborator_.motion(segment, result.gap.begin, end)) {
        result.motion.emplace();
        for (checker::Box& box : *boxes) result.motion->push_back({number, std::move(box)});
      }
    }
    return result;
  }

  const Elaborator& elaborator_;
  const Prover& prover_;
  Interpolation law_;
  PathCsv csv_;
};

// --- Writing -----------------------------------------------------------------------------------------------------------

/// Takes batches in order; keeps what a summary needs.
class BatchWriter {
 public:
  BatchWriter(const PathSource& source, const Elaborator& elaborator, CertificateStream& certificate,
              const WriteText& csv)
      : elaborator_(elaborator),
        law_(source.law()),
        sharpens_(source.segments() <= kMostSharpened),
        has_times_(source.has_times()),
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
    csv_(batch.csv);
    for (std::size_t i = 0; i < batch.segments.size(); ++i) {
      const auto& [segment, survey, boxes, gaps, text] = batch.segments[i];
      if (has_tubes_) certificate_.add_tube(segment.tube);
      if (has_pose_tubes_) certificate_.add_pose_tube(segment.pose_tube, segment.inner_poses);
      if (!sharpens_) certificate_.add_segment(text, boxes.size());
      result_.boxes += boxes.size();
      result_.boxes_judged += survey.boxes_judged;
      add_margins(boxes);
      for (const StatedGap& gap : gaps) add(batch, i, gap);
    }
    result_.segments += batch.segments.size();
    if (sharpens_) kept_.push_back(shared_batch);
  }

  /// The summary, once all is written.
  [[nodiscard]] Audit finish() {
    close_stretch();
    if (sharpens_) write_kept();
    if (result_.stretches_violated > 0) {
      result_.verdict = Verdict::kRefuted;
    } else if (result_.stretches_open == 0) {
      result_.verdict = Verdict::kProved;
      result_.margins = margins_below(tension_N_, length_m_, wrench_scale_);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] static AuditPlace place(const Batch& batch, std::size_t i, const Dyadic& s) {
    // Splines have no waypoint at their joints: the control points that weigh most there are the middle ones.
    const std::size_t shared = batch.waypoints.size() - batch.segments.size();
    const std::size_t before = i + (shared - 1) / 2;
    const SourceWaypoint& a = batch.waypoints[before];
    const SourceWaypoint& b = batch.waypoints[before + 1];
    AuditPlace place{batch.first_segment + i, s, a.line, b.line, std::nullopt};
    if (s == Dyadic{0, 0}) place.line_behind = place.line_before;
    if (s == Dyadic{1, 0}) place.line_before = place.line_behind;
    if (a.time_s && b.time_s) {
      const double from = ScalarTraits<double>::from_decimal(a.time_s->text());
      const double to = ScalarTraits<double>::from_decimal(b.time_s->text());
      place.time_s = from + s.approx() * (to - from);
    }
    return place;
  }

  /// The segments of a path that is short enough to be looked at once more: with sharper margins, if it is proved.
  void write_kept() {
    std::vector<const SegmentResult*> all;
    for (const auto& batch : kept_) {
      for (const SegmentResult& segment : batch->segments) all.push_back(&segment);
    }
    if (result_.stretches_violated + result_.stretches_open > 0) {
      for (const SegmentResult* segment : all) certificate_.add_segment(segment->text, segment->boxes.size());
      return;
    }
    std::vector<std::vector<KernelBox>> boxes;
    for (const SegmentResult* segment : all) boxes.push_back(segment->boxes);
    elaborator_.tighten([&](std::size_t k) { return all[k]->segment; }, boxes);
    result_.boxes = 0;
    tension_N_ = length_m_ = wrench_scale_ = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      add_margins(boxes[k]);
      result_.boxes += boxes[k].size();
      const std::size_t number = boxes[k].size();
      certificate_.add_segment(segment_text(make_segment(std::move(boxes[k])), k, k + control_points(law_) - 1,
                                            elaborator_.has_tolerances()),
                               number);
    }
  }

  void add_margins(const std::vector<KernelBox>& boxes) {
    for (const KernelBox& box : boxes) {
      tension_N_ = std::min(tension_N_, box.tension_N);
      length_m_ = std::min(length_m_, box.length_m);
      wrench_scale_ = std::min(wrench_scale_, box.wrench_scale);
    }
  }

  void add(const Batch& batch, std::size_t i, const StatedGap& stated) {
    const Gap& gap = stated.gap;
    const AuditPlace begin = place(batch, i, gap.begin);
    const AuditPlace end = place(batch, i, gap.end);
    const bool continues = stretch_ && gap.begin == Dyadic{0, 0} && stretch_->end.s == Dyadic{1, 0} &&
                           stretch_->end.segment + 1 == begin.segment;
    if (!continues) {
      close_stretch();
      stretch_ = AuditStretch{begin, end, std::nullopt, {}, std::nullopt, gap.reason};
    }
    stretch_->end = end;
    if (!stated.inner || !is_connected(stated)) {
      if (elaborator_.is_implied()) follow(stated);
      if (stated.inner && !stretch_->inner) stretch_->reason = Undecided::kKernel;
      return;
    }
    const PathWitness& last_witness = stated.inner->second;
    const AuditPlace first = place(batch, i, stated.inner->first.at.s);
    const AuditPlace last = place(batch, i, last_witness.singular ? last_witness.to.s : last_witness.at.s);
    const std::size_t number = batch.first_segment + i;
    const auto as_json = [&](const PathWitness& witness, KernelWitness kernel, bool is_first) {
      json result = to_json(witness, kernel, number);
      if (!is_first) return result;
      for (const checker::MotionBox& box : way_) result["motion"].push_back(checker::to_json(box));
      return result;
    };
    if (!stretch_->inner) {
      const bool is_first = !has_witness_;
      if (is_first && elaborator_.is_implied()) follow(stated);
      stretch_->inner = stated.inner;
      stretch_->inner_json = {as_json(stated.inner->first, stated.kernel->first, is_first), nullptr};
      stretch_->inner_places = {first, last};
      has_witness_ = true;
    }
    stretch_->inner->second = last_witness;
    stretch_->inner_json.second = as_json(last_witness, stated.kernel->second, false);
    stretch_->inner_places->second = last;
  }

  /// Whether a violation may refute: the first where the path is known to lead to it from its beginning. Others follow it.
  [[nodiscard]] bool is_connected(const StatedGap& stated) const {
    return has_witness_ || !elaborator_.is_implied() || (is_followed_ && stated.motion);
  }

  /// Adds what is known of the motion on a gap to the way from the path's beginning.
  void follow(const StatedGap& stated) {
    is_followed_ = is_followed_ && stated.motion;
    if (is_followed_) way_.insert(way_.end(), stated.motion->begin(), stated.motion->end());
  }

  void close_stretch() {
    if (!stretch_) return;
    json inner;
    if (stretch_->inner) inner = {stretch_->inner_json.first, stretch_->inner_json.second};
    certificate_.add_stretch(
        {{"outer",
          {place_json(stretch_->begin.segment, stretch_->begin.s), place_json(stretch_->end.segment, stretch_->end.s)}},
         {"inner", inner},
         {"reason", stretch_->inner ? json() : json(stretch_->reason.text())}});
    ++(stretch_->inner ? result_.stretches_violated : result_.stretches_open);
    // A refuted audit shows a violation, whatever is open before it.
    const bool is_first_violation = stretch_->inner && result_.stretches_violated == 1;
    if (result_.stretches.size() < Audit::kMaxListed) {
      result_.stretches.push_back(std::move(*stretch_));
    } else if (is_first_violation) {
      result_.stretches.back() = std::move(*stretch_);
    }
    stretch_.reset();
  }

  static constexpr std::size_t kMostSharpened = 5000;  ///< segments

  const Elaborator& elaborator_;
  Interpolation law_;
  bool has_witness_ = false;
  bool is_followed_ = true;              ///< by proved boxes and `way_`, up to now
  std::vector<checker::MotionBox> way_;  ///< of gaps before the first witness, where the motion is implied
  bool sharpens_;
  std::vector<std::shared_ptr<const Batch>> kept_;  ///< whose segments are not written yet
  bool has_times_, has_tubes_, has_pose_tubes_;
  CertificateStream& certificate_;
  const WriteText& csv_;
  Audit result_;
  double tension_N_ = std::numeric_limits<double>::infinity();
  double length_m_ = std::numeric_limits<double>::infinity();
  double wrench_scale_ = std::numeric_limits<double>::infinity();
  std::optional<AuditStretch> stretch_;
};

}  // namespace

Audit audit(const Prover& prover, PathSource& source, CertificateStream& certificate, const WriteText& csv,
            const AuditProgress& progress, const std::stop_token& stop) {
  const auto begin = std::chrono::steady_clock::now();
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  constexpr std::size_t kMostSegments = 128;
  constexpr std::size_t kBatchesPerThread = 8;  // few segments are spread evenly
  const std::size_t batch_segments =
      std::clamp<std::size_t>(source.segments() / (kBatchesPerThread * threads), 1, kMostSegments);
  BatchReader reader(source, batch_segments);
  const Elaborator elaborator(source.problem(), source.law());
  const BatchProver batch_prover(prover, elaborator, source);
  BatchWriter writer(source, elaborator, certificate, csv);
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
  if (!stop.stop_requested()) {
    result = writer.finish();
  }
  result.interrupted = stop.stop_requested();
  result.seconds = seconds_since(begin);
  return result;
}

json undecided_json(const Audit& audit) {
  if (audit.verdict != Verdict::kUndecided || audit.stretches.empty()) return nullptr;
  const AuditStretch& open = audit.stretches.front();
  const bool ends_there = open.end.segment == open.begin.segment;
  return {{"reason", open.reason.text()},
          {"segment", open.begin.segment},
          {"box", {open.begin.s.text(), ends_there ? open.end.s.text() : "1"}}};
}

}  // namespace taut
