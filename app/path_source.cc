// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/path_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "app/path_hints.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "base/sha256.h"
#include "certificate/certificate_reader.h"

namespace taut {
namespace {

/// Checks a certificate's waypoints as the readers of path files check rows.
void require_poses(const Path& path, const std::string& file) {
  if (!has_poses(path.interpolation)) return;
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    const double norm = quaternion_length(path.waypoints[k].pose());
    if (!(std::abs(norm - 1) <= kNormTolerance)) {
      throw InputError(fmt::format("{}: path.waypoints[{}].quaternion: got one of length {:.6g}, expected 1 within {}",
                                   file, k, norm, kNormTolerance));
    }
    if (path.interpolation == Interpolation::kCableLengths && !have_lengths(path.waypoints[k])) {
      throw InputError(fmt::format("{}: path.waypoints[{}].lengths: got one that is not above 0", file, k));
    }
  }
}

/// "without its law in time, which this audit is not of", or how long it takes.
std::string law_in_time(const Path& path, bool is_kept) {
  if (!path.timing) return "";
  return is_kept ? fmt::format(" with its law in time, {:.6g} s", path.timing->duration_s())
                 : " without its law in time, which this audit is not of (--timed is)";
}

/// A path is read more than once, which a pipe can't be.
PathInput kept_if_pipe(PathInput input) {
  std::error_code ignored;
  if (!input.text && std::filesystem::is_fifo(input.name, ignored)) {
    input.text = std::make_shared<const std::string>(read_whole(input.name));
  }
  return input;
}

std::string sha256_of(const PathInput& input) {
  Sha256 digest;
  if (input.text) {
    digest.update(*input.text);
    return digest.hex();
  }
  std::ifstream file(input.name, std::ios::binary);
  std::vector<char> buffer(std::size_t{1} << 18U);
  while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || file.gcount() > 0) {
    digest.update(std::string_view(buffer.data(), static_cast<std::size_t>(file.gcount())));
  }
  return digest.hex();
}

/// A stream of a file's or a text's bytes that digests what is read from it, so that what is proved is what is
/// digested.
class DigestedStream : private std::streambuf, public std::istream {
 public:
  DigestedStream(std::unique_ptr<std::istream> source, Sha256& digest)
      : std::istream(static_cast<std::streambuf*>(this)), source_(std::move(source)), digest_(digest) {}

 private:
  std::streamsize xsgetn(char* to, std::streamsize most) override {
    source_->read(to, most);
    if (source_->bad()) throw std::ios_base::failure("could not read on");  // to whoever reads, a bad stream
    const std::streamsize count = source_->gcount();
    digest_.update(std::string_view(to, static_cast<std::size_t>(count)));
    return count;
  }

  std::unique_ptr<std::istream> source_;
  Sha256& digest_;
};

}  // namespace

std::string bytes_of(const PathInput& input) { return input.text ? *input.text : read_whole(input.name); }

PathSource::PathSource(const Problem& stated, PathInput input, std::optional<Interpolation> law, bool keeps_time)
    : input_(kept_if_pipe(std::move(input))),
      keeps_time_(keeps_time),
      case_problem_(keeps_time ? stated : without_time(stated)) {
  const Problem& problem = case_problem_;
  if (!input_.text && is_certificate_name(path_)) {
    read_certificate_path(law);
    waypoints_ = certificate_->waypoints.size();
    description_ = fmt::format("a certificate's path{}, {}\n", law_in_time(*certificate_, keeps_time_),
                               plural(waypoints_, "waypoint"));
    if (!keeps_time_) certificate_->timing.reset();
  } else {
    PathFile file = open_file();
    header_ = file.header();
    law_ = law.value_or(usual_law(*header_));
    WaypointMaker maker(problem, *header_, law_, path_);
    problem_ = maker.problem();
    PathSummary summary(problem, *header_);
    for (PathRow row; file.next(row);) {
      if (summary.rows() == 0) column_hint_ = column_hint(PoseSampler(problem), *header_, row);
      summary.add(row);
    }
    waypoints_ = summary.rows();
    description_ = summary.text();
  }
  if (waypoints_ < control_points(law_) && (waypoints_ != 1 || law_ == Interpolation::kCubicBSpline)) {
    throw InputError(fmt::format("{}: got {}, expected at least {} of a spline", path_, plural(waypoints_, "waypoint"),
                                 control_points(law_)),
                     {path_});
  }
  stays_ = waypoints_ == 1;
  if (stays_) description_ += "  one pose only: the platform stays there\n";
  waypoints_ = std::max<std::size_t>(waypoints_, 2);
  if (!certificate_) sha256_ = sha256_of(input_);
  open();
}

PathSource::~PathSource() = default;

void PathSource::read_certificate_path(std::optional<Interpolation> law) {
  const std::string bytes = read_whole(path_);
  const nlohmann::json certificate = parse_certificate(bytes, path_);
  Sha256 digest;
  digest.update(bytes);
  sha256_ = digest.hex();
  const bool has_space = certificate.contains("path") && certificate.contains("problem") &&
                         certificate["problem"].is_object() && certificate["problem"].contains("space");
  if (certificate.contains("legs")) {
    throw InputError(path_ + ": got a certificate of several legs, expected that of one: 1-NAME/certificate.json",
                     {path_});
  }
  if (!has_space) throw InputError(path_ + ": got no problem and no path, expected a certificate", {path_});
  certificate_ = with_error_code(ErrorCode::kPath, path_, [&] { return read_path(certificate["path"]); });
  if (keeps_time_ && !certificate_->timing) {
    throw InputError(path_ + ": path: got no law in time ('timing'), expected the certificate of a move", {path_});
  }
  require_poses(*certificate_, path_);
  law_ = certificate_->interpolation;
  if (law && *law != law_) {
    throw InputError(path_ + ": got a certificate, expected no other law than its own", {path_});
  }
  if (certificate_->waypoints.empty())
    throw InputError(path_ + ": path: got no waypoints, expected at least one", {path_});
  problem_ = case_problem_;
  problem_.query.clear();
  const nlohmann::json& space = certificate["problem"]["space"];
  std::vector<SpaceText> spaces = {coordinate_space()};
  if (!has_poses(law_)) {
    spaces = {case_problem_.space, coordinate_space(case_problem_.space.angles), coordinate_space(),
              coordinate_space({AngleKind::kRollPitchYaw})};
  }
  const bool is_known = std::ranges::any_of(spaces, [&](const SpaceText& known) {
    problem_.space = known;
    return space == to_json(problem_).at("space");
  });
  if (!is_known) {
    throw InputError(
        fmt::format("{}: problem.space: got another than {}, expected a path in {}", path_,
                    has_poses(law_) ? "that of free coordinates" : "the case's",
                    has_poses(law_) ? "the free coordinates, as the law is one of poses" : "the space of the case"),
        {path_});
  }
  if (has_poses(law_)) return;
  const std::size_t parameters = problem_.space.parameters.size();
  const std::size_t normals = parameters * problem_.space.constraints.size();
  const bool fits = std::ranges::all_of(certificate_->waypoints, [&](const Waypoint& waypoint) {
    const ParameterPoint& point = waypoint.parameters();
    return point.x.size() == parameters && point.normals.size() == normals;
  });
  if (!fits) {
    throw InputError(path_ + ": path.waypoints: got some of another size, expected those of the space", {path_});
  }
  for (std::size_t k = 0; k < certificate_->waypoints.size(); ++k) {
    const std::vector<int>& turns = certificate_->waypoints[k].parameters().half_turns;
    for (std::size_t j = 0; j < turns.size(); ++j) {
      const Parameter& parameter = problem_.space.parameters[j];
      if (turns[j] == 0 || parameter.kind == ParameterKind::kPeriodic) continue;
      throw InputError(
          fmt::format("{}: path.waypoints[{}].half_turns: got {} of '{}', expected 0, as it is not periodic", path_, k,
                      turns[j], parameter.name),
          {path_});
    }
  }
}

PathFile PathSource::open_file() const {
  if (!input_.text) return {path_, case_problem_.space};
  return {std::make_unique<std::istringstream>(*input_.text), path_, case_problem_.space};
}

Path PathSource::whole_path() const {
  PathSource again(case_problem_, input_, law_, keeps_time_);
  if (again.sha256_ != sha256_) throw InputError(path_ + ": the file was changed while it was read", {path_});
  Path path;
  path.interpolation = law_;
  for (SourceWaypoint waypoint; again.next(waypoint);) {
    path.waypoints.push_back(waypoint.waypoint);
    if (waypoint.time_s) path.times.push_back(waypoint.time_s->text());
  }
  if (certificate_) path.timing = certificate_->timing;
  return path;
}

Path PathSource::first_segment() const {
  PathSource again(case_problem_, input_, law_, keeps_time_);
  Path path;
  path.interpolation = law_;
  SourceWaypoint waypoint;
  while (path.waypoints.size() < control_points(law_) && again.next(waypoint)) {
    path.waypoints.push_back(waypoint.is_copy ? path.waypoints.back() : waypoint.waypoint);
  }
  return path;
}

void PathSource::open() {
  if (certificate_) return;
  std::unique_ptr<std::istream> text;
  if (input_.text) {
    text = std::make_unique<std::istringstream>(*input_.text);
  } else {
    text = std::make_unique<std::ifstream>(path_, std::ios::binary);
  }
  file_ = std::make_unique<PathFile>(std::make_unique<DigestedStream>(std::move(text), digest_), path_,
                                     case_problem_.space);
  maker_ = std::make_unique<WaypointMaker>(case_problem_, *header_, law_, path_);
}

bool PathSource::has_times() const {
  if (stays_) return false;
  return certificate_ ? !certificate_->times.empty() : header_->time.has_value();
}

/// The bytes that the waypoints were read from are those that were digested first.
void PathSource::require_unchanged() {
  if (certificate_ || is_unchanged_) return;
  PathRow row;
  if (file_->next(row) || digest_.hex() != sha256_) {  // the first reads on to the file's end
    throw InputError(path_ + ": the file was changed while it was read", {path_});
  }
  is_unchanged_ = true;
}

bool PathSource::next(SourceWaypoint& result) {
  if (next_ == waypoints_) {
    require_unchanged();
    return false;
  }
  const std::size_t k = next_++;
  result.is_copy = false;
  if (certificate_) {
    const std::size_t known = certificate_->waypoints.size();
    result.is_copy = k >= known;
    result.line = std::min(k, known - 1);
    result.waypoint = certificate_->waypoints[result.line];
    if (has_times()) result.time_s = Decimal::parse(certificate_->times[result.line]);
    return true;
  }
  PathRow row;
  if (!file_->next(row)) {
    if (k != 1) throw InputError(path_ + ": the file was changed while it was read", {path_});
    result.is_copy = true;
    return true;
  }
  result.waypoint = maker_->next(row, file_->start());
  if (k == 0) require_start(case_problem_, *header_, *maker_, path_, row.line);
  result.line = row.line;
  if (has_times()) result.time_s = row.time_s;
  return true;
}

namespace {

/// " (With l2 and l3 exchanged they would agree …)", or nothing.
std::string swapped_lengths(const PathHeader& header, const WaypointMaker& poses, double most_m) {
  const auto swapped = poses.exchanged_lengths(most_m);
  if (!swapped) return "";
  return fmt::format(" (With {} and {} exchanged they would agree: are these columns swapped?)",
                     header.coordinates[swapped->first].name, header.coordinates[swapped->second].name);
}

}  // namespace

void require_start(const Problem& problem, const PathHeader& header, const WaypointMaker& poses,
                   const std::string& file, std::size_t line) {
  constexpr double kMostOff = 0.02;  // of the platform's size; beyond, it may be the start of another assembly
  const double size = make_model<double>(problem).characteristic_length;
  const double off = poses.start_error_m();
  if (off <= kMostOff * size) return;
  throw InputError(
      fmt::format(
          "{}:{}: got a start pose whose cables' lengths differ by up to {:.4g} m from those of this row{}, expected "
          "the pose that has them, to within {:.4g} m",
          file, line, off, swapped_lengths(header, poses, kMostOff * size), kMostOff * size),
      {file, line});
}

std::string PathSource::description() const {
  std::string text =
      fmt::format("Read {}: {}Interpolation {}.\n", sanitize(path_), description_, law_sentence(law_, problem_));
  if (maker_ && maker_->is_converted()) {
    text +=
        "The file's poses were converted to this form in floating point: what is proved is about the converted "
        "waypoints, those of path.csv.\n";
  }
  return text;
}

std::string PathSource::remarks() const {
  constexpr double kLargeError = 1e-3;
  std::string text = column_hint_;
  if (maker_ && maker_->start_error_m() > kLargeError) {
    text += fmt::format(
        "The start pose has cable lengths up to {:.4g} m from those of the first row; the pose next to it was "
        "taken.{}\n",
        maker_->start_error_m(), swapped_lengths(*header_, *maker_, maker_->start_error_m() / 10));
  }
  if (maker_ && maker_->lost_line()) {
    text += fmt::format(
        "At line {} no pose was found that has the cable lengths of the file and follows from those before; what is "
        "said of later "
        "lines is about poses next to the last one found.\n",
        *maker_->lost_line());
  }
  return text;
}

PathOrigin PathSource::source() const { return {excerpt(std::filesystem::path(path_).filename().string()), sha256_}; }

}  // namespace taut
