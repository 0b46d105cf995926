// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate_file.h"

#include <fmt/format.h>

#include "base/files.h"
#include "base/input_error.h"
#include "base/input_kind.h"
#include "base/json_cursor.h"
#include "checker/format/strict_json.h"
#include "checker/kernel/errors.h"

namespace taut {

namespace {

void require_unaltered(const nlohmann::json& certificate, const std::string& sha256) {
  const nlohmann::json::json_pointer place("/footer/sha256");
  static const nlohmann::json kNone;
  const nlohmann::json& stated = certificate.is_object() && certificate.contains(place) ? certificate.at(place) : kNone;
  if (stated == sha256) return;
  JsonCursor(stated, "footer.sha256").fail("the digest of this file: it is no certificate, or was cut or altered");
}

}  // namespace

nlohmann::json parse_certificate(const std::string& text, const std::string& name) {
  return reading(InputKind::kCertificate, name, [&] {
    try {
      const std::string digest = checker::read_json(text).body_sha256;
      nlohmann::json certificate = nlohmann::json::parse(text);
      require_unaltered(certificate, digest);
      return certificate;
    } catch (const checker::Malformed& error) {
      throw InputError(fmt::format("got {}, expected a certificate", error.what()));
    }
  });
}

nlohmann::json read_certificate(const std::string& path) { return parse_certificate(read_whole(path), path); }

}  // namespace taut
