// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "base/sanitize.h"

namespace taut {
namespace {

constexpr std::size_t kUsualColumns = 80;
constexpr std::size_t kLeastColumns = 20;  // a narrower terminal is not worth wrapping for

/// The columns of the terminal at standard output.
std::size_t terminal_columns() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* const stated = std::getenv("COLUMNS");
  if (stated == nullptr) return kUsualColumns;
  std::size_t columns = 0;
  const std::string_view text = stated;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), columns);
  return error == std::errc() && end == text.data() + text.size() && columns > 0 ? columns : kUsualColumns;
}

/// One line, without its line feed, broken between words.
std::string wrapped_line(std::string_view line, std::size_t columns, std::size_t indent) {
  const std::size_t margin = std::min(line.find_first_not_of(' '), line.size());
  const std::string continued(std::min(margin + indent, columns / 2), ' ');
  std::string result(line.substr(0, margin));
  std::size_t used = margin;
  bool is_first = true;
  for (std::size_t at = margin; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(' ', at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    const std::size_t gap = begin - at;  // blanks that align columns stay within a line
    const std::size_t width = characters(word);
    if (is_first || used + gap + width <= columns) {
      result += std::string(gap, ' ');
      used += gap;
    } else {
      result += "\n" + continued;
      used = continued.size();
    }
    result += word;
    used += width;
    is_first = false;
    at = end;
  }
  return result;
}

}  // namespace

Terminal standard_output() {
  if (::isatty(STDOUT_FILENO) != 1) return {};
  const char* const no_colour = std::getenv("NO_COLOR");
  const char* const kind = std::getenv("TERM");
  const bool is_plain =
      (no_colour != nullptr && *no_colour != '\0') || kind == nullptr || std::string_view(kind) == "dumb";
  return {std::max(terminal_columns(), kLeastColumns), !is_plain};
}

std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent) {
  if (columns == 0) return std::string(text);
  std::string result;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find('\n', at);
    result += wrapped_line(text.substr(at, end - at), columns, indent);
    if (end == std::string_view::npos) return result;
    result += '\n';
    at = end + 1;
  }
}

std::string coloured(const std::string& text, Colour colour, const Terminal& terminal) {
  if (!terminal.has_colour || text.empty()) return text;
  const int number = colour == Colour::kGreen ? 32 : colour == Colour::kYellow ? 33 : 31;
  return fmt::format("\033[1;{}m{}\033[0m", number, text);
}

void print_wrapped(std::string_view text, std::size_t indent) {
  fmt::print("{}\n", wrapped(text, standard_output().columns, indent));
}

}  // namespace taut
