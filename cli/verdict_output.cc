// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/verdict_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/sanitize.h"
#include "cli/terminal.h"

namespace taut {
namespace {

/// Green for what is proved, red for what must not be run, else yellow.
Colour colour_of(std::string_view word) {
  if (word.starts_with("PROVED")) return Colour::kGreen;
  return word.starts_with("REFUTED") ? Colour::kRed : Colour::kYellow;
}

/// The text wrapped, its first `size` bytes, which are not broken, in colour.
void print_with_coloured_beginning(const std::string& text, std::size_t size, Colour colour) {
  const Terminal terminal = standard_output();
  const std::string shown = wrapped(text, terminal.columns);
  // Wrapping keeps a beginning that fits on the first line as it is.
  const bool is_whole = shown.compare(0, size, text, 0, size) == 0;
  fmt::print("{}{}\n", is_whole ? coloured(shown.substr(0, size), colour, terminal) : "",
             is_whole ? shown.substr(size) : shown);
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, characters(text)), ' ');
}

}  // namespace

void print_verdict(const std::string& word, const std::string& sentence) {
  print_with_coloured_beginning(fmt::format("{}: {}", word, sanitize_lines(sentence)), word.size(), colour_of(word));
}

void print_key_numbers(const std::vector<KeyNumber>& numbers) {
  const Terminal terminal = standard_output();
  std::size_t titles = 0, values = 0;
  for (const KeyNumber& n : numbers) {
    titles = std::max(titles, characters(n.title));
    values = std::max(values, characters(n.value));
  }
  for (const KeyNumber& n : numbers) {
    std::string line = wrapped(fmt::format("  {}  {}  {}", padded(n.title, titles), padded(n.value, values), n.detail),
                               terminal.columns, titles + 2);
    const std::size_t value = line.find(n.value);
    const bool is_close = n.nearness == Nearness::kClose || n.nearness == Nearness::kOut;
    if (value != std::string::npos && n.nearness != Nearness::kCalm) {
      line.replace(value, n.value.size(), coloured(n.value, is_close ? Colour::kRed : Colour::kYellow, terminal));
    }
    fmt::print("{}\n", line);
  }
}

void print_text_report(const std::string& text) {
  const std::string lines = text.ends_with('\n') ? text.substr(0, text.size() - 1) : text;
  const std::size_t word = std::min(lines.find(':'), lines.size());
  print_with_coloured_beginning(lines, word, colour_of(lines.substr(0, word)));
}

}  // namespace taut
