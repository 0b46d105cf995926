// SPDX-License-Identifier: GPL-3.0-or-later
// The script that draws the report's plots and the picture of the move in the reader's browser: all of reports/web/
// with the libraries that it uses, bundled when taut is built.
#pragma once

#include <string_view>

namespace taut {

/// The content of the script element, UTF-8. It begins with the licences of the libraries in it.
[[nodiscard]] std::string_view page_script();
/// Its SHA-256 in base64, for the page's Content-Security-Policy, which allows this script and no other.
[[nodiscard]] std::string_view page_script_sha256();

}  // namespace taut
