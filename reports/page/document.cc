// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/document.h"

#include "base/sanitize.h"
#include "reports/page/first_page_style.h"
#include "reports/page/machine_style.h"
#include "reports/page/style.h"
#include "reports/page/typeface.h"

namespace taut {
namespace {

/// The text as a string of a style sheet, which none of its characters can end.
std::string css_string(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain =
        byte >= 0x80 || (byte >= 0x20 && byte != 0x7f && std::string_view("\"\\<>&").find(c) == std::string_view::npos);
    result += is_plain ? std::string(1, c) : fmt::format("\\{:x} ", byte);
  }
  return result + "\"";
}

/// The style sheet's part for head and foot of the printed pages: case, verdict and document; date and page.
std::string running_head(const DocumentHead& head) {
  const std::string revision = head.revision.empty() ? "" : " · revision " + head.revision;
  return fmt::format(
      "@media print {{ @page {{ @top-left {{ content: {}; }} @top-right {{ content: {}; }} "
      "@bottom-left {{ content: {}; }} "
      "@bottom-right {{ content: \"Page \" counter(page) \" of \" counter(pages); }} }} }}\n",
      css_string(excerpt(head.title)), css_string(fmt::format("{} · {}{}", head.word, head.document, revision)),
      css_string(head.date));
}

}  // namespace

std::string html_document(const DocumentHead& head, const std::string& body) {
  // An empty icon keeps browsers from asking a server for one.
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n<link rel=\"icon\" "
      "href=\"data:,\">\n<title>{}</title>\n<style>{}{}{}{}{}{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      head.policy, escape(head.window_title), page_typeface(), kStyle, kFirstPageStyle, kMachineStyle, head.more_style,
      running_head(head), body);
}

}  // namespace taut
