// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sanitize.h"

#include <gtest/gtest.h>

#include <string>

namespace taut {
namespace {

TEST(Sanitize, KeepsTextThatCanBePrinted) {
  for (const std::string text : {"", "plain", "Größe µ ≤ 漢字 🚀", "\xEF\xBF\xBD", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_EQ(sanitize(text), text);
  }
}

TEST(Sanitize, EscapesWhatSteersATerminal) {
  EXPECT_EQ(sanitize("a\x1b[31m\tb\r\n"), "a\\x1b[31m\\x09b\\x0d\\x0a");
  EXPECT_EQ(sanitize(std::string("\0\x7F", 2)), "\\x00\\x7f");
  EXPECT_EQ(sanitize("\u009B31m"), "\\xc2\\x9b31m") << "C1";
}

TEST(Sanitize, EscapesWhatHidesOrReverses) {
  for (const std::string text : {"\u00AD", "\u061C", "\u180E", "\u200B", "\u200E", "\u2028", "\u2029", "\u202E",
                                 "\u2060", "\u2066", "\u2069", "\uFEFF", "\uFFF9", "\U0001D173", "\U000E0041"}) {
    const std::string result = sanitize("x" + text + "y");
    EXPECT_EQ(result.size(), 2 + 4 * text.size()) << result;
    EXPECT_TRUE(result.starts_with("x\\x")) << result;
  }
}

TEST(Sanitize, EscapesBytesThatAreNoCharacters) {
  EXPECT_EQ(sanitize("a\x9b\xff"
                     "b"),
            "a\\x9b\\xffb");
  EXPECT_EQ(sanitize("\xE2\x80"), "\\xe2\\x80") << "cut";
  EXPECT_EQ(sanitize("\xC0\xAF"), "\\xc0\\xaf") << "longer than it has to be";
  EXPECT_EQ(sanitize("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(sanitize("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(Sanitize, IsItsOwnResult) {
  for (int byte = 0; byte < 256; ++byte) {
    const std::string once = sanitize(std::string(2, static_cast<char>(byte)) + "é");
    EXPECT_EQ(sanitize(once), once);
  }
}

TEST(SanitizeLines, KeepsLineFeedsOnly) { EXPECT_EQ(sanitize_lines("a\x1b\nb\r\n\n"), "a\\x1b\nb\\x0d\n\n"); }

TEST(Excerpt, EndsBetweenCharacters) {
  EXPECT_EQ(excerpt(std::string(60, 'x')), std::string(60, 'x'));
  EXPECT_EQ(excerpt(std::string(61, 'x')), std::string(60, 'x') + "…");
  EXPECT_EQ(excerpt(std::string(59, 'x') + "é"), std::string(59, 'x') + "…");
  EXPECT_EQ(excerpt(std::string(58, 'x') + "\x1b"), std::string(58, 'x') + "…") << "an escape stays whole";
}

TEST(ValidUtf8Prefix, EndsAtTheFirstWrongByte) {
  EXPECT_EQ(valid_utf8_prefix("é\n"), 3U);
  EXPECT_EQ(valid_utf8_prefix("é\xC3"), 2U);
  EXPECT_EQ(valid_utf8_prefix(std::string("a\0b", 3)), 1U);
}

}  // namespace
}  // namespace taut
