#include "checker/signature.h"

#include <openssl/evp.h>
#include <openssl/pem.h>

#include <array>
#include <memory>
#include <vector>

#include "checker/certificate.h"
#include "checker/errors.h"

namespace taut::checker {
namespace {

using Bytes = std::vector<unsigned char>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;

constexpr std::size_t kKeySize = 32;
constexpr std::size_t kSignatureSize = 64;
constexpr std::size_t kMaxPemSize = 1 << 16;

std::string to_hex(const Bytes& bytes) {
  std::string hex;
  for (const unsigned char byte : bytes) {
    hex += "0123456789abcdef"[byte >> 4U];
    hex += "0123456789abcdef"[byte & 15U];
  }
  return hex;
}

/// One way of writing only: lower case.
Bytes from_hex(const nlohmann::json& json, std::size_t size, const std::string& where) {
  const std::string text = json.is_string() ? json.get<std::string>() : "";
  if (text.size() != 2 * size || text.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw Malformed(where + ": expected " + std::to_string(2 * size) + " lower-case hex digits");
  }
  Bytes bytes;
  const auto digit = [](char c) { return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10); };
  for (std::size_t i = 0; i < text.size(); i += 2) {
    bytes.push_back(static_cast<unsigned char>(digit(text[i]) << 4U | digit(text[i + 1])));
  }
  return bytes;
}

Key make_key(const Bytes& bytes) {
  Key key(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, bytes.data(), bytes.size()), EVP_PKEY_free);
  if (!key) throw std::runtime_error("Ed25519 is not available");
  return key;
}

bool verifies(const Bytes& public_key, const Bytes& value, const std::string& message) {
  const Key key = make_key(public_key);
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  if (!context || EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, key.get()) != 1) {
    throw std::runtime_error("Ed25519 is not available");
  }
  const Bytes bytes(message.begin(), message.end());
  return EVP_DigestVerify(context.get(), value.data(), value.size(), bytes.data(), bytes.size()) == 1;
}

}  // namespace

std::optional<std::string> take_signature(nlohmann::json& certificate) {
  if (!certificate.is_object() || !certificate.contains("signature")) return std::nullopt;
  const nlohmann::json signature = certificate["signature"];
  certificate.erase("signature");
  if (!signature.is_object() || signature.size() != 3 || !signature.contains("algorithm") ||
      !signature.contains("public_key") || !signature.contains("value")) {
    throw Malformed("signature: expected an object with algorithm, public_key and value");
  }
  if (signature["algorithm"] != "Ed25519") throw Malformed("signature.algorithm: expected 'Ed25519'");
  const Bytes public_key = from_hex(signature["public_key"], kKeySize, "signature.public_key");
  const Bytes value = from_hex(signature["value"], kSignatureSize, "signature.value");
  if (!verifies(public_key, value, "taut certificate " + digest(certificate))) {
    throw Malformed(
        "signature.value: expected a signature of this certificate by that key: one of the three was altered");
  }
  return to_hex(public_key);
}

std::string read_public_key(const std::string& pem, const std::string& where) {
  const auto fail = [&](const std::string& seen) {
    throw Malformed(where + ": got " + seen + ", expected one Ed25519 public key in PEM (openssl pkey -pubout)");
  };
  if (pem.size() > kMaxPemSize) fail("a file too long");
  const std::size_t first = pem.find("-----BEGIN ");
  if (first == std::string::npos) fail("no PEM");
  if (pem.find("-----BEGIN ", first + 1) != std::string::npos) fail("more than one key");
  if (pem.find("PRIVATE KEY-----") != std::string::npos) fail("a private key");
  const std::unique_ptr<BIO, decltype(&BIO_free)> bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())),
                                                      BIO_free);
  if (!bio) throw std::runtime_error("OpenSSL could not read from memory");
  const Key key(PEM_read_bio_PUBKEY(bio.get(), nullptr, nullptr, nullptr), EVP_PKEY_free);
  if (!key) fail("something else");
  if (EVP_PKEY_id(key.get()) != EVP_PKEY_ED25519) fail("a key of another type");
  Bytes bytes(kKeySize);
  std::size_t size = kKeySize;
  if (EVP_PKEY_get_raw_public_key(key.get(), bytes.data(), &size) != 1 || size != kKeySize) {
    throw std::runtime_error("OpenSSL could not tell the public key");
  }
  return to_hex(bytes);
}

std::string fingerprint(const std::string& public_key) {
  const Key key = make_key(from_hex(public_key, kKeySize, "public key"));
  unsigned char* der = nullptr;
  const int size = i2d_PUBKEY(key.get(), &der);
  if (size <= 0) throw std::runtime_error("OpenSSL could not write a public key");
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(der, [](unsigned char* p) { OPENSSL_free(p); });
  Bytes hash(EVP_MAX_MD_SIZE);
  unsigned int hash_size = 0;
  if (EVP_Digest(der, static_cast<std::size_t>(size), hash.data(), &hash_size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available");
  }
  hash.resize(hash_size);
  return "SHA256:" + to_hex(hash);
}

}  // namespace taut::checker
