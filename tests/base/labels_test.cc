// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/labels.h"

#include <gtest/gtest.h>

#include <string>

namespace taut {
namespace {

TEST(Label, IsALineThatCanBeShownAsItIs) {
  for (const std::string text :
       {"Container to the second bay", "Turn the platform, 174°", "漢字", "a \"b\" <c> & 'd'"}) {
    EXPECT_TRUE(is_label(text)) << text;
  }
  for (const std::string text : {"", "   ", "a\nb", "a\tb", "a\x1b[31m", "\xFF", "\u202Eabc", "a\u200Bb", "\u2066a"}) {
    EXPECT_FALSE(is_label(text)) << text;
  }
}

TEST(Label, IsCountedInCharactersNotBytes) {
  std::string text;
  for (std::size_t i = 0; i < kMostLabelCharacters; ++i) text += "é";
  EXPECT_TRUE(is_label(text));
  EXPECT_FALSE(is_label(text + "e"));
}

TEST(DocumentLabel, HasOnlyCharactersThatAStyleSheetMayQuote) {
  EXPECT_TRUE(is_document_label("LP-17/B, sheet 2: (a)"));
  EXPECT_TRUE(is_document_label(""));
  EXPECT_TRUE(is_document_label(std::string(kMostDocumentCharacters, 'x')));
  EXPECT_FALSE(is_document_label(std::string(kMostDocumentCharacters + 1, 'x')));
  for (const std::string text : {"\"", "\\", "'", "{", "<", "é", "a\nb"}) EXPECT_FALSE(is_document_label(text)) << text;
}

}  // namespace
}  // namespace taut
