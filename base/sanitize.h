// SPDX-License-Identifier: GPL-3.0-or-later
// Text from files and command lines, made safe to print.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace taut {

/// Text that can be printed on one line whatever a file or a command line said: it cannot steer a terminal, hide
/// characters or reverse the direction of writing. Bytes that are not UTF-8, and each byte of control and format
/// characters and of separators of lines and paragraphs (Unicode's categories Cc, Cf, Zl, Zp), become "\xNN".
[[nodiscard]] std::string sanitize(std::string_view text);

/// As much of sanitize(text) as a message should quote: whole characters, some 60 bytes, and "…" where there is more.
[[nodiscard]] std::string excerpt(std::string_view text);

/// sanitize() of each line; line feeds stay.
[[nodiscard]] std::string sanitize_lines(std::string_view text);

/// Size of the longest prefix of `text` that is valid UTF-8 without the character NUL [bytes].
[[nodiscard]] std::size_t valid_utf8_prefix(std::string_view text);

/// How many characters a text in UTF-8 has.
[[nodiscard]] std::size_t characters(std::string_view text);

}  // namespace taut
