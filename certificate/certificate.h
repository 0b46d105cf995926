// SPDX-License-Identifier: GPL-3.0-or-later
// Writes certificates (docs/certificate-format.md): the theorem, its exact inputs, and the boxes that prove it.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "certificate/elaborate.h"

namespace taut {

/// Of the format that is written.
inline constexpr int kCertificateVersion = 4;

/// "-0x1.2666666666666p+1": reads back bit for bit.
[[nodiscard]] std::string hex_float(double x);

/// The whole certificate, footer included. `illustration` is floating-point data for pictures and proves nothing.
[[nodiscard]] nlohmann::json make_certificate(const Problem& problem, const Path& path, const PathProof& proof,
                                              nlohmann::json illustration);

// Its parts.
[[nodiscard]] const char* name(Verdict verdict);      ///< "proved", …
[[nodiscard]] const char* claim_of(Verdict verdict);  ///< the theorem, in words
[[nodiscard]] const char* interpolation_name(Interpolation law);
[[nodiscard]] nlohmann::json generator_json();
[[nodiscard]] nlohmann::json to_json(const Margins& margins);
[[nodiscard]] nlohmann::json to_json(const PathPoint& place);
/// @param segment  what the kernel was asked about as segment 0
[[nodiscard]] nlohmann::json to_json(const PathWitness& found, const KernelWitness& kernel, std::size_t segment);
/// A segment with its boxes; `from` and `to` are its first and last control point.
[[nodiscard]] nlohmann::json to_json(const KernelSegment& segment, std::size_t from, std::size_t to,
                                     bool has_tolerances);

/// An entry of `path.pose_tubes`.
[[nodiscard]] nlohmann::json pose_tube_json(const PoseTube& tube, std::span<const InnerPose> inner_poses);

inline constexpr int kMostHalfTurns = 1'000'000;  ///< of a waypoint in a certificate, either way

/// A certificate's `path`. @throws InputError for anything malformed.
[[nodiscard]] Path path_from_json(const nlohmann::json& path);

}  // namespace taut
