// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/labels.h"

#include <algorithm>

#include "base/sanitize.h"

namespace taut {

bool is_label(std::string_view text) {
  return text.find_first_not_of(' ') != std::string_view::npos && characters(text) <= kMostLabelCharacters &&
         sanitize(text) == text;
}

bool is_document_label(std::string_view text) {
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view(" .,:;/_+-#()").find(c) != std::string_view::npos;
  };
  return text.size() <= kMostDocumentCharacters && std::ranges::all_of(text, is_plain);
}

}  // namespace taut
