// SPDX-License-Identifier: GPL-3.0-or-later
// A certificate (docs/certificate-format.md) as taut holds it: what is claimed, about which path of which machine, and
// how the checker's kernel proves it. elaborate.h fills it, certificate_writer.h writes it, certificate_reader.h reads
// it back. It is no verdict: only the checker can make a theorem of it (checker/theorem.h).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "certify/path_proof.h"
#include "checker/format/witness.h"
#include "checker/kernel/statement.h"

namespace taut {

/// Version of the format that is written and read; that where the problem has bodies; and that where it has limits in
/// time, with bodies or without.
inline constexpr int kCertificateVersion = 4;
inline constexpr int kCertificateVersionWithBodies = 5;
inline constexpr int kCertificateVersionInTime = 6;
/// The most half turns that a waypoint may state, either way.
inline constexpr int kMostHalfTurns = 1'000'000;

/// The program that wrote a certificate; free text.
struct Generator {
  std::string name;
  std::string version;
};

/// What is proved of one segment.
struct CertificateSegment {
  std::vector<checker::Box> boxes;  ///< in order; each is proved by the kernel at one go
  std::optional<Margins> margins;   ///< kept by all boxes; absent where there is no box
  /// One a box, where the problem has bodies: along which pairs are told apart on it.
  std::vector<PairDirections> directions{};
};

/// A proved violation, and how the kernel proves it. Segments are counted from the path's beginning.
struct Witness {
  PathWitness violation;                      ///< what is violated, where and by how much
  checker::Box at_box;                        ///< the pose at `violation.at`
  checker::Box to_box;                        ///< the pose at `violation.to`; only if singular
  std::vector<checker::MotionBox> motion;     ///< boxes over which only the motion is shown
  std::vector<checker::InnerPose> way_poses;  ///< how a deviation is followed as it grows; none if it leads nowhere
  std::vector<checker::Box> way_boxes;        ///< likewise
  /// One load of each item under which the limit is violated; none where the load is an ellipsoid alone, the limit one
  /// of a length, or no load was found that can be written down.
  std::optional<std::vector<checker::LoadChoice>> loads = std::nullopt;
};

/// A part of an audited path that is not proved. Next to it, the path is proved or ends.
struct Stretch {
  PathPoint begin, end;
  std::optional<std::pair<Witness, Witness>> violations;  ///< the first and the last proved one; none if it is open
  std::string reason;                                     ///< why it is open; empty where there are violations
};

/// What was left open by a proof that came to no verdict.
struct OpenPart {
  std::string reason;
  std::optional<int> segment;                      ///< absent where no segment was tried
  std::optional<std::pair<Dyadic, Dyadic>> box{};  ///< of that segment
};

/// Where an audited path came from; free text.
struct PathOrigin {
  std::string file;
  std::string sha256;
};

struct Certificate {
  Verdict verdict = Verdict::kUndecided;
  Problem problem;
  Path path;
  std::vector<CertificateSegment> segments;  ///< one a segment of the path; none where nothing is proved of any
  std::optional<Margins> margins;            ///< the least along the path; only if proved
  std::optional<Witness> witness;            ///< only if refuted
  std::optional<OpenPart> undecided;         ///< only if undecided
  std::vector<Stretch> stretches;            ///< of an audit that is not proved
  std::optional<PathOrigin> source;          ///< of an audit
  nlohmann::json illustration;               ///< floating-point data for pictures; proves nothing
  // These are as a file states them; the writer takes none of them from here.
  Generator generator;
  std::string claim;
  std::string problem_sha256, path_sha256, footer_sha256;
};

/// The boxes of all segments.
[[nodiscard]] std::size_t count_boxes(const Certificate& certificate);
/// Those boxes that are of the form [k/2^d, (k+1)/2^d]; taut writes no others.
[[nodiscard]] std::vector<DyadicBox> dyadic_boxes(std::span<const checker::Box> boxes);
/// `x` as the kernel has numbers.
[[nodiscard]] mpq_class to_rational(const Dyadic& x);

/// "proved", "refuted" or "undecided".
[[nodiscard]] const char* name(Verdict verdict);
/// "straight-in-parameters" and so on.
[[nodiscard]] const char* interpolation_name(Interpolation law);
/// "-0x1.2666666666666p+1": a binary64 that reads back bit for bit.
[[nodiscard]] std::string hex_float(double x);

}  // namespace taut
