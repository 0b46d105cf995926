#include "library/certificate_file.h"

#include <fmt/format.h>

#include "certify/certificate.h"
#include "kinematics/input_error.h"
#include "kinematics/input_kind.h"
#include "library/files.h"

namespace taut {
namespace {

void require_unaltered(const nlohmann::json& certificate, const std::string& path) {
  nlohmann::json body = certificate;
  const bool has_footer =
      body.is_object() && body.contains("footer") && body["footer"].is_object() && body["footer"].contains("sha256");
  const nlohmann::json digest = has_footer ? body["footer"]["sha256"] : nlohmann::json();
  if (body.is_object()) {
    body.erase("footer");
    body.erase("signature");
  }
  if (digest != sha256(body)) {
    throw InputError(fmt::format("{}: footer.sha256: got {}, expected the digest of this file: it is no certificate, "
                                 "or was cut or altered",
                                 path, digest.dump()),
                     {path});
  }
}

}  // namespace

nlohmann::json parse_certificate(const std::string& text, const std::string& name) {
  return reading(InputKind::kCertificate, [&] {
    nlohmann::json certificate;
    try {
      certificate = nlohmann::json::parse(text);
      require_unaltered(certificate, name);
    } catch (const nlohmann::json::exception& error) {
      throw InputError(fmt::format("{}: {}", name, error.what()), {name});
    }
    return certificate;
  });
}

nlohmann::json read_certificate(const std::string& path) { return parse_certificate(read_whole(path), path); }

}  // namespace taut
