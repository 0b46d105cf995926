// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256, of all at once or piece by piece.
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
  /// 64 lower-case hex digits; no update() after it.
  [[nodiscard]] std::string hex();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// Of the canonical JSON of `value`, 64 lower-case hex digits.
[[nodiscard]] std::string sha256(const nlohmann::json& value);

}  // namespace taut
