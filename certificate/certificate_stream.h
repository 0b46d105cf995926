// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a certificate of any length in constant memory: waypoints and segments are spooled to unnamed files as they come, and put
// together at the end, when the verdict is known. What is written is what make_certificate() would make of the same parts.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "certificate/certificate.h"
#include "certify/path_proof.h"

namespace taut {

/// Canonical JSON of a waypoint and of a segment, as certificates have them. Quick, and safe in any thread.
[[nodiscard]] std::string waypoint_text(Interpolation law, const Waypoint& waypoint);
[[nodiscard]] std::string segment_text(const KernelSegment& segment, std::size_t from, std::size_t to,
                                       bool has_tolerances);

class CertificateStream {
 public:
  /// What is only known at the end.
  struct Ending {
    Verdict verdict = Verdict::kUndecided;
    std::optional<Margins> margins;  ///< only if proved
    nlohmann::json witness;          ///< only if refuted
    nlohmann::json undecided;        ///< only if undecided
    nlohmann::json source;
    nlohmann::json illustration;
  };
  /// Receives the file, piece by piece.
  using Write = std::function<void(std::string_view)>;
  /// The object `signature` for a digest (signature.h).
  using Sign = std::function<nlohmann::json(const std::string& digest)>;

  /// Spools in `folder`, in files without a name. @throws InputError if it can't.
  CertificateStream(const std::filesystem::path& folder, const Problem& problem, Interpolation law);
  ~CertificateStream();
  CertificateStream(const CertificateStream&) = delete;
  CertificateStream& operator=(const CertificateStream&) = delete;

  // Each in order along the path.
  void add_waypoint(std::string_view text);
  void add_time(std::string_view decimal);  ///< one a waypoint, or none at all
  void add_tube(double tube);
  void add_pose_tube(const PoseTube& tube, std::span<const InnerPose> inner_poses = {});
  void add_segment(std::string_view text, std::size_t boxes);
  void add_stretch(const nlohmann::json& stretch);

  /// The whole certificate, with a line for each waypoint and segment. Undecided ones have no segments, whatever was added.
  void finish(const Ending& ending, const Write& write, const Sign& sign = {});

 private:
  class Spool;
  struct Parts;
  void emit_path(const Write& write) const;
  void emit(const Ending& ending, const Write& write, const std::string& path_digest) const;

  std::filesystem::path folder_;
  nlohmann::json problem_;
  Interpolation law_;
  std::unique_ptr<Spool> waypoints_, times_, tubes_, pose_tubes_, segments_, stretches_;
  std::size_t boxes_ = 0;
};

}  // namespace taut
