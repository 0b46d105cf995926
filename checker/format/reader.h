// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a certificate of a path and checks its form: docs/certificate-format.md, versions 4 to 6. Proves nothing about
// the robot.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "checker/format/strict_json.h"
#include "checker/format/witness.h"

namespace taut::checker {

enum class Verdict { kProved, kRefuted, kUndecided };

struct Segment {
  std::vector<Box> boxes;             ///< in order, not overlapping
  Margins margins;                    ///< stated for all of them; 0 where there is no box
  Apart apart;                        ///< likewise; empty where there is no box or no pair
  std::vector<ApartChanges> changes;  ///< of each box, to `apart`
  [[nodiscard]] Apart apart_of(std::size_t box) const;
};

/// A part of an audited path that is not proved.
struct Stretch {
  PathPoint begin;
  PathPoint end;
  std::vector<Witness> inner;  ///< its first and last proved violation; none where it is open
};

/// Where an audited path came from: informative.
struct Source {
  std::string file;
  std::string sha256;
};

struct Certificate {
  Verdict verdict = Verdict::kUndecided;
  Problem problem;
  nlohmann::json problem_json;  ///< `problem` as the file states it
  Path path;
  /// Of the whole path, as written: tension_N, length_m, wrench_scale, and clearance_m, which is empty where there are
  /// no bodies.
  std::array<std::string, 4> margins;
  std::optional<Witness> witness;
  std::string undecided_reason;
  std::optional<Source> source;
  std::string signer;  ///< the public key, 64 hex digits; empty where there is no signature
  std::size_t boxes = 0;

  // Segments and stretches stay text until they are wanted, as they would take many times the memory otherwise. Their
  // form has been checked. Both functions may be called from several threads.
  std::vector<std::string_view> segment_texts;
  std::vector<std::string_view> stretch_texts;
  [[nodiscard]] Segment segment(std::size_t k) const;
  [[nodiscard]] Stretch stretch(std::size_t i) const;
};

/// Checks all rules of form: keys and their order, types, counts, digests, the signature, the claim's text; limits in
/// order, E symmetric, periodic parameters along which pose and constraints close; sizes of waypoints and tubes, tubes
/// that contain one another; boxes and stretches that tile the path, no box across an inner pose; directions for
/// all pairs of bodies, in axes that may be; values of witnesses beyond their limits, weights of points whose sum is 1;
/// the top-level margins those of the worst segments.
/// @param text  must outlive the certificate, which refers to it.
/// @throws Malformed naming the key.
[[nodiscard]] Certificate read_certificate(std::string_view text);
/// The same for a text that read_json() has gone through.
[[nodiscard]] Certificate read_certificate(Outline outline);

}  // namespace taut::checker
