// Is the claim of a certificate true? Proves it again, from the file alone.
//
// This checker shares with the prover the certificate's format and nothing else: own equations, own parser, own
// arithmetic, no heuristics that could matter. To believe "accepted", read in this order: errors.h, interval.h, form.h,
// then krawczyk.h, motion.h, pose_proof.h, held.h, deviation.h and their .cc (the mathematics), check.cc (what is proved
// of which poses), then exact.h, expression.h and certificate.h (that the numbers are those of the file); signature.h if
// it matters who wrote it.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace taut::checker {

enum class Outcome {
  kAccepted,   ///< the claim, "proved" or "refuted", was proved again
  kRejected,   ///< well formed, but some statement could not be confirmed
  kUndecided,  ///< well formed, and the certificate itself claims nothing
  kMalformed,  ///< unreadable, cut, altered, or no certificate
};

struct CheckResult {
  Outcome outcome = Outcome::kMalformed;
  std::string message = "nothing was checked";  ///< one line of printable ASCII, without the outcome itself
  std::string verdict;                          ///< the certificate's, once it was read
  std::string signer;                           ///< public key whose signature was verified, or empty
  bool is_trusted = false;                      ///< whether the signer is one of those asked for
  bool is_audit = false;                        ///< the path itself is what was asked about
  std::size_t segments = 0;
  std::size_t boxes = 0;
  std::size_t pieces = 0;  ///< boxes after splitting: how many were proved at one go
  int bits = 0;            ///< the highest precision that was needed
};

/// Thrown where somebody asked to stop.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// @param text     the whole file.
/// @param problem  where not null: what the certificate's `problem` must equal.
/// @param trusted  unless empty: public keys (signature.h), one of which must have signed.
/// @param stop     asks to stop: looked at before each piece.
/// Never throws because of what the text says. @throws Interrupted; any other std::exception only where this program or machine
/// fails.
/// Cost: about a millisecond a box; with tolerances some 10 to 50, or half a second where they take many parts. Thread-safe.
[[nodiscard]] CheckResult check_certificate(const std::string& text, const nlohmann::json* problem = nullptr,
                                            std::span<const std::string> trusted = {},
                                            const std::stop_token& stop = {});

}  // namespace taut::checker
