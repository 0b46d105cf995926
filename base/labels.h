// SPDX-License-Identifier: GPL-3.0-or-later
// Short texts that a document shows: titles, names of machines and places, numbers of documents.
#pragma once

#include <cstddef>
#include <string_view>

namespace taut {

inline constexpr std::size_t kMostLabelCharacters = 120;
inline constexpr std::size_t kMostDocumentCharacters = 40;

/// For messages: what is_label() and is_document_label() ask for.
inline constexpr const char* kLabelExpected =
    "one line of 1 to 120 characters, none of which is a control character or changes the direction of writing";
inline constexpr const char* kDocumentExpected = "at most 40 letters, digits, blanks and . , : ; / _ + - # ( )";

/// Whether `text` is one line of 1 to kMostLabelCharacters characters of UTF-8, not all of them blanks, that can be
/// shown as it is: without the characters that sanitize() escapes.
[[nodiscard]] bool is_label(std::string_view text);

/// Whether `text` has at most kMostDocumentCharacters characters, all of them ASCII letters, digits, blanks or one of
/// punctuation of `kDocumentExpected`; so it can stand in a style sheet. Empty text is one.
[[nodiscard]] bool is_document_label(std::string_view text);

}  // namespace taut
