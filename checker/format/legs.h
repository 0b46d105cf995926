// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a certificate of legs, and checks its form: "Legs" in docs/certificate-format.md. Proves nothing about the
// robot.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "checker/format/reader.h"
#include "checker/format/strict_json.h"

namespace taut::checker {

inline constexpr int kVersionOfLegs = 7;  ///< of the format
inline constexpr std::size_t kLeastLegs = 2;
inline constexpr std::size_t kMostLegs = 64;

/// A certificate of its own.
struct Leg {
  std::string_view text;  ///< its bytes, a part of those of the whole
  Certificate certificate;
};

struct LegsCertificate {
  Verdict verdict = Verdict::kUndecided;  ///< proved if all legs are; refuted if one is
  std::vector<Leg> legs;
  std::size_t first_refuted = 0;  ///< of kRefuted
  std::string signer;             ///< the public key, 64 hex digits; empty where there is no signature
};

/// Whether a text that read_json() has gone through is a certificate of legs, well formed or not.
[[nodiscard]] bool is_of_legs(const Outline& outline);

/// The bytes of each leg. @pre read_legs() takes the certificate
[[nodiscard]] std::vector<std::string_view> leg_texts(const Outline& outline);

/// Checks all rules of form of the whole and of each leg: 2 to 64 legs, each a planned path in a space without
/// constraints; the verdict that follows from theirs. That all proved legs are moves, or none is, follows from one
/// problem for all (checker/legs.h), since a proved path has a law where its problem limits moves, and nowhere else.
/// @param outline  its text must outlive the certificate, which refers to it.
/// @throws Malformed naming the key.
[[nodiscard]] LegsCertificate read_legs(const Outline& outline);

}  // namespace taut::checker
