// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "base/sanitize.h"
#include "problem/units.h"

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

/// "0.5", "(-4", "−1e-3)": what a unit may stand behind.
bool is_number(std::string_view word) {
  for (const std::string_view sign : {"(", "±", "+", "-", "−"}) {
    if (word.starts_with(sign)) word.remove_prefix(sign.size());
  }
  while (!word.empty() && word.back() == ')') word.remove_suffix(1);
  return !word.empty() && std::isdigit(static_cast<unsigned char>(word.front())) != 0 &&
         std::isdigit(static_cast<unsigned char>(word.back())) != 0;
}

/// "N", "kN·m,", "%.": with what punctuation may follow.
bool is_unit(std::string_view word) {
  const std::size_t last = word.find_last_not_of(".,:;)");
  std::string name(word.substr(0, last == std::string_view::npos ? 0 : last + 1));
  constexpr std::string_view kProduct = "·";
  if (const std::size_t product = name.find(kProduct); product != std::string::npos) {
    name.replace(product, kProduct.size(), "*");
  }
  return name == "%" || find_unit(name).has_value();
}

/// Where the word that begins at `begin` ends, a number's unit included.
std::size_t end_of_word(std::string_view line, std::size_t begin) {
  const std::size_t end = std::min(line.find(' ', begin), line.size());
  if (end == line.size() || !is_number(line.substr(begin, end - begin))) return end;
  const std::size_t next = std::min(line.find(' ', end + 1), line.size());
  return is_unit(line.substr(end + 1, next - end - 1)) ? next : end;
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
    const std::size_t end = end_of_word(line, begin);
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
