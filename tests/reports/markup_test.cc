// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/markup.h"

#include <gtest/gtest.h>

namespace taut {
namespace {

TEST(Markup, EscapesTextArguments) {
  EXPECT_EQ(html("<b>{}</b>", std::string("<i> & \"x\" 'y'")).str(),
            "<b>&lt;i&gt; &amp; &quot;x&quot; &#39;y&#39;</b>");
  EXPECT_EQ(html("<b>{}</b>", "a < b").str(), "<b>a &lt; b</b>");
}

TEST(Markup, KeepsMarkupAndFormatsNumbers) {
  EXPECT_EQ(html("<p>{}: {:.2f}, {}</p>", html("<b>x</b>"), 0.125, 3).str(), "<p><b>x</b>: 0.12, 3</p>");
}

TEST(Markup, DoesNotReadBracesOfAnArgumentAsATemplate) { EXPECT_EQ(html("{}", "{} {0}").str(), "{} {0}"); }

TEST(Markup, ReplacesControlCharactersThatHtmlForbids) {
  EXPECT_EQ(escape(std::string("a\0b\x1b", 4)), "a\uFFFDb\uFFFD");
  EXPECT_EQ(escape("tab\tline\n"), "tab\tline\n");
}

TEST(Markup, MakesTablesWithOneCellAColumn) {
  EXPECT_EQ(table(html("A<sub>1</sub>"), {{html("k")}, {html("v"), true}}, {{html("a"), html("1")}}).str(),
            "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"A1\"><table><caption>A<sub>1</sub>"
            "</caption><thead><tr><th scope=\"col\">k</th><th scope=\"col\" class=\"n\">v</th></tr>"
            "</thead>\n<tbody><tr><td>a</td><td class=\"n\">1</td></tr>\n</tbody></table></div>\n");
}

TEST(Markup, GivesItsWordsForAnAttribute) {
  EXPECT_EQ(without_tags(html("<i class=\"{}\">a</i> {}", "x>y", "<\"b\">")).str(), "a &lt;&quot;b&quot;&gt;");
}

}  // namespace
}  // namespace taut
