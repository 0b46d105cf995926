// SPDX-License-Identifier: GPL-3.0-or-later
// A path to be audited, waypoint by waypoint, wherever it comes from: a path file of any kind, or a certificate.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/sha256.h"
#include "certificate/certificate.h"
#include "kinematics/segment.h"
#include "path_io/path_file.h"
#include "path_io/path_summary.h"
#include "path_io/waypoint_maker.h"

namespace taut {

/// A path file, or the text of one that is in no file.
struct PathInput {
  PathInput(std::string file) : name(std::move(file)) {}  // NOLINT(google-explicit-constructor): files are named
  PathInput(std::string called, std::shared_ptr<const std::string> content)
      : name(std::move(called)), text(std::move(content)) {}

  std::string name;                         ///< also in messages
  std::shared_ptr<const std::string> text;  ///< of a table; null: the file's
};

struct SourceWaypoint {
  Waypoint waypoint;
  std::size_t line = 0;  ///< of the file; of a certificate, the waypoint's number, from 0
  std::optional<Decimal> time_s;
  bool is_copy = false;  ///< a path of one pose is audited as a segment that stays there
};

/// The bytes of a file or a text. @throws InputError where there is no such file.
[[nodiscard]] std::string bytes_of(const PathInput& input);

class PathSource {
 public:
  /// Reads all of the file once, so that whatever is wrong with it is said at once, and stands before its first
  /// waypoint.
  /// @param law         how to join the waypoints; nothing for the file's usual way.
  /// @param keeps_time  a certificate's law in time and the problem's limits in time are kept
  /// @throws InputError, also where a law in time is asked for and there is none.
  PathSource(const Problem& problem, PathInput input, std::optional<Interpolation> law, bool keeps_time = false);
  ~PathSource();
  PathSource(const PathSource&) = delete;
  PathSource& operator=(const PathSource&) = delete;

  /// Reads the whole path once more. @throws InputError where the file changed meanwhile.
  [[nodiscard]] Path whole_path() const;
  /// The first segment of the path, read once more.
  [[nodiscard]] Path first_segment() const;

  /// The case's problem without its query and, unless they are kept, its limits in time; in the case's space or in the
  /// space of all poses.
  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] Interpolation law() const { return law_; }
  [[nodiscard]] std::size_t waypoints() const { return waypoints_; }  ///< with the copy of a single one
  [[nodiscard]] std::size_t segments() const { return waypoints_ - control_points(law_) + 1; }
  [[nodiscard]] bool has_times() const;
  [[nodiscard]] const std::string& name() const { return path_; }
  /// Whether SourceWaypoint::line counts lines; else it counts waypoints.
  [[nodiscard]] bool counts_lines() const { return !certificate_; }
  /// "line" or "waypoint": what SourceWaypoint::line counts.
  [[nodiscard]] const char* place_name() const { return counts_lines() ? "line" : "waypoint"; }

  /// False behind the last. @throws InputError, also where the file changed since it was read first.
  [[nodiscard]] bool next(SourceWaypoint& result);

  /// Lines of text: what was read, how it is joined, and what that means.
  [[nodiscard]] std::string description() const;
  /// What is odd about the file's columns and, once all waypoints were read, about the poses that cable lengths imply;
  /// may be empty.
  [[nodiscard]] std::string remarks() const;
  /// A certificate's `source`.
  [[nodiscard]] PathOrigin source() const;

 private:
  [[nodiscard]] PathFile open_file() const;
  void open();
  void require_unchanged();
  void read_certificate_path(std::optional<Interpolation> law);

  PathInput input_;
  const std::string& path_ = input_.name;
  bool keeps_time_;
  bool stays_ = false;  ///< one pose, which takes no time
  Problem case_problem_;
  Problem problem_;
  Interpolation law_ = Interpolation::kStraight;
  std::size_t waypoints_ = 0;
  std::string sha256_;
  Sha256 digest_;  ///< of what file_ has read
  bool is_unchanged_ = false;
  std::string description_;
  std::string column_hint_;
  std::optional<Path> certificate_;  ///< the path of one
  std::unique_ptr<PathFile> file_;
  std::unique_ptr<WaypointMaker> maker_;
  std::optional<PathHeader> header_;
  std::size_t next_ = 0;
};

/// Throws an InputError that names `file` where the pose that rows of cable lengths start from has other lengths than
/// the first row, in `line`.
void require_start(const Problem& problem, const PathHeader& header, const WaypointMaker& poses,
                   const std::string& file, std::size_t line);

}  // namespace taut
