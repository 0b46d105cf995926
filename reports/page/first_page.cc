// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/first_page.h"

#include <algorithm>
#include <cmath>

#include "certify/severity.h"
#include "reports/page/body_shapes.h"
#include "reports/page/cable_plot.h"
#include "reports/page/machine_picture.h"
#include "reports/summary/around_items.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/broken_limits.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"
#include "reports/summary/worst_place.h"

namespace taut {

namespace {

/// The text, or a line to write on if it is empty.
Html or_blank(const std::string& text) {
  return text.empty() ? html("<span class=\"blank\"></span>") : html("<bdi>{}</bdi>", text);
}

/// Which pairs of bodies are checked and which are not, and the bodies' names.
Html bodies_words(const BodiesText& bodies) {
  constexpr std::size_t kMostNames = 6;
  const BodiesStatement statement = bodies_statement(bodies);
  Html text = html("{}", with_minus_signs(statement.checked));
  const auto list = [&](const char* where, const std::vector<BodyText>& all) {
    if (!all.empty()) text += html(" {}: <bdi>{}</bdi>.", where, body_names(all, kMostNames));
  };
  if (!statement.contacts.empty()) text += html(" <b>{}</b>", with_minus_signs(statement.contacts));
  list("On the platform", bodies.platform);
  list("Obstacles", bodies.obstacles);
  for (const std::string& words : {statement.cables, statement.exit_cones}) {
    if (!words.empty()) text += html(" {}", with_minus_signs(words));
  }
  const std::vector<std::string> open = bodies_without_inside(bodies);
  if (!open.empty()) {
    text += html(" <b>Only the surface is checked, not what is inside, of <bdi>{}</bdi>: not a closed mesh.</b>",
                 fmt::format("{}", fmt::join(open, ", ")));
  }
  return text + html(" <a class=\"more\" href=\"#robot\">each body</a>");
}

/// What the verdict is about, before the verdict.
Html scope(const ReportContext& scene, const Summary& s) {
  Html rows;
  const auto row = [&](const char* title, const Html& text) {
    rows += html("<div><dt>{}</dt><dd>{}</dd></div>\n", title, text);
  };
  for (const auto& [what, text] : {std::pair("Machine", s.machine), std::pair("Site", s.site)}) {
    if (!text.empty()) row(what, html("<bdi>{}</bdi>", text));
  }
  row("Move", html("{}", with_minus_signs(s.move)));
  if (const std::string file = audited_file(scene); !file.empty()) {
    const std::string table = table_text(scene);
    const Html is_compared =
        scene.certificate.path.timing ? Html() : html("; <code>taut-check --path</code> compares it");
    row("Path file", html("<bdi>{}</bdi>, SHA-256 <span class=\"digest\">{}</span>{}", file,
                          scene.certificate.source->sha256, is_compared));
    if (!table.empty()) row("Rows", html("<bdi>{}</bdi>", table));
  }
  row("Load", load_words(s.load_name, s.load));
  for (const Statement& statement : s.statements) {
    const std::string_view key = statement.key;
    if (key == "limits" || key == "tolerances") row(statement.title, html("{}", with_minus_signs(statement.text)));
    if (key == "clearance") row("Bodies", bodies_words(*scene.certificate.problem.bodies));
  }
  return html("<dl class=\"scope\">\n{}</dl>\n", rows);
}

// ---- The verdict.

/// Which collisions the verdict is about.
Html collisions(const ReportContext& scene) {
  const std::optional<BodiesText>& bodies = scene.certificate.problem.bodies;
  const std::size_t cones = bodies ? bodies->exit_cones.size() : 0;
  const Html of_cones = cones == 0 ? Html() : html("; {} of cables", plural(cones, "exit cone"));
  if (!bodies || pairs(*bodies).size() == cones) return html("Collisions: <b>not checked</b>") + of_cones;
  const std::string count = plural(pairs(*bodies).size() - cones, "pair");
  const Html checked = scene.verdict == "proved" ? html("Collisions: {} of bodies <b>✓</b>", count)
                                                 : html("Collisions: {} of bodies looked at", count);
  std::string others;
  for (const PairClass kind : unchecked_classes(*bodies))
    others += (others.empty() ? "" : ", ") + std::string(words_of(kind));
  return (others.empty() ? checked : checked + html("; <b>not checked</b>: {}", others)) + of_cones;
}

/// What stands beside the verdict: the second program, the machine, collisions.
Html checks(const ReportContext& scene) {
  const bool is_confirmed = scene.recheck.result == Recheck::Result::kConfirmed;
  const Html recheck = is_confirmed ? html("Re-checked by a second program <b>✓</b>")
                       : scene.recheck.result == Recheck::Result::kNoClaim ? html("There is no claim to re-check")
                                                                           : html("<b>Not re-checked</b>");
  const Html machine = scene.certificate.problem.tolerances ? html("Machine within the stated tolerances")
                                                            : html("Machine exactly as typed: <b>no tolerances</b>");
  return html("<ul class=\"checks\"><li>{}</li><li>{}</li><li>{}</li></ul>", recheck, machine, collisions(scene));
}

Html band(const ReportContext& scene, const Summary& s) {
  return html("<div class=\"band {}\"><p class=\"word\">{}{}</p><p class=\"headline\">{}</p>{}</div>\n", s.verdict,
              verdict_icon(s.verdict), s.word, with_minus_signs(s.headline), checks(scene));
}

Html tiles(const Summary& s) {
  if (s.key_numbers.empty()) return {};
  Html result;
  Html rates;
  for (const KeyNumber& n : s.key_numbers) {
    if (n.is_of_rate) {  // there may be seven of them
      rates += html("<li><b>{}</b>: <span class=\"{}\">{}</span> ({})</li>", n.title, name(n.nearness),
                    with_minus_signs(n.value), with_minus_signs(n.detail));
      continue;
    }
    result += html("<div class=\"tile {}\"><dt>{}</dt><dd class=\"value\">{}</dd><dd class=\"detail\">{}</dd></div>\n",
                   name(n.nearness), n.title, with_minus_signs(n.value), with_minus_signs(n.detail));
  }
  return html("<dl class=\"tiles\">\n{}</dl>\n", result) +
         (rates.empty() ? Html() : html("<ul class=\"rates\">{}</ul>\n", rates));
}

// ---- The cables.

/// The range between its slack limit and its top limit, drawn.
Html bar(const Use& use, Nearness nearness) {
  constexpr double kWidth = 100;
  const double width = use.upper_limit - use.lower_limit;
  const auto at = [&](double x) { return std::clamp(kWidth * (x - use.lower_limit) / width, 0.0, kWidth); };
  constexpr double kThinnest = 1.2;
  const double from = std::min(at(use.range.lower), kWidth - kThinnest);
  const double to = std::max(at(use.range.upper), from + kThinnest);
  return html(
      "<svg class=\"use {}\" viewBox=\"-1 0 102 10\" preserveAspectRatio=\"none\" aria-hidden=\"true\">"
      "<path class=\"rail\" d=\"M0 5H100\"/><rect x=\"{:.2f}\" y=\"1.5\" width=\"{:.2f}\" height=\"7\"/>"
      "<path class=\"limit\" d=\"M0 0V10M100 0V10\"/></svg>",
      name(nearness), from, to - from);
}

/// "between slack limit 0.05 and top limit 0.5 N", or of each cable its own.
Html bar_head(const ReportContext& scene) {
  const RobotText& robot = scene.certificate.problem.robot;
  const DisplayUnit& force = scene.illustration.units.force;
  const bool is_one = std::ranges::all_of(robot.tension_N, [&](const Limits& l) { return l == robot.tension_N[0]; });
  if (!is_one) return html("between its slack limit and its top limit");
  return html("between slack limit {} and top limit {} {}", force.exact(robot.tension_N[0].lower),
              force.exact(robot.tension_N[0].upper), force.name());
}

Html cables(const ReportContext& scene, const Summary& s) {
  if (s.cables.empty()) return {};
  Html rows;
  for (const CableLine& c : s.cables) {
    rows += html(
        "<tr><th scope=\"row\" class=\"n\">{}</th><td class=\"n\">{} – {}</td><td>{}</td><td class=\"n {}\">{}</td>"
        "<td class=\"n {}\">{}</td><td class=\"n {}\">{}</td></tr>\n",
        c.cable + 1, with_minus_signs(c.from), with_minus_signs(c.to),
        bar(s.use.tension[c.cable], worse(c.slack, c.top)), name(c.slack), c.above_slack, name(c.top), c.of_top,
        name(c.length), c.length_left);
  }
  return html(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table of the cables\"><table "
      "class=\"cables\"><caption>{}</caption>\n<thead><tr><th scope=\"col\" class=\"n\">Cable</th><th scope=\"col\" "
      "class=\"n\">Tension [{}]</th><th scope=\"col\">{}</th><th scope=\"col\" class=\"n\">above slack</th><th "
      "scope=\"col\" class=\"n\">of top limit</th><th scope=\"col\" class=\"n\">length left</th></tr></thead>\n"
      "<tbody>{}</tbody></table></div>\n",
      use_caption(scene, s.use.source), scene.illustration.units.force.name(), bar_head(scene), rows);
}

/// "every tension stays at least 0.0138 kN and every length at least 9.76 m inside its limits".
std::string confirmed_text(const ReportContext& scene) {
  const DisplayUnits& units = scene.illustration.units;
  const Margins& margins = *scene.certificate.margins;
  const bool in_time = is_move(scene.certificate);
  return fmt::format(
      "every tension stays at least {} {} and every length at least {} {} inside its limits, {}{}{}",
      units.force.exact(truncated(margins.tension_N)), units.force.name(),
      units.length.exact(truncated(margins.length_m)), units.length.name(), margins.clearance_m ? "" : "and ",
      in_time ? "all stated limits of speed, acceleration and power are kept"
              : "the set of loads could grow by the factor above",
      margins.clearance_m ? fmt::format(", and every checked pair of bodies is at least {} {} farther apart than its "
                                        "clearance{}",
                                        units.length.exact(truncated(*margins.clearance_m)), units.length.name(),
                                        scene.certificate.problem.bodies->contacts.empty()
                                            ? ""
                                            : " or, where it may touch, than minus the depth allowed")
                          : "");
}

/// What the colours mean, and what the numbers rest on.
Html cables_note(const ReportContext& scene, const Summary& s) {
  if (s.cables.empty()) return {};
  std::string basis = "At sampled poses, in floating point: between samples they may be exceeded.";
  if (s.use.source != CableUse::Source::kSamples) {
    basis = "This program proved these bounds; they are rounded outward.";
    if (scene.certificate.margins) basis += fmt::format(" taut-check confirmed: {}.", confirmed_text(scene));
  }
  return html(
      "<p class=\"note\">Worst first. Amber from 75 % of a limit of tension (less than +33.3 % above slack), or with "
      "less than 5 % of the range of lengths left; vermilion from 95 %, or with less than 2 %. {}</p>\n",
      basis);
}

// ---- What is broken.

Html what(const ReportContext& scene, const BrokenLimit& broken) {
  const std::string text = what_text(broken);
  return html("<b><bdi>{}</bdi></b>{}{}", subject_text(scene, broken), text.empty() ? "" : " ", text);
}

/// All that are proved, and of the sampled ones as many as fill the table; then how many there are besides.
Html broken_table(const ReportContext& scene, const std::vector<BrokenLimit>& all) {
  constexpr std::size_t kMostRows = 5;
  const auto proved = static_cast<std::size_t>(std::ranges::count_if(all, &BrokenLimit::is_proved));
  const std::size_t shown = std::min(all.size(), std::max(kMostRows, proved));
  Html rows;
  for (std::size_t k = 0; k < shown; ++k) {
    const BrokenLimit& broken = all[k];
    const bool is_plain = broken.is_proved() && broken.is_reached;
    rows += html("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", what(scene, broken),
                 with_minus_signs(amount_text(scene, broken)), where_text(scene, broken),
                 is_plain ? html("<b>{}</b>", known_by(broken)) : html("{}", known_by(broken)));
  }
  const std::string file = audited_file(scene);
  const char* const others = std::ranges::all_of(all, &BrokenLimit::is_reached)
                                 ? ""
                                 : "; then those that are broken at poses which it may not reach";
  const Html more = shown == all.size() ? Html()
                                        : html("<p class=\"note\">Samples show {} besides.</p>\n",
                                               plural(all.size() - shown, "broken limit"));
  return html(
             "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Limits that are broken\"><table "
             "class=\"broken\"><caption>Limits that this move breaks, the gravest first{}{}</caption>\n<thead><tr><th "
             "scope=\"col\">What</th><th scope=\"col\">How far</th><th scope=\"col\">Where it is worst</th><th "
             "scope=\"col\">Known by</th></tr></thead>\n<tbody>{}</tbody></table></div>\n",
             others,
             file.empty() ? Html()
                          : html("; lines are those of <bdi>{}</bdi>, as the certificate says, not checked", file),
             rows) +
         more;
}

/// The cable whose limit is broken most, or next to a singular pose the one whose tension swings most.
CablePlot gravest_plot(const std::vector<BrokenLimit>& all) {
  const BrokenLimit& gravest = all.front();
  CablePlot plot{0, false, gravest.position, gravest.proof && gravest.proof->deviation};
  // Of a winch that is too fast, its cable.
  if (gravest.rate && is_of_winch(gravest.rate->kind)) plot.cable = static_cast<std::size_t>(gravest.rate->cable);
  if (gravest.rate) return plot;
  const auto named = std::ranges::find_if(all, &BrokenLimit::is_of_cable);
  if (named != all.end()) {
    plot.cable = static_cast<std::size_t>(named->margin.cable);
    plot.is_length = is_length(named->margin);
  }
  return plot;
}

Html broken(const ReportContext& scene) {
  const std::vector<BrokenLimit> all = broken_limits(scene);
  if (all.empty()) return {};
  const Html plot = all.front().bodies                                         ? distance_plot(scene, all.front())
                    : all.front().rate && !is_of_winch(all.front().rate->kind) ? Html()
                                                                               : cable_plot(scene, gravest_plot(all));
  return broken_table(scene, all) + plot;
}

// ---- What has to be confirmed elsewhere, and the declaration.

Html not_covered(const Summary& s) {
  Html items;
  for (const ScopeItem& item : s.not_covered) items += html("<li>{}</li>", item.brief);
  std::string assumed;
  for (const ScopeItem& item : s.assumed) assumed += (assumed.empty() ? "" : "; ") + item.brief;
  const bool is_proved = s.verdict == "proved";
  const Html assumes = is_proved ? html("<p><b>It assumes</b> {}.</p>", assumed) : Html();
  return html(
      "<div class=\"uncovered\"><p><b>{}</b> <a class=\"more\" href=\"#assumptions\">in "
      "full</a></p><ul>{}</ul>{}</div>\n",
      is_proved ? "This proof does not cover — confirm elsewhere:" : "This report says nothing about:", items, assumes);
}

/// "the certificate file (SHA-256 39aa…)": in full, as sha256sum prints it.
Html certificate_name(const Summary& s) {
  const bool has_file = !s.recheck.sha256.empty();
  return html("{} with SHA-256 <span class=\"digest\">{}</span>", has_file ? "certificate file" : "certificate content",
              has_file ? s.recheck.sha256 : s.footer_sha256);
}

Html declaration(const ReportContext& scene, const Summary& s) {
  Html text;
  const char* last = "Acknowledged by";
  if (s.verdict == "proved") {
    last = "Lift supervisor";
    text = html(
        "<b>By signing</b> I confirm that machine, load, limits{} above and under "
        "<a href=\"#robot\">Machine and load</a> are those of the machine that is used, that {}, that what the proof "
        "does not cover is covered by document "
        "<span class=\"blank\"></span>, and that taut-check accepted the {}.",
        scene.certificate.problem.bodies ? ", tolerances and bodies" : " and tolerances",
        !is_move(scene.certificate) ? "it moves slowly and its controller follows this path"
        : scene.certificate.problem.time->rows
            ? "its drives follow this move in time or run lengths straight between the rows of its table"
            : "its drives follow this move in time",
        certificate_name(s));
  } else if (s.verdict == "refuted") {
    text = html(
        "<b>By signing</b> I acknowledge that this move breaks the limits stated above and must not be run as it is "
        "({}).",
        certificate_name(s));
  } else {
    text = html(
        "<b>By signing</b> I acknowledge that nothing is proved about this move, and that this report does not release "
        "it ({}).",
        certificate_name(s));
  }
  Html boxes;
  for (const auto& [role, by] :
       {std::pair("Prepared", s.prepared_by), std::pair("Checked", std::string()), std::pair(last, std::string())}) {
    boxes += html("<div><span>{}</span><b><bdi>{}</bdi></b><small>name, date, signature</small></div>", role, by);
  }
  return html("<p class=\"declaration\">{}</p>\n<div class=\"signatures\">{}</div>\n", text, boxes);
}

Html details(const Summary& s) {
  Html result;
  for (const std::string& sentence : s.details) result += html("<p>{}</p>\n", with_minus_signs(sentence));
  return result.empty() ? result : html("<div class=\"details\">{}</div>\n", result);
}

// ---- The machine.

/// Where the machine is drawn, and why there.
struct Place {
  double position = 0;
  std::string why;
};

Place place_of_picture(const ReportContext& scene, const Summary& s) {
  if (scene.verdict == "refuted") {
    const std::vector<BrokenLimit> all = broken_limits(scene);
    if (!all.empty()) return {all.front().position, "Where it breaks its limits"};
  }
  if (const auto& open = scene.certificate.undecided; open && open->segment) {
    return {*open->segment + (open->box ? open->box->first.approx() : 0.0), "Where it is open"};
  }
  if (const auto worst = worst_place(scene, s.use)) return {*worst, "Worst place"};
  return {0, "The machine"};
}

/// As near to its limits as a cable is at this pose, and where its own worst place is this one, as the table says.
std::array<Nearness, kCables> nearness_there(const ReportContext& scene, const Summary& s, double position) {
  constexpr double kThere = 1e-6;  // of a segment
  const PathSample sample = scene.sampler.at(scene.certificate.path, position);
  std::array<Nearness, kCables> nearness = nearness_at(scene.sampler.model(), sample.statics);
  for (const BrokenLimit& broken : broken_limits(scene)) {  // perhaps of another machine within the tolerances
    if (broken.is_proved() && broken.is_of_cable() && std::abs(broken.position - position) < kThere) {
      nearness[static_cast<std::size_t>(broken.margin.cable)] = Nearness::kOut;
    }
  }
  for (const CableLine& line : s.cables) {
    const Use& use = s.use.tension[line.cable];
    Nearness& cable = nearness[line.cable];
    if (std::abs(use.least_at - position) < kThere) cable = worse(cable, line.slack);
    if (std::abs(use.greatest_at - position) < kThere) cable = worse(cable, line.top);
  }
  return nearness;
}

Html picture(const ReportContext& scene, const Summary& s) {
  if (scene.certificate.path.waypoints.empty()) return {};
  const auto [position, why] = place_of_picture(scene, s);
  return machine_picture(scene, position, nearness_there(scene, s, position),
                         fmt::format("{}: {}", why, place_text(scene, position)),
                         bodies_note(scene) + shown_bodies_note(scene));
}

}  // namespace

Html masthead(const std::string& document, const std::string& revision, const std::string& date) {
  return html(
      "<div class=\"masthead\"><p>Motion proof report for a cable-driven hexapod · appendix to a lift plan</p>\n<dl>"
      "<div><dt>Document</dt><dd>{}</dd></div><div><dt>Rev</dt><dd>{}</dd></div><div><dt>Date</dt><dd>{}</dd></div>"
      "</dl></div>\n",
      or_blank(document), or_blank(revision), or_blank(date));
}

Html title_note() {
  return html("<p class=\"note unverified\">Title and names are text of the case, which nothing checks.</p>\n");
}

Html load_words(const std::string& load_name, const LoadStatement& load) {
  Html text = load_name.empty() ? Html() : html("<bdi>{}</bdi>. ", load_name);
  text += html("{}", with_minus_signs(load.total));
  if (load.items.empty()) text += html(" {}", with_minus_signs(load.spread));
  if (!load.inertia.empty()) text += html(" <bdi>{}</bdi>", load.inertia);
  for (const auto& [name, words] : load.items) {
    text += html(" <bdi>{}</bdi>: {}.", quoted_name(name), with_minus_signs(words));
  }
  if (!load.around_items) return text;
  text += html("<br><span class=\"note\">{}", kItemsNotChecked);
  for (const auto& [name, words] : load.around_items->items) {
    text += html(" <bdi>{}</bdi>: {}.", quoted_name(name), with_minus_signs(words));
  }
  return text + html("</span>");
}

Html verdict_icon(const std::string& verdict) {
  const char* const path = verdict == "proved"    ? "M4 13l5.5 5.5L20 6.5"
                           : verdict == "refuted" ? "M5 5l14 14M19 5L5 19"
                                                  : "M12 4v10M12 18.5v1";
  return html("<svg class=\"icon\" viewBox=\"0 0 24 24\" aria-hidden=\"true\"><path d=\"{}\"/></svg>", path);
}

Html first_page(const ReportContext& scene, const Summary& s) {
  const Html title = html("<h1><bdi>{}</bdi></h1>\n", s.title) + title_note();
  const bool is_proved = s.verdict == "proved";
  const Html beside = is_proved ? cables(scene, s) + cables_note(scene, s) : broken(scene) + details(s);
  return html("<header class=\"first {}\">\n{}{}{}{}{}<div class=\"duo\">{}<div>{}</div></div>\n{}{}</header>\n",
              s.verdict, masthead(s.document, s.revision, s.date), title, scope(scene, s), band(scene, s), tiles(s),
              picture(scene, s), beside, not_covered(s), declaration(scene, s));
}

Html verdict_section(const Summary& s) {
  Html rows;
  for (const Statement& statement : s.statements) {
    const std::string_view key = statement.key;
    if (key != "motion" && key != "proof" && key != "recheck") continue;
    rows += html("<div><dt>{}</dt><dd>{}</dd></div>\n", statement.title, with_minus_signs(statement.text));
  }
  return section("verdict", "The verdict in full", html("<dl class=\"facts\">\n{}</dl>\n", rows));
}

Html cables_section(const ReportContext& scene, const Summary& s) {
  if (s.verdict == "proved" || s.cables.empty()) return {};
  return section("cables", "The cables", cables(scene, s) + cables_note(scene, s));
}

}  // namespace taut
