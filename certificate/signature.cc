// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/signature.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/pem.h>

#include <array>
#include <span>
#include <stdexcept>

#include "base/input_error.h"

namespace taut {
namespace {

constexpr std::size_t kMaxSize = 1 << 16;  ///< bytes of a key file; Ed25519 needs 119

std::string hex(std::span<const unsigned char> bytes) {
  std::string digits;
  for (const unsigned char byte : bytes) digits += fmt::format("{:02x}", byte);
  return digits;
}

/// Tells OpenSSL that there is no passphrase, and notes that the file was encrypted.
int no_passphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* was_asked) {
  *static_cast<bool*>(was_asked) = true;
  return -1;
}

std::string describe(const std::string& pem, bool is_encrypted) {
  const auto holds = [&](const char* label) { return pem.find(label) != std::string::npos; };
  if (is_encrypted) return "an encrypted private key";
  if (holds("-----BEGIN PUBLIC KEY-----")) return "a public key";
  if (holds("-----BEGIN CERTIFICATE-----")) return "an X.509 certificate";
  if (holds("-----BEGIN OPENSSH PRIVATE KEY-----")) return "a private key in OpenSSH's own format";
  if (holds("PRIVATE KEY-----")) return "a private key that OpenSSL cannot read";
  return "no PEM";
}

}  // namespace

void SigningKey::Free::operator()(evp_pkey_st* key) const { EVP_PKEY_free(key); }

SigningKey::SigningKey(std::string pem, const std::string& name) {
  bool is_encrypted = false;
  if (pem.size() <= kMaxSize) {
    const std::unique_ptr<BIO, decltype(&BIO_free)> bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())),
                                                        BIO_free);
    if (!bio) throw std::runtime_error("OpenSSL could not read from memory");
    key_.reset(PEM_read_bio_PrivateKey(bio.get(), nullptr, no_passphrase, &is_encrypted));
  }
  std::string seen;
  if (!key_) {
    seen = describe(pem, is_encrypted);
  } else if (EVP_PKEY_id(key_.get()) != EVP_PKEY_ED25519) {
    const char* const type = EVP_PKEY_get0_type_name(key_.get());
    seen = fmt::format("a private key of type {}", type != nullptr ? type : "unknown");
  }
  OPENSSL_cleanse(pem.data(), pem.size());
  if (!seen.empty()) {
    throw InputError(
        ErrorCode::kKey,
        fmt::format(
            "{}: got {}, expected an unencrypted Ed25519 private key in PEM (openssl genpkey -algorithm ed25519)", name,
            seen),
        {name});
  }
}

std::string SigningKey::public_key() const {
  std::array<unsigned char, 32> bytes{};
  std::size_t size = bytes.size();
  if (EVP_PKEY_get_raw_public_key(key_.get(), bytes.data(), &size) != 1 || size != bytes.size()) {
    throw std::runtime_error("OpenSSL could not tell the public key");
  }
  return hex(bytes);
}

nlohmann::json SigningKey::signature(const std::string& digest) const {
  const std::string message = "taut certificate " + digest;
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  std::array<unsigned char, 64> value{};
  std::size_t size = value.size();
  const std::basic_string<unsigned char> bytes(message.begin(), message.end());
  if (!context || EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key_.get()) != 1 ||
      EVP_DigestSign(context.get(), value.data(), &size, bytes.data(), bytes.size()) != 1 || size != value.size()) {
    throw std::runtime_error("OpenSSL could not sign");
  }
  return {{"algorithm", "Ed25519"}, {"public_key", public_key()}, {"value", hex(value)}};
}

}  // namespace taut
