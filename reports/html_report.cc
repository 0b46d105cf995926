#include "reports/html_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/figures.h"
#include "reports/plot_sections.h"
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

Html contents(const Scene& scene) {
  Html links;
  const auto link = [&](bool present, const char* id, const char* title) {
    if (present) links += html("<a href=\"#{}\">{}</a> ", id, title);
  };
  const bool has_path = !scene.samples.empty();
  link(true, "theorem", "Claim");
  link(scene.view.problem.tolerances.has_value(), "tolerances", "Tolerances");
  link(true, "assumptions", "Assumptions");
  link(true, "inputs", "Digests");
  link(has_path, "move", "The move");
  link(!scene.view.stretches.empty(), "stretches", "Stretches");
  link(has_path, "tensions", "Tensions");
  link(has_path, "lengths", "Lengths");
  link(has_path, "pose", "Pose");
  link(is_plane(scene.view.problem.space), "slice", "Plane");
  link(scene.view.margins.has_value(), "margins", "Margins");
  link(true, "robot", "Robot");
  link(true, "path", "Path");
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
                    assumptions(scene.view.problem) + inputs(scene.view) + move_section(scene) + stretches(scene.view) +
                    plot_sections(scene) + margins(scene.view) + robot(scene) + path_section(scene) +
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
