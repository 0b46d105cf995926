#include "reports/html_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/figures.h"
#include "reports/sections.h"
#include "reports/sentences.h"
#include "reports/style.h"
#include "reports/wording.h"

namespace taut {

namespace {

Html tile(const std::string& value, const Html& words) {
  return html("<div class=\"tile\"><b>{}</b><span>{}</span></div>\n", value, words);
}

Html header(const Scene& scene) {
  const CertificateView& view = scene.view;
  Html sentences;
  for (const std::string& sentence : verdict_text(scene)) sentences += html("<p>{}</p>\n", sentence);
  Html tiles;
  if (view.margins) {
    tiles = html(
        "<div class=\"tiles\">\n{}{}{}{}</div>\n",
        tile(plain(view.margins->tension_N) + " N", html("tension_N: least distance of a tension from its limits")),
        tile(millimetres(view.margins->length_m) + " mm", html("length_m: least distance of a length from its limits")),
        tile("× " + plain(view.margins->wrench_scale),
             html("wrench_scale: factor by which the load ellipsoid may grow")),
        tile(fmt::format("{} / {}", view.segments.size(), view.boxes), html("segments / boxes that were proved")));
  }
  return html(
      "<header>\n<p class=\"kind\">Motion report for a cable-driven hexapod</p>\n<h1><bdi>{}</bdi></h1>\n"
      "<div class=\"verdict {}\">{}</div>\n{}</header>\n",
      view.problem.name, view.verdict, sentences, tiles);
}

/// What the marks on the plots along the path mean, where there are some.
Html marks_text(const CertificateView& view) {
  if (view.witness) return html(" Dashed red: {}.", view.witness->to ? "the two witness poses" : "the witness pose");
  if (view.undecided && view.undecided->segment) return html(" Amber: what was left open.");
  return {};
}

Html tensions(const Scene& scene) {
  if (scene.samples.empty()) return {};
  return section(
      "tensions", "Tensions along the path",
      html("<p>The band is f<sub>0</sub> ± v: all tensions that the loads in K can ask of a cable; the line is "
           "f<sub>0</sub>, for the centre load. Shaded red: beyond the limits. Curves are floating-point samples; the "
           "proof does not rest on them.{}</p>\n",
           marks_text(scene.view)) +
          tension_figure(scene));
}

Html lengths(const Scene& scene) {
  if (scene.samples.empty()) return {};
  return section(
      "lengths", "Cable lengths along the path",
      html("<p>Shaded red: beyond the limits. Floating-point samples again.{}</p>\n", marks_text(scene.view)) +
          length_figure(scene));
}

Html slice(const Scene& scene) {
  const Html figure = slice_figure(scene);
  if (figure.empty()) return {};
  Html stats;
  for (const auto& [key, value] : scene.view.stats)
    stats += html("{}{}: {}", stats.empty() ? Html() : html(" · "), key, value);
  return section(
      "slice", "The plane of the two parameters",
      html("<p>C is the set of wrench-feasible poses. Colours and the line det J = 0 are floating-point samples on "
           "a grid, and the atlas is where the planner looked: neither proves anything. Periodic parameters are drawn "
           "unwrapped, so that the path is "
           "one line.{}</p>\n",
           scene.view.problem.space.flip ? " (φ, θ) and (φ + π, −θ) are the same pose." : "") +
          figure + (stats.empty() ? Html() : html("<p class=\"note\">Search: {}</p>\n", stats)));
}

Html contents(const Scene& scene) {
  Html links;
  const auto link = [&](bool present, const char* id, const char* title) {
    if (present) links += html("<a href=\"#{}\">{}</a> ", id, title);
  };
  const bool sampled = !scene.samples.empty();
  link(true, "theorem", "Claim");
  link(scene.view.problem.tolerances.has_value(), "tolerances", "Tolerances");
  link(true, "assumptions", "Assumptions");
  link(true, "inputs", "Digests");
  link(true, "robot", "Robot");
  link(true, "path", "Path");
  link(!scene.view.stretches.empty(), "stretches", "Stretches");
  link(sampled, "tensions", "Tensions");
  link(sampled, "lengths", "Lengths");
  link(scene.view.margins.has_value(), "margins", "Margins");
  link(is_plane(scene.view.problem.space), "slice", "Plane");
  link(true, "recheck", "Check again");
  return html("<nav aria-label=\"Contents\">{}</nav>\n", links);
}

Html signature(const CertificateView& view) {
  return html(
      "<div class=\"sign\"><div>Name</div><div>Date</div><div>Signature</div></div>\n"
      "<p class=\"note\">This report belongs to the certificate with footer.sha256 <span "
      "class=\"digest\">{}</span>.</p>\n",
      view.footer_sha256);
}

}  // namespace

std::string html_report(const nlohmann::json& certificate) {
  const Scene scene(certificate);
  const Html body = header(scene) + contents(scene) + theorem(scene.view) + tolerances(scene.view) +
                    assumptions(scene.view.problem) + inputs(scene.view) + robot(scene) + path_section(scene) +
                    stretches(scene.view) + tensions(scene) + lengths(scene) + margins(scene.view) + slice(scene) +
                    recheck(scene.view) + signature(scene.view);
  const Html title = html("{}: {}", scene.view.problem.name, scene.view.verdict);
  // An empty icon keeps browsers from asking a server for one.
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src "
      "data:\">\n<link rel=\"icon\" "
      "href=\"data:,\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      title.str(), kStyle, body.str());
}

std::string text_summary(const nlohmann::json& certificate) {
  std::string result;
  for (const std::string& sentence : verdict_text(Scene(certificate))) result += sentence + "\n";
  return result;
}

}  // namespace taut
