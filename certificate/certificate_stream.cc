// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "base/input_error.h"
#include "base/sha256.h"

namespace taut {

using nlohmann::json;

namespace {

std::string canonical(const json& value) { return value.dump(-1, ' ', true); }

void append_hex_floats(std::string& text, std::span<const double> values) {
  text += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i == 0 ? "\"" : ",\"") + hex_float(values[i]) + "\"";
  }
  text += ']';
}

/// Of canonical text: without the line feeds that the file has for the eye.
CertificateStream::Write digest_of(Sha256& sha256) {
  return [&sha256](std::string_view text) {
    while (!text.empty()) {
      const std::size_t size = std::min(text.find('\n'), text.size());
      sha256.update(text.substr(0, size));
      text.remove_prefix(std::min(size + 1, text.size()));
    }
  };
}

}  // namespace

std::string waypoint_text(Interpolation law, const Waypoint& waypoint) {
  const std::span<const double> x = waypoint.x;
  std::string text;
  if (has_poses(law)) {
    text = "{";
    if (law == Interpolation::kCableLengths) {
      text += "\"lengths\":";
      append_hex_floats(text, x.subspan(7));
      text += ',';
    }
    text += "\"position\":";
    append_hex_floats(text, x.first(3));
    text += ",\"quaternion\":";
    append_hex_floats(text, x.subspan(3, 4));
    return text + "}";
  }
  text = "{\"half_turns\":[";
  for (std::size_t j = 0; j < waypoint.half_turns.size(); ++j) {
    text += (j == 0 ? "" : ",") + std::to_string(waypoint.half_turns[j]);
  }
  text += "],";
  if (!waypoint.normals.empty()) {
    text += "\"normals\":";
    append_hex_floats(text, waypoint.normals);
    text += ',';
  }
  text += "\"x\":";
  append_hex_floats(text, x);
  return text + "}";
}

std::string segment_text(const KernelSegment& segment, std::size_t from, std::size_t to, bool has_tolerances) {
  return canonical(to_json(segment, from, to, has_tolerances));
}

/// The items of a JSON array, in a file without a name.
class CertificateStream::Spool {
 public:
  explicit Spool(const std::filesystem::path& folder) : folder_(folder) {
    std::string name = (folder / ".taut.XXXXXX").string();
    const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0) fail();
    ::unlink(name.c_str());
    file_ = ::fdopen(descriptor, "w+b");
    if (file_ == nullptr) fail();
  }
  ~Spool() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  void add(std::string_view item) {
    if (count_++ > 0) append(",\n");
    append(item);
  }
  [[nodiscard]] std::size_t count() const { return count_; }

  /// The array. The line feeds between items are for the eye: `write` takes them, no digest does.
  void replay(const Write& write) const {
    write("[");
    if (std::fflush(file_) != 0 || std::fseek(file_, 0, SEEK_SET) != 0) fail();
    std::vector<char> buffer(std::size_t{1} << 18U);
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), file_)) {
      write(std::string_view(buffer.data(), size));
    }
    if (std::ferror(file_) != 0 || std::fseek(file_, 0, SEEK_END) != 0) fail();
    write("]");
  }

 private:
  void append(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
  }
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("{}: could not write a temporary file: {}", folder_.string(), std::strerror(errno)));
  }

  std::filesystem::path folder_;
  std::FILE* file_ = nullptr;
  std::size_t count_ = 0;
};

CertificateStream::CertificateStream(const std::filesystem::path& folder, const Problem& problem, Interpolation law)
    : folder_(folder), problem_(to_json(problem)), law_(law) {
  for (auto* spool : {&waypoints_, &times_, &tubes_, &pose_tubes_, &segments_, &stretches_}) {
    *spool = std::make_unique<Spool>(folder_);
  }
}

CertificateStream::~CertificateStream() = default;

void CertificateStream::add_waypoint(std::string_view text) { waypoints_->add(text); }
void CertificateStream::add_time(std::string_view decimal) { times_->add(fmt::format("\"{}\"", decimal)); }
void CertificateStream::add_tube(double tube) { tubes_->add("\"" + hex_float(tube) + "\""); }
void CertificateStream::add_pose_tube(const PoseTube& tube, std::span<const InnerPose> inner_poses) {
  pose_tubes_->add(canonical(pose_tube_json(tube, inner_poses)));
}
void CertificateStream::add_segment(std::string_view text, std::size_t boxes) {
  segments_->add(text);
  boxes_ += boxes;
}
void CertificateStream::add_stretch(const json& stretch) { stretches_->add(canonical(stretch)); }

void CertificateStream::emit_path(const Write& write) const {
  write(fmt::format(R"({{"interpolation":"{}","pose_tubes":)", interpolation_name(law_)));
  pose_tubes_->replay(write);
  write(",\"times\":");
  if (times_->count() == 0) {
    write("null");
  } else {
    times_->replay(write);
  }
  write(",\"tubes\":");
  tubes_->replay(write);
  write(",\"waypoints\":");
  waypoints_->replay(write);
  write("}");
}

/// All but the footer, the signature and the brace at the end.
void CertificateStream::emit(const Ending& ending, const Write& write, const std::string& path_digest) const {
  const bool proved = ending.verdict == Verdict::kProved;
  const bool refuted = ending.verdict == Verdict::kRefuted;
  write("{\"claim\":" + canonical(claim_of(ending.verdict)));
  write(",\"format\":\"taut-certificate\",\"generator\":" + canonical(generator_json()));
  write(",\"illustration\":" + canonical(ending.illustration));
  write(",\"margins\":" + canonical(proved ? to_json(*ending.margins) : json::object()));
  write(",\"path\":");
  emit_path(write);
  write(fmt::format(R"(,"path_sha256":"{}","problem":{},"problem_sha256":"{}","segments":)", path_digest,
                    canonical(problem_), sha256(problem_)));
  if (ending.verdict == Verdict::kUndecided) {
    write("[]");
  } else {
    segments_->replay(write);
  }
  write(",\"source\":" + canonical(ending.source) + ",\"stretches\":");
  if (proved) {
    write("null");
  } else {
    stretches_->replay(write);
  }
  write(",\"undecided\":" + canonical(proved || refuted ? json() : ending.undecided));
  write(fmt::format(R"(,"verdict":"{}","version":{},"witness":{})", name(ending.verdict), kCertificateVersion,
                    canonical(refuted ? ending.witness : json())));
}

void CertificateStream::finish(const Ending& ending, const Write& write, const Sign& sign) {
  Sha256 path;
  emit_path(digest_of(path));
  const std::string path_digest = path.hex();

  Sha256 whole;
  const Write digest = digest_of(whole);
  emit(
      ending,
      [&](std::string_view text) {
        digest(text);
        write(text);
      },
      path_digest);
  digest("}");
  const std::string body_digest = whole.hex();
  const bool has_segments = ending.verdict != Verdict::kUndecided;
  const std::string footer = canonical({{"waypoints", waypoints_->count()},
                                        {"segments", has_segments ? segments_->count() : 0},
                                        {"boxes", has_segments ? boxes_ : 0},
                                        {"sha256", body_digest}});
  write(",\"footer\":" + footer);
  if (sign) write(",\"signature\":" + canonical(sign(body_digest)));
  write("}\n");
}

}  // namespace taut
