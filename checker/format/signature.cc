// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/signature.h"

#include <openssl/evp.h>
#include <openssl/pem.h>

#include <memory>

#include "base/sha256.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

using Bytes = std::vector<unsigned char>;
template <class T>
using Owner = std::unique_ptr<T, void (*)(T*)>;

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

/// @param hex  an even number of hex digits
Bytes from_hex(const std::string& hex) {
  Bytes bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<unsigned char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

Owner<EVP_PKEY> make_key(const Bytes& bytes) {
  Owner<EVP_PKEY> key(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, bytes.data(), bytes.size()),
                      EVP_PKEY_free);
  if (!key) throw std::runtime_error("Ed25519 is not available");
  return key;
}

bool is_signed(const std::string& message, const Bytes& value, const Bytes& public_key) {
  const Owner<EVP_PKEY> key = make_key(public_key);
  const Owner<EVP_MD_CTX> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  if (!context || EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, key.get()) != 1) {
    throw std::runtime_error("Ed25519 is not available");
  }
  const Bytes bytes(message.begin(), message.end());
  return EVP_DigestVerify(context.get(), value.data(), value.size(), bytes.data(), bytes.size()) == 1;
}

}  // namespace

std::string verify_signature(const Cursor& json, const std::string& digest) {
  json.object({"algorithm", "public_key", "value"});
  if (json["algorithm"].text() != "Ed25519") json["algorithm"].fail("'Ed25519'");
  const Bytes public_key = from_hex(json["public_key"].hex(kKeySize));
  const Bytes value = from_hex(json["value"].hex(kSignatureSize));
  if (!is_signed("taut certificate " + digest, value, public_key)) {
    json["value"].fail("a signature of this certificate by that key: one of the three was altered");
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
  const Owner<BIO> bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())), [](BIO* x) { BIO_free(x); });
  if (!bio) throw std::runtime_error("OpenSSL could not read from memory");
  const Owner<EVP_PKEY> key(PEM_read_bio_PUBKEY(bio.get(), nullptr, nullptr, nullptr), EVP_PKEY_free);
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
  const Owner<EVP_PKEY> key = make_key(from_hex(public_key));
  unsigned char* der = nullptr;
  const int size = i2d_PUBKEY(key.get(), &der);
  if (size <= 0) throw std::runtime_error("OpenSSL could not write a public key");
  const Owner<unsigned char> owner(der, [](unsigned char* p) { OPENSSL_free(p); });
  Sha256 digest;
  const std::string bytes(der, der + size);
  digest.update(bytes);
  return "SHA256:" + digest.hex();
}

}  // namespace taut::checker
