// SPDX-License-Identifier: GPL-3.0-or-later
// Who signed a certificate: "signature" in docs/certificate-format.md. Says nothing about whether its claim is true.
#pragma once

#include <string>

#include "checker/format/cursor.h"

namespace taut::checker {

/// A file with a key is not larger [bytes].
inline constexpr std::size_t kMaxKeyFile = 1U << 16;

/// Verifies the object `signature` of a certificate whose footer has this digest.
/// @returns the signer's public key, 64 lower-case hex digits.
/// @throws Malformed where the object is not well formed or the signature does not belong to digest and key.
[[nodiscard]] std::string verify_signature(const Cursor& json, const std::string& digest);

/// The public key of a PEM file (SubjectPublicKeyInfo), 64 lower-case hex digits.
/// @throws Malformed, beginning with `where`, for anything but one Ed25519 public key.
[[nodiscard]] std::string read_public_key(const std::string& pem, const std::string& where);

/// "SHA256:" and the digest of the key's SubjectPublicKeyInfo in DER, in hex, as of
/// `openssl pkey -pubin -in FILE -outform DER | sha256sum`. `public_key` has 64 lower-case hex digits.
[[nodiscard]] std::string fingerprint(const std::string& public_key);

}  // namespace taut::checker
