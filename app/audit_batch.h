// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of an audited path on their way through the pipeline of an audit: read, proved, and put into the words of
// files.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/path_source.h"
#include "certificate/elaborate.h"
#include "certify/gaps.h"
#include "certify/gravest.h"
#include "kinematics/pose_sampler.h"
#include "path_io/path_csv.h"

namespace taut {

/// A part of a segment that is not proved.
struct SegmentStretch {
  Stretch stretch;
  /// If the motion is implied: boxes that show it from the beginning of the stretch to its first violation, or all
  /// along an open stretch; nothing where the kernel does not.
  std::optional<std::vector<checker::MotionBox>> motion;
  /// If the motion is not implied: the gravest violations that seem to be inside.
  SampledViolations sampled;
};

/// What is known of one segment, and what the certificate says of it.
struct SegmentResult {
  Segment segment;  ///< refers to the waypoints of its batch
  long boxes_judged = 0;
  std::vector<KernelBox> boxes;  ///< proved
  std::vector<SegmentStretch> stretches;
  std::string text;  ///< of `boxes`; empty where the problem has bodies, whose directions the writer numbers
};

/// Some successive segments.
struct Batch {
  std::size_t first_segment = 0;
  std::size_t old_waypoints = 0;  ///< the first ones, which the batch before has too and has written
  std::vector<SourceWaypoint> waypoints;
  std::vector<std::string> waypoint_texts;  ///< of the new ones
  std::string csv;
  std::vector<SegmentResult> segments;

  /// Segment i of the batch; refers to the batch.
  [[nodiscard]] Segment segment(Interpolation law, std::size_t i) const;
};

/// "1.5", or empty where the waypoint has no time.
[[nodiscard]] std::string time_text(const SourceWaypoint& waypoint);

/// Reads batches in order; each begins with the control points that it shares with the one before.
class BatchReader {
 public:
  BatchReader(PathSource& source, std::size_t batch_segments);

  /// Null after the last.
  /// @throws InputError where a waypoint is off the space's constraints, and as PathSource::next().
  [[nodiscard]] std::shared_ptr<Batch> next();

 private:
  /// Checks that waypoints are on the constraints but for rounding: what is proved is about the poses on them.
  void require_on_constraints(const Batch& batch) const;

  PathSource& source_;
  std::size_t batch_segments_;
  std::size_t shared_;  ///< control points of successive batches
  PoseSampler sampler_;
  std::size_t next_segment_ = 0;
  std::vector<SourceWaypoint> tail_;
};

/// Proves the segments of batches. Thread-safe.
class BatchProver {
 public:
  BatchProver(const Prover& prover, const Elaborator& elaborator, const PathSource& source);

  /// The first line of path.csv.
  [[nodiscard]] std::string csv_header() const { return csv_.header(); }
  void prove(Batch& batch, const std::stop_token& stop) const;

 private:
  [[nodiscard]] SegmentResult prove(const Batch& batch, std::size_t i, const std::stop_token& stop) const;
  [[nodiscard]] SegmentStretch stretch(const Segment& segment, std::size_t number, const Gap& gap) const;
  [[nodiscard]] SampledViolations sampled(const Segment& segment, const Gap& gap) const;

  const Elaborator& elaborator_;
  const Prover& prover_;
  const Problem& problem_;
  Interpolation law_;
  PathCsv csv_;
  int samples_;  ///< in a stretch of a segment
};

}  // namespace taut
