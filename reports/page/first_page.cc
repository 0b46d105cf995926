// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/first_page.h"

#include <algorithm>
#include <cmath>

#include "reports/summary/wording.h"

namespace taut {

namespace {

/// The text, or "________" to write on if it is empty.
Html or_blank(const std::string& text) {
  return text.empty() ? html("<span class=\"blank\"></span>") : html("<bdi>{}</bdi>", text);
}

Html masthead(const Summary& s) {
  return html(
      "<div class=\"masthead\"><p>Motion report for a cable-driven hexapod</p>\n<dl>"
      "<div><dt>Document</dt><dd>{}</dd></div><div><dt>Revision</dt><dd>{}</dd></div><div><dt>Date</dt><dd>{}</dd></"
      "div>"
      "</dl></div>\n",
      or_blank(s.document), or_blank(s.revision), or_blank(s.date));
}

Html verdict(const Summary& s) {
  Html body = html("<p>{}</p>\n", s.headline);
  for (const std::string& sentence : s.details) body += html("<p>{}</p>\n", sentence);
  if (!s.closest.empty()) {
    Html items;
    for (const std::string& sentence : s.closest) items += html("<li>{}</li>\n", sentence);
    body += html("<ul>{}</ul>\n", items);
  }
  return html("<div class=\"verdict {}\">{}</div>\n", s.verdict, body);
}

/// A drawing of the range on a scale from 0 to slightly above the upper limit, with the limits.
Html bar(const Use& use) {
  constexpr double kWidth = 100;
  const double full = 1.06 * use.upper_limit;
  const auto at = [&](double x) { return std::clamp(kWidth * x / full, 0.0, kWidth); };
  const double from = at(use.range.lower);
  const double to = at(use.range.upper);
  const bool is_out = use.range.lower <= use.lower_limit || use.range.upper >= use.upper_limit;
  constexpr double kThinnest = 0.8;
  return html(
      "<svg class=\"use{}\" viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" aria-hidden=\"true\">"
      "<path class=\"rail\" d=\"M0 5H100\"/><rect x=\"{:.2f}\" y=\"2\" width=\"{:.2f}\" height=\"6\"/>"
      "<path class=\"limit\" d=\"M{:.2f} 0V10M{:.2f} 0V10\"/></svg>",
      is_out ? html(" out") : Html(), from, std::max(to - from, kThinnest), at(use.lower_limit), at(use.upper_limit));
}

Html cables(const ReportContext& scene, const CableUse& use) {
  if (use.source == CableUse::Source::kNone) return {};
  const RobotText& robot = scene.certificate.problem.robot;
  const DisplayUnit& force = scene.illustration.units.force;
  const DisplayUnit& length = scene.illustration.units.length;
  Html rows;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Use& t = use.tension[i];
    const Use& d = use.length[i];
    const Limits& f = robot.tension_N[i];
    const Limits& l = robot.length_m[i];
    rows += html(
        "<tr><th scope=\"row\" class=\"n\">{}</th><td class=\"n\">{} – {}</td><td class=\"n\">{} – {}</td><td>{}</td>"
        "<td class=\"n\"><b>{} %</b></td><td class=\"n\">{} – {}</td><td class=\"n\">{} – {}</td><td>{}</td>"
        "<td class=\"n\"><b>{} %</b></td></tr>\n",
        i + 1, force.down(t.range.lower), force.up(t.range.upper), force.exact(f.lower), force.exact(f.upper), bar(t),
        rounded_up(t.used_percent(), 3), length.down(d.range.lower), length.up(d.range.upper), length.exact(l.lower),
        length.exact(l.upper), bar(d), rounded_up(d.used_percent(), 3));
  }
  const bool is_proved = use.source != CableUse::Source::kSamples;
  return html(
      "<div class=\"scroll\"><table class=\"cables\"><caption>{}</caption>\n<thead><tr><th scope=\"col\" "
      "class=\"n\">Cable</th>"
      "<th scope=\"col\" class=\"n\">Tension [{}]</th><th scope=\"col\" class=\"n\">Limits [{}]</th>"
      "<th scope=\"col\"><span class=\"unseen\">Tension between 0 and its limits</span></th><th scope=\"col\" "
      "class=\"n\">of upper limit</th>"
      "<th scope=\"col\" class=\"n\">Length [{}]</th><th scope=\"col\" class=\"n\">Limits [{}]</th>"
      "<th scope=\"col\"><span class=\"unseen\">Length between 0 and its limits</span></th><th scope=\"col\" "
      "class=\"n\">of upper limit</th></tr></thead>\n"
      "<tbody>{}</tbody></table></div>\n<p class=\"note\">{}</p>\n",
      use_caption(use.source), force.name(), force.name(), length.name(), length.name(), rows,
      is_proved
          ? "Least and greatest values, rounded outward. This program computed them anew with interval arithmetic over "
            "the "
            "certificate's boxes; the certificate itself states the reserves only, and the report claims nothing "
            "beyond it."
          : "Least and greatest values at sampled poses, in floating point. Between samples they may be exceeded.");
}

Html facts(const Summary& s) {
  Html rows;
  for (const Statement& statement : s.statements) {
    const std::string_view key = statement.key;
    const Html more = key == "assumptions" || key == "not_covered"
                          ? html(" <a class=\"more\" href=\"#assumptions\">In full</a>")
                          : Html();
    rows += html("<div class=\"{}\"><dt>{}</dt><dd>{}{}</dd></div>\n", statement.key, statement.title, statement.text,
                 more);
  }
  return html("<dl class=\"facts\">\n{}</dl>\n", rows);
}

Html signatures() {
  Html rows;
  for (const char* role : {"Prepared by", "Checked by", "Approved by"}) {
    rows += html("<tr><th scope=\"row\">{}</th><td></td><td></td><td></td></tr>\n", role);
  }
  return html(
      "<table class=\"sign\"><caption class=\"unseen\">Signatures</caption><thead><tr><td></td><th "
      "scope=\"col\">Name</th>"
      "<th scope=\"col\">Date</th><th scope=\"col\">Signature</th></tr></thead>\n<tbody>{}</tbody></table>\n",
      rows);
}

}  // namespace

Html first_page(const ReportContext& scene, const Summary& summary) {
  return html(
      "<header class=\"first\">\n{}<h1><bdi>{}</bdi> <small>(name given in the case, not "
      "checked)</small></h1>\n{}{}{}{}</header>\n",
      masthead(summary), summary.name, verdict(summary), facts(summary), cables(scene, summary.use), signatures());
}

}  // namespace taut
