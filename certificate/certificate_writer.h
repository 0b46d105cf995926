// SPDX-License-Identifier: GPL-3.0-or-later
// Writes certificates, whole ones and ones of any length that come segment by segment.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "certificate/certificate.h"
#include "certificate/signature.h"

namespace taut {

/// Canonical JSON of a waypoint. Thread-safe.
[[nodiscard]] std::string waypoint_text(Interpolation law, const Waypoint& waypoint);
/// Canonical JSON of segment k of a path. Thread-safe. @pre the problem has no bodies
[[nodiscard]] std::string segment_text(const CertificateSegment& segment, std::size_t k, const Problem& problem,
                                       Interpolation law);
/// A witness as certificates state it.
[[nodiscard]] nlohmann::json to_json(const Witness& witness);

/// Takes the parts of a certificate in order along the path, and writes it when the verdict is known. Given a folder,
/// it keeps the parts there in files without a name, so that its memory does not grow with the path.
class CertificateWriter {
 public:
  /// Receives the file, piece by piece.
  using Write = std::function<void(std::string_view)>;
  /// Makes the object `signature` for a digest (signature.h).
  using Sign = std::function<nlohmann::json(const std::string& digest)>;

  /// @param folder  for temporary files; empty: the parts are kept in memory.
  /// @throws InputError if it can't write there.
  CertificateWriter(const Problem& problem, Interpolation law, const std::filesystem::path& folder = {});
  ~CertificateWriter();
  CertificateWriter(const CertificateWriter&) = delete;
  CertificateWriter& operator=(const CertificateWriter&) = delete;

  /// @param text  as waypoint_text() has it
  void add_waypoint(std::string_view text);
  void add_time(std::string_view decimal);  ///< one a waypoint, or none at all
  void set_timing(const TimeLaw& law);      ///< of a move
  void add_tube(double tube);
  void add_pose_tube(const PoseTube& tube, std::span<const InnerPose> inner_poses = {});
  /// @param text  as segment_text() has it
  void add_segment(std::string_view text, std::size_t boxes);
  /// Segment k of a path, with its directions where the problem has bodies.
  void add_segment(const CertificateSegment& segment, std::size_t k);
  void add_stretch(const Stretch& stretch);

  /// Writes the whole certificate, with a line for each waypoint and segment. If it is undecided, its segments are left
  /// out, whatever was added.
  /// @param rest  verdict, margins, witness, undecided, source and illustration; the rest was added before.
  /// @param sign  may be empty: then the certificate is not signed.
  void finish(const Certificate& rest, const Write& write, const Sign& sign = {});

 private:
  class Spool;
  void emit_path(const Write& write) const;
  void emit(const Certificate& rest, const Write& write, const std::string& path_digest) const;
  [[nodiscard]] std::size_t index_of(const Direction& direction);
  [[nodiscard]] nlohmann::json apart(const PairDirections& directions);

  nlohmann::json problem_;
  std::optional<std::array<bool, kPairClasses>> checked_;  ///< where the problem has bodies: which pairs
  Interpolation law_;
  std::optional<TimeLaw> timing_;
  std::unique_ptr<Spool> waypoints_, times_, tubes_, pose_tubes_, segments_, stretches_, directions_;
  std::map<Direction, std::size_t> index_;  ///< of each in `directions_`
  std::size_t boxes_ = 0;
};

/// The text of a certificate that is held in memory, indented for people.
/// @param key  signs it; null: it is not signed.
[[nodiscard]] std::string certificate_text(const Certificate& certificate, const SigningKey* key = nullptr);

}  // namespace taut
