// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates in files, read back.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace taut {

/// A whole certificate, as it was written: whether it is true is taut-check's to say.
/// @throws InputError where it can't be read, or was cut or altered.
[[nodiscard]] nlohmann::json read_certificate(const std::string& path);
/// From the text of such a file; `name` stands for it in messages.
[[nodiscard]] nlohmann::json parse_certificate(const std::string& text, const std::string& name);

}  // namespace taut
