// SPDX-License-Identifier: GPL-3.0-or-later
// Reads certificates for those who show or use them. Only their form is looked at: whether one is true is the checker's
// to say.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "certificate/certificate.h"

namespace taut {

/// The JSON of a certificate's text, once its digest was compared.
/// @param name  stands for the text in messages
/// @throws InputError where it is not a certificate, or was cut or altered.
[[nodiscard]] nlohmann::json parse_certificate(const std::string& text, const std::string& name);

/// The whole certificate. Digests and claim are what the file states; a signature is left out.
/// @throws InputError for a missing key or a wrong type.
[[nodiscard]] Certificate read_certificate(const nlohmann::json& certificate);

/// A certificate's `path` alone. Sizes and ranges that the problem prescribes are not looked at.
/// @throws InputError for anything malformed.
[[nodiscard]] Path read_path(const nlohmann::json& path);

}  // namespace taut
