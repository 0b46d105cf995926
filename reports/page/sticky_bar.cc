// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/sticky_bar.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "reports/summary/sentences.h"

namespace taut {

namespace {

const char* sign(const ReportContext& scene) {
  return scene.verdict == "proved" ? "✓" : scene.verdict == "refuted" ? "✕" : "?";
}

}  // namespace

Html sticky_bar(const ReportContext& scene, const std::vector<ContentsLink>& contents) {
  // Those that fit on one line of a desktop's screen; the menu has all.
  constexpr std::array<std::string_view, 5> kQuick = {"move", "tensions", "lengths", "plane", "theorem"};
  Html quick;
  Html all;
  for (const ContentsLink& entry : contents) {
    const Html link = html("<a href=\"#{}\">{}</a> ", entry.id, entry.title);
    all += link;
    if (std::ranges::find(kQuick, std::string_view(entry.id)) != kQuick.end()) quick += link;
  }
  return html(
      "<header class=\"bar\"><a class=\"state {}\" href=\"#top\">{} {}</a>\n<div data-plot=\"bar\"></div>\n"
      "<nav aria-label=\"Contents\"><span class=\"quick\">{}</span><details><summary>☰ <span class=\"word\">Contents"
      "</span></summary><div>{}</div></details></nav></header>\n",
      scene.verdict, sign(scene), verdict_word(scene), quick, all);
}

}  // namespace taut
