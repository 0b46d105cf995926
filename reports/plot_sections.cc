#include "reports/plot_sections.h"

#include <nlohmann/json.hpp>

#include "reports/figures.h"
#include "reports/sections.h"

namespace taut {

namespace {

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

Html poses(const Scene& scene) {
  if (scene.samples.empty()) return {};
  return section("pose", "Pose along the path", pose_figure(scene));
}

}  // namespace

Html move_section(const Scene& scene) {
  if (scene.samples.empty()) return {};
  return section("move", "The move",
                 robot_figure(scene) +
                     html("<p class=\"note\">Seen from the side, with the load pulling down; the dot is the load "
                          "point. Numbers are cables.</p>\n"));
}

Html plot_sections(const Scene& scene) { return tensions(scene) + lengths(scene) + poses(scene) + slice(scene); }

}  // namespace taut
