// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate_file.h"

#include <fmt/format.h>

#include "base/files.h"
#include "base/input_error.h"
#include "base/input_kind.h"
#include "base/placed_json.h"
#include "checker/format/reader.h"
#include "checker/kernel/errors.h"

namespace taut {

nlohmann::json parse_certificate(const std::string& text, const std::string& name) {
  return reading(InputKind::kCertificate, name, [&] {
    try {
      (void)checker::read_certificate(text);
      return nlohmann::json::parse(text);
    } catch (const checker::Malformed& error) {
      throw InputError(fmt::format("got {}, expected a certificate", error.what()));
    }
  });
}

nlohmann::json read_certificate(const std::string& path) { return parse_certificate(read_whole(path), path); }

}  // namespace taut
