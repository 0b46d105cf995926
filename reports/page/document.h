// SPDX-License-Identifier: GPL-3.0-or-later
// The shell of a report's page: its head with the style sheet, and the running head and foot of its printed pages.
#pragma once

#include <string>

#include "reports/page/markup.h"

namespace taut {

struct DocumentHead {
  std::string window_title;  ///< of the browser's window
  std::string title, word;   ///< of the move; the verdict
  std::string document, revision, date;
  std::string policy;      ///< Content-Security-Policy
  std::string more_style;  ///< beyond that of every report
};

/// A complete HTML document, UTF-8. @param body  what is in the body element
[[nodiscard]] std::string html_document(const DocumentHead& head, const std::string& body);

}  // namespace taut
