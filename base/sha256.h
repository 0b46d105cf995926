// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256 of JSON values, or of bytes piece by piece.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX

namespace taut {

class Sha256 {
 public:
  Sha256();
  void update(std::string_view bytes);
  /// The digest, 64 lower-case hex digits. @pre called once; no update() follows.
  [[nodiscard]] std::string hex();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// The SHA-256 of the canonical JSON of `value`: 64 lower-case hex digits.
[[nodiscard]] std::string sha256(const nlohmann::json& value);

}  // namespace taut
