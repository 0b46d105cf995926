// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/explain_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/sanitize.h"
#include "cli/console.h"
#include "reports/summary/explanations.h"

namespace taut {

namespace {

std::string to_text(const Explanation& e) {
  return fmt::format("{}  {}\n\n{}\nUsual causes: {}\nWhat to do: {}\nExample: {}\n", e.code, e.title, e.meaning,
                     e.causes, e.remedy, e.example);
}

/// Breaks a paragraph at blanks into lines of at most 120 characters; lines after the first begin with `indent`.
std::string wrapped(std::string_view paragraph, std::string_view indent) {
  constexpr std::size_t kColumns = 120;
  const auto characters = [](std::string_view text) {  // of UTF-8: all bytes but continuation bytes
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
  };
  std::string text;
  std::size_t column = 0;
  while (!paragraph.empty()) {
    const std::string_view word = paragraph.substr(0, paragraph.find(' '));
    paragraph.remove_prefix(std::min(paragraph.size(), word.size() + 1));
    if (column > 0 && column + 1 + characters(word) > kColumns) {
      text += fmt::format("\n{}", indent);
      column = indent.size();
    } else if (column > 0) {
      text += ' ';
      ++column;
    }
    text += word;
    column += characters(word);
  }
  return text;
}

std::string to_markdown(const std::vector<Explanation>& all) {
  std::string text =
      "# Messages and their codes\n\n" +
      wrapped(
          "Each reason for *undecided* and each error ends with a short code that never changes. `taut explain` "
          "lists the codes, and `taut explain CODE` prints what is written here about one of them. Undecided does "
          "not mean unsafe: neither a proof nor a refutation was found.",
          "") +
      "\n\n*(This page is what `taut explain --markdown` prints.)*\n";
  char family = 0;
  for (const Explanation& e : all) {
    if (e.code[0] != family) {
      family = e.code[0];
      text += family == 'U'   ? "\n## Why something stayed undecided (exit code 2)\n"
              : family == 'E' ? "\n## What is wrong with the input (exit code 3)\n"
                              : "\n## Failures (exit code 4)\n";
    }
    text += fmt::format("\n### {}: {}\n\n{}\n\n", e.code, e.title, wrapped(e.meaning, ""));
    text += wrapped(fmt::format("- **Usual causes:** {}", e.causes), "  ") + "\n";
    text += wrapped(fmt::format("- **What to do:** {}", e.remedy), "  ") + "\n";
    text += wrapped(fmt::format("- **Example:** `{}`", e.example), "  ") + "\n";
  }
  return text;
}

}  // namespace

void add_explain_options(CLI::App& command, ExplainArguments& arguments) {
  command.add_option("CODE", arguments.code, "the code behind a message, such as U3 or E5 (default: list all)");
  command.add_flag("--markdown", arguments.markdown, "print all of them, as docs/errors.md");
}

int run_explain(const ExplainArguments& arguments) {
  if (arguments.markdown) {
    fmt::print("{}", to_markdown(explanations()));
    return kProvedExit;
  }
  if (arguments.code.empty()) {
    for (const Explanation& e : explanations()) fmt::print("{:<4} {}\n", e.code, e.title);
    return kProvedExit;
  }
  std::string wanted = arguments.code;
  if (wanted.starts_with('[') && wanted.ends_with(']')) wanted = wanted.substr(1, wanted.size() - 2);  // as it is shown
  for (char& c : wanted) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto found = std::ranges::find(explanations(), wanted, &Explanation::code);
  if (found == explanations().end()) {
    throw InputError(ErrorCode::kUse, fmt::format("CODE: got '{}', expected one of those that taut explain lists",
                                                  excerpt(arguments.code)));
  }
  fmt::print("{}", to_text(*found));
  return kProvedExit;
}

}  // namespace taut
