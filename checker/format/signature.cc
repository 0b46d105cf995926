// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/signature.h"

#include <openssl/evp.h>
#include <openssl/pem.h>

#include <algorithm>
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

Bytes from_hex(const std::string& hex) {
  Bytes bytes(hex.size() / 2);
  std::size_t size = 0;
  if (OPENSSL_hexstr2buf_ex(bytes.data(), bytes.size(), &size, hex.c_str(), '\0') != 1) {
    throw std::runtime_error("OpenSSL could not read hex digits");
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
  std::string public_key;
  std::string value;
  json.object("algorithm", exactly("Ed25519", "'Ed25519'"), "public_key", hex(public_key, kKeySize), "value",
              hex(value, kSignatureSize));
  json["value"].require(is_signed("taut certificate " + digest, from_hex(value), from_hex(public_key)),
                        "a signature of this certificate by that key: one of the three was altered");
  return public_key;
}

std::string read_public_key(const std::string& pem, const std::string& where) {
  const auto fail = [&](const std::string& seen) {
    throw Malformed(where + ": got " + seen + ", expected one Ed25519 public key in PEM (openssl pkey -pubout)");
  };
  if (pem.size() > kMaxKeyFile) fail("a file too long");
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
  std::string digits(2 * kKeySize + 1, '\0');  // OpenSSL ends them with a NUL
  if (EVP_PKEY_get_raw_public_key(key.get(), bytes.data(), &size) != 1 ||
      OPENSSL_buf2hexstr_ex(digits.data(), digits.size(), nullptr, bytes.data(), size, '\0') != 1) {
    throw std::runtime_error("OpenSSL could not tell the public key");
  }
  digits.pop_back();
  std::ranges::transform(digits, digits.begin(),
                         [](char c) { return c >= 'A' ? static_cast<char>(c - 'A' + 'a') : c; });
  return digits;
}

std::string fingerprint(const std::string& public_key) {
  const Owner<EVP_PKEY> key = make_key(from_hex(public_key));
  unsigned char* der = nullptr;
  const int size = i2d_PUBKEY(key.get(), &der);
  if (size <= 0) throw std::runtime_error("OpenSSL could not write a public key");
  const Owner<unsigned char> owner(der, [](unsigned char* p) { OPENSSL_free(p); });
  Sha256 digest;
  digest.update({reinterpret_cast<const char*>(der), static_cast<std::size_t>(size)});
  return "SHA256:" + digest.hex();
}

}  // namespace taut::checker
