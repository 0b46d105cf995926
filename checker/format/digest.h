// SHA-256, piece by piece.
#pragma once

#include <openssl/evp.h>

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace taut::checker {

/// Lower-case hex digits, two a byte.
[[nodiscard]] inline std::string to_hex(std::span<const unsigned char> bytes) {
  std::string hex;
  for (const unsigned char byte : bytes) {
    hex += "0123456789abcdef"[byte >> 4U];
    hex += "0123456789abcdef"[byte & 15U];
  }
  return hex;
}

class Sha256 {
 public:
  Sha256() { require(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr)); }
  void update(std::string_view bytes) { require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size())); }
  /// 64 lower-case hex digits. Nothing may be added after it.
  [[nodiscard]] std::string hex() {
    unsigned char bytes[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    require(EVP_DigestFinal_ex(context_.get(), bytes, &size));
    return to_hex({bytes, size});
  }

 private:
  static void require(int is_done) {
    if (is_done != 1) throw std::runtime_error("SHA-256 is not available");
  }
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

}  // namespace taut::checker
