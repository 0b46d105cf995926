// SPDX-License-Identifier: GPL-3.0-or-later
// Tries to prove that no path exists: separates waypoints of the query by a map, and writes the certificate.
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "case/case_file.h"
#include "certificate/signature.h"
#include "map/separation.h"

namespace taut {

/// How long `taut plan` tries where its search found no path, if nobody says [s].
inline constexpr double kNoPathSeconds = 10;

/// What became of it.
struct NoPathAttempt {
  enum class Answer {
    kApart,        ///< there is a certificate
    kJoined,       ///< the machine as typed can go all the way: there is nothing to prove
    kOpen,         ///< neither is proved
    kUnsupported,  ///< the space has no map
  };
  Answer answer = Answer::kUnsupported;
  std::string why;                 ///< of kUnsupported
  std::size_t from = 0;            ///< of kApart and kOpen: the waypoint of the query from which it is
  std::string certificate;         ///< of kApart: its text
  std::optional<MapSpace> space;   ///< but of kUnsupported
  std::optional<Separation> open;  ///< of kOpen
  std::size_t cells = 0;           ///< of all maps
  double seconds = 0;
};

/// Tries each way from a waypoint of the query to the next, until one is proved to be none.
/// @param key  signs the certificate; null: it is not signed
/// @pre the query has two waypoints
[[nodiscard]] NoPathAttempt seek_no_path(const Case& the_case, const SeparationOptions& options,
                                         const SigningKey* key = nullptr);

/// What an attempt that proved nothing has found, in a sentence or two with the case's units, such as where the gap is.
[[nodiscard]] std::string describe_open(const Case& the_case, const NoPathAttempt& attempt);

}  // namespace taut
