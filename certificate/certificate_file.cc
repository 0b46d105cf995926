#include "certificate/certificate_file.h"

#include <fmt/format.h>

#include "base/files.h"
#include "base/input_error.h"
#include "base/input_kind.h"
#include "base/placed_json.h"
#include "base/sha256.h"
#include "certificate/certificate.h"
#include "checker/certificate.h"
#include "checker/errors.h"

namespace taut {
namespace {

void require_unaltered(const nlohmann::json& certificate) {
  nlohmann::json body = certificate;
  const bool has_footer =
      body.is_object() && body.contains("footer") && body["footer"].is_object() && body["footer"].contains("sha256");
  static const nlohmann::json kNone;
  const nlohmann::json digest = has_footer ? body["footer"]["sha256"] : kNone;
  if (body.is_object()) {
    body.erase("footer");
    body.erase("signature");
  }
  if (digest != sha256(body)) {
    PlacedJson(digest, "footer.sha256").fail("the digest of this file: it is no certificate, or was cut or altered");
  }
}

}  // namespace

nlohmann::json parse_certificate(const std::string& text, const std::string& name) {
  return reading(InputKind::kCertificate, name, [&] {
    try {
      nlohmann::json certificate = checker::parse_json(text);
      require_unaltered(certificate);
      return certificate;
    } catch (const checker::Malformed& error) {
      throw InputError(fmt::format("got {}, expected a certificate", error.what()));
    }
  });
}

nlohmann::json read_certificate(const std::string& path) { return parse_certificate(read_whole(path), path); }

}  // namespace taut
