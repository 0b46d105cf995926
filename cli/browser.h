// SPDX-License-Identifier: GPL-3.0-or-later
// Pages as PDF and pictures as PNG, by a Chromium that the user has: it knows a page's style sheet and script as no
// library does.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace taut {

/// The browser is there and failed; exit code 4.
class BrowserFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Prints a page, without network, in a directory of its own that vanishes. The browser is $TAUT_BROWSER where that is
/// set, else the first of chromium, chromium-browser, google-chrome-stable and google-chrome that is found.
/// @returns the PDF's bytes, whole; nothing where `stop` asked to stop.
/// @throws InputError where there is no browser; BrowserFailed where it fails or takes too long.
[[nodiscard]] std::optional<std::string> print_to_pdf(const std::string& page, const std::stop_token& stop);

/// Draws an SVG picture of this size [px] as PNG, with two dots a pixel, in the same way.
/// @returns the PNG's bytes, whole; nothing where `stop` asked to stop.
/// @throws InputError where there is no browser; BrowserFailed where it fails or takes too long.
[[nodiscard]] std::optional<std::string> draw_as_png(const std::string& svg, int width, int height,
                                                     const std::stop_token& stop);

}  // namespace taut
