// SPDX-License-Identifier: GPL-3.0-or-later
// Signatures of certificates (docs/certificate-format.md, "signature"): who vouches for a file. They prove nothing
// about the robot.
//
// Ed25519 as OpenSSL does it; keys are PEM as `openssl genpkey -algorithm ed25519` writes them.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

struct evp_pkey_st;  // OpenSSL's EVP_PKEY

namespace taut {

/// An Ed25519 private key.
class SigningKey {
 public:
  /// @param pem   the text of a PKCS#8 file; wiped before this returns.
  /// @param name  of the file, for messages.
  /// @throws InputError for anything but one unencrypted Ed25519 private key, saying what was seen.
  SigningKey(std::string pem, const std::string& name);

  /// The 32 bytes of the public half, as 64 lower-case hex digits.
  [[nodiscard]] std::string public_key() const;

  /// The object `signature` of a certificate.
  /// @param digest  `footer.sha256`
  [[nodiscard]] nlohmann::json signature(const std::string& digest) const;

 private:
  struct Free {
    void operator()(evp_pkey_st* key) const;
  };
  std::unique_ptr<evp_pkey_st, Free> key_;
};

}  // namespace taut
