// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/markup.h"

namespace taut {

std::string escape(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      case '\n':
      case '\t': result += c; break;
      default:
        if (code < 0x20 || code == 0x7f) {
          result += "\uFFFD";
        } else {
          result += c;
        }
    }
  }
  return result;
}

Html without_tags(const Html& markup) {
  Html result;
  bool is_tag = false;
  for (const char c : markup.markup_) {
    if (c == '<') is_tag = true;
    if (!is_tag) result.markup_ += c;
    if (c == '>') is_tag = false;
  }
  return result;
}

Html table(const Html& caption, const std::vector<Column>& columns, const std::vector<std::vector<Html>>& rows) {
  Html head;
  for (const Column& column : columns) {
    head += html("<th scope=\"col\"{}>{}</th>", column.number ? html(" class=\"n\"") : Html(), column.head);
  }
  Html body;
  for (const std::vector<Html>& row : rows) {
    Html cells;
    for (std::size_t i = 0; i < row.size(); ++i) {
      cells += html("<td{}>{}</td>", columns.at(i).number ? html(" class=\"n\"") : Html(), row[i]);
    }
    body += html("<tr>{}</tr>\n", cells);
  }
  return scrollable(caption, html("<table><caption>{}</caption><thead><tr>{}</tr></thead>\n<tbody>{}</tbody></table>",
                                  caption, head, body));
}

Html scrollable(const Html& name, const Html& body) {
  return html("<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">{}</div>\n", without_tags(name),
              body);
}

Html folded(bool long_, const Html& summary, const Html& body) {
  return html("<details{}><summary>{}</summary>\n{}</details>\n", long_ ? Html() : html(" open=\"\""), summary, body);
}

Html section(const char* id, const char* title, const Html& body) {
  return html("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, title, body);
}

}  // namespace taut
