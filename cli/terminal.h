// SPDX-License-Identifier: GPL-3.0-or-later
// Text for people on standard output: wrapped and coloured on a terminal, and neither in a file or a pipe, so that
// programs find each sentence whole on one line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace taut {

/// What standard output can show.
struct Terminal {
  std::size_t columns = 0;  ///< of a line; 0: lines are not wrapped
  bool has_colour = false;
};

/// On a terminal its columns (of COLUMNS, or 80, where it does not know), and colour unless NO_COLOR is set to anything
/// or TERM is "dumb". Elsewhere neither.
[[nodiscard]] Terminal standard_output();

/// Breaks lines between words, so that each has at most `columns` characters; longer words have a line of their own. A
/// number and its unit are one word.
/// Continued lines are indented by `indent` more blanks than the line has. With 0 columns the text stays as it is.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent = 2);

enum class Colour { kGreen, kYellow, kRed };
/// The text in bold and in colour, where the terminal has colours.
[[nodiscard]] std::string coloured(const std::string& text, Colour colour, const Terminal& terminal);

/// Prints `text` and a line end, wrapped where standard output is a terminal.
void print_wrapped(std::string_view text, std::size_t indent = 2);

}  // namespace taut
