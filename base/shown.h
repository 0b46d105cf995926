// How messages show what a file says: short, and without anything that would steer a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace taut {

/// Length of the UTF-8 character (Unicode 15, table 3-7) other than NUL that the text begins with; 0 if there is none.
[[nodiscard]] std::size_t utf8_character_length(std::string_view text);

/// Bytes that are no UTF-8 as "\\xNN".
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// As much of the text as a message should show: whole characters.
[[nodiscard]] std::string shorten(const std::string& text);

/// Control characters as "\\xNN", each of their bytes; those of Unicode that change the direction of writing or end a line, too.
[[nodiscard]] std::string without_control_characters(const std::string& text);

/// Both, and bytes that are no UTF-8 as "\\xNN" too: fit to be quoted, whatever it was.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace taut
