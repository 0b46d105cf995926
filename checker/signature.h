// Who signed a certificate: "signature" in docs/certificate-format.md. Says nothing about whether its claim is true.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace taut::checker {

/// Takes the key `signature` off a certificate, if it has one, and verifies it against all the rest.
/// @returns the signer's public key, 64 lower-case hex digits, or nothing where there is no signature.
/// @throws Malformed where the signature is not well formed or is not that of the rest by that key.
[[nodiscard]] std::optional<std::string> take_signature(nlohmann::json& certificate);

/// The public key of a PEM file (SubjectPublicKeyInfo), 64 lower-case hex digits.
/// @throws Malformed, beginning with `where`, for anything but one Ed25519 public key.
[[nodiscard]] std::string read_public_key(const std::string& pem, const std::string& where);

/// "SHA256:" and the digest of the key's SubjectPublicKeyInfo in DER, in hex, as of
/// `openssl pkey -pubin -in FILE -outform DER | sha256sum`.
[[nodiscard]] std::string fingerprint(const std::string& public_key);

}  // namespace taut::checker
