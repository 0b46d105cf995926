// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/sections.h"

#include <algorithm>
#include <cmath>

#include "reports/page/table_sizes.h"
#include "reports/summary/angles.h"
#include "reports/summary/around_items.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/broken_limits.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/numbers.h"
#include "reports/summary/scope.h"
#include "reports/summary/sentences.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

/// γ of segment k, where the path runs between poses.
Html motion_between_poses(Interpolation law) {
  if (law == Interpolation::kGeodesic) {
    return html(
        "<p>p(s) <span class=\"up\">=</span> (1 − s) p<sub>k</sub> + s p<sub>k+1</sub>,&ensp;R(s) <span "
        "class=\"up\">=</span> R<sub>k</sub> exp(s log(R<sub>k</sub><sup>T</sup> R<sub>k+1</sub>)),&ensp;s ∈ [0, "
        "1]</p>\n");
  }
  return html(
      "<p>(p, R)(s) <span class=\"up\">the only pose in its tube with</span> |p + R b<sub>i</sub> − a<sub>i</sub>| = "
      "(1 − s) L<sub>k,i</sub> + s L<sub>k+1,i</sub>,&ensp;s ∈ [0, 1]</p>\n");
}

/// The claim about a move in time; `path` says what γ, K and σ are.
Html formulas_in_time(const Certificate& certificate, const Html& path) {
  const Html law = html(
      "<p>s <span class=\"up\">=</span> σ(t), <span class=\"up\">a cubic B-spline of time that never falls, from 0 to "
      "the number of segments; at s = k + x the pose is</span> γ<sub>k</sub>(x), <span class=\"up\">written</span> "
      "γ(σ(t)); L <span class=\"up\">are the lengths</span> d <span class=\"up\">that are commanded</span></p>\n");
  if (certificate.verdict == Verdict::kRefuted) {
    return html(
        "<div class=\"formulas\">{}{}"
        "<p>∃ t ∈ [0, T], i, w ∈ K :&ensp; det J(γ(σ(t))) = 0 &ensp;<span class=\"up\">or</span>&ensp; "
        "f<sub>i</sub> ∉ (f<sub>lo,i</sub>, f<sub>hi,i</sub>) <span class=\"up\">with</span> J f = w − "
        "w<sub>in</sub>(t) &ensp;<span class=\"up\">or</span>&ensp; d<sub>i</sub> ∉ (d<sub>lo,i</sub>, "
        "d<sub>hi,i</sub>) &ensp;<span class=\"up\">or a speed, an acceleration or a power is not below its "
        "limit</span></p></div>\n",
        path, law);
  }
  return html(
      "<div class=\"formulas\">{}{}"
      "<p>∀ t ∈ [0, T] &ensp;{}∀ w ∈ K &ensp;∀ i ∈ {{1, …, 6}}, <span class=\"up\">at the pose</span> γ(σ(t)){}:</p>\n"
      "<p>&emsp;det J ≠ 0, &emsp; J f = w − w<sub>in</sub>(t) ⟹ f<sub>lo,i</sub> &lt; f<sub>i</sub> &lt; "
      "f<sub>hi,i</sub>, &emsp; d<sub>lo,i</sub> &lt; d<sub>i</sub> &lt; d<sub>hi,i</sub></p>\n"
      "<p>&emsp;<span class=\"up\">and below their limits, where such are stated:</span> |dL<sub>i</sub>/dt|, "
      "|d²L<sub>i</sub>/dt²|, |f<sub>i</sub> dL<sub>i</sub>/dt|, <span class=\"up\">speed and acceleration of the load "
      "point, and those of the platform's turning</span></p></div>\n",
      path, law,
      certificate.problem.tolerances ? html("∀ <span class=\"up\">deviations within the tolerances</span> &ensp;")
                                     : Html(),
      certificate.problem.tolerances ? html("<span class=\"up\">, moved by the deviation</span>") : Html());
}

Html formulas(const Certificate& certificate) {
  if (certificate.verdict == Verdict::kUndecided) return {};
  const Html curve =
      certificate.path.interpolation == Interpolation::kStraight
          ? html("(1 − s) λ<sub>k</sub> + s λ<sub>k+1</sub>")
          : html(
                "((1 − s)<sup>3</sup> λ<sub>k</sub> + (3s<sup>3</sup> − 6s<sup>2</sup> + 4) λ<sub>k+1</sub> + "
                "(−3s<sup>3</sup> + 3s<sup>2</sup> + 3s + 1) λ<sub>k+2</sub> + s<sup>3</sup> λ<sub>k+3</sub>)/6");
  const Html motion =
      has_poses(certificate.path.interpolation) ? motion_between_poses(certificate.path.interpolation)
      : certificate.problem.space.constraints.empty()
          ? html("<p>γ<sub>k</sub>(s) <span class=\"up\">=</span> pose({}),&ensp;s ∈ [0, 1]</p>\n", curve)
          : html(
                "<p>γ<sub>k</sub>(s) <span class=\"up\">=</span> pose(ℓ<sub>k</sub>(s) + N<sub>k</sub>(s) y(s)),&ensp;"
                "ℓ<sub>k</sub>(s) = {},&ensp;s ∈ [0, 1]</p>\n"
                "<p>y(s) <span class=\"up\">the only</span> y <span class=\"up\">with</span> C(ℓ<sub>k</sub>(s) + "
                "N<sub>k</sub>(s) y) = 0, |y<sub>i</sub>| ≤ r<sub>k</sub></p>\n",
                curve);
  const LoadText& load = certificate.problem.load;
  const Html ellipsoid = html("{{ w : (w − w<sub>0</sub>)<sup>T</sup> E (w − w<sub>0</sub>) ≤ 1 }}");
  const Html items = html(
      "K<sub>1</sub> + … + K<sub>{}</sub>, <span class=\"up\">the items of the load, in the axes of the world about "
      "the load point</span>",
      load.items.size());
  const Html set = load.items.empty() ? ellipsoid : load.ellipsoid ? items + html(" + ") + ellipsoid : items;
  const Html path = html("{}<p>K <span class=\"up\">=</span> {}</p>\n", motion, set);
  if (is_move(certificate)) return formulas_in_time(certificate, path);
  if (certificate.verdict == Verdict::kRefuted) {
    return html(
        "<div class=\"formulas\">{}"
        "<p>∃ k, s ∈ [0, 1], i, w ∈ K :&ensp; det J(γ<sub>k</sub>(s)) = 0 &ensp;<span class=\"up\">or</span>&ensp; "
        "f<sub>i</sub> ∉ (f<sub>lo,i</sub>, f<sub>hi,i</sub>) <span class=\"up\">with</span> J f = w "
        "&ensp;<span class=\"up\">or</span>&ensp; d<sub>i</sub> ∉ (d<sub>lo,i</sub>, d<sub>hi,i</sub>)</p></div>\n",
        path);
  }
  return html(
      "<div class=\"formulas\">{}"
      "<p>∀ k ∈ {{0, …, {}}} &ensp;∀ s ∈ [0, 1] &ensp;{}∀ w ∈ K &ensp;∀ i ∈ {{1, …, 6}}, "
      "<span class=\"up\">at the pose</span> γ<sub>k</sub>(s){}:</p>\n"
      "<p>&emsp;det J ≠ 0, &emsp; J f = w ⟹ f<sub>lo,i</sub> &lt; f<sub>i</sub> &lt; f<sub>hi,i</sub>, &emsp; "
      "d<sub>lo,i</sub> &lt; d<sub>i</sub> &lt; d<sub>hi,i</sub></p>\n"
      "<p><span class=\"up\">which is the same as</span>&ensp; {}</p></div>\n",
      path, certificate.segments.empty() ? 0 : certificate.segments.size() - 1,
      certificate.problem.tolerances ? html("∀ <span class=\"up\">deviations within the tolerances</span> &ensp;")
                                     : Html(),
      certificate.problem.tolerances ? html("<span class=\"up\">, moved by the deviation</span>") : Html(),
      load.items.empty()
          ? html("f<sub>lo,i</sub> &lt; f<sub>0,i</sub> − v<sub>i</sub>, &ensp; f<sub>0,i</sub> + v<sub>i</sub> &lt; "
                 "f<sub>hi,i</sub>, &ensp;<span class=\"up\">where</span>&ensp; f<sub>0</sub> = J<sup>−1</sup> "
                 "w<sub>0</sub>, &ensp; B = J<sup>T</sup> E J, &ensp; v<sub>i</sub> = √(B<sup>−1</sup>)<sub>ii</sub>")
          : html("f<sub>lo,i</sub> &lt; <span class=\"up\">min</span><sub>w ∈ K</sub> (J<sup>−1</sup> w)<sub>i</sub>, "
                 "&ensp; <span class=\"up\">max</span><sub>w ∈ K</sub> (J<sup>−1</sup> w)<sub>i</sub> &lt; "
                 "f<sub>hi,i</sub>"));
}

/// "0.5 mm", or six of them.
Html each_cable(const std::array<DecimalText, kCables>& metres, const DisplayUnit& unit) {
  if (std::ranges::all_of(metres, [&](const DecimalText& x) { return x == metres[0]; })) {
    return html("{} {}", unit.exact(metres[0]), unit.name());
  }
  Html list;
  for (const DecimalText& x : metres) list += html("{}{}", list.empty() ? "" : ", ", unit.exact(x));
  return list + html(" {}", unit.name());
}

Html robot_tables(const Problem& problem, const DisplayUnits& units) {
  std::vector<std::vector<Html>> cables;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Limits& tension = problem.robot.tension_N[i];
    const Limits& length = problem.robot.length_m[i];
    cables.push_back({html("{}", i + 1), html("{}", triple(problem.robot.base_anchors_m[i], units.length)),
                      html("{}", triple(problem.robot.platform_anchors_m[i], units.length)),
                      html("({}, {})", units.force.exact(tension.lower), units.force.exact(tension.upper)),
                      html("({}, {})", units.length.exact(length.lower), units.length.exact(length.upper))});
  }
  return table(html("Cables: anchors and limits, as the case states them"),
               {{html("Cable"), true},
                {html("Base anchor a [{}]", units.length.name())},
                {html("Platform anchor b [{}]", units.length.name())},
                {html("Tension limits [{}]", units.force.name())},
                {html("Length limits [{}]", units.length.name())}},
               cables);
}

Html items_table(const LoadStatement& statement, const char* caption) {
  std::vector<std::vector<Html>> rows;
  for (const auto& [name, words] : statement.items) rows.push_back({html("<bdi>{}</bdi>", name), html("{}", words)});
  const std::string inertia = statement.inertia.empty() ? "" : " " + statement.inertia;
  return html("<p>{} {}{}</p>\n", statement.total, statement.spread, inertia) +
         table(html("{}", caption), {{html("Item")}, {html("What it is")}}, rows);
}

/// The items in words, and those that the case puts an ellipsoid around.
Html load_tables(const Certificate& certificate) {
  Html result = items_table(stated_load(certificate),
                            "What the load consists of; K is the sum. Ranges with many digits are rounded inward");
  if (const auto items = stated_items(certificate)) {
    result += html("<p class=\"note\">{}</p>\n", kItemsNotChecked) +
              items_table(*items, "What the case puts the ellipsoid around; not checked");
  }
  return result;
}

/// How the path follows the constraints, and how far that takes it from the waypoints.
Html on_constraints(const ReportContext& scene) {
  const std::vector<double>& tubes = scene.certificate.path.tubes;
  const double widest = tubes.empty() ? 0 : *std::max_element(tubes.begin(), tubes.end());
  return html(
      " All poses of the motion lie on the constraints, exactly; waypoints lie near them, and the poses shown are "
      "those on them. The motion is at most {:.3g} (m, rad; r<sub>k</sub> along each column of N) from what the "
      "waypoints alone would give.",
      widest);
}

/// Decimals of metres that make positions on this machine sure to a thousandth of its size.
int position_decimals(const RobotText& robot) {
  double size = 0;
  for (const auto* anchors : {&robot.base_anchors_m, &robot.platform_anchors_m}) {
    for (const auto& anchor : *anchors) {
      for (const DecimalText& x : anchor) size = std::max(size, std::abs(nearest_double(x)));
    }
  }
  constexpr int kDigits = 3;
  return size > 0 ? kDigits - static_cast<int>(std::floor(std::log10(size))) : kDigits;
}

/// The pose at every `step`th waypoint and at the last, rounded.
Html pose_table(const ReportContext& scene, std::size_t step) {
  const Path& path = scene.certificate.path;
  const bool is_spline = path.interpolation == Interpolation::kCubicBSpline;
  const AngleKind kind = shown_angles(scene.certificate).kind;
  const DisplayUnit& length = scene.illustration.units.length;
  const int decimals = position_decimals(scene.certificate.problem.robot);
  const char* const what = is_spline ? "Control point" : "Waypoint";
  std::vector<Column> columns = {{html("{}", what), true}};
  for (const char* name : {"px", "py", "pz"}) columns.push_back({html("{} [{}]", name, length.name()), true});
  const std::vector<std::string> symbols = angle_symbols(kind);
  for (const std::string& symbol : symbols) columns.push_back({html("{} [°]", symbol), true});
  std::vector<std::vector<Html>> rows;
  const std::size_t last = path.waypoints.size() - 1;
  for (std::size_t k = 0; k <= last; k = k < last ? std::min(k + step, last) : last + 1) {
    const Pose<double> pose =
        is_spline ? scene.sampler.pose(path.waypoints[k]) : scene.sampler.at(path, static_cast<double>(k)).pose;
    rows.push_back({html("{}", k)});
    for (int c = 0; c < 3; ++c) rows.back().push_back(html("{}", length.fixed(pose.p_WP(c), decimals)));
    const auto angles = angles_of(kind, scene.sampler.model().angles, pose.angles);
    for (std::size_t c = 0; c < symbols.size(); ++c) {
      rows.back().push_back(html("{:.1f}", degrees(angles[c]) + 0.0));
    }
  }
  return table(html("{}s: poses, rounded", what), columns, rows);
}

}  // namespace

Html theorem(const Certificate& certificate) {
  const std::vector<Column> columns = {{html("Symbol")}, {html("Meaning")}, {html("Unit")}};
  const auto row = [](const Html& symbol, const Html& meaning, const Html& unit) {
    return std::vector<Html>{html("<i>{}</i>", symbol), meaning, unit};
  };
  std::vector<std::vector<Html>> rows = {
      row(html("γ<sub>k</sub>(s)"), html("pose of the platform at the point s of segment k"), html("")),
      row(html("λ<sub>k</sub>"), html("waypoint k: one exact number for each parameter of the space of poses"),
          html("m, rad")),
      row(html("p, R"),
          html("position of the platform's origin; its orientation by {}", rotation_formula(shown_angles(certificate))),
          html("m, rad")),
      row(html("a<sub>i</sub>, b<sub>i</sub>"),
          html("anchors of cable i on the base (world axes) and on the platform (platform axes)"), html("m")),
      row(html("d<sub>i</sub>"), html("length of cable i, |p + R b<sub>i</sub> − a<sub>i</sub>|"), html("m")),
      row(html("u<sub>i</sub>"), html("direction of cable i, from base to platform"), html("1")),
      row(html("J"),
          html("force Jacobian: column i is (u<sub>i</sub> ; (R (b<sub>i</sub> − p<sub>m</sub>)) × u<sub>i</sub>), "
               "about the load point"),
          html("1, m")),
      row(html("f<sub>i</sub>"), html("tension of cable i"), html("N")),
      row(html("w"), html("wrench (force, moment about the load point) that the cables balance"), html("N, N·m")),
      row(html("K"), html("the set of all wrenches of the load"), html("N, N·m")),
      row(html("f<sub>lo</sub>, f<sub>hi</sub>, d<sub>lo</sub>, d<sub>hi</sub>"),
          html("limits of tension and length; they are themselves excluded"), html("N, m"))};
  const LoadText& load = certificate.problem.load;
  if (load.ellipsoid) {
    rows.push_back(
        row(html("w<sub>0</sub>, E"), html("centre and matrix of the load ellipsoid"), html("N, N·m; 1/N², 1/(N·m)²")));
  }
  if (is_move(certificate)) {
    rows.push_back(row(html("σ(t)"),
                       html("where on the path the move is at the time t: 2.5 is the middle of segment 2"), html("1")));
    rows.push_back(row(html("w<sub>in</sub>(t)"),
                       html("wrench that changes the momenta of the load's weights, for all that their tolerances "
                            "allow"),
                       html("N, N·m")));
  } else if (load.items.empty()) {
    rows.push_back(row(html("f<sub>0,i</sub> ± v<sub>i</sub>"),
                       html("least and greatest tension of cable i over all wrenches in K"), html("N")));
  }
  const Html symbols = table(html("Symbols of the claim"), columns, rows);
  return section("theorem", "What is claimed",
                 html("<blockquote>{}</blockquote>\n{}{}", certificate.claim, formulas(certificate),
                      folded(false, html("Symbols"), symbols)));
}

Html assumptions(const Certificate& certificate) {
  const auto list = [](const std::vector<ScopeItem>& items) {
    Html rows;
    for (const ScopeItem& item : items) rows += html("<li>{}</li>\n", item.text);
    return html("<ul>\n{}</ul>\n", rows);
  };
  return section(
      "assumptions", "What is assumed, and what is not covered",
      html("<p>The claim is about a mathematical model. Whoever signs this report vouches that the machine "
           "agrees with it.</p>\n<div class=\"scopes\"><div><h3>Assumed</h3>\n{}</div>\n<div><h3>Not covered</h3>\n"
           "{}</div></div>\n",
           list(assumed(certificate)), list(not_covered(certificate))));
}

Html headroom(const ReportContext& scene) {
  std::vector<std::string> sentences;
  if (scene.illustration.headroom) {
    sentences = headroom_sentences(*scene.illustration.headroom, scene.certificate.problem, scene.illustration.units);
  }
  const bool is_unchecked = scene.recheck.result == Recheck::Result::kUnchecked;
  if (const auto found = stated_as_items(scene.certificate); found && !is_unchecked) {
    sentences.insert(sentences.begin(), sentence(*found, scene.illustration.units));
  }
  if (sentences.empty()) return {};
  Html body;
  for (const std::string& sentence : sentences) body += html("<p>{}</p>\n", sentence);
  return section("headroom", scene.verdict == "proved" ? "How far the proof reaches" : "What stands in the way",
                 body + html("<p class=\"note\">The program that wrote the certificate proved these shares, and found "
                             "the place in floating point. They are no part of the claim, and nothing has checked "
                             "them.</p>\n"));
}

Html tolerances(const ReportContext& scene) {
  if (!scene.certificate.problem.tolerances) return {};
  const TolerancesText& t = *scene.certificate.problem.tolerances;
  const std::optional<Headroom>& headroom = scene.illustration.headroom;
  const DisplayUnit& length = scene.illustration.units.length;
  const std::vector<EachAlone> alone =
      headroom ? each_alone(*headroom, scene.certificate.problem, scene.illustration.units) : std::vector<EachAlone>();
  std::vector<std::vector<Html>> rows;
  const auto row = [&](const std::string& key, const Html& what, const Html& stated) {
    Html limit = html("–");
    for (const EachAlone& found : alone) {
      if (key == name(found.of.kind)) limit = html("{}", found.size.empty() ? found.share : found.size);
    }
    rows.push_back({what, stated, limit});
  };
  row("base_anchors", html("anchors on the base, each from where it is stated"), each_cable(t.base_anchor_m, length));
  row("platform_anchors", html("anchors on the platform, likewise"), each_cable(t.platform_anchor_m, length));
  row("load_point", html("load point on the platform"), html("{} {}", length.exact(t.load_point_m), length.name()));
  Html wrench;
  for (const DecimalText& x : t.wrench) wrench += html("{}{}", wrench.empty() ? "± (" : ", ", x);
  row("load", html("wrench w<sub>0</sub>: force [N], moment [N·m]"), wrench + html(")"));
  row("position", html("tracking: position of the platform's origin"),
      html("{} {}", length.exact(t.position_m), length.name()));
  row("orientation", html("tracking: angle that the platform is turned by"), html("{}", angle_text(t.orientation_rad)));
  if (t.cable_length_m)
    row("cable_length", html("length of each cable, from what is commanded"), each_cable(*t.cable_length_m, length));
  const Html note =
      !headroom
          ? Html()
          : html(
                "<p class=\"note\">The last column: the size of each alone at which the path is provable, all others "
                "as "
                "stated, bisected; of six the largest. The program that wrote the certificate says so; it is no part "
                "of "
                "the claim, and nothing has checked it.</p>\n");
  return section(
      "tolerances", "Tolerances",
      html("<p>The claim covers every machine within all of these at once.</p>\n") +
          table(html("Tolerances"),
                {{html("Tolerance")}, {html("Stated"), true}, {html("Up to, alone (not checked)"), true}}, rows) +
          note);
}

namespace {

/// The bodies in people's units, and which pairs are checked.
Html bodies_tables(const Problem& problem) {
  if (!problem.bodies) return {};
  const BodiesStatement statement = bodies_statement(*problem.bodies);
  std::vector<std::vector<Html>> rows;
  for (const auto& [name, words] : statement.bodies) rows.push_back({html("<bdi>{}</bdi>", name), html("{}", words)});
  Html notes;
  for (const std::string& note : statement.notes) notes += html(" {}.", note);
  return html("<h3>Bodies that may not touch</h3>\n<p>{} {}{}</p>\n", statement.checked, statement.cables, notes) +
         (rows.empty()
              ? Html()
              : folded(rows.size() > kLongTable, html("{}", fmt::format("{} bodies", rows.size())),
                       table(html("Bodies, as the case states them"), {{html("Body")}, {html("What it is")}}, rows)));
}

}  // namespace

Html machine(const ReportContext& scene) {
  return section("robot", "Machine and load",
                 robot_tables(scene.certificate.problem, scene.illustration.units) + load_tables(scene.certificate) +
                     bodies_tables(scene.certificate.problem));
}

Html path_section(const ReportContext& scene) {
  const std::size_t count = scene.certificate.path.waypoints.size();
  if (count == 0) return section("path", "Path", html("<p>The certificate contains no path.</p>\n"));
  const Html segments =
      scene.certificate.path.interpolation != Interpolation::kCubicBSpline
          ? html("segment k leads from waypoint k to waypoint k + 1")
          : html(
                "segment k is the piece of a spline that waypoints k to k + 3 control, passing through a waypoint only "
                "where that stands three times in a row");
  const std::size_t step = step_for(count);
  const bool constrained = !scene.certificate.problem.space.constraints.empty();
  const std::optional<TimeLaw>& law = scene.certificate.path.timing;
  const Html timing =
      !is_move(scene.certificate)
          ? Html()
          : html(
                "<p>The move takes T = {:.9g} s. When it is where on the path is a uniform cubic B-spline of time with "
                "{} control values, one every {:.9g} s; the certificate has all of their digits.</p>\n",
                law->duration_s(), law->controls.size(), law->step_s);
  return section(
      "path", "Path",
      html("<p>{}, numbered from 0; {}. Interpolation: <code>{}</code>.{} {}Poses are rounded, "
           "and angles are given up to whole turns: between waypoints they run on without a jump, as the exact numbers "
           "do.</p>\n",
           plural(count, "waypoint"), segments, interpolation_name(scene.certificate.path.interpolation),
           constrained ? on_constraints(scene) : Html(),
           step == 1 ? Html() : html("Every {}th of them is shown. ", step)) +
          timing + folded(count > kLongTable, html("{}", plural(count, "waypoint")), pose_table(scene, step)));
}

namespace {

/// What is proved of the stretches, and outside of them.
std::string stretches_note(const Certificate& certificate) {
  if (certificate.verdict != Verdict::kRefuted) return "These stretches were left open; nothing is claimed of them.";
  const bool has_boxes = count_boxes(certificate) > 0;
  const std::string each =
      " Each violation is proved at one pose, with an enclosure of the quantity; nothing is claimed between the two.";
  if (is_implied(certificate)) return implied_scope(has_boxes) + each;
  return (has_boxes ? "Outside of these stretches the path is proved." : "No part of the path is proved.") + each;
}

}  // namespace

Html stretches(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  if (certificate.stretches.empty()) return {};
  const auto place = [&](const PathPoint& point) { return html("{}", place_text(scene, position(point))); };
  const auto violation = [&](const PathWitness& end) {
    const std::string about =
        end.contact && scene.bodies
            ? fmt::format(" ({} in floating point)", apart_text(distance_at(scene, position(end.at), end.contact->pair),
                                                                scene.illustration.units.length))
            : "";
    return html("{}{}, {}", violation_text(end, certificate.problem, scene.illustration.units), about,
                place_text(scene, position(end.at)));
  };
  const std::size_t shown = std::min(certificate.stretches.size(), kMostRows);
  std::vector<std::vector<Html>> rows;
  for (std::size_t k = 0; k < shown; ++k) {
    const Stretch& stretch = certificate.stretches[k];
    rows.push_back(
        {html("{}", k + 1), place(stretch.begin), place(stretch.end),
         stretch.violations ? violation(stretch.violations->first.violation) : html("open: {}", stretch.reason),
         stretch.violations ? violation(stretch.violations->second.violation) : Html()});
  }
  const Html all = table(
      html("Stretches that are not proved"),
      {{html("Stretch"), true}, {html("From")}, {html("To")}, {html("First violation")}, {html("Last violation")}},
      rows);
  const Html rest =
      certificate.stretches.size() > shown
          ? html("<p>These are the first {}; the certificate has all {}.</p>\n", shown, certificate.stretches.size())
          : Html();
  return section(
      "stretches", "Where the path is not proved",
      html("<p>{} Segment k leads from waypoint k to the next.</p>\n", stretches_note(certificate)) +
          folded(rows.size() > kLongTable, html("{}", plural(certificate.stretches.size(), "stretch")), all) + rest);
}

}  // namespace taut
