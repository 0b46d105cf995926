// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/plot_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/page/page_script.h"
#include "reports/page/plane.h"
#include "reports/page/report_data.h"
#include "reports/page/robot_drawing.h"
#include "reports/page/still_picture.h"
#include "reports/summary/angles.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

/// The place where the script draws a plot.
Html place(const char* name) { return html("<div data-plot=\"{}\"></div>\n", name); }

/// The text shown if no script draws the plots.
Html unscripted() {
  return html(
      "<p class=\"note unscripted\">The plots are drawn by a script in this page, which does not run here. The tables "
      "have the "
      "numbers.</p>\n");
}

/// What the marks on the plots along the path mean, where there are some.
Html marks_text(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  Html result;
  if (scene.gravest)
    result +=
        html(" Dashed red: {}.", scene.gravest->violation.singular ? "the two witness poses" : "the witness pose");
  if (!certificate.stretches.empty()) {
    result += html(" Shaded over the whole height: the stretches where the path is not proved.");
  } else if (certificate.undecided && certificate.undecided->segment) {
    result += html(" Amber: what was left open.");
  }
  return result;
}

bool has_bands(const ReportContext& scene) {
  return std::ranges::any_of(scene.ranges.segments, [](const auto& segment) { return !segment.empty(); });
}

/// Explains the bands, if there are any.
Html bands_text(const ReportContext& scene) {
  if (!has_bands(scene)) return html("No theorem stands behind this path, so that there are samples only.");
  return html(
      "Light bands are enclosures, computed by this program anew with interval arithmetic, box by box as the "
      "certificate has them: "
      "at no pose{}{} does a value leave its band.{} The darker band and the line are floating-point samples.",
      is_implied(scene.certificate) && !scene.ranges_are_whole ? " in the stated tubes" : "",
      scene.certificate.problem.tolerances ? " and no deviation within the tolerances" : "",
      scene.ranges_are_whole ? ""
      : scene.ranges.missing > 0
          ? fmt::format(" Where there is none, nothing is proved, or enclosing was given up ({}).",
                        plural(scene.ranges.missing, "box"))
          : " Where there is none, nothing is proved.");
}

/// How the six plots of one quantity are arranged.
constexpr const char* kArrangement = "All six share one scale. The cable that comes nearest to a limit is first.";

Html tensions(const ReportContext& scene) {
  return section(
      "tensions", "Tensions along the path",
      html("<p>For each cable all tensions that the loads in K can ask of it{}. {} {} Shaded red: beyond the "
           "limits.{}</p>\n",
           is_move(scene.certificate) ? ", with their inertia" : "", kArrangement, bands_text(scene),
           marks_text(scene)) +
          unscripted() + place("tensions"));
}

Html lengths(const ReportContext& scene) {
  return section(
      "lengths", "Cable lengths along the path",
      html("<p>{} {} Shaded red: beyond the limits.{}</p>\n", kArrangement, bands_text(scene), marks_text(scene)) +
          unscripted() + place("lengths"));
}

/// Only of a move in time.
Html winches(const ReportContext& scene) {
  if (!is_move(scene.certificate)) return {};
  const std::vector<RateUse> uses = rate_uses(scene);
  const bool has_power =
      std::ranges::any_of(uses, [](const RateUse& use) { return use.limit.id.kind == RateKind::kWinchPower; });
  return section(
      "winches", "Winches during the move",
      html("<p>How fast each cable is wound, the acceleration of that{}: samples of the commanded motion, in floating "
           "point. Positive: the cable becomes longer. Lines are the limits that are stated{}; shaded red: beyond "
           "them.{}</p>\n",
           has_power ? ", and power, which is the greatest tension times the speed" : "",
           scene.verdict == "proved" ? ", which are proved to be kept" : "", marks_text(scene)) +
          unscripted() + place("winch_speed") + place("winch_acceleration") +
          (has_power ? place("winch_power") : Html()));
}

Html margins_along(const ReportContext& scene) {
  if (scene.certificate.segments.empty()) return {};
  return section(
      "margins-along", "Margins along the path",
      html("<p>How far inside the limits the worst of the six cables is. Steps: what the certificate proves "
           "of each segment; "
           "dashed: samples. A bound is as sharp as the proof needed it; the true margin is in between.{}{}</p>\n",
           is_move(scene.certificate) ? ""
                                      : " The set of loads may grow by wrench_scale before a tension reaches a limit.",
           marks_text(scene)) +
          unscripted() + place("margins"));
}

/// The pairs that come nearest, in numbers.
Html nearest_table(const ReportContext& scene) {
  const DistancesAlong& along = scene.distances;
  const DisplayUnit& unit = scene.illustration.units.length;
  const std::vector<BodyPair> all = pairs(*scene.certificate.problem.bodies);
  std::vector<std::vector<Html>> rows;
  for (std::size_t n = 0; n < along.nearest.size(); ++n) {
    const double distance = along.distance[n][along.nearest_at[n]];
    const double clearance = along.clearance[n][along.nearest_at[n]];
    const BodyPair& pair = all.at(along.nearest[n]);
    rows.push_back({html("<bdi>{}</bdi>", scene.bodies->name(along.nearest[n])),
                    html("{}", with_minus_signs(unit.nearest(distance, 3))),
                    html("{}", with_minus_signs(unit.exact(asked_exactly({.clearance = clearance}, pair)))),
                    html("{}", with_minus_signs(unit.nearest(distance - clearance, 3))),
                    html("{}", place_text(scene, scene.samples[along.nearest_at[n]].position))});
  }
  return table(
      html("The pairs that come nearest to their clearance, in floating point; below 0: about how deep they are "
           "in each other, or may be"),
      {{html("Bodies")},
       {html("Apart [{}]", unit.name()), true},
       {html("Clearance [{}]", unit.name()), true},
       {html("Left [{}]", unit.name()), true},
       {html("Where")}},
      rows);
}

Html clearances(const ReportContext& scene) {
  if (!scene.bodies || scene.distances.least.empty()) return {};
  const std::string checked = plural(scene.bodies->pairs(), "pair");
  return section(
      "clearances", "Distances between bodies",
      html("<p>How much farther than its clearance the nearest of {} of bodies is apart{}. Then those that come "
           "nearest, each with its clearance: samples of the machine as stated, in floating point. Shaded red: nearer "
           "than the clearance.{}</p>\n",
           checked,
           scene.certificate.segments.empty()
               ? Html(html(" in samples"))
               : html(". Steps: what the certificate proves of each segment, for all pairs{}; dashed: samples",
                      scene.certificate.problem.tolerances ? " and all deviations within the tolerances" : ""),
           marks_text(scene)) +
          unscripted() + place("clearances") + nearest_table(scene));
}

/// Of a space of three coordinates: where all of its poses are shown.
Html slices_text(const ReportContext& scene) {
  const SpaceText& space = scene.certificate.problem.space;
  if (space.parameters.size() != 3 || !space.constraints.empty()) return {};
  return html(
      " A proved map of all poses of this space, slice by slice, is drawn by <code>taut map CASE --out FOLDER</code>.");
}

Html poses(const ReportContext& scene) {
  return section("pose", "Pose along the path",
                 html("<p>Position p of the platform’s origin in the world; {}. Floating-point samples.{}</p>\n",
                      rotation_formula(shown_angles(scene.certificate)), slices_text(scene)) +
                     unscripted() + place("pose"));
}

Html plane(const ReportContext& scene) {
  if (!is_plane(scene.certificate.problem.space)) return {};
  Html stats;
  for (const auto& [key, value] : scene.illustration.stats)
    stats += html("{}{}: {}", stats.empty() ? Html() : html(" · "), key, value);
  return section(
      "plane", "Where the platform may go",
      html("<p>The plane of the two parameters. C is the set of wrench-feasible poses. The atlas is where the planner "
           "looked; it proves nothing. Periodic parameters are drawn unwrapped, so that the path is one line.{}</p>\n",
           scene.certificate.problem.space.flip ? " (φ, θ) and (φ + π, −θ) are the same pose." : "") +
          unscripted() + place("plane") +
          (stats.empty() ? Html()
                         : html("<p class=\"note\">The search, as the program that wrote the certificate says (not "
                                "checked): {}</p>\n",
                                stats)));
}

Html biting_tolerances(const ReportContext& scene) {
  const std::optional<Headroom>& headroom = scene.illustration.headroom;
  if (scene.verdict != "proved" || !headroom || !scene.certificate.problem.tolerances) return {};
  return section(
      "tolerances-used", "Which tolerance bites",
      html("<p>Each bar: how much is stated of what this uncertainty alone could be, all others as stated. The one "
           "nearest to 100 % is the first to look after. Beside it: how far it could go alone, of what is stated, as "
           "the program that wrote the certificate says; it is not checked.</p>\n") +
          unscripted() + place("tolerances"));
}

}  // namespace

bool shows_path(const ReportContext& scene) {
  return !scene.samples.empty() && scene.certificate.path.segments() > 0 && !found_no_path(scene.certificate);
}

const char* move_title(const ReportContext& scene) {
  if (shows_path(scene)) return "The move";
  return found_no_path(scene.certificate) ? "Start and goal" : "The pose";
}

Html move_section(const ReportContext& scene) {
  if (scene.samples.empty()) return {};
  return section(
      "move", move_title(scene),
      place("move") +
          html("<div class=\"still\">{}<p class=\"note\">Dashed outlines are the platform at the start (S) and at the "
               "goal (G). Posts and ground stand for whatever carries the anchors A1 to A6. Cables are coloured by "
               "floating-point values at this place: grey is calm, amber from 75 % of a limit, dashed from 95 %, red "
               "out of the limits.</p></div>\n",
               still_picture(scene)) +
          dimensioned_views(scene));
}

Html plot_sections(const ReportContext& scene) {
  if (!shows_path(scene)) return plane(scene);
  return poses(scene) + tensions(scene) + lengths(scene) + winches(scene) + clearances(scene) + margins_along(scene) +
         plane(scene) + biting_tolerances(scene);
}

std::string page_scripts(const ReportContext& scene) {
  return fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n<script>{}</script>\n",
                     script_safe(report_data(scene)), page_script());
}

std::string content_security_policy() {
  return fmt::format(
      "default-src 'none'; script-src 'sha256-{}'; style-src 'unsafe-inline'; img-src data:; font-src data:; "
      "base-uri 'none'; form-action 'none'",
      page_script_sha256());
}

}  // namespace taut
